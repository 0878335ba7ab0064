#version 310 es
// OpenGL ES 3.1, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
precision highp float;
precision highp int;
precision highp sampler2D;

// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset e4b670063e777080a8d4e335c8112fc6ed2f2f51991ae458c750de88c0ee67d6.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(0.7114112, 1.794765, -0.6456376, 0.84930515), vec4(-0.028981173, 0.02970049, 0.329591, -0.035812013), vec4(-0.012841912, 0.09650574, 0.06255524, 0.041502737), vec4(2.4123957, 2.9781296, 3.1630163, -15.838907)),
    mat4(vec4(-1.7079562, -0.7621927, 1.3614055, -20.888063), vec4(-1.738914, 1.0196699, 0.6202387, -1.0327412), vec4(-1.6108372, 1.55356, 3.7318592, 0.7500771), vec4(1.7808586, -4.1291547, -1.2347131, -0.080635615)),
    mat4(vec4(3.9679668, 0.6957134, -1.6087618, 1.9531379), vec4(-0.18651953, 0.2290573, -1.6097274, 0.44473892), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.13436112, -0.35477012, -0.99324006, 0.6968991), vec4(-0.01993656, -0.19747771, 0.040589366, -0.035102323), vec4(0.14162314, -0.017389048, 0.06625489, -0.04209293), vec4(-4.261307, 0.92345315, -29.521399, 3.5638864)),
    mat4(vec4(-3.4156718, 3.3481202, -0.9449227, -0.20882013), vec4(-1.8078896, 1.2912533, -0.13449717, 2.2615066), vec4(1.2349912, -1.5557613, 0.8040417, -0.32323965), vec4(0.45095217, 0.501725, -1.3727416, -3.8504052)),
    mat4(vec4(1.5367998, 0.27913368, -0.93597645, -0.7016706), vec4(-0.48996648, -0.29803982, 0.15136014, 1.4305378), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.4699823, 1.0923232, -1.1598638, 1.2263182), vec4(-0.14797291, 0.026214255, -0.113542765, 0.16095562), vec4(0.063653596, -0.028496107, -0.014273023, -0.066561654), vec4(-0.10964669, -7.8148737, -2.3802822, 1.3221512)),
    mat4(vec4(0.833382, -5.0199294, 1.8868679, 0.2592309), vec4(3.3271794, -2.7400637, -0.18183625, -1.7967983), vec4(-0.33488667, -0.57395476, -6.2630186, -0.566368), vec4(-3.469189, 2.074026, 1.8110873, -1.3759528)),
    mat4(vec4(-1.7062492, 2.9541376, 1.1419351, -0.46530396), vec4(-2.0482693, 0.3081567, -0.1017172, 0.61162734), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.96986026, 2.031756, -1.3089055, -1.1332997), vec4(0.26061314, -0.02159665, 0.1892596, -0.23133557), vec4(-0.16803175, -0.0238116, 0.13244852, 0.11946321), vec4(1.6070043, 4.6796885, 0.5326129, 1.6828455)),
    mat4(vec4(-0.24018972, -0.36707783, -1.1872584, -1.8052766), vec4(2.2013566, -2.5746849, -0.9833889, 0.71542686), vec4(0.9339632, 0.074673206, 0.3756152, -1.4103022), vec4(-1.2919157, 2.7009892, 0.17862882, 0.9242325)),
    mat4(vec4(-0.5461605, -2.2530963, 0.028314795, -0.22744498), vec4(-0.46826938, 0.19410363, -1.5857325, 0.62136894), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.6077851, 2.13829, -2.0248055, -0.9561631), vec4(-0.21585236, -0.17091903, 0.0005434734, 0.085117176), vec4(0.3689412, 0.042130224, -0.00078797276, -0.010276212), vec4(1.7625064, -3.3381279, -0.5359629, -6.5600257)),
    mat4(vec4(-1.0561279, -0.39834294, -0.01582293, -4.003998), vec4(-1.4282976, -0.3875128, -0.017486755, 1.0817925), vec4(1.6093467, -0.29775304, 0.0014686225, -0.5089773), vec4(1.1229762, 0.25455555, 0.023702715, -1.4840105)),
    mat4(vec4(-1.0692314, 0.44872382, 0.0050543183, -2.0327947), vec4(-1.2847424, 1.9871289, -2.0014124, 0.5855031), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.25211033, 0.005119752, -2.1872346, -1.1620688), vec4(0.017108291, -0.041987717, -0.027050076, -0.13018315), vec4(-0.05244853, -0.00975882, -0.0017314742, -0.024875414), vec4(-3.3165135, 3.4593008, 0.056680337, -3.8843656)),
    mat4(vec4(-5.0323253, -3.7635498, -0.14022315, -2.9610775), vec4(0.19241972, 0.98123837, -0.020708552, -0.82796156), vec4(-0.7785813, -2.6562915, -0.029912062, 0.15352848), vec4(-0.23903932, -1.3826402, 0.03861026, 0.78095865)),
    mat4(vec4(0.051276475, 2.8420196, 0.022135658, 1.7738895), vec4(1.1062568, -0.03576447, -1.9842397, -1.0732489), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.89384013, 2.1012056, 1.0233192, 0.29809642), vec4(-0.09234901, 0.25171867, 0.091949716, 0.027206952), vec4(0.06028613, -0.09364583, -0.003017085, -0.07408811), vec4(-8.21473, -7.1158323, -0.29907146, -13.753689)),
    mat4(vec4(-0.82880133, -0.11900272, 1.0887092, -1.0829563), vec4(1.5570911, -2.0484927, 0.6727108, 2.8067222), vec4(-1.3930216, 3.9515226, 2.191993, -1.9209694), vec4(-1.5297359, 1.3419784, 1.7527841, -4.159152)),
    mat4(vec4(-1.3002264, -0.1587132, -1.3874993, -2.2122061), vec4(0.9308778, -0.01432749, -0.32084987, 0.5311433), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.0899152, -0.46256414, 0.7049528, -1.9639246), vec4(0.07281596, -0.029488033, 0.08644452, 0.33723482), vec4(-0.024699729, 0.039019354, -0.0020412535, -0.107665926), vec4(-5.0240855, 4.4698567, -0.3773489, 3.029914)),
    mat4(vec4(0.4699823, -12.642521, 2.0421138, 0.5925172), vec4(-0.6282306, 0.7541472, 0.78359836, 2.1257553), vec4(1.0577993, -5.0155177, 0.5018363, -3.7114465), vec4(1.4569777, 0.20955017, -0.26426747, -0.516294)),
    mat4(vec4(-1.849059, 0.83120733, 1.6998835, 0.43989202), vec4(0.29986665, 0.44387412, 0.027788686, -1.4363279), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(0.7740623, 1.164834, -2.068747, 0.5035737), vec4(-0.43030062, 0.5031227, -0.5259753, -0.3920844), vec4(0.10343112, -0.9487578, 0.4521868, 0.7030511), vec4(0.29194787, -0.77824557, 2.0776682, 0.6425224)),
    mat4(vec4(0.34115967, 0.8258437, -1.1655577, 0.4527021), vec4(-0.30841342, -1.5406653, 0.793599, -0.4885833), vec4(0.24813442, -0.06837169, 0.7312526, 0.48864943), vec4(-0.06723341, 0.030995093, 0.3126809, 0.34851396)),
    mat4(vec4(1.1542072, 0.60191077, -0.1673615, 1.5101223), vec4(-0.6295398, 0.1350956, -0.15090144, -0.0045507145), vec4(-0.7594554, -3.183002, -0.011628814, -0.537017), vec4(0.0935774, 0.28425312, -0.6353981, -0.33264762)),
    mat4(vec4(0.107764795, 0.6251307, -0.6540966, 0.17470424), vec4(0.08688614, 1.2753782, 0.002994262, 0.35474792), vec4(0.80133814, -1.0117424, 0.9615147, 0.7564474), vec4(0.5615409, -0.60304195, 0.57057774, 0.3935742)),
    mat4(vec4(0.94817245, 1.3650261, -0.11474803, 0.49694648), vec4(0.41581315, 1.8526163, -0.76631796, 0.9206522), vec4(14.029429, -18.676725, -7.6060667, 13.889425), vec4(0.49538067, 1.4112307, -0.23383838, 1.0261047)),
    mat4(vec4(1.0396186, 1.1263485, -0.2977602, 0.5864095), vec4(-0.022290334, 1.0802742, -2.224464, 0.6896624), vec4(3.2834804, -4.8464727, 0.49362117, 2.981774), vec4(0.6474172, 0.45798972, -1.4866697, 0.41479996)),
    mat4(vec4(-0.049895614, -1.7115567, 0.5712569, 0.42274615), vec4(-0.57910365, -0.37556976, 0.12025096, -0.5134444), vec4(-0.078454964, -1.104504, -0.21341194, 0.32574376), vec4(-0.60929734, 0.39671648, 1.716525, -0.6434868)),
    mat4(vec4(0.29538763, 1.2219275, -0.3817008, 0.46568033), vec4(-0.3134722, -0.82973665, 0.42114016, -0.6720282), vec4(0.073724896, -1.2034802, -0.19534321, 0.33451772), vec4(0.081607856, 0.8409012, -0.3902697, 0.5598342)),
    mat4(vec4(-0.9394346, 1.2753603, 0.046467967, -1.0432429), vec4(0.4232378, 0.25417325, -0.22898075, -0.33732072), vec4(-1.0096414, 1.3777792, -0.3391435, 0.2819673), vec4(-3.310305, 2.0749035, -0.3008336, -1.6021631)),
    mat4(vec4(1.258784, 0.19042464, -0.41340786, -0.12071069), vec4(-1.519997, 0.7436436, -0.3120882, -0.1729203), vec4(0.483262, -0.09374421, 0.23163426, 0.31795964), vec4(0.4230913, 0.061426286, -0.25224203, -0.22310378)),
    mat4(vec4(0.93325996, 1.8971597, -0.28234145, -0.025177272), vec4(-7.6522527, -0.3206657, 0.14168794, -1.5123086), vec4(0.15061197, 0.16521153, 0.03541052, -0.9992068), vec4(1.2428966, -0.08382708, -0.22232577, 0.048396748)),
    mat4(vec4(-0.18973663, -0.033910725, 0.13325143, -0.17352992), vec4(0.4461619, 0.6364925, -0.10560766, -1.9667461), vec4(-0.45408845, -0.45158005, -0.3393527, 0.23955418), vec4(-0.1490831, -0.27201223, -0.29839015, 0.3486842)),
    mat4(vec4(0.9126985, -0.32295942, 0.18586884, -0.3813523), vec4(-2.2016847, -0.20238802, -0.2387893, 1.108497), vec4(-16.085505, -11.817784, 0.33659443, 18.04033), vec4(2.8204956, 0.2766079, 0.13006428, -0.32751954)),
    mat4(vec4(-2.3231235, -0.40893358, -0.29915, 0.003795701), vec4(0.26880562, -1.2932492, -0.017290879, 2.6089804), vec4(-0.60153836, -2.8597462, -0.41541255, 2.8458073), vec4(2.1445951, -0.02217821, -0.016395334, 0.34860465)),
    mat4(vec4(-0.44858697, -0.18469375, -0.0487925, 0.055945862), vec4(1.938247, -0.9735102, -0.11066262, 1.1382389), vec4(1.155708, 0.61691636, -0.2702479, -0.77236706), vec4(-2.4122674, -0.71479994, 0.012769671, -4.688386)),
    mat4(vec4(-2.96085, 0.42215174, -0.38456017, -0.38776773), vec4(-0.24383856, -1.6216474, 0.07149901, 1.4710059), vec4(0.7342929, 0.7211161, -0.22429495, -1.0781635), vec4(1.1297781, -1.029324, -0.16603275, 0.58354384)),
    mat4(vec4(-0.05003959, 0.17409228, -1.7151766, 0.10474924), vec4(0.01457923, -0.14070602, -2.338239, 0.16299094), vec4(-0.18373938, -0.42455322, -0.13555224, -0.23536675), vec4(0.19085951, -10.431905, 0.1561438, 0.090965495)),
    mat4(vec4(-0.29841623, -5.4967546, 0.36875647, -0.25406379), vec4(-0.8486684, -1.2277318, -0.6337861, -0.31054696), vec4(-0.4919306, -1.1227449, 1.0165828, -0.4170905), vec4(-0.33625957, 1.3663192, -2.173731, -0.5335285)),
    mat4(vec4(-0.02580354, -0.99563456, 0.5907119, -0.25888622), vec4(0.016648367, -4.541484, 2.382072, -0.28103116), vec4(-0.14202255, 1.1210418, 0.39246255, -0.19009183), vec4(-0.607, -0.4930353, 1.2736763, -0.41987988)),
    mat4(vec4(0.17047478, -0.9777811, 0.49490413, -0.12701556), vec4(-0.053615864, -0.6757622, -1.5249232, -0.028747546), vec4(-0.32371497, 0.06521764, 0.7220942, -0.19597325), vec4(0.08538029, 0.9865701, -0.41408128, -0.26629293)),
    mat4(vec4(-0.27797985, 1.245964, -0.31600127, 0.24749051), vec4(-0.38834217, 1.0111324, 2.1538868, -0.57203734), vec4(0.052746143, -4.1187143, -3.127516, -0.20474255), vec4(-0.28306407, 0.76736736, -0.3911666, -0.19085774)),
    mat4(vec4(-0.24509515, -0.54012036, 0.6798456, 0.2861152), vec4(0.0883146, -1.8435801, -0.7039397, 0.07257456), vec4(0.046027165, 0.50666636, 0.28459528, -0.14042337), vec4(-0.35120356, 0.09453443, -0.5894016, -0.06492637)),
    mat4(vec4(-0.2621763, -3.170006, 0.29966676, 0.25263417), vec4(-0.111120336, -1.2728657, -1.5264434, -0.038851615), vec4(-0.63447267, -0.42552397, -1.2964416, -0.42073154), vec4(-0.32678196, 1.6176457, -4.360378, 0.21671215)),
    mat4(vec4(-0.0059840316, -3.8099651, -0.7975418, 0.0896058), vec4(-0.4766693, -6.305596, -0.9151071, -0.124717675), vec4(-0.07483728, 0.4794457, -0.16928793, -0.26237386), vec4(-0.09608338, -5.6179204, 1.5533636, -0.25067762)),
    mat4(vec4(-0.44553274, -2.4276547, -0.34491634, -0.3018809), vec4(-0.52397114, 0.030779477, -0.17118035, 0.78206486), vec4(-0.17858525, -0.24578506, -0.35063842, -0.21416129), vec4(-0.8180598, -4.199304, 0.071606964, -3.011446)),
    mat4(vec4(0.03209997, 0.93677473, -0.19422996, 0.92966574), vec4(-1.0652505, -3.58009, -0.44814247, -0.70519245), vec4(0.28799462, 0.571532, -0.49397644, 0.67908394), vec4(-1.035229, 1.0754316, -0.4090003, 0.11564912)),
    mat4(vec4(-0.77254635, -0.17241158, -0.022551931, 1.2262067), vec4(-0.605102, 0.20001902, 0.068069376, -4.080519), vec4(-0.6443346, 1.9855751, -0.44039902, 1.9125082), vec4(0.42612883, -1.1998643, -0.8721463, 0.15239058)),
    mat4(vec4(-0.29837945, 0.0068644956, -0.3898633, 0.009918437), vec4(0.3782384, 1.178301, 0.08229874, -0.06470791), vec4(0.0774512, 0.9013115, -0.65848154, 0.3284934), vec4(-0.70972896, -0.14531367, -0.3254276, 0.17822915)),
    mat4(vec4(-0.3608274, -1.1323757, 0.016613701, -0.28131887), vec4(-0.8172055, 1.9383489, -0.6498204, 0.72158223), vec4(0.002547174, 11.533519, 0.1844353, 9.447558), vec4(-0.93364465, 0.47887138, -0.20126021, 0.42655954)),
    mat4(vec4(-0.5974013, -0.13806076, 0.07475581, 0.012252475), vec4(-0.30127043, -1.3356161, 0.25582203, -1.0638454), vec4(-0.26102355, 3.1362603, 0.14241977, 1.7407504), vec4(-0.28486803, -0.51141244, 0.18834773, 1.5194561)),
    mat4(vec4(-0.5440513, 0.17791238, -0.090685666, 0.1784574), vec4(-0.21578477, -0.3776157, -0.1747485, -0.025778314), vec4(-0.9090561, -0.55879486, -0.07472327, -0.91794974), vec4(-0.32820567, -13.047486, 0.15306818, -0.93660307)),
    mat4(vec4(-0.18533035, -0.50595695, -0.68981564, -0.007534794), vec4(-0.5021136, 1.6381675, -0.15506433, -0.19430783), vec4(-0.79204714, -2.4517088, -0.54169047, 0.22938052), vec4(-0.7950926, -0.721995, -0.29049164, 0.20856877))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(0.4770337, 0.5460797, 0.12910557, 0.52999705),
    vec4(-1.6353985, -0.015806707, -0.09737429, -0.15550172),
    vec4(-0.093735114, -0.16538522, 0.15941054, -0.084039986),
    vec4(-0.27845818, -1.404325, -0.21183206, 0.7471019)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.40647185, 0.44648197, 0.33806726, -0.58729476),
    vec4(0.296294, 0.4119679, -0.092257194, -1.5042608),
    vec4(0.5056655, 0.25605714, 0.47047532, 0.08635457),
    vec4(-0.21344288, 0.44311768, -0.35619932, -0.38459864)
);
const float NMT_B3 = -0.75821054;

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
// Slots of a pixel, empty ones at the end among them, a multiple of four.
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
    uint shift = max(uint(findMSB(range) + 1), NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
    uint multiplier = 0x80000000u / ((range >> shift) + 1u);
    uint room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    uint slope = min(uint(float(range >> 8u) * NMT_KEY_SCALE), room);
    return NmtCodes(first, last, first_log2, shift, multiplier, slope);
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
    return exp(-front_6) * nmt_transmittance(mat3x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
        + 0.05), bounds.x), vec4(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
        * mean, 1e-6), 0.0, 1.0), mean_2), vec4(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2)
        / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
vec2 nmt_core_slot(uint code, uvec2 steps) {
    return code > 0u ? vec2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : vec2(0.0);
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
layout(std430, binding = 0) readonly buffer Cores { uvec4 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint first = 2u * (uint(at.y) * width + uint(at.x));
    vec4 sums0 = texelFetch(sums0_texture, at, 0);
    vec4 sums1 = texelFetch(sums1_texture, at, 0);
    vec4 moments = vec4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, core[first], core[first + 1u], sums1.y, sums0.x, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
