//! Fragments and lists of them.

use super::left_out::{LeftOut, note};
use super::{CameraPlanes, DepthError};
use rayon::prelude::*;

/// One transparent surface seen through one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// Distance along the view direction, > 0 [scene units].
    pub view_z: f32,
    /// Opacity, in [0, 1].
    pub alpha: f32,
    /// Linear colour, each channel in [0, ∞) and finite; not premultiplied.
    pub color: [f32; 3],
}

/// The fragments of one pixel, in any order.
#[derive(Debug, Clone, Copy)]
pub struct Pixel<'a> {
    /// Distances along the view direction, > 0 [scene units].
    pub view_z: &'a [f32],
    /// Opacities, in [0, 1].
    pub alpha: &'a [f32],
    /// Linear colours where the list has any.
    pub color: Option<&'a [[f32; 3]]>,
}

impl Pixel<'_> {
    /// Number of fragments.
    pub fn len(&self) -> usize {
        self.view_z.len()
    }

    /// Whether the pixel holds no fragment.
    pub fn is_empty(&self) -> bool {
        self.view_z.is_empty()
    }
}

/// The fragments of many pixels, as compressed sparse rows: pixel p holds fragments `offsets[p]..offsets[p + 1]`.
///
/// A list that exists is valid: every constructor checks what [`FragmentList::new`] documents. Lists are equal where
/// their pixels are, whatever was left out of either.
#[derive(Debug, Clone)]
pub struct FragmentList {
    offsets: Vec<u64>,
    view_z: Vec<f32>,
    alpha: Vec<f32>,
    color: Option<Vec<[f32; 3]>>,
    size: Option<(u32, u32)>,
    windows: Option<Windows>,
    planes: Option<CameraPlanes>,
    left_out: Vec<LeftOut>,
}

impl PartialEq for FragmentList {
    fn eq(&self, other: &Self) -> bool {
        self.offsets == other.offsets
            && self.view_z == other.view_z
            && self.alpha == other.alpha
            && self.color == other.color
            && self.size == other.size
            && self.windows == other.windows
            && self.planes == other.planes
    }
}

/// Where an image lies in the plane of its camera, as OpenEXR says it: x_min, y_min, x_max, y_max, both ends included
/// \[pixels\].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Windows {
    /// The pixels that the list holds.
    pub data: [i32; 4],
    /// The pixels that the camera shows.
    pub display: [i32; 4],
}

impl Windows {
    /// Columns and rows of a window; none where it is empty or too large to count.
    pub fn size_of([x0, y0, x1, y1]: [i32; 4]) -> Option<(u32, u32)> {
        let side = |lo: i32, hi: i32| u32::try_from(i64::from(hi) - i64::from(lo) + 1).ok().filter(|n| *n > 0);
        Some((side(x0, x1)?, side(y0, y1)?))
    }
}

/// What is wrong with a fragment list, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FragmentError {
    /// There is no entry 0.
    #[error("offsets is empty; it must hold one entry more than there are pixels, so at least the entry 0")]
    NoOffsets,
    /// The first offset is not 0.
    #[error("offsets[0] = {0}; it must be 0")]
    FirstOffset(u64),
    /// Offsets fall.
    #[error("offsets[{index}] = {value} is less than offsets[{}] = {previous}; offsets must never fall", index - 1)]
    OffsetsFall {
        /// Place in `offsets`.
        index: usize,
        /// Its value.
        value: u64,
        /// The value before it.
        previous: u64,
    },
    /// The last offset is not the number of fragments.
    #[error("the last offset is {last}, but there are {fragments} fragments; they must be equal")]
    LastOffset {
        /// The last offset.
        last: u64,
        /// Number of fragments.
        fragments: usize,
    },
    /// An array has another length than `view_z`.
    #[error("{name} holds {len} entries, but view_z holds {fragments}; one entry a fragment is needed")]
    Length {
        /// The array.
        name: &'static str,
        /// Its length.
        len: usize,
        /// Number of fragments.
        fragments: usize,
    },
    /// A view depth is not a positive finite number.
    #[error("view_z[{index}] = {value} (pixel {pixel}); it must be finite and greater than 0")]
    ViewZ {
        /// Fragment.
        index: usize,
        /// Pixel.
        pixel: usize,
        /// Its value.
        value: f32,
    },
    /// An opacity is outside [0, 1].
    #[error("alpha[{index}] = {value} (pixel {pixel}); it must lie in [0, 1]")]
    Alpha {
        /// Fragment.
        index: usize,
        /// Pixel.
        pixel: usize,
        /// Its value.
        value: f32,
    },
    /// A colour is negative or not finite.
    #[error("color[{index}] = {value:?} (pixel {pixel}); every channel must be 0 or more, and finite")]
    Color {
        /// Fragment.
        index: usize,
        /// Pixel.
        pixel: usize,
        /// Its value.
        value: [f32; 3],
    },
    /// Width times height is not the number of pixels.
    #[error("width {width} x height {height} is not the number of pixels, {pixels} (the length of offsets less one)")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Number of pixels.
        pixels: usize,
    },
    /// The data window is not of the image's size, or the display window is empty.
    #[error(
        "data window {data:?}, display window {display:?}; the first must have as many columns and rows as the image, \
            the second at least one"
    )]
    Windows {
        /// x_min, y_min, x_max, y_max.
        data: [i32; 4],
        /// x_min, y_min, x_max, y_max.
        display: [i32; 4],
    },
    /// The camera planes are invalid.
    #[error(transparent)]
    Planes(#[from] DepthError),
}

impl FragmentList {
    /// A list from its arrays.
    ///
    /// # Shapes
    /// `offsets: [P + 1]`, `view_z: [F]`, `alpha: [F]`, `color: [F]`.
    ///
    /// # Domain
    /// Offsets start at 0, never fall and end at F; view_z finite and > 0; alpha in [0, 1]; colour channels in [0, ∞).
    /// Empty pixels, a list without fragments, ties and alpha 0 or 1 are valid.
    ///
    /// # Errors
    /// [`FragmentError`] names the first entry that is out of its domain.
    pub fn new(
        offsets: Vec<u64>,
        view_z: Vec<f32>,
        alpha: Vec<f32>,
        color: Option<Vec<[f32; 3]>>,
    ) -> Result<Self, FragmentError> {
        let fragments = view_z.len();
        match offsets.first() {
            None => return Err(FragmentError::NoOffsets),
            Some(0) => {}
            Some(&first) => return Err(FragmentError::FirstOffset(first)),
        }
        if let Some(i) = offsets.windows(2).position(|w| w[1] < w[0]) {
            return Err(FragmentError::OffsetsFall {
                index: i + 1,
                value: offsets[i + 1],
                previous: offsets[i],
            });
        }
        let last = offsets[offsets.len() - 1];
        if last != fragments as u64 {
            return Err(FragmentError::LastOffset { last, fragments });
        }
        let lengths = [
            ("alpha", alpha.len()),
            ("color", color.as_ref().map_or(fragments, Vec::len)),
        ];
        for (name, len) in lengths {
            if len != fragments {
                return Err(FragmentError::Length { name, len, fragments });
            }
        }
        let pixel = |index: usize| offsets.partition_point(|&o| o <= index as u64) - 1;
        if let Some(index) = first_outside(&view_z, |v| (v > 0.0) & (v < f32::INFINITY)) {
            return Err(FragmentError::ViewZ {
                index,
                pixel: pixel(index),
                value: view_z[index],
            });
        }
        if let Some(index) = first_outside(&alpha, |a| (0.0..=1.0).contains(&a)) {
            return Err(FragmentError::Alpha {
                index,
                pixel: pixel(index),
                value: alpha[index],
            });
        }
        if let Some(color) = &color
            && let Some(index) = color
                .iter()
                .position(|c| c.iter().any(|x| !(0.0..f32::INFINITY).contains(x)))
        {
            return Err(FragmentError::Color {
                index,
                pixel: pixel(index),
                value: color[index],
            });
        }
        Ok(Self {
            offsets,
            view_z,
            alpha,
            color,
            size: None,
            windows: None,
            planes: None,
            left_out: Vec::new(),
        })
    }

    /// The same list as an image, row by row from the top.
    ///
    /// # Errors
    /// [`FragmentError::Size`] unless width × height is the number of pixels.
    pub fn with_size(mut self, width: u32, height: u32) -> Result<Self, FragmentError> {
        let pixels = self.pixels();
        if u64::from(width) * u64::from(height) != pixels as u64 {
            return Err(FragmentError::Size { width, height, pixels });
        }
        self.size = Some((width, height));
        Ok(self)
    }

    /// The same list with its place in the plane of the camera.
    ///
    /// # Errors
    /// [`FragmentError::Windows`] unless the data window has the image's size and the display window a pixel.
    pub fn with_windows(mut self, windows: Windows) -> Result<Self, FragmentError> {
        let Windows { data, display } = windows;
        if self.size.is_none() || Windows::size_of(data) != self.size || Windows::size_of(display).is_none() {
            return Err(FragmentError::Windows { data, display });
        }
        self.windows = Some(windows);
        Ok(self)
    }

    /// The same list with more that its source holds and it does not.
    pub fn with_left_out(mut self, left_out: impl IntoIterator<Item = LeftOut>) -> Self {
        left_out.into_iter().for_each(|l| note(&mut self.left_out, l));
        self
    }

    /// The same list with the planes of the camera that saw it.
    pub fn with_planes(mut self, planes: CameraPlanes) -> Self {
        self.planes = Some(planes);
        self
    }

    /// The same pixels with their fragments in another order: fragment i becomes what fragment `order[i]` was.
    ///
    /// # Panics
    /// If `order` has another length than the list, or takes a fragment from another pixel.
    pub fn reordered(&self, order: &[usize]) -> Self {
        assert_eq!(order.len(), self.len(), "one place a fragment");
        let stays = |p: usize| order[self.range(p)].iter().all(|i| self.range(p).contains(i));
        assert!((0..self.pixels()).all(stays), "fragments stay in their pixels");
        Self {
            view_z: order.iter().map(|&i| self.view_z[i]).collect(),
            alpha: order.iter().map(|&i| self.alpha[i]).collect(),
            color: self
                .color
                .as_ref()
                .map(|color| order.iter().map(|&i| color[i]).collect()),
            ..self.clone()
        }
    }

    /// The pixels of this list, then those of another, with this list's planes; not an image any more.
    ///
    /// Colours stay where both lists have them.
    pub fn followed_by(&self, other: &Self) -> Self {
        let join = |a: &[f32], b: &[f32]| [a, b].concat();
        let start = self.len() as u64;
        Self {
            offsets: self
                .offsets
                .iter()
                .copied()
                .chain(other.offsets[1..].iter().map(|o| start + o))
                .collect(),
            view_z: join(&self.view_z, &other.view_z),
            alpha: join(&self.alpha, &other.alpha),
            color: self
                .color
                .as_ref()
                .zip(other.color.as_ref())
                .map(|(a, b)| [a.as_slice(), b].concat()),
            size: None,
            windows: None,
            planes: self.planes,
            left_out: self.left_out.clone(),
        }
        .with_left_out(other.left_out.iter().cloned())
    }

    /// Number of pixels, P.
    pub fn pixels(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of fragments, F.
    pub fn len(&self) -> usize {
        self.view_z.len()
    }

    /// Whether there is no fragment at all.
    pub fn is_empty(&self) -> bool {
        self.view_z.is_empty()
    }

    /// Where pixel p's fragments stand in [`Self::view_z`] and [`Self::alpha`].
    ///
    /// # Panics
    /// If p is not less than [`Self::pixels`].
    pub fn range(&self, p: usize) -> std::ops::Range<usize> {
        self.offsets[p] as usize..self.offsets[p + 1] as usize
    }

    /// The fragments of pixel p.
    ///
    /// # Panics
    /// If p is not less than [`Self::pixels`].
    pub fn pixel(&self, p: usize) -> Pixel<'_> {
        let range = self.range(p);
        Pixel {
            view_z: &self.view_z[range.clone()],
            alpha: &self.alpha[range.clone()],
            color: self.color.as_ref().map(|c| &c[range]),
        }
    }

    /// Runs `f(p, pixel, out)` for every non-empty pixel of a range on all cores, `out` being the pixel's own part of
    /// an array that holds `width` values for every fragment of the range, in the order of the list.
    ///
    /// # Errors
    /// The first error of `f`, whichever thread meets it.
    ///
    /// # Panics
    /// If `out` does not hold `width` values for every fragment of the range.
    pub fn par_pixels<T: Send, E: Send>(
        &self,
        range: std::ops::Range<usize>,
        out: &mut [T],
        width: usize,
        f: impl Fn(usize, Pixel<'_>, &mut [T]) -> Result<(), E> + Send + Sync,
    ) -> Result<(), E> {
        self.par_pixels_of_two(range, (out, width), (&mut [], 0), |p, pixel, out, _: &mut [()]| {
            f(p, pixel, out)
        })
    }

    /// [`Self::par_pixels`] with two kinds of values, so many of each a fragment.
    ///
    /// # Errors
    /// The first error of `f`.
    ///
    /// # Panics
    /// If there are not as many values.
    pub fn par_pixels_of_two<T: Send, U: Send, E: Send>(
        &self,
        range: std::ops::Range<usize>,
        (mut first, first_width): (&mut [T], usize),
        (mut second, second_width): (&mut [U], usize),
        f: impl Fn(usize, Pixel<'_>, &mut [T], &mut [U]) -> Result<(), E> + Send + Sync,
    ) -> Result<(), E> {
        let fragments = (self.offsets[range.end] - self.offsets[range.start]) as usize;
        assert_eq!(first.len(), fragments * first_width, "{first_width} values a fragment");
        assert_eq!(
            second.len(),
            fragments * second_width,
            "{second_width} values a fragment"
        );
        let mut jobs = Vec::new();
        for p in range.filter(|&p| !self.range(p).is_empty()) {
            let n = self.range(p).len();
            let of_first = first.split_off_mut(..n * first_width).expect("as many as asserted");
            let of_second = second.split_off_mut(..n * second_width).expect("as many as asserted");
            jobs.push((p, of_first, of_second));
        }
        jobs.into_par_iter()
            .with_min_len(64)
            .try_for_each(|(p, first, second)| f(p, self.pixel(p), first, second))
    }

    /// Pixel p holds fragments `offsets[p]..offsets[p + 1]`.
    pub fn offsets(&self) -> &[u64] {
        &self.offsets
    }

    /// Distances along the view direction, > 0 [scene units].
    pub fn view_z(&self) -> &[f32] {
        &self.view_z
    }

    /// Opacities, in [0, 1].
    pub fn alpha(&self) -> &[f32] {
        &self.alpha
    }

    /// Linear colours.
    pub fn color(&self) -> Option<&[[f32; 3]]> {
        self.color.as_deref()
    }

    /// Columns and rows where the list is an image.
    pub fn size(&self) -> Option<(u32, u32)> {
        self.size
    }

    /// Where the image lies in the plane of its camera, where that is known and the list is an image.
    pub fn windows(&self) -> Option<Windows> {
        self.windows
    }

    /// What the source of this list holds and the list does not.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// The greatest value of any colour channel, at least 1; what bounds of images scale with.
    pub fn brightest(&self) -> f32 {
        let channels = self.color.iter().flatten().flatten();
        channels.fold(1.0, |brightest, &c| brightest.max(c))
    }

    /// The camera's planes where they are known.
    pub fn planes(&self) -> Option<CameraPlanes> {
        self.planes
    }

    /// Greatest number of fragments in a pixel (the depth complexity).
    pub fn depth_complexity(&self) -> usize {
        self.offsets
            .windows(2)
            .map(|w| (w[1] - w[0]) as usize)
            .max()
            .unwrap_or(0)
    }

    /// Least and greatest view depth of the whole list; none where it has no fragment.
    ///
    /// Fragments of alpha 0 have no part in it, unless there are no others: where a ray missed, many programs write a
    /// depth of no meaning.
    pub fn depth_range(&self) -> Option<(f32, f32)> {
        // Branch-free, so that the loop runs on SIMD lanes; depths are finite and positive.
        let range = |keep: fn(f32) -> bool| {
            let ends = self
                .view_z
                .iter()
                .zip(&self.alpha)
                .fold((f32::INFINITY, 0.0f32), |(lo, hi), (&v, &a)| {
                    let (low, high) = if keep(a) { (v, v) } else { (f32::INFINITY, 0.0) };
                    (lo.min(low), hi.max(high))
                });
            (ends.0 <= ends.1).then_some(ends)
        };
        range(|a| a > 0.0).or_else(|| range(|_| true))
    }
}

/// The first value that is not in a domain. A chunk is looked at as a whole, without an early exit, so that the loop
/// runs on SIMD lanes.
fn first_outside(values: &[f32], domain: impl Fn(f32) -> bool) -> Option<usize> {
    const CHUNK: usize = 1024;
    let chunk = values
        .chunks(CHUNK)
        .position(|chunk| !chunk.iter().fold(true, |all, &x| all & domain(x)))?;
    (chunk * CHUNK..values.len()).find(|&i| !domain(values[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(offsets: &[u64], view_z: &[f32], alpha: &[f32]) -> Result<FragmentList, FragmentError> {
        FragmentList::new(offsets.to_vec(), view_z.to_vec(), alpha.to_vec(), None)
    }

    #[test]
    fn valid_lists_that_look_odd() {
        assert_eq!(list(&[0], &[], &[]).unwrap().pixels(), 0);
        assert_eq!(list(&[0, 0, 0], &[], &[]).unwrap().depth_complexity(), 0);
        let ties = list(&[0, 0, 2, 3], &[1.0, 1.0, 2.0], &[0.0, 1.0, 0.5]).unwrap();
        assert_eq!((ties.pixels(), ties.len(), ties.depth_complexity()), (3, 3, 2));
        assert_eq!(ties.range(1), 0..2);
        assert_eq!(ties.depth_range(), Some((1.0, 2.0)));
        let misses = list(&[0, 3], &[1e30, 2.0, 3.0], &[0.0, 1.0, 0.5]).unwrap();
        assert_eq!(misses.depth_range(), Some((2.0, 3.0)));
        assert_eq!(
            list(&[0, 1], &[1e30], &[0.0]).unwrap().depth_range(),
            Some((1e30, 1e30))
        );
        let twice = ties.followed_by(&ties);
        assert_eq!(
            (twice.pixels(), twice.len(), twice.range(4), twice.range(5)),
            (6, 6, 3..5, 5..6)
        );
    }

    /// In whatever chunk it lies, and before any later one.
    #[test]
    fn the_first_value_outside_is_found() {
        for at in [0, 1, 1023, 1024, 1500, 2999] {
            let mut values = vec![0.5f32; 3000];
            values[2999] = -1.0;
            values[at] = f32::NAN;
            assert_eq!(first_outside(&values, |x| x > 0.0), Some(at));
        }
        assert_eq!(first_outside(&[0.5; 3000], |x| x > 0.0), None);
    }

    #[test]
    fn every_error_names_its_place() {
        let cases = [
            (list(&[], &[], &[]), "offsets is empty"),
            (list(&[1, 1], &[1.0], &[0.5]), "offsets[0] = 1"),
            (
                list(&[0, 2, 1, 2], &[1.0, 1.0], &[0.5, 0.5]),
                "offsets[2] = 1 is less than offsets[1] = 2",
            ),
            (list(&[0, 3], &[1.0], &[0.5]), "the last offset is 3, but there are 1"),
            (list(&[0, 1], &[1.0], &[]), "alpha holds 0 entries"),
            (list(&[0, 0, 1], &[f32::NAN], &[0.5]), "view_z[0] = NaN (pixel 1)"),
            (list(&[0, 1], &[0.0], &[0.5]), "view_z[0] = 0 (pixel 0)"),
            (list(&[0, 1], &[-1.0], &[0.5]), "view_z[0] = -1"),
            (list(&[0, 1], &[1.0], &[1.5]), "alpha[0] = 1.5"),
            (list(&[0, 1], &[1.0], &[f32::NAN]), "alpha[0] = NaN"),
        ];
        for (result, part) in cases {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        let color = FragmentList::new(vec![0, 1], vec![1.0], vec![0.5], Some(vec![[0.0, -2.0, 0.0]]));
        assert!(color.unwrap_err().to_string().contains("color[0]"));
        let bright = FragmentList::new(vec![0, 1], vec![1.0], vec![0.5], Some(vec![[0.0, 2.0, 0.0]])).unwrap();
        assert_eq!(bright.brightest(), 2.0);
        assert!(list(&[0, 0, 0], &[], &[]).unwrap().with_size(3, 1).is_err());
    }
}
