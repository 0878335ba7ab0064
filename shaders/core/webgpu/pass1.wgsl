// WebGPU, pass 1: draw every transparent surface, in any order, without writing depth.
//
// The fragment shader writes to a storage buffer even where a depth test fails behind it: discard what lies behind the
// opaque depth, read as a texture, before nmt_core_insert.
//
// Target 0: rgba32float, blend add, factors one and one, cleared to 0.
// Target 1: rg32float, blend add, factors one and one, cleared to 0.
// Buffer of group 3: 6 words a pixel, cleared to 0.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

const NMT_DEPTH_BITS: u32 = 16u;
// Steps of absorbance to the octave, as a power of two.
const NMT_OCTAVE_BITS: u32 = 11u;
const NMT_HEAVY: u32 = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const NMT_SLOTS: u32 = 6u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const NMT_KEY_SCALE: f32 = 0.625;
// The last step of absorbance, that of A = 10.
const NMT_LAST_ABSORBANCE: u32 = 27136u;
const NMT_LAST_DEPTH: u32 = (1u << NMT_DEPTH_BITS) - 1u;
const NMT_END_BITS: u32 = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
const NMT_LINEAR_BITS: u32 = 0x3a800000u;
const NMT_LINEAR: f32 = 0.0009765625;

// Codes of a scene. The same for every fragment of a frame, in both passes.
struct NmtCodes { first_bits: i32, last_bits: i32, first_log2: i32, shift: u32, multiplier: u32, slope: u32 }

// Logarithm of base 2 of the positive number with these bits, in units of 2^-23 octaves and 127 octaves more, by
// integers alone: bits are a logarithm that is linear in each octave, and a parabola bends it.
fn nmt_core_log2(bits: i32) -> i32 {
    let m = bits & 0x007fffff;
    let h = m >> 11u;
    let l = m & 2047;
    let t = ((h * (4096 - h)) >> 1u) + ((l * (2048 - h)) >> 11u);
    return bits + ((11 * t) >> 5u);
}

// Codes of a scene whose view depths lie in [v0, v1], 0 < v0 <= v1.
fn nmt_core_codes(v0: f32, v1: f32) -> NmtCodes {
    let first = bitcast<i32>(v0);
    let last = bitcast<i32>(v1);
    let first_log2 = nmt_core_log2(first);
    let range = u32(nmt_core_log2(last) - first_log2);
    let shift = max(32u - countLeadingZeros(range), NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
    let multiplier = 0x80000000u / ((range >> shift) + 1u);
    let room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    let slope = min(u32(f32(range >> 8u) * NMT_KEY_SCALE), room);
    return NmtCodes(first, last, first_log2, shift, multiplier, slope);
}

// Absorbance min(-ln(1 - alpha), 10) of an opacity.
fn nmt_core_absorbance_of(alpha: f32) -> f32 {
    return -log(max(1.0 - alpha, 0.000045399931));
}

// Steps of a fragment of view depth v.
fn nmt_core_steps(v: f32, absorbance: f32, codes: NmtCodes) -> vec2<u32> {
    let place = nmt_core_log2(clamp(bitcast<i32>(v), codes.first_bits, codes.last_bits));
    let w = u32(place - codes.first_log2) >> codes.shift;
    let a = bitcast<u32>(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return vec2<u32>(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
fn nmt_core_depth(steps: vec2<u32>) -> f32 {
    return f32(2u * steps.x + 1u) * (1.0 / f32(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
fn nmt_core_absorbance(steps: vec2<u32>) -> f32 {
    return bitcast<f32>(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
fn nmt_core_moments(steps: vec2<u32>) -> vec4<f32> {
    let z = nmt_core_depth(steps);
    let first = nmt_core_absorbance(steps) * z;
    let second = first * z;
    let third = second * z;
    return vec4<f32>(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
fn nmt_core_nearest_code(steps: vec2<u32>) -> u32 {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

fn nmt_core_nearest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_farthest_code(steps: vec2<u32>) -> u32 {
    return (steps.x << NMT_END_BITS) | steps.y;
}

fn nmt_core_farthest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_heavy_code(steps: vec2<u32>, codes: NmtCodes) -> u32 {
    let nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

@group(3) @binding(0) var<storage, read_write> nmt_core: array<atomic<u32>>;

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
fn nmt_core_offer(slot: u32, code: u32) -> u32 {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (atomicLoad(&nmt_core[slot]) >= code) {
        return code;
    }
    return min(atomicMax(&nmt_core[slot], code), code);
}

// Offers a fragment, by its steps, to the core of a pixel.
fn nmt_core_insert(pixel: u32, steps: vec2<u32>, codes: NmtCodes) {
    if (steps.y == 0u) {
        return;
    }
    let first = pixel * NMT_SLOTS;
    let second = nmt_core_offer(first, nmt_core_nearest_code(steps));
    if (second == 0u) {
        return;
    }
    let third = nmt_core_offer(first + 1u, nmt_core_farthest_code(nmt_core_nearest_steps(second)));
    if (third == 0u) {
        return;
    }
    var code = nmt_core_heavy_code(nmt_core_farthest_steps(third), codes);
    // What is lighter than the last of the heavy is lighter than all of them.
    if (NMT_HEAVY == 0u || atomicLoad(&nmt_core[first + 1u + NMT_HEAVY]) >= code) {
        return;
    }
    for (var slot = first + 2u; slot < first + 2u + NMT_HEAVY; slot++) {
        code = nmt_core_offer(slot, code);
        if (code == 0u) {
            return;
        }
    }
}

struct Frame {
    // Least and greatest distance along the view direction of what is transparent.
    v0: f32,
    v1: f32,
    // Columns of the image.
    width: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    // Distance along the view direction.
    @location(0) v: f32,
    // Not premultiplied.
    @location(1) color: vec4<f32>,
}

struct Targets {
    @location(0) sums0: vec4<f32>,
    @location(1) sums1: vec4<f32>,
}

@fragment
fn pass1(in: Varying) -> Targets {
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    let at = vec2<u32>(in.position.xy);
    nmt_core_insert(at.y * frame.width + at.x, steps, codes);
    let absorbance = nmt_core_absorbance(steps);
    let b = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    return Targets(vec4<f32>(absorbance, b.x, b.y, b.z), vec4<f32>(b.w, n, 0.0, 0.0));
}
