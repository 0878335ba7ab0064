//! The samples of a block of pixels, and the fragments that they become.

use super::bytes::{Bytes, Kind};
use super::channels::{Alpha, Used, used};
use super::chunks::Chunk;
use super::header::FileHeader;
use super::unpack::{Content, Packing};
use super::{MAX_SIDE, ReadOptions};
use crate::pixel::Windows;
use crate::pixel::left_out::{LeftOut, note};
use crate::scene::SceneError;
use std::num::NonZeroU32;
use std::path::Path;

/// Alpha of a sample that shines without hiding anything: small enough that nothing shows what it hides, and large
/// enough for f32 colours.
pub const MIN_EMITTING_ALPHA: f32 = 1.0 / 65536.0;

/// What is needed to decode a chunk.
pub(super) struct Layout<'a> {
    pub path: &'a Path,
    pub width: usize,
    pub height: usize,
    pub windows: Windows,
    /// Columns and rows of a whole block.
    pub block: [usize; 2],
    pub packing: Packing,
    pub kinds: Vec<Kind>,
    pub used: Used,
    pub slices: Option<NonZeroU32>,
}

/// Fragments of a block, pixel by pixel.
#[derive(Default)]
pub(super) struct Decoded {
    pub counts: Vec<u32>,
    pub view_z: Vec<f32>,
    pub alpha: Vec<f32>,
    pub color: Vec<[f32; 3]>,
    pub tally: Tally,
}

/// Samples that did not become fragments as they are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Tally {
    empty: u64,
    clamped: u64,
    negative: u64,
    emitting: u64,
    volumes: u64,
}

impl Tally {
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            empty: self.empty + other.empty,
            clamped: self.clamped + other.clamped,
            negative: self.negative + other.negative,
            emitting: self.emitting + other.emitting,
            volumes: self.volumes + other.volumes,
        }
    }

    pub fn name_what_is_left_out(&self, place: &str, slices: Option<NonZeroU32>, left_out: &mut Vec<LeftOut>) {
        let slices = slices.map_or(1, NonZeroU32::get);
        for (what, count, remedy) in [
            (
                "samples of alpha 0 without light",
                self.empty,
                "they hide and show nothing, whatever their depth".to_owned(),
            ),
            (
                "samples' alpha outside [0, 1]",
                self.clamped,
                "it is taken as 0 or 1; correct it where it was written".to_owned(),
            ),
            (
                "samples' negative colours",
                self.negative,
                "they are taken as 0; filters with negative lobes make them".to_owned(),
            ),
            (
                "samples' alpha below 1/65536, all of them light sources",
                self.emitting,
                "it is taken as 1/65536, so that their light is kept".to_owned(),
            ),
            (
                "depth extents of volumetric samples (ZBack > Z)",
                self.volumes,
                format!("each sample becomes {slices} fragments that hide as much together"),
            ),
        ] {
            note(left_out, LeftOut::new(what, place, count, remedy));
        }
    }
}

impl<'a> Layout<'a> {
    /// The layout that a part's header describes.
    ///
    /// # Errors
    /// [`SceneError::FileContent`] for attributes that are missing or make no image.
    pub fn of_part(
        bytes: &Bytes<'a>,
        file: &FileHeader,
        part: usize,
        options: &ReadOptions,
        left_out: &mut Vec<LeftOut>,
    ) -> Result<Self, SceneError> {
        let header = &file.parts[part];
        let missing = |what: &str| {
            bytes.wrong(
                &format!("header of part {part}"),
                format!("there is no attribute '{what}'"),
            )
        };
        let data = header.data_window.ok_or_else(|| missing("dataWindow"))?;
        let (width, height) = (
            i64::from(data[2]) - i64::from(data[0]) + 1,
            i64::from(data[3]) - i64::from(data[1]) + 1,
        );
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            let reason = format!("{width} x {height} pixels; 1 to {MAX_SIDE} a side are supported");
            return Err(bytes.wrong("dataWindow", reason));
        }
        let (width, height) = (width as usize, height as usize);
        let display = header
            .display_window
            .filter(|w| Windows::size_of(*w).is_some())
            .unwrap_or(data);
        let method = header.compression.ok_or_else(|| missing("compression"))?;
        let (packing, lines) = Packing::of_method(method).map_err(|reason| bytes.wrong("compression", reason))?;
        let channels = header.channels.as_ref().ok_or_else(|| missing("channels"))?;
        let place = format!("{}, {}", bytes.path.display(), file.name_of(part));
        let used = used(bytes, channels, &place, left_out)?;
        let block = if file.is_tiled(part) {
            let [w, h] = header.tiles.ok_or_else(|| missing("tiles"))?;
            if w == 0 || h == 0 || header.levels > 2 {
                let reason = format!("tiles of {w} x {h} pixels, level mode {}", header.levels);
                return Err(bytes.wrong("tiles", reason));
            }
            if header.levels > 0 {
                note(
                    left_out,
                    LeftOut::new(
                        "the smaller levels of tiles",
                        &place,
                        1,
                        "the image of full size is read",
                    ),
                );
            }
            [w as usize, h as usize]
        } else {
            [width, lines]
        };
        Ok(Self {
            path: bytes.path,
            width,
            height,
            windows: Windows { data, display },
            block,
            packing,
            kinds: channels.iter().map(|c| c.1).collect(),
            used,
            slices: options.volume_slices,
        })
    }

    fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    /// A pixel as the file counts it.
    fn pixel(&self, chunk: &Chunk<'_>, column: usize, row: usize) -> String {
        let [x_min, y_min, ..] = self.windows.data.map(i64::from);
        let (x, y) = (x_min + (chunk.x + column) as i64, y_min + (chunk.y + row) as i64);
        format!("{}, pixel ({x}, {y})", chunk.place)
    }

    /// Samples of every pixel of a block.
    fn counts(&self, chunk: &Chunk<'_>) -> Result<Vec<u32>, SceneError> {
        let pixels = chunk.width * chunk.height;
        let table = self
            .packing
            .unpack(chunk.table, pixels as u64 * 4, Content::Counts)
            .map_err(|reason| self.wrong(&format!("{}, sample counts", chunk.place), reason))?;
        // Counts are running sums along each row.
        let mut counts = Vec::with_capacity(pixels);
        for (row, line) in table.chunks_exact(4 * chunk.width).enumerate() {
            let mut before = 0;
            for (column, b) in line.chunks_exact(4).enumerate() {
                let sum = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
                if sum < before || sum > i32::MAX as u32 {
                    let reason = format!("the running sum of samples goes from {before} to {sum}; the file is damaged");
                    return Err(self.wrong(&self.pixel(chunk, column, row), reason));
                }
                counts.push(sum - before);
                before = sum;
            }
        }
        Ok(counts)
    }

    /// The fragments of a block.
    pub fn block(&self, chunk: &Chunk<'_>) -> Result<Decoded, SceneError> {
        let counts = self.counts(chunk)?;
        let rows: Vec<u64> = counts
            .chunks_exact(chunk.width)
            .map(|row| row.iter().map(|&c| u64::from(c)).sum())
            .collect();
        let total: u64 = rows.iter().sum();
        let sizes: Vec<usize> = self.kinds.iter().map(|k| k.bytes()).collect();
        let bytes_a_sample: usize = sizes.iter().sum();
        if total.checked_mul(bytes_a_sample as u64) != Some(chunk.unpacked) {
            let reason = format!(
                "{total} samples of {bytes_a_sample} bytes are counted, but {} bytes declared; the file is damaged",
                chunk.unpacked
            );
            return Err(self.wrong(&chunk.place, reason));
        }
        let content = Content::Samples {
            rows: &rows,
            channels: &sizes,
        };
        let data = self
            .packing
            .unpack(chunk.samples, chunk.unpacked, content)
            .map_err(|reason| self.wrong(&format!("{}, samples", chunk.place), reason))?;
        let mut out = Decoded::default();
        out.view_z.reserve(total as usize);
        out.alpha.reserve(total as usize);
        out.color
            .reserve(if self.used.color.is_some() { total as usize } else { 0 });
        let mut line_at = 0;
        for (row, (counts, &samples)) in counts.chunks_exact(chunk.width).zip(&rows).enumerate() {
            // Within a row, each channel stands alone.
            let mut starts = Vec::with_capacity(self.kinds.len());
            for size in &sizes {
                starts.push(line_at);
                line_at += samples as usize * size;
            }
            let value =
                |channel: usize, i: usize| self.kinds[channel].value(&data[starts[channel] + i * sizes[channel]..]);
            let mut i = 0;
            for (column, &count) in counts.iter().enumerate() {
                let before = out.view_z.len();
                for sample in 0..count {
                    self.sample(&value, i, &mut out).map_err(|reason| {
                        self.wrong(&format!("{}, sample {sample}", self.pixel(chunk, column, row)), reason)
                    })?;
                    i += 1;
                }
                out.counts.push((out.view_z.len() - before) as u32);
            }
        }
        Ok(out)
    }

    /// Opacity as it stands in the file.
    fn stored_alpha(&self, value: &impl Fn(usize, usize) -> f32, i: usize) -> Result<f32, String> {
        let alpha = match self.used.alpha {
            Alpha::One(place) => value(place, i),
            Alpha::PerColor(places) => (places.iter().map(|&p| f64::from(value(p, i))).sum::<f64>() / 3.0) as f32,
        };
        if alpha.is_nan() {
            Err("A is not a number".to_owned())
        } else {
            Ok(alpha)
        }
    }

    /// Appends the fragments of one sample: none, one, or the slices of a volume.
    pub fn sample(&self, value: &impl Fn(usize, usize) -> f32, i: usize, out: &mut Decoded) -> Result<(), String> {
        let stored = self.stored_alpha(value, i)?;
        let mut alpha = stored.clamp(0.0, 1.0);
        out.tally.clamped += u64::from(stored != alpha);
        let mut premultiplied = [0.0f32; 3];
        for (c, place) in premultiplied.iter_mut().zip(self.used.color.into_iter().flatten()) {
            *c = value(place, i);
            if !c.is_finite() {
                return Err(format!("its colour holds {c}; colours must be finite"));
            }
        }
        if premultiplied.iter().any(|c| *c < 0.0) {
            out.tally.negative += 1;
            premultiplied = premultiplied.map(|c| c.max(0.0));
        }
        let light = premultiplied.iter().fold(0.0, |most: f32, c| most.max(*c));
        if alpha == 0.0 && light == 0.0 {
            out.tally.empty += 1;
            return Ok(());
        }
        if light > alpha && alpha < MIN_EMITTING_ALPHA {
            out.tally.emitting += 1;
            alpha = MIN_EMITTING_ALPHA;
        }
        let z = value(self.used.z, i);
        if !(z > 0.0 && z.is_finite()) {
            return Err(format!("Z = {z}; it must be finite and greater than 0"));
        }
        let color = premultiplied.map(|c| c / alpha);
        let back = self.used.z_back.map_or(z, |place| value(place, i));
        if !back.is_finite() {
            return Err(format!("ZBack = {back}; it must be finite"));
        }
        let slices = match self.slices {
            _ if back <= z => 1,
            Some(slices) => slices.get(),
            None => {
                return Err(format!(
                    "it is a volume, from Z = {z} to ZBack = {back}; allow slices to read it"
                ));
            }
        };
        out.tally.volumes += u64::from(slices > 1);
        // (1 − a_slice)^slices = 1 − a
        let thin = if slices == 1 {
            alpha
        } else {
            -libm::expm1(libm::log1p(-f64::from(alpha)) / f64::from(slices)) as f32
        };
        for s in 0..slices {
            let share = (f64::from(s) + 0.5) / f64::from(slices);
            let depth = if slices == 1 {
                z
            } else {
                (f64::from(z) + share * (f64::from(back) - f64::from(z))) as f32
            };
            out.view_z.push(depth);
            out.alpha.push(thin);
            if self.used.color.is_some() {
                out.color.push(color);
            }
        }
        Ok(())
    }
}
