#version 430
// OpenGL 4.3, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
// Neural moment transparency: network 'core-large', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 3, epochs 1500, dataset 6b20a1357fe130e18d08f55d5155b4481667abb47f55abc52cc6366e964d37ed.
// Measured on fresh pixels of the training distribution: mean squared error of T 1.815e-3, worst 1.000.

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(6.204872, 2.8133395, 3.8717713, 3.4365928), vec4(-0.101355486, -0.80166835, -0.046910837, 0.07250359), vec4(-0.021604054, 1.72706, -0.054340035, -0.06785708), vec4(-6.946954, -2.300351, -3.4141264, 3.5611715)),
    mat4(vec4(-2.2312346, 1.4460495, 1.350287, 0.2781561), vec4(-3.5046957, -2.017726, -2.374801, 4.420415), vec4(1.0577246, 2.8064923, 0.7623902, 3.4509523), vec4(2.6835322, -0.70754516, 6.5579576, -10.669322)),
    mat4(vec4(0.4006354, 0.24350096, 0.663123, -0.6519766), vec4(5.264841, -3.403898, 1.3743782, -0.2183028), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.7981963, -1.4129393, -1.0607893, 1.5912263), vec4(0.05322063, 0.3539213, -0.19883794, -0.013613466), vec4(-0.10299524, -0.35735005, 0.02214596, -0.042126805), vec4(5.633362, -36.578434, 7.033086, 0.8023797)),
    mat4(vec4(8.898151, -8.121007, -17.221498, 1.0746595), vec4(4.0676994, 1.5276451, -2.8564644, -8.732235), vec4(2.6934555, -37.686146, -0.9592489, 1.7140763), vec4(-3.4736412, -0.86801314, 3.6190457, 11.374533)),
    mat4(vec4(-5.504661, -0.7658614, 1.7203724, 0.19787298), vec4(0.72156316, 4.796095, 1.7140621, 1.3453492), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.6326102, -1.8870184, 3.5283074, 3.7838643), vec4(-0.13681301, 0.069581605, 0.13528098, 0.88836443), vec4(-0.006082848, -0.1336125, -0.029393682, 0.2799977), vec4(2.80411, 4.927762, 17.299143, 4.7893004)),
    mat4(vec4(-4.91337, -6.7606926, -11.6568775, -4.4463596), vec4(-1.8343529, 7.744741, -5.747167, -4.1380253), vec4(-9.301559, -4.6508403, -0.5542998, 10.99322), vec4(1.5717273, -10.986497, 3.317018, 0.8478676)),
    mat4(vec4(8.42374, 0.26131183, 10.281987, -0.10212514), vec4(-3.0205727, 0.6666693, -0.14254783, -2.0059035), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.755177, -4.042959, 0.5506073, 4.557005), vec4(0.6095984, 0.045305915, -0.14754099, 0.30063155), vec4(-0.29475665, 0.60104185, 0.0068221376, 0.085523844), vec4(-0.14942089, 4.526219, -119.97225, -1.5962425)),
    mat4(vec4(-0.37608734, -2.937702, -8.477666, -4.516912), vec4(-0.13451223, -1.5557053, -9.081086, -2.081463), vec4(4.2415347, 0.22778013, -2.1703372, 9.726672), vec4(-3.3759682, 1.3922427, 10.223112, -1.0208558)),
    mat4(vec4(-1.0549339, -0.38253945, 6.04355, -11.763591), vec4(-4.324575, -4.293104, -0.33705884, 2.524719), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-6.509173, -0.6667411, -0.84195983, 1.5420114), vec4(0.066726476, -0.38902503, 1.0896145, -0.08918266), vec4(-0.06429821, 0.14853202, -0.6678769, -0.0494696), vec4(1.1424367, 6.3754134, 5.2589126, -137.67015)),
    mat4(vec4(-0.44659847, -5.7695274, -8.623573, -26.390863), vec4(-0.36106414, 8.934726, -2.9854681, -1.5266478), vec4(2.0882123, 0.1922003, -2.2155347, 0.2369156), vec4(-0.01522975, 0.1292762, 3.1306255, -1.8630923)),
    mat4(vec4(0.11624097, -74.13805, 3.5565298, 4.5083303), vec4(-6.1390705, -1.2168869, 1.0260584, 2.4315135), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-3.5480623, 4.3443193, -6.0640097, 2.0157316), vec4(0.44361994, -0.09958827, -0.002614725, -0.06954539), vec4(-0.21089426, -0.06859401, -0.00012028825, 0.15595998), vec4(0.55394566, 5.7900405, 0.04844435, 2.5593207)),
    mat4(vec4(0.71850526, -0.09873017, -0.024438646, -0.7414565), vec4(2.6148055, -5.3578644, -0.02481355, 3.457171), vec4(-13.242175, -3.4362228, 0.033985093, 2.4870965), vec4(0.78623194, 0.598498, 0.02698959, -8.410853)),
    mat4(vec4(0.21221437, 0.37101457, 0.005282033, 6.9881825), vec4(1.5699171, 3.5130217, -6.0419717, -1.0249234), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.90750986, 2.6633465, -0.8052706, -6.1982207), vec4(0.075742856, -0.22764629, -0.24734835, 0.0746464), vec4(-0.0025613639, 0.1376831, -0.13632917, -0.02001572), vec4(24.988588, 4.872218, 0.8445787, 0.37891808)),
    mat4(vec4(-22.746803, 2.0633085, 2.8822708, 0.13335148), vec4(3.3876948, 2.988283, 8.079052, -0.19542086), vec4(-2.2974532, 0.31802145, -15.241872, 0.3332559), vec4(-3.4267986, -3.9556756, -4.8386097, 0.17851198)),
    mat4(vec4(-0.8658033, 8.452439, -0.4347663, -0.037509352), vec4(0.7509301, -2.810309, 0.034173217, -6.0997205), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.17954855, -2.530912, -0.3779119, 1.7662483), vec4(0.46774656, -0.6943666, -0.060912203, -0.28464755), vec4(-0.18244119, 0.2409339, 0.1257029, -0.045022108), vec4(6.0069795, 7.9403286, -8.667023, 4.4826617)),
    mat4(vec4(-0.67186695, -7.1475515, -1.282027, -9.123962), vec4(0.20577912, 1.2996395, 6.1463923, -0.20032407), vec4(3.8142853, -3.8269134, -1.9772706, 3.074882), vec4(8.014048, 0.34990573, -7.0761423, -6.848341)),
    mat4(vec4(-0.5402738, 3.9567156, -5.1775007, -0.62641615), vec4(-7.0803804, 0.19455366, 2.7288408, 3.1864016), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(0.0014794759, -1.6126761, 0.54000443, 0.9577151), vec4(-0.35623825, -0.39092347, -0.2153758, -0.37392086), vec4(-0.27367756, -3.3168862, 0.52879083, -0.9685586), vec4(-0.19818558, -47.838207, -1.5003899, -0.20914485)),
    mat4(vec4(-0.55751497, -3.4390726, 0.30028278, -0.1718346), vec4(-0.32693204, -0.56310403, -0.508209, -1.005984), vec4(-0.33143577, 1.420434, -0.5103506, 0.5355924), vec4(-0.50951445, 2.011052, -1.5980743, 0.39063236)),
    mat4(vec4(-0.007893177, -1.9168547, -2.8238313, 0.8126926), vec4(-0.024703195, 3.0338197, -0.83963317, 0.76560605), vec4(-0.25359395, 0.25137326, 1.6551076, -1.2946343), vec4(-0.07779426, 0.6158974, -1.3742461, -0.20147389)),
    mat4(vec4(-0.36245236, -2.126473, 1.6999443, 0.27836984), vec4(-0.3802638, -1.0578899, 0.6559833, 1.2648615), vec4(0.16218288, -1.8476137, -1.8538566, 0.38487968), vec4(-0.3607257, -1.8992126, 0.88479364, -0.35938486)),
    mat4(vec4(-0.3046523, 2.5543103, 0.00779031, -0.6110913), vec4(0.20248345, 0.3673109, 0.045366533, 0.7675556), vec4(-0.3128859, -2.3527296, 0.11086922, 0.56910765), vec4(-0.115936086, -0.5900598, 0.91291374, 0.5018808)),
    mat4(vec4(0.1140261, 0.86378473, -1.5482339, 0.2675193), vec4(-0.6249853, 0.16345339, -0.6099004, 1.2764479), vec4(0.10792662, -72.400085, 41.909176, 52.739677), vec4(-0.12643147, 1.1393485, 0.0035437625, -0.8239877)),
    mat4(vec4(-0.35446605, 1.7820624, 0.85655636, -4.8371544), vec4(0.2561083, -2.524373, -3.803316, 1.3527868), vec4(-0.12295044, 10.607384, -5.677808, 1.980226), vec4(-0.49874857, -4.762254, 7.40551, 17.157087)),
    mat4(vec4(-0.13175572, -5.0668335, 1.8651767, -1.4482958), vec4(0.0062510255, 0.08487061, 1.0535067, 0.17322683), vec4(-0.31125408, -2.9081576, 0.02950071, 2.1925697), vec4(-0.076180436, -0.29697967, -3.1009912, -0.97578424)),
    mat4(vec4(-1.2788697, -1.7724941, 0.031367466, -0.33944327), vec4(-0.8223728, 0.2586289, -0.673155, 0.14301081), vec4(-0.021701338, 0.39983368, 1.5640485, -0.54768234), vec4(1.7517431, -0.6110178, -11.170872, -0.90779716)),
    mat4(vec4(-1.1979388, 1.4289565, -0.78963566, -0.22586913), vec4(1.8346869, -2.7638795, 2.9078295, -0.31293452), vec4(0.034241926, -1.8968059, 0.23844111, -0.1667677), vec4(2.5662813, -1.8090616, -2.3385468, -0.7566507)),
    mat4(vec4(-1.3626353, 0.81723726, 2.5182261, -0.40006098), vec4(2.8653626, 1.9190807, -1.5346744, -0.23406813), vec4(-4.8388877, 1.8530403, 1.1219699, -0.28431627), vec4(-1.7455623, -0.26064312, -2.630886, -0.67394614)),
    mat4(vec4(-4.250465, 0.8485477, -1.2077881, -0.35964197), vec4(0.61203647, 1.4320666, 0.041044943, -0.19733426), vec4(-6.530458, 1.9437848, -0.99711215, -0.5484805), vec4(0.21567212, -0.9349211, -1.3242472, -0.6653045)),
    mat4(vec4(3.035908, 1.436095, 7.5924344, -0.84817594), vec4(1.3552063, -0.29650798, -1.0791736, -0.75067174), vec4(-3.5197146, -1.9264128, -1.5374576, -0.43862274), vec4(-2.4996636, -3.8316312, 0.44254833, -0.32154953)),
    mat4(vec4(2.8465588, 0.5712192, 0.735795, -0.0033822865), vec4(-0.56190825, -1.990058, -1.5354006, -0.6337873), vec4(-40.07591, -33.298107, 47.418564, -0.3391771), vec4(-2.4642332, -4.257247, -1.4350299, -0.74468124)),
    mat4(vec4(-4.7277837, -3.5859263, 2.9436538, -0.90756035), vec4(3.105952, 2.0426662, -0.70306903, -0.71554726), vec4(-1.692159, -2.07432, 0.78881866, -0.78756803), vec4(-1.4522907, -0.81979513, 11.831197, -0.13985069)),
    mat4(vec4(-20.284815, -1.9131353, 1.4277077, -0.81649566), vec4(1.1189439, -0.90156674, -0.5455159, -0.7752789), vec4(-0.83667487, -0.21452728, 0.37944394, -0.34293464), vec4(1.1372877, -1.0982034, 0.4583989, -0.2734245)),
    mat4(vec4(0.32342657, -0.16381542, -0.40632406, -0.16606194), vec4(0.2886088, 1.4384278, -0.13271601, -0.72110575), vec4(2.0296056, -0.9668749, 0.055594433, 0.89882463), vec4(-2.7802057, -0.50567096, -0.3152656, 0.29999986)),
    mat4(vec4(0.30521056, 0.11159783, -0.05518078, -1.3052118), vec4(-0.09157455, -1.0110682, -0.35769543, -1.5615903), vec4(-1.1007711, 2.0066028, 0.18243526, 1.0613225), vec4(-2.2169673, -0.20630412, -0.38137758, -1.7758629)),
    mat4(vec4(0.7250795, -0.9703145, 0.19154473, 2.1376066), vec4(1.3108358, -0.32054564, -0.98763305, 0.63966024), vec4(0.58257407, -0.3485913, -0.15903606, -0.2969556), vec4(0.47538194, 0.46428493, -0.052737117, -0.60588396)),
    mat4(vec4(1.3384848, 0.76405257, -0.035901032, 0.50153345), vec4(-1.8342975, 1.9698441, 0.2048863, 1.3807392), vec4(-0.5539028, 0.82545257, -0.38099998, -0.54782456), vec4(-0.60050094, 0.06114892, 0.0109926, -0.112417564)),
    mat4(vec4(1.1562332, 0.43306014, -0.1296074, 2.440256), vec4(-0.52387255, 0.9127684, -0.22081022, 0.32616612), vec4(-0.32088432, -0.39988524, -0.3211627, 0.8526902), vec4(-0.2553219, 0.5045174, -0.22395696, -0.16359173)),
    mat4(vec4(0.7099996, 1.232924, -0.6559115, -1.6254576), vec4(-0.021275291, -0.28515562, -0.6122335, 3.148062), vec4(38.279278, 28.5439, -0.23451121, 23.176136), vec4(0.38483733, 0.120970905, -0.5669942, -0.42253715)),
    mat4(vec4(0.6025491, 1.7445382, -0.38868186, -1.003331), vec4(-2.0015347, 0.4662167, -0.08761083, -0.03295988), vec4(-2.4838984, 0.3430683, -0.18713558, 1.5661621), vec4(4.9074254, -0.31771374, -0.27555382, 6.9322076)),
    mat4(vec4(0.48470423, 1.3017286, -0.57338256, 1.9977043), vec4(1.3343451, 1.124883, -0.31965873, -2.422213), vec4(0.03425674, 1.3219501, -0.0140554225, -0.36539128), vec4(0.09453477, -0.72655016, -0.15501757, -1.2257603)),
    mat4(vec4(-0.3830995, 0.8711124, -2.531773, 2.3450906), vec4(-0.5046418, -0.18559308, -0.043250065, -0.04814989), vec4(0.80467397, -2.6349037, 2.4433057, -1.8888735), vec4(0.14080918, 0.16216256, -0.73435795, -1.7728852)),
    mat4(vec4(-0.5284839, 0.15593404, 1.5015632, -0.70785993), vec4(0.36261168, 0.29404876, 0.3235795, -0.46695745), vec4(-0.31503266, 0.2504051, -0.62893677, 1.1998066), vec4(-0.7907909, 1.6867315, -0.7408103, -0.8367681)),
    mat4(vec4(2.6406658, -1.5987536, -0.02024108, -39.160957), vec4(0.35633612, -1.1326717, 0.078679256, -0.6269402), vec4(-2.110519, 0.48404667, -0.91979617, -9.404749), vec4(0.35182858, 0.25797543, 0.7645786, -1.221499)),
    mat4(vec4(-0.44946235, -0.7788535, 1.1892793, 0.5591938), vec4(0.35645786, 0.094985425, 0.17615107, 0.26346347), vec4(-0.4571226, 1.5074216, -0.94012666, -1.3043909), vec4(-1.7155043, 0.97074556, -1.9019933, -6.346539)),
    mat4(vec4(2.6538086, -2.5318153, 2.8000367, -2.7600226), vec4(-0.65784967, -0.21742234, -1.0497744, -9.233375), vec4(0.11880474, -0.66432357, -1.4177536, -0.103072815), vec4(-0.91791725, 1.7479087, -2.9147553, 1.7644771)),
    mat4(vec4(-0.5185405, -0.45023468, 1.239262, -1.1819397), vec4(0.08794238, 0.60203266, -0.7610508, -0.46930638), vec4(56.63506, -40.97147, -38.491665, 55.731823), vec4(0.84508294, -0.7917561, -0.46851754, -0.65988994)),
    mat4(vec4(-3.127498, 1.6072181, -5.5871, 3.0458117), vec4(-1.2642719, 1.1635212, 0.97104865, -7.0801797), vec4(-1.7273396, 0.12588477, -0.047348537, 1.99572), vec4(7.475945, -10.227622, -2.3160303, 16.526388)),
    mat4(vec4(-3.3859339, -1.1914951, -1.551237, 1.9976467), vec4(1.1268681, -0.29889172, 1.0361499, 0.3534297), vec4(1.0624168, 0.22369984, 1.6649894, -1.1051549), vec4(-0.023290886, 0.9238263, -0.5466744, 0.7365538))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(-0.4702997, 3.6017132, 3.1618407, -4.565967),
    vec4(-3.1748745, 5.315254, 2.8817766, -0.46516532),
    vec4(0.46057475, -0.5172249, -0.0779469, 3.736676),
    vec4(3.3655753, -0.29277152, 0.44119278, 0.9078992)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.027475799, -0.11262302, 0.113024525, -0.11926887),
    vec4(0.078904204, -0.13931622, -0.11915389, 0.5882544),
    vec4(-0.10881586, -0.15059823, 0.335851, 0.10879014),
    vec4(-0.2194254, 0.11674281, 0.17508075, -0.31335026)
);
const float NMT_B3 = -1.9357655;

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
    vec3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_8 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_8 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
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
