// Vectors of three numbers, column-major 4 x 4 matrices, and the random numbers of the scenes.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const mix = (a, b, t) => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])];

/** a / |a|; the zero vector where a has no direction. */
export function unit(a) {
  const length = Math.hypot(a[0], a[1], a[2]);
  return length > 0 ? scale(a, 1 / length) : [0, 0, 0];
}

/** A right-handed orthonormal frame whose third axis is `axis`. */
export function frameOf(axis) {
  const w = unit(axis);
  const u = unit(cross(Math.abs(w[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], w));
  return [u, cross(w, u), w];
}

/** The product a b. */
export function multiply(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + r] * b[4 * c + k];
      out[4 * c + r] = sum;
    }
  }
  return out;
}

/** World to view space: the viewer at the origin looks along -z. */
export function lookAt(eye, target, up = [0, 1, 0]) {
  const back = unit(sub(eye, target));
  const right = unit(cross(up, back));
  const above = cross(back, right);
  return new Float32Array([
    right[0],
    above[0],
    back[0],
    0,
    right[1],
    above[1],
    back[1],
    0,
    right[2],
    above[2],
    back[2],
    0,
    -dot(right, eye),
    -dot(above, eye),
    -dot(back, eye),
    1,
  ]);
}

/**
 * A perspective projection; w of clip space is the distance along the view direction.
 * Window depth runs from 0 to 1 (WebGPU), or from -1 to 1 before the viewport (OpenGL) if `symmetric`.
 */
export function perspective(verticalFov, aspect, near, far, symmetric) {
  const f = 1 / Math.tan(verticalFov / 2);
  const out = new Float32Array(16);
  out[0] = f / aspect;
  out[5] = f;
  out[10] = symmetric ? (near + far) / (near - far) : far / (near - far);
  out[11] = -1;
  out[14] = symmetric ? (2 * near * far) / (near - far) : (near * far) / (near - far);
  return out;
}

/** Random numbers in [0, 1) from a seed: mulberry32, the same on every machine. */
export function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Uniform in [lo, hi). */
export const between = (rng, lo, hi) => lo + (hi - lo) * rng();

/** Uniform on the unit sphere. */
export function direction(rng) {
  const y = between(rng, -1, 1);
  const angle = between(rng, 0, 2 * Math.PI);
  const r = Math.sqrt(Math.max(0, 1 - y * y));
  return [r * Math.cos(angle), y, r * Math.sin(angle)];
}
