// Exact: the fragments of a pixel's list, nearest first, composited with the over operator. Any number of them: each
// walk along the list keeps the next sixteen.
struct Node { next: u32, v: f32, alpha: f32, red_green: u32, blue: u32 }

@group(1) @binding(0) var<storage, read> taken: u32;
@group(1) @binding(1) var<storage, read> pixels: array<array<u32, 2>>;
@group(1) @binding(2) var<storage, read> nodes: array<Node>;
@group(1) @binding(3) var background: texture_2d<f32>;

const AT_ONCE = 16u;

@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn composite(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<u32>(position.xy);
    let pixel = at.x + at.y * u32(frame.size.x);
    let first = pixels[pixel][0];
    // Absorbance is at most 10.
    const LEAST_CLEAR = 0.000045399931;
    var color = vec3<f32>(0.0);
    var clear = 1.0;
    // The last fragment that was composited: those at one depth go by their place in memory.
    var done_v = -1.0;
    var done_node = 0u;
    var complete = 0u;
    loop {
        var next_v: array<f32, AT_ONCE>;
        var next_node: array<u32, AT_ONCE>;
        var count = 0u;
        var node = first;
        while (node != 0u) {
            let v = nodes[node - 1u].v;
            let after = v > done_v || (v == done_v && node > done_node);
            if (after) {
                var i = min(count, AT_ONCE - 1u);
                let fits = count < AT_ONCE || v < next_v[i] || (v == next_v[i] && node < next_node[i]);
                if (fits) {
                    while (i > 0u && (v < next_v[i - 1u] || (v == next_v[i - 1u] && node < next_node[i - 1u]))) {
                        next_v[i] = next_v[i - 1u];
                        next_node[i] = next_node[i - 1u];
                        i -= 1u;
                    }
                    next_v[i] = v;
                    next_node[i] = node;
                    count = min(count + 1u, AT_ONCE);
                }
            }
            node = nodes[node - 1u].next;
        }
        for (var i = 0u; i < count; i += 1u) {
            let found = nodes[next_node[i] - 1u];
            let rgb = vec3<f32>(unpack2x16unorm(found.red_green), unpack2x16unorm(found.blue).x);
            color += clear * found.alpha * rgb;
            clear *= max(1.0 - found.alpha, LEAST_CLEAR);
        }
        complete += count;
        if (count < AT_ONCE || clear < 1e-7) {
            break;
        }
        done_v = next_v[AT_ONCE - 1u];
        done_node = next_node[AT_ONCE - 1u];
    }
    // Where memory for the lists ran out the pixel is painted in a colour that no scene has.
    if (taken > frame.capacity && complete < pixels[pixel][1] && clear >= 1e-7) {
        return vec4<f32>(1.0, 0.0, 1.0, 1.0);
    }
    return vec4<f32>(color + clear * textureLoad(background, at, 0).rgb, 1.0);
}
