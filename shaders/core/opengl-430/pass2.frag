#version 430
// OpenGL 4.3, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit b1d5f0d9a708, backend fused, seed 1, epochs 6000, dataset e4b670063e777080a8d4e335c8112fc6ed2f2f51991ae458c750de88c0ee67d6.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.076e-3, worst 1.000.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(5.105601, -7.776949, -6.0050955, 4.35002), vec4(0.023220908, 0.30917516, -0.13695663, -0.14382242), vec4(0.21147795, 0.35639855, -0.062964685, 0.002809352), vec4(-2.5967512, 22.351898, -23.143448, -205.42451)),
    mat4(vec4(-0.31193998, 6.7898197, -54.12732, -47.573433), vec4(-0.60654885, 5.9676127, 3.0856981, -10.418275), vec4(-4.4941916, -2.0020182, -15.190292, 2.0452278), vec4(-0.8066691, -2.97389, 0.98539966, 7.3517427)),
    mat4(vec4(15.56608, -5.7345085, -0.4197574, 13.895891), vec4(-1.8566706, -6.4097342, 1.708392, 0.94489276), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(2.8988519, 2.1483068, -6.141246, 3.832572), vec4(-0.043049954, 0.0013504993, 0.5068191, 0.10825731), vec4(0.120203584, -0.019085664, 0.11918055, 0.37410185), vec4(-275.1931, -0.6838616, -0.87953967, -270.13834)),
    mat4(vec4(-11.156709, 6.9914265, -1.1131457, -1.2721392), vec4(-8.456398, 1.8514961, -3.006853, 2.3839877), vec4(4.4430394, 2.910352, -1.3252851, 4.6527796), vec4(4.8252115, 1.7819123, 0.96366787, -8.276807)),
    mat4(vec4(7.911175, 0.25640938, 0.5788228, -0.6366296), vec4(0.69316465, -1.0827959, -4.561138, 0.3928774), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(1.8522606, 6.257332, -3.080659, -2.634544), vec4(0.5086991, 0.21848376, -0.23465014, -0.104933806), vec4(0.09076835, -0.23718849, -0.3026637, -0.080448024), vec4(-14.326484, -1.8913914, -1.2898521, 16.793245)),
    mat4(vec4(0.15697204, 1.8957422, -3.1672099, 12.570847), vec4(0.068353504, -11.033392, -9.184098, 3.1564772), vec4(8.724328, 1.0235292, -23.29579, 0.39650568), vec4(-1.2083226, 5.060427, 10.9705925, 0.56463635)),
    mat4(vec4(-5.697375, -0.1546829, 0.06553507, 1.9628643), vec4(-0.33343205, 3.551, 3.5038662, -2.689176), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.5225184, 0.5133232, -13.984075, -2.4731104), vec4(0.0394662, -0.012775333, 0.14760341, -2.6331127), vec4(-1.2133482, 0.26808673, -0.025899684, 1.1622663), vec4(1.7089345, 7.072623, -2.3439279, -2.0342574)),
    mat4(vec4(0.41221315, -6.7205515, 1.1159382, -4.7000427), vec4(3.415568, -12.434128, 0.1943438, -1.0476273), vec4(-4.455235, -2.4347835, -0.83084714, -2.2484365), vec4(-0.58668476, 13.411483, 0.38693205, 1.18982)),
    mat4(vec4(-0.039616797, -11.22243, 0.83889264, 1.2326022), vec4(3.3515599, 1.0467722, -13.557409, -0.093907766), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-13.982129, 2.3758018, -3.3194711, 1.1728226), vec4(0.110941164, -0.2638195, -0.025995683, -0.030497411), vec4(-0.037691645, 0.053093266, -0.0530958, -0.21025592), vec4(-6.103725, 9.406993, -0.5770045, -185.77985)),
    mat4(vec4(-0.666941, -3.3638792, -0.27342474, -25.038755), vec4(-0.51459336, 3.0862372, -0.06407232, -3.1050527), vec4(1.7560154, -8.128283, -0.243695, 3.2070622), vec4(0.38069966, -4.452379, -0.041192476, 0.42360008)),
    mat4(vec4(-1.9304729, -3.7500045, -0.23138194, 0.56804115), vec4(-13.277853, 4.758931, -3.584098, 4.9006147), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.1450951, 4.120741, -13.907398, -8.625761), vec4(-0.387003, -0.36109456, 0.0064239977, 0.009801125), vec4(0.25361887, 0.053927135, -0.0021939417, -0.15860346), vec4(-21.365168, -172.61107, 0.17477922, -51.368767)),
    mat4(vec4(-8.635486, -29.214334, 0.021726517, -8.044878), vec4(-11.482672, -3.2639728, -0.013819815, -3.2251644), vec4(-9.422208, 0.022588652, 0.021991013, 2.2397661), vec4(13.14991, -2.1781762, 0.0077962712, 2.25823)),
    mat4(vec4(11.179421, 12.596346, 0.026374217, 6.4431143), vec4(-2.3435538, 2.4249837, -13.852932, -9.073568), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-4.829132, -7.8334613, -4.5468693, -2.1926074), vec4(-0.31630903, -0.29768285, 0.0039741467, -0.10085432), vec4(0.32456073, 0.0021103336, 0.36441302, -0.04167412), vec4(7.2600203, 39.73682, -13.001361, -68.57387)),
    mat4(vec4(-3.5925124, -40.307766, 2.5083969, -56.382004), vec4(7.147693, -2.452206, -8.350125, 7.6832743), vec4(-8.0426445, 11.154003, -7.982382, -6.9970746), vec4(-4.2268105, 0.3991062, 16.75555, -10.219937)),
    mat4(vec4(-0.88635343, -0.75385606, 3.154558, 1.6476432), vec4(0.35605, -8.718019, -5.2014933, -1.9921725), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.9229885, -4.844933, 1.1987408, 3.0472248), vec4(0.093173504, 0.35200232, 0.040751476, -0.029037263), vec4(-0.06796274, -0.44380617, 0.75943786, 0.044587515), vec4(-0.43263108, 21.904581, -0.8844772, 2.7531273)),
    mat4(vec4(-1.2013022, -108.8591, 2.3038723, 5.3356767), vec4(-4.8903656, 2.7748172, 1.6174321, 0.32124317), vec4(-4.625781, -29.927137, 1.7514372, 1.2718332), vec4(6.909279, 2.365779, -0.34391, 4.7517195)),
    mat4(vec4(1.5040059, 3.7027698, 2.6831563, 4.5805984), vec4(1.7121153, 3.79226, -0.71379894, -4.2009153), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(1.4117749, 1.1455115, -1.0086119, 0.0004797554), vec4(-0.17528519, 0.11391741, -0.29034904, 0.7241151), vec4(-2.1908772, -0.391476, -0.08961872, 0.9594575), vec4(-0.14267835, 0.15408039, -2.051766, 0.055051133)),
    mat4(vec4(0.9596603, -0.48269808, -0.42018393, -0.1803454), vec4(-1.2544678, 1.0647244, 0.02147165, -0.7638201), vec4(0.47986585, -0.84491074, 1.7447041, 1.3960198), vec4(-0.19821063, -0.79286224, 0.85816985, -0.26733887)),
    mat4(vec4(0.94047356, 0.95441526, -0.9931214, 0.52400935), vec4(0.53910285, -0.11692361, -1.0469438, -0.15025753), vec4(0.23474608, 0.2108287, 0.63860965, 0.1842764), vec4(-0.19755994, -0.02986438, 0.6369611, -0.2505009)),
    mat4(vec4(0.19427648, -0.79274374, 0.47619057, 1.3965701), vec4(-5.2104583, -4.6881537, -1.2886525, 0.596525), vec4(2.9574912, -2.2038035, 1.0524839, 5.7795506), vec4(0.69122237, 0.32629198, 1.0412474, 0.4487828)),
    mat4(vec4(1.3182099, 0.43033296, 0.04891999, -0.18893845), vec4(0.105346136, -0.47653708, 0.6135861, 0.21682577), vec4(17.60009, -23.61967, -1.7953713, 16.923414), vec4(-0.011252998, -0.1360435, -0.7944033, -0.2513587)),
    mat4(vec4(-1.2667481, -3.0897038, -4.122969, 0.31176418), vec4(-1.3825121, 0.23001349, -1.3250293, 0.38488436), vec4(-135.79802, -133.9177, -22.080603, 71.74813), vec4(0.23596533, -1.0659001, 2.6728966, -0.4659539)),
    mat4(vec4(-0.88412523, -0.0022808446, 1.3066578, 2.3039625), vec4(-1.0502533, -3.6898844, 0.19183235, 0.41163737), vec4(1.3648864, 2.927925, 1.3360986, 0.0046246676), vec4(0.664076, -11.838231, -7.549727, -1.0275925)),
    mat4(vec4(-0.87744904, 1.0097657, -1.7211068, -0.04698234), vec4(2.380362, -0.70639944, -0.8697528, -1.578907), vec4(0.22534208, -1.1221607, 0.63426286, 1.8184385), vec4(-2.2981977, -1.9128195, 1.0795509, 0.12111062)),
    mat4(vec4(-1.8443363, 0.56556493, 0.09560901, -1.3190942), vec4(1.0664049, 0.3087944, -0.23027885, 0.4483379), vec4(-3.224628, -0.84289473, -0.57763636, 0.7255968), vec4(-2.5056968, -0.08255808, -0.47086683, -2.7120073)),
    mat4(vec4(1.3064679, -0.017068246, -0.62331957, -1.9613546), vec4(-5.493033, -0.8580647, -0.39121553, -0.74754095), vec4(0.8735196, -0.21701387, -0.2966358, 0.85576195), vec4(-2.0695543, -1.300886, -0.7988393, -2.4490328)),
    mat4(vec4(0.6565235, 0.3903638, -0.28224826, -2.082288), vec4(2.006443, 2.4669216, -0.14219742, -0.060256653), vec4(0.67531955, 0.13639764, -0.03523145, -1.755812), vec4(-0.865527, 0.6221016, -0.6368253, -1.5856439)),
    mat4(vec4(0.4891402, 0.2581284, -0.08101575, -0.24707842), vec4(-0.16358995, 0.5099237, -0.105441764, -3.0301104), vec4(0.62760687, 1.4812951, -0.6093596, 5.783497), vec4(1.8950132, -0.07125754, -0.6786951, 0.14868382)),
    mat4(vec4(0.7869905, -5.3466587, 0.1741541, 2.0395641), vec4(1.3420644, -0.28202555, -0.47155303, 1.0279235), vec4(-9.01687, -13.114879, 0.33679408, 29.04798), vec4(0.9333192, -0.21021648, 0.23570606, -2.5541313)),
    mat4(vec4(0.6453444, 0.9763128, -0.3718651, 0.39026862), vec4(0.17396936, 0.5483875, -0.45548332, 4.2985826), vec4(-1.0830393, 4.6675353, -0.333695, 71.7838), vec4(-1.4337493, -0.53264886, -0.19717096, 0.6267395)),
    mat4(vec4(-1.4478867, -0.5249548, -0.4335779, 1.6650672), vec4(-2.5251105, -0.8519394, -0.04889558, 2.3745184), vec4(-0.4131709, -0.78096247, -0.265346, -2.8289497), vec4(-0.8659692, 0.67117697, -0.40825266, -7.0920377)),
    mat4(vec4(-2.5151942, 0.34818825, -0.7929048, -1.0159082), vec4(4.2902603, -2.4972966, 0.12204305, 3.0165975), vec4(1.1052955, 0.9943748, -0.4099802, -1.3225311), vec4(5.2346444, -1.6471541, -0.15307099, 2.7453272)),
    mat4(vec4(0.07138306, 2.076648, -1.8942585, -3.3003516), vec4(-0.2882856, 0.5259255, -1.1715925, 0.6548139), vec4(-0.55099267, -2.045182, 0.16101238, -19.281754), vec4(0.1813682, -1.2356466, 6.7513304, -2.068983)),
    mat4(vec4(-0.28732413, 2.1736734, -2.2015593, 0.70505905), vec4(-0.61555994, -0.97298265, -0.8315434, -4.331392), vec4(-0.7491897, -1.3155322, 0.7434592, 0.24302031), vec4(-0.92366385, 0.5785332, -1.1841005, -2.1942017)),
    mat4(vec4(-0.025959171, 1.0332141, -0.3057038, 0.14345387), vec4(0.1820034, 0.6463979, -0.4230483, 0.88760984), vec4(-0.506119, -2.2852664, 0.7100101, -0.04251004), vec4(-1.605868, -0.76535636, 0.47167516, -0.5869909)),
    mat4(vec4(-0.27339047, -0.19307494, -0.079702504, 0.6384779), vec4(0.2063675, -4.1424527, -4.7255635, -3.6037133), vec4(-0.7378594, -0.42104614, 2.5694761, 2.440463), vec4(-0.1201131, 0.6122979, 0.9770483, -1.823438)),
    mat4(vec4(-0.64848614, -7.342971, -0.12128481, 1.2423502), vec4(-0.1644702, 2.21513, -0.6999483, -0.13381991), vec4(0.055238426, -14.326893, 2.2322915, 1.5615437), vec4(-0.15758026, 0.6125606, 0.48911768, -0.33160573)),
    mat4(vec4(-0.18421619, -2.0189714, -1.7023716, 0.43409413), vec4(0.23080006, -0.8519016, -3.5074615, 1.3633063), vec4(0.04658364, -78.44668, 0.79340786, 32.057377), vec4(-0.34704253, 0.33576915, -0.9627348, 0.5085888)),
    mat4(vec4(-0.45095307, -0.47410285, 0.24623942, -0.8926218), vec4(-0.09543575, -1.6511658, -2.8479211, -25.014994), vec4(-0.23262836, 3.4916303, -1.1458504, -2.7429433), vec4(-0.32691115, -0.44231844, -8.368213, -4.1542387)),
    mat4(vec4(-0.4557896, -1.934449, 1.0928212, -0.232232), vec4(-0.38127586, 2.3346226, 0.41953424, -9.160213), vec4(-0.42633402, -1.3171939, 0.78922266, 1.3385485), vec4(0.10132453, -1.1957477, -3.0540102, -7.5172434)),
    mat4(vec4(-0.6846841, -0.39949378, -0.43331692, -1.1108447), vec4(0.086074844, -0.12320614, -0.18615182, 0.19640923), vec4(-0.35280946, 0.02964202, -0.028854044, -0.30641377), vec4(-0.47222504, -0.11014126, -0.004455302, -1.7318124)),
    mat4(vec4(0.3095977, -0.26672626, -0.26871482, -0.5386906), vec4(-0.1904637, -0.22352202, -0.3699714, 0.2667565), vec4(-0.023135059, -0.26332396, -0.45012188, 0.1675753), vec4(-0.61727947, -0.032617245, -0.4171554, 0.19419159)),
    mat4(vec4(-1.0615184, -0.1701745, -0.035369314, -1.5066206), vec4(-0.7746694, -0.45181212, -0.24145463, 0.4399054), vec4(-0.44384918, -0.19252208, -0.25796694, 0.12573382), vec4(-1.3391436, -0.42201588, -0.5491518, -1.0046335)),
    mat4(vec4(-0.0066728536, -0.4799766, -0.26922658, 0.12601812), vec4(-1.2285767, -0.109489426, -1.134757, -0.48262617), vec4(-0.024299905, -0.09656521, -0.59825903, -0.6290528), vec4(-0.31450796, -0.23098287, -0.21771114, 0.98455596)),
    mat4(vec4(0.08517324, -0.08440631, -0.035429735, 0.88830054), vec4(-1.3710811, -0.62781394, -1.6546706, -0.10364189), vec4(-0.5688971, -0.33749542, 0.20412302, 16.703667), vec4(-0.4831616, -0.19607466, -0.38795856, 1.1162999)),
    mat4(vec4(-0.41509444, -0.110484555, -0.2607657, -2.3323455), vec4(-0.16110119, -0.042242657, 0.237565, -0.47444546), vec4(-0.25614524, 0.09534541, 0.22616278, 46.38153), vec4(0.025013793, -0.34746808, 0.17879407, 2.955301)),
    mat4(vec4(-0.2926618, -0.47597834, -0.1421112, -0.5474815), vec4(-0.31367156, -0.27706975, 0.0012671659, -0.5512675), vec4(-0.1773227, -0.33372575, -0.2741667, 0.59745055), vec4(-0.1527745, -0.08500009, 0.14344408, -4.103511)),
    mat4(vec4(-0.38976654, -0.50683564, -0.67122334, -0.84118474), vec4(-0.47082475, 0.011163686, -0.76321733, 0.28329408), vec4(-0.7255998, -0.10084268, -0.42822677, 0.8368735), vec4(-0.45611984, -0.24425219, -0.2817987, -0.32840288))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(0.871116, 1.8918169, -0.7374457, -5.431118),
    vec4(-5.1308475, -1.3067405, -0.52322567, 5.599536),
    vec4(-0.71397114, 0.6413444, -0.2442821, -2.0892909),
    vec4(-0.1836862, -0.39407033, -0.15463342, 5.6735487)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.1441644, 0.10191933, 0.16379957, -0.17671104),
    vec4(0.09976095, 0.10984438, -0.03324448, -0.14598179),
    vec4(-0.058332108, 0.10727377, 0.10310578, 0.18810688),
    vec4(-0.56664026, -0.00066999835, 0.25467998, -0.22518922)
);
const float NMT_B3 = -2.3455548;

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
    vec2 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * ((1.0 + abs(center)) * per_h + 1.0)
            * 4.7683716e-7 * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) / (max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
            * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7) * max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
            * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7));
        float most = min(exp(-(front_6 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_6 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
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
