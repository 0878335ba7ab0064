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

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 12>(
    mat4x4<f32>(vec4<f32>(1.9524608f, 1.0713975f, 1.4039351f, -1.5217286f), vec4<f32>(-0.022230538f, 0.026557269f, 0.06309734f, -0.17475322f), vec4<f32>(0.047427006f, -0.00469664f, 0.025943926f, 0.26743507f), vec4<f32>(-2.610338f, 1.7166722f, 8.023302f, 0.13859871f)),
    mat4x4<f32>(vec4<f32>(-0.31684518f, 3.2051063f, 1.401991f, -2.1894662f), vec4<f32>(0.04005704f, 0.32028624f, -0.39842847f, -0.66725725f), vec4<f32>(0.16254476f, -0.4127584f, 1.1801735f, 1.8491927f), vec4<f32>(-0.22754906f, 0.7579889f, 0.09157842f, -0.87315947f)),
    mat4x4<f32>(vec4<f32>(-0.2689073f, 0.21747705f, -0.13199797f, -0.12784465f), vec4<f32>(2.1772313f, 1.1888932f, 1.1551433f, -0.87760884f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.81854665f, 1.409713f, -0.41876668f, -1.3666365f), vec4<f32>(0.034107465f, -0.03685927f, -0.1553165f, 0.12620565f), vec4<f32>(0.03321912f, 0.0033020813f, 0.06593848f, -0.007674537f), vec4<f32>(3.6540296f, -2.2724702f, 2.8454916f, 1.4697961f)),
    mat4x4<f32>(vec4<f32>(-2.299097f, -2.199256f, -5.2893305f, 1.9870816f), vec4<f32>(2.4571347f, -0.83326393f, -1.4877391f, -0.93114316f), vec4<f32>(-2.7327578f, 0.12991856f, 0.48797175f, 0.47749f), vec4<f32>(-2.8144898f, -1.2780569f, 2.2409158f, 1.4453955f)),
    mat4x4<f32>(vec4<f32>(0.78125113f, 2.5927734f, 1.0933044f, -0.5034421f), vec4<f32>(-0.24653246f, 1.0398772f, 0.8146086f, 0.2817792f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.9260247f, 0.85952455f, 0.45401737f, 1.2723763f), vec4<f32>(-0.04285044f, 0.31560546f, 0.017856365f, -0.028521825f), vec4<f32>(-0.052516434f, -0.27625632f, 0.0510878f, -0.0137894405f), vec4<f32>(1.6011887f, 0.12541816f, -0.17053595f, -0.46624243f)),
    mat4x4<f32>(vec4<f32>(-4.574354f, 2.887386f, 0.074741684f, -7.2879086f), vec4<f32>(-0.31982198f, 1.5869461f, 1.8657863f, -3.0015862f), vec4<f32>(-0.33059454f, -1.782947f, 0.9666899f, 0.33783144f), vec4<f32>(0.26441604f, -0.5676601f, -2.3556285f, 2.1970835f)),
    mat4x4<f32>(vec4<f32>(1.211836f, 0.73746043f, 2.4677353f, 2.5184371f), vec4<f32>(-1.1619287f, 0.8677148f, -1.4660302f, 0.62358993f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.16088599f, -1.5223581f, 0.0f, 0.0f), vec4<f32>(-0.0041487496f, 0.19258048f, 0.0f, 0.0f), vec4<f32>(0.056485593f, -0.04926818f, 0.0f, 0.0f), vec4<f32>(11.940453f, -12.363574f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.1872992f, 2.1171644f, 0.0f, 0.0f), vec4<f32>(-2.1300912f, 2.1395888f, 0.0f, 0.0f), vec4<f32>(0.33336386f, -0.8256183f, 0.0f, 0.0f), vec4<f32>(2.8348258f, -2.3406053f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(1.5841515f, -6.709348f, 0.0f, 0.0f), vec4<f32>(-1.2724476f, -0.22252339f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 8>(
    mat4x4<f32>(vec4<f32>(1.2749535f, -1.2206278f, 0.028193194f, 0.8423979f), vec4<f32>(-1.2200161f, 1.2229213f, 0.3101811f, 0.31512943f), vec4<f32>(-0.15609749f, 1.2058281f, -0.41686842f, -0.1321389f), vec4<f32>(0.5738092f, 0.32298833f, -0.25300327f, 0.70333153f)),
    mat4x4<f32>(vec4<f32>(-0.9644515f, -1.4976041f, -0.8924194f, 1.031193f), vec4<f32>(0.09596964f, -1.3812109f, -0.99426335f, -0.7698786f), vec4<f32>(-0.27224338f, 0.49484494f, -0.30159897f, 1.3121598f), vec4<f32>(0.40367886f, -0.07355354f, 0.9684212f, 0.15634966f)),
    mat4x4<f32>(vec4<f32>(0.31352583f, -0.07697483f, -0.27615148f, 2.0191827f), vec4<f32>(-0.07209049f, 0.2702196f, -2.1244931f, 0.27906394f), vec4<f32>(-0.23925827f, -0.9513572f, 2.03597f, 0.32911965f), vec4<f32>(-2.638307f, 1.872359f, 1.6225691f, -1.4433334f)),
    mat4x4<f32>(vec4<f32>(0.02017221f, -1.6147795f, 0.14303435f, 0.83729297f), vec4<f32>(-0.6862176f, -0.44755808f, -4.0235376f, -0.01778543f), vec4<f32>(1.0969412f, 0.02962239f, 1.0639843f, 0.49953485f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.6739009f, 1.4489998f, -6.061824f, 1.7098606f), vec4<f32>(1.4577574f, -1.8589485f, -0.38928428f, 0.10030627f), vec4<f32>(0.01998619f, 0.48650917f, -1.7238876f, -2.6405706f), vec4<f32>(-1.2022905f, -0.27215597f, 1.5082463f, -0.13863346f)),
    mat4x4<f32>(vec4<f32>(-0.6243122f, 1.7342827f, 0.32260272f, 1.9255228f), vec4<f32>(0.56403655f, 1.1141405f, -0.71229786f, 0.5767114f), vec4<f32>(0.95821536f, -0.49319956f, -0.39364746f, 0.9515521f), vec4<f32>(-0.4755803f, -1.4792235f, 1.0261518f, -0.9079893f)),
    mat4x4<f32>(vec4<f32>(0.15076402f, 1.4911646f, 0.30963883f, -0.9034152f), vec4<f32>(-0.1908811f, -0.0032071099f, 0.75148535f, -0.147816f), vec4<f32>(0.76777065f, -1.6563613f, 0.27035776f, -1.2608712f), vec4<f32>(-2.4480877f, -1.9728118f, 0.1101791f, -1.0284874f)),
    mat4x4<f32>(vec4<f32>(1.7924052f, 0.9207351f, -0.14314386f, 1.8696913f), vec4<f32>(0.77036667f, 1.9583427f, 0.1715907f, 2.3901844f), vec4<f32>(-1.3831987f, 0.44357684f, -0.54849935f, 0.33465484f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.62214833f, 0.39003918f, 0.40604776f, -0.75780785f),
    vec4<f32>(0.4352812f, 0.8156252f, -1.98668f, -0.6356217f)
);
const NMT_B3: f32 = -0.8207263f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat3x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = f[1];
    let h0_2 = vec4<f32>(f[2].x, 1.0f, 0.0f, 0.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4<f32>(0.0f)) + vec4<f32>(0.0f, 0.0f, 1.0f, 0.0f);
    let h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4<f32>(0.0f));
    let h2_1 = max(NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat3x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}
