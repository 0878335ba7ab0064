for (var i = oit_offsets[pixel]; i < oit_offsets[pixel + 1u]; i++) {
        nearest = min(nearest, oit_view_z[i]);
        farthest = max(farthest, oit_view_z[i]);
    }
    let ends = vec2<f32>(nearest, farthest);
