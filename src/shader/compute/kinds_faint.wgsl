let faint = state.sums[0] <= OIT_MIN_OPACITY;
    let kind = 0u;
