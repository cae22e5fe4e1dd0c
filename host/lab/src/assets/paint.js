// What canvases share: colours of the style sheet, ticks, a polyline, dots.

let colours = {};
const dark = matchMedia("(prefers-color-scheme: dark)");
const redraws = new Set();
const redrawAll = () => { colours = {}; for (const redraw of redraws) redraw(); };
dark.addEventListener("change", redrawAll);
addEventListener("resize", redrawAll);
// Calls `redraw` whenever the page changes its size or its palette.
export const onLook = (redraw) => redraws.add(redraw);
const style = () => getComputedStyle(document.documentElement);
export const colour = (name) =>
  (colours[name] ??= style().getPropertyValue(`--${name}`).trim());

const roundStep = (step) => {
  const power = 10 ** Math.floor(Math.log10(step));
  return [1, 2, 5, 10].find((digit) => digit * power >= step * 0.999) * power;
};
export const ticks = (low, high, wanted) => {
  const step = roundStep((high - low) / wanted), all = [];
  if (!(step > 0)) return [[], 0];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step;
    k++) all.push(k * step);
  return [all, Math.min(8, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)))];
};
export const label = (value, decimals) => {
  const size = Math.abs(value);
  if (size >= 1e5 || (size > 0 && size < 1e-4)) return value.toExponential(1);
  return value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−");
};

export const prepare = (canvas) => {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height =
    canvas.clientHeight;
  const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "11px system-ui, sans-serif";
  return [pen, width, height];
};

// A polyline; where samples outnumber pixels, the lowest and highest of each column.
export const stroke = (pen, time, values, begin, end, x, y) => {
  pen.beginPath();
  let column = NaN, low = 0, high = 0, last = 0, broken = true;
  const flush = () => {
    if (Number.isNaN(column)) return;
    const at = column + 0.5;
    if (broken) { pen.moveTo(at, y(low)); broken = false; } else pen.lineTo(at, y(low));
    if (high !== low) pen.lineTo(at, y(high));
    pen.lineTo(at, y(last));
  };
  const dense = end - begin > 2 * Math.abs(x(time[end - 1] ?? 0) - x(time[begin] ?? 0));
  for (let k = begin; k < end; k++) {
    const v = values[k];
    if (!(Math.abs(v) < 1e12)) {
      if (dense) flush();
      column = NaN; broken = true;
      continue;
    }
    if (!dense) {
      if (broken) { pen.moveTo(x(time[k]), y(v)); broken = false;
        } else pen.lineTo(x(time[k]), y(v));
      continue;
    }
    const here = Math.floor(x(time[k]));
    if (here !== column) { flush(); column = here; low = high = v; }
    if (v < low) low = v;
    if (v > high) high = v;
    last = v;
  }
  if (dense) flush();
  pen.stroke();
};

// Dots of one quantity over another; those that `marked` holds stand out.
export const scatter = (canvas, xs, ys, { band, scale = 1, xLabel, marked, joined }) => {
  const [pen, width, height] = prepare(canvas);
  let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let k = 0; k < xs.length; k++) {
    if (!Number.isFinite(xs[k]) || !Number.isFinite(ys[k])) continue;
    left = Math.min(left, xs[k]); right = Math.max(right, xs[k]);
    low = Math.min(low, ys[k] * scale); high = Math.max(high, ys[k] * scale);
  }
  if (!(left <= right)) { pen.fillStyle = colour("soft");
    pen.fillText("not known in these logs", 60, height / 2); return; }
  const spareX = (right - left) * 0.04 || 1e-3, spareY = (high - low) * 0.06 || 1e-3;
  left -= spareX; right += spareX; low -= spareY; high += spareY;
  const x = (v) => 50 + (v - left) / (right - left) * (width - 58);
  const y = (v) => height - 34 - (v * scale - low) / (high - low) * (height - 42);
  pen.strokeStyle = colour("rule"); pen.fillStyle = colour("soft"); pen.lineWidth = 1;
  const [rows, decimals] = ticks(low, high, 4);
  pen.textAlign = "right";
  for (const v of rows) {
    pen.beginPath(); pen.moveTo(50, y(v / scale)); pen.lineTo(width - 8, y(v / scale));
      pen.stroke();
    pen.fillText(label(v, decimals), 44, y(v / scale) + 4);
  }
  pen.textAlign = "center";
  const [columns, places] = ticks(left, right, Math.max(2, width / 80));
  for (const v of columns) pen.fillText(label(v, places), x(v), height - 20);
  pen.fillStyle = colour("ink"); pen.fillText(xLabel, (50 + width) / 2, height - 5);
  if (band) {
    pen.fillStyle = colour("green"); pen.globalAlpha = 0.25;
    pen.fillRect(50, y(band), width - 58, Math.max(1, y(-band) - y(band)));
  }
  if (joined) {
    pen.strokeStyle = colour("blue"); pen.globalAlpha = 1; pen.lineWidth = 1.4;
    pen.beginPath();
    for (let k = 0; k < xs.length; k++) pen.lineTo(x(xs[k]), y(ys[k]));
    pen.stroke();
    return;
  }
  const stride = Math.max(1, Math.floor(xs.length / 6000));
  for (const pass of [0, 1]) {
    pen.fillStyle = colour(pass ? "orange" : "blue"); pen.globalAlpha = pass ? 0.75 : 0.35;
    for (let k = 0; k < xs.length; k += stride) {
      if (Boolean(marked?.[k]) !== Boolean(pass) || !Number.isFinite(xs[k] + ys[k])) continue;
      pen.fillRect(x(xs[k]) - 1, y(ys[k]) - 1, 2, 2);
    }
  }
  pen.globalAlpha = 1;
};
