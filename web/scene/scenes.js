// The built-in scenes. Each is made from a seed, so that it is the same on every machine; `detail` in (0, 1] thins out
// what is many.

import { SplatBuilder, TriangleBuilder } from "./geometry.js";
import { add, between, cross, direction, frameOf, mix, random, scale, unit } from "./vector.js";

const TAU = 2 * Math.PI;

/** The menu: name, title, what it is for, and how it is made. */
export const SCENES = [
  { name: "glass", title: "Glassware", note: "vases, bottles and bowls inside one another", make: glassware },
  { name: "panes", title: "Panes", note: "stacks of glass, up to fifty layers deep", make: panes },
  {
    name: "spheres",
    title: "Spheres",
    note: "balls that cut through one another: no order of objects is right",
    make: spheres,
  },
  { name: "foliage", title: "Foliage", note: "thousands of nearly opaque leaves", make: foliage },
  { name: "hair", title: "Hair", note: "strands thinner than a pixel", make: hair },
  { name: "crowd", title: "Crowd", note: "two hundred translucent figures", make: crowd },
  { name: "smoke", title: "Smoke", note: "soft particles, a hundred deep", make: smoke },
  { name: "splats", title: "Splats", note: "Gaussian splats along a knot", make: knot },
];

/** Makes a scene: { name, title, transparent, opaque, view, gloss, strandWidth, floor }. */
export function makeScene(name, detail = 1) {
  const entry = SCENES.find((s) => s.name === name);
  if (!entry) throw new Error(`no scene is called "${name}"; there are ${SCENES.map((s) => s.name).join(", ")}`);
  const scene = { name, title: entry.title, gloss: 0, strandWidth: 0, floor: 0, opaque: null, ...entry.make(detail) };
  if (scene.transparent.bounds.empty) throw new Error(`the scene "${name}" is empty at detail ${detail}`);
  return scene;
}

function glassware() {
  const out = new TriangleBuilder();
  const inner = (outline, thick) => outline.slice(1).map(([r, y]) => [Math.max(0, r - thick), y + 0.02]);
  const vessel = (origin, outline, color, alpha, thick = 0.035) => {
    out.group();
    out.lathe(origin, outline, { color, alpha, rim: 0.62 });
    out.group();
    out.lathe(origin, [[0, outline[0][1] + 0.05], ...inner(outline, thick)], { color, alpha: alpha * 0.6, rim: 0.5 });
  };
  const liquid = (origin, outline, color) => {
    out.group();
    out.lathe(origin, outline, { color, alpha: 0.55, rim: 0.25 }, 64, 24);
  };
  const VASE = [
    [0, 0],
    [0.3, 0.0],
    [0.42, 0.15],
    [0.5, 0.45],
    [0.42, 0.85],
    [0.22, 1.2],
    [0.18, 1.45],
    [0.3, 1.62],
  ];
  const BOTTLE = [
    [0, 0],
    [0.33, 0],
    [0.36, 0.1],
    [0.36, 0.6],
    [0.36, 1.0],
    [0.26, 1.25],
    [0.11, 1.42],
    [0.1, 1.8],
    [0.13, 1.86],
  ];
  const BOWL = [
    [0, 0],
    [0.25, 0],
    [0.3, 0.05],
    [0.55, 0.2],
    [0.78, 0.45],
    [0.85, 0.62],
  ];
  const GOBLET = [
    [0, 0],
    [0.32, 0.0],
    [0.28, 0.05],
    [0.06, 0.12],
    [0.05, 0.5],
    [0.08, 0.62],
    [0.34, 0.85],
    [0.4, 1.15],
    [0.33, 1.45],
  ];
  const TUMBLER = [
    [0, 0],
    [0.25, 0],
    [0.29, 0.04],
    [0.31, 0.4],
    [0.34, 0.8],
  ];
  vessel([-1.25, 0, 0.35], VASE, [0.15, 0.45, 0.85], 0.32);
  vessel([0.0, 0, -0.55], BOTTLE, [0.1, 0.62, 0.42], 0.36);
  liquid(
    [0.0, 0.06, -0.55],
    [
      [0, 0],
      [0.3, 0],
      [0.31, 0.1],
      [0.31, 0.4],
      [0.31, 0.66],
      [0, 0.66],
    ],
    [0.72, 0.12, 0.25],
  );
  vessel([1.3, 0, 0.1], BOWL, [0.95, 0.55, 0.12], 0.34);
  vessel([1.24, 0.12, 0.12], TUMBLER, [0.85, 0.25, 0.45], 0.35, 0.03);
  vessel([0.28, 0, 0.75], GOBLET, [0.75, 0.78, 0.9], 0.26);
  liquid(
    [0.28, 0.66, 0.75],
    [
      [0, 0],
      [0.14, 0.06],
      [0.3, 0.2],
      [0.36, 0.42],
      [0, 0.44],
    ],
    [0.85, 0.15, 0.2],
  );
  vessel([-0.5, 0, 0.9], TUMBLER, [0.25, 0.75, 0.8], 0.32, 0.03);
  liquid(
    [-0.5, 0.05, 0.9],
    [
      [0, 0],
      [0.2, 0.0],
      [0.25, 0.05],
      [0.27, 0.42],
      [0, 0.43],
    ],
    [0.95, 0.62, 0.1],
  );
  vessel([-0.55, 0, -1.05], VASE, [0.8, 0.3, 0.75], 0.34);
  vessel([1.05, 0, -1.15], BOTTLE, [0.55, 0.4, 0.9], 0.34);
  vessel([-1.75, 0, -0.75], TUMBLER, [0.95, 0.45, 0.3], 0.38, 0.03);
  vessel([1.95, 0, -0.75], GOBLET, [0.4, 0.8, 0.55], 0.3);
  out.group();
  out.sphere([-1.25, 0.42, 0.35], 0.28, { color: [0.98, 0.8, 0.3], alpha: 0.35, rim: 0.4 });
  return {
    transparent: out.finish(),
    gloss: 0.85,
    floor: 5,
    view: { target: [0.05, 0.66, 0], yaw: 0.42, pitch: 0.3, distance: 6.4, fov: 36 },
  };
}

function panes() {
  const COLORS = [
    [0.15, 0.5, 0.95],
    [0.1, 0.75, 0.55],
    [0.98, 0.72, 0.15],
    [0.95, 0.3, 0.25],
    [0.62, 0.35, 0.92],
    [0.2, 0.8, 0.9],
  ];
  const rng = random(7);
  const out = new TriangleBuilder();
  for (let stack = 0; stack < 9; stack++) {
    const turn = between(rng, -0.35, 0.35);
    const x = [Math.cos(turn), 0, -Math.sin(turn)];
    const z = [Math.sin(turn), 0, Math.cos(turn)];
    const origin = [((stack % 3) - 1) * 1.4, 0, (Math.floor(stack / 3) - 1) * 1.4];
    const first = Math.floor(between(rng, 0, 6));
    for (let pane = 0; pane < 9; pane++) {
      const color = mix(COLORS[first], COLORS[(first + 1 + (stack % 2)) % 6], pane / 8);
      const alpha = between(rng, 0.08, 0.36);
      const from = add(origin, add(scale(x, -0.46), scale(z, (pane / 8 - 0.5) * 0.9)));
      out.group();
      out.pane(
        from,
        scale(x, 0.92),
        [0, between(rng, 0.75, 1.2), 0],
        scale(z, 0.024),
        { color, alpha, rim: 0.35 },
        { color: mix(color, [0.1, 0.3, 0.3], 0.3), alpha: 0.6, rim: 0 },
      );
    }
  }
  return {
    transparent: out.finish(),
    gloss: 0.5,
    floor: 5,
    view: { target: [0, 0.42, 0], yaw: 0.55, pitch: 0.33, distance: 6.6, fov: 36 },
  };
}

function spheres() {
  const COLORS = [
    [0.95, 0.25, 0.2],
    [0.98, 0.62, 0.1],
    [0.8, 0.8, 0.15],
    [0.2, 0.72, 0.3],
    [0.1, 0.62, 0.8],
    [0.25, 0.35, 0.95],
    [0.72, 0.3, 0.85],
  ];
  const out = new TriangleBuilder();
  COLORS.forEach((color, i) => {
    const angle = (TAU * i) / COLORS.length;
    out.group();
    out.sphere(
      [Math.cos(angle), 0.95 + 0.25 * Math.sin(2 * angle), Math.sin(angle)],
      0.7,
      { color, alpha: 0.24 + 0.06 * (i % 4), rim: 0.5 },
      72,
    );
  });
  out.group();
  out.sphere([0, 0.95, 0], 0.62, { color: [0.96, 0.96, 1], alpha: 0.5, rim: 0.4 }, 72);
  return {
    transparent: out.finish(),
    gloss: 0.9,
    floor: 5,
    view: { target: [0, 0.82, 0], yaw: 0.3, pitch: 0.28, distance: 5.6, fov: 36 },
  };
}

function foliage(detail) {
  const rng = random(11);
  const wood = new TriangleBuilder();
  const bark = { color: [0.33, 0.22, 0.14], alpha: 1, rim: 0 };
  wood.tube(
    bark,
    (t) => [0.06 * Math.sin(3 * t), 2.2 * t, 0.03 * Math.sin(5 * t)],
    (t) => 0.15 - 0.1 * t + 0.1 * Math.exp(-14 * t),
    16,
    16,
  );
  const tips = Array.from({ length: 26 }, (_, b) => {
    const angle = 2.3999632 * b;
    const up = between(rng, 0, 1);
    const reach = 1.2 * (0.35 + 0.65 * Math.sin(Math.PI * (0.25 + 0.7 * up)));
    return [reach * Math.cos(angle), 1.3 + 1.75 * up, reach * Math.sin(angle)];
  });
  for (const tip of tips) {
    const from = [0.04, 0.8 + 0.4 * (tip[1] - 1), 0];
    wood.tube(
      bark,
      (t) => {
        const p = mix(from, tip, t);
        return [p[0], p[1] + 0.25 * Math.sin(Math.PI * t) * 0.4, p[2]];
      },
      (t) => 0.045 * (1 - 0.8 * t),
      8,
      8,
    );
  }
  const out = new TriangleBuilder();
  const leaves = Math.round(260 * detail);
  for (const tip of tips) {
    out.group();
    for (let i = 0; i < leaves; i++) {
      const around = direction(rng);
      const center = add(tip, scale(around, 0.6 * Math.cbrt(between(rng, 0.02, 1))));
      const normal = unit(add(add(around, [0, 0.8, 0]), scale(direction(rng), 0.9)));
      const along = unit(cross(normal, direction(rng)));
      const across = cross(normal, along);
      const size = between(rng, 0.06, 0.11);
      const green = mix([0.1, 0.42, 0.1], [0.45, 0.7, 0.14], rng());
      const paint = {
        color: mix(green, [0.95, 0.55, 0.08], 0.5 * rng() ** 4),
        alpha: between(rng, 0.72, 0.97),
        rim: 0,
      };
      const at = (x, y) =>
        add(
          center,
          add(add(scale(along, x * size), scale(across, y * size)), scale(normal, 0.35 * Math.abs(y) * size)),
        );
      const [base, end] = [at(-1, 0), at(1.15, 0)];
      for (const side of [-1, 1]) {
        const edge = [
          [-0.55, 0.34],
          [0.1, 0.42],
          [0.65, 0.22],
        ].map(([x, y]) => at(x, side * y));
        out.flat([base, edge[0], edge[1]], paint);
        out.flat([base, edge[1], end], paint);
        out.flat([edge[1], edge[2], end], paint);
      }
    }
  }
  return {
    transparent: out.finish(),
    opaque: wood.finish(),
    floor: 5,
    view: { target: [0, 1.55, 0], yaw: 0.2, pitch: 0.16, distance: 6.9, fov: 36 },
  };
}

function hair(detail) {
  const rng = random(5);
  const SEGMENTS = 18;
  const LOCKS = 150;
  const out = new TriangleBuilder();
  const strands = Math.max(1, Math.round(44 * detail));
  for (let l = 0; l < LOCKS; l++) {
    out.group();
    const root0 = direction(rng);
    root0[1] = Math.abs(root0[1]) * 0.9 + 0.1;
    const curl = [between(rng, 0.05, 0.16), between(rng, 5, 9), between(rng, 0, TAU)];
    const length0 = between(rng, 1.7, 2.2);
    const shade = rng();
    for (let s = 0; s < strands; s++) {
      const root = unit(add(root0, scale(direction(rng), 0.22)));
      const flat = unit([root[0], 0, root[2]]);
      const length = (length0 + between(rng, -0.15, 0.15)) * (0.55 + 0.4 * root[1]);
      const color = mix([0.28, 0.1, 0.04], [0.85, 0.5, 0.2], 0.8 * shade + 0.2 * rng());
      const alpha = between(rng, 0.22, 0.5);
      const point = (t) => {
        const d = t * length;
        const reach = 0.78 + 0.22 * (1 - Math.exp(-3 * d)) + 0.05 * d;
        const polar = Math.acos(Math.min(1, root[1])) + d / reach;
        const bend = Math.min(polar, Math.PI / 2);
        const fall = Math.max(0, polar - Math.PI / 2) * reach;
        const wave = curl[0] * t;
        return [
          flat[0] * reach * Math.sin(bend) + wave * Math.sin(curl[1] * d + curl[2]),
          1.62 + reach * Math.cos(bend) - fall - 0.06 * d * d * Math.sin(bend),
          flat[2] * reach * Math.sin(bend) + wave * Math.cos(curl[1] * d + curl[2]),
        ];
      };
      let before = null;
      for (let k = 0; k <= SEGMENTS; k++) {
        const t = k / SEGMENTS;
        const p = point(t);
        const along = unit(add(point(t + 1e-3), scale(p, -1)));
        const thin = 1 - 0.6 * t;
        const pair = [-1, 1].map((side) => out.vertex(p, along, { color, alpha, side: side * thin }));
        if (before) {
          out.triangle(before[0], before[1], pair[1]);
          out.triangle(before[0], pair[1], pair[0]);
        }
        before = pair;
      }
    }
  }
  const head = new TriangleBuilder();
  head.sphere([0, 1.62, 0], 0.74, { color: [0.85, 0.78, 0.72], alpha: 1, rim: 0 }, 64);
  head.lathe(
    [0, 0, 0],
    [
      [0.9, 0],
      [0.85, 0.05],
      [0.32, 0.25],
      [0.28, 0.6],
      [0.36, 1.1],
    ],
    { color: [0.85, 0.78, 0.72], alpha: 1, rim: 0 },
  );
  return {
    transparent: out.finish("strands"),
    opaque: head.finish(),
    strandWidth: 0.011,
    floor: 5,
    view: { target: [0, 1.25, 0], yaw: 0.5, pitch: 0.12, distance: 5.6, fov: 36 },
  };
}

function crowd(detail) {
  const rng = random(3);
  const out = new TriangleBuilder();
  const COLORS = [
    [0.9, 0.35, 0.3],
    [0.95, 0.65, 0.2],
    [0.3, 0.65, 0.45],
    [0.2, 0.55, 0.8],
    [0.5, 0.4, 0.85],
    [0.85, 0.45, 0.65],
  ];
  const BODY = [
    [0, 0],
    [0.09, 0.0],
    [0.11, 0.25],
    [0.14, 0.55],
    [0.2, 0.85],
    [0.2, 1.02],
    [0.06, 1.1],
    [0.05, 1.15],
  ];
  const rows = Math.max(2, Math.round(14 * Math.sqrt(detail)));
  for (let i = 0; i < rows; i++) {
    for (let j = 0; j < rows; j++) {
      const x = (i - (rows - 1) / 2) * 0.52 + between(rng, -0.16, 0.16);
      const z = (j - (rows - 1) / 2) * 0.52 + between(rng, -0.16, 0.16);
      const tall = between(rng, 0.82, 1.12);
      const color = mix(COLORS[Math.floor(rng() * 6)], [0.9, 0.9, 0.95], 0.25 * rng());
      const paint = { color, alpha: between(rng, 0.16, 0.42), rim: 0.5 };
      out.group();
      out.lathe(
        [x, 0, z],
        BODY.map(([r, y]) => [r * between(rng, 0.95, 1.05), y * tall]),
        paint,
        18,
        14,
      );
      out.sphere([x, 1.28 * tall, z], 0.115, paint, 18);
      const [sin, cos] = [Math.sin(between(rng, 0, TAU)), Math.cos(between(rng, 0, TAU))];
      const swing = between(rng, 0.05, 0.3);
      for (const side of [-1, 1]) {
        const shoulder = [x + side * 0.2 * cos, 1.0 * tall, z + side * 0.2 * sin];
        const hand = [
          x + side * (0.24 + 0.06 * swing) * cos - sin * swing * side,
          0.52 * tall,
          z + side * 0.27 * sin + cos * swing * side,
        ];
        out.tube(
          paint,
          (t) => mix(shoulder, hand, t),
          (t) => 0.045 - 0.015 * t,
          8,
          4,
        );
      }
    }
  }
  return {
    transparent: out.finish(),
    gloss: 0.25,
    floor: 8,
    view: { target: [0, 0.55, 0.4], yaw: 0.6, pitch: 0.24, distance: 8.6, fov: 36 },
  };
}

function smoke(detail) {
  const rng = random(9);
  const out = new SplatBuilder();
  const axes = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  const count = Math.round(5400 * detail);
  for (let i = 0; i < count; i++) {
    const plume = (i % 3) - 1;
    const t = between(rng, 0, 1) ** 0.8;
    const phase = 2.1 * plume;
    const swirl = 0.08 + 0.5 * t;
    const axis = [
      plume * 1.2 + swirl * 0.55 * Math.sin(4.2 * t + phase) + 0.2 * t,
      3.6 * t + 0.1,
      plume * 0.45 + swirl * 0.55 * Math.cos(5 * t + phase),
    ];
    const spread = 0.06 + 0.4 * t + 0.09 * Math.sin(34 * t + 3 * phase) * (0.3 + t);
    const off = scale(direction(rng), spread * Math.cbrt(rng()));
    const radius = (0.025 + 0.075 * t) * between(rng, 0.6, 1.3);
    const alpha = Math.min(1, ((0.26 * (1 - t) + 0.05) * between(rng, 0.6, 1.3)) / Math.sqrt(detail));
    const height = Math.min(1, Math.max(0, 0.55 + (0.45 * (off[1] - 0.4 * off[0])) / spread));
    const grey = mix([0.2, 0.21, 0.26], [0.92, 0.92, 0.95], height);
    const tint = [
      [0.98, 0.42, 0.15],
      [0.85, 0.3, 0.6],
      [0.2, 0.48, 0.98],
    ][i % 3];
    out.splat(add(axis, off), axes, [radius, radius, radius], mix(grey, tint, 0.65 * (1 - t)), alpha);
  }
  return {
    transparent: out.finish(),
    floor: 5,
    view: { target: [0.1, 1.75, 0], yaw: 0.15, pitch: 0.12, distance: 7.2, fov: 36 },
  };
}

function knot(detail) {
  const rng = random(21);
  const out = new SplatBuilder();
  const count = Math.round(26000 * detail);
  const curve = (s) => {
    const a = TAU * s;
    const r = 1.05 + 0.42 * Math.cos(3 * a);
    return [r * Math.cos(2 * a), 1.35 + 0.5 * Math.sin(3 * a), r * Math.sin(2 * a)];
  };
  const hue = (h) => [0, 1, 2].map((k) => 0.5 + 0.46 * Math.cos(TAU * (h - k / 3)));
  for (let i = 0; i < count; i++) {
    const s = rng();
    const p = curve(s);
    const [u, w, along] = frameOf(add(curve(s + 1e-4), scale(p, -1)));
    const angle = between(rng, 0, TAU);
    const out1 = add(scale(u, Math.cos(angle)), scale(w, Math.sin(angle)));
    const dust = rng() < 0.06;
    const reach = dust ? between(rng, 0.3, 0.62) : 0.24 + 0.012 * Math.sin(24 * angle + 90 * s);
    const center = add(p, scale(out1, reach));
    const side = cross(along, out1);
    const size = dust
      ? [0.006, 0.006, 0.006]
      : [0.045, 0.022, 0.003].map((x) => (x * between(rng, 0.7, 1.4)) / Math.cbrt(detail));
    const color = mix(hue(s * 2 + angle / TAU), [1, 1, 1], dust ? 0.5 : 0.12 + 0.2 * Math.max(0, out1[1]));
    out.splat(center, [along, side, out1], size, color, dust ? between(rng, 0.2, 0.5) : between(rng, 0.08, 0.3));
  }
  return {
    transparent: out.finish(),
    floor: 5,
    view: { target: [0, 1.2, 0], yaw: 0.5, pitch: 0.3, distance: 5.9, fov: 36 },
  };
}
