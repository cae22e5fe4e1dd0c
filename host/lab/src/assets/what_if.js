// Sliders for every value of the model and every effect of the library.
import { ChartGroup } from "./chart.js";
import { arrays, element } from "./curves.js";
import { go, inWords, mark, meant, panelsOf, say, send } from "./lab.js";

const base = `/s/${document.body.dataset.session}`;
const root = document.getElementById("curves"), motion = document.getElementById("motion");
const group = new ChartGroup(root);
const library = JSON.parse(document.getElementById("library").textContent);
const values = new Map(), added = [];
let plain = null, wanted = null, busy = false, fitting = false, overtaken = null;

const draw = (changed) => {
  const data = { ...plain.data, ...(changed?.data ?? {}) };
  group.show(data.time, panelsOf({ meta: plain.meta, data }, ["as it is", "what if",
    "orange", "blue"]), { marks: plain.meta.restarts_s });
  document.getElementById("error-was").textContent = inWords(plain.meta.rms, plain.meta.error);
  document.getElementById("error-if").textContent = inWords(changed?.meta.rms ?? plain.meta.rms,
    plain.meta.error);
  keepAside();
};
// What is not kept yet is there again when the page is, as long as the model is the same.
const place = `what-if ${base} ${document.body.dataset.model}`;
const keepAside = () => {
  if (values.size || added.length) sessionStorage.setItem(place, JSON.stringify({
    effects: added.map(({ name }) => name), values: [...values] }));
  else sessionStorage.removeItem(place);
};
const tried = (moving = false) => ({
  motion: Number(motion.value), moving,
  effects: added.map((effect) => effect.name), values: [...values],
});
const run = (moving) => arrays(`${base}/what-if`, {
  method: "POST", signal: overtaken.signal, headers: meant(),
  body: JSON.stringify(tried(moving)),
});
// One request at a time: while it runs only the last wish is kept. While a slider moves, windows
// start where they do for the model as it is; when it has rested a moment, their starts are fitted
// again, which a slider that moves on does not wait for.
let rest = 0;
const settle = () => { clearTimeout(rest); rest = setTimeout(() => ask(false), 250); };
const ask = async (moving = false) => {
  wanted = { moving };
  if (busy) {
    if (fitting) overtaken.abort();
    return;
  }
  busy = true;
  while (wanted) {
    const next = wanted;
    wanted = null;
    fitting = !next.moving;
    overtaken = new AbortController();
    const begun = performance.now();
    try {
      draw(values.size || added.length ? await run(next.moving) : null);
      document.getElementById("error-about").textContent = next.moving ? "about " : "";
      say(restored ? "The sliders are where you left them; nothing of it is kept yet." : "", false);
      restored = false;
    } catch (error) { if (error.name === "AbortError") continue; say(error.message); }
    root.dataset.answered = String(Math.round(performance.now() - begun));
  }
  busy = false;
};
const load = async () => {
  plain = await arrays(`${base}/curves?motion=${motion.value}`);
  await ask();
};

// The slider runs from `low` to `high`, by the logarithm where both are above 0 and far apart.
const sliders = new Map();
const slider = ({ path, name, unit, low, high, value, meaning }) => {
  const logarithmic = low > 0 && high / low >= 8;
  const to = (v) => (logarithmic ? Math.log(v / low) / Math.log(high / low) :
    (v - low) / (high - low));
  const from = (s) => (logarithmic ? low * (high / low) ** s : low + s * (high - low));
  const id = `value-${path.replaceAll(/[^a-z0-9]/gi, "-")}`;
  const range = element("input", { type: "range", min: 0, max: 1000, step: 1, id, value:
    Math.round(1000 * to(value)) });
  const number = element("input", { type: "number", step: "any", value:
    Number(value.toPrecision(5)) });
  number.setAttribute("aria-label", `${name}, ${unit}`);
  number.dataset.field = path;
  range.dataset.path = path;
  const set = (v, moving) => { clearTimeout(rest); values.set(path, v); ask(moving); };
  range.addEventListener("input", () => {
    const v = Number(from(range.value / 1000).toPrecision(4));
    number.value = v;
    set(v, true);
  });
  range.addEventListener("change", settle);
  number.addEventListener("change", () => {
    const v = Number(number.value);
    if (!Number.isFinite(v)) return;
    range.value = Math.round(1000 * to(v));
    set(v, false);
  });
  sliders.set(path, (v) => { number.value = Number(v.toPrecision(5)); range.value =
    Math.round(1000 * to(v)); });
  const label = element("label", { htmlFor: id, title: meaning ? `${path}: ${meaning}` : path },
    name);
  return element("div", { className: "slider" }, label, number, element("span", {
    className: "unit", textContent: unit }), range);
};
const box = document.getElementById("sliders");
for (const given of library.values) box.append(slider(given));
const picker = document.getElementById("effect");
const addEffect = (name) => {
  const effect = library.effects.find((each) => each.name === name);
  if (!effect || added.includes(effect)) return;
  added.push(effect);
  const fields = effect.values.map((value) => { values.set(value.path, value.value);
    return slider(value); });
  const drop = element("button", { type: "button", textContent: "Take out" });
  drop.setAttribute("aria-label", `Take ${effect.name} out`);
  const set = element("fieldset", {}, element("legend", {
    textContent: `${effect.title} (${effect.name})` }),
    element("p", { className: "note" }, element("code", {
      textContent: effect.law })), ...fields, drop);
  drop.addEventListener("click", () => {
    added.splice(added.indexOf(effect), 1);
    for (const value of effect.values) values.delete(value.path);
    set.remove();
    ask();
  });
  box.prepend(set);
  return set;
};
document.getElementById("add-effect").addEventListener("click", () => {
  const set = addEffect(picker.value);
  if (!set) return;
  set.querySelector("input")?.focus();
  ask();
});
document.getElementById("keep").addEventListener("click", async () => {
  try {
    const said = await send("keep", tried());
    sessionStorage.removeItem(place);
    go(said);
  } catch (error) { say(error.message); mark(error, box); }
});
document.getElementById("reset").addEventListener("click", () => {
  sessionStorage.removeItem(place);
  location.reload();
});
const before = JSON.parse(sessionStorage.getItem(place) ?? "null");
if (before) {
  for (const name of before.effects) addEffect(name);
  for (const [path, value] of before.values) if (sliders.has(path)) {
    values.set(path, value);
    sliders.get(path)(value);
  }
}
let restored = values.size > 0 || added.length > 0;
motion.addEventListener("change", () => load().catch((error) => say(error.message)));
load().catch((error) => say(error.message));
