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
//! Hybrid transparency: Maule, Comba, Torchelsen, Bastos, *Hybrid transparency*, I3D 2013, keeps the nearest fragments and
//! averages the rest. Keeping the heaviest, codes that need no interlock, and the tail's moments are this program's.

pub mod code;

pub mod formulas;
pub mod pixel;

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

/// The layout that the feature sets use: 65,536 steps of depth, 2048 of absorbance to the octave, key A / v^6.
pub const LAYOUT: CodeLayout = CodeLayout {
    depth_bits: 16,
    octave_bits: 11,
    key_exponent: 6.0,
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
    "in_core",
    "range",
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
pub const DESCRIPTION: [&str; 12] = [
    "Pass 1 rounds each fragment to a depth step q and an absorbance step a (nmt_core_fragment), which stand for moment depth",
    "z = (2 q + 1)/2^16 - 1 and absorbance A; it adds up b_k = sum of A z^k, counts fragments (n) and keeps the core in codes",
    "of 32 bits: nearest, farthest, and the K heaviest of the rest by A / v^6, with an atomic maximum for each slot.",
    "Pass 2 takes the core and the fragment itself out of the sums; what is left is the tail, b_k''.",
    "c and h are middle and half of the range of z from the nearest to the farthest; x = (z - c)/h;",
    "count = log2 of the number of fragments in the tail, /3 - 1; ln_b0 = ln(b_0'' + 0.05); in_core = 1 for a fragment of the core;",
    "range = ln(h + 1e-4)/5; m_k = moments of the tail in (z - c)/h, normalised by b_0'':",
    "mean = m_1, spread = (m_2 - m_1^2)/(1 - m_1^2); inner_ of (1 - x^2) times the tail, the spread its square root; inner2_ of",
    "(1 - x^2)^2 times the tail.",
    "The answer is T = exp(-(core in front) - b_0'' s), s the network's sigmoid: the share of the tail that lies in front.",
    "Not part of the network, and to be applied before it: no core in front: T = 1; no tail: T = exp(-(core in front));",
    "behind or at the farthest: all of the tail lies in front; one fragment of tail, and two where M >= 3: closed forms.",
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

    /// What pass 1 keeps of a pixel \[bits\]: 32 each for b_0..b_M and the slots, 16 for the count.
    pub const fn bits(&self) -> u32 {
        32 * (1 + self.moments as u32 + self.slots() as u32) + 16
    }
}
