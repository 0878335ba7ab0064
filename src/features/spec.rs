//! What the rest of the program must know of a feature set, in one value.
//!
//! # How a feature set registers
//!
//! 1. Its file or folder in `features/` holds a constant [`FeatureSpec`], and the formulas and functions that it names.
//! 2. The table at the top of `features/mod.rs` gets one line: the name of the variant, and that constant.
//!
//! Nothing else knows sets by name: the dataset, the trainers, the exports, the checks and the passes ask
//! [`FeatureSet::spec`](super::FeatureSet::spec). A set whose formulas are written over [`Real`](crate::numeric::Real)
//! gives its shader functions by running them on a [`Source`].
//!
//! # Learned sums
//!
//! What pass 1 adds up is fixed by [`FeatureSpec::pixel`] and [`FeatureSpec::sample`], which make features of a pixel
//! at once, so that a trainer never meets the fragments. Training that reaches into pass 1 would hook in there:
//! [`Sums`] would name a basis, functions of depth and absorbance with parameters, `sample` would hand rows of
//! fragments to the trainer beside their features, and the trainer would carry the gradient of the features on to the
//! parameters of the basis.

use super::core::CoreSet;
use super::{Answer, Extractor, Known, MomentDepthKind, OutputMeaning, Sampled, Target};
use crate::numeric::rng::Stream;
use crate::numeric::source::Source;
use crate::pixel::{DepthError, Pixel};
use crate::synth::SynthConfig;

/// Everything that the rest of the program must know of a feature set; see the [module](self).
#[derive(Debug, Clone, Copy)]
pub struct FeatureSpec {
    /// Its name in configs, model files and file headers.
    pub name: &'static str,
    /// Names of the columns, in order.
    pub columns: &'static [&'static str],
    /// What the columns mean, line by line: part of header comments and metadata.
    pub description: &'static [&'static str],
    /// What pass 1 keeps of a pixel.
    pub sums: Sums,
    /// Single fragments that pass 1 keeps besides, and that pass 2 takes out of the sums; none of most sets. The
    /// network then answers with the transmittance of what is left.
    pub core: Option<CoreSet>,
    /// Depth that moments are taken of, and with it what must be known of camera and scene.
    pub depth: MomentDepthKind,
    /// What a network on these features is trained to give.
    pub output: OutputMeaning,
    /// How a logit becomes the answer: what `output` means, as arithmetic.
    pub answer: Answer,
    /// What rows of a dataset are answered with.
    pub target: Target,
    /// What is answered without the network.
    pub exact: ExactRules,
    /// How far exports may be off.
    pub tolerances: Tolerances,
    /// Pixels that a network is checked on where its file does not tell what it was trained on.
    pub default_pixels: fn() -> SynthConfig,
    /// Features of every fragment of a pixel; see [`Extractor::pixel`].
    pub pixel: PixelRows,
    /// Rows of some fragments of a pixel, for sets that are trained on transmittances; see [`Extractor::sample`].
    pub sample: Option<Sampler>,
    /// Whether a dataset holds such rows, drawn pixel by pixel, and not every fragment of its pixels.
    pub is_sampled: bool,
    /// Its shader functions.
    pub shader: ShaderCalls,
}

impl FeatureSpec {
    /// Whether two passes that blend their sums are all that an answer needs, and the answer is a transmittance: such
    /// sets have calls and whole passes in shader source.
    pub fn has_blended_passes(&self) -> bool {
        let is_blended = self.core.is_none_or(|core| core.is_blended());
        is_blended && self.target == Target::Transmittance
    }
}

/// What fills in the features of a pixel's fragments and what is known of them; see [`Extractor::pixel`].
pub type PixelRows = fn(&Extractor, Pixel<'_>, &mut [f32], &mut [Known]) -> Result<(), DepthError>;

/// What draws rows of some fragments of a pixel: at most so many of them, by random numbers of the pixel's own.
pub type Sampler = fn(&Extractor, Pixel<'_>, usize, &mut Stream, &mut Sampled);

/// What pass 1 keeps of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sums {
    /// Moments that it adds up besides b_0.
    pub moments: usize,
    /// Whether precision and frame of the moments may be chosen; see [`SumPrecision`](super::SumPrecision) and
    /// [`MomentFrame`](super::MomentFrame).
    pub has_precisions: bool,
}

/// What a set answers without the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExactRules {
    /// The nearest and the farthest of a pixel, and fragments beside which there is next to nothing.
    pub ends: bool,
    /// Pixels of up to so many fragments are answered in closed form; 0 where there is none.
    pub closed_forms: u32,
}

impl ExactRules {
    /// The network answers everything.
    pub const NONE: Self = Self {
        ends: false,
        closed_forms: 0,
    };
}

/// How far exports may be off on rows of the training distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Greatest absolute error of the answer in f32.
    pub single: f64,
    /// Greatest absolute error with hidden layers in f16, against f64.
    pub half: f64,
    /// Greatest mean error with hidden layers in f16, against f64.
    pub half_mean: f64,
    /// Greatest feature that is usual, as a power of two: a network whose hidden layers could overflow f16 on it has no
    /// export in f16.
    pub usual_feature_log2: i32,
}

/// Functions of a set in shader source.
#[derive(Debug, Clone, Copy)]
pub struct ShaderCalls {
    /// Writes the functions that the network stands behind: those of pass 1, and the features.
    pub write_features: fn(&Source),
    /// Writes the functions that stand behind the network and call it.
    pub write_answers: fn(&Source),
    /// What a fragment's row of arguments holds, the moments not counted, which come last.
    pub arguments: &'static [&'static str],
    /// The answer to such a row in WGSL, with `HEAD` for the arguments and `TAIL` for the moments as one value.
    pub answer: &'static str,
}
