//! A software rasteriser: surfaces, particles and Gaussian splats to the fragments of every pixel.
//!
//! Samples lie at pixel centres. Vertices are snapped to 1/256 of a pixel and edges are decided in whole numbers under
//! the top-left rule, so a sample on an edge that two triangles share belongs to exactly one of them. Both sides of a
//! surface are drawn.
//!
//! A picture is cut into bands of rows; each band is rasterised twice, first to count its fragments and then to fill in
//! arrays of exactly the size needed. Fragments of a pixel stand in the order of the primitives (triangles, textured
//! triangles, particles, splats), whatever the number of threads.

use super::camera::{Vec3, View};
use super::splat::{ScreenSplat, Splat};
use super::texture::TexturedMaterial;
use super::{MAX_FRAGMENTS, SceneError};
use crate::numeric::rng::stream;
use crate::pixel::FragmentList;
use rand::RngExt;
use rayon::prelude::*;
use std::ops::Range;

/// Corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Place [scene units].
    pub position: [f32; 3],
    /// Linear colour (shaded already), each channel 0 or more, and alpha in [0, 1].
    pub rgba: [f32; 4],
}

/// A triangle; colour and alpha are interpolated in perspective. It is opaque where all its corners have alpha 1.
pub type Triangle = [Vertex; 3];

/// A soft particle that faces the camera: at distance r from its centre alpha is a (1 − r²/R²)².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// Centre [scene units].
    pub position: [f32; 3],
    /// Radius R [scene units].
    pub radius: f32,
    /// Linear colour and the alpha a of its centre, in [0, 1].
    pub rgba: [f32; 4],
}

/// A triangle whose colour and alpha are multiplied by textures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexturedTriangle {
    /// Corners, with the colour and alpha that textures multiply.
    pub corners: Triangle,
    /// Texture coordinates of the corners, v downwards.
    pub uv: [[f32; 2]; 3],
    /// Place in [`Geometry::materials`].
    pub material: u32,
}

/// What is to be seen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Geometry {
    /// Surfaces.
    pub triangles: Vec<Triangle>,
    /// Surfaces with textures.
    pub textured: Vec<TexturedTriangle>,
    /// Their textures.
    pub materials: Vec<TexturedMaterial>,
    /// Soft particles; never opaque.
    pub particles: Vec<Particle>,
    /// Gaussian splats; never opaque.
    pub splats: Vec<Splat>,
    /// Where objects end among the triangles and among the textured triangles, in rising order; what comes after the
    /// last is one object more. Every particle and every splat is an object.
    pub object_ends: Vec<[usize; 2]>,
}

/// What random draw orders are drawn for.
const DRAW_ORDER: u64 = 0x0d0e;

impl Geometry {
    fn surfaces(&self) -> [usize; 2] {
        [self.triangles.len(), self.textured.len()]
    }

    /// Ends the object that the last surfaces belong to.
    pub fn end_object(&mut self) {
        self.object_ends.push(self.surfaces());
    }

    /// The same geometry with its objects in a random order, as a renderer draws them that does not sort; surfaces stay
    /// before textured surfaces, and these before particles and splats.
    pub fn in_random_order(self, seed: u64) -> Self {
        let mut rng = stream(seed, DRAW_ORDER, 0);
        let mut shuffle = |n: usize| {
            let mut order: Vec<usize> = (0..n).collect();
            for i in (1..n).rev() {
                order.swap(i, (rng.random::<f64>() * (i + 1) as f64) as usize);
            }
            order
        };
        let all = self.surfaces();
        let mut starts = vec![[0, 0]];
        starts.extend(self.object_ends.iter().copied().filter(|&end| end != all));
        let mut out = Self::default();
        for object in shuffle(starts.len()) {
            let ([first, first_textured], end) = (starts[object], starts.get(object + 1).unwrap_or(&all));
            out.triangles.extend_from_slice(&self.triangles[first..end[0]]);
            out.textured.extend_from_slice(&self.textured[first_textured..end[1]]);
            out.end_object();
        }
        out.particles = shuffle(self.particles.len())
            .into_iter()
            .map(|i| self.particles[i])
            .collect();
        out.splats = shuffle(self.splats.len()).into_iter().map(|i| self.splats[i]).collect();
        out.materials = self.materials;
        out
    }
}

/// Subpixel steps in a pixel.
const STEPS: i64 = 256;
/// Greatest distance of a snapped vertex from the picture's centre \[pixels\]; products of two such distances in
/// subpixel steps fit 64 bits.
const GUARD: f64 = (1 << 20) as f64;
/// Rows of a band.
const BAND: usize = 8;
/// Alpha below which a particle's rim is left out.
const FAINT: f32 = 1.0 / 512.0;

/// A corner on its way to the screen: camera coordinates, colour, texture coordinates.
#[derive(Clone, Copy)]
struct Corner {
    at: Vec3,
    rgba: [f32; 4],
    uv: [f32; 2],
}

/// A triangle on the screen, its area positive.
struct ScreenTriangle {
    /// Corners [subpixel steps].
    xy: [[i32; 2]; 3],
    /// 1 / view depth of the corners.
    inverse_z: [f64; 3],
    rgba: [[f32; 4]; 3],
    uv: [[f32; 2]; 3],
    material: Option<u32>,
    flat: bool,
    /// Whether any of its samples may be opaque.
    opaque: bool,
}

/// A particle on the screen.
struct ScreenParticle {
    /// Centre and radius \[pixels\].
    center: (f64, f64),
    radius: f64,
    view_z: f32,
    rgba: [f32; 4],
}

/// All that is on the screen: triangles, then particles, then splats, counted through.
struct Screen<'a> {
    triangles: Vec<ScreenTriangle>,
    particles: Vec<ScreenParticle>,
    splats: Vec<ScreenSplat>,
    materials: &'a [TexturedMaterial],
}

/// Fragments of a geometry seen through a camera.
///
/// An opaque fragment (alpha 1) is kept, and what lies strictly behind the nearest opaque one of its pixel is left out.
///
/// # Errors
/// [`SceneError::TooManyFragments`] before memory for them is taken.
pub(super) fn rasterise(geometry: &Geometry, view: &View) -> Result<FragmentList, SceneError> {
    let screen = Screen::new(geometry, view);
    let (width, height) = (view.width as usize, view.height as usize);
    let bins = Bins::new(&screen, height);
    let far = view.planes.far();
    let counted: Vec<(Vec<u32>, Vec<f32>)> = (0..bins.bands())
        .into_par_iter()
        .map(|band| count_band(&screen, bins.of(band), rows_of(band, height), width, far))
        .collect();

    let total: u64 = counted
        .par_iter()
        .map(|(counts, _)| counts.iter().map(|&c| u64::from(c)).sum::<u64>())
        .sum();
    if total > MAX_FRAGMENTS {
        return Err(SceneError::TooManyFragments {
            fragments: total,
            pixels: (width * height) as u64,
        });
    }
    let mut offsets = Vec::with_capacity(width * height + 1);
    offsets.push(0u64);
    let mut last = 0;
    for (counts, _) in &counted {
        offsets.extend(counts.iter().map(|&c| {
            last += u64::from(c);
            last
        }));
    }
    let mut view_z: Vec<f32> = zeros(total)?;
    let mut alpha: Vec<f32> = zeros(total)?;
    let mut color: Vec<[f32; 3]> = zeros(total)?;
    let mut jobs = Vec::with_capacity(counted.len());
    let mut rest = (view_z.as_mut_slice(), alpha.as_mut_slice(), color.as_mut_slice());
    for (band, (counts, nearest)) in counted.into_iter().enumerate() {
        let n: usize = counts.iter().map(|&c| c as usize).sum();
        let (z, z_rest) = rest.0.split_at_mut(n);
        let (a, a_rest) = rest.1.split_at_mut(n);
        let (c, c_rest) = rest.2.split_at_mut(n);
        rest = (z_rest, a_rest, c_rest);
        jobs.push((band, counts, nearest, z, a, c));
    }
    jobs.into_par_iter()
        .for_each(|(band, counts, nearest, z_out, a_out, c_out)| {
            let mut next = Vec::with_capacity(counts.len());
            let mut at = 0usize;
            for &c in &counts {
                next.push(at);
                at += c as usize;
            }
            for &i in bins.of(band) {
                screen.draw(i, width, &rows_of(band, height), |p, z, rgba| {
                    if z <= limit(&nearest, p, far) {
                        let at = next[p];
                        z_out[at] = z;
                        a_out[at] = rgba[3];
                        c_out[at] = [rgba[0], rgba[1], rgba[2]];
                        next[p] += 1;
                    }
                });
            }
        });
    let content = |source| SceneError::Content {
        path: "the rasterised scene".into(),
        source,
    };
    let list = FragmentList::new(offsets, view_z, alpha, Some(color)).map_err(content)?;
    Ok(list
        .with_size(view.width, view.height)
        .map_err(content)?
        .with_planes(view.planes))
}

/// The rows of a band.
fn rows_of(band: usize, height: usize) -> Range<usize> {
    band * BAND..((band + 1) * BAND).min(height)
}

/// Number of fragments of each pixel of a band, and the depth of its nearest opaque one; no depths where nothing is
/// opaque.
fn count_band(
    screen: &Screen<'_>,
    primitives: &[u32],
    rows: Range<usize>,
    width: usize,
    far: f32,
) -> (Vec<u32>, Vec<f32>) {
    let mut nearest = Vec::new();
    if screen.triangles.iter().any(|t| t.opaque) {
        nearest.resize(rows.len() * width, far);
        let triangles = primitives.iter().filter_map(|&i| screen.triangles.get(i as usize));
        for t in triangles.filter(|t| t.opaque) {
            t.draw(screen.materials, width, &rows, |p, z, rgba| {
                if rgba[3] >= 1.0 {
                    nearest[p] = nearest[p].min(z);
                }
            });
        }
    }
    let mut counts = vec![0u32; rows.len() * width];
    for &i in primitives {
        screen.count(i, width, &rows, |p, z| {
            counts[p] += u32::from(z <= limit(&nearest, p, far))
        });
    }
    (counts, nearest)
}

/// An array of zeros for so many fragments.
///
/// # Errors
/// [`SceneError::OutOfMemory`].
fn zeros<T: Default + Clone>(fragments: u64) -> Result<Vec<T>, SceneError> {
    let mut array = Vec::new();
    let reserved = array.try_reserve_exact(fragments as usize);
    reserved.map_err(|_| SceneError::OutOfMemory { fragments })?;
    array.resize(fragments as usize, T::default());
    Ok(array)
}

/// View depth beyond which a fragment of a pixel is not seen.
fn limit(nearest: &[f32], pixel: usize, far: f32) -> f32 {
    nearest.get(pixel).copied().unwrap_or(far)
}

/// Which primitives touch which band, in their order.
struct Bins {
    offsets: Vec<usize>,
    members: Vec<u32>,
}

impl Bins {
    fn new(screen: &Screen<'_>, height: usize) -> Self {
        let bands = height.div_ceil(BAND);
        let mut offsets = vec![0usize; bands + 1];
        let touched = |i: u32| {
            let rows = screen.rows(i, height);
            if rows.is_empty() {
                0..0
            } else {
                rows.start / BAND..(rows.end - 1) / BAND + 1
            }
        };
        for i in 0..screen.len() {
            for band in touched(i) {
                offsets[band + 1] += 1;
            }
        }
        for band in 0..bands {
            offsets[band + 1] += offsets[band];
        }
        let mut next = offsets.clone();
        let mut members = vec![0u32; offsets[bands]];
        for i in 0..screen.len() {
            for band in touched(i) {
                members[next[band]] = i;
                next[band] += 1;
            }
        }
        Self { offsets, members }
    }

    fn bands(&self) -> usize {
        self.offsets.len() - 1
    }

    fn of(&self, band: usize) -> &[u32] {
        &self.members[self.offsets[band]..self.offsets[band + 1]]
    }
}

/// A primitive by its number.
enum Primitive<'a> {
    Triangle(&'a ScreenTriangle),
    Particle(&'a ScreenParticle),
    Splat(&'a ScreenSplat),
}

impl<'a> Screen<'a> {
    fn new(geometry: &'a Geometry, view: &View) -> Self {
        let plain = geometry.triangles.par_chunks(4096).flat_map_iter(|chunk| {
            let mut out = Vec::with_capacity(chunk.len());
            for triangle in chunk {
                to_screen(triangle, [[0.0; 2]; 3], None, view, &mut out);
            }
            out
        });
        let mut triangles: Vec<ScreenTriangle> = plain.collect();
        for t in &geometry.textured {
            to_screen(&t.corners, t.uv, Some(t.material), view, &mut triangles);
        }
        Self {
            triangles,
            particles: geometry.particles.iter().filter_map(|p| particle(p, view)).collect(),
            splats: geometry.splats.par_iter().filter_map(|s| s.project(view)).collect(),
            materials: &geometry.materials,
        }
    }

    fn len(&self) -> u32 {
        (self.triangles.len() + self.particles.len() + self.splats.len()) as u32
    }

    fn primitive(&self, i: u32) -> Primitive<'_> {
        let i = i as usize;
        let (triangles, particles) = (self.triangles.len(), self.particles.len());
        if i < triangles {
            Primitive::Triangle(&self.triangles[i])
        } else if i < triangles + particles {
            Primitive::Particle(&self.particles[i - triangles])
        } else {
            Primitive::Splat(&self.splats[i - triangles - particles])
        }
    }

    /// Rows of the picture that a primitive may touch.
    fn rows(&self, i: u32, height: usize) -> std::ops::Range<usize> {
        let round = |center: f64, half: f64| ((center - half).floor() as i64, (center + half).ceil() as i64);
        let (lo, hi) = match self.primitive(i) {
            Primitive::Triangle(t) => {
                let y = t.xy.map(|c| i64::from(c[1]));
                (
                    y.into_iter().min().unwrap_or(0).div_euclid(STEPS),
                    y.into_iter().max().unwrap_or(0).div_euclid(STEPS) + 1,
                )
            }
            Primitive::Particle(p) => round(p.center.1, p.radius),
            Primitive::Splat(s) => round(s.center.1, s.half_height + 0.5),
        };
        lo.clamp(0, height as i64) as usize..hi.clamp(0, height as i64) as usize
    }

    /// Calls `f(pixel within the rows, view_z, rgba)` for every sample that a primitive covers.
    fn draw(&self, i: u32, width: usize, rows: &std::ops::Range<usize>, f: impl FnMut(usize, f32, [f32; 4])) {
        match self.primitive(i) {
            Primitive::Triangle(t) => t.draw(self.materials, width, rows, f),
            Primitive::Particle(p) => p.draw(width, rows, f),
            Primitive::Splat(s) => s.draw(width, rows, f),
        }
    }

    /// Calls `f(pixel within the rows, view_z)` for the same samples as [`Self::draw`].
    fn count(&self, i: u32, width: usize, rows: &std::ops::Range<usize>, mut f: impl FnMut(usize, f32)) {
        match self.primitive(i) {
            Primitive::Splat(s) => s.count(width, rows, |p| f(p, s.view_z)),
            _ => self.draw(i, width, rows, |p, z, _| f(p, z)),
        }
    }
}

impl ScreenTriangle {
    fn draw(
        &self,
        materials: &[TexturedMaterial],
        width: usize,
        rows: &std::ops::Range<usize>,
        mut f: impl FnMut(usize, f32, [f32; 4]),
    ) {
        let material = self.material.map(|m| &materials[m as usize]);
        let xy = self.xy.map(|c| c.map(i64::from));
        let edge = |i: usize| (xy[(i + 1) % 3], xy[(i + 2) % 3]);
        let area = cross_at(xy[0], xy[1], xy[2]);
        let lo_y = xy
            .iter()
            .map(|c| c[1])
            .min()
            .unwrap_or(0)
            .div_euclid(STEPS)
            .max(rows.start as i64);
        let hi_y = (xy.iter().map(|c| c[1]).max().unwrap_or(0).div_euclid(STEPS) + 1).min(rows.end as i64);
        let z = self.inverse_z.map(|q| (1.0 / q) as f32);
        let (nearest, farthest) = (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]));
        let per_area = 1.0 / area as f64;
        for y in lo_y..hi_y {
            // Samples from..to of this row lie inside all three edges.
            let left = [STEPS / 2, y * STEPS + STEPS / 2];
            let (mut from, mut to) = (0i64, width as i64);
            let mut weight = [0i64; 3];
            let mut step = [0i64; 3];
            for i in 0..3 {
                let (a, b) = edge(i);
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                weight[i] = cross_at(a, b, left);
                step[i] = -dy * STEPS;
                let top_or_left = dy < 0 || (dy == 0 && dx > 0);
                let inside = weight[i] - i64::from(!top_or_left);
                match step[i].signum() {
                    1 => from = from.max(-inside.div_euclid(step[i])),
                    -1 => to = to.min(inside.div_euclid(-step[i]) + 1),
                    _ if inside < 0 => to = 0,
                    _ => {}
                }
            }
            if from >= to {
                continue;
            }
            // 1/z, and colour over z, are linear on the screen.
            let share = |i: usize, x: i64| (weight[i] + step[i] * x) as f64 * per_area * self.inverse_z[i];
            let row = (y as usize - rows.start) * width;
            for x in from..to {
                let w = [share(0, x), share(1, x), share(2, x)];
                let z = 1.0 / (w[0] + w[1] + w[2]);
                let rgba = if self.flat {
                    self.rgba[0]
                } else {
                    let mixed: [f32; 4] = std::array::from_fn(|c| {
                        let sum: f64 = (0..3).map(|i| w[i] * f64::from(self.rgba[i][c])).sum();
                        (sum * z).max(0.0) as f32
                    });
                    [mixed[0], mixed[1], mixed[2], mixed[3].min(1.0)]
                };
                let rgba = match material {
                    None => rgba,
                    Some(material) => {
                        let uv = [0, 1].map(|c| {
                            let sum: f64 = (0..3).map(|i| w[i] * f64::from(self.uv[i][c])).sum();
                            (sum * z) as f32
                        });
                        match material.shade(rgba, uv) {
                            Some(rgba) => rgba,
                            None => continue,
                        }
                    }
                };
                f(row + x as usize, (z as f32).clamp(nearest, farthest), rgba);
            }
        }
    }
}

impl ScreenParticle {
    fn draw(&self, width: usize, rows: &std::ops::Range<usize>, mut f: impl FnMut(usize, f32, [f32; 4])) {
        let per_radius = 1.0 / (self.radius * self.radius);
        let [r, g, b, a] = self.rgba;
        for y in rows.clone() {
            let dy = y as f64 + 0.5 - self.center.1;
            let half = (self.radius * self.radius - dy * dy).max(0.0).sqrt();
            let from = (self.center.0 - half - 0.5).ceil().clamp(0.0, width as f64) as usize;
            let to = (self.center.0 + half + 0.5).floor().clamp(0.0, width as f64) as usize;
            for x in from..to {
                let dx = x as f64 + 0.5 - self.center.0;
                let fall = (1.0 - (dx * dx + dy * dy) * per_radius).max(0.0) as f32;
                let alpha = a * fall * fall;
                if alpha >= FAINT {
                    f((y - rows.start) * width + x, self.view_z, [r, g, b, alpha]);
                }
            }
        }
    }
}

/// Twice the signed area of (a, b, p).
fn cross_at(a: [i64; 2], b: [i64; 2], p: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

fn particle(p: &Particle, view: &View) -> Option<ScreenParticle> {
    let at = view.to_camera(p.position);
    let view_z = at[2] as f32;
    if !(view_z >= view.planes.near() && view_z <= view.planes.far()) {
        return None;
    }
    let radius = view.focal * f64::from(p.radius) / at[2];
    let center = view.to_pixel(at);
    (radius > 0.0 && radius.is_finite()).then_some(ScreenParticle {
        center,
        radius,
        view_z,
        rgba: p.rgba,
    })
}

/// Projects a triangle, cut at the near plane and at the guard band, as a fan.
fn to_screen(
    triangle: &Triangle,
    uv: [[f32; 2]; 3],
    material: Option<u32>,
    view: &View,
    out: &mut Vec<ScreenTriangle>,
) {
    let corners: [Corner; 3] = std::array::from_fn(|i| Corner {
        at: view.to_camera(triangle[i].position),
        rgba: triangle[i].rgba,
        uv: uv[i],
    });
    let (near, far) = (f64::from(view.planes.near()), f64::from(view.planes.far()));
    if corners.iter().all(|c| c.at[2] < near) || corners.iter().all(|c| c.at[2] > far) {
        return;
    }
    // |pixel offset from the centre| < GUARD  <=>  guard z − |x| > 0
    let guard = GUARD / view.focal;
    let planes: [&dyn Fn(Vec3) -> f64; 5] = [
        &|p| p[2] - near,
        &|p| guard * p[2] - p[0],
        &|p| guard * p[2] + p[0],
        &|p| guard * p[2] - p[1],
        &|p| guard * p[2] + p[1],
    ];
    let whole = corners.iter().all(|c| planes.iter().all(|plane| plane(c.at) >= 0.0));
    let polygon = if whole {
        corners.to_vec()
    } else {
        planes
            .iter()
            .fold(corners.to_vec(), |polygon, plane| cut(&polygon, *plane))
    };
    let flat = triangle[0].rgba == triangle[1].rgba && triangle[0].rgba == triangle[2].rgba;
    let opaque = material.is_some() || triangle.iter().all(|v| v.rgba[3] >= 1.0);
    let snap = |c: &Corner| {
        let (x, y) = view.to_pixel(c.at);
        // Rounding of far cut points may leave the guard band a little; whole-number products still fit at twice its
        // size.
        [x, y]
            .map(|v| v.clamp(-2.0 * GUARD, 2.0 * GUARD))
            .map(|v| (v * STEPS as f64).round() as i32)
    };
    for i in 1..polygon.len().max(2) - 1 {
        let mut fan = [polygon[0], polygon[i], polygon[i + 1]];
        let mut xy = [snap(&fan[0]), snap(&fan[1]), snap(&fan[2])];
        let [a, b, c] = xy.map(|c| c.map(i64::from));
        match cross_at(a, b, c) {
            0 => continue,
            i64::MIN..0 => {
                fan.swap(1, 2);
                xy.swap(1, 2);
            }
            _ => {}
        }
        let sides = |k: usize, size: u32| {
            let (lo, hi) = (
                xy.iter().map(|c| c[k]).min().unwrap_or(0),
                xy.iter().map(|c| c[k]).max().unwrap_or(0),
            );
            hi >= 0 && i64::from(lo) <= i64::from(size) * STEPS
        };
        if sides(0, view.width) && sides(1, view.height) {
            out.push(ScreenTriangle {
                xy,
                inverse_z: fan.map(|c| 1.0 / c.at[2].max(near)),
                rgba: fan.map(|c| c.rgba),
                uv: fan.map(|c| c.uv),
                material,
                flat,
                opaque,
            });
        }
    }
}

/// The part of a polygon where `plane` is not negative. A cut point is always computed from the inner end of its edge,
/// so that two triangles cut a shared edge at the same point.
fn cut(polygon: &[Corner], plane: &dyn Fn(Vec3) -> f64) -> Vec<Corner> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (da, db) = (plane(a.at), plane(b.at));
        if (da >= 0.0) != (db >= 0.0) {
            let (inner, outer, t) = if da >= 0.0 {
                (a, b, da / (da - db))
            } else {
                (b, a, db / (db - da))
            };
            out.push(Corner {
                at: std::array::from_fn(|k| inner.at[k] + t * (outer.at[k] - inner.at[k])),
                rgba: std::array::from_fn(|k| inner.rgba[k] + t as f32 * (outer.rgba[k] - inner.rgba[k])),
                uv: std::array::from_fn(|k| inner.uv[k] + t as f32 * (outer.uv[k] - inner.uv[k])),
            });
        }
        if db >= 0.0 {
            out.push(b);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;
    use proptest::prelude::*;
    use std::path::Path;

    fn view(width: u32, height: u32) -> View {
        let camera = Camera {
            position: [0.0, 0.0, 0.0],
            look_at: [0.0, 0.0, -1.0],
            up: [0.0, 1.0, 0.0],
            vertical_fov: 90.0,
            width,
            height,
            near: 0.1,
            far: 100.0,
        };
        camera.view(Path::new("test")).unwrap()
    }

    fn triangle(corners: [[f32; 3]; 3], rgba: [f32; 4]) -> Triangle {
        corners.map(|position| Vertex { position, rgba })
    }

    fn draw(triangles: Vec<Triangle>, view: &View) -> FragmentList {
        rasterise(
            &Geometry {
                triangles,
                ..Geometry::default()
            },
            view,
        )
        .unwrap()
    }

    const GLASS: [f32; 4] = [0.2, 0.4, 0.6, 0.5];

    proptest! {
        /// A fan around a point within the picture covers every sample exactly once, wherever the point lies; the
        /// control turns one triangle away.
        #[test]
        fn shared_edges_give_one_fragment(x in -3.9f32..3.9, y in -3.9f32..3.9, depth in 4.0f32..30.0) {
            let view = view(33, 31);
            let s = 40.0;
            let ring = [[-s, -s], [s, -s], [s, s], [-s, s]].map(|[x, y]| [x, y, -4.0 - s * 0.5]);
            let middle = [x, y, -depth];
            let fan: Vec<_> = (0..4).map(|i| triangle([middle, ring[i], ring[(i + 1) % 4]], GLASS)).collect();
            let list = draw(fan.clone(), &view);
            prop_assert!((0..list.pixels()).all(|p| list.pixel(p).len() == 1));
            let holed = draw(fan[1..].to_vec(), &view);
            prop_assert!((0..holed.pixels()).any(|p| holed.pixel(p).is_empty()));
        }

        /// Any triangle at all, near plane crossings and absurd sizes included, gives a valid list.
        #[test]
        fn nothing_panics(c in prop::array::uniform9(prop_oneof![-10f32..10.0, -1e18f32..1e18])) {
            let t = triangle([[c[0], c[1], c[2]], [c[3], c[4], c[5]], [c[6], c[7], c[8]]], GLASS);
            let list = draw(vec![t], &view(16, 16));
            // Beyond 1e15 the cut points' rounding may fold the polygon.
            prop_assert!(c.iter().any(|x| x.abs() > 10.0) || list.depth_complexity() <= 1);
            prop_assert!(list.view_z().iter().all(|z| (0.1..=100.0).contains(z)));
        }
    }

    /// A slanted plane's depth against the ray's intersection. Tolerance: vertices move by up to 1/512 pixel, here
    /// below 1e-3 of the depth. Control: depth interpolated linearly on the screen, between the depths at the left and
    /// right edge, is further off in the middle.
    #[test]
    fn depth_is_perspective_correct() {
        let view = view(64, 64);
        // The plane z = −5 − x, on which view depth at screen slope t = x/z' is 5/(1 − t).
        let at = |x: f32, y: f32| [x, y, -5.0 - x];
        let list = draw(
            vec![triangle([at(-4.0, -30.0), at(40.0, -30.0), at(-4.0, 60.0)], GLASS)],
            &view,
        );
        let mut seen = 0;
        let mut linear_is_off = 0;
        let depth_at = |column: f64| 5.0 / (1.0 - (column - 32.0) / view.focal);
        for p in 0..list.pixels() {
            let column = (p % 64) as f64 + 0.5;
            let t = (column - 32.0) / view.focal;
            for &z in list.pixel(p).view_z {
                let expected = 5.0 / (1.0 - t);
                assert!(
                    (f64::from(z) - expected).abs() <= 1e-3 * expected,
                    "{z} against {expected}"
                );
                let linear = depth_at(0.5) + (depth_at(63.5) - depth_at(0.5)) * (column - 0.5) / 63.0;
                linear_is_off += usize::from((linear - expected).abs() > 1e-3 * expected);
                seen += 1;
            }
        }
        assert!(seen > 500 && linear_is_off > seen / 2, "{seen}, {linear_is_off}");
    }

    #[test]
    fn opaque_surfaces_hide_what_is_strictly_behind_them() {
        let view = view(8, 8);
        let plane = |z: f32, alpha: f32| {
            triangle(
                [[-99.0, -99.0, -z], [99.0, -99.0, -z], [0.0, 199.0, -z]],
                [0.5, 0.5, 0.5, alpha],
            )
        };
        let list = draw(
            vec![
                plane(4.0, 0.5),
                plane(3.0, 1.0),
                plane(2.0, 0.25),
                plane(3.5, 1.0),
                plane(3.0, 0.75),
            ],
            &view,
        );
        for p in 0..list.pixels() {
            assert_eq!(list.pixel(p).alpha, [1.0, 0.25, 0.75], "pixel {p}");
        }
        let all = draw(vec![plane(4.0, 0.5), plane(3.0, 0.99)], &view);
        assert_eq!(all.depth_complexity(), 2);
    }

    #[test]
    fn a_surface_through_the_near_plane_is_cut_there() {
        let view = view(16, 16);
        let list = draw(
            vec![triangle(
                [[-50.0, -1.0, 5.0], [50.0, -1.0, 5.0], [0.0, -1.0, -50.0]],
                GLASS,
            )],
            &view,
        );
        assert!(!list.is_empty());
        // The floor y = −1 is seen below the horizon only, at depth 1/slope.
        for p in 0..list.pixels() {
            let slope = ((p / 16) as f64 + 0.5 - 8.0) / view.focal;
            for &z in list.pixel(p).view_z {
                assert!(
                    slope > 0.0 && (f64::from(z) * slope - 1.0).abs() < 0.02,
                    "{z} at {slope}"
                );
            }
        }
    }

    #[test]
    fn degenerate_triangles_and_an_empty_scene_leave_nothing() {
        let view = view(8, 8);
        let line = triangle([[-1.0, 0.0, -2.0], [0.0, 0.0, -2.0], [1.0, 0.0, -2.0]], GLASS);
        let point = triangle([[0.1, 0.1, -2.0]; 3], GLASS);
        assert!(draw(vec![line, point], &view).is_empty());
        assert_eq!(draw(Vec::new(), &view).pixels(), 64);
    }
}
