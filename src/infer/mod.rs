//! Answers of a network for whole fragment lists, fast: both passes, classes of fragments, and what the network is
//! spared.

pub mod classes;
pub mod core;
pub mod passes;
mod queue;
pub mod tiled;

pub use classes::{Class, Skip, Switches, Tally};
pub use passes::Passes;
pub use tiled::Tiled;

use crate::features::{Extracted, Extractor, Known};
use crate::model::Mlp;
use crate::pixel::{DepthError, FragmentList, abuffer};
use std::time::Instant;

/// A network's answers, and what was done for them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answered {
    /// Transmittance (or the like) of every fragment, in the order of the list.
    pub transmittance: Vec<f32>,
    /// What decided each.
    pub classes: Vec<Class>,
    /// How many fragments each class has, and how long it took.
    pub tally: Tally,
}

/// Greatest b_0 of a pixel that shows less than half a display step: 1 − e^−b_0 < 1/512.
const MIN_OPACITY: f64 = 1.0 / 512.0;

/// A network's answers for every fragment of a list, with what decided each, and how long both passes took. `progress`
/// is told how many fragments are done.
///
/// Recentred features are made in f32, sixteen at once ([`Passes`]); the others in f64, rounded to f32. The forward
/// pass is f32.
///
/// # Errors
/// [`DepthError`] where a fragment lies outside of the camera's planes.
pub fn answers(
    mlp: &Mlp,
    extractor: &Extractor,
    list: &FragmentList,
    switches: Switches,
    progress: &dyn Fn(u64),
) -> Result<Answered, DepthError> {
    // Pixels are taken in runs of about this many fragments, so that what is made of them stays a few megabytes.
    const RUN: u64 = 1 << 18;
    let passes = Passes::of(extractor);
    let tiled = Tiled::new(mlp);
    let offsets = list.offsets();
    let mut answered = Answered {
        transmittance: vec![0.0; list.len()],
        classes: vec![Class::Network; list.len()],
        tally: Tally::default(),
    };
    let mut first = 0;
    while first < list.pixels() {
        let end = offsets
            .partition_point(|&o| o < offsets[first] + RUN)
            .clamp(first + 1, list.pixels());
        let fragments = offsets[first] as usize..offsets[end] as usize;
        let (out, classes) = (
            &mut answered.transmittance[fragments.clone()],
            &mut answered.classes[fragments.clone()],
        );
        let tally = match passes {
            Some(passes) => passes.run(list, first..end, switches, || tiled.answers_to_columns(), out, classes),
            None if extractor.set().spec().core.is_some() => {
                let (set, codes) = extractor.codes();
                core::run(
                    (&set, &codes),
                    core::Tail::Network(&tiled),
                    list,
                    first..end,
                    switches,
                    out,
                    classes,
                )
            }
            None => pixel_by_pixel(mlp, extractor, list, first..end, switches, out, classes)?,
        };
        answered.tally.add(&tally);
        first = end;
        progress(fragments.end as u64);
    }
    Ok(answered)
}

/// Features that are made pixel by pixel: the network is evaluated for all fragments that they do not know, but for
/// pixels that hardly show.
fn pixel_by_pixel(
    mlp: &Mlp,
    extractor: &Extractor,
    list: &FragmentList,
    pixels: std::ops::Range<usize>,
    switches: Switches,
    out: &mut [f32],
    classes: &mut [Class],
) -> Result<Tally, DepthError> {
    let start = Instant::now();
    let Extracted { known, mut features } = extractor.list(list, pixels.clone())?;
    let seconds_pass_1 = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let offsets = list.offsets();
    let width = extractor.set().width();
    for p in pixels.clone() {
        let own = (offsets[p] - offsets[pixels.start]) as usize..(offsets[p + 1] - offsets[pixels.start]) as usize;
        // Both mean colours lie in [0, 1], whatever the weights: the image changes by at most 1 − e^−b_0.
        let b0 = if switches.faint {
            abuffer::total_absorbance(list.pixel(p))
        } else {
            f64::INFINITY
        };
        for i in own {
            (out[i], classes[i]) = match known[i] {
                Known::Transmittance(t) => (t, Class::Known),
                Known::Front(_) if b0 <= MIN_OPACITY => (libm::exp(-0.5 * b0) as f32, Class::Faint),
                Known::Front(front) => (front, Class::Network),
            };
        }
    }
    let (mut kept, mut row) = (0, 0);
    for (i, class) in classes.iter().enumerate() {
        if matches!(known[i], Known::Front(_)) {
            if *class == Class::Network {
                features.copy_within(row * width..(row + 1) * width, kept * width);
                kept += 1;
            }
            row += 1;
        }
    }
    features.truncate(kept * width);
    let mut tally = Tally {
        rows: kept as u64,
        seconds_pass_1,
        ..Tally::default()
    };
    let mut answers = mlp.predict(&features).into_iter();
    for (out, &class) in out.iter_mut().zip(&*classes) {
        if class == Class::Network {
            *out *= answers.next().expect("one answer a question");
        }
        tally.classes[class as usize] += 1;
    }
    tally.seconds_pass_2 = start.elapsed().as_secs_f64();
    Ok(tally)
}
