// Comparison: the motion, the steps drawn, the windows, the conditions shaded, the residual.
import { ChartGroup } from "./chart.js";
import { arrays, element } from "./curves.js";
import { $, $$, base, go, inWords, panelsOf, say, send } from "./lab.js";
import { onLook, scatter } from "./paint.js";
import { residualOf, showResidual } from "./residual.js";

const curves = $("#curves");
const group = new ChartGroup(curves);
const motion = $("#motion"), other = $("#other"), slider = $("#window"), shown =
  $("#window-shown");
let known = null, shades = [], chosen = null, wanted = null, busy = false, rest = 0;
const shade = () => {
  const part = chosen === null ? null : shades[chosen];
  group.setShade((part?.stretches_s ?? []).map(([from, to]) => ({
    from, to, joint: part.joint })));
};
const load = async (horizon, moving) => {
  const query = new URLSearchParams({ motion: motion.value });
  if (other?.value) query.set("other", other.value);
  if (horizon) query.set("horizon", horizon);
  if (moving) query.set("moving", "true");
  const answer = await arrays(`${base}/curves?${query}`);
  const second = other?.selectedOptions[0]?.textContent ?? "";
  const names = [curves.dataset.name, second, "orange", "blue"];
  group.show(answer.data.time, panelsOf(answer, names), { marks: answer.meta.restarts_s });
  $("#shown-about").textContent = moving ? "about " : "";
  known = answer;
  showResidual(residualOf(known, Number($("#scatter-joint").value)));
  shades = answer.meta.shades;
  shade();
  $("#shown-error").textContent = inWords(answer.meta.rms, answer.meta.error);
  if (horizon) $("#shown-over").textContent = horizon === "whole" ? "over whole motions" :
    `over ${horizon} s`;
  $("#shown-role").textContent = answer.meta.held_out ? "held out" : "fitted";
  $("#shown-window").textContent = answer.meta.window_s ?
    `${Number(answer.meta.window_s.toPrecision(3))} s` : "whole motion";
  curves.dataset.answered = String(Math.round(performance.now()));
};
// The last wish wins.
const ask = async (horizon, moving = false) => {
  wanted = { horizon, moving };
  if (busy) return;
  busy = true;
  while (wanted) {
    const next = wanted;
    wanted = null;
    try { await load(next.horizon, next.moving); } catch (error) { say(error.message); }
  }
  busy = false;
};
// The slider is logarithmic; its right end means whole motions.
const seconds = () => {
  if (Number(slider.value) > Number(slider.max) - 0.05) return null;
  return Number((10 ** Number(slider.value)).toPrecision(2));
};
const tell = () => { const s = seconds(); shown.textContent = s === null ? "whole motions" :
  `${s} s`; };
// While it moves start states are fitted roughly; what it rests on becomes the session's.
slider?.addEventListener("input", () => {
  clearTimeout(rest); tell();
  ask(String(seconds() ?? "whole"), true);
});
const keep = async (window) => {
  try { go(await send("horizon", { window })); } catch (error) { say(error.message); }
};
slider?.addEventListener("change", () => {
  const chosen = seconds();
  clearTimeout(rest);
  rest = setTimeout(() => keep(chosen === null ? "whole" : { seconds: chosen }), 500);
});
$("#window-automatic")?.addEventListener("click", () => keep("automatic"));
for (const field of [motion, other]) field?.addEventListener("change", () => ask());
const conditions = $$("[data-condition]");
const scatters = $("#scatters");
let dots = null;
const drawDots = () => {
  if (!dots) return;
  drawXy();
  for (const canvas of $$("canvas", scatters)) {
    const { name, unit } = dots.meta.variables[Number(canvas.dataset.index)];
    const marked = chosen === null ? null : dots.data[`holds_${chosen}`];
    scatter(canvas, dots.data[name], dots.data.residual, {
      band: dots.meta.floor, scale: dots.meta.shown.error_per_si, marked,
      xLabel: unit === "1" ? name : `${name}, ${unit}` });
  }
};
const loadDots = async () => {
  dots = await arrays(`${base}/scatter?joint=${$("#scatter-joint").value}`);
  scatters.replaceChildren(...dots.meta.variables.map(({ name, unit }, index) => {
    const canvas = element("canvas", { className: "scatter" });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `residual over ${name} in ${unit}`);
    canvas.dataset.index = index;
    return element("figure", {}, element("figcaption", {
      textContent: `Residual, ${dots.meta.shown.error_unit}, over ${name}` }), canvas);
  }));
  names();
  drawDots();
};
// Any quantity over any other.
const across = $("#xy-x"), up = $("#xy-y");
const names = () => {
  const all = [{ name: "residual", unit: dots.meta.shown.error_unit }, ...dots.meta.variables];
  for (const [select, first] of [[across, 1], [up, 0]]) {
    const before = select.value;
    select.replaceChildren(...all.map(({ name, unit }) => element("option", { value: name,
      textContent: unit === "1" ? name : `${name}, ${unit}` })));
    select.value = all.some(({ name }) => name === before) ? before : all[first]?.name;
  }
};
const drawXy = () => {
  const scale = (name) => (name === "residual" ? dots.meta.shown.error_per_si : 1);
  const marked = chosen === null ? null : dots.data[`holds_${chosen}`];
  const [x, y] = [across.value, up.value], words = (select) => select.selectedOptions[0].textContent;
  scatter($("#xy"), dots.data[x].map((v) => v * scale(x)), dots.data[y], {
    band: y === "residual" ? dots.meta.floor : null, scale: scale(y), marked, xLabel: words(across) });
  $("#xy-name").textContent = `${words(up)} over ${words(across)}`;
};
for (const select of [across, up]) select.addEventListener("change", () => drawXy());
if (scatters) {
  loadDots().catch((error) => say(error.message));
  $("#scatter-joint").addEventListener("change", () => {
    loadDots().catch((error) => say(error.message));
    if (known) showResidual(residualOf(known, Number($("#scatter-joint").value)));
  });
  onLook(drawDots);
}
for (const button of conditions) {
  button.addEventListener("click", () => {
    const index = Number(button.dataset.condition);
    chosen = chosen === index ? null : index;
    for (const each of conditions) each.setAttribute("aria-pressed",
      String(Number(each.dataset.condition) === chosen));
    shade();
    drawDots();
  });
}
if (slider) tell();
ask();
