// What every page does: forms that say what went wrong, progress, files, curves.
import { problem } from "./curves.js";

export const base = `/s/${document.body.dataset.session}`;
export const $ = (selector, within = document) => within.querySelector(selector);
export const $$ = (selector, within = document) => [...within.querySelectorAll(selector)];

export const say = (text, bad = true) => {
  const message = $("#message");
  message.className = bad ? "bad-news" : "good-news";
  message.textContent = text;
  if (text && bad) message.scrollIntoView({ block: "nearest" });
};
// What is sent is meant for the model that this page shows: another tab may have gone on.
export const meant = () => ({ "content-type": "application/json",
  "handstand-model": document.body.dataset.model ?? "" });
// Marks the field or the line that an error names: `mass_kg = -1`, `model.toml:11:11`.
export const mark = (error, form) => {
  for (const field of form?.querySelectorAll("[aria-invalid]") ?? [])
    field.removeAttribute("aria-invalid");
  if (!error || !form) return;
  const text = form.querySelector("textarea");
  const [, line, column] = /:(\d+):(\d+)/.exec(error.message) ?? [];
  if (text && line) {
    const before = text.value.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0);
    const end = text.value.indexOf("\n", before);
    text.setAttribute("aria-invalid", "true");
    text.focus();
    text.setSelectionRange(before + Number(column) - 1, end < 0 ? text.value.length : end);
    text.scrollTop = text.scrollHeight * (line - 3) / text.value.split("\n").length;
    return;
  }
  const named = [...form.querySelectorAll("[name], [data-field]")].filter((field) => {
    const name = field.dataset.field ?? field.name;
    return name && new RegExp(`\\b${name}\\b`).test(error.message);
  });
  // Of several joints' fields the one whose value the error repeats.
  const said = named.filter((field) => field.value !== "" &&
    new RegExp(`= ?${field.value.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}(\\b|$|[ ,])`)
      .test(error.message));
  const marked = said.length ? said : named.slice(0, 1);
  for (const field of marked) field.setAttribute("aria-invalid", "true");
  marked[0]?.focus();
};
export const send = async (path, data = {}) => {
  const answer = await fetch(path.startsWith("/") ? path : `${base}/${path}`, {
    method: "POST", headers: meant(), body: JSON.stringify(data),
  });
  if (!answer.ok) throw await problem(answer);
  return answer.json();
};
export const go = (said) => {
  if (!said.go) return;
  sessionStorage.setItem("scroll", JSON.stringify([said.go, scrollY]));
  if (location.pathname === said.go) location.reload(); else location.assign(said.go);
};
// What the page before could not say, for this one took its place.
const unsaid = sessionStorage.getItem("said");
sessionStorage.removeItem("said");
if (unsaid) say(unsaid);
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
fill("#whole-wanted", "whole", "It came to no end.").catch(() => {});
fill("#findings-wanted", "findings", "The check came to no end.").catch(() => {});

// Bounds that were changed, both ends of each value; an empty end is free.
const boundsOf = (form) => {
  const ends = (path, end) => form.querySelector(`[data-path="${path}"][data-bound=${end}]`);
  const changed = $$("[data-bound]", form).filter((field) => field.value !== (field.dataset.was ??
    ""));
  const number = ({ value }) => value === "" ? null : Number(value);
  return [...new Set(changed.map((field) => field.dataset.path))].map((path) => ({ path,
    low: number(ends(path, "low")), high: number(ends(path, "high")) }));
};
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
    if (form.dataset.names !== undefined) {
      data.names = $$("[data-name]:checked", form).map((box) => box.dataset.name).join("+");
      if (!data.names) { say("Tick at least one value."); return; }
      data.bounds = boundsOf(form);
    }
    if (event.submitter?.name) data[event.submitter.name] = event.submitter.value;
    say("");
    mark(null, form);
    try {
      const said = await send(form.dataset.send, data);
      if (form.dataset.said) say(form.dataset.said, false);
      if (said.begun) watch(); else go(said);
    } catch (error) { say(error.message); mark(error, form); }
  });
}
for (const field of $$("[data-submit]")) field.addEventListener("change", () =>
  field.form.requestSubmit());

// Progress of long work: how far it is, how long it takes at most, the best so far.
const tell = (box, { what, done, total, best, left_s, ending }) => {
  const bar = $("progress", box);
  if (total > 0) { bar.max = total; bar.value = done; } else bar.removeAttribute("value");
  $("#what", box).textContent = ending === "stopped" ? "Stopping …" : ending === "accepted" ?
    "Judging what was found …" : total > 0 ? `${what}, ${Math.floor(100 * done / total)} %` : what;
  $("#left", box).textContent = left_s === null || ending ? "" : left_s < 90 ?
    `at most ${Math.ceil(left_s)} s more` : `at most ${Math.ceil(left_s / 60)} min more`;
  $("#stop", box).disabled = ending === "stopped";
  const shown = $("#best", box);
  if (!shown) return;
  shown.hidden = !best;
  $("#accept", box).disabled = Boolean(ending);
  if (!best) return;
  const unit = { error_unit: box.dataset.errorUnit, error_per_si: Number(box.dataset.errorPerSi) };
  for (const name of ["before", "error", "floor"])
    $(`#best-${name}`, box).textContent = inWords(best[`${name}_rad`], unit);
  $("#best-name", box).textContent = best.name;
  const [, drawn] = $$(".bar", shown);
  const share = (value) => Math.min(1000 * value / best.before_rad, 1000).toFixed(1);
  $(".area", drawn).setAttribute("width", share(best.error_rad));
  for (const end of ["x1", "x2"]) $(".mark", drawn).setAttribute(end, share(best.floor_rad));
};
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
      tell(box, state);
      for (const button of $$("[data-work]")) button.disabled = true;
    } else if (ran) {
      events.close(); events = null;
      for (const button of $$("[data-work]")) button.disabled = false;
      if (state.state === "done") go({ go: state.page ? `${base}/${state.page}` : location.pathname });
      else if (state.state === "failed") say(`${state.error}. ${state.remedy}.`);
      else say("Stopped. Nothing was changed.", false);
    }
  };
};
if (document.body.dataset.running !== undefined) watch();
for (const end of ["stop", "accept"]) $(`#${end}`)?.addEventListener("click", () =>
  send(end).catch((error) => say(error.message)));

// Logs that are dropped or chosen.
const MOST = Number($("#files")?.dataset.most ?? 0);
const bring = async (files) => {
  let last = null;
  const refused = [];
  // A robot's file takes the columns of the first log, and a model names a robot's file.
  const rank = ({ name }) => /\.toml$/i.test(name) ? 2 : /\.(urdf|xml)$/i.test(name) ? 1 : 0;
  for (const file of [...files].sort((a, b) => rank(a) - rank(b))) {
    if (file.size > MOST) {
      const [has, most] = [file.size, MOST].map((bytes) => Math.round(bytes / 2 ** 20));
      say(`${file.name} has ${has} MiB; a file may have up to ${most} MiB.`);
      return;
    }
    say(`Bringing ${file.name} …`, false);
    const answer = await fetch(`${base}/upload?name=${encodeURIComponent(file.name)}`, {
      method: "POST", body: file });
    if (!answer.ok) { refused.push((await problem(answer)).message); continue; }
    last = await answer.json();
    say("");
  }
  if (refused.length && last) sessionStorage.setItem("said", refused.join(" "));
  else if (refused.length) say(refused.join(" "));
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

// Panels of measured and predicted angles, residuals below. A model that runs away does not press
// the others flat: `anchor` is what the scale follows.
export const panelsOf = ({ meta, data }, names) => {
  const panels = [];
  for (let joint = 0; joint < meta.joints; joint++) {
    const measured = data[`measured_${joint}`], predicted = data[`predicted_${joint}`], other =
      data[`other_${joint}`], shown = meta.shown[joint];
    const left = (values) => values && measured.map((angle, k) => angle - values[k]);
    const angles = [{ name: "measured", tone: "ink", values: measured, wide: true }, {
      name: names[0], tone: names[2] ?? "orange", values: predicted }];
    const residuals = [{ name: names[0], tone: names[2] ?? "orange", values: left(predicted) }];
    if (other) {
      angles.push({ name: names[1], tone: names[3] ?? "blue", values: other });
      residuals.push({ name: names[1], tone: names[3] ?? "blue", values: left(other) });
    }
    const quantity = meta.rates[joint] ? "Rate" : "Angle";
    const title = meta.joints > 1 ? `${quantity} of joint ${joint + 1}` : quantity;
    panels.push({ title, unit: shown.unit, scale: shown.per_si, joint, anchor: measured, curves:
      angles });
    panels.push({ title: meta.joints > 1 ? `Residual of joint ${joint + 1}` : "Residual", unit:
      shown.error_unit, small: true, scale: shown.error_per_si, band: meta.floor[joint], joint,
      reach: measured, curves: residuals });
    const input = data[`input_${joint}`];
    if (input) panels.push({ title:
      `Input${meta.joints > 1 ? ` of joint ${joint + 1}` : ""}: ${meta.inputs[joint].name}`, unit:
      meta.inputs[joint].unit.replace(/^1$/, ""), scale: meta.inputs[joint].per_si, small: true,
      curves: [{ name: "input", tone: "violet", values: input }] });
  }
  return panels;
};
// An error in the unit in which people read it, `error` of the answers.
export const inWords = (value, { error_unit, error_per_si }) => {
  const size = error_per_si * value;
  const large = Math.abs(size) >= 100;
  return `${large ? Math.round(size) : Number(size.toPrecision(3))} ${error_unit}`;
};

if ($("#raw")) import("./raw.js").catch((error) => say(error.message));
if ($("#curves") && $("#curves").dataset.kind !== "what-if") {
  import("./compare.js").catch((error) => say(error.message));
}
