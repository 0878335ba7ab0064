//! Gaussian splats: what they are, and what a camera sees of one.
//!
//! # Source
//! Zwicker, Pfister, van Baar, Gross, *EWA Splatting*, TVCG 2002, as Kerbl et al., *3D Gaussian Splatting*, SIGGRAPH
//! 2023, use it: the Gaussian's covariance goes through the Jacobian of the projection at its centre, 0.3 square pixels
//! are added for the pixel's own extent, and a fragment's alpha is the splat's opacity times the Gaussian's value at
//! the pixel's centre. All fragments of a splat have the depth of its centre; those of alpha below 1/255 are not drawn.
//! The Jacobian is not clamped off the screen and alpha not cut at 0.99, both of which that paper's program does for
//! its training's sake.

pub mod file;

use super::camera::{View, dot};

/// Least alpha of a splat's fragment.
pub const MIN_ALPHA: f64 = 1.0 / 255.0;

/// The pixel's own extent, added to a projected covariance \[pixels²\].
pub const PIXEL_VARIANCE: f64 = 0.3;

/// A Gaussian in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Splat {
    /// Centre [scene units].
    pub position: [f32; 3],
    /// Standard deviations along the splat's own axes [scene units].
    pub scale: [f32; 3],
    /// Unit quaternion that turns its axes into the scene's: w, x, y, z.
    pub rotation: [f32; 4],
    /// Colour as it is composited, and the opacity of its centre in [0, 1].
    pub rgba: [f32; 4],
}

/// A splat on the screen.
#[derive(Debug, Clone, Copy)]
pub(super) struct ScreenSplat {
    /// Centre \[pixels\].
    pub center: (f64, f64),
    /// The inverse covariance: xx, xy, yy \[pixels⁻²\].
    conic: [f64; 3],
    /// Greatest Mahalanobis distance squared at which alpha is not less than [`MIN_ALPHA`].
    reach: f64,
    /// Rows above and below the centre that it reaches \[pixels\].
    pub half_height: f64,
    pub view_z: f32,
    rgba: [f32; 4],
}

impl Splat {
    /// Covariance's root in the scene: the rotation's columns, each times its standard deviation.
    fn axes(&self) -> [[f64; 3]; 3] {
        let [w, x, y, z] = self.rotation.map(f64::from);
        let s = self.scale.map(f64::from);
        let columns = [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y + w * z),
                2.0 * (x * z - w * y),
            ],
            [
                2.0 * (x * y - w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z + w * x),
            ],
            [
                2.0 * (x * z + w * y),
                2.0 * (y * z - w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ];
        std::array::from_fn(|k| columns[k].map(|v| v * s[k]))
    }

    /// What a camera sees of it; nothing where its centre is not between the planes, where it is too faint, or where it
    /// misses the picture.
    pub(super) fn project(&self, view: &View) -> Option<ScreenSplat> {
        let at = view.to_camera(self.position);
        let view_z = at[2] as f32;
        let opacity = f64::from(self.rgba[3]);
        if !(view_z >= view.planes.near() && view_z <= view.planes.far()) || opacity < MIN_ALPHA {
            return None;
        }
        let center = view.to_pixel(at);
        // The rows of J W, rows of the picture counted downwards.
        let per_z = view.focal / at[2];
        let rows: [[f64; 3]; 2] = [
            std::array::from_fn(|k| per_z * (view.right[k] - at[0] / at[2] * view.forward[k])),
            std::array::from_fn(|k| -per_z * (view.up[k] - at[1] / at[2] * view.forward[k])),
        ];
        let axes = self.axes();
        let root: [[f64; 3]; 2] = rows.map(|row| axes.map(|axis| dot(row, axis)));
        let (xx, xy, yy) = (
            dot(root[0], root[0]) + PIXEL_VARIANCE,
            dot(root[0], root[1]),
            dot(root[1], root[1]) + PIXEL_VARIANCE,
        );
        let determinant = xx * yy - xy * xy;
        let reach = 2.0 * libm::log(opacity / MIN_ALPHA);
        let (half_width, half_height) = ((reach * xx).sqrt(), (reach * yy).sqrt());
        let inside = |center: f64, half: f64, size: u32| center + half >= 0.0 && center - half <= f64::from(size);
        let visible = determinant > 0.0
            && determinant.is_finite()
            && inside(center.0, half_width, view.width)
            && inside(center.1, half_height, view.height);
        visible.then(|| ScreenSplat {
            center,
            conic: [yy / determinant, -xy / determinant, xx / determinant],
            reach,
            half_height,
            view_z,
            rgba: self.rgba,
        })
    }
}

impl ScreenSplat {
    /// Calls `f(pixel within the rows, view_z, rgba)` for every pixel in which alpha is at least [`MIN_ALPHA`].
    pub fn draw(&self, width: usize, rows: &std::ops::Range<usize>, mut f: impl FnMut(usize, f32, [f32; 4])) {
        let [r, g, b, opacity] = self.rgba;
        self.covered(width, rows, |p, distance| {
            let alpha = (f64::from(opacity) * libm::exp(-0.5 * distance)) as f32;
            f(p, self.view_z, [r, g, b, alpha.max(MIN_ALPHA as f32)]);
        });
    }

    /// Calls `f(pixel within the rows)` for the same pixels as [`Self::draw`], faster.
    pub fn count(&self, width: usize, rows: &std::ops::Range<usize>, mut f: impl FnMut(usize)) {
        self.covered(width, rows, |p, _| f(p));
    }

    /// Pixels of the rows within reach, with their squared Mahalanobis distances.
    fn covered(&self, width: usize, rows: &std::ops::Range<usize>, mut f: impl FnMut(usize, f64)) {
        let [a, b, c] = self.conic;
        let lo = (self.center.1 - self.half_height - 0.5).floor().max(rows.start as f64) as usize;
        let hi = (self.center.1 + self.half_height + 0.5)
            .ceil()
            .min(rows.end as f64)
            .max(0.0) as usize;
        for y in lo..hi {
            // a dx² + 2 b dx dy + c dy² = reach
            let dy = y as f64 + 0.5 - self.center.1;
            let root = ((b * dy) * (b * dy) - a * (c * dy * dy - self.reach)).max(0.0).sqrt();
            let from = (self.center.0 - (b * dy + root) / a - 1.0)
                .floor()
                .clamp(0.0, width as f64) as usize;
            let to = (self.center.0 - (b * dy - root) / a + 1.0)
                .ceil()
                .clamp(0.0, width as f64) as usize;
            let row = (y - rows.start) * width;
            for x in from..to {
                let dx = x as f64 + 0.5 - self.center.0;
                let distance = (a * dx + 2.0 * b * dy) * dx + c * dy * dy;
                if distance <= self.reach {
                    f(row + x, distance);
                }
            }
        }
    }
}
