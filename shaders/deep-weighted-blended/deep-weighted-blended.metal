// Neural moment transparency: network 'deep-weighted-blended', 3-10-8-1, 118 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.
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

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType3 {
    metal::float4x4 inner[3];
};
struct NmtType5 {
    metal::float4x4 inner[6];
};
struct NmtType6 {
    metal::float4 inner[2];
};
constant NmtType3 NMT_W1 = NmtType3 {{metal::float4x4(metal::float4(1.657024, 3.360892, 0.1313911, -0.5419495), metal::float4(-0.18385865, 0.25869948, -0.16814557, -0.17278436), metal::float4(0.0012825805, 0.11082688, -0.6666102, -0.67785805), metal::float4(-0.25357166, -0.44708672, 0.0, 0.0)), metal::float4x4(metal::float4(-0.07264159, 1.3070917, -2.9824917, -0.40802893), metal::float4(-0.32245347, -0.25351995, 0.24740538, -0.19207934), metal::float4(-0.50113267, 0.34644765, 0.6330341, 0.0002550998), metal::float4(0.0, 0.92429936, -0.40088236, 0.0)), metal::float4x4(metal::float4(-0.40944138, -0.074698396, 0.0, 0.0), metal::float4(-0.47886637, -0.017225184, 0.0, 0.0), metal::float4(-0.4349005, -0.2579935, 0.0, 0.0), metal::float4(0.0, 0.60113144, 0.0, 0.0))}};
constant NmtType5 NMT_W2 = NmtType5 {{metal::float4x4(metal::float4(0.014763311, 1.305958, -0.440859, -1.0433087), metal::float4(0.028645676, 0.0041750926, 0.2555631, 0.90604717), metal::float4(-0.13698046, 0.5144506, 0.44923508, -0.4483657), metal::float4(0.10367611, -0.50131184, -0.39070386, 0.40000266)), metal::float4x4(metal::float4(-0.5062982, -0.5249564, 0.1609732, 0.36636382), metal::float4(-0.14561537, -0.40466505, -0.3715233, -0.058552146), metal::float4(-0.20395063, 0.5750192, -0.4836793, 0.25766757), metal::float4(0.42088935, -0.30838564, -0.2037243, 0.23894006)), metal::float4x4(metal::float4(-0.045537747, -0.12986495, -0.04161216, -0.026916003), metal::float4(-0.36526972, 3.6764855, -0.28440914, -1.6562685), metal::float4(0.0, 0.30335924, -0.074186884, 0.056896713), metal::float4(0.0, 0.0, 0.0, 0.0)), metal::float4x4(metal::float4(1.226652, 0.4529289, 0.23199527, -1.0102673), metal::float4(-0.3470101, -0.5558072, -0.2847423, 0.7892058), metal::float4(0.5582243, 0.15086795, -0.35774484, -0.30643842), metal::float4(-0.006129122, 0.045579523, -0.16806939, 0.33085632)), metal::float4x4(metal::float4(0.52507216, 0.06663525, -0.5123686, 0.32388544), metal::float4(-0.07300764, 0.4780235, -0.034844056, -0.08061752), metal::float4(0.5178387, -0.18277086, -0.5198439, 0.31385434), metal::float4(-0.38142112, -0.07048002, 0.2614812, -0.19305119)), metal::float4x4(metal::float4(-0.110646755, 0.008903797, -0.5232101, -0.5212966), metal::float4(3.8915682, 2.4374554, -0.0937952, -1.2070087), metal::float4(0.39106137, 0.9804706, -0.10930961, 0.046829898), metal::float4(0.0, 0.0, 0.0, 0.0))}};
constant NmtType6 NMT_W3 = NmtType6 {{metal::float4(-0.37347975, 0.78402555, 0.64845484, -0.9254207), metal::float4(0.35157916, 1.4549395, -0.13997157, -0.12255525)}};
constant float NMT_B3 = 0.052733794;

metal::float3 nmt_features(
    float view_z,
    float v_min,
    float v_max,
    float alpha_sum,
    float n
) {
    float depth = (v_max > v_min) ? metal::clamp((view_z - v_min) / metal::max(v_max - v_min, 0.000000000000000000000000000001), 0.0, 1.0) : 0.0;
    return metal::float3(depth, alpha_sum, n);
}

float nmt_transmittance(
    metal::float3 f
) {
    metal::float4 h0_0 = metal::float4(f, 1.0);
    metal::float4 h1_0 = metal::max(metal::float4x4(metal::float4(1.657024, 3.360892, 0.1313911, -0.5419495), metal::float4(-0.18385865, 0.25869948, -0.16814557, -0.17278436), metal::float4(0.0012825805, 0.11082688, -0.6666102, -0.67785805), metal::float4(-0.25357166, -0.44708672, 0.0, 0.0)) * h0_0, metal::float4(0.0));
    metal::float4 h1_1 = metal::max(metal::float4x4(metal::float4(-0.07264159, 1.3070917, -2.9824917, -0.40802893), metal::float4(-0.32245347, -0.25351995, 0.24740538, -0.19207934), metal::float4(-0.50113267, 0.34644765, 0.6330341, 0.0002550998), metal::float4(0.0, 0.92429936, -0.40088236, 0.0)) * h0_0, metal::float4(0.0));
    metal::float4 h1_2 = metal::max(metal::float4x4(metal::float4(-0.40944138, -0.074698396, 0.0, 0.0), metal::float4(-0.47886637, -0.017225184, 0.0, 0.0), metal::float4(-0.4349005, -0.2579935, 0.0, 0.0), metal::float4(0.0, 0.60113144, 0.0, 0.0)) * h0_0, metal::float4(0.0)) + metal::float4(0.0, 0.0, 1.0, 0.0);
    metal::float4 h2_0 = metal::max(((metal::float4x4(metal::float4(0.014763311, 1.305958, -0.440859, -1.0433087), metal::float4(0.028645676, 0.0041750926, 0.2555631, 0.90604717), metal::float4(-0.13698046, 0.5144506, 0.44923508, -0.4483657), metal::float4(0.10367611, -0.50131184, -0.39070386, 0.40000266)) * h1_0) + (metal::float4x4(metal::float4(-0.5062982, -0.5249564, 0.1609732, 0.36636382), metal::float4(-0.14561537, -0.40466505, -0.3715233, -0.058552146), metal::float4(-0.20395063, 0.5750192, -0.4836793, 0.25766757), metal::float4(0.42088935, -0.30838564, -0.2037243, 0.23894006)) * h1_1)) + (metal::float4x4(metal::float4(-0.045537747, -0.12986495, -0.04161216, -0.026916003), metal::float4(-0.36526972, 3.6764855, -0.28440914, -1.6562685), metal::float4(0.0, 0.30335924, -0.074186884, 0.056896713), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_2), metal::float4(0.0));
    metal::float4 h2_1 = metal::max(((metal::float4x4(metal::float4(1.226652, 0.4529289, 0.23199527, -1.0102673), metal::float4(-0.3470101, -0.5558072, -0.2847423, 0.7892058), metal::float4(0.5582243, 0.15086795, -0.35774484, -0.30643842), metal::float4(-0.006129122, 0.045579523, -0.16806939, 0.33085632)) * h1_0) + (metal::float4x4(metal::float4(0.52507216, 0.06663525, -0.5123686, 0.32388544), metal::float4(-0.07300764, 0.4780235, -0.034844056, -0.08061752), metal::float4(0.5178387, -0.18277086, -0.5198439, 0.31385434), metal::float4(-0.38142112, -0.07048002, 0.2614812, -0.19305119)) * h1_1)) + (metal::float4x4(metal::float4(-0.110646755, 0.008903797, -0.5232101, -0.5212966), metal::float4(3.8915682, 2.4374554, -0.0937952, -1.2070087), metal::float4(0.39106137, 0.9804706, -0.10930961, 0.046829898), metal::float4(0.0, 0.0, 0.0, 0.0)) * h1_2), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.37347975, 0.78402555, 0.64845484, -0.9254207), h2_0)) + metal::dot(metal::float4(0.35157916, 1.4549395, -0.13997157, -0.12255525), h2_1);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

#endif
