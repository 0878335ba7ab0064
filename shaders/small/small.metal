// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.
//
// Features, set 'recentred', in this order: x, count, ln_b0, mean, spread, inner_mean, inner_spread.
// v is distance along the view direction and z = 2 ln(v/v0)/ln(v1/v0) - 1 moment depth, v0 and v1 the scene's least and greatest v;
// pass 1 adds up b_k = sum of A z^k, counts fragments (n) and keeps the pixel's least and greatest v as f32.
// A = min(-ln(1 - alpha), 10) is a fragment's absorbance; primed quantities leave out the fragment's own, b_k' = b_k - A z^k.
// c and h are middle and half of the pixel's range of z; m_k = moments of the others in (z - c)/h, normalised by b_0'.
// x = (z - c)/h, count = log2(n)/3 - 1, ln_b0 = ln(b_0' + 0.05);
// mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2) times the measure: mean = (m_1 - m_3)/(1 - m_2),
// spread = the square root of the same ratio of its own; inner2_ and inner3_ of (1 - x^2)^2 and (1 - x^2)^3, faded out where f32 leaves noise.
// The answer is T = exp(-b_0' s), s the network's sigmoid: the share of the other absorbance that lies in front.
// Not part of the network, and to be applied before it, in this order: nearest in its pixel (v compared bit for bit): T = 1;
// b_0' <= 1e-6 b_0: T = 1; farthest: T = exp(-b_0'); three fragments: T = exp(-b_0' (1 - m_1)/2);
// four fragments: the closed form in nmt_recentred.
// So pixels of up to four fragments, and all that is nearest or farthest, never need the network.
//
// Provenance: nmt 0.1.0, commit a3706793e652-modified, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

#ifndef NMT_INCLUDED_SMALL
#define NMT_INCLUDED_SMALL

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct type_1 {
    float inner[4];
};
struct type_2 {
    float inner[8];
};
struct type_4 {
    metal::float4x4 inner[8];
};
struct type_6 {
    metal::float4 inner[2];
};
struct type_7 {
    float inner[7];
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant type_4 NMT_W1 = type_4 {{metal::float4x4(metal::float4(0.5572419, 0.8873689, 0.025650654, -2.3207302), metal::float4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), metal::float4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), metal::float4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)), metal::float4x4(metal::float4(2.9037392, 4.164609, 1.6416957, -1.0860678), metal::float4(3.182191, -1.0674255, -0.9432166, 2.8805542), metal::float4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), metal::float4(2.1899598, -1.1524864, 2.8668165, 0.26594585)), metal::float4x4(metal::float4(-5.0277195, 3.556171, -4.748659, -3.4211285), metal::float4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), metal::float4(0.11110483, -0.09587958, 0.028702937, 0.08554635), metal::float4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)), metal::float4x4(metal::float4(0.8829105, 1.4194763, -0.053129755, -4.384808), metal::float4(5.9241633, 0.9597082, 4.626354, -0.6152009), metal::float4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), metal::float4(-1.2974775, 2.533871, 0.26404834, 1.322599)), metal::float4x4(metal::float4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), metal::float4(0.48690128, 0.11834759, 0.17926306, -0.20529807), metal::float4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), metal::float4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)), metal::float4x4(metal::float4(-0.42825016, -0.66429555, -6.518144, -0.7735734), metal::float4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), metal::float4(2.9222262, 1.6352106, 6.105769, -1.6681633), metal::float4(-2.4759755, -2.758409, -1.277408, 3.7719758)), metal::float4x4(metal::float4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), metal::float4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), metal::float4(0.10049601, 0.0337685, -0.1098763, 0.017653327), metal::float4(1.6598035, -5.834993, -5.4151325, -0.41488847)), metal::float4x4(metal::float4(-1.4044262, -5.671788, 1.827299, 0.9802938), metal::float4(0.16522916, 2.2399037, -0.2985399, 0.34238428), metal::float4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), metal::float4(2.0557249, 1.7273939, -0.45318872, -4.756142))}};
constant type_4 NMT_W2 = type_4 {{metal::float4x4(metal::float4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), metal::float4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), metal::float4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), metal::float4(0.7370069, 0.3038649, 0.3395028, 0.80514723)), metal::float4x4(metal::float4(-3.49791, -0.6550794, 0.46273717, -1.0264783), metal::float4(-0.39480978, 0.22474408, 1.956778, -0.082365066), metal::float4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), metal::float4(3.1965384, -1.0385951, -2.110678, 0.43452936)), metal::float4x4(metal::float4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), metal::float4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), metal::float4(4.966727, -0.31968412, 0.58516496, 0.77836883), metal::float4(1.5743009, -0.9283775, -0.74404365, 0.6748018)), metal::float4x4(metal::float4(2.7018049, 2.1556873, 0.6269551, 1.3626245), metal::float4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), metal::float4(-3.531625, 0.04492224, 2.324661, 1.9930973), metal::float4(-25.788624, 2.5182197, -1.4758978, 3.1982157)), metal::float4x4(metal::float4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), metal::float4(-1.1366525, -1.5580677, 0.22625221, -2.727241), metal::float4(1.318036, -0.8864321, -0.44220364, 0.3394501), metal::float4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)), metal::float4x4(metal::float4(0.79437137, -1.5935353, -2.7841825, 1.2082449), metal::float4(1.3773485, -0.25885287, -2.0684526, -3.7339642), metal::float4(-0.3631151, -21.331264, 0.13827866, 0.43595257), metal::float4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)), metal::float4x4(metal::float4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), metal::float4(-0.16068031, 1.6363701, 3.9007616, 4.429163), metal::float4(-6.5963273, 4.705528, 2.5016162, 3.4034655), metal::float4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)), metal::float4x4(metal::float4(0.659403, 2.378958, 0.81767404, -0.9107636), metal::float4(2.0063715, 0.6180353, 5.9041595, 0.08523572), metal::float4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), metal::float4(-5.688983, 4.35494, -39.64846, 12.921714))}};
constant type_6 NMT_B2 = type_6 {{metal::float4(-1.4392625, -3.6934829, -1.2812184, 3.0139205), metal::float4(4.0596824, -2.0969372, 1.9294189, -1.1730818)}};
constant type_6 NMT_W3 = type_6 {{metal::float4(-0.21454798, 0.23790133, 0.21061999, -0.41597816), metal::float4(-0.20229746, 0.22367835, 0.15568821, -0.21407762)}};
constant float NMT_B3 = -0.09972816;
constant float NMT_FAINT = 0.0625;
constant float NMT_HIDDEN = 0.00095;

float nmt_absorbance(
    float alpha
) {
    float faint = alpha * (1.0 + (alpha * (0.5 + (alpha * (0.33333334 + (alpha * (0.25 + (alpha * 0.2))))))));
    return (alpha < 0.03) ? faint : -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

float nmt_log_ratio(
    float a,
    float b
) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (metal::abs(s) < 0.2) ? ((s + s) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + (q * 0.11111111))))))))) : metal::log(a / b);
}

float nmt_moment_depth(
    float v,
    float v0,
    float v1
) {
    float _e3 = nmt_log_ratio(v, v0);
    float _e6 = nmt_log_ratio(v1, v0);
    float warped = ((2.0 * _e3) / metal::max(_e6, 0.000000000000000000000000000001)) - 1.0;
    return (v1 > v0) ? metal::clamp(warped, -1.0, 1.0) : 0.0;
}

type_1 nmt_moments(
    float z,
    float absorbance
) {
    float own1 = absorbance * z;
    float own2 = own1 * z;
    float own3 = own2 * z;
    float own4 = own3 * z;
    return type_1 {{own1, own2, own3, own4}};
}

type_2 nmt_recentred(
    float v_1,
    float z_1,
    float absorbance_1,
    float nearest,
    float farthest,
    float z_nearest,
    float z_farthest,
    float n,
    float b0,
    type_1 b_1
) {
    float m1 = {};
    float m2 = {};
    float m3 = {};
    float m4 = {};
    float front = -1.0;
    float others = metal::clamp(b0 - absorbance_1, 0.0, 1000000000000000000000000000000.0);
    float c = 0.5 * (z_nearest + z_farthest);
    float h1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
    float own1_1 = absorbance_1 * z_1;
    float own2_1 = own1_1 * z_1;
    float own3_1 = own2_1 * z_1;
    float own4_1 = own3_1 * z_1;
    float per_b0 = 1.0 / metal::max(others, 0.000000000000000000000000000001);
    m1 = (b_1.inner[0] - own1_1) * per_b0;
    m2 = (b_1.inner[1] - own2_1) * per_b0;
    m3 = (b_1.inner[2] - own3_1) * per_b0;
    m4 = (b_1.inner[3] - own4_1) * per_b0;
    float _e48 = m4;
    float _e49 = m3;
    m4 = _e48 - (c * _e49);
    float _e52 = m3;
    float _e53 = m2;
    m3 = _e52 - (c * _e53);
    float _e56 = m2;
    float _e57 = m1;
    m2 = _e56 - (c * _e57);
    float _e60 = m1;
    m1 = _e60 - c;
    float _e62 = m4;
    float _e63 = m3;
    m4 = _e62 - (c * _e63);
    float _e66 = m3;
    float _e67 = m2;
    m3 = _e66 - (c * _e67);
    float _e70 = m2;
    float _e71 = m1;
    m2 = _e70 - (c * _e71);
    float _e74 = m4;
    float _e75 = m3;
    m4 = _e74 - (c * _e75);
    float _e78 = m3;
    float _e79 = m2;
    m3 = _e78 - (c * _e79);
    float _e82 = m4;
    float _e83 = m3;
    m4 = _e82 - (c * _e83);
    float h2 = h1 * h1;
    float h3 = h2 * h1;
    float h4 = h2 * h2;
    float _e89 = m1;
    m1 = metal::clamp(_e89 * h1, -1.0, 1.0);
    float _e94 = m2;
    m2 = metal::clamp(_e94 * h2, -1.0, 1.0);
    float _e99 = m3;
    m3 = metal::clamp(_e99 * h3, -1.0, 1.0);
    float _e104 = m4;
    m4 = metal::clamp(_e104 * h4, -1.0, 1.0);
    float along = (z_1 - c) * h1;
    float range_2 = farthest - nearest;
    float ratio = range_2 / nearest;
    float t = (v_1 - nearest) / metal::max(range_2, 0.000000000000000000000000000001);
    float x = metal::clamp((ratio < 0.01) ? (((2.0 * t) * (1.0 + ((0.5 * ratio) * (1.0 - t)))) - 1.0) : along, -1.0, 1.0);
    float reach = 1.0 + ((2.0 * metal::abs(c)) * h1);
    float e1 = ((NMT_ROUNDING * reach) * b0) * per_b0;
    float per_n = 1.0 / n;
    float noise1 = e1 * (0.12 * metal::sqrt(n));
    float deviation1 = 0.22 + (0.7 * per_n);
    float trust1 = deviation1 * deviation1;
    float _e156 = m1;
    float mean0 = _e156 * (trust1 / (trust1 + (noise1 * noise1)));
    float front3 = others * metal::clamp(0.5 - (0.5 * mean0), 0.0, 1.0);
    float further = reach * 0.87;
    float noise2 = metal::min(noise1 * further, 1000000000000000.0);
    float noise3 = (noise1 * further) * further;
    float most0 = metal::max(1.0 - (mean0 * mean0), 0.000001);
    float deviation2 = 0.12 + (0.5 * per_n);
    float trust2 = (deviation2 * deviation2) * most0;
    float doubt2 = noise2 * noise2;
    float _e188 = m2;
    float spread0 = ((metal::clamp(_e188 - (mean0 * mean0), 0.0, most0) * trust2) + ((0.3 + (1.8 * per_n)) * doubt2)) / ((most0 * trust2) + doubt2);
    float _e203 = m2;
    float per_mass1 = 1.0 / metal::max(1.0 - _e203, 0.000001);
    float mean_part = 1.0 + spread0;
    float deviation3 = (0.17 + (3.1 * per_n)) * (spread0 + 0.02);
    float trust3 = deviation3 * deviation3;
    float bounded3 = metal::min(noise3 * per_mass1, 1000000000000000.0);
    float doubt3 = bounded3 * bounded3;
    float expected3 = mean0 * (1.0 - spread0);
    float _e227 = m1;
    float _e228 = m3;
    float raw_mean1 = metal::clamp((_e227 - _e228) * per_mass1, -1.0, 1.0);
    float mean1 = (((raw_mean1 * mean_part) * trust3) + (expected3 * doubt3)) / (mean_part * (trust3 + doubt3));
    float noise = bounded3 + (0.0000009536743 * per_mass1);
    float off = (noise * deviation3) / (noise + deviation3);
    float inner = (1.0 - spread0) * (1.0 - (mean0 * mean0));
    float near_share = metal::clamp(0.5 * ((1.0 - mean0) - (inner / metal::max(1.0 + mean1, 0.000001))), 0.0, 1.0);
    float far_share = metal::clamp(0.5 * ((1.0 + mean0) - (inner / metal::max(1.0 - mean1, 0.000001))), 0.0, 1.0);
    float behind = metal::clamp(0.5 + ((0.5 * (x - mean1)) / off), 0.0, 1.0);
    float front4 = others * metal::clamp(near_share + (behind * ((1.0 - far_share) - near_share)), 0.0, 1.0);
    float _e299 = front;
    front = (n == 4.0) ? front4 : _e299;
    float _e303 = front;
    front = (n == 3.0) ? front3 : _e303;
    float _e307 = front;
    front = (v_1 == farthest) ? others : _e307;
    float _e310 = front;
    front = (others > (0.000001 * b0)) ? _e310 : 0.0;
    float _e316 = front;
    front = (v_1 == nearest) ? 0.0 : _e316;
    float _e320 = front;
    float _e325 = front;
    float known = (_e325 >= 0.0) ? metal::min(metal::exp(-(_e320)), 1.0) : -1.0;
    float count = (metal::log(n) * 0.48089835) - 1.0;
    float most1 = metal::max(1.0 - (mean1 * mean1), 0.000001);
    float spread_part = mean_part + spread0;
    float offset = (mean1 * mean_part) - expected3;
    float square0 = spread0 * spread0;
    float expected4 = metal::clamp((((0.94 + (-3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * spread0, 0.0, spread_part);
    float deviation4 = (0.12 + (1.4 * per_n)) * (spread0 + 0.02);
    float trust4 = (deviation4 * deviation4) * most1;
    float bounded4 = metal::min((noise3 * further) * per_mass1, 1000000000000000.0);
    float doubt4 = bounded4 * bounded4;
    float _e373 = m2;
    float _e374 = m4;
    float raw_square1 = metal::clamp(((_e373 - _e374) * per_mass1) - (mean1 * mean1), 0.0, most1);
    float square1 = (((raw_square1 * trust4) * spread_part) + (expected4 * doubt4)) / (spread_part * ((trust4 * most1) + doubt4));
    float spread1 = metal::sqrt(square1);
    return type_2 {{x, count, metal::log(others + 0.05), mean0, spread0, mean1, spread1, known}};
}

float nmt_share(
    type_7 f
) {
    metal::float4 h0_0 = metal::float4(f.inner[0], f.inner[1], f.inner[2], f.inner[3]);
    metal::float4 h0_1 = metal::float4(f.inner[4], f.inner[5], f.inner[6], 1.0);
    metal::float4 h1_0 = metal::max((metal::float4x4(metal::float4(0.5572419, 0.8873689, 0.025650654, -2.3207302), metal::float4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), metal::float4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), metal::float4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)) * h0_0) + (metal::float4x4(metal::float4(2.9037392, 4.164609, 1.6416957, -1.0860678), metal::float4(3.182191, -1.0674255, -0.9432166, 2.8805542), metal::float4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), metal::float4(2.1899598, -1.1524864, 2.8668165, 0.26594585)) * h0_1), metal::float4(0.0));
    metal::float4 h1_1_ = metal::max((metal::float4x4(metal::float4(-5.0277195, 3.556171, -4.748659, -3.4211285), metal::float4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), metal::float4(0.11110483, -0.09587958, 0.028702937, 0.08554635), metal::float4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)) * h0_0) + (metal::float4x4(metal::float4(0.8829105, 1.4194763, -0.053129755, -4.384808), metal::float4(5.9241633, 0.9597082, 4.626354, -0.6152009), metal::float4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), metal::float4(-1.2974775, 2.533871, 0.26404834, 1.322599)) * h0_1), metal::float4(0.0));
    metal::float4 h1_2_ = metal::max((metal::float4x4(metal::float4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), metal::float4(0.48690128, 0.11834759, 0.17926306, -0.20529807), metal::float4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), metal::float4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)) * h0_0) + (metal::float4x4(metal::float4(-0.42825016, -0.66429555, -6.518144, -0.7735734), metal::float4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), metal::float4(2.9222262, 1.6352106, 6.105769, -1.6681633), metal::float4(-2.4759755, -2.758409, -1.277408, 3.7719758)) * h0_1), metal::float4(0.0));
    metal::float4 h1_3 = metal::max((metal::float4x4(metal::float4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), metal::float4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), metal::float4(0.10049601, 0.0337685, -0.1098763, 0.017653327), metal::float4(1.6598035, -5.834993, -5.4151325, -0.41488847)) * h0_0) + (metal::float4x4(metal::float4(-1.4044262, -5.671788, 1.827299, 0.9802938), metal::float4(0.16522916, 2.2399037, -0.2985399, 0.34238428), metal::float4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), metal::float4(2.0557249, 1.7273939, -0.45318872, -4.756142)) * h0_1), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((metal::float4(-1.4392625, -3.6934829, -1.2812184, 3.0139205) + (metal::float4x4(metal::float4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), metal::float4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), metal::float4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), metal::float4(0.7370069, 0.3038649, 0.3395028, 0.80514723)) * h1_0)) + (metal::float4x4(metal::float4(-3.49791, -0.6550794, 0.46273717, -1.0264783), metal::float4(-0.39480978, 0.22474408, 1.956778, -0.082365066), metal::float4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), metal::float4(3.1965384, -1.0385951, -2.110678, 0.43452936)) * h1_1_)) + (metal::float4x4(metal::float4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), metal::float4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), metal::float4(4.966727, -0.31968412, 0.58516496, 0.77836883), metal::float4(1.5743009, -0.9283775, -0.74404365, 0.6748018)) * h1_2_)) + (metal::float4x4(metal::float4(2.7018049, 2.1556873, 0.6269551, 1.3626245), metal::float4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), metal::float4(-3.531625, 0.04492224, 2.324661, 1.9930973), metal::float4(-25.788624, 2.5182197, -1.4758978, 3.1982157)) * h1_3), metal::float4(0.0));
    metal::float4 h2_1_ = metal::max((((metal::float4(4.0596824, -2.0969372, 1.9294189, -1.1730818) + (metal::float4x4(metal::float4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), metal::float4(-1.1366525, -1.5580677, 0.22625221, -2.727241), metal::float4(1.318036, -0.8864321, -0.44220364, 0.3394501), metal::float4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)) * h1_0)) + (metal::float4x4(metal::float4(0.79437137, -1.5935353, -2.7841825, 1.2082449), metal::float4(1.3773485, -0.25885287, -2.0684526, -3.7339642), metal::float4(-0.3631151, -21.331264, 0.13827866, 0.43595257), metal::float4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)) * h1_1_)) + (metal::float4x4(metal::float4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), metal::float4(-0.16068031, 1.6363701, 3.9007616, 4.429163), metal::float4(-6.5963273, 4.705528, 2.5016162, 3.4034655), metal::float4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)) * h1_2_)) + (metal::float4x4(metal::float4(0.659403, 2.378958, 0.81767404, -0.9107636), metal::float4(2.0063715, 0.6180353, 5.9041595, 0.08523572), metal::float4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), metal::float4(-5.688983, 4.35494, -39.64846, 12.921714)) * h1_3), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.21454798, 0.23790133, 0.21061999, -0.41597816), h2_0)) + metal::dot(metal::float4(-0.20229746, 0.22367835, 0.15568821, -0.21407762), h2_1_);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    type_7 f_1
) {
    float absorbance_5 = metal::max(metal::exp(metal::min(f_1.inner[2], 40.0)) - 0.05, 0.0);
    float _e9 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_5 * _e9, 80.0)));
}

float nmt_fragment_transmittance(
    float v_2,
    float z_2,
    float absorbance_2,
    float nearest_1,
    float farthest_1,
    float z_nearest_1,
    float z_farthest_1,
    float n_1,
    float b0_1,
    type_1 b_2
) {
    float front_1 = 0.0;
    float m1_1 = {};
    float m2_1 = {};
    float m3_1 = {};
    float m4_1 = {};
    float others_1 = metal::clamp(b0_1 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    if (v_2 != nearest_1) {
        if (others_1 > (0.000001 * b0_1)) {
            front_1 = others_1;
            if (v_2 != farthest_1) {
                float c_1 = 0.5 * (z_nearest_1 + z_farthest_1);
                float h1_1 = 1.0 / metal::max(0.5 * (z_farthest_1 - z_nearest_1), 0.00000001);
                float own1_2 = absorbance_2 * z_2;
                float own2_2 = own1_2 * z_2;
                float own3_2 = own2_2 * z_2;
                float own4_2 = own3_2 * z_2;
                float per_b0_1 = 1.0 / metal::max(others_1, 0.000000000000000000000000000001);
                m1_1 = (b_2.inner[0] - own1_2) * per_b0_1;
                m2_1 = (b_2.inner[1] - own2_2) * per_b0_1;
                m3_1 = (b_2.inner[2] - own3_2) * per_b0_1;
                m4_1 = (b_2.inner[3] - own4_2) * per_b0_1;
                float _e55 = m4_1;
                float _e56 = m3_1;
                m4_1 = _e55 - (c_1 * _e56);
                float _e59 = m3_1;
                float _e60 = m2_1;
                m3_1 = _e59 - (c_1 * _e60);
                float _e63 = m2_1;
                float _e64 = m1_1;
                m2_1 = _e63 - (c_1 * _e64);
                float _e67 = m1_1;
                m1_1 = _e67 - c_1;
                float _e69 = m4_1;
                float _e70 = m3_1;
                m4_1 = _e69 - (c_1 * _e70);
                float _e73 = m3_1;
                float _e74 = m2_1;
                m3_1 = _e73 - (c_1 * _e74);
                float _e77 = m2_1;
                float _e78 = m1_1;
                m2_1 = _e77 - (c_1 * _e78);
                float _e81 = m4_1;
                float _e82 = m3_1;
                m4_1 = _e81 - (c_1 * _e82);
                float _e85 = m3_1;
                float _e86 = m2_1;
                m3_1 = _e85 - (c_1 * _e86);
                float _e89 = m4_1;
                float _e90 = m3_1;
                m4_1 = _e89 - (c_1 * _e90);
                float h2_1 = h1_1 * h1_1;
                float h3_1 = h2_1 * h1_1;
                float h4_1 = h2_1 * h2_1;
                float _e96 = m1_1;
                m1_1 = metal::clamp(_e96 * h1_1, -1.0, 1.0);
                float _e101 = m2_1;
                m2_1 = metal::clamp(_e101 * h2_1, -1.0, 1.0);
                float _e106 = m3_1;
                m3_1 = metal::clamp(_e106 * h3_1, -1.0, 1.0);
                float _e111 = m4_1;
                m4_1 = metal::clamp(_e111 * h4_1, -1.0, 1.0);
                float along_1 = (z_2 - c_1) * h1_1;
                float range_3 = farthest_1 - nearest_1;
                float ratio_1 = range_3 / nearest_1;
                float t_1 = (v_2 - nearest_1) / metal::max(range_3, 0.000000000000000000000000000001);
                float x_1 = metal::clamp((ratio_1 < 0.01) ? (((2.0 * t_1) * (1.0 + ((0.5 * ratio_1) * (1.0 - t_1)))) - 1.0) : along_1, -1.0, 1.0);
                float reach_1 = 1.0 + ((2.0 * metal::abs(c_1)) * h1_1);
                float e1_1 = ((NMT_ROUNDING * reach_1) * b0_1) * per_b0_1;
                float per_n_1 = 1.0 / n_1;
                float noise1_1 = e1_1 * (0.12 * metal::sqrt(n_1));
                float deviation1_1 = 0.22 + (0.7 * per_n_1);
                float trust1_1 = deviation1_1 * deviation1_1;
                float _e163 = m1_1;
                float mean0_1 = _e163 * (trust1_1 / (trust1_1 + (noise1_1 * noise1_1)));
                float front3_1 = others_1 * metal::clamp(0.5 - (0.5 * mean0_1), 0.0, 1.0);
                front_1 = front3_1;
                if (n_1 != 3.0) {
                    float further_1 = reach_1 * 0.87;
                    float noise2_1 = metal::min(noise1_1 * further_1, 1000000000000000.0);
                    float noise3_1 = (noise1_1 * further_1) * further_1;
                    float most0_1 = metal::max(1.0 - (mean0_1 * mean0_1), 0.000001);
                    float deviation2_1 = 0.12 + (0.5 * per_n_1);
                    float trust2_1 = (deviation2_1 * deviation2_1) * most0_1;
                    float doubt2_1 = noise2_1 * noise2_1;
                    float _e197 = m2_1;
                    float spread0_1 = ((metal::clamp(_e197 - (mean0_1 * mean0_1), 0.0, most0_1) * trust2_1) + ((0.3 + (1.8 * per_n_1)) * doubt2_1)) / ((most0_1 * trust2_1) + doubt2_1);
                    float _e212 = m2_1;
                    float per_mass1_1 = 1.0 / metal::max(1.0 - _e212, 0.000001);
                    float mean_part_1 = 1.0 + spread0_1;
                    float deviation3_1 = (0.17 + (3.1 * per_n_1)) * (spread0_1 + 0.02);
                    float trust3_1 = deviation3_1 * deviation3_1;
                    float bounded3_1 = metal::min(noise3_1 * per_mass1_1, 1000000000000000.0);
                    float doubt3_1 = bounded3_1 * bounded3_1;
                    float expected3_1 = mean0_1 * (1.0 - spread0_1);
                    float _e236 = m1_1;
                    float _e237 = m3_1;
                    float raw_mean1_1 = metal::clamp((_e236 - _e237) * per_mass1_1, -1.0, 1.0);
                    float mean1_1 = (((raw_mean1_1 * mean_part_1) * trust3_1) + (expected3_1 * doubt3_1)) / (mean_part_1 * (trust3_1 + doubt3_1));
                    float noise_1 = bounded3_1 + (0.0000009536743 * per_mass1_1);
                    float off_1 = (noise_1 * deviation3_1) / (noise_1 + deviation3_1);
                    float inner_1 = (1.0 - spread0_1) * (1.0 - (mean0_1 * mean0_1));
                    float near_share_1 = metal::clamp(0.5 * ((1.0 - mean0_1) - (inner_1 / metal::max(1.0 + mean1_1, 0.000001))), 0.0, 1.0);
                    float far_share_1 = metal::clamp(0.5 * ((1.0 + mean0_1) - (inner_1 / metal::max(1.0 - mean1_1, 0.000001))), 0.0, 1.0);
                    float behind_1 = metal::clamp(0.5 + ((0.5 * (x_1 - mean1_1)) / off_1), 0.0, 1.0);
                    float front4_1 = others_1 * metal::clamp(near_share_1 + (behind_1 * ((1.0 - far_share_1) - near_share_1)), 0.0, 1.0);
                    front_1 = front4_1;
                    if (n_1 != 4.0) {
                        float count_1 = (metal::log(n_1) * 0.48089835) - 1.0;
                        float most1_1 = metal::max(1.0 - (mean1_1 * mean1_1), 0.000001);
                        float spread_part_1 = mean_part_1 + spread0_1;
                        float offset_1 = (mean1_1 * mean_part_1) - expected3_1;
                        float square0_1 = spread0_1 * spread0_1;
                        float expected4_1 = metal::clamp((((0.94 + (-3.8 * per_n_1)) + ((4.0 * square0_1) * square0_1)) - ((1.2 * offset_1) * offset_1)) * spread0_1, 0.0, spread_part_1);
                        float deviation4_1 = (0.12 + (1.4 * per_n_1)) * (spread0_1 + 0.02);
                        float trust4_1 = (deviation4_1 * deviation4_1) * most1_1;
                        float bounded4_1 = metal::min((noise3_1 * further_1) * per_mass1_1, 1000000000000000.0);
                        float doubt4_1 = bounded4_1 * bounded4_1;
                        float _e351 = m2_1;
                        float _e352 = m4_1;
                        float raw_square1_1 = metal::clamp(((_e351 - _e352) * per_mass1_1) - (mean1_1 * mean1_1), 0.0, most1_1);
                        float square1_1 = (((raw_square1_1 * trust4_1) * spread_part_1) + (expected4_1 * doubt4_1)) / (spread_part_1 * ((trust4_1 * most1_1) + doubt4_1));
                        float spread1_1 = metal::sqrt(square1_1);
                        float _e372 = nmt_share(type_7 {{x_1, count_1, metal::log(others_1 + 0.05), mean0_1, spread0_1, mean1_1, spread1_1}});
                        front_1 = others_1 * _e372;
                    }
                }
            }
        }
    }
    float _e374 = front_1;
    return metal::min(metal::exp(-(_e374)), 1.0);
}

float nmt_first_hidden_depth(
    float b0_2,
    float b1,
    float b2
) {
    float excess = b0_2 - 5.0;
    float deviation = metal::sqrt((5.0 * metal::max((b2 * b0_2) - (b1 * b1), 0.0)) / metal::max(excess, 0.000001));
    return (excess > 0.0) ? ((b1 + deviation) / metal::max(b0_2, 0.000000000000000000000000000001)) : 300000000000000000000000000000000000000.0;
}

float nmt_hidden_weight(
    float z_3,
    float absorbance_3,
    float z_nearest_2,
    float z_farthest_2,
    float n_2,
    float b0_3,
    type_1 b_3
) {
    float m1_2 = {};
    float m2_2 = {};
    float m3_2 = {};
    float m4_2 = {};
    float others_2 = metal::clamp(b0_3 - absorbance_3, 0.0, 1000000000000000000000000000000.0);
    float c_2 = 0.5 * (z_nearest_2 + z_farthest_2);
    float h1_2 = 1.0 / metal::max(0.5 * (z_farthest_2 - z_nearest_2), 0.00000001);
    float own1_3 = absorbance_3 * z_3;
    float own2_3 = own1_3 * z_3;
    float own3_3 = own2_3 * z_3;
    float own4_3 = own3_3 * z_3;
    float per_b0_2 = 1.0 / metal::max(others_2, 0.000000000000000000000000000001);
    m1_2 = (b_3.inner[0] - own1_3) * per_b0_2;
    m2_2 = (b_3.inner[1] - own2_3) * per_b0_2;
    m3_2 = (b_3.inner[2] - own3_3) * per_b0_2;
    m4_2 = (b_3.inner[3] - own4_3) * per_b0_2;
    float _e45 = m4_2;
    float _e46 = m3_2;
    m4_2 = _e45 - (c_2 * _e46);
    float _e49 = m3_2;
    float _e50 = m2_2;
    m3_2 = _e49 - (c_2 * _e50);
    float _e53 = m2_2;
    float _e54 = m1_2;
    m2_2 = _e53 - (c_2 * _e54);
    float _e57 = m1_2;
    m1_2 = _e57 - c_2;
    float _e59 = m4_2;
    float _e60 = m3_2;
    m4_2 = _e59 - (c_2 * _e60);
    float _e63 = m3_2;
    float _e64 = m2_2;
    m3_2 = _e63 - (c_2 * _e64);
    float _e67 = m2_2;
    float _e68 = m1_2;
    m2_2 = _e67 - (c_2 * _e68);
    float _e71 = m4_2;
    float _e72 = m3_2;
    m4_2 = _e71 - (c_2 * _e72);
    float _e75 = m3_2;
    float _e76 = m2_2;
    m3_2 = _e75 - (c_2 * _e76);
    float _e79 = m4_2;
    float _e80 = m3_2;
    m4_2 = _e79 - (c_2 * _e80);
    float h2_2 = h1_2 * h1_2;
    float h3_2 = h2_2 * h1_2;
    float h4_2 = h2_2 * h2_2;
    float _e86 = m1_2;
    m1_2 = metal::clamp(_e86 * h1_2, -1.0, 1.0);
    float _e91 = m2_2;
    m2_2 = metal::clamp(_e91 * h2_2, -1.0, 1.0);
    float _e96 = m3_2;
    m3_2 = metal::clamp(_e96 * h3_2, -1.0, 1.0);
    float _e101 = m4_2;
    m4_2 = metal::clamp(_e101 * h4_2, -1.0, 1.0);
    float reach_2 = 1.0 + ((2.0 * metal::abs(c_2)) * h1_2);
    float unsure = (((n_2 + 16.0) * NMT_ROUNDING) * b0_3) * per_b0_2;
    float off_2 = 0.000002 * h1_2;
    float end = 1.0 + off_2;
    float x_2 = metal::clamp((z_3 - c_2) * h1_2, -1.0, 1.0) - off_2;
    float _e128 = m1_2;
    float ahead = x_2 - _e128;
    float _e130 = m1_2;
    float _e131 = m2_2;
    float _e132 = m1_2;
    float _e133 = m1_2;
    float r1 = metal::max(_e130 - (metal::max(_e131 - (_e132 * _e133), 0.0) / metal::max(ahead, 0.000000000000000000000000000001)), -1000000.0);
    float gap1 = x_2 - r1;
    float reach1 = reach_2 + metal::abs(r1);
    float _e147 = m2_2;
    float _e150 = m1_2;
    float share1 = (((_e147 - ((2.0 * r1) * _e150)) + (r1 * r1)) + ((unsure * reach1) * reach1)) / metal::max(gap1 * gap1, 0.000000000000000000000000000001);
    float _e162 = m1_2;
    float _e163 = m3_2;
    float w1 = _e162 - _e163;
    float _e165 = m2_2;
    float below = w1 - (x_2 * (1.0 - _e165));
    float _e170 = m2_2;
    float _e171 = m4_2;
    float inner_2 = ((_e170 - _e171) - (x_2 * w1)) / ((metal::abs(below) < 0.000000000000000000000000000001) ? 0.000000000000000000000000000001 : below);
    float inside = (inner_2 >= -(end)) ? inner_2 : 300000000000000000000000000000000000000.0;
    float r = (inside < x_2) ? inside : metal::max(r1, -1.0);
    float gap = x_2 - r;
    float per_value = 1.0 / metal::max(((end + x_2) * gap) * gap, 0.000000000000000000000000000001);
    float gamma = (0.99999 * (1.0 - (1.0 / ((((2.0 * end) * (end - r)) * (end - r)) * per_value)))) / (end - x_2);
    float lift = 1.0 + (gamma * x_2);
    float p0 = (end * r) * r;
    float p1 = (r * r) - ((2.0 * r) * end);
    float p2 = end - (2.0 * r);
    float _e229 = m1_2;
    float _e235 = m2_2;
    float _e240 = m3_2;
    float _e243 = m4_2;
    float value = ((((p0 * lift) + (((p1 * lift) - (gamma * p0)) * _e229)) + (((p2 * lift) - (gamma * p1)) * _e235)) + ((lift - (gamma * p2)) * _e240)) - (gamma * _e243);
    float reach2 = reach_2 + metal::abs(r);
    float lost = (((unsure * (end + reach_2)) * reach2) * reach2) * (1.0 + (gamma * (metal::abs(x_2) + reach_2)));
    float share2 = (value + lost) * per_value;
    float share = 1.00001 * metal::min(share1, share2);
    float below_1 = (share < 1.0) ? metal::max(share, 0.0) : 1.0;
    float behind_2 = (ahead > 0.0) ? below_1 : 1.0;
    float least_depth = ((others_2 * (1.0 - behind_2)) - (((n_2 + 4.0) * NMT_ROUNDING) * b0_3)) - 0.00001;
    return metal::exp(-(least_depth)) * metal::min((others_2 * behind_2) + absorbance_3, n_2 - 2.0);
}

float nmt_visible_transmittance(
    float v_3,
    float z_4,
    float absorbance_4,
    float nearest_2,
    float farthest_2,
    float z_nearest_3,
    float z_farthest_3,
    float n_3,
    float b0_4,
    type_1 b_4
) {
    float front_2 = -1.0;
    float answer = {};
    float others_3 = metal::clamp(b0_4 - absorbance_4, 0.0, 1000000000000000000000000000000.0);
    if (n_3 > 4.0) {
        if (v_3 != nearest_2) {
            if (v_3 != farthest_2) {
                if (others_3 > (0.000001 * b0_4)) {
                    if (b0_4 <= NMT_FAINT) {
                        front_2 = 0.5 * others_3;
                    }
                    if (true) {
                        float _e30 = nmt_first_hidden_depth(b0_4, b_4.inner[0], b_4.inner[1]);
                        if (z_4 >= _e30) {
                            float _e32 = nmt_hidden_weight(z_4, absorbance_4, z_nearest_3, z_farthest_3, n_3, b0_4, b_4);
                            if (_e32 <= NMT_HIDDEN) {
                                front_2 = others_3;
                            }
                        }
                    }
                }
            }
        }
    }
    float _e35 = front_2;
    answer = metal::min(metal::exp(-(_e35)), 1.0);
    float _e41 = front_2;
    if (_e41 < 0.0) {
        float _e44 = nmt_fragment_transmittance(v_3, z_4, absorbance_4, nearest_2, farthest_2, z_nearest_3, z_farthest_3, n_3, b0_4, b_4);
        answer = _e44;
    }
    float _e45 = answer;
    return _e45;
}

NmtSums nmt_pass1(
    float v_4,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_4, v0_1, v1_1);
    type_1 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6.inner[0], _e6.inner[1], _e6.inner[2]), metal::float4(_e6.inner[3], 1.0, 0.0, 0.0), metal::float4(-(v_4), v_4, 0.0, 0.0)};
}

float nmt_pass2(
    float v_5,
    float v0_2,
    float v1_2,
    float alpha_2,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_3 = -(range.x);
    float farthest_3 = range.y;
    float _e10 = nmt_moment_depth(v_5, v0_2, v1_2);
    float _e11 = nmt_absorbance(alpha_2);
    float _e12 = nmt_moment_depth(nearest_3, v0_2, v1_2);
    float _e13 = nmt_moment_depth(farthest_3, v0_2, v1_2);
    float _e21 = nmt_fragment_transmittance(v_5, _e10, _e11, nearest_3, farthest_3, _e12, _e13, sums1.y, sums0.x, type_1 {{sums0.y, sums0.z, sums0.w, sums1.x}});
    return _e21;
}

float nmt_visible_pass2(
    float v_6,
    float v0_3,
    float v1_3,
    float alpha_3,
    metal::float4 sums0_1,
    metal::float4 sums1_1,
    metal::float4 range_1
) {
    float nearest_4 = -(range_1.x);
    float farthest_4 = range_1.y;
    float _e10 = nmt_moment_depth(v_6, v0_3, v1_3);
    float _e11 = nmt_absorbance(alpha_3);
    float _e12 = nmt_moment_depth(nearest_4, v0_3, v1_3);
    float _e13 = nmt_moment_depth(farthest_4, v0_3, v1_3);
    float _e21 = nmt_visible_transmittance(v_6, _e10, _e11, nearest_4, farthest_4, _e12, _e13, sums1_1.y, sums0_1.x, type_1 {{sums0_1.y, sums0_1.z, sums0_1.w, sums1_1.x}});
    return _e21;
}

metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0_2
) {
    float behind_3 = metal::exp(-(sums0_2.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind_3) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.xyz, behind_3);
}

#endif
