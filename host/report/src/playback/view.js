"use strict";
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const $ = (id) => document.getElementById(id);
  const chart = $("chart"), scrub = $("scrub");
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
  const fit = (canvas) => {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, box.width, box.height);
    return [pen, box.width, box.height];
  };
  // Half black, half white, as on drawings.
  const massMark = (pen, [x, y], r) => {
    pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI);
    pen.fillStyle = colour("--paper"); pen.fill();
    pen.fillStyle = colour("--limb-edge");
    for (const turn of [0, Math.PI]) { pen.beginPath(); pen.moveTo(x, y); pen.arc(x, y, r, turn, turn + Math.PI / 2); pen.fill(); }
    pen.beginPath(); pen.arc(x, y, r, 0, 2 * Math.PI);
    pen.strokeStyle = colour("--limb-edge"); pen.lineWidth = 1; pen.stroke();
  };

  const player = { scene, state, motion, colour, toneOf, before, between };
  Object.assign(player, { fit, massMark, TRAIL_S, redraw: () => drawStage() });
  const picture = (scene.tree ? spaceStage : planarStage)(player);
  const drawStage = picture.draw;

  // What people read of a joint: factor, unit, its mark behind a number, decimals of that.
  const SHOWN = { hinge: [180 / Math.PI, "deg", "°", 2], slide: [1000, "mm", " mm", 1] };
  const shownAs = (joint) => SHOWN[scene.joints[joint].slides ? "slide" : "hinge"];

  // Joints side by side, of a robot in space in rows: each its own small chart with all tracks.
  const PAD = { left: 44, right: 10, top: 18, bottom: 20, gap: 50 };
  const LEAST = 120, ROW_REM = 6.4;
  const columns = (width) => {
    const count = scene.joints.length;
    const fitting = Math.floor((width - PAD.left - PAD.right + PAD.gap) / (LEAST + PAD.gap));
    const most = scene.tree ? Math.max(1, Math.min(count, fitting)) : count;
    return Math.ceil(count / Math.ceil(count / most));
  };
  const rows = (width) => Math.ceil(scene.joints.length / columns(width));
  // Left edge, width, top and height of each.
  const panels = (width, height) => {
    const count = columns(width), tall = height / rows(width);
    const each = (width - PAD.left - PAD.right - PAD.gap * (count - 1)) / count;
    return scene.joints.map((_, i) =>
      [PAD.left + (i % count) * (each + PAD.gap), each, Math.floor(i / count) * tall, tall]);
  };
  const fitted = (pen, text, width) => {
    if (pen.measureText(text).width <= width) return text;
    let length = text.length;
    while (length > 1 && pen.measureText(`${text.slice(0, length)}…`).width > width) length--;
    return `${text.slice(0, length)}…`;
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
    const lines = rows(chart.getBoundingClientRect().width);
    chart.style.height = lines > 1 ? `${lines * ROW_REM}rem` : "";
    const [pen, width, height] = fit(chart), total = end();
    pen.font = "11px system-ui, sans-serif";
    panels(width, height).forEach(([left, each, above, tall], joint) => {
      const [deg, unit] = shownAs(joint), top = above + PAD.top, bottom = above + tall - PAD.bottom;
      let low = Infinity, high = -Infinity;
      motion().tracks.forEach((track, i) => {
        if (!state.shown[i] && i > 0) return;
        for (const v of track.joint_rad[joint]) if (v !== null) { low = Math.min(low, v * deg); high = Math.max(high, v * deg); }
      });
      if (!(high > low)) { low = (Number.isFinite(low) ? low : 0) - 1; high = low + 2; }
      const spare = 0.06 * (high - low); low -= spare; high += spare;
      const X = (t) => left + t / total * each, Y = (v) => bottom - (v - low) / (high - low) * (bottom - top);
      pen.strokeStyle = colour("--rule"); pen.fillStyle = colour("--soft"); pen.lineWidth = 1; pen.textAlign = "right";
      const [levels, decimals] = ticks(low, high, 4);
      for (const v of levels) {
        pen.beginPath(); pen.moveTo(left, Y(v)); pen.lineTo(left + each, Y(v)); pen.stroke();
        pen.fillText(v.toFixed(decimals), left - 6, Y(v) + 4);
      }
      pen.textAlign = "center";
      const [times, places] = ticks(0, total, Math.max(2, Math.floor(each / 70)));
      for (const t of times) pen.fillText(t.toFixed(places), X(t), above + tall - 6);
      pen.textAlign = "left"; pen.fillStyle = colour("--ink");
      const title = `${scene.joints[joint].name}, ${unit}`;
      pen.fillText(fitted(pen, title, each + PAD.gap / 2), left, above + 11);
      pen.save(); pen.beginPath(); pen.rect(left, above, each, tall); pen.clip();
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
        if (i > 0 && name === "td") cell.style.borderBottom = `2px solid var(${toneOf(shown[i - 1])})`;
        return cell;
      }));
      return row;
    };
    const kinds = { measured: "measured", model: "model", overlay: "overlay" };
    $("angles").replaceChildren(
      cells("th", [scene.tree ? "Joint" : "Angle", ...shown.map((track) => kinds[track.kind])]),
      ...scene.joints.map(({ name }, joint) => cells("td", [name, ...shown.map((track) => {
        const [scale, , mark, places] = shownAs(joint);
        const [value] = between(track, [track.joint_rad[joint]], state.time);
        return number(value * scale, places) + mark;
      })])));
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
    $("drives").classList.toggle("many", motion().inputs.length > 6);
    $("drives").replaceChildren(...motion().inputs.map((input) => {
      const node = document.createElement("div");
      node.className = "drive";
      node.innerHTML = `<div><span></span><b></b></div>
        <svg viewBox="0 0 200 10" preserveAspectRatio="none"><rect width="200" height="10" rx="2" fill="var(--grid)"/>
        <rect class="level" y="0" height="10" fill="var(--blue)"/><line x1="100" x2="100" y2="10" stroke="var(--soft)"/></svg>`;
      const { name } = scene.joints[input.joint - 1];
      node.querySelector("span").textContent = `${name}, ${input.what}`;
      return node;
    }));
    picture.measure(); legend(); draw();
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
    const y = Math.min(Math.max(e.clientY - box.top, 0), box.height);
    const panel = panels(box.width, box.height).find(([left, each, top, tall]) =>
      x >= left - PAD.gap / 2 && x <= left + each + PAD.gap / 2 && y >= top && y <= top + tall);
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
      ...picture.keys,
    };
    const act = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!act) return;
    e.preventDefault();
    act(e);
  });
  document.documentElement.classList.toggle("dark", dark);
  choose(Math.min(Number(hash.get("motion")) || 0, scene.motions.length - 1));
  if (hash.has("t")) seek(Number(hash.get("t")) || 0);
  if (hash.has("play")) play(true);
})();
