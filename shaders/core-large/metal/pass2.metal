// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core-large', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit c1ed93bd63ea, backend fused, seed 2, epochs 1500, dataset cfac8078bedf5effa916da488b9581e4e76632aac69746931a2aa032cd1a0a6b.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.016e-3, worst 1.000.

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
    uint width;
};
typedef metal::uint2 NmtType14[1];
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(-4.0255322, 5.696204, 1.6943908, 4.625778), metal::float4(-0.123158716, -0.022845494, 1.3684101, -0.22309694), metal::float4(-0.055782713, -0.02729638, -0.7351799, 0.12446838), metal::float4(-22.08425, -21.542097, -12.540206, 7.9311724)), metal::float4x4(metal::float4(4.003113, -12.202889, -6.03625, -9.53933), metal::float4(5.079678, 0.96678704, -2.5490577, -3.7921448), metal::float4(-5.563451, -3.4979208, 2.9750206, -5.7120223), metal::float4(-1.8828032, -0.6641459, 2.2350688, -2.790497)), metal::float4x4(metal::float4(-47.499374, 0.7882673, -0.7554687, -0.40223193), metal::float4(2.2457452, 4.4966774, 2.7239416, 4.8531356), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-6.509258, -3.6678035, 2.3813612, 0.8936451), metal::float4(-0.0070089055, -0.38917178, 0.056811646, -0.03466737), metal::float4(0.0034584545, -0.08949225, -0.041342236, -0.03309034), metal::float4(0.002414985, 35.769714, 17.576942, 25.224512)), metal::float4x4(metal::float4(-0.020485638, -38.85436, -0.86674184, -23.896433), metal::float4(-0.01604367, 4.0836473, 0.33259383, 1.0908167), metal::float4(0.03454655, -18.111965, -3.71319, -4.6560225), metal::float4(0.011393566, -0.30890125, -1.3219124, -2.8662512)), metal::float4x4(metal::float4(0.0041463277, 1.9609691, 10.727305, 4.8774633), metal::float4(-6.485228, 1.0027441, -1.0354357, 2.0669503), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(1.0427063, 1.4444615, 0.22712201, -2.9948504), metal::float4(0.066054374, 0.31861958, 0.026391018, -0.27554062), metal::float4(-0.12969105, -0.015988281, 0.07662249, -0.0039148843), metal::float4(-2.64852, -0.30498013, -4.04413, 0.3279041)), metal::float4x4(metal::float4(-2.7326443, 2.5969625, -4.288648, 6.164401), metal::float4(-8.941283, 4.4852185, -1.8909162, 0.41518652), metal::float4(-8.713514, 8.992529, -1.2659963, -2.206071), metal::float4(5.6512294, -3.470394, -1.0694718, 4.1851635)), metal::float4x4(metal::float4(-1.1414442, -0.5981651, 9.139677, -8.4315195), metal::float4(3.3552182, -3.8380163, -2.0059235, 1.4037566), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.50419164, 3.3264024, 0.3408373, 0.15794963), metal::float4(0.15867789, -0.12802078, -0.0507785, 0.11978142), metal::float4(-0.100550495, 0.022845238, 0.04496174, 0.034926943), metal::float4(16.608372, 0.0759729, -1.9273227, -10.205227)), metal::float4x4(metal::float4(-12.711161, 2.190889, -1.5415816, 0.8842952), metal::float4(-1.7452958, -1.3973209, -7.6971993, 4.01076), metal::float4(-10.807886, -1.2840962, -3.3269665, 5.866802), metal::float4(0.44886237, 4.806983, 9.19736, -5.7426167)), metal::float4x4(metal::float4(7.395807, 1.3404678, 2.9149747, -8.111294), metal::float4(0.22378251, 1.1213043, 0.44062462, 1.4559642), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-6.7969713, -0.502306, 6.0482206, -1.571385), metal::float4(0.15505987, -0.112316325, -0.4587652, -0.04966048), metal::float4(0.013082438, -0.018316714, 0.44126177, -0.00346313), metal::float4(1.7010074, 19.925846, -26.00454, -0.16778176)), metal::float4x4(metal::float4(-1.2125382, -18.547857, 3.1266713, 0.29102612), metal::float4(-1.0211937, -0.9701661, -0.14331418, 7.204432), metal::float4(1.9405318, -0.29332843, -1.8971208, -5.4432473), metal::float4(0.5886473, 0.15590455, -3.7831268, -8.984916)), metal::float4x4(metal::float4(-1.5789444, 1.2986006, 2.2151904, 0.062172584), metal::float4(-6.4984884, 2.0684013, 1.5952907, 1.0277586), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.393126, 2.3674746, 0.82819694, 3.3245544), metal::float4(-0.12058834, -0.0047716806, -0.5326883, -0.6793858), metal::float4(0.025013916, 0.010085596, 1.4445151, 0.11267296), metal::float4(3.8268487, 32.934467, -0.16003872, 3.8154705)), metal::float4x4(metal::float4(-7.692379, -20.772335, 0.35992932, -9.875593), metal::float4(1.4604832, -6.4257917, -2.883336, -2.820427), metal::float4(-4.661669, -1.7963374, 2.6235654, 4.8746185), metal::float4(-0.022091508, 4.993737, 0.3696627, -2.0515103)), metal::float4x4(metal::float4(-1.0262295, 7.732843, -0.19911182, 4.143213), metal::float4(1.0726902, 0.3799708, -3.7199762, 2.1817524), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-4.187771, 5.7622466, 3.464974, 3.5274491), metal::float4(0.123458035, -0.15130657, -0.21285085, -0.6091351), metal::float4(0.113453746, 0.058647636, -0.12338351, 0.3324342), metal::float4(-8.736808, 3.7716558, -0.9494796, -103.00982)), metal::float4x4(metal::float4(2.0454342, 0.2812312, -0.055282958, -4.450533), metal::float4(-3.6171782, -0.49419218, 5.6497235, -1.925063), metal::float4(0.7400166, 1.2106199, -3.009102, 0.2615118), metal::float4(7.4685283, -1.4964488, -11.21016, 1.9037799)), metal::float4x4(metal::float4(2.3226392, -0.80109143, 5.0596423, 1.3209901), metal::float4(-6.4159875, 4.7279124, -1.2052386, 3.2027826), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-2.67451, -0.25473332, -4.7082705, -6.950072), metal::float4(-0.22337003, 0.013849621, -0.5821967, 0.023658099), metal::float4(0.18122683, -0.050395988, -0.25371712, -0.008888219), metal::float4(6.502307, -1.9178911, -0.39032215, -0.7561635)), metal::float4x4(metal::float4(-3.0350447, 9.534253, -0.75022167, -0.3300544), metal::float4(3.5901492, 3.03143, 0.117477216, 0.01888314), metal::float4(-4.6517525, 2.9598794, -0.58163494, -0.36835226), metal::float4(-2.483894, -2.092986, -0.02274922, 0.06036394)), metal::float4x4(metal::float4(3.4605544, -1.1416317, -0.49811774, 1.056725), metal::float4(-0.9243449, -1.1349953, -5.6314116, -6.5328717), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(-0.9533716, -0.023912556, -0.9153294, -0.6364172), metal::float4(-1.3491272, -0.021342112, 1.0095835, 0.28646916), metal::float4(0.16594304, -0.27667075, -0.51430374, -2.0443883), metal::float4(1.112755, 0.0915239, -1.0105754, 0.24547203)), metal::float4x4(metal::float4(-15.338107, -0.18109065, 36.85456, -16.543253), metal::float4(-1.0150462, 0.056353666, 0.016026035, 2.2635589), metal::float4(1.6816186, -0.05943171, 0.8579211, -1.0591912), metal::float4(0.043707225, -0.09092495, 0.15902202, 3.3374038)), metal::float4x4(metal::float4(0.039660048, -0.3292222, -0.5847584, -2.5101895), metal::float4(-1.311235, -0.40319374, 1.7404836, 0.9153837), metal::float4(2.1340253, -0.32362092, -0.17209554, 1.191257), metal::float4(0.6353717, -0.21473892, 1.5834737, 2.851836)), metal::float4x4(metal::float4(1.2562435, 0.07121042, -0.0665915, -1.2945167), metal::float4(-0.7341449, -0.3799136, -0.010191748, -16.294928), metal::float4(0.85872763, 0.20701307, -1.0996699, -24.260374), metal::float4(3.177199, -0.38679487, 0.11351008, -1.6164944)), metal::float4x4(metal::float4(-6.4650416, -0.41673565, 0.55340284, -13.12142), metal::float4(0.7579364, -0.18683712, 0.20788263, -1.0848093), metal::float4(3.2402115, -0.04443337, -0.033630773, 0.19914113), metal::float4(-1.1899779, -0.13963297, 1.885436, 3.854255)), metal::float4x4(metal::float4(0.5404526, 0.09659141, 1.6735438, -1.3909712), metal::float4(-2.067266, -0.39151478, -0.18703642, 0.6079234), metal::float4(1.2486103, -0.07376202, 1.1963037, -0.5950847), metal::float4(-4.0807877, -0.1041501, 0.2707971, 0.10968553)), metal::float4x4(metal::float4(-0.78077024, -0.17305139, 1.9303315, -12.010455), metal::float4(-0.9506922, -0.20199437, -0.06307983, 2.4605262), metal::float4(-0.43516338, -0.100928746, -2.1531272, -3.1601245), metal::float4(-0.23850946, 0.059164405, 0.1695899, -3.4487617)), metal::float4x4(metal::float4(-1.3490047, -0.4209982, 0.22618073, -3.3278596), metal::float4(-1.875717, -0.4981746, -0.78577715, -4.9637), metal::float4(44.00582, -0.31377533, 25.27289, -18.628054), metal::float4(-3.6807067, -0.12270356, 1.5959344, -0.8601947)), metal::float4x4(metal::float4(-0.1453553, 0.07063915, 1.8956821, 1.9108816), metal::float4(0.3346319, -0.076211855, 0.34616187, 0.5547185), metal::float4(-0.011447386, -0.41964942, -0.28713802, -0.2837125), metal::float4(0.7431988, 0.090956256, -0.9054148, 0.72439426)), metal::float4x4(metal::float4(39.286304, -0.31516922, 40.76921, 16.395794), metal::float4(-0.42318517, -0.5491356, -2.1107347, -14.392391), metal::float4(-1.0712371, -0.25630018, -0.26045516, -4.6359696), metal::float4(-0.6129423, -0.99003834, 1.545693, -0.76912624)), metal::float4x4(metal::float4(-1.0058358, -0.32852674, 0.4163718, -1.056459), metal::float4(-0.84956074, -0.565298, -0.83973414, -1.2990212), metal::float4(1.4913182, -0.16343024, -2.343077, 0.6615414), metal::float4(-0.6030688, -0.30026984, -0.18957068, -2.59755)), metal::float4x4(metal::float4(2.6016612, -0.2845663, 1.6151973, 0.6618105), metal::float4(-0.0525817, -0.33184847, -0.28768083, 0.91238344), metal::float4(-0.119816735, -0.25671324, 0.9706344, -0.6891455), metal::float4(0.56451523, 0.17033842, -0.47975639, -1.8264201)), metal::float4x4(metal::float4(2.9959838, -0.652482, 1.8844278, 0.9622594), metal::float4(0.070143305, -0.6639423, 0.40328276, -0.64634347), metal::float4(-0.60777456, -0.5887462, 0.7209019, -0.69019026), metal::float4(0.5434486, -0.5052658, 0.33621076, 2.5048401)), metal::float4x4(metal::float4(-0.26733327, -0.4642397, -0.9772016, -0.870254), metal::float4(-3.6335413, -0.3555749, -1.045125, -4.07717), metal::float4(-0.8452041, -0.3185469, -0.37459856, -0.110035), metal::float4(0.55276686, -0.4794151, -0.3470924, -2.098274)), metal::float4x4(metal::float4(-0.6638723, -0.29884577, -0.35764614, -2.100383), metal::float4(0.30588472, -0.8333303, -0.17897666, -1.1643548), metal::float4(-2.3153057, -0.55565417, -0.32713842, -3.6840034), metal::float4(0.7842276, -0.38678697, 0.6786007, 1.412775)), metal::float4x4(metal::float4(0.42784715, -0.8615997, 0.2460582, -0.10386703), metal::float4(-0.13341987, -0.7622468, -1.076524, 1.2882116), metal::float4(26.760437, 0.043523494, 41.775837, 6.34395), metal::float4(2.348743, -0.58241946, 12.563165, 1.9395633)), metal::float4x4(metal::float4(-1.0057069, -15.484056, -0.8306804, 4.1161814), metal::float4(0.16261958, -11.575914, 0.7167826, -0.7424119), metal::float4(-0.18335058, -0.9846208, -1.2416226, 0.44570327), metal::float4(-1.1767898, 4.0964417, 0.13868305, -1.2914313)), metal::float4x4(metal::float4(-70.23616, -75.0458, -59.01664, 12.429902), metal::float4(-2.5156229, -1.0310744, -1.2728319, 0.34910786), metal::float4(2.1732159, 0.15101202, 0.85288423, 2.1510382), metal::float4(2.449578, -6.0832376, -2.8002646, 1.9478861)), metal::float4x4(metal::float4(-0.29509312, -3.8282657, -0.67162865, 1.6842072), metal::float4(-0.9205352, 0.11075853, 1.3054434, 0.5321204), metal::float4(-0.22425814, -0.15107968, -1.575949, 0.22575685), metal::float4(0.37909648, -0.250605, 0.9879276, -7.929242)), metal::float4x4(metal::float4(-0.47060302, 2.9747362, -10.990186, 0.4114294), metal::float4(-1.6254674, 0.7859203, 0.46615675, -3.7527027), metal::float4(-0.286325, 0.617553, 0.0033092718, 4.303752), metal::float4(2.7186172, 0.44322705, -1.863603, 1.624693)), metal::float4x4(metal::float4(-2.4725301, -1.5300545, -0.9504451, 3.1540065), metal::float4(0.053648796, -1.0160289, -1.0822248, 3.1805134), metal::float4(0.4030251, -0.2734259, 0.38411066, 0.38576034), metal::float4(-0.2328709, 1.4899489, 1.5601239, -1.69999)), metal::float4x4(metal::float4(-0.49676415, 1.1180121, -0.43828925, -1.4976035), metal::float4(-1.5912924, -9.547819, -0.78240997, -7.8603153), metal::float4(-0.3214312, 0.087684, -0.04540323, -0.5647855), metal::float4(0.46469375, 1.1731452, -0.63446325, 0.25039765)), metal::float4x4(metal::float4(2.304289, 1.1074053, 1.7841369, -1.1050184), metal::float4(0.41535342, -0.790432, -1.2212279, 2.138696), metal::float4(-1.4066341, -3.970257, -0.077826135, -4.155295), metal::float4(0.93355304, -1.0763787, -0.11814381, 2.1212103)), metal::float4x4(metal::float4(-1.1244867, -0.4228181, 1.161553, -1.3148576), metal::float4(0.056548953, 0.39536077, -0.5357919, -3.4298966), metal::float4(-62.053368, -59.341625, -40.85116, 5.0153856), metal::float4(-3.138093, 1.2564723, -2.4892633, -6.9960933)), metal::float4x4(metal::float4(-1.3116454, -2.4449224, 0.6285333, 0.33160317), metal::float4(0.89022815, 1.6486273, 0.56321317, 0.21195675), metal::float4(-0.19395639, -1.2140524, -0.94985414, 0.061687086), metal::float4(1.2984312, -1.0810565, -1.3238264, 0.26209682)), metal::float4x4(metal::float4(-19.707382, -58.439476, -34.231743, 51.697456), metal::float4(-0.8955569, -0.5577856, -1.7309264, 1.9096798), metal::float4(0.2397159, 0.29411244, -0.55452573, -1.7539995), metal::float4(-0.47557485, 3.0380623, -3.7277555, -0.18603717)), metal::float4x4(metal::float4(-0.26022965, 0.12189879, -1.4006208, -0.055232037), metal::float4(2.2262263, -0.44580844, -0.26314613, -1.8803545), metal::float4(-0.26910368, -1.6509178, 5.3864126, 0.032558464), metal::float4(2.2175922, -1.0064648, -0.20202447, -1.7486198)), metal::float4x4(metal::float4(-0.363278, 4.63216, 1.9288766, -2.4225435), metal::float4(-0.50264215, -2.6026533, 0.5468965, -0.6739758), metal::float4(0.120355025, 1.240956, -3.8503177, 0.007677607), metal::float4(-1.3201234, 0.4576058, -0.94173425, -2.2499797)), metal::float4x4(metal::float4(-2.5061276, -0.49517626, -2.9986513, 3.318081), metal::float4(-1.2816699, 0.23562266, -1.484695, 0.91130346), metal::float4(-0.8777639, 0.88774824, -0.4923823, 0.106555), metal::float4(1.272445, -1.5231833, 3.9530544, 0.9388586)), metal::float4x4(metal::float4(1.3245022, -0.4820548, 1.6983755, 0.028543063), metal::float4(1.3538333, -6.846795, 0.8200843, -4.4577127), metal::float4(-0.015166995, 0.16394323, -0.07165488, -0.2219812), metal::float4(0.97834635, 1.1480302, -1.5143827, 0.32333264)), metal::float4x4(metal::float4(-0.37034887, 1.3580012, 0.116402686, -3.630028), metal::float4(0.25529686, 0.66414505, 2.4161358, 1.323056), metal::float4(-2.662821, -4.2417464, -2.479341, -20.309309), metal::float4(-0.06483494, -1.9271599, 0.23421793, 0.18673025)), metal::float4x4(metal::float4(-0.78342414, 1.2142608, -1.4254683, 0.36460462), metal::float4(1.2078199, -0.90951747, -0.011000494, 0.7334401), metal::float4(-21.266111, -49.016678, 6.222171, 45.55174), metal::float4(0.2647363, -0.14191146, 2.8238018, 0.15251571))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(1.3959447, -0.14219934, 2.8130505, -6.171281), metal::float4(3.1731634, -0.4604881, -3.3478606, 2.343485), metal::float4(-0.57769954, -3.2398953, 2.278988, -2.250032), metal::float4(-2.4342277, 2.9267676, -10.166434, -1.6841649)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.080188386, -0.17788683, -0.22983594, 0.20219137), metal::float4(-0.19566493, 0.18433502, -0.25953397, 0.14942715), metal::float4(0.11522388, 0.13476127, 0.11928268, 0.14287084), metal::float4(0.12903644, -0.2549965, 0.0918149, -0.43687555)}};
constant float NMT_B3 = -1.4460578;
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 6u;
constant uint NMT_SLOTS = 8u;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(-4.0255322, 5.696204, 1.6943908, 4.625778), metal::float4(-0.123158716, -0.022845494, 1.3684101, -0.22309694), metal::float4(-0.055782713, -0.02729638, -0.7351799, 0.12446838), metal::float4(-22.08425, -21.542097, -12.540206, 7.9311724)) * h0_0) + (metal::float4x4(metal::float4(4.003113, -12.202889, -6.03625, -9.53933), metal::float4(5.079678, 0.96678704, -2.5490577, -3.7921448), metal::float4(-5.563451, -3.4979208, 2.9750206, -5.7120223), metal::float4(-1.8828032, -0.6641459, 2.2350688, -2.790497)) * h0_1)) + (metal::float4x4(metal::float4(-47.499374, 0.7882673, -0.7554687, -0.40223193), metal::float4(2.2457452, 4.4966774, 2.7239416, 4.8531356), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-6.509258, -3.6678035, 2.3813612, 0.8936451), metal::float4(-0.0070089055, -0.38917178, 0.056811646, -0.03466737), metal::float4(0.0034584545, -0.08949225, -0.041342236, -0.03309034), metal::float4(0.002414985, 35.769714, 17.576942, 25.224512)) * h0_0) + (metal::float4x4(metal::float4(-0.020485638, -38.85436, -0.86674184, -23.896433), metal::float4(-0.01604367, 4.0836473, 0.33259383, 1.0908167), metal::float4(0.03454655, -18.111965, -3.71319, -4.6560225), metal::float4(0.011393566, -0.30890125, -1.3219124, -2.8662512)) * h0_1)) + (metal::float4x4(metal::float4(0.0041463277, 1.9609691, 10.727305, 4.8774633), metal::float4(-6.485228, 1.0027441, -1.0354357, 2.0669503), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(1.0427063, 1.4444615, 0.22712201, -2.9948504), metal::float4(0.066054374, 0.31861958, 0.026391018, -0.27554062), metal::float4(-0.12969105, -0.015988281, 0.07662249, -0.0039148843), metal::float4(-2.64852, -0.30498013, -4.04413, 0.3279041)) * h0_0) + (metal::float4x4(metal::float4(-2.7326443, 2.5969625, -4.288648, 6.164401), metal::float4(-8.941283, 4.4852185, -1.8909162, 0.41518652), metal::float4(-8.713514, 8.992529, -1.2659963, -2.206071), metal::float4(5.6512294, -3.470394, -1.0694718, 4.1851635)) * h0_1)) + (metal::float4x4(metal::float4(-1.1414442, -0.5981651, 9.139677, -8.4315195), metal::float4(3.3552182, -3.8380163, -2.0059235, 1.4037566), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(0.50419164, 3.3264024, 0.3408373, 0.15794963), metal::float4(0.15867789, -0.12802078, -0.0507785, 0.11978142), metal::float4(-0.100550495, 0.022845238, 0.04496174, 0.034926943), metal::float4(16.608372, 0.0759729, -1.9273227, -10.205227)) * h0_0) + (metal::float4x4(metal::float4(-12.711161, 2.190889, -1.5415816, 0.8842952), metal::float4(-1.7452958, -1.3973209, -7.6971993, 4.01076), metal::float4(-10.807886, -1.2840962, -3.3269665, 5.866802), metal::float4(0.44886237, 4.806983, 9.19736, -5.7426167)) * h0_1)) + (metal::float4x4(metal::float4(7.395807, 1.3404678, 2.9149747, -8.111294), metal::float4(0.22378251, 1.1213043, 0.44062462, 1.4559642), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(-6.7969713, -0.502306, 6.0482206, -1.571385), metal::float4(0.15505987, -0.112316325, -0.4587652, -0.04966048), metal::float4(0.013082438, -0.018316714, 0.44126177, -0.00346313), metal::float4(1.7010074, 19.925846, -26.00454, -0.16778176)) * h0_0) + (metal::float4x4(metal::float4(-1.2125382, -18.547857, 3.1266713, 0.29102612), metal::float4(-1.0211937, -0.9701661, -0.14331418, 7.204432), metal::float4(1.9405318, -0.29332843, -1.8971208, -5.4432473), metal::float4(0.5886473, 0.15590455, -3.7831268, -8.984916)) * h0_1)) + (metal::float4x4(metal::float4(-1.5789444, 1.2986006, 2.2151904, 0.062172584), metal::float4(-6.4984884, 2.0684013, 1.5952907, 1.0277586), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-3.393126, 2.3674746, 0.82819694, 3.3245544), metal::float4(-0.12058834, -0.0047716806, -0.5326883, -0.6793858), metal::float4(0.025013916, 0.010085596, 1.4445151, 0.11267296), metal::float4(3.8268487, 32.934467, -0.16003872, 3.8154705)) * h0_0) + (metal::float4x4(metal::float4(-7.692379, -20.772335, 0.35992932, -9.875593), metal::float4(1.4604832, -6.4257917, -2.883336, -2.820427), metal::float4(-4.661669, -1.7963374, 2.6235654, 4.8746185), metal::float4(-0.022091508, 4.993737, 0.3696627, -2.0515103)) * h0_1)) + (metal::float4x4(metal::float4(-1.0262295, 7.732843, -0.19911182, 4.143213), metal::float4(1.0726902, 0.3799708, -3.7199762, 2.1817524), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-4.187771, 5.7622466, 3.464974, 3.5274491), metal::float4(0.123458035, -0.15130657, -0.21285085, -0.6091351), metal::float4(0.113453746, 0.058647636, -0.12338351, 0.3324342), metal::float4(-8.736808, 3.7716558, -0.9494796, -103.00982)) * h0_0) + (metal::float4x4(metal::float4(2.0454342, 0.2812312, -0.055282958, -4.450533), metal::float4(-3.6171782, -0.49419218, 5.6497235, -1.925063), metal::float4(0.7400166, 1.2106199, -3.009102, 0.2615118), metal::float4(7.4685283, -1.4964488, -11.21016, 1.9037799)) * h0_1)) + (metal::float4x4(metal::float4(2.3226392, -0.80109143, 5.0596423, 1.3209901), metal::float4(-6.4159875, 4.7279124, -1.2052386, 3.2027826), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(-2.67451, -0.25473332, -4.7082705, -6.950072), metal::float4(-0.22337003, 0.013849621, -0.5821967, 0.023658099), metal::float4(0.18122683, -0.050395988, -0.25371712, -0.008888219), metal::float4(6.502307, -1.9178911, -0.39032215, -0.7561635)) * h0_0) + (metal::float4x4(metal::float4(-3.0350447, 9.534253, -0.75022167, -0.3300544), metal::float4(3.5901492, 3.03143, 0.117477216, 0.01888314), metal::float4(-4.6517525, 2.9598794, -0.58163494, -0.36835226), metal::float4(-2.483894, -2.092986, -0.02274922, 0.06036394)) * h0_1)) + (metal::float4x4(metal::float4(3.4605544, -1.1416317, -0.49811774, 1.056725), metal::float4(-0.9243449, -1.1349953, -5.6314116, -6.5328717), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.3959447, -0.14219934, 2.8130505, -6.171281) + (metal::float4x4(metal::float4(-0.9533716, -0.023912556, -0.9153294, -0.6364172), metal::float4(-1.3491272, -0.021342112, 1.0095835, 0.28646916), metal::float4(0.16594304, -0.27667075, -0.51430374, -2.0443883), metal::float4(1.112755, 0.0915239, -1.0105754, 0.24547203)) * h1_0)) + (metal::float4x4(metal::float4(-15.338107, -0.18109065, 36.85456, -16.543253), metal::float4(-1.0150462, 0.056353666, 0.016026035, 2.2635589), metal::float4(1.6816186, -0.05943171, 0.8579211, -1.0591912), metal::float4(0.043707225, -0.09092495, 0.15902202, 3.3374038)) * h1_1)) + (metal::float4x4(metal::float4(0.039660048, -0.3292222, -0.5847584, -2.5101895), metal::float4(-1.311235, -0.40319374, 1.7404836, 0.9153837), metal::float4(2.1340253, -0.32362092, -0.17209554, 1.191257), metal::float4(0.6353717, -0.21473892, 1.5834737, 2.851836)) * h1_2)) + (metal::float4x4(metal::float4(1.2562435, 0.07121042, -0.0665915, -1.2945167), metal::float4(-0.7341449, -0.3799136, -0.010191748, -16.294928), metal::float4(0.85872763, 0.20701307, -1.0996699, -24.260374), metal::float4(3.177199, -0.38679487, 0.11351008, -1.6164944)) * h1_3)) + (metal::float4x4(metal::float4(-6.4650416, -0.41673565, 0.55340284, -13.12142), metal::float4(0.7579364, -0.18683712, 0.20788263, -1.0848093), metal::float4(3.2402115, -0.04443337, -0.033630773, 0.19914113), metal::float4(-1.1899779, -0.13963297, 1.885436, 3.854255)) * h1_4)) + (metal::float4x4(metal::float4(0.5404526, 0.09659141, 1.6735438, -1.3909712), metal::float4(-2.067266, -0.39151478, -0.18703642, 0.6079234), metal::float4(1.2486103, -0.07376202, 1.1963037, -0.5950847), metal::float4(-4.0807877, -0.1041501, 0.2707971, 0.10968553)) * h1_5)) + (metal::float4x4(metal::float4(-0.78077024, -0.17305139, 1.9303315, -12.010455), metal::float4(-0.9506922, -0.20199437, -0.06307983, 2.4605262), metal::float4(-0.43516338, -0.100928746, -2.1531272, -3.1601245), metal::float4(-0.23850946, 0.059164405, 0.1695899, -3.4487617)) * h1_6)) + (metal::float4x4(metal::float4(-1.3490047, -0.4209982, 0.22618073, -3.3278596), metal::float4(-1.875717, -0.4981746, -0.78577715, -4.9637), metal::float4(44.00582, -0.31377533, 25.27289, -18.628054), metal::float4(-3.6807067, -0.12270356, 1.5959344, -0.8601947)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(3.1731634, -0.4604881, -3.3478606, 2.343485) + (metal::float4x4(metal::float4(-0.1453553, 0.07063915, 1.8956821, 1.9108816), metal::float4(0.3346319, -0.076211855, 0.34616187, 0.5547185), metal::float4(-0.011447386, -0.41964942, -0.28713802, -0.2837125), metal::float4(0.7431988, 0.090956256, -0.9054148, 0.72439426)) * h1_0)) + (metal::float4x4(metal::float4(39.286304, -0.31516922, 40.76921, 16.395794), metal::float4(-0.42318517, -0.5491356, -2.1107347, -14.392391), metal::float4(-1.0712371, -0.25630018, -0.26045516, -4.6359696), metal::float4(-0.6129423, -0.99003834, 1.545693, -0.76912624)) * h1_1)) + (metal::float4x4(metal::float4(-1.0058358, -0.32852674, 0.4163718, -1.056459), metal::float4(-0.84956074, -0.565298, -0.83973414, -1.2990212), metal::float4(1.4913182, -0.16343024, -2.343077, 0.6615414), metal::float4(-0.6030688, -0.30026984, -0.18957068, -2.59755)) * h1_2)) + (metal::float4x4(metal::float4(2.6016612, -0.2845663, 1.6151973, 0.6618105), metal::float4(-0.0525817, -0.33184847, -0.28768083, 0.91238344), metal::float4(-0.119816735, -0.25671324, 0.9706344, -0.6891455), metal::float4(0.56451523, 0.17033842, -0.47975639, -1.8264201)) * h1_3)) + (metal::float4x4(metal::float4(2.9959838, -0.652482, 1.8844278, 0.9622594), metal::float4(0.070143305, -0.6639423, 0.40328276, -0.64634347), metal::float4(-0.60777456, -0.5887462, 0.7209019, -0.69019026), metal::float4(0.5434486, -0.5052658, 0.33621076, 2.5048401)) * h1_4)) + (metal::float4x4(metal::float4(-0.26733327, -0.4642397, -0.9772016, -0.870254), metal::float4(-3.6335413, -0.3555749, -1.045125, -4.07717), metal::float4(-0.8452041, -0.3185469, -0.37459856, -0.110035), metal::float4(0.55276686, -0.4794151, -0.3470924, -2.098274)) * h1_5)) + (metal::float4x4(metal::float4(-0.6638723, -0.29884577, -0.35764614, -2.100383), metal::float4(0.30588472, -0.8333303, -0.17897666, -1.1643548), metal::float4(-2.3153057, -0.55565417, -0.32713842, -3.6840034), metal::float4(0.7842276, -0.38678697, 0.6786007, 1.412775)) * h1_6)) + (metal::float4x4(metal::float4(0.42784715, -0.8615997, 0.2460582, -0.10386703), metal::float4(-0.13341987, -0.7622468, -1.076524, 1.2882116), metal::float4(26.760437, 0.043523494, 41.775837, 6.34395), metal::float4(2.348743, -0.58241946, 12.563165, 1.9395633)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-0.57769954, -3.2398953, 2.278988, -2.250032) + (metal::float4x4(metal::float4(-1.0057069, -15.484056, -0.8306804, 4.1161814), metal::float4(0.16261958, -11.575914, 0.7167826, -0.7424119), metal::float4(-0.18335058, -0.9846208, -1.2416226, 0.44570327), metal::float4(-1.1767898, 4.0964417, 0.13868305, -1.2914313)) * h1_0)) + (metal::float4x4(metal::float4(-70.23616, -75.0458, -59.01664, 12.429902), metal::float4(-2.5156229, -1.0310744, -1.2728319, 0.34910786), metal::float4(2.1732159, 0.15101202, 0.85288423, 2.1510382), metal::float4(2.449578, -6.0832376, -2.8002646, 1.9478861)) * h1_1)) + (metal::float4x4(metal::float4(-0.29509312, -3.8282657, -0.67162865, 1.6842072), metal::float4(-0.9205352, 0.11075853, 1.3054434, 0.5321204), metal::float4(-0.22425814, -0.15107968, -1.575949, 0.22575685), metal::float4(0.37909648, -0.250605, 0.9879276, -7.929242)) * h1_2)) + (metal::float4x4(metal::float4(-0.47060302, 2.9747362, -10.990186, 0.4114294), metal::float4(-1.6254674, 0.7859203, 0.46615675, -3.7527027), metal::float4(-0.286325, 0.617553, 0.0033092718, 4.303752), metal::float4(2.7186172, 0.44322705, -1.863603, 1.624693)) * h1_3)) + (metal::float4x4(metal::float4(-2.4725301, -1.5300545, -0.9504451, 3.1540065), metal::float4(0.053648796, -1.0160289, -1.0822248, 3.1805134), metal::float4(0.4030251, -0.2734259, 0.38411066, 0.38576034), metal::float4(-0.2328709, 1.4899489, 1.5601239, -1.69999)) * h1_4)) + (metal::float4x4(metal::float4(-0.49676415, 1.1180121, -0.43828925, -1.4976035), metal::float4(-1.5912924, -9.547819, -0.78240997, -7.8603153), metal::float4(-0.3214312, 0.087684, -0.04540323, -0.5647855), metal::float4(0.46469375, 1.1731452, -0.63446325, 0.25039765)) * h1_5)) + (metal::float4x4(metal::float4(2.304289, 1.1074053, 1.7841369, -1.1050184), metal::float4(0.41535342, -0.790432, -1.2212279, 2.138696), metal::float4(-1.4066341, -3.970257, -0.077826135, -4.155295), metal::float4(0.93355304, -1.0763787, -0.11814381, 2.1212103)) * h1_6)) + (metal::float4x4(metal::float4(-1.1244867, -0.4228181, 1.161553, -1.3148576), metal::float4(0.056548953, 0.39536077, -0.5357919, -3.4298966), metal::float4(-62.053368, -59.341625, -40.85116, 5.0153856), metal::float4(-3.138093, 1.2564723, -2.4892633, -6.9960933)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-2.4342277, 2.9267676, -10.166434, -1.6841649) + (metal::float4x4(metal::float4(-1.3116454, -2.4449224, 0.6285333, 0.33160317), metal::float4(0.89022815, 1.6486273, 0.56321317, 0.21195675), metal::float4(-0.19395639, -1.2140524, -0.94985414, 0.061687086), metal::float4(1.2984312, -1.0810565, -1.3238264, 0.26209682)) * h1_0)) + (metal::float4x4(metal::float4(-19.707382, -58.439476, -34.231743, 51.697456), metal::float4(-0.8955569, -0.5577856, -1.7309264, 1.9096798), metal::float4(0.2397159, 0.29411244, -0.55452573, -1.7539995), metal::float4(-0.47557485, 3.0380623, -3.7277555, -0.18603717)) * h1_1)) + (metal::float4x4(metal::float4(-0.26022965, 0.12189879, -1.4006208, -0.055232037), metal::float4(2.2262263, -0.44580844, -0.26314613, -1.8803545), metal::float4(-0.26910368, -1.6509178, 5.3864126, 0.032558464), metal::float4(2.2175922, -1.0064648, -0.20202447, -1.7486198)) * h1_2)) + (metal::float4x4(metal::float4(-0.363278, 4.63216, 1.9288766, -2.4225435), metal::float4(-0.50264215, -2.6026533, 0.5468965, -0.6739758), metal::float4(0.120355025, 1.240956, -3.8503177, 0.007677607), metal::float4(-1.3201234, 0.4576058, -0.94173425, -2.2499797)) * h1_3)) + (metal::float4x4(metal::float4(-2.5061276, -0.49517626, -2.9986513, 3.318081), metal::float4(-1.2816699, 0.23562266, -1.484695, 0.91130346), metal::float4(-0.8777639, 0.88774824, -0.4923823, 0.106555), metal::float4(1.272445, -1.5231833, 3.9530544, 0.9388586)) * h1_4)) + (metal::float4x4(metal::float4(1.3245022, -0.4820548, 1.6983755, 0.028543063), metal::float4(1.3538333, -6.846795, 0.8200843, -4.4577127), metal::float4(-0.015166995, 0.16394323, -0.07165488, -0.2219812), metal::float4(0.97834635, 1.1480302, -1.5143827, 0.32333264)) * h1_5)) + (metal::float4x4(metal::float4(-0.37034887, 1.3580012, 0.116402686, -3.630028), metal::float4(0.25529686, 0.66414505, 2.4161358, 1.323056), metal::float4(-2.662821, -4.2417464, -2.479341, -20.309309), metal::float4(-0.06483494, -1.9271599, 0.23421793, 0.18673025)) * h1_6)) + (metal::float4x4(metal::float4(-0.78342414, 1.2142608, -1.4254683, 0.36460462), metal::float4(1.2078199, -0.90951747, -0.011000494, 0.7334401), metal::float4(-21.266111, -49.016678, 6.222171, 45.55174), metal::float4(0.2647363, -0.14191146, 2.8238018, 0.15251571)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.080188386, -0.17788683, -0.22983594, 0.20219137), h2_0)) + metal::dot(metal::float4(-0.19566493, 0.18433502, -0.25953397, 0.14942715), h2_1)) + metal::dot(metal::float4(0.11522388, 0.13476127, 0.11928268, 0.14287084), h2_2)) + metal::dot(metal::float4(0.12903644, -0.2549965, 0.0918149, -0.43687555), h2_3);
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
    uint range = static_cast<uint>(as_type<int>(as_type<uint>(_e5) - as_type<uint>(_e4)));
    uint shift = metal::max(32u - metal::clz(range), 17u) - 17u;
    uint multiplier = naga_div(2147483648u, (range >> shift) + 1u);
    uint slope = metal::min(naga_f2u32(static_cast<float>(range >> 8u) * NMT_KEY_SCALE), 38399u);
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

metal::uint2 nmt_core_heavy_steps(
    uint code_2,
    NmtCodes codes_1
) {
    uint nearness = code_2 & NMT_LAST_DEPTH;
    uint key = code_2 >> NMT_DEPTH_BITS;
    return metal::uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes_1.slope) >> NMT_DEPTH_BITS));
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
    metal::float4 depths1,
    metal::float4 absorbances1,
    float n,
    float b0,
    metal::float4 moments
) {
    bool local = {};
    bool local_1 = {};
    bool local_2 = {};
    bool local_3 = {};
    bool local_4 = {};
    bool local_5 = {};
    bool local_6 = {};
    bool local_7 = {};
    bool local_8 = {};
    bool local_9 = {};
    bool local_10 = {};
    float front = 0.0 + ((z > depths0.x) ? absorbances0.x : 0.0);
    if (depths0.x == z) {
        local = absorbances0.x == absorbance_1;
    } else {
        local = false;
    }
    bool _e23 = local;
    float in_core = _e23 ? 1.0 : 0.0;
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
    bool _e81 = local_1;
    float in_core_2 = _e81 ? 1.0 : in_core;
    float count_2 = count - ((absorbances0.y > 0.0) ? 1.0 : 0.0);
    float rest0_2 = rest0 - absorbances0.y;
    float rest1_2 = rest1 - (absorbances0.y * depths0.y);
    float rest2_2 = rest2 - ((absorbances0.y * depths0.y) * depths0.y);
    float rest3_2 = rest3 - (((absorbances0.y * depths0.y) * depths0.y) * depths0.y);
    float rest4_2 = rest4 - ((((absorbances0.y * depths0.y) * depths0.y) * depths0.y) * depths0.y);
    float front_3 = front_2 + ((z > depths0.z) ? absorbances0.z : 0.0);
    if (depths0.z == z) {
        local_2 = absorbances0.z == absorbance_1;
    } else {
        local_2 = false;
    }
    bool _e134 = local_2;
    float in_core_3 = _e134 ? 1.0 : in_core_2;
    float count_3 = count_2 - ((absorbances0.z > 0.0) ? 1.0 : 0.0);
    float rest0_3 = rest0_2 - absorbances0.z;
    float rest1_3 = rest1_2 - (absorbances0.z * depths0.z);
    float rest2_3 = rest2_2 - ((absorbances0.z * depths0.z) * depths0.z);
    float rest3_3 = rest3_2 - (((absorbances0.z * depths0.z) * depths0.z) * depths0.z);
    float rest4_3 = rest4_2 - ((((absorbances0.z * depths0.z) * depths0.z) * depths0.z) * depths0.z);
    float front_4 = front_3 + ((z > depths0.w) ? absorbances0.w : 0.0);
    if (depths0.w == z) {
        local_3 = absorbances0.w == absorbance_1;
    } else {
        local_3 = false;
    }
    bool _e187 = local_3;
    float in_core_4 = _e187 ? 1.0 : in_core_3;
    float count_4 = count_3 - ((absorbances0.w > 0.0) ? 1.0 : 0.0);
    float rest0_4 = rest0_3 - absorbances0.w;
    float rest1_4 = rest1_3 - (absorbances0.w * depths0.w);
    float rest2_4 = rest2_3 - ((absorbances0.w * depths0.w) * depths0.w);
    float rest3_4 = rest3_3 - (((absorbances0.w * depths0.w) * depths0.w) * depths0.w);
    float rest4_4 = rest4_3 - ((((absorbances0.w * depths0.w) * depths0.w) * depths0.w) * depths0.w);
    float front_5 = front_4 + ((z > depths1.x) ? absorbances1.x : 0.0);
    if (depths1.x == z) {
        local_4 = absorbances1.x == absorbance_1;
    } else {
        local_4 = false;
    }
    bool _e240 = local_4;
    float in_core_5 = _e240 ? 1.0 : in_core_4;
    float count_5 = count_4 - ((absorbances1.x > 0.0) ? 1.0 : 0.0);
    float rest0_5 = rest0_4 - absorbances1.x;
    float rest1_5 = rest1_4 - (absorbances1.x * depths1.x);
    float rest2_5 = rest2_4 - ((absorbances1.x * depths1.x) * depths1.x);
    float rest3_5 = rest3_4 - (((absorbances1.x * depths1.x) * depths1.x) * depths1.x);
    float rest4_5 = rest4_4 - ((((absorbances1.x * depths1.x) * depths1.x) * depths1.x) * depths1.x);
    float front_6 = front_5 + ((z > depths1.y) ? absorbances1.y : 0.0);
    if (depths1.y == z) {
        local_5 = absorbances1.y == absorbance_1;
    } else {
        local_5 = false;
    }
    bool _e293 = local_5;
    float in_core_6 = _e293 ? 1.0 : in_core_5;
    float count_6 = count_5 - ((absorbances1.y > 0.0) ? 1.0 : 0.0);
    float rest0_6 = rest0_5 - absorbances1.y;
    float rest1_6 = rest1_5 - (absorbances1.y * depths1.y);
    float rest2_6 = rest2_5 - ((absorbances1.y * depths1.y) * depths1.y);
    float rest3_6 = rest3_5 - (((absorbances1.y * depths1.y) * depths1.y) * depths1.y);
    float rest4_6 = rest4_5 - ((((absorbances1.y * depths1.y) * depths1.y) * depths1.y) * depths1.y);
    float front_7 = front_6 + ((z > depths1.z) ? absorbances1.z : 0.0);
    if (depths1.z == z) {
        local_6 = absorbances1.z == absorbance_1;
    } else {
        local_6 = false;
    }
    bool _e346 = local_6;
    float in_core_7 = _e346 ? 1.0 : in_core_6;
    float count_7 = count_6 - ((absorbances1.z > 0.0) ? 1.0 : 0.0);
    float rest0_7 = rest0_6 - absorbances1.z;
    float rest1_7 = rest1_6 - (absorbances1.z * depths1.z);
    float rest2_7 = rest2_6 - ((absorbances1.z * depths1.z) * depths1.z);
    float rest3_7 = rest3_6 - (((absorbances1.z * depths1.z) * depths1.z) * depths1.z);
    float rest4_7 = rest4_6 - ((((absorbances1.z * depths1.z) * depths1.z) * depths1.z) * depths1.z);
    float front_8 = front_7 + ((z > depths1.w) ? absorbances1.w : 0.0);
    if (depths1.w == z) {
        local_7 = absorbances1.w == absorbance_1;
    } else {
        local_7 = false;
    }
    bool _e399 = local_7;
    float in_core_8 = _e399 ? 1.0 : in_core_7;
    float count_8 = count_7 - ((absorbances1.w > 0.0) ? 1.0 : 0.0);
    float rest0_8 = rest0_7 - absorbances1.w;
    float rest1_8 = rest1_7 - (absorbances1.w * depths1.w);
    float rest2_8 = rest2_7 - ((absorbances1.w * depths1.w) * depths1.w);
    float rest3_8 = rest3_7 - (((absorbances1.w * depths1.w) * depths1.w) * depths1.w);
    float rest4_8 = rest4_7 - ((((absorbances1.w * depths1.w) * depths1.w) * depths1.w) * depths1.w);
    float far = (absorbances0.y > 0.0) ? depths0.y : depths0.x;
    float center = 0.5 * (depths0.x + far);
    float half_range = metal::max(0.5 * (far - depths0.x), 0.000015258789);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_8 - (center * rest0_8)) * per_h;
    float moved2 = ((rest2_8 - (center * rest1_8)) - (center * (rest1_8 - (center * rest0_8)))) * (per_h * per_h);
    float moved3 = (((rest3_8 - (center * rest2_8)) - (center * (rest2_8 - (center * rest1_8)))) - (center * ((rest2_8 - (center * rest1_8)) - (center * (rest1_8 - (center * rest0_8)))))) * ((per_h * per_h) * per_h);
    float moved4 = ((((rest4_8 - (center * rest3_8)) - (center * (rest3_8 - (center * rest2_8)))) - (center * ((rest3_8 - (center * rest2_8)) - (center * (rest2_8 - (center * rest1_8)))))) - (center * (((rest3_8 - (center * rest2_8)) - (center * (rest2_8 - (center * rest1_8)))) - (center * ((rest2_8 - (center * rest1_8)) - (center * (rest1_8 - (center * rest0_8)))))))) * (((per_h * per_h) * per_h) * per_h);
    float x_1 = metal::clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_8 == 0.0) ? absorbance_1 : 0.0;
    float tail0 = rest0_8 - removed;
    float tail1 = moved1 - (removed * x_1);
    float tail2 = moved2 - ((removed * x_1) * x_1);
    float tail3 = moved3 - (((removed * x_1) * x_1) * x_1);
    float tail4 = moved4 - ((((removed * x_1) * x_1) * x_1) * x_1);
    float others = count_8 - ((removed > 0.0) ? 1.0 : 0.0);
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
        local_8 = z <= depths0.x;
    } else {
        local_8 = true;
    }
    bool _e679 = local_8;
    float exact_4 = _e679 ? 0.0 : exact_3;
    if (!((others < 2.5))) {
        local_9 = z >= far;
    } else {
        local_9 = true;
    }
    bool _e689 = local_9;
    if (!(_e689)) {
        local_10 = z <= depths0.x;
    } else {
        local_10 = true;
    }
    bool _e696 = local_10;
    if (_e696) {
        float known = metal::min(metal::exp(-((front_8 + (absorbance_of_tail * exact_4)))), 1.0);
        return known;
    }
    metal::float2 _e703 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    if (false) {
        float bounds_noise = ((((((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * 0.00000047683716) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) / (metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001) * metal::max(metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0) * (1.0 - (mean_1 * mean_1)), 0.0000001));
        float most = metal::min(metal::exp(-((front_8 + (absorbance_of_tail * metal::max(_e703.x - bounds_noise, 0.0))))), 1.0);
        float least = metal::min(metal::exp(-((front_8 + (absorbance_of_tail * metal::min(_e703.y + bounds_noise, 1.0))))), 1.0);
        if ((most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float _e872 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e703.x), metal::float4(_e703.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_8)) * _e872;
}

metal::float2 nmt_core_slot(
    uint code_3,
    metal::uint2 steps_2
) {
    float _e4 = nmt_core_depth(steps_2);
    float _e5 = nmt_core_absorbance(steps_2);
    return (code_3 > 0u) ? metal::float2(_e4, _e5) : metal::float2(0.0);
}

float nmt_core_transmittance(
    metal::uint2 steps_3,
    NmtCodes codes_2,
    metal::uint4 core0,
    metal::uint4 core1,
    float n_1,
    float b0_1,
    metal::float4 moments_1
) {
    metal::uint2 _e9 = nmt_core_nearest_steps(core0.x);
    metal::float2 _e10 = nmt_core_slot(core0.x, _e9);
    metal::uint2 _e13 = nmt_core_farthest_steps(core0.y);
    metal::float2 _e14 = nmt_core_slot(core0.y, _e13);
    metal::uint2 _e17 = nmt_core_heavy_steps(core0.z, codes_2);
    metal::float2 _e18 = nmt_core_slot(core0.z, _e17);
    metal::uint2 _e21 = nmt_core_heavy_steps(core0.w, codes_2);
    metal::float2 _e22 = nmt_core_slot(core0.w, _e21);
    metal::uint2 _e25 = nmt_core_heavy_steps(core1.x, codes_2);
    metal::float2 _e26 = nmt_core_slot(core1.x, _e25);
    metal::uint2 _e29 = nmt_core_heavy_steps(core1.y, codes_2);
    metal::float2 _e30 = nmt_core_slot(core1.y, _e29);
    metal::uint2 _e33 = nmt_core_heavy_steps(core1.z, codes_2);
    metal::float2 _e34 = nmt_core_slot(core1.z, _e33);
    metal::uint2 _e37 = nmt_core_heavy_steps(core1.w, codes_2);
    metal::float2 _e38 = nmt_core_slot(core1.w, _e37);
    float _e39 = nmt_core_depth(steps_3);
    float _e40 = nmt_core_absorbance(steps_3);
    float _e61 = nmt_core_weigh(_e39, _e40, metal::float4(_e10.x, _e14.x, _e18.x, _e22.x), metal::float4(_e10.y, _e14.y, _e18.y, _e22.y), metal::float4(_e26.x, _e30.x, _e34.x, _e38.x), metal::float4(_e26.y, _e30.y, _e34.y, _e38.y), n_1, b0_1, moments_1);
    return _e61;
}
metal::uint2 naga_f2u32(metal::float2 value) {
    return static_cast<metal::uint2>(metal::clamp(value, 0.0, 4294967000.0));
}


struct pass2_Input {
    float v_1 [[user(loc0), center_perspective]];
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
, device NmtType14 const& core [[buffer(2)]]
) {
    const Varying in = { position, varyings.v_1, {}, varyings.color };
    float _e3 = frame.v0;
    float _e6 = frame.v1;
    NmtCodes _e7 = nmt_core_codes(_e3, _e6);
    float _e11 = nmt_core_absorbance_of(in.color.w);
    metal::uint2 _e12 = nmt_core_steps(in.v, _e11, _e7);
    metal::uint2 at_1 = naga_f2u32(in.position.xy);
    uint _e20 = frame.width;
    uint first_1 = 4u * ((at_1.y * _e20) + at_1.x);
    metal::float4 sums0 = sums0_texture.read(metal::uint2(at_1), 0);
    metal::float4 sums1 = sums1_texture.read(metal::uint2(at_1), 0);
    metal::float4 moments_2 = metal::float4(sums0.y, sums0.z, sums0.w, sums1.x);
    metal::uint2 _e38 = core[first_1];
    metal::uint2 _e43 = core[first_1 + 1u];
    metal::uint2 _e49 = core[first_1 + 2u];
    metal::uint2 _e54 = core[first_1 + 3u];
    float _e58 = nmt_core_transmittance(_e12, _e7, metal::uint4(_e38, _e43), metal::uint4(_e49, _e54), sums1.y, sums0.x, moments_2);
    float weight = in.color.w * _e58;
    return pass2_Output { metal::float4(weight * in.color.xyz, weight) };
}
