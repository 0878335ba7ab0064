//! Writing a deep image.

use super::{DEEP, MAGIC, MAX_SIDE};
use crate::numeric::file::{FileError, Replace, write_atomically};
use crate::pixel::{FragmentList, Windows};
use crate::scene::SceneError;
use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;
use std::path::Path;

/// Writes a deep image: one part of scanlines, ZIPS compressed; Z, A and, where the list has colours, R, G, B as 32-bit
/// floats, colours premultiplied.
///
/// A list without an image size becomes one row of pixels. Depths and alphas are read back bit for bit and a colour to
/// one unit in its last place; fragments of alpha 0 are written and, as in files of other programs, not read.
///
/// # Errors
/// [`SceneError::FileContent`] for a list without pixels or wider than the format can say; [`SceneError::File`] for
/// what the system reports.
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
    let whole = [0, 0, width as i32 - 1, height as i32 - 1];
    let Windows { data, display } = list.windows().unwrap_or(Windows {
        data: whole,
        display: whole,
    });
    let window = |window: [i32; 4]| -> Vec<u8> { window.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let deepest = (0..pixels)
        .map(|p| list.range(p).len())
        .max()
        .unwrap_or(0)
        .min(i32::MAX as usize) as i32;
    attribute("channels", "chlist", &channels);
    attribute("chunkCount", "int", &(height as i32).to_le_bytes());
    attribute("compression", "compression", &[2]);
    attribute("dataWindow", "box2i", &window(data));
    attribute("displayWindow", "box2i", &window(display));
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
    let rows: Vec<Vec<u8>> = (0..height)
        .into_par_iter()
        .map(|y| scanline(list, width, y, data[1]))
        .collect();
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

/// The chunk of one row; `first_row` is the number of the image's first in the file.
fn scanline(list: &FragmentList, width: usize, y: usize, first_row: i32) -> Vec<u8> {
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
    out.extend((first_row + y as i32).to_le_bytes());
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
