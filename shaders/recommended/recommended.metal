// Neural moment transparency: network 'recommended', 7-32-16-1, 752 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.
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

#ifndef NMT_INCLUDED_RECOMMENDED
#define NMT_INCLUDED_RECOMMENDED

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType4 {
    metal::float4x4 inner[16];
};
struct NmtType5 {
    metal::float4x4 inner[32];
};
struct NmtType6 {
    metal::float4 inner[4];
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant NmtType4 NMT_W1 = NmtType4 {{metal::float4x4(metal::float4(-4.1674604, 1.9599856, -0.73242956, -0.20504631), metal::float4(-0.12590207, 0.52091557, 0.07906628, 0.021661459), metal::float4(0.08731185, -0.010980034, -0.04702237, -0.014140079), metal::float4(-2.3502588, 0.98347735, 5.2544265, 7.5886335)), metal::float4x4(metal::float4(-2.0677073, -3.0403187, -7.251252, -0.21163398), metal::float4(4.0386076, -0.3408012, -6.547609, -0.27915618), metal::float4(2.371881, -3.6694639, 2.8083203, 0.16396397), metal::float4(-4.5592628, 3.2408876, 0.7731898, -6.0322914)), metal::float4x4(metal::float4(-0.46817917, 2.2209268, 0.42732853, -2.1391058), metal::float4(0.6626024, 0.12554957, 0.15880474, 0.08205461), metal::float4(-0.002107043, 0.067374885, -0.04141126, 0.018053476), metal::float4(-0.02131919, -5.3346705, 6.854231, 0.49863964)), metal::float4x4(metal::float4(-2.3983507, -2.2166302, -9.364158, -4.6879478), metal::float4(-7.131321, 0.9307025, -5.2908893, -0.09217429), metal::float4(0.18057501, -0.056932688, -5.222522, 5.909689), metal::float4(-3.2400908, 1.7953771, 2.3643174, -2.5787416)), metal::float4x4(metal::float4(-2.0212417, 3.5234349, -0.29862827, 2.837473), metal::float4(-0.0034417917, -0.2701374, -0.06850981, 0.26511696), metal::float4(0.06310855, -0.074502654, 0.0036534448, -0.02181142), metal::float4(1.1280895, -0.06773128, 7.143841, -0.33201975)), metal::float4x4(metal::float4(-5.189434, -2.4549117, -0.16383393, 2.9110465), metal::float4(-3.691939, -2.2927215, -1.7290045, 0.5228869), metal::float4(3.423124, 4.379191, -0.54773974, -2.3272412), metal::float4(0.18388788, 1.0360488, -2.4800966, 1.8856108)), metal::float4x4(metal::float4(-3.5864356, 3.698348, -2.763185, -2.920156), metal::float4(0.78295255, 0.015520756, -0.32045588, -0.06508547), metal::float4(0.009859245, -0.076360114, 0.06714014, 0.014959682), metal::float4(-0.39343145, -0.1780676, 4.0171967, -0.3578333)), metal::float4x4(metal::float4(1.4050651, 0.118033335, -6.476847, -0.18825664), metal::float4(0.19789477, -0.5731352, -5.180575, 3.0493782), metal::float4(-0.75208825, 6.0289307, 3.036596, 0.6782269), metal::float4(-4.040601, -2.1219463, -0.72817266, 0.23356485)), metal::float4x4(metal::float4(0.33965114, 0.53012913, 3.6864781, 0.75859493), metal::float4(0.00060585595, -2.9309227, -0.36718613, -0.3317407), metal::float4(0.033321146, 1.2089126, 0.2153916, -0.0014231349), metal::float4(7.1874413, 0.3191635, -8.419987, -2.4559073)), metal::float4x4(metal::float4(-11.693587, -2.831591, -2.3943553, -8.275588), metal::float4(-7.1602225, -0.7036662, 2.2086513, 3.6333103), metal::float4(4.0300922, 1.7700683, 1.188168, 7.4534593), metal::float4(0.7538325, -0.7767871, 0.016310979, 0.18021783)), metal::float4x4(metal::float4(-1.3306596, 1.8677293, -4.101393, -4.6770787), metal::float4(0.19519782, -0.48456788, -0.20488237, 0.021339769), metal::float4(-0.010044715, -0.031366363, 0.050242912, 0.015430227), metal::float4(-4.2732124, 1.70702, 0.0028088223, -0.010693944)), metal::float4x4(metal::float4(-3.774896, -1.1750406, -0.93092984, -0.049676165), metal::float4(4.5747614, -0.64899164, -0.34892794, -0.11725599), metal::float4(-2.6529639, -2.241756, 1.2695652, 0.121937424), metal::float4(1.5011057, 2.9329836, -3.6110363, -4.5134344)), metal::float4x4(metal::float4(-4.6046376, 3.0093236, 4.978195, 1.5529538), metal::float4(-5.0088716, 0.49800482, 0.108492136, 0.17909843), metal::float4(0.19106047, 0.006962222, -0.0562687, -0.05636758), metal::float4(2.4868011, -2.9974, 1.1363013, 0.8436937)), metal::float4x4(metal::float4(-3.112934, 2.7212074, -0.7725423, 2.895838), metal::float4(-1.4298413, 2.0517163, -5.190096, -2.2426555), metal::float4(1.0851005, 1.2990258, 1.9417673, -7.12554), metal::float4(-1.7792232, 0.8998802, 0.6199238, 1.7865978)), metal::float4x4(metal::float4(-4.373691, 7.469767, 0.73178667, 0.19036344), metal::float4(0.18150902, -0.09014448, -0.10938936, 0.30877957), metal::float4(-0.00059860875, -0.04931852, -0.033257622, 0.008763494), metal::float4(0.013503743, -1.9672016, -3.3122485, 2.5027857)), metal::float4x4(metal::float4(-0.16557512, -2.3265748, 3.9967105, 5.9642453), metal::float4(4.2863545, -0.5382311, 1.9298717, -1.1969867), metal::float4(-1.3004589, -0.5782102, -3.2860882, 0.18440095), metal::float4(0.19718102, -2.082068, 1.6094493, -3.5837553))}};
constant NmtType5 NMT_W2 = NmtType5 {{metal::float4x4(metal::float4(2.0213919, -2.91184, 1.5348691, -0.2929838), metal::float4(1.3055472, 0.27231, -0.8899139, -0.4409711), metal::float4(0.11069353, -1.8431019, 0.17304926, 0.8809019), metal::float4(-5.399847, -17.517437, 0.47533467, 6.2987537)), metal::float4x4(metal::float4(0.419285, -0.42110118, 2.5071044, -1.4210333), metal::float4(-0.7503765, 0.8864603, 0.037235156, 0.37260938), metal::float4(0.6845067, 0.44033587, -0.28448498, 0.24686478), metal::float4(2.7418797, 1.6742915, 0.8079822, -0.8698964)), metal::float4x4(metal::float4(0.9036239, -0.82326996, -0.8262928, -0.335104), metal::float4(-0.41287225, -0.55577654, -1.3758198, -0.18870488), metal::float4(-0.63340414, 0.42160872, 0.7002752, 2.267698), metal::float4(-1.08188, -3.98043, -1.4021765, 0.6892029)), metal::float4x4(metal::float4(3.4161088, 0.7640683, 1.9327487, 1.83947), metal::float4(-5.0462413, -0.713245, -0.014138731, -0.31107137), metal::float4(1.3723212, 2.744764, -0.30109656, -0.48658893), metal::float4(0.26442823, -1.2755157, 0.42979032, 0.022228852)), metal::float4x4(metal::float4(0.9166541, 2.8674293, -2.7461586, -0.11615238), metal::float4(0.077809386, -2.372911, -0.1854338, 0.5619069), metal::float4(-1.2895492, -0.69098186, -1.6812513, 0.17504105), metal::float4(-1.556445, 1.623512, 1.1337266, 2.044273)), metal::float4x4(metal::float4(-0.8967381, 2.4832838, 0.3154895, 0.5799579), metal::float4(0.76742953, -1.2556587, 1.0351061, 0.9519333), metal::float4(0.7550382, -0.7536835, -8.745191, -0.5979435), metal::float4(-0.6330228, -5.822986, -24.325792, 3.6463118)), metal::float4x4(metal::float4(-0.16797684, 1.0777332, -0.6376268, -0.33728403), metal::float4(-1.061007, 2.0483856, 1.2846082, -0.06528943), metal::float4(-2.8672419, -0.13821496, -0.40658525, -0.7010545), metal::float4(0.73339987, 0.85867685, -2.980733, -0.6767882)), metal::float4x4(metal::float4(-0.17565668, -0.66932446, -0.087680444, 0.82007885), metal::float4(-0.81018645, -5.083275, 6.716149, -2.5253572), metal::float4(-0.21873666, 1.6195232, 0.10287789, -0.7853111), metal::float4(-0.8664899, 1.8022391, 0.12425704, -0.12265211)), metal::float4x4(metal::float4(-0.019619394, -2.9439027, 0.20967697, -3.419845), metal::float4(-3.0203755, -0.17222819, -0.21907517, -0.1506443), metal::float4(0.2171478, -0.16118884, -0.34547976, 3.1116161), metal::float4(0.59133464, 0.16578314, -0.26919577, -17.852287)), metal::float4x4(metal::float4(-1.9658519, -0.026431112, -0.32840747, 2.9921103), metal::float4(-3.432273, 0.28572825, -0.3039937, -1.5232166), metal::float4(-1.0966971, -0.76801056, 0.27018806, 3.2838664), metal::float4(-0.8133999, -0.12406365, -0.23587477, 0.42709732)), metal::float4x4(metal::float4(-6.489317, 0.13252488, -0.26811773, 2.2592547), metal::float4(-3.6722937, 0.4313345, 0.27116078, -0.16659443), metal::float4(0.10130279, 0.19058819, 0.043735087, -3.4506261), metal::float4(2.148812, -1.1394475, -0.23171818, -2.8741112)), metal::float4x4(metal::float4(0.6639304, 3.6351647, 0.15170369, -0.9139982), metal::float4(1.5778636, -0.57759607, -0.076416016, -17.85372), metal::float4(-2.942476, -1.2473558, -0.3413897, 1.8454653), metal::float4(-6.107756, -0.2496649, -0.2933674, -0.3217662)), metal::float4x4(metal::float4(0.27639863, -0.020356344, 0.20805937, 5.0024533), metal::float4(0.27502623, 0.33333814, -0.17369579, 0.3428085), metal::float4(0.2811654, -0.09691671, 0.3376751, -4.3889575), metal::float4(0.5050634, 0.056959357, 0.15600675, 0.9328736)), metal::float4x4(metal::float4(0.6798183, 0.561105, -0.29834086, -1.388716), metal::float4(0.93923146, -0.38923523, -0.0074161366, -0.62310964), metal::float4(-0.27356088, -3.8132336, -0.326761, -3.2853408), metal::float4(-0.17321798, -10.054951, 0.094018586, -4.1044903)), metal::float4x4(metal::float4(-2.9375002, -1.5772644, -0.028824203, 0.39525685), metal::float4(0.2538739, 0.6404099, -0.08917889, -0.23136254), metal::float4(-1.4123424, 0.49519774, -0.28288534, -4.4888506), metal::float4(-0.19552387, 0.031744648, -0.024117399, 3.5014074)), metal::float4x4(metal::float4(-6.388915, 0.25000545, -0.319836, -0.93253845), metal::float4(9.816028, 2.536431, 0.09538501, -0.33083022), metal::float4(-3.8032932, 1.2661434, -0.16308375, -2.2764294), metal::float4(1.7594389, -0.51916075, -0.13081738, -2.6253278)), metal::float4x4(metal::float4(1.9530706, -1.8485831, 0.2109906, -0.25858083), metal::float4(0.93915653, 1.6989772, 0.10935656, 3.243871), metal::float4(-1.668992, 0.26239094, -0.19926538, -0.2640662), metal::float4(-4.7925825, -1.5411111, -1.9145753, 1.6478897)), metal::float4x4(metal::float4(-0.35818458, 1.2148889, 0.3322431, 2.009875), metal::float4(-0.88717693, 2.085225, -0.059712175, -0.7660865), metal::float4(-5.2038116, 1.1421809, -0.069393694, -1.2104797), metal::float4(1.4166483, 8.891604, -0.19883786, 2.5516102)), metal::float4x4(metal::float4(-0.8331628, -0.74940425, -0.5258979, -0.38192207), metal::float4(-0.61086315, -1.6954087, 0.03969145, 2.0987928), metal::float4(0.17930607, -0.91649634, -0.14285758, -1.7155297), metal::float4(0.8023482, 0.7970375, 0.6197916, -5.2210584)), metal::float4x4(metal::float4(-2.5854452, 5.9796576, 0.61167616, 0.4250337), metal::float4(1.3043399, 2.8135962, -0.05531424, -0.15286618), metal::float4(1.3677459, 2.6523335, 0.37061626, 0.8490703), metal::float4(-0.28107482, -19.692179, -0.19836535, -1.71023)), metal::float4x4(metal::float4(1.2583504, -0.7968344, 0.369631, 0.28707027), metal::float4(0.32727537, 0.16690618, -0.3634363, 0.88905156), metal::float4(0.014350122, -0.15114553, 0.2937969, 1.5788385), metal::float4(-4.5339465, -0.17390747, -0.241532, 0.70758146)), metal::float4x4(metal::float4(-0.5519906, 2.8230247, 0.05278055, 0.54575557), metal::float4(-1.3154308, 0.656429, 0.7821612, -9.275172), metal::float4(1.1405544, -2.1575017, 1.4119513, 0.7853599), metal::float4(3.2076383, -6.13053, 15.256626, -12.406102)), metal::float4x4(metal::float4(1.2811682, 0.083948754, -0.37948, -0.4940118), metal::float4(-1.1444502, -2.5660405, -0.552346, 0.1214361), metal::float4(0.5068235, -0.47298962, 0.4408889, -2.732477), metal::float4(-0.5066367, -0.8545023, -0.51588374, -1.2569976)), metal::float4x4(metal::float4(0.5785463, -32.425995, 0.42408907, 0.9343084), metal::float4(-3.902431, -0.7520251, -0.06531561, -4.5250793), metal::float4(1.669008, 1.2654543, 0.5549053, 3.3851264), metal::float4(-0.31843388, -0.1135918, 0.2259276, 3.8177497)), metal::float4x4(metal::float4(1.9812528, -0.36313337, -0.7867708, -1.8871622), metal::float4(-0.3773511, -0.16610058, 1.1051798, 1.2316991), metal::float4(1.8488358, -0.046805546, -0.6921194, -0.5387434), metal::float4(0.3181373, -0.18279947, -1.689014, 3.066741)), metal::float4x4(metal::float4(-0.34661636, -0.4327142, 1.5718977, -0.5606247), metal::float4(-0.03964064, -0.23198833, 0.47888073, -0.5954511), metal::float4(-0.36834794, -0.23371373, 0.15666945, 0.93414724), metal::float4(-0.281857, 0.20966858, 8.412329, 9.048968)), metal::float4x4(metal::float4(-0.34866777, -0.29574445, 2.2201583, 1.0108215), metal::float4(2.1363382, -0.027613534, -1.1590986, -0.66171604), metal::float4(0.34671408, 0.07055651, -0.63689375, -0.49965852), metal::float4(-1.2961404, -0.75858885, 0.23002268, 0.47372976)), metal::float4x4(metal::float4(-0.008777903, -0.58365583, -7.097225, -0.7343006), metal::float4(-2.659016, 0.31216386, 0.68762773, 0.2661025), metal::float4(-1.6388949, -0.17292544, -0.52062505, -0.22462904), metal::float4(0.8361993, -0.09593139, -4.261884, -0.79932857)), metal::float4x4(metal::float4(-0.23727515, -0.091116585, 0.93601537, -2.982952), metal::float4(0.032420382, -0.21857665, -0.6826385, 0.1599772), metal::float4(0.47912702, -0.3265304, -0.20499313, -1.6727635), metal::float4(1.9387163, -0.111314304, -0.61201704, 2.9126418)), metal::float4x4(metal::float4(-0.80854404, 0.07845742, -2.8177385, 0.109425806), metal::float4(0.19731739, -0.1832566, 0.387768, 0.2938763), metal::float4(-1.713297, 0.05192612, -10.083423, -0.7480528), metal::float4(-8.829212, -0.33925098, -16.97128, -2.5043054)), metal::float4x4(metal::float4(-0.6140045, -0.27008948, -0.00565183, 0.40399697), metal::float4(1.3195682, -0.2859485, -0.6891265, -0.010279318), metal::float4(-0.27614084, -0.34485704, 1.0004749, -2.5375779), metal::float4(0.1936343, -0.15814485, -0.32213724, -0.7124809)), metal::float4x4(metal::float4(-1.5785738, -0.5448545, -7.9740224, -0.3882083), metal::float4(-1.0468239, -0.4249315, -0.3257484, -0.8561734), metal::float4(-0.07593948, -0.07261215, 0.73661035, 0.53244424), metal::float4(0.6394129, -0.39995986, -1.0125879, -0.50449544))}};
constant NmtType6 NMT_B2 = NmtType6 {{metal::float4(1.5403837, -1.8343279, -0.9217493, 1.313698), metal::float4(-7.616127, 0.743722, -0.04113058, -1.5676365), metal::float4(-1.6024822, 0.326761, -5.2702546, -9.288301), metal::float4(2.192788, -0.38622347, 1.562341, -3.0405202)}};
constant NmtType6 NMT_W3 = NmtType6 {{metal::float4(-0.23133157, 0.07465856, 0.11972243, -0.19268681), metal::float4(0.34225202, 0.15328355, -0.12462099, -0.17171375), metal::float4(0.09308249, 0.25963008, -0.57784873, 0.18180469), metal::float4(0.15193784, 0.23329662, 0.12255926, -0.111732274)}};
constant float NMT_B3 = -1.1533976;
constant float NMT_FAINT = 0.0625;
constant float NMT_HIDDEN = 0.00095;

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
    float range_2 = farthest - nearest;
    float t = (v_1 - nearest) / metal::max(range_2, 0.000000000000000000000000000001);
    float x_1 = t * (1.0 + ((0.5 * (range_2 / nearest)) * (1.0 - t)));
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

metal::float2x4 nmt_recentred(
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
    float front = -1.0;
    float c_1 = 0.5 * (z_nearest + z_farthest);
    float others = metal::clamp(b0 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    float per_b0_1 = 1.0 / metal::max(metal::max(others, b0 * 0.000001), 0.000000000000000000000000000001);
    float per_h_1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
    metal::float4 _e31 = nmt_recentred_moments(z_2, absorbance_2, c_1, per_h_1, per_b0_1, b_2);
    float noise_growth = 1.0 + ((2.0 * metal::abs(c_1)) * per_h_1);
    float moment_noise = ((NMT_ROUNDING * noise_growth) * b0) * per_b0_1;
    float noise1 = moment_noise * (0.12 * metal::sqrt(n));
    float per_n = 1.0 / n;
    float _e54 = nmt_shrink_to_prior(_e31.x, 0.0, noise1, 0.22 + (0.7 * per_n));
    float _e60 = nmt_place_in_thin(v_2, nearest_1, farthest_1);
    float x_2 = (0.01 > ((farthest_1 - nearest_1) / nearest_1)) ? _e60 : metal::clamp((z_2 - c_1) * per_h_1, -1.0, 1.0);
    float further = noise_growth * 0.87;
    float noise2 = noise1 * further;
    float noise3 = noise2 * further;
    float most0 = metal::max(1.0 - (_e54 * _e54), 0.000001);
    float raw_spread0 = metal::clamp((_e31.y - (_e54 * _e54)) / most0, 0.0, 1.0);
    float _e91 = nmt_shrink_to_prior(raw_spread0, 0.3 + (1.8 * per_n), noise2 / most0, 0.12 + (0.5 * per_n));
    float per_mass1 = 1.0 / metal::max(1.0 - _e31.y, 0.000001);
    float raw_mean1 = metal::clamp((_e31.x - _e31.z) * per_mass1, -1.0, 1.0);
    float expected_mean1 = (_e54 * (1.0 - _e91)) / (1.0 + _e91);
    float deviation_1 = (0.17 + (3.1 * per_n)) * (_e91 + 0.02);
    float noise_1 = noise3 * per_mass1;
    float all_noise = noise_1 + (0.0000009536743 * per_mass1);
    float _e123 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise_1, deviation_1);
    float transition_width_1 = (all_noise * deviation_1) / (all_noise + deviation_1);
    float _e129 = front;
    float _e130 = nmt_share_of_four(x_2, _e54, _e91, _e123, transition_width_1);
    front = (n == 4.0) ? (others * _e130) : _e129;
    float _e135 = front;
    front = (n == 3.0) ? (others * metal::clamp(0.5 - (0.5 * _e54), 0.0, 1.0)) : _e135;
    float _e147 = front;
    front = (v_2 == farthest_1) ? others : _e147;
    float _e150 = front;
    front = (others > (0.000001 * b0)) ? _e150 : 0.0;
    float _e156 = front;
    front = (v_2 == nearest_1) ? 0.0 : _e156;
    float _e160 = front;
    float _e165 = front;
    float known = (_e165 >= 0.0) ? metal::min(metal::exp(-(_e160)), 1.0) : -1.0;
    float most1 = metal::max(1.0 - (_e123 * _e123), 0.000001);
    float raw_square1 = metal::clamp((((_e31.y - _e31.w) * per_mass1) - (_e123 * _e123)) / most1, 0.0, 1.0);
    float offset = (_e123 * (1.0 + _e91)) - (_e54 * (1.0 - _e91));
    float square0 = _e91 * _e91;
    float expected_square1 = metal::clamp(((((0.94 - (3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * _e91) / ((1.0 + _e91) + _e91), 0.0, 1.0);
    float _e223 = nmt_shrink_to_prior(raw_square1, expected_square1, ((noise3 * further) * per_mass1) / most1, (0.12 + (1.4 * per_n)) * (_e91 + 0.02));
    float spread1 = metal::sqrt(_e223);
    return metal::float2x4(metal::float4(x_2, (metal::log(n) * 0.48089835) - 1.0, metal::log(others + 0.05), _e54), metal::float4(_e91, _e123, spread1, known));
}

float nmt_share(
    metal::float2x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = metal::float4(f[1].xyz, 1.0);
    metal::float4 h1_0 = metal::max((metal::float4x4(metal::float4(-4.1674604, 1.9599856, -0.73242956, -0.20504631), metal::float4(-0.12590207, 0.52091557, 0.07906628, 0.021661459), metal::float4(0.08731185, -0.010980034, -0.04702237, -0.014140079), metal::float4(-2.3502588, 0.98347735, 5.2544265, 7.5886335)) * h0_0) + (metal::float4x4(metal::float4(-2.0677073, -3.0403187, -7.251252, -0.21163398), metal::float4(4.0386076, -0.3408012, -6.547609, -0.27915618), metal::float4(2.371881, -3.6694639, 2.8083203, 0.16396397), metal::float4(-4.5592628, 3.2408876, 0.7731898, -6.0322914)) * h0_1), metal::float4(0.0));
    metal::float4 h1_1 = metal::max((metal::float4x4(metal::float4(-0.46817917, 2.2209268, 0.42732853, -2.1391058), metal::float4(0.6626024, 0.12554957, 0.15880474, 0.08205461), metal::float4(-0.002107043, 0.067374885, -0.04141126, 0.018053476), metal::float4(-0.02131919, -5.3346705, 6.854231, 0.49863964)) * h0_0) + (metal::float4x4(metal::float4(-2.3983507, -2.2166302, -9.364158, -4.6879478), metal::float4(-7.131321, 0.9307025, -5.2908893, -0.09217429), metal::float4(0.18057501, -0.056932688, -5.222522, 5.909689), metal::float4(-3.2400908, 1.7953771, 2.3643174, -2.5787416)) * h0_1), metal::float4(0.0));
    metal::float4 h1_2 = metal::max((metal::float4x4(metal::float4(-2.0212417, 3.5234349, -0.29862827, 2.837473), metal::float4(-0.0034417917, -0.2701374, -0.06850981, 0.26511696), metal::float4(0.06310855, -0.074502654, 0.0036534448, -0.02181142), metal::float4(1.1280895, -0.06773128, 7.143841, -0.33201975)) * h0_0) + (metal::float4x4(metal::float4(-5.189434, -2.4549117, -0.16383393, 2.9110465), metal::float4(-3.691939, -2.2927215, -1.7290045, 0.5228869), metal::float4(3.423124, 4.379191, -0.54773974, -2.3272412), metal::float4(0.18388788, 1.0360488, -2.4800966, 1.8856108)) * h0_1), metal::float4(0.0));
    metal::float4 h1_3 = metal::max((metal::float4x4(metal::float4(-3.5864356, 3.698348, -2.763185, -2.920156), metal::float4(0.78295255, 0.015520756, -0.32045588, -0.06508547), metal::float4(0.009859245, -0.076360114, 0.06714014, 0.014959682), metal::float4(-0.39343145, -0.1780676, 4.0171967, -0.3578333)) * h0_0) + (metal::float4x4(metal::float4(1.4050651, 0.118033335, -6.476847, -0.18825664), metal::float4(0.19789477, -0.5731352, -5.180575, 3.0493782), metal::float4(-0.75208825, 6.0289307, 3.036596, 0.6782269), metal::float4(-4.040601, -2.1219463, -0.72817266, 0.23356485)) * h0_1), metal::float4(0.0));
    metal::float4 h1_4 = metal::max((metal::float4x4(metal::float4(0.33965114, 0.53012913, 3.6864781, 0.75859493), metal::float4(0.00060585595, -2.9309227, -0.36718613, -0.3317407), metal::float4(0.033321146, 1.2089126, 0.2153916, -0.0014231349), metal::float4(7.1874413, 0.3191635, -8.419987, -2.4559073)) * h0_0) + (metal::float4x4(metal::float4(-11.693587, -2.831591, -2.3943553, -8.275588), metal::float4(-7.1602225, -0.7036662, 2.2086513, 3.6333103), metal::float4(4.0300922, 1.7700683, 1.188168, 7.4534593), metal::float4(0.7538325, -0.7767871, 0.016310979, 0.18021783)) * h0_1), metal::float4(0.0));
    metal::float4 h1_5 = metal::max((metal::float4x4(metal::float4(-1.3306596, 1.8677293, -4.101393, -4.6770787), metal::float4(0.19519782, -0.48456788, -0.20488237, 0.021339769), metal::float4(-0.010044715, -0.031366363, 0.050242912, 0.015430227), metal::float4(-4.2732124, 1.70702, 0.0028088223, -0.010693944)) * h0_0) + (metal::float4x4(metal::float4(-3.774896, -1.1750406, -0.93092984, -0.049676165), metal::float4(4.5747614, -0.64899164, -0.34892794, -0.11725599), metal::float4(-2.6529639, -2.241756, 1.2695652, 0.121937424), metal::float4(1.5011057, 2.9329836, -3.6110363, -4.5134344)) * h0_1), metal::float4(0.0));
    metal::float4 h1_6 = metal::max((metal::float4x4(metal::float4(-4.6046376, 3.0093236, 4.978195, 1.5529538), metal::float4(-5.0088716, 0.49800482, 0.108492136, 0.17909843), metal::float4(0.19106047, 0.006962222, -0.0562687, -0.05636758), metal::float4(2.4868011, -2.9974, 1.1363013, 0.8436937)) * h0_0) + (metal::float4x4(metal::float4(-3.112934, 2.7212074, -0.7725423, 2.895838), metal::float4(-1.4298413, 2.0517163, -5.190096, -2.2426555), metal::float4(1.0851005, 1.2990258, 1.9417673, -7.12554), metal::float4(-1.7792232, 0.8998802, 0.6199238, 1.7865978)) * h0_1), metal::float4(0.0));
    metal::float4 h1_7 = metal::max((metal::float4x4(metal::float4(-4.373691, 7.469767, 0.73178667, 0.19036344), metal::float4(0.18150902, -0.09014448, -0.10938936, 0.30877957), metal::float4(-0.00059860875, -0.04931852, -0.033257622, 0.008763494), metal::float4(0.013503743, -1.9672016, -3.3122485, 2.5027857)) * h0_0) + (metal::float4x4(metal::float4(-0.16557512, -2.3265748, 3.9967105, 5.9642453), metal::float4(4.2863545, -0.5382311, 1.9298717, -1.1969867), metal::float4(-1.3004589, -0.5782102, -3.2860882, 0.18440095), metal::float4(0.19718102, -2.082068, 1.6094493, -3.5837553)) * h0_1), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.5403837, -1.8343279, -0.9217493, 1.313698) + (metal::float4x4(metal::float4(2.0213919, -2.91184, 1.5348691, -0.2929838), metal::float4(1.3055472, 0.27231, -0.8899139, -0.4409711), metal::float4(0.11069353, -1.8431019, 0.17304926, 0.8809019), metal::float4(-5.399847, -17.517437, 0.47533467, 6.2987537)) * h1_0)) + (metal::float4x4(metal::float4(0.419285, -0.42110118, 2.5071044, -1.4210333), metal::float4(-0.7503765, 0.8864603, 0.037235156, 0.37260938), metal::float4(0.6845067, 0.44033587, -0.28448498, 0.24686478), metal::float4(2.7418797, 1.6742915, 0.8079822, -0.8698964)) * h1_1)) + (metal::float4x4(metal::float4(0.9036239, -0.82326996, -0.8262928, -0.335104), metal::float4(-0.41287225, -0.55577654, -1.3758198, -0.18870488), metal::float4(-0.63340414, 0.42160872, 0.7002752, 2.267698), metal::float4(-1.08188, -3.98043, -1.4021765, 0.6892029)) * h1_2)) + (metal::float4x4(metal::float4(3.4161088, 0.7640683, 1.9327487, 1.83947), metal::float4(-5.0462413, -0.713245, -0.014138731, -0.31107137), metal::float4(1.3723212, 2.744764, -0.30109656, -0.48658893), metal::float4(0.26442823, -1.2755157, 0.42979032, 0.022228852)) * h1_3)) + (metal::float4x4(metal::float4(0.9166541, 2.8674293, -2.7461586, -0.11615238), metal::float4(0.077809386, -2.372911, -0.1854338, 0.5619069), metal::float4(-1.2895492, -0.69098186, -1.6812513, 0.17504105), metal::float4(-1.556445, 1.623512, 1.1337266, 2.044273)) * h1_4)) + (metal::float4x4(metal::float4(-0.8967381, 2.4832838, 0.3154895, 0.5799579), metal::float4(0.76742953, -1.2556587, 1.0351061, 0.9519333), metal::float4(0.7550382, -0.7536835, -8.745191, -0.5979435), metal::float4(-0.6330228, -5.822986, -24.325792, 3.6463118)) * h1_5)) + (metal::float4x4(metal::float4(-0.16797684, 1.0777332, -0.6376268, -0.33728403), metal::float4(-1.061007, 2.0483856, 1.2846082, -0.06528943), metal::float4(-2.8672419, -0.13821496, -0.40658525, -0.7010545), metal::float4(0.73339987, 0.85867685, -2.980733, -0.6767882)) * h1_6)) + (metal::float4x4(metal::float4(-0.17565668, -0.66932446, -0.087680444, 0.82007885), metal::float4(-0.81018645, -5.083275, 6.716149, -2.5253572), metal::float4(-0.21873666, 1.6195232, 0.10287789, -0.7853111), metal::float4(-0.8664899, 1.8022391, 0.12425704, -0.12265211)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(-7.616127, 0.743722, -0.04113058, -1.5676365) + (metal::float4x4(metal::float4(-0.019619394, -2.9439027, 0.20967697, -3.419845), metal::float4(-3.0203755, -0.17222819, -0.21907517, -0.1506443), metal::float4(0.2171478, -0.16118884, -0.34547976, 3.1116161), metal::float4(0.59133464, 0.16578314, -0.26919577, -17.852287)) * h1_0)) + (metal::float4x4(metal::float4(-1.9658519, -0.026431112, -0.32840747, 2.9921103), metal::float4(-3.432273, 0.28572825, -0.3039937, -1.5232166), metal::float4(-1.0966971, -0.76801056, 0.27018806, 3.2838664), metal::float4(-0.8133999, -0.12406365, -0.23587477, 0.42709732)) * h1_1)) + (metal::float4x4(metal::float4(-6.489317, 0.13252488, -0.26811773, 2.2592547), metal::float4(-3.6722937, 0.4313345, 0.27116078, -0.16659443), metal::float4(0.10130279, 0.19058819, 0.043735087, -3.4506261), metal::float4(2.148812, -1.1394475, -0.23171818, -2.8741112)) * h1_2)) + (metal::float4x4(metal::float4(0.6639304, 3.6351647, 0.15170369, -0.9139982), metal::float4(1.5778636, -0.57759607, -0.076416016, -17.85372), metal::float4(-2.942476, -1.2473558, -0.3413897, 1.8454653), metal::float4(-6.107756, -0.2496649, -0.2933674, -0.3217662)) * h1_3)) + (metal::float4x4(metal::float4(0.27639863, -0.020356344, 0.20805937, 5.0024533), metal::float4(0.27502623, 0.33333814, -0.17369579, 0.3428085), metal::float4(0.2811654, -0.09691671, 0.3376751, -4.3889575), metal::float4(0.5050634, 0.056959357, 0.15600675, 0.9328736)) * h1_4)) + (metal::float4x4(metal::float4(0.6798183, 0.561105, -0.29834086, -1.388716), metal::float4(0.93923146, -0.38923523, -0.0074161366, -0.62310964), metal::float4(-0.27356088, -3.8132336, -0.326761, -3.2853408), metal::float4(-0.17321798, -10.054951, 0.094018586, -4.1044903)) * h1_5)) + (metal::float4x4(metal::float4(-2.9375002, -1.5772644, -0.028824203, 0.39525685), metal::float4(0.2538739, 0.6404099, -0.08917889, -0.23136254), metal::float4(-1.4123424, 0.49519774, -0.28288534, -4.4888506), metal::float4(-0.19552387, 0.031744648, -0.024117399, 3.5014074)) * h1_6)) + (metal::float4x4(metal::float4(-6.388915, 0.25000545, -0.319836, -0.93253845), metal::float4(9.816028, 2.536431, 0.09538501, -0.33083022), metal::float4(-3.8032932, 1.2661434, -0.16308375, -2.2764294), metal::float4(1.7594389, -0.51916075, -0.13081738, -2.6253278)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-1.6024822, 0.326761, -5.2702546, -9.288301) + (metal::float4x4(metal::float4(1.9530706, -1.8485831, 0.2109906, -0.25858083), metal::float4(0.93915653, 1.6989772, 0.10935656, 3.243871), metal::float4(-1.668992, 0.26239094, -0.19926538, -0.2640662), metal::float4(-4.7925825, -1.5411111, -1.9145753, 1.6478897)) * h1_0)) + (metal::float4x4(metal::float4(-0.35818458, 1.2148889, 0.3322431, 2.009875), metal::float4(-0.88717693, 2.085225, -0.059712175, -0.7660865), metal::float4(-5.2038116, 1.1421809, -0.069393694, -1.2104797), metal::float4(1.4166483, 8.891604, -0.19883786, 2.5516102)) * h1_1)) + (metal::float4x4(metal::float4(-0.8331628, -0.74940425, -0.5258979, -0.38192207), metal::float4(-0.61086315, -1.6954087, 0.03969145, 2.0987928), metal::float4(0.17930607, -0.91649634, -0.14285758, -1.7155297), metal::float4(0.8023482, 0.7970375, 0.6197916, -5.2210584)) * h1_2)) + (metal::float4x4(metal::float4(-2.5854452, 5.9796576, 0.61167616, 0.4250337), metal::float4(1.3043399, 2.8135962, -0.05531424, -0.15286618), metal::float4(1.3677459, 2.6523335, 0.37061626, 0.8490703), metal::float4(-0.28107482, -19.692179, -0.19836535, -1.71023)) * h1_3)) + (metal::float4x4(metal::float4(1.2583504, -0.7968344, 0.369631, 0.28707027), metal::float4(0.32727537, 0.16690618, -0.3634363, 0.88905156), metal::float4(0.014350122, -0.15114553, 0.2937969, 1.5788385), metal::float4(-4.5339465, -0.17390747, -0.241532, 0.70758146)) * h1_4)) + (metal::float4x4(metal::float4(-0.5519906, 2.8230247, 0.05278055, 0.54575557), metal::float4(-1.3154308, 0.656429, 0.7821612, -9.275172), metal::float4(1.1405544, -2.1575017, 1.4119513, 0.7853599), metal::float4(3.2076383, -6.13053, 15.256626, -12.406102)) * h1_5)) + (metal::float4x4(metal::float4(1.2811682, 0.083948754, -0.37948, -0.4940118), metal::float4(-1.1444502, -2.5660405, -0.552346, 0.1214361), metal::float4(0.5068235, -0.47298962, 0.4408889, -2.732477), metal::float4(-0.5066367, -0.8545023, -0.51588374, -1.2569976)) * h1_6)) + (metal::float4x4(metal::float4(0.5785463, -32.425995, 0.42408907, 0.9343084), metal::float4(-3.902431, -0.7520251, -0.06531561, -4.5250793), metal::float4(1.669008, 1.2654543, 0.5549053, 3.3851264), metal::float4(-0.31843388, -0.1135918, 0.2259276, 3.8177497)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(2.192788, -0.38622347, 1.562341, -3.0405202) + (metal::float4x4(metal::float4(1.9812528, -0.36313337, -0.7867708, -1.8871622), metal::float4(-0.3773511, -0.16610058, 1.1051798, 1.2316991), metal::float4(1.8488358, -0.046805546, -0.6921194, -0.5387434), metal::float4(0.3181373, -0.18279947, -1.689014, 3.066741)) * h1_0)) + (metal::float4x4(metal::float4(-0.34661636, -0.4327142, 1.5718977, -0.5606247), metal::float4(-0.03964064, -0.23198833, 0.47888073, -0.5954511), metal::float4(-0.36834794, -0.23371373, 0.15666945, 0.93414724), metal::float4(-0.281857, 0.20966858, 8.412329, 9.048968)) * h1_1)) + (metal::float4x4(metal::float4(-0.34866777, -0.29574445, 2.2201583, 1.0108215), metal::float4(2.1363382, -0.027613534, -1.1590986, -0.66171604), metal::float4(0.34671408, 0.07055651, -0.63689375, -0.49965852), metal::float4(-1.2961404, -0.75858885, 0.23002268, 0.47372976)) * h1_2)) + (metal::float4x4(metal::float4(-0.008777903, -0.58365583, -7.097225, -0.7343006), metal::float4(-2.659016, 0.31216386, 0.68762773, 0.2661025), metal::float4(-1.6388949, -0.17292544, -0.52062505, -0.22462904), metal::float4(0.8361993, -0.09593139, -4.261884, -0.79932857)) * h1_3)) + (metal::float4x4(metal::float4(-0.23727515, -0.091116585, 0.93601537, -2.982952), metal::float4(0.032420382, -0.21857665, -0.6826385, 0.1599772), metal::float4(0.47912702, -0.3265304, -0.20499313, -1.6727635), metal::float4(1.9387163, -0.111314304, -0.61201704, 2.9126418)) * h1_4)) + (metal::float4x4(metal::float4(-0.80854404, 0.07845742, -2.8177385, 0.109425806), metal::float4(0.19731739, -0.1832566, 0.387768, 0.2938763), metal::float4(-1.713297, 0.05192612, -10.083423, -0.7480528), metal::float4(-8.829212, -0.33925098, -16.97128, -2.5043054)) * h1_5)) + (metal::float4x4(metal::float4(-0.6140045, -0.27008948, -0.00565183, 0.40399697), metal::float4(1.3195682, -0.2859485, -0.6891265, -0.010279318), metal::float4(-0.27614084, -0.34485704, 1.0004749, -2.5375779), metal::float4(0.1936343, -0.15814485, -0.32213724, -0.7124809)) * h1_6)) + (metal::float4x4(metal::float4(-1.5785738, -0.5448545, -7.9740224, -0.3882083), metal::float4(-1.0468239, -0.4249315, -0.3257484, -0.8561734), metal::float4(-0.07593948, -0.07261215, 0.73661035, 0.53244424), metal::float4(0.6394129, -0.39995986, -1.0125879, -0.50449544)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.23133157, 0.07465856, 0.11972243, -0.19268681), h2_0)) + metal::dot(metal::float4(0.34225202, 0.15328355, -0.12462099, -0.17171375), h2_1)) + metal::dot(metal::float4(0.09308249, 0.25963008, -0.57784873, 0.18180469), h2_2)) + metal::dot(metal::float4(0.15193784, 0.23329662, 0.12255926, -0.111732274), h2_3);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float2x4 f_1
) {
    float absorbance_6 = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_6 * _e10, 80.0)));
}

float nmt_fragment_transmittance(
    float v_3,
    float z_3,
    float absorbance_3,
    float nearest_2,
    float farthest_2,
    float z_nearest_1,
    float z_farthest_1,
    float n_1,
    float b0_1,
    metal::float4 b_3
) {
    float front_1 = 0.0;
    float others_1 = metal::clamp(b0_1 - absorbance_3, 0.0, 1000000000000000000000000000000.0);
    if (v_3 != nearest_2) {
        if (others_1 > (0.000001 * b0_1)) {
            front_1 = others_1;
            if (v_3 != farthest_2) {
                float c_2 = 0.5 * (z_nearest_1 + z_farthest_1);
                float per_b0_2 = 1.0 / metal::max(metal::max(others_1, b0_1 * 0.000001), 0.000000000000000000000000000001);
                float per_h_2 = 1.0 / metal::max(0.5 * (z_farthest_1 - z_nearest_1), 0.00000001);
                metal::float4 _e38 = nmt_recentred_moments(z_3, absorbance_3, c_2, per_h_2, per_b0_2, b_3);
                float noise_growth_1 = 1.0 + ((2.0 * metal::abs(c_2)) * per_h_2);
                float moment_noise_1 = ((NMT_ROUNDING * noise_growth_1) * b0_1) * per_b0_2;
                float noise1_1 = moment_noise_1 * (0.12 * metal::sqrt(n_1));
                float per_n_1 = 1.0 / n_1;
                float _e61 = nmt_shrink_to_prior(_e38.x, 0.0, noise1_1, 0.22 + (0.7 * per_n_1));
                front_1 = others_1 * metal::clamp(0.5 - (0.5 * _e61), 0.0, 1.0);
                if (n_1 != 3.0) {
                    float _e77 = nmt_place_in_thin(v_3, nearest_2, farthest_2);
                    float x_3 = (0.01 > ((farthest_2 - nearest_2) / nearest_2)) ? _e77 : metal::clamp((z_3 - c_2) * per_h_2, -1.0, 1.0);
                    float further_1 = noise_growth_1 * 0.87;
                    float noise2_1 = noise1_1 * further_1;
                    float noise3_1 = noise2_1 * further_1;
                    float most0_1 = metal::max(1.0 - (_e61 * _e61), 0.000001);
                    float raw_spread0_1 = metal::clamp((_e38.y - (_e61 * _e61)) / most0_1, 0.0, 1.0);
                    float _e108 = nmt_shrink_to_prior(raw_spread0_1, 0.3 + (1.8 * per_n_1), noise2_1 / most0_1, 0.12 + (0.5 * per_n_1));
                    float per_mass1_1 = 1.0 / metal::max(1.0 - _e38.y, 0.000001);
                    float raw_mean1_1 = metal::clamp((_e38.x - _e38.z) * per_mass1_1, -1.0, 1.0);
                    float expected_mean1_1 = (_e61 * (1.0 - _e108)) / (1.0 + _e108);
                    float deviation_2 = (0.17 + (3.1 * per_n_1)) * (_e108 + 0.02);
                    float noise_2 = noise3_1 * per_mass1_1;
                    float all_noise_1 = noise_2 + (0.0000009536743 * per_mass1_1);
                    float _e140 = nmt_shrink_to_prior(raw_mean1_1, expected_mean1_1, noise_2, deviation_2);
                    float transition_width_2 = (all_noise_1 * deviation_2) / (all_noise_1 + deviation_2);
                    float _e144 = nmt_share_of_four(x_3, _e61, _e108, _e140, transition_width_2);
                    front_1 = others_1 * _e144;
                    if (n_1 != 4.0) {
                        float most1_1 = metal::max(1.0 - (_e140 * _e140), 0.000001);
                        float raw_square1_1 = metal::clamp((((_e38.y - _e38.w) * per_mass1_1) - (_e140 * _e140)) / most1_1, 0.0, 1.0);
                        float offset_1 = (_e140 * (1.0 + _e108)) - (_e61 * (1.0 - _e108));
                        float square0_1 = _e108 * _e108;
                        float expected_square1_1 = metal::clamp(((((0.94 - (3.8 * per_n_1)) + ((4.0 * square0_1) * square0_1)) - ((1.2 * offset_1) * offset_1)) * _e108) / ((1.0 + _e108) + _e108), 0.0, 1.0);
                        float _e201 = nmt_shrink_to_prior(raw_square1_1, expected_square1_1, ((noise3_1 * further_1) * per_mass1_1) / most1_1, (0.12 + (1.4 * per_n_1)) * (_e108 + 0.02));
                        float spread1_1 = metal::sqrt(_e201);
                        float _e215 = nmt_share(metal::float2x4(metal::float4(x_3, (metal::log(n_1) * 0.48089835) - 1.0, metal::log(others_1 + 0.05), _e61), metal::float4(_e108, _e140, spread1_1, 0.0)));
                        front_1 = others_1 * _e215;
                    }
                }
            }
        }
    }
    float _e217 = front_1;
    return metal::min(metal::exp(-(_e217)), 1.0);
}

float nmt_first_hidden_depth(
    float b0_2,
    float b1,
    float b2
) {
    float excess = b0_2 - 5.0;
    float deviation_3 = metal::sqrt((metal::max((b2 * b0_2) - (b1 * b1), 0.0) * 5.0) / metal::max(excess, 0.000001));
    return (excess > 0.0) ? ((b1 + deviation_3) / metal::max(b0_2, 0.000000000000000000000000000001)) : 300000000000000000000000000000000000000.0;
}

float nmt_hidden_weight(
    float z_4,
    float absorbance_4,
    float z_nearest_2,
    float z_farthest_2,
    float n_2,
    float b0_3,
    metal::float4 b_4
) {
    float c_3 = 0.5 * (z_nearest_2 + z_farthest_2);
    float others_2 = metal::clamp(b0_3 - absorbance_4, 0.0, 1000000000000000000000000000000.0);
    float per_b0_3 = 1.0 / metal::max(metal::max(others_2, b0_3 * 0.000001), 0.000000000000000000000000000001);
    float per_h_3 = 1.0 / metal::max(0.5 * (z_farthest_2 - z_nearest_2), 0.00000001);
    metal::float4 _e28 = nmt_recentred_moments(z_4, absorbance_4, c_3, per_h_3, per_b0_3, b_4);
    float noise_growth_2 = 1.0 + ((2.0 * metal::abs(c_3)) * per_h_3);
    float unsure = (((n_2 + 16.0) * NMT_ROUNDING) * b0_3) / metal::max(others_2, 0.000000000000000000000000000001);
    float off = 0.000002 * per_h_3;
    float end = 1.0 + off;
    float x_4 = metal::clamp((z_4 - c_3) * per_h_3, -1.0, 1.0) - off;
    float ahead = x_4 - _e28.x;
    float r1 = metal::max(_e28.x - (metal::max(_e28.y - (_e28.x * _e28.x), 0.0) / metal::max(ahead, 0.000000000000000000000000000001)), -1000000.0);
    float growth1 = noise_growth_2 + metal::abs(r1);
    float gap1 = x_4 - r1;
    float share1 = (((_e28.y - ((2.0 * r1) * _e28.x)) + (r1 * r1)) + (unsure * (growth1 * growth1))) / metal::max(gap1 * gap1, 0.000000000000000000000000000001);
    float w1 = _e28.x - _e28.z;
    float below = w1 - (x_4 * (1.0 - _e28.y));
    float inner_1 = ((_e28.y - _e28.w) - (x_4 * w1)) / ((0.000000000000000000000000000001 > metal::abs(below)) ? 0.000000000000000000000000000001 : below);
    float outer = metal::max(r1, -1.0);
    float inside = (inner_1 >= -(end)) ? inner_1 : outer;
    float r = (x_4 > inside) ? inside : outer;
    float gap = x_4 - r;
    float per_value = 1.0 / metal::max((end + x_4) * (gap * gap), 0.000000000000000000000000000001);
    float end_gap = end - r;
    float gamma = (0.99999 * (1.0 - (1.0 / (((2.0 * end) * (end_gap * end_gap)) * per_value)))) / (end - x_4);
    float p0 = (end * r) * r;
    float p1 = (r * r) - ((2.0 * r) * end);
    float p2 = end - (2.0 * r);
    float lift = 1.0 + (gamma * x_4);
    float value_1 = ((((p0 * lift) + (((p1 * lift) - (gamma * p0)) * _e28.x)) + (((p2 * lift) - (gamma * p1)) * _e28.y)) + ((lift - (gamma * p2)) * _e28.z)) - (gamma * _e28.w);
    float growth2 = noise_growth_2 + metal::abs(r);
    float lost = ((unsure * (end + noise_growth_2)) * (growth2 * growth2)) * (1.0 + (gamma * (metal::abs(x_4) + noise_growth_2)));
    float share2 = (value_1 + lost) * per_value;
    float share = metal::min(share1, share2) * 1.00001;
    float behind_1 = (ahead > 0.0) ? ((1.0 > share) ? metal::max(share, 0.0) : 1.0) : 1.0;
    float least_depth = (others_2 * (1.0 - behind_1)) - ((((n_2 + 4.0) * NMT_ROUNDING) * b0_3) + 0.00001);
    return metal::exp(-(least_depth)) * metal::min((others_2 * behind_1) + absorbance_4, n_2 - 2.0);
}

float nmt_visible_transmittance(
    float v_4,
    float z_5,
    float absorbance_5,
    float nearest_3,
    float farthest_3,
    float z_nearest_3,
    float z_farthest_3,
    float n_3,
    float b0_4,
    metal::float4 b_5
) {
    float front_2 = -1.0;
    float answer = {};
    float others_3 = metal::clamp(b0_4 - absorbance_5, 0.0, 1000000000000000000000000000000.0);
    if (n_3 > 4.0) {
        if (v_4 != nearest_3) {
            if (v_4 != farthest_3) {
                if (others_3 > (0.000001 * b0_4)) {
                    if (b0_4 <= NMT_FAINT) {
                        front_2 = 0.5 * others_3;
                    }
                    if (true) {
                        float _e30 = nmt_first_hidden_depth(b0_4, b_5.x, b_5.y);
                        if (z_5 >= _e30) {
                            float _e32 = nmt_hidden_weight(z_5, absorbance_5, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
                            if (_e32 <= NMT_HIDDEN) {
                                front_2 = others_3;
                            }
                        }
                    }
                }
            }
        }
    }
    float _e35 = front_2;
    answer = metal::min(metal::exp(-(_e35)), 1.0);
    float _e41 = front_2;
    if (_e41 < 0.0) {
        float _e44 = nmt_fragment_transmittance(v_4, z_5, absorbance_5, nearest_3, farthest_3, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
        answer = _e44;
    }
    float _e45 = answer;
    return _e45;
}

NmtSums nmt_pass1(
    float v_5,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_5, v0_1, v1_1);
    metal::float4 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6.xyz), metal::float4(_e6.w, 1.0, 0.0, 0.0), metal::float4(-(v_5), v_5, 0.0, 0.0)};
}

float nmt_pass2(
    float v_6,
    float v0_2,
    float v1_2,
    float alpha_2,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_4 = -(range.x);
    float _e9 = nmt_moment_depth(v_6, v0_2, v1_2);
    float _e10 = nmt_absorbance(alpha_2);
    float _e12 = nmt_moment_depth(nearest_4, v0_2, v1_2);
    float _e14 = nmt_moment_depth(range.y, v0_2, v1_2);
    float _e20 = nmt_fragment_transmittance(v_6, _e9, _e10, nearest_4, range.y, _e12, _e14, sums1.y, sums0.x, metal::float4(sums0.yzw, sums1.x));
    return _e20;
}

float nmt_visible_pass2(
    float v_7,
    float v0_3,
    float v1_3,
    float alpha_3,
    metal::float4 sums0_1,
    metal::float4 sums1_1,
    metal::float4 range_1
) {
    float nearest_5 = -(range_1.x);
    float _e9 = nmt_moment_depth(v_7, v0_3, v1_3);
    float _e10 = nmt_absorbance(alpha_3);
    float _e12 = nmt_moment_depth(nearest_5, v0_3, v1_3);
    float _e14 = nmt_moment_depth(range_1.y, v0_3, v1_3);
    float _e20 = nmt_visible_transmittance(v_7, _e9, _e10, nearest_5, range_1.y, _e12, _e14, sums1_1.y, sums0_1.x, metal::float4(sums0_1.yzw, sums1_1.x));
    return _e20;
}

metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0_2
) {
    float behind_2 = metal::exp(-(sums0_2.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind_2) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind_2);
}

#endif
