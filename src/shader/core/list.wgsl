
// Offers a fragment to a core that one thread has for itself.
fn oit_insert(core: ptr<function, array<u32, NMT_SLOTS>>, steps: vec2<u32>) {
    if (steps.y == 0u) {
        return;
    }
    let first = nmt_core_nearest_code(steps);
    let nearest = (*core)[0];
    (*core)[0] = max(nearest, first);
    if (nearest == 0u) {
        return;
    }
    let second = nmt_core_farthest_code(nmt_core_nearest_steps(min(nearest, first)));
    let farthest = (*core)[1];
    (*core)[1] = max(farthest, second);
    if (farthest == 0u) {
        return;
    }
    var code = nmt_core_heavy_code(nmt_core_farthest_steps(min(farthest, second)), oit_codes());
    if (NMT_HEAVY == 0u || (*core)[1u + NMT_HEAVY] >= code) {
        return;
    }
    OIT_HEAVY
}
