//! Textures: images that give the colour and the opacity of a surface.

use super::SceneError;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Most columns or rows of a texture.
const MAX_SIDE: u32 = 1 << 14;

/// First bytes of a PNG file (its specification, section 5.2).
const PNG_MAGIC: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// First bytes of a JPEG file: the marker of its start, and the first byte of another marker (ITU-T T.81, B.1.1).
const JPEG_MAGIC: [u8; 3] = [0xff, 0xd8, 0xff];

/// Texels of eight bits a channel: colour in the sRGB curve, alpha linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    rgba: Vec<[u8; 4]>,
}

/// What becomes of coordinates outside [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image again, every second time in the mirror.
    Mirror,
    /// The texel at the edge.
    Clamp,
}

/// Where a texture's scalar comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Mean of the colours, linear in their stored values, weighted as luminance is.
    Luminance,
    /// One of r, g, b, a.
    One(usize),
}

/// An image and how it is looked up.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// The texels.
    pub image: Arc<Image>,
    /// Along u and v.
    pub wrap: [Wrap; 2],
    /// The nearest texel instead of a mixture of four.
    pub nearest: bool,
    /// Rows of the 2 x 3 matrix that is applied to (u, v, 1) first.
    pub transform: [[f32; 3]; 2],
}

/// What textures make of a surface's own colour and opacity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TexturedMaterial {
    /// Multiplies the colour where `color_counts` holds, and its alpha the opacity where `alpha_counts` does.
    pub color: Option<Texture>,
    /// Whether the colours of `color` count.
    pub color_counts: bool,
    /// Whether the alpha of `color` counts.
    pub alpha_counts: bool,
    /// Multiplies the opacity.
    pub opacity: Option<(Texture, Channel)>,
    /// Alpha below the first leaves no fragment, and from there on one of the second.
    pub cutoff: Option<(f32, f32)>,
}

/// The matrix that changes no coordinates.
pub const UNMOVED: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

impl Image {
    /// Decodes a PNG or JPEG file's bytes; `place` is where it is said to be wrong.
    ///
    /// # Errors
    /// [`SceneError::FileContent`] for another kind of image, damage, and a size that the bytes cannot hold.
    pub fn decode(path: &Path, place: &str, bytes: &[u8]) -> Result<Self, SceneError> {
        let wrong = |reason: String| SceneError::file_content(path, place, reason);
        let mut source = Source::open(bytes).map_err(|e| {
            wrong(format!(
                "the image is not readable ({e}); textures are PNG or JPEG files"
            ))
        })?;
        let (width, height) = source.size();
        // Deflate's best is about a thousand to one; JPEG's flat blocks reach less.
        let plausible = 16 * 1024 * 1024 + 1032 * bytes.len() as u64;
        let texels = u64::from(width) * u64::from(height);
        if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE || 4 * texels > plausible {
            let reason = format!(
                "an image of {width} x {height} texels in {} bytes; at most {MAX_SIDE} a side are supported",
                bytes.len()
            );
            return Err(wrong(reason));
        }
        let rgba = source
            .texels()
            .map_err(|e| wrong(format!("the image is damaged ({e})")))?;
        if rgba.len() as u64 != texels {
            return Err(wrong(format!(
                "the image is damaged (it holds {} of {texels} texels)",
                rgba.len()
            )));
        }
        Ok(Self { width, height, rgba })
    }

    /// Whether any texel is less than opaque.
    pub fn has_alpha(&self) -> bool {
        self.rgba.iter().any(|t| t[3] < 255)
    }

    /// A texel with linear colour.
    fn texel(&self, x: u32, y: u32) -> [f32; 4] {
        let [r, g, b, a] = self.rgba[y as usize * self.width as usize + x as usize];
        let linear = linear_of_srgb();
        [
            linear[usize::from(r)],
            linear[usize::from(g)],
            linear[usize::from(b)],
            f32::from(a) / 255.0,
        ]
    }

    /// A texel as it is stored, in [0, 1].
    fn stored(&self, x: u32, y: u32) -> [f32; 4] {
        self.rgba[y as usize * self.width as usize + x as usize].map(|v| f32::from(v) / 255.0)
    }
}

/// An image file whose header was read.
enum Source<'a> {
    Png(Box<png::Reader<Cursor<&'a [u8]>>>),
    Jpeg(Box<JpegDecoder<ZCursor<&'a [u8]>>>, u32, u32),
}

impl<'a> Source<'a> {
    /// Reads the header of a PNG or JPEG file, told apart by their first bytes.
    fn open(bytes: &'a [u8]) -> Result<Self, String> {
        if bytes.starts_with(&PNG_MAGIC) {
            let mut decoder = png::Decoder::new(Cursor::new(bytes));
            decoder.set_ignore_text_chunk(true);
            decoder.set_ignore_iccp_chunk(true);
            // Palettes, bits below eight a channel and transparent colours become channels of eight bits.
            decoder.set_transformations(png::Transformations::EXPAND);
            return decoder
                .read_info()
                .map(|r| Self::Png(Box::new(r)))
                .map_err(|e| e.to_string());
        }
        if bytes.starts_with(&JPEG_MAGIC) {
            // Greater sizes than these cannot be written; what is supported is the caller's to say.
            let side = usize::from(u16::MAX);
            let options = DecoderOptions::default()
                .set_strict_mode(false)
                .set_max_width(side)
                .set_max_height(side);
            let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
            decoder.decode_headers().map_err(|e| e.to_string())?;
            let (width, height) = decoder.dimensions().ok_or("it has no size")?;
            let grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
            let colors = if grey { ColorSpace::Luma } else { ColorSpace::RGB };
            decoder.set_options(options.jpeg_set_out_colorspace(colors));
            return Ok(Self::Jpeg(Box::new(decoder), width as u32, height as u32));
        }
        Err("it is of another kind".to_owned())
    }

    /// Columns and rows.
    fn size(&self) -> (u32, u32) {
        match self {
            Self::Png(reader) => (reader.info().width, reader.info().height),
            Self::Jpeg(_, width, height) => (*width, *height),
        }
    }

    /// Decodes the image.
    fn texels(&mut self) -> Result<Vec<[u8; 4]>, String> {
        match self {
            Self::Png(reader) => {
                let mut bytes = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
                let info = reader.next_frame(&mut bytes).map_err(|e| e.to_string())?;
                bytes.truncate(info.buffer_size());
                if info.bit_depth == png::BitDepth::Sixteen {
                    // The nearest of the 256 values; 65535 is 257 times 255.
                    let nearest = |pair: &[u8; 2]| ((u32::from(u16::from_be_bytes(*pair)) + 128) / 257) as u8;
                    bytes = bytes.as_chunks().0.iter().map(nearest).collect();
                }
                Ok(rgba(&bytes, info.color_type.samples()))
            }
            Self::Jpeg(decoder, ..) => {
                let bytes = decoder.decode().map_err(|e| e.to_string())?;
                let channels = decoder.output_colorspace().map_or(3, |c| c.num_components());
                Ok(rgba(&bytes, channels))
            }
        }
    }
}

/// Texels of bytes with so many channels: grey, grey and alpha, colour, colour and alpha.
fn rgba(bytes: &[u8], channels: usize) -> Vec<[u8; 4]> {
    let texel = |c: &[u8]| match *c {
        [grey] => [grey, grey, grey, 255],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, 255],
        _ => [c[0], c[1], c[2], c[3]],
    };
    bytes.chunks_exact(channels).map(texel).collect()
}

/// The sRGB curve's inverse at the 256 values of a byte.
///
/// # Source
/// IEC 61966-2-1.
fn linear_of_srgb() -> &'static [f32; 256] {
    static TABLE: OnceLock<[f32; 256]> = OnceLock::new();
    TABLE.get_or_init(|| {
        std::array::from_fn(|i| {
            let s = i as f64 / 255.0;
            let linear = if s <= 0.040_45 {
                s / 12.92
            } else {
                libm::pow((s + 0.055) / 1.055, 2.4)
            };
            linear as f32
        })
    })
}

impl Wrap {
    /// The texel for a place of any size.
    fn texel(self, i: i64, n: u32) -> u32 {
        let n = i64::from(n);
        let i = match self {
            Self::Clamp => i.clamp(0, n - 1),
            Self::Repeat => i.rem_euclid(n),
            Self::Mirror => match i.rem_euclid(2 * n) {
                i if i < n => i,
                i => 2 * n - 1 - i,
            },
        };
        i as u32
    }
}

impl Texture {
    /// A texture that repeats and mixes four texels.
    pub fn new(image: Arc<Image>) -> Self {
        Self {
            image,
            wrap: [Wrap::Repeat; 2],
            nearest: false,
            transform: UNMOVED,
        }
    }

    /// Mixture of texels around a coordinate, of whatever `of` makes of a texel.
    fn look_up(&self, uv: [f32; 2], of: impl Fn(u32, u32) -> [f32; 4]) -> [f32; 4] {
        let [u, v] = self.transform.map(|row| row[0] * uv[0] + row[1] * uv[1] + row[2]);
        let place = |c: f32, n: u32| {
            // Coordinates without bound lose their place; whole turns of the image may be dropped.
            let c = if c.is_finite() {
                f64::from(c).clamp(-1e6, 1e6)
            } else {
                0.0
            };
            c * f64::from(n)
        };
        let (x, y) = (place(u, self.image.width), place(v, self.image.height));
        let at = |x: i64, y: i64| {
            of(
                self.wrap[0].texel(x, self.image.width),
                self.wrap[1].texel(y, self.image.height),
            )
        };
        if self.nearest {
            return at(x.floor() as i64, y.floor() as i64);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (s, t) = ((x - x0) as f32, (y - y0) as f32);
        let (x0, y0) = (x0 as i64, y0 as i64);
        let [a, b, c, d] = [at(x0, y0), at(x0 + 1, y0), at(x0, y0 + 1), at(x0 + 1, y0 + 1)];
        std::array::from_fn(|k| {
            let (top, bottom) = (a[k] + s * (b[k] - a[k]), c[k] + s * (d[k] - c[k]));
            top + t * (bottom - top)
        })
    }

    /// Linear colour and alpha at a coordinate.
    pub fn sample(&self, uv: [f32; 2]) -> [f32; 4] {
        self.look_up(uv, |x, y| self.image.texel(x, y))
    }

    /// One scalar at a coordinate, linear in what is stored.
    pub fn scalar(&self, uv: [f32; 2], channel: Channel) -> f32 {
        let [r, g, b, a] = self.look_up(uv, |x, y| self.image.stored(x, y));
        match channel {
            Channel::Luminance => 0.2126 * r + 0.7152 * g + 0.0722 * b,
            Channel::One(k) => [r, g, b, a][k.min(3)],
        }
    }
}

impl TexturedMaterial {
    /// Colour and alpha of a fragment; none where it is not there at all.
    pub fn shade(&self, mut rgba: [f32; 4], uv: [f32; 2]) -> Option<[f32; 4]> {
        if let Some(texture) = &self.color {
            let texel = texture.sample(uv);
            if self.color_counts {
                (0..3).for_each(|k| rgba[k] *= texel[k]);
            }
            if self.alpha_counts {
                rgba[3] *= texel[3];
            }
        }
        if let Some((texture, channel)) = &self.opacity {
            rgba[3] *= texture.scalar(uv, *channel);
        }
        rgba[3] = match self.cutoff {
            Some((cutoff, alpha)) if rgba[3] >= cutoff => alpha,
            Some(_) => 0.0,
            None => rgba[3].clamp(0.0, 1.0),
        };
        (rgba[3] > 0.0).then_some(rgba)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, rgba: &[[u8; 4]]) -> Arc<Image> {
        Arc::new(Image {
            width,
            height: rgba.len() as u32 / width,
            rgba: rgba.to_vec(),
        })
    }

    /// PNG's kinds, each as it is stored: grey of 1 and 16 bits, a palette with opacities, grey with alpha, and 16 bits
    /// a channel, of which the nearest eight remain.
    #[test]
    fn kinds_of_png() {
        use png::{BitDepth, ColorType};
        let png = |color: ColorType, depth: BitDepth, data: &[u8]| {
            let mut out = Vec::new();
            let mut encoder = png::Encoder::new(&mut out, 2, 1);
            encoder.set_color(color);
            encoder.set_depth(depth);
            if color == ColorType::Indexed {
                encoder.set_palette(&[1u8, 2, 3, 4, 5, 6][..]);
                encoder.set_trns(&[7u8][..]);
            }
            encoder.write_header().unwrap().write_image_data(data).unwrap();
            out
        };
        let decoded = |bytes: &[u8]| Image::decode(Path::new("a.png"), "", bytes).map(|image| image.rgba);
        for (color, depth, data, texels) in [
            (
                ColorType::Grayscale,
                BitDepth::One,
                &[0x40][..],
                [[0, 0, 0, 255], [255; 4]],
            ),
            (
                ColorType::Grayscale,
                BitDepth::Sixteen,
                &[0x7f, 0xff, 0xff, 0x7f],
                [[127, 127, 127, 255], [255; 4]],
            ),
            (
                ColorType::Indexed,
                BitDepth::Eight,
                &[0, 1],
                [[1, 2, 3, 7], [4, 5, 6, 255]],
            ),
            (
                ColorType::GrayscaleAlpha,
                BitDepth::Eight,
                &[9, 8, 7, 6],
                [[9, 9, 9, 8], [7, 7, 7, 6]],
            ),
            (
                ColorType::Rgb,
                BitDepth::Eight,
                &[1, 2, 3, 4, 5, 6],
                [[1, 2, 3, 255], [4, 5, 6, 255]],
            ),
            (
                ColorType::Rgba,
                BitDepth::Sixteen,
                &[0, 128, 0, 129, 1, 1, 255, 255, 0, 0, 1, 0, 1, 129, 1, 130],
                [[0, 1, 1, 255], [0, 1, 1, 2]],
            ),
        ] {
            assert_eq!(
                decoded(&png(color, depth, data)).unwrap(),
                texels,
                "{color:?} {depth:?}"
            );
        }
        let whole = png(ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]);
        for length in 0..whole.len() - 12 {
            let error = decoded(&whole[..length]).unwrap_err().to_string();
            assert!(
                error.contains("not readable") || error.contains("damaged"),
                "{length}: {error}"
            );
        }
        assert!(
            decoded(b"GIF89a")
                .unwrap_err()
                .to_string()
                .contains("textures are PNG or JPEG")
        );
    }

    #[test]
    fn texels_are_mixed_between_their_centres() {
        let mut texture = Texture::new(image(2, &[[0, 0, 0, 0], [255, 255, 255, 255]]));
        let alpha = |t: &Texture, u: f32| t.sample([u, 0.5])[3];
        assert_eq!([0.25, 0.5, 0.75, 1.0].map(|u| alpha(&texture, u)), [0.0, 0.5, 1.0, 0.5]);
        texture.wrap = [Wrap::Clamp; 2];
        assert_eq!([-3.0, 1.0, 7.0].map(|u| alpha(&texture, u)), [0.0, 1.0, 1.0]);
        texture.wrap = [Wrap::Mirror; 2];
        assert_eq!(
            [1.25, 1.75, -0.25, f32::NAN].map(|u| alpha(&texture, u)),
            [1.0, 0.0, 0.0, 0.0]
        );
        texture.nearest = true;
        assert_eq!([0.49, 0.51].map(|u| alpha(&texture, u)), [0.0, 1.0]);
        texture.transform = [[1.0, 0.0, 0.5], [0.0, 1.0, 0.0]];
        assert_eq!([0.01, 0.51].map(|u| alpha(&texture, u)), [1.0, 1.0]);
    }

    /// Reference: the curve's value at 188/255 is 0.5029 (IEC 61966-2-1).
    #[test]
    fn colours_are_linear_and_opacities_are_not_touched() {
        let texture = Texture::new(image(1, &[[188, 0, 255, 188]]));
        let [r, g, b, a] = texture.sample([0.5, 0.5]);
        assert!((r - 0.5029).abs() < 1e-4 && g == 0.0 && b == 1.0, "{r} {g} {b}");
        assert!((a - 188.0 / 255.0).abs() < 1e-6);
        assert!((texture.scalar([0.5, 0.5], Channel::One(0)) - 188.0 / 255.0).abs() < 1e-6);
    }

    #[test]
    fn a_cutoff_keeps_or_drops() {
        let material = |cutoff| TexturedMaterial {
            color: Some(Texture::new(image(1, &[[255, 255, 255, 100]]))),
            alpha_counts: true,
            cutoff,
            ..TexturedMaterial::default()
        };
        let alpha = |cutoff| material(cutoff).shade([1.0; 4], [0.5; 2]).map(|c| c[3]);
        let cases = [None, Some((0.3, 1.0)), Some((0.3, 0.5)), Some((0.5, 1.0))];
        assert_eq!(cases.map(alpha), [Some(100.0 / 255.0), Some(1.0), Some(0.5), None]);
    }
}
