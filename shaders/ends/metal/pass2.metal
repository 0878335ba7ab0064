// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a11f08561d89, backend fused, seed 1, epochs 1500, dataset 381d5ef98678649c941c2c4c7bd79249c8745cf2398e785a10c209e31313e407.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.982e-3, worst 1.000.

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType2 {
    metal::float4x4 inner[24];
};
struct NmtType4 {
    metal::float4x4 inner[32];
};
struct NmtType5 {
    metal::float4 inner[4];
};
struct NmtCodes {
    int first_bits;
    int last_bits;
    int first_log2;
    uint shift;
    uint multiplier;
    uint slope;
};
struct Frame {
    float v0;
    float v1;
};
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(1.4317298, 2.191651, 6.727079, -3.751045), metal::float4(-0.060478445, 0.11461254, -0.1646913, -0.35877922), metal::float4(0.06289728, -0.1580284, 0.07473804, 0.13326874), metal::float4(7.0914807, 5.603903, 0.58649045, -2.2741826)), metal::float4x4(metal::float4(-3.4689405, -8.352193, -1.883482, 2.9752848), metal::float4(0.74735314, 6.36241, -5.499922, 0.58222175), metal::float4(-4.0372705, -7.862177, 1.2919396, -18.645775), metal::float4(-4.5778747, -9.596229, -0.32165408, 3.9021926)), metal::float4x4(metal::float4(9.54276, -0.0893324, 0.5160126, 2.5115654), metal::float4(-0.91783404, 0.8151581, 3.3516243, -0.12292782), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-1.1352023, 1.2119503, -2.8251603, -3.9147177), metal::float4(-0.123959064, -0.18036275, 0.016107535, 0.0041036624), metal::float4(0.15222655, 0.018420562, 0.0005397574, 0.069991186), metal::float4(-29.524288, -0.110847086, -8.73089, -7.214845)), metal::float4x4(metal::float4(-6.5716004, -0.14318708, -5.8059306, -5.389088), metal::float4(-1.6517118, 5.489244, -3.0327194, 9.124509), metal::float4(1.7978463, 0.8188869, -0.6640067, -12.607745), metal::float4(-0.5151307, -6.743748, 1.172957, -8.333976)), metal::float4x4(metal::float4(-19.125027, -1.8108281, 7.6768246, -0.95093083), metal::float4(1.8843677, 3.0185444, -3.3729057, 0.74029505), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(3.6519125, 1.5300299, -2.5522842, 1.2378398), metal::float4(-0.28464514, -0.121829726, -0.4616278, 0.32837835), metal::float4(0.039522942, -0.042005762, -0.05278465, 0.0013193002), metal::float4(-29.194708, 6.2694902, -10.627289, 2.0877857)), metal::float4x4(metal::float4(-15.559965, 0.87976754, 4.560895, 1.7619933), metal::float4(1.689421, 3.5073512, 2.3340404, 1.6568208), metal::float4(-4.8063483, -8.044831, -4.486502, 5.4426866), metal::float4(0.7073662, -3.271601, 2.5592906, -0.84171367)), metal::float4x4(metal::float4(-2.4559228, 8.6417265, -3.190338, -6.912059), metal::float4(5.0728116, -0.9842609, -0.053381015, -0.48948488), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.8468652, 0.49485567, -1.4169084, -3.5201824), metal::float4(-0.18228158, -0.07358338, -0.09071074, -0.112331256), metal::float4(0.14616138, 0.0965952, 0.080804884, 0.55146295), metal::float4(-62.268635, 2.377452, -246.12312, 12.9031925)), metal::float4x4(metal::float4(3.3802698, 2.0192537, -1.4338511, -6.659293), metal::float4(1.6852884, 5.941192, -0.8342008, 0.6035608), metal::float4(0.82760155, 4.488113, -2.2999249, 0.8024826), metal::float4(2.7274487, -5.7792253, -0.42838722, -0.6982501)), metal::float4x4(metal::float4(-1.4576274, -2.8315725, 0.17714114, -2.9663568), metal::float4(-2.2372859, -3.2930517, 1.4550539, -1.765235), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.057183642, 3.3389902, -3.542497, 5.0050306), metal::float4(-6.2289014, -0.45804322, -0.21599492, 0.4667237), metal::float4(1.8799043, 0.47896728, 0.021543205, -0.11040543), metal::float4(-47.834312, 12.908583, -50.006176, 12.68344)), metal::float4x4(metal::float4(-7.166474, -3.2794552, -7.324561, -11.086611), metal::float4(0.08703052, 3.6560774, -6.625171, -9.83278), metal::float4(-1.1809275, 4.1829724, -2.0076742, -2.3111808), metal::float4(-0.5327761, 6.0015187, 8.269169, 7.0828376)), metal::float4x4(metal::float4(1.2172115, 2.3474467, 6.6875763, 1.2265673), metal::float4(-0.84486043, -8.57313, -4.2065907, 0.25463516), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(1.2139328, 0.5683898, -8.752637, -2.3898895), metal::float4(-0.20198928, -0.1401188, 0.0076826406, -0.1317224), metal::float4(-0.15326285, 0.02953581, 0.005616545, -0.18556674), metal::float4(-74.320786, -63.76376, -0.40675116, 0.7189491)), metal::float4x4(metal::float4(-16.147669, -42.632393, -0.06485997, -0.7695405), metal::float4(-1.2008938, -1.9657207, -0.032466654, -0.61546624), metal::float4(-2.8951817, -0.36982724, -0.08826993, -0.04208433), metal::float4(-0.98575014, 0.2650366, 0.07488505, 0.25202516)), metal::float4x4(metal::float4(6.882571, 3.3037403, -0.026097342, -0.8564453), metal::float4(2.0067384, 2.481892, -8.339849, -3.6626396), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-8.682326, 2.5371814, 1.7621095, 5.163456), metal::float4(-0.04183948, -0.037750814, -0.26279384, 0.121042185), metal::float4(0.14225043, 0.2631145, 0.027440522, -0.017610844), metal::float4(-0.8747293, 0.17003822, -1.4690326, -40.289505)), metal::float4x4(metal::float4(-2.7966685, -0.4179041, 0.9744584, -15.364956), metal::float4(-2.036611, 1.2122619, 3.4936776, -8.379077), metal::float4(-0.058713485, 6.524647, 3.5530078, -2.8674653), metal::float4(1.0533278, -9.348143, -6.0639396, 6.181865)), metal::float4x4(metal::float4(-0.589845, -0.031207768, 1.9180096, 8.55072), metal::float4(-5.5204773, -12.310446, -1.1147383, 2.9653676), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-4.5687118, 3.9562721, -1.7089586, 2.9960845), metal::float4(0.3399617, 0.0059691444, 0.021057142, -0.3196038), metal::float4(-0.071923144, -0.06025869, -0.031907883, 0.4514363), metal::float4(9.062922, 2.733657, 6.4316134, -15.971774)), metal::float4x4(metal::float4(-4.166488, 4.485879, 7.3074393, 2.037908), metal::float4(4.997433, -1.8625803, -0.15396278, -5.600335), metal::float4(-8.760638, -5.704339, 0.5472291, 4.4456587), metal::float4(-1.0656345, -2.1319022, -0.6854484, 3.65672)), metal::float4x4(metal::float4(1.3734262, 0.061342563, 1.6200686, -1.0755827), metal::float4(-0.47460523, -1.7739332, -2.109841, -0.5640859), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(-0.027982399, -1.5974598, -0.26108313, -0.44758323), metal::float4(-2.5582268, -11.182121, -14.092224, 0.48459366), metal::float4(-0.3511142, 0.19059174, -4.006024, -2.5721786), metal::float4(0.84639025, 0.71176577, -2.404681, -0.99055934)), metal::float4x4(metal::float4(-0.57720464, -0.21008737, -2.6325812, 0.8914639), metal::float4(0.6590815, -4.3658676, -1.1448785, 0.9430832), metal::float4(0.9581404, 0.24328482, -1.1340039, 0.6141433), metal::float4(1.8922666, -1.7110677, 1.5307064, -0.12547962)), metal::float4x4(metal::float4(1.1394193, 2.147547, -3.7314217, 1.0358683), metal::float4(0.29220706, 0.64925766, 0.027457166, 1.0072486), metal::float4(-0.2511268, -1.6159694, -0.30810866, -0.7661485), metal::float4(-0.61015004, -11.99502, -1.4946063, 0.6136324)), metal::float4x4(metal::float4(0.48261017, 0.31079328, 3.0939977, 0.57151663), metal::float4(0.50222915, -2.8824496, 3.6301494, -0.72832125), metal::float4(1.2419188, 6.1217794, 0.9959902, -2.6530755), metal::float4(1.0656027, -0.80007607, 0.0050528687, 0.3594124)), metal::float4x4(metal::float4(0.4766542, -0.6569586, 0.09155712, 0.20338818), metal::float4(0.061753884, -5.875319, 0.8493232, 1.9528707), metal::float4(-0.098926954, -0.076384485, 0.25303012, -0.44919094), metal::float4(-1.6619605, -1.0296458, -0.80755866, 1.041455)), metal::float4x4(metal::float4(-0.28459114, -0.23509726, 2.6095576, 0.3711765), metal::float4(-0.19801985, 1.3067058, -1.8208132, -0.21006615), metal::float4(17.968971, 1.0652256, -3.5379207, -2.321049), metal::float4(5.994907, 7.3533573, 7.0550814, 3.9401383)), metal::float4x4(metal::float4(0.5775448, -0.6548861, -1.2006896, 4.452374), metal::float4(1.9466195, 2.9656568, -9.168257, 3.7066925), metal::float4(0.010909571, -4.760984, -1.1203054, -0.30235562), metal::float4(-0.37076265, -0.46530518, -3.4178302, 0.21127713)), metal::float4x4(metal::float4(1.3553408, 0.25208706, -0.32089064, 0.3037293), metal::float4(2.6422317, 0.23288439, 5.304172, -1.3016943), metal::float4(-2.056287, -5.8164153, 0.2749001, 0.9006329), metal::float4(1.7194343, -0.39653745, 0.64695686, -1.3309863)), metal::float4x4(metal::float4(-2.6109602, 0.57091993, -0.19495131, 0.2190746), metal::float4(-0.38188392, -8.280481, -0.21908845, -8.753874), metal::float4(0.16272675, 0.90584135, -0.7099145, 0.19912654), metal::float4(-1.0646359, 0.06383801, -0.65292776, -0.6046393)), metal::float4x4(metal::float4(-4.3083715, 1.2327925, -0.35576007, -0.13176583), metal::float4(-1.8031285, 1.1302786, -0.87164867, 1.0115228), metal::float4(2.5004644, -0.8605538, -0.47234374, -0.01138025), metal::float4(-2.1511698, 1.2068214, -0.29616776, 2.0578663)), metal::float4x4(metal::float4(-7.250049, -0.6875534, -0.26806444, 1.6461489), metal::float4(1.9680052, -0.7389492, -0.12802388, -1.5441029), metal::float4(0.33719414, -2.705163, -0.33733937, 0.30897093), metal::float4(0.3458763, -0.32137284, -0.20389776, -0.20329195)), metal::float4x4(metal::float4(-4.9958253, 0.5969844, -0.0012780179, 0.25512967), metal::float4(1.0859861, 0.4249844, -0.32204592, -0.25992328), metal::float4(-1.1684371, -2.8410194, -1.0051937, 1.1974963), metal::float4(-15.443957, 1.2945144, -0.8225332, -0.3074546)), metal::float4x4(metal::float4(2.9357085, 0.20545141, 0.19485117, 0.91170377), metal::float4(0.50134575, -2.171273, -0.5857367, -1.5256736), metal::float4(-2.9058325, 0.10822418, -0.13411592, 1.1221116), metal::float4(-1.9692392, 0.76492536, -0.39793473, -2.617637)), metal::float4x4(metal::float4(-0.2213089, 0.18984394, -0.8296945, 2.0599499), metal::float4(-0.9738273, 0.39160827, -0.21650149, -1.6428514), metal::float4(-0.46032265, 0.99766743, -0.552936, -5.322368), metal::float4(-0.17638971, -7.9630685, 0.0143214, 8.131895)), metal::float4x4(metal::float4(-4.054167, 0.057102606, -0.42363355, -0.16980857), metal::float4(-0.501281, -5.155497, -0.13397385, -18.643253), metal::float4(-0.4815355, -1.2359868, -0.7334735, -1.0535395), metal::float4(-1.0420411, -0.18130244, -0.5297515, -3.1283865)), metal::float4x4(metal::float4(-0.9608823, -1.173892, -0.93231755, -1.0004952), metal::float4(-0.8453368, -1.7416643, -0.041984737, 0.45407665), metal::float4(-2.6328058, 0.03621532, -0.80184144, -0.12543038), metal::float4(-5.4342036, -0.17941746, -0.5029284, -0.67339176)), metal::float4x4(metal::float4(-0.7316836, -0.2475589, -1.5897065, -0.2768745), metal::float4(0.8213411, 2.9054494, -8.956052, 1.0110811), metal::float4(0.48169297, 0.76748884, -1.2648801, -0.32161984), metal::float4(-2.0701137, -1.8383626, 1.4241215, -1.4391695)), metal::float4x4(metal::float4(-1.8213843, -2.6883566, -2.023306, -0.44395453), metal::float4(0.2872357, -3.1867425, 0.3486228, -0.93589634), metal::float4(-0.20337726, -0.32137153, -0.99396664, -0.0847146), metal::float4(-1.0395169, 3.8884697, 3.523059, -0.92916214)), metal::float4x4(metal::float4(-1.1685339, 1.5040996, 2.2066386, -0.74584043), metal::float4(-1.0791676, 0.7468052, 1.207109, -1.340223), metal::float4(1.173599, 1.1568028, 0.320179, -0.41836986), metal::float4(0.11363276, -0.17460881, 0.71926916, -0.3238061)), metal::float4x4(metal::float4(1.8713467, -2.7534688, 0.39546612, -0.38263693), metal::float4(-1.0851198, -1.6376357, -0.113489404, -0.2849405), metal::float4(0.7609707, 3.4911816, 1.7288836, -0.6940429), metal::float4(0.84274054, -0.5509994, -0.8265054, -1.5711111)), metal::float4x4(metal::float4(0.09381255, -0.4158294, 0.9894585, 0.2408242), metal::float4(-16.54033, -0.7249689, -0.55347764, -1.4864933), metal::float4(-0.31491104, 1.0514522, -1.4282348, -0.12754518), metal::float4(-11.089369, -0.42137167, -4.687089, -0.44227016)), metal::float4x4(metal::float4(-0.139781, 0.16992623, -1.0356948, -0.7625751), metal::float4(-1.0477134, -0.7334245, -7.0605564, -0.49583894), metal::float4(-5.4379754, 1.6187942, 0.1498525, -0.5862648), metal::float4(-10.6316, 0.5565308, -2.2774708, -0.30862746)), metal::float4x4(metal::float4(-0.95374274, -0.16887577, 1.0055864, -0.108160555), metal::float4(-0.89210844, 8.238755, -11.546918, 0.86600065), metal::float4(0.16547705, -6.461979, -0.7165446, -0.7399076), metal::float4(3.6122646, -0.33972144, -6.508603, 0.5218143)), metal::float4x4(metal::float4(-0.19755183, -1.4309961, -0.23493266, -2.4542491), metal::float4(1.4060878, 3.7502568, -0.65528446, 0.19468662), metal::float4(-0.02978186, -1.2009946, 0.46360138, -2.19065), metal::float4(-0.43914932, 2.293388, -0.28565758, -0.76630586)), metal::float4x4(metal::float4(0.6045855, -0.32436177, -0.5969974, 0.7781134), metal::float4(-2.0271108, -25.982105, 3.0252635, -1.8011206), metal::float4(0.0511712, -0.24000557, 0.6970283, -0.30310902), metal::float4(-0.626127, -1.0534695, -2.2961197, -0.13226692)), metal::float4x4(metal::float4(2.343736, -6.217139, 0.6712475, -0.27228785), metal::float4(2.8466034, -0.7898569, -0.29988006, -0.15770356), metal::float4(1.2730513, -1.385769, 0.84351015, -0.8792476), metal::float4(1.739586, -2.8399658, -3.197824, -0.3127936)), metal::float4x4(metal::float4(-0.084362775, -3.91136, -4.428161, 0.3635336), metal::float4(0.27836874, -0.14268269, -0.51529294, -0.538423), metal::float4(0.7830889, -0.0182398, -0.5262698, -1.0518626), metal::float4(0.9851691, 0.3181157, -0.28284815, 0.058373082)), metal::float4x4(metal::float4(-3.414534, -0.5341867, -0.18411401, -0.61921275), metal::float4(-1.510084, -0.26633763, -1.3305926, -0.8619801), metal::float4(-1.5470308, -1.4743968, -38.504658, 0.30969214), metal::float4(-0.14469263, -0.49709392, -3.0121145, 0.079902336)), metal::float4x4(metal::float4(-0.097979546, -0.25242627, 3.8054092, 0.5641174), metal::float4(0.65214485, 0.51018125, -0.44167098, -1.1165974), metal::float4(-0.46976346, 2.875159, -1.2651387, 0.7852967), metal::float4(2.0540571, -1.5942682, -3.18146, -11.497131)), metal::float4x4(metal::float4(0.46952778, 0.87392676, 0.20043781, 0.1656688), metal::float4(-0.10401463, -3.3204172, -3.3489892, -1.9651427), metal::float4(-3.1124127, -6.1396356, 14.753386, 33.852314), metal::float4(1.0041435, 8.950814, -6.8097973, 9.132108)), metal::float4x4(metal::float4(0.024301916, -0.34294394, 3.6597943, -2.9148378), metal::float4(3.058157, -15.93681, -4.1251917, -5.969938), metal::float4(-1.4033467, 0.22916655, 0.8508055, 0.32185614), metal::float4(-0.40119967, -2.2542157, -0.438894, -0.59386617)), metal::float4x4(metal::float4(-0.7943322, -1.1189687, 0.35319355, 0.054232705), metal::float4(1.8380309, -0.83985823, 0.67006063, -0.7411227), metal::float4(0.63809717, 1.5535564, -0.34432167, -0.55257744), metal::float4(-0.64813596, -0.5104218, 1.0521047, 0.48838916))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(1.9449311, -5.905165, -8.407714, -6.7975154), metal::float4(-11.532762, 1.2303761, -0.8146868, 1.1261033), metal::float4(-1.4014693, -1.9073353, -2.223379, -0.7291616), metal::float4(-8.380391, -0.18974769, 0.49893165, 0.3580487)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.17358325, 0.13816246, 0.21617825, -0.103588134), metal::float4(-0.26226506, 0.061416283, -0.053857677, -0.2043406), metal::float4(0.09141985, 0.10511065, 0.17135085, -0.13144962), metal::float4(0.12578346, 0.15885915, 0.08919641, -0.61215395)}};
constant float NMT_B3 = -1.4909608;
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 0u;
constant uint NMT_SLOTS = 2u;
constant float NMT_KEY_SCALE = 0.625;
constant uint NMT_LAST_ABSORBANCE = 27136u;
constant uint NMT_LAST_DEPTH = 65535u;
constant uint NMT_END_BITS = 16u;
constant uint NMT_LINEAR_BITS = 981467136u;
constant float NMT_LINEAR = 0.0009765625;
constant float NMT_OPEN = 0.0;

float nmt_share(
    metal::float3x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = f[1];
    metal::float4 h0_2 = metal::float4(f[2].x, 1.0, 0.0, 0.0);
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(1.4317298, 2.191651, 6.727079, -3.751045), metal::float4(-0.060478445, 0.11461254, -0.1646913, -0.35877922), metal::float4(0.06289728, -0.1580284, 0.07473804, 0.13326874), metal::float4(7.0914807, 5.603903, 0.58649045, -2.2741826)) * h0_0) + (metal::float4x4(metal::float4(-3.4689405, -8.352193, -1.883482, 2.9752848), metal::float4(0.74735314, 6.36241, -5.499922, 0.58222175), metal::float4(-4.0372705, -7.862177, 1.2919396, -18.645775), metal::float4(-4.5778747, -9.596229, -0.32165408, 3.9021926)) * h0_1)) + (metal::float4x4(metal::float4(9.54276, -0.0893324, 0.5160126, 2.5115654), metal::float4(-0.91783404, 0.8151581, 3.3516243, -0.12292782), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-1.1352023, 1.2119503, -2.8251603, -3.9147177), metal::float4(-0.123959064, -0.18036275, 0.016107535, 0.0041036624), metal::float4(0.15222655, 0.018420562, 0.0005397574, 0.069991186), metal::float4(-29.524288, -0.110847086, -8.73089, -7.214845)) * h0_0) + (metal::float4x4(metal::float4(-6.5716004, -0.14318708, -5.8059306, -5.389088), metal::float4(-1.6517118, 5.489244, -3.0327194, 9.124509), metal::float4(1.7978463, 0.8188869, -0.6640067, -12.607745), metal::float4(-0.5151307, -6.743748, 1.172957, -8.333976)) * h0_1)) + (metal::float4x4(metal::float4(-19.125027, -1.8108281, 7.6768246, -0.95093083), metal::float4(1.8843677, 3.0185444, -3.3729057, 0.74029505), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(3.6519125, 1.5300299, -2.5522842, 1.2378398), metal::float4(-0.28464514, -0.121829726, -0.4616278, 0.32837835), metal::float4(0.039522942, -0.042005762, -0.05278465, 0.0013193002), metal::float4(-29.194708, 6.2694902, -10.627289, 2.0877857)) * h0_0) + (metal::float4x4(metal::float4(-15.559965, 0.87976754, 4.560895, 1.7619933), metal::float4(1.689421, 3.5073512, 2.3340404, 1.6568208), metal::float4(-4.8063483, -8.044831, -4.486502, 5.4426866), metal::float4(0.7073662, -3.271601, 2.5592906, -0.84171367)) * h0_1)) + (metal::float4x4(metal::float4(-2.4559228, 8.6417265, -3.190338, -6.912059), metal::float4(5.0728116, -0.9842609, -0.053381015, -0.48948488), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-3.8468652, 0.49485567, -1.4169084, -3.5201824), metal::float4(-0.18228158, -0.07358338, -0.09071074, -0.112331256), metal::float4(0.14616138, 0.0965952, 0.080804884, 0.55146295), metal::float4(-62.268635, 2.377452, -246.12312, 12.9031925)) * h0_0) + (metal::float4x4(metal::float4(3.3802698, 2.0192537, -1.4338511, -6.659293), metal::float4(1.6852884, 5.941192, -0.8342008, 0.6035608), metal::float4(0.82760155, 4.488113, -2.2999249, 0.8024826), metal::float4(2.7274487, -5.7792253, -0.42838722, -0.6982501)) * h0_1)) + (metal::float4x4(metal::float4(-1.4576274, -2.8315725, 0.17714114, -2.9663568), metal::float4(-2.2372859, -3.2930517, 1.4550539, -1.765235), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(-0.057183642, 3.3389902, -3.542497, 5.0050306), metal::float4(-6.2289014, -0.45804322, -0.21599492, 0.4667237), metal::float4(1.8799043, 0.47896728, 0.021543205, -0.11040543), metal::float4(-47.834312, 12.908583, -50.006176, 12.68344)) * h0_0) + (metal::float4x4(metal::float4(-7.166474, -3.2794552, -7.324561, -11.086611), metal::float4(0.08703052, 3.6560774, -6.625171, -9.83278), metal::float4(-1.1809275, 4.1829724, -2.0076742, -2.3111808), metal::float4(-0.5327761, 6.0015187, 8.269169, 7.0828376)) * h0_1)) + (metal::float4x4(metal::float4(1.2172115, 2.3474467, 6.6875763, 1.2265673), metal::float4(-0.84486043, -8.57313, -4.2065907, 0.25463516), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(1.2139328, 0.5683898, -8.752637, -2.3898895), metal::float4(-0.20198928, -0.1401188, 0.0076826406, -0.1317224), metal::float4(-0.15326285, 0.02953581, 0.005616545, -0.18556674), metal::float4(-74.320786, -63.76376, -0.40675116, 0.7189491)) * h0_0) + (metal::float4x4(metal::float4(-16.147669, -42.632393, -0.06485997, -0.7695405), metal::float4(-1.2008938, -1.9657207, -0.032466654, -0.61546624), metal::float4(-2.8951817, -0.36982724, -0.08826993, -0.04208433), metal::float4(-0.98575014, 0.2650366, 0.07488505, 0.25202516)) * h0_1)) + (metal::float4x4(metal::float4(6.882571, 3.3037403, -0.026097342, -0.8564453), metal::float4(2.0067384, 2.481892, -8.339849, -3.6626396), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-8.682326, 2.5371814, 1.7621095, 5.163456), metal::float4(-0.04183948, -0.037750814, -0.26279384, 0.121042185), metal::float4(0.14225043, 0.2631145, 0.027440522, -0.017610844), metal::float4(-0.8747293, 0.17003822, -1.4690326, -40.289505)) * h0_0) + (metal::float4x4(metal::float4(-2.7966685, -0.4179041, 0.9744584, -15.364956), metal::float4(-2.036611, 1.2122619, 3.4936776, -8.379077), metal::float4(-0.058713485, 6.524647, 3.5530078, -2.8674653), metal::float4(1.0533278, -9.348143, -6.0639396, 6.181865)) * h0_1)) + (metal::float4x4(metal::float4(-0.589845, -0.031207768, 1.9180096, 8.55072), metal::float4(-5.5204773, -12.310446, -1.1147383, 2.9653676), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(-4.5687118, 3.9562721, -1.7089586, 2.9960845), metal::float4(0.3399617, 0.0059691444, 0.021057142, -0.3196038), metal::float4(-0.071923144, -0.06025869, -0.031907883, 0.4514363), metal::float4(9.062922, 2.733657, 6.4316134, -15.971774)) * h0_0) + (metal::float4x4(metal::float4(-4.166488, 4.485879, 7.3074393, 2.037908), metal::float4(4.997433, -1.8625803, -0.15396278, -5.600335), metal::float4(-8.760638, -5.704339, 0.5472291, 4.4456587), metal::float4(-1.0656345, -2.1319022, -0.6854484, 3.65672)) * h0_1)) + (metal::float4x4(metal::float4(1.3734262, 0.061342563, 1.6200686, -1.0755827), metal::float4(-0.47460523, -1.7739332, -2.109841, -0.5640859), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.9449311, -5.905165, -8.407714, -6.7975154) + (metal::float4x4(metal::float4(-0.027982399, -1.5974598, -0.26108313, -0.44758323), metal::float4(-2.5582268, -11.182121, -14.092224, 0.48459366), metal::float4(-0.3511142, 0.19059174, -4.006024, -2.5721786), metal::float4(0.84639025, 0.71176577, -2.404681, -0.99055934)) * h1_0)) + (metal::float4x4(metal::float4(-0.57720464, -0.21008737, -2.6325812, 0.8914639), metal::float4(0.6590815, -4.3658676, -1.1448785, 0.9430832), metal::float4(0.9581404, 0.24328482, -1.1340039, 0.6141433), metal::float4(1.8922666, -1.7110677, 1.5307064, -0.12547962)) * h1_1)) + (metal::float4x4(metal::float4(1.1394193, 2.147547, -3.7314217, 1.0358683), metal::float4(0.29220706, 0.64925766, 0.027457166, 1.0072486), metal::float4(-0.2511268, -1.6159694, -0.30810866, -0.7661485), metal::float4(-0.61015004, -11.99502, -1.4946063, 0.6136324)) * h1_2)) + (metal::float4x4(metal::float4(0.48261017, 0.31079328, 3.0939977, 0.57151663), metal::float4(0.50222915, -2.8824496, 3.6301494, -0.72832125), metal::float4(1.2419188, 6.1217794, 0.9959902, -2.6530755), metal::float4(1.0656027, -0.80007607, 0.0050528687, 0.3594124)) * h1_3)) + (metal::float4x4(metal::float4(0.4766542, -0.6569586, 0.09155712, 0.20338818), metal::float4(0.061753884, -5.875319, 0.8493232, 1.9528707), metal::float4(-0.098926954, -0.076384485, 0.25303012, -0.44919094), metal::float4(-1.6619605, -1.0296458, -0.80755866, 1.041455)) * h1_4)) + (metal::float4x4(metal::float4(-0.28459114, -0.23509726, 2.6095576, 0.3711765), metal::float4(-0.19801985, 1.3067058, -1.8208132, -0.21006615), metal::float4(17.968971, 1.0652256, -3.5379207, -2.321049), metal::float4(5.994907, 7.3533573, 7.0550814, 3.9401383)) * h1_5)) + (metal::float4x4(metal::float4(0.5775448, -0.6548861, -1.2006896, 4.452374), metal::float4(1.9466195, 2.9656568, -9.168257, 3.7066925), metal::float4(0.010909571, -4.760984, -1.1203054, -0.30235562), metal::float4(-0.37076265, -0.46530518, -3.4178302, 0.21127713)) * h1_6)) + (metal::float4x4(metal::float4(1.3553408, 0.25208706, -0.32089064, 0.3037293), metal::float4(2.6422317, 0.23288439, 5.304172, -1.3016943), metal::float4(-2.056287, -5.8164153, 0.2749001, 0.9006329), metal::float4(1.7194343, -0.39653745, 0.64695686, -1.3309863)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(-11.532762, 1.2303761, -0.8146868, 1.1261033) + (metal::float4x4(metal::float4(-2.6109602, 0.57091993, -0.19495131, 0.2190746), metal::float4(-0.38188392, -8.280481, -0.21908845, -8.753874), metal::float4(0.16272675, 0.90584135, -0.7099145, 0.19912654), metal::float4(-1.0646359, 0.06383801, -0.65292776, -0.6046393)) * h1_0)) + (metal::float4x4(metal::float4(-4.3083715, 1.2327925, -0.35576007, -0.13176583), metal::float4(-1.8031285, 1.1302786, -0.87164867, 1.0115228), metal::float4(2.5004644, -0.8605538, -0.47234374, -0.01138025), metal::float4(-2.1511698, 1.2068214, -0.29616776, 2.0578663)) * h1_1)) + (metal::float4x4(metal::float4(-7.250049, -0.6875534, -0.26806444, 1.6461489), metal::float4(1.9680052, -0.7389492, -0.12802388, -1.5441029), metal::float4(0.33719414, -2.705163, -0.33733937, 0.30897093), metal::float4(0.3458763, -0.32137284, -0.20389776, -0.20329195)) * h1_2)) + (metal::float4x4(metal::float4(-4.9958253, 0.5969844, -0.0012780179, 0.25512967), metal::float4(1.0859861, 0.4249844, -0.32204592, -0.25992328), metal::float4(-1.1684371, -2.8410194, -1.0051937, 1.1974963), metal::float4(-15.443957, 1.2945144, -0.8225332, -0.3074546)) * h1_3)) + (metal::float4x4(metal::float4(2.9357085, 0.20545141, 0.19485117, 0.91170377), metal::float4(0.50134575, -2.171273, -0.5857367, -1.5256736), metal::float4(-2.9058325, 0.10822418, -0.13411592, 1.1221116), metal::float4(-1.9692392, 0.76492536, -0.39793473, -2.617637)) * h1_4)) + (metal::float4x4(metal::float4(-0.2213089, 0.18984394, -0.8296945, 2.0599499), metal::float4(-0.9738273, 0.39160827, -0.21650149, -1.6428514), metal::float4(-0.46032265, 0.99766743, -0.552936, -5.322368), metal::float4(-0.17638971, -7.9630685, 0.0143214, 8.131895)) * h1_5)) + (metal::float4x4(metal::float4(-4.054167, 0.057102606, -0.42363355, -0.16980857), metal::float4(-0.501281, -5.155497, -0.13397385, -18.643253), metal::float4(-0.4815355, -1.2359868, -0.7334735, -1.0535395), metal::float4(-1.0420411, -0.18130244, -0.5297515, -3.1283865)) * h1_6)) + (metal::float4x4(metal::float4(-0.9608823, -1.173892, -0.93231755, -1.0004952), metal::float4(-0.8453368, -1.7416643, -0.041984737, 0.45407665), metal::float4(-2.6328058, 0.03621532, -0.80184144, -0.12543038), metal::float4(-5.4342036, -0.17941746, -0.5029284, -0.67339176)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-1.4014693, -1.9073353, -2.223379, -0.7291616) + (metal::float4x4(metal::float4(-0.7316836, -0.2475589, -1.5897065, -0.2768745), metal::float4(0.8213411, 2.9054494, -8.956052, 1.0110811), metal::float4(0.48169297, 0.76748884, -1.2648801, -0.32161984), metal::float4(-2.0701137, -1.8383626, 1.4241215, -1.4391695)) * h1_0)) + (metal::float4x4(metal::float4(-1.8213843, -2.6883566, -2.023306, -0.44395453), metal::float4(0.2872357, -3.1867425, 0.3486228, -0.93589634), metal::float4(-0.20337726, -0.32137153, -0.99396664, -0.0847146), metal::float4(-1.0395169, 3.8884697, 3.523059, -0.92916214)) * h1_1)) + (metal::float4x4(metal::float4(-1.1685339, 1.5040996, 2.2066386, -0.74584043), metal::float4(-1.0791676, 0.7468052, 1.207109, -1.340223), metal::float4(1.173599, 1.1568028, 0.320179, -0.41836986), metal::float4(0.11363276, -0.17460881, 0.71926916, -0.3238061)) * h1_2)) + (metal::float4x4(metal::float4(1.8713467, -2.7534688, 0.39546612, -0.38263693), metal::float4(-1.0851198, -1.6376357, -0.113489404, -0.2849405), metal::float4(0.7609707, 3.4911816, 1.7288836, -0.6940429), metal::float4(0.84274054, -0.5509994, -0.8265054, -1.5711111)) * h1_3)) + (metal::float4x4(metal::float4(0.09381255, -0.4158294, 0.9894585, 0.2408242), metal::float4(-16.54033, -0.7249689, -0.55347764, -1.4864933), metal::float4(-0.31491104, 1.0514522, -1.4282348, -0.12754518), metal::float4(-11.089369, -0.42137167, -4.687089, -0.44227016)) * h1_4)) + (metal::float4x4(metal::float4(-0.139781, 0.16992623, -1.0356948, -0.7625751), metal::float4(-1.0477134, -0.7334245, -7.0605564, -0.49583894), metal::float4(-5.4379754, 1.6187942, 0.1498525, -0.5862648), metal::float4(-10.6316, 0.5565308, -2.2774708, -0.30862746)) * h1_5)) + (metal::float4x4(metal::float4(-0.95374274, -0.16887577, 1.0055864, -0.108160555), metal::float4(-0.89210844, 8.238755, -11.546918, 0.86600065), metal::float4(0.16547705, -6.461979, -0.7165446, -0.7399076), metal::float4(3.6122646, -0.33972144, -6.508603, 0.5218143)) * h1_6)) + (metal::float4x4(metal::float4(-0.19755183, -1.4309961, -0.23493266, -2.4542491), metal::float4(1.4060878, 3.7502568, -0.65528446, 0.19468662), metal::float4(-0.02978186, -1.2009946, 0.46360138, -2.19065), metal::float4(-0.43914932, 2.293388, -0.28565758, -0.76630586)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-8.380391, -0.18974769, 0.49893165, 0.3580487) + (metal::float4x4(metal::float4(0.6045855, -0.32436177, -0.5969974, 0.7781134), metal::float4(-2.0271108, -25.982105, 3.0252635, -1.8011206), metal::float4(0.0511712, -0.24000557, 0.6970283, -0.30310902), metal::float4(-0.626127, -1.0534695, -2.2961197, -0.13226692)) * h1_0)) + (metal::float4x4(metal::float4(2.343736, -6.217139, 0.6712475, -0.27228785), metal::float4(2.8466034, -0.7898569, -0.29988006, -0.15770356), metal::float4(1.2730513, -1.385769, 0.84351015, -0.8792476), metal::float4(1.739586, -2.8399658, -3.197824, -0.3127936)) * h1_1)) + (metal::float4x4(metal::float4(-0.084362775, -3.91136, -4.428161, 0.3635336), metal::float4(0.27836874, -0.14268269, -0.51529294, -0.538423), metal::float4(0.7830889, -0.0182398, -0.5262698, -1.0518626), metal::float4(0.9851691, 0.3181157, -0.28284815, 0.058373082)) * h1_2)) + (metal::float4x4(metal::float4(-3.414534, -0.5341867, -0.18411401, -0.61921275), metal::float4(-1.510084, -0.26633763, -1.3305926, -0.8619801), metal::float4(-1.5470308, -1.4743968, -38.504658, 0.30969214), metal::float4(-0.14469263, -0.49709392, -3.0121145, 0.079902336)) * h1_3)) + (metal::float4x4(metal::float4(-0.097979546, -0.25242627, 3.8054092, 0.5641174), metal::float4(0.65214485, 0.51018125, -0.44167098, -1.1165974), metal::float4(-0.46976346, 2.875159, -1.2651387, 0.7852967), metal::float4(2.0540571, -1.5942682, -3.18146, -11.497131)) * h1_4)) + (metal::float4x4(metal::float4(0.46952778, 0.87392676, 0.20043781, 0.1656688), metal::float4(-0.10401463, -3.3204172, -3.3489892, -1.9651427), metal::float4(-3.1124127, -6.1396356, 14.753386, 33.852314), metal::float4(1.0041435, 8.950814, -6.8097973, 9.132108)) * h1_5)) + (metal::float4x4(metal::float4(0.024301916, -0.34294394, 3.6597943, -2.9148378), metal::float4(3.058157, -15.93681, -4.1251917, -5.969938), metal::float4(-1.4033467, 0.22916655, 0.8508055, 0.32185614), metal::float4(-0.40119967, -2.2542157, -0.438894, -0.59386617)) * h1_6)) + (metal::float4x4(metal::float4(-0.7943322, -1.1189687, 0.35319355, 0.054232705), metal::float4(1.8380309, -0.83985823, 0.67006063, -0.7411227), metal::float4(0.63809717, 1.5535564, -0.34432167, -0.55257744), metal::float4(-0.64813596, -0.5104218, 1.0521047, 0.48838916)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.17358325, 0.13816246, 0.21617825, -0.103588134), h2_0)) + metal::dot(metal::float4(-0.26226506, 0.061416283, -0.053857677, -0.2043406), h2_1)) + metal::dot(metal::float4(0.09141985, 0.10511065, 0.17135085, -0.13144962), h2_2)) + metal::dot(metal::float4(0.12578346, 0.15885915, 0.08919641, -0.61215395), h2_3);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float3x4 f_1
) {
    float absorbance_2 = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_2 * _e10, 80.0)));
}

int nmt_core_log2(
    int bits
) {
    int m = bits & 8388607;
    int h = m >> 11u;
    int l = m & 2047;
    int t = as_type<int>(as_type<uint>(as_type<int>(as_type<uint>(h) * as_type<uint>(as_type<int>(as_type<uint>(4096) - as_type<uint>(h)))) >> 1u) + as_type<uint>(as_type<int>(as_type<uint>(l) * as_type<uint>(as_type<int>(as_type<uint>(2048) - as_type<uint>(h)))) >> 11u));
    return as_type<int>(as_type<uint>(bits) + as_type<uint>(as_type<int>(as_type<uint>(11) * as_type<uint>(t)) >> 5u));
}

uint naga_div(uint lhs, uint rhs) {
    return lhs / metal::select(rhs, 1u, rhs == 0u);
}

uint naga_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

NmtCodes nmt_core_codes(
    float v0,
    float v1
) {
    int first = as_type<int>(v0);
    int last = as_type<int>(v1);
    int _e4 = nmt_core_log2(first);
    int _e5 = nmt_core_log2(last);
    uint range_1 = static_cast<uint>(as_type<int>(as_type<uint>(_e5) - as_type<uint>(_e4)));
    uint shift = metal::max(32u - metal::clz(range_1), 17u) - 17u;
    uint multiplier = naga_div(2147483648u, (range_1 >> shift) + 1u);
    uint slope = metal::min(naga_f2u32(static_cast<float>(range_1 >> 8u) * NMT_KEY_SCALE), 38399u);
    return NmtCodes {first, last, _e4, shift, multiplier, slope};
}

float nmt_core_absorbance_of(
    float alpha
) {
    return -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

metal::uint2 nmt_core_steps(
    float v,
    float absorbance,
    NmtCodes codes
) {
    int _e7 = nmt_core_log2(metal::clamp(as_type<int>(v), codes.first_bits, codes.last_bits));
    uint w = static_cast<uint>(as_type<int>(as_type<uint>(_e7) - as_type<uint>(codes.first_log2))) >> codes.shift;
    uint a = as_type<uint>(metal::clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return metal::uint2((w * codes.multiplier) >> 15u, (a + 2048u) >> 12u);
}

float nmt_core_depth(
    metal::uint2 steps
) {
    return (static_cast<float>((2u * steps.x) + 1u) * 0.000015258789) - 1.0;
}

float nmt_core_absorbance(
    metal::uint2 steps_1
) {
    return as_type<float>(NMT_LINEAR_BITS + (steps_1.y << 12u)) - NMT_LINEAR;
}

metal::uint2 nmt_core_nearest_steps(
    uint code
) {
    return metal::uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & 65535u);
}

metal::uint2 nmt_core_farthest_steps(
    uint code_1
) {
    return metal::uint2(code_1 >> NMT_END_BITS, code_1 & 65535u);
}

uint nmt_core_end_code(
    float value
) {
    uint bits_1 = as_type<uint>(metal::max(value, -3.9999998));
    int rank = as_type<int>(as_type<uint>(static_cast<int>(bits_1 & 2147483647u)) - as_type<uint>(8388608));
    uint packed_code = static_cast<uint>(as_type<int>(as_type<uint>((bits_1 > 2147483647u) ? as_type<int>(as_type<uint>(-1) - as_type<uint>(rank)) : rank) + as_type<uint>(1073741824)));
    return ((packed_code >> 15u) << NMT_END_BITS) | (packed_code & ((1u << 15u) - 1u));
}

metal::uint2 nmt_core_ends(
    metal::float2 values
) {
    uint _e2 = nmt_core_end_code(values.x);
    uint _e4 = nmt_core_end_code(values.y);
    metal::uint2 _e5 = nmt_core_nearest_steps(_e2);
    metal::uint2 _e7 = nmt_core_farthest_steps(_e4);
    bool apart = _e5.x != _e7.x;
    return metal::uint2(_e2, apart ? _e4 : 0u);
}

metal::float2 nmt_core_bounds(
    float x,
    float m1,
    float m2,
    float m3,
    float m4
) {
    float mean = m1 * 0.9999;
    float second = (m2 * 0.9999) + 0.000033333334;
    float third = m3 * 0.9999;
    float square = mean * mean;
    float variance = metal::max(second - square, 0.0000001);
    float per_deviation = 1.0 / metal::sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = metal::clamp(((third - (mean * ((3.0 * second) - (2.0 * square)))) * per_variance) * per_deviation, -30.0, 30.0);
    float d = metal::clamp(((((((m4 * 0.9999) + 0.00002) - (mean * ((4.0 * third) - (mean * ((6.0 * second) - (3.0 * square)))))) * per_variance) * per_variance) - (skewness * skewness)) - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float q = ((y * (y - skewness)) - 1.0) / d;
    float at = 1.0 / ((1.0 + (y * y)) + ((q * q) * d));
    float rest = 1.0 - at;
    float linear = y - (q * skewness);
    float per_root = 1.0 / metal::sqrt(metal::max((linear * linear) - ((4.0 * q) * (1.0 - q)), 0.000000000001));
    float between = metal::clamp(((0.5 * rest) * (1.0 + (linear * per_root))) - (((at * y) * q) * per_root), 0.0, rest);
    float lower = (0.0 > q) ? between : ((y > (0.5 * skewness)) ? rest : 0.0);
    return metal::float2(lower, lower + at);
}

float nmt_core_weigh(
    float z,
    float absorbance_1,
    metal::float4 depths0,
    metal::float4 absorbances0,
    float n,
    float b0,
    metal::float4 moments
) {
    bool local = {};
    bool local_1 = {};
    bool local_2 = {};
    bool local_3 = {};
    bool local_4 = {};
    float front = 0.0 + ((z > depths0.x) ? absorbances0.x : 0.0);
    if (depths0.x == z) {
        local = absorbances0.x == absorbance_1;
    } else {
        local = false;
    }
    bool _e21 = local;
    float in_core = _e21 ? 1.0 : 0.0;
    float count = n - ((absorbances0.x > 0.0) ? 1.0 : 0.0);
    float rest0 = b0 - absorbances0.x;
    float rest1 = moments.x - (absorbances0.x * depths0.x);
    float rest2 = moments.y - ((absorbances0.x * depths0.x) * depths0.x);
    float rest3 = moments.z - (((absorbances0.x * depths0.x) * depths0.x) * depths0.x);
    float rest4 = moments.w - ((((absorbances0.x * depths0.x) * depths0.x) * depths0.x) * depths0.x);
    float front_2 = front + ((z > depths0.y) ? absorbances0.y : 0.0);
    if (depths0.y == z) {
        local_1 = absorbances0.y == absorbance_1;
    } else {
        local_1 = false;
    }
    bool _e79 = local_1;
    float in_core_2 = _e79 ? 1.0 : in_core;
    float count_2 = count - ((absorbances0.y > 0.0) ? 1.0 : 0.0);
    float rest0_2 = rest0 - absorbances0.y;
    float rest1_2 = rest1 - (absorbances0.y * depths0.y);
    float rest2_2 = rest2 - ((absorbances0.y * depths0.y) * depths0.y);
    float rest3_2 = rest3 - (((absorbances0.y * depths0.y) * depths0.y) * depths0.y);
    float rest4_2 = rest4 - ((((absorbances0.y * depths0.y) * depths0.y) * depths0.y) * depths0.y);
    float far = (absorbances0.y > 0.0) ? depths0.y : depths0.x;
    float center = 0.5 * (depths0.x + far);
    float half_range = metal::max(0.5 * (far - depths0.x), 0.000015258789);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_2 - (center * rest0_2)) * per_h;
    float moved2 = ((rest2_2 - (center * rest1_2)) - (center * (rest1_2 - (center * rest0_2)))) * (per_h * per_h);
    float moved3 = (((rest3_2 - (center * rest2_2)) - (center * (rest2_2 - (center * rest1_2)))) - (center * ((rest2_2 - (center * rest1_2)) - (center * (rest1_2 - (center * rest0_2)))))) * ((per_h * per_h) * per_h);
    float moved4 = ((((rest4_2 - (center * rest3_2)) - (center * (rest3_2 - (center * rest2_2)))) - (center * ((rest3_2 - (center * rest2_2)) - (center * (rest2_2 - (center * rest1_2)))))) - (center * (((rest3_2 - (center * rest2_2)) - (center * (rest2_2 - (center * rest1_2)))) - (center * ((rest2_2 - (center * rest1_2)) - (center * (rest1_2 - (center * rest0_2)))))))) * (((per_h * per_h) * per_h) * per_h);
    float x_1 = metal::clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_2 == 0.0) ? absorbance_1 : 0.0;
    float tail0 = rest0_2 - removed;
    float tail1 = moved1 - (removed * x_1);
    float tail2 = moved2 - ((removed * x_1) * x_1);
    float tail3 = moved3 - (((removed * x_1) * x_1) * x_1);
    float tail4 = moved4 - ((((removed * x_1) * x_1) * x_1) * x_1);
    float others = count_2 - ((removed > 0.0) ? 1.0 : 0.0);
    float absorbance_of_tail = metal::clamp(tail0, 0.0, 1000000000000000000000000000000.0);
    float per_b0 = 1.0 / metal::max(tail0, 0.000000000001);
    float m1_1 = metal::clamp(tail1 * per_b0, -1.0, 1.0);
    float m2_1 = metal::clamp(tail2 * per_b0, -1.0, 1.0);
    float m3_1 = metal::clamp(tail3 * per_b0, -1.0, 1.0);
    float m4_1 = metal::clamp(tail4 * per_b0, -1.0, 1.0);
    float own_step = per_h * 0.000030517578;
    float noise = ((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (per_h + (metal::abs(center) * per_h))) * 0.0000019073486;
    float exact = metal::clamp(((x_1 - m1_1) - (own_step * 0.25)) / ((own_step * 0.5) + noise), 0.0, 1.0);
    float variance_1 = metal::max(m2_1 - (m1_1 * m1_1), 0.000000001);
    float sum = metal::clamp(((m3_1 - ((3.0 * m1_1) * m2_1)) + (((2.0 * m1_1) * m1_1) * m1_1)) / variance_1, -2.0, 2.0);
    float root = metal::sqrt((sum * sum) + (4.0 * variance_1));
    float near = 0.5 * (sum - root);
    float far_2 = 0.5 * (sum + root);
    float of_near = metal::clamp(far_2 / root, 0.0, 1.0);
    float exact_2 = (others > 1.5) ? ((of_near * metal::clamp((((x_1 - m1_1) - near) - (own_step * 0.25)) / ((own_step * 0.5) + (noise + (noise / metal::max(metal::sqrt(variance_1), 0.0001)))), 0.0, 1.0)) + ((1.0 - of_near) * metal::clamp((((x_1 - m1_1) - far_2) - (own_step * 0.25)) / ((own_step * 0.5) + (noise + (noise / metal::max(metal::sqrt(variance_1), 0.0001)))), 0.0, 1.0))) : exact;
    float exact_3 = (z >= far) ? 1.0 : exact_2;
    if (!((others < 0.5))) {
        local_2 = z <= depths0.x;
    } else {
        local_2 = true;
    }
    bool _e359 = local_2;
    float exact_4 = _e359 ? 0.0 : exact_3;
    if (!((others < 2.5))) {
        local_3 = z >= far;
    } else {
        local_3 = true;
    }
    bool _e369 = local_3;
    if (!(_e369)) {
        local_4 = z <= depths0.x;
    } else {
        local_4 = true;
    }
    bool _e376 = local_4;
    if (_e376) {
        float known = metal::min(metal::exp(-((front_2 + (absorbance_of_tail * exact_4)))), 1.0);
        return known;
    }
    metal::float2 _e383 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    if (false) {
        float bounds_noise = ((((((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * 0.00000047683716) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) / (metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001) * metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001));
        float most = metal::min(metal::exp(-((front_2 + (absorbance_of_tail * metal::max(_e383.x - bounds_noise, 0.0))))), 1.0);
        float least = metal::min(metal::exp(-((front_2 + (absorbance_of_tail * metal::min(_e383.y + bounds_noise, 1.0))))), 1.0);
        if ((most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float _e552 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e383.x), metal::float4(_e383.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_2)) * _e552;
}

metal::float2 nmt_core_slot(
    uint code_2,
    metal::uint2 steps_2
) {
    float _e4 = nmt_core_depth(steps_2);
    float _e5 = nmt_core_absorbance(steps_2);
    return (code_2 > 0u) ? metal::float2(_e4, _e5) : metal::float2(0.0);
}

float nmt_core_transmittance(
    metal::uint2 steps_3,
    NmtCodes codes_1,
    metal::uint4 core0,
    float n_1,
    float b0_1,
    metal::float4 moments_1
) {
    metal::uint2 _e8 = nmt_core_nearest_steps(core0.x);
    metal::float2 _e9 = nmt_core_slot(core0.x, _e8);
    metal::uint2 _e12 = nmt_core_farthest_steps(core0.y);
    metal::float2 _e13 = nmt_core_slot(core0.y, _e12);
    float _e14 = nmt_core_depth(steps_3);
    float _e15 = nmt_core_absorbance(steps_3);
    float _e26 = nmt_core_weigh(_e14, _e15, metal::float4(_e9.x, _e13.x, 0.0, 0.0), metal::float4(_e9.y, _e13.y, 0.0, 0.0), n_1, b0_1, moments_1);
    return _e26;
}

float nmt_pass2(
    float v_1,
    float v0_1,
    float v1_1,
    float alpha_1,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    NmtCodes _e7 = nmt_core_codes(v0_1, v1_1);
    float _e8 = nmt_core_absorbance_of(alpha_1);
    metal::uint2 _e9 = nmt_core_steps(v_1, _e8, _e7);
    metal::uint2 _e11 = nmt_core_ends(range.xy);
    metal::uint4 core = metal::uint4(_e11, 0u, 0u);
    float _e22 = nmt_core_transmittance(_e9, _e7, core, sums1.y, sums0.x, metal::float4(sums0.y, sums0.z, sums0.w, sums1.x));
    return _e22;
}
metal::int2 naga_f2i32(metal::float2 value) {
    return static_cast<metal::int2>(metal::clamp(value, -2147483600.0, 2147483500.0));
}


struct pass2_Input {
    float v_2 [[user(loc0), center_perspective]];
    metal::float4 color [[user(loc1), center_perspective]];
};
struct pass2_Output {
    metal::float4 member [[color(0)]];
};
fragment pass2_Output pass2(
  pass2_Input varyings [[stage_in]]
, metal::float4 position [[position]]
, constant Frame& frame [[buffer(0)]]
, metal::texture2d<float, metal::access::sample> sums0_texture [[texture(0)]]
, metal::texture2d<float, metal::access::sample> sums1_texture [[texture(1)]]
, metal::texture2d<float, metal::access::sample> range_texture [[texture(2)]]
) {
    const Varying in = { position, varyings.v_2, {}, varyings.color };
    metal::int2 at_1 = naga_f2i32(in.position.xy);
    float _e7 = frame.v0;
    float _e10 = frame.v1;
    metal::float4 _e15 = sums0_texture.read(metal::uint2(at_1), 0);
    metal::float4 _e18 = sums1_texture.read(metal::uint2(at_1), 0);
    metal::float4 _e21 = range_texture.read(metal::uint2(at_1), 0);
    float _e22 = nmt_pass2(in.v, _e7, _e10, in.color.w, _e15, _e18, _e21);
    float weight = in.color.w * _e22;
    return pass2_Output { metal::float4(weight * in.color.xyz, weight) };
}
