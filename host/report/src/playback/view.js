"use strict";
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const $ = (id) => document.getElementById(id);
  const stage = $("stage"), chart = $("chart"), scrub = $("scrub");
  const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
  const TRAIL_S = 1.2;
  const TONES = { measured: ["--ink"], model: ["--orange", "--green"], overlay: ["--blue", "--green"] };
  const state = { motion: 0, time: 0, speed: 1, playing: false, trail: true, com: true, shown: [], last: 0 };
  const hash = new URLSearchParams(location.hash.slice(1));

  // Light or dark: the system's wish until the reader has one.
  const system = matchMedia("(prefers-color-scheme: dark)");
  let dark = hash.has("dark") ? hash.get("dark") !== "0" : system.matches;
  const paint = () => { document.documentElement.classList.toggle("dark", dark); colours = {}; legend(); draw(); };
  system.addEventListener("change", () => { dark = system.matches; paint(); });
  let colours = {};
  const colour = (name) => (colours[name] ??= getComputedStyle(document.documentElement).getPropertyValue(name).trim());

  const motion = () => scene.motions[state.motion];
  const end = () => Math.max(...motion().tracks.map((t) => t.time_s[t.time_s.length - 1]));
  const toneOf = (track) => {
    const same = motion().tracks.filter((t) => t.kind === track.kind);
    const tones = TONES[track.kind];
    return tones[Math.min(same.indexOf(track), tones.length - 1)];
  };

  // Index of the last sample at or before a time.
  const before = (time, t) => {
    let low = 0, high = time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (time[middle] <= t) low = middle; else high = middle - 1;
    }
    return low;
  };
  const between = (track, rows, t) => {
    const k = before(track.time_s, t), next = Math.min(k + 1, track.time_s.length - 1);
    const span = track.time_s[next] - track.time_s[k];
    const share = span > 0 ? Math.min(Math.max((t - track.time_s[k]) / span, 0), 1) : 0;
    return rows.map((row) => row[k] === null || row[next] === null ? NaN : row[k] + share * (row[next] - row[k]));
  };
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

  const fit = (canvas) => {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, box.width, box.height);
    return [pen, box.width, box.height];
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
    const mark = ([x, y], r) => {
      pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI);
      pen.fillStyle = colour("--paper"); pen.fill();
      pen.fillStyle = colour("--limb-edge");
      for (const turn of [0, Math.PI]) { pen.beginPath(); pen.moveTo(x, y); pen.arc(x, y, r, turn, turn + Math.PI / 2); pen.fill(); }
      pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI);
      pen.strokeStyle = colour("--limb-edge"); pen.lineWidth = 1; pen.stroke();
    };
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

  // Joints side by side: each its own small chart with all tracks.
  const PAD = { left: 44, right: 10, top: 18, bottom: 20, gap: 50 };
  const panels = (width) => {
    const count = motion().tracks[0].joint_rad.length;
    const each = (width - PAD.left - PAD.right - PAD.gap * (count - 1)) / count;
    return Array.from({ length: count }, (_, i) => [PAD.left + i * (each + PAD.gap), each]);
  };
  const round = (step) => {
    const power = 10 ** Math.floor(Math.log10(step));
    return [1, 2, 5, 10].find((d) => d * power >= step * 0.999) * power;
  };
  const ticks = (low, high, wanted) => {
    const step = round((high - low) / wanted), all = [];
    for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) all.push(k * step);
    return [all, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))];
  };
  const drawChart = () => {
    const [pen, width, height] = fit(chart), total = end();
    const deg = 180 / Math.PI, top = PAD.top, bottom = height - PAD.bottom;
    pen.font = "11px system-ui, sans-serif";
    panels(width).forEach(([left, each], joint) => {
      let low = Infinity, high = -Infinity;
      motion().tracks.forEach((track, i) => {
        if (!state.shown[i] && i > 0) return;
        for (const v of track.joint_rad[joint]) if (v !== null) { low = Math.min(low, v * deg); high = Math.max(high, v * deg); }
      });
      if (!(high > low)) { low = (Number.isFinite(low) ? low : 0) - 1; high = low + 2; }
      const spare = 0.06 * (high - low); low -= spare; high += spare;
      const X = (t) => left + t / total * each, Y = (v) => bottom - (v - low) / (high - low) * (bottom - top);
      pen.strokeStyle = colour("--rule"); pen.fillStyle = colour("--soft"); pen.lineWidth = 1; pen.textAlign = "right";
      const [rows, decimals] = ticks(low, high, 4);
      for (const v of rows) {
        pen.beginPath(); pen.moveTo(left, Y(v)); pen.lineTo(left + each, Y(v)); pen.stroke();
        pen.fillText(v.toFixed(decimals), left - 6, Y(v) + 4);
      }
      pen.textAlign = "center";
      const [columns, places] = ticks(0, total, Math.max(2, Math.floor(each / 70)));
      for (const t of columns) pen.fillText(t.toFixed(places), X(t), height - 6);
      pen.textAlign = "left"; pen.fillStyle = colour("--ink");
      pen.fillText(`joint ${joint + 1}, deg`, left, 11);
      pen.save(); pen.beginPath(); pen.rect(left, 0, each, height); pen.clip();
      motion().tracks.forEach((track, i) => {
        if (!state.shown[i]) return;
        pen.strokeStyle = colour(toneOf(track)); pen.lineWidth = track.kind === "measured" ? 2 : 1.4;
        pen.globalAlpha = track.kind === "measured" ? 0.75 : 1;
        pen.beginPath();
        const stride = Math.max(1, Math.floor(track.time_s.length / (2 * each)));
        let pending = true;
        for (let k = 0; k < track.time_s.length; k += stride) {
          const v = track.joint_rad[joint][k];
          if (v === null) { pending = true; continue; }
          if (pending) pen.moveTo(X(track.time_s[k]), Y(v * deg)); else pen.lineTo(X(track.time_s[k]), Y(v * deg));
          pending = false;
        }
        pen.stroke(); pen.globalAlpha = 1;
      });
      pen.restore();
      pen.strokeStyle = colour("--blue"); pen.lineWidth = 1.5;
      pen.beginPath(); pen.moveTo(X(state.time), top - 4); pen.lineTo(X(state.time), bottom); pen.stroke();
    });
  };

  // Numbers beside the picture.
  const number = (value, places) => Number.isFinite(value) ? value.toFixed(places).replace(/^-(0\.?0*)$/, "$1") : "–";
  const drawNumbers = () => {
    const first = motion().tracks[0];
    motion().inputs.forEach((input, i) => {
      const node = $("drives").children[i];
      const value = input.values[before(first.time_s, state.time)];
      const share = Math.max(-1, Math.min(1, value / input.most));
      node.querySelector("b").textContent = `${number(value, 3)} ${input.unit}`;
      const bar = node.querySelector(".level");
      bar.setAttribute("x", share >= 0 ? 100 : 100 + 100 * share);
      bar.setAttribute("width", Math.abs(100 * share));
    });
    const shown = motion().tracks.filter((_, i) => state.shown[i]);
    const cells = (name, texts) => {
      const row = document.createElement("tr");
      row.append(...texts.map((text, i) => {
        const cell = document.createElement(name);
        cell.textContent = text;
        // Set here: a page's policy may refuse styles that stand in markup.
        if (i > 0 && name === "td") cell.style.color = `var(${toneOf(shown[i - 1])})`;
        return cell;
      }));
      return row;
    };
    const kinds = { measured: "measured", model: "model", overlay: "overlay" };
    $("angles").replaceChildren(
      cells("th", ["Angle", ...shown.map((track) => kinds[track.kind])]),
      ...first.joint_rad.map((_, joint) => cells("td", [`joint ${joint + 1}`, ...shown.map((track) =>
        `${number(between(track, [track.joint_rad[joint]], state.time)[0] * 180 / Math.PI, 2)}°`)])));
    $("clock").textContent = `${state.time.toFixed(2)} / ${end().toFixed(2)} s`;
    scrub.value = Math.round(1000 * state.time / end());
    $("play").textContent = state.playing ? "❚❚" : "▶";
  };
  const draw = () => { drawStage(); drawChart(); drawNumbers(); };

  const legend = () => {
    $("legend").replaceChildren(...motion().tracks.map((track, i) => {
      const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("i");
      box.type = "checkbox"; box.checked = state.shown[i];
      box.addEventListener("change", () => { state.shown[i] = box.checked; draw(); });
      swatch.style.background = `var(${toneOf(track)})`;
      label.append(box, swatch, document.createTextNode(track.name));
      return label;
    }));
  };
  const choose = (index) => {
    state.motion = index; state.time = 0; $("motion").value = index;
    state.shown = motion().tracks.map(() => true);
    for (const input of motion().inputs) input.most = Math.max(1e-9, ...input.values.map(Math.abs).filter(Number.isFinite));
    $("drives").replaceChildren(...motion().inputs.map((input) => {
      const node = document.createElement("div");
      node.className = "drive";
      node.innerHTML = `<div><span>joint ${input.joint}, ${input.what}</span><b></b></div>
        <svg viewBox="0 0 200 10" preserveAspectRatio="none"><rect width="200" height="10" rx="2" fill="var(--grid)"/>
        <rect class="level" y="0" height="10" fill="var(--blue)"/><line x1="100" x2="100" y2="10" stroke="var(--soft)"/></svg>`;
      return node;
    }));
    measure(); legend(); draw();
  };
  const seek = (time) => { state.time = Math.min(Math.max(time, 0), end()); draw(); };
  const play = (on) => {
    if (on && state.time >= end()) state.time = 0;
    state.playing = on; state.last = performance.now();
    if (on) requestAnimationFrame(tick);
    drawNumbers();
  };
  const tick = (now) => {
    if (!state.playing) return;
    state.time += Math.min(0.25, (now - state.last) / 1000) * state.speed;
    state.last = now;
    if (state.time >= end()) { state.time = end(); state.playing = false; }
    draw();
    requestAnimationFrame(tick);
  };
  const setSpeed = (speed) => { state.speed = speed; $("speed").value = speed; };
  const step = (count) => {
    const time = motion().tracks[0].time_s;
    play(false); seek(time[Math.min(Math.max(before(time, state.time + 1e-9) + count, 0), time.length - 1)]);
  };

  scene.motions.forEach((m, i) => $("motion").add(new Option(m.name, i)));
  $("motion").hidden = scene.motions.length < 2;
  $("motion").addEventListener("change", (e) => choose(Number(e.target.value)));
  SPEEDS.forEach((s) => $("speed").add(new Option(`${s} ×`, s)));
  setSpeed(1);
  $("speed").addEventListener("change", (e) => setSpeed(Number(e.target.value)));
  $("play").addEventListener("click", () => play(!state.playing));
  $("theme").addEventListener("click", () => { dark = !dark; paint(); });
  scrub.addEventListener("input", () => seek(scrub.value / 1000 * end()));
  const drag = (e) => {
    const box = chart.getBoundingClientRect(), x = e.clientX - box.left;
    const panel = panels(box.width).find(([left, each]) => x >= left - PAD.gap / 2 && x <= left + each + PAD.gap / 2);
    if (panel) seek((x - panel[0]) / panel[1] * end());
  };
  chart.addEventListener("pointerdown", (e) => { chart.setPointerCapture(e.pointerId); drag(e); });
  chart.addEventListener("pointermove", (e) => { if (e.buttons) drag(e); });
  addEventListener("resize", draw);
  addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT") return;
    const faster = (by) => setSpeed(SPEEDS[Math.min(Math.max(SPEEDS.indexOf(state.speed) + by, 0), SPEEDS.length - 1)]);
    const keys = {
      " ": () => play(!state.playing),
      ArrowLeft: () => step(e.shiftKey ? -10 : -1), ArrowRight: () => step(e.shiftKey ? 10 : 1),
      Home: () => seek(0), End: () => seek(end()),
      "-": () => faster(-1), "+": () => faster(1), "=": () => faster(1),
      t: () => { state.trail = !state.trail; draw(); }, c: () => { state.com = !state.com; draw(); },
      m: () => choose((state.motion + 1) % scene.motions.length), d: () => { dark = !dark; paint(); },
    };
    const act = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!act) return;
    e.preventDefault();
    act();
  });
  document.documentElement.classList.toggle("dark", dark);
  choose(Math.min(Number(hash.get("motion")) || 0, scene.motions.length - 1));
  if (hash.has("t")) seek(Number(hash.get("t")) || 0);
  if (hash.has("play")) play(true);
})();
