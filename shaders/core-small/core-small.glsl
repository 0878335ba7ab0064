// Neural moment transparency: network 'core-small', 9-14-8-1, 246 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
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
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset 9636ee68609509b56e59e891665a02e7488e2241af88306025242c084edbf4a2.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
mat3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, vec4 tail) {
    return mat3x4(vec4(x, count, ln_b0, lower), vec4(upper, tail.xyz), vec4(tail.w, 0.0, 0.0, 0.0));
}

const mat4 NMT_W1[12] = mat4[12](
    mat4(vec4(1.9524608, 1.0713975, 1.4039351, -1.5217286), vec4(-0.022230538, 0.026557269, 0.06309734, -0.17475322), vec4(0.047427006, -0.00469664, 0.025943926, 0.26743507), vec4(-2.610338, 1.7166722, 8.023302, 0.13859871)),
    mat4(vec4(-0.31684518, 3.2051063, 1.401991, -2.1894662), vec4(0.04005704, 0.32028624, -0.39842847, -0.66725725), vec4(0.16254476, -0.4127584, 1.1801735, 1.8491927), vec4(-0.22754906, 0.7579889, 0.09157842, -0.87315947)),
    mat4(vec4(-0.2689073, 0.21747705, -0.13199797, -0.12784465), vec4(2.1772313, 1.1888932, 1.1551433, -0.87760884), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.81854665, 1.409713, -0.41876668, -1.3666365), vec4(0.034107465, -0.03685927, -0.1553165, 0.12620565), vec4(0.03321912, 0.0033020813, 0.06593848, -0.007674537), vec4(3.6540296, -2.2724702, 2.8454916, 1.4697961)),
    mat4(vec4(-2.299097, -2.199256, -5.2893305, 1.9870816), vec4(2.4571347, -0.83326393, -1.4877391, -0.93114316), vec4(-2.7327578, 0.12991856, 0.48797175, 0.47749), vec4(-2.8144898, -1.2780569, 2.2409158, 1.4453955)),
    mat4(vec4(0.78125113, 2.5927734, 1.0933044, -0.5034421), vec4(-0.24653246, 1.0398772, 0.8146086, 0.2817792), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-1.9260247, 0.85952455, 0.45401737, 1.2723763), vec4(-0.04285044, 0.31560546, 0.017856365, -0.028521825), vec4(-0.052516434, -0.27625632, 0.0510878, -0.0137894405), vec4(1.6011887, 0.12541816, -0.17053595, -0.46624243)),
    mat4(vec4(-4.574354, 2.887386, 0.074741684, -7.2879086), vec4(-0.31982198, 1.5869461, 1.8657863, -3.0015862), vec4(-0.33059454, -1.782947, 0.9666899, 0.33783144), vec4(0.26441604, -0.5676601, -2.3556285, 2.1970835)),
    mat4(vec4(1.211836, 0.73746043, 2.4677353, 2.5184371), vec4(-1.1619287, 0.8677148, -1.4660302, 0.62358993), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.16088599, -1.5223581, 0.0, 0.0), vec4(-0.0041487496, 0.19258048, 0.0, 0.0), vec4(0.056485593, -0.04926818, 0.0, 0.0), vec4(11.940453, -12.363574, 0.0, 0.0)),
    mat4(vec4(0.1872992, 2.1171644, 0.0, 0.0), vec4(-2.1300912, 2.1395888, 0.0, 0.0), vec4(0.33336386, -0.8256183, 0.0, 0.0), vec4(2.8348258, -2.3406053, 0.0, 0.0)),
    mat4(vec4(1.5841515, -6.709348, 0.0, 0.0), vec4(-1.2724476, -0.22252339, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, 0.0))
);
const mat4 NMT_W2[8] = mat4[8](
    mat4(vec4(1.2749535, -1.2206278, 0.028193194, 0.8423979), vec4(-1.2200161, 1.2229213, 0.3101811, 0.31512943), vec4(-0.15609749, 1.2058281, -0.41686842, -0.1321389), vec4(0.5738092, 0.32298833, -0.25300327, 0.70333153)),
    mat4(vec4(-0.9644515, -1.4976041, -0.8924194, 1.031193), vec4(0.09596964, -1.3812109, -0.99426335, -0.7698786), vec4(-0.27224338, 0.49484494, -0.30159897, 1.3121598), vec4(0.40367886, -0.07355354, 0.9684212, 0.15634966)),
    mat4(vec4(0.31352583, -0.07697483, -0.27615148, 2.0191827), vec4(-0.07209049, 0.2702196, -2.1244931, 0.27906394), vec4(-0.23925827, -0.9513572, 2.03597, 0.32911965), vec4(-2.638307, 1.872359, 1.6225691, -1.4433334)),
    mat4(vec4(0.02017221, -1.6147795, 0.14303435, 0.83729297), vec4(-0.6862176, -0.44755808, -4.0235376, -0.01778543), vec4(1.0969412, 0.02962239, 1.0639843, 0.49953485), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(-0.6739009, 1.4489998, -6.061824, 1.7098606), vec4(1.4577574, -1.8589485, -0.38928428, 0.10030627), vec4(0.01998619, 0.48650917, -1.7238876, -2.6405706), vec4(-1.2022905, -0.27215597, 1.5082463, -0.13863346)),
    mat4(vec4(-0.6243122, 1.7342827, 0.32260272, 1.9255228), vec4(0.56403655, 1.1141405, -0.71229786, 0.5767114), vec4(0.95821536, -0.49319956, -0.39364746, 0.9515521), vec4(-0.4755803, -1.4792235, 1.0261518, -0.9079893)),
    mat4(vec4(0.15076402, 1.4911646, 0.30963883, -0.9034152), vec4(-0.1908811, -0.0032071099, 0.75148535, -0.147816), vec4(0.76777065, -1.6563613, 0.27035776, -1.2608712), vec4(-2.4480877, -1.9728118, 0.1101791, -1.0284874)),
    mat4(vec4(1.7924052, 0.9207351, -0.14314386, 1.8696913), vec4(0.77036667, 1.9583427, 0.1715907, 2.3901844), vec4(-1.3831987, 0.44357684, -0.54849935, 0.33465484), vec4(0.0, 0.0, 0.0, 0.0))
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.62214833, 0.39003918, 0.40604776, -0.75780785),
    vec4(0.4352812, 0.8156252, -1.98668, -0.6356217)
);
const float NMT_B3 = -0.8207263;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat3x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = f[1];
    vec4 h0_2 = vec4(f[2].x, 1.0, 0.0, 0.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4(0.0)) + vec4(0.0, 0.0, 1.0, 0.0);
    vec4 h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4(0.0));
    vec4 h2_1 = max(NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(mat3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0)) - 0.05, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif
