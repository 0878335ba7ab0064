//! A scene as a light sees it: a shadow map of fragments, and points whose transmittance towards the light is known
//! from rays.

use super::camera::{Vec3, View, add, cross, dot, scale, sub};
use super::file::Seen;
use super::raster::{Geometry, rasterise};
use super::{Options, SceneError, SceneFile};
use crate::numeric::rng::stream;
use crate::pixel::{FragmentList, absorbance};
use rand::RngExt;
use rayon::prelude::*;

/// What receivers on surfaces are drawn for.
const PURPOSE: u64 = 0x5ad0;

/// Share of a receiver's depth by which a fragment must lie in front of it to shade it, so that a surface does not
/// shade itself.
pub const DEPTH_BIAS: f64 = 5e-3;

/// A point that light should reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receiver {
    /// Its place in the shadow map [texels from its left upper corner].
    pub texel: (f64, f64),
    /// Its depth along the light's view direction, less [`DEPTH_BIAS`] of it [scene units].
    pub view_z: f32,
    /// Transmittance between light and point: e^−Σ A over the surfaces and particles that the ray between them meets.
    pub transmittance: f64,
}

/// A shadow map and what is asked of it.
#[derive(Debug, Clone)]
pub struct Shadowed {
    /// Fragments that the light sees, a texel a pixel.
    pub map: FragmentList,
    /// Points of the surfaces and particles that the camera sees.
    pub on_surfaces: Vec<Receiver>,
    /// Points of a floor under the scene, row by row, [`Self::floor_size`] a side; none where a point lies outside of
    /// the light's view.
    pub floor: Vec<Option<Receiver>>,
    /// Points of the floor a side.
    pub floor_size: u32,
}

/// How much is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShadowOptions {
    /// Texels of the shadow map a side.
    pub map_size: u32,
    /// Points on surfaces, at most.
    pub on_surfaces: usize,
    /// Points of the floor a side.
    pub floor_size: u32,
}

impl SceneFile {
    /// The shadow map of the scene's light and points with their exact transmittance towards it.
    ///
    /// # Errors
    /// [`SceneError::Field`] where the scene has no light, and as [`super::build`].
    pub fn shadowed(&self, options: &Options, shadow: &ShadowOptions) -> Result<Shadowed, SceneError> {
        let Seen { geometry, view, .. } = self.seen(options)?;
        if !geometry.textured.is_empty() || !geometry.splats.is_empty() {
            return Err(SceneError::field(
                self.path(),
                "shadows",
                "rays meet no textures and no splats".to_owned(),
                "a scene of surfaces without textures, and of particles",
            ));
        }
        let mut light = self.light_camera()?;
        (light.width, light.height) = (shadow.map_size, shadow.map_size);
        let light = light.view(self.path())?;
        let map = rasterise(&geometry, &light)?;
        let seen = rasterise(&geometry, &view)?;
        let rays = Rays::new(&geometry, &light);
        let on_surfaces = points_of(&seen, &view, shadow.on_surfaces);
        let floor = floor_points(&geometry, shadow.floor_size);
        let receivers = |points: Vec<Vec3>| -> Vec<Option<Receiver>> {
            points.into_par_iter().map(|p| rays.receiver(p, &light)).collect()
        };
        Ok(Shadowed {
            map,
            on_surfaces: receivers(on_surfaces).into_iter().flatten().collect(),
            floor: receivers(floor),
            floor_size: shadow.floor_size,
        })
    }
}

/// Places of so many random fragments that a camera sees [scene units].
fn points_of(list: &FragmentList, view: &View, most: usize) -> Vec<Vec3> {
    let mut rng = stream(0, PURPOSE, 0);
    let offsets = list.offsets();
    let point = |_| {
        let i = (rng.random::<f64>() * list.len() as f64) as usize;
        let p = offsets.partition_point(|&o| o <= i as u64) - 1;
        let (x, y) = (p % view.width as usize, p / view.width as usize);
        let z = f64::from(list.view_z()[i]);
        let across = (x as f64 + 0.5 - f64::from(view.width) / 2.0) / view.focal;
        let down = (f64::from(view.height) / 2.0 - y as f64 - 0.5) / view.focal;
        let ray = add(view.forward, add(scale(view.right, across), scale(view.up, down)));
        add(view.eye, scale(ray, z))
    };
    if list.is_empty() {
        Vec::new()
    } else {
        (0..most).map(point).collect()
    }
}

/// Points of a square floor just under a geometry, half as wide again as it is.
fn floor_points(geometry: &Geometry, side: u32) -> Vec<Vec3> {
    let corners = geometry.triangles.iter().flatten().map(|v| v.position);
    let all = corners.chain(geometry.particles.iter().map(|p| p.position));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in all {
        for k in 0..3 {
            low[k] = low[k].min(p[k].into());
            high[k] = high[k].max(p[k].into());
        }
    }
    if low[0] > high[0] {
        return Vec::new();
    }
    let half = 0.75 * (high[0] - low[0]).max(high[2] - low[2]);
    let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[2] + high[2])];
    let y = low[1] - 0.01 * half;
    let at = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0;
    (0..side)
        .flat_map(|row| (0..side).map(move |column| [middle[0] + half * at(column), y, middle[1] + half * at(row)]))
        .collect()
}

/// A geometry in the coordinates of the light, which lies in their origin and looks along z.
struct Rays {
    triangles: Vec<([Vec3; 3], [f32; 3])>,
    /// Centre, radius, alpha.
    particles: Vec<(Vec3, f64, f32)>,
}

impl Rays {
    fn new(geometry: &Geometry, light: &View) -> Self {
        Self {
            triangles: geometry
                .triangles
                .iter()
                .map(|t| (t.map(|v| light.to_camera(v.position)), t.map(|v| v.rgba[3])))
                .collect(),
            particles: geometry
                .particles
                .iter()
                .map(|p| (light.to_camera(p.position), p.radius.into(), p.rgba[3]))
                .collect(),
        }
    }

    /// What reaches a point; none where the light does not see its place.
    fn receiver(&self, point: Vec3, light: &View) -> Option<Receiver> {
        let d = sub(point, light.eye);
        let at = [dot(d, light.right), dot(d, light.up), dot(d, light.forward)];
        let (near, far) = (f64::from(light.planes.near()), f64::from(light.planes.far()));
        if !(near..=far).contains(&at[2]) {
            return None;
        }
        let (x, y) = light.to_pixel(at);
        let inside = |v: f64, size: u32| v >= 0.0 && v < f64::from(size);
        if !inside(x, light.width) || !inside(y, light.height) {
            return None;
        }
        let limit = at[2] * (1.0 - DEPTH_BIAS);
        let ray = [at[0] / at[2], at[1] / at[2], 1.0];
        let seen = |z: f64| z >= near && z < limit;
        let of_triangles = self.triangles.iter().filter_map(|(corners, alpha)| {
            let (z, alpha) = meet(ray, corners, alpha)?;
            seen(z).then(|| absorbance(alpha))
        });
        let of_particles = self.particles.iter().filter_map(|&(center, radius, alpha)| {
            let off = sub(scale(ray, center[2]), center);
            let fall = 1.0 - dot(off, off) / (radius * radius);
            (fall > 0.0 && seen(center[2])).then(|| absorbance(alpha * (fall * fall) as f32))
        });
        let in_front: f64 = of_triangles.sum::<f64>() + of_particles.sum::<f64>();
        Some(Receiver {
            texel: (x, y),
            view_z: limit as f32,
            transmittance: libm::exp(-in_front),
        })
    }
}

/// Where a ray from the origin meets a triangle, as a factor of the ray, and the alpha there.
///
/// # Source
/// Möller, Trumbore, *Fast, Minimum Storage Ray/Triangle Intersection*, JGT 2(1) 1997.
fn meet(ray: Vec3, [a, b, c]: &[Vec3; 3], alpha: &[f32; 3]) -> Option<(f64, f32)> {
    let (ab, ac) = (sub(*b, *a), sub(*c, *a));
    let p = cross(ray, ac);
    let determinant = dot(ab, p);
    if determinant == 0.0 {
        return None;
    }
    let from_a = scale(*a, -1.0);
    let u = dot(from_a, p) / determinant;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = cross(from_a, ab);
    let v = dot(ray, q) / determinant;
    if v < 0.0 || u + v > 1.0 {
        return None;
    }
    let t = dot(ac, q) / determinant;
    let weights = [1.0 - u - v, u, v];
    let alpha: f64 = weights.iter().zip(alpha).map(|(w, &a)| w * f64::from(a)).sum();
    Some((t, alpha.clamp(0.0, 1.0) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::abuffer;
    use crate::scene::open;

    const SMALL: ShadowOptions = ShadowOptions {
        map_size: 256,
        on_surfaces: 300,
        floor_size: 12,
    };

    /// By hand: a ray along z meets a triangle at depth 2, a third of the way to each corner, with the mean alpha.
    #[test]
    fn a_ray_meets_a_triangle() {
        let corners = [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.0, 2.0, 2.0]];
        let (t, alpha) = meet([0.0, 0.0, 1.0], &corners, &[0.3, 0.6, 0.9]).unwrap();
        assert!((t - 2.0).abs() < 1e-12 && (alpha - 0.6).abs() < 1e-6, "{t} {alpha}");
        assert!(meet([2.0, 0.0, 1.0], &corners, &[0.5; 3]).is_none());
    }

    /// Rays and the rasterised shadow map agree on the floor: most points, whose texel holds what the ray meets, within
    /// 0.02. Control: the map's transmittance of another texel.
    #[test]
    fn rays_agree_with_the_map() {
        for name in ["glass-stacks", "spheres", "smoke"] {
            let scene = open(name).unwrap();
            let options = Options {
                size: Some((64, 64)),
                seed: None,
            };
            let shadowed = scene.shadowed(&options, &SMALL).unwrap();
            assert!(
                shadowed.on_surfaces.len() > 100,
                "{name}: {}",
                shadowed.on_surfaces.len()
            );
            let of_texel = |x: f64, y: f64| {
                let p = y as usize * 256 + x as usize;
                (-abuffer::total_absorbance(shadowed.map.pixel(p.min(256 * 256 - 1)))).exp()
            };
            let floor: Vec<Receiver> = shadowed.floor.iter().flatten().copied().collect();
            let share = |shift: f64| {
                let near = floor
                    .iter()
                    .filter(|r| (of_texel((r.texel.0 + shift) % 256.0, r.texel.1) - r.transmittance).abs() < 0.02);
                near.count() as f64 / floor.len() as f64
            };
            let shaded = floor.iter().filter(|r| r.transmittance < 0.95).count();
            println!(
                "{name}: {} of the floor's {} points shaded, {:.2} agree",
                shaded,
                floor.len(),
                share(0.0)
            );
            assert!(floor.len() > 20 && shaded > 3 && share(0.0) > 0.75, "{name}");
            assert!(share(97.0) < share(0.0), "{name}");
        }
    }
}
