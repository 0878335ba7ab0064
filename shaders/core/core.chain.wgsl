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
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 6000, dataset bd56c8a2a9c6d4f460653e7f112f48bcc4cd217bead9bf4934f14f488f930250.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.061e-3, worst 1.000.

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 24>(
    mat4x4<f32>(vec4<f32>(5.4374213f, 4.099272f, -2.3999908f, 0.06732468f), vec4<f32>(-0.30876112f, 0.039813306f, -0.06825874f, 0.09791592f), vec4<f32>(0.11699771f, -0.0126477955f, 0.009044837f, 0.024920827f), vec4<f32>(-0.06984082f, -1.4153421f, 11.242752f, 27.765509f)),
    mat4x4<f32>(vec4<f32>(2.1031263f, -18.205357f, 11.592584f, -24.416697f), vec4<f32>(0.68829197f, -3.5122368f, 5.105146f, 3.1200283f), vec4<f32>(1.2533448f, 11.688712f, 1.1489722f, 1.8796386f), vec4<f32>(-0.7433028f, -1.2973337f, -3.0665278f, 1.5641073f)),
    mat4x4<f32>(vec4<f32>(-0.3011667f, -40.251568f, -5.629344f, -0.5443934f), vec4<f32>(3.0883026f, 6.4341197f, -0.02780485f, -3.0386043f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-6.0495343f, 1.8236239f, 3.2971628f, 6.976045f), vec4<f32>(0.14396286f, -0.10366543f, -0.19931847f, -0.073501945f), vec4<f32>(0.045301538f, 1.5944515f, 0.024680262f, 0.024978848f), vec4<f32>(-11.065943f, -0.46564764f, -302.25082f, 6.2804327f)),
    mat4x4<f32>(vec4<f32>(6.5376883f, 1.4367918f, 4.3187885f, -3.8740258f), vec4<f32>(10.118008f, -3.1108778f, 4.2425604f, -2.354306f), vec4<f32>(-8.242886f, 1.7415371f, 2.897262f, -0.57454836f), vec4<f32>(-8.166772f, 0.504575f, -6.560604f, 0.8390675f)),
    mat4x4<f32>(vec4<f32>(-11.040061f, 0.82958007f, -1.1059247f, 10.712579f), vec4<f32>(-0.35051835f, -4.799316f, 1.6909233f, 2.4979432f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(3.3376653f, -0.38297144f, -2.2952204f, 7.0122256f), vec4<f32>(-0.19583838f, -0.21951479f, -0.04405034f, 0.040380068f), vec4<f32>(-0.013765891f, 0.11841442f, -0.16300689f, 0.03734604f), vec4<f32>(-31.77642f, -70.86214f, -5.6645384f, 2.3562365f)),
    mat4x4<f32>(vec4<f32>(-24.84731f, -5.8407044f, 0.8097388f, -3.0066211f), vec4<f32>(-3.5153785f, -10.087853f, -8.900696f, -9.773681f), vec4<f32>(1.4137939f, -7.7516947f, -8.073735f, 0.110253155f), vec4<f32>(0.11317725f, 11.804854f, 12.301212f, 3.7292614f)),
    mat4x4<f32>(vec4<f32>(9.362567f, 11.713174f, -0.49722984f, -0.009957121f), vec4<f32>(2.1004505f, -2.2335987f, 0.8774605f, 4.5194054f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-14.200476f, 11.250799f, -3.614167f, -2.746474f), vec4<f32>(0.005306553f, 2.6359544f, -2.3081715f, -0.22634201f), vec4<f32>(-0.0017052869f, 0.11265119f, 1.0070869f, 0.25444132f), vec4<f32>(-0.021890452f, -108.46809f, -2.2514987f, 7.211717f)),
    mat4x4<f32>(vec4<f32>(-0.06271778f, -0.07305096f, -5.558425f, 5.7747507f), vec4<f32>(-0.033172604f, -6.5932364f, -0.5465898f, -2.1271129f), vec4<f32>(0.04429119f, 19.870779f, -1.9174488f, -10.829139f), vec4<f32>(0.039593868f, -3.3658838f, 0.62879133f, 9.388285f)),
    mat4x4<f32>(vec4<f32>(-0.020906946f, 0.5016997f, -1.60396f, 3.9739897f), vec4<f32>(-14.116647f, -5.6320314f, 0.11533172f, -2.244007f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(2.3758276f, 0.7344675f, -9.42585f, -1.7282971f), vec4<f32>(0.11907535f, -0.6181794f, -0.72843254f, -0.2958274f), vec4<f32>(-0.21814533f, 0.07219827f, -0.23492429f, 0.058244046f), vec4<f32>(-124.99927f, -59.562664f, -0.5356338f, 10.4820795f)),
    mat4x4<f32>(vec4<f32>(-21.341158f, -9.852887f, -0.06728689f, -32.79679f), vec4<f32>(-2.306273f, -1.9161882f, 0.07075858f, 10.962963f), vec4<f32>(5.05221f, 6.1378217f, -0.35156924f, -16.601978f), vec4<f32>(0.60254544f, -3.0944357f, 0.07379391f, -12.189142f)),
    mat4x4<f32>(vec4<f32>(-4.0926666f, 5.6984234f, -0.10884648f, 0.5172278f), vec4<f32>(6.597823f, -1.295542f, -10.24747f, 2.0605915f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-11.041016f, -1.727267f, -13.253658f, -5.3044567f), vec4<f32>(-0.08233529f, 0.28346556f, 0.11086188f, 0.033272017f), vec4<f32>(0.17816567f, -0.36862642f, -0.00985248f, 0.18185203f), vec4<f32>(4.587747f, 38.25356f, 0.92788625f, 8.650902f)),
    mat4x4<f32>(vec4<f32>(-2.0548725f, -201.86287f, -0.0065434664f, -1.6800108f), vec4<f32>(-0.43485776f, 1.1749663f, 0.19468619f, 8.001372f), vec4<f32>(2.110869f, -170.5215f, -0.15174873f, -4.467283f), vec4<f32>(-0.16220906f, 0.7012172f, 0.0644586f, -6.989527f)),
    mat4x4<f32>(vec4<f32>(-0.5775319f, -1.6356709f, -0.18584095f, 1.5081521f), vec4<f32>(-10.046028f, 2.7278986f, -12.654014f, -2.4023314f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-5.0406375f, 4.139162f, 0.09449681f, -2.6226003f), vec4<f32>(-0.10544489f, 0.12420155f, 0.0846088f, -0.2773238f), vec4<f32>(-0.22284019f, -0.23321922f, 0.13458256f, -0.017866516f), vec4<f32>(26.932327f, 17.52416f, -10.881321f, -10.78837f)),
    mat4x4<f32>(vec4<f32>(-27.125784f, -8.781659f, -3.0741816f, 3.4798355f), vec4<f32>(4.148134f, -4.233007f, -9.016876f, 4.16812f), vec4<f32>(-16.758512f, -5.822711f, 4.054722f, 5.8445425f), vec4<f32>(0.27446285f, 4.334256f, 12.806946f, -1.8126884f)),
    mat4x4<f32>(vec4<f32>(0.42796925f, 8.407661f, 0.06883113f, -14.229925f), vec4<f32>(2.672512f, 1.2197539f, -1.8344728f, 2.8224165f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.9830742f, 8.944236f, -1.1504629f, -4.3265924f), vec4<f32>(-0.023475759f, -0.15907055f, -0.42637935f, 0.11589328f), vec4<f32>(0.041950222f, -0.21535935f, -0.07122723f, 0.15908366f), vec4<f32>(-101.51232f, 0.34831f, 0.77278036f, 26.464895f)),
    mat4x4<f32>(vec4<f32>(0.027170673f, -2.085998f, 8.533334f, -19.456049f), vec4<f32>(0.29037327f, -5.1486573f, 5.737693f, 4.954904f), vec4<f32>(7.710748f, -2.8508146f, -0.92319506f, 1.4761099f), vec4<f32>(2.0909944f, -5.1753078f, -1.1685946f, -3.2550154f)),
    mat4x4<f32>(vec4<f32>(0.6073655f, 0.680405f, 0.752367f, -5.182517f), vec4<f32>(-0.7346928f, 3.5099447f, -2.367339f, -1.9820573f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(0.5612714f, -0.8052822f, 1.9578358f, 0.7541197f), vec4<f32>(-3.0509675f, -0.8913338f, -2.0507882f, 0.08210287f), vec4<f32>(-1.8096141f, -4.047719f, -0.87021947f, -0.5095532f), vec4<f32>(-1.7694044f, -2.431335f, -3.985533f, 2.5685859f)),
    mat4x4<f32>(vec4<f32>(0.00018819174f, -1.6301407f, -0.8177756f, 0.8410233f), vec4<f32>(-0.18867442f, -0.14180064f, 0.23432782f, 1.1939652f), vec4<f32>(-0.28679964f, 4.192852f, -0.15248433f, 0.10820271f), vec4<f32>(-0.5148806f, 0.57227784f, -3.5086772f, -0.8603132f)),
    mat4x4<f32>(vec4<f32>(-0.057861097f, 1.2268503f, -4.9752107f, 0.97435975f), vec4<f32>(-0.10037012f, 1.4835347f, -2.708487f, 0.22378573f), vec4<f32>(-0.26280734f, 1.1496403f, 0.24401025f, -0.12223057f), vec4<f32>(0.9853024f, 1.2418171f, -0.027950218f, -0.84020066f)),
    mat4x4<f32>(vec4<f32>(29.311577f, 5.1649904f, -7.3978987f, 38.205784f), vec4<f32>(-0.13957557f, -0.39724877f, -0.57345605f, 0.16402759f), vec4<f32>(0.44155926f, 0.59527594f, 1.1621081f, 0.8841033f), vec4<f32>(-0.75949806f, -1.1115868f, -0.1917119f, 0.35651338f)),
    mat4x4<f32>(vec4<f32>(1.55433f, 0.57734424f, 0.4066175f, -0.38792506f), vec4<f32>(-0.28983963f, -2.51321f, -1.8156649f, -0.5273519f), vec4<f32>(20.610762f, 10.519593f, 4.2690234f, 35.395996f), vec4<f32>(-0.06966489f, -1.7839004f, -4.118357f, -0.66634846f)),
    mat4x4<f32>(vec4<f32>(-0.0768172f, -0.90769356f, -0.76780784f, 1.6518021f), vec4<f32>(-3.379264f, -10.539941f, -16.59533f, -2.8945174f), vec4<f32>(3.7318642f, 1.2683077f, 0.5771581f, 5.465723f), vec4<f32>(-0.34995794f, -2.0756266f, -0.71379185f, 1.1416491f)),
    mat4x4<f32>(vec4<f32>(-0.063372806f, 1.2796607f, 1.2495276f, 2.0932581f), vec4<f32>(-0.80130994f, -3.971518f, 0.8077129f, 0.61369365f), vec4<f32>(0.006266941f, -2.1069548f, -1.4359239f, 0.20941292f), vec4<f32>(0.17255613f, -6.439542f, -0.43115193f, -0.3608885f)),
    mat4x4<f32>(vec4<f32>(0.20230684f, 1.3585289f, 1.690652f, 0.30478713f), vec4<f32>(-0.2972322f, 0.5015593f, -3.7431738f, -0.15872914f), vec4<f32>(-0.063379474f, -1.8211364f, -0.5723202f, -1.0097622f), vec4<f32>(1.6373553f, 5.8172894f, 2.0908377f, -0.12513334f)),
    mat4x4<f32>(vec4<f32>(4.432494f, -1.0324867f, 0.15783006f, -0.19616091f), vec4<f32>(-1.0922611f, 0.80809677f, -0.4039501f, -0.17652889f), vec4<f32>(0.14157669f, 0.91334754f, -0.5151216f, -0.50741524f), vec4<f32>(-11.98909f, -0.6244048f, -0.29388586f, -0.9342302f)),
    mat4x4<f32>(vec4<f32>(-1.192838f, -0.59448165f, -0.5513403f, 0.22779986f), vec4<f32>(0.32817048f, -0.0049283956f, -0.3480491f, -0.09889783f), vec4<f32>(-1.6917663f, -0.28460243f, 0.22333966f, 1.7914547f), vec4<f32>(-2.6235445f, 0.3005778f, -0.55614203f, 0.3724611f)),
    mat4x4<f32>(vec4<f32>(1.455877f, 0.4335604f, -0.4377843f, 0.99129975f), vec4<f32>(1.41245f, -0.18254372f, 0.20757042f, -0.0055713546f), vec4<f32>(-0.48564953f, 0.20124733f, 0.0506122f, -0.7202818f), vec4<f32>(0.3632785f, 1.0082462f, -0.3909515f, 0.14880356f)),
    mat4x4<f32>(vec4<f32>(34.768063f, -7.8861685f, 0.14344464f, 110.397125f), vec4<f32>(-1.2552068f, -0.7247046f, -0.13631397f, -0.745887f), vec4<f32>(-1.7309783f, 0.50249267f, -0.22249134f, 0.49455148f), vec4<f32>(-3.3301651f, -0.11269005f, -0.26882094f, -0.3997913f)),
    mat4x4<f32>(vec4<f32>(-0.63325346f, -0.23269548f, 0.03240724f, -0.24410391f), vec4<f32>(-0.56117594f, -1.0841293f, -0.33914873f, -1.479392f), vec4<f32>(21.043505f, -9.559243f, 0.2872074f, 75.28369f), vec4<f32>(1.6869254f, -3.9069245f, 0.037293382f, -1.0802398f)),
    mat4x4<f32>(vec4<f32>(1.1544132f, -0.9880814f, -0.20143014f, -1.0886188f), vec4<f32>(-9.796492f, -1.5660758f, 0.031343132f, -7.743226f), vec4<f32>(4.532845f, -0.99818444f, -0.35377118f, -1.7958479f), vec4<f32>(-0.08037113f, -0.53063697f, -0.030638263f, 0.17173046f)),
    mat4x4<f32>(vec4<f32>(-2.2670875f, 1.5502144f, -0.13599676f, 0.6596191f), vec4<f32>(-0.39481798f, 0.25847867f, -0.106472634f, -1.1384745f), vec4<f32>(-1.612787f, -0.55916464f, -0.22542503f, -0.8191134f), vec4<f32>(-1.0800495f, -0.92530394f, -0.141488f, -0.7818429f)),
    mat4x4<f32>(vec4<f32>(0.91121244f, 0.13503289f, -0.3357986f, -0.49670896f), vec4<f32>(-1.6732597f, 1.6311814f, -0.03868916f, 0.08786737f), vec4<f32>(-2.7890007f, -0.8569007f, -0.17694147f, -0.78453374f), vec4<f32>(-1.2615094f, -0.31259876f, -0.15151915f, 1.4896415f)),
    mat4x4<f32>(vec4<f32>(-0.13391794f, -0.891611f, -0.60111266f, 0.18036509f), vec4<f32>(-45.253212f, -2.0789275f, -55.56758f, -0.24589449f), vec4<f32>(-0.94204605f, -4.857143f, 0.773831f, -0.33291525f), vec4<f32>(-20.090935f, -0.78326464f, 2.4229555f, 0.09803279f)),
    mat4x4<f32>(vec4<f32>(3.1258688f, 3.3962352f, -0.3281802f, -0.58999366f), vec4<f32>(-0.50923795f, 0.3633625f, -0.17792912f, -0.26248187f), vec4<f32>(0.87033373f, 0.18452893f, -0.050617557f, -0.67375934f), vec4<f32>(-0.14110301f, -0.014655196f, 0.44809416f, -0.26554093f)),
    mat4x4<f32>(vec4<f32>(-0.5455171f, 1.0173776f, 0.915084f, -0.17738713f), vec4<f32>(-4.9446936f, 0.19119684f, -0.84807664f, -0.281693f), vec4<f32>(4.4927692f, -1.2343456f, 0.28497058f, -0.19485503f), vec4<f32>(0.87839663f, -0.106170714f, -2.096666f, -0.46047825f)),
    mat4x4<f32>(vec4<f32>(-3.0281644f, -21.505493f, -64.173225f, -0.22722849f), vec4<f32>(-26.211569f, 0.016989341f, 1.0031826f, -0.14194465f), vec4<f32>(0.38507217f, 0.9351074f, -0.0777235f, -0.41040322f), vec4<f32>(1.0386806f, -0.18513341f, 1.3027041f, -0.24041142f)),
    mat4x4<f32>(vec4<f32>(0.22283384f, 2.367998f, -1.4081047f, -0.15789123f), vec4<f32>(-2.3488436f, -0.09097922f, -0.005557982f, -0.3844968f), vec4<f32>(-25.454828f, -30.255812f, -68.86f, -0.22142246f), vec4<f32>(0.9135177f, 0.12279967f, -27.964146f, -0.17632717f)),
    mat4x4<f32>(vec4<f32>(1.1946952f, -1.5483994f, -1.7453567f, 0.2640197f), vec4<f32>(-10.479829f, -0.065224044f, -6.247429f, 0.09248742f), vec4<f32>(-0.22627845f, -6.987417f, -8.7303f, -0.24033648f), vec4<f32>(0.5106705f, 0.21911664f, -0.14479464f, -0.05997175f)),
    mat4x4<f32>(vec4<f32>(-1.0584769f, -0.76991665f, 0.35826787f, 0.2570622f), vec4<f32>(-38.088936f, 0.9563952f, -10.26186f, -0.012669509f), vec4<f32>(-1.8953276f, 1.3880517f, 2.193768f, -0.47001857f), vec4<f32>(-1.6761823f, 0.29450762f, 0.62701017f, -0.20249395f)),
    mat4x4<f32>(vec4<f32>(2.902732f, 0.4166712f, 0.2856457f, -0.086941235f), vec4<f32>(-0.9827138f, -0.21861658f, -1.2146354f, -0.12214594f), vec4<f32>(-2.7559738f, -1.0897014f, 0.20467448f, -0.1411117f), vec4<f32>(-1.0689127f, -2.4455764f, -1.3695912f, -0.51198465f)),
    mat4x4<f32>(vec4<f32>(0.81078166f, -0.4044338f, 2.720114f, -0.018226687f), vec4<f32>(2.3581884f, 1.6104178f, -4.943122f, -0.75195354f), vec4<f32>(-0.3908668f, 1.0078644f, -1.1918337f, -0.14066498f), vec4<f32>(-1.492688f, -4.646078f, 1.8119683f, -0.52144f)),
    mat4x4<f32>(vec4<f32>(-1.1722519f, 0.9783798f, -0.01346622f, -1.4579939f), vec4<f32>(-1.8240347f, 0.76718897f, -1.1876087f, -0.013630305f), vec4<f32>(2.17518f, 0.035115838f, -1.155891f, 0.3128857f), vec4<f32>(-2.617839f, 0.21239686f, -1.7636377f, -0.13492033f)),
    mat4x4<f32>(vec4<f32>(0.8584923f, 0.410397f, -4.2714176f, -0.6748531f), vec4<f32>(-0.21329014f, -0.23891681f, 2.2193787f, -1.5731057f), vec4<f32>(-0.9720868f, 0.017681163f, -3.4190187f, -0.47943452f), vec4<f32>(-0.61413044f, 0.50284374f, 0.7826973f, 0.70128167f)),
    mat4x4<f32>(vec4<f32>(-21.171513f, 26.865187f, -34.713753f, 30.892735f), vec4<f32>(0.64165086f, -0.961954f, -2.718338f, -1.7435387f), vec4<f32>(0.6778252f, 1.7303016f, 0.32805926f, 0.58119136f), vec4<f32>(-0.31990194f, -0.74946654f, 1.1855053f, -0.5359104f)),
    mat4x4<f32>(vec4<f32>(-0.5938348f, -0.2984739f, 2.1709085f, 0.7654855f), vec4<f32>(-1.3230438f, -0.21147202f, 2.9178054f, 0.84411603f), vec4<f32>(-3.8531673f, 14.801703f, -33.84283f, 32.70362f), vec4<f32>(0.7274438f, 0.19319296f, -2.167876f, -2.0092883f)),
    mat4x4<f32>(vec4<f32>(-2.0672529f, 1.5651822f, 4.6140957f, -4.5149217f), vec4<f32>(0.85987955f, -20.381807f, -4.8222675f, 6.1487484f), vec4<f32>(-11.035366f, 2.083262f, 9.291252f, 18.810875f), vec4<f32>(1.0576226f, -0.83874434f, 0.3078845f, -0.061636534f)),
    mat4x4<f32>(vec4<f32>(1.2366849f, -0.12529887f, 1.47252f, 0.15226749f), vec4<f32>(3.912004f, -0.6518246f, 1.4097291f, -0.3996969f), vec4<f32>(1.3647116f, -0.7544857f, 2.0510762f, -3.3437326f), vec4<f32>(0.4689717f, -1.8347169f, 3.3225002f, -1.0843767f)),
    mat4x4<f32>(vec4<f32>(-1.1071062f, -0.18258168f, -1.8788732f, -0.4204919f), vec4<f32>(0.29666585f, -1.5362499f, 1.769943f, 0.34129623f), vec4<f32>(-12.318685f, 2.4055486f, 0.08319975f, 0.4437303f), vec4<f32>(-1.6225735f, -2.517713f, 0.03564834f, -0.37749812f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(8.4412f, 3.6170914f, 6.4581738f, 4.2712755f),
    vec4<f32>(0.41956437f, 2.4876723f, -0.15839966f, -0.114488125f),
    vec4<f32>(-5.21652f, -5.002616f, -4.8846345f, -0.22173963f),
    vec4<f32>(-10.75025f, -5.905891f, -18.288715f, 1.4138744f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.19069599f, 0.24618374f, 0.13081251f, -0.18281528f),
    vec4<f32>(0.22839579f, 0.10921503f, 0.2918631f, -0.2877968f),
    vec4<f32>(0.13975196f, 0.11612862f, 0.10460415f, -0.06111151f),
    vec4<f32>(0.074991226f, 0.112442635f, 0.089019135f, -0.1614554f)
);
const NMT_B3: f32 = -1.8172282f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
fn nmt_share(f: mat3x4<f32>) -> f32 {
    let h0_0 = f[0];
    let h0_1 = f[1];
    let h0_2 = vec4<f32>(f[2].x, 1.0f, 0.0f, 0.0f);
    let h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1 + NMT_W1[2] * h0_2, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[3] * h0_0 + NMT_W1[4] * h0_1 + NMT_W1[5] * h0_2, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1 + NMT_W1[8] * h0_2, vec4<f32>(0.0f));
    let h1_3 = max(NMT_W1[9] * h0_0 + NMT_W1[10] * h0_1 + NMT_W1[11] * h0_2, vec4<f32>(0.0f));
    let h1_4 = max(NMT_W1[12] * h0_0 + NMT_W1[13] * h0_1 + NMT_W1[14] * h0_2, vec4<f32>(0.0f));
    let h1_5 = max(NMT_W1[15] * h0_0 + NMT_W1[16] * h0_1 + NMT_W1[17] * h0_2, vec4<f32>(0.0f));
    let h1_6 = max(NMT_W1[18] * h0_0 + NMT_W1[19] * h0_1 + NMT_W1[20] * h0_2, vec4<f32>(0.0f));
    let h1_7 = max(NMT_W1[21] * h0_0 + NMT_W1[22] * h0_1 + NMT_W1[23] * h0_2, vec4<f32>(0.0f));
    let h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3 + NMT_W2[4] * h1_4 + NMT_W2[5] * h1_5 + NMT_W2[6] * h1_6 + NMT_W2[7] * h1_7, vec4<f32>(0.0f));
    let h2_1 = max(NMT_B2[1] + NMT_W2[8] * h1_0 + NMT_W2[9] * h1_1 + NMT_W2[10] * h1_2 + NMT_W2[11] * h1_3 + NMT_W2[12] * h1_4 + NMT_W2[13] * h1_5 + NMT_W2[14] * h1_6 + NMT_W2[15] * h1_7, vec4<f32>(0.0f));
    let h2_2 = max(NMT_B2[2] + NMT_W2[16] * h1_0 + NMT_W2[17] * h1_1 + NMT_W2[18] * h1_2 + NMT_W2[19] * h1_3 + NMT_W2[20] * h1_4 + NMT_W2[21] * h1_5 + NMT_W2[22] * h1_6 + NMT_W2[23] * h1_7, vec4<f32>(0.0f));
    let h2_3 = max(NMT_B2[3] + NMT_W2[24] * h1_0 + NMT_W2[25] * h1_1 + NMT_W2[26] * h1_2 + NMT_W2[27] * h1_3 + NMT_W2[28] * h1_4 + NMT_W2[29] * h1_5 + NMT_W2[30] * h1_6 + NMT_W2[31] * h1_7, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: mat3x4<f32>) -> f32 {
    let absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

// Core of a pixel: codes of single fragments, 32 bits of whole numbers, so that both passes and every device find the
// same ones.
//
// A fragment is its steps: x of depth in 0..2^NMT_DEPTH_BITS, 0 the nearest, and y of absorbance, 0 none. What a
// renderer adds up, and removes later, is what the steps stand for. Slots of a pixel hold the nearest, the farthest of
// the others, and the NMT_HEAVY heaviest of the rest; 0 is an empty slot.

const NMT_DEPTH_BITS: u32 = 16u;
// Steps of absorbance to the octave, as a power of two.
const NMT_OCTAVE_BITS: u32 = 11u;
const NMT_HEAVY: u32 = 4u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const NMT_SLOTS: u32 = 6u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const NMT_KEY_SCALE: f32 = 0.625;
// The last step of absorbance, that of A = 10.
const NMT_LAST_ABSORBANCE: u32 = 27136u;
const NMT_LAST_DEPTH: u32 = (1u << NMT_DEPTH_BITS) - 1u;
const NMT_END_BITS: u32 = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
const NMT_LINEAR_BITS: u32 = 0x3a800000u;
const NMT_LINEAR: f32 = 0.0009765625;

// Codes of a scene. The same for every fragment of a frame, in both passes.
struct NmtCodes { first_bits: i32, last_bits: i32, first_log2: i32, shift: u32, multiplier: u32, slope: u32 }

// Logarithm of base 2 of the positive number with these bits, in units of 2^-23 octaves and 127 octaves more, by
// integers alone: bits are a logarithm that is linear in each octave, and a parabola bends it.
fn nmt_core_log2(bits: i32) -> i32 {
    let m = bits & 0x007fffff;
    let h = m >> 11u;
    let l = m & 2047;
    let t = ((h * (4096 - h)) >> 1u) + ((l * (2048 - h)) >> 11u);
    return bits + ((11 * t) >> 5u);
}

// Codes of a scene whose view depths lie in [v0, v1], 0 < v0 <= v1.
fn nmt_core_codes(v0: f32, v1: f32) -> NmtCodes {
    let first = bitcast<i32>(v0);
    let last = bitcast<i32>(v1);
    let first_log2 = nmt_core_log2(first);
    let range = u32(nmt_core_log2(last) - first_log2);
    let shift = max(32u - countLeadingZeros(range), NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
    let multiplier = 0x80000000u / ((range >> shift) + 1u);
    let room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    let slope = min(u32(f32(range >> 8u) * NMT_KEY_SCALE), room);
    return NmtCodes(first, last, first_log2, shift, multiplier, slope);
}

// Absorbance min(-ln(1 - alpha), 10) of an opacity.
fn nmt_core_absorbance_of(alpha: f32) -> f32 {
    return -log(max(1.0 - alpha, 0.000045399931));
}

// Steps of a fragment of view depth v.
fn nmt_core_steps(v: f32, absorbance: f32, codes: NmtCodes) -> vec2<u32> {
    let place = nmt_core_log2(clamp(bitcast<i32>(v), codes.first_bits, codes.last_bits));
    let w = u32(place - codes.first_log2) >> codes.shift;
    let a = bitcast<u32>(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return vec2<u32>(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
fn nmt_core_depth(steps: vec2<u32>) -> f32 {
    return f32(2u * steps.x + 1u) * (1.0 / f32(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
fn nmt_core_absorbance(steps: vec2<u32>) -> f32 {
    return bitcast<f32>(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

// Moments of a fragment: what pass 1 adds to b1, b2, b3, b4 of its pixel, beside its absorbance to b0.
fn nmt_core_moments(steps: vec2<u32>) -> vec4<f32> {
    let z = nmt_core_depth(steps);
    let first = nmt_core_absorbance(steps) * z;
    let second = first * z;
    let third = second * z;
    return vec4<f32>(first, second, third, third * z);
}

// Codes in the three kinds of slots, and back. The greater code stays in a slot.
fn nmt_core_nearest_code(steps: vec2<u32>) -> u32 {
    return ((NMT_LAST_DEPTH - steps.x) << NMT_END_BITS) | steps.y;
}

fn nmt_core_nearest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_farthest_code(steps: vec2<u32>) -> u32 {
    return (steps.x << NMT_END_BITS) | steps.y;
}

fn nmt_core_farthest_steps(code: u32) -> vec2<u32> {
    return vec2<u32>(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

fn nmt_core_heavy_code(steps: vec2<u32>, codes: NmtCodes) -> u32 {
    let nearness = NMT_LAST_DEPTH - steps.x;
    return ((steps.y + ((nearness * codes.slope) >> NMT_DEPTH_BITS)) << NMT_DEPTH_BITS) | nearness;
}

fn nmt_core_heavy_steps(code: u32, codes: NmtCodes) -> vec2<u32> {
    let nearness = code & NMT_LAST_DEPTH;
    let key = code >> NMT_DEPTH_BITS;
    return vec2<u32>(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Pass 1 of the core, in the fragment stage, without an interlock. Every fragment walks down the slots of its pixel:
// each slot keeps the greater of two codes in one atomic step and hands the lesser on to the next, so that the slots
// end with the same codes whatever order fragments come in.
//
// Clear the buffer to 0 before the pass. Atomics write even where a depth test that runs after the shader fails:
// test against opaque depth before the call.

@group(3) @binding(0) var<storage, read_write> nmt_core: array<atomic<u32>>;

// Offers a code to a slot; the lesser of that and what was there, 0 where the slot was empty.
fn nmt_core_offer(slot: u32, code: u32) -> u32 {
    // Slots only grow: what is not less now never will be, and most fragments need no atomic step.
    if (atomicLoad(&nmt_core[slot]) >= code) {
        return code;
    }
    return min(atomicMax(&nmt_core[slot], code), code);
}

// Offers a fragment, by its steps, to the core of a pixel.
fn nmt_core_insert(pixel: u32, steps: vec2<u32>, codes: NmtCodes) {
    if (steps.y == 0u) {
        return;
    }
    let first = pixel * NMT_SLOTS;
    let second = nmt_core_offer(first, nmt_core_nearest_code(steps));
    if (second == 0u) {
        return;
    }
    let third = nmt_core_offer(first + 1u, nmt_core_farthest_code(nmt_core_nearest_steps(second)));
    if (third == 0u) {
        return;
    }
    var code = nmt_core_heavy_code(nmt_core_farthest_steps(third), codes);
    // What is lighter than the last of the heavy is lighter than all of them.
    if (NMT_HEAVY == 0u || atomicLoad(&nmt_core[first + 1u + NMT_HEAVY]) >= code) {
        return;
    }
    for (var slot = first + 2u; slot < first + 2u + NMT_HEAVY; slot++) {
        code = nmt_core_offer(slot, code);
        if (code == 0u) {
            return;
        }
    }
}

// Where the moments of the tail leave what the fragment adds to the image open by no more than this, T is the middle of
// what they allow, and the network is not asked. 0 always asks it; 1/512 cannot be seen.
const NMT_OPEN: f32 = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err than
// these: Markov's bounds.
fn nmt_core_bounds(x: f32, m1: f32, m2: f32, m3: f32, m4: f32) -> vec3<f32> {
    let mean = m1 * 0.9999;
    let second = m2 * 0.9999 + 3.3333334e-5;
    let third = m3 * 0.9999;
    let fourth = m4 * 0.9999 + 2e-5;
    let square = mean * mean;
    let variance = max(second - square, 1e-7);
    let per_deviation = 1.0 / sqrt(variance);
    let per_variance = per_deviation * per_deviation;
    let skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    let d = clamp((fourth - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    let y = (x - mean) * per_deviation;
    let per_d = 1.0 / d;
    let q = (y * (y - skewness) - 1.0) * per_d;
    let at = 1.0 / (1.0 + y * y + q * q * d);
    let rest = 1.0 - at;
    let linear_ = y - q * skewness;
    let per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    let between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    let lower = select(select(0.0, rest, y > 0.5 * skewness), between, 0.0 > q);
    let inner = max(1.0 - second, 1e-6);
    let per_inner = 1.0 / inner;
    let inner_mean = (mean - third) * per_inner;
    let inner_second = (second - fourth) * per_inner;
    let width = max(inner_second - inner_mean * inner_mean, 1e-7);
    let place = inner_mean - x;
    let of_inner = width / (width + place * place);
    let ended = inner * of_inner / max(1.0 - x * x, 1e-6);
    let side = select(1.0, -1.0, 0.0 > place);
    let of_fourth = inner * (1.0 - of_inner) * abs(place) / max(abs(place) + inner_second - x * inner_mean, 1e-6);
    let at_end = clamp(0.5 * (1.0 - side * mean - ended * (1.0 - side * x) - of_fourth), 0.0, max(1.0 - ended, 0.0));
    let least = select(lower, select(at_end, 1.0 - ended - at_end, 0.0 > place), at > ended);
    let most = select(at, ended, at > ended);
    return vec3<f32>(least, least + most, per_variance * per_variance * per_d);
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
fn nmt_core_weigh(z: f32, absorbance: f32, depths0: vec4<f32>, absorbances0: vec4<f32>, depths1: vec4<f32>,
    absorbances1: vec4<f32>, n: f32, b0: f32, moments: vec4<f32>) -> f32 {
    let front = 0.0 + select(0.0, absorbances0.x, z > depths0.x);
    let in_core = select(0.0, 1.0, depths0.x == z && absorbances0.x == absorbance);
    let count = n - select(0.0, 1.0, absorbances0.x > 0.0);
    let rest0 = b0 - absorbances0.x;
    let rest1 = moments.x - absorbances0.x * depths0.x;
    let rest2 = moments.y - absorbances0.x * depths0.x * depths0.x;
    let rest3 = moments.z - absorbances0.x * depths0.x * depths0.x * depths0.x;
    let rest4 = moments.w - absorbances0.x * depths0.x * depths0.x * depths0.x * depths0.x;
    let front_2 = front + select(0.0, absorbances0.y, z > depths0.y);
    let in_core_2 = select(in_core, 1.0, depths0.y == z && absorbances0.y == absorbance);
    let count_2 = count - select(0.0, 1.0, absorbances0.y > 0.0);
    let rest0_2 = rest0 - absorbances0.y;
    let rest1_2 = rest1 - absorbances0.y * depths0.y;
    let rest2_2 = rest2 - absorbances0.y * depths0.y * depths0.y;
    let rest3_2 = rest3 - absorbances0.y * depths0.y * depths0.y * depths0.y;
    let rest4_2 = rest4 - absorbances0.y * depths0.y * depths0.y * depths0.y * depths0.y;
    let front_3 = front_2 + select(0.0, absorbances0.z, z > depths0.z);
    let in_core_3 = select(in_core_2, 1.0, depths0.z == z && absorbances0.z == absorbance);
    let count_3 = count_2 - select(0.0, 1.0, absorbances0.z > 0.0);
    let rest0_3 = rest0_2 - absorbances0.z;
    let rest1_3 = rest1_2 - absorbances0.z * depths0.z;
    let rest2_3 = rest2_2 - absorbances0.z * depths0.z * depths0.z;
    let rest3_3 = rest3_2 - absorbances0.z * depths0.z * depths0.z * depths0.z;
    let rest4_3 = rest4_2 - absorbances0.z * depths0.z * depths0.z * depths0.z * depths0.z;
    let front_4 = front_3 + select(0.0, absorbances0.w, z > depths0.w);
    let in_core_4 = select(in_core_3, 1.0, depths0.w == z && absorbances0.w == absorbance);
    let count_4 = count_3 - select(0.0, 1.0, absorbances0.w > 0.0);
    let rest0_4 = rest0_3 - absorbances0.w;
    let rest1_4 = rest1_3 - absorbances0.w * depths0.w;
    let rest2_4 = rest2_3 - absorbances0.w * depths0.w * depths0.w;
    let rest3_4 = rest3_3 - absorbances0.w * depths0.w * depths0.w * depths0.w;
    let rest4_4 = rest4_3 - absorbances0.w * depths0.w * depths0.w * depths0.w * depths0.w;
    let front_5 = front_4 + select(0.0, absorbances1.x, z > depths1.x);
    let in_core_5 = select(in_core_4, 1.0, depths1.x == z && absorbances1.x == absorbance);
    let count_5 = count_4 - select(0.0, 1.0, absorbances1.x > 0.0);
    let rest0_5 = rest0_4 - absorbances1.x;
    let rest1_5 = rest1_4 - absorbances1.x * depths1.x;
    let rest2_5 = rest2_4 - absorbances1.x * depths1.x * depths1.x;
    let rest3_5 = rest3_4 - absorbances1.x * depths1.x * depths1.x * depths1.x;
    let rest4_5 = rest4_4 - absorbances1.x * depths1.x * depths1.x * depths1.x * depths1.x;
    let front_6 = front_5 + select(0.0, absorbances1.y, z > depths1.y);
    let in_core_6 = select(in_core_5, 1.0, depths1.y == z && absorbances1.y == absorbance);
    let count_6 = count_5 - select(0.0, 1.0, absorbances1.y > 0.0);
    let rest0_6 = rest0_5 - absorbances1.y;
    let rest1_6 = rest1_5 - absorbances1.y * depths1.y;
    let rest2_6 = rest2_5 - absorbances1.y * depths1.y * depths1.y;
    let rest3_6 = rest3_5 - absorbances1.y * depths1.y * depths1.y * depths1.y;
    let rest4_6 = rest4_5 - absorbances1.y * depths1.y * depths1.y * depths1.y * depths1.y;
    let far = select(depths0.x, depths0.y, absorbances0.y > 0.0);
    let center = 0.5 * (depths0.x + far);
    let half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    let per_h = 1.0 / half_range;
    let moved1 = (rest1_6 - center * rest0_6) * per_h;
    let moved2 = (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)) * (per_h * per_h);
    let moved3 = (rest3_6 - center * rest2_6 - center * (rest2_6 - center * rest1_6) - center * (rest2_6 - center
        * rest1_6 - center * (rest1_6 - center * rest0_6))) * (per_h * per_h * per_h);
    let moved4 = (rest4_6 - center * rest3_6 - center * (rest3_6 - center * rest2_6) - center * (rest3_6 - center
        * rest2_6 - center * (rest2_6 - center * rest1_6)) - center * (rest3_6 - center * rest2_6 - center * (rest2_6
        - center * rest1_6) - center * (rest2_6 - center * rest1_6 - center * (rest1_6 - center * rest0_6)))) * (per_h
        * per_h * per_h * per_h);
    let x = clamp((z - center) * per_h, -1.0, 1.0);
    let removed = select(0.0, absorbance, in_core_6 == 0.0);
    let tail0 = rest0_6 - removed;
    let tail1 = moved1 - removed * x;
    let tail2 = moved2 - removed * x * x;
    let tail3 = moved3 - removed * x * x * x;
    let tail4 = moved4 - removed * x * x * x * x;
    let others = count_6 - select(0.0, 1.0, removed > 0.0);
    let absorbance_of_tail = clamp(tail0, 0.0, 1e30);
    let per_b0 = 1.0 / max(tail0, 1e-12);
    let m1 = clamp(tail1 * per_b0, -1.0, 1.0);
    let m2 = clamp(tail2 * per_b0, -1.0, 1.0);
    let m3 = clamp(tail3 * per_b0, -1.0, 1.0);
    let m4 = clamp(tail4 * per_b0, -1.0, 1.0);
    let own_step = per_h * 3.0517578e-5;
    let noise = b0 / max(absorbance_of_tail, 1e-12) * (per_h + abs(center) * per_h) * 1.9073486e-6;
    let exact = clamp((x - m1 - own_step * 0.25) / (own_step * 0.5 + noise), 0.0, 1.0);
    let variance = max(m2 - m1 * m1, 1e-9);
    let sum = clamp((m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1) / variance, -2.0, 2.0);
    let root = sqrt(sum * sum + 4.0 * variance);
    let near = 0.5 * (sum - root);
    let far_2 = 0.5 * (sum + root);
    let of_near = clamp(far_2 / root, 0.0, 1.0);
    let exact_2 = select(exact, of_near * clamp((x - m1 - near - own_step * 0.25) / (own_step * 0.5 + (noise + noise
        / max(sqrt(variance), 0.0001))), 0.0, 1.0) + (1.0 - of_near) * clamp((x - m1 - far_2 - own_step * 0.25)
        / (own_step * 0.5 + (noise + noise / max(sqrt(variance), 0.0001))), 0.0, 1.0), others > 1.5);
    let exact_3 = select(exact_2, 1.0, z >= far);
    let exact_4 = select(exact_3, 0.0, others < 0.5 || z <= depths0.x);
    if ((others < 2.5 || z >= far) || z <= depths0.x) {
        let known = min(exp(-(front_6 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    let bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        let bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        let most = min(exp(-(front_6 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        let least = min(exp(-(front_6 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        let opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            let middle = 0.5 * (most + least);
            return middle;
        }
    }
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_6) * nmt_transmittance(mat3x4<f32>(vec4<f32>(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), bounds.x), vec4<f32>(bounds.y, mean, clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean
        * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0), mean_2), vec4<f32>(sqrt(clamp(((m2 - m4) * (1.0 / max(1.0
        - m2, 1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0, 0.0, 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
fn nmt_core_slot(code: u32, steps: vec2<u32>) -> vec2<f32> {
    return select(vec2<f32>(0.0), vec2<f32>(nmt_core_depth(steps), nmt_core_absorbance(steps)), code > 0u);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
fn nmt_core_transmittance(
    steps: vec2<u32>,
    codes: NmtCodes,
    core0: vec4<u32>,
    core1: vec4<u32>,
    n: f32,
    b0: f32,
    moments: vec4<f32>
) -> f32 {
    let slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    let slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    let slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    let slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    let slot4 = nmt_core_slot(core1.x, nmt_core_heavy_steps(core1.x, codes));
    let slot5 = nmt_core_slot(core1.y, nmt_core_heavy_steps(core1.y, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4<f32>(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4<f32>(slot0.y, slot1.y, slot2.y, slot3.y),
        vec4<f32>(slot4.x, slot5.x, 0.0, 0.0),
        vec4<f32>(slot4.y, slot5.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}
