for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        let f = oit_fragment(i);
        weighted += oit_weighted(i, f.alpha * oit_weight(f, state));
    }
    let evaluated = state.n;
