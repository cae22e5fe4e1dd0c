"use strict";
// Surfaces of links by WebGL: shaded, seen through where they are no measurement, with a shadow.
const VERTEX = `
  attribute vec3 corner, normal;
  uniform mat4 whole, pose;
  uniform vec3 scale;
  varying vec3 across, place;
  void main() {
    vec4 at = pose * vec4(scale * corner, 1.0);
    place = at.xyz;
    across = (pose * vec4(normal / scale, 0.0)).xyz;
    gl_Position = whole * at;
  }`;
const FRAGMENT = `
  precision highp float;
  uniform vec3 colour, eye, up;
  uniform float opacity, lit;
  varying vec3 across, place;
  void main() {
    vec3 view = normalize(eye - place), normal = normalize(across);
    normal = dot(normal, view) < 0.0 ? -normal : normal;
    vec3 side = normalize(cross(up, view) + vec3(1e-6));
    vec3 lamp = normalize(view + 0.9 * up - 0.55 * side);
    float sky = 0.5 + 0.5 * dot(normal, up);
    float shine = pow(max(dot(reflect(-lamp, normal), view), 0.0), 24.0);
    vec3 shaded = colour * (0.4 + 0.24 * sky + 0.46 * max(dot(normal, lamp), 0.0)) + 0.1 * shine;
    gl_FragColor = vec4(mix(colour, shaded, lit) * opacity, opacity);
  }`;

// Corners and normals of a packed mesh, each triangle by itself.
const unpacked = ({ low_m, size_m, corners, triangles }) => {
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const numbers = (text) => new Uint16Array(bytes(text).buffer);
  const shares = numbers(corners), order = numbers(triangles), count = order.length / 3;
  const at = Float32Array.from(shares, (share, i) => low_m[i % 3] + size_m[i % 3] * share / 65535);
  // Normals as long as twice the area.
  const flat = new Float32Array(3 * count);
  const around = Array.from({ length: at.length / 3 }, () => []);
  const corner = (number) => [at[3 * number], at[3 * number + 1], at[3 * number + 2]];
  for (let t = 0; t < count; t++) {
    const [a, b, c] = [0, 1, 2].map((k) => corner(order[3 * t + k]));
    flat.set(cross(plus(b, a, -1), plus(c, a, -1)), 3 * t);
    for (let k = 0; k < 3; k++) around[order[3 * t + k]].push(t);
  }
  const normal = (t) => [flat[3 * t], flat[3 * t + 1], flat[3 * t + 2]];
  const data = new Float32Array(18 * count);
  for (let t = 0; t < count; t++) {
    const own = unit(normal(t));
    for (let k = 0; k < 3; k++) {
      const number = order[3 * t + k];
      // Smooth but over edges.
      let sum = [0, 0, 0];
      for (const other of around[number]) {
        const next = normal(other);
        if (dot(own, next) > 0.7 * Math.hypot(...next)) sum = plus(sum, next);
      }
      data.set(corner(number), 18 * t + 6 * k);
      data.set(unit(dot(sum, sum) > 0 ? sum : own), 18 * t + 6 * k + 3);
    }
  }
  return data;
};

// Draws robots; null where the browser has no WebGL.
const solidPainter = (canvas, tree, redraw) => {
  const gl = canvas.getContext("webgl", { stencil: true });
  if (!gl) return null;
  let program, buffers, at = {};
  const shader = (kind, text) => {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  const meshes = tree.meshes.map(unpacked);
  const begin = () => {
    program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, VERTEX));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(program);
    const works = gl.getProgramParameter(program, gl.LINK_STATUS);
    for (const name of ["corner", "normal"]) {
      at[name] = works && gl.getAttribLocation(program, name);
    }
    for (const name of ["whole", "pose", "scale", "colour", "eye", "up", "opacity", "lit"]) {
      at[name] = works && gl.getUniformLocation(program, name);
    }
    buffers = meshes.map((data) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      return buffer;
    });
    return works;
  };
  if (!begin()) return null;
  canvas.addEventListener("webglcontextlost", (e) => e.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { begin(); redraw(); });

  // All parts of a robot, each by `ahead` times its pose.
  const parts = ({ poses, colours }, ahead) => {
    for (const { link, mesh, pose, scale } of tree.parts) {
      const own = product(link === null ? UNIT : poses[link], frameOf(pose));
      gl.uniformMatrix4fv(at.pose, false, ahead ? product(ahead, own) : own);
      gl.uniform3fv(at.scale, scale);
      if (colours) gl.uniform3fv(at.colour, colours(link));
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[mesh]);
      gl.vertexAttribPointer(at.corner, 3, gl.FLOAT, false, 24, 0);
      gl.vertexAttribPointer(at.normal, 3, gl.FLOAT, false, 24, 12);
      gl.drawArrays(gl.TRIANGLES, 0, meshes[mesh].length / 6);
    }
  };
  // Shadows fall along up on the ground, each place once.
  const shadows = (robots, up, ground, opacity) => {
    const flat = UNIT.slice();
    for (let column = 0; column < 3; column++) {
      for (let row = 0; row < 3; row++) flat[4 * column + row] -= up[row] * up[column];
    }
    for (let row = 0; row < 3; row++) flat[12 + row] = up[row] * ground;
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.EQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
    gl.depthMask(false);
    gl.uniform1f(at.lit, 0);
    gl.uniform1f(at.opacity, opacity);
    gl.uniform3fv(at.colour, [0, 0, 0]);
    for (const { poses } of robots) parts({ poses }, flat);
    gl.depthMask(true);
    gl.disable(gl.STENCIL_TEST);
  };
  // Whatever is seen through: only its nearest surface.
  const ghost = (robot) => {
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.colorMask(false, false, false, false);
    gl.uniform1f(at.opacity, robot.opacity);
    parts(robot);
    gl.colorMask(true, true, true, true);
    parts(robot);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  };

  // Robots: poses, colours of a link, opacity.
  return (view, robots, { width, height, up, ground, shadow }) => {
    if (gl.isContextLost()) return;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(program);
    gl.enableVertexAttribArray(at.corner);
    gl.enableVertexAttribArray(at.normal);
    gl.uniformMatrix4fv(at.whole, false, view.whole);
    gl.uniform3fv(at.eye, view.eye);
    gl.uniform3fv(at.up, up);
    const set = (opacity) => { gl.uniform1f(at.lit, 1); gl.uniform1f(at.opacity, opacity); };
    const solid = robots.filter((robot) => robot.opacity === 1);
    set(1);
    for (const robot of solid) parts(robot);
    shadows(solid.length ? solid : robots, up, ground, shadow);
    set(1);
    for (const robot of robots) if (robot.opacity < 1) ghost(robot);
  };
};
