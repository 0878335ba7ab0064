// Of two images: sum of squared differences, greatest difference; of the lists: fragments, most of a pixel, covered
// pixels. One row of results for every 16 x 16 pixels.
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var truth: texture_2d<f32>;
@group(0) @binding(2) var<storage, read> pixels: array<array<u32, 2>>;
@group(0) @binding(3) var<storage, read_write> results: array<array<f32, 8>>;

var<workgroup> squares: array<f32, 256>;
var<workgroup> worst: array<f32, 256>;
var<workgroup> counts: array<u32, 256>;
var<workgroup> most: array<u32, 256>;
var<workgroup> covered: array<u32, 256>;

@compute @workgroup_size(16, 16)
fn statistics(
    @builtin(global_invocation_id) at: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let size = textureDimensions(image);
    let inside = at.x < size.x && at.y < size.y;
    var d = vec3<f32>(0.0);
    var count = 0u;
    if (inside) {
        d = textureLoad(image, at.xy, 0).rgb - textureLoad(truth, at.xy, 0).rgb;
        count = pixels[at.x + at.y * size.x][1];
    }
    squares[local] = dot(d, d);
    worst[local] = max(abs(d.x), max(abs(d.y), abs(d.z)));
    counts[local] = count;
    most[local] = count;
    covered[local] = select(0u, 1u, count > 0u);
    for (var half = 128u; half > 0u; half >>= 1u) {
        workgroupBarrier();
        if (local < half) {
            squares[local] += squares[local + half];
            worst[local] = max(worst[local], worst[local + half]);
            counts[local] += counts[local + half];
            most[local] = max(most[local], most[local + half]);
            covered[local] += covered[local + half];
        }
    }
    if (local == 0u) {
        let i = group.x + group.y * groups.x;
        results[i] = array<f32, 8>(squares[0], worst[0], f32(counts[0]), f32(most[0]), f32(covered[0]), 0.0, 0.0, 0.0);
    }
}
