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

#ifndef NMT_INCLUDED_CORE_SMALL_CHAIN
#define NMT_INCLUDED_CORE_SMALL_CHAIN

// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =
// least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1
// alone): Markov's bounds. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset 9636ee68609509b56e59e891665a02e7488e2241af88306025242c084edbf4a2.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
float3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, float4 tail) {
    return float3x4(float4(x, count, ln_b0, lower), float4(upper, tail.xyz), float4(tail.w, 0.0, 0.0, 0.0));
}

static const float4x4 NMT_W1[12] = {
    float4x4(float4(1.9524608f, 1.0713975f, 1.4039351f, -1.5217286f), float4(-0.022230538f, 0.026557269f, 0.06309734f, -0.17475322f), float4(0.047427006f, -0.00469664f, 0.025943926f, 0.26743507f), float4(-2.610338f, 1.7166722f, 8.023302f, 0.13859871f)),
    float4x4(float4(-0.31684518f, 3.2051063f, 1.401991f, -2.1894662f), float4(0.04005704f, 0.32028624f, -0.39842847f, -0.66725725f), float4(0.16254476f, -0.4127584f, 1.1801735f, 1.8491927f), float4(-0.22754906f, 0.7579889f, 0.09157842f, -0.87315947f)),
    float4x4(float4(-0.2689073f, 0.21747705f, -0.13199797f, -0.12784465f), float4(2.1772313f, 1.1888932f, 1.1551433f, -0.87760884f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.81854665f, 1.409713f, -0.41876668f, -1.3666365f), float4(0.034107465f, -0.03685927f, -0.1553165f, 0.12620565f), float4(0.03321912f, 0.0033020813f, 0.06593848f, -0.007674537f), float4(3.6540296f, -2.2724702f, 2.8454916f, 1.4697961f)),
    float4x4(float4(-2.299097f, -2.199256f, -5.2893305f, 1.9870816f), float4(2.4571347f, -0.83326393f, -1.4877391f, -0.93114316f), float4(-2.7327578f, 0.12991856f, 0.48797175f, 0.47749f), float4(-2.8144898f, -1.2780569f, 2.2409158f, 1.4453955f)),
    float4x4(float4(0.78125113f, 2.5927734f, 1.0933044f, -0.5034421f), float4(-0.24653246f, 1.0398772f, 0.8146086f, 0.2817792f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.9260247f, 0.85952455f, 0.45401737f, 1.2723763f), float4(-0.04285044f, 0.31560546f, 0.017856365f, -0.028521825f), float4(-0.052516434f, -0.27625632f, 0.0510878f, -0.0137894405f), float4(1.6011887f, 0.12541816f, -0.17053595f, -0.46624243f)),
    float4x4(float4(-4.574354f, 2.887386f, 0.074741684f, -7.2879086f), float4(-0.31982198f, 1.5869461f, 1.8657863f, -3.0015862f), float4(-0.33059454f, -1.782947f, 0.9666899f, 0.33783144f), float4(0.26441604f, -0.5676601f, -2.3556285f, 2.1970835f)),
    float4x4(float4(1.211836f, 0.73746043f, 2.4677353f, 2.5184371f), float4(-1.1619287f, 0.8677148f, -1.4660302f, 0.62358993f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.16088599f, -1.5223581f, 0.0f, 0.0f), float4(-0.0041487496f, 0.19258048f, 0.0f, 0.0f), float4(0.056485593f, -0.04926818f, 0.0f, 0.0f), float4(11.940453f, -12.363574f, 0.0f, 0.0f)),
    float4x4(float4(0.1872992f, 2.1171644f, 0.0f, 0.0f), float4(-2.1300912f, 2.1395888f, 0.0f, 0.0f), float4(0.33336386f, -0.8256183f, 0.0f, 0.0f), float4(2.8348258f, -2.3406053f, 0.0f, 0.0f)),
    float4x4(float4(1.5841515f, -6.709348f, 0.0f, 0.0f), float4(-1.2724476f, -0.22252339f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[8] = {
    float4x4(float4(1.2749535f, -1.2206278f, 0.028193194f, 0.8423979f), float4(-1.2200161f, 1.2229213f, 0.3101811f, 0.31512943f), float4(-0.15609749f, 1.2058281f, -0.41686842f, -0.1321389f), float4(0.5738092f, 0.32298833f, -0.25300327f, 0.70333153f)),
    float4x4(float4(-0.9644515f, -1.4976041f, -0.8924194f, 1.031193f), float4(0.09596964f, -1.3812109f, -0.99426335f, -0.7698786f), float4(-0.27224338f, 0.49484494f, -0.30159897f, 1.3121598f), float4(0.40367886f, -0.07355354f, 0.9684212f, 0.15634966f)),
    float4x4(float4(0.31352583f, -0.07697483f, -0.27615148f, 2.0191827f), float4(-0.07209049f, 0.2702196f, -2.1244931f, 0.27906394f), float4(-0.23925827f, -0.9513572f, 2.03597f, 0.32911965f), float4(-2.638307f, 1.872359f, 1.6225691f, -1.4433334f)),
    float4x4(float4(0.02017221f, -1.6147795f, 0.14303435f, 0.83729297f), float4(-0.6862176f, -0.44755808f, -4.0235376f, -0.01778543f), float4(1.0969412f, 0.02962239f, 1.0639843f, 0.49953485f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.6739009f, 1.4489998f, -6.061824f, 1.7098606f), float4(1.4577574f, -1.8589485f, -0.38928428f, 0.10030627f), float4(0.01998619f, 0.48650917f, -1.7238876f, -2.6405706f), float4(-1.2022905f, -0.27215597f, 1.5082463f, -0.13863346f)),
    float4x4(float4(-0.6243122f, 1.7342827f, 0.32260272f, 1.9255228f), float4(0.56403655f, 1.1141405f, -0.71229786f, 0.5767114f), float4(0.95821536f, -0.49319956f, -0.39364746f, 0.9515521f), float4(-0.4755803f, -1.4792235f, 1.0261518f, -0.9079893f)),
    float4x4(float4(0.15076402f, 1.4911646f, 0.30963883f, -0.9034152f), float4(-0.1908811f, -0.0032071099f, 0.75148535f, -0.147816f), float4(0.76777065f, -1.6563613f, 0.27035776f, -1.2608712f), float4(-2.4480877f, -1.9728118f, 0.1101791f, -1.0284874f)),
    float4x4(float4(1.7924052f, 0.9207351f, -0.14314386f, 1.8696913f), float4(0.77036667f, 1.9583427f, 0.1715907f, 2.3901844f), float4(-1.3831987f, 0.44357684f, -0.54849935f, 0.33465484f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4 NMT_W3[2] = {
    float4(-0.62214833f, 0.39003918f, 0.40604776f, -0.75780785f),
    float4(0.4352812f, 0.8156252f, -1.98668f, -0.6356217f)
};
static const float NMT_B3 = -0.8207263f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float3x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = f[1];
    float4 h0_2 = float4(f[2].x, 1.0f, 0.0f, 0.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]) + mul(h0_2, NMT_W1[2]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[3]) + mul(h0_1, NMT_W1[4]) + mul(h0_2, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]) + mul(h0_2, NMT_W1[8]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[9]) + mul(h0_1, NMT_W1[10]) + mul(h0_2, NMT_W1[11]), float4(0.0f, 0.0f, 0.0f, 0.0f)) + float4(0.0f, 0.0f, 1.0f, 0.0f);
    float4 h2_0 = max(mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(mul(h1_0, NMT_W2[4]) + mul(h1_1, NMT_W2[5]) + mul(h1_2, NMT_W2[6]) + mul(h1_3, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 2u;
// Slots of a pixel, empty ones at the end among them, a multiple of four.
static const uint NMT_SLOTS = 4u;
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
    uint shift = max(firstbithigh(range) + 1u, NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
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

uint2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Pass 1 of the core, in the fragment stage, without an interlock. Every fragment walks down the slots of its pixel:
// each slot keeps the greater of two codes in one atomic step and hands the lesser on to the next, so that the slots
// end with the same codes whatever order fragments come in.
//
// Clear the buffer to 0 before the pass. Atomics write even where a depth test that runs after the shader fails:
// declare `[earlydepthstencil]`.

globallycoherent RWStructuredBuffer<uint> nmt_core : register(u0);

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

// Least and greatest share of the tail that may lie in front of x, from its moments: Markov's bounds.
float2 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
    float mean = m1 * 0.9999;
    float second = m2 * 0.9999 + 3.3333334e-5;
    float third = m3 * 0.9999;
    float square = mean * mean;
    float variance = max(second - square, 1e-7);
    float per_deviation = 1.0 / sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    float d = clamp((m4 * 0.9999 + 2e-5 - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square)))
        * per_variance * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float q = (y * (y - skewness) - 1.0) / d;
    float at = 1.0 / (1.0 + y * y + q * q * d);
    float rest = 1.0 - at;
    float linear_ = y - q * skewness;
    float per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    float between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    float lower = (q < 0.0 ? between : (y > 0.5 * skewness ? rest : 0.0));
    return float2(lower, lower + at);
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
float nmt_core_weigh(float z, float absorbance, float4 depths0, float4 absorbances0, float n, float b0, float4
    moments) {
    float front = 0.0 + (depths0.x < z ? absorbances0.x : 0.0);
    float in_core = (depths0.x == z && absorbances0.x == absorbance ? 1.0 : 0.0);
    float count = n - (absorbances0.x > 0.0 ? 1.0 : 0.0);
    float rest0 = b0 - absorbances0.x;
    float rest1 = moments.x - absorbances0.x * depths0.x;
    float rest2 = moments.y - absorbances0.x * depths0.x * depths0.x;
    float rest3 = moments.z - absorbances0.x * depths0.x * depths0.x * depths0.x;
    float rest4 = moments.w - absorbances0.x * depths0.x * depths0.x * depths0.x * depths0.x;
    float front_2 = front + (depths0.y < z ? absorbances0.y : 0.0);
    float in_core_2 = (depths0.y == z && absorbances0.y == absorbance ? 1.0 : in_core);
    float count_2 = count - (absorbances0.y > 0.0 ? 1.0 : 0.0);
    float rest0_2 = rest0 - absorbances0.y;
    float rest1_2 = rest1 - absorbances0.y * depths0.y;
    float rest2_2 = rest2 - absorbances0.y * depths0.y * depths0.y;
    float rest3_2 = rest3 - absorbances0.y * depths0.y * depths0.y * depths0.y;
    float rest4_2 = rest4 - absorbances0.y * depths0.y * depths0.y * depths0.y * depths0.y;
    float front_3 = front_2 + (depths0.z < z ? absorbances0.z : 0.0);
    float in_core_3 = (depths0.z == z && absorbances0.z == absorbance ? 1.0 : in_core_2);
    float count_3 = count_2 - (absorbances0.z > 0.0 ? 1.0 : 0.0);
    float rest0_3 = rest0_2 - absorbances0.z;
    float rest1_3 = rest1_2 - absorbances0.z * depths0.z;
    float rest2_3 = rest2_2 - absorbances0.z * depths0.z * depths0.z;
    float rest3_3 = rest3_2 - absorbances0.z * depths0.z * depths0.z * depths0.z;
    float rest4_3 = rest4_2 - absorbances0.z * depths0.z * depths0.z * depths0.z * depths0.z;
    float front_4 = front_3 + (depths0.w < z ? absorbances0.w : 0.0);
    float in_core_4 = (depths0.w == z && absorbances0.w == absorbance ? 1.0 : in_core_3);
    float count_4 = count_3 - (absorbances0.w > 0.0 ? 1.0 : 0.0);
    float rest0_4 = rest0_3 - absorbances0.w;
    float rest1_4 = rest1_3 - absorbances0.w * depths0.w;
    float rest2_4 = rest2_3 - absorbances0.w * depths0.w * depths0.w;
    float rest3_4 = rest3_3 - absorbances0.w * depths0.w * depths0.w * depths0.w;
    float rest4_4 = rest4_3 - absorbances0.w * depths0.w * depths0.w * depths0.w * depths0.w;
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_4 - center * rest0_4) * per_h;
    float moved2 = (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)) * (per_h * per_h);
    float moved3 = (rest3_4 - center * rest2_4 - center * (rest2_4 - center * rest1_4) - center * (rest2_4 - center
        * rest1_4 - center * (rest1_4 - center * rest0_4))) * (per_h * per_h * per_h);
    float moved4 = (rest4_4 - center * rest3_4 - center * (rest3_4 - center * rest2_4) - center * (rest3_4 - center
        * rest2_4 - center * (rest2_4 - center * rest1_4)) - center * (rest3_4 - center * rest2_4 - center * (rest2_4
        - center * rest1_4) - center * (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_4 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_4 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_4 - (removed > 0.0 ? 1.0 : 0.0);
    float absorbance_of_tail = clamp(tail0, 0.0, 1e30);
    float per_b0 = 1.0 / max(tail0, 1e-12);
    float m1 = clamp(tail1 * per_b0, -1.0, 1.0);
    float m2 = clamp(tail2 * per_b0, -1.0, 1.0);
    float m3 = clamp(tail3 * per_b0, -1.0, 1.0);
    float m4 = clamp(tail4 * per_b0, -1.0, 1.0);
    float own_step = per_h * 3.0517578e-5;
    float noise = b0 / max(absorbance_of_tail, 1e-12) * (per_h + abs(center) * per_h) * 1.9073486e-6;
    float exact = clamp((x - m1 - own_step * 0.25) / (own_step * 0.5 + noise), 0.0, 1.0);
    float variance = max(m2 - m1 * m1, 1e-9);
    float sum = clamp((m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1) / variance, -2.0, 2.0);
    float root = sqrt(sum * sum + 4.0 * variance);
    float near = 0.5 * (sum - root);
    float far_2 = 0.5 * (sum + root);
    float of_near = clamp(far_2 / root, 0.0, 1.0);
    float exact_2 = (others > 1.5 ? of_near * clamp((x - m1 - near - own_step * 0.25) / (own_step * 0.5 + (noise
        + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0) + (1.0 - of_near) * clamp((x - m1 - far_2 - own_step * 0.25)
        / (own_step * 0.5 + (noise + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0) : exact);
    float exact_3 = (z >= far ? 1.0 : exact_2);
    float exact_4 = (others < 0.5 || z <= depths0.x ? 0.0 : exact_3);
    if ((others < 2.5 || z >= far) || z <= depths0.x) {
        float known = min(exp(-(front_4 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    float2 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_4) * nmt_transmittance(float3x4(float4(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), bounds.x), float4(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
        * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0), mean_2), float4(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2,
        1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
float2 nmt_core_slot(uint code, uint2 steps) {
    return code > 0u ? float2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : float2(0.0, 0.0);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
float nmt_core_transmittance(
    uint2 steps,
    NmtCodes codes,
    uint4 core0,
    float n,
    float b0,
    float4 moments
) {
    float2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    float2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    float2 slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    float2 slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        float4(slot0.x, slot1.x, slot2.x, slot3.x),
        float4(slot0.y, slot1.y, slot2.y, slot3.y),
        n,
        b0,
        moments
    );
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
float4 nmt_resolve(float4 weighted, float4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

#endif
