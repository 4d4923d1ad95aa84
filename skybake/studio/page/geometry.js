// Between places in a view and directions; +Y up, -Z north, +X east. The shader has the same formulas.

const DEG = Math.PI / 180;

/** Faces of a horizontal cross: column, row, and right, up and forward of each. */
export const CROSS = [
  { at: [1, 0], right: [1, 0, 0], up: [0, 0, -1], forward: [0, 1, 0] },
  { at: [0, 1], right: [0, 0, 1], up: [0, 1, 0], forward: [-1, 0, 0] },
  { at: [1, 1], right: [1, 0, 0], up: [0, 1, 0], forward: [0, 0, 1] },
  { at: [2, 1], right: [0, 0, -1], up: [0, 1, 0], forward: [1, 0, 0] },
  { at: [3, 1], right: [-1, 0, 0], up: [0, 1, 0], forward: [0, 0, -1] },
  { at: [1, 2], right: [1, 0, 0], up: [0, 0, 1], forward: [0, -1, 0] },
];

/** Width over height of views that have one of their own. */
export const ASPECT = { equirect: 2, cross: 4 / 3, fisheye: 1 };

/** Unit vector of a bearing and an elevation in degrees. */
export function direction(azimuth, elevation) {
  const level = Math.cos(elevation * DEG);
  return [Math.sin(azimuth * DEG) * level, Math.sin(elevation * DEG), -Math.cos(azimuth * DEG) * level];
}

/** Bearing and elevation of a vector, in degrees. */
export function angles([x, y, z]) {
  const azimuth = Math.atan2(x, -z) / DEG;
  return { azimuth: (azimuth + 360) % 360, elevation: Math.atan2(y, Math.hypot(x, z)) / DEG };
}

/** Right, up and forward of a camera. */
export function basis({ azimuth, elevation }) {
  const a = azimuth * DEG;
  const e = elevation * DEG;
  return {
    right: [Math.cos(a), 0, Math.sin(a)],
    up: [-Math.sin(a) * Math.sin(e), Math.cos(e), Math.cos(a) * Math.sin(e)],
    forward: direction(azimuth, elevation),
  };
}

/** Largest rectangle of an aspect in the middle of an area: [x, y, width, height]. */
export function fitted(aspect, width, height) {
  const w = Math.min(width, height * aspect);
  const h = w / aspect;
  return [(width - w) / 2, (height - h) / 2, w, h];
}

/**
 * Direction that a view shows at a place, or null where it shows none.
 * `x` and `y` are shares of width and height of what `fitted` gives, from its upper left.
 */
export function directionAt(kind, camera, x, y, aspect) {
  if (x < 0 || x > 1 || y < 0 || y > 1) return null;
  if (kind === "equirect") return direction(x * 360, 90 - y * 180);
  if (kind === "cross") return crossed(x * 4, y * 3);
  if (kind === "fisheye") return domed(2 * x - 1, 2 * y - 1);
  if (kind === "look") return seen(camera, (2 * x - 1) * aspect, 1 - 2 * y);
  return null;
}

/** Tangent of half the angle that a camera's height covers. */
export function halfHeight({ fov }, aspect) {
  return Math.tan((fov * DEG) / 2) / aspect;
}

function seen(camera, x, y) {
  const { right, up, forward } = basis(camera);
  const half = camera.half;
  return unit(forward.map((value, axis) => value + x * half * right[axis] + y * half * up[axis]));
}

function domed(x, y) {
  const radius = Math.hypot(x, y);
  if (radius > 1) return null;
  // Straight up, with north at the top and east at the left.
  return direction(Math.atan2(-x, -y) / DEG, 90 - radius * 90);
}

function crossed(x, y) {
  const face = CROSS.find(({ at }) => at[0] === Math.floor(x) && at[1] === Math.floor(y));
  if (!face) return null;
  const u = 2 * (x % 1) - 1;
  const v = 2 * (y % 1) - 1;
  return unit(face.forward.map((value, axis) => value + u * face.right[axis] - v * face.up[axis]));
}

function unit(vector) {
  const length = Math.hypot(...vector);
  return vector.map((value) => value / length);
}
