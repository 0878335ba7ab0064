// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as vectors.
//
// Neural moment transparency: network 'core-large', 9-48-24-1, 1608 multiply-adds.
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset 2047c3a13a19dc612f5c4d0b31421acc3ed79459e8fe18b2fc743a11529b0aab.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

static const float4x4 NMT_W1[36] = {
    float4x4(float4(0.55806774f, -0.44292864f, -0.72614175f, -1.3351513f), float4(-0.05324088f, 0.0043841065f, -0.18285415f, 0.02536074f), float4(-0.13352484f, 0.08375983f, 0.22284195f, 0.14627187f), float4(-0.380239f, -6.0682845f, -13.625908f, 0.5956826f)),
    float4x4(float4(0.36625358f, -2.9806106f, -2.5406961f, -0.38580075f), float4(0.8799789f, -1.2017877f, -1.2959102f, 0.561088f), float4(2.3728793f, 0.8436882f, -5.6676764f, -0.6733761f), float4(1.2116308f, -0.065298125f, 1.12709f, 0.91044515f)),
    float4x4(float4(-1.5294496f, 1.7835509f, -3.4773397f, -0.19604592f), float4(0.05750032f, -0.6030508f, 0.8054012f, 0.061955538f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.4385324f, 1.3639718f, -1.0306638f, 1.4275537f), float4(-0.098020084f, 0.2218877f, 0.46271548f, 0.01775085f), float4(-0.006018177f, -0.00728007f, 0.0016085033f, -0.08494704f), float4(2.302306f, 5.0464845f, 0.22935914f, 2.7825875f)),
    float4x4(float4(0.42327285f, 1.0568275f, -0.6098001f, -3.4462757f), float4(0.8571805f, 0.7801869f, -1.7597632f, -2.3625355f), float4(-3.12182f, 1.06728f, 1.1810184f, 3.06692f), float4(-0.21671738f, -0.89949197f, 1.3698279f, 2.3160243f)),
    float4x4(float4(0.1811915f, 0.35231736f, 0.4181643f, -1.1030469f), float4(-0.9908363f, 0.45591435f, -2.2249274f, 0.34560013f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.9778422f, -0.017212195f, -1.4748449f, 0.84529644f), float4(0.09873822f, 0.5519083f, -0.07230803f, 0.014905357f), float4(0.021977944f, -0.111525655f, 0.10557546f, 0.04541206f), float4(-2.451723f, -0.08014107f, 1.5792971f, -0.7078986f)),
    float4x4(float4(-0.3051956f, 2.2953815f, -3.3416395f, 0.08043254f), float4(-1.3869635f, 0.004135052f, -1.3754796f, 0.5018249f), float4(-0.5714667f, 1.1063558f, -0.13501523f, 2.5894666f), float4(2.4520626f, -0.09932363f, 0.8377761f, -0.81829363f)),
    float4x4(float4(1.6478494f, -0.76415366f, 0.18035454f, -3.343759f), float4(-1.7611853f, -1.1202525f, -0.6719218f, 1.1184571f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.87708235f, -0.09961068f, -0.8481134f, 0.6391947f), float4(0.050893877f, -0.22014493f, 0.27750498f, 0.120802574f), float4(-0.095055856f, 0.078784116f, -0.08016207f, -0.30470887f), float4(-1.510754f, -11.371086f, 3.3518076f, -0.063728265f)),
    float4x4(float4(1.8942649f, -2.764668f, -2.1716108f, 1.9397254f), float4(1.4176176f, -0.42356294f, 1.6321214f, -2.175169f), float4(1.8904504f, 1.1171756f, -1.5129455f, 1.2903796f), float4(0.5705323f, -0.49751347f, 0.10275594f, 1.4887366f)),
    float4x4(float4(1.0805712f, 3.4127975f, 1.6076572f, -0.97486085f), float4(-0.8157024f, -1.5566509f, -1.0042311f, -1.025133f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.0555946f, -1.0364676f, 1.279098f, -0.4110115f), float4(0.024651354f, 0.1411363f, 0.23423415f, -1.2997997f), float4(0.124928184f, 0.03131803f, 0.15773827f, 0.58881974f), float4(0.10136319f, -6.3294086f, -1.7261844f, -1.3834095f)),
    float4x4(float4(1.7567682f, 1.4719923f, -0.55578095f, -2.0846887f), float4(1.5134485f, -1.473819f, 2.838168f, -1.0360707f), float4(1.3887018f, -3.7003794f, -9.673744f, 1.2400547f), float4(-1.3243271f, 3.1452937f, -0.021236356f, 0.5207019f)),
    float4x4(float4(-2.103662f, 0.19137521f, -6.774238f, -0.8554695f), float4(-0.91210526f, -0.73864466f, -0.636952f, 0.4384121f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.35577703f, -0.43791804f, 0.18277882f, -2.1139126f), float4(0.15781248f, -0.030516682f, 0.1810792f, -0.011733967f), float4(-0.054442864f, 0.02338948f, -0.066262715f, -0.0023368946f), float4(2.8837457f, 7.087114f, 1.7910595f, 0.230784f)),
    float4x4(float4(2.5999358f, -4.5935946f, 1.7987843f, -0.12281367f), float4(-0.6703469f, 1.3134067f, 2.271754f, -0.19861068f), float4(0.12447109f, -3.437476f, -0.6579124f, 0.27584594f), float4(1.9438467f, -1.6386985f, -0.83810973f, 0.18547691f)),
    float4x4(float4(0.36485538f, 1.9157228f, -6.473582f, -0.105186574f), float4(-0.018766357f, -0.26111087f, 0.82158494f, -2.0550177f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.4464397f, 1.8174143f, 0.32492536f, 0.21916956f), float4(-0.036945097f, 0.015831666f, -0.060867626f, -0.15540646f), float4(0.014252259f, 0.009857574f, 0.15620914f, -0.6357397f), float4(1.5250934f, -4.287898f, -2.3317847f, -2.0695531f)),
    float4x4(float4(-6.9569135f, 0.5292f, 1.324474f, -7.307691f), float4(-0.073489055f, 0.8220712f, 2.3491354f, -4.7828045f), float4(-0.841782f, -1.3537288f, 0.124621674f, 0.85887444f), float4(-0.23106417f, -0.8482506f, 0.41334888f, 1.2300836f)),
    float4x4(float4(1.7422702f, 0.61403435f, 0.12927109f, -5.0141582f), float4(-0.04733097f, 1.6133701f, 0.017000549f, 1.1244426f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.7645873f, -0.7912974f, 0.861609f, 0.29082698f), float4(-0.11730501f, -0.05897767f, -0.011626148f, -0.2628027f), float4(-0.37481084f, -0.007978047f, 0.020621125f, -0.10160456f), float4(-15.004611f, 4.152447f, -9.580385f, 0.28955266f)),
    float4x4(float4(-0.030680388f, -4.6505466f, -0.36800304f, 0.036276218f), float4(1.5218276f, 1.427771f, -2.6694298f, 1.2387238f), float4(-0.8410458f, -5.445589f, -3.1287425f, -2.961497f), float4(0.11077644f, -0.24339621f, 2.1115332f, -0.17595454f)),
    float4x4(float4(0.16906585f, 0.0011089913f, -0.7526741f, 0.46008316f), float4(0.102451555f, 0.9930348f, 1.4629606f, 1.5097761f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.3057256f, 2.0050066f, -0.26199067f, 0.27851003f), float4(0.33476385f, 0.17164616f, -0.0059270873f, -0.012581149f), float4(-0.176359f, -0.085746415f, 0.0042114086f, 0.06184859f), float4(-10.9224825f, 3.1841152f, 3.5534623f, 1.9988027f)),
    float4x4(float4(-2.3567529f, -3.785828f, -5.174365f, 0.8215718f), float4(1.6070983f, -0.76070076f, 0.65124273f, -2.5577412f), float4(-2.5952268f, -4.6816835f, -7.1648803f, -0.6243319f), float4(-1.0464823f, -0.25357494f, 1.3228892f, 4.4393816f)),
    float4x4(float4(-2.0000074f, 1.9256629f, 0.41030508f, 0.72306615f), float4(1.0407834f, 0.33637527f, 0.5520835f, -0.2697425f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(1.5049344f, -1.5695361f, 1.1442264f, 1.9741359f), float4(-0.015103893f, 0.1618618f, -0.006202282f, 0.041523725f), float4(-0.013035699f, 0.06372571f, -0.0881914f, -0.020080682f), float4(-12.98584f, 2.0922108f, 4.812617f, 2.4294512f)),
    float4x4(float4(-0.963725f, -1.2460338f, -2.381702f, -4.3104706f), float4(0.027185395f, 0.15988883f, -0.69146866f, -2.6258442f), float4(-0.3978837f, -0.03096139f, 1.2947563f, 0.33023125f), float4(-0.8806673f, -1.1640862f, -0.32489428f, -0.54779387f)),
    float4x4(float4(2.6497355f, 0.10946282f, 1.1824491f, -0.32193375f), float4(0.56782794f, -0.5699246f, 0.8776655f, 1.4853933f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.16208579f, 1.2926403f, 1.4274973f, -0.2795598f), float4(-0.17118111f, 0.0021723593f, -0.27643296f, 0.2205893f), float4(-0.08982216f, -0.0025678938f, 0.7937979f, 0.0032285806f), float4(-2.974072f, -0.6783333f, -1.083541f, -5.9226756f)),
    float4x4(float4(-5.296071f, -5.9140444f, 0.5903538f, -2.7260377f), float4(2.308578f, -3.0541987f, -0.5729362f, -0.29918826f), float4(3.5402915f, 0.13617352f, 1.4820328f, 0.44422117f), float4(1.1571f, 2.3794005f, -0.21038601f, 0.7679123f)),
    float4x4(float4(-1.0230507f, 2.8326612f, 0.38138846f, -0.46221322f), float4(-1.4874815f, 0.37287945f, -2.0291657f, 0.5430083f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.59914684f, -1.7604535f, -0.82120365f, -0.59817195f), float4(-0.85477364f, -0.06150866f, 0.04204701f, -0.14527619f), float4(0.29668626f, 0.006776952f, -0.038161967f, -0.08460091f), float4(1.7320052f, -0.9130395f, 3.1648881f, -0.116671115f)),
    float4x4(float4(1.2565001f, -2.3775766f, -4.839742f, -0.7062411f), float4(0.35866988f, -0.54485995f, 1.0607102f, -1.7434273f), float4(0.24820839f, 0.9227296f, -0.35050797f, 0.9206224f), float4(-1.0739918f, 0.14258812f, -0.99694324f, 2.7114058f)),
    float4x4(float4(0.65769655f, -0.20826364f, 0.42099646f, -1.0905643f), float4(0.07643958f, -1.363614f, 0.2555151f, 1.1271988f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[72] = {
    float4x4(float4(0.20897241f, 0.013402366f, -1.3403349f, 0.19922471f), float4(-0.09633657f, -0.39079496f, 0.27154562f, 0.5247394f), float4(-0.8039113f, 0.2205815f, -0.43568245f, 0.5562842f), float4(-0.10052977f, -0.05574661f, -0.60680807f, 0.27594417f)),
    float4x4(float4(-0.36220244f, 0.10701322f, 0.49269763f, 0.64303493f), float4(0.018880203f, -0.055885218f, -0.49220726f, -0.40931666f), float4(1.0596713f, 0.23330916f, 2.083065f, 0.8678954f), float4(1.5134813f, -0.19452374f, 0.9325514f, 0.52140576f)),
    float4x4(float4(-0.7359224f, -0.053891685f, -1.9724003f, 0.8075855f), float4(0.33144537f, -0.24380405f, 0.638103f, -0.027885394f), float4(-0.5214817f, -0.0008847724f, -1.4010432f, 0.588388f), float4(-0.76959133f, -0.21818095f, 0.35599905f, 0.47163284f)),
    float4x4(float4(-0.96244514f, 0.18083826f, -0.43489087f, 0.08733331f), float4(-1.4066592f, -0.23101164f, -1.1309593f, -0.1452855f), float4(-0.8731514f, -0.19805409f, 0.31689787f, 0.5213694f), float4(-1.0691059f, 0.03569499f, -3.5697267f, -0.75991523f)),
    float4x4(float4(-0.18780418f, -0.3015516f, -1.0872362f, 0.15241675f), float4(-0.43858618f, -0.07501383f, -4.0657783f, 0.027297467f), float4(0.35776854f, -0.2303498f, -0.5454567f, 0.297172f), float4(0.07728166f, -0.19508429f, 0.56022024f, 0.6751353f)),
    float4x4(float4(-0.645187f, -0.25830993f, -0.6605728f, -0.25237808f), float4(1.7151197f, 0.1766037f, 1.9131291f, 0.3087759f), float4(0.96429986f, 0.2190129f, 1.4979433f, 1.0232033f), float4(14.4398575f, -0.0081841545f, 14.375571f, 3.2107842f)),
    float4x4(float4(2.0419636f, 0.15841584f, 2.9914358f, 0.14697532f), float4(1.1292533f, -0.33694097f, 1.7156609f, 0.05444616f), float4(-0.0032931913f, -0.17052343f, -1.1399049f, 0.2219354f), float4(-0.40802875f, -0.019391622f, 0.6590554f, 2.706729f)),
    float4x4(float4(0.28635725f, 0.026009299f, -0.3240904f, -0.123607546f), float4(0.98459566f, -0.33095708f, 0.5018582f, -0.5534794f), float4(0.09702438f, -0.01722566f, -2.978186f, 0.21445417f), float4(-0.30748868f, -0.056815047f, -0.32678452f, 0.13933676f)),
    float4x4(float4(-0.21168016f, -0.04626017f, 1.6412543f, -0.12936719f), float4(-0.1540728f, 0.25167313f, 0.022762401f, 0.09057579f), float4(2.1785948f, 0.13152696f, 3.1430705f, -0.0290871f), float4(-1.6666493f, -0.23380172f, -2.1963959f, 0.103762686f)),
    float4x4(float4(1.1284527f, -0.11941011f, 1.632404f, -0.30722633f), float4(0.32328448f, -0.01494952f, 0.103632495f, 0.32088438f), float4(0.13076977f, -0.12541221f, 0.12509413f, 0.30117297f), float4(-0.3976947f, 0.021882966f, 0.24299529f, -0.8292663f)),
    float4x4(float4(0.14272028f, -0.3213788f, 0.3063993f, 0.57025826f), float4(-4.3297715f, -0.036393873f, -5.9335194f, 0.23511297f), float4(-0.11210419f, 0.15002204f, -0.12416695f, 0.5771959f), float4(-0.3692848f, -0.16307591f, 0.18951f, 0.31966692f)),
    float4x4(float4(0.3771096f, -0.22011648f, 0.45279834f, 0.075300545f), float4(0.8545977f, 0.1293634f, 0.7416638f, 1.0779505f), float4(1.3877673f, -0.13401692f, 0.59824425f, 0.3543023f), float4(-0.57270277f, -0.20928824f, -3.6922965f, 0.102309585f)),
    float4x4(float4(-0.06690604f, 0.860876f, -0.45208257f, -0.563896f), float4(-0.1188971f, 1.0364031f, -0.013766638f, 0.054125976f), float4(0.17144312f, -2.9728596f, -0.089980364f, -0.038437918f), float4(0.1760476f, -0.42985675f, -0.2150402f, -0.35239395f)),
    float4x4(float4(0.036302f, -1.4550543f, 0.69838536f, 0.029589169f), float4(-0.26642898f, -0.05694085f, -1.313514f, -0.4168944f), float4(0.036984473f, 1.5489564f, -0.17244855f, -0.27642617f), float4(-0.16905366f, -3.5792916f, -0.61177045f, -0.37417135f)),
    float4x4(float4(0.12234954f, 1.1757063f, 0.37091872f, -0.25829023f), float4(-0.21078394f, 0.48845693f, 0.24949598f, -0.52792394f), float4(-0.21442872f, 0.030354945f, 0.058814537f, 0.012047577f), float4(0.03319849f, 1.384859f, -1.032457f, -0.5727255f)),
    float4x4(float4(-0.28967768f, 0.12889028f, 0.34054887f, -0.5120144f), float4(-0.12998866f, 0.73051417f, 0.20493068f, 0.056848638f), float4(-0.098927625f, -0.6781862f, 0.31521586f, 0.009087788f), float4(-0.25847656f, 0.56131816f, -0.2639525f, 0.38635957f)),
    float4x4(float4(-0.26792505f, 0.813656f, 0.7257653f, -0.24108703f), float4(0.20592156f, -1.764769f, 0.08279555f, -0.2565833f), float4(-0.12383205f, -0.10185535f, -0.62007713f, 0.09410638f), float4(0.027188756f, -0.11967376f, -0.13921508f, -0.4093311f)),
    float4x4(float4(-0.32102695f, -0.24016766f, -0.10142264f, -0.68021744f), float4(-0.36710355f, 0.44113946f, 1.1116201f, -0.20787907f), float4(-0.23798195f, 1.1301265f, 0.5228936f, 0.042630557f), float4(0.19492269f, -1.2940198f, 12.464008f, 0.026262447f)),
    float4x4(float4(-0.11019408f, -0.36554545f, 0.1315131f, -0.046202227f), float4(-0.30352944f, -0.4912019f, -2.6503265f, 0.011698126f), float4(-0.12766238f, 0.3086185f, 0.16418517f, -0.2619273f), float4(0.102072954f, 1.143056f, -0.0088608675f, -0.11693814f)),
    float4x4(float4(0.2154396f, -0.8262243f, -0.06396195f, 0.48627335f), float4(-0.106939f, -3.2893236f, -0.66713893f, -0.023973785f), float4(-0.10294576f, 0.22692443f, -0.21682812f, -0.52269256f), float4(-0.16212085f, -0.60887486f, 0.06766954f, -0.029481405f)),
    float4x4(float4(-0.17885831f, -1.1034814f, 0.038571052f, -0.09394316f), float4(0.027915828f, 1.2782774f, 0.5000175f, -0.25231487f), float4(0.16374977f, 0.5037475f, -0.0048110555f, -0.40346387f), float4(0.048518814f, -0.6104315f, -0.08168586f, -0.6083246f)),
    float4x4(float4(-0.023818461f, -0.25418556f, -0.4538824f, -0.3746574f), float4(-0.16279273f, 0.06922475f, 0.8221205f, -0.26678532f), float4(-0.28626478f, 1.7077856f, -0.10817632f, -0.4276605f), float4(0.10118939f, -0.3918821f, -0.40388453f, -0.112776734f)),
    float4x4(float4(0.020511346f, 0.71910906f, -0.091525435f, -0.3141403f), float4(0.044527166f, 0.46587393f, -0.48347387f, -0.3440474f), float4(0.17662916f, -0.15163977f, -0.11761125f, -0.39981863f), float4(-0.00048976234f, 0.54355466f, -0.043450315f, -0.35202172f)),
    float4x4(float4(0.05183687f, 0.1896036f, -0.1337119f, -0.2598758f), float4(-0.06724604f, -1.643086f, 0.8971792f, -0.11372286f), float4(0.0352418f, 0.3831299f, 0.03479939f, 0.26456282f), float4(-0.38439f, 0.33797875f, -0.21574175f, -0.24593784f)),
    float4x4(float4(-0.39465296f, 0.13226813f, 0.585271f, -0.27050406f), float4(2.1692886f, -1.0760825f, -4.2781067f, -0.2617828f), float4(0.357477f, -0.89543945f, -0.5446753f, -0.7212425f), float4(-0.90147114f, -0.19188583f, 0.7757622f, 0.49176216f)),
    float4x4(float4(-2.2552478f, -1.6722686f, 1.4089596f, -1.4810479f), float4(0.31616744f, 0.58724725f, -0.29492605f, -0.9589943f), float4(0.8668073f, -0.02586172f, 0.783138f, 0.4649073f), float4(0.29134396f, 0.7401921f, -3.0985632f, 0.971766f)),
    float4x4(float4(3.9092522f, -0.6128454f, 0.34623742f, -0.28465247f), float4(-1.1149688f, 0.11180207f, -0.36184517f, 0.16712165f), float4(0.5475687f, -0.75980043f, -2.0250356f, 0.60747504f), float4(0.16112892f, -0.3474701f, -2.298693f, 1.4900813f)),
    float4x4(float4(0.10158989f, 0.20131789f, 1.0191196f, -1.4429666f), float4(1.338152f, 1.1367623f, 1.5498085f, -1.029529f), float4(-0.5436558f, 0.66847587f, 0.8143833f, 0.8339414f), float4(0.6249825f, -0.265554f, 0.54653347f, 0.8370412f)),
    float4x4(float4(-0.3120663f, 0.4050771f, 0.45253643f, -0.39433494f), float4(-0.9624699f, -0.4139833f, 0.4786828f, -1.3860507f), float4(-0.39158618f, 1.0782933f, 0.4374224f, 0.78105044f), float4(0.6398117f, 2.3563936f, 1.0250002f, -0.27176544f)),
    float4x4(float4(0.6811693f, 0.28979f, 0.49941704f, -0.030567678f), float4(-1.0748317f, -0.27872378f, 1.0455899f, 0.97671694f), float4(0.65851444f, -0.7469414f, -5.9250736f, 0.25936523f), float4(7.3868f, -1.3801894f, -6.820488f, 4.2642617f)),
    float4x4(float4(-0.9656579f, 0.89416033f, -1.4549199f, -0.64436555f), float4(0.25946692f, -0.4532617f, -3.1088095f, 0.69634223f), float4(-0.4336003f, 0.4059016f, -0.6568687f, 0.8314789f), float4(0.087498434f, -0.6254835f, -0.98042f, -0.52642345f)),
    float4x4(float4(0.22378102f, 0.25300193f, -1.7377725f, 0.37102515f), float4(2.0261154f, -1.114933f, -0.15504634f, -0.41170427f), float4(-1.1371154f, 0.013273741f, -1.6805257f, 0.4573712f), float4(1.2654424f, -0.91114855f, -0.5240473f, -0.7022115f)),
    float4x4(float4(-0.0038357668f, 0.095116764f, 1.0613953f, -0.6558609f), float4(1.7866236f, 0.31381717f, -12.485452f, -1.5766371f), float4(1.2261627f, -3.2458467f, -1.7740865f, 1.5084383f), float4(-0.5826618f, 0.33402008f, 1.0995622f, -2.4199162f)),
    float4x4(float4(0.608481f, -0.44787562f, 3.0947487f, -2.7540772f), float4(-0.576954f, -0.40597218f, 0.30719358f, 0.23377985f), float4(-0.67947185f, 0.25314108f, -1.1659861f, -0.43460125f), float4(0.9738538f, 0.56554264f, 2.9601793f, 0.7653173f)),
    float4x4(float4(1.504734f, -0.48183274f, 1.0391171f, 0.26192057f), float4(-10.611856f, 0.4996653f, -2.8791676f, 2.593785f), float4(0.16613999f, 1.0639842f, -0.21233742f, -0.22644612f), float4(0.4117542f, 0.94157827f, 1.2354072f, -0.36669755f)),
    float4x4(float4(-0.22894695f, -0.546901f, -1.5671277f, -0.046548784f), float4(3.616873f, -0.7322332f, -3.939454f, 1.2563707f), float4(-0.3428878f, 1.0228982f, -1.256035f, -0.5325078f), float4(-1.8939433f, 0.20103595f, 1.0717933f, 0.9221485f)),
    float4x4(float4(0.8360675f, -0.3472675f, -0.28512567f, -0.5697213f), float4(0.347752f, -0.104260124f, -0.3831009f, 0.91405374f), float4(2.2447991f, -0.15077245f, 0.09025633f, -1.862868f), float4(0.21308349f, 0.081316955f, -0.30445278f, 0.30652577f)),
    float4x4(float4(1.1780167f, -0.07036236f, -0.3208207f, -0.87336564f), float4(0.3451941f, -0.24091065f, -0.50547975f, -0.2238763f), float4(1.3982508f, -0.08535457f, 0.089486316f, 0.28984255f), float4(0.92930937f, 0.14261842f, -0.3164983f, -2.4353352f)),
    float4x4(float4(-2.4103608f, -0.3402426f, -0.17205366f, -1.4302626f), float4(0.29552627f, -0.018999128f, -0.31563318f, 0.5204516f), float4(-0.30518872f, 0.13477983f, -0.11910901f, 0.58336174f), float4(-5.4491816f, -0.30540466f, -0.69025564f, 1.1857105f)),
    float4x4(float4(-0.9818361f, -0.29394394f, 0.19735798f, 0.32189167f), float4(-1.0826308f, -0.16375321f, -0.31978685f, 0.13781619f), float4(-0.4666183f, -0.034972727f, 0.21338634f, -0.2682482f), float4(-0.20653117f, -0.32898486f, 0.035652384f, 0.8903216f)),
    float4x4(float4(0.6623246f, -0.19683164f, -0.049821094f, -0.34698534f), float4(-0.8037827f, 0.14320448f, -0.2455654f, -1.4676298f), float4(-1.4380087f, 0.09767321f, 0.15113883f, -1.5854113f), float4(0.10862937f, 0.0031524242f, 0.02707748f, -0.025726574f)),
    float4x4(float4(-0.6486161f, -0.00873128f, 0.09628938f, -0.4862315f), float4(-7.590088f, 0.051619414f, -0.29421806f, 0.7432432f), float4(-0.97913164f, 0.08040334f, -0.31199142f, 0.5985564f), float4(6.3124995f, 0.11130172f, 0.120374605f, 4.425878f)),
    float4x4(float4(-2.52671f, 0.03229294f, -0.22211112f, 0.7700192f), float4(0.46025777f, 0.08347539f, -0.36274272f, 0.8131964f), float4(0.36119252f, -0.09165168f, -0.177589f, -0.559711f), float4(-0.8728388f, -0.04798773f, 0.056596905f, 0.37899375f)),
    float4x4(float4(-0.2727541f, -0.0015104603f, -0.30773938f, 0.7328371f), float4(0.70068127f, -0.087403856f, -0.12790942f, 1.0148358f), float4(-0.663807f, -0.23051648f, 0.045310978f, -0.3491575f), float4(0.65938306f, 0.13437611f, -0.019531485f, 0.18466443f)),
    float4x4(float4(0.4958076f, -0.002739571f, 0.06712439f, -0.79943794f), float4(-1.5338442f, 0.0020532683f, -0.8453459f, 0.59205544f), float4(1.3568631f, -0.40019953f, -0.30250224f, 1.6419259f), float4(-1.2769017f, -0.020115484f, 0.1464215f, 0.49655032f)),
    float4x4(float4(-3.5850167f, -0.19752085f, 0.14370686f, 0.39350897f), float4(0.40076128f, -0.09735637f, 0.17980704f, 0.5858434f), float4(-0.8643245f, -0.07214185f, 0.20311011f, -0.37019897f), float4(-0.30238327f, -0.012861428f, 0.09035797f, -0.111839786f)),
    float4x4(float4(-0.7602195f, 0.15396515f, 0.0884693f, 0.590723f), float4(2.6033137f, 0.15245377f, -0.34463802f, -3.0539978f), float4(0.008523752f, 0.014342837f, 0.12331255f, -0.3171981f), float4(-0.3338474f, -0.40507534f, -0.31452024f, 0.49345905f)),
    float4x4(float4(0.037417177f, -0.091397986f, -0.62063396f, 0.16860628f), float4(-1.8150861f, 0.04897142f, -0.13650121f, 0.6923447f), float4(-0.24522802f, 0.16756076f, -0.29653138f, 0.54315615f), float4(-0.3383094f, -0.09143206f, -0.19810113f, -0.1134738f)),
    float4x4(float4(-0.23510076f, -1.7400483f, -0.044223562f, -0.65458816f), float4(-0.084029354f, -0.6522377f, -0.90016484f, -0.59424144f), float4(-0.04406973f, -0.7960449f, -1.5840528f, -0.08827734f), float4(-0.25987446f, 0.3087383f, -0.4780331f, -0.6573033f)),
    float4x4(float4(-0.08015499f, -0.39936393f, 1.3629559f, -0.37176597f), float4(-0.22759356f, -1.3315377f, 0.18867254f, -0.5318347f), float4(-0.15097532f, 1.2751925f, -0.4792509f, -0.37857282f), float4(-0.09856822f, -0.2602111f, 0.5720131f, -0.9299879f)),
    float4x4(float4(-0.04486398f, -0.59881186f, -0.5240643f, -0.3700895f), float4(-0.2382391f, 1.1438818f, 1.2360939f, -0.4784797f), float4(0.25557613f, 0.6308194f, 1.2076434f, -0.8478544f), float4(-0.24613337f, -0.19182238f, -0.8465001f, -0.7537523f)),
    float4x4(float4(-0.27086616f, -0.072597034f, -0.37037045f, -0.37549666f), float4(-0.17241828f, -1.3833554f, 0.5960745f, -0.5021096f), float4(0.15763648f, 0.83743846f, -0.1570565f, -0.7557446f), float4(-0.26487663f, -1.7282526f, 0.8310019f, -0.6603439f)),
    float4x4(float4(-0.29081246f, -0.75460047f, -0.69249296f, -0.20238173f), float4(-2.6696856e-5f, -0.59520125f, 1.2887986f, -0.31240904f), float4(0.24147157f, 3.111748f, -1.065548f, -0.1203352f), float4(-0.27875692f, -0.12105271f, 0.5380451f, -0.3869154f)),
    float4x4(float4(-0.18981592f, -0.047700185f, 0.122525886f, -0.05443517f), float4(-0.03336221f, -0.8052412f, -1.3797023f, -0.2882124f), float4(0.034790445f, -0.3016766f, 0.58789855f, -0.91176236f), float4(-0.07115383f, -3.0485005f, -5.846287f, -0.3046888f)),
    float4x4(float4(-0.085903235f, -0.2586256f, 0.21497017f, -0.5620831f), float4(0.018255897f, -1.2295779f, -0.23635364f, -0.51750237f), float4(-0.08877649f, 0.20822515f, 1.0431595f, -0.6951777f), float4(0.20835596f, -1.0287071f, 0.45939144f, -0.18812001f)),
    float4x4(float4(-0.120406225f, -0.5334465f, 0.19561131f, -0.66369027f), float4(-0.085930414f, 0.33314332f, -0.19959992f, -0.3700111f), float4(0.08092367f, 2.0301802f, 0.17972493f, -0.49729005f), float4(-0.33364984f, -0.062122878f, 1.2094928f, -0.43880606f)),
    float4x4(float4(-0.18795416f, -0.034674607f, 0.8458358f, -0.43933502f), float4(-0.12681018f, -0.81425333f, 2.5717497f, -0.28027612f), float4(-0.23433834f, -0.30295697f, -0.7355802f, -0.48940438f), float4(0.13347512f, -1.8573369f, -0.006868776f, -0.44006586f)),
    float4x4(float4(-0.25717387f, 0.34293306f, -1.1301154f, -0.35305908f), float4(-0.3010236f, -0.5376746f, 0.20885329f, -0.45100686f), float4(-0.056363665f, -0.43494055f, -1.7292337f, -0.6710583f), float4(0.14887822f, -1.04866f, 1.6820546f, -0.24690454f)),
    float4x4(float4(0.15536484f, -1.2452894f, -0.8607866f, -0.70754224f), float4(-0.25914142f, 3.2769861f, 0.53106844f, -0.7936858f), float4(0.093949236f, -0.29309437f, 0.47939345f, -0.7758217f), float4(0.19636369f, 0.3551056f, -1.0386655f, -0.29499307f)),
    float4x4(float4(-0.21965538f, 0.053901132f, 0.9926383f, -0.45382258f), float4(0.17457828f, -1.1652131f, 2.344076f, -0.3432021f), float4(-0.17392375f, -0.7389563f, -0.79546577f, -0.74099785f), float4(-0.301588f, 0.9619273f, -0.46254408f, -0.5560105f)),
    float4x4(float4(0.251553f, -0.5216587f, -6.3016415f, 0.4217427f), float4(-1.1624953f, 0.534006f, -0.80433774f, 0.47297537f), float4(0.83449453f, -1.2127753f, 0.1896605f, 0.22470263f), float4(-0.31886542f, 0.10837265f, -2.1233199f, 0.947551f)),
    float4x4(float4(1.685894f, -0.37805885f, 1.8045504f, 0.15809134f), float4(-0.588289f, -0.6451205f, 0.3887859f, 0.15438226f), float4(1.1356065f, 1.3056532f, 0.49343207f, 1.2027899f), float4(-0.6024027f, -2.3315346f, -3.1174824f, -0.59667253f)),
    float4x4(float4(2.0061622f, 2.9452016f, -2.579163f, 0.47943482f), float4(0.4809253f, 0.3288796f, -1.6146777f, -0.30526364f), float4(-0.21354721f, 0.5308495f, 0.39427456f, 1.1706805f), float4(-0.0057761744f, 0.32200682f, -0.06590179f, 0.88259757f)),
    float4x4(float4(-1.142027f, -0.9734908f, -2.4729595f, 0.34469515f), float4(0.9959104f, 1.7742321f, 1.8809263f, 0.13160788f), float4(0.6979206f, -0.26361027f, 0.6406733f, 0.9040456f), float4(-0.42640212f, 0.79191405f, 3.206314f, -0.24652615f)),
    float4x4(float4(1.1773751f, -0.550523f, 0.2590511f, 0.1821846f), float4(-1.3351789f, 0.16070598f, -0.77684456f, 0.07516518f), float4(0.31788227f, 0.39311412f, -0.30201736f, -0.59018266f), float4(-0.8418918f, 0.81671745f, -6.7748456f, 0.8246774f)),
    float4x4(float4(-0.63381374f, -0.5833588f, -0.29435346f, -0.3081f), float4(-0.49936157f, -2.557888f, 1.2611542f, 0.058782004f), float4(-0.94411665f, 0.46099147f, -0.46499082f, -0.114609726f), float4(9.557659f, 4.4555407f, -15.712968f, 3.9735298f)),
    float4x4(float4(1.0153288f, -0.9269596f, -0.5636849f, 0.7446654f), float4(1.2130457f, 0.94185597f, -3.3360755f, 0.2794923f), float4(0.55907154f, 0.44040453f, -1.6438531f, 0.18776669f), float4(-3.8769932f, 0.9580362f, 4.294532f, -1.0530711f)),
    float4x4(float4(-0.45426607f, 0.10752549f, -1.9939363f, -0.043012742f), float4(-0.95760334f, 0.94234735f, -1.5250925f, -0.29587165f), float4(0.28793916f, -0.22247659f, 2.7722063f, 0.02585846f), float4(0.23697962f, 0.19680756f, 0.002365045f, 0.65682405f)),
    float4x4(float4(0.23513512f, 0.77429867f, -2.359746f, 0.2700161f), float4(0.9827967f, 1.5327572f, -1.8418763f, -0.3865271f), float4(0.9240565f, -1.093527f, -2.0048318f, -0.019661797f), float4(-1.5694324f, -0.9434031f, 1.0255023f, -0.07492355f)),
    float4x4(float4(-2.2820404f, 0.2975524f, -0.4105001f, -0.3284004f), float4(0.12071272f, 0.3823576f, 1.1901107f, 0.8104348f), float4(-0.22143303f, -0.15539984f, -0.27574047f, 0.17495728f), float4(0.9012849f, 0.8722363f, 1.0085522f, -0.25298283f)),
    float4x4(float4(-0.80402136f, -0.8484613f, -1.4971787f, 0.8027125f), float4(0.681508f, -6.7109394f, 1.9751136f, -0.2076436f), float4(1.0443202f, -0.17004362f, -0.43439034f, 1.0167354f), float4(-0.12717013f, 0.27257156f, -0.42760894f, 0.5155995f)),
    float4x4(float4(-0.18455565f, -0.26527405f, 0.5126755f, -0.39715475f), float4(-1.2824184f, 1.594509f, 1.2776839f, 1.7152472f), float4(-0.49002635f, 0.16364951f, -1.7065982f, 0.5215009f), float4(0.6753839f, 0.46148688f, -0.89310867f, -0.037777532f))
};
static const float4 NMT_B2[6] = {
    float4(-0.23644923f, -0.050094504f, -0.1818995f, 0.26284388f),
    float4(-0.0815795f, -0.0986692f, -1.4277145f, -0.1765418f),
    float4(-0.040717017f, -0.29805613f, -1.537921f, 0.4319674f),
    float4(0.4215033f, -0.11394235f, -0.08973199f, 0.30842698f),
    float4(-0.0324418f, 0.352665f, 0.34218708f, -0.47113192f),
    float4(0.13193908f, 0.83529454f, -1.2487999f, 0.54470766f)
};
static const float4 NMT_W3[6] = {
    float4(-0.65773064f, 0.3892501f, 0.59662634f, -0.13816343f),
    float4(0.09547661f, 0.19400848f, -2.600543f, 0.0070694895f),
    float4(0.22779559f, 0.16346064f, 0.30702785f, 0.26242688f),
    float4(0.34193793f, 0.048626088f, 0.34960824f, -0.21229176f),
    float4(0.38000742f, 0.26148182f, 0.20948559f, 0.40972248f),
    float4(-0.32724535f, -0.35601166f, 0.13613808f, -0.35477844f)
};
static const float NMT_B3 = -0.92229646f;

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
// Slots of a pixel, empty ones at the end among them, a multiple of four.
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
StructuredBuffer<uint4> core : register(t2);

struct Varying {
    float4 position : SV_Position;
    float v : DEPTH;
    float4 color : COLOR;
};

float4 pass2(Varying input) : SV_Target {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uint2 steps = nmt_core_steps(input.v, nmt_core_absorbance_of(input.color.a), codes);
    uint2 pixel = uint2(input.position.xy);
    uint first = 2u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
    float4 sums0 = sums0_texture.Load(at);
    float4 sums1 = sums1_texture.Load(at);
    float4 moments = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, core[first], core[first + 1u], sums1.y, sums0.x, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
