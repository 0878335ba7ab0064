// Direct3D, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// Factors ONE, D3D12_BLEND_OP_ADD; target DXGI_FORMAT_R16G16B16A16_FLOAT or R32G32B32A32_FLOAT, cleared to 0. Textures:
// the targets of pass 1; behind them the buffer of pass 1, as vectors.
//
// Neural moment transparency: network 'core', 9-32-16-1, 816 multiply-adds.
// Provenance: nmt 0.1.0, commit 38d1fbcbf275, backend fused, seed 1, epochs 150, dataset e4b670063e777080a8d4e335c8112fc6ed2f2f51991ae458c750de88c0ee67d6.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

static const float4x4 NMT_W1[24] = {
    float4x4(float4(0.7114112f, 1.794765f, -0.6456376f, 0.84930515f), float4(-0.028981173f, 0.02970049f, 0.329591f, -0.035812013f), float4(-0.012841912f, 0.09650574f, 0.06255524f, 0.041502737f), float4(2.4123957f, 2.9781296f, 3.1630163f, -15.838907f)),
    float4x4(float4(-1.7079562f, -0.7621927f, 1.3614055f, -20.888063f), float4(-1.738914f, 1.0196699f, 0.6202387f, -1.0327412f), float4(-1.6108372f, 1.55356f, 3.7318592f, 0.7500771f), float4(1.7808586f, -4.1291547f, -1.2347131f, -0.080635615f)),
    float4x4(float4(3.9679668f, 0.6957134f, -1.6087618f, 1.9531379f), float4(-0.18651953f, 0.2290573f, -1.6097274f, 0.44473892f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.13436112f, -0.35477012f, -0.99324006f, 0.6968991f), float4(-0.01993656f, -0.19747771f, 0.040589366f, -0.035102323f), float4(0.14162314f, -0.017389048f, 0.06625489f, -0.04209293f), float4(-4.261307f, 0.92345315f, -29.521399f, 3.5638864f)),
    float4x4(float4(-3.4156718f, 3.3481202f, -0.9449227f, -0.20882013f), float4(-1.8078896f, 1.2912533f, -0.13449717f, 2.2615066f), float4(1.2349912f, -1.5557613f, 0.8040417f, -0.32323965f), float4(0.45095217f, 0.501725f, -1.3727416f, -3.8504052f)),
    float4x4(float4(1.5367998f, 0.27913368f, -0.93597645f, -0.7016706f), float4(-0.48996648f, -0.29803982f, 0.15136014f, 1.4305378f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.4699823f, 1.0923232f, -1.1598638f, 1.2263182f), float4(-0.14797291f, 0.026214255f, -0.113542765f, 0.16095562f), float4(0.063653596f, -0.028496107f, -0.014273023f, -0.066561654f), float4(-0.10964669f, -7.8148737f, -2.3802822f, 1.3221512f)),
    float4x4(float4(0.833382f, -5.0199294f, 1.8868679f, 0.2592309f), float4(3.3271794f, -2.7400637f, -0.18183625f, -1.7967983f), float4(-0.33488667f, -0.57395476f, -6.2630186f, -0.566368f), float4(-3.469189f, 2.074026f, 1.8110873f, -1.3759528f)),
    float4x4(float4(-1.7062492f, 2.9541376f, 1.1419351f, -0.46530396f), float4(-2.0482693f, 0.3081567f, -0.1017172f, 0.61162734f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.96986026f, 2.031756f, -1.3089055f, -1.1332997f), float4(0.26061314f, -0.02159665f, 0.1892596f, -0.23133557f), float4(-0.16803175f, -0.0238116f, 0.13244852f, 0.11946321f), float4(1.6070043f, 4.6796885f, 0.5326129f, 1.6828455f)),
    float4x4(float4(-0.24018972f, -0.36707783f, -1.1872584f, -1.8052766f), float4(2.2013566f, -2.5746849f, -0.9833889f, 0.71542686f), float4(0.9339632f, 0.074673206f, 0.3756152f, -1.4103022f), float4(-1.2919157f, 2.7009892f, 0.17862882f, 0.9242325f)),
    float4x4(float4(-0.5461605f, -2.2530963f, 0.028314795f, -0.22744498f), float4(-0.46826938f, 0.19410363f, -1.5857325f, 0.62136894f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.6077851f, 2.13829f, -2.0248055f, -0.9561631f), float4(-0.21585236f, -0.17091903f, 0.0005434734f, 0.085117176f), float4(0.3689412f, 0.042130224f, -0.00078797276f, -0.010276212f), float4(1.7625064f, -3.3381279f, -0.5359629f, -6.5600257f)),
    float4x4(float4(-1.0561279f, -0.39834294f, -0.01582293f, -4.003998f), float4(-1.4282976f, -0.3875128f, -0.017486755f, 1.0817925f), float4(1.6093467f, -0.29775304f, 0.0014686225f, -0.5089773f), float4(1.1229762f, 0.25455555f, 0.023702715f, -1.4840105f)),
    float4x4(float4(-1.0692314f, 0.44872382f, 0.0050543183f, -2.0327947f), float4(-1.2847424f, 1.9871289f, -2.0014124f, 0.5855031f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.25211033f, 0.005119752f, -2.1872346f, -1.1620688f), float4(0.017108291f, -0.041987717f, -0.027050076f, -0.13018315f), float4(-0.05244853f, -0.00975882f, -0.0017314742f, -0.024875414f), float4(-3.3165135f, 3.4593008f, 0.056680337f, -3.8843656f)),
    float4x4(float4(-5.0323253f, -3.7635498f, -0.14022315f, -2.9610775f), float4(0.19241972f, 0.98123837f, -0.020708552f, -0.82796156f), float4(-0.7785813f, -2.6562915f, -0.029912062f, 0.15352848f), float4(-0.23903932f, -1.3826402f, 0.03861026f, 0.78095865f)),
    float4x4(float4(0.051276475f, 2.8420196f, 0.022135658f, 1.7738895f), float4(1.1062568f, -0.03576447f, -1.9842397f, -1.0732489f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.89384013f, 2.1012056f, 1.0233192f, 0.29809642f), float4(-0.09234901f, 0.25171867f, 0.091949716f, 0.027206952f), float4(0.06028613f, -0.09364583f, -0.003017085f, -0.07408811f), float4(-8.21473f, -7.1158323f, -0.29907146f, -13.753689f)),
    float4x4(float4(-0.82880133f, -0.11900272f, 1.0887092f, -1.0829563f), float4(1.5570911f, -2.0484927f, 0.6727108f, 2.8067222f), float4(-1.3930216f, 3.9515226f, 2.191993f, -1.9209694f), float4(-1.5297359f, 1.3419784f, 1.7527841f, -4.159152f)),
    float4x4(float4(-1.3002264f, -0.1587132f, -1.3874993f, -2.2122061f), float4(0.9308778f, -0.01432749f, -0.32084987f, 0.5311433f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(-0.0899152f, -0.46256414f, 0.7049528f, -1.9639246f), float4(0.07281596f, -0.029488033f, 0.08644452f, 0.33723482f), float4(-0.024699729f, 0.039019354f, -0.0020412535f, -0.107665926f), float4(-5.0240855f, 4.4698567f, -0.3773489f, 3.029914f)),
    float4x4(float4(0.4699823f, -12.642521f, 2.0421138f, 0.5925172f), float4(-0.6282306f, 0.7541472f, 0.78359836f, 2.1257553f), float4(1.0577993f, -5.0155177f, 0.5018363f, -3.7114465f), float4(1.4569777f, 0.20955017f, -0.26426747f, -0.516294f)),
    float4x4(float4(-1.849059f, 0.83120733f, 1.6998835f, 0.43989202f), float4(0.29986665f, 0.44387412f, 0.027788686f, -1.4363279f), float4(0.0f, 0.0f, 0.0f, 0.0f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[32] = {
    float4x4(float4(0.7740623f, 1.164834f, -2.068747f, 0.5035737f), float4(-0.43030062f, 0.5031227f, -0.5259753f, -0.3920844f), float4(0.10343112f, -0.9487578f, 0.4521868f, 0.7030511f), float4(0.29194787f, -0.77824557f, 2.0776682f, 0.6425224f)),
    float4x4(float4(0.34115967f, 0.8258437f, -1.1655577f, 0.4527021f), float4(-0.30841342f, -1.5406653f, 0.793599f, -0.4885833f), float4(0.24813442f, -0.06837169f, 0.7312526f, 0.48864943f), float4(-0.06723341f, 0.030995093f, 0.3126809f, 0.34851396f)),
    float4x4(float4(1.1542072f, 0.60191077f, -0.1673615f, 1.5101223f), float4(-0.6295398f, 0.1350956f, -0.15090144f, -0.0045507145f), float4(-0.7594554f, -3.183002f, -0.011628814f, -0.537017f), float4(0.0935774f, 0.28425312f, -0.6353981f, -0.33264762f)),
    float4x4(float4(0.107764795f, 0.6251307f, -0.6540966f, 0.17470424f), float4(0.08688614f, 1.2753782f, 0.002994262f, 0.35474792f), float4(0.80133814f, -1.0117424f, 0.9615147f, 0.7564474f), float4(0.5615409f, -0.60304195f, 0.57057774f, 0.3935742f)),
    float4x4(float4(0.94817245f, 1.3650261f, -0.11474803f, 0.49694648f), float4(0.41581315f, 1.8526163f, -0.76631796f, 0.9206522f), float4(14.029429f, -18.676725f, -7.6060667f, 13.889425f), float4(0.49538067f, 1.4112307f, -0.23383838f, 1.0261047f)),
    float4x4(float4(1.0396186f, 1.1263485f, -0.2977602f, 0.5864095f), float4(-0.022290334f, 1.0802742f, -2.224464f, 0.6896624f), float4(3.2834804f, -4.8464727f, 0.49362117f, 2.981774f), float4(0.6474172f, 0.45798972f, -1.4866697f, 0.41479996f)),
    float4x4(float4(-0.049895614f, -1.7115567f, 0.5712569f, 0.42274615f), float4(-0.57910365f, -0.37556976f, 0.12025096f, -0.5134444f), float4(-0.078454964f, -1.104504f, -0.21341194f, 0.32574376f), float4(-0.60929734f, 0.39671648f, 1.716525f, -0.6434868f)),
    float4x4(float4(0.29538763f, 1.2219275f, -0.3817008f, 0.46568033f), float4(-0.3134722f, -0.82973665f, 0.42114016f, -0.6720282f), float4(0.073724896f, -1.2034802f, -0.19534321f, 0.33451772f), float4(0.081607856f, 0.8409012f, -0.3902697f, 0.5598342f)),
    float4x4(float4(-0.9394346f, 1.2753603f, 0.046467967f, -1.0432429f), float4(0.4232378f, 0.25417325f, -0.22898075f, -0.33732072f), float4(-1.0096414f, 1.3777792f, -0.3391435f, 0.2819673f), float4(-3.310305f, 2.0749035f, -0.3008336f, -1.6021631f)),
    float4x4(float4(1.258784f, 0.19042464f, -0.41340786f, -0.12071069f), float4(-1.519997f, 0.7436436f, -0.3120882f, -0.1729203f), float4(0.483262f, -0.09374421f, 0.23163426f, 0.31795964f), float4(0.4230913f, 0.061426286f, -0.25224203f, -0.22310378f)),
    float4x4(float4(0.93325996f, 1.8971597f, -0.28234145f, -0.025177272f), float4(-7.6522527f, -0.3206657f, 0.14168794f, -1.5123086f), float4(0.15061197f, 0.16521153f, 0.03541052f, -0.9992068f), float4(1.2428966f, -0.08382708f, -0.22232577f, 0.048396748f)),
    float4x4(float4(-0.18973663f, -0.033910725f, 0.13325143f, -0.17352992f), float4(0.4461619f, 0.6364925f, -0.10560766f, -1.9667461f), float4(-0.45408845f, -0.45158005f, -0.3393527f, 0.23955418f), float4(-0.1490831f, -0.27201223f, -0.29839015f, 0.3486842f)),
    float4x4(float4(0.9126985f, -0.32295942f, 0.18586884f, -0.3813523f), float4(-2.2016847f, -0.20238802f, -0.2387893f, 1.108497f), float4(-16.085505f, -11.817784f, 0.33659443f, 18.04033f), float4(2.8204956f, 0.2766079f, 0.13006428f, -0.32751954f)),
    float4x4(float4(-2.3231235f, -0.40893358f, -0.29915f, 0.003795701f), float4(0.26880562f, -1.2932492f, -0.017290879f, 2.6089804f), float4(-0.60153836f, -2.8597462f, -0.41541255f, 2.8458073f), float4(2.1445951f, -0.02217821f, -0.016395334f, 0.34860465f)),
    float4x4(float4(-0.44858697f, -0.18469375f, -0.0487925f, 0.055945862f), float4(1.938247f, -0.9735102f, -0.11066262f, 1.1382389f), float4(1.155708f, 0.61691636f, -0.2702479f, -0.77236706f), float4(-2.4122674f, -0.71479994f, 0.012769671f, -4.688386f)),
    float4x4(float4(-2.96085f, 0.42215174f, -0.38456017f, -0.38776773f), float4(-0.24383856f, -1.6216474f, 0.07149901f, 1.4710059f), float4(0.7342929f, 0.7211161f, -0.22429495f, -1.0781635f), float4(1.1297781f, -1.029324f, -0.16603275f, 0.58354384f)),
    float4x4(float4(-0.05003959f, 0.17409228f, -1.7151766f, 0.10474924f), float4(0.01457923f, -0.14070602f, -2.338239f, 0.16299094f), float4(-0.18373938f, -0.42455322f, -0.13555224f, -0.23536675f), float4(0.19085951f, -10.431905f, 0.1561438f, 0.090965495f)),
    float4x4(float4(-0.29841623f, -5.4967546f, 0.36875647f, -0.25406379f), float4(-0.8486684f, -1.2277318f, -0.6337861f, -0.31054696f), float4(-0.4919306f, -1.1227449f, 1.0165828f, -0.4170905f), float4(-0.33625957f, 1.3663192f, -2.173731f, -0.5335285f)),
    float4x4(float4(-0.02580354f, -0.99563456f, 0.5907119f, -0.25888622f), float4(0.016648367f, -4.541484f, 2.382072f, -0.28103116f), float4(-0.14202255f, 1.1210418f, 0.39246255f, -0.19009183f), float4(-0.607f, -0.4930353f, 1.2736763f, -0.41987988f)),
    float4x4(float4(0.17047478f, -0.9777811f, 0.49490413f, -0.12701556f), float4(-0.053615864f, -0.6757622f, -1.5249232f, -0.028747546f), float4(-0.32371497f, 0.06521764f, 0.7220942f, -0.19597325f), float4(0.08538029f, 0.9865701f, -0.41408128f, -0.26629293f)),
    float4x4(float4(-0.27797985f, 1.245964f, -0.31600127f, 0.24749051f), float4(-0.38834217f, 1.0111324f, 2.1538868f, -0.57203734f), float4(0.052746143f, -4.1187143f, -3.127516f, -0.20474255f), float4(-0.28306407f, 0.76736736f, -0.3911666f, -0.19085774f)),
    float4x4(float4(-0.24509515f, -0.54012036f, 0.6798456f, 0.2861152f), float4(0.0883146f, -1.8435801f, -0.7039397f, 0.07257456f), float4(0.046027165f, 0.50666636f, 0.28459528f, -0.14042337f), float4(-0.35120356f, 0.09453443f, -0.5894016f, -0.06492637f)),
    float4x4(float4(-0.2621763f, -3.170006f, 0.29966676f, 0.25263417f), float4(-0.111120336f, -1.2728657f, -1.5264434f, -0.038851615f), float4(-0.63447267f, -0.42552397f, -1.2964416f, -0.42073154f), float4(-0.32678196f, 1.6176457f, -4.360378f, 0.21671215f)),
    float4x4(float4(-0.0059840316f, -3.8099651f, -0.7975418f, 0.0896058f), float4(-0.4766693f, -6.305596f, -0.9151071f, -0.124717675f), float4(-0.07483728f, 0.4794457f, -0.16928793f, -0.26237386f), float4(-0.09608338f, -5.6179204f, 1.5533636f, -0.25067762f)),
    float4x4(float4(-0.44553274f, -2.4276547f, -0.34491634f, -0.3018809f), float4(-0.52397114f, 0.030779477f, -0.17118035f, 0.78206486f), float4(-0.17858525f, -0.24578506f, -0.35063842f, -0.21416129f), float4(-0.8180598f, -4.199304f, 0.071606964f, -3.011446f)),
    float4x4(float4(0.03209997f, 0.93677473f, -0.19422996f, 0.92966574f), float4(-1.0652505f, -3.58009f, -0.44814247f, -0.70519245f), float4(0.28799462f, 0.571532f, -0.49397644f, 0.67908394f), float4(-1.035229f, 1.0754316f, -0.4090003f, 0.11564912f)),
    float4x4(float4(-0.77254635f, -0.17241158f, -0.022551931f, 1.2262067f), float4(-0.605102f, 0.20001902f, 0.068069376f, -4.080519f), float4(-0.6443346f, 1.9855751f, -0.44039902f, 1.9125082f), float4(0.42612883f, -1.1998643f, -0.8721463f, 0.15239058f)),
    float4x4(float4(-0.29837945f, 0.0068644956f, -0.3898633f, 0.009918437f), float4(0.3782384f, 1.178301f, 0.08229874f, -0.06470791f), float4(0.0774512f, 0.9013115f, -0.65848154f, 0.3284934f), float4(-0.70972896f, -0.14531367f, -0.3254276f, 0.17822915f)),
    float4x4(float4(-0.3608274f, -1.1323757f, 0.016613701f, -0.28131887f), float4(-0.8172055f, 1.9383489f, -0.6498204f, 0.72158223f), float4(0.002547174f, 11.533519f, 0.1844353f, 9.447558f), float4(-0.93364465f, 0.47887138f, -0.20126021f, 0.42655954f)),
    float4x4(float4(-0.5974013f, -0.13806076f, 0.07475581f, 0.012252475f), float4(-0.30127043f, -1.3356161f, 0.25582203f, -1.0638454f), float4(-0.26102355f, 3.1362603f, 0.14241977f, 1.7407504f), float4(-0.28486803f, -0.51141244f, 0.18834773f, 1.5194561f)),
    float4x4(float4(-0.5440513f, 0.17791238f, -0.090685666f, 0.1784574f), float4(-0.21578477f, -0.3776157f, -0.1747485f, -0.025778314f), float4(-0.9090561f, -0.55879486f, -0.07472327f, -0.91794974f), float4(-0.32820567f, -13.047486f, 0.15306818f, -0.93660307f)),
    float4x4(float4(-0.18533035f, -0.50595695f, -0.68981564f, -0.007534794f), float4(-0.5021136f, 1.6381675f, -0.15506433f, -0.19430783f), float4(-0.79204714f, -2.4517088f, -0.54169047f, 0.22938052f), float4(-0.7950926f, -0.721995f, -0.29049164f, 0.20856877f))
};
static const float4 NMT_B2[4] = {
    float4(0.4770337f, 0.5460797f, 0.12910557f, 0.52999705f),
    float4(-1.6353985f, -0.015806707f, -0.09737429f, -0.15550172f),
    float4(-0.093735114f, -0.16538522f, 0.15941054f, -0.084039986f),
    float4(-0.27845818f, -1.404325f, -0.21183206f, 0.7471019f)
};
static const float4 NMT_W3[4] = {
    float4(-0.40647185f, 0.44648197f, 0.33806726f, -0.58729476f),
    float4(0.296294f, 0.4119679f, -0.092257194f, -1.5042608f),
    float4(0.5056655f, 0.25605714f, 0.47047532f, 0.08635457f),
    float4(-0.21344288f, 0.44311768f, -0.35619932f, -0.38459864f)
};
static const float NMT_B3 = -0.75821054f;

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
    float2 bounds = nmt_core_bounds(x, m1, m2, m3, m4);
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
