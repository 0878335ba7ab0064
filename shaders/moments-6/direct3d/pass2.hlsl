// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1.
//
// Neural moment transparency: network 'moments-6', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset 37f23ca23c85cddd29cc28c82e42ad387652d607b62fdde6a7e9a18fca6b8f75.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.305e-3, worst 0.995.

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
float2x4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    float moment5 = moment4 * z;
    float moment6 = moment5 * z;
    return float2x4(float4(moment1, moment2, moment3, moment4), float4(moment5, moment6, 0.0, 0.0));
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
float2x4 nmt_recentred_moments(float z, float absorbance, float c, float per_h, float per_b0, float2x4 b) {
    float2x4 own = nmt_moments(z, absorbance);
    float m1 = (b[0].x - own[0].x) * per_b0;
    float m2 = (b[0].y - own[0].y) * per_b0;
    float m3 = (b[0].z - own[0].z) * per_b0;
    float m4 = (b[0].w - own[0].w) * per_b0;
    float m5 = (b[1].x - own[1].x) * per_b0;
    float m6 = (b[1].y - own[1].y) * per_b0;
    // Moments of z - c, one factor at a time.
    float m6_2 = m6 - c * m5;
    float m5_2 = m5 - c * m4;
    float m4_2 = m4 - c * m3;
    float m3_2 = m3 - c * m2;
    float m2_2 = m2 - c * m1;
    float m1_2 = m1 - c;
    float m6_3 = m6_2 - c * m5_2;
    float m5_3 = m5_2 - c * m4_2;
    float m4_3 = m4_2 - c * m3_2;
    float m3_3 = m3_2 - c * m2_2;
    float m2_3 = m2_2 - c * m1_2;
    float m6_4 = m6_3 - c * m5_3;
    float m5_4 = m5_3 - c * m4_3;
    float m4_4 = m4_3 - c * m3_3;
    float m3_4 = m3_3 - c * m2_3;
    float m6_5 = m6_4 - c * m5_4;
    float m5_5 = m5_4 - c * m4_4;
    float m4_5 = m4_4 - c * m3_4;
    float m6_6 = m6_5 - c * m5_5;
    float m5_6 = m5_5 - c * m4_5;
    float m6_7 = m6_6 - c * m5_6;
    float per_h2 = per_h * per_h;
    float per_h3 = per_h2 * per_h;
    float per_h4 = per_h2 * per_h2;
    return float2x4(float4(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3,
        -1.0, 1.0), clamp(m4_5 * per_h4, -1.0, 1.0)), float4(clamp(m5_6 * per_h4 * per_h, -1.0, 1.0), clamp(m6_7
        * per_h4 * per_h2, -1.0, 1.0), 0.0, 0.0));
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

static const float4x4 NMT_W1[24] = {
    float4x4(float4(-6.111781f, 1.2590787f, 0.5475349f, -1.2606547f), float4(-0.9432912f, -0.027208287f, -0.30223295f, -0.008989807f), float4(0.10382608f, 0.04081687f, 0.00517731f, 0.13695489f), float4(0.5247361f, 7.551865f, -1.6350569f, 7.4871354f)),
    float4x4(float4(-1.2694472f, -9.020549f, -6.307308f, 0.1156755f), float4(-0.5863311f, -6.3508167f, 2.2088974f, -0.95557034f), float4(2.519586f, -4.0575604f, 6.3729653f, -1.4507685f), float4(0.05811975f, -0.25461668f, -0.4064348f, -0.41226965f)),
    float4x4(float4(-1.603955f, -0.63644004f, 0.49392483f, 1.1919441f), float4(-5.366019f, 2.9462543f, -0.4136076f, -3.124585f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.7355766f, 1.0036091f, -2.8403323f, -4.795097f), float4(0.024920808f, -0.23226534f, 0.5254088f, 0.11377028f), float4(0.13349196f, 0.07365853f, 0.20932944f, 0.016179072f), float4(-1.6250459f, -4.8359137f, -0.08537557f, -0.19261461f)),
    float4x4(float4(0.13225362f, 2.89904f, -3.04994f, 0.36533222f), float4(4.800494f, 3.977632f, -0.61880076f, 0.12900063f), float4(-1.0653358f, -3.289986f, 2.3399897f, -0.22318892f), float4(-2.6758354f, 0.62541056f, -0.4392313f, 0.027572617f)),
    float4x4(float4(5.42803f, 0.50919867f, -1.5685683f, -0.007823314f), float4(-4.863298f, 1.7043099f, -0.4714574f, -4.861206f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.13962865f, 1.5440083f, 3.000412f, 3.4353843f), float4(-0.57095677f, -0.061338373f, 0.2472489f, 0.19988087f), float4(-0.32642198f, 0.0010412352f, -0.021046346f, -0.012095685f), float4(0.24782896f, 2.2739713f, 5.3219786f, -4.776767f)),
    float4x4(float4(-0.47955763f, -0.82601726f, 4.6288095f, -2.1269662f), float4(-0.6476124f, -9.601333f, -3.9761598f, 0.89417446f), float4(-0.0847439f, 4.3309703f, 1.7938333f, 0.48631155f), float4(0.4469387f, 8.027626f, -1.1833122f, 0.0064941095f)),
    float4x4(float4(-0.49138308f, -2.9760563f, -0.9328496f, 0.8670376f), float4(-0.87651825f, 0.64863366f, -5.0546846f, 2.3387825f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.5760229f, 4.533266f, -1.6427152f, -1.4796346f), float4(-0.07957402f, -0.33262858f, 0.39887205f, -0.07089995f), float4(-0.014048754f, -0.053987775f, -0.08135598f, -0.000117340634f), float4(-0.11836353f, 0.44236583f, 3.952692f, -0.06623836f)),
    float4x4(float4(-1.128837f, -0.3080469f, -5.6531177f, -1.2193537f), float4(-0.6106688f, -2.1997905f, -4.896287f, 2.2838867f), float4(5.117241f, 6.327744f, 3.4865515f, 3.0882306f), float4(1.010223f, 0.340252f, -0.53299254f, -1.0834862f)),
    float4x4(float4(-5.1776967f, 0.98614454f, 1.1521934f, -6.7103496f), float4(-3.1058083f, -2.119367f, -1.3814752f, 1.0148283f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.9691913f, 3.6027002f, 3.4038823f, -1.4982073f), float4(-0.09721829f, 0.7538304f, 0.11502148f, -0.36653677f), float4(0.069223955f, -0.050337084f, 0.05156069f, 0.00126499f), float4(4.8298807f, -1.5281683f, -6.356912f, 1.9819074f)),
    float4x4(float4(-9.021647f, 2.6192272f, -8.228654f, -3.639272f), float4(-4.886636f, -1.1694726f, 0.33833027f, 3.7475548f), float4(5.3034215f, 1.6796954f, 4.7872767f, 4.596024f), float4(-1.2544109f, 2.2807274f, -0.3591253f, -0.5454767f)),
    float4x4(float4(1.7421607f, 1.9923266f, -0.03349984f, -0.19245246f), float4(0.29631603f, 0.41034484f, 0.5748713f, -0.49153104f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.2280331f, 3.3868275f, -2.665127f, -0.74408203f), float4(0.043601274f, -0.4817103f, -0.18844081f, -0.06487209f), float4(0.012015421f, -0.026456503f, 0.008891798f, 0.0075397766f), float4(-4.4597335f, 1.201724f, 1.7545215f, 2.532967f)),
    float4x4(float4(3.5101607f, -1.9561962f, -1.3536254f, -2.4960887f), float4(3.8059118f, -0.80123705f, -7.3587255f, -8.631405f), float4(2.9984262f, 0.8873145f, 0.38955295f, 5.230721f), float4(-0.08283735f, -0.27585363f, 5.9716625f, 6.624569f)),
    float4x4(float4(-0.40433055f, 0.029642176f, 2.079507f, -3.0390704f), float4(-2.4578543f, 3.7255483f, -2.189978f, -0.87685984f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.262312f, 2.3860085f, 6.7077255f, 1.7991533f), float4(-0.16270845f, 0.032198705f, -0.05943885f, -0.3940928f), float4(0.058438443f, 0.015088889f, -0.042749982f, 0.07342043f), float4(-0.7669092f, -2.3534462f, 0.99614793f, 2.8025775f)),
    float4x4(float4(-0.9087242f, 3.0325496f, -1.396636f, -1.098918f), float4(3.3784263f, 6.4511676f, -6.228715f, -4.159704f), float4(0.8494316f, -2.7000678f, 2.0243857f, -5.193673f), float4(0.20995937f, -4.190236f, -0.61862284f, -0.02107041f)),
    float4x4(float4(0.12992106f, 0.29974172f, -0.70772874f, -0.85352206f), float4(0.72485054f, 2.2938392f, 1.3125209f, 4.1111984f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-5.3910193f, 5.217595f, 3.4597962f, 1.1132557f), float4(0.0527404f, -0.22649224f, 0.2102456f, -0.04448421f), float4(0.02741702f, -0.05801576f, -0.004462379f, 0.038614187f), float4(0.07164862f, -1.0982728f, 1.1179584f, 4.9506955f)),
    float4x4(float4(-0.22796391f, -6.7252426f, 5.3008366f, -4.017342f), float4(5.2988577f, 1.8783277f, -1.299335f, -4.2415414f), float4(-1.6573465f, 3.03367f, 0.923951f, -3.392957f), float4(0.03842112f, 0.5970927f, 0.58665645f, 0.46000332f)),
    float4x4(float4(-0.08871091f, 0.49993217f, -2.3402717f, 1.2996048f), float4(0.29164585f, -0.08348722f, 0.049777083f, 2.3808312f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(-2.992966f, -2.858956f, -4.254115f, -0.22101966f), float4(1.8619783f, -1.7560344f, 0.18683062f, 0.71421546f), float4(-0.9313739f, 4.859132f, 0.6138396f, 0.49655724f), float4(-0.37038225f, 0.020796178f, 0.7491361f, 0.8727151f)),
    float4x4(float4(0.36748806f, -0.7872776f, -3.911794f, 0.009744219f), float4(-1.1042612f, 3.0573065f, 0.22637399f, 0.12707636f), float4(0.9925066f, -0.4076182f, 0.97743005f, 0.30577096f), float4(7.2628703f, -21.080715f, -4.972773f, -3.7080753f)),
    float4x4(float4(0.71003896f, -0.057421677f, -0.7333687f, -0.1349236f), float4(-3.0351005f, -0.025662167f, 5.439921f, 1.1083124f), float4(-1.2842412f, -0.40064743f, 2.132936f, 0.4587207f), float4(-0.4143241f, 3.001643f, 0.0988189f, -0.26960135f)),
    float4x4(float4(0.91364557f, 0.14445628f, -8.310524f, -0.065409906f), float4(-3.2332554f, -2.9022744f, -15.36157f, 0.50497496f), float4(0.8229345f, -2.064584f, 0.12143615f, -0.10263531f), float4(0.054719314f, 2.4150016f, 1.2882204f, 1.110596f)),
    float4x4(float4(-0.6192766f, 3.047318f, -0.96840745f, 0.2605519f), float4(-1.2917666f, -2.2279055f, -1.8872515f, 0.68316597f), float4(0.109164976f, 2.52896f, 0.8579186f, 0.15905996f), float4(-0.69663775f, 1.246913f, -0.710606f, 0.92853165f)),
    float4x4(float4(0.9062126f, 1.0490677f, 1.9008839f, -1.0397452f), float4(1.6107726f, -1.0856603f, 1.346723f, 0.993593f), float4(1.7179087f, 0.22983813f, -3.5189588f, -1.0520781f), float4(2.4576623f, 0.5125091f, -6.4215956f, -0.5380803f)),
    float4x4(float4(0.3615602f, -4.6017222f, -0.14912221f, 0.4948515f), float4(-0.63468134f, -9.653261f, -1.9091142f, -0.03045894f), float4(-2.565982f, -2.7410276f, -8.579719f, -1.8886751f), float4(0.37309378f, -0.7666512f, 0.9897772f, -0.053876042f)),
    float4x4(float4(0.14261079f, -2.7428598f, 0.71818084f, 0.079738714f), float4(1.1686169f, 2.7973378f, -12.209488f, -1.3224617f), float4(-0.10436231f, 3.5554519f, -1.8719939f, -0.083544716f), float4(0.37562165f, -2.0031798f, -1.140298f, 1.4245508f)),
    float4x4(float4(0.07020887f, -7.7853203f, 3.2623754f, -0.9289991f), float4(-0.41948175f, 0.91524047f, -0.09373543f, 3.1709063f), float4(1.707971f, 0.79446125f, 0.14929785f, 2.5686665f), float4(-0.056600675f, -0.1659347f, 5.8103175f, -1.8952311f)),
    float4x4(float4(-4.786343f, 1.030607f, 0.3021604f, -0.21997102f), float4(2.4703267f, 1.123544f, 2.1217737f, -0.52224094f), float4(-2.2712877f, 0.5158962f, 0.3472931f, 1.4640517f), float4(0.11313607f, -13.780107f, 8.568549f, -13.411448f)),
    float4x4(float4(-0.04082529f, 0.1669218f, 0.46733433f, -0.36587787f), float4(0.34007803f, 1.5025666f, -1.0191387f, -2.497706f), float4(5.29306f, -0.110161185f, -0.45350894f, -2.687117f), float4(1.1021147f, -0.042523265f, -8.089456f, -1.1886902f)),
    float4x4(float4(0.3839846f, 1.6447116f, -2.4580069f, -0.70252365f), float4(0.26104167f, -0.5908336f, 0.026685795f, -1.7847142f), float4(-5.2497396f, -0.5974036f, -3.9859402f, 1.2823159f), float4(-2.8455558f, 1.4684895f, 0.58783984f, 0.48113063f)),
    float4x4(float4(0.16200472f, 0.6974124f, -0.056665666f, 5.1168947f), float4(-1.1185981f, 0.28122574f, -1.1758981f, -0.2487846f), float4(-0.40818137f, 0.45375705f, 0.3172075f, -2.4046204f), float4(-3.1995828f, 1.259068f, 1.8805319f, 2.4689593f)),
    float4x4(float4(-1.3353378f, 0.63000417f, 0.38511258f, 2.2301257f), float4(0.2802323f, -0.1214043f, 0.15000337f, -1.1558938f), float4(0.71096516f, -1.684167f, -0.530025f, -0.8572137f), float4(-3.2262592f, -0.68959f, 2.0129254f, 4.257681f)),
    float4x4(float4(-19.512064f, -0.18027107f, -3.1857862f, -0.6899437f), float4(-0.3005064f, -0.34270313f, -0.42363968f, -5.0216107f), float4(-2.4683843f, 0.21464697f, 1.3507403f, -2.8129263f), float4(-0.07548671f, -0.8579342f, -1.1152614f, 3.2826817f)),
    float4x4(float4(-12.441226f, -1.5329676f, -0.020585677f, -1.3522521f), float4(6.684407f, -1.0653955f, 2.805359f, -5.174105f), float4(-1.2013803f, -0.14954259f, 1.1032336f, -2.7582016f), float4(-1.0236809f, -0.6934412f, 0.20977055f, -0.44141737f)),
    float4x4(float4(-0.08507485f, -3.0545528f, 0.096640795f, -2.997112f), float4(0.016383547f, -0.38022602f, -0.32512355f, -2.9064112f), float4(-0.18832994f, -2.7187495f, -0.30681947f, 3.0764172f), float4(0.032234084f, -0.674778f, -0.26126426f, -0.7389055f)),
    float4x4(float4(-0.30429694f, -5.9502687f, -0.25058585f, -0.56996036f), float4(-0.44421595f, 1.3879135f, -0.46375105f, -1.5739975f), float4(-0.5096615f, 1.5734165f, -0.22679868f, 0.034422264f), float4(-0.30219105f, -18.450062f, -0.06314865f, -11.160464f)),
    float4x4(float4(-0.02603846f, 0.30140403f, 0.2238884f, -0.4666892f), float4(-0.029553855f, 1.2880361f, 0.108896896f, -2.0154498f), float4(-0.14497134f, 0.71481055f, -0.06489657f, 1.5688689f), float4(-0.43832225f, 1.1543839f, -0.74085f, 1.265431f)),
    float4x4(float4(0.17543544f, -4.287299f, 0.035343643f, 2.50911f), float4(0.15206087f, 0.5505871f, -0.5673676f, -2.6335747f), float4(-0.2942823f, -2.0406406f, 0.12456984f, -1.7555345f), float4(-0.01804171f, 4.622501f, -0.11310927f, 3.5968187f)),
    float4x4(float4(-0.24732798f, 0.020867135f, 0.11910821f, -0.59342366f), float4(-0.24452622f, -0.71158904f, -0.73464835f, 0.033891715f), float4(0.060986243f, 0.14190178f, 0.103602394f, -0.3242666f), float4(-0.32296723f, -2.1236103f, -0.11954761f, -0.5252579f)),
    float4x4(float4(-0.22450684f, -2.814268f, -0.18150029f, 1.3641322f), float4(0.027793886f, -0.5324461f, -0.20759605f, -2.3197892f), float4(0.04657861f, 1.1140198f, 0.24319865f, -9.763681f), float4(-0.35169291f, -1.7075313f, -0.068953544f, -9.342775f)),
    float4x4(float4(-0.4123966f, -5.300227f, -0.0910799f, -2.8317666f), float4(-0.287858f, 0.46392447f, -0.16798578f, 0.6952194f), float4(-0.1862946f, -0.63765377f, -0.69623035f, 2.604372f), float4(-0.33906487f, -0.5565427f, -0.42190912f, -0.23940141f)),
    float4x4(float4(-0.12144742f, -20.892881f, -0.4145004f, 1.2375941f), float4(-0.697824f, 1.987435f, -0.5976051f, 4.402753f), float4(-0.20529044f, -0.3576681f, -0.21677442f, -0.24279527f), float4(-0.08807971f, 2.9789166f, 0.071931176f, -2.929071f)),
    float4x4(float4(-2.6315901f, -0.34439078f, -2.9610267f, -1.0923961f), float4(0.223164f, 1.8039895f, 2.5519726f, -0.9711679f), float4(-0.24532005f, -2.3492897f, -1.4704975f, 0.76217866f), float4(0.36889645f, -0.115326025f, 0.35473856f, -0.20498301f)),
    float4x4(float4(-0.88672864f, -0.39859805f, 2.39492f, 1.744944f), float4(-0.69307685f, -0.99920523f, 4.2183623f, -0.87868303f), float4(0.35942724f, -0.29691926f, 1.0818437f, 1.3207207f), float4(-30.2384f, 0.10928893f, -7.0647554f, 15.717544f)),
    float4x4(float4(-0.20164908f, -0.19088599f, 0.1551302f, 0.04737597f), float4(-0.81887734f, -3.1323016f, -2.7505014f, -1.5834199f), float4(-0.14424095f, -1.555143f, -4.6802588f, -1.3235509f), float4(-0.25277188f, -0.4647671f, 1.6973499f, -0.99667746f)),
    float4x4(float4(0.78845274f, 0.7655463f, 3.7973511f, 3.320911f), float4(-1.2283723f, -4.476903f, -3.5822878f, -3.721869f), float4(0.46523815f, 0.041043233f, 2.1500504f, 1.4796671f), float4(-4.0602994f, 2.0099647f, 0.85182285f, -0.7933596f)),
    float4x4(float4(0.35618836f, -0.5405226f, -0.8827116f, 1.0714078f), float4(1.0268298f, -0.2317349f, -2.412876f, -1.5990334f), float4(0.2031206f, -0.9403622f, 1.6003618f, -1.0273224f), float4(0.9049673f, 0.47973f, -1.1511244f, 0.058414135f)),
    float4x4(float4(1.9166514f, 1.426175f, -1.1536136f, 1.3503083f), float4(2.6654356f, -2.2231581f, 0.58408207f, 2.110834f), float4(-0.79796445f, -3.0819988f, 0.9331857f, 0.02824189f), float4(1.5963962f, 7.198678f, 2.0963554f, 2.8723466f)),
    float4x4(float4(-1.2596036f, 0.631166f, -11.672623f, -0.5510185f), float4(-1.0386657f, -3.2057896f, -2.1611688f, -1.6124867f), float4(-0.38434005f, -3.9630258f, -1.478051f, -2.4563847f), float4(1.4227921f, 1.0508367f, 1.2534283f, 0.904385f)),
    float4x4(float4(-0.8039124f, -1.2763106f, -23.93499f, 0.287792f), float4(-1.8194247f, -1.8709297f, 1.4603959f, 0.10037173f), float4(-0.9812876f, -2.6164715f, -0.132473f, -1.9431459f), float4(-1.5269586f, -0.5822796f, 1.6227671f, -0.8949245f))
};
static const float4 NMT_B2[4] = {
    float4(1.2619187f, -2.5986087f, -2.149382f, 1.3353654f),
    float4(-4.6729555f, 3.27779f, -12.580061f, -0.2602885f),
    float4(-0.13580789f, 0.6970699f, -0.15496458f, 0.740331f),
    float4(-0.12114108f, 1.2450967f, -2.2606373f, -0.36267692f)
};
static const float4 NMT_W3[4] = {
    float4(-0.20100085f, 0.17548272f, 0.09926478f, -0.21060409f),
    float4(0.18316391f, 0.13202123f, -0.10359111f, -0.18595253f),
    float4(0.5044715f, 0.1379622f, -0.045420256f, 0.09471249f),
    float4(0.13760756f, 0.21741933f, 0.2403533f, -0.21945743f)
};
static const float NMT_B3 = -0.117446944f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float3x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = f[1];
    float4 h0_2 = float4(f[2].x, 1.0f, 0.0f, 0.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]) + mul(h0_2, NMT_W1[2]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[3]) + mul(h0_1, NMT_W1[4]) + mul(h0_2, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]) + mul(h0_2, NMT_W1[8]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[9]) + mul(h0_1, NMT_W1[10]) + mul(h0_2, NMT_W1[11]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_4 = max(mul(h0_0, NMT_W1[12]) + mul(h0_1, NMT_W1[13]) + mul(h0_2, NMT_W1[14]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_5 = max(mul(h0_0, NMT_W1[15]) + mul(h0_1, NMT_W1[16]) + mul(h0_2, NMT_W1[17]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_6 = max(mul(h0_0, NMT_W1[18]) + mul(h0_1, NMT_W1[19]) + mul(h0_2, NMT_W1[20]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_7 = max(mul(h0_0, NMT_W1[21]) + mul(h0_1, NMT_W1[22]) + mul(h0_2, NMT_W1[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_0 = max(NMT_B2[0] + mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]) + mul(h1_4, NMT_W2[4]) + mul(h1_5, NMT_W2[5]) + mul(h1_6, NMT_W2[6]) + mul(h1_7, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(NMT_B2[1] + mul(h1_0, NMT_W2[8]) + mul(h1_1, NMT_W2[9]) + mul(h1_2, NMT_W2[10]) + mul(h1_3, NMT_W2[11]) + mul(h1_4, NMT_W2[12]) + mul(h1_5, NMT_W2[13]) + mul(h1_6, NMT_W2[14]) + mul(h1_7, NMT_W2[15]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_2 = max(NMT_B2[2] + mul(h1_0, NMT_W2[16]) + mul(h1_1, NMT_W2[17]) + mul(h1_2, NMT_W2[18]) + mul(h1_3, NMT_W2[19]) + mul(h1_4, NMT_W2[20]) + mul(h1_5, NMT_W2[21]) + mul(h1_6, NMT_W2[22]) + mul(h1_7, NMT_W2[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_3 = max(NMT_B2[3] + mul(h1_0, NMT_W2[24]) + mul(h1_1, NMT_W2[25]) + mul(h1_2, NMT_W2[26]) + mul(h1_3, NMT_W2[27]) + mul(h1_4, NMT_W2[28]) + mul(h1_5, NMT_W2[29]) + mul(h1_6, NMT_W2[30]) + mul(h1_7, NMT_W2[31]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
float nmt_fragment_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, float2x4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                float c = 0.5 * (z_nearest + z_farthest);
                float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                float2x4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
                float noise_growth = 1.0 + 2.0 * abs(c) * per_h;
                float moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
                float noise1 = moment_noise * (0.12 * sqrt(n));
                float per_n = 1.0 / n;
                float mean0 = nmt_shrink_to_prior(m[0].x, 0.0, noise1, 0.22 + 0.7 * per_n);
                front = others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0);
                if (n != 3.0) {
                    float x = ((farthest - nearest) / nearest < 0.01 ? nmt_place_in_thin(v, nearest, farthest)
                        : clamp((z - c) * per_h, -1.0, 1.0));
                    float further = noise_growth * 0.87;
                    float noise2 = noise1 * further;
                    float noise3 = noise2 * further;
                    float most0 = max(1.0 - mean0 * mean0, 1e-6);
                    float raw_spread0 = clamp((m[0].y - mean0 * mean0) / most0, 0.0, 1.0);
                    float spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5
                        * per_n);
                    // The same of (1 - x^2) times the measure, which does not hold the ends.
                    float per_mass1 = 1.0 / max(1.0 - m[0].y, 1e-6);
                    float raw_mean1 = clamp((m[0].x - m[0].z) * per_mass1, -1.0, 1.0);
                    float expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
                    float deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
                    float noise = noise3 * per_mass1;
                    float all_noise = noise + 9.536743e-7 * per_mass1;
                    float mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
                    float transition_width = all_noise * deviation / (all_noise + deviation);
                    front = others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width);
                    if (n != 4.0) {
                        float most1 = max(1.0 - mean1 * mean1, 1e-6);
                        float raw_square1 = clamp(((m[0].y - m[0].w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
                        float offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
                        float square0 = spread0 * spread0;
                        float expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset
                            * offset) * spread0 / (1.0 + spread0 + spread0), 0.0, 1.0);
                        float spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further
                            * per_mass1 / most1, (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
                        float q0 = 1.0 - m[0].y;
                        float q1 = m[0].x - m[0].z;
                        float q2 = m[0].y - m[0].w;
                        float q3 = m[0].z - m[1].x;
                        float q4 = m[0].w - m[1].y;
                        float q0_2 = q0 - q2;
                        float q1_2 = q1 - q3;
                        float q2_2 = q2 - q4;
                        float per_mass2 = 1.0 / max(q0_2, 1e-6);
                        float raw_mean2 = clamp(q1_2 * per_mass2, -1.0, 1.0);
                        float noise_2 = moment_noise * noise_growth * noise_growth * noise_growth * noise_growth;
                        float rounded = noise_2 * per_mass2;
                        float mean2 = raw_mean2 * (1.0 / (1.0 + rounded * rounded));
                        float rounded_2 = noise_2 * noise_growth * per_mass2;
                        float spread2 = 0.5 + (sqrt(clamp((q2_2 * per_mass2 - raw_mean2 * raw_mean2) / max(1.0
                            - raw_mean2 * raw_mean2, 1e-6), 0.0, 1.0)) - 0.5) * (1.0 / (1.0 + rounded_2 * rounded_2));
                        front = others * nmt_share(float3x4(float4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05),
                            mean0), float4(spread0, mean1, spread1, mean2), float4(spread2, 0.0, 0.0, 0.0)));
                    }
                }
            }
        }
    }
    return min(exp(-front), 1.0);
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, float4 sums0, float4 sums1, float4 range) {
    float nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.w, sums0.x,
        float2x4(float4(sums0.yzw, sums1.x), float4(sums1.yz, 0.0, 0.0)));
}

cbuffer Frame : register(b0) {
    float2 v_range;
};

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> sums1_texture : register(t1);
Texture2D<float4> range_texture : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    int3 at = int3(int2(input.position.xy), 0);
    float T = nmt_pass2(
        input.v, v_range.x, v_range.y, input.color.a,
        sums0_texture.Load(at),
        sums1_texture.Load(at),
        range_texture.Load(at));
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
