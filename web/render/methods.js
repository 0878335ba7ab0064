// The methods: what they are called, what they keep of a pixel, and their WGSL.
//
// A blended method draws the scene twice. Pass 1 adds up `targets`; `accumulate` makes what a fragment adds. Pass 2
// adds up colour by `weight`; `total` is a pixel's absorbance b0. `functions` are files that the three of them use.

const SUMS_OF_MOMENTS = `
struct Sums { @location(0) b0123: vec4<f32>, @location(1) b4: f32 }
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let a = absorbance_of(s.alpha);
    let z = depth_of(s.v);
    return Sums(a * vec4<f32>(1.0, z, z * z, z * z * z), a * z * z * z * z);
}
`;

// Absorbance and moment depth of methods whose files have none.
const COMMON = `
fn absorbance_of(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 0.000045399931)), faint, alpha < 0.03);
}
fn depth_of(v: f32) -> f32 {
    return clamp(2.0 * log(v / frame.range.x) / log(frame.range.y / frame.range.x) - 1.0, -1.0, 1.0);
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
function network(name, title, note) {
  return {
    name,
    title,
    note,
    kind: "blended",
    bits: 32 * 8,
    functions: [`shaders/${name}/${name}.wgsl`],
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
    functions: ["src/oit/weighted_blended.wgsl"],
    targets: [add("r32float")],
    half: { targets: [add("r16float")], bits: 16 },
    accumulate: `${COMMON}
struct Sums { @location(0) b0: f32 }
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    return Sums(absorbance_of(s.alpha));
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
    functions: ["src/numeric/roots.wgsl", "src/moments/hamburger.wgsl"],
    targets: [add("rgba32float"), add("r32float")],
    accumulate: `${COMMON}${SUMS_OF_MOMENTS}`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let b0123 = textureLoad(target0, at, 0);
    let b = array<f32, 5>(b0123.x, b0123.y, b0123.z, b0123.w, textureLoad(target1, at, 0).x);
    return select(power_transmittance_4(b, depth_of(s.v), 0.25), 1.0, b0123.x == 0.0);
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
    functions: ["web/wgsl/wavelet.wgsl"],
    targets: [add("rgba16float"), add("rgba16float"), add("rgba16float"), add("rgba16float")],
    half: {
      targets: [add("rgba16float"), add("rgba16float"), add("rgba16float"), add("rgba16float")],
      bits: 256 + 64,
    },
    accumulate: `${COMMON}
struct Sums {
    @location(0) c0: vec4<f32>,
    @location(1) c1: vec4<f32>,
    @location(2) c2: vec4<f32>,
    @location(3) c3: vec4<f32>,
}
fn accumulate(s: Surface, at: vec2<i32>) -> Sums {
    let c = wavelet_terms(wavelet_place(s.v, ends_of(at)), absorbance_of(s.alpha));
    return Sums(c[0], c[1], c[2], c[3]);
}
`,
    weight: `
fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let x = wavelet_place(s.v, ends_of(at));
    let own = wavelet_terms(x, absorbance_of(s.alpha));
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
  network("small", "Network small", "four moments and both ends; 7-16-8-1, 248 multiply-adds a fragment"),
  network("recommended", "Network recommended", "four moments and both ends; 7-32-16-1, 752 multiply-adds a fragment"),
  {
    name: "core-6",
    title: "Core of 6",
    note: "both ends and the six heaviest fragments by atomics, the rest by mean and spread; no network",
    kind: "blended",
    bits: 4 * 32 + 8 * 32,
    slots: 8,
    fill: {
      CORE_DEPTH_BITS: "16",
      CORE_OCTAVE_BITS: "11",
      CORE_HEAVY: "6",
      CORE_SLOTS: "8",
      CORE_KEY_SCALE: "0.375",
      CORE_LAST_ABSORBANCE: "27136",
      CORE_GROUP: "1",
      CORE_BINDING: "8",
    },
    functions: ["src/export/core/codes.wgsl", "web/wgsl/core.wgsl"],
    first: ["src/export/core/insert.wgsl", "web/wgsl/core-first.wgsl"],
    second: ["web/wgsl/core-second.wgsl"],
    targets: [add("rgba32float")],
    accumulate: "",
    weight: "",
    total: FIRST_IS_TOTAL,
  },
];

/** A method by its name. */
export function method(name) {
  const found = METHODS.find((m) => m.name === name);
  if (!found) throw new Error(`no method is called "${name}"; there are ${METHODS.map((m) => m.name).join(", ")}`);
  return found;
}
