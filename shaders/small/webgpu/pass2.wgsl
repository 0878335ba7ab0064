// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.593e-3, worst 0.995.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
fn nmt_absorbance(alpha: f32) -> f32 {
    let faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return select(-log(max(1.0 - alpha, 4.539993e-5)), faint, 0.03 > alpha);
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
fn nmt_log_ratio(a: f32, b: f32) -> f32 {
    let s = (a - b) / (a + b);
    let q = s * s;
    return select(log(a / b), (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111)))),
        0.2 > abs(s));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
fn nmt_moment_depth(v: f32, v0: f32, v1: f32) -> f32 {
    return select(0.0, clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0), v1 > v0);
}

// Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.
const NMT_ROUNDING: f32 = 1.1920929e-7;

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
fn nmt_moments(z: f32, absorbance: f32) -> vec4<f32> {
    let moment1 = absorbance * z;
    let moment2 = moment1 * z;
    let moment3 = moment2 * z;
    let moment4 = moment3 * z;
    return vec4<f32>(moment1, moment2, moment3, moment4);
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
fn nmt_recentred_moments(z: f32, absorbance: f32, c: f32, per_h: f32, per_b0: f32, b: vec4<f32>) -> vec4<f32> {
    let own = nmt_moments(z, absorbance);
    let m1 = (b.x - own.x) * per_b0;
    let m2 = (b.y - own.y) * per_b0;
    let m3 = (b.z - own.z) * per_b0;
    let m4 = (b.w - own.w) * per_b0;
    // Moments of z - c, one factor at a time.
    let m4_2 = m4 - c * m3;
    let m3_2 = m3 - c * m2;
    let m2_2 = m2 - c * m1;
    let m1_2 = m1 - c;
    let m4_3 = m4_2 - c * m3_2;
    let m3_3 = m3_2 - c * m2_2;
    let m2_3 = m2_2 - c * m1_2;
    let m4_4 = m4_3 - c * m3_3;
    let m3_4 = m3_3 - c * m2_3;
    let m4_5 = m4_4 - c * m3_4;
    let per_h2 = per_h * per_h;
    let per_h3 = per_h2 * per_h;
    let per_h4 = per_h2 * per_h2;
    return vec4<f32>(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3, -1.0,
        1.0), clamp(m4_5 * per_h4, -1.0, 1.0));
}

// Shrinks a noisy value towards what is expected of it, as far as the noise exceeds the usual deviation.
fn nmt_shrink_to_prior(value: f32, expected: f32, noise: f32, deviation: f32) -> f32 {
    let bounded = min(noise, 1e15);
    let trust = deviation * deviation;
    return expected + (value - expected) * (trust / (trust + bounded * bounded));
}

// Place of view depth v in the range of a thin pixel, in [-1, 1], where view depth says more than moment depth.
fn nmt_place_in_thin(v: f32, nearest: f32, farthest: f32) -> f32 {
    let range = farthest - nearest;
    let t = (v - nearest) / max(range, 1e-30);
    let x = t * (1.0 + 0.5 * (range / nearest) * (1.0 - t));
    return clamp(x + x - 1.0, -1.0, 1.0);
}

// Share of the others' absorbance in front of place x in a pixel of four: atoms at -1, u and 1 have this mean and
// spread. Within the transition width of u, in front and behind go over into one another.
fn nmt_share_of_four(x: f32, mean: f32, spread: f32, u: f32, transition_width: f32) -> f32 {
    let inner = (1.0 - spread) * (1.0 - mean * mean);
    let near_end = clamp(0.5 * (1.0 - mean - inner / max(1.0 + u, 1e-6)), 0.0, 1.0);
    let far_end = clamp(0.5 * (1.0 + mean - inner / max(1.0 - u, 1e-6)), 0.0, 1.0);
    let behind = clamp(0.5 + 0.5 * (x - u) / transition_width, 0.0, 1.0);
    return clamp(near_end + behind * (1.0 - far_end - near_end), 0.0, 1.0);
}

const NMT_W1 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(0.5572419f, 0.8873689f, 0.025650654f, -2.3207302f), vec4<f32>(-0.34461814f, -0.44891888f, -0.39050588f, -0.18091549f), vec4<f32>(-0.071615376f, -0.024140464f, -0.008282083f, 0.038272522f), vec4<f32>(-3.7245471f, 2.6387365f, -2.2102082f, -0.5306895f)),
    mat4x4<f32>(vec4<f32>(2.9037392f, 4.164609f, 1.6416957f, -1.0860678f), vec4<f32>(3.182191f, -1.0674255f, -0.9432166f, 2.8805542f), vec4<f32>(-3.5021276f, 1.3302044f, -0.5502461f, 1.2838587f), vec4<f32>(2.1899598f, -1.1524864f, 2.8668165f, 0.26594585f)),
    mat4x4<f32>(vec4<f32>(-5.0277195f, 3.556171f, -4.748659f, -3.4211285f), vec4<f32>(-0.089546226f, 0.9750353f, 0.13666514f, -0.24305318f), vec4<f32>(0.11110483f, -0.09587958f, 0.028702937f, 0.08554635f), vec4<f32>(-1.3789594f, -1.5830472f, -0.08525755f, -0.4679912f)),
    mat4x4<f32>(vec4<f32>(0.8829105f, 1.4194763f, -0.053129755f, -4.384808f), vec4<f32>(5.9241633f, 0.9597082f, 4.626354f, -0.6152009f), vec4<f32>(-0.9577396f, -0.31151232f, -1.3498255f, -0.17014448f), vec4<f32>(-1.2974775f, 2.533871f, 0.26404834f, 1.322599f)),
    mat4x4<f32>(vec4<f32>(-2.8703783f, 6.6934257f, -0.7819008f, 3.0343735f), vec4<f32>(0.48690128f, 0.11834759f, 0.17926306f, -0.20529807f), vec4<f32>(-0.0747379f, -0.10869953f, 0.011314124f, -0.018088961f), vec4<f32>(-1.3296846f, -3.0842803f, 2.6905768f, 2.3319657f)),
    mat4x4<f32>(vec4<f32>(-0.42825016f, -0.66429555f, -6.518144f, -0.7735734f), vec4<f32>(-1.6082613f, 0.79219943f, -3.6361427f, -2.9449046f), vec4<f32>(2.9222262f, 1.6352106f, 6.105769f, -1.6681633f), vec4<f32>(-2.4759755f, -2.758409f, -1.277408f, 3.7719758f)),
    mat4x4<f32>(vec4<f32>(-3.9685419f, -0.07865249f, 3.7518868f, -4.5860977f), vec4<f32>(-0.24054211f, -0.016617632f, 0.43475664f, 0.22254096f), vec4<f32>(0.10049601f, 0.0337685f, -0.1098763f, 0.017653327f), vec4<f32>(1.6598035f, -5.834993f, -5.4151325f, -0.41488847f)),
    mat4x4<f32>(vec4<f32>(-1.4044262f, -5.671788f, 1.827299f, 0.9802938f), vec4<f32>(0.16522916f, 2.2399037f, -0.2985399f, 0.34238428f), vec4<f32>(-5.7326884f, 0.47215062f, -1.3136361f, -0.68593293f), vec4<f32>(2.0557249f, 1.7273939f, -0.45318872f, -4.756142f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(-1.0931103f, 0.44210717f, -1.2169352f, -0.008068636f), vec4<f32>(-0.46324944f, 0.43549836f, 0.5542804f, 1.1708078f), vec4<f32>(-2.2489386f, 0.16765693f, 1.8471042f, -1.4360818f), vec4<f32>(0.7370069f, 0.3038649f, 0.3395028f, 0.80514723f)),
    mat4x4<f32>(vec4<f32>(-3.49791f, -0.6550794f, 0.46273717f, -1.0264783f), vec4<f32>(-0.39480978f, 0.22474408f, 1.956778f, -0.082365066f), vec4<f32>(-0.57403874f, 0.83014053f, -0.7696553f, 0.6588965f), vec4<f32>(3.1965384f, -1.0385951f, -2.110678f, 0.43452936f)),
    mat4x4<f32>(vec4<f32>(-1.2251607f, 0.5895338f, -0.8918203f, 0.8026775f), vec4<f32>(-0.41444397f, 0.053060696f, -6.2512116f, -2.7577538f), vec4<f32>(4.966727f, -0.31968412f, 0.58516496f, 0.77836883f), vec4<f32>(1.5743009f, -0.9283775f, -0.74404365f, 0.6748018f)),
    mat4x4<f32>(vec4<f32>(2.7018049f, 2.1556873f, 0.6269551f, 1.3626245f), vec4<f32>(-1.4378589f, 0.064023025f, 1.8883291f, 0.014146412f), vec4<f32>(-3.531625f, 0.04492224f, 2.324661f, 1.9930973f), vec4<f32>(-25.788624f, 2.5182197f, -1.4758978f, 3.1982157f)),
    mat4x4<f32>(vec4<f32>(-0.41391823f, 1.1319875f, -1.5793422f, -2.3548183f), vec4<f32>(-1.1366525f, -1.5580677f, 0.22625221f, -2.727241f), vec4<f32>(1.318036f, -0.8864321f, -0.44220364f, 0.3394501f), vec4<f32>(-1.5196753f, -7.6356916f, 1.4066124f, -0.07263669f)),
    mat4x4<f32>(vec4<f32>(0.79437137f, -1.5935353f, -2.7841825f, 1.2082449f), vec4<f32>(1.3773485f, -0.25885287f, -2.0684526f, -3.7339642f), vec4<f32>(-0.3631151f, -21.331264f, 0.13827866f, 0.43595257f), vec4<f32>(-3.5297334f, 0.29987663f, -5.3779497f, -0.21252474f)),
    mat4x4<f32>(vec4<f32>(-1.9185516f, 1.1649779f, 2.1195953f, 2.3788228f), vec4<f32>(-0.16068031f, 1.6363701f, 3.9007616f, 4.429163f), vec4<f32>(-6.5963273f, 4.705528f, 2.5016162f, 3.4034655f), vec4<f32>(-2.0963562f, 2.1782613f, 0.7483879f, 3.5064597f)),
    mat4x4<f32>(vec4<f32>(0.659403f, 2.378958f, 0.81767404f, -0.9107636f), vec4<f32>(2.0063715f, 0.6180353f, 5.9041595f, 0.08523572f), vec4<f32>(-2.0180254f, -0.19664863f, -0.51828355f, -0.41485465f), vec4<f32>(-5.688983f, 4.35494f, -39.64846f, 12.921714f))
);
const NMT_B2 = array<vec4<f32>, 2>(
    vec4<f32>(-1.4392625f, -3.6934829f, -1.2812184f, 3.0139205f),
    vec4<f32>(4.0596824f, -2.0969372f, 1.9294189f, -1.1730818f)
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.21454798f, 0.23790133f, 0.21061999f, -0.41597816f),
    vec4<f32>(-0.20229746f, 0.22367835f, 0.15568821f, -0.21407762f)
);
const NMT_B3: f32 = -0.09972816f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat2x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = vec4<f32>(f[1].xyz, 1.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4<f32>(0.0f));
    let h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4<f32>(0.0f));
    let h2_1 = max(NMT_B2[1] + NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
fn nmt_fragment_transmittance(v: f32, z: f32, absorbance: f32, nearest: f32, farthest: f32, z_nearest: f32,
    z_farthest: f32, n: f32, b0: f32, b: vec4<f32>) -> f32 {
    let others = clamp(b0 - absorbance, 0.0, 1e30);
    var front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                let c = 0.5 * (z_nearest + z_farthest);
                let per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                let per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                let m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
                let noise_growth = 1.0 + 2.0 * abs(c) * per_h;
                let moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
                let noise1 = moment_noise * (0.12 * sqrt(n));
                let per_n = 1.0 / n;
                let mean0 = nmt_shrink_to_prior(m.x, 0.0, noise1, 0.22 + 0.7 * per_n);
                front = others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0);
                if (n != 3.0) {
                    let x = select(clamp((z - c) * per_h, -1.0, 1.0), nmt_place_in_thin(v, nearest, farthest), 0.01
                        > (farthest - nearest) / nearest);
                    let further = noise_growth * 0.87;
                    let noise2 = noise1 * further;
                    let noise3 = noise2 * further;
                    let most0 = max(1.0 - mean0 * mean0, 1e-6);
                    let raw_spread0 = clamp((m.y - mean0 * mean0) / most0, 0.0, 1.0);
                    let spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5
                        * per_n);
                    // The same of (1 - x^2) times the measure, which does not hold the ends.
                    let per_mass1 = 1.0 / max(1.0 - m.y, 1e-6);
                    let raw_mean1 = clamp((m.x - m.z) * per_mass1, -1.0, 1.0);
                    let expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
                    let deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
                    let noise = noise3 * per_mass1;
                    let all_noise = noise + 9.536743e-7 * per_mass1;
                    let mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
                    let transition_width = all_noise * deviation / (all_noise + deviation);
                    front = others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width);
                    if (n != 4.0) {
                        let most1 = max(1.0 - mean1 * mean1, 1e-6);
                        let raw_square1 = clamp(((m.y - m.w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
                        let offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
                        let square0 = spread0 * spread0;
                        let expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset
                            * offset) * spread0 / (1.0 + spread0 + spread0), 0.0, 1.0);
                        let spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further
                            * per_mass1 / most1, (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
                        front = others * nmt_share(mat2x4<f32>(vec4<f32>(x, log(n) * 0.48089835 - 1.0, log(others
                            + 0.05), mean0), vec4<f32>(spread0, mean1, spread1, 0.0)));
                    }
                }
            }
        }
    }
    return min(exp(-front), 1.0);
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>, range: vec4<f32>) -> f32 {
    let nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, vec4<f32>(sums0.yzw,
        sums1.x));
}

struct Frame {
    v0: f32,
    v1: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var sums0_texture: texture_2d<f32>;
@group(1) @binding(1) var sums1_texture: texture_2d<f32>;
@group(1) @binding(2) var range_texture: texture_2d<f32>;

struct Varying {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) v: f32,
    @location(1) color: vec4<f32>,
}

@fragment
fn pass2(in: Varying) -> @location(0) vec4<f32> {
    let at = vec2<i32>(in.position.xy);
    let T = nmt_pass2(
        in.v, frame.v0, frame.v1, in.color.a,
        textureLoad(sums0_texture, at, 0),
        textureLoad(sums1_texture, at, 0),
        textureLoad(range_texture, at, 0),
    );
    let weight = in.color.a * T;
    return vec4<f32>(weight * in.color.rgb, weight);
}
