// Weights, sampling time and delay as sliders; poles and response while they move.
import { ChartGroup } from "./chart.js";
import { element } from "./curves.js";
import { colour, onLook, prepare } from "./paint.js";
import { say, send } from "./lab.js";

const base = `/s/${document.body.dataset.session}`;
const $ = (id) => document.getElementById(id);
const group = new ChartGroup($("response"));
const shown = { q: (v) => v, r: (v) => v, ts_s: (v) => v, delay_s: (v) => v };
const logs = { q: true, r: true, ts_s: true };
const value = (name) => {
  const raw = Number($(name).value);
  return logs[name] ? Number((10 ** raw).toPrecision(2)) : Number(raw.toFixed(4));
};
const asked = (region = false) => ({
  q: value("q"), r: value("r"), ts_s: value("ts_s"),
  delay_s: $("own-delay").checked ? null : value("delay_s"), region,
});
let poles = [], wanted = false, busy = false;

const drawPoles = () => {
  const [pen, width, height] = prepare($("poles"));
  const reach = Math.max(1.1, ...poles.map(([re, im]) => Math.hypot(re, im) * 1.1));
  const scale = Math.min(width, height) / 2 / reach, x = (v) => width / 2 + v * scale, y = (v) =>
    height / 2 - v * scale;
  pen.strokeStyle = colour("rule"); pen.lineWidth = 1;
  pen.beginPath(); pen.moveTo(0, y(0)); pen.lineTo(width, y(0)); pen.moveTo(x(0), 0);
    pen.lineTo(x(0), height); pen.stroke();
  pen.strokeStyle = colour("soft"); pen.beginPath(); pen.arc(x(0), y(0), scale, 0, 2 * Math.PI);
    pen.stroke();
  pen.lineWidth = 2;
  for (const [re, im] of poles) {
    pen.strokeStyle = colour(Math.hypot(re, im) < 1 ? "blue" : "orange");
    pen.beginPath(); pen.moveTo(x(re) - 5, y(im) - 5); pen.lineTo(x(re) + 5, y(im) + 5);
    pen.moveTo(x(re) + 5, y(im) - 5); pen.lineTo(x(re) - 5, y(im) + 5); pen.stroke();
  }
};
const table = (head, rows) => element("table", {},
  element("thead", {}, element("tr", {}, ...head.map((text, i) => element("th", {
    textContent: text, className: i ? "number" : "" })))),
  element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((text, i) => element(i ?
    "td" : "th", { textContent: text, className: i ? "number" : "" }))))));
const show = (said) => {
  poles = said.poles;
  drawPoles();
  const slowest = Math.max(...poles.map(([re, im]) => Math.hypot(re, im)));
  const lines = [["Largest pole, magnitude", slowest.toPrecision(6)]];
  if (said.fixed) {
    lines.push([`The same in ${said.fixed.bits}-bit fixed point`,
      said.fixed.radius_fixed.toPrecision(6)]);
    lines.push(["Bits to spare before overflow", Math.min(...said.fixed.margin_bits).toFixed(1)]);
    lines.push(["Largest change of an input by rounded gains",
      Math.max(...said.fixed.gain_error).toPrecision(3)]);
  }
  if (said.omitted.length) lines.push(["Left out of the design, kept in the response",
    said.omitted.join(", ")]);
  if (said.region_rad !== null) {
    lines.push(["Starts that 95 % are stabilised from",
      `${said.region_open ? "at least" : "within"} ${
        (said.region_rad * 180 / Math.PI).toFixed(2)}°`]);
    lines.push(["Stabilised from half a degree", said.stabilised ? "yes" : "no"]);
    lines.push(["It stays without control, too", said.stays_uncontrolled ? "yes" : "no"]);
  }
  $("figures").replaceChildren(table(["Quantity", "Value"], lines));
  $("gain").replaceChildren(table(["Input", ...said.states], said.k.map((row, i) => [said.inputs[i],
    ...row.map((v) => v.toPrecision(4))])));
  const time = Float32Array.from(said.response.time_s);
  const tones = ["blue", "orange", "green", "ink", "grey"];
  const of = (rows, name) => rows.map((row, i) => ({
    name: name(i), tone: tones[i % tones.length], values: Float32Array.from(row) }));
  group.time = null;
  group.show(time, [
    { title: "Angles from the pose", unit: "mrad", scale: 1e3, curves: of(said.response.angle_rad,
      (i) => `joint ${i + 1}`) },
    { title: "Commands", unit: "", small: true, curves: of(said.response.command, (i) =>
      said.inputs[i]) },
  ]);
  $("gains-command").textContent = said.command;
  $("response").dataset.answered = String(Math.round(performance.now()));
};
// What stands there is of another design.
const refuse = (error) => {
  say(error.message);
  poles = [];
  drawPoles();
  $("figures").replaceChildren(element("p", { className: "bad", textContent: error.message }));
  $("gain").replaceChildren();
  group.show(new Float32Array(), []);
  for (const link of document.querySelectorAll("[data-file]")) link.removeAttribute("href");
};
const ask = async (region) => {
  wanted = { region };
  for (const name of Object.keys(shown)) $(`${name}-shown`).textContent = value(name);
  const query = asked();
  const text = new URLSearchParams({ q: query.q, r: query.r, ts_s: query.ts_s,
    ...(query.delay_s === null ? {} : { delay_s: query.delay_s }) });
  for (const link of document.querySelectorAll("[data-file]")) link.href =
    `${base}/gains-file/${link.dataset.file}?${text}`;
  if (busy) return;
  busy = true;
  while (wanted) {
    const next = wanted;
    wanted = null;
    try { show(await send("gains", asked(next.region))); say(""); } catch (error) {
      refuse(error); }
  }
  busy = false;
};
for (const name of Object.keys(shown)) $(name).addEventListener("input", () => ask(false));
$("own-delay").addEventListener("change", () => { $("delay_s").disabled = $("own-delay").checked;
  ask(false); });
$("find-region").addEventListener("click", () => ask(true));
onLook(drawPoles);
ask(false);
