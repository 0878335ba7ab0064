// Core and tail: a pixel's nearest, its farthest and its 4 heaviest other fragments one by one, all others by their sums.
// Written by nmt 0.1.0.
//
// Frame:  codes = nmt_core_codes(v0, v1), v0 and v1 the least and the greatest view depth of what is transparent. Clear to 0 the buffer
//         nmt_core, 6 words a pixel, and targets for b0, 4 moments and n, which are added up by blending in f32.
// Pass 1, for every fragment of view depth v and opacity alpha:
//         steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes)
//         nmt_core_insert(pixel, steps, codes)
//         add to b0: nmt_core_absorbance(steps); to the moments: nmt_core_moments(steps); to n: 1 where steps.y > 0, else 0
// Pass 2: T = nmt_core_transmittance(steps, codes, core0, ..., n, b0, moments), the core as vectors of four words;
//         steps must come from the same expressions as in pass 1. Add up alpha T C and alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

#ifndef NMT_INCLUDED_CORE_CHAIN
#define NMT_INCLUDED_CORE_CHAIN

// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-4-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =
// least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1
// alone): Markov's bounds. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

#ifndef NMT_INCLUDED_CORE
#define NMT_INCLUDED_CORE

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
mat3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, vec4 tail) {
    return mat3x4(vec4(x, count, ln_b0, lower), vec4(upper, tail.xyz), vec4(tail.w, 0.0, 0.0, 0.0));
}

const mat4 NMT_W1[24] = mat4[24](
    mat4(vec4(-6.644906, -6.8369474, 4.1170993, 2.9288063), vec4(0.24427499, -0.09179742, -0.18109056, 0.39672866), vec4(0.09456859, -0.0558132, -0.004021847, -0.251864), vec4(2.366806, -0.011803482, -0.1023652, 45.75337)),
    mat4(vec4(-1.4355919, 0.14289287, -0.23304649, -73.084694), vec4(-0.88735557, 0.58894396, -2.9240642, -2.084273), vec4(0.70983315, -1.0194519, -2.769523, 4.739505), vec4(0.39219984, 0.013014964, 5.017334, -1.925962)),
    mat4(vec4(0.7737863, 0.020955756, -1.8071773, -0.69392633), vec4(-6.5454655, -5.757807, 3.6420445, 3.7493362), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-7.274952, -1.2582943, 0.750487, -4.7914953), vec4(-0.03187928, -0.18776524, -0.10574456, -0.10121069), vec4(0.02594284, 0.0060951775, 0.12402804, -0.14500959), vec4(8.788641, 12.080313, -23.444958, 7.274002)),
    mat4(vec4(-20.707815, -23.360075, -6.007787, -1.3619602), vec4(-0.2932839, 8.935144, -8.427754, 1.7369972), vec4(3.0867727, -12.55485, -5.0971174, -29.500847), vec4(-0.6835189, -8.825866, 9.538471, 0.022721268)),
    mat4(vec4(-0.25592273, 0.15926334, 7.352642, -0.32446146), vec4(-7.146026, 1.3202263, -0.6231722, 1.0852268), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.2347827, -1.5456473, -3.0691724, -2.5347395), vec4(0.08673811, 0.046493262, -0.5524588, -0.030162303), vec4(0.22072567, 0.23512895, 0.27654696, -0.0552715), vec4(-8.506384, -5.3671, -2.738622, -0.768126)),
    mat4(vec4(5.099379, 3.4453056, 1.6650816, 10.453707), vec4(-3.5380375, 6.0613985, 2.3064294, 3.2792985), vec4(-3.6804945, 2.2989976, -16.632036, -0.9256119), vec4(9.719984, -5.940651, 0.346839, -0.87034315)),
    mat4(vec4(4.873015, -8.553477, 0.44932845, -6.306754), vec4(-5.170214, -0.41068712, 1.5794455, -0.12941931), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.82907254, 2.055103, -3.9308155, -1.8275987), vec4(0.24345244, 0.49341047, 0.6545849, -0.022919524), vec4(-0.12706393, -0.35977432, -0.5561126, 0.17710388), vec4(20.038559, 10.374188, 4.932662, -9.194126)),
    mat4(vec4(-9.926305, 1.2870265, -0.85073864, 0.28929147), vec4(2.8270183, -0.9751517, 2.8089926, -1.0786438), vec4(0.1419767, -0.02160598, -3.3599737, 4.795184), vec4(4.8569894, 1.4082379, 1.8042303, 2.2699566)),
    mat4(vec4(-2.1796367, 1.5583503, -0.387307, -12.48738), vec4(-5.879166, 1.8285091, -0.10583214, 1.4132012), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-2.1612747, -3.3155434, 5.7242703, -6.0707493), vec4(-0.19226082, 0.15382223, -0.34234348, -0.006578651), vec4(0.19576819, -0.38018504, 0.084700346, -0.0009343119), vec4(2.5350783, 8.021561, 0.92302895, -19.162228)),
    mat4(vec4(5.2881513, -7.946638, -3.55236, 0.024127962), vec4(5.5462565, 2.638155, -4.987424, -0.041671384), vec4(1.106101, -10.608368, -2.8620849, 0.11833197), vec4(-1.678799, 0.40029234, -2.4656491, 0.03180234)),
    mat4(vec4(0.011229959, 0.30013785, -1.7312031, 0.00095800485), vec4(-3.161044, 2.34481, 5.5600524, -6.074554), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.83962137, 2.2565045, 0.3291371, 1.5309821), vec4(-0.46886164, 0.04599322, 0.17105673, -0.94829005), vec4(1.280081, -0.02836603, 0.13397053, 0.42108443), vec4(8.010298, 12.996346, -0.9753846, -10.440201)),
    mat4(vec4(-6.3218236, -14.843192, 0.21337391, -4.3733397), vec4(-2.7684438, -4.504969, 2.6891792, -2.67894), vec4(1.9443177, -6.2891393, 4.648647, 1.6464616), vec4(0.56212527, 3.0974865, -8.001758, 0.33785355)),
    mat4(vec4(-0.55173165, 11.879521, 2.8588138, 6.7998548), vec4(-3.9557676, -0.8232811, -4.226862, -1.1620078), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.09421036, 3.3446453, 5.9199386, -2.0354898), vec4(-0.32518014, 0.11868493, -0.0003276461, -0.86161435), vec4(0.23984146, 0.013836953, 0.16386716, 0.6702215), vec4(21.249325, 2.2917397, -54.71574, -13.427977)),
    mat4(vec4(-30.97261, 0.216219, 2.2226324, -8.0110235), vec4(-1.3988694, 2.413615, -0.9885946, -2.2326064), vec4(1.216775, 3.12481, -1.014333, -0.5798262), vec4(0.9931289, -4.5937138, -0.06466371, 1.4991573)),
    mat4(vec4(-0.44282106, -5.0399785, 0.90951955, 1.2706821), vec4(2.2369783, 3.8954997, 3.736989, -0.8606754), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(0.8110742, 2.519742, -2.8404272, -2.533226), vec4(-0.16292943, -0.15577753, 0.0023999377, 0.1807285), vec4(-0.10005566, 0.20275813, -0.026740337, -0.10489468), vec4(-109.459465, 0.28144076, -2.1053116, 22.064835)),
    mat4(vec4(-18.75007, 5.0484786, -0.8004698, -17.53146), vec4(-0.7771674, 2.6927354, 4.2178493, 6.849358), vec4(2.1881056, 2.6948338, -5.263059, -4.4680424), vec4(-0.62796694, 0.9298859, -5.847802, -7.7678084)),
    mat4(vec4(2.4307024, 4.0429654, 1.3701764, 0.049088877), vec4(2.5936298, -4.2656145, 0.21204378, -0.5714553), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[32] = mat4[32](
    mat4(vec4(-2.255839, 0.38752246, 1.0548706, 0.29508346), vec4(3.5021229, -5.5486403, 3.919978, 7.1393404), vec4(0.7005687, -0.65590554, -0.5999031, 0.3372998), vec4(0.55797297, -3.5278974, -0.9375819, -1.3799571)),
    mat4(vec4(-0.822207, 9.646074, 2.7334387, -2.0096188), vec4(-0.34243435, 0.38596803, -1.3136973, -4.985529), vec4(-0.27410707, -3.056068, 0.50217193, 0.96197915), vec4(-1.5862749, -1.5913026, -0.78255177, 1.6379662)),
    mat4(vec4(0.37614006, 0.62856156, 1.2053005, -0.115299), vec4(0.4000405, -2.2793074, 0.703724, 1.3842056), vec4(0.046837762, 2.1889262, 1.6758739, 0.5046616), vec4(-1.2901784, 0.6479536, -0.18261576, 0.47293198)),
    mat4(vec4(2.4513392, -3.2317476, -0.2937333, -0.87541187), vec4(-1.8018963, -0.08537033, -0.20679249, 0.17125203), vec4(0.37318125, 0.7007333, 1.0497698, -0.45693758), vec4(-0.07528782, -1.2427787, -0.3740497, -1.6162221)),
    mat4(vec4(-0.0056854156, -0.46216673, 0.37168384, 2.5266922), vec4(0.42355457, 0.56246275, 1.8464576, 0.30171275), vec4(-1.2142218, -0.93152916, 0.09710974, -0.1281254), vec4(-35.785778, -10.926431, 17.699657, -37.416485)),
    mat4(vec4(0.0455293, 0.4253418, 1.3075101, -0.33589628), vec4(0.37694284, -0.46193188, -0.16009994, -1.2368256), vec4(-0.7424769, -0.91597766, 1.3993851, 0.8158363), vec4(0.6780773, -0.98902965, -0.23915097, -0.84954214)),
    mat4(vec4(0.4356865, -3.6098413, 1.1518133, 1.6138109), vec4(0.018964194, -1.5095415, -0.03347981, -1.7394528), vec4(0.34304652, 0.37768713, 0.37472695, 0.55225396), vec4(-0.16768894, 1.2062308, 1.1071843, -1.0196143)),
    mat4(vec4(-0.9044732, -1.5783812, 0.044219047, 1.1296388), vec4(0.723707, 0.8417245, 0.18935676, 0.49409577), vec4(0.87967724, -0.9325288, -0.34372085, 1.7053646), vec4(0.42819053, -0.4067075, 0.06962549, -2.9700143)),
    mat4(vec4(2.5356777, -0.43621665, 7.423511, 0.71164465), vec4(-2.5701082, -0.6688071, 10.531412, -0.6108748), vec4(-0.39176378, -1.192722, 0.9267386, -0.5292072), vec4(-2.8794026, 0.21899784, 0.5366228, 0.048845787)),
    mat4(vec4(-0.8919236, -0.72751194, -1.7338217, -1.5668687), vec4(0.96019304, -0.34058416, -2.638105, -4.055744), vec4(0.8843582, -0.9128858, 0.117157556, 1.4530233), vec4(-0.708193, -0.66400707, 0.14623506, -0.4712691)),
    mat4(vec4(-0.7783678, -0.31102005, 0.44752443, -2.3856215), vec4(0.2624257, -1.0766104, -0.8439249, -0.74432045), vec4(-0.22061767, -0.43857747, -0.7492733, 0.49457687), vec4(-0.58638155, -0.2999724, -0.0067094145, 1.5273387)),
    mat4(vec4(3.4200375, -0.25266263, -3.1257107, -1.217456), vec4(-0.69696784, -0.6843623, -0.8573749, -0.56962454), vec4(0.01716081, -0.9216826, -1.5785106, -0.010490018), vec4(0.28287438, -0.4286377, 0.51161504, -0.95480466)),
    mat4(vec4(0.58851045, -1.0371984, 0.7001552, 0.806398), vec4(0.016595919, -0.7279884, 0.18224803, 1.1515921), vec4(0.3760666, -0.5972783, -0.2621969, 0.5113156), vec4(10.545665, -0.37558118, 4.6311793, 10.488333)),
    mat4(vec4(-0.20850836, -0.39854836, -0.3709685, 0.3344729), vec4(-4.7711983, -0.6631636, -0.28696483, -0.2530558), vec4(-0.19809644, -0.8487018, -0.98007166, -0.63437307), vec4(-0.25123456, 0.096610285, -0.4769591, -1.1468279)),
    mat4(vec4(-0.60058844, -0.63592666, -0.6052252, 2.147502), vec4(-0.03999185, -1.2613406, 0.09392666, -0.0019396583), vec4(0.5476339, -0.51548564, 0.052660856, -0.6011902), vec4(-0.009928996, -0.3182906, -0.99936664, -0.2935119)),
    mat4(vec4(2.6636226, -0.8832171, 0.20496556, -0.04191312), vec4(-1.2509433, -0.55184084, -2.144729, 0.30126184), vec4(0.6532062, -1.1347219, 0.053510785, -0.91702574), vec4(-1.381274, -0.8147487, 0.33820778, -4.516578)),
    mat4(vec4(-2.3944836, -1.5599631, -1.5443133, 7.2195654), vec4(-3.189623, -1.1757643, -3.0395696, -3.0470943), vec4(-0.74049497, -1.7795825, -3.3150501, 1.0655732), vec4(0.23391353, -1.9687781, -5.3815885, 0.301576)),
    mat4(vec4(0.6127581, 0.7189719, 0.4580838, -1.6256864), vec4(-1.2738101, 0.50001895, 1.1716812, 1.8961793), vec4(1.3969544, -1.026486, 4.5668006, -0.4924125), vec4(-1.281743, 0.74455583, 1.8456057, 1.333482)),
    mat4(vec4(1.6401439, -0.123683035, -3.8032908, -3.1102664), vec4(0.2741913, -1.0241107, 1.404279, 1.5889775), vec4(0.1882553, -2.4512374, -1.2712853, -2.092814), vec4(-0.6549388, 0.5310589, -3.4538968, -0.24010293)),
    mat4(vec4(-1.179344, 2.261319, 0.08677091, 2.3124037), vec4(2.2208896, -1.7276238, 3.0533953, 0.21290262), vec4(-0.22286461, 0.37983313, -0.8543179, -0.26173314), vec4(1.4492773, -0.83511055, -9.288777, -0.39975622)),
    mat4(vec4(-0.35471365, -1.4553583, -2.13006, -0.4722494), vec4(0.22448993, 1.6314536, -1.176599, -1.0119965), vec4(0.29016638, 2.3146746, 1.6903033, 2.050139), vec4(-47.534008, 13.450688, 45.055683, 36.8565)),
    mat4(vec4(-0.22244097, 0.73429656, 0.9862094, -0.12936336), vec4(-0.1992381, 1.0202835, -8.927242, -0.1334078), vec4(1.5236185, 1.6330041, -2.4532542, -4.456027), vec4(1.0353031, -0.54515195, -0.85325897, -0.043900564)),
    mat4(vec4(0.0486813, -0.781592, 0.8640903, 0.4591338), vec4(0.43045935, 0.5000094, -4.739644, -1.660293), vec4(-0.16277091, -0.22619689, 4.470063, -0.448047), vec4(0.44084775, 1.7280015, -0.500346, -1.6410081)),
    mat4(vec4(0.16035058, 0.75065976, 4.032844, 0.45246646), vec4(-0.89536476, -1.2162967, -4.4385104, 0.46120143), vec4(-0.80455375, -2.5115435, -0.41027853, -0.2586623), vec4(0.029636882, 0.63010544, 2.973935, -0.05043506)),
    mat4(vec4(-1.7194197, 4.824015, -0.5266476, -0.78833747), vec4(-1.471812, 9.310035, -0.36150956, 4.5210505), vec4(-7.3974433, -0.44423026, -0.52594626, -0.46529654), vec4(-2.518356, 0.05439636, 0.1194184, -5.167155)),
    mat4(vec4(1.1304877, -0.43544415, 0.05339168, -1.1652164), vec4(-0.10885799, 0.41674054, -0.0952923, -1.2645881), vec4(-1.6490318, -0.18742283, -0.38375202, -0.97365975), vec4(-2.0202, -0.071377896, 0.07519452, 3.0742452)),
    mat4(vec4(1.6776807, -0.008116794, 0.024402482, 0.03255095), vec4(-0.54861903, -0.18131344, -0.4416248, 0.8281913), vec4(0.8584243, -0.8858986, -0.3033022, -1.0664535), vec4(1.1155258, 0.7076073, -0.24093512, -1.1810366)),
    mat4(vec4(0.38029328, -0.2386654, -0.35356867, 3.3918595), vec4(-0.21296081, -0.23470572, 0.042254288, 0.13682778), vec4(0.66403234, -0.28447255, -0.1571084, -1.7468112), vec4(2.418734, 0.1238797, -0.3289564, -5.60176)),
    mat4(vec4(-0.07753089, -0.48136306, -0.1604197, -1.1021476), vec4(-0.26256388, -0.32693323, -0.31468716, 0.55450964), vec4(-41.1247, -0.032185316, -0.075553805, 0.5439732), vec4(-18.707817, 48.940483, 0.22923301, 58.23926)),
    mat4(vec4(-0.9359581, 0.0538587, 0.108696185, 0.19324653), vec4(-4.07145, -0.09797463, -0.011038951, -14.01719), vec4(0.7007382, -0.5162815, -0.56258255, -0.66931564), vec4(-0.37976232, -0.32823804, -0.4771057, -0.29178965)),
    mat4(vec4(-1.1176615, 0.26750723, 0.04743282, 3.1740904), vec4(-6.9861116, 0.13787462, -0.30856836, -1.2273467), vec4(-0.8925413, -0.25709334, -0.29693884, 2.0135877), vec4(0.005031425, 0.06407095, -0.38787746, -0.32969463)),
    mat4(vec4(-0.16123626, -0.12301454, -0.4572737, 2.7402086), vec4(1.9703797, 0.14687034, -0.21890731, -0.97876066), vec4(0.6571604, 1.3451152, -0.12175569, 1.41641), vec4(0.04929141, -0.58692384, -0.52177536, -0.42594108))
);
const vec4 NMT_B2[4] = vec4[4](
    vec4(3.510157, 1.7952743, 1.1987314, 0.26025793),
    vec4(2.3944774, -0.85182935, -3.3829448, 2.091531),
    vec4(-1.6684406, 3.4333026, -2.3400319, -2.8371181),
    vec4(-3.3407154, -10.006952, -0.18896143, -0.0427072)
);
const vec4 NMT_W3[4] = vec4[4](
    vec4(-0.1269171, 0.11457737, -0.18309915, 0.13220085),
    vec4(-0.16864425, 0.3531046, -0.14550374, 0.10706206),
    vec4(0.14921415, 0.07990781, 0.1836161, 0.15159988),
    vec4(0.14897928, -0.7261686, 0.38606063, -0.14916353)
);
const float NMT_B3 = -2.3116946;

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

#endif

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

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

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
vec4 nmt_core_moments(uvec2 steps) {
    float z = nmt_core_depth(steps);
    float first = nmt_core_absorbance(steps) * z;
    float second = first * z;
    float third = second * z;
    return vec4(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
uint nmt_core_nearest_code(uvec2 steps) {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_farthest_code(uvec2 steps) {
    return (steps.x << NMT_END_BITS) | steps.y;
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_heavy_code(uvec2 steps, NmtCodes codes) {
    uint nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

uvec2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uvec2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Pass 1 of the core, in the fragment stage, without an interlock. Every fragment walks down the slots of its pixel:
// each slot keeps the greater of two codes in one atomic step and hands the lesser on to the next, so that the slots
// end with the same codes whatever order fragments come in.
//
// Clear the buffer to 0 before the pass. Atomics write even where a depth test that runs after the shader fails:
// declare `layout(early_fragment_tests) in;`.

layout(std430, binding = 0) coherent buffer NmtCore { uint nmt_core[]; };

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
uint nmt_core_offer(uint slot, uint code) {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (nmt_core[slot] >= code) {
        return code;
    }
    uint old = atomicMax(nmt_core[slot], code);
    return min(old, code);
}

// Offers a fragment, by its steps, to the core of a pixel.
void nmt_core_insert(uint pixel, uvec2 steps, NmtCodes codes) {
    if (steps.y == 0u) {
        return;
    }
    uint first = pixel * NMT_SLOTS;
    uint second = nmt_core_offer(first, nmt_core_nearest_code(steps));
    if (second == 0u) {
        return;
    }
    uint third = nmt_core_offer(first + 1u, nmt_core_farthest_code(nmt_core_nearest_steps(second)));
    if (third == 0u) {
        return;
    }
    uint code = nmt_core_heavy_code(nmt_core_farthest_steps(third), codes);
    // What is lighter than the last of the heavy is lighter than all of them.
    if (NMT_HEAVY == 0u || nmt_core[first + 1u + NMT_HEAVY] >= code) {
        return;
    }
    for (uint slot = first + 2u; slot < first + 2u + NMT_HEAVY; slot++) {
        code = nmt_core_offer(slot, code);
        if (code == 0u) {
            return;
        }
    }
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

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
vec4 nmt_resolve(vec4 weighted, vec4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return vec4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

#endif
