// Neural moment transparency: network 'deep-weighted-blended', 3-10-8-1, 118 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
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

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, number of
// fragments) and the least and greatest view depth of the scene.
vec3 nmt_features(float view_z, float v_min, float v_max, float alpha_sum, float n) {
    float depth = (v_max > v_min ? clamp((view_z - v_min) / max(v_max - v_min, 1e-30), 0.0, 1.0) : 0.0);
    return vec3(depth, alpha_sum, n);
}

const mat4 NMT_W1[3] = mat4[3](
    mat4(vec4(1.657024, 3.360892, 0.1313911, -0.5419495), vec4(-0.18385865, 0.25869948, -0.16814557, -0.17278436), vec4(0.0012825805, 0.11082688, -0.6666102, -0.67785805), vec4(-0.25357166, -0.44708672, 0.0, 0.0)),
    mat4(vec4(-0.07264159, 1.3070917, -2.9824917, -0.40802893), vec4(-0.32245347, -0.25351995, 0.24740538, -0.19207934), vec4(-0.50113267, 0.34644765, 0.6330341, 0.0002550998), vec4(0.0, 0.92429936, -0.40088236, 0.0)),
    mat4(vec4(-0.40944138, -0.074698396, 0.0, 0.0), vec4(-0.47886637, -0.017225184, 0.0, 0.0), vec4(-0.4349005, -0.2579935, 0.0, 0.0), vec4(0.0, 0.60113144, 0.0, 0.0))
);
const mat4 NMT_W2[6] = mat4[6](
    mat4(vec4(0.014763311, 1.305958, -0.440859, -1.0433087), vec4(0.028645676, 0.0041750926, 0.2555631, 0.90604717), vec4(-0.13698046, 0.5144506, 0.44923508, -0.4483657), vec4(0.10367611, -0.50131184, -0.39070386, 0.40000266)),
    mat4(vec4(-0.5062982, -0.5249564, 0.1609732, 0.36636382), vec4(-0.14561537, -0.40466505, -0.3715233, -0.058552146), vec4(-0.20395063, 0.5750192, -0.4836793, 0.25766757), vec4(0.42088935, -0.30838564, -0.2037243, 0.23894006)),
    mat4(vec4(-0.045537747, -0.12986495, -0.04161216, -0.026916003), vec4(-0.36526972, 3.6764855, -0.28440914, -1.6562685), vec4(0.0, 0.30335924, -0.074186884, 0.056896713), vec4(0.0, 0.0, 0.0, 0.0)),
    mat4(vec4(1.226652, 0.4529289, 0.23199527, -1.0102673), vec4(-0.3470101, -0.5558072, -0.2847423, 0.7892058), vec4(0.5582243, 0.15086795, -0.35774484, -0.30643842), vec4(-0.006129122, 0.045579523, -0.16806939, 0.33085632)),
    mat4(vec4(0.52507216, 0.06663525, -0.5123686, 0.32388544), vec4(-0.07300764, 0.4780235, -0.034844056, -0.08061752), vec4(0.5178387, -0.18277086, -0.5198439, 0.31385434), vec4(-0.38142112, -0.07048002, 0.2614812, -0.19305119)),
    mat4(vec4(-0.110646755, 0.008903797, -0.5232101, -0.5212966), vec4(3.8915682, 2.4374554, -0.0937952, -1.2070087), vec4(0.39106137, 0.9804706, -0.10930961, 0.046829898), vec4(0.0, 0.0, 0.0, 0.0))
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.37347975, 0.78402555, 0.64845484, -0.9254207),
    vec4(0.35157916, 1.4549395, -0.13997157, -0.12255525)
);
const float NMT_B3 = 0.052733794;

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(vec3 f) {
    vec4 h0_0 = vec4(f, 1.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[1] * h0_0, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[2] * h0_0, vec4(0.0)) + vec4(0.0, 0.0, 1.0, 0.0);
    vec4 h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2, vec4(0.0));
    vec4 h2_1 = max(NMT_W2[3] * h1_0 + NMT_W2[4] * h1_1 + NMT_W2[5] * h1_2, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

#endif
