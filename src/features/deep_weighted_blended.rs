//! DWB22's features: `[depth, alpha_sum, n]`.

use super::spec::{ExactRules, FeatureSpec, ShaderCalls, Sums, Tolerances};
use super::{Answer, MomentDepthKind, OutputMeaning, Target};
use crate::numeric::real::{Real, c};
use crate::numeric::source::{Source, Type};
use crate::pixel::{DepthError, Pixel, ViewZ};
use crate::synth::SynthConfig;

/// Names of the columns.
pub const COLUMNS: [&str; 3] = ["depth", "alpha_sum", "n"];

/// What the columns mean.
pub const DESCRIPTION: [&str; 4] = [
    "v is distance along the view direction; v_min and v_max are its extremes over the whole scene.",
    "depth = (v - v_min) / (v_max - v_min), clamped to [0, 1], 0 where v_min = v_max;",
    "alpha_sum = sum of alpha and n = number of fragments of the pixel, over all of its fragments.",
    "The answer is what front-to-back blending has left when it reaches the fragment; use it as the weight of weighted \
        blended transparency.",
];

/// DWB22's feature set.
pub const SPEC: FeatureSpec = FeatureSpec {
    name: "deep-weighted-blended",
    columns: &COLUMNS,
    description: &DESCRIPTION,
    sums: Sums {
        moments: 0,
        has_precisions: false,
    },
    core: None,
    depth: MomentDepthKind::None,
    output: OutputMeaning::FrontToBackFactor,
    answer: Answer::Sigmoid,
    target: Target::FrontToBackFactor,
    exact: ExactRules::NONE,
    tolerances: Tolerances {
        single: 3e-5,
        half: 1e-1,
        half_mean: 2e-3,
        // Fragments are counted.
        usual_feature_log2: 6,
    },
    default_pixels: SynthConfig::paper,
    pixel: |e, pixel, features, _| {
        extract(pixel, e.scale.linear_range(), features);
        Ok(())
    },
    sample: None,
    is_sampled: false,
    shader: ShaderCalls {
        write_features,
        write_answers: |_| (),
        arguments: &["view_z", "v_min", "v_max", "alpha_sum", "n"],
        answer: "nmt_transmittance(nmt_features(HEAD))",
    },
};

fn write_features(source: &Source) {
    let about = "The features of a fragment at view depth view_z, from what pass 1 left in its pixel (sum of alpha, \
                 number of fragments) and the least and greatest view depth of the scene.";
    let names = ["view_z", "v_min", "v_max", "alpha_sum", "n"];
    source.begin_function(
        "nmt_features",
        about,
        &names.map(|name| (name, Type::Real)),
        Type::Reals(COLUMNS.len()),
    );
    let [view_z, v_min, v_max, alpha_sum, n] = names.map(|name| source.real(name));
    let relative = ((view_z - v_min) / (v_max - v_min).max(c(1e-30))).clamp(c(0.0), c(1.0));
    let depth = Real::select(v_max.gt(v_min), relative, view_z.like(0.0)).named("depth");
    source.return_numbers(&[depth, alpha_sum, n]);
}

/// Linear depth relative to a range: d = (v − v0)/(v1 − v0), clamped to [0, 1]; 0 where v0 = v1.
///
/// DWB22's shader takes the view depth itself, in scene units, which ties a network to the one scene that it was
/// trained on. Here it is measured from the least to the greatest view depth of the fragment list (or of
/// `--depth-range`), not between the camera's planes: a scene fills little of the room between those.
///
/// # Source
/// DWB22 Sec. 3.3.2 and App. B.2 (`LinearizeDepth`); the normalisation is ours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearRange {
    v0: f64,
    extent: f64,
}

impl LinearRange {
    /// The range [v0, v1].
    ///
    /// # Errors
    /// [`DepthError::BadRange`] unless 0 < v0 ≤ v1, both finite.
    pub fn new(ViewZ(v0): ViewZ, ViewZ(v1): ViewZ) -> Result<Self, DepthError> {
        if !(v0 > 0.0 && v0 <= v1 && v1.is_finite()) {
            return Err(DepthError::BadRange { v0, v1 });
        }
        Ok(Self { v0, extent: v1 - v0 })
    }

    /// Where a view depth lies in the range, in [0, 1].
    pub fn relative(&self, ViewZ(v): ViewZ) -> f64 {
        if self.extent > 0.0 {
            ((v - self.v0) / self.extent).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

/// Features of every fragment of a pixel: its relative linear depth, the pixel's sum of alpha, and its number of
/// fragments; in f64, rounded to f32 once.
///
/// # Source
/// DWB22 Sec. 3.3.2.
///
/// # Shapes
/// `out: [n, 3]`, row by row.
///
/// # Panics
/// If `out` has another length.
pub fn extract(pixel: Pixel<'_>, range: LinearRange, out: &mut [f32]) {
    const W: usize = COLUMNS.len();
    assert_eq!(out.len(), pixel.len() * W, "one row of {W} features a fragment");
    let sum: f64 = pixel.alpha.iter().map(|&a| f64::from(a)).sum();
    for (row, &v) in out.chunks_exact_mut(W).zip(pixel.view_z) {
        row.copy_from_slice(&[range.relative(ViewZ(v.into())) as f32, sum as f32, pixel.len() as f32]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_fragments_by_hand() {
        let range = LinearRange::new(ViewZ(2.0), ViewZ(6.0)).unwrap();
        let mut out = [f32::NAN; 9];
        extract(
            Pixel {
                view_z: &[3.0, 2.0, 6.0],
                alpha: &[0.5, 0.0, 1.0],
                color: None,
            },
            range,
            &mut out,
        );
        assert_eq!(out, [0.25, 1.5, 3.0, 0.0, 1.5, 3.0, 1.0, 1.5, 3.0]);
        extract(
            Pixel {
                view_z: &[],
                alpha: &[],
                color: None,
            },
            range,
            &mut [],
        );
    }

    #[test]
    fn ranges_are_validated_and_clamp() {
        let one = LinearRange::new(ViewZ(2.0), ViewZ(2.0)).unwrap();
        assert_eq!(one.relative(ViewZ(2.0)), 0.0);
        let range = LinearRange::new(ViewZ(2.0), ViewZ(4.0)).unwrap();
        assert_eq!((range.relative(ViewZ(1.0)), range.relative(ViewZ(9.0))), (0.0, 1.0));
        for (v0, v1) in [(0.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert!(LinearRange::new(ViewZ(v0), ViewZ(v1)).is_err(), "{v0} {v1}");
        }
    }
}
