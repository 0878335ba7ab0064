// Neural moment transparency: network 'core-small', 7-16-8-1, 248 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
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

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

// The features of a fragment that needs the network, from its three numbers and the means and spreads of the tail.
float2x4 nmt_features(float x, float count, float ln_b0, float4 tail) {
    return float2x4(float4(x, count, ln_b0, tail.x), float4(tail.yzw, 0.0));
}

static const float4x4 NMT_W1[8] = {
    float4x4(float4(1.4474705f, -2.3140097f, 2.4587274f, -2.0283625f), float4(0.025019553f, -0.03455168f, -0.20108078f, -0.3676571f), float4(0.02266329f, 0.048362754f, 0.033006392f, 0.4335871f), float4(-4.9143996f, 2.5796134f, -2.5119598f, 1.4190323f)),
    float4x4(float4(4.1092668f, 4.0608425f, -3.199834f, -1.3899742f), float4(5.5573077f, -2.4150424f, -0.41402522f, 0.81533575f), float4(-0.19838761f, -8.665485f, 1.8881316f, 1.0846932f), float4(0.68159187f, 1.9176182f, 1.9448986f, 0.32637742f)),
    float4x4(float4(1.541189f, 2.744907f, -2.409202f, -3.255194f), float4(0.16370825f, 0.021742474f, 0.0076347045f, 0.06370908f), float4(-0.28933865f, -0.02309331f, 0.009891848f, 0.05982188f), float4(2.1720924f, 3.9204137f, -2.5205986f, 0.81907207f)),
    float4x4(float4(-1.9147855f, -3.6099176f, -0.6726784f, -1.253065f), float4(-2.4566364f, -6.9067745f, 4.8918395f, -2.1710742f), float4(0.1385836f, 1.9539759f, 0.4752808f, -0.2570193f), float4(2.742572f, 0.3957342f, 0.5051741f, -1.0210482f)),
    float4x4(float4(1.9162954f, 2.059045f, -2.5061216f, 0.6707573f), float4(-0.04663631f, 0.028203119f, -0.057964344f, 0.0018452917f), float4(0.010741622f, 0.047778197f, -0.0048850058f, -0.0019730802f), float4(3.6878772f, 1.181982f, -2.1302025f, -0.394331f)),
    float4x4(float4(-4.2873454f, 4.0037327f, -1.2806336f, 5.6339912f), float4(-4.2245893f, -0.035980005f, 4.6360426f, -1.0983442f), float4(0.11669542f, 2.6384828f, 4.021518f, -3.4167442f), float4(2.5587585f, -0.51070315f, -2.116296f, 0.7068791f)),
    float4x4(float4(-0.6415181f, 5.4087095f, -2.7415826f, -3.481457f), float4(-0.031237075f, 0.027115235f, -0.08193817f, -0.0057335687f), float4(0.021212518f, -0.21955463f, 0.016048992f, -0.00071349356f), float4(1.9812537f, -2.819833f, -0.57123965f, -0.10751174f)),
    float4x4(float4(-4.632885f, -3.490217f, 2.5329893f, 0.064274155f), float4(-2.6028123f, 0.68095744f, 0.01846506f, 0.16123538f), float4(4.921812f, -0.2815728f, -0.09549676f, 0.04217817f), float4(-1.2647824f, -0.13394293f, -2.2597103f, -3.419232f))
};
static const float4x4 NMT_W2[8] = {
    float4x4(float4(-3.3418725f, -4.0855875f, 0.77165955f, 0.41316321f), float4(-0.35114214f, -2.7670434f, 2.1249874f, 2.197555f), float4(-0.58745646f, 3.3334498f, 0.70710117f, 0.43568578f), float4(-0.25018284f, -0.23728038f, 0.05269738f, 1.0609303f)),
    float4x4(float4(-1.7087882f, -0.41349608f, -0.08120874f, 1.4551854f), float4(-0.40181422f, -3.625493f, 3.7512345f, 1.8275597f), float4(1.7986207f, 1.546551f, -0.603336f, 0.49119824f), float4(-0.57053983f, 0.88894725f, -0.73311305f, -0.07771064f)),
    float4x4(float4(2.9096277f, -0.15429012f, -1.4159456f, -1.1466888f), float4(-0.9994283f, 2.6177647f, 0.45010838f, 1.4062314f), float4(-1.7475772f, -3.352449f, -0.28202784f, -0.8496246f), float4(0.8343176f, -0.610604f, 1.8189929f, 0.8360092f)),
    float4x4(float4(1.4888489f, -1.7507061f, -2.3789833f, -0.33815762f), float4(-0.9610482f, -4.7598224f, 0.5400893f, -0.27676913f), float4(2.1696684f, 2.3751001f, -0.8185451f, -0.39043123f), float4(20.988102f, -8.060803f, -6.457696f, 2.0178878f)),
    float4x4(float4(-1.9192039f, 1.2973583f, 0.12957217f, -2.0995288f), float4(0.13706096f, 0.18189034f, -0.07957252f, -1.3877001f), float4(0.60850334f, -0.78841f, -0.14115039f, -0.776932f), float4(-0.011215124f, 0.34320807f, 0.14902373f, 0.3875658f)),
    float4x4(float4(-0.81812435f, 0.94332623f, 0.01563329f, 0.16517355f), float4(-1.3968968f, -0.28342438f, -0.29675168f, -4.430481f), float4(1.4621456f, -2.2371657f, -0.68029326f, -0.5449462f), float4(-2.476674f, -0.56428456f, -0.10914541f, 0.76484877f)),
    float4x4(float4(-1.0451545f, 0.22052269f, -0.6172878f, 2.7052572f), float4(1.7968506f, 0.17819253f, 0.08662049f, -1.1919606f), float4(-0.8731105f, 1.1723455f, -0.27935618f, 2.347068f), float4(-0.23865318f, -1.2344798f, 0.30622983f, 1.1333549f)),
    float4x4(float4(-0.5555628f, 4.491205f, 0.045380052f, 2.1592524f), float4(2.492795f, -0.41927868f, -0.5530473f, 0.7241723f), float4(1.3377888f, 0.7353521f, -0.59209406f, 1.995464f), float4(2.6316738f, -1.2303891f, -0.38901335f, 9.579925f))
};
static const float4 NMT_B2[2] = {
    float4(-0.17192039f, 0.17679797f, 1.3886025f, -1.34472f),
    float4(2.173804f, 0.5498685f, 0.17730568f, -0.7695141f)
};
static const float4 NMT_W3[2] = {
    float4(-0.50458753f, 0.20017031f, 0.6225078f, -0.7532515f),
    float4(0.2678952f, 0.3193554f, -0.35949963f, -0.49384788f)
};
static const float NMT_B3 = 0.57963055f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float2x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = float4(f[1].xyz, 1.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[2]) + mul(h0_1, NMT_W1[3]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[4]) + mul(h0_1, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_0 = max(NMT_B2[0] + mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(NMT_B2[1] + mul(h1_0, NMT_W2[4]) + mul(h1_1, NMT_W2[5]) + mul(h1_2, NMT_W2[6]) + mul(h1_3, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float2x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif
