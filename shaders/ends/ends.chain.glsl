// Both ends and tail: a pixel's nearest and its farthest fragment one by one, all others by their sums; blending keeps
// them. Written by nmt 0.1.0.
//
// Frame:  v0 and v1 are the least and the greatest view depth of what is transparent. Targets are cleared and blended as
//         NmtSums says.
// Pass 1, for every fragment of view depth v and opacity alpha: write nmt_pass1(v, v0, v1, alpha).
// Pass 2: T = nmt_pass2(v, v0, v1, alpha, ...) of the targets of pass 1 and the same bits as there. Add up alpha T C and
//         alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

#ifndef NMT_INCLUDED_ENDS_CHAIN
#define NMT_INCLUDED_ENDS_CHAIN

// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-0-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =
// least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1
// alone): Markov's bounds. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a11f08561d89, backend fused, seed 1, epochs 1500, dataset 381d5ef98678649c941c2c4c7bd79249c8745cf2398e785a10c209e31313e407.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.982e-3, worst 1.000.

#ifndef NMT_INCLUDED_ENDS
#define NMT_INCLUDED_ENDS

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
mat3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, vec4 tail) {
    return mat3x4(vec4(x, count, ln_b0, lower), vec4(upper, tail.xyz), vec4(tail.w, 0.0, 0.0, 0.0));
}

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(1.4317298, 2.191651, 6.727079, -3.751045), vec4(-0.060478445, 0.11461254, -0.1646913, -0.35877922), vec4(0.06289728, -0.1580284, 0.07473804, 0.13326874), vec4(7.0914807, 5.603903, 0.58649045, -2.2741826)),
    mat4(vec4(-3.4689405, -8.352193, -1.883482, 2.9752848), vec4(0.74735314, 6.36241, -5.499922, 0.58222175), vec4(-4.0372705, -7.862177, 1.2919396, -18.645775), vec4(-4.5778747, -9.596229, -0.32165408, 3.9021926)),
    mat4(vec4(9.54276, -0.0893324, 0.5160126, 2.5115654), vec4(-0.91783404, 0.8151581, 3.3516243, -0.12292782), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.1352023, 1.2119503, -2.8251603, -3.9147177), vec4(-0.123959064, -0.18036275, 0.016107535, 0.0041036624), vec4(0.15222655, 0.018420562, 0.0005397574, 0.069991186), vec4(-29.524288, -0.110847086, -8.73089, -7.214845)),
    mat4(vec4(-6.5716004, -0.14318708, -5.8059306, -5.389088), vec4(-1.6517118, 5.489244, -3.0327194, 9.124509), vec4(1.7978463, 0.8188869, -0.6640067, -12.607745), vec4(-0.5151307, -6.743748, 1.172957, -8.333976)),
    mat4(vec4(-19.125027, -1.8108281, 7.6768246, -0.95093083), vec4(1.8843677, 3.0185444, -3.3729057, 0.74029505), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(3.6519125, 1.5300299, -2.5522842, 1.2378398), vec4(-0.28464514, -0.121829726, -0.4616278, 0.32837835), vec4(0.039522942, -0.042005762, -0.05278465, 0.0013193002), vec4(-29.194708, 6.2694902, -10.627289, 2.0877857)),
    mat4(vec4(-15.559965, 0.87976754, 4.560895, 1.7619933), vec4(1.689421, 3.5073512, 2.3340404, 1.6568208), vec4(-4.8063483, -8.044831, -4.486502, 5.4426866), vec4(0.7073662, -3.271601, 2.5592906, -0.84171367)),
    mat4(vec4(-2.4559228, 8.6417265, -3.190338, -6.912059), vec4(5.0728116, -0.9842609, -0.053381015, -0.48948488), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.8468652, 0.49485567, -1.4169084, -3.5201824), vec4(-0.18228158, -0.07358338, -0.09071074, -0.112331256), vec4(0.14616138, 0.0965952, 0.080804884, 0.55146295), vec4(-62.268635, 2.377452, -246.12312, 12.9031925)),
    mat4(vec4(3.3802698, 2.0192537, -1.4338511, -6.659293), vec4(1.6852884, 5.941192, -0.8342008, 0.6035608), vec4(0.82760155, 4.488113, -2.2999249, 0.8024826), vec4(2.7274487, -5.7792253, -0.42838722, -0.6982501)),
    mat4(vec4(-1.4576274, -2.8315725, 0.17714114, -2.9663568), vec4(-2.2372859, -3.2930517, 1.4550539, -1.765235), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.057183642, 3.3389902, -3.542497, 5.0050306), vec4(-6.2289014, -0.45804322, -0.21599492, 0.4667237), vec4(1.8799043, 0.47896728, 0.021543205, -0.11040543), vec4(-47.834312, 12.908583, -50.006176, 12.68344)),
    mat4(vec4(-7.166474, -3.2794552, -7.324561, -11.086611), vec4(0.08703052, 3.6560774, -6.625171, -9.83278), vec4(-1.1809275, 4.1829724, -2.0076742, -2.3111808), vec4(-0.5327761, 6.0015187, 8.269169, 7.0828376)),
    mat4(vec4(1.2172115, 2.3474467, 6.6875763, 1.2265673), vec4(-0.84486043, -8.57313, -4.2065907, 0.25463516), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(1.2139328, 0.5683898, -8.752637, -2.3898895), vec4(-0.20198928, -0.1401188, 0.0076826406, -0.1317224), vec4(-0.15326285, 0.02953581, 0.005616545, -0.18556674), vec4(-74.320786, -63.76376, -0.40675116, 0.7189491)),
    mat4(vec4(-16.147669, -42.632393, -0.06485997, -0.7695405), vec4(-1.2008938, -1.9657207, -0.032466654, -0.61546624), vec4(-2.8951817, -0.36982724, -0.08826993, -0.04208433), vec4(-0.98575014, 0.2650366, 0.07488505, 0.25202516)),
    mat4(vec4(6.882571, 3.3037403, -0.026097342, -0.8564453), vec4(2.0067384, 2.481892, -8.339849, -3.6626396), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-8.682326, 2.5371814, 1.7621095, 5.163456), vec4(-0.04183948, -0.037750814, -0.26279384, 0.121042185), vec4(0.14225043, 0.2631145, 0.027440522, -0.017610844), vec4(-0.8747293, 0.17003822, -1.4690326, -40.289505)),
    mat4(vec4(-2.7966685, -0.4179041, 0.9744584, -15.364956), vec4(-2.036611, 1.2122619, 3.4936776, -8.379077), vec4(-0.058713485, 6.524647, 3.5530078, -2.8674653), vec4(1.0533278, -9.348143, -6.0639396, 6.181865)),
    mat4(vec4(-0.589845, -0.031207768, 1.9180096, 8.55072), vec4(-5.5204773, -12.310446, -1.1147383, 2.9653676), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-4.5687118, 3.9562721, -1.7089586, 2.9960845), vec4(0.3399617, 0.0059691444, 0.021057142, -0.3196038), vec4(-0.071923144, -0.06025869, -0.031907883, 0.4514363), vec4(9.062922, 2.733657, 6.4316134, -15.971774)),
    mat4(vec4(-4.166488, 4.485879, 7.3074393, 2.037908), vec4(4.997433, -1.8625803, -0.15396278, -5.600335), vec4(-8.760638, -5.704339, 0.5472291, 4.4456587), vec4(-1.0656345, -2.1319022, -0.6854484, 3.65672)),
    mat4(vec4(1.3734262, 0.061342563, 1.6200686, -1.0755827), vec4(-0.47460523, -1.7739332, -2.109841, -0.5640859), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(-0.027982399, -1.5974598, -0.26108313, -0.44758323), vec4(-2.5582268, -11.182121, -14.092224, 0.48459366), vec4(-0.3511142, 0.19059174, -4.006024, -2.5721786), vec4(0.84639025, 0.71176577, -2.404681, -0.99055934)),
    mat4(vec4(-0.57720464, -0.21008737, -2.6325812, 0.8914639), vec4(0.6590815, -4.3658676, -1.1448785, 0.9430832), vec4(0.9581404, 0.24328482, -1.1340039, 0.6141433), vec4(1.8922666, -1.7110677, 1.5307064, -0.12547962)),
    mat4(vec4(1.1394193, 2.147547, -3.7314217, 1.0358683), vec4(0.29220706, 0.64925766, 0.027457166, 1.0072486), vec4(-0.2511268, -1.6159694, -0.30810866, -0.7661485), vec4(-0.61015004, -11.99502, -1.4946063, 0.6136324)),
    mat4(vec4(0.48261017, 0.31079328, 3.0939977, 0.57151663), vec4(0.50222915, -2.8824496, 3.6301494, -0.72832125), vec4(1.2419188, 6.1217794, 0.9959902, -2.6530755), vec4(1.0656027, -0.80007607, 0.0050528687, 0.3594124)),
    mat4(vec4(0.4766542, -0.6569586, 0.09155712, 0.20338818), vec4(0.061753884, -5.875319, 0.8493232, 1.9528707), vec4(-0.098926954, -0.076384485, 0.25303012, -0.44919094), vec4(-1.6619605, -1.0296458, -0.80755866, 1.041455)),
    mat4(vec4(-0.28459114, -0.23509726, 2.6095576, 0.3711765), vec4(-0.19801985, 1.3067058, -1.8208132, -0.21006615), vec4(17.968971, 1.0652256, -3.5379207, -2.321049), vec4(5.994907, 7.3533573, 7.0550814, 3.9401383)),
    mat4(vec4(0.5775448, -0.6548861, -1.2006896, 4.452374), vec4(1.9466195, 2.9656568, -9.168257, 3.7066925), vec4(0.010909571, -4.760984, -1.1203054, -0.30235562), vec4(-0.37076265, -0.46530518, -3.4178302, 0.21127713)),
    mat4(vec4(1.3553408, 0.25208706, -0.32089064, 0.3037293), vec4(2.6422317, 0.23288439, 5.304172, -1.3016943), vec4(-2.056287, -5.8164153, 0.2749001, 0.9006329), vec4(1.7194343, -0.39653745, 0.64695686, -1.3309863)),
    mat4(vec4(-2.6109602, 0.57091993, -0.19495131, 0.2190746), vec4(-0.38188392, -8.280481, -0.21908845, -8.753874), vec4(0.16272675, 0.90584135, -0.7099145, 0.19912654), vec4(-1.0646359, 0.06383801, -0.65292776, -0.6046393)),
    mat4(vec4(-4.3083715, 1.2327925, -0.35576007, -0.13176583), vec4(-1.8031285, 1.1302786, -0.87164867, 1.0115228), vec4(2.5004644, -0.8605538, -0.47234374, -0.01138025), vec4(-2.1511698, 1.2068214, -0.29616776, 2.0578663)),
    mat4(vec4(-7.250049, -0.6875534, -0.26806444, 1.6461489), vec4(1.9680052, -0.7389492, -0.12802388, -1.5441029), vec4(0.33719414, -2.705163, -0.33733937, 0.30897093), vec4(0.3458763, -0.32137284, -0.20389776, -0.20329195)),
    mat4(vec4(-4.9958253, 0.5969844, -0.0012780179, 0.25512967), vec4(1.0859861, 0.4249844, -0.32204592, -0.25992328), vec4(-1.1684371, -2.8410194, -1.0051937, 1.1974963), vec4(-15.443957, 1.2945144, -0.8225332, -0.3074546)),
    mat4(vec4(2.9357085, 0.20545141, 0.19485117, 0.91170377), vec4(0.50134575, -2.171273, -0.5857367, -1.5256736), vec4(-2.9058325, 0.10822418, -0.13411592, 1.1221116), vec4(-1.9692392, 0.76492536, -0.39793473, -2.617637)),
    mat4(vec4(-0.2213089, 0.18984394, -0.8296945, 2.0599499), vec4(-0.9738273, 0.39160827, -0.21650149, -1.6428514), vec4(-0.46032265, 0.99766743, -0.552936, -5.322368), vec4(-0.17638971, -7.9630685, 0.0143214, 8.131895)),
    mat4(vec4(-4.054167, 0.057102606, -0.42363355, -0.16980857), vec4(-0.501281, -5.155497, -0.13397385, -18.643253), vec4(-0.4815355, -1.2359868, -0.7334735, -1.0535395), vec4(-1.0420411, -0.18130244, -0.5297515, -3.1283865)),
    mat4(vec4(-0.9608823, -1.173892, -0.93231755, -1.0004952), vec4(-0.8453368, -1.7416643, -0.041984737, 0.45407665), vec4(-2.6328058, 0.03621532, -0.80184144, -0.12543038), vec4(-5.4342036, -0.17941746, -0.5029284, -0.67339176)),
    mat4(vec4(-0.7316836, -0.2475589, -1.5897065, -0.2768745), vec4(0.8213411, 2.9054494, -8.956052, 1.0110811), vec4(0.48169297, 0.76748884, -1.2648801, -0.32161984), vec4(-2.0701137, -1.8383626, 1.4241215, -1.4391695)),
    mat4(vec4(-1.8213843, -2.6883566, -2.023306, -0.44395453), vec4(0.2872357, -3.1867425, 0.3486228, -0.93589634), vec4(-0.20337726, -0.32137153, -0.99396664, -0.0847146), vec4(-1.0395169, 3.8884697, 3.523059, -0.92916214)),
    mat4(vec4(-1.1685339, 1.5040996, 2.2066386, -0.74584043), vec4(-1.0791676, 0.7468052, 1.207109, -1.340223), vec4(1.173599, 1.1568028, 0.320179, -0.41836986), vec4(0.11363276, -0.17460881, 0.71926916, -0.3238061)),
    mat4(vec4(1.8713467, -2.7534688, 0.39546612, -0.38263693), vec4(-1.0851198, -1.6376357, -0.113489404, -0.2849405), vec4(0.7609707, 3.4911816, 1.7288836, -0.6940429), vec4(0.84274054, -0.5509994, -0.8265054, -1.5711111)),
    mat4(vec4(0.09381255, -0.4158294, 0.9894585, 0.2408242), vec4(-16.54033, -0.7249689, -0.55347764, -1.4864933), vec4(-0.31491104, 1.0514522, -1.4282348, -0.12754518), vec4(-11.089369, -0.42137167, -4.687089, -0.44227016)),
    mat4(vec4(-0.139781, 0.16992623, -1.0356948, -0.7625751), vec4(-1.0477134, -0.7334245, -7.0605564, -0.49583894), vec4(-5.4379754, 1.6187942, 0.1498525, -0.5862648), vec4(-10.6316, 0.5565308, -2.2774708, -0.30862746)),
    mat4(vec4(-0.95374274, -0.16887577, 1.0055864, -0.108160555), vec4(-0.89210844, 8.238755, -11.546918, 0.86600065), vec4(0.16547705, -6.461979, -0.7165446, -0.7399076), vec4(3.6122646, -0.33972144, -6.508603, 0.5218143)),
    mat4(vec4(-0.19755183, -1.4309961, -0.23493266, -2.4542491), vec4(1.4060878, 3.7502568, -0.65528446, 0.19468662), vec4(-0.02978186, -1.2009946, 0.46360138, -2.19065), vec4(-0.43914932, 2.293388, -0.28565758, -0.76630586)),
    mat4(vec4(0.6045855, -0.32436177, -0.5969974, 0.7781134), vec4(-2.0271108, -25.982105, 3.0252635, -1.8011206), vec4(0.0511712, -0.24000557, 0.6970283, -0.30310902), vec4(-0.626127, -1.0534695, -2.2961197, -0.13226692)),
    mat4(vec4(2.343736, -6.217139, 0.6712475, -0.27228785), vec4(2.8466034, -0.7898569, -0.29988006, -0.15770356), vec4(1.2730513, -1.385769, 0.84351015, -0.8792476), vec4(1.739586, -2.8399658, -3.197824, -0.3127936)),
    mat4(vec4(-0.084362775, -3.91136, -4.428161, 0.3635336), vec4(0.27836874, -0.14268269, -0.51529294, -0.538423), vec4(0.7830889, -0.0182398, -0.5262698, -1.0518626), vec4(0.9851691, 0.3181157, -0.28284815, 0.058373082)),
    mat4(vec4(-3.414534, -0.5341867, -0.18411401, -0.61921275), vec4(-1.510084, -0.26633763, -1.3305926, -0.8619801), vec4(-1.5470308, -1.4743968, -38.504658, 0.30969214), vec4(-0.14469263, -0.49709392, -3.0121145, 0.079902336)),
    mat4(vec4(-0.097979546, -0.25242627, 3.8054092, 0.5641174), vec4(0.65214485, 0.51018125, -0.44167098, -1.1165974), vec4(-0.46976346, 2.875159, -1.2651387, 0.7852967), vec4(2.0540571, -1.5942682, -3.18146, -11.497131)),
    mat4(vec4(0.46952778, 0.87392676, 0.20043781, 0.1656688), vec4(-0.10401463, -3.3204172, -3.3489892, -1.9651427), vec4(-3.1124127, -6.1396356, 14.753386, 33.852314), vec4(1.0041435, 8.950814, -6.8097973, 9.132108)),
    mat4(vec4(0.024301916, -0.34294394, 3.6597943, -2.9148378), vec4(3.058157, -15.93681, -4.1251917, -5.969938), vec4(-1.4033467, 0.22916655, 0.8508055, 0.32185614), vec4(-0.40119967, -2.2542157, -0.438894, -0.59386617)),
    mat4(vec4(-0.7943322, -1.1189687, 0.35319355, 0.054232705), vec4(1.8380309, -0.83985823, 0.67006063, -0.7411227), vec4(0.63809717, 1.5535564, -0.34432167, -0.55257744), vec4(-0.64813596, -0.5104218, 1.0521047, 0.48838916))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(1.9449311, -5.905165, -8.407714, -6.7975154),
    vec4(-11.532762, 1.2303761, -0.8146868, 1.1261033),
    vec4(-1.4014693, -1.9073353, -2.223379, -0.7291616),
    vec4(-8.380391, -0.18974769, 0.49893165, 0.3580487)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.17358325, 0.13816246, 0.21617825, -0.103588134),
    vec4(-0.26226506, 0.061416283, -0.053857677, -0.2043406),
    vec4(0.09141985, 0.10511065, 0.17135085, -0.13144962),
    vec4(0.12578346, 0.15885915, 0.08919641, -0.61215395)
);
const float NMT_B3 = -1.4909608;

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

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(mat3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0)) - 0.05, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
const uint NMT_OCTAVE_BITS = 11u;
const uint NMT_HEAVY = 0u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const uint NMT_SLOTS = 2u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const float NMT_KEY_SCALE = 0.625;
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
    // Its length in bits, from the exponent of a float that is not rounded up to the next power of two.
    uint exponent = floatBitsToUint(float(range & ~(range >> 1))) >> 23;
    uint shift = max(exponent, 127u + NMT_DEPTH_BITS) - (127u + NMT_DEPTH_BITS);
    uint multiplier = 0x80000000u / ((range >> shift) + 1u);
    uint room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    NmtCodes codes;
    codes.first_bits = first;
    codes.last_bits = last;
    codes.first_log2 = first_log2;
    codes.shift = shift;
    codes.multiplier = multiplier;
    codes.slope = min(uint(float(range >> 8u) * NMT_KEY_SCALE), room);
    return codes;
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

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
vec4 nmt_core_moments(uvec2 steps) {
    float z = nmt_core_depth(steps);
    float first = nmt_core_absorbance(steps) * z;
    float second = first * z;
    float third = second * z;
    return vec4(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
uint nmt_core_nearest_code(uvec2 steps) {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_farthest_code(uvec2 steps) {
    return (steps.x << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_heavy_code(uvec2 steps, NmtCodes codes) {
    uint nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

uvec2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uvec2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}


// Both ends of a pixel stand in two channels of a render target, of which blending keeps the greater: the codes of
// their slots as numbers that rise as codes do, none of them subnormal, infinite or NaN.
float nmt_core_end_value(uint code) {
    // Steps of absorbance leave a bit unused, which is left out.
    uint low = NMT_END_BITS - 1u;
    int rank = int(((code >> NMT_END_BITS) << low) | (code & ((1u << low) - 1u))) - 0x40000000;
    return uintBitsToFloat(rank >= 0 ? 0x00800000u + uint(rank) : 0x80800000u + uint(-1 - rank));
}

// The code of such a number; 0, the empty slot, of what the target is cleared to.
uint nmt_core_end_code(float value) {
    uint low = NMT_END_BITS - 1u;
    uint bits = floatBitsToUint(max(value, -3.9999998));
    int rank = int(bits & 0x7fffffffu) - 0x00800000;
    uint packed_code = uint((bits > 0x7fffffffu ? -1 - rank : rank) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// What a fragment writes there, by its steps; the nearest comes first. One that absorbs nothing is no end.
vec2 nmt_core_end_values(uvec2 steps) {
    bool absorbs = steps.y > 0u;
    return vec2(
        nmt_core_end_value(absorbs ? nmt_core_nearest_code(steps) : 0u),
        nmt_core_end_value(absorbs ? nmt_core_farthest_code(steps) : 0u)
    );
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
uvec2 nmt_core_ends(vec2 values) {
    uint nearest = nmt_core_end_code(values.x);
    uint farthest = nmt_core_end_code(values.y);
    bool apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return uvec2(nearest, apart ? farthest : 0u);
}

// Where the moments of the tail leave T open by no more than this, it is the middle of what they allow, and the network
// is not asked. 0 always asks it; 1/256 cannot be seen.
const float NMT_OPEN = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments: Markov's bounds.
vec2 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
    float mean = m1 * 0.9999;
    float second = m2 * 0.9999 + 3.3333334e-5;
    float third = m3 * 0.9999;
    float square = mean * mean;
    float variance = max(second - square, 1e-7);
    float per_deviation = 1.0 / sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    float d = clamp((m4 * 0.9999 + 2e-5 - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square)))
        * per_variance * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float q = (y * (y - skewness) - 1.0) / d;
    float at = 1.0 / (1.0 + y * y + q * q * d);
    float rest = 1.0 - at;
    float linear_ = y - q * skewness;
    float per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    float between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    float lower = (q < 0.0 ? between : (y > 0.5 * skewness ? rest : 0.0));
    return vec2(lower, lower + at);
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
float nmt_core_weigh(float z, float absorbance, vec4 depths0, vec4 absorbances0, float n, float b0, vec4 moments) {
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
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_2 - center * rest0_2) * per_h;
    float moved2 = (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)) * (per_h * per_h);
    float moved3 = (rest3_2 - center * rest2_2 - center * (rest2_2 - center * rest1_2) - center * (rest2_2 - center
        * rest1_2 - center * (rest1_2 - center * rest0_2))) * (per_h * per_h * per_h);
    float moved4 = (rest4_2 - center * rest3_2 - center * (rest3_2 - center * rest2_2) - center * (rest3_2 - center
        * rest2_2 - center * (rest2_2 - center * rest1_2)) - center * (rest3_2 - center * rest2_2 - center * (rest2_2
        - center * rest1_2) - center * (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_2 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_2 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_2 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_2 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    vec2 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * ((1.0 + abs(center)) * per_h + 1.0)
            * 4.7683716e-7 * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) / (max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
            * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7) * max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
            * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7));
        float most = min(exp(-(front_2 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_2 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    return exp(-front_2) * nmt_transmittance(mat3x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
        + 0.05), bounds.x), vec4(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
        * mean, 1e-6), 0.0, 1.0), mean_2), vec4(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2)
        / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
vec2 nmt_core_slot(uint code, uvec2 steps) {
    return code > 0u ? vec2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : vec2(0.0, 0.0);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
float nmt_core_transmittance(
    uvec2 steps,
    NmtCodes codes,
    uvec4 core0,
    float n,
    float b0,
    vec4 moments
) {
    vec2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    vec2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4(slot0.x, slot1.x, 0.0, 0.0),
        vec4(slot0.y, slot1.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    vec4 sums0;
    // (b4, number of fragments that absorb, 0, 0): blended by addition, cleared to 0.
    vec4 sums1;
    // (nearest, farthest, 0, 0) as nmt_core_end_values has them: blended by max, cleared to -3e38. Two channels, f32
    // always.
    vec4 range;
};

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
NmtSums nmt_pass1(float v, float v0, float v1, float alpha) {
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), nmt_core_codes(v0, v1));
    float absorbance = nmt_core_absorbance(steps);
    vec4 b = nmt_core_moments(steps);
    float n = steps.y > 0u ? 1.0 : 0.0;
    NmtSums sums;
    sums.sums0 = vec4(absorbance, b.x, b.y, b.z);
    sums.sums1 = vec4(b.w, n, 0.0, 0.0);
    sums.range = vec4(nmt_core_end_values(steps), 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, vec4 sums0, vec4 sums1, vec4 range) {
    NmtCodes codes = nmt_core_codes(v0, v1);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    uvec4 core = uvec4(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, sums1.y, sums0.x, vec4(sums0.y, sums0.z, sums0.w, sums1.x));
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
vec4 nmt_resolve(vec4 weighted, vec4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return vec4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

#endif
