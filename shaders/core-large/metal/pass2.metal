// Metal, by naga from WGSL, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Target 0: rgba16float or rgba32float, blend add, factors one and one, cleared to 0.
// Textures: the targets of pass 1. Buffer 2: that of pass 1. Buffer 0: the uniforms.
//
// Neural moment transparency: network 'core-large', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 3, epochs 1500, dataset 6b20a1357fe130e18d08f55d5155b4481667abb47f55abc52cc6366e964d37ed.
// Measured on fresh pixels of the training distribution: mean squared error of T 1.815e-3, worst 1.000.

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
constant NmtType2 NMT_W1 = NmtType2 {{metal::float4x4(metal::float4(6.204872, 2.8133395, 3.8717713, 3.4365928), metal::float4(-0.101355486, -0.80166835, -0.046910837, 0.07250359), metal::float4(-0.021604054, 1.72706, -0.054340035, -0.06785708), metal::float4(-6.946954, -2.300351, -3.4141264, 3.5611715)), metal::float4x4(metal::float4(-2.2312346, 1.4460495, 1.350287, 0.2781561), metal::float4(-3.5046957, -2.017726, -2.374801, 4.420415), metal::float4(1.0577246, 2.8064923, 0.7623902, 3.4509523), metal::float4(2.6835322, -0.70754516, 6.5579576, -10.669322)), metal::float4x4(metal::float4(0.4006354, 0.24350096, 0.663123, -0.6519766), metal::float4(5.264841, -3.403898, 1.3743782, -0.2183028), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.7981963, -1.4129393, -1.0607893, 1.5912263), metal::float4(0.05322063, 0.3539213, -0.19883794, -0.013613466), metal::float4(-0.10299524, -0.35735005, 0.02214596, -0.042126805), metal::float4(5.633362, -36.578434, 7.033086, 0.8023797)), metal::float4x4(metal::float4(8.898151, -8.121007, -17.221498, 1.0746595), metal::float4(4.0676994, 1.5276451, -2.8564644, -8.732235), metal::float4(2.6934555, -37.686146, -0.9592489, 1.7140763), metal::float4(-3.4736412, -0.86801314, 3.6190457, 11.374533)), metal::float4x4(metal::float4(-5.504661, -0.7658614, 1.7203724, 0.19787298), metal::float4(0.72156316, 4.796095, 1.7140621, 1.3453492), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-1.6326102, -1.8870184, 3.5283074, 3.7838643), metal::float4(-0.13681301, 0.069581605, 0.13528098, 0.88836443), metal::float4(-0.006082848, -0.1336125, -0.029393682, 0.2799977), metal::float4(2.80411, 4.927762, 17.299143, 4.7893004)), metal::float4x4(metal::float4(-4.91337, -6.7606926, -11.6568775, -4.4463596), metal::float4(-1.8343529, 7.744741, -5.747167, -4.1380253), metal::float4(-9.301559, -4.6508403, -0.5542998, 10.99322), metal::float4(1.5717273, -10.986497, 3.317018, 0.8478676)), metal::float4x4(metal::float4(8.42374, 0.26131183, 10.281987, -0.10212514), metal::float4(-3.0205727, 0.6666693, -0.14254783, -2.0059035), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.755177, -4.042959, 0.5506073, 4.557005), metal::float4(0.6095984, 0.045305915, -0.14754099, 0.30063155), metal::float4(-0.29475665, 0.60104185, 0.0068221376, 0.085523844), metal::float4(-0.14942089, 4.526219, -119.97225, -1.5962425)), metal::float4x4(metal::float4(-0.37608734, -2.937702, -8.477666, -4.516912), metal::float4(-0.13451223, -1.5557053, -9.081086, -2.081463), metal::float4(4.2415347, 0.22778013, -2.1703372, 9.726672), metal::float4(-3.3759682, 1.3922427, 10.223112, -1.0208558)), metal::float4x4(metal::float4(-1.0549339, -0.38253945, 6.04355, -11.763591), metal::float4(-4.324575, -4.293104, -0.33705884, 2.524719), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-6.509173, -0.6667411, -0.84195983, 1.5420114), metal::float4(0.066726476, -0.38902503, 1.0896145, -0.08918266), metal::float4(-0.06429821, 0.14853202, -0.6678769, -0.0494696), metal::float4(1.1424367, 6.3754134, 5.2589126, -137.67015)), metal::float4x4(metal::float4(-0.44659847, -5.7695274, -8.623573, -26.390863), metal::float4(-0.36106414, 8.934726, -2.9854681, -1.5266478), metal::float4(2.0882123, 0.1922003, -2.2155347, 0.2369156), metal::float4(-0.01522975, 0.1292762, 3.1306255, -1.8630923)), metal::float4x4(metal::float4(0.11624097, -74.13805, 3.5565298, 4.5083303), metal::float4(-6.1390705, -1.2168869, 1.0260584, 2.4315135), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.5480623, 4.3443193, -6.0640097, 2.0157316), metal::float4(0.44361994, -0.09958827, -0.002614725, -0.06954539), metal::float4(-0.21089426, -0.06859401, -0.00012028825, 0.15595998), metal::float4(0.55394566, 5.7900405, 0.04844435, 2.5593207)), metal::float4x4(metal::float4(0.71850526, -0.09873017, -0.024438646, -0.7414565), metal::float4(2.6148055, -5.3578644, -0.02481355, 3.457171), metal::float4(-13.242175, -3.4362228, 0.033985093, 2.4870965), metal::float4(0.78623194, 0.598498, 0.02698959, -8.410853)), metal::float4x4(metal::float4(0.21221437, 0.37101457, 0.005282033, 6.9881825), metal::float4(1.5699171, 3.5130217, -6.0419717, -1.0249234), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.90750986, 2.6633465, -0.8052706, -6.1982207), metal::float4(0.075742856, -0.22764629, -0.24734835, 0.0746464), metal::float4(-0.0025613639, 0.1376831, -0.13632917, -0.02001572), metal::float4(24.988588, 4.872218, 0.8445787, 0.37891808)), metal::float4x4(metal::float4(-22.746803, 2.0633085, 2.8822708, 0.13335148), metal::float4(3.3876948, 2.988283, 8.079052, -0.19542086), metal::float4(-2.2974532, 0.31802145, -15.241872, 0.3332559), metal::float4(-3.4267986, -3.9556756, -4.8386097, 0.17851198)), metal::float4x4(metal::float4(-0.8658033, 8.452439, -0.4347663, -0.037509352), metal::float4(0.7509301, -2.810309, 0.034173217, -6.0997205), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.17954855, -2.530912, -0.3779119, 1.7662483), metal::float4(0.46774656, -0.6943666, -0.060912203, -0.28464755), metal::float4(-0.18244119, 0.2409339, 0.1257029, -0.045022108), metal::float4(6.0069795, 7.9403286, -8.667023, 4.4826617)), metal::float4x4(metal::float4(-0.67186695, -7.1475515, -1.282027, -9.123962), metal::float4(0.20577912, 1.2996395, 6.1463923, -0.20032407), metal::float4(3.8142853, -3.8269134, -1.9772706, 3.074882), metal::float4(8.014048, 0.34990573, -7.0761423, -6.848341)), metal::float4x4(metal::float4(-0.5402738, 3.9567156, -5.1775007, -0.62641615), metal::float4(-7.0803804, 0.19455366, 2.7288408, 3.1864016), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(0.0014794759, -1.6126761, 0.54000443, 0.9577151), metal::float4(-0.35623825, -0.39092347, -0.2153758, -0.37392086), metal::float4(-0.27367756, -3.3168862, 0.52879083, -0.9685586), metal::float4(-0.19818558, -47.838207, -1.5003899, -0.20914485)), metal::float4x4(metal::float4(-0.55751497, -3.4390726, 0.30028278, -0.1718346), metal::float4(-0.32693204, -0.56310403, -0.508209, -1.005984), metal::float4(-0.33143577, 1.420434, -0.5103506, 0.5355924), metal::float4(-0.50951445, 2.011052, -1.5980743, 0.39063236)), metal::float4x4(metal::float4(-0.007893177, -1.9168547, -2.8238313, 0.8126926), metal::float4(-0.024703195, 3.0338197, -0.83963317, 0.76560605), metal::float4(-0.25359395, 0.25137326, 1.6551076, -1.2946343), metal::float4(-0.07779426, 0.6158974, -1.3742461, -0.20147389)), metal::float4x4(metal::float4(-0.36245236, -2.126473, 1.6999443, 0.27836984), metal::float4(-0.3802638, -1.0578899, 0.6559833, 1.2648615), metal::float4(0.16218288, -1.8476137, -1.8538566, 0.38487968), metal::float4(-0.3607257, -1.8992126, 0.88479364, -0.35938486)), metal::float4x4(metal::float4(-0.3046523, 2.5543103, 0.00779031, -0.6110913), metal::float4(0.20248345, 0.3673109, 0.045366533, 0.7675556), metal::float4(-0.3128859, -2.3527296, 0.11086922, 0.56910765), metal::float4(-0.115936086, -0.5900598, 0.91291374, 0.5018808)), metal::float4x4(metal::float4(0.1140261, 0.86378473, -1.5482339, 0.2675193), metal::float4(-0.6249853, 0.16345339, -0.6099004, 1.2764479), metal::float4(0.10792662, -72.400085, 41.909176, 52.739677), metal::float4(-0.12643147, 1.1393485, 0.0035437625, -0.8239877)), metal::float4x4(metal::float4(-0.35446605, 1.7820624, 0.85655636, -4.8371544), metal::float4(0.2561083, -2.524373, -3.803316, 1.3527868), metal::float4(-0.12295044, 10.607384, -5.677808, 1.980226), metal::float4(-0.49874857, -4.762254, 7.40551, 17.157087)), metal::float4x4(metal::float4(-0.13175572, -5.0668335, 1.8651767, -1.4482958), metal::float4(0.0062510255, 0.08487061, 1.0535067, 0.17322683), metal::float4(-0.31125408, -2.9081576, 0.02950071, 2.1925697), metal::float4(-0.076180436, -0.29697967, -3.1009912, -0.97578424)), metal::float4x4(metal::float4(-1.2788697, -1.7724941, 0.031367466, -0.33944327), metal::float4(-0.8223728, 0.2586289, -0.673155, 0.14301081), metal::float4(-0.021701338, 0.39983368, 1.5640485, -0.54768234), metal::float4(1.7517431, -0.6110178, -11.170872, -0.90779716)), metal::float4x4(metal::float4(-1.1979388, 1.4289565, -0.78963566, -0.22586913), metal::float4(1.8346869, -2.7638795, 2.9078295, -0.31293452), metal::float4(0.034241926, -1.8968059, 0.23844111, -0.1667677), metal::float4(2.5662813, -1.8090616, -2.3385468, -0.7566507)), metal::float4x4(metal::float4(-1.3626353, 0.81723726, 2.5182261, -0.40006098), metal::float4(2.8653626, 1.9190807, -1.5346744, -0.23406813), metal::float4(-4.8388877, 1.8530403, 1.1219699, -0.28431627), metal::float4(-1.7455623, -0.26064312, -2.630886, -0.67394614)), metal::float4x4(metal::float4(-4.250465, 0.8485477, -1.2077881, -0.35964197), metal::float4(0.61203647, 1.4320666, 0.041044943, -0.19733426), metal::float4(-6.530458, 1.9437848, -0.99711215, -0.5484805), metal::float4(0.21567212, -0.9349211, -1.3242472, -0.6653045)), metal::float4x4(metal::float4(3.035908, 1.436095, 7.5924344, -0.84817594), metal::float4(1.3552063, -0.29650798, -1.0791736, -0.75067174), metal::float4(-3.5197146, -1.9264128, -1.5374576, -0.43862274), metal::float4(-2.4996636, -3.8316312, 0.44254833, -0.32154953)), metal::float4x4(metal::float4(2.8465588, 0.5712192, 0.735795, -0.0033822865), metal::float4(-0.56190825, -1.990058, -1.5354006, -0.6337873), metal::float4(-40.07591, -33.298107, 47.418564, -0.3391771), metal::float4(-2.4642332, -4.257247, -1.4350299, -0.74468124)), metal::float4x4(metal::float4(-4.7277837, -3.5859263, 2.9436538, -0.90756035), metal::float4(3.105952, 2.0426662, -0.70306903, -0.71554726), metal::float4(-1.692159, -2.07432, 0.78881866, -0.78756803), metal::float4(-1.4522907, -0.81979513, 11.831197, -0.13985069)), metal::float4x4(metal::float4(-20.284815, -1.9131353, 1.4277077, -0.81649566), metal::float4(1.1189439, -0.90156674, -0.5455159, -0.7752789), metal::float4(-0.83667487, -0.21452728, 0.37944394, -0.34293464), metal::float4(1.1372877, -1.0982034, 0.4583989, -0.2734245)), metal::float4x4(metal::float4(0.32342657, -0.16381542, -0.40632406, -0.16606194), metal::float4(0.2886088, 1.4384278, -0.13271601, -0.72110575), metal::float4(2.0296056, -0.9668749, 0.055594433, 0.89882463), metal::float4(-2.7802057, -0.50567096, -0.3152656, 0.29999986)), metal::float4x4(metal::float4(0.30521056, 0.11159783, -0.05518078, -1.3052118), metal::float4(-0.09157455, -1.0110682, -0.35769543, -1.5615903), metal::float4(-1.1007711, 2.0066028, 0.18243526, 1.0613225), metal::float4(-2.2169673, -0.20630412, -0.38137758, -1.7758629)), metal::float4x4(metal::float4(0.7250795, -0.9703145, 0.19154473, 2.1376066), metal::float4(1.3108358, -0.32054564, -0.98763305, 0.63966024), metal::float4(0.58257407, -0.3485913, -0.15903606, -0.2969556), metal::float4(0.47538194, 0.46428493, -0.052737117, -0.60588396)), metal::float4x4(metal::float4(1.3384848, 0.76405257, -0.035901032, 0.50153345), metal::float4(-1.8342975, 1.9698441, 0.2048863, 1.3807392), metal::float4(-0.5539028, 0.82545257, -0.38099998, -0.54782456), metal::float4(-0.60050094, 0.06114892, 0.0109926, -0.112417564)), metal::float4x4(metal::float4(1.1562332, 0.43306014, -0.1296074, 2.440256), metal::float4(-0.52387255, 0.9127684, -0.22081022, 0.32616612), metal::float4(-0.32088432, -0.39988524, -0.3211627, 0.8526902), metal::float4(-0.2553219, 0.5045174, -0.22395696, -0.16359173)), metal::float4x4(metal::float4(0.7099996, 1.232924, -0.6559115, -1.6254576), metal::float4(-0.021275291, -0.28515562, -0.6122335, 3.148062), metal::float4(38.279278, 28.5439, -0.23451121, 23.176136), metal::float4(0.38483733, 0.120970905, -0.5669942, -0.42253715)), metal::float4x4(metal::float4(0.6025491, 1.7445382, -0.38868186, -1.003331), metal::float4(-2.0015347, 0.4662167, -0.08761083, -0.03295988), metal::float4(-2.4838984, 0.3430683, -0.18713558, 1.5661621), metal::float4(4.9074254, -0.31771374, -0.27555382, 6.9322076)), metal::float4x4(metal::float4(0.48470423, 1.3017286, -0.57338256, 1.9977043), metal::float4(1.3343451, 1.124883, -0.31965873, -2.422213), metal::float4(0.03425674, 1.3219501, -0.0140554225, -0.36539128), metal::float4(0.09453477, -0.72655016, -0.15501757, -1.2257603)), metal::float4x4(metal::float4(-0.3830995, 0.8711124, -2.531773, 2.3450906), metal::float4(-0.5046418, -0.18559308, -0.043250065, -0.04814989), metal::float4(0.80467397, -2.6349037, 2.4433057, -1.8888735), metal::float4(0.14080918, 0.16216256, -0.73435795, -1.7728852)), metal::float4x4(metal::float4(-0.5284839, 0.15593404, 1.5015632, -0.70785993), metal::float4(0.36261168, 0.29404876, 0.3235795, -0.46695745), metal::float4(-0.31503266, 0.2504051, -0.62893677, 1.1998066), metal::float4(-0.7907909, 1.6867315, -0.7408103, -0.8367681)), metal::float4x4(metal::float4(2.6406658, -1.5987536, -0.02024108, -39.160957), metal::float4(0.35633612, -1.1326717, 0.078679256, -0.6269402), metal::float4(-2.110519, 0.48404667, -0.91979617, -9.404749), metal::float4(0.35182858, 0.25797543, 0.7645786, -1.221499)), metal::float4x4(metal::float4(-0.44946235, -0.7788535, 1.1892793, 0.5591938), metal::float4(0.35645786, 0.094985425, 0.17615107, 0.26346347), metal::float4(-0.4571226, 1.5074216, -0.94012666, -1.3043909), metal::float4(-1.7155043, 0.97074556, -1.9019933, -6.346539)), metal::float4x4(metal::float4(2.6538086, -2.5318153, 2.8000367, -2.7600226), metal::float4(-0.65784967, -0.21742234, -1.0497744, -9.233375), metal::float4(0.11880474, -0.66432357, -1.4177536, -0.103072815), metal::float4(-0.91791725, 1.7479087, -2.9147553, 1.7644771)), metal::float4x4(metal::float4(-0.5185405, -0.45023468, 1.239262, -1.1819397), metal::float4(0.08794238, 0.60203266, -0.7610508, -0.46930638), metal::float4(56.63506, -40.97147, -38.491665, 55.731823), metal::float4(0.84508294, -0.7917561, -0.46851754, -0.65988994)), metal::float4x4(metal::float4(-3.127498, 1.6072181, -5.5871, 3.0458117), metal::float4(-1.2642719, 1.1635212, 0.97104865, -7.0801797), metal::float4(-1.7273396, 0.12588477, -0.047348537, 1.99572), metal::float4(7.475945, -10.227622, -2.3160303, 16.526388)), metal::float4x4(metal::float4(-3.3859339, -1.1914951, -1.551237, 1.9976467), metal::float4(1.1268681, -0.29889172, 1.0361499, 0.3534297), metal::float4(1.0624168, 0.22369984, 1.6649894, -1.1051549), metal::float4(-0.023290886, 0.9238263, -0.5466744, 0.7365538))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(-0.4702997, 3.6017132, 3.1618407, -4.565967), metal::float4(-3.1748745, 5.315254, 2.8817766, -0.46516532), metal::float4(0.46057475, -0.5172249, -0.0779469, 3.736676), metal::float4(3.3655753, -0.29277152, 0.44119278, 0.9078992)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.027475799, -0.11262302, 0.113024525, -0.11926887), metal::float4(0.078904204, -0.13931622, -0.11915389, 0.5882544), metal::float4(-0.10881586, -0.15059823, 0.335851, 0.10879014), metal::float4(-0.2194254, 0.11674281, 0.17508075, -0.31335026)}};
constant float NMT_B3 = -1.9357655;
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
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(6.204872, 2.8133395, 3.8717713, 3.4365928), metal::float4(-0.101355486, -0.80166835, -0.046910837, 0.07250359), metal::float4(-0.021604054, 1.72706, -0.054340035, -0.06785708), metal::float4(-6.946954, -2.300351, -3.4141264, 3.5611715)) * h0_0) + (metal::float4x4(metal::float4(-2.2312346, 1.4460495, 1.350287, 0.2781561), metal::float4(-3.5046957, -2.017726, -2.374801, 4.420415), metal::float4(1.0577246, 2.8064923, 0.7623902, 3.4509523), metal::float4(2.6835322, -0.70754516, 6.5579576, -10.669322)) * h0_1)) + (metal::float4x4(metal::float4(0.4006354, 0.24350096, 0.663123, -0.6519766), metal::float4(5.264841, -3.403898, 1.3743782, -0.2183028), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-0.7981963, -1.4129393, -1.0607893, 1.5912263), metal::float4(0.05322063, 0.3539213, -0.19883794, -0.013613466), metal::float4(-0.10299524, -0.35735005, 0.02214596, -0.042126805), metal::float4(5.633362, -36.578434, 7.033086, 0.8023797)) * h0_0) + (metal::float4x4(metal::float4(8.898151, -8.121007, -17.221498, 1.0746595), metal::float4(4.0676994, 1.5276451, -2.8564644, -8.732235), metal::float4(2.6934555, -37.686146, -0.9592489, 1.7140763), metal::float4(-3.4736412, -0.86801314, 3.6190457, 11.374533)) * h0_1)) + (metal::float4x4(metal::float4(-5.504661, -0.7658614, 1.7203724, 0.19787298), metal::float4(0.72156316, 4.796095, 1.7140621, 1.3453492), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-1.6326102, -1.8870184, 3.5283074, 3.7838643), metal::float4(-0.13681301, 0.069581605, 0.13528098, 0.88836443), metal::float4(-0.006082848, -0.1336125, -0.029393682, 0.2799977), metal::float4(2.80411, 4.927762, 17.299143, 4.7893004)) * h0_0) + (metal::float4x4(metal::float4(-4.91337, -6.7606926, -11.6568775, -4.4463596), metal::float4(-1.8343529, 7.744741, -5.747167, -4.1380253), metal::float4(-9.301559, -4.6508403, -0.5542998, 10.99322), metal::float4(1.5717273, -10.986497, 3.317018, 0.8478676)) * h0_1)) + (metal::float4x4(metal::float4(8.42374, 0.26131183, 10.281987, -0.10212514), metal::float4(-3.0205727, 0.6666693, -0.14254783, -2.0059035), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-3.755177, -4.042959, 0.5506073, 4.557005), metal::float4(0.6095984, 0.045305915, -0.14754099, 0.30063155), metal::float4(-0.29475665, 0.60104185, 0.0068221376, 0.085523844), metal::float4(-0.14942089, 4.526219, -119.97225, -1.5962425)) * h0_0) + (metal::float4x4(metal::float4(-0.37608734, -2.937702, -8.477666, -4.516912), metal::float4(-0.13451223, -1.5557053, -9.081086, -2.081463), metal::float4(4.2415347, 0.22778013, -2.1703372, 9.726672), metal::float4(-3.3759682, 1.3922427, 10.223112, -1.0208558)) * h0_1)) + (metal::float4x4(metal::float4(-1.0549339, -0.38253945, 6.04355, -11.763591), metal::float4(-4.324575, -4.293104, -0.33705884, 2.524719), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(-6.509173, -0.6667411, -0.84195983, 1.5420114), metal::float4(0.066726476, -0.38902503, 1.0896145, -0.08918266), metal::float4(-0.06429821, 0.14853202, -0.6678769, -0.0494696), metal::float4(1.1424367, 6.3754134, 5.2589126, -137.67015)) * h0_0) + (metal::float4x4(metal::float4(-0.44659847, -5.7695274, -8.623573, -26.390863), metal::float4(-0.36106414, 8.934726, -2.9854681, -1.5266478), metal::float4(2.0882123, 0.1922003, -2.2155347, 0.2369156), metal::float4(-0.01522975, 0.1292762, 3.1306255, -1.8630923)) * h0_1)) + (metal::float4x4(metal::float4(0.11624097, -74.13805, 3.5565298, 4.5083303), metal::float4(-6.1390705, -1.2168869, 1.0260584, 2.4315135), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-3.5480623, 4.3443193, -6.0640097, 2.0157316), metal::float4(0.44361994, -0.09958827, -0.002614725, -0.06954539), metal::float4(-0.21089426, -0.06859401, -0.00012028825, 0.15595998), metal::float4(0.55394566, 5.7900405, 0.04844435, 2.5593207)) * h0_0) + (metal::float4x4(metal::float4(0.71850526, -0.09873017, -0.024438646, -0.7414565), metal::float4(2.6148055, -5.3578644, -0.02481355, 3.457171), metal::float4(-13.242175, -3.4362228, 0.033985093, 2.4870965), metal::float4(0.78623194, 0.598498, 0.02698959, -8.410853)) * h0_1)) + (metal::float4x4(metal::float4(0.21221437, 0.37101457, 0.005282033, 6.9881825), metal::float4(1.5699171, 3.5130217, -6.0419717, -1.0249234), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-0.90750986, 2.6633465, -0.8052706, -6.1982207), metal::float4(0.075742856, -0.22764629, -0.24734835, 0.0746464), metal::float4(-0.0025613639, 0.1376831, -0.13632917, -0.02001572), metal::float4(24.988588, 4.872218, 0.8445787, 0.37891808)) * h0_0) + (metal::float4x4(metal::float4(-22.746803, 2.0633085, 2.8822708, 0.13335148), metal::float4(3.3876948, 2.988283, 8.079052, -0.19542086), metal::float4(-2.2974532, 0.31802145, -15.241872, 0.3332559), metal::float4(-3.4267986, -3.9556756, -4.8386097, 0.17851198)) * h0_1)) + (metal::float4x4(metal::float4(-0.8658033, 8.452439, -0.4347663, -0.037509352), metal::float4(0.7509301, -2.810309, 0.034173217, -6.0997205), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(0.17954855, -2.530912, -0.3779119, 1.7662483), metal::float4(0.46774656, -0.6943666, -0.060912203, -0.28464755), metal::float4(-0.18244119, 0.2409339, 0.1257029, -0.045022108), metal::float4(6.0069795, 7.9403286, -8.667023, 4.4826617)) * h0_0) + (metal::float4x4(metal::float4(-0.67186695, -7.1475515, -1.282027, -9.123962), metal::float4(0.20577912, 1.2996395, 6.1463923, -0.20032407), metal::float4(3.8142853, -3.8269134, -1.9772706, 3.074882), metal::float4(8.014048, 0.34990573, -7.0761423, -6.848341)) * h0_1)) + (metal::float4x4(metal::float4(-0.5402738, 3.9567156, -5.1775007, -0.62641615), metal::float4(-7.0803804, 0.19455366, 2.7288408, 3.1864016), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(-0.4702997, 3.6017132, 3.1618407, -4.565967) + (metal::float4x4(metal::float4(0.0014794759, -1.6126761, 0.54000443, 0.9577151), metal::float4(-0.35623825, -0.39092347, -0.2153758, -0.37392086), metal::float4(-0.27367756, -3.3168862, 0.52879083, -0.9685586), metal::float4(-0.19818558, -47.838207, -1.5003899, -0.20914485)) * h1_0)) + (metal::float4x4(metal::float4(-0.55751497, -3.4390726, 0.30028278, -0.1718346), metal::float4(-0.32693204, -0.56310403, -0.508209, -1.005984), metal::float4(-0.33143577, 1.420434, -0.5103506, 0.5355924), metal::float4(-0.50951445, 2.011052, -1.5980743, 0.39063236)) * h1_1)) + (metal::float4x4(metal::float4(-0.007893177, -1.9168547, -2.8238313, 0.8126926), metal::float4(-0.024703195, 3.0338197, -0.83963317, 0.76560605), metal::float4(-0.25359395, 0.25137326, 1.6551076, -1.2946343), metal::float4(-0.07779426, 0.6158974, -1.3742461, -0.20147389)) * h1_2)) + (metal::float4x4(metal::float4(-0.36245236, -2.126473, 1.6999443, 0.27836984), metal::float4(-0.3802638, -1.0578899, 0.6559833, 1.2648615), metal::float4(0.16218288, -1.8476137, -1.8538566, 0.38487968), metal::float4(-0.3607257, -1.8992126, 0.88479364, -0.35938486)) * h1_3)) + (metal::float4x4(metal::float4(-0.3046523, 2.5543103, 0.00779031, -0.6110913), metal::float4(0.20248345, 0.3673109, 0.045366533, 0.7675556), metal::float4(-0.3128859, -2.3527296, 0.11086922, 0.56910765), metal::float4(-0.115936086, -0.5900598, 0.91291374, 0.5018808)) * h1_4)) + (metal::float4x4(metal::float4(0.1140261, 0.86378473, -1.5482339, 0.2675193), metal::float4(-0.6249853, 0.16345339, -0.6099004, 1.2764479), metal::float4(0.10792662, -72.400085, 41.909176, 52.739677), metal::float4(-0.12643147, 1.1393485, 0.0035437625, -0.8239877)) * h1_5)) + (metal::float4x4(metal::float4(-0.35446605, 1.7820624, 0.85655636, -4.8371544), metal::float4(0.2561083, -2.524373, -3.803316, 1.3527868), metal::float4(-0.12295044, 10.607384, -5.677808, 1.980226), metal::float4(-0.49874857, -4.762254, 7.40551, 17.157087)) * h1_6)) + (metal::float4x4(metal::float4(-0.13175572, -5.0668335, 1.8651767, -1.4482958), metal::float4(0.0062510255, 0.08487061, 1.0535067, 0.17322683), metal::float4(-0.31125408, -2.9081576, 0.02950071, 2.1925697), metal::float4(-0.076180436, -0.29697967, -3.1009912, -0.97578424)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(-3.1748745, 5.315254, 2.8817766, -0.46516532) + (metal::float4x4(metal::float4(-1.2788697, -1.7724941, 0.031367466, -0.33944327), metal::float4(-0.8223728, 0.2586289, -0.673155, 0.14301081), metal::float4(-0.021701338, 0.39983368, 1.5640485, -0.54768234), metal::float4(1.7517431, -0.6110178, -11.170872, -0.90779716)) * h1_0)) + (metal::float4x4(metal::float4(-1.1979388, 1.4289565, -0.78963566, -0.22586913), metal::float4(1.8346869, -2.7638795, 2.9078295, -0.31293452), metal::float4(0.034241926, -1.8968059, 0.23844111, -0.1667677), metal::float4(2.5662813, -1.8090616, -2.3385468, -0.7566507)) * h1_1)) + (metal::float4x4(metal::float4(-1.3626353, 0.81723726, 2.5182261, -0.40006098), metal::float4(2.8653626, 1.9190807, -1.5346744, -0.23406813), metal::float4(-4.8388877, 1.8530403, 1.1219699, -0.28431627), metal::float4(-1.7455623, -0.26064312, -2.630886, -0.67394614)) * h1_2)) + (metal::float4x4(metal::float4(-4.250465, 0.8485477, -1.2077881, -0.35964197), metal::float4(0.61203647, 1.4320666, 0.041044943, -0.19733426), metal::float4(-6.530458, 1.9437848, -0.99711215, -0.5484805), metal::float4(0.21567212, -0.9349211, -1.3242472, -0.6653045)) * h1_3)) + (metal::float4x4(metal::float4(3.035908, 1.436095, 7.5924344, -0.84817594), metal::float4(1.3552063, -0.29650798, -1.0791736, -0.75067174), metal::float4(-3.5197146, -1.9264128, -1.5374576, -0.43862274), metal::float4(-2.4996636, -3.8316312, 0.44254833, -0.32154953)) * h1_4)) + (metal::float4x4(metal::float4(2.8465588, 0.5712192, 0.735795, -0.0033822865), metal::float4(-0.56190825, -1.990058, -1.5354006, -0.6337873), metal::float4(-40.07591, -33.298107, 47.418564, -0.3391771), metal::float4(-2.4642332, -4.257247, -1.4350299, -0.74468124)) * h1_5)) + (metal::float4x4(metal::float4(-4.7277837, -3.5859263, 2.9436538, -0.90756035), metal::float4(3.105952, 2.0426662, -0.70306903, -0.71554726), metal::float4(-1.692159, -2.07432, 0.78881866, -0.78756803), metal::float4(-1.4522907, -0.81979513, 11.831197, -0.13985069)) * h1_6)) + (metal::float4x4(metal::float4(-20.284815, -1.9131353, 1.4277077, -0.81649566), metal::float4(1.1189439, -0.90156674, -0.5455159, -0.7752789), metal::float4(-0.83667487, -0.21452728, 0.37944394, -0.34293464), metal::float4(1.1372877, -1.0982034, 0.4583989, -0.2734245)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(0.46057475, -0.5172249, -0.0779469, 3.736676) + (metal::float4x4(metal::float4(0.32342657, -0.16381542, -0.40632406, -0.16606194), metal::float4(0.2886088, 1.4384278, -0.13271601, -0.72110575), metal::float4(2.0296056, -0.9668749, 0.055594433, 0.89882463), metal::float4(-2.7802057, -0.50567096, -0.3152656, 0.29999986)) * h1_0)) + (metal::float4x4(metal::float4(0.30521056, 0.11159783, -0.05518078, -1.3052118), metal::float4(-0.09157455, -1.0110682, -0.35769543, -1.5615903), metal::float4(-1.1007711, 2.0066028, 0.18243526, 1.0613225), metal::float4(-2.2169673, -0.20630412, -0.38137758, -1.7758629)) * h1_1)) + (metal::float4x4(metal::float4(0.7250795, -0.9703145, 0.19154473, 2.1376066), metal::float4(1.3108358, -0.32054564, -0.98763305, 0.63966024), metal::float4(0.58257407, -0.3485913, -0.15903606, -0.2969556), metal::float4(0.47538194, 0.46428493, -0.052737117, -0.60588396)) * h1_2)) + (metal::float4x4(metal::float4(1.3384848, 0.76405257, -0.035901032, 0.50153345), metal::float4(-1.8342975, 1.9698441, 0.2048863, 1.3807392), metal::float4(-0.5539028, 0.82545257, -0.38099998, -0.54782456), metal::float4(-0.60050094, 0.06114892, 0.0109926, -0.112417564)) * h1_3)) + (metal::float4x4(metal::float4(1.1562332, 0.43306014, -0.1296074, 2.440256), metal::float4(-0.52387255, 0.9127684, -0.22081022, 0.32616612), metal::float4(-0.32088432, -0.39988524, -0.3211627, 0.8526902), metal::float4(-0.2553219, 0.5045174, -0.22395696, -0.16359173)) * h1_4)) + (metal::float4x4(metal::float4(0.7099996, 1.232924, -0.6559115, -1.6254576), metal::float4(-0.021275291, -0.28515562, -0.6122335, 3.148062), metal::float4(38.279278, 28.5439, -0.23451121, 23.176136), metal::float4(0.38483733, 0.120970905, -0.5669942, -0.42253715)) * h1_5)) + (metal::float4x4(metal::float4(0.6025491, 1.7445382, -0.38868186, -1.003331), metal::float4(-2.0015347, 0.4662167, -0.08761083, -0.03295988), metal::float4(-2.4838984, 0.3430683, -0.18713558, 1.5661621), metal::float4(4.9074254, -0.31771374, -0.27555382, 6.9322076)) * h1_6)) + (metal::float4x4(metal::float4(0.48470423, 1.3017286, -0.57338256, 1.9977043), metal::float4(1.3343451, 1.124883, -0.31965873, -2.422213), metal::float4(0.03425674, 1.3219501, -0.0140554225, -0.36539128), metal::float4(0.09453477, -0.72655016, -0.15501757, -1.2257603)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(3.3655753, -0.29277152, 0.44119278, 0.9078992) + (metal::float4x4(metal::float4(-0.3830995, 0.8711124, -2.531773, 2.3450906), metal::float4(-0.5046418, -0.18559308, -0.043250065, -0.04814989), metal::float4(0.80467397, -2.6349037, 2.4433057, -1.8888735), metal::float4(0.14080918, 0.16216256, -0.73435795, -1.7728852)) * h1_0)) + (metal::float4x4(metal::float4(-0.5284839, 0.15593404, 1.5015632, -0.70785993), metal::float4(0.36261168, 0.29404876, 0.3235795, -0.46695745), metal::float4(-0.31503266, 0.2504051, -0.62893677, 1.1998066), metal::float4(-0.7907909, 1.6867315, -0.7408103, -0.8367681)) * h1_1)) + (metal::float4x4(metal::float4(2.6406658, -1.5987536, -0.02024108, -39.160957), metal::float4(0.35633612, -1.1326717, 0.078679256, -0.6269402), metal::float4(-2.110519, 0.48404667, -0.91979617, -9.404749), metal::float4(0.35182858, 0.25797543, 0.7645786, -1.221499)) * h1_2)) + (metal::float4x4(metal::float4(-0.44946235, -0.7788535, 1.1892793, 0.5591938), metal::float4(0.35645786, 0.094985425, 0.17615107, 0.26346347), metal::float4(-0.4571226, 1.5074216, -0.94012666, -1.3043909), metal::float4(-1.7155043, 0.97074556, -1.9019933, -6.346539)) * h1_3)) + (metal::float4x4(metal::float4(2.6538086, -2.5318153, 2.8000367, -2.7600226), metal::float4(-0.65784967, -0.21742234, -1.0497744, -9.233375), metal::float4(0.11880474, -0.66432357, -1.4177536, -0.103072815), metal::float4(-0.91791725, 1.7479087, -2.9147553, 1.7644771)) * h1_4)) + (metal::float4x4(metal::float4(-0.5185405, -0.45023468, 1.239262, -1.1819397), metal::float4(0.08794238, 0.60203266, -0.7610508, -0.46930638), metal::float4(56.63506, -40.97147, -38.491665, 55.731823), metal::float4(0.84508294, -0.7917561, -0.46851754, -0.65988994)) * h1_5)) + (metal::float4x4(metal::float4(-3.127498, 1.6072181, -5.5871, 3.0458117), metal::float4(-1.2642719, 1.1635212, 0.97104865, -7.0801797), metal::float4(-1.7273396, 0.12588477, -0.047348537, 1.99572), metal::float4(7.475945, -10.227622, -2.3160303, 16.526388)) * h1_6)) + (metal::float4x4(metal::float4(-3.3859339, -1.1914951, -1.551237, 1.9976467), metal::float4(1.1268681, -0.29889172, 1.0361499, 0.3534297), metal::float4(1.0624168, 0.22369984, 1.6649894, -1.1051549), metal::float4(-0.023290886, 0.9238263, -0.5466744, 0.7365538)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.027475799, -0.11262302, 0.113024525, -0.11926887), h2_0)) + metal::dot(metal::float4(0.078904204, -0.13931622, -0.11915389, 0.5882544), h2_1)) + metal::dot(metal::float4(-0.10881586, -0.15059823, 0.335851, 0.10879014), h2_2)) + metal::dot(metal::float4(-0.2194254, 0.11674281, 0.17508075, -0.31335026), h2_3);
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
    metal::float3 _e703 = nmt_core_bounds(x_1, m1_1, m2_1, m3_1, m4_1);
    if (false) {
        float bounds_noise = (((b0 / metal::max(absorbance_of_tail, 0.000000000001)) * (((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)) * ((((1.0 + metal::abs(center)) * per_h) + 1.0) * (((1.0 + metal::abs(center)) * per_h) + 1.0)))) * _e703.z) * 0.000000014901161;
        float most_1 = metal::min(metal::exp(-((front_8 + (absorbance_of_tail * metal::max(_e703.x - bounds_noise, 0.0))))), 1.0);
        float least_1 = metal::min(metal::exp(-((front_8 + (absorbance_of_tail * metal::min(_e703.y + bounds_noise, 1.0))))), 1.0);
        float opacity = 1.0 - metal::exp(-(absorbance_1));
        if ((opacity * (most_1 - least_1)) <= NMT_OPEN) {
            float middle = 0.5 * (most_1 + least_1);
            return middle;
        }
    }
    float mean_1 = metal::clamp(m1_1 * 1.0, -1.0, 1.0);
    float mean_2 = metal::clamp((m1_1 - m3_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001)), -1.0, 1.0);
    float _e839 = nmt_transmittance(metal::float3x4(metal::float4(x_1, (metal::log2(others) * 0.33333334) - 1.0, metal::log(absorbance_of_tail + 0.05), _e703.x), metal::float4(_e703.y, mean_1, metal::clamp(((m2_1 * 1.0) - (mean_1 * mean_1)) / metal::max(1.0 - (mean_1 * mean_1), 0.000001), 0.0, 1.0), mean_2), metal::float4(metal::sqrt(metal::clamp((((m2_1 - m4_1) * (1.0 / metal::max(1.0 - m2_1, 0.000001))) - (mean_2 * mean_2)) / metal::max(1.0 - (mean_2 * mean_2), 0.000001), 0.0, 1.0)), 0.0, 0.0, 0.0)));
    return metal::exp(-(front_8)) * _e839;
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
