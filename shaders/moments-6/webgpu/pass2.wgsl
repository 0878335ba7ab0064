// WebGPU, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
// Neural moment transparency: network 'moments-6', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset 37f23ca23c85cddd29cc28c82e42ad387652d607b62fdde6a7e9a18fca6b8f75.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.305e-3, worst 0.995.

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
fn nmt_moments(z: f32, absorbance: f32) -> mat2x4<f32> {
    let moment1 = absorbance * z;
    let moment2 = moment1 * z;
    let moment3 = moment2 * z;
    let moment4 = moment3 * z;
    let moment5 = moment4 * z;
    let moment6 = moment5 * z;
    return mat2x4<f32>(vec4<f32>(moment1, moment2, moment3, moment4), vec4<f32>(moment5, moment6, 0.0, 0.0));
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
fn nmt_recentred_moments(z: f32, absorbance: f32, c: f32, per_h: f32, per_b0: f32, b: mat2x4<f32>) -> mat2x4<f32> {
    let own = nmt_moments(z, absorbance);
    let m1 = (b[0].x - own[0].x) * per_b0;
    let m2 = (b[0].y - own[0].y) * per_b0;
    let m3 = (b[0].z - own[0].z) * per_b0;
    let m4 = (b[0].w - own[0].w) * per_b0;
    let m5 = (b[1].x - own[1].x) * per_b0;
    let m6 = (b[1].y - own[1].y) * per_b0;
    // Moments of z - c, one factor at a time.
    let m6_2 = m6 - c * m5;
    let m5_2 = m5 - c * m4;
    let m4_2 = m4 - c * m3;
    let m3_2 = m3 - c * m2;
    let m2_2 = m2 - c * m1;
    let m1_2 = m1 - c;
    let m6_3 = m6_2 - c * m5_2;
    let m5_3 = m5_2 - c * m4_2;
    let m4_3 = m4_2 - c * m3_2;
    let m3_3 = m3_2 - c * m2_2;
    let m2_3 = m2_2 - c * m1_2;
    let m6_4 = m6_3 - c * m5_3;
    let m5_4 = m5_3 - c * m4_3;
    let m4_4 = m4_3 - c * m3_3;
    let m3_4 = m3_3 - c * m2_3;
    let m6_5 = m6_4 - c * m5_4;
    let m5_5 = m5_4 - c * m4_4;
    let m4_5 = m4_4 - c * m3_4;
    let m6_6 = m6_5 - c * m5_5;
    let m5_6 = m5_5 - c * m4_5;
    let m6_7 = m6_6 - c * m5_6;
    let per_h2 = per_h * per_h;
    let per_h3 = per_h2 * per_h;
    let per_h4 = per_h2 * per_h2;
    return mat2x4<f32>(vec4<f32>(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4
        * per_h3, -1.0, 1.0), clamp(m4_5 * per_h4, -1.0, 1.0)), vec4<f32>(clamp(m5_6 * per_h4 * per_h, -1.0, 1.0),
        clamp(m6_7 * per_h4 * per_h2, -1.0, 1.0), 0.0, 0.0));
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

const NMT_W1 = array<mat4x4<f32>, 24>(
    mat4x4<f32>(vec4<f32>(-6.111781f, 1.2590787f, 0.5475349f, -1.2606547f), vec4<f32>(-0.9432912f, -0.027208287f, -0.30223295f, -0.008989807f), vec4<f32>(0.10382608f, 0.04081687f, 0.00517731f, 0.13695489f), vec4<f32>(0.5247361f, 7.551865f, -1.6350569f, 7.4871354f)),
    mat4x4<f32>(vec4<f32>(-1.2694472f, -9.020549f, -6.307308f, 0.1156755f), vec4<f32>(-0.5863311f, -6.3508167f, 2.2088974f, -0.95557034f), vec4<f32>(2.519586f, -4.0575604f, 6.3729653f, -1.4507685f), vec4<f32>(0.05811975f, -0.25461668f, -0.4064348f, -0.41226965f)),
    mat4x4<f32>(vec4<f32>(-1.603955f, -0.63644004f, 0.49392483f, 1.1919441f), vec4<f32>(-5.366019f, 2.9462543f, -0.4136076f, -3.124585f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-2.7355766f, 1.0036091f, -2.8403323f, -4.795097f), vec4<f32>(0.024920808f, -0.23226534f, 0.5254088f, 0.11377028f), vec4<f32>(0.13349196f, 0.07365853f, 0.20932944f, 0.016179072f), vec4<f32>(-1.6250459f, -4.8359137f, -0.08537557f, -0.19261461f)),
    mat4x4<f32>(vec4<f32>(0.13225362f, 2.89904f, -3.04994f, 0.36533222f), vec4<f32>(4.800494f, 3.977632f, -0.61880076f, 0.12900063f), vec4<f32>(-1.0653358f, -3.289986f, 2.3399897f, -0.22318892f), vec4<f32>(-2.6758354f, 0.62541056f, -0.4392313f, 0.027572617f)),
    mat4x4<f32>(vec4<f32>(5.42803f, 0.50919867f, -1.5685683f, -0.007823314f), vec4<f32>(-4.863298f, 1.7043099f, -0.4714574f, -4.861206f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.13962865f, 1.5440083f, 3.000412f, 3.4353843f), vec4<f32>(-0.57095677f, -0.061338373f, 0.2472489f, 0.19988087f), vec4<f32>(-0.32642198f, 0.0010412352f, -0.021046346f, -0.012095685f), vec4<f32>(0.24782896f, 2.2739713f, 5.3219786f, -4.776767f)),
    mat4x4<f32>(vec4<f32>(-0.47955763f, -0.82601726f, 4.6288095f, -2.1269662f), vec4<f32>(-0.6476124f, -9.601333f, -3.9761598f, 0.89417446f), vec4<f32>(-0.0847439f, 4.3309703f, 1.7938333f, 0.48631155f), vec4<f32>(0.4469387f, 8.027626f, -1.1833122f, 0.0064941095f)),
    mat4x4<f32>(vec4<f32>(-0.49138308f, -2.9760563f, -0.9328496f, 0.8670376f), vec4<f32>(-0.87651825f, 0.64863366f, -5.0546846f, 2.3387825f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.5760229f, 4.533266f, -1.6427152f, -1.4796346f), vec4<f32>(-0.07957402f, -0.33262858f, 0.39887205f, -0.07089995f), vec4<f32>(-0.014048754f, -0.053987775f, -0.08135598f, -0.000117340634f), vec4<f32>(-0.11836353f, 0.44236583f, 3.952692f, -0.06623836f)),
    mat4x4<f32>(vec4<f32>(-1.128837f, -0.3080469f, -5.6531177f, -1.2193537f), vec4<f32>(-0.6106688f, -2.1997905f, -4.896287f, 2.2838867f), vec4<f32>(5.117241f, 6.327744f, 3.4865515f, 3.0882306f), vec4<f32>(1.010223f, 0.340252f, -0.53299254f, -1.0834862f)),
    mat4x4<f32>(vec4<f32>(-5.1776967f, 0.98614454f, 1.1521934f, -6.7103496f), vec4<f32>(-3.1058083f, -2.119367f, -1.3814752f, 1.0148283f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.9691913f, 3.6027002f, 3.4038823f, -1.4982073f), vec4<f32>(-0.09721829f, 0.7538304f, 0.11502148f, -0.36653677f), vec4<f32>(0.069223955f, -0.050337084f, 0.05156069f, 0.00126499f), vec4<f32>(4.8298807f, -1.5281683f, -6.356912f, 1.9819074f)),
    mat4x4<f32>(vec4<f32>(-9.021647f, 2.6192272f, -8.228654f, -3.639272f), vec4<f32>(-4.886636f, -1.1694726f, 0.33833027f, 3.7475548f), vec4<f32>(5.3034215f, 1.6796954f, 4.7872767f, 4.596024f), vec4<f32>(-1.2544109f, 2.2807274f, -0.3591253f, -0.5454767f)),
    mat4x4<f32>(vec4<f32>(1.7421607f, 1.9923266f, -0.03349984f, -0.19245246f), vec4<f32>(0.29631603f, 0.41034484f, 0.5748713f, -0.49153104f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.2280331f, 3.3868275f, -2.665127f, -0.74408203f), vec4<f32>(0.043601274f, -0.4817103f, -0.18844081f, -0.06487209f), vec4<f32>(0.012015421f, -0.026456503f, 0.008891798f, 0.0075397766f), vec4<f32>(-4.4597335f, 1.201724f, 1.7545215f, 2.532967f)),
    mat4x4<f32>(vec4<f32>(3.5101607f, -1.9561962f, -1.3536254f, -2.4960887f), vec4<f32>(3.8059118f, -0.80123705f, -7.3587255f, -8.631405f), vec4<f32>(2.9984262f, 0.8873145f, 0.38955295f, 5.230721f), vec4<f32>(-0.08283735f, -0.27585363f, 5.9716625f, 6.624569f)),
    mat4x4<f32>(vec4<f32>(-0.40433055f, 0.029642176f, 2.079507f, -3.0390704f), vec4<f32>(-2.4578543f, 3.7255483f, -2.189978f, -0.87685984f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.262312f, 2.3860085f, 6.7077255f, 1.7991533f), vec4<f32>(-0.16270845f, 0.032198705f, -0.05943885f, -0.3940928f), vec4<f32>(0.058438443f, 0.015088889f, -0.042749982f, 0.07342043f), vec4<f32>(-0.7669092f, -2.3534462f, 0.99614793f, 2.8025775f)),
    mat4x4<f32>(vec4<f32>(-0.9087242f, 3.0325496f, -1.396636f, -1.098918f), vec4<f32>(3.3784263f, 6.4511676f, -6.228715f, -4.159704f), vec4<f32>(0.8494316f, -2.7000678f, 2.0243857f, -5.193673f), vec4<f32>(0.20995937f, -4.190236f, -0.61862284f, -0.02107041f)),
    mat4x4<f32>(vec4<f32>(0.12992106f, 0.29974172f, -0.70772874f, -0.85352206f), vec4<f32>(0.72485054f, 2.2938392f, 1.3125209f, 4.1111984f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-5.3910193f, 5.217595f, 3.4597962f, 1.1132557f), vec4<f32>(0.0527404f, -0.22649224f, 0.2102456f, -0.04448421f), vec4<f32>(0.02741702f, -0.05801576f, -0.004462379f, 0.038614187f), vec4<f32>(0.07164862f, -1.0982728f, 1.1179584f, 4.9506955f)),
    mat4x4<f32>(vec4<f32>(-0.22796391f, -6.7252426f, 5.3008366f, -4.017342f), vec4<f32>(5.2988577f, 1.8783277f, -1.299335f, -4.2415414f), vec4<f32>(-1.6573465f, 3.03367f, 0.923951f, -3.392957f), vec4<f32>(0.03842112f, 0.5970927f, 0.58665645f, 0.46000332f)),
    mat4x4<f32>(vec4<f32>(-0.08871091f, 0.49993217f, -2.3402717f, 1.2996048f), vec4<f32>(0.29164585f, -0.08348722f, 0.049777083f, 2.3808312f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(-2.992966f, -2.858956f, -4.254115f, -0.22101966f), vec4<f32>(1.8619783f, -1.7560344f, 0.18683062f, 0.71421546f), vec4<f32>(-0.9313739f, 4.859132f, 0.6138396f, 0.49655724f), vec4<f32>(-0.37038225f, 0.020796178f, 0.7491361f, 0.8727151f)),
    mat4x4<f32>(vec4<f32>(0.36748806f, -0.7872776f, -3.911794f, 0.009744219f), vec4<f32>(-1.1042612f, 3.0573065f, 0.22637399f, 0.12707636f), vec4<f32>(0.9925066f, -0.4076182f, 0.97743005f, 0.30577096f), vec4<f32>(7.2628703f, -21.080715f, -4.972773f, -3.7080753f)),
    mat4x4<f32>(vec4<f32>(0.71003896f, -0.057421677f, -0.7333687f, -0.1349236f), vec4<f32>(-3.0351005f, -0.025662167f, 5.439921f, 1.1083124f), vec4<f32>(-1.2842412f, -0.40064743f, 2.132936f, 0.4587207f), vec4<f32>(-0.4143241f, 3.001643f, 0.0988189f, -0.26960135f)),
    mat4x4<f32>(vec4<f32>(0.91364557f, 0.14445628f, -8.310524f, -0.065409906f), vec4<f32>(-3.2332554f, -2.9022744f, -15.36157f, 0.50497496f), vec4<f32>(0.8229345f, -2.064584f, 0.12143615f, -0.10263531f), vec4<f32>(0.054719314f, 2.4150016f, 1.2882204f, 1.110596f)),
    mat4x4<f32>(vec4<f32>(-0.6192766f, 3.047318f, -0.96840745f, 0.2605519f), vec4<f32>(-1.2917666f, -2.2279055f, -1.8872515f, 0.68316597f), vec4<f32>(0.109164976f, 2.52896f, 0.8579186f, 0.15905996f), vec4<f32>(-0.69663775f, 1.246913f, -0.710606f, 0.92853165f)),
    mat4x4<f32>(vec4<f32>(0.9062126f, 1.0490677f, 1.9008839f, -1.0397452f), vec4<f32>(1.6107726f, -1.0856603f, 1.346723f, 0.993593f), vec4<f32>(1.7179087f, 0.22983813f, -3.5189588f, -1.0520781f), vec4<f32>(2.4576623f, 0.5125091f, -6.4215956f, -0.5380803f)),
    mat4x4<f32>(vec4<f32>(0.3615602f, -4.6017222f, -0.14912221f, 0.4948515f), vec4<f32>(-0.63468134f, -9.653261f, -1.9091142f, -0.03045894f), vec4<f32>(-2.565982f, -2.7410276f, -8.579719f, -1.8886751f), vec4<f32>(0.37309378f, -0.7666512f, 0.9897772f, -0.053876042f)),
    mat4x4<f32>(vec4<f32>(0.14261079f, -2.7428598f, 0.71818084f, 0.079738714f), vec4<f32>(1.1686169f, 2.7973378f, -12.209488f, -1.3224617f), vec4<f32>(-0.10436231f, 3.5554519f, -1.8719939f, -0.083544716f), vec4<f32>(0.37562165f, -2.0031798f, -1.140298f, 1.4245508f)),
    mat4x4<f32>(vec4<f32>(0.07020887f, -7.7853203f, 3.2623754f, -0.9289991f), vec4<f32>(-0.41948175f, 0.91524047f, -0.09373543f, 3.1709063f), vec4<f32>(1.707971f, 0.79446125f, 0.14929785f, 2.5686665f), vec4<f32>(-0.056600675f, -0.1659347f, 5.8103175f, -1.8952311f)),
    mat4x4<f32>(vec4<f32>(-4.786343f, 1.030607f, 0.3021604f, -0.21997102f), vec4<f32>(2.4703267f, 1.123544f, 2.1217737f, -0.52224094f), vec4<f32>(-2.2712877f, 0.5158962f, 0.3472931f, 1.4640517f), vec4<f32>(0.11313607f, -13.780107f, 8.568549f, -13.411448f)),
    mat4x4<f32>(vec4<f32>(-0.04082529f, 0.1669218f, 0.46733433f, -0.36587787f), vec4<f32>(0.34007803f, 1.5025666f, -1.0191387f, -2.497706f), vec4<f32>(5.29306f, -0.110161185f, -0.45350894f, -2.687117f), vec4<f32>(1.1021147f, -0.042523265f, -8.089456f, -1.1886902f)),
    mat4x4<f32>(vec4<f32>(0.3839846f, 1.6447116f, -2.4580069f, -0.70252365f), vec4<f32>(0.26104167f, -0.5908336f, 0.026685795f, -1.7847142f), vec4<f32>(-5.2497396f, -0.5974036f, -3.9859402f, 1.2823159f), vec4<f32>(-2.8455558f, 1.4684895f, 0.58783984f, 0.48113063f)),
    mat4x4<f32>(vec4<f32>(0.16200472f, 0.6974124f, -0.056665666f, 5.1168947f), vec4<f32>(-1.1185981f, 0.28122574f, -1.1758981f, -0.2487846f), vec4<f32>(-0.40818137f, 0.45375705f, 0.3172075f, -2.4046204f), vec4<f32>(-3.1995828f, 1.259068f, 1.8805319f, 2.4689593f)),
    mat4x4<f32>(vec4<f32>(-1.3353378f, 0.63000417f, 0.38511258f, 2.2301257f), vec4<f32>(0.2802323f, -0.1214043f, 0.15000337f, -1.1558938f), vec4<f32>(0.71096516f, -1.684167f, -0.530025f, -0.8572137f), vec4<f32>(-3.2262592f, -0.68959f, 2.0129254f, 4.257681f)),
    mat4x4<f32>(vec4<f32>(-19.512064f, -0.18027107f, -3.1857862f, -0.6899437f), vec4<f32>(-0.3005064f, -0.34270313f, -0.42363968f, -5.0216107f), vec4<f32>(-2.4683843f, 0.21464697f, 1.3507403f, -2.8129263f), vec4<f32>(-0.07548671f, -0.8579342f, -1.1152614f, 3.2826817f)),
    mat4x4<f32>(vec4<f32>(-12.441226f, -1.5329676f, -0.020585677f, -1.3522521f), vec4<f32>(6.684407f, -1.0653955f, 2.805359f, -5.174105f), vec4<f32>(-1.2013803f, -0.14954259f, 1.1032336f, -2.7582016f), vec4<f32>(-1.0236809f, -0.6934412f, 0.20977055f, -0.44141737f)),
    mat4x4<f32>(vec4<f32>(-0.08507485f, -3.0545528f, 0.096640795f, -2.997112f), vec4<f32>(0.016383547f, -0.38022602f, -0.32512355f, -2.9064112f), vec4<f32>(-0.18832994f, -2.7187495f, -0.30681947f, 3.0764172f), vec4<f32>(0.032234084f, -0.674778f, -0.26126426f, -0.7389055f)),
    mat4x4<f32>(vec4<f32>(-0.30429694f, -5.9502687f, -0.25058585f, -0.56996036f), vec4<f32>(-0.44421595f, 1.3879135f, -0.46375105f, -1.5739975f), vec4<f32>(-0.5096615f, 1.5734165f, -0.22679868f, 0.034422264f), vec4<f32>(-0.30219105f, -18.450062f, -0.06314865f, -11.160464f)),
    mat4x4<f32>(vec4<f32>(-0.02603846f, 0.30140403f, 0.2238884f, -0.4666892f), vec4<f32>(-0.029553855f, 1.2880361f, 0.108896896f, -2.0154498f), vec4<f32>(-0.14497134f, 0.71481055f, -0.06489657f, 1.5688689f), vec4<f32>(-0.43832225f, 1.1543839f, -0.74085f, 1.265431f)),
    mat4x4<f32>(vec4<f32>(0.17543544f, -4.287299f, 0.035343643f, 2.50911f), vec4<f32>(0.15206087f, 0.5505871f, -0.5673676f, -2.6335747f), vec4<f32>(-0.2942823f, -2.0406406f, 0.12456984f, -1.7555345f), vec4<f32>(-0.01804171f, 4.622501f, -0.11310927f, 3.5968187f)),
    mat4x4<f32>(vec4<f32>(-0.24732798f, 0.020867135f, 0.11910821f, -0.59342366f), vec4<f32>(-0.24452622f, -0.71158904f, -0.73464835f, 0.033891715f), vec4<f32>(0.060986243f, 0.14190178f, 0.103602394f, -0.3242666f), vec4<f32>(-0.32296723f, -2.1236103f, -0.11954761f, -0.5252579f)),
    mat4x4<f32>(vec4<f32>(-0.22450684f, -2.814268f, -0.18150029f, 1.3641322f), vec4<f32>(0.027793886f, -0.5324461f, -0.20759605f, -2.3197892f), vec4<f32>(0.04657861f, 1.1140198f, 0.24319865f, -9.763681f), vec4<f32>(-0.35169291f, -1.7075313f, -0.068953544f, -9.342775f)),
    mat4x4<f32>(vec4<f32>(-0.4123966f, -5.300227f, -0.0910799f, -2.8317666f), vec4<f32>(-0.287858f, 0.46392447f, -0.16798578f, 0.6952194f), vec4<f32>(-0.1862946f, -0.63765377f, -0.69623035f, 2.604372f), vec4<f32>(-0.33906487f, -0.5565427f, -0.42190912f, -0.23940141f)),
    mat4x4<f32>(vec4<f32>(-0.12144742f, -20.892881f, -0.4145004f, 1.2375941f), vec4<f32>(-0.697824f, 1.987435f, -0.5976051f, 4.402753f), vec4<f32>(-0.20529044f, -0.3576681f, -0.21677442f, -0.24279527f), vec4<f32>(-0.08807971f, 2.9789166f, 0.071931176f, -2.929071f)),
    mat4x4<f32>(vec4<f32>(-2.6315901f, -0.34439078f, -2.9610267f, -1.0923961f), vec4<f32>(0.223164f, 1.8039895f, 2.5519726f, -0.9711679f), vec4<f32>(-0.24532005f, -2.3492897f, -1.4704975f, 0.76217866f), vec4<f32>(0.36889645f, -0.115326025f, 0.35473856f, -0.20498301f)),
    mat4x4<f32>(vec4<f32>(-0.88672864f, -0.39859805f, 2.39492f, 1.744944f), vec4<f32>(-0.69307685f, -0.99920523f, 4.2183623f, -0.87868303f), vec4<f32>(0.35942724f, -0.29691926f, 1.0818437f, 1.3207207f), vec4<f32>(-30.2384f, 0.10928893f, -7.0647554f, 15.717544f)),
    mat4x4<f32>(vec4<f32>(-0.20164908f, -0.19088599f, 0.1551302f, 0.04737597f), vec4<f32>(-0.81887734f, -3.1323016f, -2.7505014f, -1.5834199f), vec4<f32>(-0.14424095f, -1.555143f, -4.6802588f, -1.3235509f), vec4<f32>(-0.25277188f, -0.4647671f, 1.6973499f, -0.99667746f)),
    mat4x4<f32>(vec4<f32>(0.78845274f, 0.7655463f, 3.7973511f, 3.320911f), vec4<f32>(-1.2283723f, -4.476903f, -3.5822878f, -3.721869f), vec4<f32>(0.46523815f, 0.041043233f, 2.1500504f, 1.4796671f), vec4<f32>(-4.0602994f, 2.0099647f, 0.85182285f, -0.7933596f)),
    mat4x4<f32>(vec4<f32>(0.35618836f, -0.5405226f, -0.8827116f, 1.0714078f), vec4<f32>(1.0268298f, -0.2317349f, -2.412876f, -1.5990334f), vec4<f32>(0.2031206f, -0.9403622f, 1.6003618f, -1.0273224f), vec4<f32>(0.9049673f, 0.47973f, -1.1511244f, 0.058414135f)),
    mat4x4<f32>(vec4<f32>(1.9166514f, 1.426175f, -1.1536136f, 1.3503083f), vec4<f32>(2.6654356f, -2.2231581f, 0.58408207f, 2.110834f), vec4<f32>(-0.79796445f, -3.0819988f, 0.9331857f, 0.02824189f), vec4<f32>(1.5963962f, 7.198678f, 2.0963554f, 2.8723466f)),
    mat4x4<f32>(vec4<f32>(-1.2596036f, 0.631166f, -11.672623f, -0.5510185f), vec4<f32>(-1.0386657f, -3.2057896f, -2.1611688f, -1.6124867f), vec4<f32>(-0.38434005f, -3.9630258f, -1.478051f, -2.4563847f), vec4<f32>(1.4227921f, 1.0508367f, 1.2534283f, 0.904385f)),
    mat4x4<f32>(vec4<f32>(-0.8039124f, -1.2763106f, -23.93499f, 0.287792f), vec4<f32>(-1.8194247f, -1.8709297f, 1.4603959f, 0.10037173f), vec4<f32>(-0.9812876f, -2.6164715f, -0.132473f, -1.9431459f), vec4<f32>(-1.5269586f, -0.5822796f, 1.6227671f, -0.8949245f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(1.2619187f, -2.5986087f, -2.149382f, 1.3353654f),
    vec4<f32>(-4.6729555f, 3.27779f, -12.580061f, -0.2602885f),
    vec4<f32>(-0.13580789f, 0.6970699f, -0.15496458f, 0.740331f),
    vec4<f32>(-0.12114108f, 1.2450967f, -2.2606373f, -0.36267692f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.20100085f, 0.17548272f, 0.09926478f, -0.21060409f),
    vec4<f32>(0.18316391f, 0.13202123f, -0.10359111f, -0.18595253f),
    vec4<f32>(0.5044715f, 0.1379622f, -0.045420256f, 0.09471249f),
    vec4<f32>(0.13760756f, 0.21741933f, 0.2403533f, -0.21945743f)
);
const NMT_B3: f32 = -0.117446944f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat3x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = f[1];
    let h0_2 = vec4<f32>(f[2].x, 1.0f, 0.0f, 0.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4<f32>(0.0f));
    let h1_4 = max(NMT_W1[12] * h0_0 + NMT_W1[13] * h0_1 + NMT_W1[14] * h0_2, vec4<f32>(0.0f));
    let h1_5 = max(NMT_W1[15] * h0_0 + NMT_W1[16] * h0_1 + NMT_W1[17] * h0_2, vec4<f32>(0.0f));
    let h1_6 = max(NMT_W1[18] * h0_0 + NMT_W1[19] * h0_1 + NMT_W1[20] * h0_2, vec4<f32>(0.0f));
    let h1_7 = max(NMT_W1[21] * h0_0 + NMT_W1[22] * h0_1 + NMT_W1[23] * h0_2, vec4<f32>(0.0f));
    let h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3 + NMT_W2[4] * h1_4 + NMT_W2[5] * h1_5 + NMT_W2[6] * h1_6 + NMT_W2[7] * h1_7, vec4<f32>(0.0f));
    let h2_1 = max(NMT_B2[1] + NMT_W2[8] * h1_0 + NMT_W2[9] * h1_1 + NMT_W2[10] * h1_2 + NMT_W2[11] * h1_3 + NMT_W2[12] * h1_4 + NMT_W2[13] * h1_5 + NMT_W2[14] * h1_6 + NMT_W2[15] * h1_7, vec4<f32>(0.0f));
    let h2_2 = max(NMT_B2[2] + NMT_W2[16] * h1_0 + NMT_W2[17] * h1_1 + NMT_W2[18] * h1_2 + NMT_W2[19] * h1_3 + NMT_W2[20] * h1_4 + NMT_W2[21] * h1_5 + NMT_W2[22] * h1_6 + NMT_W2[23] * h1_7, vec4<f32>(0.0f));
    let h2_3 = max(NMT_B2[3] + NMT_W2[24] * h1_0 + NMT_W2[25] * h1_1 + NMT_W2[26] * h1_2 + NMT_W2[27] * h1_3 + NMT_W2[28] * h1_4 + NMT_W2[29] * h1_5 + NMT_W2[30] * h1_6 + NMT_W2[31] * h1_7, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
fn nmt_fragment_transmittance(v: f32, z: f32, absorbance: f32, nearest: f32, farthest: f32, z_nearest: f32,
    z_farthest: f32, n: f32, b0: f32, b: mat2x4<f32>) -> f32 {
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
                let mean0 = nmt_shrink_to_prior(m[0].x, 0.0, noise1, 0.22 + 0.7 * per_n);
                front = others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0);
                if (n != 3.0) {
                    let x = select(clamp((z - c) * per_h, -1.0, 1.0), nmt_place_in_thin(v, nearest, farthest), 0.01
                        > (farthest - nearest) / nearest);
                    let further = noise_growth * 0.87;
                    let noise2 = noise1 * further;
                    let noise3 = noise2 * further;
                    let most0 = max(1.0 - mean0 * mean0, 1e-6);
                    let raw_spread0 = clamp((m[0].y - mean0 * mean0) / most0, 0.0, 1.0);
                    let spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5
                        * per_n);
                    // The same of (1 - x^2) times the measure, which does not hold the ends.
                    let per_mass1 = 1.0 / max(1.0 - m[0].y, 1e-6);
                    let raw_mean1 = clamp((m[0].x - m[0].z) * per_mass1, -1.0, 1.0);
                    let expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
                    let deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
                    let noise = noise3 * per_mass1;
                    let all_noise = noise + 9.536743e-7 * per_mass1;
                    let mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
                    let transition_width = all_noise * deviation / (all_noise + deviation);
                    front = others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width);
                    if (n != 4.0) {
                        let most1 = max(1.0 - mean1 * mean1, 1e-6);
                        let raw_square1 = clamp(((m[0].y - m[0].w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
                        let offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
                        let square0 = spread0 * spread0;
                        let expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset
                            * offset) * spread0 / (1.0 + spread0 + spread0), 0.0, 1.0);
                        let spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further
                            * per_mass1 / most1, (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
                        let q0 = 1.0 - m[0].y;
                        let q1 = m[0].x - m[0].z;
                        let q2 = m[0].y - m[0].w;
                        let q3 = m[0].z - m[1].x;
                        let q4 = m[0].w - m[1].y;
                        let q0_2 = q0 - q2;
                        let q1_2 = q1 - q3;
                        let q2_2 = q2 - q4;
                        let per_mass2 = 1.0 / max(q0_2, 1e-6);
                        let raw_mean2 = clamp(q1_2 * per_mass2, -1.0, 1.0);
                        let noise_2 = moment_noise * noise_growth * noise_growth * noise_growth * noise_growth;
                        let rounded = noise_2 * per_mass2;
                        let mean2 = raw_mean2 * (1.0 / (1.0 + rounded * rounded));
                        let rounded_2 = noise_2 * noise_growth * per_mass2;
                        let spread2 = 0.5 + (sqrt(clamp((q2_2 * per_mass2 - raw_mean2 * raw_mean2) / max(1.0
                            - raw_mean2 * raw_mean2, 1e-6), 0.0, 1.0)) - 0.5) * (1.0 / (1.0 + rounded_2 * rounded_2));
                        front = others * nmt_share(mat3x4<f32>(vec4<f32>(x, log(n) * 0.48089835 - 1.0, log(others
                            + 0.05), mean0), vec4<f32>(spread0, mean1, spread1, mean2), vec4<f32>(spread2, 0.0, 0.0,
                            0.0)));
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
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.w, sums0.x,
        mat2x4<f32>(vec4<f32>(sums0.yzw, sums1.x), vec4<f32>(sums1.yz, 0.0, 0.0)));
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
