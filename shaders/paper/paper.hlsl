// Neural moment transparency: network 'paper', 7-32-16-1, 752 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
//
// Features, set 'paper', in this order: d, n, b0, b1, b2, b3, b4.
// w is window depth in [0, 1], as gl_FragCoord.z holds it; moments are taken of z = 2w - 1.
// d = (e^w - e^w_min) / (e^w_max - e^w_min) over the fragments of the pixel, 0 where w_min = w_max;
// n = number of fragments of the pixel; b0 = sum of A; b_k = sum of A z^k;
// A = min(-ln(1 - alpha), 10) is a fragment's absorbance, and every sum takes in all fragments of the pixel.
// The answer is T = exp(-sum of A over the fragments nearer than this one).
//
// Provenance: nmt 0.1.0, commit 122c62af9569, backend fused, seed 1, epochs 1000, dataset 7efe7a15adf78c7d3c08d1766f86933c7206479e931a41fb0eb5cd099252fcd5.
// Measured on fresh pixels of the training distribution: mean squared error of T 5.094e-3, worst 0.657.

#ifndef NMT_INCLUDED_PAPER
#define NMT_INCLUDED_PAPER

// e^x - 1 for 0 <= x <= 1, without the cancellation of exp(x) - 1 near 0; relative error below 1e-7.
float nmt_expm1(float x) {
    return x * (1.0 + x * (0.5 + x * (0.16666667 + x * (0.041666668 + x * (0.008333334 + x * (0.0013888889 + x
        * (0.0001984127 + x * (2.4801588e-5 + x * (2.7557319e-6 + x * 2.755732e-7)))))))));
}

// Absorbance of a fragment, min(-ln(1 - alpha), 10), accurate for faint fragments too.
float nmt_absorbance(float alpha) {
    float faint = alpha * (1.0 + alpha * (0.5 + alpha * (0.33333334 + alpha * (0.25 + alpha * 0.2))));
    return (alpha < 0.03 ? faint : -log(max(1.0 - alpha, 4.539993e-5)));
}

// Pass 1: what a fragment at window depth w adds to b1..b4; to b0 it adds its absorbance.
float4 nmt_moments(float w, float absorbance) {
    float z = 2.0 * w - 1.0;
    float b1 = absorbance * z;
    float b2 = b1 * z;
    float b3 = b2 * z;
    float b4 = b3 * z;
    return float4(b1, b2, b3, b4);
}

// Pass 2: the features of a fragment at window depth w, from what pass 1 left in its pixel: least and greatest window
// depth, number of fragments, total absorbance b0 and moments b1..b4.
float2x4 nmt_features(float w, float w_min, float w_max, float n, float b0, float4 b1234) {
    float d = (w_max > w_min ? nmt_expm1(w - w_min) / max(nmt_expm1(w_max - w_min), 1e-30) : 0.0);
    return float2x4(float4(d, n, b0, b1234.x), float4(b1234.yzw, 0.0));
}

static const float4x4 NMT_W1[16] = {
    float4x4(float4(-0.56261206f, -0.081534505f, 0.86792815f, -3.4482932f), float4(0.031147113f, 0.27537444f, 0.30065098f, 0.15209784f), float4(0.060126178f, 0.29955044f, 0.30972698f, -0.2530429f), float4(0.0937746f, -0.041752703f, 0.37482864f, 0.3730254f)),
    float4x4(float4(-0.2008841f, -0.6857078f, 0.13445434f, -0.18970652f), float4(0.17733343f, 0.094713554f, -0.3170063f, 0.28719416f), float4(0.48911983f, -0.23789321f, -0.17487541f, -0.23815268f), float4(-0.09753168f, 0.016576627f, -0.08764214f, 0.028631438f)),
    float4x4(float4(0.48364165f, 0.22709142f, 1.9760454f, 0.23709649f), float4(0.28276798f, -0.30725434f, 0.20472161f, 0.15256429f), float4(0.24615212f, -0.12917116f, 0.10248366f, -0.28710803f), float4(0.1707121f, -0.36197695f, -0.1687728f, -0.13203627f)),
    float4x4(float4(-0.6067922f, 0.26647654f, -0.02500634f, 0.43397835f), float4(0.03986926f, 0.19262528f, -0.3524807f, -0.12221677f), float4(0.5352297f, -0.118321545f, -0.28360066f, 0.36582744f), float4(-0.017938795f, 0.0f, -0.0426102f, -0.08335628f)),
    float4x4(float4(-0.2363911f, -0.90211654f, 0.1350015f, -0.2968562f), float4(-0.3078159f, 0.24983858f, 0.18404892f, 0.049047947f), float4(-0.38623205f, -0.019589098f, -0.17973164f, -0.12997437f), float4(-0.050442055f, 0.08614008f, 0.029095931f, 0.5017569f)),
    float4x4(float4(-0.16036996f, -0.35064295f, 0.43490127f, -0.11450475f), float4(-0.19084297f, 0.10945594f, -0.57625324f, -0.36887074f), float4(0.15492678f, 0.5036909f, -0.3212962f, -0.108860336f), float4(0.0f, 0.15278998f, -0.14877437f, 0.5713367f)),
    float4x4(float4(2.0630271f, -0.0997571f, 4.2228503f, 0.007931798f), float4(0.38986924f, -0.2959917f, 0.04543091f, 0.13003084f), float4(0.070301324f, -0.36287212f, 0.43051285f, 0.13133188f), float4(-0.3442748f, -0.35115057f, 0.3726217f, -0.66278887f)),
    float4x4(float4(-0.10813944f, 0.26824868f, -0.28523403f, 0.19123992f), float4(0.25112462f, -0.07467726f, -0.31305647f, -0.32384253f), float4(0.49133512f, 0.3014543f, -0.11517484f, -0.3613984f), float4(0.10455305f, 0.0f, 0.111430615f, -0.094209075f)),
    float4x4(float4(-6.690659f, -0.11089706f, -9.332093f, 1.3173586f), float4(-0.028662542f, -0.09643745f, 0.09106966f, 0.14507128f), float4(0.30880523f, -0.3225432f, -0.18311906f, 0.08327701f), float4(-0.1131014f, 0.009394511f, -0.033861764f, 0.38145432f)),
    float4x4(float4(-0.34240577f, -0.040110134f, 0.1073907f, 0.11872532f), float4(-0.06347048f, 0.0309682f, 0.22518612f, 0.28756177f), float4(0.27633002f, 0.3479269f, -0.14870928f, -0.0010501626f), float4(-0.17794487f, 0.0f, 0.13268076f, -0.0026669356f)),
    float4x4(float4(0.06425869f, -2.7683237f, -3.5384176f, -8.883114f), float4(-0.26588643f, 0.16331653f, 0.15929018f, -0.03159351f), float4(0.26619807f, 0.05302929f, 0.22134489f, 0.19676779f), float4(-0.24423835f, 0.25309777f, -0.4777169f, 0.09200121f)),
    float4x4(float4(-0.1593399f, 0.43163684f, -0.30957335f, 0.043360602f), float4(0.086035684f, -0.18985449f, -0.30486077f, -0.080305755f), float4(0.2539124f, -0.36083746f, -0.028782794f, -0.14562844f), float4(0.0f, -0.25015193f, -0.099530414f, 0.13203456f)),
    float4x4(float4(-0.28932908f, -0.7158281f, 0.3894202f, -0.665815f), float4(-0.15771514f, 0.16232553f, -0.26005292f, 0.05746202f), float4(0.10007211f, -0.14397416f, -0.17480299f, 0.36618418f), float4(0.023264207f, -0.3201716f, 0.21525978f, -0.10264065f)),
    float4x4(float4(-0.0655724f, 0.4643477f, 0.005090512f, 0.10274544f), float4(0.14403597f, -0.043411758f, -0.09076426f, -0.6071357f), float4(-0.36943936f, 0.7716603f, 0.114491925f, -0.007496275f), float4(0.0f, 0.37904558f, 0.0f, 0.015907617f)),
    float4x4(float4(-0.25108993f, -0.030646749f, 1.1078541f, 1.1663129f), float4(-0.14131935f, -0.260406f, 0.003224754f, 0.3519263f), float4(-0.29822555f, -0.3538651f, -0.13726617f, 0.18897751f), float4(-0.36455408f, -0.23652422f, -0.0213017f, -0.11718057f)),
    float4x4(float4(0.07587434f, -0.24041364f, 0.8068686f, 0.29587045f), float4(0.15090741f, -0.13351996f, -0.5334153f, -0.13204023f), float4(-0.08125867f, -0.3258677f, -0.18280673f, 0.40286466f), float4(0.0f, 0.0f, 0.009271638f, 0.018559396f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(0.15863541f, 0.2525127f, -0.15120283f, -0.26976195f), float4(-0.05434058f, 0.2809714f, 0.3100116f, -0.21381792f), float4(0.03300902f, -0.38866538f, 0.10966782f, 0.3129235f), float4(-0.12895551f, 0.3518813f, 0.26532203f, 0.15405385f)),
    float4x4(float4(0.08303688f, -0.10777524f, -0.004562065f, 0.060743142f), float4(0.242445f, -0.3477067f, 0.13462684f, -0.163738f), float4(0.012667671f, 0.1318393f, -0.4448558f, 0.40774822f), float4(-0.363982f, 0.09614958f, -0.04117179f, 0.024848215f)),
    float4x4(float4(-0.25264475f, 0.30257717f, -0.18384172f, 0.045158457f), float4(-0.16868213f, 0.33109534f, 0.09541004f, 0.31074092f), float4(-0.030012753f, -0.03539373f, -0.07046072f, -0.20551562f), float4(-0.43467635f, 0.6390846f, 0.48763147f, -0.067994185f)),
    float4x4(float4(0.15664236f, -0.04784774f, 0.018023783f, 0.21864185f), float4(-0.023313971f, 0.19092087f, 0.054748215f, 0.25228634f), float4(0.42236382f, -0.0709761f, -0.22072017f, 0.4350028f), float4(-0.0008042033f, -0.0029783403f, 0.055109117f, 0.01440448f)),
    float4x4(float4(0.15190038f, 0.652126f, 0.26623172f, -0.4860729f), float4(-0.122314595f, -0.26764223f, -0.12185362f, 0.1896003f), float4(0.7215206f, 0.9778508f, 0.54641753f, -0.63180816f), float4(0.07304639f, 0.029519415f, -0.14615844f, 0.33884993f)),
    float4x4(float4(0.3266132f, 0.02527306f, 0.18978205f, -0.24936944f), float4(-0.067330204f, -0.24066235f, -0.046937913f, 0.10305957f), float4(0.21168369f, 0.15176779f, -0.15369532f, -0.1425104f), float4(-0.9346852f, 0.63619727f, 0.5547082f, -0.78424007f)),
    float4x4(float4(-0.17362157f, -0.2472279f, 0.044839457f, 0.24538255f), float4(-0.45942637f, 0.30706283f, -0.21326357f, 0.2669364f), float4(-0.04711403f, -0.16529115f, 0.08612868f, 0.06474462f), float4(-0.7189284f, -0.3346352f, 0.25568205f, -0.01770787f)),
    float4x4(float4(0.31449988f, 0.15014021f, 0.14384913f, 0.041162763f), float4(0.1378913f, 0.30203733f, 0.35173044f, -0.20212953f), float4(-0.8366457f, 0.97466934f, 1.3973445f, -0.95356244f), float4(0.1981082f, -0.030549787f, 0.032619085f, 0.40382525f)),
    float4x4(float4(0.007833827f, 0.043946348f, 0.20967697f, -0.2417932f), float4(0.27053744f, 0.123608455f, -0.21907309f, -0.19147225f), float4(0.22443843f, -0.014629798f, -0.3137604f, 0.19461201f), float4(0.28803098f, 0.2040196f, -0.26921818f, 0.20720433f)),
    float4x4(float4(-0.15424591f, -0.020594526f, -0.32039946f, -0.32255796f), float4(-0.19064753f, 0.26219678f, -0.30389923f, 0.2997231f), float4(0.03767277f, 0.04798742f, 0.33777347f, 0.24251892f), float4(0.15385462f, -0.23074666f, -0.23587483f, -0.16566832f)),
    float4x4(float4(-0.08849889f, -0.27658692f, -0.26811448f, 0.08877439f), float4(0.09032717f, 0.12704806f, 0.27129027f, -0.24753037f), float4(0.1540233f, -0.25168476f, 0.085253686f, 0.25216043f), float4(-0.00440461f, -1.0907258f, -0.18440093f, -0.14239879f)),
    float4x4(float4(0.13668662f, 0.19015051f, 0.16138773f, -0.1899346f), float4(0.061962534f, 0.0027379268f, -0.0763484f, -0.18883264f), float4(0.0806285f, -0.061850317f, -0.33406126f, 0.13096409f), float4(-0.19310614f, 0.03369136f, -0.2933674f, 0.038056605f)),
    float4x4(float4(0.6140851f, 0.004308689f, 0.20805937f, 0.3513004f), float4(-0.08817114f, -0.27002913f, -0.16879168f, 0.058134243f), float4(0.3822621f, 0.6349342f, 0.33781627f, -0.23469551f), float4(-0.08636937f, -0.017379597f, 0.15603326f, -0.08295044f)),
    float4x4(float4(-0.16527201f, -0.11037368f, -0.29834017f, 0.33868065f), float4(-0.07195685f, -0.17940363f, 0.061642367f, 0.2716619f), float4(-0.26297268f, 0.09074967f, -0.326761f, 0.21076655f), float4(0.44395074f, 0.54224485f, 0.094018586f, -0.04962075f)),
    float4x4(float4(-0.20743673f, 0.037099138f, -0.02882706f, -0.14811924f), float4(0.23832904f, -0.2433634f, -0.08906671f, 0.03349316f), float4(0.2752078f, 0.31540117f, -0.2501898f, 0.045189876f), float4(-0.20317389f, -0.23967542f, 0.016514948f, 0.11041255f)),
    float4x4(float4(0.026938718f, -0.23526844f, -0.31909692f, -0.29514864f), float4(0.009760433f, 0.17438713f, 0.09547135f, 0.22677593f), float4(0.6044183f, 0.76910025f, -0.1569786f, -0.3425574f), float4(-0.15574625f, 0.0065051313f, -0.13081738f, -0.1103127f)),
    float4x4(float4(-0.0057571f, 0.37159857f, 0.2999066f, 0.22917935f), float4(0.040222768f, -0.22368383f, -0.22406356f, 0.2449506f), float4(-0.11238228f, -0.13068227f, -0.263872f, -0.15478839f), float4(0.2344198f, 0.36361137f, 0.021458842f, 0.1463203f)),
    float4x4(float4(-0.24688785f, 0.02838289f, -0.14213243f, -0.19348972f), float4(-0.28346446f, -0.21802679f, 0.0157406f, -0.19143288f), float4(-0.3009512f, -0.46597207f, -0.22796811f, -0.27250108f), float4(-0.24360837f, 0.16977167f, -0.056330558f, -0.20878227f)),
    float4x4(float4(0.04442228f, 0.08103803f, 0.32526582f, -0.1267583f), float4(0.06685935f, 0.35682228f, 0.29954544f, -0.24046989f), float4(-0.11041954f, -0.06964907f, -0.07987933f, -0.15301043f), float4(-0.08378737f, 0.90474415f, -0.47399077f, -0.18440601f)),
    float4x4(float4(0.30161017f, -0.21510267f, 0.123862654f, -0.056081228f), float4(0.2668641f, -0.25568447f, -0.3530215f, 0.18033396f), float4(-0.23629597f, 0.21369207f, 0.020615518f, -0.12241909f), float4(0.16081825f, 0.013051194f, -0.0034500982f, -0.18183477f)),
    float4x4(float4(-0.23670131f, 0.5656172f, 0.72218657f, 0.34387004f), float4(0.029860621f, 0.07825398f, 0.14359516f, -0.25737625f), float4(0.1284287f, 0.92732173f, 0.8735086f, -0.16246012f), float4(-0.19368172f, -0.25408876f, 0.12726404f, -0.110971965f)),
    float4x4(float4(-0.18584065f, 0.17929497f, -0.10847511f, 0.34979796f), float4(0.10549468f, 0.20899051f, 0.1588708f, 0.14269136f), float4(0.08742764f, 0.26674455f, 0.32029495f, -0.08079863f), float4(-0.2908753f, 0.7470617f, 0.8165383f, -0.010687356f)),
    float4x4(float4(-0.08278364f, 0.09763273f, 0.13445327f, 0.33644497f), float4(-0.046188846f, -0.08238645f, 0.22843269f, 0.024818348f), float4(0.033848044f, -0.047503226f, -0.33217376f, -0.0046460805f), float4(-0.29576194f, 0.16824606f, -0.41061586f, 0.32781f)),
    float4x4(float4(0.17888758f, -0.17684764f, -0.07458393f, 0.16880196f), float4(-0.31342f, -0.2894574f, -0.21117513f, -0.093085304f), float4(0.22910486f, 0.8931653f, 2.8712082f, -0.10392129f), float4(0.06692622f, 0.30950788f, 0.13586104f, -0.16927606f)),
    float4x4(float4(0.19060175f, -0.3551726f, -0.20936812f, 0.16551574f), float4(0.033321444f, 0.07630563f, -0.13914655f, 0.20260729f), float4(0.04876663f, 0.26848227f, -0.01621514f, -0.15432689f), float4(-0.27987304f, -0.41987664f, 0.965466f, -0.118219234f)),
    float4x4(float4(0.36336154f, -0.22000551f, -0.09294532f, -0.205551f), float4(-0.110349104f, -0.09818374f, 0.30590615f, 0.33765462f), float4(0.20837715f, 0.30645517f, -0.5408049f, 0.07240235f), float4(-0.33748776f, 0.10091919f, -0.14343539f, 0.016264914f)),
    float4x4(float4(-0.30328918f, -0.07747318f, 0.026047872f, 0.2547307f), float4(0.06335004f, -0.11015976f, 0.17776856f, -0.1554158f), float4(-0.22925533f, 0.6026123f, -0.07125554f, -0.21864294f), float4(1.136014f, 0.7960045f, -0.13498874f, -0.1151894f)),
    float4x4(float4(0.26003727f, -0.42025024f, -0.20482574f, 0.045322396f), float4(-0.1674063f, 0.3474889f, 0.056501385f, -0.30929214f), float4(0.07188964f, 0.103785135f, -0.66589165f, -0.3466551f), float4(-0.17000465f, 0.5815388f, -0.011686608f, 0.21801238f)),
    float4x4(float4(-0.39589956f, 0.029709883f, 1.6024812f, -0.06855843f), float4(0.20172702f, -0.1378298f, 0.05266197f, 0.028083788f), float4(-2.2544658f, -0.74231166f, 2.207603f, -0.29084167f), float4(-0.080382995f, -0.08914118f, -0.13744196f, -0.13598405f)),
    float4x4(float4(-0.01976329f, 0.17375432f, 0.17898369f, 0.013462532f), float4(0.21109128f, 0.2684431f, 0.37662315f, 0.1629181f), float4(-0.22403312f, -0.10118787f, 0.41723555f, 0.06457919f), float4(-2.8177454f, -0.2133719f, 2.1350548f, -0.30101958f)),
    float4x4(float4(-0.098383315f, -0.07052091f, 0.0071323975f, 0.019190967f), float4(0.28042206f, -0.39771014f, 0.16419372f, -0.3361841f), float4(0.27304712f, -0.25571826f, 0.31424743f, -0.041925732f), float4(0.25147727f, 0.19988696f, 0.23505671f, -0.17996508f)),
    float4x4(float4(0.15666483f, -0.099297434f, -0.32955775f, -0.2410699f), float4(0.13662578f, 0.30806872f, 0.044379342f, 0.03773576f), float4(0.4227286f, 0.03201261f, -1.8718351f, 0.09498275f), float4(-0.34827244f, -0.20537117f, -0.25726908f, 0.07362006f))
};
static const float4 NMT_B2[4] = {
    float4(-0.95196974f, 0.1504073f, 0.13671528f, 0.06643443f),
    float4(-0.07894247f, 0.14076409f, 0.0f, -0.0013505457f),
    float4(-0.023380226f, 0.15595594f, 0.07308679f, 0.0f),
    float4(-0.046577185f, -0.061987642f, 0.031008944f, 0.0f)
};
static const float4 NMT_W3[4] = {
    float4(-1.1159146f, 0.5144221f, 0.76581216f, -0.6606414f),
    float4(0.100599684f, 0.88675445f, -0.13142118f, 0.009695193f),
    float4(0.555042f, 1.2137244f, 0.28732947f, 0.14776249f),
    float4(1.1563534f, 1.7936894f, 14.631654f, -0.2089166f)
};
static const float NMT_B3 = -0.06779878f;

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float2x4 f) {
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

// What pass 1 writes of a fragment, and what pass 2 reads of its pixel, a vector a render target.
struct NmtSums {
    // (b0, b1, b2, b3): blended by addition, cleared to 0.
    float4 sums0;
    // (b4, number of fragments, 0, 0): blended by addition, cleared to 0.
    float4 sums1;
    // (-w, w, 0, 0): blended by max, cleared to -3e38, so that it holds -w_min and w_max. Two channels, f32 always.
    float4 range;
};

// Pass 1 in one call. w is window depth in [0, 1], the same bits in both passes.
NmtSums nmt_pass1(float w, float alpha) {
    float absorbance = nmt_absorbance(alpha);
    float4 b = nmt_moments(w, absorbance);
    NmtSums result;
    result.sums0 = float4(absorbance, b.xyz);
    result.sums1 = float4(b.w, 1.0, 0.0, 0.0);
    result.range = float4(-w, w, 0.0, 0.0);
    return result;
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up (alpha * T *
// color, alpha * T).
float nmt_pass2(float w, float4 sums0, float4 sums1, float4 range) {
    return nmt_transmittance(nmt_features(w, -range.x, range.y, sums1.y, sums0.x, float4(sums0.yzw, sums1.x)));
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
