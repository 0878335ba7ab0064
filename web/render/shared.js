// What both renderers share: the camera's numbers, the frame's uniform data, objects from far to near, the floor's
// shadow.

import { FRAGMENT_BYTES, SPLAT_BYTES, VERTEX_BYTES } from "../scene/geometry.js";
import { dot, lookAt, multiply, perspective, sub, unit } from "../scene/vector.js";

export const NEAR = 0.05;
export const FAR = 200;

/** Vertex layouts by kind of geometry: name of the WGSL file, bytes, attributes in the order of their locations. */
export const KINDS = {
  triangles: {
    stride: VERTEX_BYTES,
    attributes: [
      [0, "float32x3"],
      [12, "snorm8x4"],
      [16, "unorm8x4"],
    ],
  },
  strands: {
    stride: VERTEX_BYTES,
    attributes: [
      [0, "float32x3"],
      [12, "snorm8x4"],
      [16, "unorm8x4"],
    ],
  },
  splats: {
    stride: SPLAT_BYTES,
    attributes: [
      [0, "float32x3"],
      [12, "float32x3"],
      [24, "float32x3"],
      [36, "unorm8x4"],
    ],
  },
  fragments: {
    stride: FRAGMENT_BYTES,
    attributes: [
      [0, "uint32"],
      [4, "float32"],
      [8, "float32x4"],
    ],
  },
};

/** Eye, matrices and depth range of an orbit camera { target, yaw, pitch, distance, fov (degrees) } on a scene. */
export function viewOf(camera, geometry, width, height, symmetric) {
  const { target, yaw, pitch, distance, fov } = camera;
  const back = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
  const eye = target.map((x, i) => x + distance * back[i]);
  const view = lookAt(eye, target);
  // A tall image keeps the horizontal angle of a square one, so that nothing is cut off on a phone.
  const half = Math.tan((fov * Math.PI) / 360);
  const vertical = 2 * Math.atan(width < height ? (half * height) / width : half);
  const projection = perspective(vertical, width / height, NEAR, FAR, symmetric);
  let range;
  if (geometry.range) {
    range = geometry.range;
  } else {
    const depths = geometry.bounds.corners.map((p) => dot(sub(eye, p), back));
    const margin = 0.02 * geometry.bounds.radius;
    const least = Math.max(NEAR, Math.min(...depths) - margin);
    range = [least, Math.max(least * 1.001, Math.max(...depths) + margin)];
  }
  return {
    eye,
    back,
    view,
    clip: multiply(projection, view),
    focal: (0.5 * height) / Math.tan(vertical / 2),
    range: range.map(Math.fround),
  };
}

/** Floats of a frame's uniform block, in the order of wgsl/frame.wgsl. */
export const FRAME_FLOATS = 56;

/** The power of two that takes v to [1/2, 1). */
const scaleBelow1 = (v) => 2 ** -(Math.floor(Math.log2(v)) + 1);

/** Fills the frame's uniform block. */
export function frameData(out, view, width, height, scene, options, band = { firstRow: 0, capacity: 0 }) {
  out.set(view.clip, 0);
  out.set(view.view, 16);
  out.set([...view.eye, options.opacity], 32);
  out.set([...view.range, width, height], 36);
  out.set([view.focal, scene.gloss, scene.strandWidth, scaleBelow1(view.range[1])], 40);
  out.set(options.backdrop ? [...options.backdrop, 0] : [0.8, 0.8, 0.8, 1], 44);
  out.set([scene.floor, 0, 0, options.oneColor ? 1 : 0], 48);
  new Uint32Array(out.buffer, out.byteOffset).set([band.firstRow, band.capacity], 49);
  return out;
}

/** The groups of a geometry, farthest first, by the view depth of their centres. */
export function farToNear(geometry, view) {
  const depth = (g) => dot(sub(view.eye, g.center), view.back);
  return [...geometry.groups].sort((a, b) => depth(b) - depth(a));
}

/** The vertices of splats, farthest first. */
export function sortedSplats(geometry, view) {
  const source = new Float32Array(geometry.vertices);
  const [words, n] = [SPLAT_BYTES / 4, geometry.count];
  const offset = dot(view.eye, view.back);
  const depth = new Float32Array(n);
  for (let i = 0; i < n; i++) {
    const k = i * words;
    depth[i] = offset - (source[k] * view.back[0] + source[k + 1] * view.back[1] + source[k + 2] * view.back[2]);
  }
  const order = Uint32Array.from({ length: n }, (_, i) => i).sort((a, b) => depth[b] - depth[a]);
  const from = new Uint32Array(geometry.vertices);
  const sorted = new Uint32Array(n * words);
  for (let i = 0; i < n; i++) sorted.set(from.subarray(order[i] * words, (order[i] + 1) * words), i * words);
  return sorted;
}

/** Columns and rows of the floor's shadow. */
export const SHADOW = 192;

/**
 * Light that reaches the floor through what stands on it, as SHADOW x SHADOW rgba8 (square roots are not taken:
 * linear). Triangles and splats are projected along the lamp, their absorbance is spread over cells and blurred.
 */
export function shadowOf(scene) {
  const size = SHADOW;
  const sums = [0, 1, 2].map(() => new Float32Array(size * size));
  const lamp = unit([-0.45, 0.75, 0.5]);
  const cell = (2 * scene.floor) / size;
  const put = (p, color, optical) => {
    const t = p[1] / lamp[1];
    const x = (p[0] - t * lamp[0] + scene.floor) / cell - 0.5;
    const y = (p[2] - t * lamp[2] + scene.floor) / cell - 0.5;
    const [i, j] = [Math.floor(x), Math.floor(y)];
    if (i < 0 || j < 0 || i >= size - 1 || j >= size - 1) return;
    for (const [k, w] of [
      [0, (1 - x + i) * (1 - y + j)],
      [1, (x - i) * (1 - y + j)],
      [size, (1 - x + i) * (y - j)],
      [size + 1, (x - i) * (y - j)],
    ]) {
      for (let c = 0; c < 3; c++) sums[c][j * size + i + k] += w * optical * (1.08 - color[c]);
    }
  };
  for (const [geometry, opaque] of [
    [scene.transparent, false],
    [scene.opaque, true],
  ]) {
    if (!geometry || geometry.kind === "fragments") continue;
    const floats = new Float32Array(geometry.vertices);
    const bytes = new Uint8Array(geometry.vertices);
    const words = KINDS[geometry.kind].stride / 4;
    const color = (i) => [0, 1, 2, 3].map((c) => bytes[i * words * 4 + words * 4 - 4 + c] / 255);
    const at = (i) => floats.subarray(i * words, i * words + 3);
    const absorb = (a) => (opaque ? 1.6 : Math.min(2.5, -Math.log(Math.max(1e-3, 1 - a))));
    if (geometry.kind === "splats") {
      for (let i = 0; i < geometry.count; i++) {
        const k = i * words;
        const size2 = Math.cbrt(floats[k + 3] * floats[k + 6] * floats[k + 8]);
        const [r, g, b, a] = color(i);
        put(at(i), [r, g, b], Math.min(2, (absorb(a) * 6 * Math.max(size2, 4e-4)) / (cell * cell)));
      }
      continue;
    }
    for (let t = 0; t < geometry.indices.length; t += 3) {
      const [i, j, k] = geometry.indices.subarray(t, t + 3);
      const [p, q, s] = [at(i), at(j), at(k)];
      const [u, v] = [sub(q, p), sub(s, p)];
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      let area = (0.5 * Math.abs(dot(n, lamp))) / lamp[1];
      if (geometry.kind === "strands") area = 0.25 * scene.strandWidth * Math.hypot(v[0], v[1], v[2]);
      const [r, g, b, a] = color(i);
      const pieces = Math.max(1, Math.ceil(Math.sqrt(area) / cell));
      const share = (0.8 * absorb(a) * area) / (cell * cell) / (pieces * pieces);
      for (let x = 0; x < pieces; x++) {
        for (let y = 0; y < pieces; y++) {
          const upper = x + y >= pieces;
          const [f, h] = [(x + (upper ? 0.67 : 0.33)) / pieces, (y + (upper ? 0.67 : 0.33)) / pieces];
          const [e, w] = f + h > 1 ? [1 - f, 1 - h] : [f, h];
          put(
            [0, 1, 2].map((c) => p[c] + e * u[c] + w * v[c]),
            [r, g, b],
            share,
          );
        }
      }
    }
  }
  const out = new Uint8Array(size * size * 4).fill(255);
  for (let c = 0; c < 3; c++) {
    let plane = sums[c];
    for (let pass = 0; pass < 3; pass++) plane = blurred(plane, size, 2);
    for (let i = 0; i < size * size; i++) {
      const edge = Math.min(i % size, size - 1 - (i % size), Math.floor(i / size), size - 1 - Math.floor(i / size));
      const fade = Math.min(1, edge / 20);
      out[4 * i + c] = Math.round(255 * (1 - 0.6 * fade * (1 - Math.exp(-0.5 * plane[i]))));
    }
  }
  return out;
}

function blurred(plane, size, reach) {
  const pass = (from, step, other) => {
    const to = new Float32Array(size * size);
    for (let a = 0; a < size; a++) {
      let sum = 0;
      for (let b = -reach; b < size + reach; b++) {
        if (b + reach < size) sum += from[a * other + (b + reach) * step];
        if (b - reach - 1 >= 0) sum -= from[a * other + (b - reach - 1) * step];
        if (b >= 0 && b < size) to[a * other + b * step] = sum / (2 * reach + 1);
      }
    }
    return to;
  };
  return pass(pass(plane, 1, size), size, 1);
}

/** What the exact image depends on, besides scene and size; an image is drawn again when it changes. */
export const exactKey = (renderer, { camera, opacity, backdrop, oneColor, transparentOnly }) =>
  JSON.stringify([camera, opacity, backdrop, !!oneColor, !!transparentOnly, renderer.bands]);

/**
 * A network's source for sums that are stored in 16 bits: what thin pixels take for noise follows from how sums are
 * rounded, here to 2^-10 of b0 instead of 2^-23.
 */
export function rounded(source, constant) {
  if (!constant.test(source)) throw new Error(`the network's source has no ${constant}`);
  return source.replace(constant, "$19.765625e-4;");
}
