//! Rows of the networks that answer with a pixel's colour: one a pixel, of random pixels with random colours.

use super::Row;
use crate::features::colour::{ColourSet, Kept};
use crate::numeric::rng::stream;
use crate::pixel::{Pixel, abuffer};
use crate::synth::{Purpose, Synth};
use rand::RngExt;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Keeps the random numbers of colours apart from those of depths and opacities.
const PURPOSE: u64 = 0x1010;

/// Pixels of one task.
const TASK: usize = 256;

/// Colours of a pixel's fragments: each pixel has a palette of uniform colours; in half of the pixels fragments take
/// theirs at random, in the others the palette is gone through from front to back, as objects behind one another are.
/// Each fragment is then darkened by up to a share of the pixel's own, as shading does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColourLaw {
    /// Most colours of a palette; their number is uniform from 1.
    pub palette: u32,
    /// Greatest share that shading takes away, in [0, 1]; a pixel's own is uniform from 0.
    pub shading: f32,
}

impl ColourLaw {
    /// Checks both numbers.
    ///
    /// # Errors
    /// A sentence that names the field.
    pub fn validate(&self) -> Result<(), String> {
        if !(1..=256).contains(&self.palette) {
            return Err(format!("colours.palette = {}: must be from 1 to 256", self.palette));
        }
        if !(0.0..=1.0).contains(&self.shading) {
            return Err(format!("colours.shading = {}: must be from 0 to 1", self.shading));
        }
        Ok(())
    }

    /// Colours of the fragments of pixel `index`.
    fn draw(&self, seed: u64, purpose: Purpose, index: u64, pixel: Pixel<'_>) -> Vec<[f32; 3]> {
        let mut rng = stream(seed, PURPOSE + purpose as u64, index);
        let count = rng.random_range(1..=self.palette) as usize;
        let palette: Vec<[f32; 3]> = (0..count).map(|_| std::array::from_fn(|_| rng.random())).collect();
        let shading = self.shading * rng.random::<f32>();
        let (sorted, n) = (rng.random::<bool>(), pixel.len());
        let mut order = Vec::new();
        abuffer::front_to_back(pixel, &mut order);
        let mut colors = vec![[0.0; 3]; n];
        for (rank, &i) in order.iter().enumerate() {
            let entry = if sorted {
                rank * count / n
            } else {
                rng.random_range(0..count)
            };
            let light = 1.0 - shading * rng.random::<f32>();
            colors[i as usize] = palette[entry].map(|c| c * light);
        }
        colors
    }
}

/// Rows of pixels: what the network sees, the colour that it should answer, and how much an error of it counts.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourRows {
    /// Whose columns they are.
    pub set: ColourSet,
    /// `[N, W]`.
    pub features: Vec<f32>,
    /// `[N, 3]`.
    pub targets: Vec<f32>,
    /// `[N]`: the square of what the network's colour is multiplied by in the pixel, so that the loss is the mean
    /// squared error of the image over pixels that need the network.
    pub weights: Vec<f32>,
}

impl ColourRows {
    /// Rows of the first `count` random pixels of a purpose; pixels whose colour is known without the network have
    /// none. The same rows on any number of threads.
    pub fn of(synth: &Synth, seed: u64, purpose: Purpose, count: usize, law: ColourLaw, set: ColourSet) -> Self {
        let list = synth.pixels(purpose, 0, count);
        let parts: Vec<Self> = (0..count.div_ceil(TASK))
            .into_par_iter()
            .map(|task| {
                let mut part = Self::none(set);
                for p in task * TASK..((task + 1) * TASK).min(count) {
                    let pixel = list.pixel(p);
                    let colors = law.draw(seed, purpose, p as u64, pixel);
                    part.push(Pixel {
                        color: Some(&colors),
                        ..pixel
                    });
                }
                part
            })
            .collect();
        let mut all = Self::none(set);
        for part in parts {
            all.features.extend(part.features);
            all.targets.extend(part.targets);
            all.weights.extend(part.weights);
        }
        all
    }

    fn none(set: ColourSet) -> Self {
        Self {
            set,
            features: Vec::new(),
            targets: Vec::new(),
            weights: Vec::new(),
        }
    }

    fn push(&mut self, pixel: Pixel<'_>) {
        let kept = Kept::of(pixel);
        if kept.needs_network() {
            self.set.features(&kept, &mut self.features);
            self.targets.extend(kept.target(abuffer::composite(pixel, [0.0; 3])));
            let share = kept.share();
            self.weights.push((share * share) as f32);
        }
    }

    /// One of the rows.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn row(&self, index: usize) -> Row<'_> {
        let width = self.set.columns().len();
        Row {
            features: &self.features[index * width..][..width],
            targets: &self.targets[index * 3..][..3],
            weight: self.weights[index],
        }
    }

    /// Number of rows, N.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::SynthConfig;

    /// Rows depend on seed and purpose alone, lie in range, and a palette of one colour without shading has that colour
    /// as target. Control: with more colours it has not.
    #[test]
    fn rows_are_reproducible_and_in_range() {
        let synth = Synth::new(SynthConfig::paper(), 3).unwrap();
        let law = |palette, shading| ColourLaw { palette, shading };
        for set in ColourSet::ALL {
            let rows = |purpose, law| ColourRows::of(&synth, 3, purpose, 600, law, set);
            let one = rows(Purpose::Training, law(8, 0.5));
            let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            assert_eq!(one, alone.install(|| rows(Purpose::Training, law(8, 0.5))));
            assert_ne!(one, rows(Purpose::Validation, law(8, 0.5)));
            assert!(one.len() > 500 && one.features.iter().all(|f| (0.0..=1.0).contains(f)));
            let in_range = |v: &[f32]| v.iter().all(|t| (-1e-5..=1.0 + 1e-5).contains(t));
            assert!(in_range(&one.targets) && in_range(&one.weights));
            let mean = set.columns().iter().position(|c| *c == "tail_mean_r").unwrap();
            let off = |rows: &ColourRows| {
                let differences = (0..rows.len()).map(|i| (rows.row(i).features[mean] - rows.row(i).targets[0]).abs());
                differences.fold(0.0f32, f32::max)
            };
            assert!(off(&rows(Purpose::Training, law(1, 0.0))) < 1e-4);
            assert!(off(&one) > 0.1, "the control");
        }
    }
}
