// Weights, sampling time and delay as sliders; poles and response while they move.
import { ChartGroup } from "./chart.js";
import { element } from "./curves.js";
import { colour, onLook, prepare } from "./paint.js";
import { say, send } from "./lab.js";

const base = `/s/${document.body.dataset.session}`;
const $ = (id) => document.getElementById(id);
const group = new ChartGroup($("response"));
const sliders = ["states", "speeds", "ts_s", "delay_s"];
const logs = { states: true, speeds: true, ts_s: true };
const value = (name) => {
  const raw = Number($(name).value);
  return logs[name] ? Number((10 ** raw).toPrecision(2)) : Number(raw.toFixed(4));
};
const asked = () => ({
  states: value("states"), speeds: value("speeds"), ts_s: value("ts_s"),
  delay_s: $("own-delay").checked ? null : value("delay_s"),
  // Of a robot in space.
  pose: $("pose") ? $("pose").value : null,
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
// A cell of a table; one without words is no heading, whatever it stands over.
const cell = (text, i, scope) => {
  const className = i ? "number" : "";
  return scope && text ? element("th", { textContent: text, className, scope })
    : element("td", { textContent: text, className });
};
const table = (head, rows) => element("table", {},
  element("thead", {}, element("tr", {}, ...head.map((text, i) => cell(text, i, "col")))),
  element("tbody", {}, ...rows.map((row) => element("tr", {},
    ...row.map((text, i) => cell(text, i, i ? "" : "row"))))));
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
  $("figures").replaceChildren(table(["Quantity", "Value"], lines), ...said.margins.map((part) =>
    typeof part === "string" ? element("p", { className: "note", textContent: part }) :
      table(part[0], part.slice(1))));
  $("gain").replaceChildren(table(["Input", ...said.states], said.k.map((row, i) => [said.inputs[i],
    ...row.map((v) => v.toPrecision(4))])));
  const time = Float32Array.from(said.response.time_s);
  const tones = ["blue", "orange", "green", "ink", "grey"];
  const of = (rows, name) => rows.map((row, i) => ({
    name: name(i), tone: tones[i % tones.length], values: Float32Array.from(row) }));
  group.time = null;
  group.show(time, [
    { title: "Angles from the pose", unit: said.degrees ? "deg" : "mrad", scale: said.degrees ?
      180 / Math.PI : 1e3, curves: of(said.response.angle_rad,
      (i) => said.joints[i]) },
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
// What the simulated loop does takes seconds: it is asked when the sliders have rested.
let rest = 0, verifying = false, stale = false;
const verify = async () => {
  if (verifying) { stale = true; return; }
  verifying = true;
  const place = $("verified");
  place.replaceChildren(element("p", { className: "note", textContent: "Simulating the loop …" }));
  try {
    const said = await send("verified", asked());
    if (!stale) {
      const proves = said.stabilised && !said.stays_uncontrolled;
      place.replaceChildren(...said.lines.map((textContent, i) => element("p", { textContent,
        className: i ? "" : proves ? "good" : "bad" })));
      place.dataset.answered = String(Math.round(performance.now()));
    }
  } catch (error) {
    if (!stale) place.replaceChildren(element("p", { className: "bad", textContent:
      error.message }));
  }
  verifying = false;
  if (stale) { stale = false; verify(); }
};
const ask = async () => {
  wanted = true;
  clearTimeout(rest);
  rest = setTimeout(verify, 700);
  for (const name of sliders) $(`${name}-shown`).textContent = value(name);
  const query = asked();
  const text = new URLSearchParams({ states: query.states, speeds: query.speeds, ts_s: query.ts_s,
    ...(query.delay_s === null ? {} : { delay_s: query.delay_s }),
    ...(query.pose === null ? {} : { pose: query.pose }) });
  for (const link of document.querySelectorAll("[data-file]")) link.href =
    `${base}/gains-file/${link.dataset.file}?${text}`;
  if (busy) return;
  busy = true;
  while (wanted) {
    wanted = false;
    try { show(await send("gains", asked())); say(""); } catch (error) { refuse(error); }
  }
  busy = false;
};
for (const name of sliders) $(name).addEventListener("input", ask);
if ($("pose")) $("pose").addEventListener("change", ask);
$("own-delay").addEventListener("change", () => { $("delay_s").disabled = $("own-delay").checked;
  ask(); });
onLook(drawPoles);
ask();
