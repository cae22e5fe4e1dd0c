// Charts on canvases that share one time axis: zoom, pan, a cursor, shaded stretches.
// Curves come as four-byte numbers and are decimated to pixel columns as they are drawn.
// uPlot draws 18 charts of 3 x 6000 points in 0.26 s against 0.45 s here, or 0.12 s of those in
// sight; its canvases take no focus, no key and have no name, and it does not pan.
import { element } from "./curves.js";
import { colour, label, onLook, prepare, stroke, ticks } from "./paint.js";

// Index of the first sample at or after a time.
const after = (time, t) => {
  let low = 0, high = time.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time[middle] < t) low = middle + 1; else high = middle;
  }
  return low;
};

const PAD = { left: 56, right: 10, top: 8, bottom: 20 };

export class ChartGroup {
  // `root` gets the charts; `onCursor` hears of the time under the pointer.
  constructor(root, { onCursor } = {}) {
    this.root = root;
    this.onCursor = onCursor;
    this.panels = [];
    this.shade = [];
    this.cursor = null;
    this.hidden = new Set();
    this.toolbar = element("div", { className: "chart-tools" });
    const tool = (text, title, act) => {
      const button = element("button", { type: "button", textContent: text, title });
      button.setAttribute("aria-label", title);
      button.addEventListener("click", act);
      this.toolbar.append(button);
    };
    tool("+", "Zoom in (+)", () => this.zoom(0.5));
    tool("−", "Zoom out (−)", () => this.zoom(2));
    tool("←", "Earlier (←)", () => this.pan(-0.25));
    tool("→", "Later (→)", () => this.pan(0.25));
    tool("All", "Whole motion (0)", () => this.all());
    this.legend = element("div", { className: "legend" });
    this.box = element("div", { className: "plots" });
    root.replaceChildren(element("div", { className: "chart-head" }, this.legend, this.toolbar),
      this.box);
    // What is out of sight is drawn when it comes into sight.
    this.sight = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const part = this.panels.find(({ canvas }) => canvas === target);
        if (!part) continue;
        const first = part.inSight === undefined;
        part.inSight = isIntersecting;
        if (first || (isIntersecting && part.stale)) this.draw();
      }
    }, { rootMargin: "200px" });
    onLook(() => this.draw());
  }

  // `panels` over `time`: { title, unit, scale, band, joint, curves };
  // `curves`: [{ name, tone, values, wide }].
  // With `follow` the time grows from call to call, and all of it is shown.
  show(time, panels, { marks = [], follow = false } = {}) {
    const same = this.time && (follow || this.time.length === time.length) &&
      this.panels.length === panels.length;
    this.time = time;
    this.marks = marks;
    const first = time.length ? time[0] : 0, last = time.length ? time[time.length - 1] : 1;
    if (!same || follow || !this.view) this.view = [first, last];
    this.ends = [first, last];
    if (!same) {
      this.box.replaceChildren();
      this.sight.disconnect();
      this.panels = panels.map((panel) => this.make(panel));
      for (const { canvas } of this.panels) this.sight.observe(canvas);
    } else {
      panels.forEach((panel, i) => Object.assign(this.panels[i].panel, panel));
    }
    this.names();
    this.draw();
  }

  make(panel) {
    const canvas = element("canvas", { className: panel.small ? "plot small" : "plot", tabIndex:
      0 });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label",
      `${panel.title}, ${panel.unit}, over time; + − zoom, arrows move, 0 shows all`);
    const readout = element("span", { className: "readout" });
    const caption = element("figcaption", {}, element("b", {
      textContent: panel.title }), ` ${panel.unit}`, readout);
    this.box.append(element("figure", {}, caption, canvas));
    this.listen(canvas);
    return { panel, canvas, readout, inSight: undefined, stale: true };
  }

  names() {
    const seen = new Map();
    const curves = this.panels.flatMap(({ panel }) => panel.curves).filter(({ name }) => name);
    for (const curve of curves) seen.set(curve.name, curve);
    this.legend.replaceChildren(...[...seen].map(([name, curve]) => {
      const box = element("input", { type: "checkbox", checked: !this.hidden.has(name) });
      box.addEventListener("change", () => {
        if (box.checked) this.hidden.delete(name); else this.hidden.add(name);
        this.draw();
      });
      const swatch = element("span", { className: "swatch" });
      return element("label", { className: `key tone-${curve.tone}` }, box, swatch, name);
    }));
    if (this.panels.some(({ panel }) => panel.band)) {
      const swatch = element("span", { className: "swatch" });
      const key = element("span", { className: "key tone-green" }, swatch, "± noise floor");
      this.legend.append(key);
    }
  }

  place(canvas) {
    const left = PAD.left, right = canvas.clientWidth - PAD.right, [from, to] = this.view;
    return {
      x: (t) => left + (t - from) / (to - from || 1) * (right - left),
      t: (x) => from + (x - left) / (right - left) * (to - from),
      left, right,
    };
  }

  listen(canvas) {
    let drag = null;
    const at = (event) => event.clientX - canvas.getBoundingClientRect().left;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      canvas.setPointerCapture(event.pointerId);
      drag = { from: at(event), to: at(event), pan: event.shiftKey, view: [...this.view] };
    });
    canvas.addEventListener("pointermove", (event) => {
      const place = this.place(canvas);
      this.setCursor(place.t(at(event)));
      if (!drag) return;
      drag.to = at(event);
      if (drag.pan) {
        const shift = (drag.from - drag.to) / (place.right - place.left) *
          (drag.view[1] - drag.view[0]);
        this.setView(drag.view[0] + shift, drag.view[1] + shift);
      } else {
        this.selection = [place.t(drag.from), place.t(drag.to)].sort((a, b) => a - b);
        this.draw();
      }
    });
    canvas.addEventListener("pointerup", () => {
      const chosen = this.selection;
      const wide = drag && !drag.pan && Math.abs(drag.to - drag.from) > 4;
      drag = this.selection = null;
      if (wide && chosen) this.setView(...chosen); else this.draw();
    });
    canvas.addEventListener("pointercancel", () => { drag = this.selection = null; this.draw(); });
    canvas.addEventListener("pointerleave", () => this.setCursor(null));
    canvas.addEventListener("dblclick", () => this.all());
    canvas.addEventListener("wheel", (event) => {
      // Without Ctrl the wheel scrolls the page.
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      this.zoom(event.deltaY > 0 ? 1.25 : 0.8, this.place(canvas).t(at(event)));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const keys = {
        "+": () => this.zoom(0.5), "=": () => this.zoom(0.5), "-": () => this.zoom(2),
        ArrowLeft: () => this.pan(-0.25), ArrowRight: () => this.pan(0.25),
        Home: () => this.pan(-1e9), End: () => this.pan(1e9), 0: () => this.all(),
      };
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  }

  zoom(factor, around = (this.view[0] + this.view[1]) / 2) {
    this.setView(around + (this.view[0] - around) * factor, around + (this.view[1] - around) *
      factor);
  }
  pan(share) {
    const shift = share * (this.view[1] - this.view[0]);
    this.setView(this.view[0] + shift, this.view[1] + shift);
  }
  all() { this.setView(...this.ends); }
  setView(from, to) {
    const [first, last] = this.ends, whole = last - first || 1;
    const width = Math.min(Math.max(to - from, whole * 1e-4), whole);
    from = Math.min(Math.max(from, first), last - width);
    this.view = [from, from + width];
    this.onView?.();
    this.draw();
  }
  setCursor(time) {
    this.cursor = time;
    this.draw();
    this.onCursor?.(time);
  }
  setShade(shade) { this.shade = shade; this.draw(); }

  draw() {
    if (!this.time || this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      for (const part of this.panels) {
        part.stale = !part.inSight;
        if (part.inSight) this.drawPanel(part);
      }
      // Before it is known what is in sight nothing has been drawn.
      const known = this.panels.every((part) => part.inSight !== undefined);
      if (known) this.root.dataset.drawn = String(performance.now());
    });
  }

  // The scale follows what was measured: what runs away from it leaves the picture. `anchor` holds
  // the scale about its own values, `reach` about zero.
  held(panel, low, high, begin, end) {
    const held = panel.anchor ?? panel.reach;
    if (!held) return [low, high];
    let least = Infinity, most = -Infinity;
    for (let k = begin; k < end; k++) {
      if (held[k] < least) least = held[k];
      if (held[k] > most) most = held[k];
    }
    const span = Math.max(most - least, 1e-6);
    if (!(span < Infinity)) return [low, high];
    const [bottom, top] = panel.anchor ? [least - span, most + span] : [-2 * span, 2 * span];
    return [Math.max(low, bottom), Math.min(high, top)];
  }

  drawPanel({ panel, canvas, readout }) {
    const [pen, width, height] = prepare(canvas);
    const { time, view: [from, to] } = this, scale = panel.scale ?? 1;
    const top = PAD.top, bottom = height - PAD.bottom, { x, left, right } = this.place(canvas);
    const begin = Math.max(0, after(time, from) - 1), end = Math.min(time.length, after(time, to) +
      2);
    const shown = panel.curves.filter((curve) => curve.values && !this.hidden.has(curve.name));
    let low = Infinity, high = -Infinity;
    for (const { values } of shown) {
      for (let k = begin; k < end; k++) {
        const v = values[k];
        if (v < low && v > -1e12) low = v;
        if (v > high && v < 1e12) high = v;
      }
    }
    [low, high] = this.held(panel, low, high, begin, end);
    const band = 1.3 * (panel.band ?? NaN);
    if (band > 0) [low, high] = [Math.min(low, -band), Math.max(high, band)];
    if (!(low <= high)) { low = 0; high = 1; }
    [low, high] = [low * scale, high * scale];
    const spare = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1e-3;
    low -= spare; high += spare;
    const y = (v) => bottom - (v * scale - low) / (high - low) * (bottom - top);
    const clip = () => { pen.save(); pen.beginPath();
      pen.rect(left, top, right - left, bottom - top); pen.clip(); };

    clip();
    for (const stretch of this.shade) {
      if (stretch.joint !== undefined && panel.joint !== undefined &&
        stretch.joint !== panel.joint) continue;
      pen.fillStyle = colour("orange"); pen.globalAlpha = 0.22;
      pen.fillRect(x(stretch.from), top, Math.max(1, x(stretch.to) - x(stretch.from)),
        bottom - top);
    }
    pen.globalAlpha = 1;
    if (this.selection) {
      pen.fillStyle = colour("blue"); pen.globalAlpha = 0.18;
      pen.fillRect(x(this.selection[0]), top, x(this.selection[1]) - x(this.selection[0]),
        bottom - top);
      pen.globalAlpha = 1;
    }
    pen.restore();

    pen.lineWidth = 1; pen.strokeStyle = colour("rule"); pen.fillStyle = colour("soft");
    pen.textAlign = "right";
    const [rows, rowDecimals] = ticks(low, high, Math.max(3, height / 32));
    for (const v of rows) {
      const at = bottom - (v - low) / (high - low) * (bottom - top);
      pen.beginPath(); pen.moveTo(left, at); pen.lineTo(right, at); pen.stroke();
      pen.fillText(label(v, rowDecimals), left - 6, at + 4);
    }
    pen.textAlign = "center";
    const [columns, decimals] = ticks(from, to, Math.max(2, width / 90));
    for (const t of columns) {
      pen.beginPath(); pen.moveTo(x(t), top); pen.lineTo(x(t), bottom); pen.stroke();
      pen.fillText(`${label(t, decimals)}`, x(t), height - 5);
    }
    clip();
    if (panel.band) {
      pen.fillStyle = colour("green"); pen.globalAlpha = 0.25;
      pen.fillRect(left, y(panel.band), right - left, y(-panel.band) - y(panel.band));
      pen.globalAlpha = 1;
    }
    if (this.marks.length < (right - left) / 6) {
      pen.strokeStyle = colour("grey"); pen.setLineDash([2, 4]);
      for (const mark of this.marks) { pen.beginPath(); pen.moveTo(x(mark), top);
        pen.lineTo(x(mark), bottom); pen.stroke(); }
      pen.setLineDash([]);
    }
    for (const curve of shown) {
      pen.strokeStyle = colour(curve.tone); pen.lineWidth = curve.wide ? 2.6 : 1.4;
      pen.globalAlpha = curve.wide ? 0.5 : 1;
      if (curve.dashed) pen.setLineDash([5, 4]);
      stroke(pen, time, curve.values, begin, end, x, y);
      pen.setLineDash([]);
    }
    pen.globalAlpha = 1;
    if (this.cursor !== null && this.cursor >= from && this.cursor <= to) {
      const at = x(this.cursor); pen.strokeStyle = colour("blue"); pen.lineWidth = 1;
      pen.beginPath(); pen.moveTo(at, top); pen.lineTo(at, bottom); pen.stroke();
    }
    pen.restore();
    readout.textContent = this.reading(shown, scale);
  }

  reading(shown, scale) {
    if (this.cursor === null || !this.time.length) return "";
    const k = Math.min(this.time.length - 1, after(this.time, this.cursor));
    const numbers = shown.map((curve) =>
      `${curve.name} ${Number((curve.values[k] * scale).toPrecision(4))}`);
    return `at ${this.time[k].toFixed(3)} s: ${numbers.join(", ")}`;
  }
}
