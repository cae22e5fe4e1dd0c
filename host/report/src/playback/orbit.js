"use strict";
// A camera that looks at a place from around it, moved by mouse, touch and keys.
const orbitCamera = (stage, up, redraw) => {
  const LENS = Math.tan(Math.PI / 10);
  const START = { yaw: -0.9, tilt: 0.32, zoom: 0.9, shift: [0, 0, 0] };
  // Directions across up: the base's x where that is not up.
  const level = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const ahead = unit(plus(level, up, -dot(level, up))), left = cross(up, ahead);
  let at = { ...START }, centre = [0, 0, 0], radius = 1;
  const limit = (value, low, high) => Math.min(Math.max(value, low), high);
  const back = () => {
    const flat = plus(ahead.map((v) => v * Math.cos(at.yaw)), left, Math.sin(at.yaw));
    return plus(flat.map((v) => v * Math.cos(at.tilt)), up, Math.sin(at.tilt));
  };

  // What is needed to draw on so many pixels.
  const seen = (width, height) => {
    const aspect = width / height, narrow = LENS * Math.min(1, aspect);
    const distance = at.zoom * radius * Math.hypot(1, narrow) / narrow;
    const out = back(), target = plus(centre, at.shift), eye = plus(target, out, distance);
    const right = unit(cross(up, out)), above = cross(out, right);
    const near = distance / 50, far = distance + 30 * radius, depth = near - far;
    const look = [
      right[0], above[0], out[0], 0, right[1], above[1], out[1], 0, right[2], above[2], out[2], 0,
      -dot(right, eye), -dot(above, eye), -dot(out, eye), 1,
    ];
    const lens = [1 / (LENS * aspect), 0, 0, 0, 0, 1 / LENS, 0, 0,
      0, 0, (far + near) / depth, -1, 0, 0, 2 * far * near / depth, 0];
    const whole = product(lens, look);
    const pixels = height / (2 * LENS);
    return {
      eye, right, above, out, whole, distance,
      // x, y in pixels and the distance ahead; none behind the eye.
      project: (point) => {
        const away = plus(point, eye, -1), ahead = -dot(out, away);
        if (ahead < near) return null;
        const scale = pixels / ahead;
        const x = width / 2 + dot(right, away) * scale;
        return [x, height / 2 - dot(above, away) * scale, ahead, scale];
      },
    };
  };

  const look = (yaw, tilt) => {
    Object.assign(at, { yaw, tilt: limit(tilt, -1.5, 1.5) });
    redraw();
  };
  const turn = (yaw, tilt) => look(at.yaw + yaw, at.tilt + tilt);
  const zoom = (by) => { at.zoom = limit(at.zoom * by, 0.02, 20); redraw(); };
  // By so many pixels.
  const pan = (x, y) => {
    const box = stage.getBoundingClientRect(), view = seen(box.width, box.height);
    const size = 2 * LENS * view.distance / box.height;
    at.shift = plus(plus(at.shift, view.right, -x * size), view.above, y * size);
    redraw();
  };
  const reset = () => { at = { ...START }; redraw(); };

  const touches = new Map();
  const spread = () => {
    const [a, b] = [...touches.values()];
    const far = Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;
    return { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, far };
  };
  stage.addEventListener("pointerdown", (e) => {
    stage.setPointerCapture(e.pointerId);
    touches.set(e.pointerId, [e.clientX, e.clientY]);
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    stage.addEventListener(kind, (e) => touches.delete(e.pointerId));
  }
  stage.addEventListener("pointermove", (e) => {
    const last = touches.get(e.pointerId);
    if (!last) return;
    const x = e.clientX - last[0], y = e.clientY - last[1];
    if (touches.size === 2) {
      const before = spread();
      touches.set(e.pointerId, [e.clientX, e.clientY]);
      const now = spread();
      pan(now.x - before.x, now.y - before.y);
      zoom(before.far / now.far);
      return;
    }
    touches.set(e.pointerId, [e.clientX, e.clientY]);
    if (e.buttons & 6 || e.shiftKey) pan(x, y); else turn(-x / 160, y / 160);
  });
  stage.addEventListener("contextmenu", (e) => e.preventDefault());
  stage.addEventListener("dblclick", reset);
  stage.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(Math.exp(limit(e.deltaY, -200, 200) / 500));
  }, { passive: false });

  const STEP = 0.12, SHIFT = 30;
  const arrow = (x, y) => (e) =>
    (e.shiftKey ? pan(-x * SHIFT, -y * SHIFT) : turn(x * STEP, -y * STEP));
  return {
    seen, ahead, left,
    // What is to be seen: a ball.
    frame: (middle, size) => { centre = middle; radius = size; },
    keys: {
      j: arrow(-1, 0), l: arrow(1, 0), i: arrow(0, -1), k: arrow(0, 1),
      u: () => zoom(0.9), o: () => zoom(1 / 0.9), r: reset,
      1: () => look(0, 0), 2: () => look(-Math.PI / 2, 0), 3: () => look(-Math.PI / 2, 1.5),
    },
  };
};
