// What a scene is made of: indexed triangles, strands, splats or single fragments, in arrays that a GPU takes as they
// are.

import { add, cross, frameOf, sub, unit } from "./vector.js";

/** Bytes of a vertex: position (3 f32), normal and rim (4 snorm8), colour and alpha (4 unorm8). */
export const VERTEX_BYTES = 20;
/** Bytes of a splat: centre (3 f32), covariance xx xy xz yy yz zz (6 f32), colour and alpha (4 unorm8). */
export const SPLAT_BYTES = 40;
/** Bytes of a listed fragment: pixel (u32), view depth, red, green, blue, alpha (5 f32). */
export const FRAGMENT_BYTES = 24;

/**
 * Collects triangles. A surface is drawn from both sides; its colour is linear. `group` starts a new object, which
 * the method that sorts objects draws in one go.
 */
export class TriangleBuilder {
  constructor() {
    this.floats = [];
    this.bytes = [];
    this.indices = [];
    this.groups = [];
  }

  get vertices() {
    return this.bytes.length / 8;
  }

  /** Starts a new object. */
  group() {
    const first = this.indices.length;
    const last = this.groups.at(-1);
    if (last && last.first === first) return;
    this.groups.push({ first, count: 0 });
  }

  /** Adds a vertex and returns its index. `paint` is { color, alpha, rim }, or for strands { color, alpha, side }. */
  vertex(position, normal, paint) {
    const snorm = (x) => Math.round(127 * Math.min(1, Math.max(-1, x))) & 255;
    const unorm = (x) => Math.round(255 * Math.min(1, Math.max(0, x)));
    this.floats.push(position[0], position[1], position[2]);
    const fourth = paint.side ?? paint.rim ?? 0;
    this.bytes.push(snorm(normal[0]), snorm(normal[1]), snorm(normal[2]), snorm(fourth));
    this.bytes.push(unorm(paint.color[0]), unorm(paint.color[1]), unorm(paint.color[2]), unorm(paint.alpha));
    return this.vertices - 1;
  }

  triangle(a, b, c) {
    this.indices.push(a, b, c);
  }

  /** A flat polygon of three or four corners. */
  flat(corners, paint) {
    const normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
    const ids = corners.map((p) => this.vertex(p, normal, paint));
    for (let i = 2; i < ids.length; i++) this.triangle(ids[0], ids[i - 1], ids[i]);
  }

  /** A box with the corner `from`, edges x, y, z; `faces` and `edges` are its paints. */
  pane(from, x, y, z, face, edge) {
    const corner = (i) => {
      let p = from;
      if (i & 1) p = add(p, x);
      if (i & 2) p = add(p, y);
      if (i & 4) p = add(p, z);
      return p;
    };
    for (const ids of [
      [0, 1, 3, 2],
      [4, 5, 7, 6],
    ])
      this.flat(ids.map(corner), face);
    for (const ids of [
      [0, 2, 6, 4],
      [1, 3, 7, 5],
      [0, 1, 5, 4],
      [2, 3, 7, 6],
    ])
      this.flat(ids.map(corner), edge);
  }

  /**
   * A smooth surface over the unit square, `point(u, v)` on a grid of columns x rows. Normals are differences, taken a
   * little way off v = 0 and v = 1, where a ring may be a point. `paint` may be a function of (u, v).
   */
  surface(columns, rows, paint, point) {
    const step = 1e-3;
    const first = this.vertices;
    for (let j = 0; j <= rows; j++) {
      for (let i = 0; i <= columns; i++) {
        const u = i / columns;
        const v = j / rows;
        const inner = Math.min(1 - 2 * step, Math.max(2 * step, v));
        const along = sub(point(u + step, inner), point(u - step, inner));
        const up = sub(point(u, Math.min(1, inner + step)), point(u, Math.max(0, inner - step)));
        this.vertex(point(u, v), unit(cross(up, along)), typeof paint === "function" ? paint(u, v) : paint);
      }
    }
    for (let j = 0; j < rows; j++) {
      for (let i = 0; i < columns; i++) {
        const a = first + j * (columns + 1) + i;
        const c = a + columns + 2;
        this.triangle(a, a + 1, c);
        this.triangle(a, c, c - 1);
      }
    }
  }

  /** A ball. */
  sphere(center, radius, paint, columns = 56) {
    this.surface(columns, columns >> 1, paint, (u, v) => {
      const ring = radius * Math.sin(Math.PI * v);
      const angle = 2 * Math.PI * u;
      return add(center, [ring * Math.cos(angle), radius * Math.cos(Math.PI * v), ring * Math.sin(angle)]);
    });
  }

  /** A surface of revolution about a vertical axis: `outline` holds radii and heights, joined by a smooth curve. */
  lathe(origin, outline, paint, columns = 64, rows = 40) {
    this.surface(columns, rows, paint, (u, v) => {
      const [r, y] = smooth(outline, v);
      const angle = 2 * Math.PI * u;
      return add(origin, [r * Math.cos(angle), y, r * Math.sin(angle)]);
    });
  }

  /** A round tube along `curve(t)`, t in [0, 1], of radius `radius(t)`, open at both ends. */
  tube(paint, curve, radius, columns = 12, rows = 12) {
    this.surface(columns, rows, paint, (u, t) => {
      const [x, y] = frameOf(sub(curve(t + 1e-3), curve(t - 1e-3)));
      const [c, s] = [Math.cos(2 * Math.PI * u) * radius(t), Math.sin(2 * Math.PI * u) * radius(t)];
      return add(curve(t), [c * x[0] + s * y[0], c * x[1] + s * y[1], c * x[2] + s * y[2]]);
    });
  }

  /** { kind, vertices, indices, groups, bounds } for the renderers. */
  finish(kind = "triangles") {
    const count = this.vertices;
    const vertices = new ArrayBuffer(Math.max(1, count) * VERTEX_BYTES);
    const floats = new Float32Array(vertices);
    const bytes = new Uint8Array(vertices);
    for (let i = 0; i < count; i++) {
      floats.set(this.floats.slice(3 * i, 3 * i + 3), 5 * i);
      bytes.set(this.bytes.slice(8 * i, 8 * i + 8), 20 * i + 12);
    }
    if (this.groups.length === 0) this.group();
    const groups = this.groups
      .map((g, i) => ({
        first: g.first,
        count: (this.groups[i + 1]?.first ?? this.indices.length) - g.first,
      }))
      .filter((g) => g.count > 0);
    for (const group of groups) {
      const bounds = new Bounds();
      for (let i = group.first; i < group.first + group.count; i++) {
        const k = 3 * this.indices[i];
        bounds.take(this.floats[k], this.floats[k + 1], this.floats[k + 2]);
      }
      group.center = bounds.center;
    }
    const bounds = new Bounds();
    for (let i = 0; i < count; i++) bounds.take(this.floats[3 * i], this.floats[3 * i + 1], this.floats[3 * i + 2]);
    return { kind, vertices, indices: new Uint32Array(this.indices), groups, bounds };
  }
}

/** Collects Gaussian splats. */
export class SplatBuilder {
  constructor() {
    this.items = [];
  }

  /** A splat with standard deviations `size` along the axes of a rotation (three unit vectors). */
  splat(center, axes, size, color, alpha) {
    const c = [0, 0, 0, 0, 0, 0];
    for (let k = 0; k < 3; k++) {
      const [x, y, z] = axes[k];
      const s = size[k] * size[k];
      c[0] += s * x * x;
      c[1] += s * x * y;
      c[2] += s * x * z;
      c[3] += s * y * y;
      c[4] += s * y * z;
      c[5] += s * z * z;
    }
    this.items.push([...center, ...c, ...color, alpha]);
  }

  finish() {
    const count = this.items.length;
    const vertices = new ArrayBuffer(Math.max(1, count) * SPLAT_BYTES);
    const floats = new Float32Array(vertices);
    const bytes = new Uint8Array(vertices);
    const bounds = new Bounds();
    this.items.forEach((item, i) => {
      floats.set(item.slice(0, 9), 10 * i);
      bytes.set(
        item.slice(9).map((x) => Math.round(255 * Math.min(1, Math.max(0, x)))),
        40 * i + 36,
      );
      bounds.take(item[0], item[1], item[2]);
    });
    return { kind: "splats", vertices, count, groups: [], bounds };
  }
}

/** An axis-aligned box that grows. */
export class Bounds {
  constructor() {
    this.least = [Infinity, Infinity, Infinity];
    this.greatest = [-Infinity, -Infinity, -Infinity];
  }

  take(x, y, z) {
    const [a, b] = [this.least, this.greatest];
    a[0] = Math.min(a[0], x);
    a[1] = Math.min(a[1], y);
    a[2] = Math.min(a[2], z);
    b[0] = Math.max(b[0], x);
    b[1] = Math.max(b[1], y);
    b[2] = Math.max(b[2], z);
  }

  get empty() {
    return !(this.least[0] <= this.greatest[0]);
  }

  get center() {
    return this.empty ? [0, 0, 0] : this.least.map((x, i) => 0.5 * (x + this.greatest[i]));
  }

  /** Half the diagonal. */
  get radius() {
    return this.empty ? 1 : 0.5 * Math.hypot(...this.least.map((x, i) => this.greatest[i] - x));
  }

  /** The eight corners. */
  get corners() {
    return Array.from({ length: 8 }, (_, k) => [0, 1, 2].map((i) => ((k >> i) & 1 ? this.greatest : this.least)[i]));
  }
}

/** A smooth curve through points of two numbers (Catmull-Rom), v in [0, 1]; the first number is never below 0. */
function smooth(points, v) {
  const last = points.length - 1;
  const s = Math.min(1, Math.max(0, v)) * last;
  const k = Math.min(last - 1, Math.floor(s));
  const t = s - k;
  const at = (i) => points[Math.min(last, Math.max(0, i))];
  const [p0, p1, p2, p3] = [at(k - 1), at(k), at(k + 1), at(k + 2)];
  const value = (c) => {
    const a = (p2[c] - p0[c]) / 2;
    const b = (p3[c] - p1[c]) / 2;
    const d = p2[c] - p1[c];
    return p1[c] + t * (a + t * (3 * d - 2 * a - b + t * (a + b - 2 * d)));
  };
  return [Math.max(0, value(0)), value(1)];
}
