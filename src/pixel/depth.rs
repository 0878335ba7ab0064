//! The three kinds of depth, each a type of its own so that a mix-up does not compile.

use crate::numeric::{doubles, lanes};
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, f64x8};

/// Distance along the view direction, linear, > 0 [scene units]. What fragment files carry.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct ViewZ(pub f64);

/// Depth as `gl_FragCoord.z` holds it, in [0, 1], hyperbolic in [`ViewZ`].
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct WindowDepth(pub f64);

/// Depth that moments are taken of, in [−1, 1].
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct MomentDepth(pub f64);

/// Why one kind of depth could not be turned into another.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// Window depth was asked for and no camera planes are known.
    #[error("window depth needs the camera planes, which the fragment list does not carry; pass --near and --far")]
    NoPlanes,
    /// Relative depth was asked for and no range is known.
    #[error(
        "relative depth needs a range of view depths, and neither the fragment list nor the caller gives one; pass \
            --depth-range"
    )]
    NoRange,
    /// The planes are not 0 < near < far, or not finite.
    #[error("camera planes near = {near}, far = {far}: expected 0 < near < far, both finite")]
    BadPlanes {
        /// Near plane [scene units].
        near: f64,
        /// Far plane [scene units].
        far: f64,
    },
    /// A fragment lies in front of the near or behind the far plane.
    #[error("view_z = {view_z} lies outside the camera planes [{near}, {far}]; correct --near and --far")]
    OutsidePlanes {
        /// The fragment's depth [scene units].
        view_z: f64,
        /// Near plane [scene units].
        near: f64,
        /// Far plane [scene units].
        far: f64,
    },
    /// The range of the log warp is not 0 < v0 ≤ v1, or not finite.
    #[error("depth range [{v0}, {v1}]: expected 0 < v0 <= v1, both finite")]
    BadRange {
        /// Least depth [scene units].
        v0: f64,
        /// Greatest depth [scene units].
        v1: f64,
    },
}

/// The clipping planes of a perspective camera [scene units].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CameraPlanes {
    /// Near plane, > 0 [scene units].
    near: f32,
    /// Far plane, beyond the near one [scene units].
    far: f32,
}

impl CameraPlanes {
    /// Planes at `near` and `far`.
    ///
    /// # Errors
    /// [`DepthError::BadPlanes`] unless 0 < near < far, both finite.
    pub fn new(near: f32, far: f32) -> Result<Self, DepthError> {
        Self { near, far }.checked()
    }

    /// Itself, where it is valid; for planes that came from a file.
    ///
    /// # Errors
    /// [`DepthError::BadPlanes`].
    pub fn checked(self) -> Result<Self, DepthError> {
        if self.near > 0.0 && self.near < self.far && self.far.is_finite() {
            Ok(self)
        } else {
            Err(DepthError::BadPlanes {
                near: self.near.into(),
                far: self.far.into(),
            })
        }
    }

    /// Near plane [scene units].
    pub fn near(&self) -> f32 {
        self.near
    }

    /// Far plane [scene units].
    pub fn far(&self) -> f32 {
        self.far
    }

    /// Window depth w = far (v − near) / (v (far − near)).
    ///
    /// # Errors
    /// [`DepthError::OutsidePlanes`] where v is not within [near, far].
    pub fn window(&self, ViewZ(v): ViewZ) -> Result<WindowDepth, DepthError> {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        if !(near..=far).contains(&v) {
            return Err(DepthError::OutsidePlanes { view_z: v, near, far });
        }
        Ok(WindowDepth(far * (v - near) / (v * (far - near))))
    }

    /// [`Self::window`] of sixteen view depths at once, in f32, clamped to [0, 1]; a few 1e-7 from it.
    #[inline(always)]
    pub fn window_lanes<S: Simd>(&self, simd: S, view_z: f32x16<S>) -> f32x16<S> {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let splat = |x: f64| f32x16::splat(simd, x as f32);
        let w = (splat(1.0) - splat(near) / view_z) * splat(far / (far - near));
        w.max(splat(0.0)).min(splat(1.0))
    }

    /// The inverse of [`Self::window`]: v = near·far / (far − w (far − near)), kept within the planes.
    pub fn view_z(&self, WindowDepth(w): WindowDepth) -> ViewZ {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        ViewZ((near * far / (far - w * (far - near))).clamp(near, far))
    }

    /// [`Self::view_z`] of eight window depths at once, the same to the bit.
    #[inline(always)]
    pub fn view_z_doubles<S: Simd>(&self, simd: S, w: f64x8<S>) -> f64x8<S> {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let splat = |x: f64| f64x8::splat(simd, x);
        (splat(near * far) / (splat(far) - w * splat(far - near)))
            .max(splat(near))
            .min(splat(far))
    }
}

impl WindowDepth {
    /// Moment depth 2w − 1, as NMT24's shader takes it.
    pub fn to_moment(self) -> MomentDepth {
        MomentDepth(2.0 * self.0 - 1.0)
    }
}

/// Logarithmic warp of view depth to moment depth: z = 2 ln(v/v0)/ln(v1/v0) − 1.
///
/// # Source
/// MKKP18 Sec. 3.3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogWarp {
    v0: f64,
    log_ratio: f64,
    inverse_log_ratio: f64,
}

impl LogWarp {
    /// The warp that takes [v0, v1] to [−1, 1]; where v0 = v1 everything goes to 0.
    ///
    /// # Errors
    /// [`DepthError::BadRange`] unless 0 < v0 ≤ v1, both finite.
    pub fn new(ViewZ(v0): ViewZ, ViewZ(v1): ViewZ) -> Result<Self, DepthError> {
        if !(v0 > 0.0 && v0 <= v1 && v1.is_finite()) {
            return Err(DepthError::BadRange { v0, v1 });
        }
        let log_ratio = libm::log(v1 / v0);
        Ok(Self {
            v0,
            log_ratio,
            inverse_log_ratio: if log_ratio > 0.0 { 1.0 / log_ratio } else { 0.0 },
        })
    }

    /// Moment depth of a view depth, clamped to [−1, 1].
    pub fn moment(&self, ViewZ(v): ViewZ) -> MomentDepth {
        if self.inverse_log_ratio == 0.0 {
            return MomentDepth(0.0);
        }
        MomentDepth((2.0 * libm::log(v / self.v0) * self.inverse_log_ratio - 1.0).clamp(-1.0, 1.0))
    }

    /// [`Self::moment`] of sixteen view depths at once, in f32; a few 1e-7 from it.
    #[inline(always)]
    pub fn moment_lanes<S: Simd>(&self, simd: S, view_z: f32x16<S>) -> f32x16<S> {
        let splat = |x: f64| f32x16::splat(simd, x as f32);
        let z = lanes::ln(simd, view_z * splat(1.0 / self.v0)) * splat(2.0 * self.inverse_log_ratio) - splat(1.0);
        let z = z.max(splat(-1.0)).min(splat(1.0));
        if self.inverse_log_ratio == 0.0 { splat(0.0) } else { z }
    }

    /// The inverse of [`Self::moment`]: v = v0 (v1/v0)^((z + 1)/2).
    pub fn view_z(&self, MomentDepth(z): MomentDepth) -> ViewZ {
        ViewZ(self.v0 * libm::exp(0.5 * (z + 1.0) * self.log_ratio))
    }

    /// [`Self::view_z`] of eight moment depths at once, the same to the bit.
    #[inline(always)]
    pub fn view_z_doubles<S: Simd>(&self, simd: S, z: f64x8<S>) -> f64x8<S> {
        let splat = |x: f64| f64x8::splat(simd, x);
        splat(self.v0) * doubles::exp(simd, splat(0.5) * (z + splat(1.0)) * splat(self.log_ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn planes_map_to_the_ends_of_window_depth() {
        let planes = CameraPlanes::new(0.5, 10.0).unwrap();
        assert_eq!(planes.window(ViewZ(0.5)).unwrap(), WindowDepth(0.0));
        assert_eq!(planes.window(ViewZ(10.0)).unwrap(), WindowDepth(1.0));
        assert!(planes.window(ViewZ(0.49)).is_err());
        assert!(planes.window(ViewZ(10.01)).is_err());
        assert!(planes.window(ViewZ(f64::NAN)).is_err());
        // w(1) = 10·0.5/9.5
        assert!((planes.window(ViewZ(1.0)).unwrap().0 - 5.0 / 9.5).abs() < 1e-15);
    }

    #[test]
    fn planes_and_ranges_are_validated() {
        for (near, far) in [
            (0.0, 1.0),
            (-1.0, 1.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (f32::NAN, 1.0),
            (1.0, f32::INFINITY),
        ] {
            assert!(CameraPlanes::new(near, far).is_err(), "{near} {far}");
        }
        assert!(LogWarp::new(ViewZ(2.0), ViewZ(1.0)).is_err());
        assert!(LogWarp::new(ViewZ(0.0), ViewZ(1.0)).is_err());
        assert_eq!(
            LogWarp::new(ViewZ(3.0), ViewZ(3.0)).unwrap().moment(ViewZ(3.0)),
            MomentDepth(0.0)
        );
    }

    #[test]
    fn the_log_warp_takes_the_geometric_mean_to_zero() {
        let warp = LogWarp::new(ViewZ(2.0), ViewZ(32.0)).unwrap();
        assert_eq!(warp.moment(ViewZ(2.0)).0, -1.0);
        assert_eq!(warp.moment(ViewZ(32.0)).0, 1.0);
        assert!(warp.moment(ViewZ(8.0)).0.abs() < 1e-15);
    }

    /// Eight at once and one by one: the same bits, at every place between the ends. Control: another warp, other
    /// planes.
    #[test]
    fn doubles_follow_the_scalar() {
        use fearless_simd::{Level, dispatch};
        let planes = CameraPlanes::new(0.1, 100.0).unwrap();
        let (warp, other) = (
            LogWarp::new(ViewZ(0.1), ViewZ(100.0)).unwrap(),
            LogWarp::new(ViewZ(0.1), ViewZ(101.0)).unwrap(),
        );
        for level in [Level::new(), Level::baseline()] {
            for i in (0..8000).step_by(8) {
                let w: [f64; 8] = std::array::from_fn(|lane| (i + lane) as f64 / 7999.0);
                let z = w.map(|w| 2.0 * w - 1.0);
                let (moment, window): ([f64; 8], [f64; 8]) = dispatch!(level, simd => {
                    let of = |x: &[f64]| f64x8::from_slice(simd, x);
                    (warp.view_z_doubles(simd, of(&z)).into(), planes.view_z_doubles(simd, of(&w)).into())
                });
                assert_eq!(moment, z.map(|z| warp.view_z(MomentDepth(z)).0));
                assert_eq!(window, w.map(|w| planes.view_z(WindowDepth(w)).0));
                assert_ne!(moment, z.map(|z| other.view_z(MomentDepth(z)).0));
            }
        }
    }

    proptest! {
        /// Tolerance: view_z kept as f32 (relative 6e-8) between near 0.1 and far 100 moves window depth by less than
        /// 1e-7.
        #[test]
        fn window_depth_survives_the_f32_view_depth_of_a_file(w in 0.0f64..=1.0) {
            let planes = CameraPlanes::new(0.1, 100.0).unwrap();
            let stored = planes.view_z(WindowDepth(w)).0 as f32;
            let back = planes.window(ViewZ(stored.into())).unwrap().0;
            prop_assert!((back - w).abs() < 1e-7, "{w} -> {stored} -> {back}");
        }

        /// Tolerance: a few roundings of numbers of order 1 to 10.
        #[test]
        fn the_log_warp_has_an_inverse(z in -1.0f64..=1.0, v0 in 0.01f64..10.0, ratio in 1.01f64..1e4) {
            let warp = LogWarp::new(ViewZ(v0), ViewZ(v0 * ratio)).unwrap();
            let back = warp.moment(warp.view_z(MomentDepth(z))).0;
            prop_assert!((back - z).abs() < 2e-13, "{z} -> {back}");
        }
    }
}
