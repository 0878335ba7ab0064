// Hybrid transparency, the twin of hybrid.rs. HYBRID_CORE, K, stands before it. A pixel has v, absorbance and opacity of K fragments from front to
// back, absorbance and opacity of all others, and how many of the K there are.

const HYBRID_TAIL = 3u * HYBRID_CORE;

fn oit_add_to(sums: ptr<function, array<f32, OIT_SUMS>>, f: OitFragment, nearest: f32, farthest: f32) {
    var carried = vec3<f32>(f.v, f.absorbance, f.alpha);
    let count = u32((*sums)[HYBRID_TAIL + 2u]);
    var shifts = false;
    for (var i = 0u; i < HYBRID_CORE; i++) {
        let at = 3u * i;
        if (i >= count) {
            (*sums)[at] = carried.x;
            (*sums)[at + 1u] = carried.y;
            (*sums)[at + 2u] = carried.z;
            (*sums)[HYBRID_TAIL + 2u] += 1.0;
            return;
        }
        shifts = shifts || carried.x < (*sums)[at];
        if (shifts) {
            let kept = carried;
            carried = vec3<f32>((*sums)[at], (*sums)[at + 1u], (*sums)[at + 2u]);
            (*sums)[at] = kept.x;
            (*sums)[at + 1u] = kept.y;
            (*sums)[at + 2u] = kept.z;
        }
    }
    (*sums)[HYBRID_TAIL] += carried.y;
    (*sums)[HYBRID_TAIL + 1u] += carried.z;
}

fn oit_weight(f: OitFragment, p: OitPixel) -> f32 {
    var sums = p.sums;
    let count = u32(sums[HYBRID_TAIL + 2u]);
    var in_front = 0.0;
    for (var i = 0u; i < count; i++) {
        let at = 3u * i;
        if (sums[at] == f.v && sums[at + 2u] == f.alpha) {
            return exp(-in_front);
        }
        in_front += sums[at + 1u];
    }
    let alphas = sums[HYBRID_TAIL + 1u];
    let mean = (1.0 - exp(-sums[HYBRID_TAIL])) / max(alphas, 1e-30);
    return exp(-in_front) * select(1.0, mean, alphas > 0.0);
}
