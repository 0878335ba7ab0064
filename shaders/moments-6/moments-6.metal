// Neural moment transparency: network 'moments-6', 9-32-16-1, 816 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.
//
// Features, set 'recentred-6', in this order: x, count, ln_b0, mean, spread, inner_mean, inner_spread, inner2_mean, inner2_spread.
// v is distance along the view direction and z = 2 ln(v/v0)/ln(v1/v0) - 1 moment depth, v0 and v1 the scene's least and greatest v;
// pass 1 adds up b_k = sum of A z^k, counts fragments (n) and keeps the pixel's least and greatest v as f32.
// A = min(-ln(1 - alpha), 10) is a fragment's absorbance; primed quantities leave out the fragment's own, b_k' = b_k - A z^k.
// c and h are middle and half of the pixel's range of z; m_k = moments of the others in (z - c)/h, normalised by b_0'.
// x = (z - c)/h, count = log2(n)/3 - 1, ln_b0 = ln(b_0' + 0.05);
// mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2) times the measure: mean = (m_1 - m_3)/(1 - m_2),
// spread = the square root of the same ratio of its own; inner2_ and inner3_ of (1 - x^2)^2 and (1 - x^2)^3, faded out where f32 leaves noise.
// The answer is T = exp(-b_0' s), s the network's sigmoid: the share of the other absorbance that lies in front.
// Not part of the network, and to be applied before it, in this order: nearest in its pixel (v compared bit for bit): T = 1;
// b_0' <= 1e-6 b_0: T = 1; farthest: T = exp(-b_0'); three fragments: T = exp(-b_0' (1 - m_1)/2);
// four fragments: the closed form in nmt_recentred.
// So pixels of up to four fragments, and all that is nearest or farthest, never need the network.
//
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 600, dataset 37f23ca23c85cddd29cc28c82e42ad387652d607b62fdde6a7e9a18fca6b8f75.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.305e-3, worst 0.995.

#ifndef NMT_INCLUDED_MOMENTS_6
#define NMT_INCLUDED_MOMENTS_6

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType5 {
    metal::float4x4 inner[24];
};
struct NmtType6 {
    metal::float4x4 inner[32];
};
struct NmtType7 {
    metal::float4 inner[4];
};
struct NmtSums {
    metal::float4 sums0;
    metal::float4 sums1;
    metal::float4 range;
};
constant float NMT_ROUNDING = 0.00000011920929;
constant NmtType5 NMT_W1 = NmtType5 {{metal::float4x4(metal::float4(-6.111781, 1.2590787, 0.5475349, -1.2606547), metal::float4(-0.9432912, -0.027208287, -0.30223295, -0.008989807), metal::float4(0.10382608, 0.04081687, 0.00517731, 0.13695489), metal::float4(0.5247361, 7.551865, -1.6350569, 7.4871354)), metal::float4x4(metal::float4(-1.2694472, -9.020549, -6.307308, 0.1156755), metal::float4(-0.5863311, -6.3508167, 2.2088974, -0.95557034), metal::float4(2.519586, -4.0575604, 6.3729653, -1.4507685), metal::float4(0.05811975, -0.25461668, -0.4064348, -0.41226965)), metal::float4x4(metal::float4(-1.603955, -0.63644004, 0.49392483, 1.1919441), metal::float4(-5.366019, 2.9462543, -0.4136076, -3.124585), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-2.7355766, 1.0036091, -2.8403323, -4.795097), metal::float4(0.024920808, -0.23226534, 0.5254088, 0.11377028), metal::float4(0.13349196, 0.07365853, 0.20932944, 0.016179072), metal::float4(-1.6250459, -4.8359137, -0.08537557, -0.19261461)), metal::float4x4(metal::float4(0.13225362, 2.89904, -3.04994, 0.36533222), metal::float4(4.800494, 3.977632, -0.61880076, 0.12900063), metal::float4(-1.0653358, -3.289986, 2.3399897, -0.22318892), metal::float4(-2.6758354, 0.62541056, -0.4392313, 0.027572617)), metal::float4x4(metal::float4(5.42803, 0.50919867, -1.5685683, -0.007823314), metal::float4(-4.863298, 1.7043099, -0.4714574, -4.861206), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-0.13962865, 1.5440083, 3.000412, 3.4353843), metal::float4(-0.57095677, -0.061338373, 0.2472489, 0.19988087), metal::float4(-0.32642198, 0.0010412352, -0.021046346, -0.012095685), metal::float4(0.24782896, 2.2739713, 5.3219786, -4.776767)), metal::float4x4(metal::float4(-0.47955763, -0.82601726, 4.6288095, -2.1269662), metal::float4(-0.6476124, -9.601333, -3.9761598, 0.89417446), metal::float4(-0.0847439, 4.3309703, 1.7938333, 0.48631155), metal::float4(0.4469387, 8.027626, -1.1833122, 0.0064941095)), metal::float4x4(metal::float4(-0.49138308, -2.9760563, -0.9328496, 0.8670376), metal::float4(-0.87651825, 0.64863366, -5.0546846, 2.3387825), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.5760229, 4.533266, -1.6427152, -1.4796346), metal::float4(-0.07957402, -0.33262858, 0.39887205, -0.07089995), metal::float4(-0.014048754, -0.053987775, -0.08135598, -0.000117340634), metal::float4(-0.11836353, 0.44236583, 3.952692, -0.06623836)), metal::float4x4(metal::float4(-1.128837, -0.3080469, -5.6531177, -1.2193537), metal::float4(-0.6106688, -2.1997905, -4.896287, 2.2838867), metal::float4(5.117241, 6.327744, 3.4865515, 3.0882306), metal::float4(1.010223, 0.340252, -0.53299254, -1.0834862)), metal::float4x4(metal::float4(-5.1776967, 0.98614454, 1.1521934, -6.7103496), metal::float4(-3.1058083, -2.119367, -1.3814752, 1.0148283), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(0.9691913, 3.6027002, 3.4038823, -1.4982073), metal::float4(-0.09721829, 0.7538304, 0.11502148, -0.36653677), metal::float4(0.069223955, -0.050337084, 0.05156069, 0.00126499), metal::float4(4.8298807, -1.5281683, -6.356912, 1.9819074)), metal::float4x4(metal::float4(-9.021647, 2.6192272, -8.228654, -3.639272), metal::float4(-4.886636, -1.1694726, 0.33833027, 3.7475548), metal::float4(5.3034215, 1.6796954, 4.7872767, 4.596024), metal::float4(-1.2544109, 2.2807274, -0.3591253, -0.5454767)), metal::float4x4(metal::float4(1.7421607, 1.9923266, -0.03349984, -0.19245246), metal::float4(0.29631603, 0.41034484, 0.5748713, -0.49153104), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-1.2280331, 3.3868275, -2.665127, -0.74408203), metal::float4(0.043601274, -0.4817103, -0.18844081, -0.06487209), metal::float4(0.012015421, -0.026456503, 0.008891798, 0.0075397766), metal::float4(-4.4597335, 1.201724, 1.7545215, 2.532967)), metal::float4x4(metal::float4(3.5101607, -1.9561962, -1.3536254, -2.4960887), metal::float4(3.8059118, -0.80123705, -7.3587255, -8.631405), metal::float4(2.9984262, 0.8873145, 0.38955295, 5.230721), metal::float4(-0.08283735, -0.27585363, 5.9716625, 6.624569)), metal::float4x4(metal::float4(-0.40433055, 0.029642176, 2.079507, -3.0390704), metal::float4(-2.4578543, 3.7255483, -2.189978, -0.87685984), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-3.262312, 2.3860085, 6.7077255, 1.7991533), metal::float4(-0.16270845, 0.032198705, -0.05943885, -0.3940928), metal::float4(0.058438443, 0.015088889, -0.042749982, 0.07342043), metal::float4(-0.7669092, -2.3534462, 0.99614793, 2.8025775)), metal::float4x4(metal::float4(-0.9087242, 3.0325496, -1.396636, -1.098918), metal::float4(3.3784263, 6.4511676, -6.228715, -4.159704), metal::float4(0.8494316, -2.7000678, 2.0243857, -5.193673), metal::float4(0.20995937, -4.190236, -0.61862284, -0.02107041)), metal::float4x4(metal::float4(0.12992106, 0.29974172, -0.70772874, -0.85352206), metal::float4(0.72485054, 2.2938392, 1.3125209, 4.1111984), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(-5.3910193, 5.217595, 3.4597962, 1.1132557), metal::float4(0.0527404, -0.22649224, 0.2102456, -0.04448421), metal::float4(0.02741702, -0.05801576, -0.004462379, 0.038614187), metal::float4(0.07164862, -1.0982728, 1.1179584, 4.9506955)), metal::float4x4(metal::float4(-0.22796391, -6.7252426, 5.3008366, -4.017342), metal::float4(5.2988577, 1.8783277, -1.299335, -4.2415414), metal::float4(-1.6573465, 3.03367, 0.923951, -3.392957), metal::float4(0.03842112, 0.5970927, 0.58665645, 0.46000332)), metal::float4x4(metal::float4(-0.08871091, 0.49993217, -2.3402717, 1.2996048), metal::float4(0.29164585, -0.08348722, 0.049777083, 2.3808312), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType6 NMT_W2 = NmtType6 {{metal::float4x4(metal::float4(-2.992966, -2.858956, -4.254115, -0.22101966), metal::float4(1.8619783, -1.7560344, 0.18683062, 0.71421546), metal::float4(-0.9313739, 4.859132, 0.6138396, 0.49655724), metal::float4(-0.37038225, 0.020796178, 0.7491361, 0.8727151)), metal::float4x4(metal::float4(0.36748806, -0.7872776, -3.911794, 0.009744219), metal::float4(-1.1042612, 3.0573065, 0.22637399, 0.12707636), metal::float4(0.9925066, -0.4076182, 0.97743005, 0.30577096), metal::float4(7.2628703, -21.080715, -4.972773, -3.7080753)), metal::float4x4(metal::float4(0.71003896, -0.057421677, -0.7333687, -0.1349236), metal::float4(-3.0351005, -0.025662167, 5.439921, 1.1083124), metal::float4(-1.2842412, -0.40064743, 2.132936, 0.4587207), metal::float4(-0.4143241, 3.001643, 0.0988189, -0.26960135)), metal::float4x4(metal::float4(0.91364557, 0.14445628, -8.310524, -0.065409906), metal::float4(-3.2332554, -2.9022744, -15.36157, 0.50497496), metal::float4(0.8229345, -2.064584, 0.12143615, -0.10263531), metal::float4(0.054719314, 2.4150016, 1.2882204, 1.110596)), metal::float4x4(metal::float4(-0.6192766, 3.047318, -0.96840745, 0.2605519), metal::float4(-1.2917666, -2.2279055, -1.8872515, 0.68316597), metal::float4(0.109164976, 2.52896, 0.8579186, 0.15905996), metal::float4(-0.69663775, 1.246913, -0.710606, 0.92853165)), metal::float4x4(metal::float4(0.9062126, 1.0490677, 1.9008839, -1.0397452), metal::float4(1.6107726, -1.0856603, 1.346723, 0.993593), metal::float4(1.7179087, 0.22983813, -3.5189588, -1.0520781), metal::float4(2.4576623, 0.5125091, -6.4215956, -0.5380803)), metal::float4x4(metal::float4(0.3615602, -4.6017222, -0.14912221, 0.4948515), metal::float4(-0.63468134, -9.653261, -1.9091142, -0.03045894), metal::float4(-2.565982, -2.7410276, -8.579719, -1.8886751), metal::float4(0.37309378, -0.7666512, 0.9897772, -0.053876042)), metal::float4x4(metal::float4(0.14261079, -2.7428598, 0.71818084, 0.079738714), metal::float4(1.1686169, 2.7973378, -12.209488, -1.3224617), metal::float4(-0.10436231, 3.5554519, -1.8719939, -0.083544716), metal::float4(0.37562165, -2.0031798, -1.140298, 1.4245508)), metal::float4x4(metal::float4(0.07020887, -7.7853203, 3.2623754, -0.9289991), metal::float4(-0.41948175, 0.91524047, -0.09373543, 3.1709063), metal::float4(1.707971, 0.79446125, 0.14929785, 2.5686665), metal::float4(-0.056600675, -0.1659347, 5.8103175, -1.8952311)), metal::float4x4(metal::float4(-4.786343, 1.030607, 0.3021604, -0.21997102), metal::float4(2.4703267, 1.123544, 2.1217737, -0.52224094), metal::float4(-2.2712877, 0.5158962, 0.3472931, 1.4640517), metal::float4(0.11313607, -13.780107, 8.568549, -13.411448)), metal::float4x4(metal::float4(-0.04082529, 0.1669218, 0.46733433, -0.36587787), metal::float4(0.34007803, 1.5025666, -1.0191387, -2.497706), metal::float4(5.29306, -0.110161185, -0.45350894, -2.687117), metal::float4(1.1021147, -0.042523265, -8.089456, -1.1886902)), metal::float4x4(metal::float4(0.3839846, 1.6447116, -2.4580069, -0.70252365), metal::float4(0.26104167, -0.5908336, 0.026685795, -1.7847142), metal::float4(-5.2497396, -0.5974036, -3.9859402, 1.2823159), metal::float4(-2.8455558, 1.4684895, 0.58783984, 0.48113063)), metal::float4x4(metal::float4(0.16200472, 0.6974124, -0.056665666, 5.1168947), metal::float4(-1.1185981, 0.28122574, -1.1758981, -0.2487846), metal::float4(-0.40818137, 0.45375705, 0.3172075, -2.4046204), metal::float4(-3.1995828, 1.259068, 1.8805319, 2.4689593)), metal::float4x4(metal::float4(-1.3353378, 0.63000417, 0.38511258, 2.2301257), metal::float4(0.2802323, -0.1214043, 0.15000337, -1.1558938), metal::float4(0.71096516, -1.684167, -0.530025, -0.8572137), metal::float4(-3.2262592, -0.68959, 2.0129254, 4.257681)), metal::float4x4(metal::float4(-19.512064, -0.18027107, -3.1857862, -0.6899437), metal::float4(-0.3005064, -0.34270313, -0.42363968, -5.0216107), metal::float4(-2.4683843, 0.21464697, 1.3507403, -2.8129263), metal::float4(-0.07548671, -0.8579342, -1.1152614, 3.2826817)), metal::float4x4(metal::float4(-12.441226, -1.5329676, -0.020585677, -1.3522521), metal::float4(6.684407, -1.0653955, 2.805359, -5.174105), metal::float4(-1.2013803, -0.14954259, 1.1032336, -2.7582016), metal::float4(-1.0236809, -0.6934412, 0.20977055, -0.44141737)), metal::float4x4(metal::float4(-0.08507485, -3.0545528, 0.096640795, -2.997112), metal::float4(0.016383547, -0.38022602, -0.32512355, -2.9064112), metal::float4(-0.18832994, -2.7187495, -0.30681947, 3.0764172), metal::float4(0.032234084, -0.674778, -0.26126426, -0.7389055)), metal::float4x4(metal::float4(-0.30429694, -5.9502687, -0.25058585, -0.56996036), metal::float4(-0.44421595, 1.3879135, -0.46375105, -1.5739975), metal::float4(-0.5096615, 1.5734165, -0.22679868, 0.034422264), metal::float4(-0.30219105, -18.450062, -0.06314865, -11.160464)), metal::float4x4(metal::float4(-0.02603846, 0.30140403, 0.2238884, -0.4666892), metal::float4(-0.029553855, 1.2880361, 0.108896896, -2.0154498), metal::float4(-0.14497134, 0.71481055, -0.06489657, 1.5688689), metal::float4(-0.43832225, 1.1543839, -0.74085, 1.265431)), metal::float4x4(metal::float4(0.17543544, -4.287299, 0.035343643, 2.50911), metal::float4(0.15206087, 0.5505871, -0.5673676, -2.6335747), metal::float4(-0.2942823, -2.0406406, 0.12456984, -1.7555345), metal::float4(-0.01804171, 4.622501, -0.11310927, 3.5968187)), metal::float4x4(metal::float4(-0.24732798, 0.020867135, 0.11910821, -0.59342366), metal::float4(-0.24452622, -0.71158904, -0.73464835, 0.033891715), metal::float4(0.060986243, 0.14190178, 0.103602394, -0.3242666), metal::float4(-0.32296723, -2.1236103, -0.11954761, -0.5252579)), metal::float4x4(metal::float4(-0.22450684, -2.814268, -0.18150029, 1.3641322), metal::float4(0.027793886, -0.5324461, -0.20759605, -2.3197892), metal::float4(0.04657861, 1.1140198, 0.24319865, -9.763681), metal::float4(-0.35169291, -1.7075313, -0.068953544, -9.342775)), metal::float4x4(metal::float4(-0.4123966, -5.300227, -0.0910799, -2.8317666), metal::float4(-0.287858, 0.46392447, -0.16798578, 0.6952194), metal::float4(-0.1862946, -0.63765377, -0.69623035, 2.604372), metal::float4(-0.33906487, -0.5565427, -0.42190912, -0.23940141)), metal::float4x4(metal::float4(-0.12144742, -20.892881, -0.4145004, 1.2375941), metal::float4(-0.697824, 1.987435, -0.5976051, 4.402753), metal::float4(-0.20529044, -0.3576681, -0.21677442, -0.24279527), metal::float4(-0.08807971, 2.9789166, 0.071931176, -2.929071)), metal::float4x4(metal::float4(-2.6315901, -0.34439078, -2.9610267, -1.0923961), metal::float4(0.223164, 1.8039895, 2.5519726, -0.9711679), metal::float4(-0.24532005, -2.3492897, -1.4704975, 0.76217866), metal::float4(0.36889645, -0.115326025, 0.35473856, -0.20498301)), metal::float4x4(metal::float4(-0.88672864, -0.39859805, 2.39492, 1.744944), metal::float4(-0.69307685, -0.99920523, 4.2183623, -0.87868303), metal::float4(0.35942724, -0.29691926, 1.0818437, 1.3207207), metal::float4(-30.2384, 0.10928893, -7.0647554, 15.717544)), metal::float4x4(metal::float4(-0.20164908, -0.19088599, 0.1551302, 0.04737597), metal::float4(-0.81887734, -3.1323016, -2.7505014, -1.5834199), metal::float4(-0.14424095, -1.555143, -4.6802588, -1.3235509), metal::float4(-0.25277188, -0.4647671, 1.6973499, -0.99667746)), metal::float4x4(metal::float4(0.78845274, 0.7655463, 3.7973511, 3.320911), metal::float4(-1.2283723, -4.476903, -3.5822878, -3.721869), metal::float4(0.46523815, 0.041043233, 2.1500504, 1.4796671), metal::float4(-4.0602994, 2.0099647, 0.85182285, -0.7933596)), metal::float4x4(metal::float4(0.35618836, -0.5405226, -0.8827116, 1.0714078), metal::float4(1.0268298, -0.2317349, -2.412876, -1.5990334), metal::float4(0.2031206, -0.9403622, 1.6003618, -1.0273224), metal::float4(0.9049673, 0.47973, -1.1511244, 0.058414135)), metal::float4x4(metal::float4(1.9166514, 1.426175, -1.1536136, 1.3503083), metal::float4(2.6654356, -2.2231581, 0.58408207, 2.110834), metal::float4(-0.79796445, -3.0819988, 0.9331857, 0.02824189), metal::float4(1.5963962, 7.198678, 2.0963554, 2.8723466)), metal::float4x4(metal::float4(-1.2596036, 0.631166, -11.672623, -0.5510185), metal::float4(-1.0386657, -3.2057896, -2.1611688, -1.6124867), metal::float4(-0.38434005, -3.9630258, -1.478051, -2.4563847), metal::float4(1.4227921, 1.0508367, 1.2534283, 0.904385)), metal::float4x4(metal::float4(-0.8039124, -1.2763106, -23.93499, 0.287792), metal::float4(-1.8194247, -1.8709297, 1.4603959, 0.10037173), metal::float4(-0.9812876, -2.6164715, -0.132473, -1.9431459), metal::float4(-1.5269586, -0.5822796, 1.6227671, -0.8949245))}};
constant NmtType7 NMT_B2 = NmtType7 {{metal::float4(1.2619187, -2.5986087, -2.149382, 1.3353654), metal::float4(-4.6729555, 3.27779, -12.580061, -0.2602885), metal::float4(-0.13580789, 0.6970699, -0.15496458, 0.740331), metal::float4(-0.12114108, 1.2450967, -2.2606373, -0.36267692)}};
constant NmtType7 NMT_W3 = NmtType7 {{metal::float4(-0.20100085, 0.17548272, 0.09926478, -0.21060409), metal::float4(0.18316391, 0.13202123, -0.10359111, -0.18595253), metal::float4(0.5044715, 0.1379622, -0.045420256, 0.09471249), metal::float4(0.13760756, 0.21741933, 0.2403533, -0.21945743)}};
constant float NMT_B3 = -0.117446944;
constant float NMT_FAINT = 0.0625;
constant float NMT_HIDDEN = 0.00095;

float nmt_absorbance(
    float alpha
) {
    float faint = alpha * (1.0 + (alpha * (0.5 + (alpha * (0.33333334 + (alpha * (0.25 + (alpha * 0.2))))))));
    return (0.03 > alpha) ? faint : -(metal::log(metal::max(1.0 - alpha, 0.00004539993)));
}

float nmt_log_ratio(
    float a,
    float b
) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (0.2 > metal::abs(s)) ? ((s + s) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + (q * 0.11111111))))))))) : metal::log(a / b);
}

float nmt_moment_depth(
    float v,
    float v0,
    float v1
) {
    float _e3 = nmt_log_ratio(v, v0);
    float _e6 = nmt_log_ratio(v1, v0);
    return (v1 > v0) ? metal::clamp(((2.0 * _e3) / metal::max(_e6, 0.000000000000000000000000000001)) - 1.0, -1.0, 1.0) : 0.0;
}

metal::float2x4 nmt_moments(
    float z,
    float absorbance
) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    float moment5 = moment4 * z;
    float moment6 = moment5 * z;
    return metal::float2x4(metal::float4(moment1, moment2, moment3, moment4), metal::float4(moment5, moment6, 0.0, 0.0));
}

metal::float2x4 nmt_recentred_moments(
    float z_1,
    float absorbance_1,
    float c,
    float per_h,
    float per_b0,
    metal::float2x4 b_1
) {
    metal::float2x4 _e6 = nmt_moments(z_1, absorbance_1);
    float m1 = (b_1[0].x - _e6[0].x) * per_b0;
    float m2 = (b_1[0].y - _e6[0].y) * per_b0;
    float m3 = (b_1[0].z - _e6[0].z) * per_b0;
    float m4 = (b_1[0].w - _e6[0].w) * per_b0;
    float m5 = (b_1[1].x - _e6[1].x) * per_b0;
    float m6 = (b_1[1].y - _e6[1].y) * per_b0;
    float m6_2 = m6 - (c * m5);
    float m5_2 = m5 - (c * m4);
    float m4_2 = m4 - (c * m3);
    float m3_2 = m3 - (c * m2);
    float m2_2 = m2 - (c * m1);
    float m1_2 = m1 - c;
    float m6_3 = m6_2 - (c * m5_2);
    float m5_3 = m5_2 - (c * m4_2);
    float m4_3 = m4_2 - (c * m3_2);
    float m3_3 = m3_2 - (c * m2_2);
    float m2_3 = m2_2 - (c * m1_2);
    float m6_4 = m6_3 - (c * m5_3);
    float m5_4 = m5_3 - (c * m4_3);
    float m4_4 = m4_3 - (c * m3_3);
    float m3_4 = m3_3 - (c * m2_3);
    float m6_5 = m6_4 - (c * m5_4);
    float m5_5 = m5_4 - (c * m4_4);
    float m4_5 = m4_4 - (c * m3_4);
    float m6_6 = m6_5 - (c * m5_5);
    float m5_6 = m5_5 - (c * m4_5);
    float m6_7 = m6_6 - (c * m5_6);
    float per_h2 = per_h * per_h;
    float per_h3 = per_h2 * per_h;
    float per_h4 = per_h2 * per_h2;
    return metal::float2x4(metal::float4(metal::clamp(m1_2 * per_h, -1.0, 1.0), metal::clamp(m2_3 * per_h2, -1.0, 1.0), metal::clamp(m3_4 * per_h3, -1.0, 1.0), metal::clamp(m4_5 * per_h4, -1.0, 1.0)), metal::float4(metal::clamp((m5_6 * per_h4) * per_h, -1.0, 1.0), metal::clamp((m6_7 * per_h4) * per_h2, -1.0, 1.0), 0.0, 0.0));
}

float nmt_shrink_to_prior(
    float value,
    float expected,
    float noise,
    float deviation
) {
    float bounded = metal::min(noise, 1000000000000000.0);
    float trust = deviation * deviation;
    return expected + ((value - expected) * (trust / (trust + (bounded * bounded))));
}

float nmt_place_in_thin(
    float v_1,
    float nearest,
    float farthest
) {
    float range_2 = farthest - nearest;
    float t = (v_1 - nearest) / metal::max(range_2, 0.000000000000000000000000000001);
    float x_1 = t * (1.0 + ((0.5 * (range_2 / nearest)) * (1.0 - t)));
    return metal::clamp((x_1 + x_1) - 1.0, -1.0, 1.0);
}

float nmt_share_of_four(
    float x,
    float mean,
    float spread,
    float u,
    float transition_width
) {
    float inner = (1.0 - spread) * (1.0 - (mean * mean));
    float near_end = metal::clamp(0.5 * ((1.0 - mean) - (inner / metal::max(1.0 + u, 0.000001))), 0.0, 1.0);
    float far_end = metal::clamp(0.5 * ((1.0 + mean) - (inner / metal::max(1.0 - u, 0.000001))), 0.0, 1.0);
    float behind = metal::clamp(0.5 + ((0.5 * (x - u)) / transition_width), 0.0, 1.0);
    return metal::clamp(near_end + (behind * ((1.0 - far_end) - near_end)), 0.0, 1.0);
}

metal::float3x4 nmt_recentred(
    float v_2,
    float z_2,
    float absorbance_2,
    float nearest_1,
    float farthest_1,
    float z_nearest,
    float z_farthest,
    float n,
    float b0,
    metal::float2x4 b_2
) {
    float front = -1.0;
    float c_1 = 0.5 * (z_nearest + z_farthest);
    float others = metal::clamp(b0 - absorbance_2, 0.0, 1000000000000000000000000000000.0);
    float per_b0_1 = 1.0 / metal::max(metal::max(others, b0 * 0.000001), 0.000000000000000000000000000001);
    float per_h_1 = 1.0 / metal::max(0.5 * (z_farthest - z_nearest), 0.00000001);
    metal::float2x4 _e31 = nmt_recentred_moments(z_2, absorbance_2, c_1, per_h_1, per_b0_1, b_2);
    float noise_growth = 1.0 + ((2.0 * metal::abs(c_1)) * per_h_1);
    float moment_noise = ((NMT_ROUNDING * noise_growth) * b0) * per_b0_1;
    float noise1 = moment_noise * (0.12 * metal::sqrt(n));
    float per_n = 1.0 / n;
    float _e55 = nmt_shrink_to_prior(_e31[0].x, 0.0, noise1, 0.22 + (0.7 * per_n));
    float _e61 = nmt_place_in_thin(v_2, nearest_1, farthest_1);
    float x_2 = (0.01 > ((farthest_1 - nearest_1) / nearest_1)) ? _e61 : metal::clamp((z_2 - c_1) * per_h_1, -1.0, 1.0);
    float further = noise_growth * 0.87;
    float noise2 = noise1 * further;
    float noise3 = noise2 * further;
    float most0 = metal::max(1.0 - (_e55 * _e55), 0.000001);
    float raw_spread0 = metal::clamp((_e31[0].y - (_e55 * _e55)) / most0, 0.0, 1.0);
    float _e93 = nmt_shrink_to_prior(raw_spread0, 0.3 + (1.8 * per_n), noise2 / most0, 0.12 + (0.5 * per_n));
    float per_mass1 = 1.0 / metal::max(1.0 - _e31[0].y, 0.000001);
    float raw_mean1 = metal::clamp((_e31[0].x - _e31[0].z) * per_mass1, -1.0, 1.0);
    float expected_mean1 = (_e55 * (1.0 - _e93)) / (1.0 + _e93);
    float deviation_1 = (0.17 + (3.1 * per_n)) * (_e93 + 0.02);
    float noise_1 = noise3 * per_mass1;
    float all_noise = noise_1 + (0.0000009536743 * per_mass1);
    float _e128 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise_1, deviation_1);
    float transition_width_1 = (all_noise * deviation_1) / (all_noise + deviation_1);
    float _e134 = front;
    float _e135 = nmt_share_of_four(x_2, _e55, _e93, _e128, transition_width_1);
    front = (n == 4.0) ? (others * _e135) : _e134;
    float _e140 = front;
    front = (n == 3.0) ? (others * metal::clamp(0.5 - (0.5 * _e55), 0.0, 1.0)) : _e140;
    float _e152 = front;
    front = (v_2 == farthest_1) ? others : _e152;
    float _e155 = front;
    front = (others > (0.000001 * b0)) ? _e155 : 0.0;
    float _e161 = front;
    front = (v_2 == nearest_1) ? 0.0 : _e161;
    float _e165 = front;
    float _e170 = front;
    float known = (_e170 >= 0.0) ? metal::min(metal::exp(-(_e165)), 1.0) : -1.0;
    float most1 = metal::max(1.0 - (_e128 * _e128), 0.000001);
    float raw_square1 = metal::clamp((((_e31[0].y - _e31[0].w) * per_mass1) - (_e128 * _e128)) / most1, 0.0, 1.0);
    float offset = (_e128 * (1.0 + _e93)) - (_e55 * (1.0 - _e93));
    float square0 = _e93 * _e93;
    float expected_square1 = metal::clamp(((((0.94 - (3.8 * per_n)) + ((4.0 * square0) * square0)) - ((1.2 * offset) * offset)) * _e93) / ((1.0 + _e93) + _e93), 0.0, 1.0);
    float _e230 = nmt_shrink_to_prior(raw_square1, expected_square1, ((noise3 * further) * per_mass1) / most1, (0.12 + (1.4 * per_n)) * (_e93 + 0.02));
    float spread1 = metal::sqrt(_e230);
    float q0 = 1.0 - _e31[0].y;
    float q1 = _e31[0].x - _e31[0].z;
    float q2 = _e31[0].y - _e31[0].w;
    float q3 = _e31[0].z - _e31[1].x;
    float q4 = _e31[0].w - _e31[1].y;
    float q0_2 = q0 - q2;
    float q1_2 = q1 - q3;
    float q2_2 = q2 - q4;
    float per_mass2 = 1.0 / metal::max(q0_2, 0.000001);
    float raw_mean2 = metal::clamp(q1_2 * per_mass2, -1.0, 1.0);
    float noise_2_ = (((moment_noise * noise_growth) * noise_growth) * noise_growth) * noise_growth;
    float rounded = noise_2_ * per_mass2;
    float mean2 = raw_mean2 * (1.0 / (1.0 + (rounded * rounded)));
    float rounded_2 = (noise_2_ * noise_growth) * per_mass2;
    float spread2 = 0.5 + ((metal::sqrt(metal::clamp(((q2_2 * per_mass2) - (raw_mean2 * raw_mean2)) / metal::max(1.0 - (raw_mean2 * raw_mean2), 0.000001), 0.0, 1.0)) - 0.5) * (1.0 / (1.0 + (rounded_2 * rounded_2))));
    return metal::float3x4(metal::float4(x_2, (metal::log(n) * 0.48089835) - 1.0, metal::log(others + 0.05), _e55), metal::float4(_e93, _e128, spread1, mean2), metal::float4(spread2, known, 0.0, 0.0));
}

float nmt_share(
    metal::float3x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = f[1];
    metal::float4 h0_2 = metal::float4(f[2].x, 1.0, 0.0, 0.0);
    metal::float4 h1_0 = metal::max(((metal::float4x4(metal::float4(-6.111781, 1.2590787, 0.5475349, -1.2606547), metal::float4(-0.9432912, -0.027208287, -0.30223295, -0.008989807), metal::float4(0.10382608, 0.04081687, 0.00517731, 0.13695489), metal::float4(0.5247361, 7.551865, -1.6350569, 7.4871354)) * h0_0) + (metal::float4x4(metal::float4(-1.2694472, -9.020549, -6.307308, 0.1156755), metal::float4(-0.5863311, -6.3508167, 2.2088974, -0.95557034), metal::float4(2.519586, -4.0575604, 6.3729653, -1.4507685), metal::float4(0.05811975, -0.25461668, -0.4064348, -0.41226965)) * h0_1)) + (metal::float4x4(metal::float4(-1.603955, -0.63644004, 0.49392483, 1.1919441), metal::float4(-5.366019, 2.9462543, -0.4136076, -3.124585), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_1 = metal::max(((metal::float4x4(metal::float4(-2.7355766, 1.0036091, -2.8403323, -4.795097), metal::float4(0.024920808, -0.23226534, 0.5254088, 0.11377028), metal::float4(0.13349196, 0.07365853, 0.20932944, 0.016179072), metal::float4(-1.6250459, -4.8359137, -0.08537557, -0.19261461)) * h0_0) + (metal::float4x4(metal::float4(0.13225362, 2.89904, -3.04994, 0.36533222), metal::float4(4.800494, 3.977632, -0.61880076, 0.12900063), metal::float4(-1.0653358, -3.289986, 2.3399897, -0.22318892), metal::float4(-2.6758354, 0.62541056, -0.4392313, 0.027572617)) * h0_1)) + (metal::float4x4(metal::float4(5.42803, 0.50919867, -1.5685683, -0.007823314), metal::float4(-4.863298, 1.7043099, -0.4714574, -4.861206), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_2 = metal::max(((metal::float4x4(metal::float4(-0.13962865, 1.5440083, 3.000412, 3.4353843), metal::float4(-0.57095677, -0.061338373, 0.2472489, 0.19988087), metal::float4(-0.32642198, 0.0010412352, -0.021046346, -0.012095685), metal::float4(0.24782896, 2.2739713, 5.3219786, -4.776767)) * h0_0) + (metal::float4x4(metal::float4(-0.47955763, -0.82601726, 4.6288095, -2.1269662), metal::float4(-0.6476124, -9.601333, -3.9761598, 0.89417446), metal::float4(-0.0847439, 4.3309703, 1.7938333, 0.48631155), metal::float4(0.4469387, 8.027626, -1.1833122, 0.0064941095)) * h0_1)) + (metal::float4x4(metal::float4(-0.49138308, -2.9760563, -0.9328496, 0.8670376), metal::float4(-0.87651825, 0.64863366, -5.0546846, 2.3387825), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_3 = metal::max(((metal::float4x4(metal::float4(-3.5760229, 4.533266, -1.6427152, -1.4796346), metal::float4(-0.07957402, -0.33262858, 0.39887205, -0.07089995), metal::float4(-0.014048754, -0.053987775, -0.08135598, -0.000117340634), metal::float4(-0.11836353, 0.44236583, 3.952692, -0.06623836)) * h0_0) + (metal::float4x4(metal::float4(-1.128837, -0.3080469, -5.6531177, -1.2193537), metal::float4(-0.6106688, -2.1997905, -4.896287, 2.2838867), metal::float4(5.117241, 6.327744, 3.4865515, 3.0882306), metal::float4(1.010223, 0.340252, -0.53299254, -1.0834862)) * h0_1)) + (metal::float4x4(metal::float4(-5.1776967, 0.98614454, 1.1521934, -6.7103496), metal::float4(-3.1058083, -2.119367, -1.3814752, 1.0148283), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_4 = metal::max(((metal::float4x4(metal::float4(0.9691913, 3.6027002, 3.4038823, -1.4982073), metal::float4(-0.09721829, 0.7538304, 0.11502148, -0.36653677), metal::float4(0.069223955, -0.050337084, 0.05156069, 0.00126499), metal::float4(4.8298807, -1.5281683, -6.356912, 1.9819074)) * h0_0) + (metal::float4x4(metal::float4(-9.021647, 2.6192272, -8.228654, -3.639272), metal::float4(-4.886636, -1.1694726, 0.33833027, 3.7475548), metal::float4(5.3034215, 1.6796954, 4.7872767, 4.596024), metal::float4(-1.2544109, 2.2807274, -0.3591253, -0.5454767)) * h0_1)) + (metal::float4x4(metal::float4(1.7421607, 1.9923266, -0.03349984, -0.19245246), metal::float4(0.29631603, 0.41034484, 0.5748713, -0.49153104), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_5 = metal::max(((metal::float4x4(metal::float4(-1.2280331, 3.3868275, -2.665127, -0.74408203), metal::float4(0.043601274, -0.4817103, -0.18844081, -0.06487209), metal::float4(0.012015421, -0.026456503, 0.008891798, 0.0075397766), metal::float4(-4.4597335, 1.201724, 1.7545215, 2.532967)) * h0_0) + (metal::float4x4(metal::float4(3.5101607, -1.9561962, -1.3536254, -2.4960887), metal::float4(3.8059118, -0.80123705, -7.3587255, -8.631405), metal::float4(2.9984262, 0.8873145, 0.38955295, 5.230721), metal::float4(-0.08283735, -0.27585363, 5.9716625, 6.624569)) * h0_1)) + (metal::float4x4(metal::float4(-0.40433055, 0.029642176, 2.079507, -3.0390704), metal::float4(-2.4578543, 3.7255483, -2.189978, -0.87685984), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_6 = metal::max(((metal::float4x4(metal::float4(-3.262312, 2.3860085, 6.7077255, 1.7991533), metal::float4(-0.16270845, 0.032198705, -0.05943885, -0.3940928), metal::float4(0.058438443, 0.015088889, -0.042749982, 0.07342043), metal::float4(-0.7669092, -2.3534462, 0.99614793, 2.8025775)) * h0_0) + (metal::float4x4(metal::float4(-0.9087242, 3.0325496, -1.396636, -1.098918), metal::float4(3.3784263, 6.4511676, -6.228715, -4.159704), metal::float4(0.8494316, -2.7000678, 2.0243857, -5.193673), metal::float4(0.20995937, -4.190236, -0.61862284, -0.02107041)) * h0_1)) + (metal::float4x4(metal::float4(0.12992106, 0.29974172, -0.70772874, -0.85352206), metal::float4(0.72485054, 2.2938392, 1.3125209, 4.1111984), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h1_7 = metal::max(((metal::float4x4(metal::float4(-5.3910193, 5.217595, 3.4597962, 1.1132557), metal::float4(0.0527404, -0.22649224, 0.2102456, -0.04448421), metal::float4(0.02741702, -0.05801576, -0.004462379, 0.038614187), metal::float4(0.07164862, -1.0982728, 1.1179584, 4.9506955)) * h0_0) + (metal::float4x4(metal::float4(-0.22796391, -6.7252426, 5.3008366, -4.017342), metal::float4(5.2988577, 1.8783277, -1.299335, -4.2415414), metal::float4(-1.6573465, 3.03367, 0.923951, -3.392957), metal::float4(0.03842112, 0.5970927, 0.58665645, 0.46000332)) * h0_1)) + (metal::float4x4(metal::float4(-0.08871091, 0.49993217, -2.3402717, 1.2996048), metal::float4(0.29164585, -0.08348722, 0.049777083, 2.3808312), metal::float4(0.0, 0.0, 0.0, 0.0), metal::float4(0.0, 0.0, 0.0, 0.0)) * h0_2), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((((((metal::float4(1.2619187, -2.5986087, -2.149382, 1.3353654) + (metal::float4x4(metal::float4(-2.992966, -2.858956, -4.254115, -0.22101966), metal::float4(1.8619783, -1.7560344, 0.18683062, 0.71421546), metal::float4(-0.9313739, 4.859132, 0.6138396, 0.49655724), metal::float4(-0.37038225, 0.020796178, 0.7491361, 0.8727151)) * h1_0)) + (metal::float4x4(metal::float4(0.36748806, -0.7872776, -3.911794, 0.009744219), metal::float4(-1.1042612, 3.0573065, 0.22637399, 0.12707636), metal::float4(0.9925066, -0.4076182, 0.97743005, 0.30577096), metal::float4(7.2628703, -21.080715, -4.972773, -3.7080753)) * h1_1)) + (metal::float4x4(metal::float4(0.71003896, -0.057421677, -0.7333687, -0.1349236), metal::float4(-3.0351005, -0.025662167, 5.439921, 1.1083124), metal::float4(-1.2842412, -0.40064743, 2.132936, 0.4587207), metal::float4(-0.4143241, 3.001643, 0.0988189, -0.26960135)) * h1_2)) + (metal::float4x4(metal::float4(0.91364557, 0.14445628, -8.310524, -0.065409906), metal::float4(-3.2332554, -2.9022744, -15.36157, 0.50497496), metal::float4(0.8229345, -2.064584, 0.12143615, -0.10263531), metal::float4(0.054719314, 2.4150016, 1.2882204, 1.110596)) * h1_3)) + (metal::float4x4(metal::float4(-0.6192766, 3.047318, -0.96840745, 0.2605519), metal::float4(-1.2917666, -2.2279055, -1.8872515, 0.68316597), metal::float4(0.109164976, 2.52896, 0.8579186, 0.15905996), metal::float4(-0.69663775, 1.246913, -0.710606, 0.92853165)) * h1_4)) + (metal::float4x4(metal::float4(0.9062126, 1.0490677, 1.9008839, -1.0397452), metal::float4(1.6107726, -1.0856603, 1.346723, 0.993593), metal::float4(1.7179087, 0.22983813, -3.5189588, -1.0520781), metal::float4(2.4576623, 0.5125091, -6.4215956, -0.5380803)) * h1_5)) + (metal::float4x4(metal::float4(0.3615602, -4.6017222, -0.14912221, 0.4948515), metal::float4(-0.63468134, -9.653261, -1.9091142, -0.03045894), metal::float4(-2.565982, -2.7410276, -8.579719, -1.8886751), metal::float4(0.37309378, -0.7666512, 0.9897772, -0.053876042)) * h1_6)) + (metal::float4x4(metal::float4(0.14261079, -2.7428598, 0.71818084, 0.079738714), metal::float4(1.1686169, 2.7973378, -12.209488, -1.3224617), metal::float4(-0.10436231, 3.5554519, -1.8719939, -0.083544716), metal::float4(0.37562165, -2.0031798, -1.140298, 1.4245508)) * h1_7), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((((((metal::float4(-4.6729555, 3.27779, -12.580061, -0.2602885) + (metal::float4x4(metal::float4(0.07020887, -7.7853203, 3.2623754, -0.9289991), metal::float4(-0.41948175, 0.91524047, -0.09373543, 3.1709063), metal::float4(1.707971, 0.79446125, 0.14929785, 2.5686665), metal::float4(-0.056600675, -0.1659347, 5.8103175, -1.8952311)) * h1_0)) + (metal::float4x4(metal::float4(-4.786343, 1.030607, 0.3021604, -0.21997102), metal::float4(2.4703267, 1.123544, 2.1217737, -0.52224094), metal::float4(-2.2712877, 0.5158962, 0.3472931, 1.4640517), metal::float4(0.11313607, -13.780107, 8.568549, -13.411448)) * h1_1)) + (metal::float4x4(metal::float4(-0.04082529, 0.1669218, 0.46733433, -0.36587787), metal::float4(0.34007803, 1.5025666, -1.0191387, -2.497706), metal::float4(5.29306, -0.110161185, -0.45350894, -2.687117), metal::float4(1.1021147, -0.042523265, -8.089456, -1.1886902)) * h1_2)) + (metal::float4x4(metal::float4(0.3839846, 1.6447116, -2.4580069, -0.70252365), metal::float4(0.26104167, -0.5908336, 0.026685795, -1.7847142), metal::float4(-5.2497396, -0.5974036, -3.9859402, 1.2823159), metal::float4(-2.8455558, 1.4684895, 0.58783984, 0.48113063)) * h1_3)) + (metal::float4x4(metal::float4(0.16200472, 0.6974124, -0.056665666, 5.1168947), metal::float4(-1.1185981, 0.28122574, -1.1758981, -0.2487846), metal::float4(-0.40818137, 0.45375705, 0.3172075, -2.4046204), metal::float4(-3.1995828, 1.259068, 1.8805319, 2.4689593)) * h1_4)) + (metal::float4x4(metal::float4(-1.3353378, 0.63000417, 0.38511258, 2.2301257), metal::float4(0.2802323, -0.1214043, 0.15000337, -1.1558938), metal::float4(0.71096516, -1.684167, -0.530025, -0.8572137), metal::float4(-3.2262592, -0.68959, 2.0129254, 4.257681)) * h1_5)) + (metal::float4x4(metal::float4(-19.512064, -0.18027107, -3.1857862, -0.6899437), metal::float4(-0.3005064, -0.34270313, -0.42363968, -5.0216107), metal::float4(-2.4683843, 0.21464697, 1.3507403, -2.8129263), metal::float4(-0.07548671, -0.8579342, -1.1152614, 3.2826817)) * h1_6)) + (metal::float4x4(metal::float4(-12.441226, -1.5329676, -0.020585677, -1.3522521), metal::float4(6.684407, -1.0653955, 2.805359, -5.174105), metal::float4(-1.2013803, -0.14954259, 1.1032336, -2.7582016), metal::float4(-1.0236809, -0.6934412, 0.20977055, -0.44141737)) * h1_7), metal::float4(0.0));
    metal::float4 h2_2 = metal::max((((((((metal::float4(-0.13580789, 0.6970699, -0.15496458, 0.740331) + (metal::float4x4(metal::float4(-0.08507485, -3.0545528, 0.096640795, -2.997112), metal::float4(0.016383547, -0.38022602, -0.32512355, -2.9064112), metal::float4(-0.18832994, -2.7187495, -0.30681947, 3.0764172), metal::float4(0.032234084, -0.674778, -0.26126426, -0.7389055)) * h1_0)) + (metal::float4x4(metal::float4(-0.30429694, -5.9502687, -0.25058585, -0.56996036), metal::float4(-0.44421595, 1.3879135, -0.46375105, -1.5739975), metal::float4(-0.5096615, 1.5734165, -0.22679868, 0.034422264), metal::float4(-0.30219105, -18.450062, -0.06314865, -11.160464)) * h1_1)) + (metal::float4x4(metal::float4(-0.02603846, 0.30140403, 0.2238884, -0.4666892), metal::float4(-0.029553855, 1.2880361, 0.108896896, -2.0154498), metal::float4(-0.14497134, 0.71481055, -0.06489657, 1.5688689), metal::float4(-0.43832225, 1.1543839, -0.74085, 1.265431)) * h1_2)) + (metal::float4x4(metal::float4(0.17543544, -4.287299, 0.035343643, 2.50911), metal::float4(0.15206087, 0.5505871, -0.5673676, -2.6335747), metal::float4(-0.2942823, -2.0406406, 0.12456984, -1.7555345), metal::float4(-0.01804171, 4.622501, -0.11310927, 3.5968187)) * h1_3)) + (metal::float4x4(metal::float4(-0.24732798, 0.020867135, 0.11910821, -0.59342366), metal::float4(-0.24452622, -0.71158904, -0.73464835, 0.033891715), metal::float4(0.060986243, 0.14190178, 0.103602394, -0.3242666), metal::float4(-0.32296723, -2.1236103, -0.11954761, -0.5252579)) * h1_4)) + (metal::float4x4(metal::float4(-0.22450684, -2.814268, -0.18150029, 1.3641322), metal::float4(0.027793886, -0.5324461, -0.20759605, -2.3197892), metal::float4(0.04657861, 1.1140198, 0.24319865, -9.763681), metal::float4(-0.35169291, -1.7075313, -0.068953544, -9.342775)) * h1_5)) + (metal::float4x4(metal::float4(-0.4123966, -5.300227, -0.0910799, -2.8317666), metal::float4(-0.287858, 0.46392447, -0.16798578, 0.6952194), metal::float4(-0.1862946, -0.63765377, -0.69623035, 2.604372), metal::float4(-0.33906487, -0.5565427, -0.42190912, -0.23940141)) * h1_6)) + (metal::float4x4(metal::float4(-0.12144742, -20.892881, -0.4145004, 1.2375941), metal::float4(-0.697824, 1.987435, -0.5976051, 4.402753), metal::float4(-0.20529044, -0.3576681, -0.21677442, -0.24279527), metal::float4(-0.08807971, 2.9789166, 0.071931176, -2.929071)) * h1_7), metal::float4(0.0));
    metal::float4 h2_3 = metal::max((((((((metal::float4(-0.12114108, 1.2450967, -2.2606373, -0.36267692) + (metal::float4x4(metal::float4(-2.6315901, -0.34439078, -2.9610267, -1.0923961), metal::float4(0.223164, 1.8039895, 2.5519726, -0.9711679), metal::float4(-0.24532005, -2.3492897, -1.4704975, 0.76217866), metal::float4(0.36889645, -0.115326025, 0.35473856, -0.20498301)) * h1_0)) + (metal::float4x4(metal::float4(-0.88672864, -0.39859805, 2.39492, 1.744944), metal::float4(-0.69307685, -0.99920523, 4.2183623, -0.87868303), metal::float4(0.35942724, -0.29691926, 1.0818437, 1.3207207), metal::float4(-30.2384, 0.10928893, -7.0647554, 15.717544)) * h1_1)) + (metal::float4x4(metal::float4(-0.20164908, -0.19088599, 0.1551302, 0.04737597), metal::float4(-0.81887734, -3.1323016, -2.7505014, -1.5834199), metal::float4(-0.14424095, -1.555143, -4.6802588, -1.3235509), metal::float4(-0.25277188, -0.4647671, 1.6973499, -0.99667746)) * h1_2)) + (metal::float4x4(metal::float4(0.78845274, 0.7655463, 3.7973511, 3.320911), metal::float4(-1.2283723, -4.476903, -3.5822878, -3.721869), metal::float4(0.46523815, 0.041043233, 2.1500504, 1.4796671), metal::float4(-4.0602994, 2.0099647, 0.85182285, -0.7933596)) * h1_3)) + (metal::float4x4(metal::float4(0.35618836, -0.5405226, -0.8827116, 1.0714078), metal::float4(1.0268298, -0.2317349, -2.412876, -1.5990334), metal::float4(0.2031206, -0.9403622, 1.6003618, -1.0273224), metal::float4(0.9049673, 0.47973, -1.1511244, 0.058414135)) * h1_4)) + (metal::float4x4(metal::float4(1.9166514, 1.426175, -1.1536136, 1.3503083), metal::float4(2.6654356, -2.2231581, 0.58408207, 2.110834), metal::float4(-0.79796445, -3.0819988, 0.9331857, 0.02824189), metal::float4(1.5963962, 7.198678, 2.0963554, 2.8723466)) * h1_5)) + (metal::float4x4(metal::float4(-1.2596036, 0.631166, -11.672623, -0.5510185), metal::float4(-1.0386657, -3.2057896, -2.1611688, -1.6124867), metal::float4(-0.38434005, -3.9630258, -1.478051, -2.4563847), metal::float4(1.4227921, 1.0508367, 1.2534283, 0.904385)) * h1_6)) + (metal::float4x4(metal::float4(-0.8039124, -1.2763106, -23.93499, 0.287792), metal::float4(-1.8194247, -1.8709297, 1.4603959, 0.10037173), metal::float4(-0.9812876, -2.6164715, -0.132473, -1.9431459), metal::float4(-1.5269586, -0.5822796, 1.6227671, -0.8949245)) * h1_7), metal::float4(0.0));
    float logit = (((NMT_B3 + metal::dot(metal::float4(-0.20100085, 0.17548272, 0.09926478, -0.21060409), h2_0)) + metal::dot(metal::float4(0.18316391, 0.13202123, -0.10359111, -0.18595253), h2_1)) + metal::dot(metal::float4(0.5044715, 0.1379622, -0.045420256, 0.09471249), h2_2)) + metal::dot(metal::float4(0.13760756, 0.21741933, 0.2403533, -0.21945743), h2_3);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float3x4 f_1
) {
    float absorbance_6 = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance_6 * _e10, 80.0)));
}

float nmt_fragment_transmittance(
    float v_3,
    float z_3,
    float absorbance_3,
    float nearest_2,
    float farthest_2,
    float z_nearest_1,
    float z_farthest_1,
    float n_1,
    float b0_1,
    metal::float2x4 b_3
) {
    float front_1 = 0.0;
    float others_1 = metal::clamp(b0_1 - absorbance_3, 0.0, 1000000000000000000000000000000.0);
    if (v_3 != nearest_2) {
        if (others_1 > (0.000001 * b0_1)) {
            front_1 = others_1;
            if (v_3 != farthest_2) {
                float c_2 = 0.5 * (z_nearest_1 + z_farthest_1);
                float per_b0_2 = 1.0 / metal::max(metal::max(others_1, b0_1 * 0.000001), 0.000000000000000000000000000001);
                float per_h_2 = 1.0 / metal::max(0.5 * (z_farthest_1 - z_nearest_1), 0.00000001);
                metal::float2x4 _e38 = nmt_recentred_moments(z_3, absorbance_3, c_2, per_h_2, per_b0_2, b_3);
                float noise_growth_1 = 1.0 + ((2.0 * metal::abs(c_2)) * per_h_2);
                float moment_noise_1 = ((NMT_ROUNDING * noise_growth_1) * b0_1) * per_b0_2;
                float noise1_1 = moment_noise_1 * (0.12 * metal::sqrt(n_1));
                float per_n_1 = 1.0 / n_1;
                float _e62 = nmt_shrink_to_prior(_e38[0].x, 0.0, noise1_1, 0.22 + (0.7 * per_n_1));
                front_1 = others_1 * metal::clamp(0.5 - (0.5 * _e62), 0.0, 1.0);
                if (n_1 != 3.0) {
                    float _e78 = nmt_place_in_thin(v_3, nearest_2, farthest_2);
                    float x_3 = (0.01 > ((farthest_2 - nearest_2) / nearest_2)) ? _e78 : metal::clamp((z_3 - c_2) * per_h_2, -1.0, 1.0);
                    float further_1 = noise_growth_1 * 0.87;
                    float noise2_1 = noise1_1 * further_1;
                    float noise3_1 = noise2_1 * further_1;
                    float most0_1 = metal::max(1.0 - (_e62 * _e62), 0.000001);
                    float raw_spread0_1 = metal::clamp((_e38[0].y - (_e62 * _e62)) / most0_1, 0.0, 1.0);
                    float _e110 = nmt_shrink_to_prior(raw_spread0_1, 0.3 + (1.8 * per_n_1), noise2_1 / most0_1, 0.12 + (0.5 * per_n_1));
                    float per_mass1_1 = 1.0 / metal::max(1.0 - _e38[0].y, 0.000001);
                    float raw_mean1_1 = metal::clamp((_e38[0].x - _e38[0].z) * per_mass1_1, -1.0, 1.0);
                    float expected_mean1_1 = (_e62 * (1.0 - _e110)) / (1.0 + _e110);
                    float deviation_2 = (0.17 + (3.1 * per_n_1)) * (_e110 + 0.02);
                    float noise_2 = noise3_1 * per_mass1_1;
                    float all_noise_1 = noise_2 + (0.0000009536743 * per_mass1_1);
                    float _e145 = nmt_shrink_to_prior(raw_mean1_1, expected_mean1_1, noise_2, deviation_2);
                    float transition_width_2 = (all_noise_1 * deviation_2) / (all_noise_1 + deviation_2);
                    float _e149 = nmt_share_of_four(x_3, _e62, _e110, _e145, transition_width_2);
                    front_1 = others_1 * _e149;
                    if (n_1 != 4.0) {
                        float most1_1 = metal::max(1.0 - (_e145 * _e145), 0.000001);
                        float raw_square1_1 = metal::clamp((((_e38[0].y - _e38[0].w) * per_mass1_1) - (_e145 * _e145)) / most1_1, 0.0, 1.0);
                        float offset_1 = (_e145 * (1.0 + _e110)) - (_e62 * (1.0 - _e110));
                        float square0_1 = _e110 * _e110;
                        float expected_square1_1 = metal::clamp(((((0.94 - (3.8 * per_n_1)) + ((4.0 * square0_1) * square0_1)) - ((1.2 * offset_1) * offset_1)) * _e110) / ((1.0 + _e110) + _e110), 0.0, 1.0);
                        float _e208 = nmt_shrink_to_prior(raw_square1_1, expected_square1_1, ((noise3_1 * further_1) * per_mass1_1) / most1_1, (0.12 + (1.4 * per_n_1)) * (_e110 + 0.02));
                        float spread1_1 = metal::sqrt(_e208);
                        float q0_1 = 1.0 - _e38[0].y;
                        float q1_1 = _e38[0].x - _e38[0].z;
                        float q2_1 = _e38[0].y - _e38[0].w;
                        float q3_1 = _e38[0].z - _e38[1].x;
                        float q4_1 = _e38[0].w - _e38[1].y;
                        float q0_2_1 = q0_1 - q2_1;
                        float q1_2_1 = q1_1 - q3_1;
                        float q2_2_1 = q2_1 - q4_1;
                        float per_mass2_1 = 1.0 / metal::max(q0_2_1, 0.000001);
                        float raw_mean2_1 = metal::clamp(q1_2_1 * per_mass2_1, -1.0, 1.0);
                        float noise_2_1 = (((moment_noise_1 * noise_growth_1) * noise_growth_1) * noise_growth_1) * noise_growth_1;
                        float rounded_1 = noise_2_1 * per_mass2_1;
                        float mean2_1 = raw_mean2_1 * (1.0 / (1.0 + (rounded_1 * rounded_1)));
                        float rounded_2_1 = (noise_2_1 * noise_growth_1) * per_mass2_1;
                        float spread2_1 = 0.5 + ((metal::sqrt(metal::clamp(((q2_2_1 * per_mass2_1) - (raw_mean2_1 * raw_mean2_1)) / metal::max(1.0 - (raw_mean2_1 * raw_mean2_1), 0.000001), 0.0, 1.0)) - 0.5) * (1.0 / (1.0 + (rounded_2_1 * rounded_2_1))));
                        float _e296 = nmt_share(metal::float3x4(metal::float4(x_3, (metal::log(n_1) * 0.48089835) - 1.0, metal::log(others_1 + 0.05), _e62), metal::float4(_e110, _e145, spread1_1, mean2_1), metal::float4(spread2_1, 0.0, 0.0, 0.0)));
                        front_1 = others_1 * _e296;
                    }
                }
            }
        }
    }
    float _e298 = front_1;
    return metal::min(metal::exp(-(_e298)), 1.0);
}

float nmt_first_hidden_depth(
    float b0_2,
    float b1,
    float b2
) {
    float excess = b0_2 - 5.0;
    float deviation_3 = metal::sqrt((metal::max((b2 * b0_2) - (b1 * b1), 0.0) * 5.0) / metal::max(excess, 0.000001));
    return (excess > 0.0) ? ((b1 + deviation_3) / metal::max(b0_2, 0.000000000000000000000000000001)) : 300000000000000000000000000000000000000.0;
}

float nmt_hidden_weight(
    float z_4,
    float absorbance_4,
    float z_nearest_2,
    float z_farthest_2,
    float n_2,
    float b0_3,
    metal::float2x4 b_4
) {
    float c_3 = 0.5 * (z_nearest_2 + z_farthest_2);
    float others_2 = metal::clamp(b0_3 - absorbance_4, 0.0, 1000000000000000000000000000000.0);
    float per_b0_3 = 1.0 / metal::max(metal::max(others_2, b0_3 * 0.000001), 0.000000000000000000000000000001);
    float per_h_3 = 1.0 / metal::max(0.5 * (z_farthest_2 - z_nearest_2), 0.00000001);
    metal::float2x4 _e28 = nmt_recentred_moments(z_4, absorbance_4, c_3, per_h_3, per_b0_3, b_4);
    float noise_growth_2 = 1.0 + ((2.0 * metal::abs(c_3)) * per_h_3);
    float unsure = (((n_2 + 16.0) * NMT_ROUNDING) * b0_3) / metal::max(others_2, 0.000000000000000000000000000001);
    float off = 0.000002 * per_h_3;
    float end = 1.0 + off;
    float x_4 = metal::clamp((z_4 - c_3) * per_h_3, -1.0, 1.0) - off;
    float ahead = x_4 - _e28[0].x;
    float r1 = metal::max(_e28[0].x - (metal::max(_e28[0].y - (_e28[0].x * _e28[0].x), 0.0) / metal::max(ahead, 0.000000000000000000000000000001)), -1000000.0);
    float growth1 = noise_growth_2 + metal::abs(r1);
    float gap1 = x_4 - r1;
    float share1 = (((_e28[0].y - ((2.0 * r1) * _e28[0].x)) + (r1 * r1)) + (unsure * (growth1 * growth1))) / metal::max(gap1 * gap1, 0.000000000000000000000000000001);
    float w1 = _e28[0].x - _e28[0].z;
    float below = w1 - (x_4 * (1.0 - _e28[0].y));
    float inner_1 = ((_e28[0].y - _e28[0].w) - (x_4 * w1)) / ((0.000000000000000000000000000001 > metal::abs(below)) ? 0.000000000000000000000000000001 : below);
    float outer = metal::max(r1, -1.0);
    float inside = (inner_1 >= -(end)) ? inner_1 : outer;
    float r = (x_4 > inside) ? inside : outer;
    float gap = x_4 - r;
    float per_value = 1.0 / metal::max((end + x_4) * (gap * gap), 0.000000000000000000000000000001);
    float end_gap = end - r;
    float gamma = (0.99999 * (1.0 - (1.0 / (((2.0 * end) * (end_gap * end_gap)) * per_value)))) / (end - x_4);
    float p0 = (end * r) * r;
    float p1 = (r * r) - ((2.0 * r) * end);
    float p2 = end - (2.0 * r);
    float lift = 1.0 + (gamma * x_4);
    float value_1 = ((((p0 * lift) + (((p1 * lift) - (gamma * p0)) * _e28[0].x)) + (((p2 * lift) - (gamma * p1)) * _e28[0].y)) + ((lift - (gamma * p2)) * _e28[0].z)) - (gamma * _e28[0].w);
    float growth2 = noise_growth_2 + metal::abs(r);
    float lost = ((unsure * (end + noise_growth_2)) * (growth2 * growth2)) * (1.0 + (gamma * (metal::abs(x_4) + noise_growth_2)));
    float share2 = (value_1 + lost) * per_value;
    float share = metal::min(share1, share2) * 1.00001;
    float behind_1 = (ahead > 0.0) ? ((1.0 > share) ? metal::max(share, 0.0) : 1.0) : 1.0;
    float least_depth = (others_2 * (1.0 - behind_1)) - ((((n_2 + 4.0) * NMT_ROUNDING) * b0_3) + 0.00001);
    return metal::exp(-(least_depth)) * metal::min((others_2 * behind_1) + absorbance_4, n_2 - 2.0);
}

float nmt_visible_transmittance(
    float v_4,
    float z_5,
    float absorbance_5,
    float nearest_3,
    float farthest_3,
    float z_nearest_3,
    float z_farthest_3,
    float n_3,
    float b0_4,
    metal::float2x4 b_5
) {
    float front_2 = -1.0;
    float answer = {};
    float others_3 = metal::clamp(b0_4 - absorbance_5, 0.0, 1000000000000000000000000000000.0);
    if (n_3 > 4.0) {
        if (v_4 != nearest_3) {
            if (v_4 != farthest_3) {
                if (others_3 > (0.000001 * b0_4)) {
                    if (b0_4 <= NMT_FAINT) {
                        front_2 = 0.5 * others_3;
                    }
                    if (true) {
                        float _e32 = nmt_first_hidden_depth(b0_4, b_5[0].x, b_5[0].y);
                        if (z_5 >= _e32) {
                            float _e34 = nmt_hidden_weight(z_5, absorbance_5, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
                            if (_e34 <= NMT_HIDDEN) {
                                front_2 = others_3;
                            }
                        }
                    }
                }
            }
        }
    }
    float _e37 = front_2;
    answer = metal::min(metal::exp(-(_e37)), 1.0);
    float _e43 = front_2;
    if (_e43 < 0.0) {
        float _e46 = nmt_fragment_transmittance(v_4, z_5, absorbance_5, nearest_3, farthest_3, z_nearest_3, z_farthest_3, n_3, b0_4, b_5);
        answer = _e46;
    }
    float _e47 = answer;
    return _e47;
}

NmtSums nmt_pass1(
    float v_5,
    float v0_1,
    float v1_1,
    float alpha_1
) {
    float _e4 = nmt_absorbance(alpha_1);
    float _e5 = nmt_moment_depth(v_5, v0_1, v1_1);
    metal::float2x4 _e6 = nmt_moments(_e5, _e4);
    return NmtSums {metal::float4(_e4, _e6[0].xyz), metal::float4(_e6[0].w, _e6[1].xy, 1.0), metal::float4(-(v_5), v_5, 0.0, 0.0)};
}

float nmt_pass2(
    float v_6,
    float v0_2,
    float v1_2,
    float alpha_2,
    metal::float4 sums0,
    metal::float4 sums1,
    metal::float4 range
) {
    float nearest_4 = -(range.x);
    float _e9 = nmt_moment_depth(v_6, v0_2, v1_2);
    float _e10 = nmt_absorbance(alpha_2);
    float _e12 = nmt_moment_depth(nearest_4, v0_2, v1_2);
    float _e14 = nmt_moment_depth(range.y, v0_2, v1_2);
    float _e25 = nmt_fragment_transmittance(v_6, _e9, _e10, nearest_4, range.y, _e12, _e14, sums1.w, sums0.x, metal::float2x4(metal::float4(sums0.yzw, sums1.x), metal::float4(sums1.yz, 0.0, 0.0)));
    return _e25;
}

float nmt_visible_pass2(
    float v_7,
    float v0_3,
    float v1_3,
    float alpha_3,
    metal::float4 sums0_1,
    metal::float4 sums1_1,
    metal::float4 range_1
) {
    float nearest_5 = -(range_1.x);
    float _e9 = nmt_moment_depth(v_7, v0_3, v1_3);
    float _e10 = nmt_absorbance(alpha_3);
    float _e12 = nmt_moment_depth(nearest_5, v0_3, v1_3);
    float _e14 = nmt_moment_depth(range_1.y, v0_3, v1_3);
    float _e25 = nmt_visible_transmittance(v_7, _e9, _e10, nearest_5, range_1.y, _e12, _e14, sums1_1.w, sums0_1.x, metal::float2x4(metal::float4(sums0_1.yzw, sums1_1.x), metal::float4(sums1_1.yz, 0.0, 0.0)));
    return _e25;
}

metal::float4 nmt_resolve(
    metal::float4 weighted,
    metal::float4 sums0_2
) {
    float behind_2 = metal::exp(-(sums0_2.x));
    float scale = (weighted.w > 0.0) ? ((1.0 - behind_2) / metal::max(weighted.w, 0.0000000000000000000000000000000000001)) : 0.0;
    return metal::float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind_2);
}

#endif
