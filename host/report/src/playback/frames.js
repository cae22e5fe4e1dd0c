"use strict";
// Frames of links: 4 x 4 matrices by columns, as WebGL takes them.
const UNIT = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const product = (a, b) => {
  const out = new Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
      out[4 * column + row] = sum;
    }
  }
  return out;
};
// Of a place x, y, z and a unit quaternion x, y, z, w.
const frameOf = ([px, py, pz, x, y, z, w]) => [
  1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0,
  2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0,
  2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0,
  px, py, pz, 1,
];
const placed = (m, [x, y, z]) =>
  [0, 1, 2].map((i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);
const plus = (a, b, share = 1) => a.map((value, i) => value + share * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = (a) => { const long = Math.hypot(...a) || 1; return a.map((value) => value / long); };

// What a joint does to its link's frame: rad about its axis, or m along it.
const moved = ({ axis, slides }, value) => {
  if (slides) return frameOf([...axis.map((part) => part * value), 0, 0, 0, 1]);
  const sine = Math.sin(value / 2);
  return frameOf([0, 0, 0, ...axis.map((part) => part * sine), Math.cos(value / 2)]);
};
// Poses of the links' frames in the base's, of a value for each joint, rad or m.
const linkPoses = (tree, values) => {
  const poses = [];
  tree.links.forEach((link, i) => {
    const own = product(frameOf(link.place), moved(link, values[i]));
    poses.push(link.parent === null ? own : product(poses[link.parent], own));
  });
  return poses;
};
// The bones of a robot: from where to where, how thick, of which link; -1 is the base.
const bonesOf = (tree, poses) => {
  const of = (pose, bones, link, radius) => bones.map((end) =>
    ({ from: placed(pose, [0, 0, 0]), to: placed(pose, end), link, radius }));
  const thick = Math.max(...tree.links.map((link) => link.radius_m));
  const all = of(UNIT, tree.base_bones_m, -1, thick);
  tree.links.forEach((link, i) => {
    all.push(...of(poses[i], link.bones_m, i, link.radius_m));
    // A slide's rail: from where its link stands at 0.
    if (!link.slides) return;
    const parent = link.parent === null ? UNIT : poses[link.parent];
    const from = placed(parent, link.place.slice(0, 3));
    all.push({ from, to: placed(poses[i], [0, 0, 0]), link: i, radius: link.radius_m });
  });
  return all;
};
