#version 310 es
// OpenGL ES 3.1, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
precision highp float;
precision highp int;
precision highp sampler2D;

// Neural moment transparency: network 'core-large', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit c1ed93bd63ea, backend fused, seed 2, epochs 1500, dataset cfac8078bedf5effa916da488b9581e4e76632aac69746931a2aa032cd1a0a6b.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.016e-3, worst 1.000.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(-4.0255322, 5.696204, 1.6943908, 4.625778), vec4(-0.123158716, -0.022845494, 1.3684101, -0.22309694), vec4(-0.055782713, -0.02729638, -0.7351799, 0.12446838), vec4(-22.08425, -21.542097, -12.540206, 7.9311724)),
    mat4(vec4(4.003113, -12.202889, -6.03625, -9.53933), vec4(5.079678, 0.96678704, -2.5490577, -3.7921448), vec4(-5.563451, -3.4979208, 2.9750206, -5.7120223), vec4(-1.8828032, -0.6641459, 2.2350688, -2.790497)),
    mat4(vec4(-47.499374, 0.7882673, -0.7554687, -0.40223193), vec4(2.2457452, 4.4966774, 2.7239416, 4.8531356), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-6.509258, -3.6678035, 2.3813612, 0.8936451), vec4(-0.0070089055, -0.38917178, 0.056811646, -0.03466737), vec4(0.0034584545, -0.08949225, -0.041342236, -0.03309034), vec4(0.002414985, 35.769714, 17.576942, 25.224512)),
    mat4(vec4(-0.020485638, -38.85436, -0.86674184, -23.896433), vec4(-0.01604367, 4.0836473, 0.33259383, 1.0908167), vec4(0.03454655, -18.111965, -3.71319, -4.6560225), vec4(0.011393566, -0.30890125, -1.3219124, -2.8662512)),
    mat4(vec4(0.0041463277, 1.9609691, 10.727305, 4.8774633), vec4(-6.485228, 1.0027441, -1.0354357, 2.0669503), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(1.0427063, 1.4444615, 0.22712201, -2.9948504), vec4(0.066054374, 0.31861958, 0.026391018, -0.27554062), vec4(-0.12969105, -0.015988281, 0.07662249, -0.0039148843), vec4(-2.64852, -0.30498013, -4.04413, 0.3279041)),
    mat4(vec4(-2.7326443, 2.5969625, -4.288648, 6.164401), vec4(-8.941283, 4.4852185, -1.8909162, 0.41518652), vec4(-8.713514, 8.992529, -1.2659963, -2.206071), vec4(5.6512294, -3.470394, -1.0694718, 4.1851635)),
    mat4(vec4(-1.1414442, -0.5981651, 9.139677, -8.4315195), vec4(3.3552182, -3.8380163, -2.0059235, 1.4037566), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.50419164, 3.3264024, 0.3408373, 0.15794963), vec4(0.15867789, -0.12802078, -0.0507785, 0.11978142), vec4(-0.100550495, 0.022845238, 0.04496174, 0.034926943), vec4(16.608372, 0.0759729, -1.9273227, -10.205227)),
    mat4(vec4(-12.711161, 2.190889, -1.5415816, 0.8842952), vec4(-1.7452958, -1.3973209, -7.6971993, 4.01076), vec4(-10.807886, -1.2840962, -3.3269665, 5.866802), vec4(0.44886237, 4.806983, 9.19736, -5.7426167)),
    mat4(vec4(7.395807, 1.3404678, 2.9149747, -8.111294), vec4(0.22378251, 1.1213043, 0.44062462, 1.4559642), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-6.7969713, -0.502306, 6.0482206, -1.571385), vec4(0.15505987, -0.112316325, -0.4587652, -0.04966048), vec4(0.013082438, -0.018316714, 0.44126177, -0.00346313), vec4(1.7010074, 19.925846, -26.00454, -0.16778176)),
    mat4(vec4(-1.2125382, -18.547857, 3.1266713, 0.29102612), vec4(-1.0211937, -0.9701661, -0.14331418, 7.204432), vec4(1.9405318, -0.29332843, -1.8971208, -5.4432473), vec4(0.5886473, 0.15590455, -3.7831268, -8.984916)),
    mat4(vec4(-1.5789444, 1.2986006, 2.2151904, 0.062172584), vec4(-6.4984884, 2.0684013, 1.5952907, 1.0277586), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.393126, 2.3674746, 0.82819694, 3.3245544), vec4(-0.12058834, -0.0047716806, -0.5326883, -0.6793858), vec4(0.025013916, 0.010085596, 1.4445151, 0.11267296), vec4(3.8268487, 32.934467, -0.16003872, 3.8154705)),
    mat4(vec4(-7.692379, -20.772335, 0.35992932, -9.875593), vec4(1.4604832, -6.4257917, -2.883336, -2.820427), vec4(-4.661669, -1.7963374, 2.6235654, 4.8746185), vec4(-0.022091508, 4.993737, 0.3696627, -2.0515103)),
    mat4(vec4(-1.0262295, 7.732843, -0.19911182, 4.143213), vec4(1.0726902, 0.3799708, -3.7199762, 2.1817524), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-4.187771, 5.7622466, 3.464974, 3.5274491), vec4(0.123458035, -0.15130657, -0.21285085, -0.6091351), vec4(0.113453746, 0.058647636, -0.12338351, 0.3324342), vec4(-8.736808, 3.7716558, -0.9494796, -103.00982)),
    mat4(vec4(2.0454342, 0.2812312, -0.055282958, -4.450533), vec4(-3.6171782, -0.49419218, 5.6497235, -1.925063), vec4(0.7400166, 1.2106199, -3.009102, 0.2615118), vec4(7.4685283, -1.4964488, -11.21016, 1.9037799)),
    mat4(vec4(2.3226392, -0.80109143, 5.0596423, 1.3209901), vec4(-6.4159875, 4.7279124, -1.2052386, 3.2027826), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.67451, -0.25473332, -4.7082705, -6.950072), vec4(-0.22337003, 0.013849621, -0.5821967, 0.023658099), vec4(0.18122683, -0.050395988, -0.25371712, -0.008888219), vec4(6.502307, -1.9178911, -0.39032215, -0.7561635)),
    mat4(vec4(-3.0350447, 9.534253, -0.75022167, -0.3300544), vec4(3.5901492, 3.03143, 0.117477216, 0.01888314), vec4(-4.6517525, 2.9598794, -0.58163494, -0.36835226), vec4(-2.483894, -2.092986, -0.02274922, 0.06036394)),
    mat4(vec4(3.4605544, -1.1416317, -0.49811774, 1.056725), vec4(-0.9243449, -1.1349953, -5.6314116, -6.5328717), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(-0.9533716, -0.023912556, -0.9153294, -0.6364172), vec4(-1.3491272, -0.021342112, 1.0095835, 0.28646916), vec4(0.16594304, -0.27667075, -0.51430374, -2.0443883), vec4(1.112755, 0.0915239, -1.0105754, 0.24547203)),
    mat4(vec4(-15.338107, -0.18109065, 36.85456, -16.543253), vec4(-1.0150462, 0.056353666, 0.016026035, 2.2635589), vec4(1.6816186, -0.05943171, 0.8579211, -1.0591912), vec4(0.043707225, -0.09092495, 0.15902202, 3.3374038)),
    mat4(vec4(0.039660048, -0.3292222, -0.5847584, -2.5101895), vec4(-1.311235, -0.40319374, 1.7404836, 0.9153837), vec4(2.1340253, -0.32362092, -0.17209554, 1.191257), vec4(0.6353717, -0.21473892, 1.5834737, 2.851836)),
    mat4(vec4(1.2562435, 0.07121042, -0.0665915, -1.2945167), vec4(-0.7341449, -0.3799136, -0.010191748, -16.294928), vec4(0.85872763, 0.20701307, -1.0996699, -24.260374), vec4(3.177199, -0.38679487, 0.11351008, -1.6164944)),
    mat4(vec4(-6.4650416, -0.41673565, 0.55340284, -13.12142), vec4(0.7579364, -0.18683712, 0.20788263, -1.0848093), vec4(3.2402115, -0.04443337, -0.033630773, 0.19914113), vec4(-1.1899779, -0.13963297, 1.885436, 3.854255)),
    mat4(vec4(0.5404526, 0.09659141, 1.6735438, -1.3909712), vec4(-2.067266, -0.39151478, -0.18703642, 0.6079234), vec4(1.2486103, -0.07376202, 1.1963037, -0.5950847), vec4(-4.0807877, -0.1041501, 0.2707971, 0.10968553)),
    mat4(vec4(-0.78077024, -0.17305139, 1.9303315, -12.010455), vec4(-0.9506922, -0.20199437, -0.06307983, 2.4605262), vec4(-0.43516338, -0.100928746, -2.1531272, -3.1601245), vec4(-0.23850946, 0.059164405, 0.1695899, -3.4487617)),
    mat4(vec4(-1.3490047, -0.4209982, 0.22618073, -3.3278596), vec4(-1.875717, -0.4981746, -0.78577715, -4.9637), vec4(44.00582, -0.31377533, 25.27289, -18.628054), vec4(-3.6807067, -0.12270356, 1.5959344, -0.8601947)),
    mat4(vec4(-0.1453553, 0.07063915, 1.8956821, 1.9108816), vec4(0.3346319, -0.076211855, 0.34616187, 0.5547185), vec4(-0.011447386, -0.41964942, -0.28713802, -0.2837125), vec4(0.7431988, 0.090956256, -0.9054148, 0.72439426)),
    mat4(vec4(39.286304, -0.31516922, 40.76921, 16.395794), vec4(-0.42318517, -0.5491356, -2.1107347, -14.392391), vec4(-1.0712371, -0.25630018, -0.26045516, -4.6359696), vec4(-0.6129423, -0.99003834, 1.545693, -0.76912624)),
    mat4(vec4(-1.0058358, -0.32852674, 0.4163718, -1.056459), vec4(-0.84956074, -0.565298, -0.83973414, -1.2990212), vec4(1.4913182, -0.16343024, -2.343077, 0.6615414), vec4(-0.6030688, -0.30026984, -0.18957068, -2.59755)),
    mat4(vec4(2.6016612, -0.2845663, 1.6151973, 0.6618105), vec4(-0.0525817, -0.33184847, -0.28768083, 0.91238344), vec4(-0.119816735, -0.25671324, 0.9706344, -0.6891455), vec4(0.56451523, 0.17033842, -0.47975639, -1.8264201)),
    mat4(vec4(2.9959838, -0.652482, 1.8844278, 0.9622594), vec4(0.070143305, -0.6639423, 0.40328276, -0.64634347), vec4(-0.60777456, -0.5887462, 0.7209019, -0.69019026), vec4(0.5434486, -0.5052658, 0.33621076, 2.5048401)),
    mat4(vec4(-0.26733327, -0.4642397, -0.9772016, -0.870254), vec4(-3.6335413, -0.3555749, -1.045125, -4.07717), vec4(-0.8452041, -0.3185469, -0.37459856, -0.110035), vec4(0.55276686, -0.4794151, -0.3470924, -2.098274)),
    mat4(vec4(-0.6638723, -0.29884577, -0.35764614, -2.100383), vec4(0.30588472, -0.8333303, -0.17897666, -1.1643548), vec4(-2.3153057, -0.55565417, -0.32713842, -3.6840034), vec4(0.7842276, -0.38678697, 0.6786007, 1.412775)),
    mat4(vec4(0.42784715, -0.8615997, 0.2460582, -0.10386703), vec4(-0.13341987, -0.7622468, -1.076524, 1.2882116), vec4(26.760437, 0.043523494, 41.775837, 6.34395), vec4(2.348743, -0.58241946, 12.563165, 1.9395633)),
    mat4(vec4(-1.0057069, -15.484056, -0.8306804, 4.1161814), vec4(0.16261958, -11.575914, 0.7167826, -0.7424119), vec4(-0.18335058, -0.9846208, -1.2416226, 0.44570327), vec4(-1.1767898, 4.0964417, 0.13868305, -1.2914313)),
    mat4(vec4(-70.23616, -75.0458, -59.01664, 12.429902), vec4(-2.5156229, -1.0310744, -1.2728319, 0.34910786), vec4(2.1732159, 0.15101202, 0.85288423, 2.1510382), vec4(2.449578, -6.0832376, -2.8002646, 1.9478861)),
    mat4(vec4(-0.29509312, -3.8282657, -0.67162865, 1.6842072), vec4(-0.9205352, 0.11075853, 1.3054434, 0.5321204), vec4(-0.22425814, -0.15107968, -1.575949, 0.22575685), vec4(0.37909648, -0.250605, 0.9879276, -7.929242)),
    mat4(vec4(-0.47060302, 2.9747362, -10.990186, 0.4114294), vec4(-1.6254674, 0.7859203, 0.46615675, -3.7527027), vec4(-0.286325, 0.617553, 0.0033092718, 4.303752), vec4(2.7186172, 0.44322705, -1.863603, 1.624693)),
    mat4(vec4(-2.4725301, -1.5300545, -0.9504451, 3.1540065), vec4(0.053648796, -1.0160289, -1.0822248, 3.1805134), vec4(0.4030251, -0.2734259, 0.38411066, 0.38576034), vec4(-0.2328709, 1.4899489, 1.5601239, -1.69999)),
    mat4(vec4(-0.49676415, 1.1180121, -0.43828925, -1.4976035), vec4(-1.5912924, -9.547819, -0.78240997, -7.8603153), vec4(-0.3214312, 0.087684, -0.04540323, -0.5647855), vec4(0.46469375, 1.1731452, -0.63446325, 0.25039765)),
    mat4(vec4(2.304289, 1.1074053, 1.7841369, -1.1050184), vec4(0.41535342, -0.790432, -1.2212279, 2.138696), vec4(-1.4066341, -3.970257, -0.077826135, -4.155295), vec4(0.93355304, -1.0763787, -0.11814381, 2.1212103)),
    mat4(vec4(-1.1244867, -0.4228181, 1.161553, -1.3148576), vec4(0.056548953, 0.39536077, -0.5357919, -3.4298966), vec4(-62.053368, -59.341625, -40.85116, 5.0153856), vec4(-3.138093, 1.2564723, -2.4892633, -6.9960933)),
    mat4(vec4(-1.3116454, -2.4449224, 0.6285333, 0.33160317), vec4(0.89022815, 1.6486273, 0.56321317, 0.21195675), vec4(-0.19395639, -1.2140524, -0.94985414, 0.061687086), vec4(1.2984312, -1.0810565, -1.3238264, 0.26209682)),
    mat4(vec4(-19.707382, -58.439476, -34.231743, 51.697456), vec4(-0.8955569, -0.5577856, -1.7309264, 1.9096798), vec4(0.2397159, 0.29411244, -0.55452573, -1.7539995), vec4(-0.47557485, 3.0380623, -3.7277555, -0.18603717)),
    mat4(vec4(-0.26022965, 0.12189879, -1.4006208, -0.055232037), vec4(2.2262263, -0.44580844, -0.26314613, -1.8803545), vec4(-0.26910368, -1.6509178, 5.3864126, 0.032558464), vec4(2.2175922, -1.0064648, -0.20202447, -1.7486198)),
    mat4(vec4(-0.363278, 4.63216, 1.9288766, -2.4225435), vec4(-0.50264215, -2.6026533, 0.5468965, -0.6739758), vec4(0.120355025, 1.240956, -3.8503177, 0.007677607), vec4(-1.3201234, 0.4576058, -0.94173425, -2.2499797)),
    mat4(vec4(-2.5061276, -0.49517626, -2.9986513, 3.318081), vec4(-1.2816699, 0.23562266, -1.484695, 0.91130346), vec4(-0.8777639, 0.88774824, -0.4923823, 0.106555), vec4(1.272445, -1.5231833, 3.9530544, 0.9388586)),
    mat4(vec4(1.3245022, -0.4820548, 1.6983755, 0.028543063), vec4(1.3538333, -6.846795, 0.8200843, -4.4577127), vec4(-0.015166995, 0.16394323, -0.07165488, -0.2219812), vec4(0.97834635, 1.1480302, -1.5143827, 0.32333264)),
    mat4(vec4(-0.37034887, 1.3580012, 0.116402686, -3.630028), vec4(0.25529686, 0.66414505, 2.4161358, 1.323056), vec4(-2.662821, -4.2417464, -2.479341, -20.309309), vec4(-0.06483494, -1.9271599, 0.23421793, 0.18673025)),
    mat4(vec4(-0.78342414, 1.2142608, -1.4254683, 0.36460462), vec4(1.2078199, -0.90951747, -0.011000494, 0.7334401), vec4(-21.266111, -49.016678, 6.222171, 45.55174), vec4(0.2647363, -0.14191146, 2.8238018, 0.15251571))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(1.3959447, -0.14219934, 2.8130505, -6.171281),
    vec4(3.1731634, -0.4604881, -3.3478606, 2.343485),
    vec4(-0.57769954, -3.2398953, 2.278988, -2.250032),
    vec4(-2.4342277, 2.9267676, -10.166434, -1.6841649)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.080188386, -0.17788683, -0.22983594, 0.20219137),
    vec4(-0.19566493, 0.18433502, -0.25953397, 0.14942715),
    vec4(0.11522388, 0.13476127, 0.11928268, 0.14287084),
    vec4(0.12903644, -0.2549965, 0.0918149, -0.43687555)
);
const float NMT_B3 = -1.4460578;

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

const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
const uint NMT_OCTAVE_BITS = 11u;
const uint NMT_HEAVY = 6u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const uint NMT_SLOTS = 8u;
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
    float front_7 = front_6 + (depths1.z < z ? absorbances1.z : 0.0);
    float in_core_7 = (depths1.z == z && absorbances1.z == absorbance ? 1.0 : in_core_6);
    float count_7 = count_6 - (absorbances1.z > 0.0 ? 1.0 : 0.0);
    float rest0_7 = rest0_6 - absorbances1.z;
    float rest1_7 = rest1_6 - absorbances1.z * depths1.z;
    float rest2_7 = rest2_6 - absorbances1.z * depths1.z * depths1.z;
    float rest3_7 = rest3_6 - absorbances1.z * depths1.z * depths1.z * depths1.z;
    float rest4_7 = rest4_6 - absorbances1.z * depths1.z * depths1.z * depths1.z * depths1.z;
    float front_8 = front_7 + (depths1.w < z ? absorbances1.w : 0.0);
    float in_core_8 = (depths1.w == z && absorbances1.w == absorbance ? 1.0 : in_core_7);
    float count_8 = count_7 - (absorbances1.w > 0.0 ? 1.0 : 0.0);
    float rest0_8 = rest0_7 - absorbances1.w;
    float rest1_8 = rest1_7 - absorbances1.w * depths1.w;
    float rest2_8 = rest2_7 - absorbances1.w * depths1.w * depths1.w;
    float rest3_8 = rest3_7 - absorbances1.w * depths1.w * depths1.w * depths1.w;
    float rest4_8 = rest4_7 - absorbances1.w * depths1.w * depths1.w * depths1.w * depths1.w;
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_8 - center * rest0_8) * per_h;
    float moved2 = (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)) * (per_h * per_h);
    float moved3 = (rest3_8 - center * rest2_8 - center * (rest2_8 - center * rest1_8) - center * (rest2_8 - center
        * rest1_8 - center * (rest1_8 - center * rest0_8))) * (per_h * per_h * per_h);
    float moved4 = (rest4_8 - center * rest3_8 - center * (rest3_8 - center * rest2_8) - center * (rest3_8 - center
        * rest2_8 - center * (rest2_8 - center * rest1_8)) - center * (rest3_8 - center * rest2_8 - center * (rest2_8
        - center * rest1_8) - center * (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_8 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_8 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_8 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_8 + absorbance_of_tail * exact_4)), 1.0);
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
        float most = min(exp(-(front_8 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_8 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    return exp(-front_8) * nmt_transmittance(mat3x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
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
    vec2 slot6 = nmt_core_slot(core1.z, nmt_core_heavy_steps(core1.z, codes));
    vec2 slot7 = nmt_core_slot(core1.w, nmt_core_heavy_steps(core1.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4(slot0.y, slot1.y, slot2.y, slot3.y),
        vec4(slot4.x, slot5.x, slot6.x, slot7.x),
        vec4(slot4.y, slot5.y, slot6.y, slot7.y),
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
layout(std430, binding = 0) readonly buffer Cores { uvec2 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint first = 4u * (uint(at.y) * width + uint(at.x));
    vec4 sums0 = texelFetch(sums0_texture, at, 0);
    vec4 sums1 = texelFetch(sums1_texture, at, 0);
    vec4 moments = vec4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, uvec4(core[first], core[first + 1u]), uvec4(core[first + 2u], core[first + 3u]), sums1.y, sums0.x, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
