// Pass 1, blended: sums and count by addition, the range by max of (-v, v), so that one operation keeps both ends.

struct OitTargets {
    OIT_TARGETS
}

@fragment
fn oit_pass1(f: OitVarying) -> OitTargets {
    let seen = oit_seen(f);
    let terms = oit_accumulate(seen);
    OIT_INSERT
    return OitTargets(OIT_TERMS);
}
