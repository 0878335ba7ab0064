#version 300 es
// OpenGL ES 3.0 and WebGL 2, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1.
//
precision highp float;
precision highp int;
precision highp sampler2D;

// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 8eea3df1bcd36b439cc33c166ec5bf3acdf40f132555cd6c0c5c70ae502afbb9.
// Measured on fresh pixels of the training distribution: mean squared error of T 3.010e-3, worst 1.000.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(0.0128673, 3.7605476, 4.967981, -9.073497), vec4(0.061486423, 0.26695788, -0.05592443, -0.0004770445), vec4(0.120595664, -0.020408515, 0.32599422, -0.0014622799), vec4(-6.8605456, 12.684051, -45.805843, 0.60604024)),
    mat4(vec4(8.029831, -4.185539, -0.6309454, -0.070048265), vec4(0.37674192, -2.6459327, -7.1975346, -0.079928055), vec4(4.477463, -3.530796, -23.34172, 0.0123483315), vec4(5.9921083, -1.0951891, 2.625345, 0.1018246)),
    mat4(vec4(0.8995982, 1.5784115, -1.9817613, 0.03263077), vec4(-7.8599067, 1.3771372, 2.804348, -8.989794), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(3.053503, 3.3163035, 4.0997186, -1.8181499), vec4(0.10083877, -0.15764526, 0.37501672, 0.18639907), vec4(-0.1141413, 0.0141200675, -0.07648036, 0.019727733), vec4(-5.816949, -1.6847119, -28.352114, -36.955414)),
    mat4(vec4(-9.24026, 0.53857344, -8.226313, -0.7732424), vec4(4.926565, 3.2234447, -7.1700964, 2.7766924), vec4(6.0966964, -5.6362576, 6.675482, 3.936297), vec4(3.0072625, -4.3396215, 2.4934776, -5.1654115)),
    mat4(vec4(0.509092, 7.4188333, 3.9676015, -3.6344948), vec4(-4.987512, 1.741231, 1.6843204, 0.35940275), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.1357752, 3.1969974, 0.6388284, 0.35029534), vec4(-0.09240131, 0.06461878, 0.073132895, -0.11267547), vec4(-0.09839589, 0.011218065, -0.042015534, 0.30540684), vec4(-8.129085, 0.081854336, -0.5113961, 7.3107734)),
    mat4(vec4(-0.5181795, -0.8867954, 2.5176802, -13.771118), vec4(1.4127574, 0.608775, 3.4103985, -6.692415), vec4(-71.603485, -5.4107456, 4.0707083, -2.78479), vec4(1.4849635, -2.0275028, -4.486, 9.590367)),
    mat4(vec4(4.8973527, 9.712532, -0.7723977, 1.0119555), vec4(2.0110922, -1.6190807, -1.6753997, -1.7989482), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.0951456, -6.380943, -8.963903, -4.4872713), vec4(-0.14963645, -3.6276865, 0.04144575, -0.19638653), vec4(-0.027325645, 0.85273635, 0.033327766, 0.17155321), vec4(-10.517675, 2.8791196, -0.9624652, 2.4270668)),
    mat4(vec4(0.51770294, 1.1915114, -0.38210407, -2.2753205), vec4(-3.8812947, 4.5123944, -0.21275786, 4.471844), vec4(7.3276258, -16.216568, 0.044620886, -1.4459828), vec4(4.7779346, 0.8548577, 0.105853535, -0.07487261)),
    mat4(vec4(-7.9724526, 0.11366252, 0.09251511, 0.004421727), vec4(2.2588694, -1.3475512, -8.667636, 0.02357316), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-7.7796874, 4.4515243, 1.6453724, -3.3046415), vec4(-0.04655458, 0.16389099, -5.623225, -0.076588124), vec4(0.21422838, -0.12146205, 2.2912526, 0.32628185), vec4(6.5471015, -2.6268616, -113.76781, 10.478893)),
    mat4(vec4(-6.703381, -0.3940546, -4.6124873, -1.3663454), vec4(-0.89949095, -1.9441097, -0.861114, 5.675592), vec4(1.8441706, 6.249376, -0.32739648, 2.790953), vec4(0.02780533, 2.396314, -1.823028, -3.0873811)),
    mat4(vec4(-0.1285339, -11.436484, 0.09829164, -1.9000167), vec4(-6.62964, 2.176947, -1.449254, -9.000235), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.2223232, -2.81537, 0.0381704, -3.2866175), vec4(-0.16036503, -0.03564522, -0.24743807, -0.8521144), vec4(0.14361398, 0.030019017, -0.033454824, -0.13318846), vec4(-44.266136, 10.5454035, -18.27825, -13.014755)),
    mat4(vec4(-1.2652023, -22.45449, -17.602373, -3.5409336), vec4(-4.3827944, 7.3610187, -2.5863278, -6.470938), vec4(-4.727587, -9.427833, -1.1336447, 3.4583826), vec4(7.215683, -7.0260696, 0.88531023, 6.1348376)),
    mat4(vec4(7.6807275, -0.20966919, 5.361553, 3.4800436), vec4(-5.0711794, 0.6257986, 2.3135483, -4.0624876), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-4.2517843, 2.5558038, 1.4504354, 2.9237134), vec4(0.47126552, 0.11527032, -0.19839449, 0.017221425), vec4(0.011528634, 0.025176136, -0.098738, -0.036812574), vec4(12.1783905, -2.5591013, 0.9118894, -17.348635)),
    mat4(vec4(-4.982472, 0.18365996, -3.9290173, -26.445133), vec4(4.2715745, -1.9652382, -9.8959055, -9.160783), vec4(-9.488131, 6.308886, -1.8252605, 0.3943453), vec4(-0.54524404, 1.9699956, 5.9329176, 7.882178)),
    mat4(vec4(2.2935746, -9.116118, -2.6141613, 8.270921), vec4(-1.7027036, 3.6375575, 2.4187453, 0.96318907), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.22702889, 2.741514, -0.64847213, -1.7944295), vec4(-0.025018906, 0.12644266, -0.01564159, 0.17683391), vec4(0.14392114, -0.043477118, -0.034341548, 0.045816883), vec4(-2.848468, 10.602803, 10.040098, 1.6311252)),
    mat4(vec4(-0.65445346, -5.9683332, 8.818165, 8.11726), vec4(-2.6961257, 1.6168381, 2.6546414, 0.826791), vec4(-9.831338, -0.049179975, -2.1002567, 3.793261), vec4(6.0304127, 3.5396833, 0.546225, 0.2872772)),
    mat4(vec4(-0.26623872, -149.94072, 2.0308735, -2.9207644), vec4(2.1908734, -1.4523337, -1.4518526, -5.471224), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(0.9736768, -0.29141343, 2.165374, -5.9616947), vec4(0.32695, 1.7460566, -0.73695904, -2.8565822), vec4(0.53050196, 0.02215783, 0.94649047, -0.03258612), vec4(7.30803, -20.037624, -0.4016418, 36.93685)),
    mat4(vec4(1.1549286, -2.1335447, -1.5475959, -2.0792816), vec4(0.7644667, 2.2598095, -0.85532826, 1.0806948), vec4(-0.06527169, 3.0018117, -1.1480756, -1.2850962), vec4(-0.2507964, -1.1964153, 0.37514597, 1.1753136)),
    mat4(vec4(-0.8472616, -0.7043746, -2.276852, -4.691008), vec4(-0.4555601, -1.6629165, -1.4509339, -8.189336), vec4(-0.3334633, 0.94757324, -0.55492085, -0.9525936), vec4(0.1735622, -0.025619686, -6.0581923, 2.1031337)),
    mat4(vec4(0.4554539, 0.04216364, 0.8397753, -1.2650865), vec4(0.38927913, -1.5407665, 1.013042, -0.02641012), vec4(5.774787, -1.6544327, -4.6677165, 7.3341303), vec4(0.66671425, 1.7772616, -0.3515065, -0.9281742)),
    mat4(vec4(1.9784381, 0.15601097, 0.6946781, -0.37603793), vec4(-1.2871833, 1.8456504, -15.282526, -1.846713), vec4(0.5392468, 0.40055114, -0.49634168, 0.30052704), vec4(-0.042860143, -2.7806468, -12.598277, 0.71105194)),
    mat4(vec4(0.059144653, 0.6933273, 0.07266263, -2.4127839), vec4(2.147373, -0.4122814, -0.73740923, -0.77285784), vec4(1.4421121, 0.44261938, -0.43316194, 2.195324), vec4(0.018330483, 0.3287679, -0.7590122, 0.52264804)),
    mat4(vec4(1.5273659, 0.23432893, -0.11794407, 0.19162464), vec4(0.5608629, -1.3380905, -1.6920519, 0.7178977), vec4(-0.91993153, 2.7752552, 0.24850309, -0.72549605), vec4(-0.95868415, -3.0614154, 2.69588, -1.8136024)),
    mat4(vec4(1.0603478, -0.4530526, 1.9572685, -0.765034), vec4(-0.17213117, 3.729339, -10.964154, 4.6471605), vec4(-0.78516996, -2.6175964, 0.4640726, -0.6211325), vec4(0.8244115, 1.2729508, -0.29074246, 0.67575365)),
    mat4(vec4(-21.03128, -0.26334956, -0.21224876, -1.7206993), vec4(-1.253194, 2.0803108, -0.39351013, -1.5414695), vec4(0.36283782, 0.5835208, -0.19863863, 1.0937574), vec4(8.479179, -15.568178, -0.6278676, 33.372063)),
    mat4(vec4(0.033372823, -0.5917856, -0.29407036, -0.6036532), vec4(-0.5680851, -0.8011245, -0.43400952, 0.63234293), vec4(0.26169628, 1.7879655, 0.22113287, 0.44972688), vec4(-0.22556847, -4.2311754, -0.37518364, 0.15974058)),
    mat4(vec4(-8.812771, -1.9551792, -0.23230843, -2.2471507), vec4(-3.787506, 0.95212144, 0.16235405, -0.52156943), vec4(-0.4480017, -0.11265831, -0.23024982, -0.58245707), vec4(-9.83514, 0.81435573, -0.32746187, -6.067244)),
    mat4(vec4(-1.6044284, -1.187413, -0.5729973, -0.6296531), vec4(-0.44902867, -0.9198901, -0.6862288, -0.15399714), vec4(1.7186819, -0.63127995, -0.6949159, -1.7918234), vec4(-1.0648757, -0.15579815, -0.67800283, 0.41674504)),
    mat4(vec4(0.3903473, -1.2289082, -0.53787977, 0.82405025), vec4(-2.0846198, -0.21663588, -0.56657994, -1.0735714), vec4(0.4248758, 0.22443669, -0.65666825, 0.07997841), vec4(-8.916795, -0.7094989, 0.14798479, -6.97053)),
    mat4(vec4(3.7009888, -0.70093614, -0.6128832, 2.644844), vec4(0.4247687, -0.817053, 0.42068318, 0.23905064), vec4(1.7035515, 1.461921, -0.77451235, -0.48444858), vec4(-0.615658, -0.3333953, -0.2667526, 0.36767223)),
    mat4(vec4(-0.18516809, 0.27482903, -0.2225964, -0.6724002), vec4(4.011923, 0.637334, -0.67672485, 0.3016647), vec4(0.6065027, -0.7883742, -0.9284632, 0.5641883), vec4(-3.5589437, -1.0624614, 0.096765846, -2.8511245)),
    mat4(vec4(-0.6089275, 0.090764254, -1.1523596, -0.24199161), vec4(-0.7682741, -1.3162074, 0.09341756, 0.93857926), vec4(-1.1931734, -0.23855007, -0.72499424, -1.5712576), vec4(-0.42629656, -0.26260087, -0.9542177, 1.6355244)),
    mat4(vec4(0.513711, 0.45026255, -0.17716119, 0.1736828), vec4(-1.2653636, -0.76790434, 0.14107746, -0.101236925), vec4(-3.3931994, -0.9410222, 1.9234831, -0.21560587), vec4(13.866378, -29.905949, -4.7024813, -0.05950532)),
    mat4(vec4(0.59723866, 1.7412177, -0.752095, -0.26280499), vec4(-0.003803875, -2.1383972, -3.9911714, -0.367251), vec4(-0.08324374, -0.8167838, -0.59538025, -0.6327836), vec4(-0.5830487, 0.28148487, -0.014125063, -0.31751835)),
    mat4(vec4(1.7969197, 2.0490663, 1.8168552, -0.34116894), vec4(-0.6144725, 2.9157856, 1.3234017, -0.32294732), vec4(0.5913104, 0.18101647, 0.36276755, -0.2903578), vec4(-4.3923545, 1.5272367, -2.8389628, -0.31174585)),
    mat4(vec4(-0.043329127, 1.7050985, 3.6233244, -0.14176968), vec4(-0.09525963, -2.7151825, -0.09772584, -0.07205112), vec4(-9.263754, -10.313246, -8.166591, -0.2591225), vec4(0.320203, -3.8302138, -0.30241755, -0.6026502)),
    mat4(vec4(0.41639164, -7.142308, -0.15356658, -0.07018159), vec4(-0.47224933, -2.6364233, -1.4798231, -0.4788587), vec4(-11.549793, 0.5174555, -0.12486984, -0.07710395), vec4(-3.8463557, -5.778302, -2.6209154, -0.16565485)),
    mat4(vec4(1.3733138, -0.7823414, -0.34194192, 0.07787178), vec4(-9.382015, -7.5211344, -0.9132306, 0.092068516), vec4(0.05152, -0.7322079, -0.3741282, -0.2911173), vec4(0.42595804, 1.9614707, -1.1739447, -0.081629924)),
    mat4(vec4(-0.44047526, -24.672018, 0.9065058, -0.1293647), vec4(0.31847742, 2.3859189, -0.69301957, -0.0344279), vec4(0.79915905, -0.68671614, -1.2447516, -0.6533241), vec4(-1.5470724, 1.1773903, 2.1916807, -0.0036031604)),
    mat4(vec4(-0.11451272, -0.6021976, 0.92095214, -0.32089463), vec4(-3.5989914, -9.970194, -3.6157365, -0.11802844), vec4(0.98625535, 2.7900815, 0.4079601, -0.45204443), vec4(1.5801364, -1.0910925, -0.6526661, -0.5535904)),
    mat4(vec4(-0.28614658, -2.1724875, -0.5920867, -15.148489), vec4(0.112143114, -1.1335614, 4.989998, -8.775643), vec4(1.8512427, 2.6082566, 0.75738746, 3.1869366), vec4(14.841191, 15.039519, -1.6337725, -12.899408)),
    mat4(vec4(-3.2158957, 0.10552485, 1.4139965, 1.9299747), vec4(1.2013996, 1.5588788, 3.3646104, 0.89145553), vec4(2.2672095, -0.34486154, -0.45014113, -3.075378), vec4(-2.0838945, 2.0800898, -4.884502, -1.8615084)),
    mat4(vec4(-0.20065495, 0.27777302, -0.59739953, 0.492799), vec4(-1.8899113, -1.0359483, -2.5809455, -4.207474), vec4(-0.11997342, -2.2042232, -5.1670423, -0.82337683), vec4(-2.9167504, -1.2420093, 2.304473, -3.0426073)),
    mat4(vec4(-0.9256383, -1.0924605, -0.43929762, -4.0171313), vec4(1.0769504, 0.037780624, 3.1679304, 0.5120494), vec4(-16.731611, -2.2271824, 18.3933, -4.5929675), vec4(-0.42094705, -0.8055554, -40.733025, 0.1368361)),
    mat4(vec4(-16.488438, -0.3953813, 1.4915931, 0.9422313), vec4(0.48689404, -2.7105336, 0.37647396, 1.6256014), vec4(-0.985141, -0.124065, 0.52547807, -0.28835893), vec4(-3.5103607, -2.6983385, 3.0643513, 3.5271595)),
    mat4(vec4(1.8173051, 1.553307, 1.4059104, -2.6934683), vec4(-10.258167, 1.2927513, -16.181759, 0.30489627), vec4(1.1080258, 1.2718751, -1.8642662, 4.288624), vec4(-1.4439301, -0.42140698, -0.7453024, 7.2049985)),
    mat4(vec4(-1.5084285, -0.5501037, 0.5154039, -0.5701379), vec4(-1.5225708, 1.4633889, 0.22918528, 1.7084976), vec4(-0.4712859, -1.9853026, -0.48694852, 1.1872562), vec4(-3.7520049, -0.88765305, 0.31254068, -4.251616)),
    mat4(vec4(0.8542929, -13.992373, 0.7051828, 1.0770032), vec4(0.85787165, -5.0552893, -0.31344295, -2.4815369), vec4(0.5221182, -0.4009286, -2.8391845, -1.6408883), vec4(-0.25800353, -3.6405084, 3.5037513, -1.4389756))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(1.3345498, -8.672864, 1.3157077, 0.07269316),
    vec4(-2.2007182, 3.1122139, -0.5706032, 2.51398),
    vec4(-1.9580028, -27.292315, -4.916058, -0.3410543),
    vec4(-2.0799077, -7.002787, -13.354039, -3.1847873)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.18279469, 0.103831336, 0.11210188, -0.20403156),
    vec4(0.22301295, 0.1194242, 0.19459188, -0.20728351),
    vec4(0.14650388, 0.11623583, 0.13068826, 0.11467473),
    vec4(0.12574163, 0.3050175, 0.099843465, -0.12184774)
);
const float NMT_B3 = -1.6129792;

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

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

// The code of such a number; 0, the empty slot, of what the target is cleared to.
uint nmt_core_end_code(float value) {
    uint low = NMT_END_BITS - 1u;
    uint bits = floatBitsToUint(max(value, -3.9999998));
    int rank = int(bits & 0x7fffffffu) - 0x00800000;
    uint packed_code = uint((bits > 0x7fffffffu ? -1 - rank : rank) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
uvec2 nmt_core_ends(vec2 values) {
    uint nearest = nmt_core_end_code(values.x);
    uint farthest = nmt_core_end_code(values.y);
    bool apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return uvec2(nearest, apart ? farthest : 0u);
}

// Where the moments of the tail leave what the fragment adds to the image open by no more than this, T is the middle of
// what they allow, and the network is not asked. 0 always asks it; 1/512 cannot be seen.
const float NMT_OPEN = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err than
// these: Markov's bounds.
vec3 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
    float mean = m1 * 0.9999;
    float second = m2 * 0.9999 + 3.3333334e-5;
    float third = m3 * 0.9999;
    float fourth = m4 * 0.9999 + 2e-5;
    float square = mean * mean;
    float variance = max(second - square, 1e-7);
    float per_deviation = 1.0 / sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    float d = clamp((fourth - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float per_d = 1.0 / d;
    float q = (y * (y - skewness) - 1.0) * per_d;
    float at = 1.0 / (1.0 + y * y + q * q * d);
    float rest = 1.0 - at;
    float linear_ = y - q * skewness;
    float per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    float between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    float lower = (q < 0.0 ? between : (y > 0.5 * skewness ? rest : 0.0));
    float inner = max(1.0 - second, 1e-6);
    float per_inner = 1.0 / inner;
    float inner_mean = (mean - third) * per_inner;
    float inner_second = (second - fourth) * per_inner;
    float width = max(inner_second - inner_mean * inner_mean, 1e-7);
    float place = inner_mean - x;
    float of_inner = width / (width + place * place);
    float ended = inner * of_inner / max(1.0 - x * x, 1e-6);
    float side = (place < 0.0 ? -1.0 : 1.0);
    float of_fourth = inner * (1.0 - of_inner) * abs(place) / max(abs(place) + inner_second - x * inner_mean, 1e-6);
    float at_end = clamp(0.5 * (1.0 - side * mean - ended * (1.0 - side * x) - of_fourth), 0.0, max(1.0 - ended, 0.0));
    float least = (ended < at ? (place < 0.0 ? 1.0 - ended - at_end : at_end) : lower);
    float most = (ended < at ? ended : at);
    return vec3(least, least + most, per_variance * per_variance * per_d);
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
    vec3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_2 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_2 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
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

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, vec4 sums0, vec4 sums1, vec4 range) {
    NmtCodes codes = nmt_core_codes(v0, v1);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    uvec4 core = uvec4(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, sums1.y, sums0.x, vec4(sums0.y, sums0.z, sums0.w, sums1.x));
}

in float v;
in vec4 color;
layout(location = 0) out vec4 weighted;
uniform vec2 v_range;
uniform sampler2D sums0_texture;
uniform sampler2D sums1_texture;
uniform sampler2D range_texture;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float T = nmt_pass2(
        v, v_range.x, v_range.y, color.a,
        texelFetch(sums0_texture, at, 0),
        texelFetch(sums1_texture, at, 0),
        texelFetch(range_texture, at, 0));
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
