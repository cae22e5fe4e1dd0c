"use strict";
// The chain in its plane: its lengths, thicker where it is heavier.
const planarStage = ({ scene, state, motion, colour, toneOf, before, between, fit, massMark, TRAIL_S }) => {
  const stage = document.getElementById("stage");
  // Joints from the base to the tip, m; angles are from hanging, counter-clockwise.
  const places = (angles) => {
    let x = 0, y = 0;
    const all = [[0, 0]];
    angles.forEach((angle, i) => {
      x += scene.links[i].length_m * Math.sin(angle);
      y -= scene.links[i].length_m * Math.cos(angle);
      all.push([x, y]);
    });
    return all;
  };

  let bounds;
  const measure = () => {
    bounds = [-0.02, 0.02, -0.02, 0.02];
    for (const track of motion().tracks) {
      const stride = Math.max(1, Math.floor(track.time_s.length / 400));
      for (let k = 0; k < track.time_s.length; k += stride) {
        for (const [x, y] of places(track.link_rad.map((row) => row[k]))) {
          if (!Number.isFinite(x + y)) continue;
          bounds = [Math.min(bounds[0], x), Math.max(bounds[1], x), Math.min(bounds[2], y), Math.max(bounds[3], y)];
        }
      }
    }
    const reach = scene.links.reduce((sum, link) => sum + link.length_m, 0) || 1;
    const spare = 0.16 * reach;
    bounds = [bounds[0] - spare, bounds[1] + spare, bounds[2] - spare, bounds[3] + spare];
  };

  // Half width of a link: longer and heavier ones are stouter.
  const heaviest = Math.max(...scene.links.map((link) => link.mass_kg));
  const reach = scene.links.reduce((sum, link) => sum + link.length_m, 0) || 1;
  const stout = (link) => reach * (0.022 + 0.036 * Math.sqrt(link.mass_kg / heaviest));

  const capsule = (pen, [ax, ay], [bx, by], ra, rb) => {
    const angle = Math.atan2(by - ay, bx - ax);
    pen.beginPath();
    pen.arc(ax, ay, ra, angle + Math.PI / 2, angle - Math.PI / 2);
    pen.arc(bx, by, rb, angle - Math.PI / 2, angle + Math.PI / 2);
    pen.closePath();
  };

  const drawRobot = (pen, to, scale, track, solid) => {
    const joints = places(between(track, track.link_rad, state.time)).map(to);
    if (!joints.every(([x, y]) => Number.isFinite(x + y))) return;
    const tone = colour(toneOf(track));
    pen.lineJoin = "round";
    if (scene.head) {
      const [shoulder, hip] = [joints[1], joints[2]];
      const long = Math.hypot(shoulder[0] - hip[0], shoulder[1] - hip[1]) || 1;
      const r = 0.3 * scene.links[1].length_m * scale;
      const x = shoulder[0] + (shoulder[0] - hip[0]) / long * 1.25 * r, y = shoulder[1] + (shoulder[1] - hip[1]) / long * 1.25 * r;
      pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI);
      outline(pen, tone, solid);
    }
    scene.links.forEach((link, i) => {
      const r = stout(link) * scale, last = i === scene.links.length - 1;
      capsule(pen, joints[i], joints[i + 1], i === 0 ? 0.75 * r : r, last ? 0.7 * r : 0.9 * r);
      outline(pen, tone, solid);
    });
    joints.slice(0, -1).forEach(([x, y], i) => {
      if (i === 0) return;
      pen.beginPath(); pen.arc(x, y, 0.011 * reach * scale + 1, 0, 2 * Math.PI);
      pen.fillStyle = solid ? colour("--paper") : "transparent"; pen.fill();
      pen.strokeStyle = tone; pen.lineWidth = 1.6; pen.stroke();
    });
    if (state.com && solid) masses(pen, to, between(track, track.link_rad, state.time));
  };
  const skeleton = (pen, to, track) => {
    const joints = places(between(track, track.link_rad, state.time)).map(to);
    if (!joints.every(([x, y]) => Number.isFinite(x + y))) return;
    pen.strokeStyle = colour(toneOf(track)); pen.lineWidth = 2; pen.setLineDash([5, 4]);
    pen.beginPath(); joints.forEach((joint) => pen.lineTo(...joint)); pen.stroke(); pen.setLineDash([]);
  };
  const outline = (pen, tone, solid) => {
    if (solid) {
      pen.fillStyle = colour("--skin"); pen.fill();
      pen.fillStyle = tone; pen.globalAlpha = 0.16; pen.fill(); pen.globalAlpha = 1;
      pen.setLineDash([]);
    } else {
      pen.fillStyle = tone; pen.globalAlpha = 0.08; pen.fill(); pen.globalAlpha = 1;
      pen.setLineDash([5, 4]);
    }
    pen.strokeStyle = tone; pen.lineWidth = solid ? 2 : 1.6; pen.stroke(); pen.setLineDash([]);
  };
  // Each link's centre of mass, and that of them all.
  const masses = (pen, to, angles) => {
    let sum = 0, sx = 0, sy = 0;
    const joints = places(angles);
    const mark = (at, r) => massMark(pen, at, r);
    scene.links.forEach((link, i) => {
      const x = joints[i][0] + link.com_m * Math.sin(angles[i]), y = joints[i][1] - link.com_m * Math.cos(angles[i]);
      sum += link.mass_kg; sx += link.mass_kg * x; sy += link.mass_kg * y;
      if (scene.links.length > 1) mark(to([x, y]), 3.5);
    });
    mark(to([sx / sum, sy / sum]), 6.5);
  };

  const drawStage = () => {
    const [pen, width, height] = fit(stage);
    const scale = Math.min(width / (bounds[1] - bounds[0]), height / (bounds[3] - bounds[2]));
    const cx = (bounds[0] + bounds[1]) / 2, cy = (bounds[2] + bounds[3]) / 2;
    const to = ([x, y]) => [width / 2 + (x - cx) * scale, height / 2 - (y - cy) * scale];
    // Grid of 5 cm or more, so that it stays calm.
    const cell = [0.05, 0.1, 0.2, 0.5, 1, 2, 5].find((c) => c * scale > 46) || 10;
    pen.strokeStyle = colour("--grid"); pen.lineWidth = 1;
    const halfW = width / 2 / scale, halfH = height / 2 / scale;
    for (let x = Math.ceil((cx - halfW) / cell) * cell; x < cx + halfW; x += cell) {
      const [px] = to([x, 0]); pen.beginPath(); pen.moveTo(px, 0); pen.lineTo(px, height); pen.stroke();
    }
    for (let y = Math.ceil((cy - halfH) / cell) * cell; y < cy + halfH; y += cell) {
      const [, py] = to([0, y]); pen.beginPath(); pen.moveTo(0, py); pen.lineTo(width, py); pen.stroke();
    }
    const [bx, by] = to([0, 0]);
    // The stand of the bar, or the bracket of the drive.
    pen.strokeStyle = colour("--bar"); pen.lineCap = "round"; pen.globalAlpha = 0.45; pen.lineWidth = 5;
    if (scene.on_bar) {
      pen.beginPath(); pen.moveTo(bx, by); pen.lineTo(bx, height); pen.stroke();
    } else {
      const r = 0.07 * reach * scale;
      pen.fillStyle = colour("--bar"); pen.fillRect(bx - r, by - r, 2 * r, 2 * r);
    }
    pen.globalAlpha = 1; pen.lineCap = "butt";
    const tracks = motion().tracks.filter((_, i) => state.shown[i]);
    if (state.trail) for (const track of tracks) drawTrail(pen, to, track);
    // What was measured stands in front.
    for (const track of tracks.filter((t) => t.kind !== "measured")) drawRobot(pen, to, scale, track, false);
    for (const track of tracks.filter((t) => t.kind === "measured")) drawRobot(pen, to, scale, track, true);
    // Where they agree, the others' outlines would be hidden.
    pen.globalAlpha = 0.55;
    for (const track of tracks.filter((t) => t.kind !== "measured")) skeleton(pen, to, track);
    pen.globalAlpha = 1;
    const r = Math.max(5, 0.017 * reach * scale);
    pen.beginPath(); pen.arc(bx, by, r, 0, 2 * Math.PI);
    pen.fillStyle = colour("--bar"); pen.fill();
    pen.strokeStyle = colour("--limb-edge"); pen.lineWidth = 1.5; pen.stroke();
    pen.beginPath(); pen.arc(bx - r / 3, by - r / 3, r / 3.5, 0, 2 * Math.PI);
    pen.fillStyle = colour("--paper"); pen.globalAlpha = 0.7; pen.fill(); pen.globalAlpha = 1;
    // A scale.
    pen.strokeStyle = pen.fillStyle = colour("--soft"); pen.lineWidth = 2;
    pen.beginPath(); pen.moveTo(14, height - 14); pen.lineTo(14 + cell * scale, height - 14); pen.stroke();
    pen.font = "12px system-ui, sans-serif"; pen.textAlign = "left";
    pen.fillText(cell < 1 ? `${Math.round(100 * cell)} cm` : `${cell} m`, 14, height - 20);
  };

  const drawTrail = (pen, to, track) => {
    const from = before(track.time_s, state.time - TRAIL_S), until = before(track.time_s, state.time);
    pen.strokeStyle = track.kind === "measured" ? colour("--blue") : colour(toneOf(track));
    pen.lineWidth = 2.2; pen.lineCap = "round";
    let last = null;
    for (let k = from; k <= until; k++) {
      const all = places(track.link_rad.map((row) => row[k]));
      const here = to(all[all.length - 1]);
      if (last && Number.isFinite(here[0] + last[0])) {
        pen.globalAlpha = 0.75 * Math.max(0, 1 - (state.time - track.time_s[k]) / TRAIL_S);
        pen.beginPath(); pen.moveTo(...last); pen.lineTo(...here); pen.stroke();
      }
      last = here;
    }
    pen.globalAlpha = 1; pen.lineCap = "butt";
  };

  return { measure, draw: drawStage, keys: {} };
};
