"use strict";
// A robot in space: the ground and trails behind, surfaces, and marks in front.
const spaceStage = (player) => {
  const { scene, state, motion, colour, toneOf, before, between } = player;
  const { fit, massMark, TRAIL_S, redraw } = player;
  const { tree } = scene, $ = (id) => document.getElementById(id);
  const stage = $("stage"), floor = $("floor"), surfaces = $("surfaces");
  const up = unit(tree.up), camera = orbitCamera(stage, up, redraw);
  const paint = solidPainter(surfaces, tree, redraw);
  $("plain").hidden = paint !== null;
  // Opacity of what is no measurement; most samples that are looked at for the size, or drawn of a
  // trail.
  const GHOST = 0.42, SOME = 120, MOST_CELLS = 40;
  let names = false, ground = 0, radius = 1, centre = [0, 0, 0];

  const valuesAt = (track, k) => track.joint_rad.map((row) => row[k]);
  const isWhole = (values) => values.every(Number.isFinite);
  const posesNow = (track) => {
    const values = between(track, track.joint_rad, state.time);
    return isWhole(values) ? linkPoses(tree, values) : null;
  };
  const tips = tree.links.flatMap((link, i) =>
    (link.is_last ? [[i, link.bones_m[0] ?? [0, 0, 0]]] : []));

  // Corners of the boxes around surfaces, in their links' frames.
  const boxes = tree.parts.map(({ link, mesh, pose, scale }) => {
    const { low_m, size_m } = tree.meshes[mesh], frame = frameOf(pose);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => placed(frame, [0, 1, 2].map((axis) =>
      scale[axis] * (low_m[axis] + (bits >> axis & 1) * size_m[axis]))));
    return [link, corners];
  });
  const measure = () => {
    const points = [[0, 0, 0]];
    for (const track of motion().tracks) {
      const stride = Math.max(1, Math.floor(track.time_s.length / SOME));
      for (let k = 0; k < track.time_s.length; k += stride) {
        const values = valuesAt(track, k);
        if (!isWhole(values)) continue;
        const poses = linkPoses(tree, values);
        for (const { from, to } of bonesOf(tree, poses)) points.push(from, to);
        for (const [link, corners] of boxes) {
          const pose = link === null ? UNIT : poses[link];
          for (const corner of corners) points.push(placed(pose, corner));
        }
      }
    }
    const low = [...points[0]], high = [...points[0]];
    for (const point of points) {
      for (let axis = 0; axis < 3; axis++) {
        low[axis] = Math.min(low[axis], point[axis]);
        high[axis] = Math.max(high[axis], point[axis]);
      }
    }
    centre = low.map((value, axis) => (value + high[axis]) / 2);
    [radius, ground] = [0, 0];
    for (const point of points) {
      radius = Math.max(radius, Math.hypot(...plus(point, centre, -1)));
      ground = Math.min(ground, dot(point, up));
    }
    radius = radius || 1;
    camera.frame(centre, radius);
  };

  // Of 1 cm or more, so that it stays calm.
  const cell = () => {
    const least = 4 * radius / MOST_CELLS * 1.9;
    return [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10].find((size) => size > least) ?? 2 * least;
  };
  const drawGround = (pen, view) => {
    const { ahead, left } = camera, size = cell(), reach = 3.4 * radius;
    const middle = [dot(centre, ahead), dot(centre, left)];
    const at = (x, y) => view.project(plus(plus(up.map((v) => v * ground), ahead, x), left, y));
    const levels = Array.from({ length: 6 }, () => []);
    const from = middle.map((m) => Math.ceil((m - reach) / size) * size);
    const count = Math.floor(2 * reach / size);
    const corner = (i, k) => [from[0] + i * size, from[1] + k * size];
    const add = (a, b) => {
      const far = Math.hypot((a[0] + b[0]) / 2 - middle[0], (a[1] + b[1]) / 2 - middle[1]) / reach;
      if (far >= 1) return;
      const [begin, end] = [at(...a), at(...b)];
      if (begin && end) levels[Math.floor((1 - far) * levels.length)].push([begin, end]);
    };
    for (let i = 0; i <= count; i++) {
      for (let k = 0; k <= count; k++) {
        if (i < count) add(corner(i, k), corner(i + 1, k));
        if (k < count) add(corner(i, k), corner(i, k + 1));
      }
    }
    pen.strokeStyle = colour("--ground"); pen.lineWidth = 1;
    levels.forEach((segments, level) => {
      pen.globalAlpha = Math.min(1, 1.4 * (level + 1) / levels.length);
      pen.beginPath();
      for (const [a, b] of segments) { pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); }
      pen.stroke();
    });
    pen.globalAlpha = 1;
    // What carries the base.
    const [foot, head] = [at(0, 0), view.project([0, 0, 0])];
    if (!foot || !head) return;
    pen.strokeStyle = colour("--bar"); pen.globalAlpha = 0.5;
    pen.lineWidth = 4; pen.lineCap = "round";
    pen.beginPath(); pen.moveTo(foot[0], foot[1]); pen.lineTo(head[0], head[1]); pen.stroke();
    pen.globalAlpha = 1; pen.lineCap = "butt";
  };

  const drawTrail = (pen, view, track) => {
    const [first, last] = [TRAIL_S, 0].map((past) => before(track.time_s, state.time - past));
    const stride = Math.max(1, Math.ceil((last - first) / SOME)), lines = tips.map(() => []);
    for (let k = last; k >= first; k -= stride) {
      const values = valuesAt(track, k), poses = isWhole(values) && linkPoses(tree, values);
      tips.forEach(([link, end], i) => lines[i].push(
        [poses ? view.project(placed(poses[link], end)) : null, track.time_s[k]]));
    }
    pen.strokeStyle = track.kind === "measured" ? colour("--blue") : colour(toneOf(track));
    pen.lineWidth = 2.2;
    for (const line of lines) {
      for (let k = 1; k < line.length; k++) {
        const [[a, time], [b]] = [line[k], line[k - 1]];
        if (!a || !b) continue;
        pen.globalAlpha = 0.75 * Math.max(0, 1 - (state.time - time) / TRAIL_S);
        pen.beginPath(); pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); pen.stroke();
      }
    }
    pen.globalAlpha = 1;
  };

  // Without WebGL: bones as thick lines, the farthest first.
  const drawLines = (pen, view, robots) => {
    const of = ({ poses, opacity, css }) => bonesOf(tree, poses).flatMap((bone) => {
      const [a, b] = [view.project(bone.from), view.project(bone.to)];
      if (!a || !b) return [];
      return [{ a, b, opacity, tone: css(bone.link), width: bone.radius * (a[3] + b[3]) }];
    });
    const lines = robots.flatMap(of);
    lines.sort((one, other) => other.a[2] + other.b[2] - one.a[2] - one.b[2]);
    pen.lineCap = "round";
    for (const { a, b, opacity, tone, width } of lines) {
      const edge = opacity === 1 ? [[2, colour("--limb-edge")]] : [];
      for (const [more, style] of [...edge, [0, tone]]) {
        pen.globalAlpha = opacity; pen.strokeStyle = style;
        pen.lineWidth = Math.max(2, width) + more;
        pen.beginPath(); pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); pen.stroke();
      }
    }
    pen.globalAlpha = 1; pen.lineCap = "butt";
  };
  // Where they agree, surfaces that are no measurement would be hidden.
  const drawSkeleton = (pen, view, { poses, css }) => {
    pen.strokeStyle = css(0); pen.lineWidth = 1.8; pen.setLineDash([5, 4]); pen.globalAlpha = 0.6;
    pen.beginPath();
    for (const { from, to } of bonesOf(tree, poses)) {
      const [a, b] = [view.project(from), view.project(to)];
      if (a && b) { pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); }
    }
    pen.stroke(); pen.setLineDash([]); pen.globalAlpha = 1;
  };
  const drawMasses = (pen, view, poses) => {
    let sum = 0, whole = [0, 0, 0];
    const mark = (place, r) => { const at = view.project(place); if (at) massMark(pen, at, r); };
    tree.links.forEach((link, i) => {
      const place = placed(poses[i], link.com_m);
      sum += link.mass_kg; whole = plus(whole, place, link.mass_kg);
      if (tree.links.length > 1 && link.mass_kg > 0) mark(place, tree.links.length > 12 ? 2 : 3);
    });
    if (sum > 0) mark(whole.map((value) => value / sum), 6.5);
  };
  const label = (pen, text, x, y) => {
    pen.lineWidth = 3; pen.strokeStyle = colour("--panel"); pen.lineJoin = "round";
    pen.strokeText(text, x, y);
    pen.fillStyle = colour("--ink"); pen.fillText(text, x, y);
  };
  const drawNames = (pen, view, poses) => {
    pen.font = "12px system-ui, sans-serif"; pen.textAlign = "left";
    const taken = [];
    scene.joints.forEach(({ name }, i) => {
      const at = view.project(placed(poses[i], [0, 0, 0]));
      if (!at) return;
      const wide = pen.measureText(name).width, x = at[0] + 8;
      let y = at[1] + 4;
      const isTaken = ([left, high, width]) =>
        Math.abs(high - y) < 14 && x < left + width && left < x + wide;
      while (taken.some(isTaken)) y += 14;
      taken.push([x, y, wide]);
      if (y > at[1] + 10) {
        pen.strokeStyle = colour("--blue"); pen.lineWidth = 1; pen.globalAlpha = 0.7;
        pen.beginPath(); pen.moveTo(at[0], at[1]); pen.lineTo(x - 2, y - 4); pen.stroke();
        pen.globalAlpha = 1;
      }
      pen.beginPath(); pen.arc(at[0], at[1], 3, 0, 2 * Math.PI);
      pen.fillStyle = colour("--blue"); pen.fill();
      label(pen, name, x, y);
    });
  };
  // The base's axes, and what a cell of the ground measures.
  const drawLegend = (pen, view, height) => {
    const size = cell(), x = 46, y = height - 62;
    pen.font = "12px system-ui, sans-serif"; pen.textAlign = "center";
    const axes = ["x", "y", "z"].map((name, axis) =>
      [name, `--axis-${name}`, view.right[axis], view.above[axis], view.out[axis]]);
    axes.sort((one, other) => one[4] - other[4]);
    for (const [name, tone, right, above] of axes) {
      pen.strokeStyle = colour(tone); pen.lineWidth = 2.4; pen.lineCap = "round";
      pen.beginPath(); pen.moveTo(x, y); pen.lineTo(x + 24 * right, y - 24 * above); pen.stroke();
      label(pen, name, x + 33 * right, y - 33 * above + 4);
    }
    pen.lineCap = "butt"; pen.textAlign = "left"; pen.fillStyle = colour("--soft");
    const text = size < 1 ? `${Math.round(100 * size)} cm` : `${size} m`;
    pen.fillText(`ground: squares of ${text}`, 14, height - 12);
  };

  const rgb = (text) => {
    const full = text.length === 4 ? text.replace(/[0-9a-f]/gi, "$&$&") : text;
    return [1, 3, 5].map((at) => parseInt(full.slice(at, at + 2), 16) / 255);
  };
  // The measurement in two greys by turns, everything else in its tone.
  const robotOf = (track) => {
    const poses = posesNow(track), isMeasured = track.kind === "measured";
    const css = (link) => {
      if (!isMeasured) return colour(toneOf(track));
      return colour(link === null || link < 0 ? "--bar" : link % 2 ? "--metal" : "--metal-light");
    };
    const colours = (link) => rgb(css(link));
    return poses && { poses, css, isMeasured, opacity: isMeasured ? 1 : GHOST, colours };
  };
  const draw = () => {
    const [back, width, height] = fit(floor), [front] = fit(stage);
    const view = camera.seen(width, height);
    const tracks = motion().tracks.filter((_, i) => state.shown[i]);
    const robots = tracks.map(robotOf).filter(Boolean);
    drawGround(back, view);
    if (state.trail) for (const track of tracks) drawTrail(back, view, track);
    paint?.(view, robots, {
      width: stage.width, height: stage.height, up, ground, shadow: Number(colour("--shadow")),
    });
    if (!paint) drawLines(front, view, robots);
    for (const robot of robots) if (!robot.isMeasured) drawSkeleton(front, view, robot);
    const measured = robots.find((robot) => robot.isMeasured);
    if (state.com && measured) drawMasses(front, view, measured.poses);
    if (names && robots.length) drawNames(front, view, (measured ?? robots[0]).poses);
    drawLegend(front, view, height);
  };
  return { measure, draw, keys: { ...camera.keys, n: () => { names = !names; redraw(); } } };
};
