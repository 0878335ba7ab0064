#version 450
// Vulkan, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
// cleared to 0. Set 0: the targets of pass 1. With NMT_SUBPASS defined they are input attachments of a subpass, which
// tilers keep on chip. Depth test, discard and push constants as in pass 1; before the resolve a barrier like that
// behind pass 1.
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
const float NMT_ROUNDING = 1.1920929e-7;

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
mat2x4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    float moment5 = moment4 * z;
    float moment6 = moment5 * z;
    return mat2x4(vec4(moment1, moment2, moment3, moment4), vec4(moment5, moment6, 0.0, 0.0));
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
mat2x4 nmt_recentred_moments(float z, float absorbance, float c, float per_h, float per_b0, mat2x4 b) {
    mat2x4 own = nmt_moments(z, absorbance);
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
    return mat2x4(vec4(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3, -1.0,
        1.0), clamp(m4_5 * per_h4, -1.0, 1.0)), vec4(clamp(m5_6 * per_h4 * per_h, -1.0, 1.0), clamp(m6_7 * per_h4
        * per_h2, -1.0, 1.0), 0.0, 0.0));
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

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(-6.111781, 1.2590787, 0.5475349, -1.2606547), vec4(-0.9432912, -0.027208287, -0.30223295, -0.008989807), vec4(0.10382608, 0.04081687, 0.00517731, 0.13695489), vec4(0.5247361, 7.551865, -1.6350569, 7.4871354)),
    mat4(vec4(-1.2694472, -9.020549, -6.307308, 0.1156755), vec4(-0.5863311, -6.3508167, 2.2088974, -0.95557034), vec4(2.519586, -4.0575604, 6.3729653, -1.4507685), vec4(0.05811975, -0.25461668, -0.4064348, -0.41226965)),
    mat4(vec4(-1.603955, -0.63644004, 0.49392483, 1.1919441), vec4(-5.366019, 2.9462543, -0.4136076, -3.124585), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.7355766, 1.0036091, -2.8403323, -4.795097), vec4(0.024920808, -0.23226534, 0.5254088, 0.11377028), vec4(0.13349196, 0.07365853, 0.20932944, 0.016179072), vec4(-1.6250459, -4.8359137, -0.08537557, -0.19261461)),
    mat4(vec4(0.13225362, 2.89904, -3.04994, 0.36533222), vec4(4.800494, 3.977632, -0.61880076, 0.12900063), vec4(-1.0653358, -3.289986, 2.3399897, -0.22318892), vec4(-2.6758354, 0.62541056, -0.4392313, 0.027572617)),
    mat4(vec4(5.42803, 0.50919867, -1.5685683, -0.007823314), vec4(-4.863298, 1.7043099, -0.4714574, -4.861206), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.13962865, 1.5440083, 3.000412, 3.4353843), vec4(-0.57095677, -0.061338373, 0.2472489, 0.19988087), vec4(-0.32642198, 0.0010412352, -0.021046346, -0.012095685), vec4(0.24782896, 2.2739713, 5.3219786, -4.776767)),
    mat4(vec4(-0.47955763, -0.82601726, 4.6288095, -2.1269662), vec4(-0.6476124, -9.601333, -3.9761598, 0.89417446), vec4(-0.0847439, 4.3309703, 1.7938333, 0.48631155), vec4(0.4469387, 8.027626, -1.1833122, 0.0064941095)),
    mat4(vec4(-0.49138308, -2.9760563, -0.9328496, 0.8670376), vec4(-0.87651825, 0.64863366, -5.0546846, 2.3387825), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.5760229, 4.533266, -1.6427152, -1.4796346), vec4(-0.07957402, -0.33262858, 0.39887205, -0.07089995), vec4(-0.014048754, -0.053987775, -0.08135598, -0.000117340634), vec4(-0.11836353, 0.44236583, 3.952692, -0.06623836)),
    mat4(vec4(-1.128837, -0.3080469, -5.6531177, -1.2193537), vec4(-0.6106688, -2.1997905, -4.896287, 2.2838867), vec4(5.117241, 6.327744, 3.4865515, 3.0882306), vec4(1.010223, 0.340252, -0.53299254, -1.0834862)),
    mat4(vec4(-5.1776967, 0.98614454, 1.1521934, -6.7103496), vec4(-3.1058083, -2.119367, -1.3814752, 1.0148283), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.9691913, 3.6027002, 3.4038823, -1.4982073), vec4(-0.09721829, 0.7538304, 0.11502148, -0.36653677), vec4(0.069223955, -0.050337084, 0.05156069, 0.00126499), vec4(4.8298807, -1.5281683, -6.356912, 1.9819074)),
    mat4(vec4(-9.021647, 2.6192272, -8.228654, -3.639272), vec4(-4.886636, -1.1694726, 0.33833027, 3.7475548), vec4(5.3034215, 1.6796954, 4.7872767, 4.596024), vec4(-1.2544109, 2.2807274, -0.3591253, -0.5454767)),
    mat4(vec4(1.7421607, 1.9923266, -0.03349984, -0.19245246), vec4(0.29631603, 0.41034484, 0.5748713, -0.49153104), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.2280331, 3.3868275, -2.665127, -0.74408203), vec4(0.043601274, -0.4817103, -0.18844081, -0.06487209), vec4(0.012015421, -0.026456503, 0.008891798, 0.0075397766), vec4(-4.4597335, 1.201724, 1.7545215, 2.532967)),
    mat4(vec4(3.5101607, -1.9561962, -1.3536254, -2.4960887), vec4(3.8059118, -0.80123705, -7.3587255, -8.631405), vec4(2.9984262, 0.8873145, 0.38955295, 5.230721), vec4(-0.08283735, -0.27585363, 5.9716625, 6.624569)),
    mat4(vec4(-0.40433055, 0.029642176, 2.079507, -3.0390704), vec4(-2.4578543, 3.7255483, -2.189978, -0.87685984), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.262312, 2.3860085, 6.7077255, 1.7991533), vec4(-0.16270845, 0.032198705, -0.05943885, -0.3940928), vec4(0.058438443, 0.015088889, -0.042749982, 0.07342043), vec4(-0.7669092, -2.3534462, 0.99614793, 2.8025775)),
    mat4(vec4(-0.9087242, 3.0325496, -1.396636, -1.098918), vec4(3.3784263, 6.4511676, -6.228715, -4.159704), vec4(0.8494316, -2.7000678, 2.0243857, -5.193673), vec4(0.20995937, -4.190236, -0.61862284, -0.02107041)),
    mat4(vec4(0.12992106, 0.29974172, -0.70772874, -0.85352206), vec4(0.72485054, 2.2938392, 1.3125209, 4.1111984), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-5.3910193, 5.217595, 3.4597962, 1.1132557), vec4(0.0527404, -0.22649224, 0.2102456, -0.04448421), vec4(0.02741702, -0.05801576, -0.004462379, 0.038614187), vec4(0.07164862, -1.0982728, 1.1179584, 4.9506955)),
    mat4(vec4(-0.22796391, -6.7252426, 5.3008366, -4.017342), vec4(5.2988577, 1.8783277, -1.299335, -4.2415414), vec4(-1.6573465, 3.03367, 0.923951, -3.392957), vec4(0.03842112, 0.5970927, 0.58665645, 0.46000332)),
    mat4(vec4(-0.08871091, 0.49993217, -2.3402717, 1.2996048), vec4(0.29164585, -0.08348722, 0.049777083, 2.3808312), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(-2.992966, -2.858956, -4.254115, -0.22101966), vec4(1.8619783, -1.7560344, 0.18683062, 0.71421546), vec4(-0.9313739, 4.859132, 0.6138396, 0.49655724), vec4(-0.37038225, 0.020796178, 0.7491361, 0.8727151)),
    mat4(vec4(0.36748806, -0.7872776, -3.911794, 0.009744219), vec4(-1.1042612, 3.0573065, 0.22637399, 0.12707636), vec4(0.9925066, -0.4076182, 0.97743005, 0.30577096), vec4(7.2628703, -21.080715, -4.972773, -3.7080753)),
    mat4(vec4(0.71003896, -0.057421677, -0.7333687, -0.1349236), vec4(-3.0351005, -0.025662167, 5.439921, 1.1083124), vec4(-1.2842412, -0.40064743, 2.132936, 0.4587207), vec4(-0.4143241, 3.001643, 0.0988189, -0.26960135)),
    mat4(vec4(0.91364557, 0.14445628, -8.310524, -0.065409906), vec4(-3.2332554, -2.9022744, -15.36157, 0.50497496), vec4(0.8229345, -2.064584, 0.12143615, -0.10263531), vec4(0.054719314, 2.4150016, 1.2882204, 1.110596)),
    mat4(vec4(-0.6192766, 3.047318, -0.96840745, 0.2605519), vec4(-1.2917666, -2.2279055, -1.8872515, 0.68316597), vec4(0.109164976, 2.52896, 0.8579186, 0.15905996), vec4(-0.69663775, 1.246913, -0.710606, 0.92853165)),
    mat4(vec4(0.9062126, 1.0490677, 1.9008839, -1.0397452), vec4(1.6107726, -1.0856603, 1.346723, 0.993593), vec4(1.7179087, 0.22983813, -3.5189588, -1.0520781), vec4(2.4576623, 0.5125091, -6.4215956, -0.5380803)),
    mat4(vec4(0.3615602, -4.6017222, -0.14912221, 0.4948515), vec4(-0.63468134, -9.653261, -1.9091142, -0.03045894), vec4(-2.565982, -2.7410276, -8.579719, -1.8886751), vec4(0.37309378, -0.7666512, 0.9897772, -0.053876042)),
    mat4(vec4(0.14261079, -2.7428598, 0.71818084, 0.079738714), vec4(1.1686169, 2.7973378, -12.209488, -1.3224617), vec4(-0.10436231, 3.5554519, -1.8719939, -0.083544716), vec4(0.37562165, -2.0031798, -1.140298, 1.4245508)),
    mat4(vec4(0.07020887, -7.7853203, 3.2623754, -0.9289991), vec4(-0.41948175, 0.91524047, -0.09373543, 3.1709063), vec4(1.707971, 0.79446125, 0.14929785, 2.5686665), vec4(-0.056600675, -0.1659347, 5.8103175, -1.8952311)),
    mat4(vec4(-4.786343, 1.030607, 0.3021604, -0.21997102), vec4(2.4703267, 1.123544, 2.1217737, -0.52224094), vec4(-2.2712877, 0.5158962, 0.3472931, 1.4640517), vec4(0.11313607, -13.780107, 8.568549, -13.411448)),
    mat4(vec4(-0.04082529, 0.1669218, 0.46733433, -0.36587787), vec4(0.34007803, 1.5025666, -1.0191387, -2.497706), vec4(5.29306, -0.110161185, -0.45350894, -2.687117), vec4(1.1021147, -0.042523265, -8.089456, -1.1886902)),
    mat4(vec4(0.3839846, 1.6447116, -2.4580069, -0.70252365), vec4(0.26104167, -0.5908336, 0.026685795, -1.7847142), vec4(-5.2497396, -0.5974036, -3.9859402, 1.2823159), vec4(-2.8455558, 1.4684895, 0.58783984, 0.48113063)),
    mat4(vec4(0.16200472, 0.6974124, -0.056665666, 5.1168947), vec4(-1.1185981, 0.28122574, -1.1758981, -0.2487846), vec4(-0.40818137, 0.45375705, 0.3172075, -2.4046204), vec4(-3.1995828, 1.259068, 1.8805319, 2.4689593)),
    mat4(vec4(-1.3353378, 0.63000417, 0.38511258, 2.2301257), vec4(0.2802323, -0.1214043, 0.15000337, -1.1558938), vec4(0.71096516, -1.684167, -0.530025, -0.8572137), vec4(-3.2262592, -0.68959, 2.0129254, 4.257681)),
    mat4(vec4(-19.512064, -0.18027107, -3.1857862, -0.6899437), vec4(-0.3005064, -0.34270313, -0.42363968, -5.0216107), vec4(-2.4683843, 0.21464697, 1.3507403, -2.8129263), vec4(-0.07548671, -0.8579342, -1.1152614, 3.2826817)),
    mat4(vec4(-12.441226, -1.5329676, -0.020585677, -1.3522521), vec4(6.684407, -1.0653955, 2.805359, -5.174105), vec4(-1.2013803, -0.14954259, 1.1032336, -2.7582016), vec4(-1.0236809, -0.6934412, 0.20977055, -0.44141737)),
    mat4(vec4(-0.08507485, -3.0545528, 0.096640795, -2.997112), vec4(0.016383547, -0.38022602, -0.32512355, -2.9064112), vec4(-0.18832994, -2.7187495, -0.30681947, 3.0764172), vec4(0.032234084, -0.674778, -0.26126426, -0.7389055)),
    mat4(vec4(-0.30429694, -5.9502687, -0.25058585, -0.56996036), vec4(-0.44421595, 1.3879135, -0.46375105, -1.5739975), vec4(-0.5096615, 1.5734165, -0.22679868, 0.034422264), vec4(-0.30219105, -18.450062, -0.06314865, -11.160464)),
    mat4(vec4(-0.02603846, 0.30140403, 0.2238884, -0.4666892), vec4(-0.029553855, 1.2880361, 0.108896896, -2.0154498), vec4(-0.14497134, 0.71481055, -0.06489657, 1.5688689), vec4(-0.43832225, 1.1543839, -0.74085, 1.265431)),
    mat4(vec4(0.17543544, -4.287299, 0.035343643, 2.50911), vec4(0.15206087, 0.5505871, -0.5673676, -2.6335747), vec4(-0.2942823, -2.0406406, 0.12456984, -1.7555345), vec4(-0.01804171, 4.622501, -0.11310927, 3.5968187)),
    mat4(vec4(-0.24732798, 0.020867135, 0.11910821, -0.59342366), vec4(-0.24452622, -0.71158904, -0.73464835, 0.033891715), vec4(0.060986243, 0.14190178, 0.103602394, -0.3242666), vec4(-0.32296723, -2.1236103, -0.11954761, -0.5252579)),
    mat4(vec4(-0.22450684, -2.814268, -0.18150029, 1.3641322), vec4(0.027793886, -0.5324461, -0.20759605, -2.3197892), vec4(0.04657861, 1.1140198, 0.24319865, -9.763681), vec4(-0.35169291, -1.7075313, -0.068953544, -9.342775)),
    mat4(vec4(-0.4123966, -5.300227, -0.0910799, -2.8317666), vec4(-0.287858, 0.46392447, -0.16798578, 0.6952194), vec4(-0.1862946, -0.63765377, -0.69623035, 2.604372), vec4(-0.33906487, -0.5565427, -0.42190912, -0.23940141)),
    mat4(vec4(-0.12144742, -20.892881, -0.4145004, 1.2375941), vec4(-0.697824, 1.987435, -0.5976051, 4.402753), vec4(-0.20529044, -0.3576681, -0.21677442, -0.24279527), vec4(-0.08807971, 2.9789166, 0.071931176, -2.929071)),
    mat4(vec4(-2.6315901, -0.34439078, -2.9610267, -1.0923961), vec4(0.223164, 1.8039895, 2.5519726, -0.9711679), vec4(-0.24532005, -2.3492897, -1.4704975, 0.76217866), vec4(0.36889645, -0.115326025, 0.35473856, -0.20498301)),
    mat4(vec4(-0.88672864, -0.39859805, 2.39492, 1.744944), vec4(-0.69307685, -0.99920523, 4.2183623, -0.87868303), vec4(0.35942724, -0.29691926, 1.0818437, 1.3207207), vec4(-30.2384, 0.10928893, -7.0647554, 15.717544)),
    mat4(vec4(-0.20164908, -0.19088599, 0.1551302, 0.04737597), vec4(-0.81887734, -3.1323016, -2.7505014, -1.5834199), vec4(-0.14424095, -1.555143, -4.6802588, -1.3235509), vec4(-0.25277188, -0.4647671, 1.6973499, -0.99667746)),
    mat4(vec4(0.78845274, 0.7655463, 3.7973511, 3.320911), vec4(-1.2283723, -4.476903, -3.5822878, -3.721869), vec4(0.46523815, 0.041043233, 2.1500504, 1.4796671), vec4(-4.0602994, 2.0099647, 0.85182285, -0.7933596)),
    mat4(vec4(0.35618836, -0.5405226, -0.8827116, 1.0714078), vec4(1.0268298, -0.2317349, -2.412876, -1.5990334), vec4(0.2031206, -0.9403622, 1.6003618, -1.0273224), vec4(0.9049673, 0.47973, -1.1511244, 0.058414135)),
    mat4(vec4(1.9166514, 1.426175, -1.1536136, 1.3503083), vec4(2.6654356, -2.2231581, 0.58408207, 2.110834), vec4(-0.79796445, -3.0819988, 0.9331857, 0.02824189), vec4(1.5963962, 7.198678, 2.0963554, 2.8723466)),
    mat4(vec4(-1.2596036, 0.631166, -11.672623, -0.5510185), vec4(-1.0386657, -3.2057896, -2.1611688, -1.6124867), vec4(-0.38434005, -3.9630258, -1.478051, -2.4563847), vec4(1.4227921, 1.0508367, 1.2534283, 0.904385)),
    mat4(vec4(-0.8039124, -1.2763106, -23.93499, 0.287792), vec4(-1.8194247, -1.8709297, 1.4603959, 0.10037173), vec4(-0.9812876, -2.6164715, -0.132473, -1.9431459), vec4(-1.5269586, -0.5822796, 1.6227671, -0.8949245))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(1.2619187, -2.5986087, -2.149382, 1.3353654),
    vec4(-4.6729555, 3.27779, -12.580061, -0.2602885),
    vec4(-0.13580789, 0.6970699, -0.15496458, 0.740331),
    vec4(-0.12114108, 1.2450967, -2.2606373, -0.36267692)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.20100085, 0.17548272, 0.09926478, -0.21060409),
    vec4(0.18316391, 0.13202123, -0.10359111, -0.18595253),
    vec4(0.5044715, 0.1379622, -0.045420256, 0.09471249),
    vec4(0.13760756, 0.21741933, 0.2403533, -0.21945743)
);
const float NMT_B3 = -0.117446944;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat3x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = f[1];
    vec4 h0_2 = vec4(f[2].x, 1.0, 0.0, 0.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4(0.0));
    vec4 h1_4 = max(NMT_W1[12] * h0_0 + NMT_W1[13] * h0_1 + NMT_W1[14] * h0_2, vec4(0.0));
    vec4 h1_5 = max(NMT_W1[15] * h0_0 + NMT_W1[16] * h0_1 + NMT_W1[17] * h0_2, vec4(0.0));
    vec4 h1_6 = max(NMT_W1[18] * h0_0 + NMT_W1[19] * h0_1 + NMT_W1[20] * h0_2, vec4(0.0));
    vec4 h1_7 = max(NMT_W1[21] * h0_0 + NMT_W1[22] * h0_1 + NMT_W1[23] * h0_2, vec4(0.0));
    vec4 h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3 + NMT_W2[4] * h1_4 + NMT_W2[5] * h1_5 + NMT_W2[6] * h1_6 + NMT_W2[7] * h1_7, vec4(0.0));
    vec4 h2_1 = max(NMT_B2[1] + NMT_W2[8] * h1_0 + NMT_W2[9] * h1_1 + NMT_W2[10] * h1_2 + NMT_W2[11] * h1_3 + NMT_W2[12] * h1_4 + NMT_W2[13] * h1_5 + NMT_W2[14] * h1_6 + NMT_W2[15] * h1_7, vec4(0.0));
    vec4 h2_2 = max(NMT_B2[2] + NMT_W2[16] * h1_0 + NMT_W2[17] * h1_1 + NMT_W2[18] * h1_2 + NMT_W2[19] * h1_3 + NMT_W2[20] * h1_4 + NMT_W2[21] * h1_5 + NMT_W2[22] * h1_6 + NMT_W2[23] * h1_7, vec4(0.0));
    vec4 h2_3 = max(NMT_B2[3] + NMT_W2[24] * h1_0 + NMT_W2[25] * h1_1 + NMT_W2[26] * h1_2 + NMT_W2[27] * h1_3 + NMT_W2[28] * h1_4 + NMT_W2[29] * h1_5 + NMT_W2[30] * h1_6 + NMT_W2[31] * h1_7, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
float nmt_fragment_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, mat2x4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                float c = 0.5 * (z_nearest + z_farthest);
                float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                mat2x4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
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
                        front = others * nmt_share(mat3x4(vec4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05),
                            mean0), vec4(spread0, mean1, spread1, mean2), vec4(spread2, 0.0, 0.0, 0.0)));
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
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.w, sums0.x, mat2x4(vec4(sums0.yzw,
        sums1.x), vec4(sums1.yz, 0.0, 0.0)));
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
