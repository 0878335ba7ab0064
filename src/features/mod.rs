//! Feature sets: what the network sees of a fragment. The only place that knows an order of columns.

pub mod colour;
pub mod core;
pub mod deep_weighted_blended;
mod extract;
pub mod paper;
pub mod recentred;
pub mod spec;
pub mod visible;

pub use extract::{Extracted, Extractor, Known, MomentFrame, Sampled, SumPrecision};
pub use spec::FeatureSpec;

use crate::pixel::{FragmentList, abuffer};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::str::FromStr;

/// Makes the enumeration of all feature sets of their names and their [`FeatureSpec`]s, then of cores by their numbers
/// of heavy fragments and moments.
macro_rules! feature_sets {
    ($($(#[doc = $about:literal])* $name:ident => $spec:expr,)*; $($heavy:literal $moments:literal,)*) => {
        /// A feature set: which numbers, in which order, of which moments.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum FeatureSet {
            $($(#[doc = $about])* $name,)*
            /// K heavy fragments besides both ends, and M moments; see [`core`].
            Core(core::Shape),
        }

        impl FeatureSet {
            /// Every feature set, of those with a core the usual ones.
            pub const ALL: [Self; Self::NAMES.len()] = [
                $(Self::$name,)*
                $(Self::Core(core::Shape::new($heavy, $moments)),)*
            ];

            /// Their names, in the same order.
            const NAMES: &'static [&'static str] =
                &[$($spec.name,)* $(concat!("core-", $heavy, "-", $moments),)*];

            /// All that is to be known of it.
            pub fn spec(self) -> &'static FeatureSpec {
                match self {
                    $(Self::$name => &$spec,)*
                    Self::Core(shape) => shape.spec(),
                }
            }
        }

        #[cfg(test)]
        impl schemars::JsonSchema for FeatureSet {
            fn schema_name() -> Cow<'static, str> {
                "FeatureSet".into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!({
                    "description": "A feature set: which numbers, in which order, of which moments.",
                    "oneOf": [$({
                        "const": $spec.name,
                        "description": concat!($($about),*).trim(),
                        "type": "string",
                    },)* {
                        "title": "core-K-M",
                        "pattern": "^core-[0-8]-[1-6]$",
                        "description": core::ABOUT,
                        "type": "string",
                    }],
                })
            }
        }
    };
}

feature_sets! {
    /// NMT24's seven features; see [`paper`].
    Paper => paper::SPEC,
    /// DWB22's three features; see [`deep_weighted_blended`].
    DeepWeightedBlended => deep_weighted_blended::SPEC,
    /// What the other fragments look like from the pixel's own depth range, four moments; see [`recentred`].
    Recentred => recentred::FOUR_MOMENTS,
    /// [`Self::Recentred`] with six moments.
    Recentred6 => recentred::SIX_MOMENTS,
    /// [`Self::Recentred`] with eight moments.
    Recentred8 => recentred::EIGHT_MOMENTS,
    ;
    2 4,
    3 3,
    4 2,
    4 4,
    6 2,
    4 6,
    6 4,
}

impl Serialize for FeatureSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for FeatureSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<'de, str>::deserialize(deserializer)?;
        name.parse().map_err(D::Error::custom)
    }
}

/// A name that no feature set has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown feature set '{name}'; there are {}, and any core-K-M of {}",
    FeatureSet::NAMES.join(", "), core::ABOUT)]
pub struct UnknownFeatureSet {
    name: String,
}

impl FromStr for FeatureSet {
    type Err = UnknownFeatureSet;

    fn from_str(name: &str) -> Result<Self, UnknownFeatureSet> {
        let set = Self::ALL.into_iter().find(|set| set.name() == name);
        set.or_else(|| core::Shape::named(name).map(Self::Core))
            .ok_or_else(|| UnknownFeatureSet { name: name.to_owned() })
    }
}

/// What a network's output number means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputMeaning {
    /// The sigmoid is the transmittance T itself.
    Transmittance,
    /// The sigmoid is the front-to-back factor itself.
    FrontToBackFactor,
    /// The sigmoid s is the share of the other fragments' absorbance in front, and T = exp(−b_0' s).
    AbsorbanceShare,
}

/// Name of the function that holds a network that answers with a share of absorbance, in shader source.
pub const SHARE: &str = "nmt_share";

/// Greatest ln b_0' that an answer is computed with; e^40 is more than anything absorbs, and a finite number in f32.
pub const MAX_LOG_ABSORBANCE: f32 = 40.0;

/// How a network's logit becomes its answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer {
    /// The sigmoid s.
    Sigmoid,
    /// exp(−b s), b = e^min(f, 40) − offset, at least 0, f the feature of a column.
    AbsorbanceShare {
        /// The column.
        column: usize,
        /// What was added before the logarithm.
        offset: f32,
    },
}

impl From<FeatureSet> for Answer {
    fn from(set: FeatureSet) -> Self {
        set.answer()
    }
}

/// What a dataset's rows are answered with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Transmittance; see [`abuffer::transmittance`].
    Transmittance,
    /// Front-to-back factor; see [`abuffer::front_to_back_factor`].
    FrontToBackFactor,
}

impl Target {
    /// Its name in manifests.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transmittance => "transmittance",
            Self::FrontToBackFactor => "front-to-back-factor",
        }
    }

    /// The exact answer for every fragment of a list, in its order, on all cores.
    pub fn of_list(self, list: &FragmentList) -> Vec<f64> {
        match self {
            Self::Transmittance => abuffer::list_transmittance(list),
            Self::FrontToBackFactor => abuffer::list_front_to_back_factor(list),
        }
    }
}

/// Depth that a feature set takes moments of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentDepthKind {
    /// z = 2w − 1, w the window depth.
    Window,
    /// z = 2 ln(v/v0)/ln(v1/v0) − 1, v the view depth, v0 and v1 its extremes in the scene.
    Log,
    /// It takes no moments, and measures view depth linearly between the scene's extremes.
    None,
}

impl FeatureSet {
    /// Its name in configs, model files and file headers.
    pub fn name(self) -> &'static str {
        self.spec().name
    }

    /// Names of the columns, in order.
    pub fn columns(self) -> &'static [&'static str] {
        self.spec().columns
    }

    /// What the columns mean, line by line: part of header comments and metadata.
    pub fn description(self) -> &'static [&'static str] {
        self.spec().description
    }

    /// Number of columns, W.
    pub fn width(self) -> usize {
        self.columns().len()
    }

    /// What a network on these features is trained to give.
    pub fn output(self) -> OutputMeaning {
        self.spec().output
    }

    /// How a logit becomes the answer: what [`Self::output`] means, as arithmetic.
    pub fn answer(self) -> Answer {
        self.spec().answer
    }

    /// Moments that pass 1 adds up besides b_0.
    pub fn moments(self) -> usize {
        self.spec().sums.moments
    }

    /// What its rows of a dataset are answered with.
    pub fn target(self) -> Target {
        self.spec().target
    }

    /// Depth that its moments are taken of.
    pub fn moment_depth(self) -> MomentDepthKind {
        self.spec().depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::{CameraPlanes, DepthError, Pixel};
    use rand::RngExt;

    /// Names parse back, those of cores that are not listed among them. Controls: cores beyond the bounds.
    #[test]
    fn names_parse_back() {
        let cores =
            (0..=8).flat_map(|heavy| (1..=6).map(move |moments| FeatureSet::Core(core::Shape::new(heavy, moments))));
        for set in FeatureSet::ALL.into_iter().chain(cores) {
            assert_eq!(set.name().parse(), Ok(set));
        }
        assert_eq!(FeatureSet::Core(core::Shape::new(8, 1)).name(), "core-8-1");
        for wrong in [
            "core-9-2",
            "core-4-7",
            "core-4-0",
            "core-04-2",
            "core-4",
            "core--1-2",
            "Core-4-2",
        ] {
            assert!(wrong.parse::<FeatureSet>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn names_are_those_of_files() {
        for set in FeatureSet::ALL {
            assert_eq!(serde_json::to_value(set).unwrap(), set.name());
            assert_eq!(set.width(), set.columns().len());
        }
    }

    #[test]
    fn what_is_missing_is_named() {
        let planes = CameraPlanes::new(0.5, 8.0).ok();
        assert_eq!(
            Extractor::new(FeatureSet::Paper, None, Some((1.0, 2.0))).unwrap_err(),
            DepthError::NoPlanes
        );
        assert_eq!(
            Extractor::new(FeatureSet::DeepWeightedBlended, planes, None).unwrap_err(),
            DepthError::NoRange
        );
        assert!(matches!(
            Extractor::new(FeatureSet::DeepWeightedBlended, None, Some((2.0, 1.0))),
            Err(DepthError::BadRange { .. })
        ));
        for set in FeatureSet::ALL {
            let none = FragmentList::new(vec![0, 0], vec![], vec![], None).unwrap();
            let extractor = Extractor::for_list(set, &none, planes, None).unwrap();
            assert_eq!(extractor.set(), set);
            assert_eq!(extractor.list(&none, 0..1).unwrap(), Extracted::default());
        }
    }

    /// The list's own range unless another is given.
    #[test]
    fn the_range_is_the_lists_unless_given() {
        let list = FragmentList::new(vec![0, 2, 3], vec![2.0, 3.0, 6.0], vec![0.5, 0.5, 1.0], None).unwrap();
        let depths = |range| {
            let extracted = Extractor::for_list(FeatureSet::DeepWeightedBlended, &list, None, range)
                .unwrap()
                .list(&list, 0..2)
                .unwrap();
            extracted.features.chunks_exact(3).map(|row| row[0]).collect::<Vec<_>>()
        };
        assert_eq!(depths(None), [0.0, 0.25, 1.0]);
        assert_eq!(depths(Some((1.0, 9.0))), [0.125, 0.25, 0.625]);
    }

    /// Sampled rows against those of [`Extractor::pixel`]: the same fragments, features to f32 rounding (for thin
    /// pixels what rounding of the moments makes of them), targets to 2e-6. Control: the row of the fragment before.
    #[test]
    fn sampled_rows_are_those_of_whole_pixels() {
        let planes = CameraPlanes::new(0.5, 20.0).unwrap();
        for set in [FeatureSet::Paper, FeatureSet::Recentred, FeatureSet::Recentred6] {
            let extractor = Extractor::new(set, Some(planes), Some((0.5, 20.0))).unwrap();
            let width = set.width();
            let mut rng = crate::numeric::rng::stream(1, 92, 0);
            let (mut compared, mut controls) = (0, 0);
            for round in 0..400 {
                let n = 1 + round % 40;
                let view_z: Vec<f32> = (0..n).map(|_| rng.random_range(1.0..15.0)).collect();
                let alpha: Vec<f32> = (0..n).map(|_| rng.random_range(0.01..0.9)).collect();
                let pixel = Pixel {
                    view_z: &view_z,
                    alpha: &alpha,
                    color: None,
                };
                let (mut whole, mut known) = (vec![0.0; n * width], vec![Known::Front(0.0); n]);
                extractor.pixel(pixel, &mut whole, &mut known).unwrap();
                let mut exact = vec![0.0; n];
                abuffer::transmittance(pixel, &mut exact);
                let evaluated: Vec<usize> = (0..n).filter(|&i| known[i] == Known::Front(1.0)).collect();
                let mut rows = Sampled::default();
                extractor.sample(pixel, usize::MAX, &mut rng, &mut rows);
                assert_eq!(
                    (rows.of_pixel, rows.targets.len(), rows.features.len()),
                    (evaluated.len(), evaluated.len(), evaluated.len() * width)
                );
                let off = |row: &[f32], i: usize| {
                    let expected = &whole[i * width..][..width];
                    // The square root of a small spread makes much of rounding; its square does not.
                    let measured = |k: usize, x: f32| if set != FeatureSet::Paper && k >= 6 { x * x } else { x };
                    let bar = |k: usize| if set == FeatureSet::Paper || k < 5 { 2e-5 } else { 2e-2 };
                    row.iter().zip(expected).enumerate().any(|(k, (f, e))| {
                        let off = (measured(k, *f) - measured(k, *e)).abs();
                        off.is_nan() || off > bar(k) * (1.0 + e.abs())
                    })
                };
                for (k, (&i, row)) in evaluated.iter().zip(rows.features.chunks_exact(width)).enumerate() {
                    assert!(
                        !off(row, i) || width > 7,
                        "{set:?} n = {n}: {row:?} for {:?}",
                        &whole[i * width..][..width]
                    );
                    assert!((f64::from(rows.targets[k]) - exact[i]).abs() <= 2e-6);
                    controls += usize::from(k > 0 && off(row, evaluated[k - 1]));
                    compared += 1;
                }
                // Some of them: as many as asked for, each one of the pixel's, none twice.
                let mut some = Sampled::default();
                extractor.sample(pixel, 3, &mut rng, &mut some);
                assert_eq!(some.of_pixel, evaluated.len().min(3));
                let mut seen: Vec<&[f32]> = some.features.chunks_exact(width).collect();
                assert!(
                    seen.iter()
                        .all(|row| rows.features.chunks_exact(width).any(|r| r == *row))
                );
                seen.dedup();
                assert_eq!(seen.len(), some.of_pixel);
            }
            assert!(compared > 5000 && controls > compared / 2);
        }
    }
}
