//! Coloured transmittance: what methods of one transmittance make of tinted glass, and what three channels of sums make
//! of it.

use super::{EvaluateError, Image};
use crate::oit::{self, Capabilities, Context, Method};
use crate::pixel::{FragmentList, abuffer};
use serde::{Deserialize, Serialize};

/// Glass tinted in its own colour, by a strength s in [0, 1]: a fragment of opacity a and colour C lets 1 − a (1 − s C)
/// of a channel through and adds a (1 − s) C to it. At s = 0 it is the usual fragment, at s = 1 a filter that reflects
/// nothing.
///
/// Each channel is a list of usual fragments of its own, of opacity a (1 − s C) and colour (1 − s) C/(1 − s C): the
/// over operator and every method apply to it as they stand.
#[derive(Debug)]
pub struct Tinted {
    /// Lists of the channels, opacity and colour of each; red, green, blue.
    channels: [FragmentList; 3],
    /// The list that a method of one transmittance sees: opacity is the mean of the channels'.
    scalar: FragmentList,
    exact: Image,
}

/// Errors of a method on tinted glass. In JSON, NaN becomes null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TintedResult {
    /// Strength of the tint, s.
    pub strength: f64,
    /// Mean squared error of the image where one transmittance serves all channels: that of the mean opacity.
    pub scalar_image_mse: f64,
    /// Mean squared error of the image where each channel has sums of its own.
    pub three_channel_image_mse: f64,
    /// Memory of three channels besides the colour accumulator \[bits\]: three times that of one, ranges and counts
    /// too; none where it grows with the scene. Passes stay as many.
    pub three_channel_bits_per_pixel: Option<u32>,
}

impl Tinted {
    /// The glass that a list's fragments are made of.
    ///
    /// # Errors
    /// [`EvaluateError`] where the list makes no image.
    ///
    /// # Panics
    /// If the strength is not in [0, 1].
    pub fn new(list: &FragmentList, strength: f64, background: [f64; 3]) -> Result<Self, EvaluateError> {
        assert!((0.0..=1.0).contains(&strength), "a strength lies in [0, 1]");
        let (width, height) = super::image::size_of(list)?;
        let colors = list.color().unwrap_or(&[]);
        let of_channel = |channel: usize| {
            let alpha_of = |(&a, c): (&f32, &[f32; 3])| opacity(a, c[channel], strength);
            let alpha = list.alpha().iter().zip(colors).map(alpha_of).collect();
            let color_of = |c: &[f32; 3]| {
                let c = f64::from(c[channel]);
                let left = 1.0 - strength * c;
                [if left > 0.0 {
                    ((1.0 - strength) * c / left).min(1.0) as f32
                } else {
                    0.0
                }; 3]
            };
            with(list, alpha, colors.iter().map(color_of).collect(), (width, height))
        };
        let channels = [of_channel(0), of_channel(1), of_channel(2)];
        let mean = |i: usize| channels.iter().map(|c| f64::from(c.alpha()[i])).sum::<f64>() / 3.0;
        let alpha: Vec<f32> = (0..list.len()).map(|i| mean(i).min(1.0) as f32).collect();
        // What a fragment adds to a channel, a (1 − s) C, over the opacity that the method knows.
        let color = colors.iter().zip(list.alpha()).zip(&alpha).map(|((c, &a), &mean)| {
            let of = |c: f32| (f64::from(a) * (1.0 - strength) * f64::from(c) / f64::from(mean)).min(1.0) as f32;
            c.map(|c| if mean > 0.0 { of(c) } else { 0.0 })
        });
        let scalar = with(list, alpha.clone(), color.collect(), (width, height));
        let pixels = (0..list.pixels()).map(|p| {
            let of = |channel: usize| abuffer::composite(channels[channel].pixel(p), background)[channel];
            [of(0), of(1), of(2)]
        });
        let exact = Image::new(width, height, pixels.collect())?;
        Ok(Self {
            scalar,
            channels,
            exact,
        })
    }

    /// The exact image.
    pub fn exact(&self) -> &Image {
        &self.exact
    }

    /// Both ways of a method.
    ///
    /// # Errors
    /// [`EvaluateError`] where it cannot be applied to the list.
    pub fn judge(
        &self,
        method: &dyn Method,
        context: Context,
        strength: f64,
        background: [f64; 3],
    ) -> Result<TintedResult, EvaluateError> {
        let image = |list: &FragmentList| -> Result<Image, EvaluateError> {
            let accumulated = method.accumulate(list, context)?;
            let weights = oit::weights(list, &*accumulated);
            super::image::of_method(list, &*accumulated, &weights, background)
        };
        let scalar = image(&self.scalar)?;
        let channels = [
            image(&self.channels[0])?,
            image(&self.channels[1])?,
            image(&self.channels[2])?,
        ];
        let pixels = (0..self.scalar.pixels()).map(|p| std::array::from_fn(|c| channels[c].pixels()[p][c]));
        let three = Image::new(self.exact.width(), self.exact.height(), pixels.collect())?;
        let Capabilities { bits_per_pixel, .. } = method.capabilities();
        Ok(TintedResult {
            strength,
            scalar_image_mse: scalar.error(&self.exact)?.mse(),
            three_channel_image_mse: three.error(&self.exact)?.mse(),
            three_channel_bits_per_pixel: bits_per_pixel.map(|bits| 3 * bits),
        })
    }
}

/// Opacity of a channel, a (1 − s C).
fn opacity(alpha: f32, color: f32, strength: f64) -> f32 {
    (f64::from(alpha) * (1.0 - strength * f64::from(color))) as f32
}

/// The same pixels with other opacities and colours.
fn with(list: &FragmentList, alpha: Vec<f32>, color: Vec<[f32; 3]>, (width, height): (u32, u32)) -> FragmentList {
    let color = (list.color().is_some() || list.is_empty()).then_some(color);
    let made = FragmentList::new(list.offsets().to_vec(), list.view_z().to_vec(), alpha, color)
        .and_then(|list| list.with_size(width, height))
        .expect("opacities and colours stay in [0, 1]");
    match list.planes() {
        Some(planes) => made.with_planes(planes),
        None => made,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::judge::tests::colored_list;
    use crate::oit::parse;

    /// By hand: a filter (s = 1) of opacity 1/2 and colour (1, 1/2, 0) over white lets (1, 3/4, 1/2) through and adds
    /// nothing; at s = 0 all is as usual.
    #[test]
    fn one_pane_by_hand() {
        let pane = FragmentList::new(vec![0, 1], vec![1.0], vec![0.5], Some(vec![[1.0, 0.5, 0.0]])).unwrap();
        let pane = pane.with_size(1, 1).unwrap();
        let filtered = Tinted::new(&pane, 1.0, [1.0; 3]).unwrap();
        let expected = [1.0, 0.75, 0.5];
        let found = filtered.exact().pixels()[0];
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7),
            "{found:?}"
        );
        let usual = Tinted::new(&pane, 0.0, [1.0; 3]).unwrap().exact().pixels()[0];
        assert!(
            usual.iter().zip([1.0, 0.75, 0.5]).all(|(a, b)| (a - b).abs() < 1e-7),
            "{usual:?}"
        );
    }

    /// Three channels of an exact method are exact; one transmittance is not, unless nothing is tinted.
    #[test]
    fn one_transmittance_is_not_enough() {
        let list = colored_list(20, 15);
        let judge = |strength| {
            let tinted = Tinted::new(&list, strength, [1.0; 3]).unwrap();
            let method = parse("abuffer").unwrap();
            tinted.judge(&*method, Context::default(), strength, [1.0; 3]).unwrap()
        };
        let tinted = judge(0.8);
        assert!(
            tinted.three_channel_image_mse < 1e-20 && tinted.scalar_image_mse > 1e-3,
            "{tinted:?}"
        );
        let usual = judge(0.0);
        assert!(usual.scalar_image_mse < 1e-12, "{usual:?}");
        assert_eq!(tinted.three_channel_bits_per_pixel, None);
        let method = parse("moment-power-4").unwrap();
        let tinted = Tinted::new(&list, 0.5, [1.0; 3]).unwrap();
        let found = tinted.judge(&*method, Context::default(), 0.5, [1.0; 3]).unwrap();
        assert_eq!(found.three_channel_bits_per_pixel, Some(480));
        assert!(found.three_channel_image_mse < found.scalar_image_mse, "{found:?}");
    }
}
