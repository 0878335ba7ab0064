// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 6000, dataset bd56c8a2a9c6d4f460653e7f112f48bcc4cd217bead9bf4934f14f488f930250.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.061e-3, worst 1.000.

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
typedef metal::uint2 NmtType15[1];
struct Varying {
    metal::float4 position;
    float v;
    char _pad2[12];
    metal::float4 color;
};
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(5.4374213, 4.099272, -2.3999908, 0.06732468), metal::float4(-0.30876112, 0.039813306, -0.06825874, 0.09791592), metal::float4(0.11699771, -0.0126477955, 0.009044837, 0.024920827), metal::float4(-0.06984082, -1.4153421, 11.242752, 27.765509)), metal::float4x4(metal::float4(2.1031263, -18.205357, 11.592584, -24.416697), metal::float4(0.68829197, -3.5122368, 5.105146, 3.1200283), metal::float4(1.2533448, 11.688712, 1.1489722, 1.8796386), metal::float4(-0.7433028, -1.2973337, -3.0665278, 1.5641073)), metal::float4x4(metal::float4(-0.3011667, -40.251568, -5.629344, -0.5443934), metal::float4(3.0883026, 6.4341197, -0.02780485, -3.0386043), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-6.0495343, 1.8236239, 3.2971628, 6.976045), metal::float4(0.14396286, -0.10366543, -0.19931847, -0.073501945), metal::float4(0.045301538, 1.5944515, 0.024680262, 0.024978848), metal::float4(-11.065943, -0.46564764, -302.25082, 6.2804327)), metal::float4x4(metal::float4(6.5376883, 1.4367918, 4.3187885, -3.8740258), metal::float4(10.118008, -3.1108778, 4.2425604, -2.354306), metal::float4(-8.242886, 1.7415371, 2.897262, -0.57454836), metal::float4(-8.166772, 0.504575, -6.560604, 0.8390675)), metal::float4x4(metal::float4(-11.040061, 0.82958007, -1.1059247, 10.712579), metal::float4(-0.35051835, -4.799316, 1.6909233, 2.4979432), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(3.3376653, -0.38297144, -2.2952204, 7.0122256), metal::float4(-0.19583838, -0.21951479, -0.04405034, 0.040380068), metal::float4(-0.013765891, 0.11841442, -0.16300689, 0.03734604), metal::float4(-31.77642, -70.86214, -5.6645384, 2.3562365)), metal::float4x4(metal::float4(-24.84731, -5.8407044, 0.8097388, -3.0066211), metal::float4(-3.5153785, -10.087853, -8.900696, -9.773681), metal::float4(1.4137939, -7.7516947, -8.073735, 0.110253155), metal::float4(0.11317725, 11.804854, 12.301212, 3.7292614)), metal::float4x4(metal::float4(9.362567, 11.713174, -0.49722984, -0.009957121), metal::float4(2.1004505, -2.2335987, 0.8774605, 4.5194054), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-14.200476, 11.250799, -3.614167, -2.746474), metal::float4(0.005306553, 2.6359544, -2.3081715, -0.22634201), metal::float4(-0.0017052869, 0.11265119, 1.0070869, 0.25444132), metal::float4(-0.021890452, -108.46809, -2.2514987, 7.211717)), metal::float4x4(metal::float4(-0.06271778, -0.07305096, -5.558425, 5.7747507), metal::float4(-0.033172604, -6.5932364, -0.5465898, -2.1271129), metal::float4(0.04429119, 19.870779, -1.9174488, -10.829139), metal::float4(0.039593868, -3.3658838, 0.62879133, 9.388285)), metal::float4x4(metal::float4(-0.020906946, 0.5016997, -1.60396, 3.9739897), metal::float4(-14.116647, -5.6320314, 0.11533172, -2.244007), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(2.3758276, 0.7344675, -9.42585, -1.7282971), metal::float4(0.11907535, -0.6181794, -0.72843254, -0.2958274), metal::float4(-0.21814533, 0.07219827, -0.23492429, 0.058244046), metal::float4(-124.99927, -59.562664, -0.5356338, 10.4820795)), metal::float4x4(metal::float4(-21.341158, -9.852887, -0.06728689, -32.79679), metal::float4(-2.306273, -1.9161882, 0.07075858, 10.962963), metal::float4(5.05221, 6.1378217, -0.35156924, -16.601978), metal::float4(0.60254544, -3.0944357, 0.07379391, -12.189142)), metal::float4x4(metal::float4(-4.0926666, 5.6984234, -0.10884648, 0.5172278), metal::float4(6.597823, -1.295542, -10.24747, 2.0605915), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-11.041016, -1.727267, -13.253658, -5.3044567), metal::float4(-0.08233529, 0.28346556, 0.11086188, 0.033272017), metal::float4(0.17816567, -0.36862642, -0.00985248, 0.18185203), metal::float4(4.587747, 38.25356, 0.92788625, 8.650902)), metal::float4x4(metal::float4(-2.0548725, -201.86287, -0.0065434664, -1.6800108), metal::float4(-0.43485776, 1.1749663, 0.19468619, 8.001372), metal::float4(2.110869, -170.5215, -0.15174873, -4.467283), metal::float4(-0.16220906, 0.7012172, 0.0644586, -6.989527)), metal::float4x4(metal::float4(-0.5775319, -1.6356709, -0.18584095, 1.5081521), metal::float4(-10.046028, 2.7278986, -12.654014, -2.4023314), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-5.0406375, 4.139162, 0.09449681, -2.6226003), metal::float4(-0.10544489, 0.12420155, 0.0846088, -0.2773238), metal::float4(-0.22284019, -0.23321922, 0.13458256, -0.017866516), metal::float4(26.932327, 17.52416, -10.881321, -10.78837)), metal::float4x4(metal::float4(-27.125784, -8.781659, -3.0741816, 3.4798355), metal::float4(4.148134, -4.233007, -9.016876, 4.16812), metal::float4(-16.758512, -5.822711, 4.054722, 5.8445425), metal::float4(0.27446285, 4.334256, 12.806946, -1.8126884)), metal::float4x4(metal::float4(0.42796925, 8.407661, 0.06883113, -14.229925), metal::float4(2.672512, 1.2197539, -1.8344728, 2.8224165), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.9830742, 8.944236, -1.1504629, -4.3265924), metal::float4(-0.023475759, -0.15907055, -0.42637935, 0.11589328), metal::float4(0.041950222, -0.21535935, -0.07122723, 0.15908366), metal::float4(-101.51232, 0.34831, 0.77278036, 26.464895)), metal::float4x4(metal::float4(0.027170673, -2.085998, 8.533334, -19.456049), metal::float4(0.29037327, -5.1486573, 5.737693, 4.954904), metal::float4(7.710748, -2.8508146, -0.92319506, 1.4761099), metal::float4(2.0909944, -5.1753078, -1.1685946, -3.2550154)), metal::float4x4(metal::float4(0.6073655, 0.680405, 0.752367, -5.182517), metal::float4(-0.7346928, 3.5099447, -2.367339, -1.9820573), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(0.5612714, -0.8052822, 1.9578358, 0.7541197), metal::float4(-3.0509675, -0.8913338, -2.0507882, 0.08210287), metal::float4(-1.8096141, -4.047719, -0.87021947, -0.5095532), metal::float4(-1.7694044, -2.431335, -3.985533, 2.5685859)), metal::float4x4(metal::float4(0.00018819174, -1.6301407, -0.8177756, 0.8410233), metal::float4(-0.18867442, -0.14180064, 0.23432782, 1.1939652), metal::float4(-0.28679964, 4.192852, -0.15248433, 0.10820271), metal::float4(-0.5148806, 0.57227784, -3.5086772, -0.8603132)), metal::float4x4(metal::float4(-0.057861097, 1.2268503, -4.9752107, 0.97435975), metal::float4(-0.10037012, 1.4835347, -2.708487, 0.22378573), metal::float4(-0.26280734, 1.1496403, 0.24401025, -0.12223057), metal::float4(0.9853024, 1.2418171, -0.027950218, -0.84020066)), metal::float4x4(metal::float4(29.311577, 5.1649904, -7.3978987, 38.205784), metal::float4(-0.13957557, -0.39724877, -0.57345605, 0.16402759), metal::float4(0.44155926, 0.59527594, 1.1621081, 0.8841033), metal::float4(-0.75949806, -1.1115868, -0.1917119, 0.35651338)), metal::float4x4(metal::float4(1.55433, 0.57734424, 0.4066175, -0.38792506), metal::float4(-0.28983963, -2.51321, -1.8156649, -0.5273519), metal::float4(20.610762, 10.519593, 4.2690234, 35.395996), metal::float4(-0.06966489, -1.7839004, -4.118357, -0.66634846)), metal::float4x4(metal::float4(-0.0768172, -0.90769356, -0.76780784, 1.6518021), metal::float4(-3.379264, -10.539941, -16.59533, -2.8945174), metal::float4(3.7318642, 1.2683077, 0.5771581, 5.465723), metal::float4(-0.34995794, -2.0756266, -0.71379185, 1.1416491)), metal::float4x4(metal::float4(-0.063372806, 1.2796607, 1.2495276, 2.0932581), metal::float4(-0.80130994, -3.971518, 0.8077129, 0.61369365), metal::float4(0.006266941, -2.1069548, -1.4359239, 0.20941292), metal::float4(0.17255613, -6.439542, -0.43115193, -0.3608885)), metal::float4x4(metal::float4(0.20230684, 1.3585289, 1.690652, 0.30478713), metal::float4(-0.2972322, 0.5015593, -3.7431738, -0.15872914), metal::float4(-0.063379474, -1.8211364, -0.5723202, -1.0097622), metal::float4(1.6373553, 5.8172894, 2.0908377, -0.12513334)), metal::float4x4(metal::float4(4.432494, -1.0324867, 0.15783006, -0.19616091), metal::float4(-1.0922611, 0.80809677, -0.4039501, -0.17652889), metal::float4(0.14157669, 0.91334754, -0.5151216, -0.50741524), metal::float4(-11.98909, -0.6244048, -0.29388586, -0.9342302)), metal::float4x4(metal::float4(-1.192838, -0.59448165, -0.5513403, 0.22779986), metal::float4(0.32817048, -0.0049283956, -0.3480491, -0.09889783), metal::float4(-1.6917663, -0.28460243, 0.22333966, 1.7914547), metal::float4(-2.6235445, 0.3005778, -0.55614203, 0.3724611)), metal::float4x4(metal::float4(1.455877, 0.4335604, -0.4377843, 0.99129975), metal::float4(1.41245, -0.18254372, 0.20757042, -0.0055713546), metal::float4(-0.48564953, 0.20124733, 0.0506122, -0.7202818), metal::float4(0.3632785, 1.0082462, -0.3909515, 0.14880356)), metal::float4x4(metal::float4(34.768063, -7.8861685, 0.14344464, 110.397125), metal::float4(-1.2552068, -0.7247046, -0.13631397, -0.745887), metal::float4(-1.7309783, 0.50249267, -0.22249134, 0.49455148), metal::float4(-3.3301651, -0.11269005, -0.26882094, -0.3997913)), metal::float4x4(metal::float4(-0.63325346, -0.23269548, 0.03240724, -0.24410391), metal::float4(-0.56117594, -1.0841293, -0.33914873, -1.479392), metal::float4(21.043505, -9.559243, 0.2872074, 75.28369), metal::float4(1.6869254, -3.9069245, 0.037293382, -1.0802398)), metal::float4x4(metal::float4(1.1544132, -0.9880814, -0.20143014, -1.0886188), metal::float4(-9.796492, -1.5660758, 0.031343132, -7.743226), metal::float4(4.532845, -0.99818444, -0.35377118, -1.7958479), metal::float4(-0.08037113, -0.53063697, -0.030638263, 0.17173046)), metal::float4x4(metal::float4(-2.2670875, 1.5502144, -0.13599676, 0.6596191), metal::float4(-0.39481798, 0.25847867, -0.106472634, -1.1384745), metal::float4(-1.612787, -0.55916464, -0.22542503, -0.8191134), metal::float4(-1.0800495, -0.92530394, -0.141488, -0.7818429)), metal::float4x4(metal::float4(0.91121244, 0.13503289, -0.3357986, -0.49670896), metal::float4(-1.6732597, 1.6311814, -0.03868916, 0.08786737), metal::float4(-2.7890007, -0.8569007, -0.17694147, -0.78453374), metal::float4(-1.2615094, -0.31259876, -0.15151915, 1.4896415)), metal::float4x4(metal::float4(-0.13391794, -0.891611, -0.60111266, 0.18036509), metal::float4(-45.253212, -2.0789275, -55.56758, -0.24589449), metal::float4(-0.94204605, -4.857143, 0.773831, -0.33291525), metal::float4(-20.090935, -0.78326464, 2.4229555, 0.09803279)), metal::float4x4(metal::float4(3.1258688, 3.3962352, -0.3281802, -0.58999366), metal::float4(-0.50923795, 0.3633625, -0.17792912, -0.26248187), metal::float4(0.87033373, 0.18452893, -0.050617557, -0.67375934), metal::float4(-0.14110301, -0.014655196, 0.44809416, -0.26554093)), metal::float4x4(metal::float4(-0.5455171, 1.0173776, 0.915084, -0.17738713), metal::float4(-4.9446936, 0.19119684, -0.84807664, -0.281693), metal::float4(4.4927692, -1.2343456, 0.28497058, -0.19485503), metal::float4(0.87839663, -0.106170714, -2.096666, -0.46047825)), metal::float4x4(metal::float4(-3.0281644, -21.505493, -64.173225, -0.22722849), metal::float4(-26.211569, 0.016989341, 1.0031826, -0.14194465), metal::float4(0.38507217, 0.9351074, -0.0777235, -0.41040322), metal::float4(1.0386806, -0.18513341, 1.3027041, -0.24041142)), metal::float4x4(metal::float4(0.22283384, 2.367998, -1.4081047, -0.15789123), metal::float4(-2.3488436, -0.09097922, -0.005557982, -0.3844968), metal::float4(-25.454828, -30.255812, -68.86, -0.22142246), metal::float4(0.9135177, 0.12279967, -27.964146, -0.17632717)), metal::float4x4(metal::float4(1.1946952, -1.5483994, -1.7453567, 0.2640197), metal::float4(-10.479829, -0.065224044, -6.247429, 0.09248742), metal::float4(-0.22627845, -6.987417, -8.7303, -0.24033648), metal::float4(0.5106705, 0.21911664, -0.14479464, -0.05997175)), metal::float4x4(metal::float4(-1.0584769, -0.76991665, 0.35826787, 0.2570622), metal::float4(-38.088936, 0.9563952, -10.26186, -0.012669509), metal::float4(-1.8953276, 1.3880517, 2.193768, -0.47001857), metal::float4(-1.6761823, 0.29450762, 0.62701017, -0.20249395)), metal::float4x4(metal::float4(2.902732, 0.4166712, 0.2856457, -0.086941235), metal::float4(-0.9827138, -0.21861658, -1.2146354, -0.12214594), metal::float4(-2.7559738, -1.0897014, 0.20467448, -0.1411117), metal::float4(-1.0689127, -2.4455764, -1.3695912, -0.51198465)), metal::float4x4(metal::float4(0.81078166, -0.4044338, 2.720114, -0.018226687), metal::float4(2.3581884, 1.6104178, -4.943122, -0.75195354), metal::float4(-0.3908668, 1.0078644, -1.1918337, -0.14066498), metal::float4(-1.492688, -4.646078, 1.8119683, -0.52144)), metal::float4x4(metal::float4(-1.1722519, 0.9783798, -0.01346622, -1.4579939), metal::float4(-1.8240347, 0.76718897, -1.1876087, -0.013630305), metal::float4(2.17518, 0.035115838, -1.155891, 0.3128857), metal::float4(-2.617839, 0.21239686, -1.7636377, -0.13492033)), metal::float4x4(metal::float4(0.8584923, 0.410397, -4.2714176, -0.6748531), metal::float4(-0.21329014, -0.23891681, 2.2193787, -1.5731057), metal::float4(-0.9720868, 0.017681163, -3.4190187, -0.47943452), metal::float4(-0.61413044, 0.50284374, 0.7826973, 0.70128167)), metal::float4x4(metal::float4(-21.171513, 26.865187, -34.713753, 30.892735), metal::float4(0.64165086, -0.961954, -2.718338, -1.7435387), metal::float4(0.6778252, 1.7303016, 0.32805926, 0.58119136), metal::float4(-0.31990194, -0.74946654, 1.1855053, -0.5359104)), metal::float4x4(metal::float4(-0.5938348, -0.2984739, 2.1709085, 0.7654855), metal::float4(-1.3230438, -0.21147202, 2.9178054, 0.84411603), metal::float4(-3.8531673, 14.801703, -33.84283, 32.70362), metal::float4(0.7274438, 0.19319296, -2.167876, -2.0092883)), metal::float4x4(metal::float4(-2.0672529, 1.5651822, 4.6140957, -4.5149217), metal::float4(0.85987955, -20.381807, -4.8222675, 6.1487484), metal::float4(-11.035366, 2.083262, 9.291252, 18.810875), metal::float4(1.0576226, -0.83874434, 0.3078845, -0.061636534)), metal::float4x4(metal::float4(1.2366849, -0.12529887, 1.47252, 0.15226749), metal::float4(3.912004, -0.6518246, 1.4097291, -0.3996969), metal::float4(1.3647116, -0.7544857, 2.0510762, -3.3437326), metal::float4(0.4689717, -1.8347169, 3.3225002, -1.0843767)), metal::float4x4(metal::float4(-1.1071062, -0.18258168, -1.8788732, -0.4204919), metal::float4(0.29666585, -1.5362499, 1.769943, 0.34129623), metal::float4(-12.318685, 2.4055486, 0.08319975, 0.4437303), metal::float4(-1.6225735, -2.517713, 0.03564834, -0.37749812))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(8.4412, 3.6170914, 6.4581738, 4.2712755), metal::float4(0.41956437, 2.4876723, -0.15839966, -0.114488125), metal::float4(-5.21652, -5.002616, -4.8846345, -0.22173963), metal::float4(-10.75025, -5.905891, -18.288715, 1.4138744)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.19069599, 0.24618374, 0.13081251, -0.18281528), metal::float4(0.22839579, 0.10921503, 0.2918631, -0.2877968), metal::float4(0.13975196, 0.11612862, 0.10460415, -0.06111151), metal::float4(0.074991226, 0.112442635, 0.089019135, -0.1614554)}};
constant float NMT_B3 = -1.8172282;
constant uint NMT_DEPTH_BITS = 16u;
constant uint NMT_OCTAVE_BITS = 11u;
constant uint NMT_HEAVY = 4u;
constant uint NMT_SLOTS = 6u;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(5.4374213, 4.099272, -2.3999908, 0.06732468), metal::float4(-0.30876112, 0.039813306, -0.06825874, 0.09791592), metal::float4(0.11699771, -0.0126477955, 0.009044837, 0.024920827), metal::float4(-0.06984082, -1.4153421, 11.242752, 27.765509)) * h0_0) + (metal::float4x4(metal::float4(2.1031263, -18.205357, 11.592584, -24.416697), metal::float4(0.68829197, -3.5122368, 5.105146, 3.1200283), metal::float4(1.2533448, 11.688712, 1.1489722, 1.8796386), metal::float4(-0.7433028, -1.2973337, -3.0665278, 1.5641073)) * h0_1)) + (metal::float4x4(metal::float4(-0.3011667, -40.251568, -5.629344, -0.5443934), metal::float4(3.0883026, 6.4341197, -0.02780485, -3.0386043), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-6.0495343, 1.8236239, 3.2971628, 6.976045), metal::float4(0.14396286, -0.10366543, -0.19931847, -0.073501945), metal::float4(0.045301538, 1.5944515, 0.024680262, 0.024978848), metal::float4(-11.065943, -0.46564764, -302.25082, 6.2804327)) * h0_0) + (metal::float4x4(metal::float4(6.5376883, 1.4367918, 4.3187885, -3.8740258), metal::float4(10.118008, -3.1108778, 4.2425604, -2.354306), metal::float4(-8.242886, 1.7415371, 2.897262, -0.57454836), metal::float4(-8.166772, 0.504575, -6.560604, 0.8390675)) * h0_1)) + (metal::float4x4(metal::float4(-11.040061, 0.82958007, -1.1059247, 10.712579), metal::float4(-0.35051835, -4.799316, 1.6909233, 2.4979432), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(3.3376653, -0.38297144, -2.2952204, 7.0122256), metal::float4(-0.19583838, -0.21951479, -0.04405034, 0.040380068), metal::float4(-0.013765891, 0.11841442, -0.16300689, 0.03734604), metal::float4(-31.77642, -70.86214, -5.6645384, 2.3562365)) * h0_0) + (metal::float4x4(metal::float4(-24.84731, -5.8407044, 0.8097388, -3.0066211), metal::float4(-3.5153785, -10.087853, -8.900696, -9.773681), metal::float4(1.4137939, -7.7516947, -8.073735, 0.110253155), metal::float4(0.11317725, 11.804854, 12.301212, 3.7292614)) * h0_1)) + (metal::float4x4(metal::float4(9.362567, 11.713174, -0.49722984, -0.009957121), metal::float4(2.1004505, -2.2335987, 0.8774605, 4.5194054), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-14.200476, 11.250799, -3.614167, -2.746474), metal::float4(0.005306553, 2.6359544, -2.3081715, -0.22634201), metal::float4(-0.0017052869, 0.11265119, 1.0070869, 0.25444132), metal::float4(-0.021890452, -108.46809, -2.2514987, 7.211717)) * h0_0) + (metal::float4x4(metal::float4(-0.06271778, -0.07305096, -5.558425, 5.7747507), metal::float4(-0.033172604, -6.5932364, -0.5465898, -2.1271129), metal::float4(0.04429119, 19.870779, -1.9174488, -10.829139), metal::float4(0.039593868, -3.3658838, 0.62879133, 9.388285)) * h0_1)) + (metal::float4x4(metal::float4(-0.020906946, 0.5016997, -1.60396, 3.9739897), metal::float4(-14.116647, -5.6320314, 0.11533172, -2.244007), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(2.3758276, 0.7344675, -9.42585, -1.7282971), metal::float4(0.11907535, -0.6181794, -0.72843254, -0.2958274), metal::float4(-0.21814533, 0.07219827, -0.23492429, 0.058244046), metal::float4(-124.99927, -59.562664, -0.5356338, 10.4820795)) * h0_0) + (metal::float4x4(metal::float4(-21.341158, -9.852887, -0.06728689, -32.79679), metal::float4(-2.306273, -1.9161882, 0.07075858, 10.962963), metal::float4(5.05221, 6.1378217, -0.35156924, -16.601978), metal::float4(0.60254544, -3.0944357, 0.07379391, -12.189142)) * h0_1)) + (metal::float4x4(metal::float4(-4.0926666, 5.6984234, -0.10884648, 0.5172278), metal::float4(6.597823, -1.295542, -10.24747, 2.0605915), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-11.041016, -1.727267, -13.253658, -5.3044567), metal::float4(-0.08233529, 0.28346556, 0.11086188, 0.033272017), metal::float4(0.17816567, -0.36862642, -0.00985248, 0.18185203), metal::float4(4.587747, 38.25356, 0.92788625, 8.650902)) * h0_0) + (metal::float4x4(metal::float4(-2.0548725, -201.86287, -0.0065434664, -1.6800108), metal::float4(-0.43485776, 1.1749663, 0.19468619, 8.001372), metal::float4(2.110869, -170.5215, -0.15174873, -4.467283), metal::float4(-0.16220906, 0.7012172, 0.0644586, -6.989527)) * h0_1)) + (metal::float4x4(metal::float4(-0.5775319, -1.6356709, -0.18584095, 1.5081521), metal::float4(-10.046028, 2.7278986, -12.654014, -2.4023314), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-5.0406375, 4.139162, 0.09449681, -2.6226003), metal::float4(-0.10544489, 0.12420155, 0.0846088, -0.2773238), metal::float4(-0.22284019, -0.23321922, 0.13458256, -0.017866516), metal::float4(26.932327, 17.52416, -10.881321, -10.78837)) * h0_0) + (metal::float4x4(metal::float4(-27.125784, -8.781659, -3.0741816, 3.4798355), metal::float4(4.148134, -4.233007, -9.016876, 4.16812), metal::float4(-16.758512, -5.822711, 4.054722, 5.8445425), metal::float4(0.27446285, 4.334256, 12.806946, -1.8126884)) * h0_1)) + (metal::float4x4(metal::float4(0.42796925, 8.407661, 0.06883113, -14.229925), metal::float4(2.672512, 1.2197539, -1.8344728, 2.8224165), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(0.9830742, 8.944236, -1.1504629, -4.3265924), metal::float4(-0.023475759, -0.15907055, -0.42637935, 0.11589328), metal::float4(0.041950222, -0.21535935, -0.07122723, 0.15908366), metal::float4(-101.51232, 0.34831, 0.77278036, 26.464895)) * h0_0) + (metal::float4x4(metal::float4(0.027170673, -2.085998, 8.533334, -19.456049), metal::float4(0.29037327, -5.1486573, 5.737693, 4.954904), metal::float4(7.710748, -2.8508146, -0.92319506, 1.4761099), metal::float4(2.0909944, -5.1753078, -1.1685946, -3.2550154)) * h0_1)) + (metal::float4x4(metal::float4(0.6073655, 0.680405, 0.752367, -5.182517), metal::float4(-0.7346928, 3.5099447, -2.367339, -1.9820573), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(8.4412, 3.6170914, 6.4581738, 4.2712755) + (metal::float4x4(metal::float4(0.5612714, -0.8052822, 1.9578358, 0.7541197), metal::float4(-3.0509675, -0.8913338, -2.0507882, 0.08210287), metal::float4(-1.8096141, -4.047719, -0.87021947, -0.5095532), metal::float4(-1.7694044, -2.431335, -3.985533, 2.5685859)) * h1_0)) + (metal::float4x4(metal::float4(0.00018819174, -1.6301407, -0.8177756, 0.8410233), metal::float4(-0.18867442, -0.14180064, 0.23432782, 1.1939652), metal::float4(-0.28679964, 4.192852, -0.15248433, 0.10820271), metal::float4(-0.5148806, 0.57227784, -3.5086772, -0.8603132)) * h1_1)) + (metal::float4x4(metal::float4(-0.057861097, 1.2268503, -4.9752107, 0.97435975), metal::float4(-0.10037012, 1.4835347, -2.708487, 0.22378573), metal::float4(-0.26280734, 1.1496403, 0.24401025, -0.12223057), metal::float4(0.9853024, 1.2418171, -0.027950218, -0.84020066)) * h1_2)) + (metal::float4x4(metal::float4(29.311577, 5.1649904, -7.3978987, 38.205784), metal::float4(-0.13957557, -0.39724877, -0.57345605, 0.16402759), metal::float4(0.44155926, 0.59527594, 1.1621081, 0.8841033), metal::float4(-0.75949806, -1.1115868, -0.1917119, 0.35651338)) * h1_3)) + (metal::float4x4(metal::float4(1.55433, 0.57734424, 0.4066175, -0.38792506), metal::float4(-0.28983963, -2.51321, -1.8156649, -0.5273519), metal::float4(20.610762, 10.519593, 4.2690234, 35.395996), metal::float4(-0.06966489, -1.7839004, -4.118357, -0.66634846)) * h1_4)) + (metal::float4x4(metal::float4(-0.0768172, -0.90769356, -0.76780784, 1.6518021), metal::float4(-3.379264, -10.539941, -16.59533, -2.8945174), metal::float4(3.7318642, 1.2683077, 0.5771581, 5.465723), metal::float4(-0.34995794, -2.0756266, -0.71379185, 1.1416491)) * h1_5)) + (metal::float4x4(metal::float4(-0.063372806, 1.2796607, 1.2495276, 2.0932581), metal::float4(-0.80130994, -3.971518, 0.8077129, 0.61369365), metal::float4(0.006266941, -2.1069548, -1.4359239, 0.20941292), metal::float4(0.17255613, -6.439542, -0.43115193, -0.3608885)) * h1_6)) + (metal::float4x4(metal::float4(0.20230684, 1.3585289, 1.690652, 0.30478713), metal::float4(-0.2972322, 0.5015593, -3.7431738, -0.15872914), metal::float4(-0.063379474, -1.8211364, -0.5723202, -1.0097622), metal::float4(1.6373553, 5.8172894, 2.0908377, -0.12513334)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(0.41956437, 2.4876723, -0.15839966, -0.114488125) + (metal::float4x4(metal::float4(4.432494, -1.0324867, 0.15783006, -0.19616091), metal::float4(-1.0922611, 0.80809677, -0.4039501, -0.17652889), metal::float4(0.14157669, 0.91334754, -0.5151216, -0.50741524), metal::float4(-11.98909, -0.6244048, -0.29388586, -0.9342302)) * h1_0)) + (metal::float4x4(metal::float4(-1.192838, -0.59448165, -0.5513403, 0.22779986), metal::float4(0.32817048, -0.0049283956, -0.3480491, -0.09889783), metal::float4(-1.6917663, -0.28460243, 0.22333966, 1.7914547), metal::float4(-2.6235445, 0.3005778, -0.55614203, 0.3724611)) * h1_1)) + (metal::float4x4(metal::float4(1.455877, 0.4335604, -0.4377843, 0.99129975), metal::float4(1.41245, -0.18254372, 0.20757042, -0.0055713546), metal::float4(-0.48564953, 0.20124733, 0.0506122, -0.7202818), metal::float4(0.3632785, 1.0082462, -0.3909515, 0.14880356)) * h1_2)) + (metal::float4x4(metal::float4(34.768063, -7.8861685, 0.14344464, 110.397125), metal::float4(-1.2552068, -0.7247046, -0.13631397, -0.745887), metal::float4(-1.7309783, 0.50249267, -0.22249134, 0.49455148), metal::float4(-3.3301651, -0.11269005, -0.26882094, -0.3997913)) * h1_3)) + (metal::float4x4(metal::float4(-0.63325346, -0.23269548, 0.03240724, -0.24410391), metal::float4(-0.56117594, -1.0841293, -0.33914873, -1.479392), metal::float4(21.043505, -9.559243, 0.2872074, 75.28369), metal::float4(1.6869254, -3.9069245, 0.037293382, -1.0802398)) * h1_4)) + (metal::float4x4(metal::float4(1.1544132, -0.9880814, -0.20143014, -1.0886188), metal::float4(-9.796492, -1.5660758, 0.031343132, -7.743226), metal::float4(4.532845, -0.99818444, -0.35377118, -1.7958479), metal::float4(-0.08037113, -0.53063697, -0.030638263, 0.17173046)) * h1_5)) + (metal::float4x4(metal::float4(-2.2670875, 1.5502144, -0.13599676, 0.6596191), metal::float4(-0.39481798, 0.25847867, -0.106472634, -1.1384745), metal::float4(-1.612787, -0.55916464, -0.22542503, -0.8191134), metal::float4(-1.0800495, -0.92530394, -0.141488, -0.7818429)) * h1_6)) + (metal::float4x4(metal::float4(0.91121244, 0.13503289, -0.3357986, -0.49670896), metal::float4(-1.6732597, 1.6311814, -0.03868916, 0.08786737), metal::float4(-2.7890007, -0.8569007, -0.17694147, -0.78453374), metal::float4(-1.2615094, -0.31259876, -0.15151915, 1.4896415)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-5.21652, -5.002616, -4.8846345, -0.22173963) + (metal::float4x4(metal::float4(-0.13391794, -0.891611, -0.60111266, 0.18036509), metal::float4(-45.253212, -2.0789275, -55.56758, -0.24589449), metal::float4(-0.94204605, -4.857143, 0.773831, -0.33291525), metal::float4(-20.090935, -0.78326464, 2.4229555, 0.09803279)) * h1_0)) + (metal::float4x4(metal::float4(3.1258688, 3.3962352, -0.3281802, -0.58999366), metal::float4(-0.50923795, 0.3633625, -0.17792912, -0.26248187), metal::float4(0.87033373, 0.18452893, -0.050617557, -0.67375934), metal::float4(-0.14110301, -0.014655196, 0.44809416, -0.26554093)) * h1_1)) + (metal::float4x4(metal::float4(-0.5455171, 1.0173776, 0.915084, -0.17738713), metal::float4(-4.9446936, 0.19119684, -0.84807664, -0.281693), metal::float4(4.4927692, -1.2343456, 0.28497058, -0.19485503), metal::float4(0.87839663, -0.106170714, -2.096666, -0.46047825)) * h1_2)) + (metal::float4x4(metal::float4(-3.0281644, -21.505493, -64.173225, -0.22722849), metal::float4(-26.211569, 0.016989341, 1.0031826, -0.14194465), metal::float4(0.38507217, 0.9351074, -0.0777235, -0.41040322), metal::float4(1.0386806, -0.18513341, 1.3027041, -0.24041142)) * h1_3)) + (metal::float4x4(metal::float4(0.22283384, 2.367998, -1.4081047, -0.15789123), metal::float4(-2.3488436, -0.09097922, -0.005557982, -0.3844968), metal::float4(-25.454828, -30.255812, -68.86, -0.22142246), metal::float4(0.9135177, 0.12279967, -27.964146, -0.17632717)) * h1_4)) + (metal::float4x4(metal::float4(1.1946952, -1.5483994, -1.7453567, 0.2640197), metal::float4(-10.479829, -0.065224044, -6.247429, 0.09248742), metal::float4(-0.22627845, -6.987417, -8.7303, -0.24033648), metal::float4(0.5106705, 0.21911664, -0.14479464, -0.05997175)) * h1_5)) + (metal::float4x4(metal::float4(-1.0584769, -0.76991665, 0.35826787, 0.2570622), metal::float4(-38.088936, 0.9563952, -10.26186, -0.012669509), metal::float4(-1.8953276, 1.3880517, 2.193768, -0.47001857), metal::float4(-1.6761823, 0.29450762, 0.62701017, -0.20249395)) * h1_6)) + (metal::float4x4(metal::float4(2.902732, 0.4166712, 0.2856457, -0.086941235), metal::float4(-0.9827138, -0.21861658, -1.2146354, -0.12214594), metal::float4(-2.7559738, -1.0897014, 0.20467448, -0.1411117), metal::float4(-1.0689127, -2.4455764, -1.3695912, -0.51198465)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-10.75025, -5.905891, -18.288715, 1.4138744) + (metal::float4x4(metal::float4(0.81078166, -0.4044338, 2.720114, -0.018226687), metal::float4(2.3581884, 1.6104178, -4.943122, -0.75195354), metal::float4(-0.3908668, 1.0078644, -1.1918337, -0.14066498), metal::float4(-1.492688, -4.646078, 1.8119683, -0.52144)) * h1_0)) + (metal::float4x4(metal::float4(-1.1722519, 0.9783798, -0.01346622, -1.4579939), metal::float4(-1.8240347, 0.76718897, -1.1876087, -0.013630305), metal::float4(2.17518, 0.035115838, -1.155891, 0.3128857), metal::float4(-2.617839, 0.21239686, -1.7636377, -0.13492033)) * h1_1)) + (metal::float4x4(metal::float4(0.8584923, 0.410397, -4.2714176, -0.6748531), metal::float4(-0.21329014, -0.23891681, 2.2193787, -1.5731057), metal::float4(-0.9720868, 0.017681163, -3.4190187, -0.47943452), metal::float4(-0.61413044, 0.50284374, 0.7826973, 0.70128167)) * h1_2)) + (metal::float4x4(metal::float4(-21.171513, 26.865187, -34.713753, 30.892735), metal::float4(0.64165086, -0.961954, -2.718338, -1.7435387), metal::float4(0.6778252, 1.7303016, 0.32805926, 0.58119136), metal::float4(-0.31990194, -0.74946654, 1.1855053, -0.5359104)) * h1_3)) + (metal::float4x4(metal::float4(-0.5938348, -0.2984739, 2.1709085, 0.7654855), metal::float4(-1.3230438, -0.21147202, 2.9178054, 0.84411603), metal::float4(-3.8531673, 14.801703, -33.84283, 32.70362), metal::float4(0.7274438, 0.19319296, -2.167876, -2.0092883)) * h1_4)) + (metal::float4x4(metal::float4(-2.0672529, 1.5651822, 4.6140957, -4.5149217), metal::float4(0.85987955, -20.381807, -4.8222675, 6.1487484), metal::float4(-11.035366, 2.083262, 9.291252, 18.810875), metal::float4(1.0576226, -0.83874434, 0.3078845, -0.061636534)) * h1_5)) + (metal::float4x4(metal::float4(1.2366849, -0.12529887, 1.47252, 0.15226749), metal::float4(3.912004, -0.6518246, 1.4097291, -0.3996969), metal::float4(1.3647116, -0.7544857, 2.0510762, -3.3437326), metal::float4(0.4689717, -1.8347169, 3.3225002, -1.0843767)) * h1_6)) + (metal::float4x4(metal::float4(-1.1071062, -0.18258168, -1.8788732, -0.4204919), metal::float4(0.29666585, -1.5362499, 1.769943, 0.34129623), metal::float4(-12.318685, 2.4055486, 0.08319975, 0.4437303), metal::float4(-1.6225735, -2.517713, 0.03564834, -0.37749812)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.19069599, 0.24618374, 0.13081251, -0.18281528), h2_0)) + metal::dot(metal::float4(0.22839579, 0.10921503, 0.2918631, -0.2877968), h2_1)) + metal::dot(metal::float4(0.13975196, 0.11612862, 0.10460415, -0.06111151), h2_2)) + metal::dot(metal::float4(0.074991226, 0.112442635, 0.089019135, -0.1614554), h2_3);
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

metal::float3 nmt_core_bounds(
    float x,
    float m1,
    float m2,
    float m3,
    float m4
) {
    float mean = m1 * 0.9999;
    float second = (m2 * 0.9999) + 0.000033333334;
    float third = m3 * 0.9999;
    float fourth = (m4 * 0.9999) + 0.00002;
    float square = mean * mean;
    float variance = metal::max(second - square, 0.0000001);
    float per_deviation = 1.0 / metal::sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = metal::clamp(((third - (mean * ((3.0 * second) - (2.0 * square)))) * per_variance) * per_deviation, -30.0, 30.0);
    float d = metal::clamp(((((fourth - (mean * ((4.0 * third) - (mean * ((6.0 * second) - (3.0 * square)))))) * per_variance) * per_variance) - (skewness * skewness)) - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float per_d = 1.0 / d;
    float q = ((y * (y - skewness)) - 1.0) * per_d;
    float at = 1.0 / ((1.0 + (y * y)) + ((q * q) * d));
    float rest = 1.0 - at;
    float linear = y - (q * skewness);
    float per_root = 1.0 / metal::sqrt(metal::max((linear * linear) - ((4.0 * q) * (1.0 - q)), 0.000000000001));
    float between = metal::clamp(((0.5 * rest) * (1.0 + (linear * per_root))) - (((at * y) * q) * per_root), 0.0, rest);
    float lower = (0.0 > q) ? between : ((y > (0.5 * skewness)) ? rest : 0.0);
    float inner = metal::max(1.0 - second, 0.000001);
    float per_inner = 1.0 / inner;
    float inner_mean = (mean - third) * per_inner;
    float inner_second = (second - fourth) * per_inner;
    float width = metal::max(inner_second - (inner_mean * inner_mean), 0.0000001);
    float place = inner_mean - x;
    float of_inner = width / (width + (place * place));
    float ended = (inner * of_inner) / metal::max(1.0 - (x * x), 0.000001);
    float side = (0.0 > place) ? -1.0 : 1.0;
    float of_fourth = ((inner * (1.0 - of_inner)) * metal::abs(place)) / metal::max((metal::abs(place) + inner_second) - (x * inner_mean), 0.000001);
    float at_end = metal::clamp(0.5 * (((1.0 - (side * mean)) - (ended * (1.0 - (side * x)))) - of_fourth), 0.0, metal::max(1.0 - ended, 0.0));
    float least = (at > ended) ? ((0.0 > place) ? ((1.0 - ended) - at_end) : at_end) : lower;
    float most = (at > ended) ? ended : at;
    return metal::float3(least, least + most, (per_variance * per_variance) * per_d);
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
    float far = (absorbances0.y > 0.0) ? depths0.y : depths0.x;
    float center = 0.5 * (depths0.x + far);
    float half_range = metal::max(0.5 * (far - depths0.x), 0.000015258789);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_6 - (center * rest0_6)) * per_h;
    float moved2 = ((rest2_6 - (center * rest1_6)) - (center * (rest1_6 - (center * rest0_6)))) * (per_h * per_h);
    float moved3 = (((rest3_6 - (center * rest2_6)) - (center * (rest2_6 - (center * rest1_6)))) - (center * ((rest2_6 - (center * rest1_6)) - (center * (rest1_6 - (center * rest0_6)))))) * ((per_h * per_h) * per_h);
    float moved4 = ((((rest4_6 - (center * rest3_6)) - (center * (rest3_6 - (center * rest2_6)))) - (center * ((rest3_6 - (center * rest2_6)) - (center * (rest2_6 - (center * rest1_6)))))) - (center * (((rest3_6 - (center * rest2_6)) - (center * (rest2_6 - (center * rest1_6)))) - (center * ((rest2_6 - (center * rest1_6)) - (center * (rest1_6 - (center * rest0_6)))))))) * (((per_h * per_h) * per_h) * per_h);
    float x_1 = metal::clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_6 == 0.0) ? absorbance_1 : 0.0;
    float tail0 = rest0_6 - removed;
    float tail1 = moved1 - (removed * x_1);
    float tail2 = moved2 - ((removed * x_1) * x_1);
    float tail3 = moved3 - (((removed * x_1) * x_1) * x_1);
    float tail4 = moved4 - ((((removed * x_1) * x_1) * x_1) * x_1);
    float others = count_6 - ((removed > 0.0) ? 1.0 : 0.0);
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
        local_6 = z <= depths0.x;
    } else {
        local_6 = true;
    }
    bool _e573 = local_6;
    float exact_4 = _e573 ? 0.0 : exact_3;
    if (!((others < 2.5))) {
        local_7 = z >= far;
    } else {
        local_7 = true;
    }
    bool _e583 = local_7;
    if (!(_e583)) {
        local_8 = z <= depths0.x;
    } else {
        local_8 = true;
    }
    bool _e590 = local_8;
    if (_e590) {
        float known = metal::min(metal::exp(-((front_6 + (absorbance_of_tail * exact_4)))), 1.0);
        return known;
    }
    metal::float3 _e597 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    if (false) {
        float bounds_noise = (((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * ((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)))) * _e597.z) * 0.000000014901161;
        float most_1 = metal::min(metal::exp(-((front_6 + (absorbance_of_tail * metal::max(_e597.x - bounds_noise, 0.0))))), 1.0);
        float least_1 = metal::min(metal::exp(-((front_6 + (absorbance_of_tail * metal::min(_e597.y + bounds_noise, 1.0))))), 1.0);
        float opacity = 1.0 - metal::exp(-(absorbance_1));
        if ((opacity * (most_1 - least_1)) <= NMT_OPEN) {
            float middle = 0.5 * (most_1 + least_1);
            return middle;
        }
    }
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    float _e733 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e597.x), metal::float4(_e597.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_6)) * _e733;
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
    float _e31 = nmt_core_depth(steps_3);
    float _e32 = nmt_core_absorbance(steps_3);
    float _e53 = nmt_core_weigh(_e31, _e32, metal::float4(_e10.x, _e14.x, _e18.x, _e22.x), metal::float4(_e10.y, _e14.y, _e18.y, _e22.y), metal::float4(_e26.x, _e30.x, 0.0, 0.0), metal::float4(_e26.y, _e30.y, 0.0, 0.0), n_1, b0_1, moments_1);
    return _e53;
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
, device NmtType15 const& core [[buffer(2)]]
) {
    const Varying in = { position, varyings.v_1, {}, varyings.color };
    float _e3 = frame.v0;
    float _e6 = frame.v1;
    NmtCodes _e7 = nmt_core_codes(_e3, _e6);
    float _e11 = nmt_core_absorbance_of(in.color.w);
    metal::uint2 _e12 = nmt_core_steps(in.v, _e11, _e7);
    metal::uint2 at_1 = naga_f2u32(in.position.xy);
    uint _e20 = frame.width;
    uint first_1 = 3u * ((at_1.y * _e20) + at_1.x);
    metal::float4 sums0 = sums0_texture.read(metal::uint2(at_1), 0);
    metal::float4 sums1 = sums1_texture.read(metal::uint2(at_1), 0);
    metal::float4 moments_2 = metal::float4(sums0.y, sums0.z, sums0.w, sums1.x);
    metal::uint2 _e38 = core[first_1];
    metal::uint2 _e43 = core[first_1 + 1u];
    metal::uint2 _e49 = core[first_1 + 2u];
    float _e55 = nmt_core_transmittance(_e12, _e7, metal::uint4(_e38, _e43), metal::uint4(_e49, 0u, 0u), sums1.y, sums0.x, moments_2);
    float weight = in.color.w * _e55;
    return pass2_Output { metal::float4(weight * in.color.xyz, weight) };
}
