//! Pictures of pixels, and their PNG files.

use super::palette::Rgb;
use std::io::Write;

/// A picture in 8-bit display colours, row by row from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Raster {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

impl std::fmt::Debug for Raster {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Raster of {} x {} pixels", self.width, self.height)
    }
}

impl Raster {
    /// A picture of one colour.
    pub fn new(width: u32, height: u32, color: Rgb) -> Self {
        Self {
            width,
            height,
            pixels: vec![color; width as usize * height as usize],
        }
    }

    /// A picture of the colours that a function gives to each place.
    pub fn from_fn(width: u32, height: u32, mut color: impl FnMut(u32, u32) -> Rgb) -> Self {
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            pixels.extend((0..width).map(|x| color(x, y)));
        }
        Self { width, height, pixels }
    }

    /// Width \[pixels\].
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height \[pixels\].
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Width and height \[pixels\].
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// The colour of a pixel.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Rgb {
        assert!(x < self.width, "{x} is outside");
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// Sets a pixel; nothing outside the picture.
    pub fn set(&mut self, x: u32, y: u32, color: Rgb) {
        if x < self.width && y < self.height {
            self.pixels[y as usize * self.width as usize + x as usize] = color;
        }
    }

    /// Covers a share of a pixel with a colour; nothing outside the picture.
    pub fn blend(&mut self, x: i64, y: i64, color: Rgb, coverage: f32) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
            return;
        };
        if x < self.width && y < self.height {
            let share = coverage.clamp(0.0, 1.0);
            let old = self.pixel(x, y);
            let mixed = |c: usize| f32::from(old[c]) + share * (f32::from(color[c]) - f32::from(old[c]));
            self.set(x, y, std::array::from_fn(|c| mixed(c).round() as u8));
        }
    }

    /// Fills a rectangle, as much of it as lies inside the picture.
    pub fn fill(&mut self, x: u32, y: u32, width: u32, height: u32, color: Rgb) {
        for y in y..y.saturating_add(height).min(self.height) {
            for x in x..x.saturating_add(width).min(self.width) {
                self.set(x, y, color);
            }
        }
    }

    /// Copies another picture to a place, as much of it as lies inside.
    pub fn paste(&mut self, x: u32, y: u32, other: &Self) {
        for j in 0..other.height {
            for i in 0..other.width {
                self.set(x + i, y + j, other.pixel(i, j));
            }
        }
    }

    /// Writes the picture as PNG.
    ///
    /// # Errors
    /// Where the writer fails.
    pub fn write_png(&self, to: impl Write) -> std::io::Result<()> {
        let mut encoder = png::Encoder::new(to, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(std::io::Error::other)?;
        writer
            .write_image_data(self.pixels.as_flattened())
            .map_err(std::io::Error::other)?;
        writer.finish().map_err(std::io::Error::other)
    }

    /// Reads a PNG of 8-bit RGB.
    ///
    /// # Errors
    /// Where it is something else.
    pub fn read_png(from: impl std::io::BufRead + std::io::Seek) -> std::io::Result<Self> {
        let mut reader = png::Decoder::new(from).read_info().map_err(std::io::Error::other)?;
        let size = reader
            .output_buffer_size()
            .ok_or_else(|| std::io::Error::other("the picture is too large"))?;
        let mut bytes = vec![0; size];
        let info = reader.next_frame(&mut bytes).map_err(std::io::Error::other)?;
        if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(std::io::Error::other("the picture is not 8-bit RGB"));
        }
        let pixels = bytes[..info.buffer_size()].as_chunks::<3>().0.to_vec();
        Ok(Self {
            width: info.width,
            height: info.height,
            pixels,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture comes back from its file as it was. Control: another one does not.
    #[test]
    fn files_hold_the_picture() {
        let picture = Raster::from_fn(5, 3, |x, y| [x as u8, y as u8, 200]);
        let mut bytes = Vec::new();
        picture.write_png(&mut bytes).unwrap();
        let back = Raster::read_png(std::io::Cursor::new(&bytes)).unwrap();
        assert!(back == picture && back != Raster::new(5, 3, [0; 3]));
        assert!(Raster::read_png(std::io::Cursor::new(&bytes[..30])).is_err());
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        let mut picture = Raster::new(4, 4, [255; 3]);
        picture.blend(-1, 2, [0; 3], 1.0);
        picture.blend(2, 9, [0; 3], 1.0);
        picture.fill(3, 3, 100, 100, [1; 3]);
        picture.blend(0, 0, [0; 3], 0.5);
        assert_eq!((picture.pixel(3, 3), picture.pixel(0, 0)), ([1; 3], [128; 3]));
        assert_eq!(picture.pixels().iter().filter(|p| **p != [255; 3]).count(), 2);
    }
}
