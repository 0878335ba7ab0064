// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as pairs.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 2, epochs 1500, dataset 01b6983dc69ed68b847bc6fa4ad020706782ce5990d348cf55044a5188b5ba4f.
// Measured on fresh pixels of the training distribution: mean squared error of T 2.202e-3, worst 1.000.

static const float4x4 NMT_W1[24] = {
    float4x4(float4(-6.644906f, -6.8369474f, 4.1170993f, 2.9288063f), float4(0.24427499f, -0.09179742f, -0.18109056f, 0.39672866f), float4(0.09456859f, -0.0558132f, -0.004021847f, -0.251864f), float4(2.366806f, -0.011803482f, -0.1023652f, 45.75337f)),
    float4x4(float4(-1.4355919f, 0.14289287f, -0.23304649f, -73.084694f), float4(-0.88735557f, 0.58894396f, -2.9240642f, -2.084273f), float4(0.70983315f, -1.0194519f, -2.769523f, 4.739505f), float4(0.39219984f, 0.013014964f, 5.017334f, -1.925962f)),
    float4x4(float4(0.7737863f, 0.020955756f, -1.8071773f, -0.69392633f), float4(-6.5454655f, -5.757807f, 3.6420445f, 3.7493362f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-7.274952f, -1.2582943f, 0.750487f, -4.7914953f), float4(-0.03187928f, -0.18776524f, -0.10574456f, -0.10121069f), float4(0.02594284f, 0.0060951775f, 0.12402804f, -0.14500959f), float4(8.788641f, 12.080313f, -23.444958f, 7.274002f)),
    float4x4(float4(-20.707815f, -23.360075f, -6.007787f, -1.3619602f), float4(-0.2932839f, 8.935144f, -8.427754f, 1.7369972f), float4(3.0867727f, -12.55485f, -5.0971174f, -29.500847f), float4(-0.6835189f, -8.825866f, 9.538471f, 0.022721268f)),
    float4x4(float4(-0.25592273f, 0.15926334f, 7.352642f, -0.32446146f), float4(-7.146026f, 1.3202263f, -0.6231722f, 1.0852268f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.2347827f, -1.5456473f, -3.0691724f, -2.5347395f), float4(0.08673811f, 0.046493262f, -0.5524588f, -0.030162303f), float4(0.22072567f, 0.23512895f, 0.27654696f, -0.0552715f), float4(-8.506384f, -5.3671f, -2.738622f, -0.768126f)),
    float4x4(float4(5.099379f, 3.4453056f, 1.6650816f, 10.453707f), float4(-3.5380375f, 6.0613985f, 2.3064294f, 3.2792985f), float4(-3.6804945f, 2.2989976f, -16.632036f, -0.9256119f), float4(9.719984f, -5.940651f, 0.346839f, -0.87034315f)),
    float4x4(float4(4.873015f, -8.553477f, 0.44932845f, -6.306754f), float4(-5.170214f, -0.41068712f, 1.5794455f, -0.12941931f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.82907254f, 2.055103f, -3.9308155f, -1.8275987f), float4(0.24345244f, 0.49341047f, 0.6545849f, -0.022919524f), float4(-0.12706393f, -0.35977432f, -0.5561126f, 0.17710388f), float4(20.038559f, 10.374188f, 4.932662f, -9.194126f)),
    float4x4(float4(-9.926305f, 1.2870265f, -0.85073864f, 0.28929147f), float4(2.8270183f, -0.9751517f, 2.8089926f, -1.0786438f), float4(0.1419767f, -0.02160598f, -3.3599737f, 4.795184f), float4(4.8569894f, 1.4082379f, 1.8042303f, 2.2699566f)),
    float4x4(float4(-2.1796367f, 1.5583503f, -0.387307f, -12.48738f), float4(-5.879166f, 1.8285091f, -0.10583214f, 1.4132012f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-2.1612747f, -3.3155434f, 5.7242703f, -6.0707493f), float4(-0.19226082f, 0.15382223f, -0.34234348f, -0.006578651f), float4(0.19576819f, -0.38018504f, 0.084700346f, -0.0009343119f), float4(2.5350783f, 8.021561f, 0.92302895f, -19.162228f)),
    float4x4(float4(5.2881513f, -7.946638f, -3.55236f, 0.024127962f), float4(5.5462565f, 2.638155f, -4.987424f, -0.041671384f), float4(1.106101f, -10.608368f, -2.8620849f, 0.11833197f), float4(-1.678799f, 0.40029234f, -2.4656491f, 0.03180234f)),
    float4x4(float4(0.011229959f, 0.30013785f, -1.7312031f, 0.00095800485f), float4(-3.161044f, 2.34481f, 5.5600524f, -6.074554f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.83962137f, 2.2565045f, 0.3291371f, 1.5309821f), float4(-0.46886164f, 0.04599322f, 0.17105673f, -0.94829005f), float4(1.280081f, -0.02836603f, 0.13397053f, 0.42108443f), float4(8.010298f, 12.996346f, -0.9753846f, -10.440201f)),
    float4x4(float4(-6.3218236f, -14.843192f, 0.21337391f, -4.3733397f), float4(-2.7684438f, -4.504969f, 2.6891792f, -2.67894f), float4(1.9443177f, -6.2891393f, 4.648647f, 1.6464616f), float4(0.56212527f, 3.0974865f, -8.001758f, 0.33785355f)),
    float4x4(float4(-0.55173165f, 11.879521f, 2.8588138f, 6.7998548f), float4(-3.9557676f, -0.8232811f, -4.226862f, -1.1620078f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.09421036f, 3.3446453f, 5.9199386f, -2.0354898f), float4(-0.32518014f, 0.11868493f, -0.0003276461f, -0.86161435f), float4(0.23984146f, 0.013836953f, 0.16386716f, 0.6702215f), float4(21.249325f, 2.2917397f, -54.71574f, -13.427977f)),
    float4x4(float4(-30.97261f, 0.216219f, 2.2226324f, -8.0110235f), float4(-1.3988694f, 2.413615f, -0.9885946f, -2.2326064f), float4(1.216775f, 3.12481f, -1.014333f, -0.5798262f), float4(0.9931289f, -4.5937138f, -0.06466371f, 1.4991573f)),
    float4x4(float4(-0.44282106f, -5.0399785f, 0.90951955f, 1.2706821f), float4(2.2369783f, 3.8954997f, 3.736989f, -0.8606754f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.8110742f, 2.519742f, -2.8404272f, -2.533226f), float4(-0.16292943f, -0.15577753f, 0.0023999377f, 0.1807285f), float4(-0.10005566f, 0.20275813f, -0.026740337f, -0.10489468f), float4(-109.459465f, 0.28144076f, -2.1053116f, 22.064835f)),
    float4x4(float4(-18.75007f, 5.0484786f, -0.8004698f, -17.53146f), float4(-0.7771674f, 2.6927354f, 4.2178493f, 6.849358f), float4(2.1881056f, 2.6948338f, -5.263059f, -4.4680424f), float4(-0.62796694f, 0.9298859f, -5.847802f, -7.7678084f)),
    float4x4(float4(2.4307024f, 4.0429654f, 1.3701764f, 0.049088877f), float4(2.5936298f, -4.2656145f, 0.21204378f, -0.5714553f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(-2.255839f, 0.38752246f, 1.0548706f, 0.29508346f), float4(3.5021229f, -5.5486403f, 3.919978f, 7.1393404f), float4(0.7005687f, -0.65590554f, -0.5999031f, 0.3372998f), float4(0.55797297f, -3.5278974f, -0.9375819f, -1.3799571f)),
    float4x4(float4(-0.822207f, 9.646074f, 2.7334387f, -2.0096188f), float4(-0.34243435f, 0.38596803f, -1.3136973f, -4.985529f), float4(-0.27410707f, -3.056068f, 0.50217193f, 0.96197915f), float4(-1.5862749f, -1.5913026f, -0.78255177f, 1.6379662f)),
    float4x4(float4(0.37614006f, 0.62856156f, 1.2053005f, -0.115299f), float4(0.4000405f, -2.2793074f, 0.703724f, 1.3842056f), float4(0.046837762f, 2.1889262f, 1.6758739f, 0.5046616f), float4(-1.2901784f, 0.6479536f, -0.18261576f, 0.47293198f)),
    float4x4(float4(2.4513392f, -3.2317476f, -0.2937333f, -0.87541187f), float4(-1.8018963f, -0.08537033f, -0.20679249f, 0.17125203f), float4(0.37318125f, 0.7007333f, 1.0497698f, -0.45693758f), float4(-0.07528782f, -1.2427787f, -0.3740497f, -1.6162221f)),
    float4x4(float4(-0.0056854156f, -0.46216673f, 0.37168384f, 2.5266922f), float4(0.42355457f, 0.56246275f, 1.8464576f, 0.30171275f), float4(-1.2142218f, -0.93152916f, 0.09710974f, -0.1281254f), float4(-35.785778f, -10.926431f, 17.699657f, -37.416485f)),
    float4x4(float4(0.0455293f, 0.4253418f, 1.3075101f, -0.33589628f), float4(0.37694284f, -0.46193188f, -0.16009994f, -1.2368256f), float4(-0.7424769f, -0.91597766f, 1.3993851f, 0.8158363f), float4(0.6780773f, -0.98902965f, -0.23915097f, -0.84954214f)),
    float4x4(float4(0.4356865f, -3.6098413f, 1.1518133f, 1.6138109f), float4(0.018964194f, -1.5095415f, -0.03347981f, -1.7394528f), float4(0.34304652f, 0.37768713f, 0.37472695f, 0.55225396f), float4(-0.16768894f, 1.2062308f, 1.1071843f, -1.0196143f)),
    float4x4(float4(-0.9044732f, -1.5783812f, 0.044219047f, 1.1296388f), float4(0.723707f, 0.8417245f, 0.18935676f, 0.49409577f), float4(0.87967724f, -0.9325288f, -0.34372085f, 1.7053646f), float4(0.42819053f, -0.4067075f, 0.06962549f, -2.9700143f)),
    float4x4(float4(2.5356777f, -0.43621665f, 7.423511f, 0.71164465f), float4(-2.5701082f, -0.6688071f, 10.531412f, -0.6108748f), float4(-0.39176378f, -1.192722f, 0.9267386f, -0.5292072f), float4(-2.8794026f, 0.21899784f, 0.5366228f, 0.048845787f)),
    float4x4(float4(-0.8919236f, -0.72751194f, -1.7338217f, -1.5668687f), float4(0.96019304f, -0.34058416f, -2.638105f, -4.055744f), float4(0.8843582f, -0.9128858f, 0.117157556f, 1.4530233f), float4(-0.708193f, -0.66400707f, 0.14623506f, -0.4712691f)),
    float4x4(float4(-0.7783678f, -0.31102005f, 0.44752443f, -2.3856215f), float4(0.2624257f, -1.0766104f, -0.8439249f, -0.74432045f), float4(-0.22061767f, -0.43857747f, -0.7492733f, 0.49457687f), float4(-0.58638155f, -0.2999724f, -0.0067094145f, 1.5273387f)),
    float4x4(float4(3.4200375f, -0.25266263f, -3.1257107f, -1.217456f), float4(-0.69696784f, -0.6843623f, -0.8573749f, -0.56962454f), float4(0.01716081f, -0.9216826f, -1.5785106f, -0.010490018f), float4(0.28287438f, -0.4286377f, 0.51161504f, -0.95480466f)),
    float4x4(float4(0.58851045f, -1.0371984f, 0.7001552f, 0.806398f), float4(0.016595919f, -0.7279884f, 0.18224803f, 1.1515921f), float4(0.3760666f, -0.5972783f, -0.2621969f, 0.5113156f), float4(10.545665f, -0.37558118f, 4.6311793f, 10.488333f)),
    float4x4(float4(-0.20850836f, -0.39854836f, -0.3709685f, 0.3344729f), float4(-4.7711983f, -0.6631636f, -0.28696483f, -0.2530558f), float4(-0.19809644f, -0.8487018f, -0.98007166f, -0.63437307f), float4(-0.25123456f, 0.096610285f, -0.4769591f, -1.1468279f)),
    float4x4(float4(-0.60058844f, -0.63592666f, -0.6052252f, 2.147502f), float4(-0.03999185f, -1.2613406f, 0.09392666f, -0.0019396583f), float4(0.5476339f, -0.51548564f, 0.052660856f, -0.6011902f), float4(-0.009928996f, -0.3182906f, -0.99936664f, -0.2935119f)),
    float4x4(float4(2.6636226f, -0.8832171f, 0.20496556f, -0.04191312f), float4(-1.2509433f, -0.55184084f, -2.144729f, 0.30126184f), float4(0.6532062f, -1.1347219f, 0.053510785f, -0.91702574f), float4(-1.381274f, -0.8147487f, 0.33820778f, -4.516578f)),
    float4x4(float4(-2.3944836f, -1.5599631f, -1.5443133f, 7.2195654f), float4(-3.189623f, -1.1757643f, -3.0395696f, -3.0470943f), float4(-0.74049497f, -1.7795825f, -3.3150501f, 1.0655732f), float4(0.23391353f, -1.9687781f, -5.3815885f, 0.301576f)),
    float4x4(float4(0.6127581f, 0.7189719f, 0.4580838f, -1.6256864f), float4(-1.2738101f, 0.50001895f, 1.1716812f, 1.8961793f), float4(1.3969544f, -1.026486f, 4.5668006f, -0.4924125f), float4(-1.281743f, 0.74455583f, 1.8456057f, 1.333482f)),
    float4x4(float4(1.6401439f, -0.123683035f, -3.8032908f, -3.1102664f), float4(0.2741913f, -1.0241107f, 1.404279f, 1.5889775f), float4(0.1882553f, -2.4512374f, -1.2712853f, -2.092814f), float4(-0.6549388f, 0.5310589f, -3.4538968f, -0.24010293f)),
    float4x4(float4(-1.179344f, 2.261319f, 0.08677091f, 2.3124037f), float4(2.2208896f, -1.7276238f, 3.0533953f, 0.21290262f), float4(-0.22286461f, 0.37983313f, -0.8543179f, -0.26173314f), float4(1.4492773f, -0.83511055f, -9.288777f, -0.39975622f)),
    float4x4(float4(-0.35471365f, -1.4553583f, -2.13006f, -0.4722494f), float4(0.22448993f, 1.6314536f, -1.176599f, -1.0119965f), float4(0.29016638f, 2.3146746f, 1.6903033f, 2.050139f), float4(-47.534008f, 13.450688f, 45.055683f, 36.8565f)),
    float4x4(float4(-0.22244097f, 0.73429656f, 0.9862094f, -0.12936336f), float4(-0.1992381f, 1.0202835f, -8.927242f, -0.1334078f), float4(1.5236185f, 1.6330041f, -2.4532542f, -4.456027f), float4(1.0353031f, -0.54515195f, -0.85325897f, -0.043900564f)),
    float4x4(float4(0.0486813f, -0.781592f, 0.8640903f, 0.4591338f), float4(0.43045935f, 0.5000094f, -4.739644f, -1.660293f), float4(-0.16277091f, -0.22619689f, 4.470063f, -0.448047f), float4(0.44084775f, 1.7280015f, -0.500346f, -1.6410081f)),
    float4x4(float4(0.16035058f, 0.75065976f, 4.032844f, 0.45246646f), float4(-0.89536476f, -1.2162967f, -4.4385104f, 0.46120143f), float4(-0.80455375f, -2.5115435f, -0.41027853f, -0.2586623f), float4(0.029636882f, 0.63010544f, 2.973935f, -0.05043506f)),
    float4x4(float4(-1.7194197f, 4.824015f, -0.5266476f, -0.78833747f), float4(-1.471812f, 9.310035f, -0.36150956f, 4.5210505f), float4(-7.3974433f, -0.44423026f, -0.52594626f, -0.46529654f), float4(-2.518356f, 0.05439636f, 0.1194184f, -5.167155f)),
    float4x4(float4(1.1304877f, -0.43544415f, 0.05339168f, -1.1652164f), float4(-0.10885799f, 0.41674054f, -0.0952923f, -1.2645881f), float4(-1.6490318f, -0.18742283f, -0.38375202f, -0.97365975f), float4(-2.0202f, -0.071377896f, 0.07519452f, 3.0742452f)),
    float4x4(float4(1.6776807f, -0.008116794f, 0.024402482f, 0.03255095f), float4(-0.54861903f, -0.18131344f, -0.4416248f, 0.8281913f), float4(0.8584243f, -0.8858986f, -0.3033022f, -1.0664535f), float4(1.1155258f, 0.7076073f, -0.24093512f, -1.1810366f)),
    float4x4(float4(0.38029328f, -0.2386654f, -0.35356867f, 3.3918595f), float4(-0.21296081f, -0.23470572f, 0.042254288f, 0.13682778f), float4(0.66403234f, -0.28447255f, -0.1571084f, -1.7468112f), float4(2.418734f, 0.1238797f, -0.3289564f, -5.60176f)),
    float4x4(float4(-0.07753089f, -0.48136306f, -0.1604197f, -1.1021476f), float4(-0.26256388f, -0.32693323f, -0.31468716f, 0.55450964f), float4(-41.1247f, -0.032185316f, -0.075553805f, 0.5439732f), float4(-18.707817f, 48.940483f, 0.22923301f, 58.23926f)),
    float4x4(float4(-0.9359581f, 0.0538587f, 0.108696185f, 0.19324653f), float4(-4.07145f, -0.09797463f, -0.011038951f, -14.01719f), float4(0.7007382f, -0.5162815f, -0.56258255f, -0.66931564f), float4(-0.37976232f, -0.32823804f, -0.4771057f, -0.29178965f)),
    float4x4(float4(-1.1176615f, 0.26750723f, 0.04743282f, 3.1740904f), float4(-6.9861116f, 0.13787462f, -0.30856836f, -1.2273467f), float4(-0.8925413f, -0.25709334f, -0.29693884f, 2.0135877f), float4(0.005031425f, 0.06407095f, -0.38787746f, -0.32969463f)),
    float4x4(float4(-0.16123626f, -0.12301454f, -0.4572737f, 2.7402086f), float4(1.9703797f, 0.14687034f, -0.21890731f, -0.97876066f), float4(0.6571604f, 1.3451152f, -0.12175569f, 1.41641f), float4(0.04929141f, -0.58692384f, -0.52177536f, -0.42594108f))
};
static const float4 NMT_B2[4] = {
    float4(3.510157f, 1.7952743f, 1.1987314f, 0.26025793f),
    float4(2.3944774f, -0.85182935f, -3.3829448f, 2.091531f),
    float4(-1.6684406f, 3.4333026f, -2.3400319f, -2.8371181f),
    float4(-3.3407154f, -10.006952f, -0.18896143f, -0.0427072f)
};
static const float4 NMT_W3[4] = {
    float4(-0.1269171f, 0.11457737f, -0.18309915f, 0.13220085f),
    float4(-0.16864425f, 0.3531046f, -0.14550374f, 0.10706206f),
    float4(0.14921415f, 0.07990781f, 0.1836161f, 0.15159988f),
    float4(0.14897928f, -0.7261686f, 0.38606063f, -0.14916353f)
};
static const float NMT_B3 = -2.3116946f;

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

// Where the moments of the tail leave what the fragment adds to the image open by no more than this, T is the middle of
// what they allow, and the network is not asked. 0 always asks it; 1/512 cannot be seen.
static const float NMT_OPEN = 0.0;

// Least and greatest share of the tail that may lie in front of x, from its moments, and by how much more they err than
// these: Markov's bounds.
float3 nmt_core_bounds(float x, float m1, float m2, float m3, float m4) {
    float mean = m1 * 0.9999;
    float second = m2 * 0.9999 + 3.3333334e-5;
    float third = m3 * 0.9999;
    float fourth = m4 * 0.9999 + 2e-5;
    float square = mean * mean;
    float variance = max(second - square, 1e-7);
    float per_deviation = 1.0 / sqrt(variance);
    float per_variance = per_deviation * per_deviation;
    float skewness = clamp((third - mean * (3.0 * second - 2.0 * square)) * per_variance * per_deviation, -30.0, 30.0);
    float d = clamp((fourth - mean * (4.0 * third - mean * (6.0 * second - 3.0 * square))) * per_variance
        * per_variance - skewness * skewness - 1.0, 0.001, 10000.0);
    float y = (x - mean) * per_deviation;
    float per_d = 1.0 / d;
    float q = (y * (y - skewness) - 1.0) * per_d;
    float at = 1.0 / (1.0 + y * y + q * q * d);
    float rest = 1.0 - at;
    float linear_ = y - q * skewness;
    float per_root = 1.0 / sqrt(max(linear_ * linear_ - 4.0 * q * (1.0 - q), 1e-12));
    float between = clamp(0.5 * rest * (1.0 + linear_ * per_root) - at * y * q * per_root, 0.0, rest);
    float lower = (q < 0.0 ? between : (y > 0.5 * skewness ? rest : 0.0));
    float inner = max(1.0 - second, 1e-6);
    float per_inner = 1.0 / inner;
    float inner_mean = (mean - third) * per_inner;
    float inner_second = (second - fourth) * per_inner;
    float width = max(inner_second - inner_mean * inner_mean, 1e-7);
    float place = inner_mean - x;
    float of_inner = width / (width + place * place);
    float ended = inner * of_inner / max(1.0 - x * x, 1e-6);
    float side = (place < 0.0 ? -1.0 : 1.0);
    float of_fourth = inner * (1.0 - of_inner) * abs(place) / max(abs(place) + inner_second - x * inner_mean, 1e-6);
    float at_end = clamp(0.5 * (1.0 - side * mean - ended * (1.0 - side * x) - of_fourth), 0.0, max(1.0 - ended, 0.0));
    float least = (ended < at ? (place < 0.0 ? 1.0 - ended - at_end : at_end) : lower);
    float most = (ended < at ? ended : at);
    return float3(least, least + most, per_variance * per_variance * per_d);
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
    float3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_6 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_6 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
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
    uint first = 3u * (pixel.y * width + pixel.x);
    int3 at = int3(pixel, 0);
    float4 sums0 = sums0_texture.Load(at);
    float4 sums1 = sums1_texture.Load(at);
    float4 moments = float4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, uint4(core[first], core[first + 1u]), uint4(core[first + 2u], 0u, 0u), sums1.y, sums0.x, moments);
    float weight = input.color.a * T;
    return float4(weight * input.color.rgb, weight);
}
