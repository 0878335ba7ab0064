// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as vectors.
//
// Neural moment transparency: network 'core-small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 5d4deb2f2c8a96ac5dfda935ab5f840b24948e782c8fbc4ba250b79fb256de83.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

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

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 2u;
// Slots of a pixel, empty ones at the end among them, a multiple of four.
static const uint NMT_SLOTS = 4u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
static const float NMT_KEY_SCALE = 0.375;
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

uint2 nmt_core_nearest_steps(uint code) {
    return uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint2 nmt_core_farthest_steps(uint code) {
    return uint2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
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
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_4) * nmt_transmittance(float2x4(float4(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), mean), float4(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
        * mean, 1e-6), 0.0, 1.0), mean_2, sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2)
        / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0)));
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

cbuffer Frame : register(b0) {
    float2 v_range;
    uint width;
};

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> sums1_texture : register(t1);
StructuredBuffer<uint4> core : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 pixel = uint2(input.position.xy);
    uint first = 1u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
    float4 sums0 = sums0_texture.Load(at);
    float4 sums1 = sums1_texture.Load(at);
    float4 moments = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, core[first], sums1.y, sums0.x, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
