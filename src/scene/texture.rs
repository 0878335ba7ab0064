//! Textures: images that give the colour and the opacity of a surface.

use super::SceneError;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Most columns or rows of a texture.
const MAX_SIDE: u32 = 1 << 14;

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
        let reader = || image::ImageReader::new(std::io::Cursor::new(bytes)).with_guessed_format();
        let (width, height) = reader()
            .map_err(image::ImageError::IoError)
            .and_then(image::ImageReader::into_dimensions)
            .map_err(|e| {
                wrong(format!(
                    "the image is not readable ({e}); textures are PNG or JPEG files"
                ))
            })?;
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
        let decoded = reader()
            .map_err(image::ImageError::IoError)
            .and_then(|mut reader| {
                let mut limits = image::Limits::default();
                limits.max_alloc = Some(16 * texels + (16 << 20));
                reader.limits(limits);
                reader.decode()
            })
            .map_err(|e| wrong(format!("the image is damaged ({e})")))?;
        let rgba = decoded.into_rgba8().pixels().map(|p| p.0).collect();
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
