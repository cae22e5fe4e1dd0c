// The form of a new model, drawn as it is typed; and the columns of a log.
import { element } from "./curves.js";
import { go, mark, say, send } from "./lab.js";

const form = document.getElementById("new-model");
const links = document.getElementById("links");
const FIELDS = [
  ["length_m", "length, m", 0.3], ["com_m", "centre of mass from the joint, m", 0.15], ["mass_kg",
    "mass, kg", 0.2],
  ["inertia_kg_m2", "inertia, kg m² (empty: even rod)", ""],
];
const MOTOR = [["gain", "gain, duty per rad or rad/s", 5], ["stall_torque_nm", "stall torque, N m",
  1.5], ["no_load_speed_rad_s", "no-load speed, rad/s", 6]];
const FRICTION = [["viscous_nm_s_rad", "viscous friction, N m s/rad"], ["coulomb_nm",
  "Coulomb friction, N m"]];
// Geared servos lose a few hundredths of their stall torque; a torque without a figure gets what the
// library begins a fit with.
const friction = (drive, { stall_torque_nm, no_load_speed_rad_s }) => {
  const round = (value) => Number(value.toPrecision(2));
  if (drive === "passive") return ["", ""];
  if (!(stall_torque_nm > 0) || drive === "torque") return [0.01, 0.02];
  const coulomb = 0.03 * stall_torque_nm;
  return [round(coulomb / (no_load_speed_rad_s > 0 ? no_load_speed_rad_s : 6)), round(coulomb)];
};
const USES = { passive: [], torque: [], duty: ["stall_torque_nm", "no_load_speed_rad_s"], position:
  MOTOR.map((f) => f[0]), speed: MOTOR.map((f) => f[0]) };
const DRIVES = { passive: "nothing: swings freely", torque: "a torque", duty: "a duty", position:
  "a position servo", speed: "a speed servo" };

const field = (link, [name, text, value]) => {
  const input = element("input", { type: "number", step: "any", value });
  input.dataset.field = name;
  return element("label", {}, text, input);
};
const given = JSON.parse(document.getElementById("draft")?.textContent ?? "null");
const addLink = () => {
  const number = links.children.length + 1, known = given?.links[number - 1];
  const drive = element("select", {}, ...Object.entries(DRIVES).map(([value, text]) =>
    element("option", { value, textContent: text })));
  drive.dataset.field = "drive";
  const set = element("fieldset", {}, element("legend", {
    textContent: `Link ${number}, on joint ${number}` }),
    ...FIELDS.map((each) => field(number, each)), element("label", {}, "moved by", drive),
      ...MOTOR.map((each) => field(number, each)), ...FRICTION.map(([name, text]) =>
        field(number, [name, text, ""])));
  const of = (name) => set.querySelector(`[data-field=${name}]`);
  if (known) for (const [name, value] of Object.entries(known))
    if (of(name) && value !== null) of(name).value = value;
  const propose = () => {
    const figures = Object.fromEntries(MOTOR.map(([name]) => [name, Number(of(name).value)]));
    friction(drive.value, figures).forEach((value, i) => { of(FRICTION[i][0]).value = value; });
  };
  propose();
  drive.addEventListener("change", propose);
  const uses = () => {
    for (const [name] of MOTOR) set.querySelector(`[data-field=${name}]`).parentElement.hidden =
      !USES[drive.value].includes(name);
  };
  drive.addEventListener("change", uses);
  uses();
  links.append(set);
};
const plan = () => ({
  name: form.elements.name.value, angle_zero: form.elements.angle_zero.value, angles:
    form.elements.angles.value,
  friction: [...links.children].map((set) => Object.fromEntries(FRICTION.map(([name]) => {
    const { value } = set.querySelector(`[data-field=${name}]`);
    return [name, value === "" ? null : Number(value)];
  }))),
  links: [...links.children].map((set) =>
    Object.fromEntries([...set.querySelectorAll("[data-field]")].map((input) => {
    const { field } = input.dataset;
    if (FRICTION.some(([name]) => name === field)) return ["", null];
    if (field === "drive") return [field, input.value];
    const used = !MOTOR.some((each) => each[0] === field) ||
      USES[set.querySelector("[data-field=drive]").value].includes(field);
    return [field, used && input.value !== "" ? Number(input.value) : null];
  }))),
});
const SVG = "http://www.w3.org/2000/svg";
const shape = (name, attributes) => {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
};
// The chain, a little bent so that the joints can be seen, at its angle of zero.
const draw = () => {
  const svg = document.getElementById("chain"), { links, angle_zero } = plan();
  let angle = { hanging: 0, horizontal: Math.PI / 2, upright: Math.PI }[angle_zero], x = 0, y = 0;
  const parts = [], reach = links.reduce((sum, link) => sum + Math.abs(link.length_m || 0), 0) || 1;
  const heaviest = Math.max(...links.map((link) => link.mass_kg || 0), 1e-9);
  links.forEach((link, i) => {
    if (i) angle += 0.25 * (i % 2 ? 1 : -1);
    const along = (d) => [x + d * Math.sin(angle), y + d * Math.cos(angle)];
    const [ex, ey] = along(link.length_m || 0), [cx, cy] = along(link.com_m || 0);
    const stout = reach * (0.03 + 0.04 * Math.sqrt((link.mass_kg || 0) / heaviest));
    parts.push(shape("line", { x1: x, y1: y, x2: ex, y2: ey, "stroke-width": stout, class:
      "drawn-link" }));
    parts.push(shape("circle", { cx, cy, r: reach * 0.018, class: "drawn-com" }));
    parts.push(shape("circle", { cx: x, cy: y, r: reach * 0.028, class: link.drive === "passive" ?
      "drawn-joint" : "drawn-joint driven" }));
    [x, y] = [ex, ey];
  });
  const r = 1.15 * reach;
  svg.setAttribute("viewBox", `${-r} ${-r} ${2 * r} ${2 * r}`);
  svg.replaceChildren(...parts);
};
if (form) {
  const count = form.elements.count;
  const fill = () => {
    const wanted = Math.min(Math.max(Number(count.value) || 1, 1), 32);
    while (links.children.length < wanted) addLink();
    while (links.children.length > wanted) links.lastChild.remove();
    draw();
  };
  count.addEventListener("input", fill);
  form.addEventListener("input", draw);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    mark(null, form);
    try { go(await send("new-model", plan())); } catch (error) {
      say(error.message); mark(error, form); }
  });
  if (given) {
    for (const name of ["name", "angle_zero", "angles"]) form.elements[name].value = given[name];
    count.value = given.links.length;
  }
  fill();
}
const columns = document.getElementById("columns");
columns?.addEventListener("submit", async (event) => {
  event.preventDefault();
  const of = (row, name) => row.querySelector(`[data-field=${name}]`);
  const chosen = [...columns.querySelectorAll("[data-quantity]")].map((row) => ({
    quantity: row.dataset.quantity, column: of(row, "column").value, unit: of(row, "unit").value,
    reversed: of(row, "reversed")?.checked ?? false, offset: Number(of(row, "offset")?.value ?? 0),
  }));
  mark(null, columns);
  try { go(await send("columns", { columns: chosen })); } catch (error) {
    say(error.message); mark(error, columns); }
});
