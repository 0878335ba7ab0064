let faint = state.n > 4.0 && state.sums[0] <= OIT_FAINT;
    let kind = select(0u, 1u, state.n > 4.0 && state.z_farthest > oit_first_hidden_depth(state));
