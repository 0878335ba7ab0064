// Neural moment transparency: network 'deep-weighted-blended', 3-10-8-1, 118 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// HLSL, shader model 5 and later.
//
// Features, set 'deep-weighted-blended', in this order: depth, alpha_sum, n.
// v is distance along the view direction; v_min and v_max are its extremes over the whole scene.
// depth = (v - v_min) / (v_max - v_min), clamped to [0, 1], 0 where v_min = v_max;
// alpha_sum = sum of alpha and n = number of fragments of the pixel, over all of its fragments.
// The answer is what front-to-back blending has left when it reaches the fragment; use it as the weight of weighted blended transparency.
//
// Provenance: nmt 0.1.0, commit 1bc7b727192e, backend flex, seed 1, epochs 150, dataset 1b84f088eb207b67f974e5f758304f7176d10626dadd2eb0998409b49dd991b3.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

#ifndef NMT_INCLUDED_DEEP_WEIGHTED_BLENDED
#define NMT_INCLUDED_DEEP_WEIGHTED_BLENDED

// The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, number of
// fragments) and the least and greatest view depth of the scene.
float3 nmt_features(float view_z, float v_min, float v_max, float alpha_sum, float n) {
    float depth = (v_max > v_min ? clamp((view_z - v_min) / max(v_max - v_min, 1e-30), 0.0, 1.0) : 0.0);
    return float3(depth, alpha_sum, n);
}

static const float4x4 NMT_W1[3] = {
    float4x4(float4(1.657024f, 3.360892f, 0.1313911f, -0.5419495f), float4(-0.18385865f, 0.25869948f, -0.16814557f, -0.17278436f), float4(0.0012825805f, 0.11082688f, -0.6666102f, -0.67785805f), float4(-0.25357166f, -0.44708672f, 0.0f, 0.0f)),
    float4x4(float4(-0.07264159f, 1.3070917f, -2.9824917f, -0.40802893f), float4(-0.32245347f, -0.25351995f, 0.24740538f, -0.19207934f), float4(-0.50113267f, 0.34644765f, 0.6330341f, 0.0002550998f), float4(0.0f, 0.92429936f, -0.40088236f, 0.0f)),
    float4x4(float4(-0.40944138f, -0.074698396f, 0.0f, 0.0f), float4(-0.47886637f, -0.017225184f, 0.0f, 0.0f), float4(-0.4349005f, -0.2579935f, 0.0f, 0.0f), float4(0.0f, 0.60113144f, 0.0f, 0.0f))
};
static const float4x4 NMT_W2[6] = {
    float4x4(float4(0.014763311f, 1.305958f, -0.440859f, -1.0433087f), float4(0.028645676f, 0.0041750926f, 0.2555631f, 0.90604717f), float4(-0.13698046f, 0.5144506f, 0.44923508f, -0.4483657f), float4(0.10367611f, -0.50131184f, -0.39070386f, 0.40000266f)),
    float4x4(float4(-0.5062982f, -0.5249564f, 0.1609732f, 0.36636382f), float4(-0.14561537f, -0.40466505f, -0.3715233f, -0.058552146f), float4(-0.20395063f, 0.5750192f, -0.4836793f, 0.25766757f), float4(0.42088935f, -0.30838564f, -0.2037243f, 0.23894006f)),
    float4x4(float4(-0.045537747f, -0.12986495f, -0.04161216f, -0.026916003f), float4(-0.36526972f, 3.6764855f, -0.28440914f, -1.6562685f), float4(0.0f, 0.30335924f, -0.074186884f, 0.056896713f), float4(0.0f, 0.0f, 0.0f, 0.0f)),
    float4x4(float4(1.226652f, 0.4529289f, 0.23199527f, -1.0102673f), float4(-0.3470101f, -0.5558072f, -0.2847423f, 0.7892058f), float4(0.5582243f, 0.15086795f, -0.35774484f, -0.30643842f), float4(-0.006129122f, 0.045579523f, -0.16806939f, 0.33085632f)),
    float4x4(float4(0.52507216f, 0.06663525f, -0.5123686f, 0.32388544f), float4(-0.07300764f, 0.4780235f, -0.034844056f, -0.08061752f), float4(0.5178387f, -0.18277086f, -0.5198439f, 0.31385434f), float4(-0.38142112f, -0.07048002f, 0.2614812f, -0.19305119f)),
    float4x4(float4(-0.110646755f, 0.008903797f, -0.5232101f, -0.5212966f), float4(3.8915682f, 2.4374554f, -0.0937952f, -1.2070087f), float4(0.39106137f, 0.9804706f, -0.10930961f, 0.046829898f), float4(0.0f, 0.0f, 0.0f, 0.0f))
};
static const float4 NMT_W3[2] = {
    float4(-0.37347975f, 0.78402555f, 0.64845484f, -0.9254207f),
    float4(0.35157916f, 1.4549395f, -0.13997157f, -0.12255525f)
};
static const float NMT_B3 = 0.052733794f;

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(float3 f) {
    float4 h0_0 = float4(f, 1.0f);
    float4 h1_0 = max(mul(h0_0, NMT_W1[0]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_1 = max(mul(h0_0, NMT_W1[1]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h1_2 = max(mul(h0_0, NMT_W1[2]), float4(0.0f, 0.0f, 0.0f, 0.0f)) + float4(0.0f, 0.0f, 1.0f, 0.0f);
    float4 h2_0 = max(mul(h1_0, NMT_W2[0]) + mul(h1_1, NMT_W2[1]) + mul(h1_2, NMT_W2[2]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float4 h2_1 = max(mul(h1_0, NMT_W2[3]) + mul(h1_1, NMT_W2[4]) + mul(h1_2, NMT_W2[5]), float4(0.0f, 0.0f, 0.0f, 0.0f));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

#endif
