// The steps that a slot holds.
fn core_kept(slot: u32, code: u32, codes: NmtCodes) -> vec2<u32> {
    if (slot == 0u) {
        return nmt_core_nearest_steps(code);
    }
    if (slot == 1u) {
        return nmt_core_farthest_steps(code);
    }
    return nmt_core_heavy_steps(code, codes);
}

fn weight(s: Surface, at: vec2<i32>) -> f32 {
    let codes = nmt_core_codes(frame.range.x, frame.range.y);
    let own = core_steps(s);
    let first = u32(at.x + at.y * i32(frame.size.x)) * NMT_SLOTS;
    var tail = textureLoad(target0, at, 0).xyz;
    let total_before = tail.x;
    var front = 0.0;
    var is_core = false;
    var z_first = -1.0;
    var z_last = 1.0;
    for (var slot = 0u; slot < NMT_HEAVY + 2u; slot += 1u) {
        let code = slots[first + slot];
        if (code == 0u) {
            continue;
        }
        let kept = core_kept(slot, code, codes);
        tail -= core_moments(kept);
        front += select(0.0, nmt_core_absorbance(kept), kept.x < own.x);
        is_core = is_core || all(kept == own);
        if (slot == 0u) {
            z_first = nmt_core_depth(kept);
        }
        if (slot == 1u) {
            z_last = nmt_core_depth(kept);
        }
    }
    if (!is_core) {
        tail -= core_moments(own);
    }
    // What rounding leaves of sums that hold no tail.
    if (tail.x > 1e-5 * total_before + 1e-6) {
        let mean = clamp(tail.y / tail.x, z_first, z_last);
        let most = max((mean - z_first) * (z_last - mean), 1e-8);
        let spread = sqrt(clamp(tail.z / tail.x - mean * mean, 1e-3 * most, most));
        let low = core_normal((z_first - mean) / spread);
        let high = core_normal((z_last - mean) / spread);
        let here = core_normal((nmt_core_depth(own) - mean) / spread);
        front += tail.x * clamp((here - low) / max(high - low, 1e-6), 0.0, 1.0);
    }
    return exp(-max(front, 0.0));
}
