#version 430
// OpenGL 4.3, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
// Neural moment transparency: network 'core', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 3092f67416d8b5bbb367e1c26a4ab05adc3607e46d8419bd3e02d6ef6371f815.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

const mat4 NMT_W1[16] = mat4[16](
    mat4(vec4(0.6881288, -1.1310471, 0.19075142, -0.122978434), vec4(0.059859317, -0.032530885, 0.11460753, -0.05948783), vec4(0.09496521, 0.028685618, -0.07390768, -0.0039776997), vec4(0.66928864, 1.0262985, 3.757691, 5.0184836)),
    mat4(vec4(-2.0447435, -12.088652, 1.5913789, -7.7325196), vec4(-1.2489678, 1.0511265, -0.07461163, -5.2501163), vec4(6.302579, -2.4373822, -0.32582536, 1.6611658), vec4(-1.9725834, 1.5152123, -0.1333648, 0.8429957)),
    mat4(vec4(-1.0529675, 0.047792263, -0.38675287, -0.4790484), vec4(-0.06178597, 0.016562033, 0.0030441822, 0.21425606), vec4(0.022690004, 0.0074565373, 0.01335627, 0.038239885), vec4(0.89074063, -3.7101028, 2.7637813, -3.6907377)),
    mat4(vec4(5.461836, 4.834039, -4.186392, 0.66879135), vec4(-0.76883733, 4.1093445, -2.9046538, 6.4072814), vec4(-7.442225, -3.0523446, -0.13244298, 0.59931296), vec4(1.7018301, 0.6336567, 0.9403853, -1.7658007)),
    mat4(vec4(1.8765194, 2.6232011, 2.9969184, 1.9736181), vec4(-0.22154179, 0.14598238, -0.023278037, 0.118888475), vec4(0.118653126, -0.08851043, -0.16036831, 0.044362914), vec4(1.5986516, -2.4959438, 2.785788, 0.2126117)),
    mat4(vec4(-7.5458517, 4.551311, 2.0929039, 4.794727), vec4(-0.43736508, 3.7192998, -4.572139, -2.46626), vec4(1.5987555, 2.4772296, 2.163722, -1.1508174), vec4(1.8332342, -3.4584925, -2.1935759, 0.50447434)),
    mat4(vec4(-3.6816344, 0.75467557, -2.3304558, -2.8002195), vec4(0.015614783, -0.011906751, -0.8760485, 0.11018137), vec4(-0.098102964, 0.012420373, 0.35013762, 0.026148027), vec4(-0.21351282, -1.210738, 0.7966853, 2.7524707)),
    mat4(vec4(0.31600532, 5.30934, -2.520569, -2.4315674), vec4(0.07278491, 1.2795554, 0.009831517, -2.4177828), vec4(-0.12661605, -5.4307957, 1.5556282, -0.08110618), vec4(-2.8565087, 1.3582026, -1.4116979, -0.16265324)),
    mat4(vec4(-0.73589987, -1.8186098, -3.1361523, -0.6670014), vec4(-0.03481343, -0.027409472, 0.004099067, 0.12583362), vec4(0.7344521, 0.015158952, -0.0024454447, -0.21044949), vec4(-1.7101433, -2.4010005, -0.004084912, 1.2996026)),
    mat4(vec4(1.2983388, -4.3570766, 0.008181664, -4.825084), vec4(0.48558652, 4.4745054, 0.013507118, 0.6069626), vec4(-0.0434868, 0.045928214, 0.0028301273, 1.4882053), vec4(-3.131018, 0.5826171, -3.1153202, 0.77198803)),
    mat4(vec4(-0.9910445, -0.904163, -1.5641176, -2.864658), vec4(-0.083755374, 0.0063637346, 0.011683597, 0.011187007), vec4(0.034442373, 0.11799263, -0.023390315, -0.00063614675), vec4(-1.9783124, -1.914417, 0.8819491, 0.25718477)),
    mat4(vec4(-3.0586958, 0.8365864, -0.06522236, 0.68874294), vec4(3.1094313, 3.5188265, -1.9401165, -0.47256038), vec4(4.0372915, -6.2797914, 4.0877624, 0.31359324), vec4(-1.7055315, 0.9649301, -2.1472447, -2.900496)),
    mat4(vec4(-1.4472071, 2.2963274, 2.3705218, 2.2554681), vec4(-0.16153613, -0.079673834, -0.018015817, -0.060150318), vec4(0.12294772, 0.028992303, -0.045555186, -0.019207442), vec4(0.8507081, -4.3222938, -0.41577208, -3.083476)),
    mat4(vec4(-1.8410957, 1.7540334, 3.9001808, -2.7371724), vec4(0.95275414, 6.0513377, -0.5543268, -0.15700881), vec4(0.23935543, -1.0129763, 2.4374366, -0.07785691), vec4(0.5560535, 1.7531751, -0.3538989, 2.367496)),
    mat4(vec4(-3.226583, 1.2359289, 0.43497178, -0.9067162), vec4(0.015556864, -0.015596202, -0.03136817, -0.15938309), vec4(-0.0067569828, -0.034082763, 0.06610979, 0.1136526), vec4(-0.08873681, 4.608044, -0.6641942, 4.2482862)),
    mat4(vec4(0.06337031, -6.222001, 5.6063294, 1.8426031), vec4(0.10653678, -6.1321445, 1.5532417, -0.1410054), vec4(0.06972793, 0.6201484, -0.56711805, -0.43043935), vec4(-3.150539, 0.2765468, -0.3997977, -2.271611))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(0.6829811, 0.4552564, -3.2760596, 0.36013925), vec4(-0.5800463, 0.43397135, 1.69264, 0.30690542), vec4(-0.4783497, -1.8769186, -0.36985078, 0.45314348), vec4(-0.5759224, 1.6655363, 0.21339335, -0.35386586)),
    mat4(vec4(0.2372832, -1.2258506, -1.2100883, 0.62600815), vec4(-0.066582575, -3.140791, 0.6086105, -0.1816485), vec4(1.6568266, 0.94366187, 1.452791, 0.6372167), vec4(0.94753206, -2.0465593, -1.1404506, 0.5200819)),
    mat4(vec4(0.2525698, 1.3133736, 1.5081309, 0.40640423), vec4(-2.5469668, 3.0647497, 1.961718, -0.2279379), vec4(0.7692778, 0.06353574, -0.04536396, 0.25547245), vec4(-0.38530406, 0.13071957, -0.9853148, -0.6100752)),
    mat4(vec4(1.201526, -1.6295567, -0.10577775, -0.07252603), vec4(0.32046694, 4.5078254, 1.679629, -1.3366163), vec4(0.42031792, 2.122224, -2.394823, 0.4862653), vec4(1.0541244, 3.2513852, 0.64063644, 0.9955936)),
    mat4(vec4(-0.4697213, -0.43738323, 0.5067631, 2.4849632), vec4(-1.008181, -3.3335292, -0.4435607, 1.2569082), vec4(37.271965, 3.6641302, -26.294731, 22.284088), vec4(0.35951728, 0.5743284, -0.28393292, 0.44884205)),
    mat4(vec4(1.4199101, -3.6519992, 0.183458, -0.7993746), vec4(-0.6794883, 1.0972006, -5.1737647, 0.46132165), vec4(0.28014812, 0.28579018, 1.746031, -1.063755), vec4(1.7801558, 0.8367786, 1.6030077, 0.11301107)),
    mat4(vec4(0.24823749, -1.8275152, -0.019702973, 0.87522876), vec4(-0.50621915, 1.1135135, -0.83415365, 0.8268544), vec4(-0.5979345, 0.15411714, -2.3568492, 0.8475188), vec4(-0.3274668, -1.5277493, 0.2688798, 0.27388895)),
    mat4(vec4(10.874971, 12.42683, 5.842559, -0.06638575), vec4(-0.65777004, -2.6616077, 1.2945762, -0.5985378), vec4(0.0049922424, -3.34325, 0.24058078, 0.6383325), vec4(-0.7965187, -0.4404988, -1.1006935, 1.348903)),
    mat4(vec4(-0.8094079, 1.7176261, -0.14377983, -2.757129), vec4(1.6921699, 0.3660209, -0.21817191, 2.6212182), vec4(-0.38670397, -0.15371713, -0.54104453, -0.517166), vec4(-1.6465904, -0.46712154, -0.6452769, 2.7078125)),
    mat4(vec4(0.09348285, -0.92333716, -0.319645, -1.3942697), vec4(2.403865, 0.8860558, -0.30477333, -3.6571066), vec4(1.70948, -0.3681143, 0.00028995858, -0.15613689), vec4(2.0479991, 1.0437464, -0.23805757, 0.5799883)),
    mat4(vec4(1.5732657, 0.47599813, -0.39566812, 2.6558812), vec4(0.16562577, -2.9809244, 0.26540557, 2.6580548), vec4(0.2961461, -2.7786427, -0.25035608, -1.6308049), vec4(-0.32568228, 0.4924949, -0.44617078, 1.3649439)),
    mat4(vec4(2.1699631, -1.9964819, 0.15565857, 1.8082404), vec4(-4.3035827, -0.22347507, -0.07782459, 0.8792134), vec4(1.1266261, 0.6317852, -0.50536454, 0.54505473), vec4(-0.784997, -0.15872337, -0.40840897, 0.6697734)),
    mat4(vec4(0.2951647, -0.6987558, 0.20762779, 0.12646148), vec4(-0.04911918, 1.463518, -0.18238348, -0.3969412), vec4(-31.135157, -37.478912, 0.3344418, 47.707455), vec4(-0.18904725, 0.59142, -0.059459895, -0.54543406)),
    mat4(vec4(-4.91993, 0.56642187, -0.36549205, -1.578996), vec4(-0.20717756, 1.3421755, 0.062208284, -2.920778), vec4(-2.4493325, -1.5143138, -0.60092473, 2.2542384), vec4(-4.9907455, -1.8576738, 0.09445477, -0.8239596)),
    mat4(vec4(0.37535796, -0.27190244, -0.026879478, 0.29014108), vec4(-1.5183576, -0.30159974, -0.09423651, -3.7453754), vec4(1.259349, 1.616043, -0.4829352, -0.7078577), vec4(-0.29548636, 1.4898285, -0.08079305, -1.240063)),
    mat4(vec4(-3.241739, -8.801097, -0.3190928, 14.118077), vec4(0.7231529, 2.0822303, -0.29040316, -1.3749658), vec4(0.41152754, 0.70593184, -0.2175248, -1.3170816), vec4(-0.4691217, 0.59334093, -0.2875347, -0.6505199)),
    mat4(vec4(0.2588046, 0.050598793, -0.1957072, -2.4178843), vec4(0.8062275, -0.35454574, -0.27731386, -1.8463589), vec4(-1.0551894, -0.53113884, 1.7193325, 1.3309753), vec4(3.8486824, -0.51003414, 1.3354453, 2.512551)),
    mat4(vec4(-6.962362, -0.23192449, -3.2870865, 0.21033812), vec4(-2.11509, -0.8931894, -1.7718272, -2.100163), vec4(0.72065806, -0.9571276, -4.074887, -1.375578), vec4(1.4292604, -0.16587515, -0.5036972, -0.48608148)),
    mat4(vec4(0.16909121, 0.2950534, -22.085249, 0.5762201), vec4(-1.8950677, 0.031374052, -0.0006421367, 3.3723443), vec4(-2.2480342, -0.5153087, -0.0328764, 0.7178497), vec4(-2.6809874, 0.7107395, -2.248753, 0.2450338)),
    mat4(vec4(1.3544649, -0.441318, 0.014433879, 1.1643527), vec4(7.6564403, -0.116867736, -11.974907, -0.4382366), vec4(0.18654051, -0.36403257, -0.792968, 1.3313892), vec4(1.2513425, -1.0578707, 0.22549942, -0.52266985)),
    mat4(vec4(-0.22287236, -0.4188799, 0.9217529, 0.55707884), vec4(0.13522571, -1.0391183, 1.9100517, -0.12969998), vec4(29.551878, 0.17746745, -6.0563235, -47.547195), vec4(-1.2280582, 0.22442098, -1.3063138, -1.3029408)),
    mat4(vec4(2.5341663, -0.4360425, -0.07981592, 0.3189538), vec4(-1.6002214, 0.09734367, -9.558946, 1.872932), vec4(1.3216597, -0.34509614, 2.825232, 1.6228634), vec4(0.6092978, -0.03591627, 3.5473008, 1.1023191)),
    mat4(vec4(0.3594169, -0.9171074, -3.784895, -0.7832569), vec4(-1.588527, -1.0116782, 0.9760825, -0.46781194), vec4(0.89400494, -0.03475846, -0.8669509, 0.5508923), vec4(-0.88579315, -0.15156104, -0.6192565, 2.7477405)),
    mat4(vec4(8.222077, -0.70817393, -2.307931, 2.1200726), vec4(-8.574386, -0.3667204, -7.1504316, -3.4449544), vec4(-0.6365092, -0.90271753, 1.0125942, 0.18720314), vec4(-0.82444096, 0.1657539, -0.34768492, -0.96311295)),
    mat4(vec4(1.7896386, -0.403414, -0.1782726, 0.7377316), vec4(3.399088, -0.11528515, 1.6411926, 1.8271717), vec4(0.27693757, 0.1787868, -2.6038008, -0.18954186), vec4(0.20033489, -0.14003548, -2.7112818, 4.896935)),
    mat4(vec4(1.1674491, -0.2839422, 0.58546615, -0.9488784), vec4(1.6502135, -0.10524968, -1.1594074, -0.99774444), vec4(-0.63047576, -0.12047331, -4.2065034, -0.6892302), vec4(-0.02288178, 0.17193796, 0.9352845, 1.1044908)),
    mat4(vec4(-1.328938, -0.12219198, 0.8097793, 0.013792836), vec4(-0.92077255, -0.058132254, 0.9649274, -0.6958826), vec4(-10.73252, 0.24786207, 1.4728177, -4.649633), vec4(-1.3106949, -0.25863177, 1.1633449, -0.6684613)),
    mat4(vec4(2.2923346, -0.48755655, -2.5706587, 1.5302451), vec4(-1.8465054, 0.30810782, -0.040619247, 2.2835648), vec4(0.31407765, -0.0032726983, -1.140029, 0.4757531), vec4(-0.06774242, 0.05301843, 1.2660664, 0.52409077)),
    mat4(vec4(0.096316226, -0.13515253, 1.9828489, -0.7120582), vec4(-0.052532572, -0.2707763, -1.3555428, 0.22093304), vec4(-17.776276, -0.3363576, 13.136999, 25.863195), vec4(-0.31807745, -0.07372902, -0.030780459, -0.75753033)),
    mat4(vec4(0.30170846, 0.03353345, 0.34369317, 1.9270494), vec4(-2.4706056, -0.010040872, 0.554029, 0.7586483), vec4(-1.1840302, 0.037181307, -0.3827963, 2.281691), vec4(-2.055089, -0.33115646, -6.3645334, -0.5354063)),
    mat4(vec4(0.6006043, -0.29821768, -1.7520251, 0.14276884), vec4(0.024878476, -0.27711263, 4.2765703, -0.9512076), vec4(-1.1752247, -0.47072172, -0.27052337, -0.72006303), vec4(0.7196898, -0.0633583, -1.5868052, -0.6702463)),
    mat4(vec4(4.140658, -0.18403074, -4.9940486, 2.4428742), vec4(0.34171128, -0.057354867, 4.1671295, -9.057711), vec4(0.98701304, -0.09638241, -3.6698697, -0.9148877), vec4(0.6410383, -0.23466079, 0.65903014, -0.31175098))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(-0.36086652, -2.0384705, -1.4668782, 0.18145208),
    vec4(1.1100335, -1.0497862, -0.26795477, 1.0546376),
    vec4(0.795125, -0.6150717, -2.491465, -1.7169538),
    vec4(-1.1883317, -0.21181983, -4.0430284, 0.21472351)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.521507, 0.34362823, 0.31546113, -0.34801242),
    vec4(0.21547896, 0.2207384, 0.21756127, -0.42271125),
    vec4(0.4423995, 0.27002415, 0.18167612, 0.22458315),
    vec4(0.19890426, -0.020198334, 0.15465632, -0.37186828)
);
const float NMT_B3 = -0.5558889;

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

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(mat2x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0)) - 0.05, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
const uint NMT_OCTAVE_BITS = 11u;
const uint NMT_HEAVY = 4u;
// Slots of a pixel, empty ones at the end among them, a multiple of four.
const uint NMT_SLOTS = 8u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const float NMT_KEY_SCALE = 0.375;
// The last step of absorbance, that of A = 10.
const uint NMT_LAST_ABSORBANCE = 27136u;
const uint NMT_LAST_DEPTH = (1u << NMT_DEPTH_BITS) - 1u;
const uint NMT_END_BITS = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
const uint NMT_LINEAR_BITS = 0x3a800000u;
const float NMT_LINEAR = 0.0009765625;

// Codes of a scene. The same for every fragment of a frame, in both passes.
struct NmtCodes { int first_bits; int last_bits; int first_log2; uint shift; uint multiplier; uint slope; };

// Logarithm of base 2 of the positive number with these bits, in units of 2^-23 octaves and 127 octaves more, by
// integers alone: bits are a logarithm that is linear in each octave, and a parabola bends it.
int nmt_core_log2(int bits) {
    int m = bits & 0x007fffff;
    int h = m >> 11;
    int l = m & 2047;
    int t = ((h * (4096 - h)) >> 1) + ((l * (2048 - h)) >> 11);
    return bits + ((11 * t) >> 5);
}

// Codes of a scene whose view depths lie in [v0, v1], 0 < v0 <= v1.
NmtCodes nmt_core_codes(float v0, float v1) {
    int first = floatBitsToInt(v0);
    int last = floatBitsToInt(v1);
    int first_log2 = nmt_core_log2(first);
    uint range = uint(nmt_core_log2(last) - first_log2);
    uint shift = max(uint(findMSB(range) + 1), NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
    uint multiplier = 0x80000000u / ((range >> shift) + 1u);
    uint room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    uint slope = min(uint(float(range >> 8u) * NMT_KEY_SCALE), room);
    return NmtCodes(first, last, first_log2, shift, multiplier, slope);
}

// Absorbance min(-ln(1 - alpha), 10) of an opacity.
float nmt_core_absorbance_of(float alpha) {
    return -log(max(1.0 - alpha, 0.000045399931));
}

// Steps of a fragment of view depth v.
uvec2 nmt_core_steps(float v, float absorbance, NmtCodes codes) {
    int place = nmt_core_log2(clamp(floatBitsToInt(v), codes.first_bits, codes.last_bits));
    uint w = uint(place - codes.first_log2) >> codes.shift;
    uint a = floatBitsToUint(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return uvec2(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
float nmt_core_depth(uvec2 steps) {
    return float(2u * steps.x + 1u) * (1.0 / float(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
float nmt_core_absorbance(uvec2 steps) {
    return uintBitsToFloat(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uvec2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uvec2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
float nmt_core_weigh(float z, float absorbance, vec4 depths0, vec4 absorbances0, vec4 depths1, vec4 absorbances1,
    float n, float b0, vec4 moments) {
    float front = 0.0 + (depths0.x < z ? absorbances0.x : 0.0);
    float in_core = (depths0.x == z && absorbances0.x == absorbance ? 1.0 : 0.0);
    float count = n - (absorbances0.x > 0.0 ? 1.0 : 0.0);
    float rest0 = b0 - absorbances0.x;
    float rest1 = moments.x - absorbances0.x * depths0.x;
    float rest2 = moments.y - absorbances0.x * depths0.x * depths0.x;
    float rest3 = moments.z - absorbances0.x * depths0.x * depths0.x * depths0.x;
    float rest4 = moments.w - absorbances0.x * depths0.x * depths0.x * depths0.x * depths0.x;
    float front_2 = front + (depths0.y < z ? absorbances0.y : 0.0);
    float in_core_2 = (depths0.y == z && absorbances0.y == absorbance ? 1.0 : in_core);
    float count_2 = count - (absorbances0.y > 0.0 ? 1.0 : 0.0);
    float rest0_2 = rest0 - absorbances0.y;
    float rest1_2 = rest1 - absorbances0.y * depths0.y;
    float rest2_2 = rest2 - absorbances0.y * depths0.y * depths0.y;
    float rest3_2 = rest3 - absorbances0.y * depths0.y * depths0.y * depths0.y;
    float rest4_2 = rest4 - absorbances0.y * depths0.y * depths0.y * depths0.y * depths0.y;
    float front_3 = front_2 + (depths0.z < z ? absorbances0.z : 0.0);
    float in_core_3 = (depths0.z == z && absorbances0.z == absorbance ? 1.0 : in_core_2);
    float count_3 = count_2 - (absorbances0.z > 0.0 ? 1.0 : 0.0);
    float rest0_3 = rest0_2 - absorbances0.z;
    float rest1_3 = rest1_2 - absorbances0.z * depths0.z;
    float rest2_3 = rest2_2 - absorbances0.z * depths0.z * depths0.z;
    float rest3_3 = rest3_2 - absorbances0.z * depths0.z * depths0.z * depths0.z;
    float rest4_3 = rest4_2 - absorbances0.z * depths0.z * depths0.z * depths0.z * depths0.z;
    float front_4 = front_3 + (depths0.w < z ? absorbances0.w : 0.0);
    float in_core_4 = (depths0.w == z && absorbances0.w == absorbance ? 1.0 : in_core_3);
    float count_4 = count_3 - (absorbances0.w > 0.0 ? 1.0 : 0.0);
    float rest0_4 = rest0_3 - absorbances0.w;
    float rest1_4 = rest1_3 - absorbances0.w * depths0.w;
    float rest2_4 = rest2_3 - absorbances0.w * depths0.w * depths0.w;
    float rest3_4 = rest3_3 - absorbances0.w * depths0.w * depths0.w * depths0.w;
    float rest4_4 = rest4_3 - absorbances0.w * depths0.w * depths0.w * depths0.w * depths0.w;
    float front_5 = front_4 + (depths1.x < z ? absorbances1.x : 0.0);
    float in_core_5 = (depths1.x == z && absorbances1.x == absorbance ? 1.0 : in_core_4);
    float count_5 = count_4 - (absorbances1.x > 0.0 ? 1.0 : 0.0);
    float rest0_5 = rest0_4 - absorbances1.x;
    float rest1_5 = rest1_4 - absorbances1.x * depths1.x;
    float rest2_5 = rest2_4 - absorbances1.x * depths1.x * depths1.x;
    float rest3_5 = rest3_4 - absorbances1.x * depths1.x * depths1.x * depths1.x;
    float rest4_5 = rest4_4 - absorbances1.x * depths1.x * depths1.x * depths1.x * depths1.x;
    float front_6 = front_5 + (depths1.y < z ? absorbances1.y : 0.0);
    float in_core_6 = (depths1.y == z && absorbances1.y == absorbance ? 1.0 : in_core_5);
    float count_6 = count_5 - (absorbances1.y > 0.0 ? 1.0 : 0.0);
    float rest0_6 = rest0_5 - absorbances1.y;
    float rest1_6 = rest1_5 - absorbances1.y * depths1.y;
    float rest2_6 = rest2_5 - absorbances1.y * depths1.y * depths1.y;
    float rest3_6 = rest3_5 - absorbances1.y * depths1.y * depths1.y * depths1.y;
    float rest4_6 = rest4_5 - absorbances1.y * depths1.y * depths1.y * depths1.y * depths1.y;
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_6 - center * rest0_6) * per_h;
    float moved2 = (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)) * (per_h * per_h);
    float moved3 = (rest3_6 - center * rest2_6 - center * (rest2_6 - center * rest1_6) - center * (rest2_6 - center
        * rest1_6 - center * (rest1_6 - center * rest0_6))) * (per_h * per_h * per_h);
    float moved4 = (rest4_6 - center * rest3_6 - center * (rest3_6 - center * rest2_6) - center * (rest3_6 - center
        * rest2_6 - center * (rest2_6 - center * rest1_6)) - center * (rest3_6 - center * rest2_6 - center * (rest2_6
        - center * rest1_6) - center * (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_6 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_6 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_6 - (removed > 0.0 ? 1.0 : 0.0);
    float absorbance_of_tail = clamp(tail0, 0.0, 1e30);
    float per_b0 = 1.0 / max(tail0, 1e-12);
    float m1 = clamp(tail1 * per_b0, -1.0, 1.0);
    float m2 = clamp(tail2 * per_b0, -1.0, 1.0);
    float m3 = clamp(tail3 * per_b0, -1.0, 1.0);
    float m4 = clamp(tail4 * per_b0, -1.0, 1.0);
    float own_step = per_h * 3.0517578e-5;
    float noise = b0 / max(absorbance_of_tail, 1e-12) * (per_h + abs(center) * per_h) * 1.9073486e-6;
    float exact = clamp((x - m1 - own_step * 0.25) / (own_step * 0.5 + noise), 0.0, 1.0);
    float variance = max(m2 - m1 * m1, 1e-9);
    float sum = clamp((m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1) / variance, -2.0, 2.0);
    float root = sqrt(sum * sum + 4.0 * variance);
    float near = 0.5 * (sum - root);
    float far_2 = 0.5 * (sum + root);
    float of_near = clamp(far_2 / root, 0.0, 1.0);
    float exact_2 = (others > 1.5 ? of_near * clamp((x - m1 - near - own_step * 0.25) / (own_step * 0.5 + (noise
        + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0) + (1.0 - of_near) * clamp((x - m1 - far_2 - own_step * 0.25)
        / (own_step * 0.5 + (noise + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0) : exact);
    float exact_3 = (z >= far ? 1.0 : exact_2);
    float exact_4 = (others < 0.5 || z <= depths0.x ? 0.0 : exact_3);
    if ((others < 2.5 || z >= far) || z <= depths0.x) {
        float known = min(exp(-(front_6 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_6) * nmt_transmittance(mat2x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
        + 0.05), mean), vec4(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean * mean, 1e-6), 0.0,
        1.0), mean_2, sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2
        * mean_2, 1e-6), 0.0, 1.0)), 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
vec2 nmt_core_slot(uint code, uvec2 steps) {
    return code > 0u ? vec2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : vec2(0.0);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
float nmt_core_transmittance(
    uvec2 steps,
    NmtCodes codes,
    uvec4 core0,
    uvec4 core1,
    float n,
    float b0,
    vec4 moments
) {
    vec2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    vec2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    vec2 slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    vec2 slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    vec2 slot4 = nmt_core_slot(core1.x, nmt_core_heavy_steps(core1.x, codes));
    vec2 slot5 = nmt_core_slot(core1.y, nmt_core_heavy_steps(core1.y, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4(slot0.y, slot1.y, slot2.y, slot3.y),
        vec4(slot4.x, slot5.x, 0.0, 0.0),
        vec4(slot4.y, slot5.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
layout(location = 0) uniform vec2 v_range;
layout(location = 1) uniform uint width;
layout(binding = 0) uniform sampler2D sums0_texture;
layout(binding = 1) uniform sampler2D sums1_texture;
layout(std430, binding = 0) readonly buffer Cores { uvec4 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint first = 2u * (uint(at.y) * width + uint(at.x));
    vec4 sums0 = texelFetch(sums0_texture, at, 0);
    vec4 sums1 = texelFetch(sums1_texture, at, 0);
    vec4 moments = vec4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, core[first], core[first + 1u], sums1.y, sums0.x, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
