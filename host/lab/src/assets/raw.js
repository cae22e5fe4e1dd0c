// A log's columns as they stand, and the stretches of it that are used.
import { ChartGroup } from "./chart.js";
import { arrays } from "./curves.js";
import { $, base, go, say, send } from "./lab.js";

const group = new ChartGroup($("#raw"));
const TONES = ["blue", "orange", "green", "ink", "grey"];
const file = $("#raw-file");
let rows = null, time = null;
// Rows that are in sight, the first and the last.
const inSight = () => {
  const [from, to] = group.view;
  let first = time.findIndex((t) => t >= from), last = time.findLastIndex((t) => t <= to);
  if (first < 0) first = 0;
  if (last < first) last = first;
  return [first, last];
};
group.onView = () => {
  if (!time) return;
  const [first, last] = inSight(), whole = first === 0 && last === rows - 1;
  $("#cut-rows").textContent = whole ? `all ${rows} rows are shown` :
    `rows ${first} to ${last} of ${rows} are shown`;
  $("#cut-keep").disabled = $("#cut-hold-out").disabled = whole;
};
const divide = async (parts) => {
  try { go(await send("divide", { file: file.value, parts })); } catch (error) {
    say(error.message); }
};
$("#cut-keep").addEventListener("click", () => divide([{ rows: inSight(), held_out: false }]));
$("#cut-hold-out").addEventListener("click", () => {
  const [first, last] = inSight(), parts = [];
  if (first > 1) parts.push({ rows: [0, first - 1], held_out: false });
  parts.push({ rows: [first, last], held_out: true });
  if (last < rows - 2) parts.push({ rows: [last + 1, rows - 1], held_out: false });
  divide(parts);
});
$("#cut-whole").addEventListener("click", () => divide([{ rows: null, held_out: false }]));
const show = async () => {
  const { meta, data } = await arrays(`${base}/raw?file=${encodeURIComponent(file.value)}`);
  const panels = meta.names.map((name, i) => ({
    title: name, unit: "", small: true,
    curves: [{ name: "", tone: TONES[i % TONES.length], values: data[`column_${i}`] }],
  })).filter((_, i) => i !== meta.time);
  group.panels = [];
  group.time = null;
  time = data.time;
  rows = time.length;
  group.show(time, panels);
  group.setShade(meta.parts.filter((part) => part.held_out).map(({ rows: own }) => ({
    from: time[own?.[0] ?? 0], to: time[own?.[1] ?? rows - 1] })));
  const parts = meta.parts.filter((part) => part.rows);
  $("#cut-whole").disabled = !parts.length;
  group.onView();
};
file.addEventListener("change", () => show().catch((error) => say(error.message)));
show().catch((error) => say(error.message));
