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
// Provenance: nmt 0.1.0, commit a3706793e652-modified, backend fused, seed 1, epochs 1800, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.438e-3, worst 0.994.

#ifndef NMT_INCLUDED_RECOMMENDED
#define NMT_INCLUDED_RECOMMENDED

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct type_1 {
    float inner[4];
};
struct type_2 {
    float inner[8];
};
struct type_4 {
    metal::float4x4 inner[16];
};
struct type_6 {
    metal::float4x4 inner[32];
};
struct type_7 {
    metal::float4 inner[4];
};
struct type_8 {
    float inner[7];
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant type_4 NMT_W1 = type_4 {{metal::float4x4(metal::float4(-4.1674604, 1.9599856, -0.73242956, -0.20504631), metal::float4(-0.12590207, 0.52091557, 0.07906628, 0.021661459), metal::float4(0.08731185, -0.010980034, -0.04702237, -0.014140079), metal::float4(-2.3502588, 0.98347735, 5.2544265, 7.5886335)), metal::float4x4(metal::float4(-2.0677073, -3.0403187, -7.251252, -0.21163398), metal::float4(4.0386076, -0.3408012, -6.547609, -0.27915618), metal::float4(2.371881, -3.6694639, 2.8083203, 0.16396397), metal::float4(-4.5592628, 3.2408876, 0.7731898, -6.0322914)), metal::float4x4(metal::float4(-0.46817917, 2.2209268, 0.42732853, -2.1391058), metal::float4(0.6626024, 0.12554957, 0.15880474, 0.08205461), metal::float4(-0.002107043, 0.067374885, -0.04141126, 0.018053476), metal::float4(-0.02131919, -5.3346705, 6.854231, 0.49863964)), metal::float4x4(metal::float4(-2.3983507, -2.2166302, -9.364158, -4.6879478), metal::float4(-7.131321, 0.9307025, -5.2908893, -0.09217429), metal::float4(0.18057501, -0.056932688, -5.222522, 5.909689), metal::float4(-3.2400908, 1.7953771, 2.3643174, -2.5787416)), metal::float4x4(metal::float4(-2.0212417, 3.5234349, -0.29862827, 2.837473), metal::float4(-0.0034417917, -0.2701374, -0.06850981, 0.26511696), metal::float4(0.06310855, -0.074502654, 0.0036534448, -0.02181142), metal::float4(1.1280895, -0.06773128, 7.143841, -0.33201975)), metal::float4x4(metal::float4(-5.189434, -2.4549117, -0.16383393, 2.9110465), metal::float4(-3.691939, -2.2927215, -1.7290045, 0.5228869), metal::float4(3.423124, 4.379191, -0.54773974, -2.3272412), metal::float4(0.18388788, 1.0360488, -2.4800966, 1.8856108)), metal::float4x4(metal::float4(-3.5864356, 3.698348, -2.763185, -2.920156), metal::float4(0.78295255, 0.015520756, -0.32045588, -0.06508547), metal::float4(0.009859245, -0.076360114, 0.06714014, 0.014959682), metal::float4(-0.39343145, -0.1780676, 4.0171967, -0.3578333)), metal::float4x4(metal::float4(1.4050651, 0.118033335, -6.476847, -0.18825664), metal::float4(0.19789477, -0.5731352, -5.180575, 3.0493782), metal::float4(-0.75208825, 6.0289307, 3.036596, 0.6782269), metal::float4(-4.040601, -2.1219463, -0.72817266, 0.23356485)), metal::float4x4(metal::float4(0.33965114, 0.53012913, 3.6864781, 0.75859493), metal::float4(0.00060585595, -2.9309227, -0.36718613, -0.3317407), metal::float4(0.033321146, 1.2089126, 0.2153916, -0.0014231349), metal::float4(7.1874413, 0.3191635, -8.419987, -2.4559073)), metal::float4x4(metal::float4(-11.693587, -2.831591, -2.3943553, -8.275588), metal::float4(-7.1602225, -0.7036662, 2.2086513, 3.6333103), metal::float4(4.0300922, 1.7700683, 1.188168, 7.4534593), metal::float4(0.7538325, -0.7767871, 0.016310979, 0.18021783)), metal::float4x4(metal::float4(-1.3306596, 1.8677293, -4.101393, -4.6770787), metal::float4(0.19519782, -0.48456788, -0.20488237, 0.021339769), metal::float4(-0.010044715, -0.031366363, 0.050242912, 0.015430227), metal::float4(-4.2732124, 1.70702, 0.0028088223, -0.010693944)), metal::float4x4(metal::float4(-3.774896, -1.1750406, -0.93092984, -0.049676165), metal::float4(4.5747614, -0.64899164, -0.34892794, -0.11725599), metal::float4(-2.6529639, -2.241756, 1.2695652, 0.121937424), metal::float4(1.5011057, 2.9329836, -3.6110363, -4.5134344)), metal::float4x4(metal::float4(-4.6046376, 3.0093236, 4.978195, 1.5529538), metal::float4(-5.0088716, 0.49800482, 0.108492136, 0.17909843), metal::float4(0.19106047, 0.006962222, -0.0562687, -0.05636758), metal::float4(2.4868011, -2.9974, 1.1363013, 0.8436937)), metal::float4x4(metal::float4(-3.112934, 2.7212074, -0.7725423, 2.895838), metal::float4(-1.4298413, 2.0517163, -5.190096, -2.2426555), metal::float4(1.0851005, 1.2990258, 1.9417673, -7.12554), metal::float4(-1.7792232, 0.8998802, 0.6199238, 1.7865978)), metal::float4x4(metal::float4(-4.373691, 7.469767, 0.73178667, 0.19036344), metal::float4(0.18150902, -0.09014448, -0.10938936, 0.30877957), metal::float4(-0.00059860875, -0.04931852, -0.033257622, 0.008763494), metal::float4(0.013503743, -1.9672016, -3.3122485, 2.5027857)), metal::float4x4(metal::float4(-0.16557512, -2.3265748, 3.9967105, 5.9642453), metal::float4(4.2863545, -0.5382311, 1.9298717, -1.1969867), metal::float4(-1.3004589, -0.5782102, -3.2860882, 0.18440095), metal::float4(0.19718102, -2.082068, 1.6094493, -3.5837553))}};
constant type_6 NMT_W2 = type_6 {{metal::float4x4(metal::float4(2.0213919, -2.91184, 1.5348691, -0.2929838), metal::float4(1.3055472, 0.27231, -0.8899139, -0.4409711), metal::float4(0.11069353, -1.8431019, 0.17304926, 0.8809019), metal::float4(-5.399847, -17.517437, 0.47533467, 6.2987537)), metal::float4x4(metal::float4(0.419285, -0.42110118, 2.5071044, -1.4210333), metal::float4(-0.7503765, 0.8864603, 0.037235156, 0.37260938), metal::float4(0.6845067, 0.44033587, -0.28448498, 0.24686478), metal::float4(2.7418797, 1.6742915, 0.8079822, -0.8698964)), metal::float4x4(metal::float4(0.9036239, -0.82326996, -0.8262928, -0.335104), metal::float4(-0.41287225, -0.55577654, -1.3758198, -0.18870488), metal::float4(-0.63340414, 0.42160872, 0.7002752, 2.267698), metal::float4(-1.08188, -3.98043, -1.4021765, 0.6892029)), metal::float4x4(metal::float4(3.4161088, 0.7640683, 1.9327487, 1.83947), metal::float4(-5.0462413, -0.713245, -0.014138731, -0.31107137), metal::float4(1.3723212, 2.744764, -0.30109656, -0.48658893), metal::float4(0.26442823, -1.2755157, 0.42979032, 0.022228852)), metal::float4x4(metal::float4(0.9166541, 2.8674293, -2.7461586, -0.11615238), metal::float4(0.077809386, -2.372911, -0.1854338, 0.5619069), metal::float4(-1.2895492, -0.69098186, -1.6812513, 0.17504105), metal::float4(-1.556445, 1.623512, 1.1337266, 2.044273)), metal::float4x4(metal::float4(-0.8967381, 2.4832838, 0.3154895, 0.5799579), metal::float4(0.76742953, -1.2556587, 1.0351061, 0.9519333), metal::float4(0.7550382, -0.7536835, -8.745191, -0.5979435), metal::float4(-0.6330228, -5.822986, -24.325792, 3.6463118)), metal::float4x4(metal::float4(-0.16797684, 1.0777332, -0.6376268, -0.33728403), metal::float4(-1.061007, 2.0483856, 1.2846082, -0.06528943), metal::float4(-2.8672419, -0.13821496, -0.40658525, -0.7010545), metal::float4(0.73339987, 0.85867685, -2.980733, -0.6767882)), metal::float4x4(metal::float4(-0.17565668, -0.66932446, -0.087680444, 0.82007885), metal::float4(-0.81018645, -5.083275, 6.716149, -2.5253572), metal::float4(-0.21873666, 1.6195232, 0.10287789, -0.7853111), metal::float4(-0.8664899, 1.8022391, 0.12425704, -0.12265211)), metal::float4x4(metal::float4(-0.019619394, -2.9439027, 0.20967697, -3.419845), metal::float4(-3.0203755, -0.17222819, -0.21907517, -0.1506443), metal::float4(0.2171478, -0.16118884, -0.34547976, 3.1116161), metal::float4(0.59133464, 0.16578314, -0.26919577, -17.852287)), metal::float4x4(metal::float4(-1.9658519, -0.026431112, -0.32840747, 2.9921103), metal::float4(-3.432273, 0.28572825, -0.3039937, -1.5232166), metal::float4(-1.0966971, -0.76801056, 0.27018806, 3.2838664), metal::float4(-0.8133999, -0.12406365, -0.23587477, 0.42709732)), metal::float4x4(metal::float4(-6.489317, 0.13252488, -0.26811773, 2.2592547), metal::float4(-3.6722937, 0.4313345, 0.27116078, -0.16659443), metal::float4(0.10130279, 0.19058819, 0.043735087, -3.4506261), metal::float4(2.148812, -1.1394475, -0.23171818, -2.8741112)), metal::float4x4(metal::float4(0.6639304, 3.6351647, 0.15170369, -0.9139982), metal::float4(1.5778636, -0.57759607, -0.076416016, -17.85372), metal::float4(-2.942476, -1.2473558, -0.3413897, 1.8454653), metal::float4(-6.107756, -0.2496649, -0.2933674, -0.3217662)), metal::float4x4(metal::float4(0.27639863, -0.020356344, 0.20805937, 5.0024533), metal::float4(0.27502623, 0.33333814, -0.17369579, 0.3428085), metal::float4(0.2811654, -0.09691671, 0.3376751, -4.3889575), metal::float4(0.5050634, 0.056959357, 0.15600675, 0.9328736)), metal::float4x4(metal::float4(0.6798183, 0.561105, -0.29834086, -1.388716), metal::float4(0.93923146, -0.38923523, -0.0074161366, -0.62310964), metal::float4(-0.27356088, -3.8132336, -0.326761, -3.2853408), metal::float4(-0.17321798, -10.054951, 0.094018586, -4.1044903)), metal::float4x4(metal::float4(-2.9375002, -1.5772644, -0.028824203, 0.39525685), metal::float4(0.2538739, 0.6404099, -0.08917889, -0.23136254), metal::float4(-1.4123424, 0.49519774, -0.28288534, -4.4888506), metal::float4(-0.19552387, 0.031744648, -0.024117399, 3.5014074)), metal::float4x4(metal::float4(-6.388915, 0.25000545, -0.319836, -0.93253845), metal::float4(9.816028, 2.536431, 0.09538501, -0.33083022), metal::float4(-3.8032932, 1.2661434, -0.16308375, -2.2764294), metal::float4(1.7594389, -0.51916075, -0.13081738, -2.6253278)), metal::float4x4(metal::float4(1.9530706, -1.8485831, 0.2109906, -0.25858083), metal::float4(0.93915653, 1.6989772, 0.10935656, 3.243871), metal::float4(-1.668992, 0.26239094, -0.19926538, -0.2640662), metal::float4(-4.7925825, -1.5411111, -1.9145753, 1.6478897)), metal::float4x4(metal::float4(-0.35818458, 1.2148889, 0.3322431, 2.009875), metal::float4(-0.88717693, 2.085225, -0.059712175, -0.7660865), metal::float4(-5.2038116, 1.1421809, -0.069393694, -1.2104797), metal::float4(1.4166483, 8.891604, -0.19883786, 2.5516102)), metal::float4x4(metal::float4(-0.8331628, -0.74940425, -0.5258979, -0.38192207), metal::float4(-0.61086315, -1.6954087, 0.03969145, 2.0987928), metal::float4(0.17930607, -0.91649634, -0.14285758, -1.7155297), metal::float4(0.8023482, 0.7970375, 0.6197916, -5.2210584)), metal::float4x4(metal::float4(-2.5854452, 5.9796576, 0.61167616, 0.4250337), metal::float4(1.3043399, 2.8135962, -0.05531424, -0.15286618), metal::float4(1.3677459, 2.6523335, 0.37061626, 0.8490703), metal::float4(-0.28107482, -19.692179, -0.19836535, -1.71023)), metal::float4x4(metal::float4(1.2583504, -0.7968344, 0.369631, 0.28707027), metal::float4(0.32727537, 0.16690618, -0.3634363, 0.88905156), metal::float4(0.014350122, -0.15114553, 0.2937969, 1.5788385), metal::float4(-4.5339465, -0.17390747, -0.241532, 0.70758146)), metal::float4x4(metal::float4(-0.5519906, 2.8230247, 0.05278055, 0.54575557), metal::float4(-1.3154308, 0.656429, 0.7821612, -9.275172), metal::float4(1.1405544, -2.1575017, 1.4119513, 0.7853599), metal::float4(3.2076383, -6.13053, 15.256626, -12.406102)), metal::float4x4(metal::float4(1.2811682, 0.083948754, -0.37948, -0.4940118), metal::float4(-1.1444502, -2.5660405, -0.552346, 0.1214361), metal::float4(0.5068235, -0.47298962, 0.4408889, -2.732477), metal::float4(-0.5066367, -0.8545023, -0.51588374, -1.2569976)), metal::float4x4(metal::float4(0.5785463, -32.425995, 0.42408907, 0.9343084), metal::float4(-3.902431, -0.7520251, -0.06531561, -4.5250793), metal::float4(1.669008, 1.2654543, 0.5549053, 3.3851264), metal::float4(-0.31843388, -0.1135918, 0.2259276, 3.8177497)), metal::float4x4(metal::float4(1.9812528, -0.36313337, -0.7867708, -1.8871622), metal::float4(-0.3773511, -0.16610058, 1.1051798, 1.2316991), metal::float4(1.8488358, -0.046805546, -0.6921194, -0.5387434), metal::float4(0.3181373, -0.18279947, -1.689014, 3.066741)), metal::float4x4(metal::float4(-0.34661636, -0.4327142, 1.5718977, -0.5606247), metal::float4(-0.03964064, -0.23198833, 0.47888073, -0.5954511), metal::float4(-0.36834794, -0.23371373, 0.15666945, 0.93414724), metal::float4(-0.281857, 0.20966858, 8.412329, 9.048968)), metal::float4x4(metal::float4(-0.34866777, -0.29574445, 2.2201583, 1.0108215), metal::float4(2.1363382, -0.027613534, -1.1590986, -0.66171604), metal::float4(0.34671408, 0.07055651, -0.63689375, -0.49965852), metal::float4(-1.2961404, -0.75858885, 0.23002268, 0.47372976)), metal::float4x4(metal::float4(-0.008777903, -0.58365583, -7.097225, -0.7343006), metal::float4(-2.659016, 0.31216386, 0.68762773, 0.2661025), metal::float4(-1.6388949, -0.17292544, -0.52062505, -0.22462904), metal::float4(0.8361993, -0.09593139, -4.261884, -0.79932857)), metal::float4x4(metal::float4(-0.23727515, -0.091116585, 0.93601537, -2.982952), metal::float4(0.032420382, -0.21857665, -0.6826385, 0.1599772), metal::float4(0.47912702, -0.3265304, -0.20499313, -1.6727635), metal::float4(1.9387163, -0.111314304, -0.61201704, 2.9126418)), metal::float4x4(metal::float4(-0.80854404, 0.07845742, -2.8177385, 0.109425806), metal::float4(0.19731739, -0.1832566, 0.387768, 0.2938763), metal::float4(-1.713297, 0.05192612, -10.083423, -0.7480528), metal::float4(-8.829212, -0.33925098, -16.97128, -2.5043054)), metal::float4x4(metal::float4(-0.6140045, -0.27008948, -0.00565183, 0.40399697), metal::float4(1.3195682, -0.2859485, -0.6891265, -0.010279318), metal::float4(-0.27614084, -0.34485704, 1.0004749, -2.5375779), metal::float4(0.1936343, -0.15814485, -0.32213724, -0.7124809)), metal::float4x4(metal::float4(-1.5785738, -0.5448545, -7.9740224, -0.3882083), metal::float4(-1.0468239, -0.4249315, -0.3257484, -0.8561734), metal::float4(-0.07593948, -0.07261215, 0.73661035, 0.53244424), metal::float4(0.6394129, -0.39995986, -1.0125879, -0.50449544))}};
constant type_7 NMT_B2 = type_7 {{metal::float4(1.5403837, -1.8343279, -0.9217493, 1.313698), metal::float4(-7.616127, 0.743722, -0.04113058, -1.5676365), metal::float4(-1.6024822, 0.326761, -5.2702546, -9.288301), metal::float4(2.192788, -0.38622347, 1.562341, -3.0405202)}};
constant type_7 NMT_W3 = type_7 {{metal::float4(-0.23133157, 0.07465856, 0.11972243, -0.19268681), metal::float4(0.34225202, 0.15328355, -0.12462099, -0.17171375), metal::float4(0.09308249, 0.25963008, -0.57784873, 0.18180469), metal::float4(0.15193784, 0.23329662, 0.12255926, -0.111732274)}};
constant float NMT_B3 = -1.1533976;
constant float NMT_FAINT = 0.0625;
constant float NMT_HIDDEN = 0.00095;

float nmt_absorbance(
    float alpha
) {
    float faint = alpha * (1.0 + (alpha * (0.5 + (alpha * (0.33333334 + (alpha * (0.25 + (alpha * 0.2))))))));
    return (alpha < 0.03) ? faint : -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

float nmt_log_ratio(
    float a,
    float b
) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (metal::abs(s) < 0.2) ? ((s + s) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + (q * 0.11111111))))))))) : metal::log(a / b);
}

float nmt_moment_depth(
    float v,
    float v0,
    float v1
) {
    float _e3 = nmt_log_ratio(v, v0);
    float _e6 = nmt_log_ratio(v1, v0);
    float warped = ((2.0 * _e3) / metal::max(_e6, 0.000000000000000000000000000001)) - 1.0;
    return (v1 > v0) ? metal::clamp(warped, -1.0, 1.0) : 0.0;
}

type_1 nmt_moments(
    float z,
    float absorbance
) {
    float own1 = absorbance * z;
    float own2 = own1 * z;
    float own3 = own2 * z;
    float own4 = own3 * z;
    return type_1 {{own1, own2, own3, own4}};
}

type_2 nmt_recentred(
    float v_1,
    float z_1,
    float absorbance_1,
    float nearest,
    float farthest,
    float z_nearest,
    float z_farthest,
    float n,
    float b0,
    type_1 b_1
) {
    float m1 = {};
    float m2 = {};
    float m3 = {};
    float m4 = {};
    float front = -1.0;
    float others = metal::clamp(b0 - absorbance_1, 0.0, 1000000000000000000000000000000.0);
    float c = 0.5 * (z_nearest + z_farthest);
    float h1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
    float own1_1 = absorbance_1 * z_1;
    float own2_1 = own1_1 * z_1;
    float own3_1 = own2_1 * z_1;
    float own4_1 = own3_1 * z_1;
    float per_b0 = 1.0 / metal::max(others, 0.000000000000000000000000000001);
    m1 = (b_1.inner[0] - own1_1) * per_b0;
    m2 = (b_1.inner[1] - own2_1) * per_b0;
    m3 = (b_1.inner[2] - own3_1) * per_b0;
    m4 = (b_1.inner[3] - own4_1) * per_b0;
    float _e48 = m4;
    float _e49 = m3;
    m4 = _e48 - (c * _e49);
    float _e52 = m3;
    float _e53 = m2;
    m3 = _e52 - (c * _e53);
    float _e56 = m2;
    float _e57 = m1;
    m2 = _e56 - (c * _e57);
    float _e60 = m1;
    m1 = _e60 - c;
    float _e62 = m4;
    float _e63 = m3;
    m4 = _e62 - (c * _e63);
    float _e66 = m3;
    float _e67 = m2;
    m3 = _e66 - (c * _e67);
    float _e70 = m2;
    float _e71 = m1;
    m2 = _e70 - (c * _e71);
    float _e74 = m4;
    float _e75 = m3;
    m4 = _e74 - (c * _e75);
    float _e78 = m3;
    float _e79 = m2;
    m3 = _e78 - (c * _e79);
    float _e82 = m4;
    float _e83 = m3;
    m4 = _e82 - (c * _e83);
    float h2 = h1 * h1;
    float h3 = h2 * h1;
    float h4 = h2 * h2;
    float _e89 = m1;
    m1 = metal::clamp(_e89 * h1, -1.0, 1.0);
    float _e94 = m2;
    m2 = metal::clamp(_e94 * h2, -1.0, 1.0);
    float _e99 = m3;
    m3 = metal::clamp(_e99 * h3, -1.0, 1.0);
    float _e104 = m4;
    m4 = metal::clamp(_e104 * h4, -1.0, 1.0);
    float along = (z_1 - c) * h1;
    float range_2 = farthest - nearest;
    float ratio = range_2 / nearest;
    float t = (v_1 - nearest) / metal::max(range_2, 0.000000000000000000000000000001);
    float x = metal::clamp((ratio < 0.01) ? (((2.0 * t) * (1.0 + ((0.5 * ratio) * (1.0 - t)))) - 1.0) : along, -1.0, 1.0);
    float reach = 1.0 + ((2.0 * metal::abs(c)) * h1);
    float e1 = ((NMT_ROUNDING * reach) * b0) * per_b0;
    float per_n = 1.0 / n;
    float noise1 = e1 * (0.12 * metal::sqrt(n));
    float deviation1 = 0.22 + (0.7 * per_n);
    float trust1 = deviation1 * deviation1;
    float _e156 = m1;
    float mean0 = _e156 * (trust1 / (trust1 + (noise1 * noise1)));
    float front3 = others * metal::clamp(0.5 - (0.5 * mean0), 0.0, 1.0);
    float further = reach * 0.87;
    float noise2 = metal::min(noise1 * further, 1000000000000000.0);
    float noise3 = (noise1 * further) * further;
    float most0 = metal::max(1.0 - (mean0 * mean0), 0.000001);
    float deviation2 = 0.12 + (0.5 * per_n);
    float trust2 = (deviation2 * deviation2) * most0;
    float doubt2 = noise2 * noise2;
    float _e188 = m2;
    float spread0 = ((metal::clamp(_e188 - (mean0 * mean0), 0.0, most0) * trust2) + ((0.3 + (1.8 * per_n)) * doubt2)) / ((most0 * trust2) + doubt2);
    float _e203 = m2;
    float per_mass1 = 1.0 / metal::max(1.0 - _e203, 0.000001);
    float mean_part = 1.0 + spread0;
    float deviation3 = (0.17 + (3.1 * per_n)) * (spread0 + 0.02);
    float trust3 = deviation3 * deviation3;
    float bounded3 = metal::min(noise3 * per_mass1, 1000000000000000.0);
    float doubt3 = bounded3 * bounded3;
    float expected3 = mean0 * (1.0 - spread0);
    float _e227 = m1;
    float _e228 = m3;
    float raw_mean1 = metal::clamp((_e227 - _e228) * per_mass1, -1.0, 1.0);
    float mean1 = (((raw_mean1 * mean_part) * trust3) + (expected3 * doubt3)) / (mean_part * (trust3 + doubt3));
    float noise = bounded3 + (0.0000009536743 * per_mass1);
    float off = (noise * deviation3) / (noise + deviation3);
    float inner = (1.0 - spread0) * (1.0 - (mean0 * mean0));
    float near_share = metal::clamp(0.5 * ((1.0 - mean0) - (inner / metal::max(1.0 + mean1, 0.000001))), 0.0, 1.0);
    float far_share = metal::clamp(0.5 * ((1.0 + mean0) - (inner / metal::max(1.0 - mean1, 0.000001))), 0.0, 1.0);
    float behind = metal::clamp(0.5 + ((0.5 * (x - mean1)) / off), 0.0, 1.0);
    float front4 = others * metal::clamp(near_share + (behind * ((1.0 - far_share) - near_share)), 0.0, 1.0);
    float _e299 = front;
    front = (n == 4.0) ? front4 : _e299;
    float _e303 = front;
    front = (n == 3.0) ? front3 : _e303;
    float _e307 = front;
    front = (v_1 == farthest) ? others : _e307;
    float _e310 = front;
    front = (others > (0.000001 * b0)) ? _e310 : 0.0;
    float _e316 = front;
    front = (v_1 == nearest) ? 0.0 : _e316;
    float _e320 = front;
    float _e325 = front;
    float known = (_e325 >= 0.0) ? metal::min(metal::exp(-(_e320)), 1.0) : -1.0;
    float count = (metal::log(n) * 0.48089835) - 1.0;
    float most1 = metal::max(1.0 - (mean1 * mean1), 0.000001);
    float spread_part = mean_part + spread0;
    float offset = (mean1 * mean_part) - expected3;
    float square0 = spread0 * spread0;
    float expected4 = metal::clamp((((0.94 + (-3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * spread0, 0.0, spread_part);
    float deviation4 = (0.12 + (1.4 * per_n)) * (spread0 + 0.02);
    float trust4 = (deviation4 * deviation4) * most1;
    float bounded4 = metal::min((noise3 * further) * per_mass1, 1000000000000000.0);
    float doubt4 = bounded4 * bounded4;
    float _e373 = m2;
    float _e374 = m4;
    float raw_square1 = metal::clamp(((_e373 - _e374) * per_mass1) - (mean1 * mean1), 0.0, most1);
    float square1 = (((raw_square1 * trust4) * spread_part) + (expected4 * doubt4)) / (spread_part * ((trust4 * most1) + doubt4));
    float spread1 = metal::sqrt(square1);
    return type_2 {{x, count, metal::log(others + 0.05), mean0, spread0, mean1, spread1, known}};
}

float nmt_share(
    type_8 f
) {
    metal::float4 h0_0 = metal::float4(f.inner[0], f.inner[1], f.inner[2], f.inner[3]);
    metal::float4 h0_1 = metal::float4(f.inner[4], f.inner[5], f.inner[6], 1.0);
    metal::float4 h1_0 = metal::max((metal::float4x4(metal::float4(-4.1674604, 1.9599856, -0.73242956, -0.20504631), metal::float4(-0.12590207, 0.52091557, 0.07906628, 0.021661459), metal::float4(0.08731185, -0.010980034, -0.04702237, -0.014140079), metal::float4(-2.3502588, 0.98347735, 5.2544265, 7.5886335)) * h0_0) + (metal::float4x4(metal::float4(-2.0677073, -3.0403187, -7.251252, -0.21163398), metal::float4(4.0386076, -0.3408012, -6.547609, -0.27915618), metal::float4(2.371881, -3.6694639, 2.8083203, 0.16396397), metal::float4(-4.5592628, 3.2408876, 0.7731898, -6.0322914)) * h0_1), metal::float4(0.0));
    metal::float4 h1_1_ = metal::max((metal::float4x4(metal::float4(-0.46817917, 2.2209268, 0.42732853, -2.1391058), metal::float4(0.6626024, 0.12554957, 0.15880474, 0.08205461), metal::float4(-0.002107043, 0.067374885, -0.04141126, 0.018053476), metal::float4(-0.02131919, -5.3346705, 6.854231, 0.49863964)) * h0_0) + (metal::float4x4(metal::float4(-2.3983507, -2.2166302, -9.364158, -4.6879478), metal::float4(-7.131321, 0.9307025, -5.2908893, -0.09217429), metal::float4(0.18057501, -0.056932688, -5.222522, 5.909689), metal::float4(-3.2400908, 1.7953771, 2.3643174, -2.5787416)) * h0_1), metal::float4(0.0));
    metal::float4 h1_2_ = metal::max((metal::float4x4(metal::float4(-2.0212417, 3.5234349, -0.29862827, 2.837473), metal::float4(-0.0034417917, -0.2701374, -0.06850981, 0.26511696), metal::float4(0.06310855, -0.074502654, 0.0036534448, -0.02181142), metal::float4(1.1280895, -0.06773128, 7.143841, -0.33201975)) * h0_0) + (metal::float4x4(metal::float4(-5.189434, -2.4549117, -0.16383393, 2.9110465), metal::float4(-3.691939, -2.2927215, -1.7290045, 0.5228869), metal::float4(3.423124, 4.379191, -0.54773974, -2.3272412), metal::float4(0.18388788, 1.0360488, -2.4800966, 1.8856108)) * h0_1), metal::float4(0.0));
    metal::float4 h1_3 = metal::max((metal::float4x4(metal::float4(-3.5864356, 3.698348, -2.763185, -2.920156), metal::float4(0.78295255, 0.015520756, -0.32045588, -0.06508547), metal::float4(0.009859245, -0.076360114, 0.06714014, 0.014959682), metal::float4(-0.39343145, -0.1780676, 4.0171967, -0.3578333)) * h0_0) + (metal::float4x4(metal::float4(1.4050651, 0.118033335, -6.476847, -0.18825664), metal::float4(0.19789477, -0.5731352, -5.180575, 3.0493782), metal::float4(-0.75208825, 6.0289307, 3.036596, 0.6782269), metal::float4(-4.040601, -2.1219463, -0.72817266, 0.23356485)) * h0_1), metal::float4(0.0));
    metal::float4 h1_4 = metal::max((metal::float4x4(metal::float4(0.33965114, 0.53012913, 3.6864781, 0.75859493), metal::float4(0.00060585595, -2.9309227, -0.36718613, -0.3317407), metal::float4(0.033321146, 1.2089126, 0.2153916, -0.0014231349), metal::float4(7.1874413, 0.3191635, -8.419987, -2.4559073)) * h0_0) + (metal::float4x4(metal::float4(-11.693587, -2.831591, -2.3943553, -8.275588), metal::float4(-7.1602225, -0.7036662, 2.2086513, 3.6333103), metal::float4(4.0300922, 1.7700683, 1.188168, 7.4534593), metal::float4(0.7538325, -0.7767871, 0.016310979, 0.18021783)) * h0_1), metal::float4(0.0));
    metal::float4 h1_5 = metal::max((metal::float4x4(metal::float4(-1.3306596, 1.8677293, -4.101393, -4.6770787), metal::float4(0.19519782, -0.48456788, -0.20488237, 0.021339769), metal::float4(-0.010044715, -0.031366363, 0.050242912, 0.015430227), metal::float4(-4.2732124, 1.70702, 0.0028088223, -0.010693944)) * h0_0) + (metal::float4x4(metal::float4(-3.774896, -1.1750406, -0.93092984, -0.049676165), metal::float4(4.5747614, -0.64899164, -0.34892794, -0.11725599), metal::float4(-2.6529639, -2.241756, 1.2695652, 0.121937424), metal::float4(1.5011057, 2.9329836, -3.6110363, -4.5134344)) * h0_1), metal::float4(0.0));
    metal::float4 h1_6 = metal::max((metal::float4x4(metal::float4(-4.6046376, 3.0093236, 4.978195, 1.5529538), metal::float4(-5.0088716, 0.49800482, 0.108492136, 0.17909843), metal::float4(0.19106047, 0.006962222, -0.0562687, -0.05636758), metal::float4(2.4868011, -2.9974, 1.1363013, 0.8436937)) * h0_0) + (metal::float4x4(metal::float4(-3.112934, 2.7212074, -0.7725423, 2.895838), metal::float4(-1.4298413, 2.0517163, -5.190096, -2.2426555), metal::float4(1.0851005, 1.2990258, 1.9417673, -7.12554), metal::float4(-1.7792232, 0.8998802, 0.6199238, 1.7865978)) * h0_1), metal::float4(0.0));
    metal::float4 h1_7 = metal::max((metal::float4x4(metal::float4(-4.373691, 7.469767, 0.73178667, 0.19036344), metal::float4(0.18150902, -0.09014448, -0.10938936, 0.30877957), metal::float4(-0.00059860875, -0.04931852, -0.033257622, 0.008763494), metal::float4(0.013503743, -1.9672016, -3.3122485, 2.5027857)) * h0_0) + (metal::float4x4(metal::float4(-0.16557512, -2.3265748, 3.9967105, 5.9642453), metal::float4(4.2863545, -0.5382311, 1.9298717, -1.1969867), metal::float4(-1.3004589, -0.5782102, -3.2860882, 0.18440095), metal::float4(0.19718102, -2.082068, 1.6094493, -3.5837553)) * h0_1), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.5403837, -1.8343279, -0.9217493, 1.313698) + (metal::float4x4(metal::float4(2.0213919, -2.91184, 1.5348691, -0.2929838), metal::float4(1.3055472, 0.27231, -0.8899139, -0.4409711), metal::float4(0.11069353, -1.8431019, 0.17304926, 0.8809019), metal::float4(-5.399847, -17.517437, 0.47533467, 6.2987537)) * h1_0)) + (metal::float4x4(metal::float4(0.419285, -0.42110118, 2.5071044, -1.4210333), metal::float4(-0.7503765, 0.8864603, 0.037235156, 0.37260938), metal::float4(0.6845067, 0.44033587, -0.28448498, 0.24686478), metal::float4(2.7418797, 1.6742915, 0.8079822, -0.8698964)) * h1_1_)) + (metal::float4x4(metal::float4(0.9036239, -0.82326996, -0.8262928, -0.335104), metal::float4(-0.41287225, -0.55577654, -1.3758198, -0.18870488), metal::float4(-0.63340414, 0.42160872, 0.7002752, 2.267698), metal::float4(-1.08188, -3.98043, -1.4021765, 0.6892029)) * h1_2_)) + (metal::float4x4(metal::float4(3.4161088, 0.7640683, 1.9327487, 1.83947), metal::float4(-5.0462413, -0.713245, -0.014138731, -0.31107137), metal::float4(1.3723212, 2.744764, -0.30109656, -0.48658893), metal::float4(0.26442823, -1.2755157, 0.42979032, 0.022228852)) * h1_3)) + (metal::float4x4(metal::float4(0.9166541, 2.8674293, -2.7461586, -0.11615238), metal::float4(0.077809386, -2.372911, -0.1854338, 0.5619069), metal::float4(-1.2895492, -0.69098186, -1.6812513, 0.17504105), metal::float4(-1.556445, 1.623512, 1.1337266, 2.044273)) * h1_4)) + (metal::float4x4(metal::float4(-0.8967381, 2.4832838, 0.3154895, 0.5799579), metal::float4(0.76742953, -1.2556587, 1.0351061, 0.9519333), metal::float4(0.7550382, -0.7536835, -8.745191, -0.5979435), metal::float4(-0.6330228, -5.822986, -24.325792, 3.6463118)) * h1_5)) + (metal::float4x4(metal::float4(-0.16797684, 1.0777332, -0.6376268, -0.33728403), metal::float4(-1.061007, 2.0483856, 1.2846082, -0.06528943), metal::float4(-2.8672419, -0.13821496, -0.40658525, -0.7010545), metal::float4(0.73339987, 0.85867685, -2.980733, -0.6767882)) * h1_6)) + (metal::float4x4(metal::float4(-0.17565668, -0.66932446, -0.087680444, 0.82007885), metal::float4(-0.81018645, -5.083275, 6.716149, -2.5253572), metal::float4(-0.21873666, 1.6195232, 0.10287789, -0.7853111), metal::float4(-0.8664899, 1.8022391, 0.12425704, -0.12265211)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1_ = metal::max((((((((metal::float4(-7.616127, 0.743722, -0.04113058, -1.5676365) + (metal::float4x4(metal::float4(-0.019619394, -2.9439027, 0.20967697, -3.419845), metal::float4(-3.0203755, -0.17222819, -0.21907517, -0.1506443), metal::float4(0.2171478, -0.16118884, -0.34547976, 3.1116161), metal::float4(0.59133464, 0.16578314, -0.26919577, -17.852287)) * h1_0)) + (metal::float4x4(metal::float4(-1.9658519, -0.026431112, -0.32840747, 2.9921103), metal::float4(-3.432273, 0.28572825, -0.3039937, -1.5232166), metal::float4(-1.0966971, -0.76801056, 0.27018806, 3.2838664), metal::float4(-0.8133999, -0.12406365, -0.23587477, 0.42709732)) * h1_1_)) + (metal::float4x4(metal::float4(-6.489317, 0.13252488, -0.26811773, 2.2592547), metal::float4(-3.6722937, 0.4313345, 0.27116078, -0.16659443), metal::float4(0.10130279, 0.19058819, 0.043735087, -3.4506261), metal::float4(2.148812, -1.1394475, -0.23171818, -2.8741112)) * h1_2_)) + (metal::float4x4(metal::float4(0.6639304, 3.6351647, 0.15170369, -0.9139982), metal::float4(1.5778636, -0.57759607, -0.076416016, -17.85372), metal::float4(-2.942476, -1.2473558, -0.3413897, 1.8454653), metal::float4(-6.107756, -0.2496649, -0.2933674, -0.3217662)) * h1_3)) + (metal::float4x4(metal::float4(0.27639863, -0.020356344, 0.20805937, 5.0024533), metal::float4(0.27502623, 0.33333814, -0.17369579, 0.3428085), metal::float4(0.2811654, -0.09691671, 0.3376751, -4.3889575), metal::float4(0.5050634, 0.056959357, 0.15600675, 0.9328736)) * h1_4)) + (metal::float4x4(metal::float4(0.6798183, 0.561105, -0.29834086, -1.388716), metal::float4(0.93923146, -0.38923523, -0.0074161366, -0.62310964), metal::float4(-0.27356088, -3.8132336, -0.326761, -3.2853408), metal::float4(-0.17321798, -10.054951, 0.094018586, -4.1044903)) * h1_5)) + (metal::float4x4(metal::float4(-2.9375002, -1.5772644, -0.028824203, 0.39525685), metal::float4(0.2538739, 0.6404099, -0.08917889, -0.23136254), metal::float4(-1.4123424, 0.49519774, -0.28288534, -4.4888506), metal::float4(-0.19552387, 0.031744648, -0.024117399, 3.5014074)) * h1_6)) + (metal::float4x4(metal::float4(-6.388915, 0.25000545, -0.319836, -0.93253845), metal::float4(9.816028, 2.536431, 0.09538501, -0.33083022), metal::float4(-3.8032932, 1.2661434, -0.16308375, -2.2764294), metal::float4(1.7594389, -0.51916075, -0.13081738, -2.6253278)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2_ = metal::max((((((((metal::float4(-1.6024822, 0.326761, -5.2702546, -9.288301) + (metal::float4x4(metal::float4(1.9530706, -1.8485831, 0.2109906, -0.25858083), metal::float4(0.93915653, 1.6989772, 0.10935656, 3.243871), metal::float4(-1.668992, 0.26239094, -0.19926538, -0.2640662), metal::float4(-4.7925825, -1.5411111, -1.9145753, 1.6478897)) * h1_0)) + (metal::float4x4(metal::float4(-0.35818458, 1.2148889, 0.3322431, 2.009875), metal::float4(-0.88717693, 2.085225, -0.059712175, -0.7660865), metal::float4(-5.2038116, 1.1421809, -0.069393694, -1.2104797), metal::float4(1.4166483, 8.891604, -0.19883786, 2.5516102)) * h1_1_)) + (metal::float4x4(metal::float4(-0.8331628, -0.74940425, -0.5258979, -0.38192207), metal::float4(-0.61086315, -1.6954087, 0.03969145, 2.0987928), metal::float4(0.17930607, -0.91649634, -0.14285758, -1.7155297), metal::float4(0.8023482, 0.7970375, 0.6197916, -5.2210584)) * h1_2_)) + (metal::float4x4(metal::float4(-2.5854452, 5.9796576, 0.61167616, 0.4250337), metal::float4(1.3043399, 2.8135962, -0.05531424, -0.15286618), metal::float4(1.3677459, 2.6523335, 0.37061626, 0.8490703), metal::float4(-0.28107482, -19.692179, -0.19836535, -1.71023)) * h1_3)) + (metal::float4x4(metal::float4(1.2583504, -0.7968344, 0.369631, 0.28707027), metal::float4(0.32727537, 0.16690618, -0.3634363, 0.88905156), metal::float4(0.014350122, -0.15114553, 0.2937969, 1.5788385), metal::float4(-4.5339465, -0.17390747, -0.241532, 0.70758146)) * h1_4)) + (metal::float4x4(metal::float4(-0.5519906, 2.8230247, 0.05278055, 0.54575557), metal::float4(-1.3154308, 0.656429, 0.7821612, -9.275172), metal::float4(1.1405544, -2.1575017, 1.4119513, 0.7853599), metal::float4(3.2076383, -6.13053, 15.256626, -12.406102)) * h1_5)) + (metal::float4x4(metal::float4(1.2811682, 0.083948754, -0.37948, -0.4940118), metal::float4(-1.1444502, -2.5660405, -0.552346, 0.1214361), metal::float4(0.5068235, -0.47298962, 0.4408889, -2.732477), metal::float4(-0.5066367, -0.8545023, -0.51588374, -1.2569976)) * h1_6)) + (metal::float4x4(metal::float4(0.5785463, -32.425995, 0.42408907, 0.9343084), metal::float4(-3.902431, -0.7520251, -0.06531561, -4.5250793), metal::float4(1.669008, 1.2654543, 0.5549053, 3.3851264), metal::float4(-0.31843388, -0.1135918, 0.2259276, 3.8177497)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(2.192788, -0.38622347, 1.562341, -3.0405202) + (metal::float4x4(metal::float4(1.9812528, -0.36313337, -0.7867708, -1.8871622), metal::float4(-0.3773511, -0.16610058, 1.1051798, 1.2316991), metal::float4(1.8488358, -0.046805546, -0.6921194, -0.5387434), metal::float4(0.3181373, -0.18279947, -1.689014, 3.066741)) * h1_0)) + (metal::float4x4(metal::float4(-0.34661636, -0.4327142, 1.5718977, -0.5606247), metal::float4(-0.03964064, -0.23198833, 0.47888073, -0.5954511), metal::float4(-0.36834794, -0.23371373, 0.15666945, 0.93414724), metal::float4(-0.281857, 0.20966858, 8.412329, 9.048968)) * h1_1_)) + (metal::float4x4(metal::float4(-0.34866777, -0.29574445, 2.2201583, 1.0108215), metal::float4(2.1363382, -0.027613534, -1.1590986, -0.66171604), metal::float4(0.34671408, 0.07055651, -0.63689375, -0.49965852), metal::float4(-1.2961404, -0.75858885, 0.23002268, 0.47372976)) * h1_2_)) + (metal::float4x4(metal::float4(-0.008777903, -0.58365583, -7.097225, -0.7343006), metal::float4(-2.659016, 0.31216386, 0.68762773, 0.2661025), metal::float4(-1.6388949, -0.17292544, -0.52062505, -0.22462904), metal::float4(0.8361993, -0.09593139, -4.261884, -0.79932857)) * h1_3)) + (metal::float4x4(metal::float4(-0.23727515, -0.091116585, 0.93601537, -2.982952), metal::float4(0.032420382, -0.21857665, -0.6826385, 0.1599772), metal::float4(0.47912702, -0.3265304, -0.20499313, -1.6727635), metal::float4(1.9387163, -0.111314304, -0.61201704, 2.9126418)) * h1_4)) + (metal::float4x4(metal::float4(-0.80854404, 0.07845742, -2.8177385, 0.109425806), metal::float4(0.19731739, -0.1832566, 0.387768, 0.2938763), metal::float4(-1.713297, 0.05192612, -10.083423, -0.7480528), metal::float4(-8.829212, -0.33925098, -16.97128, -2.5043054)) * h1_5)) + (metal::float4x4(metal::float4(-0.6140045, -0.27008948, -0.00565183, 0.40399697), metal::float4(1.3195682, -0.2859485, -0.6891265, -0.010279318), metal::float4(-0.27614084, -0.34485704, 1.0004749, -2.5375779), metal::float4(0.1936343, -0.15814485, -0.32213724, -0.7124809)) * h1_6)) + (metal::float4x4(metal::float4(-1.5785738, -0.5448545, -7.9740224, -0.3882083), metal::float4(-1.0468239, -0.4249315, -0.3257484, -0.8561734), metal::float4(-0.07593948, -0.07261215, 0.73661035, 0.53244424), metal::float4(0.6394129, -0.39995986, -1.0125879, -0.50449544)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.23133157, 0.07465856, 0.11972243, -0.19268681), h2_0)) + metal::dot(metal::float4(0.34225202, 0.15328355, -0.12462099, -0.17171375), h2_1_)) + metal::dot(metal::float4(0.09308249, 0.25963008, -0.57784873, 0.18180469), h2_2_)) + metal::dot(metal::float4(0.15193784, 0.23329662, 0.12255926, -0.111732274), h2_3);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    type_8 f_1
) {
    float absorbance_5 = metal::max(metal::exp(metal::min(f_1.inner[2], 40.0)) - 0.05, 0.0);
    float _e9 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_5 * _e9, 80.0)));
}

float nmt_fragment_transmittance(
    float v_2,
    float z_2,
    float absorbance_2,
    float nearest_1,
    float farthest_1,
    float z_nearest_1,
    float z_farthest_1,
    float n_1,
    float b0_1,
    type_1 b_2
) {
    float front_1 = 0.0;
    float m1_1 = {};
    float m2_1 = {};
    float m3_1 = {};
    float m4_1 = {};
    float others_1 = metal::clamp(b0_1 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    if (v_2 != nearest_1) {
        if (others_1 > (0.000001 * b0_1)) {
            front_1 = others_1;
            if (v_2 != farthest_1) {
                float c_1 = 0.5 * (z_nearest_1 + z_farthest_1);
                float h1_1 = 1.0 / metal::max(0.5 * (z_farthest_1 - z_nearest_1), 0.00000001);
                float own1_2 = absorbance_2 * z_2;
                float own2_2 = own1_2 * z_2;
                float own3_2 = own2_2 * z_2;
                float own4_2 = own3_2 * z_2;
                float per_b0_1 = 1.0 / metal::max(others_1, 0.000000000000000000000000000001);
                m1_1 = (b_2.inner[0] - own1_2) * per_b0_1;
                m2_1 = (b_2.inner[1] - own2_2) * per_b0_1;
                m3_1 = (b_2.inner[2] - own3_2) * per_b0_1;
                m4_1 = (b_2.inner[3] - own4_2) * per_b0_1;
                float _e55 = m4_1;
                float _e56 = m3_1;
                m4_1 = _e55 - (c_1 * _e56);
                float _e59 = m3_1;
                float _e60 = m2_1;
                m3_1 = _e59 - (c_1 * _e60);
                float _e63 = m2_1;
                float _e64 = m1_1;
                m2_1 = _e63 - (c_1 * _e64);
                float _e67 = m1_1;
                m1_1 = _e67 - c_1;
                float _e69 = m4_1;
                float _e70 = m3_1;
                m4_1 = _e69 - (c_1 * _e70);
                float _e73 = m3_1;
                float _e74 = m2_1;
                m3_1 = _e73 - (c_1 * _e74);
                float _e77 = m2_1;
                float _e78 = m1_1;
                m2_1 = _e77 - (c_1 * _e78);
                float _e81 = m4_1;
                float _e82 = m3_1;
                m4_1 = _e81 - (c_1 * _e82);
                float _e85 = m3_1;
                float _e86 = m2_1;
                m3_1 = _e85 - (c_1 * _e86);
                float _e89 = m4_1;
                float _e90 = m3_1;
                m4_1 = _e89 - (c_1 * _e90);
                float h2_1 = h1_1 * h1_1;
                float h3_1 = h2_1 * h1_1;
                float h4_1 = h2_1 * h2_1;
                float _e96 = m1_1;
                m1_1 = metal::clamp(_e96 * h1_1, -1.0, 1.0);
                float _e101 = m2_1;
                m2_1 = metal::clamp(_e101 * h2_1, -1.0, 1.0);
                float _e106 = m3_1;
                m3_1 = metal::clamp(_e106 * h3_1, -1.0, 1.0);
                float _e111 = m4_1;
                m4_1 = metal::clamp(_e111 * h4_1, -1.0, 1.0);
                float along_1 = (z_2 - c_1) * h1_1;
                float range_3 = farthest_1 - nearest_1;
                float ratio_1 = range_3 / nearest_1;
                float t_1 = (v_2 - nearest_1) / metal::max(range_3, 0.000000000000000000000000000001);
                float x_1 = metal::clamp((ratio_1 < 0.01) ? (((2.0 * t_1) * (1.0 + ((0.5 * ratio_1) * (1.0 - t_1)))) - 1.0) : along_1, -1.0, 1.0);
                float reach_1 = 1.0 + ((2.0 * metal::abs(c_1)) * h1_1);
                float e1_1 = ((NMT_ROUNDING * reach_1) * b0_1) * per_b0_1;
                float per_n_1 = 1.0 / n_1;
                float noise1_1 = e1_1 * (0.12 * metal::sqrt(n_1));
                float deviation1_1 = 0.22 + (0.7 * per_n_1);
                float trust1_1 = deviation1_1 * deviation1_1;
                float _e163 = m1_1;
                float mean0_1 = _e163 * (trust1_1 / (trust1_1 + (noise1_1 * noise1_1)));
                float front3_1 = others_1 * metal::clamp(0.5 - (0.5 * mean0_1), 0.0, 1.0);
                front_1 = front3_1;
                if (n_1 != 3.0) {
                    float further_1 = reach_1 * 0.87;
                    float noise2_1 = metal::min(noise1_1 * further_1, 1000000000000000.0);
                    float noise3_1 = (noise1_1 * further_1) * further_1;
                    float most0_1 = metal::max(1.0 - (mean0_1 * mean0_1), 0.000001);
                    float deviation2_1 = 0.12 + (0.5 * per_n_1);
                    float trust2_1 = (deviation2_1 * deviation2_1) * most0_1;
                    float doubt2_1 = noise2_1 * noise2_1;
                    float _e197 = m2_1;
                    float spread0_1 = ((metal::clamp(_e197 - (mean0_1 * mean0_1), 0.0, most0_1) * trust2_1) + ((0.3 + (1.8 * per_n_1)) * doubt2_1)) / ((most0_1 * trust2_1) + doubt2_1);
                    float _e212 = m2_1;
                    float per_mass1_1 = 1.0 / metal::max(1.0 - _e212, 0.000001);
                    float mean_part_1 = 1.0 + spread0_1;
                    float deviation3_1 = (0.17 + (3.1 * per_n_1)) * (spread0_1 + 0.02);
                    float trust3_1 = deviation3_1 * deviation3_1;
                    float bounded3_1 = metal::min(noise3_1 * per_mass1_1, 1000000000000000.0);
                    float doubt3_1 = bounded3_1 * bounded3_1;
                    float expected3_1 = mean0_1 * (1.0 - spread0_1);
                    float _e236 = m1_1;
                    float _e237 = m3_1;
                    float raw_mean1_1 = metal::clamp((_e236 - _e237) * per_mass1_1, -1.0, 1.0);
                    float mean1_1 = (((raw_mean1_1 * mean_part_1) * trust3_1) + (expected3_1 * doubt3_1)) / (mean_part_1 * (trust3_1 + doubt3_1));
                    float noise_1 = bounded3_1 + (0.0000009536743 * per_mass1_1);
                    float off_1 = (noise_1 * deviation3_1) / (noise_1 + deviation3_1);
                    float inner_1 = (1.0 - spread0_1) * (1.0 - (mean0_1 * mean0_1));
                    float near_share_1 = metal::clamp(0.5 * ((1.0 - mean0_1) - (inner_1 / metal::max(1.0 + mean1_1, 0.000001))), 0.0, 1.0);
                    float far_share_1 = metal::clamp(0.5 * ((1.0 + mean0_1) - (inner_1 / metal::max(1.0 - mean1_1, 0.000001))), 0.0, 1.0);
                    float behind_1 = metal::clamp(0.5 + ((0.5 * (x_1 - mean1_1)) / off_1), 0.0, 1.0);
                    float front4_1 = others_1 * metal::clamp(near_share_1 + (behind_1 * ((1.0 - far_share_1) - near_share_1)), 0.0, 1.0);
                    front_1 = front4_1;
                    if (n_1 != 4.0) {
                        float count_1 = (metal::log(n_1) * 0.48089835) - 1.0;
                        float most1_1 = metal::max(1.0 - (mean1_1 * mean1_1), 0.000001);
                        float spread_part_1 = mean_part_1 + spread0_1;
                        float offset_1 = (mean1_1 * mean_part_1) - expected3_1;
                        float square0_1 = spread0_1 * spread0_1;
                        float expected4_1 = metal::clamp((((0.94 + (-3.8 * per_n_1)) + ((4.0 * square0_1) * square0_1)) - ((1.2 * offset_1) * offset_1)) * spread0_1, 0.0, spread_part_1);
                        float deviation4_1 = (0.12 + (1.4 * per_n_1)) * (spread0_1 + 0.02);
                        float trust4_1 = (deviation4_1 * deviation4_1) * most1_1;
                        float bounded4_1 = metal::min((noise3_1 * further_1) * per_mass1_1, 1000000000000000.0);
                        float doubt4_1 = bounded4_1 * bounded4_1;
                        float _e351 = m2_1;
                        float _e352 = m4_1;
                        float raw_square1_1 = metal::clamp(((_e351 - _e352) * per_mass1_1) - (mean1_1 * mean1_1), 0.0, most1_1);
                        float square1_1 = (((raw_square1_1 * trust4_1) * spread_part_1) + (expected4_1 * doubt4_1)) / (spread_part_1 * ((trust4_1 * most1_1) + doubt4_1));
                        float spread1_1 = metal::sqrt(square1_1);
                        float _e372 = nmt_share(type_8 {{x_1, count_1, metal::log(others_1 + 0.05), mean0_1, spread0_1, mean1_1, spread1_1}});
                        front_1 = others_1 * _e372;
                    }
                }
            }
        }
    }
    float _e374 = front_1;
    return metal::min(metal::exp(-(_e374)), 1.0);
}

float nmt_first_hidden_depth(
    float b0_2,
    float b1,
    float b2
) {
    float excess = b0_2 - 5.0;
    float deviation = metal::sqrt((5.0 * metal::max((b2 * b0_2) - (b1 * b1), 0.0)) / metal::max(excess, 0.000001));
    return (excess > 0.0) ? ((b1 + deviation) / metal::max(b0_2, 0.000000000000000000000000000001)) : 300000000000000000000000000000000000000.0;
}

float nmt_hidden_weight(
    float z_3,
    float absorbance_3,
    float z_nearest_2,
    float z_farthest_2,
    float n_2,
    float b0_3,
    type_1 b_3
) {
    float m1_2 = {};
    float m2_2 = {};
    float m3_2 = {};
    float m4_2 = {};
    float others_2 = metal::clamp(b0_3 - absorbance_3, 0.0, 1000000000000000000000000000000.0);
    float c_2 = 0.5 * (z_nearest_2 + z_farthest_2);
    float h1_2 = 1.0 / metal::max(0.5 * (z_farthest_2 - z_nearest_2), 0.00000001);
    float own1_3 = absorbance_3 * z_3;
    float own2_3 = own1_3 * z_3;
    float own3_3 = own2_3 * z_3;
    float own4_3 = own3_3 * z_3;
    float per_b0_2 = 1.0 / metal::max(others_2, 0.000000000000000000000000000001);
    m1_2 = (b_3.inner[0] - own1_3) * per_b0_2;
    m2_2 = (b_3.inner[1] - own2_3) * per_b0_2;
    m3_2 = (b_3.inner[2] - own3_3) * per_b0_2;
    m4_2 = (b_3.inner[3] - own4_3) * per_b0_2;
    float _e45 = m4_2;
    float _e46 = m3_2;
    m4_2 = _e45 - (c_2 * _e46);
    float _e49 = m3_2;
    float _e50 = m2_2;
    m3_2 = _e49 - (c_2 * _e50);
    float _e53 = m2_2;
    float _e54 = m1_2;
    m2_2 = _e53 - (c_2 * _e54);
    float _e57 = m1_2;
    m1_2 = _e57 - c_2;
    float _e59 = m4_2;
    float _e60 = m3_2;
    m4_2 = _e59 - (c_2 * _e60);
    float _e63 = m3_2;
    float _e64 = m2_2;
    m3_2 = _e63 - (c_2 * _e64);
    float _e67 = m2_2;
    float _e68 = m1_2;
    m2_2 = _e67 - (c_2 * _e68);
    float _e71 = m4_2;
    float _e72 = m3_2;
    m4_2 = _e71 - (c_2 * _e72);
    float _e75 = m3_2;
    float _e76 = m2_2;
    m3_2 = _e75 - (c_2 * _e76);
    float _e79 = m4_2;
    float _e80 = m3_2;
    m4_2 = _e79 - (c_2 * _e80);
    float h2_2 = h1_2 * h1_2;
    float h3_2 = h2_2 * h1_2;
    float h4_2 = h2_2 * h2_2;
    float _e86 = m1_2;
    m1_2 = metal::clamp(_e86 * h1_2, -1.0, 1.0);
    float _e91 = m2_2;
    m2_2 = metal::clamp(_e91 * h2_2, -1.0, 1.0);
    float _e96 = m3_2;
    m3_2 = metal::clamp(_e96 * h3_2, -1.0, 1.0);
    float _e101 = m4_2;
    m4_2 = metal::clamp(_e101 * h4_2, -1.0, 1.0);
    float reach_2 = 1.0 + ((2.0 * metal::abs(c_2)) * h1_2);
    float unsure = (((n_2 + 16.0) * NMT_ROUNDING) * b0_3) * per_b0_2;
    float off_2 = 0.000002 * h1_2;
    float end = 1.0 + off_2;
    float x_2 = metal::clamp((z_3 - c_2) * h1_2, -1.0, 1.0) - off_2;
    float _e128 = m1_2;
    float ahead = x_2 - _e128;
    float _e130 = m1_2;
    float _e131 = m2_2;
    float _e132 = m1_2;
    float _e133 = m1_2;
    float r1 = metal::max(_e130 - (metal::max(_e131 - (_e132 * _e133), 0.0) / metal::max(ahead, 0.000000000000000000000000000001)), -1000000.0);
    float gap1 = x_2 - r1;
    float reach1 = reach_2 + metal::abs(r1);
    float _e147 = m2_2;
    float _e150 = m1_2;
    float share1 = (((_e147 - ((2.0 * r1) * _e150)) + (r1 * r1)) + ((unsure * reach1) * reach1)) / metal::max(gap1 * gap1, 0.000000000000000000000000000001);
    float _e162 = m1_2;
    float _e163 = m3_2;
    float w1 = _e162 - _e163;
    float _e165 = m2_2;
    float below = w1 - (x_2 * (1.0 - _e165));
    float _e170 = m2_2;
    float _e171 = m4_2;
    float inner_2 = ((_e170 - _e171) - (x_2 * w1)) / ((metal::abs(below) < 0.000000000000000000000000000001) ? 0.000000000000000000000000000001 : below);
    float inside = (inner_2 >= -(end)) ? inner_2 : 300000000000000000000000000000000000000.0;
    float r = (inside < x_2) ? inside : metal::max(r1, -1.0);
    float gap = x_2 - r;
    float per_value = 1.0 / metal::max(((end + x_2) * gap) * gap, 0.000000000000000000000000000001);
    float gamma = (0.99999 * (1.0 - (1.0 / ((((2.0 * end) * (end - r)) * (end - r)) * per_value)))) / (end - x_2);
    float lift = 1.0 + (gamma * x_2);
    float p0 = (end * r) * r;
    float p1 = (r * r) - ((2.0 * r) * end);
    float p2 = end - (2.0 * r);
    float _e229 = m1_2;
    float _e235 = m2_2;
    float _e240 = m3_2;
    float _e243 = m4_2;
    float value = ((((p0 * lift) + (((p1 * lift) - (gamma * p0)) * _e229)) + (((p2 * lift) - (gamma * p1)) * _e235)) + ((lift - (gamma * p2)) * _e240)) - (gamma * _e243);
    float reach2 = reach_2 + metal::abs(r);
    float lost = (((unsure * (end + reach_2)) * reach2) * reach2) * (1.0 + (gamma * (metal::abs(x_2) + reach_2)));
    float share2 = (value + lost) * per_value;
    float share = 1.00001 * metal::min(share1, share2);
    float below_1 = (share < 1.0) ? metal::max(share, 0.0) : 1.0;
    float behind_2 = (ahead > 0.0) ? below_1 : 1.0;
    float least_depth = ((others_2 * (1.0 - behind_2)) - (((n_2 + 4.0) * NMT_ROUNDING) * b0_3)) - 0.00001;
    return metal::exp(-(least_depth)) * metal::min((others_2 * behind_2) + absorbance_3, n_2 - 2.0);
}

float nmt_visible_transmittance(
    float v_3,
    float z_4,
    float absorbance_4,
    float nearest_2,
    float farthest_2,
    float z_nearest_3,
    float z_farthest_3,
    float n_3,
    float b0_4,
    type_1 b_4
) {
    float front_2 = -1.0;
    float answer = {};
    float others_3 = metal::clamp(b0_4 - absorbance_4, 0.0, 1000000000000000000000000000000.0);
    if (n_3 > 4.0) {
        if (v_3 != nearest_2) {
            if (v_3 != farthest_2) {
                if (others_3 > (0.000001 * b0_4)) {
                    if (b0_4 <= NMT_FAINT) {
                        front_2 = 0.5 * others_3;
                    }
                    if (true) {
                        float _e30 = nmt_first_hidden_depth(b0_4, b_4.inner[0], b_4.inner[1]);
                        if (z_4 >= _e30) {
                            float _e32 = nmt_hidden_weight(z_4, absorbance_4, z_nearest_3, z_farthest_3, n_3, b0_4, b_4);
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
        float _e44 = nmt_fragment_transmittance(v_3, z_4, absorbance_4, nearest_2, farthest_2, z_nearest_3, z_farthest_3, n_3, b0_4, b_4);
        answer = _e44;
    }
    float _e45 = answer;
    return _e45;
}

NmtSums nmt_pass1(
    float v_4,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_4, v0_1, v1_1);
    type_1 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6.inner[0], _e6.inner[1], _e6.inner[2]), metal::float4(_e6.inner[3], 1.0, 0.0, 0.0), metal::float4(-(v_4), v_4, 0.0, 0.0)};
}

float nmt_pass2(
    float v_5,
    float v0_2,
    float v1_2,
    float alpha_2,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_3 = -(range.x);
    float farthest_3 = range.y;
    float _e10 = nmt_moment_depth(v_5, v0_2, v1_2);
    float _e11 = nmt_absorbance(alpha_2);
    float _e12 = nmt_moment_depth(nearest_3, v0_2, v1_2);
    float _e13 = nmt_moment_depth(farthest_3, v0_2, v1_2);
    float _e21 = nmt_fragment_transmittance(v_5, _e10, _e11, nearest_3, farthest_3, _e12, _e13, sums1.y, sums0.x, type_1 {{sums0.y, sums0.z, sums0.w, sums1.x}});
    return _e21;
}

float nmt_visible_pass2(
    float v_6,
    float v0_3,
    float v1_3,
    float alpha_3,
    metal::float4 sums0_1,
    metal::float4 sums1_1,
    metal::float4 range_1
) {
    float nearest_4 = -(range_1.x);
    float farthest_4 = range_1.y;
    float _e10 = nmt_moment_depth(v_6, v0_3, v1_3);
    float _e11 = nmt_absorbance(alpha_3);
    float _e12 = nmt_moment_depth(nearest_4, v0_3, v1_3);
    float _e13 = nmt_moment_depth(farthest_4, v0_3, v1_3);
    float _e21 = nmt_visible_transmittance(v_6, _e10, _e11, nearest_4, farthest_4, _e12, _e13, sums1_1.y, sums0_1.x, type_1 {{sums0_1.y, sums0_1.z, sums0_1.w, sums1_1.x}});
    return _e21;
}

metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0_2
) {
    float behind_3 = metal::exp(-(sums0_2.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind_3) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.xyz, behind_3);
}

#endif
