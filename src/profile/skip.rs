//! What each way of skipping saves on a scene, and what it does to the image.

use super::{ProfileError, Scene};
use crate::evaluate::flip;
use crate::infer::Skip;
use crate::infer::{Switches, Tally};
use crate::model::Mlp;
use crate::oit::neural::Neural;
use serde::Serialize;

/// One way of skipping, measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Skipped {
    /// Its name: those of [`Skip`], and of each switch alone.
    pub skip: &'static str,
    /// Network evaluations that it avoids, as a share of all fragments.
    pub avoided: f64,
    /// What it did.
    #[serde(flatten)]
    pub tally: Tally,
    /// Time of pass 2, repetition by repetition; in each, all ways took turns \[s\].
    pub raw_seconds_pass_2: Vec<f64>,
    /// Median of those \[s\].
    pub seconds: f64,
    /// Median over the repetitions of the time under `none` divided by this one.
    pub speedup: f64,
    /// Error of the image; none where the list makes none.
    pub image: Option<ImageChange>,
}

/// What skipping did to the image.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ImageChange {
    /// Mean squared error against the exact image.
    pub image_mse: f64,
    /// Greatest change of a channel against the image under `exact`.
    pub greatest_change: f64,
    /// Greatest growth of a channel's distance from the exact image, over that under `exact`.
    pub greatest_added_error: f64,
    /// Mean of the FLIP map between the image under `exact` and this one.
    pub flip_change: f64,
}

/// The ways that are compared.
pub fn ways() -> [(&'static str, Switches); 7] {
    let off = Switches::default();
    let exact = Skip::Exact.switches();
    [
        ("none", Skip::None.switches()),
        ("exact", exact),
        ("visible", Skip::Visible.switches()),
        ("ends alone", Switches { ends: true, ..off }),
        ("short stacks alone", Switches { short: true, ..off }),
        ("exact + faint", Switches { faint: true, ..exact }),
        ("exact + hidden", Switches { hidden: true, ..exact }),
    ]
}

/// Measures every way with one network; `progress` is told how many repetitions are done.
///
/// # Errors
/// [`ProfileError`] where the network cannot be applied to the list.
pub fn measure(
    scene: &Scene<'_>,
    mlp: &Mlp,
    repeat: usize,
    progress: &dyn Fn(u64),
) -> Result<Vec<Skipped>, ProfileError> {
    let methods: Vec<Neural> = ways()
        .iter()
        .map(|(_, switches)| Neural::new(mlp.clone()).with_switches(*switches))
        .collect();
    let mut answered = Vec::with_capacity(methods.len());
    for method in &methods {
        answered.push(method.answers(scene.list, scene.context, &|_| {})?);
    }
    let mut seconds = vec![Vec::with_capacity(repeat); methods.len()];
    for turn in 0..repeat {
        for (method, seconds) in methods.iter().zip(&mut seconds) {
            seconds.push(method.answers(scene.list, scene.context, &|_| {})?.tally.seconds_pass_2);
        }
        progress(turn as u64 + 1);
    }
    let reference = scene.image_of(&answered[1].transmittance).transpose()?;
    let mut results = Vec::with_capacity(methods.len());
    for (((skip, _), answered), own) in ways().into_iter().zip(&answered).zip(&seconds) {
        let ratios: Vec<f64> = seconds[0]
            .iter()
            .zip(own)
            .map(|(none, own)| none / own.max(1e-9))
            .collect();
        let image = match (&reference, scene.truth.image()) {
            (Some(reference), Ok(truth)) => {
                let image = scene.image_of(&answered.transmittance).expect("as the reference")?;
                let (mut change, mut added) = (0.0f64, 0.0f64);
                let channels = image
                    .pixels()
                    .as_flattened()
                    .iter()
                    .zip(reference.pixels().as_flattened())
                    .zip(truth.pixels().as_flattened());
                for ((&c, &e), &t) in channels {
                    change = worse(change, (c - e).abs());
                    added = worse(added, (c - t).abs() - (e - t).abs());
                }
                Some(ImageChange {
                    image_mse: image.error(truth)?.mse(),
                    greatest_change: change,
                    greatest_added_error: added,
                    flip_change: flip(reference, &image)?.mean(),
                })
            }
            _ => None,
        };
        let fragments = answered.tally.fragments().max(1) as f64;
        results.push(Skipped {
            skip,
            avoided: 1.0 - answered.tally.rows as f64 / fragments,
            tally: answered.tally,
            seconds: super::median(own),
            speedup: super::median(&ratios),
            raw_seconds_pass_2: own.clone(),
            image,
        });
    }
    Ok(results)
}

/// The greater, and NaN once it has been met.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
