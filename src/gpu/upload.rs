//! Fragment lists on the device.

use super::device::{Gpu, GpuError};
use crate::pixel::FragmentList;
use crate::shader::MethodShader;

/// A fragment list on the device: uploaded once, drawn and computed with by every method.
///
/// Its fragments lie in chunks, several where a buffer does not hold all. Render passes draw one after the other;
/// compute passes go through a pixel's fragments wherever they lie, and take lists of one chunk.
#[derive(Debug)]
pub struct DeviceList {
    /// Pixels.
    pub pixels: usize,
    /// Fragments.
    pub fragments: usize,
    /// Columns and rows, where the list is an image.
    pub size: Option<(u32, u32)>,
    /// Greatest view depth; 1 where there is no fragment.
    pub(super) greatest: f32,
    /// Whether fragments have colours, or there are none.
    has_color: bool,
    /// Offsets of pixels.
    pub(super) offsets: wgpu::Buffer,
    pub(super) chunks: Vec<Chunk>,
}

/// Fragments that lie in one set of buffers.
#[derive(Debug)]
pub(super) struct Chunk {
    /// How many.
    pub fragments: u32,
    /// Pixel of every fragment.
    pub pixel_of: wgpu::Buffer,
    pub view_z: wgpu::Buffer,
    pub alpha: wgpu::Buffer,
    /// Three numbers a fragment; none where the list has no colours.
    pub color: wgpu::Buffer,
}

impl DeviceList {
    /// Uploads a list.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub fn new(gpu: &Gpu, list: &FragmentList) -> Result<Self, GpuError> {
        // Bytes of what takes most of a fragment: its colour, or a number.
        let bytes = if list.color().is_some() { 12 } else { 4 };
        let limits = gpu.device.limits();
        let most = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size) / bytes;
        Self::in_chunks(gpu, list, most.min(1 << 26) as usize)
    }

    /// Uploads a list in chunks of at most so many fragments.
    pub(super) fn in_chunks(gpu: &Gpu, list: &FragmentList, most: usize) -> Result<Self, GpuError> {
        let offsets: Vec<u32> = list.offsets().iter().map(|&o| o as u32).collect();
        let mut pixel_of = Vec::with_capacity(list.len());
        for p in 0..list.pixels() {
            pixel_of.extend(list.range(p).map(|_| p as u32));
        }
        let color = list.color();
        let chunk = |first: usize| {
            let range = first..(first + most).min(list.len());
            let color = color.map_or(&[][..], |color| &color[range.clone()]);
            Ok(Chunk {
                fragments: range.len() as u32,
                pixel_of: gpu.upload("pixels of fragments", &pixel_of[range.clone()])?,
                view_z: gpu.upload("view_z", &list.view_z()[range.clone()])?,
                alpha: gpu.upload("alpha", &list.alpha()[range])?,
                color: gpu.upload("color", color.as_flattened())?,
            })
        };
        // Of a list without fragments, one empty chunk.
        let chunks = (0..list.len().max(1))
            .step_by(most.max(1))
            .map(chunk)
            .collect::<Result<_, GpuError>>()?;
        Ok(Self {
            pixels: list.pixels(),
            fragments: list.len(),
            size: list.size(),
            greatest: list.depth_range().map_or(1.0, |(_, greatest)| greatest),
            has_color: color.is_some() || list.is_empty(),
            offsets: gpu.upload("offsets", &offsets)?,
            chunks,
        })
    }

    /// Columns and rows of the image that it makes.
    ///
    /// # Errors
    /// [`GpuError::NoImage`] where it has no size, no pixel, or fragments without colours.
    pub(super) fn image_size(&self) -> Result<(u32, u32), GpuError> {
        let none = |why: &str| Err(GpuError::NoImage(why.to_owned()));
        match self.size {
            None => none("the fragment list has neither width nor height; add both to the file"),
            Some((width, height)) if self.pixels == 0 => none(&format!("{width} x {height} has no pixel")),
            Some(_) if !self.has_color => {
                none("the fragments have no color; add a float32 array 'color' of shape [F, 3] to the file")
            }
            Some(size) => Ok(size),
        }
    }

    /// The one chunk that compute passes go through.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] where there are several.
    pub(super) fn whole(&self, gpu: &Gpu) -> Result<&Chunk, GpuError> {
        match &self.chunks[..] {
            [chunk] => Ok(chunk),
            _ => Err(gpu.too_large("the fragments of a list", 12 * self.fragments as u64)),
        }
    }
}

/// The uniform buffer that every pass of a frame reads; see `shader/passes/frame.wgsl`.
///
/// `range` is what depths are measured by, `scale` a power of two that takes every view depth below 1.
pub(super) fn frame(
    gpu: &Gpu,
    method: &MethodShader,
    range: [f32; 2],
    size: (u32, u32),
    background: [f32; 3],
    scale: f32,
) -> wgpu::Buffer {
    let [r, g, b] = background.map(f32::to_bits);
    let codes = method.core.map_or([[0; 4]; 2], |set| {
        let codes = set.layout.codes(range[0], range[1]);
        let signed = [codes.first_bits, codes.last_bits, codes.first_log2].map(|i| i as u32);
        [
            [signed[0], signed[1], signed[2], 0],
            [codes.shift, codes.multiplier, codes.slope, 0],
        ]
    });
    let words = [
        [range[0].to_bits(), range[1].to_bits(), size.0, size.1],
        [r, g, b, 0],
        [scale.to_bits(), scale.recip().to_bits(), 0, 0],
        codes[0],
        codes[1],
    ];
    gpu.uniform("frame", words.as_flattened())
}

/// The buffer of the cores of so many pixels; none where a method keeps none.
///
/// # Errors
/// [`GpuError::TooLarge`].
pub(super) fn core(gpu: &Gpu, method: &MethodShader, pixels: usize) -> Result<Option<wgpu::Buffer>, GpuError> {
    let bytes = |stride: usize| 4 * stride as u64 * pixels as u64;
    let buffer = |stride| gpu.zeros("cores of pixels", bytes(stride));
    method.core.map(|set| buffer(set.stride())).transpose()
}
