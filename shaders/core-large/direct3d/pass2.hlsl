// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as pairs.
//
// Neural moment transparency: network 'core-large', 9-48-24-1, 1608 multiply-adds.
// Provenance: nmt 0.1.0, commit b1d5f0d9a708, backend fused, seed 1, epochs 1500, dataset 2047c3a13a19dc612f5c4d0b31421acc3ed79459e8fe18b2fc743a11529b0aab.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

static const float4x4 NMT_W1[36] = {
    float4x4(float4(1.6569186f, 1.9784789f, -3.9046614f, -0.86073005f), float4(-0.69997776f, 0.024970355f, -0.92589283f, -0.10254667f), float4(0.4449079f, -0.010074226f, 0.107501455f, 0.1591526f), float4(9.602373f, -11.684444f, -30.372665f, -2.2374427f)),
    float4x4(float4(-4.2037187f, -9.175443f, -2.1804504f, -6.5127287f), float4(3.6737785f, -6.2169213f, 2.884005f, 0.40872213f), float4(-10.452331f, 0.10425401f, -8.658486f, -1.8254566f), float4(-0.14297311f, 3.4628265f, -0.54047215f, 1.647454f)),
    float4x4(float4(-1.0199388f, 9.5046015f, -78.18403f, 1.6368083f), float4(3.9464653f, 0.10243295f, 2.724459f, 1.7487004f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-5.064117f, 2.5543404f, -1.6703581f, 3.28437f), float4(0.3443357f, -0.10304725f, -0.33262652f, 0.3398012f), float4(-0.33817986f, 0.19543768f, -0.20537286f, -0.19144258f), float4(8.267223f, -12.365218f, -4.6949263f, -0.021674616f)),
    float4x4(float4(-1.7339858f, -11.300071f, -29.609106f, -0.121927336f), float4(2.820381f, -0.99627143f, 6.6644397f, 7.19339f), float4(-12.909039f, 3.7802687f, -21.351707f, -6.924257f), float4(0.6646754f, -0.64316106f, -0.0048229573f, -11.950956f)),
    float4x4(float4(-0.34820423f, 7.2617083f, 6.491454f, -2.4808238f), float4(1.374529f, -1.6095982f, 0.03941709f, 0.73284775f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.9949888f, 1.2993475f, -1.6998483f, 0.89773756f), float4(-0.17845331f, 0.18111914f, -2.3895698f, 0.15594023f), float4(0.19783849f, -0.21217373f, 0.724185f, 0.18601067f), float4(-13.947405f, 6.269285f, -32.035534f, -6.376138f)),
    float4x4(float4(2.8019316f, 8.061528f, -5.099121f, 0.6609397f), float4(-4.6699214f, 4.8739643f, 1.3875595f, 2.560654f), float4(-4.8872285f, 2.6187077f, -0.26434037f, 7.3422813f), float4(11.010537f, -3.297542f, -1.1304207f, -3.806458f)),
    float4x4(float4(6.547127f, 0.12552556f, -1.5175967f, -9.078557f), float4(-4.494853f, -2.668719f, 1.5751567f, 1.1882389f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.9822363f, 2.0475686f, -3.6227145f, 6.930378f), float4(0.025251335f, 0.12870438f, 1.4125818f, 0.34865347f), float4(0.13980797f, 0.2649601f, 0.23334494f, -0.3637377f), float4(9.5922365f, -103.88764f, -6.3083634f, 11.096366f)),
    float4x4(float4(-1.2707471f, 3.4628363f, 2.5236795f, -11.459972f), float4(0.20001408f, -0.39531308f, 0.059983127f, -6.3301983f), float4(10.739833f, 6.247608f, 1.948729f, -5.4154973f), float4(2.1170623f, -2.5905209f, 0.2544647f, -2.5761967f)),
    float4x4(float4(-0.6241254f, 7.356106f, -0.6997586f, 4.2820024f), float4(-8.214615f, -7.446254f, -7.262718f, 3.233489f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.00262f, -0.12009646f, -1.437064f, 2.4139824f), float4(-2.608791f, -0.07527134f, -0.27571535f, -3.8600056f), float4(1.0736527f, -0.02680241f, -0.12742607f, 1.8483324f), float4(3.7151082f, -5.8210044f, 2.8995175f, -108.74594f)),
    float4x4(float4(9.294467f, 4.059915f, 7.1807323f, -0.4118994f), float4(4.8142977f, -0.45109195f, -0.50591826f, -0.98659414f), float4(1.9381655f, -7.825728f, -8.247244f, 1.9274615f), float4(-0.5420433f, 4.3998976f, 0.6059458f, 0.39646417f)),
    float4x4(float4(-2.1974423f, 8.901942f, -1.4954599f, -0.10803265f), float4(-3.649035f, -3.5227618f, -0.28761655f, 2.7227192f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(1.4062674f, -2.4382813f, 0.38942114f, -6.101927f), float4(0.10174717f, -0.19454856f, -0.46024045f, 0.028100548f), float4(-0.08495078f, -0.012500364f, 0.07480658f, -0.010778958f), float4(16.71501f, 21.196722f, 15.619736f, -0.68034726f)),
    float4x4(float4(6.6281333f, -14.596229f, 3.6825845f, 0.1326296f), float4(-4.0444665f, 4.957581f, 5.639484f, -0.0020225905f), float4(0.29973364f, -10.180329f, 0.45788154f, -0.060165226f), float4(7.635896f, -6.409822f, -2.5422072f, 0.07934295f)),
    float4x4(float4(1.5533394f, 5.7585835f, -3.3580515f, -0.009847847f), float4(0.6666674f, -1.0311936f, -2.6030576f, -5.80842f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(1.7126791f, 7.426946f, 3.4680336f, 8.197632f), float4(-0.10013162f, 0.0065790373f, 0.23588808f, 0.66316265f), float4(-0.06521823f, -0.0031704376f, -0.27344972f, -0.32280228f), float4(-50.161194f, 2.167233f, 7.6012726f, -5.5923233f)),
    float4x4(float4(-20.7752f, -2.3903303f, 4.491617f, -3.5196195f), float4(-3.8731937f, -1.468888f, 1.271961f, -1.6822087f), float4(-0.25931534f, -0.11789168f, 5.276979f, 7.2738295f), float4(1.734476f, -0.629805f, 3.5438442f, -0.5692057f)),
    float4x4(float4(7.36187f, 0.9443042f, -1.5396038f, -14.892166f), float4(1.3617095f, 6.7488623f, -1.3858372f, 3.9954712f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-5.7761345f, -3.4264f, 0.49951464f, -1.9464877f), float4(-0.075947285f, 0.42365852f, -0.008246239f, -0.30791068f), float4(0.029046522f, -0.18861279f, -0.11025636f, -0.0007468285f), float4(1.0969179f, -20.149498f, -6.704131f, -120.90267f)),
    float4x4(float4(-4.092884f, -36.409023f, -4.5577774f, 6.739799f), float4(-1.4273698f, 5.738206f, -11.535766f, 6.5944247f), float4(0.3879312f, -35.806248f, -7.227582f, -3.6379888f), float4(0.28340065f, -0.460482f, 11.429924f, -0.8810894f)),
    float4x4(float4(2.034709f, -0.49040747f, -0.47987494f, 2.145145f), float4(-5.197952f, 2.3693619f, 2.3392289f, -2.2028139f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.262797f, 10.638024f, 1.9891852f, -1.9016554f), float4(-0.032379903f, -0.1905228f, 0.15410207f, -0.024370044f), float4(0.405682f, -0.0885772f, 0.16485238f, 0.17262495f), float4(-11.846884f, -2.5739658f, -1.8377261f, 21.312338f)),
    float4x4(float4(6.7813396f, -3.5815554f, -11.249057f, -0.5681354f), float4(5.9633894f, -9.117469f, -10.387761f, -7.047922f), float4(-20.567057f, 8.514751f, -3.0188699f, -5.049941f), float4(-5.160983f, 8.168563f, 12.520075f, 11.366489f)),
    float4x4(float4(3.968528f, 2.0440824f, 1.1239656f, -0.20943381f), float4(-1.8560716f, -4.5963264f, -0.8854409f, -1.2316022f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(3.652999f, -4.687118f, 2.6848278f, 2.817553f), float4(-1.1537365f, 0.014265241f, 8.799897f, 0.14777341f), float4(0.4811597f, 0.3423145f, -3.3817692f, -0.14645796f), float4(-2.081622f, 0.89337105f, -33.273273f, 1.920155f)),
    float4x4(float4(-1.7453666f, -2.8494093f, -0.36790287f, -12.888424f), float4(3.507498f, -0.79684967f, -0.938906f, -8.3312025f), float4(1.111984f, 1.3348967f, 2.1205478f, 8.889721f), float4(-7.914459f, 0.08130771f, 0.30573136f, -7.8835297f)),
    float4x4(float4(4.9161263f, -1.377986f, 0.03083386f, -14.890051f), float4(1.2750839f, -3.4782326f, -4.8468647f, -5.7954073f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.3584056f, 2.7283804f, 1.8771602f, 1.2047005f), float4(0.04200027f, -0.022071619f, -0.64535666f, -0.25738093f), float4(0.3019368f, -0.025663627f, 1.6044747f, 0.25470966f), float4(-68.50137f, 5.040431f, 0.7723566f, -4.760809f)),
    float4x4(float4(-49.583374f, -25.331343f, 1.5552516f, -9.0283165f), float4(2.866611f, -6.6898704f, -2.4074578f, 4.3560185f), float4(3.0473351f, -3.4238255f, 0.71908283f, 5.347882f), float4(-0.81879f, 4.925067f, -0.14941838f, -2.2609727f)),
    float4x4(float4(-2.0047204f, 9.604637f, 0.6458075f, -3.1678853f), float4(-0.8351335f, 0.5859434f, -3.5580418f, 0.61247945f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(4.6724696f, -6.5759706f, -2.3123794f, -2.3829725f), float4(-0.08286486f, 0.03577686f, 0.22643974f, -0.35159102f), float4(-0.04949818f, 0.15398875f, -0.29905543f, 0.0882129f), float4(1.8669552f, 5.251122f, -7.8454943f, 8.007516f)),
    float4x4(float4(-0.029054396f, -6.1427855f, -16.495996f, 6.187975f), float4(1.68314f, -1.2139863f, 2.5787458f, 2.2459638f), float4(-6.6394405f, 0.31670776f, -3.3181443f, 0.33860472f), float4(-5.228101f, 0.13320942f, -2.3957593f, 1.1581222f)),
    float4x4(float4(10.432761f, -1.1643064f, 2.442221f, -10.541324f), float4(-1.1272047f, -5.5824404f, 1.6166933f, 1.5944566f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[72] = {
    float4x4(float4(-0.9569566f, -0.22843781f, -2.2819052f, -4.042158f), float4(-0.33185834f, -0.9414105f, 5.576354f, -1.9857287f), float4(-1.1463109f, -0.18199955f, 3.1074798f, 2.0881627f), float4(-0.9005811f, -0.46873686f, -1.7642467f, -1.5410476f)),
    float4x4(float4(-1.9690284f, -0.27482f, 1.1638111f, 1.3090847f), float4(-3.9813774f, -0.51319313f, 0.6562163f, 0.3812907f), float4(1.9273741f, 0.21926227f, -2.803426f, 1.3943843f), float4(-9.080785f, -0.20007375f, -1.057458f, 2.123056f)),
    float4x4(float4(2.0482097f, -0.053848065f, -0.4326291f, 0.38410762f), float4(-0.23349099f, -0.253536f, -2.2579715f, -2.4886694f), float4(1.8020802f, -0.0024160405f, 0.072058454f, 0.3910633f), float4(-0.43610904f, -0.5678907f, 1.9502858f, 0.34651724f)),
    float4x4(float4(-2.8647356f, 0.1325326f, 2.9193356f, 0.33822092f), float4(-0.74042547f, -0.3374716f, -1.8621498f, 0.2610145f), float4(0.19339763f, -0.23525436f, -0.41678f, 1.1538824f), float4(1.132927f, 0.031316504f, 0.6325006f, 0.5962696f)),
    float4x4(float4(-0.44924974f, -0.2707078f, -1.2463589f, 2.5559301f), float4(-2.8378038f, -0.074034005f, -1.8163648f, 0.08186177f), float4(1.1526119f, -0.22342417f, 2.2739465f, -0.48250657f), float4(0.1783018f, -0.22773218f, 0.53640634f, -1.3791038f)),
    float4x4(float4(0.011267154f, -0.5499357f, 2.5953827f, 0.41669363f), float4(2.4573414f, 0.14659011f, -0.07384114f, -1.1286875f), float4(-6.9502325f, 0.23689634f, -6.201442f, -8.066945f), float4(13.349348f, -0.037429594f, -29.145433f, 31.836348f)),
    float4x4(float4(0.4482821f, 0.14725983f, 2.1329145f, 1.1072633f), float4(3.0650191f, -0.27477086f, 4.8587995f, 0.6192007f), float4(-3.7840147f, -0.17710839f, -4.001636f, -1.9018942f), float4(5.9573426f, -0.06637839f, 0.16358738f, -4.97373f)),
    float4x4(float4(-1.8873291f, -0.108761f, -7.043731f, 5.5049496f), float4(1.1880943f, -0.32614842f, 1.8165052f, -10.369813f), float4(0.71638024f, -0.031307787f, 1.9744909f, -0.07672727f), float4(-2.2598724f, 0.06349356f, -1.3136233f, 0.49948102f)),
    float4x4(float4(1.152624f, -0.21227111f, -1.0336936f, -1.5899588f), float4(-2.5979214f, 0.2571986f, -9.371455f, -9.979456f), float4(-5.456543f, 0.13150154f, -1.7291552f, -0.36485195f), float4(-0.6619063f, -0.3036185f, -2.2502787f, 0.039549984f)),
    float4x4(float4(0.48148215f, -0.43945044f, -0.8139389f, 0.056445293f), float4(-0.61247724f, -0.38995343f, -0.2807826f, 0.25680807f), float4(-0.35475338f, -0.14741324f, -0.5278507f, 0.39026082f), float4(-3.0473442f, 0.02465593f, -3.527682f, 0.030588279f)),
    float4x4(float4(2.5582905f, -0.3216937f, 2.7463365f, -0.22132565f), float4(-9.122823f, -0.11085702f, -12.38309f, -0.0066194246f), float4(-0.4346055f, -0.18496396f, -0.38381833f, -0.17261794f), float4(0.059110943f, -0.19413501f, 1.8202422f, -1.4571687f)),
    float4x4(float4(-36.14343f, -0.66490436f, -6.8976946f, -0.3159942f), float4(0.39859572f, -0.25311658f, 4.2377005f, 0.44192752f), float4(4.12291f, -0.41164392f, 0.4874852f, -0.46105164f), float4(-5.614309f, -0.5994117f, -5.1287174f, -0.77614534f)),
    float4x4(float4(-0.13086092f, 1.0263319f, 0.061833534f, -3.6897655f), float4(-0.1421971f, 1.9918251f, -0.17287841f, 0.45052695f), float4(0.17098317f, -2.6820064f, 0.07703166f, 0.039000798f), float4(-0.008134585f, -4.474772f, -0.15597513f, -1.2354876f)),
    float4x4(float4(0.031923424f, -2.5207298f, -0.23324417f, 0.41955918f), float4(-0.26940608f, -1.3742075f, -0.18439668f, -1.4230736f), float4(0.03705519f, -0.7115663f, -0.1413311f, -2.0318174f), float4(-0.16905375f, -0.22644258f, -12.596058f, 0.99125916f)),
    float4x4(float4(0.12241534f, 1.1651678f, 0.21255867f, 0.034023818f), float4(-0.21058139f, 0.5611968f, -0.08081555f, -3.3200665f), float4(-0.21831198f, 0.97855407f, 0.10648942f, 0.9686504f), float4(-0.24946205f, 0.29624543f, -0.270177f, 2.928592f)),
    float4x4(float4(-0.28967777f, -2.9826028f, 0.47098505f, 2.6552277f), float4(-0.12712407f, 0.47122833f, 0.0038147967f, -2.5020866f), float4(-0.114115976f, -1.9822485f, -0.08888503f, -1.7210943f), float4(-0.25847661f, 3.3038926f, 0.04987155f, -1.1346978f)),
    float4x4(float4(-0.3225532f, -1.2124803f, -0.07727846f, -0.658731f), float4(0.20457652f, 1.6706494f, 0.17838196f, 1.9200408f), float4(-0.12383211f, 3.6348212f, -0.1234997f, -8.655861f), float4(-0.071146116f, -0.086131796f, 0.12447553f, 0.71910375f)),
    float4x4(float4(-0.3504773f, -4.0025215f, -0.42838302f, -0.43353134f), float4(-0.36710382f, -0.37562567f, 0.33897725f, 1.5098579f), float4(-0.23798203f, 0.5772431f, -0.668416f, -2.0286791f), float4(0.19524615f, -2.9659243f, 31.601206f, 3.184488f)),
    float4x4(float4(-0.110194266f, -1.3157861f, 0.00051781617f, -0.45270273f), float4(-0.30937085f, 0.81166685f, -0.5228631f, -10.546541f), float4(-0.12748191f, 0.014623243f, -0.49842542f, -18.858295f), float4(0.10207291f, 2.1458786f, 2.1200268f, -4.1301665f)),
    float4x4(float4(0.21550655f, -1.5349042f, 0.95704883f, 9.059908f), float4(-0.1074009f, -32.605774f, -0.31646705f, 1.9548749f), float4(-0.103200056f, 3.8257544f, 0.0044550034f, 0.24911512f), float4(-0.16212112f, -2.4794106f, -0.21842988f, -2.5077503f)),
    float4x4(float4(-0.1793208f, -2.5331929f, -0.13248213f, -0.30201402f), float4(0.02791578f, 1.3070178f, -1.2424612f, 4.2279587f), float4(0.16374956f, -4.786407f, -0.21194237f, 0.23856619f), float4(0.044771012f, 2.6633701f, -0.041679356f, -0.6505966f)),
    float4x4(float4(-0.15927932f, 0.46496496f, 0.14514965f, -0.1430388f), float4(-0.28578043f, 0.68983334f, -0.1539827f, -1.4730971f), float4(-0.28632763f, -0.55951685f, -0.95950365f, 0.53819287f), float4(0.10036462f, -0.027634762f, -2.5330968f, -2.7025852f)),
    float4x4(float4(0.020511225f, -0.86671305f, -0.107288204f, -1.0041689f), float4(0.0445271f, -0.4966166f, -0.025380308f, -1.1858366f), float4(-0.0036166008f, 0.8899344f, -0.014349319f, -1.3555927f), float4(-0.007358011f, -10.59216f, 0.17869084f, -0.5721506f)),
    float4x4(float4(-0.32719553f, -0.053764306f, -0.1997095f, 0.9782263f), float4(-0.08268314f, 5.4312253f, 0.33151835f, 1.6430693f), float4(-0.03853205f, -0.19265355f, 0.11864803f, 1.8807625f), float4(-0.39150172f, -0.12969753f, 0.2205681f, -6.5616713f)),
    float4x4(float4(-0.30701628f, 0.32730862f, -0.27334985f, 0.37110126f), float4(1.7152207f, -0.36384094f, -0.9256443f, -2.3109426f), float4(-20.05715f, 0.12932497f, -1.5204673f, 1.0355649f), float4(0.3039975f, 1.6240504f, 0.46179605f, 0.8057629f)),
    float4x4(float4(0.1569145f, -1.5477991f, 1.6036911f, 0.36478862f), float4(1.616127f, -2.7149546f, 2.7188497f, 2.3311543f), float4(1.4305559f, 0.19831207f, -1.7302413f, -1.8806844f), float4(-0.8399841f, -1.7454112f, -0.11619088f, -1.6538787f)),
    float4x4(float4(0.6358722f, 0.67684567f, -0.50055736f, 3.7826817f), float4(0.85866493f, 3.16178f, 0.17984022f, 1.4168613f), float4(-1.2207664f, -0.6123231f, -0.27836004f, 0.4175051f), float4(-1.5725427f, 0.15585904f, -4.2651668f, 0.59560966f)),
    float4x4(float4(0.47191352f, -0.9456611f, -0.8237092f, 2.6149712f), float4(0.33602053f, -0.82299423f, -3.8622947f, -0.9966406f), float4(2.031505f, 0.20222093f, -0.48260522f, 1.3302267f), float4(1.5262527f, -0.5079884f, 0.22423738f, 0.54586744f)),
    float4x4(float4(-0.36407745f, -0.081006296f, 1.569035f, 0.02706679f), float4(-0.067485385f, -0.8453803f, -0.6640848f, 0.5463232f), float4(-1.3358576f, 1.9386705f, -2.460675f, -1.1261694f), float4(0.19310172f, 0.1746046f, -0.52712214f, 0.12923792f)),
    float4x4(float4(0.92672586f, 0.12639992f, 0.45579427f, 0.59941536f), float4(-1.236972f, -1.7993311f, -1.6179093f, 1.1962707f), float4(1.5077652f, -0.7731332f, -1.0261835f, -2.7957811f), float4(-19.032642f, -3.1659362f, 10.956811f, -10.331229f)),
    float4x4(float4(-0.020613616f, 2.432644f, -11.389433f, -0.88246715f), float4(1.4102534f, -1.1205964f, -1.3772436f, -0.6856861f), float4(-2.1523266f, -0.3508866f, -0.23155439f, 0.07493057f), float4(0.33766717f, -0.021357514f, -1.5770172f, 0.09461409f)),
    float4x4(float4(-0.4796047f, -1.1991001f, -5.352662f, -8.093623f), float4(-5.7636847f, -1.2011292f, 0.081894204f, 0.23482625f), float4(-0.33086747f, 1.2186874f, -0.62985975f, -0.0057716416f), float4(-0.115448296f, -0.24218944f, -0.5885031f, -0.5848062f)),
    float4x4(float4(0.6262672f, -1.1444383f, 0.7721388f, 0.14177772f), float4(-1.1724308f, 0.86549824f, 1.3505628f, -5.657218f), float4(-3.1483803f, -4.819699f, -28.529392f, -10.699809f), float4(0.9757761f, -0.7959013f, -0.8516148f, -0.49389157f)),
    float4x4(float4(0.9271721f, -0.36329085f, -3.8892806f, 0.081835814f), float4(0.4632176f, -0.5549612f, 1.2067363f, -1.4858345f), float4(0.20427841f, -0.14342472f, 0.5734425f, -0.035116922f), float4(1.2127295f, -11.456881f, -3.3794513f, -0.68978524f)),
    float4x4(float4(-0.70643264f, 0.41123134f, -0.22657058f, -0.49078697f), float4(-2.3874712f, 2.1472344f, -4.674345f, -7.4228477f), float4(0.2426658f, -0.020443931f, 0.2117888f, 0.19075f), float4(0.45389086f, 0.5217028f, 1.4753774f, -0.011421898f)),
    float4x4(float4(-1.1920629f, -0.3420433f, 4.4901385f, -3.1945155f), float4(-9.7870655f, 1.961409f, 5.936735f, -4.2211766f), float4(-0.11938422f, -0.35575467f, -1.7929579f, -0.43253964f), float4(0.34567595f, 0.17568114f, 2.7181635f, -0.30837658f)),
    float4x4(float4(-0.38812953f, 0.43362677f, -0.9819411f, -0.083730854f), float4(4.222915f, 1.055618f, -1.6379435f, -2.246892f), float4(-4.8152046f, 0.66534156f, 0.08948657f, -0.40959737f), float4(1.2952658f, 0.21481286f, -0.6116007f, 0.3544373f)),
    float4x4(float4(-0.07285697f, -0.89534605f, -0.29589096f, -0.35569736f), float4(-1.3581761f, 1.5325346f, -1.0582741f, 1.0566908f), float4(2.3519604f, -6.1467924f, 0.078232825f, 1.2687451f), float4(-23.54985f, -4.819632f, -0.3542292f, 0.028435562f)),
    float4x4(float4(-0.8798439f, -5.903096f, -0.1688702f, 2.0830336f), float4(-4.2820687f, -4.8952417f, -0.4974247f, 0.48821133f), float4(0.5338504f, -3.4304647f, -0.10573631f, 0.38485652f), float4(4.150841f, 1.4656174f, -0.74817044f, -2.3115296f)),
    float4x4(float4(-0.38329646f, -21.127863f, 0.13313104f, -2.6875196f), float4(-3.2343502f, -6.3806577f, -0.67778426f, 1.4114603f), float4(-0.7444415f, 1.6561986f, -0.033051655f, -1.6708161f), float4(0.5734138f, 1.1863848f, 0.02062421f, 0.81863374f)),
    float4x4(float4(0.97577405f, -1.3950008f, -0.08418025f, 0.37700582f), float4(-3.2439f, 0.5186156f, -0.2663454f, -1.4123075f), float4(-2.9745388f, 0.44322747f, 0.14385882f, -0.32827076f), float4(0.21656226f, -15.467679f, -0.2667019f, -0.37345278f)),
    float4x4(float4(1.3634562f, 0.23325692f, -0.46525854f, -1.4437617f), float4(0.09660767f, 0.8896799f, -0.27267525f, -18.009092f), float4(-11.546507f, 9.07561f, -0.4171812f, -4.406831f), float4(2.0374084f, 2.208824f, 0.11395239f, 19.04931f)),
    float4x4(float4(1.9288234f, 0.5597505f, -0.2250409f, -2.677301f), float4(2.5456374f, 0.6400108f, -0.55775857f, 0.905168f), float4(-1.963576f, -1.2845932f, -0.13469493f, 1.809353f), float4(3.4871137f, -2.0485847f, 0.09456025f, 0.4482678f)),
    float4x4(float4(-0.94462585f, 0.7290861f, -0.33969945f, 2.341217f), float4(-0.24015032f, -10.725074f, 0.004651074f, 0.34743652f), float4(4.139523f, 0.29823533f, 0.07751136f, -1.3532424f), float4(-1.366395f, -0.1797687f, -0.26854643f, -0.020598939f)),
    float4x4(float4(-1.11462f, -0.90351385f, -0.20458588f, -0.6450715f), float4(-20.254658f, 2.8724732f, -0.2767705f, -0.7765799f), float4(-5.863401f, -3.3609014f, -0.2410369f, 1.7511346f), float4(1.559679f, -3.1621275f, 0.17986065f, -2.1244833f)),
    float4x4(float4(-1.1955473f, -4.269089f, -0.50236285f, -0.83967656f), float4(-1.076114f, 0.87331927f, -0.2144916f, 0.9138092f), float4(-0.17371085f, -9.360653f, 0.16597316f, -0.0073819216f), float4(-4.6556706f, 4.079599f, 0.10359981f, -12.381626f)),
    float4x4(float4(2.5033731f, 0.13587114f, 0.088133655f, -1.6082492f), float4(-9.898666f, -2.180297f, -9.894819e-5f, 3.1811867f), float4(0.41352177f, 0.42631477f, 0.31255975f, -1.2157866f), float4(-1.1485459f, 0.3650958f, -0.34670037f, -0.23041426f)),
    float4x4(float4(-23.975426f, 0.27521536f, 0.04197887f, -5.584126f), float4(0.8495603f, -2.188212f, -0.194597f, 4.2847285f), float4(0.6803876f, -0.26295197f, -0.7436401f, -1.8148643f), float4(-10.215551f, -1.1578887f, -0.5519095f, 1.3787404f)),
    float4x4(float4(-0.5519618f, 1.4224226f, -0.5124778f, -0.31312624f), float4(-0.08445092f, -1.8614354f, -2.7614164f, -0.27247626f), float4(-0.04406977f, 1.762673f, -2.8017569f, -0.013544529f), float4(-0.26015714f, -1.0617754f, 2.1961384f, -0.44184488f)),
    float4x4(float4(0.08358597f, 1.7220447f, 0.8746328f, -0.15258257f), float4(-0.4009067f, -3.311566f, -0.7798284f, -0.17871083f), float4(-0.15093388f, -1.3492024f, 1.5252781f, -0.32841825f), float4(-0.4593032f, -22.697124f, 4.5754294f, -0.2409341f)),
    float4x4(float4(-0.047686048f, -1.9290934f, -1.0293951f, 0.12198191f), float4(-0.5730161f, -2.1019232f, -1.1327348f, -0.29797044f), float4(0.2505253f, 0.5023373f, 0.16137055f, -0.16163348f), float4(-0.36650383f, -2.0271785f, -5.231967f, -0.63407296f)),
    float4x4(float4(-0.7062006f, 2.376036f, -0.19370747f, 0.0005923773f), float4(-0.17183127f, -1.9627517f, 0.29085568f, 0.07406794f), float4(0.15574604f, 0.1529621f, 0.02650379f, -0.521952f), float4(-0.2842634f, 1.5484124f, 2.6384037f, -0.12638545f)),
    float4x4(float4(-0.30447817f, -0.47416732f, -1.0642596f, -0.11469152f), float4(-0.11389424f, 0.38724884f, 1.9143751f, 0.04269565f), float4(0.011288558f, -0.4042148f, -0.763359f, 0.041509647f), float4(-0.27760655f, 0.21339913f, 0.6540615f, -0.40897304f)),
    float4x4(float4(-0.5040556f, -0.019215917f, 1.4931005f, -0.0056399344f), float4(0.108572096f, 2.0387993f, -3.2000594f, -0.8938364f), float4(-0.364395f, -2.056595f, -0.90037584f, -0.16057278f), float4(-0.0811858f, 10.559487f, -10.160708f, -0.21827936f)),
    float4x4(float4(-0.08590324f, -2.8009543f, -0.6044441f, -0.29924962f), float4(-0.15306616f, -1.465644f, -0.96278596f, -0.1279396f), float4(0.15344417f, 0.4386753f, -2.0843856f, -0.35565132f), float4(-0.32933024f, 0.34142053f, 2.2142768f, -0.21073155f)),
    float4x4(float4(-0.12064856f, -0.20682281f, -1.8651744f, -0.025458291f), float4(-0.085930444f, 1.6655604f, -1.8139619f, -0.10276159f), float4(-0.03689975f, 1.2119658f, 0.09396969f, -0.21274646f), float4(-0.3165338f, 0.010983957f, -1.5046498f, 0.0037335667f)),
    float4x4(float4(-0.18292093f, 0.14139116f, 2.5821924f, -0.11993731f), float4(-0.4495779f, 1.3031169f, 3.3098845f, 0.017967004f), float4(-0.35145548f, 3.6215394f, -0.33965477f, -0.11646337f), float4(-0.18453096f, -4.456591f, -0.6539156f, -0.23635045f)),
    float4x4(float4(-0.21403813f, -0.12393788f, 0.5349673f, -0.25308406f), float4(-0.29266635f, 1.0284963f, 0.93693095f, -0.48223984f), float4(-0.36799502f, -0.5065443f, -0.068884805f, -0.19195281f), float4(0.14141004f, -1.0945817f, 2.444571f, -0.39856812f)),
    float4x4(float4(0.1553648f, -0.56905985f, 0.20002007f, -0.1313066f), float4(-0.25897986f, 3.3532994f, 2.3862686f, 0.20748703f), float4(0.12259125f, 0.30624333f, -0.37219924f, -0.13935086f), float4(0.19636112f, -0.34128788f, -0.210584f, 0.031290732f)),
    float4x4(float4(-0.46345264f, -23.726675f, -2.045706f, -0.24759296f), float4(0.17457826f, -0.7069478f, 0.31910083f, -0.42051992f), float4(-0.17391959f, -0.8135754f, -1.3644663f, -0.4121768f), float4(-0.5015342f, -3.1654007f, 1.1955124f, -0.23817518f)),
    float4x4(float4(2.5355523f, -0.403013f, -0.5583335f, 0.8670558f), float4(-1.8607659f, 2.2997339f, -0.15407874f, 0.16959341f), float4(-0.5474474f, 0.39618644f, -0.30496177f, 0.61375374f), float4(0.2872975f, 0.16461568f, 0.1920498f, 1.9592718f)),
    float4x4(float4(0.52815056f, -1.0455313f, -0.33338097f, 1.5156468f), float4(-2.0369718f, -1.152387f, 0.066692084f, 0.6674874f), float4(-0.28304833f, -0.29211822f, 0.02027329f, 0.86263615f), float4(-18.06209f, -4.668531f, 0.08275874f, -0.577246f)),
    float4x4(float4(-1.9111518f, 0.8267011f, -0.12365954f, 0.5212752f), float4(0.4628472f, 0.2935907f, -0.24685113f, 0.7965793f), float4(-0.41037112f, 1.1531507f, 0.055024754f, -0.86153835f), float4(-2.3666961f, 0.7592666f, -0.4559092f, 0.16644585f)),
    float4x4(float4(-10.40095f, -0.7319011f, -0.098409206f, 0.6716261f), float4(-16.846764f, -0.16363278f, 0.0705156f, -0.81101024f), float4(1.2655652f, 1.133049f, -0.32820627f, 1.3431172f), float4(0.097226314f, 2.1702707f, 0.19467546f, -0.21296397f)),
    float4x4(float4(-0.9769834f, -0.19660002f, -0.15754014f, -0.2954295f), float4(0.8903658f, -1.8261007f, 0.20727421f, 0.5121889f), float4(-0.5203369f, 0.7108131f, -0.29579365f, -0.9327649f), float4(-0.22054835f, 0.21884254f, -0.03203045f, 0.2682206f)),
    float4x4(float4(-3.2047994f, -0.8837148f, -0.4720584f, -0.62909454f), float4(4.9013968f, -0.6316979f, 0.20519109f, -0.26976955f), float4(-4.0575733f, 0.08856346f, -0.16031244f, 0.08090388f), float4(5.2038455f, -4.2888317f, -0.1686734f, 12.440769f)),
    float4x4(float4(3.6943107f, 1.8451847f, -0.22946021f, -0.45697916f), float4(-1.1194772f, 1.180061f, -0.43405393f, -0.56196725f), float4(1.3533713f, -1.2912682f, -0.5022f, -0.010167375f), float4(-1.1256665f, -0.52741456f, -0.16944394f, -0.397702f)),
    float4x4(float4(-0.71657157f, 1.0929166f, -0.31094712f, 0.9967563f), float4(3.976363f, 0.2571014f, -0.21445362f, -2.047206f), float4(-4.55307f, 1.0491005f, 0.071866944f, -0.11887761f), float4(-1.0956858f, -0.06842874f, -0.41885126f, -0.12935957f)),
    float4x4(float4(-1.5963695f, 0.3983476f, -0.017120127f, 0.727083f), float4(1.3940905f, -0.2533441f, -0.25948974f, 0.28562602f), float4(3.9495683f, -8.981777f, -0.26451614f, -0.82732475f), float4(-5.739348f, 0.7764399f, -0.06020284f, 0.43284827f)),
    float4x4(float4(0.5082415f, -0.62483346f, -0.43046457f, 0.13603057f), float4(-0.117523104f, -0.18126619f, -0.020414537f, 2.0211098f), float4(0.67537737f, -0.18371765f, -0.30383107f, -0.01744632f), float4(1.7409476f, -0.9387373f, -0.17043106f, -1.4065812f)),
    float4x4(float4(-0.3985412f, 0.36677298f, -0.18094414f, 0.40633914f), float4(-1.7927763f, -11.482819f, -0.03175604f, -1.0081413f), float4(0.1428039f, -0.30969492f, -0.0665183f, 1.4574957f), float4(-0.089206755f, -0.5059666f, -0.16247077f, 1.1644918f)),
    float4x4(float4(-0.40347168f, -4.987954f, -0.15238455f, -0.16611195f), float4(1.4411457f, -3.2031503f, 0.054474827f, 2.386548f), float4(-0.62442327f, 0.61405766f, -0.35104215f, 0.44550407f), float4(2.1856534f, -0.3575495f, -0.66822314f, 0.110733286f))
};
static const float4 NMT_B2[6] = {
    float4(-0.80572444f, -0.36572033f, -17.028751f, -8.929133f),
    float4(-0.2066644f, 3.1374116f, -8.441638f, -4.037213f),
    float4(-8.115326f, 0.5785027f, -5.9326916f, -1.0728102f),
    float4(-13.753219f, -0.52447253f, -0.35142645f, 2.7338395f),
    float4(-0.21736947f, 3.032581f, -2.7812176f, -0.3052986f),
    float4(3.9996717f, 2.19122f, -0.05236737f, 2.9993734f)
};
static const float4 NMT_W3[6] = {
    float4(-0.102657646f, 0.20861307f, 0.10088752f, -0.17545125f),
    float4(0.058216162f, 0.044907387f, -2.0607347f, -0.061762556f),
    float4(0.072035365f, 0.07638537f, 0.1103074f, 0.07059699f),
    float4(0.1438686f, 0.16542599f, 0.44603232f, -0.084360905f),
    float4(0.048001867f, 0.122930065f, 0.06356484f, 0.16569044f),
    float4(-0.10376659f, -0.14015713f, -0.044400208f, -0.15007412f)
};
static const float NMT_B3 = -1.4709775f;

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
    float4 h1_8 = max(mul(h0_0, NMT_W1[24]) + mul(h0_1, NMT_W1[25]) + mul(h0_2, NMT_W1[26]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_9 = max(mul(h0_0, NMT_W1[27]) + mul(h0_1, NMT_W1[28]) + mul(h0_2, NMT_W1[29]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_10 = max(mul(h0_0, NMT_W1[30]) + mul(h0_1, NMT_W1[31]) + mul(h0_2, NMT_W1[32]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_11 = max(mul(h0_0, NMT_W1[33]) + mul(h0_1, NMT_W1[34]) + mul(h0_2, NMT_W1[35]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_0 = max(NMT_B2[0] + mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]) + mul(h1_3, NMT_W2[3]) + mul(h1_4, NMT_W2[4]) + mul(h1_5, NMT_W2[5]) + mul(h1_6, NMT_W2[6]) + mul(h1_7, NMT_W2[7]) + mul(h1_8, NMT_W2[8]) + mul(h1_9, NMT_W2[9]) + mul(h1_10, NMT_W2[10]) + mul(h1_11, NMT_W2[11]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(NMT_B2[1] + mul(h1_0, NMT_W2[12]) + mul(h1_1, NMT_W2[13]) + mul(h1_2, NMT_W2[14]) + mul(h1_3, NMT_W2[15]) + mul(h1_4, NMT_W2[16]) + mul(h1_5, NMT_W2[17]) + mul(h1_6, NMT_W2[18]) + mul(h1_7, NMT_W2[19]) + mul(h1_8, NMT_W2[20]) + mul(h1_9, NMT_W2[21]) + mul(h1_10, NMT_W2[22]) + mul(h1_11, NMT_W2[23]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_2 = max(NMT_B2[2] + mul(h1_0, NMT_W2[24]) + mul(h1_1, NMT_W2[25]) + mul(h1_2, NMT_W2[26]) + mul(h1_3, NMT_W2[27]) + mul(h1_4, NMT_W2[28]) + mul(h1_5, NMT_W2[29]) + mul(h1_6, NMT_W2[30]) + mul(h1_7, NMT_W2[31]) + mul(h1_8, NMT_W2[32]) + mul(h1_9, NMT_W2[33]) + mul(h1_10, NMT_W2[34]) + mul(h1_11, NMT_W2[35]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_3 = max(NMT_B2[3] + mul(h1_0, NMT_W2[36]) + mul(h1_1, NMT_W2[37]) + mul(h1_2, NMT_W2[38]) + mul(h1_3, NMT_W2[39]) + mul(h1_4, NMT_W2[40]) + mul(h1_5, NMT_W2[41]) + mul(h1_6, NMT_W2[42]) + mul(h1_7, NMT_W2[43]) + mul(h1_8, NMT_W2[44]) + mul(h1_9, NMT_W2[45]) + mul(h1_10, NMT_W2[46]) + mul(h1_11, NMT_W2[47]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_4 = max(NMT_B2[4] + mul(h1_0, NMT_W2[48]) + mul(h1_1, NMT_W2[49]) + mul(h1_2, NMT_W2[50]) + mul(h1_3, NMT_W2[51]) + mul(h1_4, NMT_W2[52]) + mul(h1_5, NMT_W2[53]) + mul(h1_6, NMT_W2[54]) + mul(h1_7, NMT_W2[55]) + mul(h1_8, NMT_W2[56]) + mul(h1_9, NMT_W2[57]) + mul(h1_10, NMT_W2[58]) + mul(h1_11, NMT_W2[59]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_5 = max(NMT_B2[5] + mul(h1_0, NMT_W2[60]) + mul(h1_1, NMT_W2[61]) + mul(h1_2, NMT_W2[62]) + mul(h1_3, NMT_W2[63]) + mul(h1_4, NMT_W2[64]) + mul(h1_5, NMT_W2[65]) + mul(h1_6, NMT_W2[66]) + mul(h1_7, NMT_W2[67]) + mul(h1_8, NMT_W2[68]) + mul(h1_9, NMT_W2[69]) + mul(h1_10, NMT_W2[70]) + mul(h1_11, NMT_W2[71]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1) + dot(NMT_W3[2], h2_2) + dot(NMT_W3[3], h2_3) + dot(NMT_W3[4], h2_4) + dot(NMT_W3[5], h2_5);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float3x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0f)) - 0.05f, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

static const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
static const uint NMT_OCTAVE_BITS = 11u;
static const uint NMT_HEAVY = 6u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
static const uint NMT_SLOTS = 8u;
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

uint2 nmt_core_nearest_steps(uint code) {
    return uint2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uint2 nmt_core_farthest_steps(uint code) {
    return uint2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uint2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uint2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
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
    float front_7 = front_6 + (depths1.z < z ? absorbances1.z : 0.0);
    float in_core_7 = (depths1.z == z && absorbances1.z == absorbance ? 1.0 : in_core_6);
    float count_7 = count_6 - (absorbances1.z > 0.0 ? 1.0 : 0.0);
    float rest0_7 = rest0_6 - absorbances1.z;
    float rest1_7 = rest1_6 - absorbances1.z * depths1.z;
    float rest2_7 = rest2_6 - absorbances1.z * depths1.z * depths1.z;
    float rest3_7 = rest3_6 - absorbances1.z * depths1.z * depths1.z * depths1.z;
    float rest4_7 = rest4_6 - absorbances1.z * depths1.z * depths1.z * depths1.z * depths1.z;
    float front_8 = front_7 + (depths1.w < z ? absorbances1.w : 0.0);
    float in_core_8 = (depths1.w == z && absorbances1.w == absorbance ? 1.0 : in_core_7);
    float count_8 = count_7 - (absorbances1.w > 0.0 ? 1.0 : 0.0);
    float rest0_8 = rest0_7 - absorbances1.w;
    float rest1_8 = rest1_7 - absorbances1.w * depths1.w;
    float rest2_8 = rest2_7 - absorbances1.w * depths1.w * depths1.w;
    float rest3_8 = rest3_7 - absorbances1.w * depths1.w * depths1.w * depths1.w;
    float rest4_8 = rest4_7 - absorbances1.w * depths1.w * depths1.w * depths1.w * depths1.w;
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_8 - center * rest0_8) * per_h;
    float moved2 = (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)) * (per_h * per_h);
    float moved3 = (rest3_8 - center * rest2_8 - center * (rest2_8 - center * rest1_8) - center * (rest2_8 - center
        * rest1_8 - center * (rest1_8 - center * rest0_8))) * (per_h * per_h * per_h);
    float moved4 = (rest4_8 - center * rest3_8 - center * (rest3_8 - center * rest2_8) - center * (rest3_8 - center
        * rest2_8 - center * (rest2_8 - center * rest1_8)) - center * (rest3_8 - center * rest2_8 - center * (rest2_8
        - center * rest1_8) - center * (rest2_8 - center * rest1_8 - center * (rest1_8 - center * rest0_8)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_8 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_8 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_8 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_8 + absorbance_of_tail * exact_4)), 1.0);
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
        float most = min(exp(-(front_8 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_8 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        if (most - least <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    return exp(-front_8) * nmt_transmittance(float3x4(float4(x, log2(others) * 0.33333334 - 1.0,
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
    float2 slot6 = nmt_core_slot(core1.z, nmt_core_heavy_steps(core1.z, codes));
    float2 slot7 = nmt_core_slot(core1.w, nmt_core_heavy_steps(core1.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        float4(slot0.x, slot1.x, slot2.x, slot3.x),
        float4(slot0.y, slot1.y, slot2.y, slot3.y),
        float4(slot4.x, slot5.x, slot6.x, slot7.x),
        float4(slot4.y, slot5.y, slot6.y, slot7.y),
        n,
        b0,
        moments
    );
}

cbuffer Frame : register(b0) {
    float2 v_range;
    uint width;
};

Texture2D<float4> sums0_texture : register(t0);
Texture2D<float4> sums1_texture : register(t1);
StructuredBuffer<uint2> core : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 pixel = uint2(input.position.xy);
    uint first = 4u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
    float4 sums0 = sums0_texture.Load(at);
    float4 sums1 = sums1_texture.Load(at);
    float4 moments = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, uint4(core[first], core[first + 1u]), uint4(core[first + 2u], core[first + 3u]), sums1.y, sums0.x, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
