// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures of group 1: the targets of pass 1; behind them the buffer of pass 1, as pairs.
//
// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 4cb0c11bc9538ca61a2ffd6e935d976f36720f667fe3b7ae3813684c758f300e.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.533e-3, worst 1.000.

const NMT_W1 = array<mat4x4<f32>, 12>(
    mat4x4<f32>(vec4<f32>(4.8778276f, -0.7319692f, 3.6530824f, -1.6481752f), vec4<f32>(-0.24516319f, -0.27494642f, -0.023510791f, 0.11400228f), vec4<f32>(0.228575f, 0.25520048f, 0.13499178f, -0.10372328f), vec4<f32>(-0.5467422f, 2.6183908f, 8.650195f, -1.3826258f)),
    mat4x4<f32>(vec4<f32>(-5.8551807f, -1.0576799f, 2.7924774f, -8.082505f), vec4<f32>(-2.5652757f, 2.1842368f, -0.101185136f, 0.8496825f), vec4<f32>(0.11754783f, 1.1701148f, 0.4261731f, 1.0241573f), vec4<f32>(-0.5958086f, 0.81029135f, -0.8975072f, -1.8926371f)),
    mat4x4<f32>(vec4<f32>(1.3035642f, -0.14273503f, -0.14144559f, 2.2584605f), vec4<f32>(5.9671373f, 1.4847919f, 3.1871316f, 1.8420736f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.098758f, 2.3643606f, 1.9390315f, -0.025061242f), vec4<f32>(0.013713428f, 0.24798474f, -0.17473f, 0.1092438f), vec4<f32>(-0.016801622f, -0.1513876f, 0.054045714f, -0.00874805f), vec4<f32>(14.739972f, -164.7957f, 7.3871503f, -26.957058f)),
    mat4x4<f32>(vec4<f32>(-8.423298f, -16.265095f, -6.763347f, -3.6461272f), vec4<f32>(5.1973667f, -6.2610235f, -5.804388f, -0.79259384f), vec4<f32>(-5.0187683f, -2.1178577f, -0.1445185f, -0.47444504f), vec4<f32>(-5.852785f, 4.4160266f, 4.6112943f, -0.07370595f)),
    mat4x4<f32>(vec4<f32>(0.495891f, 6.758663f, -0.74108994f, -2.9599438f), vec4<f32>(-0.9314051f, 1.3079683f, 2.440642f, 4.655624f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-7.4299335f, -0.2297995f, -3.6704452f, 3.7584605f), vec4<f32>(-0.10068613f, 0.116125256f, -0.20114587f, 0.06323509f), vec4<f32>(0.11217993f, -0.048117194f, 0.16280521f, 0.034884017f), vec4<f32>(1.0506787f, 10.068197f, 13.049514f, -17.764614f)),
    mat4x4<f32>(vec4<f32>(-1.1598299f, 6.9126554f, -11.887382f, -10.6937065f), vec4<f32>(-0.5063457f, 1.4594547f, 2.707645f, -0.41473576f), vec4<f32>(0.3520074f, -0.93157744f, -5.942758f, 7.43136f), vec4<f32>(0.032555133f, -0.83957905f, 0.4354543f, -3.0254202f)),
    mat4x4<f32>(vec4<f32>(-0.03307929f, 0.2872462f, 0.307582f, -20.961397f), vec4<f32>(-6.8072767f, -1.608604f, -0.09493034f, 3.3601375f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.1927843f, -0.7596912f, 0.0f, 0.0f), vec4<f32>(-0.16797958f, -0.28360534f, 0.0f, 0.0f), vec4<f32>(0.097345725f, 0.1268056f, 0.0f, 0.0f), vec4<f32>(1.7302861f, 0.53903437f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.5574605f, -7.9472857f, 0.0f, 0.0f), vec4<f32>(-2.2368462f, 6.9823356f, 0.0f, 0.0f), vec4<f32>(-3.3104074f, -10.6633005f, 0.0f, 0.0f), vec4<f32>(4.8967834f, -6.983885f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(5.501963f, 0.5043578f, 0.0f, 0.0f), vec4<f32>(-4.593644f, 1.2066915f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.7685847f, -1.2965266f, 0.53486013f, -0.29221267f), vec4<f32>(0.5022446f, -0.57678044f, 2.8619845f, 1.1610198f), vec4<f32>(-1.510298f, 1.0492433f, -2.4719512f, 0.69602823f), vec4<f32>(0.4245065f, -0.021788223f, -2.2097266f, 0.45277822f)),
    mat4x4<f32>(vec4<f32>(-1.9844544f, -4.284621f, -2.0162687f, 0.80677956f), vec4<f32>(-0.08269256f, 0.83371484f, 1.4538207f, -0.3430089f), vec4<f32>(0.33549848f, 1.315723f, -2.6486657f, -0.9424922f), vec4<f32>(0.6682035f, 0.7352949f, 0.77444446f, 1.5549136f)),
    mat4x4<f32>(vec4<f32>(-3.7106292f, 1.4094218f, -3.0866914f, 6.321356f), vec4<f32>(2.9056916f, -1.6683085f, 2.5197487f, -0.12306516f), vec4<f32>(1.8786901f, 2.9980502f, 0.53554356f, 0.6986177f), vec4<f32>(-1.4987996f, 0.16394545f, -11.833226f, -0.9698973f)),
    mat4x4<f32>(vec4<f32>(0.105152994f, -2.629642f, -0.26539943f, 0.97390944f), vec4<f32>(0.20291848f, -4.665007f, -3.2223794f, -1.1747206f), vec4<f32>(-3.0591586f, 2.422517f, -0.3822718f, -1.1229484f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-2.5065336f, 1.2751687f, -3.1727622f, 2.6094267f), vec4<f32>(-0.34650132f, -0.58315194f, -2.036526f, -0.97464854f), vec4<f32>(3.4674072f, 1.1141264f, -2.0562246f, -1.5358669f), vec4<f32>(-0.8401374f, 1.7635139f, 0.88128996f, 1.1690073f)),
    mat4x4<f32>(vec4<f32>(0.62812424f, -0.6253937f, 0.07006818f, -0.3447436f), vec4<f32>(4.757243f, 4.1627517f, -0.32235038f, 1.8340607f), vec4<f32>(0.95672405f, -0.06239507f, -0.2886359f, -0.745714f), vec4<f32>(-2.170308f, -2.8018155f, 0.12480712f, -2.8756857f)),
    mat4x4<f32>(vec4<f32>(-0.46313936f, -0.42326838f, 13.634587f, -0.8679801f), vec4<f32>(-3.8175569f, 0.6408508f, 0.8411556f, 1.3615565f), vec4<f32>(0.9755631f, 0.9696179f, 0.1144694f, 1.0314378f), vec4<f32>(1.4169557f, -0.5175313f, -0.8745645f, -0.68139124f)),
    mat4x4<f32>(vec4<f32>(-0.31971556f, 0.8106935f, 0.48868963f, -0.17111878f), vec4<f32>(0.9139772f, -0.97476697f, -7.719652f, -1.006329f), vec4<f32>(4.2278967f, -1.388446f, -2.153287f, 4.008335f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.2411506f, 0.1824429f, 0.16963111f, -0.3715353f),
    vec4<f32>(-0.2563782f, 0.3967364f, -1.0420152f, -0.3345766f)
);
const NMT_B3: f32 = 0.17377278f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat3x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = f[1];
    let h0_2 = vec4<f32>(f[2].x, 1.0f, 0.0f, 0.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4<f32>(0.0f)) + vec4<f32>(0.0f, 0.0f, 1.0f, 0.0f);
    let h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4<f32>(0.0f));
    let h2_1 = max(NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat3x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

const NMT_DEPTH_BITS: u32 = 16u;
// Steps of absorbance to the octave, as a power of two.
const NMT_OCTAVE_BITS: u32 = 11u;
const NMT_HEAVY: u32 = 2u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const NMT_SLOTS: u32 = 4u;
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

fn nmt_core_nearest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_farthest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_heavy_steps(code: u32, codes: NmtCodes) -> vec2<u32> {
    let nearness = code & NMT_LAST_DEPTH;
    let key = code >> NMT_DEPTH_BITS;
    return vec2<u32>(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Where the moments of the tail leave what the fragment adds to the image open by no more than this, T is the middle of
// what they allow, and the network is not asked. 0 always asks it; 1/512 cannot be seen.
const NMT_OPEN: f32 = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err than
// these: Markov's bounds.
fn nmt_core_bounds(x: f32, m1: f32, m2: f32, m3: f32, m4: f32) -> vec3<f32> {
    let mean = m1 * 0.9999;
    let second = m2 * 0.9999 + 3.3333334e-5;
    let third = m3 * 0.9999;
    let fourth = m4 * 0.9999 + 2e-5;
    let square = mean * mean;
    let variance = max(second - square, 1e-7);
    let per_deviation = 1.0 / sqrt(variance);
    let per_variance = per_deviation * per_deviation;
    let skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    let d = clamp((fourth - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    let y = (x - mean) * per_deviation;
    let per_d = 1.0 / d;
    let q = (y * (y - skewness) - 1.0) * per_d;
    let at = 1.0 / (1.0 + y * y + q * q * d);
    let rest = 1.0 - at;
    let linear_ = y - q * skewness;
    let per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    let between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    let lower = select(select(0.0, rest, y > 0.5 * skewness), between, 0.0 > q);
    let inner = max(1.0 - second, 1e-6);
    let per_inner = 1.0 / inner;
    let inner_mean = (mean - third) * per_inner;
    let inner_second = (second - fourth) * per_inner;
    let width = max(inner_second - inner_mean * inner_mean, 1e-7);
    let place = inner_mean - x;
    let of_inner = width / (width + place * place);
    let ended = inner * of_inner / max(1.0 - x * x, 1e-6);
    let side = select(1.0, -1.0, 0.0 > place);
    let of_fourth = inner * (1.0 - of_inner) * abs(place) / max(abs(place) + inner_second - x * inner_mean, 1e-6);
    let at_end = clamp(0.5 * (1.0 - side * mean - ended * (1.0 - side * x) - of_fourth), 0.0, max(1.0 - ended, 0.0));
    let least = select(lower, select(at_end, 1.0 - ended - at_end, 0.0 > place), at > ended);
    let most = select(at, ended, at > ended);
    return vec3<f32>(least, least + most, per_variance * per_variance * per_d);
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
    let bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        let bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        let most = min(exp(-(front_4 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        let least = min(exp(-(front_4 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        let opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            let middle = 0.5 * (most + least);
            return middle;
        }
    }
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_4) * nmt_transmittance(mat3x4<f32>(vec4<f32>(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), bounds.x), vec4<f32>(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
        * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0), mean_2), vec4<f32>(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0
        - m2, 1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
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

struct Frame {
    v0: f32,
    v1: f32,
    width: u32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var sums0_texture: texture_2d<f32>;
@group(1) @binding(1) var sums1_texture: texture_2d<f32>;
@group(1) @binding(2) var<storage, read> core: array<vec2<u32>>;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn pass2(in: Varying) -> @location(0) vec4<f32> {
    let codes = nmt_core_codes(frame.v0, frame.v1);
    let steps = nmt_core_steps(in.v, nmt_core_absorbance_of(in.color.a), codes);
    let at = vec2<u32>(in.position.xy);
    let first = 2u * (at.y * frame.width + at.x);
    let sums0 = textureLoad(sums0_texture, at, 0);
    let sums1 = textureLoad(sums1_texture, at, 0);
    let moments = vec4<f32>(sums0.y, sums0.z, sums0.w, sums1.x);
    let T = nmt_core_transmittance(steps, codes, vec4<u32>(core[first], core[first + 1u]), sums1.y, sums0.x, moments);
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
