// Neural moment transparency: network 'small', 7-16-8-1, 248 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
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
static const float NMT_ROUNDING = 1.1920929e-7;

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
float4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return float4(moment1, moment2, moment3, moment4);
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
float4 nmt_recentred_moments(float z, float absorbance, float c, float per_h, float per_b0, float4 b) {
    float4 own = nmt_moments(z, absorbance);
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
    return float4(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3, -1.0, 1.0),
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

// Pass 2: what is known of a fragment at view depth v and moment depth z, from what pass 1 left in its pixel: nearest
// and farthest view depth as f32, their moment depths, number of fragments n, total absorbance b0 and moments b1..b4.
// The result holds the 7 features, then T where it is known without the network, else -1. No branch is taken.
float2x4 nmt_recentred(float v, float z, float absorbance, float nearest, float farthest, float z_nearest, float
    z_farthest, float n, float b0, float4 b) {
    float c = 0.5 * (z_nearest + z_farthest);
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
    float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
    float4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
    float noise_growth = 1.0 + 2.0 * abs(c) * per_h;
    float moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
    float noise1 = moment_noise * (0.12 * sqrt(n));
    float per_n = 1.0 / n;
    float mean0 = nmt_shrink_to_prior(m.x, 0.0, noise1, 0.22 + 0.7 * per_n);
    float x = ((farthest - nearest) / nearest < 0.01 ? nmt_place_in_thin(v, nearest, farthest) : clamp((z - c)
        * per_h, -1.0, 1.0));
    float further = noise_growth * 0.87;
    float noise2 = noise1 * further;
    float noise3 = noise2 * further;
    float most0 = max(1.0 - mean0 * mean0, 1e-6);
    float raw_spread0 = clamp((m.y - mean0 * mean0) / most0, 0.0, 1.0);
    float spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5 * per_n);
    // The same of (1 - x^2) times the measure, which does not hold the ends.
    float per_mass1 = 1.0 / max(1.0 - m.y, 1e-6);
    float raw_mean1 = clamp((m.x - m.z) * per_mass1, -1.0, 1.0);
    float expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
    float deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
    float noise = noise3 * per_mass1;
    float all_noise = noise + 9.536743e-7 * per_mass1;
    float mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
    float transition_width = all_noise * deviation / (all_noise + deviation);
    // Optical depth in front where it is known: the exact rules, then the closed forms of three and four.
    float front = -1.0;
    front = (n == 4.0 ? others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width) : front);
    front = (n == 3.0 ? others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0) : front);
    front = (v == farthest ? others : front);
    front = (others > 1e-6 * b0 ? front : 0.0);
    front = (v == nearest ? 0.0 : front);
    float known = (front >= 0.0 ? min(exp(-front), 1.0) : -1.0);
    float most1 = max(1.0 - mean1 * mean1, 1e-6);
    float raw_square1 = clamp(((m.y - m.w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
    float offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
    float square0 = spread0 * spread0;
    float expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset * offset) * spread0
        / (1.0 + spread0 + spread0), 0.0, 1.0);
    float spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further * per_mass1 / most1,
        (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
    return float2x4(float4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05), mean0), float4(spread0, mean1, spread1,
        known));
}

static const float4x4 NMT_W1[8] = {
    float4x4(float4(0.5572419f, 0.8873689f, 0.025650654f, -2.3207302f), float4(-0.34461814f, -0.44891888f, -0.39050588f, -0.18091549f), float4(-0.071615376f, -0.024140464f, -0.008282083f, 0.038272522f), float4(-3.7245471f, 2.6387365f, -2.2102082f, -0.5306895f)),
    float4x4(float4(2.9037392f, 4.164609f, 1.6416957f, -1.0860678f), float4(3.182191f, -1.0674255f, -0.9432166f, 2.8805542f), float4(-3.5021276f, 1.3302044f, -0.5502461f, 1.2838587f), float4(2.1899598f, -1.1524864f, 2.8668165f, 0.26594585f)),
    float4x4(float4(-5.0277195f, 3.556171f, -4.748659f, -3.4211285f), float4(-0.089546226f, 0.9750353f, 0.13666514f, -0.24305318f), float4(0.11110483f, -0.09587958f, 0.028702937f, 0.08554635f), float4(-1.3789594f, -1.5830472f, -0.08525755f, -0.4679912f)),
    float4x4(float4(0.8829105f, 1.4194763f, -0.053129755f, -4.384808f), float4(5.9241633f, 0.9597082f, 4.626354f, -0.6152009f), float4(-0.9577396f, -0.31151232f, -1.3498255f, -0.17014448f), float4(-1.2974775f, 2.533871f, 0.26404834f, 1.322599f)),
    float4x4(float4(-2.8703783f, 6.6934257f, -0.7819008f, 3.0343735f), float4(0.48690128f, 0.11834759f, 0.17926306f, -0.20529807f), float4(-0.0747379f, -0.10869953f, 0.011314124f, -0.018088961f), float4(-1.3296846f, -3.0842803f, 2.6905768f, 2.3319657f)),
    float4x4(float4(-0.42825016f, -0.66429555f, -6.518144f, -0.7735734f), float4(-1.6082613f, 0.79219943f, -3.6361427f, -2.9449046f), float4(2.9222262f, 1.6352106f, 6.105769f, -1.6681633f), float4(-2.4759755f, -2.758409f, -1.277408f, 3.7719758f)),
    float4x4(float4(-3.9685419f, -0.07865249f, 3.7518868f, -4.5860977f), float4(-0.24054211f, -0.016617632f, 0.43475664f, 0.22254096f), float4(0.10049601f, 0.0337685f, -0.1098763f, 0.017653327f), float4(1.6598035f, -5.834993f, -5.4151325f, -0.41488847f)),
    float4x4(float4(-1.4044262f, -5.671788f, 1.827299f, 0.9802938f), float4(0.16522916f, 2.2399037f, -0.2985399f, 0.34238428f), float4(-5.7326884f, 0.47215062f, -1.3136361f, -0.68593293f), float4(2.0557249f, 1.7273939f, -0.45318872f, -4.756142f))
};
static const float4x4 NMT_W2[8] = {
    float4x4(float4(-1.0931103f, 0.44210717f, -1.2169352f, -0.008068636f), float4(-0.46324944f, 0.43549836f, 0.5542804f, 1.1708078f), float4(-2.2489386f, 0.16765693f, 1.8471042f, -1.4360818f), float4(0.7370069f, 0.3038649f, 0.3395028f, 0.80514723f)),
    float4x4(float4(-3.49791f, -0.6550794f, 0.46273717f, -1.0264783f), float4(-0.39480978f, 0.22474408f, 1.956778f, -0.082365066f), float4(-0.57403874f, 0.83014053f, -0.7696553f, 0.6588965f), float4(3.1965384f, -1.0385951f, -2.110678f, 0.43452936f)),
    float4x4(float4(-1.2251607f, 0.5895338f, -0.8918203f, 0.8026775f), float4(-0.41444397f, 0.053060696f, -6.2512116f, -2.7577538f), float4(4.966727f, -0.31968412f, 0.58516496f, 0.77836883f), float4(1.5743009f, -0.9283775f, -0.74404365f, 0.6748018f)),
    float4x4(float4(2.7018049f, 2.1556873f, 0.6269551f, 1.3626245f), float4(-1.4378589f, 0.064023025f, 1.8883291f, 0.014146412f), float4(-3.531625f, 0.04492224f, 2.324661f, 1.9930973f), float4(-25.788624f, 2.5182197f, -1.4758978f, 3.1982157f)),
    float4x4(float4(-0.41391823f, 1.1319875f, -1.5793422f, -2.3548183f), float4(-1.1366525f, -1.5580677f, 0.22625221f, -2.727241f), float4(1.318036f, -0.8864321f, -0.44220364f, 0.3394501f), float4(-1.5196753f, -7.6356916f, 1.4066124f, -0.07263669f)),
    float4x4(float4(0.79437137f, -1.5935353f, -2.7841825f, 1.2082449f), float4(1.3773485f, -0.25885287f, -2.0684526f, -3.7339642f), float4(-0.3631151f, -21.331264f, 0.13827866f, 0.43595257f), float4(-3.5297334f, 0.29987663f, -5.3779497f, -0.21252474f)),
    float4x4(float4(-1.9185516f, 1.1649779f, 2.1195953f, 2.3788228f), float4(-0.16068031f, 1.6363701f, 3.9007616f, 4.429163f), float4(-6.5963273f, 4.705528f, 2.5016162f, 3.4034655f), float4(-2.0963562f, 2.1782613f, 0.7483879f, 3.5064597f)),
    float4x4(float4(0.659403f, 2.378958f, 0.81767404f, -0.9107636f), float4(2.0063715f, 0.6180353f, 5.9041595f, 0.08523572f), float4(-2.0180254f, -0.19664863f, -0.51828355f, -0.41485465f), float4(-5.688983f, 4.35494f, -39.64846f, 12.921714f))
};
static const float4 NMT_B2[2] = {
    float4(-1.4392625f, -3.6934829f, -1.2812184f, 3.0139205f),
    float4(4.0596824f, -2.0969372f, 1.9294189f, -1.1730818f)
};
static const float4 NMT_W3[2] = {
    float4(-0.21454798f, 0.23790133f, 0.21061999f, -0.41597816f),
    float4(-0.20229746f, 0.22367835f, 0.15568821f, -0.21407762f)
};
static const float NMT_B3 = -0.09972816f;

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

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
float nmt_fragment_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, float4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                float c = 0.5 * (z_nearest + z_farthest);
                float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                float4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
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
                        front = others * nmt_share(float2x4(float4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05),
                            mean0), float4(spread0, mean1, spread1, 0.0)));
                    }
                }
            }
        }
    }
    return min(exp(-front), 1.0);
}

// What cannot be seen needs no network. Two switches, each by itself; 0 turns one off. Colours are taken to lie in
// [0, 1].

// Pixels with b0 up to this are faint: no answer changes a channel by more than 1.923e-3, less than half a display step
// of 1/256.
static const float NMT_FAINT = 0.0625;

// Fragments that are hidden weigh no more than this, all of a pixel together: answered like the farthest, they change
// no channel by more than twice as much against exact answers of theirs, where the weights of the pixel (opacity times
// answer, what pass 2 adds up) sum to a half or more. Exact answers sum to 0.99 where one looks; a network's do not
// have to.
static const float NMT_HIDDEN = 0.00095;

// Moment depth from which on one looks for hidden fragments in a pixel; no depth reaches it where the pixel lets too
// much light through.
float nmt_first_hidden_depth(float b0, float b1, float b2) {
    float excess = b0 - 5.0;
    float deviation = sqrt(max(b2 * b0 - b1 * b1, 0.0) * 5.0 / max(excess, 1e-6));
    return (excess > 0.0 ? (b1 + deviation) / max(b0, 1e-30) : 3e38);
}

// The most that a fragment and all behind it weigh, opacity times transmittance, whatever has these moments.
// Polynomials that are 0 or more in the pixel and 1 or more from the fragment on bound the share that lies there,
// rounding included.
float nmt_hidden_weight(float z, float absorbance, float z_nearest, float z_farthest, float n, float b0, float4 b) {
    float c = 0.5 * (z_nearest + z_farthest);
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
    float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
    float4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
    float noise_growth = 1.0 + 2.0 * abs(c) * per_h;
    // What rounding may have done to moments and places.
    float unsure = (n + 16.0) * NMT_ROUNDING * b0 / max(others, 1e-30);
    float off = 2e-6 * per_h;
    float end = 1.0 + off;
    float x = clamp((z - c) * per_h, -1.0, 1.0) - off;
    // Cantelli's inequality.
    float ahead = x - m.x;
    float r1 = max(m.x - max(m.y - m.x * m.x, 0.0) / max(ahead, 1e-30), -1e6);
    float growth1 = noise_growth + abs(r1);
    float gap1 = x - r1;
    float share1 = (m.y - 2.0 * r1 * m.x + r1 * r1 + unsure * (growth1 * growth1)) / max(gap1 * gap1, 1e-30);
    // The quartic.
    float w1 = m.x - m.z;
    float below = w1 - x * (1.0 - m.y);
    float inner = (m.y - m.w - x * w1) / (abs(below) < 1e-30 ? 1e-30 : below);
    float outer = max(r1, -1.0);
    float inside = (inner >= -end ? inner : outer);
    float r = (inside < x ? inside : outer);
    float gap = x - r;
    float per_value = 1.0 / max((end + x) * (gap * gap), 1e-30);
    float end_gap = end - r;
    float gamma = 0.99999 * (1.0 - 1.0 / (2.0 * end * (end_gap * end_gap) * per_value)) / (end - x);
    float p0 = end * r * r;
    float p1 = r * r - 2.0 * r * end;
    float p2 = end - 2.0 * r;
    float lift = 1.0 + gamma * x;
    float value = p0 * lift + (p1 * lift - gamma * p0) * m.x + (p2 * lift - gamma * p1) * m.y + (lift - gamma * p2)
        * m.z - gamma * m.w;
    float growth2 = noise_growth + abs(r);
    float lost = unsure * (end + noise_growth) * (growth2 * growth2) * (1.0 + gamma * (abs(x) + noise_growth));
    float share2 = (value + lost) * per_value;
    float share = min(share1, share2) * 1.00001;
    float behind = (ahead > 0.0 ? (share < 1.0 ? max(share, 0.0) : 1.0) : 1.0);
    float least_depth = others * (1.0 - behind) - ((n + 4.0) * NMT_ROUNDING * b0 + 1e-5);
    return exp(-least_depth) * min(others * behind + absorbance, n - 2.0);
}

// Pass 2, with the network for what can be seen: parameters and answers as of nmt_fragment_transmittance, but for faint
// pixels and hidden fragments. Pixels of up to four fragments have forms of their own.
float nmt_visible_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, float4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = -1.0;
    if (n > 4.0) {
        if (v != nearest) {
            if (v != farthest) {
                if (others > 1e-6 * b0) {
                    if (b0 <= NMT_FAINT) {
                        front = 0.5 * others;
                    }
                    if (NMT_HIDDEN > 0.0) {
                        if (z >= nmt_first_hidden_depth(b0, b.x, b.y)) {
                            if (nmt_hidden_weight(z, absorbance, z_nearest, z_farthest, n, b0, b) <= NMT_HIDDEN) {
                                front = others;
                            }
                        }
                    }
                }
            }
        }
    }
    float answer = min(exp(-front), 1.0);
    if (front < 0.0) {
        answer = nmt_fragment_transmittance(v, z, absorbance, nearest, farthest, z_nearest, z_farthest, n, b0, b);
    }
    return answer;
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    float4 sums0;
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    float4 sums1;
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    float4 range;
};

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    float4 b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    NmtSums result;
    result.sums0 = float4(absorbance, b.xyz);
    result.sums1 = float4(b.w, 1.0, 0.0, 0.0);
    result.range = float4(-v, v, 0.0, 0.0);
    return result;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, float4 sums0, float4 sums1, float4 range) {
    float nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, float4(sums0.yzw,
        sums1.x));
}

// As nmt_pass2, without the network for what cannot be seen; see nmt_visible_transmittance.
float nmt_visible_pass2(float v, float v0, float v1, float alpha, float4 sums0, float4 sums1, float4 range) {
    float nearest = -range.x;
    return nmt_visible_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, float4(sums0.yzw,
        sums1.x));
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
float4 nmt_resolve(float4 weighted, float4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

#endif
