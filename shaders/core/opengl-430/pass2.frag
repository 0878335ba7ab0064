#version 430
// OpenGL 4.3, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 6000, dataset bd56c8a2a9c6d4f460653e7f112f48bcc4cd217bead9bf4934f14f488f930250.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.061e-3, worst 1.000.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(5.4374213, 4.099272, -2.3999908, 0.06732468), vec4(-0.30876112, 0.039813306, -0.06825874, 0.09791592), vec4(0.11699771, -0.0126477955, 0.009044837, 0.024920827), vec4(-0.06984082, -1.4153421, 11.242752, 27.765509)),
    mat4(vec4(2.1031263, -18.205357, 11.592584, -24.416697), vec4(0.68829197, -3.5122368, 5.105146, 3.1200283), vec4(1.2533448, 11.688712, 1.1489722, 1.8796386), vec4(-0.7433028, -1.2973337, -3.0665278, 1.5641073)),
    mat4(vec4(-0.3011667, -40.251568, -5.629344, -0.5443934), vec4(3.0883026, 6.4341197, -0.02780485, -3.0386043), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-6.0495343, 1.8236239, 3.2971628, 6.976045), vec4(0.14396286, -0.10366543, -0.19931847, -0.073501945), vec4(0.045301538, 1.5944515, 0.024680262, 0.024978848), vec4(-11.065943, -0.46564764, -302.25082, 6.2804327)),
    mat4(vec4(6.5376883, 1.4367918, 4.3187885, -3.8740258), vec4(10.118008, -3.1108778, 4.2425604, -2.354306), vec4(-8.242886, 1.7415371, 2.897262, -0.57454836), vec4(-8.166772, 0.504575, -6.560604, 0.8390675)),
    mat4(vec4(-11.040061, 0.82958007, -1.1059247, 10.712579), vec4(-0.35051835, -4.799316, 1.6909233, 2.4979432), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(3.3376653, -0.38297144, -2.2952204, 7.0122256), vec4(-0.19583838, -0.21951479, -0.04405034, 0.040380068), vec4(-0.013765891, 0.11841442, -0.16300689, 0.03734604), vec4(-31.77642, -70.86214, -5.6645384, 2.3562365)),
    mat4(vec4(-24.84731, -5.8407044, 0.8097388, -3.0066211), vec4(-3.5153785, -10.087853, -8.900696, -9.773681), vec4(1.4137939, -7.7516947, -8.073735, 0.110253155), vec4(0.11317725, 11.804854, 12.301212, 3.7292614)),
    mat4(vec4(9.362567, 11.713174, -0.49722984, -0.009957121), vec4(2.1004505, -2.2335987, 0.8774605, 4.5194054), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-14.200476, 11.250799, -3.614167, -2.746474), vec4(0.005306553, 2.6359544, -2.3081715, -0.22634201), vec4(-0.0017052869, 0.11265119, 1.0070869, 0.25444132), vec4(-0.021890452, -108.46809, -2.2514987, 7.211717)),
    mat4(vec4(-0.06271778, -0.07305096, -5.558425, 5.7747507), vec4(-0.033172604, -6.5932364, -0.5465898, -2.1271129), vec4(0.04429119, 19.870779, -1.9174488, -10.829139), vec4(0.039593868, -3.3658838, 0.62879133, 9.388285)),
    mat4(vec4(-0.020906946, 0.5016997, -1.60396, 3.9739897), vec4(-14.116647, -5.6320314, 0.11533172, -2.244007), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(2.3758276, 0.7344675, -9.42585, -1.7282971), vec4(0.11907535, -0.6181794, -0.72843254, -0.2958274), vec4(-0.21814533, 0.07219827, -0.23492429, 0.058244046), vec4(-124.99927, -59.562664, -0.5356338, 10.4820795)),
    mat4(vec4(-21.341158, -9.852887, -0.06728689, -32.79679), vec4(-2.306273, -1.9161882, 0.07075858, 10.962963), vec4(5.05221, 6.1378217, -0.35156924, -16.601978), vec4(0.60254544, -3.0944357, 0.07379391, -12.189142)),
    mat4(vec4(-4.0926666, 5.6984234, -0.10884648, 0.5172278), vec4(6.597823, -1.295542, -10.24747, 2.0605915), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-11.041016, -1.727267, -13.253658, -5.3044567), vec4(-0.08233529, 0.28346556, 0.11086188, 0.033272017), vec4(0.17816567, -0.36862642, -0.00985248, 0.18185203), vec4(4.587747, 38.25356, 0.92788625, 8.650902)),
    mat4(vec4(-2.0548725, -201.86287, -0.0065434664, -1.6800108), vec4(-0.43485776, 1.1749663, 0.19468619, 8.001372), vec4(2.110869, -170.5215, -0.15174873, -4.467283), vec4(-0.16220906, 0.7012172, 0.0644586, -6.989527)),
    mat4(vec4(-0.5775319, -1.6356709, -0.18584095, 1.5081521), vec4(-10.046028, 2.7278986, -12.654014, -2.4023314), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-5.0406375, 4.139162, 0.09449681, -2.6226003), vec4(-0.10544489, 0.12420155, 0.0846088, -0.2773238), vec4(-0.22284019, -0.23321922, 0.13458256, -0.017866516), vec4(26.932327, 17.52416, -10.881321, -10.78837)),
    mat4(vec4(-27.125784, -8.781659, -3.0741816, 3.4798355), vec4(4.148134, -4.233007, -9.016876, 4.16812), vec4(-16.758512, -5.822711, 4.054722, 5.8445425), vec4(0.27446285, 4.334256, 12.806946, -1.8126884)),
    mat4(vec4(0.42796925, 8.407661, 0.06883113, -14.229925), vec4(2.672512, 1.2197539, -1.8344728, 2.8224165), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.9830742, 8.944236, -1.1504629, -4.3265924), vec4(-0.023475759, -0.15907055, -0.42637935, 0.11589328), vec4(0.041950222, -0.21535935, -0.07122723, 0.15908366), vec4(-101.51232, 0.34831, 0.77278036, 26.464895)),
    mat4(vec4(0.027170673, -2.085998, 8.533334, -19.456049), vec4(0.29037327, -5.1486573, 5.737693, 4.954904), vec4(7.710748, -2.8508146, -0.92319506, 1.4761099), vec4(2.0909944, -5.1753078, -1.1685946, -3.2550154)),
    mat4(vec4(0.6073655, 0.680405, 0.752367, -5.182517), vec4(-0.7346928, 3.5099447, -2.367339, -1.9820573), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(0.5612714, -0.8052822, 1.9578358, 0.7541197), vec4(-3.0509675, -0.8913338, -2.0507882, 0.08210287), vec4(-1.8096141, -4.047719, -0.87021947, -0.5095532), vec4(-1.7694044, -2.431335, -3.985533, 2.5685859)),
    mat4(vec4(0.00018819174, -1.6301407, -0.8177756, 0.8410233), vec4(-0.18867442, -0.14180064, 0.23432782, 1.1939652), vec4(-0.28679964, 4.192852, -0.15248433, 0.10820271), vec4(-0.5148806, 0.57227784, -3.5086772, -0.8603132)),
    mat4(vec4(-0.057861097, 1.2268503, -4.9752107, 0.97435975), vec4(-0.10037012, 1.4835347, -2.708487, 0.22378573), vec4(-0.26280734, 1.1496403, 0.24401025, -0.12223057), vec4(0.9853024, 1.2418171, -0.027950218, -0.84020066)),
    mat4(vec4(29.311577, 5.1649904, -7.3978987, 38.205784), vec4(-0.13957557, -0.39724877, -0.57345605, 0.16402759), vec4(0.44155926, 0.59527594, 1.1621081, 0.8841033), vec4(-0.75949806, -1.1115868, -0.1917119, 0.35651338)),
    mat4(vec4(1.55433, 0.57734424, 0.4066175, -0.38792506), vec4(-0.28983963, -2.51321, -1.8156649, -0.5273519), vec4(20.610762, 10.519593, 4.2690234, 35.395996), vec4(-0.06966489, -1.7839004, -4.118357, -0.66634846)),
    mat4(vec4(-0.0768172, -0.90769356, -0.76780784, 1.6518021), vec4(-3.379264, -10.539941, -16.59533, -2.8945174), vec4(3.7318642, 1.2683077, 0.5771581, 5.465723), vec4(-0.34995794, -2.0756266, -0.71379185, 1.1416491)),
    mat4(vec4(-0.063372806, 1.2796607, 1.2495276, 2.0932581), vec4(-0.80130994, -3.971518, 0.8077129, 0.61369365), vec4(0.006266941, -2.1069548, -1.4359239, 0.20941292), vec4(0.17255613, -6.439542, -0.43115193, -0.3608885)),
    mat4(vec4(0.20230684, 1.3585289, 1.690652, 0.30478713), vec4(-0.2972322, 0.5015593, -3.7431738, -0.15872914), vec4(-0.063379474, -1.8211364, -0.5723202, -1.0097622), vec4(1.6373553, 5.8172894, 2.0908377, -0.12513334)),
    mat4(vec4(4.432494, -1.0324867, 0.15783006, -0.19616091), vec4(-1.0922611, 0.80809677, -0.4039501, -0.17652889), vec4(0.14157669, 0.91334754, -0.5151216, -0.50741524), vec4(-11.98909, -0.6244048, -0.29388586, -0.9342302)),
    mat4(vec4(-1.192838, -0.59448165, -0.5513403, 0.22779986), vec4(0.32817048, -0.0049283956, -0.3480491, -0.09889783), vec4(-1.6917663, -0.28460243, 0.22333966, 1.7914547), vec4(-2.6235445, 0.3005778, -0.55614203, 0.3724611)),
    mat4(vec4(1.455877, 0.4335604, -0.4377843, 0.99129975), vec4(1.41245, -0.18254372, 0.20757042, -0.0055713546), vec4(-0.48564953, 0.20124733, 0.0506122, -0.7202818), vec4(0.3632785, 1.0082462, -0.3909515, 0.14880356)),
    mat4(vec4(34.768063, -7.8861685, 0.14344464, 110.397125), vec4(-1.2552068, -0.7247046, -0.13631397, -0.745887), vec4(-1.7309783, 0.50249267, -0.22249134, 0.49455148), vec4(-3.3301651, -0.11269005, -0.26882094, -0.3997913)),
    mat4(vec4(-0.63325346, -0.23269548, 0.03240724, -0.24410391), vec4(-0.56117594, -1.0841293, -0.33914873, -1.479392), vec4(21.043505, -9.559243, 0.2872074, 75.28369), vec4(1.6869254, -3.9069245, 0.037293382, -1.0802398)),
    mat4(vec4(1.1544132, -0.9880814, -0.20143014, -1.0886188), vec4(-9.796492, -1.5660758, 0.031343132, -7.743226), vec4(4.532845, -0.99818444, -0.35377118, -1.7958479), vec4(-0.08037113, -0.53063697, -0.030638263, 0.17173046)),
    mat4(vec4(-2.2670875, 1.5502144, -0.13599676, 0.6596191), vec4(-0.39481798, 0.25847867, -0.106472634, -1.1384745), vec4(-1.612787, -0.55916464, -0.22542503, -0.8191134), vec4(-1.0800495, -0.92530394, -0.141488, -0.7818429)),
    mat4(vec4(0.91121244, 0.13503289, -0.3357986, -0.49670896), vec4(-1.6732597, 1.6311814, -0.03868916, 0.08786737), vec4(-2.7890007, -0.8569007, -0.17694147, -0.78453374), vec4(-1.2615094, -0.31259876, -0.15151915, 1.4896415)),
    mat4(vec4(-0.13391794, -0.891611, -0.60111266, 0.18036509), vec4(-45.253212, -2.0789275, -55.56758, -0.24589449), vec4(-0.94204605, -4.857143, 0.773831, -0.33291525), vec4(-20.090935, -0.78326464, 2.4229555, 0.09803279)),
    mat4(vec4(3.1258688, 3.3962352, -0.3281802, -0.58999366), vec4(-0.50923795, 0.3633625, -0.17792912, -0.26248187), vec4(0.87033373, 0.18452893, -0.050617557, -0.67375934), vec4(-0.14110301, -0.014655196, 0.44809416, -0.26554093)),
    mat4(vec4(-0.5455171, 1.0173776, 0.915084, -0.17738713), vec4(-4.9446936, 0.19119684, -0.84807664, -0.281693), vec4(4.4927692, -1.2343456, 0.28497058, -0.19485503), vec4(0.87839663, -0.106170714, -2.096666, -0.46047825)),
    mat4(vec4(-3.0281644, -21.505493, -64.173225, -0.22722849), vec4(-26.211569, 0.016989341, 1.0031826, -0.14194465), vec4(0.38507217, 0.9351074, -0.0777235, -0.41040322), vec4(1.0386806, -0.18513341, 1.3027041, -0.24041142)),
    mat4(vec4(0.22283384, 2.367998, -1.4081047, -0.15789123), vec4(-2.3488436, -0.09097922, -0.005557982, -0.3844968), vec4(-25.454828, -30.255812, -68.86, -0.22142246), vec4(0.9135177, 0.12279967, -27.964146, -0.17632717)),
    mat4(vec4(1.1946952, -1.5483994, -1.7453567, 0.2640197), vec4(-10.479829, -0.065224044, -6.247429, 0.09248742), vec4(-0.22627845, -6.987417, -8.7303, -0.24033648), vec4(0.5106705, 0.21911664, -0.14479464, -0.05997175)),
    mat4(vec4(-1.0584769, -0.76991665, 0.35826787, 0.2570622), vec4(-38.088936, 0.9563952, -10.26186, -0.012669509), vec4(-1.8953276, 1.3880517, 2.193768, -0.47001857), vec4(-1.6761823, 0.29450762, 0.62701017, -0.20249395)),
    mat4(vec4(2.902732, 0.4166712, 0.2856457, -0.086941235), vec4(-0.9827138, -0.21861658, -1.2146354, -0.12214594), vec4(-2.7559738, -1.0897014, 0.20467448, -0.1411117), vec4(-1.0689127, -2.4455764, -1.3695912, -0.51198465)),
    mat4(vec4(0.81078166, -0.4044338, 2.720114, -0.018226687), vec4(2.3581884, 1.6104178, -4.943122, -0.75195354), vec4(-0.3908668, 1.0078644, -1.1918337, -0.14066498), vec4(-1.492688, -4.646078, 1.8119683, -0.52144)),
    mat4(vec4(-1.1722519, 0.9783798, -0.01346622, -1.4579939), vec4(-1.8240347, 0.76718897, -1.1876087, -0.013630305), vec4(2.17518, 0.035115838, -1.155891, 0.3128857), vec4(-2.617839, 0.21239686, -1.7636377, -0.13492033)),
    mat4(vec4(0.8584923, 0.410397, -4.2714176, -0.6748531), vec4(-0.21329014, -0.23891681, 2.2193787, -1.5731057), vec4(-0.9720868, 0.017681163, -3.4190187, -0.47943452), vec4(-0.61413044, 0.50284374, 0.7826973, 0.70128167)),
    mat4(vec4(-21.171513, 26.865187, -34.713753, 30.892735), vec4(0.64165086, -0.961954, -2.718338, -1.7435387), vec4(0.6778252, 1.7303016, 0.32805926, 0.58119136), vec4(-0.31990194, -0.74946654, 1.1855053, -0.5359104)),
    mat4(vec4(-0.5938348, -0.2984739, 2.1709085, 0.7654855), vec4(-1.3230438, -0.21147202, 2.9178054, 0.84411603), vec4(-3.8531673, 14.801703, -33.84283, 32.70362), vec4(0.7274438, 0.19319296, -2.167876, -2.0092883)),
    mat4(vec4(-2.0672529, 1.5651822, 4.6140957, -4.5149217), vec4(0.85987955, -20.381807, -4.8222675, 6.1487484), vec4(-11.035366, 2.083262, 9.291252, 18.810875), vec4(1.0576226, -0.83874434, 0.3078845, -0.061636534)),
    mat4(vec4(1.2366849, -0.12529887, 1.47252, 0.15226749), vec4(3.912004, -0.6518246, 1.4097291, -0.3996969), vec4(1.3647116, -0.7544857, 2.0510762, -3.3437326), vec4(0.4689717, -1.8347169, 3.3225002, -1.0843767)),
    mat4(vec4(-1.1071062, -0.18258168, -1.8788732, -0.4204919), vec4(0.29666585, -1.5362499, 1.769943, 0.34129623), vec4(-12.318685, 2.4055486, 0.08319975, 0.4437303), vec4(-1.6225735, -2.517713, 0.03564834, -0.37749812))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(8.4412, 3.6170914, 6.4581738, 4.2712755),
    vec4(0.41956437, 2.4876723, -0.15839966, -0.114488125),
    vec4(-5.21652, -5.002616, -4.8846345, -0.22173963),
    vec4(-10.75025, -5.905891, -18.288715, 1.4138744)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.19069599, 0.24618374, 0.13081251, -0.18281528),
    vec4(0.22839579, 0.10921503, 0.2918631, -0.2877968),
    vec4(0.13975196, 0.11612862, 0.10460415, -0.06111151),
    vec4(0.074991226, 0.112442635, 0.089019135, -0.1614554)
);
const float NMT_B3 = -1.8172282;

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
const uint NMT_HEAVY = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const uint NMT_SLOTS = 6u;
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
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_6 - center * rest0_6) * per_h;
    float moved2 = (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)) * (per_h * per_h);
    float moved3 = (rest3_6 - center * rest2_6 - center * (rest2_6 - center * rest1_6) - center * (rest2_6 - center
        * rest1_6 - center * (rest1_6 - center * rest0_6))) * (per_h * per_h * per_h);
    float moved4 = (rest4_6 - center * rest3_6 - center * (rest3_6 - center * rest2_6) - center * (rest3_6 - center
        * rest2_6 - center * (rest2_6 - center * rest1_6)) - center * (rest3_6 - center * rest2_6 - center * (rest2_6
        - center * rest1_6) - center * (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_6 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_6 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_6 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_6 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    vec3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_6 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_6 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_6) * nmt_transmittance(mat3x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
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
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4(slot0.y, slot1.y, slot2.y, slot3.y),
        vec4(slot4.x, slot5.x, 0.0, 0.0),
        vec4(slot4.y, slot5.y, 0.0, 0.0),
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
    uint first = 3u * (uint(at.y) * width + uint(at.x));
    vec4 sums0 = texelFetch(sums0_texture, at, 0);
    vec4 sums1 = texelFetch(sums1_texture, at, 0);
    vec4 moments = vec4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, uvec4(core[first], core[first + 1u]), uvec4(core[first + 2u], 0u, 0u), sums1.y, sums0.x, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
