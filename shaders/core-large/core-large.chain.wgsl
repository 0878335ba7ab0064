// Core and tail: a pixel's nearest, its farthest and its 6 heaviest other fragments one by one, all others by their sums.
// Written by nmt 0.1.0.
//
// Frame:  codes = nmt_core_codes(v0, v1), v0 and v1 the least and the greatest view depth of what is transparent. Clear to 0 the buffer
//         nmt_core, 8 words a pixel, and targets for b0, 4 moments and n, which are added up by blending in f32.
// Pass 1, for every fragment of view depth v and opacity alpha:
//         steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes)
//         nmt_core_insert(pixel, steps, codes)
//         add to b0: nmt_core_absorbance(steps); to the moments: nmt_core_moments(steps); to n: 1 where steps.y > 0, else 0
// Pass 2: T = nmt_core_transmittance(steps, codes, core0, ..., n, b0, moments), the core as vectors of four words;
//         steps must come from the same expressions as in pass 1. Add up alpha T C and alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

// Neural moment transparency: network 'core-large', 9-32-16-1, 816 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
//
// Features, set 'core-6-4', in this order: x, count, ln_b0, lower, upper, mean, spread, inner_mean, inner_spread.
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
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 3, epochs 1500, dataset 6b20a1357fe130e18d08f55d5155b4481667abb47f55abc52cc6366e964d37ed.
// Measured on fresh pixels of the training distribution: mean squared error of T 1.815e-3, worst 1.000.

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 24>(
    mat4x4<f32>(vec4<f32>(6.204872f, 2.8133395f, 3.8717713f, 3.4365928f), vec4<f32>(-0.101355486f, -0.80166835f, -0.046910837f, 0.07250359f), vec4<f32>(-0.021604054f, 1.72706f, -0.054340035f, -0.06785708f), vec4<f32>(-6.946954f, -2.300351f, -3.4141264f, 3.5611715f)),
    mat4x4<f32>(vec4<f32>(-2.2312346f, 1.4460495f, 1.350287f, 0.2781561f), vec4<f32>(-3.5046957f, -2.017726f, -2.374801f, 4.420415f), vec4<f32>(1.0577246f, 2.8064923f, 0.7623902f, 3.4509523f), vec4<f32>(2.6835322f, -0.70754516f, 6.5579576f, -10.669322f)),
    mat4x4<f32>(vec4<f32>(0.4006354f, 0.24350096f, 0.663123f, -0.6519766f), vec4<f32>(5.264841f, -3.403898f, 1.3743782f, -0.2183028f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.7981963f, -1.4129393f, -1.0607893f, 1.5912263f), vec4<f32>(0.05322063f, 0.3539213f, -0.19883794f, -0.013613466f), vec4<f32>(-0.10299524f, -0.35735005f, 0.02214596f, -0.042126805f), vec4<f32>(5.633362f, -36.578434f, 7.033086f, 0.8023797f)),
    mat4x4<f32>(vec4<f32>(8.898151f, -8.121007f, -17.221498f, 1.0746595f), vec4<f32>(4.0676994f, 1.5276451f, -2.8564644f, -8.732235f), vec4<f32>(2.6934555f, -37.686146f, -0.9592489f, 1.7140763f), vec4<f32>(-3.4736412f, -0.86801314f, 3.6190457f, 11.374533f)),
    mat4x4<f32>(vec4<f32>(-5.504661f, -0.7658614f, 1.7203724f, 0.19787298f), vec4<f32>(0.72156316f, 4.796095f, 1.7140621f, 1.3453492f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-1.6326102f, -1.8870184f, 3.5283074f, 3.7838643f), vec4<f32>(-0.13681301f, 0.069581605f, 0.13528098f, 0.88836443f), vec4<f32>(-0.006082848f, -0.1336125f, -0.029393682f, 0.2799977f), vec4<f32>(2.80411f, 4.927762f, 17.299143f, 4.7893004f)),
    mat4x4<f32>(vec4<f32>(-4.91337f, -6.7606926f, -11.6568775f, -4.4463596f), vec4<f32>(-1.8343529f, 7.744741f, -5.747167f, -4.1380253f), vec4<f32>(-9.301559f, -4.6508403f, -0.5542998f, 10.99322f), vec4<f32>(1.5717273f, -10.986497f, 3.317018f, 0.8478676f)),
    mat4x4<f32>(vec4<f32>(8.42374f, 0.26131183f, 10.281987f, -0.10212514f), vec4<f32>(-3.0205727f, 0.6666693f, -0.14254783f, -2.0059035f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.755177f, -4.042959f, 0.5506073f, 4.557005f), vec4<f32>(0.6095984f, 0.045305915f, -0.14754099f, 0.30063155f), vec4<f32>(-0.29475665f, 0.60104185f, 0.0068221376f, 0.085523844f), vec4<f32>(-0.14942089f, 4.526219f, -119.97225f, -1.5962425f)),
    mat4x4<f32>(vec4<f32>(-0.37608734f, -2.937702f, -8.477666f, -4.516912f), vec4<f32>(-0.13451223f, -1.5557053f, -9.081086f, -2.081463f), vec4<f32>(4.2415347f, 0.22778013f, -2.1703372f, 9.726672f), vec4<f32>(-3.3759682f, 1.3922427f, 10.223112f, -1.0208558f)),
    mat4x4<f32>(vec4<f32>(-1.0549339f, -0.38253945f, 6.04355f, -11.763591f), vec4<f32>(-4.324575f, -4.293104f, -0.33705884f, 2.524719f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-6.509173f, -0.6667411f, -0.84195983f, 1.5420114f), vec4<f32>(0.066726476f, -0.38902503f, 1.0896145f, -0.08918266f), vec4<f32>(-0.06429821f, 0.14853202f, -0.6678769f, -0.0494696f), vec4<f32>(1.1424367f, 6.3754134f, 5.2589126f, -137.67015f)),
    mat4x4<f32>(vec4<f32>(-0.44659847f, -5.7695274f, -8.623573f, -26.390863f), vec4<f32>(-0.36106414f, 8.934726f, -2.9854681f, -1.5266478f), vec4<f32>(2.0882123f, 0.1922003f, -2.2155347f, 0.2369156f), vec4<f32>(-0.01522975f, 0.1292762f, 3.1306255f, -1.8630923f)),
    mat4x4<f32>(vec4<f32>(0.11624097f, -74.13805f, 3.5565298f, 4.5083303f), vec4<f32>(-6.1390705f, -1.2168869f, 1.0260584f, 2.4315135f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.5480623f, 4.3443193f, -6.0640097f, 2.0157316f), vec4<f32>(0.44361994f, -0.09958827f, -0.002614725f, -0.06954539f), vec4<f32>(-0.21089426f, -0.06859401f, -0.00012028825f, 0.15595998f), vec4<f32>(0.55394566f, 5.7900405f, 0.04844435f, 2.5593207f)),
    mat4x4<f32>(vec4<f32>(0.71850526f, -0.09873017f, -0.024438646f, -0.7414565f), vec4<f32>(2.6148055f, -5.3578644f, -0.02481355f, 3.457171f), vec4<f32>(-13.242175f, -3.4362228f, 0.033985093f, 2.4870965f), vec4<f32>(0.78623194f, 0.598498f, 0.02698959f, -8.410853f)),
    mat4x4<f32>(vec4<f32>(0.21221437f, 0.37101457f, 0.005282033f, 6.9881825f), vec4<f32>(1.5699171f, 3.5130217f, -6.0419717f, -1.0249234f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.90750986f, 2.6633465f, -0.8052706f, -6.1982207f), vec4<f32>(0.075742856f, -0.22764629f, -0.24734835f, 0.0746464f), vec4<f32>(-0.0025613639f, 0.1376831f, -0.13632917f, -0.02001572f), vec4<f32>(24.988588f, 4.872218f, 0.8445787f, 0.37891808f)),
    mat4x4<f32>(vec4<f32>(-22.746803f, 2.0633085f, 2.8822708f, 0.13335148f), vec4<f32>(3.3876948f, 2.988283f, 8.079052f, -0.19542086f), vec4<f32>(-2.2974532f, 0.31802145f, -15.241872f, 0.3332559f), vec4<f32>(-3.4267986f, -3.9556756f, -4.8386097f, 0.17851198f)),
    mat4x4<f32>(vec4<f32>(-0.8658033f, 8.452439f, -0.4347663f, -0.037509352f), vec4<f32>(0.7509301f, -2.810309f, 0.034173217f, -6.0997205f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.17954855f, -2.530912f, -0.3779119f, 1.7662483f), vec4<f32>(0.46774656f, -0.6943666f, -0.060912203f, -0.28464755f), vec4<f32>(-0.18244119f, 0.2409339f, 0.1257029f, -0.045022108f), vec4<f32>(6.0069795f, 7.9403286f, -8.667023f, 4.4826617f)),
    mat4x4<f32>(vec4<f32>(-0.67186695f, -7.1475515f, -1.282027f, -9.123962f), vec4<f32>(0.20577912f, 1.2996395f, 6.1463923f, -0.20032407f), vec4<f32>(3.8142853f, -3.8269134f, -1.9772706f, 3.074882f), vec4<f32>(8.014048f, 0.34990573f, -7.0761423f, -6.848341f)),
    mat4x4<f32>(vec4<f32>(-0.5402738f, 3.9567156f, -5.1775007f, -0.62641615f), vec4<f32>(-7.0803804f, 0.19455366f, 2.7288408f, 3.1864016f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(0.0014794759f, -1.6126761f, 0.54000443f, 0.9577151f), vec4<f32>(-0.35623825f, -0.39092347f, -0.2153758f, -0.37392086f), vec4<f32>(-0.27367756f, -3.3168862f, 0.52879083f, -0.9685586f), vec4<f32>(-0.19818558f, -47.838207f, -1.5003899f, -0.20914485f)),
    mat4x4<f32>(vec4<f32>(-0.55751497f, -3.4390726f, 0.30028278f, -0.1718346f), vec4<f32>(-0.32693204f, -0.56310403f, -0.508209f, -1.005984f), vec4<f32>(-0.33143577f, 1.420434f, -0.5103506f, 0.5355924f), vec4<f32>(-0.50951445f, 2.011052f, -1.5980743f, 0.39063236f)),
    mat4x4<f32>(vec4<f32>(-0.007893177f, -1.9168547f, -2.8238313f, 0.8126926f), vec4<f32>(-0.024703195f, 3.0338197f, -0.83963317f, 0.76560605f), vec4<f32>(-0.25359395f, 0.25137326f, 1.6551076f, -1.2946343f), vec4<f32>(-0.07779426f, 0.6158974f, -1.3742461f, -0.20147389f)),
    mat4x4<f32>(vec4<f32>(-0.36245236f, -2.126473f, 1.6999443f, 0.27836984f), vec4<f32>(-0.3802638f, -1.0578899f, 0.6559833f, 1.2648615f), vec4<f32>(0.16218288f, -1.8476137f, -1.8538566f, 0.38487968f), vec4<f32>(-0.3607257f, -1.8992126f, 0.88479364f, -0.35938486f)),
    mat4x4<f32>(vec4<f32>(-0.3046523f, 2.5543103f, 0.00779031f, -0.6110913f), vec4<f32>(0.20248345f, 0.3673109f, 0.045366533f, 0.7675556f), vec4<f32>(-0.3128859f, -2.3527296f, 0.11086922f, 0.56910765f), vec4<f32>(-0.115936086f, -0.5900598f, 0.91291374f, 0.5018808f)),
    mat4x4<f32>(vec4<f32>(0.1140261f, 0.86378473f, -1.5482339f, 0.2675193f), vec4<f32>(-0.6249853f, 0.16345339f, -0.6099004f, 1.2764479f), vec4<f32>(0.10792662f, -72.400085f, 41.909176f, 52.739677f), vec4<f32>(-0.12643147f, 1.1393485f, 0.0035437625f, -0.8239877f)),
    mat4x4<f32>(vec4<f32>(-0.35446605f, 1.7820624f, 0.85655636f, -4.8371544f), vec4<f32>(0.2561083f, -2.524373f, -3.803316f, 1.3527868f), vec4<f32>(-0.12295044f, 10.607384f, -5.677808f, 1.980226f), vec4<f32>(-0.49874857f, -4.762254f, 7.40551f, 17.157087f)),
    mat4x4<f32>(vec4<f32>(-0.13175572f, -5.0668335f, 1.8651767f, -1.4482958f), vec4<f32>(0.0062510255f, 0.08487061f, 1.0535067f, 0.17322683f), vec4<f32>(-0.31125408f, -2.9081576f, 0.02950071f, 2.1925697f), vec4<f32>(-0.076180436f, -0.29697967f, -3.1009912f, -0.97578424f)),
    mat4x4<f32>(vec4<f32>(-1.2788697f, -1.7724941f, 0.031367466f, -0.33944327f), vec4<f32>(-0.8223728f, 0.2586289f, -0.673155f, 0.14301081f), vec4<f32>(-0.021701338f, 0.39983368f, 1.5640485f, -0.54768234f), vec4<f32>(1.7517431f, -0.6110178f, -11.170872f, -0.90779716f)),
    mat4x4<f32>(vec4<f32>(-1.1979388f, 1.4289565f, -0.78963566f, -0.22586913f), vec4<f32>(1.8346869f, -2.7638795f, 2.9078295f, -0.31293452f), vec4<f32>(0.034241926f, -1.8968059f, 0.23844111f, -0.1667677f), vec4<f32>(2.5662813f, -1.8090616f, -2.3385468f, -0.7566507f)),
    mat4x4<f32>(vec4<f32>(-1.3626353f, 0.81723726f, 2.5182261f, -0.40006098f), vec4<f32>(2.8653626f, 1.9190807f, -1.5346744f, -0.23406813f), vec4<f32>(-4.8388877f, 1.8530403f, 1.1219699f, -0.28431627f), vec4<f32>(-1.7455623f, -0.26064312f, -2.630886f, -0.67394614f)),
    mat4x4<f32>(vec4<f32>(-4.250465f, 0.8485477f, -1.2077881f, -0.35964197f), vec4<f32>(0.61203647f, 1.4320666f, 0.041044943f, -0.19733426f), vec4<f32>(-6.530458f, 1.9437848f, -0.99711215f, -0.5484805f), vec4<f32>(0.21567212f, -0.9349211f, -1.3242472f, -0.6653045f)),
    mat4x4<f32>(vec4<f32>(3.035908f, 1.436095f, 7.5924344f, -0.84817594f), vec4<f32>(1.3552063f, -0.29650798f, -1.0791736f, -0.75067174f), vec4<f32>(-3.5197146f, -1.9264128f, -1.5374576f, -0.43862274f), vec4<f32>(-2.4996636f, -3.8316312f, 0.44254833f, -0.32154953f)),
    mat4x4<f32>(vec4<f32>(2.8465588f, 0.5712192f, 0.735795f, -0.0033822865f), vec4<f32>(-0.56190825f, -1.990058f, -1.5354006f, -0.6337873f), vec4<f32>(-40.07591f, -33.298107f, 47.418564f, -0.3391771f), vec4<f32>(-2.4642332f, -4.257247f, -1.4350299f, -0.74468124f)),
    mat4x4<f32>(vec4<f32>(-4.7277837f, -3.5859263f, 2.9436538f, -0.90756035f), vec4<f32>(3.105952f, 2.0426662f, -0.70306903f, -0.71554726f), vec4<f32>(-1.692159f, -2.07432f, 0.78881866f, -0.78756803f), vec4<f32>(-1.4522907f, -0.81979513f, 11.831197f, -0.13985069f)),
    mat4x4<f32>(vec4<f32>(-20.284815f, -1.9131353f, 1.4277077f, -0.81649566f), vec4<f32>(1.1189439f, -0.90156674f, -0.5455159f, -0.7752789f), vec4<f32>(-0.83667487f, -0.21452728f, 0.37944394f, -0.34293464f), vec4<f32>(1.1372877f, -1.0982034f, 0.4583989f, -0.2734245f)),
    mat4x4<f32>(vec4<f32>(0.32342657f, -0.16381542f, -0.40632406f, -0.16606194f), vec4<f32>(0.2886088f, 1.4384278f, -0.13271601f, -0.72110575f), vec4<f32>(2.0296056f, -0.9668749f, 0.055594433f, 0.89882463f), vec4<f32>(-2.7802057f, -0.50567096f, -0.3152656f, 0.29999986f)),
    mat4x4<f32>(vec4<f32>(0.30521056f, 0.11159783f, -0.05518078f, -1.3052118f), vec4<f32>(-0.09157455f, -1.0110682f, -0.35769543f, -1.5615903f), vec4<f32>(-1.1007711f, 2.0066028f, 0.18243526f, 1.0613225f), vec4<f32>(-2.2169673f, -0.20630412f, -0.38137758f, -1.7758629f)),
    mat4x4<f32>(vec4<f32>(0.7250795f, -0.9703145f, 0.19154473f, 2.1376066f), vec4<f32>(1.3108358f, -0.32054564f, -0.98763305f, 0.63966024f), vec4<f32>(0.58257407f, -0.3485913f, -0.15903606f, -0.2969556f), vec4<f32>(0.47538194f, 0.46428493f, -0.052737117f, -0.60588396f)),
    mat4x4<f32>(vec4<f32>(1.3384848f, 0.76405257f, -0.035901032f, 0.50153345f), vec4<f32>(-1.8342975f, 1.9698441f, 0.2048863f, 1.3807392f), vec4<f32>(-0.5539028f, 0.82545257f, -0.38099998f, -0.54782456f), vec4<f32>(-0.60050094f, 0.06114892f, 0.0109926f, -0.112417564f)),
    mat4x4<f32>(vec4<f32>(1.1562332f, 0.43306014f, -0.1296074f, 2.440256f), vec4<f32>(-0.52387255f, 0.9127684f, -0.22081022f, 0.32616612f), vec4<f32>(-0.32088432f, -0.39988524f, -0.3211627f, 0.8526902f), vec4<f32>(-0.2553219f, 0.5045174f, -0.22395696f, -0.16359173f)),
    mat4x4<f32>(vec4<f32>(0.7099996f, 1.232924f, -0.6559115f, -1.6254576f), vec4<f32>(-0.021275291f, -0.28515562f, -0.6122335f, 3.148062f), vec4<f32>(38.279278f, 28.5439f, -0.23451121f, 23.176136f), vec4<f32>(0.38483733f, 0.120970905f, -0.5669942f, -0.42253715f)),
    mat4x4<f32>(vec4<f32>(0.6025491f, 1.7445382f, -0.38868186f, -1.003331f), vec4<f32>(-2.0015347f, 0.4662167f, -0.08761083f, -0.03295988f), vec4<f32>(-2.4838984f, 0.3430683f, -0.18713558f, 1.5661621f), vec4<f32>(4.9074254f, -0.31771374f, -0.27555382f, 6.9322076f)),
    mat4x4<f32>(vec4<f32>(0.48470423f, 1.3017286f, -0.57338256f, 1.9977043f), vec4<f32>(1.3343451f, 1.124883f, -0.31965873f, -2.422213f), vec4<f32>(0.03425674f, 1.3219501f, -0.0140554225f, -0.36539128f), vec4<f32>(0.09453477f, -0.72655016f, -0.15501757f, -1.2257603f)),
    mat4x4<f32>(vec4<f32>(-0.3830995f, 0.8711124f, -2.531773f, 2.3450906f), vec4<f32>(-0.5046418f, -0.18559308f, -0.043250065f, -0.04814989f), vec4<f32>(0.80467397f, -2.6349037f, 2.4433057f, -1.8888735f), vec4<f32>(0.14080918f, 0.16216256f, -0.73435795f, -1.7728852f)),
    mat4x4<f32>(vec4<f32>(-0.5284839f, 0.15593404f, 1.5015632f, -0.70785993f), vec4<f32>(0.36261168f, 0.29404876f, 0.3235795f, -0.46695745f), vec4<f32>(-0.31503266f, 0.2504051f, -0.62893677f, 1.1998066f), vec4<f32>(-0.7907909f, 1.6867315f, -0.7408103f, -0.8367681f)),
    mat4x4<f32>(vec4<f32>(2.6406658f, -1.5987536f, -0.02024108f, -39.160957f), vec4<f32>(0.35633612f, -1.1326717f, 0.078679256f, -0.6269402f), vec4<f32>(-2.110519f, 0.48404667f, -0.91979617f, -9.404749f), vec4<f32>(0.35182858f, 0.25797543f, 0.7645786f, -1.221499f)),
    mat4x4<f32>(vec4<f32>(-0.44946235f, -0.7788535f, 1.1892793f, 0.5591938f), vec4<f32>(0.35645786f, 0.094985425f, 0.17615107f, 0.26346347f), vec4<f32>(-0.4571226f, 1.5074216f, -0.94012666f, -1.3043909f), vec4<f32>(-1.7155043f, 0.97074556f, -1.9019933f, -6.346539f)),
    mat4x4<f32>(vec4<f32>(2.6538086f, -2.5318153f, 2.8000367f, -2.7600226f), vec4<f32>(-0.65784967f, -0.21742234f, -1.0497744f, -9.233375f), vec4<f32>(0.11880474f, -0.66432357f, -1.4177536f, -0.103072815f), vec4<f32>(-0.91791725f, 1.7479087f, -2.9147553f, 1.7644771f)),
    mat4x4<f32>(vec4<f32>(-0.5185405f, -0.45023468f, 1.239262f, -1.1819397f), vec4<f32>(0.08794238f, 0.60203266f, -0.7610508f, -0.46930638f), vec4<f32>(56.63506f, -40.97147f, -38.491665f, 55.731823f), vec4<f32>(0.84508294f, -0.7917561f, -0.46851754f, -0.65988994f)),
    mat4x4<f32>(vec4<f32>(-3.127498f, 1.6072181f, -5.5871f, 3.0458117f), vec4<f32>(-1.2642719f, 1.1635212f, 0.97104865f, -7.0801797f), vec4<f32>(-1.7273396f, 0.12588477f, -0.047348537f, 1.99572f), vec4<f32>(7.475945f, -10.227622f, -2.3160303f, 16.526388f)),
    mat4x4<f32>(vec4<f32>(-3.3859339f, -1.1914951f, -1.551237f, 1.9976467f), vec4<f32>(1.1268681f, -0.29889172f, 1.0361499f, 0.3534297f), vec4<f32>(1.0624168f, 0.22369984f, 1.6649894f, -1.1051549f), vec4<f32>(-0.023290886f, 0.9238263f, -0.5466744f, 0.7365538f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(-0.4702997f, 3.6017132f, 3.1618407f, -4.565967f),
    vec4<f32>(-3.1748745f, 5.315254f, 2.8817766f, -0.46516532f),
    vec4<f32>(0.46057475f, -0.5172249f, -0.0779469f, 3.736676f),
    vec4<f32>(3.3655753f, -0.29277152f, 0.44119278f, 0.9078992f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.027475799f, -0.11262302f, 0.113024525f, -0.11926887f),
    vec4<f32>(0.078904204f, -0.13931622f, -0.11915389f, 0.5882544f),
    vec4<f32>(-0.10881586f, -0.15059823f, 0.335851f, 0.10879014f),
    vec4<f32>(-0.2194254f, 0.11674281f, 0.17508075f, -0.31335026f)
);
const NMT_B3: f32 = -1.9357655f;

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
const NMT_HEAVY: u32 = 6u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
const NMT_SLOTS: u32 = 8u;
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
    let front_7 = front_6 + select(0.0, absorbances1.z, z > depths1.z);
    let in_core_7 = select(in_core_6, 1.0, depths1.z == z && absorbances1.z == absorbance);
    let count_7 = count_6 - select(0.0, 1.0, absorbances1.z > 0.0);
    let rest0_7 = rest0_6 - absorbances1.z;
    let rest1_7 = rest1_6 - absorbances1.z * depths1.z;
    let rest2_7 = rest2_6 - absorbances1.z * depths1.z * depths1.z;
    let rest3_7 = rest3_6 - absorbances1.z * depths1.z * depths1.z * depths1.z;
    let rest4_7 = rest4_6 - absorbances1.z * depths1.z * depths1.z * depths1.z * depths1.z;
    let front_8 = front_7 + select(0.0, absorbances1.w, z > depths1.w);
    let in_core_8 = select(in_core_7, 1.0, depths1.w == z && absorbances1.w == absorbance);
    let count_8 = count_7 - select(0.0, 1.0, absorbances1.w > 0.0);
    let rest0_8 = rest0_7 - absorbances1.w;
    let rest1_8 = rest1_7 - absorbances1.w * depths1.w;
    let rest2_8 = rest2_7 - absorbances1.w * depths1.w * depths1.w;
    let rest3_8 = rest3_7 - absorbances1.w * depths1.w * depths1.w * depths1.w;
    let rest4_8 = rest4_7 - absorbances1.w * depths1.w * depths1.w * depths1.w * depths1.w;
    let far = select(depths0.x, depths0.y, absorbances0.y > 0.0);
    let center = 0.5 * (depths0.x + far);
    let half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    let per_h = 1.0 / half_range;
    let moved1 = (rest1_8 - center * rest0_8) * per_h;
    let moved2 = (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)) * (per_h * per_h);
    let moved3 = (rest3_8 - center * rest2_8 - center * (rest2_8 - center * rest1_8) - center * (rest2_8 - center
        * rest1_8 - center * (rest1_8 - center * rest0_8))) * (per_h * per_h * per_h);
    let moved4 = (rest4_8 - center * rest3_8 - center * (rest3_8 - center * rest2_8) - center * (rest3_8 - center
        * rest2_8 - center * (rest2_8 - center * rest1_8)) - center * (rest3_8 - center * rest2_8 - center * (rest2_8
        - center * rest1_8) - center * (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)))) * (per_h
        * per_h * per_h * per_h);
    let x = clamp((z - center) * per_h, -1.0, 1.0);
    let removed = select(0.0, absorbance, in_core_8 == 0.0);
    let tail0 = rest0_8 - removed;
    let tail1 = moved1 - removed * x;
    let tail2 = moved2 - removed * x * x;
    let tail3 = moved3 - removed * x * x * x;
    let tail4 = moved4 - removed * x * x * x * x;
    let others = count_8 - select(0.0, 1.0, removed > 0.0);
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
        let known = min(exp(-(front_8 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    let bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        let bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        let most = min(exp(-(front_8 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        let least = min(exp(-(front_8 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        let opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            let middle = 0.5 * (most + least);
            return middle;
        }
    }
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_8) * nmt_transmittance(mat3x4<f32>(vec4<f32>(x, log2(others) * 0.33333334 - 1.0,
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
    let slot6 = nmt_core_slot(core1.z, nmt_core_heavy_steps(core1.z, codes));
    let slot7 = nmt_core_slot(core1.w, nmt_core_heavy_steps(core1.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4<f32>(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4<f32>(slot0.y, slot1.y, slot2.y, slot3.y),
        vec4<f32>(slot4.x, slot5.x, slot6.x, slot7.x),
        vec4<f32>(slot4.y, slot5.y, slot6.y, slot7.y),
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
