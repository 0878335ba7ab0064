// Files that are dropped on the page: glTF, .splat and fragment lists. What is not taken from a file is named in
// `notes`.

import { Bounds, FRAGMENT_BYTES, SplatBuilder, TriangleBuilder } from "./geometry.js";
import { readNpz } from "./npz.js";
import { cross, multiply, sub, unit } from "./vector.js";

/** Half the diagonal that an imported scene is scaled to [scene units]. */
const RADIUS = 1.9;

/** Makes a scene of files; the first that is a scene counts, others may be buffers that it names. */
export async function loadFiles(files) {
  const name = (f) => f.name.toLowerCase();
  const is =
    (...ends) =>
    (f) =>
      ends.some((end) => name(f).endsWith(end));
  const gltf = files.find(is(".glb", ".gltf"));
  if (gltf) return loadGltf(gltf, files);
  const splat = files.find(is(".splat"));
  if (splat) return loadSplat(splat);
  const npz = files.find(is(".npz"));
  if (npz) return loadFragments(npz);
  throw new Error(`${files.map((f) => f.name).join(", ")}: not a .glb, .gltf, .splat or .npz file.`);
}

const base = (file) => ({
  name: "file",
  title: file.name,
  gloss: 0.4,
  strandWidth: 0,
  opaque: null,
  notes: [],
});

/** A view of a scene that has been scaled to RADIUS and stands on the floor. */
const VIEW = { target: [0, 1.1, 0], yaw: 0.5, pitch: 0.22, distance: 6.2, fov: 36 };

// 32 bytes a splat: centre and standard deviations (6 f32), colour and opacity (4 u8), rotation w x y z (4 u8, 128 is
// 0).
async function loadSplat(file) {
  const buffer = await file.arrayBuffer();
  if (buffer.byteLength === 0 || buffer.byteLength % 32) {
    throw new Error(`${file.name} has ${buffer.byteLength} bytes; a .splat file has 32 for every splat.`);
  }
  const floats = new Float32Array(buffer);
  const bytes = new Uint8Array(buffer);
  const count = buffer.byteLength / 32;
  const scene = { ...base(file), gloss: 0, floor: 0 };
  // The middle 96 % of all centres are what the picture is of; far splats are kept.
  const axis = (c) => Float32Array.from({ length: count }, (_, i) => floats[8 * i + c]).sort();
  const [low, high] = [0.02, 0.98].map((q) => [0, 1, 2].map((c) => axis(c)[Math.floor(q * (count - 1))]));
  const center = low.map((x, c) => 0.5 * (x + high[c]));
  const scale = RADIUS / Math.max(1e-9, 0.5 * Math.hypot(...low.map((x, c) => high[c] - x)));
  const out = new SplatBuilder();
  let broken = 0;
  for (let i = 0; i < count; i++) {
    const f = floats.subarray(8 * i, 8 * i + 6);
    if (!f.every(Number.isFinite)) {
      broken += 1;
      continue;
    }
    const rgba = [0, 1, 2, 3].map((c) => bytes[32 * i + 24 + c] / 255);
    const [w, x, y, z] = unit4([0, 1, 2, 3].map((c) => (bytes[32 * i + 28 + c] - 128) / 128));
    const axes = [
      [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
      [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
      [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ];
    // Files of this kind have y down; colours are as displayed, here made linear.
    const flip = (p) => [p[0], -p[1], -p[2]];
    const place = flip([0, 1, 2].map((c) => (f[c] - center[c]) * scale));
    out.splat(
      [place[0], place[1] + 1.1, place[2]],
      axes.map(flip),
      [f[3], f[4], f[5]].map((s) => s * scale),
      rgba.slice(0, 3).map(linear),
      rgba[3],
    );
  }
  if (broken) scene.notes.push(`${broken} of ${count} splats are not finite and were left out.`);
  return { ...scene, transparent: out.finish(), view: VIEW };
}

const unit4 = (q) => {
  const length = Math.hypot(...q);
  return length > 0 ? q.map((x) => x / length) : [1, 0, 0, 0];
};

/** sRGB as displayed to linear. */
const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

async function loadFragments(file) {
  const arrays = await readNpz(await file.arrayBuffer());
  const need = (name) => {
    if (!arrays[name])
      throw new Error(`${file.name} has no array "${name}"; a fragment list has offsets, view_z, alpha and color.`);
    return arrays[name].data;
  };
  const one = (name) => (arrays[name] ? Number(arrays[name].data[0]) : 0);
  const [offsets, viewZ, alpha, color] = ["offsets", "view_z", "alpha", "color"].map(need);
  const [width, height] = [one("width"), one("height")];
  const pixels = offsets.length - 1;
  if (width * height !== pixels || pixels < 1) {
    throw new Error(`${file.name}: width ${width} x height ${height} is not its ${pixels} pixels.`);
  }
  const count = Number(offsets[pixels]);
  if (viewZ.length !== count || alpha.length !== count || color.length !== 3 * count) {
    throw new Error(
      `${file.name}: offsets end at ${count}, but there are ${viewZ.length} depths and ${alpha.length} alphas.`,
    );
  }
  const vertices = new ArrayBuffer(Math.max(1, count) * FRAGMENT_BYTES);
  const words = new Uint32Array(vertices);
  const floats = new Float32Array(vertices);
  let range = [Infinity, -Infinity];
  for (let p = 0; p < pixels; p++) {
    for (let i = Number(offsets[p]); i < Number(offsets[p + 1]); i++) {
      const v = viewZ[i];
      if (!(v > 0 && v < Infinity))
        throw new Error(`${file.name}: view_z[${i}] is ${v}; it must be finite and above 0.`);
      words[6 * i] = p;
      floats.set([v, color[3 * i], color[3 * i + 1], color[3 * i + 2], alpha[i]], 6 * i + 1);
      range = [Math.min(range[0], v), Math.max(range[1], v)];
    }
  }
  if (count === 0) throw new Error(`${file.name} has no fragments.`);
  const bounds = new Bounds();
  bounds.take(0, 0, 0);
  bounds.take(1, 1, 1);
  if (range[0] === range[1]) range = [range[0], range[1] * 1.001];
  return {
    ...base(file),
    gloss: 0,
    floor: 0,
    view: VIEW,
    size: [width, height],
    transparent: { kind: "fragments", vertices, count, groups: [], bounds, range },
    notes: [
      `${width} x ${height} pixels with ${count.toLocaleString("en")} fragments. ` +
        "A list has no camera, so that the view is fixed.",
    ],
  };
}

const COMPONENTS = {
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array,
};
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
/** What a glTF file may require without being refused. */
const READ = new Set([
  "KHR_materials_unlit",
  "KHR_materials_transmission",
  "KHR_materials_ior",
  "KHR_materials_volume",
  "KHR_materials_specular",
  "KHR_materials_clearcoat",
  "KHR_materials_sheen",
  "KHR_materials_emissive_strength",
  "KHR_materials_pbrSpecularGlossiness",
  "KHR_texture_transform",
  "KHR_mesh_quantization",
  "KHR_lights_punctual",
]);

async function loadGltf(file, files) {
  const bytes = await file.arrayBuffer();
  const { json, binary } = file.name.toLowerCase().endsWith(".glb")
    ? readGlb(file.name, bytes)
    : { json: JSON.parse(new TextDecoder().decode(bytes)), binary: null };
  const refused = (json.extensionsRequired ?? []).filter((e) => !READ.has(e));
  if (refused.length) throw new Error(`${file.name} needs ${refused.join(", ")}, which this page does not read.`);
  const buffers = await Promise.all(
    (json.buffers ?? []).map(async (b) => {
      if (!b.uri) return binary;
      if (b.uri.startsWith("data:")) return (await fetch(b.uri)).arrayBuffer();
      const part = files.find((f) => f.name === decodeURIComponent(b.uri).split("/").pop());
      if (!part) throw new Error(`${file.name} needs ${b.uri}: drop both files together.`);
      return part.arrayBuffer();
    }),
  );
  const accessor = (index) => {
    const a = json.accessors[index];
    const [Type, width] = [COMPONENTS[a.componentType], WIDTHS[a.type]];
    const out = new Float64Array(a.count * width);
    const raw = (viewIndex, offset, count, C, w) => {
      const view = json.bufferViews[viewIndex];
      const stride = view.byteStride ?? C.BYTES_PER_ELEMENT * w;
      const start = (view.byteOffset ?? 0) + (offset ?? 0);
      return (i) => new C(buffers[view.buffer].slice(start + i * stride, start + i * stride + C.BYTES_PER_ELEMENT * w));
    };
    const divisor = a.normalized ? ({ 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 }[a.componentType] ?? 1) : 1;
    if (a.bufferView !== undefined) {
      const at = raw(a.bufferView, a.byteOffset, a.count, Type, width);
      for (let i = 0; i < a.count; i++)
        out.set(
          Array.from(at(i), (x) => (a.normalized ? Math.max(-1, x / divisor) : x)),
          i * width,
        );
    }
    if (a.sparse) {
      const { indices, values } = a.sparse;
      const index = raw(indices.bufferView, indices.byteOffset, a.sparse.count, COMPONENTS[indices.componentType], 1);
      const value = raw(values.bufferView, values.byteOffset, a.sparse.count, Type, width);
      for (let i = 0; i < a.sparse.count; i++)
        out.set(
          Array.from(value(i), (x) => x / divisor),
          index(i)[0] * width,
        );
    }
    return { data: out, width, count: a.count };
  };
  const scene = { ...base(file), floor: 5, notes: [] };
  const left = new Set();
  const parts = [];
  let clear = false;
  const visit = (index, parent) => {
    const node = json.nodes[index];
    const matrix = multiply(parent, node.matrix ? new Float32Array(node.matrix) : compose(node));
    for (const primitive of json.meshes?.[node.mesh]?.primitives ?? []) {
      if ((primitive.mode ?? 4) < 4) {
        left.add("points and lines");
        continue;
      }
      if (primitive.extensions?.KHR_draco_mesh_compression)
        throw new Error(`${file.name} is compressed with Draco, which this page does not read.`);
      if (primitive.attributes.POSITION === undefined) continue;
      if (node.skin !== undefined) left.add("skins (the rest pose is shown)");
      if (primitive.targets) left.add("morph targets");
      const material = json.materials?.[primitive.material] ?? {};
      const pbr = material.pbrMetallicRoughness ?? {};
      const factor = pbr.baseColorFactor ?? [1, 1, 1, 1];
      if (pbr.baseColorTexture) left.add("textures (base colours are used)");
      const transmission = material.extensions?.KHR_materials_transmission?.transmissionFactor ?? 0;
      const blend = material.alphaMode === "BLEND" || transmission > 0;
      clear ||= blend;
      const alpha = material.alphaMode === "BLEND" ? factor[3] : 1;
      parts.push({ primitive, matrix, color: factor.slice(0, 3), alpha: alpha * (1 - 0.85 * transmission), blend });
    }
    if (node.camera !== undefined) left.add("cameras");
    for (const child of node.children ?? []) visit(child, matrix);
  };
  const identity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  const roots = json.scenes?.[json.scene ?? 0]?.nodes ?? json.nodes?.map((_, i) => i) ?? [];
  for (const root of roots) visit(root, identity);
  if (json.animations?.length) left.add("animations");
  if (!parts.length) throw new Error(`${file.name} holds no triangles.`);

  const [out, solid] = [new TriangleBuilder(), new TriangleBuilder()];
  const bounds = new Bounds();
  const meshes = parts.map((part) => {
    const positions = accessor(part.primitive.attributes.POSITION);
    const at = (i) => {
      const [x, y, z] = positions.data.subarray(3 * i, 3 * i + 3);
      const m = part.matrix;
      return [0, 1, 2].map((r) => m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r]);
    };
    const points = Array.from({ length: positions.count }, (_, i) => at(i));
    for (const p of points) if (p.every(Number.isFinite)) bounds.take(...p);
    return points;
  });
  const scale = RADIUS / Math.max(1e-12, bounds.radius);
  const fit = (p) => [0, 1, 2].map((c) => (p[c] - (c === 1 ? bounds.least[1] : bounds.center[c])) * scale);
  parts.forEach((part, k) => {
    const points = meshes[k].map(fit);
    const { attributes, indices, mode = 4 } = part.primitive;
    const list = indices === undefined ? Array.from(points, (_, i) => i) : Array.from(accessor(indices).data);
    const triangles = [];
    for (let i = 2; i < list.length; i += mode === 4 ? 3 : 1) {
      if (mode === 4) triangles.push([list[i - 2], list[i - 1], list[i]]);
      else if (mode === 5) triangles.push([list[i - 2], list[i - 1], list[i]]);
      else triangles.push([list[0], list[i - 1], list[i]]);
    }
    const normals = points.map(() => [0, 0, 0]);
    if (attributes.NORMAL !== undefined) {
      const found = accessor(attributes.NORMAL).data;
      const m = part.matrix;
      normals.forEach((n, i) =>
        [0, 1, 2].forEach((r) => {
          n[r] = m[r] * found[3 * i] + m[4 + r] * found[3 * i + 1] + m[8 + r] * found[3 * i + 2];
        }),
      );
    } else {
      for (const [a, b, c] of triangles) {
        const n = cross(sub(points[b], points[a]), sub(points[c], points[a]));
        for (const i of [a, b, c]) normals[i] = normals[i].map((x, r) => x + n[r]);
      }
    }
    const tint = attributes.COLOR_0 === undefined ? null : accessor(attributes.COLOR_0);
    // Where nothing in the file is transparent, everything is made so: else there would be nothing to see.
    const to = part.blend || !clear ? out : solid;
    const alpha = clear ? part.alpha : 0.35;
    to.group();
    const first = to.vertices;
    points.forEach((p, i) => {
      const w = tint ? Array.from(tint.data.subarray(tint.width * i, tint.width * (i + 1))) : [1, 1, 1, 1];
      to.vertex(p, unit(normals[i]), {
        color: part.color.map((c, r) => c * w[r]),
        alpha: alpha * (w[3] ?? 1),
        rim: clear ? 0.2 : 0.45,
      });
    });
    for (const [a, b, c] of triangles) to.triangle(first + a, first + b, first + c);
  });
  if (!clear)
    scene.notes.push("Nothing in this file is transparent, so that all of it is shown at an opacity of 0.35.");
  if (left.size) scene.notes.push(`Left out: ${[...left].join(", ")}.`);
  const tall = ((bounds.greatest[1] - bounds.least[1]) * scale) / 2;
  return {
    ...scene,
    transparent: out.finish(),
    opaque: solid.vertices ? solid.finish() : null,
    view: { ...VIEW, target: [0, tall, 0] },
  };
}

function readGlb(name, buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67)
    throw new Error(`${name} is no binary glTF file.`);
  if (view.getUint32(4, true) !== 2)
    throw new Error(`${name} is glTF ${view.getUint32(4, true)}; only version 2 is read.`);
  let [json, binary] = [null, null];
  for (let at = 12; at + 8 <= buffer.byteLength;) {
    const [size, kind] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
    const data = buffer.slice(at + 8, at + 8 + size);
    if (kind === 0x4e4f534a) json = JSON.parse(new TextDecoder().decode(data));
    else if (kind === 0x004e4942) binary ??= data;
    at += 8 + size;
  }
  if (!json) throw new Error(`${name} holds no JSON chunk.`);
  return { json, binary };
}

/** Column-major matrix of a node's translation, rotation (x y z w) and scale. */
function compose({ translation: t = [0, 0, 0], rotation: q = [0, 0, 0, 1], scale: s = [1, 1, 1] }) {
  const [x, y, z, w] = q;
  return new Float32Array([
    (1 - 2 * (y * y + z * z)) * s[0],
    2 * (x * y + w * z) * s[0],
    2 * (x * z - w * y) * s[0],
    0,
    2 * (x * y - w * z) * s[1],
    (1 - 2 * (x * x + z * z)) * s[1],
    2 * (y * z + w * x) * s[1],
    0,
    2 * (x * z + w * y) * s[2],
    2 * (y * z - w * x) * s[2],
    (1 - 2 * (x * x + y * y)) * s[2],
    0,
    t[0],
    t[1],
    t[2],
    1,
  ]);
}
