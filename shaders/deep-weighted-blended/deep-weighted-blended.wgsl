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

// The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, number of
// fragments) and the least and greatest view depth of the scene.
fn nmt_features(view_z: f32, v_min: f32, v_max: f32, alpha_sum: f32, n: f32) -> vec3<f32> {
    let depth = select(0.0, clamp((view_z - v_min) / max(v_max - v_min, 1e-30), 0.0, 1.0), v_max > v_min);
    return vec3<f32>(depth, alpha_sum, n);
}

const NMT_W1 = array<mat4x4<f32>, 3>(
    mat4x4<f32>(vec4<f32>(1.657024f, 3.360892f, 0.1313911f, -0.5419495f), vec4<f32>(-0.18385865f, 0.25869948f, -0.16814557f, -0.17278436f), vec4<f32>(0.0012825805f, 0.11082688f, -0.6666102f, -0.67785805f), vec4<f32>(-0.25357166f, -0.44708672f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.07264159f, 1.3070917f, -2.9824917f, -0.40802893f), vec4<f32>(-0.32245347f, -0.25351995f, 0.24740538f, -0.19207934f), vec4<f32>(-0.50113267f, 0.34644765f, 0.6330341f, 0.0002550998f), vec4<f32>(0.0f, 0.92429936f, -0.40088236f, 0.0f)),
    mat4x4<f32>(vec4<f32>(-0.40944138f, -0.074698396f, 0.0f, 0.0f), vec4<f32>(-0.47886637f, -0.017225184f, 0.0f, 0.0f), vec4<f32>(-0.4349005f, -0.2579935f, 0.0f, 0.0f), vec4<f32>(0.0f, 0.60113144f, 0.0f, 0.0f))
);
const NMT_W2 = array<mat4x4<f32>, 6>(
    mat4x4<f32>(vec4<f32>(0.014763311f, 1.305958f, -0.440859f, -1.0433087f), vec4<f32>(0.028645676f, 0.0041750926f, 0.2555631f, 0.90604717f), vec4<f32>(-0.13698046f, 0.5144506f, 0.44923508f, -0.4483657f), vec4<f32>(0.10367611f, -0.50131184f, -0.39070386f, 0.40000266f)),
    mat4x4<f32>(vec4<f32>(-0.5062982f, -0.5249564f, 0.1609732f, 0.36636382f), vec4<f32>(-0.14561537f, -0.40466505f, -0.3715233f, -0.058552146f), vec4<f32>(-0.20395063f, 0.5750192f, -0.4836793f, 0.25766757f), vec4<f32>(0.42088935f, -0.30838564f, -0.2037243f, 0.23894006f)),
    mat4x4<f32>(vec4<f32>(-0.045537747f, -0.12986495f, -0.04161216f, -0.026916003f), vec4<f32>(-0.36526972f, 3.6764855f, -0.28440914f, -1.6562685f), vec4<f32>(0.0f, 0.30335924f, -0.074186884f, 0.056896713f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f)),
    mat4x4<f32>(vec4<f32>(1.226652f, 0.4529289f, 0.23199527f, -1.0102673f), vec4<f32>(-0.3470101f, -0.5558072f, -0.2847423f, 0.7892058f), vec4<f32>(0.5582243f, 0.15086795f, -0.35774484f, -0.30643842f), vec4<f32>(-0.006129122f, 0.045579523f, -0.16806939f, 0.33085632f)),
    mat4x4<f32>(vec4<f32>(0.52507216f, 0.06663525f, -0.5123686f, 0.32388544f), vec4<f32>(-0.07300764f, 0.4780235f, -0.034844056f, -0.08061752f), vec4<f32>(0.5178387f, -0.18277086f, -0.5198439f, 0.31385434f), vec4<f32>(-0.38142112f, -0.07048002f, 0.2614812f, -0.19305119f)),
    mat4x4<f32>(vec4<f32>(-0.110646755f, 0.008903797f, -0.5232101f, -0.5212966f), vec4<f32>(3.8915682f, 2.4374554f, -0.0937952f, -1.2070087f), vec4<f32>(0.39106137f, 0.9804706f, -0.10930961f, 0.046829898f), vec4<f32>(0.0f, 0.0f, 0.0f, 0.0f))
);
const NMT_W3 = array<vec4<f32>, 2>(
    vec4<f32>(-0.37347975f, 0.78402555f, 0.64845484f, -0.9254207f),
    vec4<f32>(0.35157916f, 1.4549395f, -0.13997157f, -0.12255525f)
);
const NMT_B3: f32 = 0.052733794f;

// Transmittance in front of the fragment with features f, in [0, 1].
fn nmt_transmittance(f: vec3<f32>) -> f32 {
    let h0_0 = vec4<f32>(f, 1.0f);
    let h1_0 = max(NMT_W1[0] * h0_0, vec4<f32>(0.0f));
    let h1_1 = max(NMT_W1[1] * h0_0, vec4<f32>(0.0f));
    let h1_2 = max(NMT_W1[2] * h0_0, vec4<f32>(0.0f)) + vec4<f32>(0.0f, 0.0f, 1.0f, 0.0f);
    let h2_0 = max(NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2, vec4<f32>(0.0f));
    let h2_1 = max(NMT_W2[3] * h1_0 + NMT_W2[4] * h1_1 + NMT_W2[5] * h1_2, vec4<f32>(0.0f));
    let logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}
