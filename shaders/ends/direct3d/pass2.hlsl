// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1.
//
// Neural moment transparency: network 'ends', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit a848199e5c6e, backend fused, seed 1, epochs 1500, dataset 8eea3df1bcd36b439cc33c166ec5bf3acdf40f132555cd6c0c5c70ae502afbb9.
// Measured on fresh pixels of the training distribution: mean squared error of T 3.010e-3, worst 1.000.

static const float4x4 NMT_W1[24] = {
    float4x4(float4(0.0128673f, 3.7605476f, 4.967981f, -9.073497f), float4(0.061486423f, 0.26695788f, -0.05592443f, -0.0004770445f), float4(0.120595664f, -0.020408515f, 0.32599422f, -0.0014622799f), float4(-6.8605456f, 12.684051f, -45.805843f, 0.60604024f)),
    float4x4(float4(8.029831f, -4.185539f, -0.6309454f, -0.070048265f), float4(0.37674192f, -2.6459327f, -7.1975346f, -0.079928055f), float4(4.477463f, -3.530796f, -23.34172f, 0.0123483315f), float4(5.9921083f, -1.0951891f, 2.625345f, 0.1018246f)),
    float4x4(float4(0.8995982f, 1.5784115f, -1.9817613f, 0.03263077f), float4(-7.8599067f, 1.3771372f, 2.804348f, -8.989794f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(3.053503f, 3.3163035f, 4.0997186f, -1.8181499f), float4(0.10083877f, -0.15764526f, 0.37501672f, 0.18639907f), float4(-0.1141413f, 0.0141200675f, -0.07648036f, 0.019727733f), float4(-5.816949f, -1.6847119f, -28.352114f, -36.955414f)),
    float4x4(float4(-9.24026f, 0.53857344f, -8.226313f, -0.7732424f), float4(4.926565f, 3.2234447f, -7.1700964f, 2.7766924f), float4(6.0966964f, -5.6362576f, 6.675482f, 3.936297f), float4(3.0072625f, -4.3396215f, 2.4934776f, -5.1654115f)),
    float4x4(float4(0.509092f, 7.4188333f, 3.9676015f, -3.6344948f), float4(-4.987512f, 1.741231f, 1.6843204f, 0.35940275f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-1.1357752f, 3.1969974f, 0.6388284f, 0.35029534f), float4(-0.09240131f, 0.06461878f, 0.073132895f, -0.11267547f), float4(-0.09839589f, 0.011218065f, -0.042015534f, 0.30540684f), float4(-8.129085f, 0.081854336f, -0.5113961f, 7.3107734f)),
    float4x4(float4(-0.5181795f, -0.8867954f, 2.5176802f, -13.771118f), float4(1.4127574f, 0.608775f, 3.4103985f, -6.692415f), float4(-71.603485f, -5.4107456f, 4.0707083f, -2.78479f), float4(1.4849635f, -2.0275028f, -4.486f, 9.590367f)),
    float4x4(float4(4.8973527f, 9.712532f, -0.7723977f, 1.0119555f), float4(2.0110922f, -1.6190807f, -1.6753997f, -1.7989482f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(0.0951456f, -6.380943f, -8.963903f, -4.4872713f), float4(-0.14963645f, -3.6276865f, 0.04144575f, -0.19638653f), float4(-0.027325645f, 0.85273635f, 0.033327766f, 0.17155321f), float4(-10.517675f, 2.8791196f, -0.9624652f, 2.4270668f)),
    float4x4(float4(0.51770294f, 1.1915114f, -0.38210407f, -2.2753205f), float4(-3.8812947f, 4.5123944f, -0.21275786f, 4.471844f), float4(7.3276258f, -16.216568f, 0.044620886f, -1.4459828f), float4(4.7779346f, 0.8548577f, 0.105853535f, -0.07487261f)),
    float4x4(float4(-7.9724526f, 0.11366252f, 0.09251511f, 0.004421727f), float4(2.2588694f, -1.3475512f, -8.667636f, 0.02357316f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-7.7796874f, 4.4515243f, 1.6453724f, -3.3046415f), float4(-0.04655458f, 0.16389099f, -5.623225f, -0.076588124f), float4(0.21422838f, -0.12146205f, 2.2912526f, 0.32628185f), float4(6.5471015f, -2.6268616f, -113.76781f, 10.478893f)),
    float4x4(float4(-6.703381f, -0.3940546f, -4.6124873f, -1.3663454f), float4(-0.89949095f, -1.9441097f, -0.861114f, 5.675592f), float4(1.8441706f, 6.249376f, -0.32739648f, 2.790953f), float4(0.02780533f, 2.396314f, -1.823028f, -3.0873811f)),
    float4x4(float4(-0.1285339f, -11.436484f, 0.09829164f, -1.9000167f), float4(-6.62964f, 2.176947f, -1.449254f, -9.000235f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-3.2223232f, -2.81537f, 0.0381704f, -3.2866175f), float4(-0.16036503f, -0.03564522f, -0.24743807f, -0.8521144f), float4(0.14361398f, 0.030019017f, -0.033454824f, -0.13318846f), float4(-44.266136f, 10.5454035f, -18.27825f, -13.014755f)),
    float4x4(float4(-1.2652023f, -22.45449f, -17.602373f, -3.5409336f), float4(-4.3827944f, 7.3610187f, -2.5863278f, -6.470938f), float4(-4.727587f, -9.427833f, -1.1336447f, 3.4583826f), float4(7.215683f, -7.0260696f, 0.88531023f, 6.1348376f)),
    float4x4(float4(7.6807275f, -0.20966919f, 5.361553f, 3.4800436f), float4(-5.0711794f, 0.6257986f, 2.3135483f, -4.0624876f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-4.2517843f, 2.5558038f, 1.4504354f, 2.9237134f), float4(0.47126552f, 0.11527032f, -0.19839449f, 0.017221425f), float4(0.011528634f, 0.025176136f, -0.098738f, -0.036812574f), float4(12.1783905f, -2.5591013f, 0.9118894f, -17.348635f)),
    float4x4(float4(-4.982472f, 0.18365996f, -3.9290173f, -26.445133f), float4(4.2715745f, -1.9652382f, -9.8959055f, -9.160783f), float4(-9.488131f, 6.308886f, -1.8252605f, 0.3943453f), float4(-0.54524404f, 1.9699956f, 5.9329176f, 7.882178f)),
    float4x4(float4(2.2935746f, -9.116118f, -2.6141613f, 8.270921f), float4(-1.7027036f, 3.6375575f, 2.4187453f, 0.96318907f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.22702889f, 2.741514f, -0.64847213f, -1.7944295f), float4(-0.025018906f, 0.12644266f, -0.01564159f, 0.17683391f), float4(0.14392114f, -0.043477118f, -0.034341548f, 0.045816883f), float4(-2.848468f, 10.602803f, 10.040098f, 1.6311252f)),
    float4x4(float4(-0.65445346f, -5.9683332f, 8.818165f, 8.11726f), float4(-2.6961257f, 1.6168381f, 2.6546414f, 0.826791f), float4(-9.831338f, -0.049179975f, -2.1002567f, 3.793261f), float4(6.0304127f, 3.5396833f, 0.546225f, 0.2872772f)),
    float4x4(float4(-0.26623872f, -149.94072f, 2.0308735f, -2.9207644f), float4(2.1908734f, -1.4523337f, -1.4518526f, -5.471224f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(0.9736768f, -0.29141343f, 2.165374f, -5.9616947f), float4(0.32695f, 1.7460566f, -0.73695904f, -2.8565822f), float4(0.53050196f, 0.02215783f, 0.94649047f, -0.03258612f), float4(7.30803f, -20.037624f, -0.4016418f, 36.93685f)),
    float4x4(float4(1.1549286f, -2.1335447f, -1.5475959f, -2.0792816f), float4(0.7644667f, 2.2598095f, -0.85532826f, 1.0806948f), float4(-0.06527169f, 3.0018117f, -1.1480756f, -1.2850962f), float4(-0.2507964f, -1.1964153f, 0.37514597f, 1.1753136f)),
    float4x4(float4(-0.8472616f, -0.7043746f, -2.276852f, -4.691008f), float4(-0.4555601f, -1.6629165f, -1.4509339f, -8.189336f), float4(-0.3334633f, 0.94757324f, -0.55492085f, -0.9525936f), float4(0.1735622f, -0.025619686f, -6.0581923f, 2.1031337f)),
    float4x4(float4(0.4554539f, 0.04216364f, 0.8397753f, -1.2650865f), float4(0.38927913f, -1.5407665f, 1.013042f, -0.02641012f), float4(5.774787f, -1.6544327f, -4.6677165f, 7.3341303f), float4(0.66671425f, 1.7772616f, -0.3515065f, -0.9281742f)),
    float4x4(float4(1.9784381f, 0.15601097f, 0.6946781f, -0.37603793f), float4(-1.2871833f, 1.8456504f, -15.282526f, -1.846713f), float4(0.5392468f, 0.40055114f, -0.49634168f, 0.30052704f), float4(-0.042860143f, -2.7806468f, -12.598277f, 0.71105194f)),
    float4x4(float4(0.059144653f, 0.6933273f, 0.07266263f, -2.4127839f), float4(2.147373f, -0.4122814f, -0.73740923f, -0.77285784f), float4(1.4421121f, 0.44261938f, -0.43316194f, 2.195324f), float4(0.018330483f, 0.3287679f, -0.7590122f, 0.52264804f)),
    float4x4(float4(1.5273659f, 0.23432893f, -0.11794407f, 0.19162464f), float4(0.5608629f, -1.3380905f, -1.6920519f, 0.7178977f), float4(-0.91993153f, 2.7752552f, 0.24850309f, -0.72549605f), float4(-0.95868415f, -3.0614154f, 2.69588f, -1.8136024f)),
    float4x4(float4(1.0603478f, -0.4530526f, 1.9572685f, -0.765034f), float4(-0.17213117f, 3.729339f, -10.964154f, 4.6471605f), float4(-0.78516996f, -2.6175964f, 0.4640726f, -0.6211325f), float4(0.8244115f, 1.2729508f, -0.29074246f, 0.67575365f)),
    float4x4(float4(-21.03128f, -0.26334956f, -0.21224876f, -1.7206993f), float4(-1.253194f, 2.0803108f, -0.39351013f, -1.5414695f), float4(0.36283782f, 0.5835208f, -0.19863863f, 1.0937574f), float4(8.479179f, -15.568178f, -0.6278676f, 33.372063f)),
    float4x4(float4(0.033372823f, -0.5917856f, -0.29407036f, -0.6036532f), float4(-0.5680851f, -0.8011245f, -0.43400952f, 0.63234293f), float4(0.26169628f, 1.7879655f, 0.22113287f, 0.44972688f), float4(-0.22556847f, -4.2311754f, -0.37518364f, 0.15974058f)),
    float4x4(float4(-8.812771f, -1.9551792f, -0.23230843f, -2.2471507f), float4(-3.787506f, 0.95212144f, 0.16235405f, -0.52156943f), float4(-0.4480017f, -0.11265831f, -0.23024982f, -0.58245707f), float4(-9.83514f, 0.81435573f, -0.32746187f, -6.067244f)),
    float4x4(float4(-1.6044284f, -1.187413f, -0.5729973f, -0.6296531f), float4(-0.44902867f, -0.9198901f, -0.6862288f, -0.15399714f), float4(1.7186819f, -0.63127995f, -0.6949159f, -1.7918234f), float4(-1.0648757f, -0.15579815f, -0.67800283f, 0.41674504f)),
    float4x4(float4(0.3903473f, -1.2289082f, -0.53787977f, 0.82405025f), float4(-2.0846198f, -0.21663588f, -0.56657994f, -1.0735714f), float4(0.4248758f, 0.22443669f, -0.65666825f, 0.07997841f), float4(-8.916795f, -0.7094989f, 0.14798479f, -6.97053f)),
    float4x4(float4(3.7009888f, -0.70093614f, -0.6128832f, 2.644844f), float4(0.4247687f, -0.817053f, 0.42068318f, 0.23905064f), float4(1.7035515f, 1.461921f, -0.77451235f, -0.48444858f), float4(-0.615658f, -0.3333953f, -0.2667526f, 0.36767223f)),
    float4x4(float4(-0.18516809f, 0.27482903f, -0.2225964f, -0.6724002f), float4(4.011923f, 0.637334f, -0.67672485f, 0.3016647f), float4(0.6065027f, -0.7883742f, -0.9284632f, 0.5641883f), float4(-3.5589437f, -1.0624614f, 0.096765846f, -2.8511245f)),
    float4x4(float4(-0.6089275f, 0.090764254f, -1.1523596f, -0.24199161f), float4(-0.7682741f, -1.3162074f, 0.09341756f, 0.93857926f), float4(-1.1931734f, -0.23855007f, -0.72499424f, -1.5712576f), float4(-0.42629656f, -0.26260087f, -0.9542177f, 1.6355244f)),
    float4x4(float4(0.513711f, 0.45026255f, -0.17716119f, 0.1736828f), float4(-1.2653636f, -0.76790434f, 0.14107746f, -0.101236925f), float4(-3.3931994f, -0.9410222f, 1.9234831f, -0.21560587f), float4(13.866378f, -29.905949f, -4.7024813f, -0.05950532f)),
    float4x4(float4(0.59723866f, 1.7412177f, -0.752095f, -0.26280499f), float4(-0.003803875f, -2.1383972f, -3.9911714f, -0.367251f), float4(-0.08324374f, -0.8167838f, -0.59538025f, -0.6327836f), float4(-0.5830487f, 0.28148487f, -0.014125063f, -0.31751835f)),
    float4x4(float4(1.7969197f, 2.0490663f, 1.8168552f, -0.34116894f), float4(-0.6144725f, 2.9157856f, 1.3234017f, -0.32294732f), float4(0.5913104f, 0.18101647f, 0.36276755f, -0.2903578f), float4(-4.3923545f, 1.5272367f, -2.8389628f, -0.31174585f)),
    float4x4(float4(-0.043329127f, 1.7050985f, 3.6233244f, -0.14176968f), float4(-0.09525963f, -2.7151825f, -0.09772584f, -0.07205112f), float4(-9.263754f, -10.313246f, -8.166591f, -0.2591225f), float4(0.320203f, -3.8302138f, -0.30241755f, -0.6026502f)),
    float4x4(float4(0.41639164f, -7.142308f, -0.15356658f, -0.07018159f), float4(-0.47224933f, -2.6364233f, -1.4798231f, -0.4788587f), float4(-11.549793f, 0.5174555f, -0.12486984f, -0.07710395f), float4(-3.8463557f, -5.778302f, -2.6209154f, -0.16565485f)),
    float4x4(float4(1.3733138f, -0.7823414f, -0.34194192f, 0.07787178f), float4(-9.382015f, -7.5211344f, -0.9132306f, 0.092068516f), float4(0.05152f, -0.7322079f, -0.3741282f, -0.2911173f), float4(0.42595804f, 1.9614707f, -1.1739447f, -0.081629924f)),
    float4x4(float4(-0.44047526f, -24.672018f, 0.9065058f, -0.1293647f), float4(0.31847742f, 2.3859189f, -0.69301957f, -0.0344279f), float4(0.79915905f, -0.68671614f, -1.2447516f, -0.6533241f), float4(-1.5470724f, 1.1773903f, 2.1916807f, -0.0036031604f)),
    float4x4(float4(-0.11451272f, -0.6021976f, 0.92095214f, -0.32089463f), float4(-3.5989914f, -9.970194f, -3.6157365f, -0.11802844f), float4(0.98625535f, 2.7900815f, 0.4079601f, -0.45204443f), float4(1.5801364f, -1.0910925f, -0.6526661f, -0.5535904f)),
    float4x4(float4(-0.28614658f, -2.1724875f, -0.5920867f, -15.148489f), float4(0.112143114f, -1.1335614f, 4.989998f, -8.775643f), float4(1.8512427f, 2.6082566f, 0.75738746f, 3.1869366f), float4(14.841191f, 15.039519f, -1.6337725f, -12.899408f)),
    float4x4(float4(-3.2158957f, 0.10552485f, 1.4139965f, 1.9299747f), float4(1.2013996f, 1.5588788f, 3.3646104f, 0.89145553f), float4(2.2672095f, -0.34486154f, -0.45014113f, -3.075378f), float4(-2.0838945f, 2.0800898f, -4.884502f, -1.8615084f)),
    float4x4(float4(-0.20065495f, 0.27777302f, -0.59739953f, 0.492799f), float4(-1.8899113f, -1.0359483f, -2.5809455f, -4.207474f), float4(-0.11997342f, -2.2042232f, -5.1670423f, -0.82337683f), float4(-2.9167504f, -1.2420093f, 2.304473f, -3.0426073f)),
    float4x4(float4(-0.9256383f, -1.0924605f, -0.43929762f, -4.0171313f), float4(1.0769504f, 0.037780624f, 3.1679304f, 0.5120494f), float4(-16.731611f, -2.2271824f, 18.3933f, -4.5929675f), float4(-0.42094705f, -0.8055554f, -40.733025f, 0.1368361f)),
    float4x4(float4(-16.488438f, -0.3953813f, 1.4915931f, 0.9422313f), float4(0.48689404f, -2.7105336f, 0.37647396f, 1.6256014f), float4(-0.985141f, -0.124065f, 0.52547807f, -0.28835893f), float4(-3.5103607f, -2.6983385f, 3.0643513f, 3.5271595f)),
    float4x4(float4(1.8173051f, 1.553307f, 1.4059104f, -2.6934683f), float4(-10.258167f, 1.2927513f, -16.181759f, 0.30489627f), float4(1.1080258f, 1.2718751f, -1.8642662f, 4.288624f), float4(-1.4439301f, -0.42140698f, -0.7453024f, 7.2049985f)),
    float4x4(float4(-1.5084285f, -0.5501037f, 0.5154039f, -0.5701379f), float4(-1.5225708f, 1.4633889f, 0.22918528f, 1.7084976f), float4(-0.4712859f, -1.9853026f, -0.48694852f, 1.1872562f), float4(-3.7520049f, -0.88765305f, 0.31254068f, -4.251616f)),
    float4x4(float4(0.8542929f, -13.992373f, 0.7051828f, 1.0770032f), float4(0.85787165f, -5.0552893f, -0.31344295f, -2.4815369f), float4(0.5221182f, -0.4009286f, -2.8391845f, -1.6408883f), float4(-0.25800353f, -3.6405084f, 3.5037513f, -1.4389756f))
};
static const float4 NMT_B2[4] = {
    float4(1.3345498f, -8.672864f, 1.3157077f, 0.07269316f),
    float4(-2.2007182f, 3.1122139f, -0.5706032f, 2.51398f),
    float4(-1.9580028f, -27.292315f, -4.916058f, -0.3410543f),
    float4(-2.0799077f, -7.002787f, -13.354039f, -3.1847873f)
};
static const float4 NMT_W3[4] = {
    float4(-0.18279469f, 0.103831336f, 0.11210188f, -0.20403156f),
    float4(0.22301295f, 0.1194242f, 0.19459188f, -0.20728351f),
    float4(0.14650388f, 0.11623583f, 0.13068826f, 0.11467473f),
    float4(0.12574163f, 0.3050175f, 0.099843465f, -0.12184774f)
};
static const float NMT_B3 = -1.6129792f;

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
static const uint NMT_HEAVY = 0u;
// Slots of a pixel, an empty one at the end among them where their number is odd.
static const uint NMT_SLOTS = 2u;
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

// The code of such a number; 0, the empty slot, of what the target is cleared to.
uint nmt_core_end_code(float value) {
    uint low = NMT_END_BITS - 1u;
    uint bits = asuint(max(value, -3.9999998));
    int rank = int(bits & 0x7fffffffu) - 0x00800000;
    uint packed_code = uint((bits > 0x7fffffffu ? -1 - rank : rank) + 0x40000000);
    return ((packed_code >> low) << NMT_END_BITS) | (packed_code & ((1u << low) - 1u));
}

// The slots of a pixel. Where all its fragments share a depth step none is in front of another, and its farthest is
// left to the tail: the code does not say whether it is another fragment than the nearest.
uint2 nmt_core_ends(float2 values) {
    uint nearest = nmt_core_end_code(values.x);
    uint farthest = nmt_core_end_code(values.y);
    bool apart = nmt_core_nearest_steps(nearest).x != nmt_core_farthest_steps(farthest).x;
    return uint2(nearest, apart ? farthest : 0u);
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
float nmt_core_weigh(float z, float absorbance, float4 depths0, float4 absorbances0, float n, float b0, float4
    moments) {
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
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_2 - center * rest0_2) * per_h;
    float moved2 = (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)) * (per_h * per_h);
    float moved3 = (rest3_2 - center * rest2_2 - center * (rest2_2 - center * rest1_2) - center * (rest2_2 - center
        * rest1_2 - center * (rest1_2 - center * rest0_2))) * (per_h * per_h * per_h);
    float moved4 = (rest4_2 - center * rest3_2 - center * (rest3_2 - center * rest2_2) - center * (rest3_2 - center
        * rest2_2 - center * (rest2_2 - center * rest1_2)) - center * (rest3_2 - center * rest2_2 - center * (rest2_2
        - center * rest1_2) - center * (rest2_2 - center * rest1_2 - center * (rest1_2 - center * rest0_2)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_2 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_2 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_2 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_2 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    float3 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
    if (NMT_OPEN > 0.0) {
        float bounds_noise = b0 / max(absorbance_of_tail, 1e-12) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0
            + abs(center)) * per_h + 1.0) * (((1.0 + abs(center)) * per_h + 1.0) * ((1.0 + abs(center)) * per_h + 1.0)))
            * bounds.z * 1.4901161e-8;
        float most = min(exp(-(front_2 + absorbance_of_tail * max(bounds.x - bounds_noise, 0.0))), 1.0);
        float least = min(exp(-(front_2 + absorbance_of_tail * min(bounds.y + bounds_noise, 1.0))), 1.0);
        float opacity = 1.0 - exp(-absorbance);
        if (opacity * (most - least) <= NMT_OPEN) {
            float middle = 0.5 * (most + least);
            return middle;
        }
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_2) * nmt_transmittance(float3x4(float4(x, log2(others) * 0.33333334 - 1.0,
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
    float n,
    float b0,
    float4 moments
) {
    float2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    float2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        float4(slot0.x, slot1.x, 0.0, 0.0),
        float4(slot0.y, slot1.y, 0.0, 0.0),
        n,
        b0,
        moments
    );
}

// Pass 2 in one call: transmittance T in front of a fragment, from what pass 1 left in its pixel. Add up
// (alpha * T * color, alpha * T).
float nmt_pass2(float v, float v0, float v1, float alpha, float4 sums0, float4 sums1, float4 range) {
    NmtCodes codes = nmt_core_codes(v0, v1);
    uint2 steps = nmt_core_steps(v, nmt_core_absorbance_of(alpha), codes);
    uint4 core = uint4(nmt_core_ends(range.xy), 0u, 0u);
    return nmt_core_transmittance(steps, codes, core, sums1.y, sums0.x, float4(sums0.y, sums0.z, sums0.w, sums1.x));
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
