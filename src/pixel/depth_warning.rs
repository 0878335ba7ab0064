//! View depths that are valid numbers and make no sense as distances along the view direction.

use super::{CameraPlanes, FragmentList};
use rayon::prelude::*;
use serde::Serialize;

/// Why the view depths of a list look as if they were something else.
#[derive(Debug, Clone, PartialEq, Serialize, thiserror::Error)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum DepthWarning {
    /// Every fragment has one depth, and some pixels hold several.
    #[error(
        "all {fragments} fragments have the view depth {view_z}, so no method can order them; \
         clip w is 1 everywhere under an orthographic camera: write the distance along the view direction"
    )]
    AllEqual {
        /// Number of fragments.
        fragments: u64,
        /// Their depth [scene units].
        view_z: f32,
    },
    /// In most pixels of several fragments, most of them share the least depth.
    #[error(
        "in {tied} of {pixels} pixels with several fragments most of them tie for nearest, so their order is lost; \
         write depths as float32, unclamped, from before any quantisation"
    )]
    MostlyTied {
        /// Pixels in which most fragments tie.
        tied: u64,
        /// Pixels that hold several fragments.
        pixels: u64,
    },
    /// No depth exceeds 1, as is true of window depth, reversed or not.
    #[error(
        "all {fragments} view depths lie in (0, {greatest}], as window depths do; if they are from gl_FragCoord.z, \
         write v = near far / (far - w (far - near)) instead, with w = 1 - depth where depth is reversed"
    )]
    WindowLike {
        /// Number of fragments.
        fragments: u64,
        /// The greatest depth.
        greatest: f32,
    },
    /// Fragments lie in front of the near or behind the far plane.
    #[error(
        "{outside} of {fragments} view depths, {view_z} among them, lie outside the camera planes [{near}, {far}]; \
         correct --near and --far, or the planes and depths of the file"
    )]
    OutsidePlanes {
        /// Fragments outside.
        outside: u64,
        /// Number of fragments.
        fragments: u64,
        /// One of the depths [scene units].
        view_z: f32,
        /// Near plane [scene units].
        near: f32,
        /// Far plane [scene units].
        far: f32,
    },
}

impl FragmentList {
    /// What makes no sense about the view depths; `planes` stand in for the list's own.
    ///
    /// Fragments of alpha 0 are not looked at: they hide nothing, wherever they are.
    pub fn depth_warnings(&self, planes: Option<CameraPlanes>) -> Vec<DepthWarning> {
        let mut warnings = Vec::new();
        let seen = || {
            self.view_z()
                .par_iter()
                .zip(self.alpha())
                .filter(|(_, a)| **a > 0.0)
                .map(|(z, _)| *z)
        };
        let fragments = seen().count() as u64;
        let Some(((least, greatest), planes)) = self.depth_range().map(|range| (range, planes.or(self.planes())))
        else {
            return warnings;
        };
        if fragments == 0 {
            return warnings;
        }
        // Planes are f32, and a depth computed in f32 may leave them by a rounding.
        let slack = 4.0 * f32::EPSILON;
        let outside = |p: CameraPlanes| move |z: &f32| *z < p.near() * (1.0 - slack) || *z > p.far() * (1.0 + slack);
        if let Some(p) = planes
            && (outside(p)(&least) || outside(p)(&greatest))
        {
            warnings.push(DepthWarning::OutsidePlanes {
                outside: seen().filter(outside(p)).count() as u64,
                fragments,
                view_z: if outside(p)(&least) { least } else { greatest },
                near: p.near(),
                far: p.far(),
            });
        }
        let (pixels, tied) = (0..self.pixels())
            .into_par_iter()
            .map(|p| {
                let pixel = self.pixel(p);
                let own = || {
                    pixel
                        .view_z
                        .iter()
                        .zip(pixel.alpha)
                        .filter(|(_, a)| **a > 0.0)
                        .map(|(z, _)| *z)
                };
                let (n, nearest) = (own().count(), own().fold(f32::INFINITY, f32::min));
                let ties = own().filter(|z| *z == nearest).count();
                (u64::from(n > 1), u64::from(n > 1 && ties > 1 && 2 * ties >= n))
            })
            .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        if pixels > 0 && least == greatest {
            warnings.push(DepthWarning::AllEqual {
                fragments,
                view_z: least,
            });
        } else if 2 * tied > pixels {
            warnings.push(DepthWarning::MostlyTied { tied, pixels });
        }
        if greatest <= 1.0 && planes.is_none_or(|p| p.far() > 1.0) && least < greatest {
            warnings.push(DepthWarning::WindowLike { fragments, greatest });
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(pixels: &[&[(f32, f32)]]) -> FragmentList {
        let mut offsets = vec![0];
        for p in pixels {
            offsets.push(offsets[offsets.len() - 1] + p.len() as u64);
        }
        let all: Vec<(f32, f32)> = pixels.concat();
        let (z, a) = all.into_iter().unzip();
        FragmentList::new(offsets, z, a, None).unwrap()
    }

    #[test]
    fn depths_that_are_none_are_told_from_depths() {
        let planes = |near, far| Some(CameraPlanes::new(near, far).unwrap());
        // The control: nothing is wrong, whatever a fragment of alpha 0 says.
        let good = list(&[
            &[(2.0, 0.5), (3.0, 0.5), (1e30, 0.0)],
            &[(2.0, 0.5), (2.0, 0.25), (4.0, 0.5)],
        ]);
        assert_eq!(good.depth_warnings(planes(1.0, 10.0)), []);
        assert_eq!(list(&[&[(0.5, 0.5)]]).depth_warnings(None), []);
        let equal = list(&[&[(1.0, 0.5), (1.0, 0.5)], &[(1.0, 0.1)]]);
        assert!(matches!(
            equal.depth_warnings(None)[..],
            [DepthWarning::AllEqual { fragments: 3, .. }]
        ));
        let tied = list(&[&[(1.0, 0.5), (1.0, 0.5), (2.0, 0.5)], &[(3.0, 0.1), (3.0, 0.5)]]);
        assert_eq!(
            tied.depth_warnings(None),
            [DepthWarning::MostlyTied { tied: 2, pixels: 2 }]
        );
        let window = list(&[&[(0.99, 0.5), (0.995, 0.5)]]);
        assert!(matches!(
            window.depth_warnings(planes(0.1, 100.0))[..],
            [DepthWarning::WindowLike { .. }]
        ));
        assert_eq!(window.depth_warnings(planes(0.1, 1.0)), []);
        let outside = good.depth_warnings(planes(2.5, 3.5));
        assert!(
            matches!(
                outside[..],
                [DepthWarning::OutsidePlanes {
                    outside: 4,
                    fragments: 5,
                    view_z: 2.0,
                    ..
                }]
            ),
            "{outside:?}"
        );
    }
}
