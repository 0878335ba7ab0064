//! Deep OpenEXR images: files in which a pixel holds many samples in depth.
//!
//! Read: every deep part of single-part and multi-part files, scanlines or tiles (level 0), uncompressed or RLE, ZIPS,
//! ZIP or ZSTD compressed, channels of any of the three number types, with or without a layer's name before them. Used
//! are depth `Z`, opacity `A` (or one for each colour), the colours `R`, `G`, `B` (all three or none) and `ZBack`.
//! Everything else is named in [`FragmentList::left_out`]. Written: one part of deep scanlines, ZIPS compressed, 32-bit
//! floats.
//!
//! Every size in a file is checked against the bytes that are there before memory is taken for it: no more is ever used
//! than what the compression methods can reach at best.

mod bytes;
mod channels;
mod chunks;
mod header;
mod samples;
mod unpack;
mod write;

pub use write::write;

use super::{ListFormat, SceneError};
use crate::numeric::file::read as read_file;
use crate::pixel::left_out::{LeftOut, note};
use crate::pixel::{CameraPlanes, FragmentError, FragmentList, Windows};
use bytes::Bytes;
use chunks::Chunk;
use header::{FileHeader, Header};
use rayon::prelude::*;
use samples::{Decoded, Layout, Tally};
use std::num::NonZeroU32;
use std::path::Path;

/// How a deep image is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadOptions {
    /// Slices that a volumetric sample (ZBack > Z) is cut into: fragments at the middles of equal intervals of depth,
    /// each of absorbance A/slices, so that all together hide as much as the sample. None refuses files with such
    /// samples.
    pub volume_slices: Option<NonZeroU32>,
    /// Name or number of the part that is read; the first deep one where none is given.
    pub part: Option<String>,
}

impl Default for ReadOptions {
    /// Four slices of the first deep part.
    fn default() -> Self {
        Self {
            volume_slices: NonZeroU32::new(4),
            part: None,
        }
    }
}

const MAGIC: u32 = 20_000_630;
/// Bits of the version word.
const TILED: u32 = 0x200;
const DEEP: u32 = 0x800;
const MULTI_PART: u32 = 0x1000;
/// Most columns or rows of an image.
const MAX_SIDE: i64 = 1 << 20;

/// `.exr`: deep images.
pub(super) const FORMAT: ListFormat = ListFormat {
    ending: "exr",
    read: |path, part| {
        let options = ReadOptions {
            part: part.map(str::to_owned),
            ..ReadOptions::default()
        };
        read(path, &options)
    },
    write,
};

/// Reads a deep image.
///
/// Colours are divided by alpha; samples that hide and show nothing (alpha 0 and no light) are left out and counted,
/// and those that shine without hiding get the alpha [`MIN_EMITTING_ALPHA`]. Camera planes come from the float
/// attributes `near` and `far`, where both are there and valid.
///
/// # Errors
/// [`SceneError::FileContent`] names the file and the place: truncation, damage, flat images, missing channels, depths
/// that are not finite and positive, and volumetric samples where the options refuse them.
pub fn read(path: &Path, options: &ReadOptions) -> Result<FragmentList, SceneError> {
    decode(path, &read_file(path)?, options)
}

pub use samples::MIN_EMITTING_ALPHA;

fn decode(path: &Path, data: &[u8], options: &ReadOptions) -> Result<FragmentList, SceneError> {
    let mut bytes = Bytes { path, data, at: 0 };
    let file = FileHeader::read(&mut bytes)?;
    let mut left_out = Vec::new();
    let part = select_part(&bytes, &file, options.part.as_deref(), &mut left_out)?;
    let layout = Layout::of_part(&bytes, &file, part, options, &mut left_out)?;
    let chunks = chunks::locate(&mut bytes, &file, part, &layout)?;
    let decoded: Vec<Decoded> = chunks
        .par_iter()
        .map(|chunk| layout.block(chunk))
        .collect::<Result<_, _>>()?;
    let tally = decoded
        .iter()
        .fold(Tally::default(), |sum, block| sum.plus(&block.tally));
    let place = format!("{}, {}", path.display(), file.name_of(part));
    tally.name_what_is_left_out(&place, options.volume_slices, &mut left_out);
    let header = &file.parts[part];
    let planes = planes(header, &place, &mut left_out);
    let list = assemble(&chunks, decoded, &layout).map_err(|source| SceneError::Content {
        path: path.to_owned(),
        source,
    })?;
    Ok(match planes {
        Some(planes) => list.with_planes(planes),
        None => list,
    }
    .with_left_out(left_out))
}

/// The camera's planes, where the part gives valid ones.
fn planes(header: &Header, place: &str, left_out: &mut Vec<LeftOut>) -> Option<CameraPlanes> {
    let (near, far) = header.near.zip(header.far)?;
    let planes = CameraPlanes::new(near, far);
    if planes.is_err() {
        let what = format!("the camera planes near = {near}, far = {far}");
        note(
            left_out,
            LeftOut::new(what, place, 1, "0 < near < far is expected; pass --near and --far"),
        );
    }
    planes.ok()
}

/// The part that is asked for, or the first deep one; all others are named.
fn select_part(
    bytes: &Bytes<'_>,
    file: &FileHeader,
    wanted: Option<&str>,
    left_out: &mut Vec<LeftOut>,
) -> Result<usize, SceneError> {
    let all = || {
        (0..file.parts.len())
            .map(|i| file.name_of(i))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let part = match wanted {
        Some(wanted) => {
            let named = file.parts.iter().position(|p| p.name.as_deref() == Some(wanted));
            let numbered = || wanted.parse::<usize>().ok().filter(|&n| n < file.parts.len());
            named
                .or_else(numbered)
                .ok_or_else(|| bytes.wrong("header", format!("there is no part '{wanted}'; the file has {}", all())))?
        }
        None => (0..file.parts.len()).find(|&i| file.is_deep(i)).ok_or_else(|| {
            bytes.wrong(
                "header",
                "this image is flat; a deep image (type deepscanline or deeptile) is needed",
            )
        })?,
    };
    if !file.is_deep(part) {
        let reason = format!(
            "{} is flat; a deep part is needed, and the file has {}",
            file.name_of(part),
            all()
        );
        return Err(bytes.wrong("header", reason));
    }
    if wanted.is_none() && file.parts.len() > 1 {
        let others: Vec<String> = (0..file.parts.len())
            .filter(|&i| i != part)
            .map(|i| file.name_of(i))
            .collect();
        let count = others.len() as u64;
        let remedy = format!("{} is read; --part NAME or NUMBER reads another", file.name_of(part));
        note(
            left_out,
            LeftOut::new(others.join(", "), bytes.path.display().to_string(), count, remedy),
        );
    }
    Ok(part)
}

/// Puts the blocks' fragments in the order of the image's pixels.
fn assemble(chunks: &[Chunk<'_>], decoded: Vec<Decoded>, layout: &Layout<'_>) -> Result<FragmentList, FragmentError> {
    let (width, height, colored) = (layout.width, layout.height, layout.used.color.is_some());
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
    let list =
        FragmentList::new(offsets, view_z, alpha, colored.then_some(color))?.with_size(width as u32, height as u32)?;
    let usual = [0, 0, width as i32 - 1, height as i32 - 1];
    match layout.windows {
        Windows { data, display } if data == usual && display == usual => Ok(list),
        windows => list.with_windows(windows),
    }
}

#[cfg(test)]
mod tests {
    use super::bytes::{Kind, half};
    use super::channels::{Alpha, Used};
    use super::unpack::{Packing, unpack_runs};
    use super::*;
    use crate::numeric::file::Replace;
    use proptest::prelude::*;

    fn sample_list() -> FragmentList {
        let offsets = vec![0, 2, 2, 3, 6, 6, 7];
        let n = 7;
        FragmentList::new(
            offsets,
            (0..n).map(|i| 1.0 + i as f32 / 3.0).collect(),
            (0..n).map(|i| (i + 1) as f32 / 7.0).collect(),
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

    /// Windows, light beyond 1 and light without opacity survive; what hides and shows nothing is counted.
    #[test]
    fn what_is_no_plain_fragment_is_kept_or_counted() {
        let list = FragmentList::new(
            vec![0, 2, 4],
            vec![1.0, 1e30, 2.0, 3.0],
            vec![0.5, 0.0, 1.0, 0.25],
            Some(vec![[0.5, 4.0, 0.0], [0.0; 3], [1.0; 3], [9.0; 3]]),
        )
        .unwrap()
        .with_size(1, 2)
        .unwrap()
        .with_windows(Windows {
            data: [-3, 7, -3, 8],
            display: [0, 0, 9, 9],
        })
        .unwrap();
        let back = decoded(&bytes_of(&list)).unwrap();
        assert_eq!((back.windows(), back.view_z()), (list.windows(), &[1.0, 2.0, 3.0][..]));
        assert_eq!(back.color().unwrap(), [[0.5, 4.0, 0.0], [1.0; 3], [9.0; 3]]);
        let [empty] = back.left_out() else {
            panic!("{:?}", back.left_out())
        };
        assert!(empty.count == 1 && empty.what.contains("alpha 0"), "{empty}");
        assert_eq!(back.depth_range(), Some((1.0, 3.0)));
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
            assert!(
                *alpha > 0.0 && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 2e-7),
                "{a:?} {b:?}"
            );
        }
        assert_eq!(back.left_out(), []);
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
        fn flipped_bytes_never_panic(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()),
            1..4), long in any::<bool>()) {
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
            width: 1,
            height: 1,
            windows: Windows {
                data: [0; 4],
                display: [0; 4],
            },
            block: [1, 1],
            packing: Packing::None,
            kinds: vec![Kind::Float; 3],
            used: Used {
                z: 0,
                alpha: Alpha::One(1),
                color: None,
                z_back: Some(2),
            },
            slices: NonZeroU32::new(slices),
        };
        let value = |channel: usize, _: usize| [2.0, 0.7, 4.0][channel];
        let mut out = Decoded::default();
        layout(4).sample(&value, 0, &mut out).unwrap();
        assert_eq!(out.view_z, [2.25, 2.75, 3.25, 3.75]);
        let through: f64 = out.alpha.iter().map(|&a| 1.0 - f64::from(a)).product();
        assert!((through - 0.3).abs() < 1e-6, "{through}");
        assert!(layout(0).sample(&value, 0, &mut out).unwrap_err().contains("volume"));
    }

    /// Files that OpenEXR's own library wrote (see `make.py` beside them): every packing, scanlines and tiles that are
    /// cut off at the edges.
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
