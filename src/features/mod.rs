//! Feature sets: what the network sees of a fragment. The only place that knows an order of columns.

pub mod deep_weighted_blended;
pub mod paper;

use crate::pixel::{CameraPlanes, DepthError, FragmentList, Pixel, ViewZ, abuffer};
use deep_weighted_blended::LinearRange;
use serde::{Deserialize, Serialize};

/// A feature set: which numbers, in which order, of which moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FeatureSet {
    /// NMT24's seven features; see [`paper`].
    Paper,
    /// DWB22's three features; see [`deep_weighted_blended`].
    DeepWeightedBlended,
}

/// What a network's output number means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputMeaning {
    /// The sigmoid is the transmittance T itself.
    Transmittance,
    /// The sigmoid is the front-to-back factor itself.
    FrontToBackFactor,
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
    /// It takes no moments.
    None,
}

impl FeatureSet {
    /// Every feature set.
    pub const ALL: [Self; 2] = [Self::Paper, Self::DeepWeightedBlended];

    /// Its name in configs, model files and file headers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::DeepWeightedBlended => "deep-weighted-blended",
        }
    }

    /// Names of the columns, in order.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::COLUMNS,
            Self::DeepWeightedBlended => &deep_weighted_blended::COLUMNS,
        }
    }

    /// What the columns mean, line by line: part of header comments and metadata.
    pub fn description(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::DESCRIPTION,
            Self::DeepWeightedBlended => &deep_weighted_blended::DESCRIPTION,
        }
    }

    /// Number of columns, W.
    pub fn width(self) -> usize {
        self.columns().len()
    }

    /// What a network on these features is trained to give.
    pub fn output(self) -> OutputMeaning {
        match self {
            Self::Paper => OutputMeaning::Transmittance,
            Self::DeepWeightedBlended => OutputMeaning::FrontToBackFactor,
        }
    }

    /// What its rows of a dataset are answered with.
    pub fn target(self) -> Target {
        match self {
            Self::Paper => Target::Transmittance,
            Self::DeepWeightedBlended => Target::FrontToBackFactor,
        }
    }

    /// Depth that its moments are taken of.
    pub fn moment_depth(self) -> MomentDepthKind {
        match self {
            Self::Paper => MomentDepthKind::Window,
            Self::DeepWeightedBlended => MomentDepthKind::None,
        }
    }
}

/// A feature set together with what it must know of the camera and the scene: turns pixels into rows of features.
#[derive(Debug, Clone, Copy)]
pub struct Extractor(Kind);

#[derive(Debug, Clone, Copy)]
enum Kind {
    Paper(CameraPlanes),
    DeepWeightedBlended(LinearRange),
}

impl Extractor {
    /// An extractor for pixels that a camera with these planes saw, of a scene whose view depths span this range.
    ///
    /// # Errors
    /// [`DepthError::NoPlanes`] where the set needs window depth and no planes are given; [`DepthError::NoRange`] where it needs depth relative to
    /// the scene and no range is given; [`DepthError::BadRange`] where that range is none.
    pub fn new(set: FeatureSet, planes: Option<CameraPlanes>, depth_range: Option<(f32, f32)>) -> Result<Self, DepthError> {
        match set {
            FeatureSet::Paper => Ok(Self(Kind::Paper(planes.ok_or(DepthError::NoPlanes)?))),
            FeatureSet::DeepWeightedBlended => {
                let (v0, v1) = depth_range.ok_or(DepthError::NoRange)?;
                Ok(Self(Kind::DeepWeightedBlended(LinearRange::new(ViewZ(v0.into()), ViewZ(v1.into()))?)))
            }
        }
    }

    /// An extractor for the pixels of a list; planes and range that are not given are the list's own.
    ///
    /// # Errors
    /// As [`Self::new`], but a range is always known.
    pub fn for_list(set: FeatureSet, list: &FragmentList, planes: Option<CameraPlanes>, depth_range: Option<(f32, f32)>) -> Result<Self, DepthError> {
        // A list without fragments has no range, and nothing to apply one to.
        let depth_range = depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
        Self::new(set, planes.or(list.planes()), Some(depth_range))
    }

    /// The feature set.
    pub fn set(&self) -> FeatureSet {
        match self.0 {
            Kind::Paper(_) => FeatureSet::Paper,
            Kind::DeepWeightedBlended(_) => FeatureSet::DeepWeightedBlended,
        }
    }

    /// Features of every fragment of a pixel, in the order of its fragments.
    ///
    /// # Shapes
    /// `out: [n, W]`, row by row.
    ///
    /// # Errors
    /// [`DepthError::OutsidePlanes`] where a fragment lies outside the camera's planes.
    ///
    /// # Panics
    /// If `out` has another length.
    pub fn pixel(&self, pixel: Pixel<'_>, out: &mut [f32]) -> Result<(), DepthError> {
        match self.0 {
            Kind::Paper(planes) => paper::extract(pixel, planes, out),
            Kind::DeepWeightedBlended(range) => {
                deep_weighted_blended::extract(pixel, range, out);
                Ok(())
            }
        }
    }

    /// Features of every fragment of pixels `range` of a list, in the order of the list, on all cores.
    ///
    /// # Shapes
    /// The result is `[F', W]`, row by row, F' = fragments of those pixels.
    ///
    /// # Errors
    /// As [`Self::pixel`].
    pub fn list(&self, list: &FragmentList, range: std::ops::Range<usize>) -> Result<Vec<f32>, DepthError> {
        let width = self.set().width();
        let fragments = list.offsets()[range.end] - list.offsets()[range.start];
        let mut rows = vec![0.0; fragments as usize * width];
        list.par_pixels(range, &mut rows, width, |_, pixel, out| self.pixel(pixel, out))?;
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(Extractor::new(FeatureSet::Paper, None, Some((1.0, 2.0))).unwrap_err(), DepthError::NoPlanes);
        assert_eq!(Extractor::new(FeatureSet::DeepWeightedBlended, planes, None).unwrap_err(), DepthError::NoRange);
        assert!(matches!(Extractor::new(FeatureSet::DeepWeightedBlended, None, Some((2.0, 1.0))), Err(DepthError::BadRange { .. })));
        for set in FeatureSet::ALL {
            let none = FragmentList::new(vec![0, 0], vec![], vec![], None).unwrap();
            let extractor = Extractor::for_list(set, &none, planes, None).unwrap();
            assert_eq!(extractor.set(), set);
            assert!(extractor.list(&none, 0..1).unwrap().is_empty());
        }
    }

    /// The list's own range unless another is given.
    #[test]
    fn the_range_is_the_lists_unless_given() {
        let list = FragmentList::new(vec![0, 2, 3], vec![2.0, 3.0, 6.0], vec![0.5, 0.5, 1.0], None).unwrap();
        let depths = |range| {
            let rows = Extractor::for_list(FeatureSet::DeepWeightedBlended, &list, None, range).unwrap().list(&list, 0..2).unwrap();
            rows.chunks_exact(3).map(|row| row[0]).collect::<Vec<_>>()
        };
        assert_eq!(depths(None), [0.0, 0.25, 1.0]);
        assert_eq!(depths(Some((1.0, 9.0))), [0.125, 0.25, 0.625]);
    }
}
