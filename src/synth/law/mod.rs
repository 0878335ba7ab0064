//! The laws that random pixels follow, a file each: what a configuration says of it, what makes that valid, and how it
//! is drawn.
//!
//! A new law is a new file in [`depth`] or [`alpha`], and its name in the table of that folder.
//!
//! All are drawn by exact arithmetic and `libm` only: the mathematics of the platform would give other bytes on other
//! machines.

pub mod alpha;
mod camera;
pub mod count;
pub mod depth;
mod gamma;
mod numbers;
#[cfg(test)]
pub(super) mod testing;

use super::config::{CountRange, SynthError, above_zero, count, number};
use crate::numeric::rng::Stream;
pub use alpha::AlphaLaw;
pub(super) use camera::Camera;
pub use count::{CountLaw, FragmentCount};
pub use depth::{DepthLaw, PixelRange};
use serde::{Deserialize, Serialize};

/// The greatest weight of one law.
pub const GREATEST_WEIGHT: f64 = 1e9;

/// The table of all laws of one kind, of which each row is a file of the folder and the struct in it that holds the
/// law's configuration. It makes
///
/// - the enum that configuration files choose from by `law = "..."`, whose variants hold these structs;
/// - `Prepared`, which is what the laws work out for all pixels, and how it draws;
/// - `Scratch`, the memory that each law draws in, under the name of its file.
///
/// The module has the traits `Law` and `Draw` that the structs, and what they prepare, implement.
macro_rules! laws {
    (
        $(#[$attribute:meta])*
        $table:ident draws ($given:ident: $Given:ty, $out:ident: $Out:ty)
        $($file:ident::$Law:ident,)*
    ) => {
        $(pub use $file::$Law;)*

        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(test, derive(schemars::JsonSchema))]
        #[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
        #[allow(missing_docs, reason = "the structs in the variants say what the laws are")]
        pub enum $table {
            $($Law($Law),)*
        }

        $(impl From<$Law> for $table {
            fn from(law: $Law) -> Self {
                Self::$Law(law)
            }
        })*

        impl $table {
            fn law(&self) -> &dyn Law {
                match self {
                    $(Self::$Law(law) => law,)*
                }
            }

            /// Of a validated configuration.
            pub(super) fn prepare(&self) -> Prepared {
                Prepared(match self {
                    $(Self::$Law(law) => PreparedLaw::$Law(law.prepare()),)*
                })
            }
        }

        /// A law with all that its pixels share worked out.
        #[derive(Debug, Clone)]
        pub(super) struct Prepared(PreparedLaw);

        #[derive(Debug, Clone)]
        enum PreparedLaw {
            $($Law(<$Law as Law>::Prepared),)*
        }

        /// Memory that the laws draw in.
        #[derive(Default)]
        pub(super) struct Scratch {
            $($file: <<$Law as Law>::Prepared as Draw>::Scratch,)*
        }

        impl Prepared {
            /// Draws one pixel.
            pub(super) fn draw(&self, rng: &mut Stream, $given: $Given, scratch: &mut Scratch, $out: $Out) {
                match &self.0 {
                    $(PreparedLaw::$Law(law) => law.draw(rng, $given, &mut scratch.$file, $out),)*
                }
            }
        }
    };
}
use laws;

/// How one kind of pixel is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PixelLaw {
    /// The share of pixels that follow this law, relative to the weights of the others.
    #[serde(default = "one")]
    pub weight: f64,
    /// How many fragments.
    pub fragments: FragmentCount,
    /// Where they lie.
    pub depth: DepthLaw,
    /// How opaque they are.
    pub alpha: AlphaLaw,
    /// How much of the space between the planes the pixel fills: of the laws in moment depth, and of them alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<PixelRange>,
}

fn one() -> f64 {
    1.0
}

impl PixelLaw {
    /// Checks every range; `at` is where the law stands in the configuration.
    pub(super) fn validate(&self, at: &str) -> Result<(), SynthError> {
        if !(self.weight > 0.0 && self.weight <= GREATEST_WEIGHT) {
            return Err(number(
                format!("{at}.weight"),
                self.weight,
                format!("be greater than 0 and at most {GREATEST_WEIGHT:e}"),
            ));
        }
        let FragmentCount { min, max, law: _ } = self.fragments;
        count(&format!("{at}.fragments"), CountRange { min, max })?;
        self.depth.validate(&format!("{at}.depth"))?;
        self.alpha.validate(&format!("{at}.alpha"))?;
        match (self.depth.space(), self.range) {
            (depth::Space::Window, None) => Ok(()),
            (depth::Space::Window, Some(_)) => Err(SynthError::UnusedRange(at.to_owned())),
            (depth::Space::Shape, None) => Err(SynthError::MissingRange(at.to_owned())),
            (depth::Space::Shape, Some(PixelRange { half })) => above_zero(&format!("{at}.range.half"), half),
        }
    }
}

/// A [`PixelLaw`] with all that its pixels share worked out.
#[derive(Debug, Clone)]
pub(super) struct Prepared {
    count: count::Prepared,
    depth: depth::Placed,
    alpha: alpha::Prepared,
}

/// Memory that the pixels of one task share.
#[derive(Default)]
pub(super) struct Scratch {
    /// Depths of the pixel, and its objects.
    shape: depth::Shape,
    depth: depth::Scratch,
    alpha: alpha::Scratch,
}

impl Prepared {
    /// Of a validated configuration.
    pub(super) fn new(config: &PixelLaw) -> Self {
        Self {
            count: count::Prepared::new(config.fragments),
            depth: depth::Placed::new(&config.depth, config.range),
            alpha: config.alpha.prepare(),
        }
    }

    /// Appends one pixel.
    pub(super) fn draw(
        &self,
        rng: &mut Stream,
        camera: &Camera,
        Scratch { shape, depth, alpha }: &mut Scratch,
        out_view_z: &mut Vec<f32>,
        out_alpha: &mut Vec<f32>,
    ) {
        let n = self.count.draw(rng);
        self.depth.draw(rng, n, camera, depth, shape, out_view_z);
        self.alpha.draw(rng, &shape.object, alpha, out_alpha);
    }
}

#[cfg(test)]
mod tests {
    use super::testing::{has_mean, range, rng};
    use super::*;
    use crate::pixel::{CameraPlanes, ViewZ};
    use crate::synth::SynthConfig;

    /// The ends of drawn pixels, read back from their view depths: half the range and the centre follow their laws.
    #[test]
    fn ranges_of_pixels() {
        let half = range(0.02, 0.5);
        let law = PixelLaw {
            depth: depth::Uniform {}.into(),
            range: Some(PixelRange { half }),
            ..SynthConfig::paper().pixels[0]
        };
        let planes = SynthConfig::paper().camera;
        let (law, camera) = (Prepared::new(&law), Camera::new(planes));
        let (mut rng, mut scratch) = (rng(), Scratch::default());
        let (mut halves, mut centers) = (Vec::new(), Vec::new());
        for _ in 0..10_000 {
            let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
            law.draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
            assert!(view_z.iter().all(|v| (0.1..=100.0).contains(v)));
            let z: Vec<f64> = view_z.iter().map(|&v| camera.moment(ViewZ(v.into()))).collect();
            let (lo, hi) = z.iter().fold((1.0f64, -1.0f64), |(lo, hi), &z| (lo.min(z), hi.max(z)));
            let h = 0.5 * (hi - lo);
            // View depths are f32: 6e-8 relative is 2e-8 in moment depth.
            assert!((0.02 - 1e-7..=0.5 + 1e-7).contains(&h));
            halves.push(h);
            centers.push(0.5 * (hi + lo) / (1.0 - h));
        }
        assert!(has_mean(&halves, f64::ln, 0.5 * (0.02f64.ln() + 0.5f64.ln())));
        assert!(has_mean(&centers, |c| c, 0.0) && has_mean(&centers, |c| c * c, 1.0 / 3.0));
        assert!(centers.iter().all(|c| c.abs() < 1.0 + 1e-6));
    }

    /// The whole range: every pixel's ends are the planes themselves. A single fragment lies halfway between them.
    #[test]
    fn the_whole_range_ends_at_the_planes() {
        let law = |n| {
            Prepared::new(&PixelLaw {
                fragments: FragmentCount {
                    min: n,
                    max: n,
                    law: CountLaw::LogUniform,
                },
                depth: depth::Uniform {}.into(),
                range: Some(PixelRange { half: range(1.0, 1.0) }),
                ..SynthConfig::paper().pixels[0]
            })
        };
        let camera = Camera::new(CameraPlanes::new(1.0, 16.0).unwrap());
        let (mut rng, mut scratch) = (rng(), Scratch::default());
        let (mut view_z, mut alpha) = (Vec::new(), Vec::new());
        law(4).draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
        assert_eq!(view_z.iter().copied().fold(f32::MAX, f32::min), 1.0);
        assert_eq!(view_z.iter().copied().fold(0.0, f32::max), 16.0);
        law(1).draw(&mut rng, &camera, &mut scratch, &mut view_z, &mut alpha);
        assert_eq!((view_z[4], view_z.len(), alpha.len()), (4.0, 5, 5));
    }
}
