// The robot at a port: its phase, questions, charts and shape while it is recorded or balanced.
import { ChartGroup } from "./chart.js";
import { element } from "./curves.js";
import { say, send } from "./lab.js";
import { colour, onLook, prepare } from "./paint.js";

const base = `/s/${document.body.dataset.session}`;
const $ = (id) => document.getElementById(id);
const TONES = ["blue", "orange", "green", "ink", "grey"];
const MOST = 3000;
const group = new ChartGroup($("live-charts"));
const scene = JSON.parse($("shape")?.textContent ?? "null");
let viewer = null, charts = [], time = [], values = [], links = [];

// The chain from its base: angles from hanging, counter-clockwise; what is not known ends it.
const drawShape = () => {
  const canvas = $("live-shape");
  canvas.hidden = !scene || !links.some((angle) => angle !== null);
  if (canvas.hidden) return;
  const [pen, width, height] = prepare(canvas);
  const reach = scene.links.reduce((sum, link) => sum + link.length_m, 0) || 1;
  const scale = Math.min(width, height) / 2 / (1.15 * reach);
  let x = width / 2, y = height / 2;
  pen.lineCap = "round";
  pen.strokeStyle = colour("rule"); pen.lineWidth = 1;
  pen.beginPath(); pen.moveTo(0, y); pen.lineTo(width, y); pen.stroke();
  for (const [i, link] of scene.links.entries()) {
    if (links[i] === null || links[i] === undefined) break;
    const [ex, ey] = [x + scale * link.length_m * Math.sin(links[i]),
      y + scale * link.length_m * Math.cos(links[i])];
    pen.strokeStyle = colour("blue"); pen.lineWidth = 9;
    pen.beginPath(); pen.moveTo(x, y); pen.lineTo(ex, ey); pen.stroke();
    pen.fillStyle = colour("paper"); pen.strokeStyle = colour("ink"); pen.lineWidth = 2;
    pen.beginPath(); pen.arc(x, y, 5, 0, 2 * Math.PI); pen.fill(); pen.stroke();
    [x, y] = [ex, ey];
  }
  canvas.dataset.drawn = String(performance.now());
};
onLook(drawShape);

const draw = () => {
  group.show(Float32Array.from(time), charts.map(({ title, unit }, i) => ({
    title, unit: unit === "1" ? "" : unit, small: true,
    curves: [{ name: "", tone: TONES[i % TONES.length], values: values[i] }],
  })), { follow: true });
  drawShape();
};
const hear = (samples) => {
  time.push(...samples.time_s);
  samples.values.forEach((row, i) => {
    values[i] ??= [];
    values[i].push(...row.map((value) => value ?? NaN));
  });
  if (time.length > MOST) {
    const old = time.length - MOST;
    time.splice(0, old);
    for (const row of values) row.splice(0, old);
  }
  links = samples.link_rad;
  const told = [];
  if (samples.supply_v !== null) told.push(`supply ${samples.supply_v.toFixed(1)} V`);
  if (samples.hottest_celsius !== null) told.push(`hottest servo ${samples.hottest_celsius} °C`);
  if (told.length) $("health").textContent = told.join(", ");
  $("live-view").hidden = false;
  draw();
};
const WORDS = {
  idle: () => "Ready.", preparing: ({ what }) => `${what} …`,
  asking: () => "Waiting for your answer.",
  running: ({ what }) => what, ended: ({ said }) => `Ended: ${said}.`,
  failed: ({ error, remedy }) => `${error}. ${remedy}${remedy ? "." : ""}`,
};
const BUSY = ["preparing", "asking", "running"];
const meet = (state) => {
  const { phase } = state, busy = BUSY.includes(phase);
  $("phase").replaceChildren(WORDS[phase](state));
  if (state.log) $("phase").append(" ", element("a", { href: `${base}/data` },
    `${state.log} is a log of this session now.`));
  $("phase").dataset.phase = phase;
  for (const id of ["begin-record", "begin-balance"]) $(id).disabled = busy || viewer === null;
  $("stop-live").disabled = !busy;
  if (!busy) $("stop-live").textContent = "Stop: let it down";
  const asked = phase === "asking";
  if (asked) $("question").textContent = state.question;
  if (asked && $("asked").hidden) { $("asked").hidden = false; $("refuse").focus(); }
  $("asked").hidden = !asked;
  if (phase === "running" && JSON.stringify(charts) !== JSON.stringify(state.charts)) {
    charts = state.charts;
    group.time = null;
  }
};

const events = new EventSource(`${base}/live`);
events.addEventListener("hello", ({ data }) => { viewer = JSON.parse(data).viewer; });
events.addEventListener("phase", ({ data }) => meet(JSON.parse(data)));
events.addEventListener("samples", ({ data }) => hear(JSON.parse(data)));
// The server lets the robot down where this page does not answer.
events.addEventListener("tick", () => send("live/here", { viewer }).catch(() => {}));
events.addEventListener("error", () => {
  viewer = null;
  $("phase").textContent = "The lab does not answer: the robot is let down.";
  for (const id of ["begin-record", "begin-balance"]) $(id).disabled = true;
});

const begin = (form, task) => $(form).addEventListener("submit", async (event) => {
  event.preventDefault();
  say("");
  time = []; values = []; charts = []; links = [];
  try { await send("live/begin", { viewer, task: task() }); } catch (error) { say(error.message); }
});
const number = (id) => ($(id).value === "" ? null : Number($(id).value));
begin("record-live", () => ({ what: "record", seconds: number("record-seconds") }));
begin("balance-live", () => ({ what: "balance", seconds: number("balance-seconds"), countdown_s: 3,
  torque: number("torque") }));
const answer = (yes) => send("live/answer", { viewer, yes }).catch((error) => say(error.message));
$("agree").addEventListener("click", () => answer(true));
$("refuse").addEventListener("click", () => answer(false));
$("stop-live").addEventListener("click", async () => {
  try {
    await send("live/stop");
    $("stop-live").textContent = "Torque off at once";
  } catch (error) { say(error.message); }
});
