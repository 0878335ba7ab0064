#version 450
// Vulkan, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
// cleared to 0. Set 0: the targets of pass 1. With NMT_SUBPASS defined they are input attachments of a subpass, which
// tilers keep on chip. Depth test, discard and push constants as in pass 1; before the resolve a barrier like that
// behind pass 1.
//
// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
float nmt_log_ratio(float a, float b) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (abs(s) < 0.2 ? (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))
        : log(a / b));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
float nmt_moment_depth(float v, float v0, float v1) {
    return (v1 > v0 ? clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0) : 0.0);
}

// Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.
const float NMT_ROUNDING = 1.1920929e-7;

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
vec4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return vec4(moment1, moment2, moment3, moment4);
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
vec4 nmt_recentred_moments(float z, float absorbance, float c, float per_h, float per_b0, vec4 b) {
    vec4 own = nmt_moments(z, absorbance);
    float m1 = (b.x - own.x) * per_b0;
    float m2 = (b.y - own.y) * per_b0;
    float m3 = (b.z - own.z) * per_b0;
    float m4 = (b.w - own.w) * per_b0;
    // Moments of z - c, one factor at a time.
    float m4_2 = m4 - c * m3;
    float m3_2 = m3 - c * m2;
    float m2_2 = m2 - c * m1;
    float m1_2 = m1 - c;
    float m4_3 = m4_2 - c * m3_2;
    float m3_3 = m3_2 - c * m2_2;
    float m2_3 = m2_2 - c * m1_2;
    float m4_4 = m4_3 - c * m3_3;
    float m3_4 = m3_3 - c * m2_3;
    float m4_5 = m4_4 - c * m3_4;
    float per_h2 = per_h * per_h;
    float per_h3 = per_h2 * per_h;
    float per_h4 = per_h2 * per_h2;
    return vec4(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3, -1.0, 1.0),
        clamp(m4_5 * per_h4, -1.0, 1.0));
}

// Shrinks a noisy value towards what is expected of it, as far as the noise exceeds the usual deviation.
float nmt_shrink_to_prior(float value, float expected, float noise, float deviation) {
    float bounded = min(noise, 1e15);
    float trust = deviation * deviation;
    return expected + (value - expected) * (trust / (trust + bounded * bounded));
}

// Place of view depth v in the range of a thin pixel, in [-1, 1], where view depth says more than moment depth.
float nmt_place_in_thin(float v, float nearest, float farthest) {
    float range = farthest - nearest;
    float t = (v - nearest) / max(range, 1e-30);
    float x = t * (1.0 + 0.5 * (range / nearest) * (1.0 - t));
    return clamp(x + x - 1.0, -1.0, 1.0);
}

// Share of the others' absorbance in front of place x in a pixel of four: atoms at -1, u and 1 have this mean and
// spread. Within the transition width of u, in front and behind go over into one another.
float nmt_share_of_four(float x, float mean, float spread, float u, float transition_width) {
    float inner = (1.0 - spread) * (1.0 - mean * mean);
    float near_end = clamp(0.5 * (1.0 - mean - inner / max(1.0 + u, 1e-6)), 0.0, 1.0);
    float far_end = clamp(0.5 * (1.0 + mean - inner / max(1.0 - u, 1e-6)), 0.0, 1.0);
    float behind = clamp(0.5 + 0.5 * (x - u) / transition_width, 0.0, 1.0);
    return clamp(near_end + behind * (1.0 - far_end - near_end), 0.0, 1.0);
}

const mat4 NMT_W1[8] = mat4[8](
    mat4(vec4(0.5572419, 0.8873689, 0.025650654, -2.3207302), vec4(-0.34461814, -0.44891888, -0.39050588, -0.18091549), vec4(-0.071615376, -0.024140464, -0.008282083, 0.038272522), vec4(-3.7245471, 2.6387365, -2.2102082, -0.5306895)),
    mat4(vec4(2.9037392, 4.164609, 1.6416957, -1.0860678), vec4(3.182191, -1.0674255, -0.9432166, 2.8805542), vec4(-3.5021276, 1.3302044, -0.5502461, 1.2838587), vec4(2.1899598, -1.1524864, 2.8668165, 0.26594585)),
    mat4(vec4(-5.0277195, 3.556171, -4.748659, -3.4211285), vec4(-0.089546226, 0.9750353, 0.13666514, -0.24305318), vec4(0.11110483, -0.09587958, 0.028702937, 0.08554635), vec4(-1.3789594, -1.5830472, -0.08525755, -0.4679912)),
    mat4(vec4(0.8829105, 1.4194763, -0.053129755, -4.384808), vec4(5.9241633, 0.9597082, 4.626354, -0.6152009), vec4(-0.9577396, -0.31151232, -1.3498255, -0.17014448), vec4(-1.2974775, 2.533871, 0.26404834, 1.322599)),
    mat4(vec4(-2.8703783, 6.6934257, -0.7819008, 3.0343735), vec4(0.48690128, 0.11834759, 0.17926306, -0.20529807), vec4(-0.0747379, -0.10869953, 0.011314124, -0.018088961), vec4(-1.3296846, -3.0842803, 2.6905768, 2.3319657)),
    mat4(vec4(-0.42825016, -0.66429555, -6.518144, -0.7735734), vec4(-1.6082613, 0.79219943, -3.6361427, -2.9449046), vec4(2.9222262, 1.6352106, 6.105769, -1.6681633), vec4(-2.4759755, -2.758409, -1.277408, 3.7719758)),
    mat4(vec4(-3.9685419, -0.07865249, 3.7518868, -4.5860977), vec4(-0.24054211, -0.016617632, 0.43475664, 0.22254096), vec4(0.10049601, 0.0337685, -0.1098763, 0.017653327), vec4(1.6598035, -5.834993, -5.4151325, -0.41488847)),
    mat4(vec4(-1.4044262, -5.671788, 1.827299, 0.9802938), vec4(0.16522916, 2.2399037, -0.2985399, 0.34238428), vec4(-5.7326884, 0.47215062, -1.3136361, -0.68593293), vec4(2.0557249, 1.7273939, -0.45318872, -4.756142))
);
const mat4 NMT_W2[8] = mat4[8](
    mat4(vec4(-1.0931103, 0.44210717, -1.2169352, -0.008068636), vec4(-0.46324944, 0.43549836, 0.5542804, 1.1708078), vec4(-2.2489386, 0.16765693, 1.8471042, -1.4360818), vec4(0.7370069, 0.3038649, 0.3395028, 0.80514723)),
    mat4(vec4(-3.49791, -0.6550794, 0.46273717, -1.0264783), vec4(-0.39480978, 0.22474408, 1.956778, -0.082365066), vec4(-0.57403874, 0.83014053, -0.7696553, 0.6588965), vec4(3.1965384, -1.0385951, -2.110678, 0.43452936)),
    mat4(vec4(-1.2251607, 0.5895338, -0.8918203, 0.8026775), vec4(-0.41444397, 0.053060696, -6.2512116, -2.7577538), vec4(4.966727, -0.31968412, 0.58516496, 0.77836883), vec4(1.5743009, -0.9283775, -0.74404365, 0.6748018)),
    mat4(vec4(2.7018049, 2.1556873, 0.6269551, 1.3626245), vec4(-1.4378589, 0.064023025, 1.8883291, 0.014146412), vec4(-3.531625, 0.04492224, 2.324661, 1.9930973), vec4(-25.788624, 2.5182197, -1.4758978, 3.1982157)),
    mat4(vec4(-0.41391823, 1.1319875, -1.5793422, -2.3548183), vec4(-1.1366525, -1.5580677, 0.22625221, -2.727241), vec4(1.318036, -0.8864321, -0.44220364, 0.3394501), vec4(-1.5196753, -7.6356916, 1.4066124, -0.07263669)),
    mat4(vec4(0.79437137, -1.5935353, -2.7841825, 1.2082449), vec4(1.3773485, -0.25885287, -2.0684526, -3.7339642), vec4(-0.3631151, -21.331264, 0.13827866, 0.43595257), vec4(-3.5297334, 0.29987663, -5.3779497, -0.21252474)),
    mat4(vec4(-1.9185516, 1.1649779, 2.1195953, 2.3788228), vec4(-0.16068031, 1.6363701, 3.9007616, 4.429163), vec4(-6.5963273, 4.705528, 2.5016162, 3.4034655), vec4(-2.0963562, 2.1782613, 0.7483879, 3.5064597)),
    mat4(vec4(0.659403, 2.378958, 0.81767404, -0.9107636), vec4(2.0063715, 0.6180353, 5.9041595, 0.08523572), vec4(-2.0180254, -0.19664863, -0.51828355, -0.41485465), vec4(-5.688983, 4.35494, -39.64846, 12.921714))
);
const vec4 NMT_B2[2] = vec4[2](
    vec4(-1.4392625, -3.6934829, -1.2812184, 3.0139205),
    vec4(4.0596824, -2.0969372, 1.9294189, -1.1730818)
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.21454798, 0.23790133, 0.21061999, -0.41597816),
    vec4(-0.20229746, 0.22367835, 0.15568821, -0.21407762)
);
const float NMT_B3 = -0.09972816;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat2x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = vec4(f[1].xyz, 1.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4(0.0));
    vec4 h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4(0.0));
    vec4 h2_1 = max(NMT_B2[1] + NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
float nmt_fragment_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, vec4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                float c = 0.5 * (z_nearest + z_farthest);
                float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                vec4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
                float noise_growth = 1.0 + 2.0 * abs(c) * per_h;
                float moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
                float noise1 = moment_noise * (0.12 * sqrt(n));
                float per_n = 1.0 / n;
                float mean0 = nmt_shrink_to_prior(m.x, 0.0, noise1, 0.22 + 0.7 * per_n);
                front = others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0);
                if (n != 3.0) {
                    float x = ((farthest - nearest) / nearest < 0.01 ? nmt_place_in_thin(v, nearest, farthest)
                        : clamp((z - c) * per_h, -1.0, 1.0));
                    float further = noise_growth * 0.87;
                    float noise2 = noise1 * further;
                    float noise3 = noise2 * further;
                    float most0 = max(1.0 - mean0 * mean0, 1e-6);
                    float raw_spread0 = clamp((m.y - mean0 * mean0) / most0, 0.0, 1.0);
                    float spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5
                        * per_n);
                    // The same of (1 - x^2) times the measure, which does not hold the ends.
                    float per_mass1 = 1.0 / max(1.0 - m.y, 1e-6);
                    float raw_mean1 = clamp((m.x - m.z) * per_mass1, -1.0, 1.0);
                    float expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
                    float deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
                    float noise = noise3 * per_mass1;
                    float all_noise = noise + 9.536743e-7 * per_mass1;
                    float mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
                    float transition_width = all_noise * deviation / (all_noise + deviation);
                    front = others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width);
                    if (n != 4.0) {
                        float most1 = max(1.0 - mean1 * mean1, 1e-6);
                        float raw_square1 = clamp(((m.y - m.w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
                        float offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
                        float square0 = spread0 * spread0;
                        float expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset
                            * offset) * spread0 / (1.0 + spread0 + spread0), 0.0, 1.0);
                        float spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further
                            * per_mass1 / most1, (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
                        front = others * nmt_share(mat2x4(vec4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05),
                            mean0), vec4(spread0, mean1, spread1, 0.0)));
                    }
                }
            }
        }
    }
    return min(exp(-front), 1.0);
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, vec4 sums0, vec4 sums1, vec4 range) {
    float nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, vec4(sums0.yzw,
        sums1.x));
}

layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
layout(push_constant) uniform Frame { vec2 v_range; } frame;
#ifdef NMT_SUBPASS
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput sums0_texture;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput sums1_texture;
layout(input_attachment_index = 2, set = 0, binding = 2) uniform subpassInput range_texture;
#define NMT_LOAD(name) subpassLoad(name)
#else
layout(set = 0, binding = 0) uniform sampler2D sums0_texture;
layout(set = 0, binding = 1) uniform sampler2D sums1_texture;
layout(set = 0, binding = 2) uniform sampler2D range_texture;
#define NMT_LOAD(name) texelFetch(name, ivec2(gl_FragCoord.xy), 0)
#endif

void main() {
    float T = nmt_pass2(
        v, frame.v_range.x, frame.v_range.y, color.a,
        NMT_LOAD(sums0_texture),
        NMT_LOAD(sums1_texture),
        NMT_LOAD(range_texture));
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
