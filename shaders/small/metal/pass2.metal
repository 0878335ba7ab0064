// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType3 {
    metal::float4x4 inner[8];
};
struct NmtType4 {
    metal::float4 inner[2];
};
struct Frame {
    float v0;
    float v1;
};
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant NmtType3 NMT_W1 = NmtType3 {{metal::float4x4(metal::float4(0.5572419, 0.8873689, 0.025650654, -2.3207302), metal::float4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), metal::float4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), metal::float4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)), metal::float4x4(metal::float4(2.9037392, 4.164609, 1.6416957, -1.0860678), metal::float4(3.182191, -1.0674255, -0.9432166, 2.8805542), metal::float4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), metal::float4(2.1899598, -1.1524864, 2.8668165, 0.26594585)), metal::float4x4(metal::float4(-5.0277195, 3.556171, -4.748659, -3.4211285), metal::float4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), metal::float4(0.11110483, -0.09587958, 0.028702937, 0.08554635), metal::float4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)), metal::float4x4(metal::float4(0.8829105, 1.4194763, -0.053129755, -4.384808), metal::float4(5.9241633, 0.9597082, 4.626354, -0.6152009), metal::float4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), metal::float4(-1.2974775, 2.533871, 0.26404834, 1.322599)), metal::float4x4(metal::float4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), metal::float4(0.48690128, 0.11834759, 0.17926306, -0.20529807), metal::float4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), metal::float4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)), metal::float4x4(metal::float4(-0.42825016, -0.66429555, -6.518144, -0.7735734), metal::float4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), metal::float4(2.9222262, 1.6352106, 6.105769, -1.6681633), metal::float4(-2.4759755, -2.758409, -1.277408, 3.7719758)), metal::float4x4(metal::float4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), metal::float4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), metal::float4(0.10049601, 0.0337685, -0.1098763, 0.017653327), metal::float4(1.6598035, -5.834993, -5.4151325, -0.41488847)), metal::float4x4(metal::float4(-1.4044262, -5.671788, 1.827299, 0.9802938), metal::float4(0.16522916, 2.2399037, -0.2985399, 0.34238428), metal::float4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), metal::float4(2.0557249, 1.7273939, -0.45318872, -4.756142))}};
constant NmtType3 NMT_W2 = NmtType3 {{metal::float4x4(metal::float4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), metal::float4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), metal::float4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), metal::float4(0.7370069, 0.3038649, 0.3395028, 0.80514723)), metal::float4x4(metal::float4(-3.49791, -0.6550794, 0.46273717, -1.0264783), metal::float4(-0.39480978, 0.22474408, 1.956778, -0.082365066), metal::float4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), metal::float4(3.1965384, -1.0385951, -2.110678, 0.43452936)), metal::float4x4(metal::float4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), metal::float4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), metal::float4(4.966727, -0.31968412, 0.58516496, 0.77836883), metal::float4(1.5743009, -0.9283775, -0.74404365, 0.6748018)), metal::float4x4(metal::float4(2.7018049, 2.1556873, 0.6269551, 1.3626245), metal::float4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), metal::float4(-3.531625, 0.04492224, 2.324661, 1.9930973), metal::float4(-25.788624, 2.5182197, -1.4758978, 3.1982157)), metal::float4x4(metal::float4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), metal::float4(-1.1366525, -1.5580677, 0.22625221, -2.727241), metal::float4(1.318036, -0.8864321, -0.44220364, 0.3394501), metal::float4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)), metal::float4x4(metal::float4(0.79437137, -1.5935353, -2.7841825, 1.2082449), metal::float4(1.3773485, -0.25885287, -2.0684526, -3.7339642), metal::float4(-0.3631151, -21.331264, 0.13827866, 0.43595257), metal::float4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)), metal::float4x4(metal::float4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), metal::float4(-0.16068031, 1.6363701, 3.9007616, 4.429163), metal::float4(-6.5963273, 4.705528, 2.5016162, 3.4034655), metal::float4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)), metal::float4x4(metal::float4(0.659403, 2.378958, 0.81767404, -0.9107636), metal::float4(2.0063715, 0.6180353, 5.9041595, 0.08523572), metal::float4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), metal::float4(-5.688983, 4.35494, -39.64846, 12.921714))}};
constant NmtType4 NMT_B2 = NmtType4 {{metal::float4(-1.4392625, -3.6934829, -1.2812184, 3.0139205), metal::float4(4.0596824, -2.0969372, 1.9294189, -1.1730818)}};
constant NmtType4 NMT_W3 = NmtType4 {{metal::float4(-0.21454798, 0.23790133, 0.21061999, -0.41597816), metal::float4(-0.20229746, 0.22367835, 0.15568821, -0.21407762)}};
constant float NMT_B3 = -0.09972816;

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
    float range_1 = farthest - nearest;
    float t = (v_1 - nearest) / metal::max(range_1, 0.000000000000000000000000000001);
    float x_1 = t * (1.0 + ((0.5 * (range_1 / nearest)) * (1.0 - t)));
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

float nmt_fragment_transmittance(
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
    float front = 0.0;
    float others = metal::clamp(b0 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    if (v_2 != nearest_1) {
        if (others > (0.000001 * b0)) {
            front = others;
            if (v_2 != farthest_1) {
                float c_1 = 0.5 * (z_nearest + z_farthest);
                float per_b0_1 = 1.0 / metal::max(metal::max(others, b0 * 0.000001), 0.000000000000000000000000000001);
                float per_h_1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
                metal::float4 _e38 = nmt_recentred_moments(z_2, absorbance_2, c_1, per_h_1, per_b0_1, b_2);
                float noise_growth = 1.0 + ((2.0 * metal::abs(c_1)) * per_h_1);
                float moment_noise = ((NMT_ROUNDING * noise_growth) * b0) * per_b0_1;
                float noise1 = moment_noise * (0.12 * metal::sqrt(n));
                float per_n = 1.0 / n;
                float _e61 = nmt_shrink_to_prior(_e38.x, 0.0, noise1, 0.22 + (0.7 * per_n));
                front = others * metal::clamp(0.5 - (0.5 * _e61), 0.0, 1.0);
                if (n != 3.0) {
                    float _e77 = nmt_place_in_thin(v_2, nearest_1, farthest_1);
                    float x_2 = (0.01 > ((farthest_1 - nearest_1) / nearest_1)) ? _e77 : metal::clamp((z_2 - c_1) * per_h_1, -1.0, 1.0);
                    float further = noise_growth * 0.87;
                    float noise2 = noise1 * further;
                    float noise3 = noise2 * further;
                    float most0 = metal::max(1.0 - (_e61 * _e61), 0.000001);
                    float raw_spread0 = metal::clamp((_e38.y - (_e61 * _e61)) / most0, 0.0, 1.0);
                    float _e108 = nmt_shrink_to_prior(raw_spread0, 0.3 + (1.8 * per_n), noise2 / most0, 0.12 + (0.5 * per_n));
                    float per_mass1 = 1.0 / metal::max(1.0 - _e38.y, 0.000001);
                    float raw_mean1 = metal::clamp((_e38.x - _e38.z) * per_mass1, -1.0, 1.0);
                    float expected_mean1 = (_e61 * (1.0 - _e108)) / (1.0 + _e108);
                    float deviation_1 = (0.17 + (3.1 * per_n)) * (_e108 + 0.02);
                    float noise_1 = noise3 * per_mass1;
                    float all_noise = noise_1 + (0.0000009536743 * per_mass1);
                    float _e140 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise_1, deviation_1);
                    float transition_width_1 = (all_noise * deviation_1) / (all_noise + deviation_1);
                    float _e144 = nmt_share_of_four(x_2, _e61, _e108, _e140, transition_width_1);
                    front = others * _e144;
                    if (n != 4.0) {
                        float most1 = metal::max(1.0 - (_e140 * _e140), 0.000001);
                        float raw_square1 = metal::clamp((((_e38.y - _e38.w) * per_mass1) - (_e140 * _e140)) / most1, 0.0, 1.0);
                        float offset = (_e140 * (1.0 + _e108)) - (_e61 * (1.0 - _e108));
                        float square0 = _e108 * _e108;
                        float expected_square1 = metal::clamp(((((0.94 - (3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * _e108) / ((1.0 + _e108) + _e108), 0.0, 1.0);
                        float _e201 = nmt_shrink_to_prior(raw_square1, expected_square1, ((noise3 * further) * per_mass1) / most1, (0.12 + (1.4 * per_n)) * (_e108 + 0.02));
                        float spread1 = metal::sqrt(_e201);
                        float _e215 = nmt_share(metal::float2x4(metal::float4(x_2, (metal::log(n) * 0.48089835) - 1.0, metal::log(others + 0.05), _e61), metal::float4(_e108, _e140, spread1, 0.0)));
                        front = others * _e215;
                    }
                }
            }
        }
    }
    float _e217 = front;
    return metal::min(metal::exp(-(_e217)), 1.0);
}

float nmt_pass2(
    float v_3,
    float v0_1,
    float v1_1,
    float alpha_1,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_2 = -(range.x);
    float _e9 = nmt_moment_depth(v_3, v0_1, v1_1);
    float _e10 = nmt_absorbance(alpha_1);
    float _e12 = nmt_moment_depth(nearest_2, v0_1, v1_1);
    float _e14 = nmt_moment_depth(range.y, v0_1, v1_1);
    float _e20 = nmt_fragment_transmittance(v_3, _e9, _e10, nearest_2, range.y, _e12, _e14, sums1.y, sums0.x, metal::float4(sums0.yzw, sums1.x));
    return _e20;
}
metal::int2 naga_f2i32(metal::float2 value) {
    return static_cast<metal::int2>(metal::clamp(value, -2147483600.0, 2147483500.0));
}


struct pass2_Input {
    float v_4 [[user(loc0), center_perspective]];
    metal::float4 color [[user(loc1), center_perspective]];
};
struct pass2_Output {
    metal::float4 member [[color(0)]];
};
fragment pass2_Output pass2(
  pass2_Input varyings [[stage_in]]
, metal::float4 position [[position]]
, constant Frame& frame [[buffer(0)]]
, metal::texture2d<float, metal::access::sample> sums0_texture [[texture(0)]]
, metal::texture2d<float, metal::access::sample> sums1_texture [[texture(1)]]
, metal::texture2d<float, metal::access::sample> range_texture [[texture(2)]]
) {
    const Varying in = { position, varyings.v_4, {}, varyings.color };
    metal::int2 at = naga_f2i32(in.position.xy);
    float _e7 = frame.v0;
    float _e10 = frame.v1;
    metal::float4 _e15 = sums0_texture.read(metal::uint2(at), 0);
    metal::float4 _e18 = sums1_texture.read(metal::uint2(at), 0);
    metal::float4 _e21 = range_texture.read(metal::uint2(at), 0);
    float _e22 = nmt_pass2(in.v, _e7, _e10, in.color.w, _e15, _e18, _e21);
    float weight = in.color.w * _e22;
    return pass2_Output { metal::float4(weight * in.color.xyz, weight) };
}
