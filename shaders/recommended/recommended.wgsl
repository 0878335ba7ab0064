// Neural moment transparency: network 'recommended', 7-32-16-1, 752 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
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
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 3 x 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.438e-3, worst 0.994.

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

// Pass 2: what is known of a fragment at view depth v and moment depth z, from what pass 1 left in its pixel: nearest
// and farthest view depth as f32, their moment depths, number of fragments n, total absorbance b0 and moments b1..b4.
// The result holds the 7 features, then T where it is known without the network, else -1. No branch is taken.
fn nmt_recentred(v: f32, z: f32, absorbance: f32, nearest: f32, farthest: f32, z_nearest: f32, z_farthest: f32,
    n: f32, b0: f32, b: vec4<f32>) -> mat2x4<f32> {
    let c = 0.5 * (z_nearest + z_farthest);
    let others = clamp(b0 - absorbance, 0.0, 1e30);
    let per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
    let per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
    let m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
    let noise_growth = 1.0 + 2.0 * abs(c) * per_h;
    let moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
    let noise1 = moment_noise * (0.12 * sqrt(n));
    let per_n = 1.0 / n;
    let mean0 = nmt_shrink_to_prior(m.x, 0.0, noise1, 0.22 + 0.7 * per_n);
    let x = select(clamp((z - c) * per_h, -1.0, 1.0), nmt_place_in_thin(v, nearest, farthest), 0.01 > (farthest
        - nearest) / nearest);
    let further = noise_growth * 0.87;
    let noise2 = noise1 * further;
    let noise3 = noise2 * further;
    let most0 = max(1.0 - mean0 * mean0, 1e-6);
    let raw_spread0 = clamp((m.y - mean0 * mean0) / most0, 0.0, 1.0);
    let spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5 * per_n);
    // The same of (1 - x^2) times the measure, which does not hold the ends.
    let per_mass1 = 1.0 / max(1.0 - m.y, 1e-6);
    let raw_mean1 = clamp((m.x - m.z) * per_mass1, -1.0, 1.0);
    let expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
    let deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
    let noise = noise3 * per_mass1;
    let all_noise = noise + 9.536743e-7 * per_mass1;
    let mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
    let transition_width = all_noise * deviation / (all_noise + deviation);
    // Optical depth in front where it is known: the exact rules, then the closed forms of three and four.
    var front = -1.0;
    front = select(front, others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width), n == 4.0);
    front = select(front, others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0), n == 3.0);
    front = select(front, others, v == farthest);
    front = select(0.0, front, others > 1e-6 * b0);
    front = select(front, 0.0, v == nearest);
    let known = select(-1.0, min(exp(-front), 1.0), front >= 0.0);
    let most1 = max(1.0 - mean1 * mean1, 1e-6);
    let raw_square1 = clamp(((m.y - m.w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
    let offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
    let square0 = spread0 * spread0;
    let expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset * offset) * spread0
        / (1.0 + spread0 + spread0), 0.0, 1.0);
    let spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further * per_mass1 / most1,
        (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
    return mat2x4<f32>(vec4<f32>(x, log(n) * 0.48089835 - 1.0, log(others + 0.05), mean0), vec4<f32>(spread0, mean1,
        spread1, known));
}

const NMT_W1 = array<mat4x4<f32>, 16>(
    mat4x4<f32>(vec4<f32>(-4.1674604f, 1.9599856f, -0.73242956f, -0.20504631f), vec4<f32>(-0.12590207f, 0.52091557f, 0.07906628f, 0.021661459f), vec4<f32>(0.08731185f, -0.010980034f, -0.04702237f, -0.014140079f), vec4<f32>(-2.3502588f, 0.98347735f, 5.2544265f, 7.5886335f)),
    mat4x4<f32>(vec4<f32>(-2.0677073f, -3.0403187f, -7.251252f, -0.21163398f), vec4<f32>(4.0386076f, -0.3408012f, -6.547609f, -0.27915618f), vec4<f32>(2.371881f, -3.6694639f, 2.8083203f, 0.16396397f), vec4<f32>(-4.5592628f, 3.2408876f, 0.7731898f, -6.0322914f)),
    mat4x4<f32>(vec4<f32>(-0.46817917f, 2.2209268f, 0.42732853f, -2.1391058f), vec4<f32>(0.6626024f, 0.12554957f, 0.15880474f, 0.08205461f), vec4<f32>(-0.002107043f, 0.067374885f, -0.04141126f, 0.018053476f), vec4<f32>(-0.02131919f, -5.3346705f, 6.854231f, 0.49863964f)),
    mat4x4<f32>(vec4<f32>(-2.3983507f, -2.2166302f, -9.364158f, -4.6879478f), vec4<f32>(-7.131321f, 0.9307025f, -5.2908893f, -0.09217429f), vec4<f32>(0.18057501f, -0.056932688f, -5.222522f, 5.909689f), vec4<f32>(-3.2400908f, 1.7953771f, 2.3643174f, -2.5787416f)),
    mat4x4<f32>(vec4<f32>(-2.0212417f, 3.5234349f, -0.29862827f, 2.837473f), vec4<f32>(-0.0034417917f, -0.2701374f, -0.06850981f, 0.26511696f), vec4<f32>(0.06310855f, -0.074502654f, 0.0036534448f, -0.02181142f), vec4<f32>(1.1280895f, -0.06773128f, 7.143841f, -0.33201975f)),
    mat4x4<f32>(vec4<f32>(-5.189434f, -2.4549117f, -0.16383393f, 2.9110465f), vec4<f32>(-3.691939f, -2.2927215f, -1.7290045f, 0.5228869f), vec4<f32>(3.423124f, 4.379191f, -0.54773974f, -2.3272412f), vec4<f32>(0.18388788f, 1.0360488f, -2.4800966f, 1.8856108f)),
    mat4x4<f32>(vec4<f32>(-3.5864356f, 3.698348f, -2.763185f, -2.920156f), vec4<f32>(0.78295255f, 0.015520756f, -0.32045588f, -0.06508547f), vec4<f32>(0.009859245f, -0.076360114f, 0.06714014f, 0.014959682f), vec4<f32>(-0.39343145f, -0.1780676f, 4.0171967f, -0.3578333f)),
    mat4x4<f32>(vec4<f32>(1.4050651f, 0.118033335f, -6.476847f, -0.18825664f), vec4<f32>(0.19789477f, -0.5731352f, -5.180575f, 3.0493782f), vec4<f32>(-0.75208825f, 6.0289307f, 3.036596f, 0.6782269f), vec4<f32>(-4.040601f, -2.1219463f, -0.72817266f, 0.23356485f)),
    mat4x4<f32>(vec4<f32>(0.33965114f, 0.53012913f, 3.6864781f, 0.75859493f), vec4<f32>(0.00060585595f, -2.9309227f, -0.36718613f, -0.3317407f), vec4<f32>(0.033321146f, 1.2089126f, 0.2153916f, -0.0014231349f), vec4<f32>(7.1874413f, 0.3191635f, -8.419987f, -2.4559073f)),
    mat4x4<f32>(vec4<f32>(-11.693587f, -2.831591f, -2.3943553f, -8.275588f), vec4<f32>(-7.1602225f, -0.7036662f, 2.2086513f, 3.6333103f), vec4<f32>(4.0300922f, 1.7700683f, 1.188168f, 7.4534593f), vec4<f32>(0.7538325f, -0.7767871f, 0.016310979f, 0.18021783f)),
    mat4x4<f32>(vec4<f32>(-1.3306596f, 1.8677293f, -4.101393f, -4.6770787f), vec4<f32>(0.19519782f, -0.48456788f, -0.20488237f, 0.021339769f), vec4<f32>(-0.010044715f, -0.031366363f, 0.050242912f, 0.015430227f), vec4<f32>(-4.2732124f, 1.70702f, 0.0028088223f, -0.010693944f)),
    mat4x4<f32>(vec4<f32>(-3.774896f, -1.1750406f, -0.93092984f, -0.049676165f), vec4<f32>(4.5747614f, -0.64899164f, -0.34892794f, -0.11725599f), vec4<f32>(-2.6529639f, -2.241756f, 1.2695652f, 0.121937424f), vec4<f32>(1.5011057f, 2.9329836f, -3.6110363f, -4.5134344f)),
    mat4x4<f32>(vec4<f32>(-4.6046376f, 3.0093236f, 4.978195f, 1.5529538f), vec4<f32>(-5.0088716f, 0.49800482f, 0.108492136f, 0.17909843f), vec4<f32>(0.19106047f, 0.006962222f, -0.0562687f, -0.05636758f), vec4<f32>(2.4868011f, -2.9974f, 1.1363013f, 0.8436937f)),
    mat4x4<f32>(vec4<f32>(-3.112934f, 2.7212074f, -0.7725423f, 2.895838f), vec4<f32>(-1.4298413f, 2.0517163f, -5.190096f, -2.2426555f), vec4<f32>(1.0851005f, 1.2990258f, 1.9417673f, -7.12554f), vec4<f32>(-1.7792232f, 0.8998802f, 0.6199238f, 1.7865978f)),
    mat4x4<f32>(vec4<f32>(-4.373691f, 7.469767f, 0.73178667f, 0.19036344f), vec4<f32>(0.18150902f, -0.09014448f, -0.10938936f, 0.30877957f), vec4<f32>(-0.00059860875f, -0.04931852f, -0.033257622f, 0.008763494f), vec4<f32>(0.013503743f, -1.9672016f, -3.3122485f, 2.5027857f)),
    mat4x4<f32>(vec4<f32>(-0.16557512f, -2.3265748f, 3.9967105f, 5.9642453f), vec4<f32>(4.2863545f, -0.5382311f, 1.9298717f, -1.1969867f), vec4<f32>(-1.3004589f, -0.5782102f, -3.2860882f, 0.18440095f), vec4<f32>(0.19718102f, -2.082068f, 1.6094493f, -3.5837553f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(2.0213919f, -2.91184f, 1.5348691f, -0.2929838f), vec4<f32>(1.3055472f, 0.27231f, -0.8899139f, -0.4409711f), vec4<f32>(0.11069353f, -1.8431019f, 0.17304926f, 0.8809019f), vec4<f32>(-5.399847f, -17.517437f, 0.47533467f, 6.2987537f)),
    mat4x4<f32>(vec4<f32>(0.419285f, -0.42110118f, 2.5071044f, -1.4210333f), vec4<f32>(-0.7503765f, 0.8864603f, 0.037235156f, 0.37260938f), vec4<f32>(0.6845067f, 0.44033587f, -0.28448498f, 0.24686478f), vec4<f32>(2.7418797f, 1.6742915f, 0.8079822f, -0.8698964f)),
    mat4x4<f32>(vec4<f32>(0.9036239f, -0.82326996f, -0.8262928f, -0.335104f), vec4<f32>(-0.41287225f, -0.55577654f, -1.3758198f, -0.18870488f), vec4<f32>(-0.63340414f, 0.42160872f, 0.7002752f, 2.267698f), vec4<f32>(-1.08188f, -3.98043f, -1.4021765f, 0.6892029f)),
    mat4x4<f32>(vec4<f32>(3.4161088f, 0.7640683f, 1.9327487f, 1.83947f), vec4<f32>(-5.0462413f, -0.713245f, -0.014138731f, -0.31107137f), vec4<f32>(1.3723212f, 2.744764f, -0.30109656f, -0.48658893f), vec4<f32>(0.26442823f, -1.2755157f, 0.42979032f, 0.022228852f)),
    mat4x4<f32>(vec4<f32>(0.9166541f, 2.8674293f, -2.7461586f, -0.11615238f), vec4<f32>(0.077809386f, -2.372911f, -0.1854338f, 0.5619069f), vec4<f32>(-1.2895492f, -0.69098186f, -1.6812513f, 0.17504105f), vec4<f32>(-1.556445f, 1.623512f, 1.1337266f, 2.044273f)),
    mat4x4<f32>(vec4<f32>(-0.8967381f, 2.4832838f, 0.3154895f, 0.5799579f), vec4<f32>(0.76742953f, -1.2556587f, 1.0351061f, 0.9519333f), vec4<f32>(0.7550382f, -0.7536835f, -8.745191f, -0.5979435f), vec4<f32>(-0.6330228f, -5.822986f, -24.325792f, 3.6463118f)),
    mat4x4<f32>(vec4<f32>(-0.16797684f, 1.0777332f, -0.6376268f, -0.33728403f), vec4<f32>(-1.061007f, 2.0483856f, 1.2846082f, -0.06528943f), vec4<f32>(-2.8672419f, -0.13821496f, -0.40658525f, -0.7010545f), vec4<f32>(0.73339987f, 0.85867685f, -2.980733f, -0.6767882f)),
    mat4x4<f32>(vec4<f32>(-0.17565668f, -0.66932446f, -0.087680444f, 0.82007885f), vec4<f32>(-0.81018645f, -5.083275f, 6.716149f, -2.5253572f), vec4<f32>(-0.21873666f, 1.6195232f, 0.10287789f, -0.7853111f), vec4<f32>(-0.8664899f, 1.8022391f, 0.12425704f, -0.12265211f)),
    mat4x4<f32>(vec4<f32>(-0.019619394f, -2.9439027f, 0.20967697f, -3.419845f), vec4<f32>(-3.0203755f, -0.17222819f, -0.21907517f, -0.1506443f), vec4<f32>(0.2171478f, -0.16118884f, -0.34547976f, 3.1116161f), vec4<f32>(0.59133464f, 0.16578314f, -0.26919577f, -17.852287f)),
    mat4x4<f32>(vec4<f32>(-1.9658519f, -0.026431112f, -0.32840747f, 2.9921103f), vec4<f32>(-3.432273f, 0.28572825f, -0.3039937f, -1.5232166f), vec4<f32>(-1.0966971f, -0.76801056f, 0.27018806f, 3.2838664f), vec4<f32>(-0.8133999f, -0.12406365f, -0.23587477f, 0.42709732f)),
    mat4x4<f32>(vec4<f32>(-6.489317f, 0.13252488f, -0.26811773f, 2.2592547f), vec4<f32>(-3.6722937f, 0.4313345f, 0.27116078f, -0.16659443f), vec4<f32>(0.10130279f, 0.19058819f, 0.043735087f, -3.4506261f), vec4<f32>(2.148812f, -1.1394475f, -0.23171818f, -2.8741112f)),
    mat4x4<f32>(vec4<f32>(0.6639304f, 3.6351647f, 0.15170369f, -0.9139982f), vec4<f32>(1.5778636f, -0.57759607f, -0.076416016f, -17.85372f), vec4<f32>(-2.942476f, -1.2473558f, -0.3413897f, 1.8454653f), vec4<f32>(-6.107756f, -0.2496649f, -0.2933674f, -0.3217662f)),
    mat4x4<f32>(vec4<f32>(0.27639863f, -0.020356344f, 0.20805937f, 5.0024533f), vec4<f32>(0.27502623f, 0.33333814f, -0.17369579f, 0.3428085f), vec4<f32>(0.2811654f, -0.09691671f, 0.3376751f, -4.3889575f), vec4<f32>(0.5050634f, 0.056959357f, 0.15600675f, 0.9328736f)),
    mat4x4<f32>(vec4<f32>(0.6798183f, 0.561105f, -0.29834086f, -1.388716f), vec4<f32>(0.93923146f, -0.38923523f, -0.0074161366f, -0.62310964f), vec4<f32>(-0.27356088f, -3.8132336f, -0.326761f, -3.2853408f), vec4<f32>(-0.17321798f, -10.054951f, 0.094018586f, -4.1044903f)),
    mat4x4<f32>(vec4<f32>(-2.9375002f, -1.5772644f, -0.028824203f, 0.39525685f), vec4<f32>(0.2538739f, 0.6404099f, -0.08917889f, -0.23136254f), vec4<f32>(-1.4123424f, 0.49519774f, -0.28288534f, -4.4888506f), vec4<f32>(-0.19552387f, 0.031744648f, -0.024117399f, 3.5014074f)),
    mat4x4<f32>(vec4<f32>(-6.388915f, 0.25000545f, -0.319836f, -0.93253845f), vec4<f32>(9.816028f, 2.536431f, 0.09538501f, -0.33083022f), vec4<f32>(-3.8032932f, 1.2661434f, -0.16308375f, -2.2764294f), vec4<f32>(1.7594389f, -0.51916075f, -0.13081738f, -2.6253278f)),
    mat4x4<f32>(vec4<f32>(1.9530706f, -1.8485831f, 0.2109906f, -0.25858083f), vec4<f32>(0.93915653f, 1.6989772f, 0.10935656f, 3.243871f), vec4<f32>(-1.668992f, 0.26239094f, -0.19926538f, -0.2640662f), vec4<f32>(-4.7925825f, -1.5411111f, -1.9145753f, 1.6478897f)),
    mat4x4<f32>(vec4<f32>(-0.35818458f, 1.2148889f, 0.3322431f, 2.009875f), vec4<f32>(-0.88717693f, 2.085225f, -0.059712175f, -0.7660865f), vec4<f32>(-5.2038116f, 1.1421809f, -0.069393694f, -1.2104797f), vec4<f32>(1.4166483f, 8.891604f, -0.19883786f, 2.5516102f)),
    mat4x4<f32>(vec4<f32>(-0.8331628f, -0.74940425f, -0.5258979f, -0.38192207f), vec4<f32>(-0.61086315f, -1.6954087f, 0.03969145f, 2.0987928f), vec4<f32>(0.17930607f, -0.91649634f, -0.14285758f, -1.7155297f), vec4<f32>(0.8023482f, 0.7970375f, 0.6197916f, -5.2210584f)),
    mat4x4<f32>(vec4<f32>(-2.5854452f, 5.9796576f, 0.61167616f, 0.4250337f), vec4<f32>(1.3043399f, 2.8135962f, -0.05531424f, -0.15286618f), vec4<f32>(1.3677459f, 2.6523335f, 0.37061626f, 0.8490703f), vec4<f32>(-0.28107482f, -19.692179f, -0.19836535f, -1.71023f)),
    mat4x4<f32>(vec4<f32>(1.2583504f, -0.7968344f, 0.369631f, 0.28707027f), vec4<f32>(0.32727537f, 0.16690618f, -0.3634363f, 0.88905156f), vec4<f32>(0.014350122f, -0.15114553f, 0.2937969f, 1.5788385f), vec4<f32>(-4.5339465f, -0.17390747f, -0.241532f, 0.70758146f)),
    mat4x4<f32>(vec4<f32>(-0.5519906f, 2.8230247f, 0.05278055f, 0.54575557f), vec4<f32>(-1.3154308f, 0.656429f, 0.7821612f, -9.275172f), vec4<f32>(1.1405544f, -2.1575017f, 1.4119513f, 0.7853599f), vec4<f32>(3.2076383f, -6.13053f, 15.256626f, -12.406102f)),
    mat4x4<f32>(vec4<f32>(1.2811682f, 0.083948754f, -0.37948f, -0.4940118f), vec4<f32>(-1.1444502f, -2.5660405f, -0.552346f, 0.1214361f), vec4<f32>(0.5068235f, -0.47298962f, 0.4408889f, -2.732477f), vec4<f32>(-0.5066367f, -0.8545023f, -0.51588374f, -1.2569976f)),
    mat4x4<f32>(vec4<f32>(0.5785463f, -32.425995f, 0.42408907f, 0.9343084f), vec4<f32>(-3.902431f, -0.7520251f, -0.06531561f, -4.5250793f), vec4<f32>(1.669008f, 1.2654543f, 0.5549053f, 3.3851264f), vec4<f32>(-0.31843388f, -0.1135918f, 0.2259276f, 3.8177497f)),
    mat4x4<f32>(vec4<f32>(1.9812528f, -0.36313337f, -0.7867708f, -1.8871622f), vec4<f32>(-0.3773511f, -0.16610058f, 1.1051798f, 1.2316991f), vec4<f32>(1.8488358f, -0.046805546f, -0.6921194f, -0.5387434f), vec4<f32>(0.3181373f, -0.18279947f, -1.689014f, 3.066741f)),
    mat4x4<f32>(vec4<f32>(-0.34661636f, -0.4327142f, 1.5718977f, -0.5606247f), vec4<f32>(-0.03964064f, -0.23198833f, 0.47888073f, -0.5954511f), vec4<f32>(-0.36834794f, -0.23371373f, 0.15666945f, 0.93414724f), vec4<f32>(-0.281857f, 0.20966858f, 8.412329f, 9.048968f)),
    mat4x4<f32>(vec4<f32>(-0.34866777f, -0.29574445f, 2.2201583f, 1.0108215f), vec4<f32>(2.1363382f, -0.027613534f, -1.1590986f, -0.66171604f), vec4<f32>(0.34671408f, 0.07055651f, -0.63689375f, -0.49965852f), vec4<f32>(-1.2961404f, -0.75858885f, 0.23002268f, 0.47372976f)),
    mat4x4<f32>(vec4<f32>(-0.008777903f, -0.58365583f, -7.097225f, -0.7343006f), vec4<f32>(-2.659016f, 0.31216386f, 0.68762773f, 0.2661025f), vec4<f32>(-1.6388949f, -0.17292544f, -0.52062505f, -0.22462904f), vec4<f32>(0.8361993f, -0.09593139f, -4.261884f, -0.79932857f)),
    mat4x4<f32>(vec4<f32>(-0.23727515f, -0.091116585f, 0.93601537f, -2.982952f), vec4<f32>(0.032420382f, -0.21857665f, -0.6826385f, 0.1599772f), vec4<f32>(0.47912702f, -0.3265304f, -0.20499313f, -1.6727635f), vec4<f32>(1.9387163f, -0.111314304f, -0.61201704f, 2.9126418f)),
    mat4x4<f32>(vec4<f32>(-0.80854404f, 0.07845742f, -2.8177385f, 0.109425806f), vec4<f32>(0.19731739f, -0.1832566f, 0.387768f, 0.2938763f), vec4<f32>(-1.713297f, 0.05192612f, -10.083423f, -0.7480528f), vec4<f32>(-8.829212f, -0.33925098f, -16.97128f, -2.5043054f)),
    mat4x4<f32>(vec4<f32>(-0.6140045f, -0.27008948f, -0.00565183f, 0.40399697f), vec4<f32>(1.3195682f, -0.2859485f, -0.6891265f, -0.010279318f), vec4<f32>(-0.27614084f, -0.34485704f, 1.0004749f, -2.5375779f), vec4<f32>(0.1936343f, -0.15814485f, -0.32213724f, -0.7124809f)),
    mat4x4<f32>(vec4<f32>(-1.5785738f, -0.5448545f, -7.9740224f, -0.3882083f), vec4<f32>(-1.0468239f, -0.4249315f, -0.3257484f, -0.8561734f), vec4<f32>(-0.07593948f, -0.07261215f, 0.73661035f, 0.53244424f), vec4<f32>(0.6394129f, -0.39995986f, -1.0125879f, -0.50449544f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(1.5403837f, -1.8343279f, -0.9217493f, 1.313698f),
    vec4<f32>(-7.616127f, 0.743722f, -0.04113058f, -1.5676365f),
    vec4<f32>(-1.6024822f, 0.326761f, -5.2702546f, -9.288301f),
    vec4<f32>(2.192788f, -0.38622347f, 1.562341f, -3.0405202f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.23133157f, 0.07465856f, 0.11972243f, -0.19268681f),
    vec4<f32>(0.34225202f, 0.15328355f, -0.12462099f, -0.17171375f),
    vec4<f32>(0.09308249f, 0.25963008f, -0.57784873f, 0.18180469f),
    vec4<f32>(0.15193784f, 0.23329662f, 0.12255926f, -0.111732274f)
);
const NMT_B3: f32 = -1.1533976f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat2x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = vec4<f32>(f[1].xyz, 1.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4<f32>(0.0f));
    let h1_4 = max(NMT_W1[8] * h0_0 + NMT_W1[9] * h0_1, vec4<f32>(0.0f));
    let h1_5 = max(NMT_W1[10] * h0_0 + NMT_W1[11] * h0_1, vec4<f32>(0.0f));
    let h1_6 = max(NMT_W1[12] * h0_0 + NMT_W1[13] * h0_1, vec4<f32>(0.0f));
    let h1_7 = max(NMT_W1[14] * h0_0 + NMT_W1[15] * h0_1, vec4<f32>(0.0f));
    let h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3 + NMT_W2[4] * h1_4 + NMT_W2[5] * h1_5 + NMT_W2[6] * h1_6 + NMT_W2[7] * h1_7, vec4<f32>(0.0f));
    let h2_1 = max(NMT_B2[1] + NMT_W2[8] * h1_0 + NMT_W2[9] * h1_1 + NMT_W2[10] * h1_2 + NMT_W2[11] * h1_3 + NMT_W2[12] * h1_4 + NMT_W2[13] * h1_5 + NMT_W2[14] * h1_6 + NMT_W2[15] * h1_7, vec4<f32>(0.0f));
    let h2_2 = max(NMT_B2[2] + NMT_W2[16] * h1_0 + NMT_W2[17] * h1_1 + NMT_W2[18] * h1_2 + NMT_W2[19] * h1_3 + NMT_W2[20] * h1_4 + NMT_W2[21] * h1_5 + NMT_W2[22] * h1_6 + NMT_W2[23] * h1_7, vec4<f32>(0.0f));
    let h2_3 = max(NMT_B2[3] + NMT_W2[24] * h1_0 + NMT_W2[25] * h1_1 + NMT_W2[26] * h1_2 + NMT_W2[27] * h1_3 + NMT_W2[28] * h1_4 + NMT_W2[29] * h1_5 + NMT_W2[30] * h1_6 + NMT_W2[31] * h1_7, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat2x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
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

// What cannot be seen needs no network. Two switches, each by itself; 0 turns one off. Colours are taken to lie in
// [0, 1].

// Pixels with b0 up to this are faint: no answer changes a channel by more than 1.923e-3, less than half a display step
// of 1/256.
const NMT_FAINT: f32 = 0.0625;

// Fragments that are hidden weigh no more than this, all of a pixel together: answered like the farthest, they change
// no channel by more than twice as much against exact answers of theirs, where the weights of the pixel (opacity times
// answer, what pass 2 adds up) sum to a half or more. Exact answers sum to 0.99 where one looks; a network's do not
// have to.
const NMT_HIDDEN: f32 = 0.00095;

// Moment depth from which on one looks for hidden fragments in a pixel; no depth reaches it where the pixel lets too
// much light through.
fn nmt_first_hidden_depth(b0: f32, b1: f32, b2: f32) -> f32 {
    let excess = b0 - 5.0;
    let deviation = sqrt(max(b2 * b0 - b1 * b1, 0.0) * 5.0 / max(excess, 1e-6));
    return select(3e38, (b1 + deviation) / max(b0, 1e-30), excess > 0.0);
}

// The most that a fragment and all behind it weigh, opacity times transmittance, whatever has these moments.
// Polynomials that are 0 or more in the pixel and 1 or more from the fragment on bound the share that lies there,
// rounding included.
fn nmt_hidden_weight(z: f32, absorbance: f32, z_nearest: f32, z_farthest: f32, n: f32, b0: f32, b: vec4<f32>) -> f32 {
    let c = 0.5 * (z_nearest + z_farthest);
    let others = clamp(b0 - absorbance, 0.0, 1e30);
    let per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
    let per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
    let m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
    let noise_growth = 1.0 + 2.0 * abs(c) * per_h;
    // What rounding may have done to moments and places.
    let unsure = (n + 16.0) * NMT_ROUNDING * b0 / max(others, 1e-30);
    let off = 2e-6 * per_h;
    let end = 1.0 + off;
    let x = clamp((z - c) * per_h, -1.0, 1.0) - off;
    // Cantelli's inequality.
    let ahead = x - m.x;
    let r1 = max(m.x - max(m.y - m.x * m.x, 0.0) / max(ahead, 1e-30), -1e6);
    let growth1 = noise_growth + abs(r1);
    let gap1 = x - r1;
    let share1 = (m.y - 2.0 * r1 * m.x + r1 * r1 + unsure * (growth1 * growth1)) / max(gap1 * gap1, 1e-30);
    // The quartic.
    let w1 = m.x - m.z;
    let below = w1 - x * (1.0 - m.y);
    let inner = (m.y - m.w - x * w1) / select(below, 1e-30, 1e-30 > abs(below));
    let outer = max(r1, -1.0);
    let inside = select(outer, inner, inner >= -end);
    let r = select(outer, inside, x > inside);
    let gap = x - r;
    let per_value = 1.0 / max((end + x) * (gap * gap), 1e-30);
    let end_gap = end - r;
    let gamma = 0.99999 * (1.0 - 1.0 / (2.0 * end * (end_gap * end_gap) * per_value)) / (end - x);
    let p0 = end * r * r;
    let p1 = r * r - 2.0 * r * end;
    let p2 = end - 2.0 * r;
    let lift = 1.0 + gamma * x;
    let value = p0 * lift + (p1 * lift - gamma * p0) * m.x + (p2 * lift - gamma * p1) * m.y + (lift - gamma * p2)
        * m.z - gamma * m.w;
    let growth2 = noise_growth + abs(r);
    let lost = unsure * (end + noise_growth) * (growth2 * growth2) * (1.0 + gamma * (abs(x) + noise_growth));
    let share2 = (value + lost) * per_value;
    let share = min(share1, share2) * 1.00001;
    let behind = select(1.0, select(1.0, max(share, 0.0), 1.0 > share), ahead > 0.0);
    let least_depth = others * (1.0 - behind) - ((n + 4.0) * NMT_ROUNDING * b0 + 1e-5);
    return exp(-least_depth) * min(others * behind + absorbance, n - 2.0);
}

// Pass 2, with the network for what can be seen: parameters and answers as of nmt_fragment_transmittance, but for faint
// pixels and hidden fragments. Pixels of up to four fragments have forms of their own.
fn nmt_visible_transmittance(v: f32, z: f32, absorbance: f32, nearest: f32, farthest: f32, z_nearest: f32,
    z_farthest: f32, n: f32, b0: f32, b: vec4<f32>) -> f32 {
    let others = clamp(b0 - absorbance, 0.0, 1e30);
    var front = -1.0;
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
    var answer = min(exp(-front), 1.0);
    if (front < 0.0) {
        answer = nmt_fragment_transmittance(v, z, absorbance, nearest, farthest, z_nearest, z_farthest, n, b0, b);
    }
    return answer;
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    sums0: vec4<f32>,
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    sums1: vec4<f32>,
    // (-v, v, 0, 0): blended by max, cleared to -3e38, so that it holds -nearest and farthest. Two channels, f32
    // always.
    range: vec4<f32>,
}

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
fn nmt_pass1(v: f32, v0: f32, v1: f32, alpha: f32) -> NmtSums {
    let absorbance = nmt_absorbance(alpha);
    let b = nmt_moments(nmt_moment_depth(v, v0, v1), absorbance);
    return NmtSums(vec4<f32>(absorbance, b.xyz), vec4<f32>(b.w, 1.0, 0.0, 0.0), vec4<f32>(-v, v, 0.0, 0.0));
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>, range: vec4<f32>) -> f32 {
    let nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, vec4<f32>(sums0.yzw,
        sums1.x));
}

// As nmt_pass2, without the network for what cannot be seen; see nmt_visible_transmittance.
fn nmt_visible_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>,
    range: vec4<f32>) -> f32 {
    let nearest = -range.x;
    return nmt_visible_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, vec4<f32>(sums0.yzw,
        sums1.x));
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}
