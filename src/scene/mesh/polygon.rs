//! Polygons cut into triangles.

use crate::scene::camera::{Vec3, cross, dot, sub, unit};
use earcut::Earcut;

/// Triangles that cover a polygon, concave ones too; each is three places among the corners.
///
/// The polygon is seen along Newell's normal. Where that has no direction, the polygon has no area and there is no
/// triangle.
///
/// # Source
/// Ear clipping by the crate `earcut`.
pub(super) fn triangles(corners: &[Vec3], cutter: &mut Earcut<f64>) -> Vec<[u32; 3]> {
    match corners.len() {
        0..3 => return Vec::new(),
        3 => return vec![[0, 1, 2]],
        _ => {}
    }
    // Differences to the first corner keep the digits of polygons far from the origin.
    let local: Vec<Vec3> = corners.iter().map(|p| sub(*p, corners[0])).collect();
    let mut normal = [0.0; 3];
    for (i, a) in local.iter().enumerate() {
        let n = cross(*a, local[(i + 1) % local.len()]);
        normal = [normal[0] + n[0], normal[1] + n[1], normal[2] + n[2]];
    }
    let normal = unit(normal);
    if normal == [0.0; 3] {
        return Vec::new();
    }
    let least = (0..3).fold(0, |k, i| if normal[i].abs() < normal[k].abs() { i } else { k });
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let u = unit(cross(axis, normal));
    let v = cross(normal, u);
    let mut out: Vec<u32> = Vec::new();
    cutter.earcut(local.iter().map(|p| [dot(*p, u), dot(*p, v)]), &[], &mut out);
    out.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles' areas add up to the polygon's, in whatever plane it lies; a fan from the first corner would
    /// overlap and sum to more.
    #[test]
    fn concave_polygons_are_covered_once() {
        let u = [
            [-1.0, 1.0],
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [0.5, 1.0],
            [0.5, -0.5],
            [-0.5, -0.5],
            [-0.5, 1.0],
        ];
        let area = |t: [Vec3; 3]| {
            let n = cross(sub(t[1], t[0]), sub(t[2], t[0]));
            dot(n, n).sqrt() / 2.0
        };
        for place in [
            |p: [f64; 2]| [p[0], p[1], 0.0],
            |p: [f64; 2]| [7e5, p[0], p[1]],
            |p: [f64; 2]| [p[0], 2.0 * p[0] + p[1], -p[1]],
        ] {
            let corners = u.map(place);
            let whole =
                |found: Vec<[u32; 3]>| -> f64 { found.iter().map(|t| area(t.map(|i| corners[i as usize]))).sum() };
            // The shape fills 2 x 2 less 1 x 1.5 of its plane's unit of area.
            let unit_area = 2.0 * area([place([0.0, 0.0]), place([1.0, 0.0]), place([0.0, 1.0])]);
            let cut = whole(triangles(&corners, &mut Earcut::new()));
            assert!((cut - 2.5 * unit_area).abs() < 1e-9 * unit_area.max(1.0), "{cut}");
            let fan = whole((1..7).map(|i| [0, i, i + 1]).collect());
            assert!(fan > cut + 0.5 * unit_area, "{fan}");
        }
        assert!(triangles(&[[1.0; 3]; 5], &mut Earcut::new()).is_empty());
        assert!(triangles(&[[1.0; 3]; 2], &mut Earcut::new()).is_empty());
    }
}
