// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1; behind them the buffer of pass 1, as vectors.
//
// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset 9636ee68609509b56e59e891665a02e7488e2241af88306025242c084edbf4a2.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

const NMT_W1 = array<mat4x4<f32>, 12>(
    mat4x4<f32>(vec4<f32>(1.9524608f, 1.0713975f, 1.4039351f, -1.5217286f), vec4<f32>(-0.022230538f, 0.026557269f, 0.06309734f, -0.17475322f), vec4<f32>(0.047427006f, -0.00469664f, 0.025943926f, 0.26743507f), vec4<f32>(-2.610338f, 1.7166722f, 8.023302f, 0.13859871f)),
    mat4x4<f32>(vec4<f32>(-0.31684518f, 3.2051063f, 1.401991f, -2.1894662f), vec4<f32>(0.04005704f, 0.32028624f, -0.39842847f, -0.66725725f), vec4<f32>(0.16254476f, -0.4127584f, 1.1801735f, 1.8491927f), vec4<f32>(-0.22754906f, 0.7579889f, 0.09157842f, -0.87315947f)),
    mat4x4<f32>(vec4<f32>(-0.2689073f, 0.21747705f, -0.13199797f, -0.12784465f), vec4<f32>(2.1772313f, 1.1888932f, 1.1551433f, -0.87760884f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.81854665f, 1.409713f, -0.41876668f, -1.3666365f), vec4<f32>(0.034107465f, -0.03685927f, -0.1553165f, 0.12620565f), vec4<f32>(0.03321912f, 0.0033020813f, 0.06593848f, -0.007674537f), vec4<f32>(3.6540296f, -2.2724702f, 2.8454916f, 1.4697961f)),
    mat4x4<f32>(vec4<f32>(-2.299097f, -2.199256f, -5.2893305f, 1.9870816f), vec4<f32>(2.4571347f, -0.83326393f, -1.4877391f, -0.93114316f), vec4<f32>(-2.7327578f, 0.12991856f, 0.48797175f, 0.47749f), vec4<f32>(-2.8144898f, -1.2780569f, 2.2409158f, 1.4453955f)),
    mat4x4<f32>(vec4<f32>(0.78125113f, 2.5927734f, 1.0933044f, -0.5034421f), vec4<f32>(-0.24653246f, 1.0398772f, 0.8146086f, 0.2817792f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.9260247f, 0.85952455f, 0.45401737f, 1.2723763f), vec4<f32>(-0.04285044f, 0.31560546f, 0.017856365f, -0.028521825f), vec4<f32>(-0.052516434f, -0.27625632f, 0.0510878f, -0.0137894405f), vec4<f32>(1.6011887f, 0.12541816f, -0.17053595f, -0.46624243f)),
    mat4x4<f32>(vec4<f32>(-4.574354f, 2.887386f, 0.074741684f, -7.2879086f), vec4<f32>(-0.31982198f, 1.5869461f, 1.8657863f, -3.0015862f), vec4<f32>(-0.33059454f, -1.782947f, 0.9666899f, 0.33783144f), vec4<f32>(0.26441604f, -0.5676601f, -2.3556285f, 2.1970835f)),
    mat4x4<f32>(vec4<f32>(1.211836f, 0.73746043f, 2.4677353f, 2.5184371f), vec4<f32>(-1.1619287f, 0.8677148f, -1.4660302f, 0.62358993f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.16088599f, -1.5223581f, 0.0f, 0.0f), vec4<f32>(-0.0041487496f, 0.19258048f, 0.0f, 0.0f), vec4<f32>(0.056485593f, -0.04926818f, 0.0f, 0.0f), vec4<f32>(11.940453f, -12.363574f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.1872992f, 2.1171644f, 0.0f, 0.0f), vec4<f32>(-2.1300912f, 2.1395888f, 0.0f, 0.0f), vec4<f32>(0.33336386f, -0.8256183f, 0.0f, 0.0f), vec4<f32>(2.8348258f, -2.3406053f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(1.5841515f, -6.709348f, 0.0f, 0.0f), vec4<f32>(-1.2724476f, -0.22252339f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.2749535f, -1.2206278f, 0.028193194f, 0.8423979f), vec4<f32>(-1.2200161f, 1.2229213f, 0.3101811f, 0.31512943f), vec4<f32>(-0.15609749f, 1.2058281f, -0.41686842f, -0.1321389f), vec4<f32>(0.5738092f, 0.32298833f, -0.25300327f, 0.70333153f)),
    mat4x4<f32>(vec4<f32>(-0.9644515f, -1.4976041f, -0.8924194f, 1.031193f), vec4<f32>(0.09596964f, -1.3812109f, -0.99426335f, -0.7698786f), vec4<f32>(-0.27224338f, 0.49484494f, -0.30159897f, 1.3121598f), vec4<f32>(0.40367886f, -0.07355354f, 0.9684212f, 0.15634966f)),
    mat4x4<f32>(vec4<f32>(0.31352583f, -0.07697483f, -0.27615148f, 2.0191827f), vec4<f32>(-0.07209049f, 0.2702196f, -2.1244931f, 0.27906394f), vec4<f32>(-0.23925827f, -0.9513572f, 2.03597f, 0.32911965f), vec4<f32>(-2.638307f, 1.872359f, 1.6225691f, -1.4433334f)),
    mat4x4<f32>(vec4<f32>(0.02017221f, -1.6147795f, 0.14303435f, 0.83729297f), vec4<f32>(-0.6862176f, -0.44755808f, -4.0235376f, -0.01778543f), vec4<f32>(1.0969412f, 0.02962239f, 1.0639843f, 0.49953485f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.6739009f, 1.4489998f, -6.061824f, 1.7098606f), vec4<f32>(1.4577574f, -1.8589485f, -0.38928428f, 0.10030627f), vec4<f32>(0.01998619f, 0.48650917f, -1.7238876f, -2.6405706f), vec4<f32>(-1.2022905f, -0.27215597f, 1.5082463f, -0.13863346f)),
    mat4x4<f32>(vec4<f32>(-0.6243122f, 1.7342827f, 0.32260272f, 1.9255228f), vec4<f32>(0.56403655f, 1.1141405f, -0.71229786f, 0.5767114f), vec4<f32>(0.95821536f, -0.49319956f, -0.39364746f, 0.9515521f), vec4<f32>(-0.4755803f, -1.4792235f, 1.0261518f, -0.9079893f)),
    mat4x4<f32>(vec4<f32>(0.15076402f, 1.4911646f, 0.30963883f, -0.9034152f), vec4<f32>(-0.1908811f, -0.0032071099f, 0.75148535f, -0.147816f), vec4<f32>(0.76777065f, -1.6563613f, 0.27035776f, -1.2608712f), vec4<f32>(-2.4480877f, -1.9728118f, 0.1101791f, -1.0284874f)),
    mat4x4<f32>(vec4<f32>(1.7924052f, 0.9207351f, -0.14314386f, 1.8696913f), vec4<f32>(0.77036667f, 1.9583427f, 0.1715907f, 2.3901844f), vec4<f32>(-1.3831987f, 0.44357684f, -0.54849935f, 0.33465484f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.62214833f, 0.39003918f, 0.40604776f, -0.75780785f),
    vec4<f32>(0.4352812f, 0.8156252f, -1.98668f, -0.6356217f)
);
const NMT_B3: f32 = -0.8207263f;

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
// Slots of a pixel, empty ones at the end among them, a multiple of four.
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

// Least and greatest share of the tail that may lie in front of x, from its moments: Markov's bounds.
fn nmt_core_bounds(x: f32, m1: f32, m2: f32, m3: f32, m4: f32) -> vec2<f32> {
    let mean = m1 * 0.9999;
    let second = m2 * 0.9999 + 3.3333334e-5;
    let third = m3 * 0.9999;
    let square = mean * mean;
    let variance = max(second - square, 1e-7);
    let per_deviation = 1.0 / sqrt(variance);
    let per_variance = per_deviation * per_deviation;
    let skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    let d = clamp((m4 * 0.9999 + 2e-5 - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    let y = (x - mean) * per_deviation;
    let q = (y * (y - skewness) - 1.0) / d;
    let at = 1.0 / (1.0 + y * y + q * q * d);
    let rest = 1.0 - at;
    let linear_ = y - q * skewness;
    let per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    let between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    let lower = select(select(0.0, rest, y > 0.5 * skewness), between, 0.0 > q);
    return vec2<f32>(lower, lower + at);
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
@group(1) @binding(2) var<storage, read> core: array<vec4<u32>>;

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
    let first = 1u * (at.y * frame.width + at.x);
    let sums0 = textureLoad(sums0_texture, at, 0);
    let sums1 = textureLoad(sums1_texture, at, 0);
    let moments = vec4<f32>(sums0.y, sums0.z, sums0.w, sums1.x);
    let T = nmt_core_transmittance(steps, codes, core[first], sums1.y, sums0.x, moments);
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
