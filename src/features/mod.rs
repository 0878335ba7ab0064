//! Feature sets: what the network sees of a fragment. The only place that knows an order of columns.

pub mod paper;

use crate::pixel::{CameraPlanes, DepthError, FragmentList, Pixel};
use serde::{Deserialize, Serialize};

/// A feature set: which numbers, in which order, of which moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FeatureSet {
    /// NMT24's seven features; see [`paper`].
    Paper,
}

/// What a network's output number means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputMeaning {
    /// The sigmoid is the transmittance T itself.
    Transmittance,
}

/// Depth that a feature set takes moments of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentDepthKind {
    /// z = 2w − 1, w the window depth.
    Window,
}

impl FeatureSet {
    /// Every feature set.
    pub const ALL: [Self; 1] = [Self::Paper];

    /// Its name in configs, model files and file headers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
        }
    }

    /// Names of the columns, in order.
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::COLUMNS,
        }
    }

    /// What the columns mean, line by line: part of header comments and metadata.
    pub fn description(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &paper::DESCRIPTION,
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
        }
    }

    /// Depth that its moments are taken of.
    pub fn moment_depth(self) -> MomentDepthKind {
        match self {
            Self::Paper => MomentDepthKind::Window,
        }
    }
}

/// A feature set together with what it must know of the camera: turns pixels into rows of features.
#[derive(Debug, Clone, Copy)]
pub struct Extractor {
    set: FeatureSet,
    planes: CameraPlanes,
}

impl Extractor {
    /// An extractor for pixels that a camera with these planes saw.
    ///
    /// # Errors
    /// [`DepthError::NoPlanes`] where the set needs window depth and no planes are given.
    pub fn new(set: FeatureSet, planes: Option<CameraPlanes>) -> Result<Self, DepthError> {
        match set {
            FeatureSet::Paper => Ok(Self { set, planes: planes.ok_or(DepthError::NoPlanes)? }),
        }
    }

    /// The feature set.
    pub fn set(&self) -> FeatureSet {
        self.set
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
        match self.set {
            FeatureSet::Paper => paper::extract(pixel, self.planes, out),
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
        let width = self.set.width();
        let fragments = list.offsets()[range.end] - list.offsets()[range.start];
        let mut rows = vec![0.0; fragments as usize * width];
        list.par_pixels(range, &mut rows, width, |_, pixel, out| self.pixel(pixel, out))?;
        Ok(rows)
    }
}
