// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as pairs.
//
// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 4cb0c11bc9538ca61a2ffd6e935d976f36720f667fe3b7ae3813684c758f300e.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.533e-3, worst 1.000.

static const float4x4 NMT_W1[12] = {
    float4x4(float4(4.8778276f, -0.7319692f, 3.6530824f, -1.6481752f), float4(-0.24516319f, -0.27494642f, -0.023510791f, 0.11400228f), float4(0.228575f, 0.25520048f, 0.13499178f, -0.10372328f), float4(-0.5467422f, 2.6183908f, 8.650195f, -1.3826258f)),
    float4x4(float4(-5.8551807f, -1.0576799f, 2.7924774f, -8.082505f), float4(-2.5652757f, 2.1842368f, -0.101185136f, 0.8496825f), float4(0.11754783f, 1.1701148f, 0.4261731f, 1.0241573f), float4(-0.5958086f, 0.81029135f, -0.8975072f, -1.8926371f)),
    float4x4(float4(1.3035642f, -0.14273503f, -0.14144559f, 2.2584605f), float4(5.9671373f, 1.4847919f, 3.1871316f, 1.8420736f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.098758f, 2.3643606f, 1.9390315f, -0.025061242f), float4(0.013713428f, 0.24798474f, -0.17473f, 0.1092438f), float4(-0.016801622f, -0.1513876f, 0.054045714f, -0.00874805f), float4(14.739972f, -164.7957f, 7.3871503f, -26.957058f)),
    float4x4(float4(-8.423298f, -16.265095f, -6.763347f, -3.6461272f), float4(5.1973667f, -6.2610235f, -5.804388f, -0.79259384f), float4(-5.0187683f, -2.1178577f, -0.1445185f, -0.47444504f), float4(-5.852785f, 4.4160266f, 4.6112943f, -0.07370595f)),
    float4x4(float4(0.495891f, 6.758663f, -0.74108994f, -2.9599438f), float4(-0.9314051f, 1.3079683f, 2.440642f, 4.655624f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-7.4299335f, -0.2297995f, -3.6704452f, 3.7584605f), float4(-0.10068613f, 0.116125256f, -0.20114587f, 0.06323509f), float4(0.11217993f, -0.048117194f, 0.16280521f, 0.034884017f), float4(1.0506787f, 10.068197f, 13.049514f, -17.764614f)),
    float4x4(float4(-1.1598299f, 6.9126554f, -11.887382f, -10.6937065f), float4(-0.5063457f, 1.4594547f, 2.707645f, -0.41473576f), float4(0.3520074f, -0.93157744f, -5.942758f, 7.43136f), float4(0.032555133f, -0.83957905f, 0.4354543f, -3.0254202f)),
    float4x4(float4(-0.03307929f, 0.2872462f, 0.307582f, -20.961397f), float4(-6.8072767f, -1.608604f, -0.09493034f, 3.3601375f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.1927843f, -0.7596912f, 0.0f, 0.0f), float4(-0.16797958f, -0.28360534f, 0.0f, 0.0f), float4(0.097345725f, 0.1268056f, 0.0f, 0.0f), float4(1.7302861f, 0.53903437f, 0.0f, 0.0f)),
    float4x4(float4(0.5574605f, -7.9472857f, 0.0f, 0.0f), float4(-2.2368462f, 6.9823356f, 0.0f, 0.0f), float4(-3.3104074f, -10.6633005f, 0.0f, 0.0f), float4(4.8967834f, -6.983885f, 0.0f, 0.0f)),
    float4x4(float4(5.501963f, 0.5043578f, 0.0f, 0.0f), float4(-4.593644f, 1.2066915f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[8] = {
    float4x4(float4(1.7685847f, -1.2965266f, 0.53486013f, -0.29221267f), float4(0.5022446f, -0.57678044f, 2.8619845f, 1.1610198f), float4(-1.510298f, 1.0492433f, -2.4719512f, 0.69602823f), float4(0.4245065f, -0.021788223f, -2.2097266f, 0.45277822f)),
    float4x4(float4(-1.9844544f, -4.284621f, -2.0162687f, 0.80677956f), float4(-0.08269256f, 0.83371484f, 1.4538207f, -0.3430089f), float4(0.33549848f, 1.315723f, -2.6486657f, -0.9424922f), float4(0.6682035f, 0.7352949f, 0.77444446f, 1.5549136f)),
    float4x4(float4(-3.7106292f, 1.4094218f, -3.0866914f, 6.321356f), float4(2.9056916f, -1.6683085f, 2.5197487f, -0.12306516f), float4(1.8786901f, 2.9980502f, 0.53554356f, 0.6986177f), float4(-1.4987996f, 0.16394545f, -11.833226f, -0.9698973f)),
    float4x4(float4(0.105152994f, -2.629642f, -0.26539943f, 0.97390944f), float4(0.20291848f, -4.665007f, -3.2223794f, -1.1747206f), float4(-3.0591586f, 2.422517f, -0.3822718f, -1.1229484f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.5065336f, 1.2751687f, -3.1727622f, 2.6094267f), float4(-0.34650132f, -0.58315194f, -2.036526f, -0.97464854f), float4(3.4674072f, 1.1141264f, -2.0562246f, -1.5358669f), float4(-0.8401374f, 1.7635139f, 0.88128996f, 1.1690073f)),
    float4x4(float4(0.62812424f, -0.6253937f, 0.07006818f, -0.3447436f), float4(4.757243f, 4.1627517f, -0.32235038f, 1.8340607f), float4(0.95672405f, -0.06239507f, -0.2886359f, -0.745714f), float4(-2.170308f, -2.8018155f, 0.12480712f, -2.8756857f)),
    float4x4(float4(-0.46313936f, -0.42326838f, 13.634587f, -0.8679801f), float4(-3.8175569f, 0.6408508f, 0.8411556f, 1.3615565f), float4(0.9755631f, 0.9696179f, 0.1144694f, 1.0314378f), float4(1.4169557f, -0.5175313f, -0.8745645f, -0.68139124f)),
    float4x4(float4(-0.31971556f, 0.8106935f, 0.48868963f, -0.17111878f), float4(0.9139772f, -0.97476697f, -7.719652f, -1.006329f), float4(4.2278967f, -1.388446f, -2.153287f, 4.008335f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4 NMT_W3[2] = {
    float4(-0.2411506f, 0.1824429f, 0.16963111f, -0.3715353f),
    float4(-0.2563782f, 0.3967364f, -1.0420152f, -0.3345766f)
};
static const float NMT_B3 = 0.17377278f;

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

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 2u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
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

// Where the moments of the tail leave what the fragment adds to the image open by no more than this, T is the middle of
// what they allow, and the network is not asked. 0 always asks it; 1/512 cannot be seen.
static const float NMT_OPEN = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err than
// these: Markov's bounds.
float3 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
    float mean = m1 * 0.9999;
    float second = m2 * 0.9999 + 3.3333334e-5;
    float third = m3 * 0.9999;
    float fourth = m4 * 0.9999 + 2e-5;
    float square = mean * mean;
    float variance = max(second - square, 1e-7);
    float per_deviation = 1.0 / sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    float d = clamp((fourth - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float per_d = 1.0 / d;
    float q = (y * (y - skewness) - 1.0) * per_d;
    float at = 1.0 / (1.0 + y * y + q * q * d);
    float rest = 1.0 - at;
    float linear_ = y - q * skewness;
    float per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    float between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    float lower = (q < 0.0 ? between : (y > 0.5 * skewness ? rest : 0.0));
    float inner = max(1.0 - second, 1e-6);
    float per_inner = 1.0 / inner;
    float inner_mean = (mean - third) * per_inner;
    float inner_second = (second - fourth) * per_inner;
    float width = max(inner_second - inner_mean * inner_mean, 1e-7);
    float place = inner_mean - x;
    float of_inner = width / (width + place * place);
    float ended = inner * of_inner / max(1.0 - x * x, 1e-6);
    float side = (place < 0.0 ? -1.0 : 1.0);
    float of_fourth = inner * (1.0 - of_inner) * abs(place) / max(abs(place) + inner_second - x * inner_mean, 1e-6);
    float at_end = clamp(0.5 * (1.0 - side * mean - ended * (1.0 - side * x) - of_fourth), 0.0, max(1.0 - ended, 0.0));
    float least = (ended < at ? (place < 0.0 ? 1.0 - ended - at_end : at_end) : lower);
    float most = (ended < at ? ended : at);
    return float3(least, least + most, per_variance * per_variance * per_d);
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
    float3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_4 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_4 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
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

cbuffer Frame : register(b0) {
    float2 v_range;
    uint width;
};

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> sums1_texture : register(t1);
StructuredBuffer<uint2> core : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 pixel = uint2(input.position.xy);
    uint first = 2u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
    float4 sums0 = sums0_texture.Load(at);
    float4 sums1 = sums1_texture.Load(at);
    float4 moments = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, uint4(core[first], core[first + 1u]), sums1.y, sums0.x, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
