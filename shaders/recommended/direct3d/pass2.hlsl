// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1.
//
// Neural moment transparency: network 'recommended', 7-32-16-1, 752 multiply-adds.
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 3 x 600, dataset b329efeb897a86799fe59c425268dc10595a6b88aa3a06fcbd8c3af287331927.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.438e-3, worst 0.994.

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// ln(a / b), as accurate relative to itself where a is near b as elsewhere.
float nmt_log_ratio(float a, float b) {
    float s = (a - b) / (a + b);
    float q = s * s;
    return (abs(s) < 0.2 ? (s + s) * (1.0 + q * (0.33333334 + q * (0.2 + q * (0.14285715 + q * 0.11111111))))
        : log(a / b));
}

// Moment depth of view depth v; v0 and v1 are the least and the greatest of the scene. Where a prepass has found the
// pixel's own nearest and farthest view depth, these may be v0 and v1 in both passes: then no pixel is too thin for its
// moments.
float nmt_moment_depth(float v, float v0, float v1) {
    return (v1 > v0 ? clamp(2.0 * nmt_log_ratio(v, v0) / max(nmt_log_ratio(v1, v0), 1e-30) - 1.0, -1.0, 1.0) : 0.0);
}

// Rounding of a stored moment, as a share of b0: of f32 sums 2^-23, of f16 sums 2^-10.
static const float NMT_ROUNDING = 1.1920929e-7;

// Pass 1: what a fragment at moment depth z adds to b1, b2 and so on; to b0 it adds its absorbance, to n it adds 1.
float4 nmt_moments(float z, float absorbance) {
    float moment1 = absorbance * z;
    float moment2 = moment1 * z;
    float moment3 = moment2 * z;
    float moment4 = moment3 * z;
    return float4(moment1, moment2, moment3, moment4);
}

// Moments of the other fragments in the pixel's own range, centre c and half-range 1 / per_h, normalised by their
// absorbance 1 / per_b0.
float4 nmt_recentred_moments(float z, float absorbance, float c, float per_h, float per_b0, float4 b) {
    float4 own = nmt_moments(z, absorbance);
    float m1 = (b.x - own.x) * per_b0;
    float m2 = (b.y - own.y) * per_b0;
    float m3 = (b.z - own.z) * per_b0;
    float m4 = (b.w - own.w) * per_b0;
    // Moments of z - c, one factor at a time.
    float m4_2 = m4 - c * m3;
    float m3_2 = m3 - c * m2;
    float m2_2 = m2 - c * m1;
    float m1_2 = m1 - c;
    float m4_3 = m4_2 - c * m3_2;
    float m3_3 = m3_2 - c * m2_2;
    float m2_3 = m2_2 - c * m1_2;
    float m4_4 = m4_3 - c * m3_3;
    float m3_4 = m3_3 - c * m2_3;
    float m4_5 = m4_4 - c * m3_4;
    float per_h2 = per_h * per_h;
    float per_h3 = per_h2 * per_h;
    float per_h4 = per_h2 * per_h2;
    return float4(clamp(m1_2 * per_h, -1.0, 1.0), clamp(m2_3 * per_h2, -1.0, 1.0), clamp(m3_4 * per_h3, -1.0, 1.0),
        clamp(m4_5 * per_h4, -1.0, 1.0));
}

// Shrinks a noisy value towards what is expected of it, as far as the noise exceeds the usual deviation.
float nmt_shrink_to_prior(float value, float expected, float noise, float deviation) {
    float bounded = min(noise, 1e15);
    float trust = deviation * deviation;
    return expected + (value - expected) * (trust / (trust + bounded * bounded));
}

// Place of view depth v in the range of a thin pixel, in [-1, 1], where view depth says more than moment depth.
float nmt_place_in_thin(float v, float nearest, float farthest) {
    float range = farthest - nearest;
    float t = (v - nearest) / max(range, 1e-30);
    float x = t * (1.0 + 0.5 * (range / nearest) * (1.0 - t));
    return clamp(x + x - 1.0, -1.0, 1.0);
}

// Share of the others' absorbance in front of place x in a pixel of four: atoms at -1, u and 1 have this mean and
// spread. Within the transition width of u, in front and behind go over into one another.
float nmt_share_of_four(float x, float mean, float spread, float u, float transition_width) {
    float inner = (1.0 - spread) * (1.0 - mean * mean);
    float near_end = clamp(0.5 * (1.0 - mean - inner / max(1.0 + u, 1e-6)), 0.0, 1.0);
    float far_end = clamp(0.5 * (1.0 + mean - inner / max(1.0 - u, 1e-6)), 0.0, 1.0);
    float behind = clamp(0.5 + 0.5 * (x - u) / transition_width, 0.0, 1.0);
    return clamp(near_end + behind * (1.0 - far_end - near_end), 0.0, 1.0);
}

static const float4x4 NMT_W1[16] = {
    float4x4(float4(-4.1674604f, 1.9599856f, -0.73242956f, -0.20504631f), float4(-0.12590207f, 0.52091557f, 0.07906628f, 0.021661459f), float4(0.08731185f, -0.010980034f, -0.04702237f, -0.014140079f), float4(-2.3502588f, 0.98347735f, 5.2544265f, 7.5886335f)),
    float4x4(float4(-2.0677073f, -3.0403187f, -7.251252f, -0.21163398f), float4(4.0386076f, -0.3408012f, -6.547609f, -0.27915618f), float4(2.371881f, -3.6694639f, 2.8083203f, 0.16396397f), float4(-4.5592628f, 3.2408876f, 0.7731898f, -6.0322914f)),
    float4x4(float4(-0.46817917f, 2.2209268f, 0.42732853f, -2.1391058f), float4(0.6626024f, 0.12554957f, 0.15880474f, 0.08205461f), float4(-0.002107043f, 0.067374885f, -0.04141126f, 0.018053476f), float4(-0.02131919f, -5.3346705f, 6.854231f, 0.49863964f)),
    float4x4(float4(-2.3983507f, -2.2166302f, -9.364158f, -4.6879478f), float4(-7.131321f, 0.9307025f, -5.2908893f, -0.09217429f), float4(0.18057501f, -0.056932688f, -5.222522f, 5.909689f), float4(-3.2400908f, 1.7953771f, 2.3643174f, -2.5787416f)),
    float4x4(float4(-2.0212417f, 3.5234349f, -0.29862827f, 2.837473f), float4(-0.0034417917f, -0.2701374f, -0.06850981f, 0.26511696f), float4(0.06310855f, -0.074502654f, 0.0036534448f, -0.02181142f), float4(1.1280895f, -0.06773128f, 7.143841f, -0.33201975f)),
    float4x4(float4(-5.189434f, -2.4549117f, -0.16383393f, 2.9110465f), float4(-3.691939f, -2.2927215f, -1.7290045f, 0.5228869f), float4(3.423124f, 4.379191f, -0.54773974f, -2.3272412f), float4(0.18388788f, 1.0360488f, -2.4800966f, 1.8856108f)),
    float4x4(float4(-3.5864356f, 3.698348f, -2.763185f, -2.920156f), float4(0.78295255f, 0.015520756f, -0.32045588f, -0.06508547f), float4(0.009859245f, -0.076360114f, 0.06714014f, 0.014959682f), float4(-0.39343145f, -0.1780676f, 4.0171967f, -0.3578333f)),
    float4x4(float4(1.4050651f, 0.118033335f, -6.476847f, -0.18825664f), float4(0.19789477f, -0.5731352f, -5.180575f, 3.0493782f), float4(-0.75208825f, 6.0289307f, 3.036596f, 0.6782269f), float4(-4.040601f, -2.1219463f, -0.72817266f, 0.23356485f)),
    float4x4(float4(0.33965114f, 0.53012913f, 3.6864781f, 0.75859493f), float4(0.00060585595f, -2.9309227f, -0.36718613f, -0.3317407f), float4(0.033321146f, 1.2089126f, 0.2153916f, -0.0014231349f), float4(7.1874413f, 0.3191635f, -8.419987f, -2.4559073f)),
    float4x4(float4(-11.693587f, -2.831591f, -2.3943553f, -8.275588f), float4(-7.1602225f, -0.7036662f, 2.2086513f, 3.6333103f), float4(4.0300922f, 1.7700683f, 1.188168f, 7.4534593f), float4(0.7538325f, -0.7767871f, 0.016310979f, 0.18021783f)),
    float4x4(float4(-1.3306596f, 1.8677293f, -4.101393f, -4.6770787f), float4(0.19519782f, -0.48456788f, -0.20488237f, 0.021339769f), float4(-0.010044715f, -0.031366363f, 0.050242912f, 0.015430227f), float4(-4.2732124f, 1.70702f, 0.0028088223f, -0.010693944f)),
    float4x4(float4(-3.774896f, -1.1750406f, -0.93092984f, -0.049676165f), float4(4.5747614f, -0.64899164f, -0.34892794f, -0.11725599f), float4(-2.6529639f, -2.241756f, 1.2695652f, 0.121937424f), float4(1.5011057f, 2.9329836f, -3.6110363f, -4.5134344f)),
    float4x4(float4(-4.6046376f, 3.0093236f, 4.978195f, 1.5529538f), float4(-5.0088716f, 0.49800482f, 0.108492136f, 0.17909843f), float4(0.19106047f, 0.006962222f, -0.0562687f, -0.05636758f), float4(2.4868011f, -2.9974f, 1.1363013f, 0.8436937f)),
    float4x4(float4(-3.112934f, 2.7212074f, -0.7725423f, 2.895838f), float4(-1.4298413f, 2.0517163f, -5.190096f, -2.2426555f), float4(1.0851005f, 1.2990258f, 1.9417673f, -7.12554f), float4(-1.7792232f, 0.8998802f, 0.6199238f, 1.7865978f)),
    float4x4(float4(-4.373691f, 7.469767f, 0.73178667f, 0.19036344f), float4(0.18150902f, -0.09014448f, -0.10938936f, 0.30877957f), float4(-0.00059860875f, -0.04931852f, -0.033257622f, 0.008763494f), float4(0.013503743f, -1.9672016f, -3.3122485f, 2.5027857f)),
    float4x4(float4(-0.16557512f, -2.3265748f, 3.9967105f, 5.9642453f), float4(4.2863545f, -0.5382311f, 1.9298717f, -1.1969867f), float4(-1.3004589f, -0.5782102f, -3.2860882f, 0.18440095f), float4(0.19718102f, -2.082068f, 1.6094493f, -3.5837553f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(2.0213919f, -2.91184f, 1.5348691f, -0.2929838f), float4(1.3055472f, 0.27231f, -0.8899139f, -0.4409711f), float4(0.11069353f, -1.8431019f, 0.17304926f, 0.8809019f), float4(-5.399847f, -17.517437f, 0.47533467f, 6.2987537f)),
    float4x4(float4(0.419285f, -0.42110118f, 2.5071044f, -1.4210333f), float4(-0.7503765f, 0.8864603f, 0.037235156f, 0.37260938f), float4(0.6845067f, 0.44033587f, -0.28448498f, 0.24686478f), float4(2.7418797f, 1.6742915f, 0.8079822f, -0.8698964f)),
    float4x4(float4(0.9036239f, -0.82326996f, -0.8262928f, -0.335104f), float4(-0.41287225f, -0.55577654f, -1.3758198f, -0.18870488f), float4(-0.63340414f, 0.42160872f, 0.7002752f, 2.267698f), float4(-1.08188f, -3.98043f, -1.4021765f, 0.6892029f)),
    float4x4(float4(3.4161088f, 0.7640683f, 1.9327487f, 1.83947f), float4(-5.0462413f, -0.713245f, -0.014138731f, -0.31107137f), float4(1.3723212f, 2.744764f, -0.30109656f, -0.48658893f), float4(0.26442823f, -1.2755157f, 0.42979032f, 0.022228852f)),
    float4x4(float4(0.9166541f, 2.8674293f, -2.7461586f, -0.11615238f), float4(0.077809386f, -2.372911f, -0.1854338f, 0.5619069f), float4(-1.2895492f, -0.69098186f, -1.6812513f, 0.17504105f), float4(-1.556445f, 1.623512f, 1.1337266f, 2.044273f)),
    float4x4(float4(-0.8967381f, 2.4832838f, 0.3154895f, 0.5799579f), float4(0.76742953f, -1.2556587f, 1.0351061f, 0.9519333f), float4(0.7550382f, -0.7536835f, -8.745191f, -0.5979435f), float4(-0.6330228f, -5.822986f, -24.325792f, 3.6463118f)),
    float4x4(float4(-0.16797684f, 1.0777332f, -0.6376268f, -0.33728403f), float4(-1.061007f, 2.0483856f, 1.2846082f, -0.06528943f), float4(-2.8672419f, -0.13821496f, -0.40658525f, -0.7010545f), float4(0.73339987f, 0.85867685f, -2.980733f, -0.6767882f)),
    float4x4(float4(-0.17565668f, -0.66932446f, -0.087680444f, 0.82007885f), float4(-0.81018645f, -5.083275f, 6.716149f, -2.5253572f), float4(-0.21873666f, 1.6195232f, 0.10287789f, -0.7853111f), float4(-0.8664899f, 1.8022391f, 0.12425704f, -0.12265211f)),
    float4x4(float4(-0.019619394f, -2.9439027f, 0.20967697f, -3.419845f), float4(-3.0203755f, -0.17222819f, -0.21907517f, -0.1506443f), float4(0.2171478f, -0.16118884f, -0.34547976f, 3.1116161f), float4(0.59133464f, 0.16578314f, -0.26919577f, -17.852287f)),
    float4x4(float4(-1.9658519f, -0.026431112f, -0.32840747f, 2.9921103f), float4(-3.432273f, 0.28572825f, -0.3039937f, -1.5232166f), float4(-1.0966971f, -0.76801056f, 0.27018806f, 3.2838664f), float4(-0.8133999f, -0.12406365f, -0.23587477f, 0.42709732f)),
    float4x4(float4(-6.489317f, 0.13252488f, -0.26811773f, 2.2592547f), float4(-3.6722937f, 0.4313345f, 0.27116078f, -0.16659443f), float4(0.10130279f, 0.19058819f, 0.043735087f, -3.4506261f), float4(2.148812f, -1.1394475f, -0.23171818f, -2.8741112f)),
    float4x4(float4(0.6639304f, 3.6351647f, 0.15170369f, -0.9139982f), float4(1.5778636f, -0.57759607f, -0.076416016f, -17.85372f), float4(-2.942476f, -1.2473558f, -0.3413897f, 1.8454653f), float4(-6.107756f, -0.2496649f, -0.2933674f, -0.3217662f)),
    float4x4(float4(0.27639863f, -0.020356344f, 0.20805937f, 5.0024533f), float4(0.27502623f, 0.33333814f, -0.17369579f, 0.3428085f), float4(0.2811654f, -0.09691671f, 0.3376751f, -4.3889575f), float4(0.5050634f, 0.056959357f, 0.15600675f, 0.9328736f)),
    float4x4(float4(0.6798183f, 0.561105f, -0.29834086f, -1.388716f), float4(0.93923146f, -0.38923523f, -0.0074161366f, -0.62310964f), float4(-0.27356088f, -3.8132336f, -0.326761f, -3.2853408f), float4(-0.17321798f, -10.054951f, 0.094018586f, -4.1044903f)),
    float4x4(float4(-2.9375002f, -1.5772644f, -0.028824203f, 0.39525685f), float4(0.2538739f, 0.6404099f, -0.08917889f, -0.23136254f), float4(-1.4123424f, 0.49519774f, -0.28288534f, -4.4888506f), float4(-0.19552387f, 0.031744648f, -0.024117399f, 3.5014074f)),
    float4x4(float4(-6.388915f, 0.25000545f, -0.319836f, -0.93253845f), float4(9.816028f, 2.536431f, 0.09538501f, -0.33083022f), float4(-3.8032932f, 1.2661434f, -0.16308375f, -2.2764294f), float4(1.7594389f, -0.51916075f, -0.13081738f, -2.6253278f)),
    float4x4(float4(1.9530706f, -1.8485831f, 0.2109906f, -0.25858083f), float4(0.93915653f, 1.6989772f, 0.10935656f, 3.243871f), float4(-1.668992f, 0.26239094f, -0.19926538f, -0.2640662f), float4(-4.7925825f, -1.5411111f, -1.9145753f, 1.6478897f)),
    float4x4(float4(-0.35818458f, 1.2148889f, 0.3322431f, 2.009875f), float4(-0.88717693f, 2.085225f, -0.059712175f, -0.7660865f), float4(-5.2038116f, 1.1421809f, -0.069393694f, -1.2104797f), float4(1.4166483f, 8.891604f, -0.19883786f, 2.5516102f)),
    float4x4(float4(-0.8331628f, -0.74940425f, -0.5258979f, -0.38192207f), float4(-0.61086315f, -1.6954087f, 0.03969145f, 2.0987928f), float4(0.17930607f, -0.91649634f, -0.14285758f, -1.7155297f), float4(0.8023482f, 0.7970375f, 0.6197916f, -5.2210584f)),
    float4x4(float4(-2.5854452f, 5.9796576f, 0.61167616f, 0.4250337f), float4(1.3043399f, 2.8135962f, -0.05531424f, -0.15286618f), float4(1.3677459f, 2.6523335f, 0.37061626f, 0.8490703f), float4(-0.28107482f, -19.692179f, -0.19836535f, -1.71023f)),
    float4x4(float4(1.2583504f, -0.7968344f, 0.369631f, 0.28707027f), float4(0.32727537f, 0.16690618f, -0.3634363f, 0.88905156f), float4(0.014350122f, -0.15114553f, 0.2937969f, 1.5788385f), float4(-4.5339465f, -0.17390747f, -0.241532f, 0.70758146f)),
    float4x4(float4(-0.5519906f, 2.8230247f, 0.05278055f, 0.54575557f), float4(-1.3154308f, 0.656429f, 0.7821612f, -9.275172f), float4(1.1405544f, -2.1575017f, 1.4119513f, 0.7853599f), float4(3.2076383f, -6.13053f, 15.256626f, -12.406102f)),
    float4x4(float4(1.2811682f, 0.083948754f, -0.37948f, -0.4940118f), float4(-1.1444502f, -2.5660405f, -0.552346f, 0.1214361f), float4(0.5068235f, -0.47298962f, 0.4408889f, -2.732477f), float4(-0.5066367f, -0.8545023f, -0.51588374f, -1.2569976f)),
    float4x4(float4(0.5785463f, -32.425995f, 0.42408907f, 0.9343084f), float4(-3.902431f, -0.7520251f, -0.06531561f, -4.5250793f), float4(1.669008f, 1.2654543f, 0.5549053f, 3.3851264f), float4(-0.31843388f, -0.1135918f, 0.2259276f, 3.8177497f)),
    float4x4(float4(1.9812528f, -0.36313337f, -0.7867708f, -1.8871622f), float4(-0.3773511f, -0.16610058f, 1.1051798f, 1.2316991f), float4(1.8488358f, -0.046805546f, -0.6921194f, -0.5387434f), float4(0.3181373f, -0.18279947f, -1.689014f, 3.066741f)),
    float4x4(float4(-0.34661636f, -0.4327142f, 1.5718977f, -0.5606247f), float4(-0.03964064f, -0.23198833f, 0.47888073f, -0.5954511f), float4(-0.36834794f, -0.23371373f, 0.15666945f, 0.93414724f), float4(-0.281857f, 0.20966858f, 8.412329f, 9.048968f)),
    float4x4(float4(-0.34866777f, -0.29574445f, 2.2201583f, 1.0108215f), float4(2.1363382f, -0.027613534f, -1.1590986f, -0.66171604f), float4(0.34671408f, 0.07055651f, -0.63689375f, -0.49965852f), float4(-1.2961404f, -0.75858885f, 0.23002268f, 0.47372976f)),
    float4x4(float4(-0.008777903f, -0.58365583f, -7.097225f, -0.7343006f), float4(-2.659016f, 0.31216386f, 0.68762773f, 0.2661025f), float4(-1.6388949f, -0.17292544f, -0.52062505f, -0.22462904f), float4(0.8361993f, -0.09593139f, -4.261884f, -0.79932857f)),
    float4x4(float4(-0.23727515f, -0.091116585f, 0.93601537f, -2.982952f), float4(0.032420382f, -0.21857665f, -0.6826385f, 0.1599772f), float4(0.47912702f, -0.3265304f, -0.20499313f, -1.6727635f), float4(1.9387163f, -0.111314304f, -0.61201704f, 2.9126418f)),
    float4x4(float4(-0.80854404f, 0.07845742f, -2.8177385f, 0.109425806f), float4(0.19731739f, -0.1832566f, 0.387768f, 0.2938763f), float4(-1.713297f, 0.05192612f, -10.083423f, -0.7480528f), float4(-8.829212f, -0.33925098f, -16.97128f, -2.5043054f)),
    float4x4(float4(-0.6140045f, -0.27008948f, -0.00565183f, 0.40399697f), float4(1.3195682f, -0.2859485f, -0.6891265f, -0.010279318f), float4(-0.27614084f, -0.34485704f, 1.0004749f, -2.5375779f), float4(0.1936343f, -0.15814485f, -0.32213724f, -0.7124809f)),
    float4x4(float4(-1.5785738f, -0.5448545f, -7.9740224f, -0.3882083f), float4(-1.0468239f, -0.4249315f, -0.3257484f, -0.8561734f), float4(-0.07593948f, -0.07261215f, 0.73661035f, 0.53244424f), float4(0.6394129f, -0.39995986f, -1.0125879f, -0.50449544f))
};
static const float4 NMT_B2[4] = {
    float4(1.5403837f, -1.8343279f, -0.9217493f, 1.313698f),
    float4(-7.616127f, 0.743722f, -0.04113058f, -1.5676365f),
    float4(-1.6024822f, 0.326761f, -5.2702546f, -9.288301f),
    float4(2.192788f, -0.38622347f, 1.562341f, -3.0405202f)
};
static const float4 NMT_W3[4] = {
    float4(-0.23133157f, 0.07465856f, 0.11972243f, -0.19268681f),
    float4(0.34225202f, 0.15328355f, -0.12462099f, -0.17171375f),
    float4(0.09308249f, 0.25963008f, -0.57784873f, 0.18180469f),
    float4(0.15193784f, 0.23329662f, 0.12255926f, -0.111732274f)
};
static const float NMT_B3 = -1.1533976f;

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

// Pass 2: transmittance in front of a fragment, exp(-front). Parameters as of nmt_recentred; what is known without the
// network branches around the features and the network, so that groups of threads in which all is known skip them.
float nmt_fragment_transmittance(float v, float z, float absorbance, float nearest, float farthest, float z_nearest,
    float z_farthest, float n, float b0, float4 b) {
    float others = clamp(b0 - absorbance, 0.0, 1e30);
    float front = 0.0;
    if (v != nearest) {
        if (others > 1e-6 * b0) {
            front = others;
            if (v != farthest) {
                float c = 0.5 * (z_nearest + z_farthest);
                float per_b0 = 1.0 / max(max(others, b0 * 1e-6), 1e-30);
                float per_h = 1.0 / max(0.5 * (z_farthest - z_nearest), 1e-8);
                float4 m = nmt_recentred_moments(z, absorbance, c, per_h, per_b0, b);
                float noise_growth = 1.0 + 2.0 * abs(c) * per_h;
                float moment_noise = NMT_ROUNDING * noise_growth * b0 * per_b0;
                float noise1 = moment_noise * (0.12 * sqrt(n));
                float per_n = 1.0 / n;
                float mean0 = nmt_shrink_to_prior(m.x, 0.0, noise1, 0.22 + 0.7 * per_n);
                front = others * clamp(0.5 - 0.5 * mean0, 0.0, 1.0);
                if (n != 3.0) {
                    float x = ((farthest - nearest) / nearest < 0.01 ? nmt_place_in_thin(v, nearest, farthest)
                        : clamp((z - c) * per_h, -1.0, 1.0));
                    float further = noise_growth * 0.87;
                    float noise2 = noise1 * further;
                    float noise3 = noise2 * further;
                    float most0 = max(1.0 - mean0 * mean0, 1e-6);
                    float raw_spread0 = clamp((m.y - mean0 * mean0) / most0, 0.0, 1.0);
                    float spread0 = nmt_shrink_to_prior(raw_spread0, 0.3 + 1.8 * per_n, noise2 / most0, 0.12 + 0.5
                        * per_n);
                    // The same of (1 - x^2) times the measure, which does not hold the ends.
                    float per_mass1 = 1.0 / max(1.0 - m.y, 1e-6);
                    float raw_mean1 = clamp((m.x - m.z) * per_mass1, -1.0, 1.0);
                    float expected_mean1 = mean0 * (1.0 - spread0) / (1.0 + spread0);
                    float deviation = (0.17 + 3.1 * per_n) * (spread0 + 0.02);
                    float noise = noise3 * per_mass1;
                    float all_noise = noise + 9.536743e-7 * per_mass1;
                    float mean1 = nmt_shrink_to_prior(raw_mean1, expected_mean1, noise, deviation);
                    float transition_width = all_noise * deviation / (all_noise + deviation);
                    front = others * nmt_share_of_four(x, mean0, spread0, mean1, transition_width);
                    if (n != 4.0) {
                        float most1 = max(1.0 - mean1 * mean1, 1e-6);
                        float raw_square1 = clamp(((m.y - m.w) * per_mass1 - mean1 * mean1) / most1, 0.0, 1.0);
                        float offset = mean1 * (1.0 + spread0) - mean0 * (1.0 - spread0);
                        float square0 = spread0 * spread0;
                        float expected_square1 = clamp((0.94 - 3.8 * per_n + 4.0 * square0 * square0 - 1.2 * offset
                            * offset) * spread0 / (1.0 + spread0 + spread0), 0.0, 1.0);
                        float spread1 = sqrt(nmt_shrink_to_prior(raw_square1, expected_square1, noise3 * further
                            * per_mass1 / most1, (0.12 + 1.4 * per_n) * (spread0 + 0.02)));
                        front = others * nmt_share(float2x4(float4(x, log(n) * 0.48089835 - 1.0, log(others + 0.05),
                            mean0), float4(spread0, mean1, spread1, 0.0)));
                    }
                }
            }
        }
    }
    return min(exp(-front), 1.0);
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, float4 sums0, float4 sums1, float4 range) {
    float nearest = -range.x;
    return nmt_fragment_transmittance(v, nmt_moment_depth(v, v0, v1), nmt_absorbance(alpha), nearest, range.y,
        nmt_moment_depth(nearest, v0, v1), nmt_moment_depth(range.y, v0, v1), sums1.y, sums0.x, float4(sums0.yzw,
        sums1.x));
}

cbuffer Frame : register(b0) {
    float2 v_range;
};

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> sums1_texture : register(t1);
Texture2D<float4> range_texture : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    int3 at = int3(int2(input.position.xy), 0);
    float T = nmt_pass2(
        input.v, v_range.x, v_range.y, input.color.a,
        sums0_texture.Load(at),
        sums1_texture.Load(at),
        range_texture.Load(at));
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
