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
// Provenance: nmt 0.1.0, commit c1ed93bd63ea, backend fused, seed 2, epochs 1500, dataset cfac8078bedf5effa916da488b9581e4e76632aac69746931a2aa032cd1a0a6b.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.016e-3, worst 1.000.

// The features of a fragment that needs the network, from its five numbers and the means and spreads of the tail.
fn nmt_features(x: f32, count: f32, ln_b0: f32, lower: f32, upper: f32, tail: vec4<f32>) -> mat3x4<f32> {
    return mat3x4<f32>(vec4<f32>(x, count, ln_b0, lower), vec4<f32>(upper, tail.xyz), vec4<f32>(tail.w, 0.0, 0.0, 0.0));
}

const NMT_W1 = array<mat4x4<f32>, 24>(
    mat4x4<f32>(vec4<f32>(-4.0255322f, 5.696204f, 1.6943908f, 4.625778f), vec4<f32>(-0.123158716f, -0.022845494f, 1.3684101f, -0.22309694f), vec4<f32>(-0.055782713f, -0.02729638f, -0.7351799f, 0.12446838f), vec4<f32>(-22.08425f, -21.542097f, -12.540206f, 7.9311724f)),
    mat4x4<f32>(vec4<f32>(4.003113f, -12.202889f, -6.03625f, -9.53933f), vec4<f32>(5.079678f, 0.96678704f, -2.5490577f, -3.7921448f), vec4<f32>(-5.563451f, -3.4979208f, 2.9750206f, -5.7120223f), vec4<f32>(-1.8828032f, -0.6641459f, 2.2350688f, -2.790497f)),
    mat4x4<f32>(vec4<f32>(-47.499374f, 0.7882673f, -0.7554687f, -0.40223193f), vec4<f32>(2.2457452f, 4.4966774f, 2.7239416f, 4.8531356f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-6.509258f, -3.6678035f, 2.3813612f, 0.8936451f), vec4<f32>(-0.0070089055f, -0.38917178f, 0.056811646f, -0.03466737f), vec4<f32>(0.0034584545f, -0.08949225f, -0.041342236f, -0.03309034f), vec4<f32>(0.002414985f, 35.769714f, 17.576942f, 25.224512f)),
    mat4x4<f32>(vec4<f32>(-0.020485638f, -38.85436f, -0.86674184f, -23.896433f), vec4<f32>(-0.01604367f, 4.0836473f, 0.33259383f, 1.0908167f), vec4<f32>(0.03454655f, -18.111965f, -3.71319f, -4.6560225f), vec4<f32>(0.011393566f, -0.30890125f, -1.3219124f, -2.8662512f)),
    mat4x4<f32>(vec4<f32>(0.0041463277f, 1.9609691f, 10.727305f, 4.8774633f), vec4<f32>(-6.485228f, 1.0027441f, -1.0354357f, 2.0669503f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(1.0427063f, 1.4444615f, 0.22712201f, -2.9948504f), vec4<f32>(0.066054374f, 0.31861958f, 0.026391018f, -0.27554062f), vec4<f32>(-0.12969105f, -0.015988281f, 0.07662249f, -0.0039148843f), vec4<f32>(-2.64852f, -0.30498013f, -4.04413f, 0.3279041f)),
    mat4x4<f32>(vec4<f32>(-2.7326443f, 2.5969625f, -4.288648f, 6.164401f), vec4<f32>(-8.941283f, 4.4852185f, -1.8909162f, 0.41518652f), vec4<f32>(-8.713514f, 8.992529f, -1.2659963f, -2.206071f), vec4<f32>(5.6512294f, -3.470394f, -1.0694718f, 4.1851635f)),
    mat4x4<f32>(vec4<f32>(-1.1414442f, -0.5981651f, 9.139677f, -8.4315195f), vec4<f32>(3.3552182f, -3.8380163f, -2.0059235f, 1.4037566f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(0.50419164f, 3.3264024f, 0.3408373f, 0.15794963f), vec4<f32>(0.15867789f, -0.12802078f, -0.0507785f, 0.11978142f), vec4<f32>(-0.100550495f, 0.022845238f, 0.04496174f, 0.034926943f), vec4<f32>(16.608372f, 0.0759729f, -1.9273227f, -10.205227f)),
    mat4x4<f32>(vec4<f32>(-12.711161f, 2.190889f, -1.5415816f, 0.8842952f), vec4<f32>(-1.7452958f, -1.3973209f, -7.6971993f, 4.01076f), vec4<f32>(-10.807886f, -1.2840962f, -3.3269665f, 5.866802f), vec4<f32>(0.44886237f, 4.806983f, 9.19736f, -5.7426167f)),
    mat4x4<f32>(vec4<f32>(7.395807f, 1.3404678f, 2.9149747f, -8.111294f), vec4<f32>(0.22378251f, 1.1213043f, 0.44062462f, 1.4559642f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-6.7969713f, -0.502306f, 6.0482206f, -1.571385f), vec4<f32>(0.15505987f, -0.112316325f, -0.4587652f, -0.04966048f), vec4<f32>(0.013082438f, -0.018316714f, 0.44126177f, -0.00346313f), vec4<f32>(1.7010074f, 19.925846f, -26.00454f, -0.16778176f)),
    mat4x4<f32>(vec4<f32>(-1.2125382f, -18.547857f, 3.1266713f, 0.29102612f), vec4<f32>(-1.0211937f, -0.9701661f, -0.14331418f, 7.204432f), vec4<f32>(1.9405318f, -0.29332843f, -1.8971208f, -5.4432473f), vec4<f32>(0.5886473f, 0.15590455f, -3.7831268f, -8.984916f)),
    mat4x4<f32>(vec4<f32>(-1.5789444f, 1.2986006f, 2.2151904f, 0.062172584f), vec4<f32>(-6.4984884f, 2.0684013f, 1.5952907f, 1.0277586f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-3.393126f, 2.3674746f, 0.82819694f, 3.3245544f), vec4<f32>(-0.12058834f, -0.0047716806f, -0.5326883f, -0.6793858f), vec4<f32>(0.025013916f, 0.010085596f, 1.4445151f, 0.11267296f), vec4<f32>(3.8268487f, 32.934467f, -0.16003872f, 3.8154705f)),
    mat4x4<f32>(vec4<f32>(-7.692379f, -20.772335f, 0.35992932f, -9.875593f), vec4<f32>(1.4604832f, -6.4257917f, -2.883336f, -2.820427f), vec4<f32>(-4.661669f, -1.7963374f, 2.6235654f, 4.8746185f), vec4<f32>(-0.022091508f, 4.993737f, 0.3696627f, -2.0515103f)),
    mat4x4<f32>(vec4<f32>(-1.0262295f, 7.732843f, -0.19911182f, 4.143213f), vec4<f32>(1.0726902f, 0.3799708f, -3.7199762f, 2.1817524f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-4.187771f, 5.7622466f, 3.464974f, 3.5274491f), vec4<f32>(0.123458035f, -0.15130657f, -0.21285085f, -0.6091351f), vec4<f32>(0.113453746f, 0.058647636f, -0.12338351f, 0.3324342f), vec4<f32>(-8.736808f, 3.7716558f, -0.9494796f, -103.00982f)),
    mat4x4<f32>(vec4<f32>(2.0454342f, 0.2812312f, -0.055282958f, -4.450533f), vec4<f32>(-3.6171782f, -0.49419218f, 5.6497235f, -1.925063f), vec4<f32>(0.7400166f, 1.2106199f, -3.009102f, 0.2615118f), vec4<f32>(7.4685283f, -1.4964488f, -11.21016f, 1.9037799f)),
    mat4x4<f32>(vec4<f32>(2.3226392f, -0.80109143f, 5.0596423f, 1.3209901f), vec4<f32>(-6.4159875f, 4.7279124f, -1.2052386f, 3.2027826f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-2.67451f, -0.25473332f, -4.7082705f, -6.950072f), vec4<f32>(-0.22337003f, 0.013849621f, -0.5821967f, 0.023658099f), vec4<f32>(0.18122683f, -0.050395988f, -0.25371712f, -0.008888219f), vec4<f32>(6.502307f, -1.9178911f, -0.39032215f, -0.7561635f)),
    mat4x4<f32>(vec4<f32>(-3.0350447f, 9.534253f, -0.75022167f, -0.3300544f), vec4<f32>(3.5901492f, 3.03143f, 0.117477216f, 0.01888314f), vec4<f32>(-4.6517525f, 2.9598794f, -0.58163494f, -0.36835226f), vec4<f32>(-2.483894f, -2.092986f, -0.02274922f, 0.06036394f)),
    mat4x4<f32>(vec4<f32>(3.4605544f, -1.1416317f, -0.49811774f, 1.056725f), vec4<f32>(-0.9243449f, -1.1349953f, -5.6314116f, -6.5328717f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 32>(
    mat4x4<f32>(vec4<f32>(-0.9533716f, -0.023912556f, -0.9153294f, -0.6364172f), vec4<f32>(-1.3491272f, -0.021342112f, 1.0095835f, 0.28646916f), vec4<f32>(0.16594304f, -0.27667075f, -0.51430374f, -2.0443883f), vec4<f32>(1.112755f, 0.0915239f, -1.0105754f, 0.24547203f)),
    mat4x4<f32>(vec4<f32>(-15.338107f, -0.18109065f, 36.85456f, -16.543253f), vec4<f32>(-1.0150462f, 0.056353666f, 0.016026035f, 2.2635589f), vec4<f32>(1.6816186f, -0.05943171f, 0.8579211f, -1.0591912f), vec4<f32>(0.043707225f, -0.09092495f, 0.15902202f, 3.3374038f)),
    mat4x4<f32>(vec4<f32>(0.039660048f, -0.3292222f, -0.5847584f, -2.5101895f), vec4<f32>(-1.311235f, -0.40319374f, 1.7404836f, 0.9153837f), vec4<f32>(2.1340253f, -0.32362092f, -0.17209554f, 1.191257f), vec4<f32>(0.6353717f, -0.21473892f, 1.5834737f, 2.851836f)),
    mat4x4<f32>(vec4<f32>(1.2562435f, 0.07121042f, -0.0665915f, -1.2945167f), vec4<f32>(-0.7341449f, -0.3799136f, -0.010191748f, -16.294928f), vec4<f32>(0.85872763f, 0.20701307f, -1.0996699f, -24.260374f), vec4<f32>(3.177199f, -0.38679487f, 0.11351008f, -1.6164944f)),
    mat4x4<f32>(vec4<f32>(-6.4650416f, -0.41673565f, 0.55340284f, -13.12142f), vec4<f32>(0.7579364f, -0.18683712f, 0.20788263f, -1.0848093f), vec4<f32>(3.2402115f, -0.04443337f, -0.033630773f, 0.19914113f), vec4<f32>(-1.1899779f, -0.13963297f, 1.885436f, 3.854255f)),
    mat4x4<f32>(vec4<f32>(0.5404526f, 0.09659141f, 1.6735438f, -1.3909712f), vec4<f32>(-2.067266f, -0.39151478f, -0.18703642f, 0.6079234f), vec4<f32>(1.2486103f, -0.07376202f, 1.1963037f, -0.5950847f), vec4<f32>(-4.0807877f, -0.1041501f, 0.2707971f, 0.10968553f)),
    mat4x4<f32>(vec4<f32>(-0.78077024f, -0.17305139f, 1.9303315f, -12.010455f), vec4<f32>(-0.9506922f, -0.20199437f, -0.06307983f, 2.4605262f), vec4<f32>(-0.43516338f, -0.100928746f, -2.1531272f, -3.1601245f), vec4<f32>(-0.23850946f, 0.059164405f, 0.1695899f, -3.4487617f)),
    mat4x4<f32>(vec4<f32>(-1.3490047f, -0.4209982f, 0.22618073f, -3.3278596f), vec4<f32>(-1.875717f, -0.4981746f, -0.78577715f, -4.9637f), vec4<f32>(44.00582f, -0.31377533f, 25.27289f, -18.628054f), vec4<f32>(-3.6807067f, -0.12270356f, 1.5959344f, -0.8601947f)),
    mat4x4<f32>(vec4<f32>(-0.1453553f, 0.07063915f, 1.8956821f, 1.9108816f), vec4<f32>(0.3346319f, -0.076211855f, 0.34616187f, 0.5547185f), vec4<f32>(-0.011447386f, -0.41964942f, -0.28713802f, -0.2837125f), vec4<f32>(0.7431988f, 0.090956256f, -0.9054148f, 0.72439426f)),
    mat4x4<f32>(vec4<f32>(39.286304f, -0.31516922f, 40.76921f, 16.395794f), vec4<f32>(-0.42318517f, -0.5491356f, -2.1107347f, -14.392391f), vec4<f32>(-1.0712371f, -0.25630018f, -0.26045516f, -4.6359696f), vec4<f32>(-0.6129423f, -0.99003834f, 1.545693f, -0.76912624f)),
    mat4x4<f32>(vec4<f32>(-1.0058358f, -0.32852674f, 0.4163718f, -1.056459f), vec4<f32>(-0.84956074f, -0.565298f, -0.83973414f, -1.2990212f), vec4<f32>(1.4913182f, -0.16343024f, -2.343077f, 0.6615414f), vec4<f32>(-0.6030688f, -0.30026984f, -0.18957068f, -2.59755f)),
    mat4x4<f32>(vec4<f32>(2.6016612f, -0.2845663f, 1.6151973f, 0.6618105f), vec4<f32>(-0.0525817f, -0.33184847f, -0.28768083f, 0.91238344f), vec4<f32>(-0.119816735f, -0.25671324f, 0.9706344f, -0.6891455f), vec4<f32>(0.56451523f, 0.17033842f, -0.47975639f, -1.8264201f)),
    mat4x4<f32>(vec4<f32>(2.9959838f, -0.652482f, 1.8844278f, 0.9622594f), vec4<f32>(0.070143305f, -0.6639423f, 0.40328276f, -0.64634347f), vec4<f32>(-0.60777456f, -0.5887462f, 0.7209019f, -0.69019026f), vec4<f32>(0.5434486f, -0.5052658f, 0.33621076f, 2.5048401f)),
    mat4x4<f32>(vec4<f32>(-0.26733327f, -0.4642397f, -0.9772016f, -0.870254f), vec4<f32>(-3.6335413f, -0.3555749f, -1.045125f, -4.07717f), vec4<f32>(-0.8452041f, -0.3185469f, -0.37459856f, -0.110035f), vec4<f32>(0.55276686f, -0.4794151f, -0.3470924f, -2.098274f)),
    mat4x4<f32>(vec4<f32>(-0.6638723f, -0.29884577f, -0.35764614f, -2.100383f), vec4<f32>(0.30588472f, -0.8333303f, -0.17897666f, -1.1643548f), vec4<f32>(-2.3153057f, -0.55565417f, -0.32713842f, -3.6840034f), vec4<f32>(0.7842276f, -0.38678697f, 0.6786007f, 1.412775f)),
    mat4x4<f32>(vec4<f32>(0.42784715f, -0.8615997f, 0.2460582f, -0.10386703f), vec4<f32>(-0.13341987f, -0.7622468f, -1.076524f, 1.2882116f), vec4<f32>(26.760437f, 0.043523494f, 41.775837f, 6.34395f), vec4<f32>(2.348743f, -0.58241946f, 12.563165f, 1.9395633f)),
    mat4x4<f32>(vec4<f32>(-1.0057069f, -15.484056f, -0.8306804f, 4.1161814f), vec4<f32>(0.16261958f, -11.575914f, 0.7167826f, -0.7424119f), vec4<f32>(-0.18335058f, -0.9846208f, -1.2416226f, 0.44570327f), vec4<f32>(-1.1767898f, 4.0964417f, 0.13868305f, -1.2914313f)),
    mat4x4<f32>(vec4<f32>(-70.23616f, -75.0458f, -59.01664f, 12.429902f), vec4<f32>(-2.5156229f, -1.0310744f, -1.2728319f, 0.34910786f), vec4<f32>(2.1732159f, 0.15101202f, 0.85288423f, 2.1510382f), vec4<f32>(2.449578f, -6.0832376f, -2.8002646f, 1.9478861f)),
    mat4x4<f32>(vec4<f32>(-0.29509312f, -3.8282657f, -0.67162865f, 1.6842072f), vec4<f32>(-0.9205352f, 0.11075853f, 1.3054434f, 0.5321204f), vec4<f32>(-0.22425814f, -0.15107968f, -1.575949f, 0.22575685f), vec4<f32>(0.37909648f, -0.250605f, 0.9879276f, -7.929242f)),
    mat4x4<f32>(vec4<f32>(-0.47060302f, 2.9747362f, -10.990186f, 0.4114294f), vec4<f32>(-1.6254674f, 0.7859203f, 0.46615675f, -3.7527027f), vec4<f32>(-0.286325f, 0.617553f, 0.0033092718f, 4.303752f), vec4<f32>(2.7186172f, 0.44322705f, -1.863603f, 1.624693f)),
    mat4x4<f32>(vec4<f32>(-2.4725301f, -1.5300545f, -0.9504451f, 3.1540065f), vec4<f32>(0.053648796f, -1.0160289f, -1.0822248f, 3.1805134f), vec4<f32>(0.4030251f, -0.2734259f, 0.38411066f, 0.38576034f), vec4<f32>(-0.2328709f, 1.4899489f, 1.5601239f, -1.69999f)),
    mat4x4<f32>(vec4<f32>(-0.49676415f, 1.1180121f, -0.43828925f, -1.4976035f), vec4<f32>(-1.5912924f, -9.547819f, -0.78240997f, -7.8603153f), vec4<f32>(-0.3214312f, 0.087684f, -0.04540323f, -0.5647855f), vec4<f32>(0.46469375f, 1.1731452f, -0.63446325f, 0.25039765f)),
    mat4x4<f32>(vec4<f32>(2.304289f, 1.1074053f, 1.7841369f, -1.1050184f), vec4<f32>(0.41535342f, -0.790432f, -1.2212279f, 2.138696f), vec4<f32>(-1.4066341f, -3.970257f, -0.077826135f, -4.155295f), vec4<f32>(0.93355304f, -1.0763787f, -0.11814381f, 2.1212103f)),
    mat4x4<f32>(vec4<f32>(-1.1244867f, -0.4228181f, 1.161553f, -1.3148576f), vec4<f32>(0.056548953f, 0.39536077f, -0.5357919f, -3.4298966f), vec4<f32>(-62.053368f, -59.341625f, -40.85116f, 5.0153856f), vec4<f32>(-3.138093f, 1.2564723f, -2.4892633f, -6.9960933f)),
    mat4x4<f32>(vec4<f32>(-1.3116454f, -2.4449224f, 0.6285333f, 0.33160317f), vec4<f32>(0.89022815f, 1.6486273f, 0.56321317f, 0.21195675f), vec4<f32>(-0.19395639f, -1.2140524f, -0.94985414f, 0.061687086f), vec4<f32>(1.2984312f, -1.0810565f, -1.3238264f, 0.26209682f)),
    mat4x4<f32>(vec4<f32>(-19.707382f, -58.439476f, -34.231743f, 51.697456f), vec4<f32>(-0.8955569f, -0.5577856f, -1.7309264f, 1.9096798f), vec4<f32>(0.2397159f, 0.29411244f, -0.55452573f, -1.7539995f), vec4<f32>(-0.47557485f, 3.0380623f, -3.7277555f, -0.18603717f)),
    mat4x4<f32>(vec4<f32>(-0.26022965f, 0.12189879f, -1.4006208f, -0.055232037f), vec4<f32>(2.2262263f, -0.44580844f, -0.26314613f, -1.8803545f), vec4<f32>(-0.26910368f, -1.6509178f, 5.3864126f, 0.032558464f), vec4<f32>(2.2175922f, -1.0064648f, -0.20202447f, -1.7486198f)),
    mat4x4<f32>(vec4<f32>(-0.363278f, 4.63216f, 1.9288766f, -2.4225435f), vec4<f32>(-0.50264215f, -2.6026533f, 0.5468965f, -0.6739758f), vec4<f32>(0.120355025f, 1.240956f, -3.8503177f, 0.007677607f), vec4<f32>(-1.3201234f, 0.4576058f, -0.94173425f, -2.2499797f)),
    mat4x4<f32>(vec4<f32>(-2.5061276f, -0.49517626f, -2.9986513f, 3.318081f), vec4<f32>(-1.2816699f, 0.23562266f, -1.484695f, 0.91130346f), vec4<f32>(-0.8777639f, 0.88774824f, -0.4923823f, 0.106555f), vec4<f32>(1.272445f, -1.5231833f, 3.9530544f, 0.9388586f)),
    mat4x4<f32>(vec4<f32>(1.3245022f, -0.4820548f, 1.6983755f, 0.028543063f), vec4<f32>(1.3538333f, -6.846795f, 0.8200843f, -4.4577127f), vec4<f32>(-0.015166995f, 0.16394323f, -0.07165488f, -0.2219812f), vec4<f32>(0.97834635f, 1.1480302f, -1.5143827f, 0.32333264f)),
    mat4x4<f32>(vec4<f32>(-0.37034887f, 1.3580012f, 0.116402686f, -3.630028f), vec4<f32>(0.25529686f, 0.66414505f, 2.4161358f, 1.323056f), vec4<f32>(-2.662821f, -4.2417464f, -2.479341f, -20.309309f), vec4<f32>(-0.06483494f, -1.9271599f, 0.23421793f, 0.18673025f)),
    mat4x4<f32>(vec4<f32>(-0.78342414f, 1.2142608f, -1.4254683f, 0.36460462f), vec4<f32>(1.2078199f, -0.90951747f, -0.011000494f, 0.7334401f), vec4<f32>(-21.266111f, -49.016678f, 6.222171f, 45.55174f), vec4<f32>(0.2647363f, -0.14191146f, 2.8238018f, 0.15251571f))
);
const NMT_B2 = array<vec4<f32>, 4>(
    vec4<f32>(1.3959447f, -0.14219934f, 2.8130505f, -6.171281f),
    vec4<f32>(3.1731634f, -0.4604881f, -3.3478606f, 2.343485f),
    vec4<f32>(-0.57769954f, -3.2398953f, 2.278988f, -2.250032f),
    vec4<f32>(-2.4342277f, 2.9267676f, -10.166434f, -1.6841649f)
);
const NMT_W3 = array<vec4<f32>, 4>(
    vec4<f32>(-0.080188386f, -0.17788683f, -0.22983594f, 0.20219137f),
    vec4<f32>(-0.19566493f, 0.18433502f, -0.25953397f, 0.14942715f),
    vec4<f32>(0.11522388f, 0.13476127f, 0.11928268f, 0.14287084f),
    vec4<f32>(0.12903644f, -0.2549965f, 0.0918149f, -0.43687555f)
);
const NMT_B3: f32 = -1.4460578f;

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
    let mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    let mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    if (NMT_OPEN > 0.0) {
        let bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * ((1.0 + abs(center)) * per_h + 1.0) * 4.7683716e-7
            * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h
            + 1.0) / (max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean * mean, 1e-6), 0.0, 1.0)
            * (1.0 - mean * mean), 1e-7) * max(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
            * mean, 1e-6), 0.0, 1.0) * (1.0 - mean * mean), 1e-7));
        let most = min(exp(-(front_8 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        let least = min(exp(-(front_8 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            let middle = 0.5 * (most + least);
            return middle;
        }
    }
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
