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
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

#ifndef NMT_INCLUDED_SMALL
#define NMT_INCLUDED_SMALL

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType4 {
    metal::float4x4 inner[8];
};
struct NmtType5 {
    metal::float4 inner[2];
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant NmtType4 NMT_W1 = NmtType4 {{metal::float4x4(metal::float4(0.5572419, 0.8873689, 0.025650654, -2.3207302), metal::float4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), metal::float4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), metal::float4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)), metal::float4x4(metal::float4(2.9037392, 4.164609, 1.6416957, -1.0860678), metal::float4(3.182191, -1.0674255, -0.9432166, 2.8805542), metal::float4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), metal::float4(2.1899598, -1.1524864, 2.8668165, 0.26594585)), metal::float4x4(metal::float4(-5.0277195, 3.556171, -4.748659, -3.4211285), metal::float4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), metal::float4(0.11110483, -0.09587958, 0.028702937, 0.08554635), metal::float4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)), metal::float4x4(metal::float4(0.8829105, 1.4194763, -0.053129755, -4.384808), metal::float4(5.9241633, 0.9597082, 4.626354, -0.6152009), metal::float4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), metal::float4(-1.2974775, 2.533871, 0.26404834, 1.322599)), metal::float4x4(metal::float4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), metal::float4(0.48690128, 0.11834759, 0.17926306, -0.20529807), metal::float4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), metal::float4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)), metal::float4x4(metal::float4(-0.42825016, -0.66429555, -6.518144, -0.7735734), metal::float4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), metal::float4(2.9222262, 1.6352106, 6.105769, -1.6681633), metal::float4(-2.4759755, -2.758409, -1.277408, 3.7719758)), metal::float4x4(metal::float4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), metal::float4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), metal::float4(0.10049601, 0.0337685, -0.1098763, 0.017653327), metal::float4(1.6598035, -5.834993, -5.4151325, -0.41488847)), metal::float4x4(metal::float4(-1.4044262, -5.671788, 1.827299, 0.9802938), metal::float4(0.16522916, 2.2399037, -0.2985399, 0.34238428), metal::float4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), metal::float4(2.0557249, 1.7273939, -0.45318872, -4.756142))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), metal::float4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), metal::float4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), metal::float4(0.7370069, 0.3038649, 0.3395028, 0.80514723)), metal::float4x4(metal::float4(-3.49791, -0.6550794, 0.46273717, -1.0264783), metal::float4(-0.39480978, 0.22474408, 1.956778, -0.082365066), metal::float4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), metal::float4(3.1965384, -1.0385951, -2.110678, 0.43452936)), metal::float4x4(metal::float4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), metal::float4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), metal::float4(4.966727, -0.31968412, 0.58516496, 0.77836883), metal::float4(1.5743009, -0.9283775, -0.74404365, 0.6748018)), metal::float4x4(metal::float4(2.7018049, 2.1556873, 0.6269551, 1.3626245), metal::float4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), metal::float4(-3.531625, 0.04492224, 2.324661, 1.9930973), metal::float4(-25.788624, 2.5182197, -1.4758978, 3.1982157)), metal::float4x4(metal::float4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), metal::float4(-1.1366525, -1.5580677, 0.22625221, -2.727241), metal::float4(1.318036, -0.8864321, -0.44220364, 0.3394501), metal::float4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)), metal::float4x4(metal::float4(0.79437137, -1.5935353, -2.7841825, 1.2082449), metal::float4(1.3773485, -0.25885287, -2.0684526, -3.7339642), metal::float4(-0.3631151, -21.331264, 0.13827866, 0.43595257), metal::float4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)), metal::float4x4(metal::float4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), metal::float4(-0.16068031, 1.6363701, 3.9007616, 4.429163), metal::float4(-6.5963273, 4.705528, 2.5016162, 3.4034655), metal::float4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)), metal::float4x4(metal::float4(0.659403, 2.378958, 0.81767404, -0.9107636), metal::float4(2.0063715, 0.6180353, 5.9041595, 0.08523572), metal::float4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), metal::float4(-5.688983, 4.35494, -39.64846, 12.921714))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(-1.4392625, -3.6934829, -1.2812184, 3.0139205), metal::float4(4.0596824, -2.0969372, 1.9294189, -1.1730818)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.21454798, 0.23790133, 0.21061999, -0.41597816), metal::float4(-0.20229746, 0.22367835, 0.15568821, -0.21407762)}};
constant float NMT_B3 = -0.09972816;
constant float NMT_FAINT = 0.0625;
constant float NMT_HIDDEN = 0.00095;

float nmt_absorbance(
    float alpha
) {
    float faint = alpha * (1.0 + (alpha * (0.5 + (alpha * (0.33333334 + (alpha * (0.25 + (alpha * 0.2))))))));
    return (0.03 > alpha) ? faint : -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

float nmt_log_ratio(
    float a,
    float b
) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (0.2 > metal::abs(s)) ? ((s + s) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + (q * 0.11111111))))))))) : metal::log(a / b);
}

float nmt_moment_depth(
    float v,
    float v0,
    float v1
) {
    float _e3 = nmt_log_ratio(v, v0);
    float _e6 = nmt_log_ratio(v1, v0);
    return (v1 > v0) ? metal::clamp(((2.0 * _e3) / metal::max(_e6, 0.000000000000000000000000000001)) - 1.0, -1.0, 1.0) : 0.0;
}

metal::float4 nmt_moments(
    float z,
    float absorbance
) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return metal::float4(moment1, moment2, moment3, moment4);
}

metal::float4 nmt_recentred_moments(
    float z_1,
    float absorbance_1,
    float c,
    float per_h,
    float per_b0,
    metal::float4 b_1
) {
    metal::float4 _e6 = nmt_moments(z_1, absorbance_1);
    float m1 = (b_1.x - _e6.x) * per_b0;
    float m2 = (b_1.y - _e6.y) * per_b0;
    float m3 = (b_1.z - _e6.z) * per_b0;
    float m4 = (b_1.w - _e6.w) * per_b0;
    float m4_2 = m4 - (c * m3);
    float m3_2 = m3 - (c * m2);
    float m2_2 = m2 - (c * m1);
    float m1_2 = m1 - c;
    float m4_3 = m4_2 - (c * m3_2);
    float m3_3 = m3_2 - (c * m2_2);
    float m2_3 = m2_2 - (c * m1_2);
    float m4_4 = m4_3 - (c * m3_3);
    float m3_4 = m3_3 - (c * m2_3);
    float m4_5 = m4_4 - (c * m3_4);
    float per_h2 = per_h * per_h;
    float per_h3 = per_h2 * per_h;
    float per_h4 = per_h2 * per_h2;
    return metal::float4(metal::clamp(m1_2 * per_h, -1.0, 1.0), metal::clamp(m2_3 * per_h2, -1.0, 1.0), metal::clamp(m3_4 * per_h3, -1.0, 1.0), metal::clamp(m4_5 * per_h4, -1.0, 1.0));
}

float nmt_shrink_to_prior(
    float value,
    float expected,
    float noise,
    float deviation
) {
    float bounded = metal::min(noise, 1000000000000000.0);
    float trust = deviation * deviation;
    return expected + ((value - expected) * (trust / (trust + (bounded * bounded))));
}

float nmt_place_in_thin(
    float v_1,
    float nearest,
    float farthest
) {
    float range_2 = farthest - nearest;
    float t = (v_1 - nearest) / metal::max(range_2, 0.000000000000000000000000000001);
    float x_1 = t * (1.0 + ((0.5 * (range_2 / nearest)) * (1.0 - t)));
    return metal::clamp((x_1 + x_1) - 1.0, -1.0, 1.0);
}

float nmt_share_of_four(
    float x,
    float mean,
    float spread,
    float u,
    float transition_width
) {
    float inner = (1.0 - spread) * (1.0 - (mean * mean));
    float near_end = metal::clamp(0.5 * ((1.0 - mean) - (inner / metal::max(1.0 + u, 0.000001))), 0.0, 1.0);
    float far_end = metal::clamp(0.5 * ((1.0 + mean) - (inner / metal::max(1.0 - u, 0.000001))), 0.0, 1.0);
    float behind = metal::clamp(0.5 + ((0.5 * (x - u)) / transition_width), 0.0, 1.0);
    return metal::clamp(near_end + (behind * ((1.0 - far_end) - near_end)), 0.0, 1.0);
}

metal::float2x4 nmt_recentred(
    float v_2,
    float z_2,
    float absorbance_2,
    float nearest_1,
    float farthest_1,
    float z_nearest,
    float z_farthest,
    float n,
    float b0,
    metal::float4 b_2
) {
    float front = -1.0;
    float c_1 = 0.5 * (z_nearest + z_farthest);
    float others = metal::clamp(b0 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    float per_b0_1 = 1.0 / metal::max(metal::max(others, b0 * 0.000001), 0.000000000000000000000000000001);
    float per_h_1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
    metal::float4 _e31 = nmt_recentred_moments(z_2, absorbance_2, c_1, per_h_1, per_b0_1, b_2);
    float noise_growth = 1.0 + ((2.0 * metal::abs(c_1)) * per_h_1);
    float moment_noise = ((NMT_ROUNDING * noise_growth) * b0) * per_b0_1;
    float noise1 = moment_noise * (0.12 * metal::sqrt(n));
    float per_n = 1.0 / n;
    float _e54 = nmt_shrink_to_prior(_e31.x, 0.0, noise1, 0.22 + (0.7 * per_n));
    float _e60 = nmt_place_in_thin(v_2, nearest_1, farthest_1);
    float x_2 = (0.01 > ((farthest_1 - nearest_1) / nearest_1)) ? _e60 : metal::clamp((z_2 - c_1) * per_h_1, -1.0, 1.0);
    float further = noise_growth * 0.87;
    float noise2 = noise1 * further;
    float noise3 = noise2 * further;
    float most0 = metal::max(1.0 - (_e54 * _e54), 0.000001);
    float raw_spread0 = metal::clamp((_e31.y - (_e54 * _e54)) / most0, 0.0, 1.0);
    float _e91 = nmt_shrink_to_prior(raw_spread0, 0.3 + (1.8 * per_n), noise2 / most0, 0.12 + (0.5 * per_n));
    float per_mass1 = 1.0 / metal::max(1.0 - _e31.y, 0.000001);
    float raw_mean1 = metal::clamp((_e31.x - _e31.z) * per_mass1, -1.0, 1.0);
    float expected_mean1 = (_e54 * (1.0 - _e91)) / (1.0 + _e91);
    float deviation_1 = (0.17 + (3.1 * per_n)) * (_e91 + 0.02);
    float noise_1 = noise3 * per_mass1;
    float all_noise = noise_1 + (0.0000009536743 * per_mass1);
    float _e123 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise_1, deviation_1);
    float transition_width_1 = (all_noise * deviation_1) / (all_noise + deviation_1);
    float _e129 = front;
    float _e130 = nmt_share_of_four(x_2, _e54, _e91, _e123, transition_width_1);
    front = (n == 4.0) ? (others * _e130) : _e129;
    float _e135 = front;
    front = (n == 3.0) ? (others * metal::clamp(0.5 - (0.5 * _e54), 0.0, 1.0)) : _e135;
    float _e147 = front;
    front = (v_2 == farthest_1) ? others : _e147;
    float _e150 = front;
    front = (others > (0.000001 * b0)) ? _e150 : 0.0;
    float _e156 = front;
    front = (v_2 == nearest_1) ? 0.0 : _e156;
    float _e160 = front;
    float _e165 = front;
    float known = (_e165 >= 0.0) ? metal::min(metal::exp(-(_e160)), 1.0) : -1.0;
    float most1 = metal::max(1.0 - (_e123 * _e123), 0.000001);
    float raw_square1 = metal::clamp((((_e31.y - _e31.w) * per_mass1) - (_e123 * _e123)) / most1, 0.0, 1.0);
    float offset = (_e123 * (1.0 + _e91)) - (_e54 * (1.0 - _e91));
    float square0 = _e91 * _e91;
    float expected_square1 = metal::clamp(((((0.94 - (3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * _e91) / ((1.0 + _e91) + _e91), 0.0, 1.0);
    float _e223 = nmt_shrink_to_prior(raw_square1, expected_square1, ((noise3 * further) * per_mass1) / most1, (0.12 + (1.4 * per_n)) * (_e91 + 0.02));
    float spread1 = metal::sqrt(_e223);
    return metal::float2x4(metal::float4(x_2, (metal::log(n) * 0.48089835) - 1.0, metal::log(others + 0.05), _e54), metal::float4(_e91, _e123, spread1, known));
}

float nmt_share(
    metal::float2x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = metal::float4(f[1].xyz, 1.0);
    metal::float4 h1_0 = metal::max((metal::float4x4(metal::float4(0.5572419, 0.8873689, 0.025650654, -2.3207302), metal::float4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), metal::float4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), metal::float4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)) * h0_0) + (metal::float4x4(metal::float4(2.9037392, 4.164609, 1.6416957, -1.0860678), metal::float4(3.182191, -1.0674255, -0.9432166, 2.8805542), metal::float4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), metal::float4(2.1899598, -1.1524864, 2.8668165, 0.26594585)) * h0_1), metal::float4(0.0));
    metal::float4 h1_1 = metal::max((metal::float4x4(metal::float4(-5.0277195, 3.556171, -4.748659, -3.4211285), metal::float4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), metal::float4(0.11110483, -0.09587958, 0.028702937, 0.08554635), metal::float4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)) * h0_0) + (metal::float4x4(metal::float4(0.8829105, 1.4194763, -0.053129755, -4.384808), metal::float4(5.9241633, 0.9597082, 4.626354, -0.6152009), metal::float4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), metal::float4(-1.2974775, 2.533871, 0.26404834, 1.322599)) * h0_1), metal::float4(0.0));
    metal::float4 h1_2 = metal::max((metal::float4x4(metal::float4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), metal::float4(0.48690128, 0.11834759, 0.17926306, -0.20529807), metal::float4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), metal::float4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)) * h0_0) + (metal::float4x4(metal::float4(-0.42825016, -0.66429555, -6.518144, -0.7735734), metal::float4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), metal::float4(2.9222262, 1.6352106, 6.105769, -1.6681633), metal::float4(-2.4759755, -2.758409, -1.277408, 3.7719758)) * h0_1), metal::float4(0.0));
    metal::float4 h1_3 = metal::max((metal::float4x4(metal::float4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), metal::float4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), metal::float4(0.10049601, 0.0337685, -0.1098763, 0.017653327), metal::float4(1.6598035, -5.834993, -5.4151325, -0.41488847)) * h0_0) + (metal::float4x4(metal::float4(-1.4044262, -5.671788, 1.827299, 0.9802938), metal::float4(0.16522916, 2.2399037, -0.2985399, 0.34238428), metal::float4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), metal::float4(2.0557249, 1.7273939, -0.45318872, -4.756142)) * h0_1), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((metal::float4(-1.4392625, -3.6934829, -1.2812184, 3.0139205) + (metal::float4x4(metal::float4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), metal::float4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), metal::float4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), metal::float4(0.7370069, 0.3038649, 0.3395028, 0.80514723)) * h1_0)) + (metal::float4x4(metal::float4(-3.49791, -0.6550794, 0.46273717, -1.0264783), metal::float4(-0.39480978, 0.22474408, 1.956778, -0.082365066), metal::float4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), metal::float4(3.1965384, -1.0385951, -2.110678, 0.43452936)) * h1_1)) + (metal::float4x4(metal::float4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), metal::float4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), metal::float4(4.966727, -0.31968412, 0.58516496, 0.77836883), metal::float4(1.5743009, -0.9283775, -0.74404365, 0.6748018)) * h1_2)) + (metal::float4x4(metal::float4(2.7018049, 2.1556873, 0.6269551, 1.3626245), metal::float4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), metal::float4(-3.531625, 0.04492224, 2.324661, 1.9930973), metal::float4(-25.788624, 2.5182197, -1.4758978, 3.1982157)) * h1_3), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((metal::float4(4.0596824, -2.0969372, 1.9294189, -1.1730818) + (metal::float4x4(metal::float4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), metal::float4(-1.1366525, -1.5580677, 0.22625221, -2.727241), metal::float4(1.318036, -0.8864321, -0.44220364, 0.3394501), metal::float4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)) * h1_0)) + (metal::float4x4(metal::float4(0.79437137, -1.5935353, -2.7841825, 1.2082449), metal::float4(1.3773485, -0.25885287, -2.0684526, -3.7339642), metal::float4(-0.3631151, -21.331264, 0.13827866, 0.43595257), metal::float4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)) * h1_1)) + (metal::float4x4(metal::float4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), metal::float4(-0.16068031, 1.6363701, 3.9007616, 4.429163), metal::float4(-6.5963273, 4.705528, 2.5016162, 3.4034655), metal::float4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)) * h1_2)) + (metal::float4x4(metal::float4(0.659403, 2.378958, 0.81767404, -0.9107636), metal::float4(2.0063715, 0.6180353, 5.9041595, 0.08523572), metal::float4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), metal::float4(-5.688983, 4.35494, -39.64846, 12.921714)) * h1_3), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.21454798, 0.23790133, 0.21061999, -0.41597816), h2_0)) + metal::dot(metal::float4(-0.20229746, 0.22367835, 0.15568821, -0.21407762), h2_1);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float2x4 f_1
) {
    float absorbance_6 = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_6 * _e10, 80.0)));
}

float nmt_fragment_transmittance(
    float v_3,
    float z_3,
    float absorbance_3,
    float nearest_2,
    float farthest_2,
    float z_nearest_1,
    float z_farthest_1,
    float n_1,
    float b0_1,
    metal::float4 b_3
) {
    float front_1 = 0.0;
    float others_1 = metal::clamp(b0_1 - absorbance_3, 0.0, 1000000000000000000000000000000.0);
    if (v_3 != nearest_2) {
        if (others_1 > (0.000001 * b0_1)) {
            front_1 = others_1;
            if (v_3 != farthest_2) {
                float c_2 = 0.5 * (z_nearest_1 + z_farthest_1);
                float per_b0_2 = 1.0 / metal::max(metal::max(others_1, b0_1 * 0.000001), 0.000000000000000000000000000001);
                float per_h_2 = 1.0 / metal::max(0.5 * (z_farthest_1 - z_nearest_1), 0.00000001);
                metal::float4 _e38 = nmt_recentred_moments(z_3, absorbance_3, c_2, per_h_2, per_b0_2, b_3);
                float noise_growth_1 = 1.0 + ((2.0 * metal::abs(c_2)) * per_h_2);
                float moment_noise_1 = ((NMT_ROUNDING * noise_growth_1) * b0_1) * per_b0_2;
                float noise1_1 = moment_noise_1 * (0.12 * metal::sqrt(n_1));
                float per_n_1 = 1.0 / n_1;
                float _e61 = nmt_shrink_to_prior(_e38.x, 0.0, noise1_1, 0.22 + (0.7 * per_n_1));
                front_1 = others_1 * metal::clamp(0.5 - (0.5 * _e61), 0.0, 1.0);
                if (n_1 != 3.0) {
                    float _e77 = nmt_place_in_thin(v_3, nearest_2, farthest_2);
                    float x_3 = (0.01 > ((farthest_2 - nearest_2) / nearest_2)) ? _e77 : metal::clamp((z_3 - c_2) * per_h_2, -1.0, 1.0);
                    float further_1 = noise_growth_1 * 0.87;
                    float noise2_1 = noise1_1 * further_1;
                    float noise3_1 = noise2_1 * further_1;
                    float most0_1 = metal::max(1.0 - (_e61 * _e61), 0.000001);
                    float raw_spread0_1 = metal::clamp((_e38.y - (_e61 * _e61)) / most0_1, 0.0, 1.0);
                    float _e108 = nmt_shrink_to_prior(raw_spread0_1, 0.3 + (1.8 * per_n_1), noise2_1 / most0_1, 0.12 + (0.5 * per_n_1));
                    float per_mass1_1 = 1.0 / metal::max(1.0 - _e38.y, 0.000001);
                    float raw_mean1_1 = metal::clamp((_e38.x - _e38.z) * per_mass1_1, -1.0, 1.0);
                    float expected_mean1_1 = (_e61 * (1.0 - _e108)) / (1.0 + _e108);
                    float deviation_2 = (0.17 + (3.1 * per_n_1)) * (_e108 + 0.02);
                    float noise_2 = noise3_1 * per_mass1_1;
                    float all_noise_1 = noise_2 + (0.0000009536743 * per_mass1_1);
                    float _e140 = nmt_shrink_to_prior(raw_mean1_1, expected_mean1_1, noise_2, deviation_2);
                    float transition_width_2 = (all_noise_1 * deviation_2) / (all_noise_1 + deviation_2);
                    float _e144 = nmt_share_of_four(x_3, _e61, _e108, _e140, transition_width_2);
                    front_1 = others_1 * _e144;
                    if (n_1 != 4.0) {
                        float most1_1 = metal::max(1.0 - (_e140 * _e140), 0.000001);
                        float raw_square1_1 = metal::clamp((((_e38.y - _e38.w) * per_mass1_1) - (_e140 * _e140)) / most1_1, 0.0, 1.0);
                        float offset_1 = (_e140 * (1.0 + _e108)) - (_e61 * (1.0 - _e108));
                        float square0_1 = _e108 * _e108;
                        float expected_square1_1 = metal::clamp(((((0.94 - (3.8 * per_n_1)) + ((4.0 * square0_1) * square0_1)) - ((1.2 * offset_1) * offset_1)) * _e108) / ((1.0 + _e108) + _e108), 0.0, 1.0);
                        float _e201 = nmt_shrink_to_prior(raw_square1_1, expected_square1_1, ((noise3_1 * further_1) * per_mass1_1) / most1_1, (0.12 + (1.4 * per_n_1)) * (_e108 + 0.02));
                        float spread1_1 = metal::sqrt(_e201);
                        float _e215 = nmt_share(metal::float2x4(metal::float4(x_3, (metal::log(n_1) * 0.48089835) - 1.0, metal::log(others_1 + 0.05), _e61), metal::float4(_e108, _e140, spread1_1, 0.0)));
                        front_1 = others_1 * _e215;
                    }
                }
            }
        }
    }
    float _e217 = front_1;
    return metal::min(metal::exp(-(_e217)), 1.0);
}

float nmt_first_hidden_depth(
    float b0_2,
    float b1,
    float b2
) {
    float excess = b0_2 - 5.0;
    float deviation_3 = metal::sqrt((metal::max((b2 * b0_2) - (b1 * b1), 0.0) * 5.0) / metal::max(excess, 0.000001));
    return (excess > 0.0) ? ((b1 + deviation_3) / metal::max(b0_2, 0.000000000000000000000000000001)) : 300000000000000000000000000000000000000.0;
}

float nmt_hidden_weight(
    float z_4,
    float absorbance_4,
    float z_nearest_2,
    float z_farthest_2,
    float n_2,
    float b0_3,
    metal::float4 b_4
) {
    float c_3 = 0.5 * (z_nearest_2 + z_farthest_2);
    float others_2 = metal::clamp(b0_3 - absorbance_4, 0.0, 1000000000000000000000000000000.0);
    float per_b0_3 = 1.0 / metal::max(metal::max(others_2, b0_3 * 0.000001), 0.000000000000000000000000000001);
    float per_h_3 = 1.0 / metal::max(0.5 * (z_farthest_2 - z_nearest_2), 0.00000001);
    metal::float4 _e28 = nmt_recentred_moments(z_4, absorbance_4, c_3, per_h_3, per_b0_3, b_4);
    float noise_growth_2 = 1.0 + ((2.0 * metal::abs(c_3)) * per_h_3);
    float unsure = (((n_2 + 16.0) * NMT_ROUNDING) * b0_3) / metal::max(others_2, 0.000000000000000000000000000001);
    float off = 0.000002 * per_h_3;
    float end = 1.0 + off;
    float x_4 = metal::clamp((z_4 - c_3) * per_h_3, -1.0, 1.0) - off;
    float ahead = x_4 - _e28.x;
    float r1 = metal::max(_e28.x - (metal::max(_e28.y - (_e28.x * _e28.x), 0.0) / metal::max(ahead, 0.000000000000000000000000000001)), -1000000.0);
    float growth1 = noise_growth_2 + metal::abs(r1);
    float gap1 = x_4 - r1;
    float share1 = (((_e28.y - ((2.0 * r1) * _e28.x)) + (r1 * r1)) + (unsure * (growth1 * growth1))) / metal::max(gap1 * gap1, 0.000000000000000000000000000001);
    float w1 = _e28.x - _e28.z;
    float below = w1 - (x_4 * (1.0 - _e28.y));
    float inner_1 = ((_e28.y - _e28.w) - (x_4 * w1)) / ((0.000000000000000000000000000001 > metal::abs(below)) ? 0.000000000000000000000000000001 : below);
    float outer = metal::max(r1, -1.0);
    float inside = (inner_1 >= -(end)) ? inner_1 : outer;
    float r = (x_4 > inside) ? inside : outer;
    float gap = x_4 - r;
    float per_value = 1.0 / metal::max((end + x_4) * (gap * gap), 0.000000000000000000000000000001);
    float end_gap = end - r;
    float gamma = (0.99999 * (1.0 - (1.0 / (((2.0 * end) * (end_gap * end_gap)) * per_value)))) / (end - x_4);
    float p0 = (end * r) * r;
    float p1 = (r * r) - ((2.0 * r) * end);
    float p2 = end - (2.0 * r);
    float lift = 1.0 + (gamma * x_4);
    float value_1 = ((((p0 * lift) + (((p1 * lift) - (gamma * p0)) * _e28.x)) + (((p2 * lift) - (gamma * p1)) * _e28.y)) + ((lift - (gamma * p2)) * _e28.z)) - (gamma * _e28.w);
    float growth2 = noise_growth_2 + metal::abs(r);
    float lost = ((unsure * (end + noise_growth_2)) * (growth2 * growth2)) * (1.0 + (gamma * (metal::abs(x_4) + noise_growth_2)));
    float share2 = (value_1 + lost) * per_value;
    float share = metal::min(share1, share2) * 1.00001;
    float behind_1 = (ahead > 0.0) ? ((1.0 > share) ? metal::max(share, 0.0) : 1.0) : 1.0;
    float least_depth = (others_2 * (1.0 - behind_1)) - ((((n_2 + 4.0) * NMT_ROUNDING) * b0_3) + 0.00001);
    return metal::exp(-(least_depth)) * metal::min((others_2 * behind_1) + absorbance_4, n_2 - 2.0);
}

float nmt_visible_transmittance(
    float v_4,
    float z_5,
    float absorbance_5,
    float nearest_3,
    float farthest_3,
    float z_nearest_3,
    float z_farthest_3,
    float n_3,
    float b0_4,
    metal::float4 b_5
) {
    float front_2 = -1.0;
    float answer = {};
    float others_3 = metal::clamp(b0_4 - absorbance_5, 0.0, 1000000000000000000000000000000.0);
    if (n_3 > 4.0) {
        if (v_4 != nearest_3) {
            if (v_4 != farthest_3) {
                if (others_3 > (0.000001 * b0_4)) {
                    if (b0_4 <= NMT_FAINT) {
                        front_2 = 0.5 * others_3;
                    }
                    if (true) {
                        float _e30 = nmt_first_hidden_depth(b0_4, b_5.x, b_5.y);
                        if (z_5 >= _e30) {
                            float _e32 = nmt_hidden_weight(z_5, absorbance_5, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
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
        float _e44 = nmt_fragment_transmittance(v_4, z_5, absorbance_5, nearest_3, farthest_3, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
        answer = _e44;
    }
    float _e45 = answer;
    return _e45;
}

NmtSums nmt_pass1(
    float v_5,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_5, v0_1, v1_1);
    metal::float4 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6.xyz), metal::float4(_e6.w, 1.0, 0.0, 0.0), metal::float4(-(v_5), v_5, 0.0, 0.0)};
}

float nmt_pass2(
    float v_6,
    float v0_2,
    float v1_2,
    float alpha_2,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_4 = -(range.x);
    float _e9 = nmt_moment_depth(v_6, v0_2, v1_2);
    float _e10 = nmt_absorbance(alpha_2);
    float _e12 = nmt_moment_depth(nearest_4, v0_2, v1_2);
    float _e14 = nmt_moment_depth(range.y, v0_2, v1_2);
    float _e20 = nmt_fragment_transmittance(v_6, _e9, _e10, nearest_4, range.y, _e12, _e14, sums1.y, sums0.x, metal::float4(sums0.yzw, sums1.x));
    return _e20;
}

float nmt_visible_pass2(
    float v_7,
    float v0_3,
    float v1_3,
    float alpha_3,
    metal::float4 sums0_1,
    metal::float4 sums1_1,
    metal::float4 range_1
) {
    float nearest_5 = -(range_1.x);
    float _e9 = nmt_moment_depth(v_7, v0_3, v1_3);
    float _e10 = nmt_absorbance(alpha_3);
    float _e12 = nmt_moment_depth(nearest_5, v0_3, v1_3);
    float _e14 = nmt_moment_depth(range_1.y, v0_3, v1_3);
    float _e20 = nmt_visible_transmittance(v_7, _e9, _e10, nearest_5, range_1.y, _e12, _e14, sums1_1.y, sums0_1.x, metal::float4(sums0_1.yzw, sums1_1.x));
    return _e20;
}

metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0_2
) {
    float behind_2 = metal::exp(-(sums0_2.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind_2) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind_2);
}

#endif
