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
// HLSL, shader model 5 and later.
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
// Provenance: nmt 0.1.0, commit b1d5f0d9a708, backend fused, seed 1, epochs 6000, dataset e4b670063e777080a8d4e335c8112fc6ed2f2f51991ae458c750de88c0ee67d6.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.076e-3, worst 1.000.

#ifndef NMT_INCLUDED_CORE
#define NMT_INCLUDED_CORE

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
float3x4 nmt_features(float x, float count, float ln_b0, float lower, float upper, float4 tail) {
    return float3x4(float4(x, count, ln_b0, lower), float4(upper, tail.xyz), float4(tail.w, 0.0, 0.0, 0.0));
}

static const float4x4 NMT_W1[24] = {
    float4x4(float4(5.105601f, -7.776949f, -6.0050955f, 4.35002f), float4(0.023220908f, 0.30917516f, -0.13695663f, -0.14382242f), float4(0.21147795f, 0.35639855f, -0.062964685f, 0.002809352f), float4(-2.5967512f, 22.351898f, -23.143448f, -205.42451f)),
    float4x4(float4(-0.31193998f, 6.7898197f, -54.12732f, -47.573433f), float4(-0.60654885f, 5.9676127f, 3.0856981f, -10.418275f), float4(-4.4941916f, -2.0020182f, -15.190292f, 2.0452278f), float4(-0.8066691f, -2.97389f, 0.98539966f, 7.3517427f)),
    float4x4(float4(15.56608f, -5.7345085f, -0.4197574f, 13.895891f), float4(-1.8566706f, -6.4097342f, 1.708392f, 0.94489276f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(2.8988519f, 2.1483068f, -6.141246f, 3.832572f), float4(-0.043049954f, 0.0013504993f, 0.5068191f, 0.10825731f), float4(0.120203584f, -0.019085664f, 0.11918055f, 0.37410185f), float4(-275.1931f, -0.6838616f, -0.87953967f, -270.13834f)),
    float4x4(float4(-11.156709f, 6.9914265f, -1.1131457f, -1.2721392f), float4(-8.456398f, 1.8514961f, -3.006853f, 2.3839877f), float4(4.4430394f, 2.910352f, -1.3252851f, 4.6527796f), float4(4.8252115f, 1.7819123f, 0.96366787f, -8.276807f)),
    float4x4(float4(7.911175f, 0.25640938f, 0.5788228f, -0.6366296f), float4(0.69316465f, -1.0827959f, -4.561138f, 0.3928774f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(1.8522606f, 6.257332f, -3.080659f, -2.634544f), float4(0.5086991f, 0.21848376f, -0.23465014f, -0.104933806f), float4(0.09076835f, -0.23718849f, -0.3026637f, -0.080448024f), float4(-14.326484f, -1.8913914f, -1.2898521f, 16.793245f)),
    float4x4(float4(0.15697204f, 1.8957422f, -3.1672099f, 12.570847f), float4(0.068353504f, -11.033392f, -9.184098f, 3.1564772f), float4(8.724328f, 1.0235292f, -23.29579f, 0.39650568f), float4(-1.2083226f, 5.060427f, 10.9705925f, 0.56463635f)),
    float4x4(float4(-5.697375f, -0.1546829f, 0.06553507f, 1.9628643f), float4(-0.33343205f, 3.551f, 3.5038662f, -2.689176f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.5225184f, 0.5133232f, -13.984075f, -2.4731104f), float4(0.0394662f, -0.012775333f, 0.14760341f, -2.6331127f), float4(-1.2133482f, 0.26808673f, -0.025899684f, 1.1622663f), float4(1.7089345f, 7.072623f, -2.3439279f, -2.0342574f)),
    float4x4(float4(0.41221315f, -6.7205515f, 1.1159382f, -4.7000427f), float4(3.415568f, -12.434128f, 0.1943438f, -1.0476273f), float4(-4.455235f, -2.4347835f, -0.83084714f, -2.2484365f), float4(-0.58668476f, 13.411483f, 0.38693205f, 1.18982f)),
    float4x4(float4(-0.039616797f, -11.22243f, 0.83889264f, 1.2326022f), float4(3.3515599f, 1.0467722f, -13.557409f, -0.093907766f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-13.982129f, 2.3758018f, -3.3194711f, 1.1728226f), float4(0.110941164f, -0.2638195f, -0.025995683f, -0.030497411f), float4(-0.037691645f, 0.053093266f, -0.0530958f, -0.21025592f), float4(-6.103725f, 9.406993f, -0.5770045f, -185.77985f)),
    float4x4(float4(-0.666941f, -3.3638792f, -0.27342474f, -25.038755f), float4(-0.51459336f, 3.0862372f, -0.06407232f, -3.1050527f), float4(1.7560154f, -8.128283f, -0.243695f, 3.2070622f), float4(0.38069966f, -4.452379f, -0.041192476f, 0.42360008f)),
    float4x4(float4(-1.9304729f, -3.7500045f, -0.23138194f, 0.56804115f), float4(-13.277853f, 4.758931f, -3.584098f, 4.9006147f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.1450951f, 4.120741f, -13.907398f, -8.625761f), float4(-0.387003f, -0.36109456f, 0.0064239977f, 0.009801125f), float4(0.25361887f, 0.053927135f, -0.0021939417f, -0.15860346f), float4(-21.365168f, -172.61107f, 0.17477922f, -51.368767f)),
    float4x4(float4(-8.635486f, -29.214334f, 0.021726517f, -8.044878f), float4(-11.482672f, -3.2639728f, -0.013819815f, -3.2251644f), float4(-9.422208f, 0.022588652f, 0.021991013f, 2.2397661f), float4(13.14991f, -2.1781762f, 0.0077962712f, 2.25823f)),
    float4x4(float4(11.179421f, 12.596346f, 0.026374217f, 6.4431143f), float4(-2.3435538f, 2.4249837f, -13.852932f, -9.073568f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-4.829132f, -7.8334613f, -4.5468693f, -2.1926074f), float4(-0.31630903f, -0.29768285f, 0.0039741467f, -0.10085432f), float4(0.32456073f, 0.0021103336f, 0.36441302f, -0.04167412f), float4(7.2600203f, 39.73682f, -13.001361f, -68.57387f)),
    float4x4(float4(-3.5925124f, -40.307766f, 2.5083969f, -56.382004f), float4(7.147693f, -2.452206f, -8.350125f, 7.6832743f), float4(-8.0426445f, 11.154003f, -7.982382f, -6.9970746f), float4(-4.2268105f, 0.3991062f, 16.75555f, -10.219937f)),
    float4x4(float4(-0.88635343f, -0.75385606f, 3.154558f, 1.6476432f), float4(0.35605f, -8.718019f, -5.2014933f, -1.9921725f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.9229885f, -4.844933f, 1.1987408f, 3.0472248f), float4(0.093173504f, 0.35200232f, 0.040751476f, -0.029037263f), float4(-0.06796274f, -0.44380617f, 0.75943786f, 0.044587515f), float4(-0.43263108f, 21.904581f, -0.8844772f, 2.7531273f)),
    float4x4(float4(-1.2013022f, -108.8591f, 2.3038723f, 5.3356767f), float4(-4.8903656f, 2.7748172f, 1.6174321f, 0.32124317f), float4(-4.625781f, -29.927137f, 1.7514372f, 1.2718332f), float4(6.909279f, 2.365779f, -0.34391f, 4.7517195f)),
    float4x4(float4(1.5040059f, 3.7027698f, 2.6831563f, 4.5805984f), float4(1.7121153f, 3.79226f, -0.71379894f, -4.2009153f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(1.4117749f, 1.1455115f, -1.0086119f, 0.0004797554f), float4(-0.17528519f, 0.11391741f, -0.29034904f, 0.7241151f), float4(-2.1908772f, -0.391476f, -0.08961872f, 0.9594575f), float4(-0.14267835f, 0.15408039f, -2.051766f, 0.055051133f)),
    float4x4(float4(0.9596603f, -0.48269808f, -0.42018393f, -0.1803454f), float4(-1.2544678f, 1.0647244f, 0.02147165f, -0.7638201f), float4(0.47986585f, -0.84491074f, 1.7447041f, 1.3960198f), float4(-0.19821063f, -0.79286224f, 0.85816985f, -0.26733887f)),
    float4x4(float4(0.94047356f, 0.95441526f, -0.9931214f, 0.52400935f), float4(0.53910285f, -0.11692361f, -1.0469438f, -0.15025753f), float4(0.23474608f, 0.2108287f, 0.63860965f, 0.1842764f), float4(-0.19755994f, -0.02986438f, 0.6369611f, -0.2505009f)),
    float4x4(float4(0.19427648f, -0.79274374f, 0.47619057f, 1.3965701f), float4(-5.2104583f, -4.6881537f, -1.2886525f, 0.596525f), float4(2.9574912f, -2.2038035f, 1.0524839f, 5.7795506f), float4(0.69122237f, 0.32629198f, 1.0412474f, 0.4487828f)),
    float4x4(float4(1.3182099f, 0.43033296f, 0.04891999f, -0.18893845f), float4(0.105346136f, -0.47653708f, 0.6135861f, 0.21682577f), float4(17.60009f, -23.61967f, -1.7953713f, 16.923414f), float4(-0.011252998f, -0.1360435f, -0.7944033f, -0.2513587f)),
    float4x4(float4(-1.2667481f, -3.0897038f, -4.122969f, 0.31176418f), float4(-1.3825121f, 0.23001349f, -1.3250293f, 0.38488436f), float4(-135.79802f, -133.9177f, -22.080603f, 71.74813f), float4(0.23596533f, -1.0659001f, 2.6728966f, -0.4659539f)),
    float4x4(float4(-0.88412523f, -0.0022808446f, 1.3066578f, 2.3039625f), float4(-1.0502533f, -3.6898844f, 0.19183235f, 0.41163737f), float4(1.3648864f, 2.927925f, 1.3360986f, 0.0046246676f), float4(0.664076f, -11.838231f, -7.549727f, -1.0275925f)),
    float4x4(float4(-0.87744904f, 1.0097657f, -1.7211068f, -0.04698234f), float4(2.380362f, -0.70639944f, -0.8697528f, -1.578907f), float4(0.22534208f, -1.1221607f, 0.63426286f, 1.8184385f), float4(-2.2981977f, -1.9128195f, 1.0795509f, 0.12111062f)),
    float4x4(float4(-1.8443363f, 0.56556493f, 0.09560901f, -1.3190942f), float4(1.0664049f, 0.3087944f, -0.23027885f, 0.4483379f), float4(-3.224628f, -0.84289473f, -0.57763636f, 0.7255968f), float4(-2.5056968f, -0.08255808f, -0.47086683f, -2.7120073f)),
    float4x4(float4(1.3064679f, -0.017068246f, -0.62331957f, -1.9613546f), float4(-5.493033f, -0.8580647f, -0.39121553f, -0.74754095f), float4(0.8735196f, -0.21701387f, -0.2966358f, 0.85576195f), float4(-2.0695543f, -1.300886f, -0.7988393f, -2.4490328f)),
    float4x4(float4(0.6565235f, 0.3903638f, -0.28224826f, -2.082288f), float4(2.006443f, 2.4669216f, -0.14219742f, -0.060256653f), float4(0.67531955f, 0.13639764f, -0.03523145f, -1.755812f), float4(-0.865527f, 0.6221016f, -0.6368253f, -1.5856439f)),
    float4x4(float4(0.4891402f, 0.2581284f, -0.08101575f, -0.24707842f), float4(-0.16358995f, 0.5099237f, -0.105441764f, -3.0301104f), float4(0.62760687f, 1.4812951f, -0.6093596f, 5.783497f), float4(1.8950132f, -0.07125754f, -0.6786951f, 0.14868382f)),
    float4x4(float4(0.7869905f, -5.3466587f, 0.1741541f, 2.0395641f), float4(1.3420644f, -0.28202555f, -0.47155303f, 1.0279235f), float4(-9.01687f, -13.114879f, 0.33679408f, 29.04798f), float4(0.9333192f, -0.21021648f, 0.23570606f, -2.5541313f)),
    float4x4(float4(0.6453444f, 0.9763128f, -0.3718651f, 0.39026862f), float4(0.17396936f, 0.5483875f, -0.45548332f, 4.2985826f), float4(-1.0830393f, 4.6675353f, -0.333695f, 71.7838f), float4(-1.4337493f, -0.53264886f, -0.19717096f, 0.6267395f)),
    float4x4(float4(-1.4478867f, -0.5249548f, -0.4335779f, 1.6650672f), float4(-2.5251105f, -0.8519394f, -0.04889558f, 2.3745184f), float4(-0.4131709f, -0.78096247f, -0.265346f, -2.8289497f), float4(-0.8659692f, 0.67117697f, -0.40825266f, -7.0920377f)),
    float4x4(float4(-2.5151942f, 0.34818825f, -0.7929048f, -1.0159082f), float4(4.2902603f, -2.4972966f, 0.12204305f, 3.0165975f), float4(1.1052955f, 0.9943748f, -0.4099802f, -1.3225311f), float4(5.2346444f, -1.6471541f, -0.15307099f, 2.7453272f)),
    float4x4(float4(0.07138306f, 2.076648f, -1.8942585f, -3.3003516f), float4(-0.2882856f, 0.5259255f, -1.1715925f, 0.6548139f), float4(-0.55099267f, -2.045182f, 0.16101238f, -19.281754f), float4(0.1813682f, -1.2356466f, 6.7513304f, -2.068983f)),
    float4x4(float4(-0.28732413f, 2.1736734f, -2.2015593f, 0.70505905f), float4(-0.61555994f, -0.97298265f, -0.8315434f, -4.331392f), float4(-0.7491897f, -1.3155322f, 0.7434592f, 0.24302031f), float4(-0.92366385f, 0.5785332f, -1.1841005f, -2.1942017f)),
    float4x4(float4(-0.025959171f, 1.0332141f, -0.3057038f, 0.14345387f), float4(0.1820034f, 0.6463979f, -0.4230483f, 0.88760984f), float4(-0.506119f, -2.2852664f, 0.7100101f, -0.04251004f), float4(-1.605868f, -0.76535636f, 0.47167516f, -0.5869909f)),
    float4x4(float4(-0.27339047f, -0.19307494f, -0.079702504f, 0.6384779f), float4(0.2063675f, -4.1424527f, -4.7255635f, -3.6037133f), float4(-0.7378594f, -0.42104614f, 2.5694761f, 2.440463f), float4(-0.1201131f, 0.6122979f, 0.9770483f, -1.823438f)),
    float4x4(float4(-0.64848614f, -7.342971f, -0.12128481f, 1.2423502f), float4(-0.1644702f, 2.21513f, -0.6999483f, -0.13381991f), float4(0.055238426f, -14.326893f, 2.2322915f, 1.5615437f), float4(-0.15758026f, 0.6125606f, 0.48911768f, -0.33160573f)),
    float4x4(float4(-0.18421619f, -2.0189714f, -1.7023716f, 0.43409413f), float4(0.23080006f, -0.8519016f, -3.5074615f, 1.3633063f), float4(0.04658364f, -78.44668f, 0.79340786f, 32.057377f), float4(-0.34704253f, 0.33576915f, -0.9627348f, 0.5085888f)),
    float4x4(float4(-0.45095307f, -0.47410285f, 0.24623942f, -0.8926218f), float4(-0.09543575f, -1.6511658f, -2.8479211f, -25.014994f), float4(-0.23262836f, 3.4916303f, -1.1458504f, -2.7429433f), float4(-0.32691115f, -0.44231844f, -8.368213f, -4.1542387f)),
    float4x4(float4(-0.4557896f, -1.934449f, 1.0928212f, -0.232232f), float4(-0.38127586f, 2.3346226f, 0.41953424f, -9.160213f), float4(-0.42633402f, -1.3171939f, 0.78922266f, 1.3385485f), float4(0.10132453f, -1.1957477f, -3.0540102f, -7.5172434f)),
    float4x4(float4(-0.6846841f, -0.39949378f, -0.43331692f, -1.1108447f), float4(0.086074844f, -0.12320614f, -0.18615182f, 0.19640923f), float4(-0.35280946f, 0.02964202f, -0.028854044f, -0.30641377f), float4(-0.47222504f, -0.11014126f, -0.004455302f, -1.7318124f)),
    float4x4(float4(0.3095977f, -0.26672626f, -0.26871482f, -0.5386906f), float4(-0.1904637f, -0.22352202f, -0.3699714f, 0.2667565f), float4(-0.023135059f, -0.26332396f, -0.45012188f, 0.1675753f), float4(-0.61727947f, -0.032617245f, -0.4171554f, 0.19419159f)),
    float4x4(float4(-1.0615184f, -0.1701745f, -0.035369314f, -1.5066206f), float4(-0.7746694f, -0.45181212f, -0.24145463f, 0.4399054f), float4(-0.44384918f, -0.19252208f, -0.25796694f, 0.12573382f), float4(-1.3391436f, -0.42201588f, -0.5491518f, -1.0046335f)),
    float4x4(float4(-0.0066728536f, -0.4799766f, -0.26922658f, 0.12601812f), float4(-1.2285767f, -0.109489426f, -1.134757f, -0.48262617f), float4(-0.024299905f, -0.09656521f, -0.59825903f, -0.6290528f), float4(-0.31450796f, -0.23098287f, -0.21771114f, 0.98455596f)),
    float4x4(float4(0.08517324f, -0.08440631f, -0.035429735f, 0.88830054f), float4(-1.3710811f, -0.62781394f, -1.6546706f, -0.10364189f), float4(-0.5688971f, -0.33749542f, 0.20412302f, 16.703667f), float4(-0.4831616f, -0.19607466f, -0.38795856f, 1.1162999f)),
    float4x4(float4(-0.41509444f, -0.110484555f, -0.2607657f, -2.3323455f), float4(-0.16110119f, -0.042242657f, 0.237565f, -0.47444546f), float4(-0.25614524f, 0.09534541f, 0.22616278f, 46.38153f), float4(0.025013793f, -0.34746808f, 0.17879407f, 2.955301f)),
    float4x4(float4(-0.2926618f, -0.47597834f, -0.1421112f, -0.5474815f), float4(-0.31367156f, -0.27706975f, 0.0012671659f, -0.5512675f), float4(-0.1773227f, -0.33372575f, -0.2741667f, 0.59745055f), float4(-0.1527745f, -0.08500009f, 0.14344408f, -4.103511f)),
    float4x4(float4(-0.38976654f, -0.50683564f, -0.67122334f, -0.84118474f), float4(-0.47082475f, 0.011163686f, -0.76321733f, 0.28329408f), float4(-0.7255998f, -0.10084268f, -0.42822677f, 0.8368735f), float4(-0.45611984f, -0.24425219f, -0.2817987f, -0.32840288f))
};
static const float4 NMT_B2[4] = {
    float4(0.871116f, 1.8918169f, -0.7374457f, -5.431118f),
    float4(-5.1308475f, -1.3067405f, -0.52322567f, 5.599536f),
    float4(-0.71397114f, 0.6413444f, -0.2442821f, -2.0892909f),
    float4(-0.1836862f, -0.39407033f, -0.15463342f, 5.6735487f)
};
static const float4 NMT_W3[4] = {
    float4(-0.1441644f, 0.10191933f, 0.16379957f, -0.17671104f),
    float4(0.09976095f, 0.10984438f, -0.03324448f, -0.14598179f),
    float4(-0.058332108f, 0.10727377f, 0.10310578f, 0.18810688f),
    float4(-0.56664026f, -0.00066999835f, 0.25467998f, -0.22518922f)
};
static const float NMT_B3 = -2.3455548f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float3x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = f[1];
    float4 h0_2 = float4(f[2].x, 1.0f, 0.0f, 0.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]) + mul(h0_2, NMT_W1[2]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[3]) + mul(h0_1, NMT_W1[4]) + mul(h0_2, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]) + mul(h0_2, NMT_W1[8]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[9]) + mul(h0_1, NMT_W1[10]) + mul(h0_2, NMT_W1[11]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_4 = max(mul(h0_0, NMT_W1[12]) + mul(h0_1, NMT_W1[13]) + mul(h0_2, NMT_W1[14]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_5 = max(mul(h0_0, NMT_W1[15]) + mul(h0_1, NMT_W1[16]) + mul(h0_2, NMT_W1[17]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_6 = max(mul(h0_0, NMT_W1[18]) + mul(h0_1, NMT_W1[19]) + mul(h0_2, NMT_W1[20]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_7 = max(mul(h0_0, NMT_W1[21]) + mul(h0_1, NMT_W1[22]) + mul(h0_2, NMT_W1[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_0 = max(NMT_B2[0] + mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]) + mul(h1_4, NMT_W2[4]) + mul(h1_5, NMT_W2[5]) + mul(h1_6, NMT_W2[6]) + mul(h1_7, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(NMT_B2[1] + mul(h1_0, NMT_W2[8]) + mul(h1_1, NMT_W2[9]) + mul(h1_2, NMT_W2[10]) + mul(h1_3, NMT_W2[11]) + mul(h1_4, NMT_W2[12]) + mul(h1_5, NMT_W2[13]) + mul(h1_6, NMT_W2[14]) + mul(h1_7, NMT_W2[15]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_2 = max(NMT_B2[2] + mul(h1_0, NMT_W2[16]) + mul(h1_1, NMT_W2[17]) + mul(h1_2, NMT_W2[18]) + mul(h1_3, NMT_W2[19]) + mul(h1_4, NMT_W2[20]) + mul(h1_5, NMT_W2[21]) + mul(h1_6, NMT_W2[22]) + mul(h1_7, NMT_W2[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_3 = max(NMT_B2[3] + mul(h1_0, NMT_W2[24]) + mul(h1_1, NMT_W2[25]) + mul(h1_2, NMT_W2[26]) + mul(h1_3, NMT_W2[27]) + mul(h1_4, NMT_W2[28]) + mul(h1_5, NMT_W2[29]) + mul(h1_6, NMT_W2[30]) + mul(h1_7, NMT_W2[31]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

#endif

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
static const uint NMT_SLOTS = 6u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
static const float NMT_KEY_SCALE = 0.625;
// The last step of absorbance, that of A = 10.
static const uint NMT_LAST_ABSORBANCE = 27136u;
static const uint NMT_LAST_DEPTH = (1u << NMT_DEPTH_BITS) - 1u;
static const uint NMT_END_BITS = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
static const uint NMT_LINEAR_BITS = 0x3a800000u;
static const float NMT_LINEAR = 0.0009765625;

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
    int first = asint(v0);
    int last = asint(v1);
    int first_log2 = nmt_core_log2(first);
    uint range = uint(nmt_core_log2(last) - first_log2);
    // Its length in bits, from the exponent of a float that is not rounded up to the next power of two.
    uint exponent = asuint(float(range & ~(range >> 1))) >> 23;
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
uint2 nmt_core_steps(float v, float absorbance, NmtCodes codes) {
    int place = nmt_core_log2(clamp(asint(v), codes.first_bits, codes.last_bits));
    uint w = uint(place - codes.first_log2) >> codes.shift;
    uint a = asuint(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return uint2(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
float nmt_core_depth(uint2 steps) {
    return float(2u * steps.x + 1u) * (1.0 / float(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
float nmt_core_absorbance(uint2 steps) {
    return asfloat(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
float4 nmt_core_moments(uint2 steps) {
    float z = nmt_core_depth(steps);
    float first = nmt_core_absorbance(steps) * z;
    float second = first * z;
    float third = second * z;
    return float4(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
uint nmt_core_nearest_code(uint2 steps) {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

uint2 nmt_core_nearest_steps(uint code) {
    return uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_farthest_code(uint2 steps) {
    return (steps.x << NMT_END_BITS) | steps.y;
}

uint2 nmt_core_farthest_steps(uint code) {
    return uint2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint nmt_core_heavy_code(uint2 steps, NmtCodes codes) {
    uint nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

uint2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Pass 1 of the core, in the fragment stage, without an interlock. Every fragment walks down the slots of its pixel:
// each slot keeps the greater of two codes in one atomic step and hands the lesser on to the next, so that the slots
// end with the same codes whatever order fragments come in.
//
// Clear the buffer to 0 before the pass. Atomics write even where a depth test that runs after the shader fails:
// declare `[earlydepthstencil]`.

globallycoherent RWStructuredBuffer<uint> nmt_core : register(u0);

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
uint nmt_core_offer(uint slot, uint code) {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (nmt_core[slot] >= code) {
        return code;
    }
    uint old;
    InterlockedMax(nmt_core[slot], code, old);
    return min(old, code);
}

// Offers a fragment, by its steps, to the core of a pixel.
void nmt_core_insert(uint pixel, uint2 steps, NmtCodes codes) {
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

// Where the moments of the tail leave T open by no more than this, it is the middle of what they allow, and the network
// is not asked. 0 always asks it; 1/256 cannot be seen.
static const float NMT_OPEN = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments: Markov's bounds.
float2 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
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
    return float2(lower, lower + at);
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
float nmt_core_weigh(float z, float absorbance, float4 depths0, float4 absorbances0, float4 depths1, float4
    absorbances1, float n, float b0, float4 moments) {
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
    float2 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
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
    return exp(-front_6) * nmt_transmittance(float3x4(float4(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), bounds.x), float4(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
        * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0), mean_2), float4(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2,
        1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
float2 nmt_core_slot(uint code, uint2 steps) {
    return code > 0u ? float2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : float2(0.0, 0.0);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
float nmt_core_transmittance(
    uint2 steps,
    NmtCodes codes,
    uint4 core0,
    uint4 core1,
    float n,
    float b0,
    float4 moments
) {
    float2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    float2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    float2 slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    float2 slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    float2 slot4 = nmt_core_slot(core1.x, nmt_core_heavy_steps(core1.x, codes));
    float2 slot5 = nmt_core_slot(core1.y, nmt_core_heavy_steps(core1.y, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        float4(slot0.x, slot1.x, slot2.x, slot3.x),
        float4(slot0.y, slot1.y, slot2.y, slot3.y),
        float4(slot4.x, slot5.x, 0.0, 0.0),
        float4(slot4.y, slot5.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
float4 nmt_resolve(float4 weighted, float4 sums0) {
    float behind = exp(-sums0.x);
    float scale = (weighted.w > 0.0 ? (1.0 - behind) / max(weighted.w, 1e-37) : 0.0);
    return float4(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}

#endif
