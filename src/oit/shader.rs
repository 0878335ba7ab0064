//! A method's twin on a GPU: what pass 1 adds up, and the weight that pass 2 makes of it, as WGSL. The
//! module `shader` makes whole passes of it.

use crate::features::MomentDepthKind;
use crate::features::core::CoreSet;

/// How a pixel's colour is made of Σ a w C and Σ a w.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Composite {
    /// (1 − e^−b0)/Σ a w · Σ a w C + e^−b0 C_bg, b0 = sums\[0\].
    ///
    /// # Source
    /// NMT24 Eq. 7.
    Normalised,
    /// Σ a w C + (1 − Σ a w) C_bg; sums need not be kept.
    ///
    /// # Source
    /// Meshkin 2007, [`crate::oit::weighted_sum`].
    Sum,
    /// (1 − t)/Σ a w · Σ a w C + t C_bg with t = (1 − Σ a w/n)^n, n the number of fragments; C_bg alone where Σ a w is
    /// 0.
    ///
    /// # Source
    /// Bavoil, Myers 2008, [`crate::oit::weighted_average`].
    Average,
}

/// How pass 1 makes the numbers of a pixel from its fragments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pass1 {
    /// It adds up what `oit_accumulate` says of each fragment: by blending, or a thread a pixel.
    Added,
    /// It hands the numbers, zeros at first, from one fragment of the pixel to the next, with the pixel's nearest and
    /// farthest v, which a prepass has found: `fn oit_add_to(sums: ptr<function, array<f32, K>>, f: OitFragment,
    /// nearest: f32, farthest: f32)`. A thread a pixel does it in passes over lists; a renderer needs an interlock, or
    /// where the numbers are sums after all, blending and the prepass.
    Inserted,
}

/// A transparency method as WGSL.
///
/// # Contract
/// `source` defines, with `OitFragment` and `OitPixel` as `shader/prelude.wgsl` has them and K = [`Self::sums`]:
/// - `fn oit_accumulate(f: OitFragment) -> array<f32, K>`: what pass 1 adds for a fragment; sums\[0\] is b0, the total
///   absorbance;
/// - `fn oit_weight(f: OitFragment, p: OitPixel) -> f32`: its weight in pass 2, transmittance in front of it;
/// - what [`Self::offers`] says.
///
/// No name of it but these begins with `oit_`.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodShader {
    /// Name on the command line.
    pub name: String,
    /// Numbers that pass 1 adds up, K.
    pub sums: usize,
    /// Whether pass 2 looks at number and range of a pixel's fragments; where not, a renderer need not keep them.
    pub range: bool,
    /// Depth that `OitFragment.z` holds.
    pub depth: MomentDepthKind,
    /// How pass 1 makes them; where [`Pass1::Inserted`], the source defines `oit_add_to` in place of `oit_accumulate`,
    /// and no sum need be b0.
    pub pass1: Pass1,
    /// How the colour is made.
    pub composite: Composite,
    /// Single fragments that pass 1 keeps beside the sums; then the sums are of what their steps stand for, and the
    /// number of fragments that absorb comes last. Blending keeps both ends, atomics what is more.
    pub core: Option<CoreSet>,
    /// Functions of the source beside the two that every method has.
    pub offers: Offers,
    /// The function that passes call for the weight of a fragment: `oit_weight`, or `oit_visible_weight` where that is
    /// offered.
    pub weight: &'static str,
    /// By how much the bounds of a core's tail may leave T open where its network is not asked; 0 where it always is.
    pub open: f32,
    /// WGSL.
    pub source: String,
}

/// Functions that a method's source may have beside `oit_accumulate` and `oit_weight`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Offers {
    /// A shorter way in pixels of up to four fragments or of fragments at one depth, or where the core holds all but
    /// one or two: `fn oit_short_weight(f, p)`, there the same numbers. Methods without a core have with it `fn
    /// oit_end_weight(f, p)`, the same number where a fragment is an end of its pixel or has next to nothing beside it,
    /// else −1.
    pub short_weight: bool,
    /// What spares a network what cannot be seen: `fn oit_visible_weight(f, p)`, `fn oit_faint_weight(f, p)`, `fn
    /// oit_first_hidden_depth(p: OitPixel) -> f32` and `fn oit_hidden_weight(f, p)`, as
    /// [`visible`](crate::features::visible) has them.
    pub visibility: bool,
}

/// The function that gives a fragment's weight.
pub const WEIGHT: &str = "oit_weight";

/// Pass 1 of methods that look at opacity alone: b0.
const TOTAL: &str = include_str!("total.wgsl");

impl MethodShader {
    /// A method that keeps b0 alone and looks at nothing else of a pixel, with its function `oit_weight`.
    pub(crate) fn of_total(name: String, depth: MomentDepthKind, composite: Composite, weight: &str) -> Self {
        Self {
            name,
            sums: 1,
            range: composite == Composite::Average,
            depth,
            composite,
            pass1: Pass1::Added,
            core: None,
            offers: Offers::default(),
            weight: WEIGHT,
            open: 0.0,
            source: format!("{TOTAL}{weight}"),
        }
    }

    /// A method whose pass 1 hands numbers from fragment to fragment.
    pub(super) fn inserted(name: String, sums: usize, source: String) -> Self {
        Self {
            name,
            sums,
            range: true,
            depth: MomentDepthKind::None,
            pass1: Pass1::Inserted,
            composite: Composite::Normalised,
            core: None,
            offers: Offers::default(),
            weight: WEIGHT,
            open: 0.0,
            source,
        }
    }

    /// A core and a tail; passes write its functions from the formulas of [`crate::features::core`].
    pub(crate) fn of_core(name: String, set: CoreSet) -> Self {
        Self {
            name,
            sums: set.moments + 2,
            range: false,
            depth: MomentDepthKind::Log,
            composite: Composite::Normalised,
            pass1: Pass1::Added,
            core: Some(set),
            offers: Offers::default(),
            weight: WEIGHT,
            open: 0.0,
            source: String::new(),
        }
    }

    /// Whether render passes keep its core by atomics on a buffer.
    pub fn needs_atomics(&self) -> bool {
        self.core.is_some_and(|core| !core.is_blended())
    }

    /// A method that weighs all fragments alike.
    pub(super) fn alike(name: &str, composite: Composite) -> Self {
        let weight = include_str!("alike.wgsl");
        Self::of_total(name.to_owned(), MomentDepthKind::None, composite, weight)
    }
}
