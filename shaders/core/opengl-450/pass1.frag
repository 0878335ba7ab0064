#version 450
// OpenGL 4.5, pass 1: draw every transparent surface, in any order, without writing depth.
//
// glBlendFunc(GL_ONE, GL_ONE); glBlendEquation(GL_FUNC_ADD).
// Target 0: GL_RGBA32F, cleared to 0.
// Target 1: GL_RG32F, cleared to 0.
// Storage buffer at binding 0: 6 words a pixel, cleared to 0; a barrier with GL_SHADER_STORAGE_BARRIER_BIT between
// the passes.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
const uint NMT_OCTAVE_BITS = 11u;
const uint NMT_HEAVY = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const uint NMT_SLOTS = 6u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const float NMT_KEY_SCALE = 0.625;
// The last step of absorbance, that of A = 10.
const uint NMT_LAST_ABSORBANCE = 27136u;
const uint NMT_LAST_DEPTH = (1u << NMT_DEPTH_BITS) - 1u;
const uint NMT_END_BITS = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
const uint NMT_LINEAR_BITS = 0x3a800000u;
const float NMT_LINEAR = 0.0009765625;

// Codes of a scene. The same for every fragment of a frame, in both passes.
struct NmtCodes { int first_bits; int last_bits; int first_log2; uint shift; uint multiplier; uint slope; };

// Logarithm of base 2 of the positive number with these bits, in units of 2^-23 octaves and 127 octaves more, by
// integers alone: bits are a logarithm that is linear in each octave, and a parabola bends it.
int nmt_core_log2(int bits) {
    int m = bits & 0x007fffff;
    int h = m >> 11;
    int l = m & 2047;
    int t = ((h * (4096 - h)) >> 1) + ((l * (2048 - h)) >> 11);
    return bits + ((11 * t) >> 5);
}

// Codes of a scene whose view depths lie in [v0, v1], 0 < v0 <= v1.
NmtCodes nmt_core_codes(float v0, float v1) {
    int first = floatBitsToInt(v0);
    int last = floatBitsToInt(v1);
    int first_log2 = nmt_core_log2(first);
    uint range = uint(nmt_core_log2(last) - first_log2);
    // Its length in bits, from the exponent of a float that is not rounded up to the next power of two.
    uint exponent = floatBitsToUint(float(range & ~(range >> 1))) >> 23;
    uint shift = max(exponent, 127u + NMT_DEPTH_BITS) - (127u + NMT_DEPTH_BITS);
    uint multiplier = 0x80000000u / ((range >> shift) + 1u);
    uint room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    NmtCodes codes;
    codes.first_bits = first;
    codes.last_bits = last;
    codes.first_log2 = first_log2;
    codes.shift = shift;
    codes.multiplier = multiplier;
    codes.slope = min(uint(float(range >> 8u) * NMT_KEY_SCALE), room);
    return codes;
}

// Absorbance min(-ln(1 - alpha), 10) of an opacity.
float nmt_core_absorbance_of(float alpha) {
    return -log(max(1.0 - alpha, 0.000045399931));
}

// Steps of a fragment of view depth v.
uvec2 nmt_core_steps(float v, float absorbance, NmtCodes codes) {
    int place = nmt_core_log2(clamp(floatBitsToInt(v), codes.first_bits, codes.last_bits));
    uint w = uint(place - codes.first_log2) >> codes.shift;
    uint a = floatBitsToUint(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return uvec2(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
float nmt_core_depth(uvec2 steps) {
    return float(2u * steps.x + 1u) * (1.0 / float(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
float nmt_core_absorbance(uvec2 steps) {
    return uintBitsToFloat(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
vec4 nmt_core_moments(uvec2 steps) {
    float z = nmt_core_depth(steps);
    float first = nmt_core_absorbance(steps) * z;
    float second = first * z;
    float third = second * z;
    return vec4(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
uint nmt_core_nearest_code(uvec2 steps) {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_farthest_code(uvec2 steps) {
    return (steps.x << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_heavy_code(uvec2 steps, NmtCodes codes) {
    uint nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

layout(std430, binding = 0) coherent buffer NmtCore { uint nmt_core[]; };

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
uint nmt_core_offer(uint slot, uint code) {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (nmt_core[slot] >= code) {
        return code;
    }
    uint old = atomicMax(nmt_core[slot], code);
    return min(old, code);
}

// Offers a fragment, by its steps, to the core of a pixel.
void nmt_core_insert(uint pixel, uvec2 steps, NmtCodes codes) {
    if (steps.y == 0u) {
        return;
    }
    uint first = pixel * NMT_SLOTS;
    uint second = nmt_core_offer(first, nmt_core_nearest_code(steps));
    if (second == 0u) {
        return;
    }
    uint third = nmt_core_offer(first + 1u, nmt_core_farthest_code(nmt_core_nearest_steps(second)));
    if (third == 0u) {
        return;
    }
    uint code = nmt_core_heavy_code(nmt_core_farthest_steps(third), codes);
    // What is lighter than the last of the heavy is lighter than all of them.
    if (NMT_HEAVY == 0u || nmt_core[first + 1u + NMT_HEAVY] >= code) {
        return;
    }
    for (uint slot = first + 2u; slot < first + 2u + NMT_HEAVY; slot++) {
        code = nmt_core_offer(slot, code);
        if (code == 0u) {
            return;
        }
    }
}

// Atomics write even where a depth test behind the shader fails.
layout(early_fragment_tests) in;

// Distance along the view direction.
layout(location = 0) in float v;
// Not premultiplied.
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 sums0;
layout(location = 1) out vec4 sums1;
// Least and greatest v of what is transparent.
layout(location = 0) uniform vec2 v_range;
// Columns of the image.
layout(location = 1) uniform uint width;

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    uvec2 at = uvec2(gl_FragCoord.xy);
    nmt_core_insert(at.y * width + at.x, steps, codes);
    float absorbance = nmt_core_absorbance(steps);
    vec4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
    sums0 = vec4(absorbance, b.x, b.y, b.z);
    sums1 = vec4(b.w, n, 0.0, 0.0);
}
