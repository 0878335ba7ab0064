//! Where the blocks of pixels of a part stand in the file.

use super::bytes::Bytes;
use super::header::FileHeader;
use super::samples::Layout;
use crate::scene::SceneError;

/// A block of pixels and its three pieces in the file.
pub(super) struct Chunk<'a> {
    pub place: String,
    /// First column and row within the data window, and columns and rows of the block.
    pub x: usize,
    pub y: usize,
    pub width: usize,
    pub height: usize,
    pub table: &'a [u8],
    pub samples: &'a [u8],
    pub unpacked: u64,
}

/// Finds the chunks of a part; `bytes` stands behind the last header.
pub(super) fn locate<'a>(
    bytes: &mut Bytes<'a>,
    file: &FileHeader,
    part: usize,
    layout: &Layout<'_>,
) -> Result<Vec<Chunk<'a>>, SceneError> {
    // The chunk tables of all parts follow one another.
    for (i, header) in file.parts[..part].iter().enumerate() {
        let Some(count) = header.chunk_count else {
            let reason = "there is no chunkCount, which multi-part files need";
            return Err(bytes.wrong(&format!("header of part {i}"), reason));
        };
        bytes.take(count.saturating_mul(8), &format!("the chunk table of part {i}"))?;
    }
    let header = &file.parts[part];
    // Blocks of level 0 come first in the chunk table, row by row.
    let [block_width, block_height] = layout.block;
    let (columns, rows) = (layout.width.div_ceil(block_width), layout.height.div_ceil(block_height));
    let blocks = columns * rows;
    if let Some(count) = header.chunk_count
        && (count < blocks as u64 || (header.levels == 0 && count != blocks as u64))
    {
        return Err(bytes.wrong("chunkCount", format!("{count}; the data window needs {blocks}")));
    }
    let table = bytes.take(blocks as u64 * 8, "the chunk table")?;
    let tiled = file.is_tiled(part);
    let mut chunks = Vec::with_capacity(blocks);
    for (k, offset) in table.chunks_exact(8).enumerate() {
        let (column, row) = (k % columns, k / columns);
        let place = if tiled {
            format!("tile ({column}, {row})")
        } else {
            format!("scanline block {k}")
        };
        let offset = u64::from_le_bytes(offset.try_into().expect("eight bytes"));
        if offset == 0 {
            let reason = "its chunk table entry is 0; the file was not written to its end";
            return Err(bytes.wrong(&place, reason));
        }
        let at = usize::try_from(offset).unwrap_or(usize::MAX).min(bytes.data.len());
        let at = Bytes {
            path: bytes.path,
            data: bytes.data,
            at,
        };
        chunks.push(chunk(at, place, [column, row], file, part, layout)?);
    }
    Ok(chunks)
}

/// The chunk that begins where `at` stands, of the block in a column and a row.
fn chunk<'a>(
    mut at: Bytes<'a>,
    place: String,
    [column, row]: [usize; 2],
    file: &FileHeader,
    part: usize,
    layout: &Layout<'_>,
) -> Result<Chunk<'a>, SceneError> {
    let [block_width, block_height] = layout.block;
    let tiled = file.is_tiled(part);
    if file.is_multi_part() {
        let found = at.u32(&place)?;
        if found as usize != part {
            let reason = format!("its chunk belongs to part {found}, not {part}; the chunk table is damaged");
            return Err(at.wrong(&place, reason));
        }
    }
    let (x, y) = (column * block_width, row * block_height);
    let expected = if tiled {
        vec![column as i64, row as i64, 0, 0]
    } else {
        vec![i64::from(layout.windows.data[1]) + y as i64]
    };
    let found = expected.iter().map(|_| at.i32(&place)).collect::<Result<Vec<_>, _>>()?;
    if found.iter().map(|&v| i64::from(v)).ne(expected.iter().copied()) {
        let reason = format!("its chunk says {found:?} where {expected:?} is expected; the chunk table is damaged");
        return Err(at.wrong(&place, reason));
    }
    let (table_bytes, sample_bytes, unpacked) = (at.u64(&place)?, at.u64(&place)?, at.u64(&place)?);
    let table = at.take(table_bytes, &format!("the sample counts of {place}"))?;
    let samples = at.take(sample_bytes, &format!("the samples of {place}"))?;
    let (width, height) = (block_width.min(layout.width - x), block_height.min(layout.height - y));
    // Counts that would not shrink are stored as they are, and for a tile that is cut off in the size of a whole
    // one.
    let whole = block_width.saturating_mul(block_height).saturating_mul(4);
    let table = if tiled && table.len() == whole {
        &table[..width * height * 4]
    } else {
        table
    };
    if (width * height * 4) as u64 > table_bytes.saturating_mul(layout.packing.max_expansion()) {
        let reason = format!("{table_bytes} bytes cannot hold the sample counts of {width} x {height} pixels");
        return Err(at.wrong(&place, reason));
    }
    Ok(Chunk {
        place,
        x,
        y,
        width,
        height,
        table,
        samples,
        unpacked,
    })
}
