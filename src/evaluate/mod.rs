//! Errors of methods against the exact answer, as numbers and as pictures.

pub mod bins;
pub mod flip;
pub mod gpu;
pub mod image;
pub mod judge;
pub mod order;
pub mod over_time;
pub mod picture;
pub mod shadow;
pub mod tinted;

pub use bins::{AlphaBin, CountBin};
pub use flip::{FlipMap, flip};
pub use image::Image;
pub use judge::{Judged, MethodResult, Truth, evaluate, sort_by_error};
pub use order::{OrderResult, OrderedList, Shuffled};
pub use over_time::OverTime;
pub use tinted::{Tinted, TintedResult};

use crate::numeric::file::FileError;
use crate::numeric::tolerance::AbsoluteError;
use crate::oit::MethodError;

/// Why something could not be evaluated, or its picture not be made.
#[derive(Debug, thiserror::Error)]
pub enum EvaluateError {
    /// The list does not say which pixel lies where.
    #[error(
        "there is no image: the fragment list has {pixels} pixels and neither width nor height; add both to the file"
    )]
    NoSize {
        /// Number of pixels.
        pixels: usize,
    },
    /// The list has fragments and no colours.
    #[error(
        "there is no image: the {fragments} fragments of the list have no color; add a float32 array 'color' of shape \
            [F, 3] to the file"
    )]
    NoColor {
        /// Number of fragments.
        fragments: usize,
    },
    /// The image has no pixel.
    #[error("an image of {width} x {height} has no pixel; at least one is needed")]
    NoPixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The pixels do not make the image.
    #[error("{pixels} pixels do not make an image of {width} x {height}")]
    PixelCount {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Number of pixels.
        pixels: usize,
    },
    /// Two images are to be compared and differ in size.
    #[error("the image is {} x {}, its reference {} x {}; only images of one size can be compared", test.0, test.1,
        reference.0, reference.1)]
    SizesDiffer {
        /// Columns and rows of the reference.
        reference: (u32, u32),
        /// Columns and rows of the image.
        test: (u32, u32),
    },
    /// A contact sheet of nothing.
    #[error("a contact sheet needs at least one method")]
    EmptySheet,
    /// A method cannot be applied to the list.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The GPU did not draw it.
    #[error(transparent)]
    Gpu(#[from] crate::gpu::GpuError),
    /// A picture could not be written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Error of transmittances, fragment by fragment: mean square, worst, number of non-finite ones.
///
/// # Shapes
/// Both `[F]`.
///
/// # Panics
/// If the lengths differ.
pub fn transmittance_error(transmittances: &[f32], exact: &[f64]) -> AbsoluteError {
    assert_eq!(transmittances.len(), exact.len(), "one exact value a fragment");
    let mut error = AbsoluteError::default();
    for (&t, &e) in transmittances.iter().zip(exact) {
        error.add(t.into(), e);
    }
    error
}
