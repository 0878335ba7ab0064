#version 450
// Vulkan, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Blend factors VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD; target VK_FORMAT_R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT,
// cleared to 0. Set 0: the targets of pass 1. With NMT_SUBPASS defined they are input attachments of a subpass, which
// tilers keep on chip. Depth test, discard and push constants as in pass 1; before the resolve a barrier like that
// behind pass 1.
//
// Neural moment transparency: network 'recommended', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 3 x 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.438e-3, worst 0.994.

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

const mat4 NMT_W1[16] = mat4[16](
    mat4(vec4(-4.1674604, 1.9599856, -0.73242956, -0.20504631), vec4(-0.12590207, 0.52091557, 0.07906628, 0.021661459), vec4(0.08731185, -0.010980034, -0.04702237, -0.014140079), vec4(-2.3502588, 0.98347735, 5.2544265, 7.5886335)),
    mat4(vec4(-2.0677073, -3.0403187, -7.251252, -0.21163398), vec4(4.0386076, -0.3408012, -6.547609, -0.27915618), vec4(2.371881, -3.6694639, 2.8083203, 0.16396397), vec4(-4.5592628, 3.2408876, 0.7731898, -6.0322914)),
    mat4(vec4(-0.46817917, 2.2209268, 0.42732853, -2.1391058), vec4(0.6626024, 0.12554957, 0.15880474, 0.08205461), vec4(-0.002107043, 0.067374885, -0.04141126, 0.018053476), vec4(-0.02131919, -5.3346705, 6.854231, 0.49863964)),
    mat4(vec4(-2.3983507, -2.2166302, -9.364158, -4.6879478), vec4(-7.131321, 0.9307025, -5.2908893, -0.09217429), vec4(0.18057501, -0.056932688, -5.222522, 5.909689), vec4(-3.2400908, 1.7953771, 2.3643174, -2.5787416)),
    mat4(vec4(-2.0212417, 3.5234349, -0.29862827, 2.837473), vec4(-0.0034417917, -0.2701374, -0.06850981, 0.26511696), vec4(0.06310855, -0.074502654, 0.0036534448, -0.02181142), vec4(1.1280895, -0.06773128, 7.143841, -0.33201975)),
    mat4(vec4(-5.189434, -2.4549117, -0.16383393, 2.9110465), vec4(-3.691939, -2.2927215, -1.7290045, 0.5228869), vec4(3.423124, 4.379191, -0.54773974, -2.3272412), vec4(0.18388788, 1.0360488, -2.4800966, 1.8856108)),
    mat4(vec4(-3.5864356, 3.698348, -2.763185, -2.920156), vec4(0.78295255, 0.015520756, -0.32045588, -0.06508547), vec4(0.009859245, -0.076360114, 0.06714014, 0.014959682), vec4(-0.39343145, -0.1780676, 4.0171967, -0.3578333)),
    mat4(vec4(1.4050651, 0.118033335, -6.476847, -0.18825664), vec4(0.19789477, -0.5731352, -5.180575, 3.0493782), vec4(-0.75208825, 6.0289307, 3.036596, 0.6782269), vec4(-4.040601, -2.1219463, -0.72817266, 0.23356485)),
    mat4(vec4(0.33965114, 0.53012913, 3.6864781, 0.75859493), vec4(0.00060585595, -2.9309227, -0.36718613, -0.3317407), vec4(0.033321146, 1.2089126, 0.2153916, -0.0014231349), vec4(7.1874413, 0.3191635, -8.419987, -2.4559073)),
    mat4(vec4(-11.693587, -2.831591, -2.3943553, -8.275588), vec4(-7.1602225, -0.7036662, 2.2086513, 3.6333103), vec4(4.0300922, 1.7700683, 1.188168, 7.4534593), vec4(0.7538325, -0.7767871, 0.016310979, 0.18021783)),
    mat4(vec4(-1.3306596, 1.8677293, -4.101393, -4.6770787), vec4(0.19519782, -0.48456788, -0.20488237, 0.021339769), vec4(-0.010044715, -0.031366363, 0.050242912, 0.015430227), vec4(-4.2732124, 1.70702, 0.0028088223, -0.010693944)),
    mat4(vec4(-3.774896, -1.1750406, -0.93092984, -0.049676165), vec4(4.5747614, -0.64899164, -0.34892794, -0.11725599), vec4(-2.6529639, -2.241756, 1.2695652, 0.121937424), vec4(1.5011057, 2.9329836, -3.6110363, -4.5134344)),
    mat4(vec4(-4.6046376, 3.0093236, 4.978195, 1.5529538), vec4(-5.0088716, 0.49800482, 0.108492136, 0.17909843), vec4(0.19106047, 0.006962222, -0.0562687, -0.05636758), vec4(2.4868011, -2.9974, 1.1363013, 0.8436937)),
    mat4(vec4(-3.112934, 2.7212074, -0.7725423, 2.895838), vec4(-1.4298413, 2.0517163, -5.190096, -2.2426555), vec4(1.0851005, 1.2990258, 1.9417673, -7.12554), vec4(-1.7792232, 0.8998802, 0.6199238, 1.7865978)),
    mat4(vec4(-4.373691, 7.469767, 0.73178667, 0.19036344), vec4(0.18150902, -0.09014448, -0.10938936, 0.30877957), vec4(-0.00059860875, -0.04931852, -0.033257622, 0.008763494), vec4(0.013503743, -1.9672016, -3.3122485, 2.5027857)),
    mat4(vec4(-0.16557512, -2.3265748, 3.9967105, 5.9642453), vec4(4.2863545, -0.5382311, 1.9298717, -1.1969867), vec4(-1.3004589, -0.5782102, -3.2860882, 0.18440095), vec4(0.19718102, -2.082068, 1.6094493, -3.5837553))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(2.0213919, -2.91184, 1.5348691, -0.2929838), vec4(1.3055472, 0.27231, -0.8899139, -0.4409711), vec4(0.11069353, -1.8431019, 0.17304926, 0.8809019), vec4(-5.399847, -17.517437, 0.47533467, 6.2987537)),
    mat4(vec4(0.419285, -0.42110118, 2.5071044, -1.4210333), vec4(-0.7503765, 0.8864603, 0.037235156, 0.37260938), vec4(0.6845067, 0.44033587, -0.28448498, 0.24686478), vec4(2.7418797, 1.6742915, 0.8079822, -0.8698964)),
    mat4(vec4(0.9036239, -0.82326996, -0.8262928, -0.335104), vec4(-0.41287225, -0.55577654, -1.3758198, -0.18870488), vec4(-0.63340414, 0.42160872, 0.7002752, 2.267698), vec4(-1.08188, -3.98043, -1.4021765, 0.6892029)),
    mat4(vec4(3.4161088, 0.7640683, 1.9327487, 1.83947), vec4(-5.0462413, -0.713245, -0.014138731, -0.31107137), vec4(1.3723212, 2.744764, -0.30109656, -0.48658893), vec4(0.26442823, -1.2755157, 0.42979032, 0.022228852)),
    mat4(vec4(0.9166541, 2.8674293, -2.7461586, -0.11615238), vec4(0.077809386, -2.372911, -0.1854338, 0.5619069), vec4(-1.2895492, -0.69098186, -1.6812513, 0.17504105), vec4(-1.556445, 1.623512, 1.1337266, 2.044273)),
    mat4(vec4(-0.8967381, 2.4832838, 0.3154895, 0.5799579), vec4(0.76742953, -1.2556587, 1.0351061, 0.9519333), vec4(0.7550382, -0.7536835, -8.745191, -0.5979435), vec4(-0.6330228, -5.822986, -24.325792, 3.6463118)),
    mat4(vec4(-0.16797684, 1.0777332, -0.6376268, -0.33728403), vec4(-1.061007, 2.0483856, 1.2846082, -0.06528943), vec4(-2.8672419, -0.13821496, -0.40658525, -0.7010545), vec4(0.73339987, 0.85867685, -2.980733, -0.6767882)),
    mat4(vec4(-0.17565668, -0.66932446, -0.087680444, 0.82007885), vec4(-0.81018645, -5.083275, 6.716149, -2.5253572), vec4(-0.21873666, 1.6195232, 0.10287789, -0.7853111), vec4(-0.8664899, 1.8022391, 0.12425704, -0.12265211)),
    mat4(vec4(-0.019619394, -2.9439027, 0.20967697, -3.419845), vec4(-3.0203755, -0.17222819, -0.21907517, -0.1506443), vec4(0.2171478, -0.16118884, -0.34547976, 3.1116161), vec4(0.59133464, 0.16578314, -0.26919577, -17.852287)),
    mat4(vec4(-1.9658519, -0.026431112, -0.32840747, 2.9921103), vec4(-3.432273, 0.28572825, -0.3039937, -1.5232166), vec4(-1.0966971, -0.76801056, 0.27018806, 3.2838664), vec4(-0.8133999, -0.12406365, -0.23587477, 0.42709732)),
    mat4(vec4(-6.489317, 0.13252488, -0.26811773, 2.2592547), vec4(-3.6722937, 0.4313345, 0.27116078, -0.16659443), vec4(0.10130279, 0.19058819, 0.043735087, -3.4506261), vec4(2.148812, -1.1394475, -0.23171818, -2.8741112)),
    mat4(vec4(0.6639304, 3.6351647, 0.15170369, -0.9139982), vec4(1.5778636, -0.57759607, -0.076416016, -17.85372), vec4(-2.942476, -1.2473558, -0.3413897, 1.8454653), vec4(-6.107756, -0.2496649, -0.2933674, -0.3217662)),
    mat4(vec4(0.27639863, -0.020356344, 0.20805937, 5.0024533), vec4(0.27502623, 0.33333814, -0.17369579, 0.3428085), vec4(0.2811654, -0.09691671, 0.3376751, -4.3889575), vec4(0.5050634, 0.056959357, 0.15600675, 0.9328736)),
    mat4(vec4(0.6798183, 0.561105, -0.29834086, -1.388716), vec4(0.93923146, -0.38923523, -0.0074161366, -0.62310964), vec4(-0.27356088, -3.8132336, -0.326761, -3.2853408), vec4(-0.17321798, -10.054951, 0.094018586, -4.1044903)),
    mat4(vec4(-2.9375002, -1.5772644, -0.028824203, 0.39525685), vec4(0.2538739, 0.6404099, -0.08917889, -0.23136254), vec4(-1.4123424, 0.49519774, -0.28288534, -4.4888506), vec4(-0.19552387, 0.031744648, -0.024117399, 3.5014074)),
    mat4(vec4(-6.388915, 0.25000545, -0.319836, -0.93253845), vec4(9.816028, 2.536431, 0.09538501, -0.33083022), vec4(-3.8032932, 1.2661434, -0.16308375, -2.2764294), vec4(1.7594389, -0.51916075, -0.13081738, -2.6253278)),
    mat4(vec4(1.9530706, -1.8485831, 0.2109906, -0.25858083), vec4(0.93915653, 1.6989772, 0.10935656, 3.243871), vec4(-1.668992, 0.26239094, -0.19926538, -0.2640662), vec4(-4.7925825, -1.5411111, -1.9145753, 1.6478897)),
    mat4(vec4(-0.35818458, 1.2148889, 0.3322431, 2.009875), vec4(-0.88717693, 2.085225, -0.059712175, -0.7660865), vec4(-5.2038116, 1.1421809, -0.069393694, -1.2104797), vec4(1.4166483, 8.891604, -0.19883786, 2.5516102)),
    mat4(vec4(-0.8331628, -0.74940425, -0.5258979, -0.38192207), vec4(-0.61086315, -1.6954087, 0.03969145, 2.0987928), vec4(0.17930607, -0.91649634, -0.14285758, -1.7155297), vec4(0.8023482, 0.7970375, 0.6197916, -5.2210584)),
    mat4(vec4(-2.5854452, 5.9796576, 0.61167616, 0.4250337), vec4(1.3043399, 2.8135962, -0.05531424, -0.15286618), vec4(1.3677459, 2.6523335, 0.37061626, 0.8490703), vec4(-0.28107482, -19.692179, -0.19836535, -1.71023)),
    mat4(vec4(1.2583504, -0.7968344, 0.369631, 0.28707027), vec4(0.32727537, 0.16690618, -0.3634363, 0.88905156), vec4(0.014350122, -0.15114553, 0.2937969, 1.5788385), vec4(-4.5339465, -0.17390747, -0.241532, 0.70758146)),
    mat4(vec4(-0.5519906, 2.8230247, 0.05278055, 0.54575557), vec4(-1.3154308, 0.656429, 0.7821612, -9.275172), vec4(1.1405544, -2.1575017, 1.4119513, 0.7853599), vec4(3.2076383, -6.13053, 15.256626, -12.406102)),
    mat4(vec4(1.2811682, 0.083948754, -0.37948, -0.4940118), vec4(-1.1444502, -2.5660405, -0.552346, 0.1214361), vec4(0.5068235, -0.47298962, 0.4408889, -2.732477), vec4(-0.5066367, -0.8545023, -0.51588374, -1.2569976)),
    mat4(vec4(0.5785463, -32.425995, 0.42408907, 0.9343084), vec4(-3.902431, -0.7520251, -0.06531561, -4.5250793), vec4(1.669008, 1.2654543, 0.5549053, 3.3851264), vec4(-0.31843388, -0.1135918, 0.2259276, 3.8177497)),
    mat4(vec4(1.9812528, -0.36313337, -0.7867708, -1.8871622), vec4(-0.3773511, -0.16610058, 1.1051798, 1.2316991), vec4(1.8488358, -0.046805546, -0.6921194, -0.5387434), vec4(0.3181373, -0.18279947, -1.689014, 3.066741)),
    mat4(vec4(-0.34661636, -0.4327142, 1.5718977, -0.5606247), vec4(-0.03964064, -0.23198833, 0.47888073, -0.5954511), vec4(-0.36834794, -0.23371373, 0.15666945, 0.93414724), vec4(-0.281857, 0.20966858, 8.412329, 9.048968)),
    mat4(vec4(-0.34866777, -0.29574445, 2.2201583, 1.0108215), vec4(2.1363382, -0.027613534, -1.1590986, -0.66171604), vec4(0.34671408, 0.07055651, -0.63689375, -0.49965852), vec4(-1.2961404, -0.75858885, 0.23002268, 0.47372976)),
    mat4(vec4(-0.008777903, -0.58365583, -7.097225, -0.7343006), vec4(-2.659016, 0.31216386, 0.68762773, 0.2661025), vec4(-1.6388949, -0.17292544, -0.52062505, -0.22462904), vec4(0.8361993, -0.09593139, -4.261884, -0.79932857)),
    mat4(vec4(-0.23727515, -0.091116585, 0.93601537, -2.982952), vec4(0.032420382, -0.21857665, -0.6826385, 0.1599772), vec4(0.47912702, -0.3265304, -0.20499313, -1.6727635), vec4(1.9387163, -0.111314304, -0.61201704, 2.9126418)),
    mat4(vec4(-0.80854404, 0.07845742, -2.8177385, 0.109425806), vec4(0.19731739, -0.1832566, 0.387768, 0.2938763), vec4(-1.713297, 0.05192612, -10.083423, -0.7480528), vec4(-8.829212, -0.33925098, -16.97128, -2.5043054)),
    mat4(vec4(-0.6140045, -0.27008948, -0.00565183, 0.40399697), vec4(1.3195682, -0.2859485, -0.6891265, -0.010279318), vec4(-0.27614084, -0.34485704, 1.0004749, -2.5375779), vec4(0.1936343, -0.15814485, -0.32213724, -0.7124809)),
    mat4(vec4(-1.5785738, -0.5448545, -7.9740224, -0.3882083), vec4(-1.0468239, -0.4249315, -0.3257484, -0.8561734), vec4(-0.07593948, -0.07261215, 0.73661035, 0.53244424), vec4(0.6394129, -0.39995986, -1.0125879, -0.50449544))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(1.5403837, -1.8343279, -0.9217493, 1.313698),
    vec4(-7.616127, 0.743722, -0.04113058, -1.5676365),
    vec4(-1.6024822, 0.326761, -5.2702546, -9.288301),
    vec4(2.192788, -0.38622347, 1.562341, -3.0405202)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.23133157, 0.07465856, 0.11972243, -0.19268681),
    vec4(0.34225202, 0.15328355, -0.12462099, -0.17171375),
    vec4(0.09308249, 0.25963008, -0.57784873, 0.18180469),
    vec4(0.15193784, 0.23329662, 0.12255926, -0.111732274)
);
const float NMT_B3 = -1.1533976;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat2x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = vec4(f[1].xyz, 1.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4(0.0));
    vec4 h1_4 = max(NMT_W1[8] * h0_0 + NMT_W1[9] * h0_1, vec4(0.0));
    vec4 h1_5 = max(NMT_W1[10] * h0_0 + NMT_W1[11] * h0_1, vec4(0.0));
    vec4 h1_6 = max(NMT_W1[12] * h0_0 + NMT_W1[13] * h0_1, vec4(0.0));
    vec4 h1_7 = max(NMT_W1[14] * h0_0 + NMT_W1[15] * h0_1, vec4(0.0));
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
