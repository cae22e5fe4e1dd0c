// The residual by itself: how it remembers, and at which frequencies it lies.
import { $ } from "./lab.js";
import { onLook, scatter } from "./paint.js";

// The longest lag and the longest stretch of a spectrum, samples.
const LAGS = 200, STRETCH = 1024;
let shown = null;

// Residual of a joint of the motion that is drawn, with the middle step of its time.
export const residualOf = ({ meta, data }, joint) => {
  const steps = [...data.time.subarray(1)].map((t, k) => t - data.time[k]).sort((a, b) => a - b);
  const measured = data[`measured_${joint}`], predicted = data[`predicted_${joint}`];
  const values = [...measured].map((angle, k) => (angle - predicted[k]) *
    meta.shown[joint].error_per_si);
  return { values: values.filter(Number.isFinite), step_s: steps[steps.length >> 1] || 1, unit:
    meta.shown[joint].error_unit, motion: meta.motion };
};

const centred = (values) => {
  const mean = values.reduce((sum, v) => sum + v, 0) / (values.length || 1);
  return values.map((v) => v - mean);
};

// Autocorrelation at lags 1, 2, ..; white noise stays within 1.96 / sqrt(n) in 95 of 100 lags.
export const autocorrelation = (given) => {
  const values = centred(given), power = values.reduce((sum, v) => sum + v * v, 0);
  const lags = Math.min(LAGS, Math.floor(values.length / 4));
  return Array.from({ length: lags }, (_, lag) => {
    let sum = 0;
    for (let k = lag + 1; k < values.length; k++) sum += values[k] * values[k - lag - 1];
    return power > 0 ? sum / power : 0;
  });
};

// In place, for a power of two (Cooley and Tukey).
const transform = (re, im) => {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) { [re[i], re[j]] = [re[j], re[i]]; [im[i], im[j]] = [im[j], im[i]]; }
  }
  for (let size = 2; size <= n; size *= 2) {
    for (let at = 0; at < n; at += size) {
      for (let k = 0; k < size / 2; k++) {
        const turn = -2 * Math.PI * k / size, c = Math.cos(turn), s = Math.sin(turn);
        const a = at + k, b = a + size / 2;
        const [x, y] = [re[b] * c - im[b] * s, re[b] * s + im[b] * c];
        re[b] = re[a] - x; im[b] = im[a] - y; re[a] += x; im[a] += y;
      }
    }
  }
};

// Amplitude density over frequency: stretches under a Hann window, half over each other, averaged
// (Welch 1967). `[frequencies in Hz, density in unit / sqrt(Hz)]`.
export const spectrum = (given, step_s) => {
  const values = centred(given);
  const size = Math.min(STRETCH, 2 ** Math.floor(Math.log2(values.length || 1)));
  if (size < 8) return [[], []];
  const weight = (k) => 0.5 - 0.5 * Math.cos(2 * Math.PI * k / size);
  const weights = Array.from({ length: size }, (_, k) => weight(k));
  const energy = weights.reduce((sum, w) => sum + w * w, 0);
  const power = new Float64Array(size / 2);
  let count = 0;
  for (let at = 0; at + size <= values.length; at += size / 2) {
    const re = weights.map((w, k) => w * values[at + k]), im = new Array(size).fill(0);
    transform(re, im);
    for (let k = 0; k < size / 2; k++) power[k] += 2 * (re[k] ** 2 + im[k] ** 2) * step_s / energy;
    count++;
  }
  const bins = Array.from({ length: size / 2 - 1 }, (_, k) => k + 1);
  return [bins.map((k) => k / size / step_s), bins.map((k) => Math.sqrt(power[k] / count))];
};

const draw = () => {
  if (!shown) return;
  const { values, step_s, unit, motion } = shown;
  const lags = autocorrelation(values);
  scatter($("#acf"), lags.map((_, k) => (k + 1) * step_s), lags, { band: 1.96 /
    Math.sqrt(values.length || 1), xLabel: "lag, s", joined: true });
  const [hz, density] = spectrum(values, step_s);
  scatter($("#spectrum"), hz, density, { xLabel: "frequency, Hz", joined: true });
  $("#acf-name").textContent = `Autocorrelation of ${motion}; shaded: 95 % of white noise`;
  const loudest = hz[density.indexOf(Math.max(...density))];
  $("#spectrum-name").textContent = `Spectrum, ${unit}/√Hz` + (loudest ?
    `; most at ${Number(loudest.toPrecision(3))} Hz` : "");
};
export const showResidual = (residual) => { shown = residual; draw(); };
onLook(draw);
