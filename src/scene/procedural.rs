//! Built-in scenes: geometry made from a seed.
//!
//! Item i of a scene draws from its own random stream, so that the same seed gives the same scene everywhere.

use super::camera::{Camera, Vec3, add, cross, dot, scale, sub, unit};
use super::file::lit;
use super::raster::{Geometry, Particle, Vertex};
use super::splat::Splat;
use crate::numeric::rng::{Stream, stream};
use rand::RngExt;
use std::f64::consts::{PI, TAU};

/// The camera of a built-in scene.
pub(super) fn camera(name: &str) -> Camera {
    let (position, look_at, vertical_fov) = match name {
        "glass-stacks" => ([3.4, 2.7, 6.2], [0.0, 0.42, 0.0], 40.0),
        "smoke" => ([0.0, 2.2, 8.5], [0.0, 2.15, 0.0], 36.0),
        "hair" => ([0.9, 0.5, 6.2], [0.0, -0.25, 0.0], 40.0),
        "foliage" => ([0.4, 1.9, 8.2], [0.0, 2.0, 0.0], 34.0),
        "sphere-cluster" => ([0.0, 1.1, 6.6], [0.0, 0.0, 0.0], 34.0),
        "spheres" => ([0.0, 1.1, 6.6], [0.0, -0.05, 0.0], 34.0),
        "splats" => ([0.6, 2.0, 5.4], [0.0, 0.95, 0.0], 34.0),
        "curtains" => ([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 40.0),
        _ => ([1.1, 3.1, 8.6], [0.0, 0.28, -0.2], 41.0),
    };
    // About a hundred splats lie over each pixel, at any size.
    let side = if name == "splats" { 256 } else { 512 };
    Camera {
        position,
        look_at,
        up: [0.0, 1.0, 0.0],
        vertical_fov,
        width: side,
        height: side,
        near: 0.5,
        far: 40.0,
    }
}

/// The light of a built-in scene, above the viewer's left shoulder.
pub(super) fn light(name: &str) -> Camera {
    let camera = camera(name);
    let (middle, size) = match name {
        "curtains" => ([0.0, 0.0, -4.0], 2.5),
        _ => (camera.look_at, 1.0),
    };
    Camera {
        position: add(middle, scale([-2.6, 6.4, 3.2], size)),
        look_at: middle,
        vertical_fov: 46.0,
        near: 0.5,
        far: 40.0,
        ..camera
    }
}

/// The geometry of a built-in scene for a viewer at `eye`.
pub(super) fn geometry(name: &str, seed: u64, eye: Vec3) -> Geometry {
    let mut out = Builder {
        eye,
        geometry: Geometry::default(),
    };
    match name {
        "glass-stacks" => glass_stacks(&mut out, seed),
        "smoke" => smoke(&mut out, seed),
        "hair" => hair(&mut out, seed),
        "foliage" => foliage(&mut out, seed),
        "spheres" => spheres(&mut out),
        "splats" => splats(&mut out, seed),
        "curtains" => curtains(&mut out, seed),
        "sphere-cluster" => sphere_cluster(&mut out, seed),
        _ => teapots(&mut out),
    }
    out.geometry
}

/// What the random streams of this file are for, so that no two scenes share numbers.
#[derive(Clone, Copy)]
enum Purpose {
    Glass = 0x5ce0,
    Smoke,
    Hair,
    Leaves,
    Splats,
    Curtains,
    Spheres,
}

fn random(seed: u64, purpose: Purpose, index: u64) -> Stream {
    stream(seed, purpose as u64, index)
}

/// Uniform in [lo, hi).
fn between(rng: &mut Stream, lo: f64, hi: f64) -> f64 {
    lo + (hi - lo) * rng.random::<f64>()
}

/// Uniform on the unit sphere.
fn direction(rng: &mut Stream) -> Vec3 {
    let y = between(rng, -1.0, 1.0);
    let angle = between(rng, 0.0, TAU);
    let r = (1.0 - y * y).max(0.0).sqrt();
    [r * libm::cos(angle), y, r * libm::sin(angle)]
}

fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
}

/// How a surface looks: its colour and alpha face on, and how much more opaque it is where seen from the side.
#[derive(Clone, Copy)]
struct Paint {
    color: [f32; 3],
    alpha: f32,
    rim: f32,
}

struct Builder {
    eye: Vec3,
    geometry: Geometry,
}

impl Builder {
    fn vertex(&self, position: Vec3, normal: Vec3, paint: Paint) -> Vertex {
        let [r, g, b] = lit(paint.color, normal);
        let facing = dot(normal, unit(sub(self.eye, position))).abs().min(1.0) as f32;
        let side = (1.0 - facing) * (1.0 - facing);
        let alpha = (paint.alpha + (1.0 - paint.alpha) * paint.rim * side).clamp(0.0, 1.0);
        Vertex {
            position: position.map(|x| x as f32),
            rgba: [r, g, b, alpha],
        }
    }

    fn flat(&mut self, corners: [Vec3; 3], paint: Paint) {
        let normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
        let [r, g, b] = lit(paint.color, normal);
        self.geometry.triangles.push(corners.map(|p| Vertex {
            position: p.map(|x| x as f32),
            rgba: [r, g, b, paint.alpha],
        }));
    }

    fn quad(&mut self, [a, b, c, d]: [Vec3; 4], paint: Paint) {
        self.flat([a, b, c], paint);
        self.flat([a, c, d], paint);
    }

    /// A smooth surface over the unit square: `point(u, v)` on a grid, normals by differences.
    fn surface(&mut self, columns: usize, rows: usize, paint: Paint, point: impl Fn(f64, f64) -> Vec3) {
        const STEP: f64 = 1e-4;
        let at = |i: usize, n: usize| i as f64 / n as f64;
        let corner = |i: usize, j: usize| {
            let (u, v) = (at(i, columns), at(j, rows));
            // One-sided differences at the ends of v, where the surface may stop; u may run over its ends.
            let (v0, v1) = ((v - STEP).max(0.0), (v + STEP).min(1.0));
            // At a pole the circle of u is a point: take the normal a little way off it.
            let inner = v.clamp(2.0 * STEP, 1.0 - 2.0 * STEP);
            let normal = unit(cross(
                sub(point(u + STEP, inner), point(u - STEP, inner)),
                sub(point(u, v1), point(u, v0)),
            ));
            self.vertex(point(u, v), normal, paint)
        };
        let grid: Vec<Vertex> = (0..=rows)
            .flat_map(|j| (0..=columns).map(move |i| (i, j)))
            .map(|(i, j)| corner(i, j))
            .collect();
        for j in 0..rows {
            for i in 0..columns {
                let k = j * (columns + 1) + i;
                let [a, b, c, d] = [grid[k], grid[k + 1], grid[k + columns + 2], grid[k + columns + 1]];
                self.geometry.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    fn sphere(&mut self, center: Vec3, radius: f64, paint: Paint) {
        self.surface(72, 36, paint, |u, v| {
            let ring = radius * libm::sin(PI * v);
            add(
                center,
                [
                    ring * libm::cos(TAU * u),
                    radius * libm::cos(PI * v),
                    ring * libm::sin(TAU * u),
                ],
            )
        });
    }

    /// A round tube of varying radius along a curve in the plane z = 0 of a frame, open at both ends.
    fn tube(
        &mut self,
        paint: Paint,
        place: impl Fn(Vec3) -> Vec3,
        curve: impl Fn(f64) -> (f64, f64),
        radius: impl Fn(f64) -> f64,
    ) {
        const STEP: f64 = 1e-3;
        self.surface(20, 20, paint, |u, v| {
            let (x, y) = curve(v);
            let ((x0, y0), (x1, y1)) = (curve(v - STEP), curve(v + STEP));
            let side = unit([y1 - y0, x0 - x1, 0.0]);
            let (r, angle) = (radius(v), TAU * u);
            place([
                x + r * libm::cos(angle) * side[0],
                y + r * libm::cos(angle) * side[1],
                r * libm::sin(angle),
            ])
        });
    }
}

/// Stacks of coloured panes that stand behind one another.
fn glass_stacks(out: &mut Builder, seed: u64) {
    const COLORS: [[f32; 3]; 6] = [
        [0.15, 0.55, 0.95],
        [0.1, 0.8, 0.55],
        [0.98, 0.75, 0.15],
        [0.95, 0.3, 0.25],
        [0.65, 0.35, 0.9],
        [0.2, 0.8, 0.9],
    ];
    const PANES: usize = 9;
    for stack in 0..9u64 {
        let (column, row) = ((stack % 3) as f64 - 1.0, (stack / 3) as f64 - 1.0);
        let mut rng = random(seed, Purpose::Glass, stack);
        let turn = between(&mut rng, -0.35, 0.35);
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let first = (between(&mut rng, 0.0, 6.0) as usize).min(5);
        let place = |p: Vec3| {
            [
                column * 1.45 + cos * p[0] + sin * p[2],
                p[1],
                row * 1.45 - sin * p[0] + cos * p[2],
            ]
        };
        for pane in 0..PANES {
            let color = mix(
                COLORS[first],
                COLORS[(first + 1 + stack as usize % 2) % 6],
                pane as f32 / (PANES - 1) as f32,
            );
            let alpha = between(&mut rng, 0.08, 0.4) as f32;
            let height = between(&mut rng, 0.75, 1.15);
            let (x, z, thick) = (0.46, (pane as f64 / (PANES - 1) as f64 - 0.5) * 0.9, 0.012);
            let corner = |i: usize| {
                let sign = |bit: usize, size: f64| if i >> bit & 1 == 1 { size } else { -size };
                place([
                    sign(0, x),
                    if i >> 1 & 1 == 1 { height } else { 0.0 },
                    z + sign(2, thick),
                ])
            };
            let face = |ids: [usize; 4]| ids.map(corner);
            for ids in [[0, 1, 3, 2], [4, 5, 7, 6]] {
                out.quad(face(ids), Paint { color, alpha, rim: 0.0 });
            }
            // The edges of a pane are seen through much more glass than its faces.
            for ids in [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6]] {
                out.quad(
                    face(ids),
                    Paint {
                        color: mix(color, [0.0, 0.15, 0.1], 0.35),
                        alpha: 0.75,
                        rim: 0.0,
                    },
                );
            }
            out.geometry.end_object();
        }
    }
}

/// Three plumes of soft particles that drift, widen and thin out as they rise.
fn smoke(out: &mut Builder, seed: u64) {
    const PARTICLES: u64 = 5400;
    for i in 0..PARTICLES {
        let mut rng = random(seed, Purpose::Smoke, i);
        let plume = (i % 3) as f64 - 1.0;
        let t = libm::pow(between(&mut rng, 0.0, 1.0), 0.8);
        let phase = plume * 2.1;
        let swirl = 0.08 + 0.5 * t;
        let axis = [
            plume * 1.3 + swirl * 0.55 * libm::sin(4.2 * t + phase) + 0.2 * t,
            4.6 * t - 0.1,
            plume * 0.5 + swirl * 0.55 * libm::cos(5.0 * t + phase),
        ];
        // Puffs: clumps of particles along the plume.
        let puff = 0.06 * libm::sin(34.0 * t + 3.0 * phase);
        let spread = 0.06 + 0.42 * t + puff * (0.3 + t);
        let off = scale(direction(&mut rng), spread * libm::cbrt(between(&mut rng, 0.0, 1.0)));
        let position = add(axis, off);
        let radius = (0.07 + 0.2 * t) * between(&mut rng, 0.7, 1.3);
        let alpha = (0.13 * (1.0 - t) + 0.012) * between(&mut rng, 0.6, 1.3);
        let height = (0.55 + 0.45 * (off[1] - 0.4 * off[0]) / spread.max(1e-9)).clamp(0.0, 1.0) as f32;
        let grey = mix([0.22, 0.23, 0.27], [0.78, 0.78, 0.8], height);
        let tint = [[0.95, 0.45, 0.2], [0.6, 0.6, 0.62], [0.25, 0.5, 0.95]][(i % 3) as usize];
        let color = mix(grey, tint, 0.45 * (1.0 - t as f32));
        out.geometry.particles.push(Particle {
            position: position.map(|x| x as f32),
            radius: radius as f32,
            rgba: [color[0], color[1], color[2], alpha as f32],
        });
    }
}

/// Long hair: strands from a scalp, each a ribbon that faces the viewer, thinner than a pixel at small sizes.
fn hair(out: &mut Builder, seed: u64) {
    const STRANDS: u64 = 15000;
    const SEGMENTS: usize = 20;
    const WIDTH: f64 = 0.009;
    for i in 0..STRANDS {
        // Strands of a lock share a lock's shape and differ a little.
        let mut lock = random(seed, Purpose::Hair, i / 60);
        let mut rng = random(seed, Purpose::Hair, (1 << 32) + i);
        let mut root = direction(&mut lock);
        root[1] = root[1].abs() * 0.9 + 0.1;
        let root = unit(add(root, scale(direction(&mut rng), 0.22)));
        let curl = (
            between(&mut lock, 0.05, 0.16),
            between(&mut lock, 5.0, 9.0),
            between(&mut lock, 0.0, TAU),
        );
        let length = between(&mut lock, 2.0, 2.5) + between(&mut rng, -0.15, 0.15);
        let shade = between(&mut lock, 0.0, 1.0) as f32;
        let base = mix(
            [0.30, 0.13, 0.05],
            [0.75, 0.45, 0.18],
            shade * 0.8 + 0.2 * between(&mut rng, 0.0, 1.0) as f32,
        );
        let alpha = between(&mut rng, 0.12, 0.32) as f32;
        let point = |t: f64| {
            // Out of the scalp, over its curve, then down.
            let s = t * length;
            let out_way = 0.85 + 0.22 * (1.0 - libm::exp(-3.0 * s)) + 0.05 * s;
            let flat = unit([root[0], 0.0, root[2]]);
            let polar = libm::acos(root[1].clamp(-1.0, 1.0)) + s / out_way;
            let bend = polar.min(PI / 2.0);
            let fall = (polar - PI / 2.0).max(0.0) * out_way;
            let p = [
                flat[0] * out_way * libm::sin(bend),
                0.75 + out_way * libm::cos(bend) - fall - 0.12 * s * s * libm::sin(bend) / 2.0,
                flat[2] * out_way * libm::sin(bend),
            ];
            let wave = curl.0 * t;
            add(
                p,
                [
                    wave * libm::sin(curl.1 * s + curl.2),
                    0.0,
                    wave * libm::cos(curl.1 * s + curl.2),
                ],
            )
        };
        let ribbon = |t: f64| {
            let p = point(t);
            let along = unit(sub(point(t + 1e-3), p));
            let across = unit(cross(along, sub(out.eye, p)));
            let half = 0.5 * WIDTH * (1.0 - 0.6 * t);
            // Light of a fibre: brightest where the lamp stands square to it.
            let square = 1.0 - dot(along, unit([-0.45, 0.75, 0.5])).abs();
            let glint = square * square * square * (1.0 - t) + 0.15;
            let color = mix(
                base.map(|c| c * (0.45 + 0.55 * square as f32)),
                [1.0, 0.92, 0.75],
                (0.5 * glint) as f32,
            );
            let vertex = |p: Vec3| Vertex {
                position: p.map(|x| x as f32),
                rgba: [color[0], color[1], color[2], alpha],
            };
            (vertex(sub(p, scale(across, half))), vertex(add(p, scale(across, half))))
        };
        let ends: Vec<_> = (0..=SEGMENTS).map(|k| ribbon(k as f64 / SEGMENTS as f64)).collect();
        for pair in ends.windows(2) {
            let ((a, b), (d, c)) = (pair[0], pair[1]);
            out.geometry.triangles.extend([[a, b, c], [a, c, d]]);
        }
        if i % 60 == 59 {
            out.geometry.end_object();
        }
    }
}

/// A tree: a translucent trunk and boughs, and leaves that let a few per cent of the light through.
fn foliage(out: &mut Builder, seed: u64) {
    const LEAVES: u64 = 9000;
    let bark = Paint {
        color: [0.42, 0.28, 0.17],
        alpha: 0.985,
        rim: 0.0,
    };
    out.tube(
        bark,
        |p| p,
        |v| (0.06 * libm::sin(3.0 * v), 2.3 * v),
        |v| 0.17 - 0.11 * v + 0.1 * libm::exp(-14.0 * v),
    );
    out.geometry.end_object();
    let boughs: Vec<Vec3> = (0..26u64)
        .map(|b| {
            let mut rng = random(seed, Purpose::Leaves, (1 << 32) + b);
            let angle = 2.399_963_2 * b as f64;
            let up = between(&mut rng, 0.0, 1.0);
            let reach = 1.25 * (0.35 + 0.65 * libm::sin(PI * (0.25 + 0.7 * up)));
            [reach * libm::cos(angle), 1.35 + 2.0 * up, reach * libm::sin(angle)]
        })
        .collect();
    for tip in &boughs {
        let from = [0.04, 0.9 + 0.35 * (tip[1] - 1.0), 0.0];
        let flat = unit([tip[0], 0.0, tip[2]]);
        let place = |p: Vec3| {
            [
                from[0] + p[0] * flat[0] - p[2] * flat[2],
                from[1] + p[1],
                from[2] + p[0] * flat[2] + p[2] * flat[0],
            ]
        };
        let reach = tip[0].hypot(tip[2]);
        out.tube(
            bark,
            place,
            |v| (reach * v, (tip[1] - from[1]) * v * (0.6 + 0.4 * v)),
            |v| 0.045 * (1.0 - 0.8 * v),
        );
        out.geometry.end_object();
    }
    for i in 0..LEAVES {
        leaf(
            out,
            boughs[i as usize % boughs.len()],
            &mut random(seed, Purpose::Leaves, i),
        );
    }
}

/// A leaf about the end of a bough.
fn leaf(out: &mut Builder, tip: Vec3, rng: &mut Stream) {
    let around = direction(rng);
    let center = add(tip, scale(around, 0.62 * libm::cbrt(between(rng, 0.02, 1.0))));
    // Leaves face outward and up, each in its own way.
    let normal = unit(add(add(around, [0.0, 0.8, 0.0]), scale(direction(rng), 0.9)));
    let along = unit(cross(normal, direction(rng)));
    let across = cross(normal, along);
    let size = between(rng, 0.055, 0.1);
    let color = mix(
        mix([0.10, 0.42, 0.10], [0.45, 0.72, 0.16], between(rng, 0.0, 1.0) as f32),
        [0.9, 0.6, 0.1],
        0.25 * libm::pow(between(rng, 0.0, 1.0), 4.0) as f32,
    );
    let alpha = between(rng, 0.86, 0.985) as f32;
    let paint = Paint { color, alpha, rim: 0.0 };
    // Pointed at both ends and folded along the midrib.
    let at = |x: f64, y: f64| {
        add(
            center,
            add(
                add(scale(along, x * size), scale(across, y * size)),
                scale(normal, 0.35 * y.abs() * size),
            ),
        )
    };
    let outline = [(-0.55, 0.34), (0.1, 0.42), (0.65, 0.22)];
    for side in [-1.0, 1.0] {
        let rim: Vec<Vec3> = outline.iter().map(|&(x, y)| at(x, side * y)).collect();
        let (base, end) = (at(-1.0, 0.0), at(1.15, 0.0));
        out.flat([base, rim[0], rim[1]], paint);
        out.flat([base, rim[1], end], paint);
        out.flat([rim[1], rim[2], end], paint);
    }
    out.geometry.end_object();
}

/// A quaternion w, x, y, z that turns the axes x, y, z into three orthonormal directions of the right hand.
fn turn([x, y, z]: [Vec3; 3]) -> [f32; 4] {
    // The largest of the four parts first: the others are divided by it.
    let squares = [
        1.0 + x[0] + y[1] + z[2],
        1.0 + x[0] - y[1] - z[2],
        1.0 - x[0] + y[1] - z[2],
        1.0 - x[0] - y[1] + z[2],
    ];
    let largest = (1..4).fold(0, |best, k| if squares[k] > squares[best] { k } else { best });
    let (yz, zx, xy) = (
        (y[2] - z[1], y[2] + z[1]),
        (z[0] - x[2], z[0] + x[2]),
        (x[1] - y[0], x[1] + y[0]),
    );
    let parts = match largest {
        0 => [squares[0], yz.0, zx.0, xy.0],
        1 => [yz.0, squares[1], xy.1, zx.1],
        2 => [zx.0, xy.1, squares[2], yz.1],
        _ => [xy.0, zx.1, yz.1, squares[3]],
    };
    parts.map(|p| (p / (2.0 * squares[largest].sqrt())) as f32)
}

/// Normally distributed, by Box and Muller's transform.
fn normal(rng: &mut Stream) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
    radius * libm::cos(between(rng, 0.0, TAU))
}

/// A splat that lies in a surface: wider along it than across, its opacity that of a sigmoid.
fn flat(rng: &mut Stream, at: Vec3, across: Vec3, color: [f32; 3], size: f64) -> Splat {
    let along = unit(cross(across, direction(rng)));
    let off = add(at, scale(direction(rng), 0.3 * size * normal(rng)));
    let width = size * libm::exp(0.5 * normal(rng));
    let shade = 1.0 + 0.12 * normal(rng) as f32;
    let opacity = 1.0 / (1.0 + libm::exp(0.7 - 1.6 * normal(rng)));
    let [r, g, b] = color.map(|c| (c * shade).clamp(0.0, 1.0));
    Splat {
        position: off.map(|x| x as f32),
        scale: [width, width * between(rng, 0.3, 0.9), 0.12 * width].map(|x| x as f32),
        rotation: turn([along, cross(across, along), across]),
        rgba: [r, g, b, opacity as f32],
    }
}

/// A leaf of the plant, in splats.
fn leaf_of_splats(all: &mut Vec<Splat>, seed: u64, leaf: u64) {
    const LEAF: u64 = 330;
    let mut shape = random(seed, Purpose::Splats, (2 << 32) + leaf);
    let angle = 2.399_963_2 * leaf as f64;
    let rise = between(&mut shape, 0.35, 1.25);
    let length = between(&mut shape, 0.7, 1.25);
    let width = between(&mut shape, 0.1, 0.17);
    let young = between(&mut shape, 0.0, 1.0) as f32;
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    // Up out of the pot, over, and down again under its weight.
    let rib = |t: f64| {
        let reach = length * t * (0.55 + 0.35 * t);
        [
            reach * cos,
            0.62 + 1.7 * rise * t - 1.15 * rise * t * t * t,
            reach * sin,
        ]
    };
    for i in 0..LEAF {
        let mut rng = random(seed, Purpose::Splats, (3 << 32) + leaf * LEAF + i);
        let t = between(&mut rng, 0.02, 1.0);
        let side = between(&mut rng, -1.0, 1.0);
        let along = unit(sub(rib(t + 1e-3), rib(t)));
        let flank = unit([-sin, 0.25 * side, cos]);
        let half = width * libm::sin(PI * t.powf(0.75)).max(0.05);
        let at = add(
            rib(t),
            add(scale(flank, side * half), [0.0, 0.3 * half * side.abs(), 0.0]),
        );
        let across = unit(cross(along, flank));
        let lamp = (0.45 + 0.55 * dot(across, unit([-0.45, 0.75, 0.5])).abs()) as f32;
        let vein = (1.0 - 6.0 * side.abs()).max(0.0) as f32;
        let color = mix(
            mix([0.05, 0.27, 0.09], [0.42, 0.62, 0.2], young),
            [0.75, 0.8, 0.5],
            0.6 * vein,
        );
        all.push(flat(&mut rng, at, across, color.map(|c| c * lamp), 0.032));
    }
}

/// A plant in a pot on a table, as a capture gives it: flat Gaussians along the surfaces, most of them faint, and a
/// haze of large ones that stands for what no camera saw well.
fn splats(out: &mut Builder, seed: u64) {
    const TABLE: u64 = 5000;
    const POT: u64 = 9000;
    const LEAVES: u64 = 70;
    const HAZE: u64 = 900;
    // Radius and height of the pot's outline.
    const OUTLINE: [[f64; 2]; 6] = [
        [0.0, 0.02],
        [0.3, 0.0],
        [0.42, 0.3],
        [0.5, 0.62],
        [0.55, 0.7],
        [0.44, 0.66],
    ];
    let all = &mut out.geometry.splats;
    for i in 0..TABLE {
        let mut rng = random(seed, Purpose::Splats, i);
        let (radius, angle) = (1.7 * between(&mut rng, 0.0, 1.0).sqrt(), between(&mut rng, 0.0, TAU));
        let at = [radius * libm::cos(angle), 0.0, radius * libm::sin(angle)];
        let grain = (0.5 + 0.5 * libm::sin(23.0 * at[0] + 2.0 * libm::sin(5.0 * at[2]))) as f32;
        let color = mix([0.36, 0.22, 0.13], [0.56, 0.38, 0.24], grain);
        all.push(flat(&mut rng, at, [0.0, 1.0, 0.0], color, 0.04));
    }
    for i in 0..POT {
        let mut rng = random(seed, Purpose::Splats, (1 << 32) + i);
        let (v, angle) = (between(&mut rng, 0.0, 1.0), between(&mut rng, 0.0, TAU));
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let ([r, y], [r1, y1]) = (smooth(&OUTLINE, v), smooth(&OUTLINE, (v + 1e-3).min(1.0)));
        let across = unit([(y1 - y + 1e-9) * cos, r - r1, (y1 - y + 1e-9) * sin]);
        let glaze = (0.5 + 0.5 * libm::sin(9.0 * y + 3.0 * cos)) as f32;
        let lamp = (0.55 + 0.45 * dot(across, unit([-0.45, 0.75, 0.5]))).clamp(0.2, 1.0) as f32;
        let color = mix([0.12, 0.28, 0.42], [0.72, 0.76, 0.74], glaze).map(|c| c * lamp);
        all.push(flat(&mut rng, [r * cos, y, r * sin], across, color, 0.03));
    }
    for leaf in 0..LEAVES {
        leaf_of_splats(all, seed, leaf);
    }
    for i in 0..HAZE {
        let mut rng = random(seed, Purpose::Splats, (4 << 32) + i);
        let at = scale(direction(&mut rng), 1.7 * libm::cbrt(between(&mut rng, 0.05, 1.0)));
        let mut splat = flat(
            &mut rng,
            add(at, [0.0, 0.9, 0.0]),
            [0.0, 0.0, 1.0],
            [0.42, 0.42, 0.36],
            0.16,
        );
        splat.scale[2] = splat.scale[1];
        splat.rgba[3] *= 0.12;
        all.push(splat);
    }
}

/// Spheres that cut into one another.
fn spheres(out: &mut Builder) {
    const COLORS: [[f32; 3]; 7] = [
        [0.95, 0.25, 0.2],
        [0.98, 0.65, 0.1],
        [0.85, 0.85, 0.2],
        [0.2, 0.75, 0.3],
        [0.1, 0.65, 0.8],
        [0.25, 0.35, 0.95],
        [0.75, 0.3, 0.85],
    ];
    for (i, &color) in COLORS.iter().enumerate() {
        let angle = TAU * i as f64 / COLORS.len() as f64;
        let center = [
            1.0 * libm::cos(angle),
            0.25 * libm::sin(2.0 * angle),
            1.0 * libm::sin(angle),
        ];
        out.sphere(
            center,
            0.72,
            Paint {
                color,
                alpha: 0.25 + 0.06 * (i % 4) as f32,
                rim: 0.45,
            },
        );
        out.geometry.end_object();
    }
    out.sphere(
        [0.0, 0.0, 0.0],
        0.62,
        Paint {
            color: [0.95, 0.95, 0.98],
            alpha: 0.55,
            rim: 0.4,
        },
    );
}

/// Gauze in narrow folds, far apart: bunches of many fragments within a hundredth of their distance, several times as
/// far as the one before.
fn curtains(out: &mut Builder, seed: u64) {
    const COLORS: [[f32; 3]; 5] = [
        [0.9, 0.35, 0.3],
        [0.95, 0.8, 0.35],
        [0.35, 0.75, 0.45],
        [0.3, 0.5, 0.9],
        [0.7, 0.4, 0.8],
    ];
    const DISTANCES: [f64; 5] = [1.2, 2.9, 7.0, 15.0, 34.0];
    const SHEETS: u64 = 7;
    const STRIPS: u64 = 9;
    for (curtain, (&color, &distance)) in COLORS.iter().zip(&DISTANCES).enumerate() {
        for sheet in 0..SHEETS {
            for strip in 0..STRIPS {
                let mut rng = random(
                    seed,
                    Purpose::Curtains,
                    (curtain as u64 * SHEETS + sheet) * STRIPS + strip,
                );
                let alpha = between(&mut rng, 0.05, 0.35) as f32;
                let shade = between(&mut rng, 0.0, 1.0) as f32;
                let left = -0.55 + 1.1 * (strip as f64 + between(&mut rng, -0.4, 0.4)) / STRIPS as f64;
                let width = between(&mut rng, 0.08, 0.24);
                let (top, bottom) = (between(&mut rng, 0.2, 0.4), between(&mut rng, -0.4, -0.2));
                let depth = distance * (1.0 + 0.012 * (sheet as f64 + between(&mut rng, 0.0, 1.0)) / SHEETS as f64);
                let (fold, phase) = (between(&mut rng, 20.0, 60.0), between(&mut rng, 0.0, TAU));
                let paint = Paint {
                    color: mix(color, [1.0, 1.0, 1.0], 0.4 * shade),
                    alpha,
                    rim: 0.0,
                };
                out.surface(24, 2, paint, |u, v| {
                    let x = left + width * u;
                    let z = depth * (1.0 + 0.002 * libm::sin(fold * x + phase));
                    [x * z, (bottom + (top - bottom) * v) * z, -z]
                });
                out.geometry.end_object();
            }
        }
    }
}

/// Forty spheres of all sizes and opacities within a ball, most of them cut by several others: as the camera moves,
/// fragments change places everywhere.
fn sphere_cluster(out: &mut Builder, seed: u64) {
    for i in 0..40 {
        let mut rng = random(seed, Purpose::Spheres, i);
        let center = scale(direction(&mut rng), 1.35 * libm::cbrt(between(&mut rng, 0.0, 1.0)));
        let radius = between(&mut rng, 0.25, 0.6);
        let color = [0, 1, 2].map(|_| between(&mut rng, 0.1, 0.98) as f32);
        let paint = Paint {
            color,
            alpha: between(&mut rng, 0.1, 0.6) as f32,
            rim: 0.3,
        };
        out.sphere(center, radius, paint);
        out.geometry.end_object();
    }
}

/// Rows of pots with a lid, a spout and a handle.
fn teapots(out: &mut Builder) {
    const COLORS: [[f32; 3]; 6] = [
        [0.9, 0.25, 0.2],
        [0.95, 0.6, 0.15],
        [0.35, 0.7, 0.25],
        [0.15, 0.65, 0.75],
        [0.25, 0.4, 0.9],
        [0.7, 0.3, 0.8],
    ];
    // Radius and height of the body's outline, from the foot to the rim.
    const BODY: [[f64; 2]; 9] = [
        [0.0, 0.03],
        [0.30, 0.0],
        [0.36, 0.02],
        [0.52, 0.16],
        [0.60, 0.36],
        [0.55, 0.56],
        [0.42, 0.68],
        [0.36, 0.72],
        [0.38, 0.75],
    ];
    const LID: [[f64; 2]; 8] = [
        [0.37, 0.74],
        [0.33, 0.79],
        [0.20, 0.85],
        [0.07, 0.88],
        [0.05, 0.92],
        [0.10, 0.97],
        [0.08, 1.02],
        [0.0, 1.04],
    ];
    for (i, &color) in COLORS.iter().enumerate() {
        let (column, row) = ((i % 3) as f64 - 1.0, (i / 3) as f64);
        let turn = -0.45 + 0.35 * column + 0.5 * row;
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let origin = [column * 1.75 + 0.25 * row, -0.25, 0.9 - 2.2 * row];
        let place = |p: Vec3| add(origin, [cos * p[0] + sin * p[2], p[1], cos * p[2] - sin * p[0]]);
        let paint = Paint {
            color,
            alpha: 0.26 + 0.04 * i as f32,
            rim: 0.5,
        };
        for outline in [BODY.as_slice(), LID.as_slice()] {
            out.surface(64, 40, paint, |u, v| {
                let [r, y] = smooth(outline, v);
                place([r * libm::cos(TAU * u), y, r * libm::sin(TAU * u)])
            });
        }
        // The spout rises from the belly to a lip as high as the rim; the handle is an ear from shoulder to belly.
        out.tube(
            paint,
            place,
            |v| (0.5 + 0.52 * v, 0.26 + 0.1 * v + 0.40 * v * v * (1.6 - 0.6 * v)),
            |v| 0.135 - 0.115 * v + 0.035 * v * v * v,
        );
        let ear = |v: f64| {
            let angle = 0.62 * PI + 0.86 * PI * v;
            (-0.50 + 0.44 * libm::cos(angle), 0.40 + 0.24 * libm::sin(angle))
        };
        out.tube(paint, place, ear, |_| 0.05);
        out.geometry.end_object();
    }
}

/// A smooth curve through points (Catmull–Rom), v in [0, 1]; the radius never below 0.
fn smooth(points: &[[f64; 2]], v: f64) -> [f64; 2] {
    let last = points.len() - 1;
    let s = v.clamp(0.0, 1.0) * last as f64;
    let k = (s.floor() as usize).min(last - 1);
    let t = s - k as f64;
    let at = |i: isize| points[(k as isize + i).clamp(0, last as isize) as usize];
    let [p0, p1, p2, p3] = [at(-1), at(0), at(1), at(2)];
    let value = |c: usize| {
        let (a, b) = ((p2[c] - p0[c]) / 2.0, (p3[c] - p1[c]) / 2.0);
        let d = p2[c] - p1[c];
        p1[c] + t * (a + t * (3.0 * d - 2.0 * a - b + t * (a + b - 2.0 * d)))
    };
    [value(0).max(0.0), value(1)]
}
