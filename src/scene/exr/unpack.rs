//! The compression methods of deep images.

use flate2::{Decompress, FlushDecompress, Status};
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;

/// How the bytes of a chunk are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Packing {
    None,
    Rle,
    Zip,
    Zstd,
}

/// What the bytes of a chunk are, which ZSTD sorts by the size of their numbers.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content<'a> {
    /// One 32-bit number a pixel.
    Counts,
    /// Samples of every row, and the bytes of one number of each channel.
    Samples { rows: &'a [u64], channels: &'a [usize] },
}

impl Packing {
    /// The method of a header's number, and the scanlines that it packs together; the number's name where there is none
    /// for deep images.
    pub fn of_method(method: u8) -> Result<(Self, usize), String> {
        let name = match method {
            0 => return Ok((Self::None, 1)),
            1 => return Ok((Self::Rle, 1)),
            2 => return Ok((Self::Zip, 1)),
            3 => return Ok((Self::Zip, 16)),
            13 => return Ok((Self::Zstd, 1)),
            4 => "PIZ",
            5 => "PXR24",
            6 => "B44",
            7 => "B44A",
            8 => "DWAA",
            9 => "DWAB",
            10..=12 => "HTJ2K",
            _ => "unknown",
        };
        Err(format!(
            "method {method} ({name}); deep images have none (0), RLE (1), ZIPS (2), ZIP (3) or ZSTD (13): save the \
                file with ZIPS"
        ))
    }

    /// Most bytes that one compressed byte may stand for: deflate's bound is 1032, run lengths reach 64, a repeated
    /// block of ZSTD 2^17 in four bytes.
    pub fn max_expansion(self) -> u64 {
        match self {
            Self::None => 1,
            Self::Rle => 64,
            Self::Zip => 1032,
            Self::Zstd => 1 << 15,
        }
    }

    /// `size` bytes from their packed form; what is wrong with it otherwise. Data that would not shrink stands there as
    /// it is.
    pub fn unpack(self, packed: &[u8], size: u64, content: Content<'_>) -> Result<Vec<u8>, String> {
        if packed.len() as u64 == size {
            return Ok(packed.to_vec());
        }
        let most = (packed.len() as u64).saturating_mul(self.max_expansion());
        if self == Self::None || packed.len() as u64 > size || size > most {
            let n = packed.len();
            return Err(format!(
                "{n} bytes cannot hold the {size} that are declared; the file is damaged"
            ));
        }
        let size = size as usize;
        let damaged = || "its compressed data is damaged".to_owned();
        match self {
            Self::Zstd => zstd(packed, size, content),
            Self::Zip => {
                let mut out = vec![0u8; size];
                let mut inflate = Decompress::new(true);
                let whole = inflate
                    .decompress(packed, &mut out, FlushDecompress::Finish)
                    .is_ok_and(|s| s == Status::StreamEnd)
                    && inflate.total_out() == size as u64;
                if whole { Ok(undifferenced(out)) } else { Err(damaged()) }
            }
            Self::None | Self::Rle => {
                let mut out = vec![0u8; size];
                if unpack_runs(packed, &mut out) {
                    Ok(undifferenced(out))
                } else {
                    Err(damaged())
                }
            }
        }
    }
}

/// Bytes that were stored as differences, all even ones before all odd ones.
fn undifferenced(mut out: Vec<u8>) -> Vec<u8> {
    for i in 1..out.len() {
        out[i] = out[i].wrapping_add(out[i - 1]).wrapping_sub(128);
    }
    let (even, odd) = out.split_at(out.len().div_ceil(2));
    (0..out.len())
        .map(|i| if i % 2 == 0 { even[i / 2] } else { odd[i / 2] })
        .collect()
}

/// ZSTD as OpenEXR writes it: 24 bytes ahead of the frame ("zstd-exr", version, flags, size), and in the frame the
/// 16-bit channels of all rows and then the 32-bit ones, each behind its length, with the first bytes of all numbers
/// before the second ones.
fn zstd(packed: &[u8], size: usize, content: Content<'_>) -> Result<Vec<u8>, String> {
    let damaged = |what: &str| format!("its ZSTD data is damaged ({what})");
    let (head, frame) = packed.split_at_checked(24).ok_or_else(|| damaged("it ends early"))?;
    let word = |k: usize| u32::from_le_bytes([head[k], head[k + 1], head[k + 2], head[k + 3]]);
    if &head[..8] != b"zstd-exr" {
        return Err(damaged("it does not begin with 'zstd-exr'"));
    }
    if word(8) != 1 || word(12) != 0 {
        let found = format!("version {} with flags {}", word(8), word(12));
        return Err(format!(
            "{found} of ZSTD in OpenEXR is not supported: save the file with ZIPS"
        ));
    }
    let segments: Vec<(usize, usize)> = match content {
        Content::Counts => vec![(size, 4)],
        Content::Samples { rows, channels } => {
            let samples: u64 = rows.iter().sum();
            let of = |bytes: usize| {
                (
                    samples as usize * channels.iter().filter(|b| **b == bytes).count() * bytes,
                    bytes,
                )
            };
            [of(2), of(4)].into_iter().filter(|s| s.0 > 0).collect()
        }
    };
    if segments.iter().map(|s| s.0).sum::<usize>() != size {
        return Err(damaged("its size is not that of its numbers"));
    }
    let inner_size = size + 8 * segments.len();
    let window = (inner_size as u64).max(1 << 20);
    let mut frame = frame;
    let decoder =
        StreamingDecoder::new_with_max_window_size(&mut frame, window).map_err(|e| damaged(&e.to_string()))?;
    let mut inner = Vec::new();
    decoder
        .take(inner_size as u64 + 1)
        .read_to_end(&mut inner)
        .map_err(|e| damaged(&e.to_string()))?;
    if inner.len() != inner_size {
        return Err(damaged("its length is not the one declared"));
    }
    let mut rest = inner.as_slice();
    let mut sorted: Vec<Vec<u8>> = Vec::new();
    for &(length, width) in &segments {
        let (declared, after) = rest.split_at(8);
        if declared != (length as u64).to_le_bytes() {
            return Err(damaged("a segment is not of the length that its numbers need"));
        }
        let (planes, after) = after.split_at(length);
        rest = after;
        let n = length / width;
        sorted.push((0..length).map(|i| planes[i % width * n + i / width]).collect());
    }
    let Content::Samples { rows, channels } = content else {
        return Ok(sorted.pop().unwrap_or_default());
    };
    let mut cursors: Vec<(usize, std::slice::Iter<'_, u8>)> = segments
        .iter()
        .map(|s| s.1)
        .zip(sorted.iter().map(|s| s.iter()))
        .collect();
    let mut out = Vec::with_capacity(size);
    for &samples in rows {
        for &bytes in channels {
            if let Some((_, cursor)) = cursors.iter_mut().find(|c| c.0 == bytes) {
                out.extend(cursor.by_ref().take(samples as usize * bytes));
            }
        }
    }
    Ok(out)
}

/// Run lengths: n >= 0 repeats the next byte n + 1 times, n < 0 copies −n bytes. False unless they fill `out` exactly.
pub(super) fn unpack_runs(mut packed: &[u8], out: &mut [u8]) -> bool {
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
