// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

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
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(-6.644906, -6.8369474, 4.1170993, 2.9288063), metal::float4(0.24427499, -0.09179742, -0.18109056, 0.39672866), metal::float4(0.09456859, -0.0558132, -0.004021847, -0.251864), metal::float4(2.366806, -0.011803482, -0.1023652, 45.75337)), metal::float4x4(metal::float4(-1.4355919, 0.14289287, -0.23304649, -73.084694), metal::float4(-0.88735557, 0.58894396, -2.9240642, -2.084273), metal::float4(0.70983315, -1.0194519, -2.769523, 4.739505), metal::float4(0.39219984, 0.013014964, 5.017334, -1.925962)), metal::float4x4(metal::float4(0.7737863, 0.020955756, -1.8071773, -0.69392633), metal::float4(-6.5454655, -5.757807, 3.6420445, 3.7493362), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-7.274952, -1.2582943, 0.750487, -4.7914953), metal::float4(-0.03187928, -0.18776524, -0.10574456, -0.10121069), metal::float4(0.02594284, 0.0060951775, 0.12402804, -0.14500959), metal::float4(8.788641, 12.080313, -23.444958, 7.274002)), metal::float4x4(metal::float4(-20.707815, -23.360075, -6.007787, -1.3619602), metal::float4(-0.2932839, 8.935144, -8.427754, 1.7369972), metal::float4(3.0867727, -12.55485, -5.0971174, -29.500847), metal::float4(-0.6835189, -8.825866, 9.538471, 0.022721268)), metal::float4x4(metal::float4(-0.25592273, 0.15926334, 7.352642, -0.32446146), metal::float4(-7.146026, 1.3202263, -0.6231722, 1.0852268), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-2.2347827, -1.5456473, -3.0691724, -2.5347395), metal::float4(0.08673811, 0.046493262, -0.5524588, -0.030162303), metal::float4(0.22072567, 0.23512895, 0.27654696, -0.0552715), metal::float4(-8.506384, -5.3671, -2.738622, -0.768126)), metal::float4x4(metal::float4(5.099379, 3.4453056, 1.6650816, 10.453707), metal::float4(-3.5380375, 6.0613985, 2.3064294, 3.2792985), metal::float4(-3.6804945, 2.2989976, -16.632036, -0.9256119), metal::float4(9.719984, -5.940651, 0.346839, -0.87034315)), metal::float4x4(metal::float4(4.873015, -8.553477, 0.44932845, -6.306754), metal::float4(-5.170214, -0.41068712, 1.5794455, -0.12941931), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.82907254, 2.055103, -3.9308155, -1.8275987), metal::float4(0.24345244, 0.49341047, 0.6545849, -0.022919524), metal::float4(-0.12706393, -0.35977432, -0.5561126, 0.17710388), metal::float4(20.038559, 10.374188, 4.932662, -9.194126)), metal::float4x4(metal::float4(-9.926305, 1.2870265, -0.85073864, 0.28929147), metal::float4(2.8270183, -0.9751517, 2.8089926, -1.0786438), metal::float4(0.1419767, -0.02160598, -3.3599737, 4.795184), metal::float4(4.8569894, 1.4082379, 1.8042303, 2.2699566)), metal::float4x4(metal::float4(-2.1796367, 1.5583503, -0.387307, -12.48738), metal::float4(-5.879166, 1.8285091, -0.10583214, 1.4132012), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-2.1612747, -3.3155434, 5.7242703, -6.0707493), metal::float4(-0.19226082, 0.15382223, -0.34234348, -0.006578651), metal::float4(0.19576819, -0.38018504, 0.084700346, -0.0009343119), metal::float4(2.5350783, 8.021561, 0.92302895, -19.162228)), metal::float4x4(metal::float4(5.2881513, -7.946638, -3.55236, 0.024127962), metal::float4(5.5462565, 2.638155, -4.987424, -0.041671384), metal::float4(1.106101, -10.608368, -2.8620849, 0.11833197), metal::float4(-1.678799, 0.40029234, -2.4656491, 0.03180234)), metal::float4x4(metal::float4(0.011229959, 0.30013785, -1.7312031, 0.00095800485), metal::float4(-3.161044, 2.34481, 5.5600524, -6.074554), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.83962137, 2.2565045, 0.3291371, 1.5309821), metal::float4(-0.46886164, 0.04599322, 0.17105673, -0.94829005), metal::float4(1.280081, -0.02836603, 0.13397053, 0.42108443), metal::float4(8.010298, 12.996346, -0.9753846, -10.440201)), metal::float4x4(metal::float4(-6.3218236, -14.843192, 0.21337391, -4.3733397), metal::float4(-2.7684438, -4.504969, 2.6891792, -2.67894), metal::float4(1.9443177, -6.2891393, 4.648647, 1.6464616), metal::float4(0.56212527, 3.0974865, -8.001758, 0.33785355)), metal::float4x4(metal::float4(-0.55173165, 11.879521, 2.8588138, 6.7998548), metal::float4(-3.9557676, -0.8232811, -4.226862, -1.1620078), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.09421036, 3.3446453, 5.9199386, -2.0354898), metal::float4(-0.32518014, 0.11868493, -0.0003276461, -0.86161435), metal::float4(0.23984146, 0.013836953, 0.16386716, 0.6702215), metal::float4(21.249325, 2.2917397, -54.71574, -13.427977)), metal::float4x4(metal::float4(-30.97261, 0.216219, 2.2226324, -8.0110235), metal::float4(-1.3988694, 2.413615, -0.9885946, -2.2326064), metal::float4(1.216775, 3.12481, -1.014333, -0.5798262), metal::float4(0.9931289, -4.5937138, -0.06466371, 1.4991573)), metal::float4x4(metal::float4(-0.44282106, -5.0399785, 0.90951955, 1.2706821), metal::float4(2.2369783, 3.8954997, 3.736989, -0.8606754), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.8110742, 2.519742, -2.8404272, -2.533226), metal::float4(-0.16292943, -0.15577753, 0.0023999377, 0.1807285), metal::float4(-0.10005566, 0.20275813, -0.026740337, -0.10489468), metal::float4(-109.459465, 0.28144076, -2.1053116, 22.064835)), metal::float4x4(metal::float4(-18.75007, 5.0484786, -0.8004698, -17.53146), metal::float4(-0.7771674, 2.6927354, 4.2178493, 6.849358), metal::float4(2.1881056, 2.6948338, -5.263059, -4.4680424), metal::float4(-0.62796694, 0.9298859, -5.847802, -7.7678084)), metal::float4x4(metal::float4(2.4307024, 4.0429654, 1.3701764, 0.049088877), metal::float4(2.5936298, -4.2656145, 0.21204378, -0.5714553), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(-2.255839, 0.38752246, 1.0548706, 0.29508346), metal::float4(3.5021229, -5.5486403, 3.919978, 7.1393404), metal::float4(0.7005687, -0.65590554, -0.5999031, 0.3372998), metal::float4(0.55797297, -3.5278974, -0.9375819, -1.3799571)), metal::float4x4(metal::float4(-0.822207, 9.646074, 2.7334387, -2.0096188), metal::float4(-0.34243435, 0.38596803, -1.3136973, -4.985529), metal::float4(-0.27410707, -3.056068, 0.50217193, 0.96197915), metal::float4(-1.5862749, -1.5913026, -0.78255177, 1.6379662)), metal::float4x4(metal::float4(0.37614006, 0.62856156, 1.2053005, -0.115299), metal::float4(0.4000405, -2.2793074, 0.703724, 1.3842056), metal::float4(0.046837762, 2.1889262, 1.6758739, 0.5046616), metal::float4(-1.2901784, 0.6479536, -0.18261576, 0.47293198)), metal::float4x4(metal::float4(2.4513392, -3.2317476, -0.2937333, -0.87541187), metal::float4(-1.8018963, -0.08537033, -0.20679249, 0.17125203), metal::float4(0.37318125, 0.7007333, 1.0497698, -0.45693758), metal::float4(-0.07528782, -1.2427787, -0.3740497, -1.6162221)), metal::float4x4(metal::float4(-0.0056854156, -0.46216673, 0.37168384, 2.5266922), metal::float4(0.42355457, 0.56246275, 1.8464576, 0.30171275), metal::float4(-1.2142218, -0.93152916, 0.09710974, -0.1281254), metal::float4(-35.785778, -10.926431, 17.699657, -37.416485)), metal::float4x4(metal::float4(0.0455293, 0.4253418, 1.3075101, -0.33589628), metal::float4(0.37694284, -0.46193188, -0.16009994, -1.2368256), metal::float4(-0.7424769, -0.91597766, 1.3993851, 0.8158363), metal::float4(0.6780773, -0.98902965, -0.23915097, -0.84954214)), metal::float4x4(metal::float4(0.4356865, -3.6098413, 1.1518133, 1.6138109), metal::float4(0.018964194, -1.5095415, -0.03347981, -1.7394528), metal::float4(0.34304652, 0.37768713, 0.37472695, 0.55225396), metal::float4(-0.16768894, 1.2062308, 1.1071843, -1.0196143)), metal::float4x4(metal::float4(-0.9044732, -1.5783812, 0.044219047, 1.1296388), metal::float4(0.723707, 0.8417245, 0.18935676, 0.49409577), metal::float4(0.87967724, -0.9325288, -0.34372085, 1.7053646), metal::float4(0.42819053, -0.4067075, 0.06962549, -2.9700143)), metal::float4x4(metal::float4(2.5356777, -0.43621665, 7.423511, 0.71164465), metal::float4(-2.5701082, -0.6688071, 10.531412, -0.6108748), metal::float4(-0.39176378, -1.192722, 0.9267386, -0.5292072), metal::float4(-2.8794026, 0.21899784, 0.5366228, 0.048845787)), metal::float4x4(metal::float4(-0.8919236, -0.72751194, -1.7338217, -1.5668687), metal::float4(0.96019304, -0.34058416, -2.638105, -4.055744), metal::float4(0.8843582, -0.9128858, 0.117157556, 1.4530233), metal::float4(-0.708193, -0.66400707, 0.14623506, -0.4712691)), metal::float4x4(metal::float4(-0.7783678, -0.31102005, 0.44752443, -2.3856215), metal::float4(0.2624257, -1.0766104, -0.8439249, -0.74432045), metal::float4(-0.22061767, -0.43857747, -0.7492733, 0.49457687), metal::float4(-0.58638155, -0.2999724, -0.0067094145, 1.5273387)), metal::float4x4(metal::float4(3.4200375, -0.25266263, -3.1257107, -1.217456), metal::float4(-0.69696784, -0.6843623, -0.8573749, -0.56962454), metal::float4(0.01716081, -0.9216826, -1.5785106, -0.010490018), metal::float4(0.28287438, -0.4286377, 0.51161504, -0.95480466)), metal::float4x4(metal::float4(0.58851045, -1.0371984, 0.7001552, 0.806398), metal::float4(0.016595919, -0.7279884, 0.18224803, 1.1515921), metal::float4(0.3760666, -0.5972783, -0.2621969, 0.5113156), metal::float4(10.545665, -0.37558118, 4.6311793, 10.488333)), metal::float4x4(metal::float4(-0.20850836, -0.39854836, -0.3709685, 0.3344729), metal::float4(-4.7711983, -0.6631636, -0.28696483, -0.2530558), metal::float4(-0.19809644, -0.8487018, -0.98007166, -0.63437307), metal::float4(-0.25123456, 0.096610285, -0.4769591, -1.1468279)), metal::float4x4(metal::float4(-0.60058844, -0.63592666, -0.6052252, 2.147502), metal::float4(-0.03999185, -1.2613406, 0.09392666, -0.0019396583), metal::float4(0.5476339, -0.51548564, 0.052660856, -0.6011902), metal::float4(-0.009928996, -0.3182906, -0.99936664, -0.2935119)), metal::float4x4(metal::float4(2.6636226, -0.8832171, 0.20496556, -0.04191312), metal::float4(-1.2509433, -0.55184084, -2.144729, 0.30126184), metal::float4(0.6532062, -1.1347219, 0.053510785, -0.91702574), metal::float4(-1.381274, -0.8147487, 0.33820778, -4.516578)), metal::float4x4(metal::float4(-2.3944836, -1.5599631, -1.5443133, 7.2195654), metal::float4(-3.189623, -1.1757643, -3.0395696, -3.0470943), metal::float4(-0.74049497, -1.7795825, -3.3150501, 1.0655732), metal::float4(0.23391353, -1.9687781, -5.3815885, 0.301576)), metal::float4x4(metal::float4(0.6127581, 0.7189719, 0.4580838, -1.6256864), metal::float4(-1.2738101, 0.50001895, 1.1716812, 1.8961793), metal::float4(1.3969544, -1.026486, 4.5668006, -0.4924125), metal::float4(-1.281743, 0.74455583, 1.8456057, 1.333482)), metal::float4x4(metal::float4(1.6401439, -0.123683035, -3.8032908, -3.1102664), metal::float4(0.2741913, -1.0241107, 1.404279, 1.5889775), metal::float4(0.1882553, -2.4512374, -1.2712853, -2.092814), metal::float4(-0.6549388, 0.5310589, -3.4538968, -0.24010293)), metal::float4x4(metal::float4(-1.179344, 2.261319, 0.08677091, 2.3124037), metal::float4(2.2208896, -1.7276238, 3.0533953, 0.21290262), metal::float4(-0.22286461, 0.37983313, -0.8543179, -0.26173314), metal::float4(1.4492773, -0.83511055, -9.288777, -0.39975622)), metal::float4x4(metal::float4(-0.35471365, -1.4553583, -2.13006, -0.4722494), metal::float4(0.22448993, 1.6314536, -1.176599, -1.0119965), metal::float4(0.29016638, 2.3146746, 1.6903033, 2.050139), metal::float4(-47.534008, 13.450688, 45.055683, 36.8565)), metal::float4x4(metal::float4(-0.22244097, 0.73429656, 0.9862094, -0.12936336), metal::float4(-0.1992381, 1.0202835, -8.927242, -0.1334078), metal::float4(1.5236185, 1.6330041, -2.4532542, -4.456027), metal::float4(1.0353031, -0.54515195, -0.85325897, -0.043900564)), metal::float4x4(metal::float4(0.0486813, -0.781592, 0.8640903, 0.4591338), metal::float4(0.43045935, 0.5000094, -4.739644, -1.660293), metal::float4(-0.16277091, -0.22619689, 4.470063, -0.448047), metal::float4(0.44084775, 1.7280015, -0.500346, -1.6410081)), metal::float4x4(metal::float4(0.16035058, 0.75065976, 4.032844, 0.45246646), metal::float4(-0.89536476, -1.2162967, -4.4385104, 0.46120143), metal::float4(-0.80455375, -2.5115435, -0.41027853, -0.2586623), metal::float4(0.029636882, 0.63010544, 2.973935, -0.05043506)), metal::float4x4(metal::float4(-1.7194197, 4.824015, -0.5266476, -0.78833747), metal::float4(-1.471812, 9.310035, -0.36150956, 4.5210505), metal::float4(-7.3974433, -0.44423026, -0.52594626, -0.46529654), metal::float4(-2.518356, 0.05439636, 0.1194184, -5.167155)), metal::float4x4(metal::float4(1.1304877, -0.43544415, 0.05339168, -1.1652164), metal::float4(-0.10885799, 0.41674054, -0.0952923, -1.2645881), metal::float4(-1.6490318, -0.18742283, -0.38375202, -0.97365975), metal::float4(-2.0202, -0.071377896, 0.07519452, 3.0742452)), metal::float4x4(metal::float4(1.6776807, -0.008116794, 0.024402482, 0.03255095), metal::float4(-0.54861903, -0.18131344, -0.4416248, 0.8281913), metal::float4(0.8584243, -0.8858986, -0.3033022, -1.0664535), metal::float4(1.1155258, 0.7076073, -0.24093512, -1.1810366)), metal::float4x4(metal::float4(0.38029328, -0.2386654, -0.35356867, 3.3918595), metal::float4(-0.21296081, -0.23470572, 0.042254288, 0.13682778), metal::float4(0.66403234, -0.28447255, -0.1571084, -1.7468112), metal::float4(2.418734, 0.1238797, -0.3289564, -5.60176)), metal::float4x4(metal::float4(-0.07753089, -0.48136306, -0.1604197, -1.1021476), metal::float4(-0.26256388, -0.32693323, -0.31468716, 0.55450964), metal::float4(-41.1247, -0.032185316, -0.075553805, 0.5439732), metal::float4(-18.707817, 48.940483, 0.22923301, 58.23926)), metal::float4x4(metal::float4(-0.9359581, 0.0538587, 0.108696185, 0.19324653), metal::float4(-4.07145, -0.09797463, -0.011038951, -14.01719), metal::float4(0.7007382, -0.5162815, -0.56258255, -0.66931564), metal::float4(-0.37976232, -0.32823804, -0.4771057, -0.29178965)), metal::float4x4(metal::float4(-1.1176615, 0.26750723, 0.04743282, 3.1740904), metal::float4(-6.9861116, 0.13787462, -0.30856836, -1.2273467), metal::float4(-0.8925413, -0.25709334, -0.29693884, 2.0135877), metal::float4(0.005031425, 0.06407095, -0.38787746, -0.32969463)), metal::float4x4(metal::float4(-0.16123626, -0.12301454, -0.4572737, 2.7402086), metal::float4(1.9703797, 0.14687034, -0.21890731, -0.97876066), metal::float4(0.6571604, 1.3451152, -0.12175569, 1.41641), metal::float4(0.04929141, -0.58692384, -0.52177536, -0.42594108))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(3.510157, 1.7952743, 1.1987314, 0.26025793), metal::float4(2.3944774, -0.85182935, -3.3829448, 2.091531), metal::float4(-1.6684406, 3.4333026, -2.3400319, -2.8371181), metal::float4(-3.3407154, -10.006952, -0.18896143, -0.0427072)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.1269171, 0.11457737, -0.18309915, 0.13220085), metal::float4(-0.16864425, 0.3531046, -0.14550374, 0.10706206), metal::float4(0.14921415, 0.07990781, 0.1836161, 0.15159988), metal::float4(0.14897928, -0.7261686, 0.38606063, -0.14916353)}};
constant float NMT_B3 = -2.3116946;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(-6.644906, -6.8369474, 4.1170993, 2.9288063), metal::float4(0.24427499, -0.09179742, -0.18109056, 0.39672866), metal::float4(0.09456859, -0.0558132, -0.004021847, -0.251864), metal::float4(2.366806, -0.011803482, -0.1023652, 45.75337)) * h0_0) + (metal::float4x4(metal::float4(-1.4355919, 0.14289287, -0.23304649, -73.084694), metal::float4(-0.88735557, 0.58894396, -2.9240642, -2.084273), metal::float4(0.70983315, -1.0194519, -2.769523, 4.739505), metal::float4(0.39219984, 0.013014964, 5.017334, -1.925962)) * h0_1)) + (metal::float4x4(metal::float4(0.7737863, 0.020955756, -1.8071773, -0.69392633), metal::float4(-6.5454655, -5.757807, 3.6420445, 3.7493362), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-7.274952, -1.2582943, 0.750487, -4.7914953), metal::float4(-0.03187928, -0.18776524, -0.10574456, -0.10121069), metal::float4(0.02594284, 0.0060951775, 0.12402804, -0.14500959), metal::float4(8.788641, 12.080313, -23.444958, 7.274002)) * h0_0) + (metal::float4x4(metal::float4(-20.707815, -23.360075, -6.007787, -1.3619602), metal::float4(-0.2932839, 8.935144, -8.427754, 1.7369972), metal::float4(3.0867727, -12.55485, -5.0971174, -29.500847), metal::float4(-0.6835189, -8.825866, 9.538471, 0.022721268)) * h0_1)) + (metal::float4x4(metal::float4(-0.25592273, 0.15926334, 7.352642, -0.32446146), metal::float4(-7.146026, 1.3202263, -0.6231722, 1.0852268), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-2.2347827, -1.5456473, -3.0691724, -2.5347395), metal::float4(0.08673811, 0.046493262, -0.5524588, -0.030162303), metal::float4(0.22072567, 0.23512895, 0.27654696, -0.0552715), metal::float4(-8.506384, -5.3671, -2.738622, -0.768126)) * h0_0) + (metal::float4x4(metal::float4(5.099379, 3.4453056, 1.6650816, 10.453707), metal::float4(-3.5380375, 6.0613985, 2.3064294, 3.2792985), metal::float4(-3.6804945, 2.2989976, -16.632036, -0.9256119), metal::float4(9.719984, -5.940651, 0.346839, -0.87034315)) * h0_1)) + (metal::float4x4(metal::float4(4.873015, -8.553477, 0.44932845, -6.306754), metal::float4(-5.170214, -0.41068712, 1.5794455, -0.12941931), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-0.82907254, 2.055103, -3.9308155, -1.8275987), metal::float4(0.24345244, 0.49341047, 0.6545849, -0.022919524), metal::float4(-0.12706393, -0.35977432, -0.5561126, 0.17710388), metal::float4(20.038559, 10.374188, 4.932662, -9.194126)) * h0_0) + (metal::float4x4(metal::float4(-9.926305, 1.2870265, -0.85073864, 0.28929147), metal::float4(2.8270183, -0.9751517, 2.8089926, -1.0786438), metal::float4(0.1419767, -0.02160598, -3.3599737, 4.795184), metal::float4(4.8569894, 1.4082379, 1.8042303, 2.2699566)) * h0_1)) + (metal::float4x4(metal::float4(-2.1796367, 1.5583503, -0.387307, -12.48738), metal::float4(-5.879166, 1.8285091, -0.10583214, 1.4132012), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(-2.1612747, -3.3155434, 5.7242703, -6.0707493), metal::float4(-0.19226082, 0.15382223, -0.34234348, -0.006578651), metal::float4(0.19576819, -0.38018504, 0.084700346, -0.0009343119), metal::float4(2.5350783, 8.021561, 0.92302895, -19.162228)) * h0_0) + (metal::float4x4(metal::float4(5.2881513, -7.946638, -3.55236, 0.024127962), metal::float4(5.5462565, 2.638155, -4.987424, -0.041671384), metal::float4(1.106101, -10.608368, -2.8620849, 0.11833197), metal::float4(-1.678799, 0.40029234, -2.4656491, 0.03180234)) * h0_1)) + (metal::float4x4(metal::float4(0.011229959, 0.30013785, -1.7312031, 0.00095800485), metal::float4(-3.161044, 2.34481, 5.5600524, -6.074554), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-0.83962137, 2.2565045, 0.3291371, 1.5309821), metal::float4(-0.46886164, 0.04599322, 0.17105673, -0.94829005), metal::float4(1.280081, -0.02836603, 0.13397053, 0.42108443), metal::float4(8.010298, 12.996346, -0.9753846, -10.440201)) * h0_0) + (metal::float4x4(metal::float4(-6.3218236, -14.843192, 0.21337391, -4.3733397), metal::float4(-2.7684438, -4.504969, 2.6891792, -2.67894), metal::float4(1.9443177, -6.2891393, 4.648647, 1.6464616), metal::float4(0.56212527, 3.0974865, -8.001758, 0.33785355)) * h0_1)) + (metal::float4x4(metal::float4(-0.55173165, 11.879521, 2.8588138, 6.7998548), metal::float4(-3.9557676, -0.8232811, -4.226862, -1.1620078), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-0.09421036, 3.3446453, 5.9199386, -2.0354898), metal::float4(-0.32518014, 0.11868493, -0.0003276461, -0.86161435), metal::float4(0.23984146, 0.013836953, 0.16386716, 0.6702215), metal::float4(21.249325, 2.2917397, -54.71574, -13.427977)) * h0_0) + (metal::float4x4(metal::float4(-30.97261, 0.216219, 2.2226324, -8.0110235), metal::float4(-1.3988694, 2.413615, -0.9885946, -2.2326064), metal::float4(1.216775, 3.12481, -1.014333, -0.5798262), metal::float4(0.9931289, -4.5937138, -0.06466371, 1.4991573)) * h0_1)) + (metal::float4x4(metal::float4(-0.44282106, -5.0399785, 0.90951955, 1.2706821), metal::float4(2.2369783, 3.8954997, 3.736989, -0.8606754), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(0.8110742, 2.519742, -2.8404272, -2.533226), metal::float4(-0.16292943, -0.15577753, 0.0023999377, 0.1807285), metal::float4(-0.10005566, 0.20275813, -0.026740337, -0.10489468), metal::float4(-109.459465, 0.28144076, -2.1053116, 22.064835)) * h0_0) + (metal::float4x4(metal::float4(-18.75007, 5.0484786, -0.8004698, -17.53146), metal::float4(-0.7771674, 2.6927354, 4.2178493, 6.849358), metal::float4(2.1881056, 2.6948338, -5.263059, -4.4680424), metal::float4(-0.62796694, 0.9298859, -5.847802, -7.7678084)) * h0_1)) + (metal::float4x4(metal::float4(2.4307024, 4.0429654, 1.3701764, 0.049088877), metal::float4(2.5936298, -4.2656145, 0.21204378, -0.5714553), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(3.510157, 1.7952743, 1.1987314, 0.26025793) + (metal::float4x4(metal::float4(-2.255839, 0.38752246, 1.0548706, 0.29508346), metal::float4(3.5021229, -5.5486403, 3.919978, 7.1393404), metal::float4(0.7005687, -0.65590554, -0.5999031, 0.3372998), metal::float4(0.55797297, -3.5278974, -0.9375819, -1.3799571)) * h1_0)) + (metal::float4x4(metal::float4(-0.822207, 9.646074, 2.7334387, -2.0096188), metal::float4(-0.34243435, 0.38596803, -1.3136973, -4.985529), metal::float4(-0.27410707, -3.056068, 0.50217193, 0.96197915), metal::float4(-1.5862749, -1.5913026, -0.78255177, 1.6379662)) * h1_1)) + (metal::float4x4(metal::float4(0.37614006, 0.62856156, 1.2053005, -0.115299), metal::float4(0.4000405, -2.2793074, 0.703724, 1.3842056), metal::float4(0.046837762, 2.1889262, 1.6758739, 0.5046616), metal::float4(-1.2901784, 0.6479536, -0.18261576, 0.47293198)) * h1_2)) + (metal::float4x4(metal::float4(2.4513392, -3.2317476, -0.2937333, -0.87541187), metal::float4(-1.8018963, -0.08537033, -0.20679249, 0.17125203), metal::float4(0.37318125, 0.7007333, 1.0497698, -0.45693758), metal::float4(-0.07528782, -1.2427787, -0.3740497, -1.6162221)) * h1_3)) + (metal::float4x4(metal::float4(-0.0056854156, -0.46216673, 0.37168384, 2.5266922), metal::float4(0.42355457, 0.56246275, 1.8464576, 0.30171275), metal::float4(-1.2142218, -0.93152916, 0.09710974, -0.1281254), metal::float4(-35.785778, -10.926431, 17.699657, -37.416485)) * h1_4)) + (metal::float4x4(metal::float4(0.0455293, 0.4253418, 1.3075101, -0.33589628), metal::float4(0.37694284, -0.46193188, -0.16009994, -1.2368256), metal::float4(-0.7424769, -0.91597766, 1.3993851, 0.8158363), metal::float4(0.6780773, -0.98902965, -0.23915097, -0.84954214)) * h1_5)) + (metal::float4x4(metal::float4(0.4356865, -3.6098413, 1.1518133, 1.6138109), metal::float4(0.018964194, -1.5095415, -0.03347981, -1.7394528), metal::float4(0.34304652, 0.37768713, 0.37472695, 0.55225396), metal::float4(-0.16768894, 1.2062308, 1.1071843, -1.0196143)) * h1_6)) + (metal::float4x4(metal::float4(-0.9044732, -1.5783812, 0.044219047, 1.1296388), metal::float4(0.723707, 0.8417245, 0.18935676, 0.49409577), metal::float4(0.87967724, -0.9325288, -0.34372085, 1.7053646), metal::float4(0.42819053, -0.4067075, 0.06962549, -2.9700143)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(2.3944774, -0.85182935, -3.3829448, 2.091531) + (metal::float4x4(metal::float4(2.5356777, -0.43621665, 7.423511, 0.71164465), metal::float4(-2.5701082, -0.6688071, 10.531412, -0.6108748), metal::float4(-0.39176378, -1.192722, 0.9267386, -0.5292072), metal::float4(-2.8794026, 0.21899784, 0.5366228, 0.048845787)) * h1_0)) + (metal::float4x4(metal::float4(-0.8919236, -0.72751194, -1.7338217, -1.5668687), metal::float4(0.96019304, -0.34058416, -2.638105, -4.055744), metal::float4(0.8843582, -0.9128858, 0.117157556, 1.4530233), metal::float4(-0.708193, -0.66400707, 0.14623506, -0.4712691)) * h1_1)) + (metal::float4x4(metal::float4(-0.7783678, -0.31102005, 0.44752443, -2.3856215), metal::float4(0.2624257, -1.0766104, -0.8439249, -0.74432045), metal::float4(-0.22061767, -0.43857747, -0.7492733, 0.49457687), metal::float4(-0.58638155, -0.2999724, -0.0067094145, 1.5273387)) * h1_2)) + (metal::float4x4(metal::float4(3.4200375, -0.25266263, -3.1257107, -1.217456), metal::float4(-0.69696784, -0.6843623, -0.8573749, -0.56962454), metal::float4(0.01716081, -0.9216826, -1.5785106, -0.010490018), metal::float4(0.28287438, -0.4286377, 0.51161504, -0.95480466)) * h1_3)) + (metal::float4x4(metal::float4(0.58851045, -1.0371984, 0.7001552, 0.806398), metal::float4(0.016595919, -0.7279884, 0.18224803, 1.1515921), metal::float4(0.3760666, -0.5972783, -0.2621969, 0.5113156), metal::float4(10.545665, -0.37558118, 4.6311793, 10.488333)) * h1_4)) + (metal::float4x4(metal::float4(-0.20850836, -0.39854836, -0.3709685, 0.3344729), metal::float4(-4.7711983, -0.6631636, -0.28696483, -0.2530558), metal::float4(-0.19809644, -0.8487018, -0.98007166, -0.63437307), metal::float4(-0.25123456, 0.096610285, -0.4769591, -1.1468279)) * h1_5)) + (metal::float4x4(metal::float4(-0.60058844, -0.63592666, -0.6052252, 2.147502), metal::float4(-0.03999185, -1.2613406, 0.09392666, -0.0019396583), metal::float4(0.5476339, -0.51548564, 0.052660856, -0.6011902), metal::float4(-0.009928996, -0.3182906, -0.99936664, -0.2935119)) * h1_6)) + (metal::float4x4(metal::float4(2.6636226, -0.8832171, 0.20496556, -0.04191312), metal::float4(-1.2509433, -0.55184084, -2.144729, 0.30126184), metal::float4(0.6532062, -1.1347219, 0.053510785, -0.91702574), metal::float4(-1.381274, -0.8147487, 0.33820778, -4.516578)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-1.6684406, 3.4333026, -2.3400319, -2.8371181) + (metal::float4x4(metal::float4(-2.3944836, -1.5599631, -1.5443133, 7.2195654), metal::float4(-3.189623, -1.1757643, -3.0395696, -3.0470943), metal::float4(-0.74049497, -1.7795825, -3.3150501, 1.0655732), metal::float4(0.23391353, -1.9687781, -5.3815885, 0.301576)) * h1_0)) + (metal::float4x4(metal::float4(0.6127581, 0.7189719, 0.4580838, -1.6256864), metal::float4(-1.2738101, 0.50001895, 1.1716812, 1.8961793), metal::float4(1.3969544, -1.026486, 4.5668006, -0.4924125), metal::float4(-1.281743, 0.74455583, 1.8456057, 1.333482)) * h1_1)) + (metal::float4x4(metal::float4(1.6401439, -0.123683035, -3.8032908, -3.1102664), metal::float4(0.2741913, -1.0241107, 1.404279, 1.5889775), metal::float4(0.1882553, -2.4512374, -1.2712853, -2.092814), metal::float4(-0.6549388, 0.5310589, -3.4538968, -0.24010293)) * h1_2)) + (metal::float4x4(metal::float4(-1.179344, 2.261319, 0.08677091, 2.3124037), metal::float4(2.2208896, -1.7276238, 3.0533953, 0.21290262), metal::float4(-0.22286461, 0.37983313, -0.8543179, -0.26173314), metal::float4(1.4492773, -0.83511055, -9.288777, -0.39975622)) * h1_3)) + (metal::float4x4(metal::float4(-0.35471365, -1.4553583, -2.13006, -0.4722494), metal::float4(0.22448993, 1.6314536, -1.176599, -1.0119965), metal::float4(0.29016638, 2.3146746, 1.6903033, 2.050139), metal::float4(-47.534008, 13.450688, 45.055683, 36.8565)) * h1_4)) + (metal::float4x4(metal::float4(-0.22244097, 0.73429656, 0.9862094, -0.12936336), metal::float4(-0.1992381, 1.0202835, -8.927242, -0.1334078), metal::float4(1.5236185, 1.6330041, -2.4532542, -4.456027), metal::float4(1.0353031, -0.54515195, -0.85325897, -0.043900564)) * h1_5)) + (metal::float4x4(metal::float4(0.0486813, -0.781592, 0.8640903, 0.4591338), metal::float4(0.43045935, 0.5000094, -4.739644, -1.660293), metal::float4(-0.16277091, -0.22619689, 4.470063, -0.448047), metal::float4(0.44084775, 1.7280015, -0.500346, -1.6410081)) * h1_6)) + (metal::float4x4(metal::float4(0.16035058, 0.75065976, 4.032844, 0.45246646), metal::float4(-0.89536476, -1.2162967, -4.4385104, 0.46120143), metal::float4(-0.80455375, -2.5115435, -0.41027853, -0.2586623), metal::float4(0.029636882, 0.63010544, 2.973935, -0.05043506)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-3.3407154, -10.006952, -0.18896143, -0.0427072) + (metal::float4x4(metal::float4(-1.7194197, 4.824015, -0.5266476, -0.78833747), metal::float4(-1.471812, 9.310035, -0.36150956, 4.5210505), metal::float4(-7.3974433, -0.44423026, -0.52594626, -0.46529654), metal::float4(-2.518356, 0.05439636, 0.1194184, -5.167155)) * h1_0)) + (metal::float4x4(metal::float4(1.1304877, -0.43544415, 0.05339168, -1.1652164), metal::float4(-0.10885799, 0.41674054, -0.0952923, -1.2645881), metal::float4(-1.6490318, -0.18742283, -0.38375202, -0.97365975), metal::float4(-2.0202, -0.071377896, 0.07519452, 3.0742452)) * h1_1)) + (metal::float4x4(metal::float4(1.6776807, -0.008116794, 0.024402482, 0.03255095), metal::float4(-0.54861903, -0.18131344, -0.4416248, 0.8281913), metal::float4(0.8584243, -0.8858986, -0.3033022, -1.0664535), metal::float4(1.1155258, 0.7076073, -0.24093512, -1.1810366)) * h1_2)) + (metal::float4x4(metal::float4(0.38029328, -0.2386654, -0.35356867, 3.3918595), metal::float4(-0.21296081, -0.23470572, 0.042254288, 0.13682778), metal::float4(0.66403234, -0.28447255, -0.1571084, -1.7468112), metal::float4(2.418734, 0.1238797, -0.3289564, -5.60176)) * h1_3)) + (metal::float4x4(metal::float4(-0.07753089, -0.48136306, -0.1604197, -1.1021476), metal::float4(-0.26256388, -0.32693323, -0.31468716, 0.55450964), metal::float4(-41.1247, -0.032185316, -0.075553805, 0.5439732), metal::float4(-18.707817, 48.940483, 0.22923301, 58.23926)) * h1_4)) + (metal::float4x4(metal::float4(-0.9359581, 0.0538587, 0.108696185, 0.19324653), metal::float4(-4.07145, -0.09797463, -0.011038951, -14.01719), metal::float4(0.7007382, -0.5162815, -0.56258255, -0.66931564), metal::float4(-0.37976232, -0.32823804, -0.4771057, -0.29178965)) * h1_5)) + (metal::float4x4(metal::float4(-1.1176615, 0.26750723, 0.04743282, 3.1740904), metal::float4(-6.9861116, 0.13787462, -0.30856836, -1.2273467), metal::float4(-0.8925413, -0.25709334, -0.29693884, 2.0135877), metal::float4(0.005031425, 0.06407095, -0.38787746, -0.32969463)) * h1_6)) + (metal::float4x4(metal::float4(-0.16123626, -0.12301454, -0.4572737, 2.7402086), metal::float4(1.9703797, 0.14687034, -0.21890731, -0.97876066), metal::float4(0.6571604, 1.3451152, -0.12175569, 1.41641), metal::float4(0.04929141, -0.58692384, -0.52177536, -0.42594108)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.1269171, 0.11457737, -0.18309915, 0.13220085), h2_0)) + metal::dot(metal::float4(-0.16864425, 0.3531046, -0.14550374, 0.10706206), h2_1)) + metal::dot(metal::float4(0.14921415, 0.07990781, 0.1836161, 0.15159988), h2_2)) + metal::dot(metal::float4(0.14897928, -0.7261686, 0.38606063, -0.14916353), h2_3);
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
