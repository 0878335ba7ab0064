//! Images of what a method, and the A-buffer, make of a fragment list.

use super::EvaluateError;
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::Accumulated;
use crate::pixel::{FragmentList, Pixel, abuffer};
use rayon::prelude::*;

/// A linear RGB image, row by row from the top left corner; channels are as computed, neither clamped nor checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f64; 3]>,
}

impl Image {
    /// An image from its pixels.
    ///
    /// # Shapes
    /// `pixels: [height * width]`, row by row.
    ///
    /// # Errors
    /// [`EvaluateError::NoPixels`] for an image without pixels, [`EvaluateError::PixelCount`] where their number is not
    /// width times height.
    pub fn new(width: u32, height: u32, pixels: Vec<[f64; 3]>) -> Result<Self, EvaluateError> {
        if pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(EvaluateError::PixelCount {
                width,
                height,
                pixels: pixels.len(),
            });
        }
        if pixels.is_empty() {
            return Err(EvaluateError::NoPixels { width, height });
        }
        Ok(Self { width, height, pixels })
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.pixels
    }

    /// Error of this image against a reference of the same size.
    ///
    /// # Errors
    /// [`EvaluateError::SizesDiffer`].
    pub fn error(&self, reference: &Self) -> Result<ImageError, EvaluateError> {
        same_size(reference, self)?;
        Ok(ImageError(AbsoluteError::of(
            self.pixels.as_flattened(),
            reference.pixels.as_flattened(),
        )))
    }
}

/// Checks that two images may be compared.
pub(super) fn same_size(reference: &Image, test: &Image) -> Result<(), EvaluateError> {
    if (reference.width, reference.height) == (test.width, test.height) {
        return Ok(());
    }
    Err(EvaluateError::SizesDiffer {
        reference: (reference.width, reference.height),
        test: (test.width, test.height),
    })
}

/// Difference of two images, channel by channel; all pixels count, empty ones too, and nothing is clamped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageError(AbsoluteError);

impl ImageError {
    /// Mean squared error over all pixels and channels; NaN as soon as one channel value is not finite.
    pub fn mse(&self) -> f64 {
        self.0.mse()
    }

    /// Peak signal-to-noise ratio for a peak of 1: −10 log10(MSE) \[dB\]; infinite for equal images, NaN where the MSE
    /// is.
    pub fn psnr(&self) -> f64 {
        -10.0 * libm::log10(self.mse())
    }

    /// Number of channel values of which either side is not finite.
    pub fn nonfinite(&self) -> u64 {
        self.0.nonfinite()
    }
}

/// Size of the image that a list makes, where it makes one.
///
/// # Errors
/// [`EvaluateError::NoSize`] without width and height, [`EvaluateError::NoPixels`] where they are 0,
/// [`EvaluateError::NoColor`] for fragments without colours.
pub fn size_of(list: &FragmentList) -> Result<(u32, u32), EvaluateError> {
    let (width, height) = list.size().ok_or(EvaluateError::NoSize { pixels: list.pixels() })?;
    if list.pixels() == 0 {
        return Err(EvaluateError::NoPixels { width, height });
    }
    if list.color().is_none() && !list.is_empty() {
        return Err(EvaluateError::NoColor { fragments: list.len() });
    }
    Ok((width, height))
}

fn from_pixels(
    list: &FragmentList,
    color: impl Fn(usize, Pixel<'_>) -> [f64; 3] + Sync,
) -> Result<Image, EvaluateError> {
    let (width, height) = size_of(list)?;
    let pixels = (0..list.pixels())
        .into_par_iter()
        .with_min_len(256)
        .map(|p| color(p, list.pixel(p)))
        .collect();
    Image::new(width, height, pixels)
}

/// The exact image of a list: every pixel composited with the over operator in f64, on all cores.
///
/// # Source
/// [`abuffer::composite`].
///
/// # Errors
/// As [`size_of`].
pub fn ground_truth(list: &FragmentList, background: [f64; 3]) -> Result<Image, EvaluateError> {
    from_pixels(list, |_, pixel| abuffer::composite(pixel, background))
}

/// The image that a method makes of a list from the weights that it gave, on all cores.
///
/// # Shapes
/// `weights: [F]`, as [`crate::oit::weights`] gives them.
///
/// # Errors
/// As [`size_of`].
///
/// # Panics
/// If there is not one weight a fragment.
pub fn of_method(
    list: &FragmentList,
    accumulated: &dyn Accumulated,
    weights: &[f64],
    background: [f64; 3],
) -> Result<Image, EvaluateError> {
    assert_eq!(weights.len(), list.len(), "one weight a fragment");
    from_pixels(list, |p, pixel| {
        accumulated.composite(pixel, p, &weights[list.range(p)], background)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::judge::tests::{Shifted, colored_list};
    use crate::oit::{self, Context, Method};

    fn image(width: u32, height: u32, value: f64) -> Image {
        Image::new(width, height, vec![[value; 3]; (width * height) as usize]).unwrap()
    }

    /// One channel of one of four pixels is off by 0.5: 0.25/12; control: the mean over that pixel alone is another
    /// number.
    #[test]
    fn mse_counts_every_pixel_and_clamps_nothing() {
        let reference = image(2, 2, 1.0);
        let mut test = reference.clone();
        test.pixels[3][1] = 1.5;
        let error = test.error(&reference).unwrap();
        assert!((error.mse() - 0.25 / 12.0).abs() < 1e-16);
        assert!((error.psnr() - 10.0 * 48f64.log10()).abs() < 1e-12);
        assert!((error.mse() - 0.25 / 3.0).abs() > 1e-2);
        assert_eq!(reference.error(&reference).unwrap().psnr(), f64::INFINITY);
    }

    #[test]
    fn non_finite_channels_are_counted_and_spoil_the_mean() {
        let reference = image(2, 1, 0.5);
        let mut test = reference.clone();
        test.pixels[0] = [f64::NAN, f64::INFINITY, 0.5];
        let error = test.error(&reference).unwrap();
        assert_eq!(error.nonfinite(), 2);
        assert!(error.mse().is_nan() && error.psnr().is_nan());
    }

    /// A method that answers exactly makes the ground truth (within 1e-14 where no depths tie); control: one that is
    /// off by 0.1 does not.
    #[test]
    fn exact_weights_make_the_ground_truth() {
        let list = colored_list(24, 16);
        let truth = ground_truth(&list, [1.0; 3]).unwrap();
        let mse = |offset| {
            let method = Shifted(offset);
            let accumulated = method.accumulate(&list, Context::default()).unwrap();
            let weights = oit::weights(&list, &*accumulated);
            of_method(&list, &*accumulated, &weights, [1.0; 3])
                .unwrap()
                .error(&truth)
                .unwrap()
                .mse()
        };
        assert!(mse(0.0) < 1e-28, "{}", mse(0.0));
        assert!(mse(0.1) > 1e-6, "{}", mse(0.1));
    }

    #[test]
    fn a_list_of_empty_pixels_shows_the_background() {
        let list = FragmentList::new(vec![0; 7], vec![], vec![], None)
            .unwrap()
            .with_size(3, 2)
            .unwrap();
        assert_eq!(
            ground_truth(&list, [0.1, 0.2, 0.3]).unwrap().pixels(),
            [[0.1, 0.2, 0.3]; 6]
        );
    }

    #[test]
    fn errors_say_what_is_missing() {
        let list =
            |offsets: &[u64], n: usize| FragmentList::new(offsets.to_vec(), vec![1.0; n], vec![0.5; n], None).unwrap();
        let messages = [
            ground_truth(&list(&[0, 1], 1), [1.0; 3]).unwrap_err(),
            ground_truth(&list(&[0, 1], 1).with_size(1, 1).unwrap(), [1.0; 3]).unwrap_err(),
            ground_truth(&list(&[0], 0).with_size(0, 4).unwrap(), [1.0; 3]).unwrap_err(),
            Image::new(2, 2, vec![[0.0; 3]; 3]).unwrap_err(),
            Image::new(0, 0, vec![]).unwrap_err(),
            image(2, 3, 0.0).error(&image(3, 2, 0.0)).unwrap_err(),
        ];
        insta::assert_snapshot!(messages.map(|e| e.to_string()).join("\n"));
    }
}
