// Exact: every fragment goes into a linked list of its pixel.
struct Node { next: u32, v: f32, alpha: f32, red_green: u32, blue: u32 }

@group(1) @binding(0) var<storage, read_write> taken: atomic<u32>;
// Of a pixel: last node + 1 (0 where there is none), number of fragments.
@group(1) @binding(1) var<storage, read_write> pixels: array<array<atomic<u32>, 2>>;
@group(1) @binding(2) var<storage, read_write> nodes: array<Node>;
@group(1) @binding(3) var opaque_depth: texture_depth_2d;

@fragment
fn list(f: Varying) {
    let found = surface(f);
    let at = vec2<u32>(f.position.xy);
    // A fragment that writes to memory does so whatever the depth test says, so that it must look itself.
    if (found.alpha < 0.0 || f.position.z > textureLoad(opaque_depth, at, 0)) {
        discard;
    }
    let pixel = at.x + at.y * u32(frame.size.x);
    atomicAdd(&pixels[pixel][1], 1u);
    let node = atomicAdd(&taken, 1u);
    if (node < frame.capacity) {
        let next = atomicExchange(&pixels[pixel][0], node + 1u);
        let blue = pack2x16unorm(vec2<f32>(found.color.b, 0.0));
        nodes[node] = Node(next, found.v, found.alpha, pack2x16unorm(found.color.rg), blue);
    }
}
