// Core and tail: a pixel's nearest, its farthest and its 4 heaviest other fragments one by one, all others by their sums.
// Written by nmt 0.1.0.
//
// Frame:  codes = nmt_core_codes(v0, v1), v0 and v1 the least and the greatest view depth of what is transparent. Clear to 0 the buffer
//         nmt_core, 8 words a pixel, and targets for b0, 4 moments and n, which are added up by blending in f32.
// Pass 1, for every fragment of view depth v and opacity alpha:
//         steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes)
//         nmt_core_insert(pixel, steps, codes)
//         add to b0: nmt_core_absorbance(steps); to the moments: nmt_core_moments(steps); to n: 1 where steps.y > 0, else 0
// Pass 2: T = nmt_core_transmittance(steps, codes, core0, ..., n, b0, moments), the core read as vectors of four words;
//         steps must come from the same expressions as in pass 1. Add up alpha T C and alpha T.
// Resolve: colour = (1 - exp(-b0)) * sum(alpha T C) / sum(alpha T) + exp(-b0) * background

#ifndef NMT_INCLUDED_CORE_CHAIN
#define NMT_INCLUDED_CORE_CHAIN

// Neural moment transparency: network 'core', 7-32-16-1, 752 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
//
// Features, set 'core-4-4', in this order: x, count, ln_b0, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^6, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 3092f67416d8b5bbb367e1c26a4ab05adc3607e46d8419bd3e02d6ef6371f815.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

#ifndef NMT_INCLUDED_CORE
#define NMT_INCLUDED_CORE

// The features of a fragment that needs the network, from its three numbers and the means and spreads of the tail.
float2x4 nmt_features(float x, float count, float ln_b0, float4 tail) {
    return float2x4(float4(x, count, ln_b0, tail.x), float4(tail.yzw, 0.0));
}

static const float4x4 NMT_W1[16] = {
    float4x4(float4(0.6881288f, -1.1310471f, 0.19075142f, -0.122978434f), float4(0.059859317f, -0.032530885f, 0.11460753f, -0.05948783f), float4(0.09496521f, 0.028685618f, -0.07390768f, -0.0039776997f), float4(0.66928864f, 1.0262985f, 3.757691f, 5.0184836f)),
    float4x4(float4(-2.0447435f, -12.088652f, 1.5913789f, -7.7325196f), float4(-1.2489678f, 1.0511265f, -0.07461163f, -5.2501163f), float4(6.302579f, -2.4373822f, -0.32582536f, 1.6611658f), float4(-1.9725834f, 1.5152123f, -0.1333648f, 0.8429957f)),
    float4x4(float4(-1.0529675f, 0.047792263f, -0.38675287f, -0.4790484f), float4(-0.06178597f, 0.016562033f, 0.0030441822f, 0.21425606f), float4(0.022690004f, 0.0074565373f, 0.01335627f, 0.038239885f), float4(0.89074063f, -3.7101028f, 2.7637813f, -3.6907377f)),
    float4x4(float4(5.461836f, 4.834039f, -4.186392f, 0.66879135f), float4(-0.76883733f, 4.1093445f, -2.9046538f, 6.4072814f), float4(-7.442225f, -3.0523446f, -0.13244298f, 0.59931296f), float4(1.7018301f, 0.6336567f, 0.9403853f, -1.7658007f)),
    float4x4(float4(1.8765194f, 2.6232011f, 2.9969184f, 1.9736181f), float4(-0.22154179f, 0.14598238f, -0.023278037f, 0.118888475f), float4(0.118653126f, -0.08851043f, -0.16036831f, 0.044362914f), float4(1.5986516f, -2.4959438f, 2.785788f, 0.2126117f)),
    float4x4(float4(-7.5458517f, 4.551311f, 2.0929039f, 4.794727f), float4(-0.43736508f, 3.7192998f, -4.572139f, -2.46626f), float4(1.5987555f, 2.4772296f, 2.163722f, -1.1508174f), float4(1.8332342f, -3.4584925f, -2.1935759f, 0.50447434f)),
    float4x4(float4(-3.6816344f, 0.75467557f, -2.3304558f, -2.8002195f), float4(0.015614783f, -0.011906751f, -0.8760485f, 0.11018137f), float4(-0.098102964f, 0.012420373f, 0.35013762f, 0.026148027f), float4(-0.21351282f, -1.210738f, 0.7966853f, 2.7524707f)),
    float4x4(float4(0.31600532f, 5.30934f, -2.520569f, -2.4315674f), float4(0.07278491f, 1.2795554f, 0.009831517f, -2.4177828f), float4(-0.12661605f, -5.4307957f, 1.5556282f, -0.08110618f), float4(-2.8565087f, 1.3582026f, -1.4116979f, -0.16265324f)),
    float4x4(float4(-0.73589987f, -1.8186098f, -3.1361523f, -0.6670014f), float4(-0.03481343f, -0.027409472f, 0.004099067f, 0.12583362f), float4(0.7344521f, 0.015158952f, -0.0024454447f, -0.21044949f), float4(-1.7101433f, -2.4010005f, -0.004084912f, 1.2996026f)),
    float4x4(float4(1.2983388f, -4.3570766f, 0.008181664f, -4.825084f), float4(0.48558652f, 4.4745054f, 0.013507118f, 0.6069626f), float4(-0.0434868f, 0.045928214f, 0.0028301273f, 1.4882053f), float4(-3.131018f, 0.5826171f, -3.1153202f, 0.77198803f)),
    float4x4(float4(-0.9910445f, -0.904163f, -1.5641176f, -2.864658f), float4(-0.083755374f, 0.0063637346f, 0.011683597f, 0.011187007f), float4(0.034442373f, 0.11799263f, -0.023390315f, -0.00063614675f), float4(-1.9783124f, -1.914417f, 0.8819491f, 0.25718477f)),
    float4x4(float4(-3.0586958f, 0.8365864f, -0.06522236f, 0.68874294f), float4(3.1094313f, 3.5188265f, -1.9401165f, -0.47256038f), float4(4.0372915f, -6.2797914f, 4.0877624f, 0.31359324f), float4(-1.7055315f, 0.9649301f, -2.1472447f, -2.900496f)),
    float4x4(float4(-1.4472071f, 2.2963274f, 2.3705218f, 2.2554681f), float4(-0.16153613f, -0.079673834f, -0.018015817f, -0.060150318f), float4(0.12294772f, 0.028992303f, -0.045555186f, -0.019207442f), float4(0.8507081f, -4.3222938f, -0.41577208f, -3.083476f)),
    float4x4(float4(-1.8410957f, 1.7540334f, 3.9001808f, -2.7371724f), float4(0.95275414f, 6.0513377f, -0.5543268f, -0.15700881f), float4(0.23935543f, -1.0129763f, 2.4374366f, -0.07785691f), float4(0.5560535f, 1.7531751f, -0.3538989f, 2.367496f)),
    float4x4(float4(-3.226583f, 1.2359289f, 0.43497178f, -0.9067162f), float4(0.015556864f, -0.015596202f, -0.03136817f, -0.15938309f), float4(-0.0067569828f, -0.034082763f, 0.06610979f, 0.1136526f), float4(-0.08873681f, 4.608044f, -0.6641942f, 4.2482862f)),
    float4x4(float4(0.06337031f, -6.222001f, 5.6063294f, 1.8426031f), float4(0.10653678f, -6.1321445f, 1.5532417f, -0.1410054f), float4(0.06972793f, 0.6201484f, -0.56711805f, -0.43043935f), float4(-3.150539f, 0.2765468f, -0.3997977f, -2.271611f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(0.6829811f, 0.4552564f, -3.2760596f, 0.36013925f), float4(-0.5800463f, 0.43397135f, 1.69264f, 0.30690542f), float4(-0.4783497f, -1.8769186f, -0.36985078f, 0.45314348f), float4(-0.5759224f, 1.6655363f, 0.21339335f, -0.35386586f)),
    float4x4(float4(0.2372832f, -1.2258506f, -1.2100883f, 0.62600815f), float4(-0.066582575f, -3.140791f, 0.6086105f, -0.1816485f), float4(1.6568266f, 0.94366187f, 1.452791f, 0.6372167f), float4(0.94753206f, -2.0465593f, -1.1404506f, 0.5200819f)),
    float4x4(float4(0.2525698f, 1.3133736f, 1.5081309f, 0.40640423f), float4(-2.5469668f, 3.0647497f, 1.961718f, -0.2279379f), float4(0.7692778f, 0.06353574f, -0.04536396f, 0.25547245f), float4(-0.38530406f, 0.13071957f, -0.9853148f, -0.6100752f)),
    float4x4(float4(1.201526f, -1.6295567f, -0.10577775f, -0.07252603f), float4(0.32046694f, 4.5078254f, 1.679629f, -1.3366163f), float4(0.42031792f, 2.122224f, -2.394823f, 0.4862653f), float4(1.0541244f, 3.2513852f, 0.64063644f, 0.9955936f)),
    float4x4(float4(-0.4697213f, -0.43738323f, 0.5067631f, 2.4849632f), float4(-1.008181f, -3.3335292f, -0.4435607f, 1.2569082f), float4(37.271965f, 3.6641302f, -26.294731f, 22.284088f), float4(0.35951728f, 0.5743284f, -0.28393292f, 0.44884205f)),
    float4x4(float4(1.4199101f, -3.6519992f, 0.183458f, -0.7993746f), float4(-0.6794883f, 1.0972006f, -5.1737647f, 0.46132165f), float4(0.28014812f, 0.28579018f, 1.746031f, -1.063755f), float4(1.7801558f, 0.8367786f, 1.6030077f, 0.11301107f)),
    float4x4(float4(0.24823749f, -1.8275152f, -0.019702973f, 0.87522876f), float4(-0.50621915f, 1.1135135f, -0.83415365f, 0.8268544f), float4(-0.5979345f, 0.15411714f, -2.3568492f, 0.8475188f), float4(-0.3274668f, -1.5277493f, 0.2688798f, 0.27388895f)),
    float4x4(float4(10.874971f, 12.42683f, 5.842559f, -0.06638575f), float4(-0.65777004f, -2.6616077f, 1.2945762f, -0.5985378f), float4(0.0049922424f, -3.34325f, 0.24058078f, 0.6383325f), float4(-0.7965187f, -0.4404988f, -1.1006935f, 1.348903f)),
    float4x4(float4(-0.8094079f, 1.7176261f, -0.14377983f, -2.757129f), float4(1.6921699f, 0.3660209f, -0.21817191f, 2.6212182f), float4(-0.38670397f, -0.15371713f, -0.54104453f, -0.517166f), float4(-1.6465904f, -0.46712154f, -0.6452769f, 2.7078125f)),
    float4x4(float4(0.09348285f, -0.92333716f, -0.319645f, -1.3942697f), float4(2.403865f, 0.8860558f, -0.30477333f, -3.6571066f), float4(1.70948f, -0.3681143f, 0.00028995858f, -0.15613689f), float4(2.0479991f, 1.0437464f, -0.23805757f, 0.5799883f)),
    float4x4(float4(1.5732657f, 0.47599813f, -0.39566812f, 2.6558812f), float4(0.16562577f, -2.9809244f, 0.26540557f, 2.6580548f), float4(0.2961461f, -2.7786427f, -0.25035608f, -1.6308049f), float4(-0.32568228f, 0.4924949f, -0.44617078f, 1.3649439f)),
    float4x4(float4(2.1699631f, -1.9964819f, 0.15565857f, 1.8082404f), float4(-4.3035827f, -0.22347507f, -0.07782459f, 0.8792134f), float4(1.1266261f, 0.6317852f, -0.50536454f, 0.54505473f), float4(-0.784997f, -0.15872337f, -0.40840897f, 0.6697734f)),
    float4x4(float4(0.2951647f, -0.6987558f, 0.20762779f, 0.12646148f), float4(-0.04911918f, 1.463518f, -0.18238348f, -0.3969412f), float4(-31.135157f, -37.478912f, 0.3344418f, 47.707455f), float4(-0.18904725f, 0.59142f, -0.059459895f, -0.54543406f)),
    float4x4(float4(-4.91993f, 0.56642187f, -0.36549205f, -1.578996f), float4(-0.20717756f, 1.3421755f, 0.062208284f, -2.920778f), float4(-2.4493325f, -1.5143138f, -0.60092473f, 2.2542384f), float4(-4.9907455f, -1.8576738f, 0.09445477f, -0.8239596f)),
    float4x4(float4(0.37535796f, -0.27190244f, -0.026879478f, 0.29014108f), float4(-1.5183576f, -0.30159974f, -0.09423651f, -3.7453754f), float4(1.259349f, 1.616043f, -0.4829352f, -0.7078577f), float4(-0.29548636f, 1.4898285f, -0.08079305f, -1.240063f)),
    float4x4(float4(-3.241739f, -8.801097f, -0.3190928f, 14.118077f), float4(0.7231529f, 2.0822303f, -0.29040316f, -1.3749658f), float4(0.41152754f, 0.70593184f, -0.2175248f, -1.3170816f), float4(-0.4691217f, 0.59334093f, -0.2875347f, -0.6505199f)),
    float4x4(float4(0.2588046f, 0.050598793f, -0.1957072f, -2.4178843f), float4(0.8062275f, -0.35454574f, -0.27731386f, -1.8463589f), float4(-1.0551894f, -0.53113884f, 1.7193325f, 1.3309753f), float4(3.8486824f, -0.51003414f, 1.3354453f, 2.512551f)),
    float4x4(float4(-6.962362f, -0.23192449f, -3.2870865f, 0.21033812f), float4(-2.11509f, -0.8931894f, -1.7718272f, -2.100163f), float4(0.72065806f, -0.9571276f, -4.074887f, -1.375578f), float4(1.4292604f, -0.16587515f, -0.5036972f, -0.48608148f)),
    float4x4(float4(0.16909121f, 0.2950534f, -22.085249f, 0.5762201f), float4(-1.8950677f, 0.031374052f, -0.0006421367f, 3.3723443f), float4(-2.2480342f, -0.5153087f, -0.0328764f, 0.7178497f), float4(-2.6809874f, 0.7107395f, -2.248753f, 0.2450338f)),
    float4x4(float4(1.3544649f, -0.441318f, 0.014433879f, 1.1643527f), float4(7.6564403f, -0.116867736f, -11.974907f, -0.4382366f), float4(0.18654051f, -0.36403257f, -0.792968f, 1.3313892f), float4(1.2513425f, -1.0578707f, 0.22549942f, -0.52266985f)),
    float4x4(float4(-0.22287236f, -0.4188799f, 0.9217529f, 0.55707884f), float4(0.13522571f, -1.0391183f, 1.9100517f, -0.12969998f), float4(29.551878f, 0.17746745f, -6.0563235f, -47.547195f), float4(-1.2280582f, 0.22442098f, -1.3063138f, -1.3029408f)),
    float4x4(float4(2.5341663f, -0.4360425f, -0.07981592f, 0.3189538f), float4(-1.6002214f, 0.09734367f, -9.558946f, 1.872932f), float4(1.3216597f, -0.34509614f, 2.825232f, 1.6228634f), float4(0.6092978f, -0.03591627f, 3.5473008f, 1.1023191f)),
    float4x4(float4(0.3594169f, -0.9171074f, -3.784895f, -0.7832569f), float4(-1.588527f, -1.0116782f, 0.9760825f, -0.46781194f), float4(0.89400494f, -0.03475846f, -0.8669509f, 0.5508923f), float4(-0.88579315f, -0.15156104f, -0.6192565f, 2.7477405f)),
    float4x4(float4(8.222077f, -0.70817393f, -2.307931f, 2.1200726f), float4(-8.574386f, -0.3667204f, -7.1504316f, -3.4449544f), float4(-0.6365092f, -0.90271753f, 1.0125942f, 0.18720314f), float4(-0.82444096f, 0.1657539f, -0.34768492f, -0.96311295f)),
    float4x4(float4(1.7896386f, -0.403414f, -0.1782726f, 0.7377316f), float4(3.399088f, -0.11528515f, 1.6411926f, 1.8271717f), float4(0.27693757f, 0.1787868f, -2.6038008f, -0.18954186f), float4(0.20033489f, -0.14003548f, -2.7112818f, 4.896935f)),
    float4x4(float4(1.1674491f, -0.2839422f, 0.58546615f, -0.9488784f), float4(1.6502135f, -0.10524968f, -1.1594074f, -0.99774444f), float4(-0.63047576f, -0.12047331f, -4.2065034f, -0.6892302f), float4(-0.02288178f, 0.17193796f, 0.9352845f, 1.1044908f)),
    float4x4(float4(-1.328938f, -0.12219198f, 0.8097793f, 0.013792836f), float4(-0.92077255f, -0.058132254f, 0.9649274f, -0.6958826f), float4(-10.73252f, 0.24786207f, 1.4728177f, -4.649633f), float4(-1.3106949f, -0.25863177f, 1.1633449f, -0.6684613f)),
    float4x4(float4(2.2923346f, -0.48755655f, -2.5706587f, 1.5302451f), float4(-1.8465054f, 0.30810782f, -0.040619247f, 2.2835648f), float4(0.31407765f, -0.0032726983f, -1.140029f, 0.4757531f), float4(-0.06774242f, 0.05301843f, 1.2660664f, 0.52409077f)),
    float4x4(float4(0.096316226f, -0.13515253f, 1.9828489f, -0.7120582f), float4(-0.052532572f, -0.2707763f, -1.3555428f, 0.22093304f), float4(-17.776276f, -0.3363576f, 13.136999f, 25.863195f), float4(-0.31807745f, -0.07372902f, -0.030780459f, -0.75753033f)),
    float4x4(float4(0.30170846f, 0.03353345f, 0.34369317f, 1.9270494f), float4(-2.4706056f, -0.010040872f, 0.554029f, 0.7586483f), float4(-1.1840302f, 0.037181307f, -0.3827963f, 2.281691f), float4(-2.055089f, -0.33115646f, -6.3645334f, -0.5354063f)),
    float4x4(float4(0.6006043f, -0.29821768f, -1.7520251f, 0.14276884f), float4(0.024878476f, -0.27711263f, 4.2765703f, -0.9512076f), float4(-1.1752247f, -0.47072172f, -0.27052337f, -0.72006303f), float4(0.7196898f, -0.0633583f, -1.5868052f, -0.6702463f)),
    float4x4(float4(4.140658f, -0.18403074f, -4.9940486f, 2.4428742f), float4(0.34171128f, -0.057354867f, 4.1671295f, -9.057711f), float4(0.98701304f, -0.09638241f, -3.6698697f, -0.9148877f), float4(0.6410383f, -0.23466079f, 0.65903014f, -0.31175098f))
};
static const float4 NMT_B2[4] = {
    float4(-0.36086652f, -2.0384705f, -1.4668782f, 0.18145208f),
    float4(1.1100335f, -1.0497862f, -0.26795477f, 1.0546376f),
    float4(0.795125f, -0.6150717f, -2.491465f, -1.7169538f),
    float4(-1.1883317f, -0.21181983f, -4.0430284f, 0.21472351f)
};
static const float4 NMT_W3[4] = {
    float4(-0.521507f, 0.34362823f, 0.31546113f, -0.34801242f),
    float4(0.21547896f, 0.2207384f, 0.21756127f, -0.42271125f),
    float4(0.4423995f, 0.27002415f, 0.18167612f, 0.22458315f),
    float4(0.19890426f, -0.020198334f, 0.15465632f, -0.37186828f)
};
static const float NMT_B3 = -0.5558889f;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(float2x4 f) {
    float4 h0_0 = f[0];
    float4 h0_1 = float4(f[1].xyz, 1.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]) + mul(h0_1, NMT_W1[1]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[2]) + mul(h0_1, NMT_W1[3]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[4]) + mul(h0_1, NMT_W1[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_3 = max(mul(h0_0, NMT_W1[6]) + mul(h0_1, NMT_W1[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_4 = max(mul(h0_0, NMT_W1[8]) + mul(h0_1, NMT_W1[9]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_5 = max(mul(h0_0, NMT_W1[10]) + mul(h0_1, NMT_W1[11]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_6 = max(mul(h0_0, NMT_W1[12]) + mul(h0_1, NMT_W1[13]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_7 = max(mul(h0_0, NMT_W1[14]) + mul(h0_1, NMT_W1[15]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_0 = max(NMT_B2[0] + mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]) + mul(h1_4, NMT_W2[4]) + mul(h1_5, NMT_W2[5]) + mul(h1_6, NMT_W2[6]) + mul(h1_7, NMT_W2[7]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(NMT_B2[1] + mul(h1_0, NMT_W2[8]) + mul(h1_1, NMT_W2[9]) + mul(h1_2, NMT_W2[10]) + mul(h1_3, NMT_W2[11]) + mul(h1_4, NMT_W2[12]) + mul(h1_5, NMT_W2[13]) + mul(h1_6, NMT_W2[14]) + mul(h1_7, NMT_W2[15]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_2 = max(NMT_B2[2] + mul(h1_0, NMT_W2[16]) + mul(h1_1, NMT_W2[17]) + mul(h1_2, NMT_W2[18]) + mul(h1_3, NMT_W2[19]) + mul(h1_4, NMT_W2[20]) + mul(h1_5, NMT_W2[21]) + mul(h1_6, NMT_W2[22]) + mul(h1_7, NMT_W2[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_3 = max(NMT_B2[3] + mul(h1_0, NMT_W2[24]) + mul(h1_1, NMT_W2[25]) + mul(h1_2, NMT_W2[26]) + mul(h1_3, NMT_W2[27]) + mul(h1_4, NMT_W2[28]) + mul(h1_5, NMT_W2[29]) + mul(h1_6, NMT_W2[30]) + mul(h1_7, NMT_W2[31]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float2x4 f) {
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
// Slots of a pixel, empty ones at the end among them, a multiple of four.
static const uint NMT_SLOTS = 8u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
static const float NMT_KEY_SCALE = 0.375;
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
    uint shift = max(firstbithigh(range) + 1u, NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
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
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_6) * nmt_transmittance(float2x4(float4(x, log2(others) * 0.33333334 - 1.0,
        log(absorbance_of_tail + 0.05), mean), float4(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean
        * mean, 1e-6), 0.0, 1.0), mean_2, sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2)
        / max(1.0 - mean_2 * mean_2, 1e-6), 0.0, 1.0)), 0.0)));
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
