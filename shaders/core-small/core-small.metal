// Neural moment transparency: network 'core-small', 7-16-8-1, 248 multiply-adds.
// Form: packed. Blocks of 4 x 4 weights as matrices; every index is a literal.
// Metal Shading Language 2.1, translated from the WGSL export by naga. An array is a struct with the one member 'inner'.
//
// Features, set 'core-2-4', in this order: x, count, ln_b0, mean, spread, inner_mean, inner_spread.
// Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment
// depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and
// keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^6, an atomic
// maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the
// tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;
// count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the
// tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)
// times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail. The answer is T =
// exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's
// function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the
// network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or
// behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed
// forms.
//
// Provenance: nmt 0.1.0, commit a626ea857e68, backend fused, seed 1, epochs 300, dataset 5d4deb2f2c8a96ac5dfda935ab5f840b24948e782c8fbc4ba250b79fb256de83.
// Measured error: none recorded; 'nmt predict' measures it on fragment lists.

#ifndef NMT_INCLUDED_CORE_SMALL
#define NMT_INCLUDED_CORE_SMALL

// language: metal2.1
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct NmtType4 {
    metal::float4x4 inner[8];
};
struct NmtType5 {
    metal::float4 inner[2];
};
constant NmtType4 NMT_W1 = NmtType4 {{metal::float4x4(metal::float4(1.4474705, -2.3140097, 2.4587274, -2.0283625), metal::float4(0.025019553, -0.03455168, -0.20108078, -0.3676571), metal::float4(0.02266329, 0.048362754, 0.033006392, 0.4335871), metal::float4(-4.9143996, 2.5796134, -2.5119598, 1.4190323)), metal::float4x4(metal::float4(4.1092668, 4.0608425, -3.199834, -1.3899742), metal::float4(5.5573077, -2.4150424, -0.41402522, 0.81533575), metal::float4(-0.19838761, -8.665485, 1.8881316, 1.0846932), metal::float4(0.68159187, 1.9176182, 1.9448986, 0.32637742)), metal::float4x4(metal::float4(1.541189, 2.744907, -2.409202, -3.255194), metal::float4(0.16370825, 0.021742474, 0.0076347045, 0.06370908), metal::float4(-0.28933865, -0.02309331, 0.009891848, 0.05982188), metal::float4(2.1720924, 3.9204137, -2.5205986, 0.81907207)), metal::float4x4(metal::float4(-1.9147855, -3.6099176, -0.6726784, -1.253065), metal::float4(-2.4566364, -6.9067745, 4.8918395, -2.1710742), metal::float4(0.1385836, 1.9539759, 0.4752808, -0.2570193), metal::float4(2.742572, 0.3957342, 0.5051741, -1.0210482)), metal::float4x4(metal::float4(1.9162954, 2.059045, -2.5061216, 0.6707573), metal::float4(-0.04663631, 0.028203119, -0.057964344, 0.0018452917), metal::float4(0.010741622, 0.047778197, -0.0048850058, -0.0019730802), metal::float4(3.6878772, 1.181982, -2.1302025, -0.394331)), metal::float4x4(metal::float4(-4.2873454, 4.0037327, -1.2806336, 5.6339912), metal::float4(-4.2245893, -0.035980005, 4.6360426, -1.0983442), metal::float4(0.11669542, 2.6384828, 4.021518, -3.4167442), metal::float4(2.5587585, -0.51070315, -2.116296, 0.7068791)), metal::float4x4(metal::float4(-0.6415181, 5.4087095, -2.7415826, -3.481457), metal::float4(-0.031237075, 0.027115235, -0.08193817, -0.0057335687), metal::float4(0.021212518, -0.21955463, 0.016048992, -0.00071349356), metal::float4(1.9812537, -2.819833, -0.57123965, -0.10751174)), metal::float4x4(metal::float4(-4.632885, -3.490217, 2.5329893, 0.064274155), metal::float4(-2.6028123, 0.68095744, 0.01846506, 0.16123538), metal::float4(4.921812, -0.2815728, -0.09549676, 0.04217817), metal::float4(-1.2647824, -0.13394293, -2.2597103, -3.419232))}};
constant NmtType4 NMT_W2 = NmtType4 {{metal::float4x4(metal::float4(-3.3418725, -4.0855875, 0.77165955, 0.41316321), metal::float4(-0.35114214, -2.7670434, 2.1249874, 2.197555), metal::float4(-0.58745646, 3.3334498, 0.70710117, 0.43568578), metal::float4(-0.25018284, -0.23728038, 0.05269738, 1.0609303)), metal::float4x4(metal::float4(-1.7087882, -0.41349608, -0.08120874, 1.4551854), metal::float4(-0.40181422, -3.625493, 3.7512345, 1.8275597), metal::float4(1.7986207, 1.546551, -0.603336, 0.49119824), metal::float4(-0.57053983, 0.88894725, -0.73311305, -0.07771064)), metal::float4x4(metal::float4(2.9096277, -0.15429012, -1.4159456, -1.1466888), metal::float4(-0.9994283, 2.6177647, 0.45010838, 1.4062314), metal::float4(-1.7475772, -3.352449, -0.28202784, -0.8496246), metal::float4(0.8343176, -0.610604, 1.8189929, 0.8360092)), metal::float4x4(metal::float4(1.4888489, -1.7507061, -2.3789833, -0.33815762), metal::float4(-0.9610482, -4.7598224, 0.5400893, -0.27676913), metal::float4(2.1696684, 2.3751001, -0.8185451, -0.39043123), metal::float4(20.988102, -8.060803, -6.457696, 2.0178878)), metal::float4x4(metal::float4(-1.9192039, 1.2973583, 0.12957217, -2.0995288), metal::float4(0.13706096, 0.18189034, -0.07957252, -1.3877001), metal::float4(0.60850334, -0.78841, -0.14115039, -0.776932), metal::float4(-0.011215124, 0.34320807, 0.14902373, 0.3875658)), metal::float4x4(metal::float4(-0.81812435, 0.94332623, 0.01563329, 0.16517355), metal::float4(-1.3968968, -0.28342438, -0.29675168, -4.430481), metal::float4(1.4621456, -2.2371657, -0.68029326, -0.5449462), metal::float4(-2.476674, -0.56428456, -0.10914541, 0.76484877)), metal::float4x4(metal::float4(-1.0451545, 0.22052269, -0.6172878, 2.7052572), metal::float4(1.7968506, 0.17819253, 0.08662049, -1.1919606), metal::float4(-0.8731105, 1.1723455, -0.27935618, 2.347068), metal::float4(-0.23865318, -1.2344798, 0.30622983, 1.1333549)), metal::float4x4(metal::float4(-0.5555628, 4.491205, 0.045380052, 2.1592524), metal::float4(2.492795, -0.41927868, -0.5530473, 0.7241723), metal::float4(1.3377888, 0.7353521, -0.59209406, 1.995464), metal::float4(2.6316738, -1.2303891, -0.38901335, 9.579925))}};
constant NmtType5 NMT_B2 = NmtType5 {{metal::float4(-0.17192039, 0.17679797, 1.3886025, -1.34472), metal::float4(2.173804, 0.5498685, 0.17730568, -0.7695141)}};
constant NmtType5 NMT_W3 = NmtType5 {{metal::float4(-0.50458753, 0.20017031, 0.6225078, -0.7532515), metal::float4(0.2678952, 0.3193554, -0.35949963, -0.49384788)}};
constant float NMT_B3 = 0.57963055;

metal::float2x4 nmt_features(
    float x,
    float count,
    float ln_b0,
    metal::float4 tail
) {
    return metal::float2x4(metal::float4(x, count, ln_b0, tail.x), metal::float4(tail.yzw, 0.0));
}

float nmt_share(
    metal::float2x4 f
) {
    metal::float4 h0_0 = f[0];
    metal::float4 h0_1 = metal::float4(f[1].xyz, 1.0);
    metal::float4 h1_0 = metal::max((metal::float4x4(metal::float4(1.4474705, -2.3140097, 2.4587274, -2.0283625), metal::float4(0.025019553, -0.03455168, -0.20108078, -0.3676571), metal::float4(0.02266329, 0.048362754, 0.033006392, 0.4335871), metal::float4(-4.9143996, 2.5796134, -2.5119598, 1.4190323)) * h0_0) + (metal::float4x4(metal::float4(4.1092668, 4.0608425, -3.199834, -1.3899742), metal::float4(5.5573077, -2.4150424, -0.41402522, 0.81533575), metal::float4(-0.19838761, -8.665485, 1.8881316, 1.0846932), metal::float4(0.68159187, 1.9176182, 1.9448986, 0.32637742)) * h0_1), metal::float4(0.0));
    metal::float4 h1_1 = metal::max((metal::float4x4(metal::float4(1.541189, 2.744907, -2.409202, -3.255194), metal::float4(0.16370825, 0.021742474, 0.0076347045, 0.06370908), metal::float4(-0.28933865, -0.02309331, 0.009891848, 0.05982188), metal::float4(2.1720924, 3.9204137, -2.5205986, 0.81907207)) * h0_0) + (metal::float4x4(metal::float4(-1.9147855, -3.6099176, -0.6726784, -1.253065), metal::float4(-2.4566364, -6.9067745, 4.8918395, -2.1710742), metal::float4(0.1385836, 1.9539759, 0.4752808, -0.2570193), metal::float4(2.742572, 0.3957342, 0.5051741, -1.0210482)) * h0_1), metal::float4(0.0));
    metal::float4 h1_2 = metal::max((metal::float4x4(metal::float4(1.9162954, 2.059045, -2.5061216, 0.6707573), metal::float4(-0.04663631, 0.028203119, -0.057964344, 0.0018452917), metal::float4(0.010741622, 0.047778197, -0.0048850058, -0.0019730802), metal::float4(3.6878772, 1.181982, -2.1302025, -0.394331)) * h0_0) + (metal::float4x4(metal::float4(-4.2873454, 4.0037327, -1.2806336, 5.6339912), metal::float4(-4.2245893, -0.035980005, 4.6360426, -1.0983442), metal::float4(0.11669542, 2.6384828, 4.021518, -3.4167442), metal::float4(2.5587585, -0.51070315, -2.116296, 0.7068791)) * h0_1), metal::float4(0.0));
    metal::float4 h1_3 = metal::max((metal::float4x4(metal::float4(-0.6415181, 5.4087095, -2.7415826, -3.481457), metal::float4(-0.031237075, 0.027115235, -0.08193817, -0.0057335687), metal::float4(0.021212518, -0.21955463, 0.016048992, -0.00071349356), metal::float4(1.9812537, -2.819833, -0.57123965, -0.10751174)) * h0_0) + (metal::float4x4(metal::float4(-4.632885, -3.490217, 2.5329893, 0.064274155), metal::float4(-2.6028123, 0.68095744, 0.01846506, 0.16123538), metal::float4(4.921812, -0.2815728, -0.09549676, 0.04217817), metal::float4(-1.2647824, -0.13394293, -2.2597103, -3.419232)) * h0_1), metal::float4(0.0));
    metal::float4 h2_0 = metal::max((((metal::float4(-0.17192039, 0.17679797, 1.3886025, -1.34472) + (metal::float4x4(metal::float4(-3.3418725, -4.0855875, 0.77165955, 0.41316321), metal::float4(-0.35114214, -2.7670434, 2.1249874, 2.197555), metal::float4(-0.58745646, 3.3334498, 0.70710117, 0.43568578), metal::float4(-0.25018284, -0.23728038, 0.05269738, 1.0609303)) * h1_0)) + (metal::float4x4(metal::float4(-1.7087882, -0.41349608, -0.08120874, 1.4551854), metal::float4(-0.40181422, -3.625493, 3.7512345, 1.8275597), metal::float4(1.7986207, 1.546551, -0.603336, 0.49119824), metal::float4(-0.57053983, 0.88894725, -0.73311305, -0.07771064)) * h1_1)) + (metal::float4x4(metal::float4(2.9096277, -0.15429012, -1.4159456, -1.1466888), metal::float4(-0.9994283, 2.6177647, 0.45010838, 1.4062314), metal::float4(-1.7475772, -3.352449, -0.28202784, -0.8496246), metal::float4(0.8343176, -0.610604, 1.8189929, 0.8360092)) * h1_2)) + (metal::float4x4(metal::float4(1.4888489, -1.7507061, -2.3789833, -0.33815762), metal::float4(-0.9610482, -4.7598224, 0.5400893, -0.27676913), metal::float4(2.1696684, 2.3751001, -0.8185451, -0.39043123), metal::float4(20.988102, -8.060803, -6.457696, 2.0178878)) * h1_3), metal::float4(0.0));
    metal::float4 h2_1 = metal::max((((metal::float4(2.173804, 0.5498685, 0.17730568, -0.7695141) + (metal::float4x4(metal::float4(-1.9192039, 1.2973583, 0.12957217, -2.0995288), metal::float4(0.13706096, 0.18189034, -0.07957252, -1.3877001), metal::float4(0.60850334, -0.78841, -0.14115039, -0.776932), metal::float4(-0.011215124, 0.34320807, 0.14902373, 0.3875658)) * h1_0)) + (metal::float4x4(metal::float4(-0.81812435, 0.94332623, 0.01563329, 0.16517355), metal::float4(-1.3968968, -0.28342438, -0.29675168, -4.430481), metal::float4(1.4621456, -2.2371657, -0.68029326, -0.5449462), metal::float4(-2.476674, -0.56428456, -0.10914541, 0.76484877)) * h1_1)) + (metal::float4x4(metal::float4(-1.0451545, 0.22052269, -0.6172878, 2.7052572), metal::float4(1.7968506, 0.17819253, 0.08662049, -1.1919606), metal::float4(-0.8731105, 1.1723455, -0.27935618, 2.347068), metal::float4(-0.23865318, -1.2344798, 0.30622983, 1.1333549)) * h1_2)) + (metal::float4x4(metal::float4(-0.5555628, 4.491205, 0.045380052, 2.1592524), metal::float4(2.492795, -0.41927868, -0.5530473, 0.7241723), metal::float4(1.3377888, 0.7353521, -0.59209406, 1.995464), metal::float4(2.6316738, -1.2303891, -0.38901335, 9.579925)) * h1_3), metal::float4(0.0));
    float logit = (NMT_B3 + metal::dot(metal::float4(-0.50458753, 0.20017031, 0.6225078, -0.7532515), h2_0)) + metal::dot(metal::float4(0.2678952, 0.3193554, -0.35949963, -0.49384788), h2_1);
    return 1.0 / (1.0 + metal::exp(metal::min(-(logit), 80.0)));
}

float nmt_transmittance(
    metal::float2x4 f_1
) {
    float absorbance = metal::max(metal::exp(metal::min(f_1[0].z, 40.0)) - 0.05, 0.0);
    float _e10 = nmt_share(f_1);
    return metal::exp(-(metal::min(absorbance * _e10, 80.0)));
}

#endif
