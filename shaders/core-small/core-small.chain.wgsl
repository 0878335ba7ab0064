// Core and tail: a pixel's nearest, its farthest and its 2 heaviest other fragments one by one, all others by their sums.
// Written by nmt 0.1.0.
//
// Frame:  codes = nmt_core_codes(v0, v1), v0 and v1 the least and the greatest view depth of what is transparent. Clear to 0 the buffer
//         nmt_core, 4 words a pixel, and targets for b0, 4 moments and n, which are added up by blending in f32.
// Pass 1, for every fragment of view depth v and opacity alpha:
//         steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes)
//         nmt_core_insert(pixel, steps, codes)
//         add to b0: nmt_core_absorbance(steps); to the moments: nmt_core_moments(steps); to n: 1 where steps.y > 0, else 0
// Pass 2: T = nmt_core_transmittance(steps, codes, core0, ..., n, b0, moments), the core read as vectors of four words;
//         steps must come from the same expressions as in pass 1. Add up alpha T C and alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

// Neural moment transparency: network 'core-small', 7-16-8-1, 248 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^6, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 5d4deb2f2c8a96ac5dfda935ab5f840b24948e782c8fbc4ba250b79fb256de83.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

// The features of a fragment that needs the network, from its three numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, tail: vec4<f32>) -> mat2x4<f32> {
    return mat2x4<f32>(vec4<f32>(x, count, ln_b0, tail.x), vec4<f32>(tail.yzw, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.4474705f, -2.3140097f, 2.4587274f, -2.0283625f), vec4<f32>(0.025019553f, -0.03455168f, -0.20108078f, -0.3676571f), vec4<f32>(0.02266329f, 0.048362754f, 0.033006392f, 0.4335871f), vec4<f32>(-4.9143996f, 2.5796134f, -2.5119598f, 1.4190323f)),
    mat4x4<f32>(vec4<f32>(4.1092668f, 4.0608425f, -3.199834f, -1.3899742f), vec4<f32>(5.5573077f, -2.4150424f, -0.41402522f, 0.81533575f), vec4<f32>(-0.19838761f, -8.665485f, 1.8881316f, 1.0846932f), vec4<f32>(0.68159187f, 1.9176182f, 1.9448986f, 0.32637742f)),
    mat4x4<f32>(vec4<f32>(1.541189f, 2.744907f, -2.409202f, -3.255194f), vec4<f32>(0.16370825f, 0.021742474f, 0.0076347045f, 0.06370908f), vec4<f32>(-0.28933865f, -0.02309331f, 0.009891848f, 0.05982188f), vec4<f32>(2.1720924f, 3.9204137f, -2.5205986f, 0.81907207f)),
    mat4x4<f32>(vec4<f32>(-1.9147855f, -3.6099176f, -0.6726784f, -1.253065f), vec4<f32>(-2.4566364f, -6.9067745f, 4.8918395f, -2.1710742f), vec4<f32>(0.1385836f, 1.9539759f, 0.4752808f, -0.2570193f), vec4<f32>(2.742572f, 0.3957342f, 0.5051741f, -1.0210482f)),
    mat4x4<f32>(vec4<f32>(1.9162954f, 2.059045f, -2.5061216f, 0.6707573f), vec4<f32>(-0.04663631f, 0.028203119f, -0.057964344f, 0.0018452917f), vec4<f32>(0.010741622f, 0.047778197f, -0.0048850058f, -0.0019730802f), vec4<f32>(3.6878772f, 1.181982f, -2.1302025f, -0.394331f)),
    mat4x4<f32>(vec4<f32>(-4.2873454f, 4.0037327f, -1.2806336f, 5.6339912f), vec4<f32>(-4.2245893f, -0.035980005f, 4.6360426f, -1.0983442f), vec4<f32>(0.11669542f, 2.6384828f, 4.021518f, -3.4167442f), vec4<f32>(2.5587585f, -0.51070315f, -2.116296f, 0.7068791f)),
    mat4x4<f32>(vec4<f32>(-0.6415181f, 5.4087095f, -2.7415826f, -3.481457f), vec4<f32>(-0.031237075f, 0.027115235f, -0.08193817f, -0.0057335687f), vec4<f32>(0.021212518f, -0.21955463f, 0.016048992f, -0.00071349356f), vec4<f32>(1.9812537f, -2.819833f, -0.57123965f, -0.10751174f)),
    mat4x4<f32>(vec4<f32>(-4.632885f, -3.490217f, 2.5329893f, 0.064274155f), vec4<f32>(-2.6028123f, 0.68095744f, 0.01846506f, 0.16123538f), vec4<f32>(4.921812f, -0.2815728f, -0.09549676f, 0.04217817f), vec4<f32>(-1.2647824f, -0.13394293f, -2.2597103f, -3.419232f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(-3.3418725f, -4.0855875f, 0.77165955f, 0.41316321f), vec4<f32>(-0.35114214f, -2.7670434f, 2.1249874f, 2.197555f), vec4<f32>(-0.58745646f, 3.3334498f, 0.70710117f, 0.43568578f), vec4<f32>(-0.25018284f, -0.23728038f, 0.05269738f, 1.0609303f)),
    mat4x4<f32>(vec4<f32>(-1.7087882f, -0.41349608f, -0.08120874f, 1.4551854f), vec4<f32>(-0.40181422f, -3.625493f, 3.7512345f, 1.8275597f), vec4<f32>(1.7986207f, 1.546551f, -0.603336f, 0.49119824f), vec4<f32>(-0.57053983f, 0.88894725f, -0.73311305f, -0.07771064f)),
    mat4x4<f32>(vec4<f32>(2.9096277f, -0.15429012f, -1.4159456f, -1.1466888f), vec4<f32>(-0.9994283f, 2.6177647f, 0.45010838f, 1.4062314f), vec4<f32>(-1.7475772f, -3.352449f, -0.28202784f, -0.8496246f), vec4<f32>(0.8343176f, -0.610604f, 1.8189929f, 0.8360092f)),
    mat4x4<f32>(vec4<f32>(1.4888489f, -1.7507061f, -2.3789833f, -0.33815762f), vec4<f32>(-0.9610482f, -4.7598224f, 0.5400893f, -0.27676913f), vec4<f32>(2.1696684f, 2.3751001f, -0.8185451f, -0.39043123f), vec4<f32>(20.988102f, -8.060803f, -6.457696f, 2.0178878f)),
    mat4x4<f32>(vec4<f32>(-1.9192039f, 1.2973583f, 0.12957217f, -2.0995288f), vec4<f32>(0.13706096f, 0.18189034f, -0.07957252f, -1.3877001f), vec4<f32>(0.60850334f, -0.78841f, -0.14115039f, -0.776932f), vec4<f32>(-0.011215124f, 0.34320807f, 0.14902373f, 0.3875658f)),
    mat4x4<f32>(vec4<f32>(-0.81812435f, 0.94332623f, 0.01563329f, 0.16517355f), vec4<f32>(-1.3968968f, -0.28342438f, -0.29675168f, -4.430481f), vec4<f32>(1.4621456f, -2.2371657f, -0.68029326f, -0.5449462f), vec4<f32>(-2.476674f, -0.56428456f, -0.10914541f, 0.76484877f)),
    mat4x4<f32>(vec4<f32>(-1.0451545f, 0.22052269f, -0.6172878f, 2.7052572f), vec4<f32>(1.7968506f, 0.17819253f, 0.08662049f, -1.1919606f), vec4<f32>(-0.8731105f, 1.1723455f, -0.27935618f, 2.347068f), vec4<f32>(-0.23865318f, -1.2344798f, 0.30622983f, 1.1333549f)),
    mat4x4<f32>(vec4<f32>(-0.5555628f, 4.491205f, 0.045380052f, 2.1592524f), vec4<f32>(2.492795f, -0.41927868f, -0.5530473f, 0.7241723f), vec4<f32>(1.3377888f, 0.7353521f, -0.59209406f, 1.995464f), vec4<f32>(2.6316738f, -1.2303891f, -0.38901335f, 9.579925f))
);
const NMT_B2 = array<vec4<f32>, 2>(
    vec4<f32>(-0.17192039f, 0.17679797f, 1.3886025f, -1.34472f),
    vec4<f32>(2.173804f, 0.5498685f, 0.17730568f, -0.7695141f)
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.50458753f, 0.20017031f, 0.6225078f, -0.7532515f),
    vec4<f32>(0.2678952f, 0.3193554f, -0.35949963f, -0.49384788f)
);
const NMT_B3: f32 = 0.57963055f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat2x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = vec4<f32>(f[1].xyz, 1.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4<f32>(0.0f));
    let h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4<f32>(0.0f));
    let h2_1 = max(NMT_B2[1] + NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat2x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

const NMT_DEPTH_BITS: u32 = 16u;
// Steps of absorbance to the octave, as a power of two.
const NMT_OCTAVE_BITS: u32 = 11u;
const NMT_HEAVY: u32 = 2u;
// Slots of a pixel, empty ones at the end among them, a multiple of four.
const NMT_SLOTS: u32 = 4u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const NMT_KEY_SCALE: f32 = 0.375;
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

fn nmt_core_heavy_steps(code: u32, codes: NmtCodes) -> vec2<u32> {
    let nearness = code & NMT_LAST_DEPTH;
    let key = code >> NMT_DEPTH_BITS;
    return vec2<u32>(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Pass 1 of the core, in the fragment stage, without an interlock. Every fragment walks down the slots of its pixel:
// each slot keeps the greater of two codes in one atomic step and hands the lesser on to the next, so that the slots
// end with the same codes whatever order fragments come in.
//
// Clear the buffer to 0 before the pass. Atomics write even where a depth test that runs after the shader fails:
// test against opaque depth before the call.

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

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
fn nmt_core_weigh(z: f32, absorbance: f32, depths0: vec4<f32>, absorbances0: vec4<f32>, n: f32, b0: f32,
    moments: vec4<f32>) -> f32 {
    let front = 0.0 + select(0.0, absorbances0.x, z > depths0.x);
    let in_core = select(0.0, 1.0, depths0.x == z && absorbances0.x == absorbance);
    let count = n - select(0.0, 1.0, absorbances0.x > 0.0);
    let rest0 = b0 - absorbances0.x;
    let rest1 = moments.x - absorbances0.x * depths0.x;
    let rest2 = moments.y - absorbances0.x * depths0.x * depths0.x;
    let rest3 = moments.z - absorbances0.x * depths0.x * depths0.x * depths0.x;
    let rest4 = moments.w - absorbances0.x * depths0.x * depths0.x * depths0.x * depths0.x;
    let front_2 = front + select(0.0, absorbances0.y, z > depths0.y);
    let in_core_2 = select(in_core, 1.0, depths0.y == z && absorbances0.y == absorbance);
    let count_2 = count - select(0.0, 1.0, absorbances0.y > 0.0);
    let rest0_2 = rest0 - absorbances0.y;
    let rest1_2 = rest1 - absorbances0.y * depths0.y;
    let rest2_2 = rest2 - absorbances0.y * depths0.y * depths0.y;
    let rest3_2 = rest3 - absorbances0.y * depths0.y * depths0.y * depths0.y;
    let rest4_2 = rest4 - absorbances0.y * depths0.y * depths0.y * depths0.y * depths0.y;
    let front_3 = front_2 + select(0.0, absorbances0.z, z > depths0.z);
    let in_core_3 = select(in_core_2, 1.0, depths0.z == z && absorbances0.z == absorbance);
    let count_3 = count_2 - select(0.0, 1.0, absorbances0.z > 0.0);
    let rest0_3 = rest0_2 - absorbances0.z;
    let rest1_3 = rest1_2 - absorbances0.z * depths0.z;
    let rest2_3 = rest2_2 - absorbances0.z * depths0.z * depths0.z;
    let rest3_3 = rest3_2 - absorbances0.z * depths0.z * depths0.z * depths0.z;
    let rest4_3 = rest4_2 - absorbances0.z * depths0.z * depths0.z * depths0.z * depths0.z;
    let front_4 = front_3 + select(0.0, absorbances0.w, z > depths0.w);
    let in_core_4 = select(in_core_3, 1.0, depths0.w == z && absorbances0.w == absorbance);
    let count_4 = count_3 - select(0.0, 1.0, absorbances0.w > 0.0);
    let rest0_4 = rest0_3 - absorbances0.w;
    let rest1_4 = rest1_3 - absorbances0.w * depths0.w;
    let rest2_4 = rest2_3 - absorbances0.w * depths0.w * depths0.w;
    let rest3_4 = rest3_3 - absorbances0.w * depths0.w * depths0.w * depths0.w;
    let rest4_4 = rest4_3 - absorbances0.w * depths0.w * depths0.w * depths0.w * depths0.w;
    let far = select(depths0.x, depths0.y, absorbances0.y > 0.0);
    let center = 0.5 * (depths0.x + far);
    let half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    let per_h = 1.0 / half_range;
    let moved1 = (rest1_4 - center * rest0_4) * per_h;
    let moved2 = (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)) * (per_h * per_h);
    let moved3 = (rest3_4 - center * rest2_4 - center * (rest2_4 - center * rest1_4) - center * (rest2_4 - center
        * rest1_4 - center * (rest1_4 - center * rest0_4))) * (per_h * per_h * per_h);
    let moved4 = (rest4_4 - center * rest3_4 - center * (rest3_4 - center * rest2_4) - center * (rest3_4 - center
        * rest2_4 - center * (rest2_4 - center * rest1_4)) - center * (rest3_4 - center * rest2_4 - center * (rest2_4
        - center * rest1_4) - center * (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)))) * (per_h
        * per_h * per_h * per_h);
    let x = clamp((z - center) * per_h, -1.0, 1.0);
    let removed = select(0.0, absorbance, in_core_4 == 0.0);
    let tail0 = rest0_4 - removed;
    let tail1 = moved1 - removed * x;
    let tail2 = moved2 - removed * x * x;
    let tail3 = moved3 - removed * x * x * x;
    let tail4 = moved4 - removed * x * x * x * x;
    let others = count_4 - select(0.0, 1.0, removed > 0.0);
    let absorbance_of_tail = clamp(tail0, 0.0, 1e30);
    let per_b0 = 1.0 / max(tail0, 1e-12);
    let m1 = clamp(tail1 * per_b0, -1.0, 1.0);
    let m2 = clamp(tail2 * per_b0, -1.0, 1.0);
    let m3 = clamp(tail3 * per_b0, -1.0, 1.0);
    let m4 = clamp(tail4 * per_b0, -1.0, 1.0);
    let own_step = per_h * 3.0517578e-5;
    let noise = b0 / max(absorbance_of_tail, 1e-12) * (per_h + abs(center) * per_h) * 1.9073486e-6;
    let exact = clamp((x - m1 - own_step * 0.25) / (own_step * 0.5 + noise), 0.0, 1.0);
    let variance = max(m2 - m1 * m1, 1e-9);
    let sum = clamp((m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1) / variance, -2.0, 2.0);
    let root = sqrt(sum * sum + 4.0 * variance);
    let near = 0.5 * (sum - root);
    let far_2 = 0.5 * (sum + root);
    let of_near = clamp(far_2 / root, 0.0, 1.0);
    let exact_2 = select(exact, of_near * clamp((x - m1 - near - own_step * 0.25) / (own_step * 0.5 + (noise + noise
        / max(sqrt(variance), 0.0001))), 0.0, 1.0) + (1.0 - of_near) * clamp((x - m1 - far_2 - own_step * 0.25)
        / (own_step * 0.5 + (noise + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0), others > 1.5);
    let exact_3 = select(exact_2, 1.0, z >= far);
    let exact_4 = select(exact_3, 0.0, others < 0.5 || z <= depths0.x);
    if ((others < 2.5 || z >= far) || z <= depths0.x) {
        let known = min(exp(-(front_4 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_4) * nmt_transmittance(mat2x4<f32>(vec4<f32>(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), mean), vec4<f32>(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0
        - mean * mean, 1e-6), 0.0, 1.0), mean_2, sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2)
        / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
fn nmt_core_slot(code: u32, steps: vec2<u32>) -> vec2<f32> {
    return select(vec2<f32>(0.0), vec2<f32>(nmt_core_depth(steps), nmt_core_absorbance(steps)), code > 0u);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
fn nmt_core_transmittance(
    steps: vec2<u32>,
    codes: NmtCodes,
    core0: vec4<u32>,
    n: f32,
    b0: f32,
    moments: vec4<f32>
) -> f32 {
    let slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    let slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    let slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    let slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4<f32>(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4<f32>(slot0.y, slot1.y, slot2.y, slot3.y),
        n,
        b0,
        moments
    );
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}
