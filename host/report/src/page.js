"use strict";
// Charts that zoom along their time, and commands that are copied. Nothing is loaded.
// A chart is an SVG whose groups `course` hold curves; `data-x` and `data-y` of such a group are the
// values at the ends of its axes and the places of these ends.
(() => {
  // The only address on a page would be that of the language itself: it is asked for.
  const SVG = document.querySelector("svg")?.namespaceURI;
  const make = (name, attributes, text) => {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    return element;
  };
  const button = (text, title, act) => {
    const element = document.createElement("button");
    Object.assign(element, { type: "button", textContent: text, title });
    element.setAttribute("aria-label", title);
    element.addEventListener("click", act);
    return element;
  };
  const numbers = (text) => text.split(" ").map(Number);

  // Round values between two ends, and the decimals that tell them apart.
  const ticks = (low, high, wanted) => {
    const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((digit) => digit * power >= rough * 0.999) * power;
    const decimals = Math.min(8, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))), all = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
      all.push([k * step, (k * step).toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1")]);
    }
    return all;
  };

  // Points of a path that only moves and draws straight lines.
  const points = (path) => [...path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)/g)]
    .map((found) => [Number(found[1]), Number(found[2])]);

  let serial = 0;
  const zoomable = (svg) => {
    const courses = [...svg.querySelectorAll("g.course")];
    const [first, last, left, right] = numbers(courses[0].dataset.x);
    const columns = svg.querySelector("g.columns"), labels = svg.querySelector("g.ticks");
    const edges = [...new Set([...columns.querySelectorAll("line")]
      .map((line) => `${line.getAttribute("y1")} ${line.getAttribute("y2")}`))];
    const below = labels.querySelector("text.tick")?.getAttribute("y");
    const clip = `clip-${serial++}`;
    const rect = make("rect", { x: left, y: 0, width: right - left, height: 4096 });
    const shape = make("clipPath", { id: clip });
    shape.append(rect);
    svg.prepend(shape);
    for (const course of courses) {
      const around = make("g", { "clip-path": `url(#${clip})` });
      course.replaceWith(around);
      around.append(course);
    }
    const cursor = make("line", { class: "cursor", y1: 0, y2: 0, visibility: "hidden" });
    const chosen = make("rect", { class: "chosen", y: 0, height: 0, visibility: "hidden" });
    const heights = edges.flatMap(numbers);
    const [top, bottom] = [Math.min(...heights), Math.max(...heights)];
    for (const [key, value] of [["y1", top], ["y2", bottom]]) cursor.setAttribute(key, value);
    chosen.setAttribute("y", top);
    chosen.setAttribute("height", bottom - top);
    svg.append(chosen, cursor);

    let [from, to] = [first, last];
    const value = (place) => from + (place - left) / (right - left) * (to - from);
    const draw = () => {
      const scale = (last - first) / (to - from);
      const shift = left - scale * (left + (from - first) / (last - first) * (right - left));
      svg.classList.toggle("zoomed", scale > 1.0001);
      for (const course of courses) {
        course.setAttribute("transform", `matrix(${scale} 0 0 1 ${shift} 0)`);
      }
      const all = ticks(from, to, 8);
      const x = (at) => left + (at - from) / (to - from) * (right - left);
      columns.replaceChildren(...edges.flatMap((edge) => {
        const [y1, y2] = numbers(edge);
        return all.map(([at]) => make("line", { class: "grid", x1: x(at), x2: x(at), y1, y2 }));
      }));
      labels.querySelectorAll("text.tick").forEach((text) => text.remove());
      labels.append(...all.map(([at, text]) =>
        make("text", { class: "tick", x: x(at), y: below, "text-anchor": "middle" }, text)));
    };
    const view = (begin, end) => {
      const whole = last - first, width = Math.min(Math.max(end - begin, whole * 1e-3), whole);
      from = Math.min(Math.max(begin, first), last - width);
      to = from + width;
      draw();
    };
    const zoom = (factor, around = (from + to) / 2) =>
      view(around + (from - around) * factor, around + (to - around) * factor);
    const pan = (share) => view(from + share * (to - from), to + share * (to - from));
    const all = () => view(first, last);

    const tools = document.createElement("div");
    tools.className = "tools";
    const readout = document.createElement("span");
    readout.className = "readout";
    tools.append(button("+", "Zoom in (+)", () => zoom(0.5)),
      button("−", "Zoom out (−)", () => zoom(2)), button("←", "Earlier (←)", () => pan(-0.25)),
      button("→", "Later (→)", () => pan(0.25)), button("All", "All of it (0)", all), readout);
    const holder = svg.closest(".scroll") ?? svg;
    holder.before(tools);

    // What the curves are at a place, each by the colour that the legend gives it.
    const curves = courses.flatMap((course) => {
      const [low, high, foot, head] = numbers(course.dataset.y);
      return [...course.querySelectorAll("path.line")].map((path) => ({
        tone: [...path.classList].find((name) => name.startsWith("tone-")), at: points(path),
        value: (place) => low + (place - foot) / (head - foot) * (high - low),
      }));
    });
    const read = (place) => {
      const at = left + (value(place) - first) / (last - first) * (right - left);
      const swatches = curves.filter(({ at }) => at.length).map(({ tone, at: known, value }) => {
        let [low, high] = [0, known.length - 1];
        while (low < high) {
          const middle = (low + high) >> 1;
          if (known[middle][0] < at) low = middle + 1; else high = middle;
        }
        const item = document.createElement("span"), swatch = document.createElement("span");
        item.className = `key ${tone}`;
        swatch.className = "swatch";
        item.append(swatch, String(Number(value(known[low][1]).toPrecision(3))));
        return item;
      });
      readout.replaceChildren(`at ${value(place).toFixed(3)}: `, ...swatches);
    };

    let drag = null;
    const place = (event) => {
      const matrix = svg.getScreenCTM().inverse();
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix).x;
      return Math.min(Math.max(at, left), right);
    };
    svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      svg.setPointerCapture(event.pointerId);
      drag = place(event);
    });
    svg.addEventListener("pointermove", (event) => {
      const at = place(event);
      cursor.setAttribute("x1", at);
      cursor.setAttribute("x2", at);
      cursor.setAttribute("visibility", "visible");
      read(at);
      if (drag === null) return;
      chosen.setAttribute("x", Math.min(drag, at));
      chosen.setAttribute("width", Math.abs(at - drag));
      chosen.setAttribute("visibility", "visible");
    });
    const release = (event) => {
      const ends = [drag, place(event)].sort((a, b) => a - b);
      const wide = drag !== null && ends[1] - ends[0] > 4;
      drag = null;
      chosen.setAttribute("visibility", "hidden");
      if (wide) view(value(ends[0]), value(ends[1]));
    };
    svg.addEventListener("pointerup", release);
    svg.addEventListener("pointercancel", () => {
      drag = null;
      chosen.setAttribute("visibility", "hidden");
    });
    svg.addEventListener("pointerleave", () => {
      cursor.setAttribute("visibility", "hidden");
      readout.replaceChildren();
    });
    svg.addEventListener("dblclick", all);
    svg.addEventListener("wheel", (event) => {
      // Without Ctrl the wheel scrolls the page.
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      zoom(event.deltaY > 0 ? 1.25 : 0.8, value(place(event)));
    }, { passive: false });
    svg.tabIndex = 0;
    svg.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const keys = {
        "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), 0: all,
        ArrowLeft: () => pan(-0.25), ArrowRight: () => pan(0.25),
      };
      if (!keys[event.key]) return;
      event.preventDefault();
      keys[event.key]();
    });
  };
  for (const svg of document.querySelectorAll("svg")) {
    if (svg.querySelector("g.course path.line")) zoomable(svg);
  }

  // Pages of a file system have no clipboard: there the text is selected to be copied.
  const copy = async (code, said) => {
    try {
      await navigator.clipboard.writeText(code.textContent);
      said.textContent = "copied";
    } catch {
      getSelection().selectAllChildren(code);
      said.textContent = document.execCommand("copy") ? "copied" : "selected: Ctrl+C";
    }
    setTimeout(() => { said.textContent = "Copy"; }, 2000);
  };
  for (const code of document.querySelectorAll("code.command")) {
    const said = button("Copy", "Copy the command", () => copy(code, said));
    said.className = "copy";
    // In a block it floats beside the first line, which begins after it.
    if (code.parentElement.tagName === "PRE") code.before(said); else code.after(said);
  }
})();
