// Both ends and tail: a pixel's nearest and its farthest fragment one by one, all others by their sums; blending keeps
// them. Written by nmt 0.1.0.
//
// Frame:  v0 and v1 are the least and the greatest view depth of what is transparent. Targets are cleared and blended as
//         NmtSums says.
// Pass 1, for every fragment of view depth v and opacity alpha: write nmt_pass1(v, v0, v1, alpha).
// Pass 2: T = nmt_pass2(v, v0, v1, alpha, ...) of the targets of pass 1 and the same bits as there. Add up alpha T C and
//         alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-0-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
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
// Provenance: nmt 0.1.0, commit a11f08561d89, backend fused, seed 1, epochs 1500, dataset 381d5ef98678649c941c2c4c7bd79249c8745cf2398e785a10c209e31313e407.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.982e-3, worst 1.000.

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 24>(
    mat4x4<f32>(vec4<f32>(1.4317298f, 2.191651f, 6.727079f, -3.751045f), vec4<f32>(-0.060478445f, 0.11461254f, -0.1646913f, -0.35877922f), vec4<f32>(0.06289728f, -0.1580284f, 0.07473804f, 0.13326874f), vec4<f32>(7.0914807f, 5.603903f, 0.58649045f, -2.2741826f)),
    mat4x4<f32>(vec4<f32>(-3.4689405f, -8.352193f, -1.883482f, 2.9752848f), vec4<f32>(0.74735314f, 6.36241f, -5.499922f, 0.58222175f), vec4<f32>(-4.0372705f, -7.862177f, 1.2919396f, -18.645775f), vec4<f32>(-4.5778747f, -9.596229f, -0.32165408f, 3.9021926f)),
    mat4x4<f32>(vec4<f32>(9.54276f, -0.0893324f, 0.5160126f, 2.5115654f), vec4<f32>(-0.91783404f, 0.8151581f, 3.3516243f, -0.12292782f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.1352023f, 1.2119503f, -2.8251603f, -3.9147177f), vec4<f32>(-0.123959064f, -0.18036275f, 0.016107535f, 0.0041036624f), vec4<f32>(0.15222655f, 0.018420562f, 0.0005397574f, 0.069991186f), vec4<f32>(-29.524288f, -0.110847086f, -8.73089f, -7.214845f)),
    mat4x4<f32>(vec4<f32>(-6.5716004f, -0.14318708f, -5.8059306f, -5.389088f), vec4<f32>(-1.6517118f, 5.489244f, -3.0327194f, 9.124509f), vec4<f32>(1.7978463f, 0.8188869f, -0.6640067f, -12.607745f), vec4<f32>(-0.5151307f, -6.743748f, 1.172957f, -8.333976f)),
    mat4x4<f32>(vec4<f32>(-19.125027f, -1.8108281f, 7.6768246f, -0.95093083f), vec4<f32>(1.8843677f, 3.0185444f, -3.3729057f, 0.74029505f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(3.6519125f, 1.5300299f, -2.5522842f, 1.2378398f), vec4<f32>(-0.28464514f, -0.121829726f, -0.4616278f, 0.32837835f), vec4<f32>(0.039522942f, -0.042005762f, -0.05278465f, 0.0013193002f), vec4<f32>(-29.194708f, 6.2694902f, -10.627289f, 2.0877857f)),
    mat4x4<f32>(vec4<f32>(-15.559965f, 0.87976754f, 4.560895f, 1.7619933f), vec4<f32>(1.689421f, 3.5073512f, 2.3340404f, 1.6568208f), vec4<f32>(-4.8063483f, -8.044831f, -4.486502f, 5.4426866f), vec4<f32>(0.7073662f, -3.271601f, 2.5592906f, -0.84171367f)),
    mat4x4<f32>(vec4<f32>(-2.4559228f, 8.6417265f, -3.190338f, -6.912059f), vec4<f32>(5.0728116f, -0.9842609f, -0.053381015f, -0.48948488f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.8468652f, 0.49485567f, -1.4169084f, -3.5201824f), vec4<f32>(-0.18228158f, -0.07358338f, -0.09071074f, -0.112331256f), vec4<f32>(0.14616138f, 0.0965952f, 0.080804884f, 0.55146295f), vec4<f32>(-62.268635f, 2.377452f, -246.12312f, 12.9031925f)),
    mat4x4<f32>(vec4<f32>(3.3802698f, 2.0192537f, -1.4338511f, -6.659293f), vec4<f32>(1.6852884f, 5.941192f, -0.8342008f, 0.6035608f), vec4<f32>(0.82760155f, 4.488113f, -2.2999249f, 0.8024826f), vec4<f32>(2.7274487f, -5.7792253f, -0.42838722f, -0.6982501f)),
    mat4x4<f32>(vec4<f32>(-1.4576274f, -2.8315725f, 0.17714114f, -2.9663568f), vec4<f32>(-2.2372859f, -3.2930517f, 1.4550539f, -1.765235f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.057183642f, 3.3389902f, -3.542497f, 5.0050306f), vec4<f32>(-6.2289014f, -0.45804322f, -0.21599492f, 0.4667237f), vec4<f32>(1.8799043f, 0.47896728f, 0.021543205f, -0.11040543f), vec4<f32>(-47.834312f, 12.908583f, -50.006176f, 12.68344f)),
    mat4x4<f32>(vec4<f32>(-7.166474f, -3.2794552f, -7.324561f, -11.086611f), vec4<f32>(0.08703052f, 3.6560774f, -6.625171f, -9.83278f), vec4<f32>(-1.1809275f, 4.1829724f, -2.0076742f, -2.3111808f), vec4<f32>(-0.5327761f, 6.0015187f, 8.269169f, 7.0828376f)),
    mat4x4<f32>(vec4<f32>(1.2172115f, 2.3474467f, 6.6875763f, 1.2265673f), vec4<f32>(-0.84486043f, -8.57313f, -4.2065907f, 0.25463516f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(1.2139328f, 0.5683898f, -8.752637f, -2.3898895f), vec4<f32>(-0.20198928f, -0.1401188f, 0.0076826406f, -0.1317224f), vec4<f32>(-0.15326285f, 0.02953581f, 0.005616545f, -0.18556674f), vec4<f32>(-74.320786f, -63.76376f, -0.40675116f, 0.7189491f)),
    mat4x4<f32>(vec4<f32>(-16.147669f, -42.632393f, -0.06485997f, -0.7695405f), vec4<f32>(-1.2008938f, -1.9657207f, -0.032466654f, -0.61546624f), vec4<f32>(-2.8951817f, -0.36982724f, -0.08826993f, -0.04208433f), vec4<f32>(-0.98575014f, 0.2650366f, 0.07488505f, 0.25202516f)),
    mat4x4<f32>(vec4<f32>(6.882571f, 3.3037403f, -0.026097342f, -0.8564453f), vec4<f32>(2.0067384f, 2.481892f, -8.339849f, -3.6626396f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-8.682326f, 2.5371814f, 1.7621095f, 5.163456f), vec4<f32>(-0.04183948f, -0.037750814f, -0.26279384f, 0.121042185f), vec4<f32>(0.14225043f, 0.2631145f, 0.027440522f, -0.017610844f), vec4<f32>(-0.8747293f, 0.17003822f, -1.4690326f, -40.289505f)),
    mat4x4<f32>(vec4<f32>(-2.7966685f, -0.4179041f, 0.9744584f, -15.364956f), vec4<f32>(-2.036611f, 1.2122619f, 3.4936776f, -8.379077f), vec4<f32>(-0.058713485f, 6.524647f, 3.5530078f, -2.8674653f), vec4<f32>(1.0533278f, -9.348143f, -6.0639396f, 6.181865f)),
    mat4x4<f32>(vec4<f32>(-0.589845f, -0.031207768f, 1.9180096f, 8.55072f), vec4<f32>(-5.5204773f, -12.310446f, -1.1147383f, 2.9653676f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-4.5687118f, 3.9562721f, -1.7089586f, 2.9960845f), vec4<f32>(0.3399617f, 0.0059691444f, 0.021057142f, -0.3196038f), vec4<f32>(-0.071923144f, -0.06025869f, -0.031907883f, 0.4514363f), vec4<f32>(9.062922f, 2.733657f, 6.4316134f, -15.971774f)),
    mat4x4<f32>(vec4<f32>(-4.166488f, 4.485879f, 7.3074393f, 2.037908f), vec4<f32>(4.997433f, -1.8625803f, -0.15396278f, -5.600335f), vec4<f32>(-8.760638f, -5.704339f, 0.5472291f, 4.4456587f), vec4<f32>(-1.0656345f, -2.1319022f, -0.6854484f, 3.65672f)),
    mat4x4<f32>(vec4<f32>(1.3734262f, 0.061342563f, 1.6200686f, -1.0755827f), vec4<f32>(-0.47460523f, -1.7739332f, -2.109841f, -0.5640859f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(-0.027982399f, -1.5974598f, -0.26108313f, -0.44758323f), vec4<f32>(-2.5582268f, -11.182121f, -14.092224f, 0.48459366f), vec4<f32>(-0.3511142f, 0.19059174f, -4.006024f, -2.5721786f), vec4<f32>(0.84639025f, 0.71176577f, -2.404681f, -0.99055934f)),
    mat4x4<f32>(vec4<f32>(-0.57720464f, -0.21008737f, -2.6325812f, 0.8914639f), vec4<f32>(0.6590815f, -4.3658676f, -1.1448785f, 0.9430832f), vec4<f32>(0.9581404f, 0.24328482f, -1.1340039f, 0.6141433f), vec4<f32>(1.8922666f, -1.7110677f, 1.5307064f, -0.12547962f)),
    mat4x4<f32>(vec4<f32>(1.1394193f, 2.147547f, -3.7314217f, 1.0358683f), vec4<f32>(0.29220706f, 0.64925766f, 0.027457166f, 1.0072486f), vec4<f32>(-0.2511268f, -1.6159694f, -0.30810866f, -0.7661485f), vec4<f32>(-0.61015004f, -11.99502f, -1.4946063f, 0.6136324f)),
    mat4x4<f32>(vec4<f32>(0.48261017f, 0.31079328f, 3.0939977f, 0.57151663f), vec4<f32>(0.50222915f, -2.8824496f, 3.6301494f, -0.72832125f), vec4<f32>(1.2419188f, 6.1217794f, 0.9959902f, -2.6530755f), vec4<f32>(1.0656027f, -0.80007607f, 0.0050528687f, 0.3594124f)),
    mat4x4<f32>(vec4<f32>(0.4766542f, -0.6569586f, 0.09155712f, 0.20338818f), vec4<f32>(0.061753884f, -5.875319f, 0.8493232f, 1.9528707f), vec4<f32>(-0.098926954f, -0.076384485f, 0.25303012f, -0.44919094f), vec4<f32>(-1.6619605f, -1.0296458f, -0.80755866f, 1.041455f)),
    mat4x4<f32>(vec4<f32>(-0.28459114f, -0.23509726f, 2.6095576f, 0.3711765f), vec4<f32>(-0.19801985f, 1.3067058f, -1.8208132f, -0.21006615f), vec4<f32>(17.968971f, 1.0652256f, -3.5379207f, -2.321049f), vec4<f32>(5.994907f, 7.3533573f, 7.0550814f, 3.9401383f)),
    mat4x4<f32>(vec4<f32>(0.5775448f, -0.6548861f, -1.2006896f, 4.452374f), vec4<f32>(1.9466195f, 2.9656568f, -9.168257f, 3.7066925f), vec4<f32>(0.010909571f, -4.760984f, -1.1203054f, -0.30235562f), vec4<f32>(-0.37076265f, -0.46530518f, -3.4178302f, 0.21127713f)),
    mat4x4<f32>(vec4<f32>(1.3553408f, 0.25208706f, -0.32089064f, 0.3037293f), vec4<f32>(2.6422317f, 0.23288439f, 5.304172f, -1.3016943f), vec4<f32>(-2.056287f, -5.8164153f, 0.2749001f, 0.9006329f), vec4<f32>(1.7194343f, -0.39653745f, 0.64695686f, -1.3309863f)),
    mat4x4<f32>(vec4<f32>(-2.6109602f, 0.57091993f, -0.19495131f, 0.2190746f), vec4<f32>(-0.38188392f, -8.280481f, -0.21908845f, -8.753874f), vec4<f32>(0.16272675f, 0.90584135f, -0.7099145f, 0.19912654f), vec4<f32>(-1.0646359f, 0.06383801f, -0.65292776f, -0.6046393f)),
    mat4x4<f32>(vec4<f32>(-4.3083715f, 1.2327925f, -0.35576007f, -0.13176583f), vec4<f32>(-1.8031285f, 1.1302786f, -0.87164867f, 1.0115228f), vec4<f32>(2.5004644f, -0.8605538f, -0.47234374f, -0.01138025f), vec4<f32>(-2.1511698f, 1.2068214f, -0.29616776f, 2.0578663f)),
    mat4x4<f32>(vec4<f32>(-7.250049f, -0.6875534f, -0.26806444f, 1.6461489f), vec4<f32>(1.9680052f, -0.7389492f, -0.12802388f, -1.5441029f), vec4<f32>(0.33719414f, -2.705163f, -0.33733937f, 0.30897093f), vec4<f32>(0.3458763f, -0.32137284f, -0.20389776f, -0.20329195f)),
    mat4x4<f32>(vec4<f32>(-4.9958253f, 0.5969844f, -0.0012780179f, 0.25512967f), vec4<f32>(1.0859861f, 0.4249844f, -0.32204592f, -0.25992328f), vec4<f32>(-1.1684371f, -2.8410194f, -1.0051937f, 1.1974963f), vec4<f32>(-15.443957f, 1.2945144f, -0.8225332f, -0.3074546f)),
    mat4x4<f32>(vec4<f32>(2.9357085f, 0.20545141f, 0.19485117f, 0.91170377f), vec4<f32>(0.50134575f, -2.171273f, -0.5857367f, -1.5256736f), vec4<f32>(-2.9058325f, 0.10822418f, -0.13411592f, 1.1221116f), vec4<f32>(-1.9692392f, 0.76492536f, -0.39793473f, -2.617637f)),
    mat4x4<f32>(vec4<f32>(-0.2213089f, 0.18984394f, -0.8296945f, 2.0599499f), vec4<f32>(-0.9738273f, 0.39160827f, -0.21650149f, -1.6428514f), vec4<f32>(-0.46032265f, 0.99766743f, -0.552936f, -5.322368f), vec4<f32>(-0.17638971f, -7.9630685f, 0.0143214f, 8.131895f)),
    mat4x4<f32>(vec4<f32>(-4.054167f, 0.057102606f, -0.42363355f, -0.16980857f), vec4<f32>(-0.501281f, -5.155497f, -0.13397385f, -18.643253f), vec4<f32>(-0.4815355f, -1.2359868f, -0.7334735f, -1.0535395f), vec4<f32>(-1.0420411f, -0.18130244f, -0.5297515f, -3.1283865f)),
    mat4x4<f32>(vec4<f32>(-0.9608823f, -1.173892f, -0.93231755f, -1.0004952f), vec4<f32>(-0.8453368f, -1.7416643f, -0.041984737f, 0.45407665f), vec4<f32>(-2.6328058f, 0.03621532f, -0.80184144f, -0.12543038f), vec4<f32>(-5.4342036f, -0.17941746f, -0.5029284f, -0.67339176f)),
    mat4x4<f32>(vec4<f32>(-0.7316836f, -0.2475589f, -1.5897065f, -0.2768745f), vec4<f32>(0.8213411f, 2.9054494f, -8.956052f, 1.0110811f), vec4<f32>(0.48169297f, 0.76748884f, -1.2648801f, -0.32161984f), vec4<f32>(-2.0701137f, -1.8383626f, 1.4241215f, -1.4391695f)),
    mat4x4<f32>(vec4<f32>(-1.8213843f, -2.6883566f, -2.023306f, -0.44395453f), vec4<f32>(0.2872357f, -3.1867425f, 0.3486228f, -0.93589634f), vec4<f32>(-0.20337726f, -0.32137153f, -0.99396664f, -0.0847146f), vec4<f32>(-1.0395169f, 3.8884697f, 3.523059f, -0.92916214f)),
    mat4x4<f32>(vec4<f32>(-1.1685339f, 1.5040996f, 2.2066386f, -0.74584043f), vec4<f32>(-1.0791676f, 0.7468052f, 1.207109f, -1.340223f), vec4<f32>(1.173599f, 1.1568028f, 0.320179f, -0.41836986f), vec4<f32>(0.11363276f, -0.17460881f, 0.71926916f, -0.3238061f)),
    mat4x4<f32>(vec4<f32>(1.8713467f, -2.7534688f, 0.39546612f, -0.38263693f), vec4<f32>(-1.0851198f, -1.6376357f, -0.113489404f, -0.2849405f), vec4<f32>(0.7609707f, 3.4911816f, 1.7288836f, -0.6940429f), vec4<f32>(0.84274054f, -0.5509994f, -0.8265054f, -1.5711111f)),
    mat4x4<f32>(vec4<f32>(0.09381255f, -0.4158294f, 0.9894585f, 0.2408242f), vec4<f32>(-16.54033f, -0.7249689f, -0.55347764f, -1.4864933f), vec4<f32>(-0.31491104f, 1.0514522f, -1.4282348f, -0.12754518f), vec4<f32>(-11.089369f, -0.42137167f, -4.687089f, -0.44227016f)),
    mat4x4<f32>(vec4<f32>(-0.139781f, 0.16992623f, -1.0356948f, -0.7625751f), vec4<f32>(-1.0477134f, -0.7334245f, -7.0605564f, -0.49583894f), vec4<f32>(-5.4379754f, 1.6187942f, 0.1498525f, -0.5862648f), vec4<f32>(-10.6316f, 0.5565308f, -2.2774708f, -0.30862746f)),
    mat4x4<f32>(vec4<f32>(-0.95374274f, -0.16887577f, 1.0055864f, -0.108160555f), vec4<f32>(-0.89210844f, 8.238755f, -11.546918f, 0.86600065f), vec4<f32>(0.16547705f, -6.461979f, -0.7165446f, -0.7399076f), vec4<f32>(3.6122646f, -0.33972144f, -6.508603f, 0.5218143f)),
    mat4x4<f32>(vec4<f32>(-0.19755183f, -1.4309961f, -0.23493266f, -2.4542491f), vec4<f32>(1.4060878f, 3.7502568f, -0.65528446f, 0.19468662f), vec4<f32>(-0.02978186f, -1.2009946f, 0.46360138f, -2.19065f), vec4<f32>(-0.43914932f, 2.293388f, -0.28565758f, -0.76630586f)),
    mat4x4<f32>(vec4<f32>(0.6045855f, -0.32436177f, -0.5969974f, 0.7781134f), vec4<f32>(-2.0271108f, -25.982105f, 3.0252635f, -1.8011206f), vec4<f32>(0.0511712f, -0.24000557f, 0.6970283f, -0.30310902f), vec4<f32>(-0.626127f, -1.0534695f, -2.2961197f, -0.13226692f)),
    mat4x4<f32>(vec4<f32>(2.343736f, -6.217139f, 0.6712475f, -0.27228785f), vec4<f32>(2.8466034f, -0.7898569f, -0.29988006f, -0.15770356f), vec4<f32>(1.2730513f, -1.385769f, 0.84351015f, -0.8792476f), vec4<f32>(1.739586f, -2.8399658f, -3.197824f, -0.3127936f)),
    mat4x4<f32>(vec4<f32>(-0.084362775f, -3.91136f, -4.428161f, 0.3635336f), vec4<f32>(0.27836874f, -0.14268269f, -0.51529294f, -0.538423f), vec4<f32>(0.7830889f, -0.0182398f, -0.5262698f, -1.0518626f), vec4<f32>(0.9851691f, 0.3181157f, -0.28284815f, 0.058373082f)),
    mat4x4<f32>(vec4<f32>(-3.414534f, -0.5341867f, -0.18411401f, -0.61921275f), vec4<f32>(-1.510084f, -0.26633763f, -1.3305926f, -0.8619801f), vec4<f32>(-1.5470308f, -1.4743968f, -38.504658f, 0.30969214f), vec4<f32>(-0.14469263f, -0.49709392f, -3.0121145f, 0.079902336f)),
    mat4x4<f32>(vec4<f32>(-0.097979546f, -0.25242627f, 3.8054092f, 0.5641174f), vec4<f32>(0.65214485f, 0.51018125f, -0.44167098f, -1.1165974f), vec4<f32>(-0.46976346f, 2.875159f, -1.2651387f, 0.7852967f), vec4<f32>(2.0540571f, -1.5942682f, -3.18146f, -11.497131f)),
    mat4x4<f32>(vec4<f32>(0.46952778f, 0.87392676f, 0.20043781f, 0.1656688f), vec4<f32>(-0.10401463f, -3.3204172f, -3.3489892f, -1.9651427f), vec4<f32>(-3.1124127f, -6.1396356f, 14.753386f, 33.852314f), vec4<f32>(1.0041435f, 8.950814f, -6.8097973f, 9.132108f)),
    mat4x4<f32>(vec4<f32>(0.024301916f, -0.34294394f, 3.6597943f, -2.9148378f), vec4<f32>(3.058157f, -15.93681f, -4.1251917f, -5.969938f), vec4<f32>(-1.4033467f, 0.22916655f, 0.8508055f, 0.32185614f), vec4<f32>(-0.40119967f, -2.2542157f, -0.438894f, -0.59386617f)),
    mat4x4<f32>(vec4<f32>(-0.7943322f, -1.1189687f, 0.35319355f, 0.054232705f), vec4<f32>(1.8380309f, -0.83985823f, 0.67006063f, -0.7411227f), vec4<f32>(0.63809717f, 1.5535564f, -0.34432167f, -0.55257744f), vec4<f32>(-0.64813596f, -0.5104218f, 1.0521047f, 0.48838916f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(1.9449311f, -5.905165f, -8.407714f, -6.7975154f),
    vec4<f32>(-11.532762f, 1.2303761f, -0.8146868f, 1.1261033f),
    vec4<f32>(-1.4014693f, -1.9073353f, -2.223379f, -0.7291616f),
    vec4<f32>(-8.380391f, -0.18974769f, 0.49893165f, 0.3580487f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.17358325f, 0.13816246f, 0.21617825f, -0.103588134f),
    vec4<f32>(-0.26226506f, 0.061416283f, -0.053857677f, -0.2043406f),
    vec4<f32>(0.09141985f, 0.10511065f, 0.17135085f, -0.13144962f),
    vec4<f32>(0.12578346f, 0.15885915f, 0.08919641f, -0.61215395f)
);
const NMT_B3: f32 = -1.4909608f;

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
const NMT_HEAVY: u32 = 0u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const NMT_SLOTS: u32 = 2u;
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


// Both ends of a pixel stand in two channels of a render target, of which blending keeps the greater: the codes of
// their slots as numbers that rise as codes do, none of them subnormal, infinite or NaN.
fn nmt_core_end_value(code: u32) -> f32 {
    // Steps of absorbance leave a bit unused, which is left out.
    let low = NMT_END_BITS - 1u;
    let rank = i32(((code >> NMT_END_BITS) << low) | (code & ((1u << low) - 1u))) - 0x40000000;
    return bitcast<f32>(select(0x80800000u + u32(-1 - rank), 0x00800000u + u32(rank), rank >= 0));
}

// The code of such a number; 0, the empty slot, of what the target is cleared to.
fn nmt_core_end_code(value: f32) -> u32 {
    let low = NMT_END_BITS - 1u;
    let bits = bitcast<u32>(max(value, -3.9999998));
    let rank = i32(bits & 0x7fffffffu) - 0x00800000;
    let packed_code = u32(select(rank, -1 - rank, bits > 0x7fffffffu) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// What a fragment writes there, by its steps; the nearest comes first. One that absorbs nothing is no end.
fn nmt_core_end_values(steps: vec2<u32>) -> vec2<f32> {
    let absorbs = steps.y > 0u;
    return vec2<f32>(
        nmt_core_end_value(select(0u, nmt_core_nearest_code(steps), absorbs)),
        nmt_core_end_value(select(0u, nmt_core_farthest_code(steps), absorbs))
    );
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
fn nmt_core_ends(values: vec2<f32>) -> vec2<u32> {
    let nearest = nmt_core_end_code(values.x);
    let farthest = nmt_core_end_code(values.y);
    let apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return vec2<u32>(nearest, select(0u, farthest, apart));
}

// Where the moments of the tail leave T open by no more than this, it is the middle of what they allow, and the network
// is not asked. 0 always asks it; 1/256 cannot be seen.
const NMT_OPEN: f32 = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments: Markov's bounds.
fn nmt_core_bounds(x: f32, m1: f32, m2: f32, m3: f32, m4: f32) -> vec2<f32> {
    let mean = m1 * 0.9999;
    let second = m2 * 0.9999 + 3.3333334e-5;
    let third = m3 * 0.9999;
    let square = mean * mean;
    let variance = max(second - square, 1e-7);
    let per_deviation = 1.0 / sqrt(variance);
    let per_variance = per_deviation * per_deviation;
    let skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    let d = clamp((m4 * 0.9999 + 2e-5 - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    let y = (x - mean) * per_deviation;
    let q = (y * (y - skewness) - 1.0) / d;
    let at = 1.0 / (1.0 + y * y + q * q * d);
    let rest = 1.0 - at;
    let linear_ = y - q * skewness;
    let per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    let between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    let lower = select(select(0.0, rest, y > 0.5 * skewness), between, 0.0 > q);
    return vec2<f32>(lower, lower + at);
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
fn nmt_core_weigh(z: f32, absorbance: f32, depths0: vec4<f32>, absorbances0: vec4<f32>, n: f32, b0: f32,
    moments: vec4<f32>) -> f32 {
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
    let far = select(depths0.x, depths0.y, absorbances0.y > 0.0);
    let center = 0.5 * (depths0.x + far);
    let half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    let per_h = 1.0 / half_range;
    let moved1 = (rest1_2 - center * rest0_2) * per_h;
    let moved2 = (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)) * (per_h * per_h);
    let moved3 = (rest3_2 - center * rest2_2 - center * (rest2_2 - center * rest1_2) - center * (rest2_2 - center
        * rest1_2 - center * (rest1_2 - center * rest0_2))) * (per_h * per_h * per_h);
    let moved4 = (rest4_2 - center * rest3_2 - center * (rest3_2 - center * rest2_2) - center * (rest3_2 - center
        * rest2_2 - center * (rest2_2 - center * rest1_2)) - center * (rest3_2 - center * rest2_2 - center * (rest2_2
        - center * rest1_2) - center * (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)))) * (per_h
        * per_h * per_h * per_h);
    let x = clamp((z - center) * per_h, -1.0, 1.0);
    let removed = select(0.0, absorbance, in_core_2 == 0.0);
    let tail0 = rest0_2 - removed;
    let tail1 = moved1 - removed * x;
    let tail2 = moved2 - removed * x * x;
    let tail3 = moved3 - removed * x * x * x;
    let tail4 = moved4 - removed * x * x * x * x;
    let others = count_2 - select(0.0, 1.0, removed > 0.0);
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
        let known = min(exp(-(front_2 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    let bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    if (NMT_OPEN > 0.0) {
        let bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * ((1.0 + abs(center)) * per_h + 1.0) * 4.7683716e-7
            * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h
            + 1.0) / (max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0)
            * (1.0 - mean * mean), 1e-7) * max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
            * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7));
        let most = min(exp(-(front_2 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        let least = min(exp(-(front_2 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            let middle = 0.5 * (most + least);
            return middle;
        }
    }
    return exp(-front_2) * nmt_transmittance(mat3x4<f32>(vec4<f32>(x, log2(others) * 0.33333334 - 1.0,
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
    n: f32,
    b0: f32,
    moments: vec4<f32>
) -> f32 {
    let slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    let slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4<f32>(slot0.x, slot1.x, 0.0, 0.0),
        vec4<f32>(slot0.y, slot1.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    sums0: vec4<f32>,
    // (b4, number of fragments that absorb, 0, 0): blended by addition, cleared to 0.
    sums1: vec4<f32>,
    // (nearest, farthest, 0, 0) as nmt_core_end_values has them: blended by max, cleared to -3e38. Two channels, f32
    // always.
    range: vec4<f32>,
}

// Pass 1 in one call. v is distance along the view direction, the same bits in both passes; v0 and v1 are the least and
// the greatest v of the scene.
fn nmt_pass1(v: f32, v0: f32, v1: f32, alpha: f32) -> NmtSums {
    let steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), nmt_core_codes(v0, v1));
    let absorbance = nmt_core_absorbance(steps);
    let b = nmt_core_moments(steps);
    let n = select(0.0, 1.0, steps.y > 0u);
    var sums: NmtSums;
    sums.sums0 = vec4<f32>(absorbance, b.x, b.y, b.z);
    sums.sums1 = vec4<f32>(b.w, n, 0.0, 0.0);
    sums.range = vec4<f32>(nmt_core_end_values(steps), 0.0, 0.0);
    return sums;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>, range: vec4<f32>) -> f32 {
    let codes = nmt_core_codes(v0, v1);
    let steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    let core = vec4<u32>(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, sums1.y, sums0.x, vec4<f32>(sums0.y, sums0.z, sums0.w, sums1.x));
}

// Resolve: what lies over the background, of the sum that pass 2 has made, and in alpha how much of the background
// shows through: result.rgb + result.a * background. As a blend state: source factor one, destination factor source
// alpha.
fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>) -> vec4<f32> {
    let behind = exp(-sums0.x);
    let scale = select(0.0, (1.0 - behind) / max(weighted.w, 1e-37), weighted.w > 0.0);
    return vec4<f32>(scale * weighted.x, scale * weighted.y, scale * weighted.z, behind);
}
