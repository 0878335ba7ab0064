// The methods: what they are called, what they keep of a pixel, and their WGSL.
//
// A blended method draws the scene twice. Pass 1 adds up `targets`; `accumulate` makes what a fragment adds. Pass 2
// adds up colour by `weight`; `total` is a pixel's absorbance b0. `functions` are files that the three of them use.

// Absorbance and moment depth, of methods whose own files have none, are those of a network's file.
const COMMON = "shaders/small/small.wgsl";
const DEPTH = "nmt_moment_depth(s.v, frame.range.x, frame.range.y)";

const SUMS_OF_MOMENTS = `
struct Sums { @location(0) b0123: vec4<f32>, @location(1) b4: f32 }
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let a = nmt_absorbance(s.alpha);
    let z = ${DEPTH};
    return Sums(a * vec4<f32>(1.0, z, z * z, z * z * z), a * z * z * z * z);
}
`;

const FIRST_IS_TOTAL = `
fn total(at: vec2<i32>) -> f32 {
    return textureLoad(target0, at, 0).x;
}
`;

const add = (format) => ({ format, operation: "add", clear: [0, 0, 0, 0] });
const ENDS = { format: "rg32float", operation: "max", clear: [-3e38, -3e38, 0, 0] };

/** A network whose pass 1 is blended: four moments, number of fragments, both ends. */
function network(name, title, note, file = `${name}.wgsl`) {
  return {
    name,
    title,
    note,
    kind: "blended",
    bits: 32 * 8,
    functions: [`shaders/${name}/${file}`],
    targets: [add("rgba32float"), add("rg32float"), ENDS],
    rounds: true,
    // Sums as f16 where f32 cannot be blended into; the ends are then two depth buffers.
    half: { targets: [add("rgba16float"), add("rg16float")], bits: 16 * 6 + 64 },
    accumulate: `
struct Sums { @location(0) sums0: vec4<f32>, @location(1) sums1: vec2<f32>, @location(2) range: vec2<f32> }
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let sums = nmt_pass1(s.v, frame.range.x, frame.range.y, s.alpha);
    return Sums(sums.sums0, sums.sums1.xy, sums.range.xy);
}
`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let ends = ends_of(at);
    return nmt_pass2(
        s.v, frame.range.x, frame.range.y, s.alpha,
        textureLoad(target0, at, 0), textureLoad(target1, at, 0), vec4<f32>(-ends.x, ends.y, 0.0, 0.0),
    );
}
`,
    total: FIRST_IS_TOTAL,
  };
}

/** The same where the ends are codes of fragments, which are taken out of sums that f16 is too coarse for. */
function ends(name, title, note) {
  return { ...network(name, title, note, `${name}.chain.wgsl`), half: undefined };
}

/** A network whose pass 1 keeps single fragments by atomics: both ends, the heaviest of the rest, and sums over all. */
function core(name, title, heavy, note) {
  const vectors = Math.ceil((heavy + 2) / 4);
  const read = (i) => [0, 1, 2, 3].map((k) => (4 * i + k < heavy + 2 ? `slots[first + ${4 * i + k}u]` : "0u")).join(", ");
  const kept = Array.from({ length: vectors }, (_, i) => `vec4<u32>(${read(i)})`);
  return {
    name,
    title,
    note: `both ends and the ${heavy} heaviest other fragments one by one, the rest as four moments; ${note}`,
    kind: "blended",
    bits: 6 * 32 + (heavy + 2) * 32,
    slots: heavy + 2,
    functions: [`shaders/${name}/${name}.chain.wgsl`],
    // The slots stand in the page's own group.
    fill: { "@group(3) @binding(0) var<storage": "@group(1) @binding(8) var<storage" },
    targets: [add("rgba32float"), add("rg32float")],
    accumulate: `
struct Sums { @location(0) b0123: vec4<f32>, @location(1) b4_and_n: vec2<f32> }
fn codes() -> NmtCodes {
    return nmt_core_codes(frame.range.x, frame.range.y);
}
fn steps_of(s: Surface) -> vec2<u32> {
    return nmt_core_steps(s.v, nmt_core_absorbance_of(s.alpha), codes());
}
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let steps = steps_of(s);
    let moments = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    return Sums(vec4<f32>(nmt_core_absorbance(steps), moments.xyz), vec2<f32>(moments.w, n));
}
fn record(s: Surface, pixel: u32) {
    nmt_core_insert(pixel, steps_of(s), codes());
}
`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let first = u32(at.x + at.y * i32(frame.size.x)) * NMT_SLOTS;
    let b0123 = textureLoad(target0, at, 0);
    let b4_and_n = textureLoad(target1, at, 0);
    return nmt_core_transmittance(
        steps_of(s), codes(), ${kept.join(", ")},
        b4_and_n.y, b0123.x, vec4<f32>(b0123.yzw, b4_and_n.x),
    );
}
`,
    total: FIRST_IS_TOTAL,
  };
}

export const METHODS = [
  {
    name: "exact",
    title: "Exact",
    note: "every fragment of a pixel in a list, sorted and composited: what the others are measured against",
    kind: "lists",
  },
  {
    name: "sorted",
    title: "Sorted objects",
    note: "whole objects drawn far to near: wrong where they overlap, and they pop as the camera turns",
    kind: "objects",
    bits: 0,
  },
  {
    name: "weighted-blended",
    title: "Weighted blended",
    note: "McGuire and Bavoil 2013: a weight that falls with depth, no knowledge of the pixel",
    kind: "blended",
    bits: 32,
    functions: [COMMON, "src/oit/weighted_blended.wgsl"],
    targets: [add("r32float")],
    half: { targets: [add("r16float")], bits: 16 },
    accumulate: `
struct Sums { @location(0) b0: f32 }
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    return Sums(nmt_absorbance(s.alpha));
}
`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    return weight_mb13_9(s.v, 0.0, s.alpha);
}
`,
    total: FIRST_IS_TOTAL,
  },
  {
    name: "moment-power-4",
    title: "MBOIT, 4 moments",
    note: "Münstermann and others 2018: transmittance reconstructed from four power moments",
    kind: "blended",
    bits: 160,
    functions: [COMMON, "src/numeric/roots.wgsl", "src/moments/hamburger.wgsl"],
    targets: [add("rgba32float"), add("r32float")],
    accumulate: SUMS_OF_MOMENTS,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let b0123 = textureLoad(target0, at, 0);
    let b = array<f32, 5>(b0123.x, b0123.y, b0123.z, b0123.w, textureLoad(target1, at, 0).x);
    return select(power_transmittance_4(b, ${DEPTH}, 0.25), 1.0, b0123.x == 0.0);
}
`,
    total: FIRST_IS_TOTAL,
  },
  {
    name: "wavelet",
    title: "Wavelet, rank 3",
    note: "Aizenshtein, Smal and McGuire 2022: 16 Haar coefficients over the pixel's own range, found by a prepass",
    kind: "blended",
    bits: 256 + 64,
    prepass: true,
    functions: [COMMON, "web/wgsl/wavelet.wgsl"],
    targets: [add("rgba16float"), add("rgba16float"), add("rgba16float"), add("rgba16float")],
    half: {
      targets: [add("rgba16float"), add("rgba16float"), add("rgba16float"), add("rgba16float")],
      bits: 256 + 64,
    },
    accumulate: `
struct Sums {
    @location(0) c0: vec4<f32>,
    @location(1) c1: vec4<f32>,
    @location(2) c2: vec4<f32>,
    @location(3) c3: vec4<f32>,
}
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let c = wavelet_terms(wavelet_place(s.v, ends_of(at)), nmt_absorbance(s.alpha));
    return Sums(c[0], c[1], c[2], c[3]);
}
`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let x = wavelet_place(s.v, ends_of(at));
    let own = wavelet_terms(x, nmt_absorbance(s.alpha));
    let others = array<vec4<f32>, 4>(
        textureLoad(target0, at, 0) - own[0], textureLoad(target1, at, 0) - own[1],
        textureLoad(target2, at, 0) - own[2], textureLoad(target3, at, 0) - own[3],
    );
    return wavelet_transmittance(others, x);
}
`,
    total: `
fn total(at: vec2<i32>) -> f32 {
    return max(wavelet_value(array<vec4<f32>, 4>(
        textureLoad(target0, at, 0), textureLoad(target1, at, 0),
        textureLoad(target2, at, 0), textureLoad(target3, at, 0),
    ), 15u), 0.0);
}
`,
  },
  network("small", "NMT small", "four moments and both ends; 7-16-8-1, 248 multiply-adds a fragment"),
  network("recommended", "NMT recommended", "four moments and both ends; 7-32-16-1, 752 multiply-adds a fragment"),
  ends("ends", "NMT ends", "four moments, and both ends with their absorbance; 32-16-1 for what they do not answer"),
  core("core-small", "NMT core-small", 2, "14-8-1, 246 multiply-adds for what the core does not answer"),
  core("core", "NMT core", 4, "32-16-1 for what the core does not answer"),
  core("core-large", "NMT core-large", 6, "32-16-1 for what the core does not answer"),
];

/** A method by its name. */
export function method(name) {
  const found = METHODS.find((m) => m.name === name);
  if (!found) throw new Error(`no method is called "${name}"; there are ${METHODS.map((m) => m.name).join(", ")}`);
  return found;
}
