// What every page does: forms that say what went wrong, progress, files, curves.
import { ChartGroup } from "./chart.js";
import { arrays, element, problem } from "./curves.js";
import { onLook, scatter } from "./paint.js";

const base = `/s/${document.body.dataset.session}`;
const $ = (selector, within = document) => within.querySelector(selector);
const $$ = (selector, within = document) => [...within.querySelectorAll(selector)];

export const say = (text, bad = true) => {
  const message = $("#message");
  message.className = bad ? "bad-news" : "good-news";
  message.textContent = text;
  if (text && bad) message.scrollIntoView({ block: "nearest" });
};
export const send = async (path, data = {}) => {
  const answer = await fetch(path.startsWith("/") ? path : `${base}/${path}`, {
    method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(data),
  });
  if (!answer.ok) throw await problem(answer);
  return answer.json();
};
export const go = (said) => {
  if (!said.go) return;
  sessionStorage.setItem("scroll", JSON.stringify([said.go, scrollY]));
  if (location.pathname === said.go) location.reload(); else location.assign(said.go);
};
const kept = JSON.parse(sessionStorage.getItem("scroll") ?? "[]");
sessionStorage.removeItem("scroll");
if (kept[0] === location.pathname) scrollTo(0, kept[1]);

// What the page did not wait for: the error in force, what the check finds.
const fill = async (selector, path, otherwise) => {
  const place = $(selector);
  if (!place) return;
  const answer = await fetch(`${base}/${path}`);
  if (answer.ok) place.outerHTML = await answer.text(); else place.textContent = otherwise;
};
fill("#error-wanted", "error", "Error: the logs cannot be read by this model").catch(() => {});
fill("#horizons-wanted", "horizons", "It came to no end.").catch(() => {});
fill("#findings-wanted", "findings", "The check came to no end.").catch(() => {});

// A form sends its fields as JSON; `data-number` ones as numbers.
for (const form of $$("form[data-send]")) {
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const data = {};
    for (const field of form.elements) {
      if (!field.name || (field.type === "radio" && !field.checked)) continue;
      if (field.type === "checkbox") data[field.name] = field.checked;
      else if (field.dataset.number !== undefined) data[field.name] = field.value === "" ? null :
        Number(field.value);
      else data[field.name] = field.value;
    }
    if (event.submitter?.name) data[event.submitter.name] = event.submitter.value;
    say("");
    try {
      const said = await send(form.dataset.send, data);
      if (form.dataset.said) say(form.dataset.said, false);
      if (said.begun) watch(); else go(said);
    } catch (error) { say(error.message); }
  });
}
for (const field of $$("[data-submit]")) field.addEventListener("change", () =>
  field.form.requestSubmit());

// Progress of long work.
let events = null;
const watch = () => {
  const box = $("#progress");
  if (!box || events) return;
  events = new EventSource(`${base}/progress`);
  let ran = false;
  events.onmessage = ({ data }) => {
    const state = JSON.parse(data);
    box.hidden = state.state !== "running";
    if (state.state === "running") {
      ran = true;
      const bar = $("progress", box);
      if (state.total > 0) { bar.max = state.total; bar.value = state.done;
        } else bar.removeAttribute("value");
      $("#what", box).textContent = state.total > 0 ?
        `${state.what}: ${state.done} of ${state.total}` : state.what;
      for (const button of $$("[data-work]")) button.disabled = true;
    } else if (ran) {
      events.close(); events = null;
      for (const button of $$("[data-work]")) button.disabled = false;
      if (state.state === "done") go({ go: location.pathname });
      else if (state.state === "failed") say(`${state.error}. ${state.remedy}.`);
      else say("Stopped. Nothing was changed.", false);
    }
  };
};
if (document.body.dataset.running !== undefined) watch();
$("#stop")?.addEventListener("click", () => send("stop").catch((error) => say(error.message)));

// Logs that are dropped or chosen.
const MOST = Number($("#files")?.dataset.most ?? 0);
const bring = async (files) => {
  let last = null;
  for (const file of files) {
    if (file.size > MOST) {
      const [has, most] = [file.size, MOST].map((bytes) => Math.round(bytes / 2 ** 20));
      say(`${file.name} has ${has} MiB; a log may have up to ${most} MiB.`);
      return;
    }
    say(`Bringing ${file.name} …`, false);
    const answer = await fetch(`${base}/upload?name=${encodeURIComponent(file.name)}`, {
      method: "POST", body: file });
    if (!answer.ok) { say((await problem(answer)).message); return; }
    last = await answer.json();
  }
  if (last) go(last);
};
const drop = $("#drop");
if (drop) {
  $("#files").addEventListener("change", (event) => bring(event.target.files).catch((error) =>
    say(error.message)));
  for (const kind of ["dragenter", "dragover"]) {
    addEventListener(kind, (event) => { event.preventDefault(); drop.classList.add("over"); });
  }
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) drop.classList.remove("over"); });
  addEventListener("drop", (event) => {
    event.preventDefault(); drop.classList.remove("over");
    bring(event.dataTransfer.files).catch((error) => say(error.message));
  });
}

// Copies a command.
for (const button of $$("[data-copy]")) {
  button.addEventListener("click", async () => {
    await navigator.clipboard.writeText($(button.dataset.copy).textContent);
    button.textContent = "Copied";
  });
}

// A log's columns as they stand.
const raw = $("#raw");
if (raw) {
  const group = new ChartGroup(raw);
  const TONES = ["blue", "orange", "green", "ink", "grey"];
  const file = $("#raw-file");
  const show = async () => {
    const { meta, data } = await arrays(`${base}/raw?file=${encodeURIComponent(file.value)}`);
    const panels = meta.names.map((name, i) => ({
      title: name, unit: "", small: true,
      curves: [{ name: "", tone: TONES[i % TONES.length], values: data[`column_${i}`] }],
    })).filter((_, i) => i !== meta.time);
    group.panels = [];
    group.time = null;
    group.show(data.time, panels);
  };
  file.addEventListener("change", () => show().catch((error) => say(error.message)));
  show().catch((error) => say(error.message));
}

// Panels of measured and predicted angles, residuals below.
export const panelsOf = ({ meta, data }, names) => {
  const panels = [];
  for (let joint = 0; joint < meta.joints; joint++) {
    const measured = data[`measured_${joint}`], predicted = data[`predicted_${joint}`], other =
      data[`other_${joint}`];
    const left = (values) => values && measured.map((angle, k) => angle - values[k]);
    const angles = [{ name: "measured", tone: "ink", values: measured, wide: true }, {
      name: names[0], tone: names[2] ?? "orange", values: predicted }];
    const residuals = [{ name: names[0], tone: names[2] ?? "orange", values: left(predicted) }];
    if (other) {
      angles.push({ name: names[1], tone: names[3] ?? "blue", values: other });
      residuals.push({ name: names[1], tone: names[3] ?? "blue", values: left(other) });
    }
    const quantity = meta.units[joint] === "rad/s" ? "Rate" : "Angle";
    const title = meta.joints > 1 ? `${quantity} of joint ${joint + 1}` : quantity;
    panels.push({ title, unit: meta.units[joint], joint, curves: angles });
    panels.push({ title: meta.joints > 1 ? `Residual of joint ${joint + 1}` : "Residual", unit:
      `m${meta.units[joint]}`, small: true, scale: 1e3, band: meta.floor[joint], joint, curves:
      residuals });
    const input = data[`input_${joint}`];
    if (input) panels.push({ title:
      `Input${meta.joints > 1 ? ` of joint ${joint + 1}` : ""}: ${meta.inputs[joint].name}`, unit:
      meta.inputs[joint].unit.replace(/^1$/, ""), small: true, curves: [{
      name: "input", tone: "grey", values: input }] });
  }
  return panels;
};
export const milli = (value, unit) => {
  const thousandths = 1e3 * value;
  const large = Math.abs(thousandths) >= 100;
  const shown = large ? Math.round(thousandths) : Number(thousandths.toPrecision(3));
  return `${shown} m${unit}`;
};

// Comparison: the motion, the steps drawn, the windows, the conditions shaded.
const curves = $("#curves");
if (curves && curves.dataset.kind !== "what-if") {
  const group = new ChartGroup(curves);
  const motion = $("#motion"), other = $("#other"), slider = $("#window"), shown =
    $("#window-shown");
  let shades = [], chosen = null, wanted = null, busy = false;
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
    const names = [curves.dataset.name, other?.selectedOptions[0]?.textContent ?? "", "orange",
      "blue"];
    group.show(answer.data.time, panelsOf(answer, names), { marks: answer.meta.restarts_s });
    $("#shown-about").textContent = moving ? "about " : "";
    shades = answer.meta.shades;
    shade();
    $("#shown-error").textContent = milli(answer.meta.rms, answer.meta.unit);
    $("#shown-role").textContent = answer.meta.held_out ? "held out" : "fitted";
    $("#shown-window").textContent = answer.meta.window_s ?
      `${Number(answer.meta.window_s.toPrecision(3))} s` : "whole motion";
    curves.dataset.answered = String(Math.round(performance.now()));
  };
  // One request at a time: the last wish wins.
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
  let rest = 0;
  slider?.addEventListener("input", () => {
    clearTimeout(rest);
    tell();
    ask(String(seconds() ?? "whole"), true);
  });
  slider?.addEventListener("change", () => {
    const keep = async () => {
      const chosen = seconds();
      try { go(await send("horizon", { window: chosen === null ? "whole" : { seconds: chosen } }));
        } catch (error) { say(error.message); }
    };
    clearTimeout(rest);
    rest = setTimeout(keep, 500);
  });
  $("#window-automatic")?.addEventListener("click", async () => {
    try { go(await send("horizon", { window: "automatic" })); } catch (error) { say(error.message);
      }
  });
  motion.addEventListener("change", () => ask());
  other?.addEventListener("change", () => ask());
  const conditions = $$("[data-condition]");
  const scatters = $("#scatters");
  let dots = null;
  const drawDots = () => {
    if (!dots) return;
    for (const canvas of $$("canvas", scatters)) {
      const { name, unit } = dots.meta.variables[Number(canvas.dataset.index)];
      const marked = chosen === null ? null : dots.data[`holds_${chosen}`];
      scatter(canvas, dots.data[name], dots.data.residual, {
        band: dots.meta.floor, scale: 1e3, xLabel: unit === "1" ? name : `${name}, ${unit}`, marked });
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
        textContent: `Residual, m${dots.meta.unit}, over ${name}` }), canvas);
    }));
    drawDots();
  };
  if (scatters) {
    loadDots().catch((error) => say(error.message));
    $("#scatter-joint").addEventListener("change", () => loadDots().catch((error) =>
      say(error.message)));
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
}
