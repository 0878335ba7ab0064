// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0. Textures of group 1: the targets
// of pass 1.
//
// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 8eea3df1bcd36b439cc33c166ec5bf3acdf40f132555cd6c0c5c70ae502afbb9.
// Measured on fresh pixels of the training distribution: mean squared error of T 3.010e-3, worst 1.000.

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
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(0.0128673, 3.7605476, 4.967981, -9.073497), metal::float4(0.061486423, 0.26695788, -0.05592443, -0.0004770445), metal::float4(0.120595664, -0.020408515, 0.32599422, -0.0014622799), metal::float4(-6.8605456, 12.684051, -45.805843, 0.60604024)), metal::float4x4(metal::float4(8.029831, -4.185539, -0.6309454, -0.070048265), metal::float4(0.37674192, -2.6459327, -7.1975346, -0.079928055), metal::float4(4.477463, -3.530796, -23.34172, 0.0123483315), metal::float4(5.9921083, -1.0951891, 2.625345, 0.1018246)), metal::float4x4(metal::float4(0.8995982, 1.5784115, -1.9817613, 0.03263077), metal::float4(-7.8599067, 1.3771372, 2.804348, -8.989794), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(3.053503, 3.3163035, 4.0997186, -1.8181499), metal::float4(0.10083877, -0.15764526, 0.37501672, 0.18639907), metal::float4(-0.1141413, 0.0141200675, -0.07648036, 0.019727733), metal::float4(-5.816949, -1.6847119, -28.352114, -36.955414)), metal::float4x4(metal::float4(-9.24026, 0.53857344, -8.226313, -0.7732424), metal::float4(4.926565, 3.2234447, -7.1700964, 2.7766924), metal::float4(6.0966964, -5.6362576, 6.675482, 3.936297), metal::float4(3.0072625, -4.3396215, 2.4934776, -5.1654115)), metal::float4x4(metal::float4(0.509092, 7.4188333, 3.9676015, -3.6344948), metal::float4(-4.987512, 1.741231, 1.6843204, 0.35940275), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-1.1357752, 3.1969974, 0.6388284, 0.35029534), metal::float4(-0.09240131, 0.06461878, 0.073132895, -0.11267547), metal::float4(-0.09839589, 0.011218065, -0.042015534, 0.30540684), metal::float4(-8.129085, 0.081854336, -0.5113961, 7.3107734)), metal::float4x4(metal::float4(-0.5181795, -0.8867954, 2.5176802, -13.771118), metal::float4(1.4127574, 0.608775, 3.4103985, -6.692415), metal::float4(-71.603485, -5.4107456, 4.0707083, -2.78479), metal::float4(1.4849635, -2.0275028, -4.486, 9.590367)), metal::float4x4(metal::float4(4.8973527, 9.712532, -0.7723977, 1.0119555), metal::float4(2.0110922, -1.6190807, -1.6753997, -1.7989482), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.0951456, -6.380943, -8.963903, -4.4872713), metal::float4(-0.14963645, -3.6276865, 0.04144575, -0.19638653), metal::float4(-0.027325645, 0.85273635, 0.033327766, 0.17155321), metal::float4(-10.517675, 2.8791196, -0.9624652, 2.4270668)), metal::float4x4(metal::float4(0.51770294, 1.1915114, -0.38210407, -2.2753205), metal::float4(-3.8812947, 4.5123944, -0.21275786, 4.471844), metal::float4(7.3276258, -16.216568, 0.044620886, -1.4459828), metal::float4(4.7779346, 0.8548577, 0.105853535, -0.07487261)), metal::float4x4(metal::float4(-7.9724526, 0.11366252, 0.09251511, 0.004421727), metal::float4(2.2588694, -1.3475512, -8.667636, 0.02357316), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-7.7796874, 4.4515243, 1.6453724, -3.3046415), metal::float4(-0.04655458, 0.16389099, -5.623225, -0.076588124), metal::float4(0.21422838, -0.12146205, 2.2912526, 0.32628185), metal::float4(6.5471015, -2.6268616, -113.76781, 10.478893)), metal::float4x4(metal::float4(-6.703381, -0.3940546, -4.6124873, -1.3663454), metal::float4(-0.89949095, -1.9441097, -0.861114, 5.675592), metal::float4(1.8441706, 6.249376, -0.32739648, 2.790953), metal::float4(0.02780533, 2.396314, -1.823028, -3.0873811)), metal::float4x4(metal::float4(-0.1285339, -11.436484, 0.09829164, -1.9000167), metal::float4(-6.62964, 2.176947, -1.449254, -9.000235), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.2223232, -2.81537, 0.0381704, -3.2866175), metal::float4(-0.16036503, -0.03564522, -0.24743807, -0.8521144), metal::float4(0.14361398, 0.030019017, -0.033454824, -0.13318846), metal::float4(-44.266136, 10.5454035, -18.27825, -13.014755)), metal::float4x4(metal::float4(-1.2652023, -22.45449, -17.602373, -3.5409336), metal::float4(-4.3827944, 7.3610187, -2.5863278, -6.470938), metal::float4(-4.727587, -9.427833, -1.1336447, 3.4583826), metal::float4(7.215683, -7.0260696, 0.88531023, 6.1348376)), metal::float4x4(metal::float4(7.6807275, -0.20966919, 5.361553, 3.4800436), metal::float4(-5.0711794, 0.6257986, 2.3135483, -4.0624876), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-4.2517843, 2.5558038, 1.4504354, 2.9237134), metal::float4(0.47126552, 0.11527032, -0.19839449, 0.017221425), metal::float4(0.011528634, 0.025176136, -0.098738, -0.036812574), metal::float4(12.1783905, -2.5591013, 0.9118894, -17.348635)), metal::float4x4(metal::float4(-4.982472, 0.18365996, -3.9290173, -26.445133), metal::float4(4.2715745, -1.9652382, -9.8959055, -9.160783), metal::float4(-9.488131, 6.308886, -1.8252605, 0.3943453), metal::float4(-0.54524404, 1.9699956, 5.9329176, 7.882178)), metal::float4x4(metal::float4(2.2935746, -9.116118, -2.6141613, 8.270921), metal::float4(-1.7027036, 3.6375575, 2.4187453, 0.96318907), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.22702889, 2.741514, -0.64847213, -1.7944295), metal::float4(-0.025018906, 0.12644266, -0.01564159, 0.17683391), metal::float4(0.14392114, -0.043477118, -0.034341548, 0.045816883), metal::float4(-2.848468, 10.602803, 10.040098, 1.6311252)), metal::float4x4(metal::float4(-0.65445346, -5.9683332, 8.818165, 8.11726), metal::float4(-2.6961257, 1.6168381, 2.6546414, 0.826791), metal::float4(-9.831338, -0.049179975, -2.1002567, 3.793261), metal::float4(6.0304127, 3.5396833, 0.546225, 0.2872772)), metal::float4x4(metal::float4(-0.26623872, -149.94072, 2.0308735, -2.9207644), metal::float4(2.1908734, -1.4523337, -1.4518526, -5.471224), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(0.9736768, -0.29141343, 2.165374, -5.9616947), metal::float4(0.32695, 1.7460566, -0.73695904, -2.8565822), metal::float4(0.53050196, 0.02215783, 0.94649047, -0.03258612), metal::float4(7.30803, -20.037624, -0.4016418, 36.93685)), metal::float4x4(metal::float4(1.1549286, -2.1335447, -1.5475959, -2.0792816), metal::float4(0.7644667, 2.2598095, -0.85532826, 1.0806948), metal::float4(-0.06527169, 3.0018117, -1.1480756, -1.2850962), metal::float4(-0.2507964, -1.1964153, 0.37514597, 1.1753136)), metal::float4x4(metal::float4(-0.8472616, -0.7043746, -2.276852, -4.691008), metal::float4(-0.4555601, -1.6629165, -1.4509339, -8.189336), metal::float4(-0.3334633, 0.94757324, -0.55492085, -0.9525936), metal::float4(0.1735622, -0.025619686, -6.0581923, 2.1031337)), metal::float4x4(metal::float4(0.4554539, 0.04216364, 0.8397753, -1.2650865), metal::float4(0.38927913, -1.5407665, 1.013042, -0.02641012), metal::float4(5.774787, -1.6544327, -4.6677165, 7.3341303), metal::float4(0.66671425, 1.7772616, -0.3515065, -0.9281742)), metal::float4x4(metal::float4(1.9784381, 0.15601097, 0.6946781, -0.37603793), metal::float4(-1.2871833, 1.8456504, -15.282526, -1.846713), metal::float4(0.5392468, 0.40055114, -0.49634168, 0.30052704), metal::float4(-0.042860143, -2.7806468, -12.598277, 0.71105194)), metal::float4x4(metal::float4(0.059144653, 0.6933273, 0.07266263, -2.4127839), metal::float4(2.147373, -0.4122814, -0.73740923, -0.77285784), metal::float4(1.4421121, 0.44261938, -0.43316194, 2.195324), metal::float4(0.018330483, 0.3287679, -0.7590122, 0.52264804)), metal::float4x4(metal::float4(1.5273659, 0.23432893, -0.11794407, 0.19162464), metal::float4(0.5608629, -1.3380905, -1.6920519, 0.7178977), metal::float4(-0.91993153, 2.7752552, 0.24850309, -0.72549605), metal::float4(-0.95868415, -3.0614154, 2.69588, -1.8136024)), metal::float4x4(metal::float4(1.0603478, -0.4530526, 1.9572685, -0.765034), metal::float4(-0.17213117, 3.729339, -10.964154, 4.6471605), metal::float4(-0.78516996, -2.6175964, 0.4640726, -0.6211325), metal::float4(0.8244115, 1.2729508, -0.29074246, 0.67575365)), metal::float4x4(metal::float4(-21.03128, -0.26334956, -0.21224876, -1.7206993), metal::float4(-1.253194, 2.0803108, -0.39351013, -1.5414695), metal::float4(0.36283782, 0.5835208, -0.19863863, 1.0937574), metal::float4(8.479179, -15.568178, -0.6278676, 33.372063)), metal::float4x4(metal::float4(0.033372823, -0.5917856, -0.29407036, -0.6036532), metal::float4(-0.5680851, -0.8011245, -0.43400952, 0.63234293), metal::float4(0.26169628, 1.7879655, 0.22113287, 0.44972688), metal::float4(-0.22556847, -4.2311754, -0.37518364, 0.15974058)), metal::float4x4(metal::float4(-8.812771, -1.9551792, -0.23230843, -2.2471507), metal::float4(-3.787506, 0.95212144, 0.16235405, -0.52156943), metal::float4(-0.4480017, -0.11265831, -0.23024982, -0.58245707), metal::float4(-9.83514, 0.81435573, -0.32746187, -6.067244)), metal::float4x4(metal::float4(-1.6044284, -1.187413, -0.5729973, -0.6296531), metal::float4(-0.44902867, -0.9198901, -0.6862288, -0.15399714), metal::float4(1.7186819, -0.63127995, -0.6949159, -1.7918234), metal::float4(-1.0648757, -0.15579815, -0.67800283, 0.41674504)), metal::float4x4(metal::float4(0.3903473, -1.2289082, -0.53787977, 0.82405025), metal::float4(-2.0846198, -0.21663588, -0.56657994, -1.0735714), metal::float4(0.4248758, 0.22443669, -0.65666825, 0.07997841), metal::float4(-8.916795, -0.7094989, 0.14798479, -6.97053)), metal::float4x4(metal::float4(3.7009888, -0.70093614, -0.6128832, 2.644844), metal::float4(0.4247687, -0.817053, 0.42068318, 0.23905064), metal::float4(1.7035515, 1.461921, -0.77451235, -0.48444858), metal::float4(-0.615658, -0.3333953, -0.2667526, 0.36767223)), metal::float4x4(metal::float4(-0.18516809, 0.27482903, -0.2225964, -0.6724002), metal::float4(4.011923, 0.637334, -0.67672485, 0.3016647), metal::float4(0.6065027, -0.7883742, -0.9284632, 0.5641883), metal::float4(-3.5589437, -1.0624614, 0.096765846, -2.8511245)), metal::float4x4(metal::float4(-0.6089275, 0.090764254, -1.1523596, -0.24199161), metal::float4(-0.7682741, -1.3162074, 0.09341756, 0.93857926), metal::float4(-1.1931734, -0.23855007, -0.72499424, -1.5712576), metal::float4(-0.42629656, -0.26260087, -0.9542177, 1.6355244)), metal::float4x4(metal::float4(0.513711, 0.45026255, -0.17716119, 0.1736828), metal::float4(-1.2653636, -0.76790434, 0.14107746, -0.101236925), metal::float4(-3.3931994, -0.9410222, 1.9234831, -0.21560587), metal::float4(13.866378, -29.905949, -4.7024813, -0.05950532)), metal::float4x4(metal::float4(0.59723866, 1.7412177, -0.752095, -0.26280499), metal::float4(-0.003803875, -2.1383972, -3.9911714, -0.367251), metal::float4(-0.08324374, -0.8167838, -0.59538025, -0.6327836), metal::float4(-0.5830487, 0.28148487, -0.014125063, -0.31751835)), metal::float4x4(metal::float4(1.7969197, 2.0490663, 1.8168552, -0.34116894), metal::float4(-0.6144725, 2.9157856, 1.3234017, -0.32294732), metal::float4(0.5913104, 0.18101647, 0.36276755, -0.2903578), metal::float4(-4.3923545, 1.5272367, -2.8389628, -0.31174585)), metal::float4x4(metal::float4(-0.043329127, 1.7050985, 3.6233244, -0.14176968), metal::float4(-0.09525963, -2.7151825, -0.09772584, -0.07205112), metal::float4(-9.263754, -10.313246, -8.166591, -0.2591225), metal::float4(0.320203, -3.8302138, -0.30241755, -0.6026502)), metal::float4x4(metal::float4(0.41639164, -7.142308, -0.15356658, -0.07018159), metal::float4(-0.47224933, -2.6364233, -1.4798231, -0.4788587), metal::float4(-11.549793, 0.5174555, -0.12486984, -0.07710395), metal::float4(-3.8463557, -5.778302, -2.6209154, -0.16565485)), metal::float4x4(metal::float4(1.3733138, -0.7823414, -0.34194192, 0.07787178), metal::float4(-9.382015, -7.5211344, -0.9132306, 0.092068516), metal::float4(0.05152, -0.7322079, -0.3741282, -0.2911173), metal::float4(0.42595804, 1.9614707, -1.1739447, -0.081629924)), metal::float4x4(metal::float4(-0.44047526, -24.672018, 0.9065058, -0.1293647), metal::float4(0.31847742, 2.3859189, -0.69301957, -0.0344279), metal::float4(0.79915905, -0.68671614, -1.2447516, -0.6533241), metal::float4(-1.5470724, 1.1773903, 2.1916807, -0.0036031604)), metal::float4x4(metal::float4(-0.11451272, -0.6021976, 0.92095214, -0.32089463), metal::float4(-3.5989914, -9.970194, -3.6157365, -0.11802844), metal::float4(0.98625535, 2.7900815, 0.4079601, -0.45204443), metal::float4(1.5801364, -1.0910925, -0.6526661, -0.5535904)), metal::float4x4(metal::float4(-0.28614658, -2.1724875, -0.5920867, -15.148489), metal::float4(0.112143114, -1.1335614, 4.989998, -8.775643), metal::float4(1.8512427, 2.6082566, 0.75738746, 3.1869366), metal::float4(14.841191, 15.039519, -1.6337725, -12.899408)), metal::float4x4(metal::float4(-3.2158957, 0.10552485, 1.4139965, 1.9299747), metal::float4(1.2013996, 1.5588788, 3.3646104, 0.89145553), metal::float4(2.2672095, -0.34486154, -0.45014113, -3.075378), metal::float4(-2.0838945, 2.0800898, -4.884502, -1.8615084)), metal::float4x4(metal::float4(-0.20065495, 0.27777302, -0.59739953, 0.492799), metal::float4(-1.8899113, -1.0359483, -2.5809455, -4.207474), metal::float4(-0.11997342, -2.2042232, -5.1670423, -0.82337683), metal::float4(-2.9167504, -1.2420093, 2.304473, -3.0426073)), metal::float4x4(metal::float4(-0.9256383, -1.0924605, -0.43929762, -4.0171313), metal::float4(1.0769504, 0.037780624, 3.1679304, 0.5120494), metal::float4(-16.731611, -2.2271824, 18.3933, -4.5929675), metal::float4(-0.42094705, -0.8055554, -40.733025, 0.1368361)), metal::float4x4(metal::float4(-16.488438, -0.3953813, 1.4915931, 0.9422313), metal::float4(0.48689404, -2.7105336, 0.37647396, 1.6256014), metal::float4(-0.985141, -0.124065, 0.52547807, -0.28835893), metal::float4(-3.5103607, -2.6983385, 3.0643513, 3.5271595)), metal::float4x4(metal::float4(1.8173051, 1.553307, 1.4059104, -2.6934683), metal::float4(-10.258167, 1.2927513, -16.181759, 0.30489627), metal::float4(1.1080258, 1.2718751, -1.8642662, 4.288624), metal::float4(-1.4439301, -0.42140698, -0.7453024, 7.2049985)), metal::float4x4(metal::float4(-1.5084285, -0.5501037, 0.5154039, -0.5701379), metal::float4(-1.5225708, 1.4633889, 0.22918528, 1.7084976), metal::float4(-0.4712859, -1.9853026, -0.48694852, 1.1872562), metal::float4(-3.7520049, -0.88765305, 0.31254068, -4.251616)), metal::float4x4(metal::float4(0.8542929, -13.992373, 0.7051828, 1.0770032), metal::float4(0.85787165, -5.0552893, -0.31344295, -2.4815369), metal::float4(0.5221182, -0.4009286, -2.8391845, -1.6408883), metal::float4(-0.25800353, -3.6405084, 3.5037513, -1.4389756))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(1.3345498, -8.672864, 1.3157077, 0.07269316), metal::float4(-2.2007182, 3.1122139, -0.5706032, 2.51398), metal::float4(-1.9580028, -27.292315, -4.916058, -0.3410543), metal::float4(-2.0799077, -7.002787, -13.354039, -3.1847873)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.18279469, 0.103831336, 0.11210188, -0.20403156), metal::float4(0.22301295, 0.1194242, 0.19459188, -0.20728351), metal::float4(0.14650388, 0.11623583, 0.13068826, 0.11467473), metal::float4(0.12574163, 0.3050175, 0.099843465, -0.12184774)}};
constant float NMT_B3 = -1.6129792;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(0.0128673, 3.7605476, 4.967981, -9.073497), metal::float4(0.061486423, 0.26695788, -0.05592443, -0.0004770445), metal::float4(0.120595664, -0.020408515, 0.32599422, -0.0014622799), metal::float4(-6.8605456, 12.684051, -45.805843, 0.60604024)) * h0_0) + (metal::float4x4(metal::float4(8.029831, -4.185539, -0.6309454, -0.070048265), metal::float4(0.37674192, -2.6459327, -7.1975346, -0.079928055), metal::float4(4.477463, -3.530796, -23.34172, 0.0123483315), metal::float4(5.9921083, -1.0951891, 2.625345, 0.1018246)) * h0_1)) + (metal::float4x4(metal::float4(0.8995982, 1.5784115, -1.9817613, 0.03263077), metal::float4(-7.8599067, 1.3771372, 2.804348, -8.989794), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(3.053503, 3.3163035, 4.0997186, -1.8181499), metal::float4(0.10083877, -0.15764526, 0.37501672, 0.18639907), metal::float4(-0.1141413, 0.0141200675, -0.07648036, 0.019727733), metal::float4(-5.816949, -1.6847119, -28.352114, -36.955414)) * h0_0) + (metal::float4x4(metal::float4(-9.24026, 0.53857344, -8.226313, -0.7732424), metal::float4(4.926565, 3.2234447, -7.1700964, 2.7766924), metal::float4(6.0966964, -5.6362576, 6.675482, 3.936297), metal::float4(3.0072625, -4.3396215, 2.4934776, -5.1654115)) * h0_1)) + (metal::float4x4(metal::float4(0.509092, 7.4188333, 3.9676015, -3.6344948), metal::float4(-4.987512, 1.741231, 1.6843204, 0.35940275), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-1.1357752, 3.1969974, 0.6388284, 0.35029534), metal::float4(-0.09240131, 0.06461878, 0.073132895, -0.11267547), metal::float4(-0.09839589, 0.011218065, -0.042015534, 0.30540684), metal::float4(-8.129085, 0.081854336, -0.5113961, 7.3107734)) * h0_0) + (metal::float4x4(metal::float4(-0.5181795, -0.8867954, 2.5176802, -13.771118), metal::float4(1.4127574, 0.608775, 3.4103985, -6.692415), metal::float4(-71.603485, -5.4107456, 4.0707083, -2.78479), metal::float4(1.4849635, -2.0275028, -4.486, 9.590367)) * h0_1)) + (metal::float4x4(metal::float4(4.8973527, 9.712532, -0.7723977, 1.0119555), metal::float4(2.0110922, -1.6190807, -1.6753997, -1.7989482), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(0.0951456, -6.380943, -8.963903, -4.4872713), metal::float4(-0.14963645, -3.6276865, 0.04144575, -0.19638653), metal::float4(-0.027325645, 0.85273635, 0.033327766, 0.17155321), metal::float4(-10.517675, 2.8791196, -0.9624652, 2.4270668)) * h0_0) + (metal::float4x4(metal::float4(0.51770294, 1.1915114, -0.38210407, -2.2753205), metal::float4(-3.8812947, 4.5123944, -0.21275786, 4.471844), metal::float4(7.3276258, -16.216568, 0.044620886, -1.4459828), metal::float4(4.7779346, 0.8548577, 0.105853535, -0.07487261)) * h0_1)) + (metal::float4x4(metal::float4(-7.9724526, 0.11366252, 0.09251511, 0.004421727), metal::float4(2.2588694, -1.3475512, -8.667636, 0.02357316), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(-7.7796874, 4.4515243, 1.6453724, -3.3046415), metal::float4(-0.04655458, 0.16389099, -5.623225, -0.076588124), metal::float4(0.21422838, -0.12146205, 2.2912526, 0.32628185), metal::float4(6.5471015, -2.6268616, -113.76781, 10.478893)) * h0_0) + (metal::float4x4(metal::float4(-6.703381, -0.3940546, -4.6124873, -1.3663454), metal::float4(-0.89949095, -1.9441097, -0.861114, 5.675592), metal::float4(1.8441706, 6.249376, -0.32739648, 2.790953), metal::float4(0.02780533, 2.396314, -1.823028, -3.0873811)) * h0_1)) + (metal::float4x4(metal::float4(-0.1285339, -11.436484, 0.09829164, -1.9000167), metal::float4(-6.62964, 2.176947, -1.449254, -9.000235), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-3.2223232, -2.81537, 0.0381704, -3.2866175), metal::float4(-0.16036503, -0.03564522, -0.24743807, -0.8521144), metal::float4(0.14361398, 0.030019017, -0.033454824, -0.13318846), metal::float4(-44.266136, 10.5454035, -18.27825, -13.014755)) * h0_0) + (metal::float4x4(metal::float4(-1.2652023, -22.45449, -17.602373, -3.5409336), metal::float4(-4.3827944, 7.3610187, -2.5863278, -6.470938), metal::float4(-4.727587, -9.427833, -1.1336447, 3.4583826), metal::float4(7.215683, -7.0260696, 0.88531023, 6.1348376)) * h0_1)) + (metal::float4x4(metal::float4(7.6807275, -0.20966919, 5.361553, 3.4800436), metal::float4(-5.0711794, 0.6257986, 2.3135483, -4.0624876), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-4.2517843, 2.5558038, 1.4504354, 2.9237134), metal::float4(0.47126552, 0.11527032, -0.19839449, 0.017221425), metal::float4(0.011528634, 0.025176136, -0.098738, -0.036812574), metal::float4(12.1783905, -2.5591013, 0.9118894, -17.348635)) * h0_0) + (metal::float4x4(metal::float4(-4.982472, 0.18365996, -3.9290173, -26.445133), metal::float4(4.2715745, -1.9652382, -9.8959055, -9.160783), metal::float4(-9.488131, 6.308886, -1.8252605, 0.3943453), metal::float4(-0.54524404, 1.9699956, 5.9329176, 7.882178)) * h0_1)) + (metal::float4x4(metal::float4(2.2935746, -9.116118, -2.6141613, 8.270921), metal::float4(-1.7027036, 3.6375575, 2.4187453, 0.96318907), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(-0.22702889, 2.741514, -0.64847213, -1.7944295), metal::float4(-0.025018906, 0.12644266, -0.01564159, 0.17683391), metal::float4(0.14392114, -0.043477118, -0.034341548, 0.045816883), metal::float4(-2.848468, 10.602803, 10.040098, 1.6311252)) * h0_0) + (metal::float4x4(metal::float4(-0.65445346, -5.9683332, 8.818165, 8.11726), metal::float4(-2.6961257, 1.6168381, 2.6546414, 0.826791), metal::float4(-9.831338, -0.049179975, -2.1002567, 3.793261), metal::float4(6.0304127, 3.5396833, 0.546225, 0.2872772)) * h0_1)) + (metal::float4x4(metal::float4(-0.26623872, -149.94072, 2.0308735, -2.9207644), metal::float4(2.1908734, -1.4523337, -1.4518526, -5.471224), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.3345498, -8.672864, 1.3157077, 0.07269316) + (metal::float4x4(metal::float4(0.9736768, -0.29141343, 2.165374, -5.9616947), metal::float4(0.32695, 1.7460566, -0.73695904, -2.8565822), metal::float4(0.53050196, 0.02215783, 0.94649047, -0.03258612), metal::float4(7.30803, -20.037624, -0.4016418, 36.93685)) * h1_0)) + (metal::float4x4(metal::float4(1.1549286, -2.1335447, -1.5475959, -2.0792816), metal::float4(0.7644667, 2.2598095, -0.85532826, 1.0806948), metal::float4(-0.06527169, 3.0018117, -1.1480756, -1.2850962), metal::float4(-0.2507964, -1.1964153, 0.37514597, 1.1753136)) * h1_1)) + (metal::float4x4(metal::float4(-0.8472616, -0.7043746, -2.276852, -4.691008), metal::float4(-0.4555601, -1.6629165, -1.4509339, -8.189336), metal::float4(-0.3334633, 0.94757324, -0.55492085, -0.9525936), metal::float4(0.1735622, -0.025619686, -6.0581923, 2.1031337)) * h1_2)) + (metal::float4x4(metal::float4(0.4554539, 0.04216364, 0.8397753, -1.2650865), metal::float4(0.38927913, -1.5407665, 1.013042, -0.02641012), metal::float4(5.774787, -1.6544327, -4.6677165, 7.3341303), metal::float4(0.66671425, 1.7772616, -0.3515065, -0.9281742)) * h1_3)) + (metal::float4x4(metal::float4(1.9784381, 0.15601097, 0.6946781, -0.37603793), metal::float4(-1.2871833, 1.8456504, -15.282526, -1.846713), metal::float4(0.5392468, 0.40055114, -0.49634168, 0.30052704), metal::float4(-0.042860143, -2.7806468, -12.598277, 0.71105194)) * h1_4)) + (metal::float4x4(metal::float4(0.059144653, 0.6933273, 0.07266263, -2.4127839), metal::float4(2.147373, -0.4122814, -0.73740923, -0.77285784), metal::float4(1.4421121, 0.44261938, -0.43316194, 2.195324), metal::float4(0.018330483, 0.3287679, -0.7590122, 0.52264804)) * h1_5)) + (metal::float4x4(metal::float4(1.5273659, 0.23432893, -0.11794407, 0.19162464), metal::float4(0.5608629, -1.3380905, -1.6920519, 0.7178977), metal::float4(-0.91993153, 2.7752552, 0.24850309, -0.72549605), metal::float4(-0.95868415, -3.0614154, 2.69588, -1.8136024)) * h1_6)) + (metal::float4x4(metal::float4(1.0603478, -0.4530526, 1.9572685, -0.765034), metal::float4(-0.17213117, 3.729339, -10.964154, 4.6471605), metal::float4(-0.78516996, -2.6175964, 0.4640726, -0.6211325), metal::float4(0.8244115, 1.2729508, -0.29074246, 0.67575365)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(-2.2007182, 3.1122139, -0.5706032, 2.51398) + (metal::float4x4(metal::float4(-21.03128, -0.26334956, -0.21224876, -1.7206993), metal::float4(-1.253194, 2.0803108, -0.39351013, -1.5414695), metal::float4(0.36283782, 0.5835208, -0.19863863, 1.0937574), metal::float4(8.479179, -15.568178, -0.6278676, 33.372063)) * h1_0)) + (metal::float4x4(metal::float4(0.033372823, -0.5917856, -0.29407036, -0.6036532), metal::float4(-0.5680851, -0.8011245, -0.43400952, 0.63234293), metal::float4(0.26169628, 1.7879655, 0.22113287, 0.44972688), metal::float4(-0.22556847, -4.2311754, -0.37518364, 0.15974058)) * h1_1)) + (metal::float4x4(metal::float4(-8.812771, -1.9551792, -0.23230843, -2.2471507), metal::float4(-3.787506, 0.95212144, 0.16235405, -0.52156943), metal::float4(-0.4480017, -0.11265831, -0.23024982, -0.58245707), metal::float4(-9.83514, 0.81435573, -0.32746187, -6.067244)) * h1_2)) + (metal::float4x4(metal::float4(-1.6044284, -1.187413, -0.5729973, -0.6296531), metal::float4(-0.44902867, -0.9198901, -0.6862288, -0.15399714), metal::float4(1.7186819, -0.63127995, -0.6949159, -1.7918234), metal::float4(-1.0648757, -0.15579815, -0.67800283, 0.41674504)) * h1_3)) + (metal::float4x4(metal::float4(0.3903473, -1.2289082, -0.53787977, 0.82405025), metal::float4(-2.0846198, -0.21663588, -0.56657994, -1.0735714), metal::float4(0.4248758, 0.22443669, -0.65666825, 0.07997841), metal::float4(-8.916795, -0.7094989, 0.14798479, -6.97053)) * h1_4)) + (metal::float4x4(metal::float4(3.7009888, -0.70093614, -0.6128832, 2.644844), metal::float4(0.4247687, -0.817053, 0.42068318, 0.23905064), metal::float4(1.7035515, 1.461921, -0.77451235, -0.48444858), metal::float4(-0.615658, -0.3333953, -0.2667526, 0.36767223)) * h1_5)) + (metal::float4x4(metal::float4(-0.18516809, 0.27482903, -0.2225964, -0.6724002), metal::float4(4.011923, 0.637334, -0.67672485, 0.3016647), metal::float4(0.6065027, -0.7883742, -0.9284632, 0.5641883), metal::float4(-3.5589437, -1.0624614, 0.096765846, -2.8511245)) * h1_6)) + (metal::float4x4(metal::float4(-0.6089275, 0.090764254, -1.1523596, -0.24199161), metal::float4(-0.7682741, -1.3162074, 0.09341756, 0.93857926), metal::float4(-1.1931734, -0.23855007, -0.72499424, -1.5712576), metal::float4(-0.42629656, -0.26260087, -0.9542177, 1.6355244)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-1.9580028, -27.292315, -4.916058, -0.3410543) + (metal::float4x4(metal::float4(0.513711, 0.45026255, -0.17716119, 0.1736828), metal::float4(-1.2653636, -0.76790434, 0.14107746, -0.101236925), metal::float4(-3.3931994, -0.9410222, 1.9234831, -0.21560587), metal::float4(13.866378, -29.905949, -4.7024813, -0.05950532)) * h1_0)) + (metal::float4x4(metal::float4(0.59723866, 1.7412177, -0.752095, -0.26280499), metal::float4(-0.003803875, -2.1383972, -3.9911714, -0.367251), metal::float4(-0.08324374, -0.8167838, -0.59538025, -0.6327836), metal::float4(-0.5830487, 0.28148487, -0.014125063, -0.31751835)) * h1_1)) + (metal::float4x4(metal::float4(1.7969197, 2.0490663, 1.8168552, -0.34116894), metal::float4(-0.6144725, 2.9157856, 1.3234017, -0.32294732), metal::float4(0.5913104, 0.18101647, 0.36276755, -0.2903578), metal::float4(-4.3923545, 1.5272367, -2.8389628, -0.31174585)) * h1_2)) + (metal::float4x4(metal::float4(-0.043329127, 1.7050985, 3.6233244, -0.14176968), metal::float4(-0.09525963, -2.7151825, -0.09772584, -0.07205112), metal::float4(-9.263754, -10.313246, -8.166591, -0.2591225), metal::float4(0.320203, -3.8302138, -0.30241755, -0.6026502)) * h1_3)) + (metal::float4x4(metal::float4(0.41639164, -7.142308, -0.15356658, -0.07018159), metal::float4(-0.47224933, -2.6364233, -1.4798231, -0.4788587), metal::float4(-11.549793, 0.5174555, -0.12486984, -0.07710395), metal::float4(-3.8463557, -5.778302, -2.6209154, -0.16565485)) * h1_4)) + (metal::float4x4(metal::float4(1.3733138, -0.7823414, -0.34194192, 0.07787178), metal::float4(-9.382015, -7.5211344, -0.9132306, 0.092068516), metal::float4(0.05152, -0.7322079, -0.3741282, -0.2911173), metal::float4(0.42595804, 1.9614707, -1.1739447, -0.081629924)) * h1_5)) + (metal::float4x4(metal::float4(-0.44047526, -24.672018, 0.9065058, -0.1293647), metal::float4(0.31847742, 2.3859189, -0.69301957, -0.0344279), metal::float4(0.79915905, -0.68671614, -1.2447516, -0.6533241), metal::float4(-1.5470724, 1.1773903, 2.1916807, -0.0036031604)) * h1_6)) + (metal::float4x4(metal::float4(-0.11451272, -0.6021976, 0.92095214, -0.32089463), metal::float4(-3.5989914, -9.970194, -3.6157365, -0.11802844), metal::float4(0.98625535, 2.7900815, 0.4079601, -0.45204443), metal::float4(1.5801364, -1.0910925, -0.6526661, -0.5535904)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-2.0799077, -7.002787, -13.354039, -3.1847873) + (metal::float4x4(metal::float4(-0.28614658, -2.1724875, -0.5920867, -15.148489), metal::float4(0.112143114, -1.1335614, 4.989998, -8.775643), metal::float4(1.8512427, 2.6082566, 0.75738746, 3.1869366), metal::float4(14.841191, 15.039519, -1.6337725, -12.899408)) * h1_0)) + (metal::float4x4(metal::float4(-3.2158957, 0.10552485, 1.4139965, 1.9299747), metal::float4(1.2013996, 1.5588788, 3.3646104, 0.89145553), metal::float4(2.2672095, -0.34486154, -0.45014113, -3.075378), metal::float4(-2.0838945, 2.0800898, -4.884502, -1.8615084)) * h1_1)) + (metal::float4x4(metal::float4(-0.20065495, 0.27777302, -0.59739953, 0.492799), metal::float4(-1.8899113, -1.0359483, -2.5809455, -4.207474), metal::float4(-0.11997342, -2.2042232, -5.1670423, -0.82337683), metal::float4(-2.9167504, -1.2420093, 2.304473, -3.0426073)) * h1_2)) + (metal::float4x4(metal::float4(-0.9256383, -1.0924605, -0.43929762, -4.0171313), metal::float4(1.0769504, 0.037780624, 3.1679304, 0.5120494), metal::float4(-16.731611, -2.2271824, 18.3933, -4.5929675), metal::float4(-0.42094705, -0.8055554, -40.733025, 0.1368361)) * h1_3)) + (metal::float4x4(metal::float4(-16.488438, -0.3953813, 1.4915931, 0.9422313), metal::float4(0.48689404, -2.7105336, 0.37647396, 1.6256014), metal::float4(-0.985141, -0.124065, 0.52547807, -0.28835893), metal::float4(-3.5103607, -2.6983385, 3.0643513, 3.5271595)) * h1_4)) + (metal::float4x4(metal::float4(1.8173051, 1.553307, 1.4059104, -2.6934683), metal::float4(-10.258167, 1.2927513, -16.181759, 0.30489627), metal::float4(1.1080258, 1.2718751, -1.8642662, 4.288624), metal::float4(-1.4439301, -0.42140698, -0.7453024, 7.2049985)) * h1_5)) + (metal::float4x4(metal::float4(-1.5084285, -0.5501037, 0.5154039, -0.5701379), metal::float4(-1.5225708, 1.4633889, 0.22918528, 1.7084976), metal::float4(-0.4712859, -1.9853026, -0.48694852, 1.1872562), metal::float4(-3.7520049, -0.88765305, 0.31254068, -4.251616)) * h1_6)) + (metal::float4x4(metal::float4(0.8542929, -13.992373, 0.7051828, 1.0770032), metal::float4(0.85787165, -5.0552893, -0.31344295, -2.4815369), metal::float4(0.5221182, -0.4009286, -2.8391845, -1.6408883), metal::float4(-0.25800353, -3.6405084, 3.5037513, -1.4389756)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.18279469, 0.103831336, 0.11210188, -0.20403156), h2_0)) + metal::dot(metal::float4(0.22301295, 0.1194242, 0.19459188, -0.20728351), h2_1)) + metal::dot(metal::float4(0.14650388, 0.11623583, 0.13068826, 0.11467473), h2_2)) + metal::dot(metal::float4(0.12574163, 0.3050175, 0.099843465, -0.12184774), h2_3);
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
    metal::float3 _e383 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    if (false) {
        float bounds_noise = (((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * ((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)))) * _e383.z) * 0.000000014901161;
        float most_1 = metal::min(metal::exp(-((front_2 + (absorbance_of_tail * metal::max(_e383.x - bounds_noise, 0.0))))), 1.0);
        float least_1 = metal::min(metal::exp(-((front_2 + (absorbance_of_tail * metal::min(_e383.y + bounds_noise, 1.0))))), 1.0);
        float opacity = 1.0 - metal::exp(-(absorbance_1));
        if ((opacity * (most_1 - least_1)) <= NMT_OPEN) {
            float middle = 0.5 * (most_1 + least_1);
            return middle;
        }
    }
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    float _e519 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e383.x), metal::float4(_e383.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_2)) * _e519;
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
