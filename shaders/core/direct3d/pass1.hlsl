// Direct3D, pass 1: draw every transparent surface, in any order, without writing depth.
//
// Factors ONE, D3D12_BLEND_OP_ADD.
// Target 0: DXGI_FORMAT_R32G32B32A32_FLOAT, cleared to 0.
// Target 1: DXGI_FORMAT_R32G32_FLOAT, cleared to 0.
// Buffer u2, behind the targets, whose slots Direct3D 11 shares with it: 6 words a pixel, cleared to 0.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
static const uint NMT_SLOTS = 6u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
static const float NMT_KEY_SCALE = 0.625;
// The last step of absorbance, that of A = 10.
static const uint NMT_LAST_ABSORBANCE = 27136u;
static const uint NMT_LAST_DEPTH = (1u << NMT_DEPTH_BITS) - 1u;
static const uint NMT_END_BITS = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
static const uint NMT_LINEAR_BITS = 0x3a800000u;
static const float NMT_LINEAR = 0.0009765625;

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
    int first = asint(v0);
    int last = asint(v1);
    int first_log2 = nmt_core_log2(first);
    uint range = uint(nmt_core_log2(last) - first_log2);
    // Its length in bits, from the exponent of a float that is not rounded up to the next power of two.
    uint exponent = asuint(float(range & ~(range >> 1))) >> 23;
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
uint2 nmt_core_steps(float v, float absorbance, NmtCodes codes) {
    int place = nmt_core_log2(clamp(asint(v), codes.first_bits, codes.last_bits));
    uint w = uint(place - codes.first_log2) >> codes.shift;
    uint a = asuint(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return uint2(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
float nmt_core_depth(uint2 steps) {
    return float(2u * steps.x + 1u) * (1.0 / float(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
float nmt_core_absorbance(uint2 steps) {
    return asfloat(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
float4 nmt_core_moments(uint2 steps) {
    float z = nmt_core_depth(steps);
    float first = nmt_core_absorbance(steps) * z;
    float second = first * z;
    float third = second * z;
    return float4(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
uint nmt_core_nearest_code(uint2 steps) {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

uint2 nmt_core_nearest_steps(uint code) {
    return uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_farthest_code(uint2 steps) {
    return (steps.x << NMT_END_BITS) | steps.y;
}

uint2 nmt_core_farthest_steps(uint code) {
    return uint2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_heavy_code(uint2 steps, NmtCodes codes) {
    uint nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

globallycoherent RWStructuredBuffer<uint> nmt_core : register(u2);

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
uint nmt_core_offer(uint slot, uint code) {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (nmt_core[slot] >= code) {
        return code;
    }
    uint old;
    InterlockedMax(nmt_core[slot], code, old);
    return min(old, code);
}

// Offers a fragment, by its steps, to the core of a pixel.
void nmt_core_insert(uint pixel, uint2 steps, NmtCodes codes) {
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

cbuffer Frame : register(b0) {
    // Least and greatest distance along the view direction of what is transparent.
    float2 v_range;
    // Columns of the image.
    uint width;
};

struct Varying {
    float4 position : SV_Position;
    // Distance along the view direction.
    float v : DEPTH;
    // Not premultiplied.
    float4 color : COLOR;
};

struct Targets {
    float4 sums0 : SV_Target0;
    float4 sums1 : SV_Target1;
};

// Atomics write even where a depth test behind the shader fails.
[earlydepthstencil]
Targets pass1(Varying input) {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 at = uint2(input.position.xy);
    nmt_core_insert(at.y * width + at.x, steps, codes);
    float absorbance = nmt_core_absorbance(steps);
    float4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
    Targets targets;
    targets.sums0 = float4(absorbance, b.x, b.y, b.z);
    targets.sums1 = float4(b.w, n, 0.0, 0.0);
    return targets;
}
