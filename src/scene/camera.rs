//! The pinhole camera that a scene is seen through, and the little vector algebra that it needs.

use super::SceneError;
use crate::pixel::CameraPlanes;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Most columns or rows that a scene may be rendered at; a bound on memory, far above any screen.
pub const MAX_PIXELS_A_SIDE: u32 = 16384;

/// A point or direction [scene units].
pub type Vec3 = [f64; 3];

/// a + b.
pub(super) fn add(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] + b[i])
}

/// a − b.
pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// s a.
pub(super) fn scale(a: Vec3, s: f64) -> Vec3 {
    a.map(|x| x * s)
}

/// a · b.
pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a / |a|; the zero vector where a has no direction.
pub(super) fn unit(a: Vec3) -> Vec3 {
    let length = dot(a, a).sqrt();
    if length > 0.0 && length.is_finite() {
        scale(a, 1.0 / length)
    } else {
        [0.0; 3]
    }
}

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where it stands [scene units].
    pub position: Vec3,
    /// The point in the middle of the picture [scene units].
    pub look_at: Vec3,
    /// The direction that is up in the picture.
    #[serde(default = "y_up")]
    pub up: Vec3,
    /// Full vertical angle of view, in (0, 180) \[degrees\].
    pub vertical_fov: f64,
    /// Columns \[pixels\].
    pub width: u32,
    /// Rows \[pixels\].
    pub height: u32,
    /// Nearest view depth that is seen [scene units].
    pub near: f32,
    /// Farthest view depth that is seen [scene units].
    pub far: f32,
}

fn y_up() -> Vec3 {
    [0.0, 1.0, 0.0]
}

/// A validated camera: an orthonormal frame and the size of a unit at depth 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Pixels that a unit length at view depth 1 covers.
    pub focal: f64,
    pub width: u32,
    pub height: u32,
    pub planes: CameraPlanes,
}

impl Camera {
    /// The camera's frame.
    ///
    /// # Errors
    /// [`SceneError::Field`] names the file and the field that makes no picture.
    pub(super) fn view(&self, path: &Path) -> Result<View, SceneError> {
        let wrong = |field: &str, found: String, expected: &str| {
            SceneError::field(path, &format!("camera.{field}"), found, expected)
        };
        for (field, v) in [("position", self.position), ("look_at", self.look_at), ("up", self.up)] {
            if !v.iter().all(|x| x.abs() <= 1e12) {
                return Err(wrong(
                    field,
                    format!("{v:?}"),
                    "three finite numbers of size 1e12 at most",
                ));
            }
        }
        for (field, n) in [("width", self.width), ("height", self.height)] {
            if !(1..=MAX_PIXELS_A_SIDE).contains(&n) {
                return Err(wrong(field, n.to_string(), &format!("1 to {MAX_PIXELS_A_SIDE} pixels")));
            }
        }
        if !(self.vertical_fov >= 0.01 && self.vertical_fov <= 179.0) {
            return Err(wrong(
                "vertical_fov",
                self.vertical_fov.to_string(),
                "an angle of 0.01 to 179 degrees",
            ));
        }
        let planes =
            CameraPlanes::new(self.near, self.far).map_err(|e| wrong("near, far", e.to_string(), "0 < near < far"))?;
        let forward = unit(sub(self.look_at, self.position));
        if forward == [0.0; 3] {
            return Err(wrong(
                "look_at",
                format!("{:?}", self.look_at),
                "a point other than camera.position",
            ));
        }
        let right = cross(forward, unit(self.up));
        if dot(right, right) < 1e-12 {
            return Err(wrong(
                "up",
                format!("{:?}", self.up),
                "a direction other than the one of view",
            ));
        }
        let right = unit(right);
        let half = self.vertical_fov.to_radians() / 2.0;
        let focal = f64::from(self.height) / 2.0 / libm::tan(half);
        Ok(View {
            eye: self.position,
            right,
            up: cross(right, forward),
            forward,
            focal,
            width: self.width,
            height: self.height,
            planes,
        })
    }
}

impl View {
    /// Camera coordinates: right, up, and the view depth.
    pub fn to_camera(self, p: [f32; 3]) -> Vec3 {
        let d = sub(p.map(f64::from), self.eye);
        [dot(d, self.right), dot(d, self.up), dot(d, self.forward)]
    }

    /// Place in the picture [pixels from its left upper corner], for a view depth > 0.
    pub fn to_pixel(self, [x, y, z]: Vec3) -> (f64, f64) {
        (
            f64::from(self.width) / 2.0 + self.focal * x / z,
            f64::from(self.height) / 2.0 - self.focal * y / z,
        )
    }
}
