// The least depth found from which on all is hidden, fragments of no absorbance standing for the depths that are tried.
    var cut = 3.0e38;
    var open = oit_first_hidden_depth(state);
    var closed = state.z_farthest;
    for (var i = 0; i < 7; i++) {
        let z = select(0.5 * (open + closed), closed, i == 0);
        if (oit_hidden_weight(OitFragment(0.0, z, 0.0, 0.0), state) <= OIT_HIDDEN) {
            cut = z;
            closed = z;
        } else {
            open = z;
        }
    }
    let behind = exp(-state.sums[0]);
    let end = oit_offsets[pixel + 1u];
    var i = oit_offsets[pixel];
    var evaluated = 0.0;
    var hidden = vec4<f32>(0.0);
    var again = false;
    loop {
        // On to the next fragment that needs the network: then all threads have one, and run it together.
        var f: OitFragment;
        for (; i < end; i++) {
            f = oit_fragment(i);
            if ((f.z < cut) != again) {
                break;
            }
            if (again) {
                continue;
            }
            // As the farthest, e^-(b0 - A).
            hidden += oit_weighted(i, f.alpha * select(min(behind / max(1.0 - f.alpha, 0.000045399931), 1.0), 1.0, f.v == state.nearest));
        }
        if (i < end) {
            weighted += oit_weighted(i, f.alpha * oit_weight(f, state));
            evaluated += 1.0;
            i++;
        } else if (!again && cut < 1.0e38 && weighted.a + hidden.a < OIT_LEAST_WEIGHT) {
            // The bound asks for more weight than the network leaves: the network for what was taken for hidden too.
            again = true;
            hidden = vec4<f32>(0.0);
            i = oit_offsets[pixel];
        } else {
            break;
        }
    }
    weighted += hidden;
