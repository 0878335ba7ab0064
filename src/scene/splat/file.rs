//! Files of Gaussian splats: `.splat`, `.ply` of the INRIA program and its descendants, and `.spz`.
//!
//! Records are read one after the other, so that memory is that of the splats and not that of the file. Colours are
//! those of spherical harmonics of degree 0, as they stand: splats are trained and composited on display values, and so
//! they are here. Higher degrees are named as left out.

use super::Splat;
use crate::numeric::file::FileError;
use crate::pixel::left_out::{LeftOut, note};
use crate::scene::SceneError;
use flate2::read::MultiGzDecoder;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// Endings of the files that are read.
pub const ENDINGS: [&str; 3] = ["splat", "ply", "spz"];

/// Most splats of a file.
pub const MAX_SPLATS: u64 = 1 << 26;

/// The value of the constant harmonic, 1/(2 √π).
const HARMONIC_0: f64 = 0.282_094_791_773_878_14;

/// Splats of a file, and what of it they do not hold.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Splats {
    /// In the order of the file.
    pub splats: Vec<Splat>,
    /// Higher harmonics, splats that are none, and what else is not used.
    pub left_out: Vec<LeftOut>,
}

/// Reads a file of splats, by the ending of its name.
///
/// # Errors
/// [`SceneError`] names the file and the place in it: truncation, damage, properties that splats need and the file
/// lacks.
pub fn read(path: &Path) -> Result<Splats, SceneError> {
    let ending = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let file = File::open(path).map_err(FileError::io(path, "cannot read"))?;
    let mut reader = Reader {
        path,
        data: BufReader::with_capacity(1 << 18, file),
        at: 0,
    };
    match ending.as_str() {
        "splat" => splat(&mut reader),
        "ply" => ply(&mut reader),
        "spz" => {
            let inner = Reader {
                path,
                data: BufReader::with_capacity(1 << 18, MultiGzDecoder::new(reader.data)),
                at: 0,
            };
            spz(inner)
        }
        _ => Err(reader.wrong("name", "expected a name that ends in .splat, .ply or .spz")),
    }
}

/// Bytes with a place, so that an error can say where.
struct Reader<'a, R> {
    path: &'a Path,
    data: R,
    at: u64,
}

impl<R: BufRead> Reader<'_, R> {
    fn wrong(&self, place: &str, reason: impl Into<String>) -> SceneError {
        SceneError::file_content(self.path, place, reason)
    }

    fn failed(&self, error: &std::io::Error) -> SceneError {
        let reason = match error.kind() {
            std::io::ErrorKind::UnexpectedEof => "the file ends early; it is truncated or damaged".to_owned(),
            _ => format!("cannot be read: {error}"),
        };
        self.wrong(&format!("byte {}", self.at), reason)
    }

    fn fill(&mut self, out: &mut [u8]) -> Result<(), SceneError> {
        self.data.read_exact(out).map_err(|e| self.failed(&e))?;
        self.at += out.len() as u64;
        Ok(())
    }

    /// `n` bytes, taken piece by piece, so that a length that lies takes no memory.
    fn bytes(&mut self, n: u64) -> Result<Vec<u8>, SceneError> {
        let mut out = Vec::new();
        let read = (&mut self.data).take(n).read_to_end(&mut out);
        match read {
            Ok(read) if read as u64 == n => {
                self.at += n;
                Ok(out)
            }
            Ok(read) => {
                self.at += read as u64;
                Err(self.failed(&std::io::ErrorKind::UnexpectedEof.into()))
            }
            Err(error) => Err(self.failed(&error)),
        }
    }

    /// Whether nothing follows.
    fn ended(&mut self) -> Result<bool, SceneError> {
        let rest = self.data.fill_buf().map(<[u8]>::is_empty);
        rest.map_err(|e| self.failed(&e))
    }

    /// A line without its end, of at most 4096 bytes; none at the end of the file.
    fn line(&mut self) -> Result<Option<String>, SceneError> {
        let mut line = Vec::new();
        let read = (&mut self.data).take(4096).read_until(b'\n', &mut line);
        let read = read.map_err(|e| self.failed(&e))?;
        self.at += read as u64;
        if read == 4096 {
            return Err(self.wrong(
                &format!("byte {}", self.at),
                "a line of more than 4096 bytes; this is no PLY header",
            ));
        }
        let line = String::from_utf8_lossy(&line).trim_end_matches(['\n', '\r']).to_owned();
        Ok((read > 0).then_some(line))
    }
}

/// Splats as they are collected, and what is not one.
struct Collected<'a> {
    path: &'a Path,
    splats: Vec<Splat>,
    not_finite: u64,
    not_turned: u64,
}

impl<'a> Collected<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            splats: Vec::new(),
            not_finite: 0,
            not_turned: 0,
        }
    }

    /// Takes a splat with a quaternion of any length.
    fn push(
        &mut self,
        position: [f64; 3],
        scale: [f64; 3],
        rotation: [f64; 4],
        rgba: [f64; 4],
    ) -> Result<(), SceneError> {
        /// Beyond this, f64 does not tell a pixel from its neighbour.
        const FARTHEST: f64 = 1e15;
        let finite = position.iter().chain(&scale).all(|x| x.abs() <= FARTHEST)
            && rotation.iter().all(|x| x.abs() <= FARTHEST)
            && rgba.iter().all(|x| x.abs() <= FARTHEST);
        if !finite {
            self.not_finite += 1;
            return Ok(());
        }
        let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            self.not_turned += 1;
            return Ok(());
        }
        if self.splats.len() as u64 >= MAX_SPLATS {
            let reason = format!("more than the {MAX_SPLATS} splats that are supported");
            return Err(SceneError::file_content(self.path, "splats", reason));
        }
        let [r, g, b, a] = rgba;
        self.splats.push(Splat {
            position: position.map(|x| x as f32),
            scale: scale.map(|x| x as f32),
            rotation: rotation.map(|x| (x / length) as f32),
            rgba: [
                r.max(0.0) as f32,
                g.max(0.0) as f32,
                b.max(0.0) as f32,
                a.clamp(0.0, 1.0) as f32,
            ],
        });
        Ok(())
    }

    fn done(self, mut left_out: Vec<LeftOut>) -> Splats {
        let place = self.path.display().to_string();
        for (what, count) in [
            (
                "splats with numbers that are not finite or exceed 1e15",
                self.not_finite,
            ),
            ("splats whose rotation is the quaternion 0", self.not_turned),
        ] {
            note(
                &mut left_out,
                LeftOut::new(what, &place, count, "repair or remove them where they were to be seen"),
            );
        }
        Splats {
            splats: self.splats,
            left_out,
        }
    }
}

/// Records of 32 bytes: position and scale in six f32, colour and opacity in four bytes, the quaternion w, x, y, z in
/// four more.
fn splat(reader: &mut Reader<'_, impl BufRead>) -> Result<Splats, SceneError> {
    let mut out = Collected::new(reader.path);
    let mut record = [0u8; 32];
    while !reader.ended()? {
        reader.fill(&mut record)?;
        let f = |k: usize| {
            f64::from(f32::from_le_bytes([
                record[k],
                record[k + 1],
                record[k + 2],
                record[k + 3],
            ]))
        };
        out.push(
            [f(0), f(4), f(8)],
            [f(12), f(16), f(20)],
            [28, 29, 30, 31].map(|k| (f64::from(record[k]) - 128.0) / 128.0),
            [24, 25, 26, 27].map(|k| f64::from(record[k]) / 255.0),
        )?;
    }
    Ok(out.done(Vec::new()))
}

/// A number type of PLY.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The value of little-endian bytes.
    fn value(self, b: [u8; 8]) -> f64 {
        match self {
            Self::I8 => f64::from(b[0] as i8),
            Self::U8 => f64::from(b[0]),
            Self::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Self::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Self::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F64 => f64::from_le_bytes(b),
        }
    }
}

/// How the numbers of a PLY file are written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// What a PLY header says of its splats.
struct PlyHeader {
    encoding: Encoding,
    count: u64,
    properties: Vec<(String, Scalar)>,
    /// Elements after the vertices, with their numbers.
    others: Vec<(String, u64)>,
}

fn ply_header(reader: &mut Reader<'_, impl BufRead>) -> Result<PlyHeader, SceneError> {
    const MAX_PROPERTIES: usize = 1024;
    let first = reader.line()?.unwrap_or_default();
    if first.trim() != "ply" {
        return Err(reader.wrong("line 1", "this is no PLY file"));
    }
    let (mut encoding, mut count, mut properties, mut others) = (None, None, Vec::new(), Vec::new());
    for number in 2.. {
        let place = format!("line {number}");
        let Some(line) = reader.line()? else {
            return Err(reader.wrong(&place, "the header does not end; the file is truncated"));
        };
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let whole = |text: &str| {
            let reason = format!("'{text}' is no number of elements");
            text.parse::<u64>().map_err(|_| reader.wrong(&place, reason))
        };
        match words[..] {
            ["format", name, _] => {
                encoding = Some(match name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err(reader.wrong(&place, format!("'{name}' is no format of PLY"))),
                });
            }
            ["element", "vertex", n] if count.is_none() && others.is_empty() => count = Some(whole(n)?),
            ["element", "chunk", _] => {
                let reason = "a PLY file with compressed splats; they are not supported: export it as .splat, .spz or \
                    plain .ply";
                return Err(reader.wrong(&place, reason));
            }
            ["element", name, n] if count.is_some() => others.push((name.to_owned(), whole(n)?)),
            ["element", name, _] => {
                let reason =
                    format!("element '{name}' before the vertices; splats are the element 'vertex', which comes first");
                return Err(reader.wrong(&place, reason));
            }
            ["property", kind, name] if others.is_empty() => {
                let Some(kind) = Scalar::named(kind) else {
                    return Err(reader.wrong(&place, format!("'{kind}' is no number type of PLY")));
                };
                if properties.len() >= MAX_PROPERTIES || properties.iter().any(|(n, _)| n == name) {
                    return Err(reader.wrong(
                        &place,
                        format!("property '{name}' is there twice, or one of more than {MAX_PROPERTIES}"),
                    ));
                }
                properties.push((name.to_owned(), kind));
            }
            ["property", "list", ..] if others.is_empty() => {
                return Err(reader.wrong(&place, "a list in a vertex; splats have single numbers only"));
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| reader.wrong(&place, "the header names no format"))?;
                let count =
                    count.ok_or_else(|| reader.wrong(&place, "there is no element 'vertex', which splats are"))?;
                return Ok(PlyHeader {
                    encoding,
                    count,
                    properties,
                    others,
                });
            }
            _ => {}
        }
    }
    unreachable!("lines end before numbers do")
}

/// Where the numbers of a splat stand among the properties.
struct Places {
    position: [usize; 3],
    color: [usize; 3],
    opacity: usize,
    scale: [Option<usize>; 3],
    rotation: [usize; 4],
}

/// The places that splats need, and what else there is.
fn ply_places(
    reader: &Reader<'_, impl BufRead>,
    header: &PlyHeader,
    left_out: &mut Vec<LeftOut>,
) -> Result<Places, SceneError> {
    let place = |name: &str| header.properties.iter().position(|(n, _)| n == name);
    let needed = |name: &str| {
        place(name).ok_or_else(|| {
            let names: Vec<&str> = header.properties.iter().map(|(n, _)| n.as_str()).take(12).collect();
            let reason = format!(
                "there is no property '{name}', which splats have (x y z f_dc_0.. opacity scale_0.. rot_0..); the file \
                    has {}; \
                 a mesh or a point cloud is read as .obj, .gltf or .glb",
                names.join(" ")
            );
            reader.wrong("header", reason)
        })
    };
    let places = Places {
        position: [needed("x")?, needed("y")?, needed("z")?],
        color: [needed("f_dc_0")?, needed("f_dc_1")?, needed("f_dc_2")?],
        opacity: needed("opacity")?,
        // Flat splats have two.
        scale: [Some(needed("scale_0")?), Some(needed("scale_1")?), place("scale_2")],
        rotation: [needed("rot_0")?, needed("rot_1")?, needed("rot_2")?, needed("rot_3")?],
    };
    let known = ["nx", "ny", "nz", "x", "y", "z", "opacity"];
    let file = reader.path.display().to_string();
    let (mut harmonics, mut unknown) = (0, Vec::new());
    for (name, _) in &header.properties {
        if name.starts_with("f_rest_") {
            harmonics += 1;
        } else if !known.contains(&name.as_str()) && !["f_dc_", "scale_", "rot_"].iter().any(|p| name.starts_with(p)) {
            unknown.push(name.as_str());
        }
    }
    if harmonics > 0 {
        let what = format!("spherical harmonics above degree 0 ({harmonics} coefficients a splat)");
        note(
            left_out,
            LeftOut::new(
                what,
                &file,
                header.count,
                "colours do not depend on the direction of view",
            ),
        );
    }
    if !unknown.is_empty() {
        let what = format!("properties {} of splats", unknown.join(", "));
        note(
            left_out,
            LeftOut::new(what, &file, header.count, "nothing here depends on them"),
        );
    }
    for (name, count) in &header.others {
        let what = format!("elements '{name}'");
        note(
            left_out,
            LeftOut::new(what, &file, *count, "splats are the element 'vertex' alone"),
        );
    }
    Ok(places)
}

fn ply(reader: &mut Reader<'_, impl BufRead>) -> Result<Splats, SceneError> {
    let header = ply_header(reader)?;
    let mut left_out = Vec::new();
    let places = ply_places(reader, &header, &mut left_out)?;
    let mut out = Collected::new(reader.path);
    let size: usize = header.properties.iter().map(|(_, kind)| kind.size()).sum();
    let (mut record, mut values) = (vec![0u8; size], vec![0.0; header.properties.len()]);
    for i in 0..header.count {
        match header.encoding {
            Encoding::Ascii => ascii(reader, i, &mut values)?,
            Encoding::Little | Encoding::Big => {
                reader.fill(&mut record)?;
                let mut rest = record.as_slice();
                for (value, (_, kind)) in values.iter_mut().zip(&header.properties) {
                    let (own, others) = rest.split_at(kind.size());
                    rest = others;
                    let mut bytes = [0; 8];
                    bytes[..own.len()].copy_from_slice(own);
                    if header.encoding == Encoding::Big {
                        bytes[..own.len()].reverse();
                    }
                    *value = kind.value(bytes);
                }
            }
        }
        out.push(
            places.position.map(|k| values[k]),
            places.scale.map(|k| k.map_or(0.0, |k| libm::exp(values[k]))),
            places.rotation.map(|k| values[k]),
            [
                0.5 + HARMONIC_0 * values[places.color[0]],
                0.5 + HARMONIC_0 * values[places.color[1]],
                0.5 + HARMONIC_0 * values[places.color[2]],
                1.0 / (1.0 + libm::exp(-values[places.opacity])),
            ],
        )?;
    }
    if header.others.is_empty() && header.encoding != Encoding::Ascii && !reader.ended()? {
        let reason = format!(
            "bytes follow the {} splats of the header; the file is damaged",
            header.count
        );
        return Err(reader.wrong(&format!("byte {}", reader.at), reason));
    }
    Ok(out.done(left_out))
}

/// The numbers of a line.
fn ascii(reader: &mut Reader<'_, impl BufRead>, splat: u64, values: &mut [f64]) -> Result<(), SceneError> {
    let place = format!("splat {splat}");
    let Some(line) = reader.line()? else {
        return Err(reader.wrong(&place, "the file ends early; it is truncated"));
    };
    let mut words = line.split_ascii_whitespace();
    for value in values.iter_mut() {
        let word = words.next();
        *value = word.and_then(|w| w.parse().ok()).ok_or_else(|| {
            reader.wrong(
                &place,
                format!("'{}' where a number is expected", word.unwrap_or("nothing")),
            )
        })?;
    }
    Ok(())
}

/// The gzip-compressed format of Niantic, versions 2 and 3: attributes one after the other, quantised.
fn spz(mut reader: Reader<'_, impl BufRead>) -> Result<Splats, SceneError> {
    /// "NGSP".
    const MAGIC: [u8; 4] = [0x4e, 0x47, 0x53, 0x50];
    let mut head = [0u8; 16];
    reader.fill(&mut head)?;
    if head[..4] != MAGIC {
        return Err(reader.wrong("byte 0", "this is no SPZ file"));
    }
    let word = |k: usize| u32::from_le_bytes([head[k], head[k + 1], head[k + 2], head[k + 3]]);
    let (version, count) = (word(4), u64::from(word(8)));
    let (degree, fraction, flags) = (head[12], head[13], head[14]);
    if !(2..=3).contains(&version) {
        let reason =
            format!("version {version} of SPZ is not supported: export it as .splat, .ply or SPZ of version 2 or 3");
        return Err(reader.wrong("byte 4", reason));
    }
    if count > MAX_SPLATS || degree > 3 || fraction > 23 {
        let reason =
            format!("{count} splats, harmonics of degree {degree}, {fraction} bits of fraction; the file is damaged");
        return Err(reader.wrong("byte 8", reason));
    }
    let turn = if version == 2 { 3 } else { 4 };
    let positions = reader.bytes(count * 9)?;
    let alphas = reader.bytes(count)?;
    let colors = reader.bytes(count * 3)?;
    let scales = reader.bytes(count * 3)?;
    let rotations = reader.bytes(count * turn)?;
    let harmonics = [0, 3, 8, 15][usize::from(degree)];
    std::io::copy(
        &mut (&mut reader.data).take(count * harmonics * 3),
        &mut std::io::sink(),
    )
    .map_err(|e| reader.failed(&e))?;
    let mut out = Collected::new(reader.path);
    let step = libm::ldexp(1.0, -i32::from(fraction));
    for (i, &alpha) in alphas.iter().enumerate() {
        let fixed = |k: usize| {
            let b = &positions[i * 9 + k * 3..];
            f64::from(i32::from_le_bytes([0, b[0], b[1], b[2]]) >> 8) * step
        };
        let byte = |bytes: &[u8], k: usize| f64::from(bytes[i * 3 + k]);
        let color = |k: usize| 0.5 + HARMONIC_0 * (byte(&colors, k) / 255.0 - 0.5) / 0.15;
        let rotation = match version {
            2 => {
                let v = [0, 1, 2].map(|k| byte(&rotations, k) / 127.5 - 1.0);
                let w = (1.0 - v.iter().map(|x| x * x).sum::<f64>()).max(0.0).sqrt();
                [w, v[0], v[1], v[2]]
            }
            _ => smallest_three(u32::from_le_bytes([
                rotations[i * 4],
                rotations[i * 4 + 1],
                rotations[i * 4 + 2],
                rotations[i * 4 + 3],
            ])),
        };
        out.push(
            [0, 1, 2].map(fixed),
            [0, 1, 2].map(|k| libm::exp(byte(&scales, k) / 16.0 - 10.0)),
            rotation,
            [color(0), color(1), color(2), f64::from(alpha) / 255.0],
        )?;
    }
    let file = reader.path.display().to_string();
    Ok(out.done(left_out_of_spz(&file, count, harmonics * 3, flags & 1 != 0)))
}

/// What of an SPZ file is left out: harmonics, so many coefficients a splat, and the flag of antialiased training.
fn left_out_of_spz(file: &str, count: u64, coefficients: u64, antialiased: bool) -> Vec<LeftOut> {
    let mut left_out = Vec::new();
    if coefficients > 0 {
        let what = format!("spherical harmonics above degree 0 ({coefficients} coefficients a splat)");
        note(
            &mut left_out,
            LeftOut::new(what, file, count, "colours do not depend on the direction of view"),
        );
    }
    if antialiased {
        let remedy = "the pixel's extent is added without making the splat fainter; train without antialiasing for the \
            same picture";
        note(
            &mut left_out,
            LeftOut::new("the flag 'trained with antialiasing'", file, 1, remedy),
        );
    }
    left_out
}

/// A quaternion w, x, y, z from its three smallest parts in nine bits and a sign each; the two highest bits name the
/// largest of x, y, z, w.
fn smallest_three(mut bits: u32) -> [f64; 4] {
    let largest = (bits >> 30) as usize;
    let mut xyzw = [0.0; 4];
    let mut squares = 0.0;
    for k in (0..4).rev().filter(|&k| k != largest) {
        let size = f64::from(bits & 511) / 511.0 * std::f64::consts::FRAC_1_SQRT_2;
        xyzw[k] = if bits >> 9 & 1 == 1 { -size } else { size };
        squares += size * size;
        bits >>= 10;
    }
    xyzw[largest] = (1.0 - squares).max(0.0).sqrt();
    [xyzw[3], xyzw[0], xyzw[1], xyzw[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest part comes back from the others, whichever it is.
    #[test]
    fn quaternions_of_three_parts_have_length_one() {
        for bits in [0u32, 0x4000_0000, 0x9234_5678, 0xc00f_f3ff, 0x8000_01ff] {
            let q = smallest_three(bits);
            let length: f64 = q.iter().map(|x| x * x).sum();
            assert!(length >= 1.0 - 1e-12, "{bits:x}: {q:?}");
        }
        assert_eq!(smallest_three(0xc000_0000), [1.0, 0.0, 0.0, 0.0]);
    }
}
