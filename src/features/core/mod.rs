//! Core and tail: single fragments of a pixel, stored one by one, and the sums of all others.
//!
//! Pass 1 adds up b_0..b_M, counts fragments, and keeps the *core*: the nearest, the farthest and the K heaviest of the
//! rest, each in a code of 32 bits; see [`code`]. Pass 2 takes the core and the fragment itself out of the sums, adds
//! what of the core lies in front to the optical depth, and describes the *tail* that is left by its means and spreads
//! within the pixel's own range. A network, or a law without one, says which share s of the tail lies in front:
//!
//! T = exp(−Σ core in front − b_0'' s).
//!
//! So a pixel whose fragments are all in the core is exact, one or two fragments of tail have closed forms, and what is
//! left to the network is light. See [`formulas`] for the arithmetic and [`pixel`] for both passes on the CPU.
//!
//! # Source
//! Hybrid transparency: Maule, Comba, Torchelsen, Bastos, *Hybrid transparency*, I3D 2013, keeps the nearest fragments
//! and
//! averages the rest. Keeping the heaviest, codes that need no interlock, and the tail's moments are this program's.

pub mod code;
pub mod extract;
pub mod formulas;
pub mod pixel;

use super::spec::{ExactRules, FeatureSpec, ShaderCalls, Sums, Tolerances};
use super::{Answer, MomentDepthKind, OutputMeaning, Target};
use crate::numeric::source::{Source, Type};
use crate::synth::SynthConfig;
use code::CodeLayout;

/// Which core and how many moments: the parameters of a feature set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoreSet {
    /// Heavy fragments besides both ends, K, at most [`code::MAX_HEAVY`].
    pub heavy: usize,
    /// Moments besides b_0, M, from 1 to [`MAX_MOMENTS`].
    pub moments: usize,
    /// How the codes are laid out.
    pub layout: CodeLayout,
}

/// Most moments.
pub const MAX_MOMENTS: usize = 6;

/// The layout that the feature sets use: 65,536 steps of depth, 2048 of absorbance to the octave, key A / v^10.
pub const LAYOUT: CodeLayout = CodeLayout {
    depth_bits: 16,
    octave_bits: 11,
    key_exponent: 10.0,
};

/// Column of ln(b_0'' + [`formulas::ABSORBANCE_OFFSET`]).
pub const ABSORBANCE_COLUMN: usize = 2;

/// Columns before the description of the tail.
pub const FIXED: usize = 5;

/// Names of the columns with six moments; with fewer, the first ones.
const COLUMNS: [&str; FIXED + MAX_MOMENTS] = [
    "x",
    "count",
    "ln_b0",
    "lower",
    "upper",
    "mean",
    "spread",
    "inner_mean",
    "inner_spread",
    "inner2_mean",
    "inner2_spread",
];

/// Names of the columns with M moments.
pub const fn columns(moments: usize) -> &'static [&'static str] {
    COLUMNS.split_at(FIXED + moments).0
}

/// What the columns mean.
pub const DESCRIPTION: [&str; 15] = [
    "Pass 1 rounds a fragment to a depth step q and an absorbance step a (nmt_core_steps), which stand for moment",
    "depth z = (2 q + 1)/2^16 - 1 and absorbance A. It adds up b_k = sum of A z^k, counts fragments (n), and",
    "keeps the core in codes of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^10, an atomic",
    "maximum for each slot. Pass 2 takes the core and the fragment itself out of the sums; what is left is the",
    "tail, b_k''. c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;",
    "count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); m_k = moments of the",
    "tail in (z - c)/h, normalised by b_0'': mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2)",
    "times the tail, the spread being its square root; inner2_ of (1 - x^2)^2 times the tail; lower and upper =",
    "least and greatest share of the tail in front of x that m_1..m_4 allow (of fewer moments, m_1 and m_2, or m_1",
    "alone): Markov's bounds. The answer is T =",
    "exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail in front. The network's",
    "function answers with exp(-b_0'' s), which is to be multiplied by exp(-(core in front)). Not part of the",
    "network, and to be applied before it: at or before the nearest: T = 1; no tail: exp(-(core in front)); at or",
    "behind the farthest: all of the tail lies in front; a tail of one fragment, and of two where M >= 3: closed",
    "forms.",
];

impl CoreSet {
    /// A core of K heavy fragments and M moments in the usual layout.
    ///
    /// # Panics
    /// If there are too many of either.
    pub const fn new(heavy: usize, moments: usize) -> Self {
        assert!(heavy <= code::MAX_HEAVY && 1 <= moments && moments <= MAX_MOMENTS);
        Self {
            heavy,
            moments,
            layout: LAYOUT,
        }
    }

    /// Slots of the core: both ends and the heavy ones.
    pub const fn slots(&self) -> usize {
        self.heavy + 2
    }

    /// Slots of a pixel in a shader's buffer, so many that they can be read two at a time.
    pub const fn stride(&self) -> usize {
        self.slots().next_multiple_of(2)
    }

    /// Whether blending keeps the core: there are no heavy fragments, which need atomics.
    pub const fn is_blended(&self) -> bool {
        self.heavy == 0
    }

    /// What pass 1 keeps of a pixel \[bits\]: 32 each for b_0..b_M and the slots, 16 for the count.
    pub const fn bits(&self) -> u32 {
        32 * (1 + self.moments as u32 + self.slots() as u32) + 16
    }
}

const fn spec<const M: usize>(name: &'static str, heavy: usize) -> FeatureSpec {
    let core = CoreSet::new(heavy, M);
    FeatureSpec {
        name,
        columns: columns(M),
        description: &DESCRIPTION,
        sums: Sums {
            moments: M,
            has_precisions: false,
        },
        core: Some(core),
        depth: MomentDepthKind::Log,
        output: OutputMeaning::AbsorbanceShare,
        answer: Answer::AbsorbanceShare {
            column: ABSORBANCE_COLUMN,
            offset: formulas::ABSORBANCE_OFFSET,
        },
        target: Target::Transmittance,
        // Its rows are those that need the network.
        exact: ExactRules::NONE,
        tolerances: Tolerances {
            single: 2e-5,
            half: 1e-1,
            half_mean: 1e-3,
            usual_feature_log2: 4,
        },
        default_pixels: SynthConfig::wide,
        pixel: extract::pixel,
        sample: Some(extract::sample),
        is_sampled: true,
        shader: ShaderCalls {
            write_features: write_features::<M>,
            write_answers: |_| (),
            arguments: columns(0),
            answer: "nmt_transmittance(nmt_features(HEAD, TAIL))",
        },
    }
}

/// The row of features from its parts, as functions behind it take it.
fn write_features<const M: usize>(source: &Source) {
    let about = "The features of a fragment that needs the network, from its five numbers and the means and spreads of \
        the tail.";
    let names = columns(0);
    let numbers = names.iter().map(|&name| (name, Type::Real));
    let parameters: Vec<_> = numbers.chain([("tail", Type::Reals(M))]).collect();
    source.begin_function("nmt_features", about, &parameters, Type::Reals(FIXED + M));
    let row: Vec<_> = names
        .iter()
        .map(|name| source.real(name))
        .chain(source.reals::<M>("tail"))
        .collect();
    source.return_numbers(&row);
}

/// What K and M are in the names of feature sets, `core-K-M`.
pub const ABOUT: &str = "K heavy fragments besides both ends, from 0 to 8, and M moments, from 1 to 6";

/// A feature set with a core: which K and which M.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    heavy: usize,
    moments: usize,
}

impl Shape {
    /// K heavy fragments and M moments.
    ///
    /// # Panics
    /// If there are too many of either, or no moments.
    pub const fn new(heavy: usize, moments: usize) -> Self {
        let CoreSet { heavy, moments, .. } = CoreSet::new(heavy, moments);
        Self { heavy, moments }
    }

    /// M.
    pub const fn moments(self) -> usize {
        self.moments
    }

    /// The one of this name; none where it is no such name.
    pub fn named(name: &str) -> Option<Self> {
        let mut specs = SPECS.iter().flatten();
        let core = specs.find(|spec| spec.name == name)?.core?;
        Some(Self::new(core.heavy, core.moments))
    }

    /// All that is to be known of it.
    pub fn spec(self) -> &'static FeatureSpec {
        &SPECS[self.heavy][self.moments - 1]
    }
}

macro_rules! specs {
    ($($heavy:literal)*) => {
        [$([
            spec::<1>(concat!("core-", $heavy, "-1"), $heavy),
            spec::<2>(concat!("core-", $heavy, "-2"), $heavy),
            spec::<3>(concat!("core-", $heavy, "-3"), $heavy),
            spec::<4>(concat!("core-", $heavy, "-4"), $heavy),
            spec::<5>(concat!("core-", $heavy, "-5"), $heavy),
            spec::<6>(concat!("core-", $heavy, "-6"), $heavy),
        ]),*]
    };
}

/// Every feature set with a core, by K and by M - 1.
static SPECS: [[FeatureSpec; MAX_MOMENTS]; code::MAX_HEAVY + 1] = specs!(0 1 2 3 4 5 6 7 8);
