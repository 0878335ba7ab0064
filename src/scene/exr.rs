//! Deep OpenEXR images: files in which a pixel holds many samples in depth.
//!
//! Read: the first deep part of single-part and multi-part files, scanlines or tiles (level 0), uncompressed or RLE, ZIPS or ZIP compressed,
//! channels of any of the three number types. Used are `Z`, `A`, the colour `R`, `G`, `B` (all three or none) and `ZBack`; other channels are skipped.
//! The list's image is the data window. Written: one part of deep scanlines, ZIPS compressed, 32-bit floats.
//!
//! Every size in a file is checked against the bytes that are there before memory is taken for it: at most about a thousand times the file's size is
//! ever used, which is what the compression methods can reach at best.

use super::SceneError;
use crate::numeric::file::{FileError, Replace, read as read_file, write_atomically};
use crate::pixel::{CameraPlanes, FragmentList};
use flate2::{Compress, Compression, Decompress, FlushCompress, FlushDecompress, Status};
use rayon::prelude::*;
use std::num::NonZeroU32;
use std::path::Path;

/// How a deep image is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// Slices that a volumetric sample (ZBack > Z) is cut into: fragments at the middles of equal intervals of depth, each of absorbance A/slices, so
    /// that all together hide as much as the sample. None refuses files with such samples.
    pub volume_slices: Option<NonZeroU32>,
}

impl Default for ReadOptions {
    /// Four slices.
    fn default() -> Self {
        Self {
            volume_slices: NonZeroU32::new(4),
        }
    }
}

const MAGIC: u32 = 20_000_630;
/// Bits of the version word.
const TILED: u32 = 0x200;
const DEEP: u32 = 0x800;
const MULTI_PART: u32 = 0x1000;
/// Most bytes that one compressed byte may stand for: deflate's bound is 1032, run lengths reach 64.
const MAX_EXPANSION: u64 = 1032;
/// Most columns or rows of an image.
const MAX_SIDE: i64 = 1 << 20;

/// Number type of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Uint,
    Half,
    Float,
}

impl Kind {
    fn bytes(self) -> usize {
        if self == Self::Half { 2 } else { 4 }
    }

    fn value(self, b: &[u8]) -> f32 {
        match self {
            Self::Uint => u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            Self::Half => half(u16::from_le_bytes([b[0], b[1]])),
            Self::Float => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

/// A 16-bit float, exactly.
fn half(bits: u16) -> f32 {
    let sign = u32::from(bits >> 15) << 31;
    let (exponent, fraction) = (u32::from(bits >> 10 & 31), u32::from(bits & 1023));
    match exponent {
        // Subnormal: fraction 2^−24
        0 => f32::from_bits(sign | (fraction as f32 * (1.0 / 16_777_216.0)).to_bits()),
        31 => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packing {
    None,
    Rle,
    Zip,
}

/// What one part's header says.
#[derive(Debug, Default)]
struct Header {
    kind: Option<String>,
    channels: Option<Vec<(String, Kind)>>,
    compression: Option<u8>,
    /// xMin, yMin, xMax, yMax.
    data_window: Option<[i32; 4]>,
    tiles: Option<[u32; 2]>,
    levels: u8,
    chunk_count: Option<u64>,
    near: Option<f32>,
    far: Option<f32>,
}

/// Bytes with a place, so that an error can say where.
struct Bytes<'a> {
    path: &'a Path,
    data: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    fn take(&mut self, n: u64, what: &str) -> Result<&'a [u8], SceneError> {
        let end = usize::try_from(n)
            .ok()
            .and_then(|n| self.at.checked_add(n))
            .filter(|&end| end <= self.data.len());
        let Some(end) = end else {
            return Err(self.wrong(
                &format!("byte {}", self.at),
                format!("the file ends within {what}; it is truncated or damaged"),
            ));
        };
        let out = &self.data[self.at..end];
        self.at = end;
        Ok(out)
    }

    fn u32(&mut self, what: &str) -> Result<u32, SceneError> {
        let b = self.take(4, what)?;
        Ok(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    }

    fn i32(&mut self, what: &str) -> Result<i32, SceneError> {
        Ok(self.u32(what)? as i32)
    }

    fn u64(&mut self, what: &str) -> Result<u64, SceneError> {
        Ok(u64::from(self.u32(what)?) | u64::from(self.u32(what)?) << 32)
    }

    /// A zero-terminated name of at most 255 bytes.
    fn name(&mut self, what: &str) -> Result<String, SceneError> {
        let rest = &self.data[self.at.min(self.data.len())..];
        match rest.iter().take(256).position(|&b| b == 0) {
            Some(n) => {
                self.at += n + 1;
                Ok(String::from_utf8_lossy(&rest[..n]).into_owned())
            }
            None => Err(self.wrong(
                &format!("byte {}", self.at),
                format!("{what} does not end; the file is truncated or damaged"),
            )),
        }
    }
}

/// One header; none where it is empty, which ends the list of a multi-part file.
fn header(bytes: &mut Bytes<'_>) -> Result<Option<Header>, SceneError> {
    let mut header = Header::default();
    for count in 0.. {
        let name = bytes.name("an attribute's name")?;
        if name.is_empty() {
            return Ok((count > 0).then_some(header));
        }
        let kind = bytes.name("an attribute's type")?;
        let size = bytes.u32("an attribute's size")?;
        let at = bytes.at;
        let data = bytes.take(size.into(), &format!("attribute '{name}'"))?;
        let mut value = Bytes {
            path: bytes.path,
            data: &bytes.data[..at + data.len()],
            at,
        };
        let what = format!("attribute '{name}'");
        match (name.as_str(), kind.as_str()) {
            ("type", "string") => header.kind = Some(String::from_utf8_lossy(data).into_owned()),
            ("channels", "chlist") => header.channels = Some(channels(&mut value)?),
            ("compression", "compression") => header.compression = Some(value.take(1, &what)?[0]),
            ("dataWindow", "box2i") => {
                header.data_window = Some([
                    value.i32(&what)?,
                    value.i32(&what)?,
                    value.i32(&what)?,
                    value.i32(&what)?,
                ]);
            }
            ("tiles", "tiledesc") => {
                header.tiles = Some([value.u32(&what)?, value.u32(&what)?]);
                header.levels = value.take(1, &what)?[0] & 15;
            }
            ("chunkCount", "int") => header.chunk_count = Some(value.u32(&what)?.into()),
            ("near", "float") => header.near = Some(f32::from_bits(value.u32(&what)?)),
            ("far", "float") => header.far = Some(f32::from_bits(value.u32(&what)?)),
            ("type" | "channels" | "compression" | "dataWindow" | "tiles" | "chunkCount", other) => {
                return Err(bytes.wrong(
                    &format!("attribute '{name}' at byte {at}"),
                    format!("it has the type '{other}', which is not its own"),
                ));
            }
            _ => {}
        }
    }
    Ok(None)
}

fn channels(value: &mut Bytes<'_>) -> Result<Vec<(String, Kind)>, SceneError> {
    let mut out: Vec<(String, Kind)> = Vec::new();
    loop {
        let name = value.name("a channel's name")?;
        if name.is_empty() {
            return Ok(out);
        }
        let place = format!("channel '{name}'");
        let kind = match value.u32(&place)? {
            0 => Kind::Uint,
            1 => Kind::Half,
            2 => Kind::Float,
            other => {
                return Err(value.wrong(
                    &place,
                    format!("number type {other}; 0 (uint), 1 (half) or 2 (float) is expected"),
                ));
            }
        };
        value.take(4, &place)?;
        let sampling = [value.u32(&place)?, value.u32(&place)?];
        if sampling != [1, 1] {
            return Err(value.wrong(
                &place,
                format!("sampling {sampling:?}; deep channels have a value for every pixel, [1, 1]"),
            ));
        }
        if out.iter().any(|(n, _)| *n == name) {
            return Err(value.wrong(&place, "it is there twice"));
        }
        out.push((name, kind));
    }
}

/// The channels that are used, by their places among all.
struct Used {
    z: usize,
    alpha: usize,
    color: Option<[usize; 3]>,
    z_back: Option<usize>,
}

/// What is needed to decode a chunk.
struct Layout<'a> {
    path: &'a Path,
    packing: Packing,
    kinds: Vec<Kind>,
    used: Used,
    slices: Option<NonZeroU32>,
    bytes_a_sample: u64,
}

/// A block of pixels and its three pieces in the file.
struct Chunk<'a> {
    place: String,
    /// First column and row within the data window, and columns and rows of the block.
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    table: &'a [u8],
    samples: &'a [u8],
    unpacked: u64,
}

/// Fragments of a block, pixel by pixel.
struct Decoded {
    counts: Vec<u32>,
    view_z: Vec<f32>,
    alpha: Vec<f32>,
    color: Vec<[f32; 3]>,
}

/// Reads a deep image.
///
/// Colours are divided by alpha and clamped to [0, 1]; where alpha is 0 they are black. Alpha is clamped to [0, 1]. Camera planes come from the float
/// attributes `near` and `far`, where both are there and valid.
///
/// # Errors
/// [`SceneError::FileContent`] names the file and the place: truncation, damage, flat images, missing channels, depths that are not finite and positive,
/// and volumetric samples where the options refuse them.
pub fn read(path: &Path, options: &ReadOptions) -> Result<FragmentList, SceneError> {
    decode(path, &read_file(path)?, options)
}

fn decode(path: &Path, data: &[u8], options: &ReadOptions) -> Result<FragmentList, SceneError> {
    let mut bytes = Bytes { path, data, at: 0 };
    if bytes.u32("the magic number")? != MAGIC {
        return Err(bytes.wrong("byte 0", "this is no OpenEXR file"));
    }
    let version = bytes.u32("the version")?;
    if version & 0xff != 2 {
        return Err(bytes.wrong(
            "byte 4",
            format!(
                "version {} of the format; 2 is the one that is supported",
                version & 0xff
            ),
        ));
    }
    let multi_part = version & MULTI_PART != 0;
    let mut headers = Vec::new();
    while let Some(header) = header(&mut bytes)? {
        headers.push(header);
        if !multi_part {
            break;
        }
    }
    let deep = |h: &Header| match h.kind.as_deref() {
        Some(kind) => kind.starts_with("deep"),
        None => version & DEEP != 0,
    };
    let Some(part) = headers.iter().position(deep) else {
        return Err(bytes.wrong(
            "header",
            "this image is flat; a deep image (type deepscanline or deeptile) is needed",
        ));
    };
    // The chunk tables of all parts follow one another.
    for (i, header) in headers[..part].iter().enumerate() {
        let Some(count) = header.chunk_count else {
            return Err(bytes.wrong(
                &format!("header of part {i}"),
                "there is no chunkCount, which multi-part files need",
            ));
        };
        bytes.take(count.saturating_mul(8), &format!("the chunk table of part {i}"))?;
    }
    let header = &headers[part];
    let missing = |what: &str| {
        bytes.wrong(
            &format!("header of part {part}"),
            format!("there is no attribute '{what}'"),
        )
    };
    let [x_min, y_min, x_max, y_max] = header.data_window.ok_or_else(|| missing("dataWindow"))?;
    let (width, height) = (
        i64::from(x_max) - i64::from(x_min) + 1,
        i64::from(y_max) - i64::from(y_min) + 1,
    );
    if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
        return Err(bytes.wrong(
            "dataWindow",
            format!("{width} x {height} pixels; 1 to {MAX_SIDE} a side are supported"),
        ));
    }
    let (width, height) = (width as usize, height as usize);
    let (packing, lines) = match header.compression.ok_or_else(|| missing("compression"))? {
        0 => (Packing::None, 1),
        1 => (Packing::Rle, 1),
        2 => (Packing::Zip, 1),
        3 => (Packing::Zip, 16),
        other => {
            return Err(bytes.wrong(
                "compression",
                format!("method {other}; deep images have none (0), RLE (1), ZIPS (2) or ZIP (3)"),
            ));
        }
    };
    let channels = header.channels.as_ref().ok_or_else(|| missing("channels"))?;
    let used = used_channels(&bytes, channels)?;
    let kinds: Vec<Kind> = channels.iter().map(|c| c.1).collect();
    let bytes_a_sample = kinds.iter().map(|k| k.bytes() as u64).sum();
    let layout = Layout {
        path,
        packing,
        kinds,
        used,
        slices: options.volume_slices,
        bytes_a_sample,
    };

    let tiled = match header.kind.as_deref() {
        Some(kind) => kind.starts_with("deeptile"),
        None => version & TILED != 0,
    };
    let block = if tiled {
        let [w, h] = header.tiles.ok_or_else(|| missing("tiles"))?;
        if w == 0 || h == 0 || header.levels > 2 {
            return Err(bytes.wrong(
                "tiles",
                format!("tiles of {w} x {h} pixels, level mode {}", header.levels),
            ));
        }
        [w as usize, h as usize]
    } else {
        [width, lines]
    };
    // Blocks of level 0 come first in the chunk table, row by row.
    let (columns, rows) = (width.div_ceil(block[0]), height.div_ceil(block[1]));
    let blocks = columns * rows;
    if let Some(count) = header.chunk_count
        && (count < blocks as u64 || (header.levels == 0 && count != blocks as u64))
    {
        return Err(bytes.wrong("chunkCount", format!("{count}; the data window needs {blocks}")));
    }
    let table_at = bytes.at;
    let mut table = Bytes {
        path,
        data,
        at: table_at,
    };
    table.take(blocks as u64 * 8, "the chunk table")?;
    table.at = table_at;
    let mut chunks = Vec::with_capacity(blocks);
    for k in 0..blocks {
        let place = if tiled {
            format!("tile ({}, {})", k % columns, k / columns)
        } else {
            format!("scanline block {k}")
        };
        let offset = table.u64("the chunk table")?;
        if offset == 0 {
            return Err(bytes.wrong(
                &place,
                "its chunk table entry is 0; the file was not written to its end",
            ));
        }
        let mut at = Bytes {
            path,
            data,
            at: usize::try_from(offset).unwrap_or(usize::MAX).min(data.len()),
        };
        if multi_part {
            let found = at.u32(&place)?;
            if found as usize != part {
                return Err(bytes.wrong(
                    &place,
                    format!("its chunk belongs to part {found}, not {part}; the chunk table is damaged"),
                ));
            }
        }
        let (x, y) = (k % columns * block[0], k / columns * block[1]);
        let (expected, found) = if tiled {
            (
                vec![(k % columns) as i64, (k / columns) as i64, 0, 0],
                (0..4).map(|_| at.i32(&place)).collect::<Result<Vec<_>, _>>()?,
            )
        } else {
            (vec![i64::from(y_min) + y as i64], vec![at.i32(&place)?])
        };
        if found.iter().map(|&v| i64::from(v)).ne(expected.iter().copied()) {
            return Err(bytes.wrong(
                &place,
                format!("its chunk says {found:?} where {expected:?} is expected; the chunk table is damaged"),
            ));
        }
        let (table_bytes, sample_bytes, unpacked) = (at.u64(&place)?, at.u64(&place)?, at.u64(&place)?);
        let table = at.take(table_bytes, &format!("the sample counts of {place}"))?;
        let samples = at.take(sample_bytes, &format!("the samples of {place}"))?;
        let (w, h) = (block[0].min(width - x), block[1].min(height - y));
        // Counts that would not shrink are stored as they are, and for a tile that is cut off in the size of a whole one.
        let whole = block[0] * block[1] * 4;
        let table = if tiled && table.len() == whole {
            &table[..w * h * 4]
        } else {
            table
        };
        if (w * h * 4) as u64 > table_bytes.saturating_mul(MAX_EXPANSION) {
            return Err(bytes.wrong(
                &place,
                format!("{table_bytes} bytes cannot hold the sample counts of {w} x {h} pixels"),
            ));
        }
        chunks.push(Chunk {
            place,
            x,
            y,
            width: w,
            height: h,
            table,
            samples,
            unpacked,
        });
    }
    let decoded: Vec<Decoded> = chunks
        .par_iter()
        .map(|chunk| layout.block(chunk))
        .collect::<Result<_, _>>()?;
    let list = assemble(&chunks, decoded, width, height, layout.used.color.is_some()).map_err(|source| {
        SceneError::Content {
            path: path.to_owned(),
            source,
        }
    })?;
    Ok(match (header.near, header.far) {
        (Some(near), Some(far)) => CameraPlanes::new(near, far).map_or(list.clone(), |planes| list.with_planes(planes)),
        _ => list,
    })
}

fn used_channels(bytes: &Bytes<'_>, channels: &[(String, Kind)]) -> Result<Used, SceneError> {
    let place = |name: &str| channels.iter().position(|(n, _)| n == name);
    let names = || channels.iter().map(|c| c.0.as_str()).collect::<Vec<_>>().join(", ");
    let needed = |name: &str, what: &str| {
        place(name).ok_or_else(|| {
            bytes.wrong(
                "channels",
                format!("there is no channel {name} ({what}); the file has {}", names()),
            )
        })
    };
    let color = match [place("R"), place("G"), place("B")] {
        [Some(r), Some(g), Some(b)] => Some([r, g, b]),
        [None, None, None] => None,
        _ => {
            return Err(bytes.wrong(
                "channels",
                format!("colour needs R, G and B, or none of them; the file has {}", names()),
            ));
        }
    };
    Ok(Used {
        z: needed("Z", "depth")?,
        alpha: needed("A", "alpha")?,
        color,
        z_back: place("ZBack"),
    })
}

impl Layout<'_> {
    fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    /// `size` bytes from their packed form; data that would not shrink stands there as it is.
    fn unpack(&self, place: &str, packed: &[u8], size: u64) -> Result<Vec<u8>, SceneError> {
        if packed.len() as u64 == size {
            return Ok(packed.to_vec());
        }
        let most = if self.packing == Packing::None {
            0
        } else {
            (packed.len() as u64).saturating_mul(MAX_EXPANSION)
        };
        if (packed.len() as u64) > size || size > most {
            return Err(self.wrong(
                place,
                format!(
                    "{} bytes cannot hold the {size} that are declared; the file is damaged",
                    packed.len()
                ),
            ));
        }
        let mut out = vec![0u8; size as usize];
        let whole = match self.packing {
            Packing::Zip => {
                let mut inflate = Decompress::new(true);
                inflate
                    .decompress(packed, &mut out, FlushDecompress::Finish)
                    .is_ok_and(|s| s == Status::StreamEnd)
                    && inflate.total_out() == size
            }
            _ => unpack_runs(packed, &mut out),
        };
        if !whole {
            return Err(self.wrong(place, "its compressed data is damaged"));
        }
        // Bytes are stored as differences, all even ones before all odd ones.
        for i in 1..out.len() {
            out[i] = out[i].wrapping_add(out[i - 1]).wrapping_sub(128);
        }
        let (even, odd) = out.split_at(out.len().div_ceil(2));
        Ok((0..out.len())
            .map(|i| if i % 2 == 0 { even[i / 2] } else { odd[i / 2] })
            .collect())
    }

    fn block(&self, chunk: &Chunk<'_>) -> Result<Decoded, SceneError> {
        let pixels = chunk.width * chunk.height;
        let table = self.unpack(
            &format!("{}, sample counts", chunk.place),
            chunk.table,
            pixels as u64 * 4,
        )?;
        // Counts are running sums along each row.
        let mut counts = Vec::with_capacity(pixels);
        let mut total = 0u64;
        for (row, line) in table.chunks_exact(4 * chunk.width).enumerate() {
            let mut before = 0;
            for (column, b) in line.chunks_exact(4).enumerate() {
                let sum = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
                if sum < before || sum > i32::MAX as u32 {
                    let place = format!("{}, pixel ({}, {})", chunk.place, chunk.x + column, chunk.y + row);
                    return Err(self.wrong(
                        &place,
                        format!("the running sum of samples goes from {before} to {sum}; the file is damaged"),
                    ));
                }
                counts.push(sum - before);
                before = sum;
            }
            total += u64::from(before);
        }
        if total.checked_mul(self.bytes_a_sample) != Some(chunk.unpacked) {
            let reason = format!(
                "{total} samples of {} bytes are counted, but {} bytes declared; the file is damaged",
                self.bytes_a_sample, chunk.unpacked
            );
            return Err(self.wrong(&chunk.place, reason));
        }
        let data = self.unpack(&format!("{}, samples", chunk.place), chunk.samples, chunk.unpacked)?;
        let n = total as usize;
        let mut out = Decoded {
            counts: Vec::with_capacity(pixels),
            view_z: Vec::with_capacity(n),
            alpha: Vec::with_capacity(n),
            color: Vec::new(),
        };
        if self.used.color.is_some() {
            out.color.reserve(n);
        }
        let mut line_at = 0;
        for (row, counts) in counts.chunks_exact(chunk.width).enumerate() {
            let samples: usize = counts.iter().map(|&c| c as usize).sum();
            // Within a row, each channel stands alone.
            let mut starts = Vec::with_capacity(self.kinds.len());
            for kind in &self.kinds {
                starts.push(line_at);
                line_at += samples * kind.bytes();
            }
            let value = |channel: usize, i: usize| {
                self.kinds[channel].value(&data[starts[channel] + i * self.kinds[channel].bytes()..])
            };
            let mut i = 0;
            for (column, &count) in counts.iter().enumerate() {
                let before = out.view_z.len();
                for _ in 0..count {
                    self.sample(&value, i, &mut out).map_err(|reason| {
                        let place = format!(
                            "{}, pixel ({}, {}), sample {}",
                            chunk.place,
                            chunk.x + column,
                            chunk.y + row,
                            out.view_z.len() - before
                        );
                        self.wrong(&place, reason)
                    })?;
                    i += 1;
                }
                out.counts.push((out.view_z.len() - before) as u32);
            }
        }
        Ok(out)
    }

    /// Appends the fragments of one sample: one, or the slices of a volume.
    fn sample(&self, value: &impl Fn(usize, usize) -> f32, i: usize, out: &mut Decoded) -> Result<(), String> {
        let (z, a) = (value(self.used.z, i), value(self.used.alpha, i));
        if !(z > 0.0 && z.is_finite()) {
            return Err(format!("Z = {z}; it must be finite and greater than 0"));
        }
        if a.is_nan() {
            return Err("A is not a number".to_owned());
        }
        let alpha = a.clamp(0.0, 1.0);
        let mut color = [0.0; 3];
        if let Some(places) = self.used.color {
            for (c, place) in color.iter_mut().zip(places) {
                let premultiplied = value(place, i);
                if premultiplied.is_nan() {
                    return Err("its colour is not a number".to_owned());
                }
                *c = if alpha > 0.0 {
                    (premultiplied / alpha).clamp(0.0, 1.0)
                } else {
                    0.0
                };
            }
        }
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

/// Run lengths: n >= 0 repeats the next byte n + 1 times, n < 0 copies −n bytes. False unless they fill `out` exactly.
fn unpack_runs(mut packed: &[u8], out: &mut [u8]) -> bool {
    let mut at = 0;
    while let Some((&n, rest)) = packed.split_first() {
        let n = n as i8;
        let length = if n < 0 {
            usize::from(n.unsigned_abs())
        } else {
            n as usize + 1
        };
        let Some(target) = out.get_mut(at..at + length) else {
            return false;
        };
        if n < 0 {
            let Some((copied, rest)) = rest.split_at_checked(length) else {
                return false;
            };
            target.copy_from_slice(copied);
            packed = rest;
        } else {
            let Some((&value, rest)) = rest.split_first() else {
                return false;
            };
            target.fill(value);
            packed = rest;
        }
        at += length;
    }
    at == out.len()
}

/// Puts the blocks' fragments in the order of the image's pixels.
fn assemble(
    chunks: &[Chunk<'_>],
    decoded: Vec<Decoded>,
    width: usize,
    height: usize,
    colored: bool,
) -> Result<FragmentList, crate::pixel::FragmentError> {
    let mut offsets = vec![0u64; width * height + 1];
    for (chunk, block) in chunks.iter().zip(&decoded) {
        for (row, counts) in block.counts.chunks_exact(chunk.width).enumerate() {
            let first = (chunk.y + row) * width + chunk.x + 1;
            for (o, &c) in offsets[first..].iter_mut().zip(counts) {
                *o = c.into();
            }
        }
    }
    for p in 1..offsets.len() {
        offsets[p] += offsets[p - 1];
    }
    let total = offsets[width * height] as usize;
    let (mut view_z, mut alpha, mut color) = (
        vec![0.0; total],
        vec![0.0; total],
        vec![[0.0; 3]; if colored { total } else { 0 }],
    );
    for (chunk, block) in chunks.iter().zip(decoded) {
        let mut from = 0;
        for (row, counts) in block.counts.chunks_exact(chunk.width).enumerate() {
            let n: usize = counts.iter().map(|&c| c as usize).sum();
            let to = offsets[(chunk.y + row) * width + chunk.x] as usize;
            view_z[to..to + n].copy_from_slice(&block.view_z[from..from + n]);
            alpha[to..to + n].copy_from_slice(&block.alpha[from..from + n]);
            if colored {
                color[to..to + n].copy_from_slice(&block.color[from..from + n]);
            }
            from += n;
        }
    }
    FragmentList::new(offsets, view_z, alpha, colored.then_some(color))?.with_size(width as u32, height as u32)
}

/// Writes a deep image: one part of scanlines, ZIPS compressed; Z, A and, where the list has colours, R, G, B as 32-bit floats, colours premultiplied.
///
/// A list without an image size becomes one row of pixels. Depths and alphas are read back bit for bit; a colour to one unit in its last place, and as
/// black where alpha is 0.
///
/// # Errors
/// [`SceneError::FileContent`] for a list without pixels or wider than the format can say; [`SceneError::File`] for what the system reports.
pub fn write(path: &Path, replace: Replace, list: &FragmentList) -> Result<(), SceneError> {
    let pixels = list.pixels();
    let (width, height) = match list.size() {
        Some((w, h)) => (w as usize, h as usize),
        None => (pixels, 1),
    };
    if pixels == 0 || width as i64 > MAX_SIDE || height as i64 > MAX_SIDE {
        let reason = format!("an image of {width} x {height} pixels; a deep image has 1 to {MAX_SIDE} a side");
        return Err(SceneError::file_content(path, "dataWindow", reason));
    }
    let mut out = Vec::new();
    out.extend(MAGIC.to_le_bytes());
    out.extend((2 | DEEP).to_le_bytes());
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        for text in [name, kind] {
            out.extend(text.as_bytes());
            out.push(0);
        }
        out.extend((value.len() as u32).to_le_bytes());
        out.extend(value);
    };
    let names: &[&str] = if list.color().is_some() {
        &["A", "B", "G", "R", "Z"]
    } else {
        &["A", "Z"]
    };
    let mut channels = Vec::new();
    for name in names {
        channels.extend(name.as_bytes());
        channels.push(0);
        // Number type float, linearity hint and padding, sampling 1 x 1.
        channels.extend([2u32, 0, 1, 1].iter().flat_map(|v| v.to_le_bytes()));
    }
    channels.push(0);
    let window: Vec<u8> = [0, 0, width as i32 - 1, height as i32 - 1]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let deepest = (0..pixels)
        .map(|p| list.range(p).len())
        .max()
        .unwrap_or(0)
        .min(i32::MAX as usize) as i32;
    attribute("channels", "chlist", &channels);
    attribute("chunkCount", "int", &(height as i32).to_le_bytes());
    attribute("compression", "compression", &[2]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("maxSamplesPerPixel", "int", &deepest.to_le_bytes());
    attribute("name", "string", b"fragments");
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    attribute("type", "string", b"deepscanline");
    attribute("version", "int", &1i32.to_le_bytes());
    if let Some(planes) = list.planes() {
        attribute("near", "float", &planes.near().to_le_bytes());
        attribute("far", "float", &planes.far().to_le_bytes());
    }
    out.push(0);
    let rows: Vec<Vec<u8>> = (0..height).into_par_iter().map(|y| scanline(list, width, y)).collect();
    let mut at = out.len() as u64 + 8 * height as u64;
    for row in &rows {
        out.extend(at.to_le_bytes());
        at += row.len() as u64;
    }
    write_atomically(path, replace, |w| {
        w.write_all(&out)?;
        rows.iter().try_for_each(|row| w.write_all(row))
    })
    .map_err(|e: FileError| e.into())
}

/// The chunk of one row.
fn scanline(list: &FragmentList, width: usize, y: usize) -> Vec<u8> {
    let range = list.range(y * width).start..list.range(y * width + width - 1).end;
    let first = range.start;
    let table: Vec<u8> = (0..width)
        .flat_map(|x| ((list.range(y * width + x).end - first) as u32).to_le_bytes())
        .collect();
    let alpha = &list.alpha()[range.clone()];
    let mut samples: Vec<u8> = Vec::with_capacity(range.len() * 20);
    samples.extend(alpha.iter().flat_map(|a| a.to_le_bytes()));
    if let Some(color) = list.color() {
        for channel in [2, 1, 0] {
            samples.extend(
                color[range.clone()]
                    .iter()
                    .zip(alpha)
                    .flat_map(|(c, a)| (c[channel] * a).to_le_bytes()),
            );
        }
    }
    samples.extend(list.view_z()[range].iter().flat_map(|z| z.to_le_bytes()));
    let (packed_table, packed) = (pack(&table), pack(&samples));
    let mut out = Vec::with_capacity(28 + packed_table.len() + packed.len());
    out.extend((y as i32).to_le_bytes());
    for size in [packed_table.len(), packed.len(), samples.len()] {
        out.extend((size as u64).to_le_bytes());
    }
    out.extend(packed_table);
    out.extend(packed);
    out
}

/// The ZIPS form of data; the data itself where that is not shorter.
fn pack(data: &[u8]) -> Vec<u8> {
    let mut split: Vec<u8> = data
        .iter()
        .step_by(2)
        .chain(data.iter().skip(1).step_by(2))
        .copied()
        .collect();
    for i in (1..split.len()).rev() {
        split[i] = split[i].wrapping_sub(split[i - 1]).wrapping_add(128);
    }
    let mut packed = vec![0; data.len()];
    let mut deflate = Compress::new(Compression::default(), true);
    match deflate.compress(&split, &mut packed, FlushCompress::Finish) {
        Ok(Status::StreamEnd) if deflate.total_out() < data.len() as u64 => {
            packed.truncate(deflate.total_out() as usize);
            packed
        }
        _ => data.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample_list() -> FragmentList {
        let offsets = vec![0, 2, 2, 3, 6, 6, 7];
        let n = 7;
        FragmentList::new(
            offsets,
            (0..n).map(|i| 1.0 + i as f32 / 3.0).collect(),
            (0..n).map(|i| i as f32 / 6.0).collect(),
            Some((0..n).map(|i| [i as f32 / 7.0, 0.5, 1.0]).collect()),
        )
        .unwrap()
        .with_size(3, 2)
        .unwrap()
        .with_planes(CameraPlanes::new(0.5, 20.0).unwrap())
    }

    fn bytes_of(list: &FragmentList) -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep.exr");
        write(&path, Replace::No, list).unwrap();
        std::fs::read(&path).unwrap()
    }

    fn decoded(bytes: &[u8]) -> Result<FragmentList, SceneError> {
        decode(Path::new("deep.exr"), bytes, &ReadOptions::default())
    }

    /// Depth and alpha bit for bit; colour within 2e-7 (a multiplication and a division in f32).
    #[test]
    fn round_trip() {
        let list = sample_list();
        let back = decoded(&bytes_of(&list)).unwrap();
        assert_eq!(
            (back.offsets(), back.view_z(), back.alpha()),
            (list.offsets(), list.view_z(), list.alpha())
        );
        assert_eq!((back.size(), back.planes()), (list.size(), list.planes()));
        for ((a, b), alpha) in back
            .color()
            .unwrap()
            .iter()
            .zip(list.color().unwrap())
            .zip(list.alpha())
        {
            let expected = if *alpha == 0.0 { [0.0; 3] } else { *b };
            assert!(
                a.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 2e-7),
                "{a:?} {expected:?}"
            );
        }
        // A long row compresses; the short ones above are stored as they are.
        let n = 5000;
        let long = FragmentList::new(vec![0, n, n], vec![2.0; n as usize], vec![0.5; n as usize], None).unwrap();
        let bytes = bytes_of(&long);
        assert!(bytes.len() < 5000);
        let back = decoded(&bytes).unwrap();
        assert_eq!(
            (back.view_z(), back.alpha(), back.size()),
            (long.view_z(), long.alpha(), Some((2, 1)))
        );
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap();
        assert!(
            write(Path::new("never.exr"), Replace::No, &none)
                .unwrap_err()
                .to_string()
                .contains("0 x 1 pixels")
        );
    }

    #[test]
    fn every_truncation_is_an_error_that_names_the_file() {
        let bytes = bytes_of(&sample_list());
        for n in 0..bytes.len() {
            let message = decoded(&bytes[..n]).unwrap_err().to_string();
            assert!(message.starts_with("deep.exr: "), "{n}: {message}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]
        /// Whatever bytes change, there is a valid list or an error, and no panic.
        #[test]
        fn flipped_bytes_never_panic(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4), long in any::<bool>()) {
            let list = if long {
                FragmentList::new(vec![0, 300], vec![2.0; 300], vec![0.5; 300], None).unwrap()
            } else {
                sample_list()
            };
            let mut bytes = bytes_of(&list);
            for (at, value) in flips {
                let i = at.index(bytes.len());
                bytes[i] = value;
            }
            if let Err(error) = decoded(&bytes) {
                prop_assert!(error.to_string().starts_with("deep.exr: "));
            }
        }
    }

    #[test]
    fn damage_names_its_place() {
        let good = bytes_of(&sample_list());
        let find = |what: &[u8]| good.windows(what.len()).position(|w| w == what).unwrap();
        let changed = |at: usize, value: &[u8]| {
            let mut bytes = good.clone();
            bytes[at..at + value.len()].copy_from_slice(value);
            decoded(&bytes).unwrap_err().to_string()
        };
        let data_at = find(b"far\0float\0") + 10 + 4 + 4 + 1;
        let first = u64::from_le_bytes(good[data_at..data_at + 8].try_into().unwrap()) as usize;
        let cases = [
            (changed(0, b"X"), "no OpenEXR file"),
            (changed(find(b"A\0\x02"), b"Q"), "no channel A (alpha)"),
            (changed(find(b"Z\0\x02"), b"Q"), "no channel Z (depth)"),
            (changed(find(b"R\0\x02"), b"Q"), "needs R, G and B"),
            (changed(find(b"deepscanline"), b"scanlineimag"), "flat"),
            (
                changed(data_at, &[0; 8]),
                "scanline block 0: its chunk table entry is 0",
            ),
            (changed(data_at + 8, &[255; 8]), "the file ends within scanline block 1"),
            (changed(first, &[9]), "its chunk says [9] where [0] is expected"),
            // The first row's running sums 2, 2, 3 follow the chunk's 28 bytes.
            (
                changed(first + 28, &[200]),
                "scanline block 0, pixel (1, 0): the running sum of samples goes from 200 to 2",
            ),
            (
                changed(first + 36, &[5]),
                "5 samples of 20 bytes are counted, but 60 bytes declared",
            ),
        ];
        for (message, part) in cases {
            assert!(
                message.contains(part) && message.contains("deep.exr"),
                "{message} / {part}"
            );
        }
    }

    #[test]
    fn halves_and_runs() {
        for (bits, value) in [
            (0u16, 0.0f32),
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (1, 5.960_464_5e-8),
            (0x7bff, 65504.0),
            (0x3555, 0.333_251_95),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan() && half(0x7c00) == f32::INFINITY);
        let mut out = [0; 5];
        assert!(unpack_runs(&[2, 7, 254, 1, 2], &mut out));
        assert_eq!(out, [7, 7, 7, 1, 2]);
        assert!(
            !unpack_runs(&[3, 7], &mut out) && !unpack_runs(&[5, 7], &mut out) && !unpack_runs(&[251, 1], &mut out)
        );
    }

    /// Slices of a volume hide as much as the whole. Tolerance: alphas are f32.
    #[test]
    fn volumes_are_cut_or_refused() {
        let layout = |slices| Layout {
            path: Path::new("deep.exr"),
            packing: Packing::None,
            kinds: vec![Kind::Float; 3],
            used: Used {
                z: 0,
                alpha: 1,
                color: None,
                z_back: Some(2),
            },
            slices: NonZeroU32::new(slices),
            bytes_a_sample: 12,
        };
        let value = |channel: usize, _: usize| [2.0, 0.7, 4.0][channel];
        let mut out = Decoded {
            counts: Vec::new(),
            view_z: Vec::new(),
            alpha: Vec::new(),
            color: Vec::new(),
        };
        layout(4).sample(&value, 0, &mut out).unwrap();
        assert_eq!(out.view_z, [2.25, 2.75, 3.25, 3.75]);
        let through: f64 = out.alpha.iter().map(|&a| 1.0 - f64::from(a)).product();
        assert!((through - 0.3).abs() < 1e-6, "{through}");
        assert!(layout(0).sample(&value, 0, &mut out).unwrap_err().contains("volume"));
    }

    /// Files that OpenEXR's own library wrote (see `make.py` beside them): every packing, scanlines and tiles that are cut off at the edges.
    #[test]
    fn files_of_openexr_itself() {
        for form in ["scanline", "tiled"] {
            for packing in ["no", "rle", "zips"] {
                let path = format!("{}/tests/data/deep/{form}_{packing}.exr", env!("CARGO_MANIFEST_DIR"));
                let list = super::read(Path::new(&path), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
                assert_eq!(list.size(), Some((13, 9)), "{path}");
                for p in 0..list.pixels() {
                    let (x, y) = (p % 13, p / 13);
                    let pixel = list.pixel(p);
                    assert_eq!(pixel.len(), (x + 2 * y) % 4, "{path} ({x}, {y})");
                    for k in 0..pixel.len() {
                        assert_eq!(pixel.view_z[k], 1.0 + k as f32 + x as f32 / 8.0);
                        assert_eq!(pixel.alpha[k], (k + 1) as f32 / 4.0);
                        assert_eq!(pixel.color.unwrap()[k], [0.5, 0.25, 0.0]);
                    }
                }
            }
        }
    }
}
