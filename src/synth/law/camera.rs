//! From the depths that laws are in to the view depths that fragment lists carry.

use super::numbers::each;
use crate::pixel::{CameraPlanes, LogWarp, ViewZ};

/// From the depths that laws are in to the view depth that fragment lists carry.
#[derive(Debug, Clone)]
pub(in crate::synth) struct Camera {
    planes: CameraPlanes,
    warp: LogWarp,
}

impl Camera {
    /// Of validated planes.
    pub(in crate::synth) fn new(planes: CameraPlanes) -> Self {
        let [near, far] = [planes.near(), planes.far()].map(|v| ViewZ(v.into()));
        Self {
            planes,
            warp: LogWarp::new(near, far).expect("validated: 0 < near < far"),
        }
    }

    /// The moment depth of a view depth.
    #[cfg(test)]
    pub(super) fn moment(&self, view_z: ViewZ) -> f64 {
        self.warp.moment(view_z).0
    }

    /// Appends the view depths of window depths, which these become on the way.
    pub(super) fn of_window(&self, depth: &mut [f64], out: &mut Vec<f32>) {
        each!(depth, simd, w => self.planes.view_z_doubles(simd, w));
        self.within(depth, out);
    }

    /// The same of moment depths.
    pub(super) fn of_moment(&self, depth: &mut [f64], out: &mut Vec<f32>) {
        each!(depth, simd, z => self.warp.view_z_doubles(simd, z));
        self.within(depth, out);
    }

    fn within(&self, view_z: &[f64], out: &mut Vec<f32>) {
        let (near, far) = (self.planes.near(), self.planes.far());
        out.extend(view_z.iter().map(|&v| (v as f32).clamp(near, far)));
    }
}
