#version 450
// OpenGL 4.5, pass 2: draw every transparent surface again, with the same vertices and the same vertex shader.
//
// glBlendFunc(GL_ONE, GL_ONE), GL_FUNC_ADD; target GL_RGBA16F or GL_RGBA32F, cleared to 0. Textures: the targets of
// pass 1. Storage buffer at binding 0: that of pass 1.
//
// Neural moment transparency: network 'core-small', 7-16-8-1, 248 multiply-adds.
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 5d4deb2f2c8a96ac5dfda935ab5f840b24948e782c8fbc4ba250b79fb256de83.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

const mat4 NMT_W1[8] = mat4[8](
    mat4(vec4(1.4474705, -2.3140097, 2.4587274, -2.0283625), vec4(0.025019553, -0.03455168, -0.20108078, -0.3676571), vec4(0.02266329, 0.048362754, 0.033006392, 0.4335871), vec4(-4.9143996, 2.5796134, -2.5119598, 1.4190323)),
    mat4(vec4(4.1092668, 4.0608425, -3.199834, -1.3899742), vec4(5.5573077, -2.4150424, -0.41402522, 0.81533575), vec4(-0.19838761, -8.665485, 1.8881316, 1.0846932), vec4(0.68159187, 1.9176182, 1.9448986, 0.32637742)),
    mat4(vec4(1.541189, 2.744907, -2.409202, -3.255194), vec4(0.16370825, 0.021742474, 0.0076347045, 0.06370908), vec4(-0.28933865, -0.02309331, 0.009891848, 0.05982188), vec4(2.1720924, 3.9204137, -2.5205986, 0.81907207)),
    mat4(vec4(-1.9147855, -3.6099176, -0.6726784, -1.253065), vec4(-2.4566364, -6.9067745, 4.8918395, -2.1710742), vec4(0.1385836, 1.9539759, 0.4752808, -0.2570193), vec4(2.742572, 0.3957342, 0.5051741, -1.0210482)),
    mat4(vec4(1.9162954, 2.059045, -2.5061216, 0.6707573), vec4(-0.04663631, 0.028203119, -0.057964344, 0.0018452917), vec4(0.010741622, 0.047778197, -0.0048850058, -0.0019730802), vec4(3.6878772, 1.181982, -2.1302025, -0.394331)),
    mat4(vec4(-4.2873454, 4.0037327, -1.2806336, 5.6339912), vec4(-4.2245893, -0.035980005, 4.6360426, -1.0983442), vec4(0.11669542, 2.6384828, 4.021518, -3.4167442), vec4(2.5587585, -0.51070315, -2.116296, 0.7068791)),
    mat4(vec4(-0.6415181, 5.4087095, -2.7415826, -3.481457), vec4(-0.031237075, 0.027115235, -0.08193817, -0.0057335687), vec4(0.021212518, -0.21955463, 0.016048992, -0.00071349356), vec4(1.9812537, -2.819833, -0.57123965, -0.10751174)),
    mat4(vec4(-4.632885, -3.490217, 2.5329893, 0.064274155), vec4(-2.6028123, 0.68095744, 0.01846506, 0.16123538), vec4(4.921812, -0.2815728, -0.09549676, 0.04217817), vec4(-1.2647824, -0.13394293, -2.2597103, -3.419232))
);
const mat4 NMT_W2[8] = mat4[8](
    mat4(vec4(-3.3418725, -4.0855875, 0.77165955, 0.41316321), vec4(-0.35114214, -2.7670434, 2.1249874, 2.197555), vec4(-0.58745646, 3.3334498, 0.70710117, 0.43568578), vec4(-0.25018284, -0.23728038, 0.05269738, 1.0609303)),
    mat4(vec4(-1.7087882, -0.41349608, -0.08120874, 1.4551854), vec4(-0.40181422, -3.625493, 3.7512345, 1.8275597), vec4(1.7986207, 1.546551, -0.603336, 0.49119824), vec4(-0.57053983, 0.88894725, -0.73311305, -0.07771064)),
    mat4(vec4(2.9096277, -0.15429012, -1.4159456, -1.1466888), vec4(-0.9994283, 2.6177647, 0.45010838, 1.4062314), vec4(-1.7475772, -3.352449, -0.28202784, -0.8496246), vec4(0.8343176, -0.610604, 1.8189929, 0.8360092)),
    mat4(vec4(1.4888489, -1.7507061, -2.3789833, -0.33815762), vec4(-0.9610482, -4.7598224, 0.5400893, -0.27676913), vec4(2.1696684, 2.3751001, -0.8185451, -0.39043123), vec4(20.988102, -8.060803, -6.457696, 2.0178878)),
    mat4(vec4(-1.9192039, 1.2973583, 0.12957217, -2.0995288), vec4(0.13706096, 0.18189034, -0.07957252, -1.3877001), vec4(0.60850334, -0.78841, -0.14115039, -0.776932), vec4(-0.011215124, 0.34320807, 0.14902373, 0.3875658)),
    mat4(vec4(-0.81812435, 0.94332623, 0.01563329, 0.16517355), vec4(-1.3968968, -0.28342438, -0.29675168, -4.430481), vec4(1.4621456, -2.2371657, -0.68029326, -0.5449462), vec4(-2.476674, -0.56428456, -0.10914541, 0.76484877)),
    mat4(vec4(-1.0451545, 0.22052269, -0.6172878, 2.7052572), vec4(1.7968506, 0.17819253, 0.08662049, -1.1919606), vec4(-0.8731105, 1.1723455, -0.27935618, 2.347068), vec4(-0.23865318, -1.2344798, 0.30622983, 1.1333549)),
    mat4(vec4(-0.5555628, 4.491205, 0.045380052, 2.1592524), vec4(2.492795, -0.41927868, -0.5530473, 0.7241723), vec4(1.3377888, 0.7353521, -0.59209406, 1.995464), vec4(2.6316738, -1.2303891, -0.38901335, 9.579925))
);
const vec4 NMT_B2[2] = vec4[2](
    vec4(-0.17192039, 0.17679797, 1.3886025, -1.34472),
    vec4(2.173804, 0.5498685, 0.17730568, -0.7695141)
);
const vec4 NMT_W3[2] = vec4[2](
    vec4(-0.50458753, 0.20017031, 0.6225078, -0.7532515),
    vec4(0.2678952, 0.3193554, -0.35949963, -0.49384788)
);
const float NMT_B3 = 0.57963055;

// Share of the other fragments' absorbance that lies in front of the fragment with features f, in [0, 1].
float nmt_share(mat2x4 f) {
    vec4 h0_0 = f[0];
    vec4 h0_1 = vec4(f[1].xyz, 1.0);
    vec4 h1_0 = max(NMT_W1[0] * h0_0 + NMT_W1[1] * h0_1, vec4(0.0));
    vec4 h1_1 = max(NMT_W1[2] * h0_0 + NMT_W1[3] * h0_1, vec4(0.0));
    vec4 h1_2 = max(NMT_W1[4] * h0_0 + NMT_W1[5] * h0_1, vec4(0.0));
    vec4 h1_3 = max(NMT_W1[6] * h0_0 + NMT_W1[7] * h0_1, vec4(0.0));
    vec4 h2_0 = max(NMT_B2[0] + NMT_W2[0] * h1_0 + NMT_W2[1] * h1_1 + NMT_W2[2] * h1_2 + NMT_W2[3] * h1_3, vec4(0.0));
    vec4 h2_1 = max(NMT_B2[1] + NMT_W2[4] * h1_0 + NMT_W2[5] * h1_1 + NMT_W2[6] * h1_2 + NMT_W2[7] * h1_3, vec4(0.0));
    float logit = NMT_B3 + dot(NMT_W3[0], h2_0) + dot(NMT_W3[1], h2_1);
    return 1.0 / (1.0 + exp(min(-logit, 80.0)));
}

// Transmittance in front of the fragment with features f, in [0, 1].
float nmt_transmittance(mat2x4 f) {
    float absorbance = max(exp(min(f[0].z, 40.0)) - 0.05, 0.0);
    return exp(-min(absorbance * nmt_share(f), 80.0));
}

const uint NMT_DEPTH_BITS = 16u;
// Steps of absorbance to the octave, as a power of two.
const uint NMT_OCTAVE_BITS = 11u;
const uint NMT_HEAVY = 2u;
// Slots of a pixel, empty ones at the end among them, a multiple of four.
const uint NMT_SLOTS = 4u;
// k 2^(NMT_OCTAVE_BITS - 15), of the key A / v^k.
const float NMT_KEY_SCALE = 0.375;
// The last step of absorbance, that of A = 10.
const uint NMT_LAST_ABSORBANCE = 27136u;
const uint NMT_LAST_DEPTH = (1u << NMT_DEPTH_BITS) - 1u;
const uint NMT_END_BITS = 32u - NMT_DEPTH_BITS;
// Bits of 2^-10, below which steps of absorbance are linear.
const uint NMT_LINEAR_BITS = 0x3a800000u;
const float NMT_LINEAR = 0.0009765625;

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
    int first = floatBitsToInt(v0);
    int last = floatBitsToInt(v1);
    int first_log2 = nmt_core_log2(first);
    uint range = uint(nmt_core_log2(last) - first_log2);
    uint shift = max(uint(findMSB(range) + 1), NMT_DEPTH_BITS + 1u) - (NMT_DEPTH_BITS + 1u);
    uint multiplier = 0x80000000u / ((range >> shift) + 1u);
    uint room = (1u << NMT_END_BITS) - 1u - NMT_LAST_ABSORBANCE;
    uint slope = min(uint(float(range >> 8u) * NMT_KEY_SCALE), room);
    return NmtCodes(first, last, first_log2, shift, multiplier, slope);
}

// Absorbance min(-ln(1 - alpha), 10) of an opacity.
float nmt_core_absorbance_of(float alpha) {
    return -log(max(1.0 - alpha, 0.000045399931));
}

// Steps of a fragment of view depth v.
uvec2 nmt_core_steps(float v, float absorbance, NmtCodes codes) {
    int place = nmt_core_log2(clamp(floatBitsToInt(v), codes.first_bits, codes.last_bits));
    uint w = uint(place - codes.first_log2) >> codes.shift;
    uint a = floatBitsToUint(clamp(absorbance, 0.0, 10.0) + NMT_LINEAR) - NMT_LINEAR_BITS;
    return uvec2(
        (w * codes.multiplier) >> (31u - NMT_DEPTH_BITS),
        (a + (1u << (22u - NMT_OCTAVE_BITS))) >> (23u - NMT_OCTAVE_BITS)
    );
}

// Moment depth that steps stand for, within (-1, 1).
float nmt_core_depth(uvec2 steps) {
    return float(2u * steps.x + 1u) * (1.0 / float(NMT_LAST_DEPTH + 1u)) - 1.0;
}

// Absorbance that steps stand for.
float nmt_core_absorbance(uvec2 steps) {
    return uintBitsToFloat(NMT_LINEAR_BITS + (steps.y << (23u - NMT_OCTAVE_BITS))) - NMT_LINEAR;
}

uvec2 nmt_core_nearest_steps(uint code) {
    return uvec2(NMT_LAST_DEPTH - (code >> NMT_END_BITS), code & ((1u << NMT_END_BITS) - 1u));
}

uvec2 nmt_core_farthest_steps(uint code) {
    return uvec2(code >> NMT_END_BITS, code & ((1u << NMT_END_BITS) - 1u));
}

uvec2 nmt_core_heavy_steps(uint code, NmtCodes codes) {
    uint nearness = code & NMT_LAST_DEPTH;
    uint key = code >> NMT_DEPTH_BITS;
    return uvec2(NMT_LAST_DEPTH - nearness, key - ((nearness * codes.slope) >> NMT_DEPTH_BITS));
}

// Transmittance in front of a fragment of moment depth z: e^-(core in front of it + its share of the tail), from the
// depths and absorbances of the core's fragments and sums over all.
float nmt_core_weigh(float z, float absorbance, vec4 depths0, vec4 absorbances0, float n, float b0, vec4 moments) {
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
    float far = (absorbances0.y > 0.0 ? depths0.y : depths0.x);
    float center = 0.5 * (depths0.x + far);
    float half_range = max(0.5 * (far - depths0.x), 1.5258789e-5);
    float per_h = 1.0 / half_range;
    float moved1 = (rest1_4 - center * rest0_4) * per_h;
    float moved2 = (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)) * (per_h * per_h);
    float moved3 = (rest3_4 - center * rest2_4 - center * (rest2_4 - center * rest1_4) - center * (rest2_4 - center
        * rest1_4 - center * (rest1_4 - center * rest0_4))) * (per_h * per_h * per_h);
    float moved4 = (rest4_4 - center * rest3_4 - center * (rest3_4 - center * rest2_4) - center * (rest3_4 - center
        * rest2_4 - center * (rest2_4 - center * rest1_4)) - center * (rest3_4 - center * rest2_4 - center * (rest2_4
        - center * rest1_4) - center * (rest2_4 - center * rest1_4 - center * (rest1_4 - center * rest0_4)))) * (per_h
        * per_h * per_h * per_h);
    float x = clamp((z - center) * per_h, -1.0, 1.0);
    float removed = (in_core_4 == 0.0 ? absorbance : 0.0);
    float tail0 = rest0_4 - removed;
    float tail1 = moved1 - removed * x;
    float tail2 = moved2 - removed * x * x;
    float tail3 = moved3 - removed * x * x * x;
    float tail4 = moved4 - removed * x * x * x * x;
    float others = count_4 - (removed > 0.0 ? 1.0 : 0.0);
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
        float known = min(exp(-(front_4 + absorbance_of_tail * exact_4)), 1.0);
        return known;
    }
    float mean = clamp(m1 * (1.0 / max(1.0, 1e-6)), -1.0, 1.0);
    float mean_2 = clamp((m1 - m3) * (1.0 / max(1.0 - m2, 1e-6)), -1.0, 1.0);
    return exp(-front_4) * nmt_transmittance(mat2x4(vec4(x, log2(others) * 0.33333334 - 1.0, log(absorbance_of_tail
        + 0.05), mean), vec4(clamp((m2 * (1.0 / max(1.0, 1e-6)) - mean * mean) / max(1.0 - mean * mean, 1e-6), 0.0,
        1.0), mean_2, sqrt(clamp(((m2 - m4) * (1.0 / max(1.0 - m2, 1e-6)) - mean_2 * mean_2) / max(1.0 - mean_2
        * mean_2, 1e-6), 0.0, 1.0)), 0.0)));
}

// What a slot stands for: moment depth and absorbance of its fragment, 0 and 0 where it is empty.
vec2 nmt_core_slot(uint code, uvec2 steps) {
    return code > 0u ? vec2(nmt_core_depth(steps), nmt_core_absorbance(steps)) : vec2(0.0);
}

// Transmittance in front of a fragment, by its steps: from the slots of its pixel, four to a vector, and what pass 1 has
// added up of all fragments whose step of absorbance is not 0: their number n, b0 = sum A, moments b1, ... = sum A z^k.
float nmt_core_transmittance(
    uvec2 steps,
    NmtCodes codes,
    uvec4 core0,
    float n,
    float b0,
    vec4 moments
) {
    vec2 slot0 = nmt_core_slot(core0.x, nmt_core_nearest_steps(core0.x));
    vec2 slot1 = nmt_core_slot(core0.y, nmt_core_farthest_steps(core0.y));
    vec2 slot2 = nmt_core_slot(core0.z, nmt_core_heavy_steps(core0.z, codes));
    vec2 slot3 = nmt_core_slot(core0.w, nmt_core_heavy_steps(core0.w, codes));
    return nmt_core_weigh(
        nmt_core_depth(steps),
        nmt_core_absorbance(steps),
        vec4(slot0.x, slot1.x, slot2.x, slot3.x),
        vec4(slot0.y, slot1.y, slot2.y, slot3.y),
        n,
        b0,
        moments
    );
}

layout(location = 0) in float v;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 weighted;
layout(location = 0) uniform vec2 v_range;
layout(location = 1) uniform uint width;
layout(binding = 0) uniform sampler2D sums0_texture;
layout(binding = 1) uniform sampler2D sums1_texture;
layout(std430, binding = 0) readonly buffer Cores { uvec4 core[]; };

void main() {
    NmtCodes codes = nmt_core_codes(v_range.x, v_range.y);
    uvec2 steps = nmt_core_steps(v, nmt_core_absorbance_of(color.a), codes);
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint first = 1u * (uint(at.y) * width + uint(at.x));
    vec4 sums0 = texelFetch(sums0_texture, at, 0);
    vec4 sums1 = texelFetch(sums1_texture, at, 0);
    vec4 moments = vec4(sums0.y, sums0.z, sums0.w, sums1.x);
    float T = nmt_core_transmittance(steps, codes, core[first], sums1.y, sums0.x, moments);
    float weight = color.a * T;
    weighted = vec4(weight * color.rgb, weight);
}
