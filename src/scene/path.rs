//! A camera on its way around a scene, frame by frame.

use super::camera::{Vec3, add, cross, dot, scale, sub, unit};
use super::{Camera, Options, SceneError, SceneFile, build};
use crate::pixel::FragmentList;

/// A camera that circles the point that it looks at, about its own upward direction, by the same angle every frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPath {
    /// Number of frames; the first is the scene's own picture.
    pub frames: u32,
    /// Angle between two frames \[degrees\].
    pub degrees_per_frame: f64,
}

impl CameraPath {
    /// The camera of a frame, of a scene whose own camera is `first`. Angle of view, size and planes stay.
    pub fn camera(&self, first: &Camera, frame: u32) -> Camera {
        let angle = (self.degrees_per_frame * f64::from(frame)).to_radians();
        let offset = turned(sub(first.position, first.look_at), unit(first.up), angle);
        Camera {
            position: if frame == 0 {
                first.position
            } else {
                add(first.look_at, offset)
            },
            ..*first
        }
    }

    /// The fragments of a frame.
    ///
    /// # Errors
    /// As [`build`].
    pub fn build(&self, scene: &SceneFile, options: &Options, frame: u32) -> Result<FragmentList, SceneError> {
        build(&scene.seen_by(self.camera(&scene.camera()?, frame)), options)
    }
}

/// v turned about a unit axis by an angle \[radians\] (Rodrigues' formula).
fn turned(v: Vec3, axis: Vec3, angle: f64) -> Vec3 {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let along = scale(axis, dot(axis, v) * (1.0 - cos));
    add(add(scale(v, cos), scale(cross(axis, v), sin)), along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    /// The camera keeps its distance to 1e-12 and its height, comes back after a full turn, and the first frame is the
    /// scene's own, bit for bit.
    #[test]
    fn the_camera_circles_its_target() {
        let first = open("teapots").unwrap().camera().unwrap();
        let path = CameraPath {
            frames: 7,
            degrees_per_frame: 60.0,
        };
        let distance = |c: &Camera| dot(sub(c.position, c.look_at), sub(c.position, c.look_at)).sqrt();
        assert_eq!(path.camera(&first, 0), first);
        for frame in 1..6 {
            let camera = path.camera(&first, frame);
            assert!((distance(&camera) - distance(&first)).abs() < 1e-12);
            assert!((camera.position[1] - first.position[1]).abs() < 1e-12);
            let chord = sub(camera.position, path.camera(&first, frame - 1).position);
            // Six steps of 60 degrees: every chord is as long as the radius of the circle.
            let radius = (first.position[0] - first.look_at[0]).hypot(first.position[2] - first.look_at[2]);
            assert!((dot(chord, chord).sqrt() - radius).abs() < 1e-12);
        }
        let around = sub(path.camera(&first, 6).position, first.position);
        assert!(dot(around, around) < 1e-24);
    }

    /// Frames are what the scene is from there; control: a frame is not the one before it.
    #[test]
    fn frames_are_seen_from_the_path() {
        let scene = open("spheres").unwrap();
        let options = Options {
            size: Some((32, 32)),
            seed: None,
        };
        let path = CameraPath {
            frames: 2,
            degrees_per_frame: 5.0,
        };
        let frame = |i| path.build(&scene, &options, i).unwrap();
        assert_eq!(frame(0), build(&scene, &options).unwrap());
        assert_ne!(frame(0), frame(1));
    }
}
