//! The typeface of pictures: a subset of DejaVu Sans, embedded. Its licence stands beside it in `data/font`.

use super::palette::Rgb;
use super::raster::Raster;
use super::text::base64;
use ab_glyph_rasterizer::{Point, Rasterizer, point};
use std::sync::OnceLock;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static BYTES: &[u8] = include_bytes!("../../data/font/DejaVuSans-subset.ttf");

/// The name under which drawings ask for it.
pub const FAMILY: &str = "DejaVu Sans";

fn face() -> &'static Face<'static> {
    static FACE: OnceLock<Face<'static>> = OnceLock::new();
    FACE.get_or_init(|| Face::parse(BYTES, 0).expect("the embedded font is whole"))
}

/// The glyph of a letter; a question mark for what the subset lacks.
fn glyph(letter: char) -> GlyphId {
    let found = face().glyph_index(letter).or_else(|| face().glyph_index('?'));
    found.expect("the subset holds a question mark")
}

/// How far a letter takes the pen \[units of the font\].
fn advance(letter: char) -> f64 {
    face().glyph_hor_advance(glyph(letter)).unwrap_or(0).into()
}

/// Width of a line of text at a size of so many pixels an em \[pixels\].
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size / f64::from(face().units_per_em())
}

/// An outline in pixels, as the rasteriser takes it.
struct Outline<'a> {
    to: &'a mut Rasterizer,
    scale: f32,
    origin: Point,
    start: Point,
    at: Point,
}

impl Outline<'_> {
    fn place(&self, x: f32, y: f32) -> Point {
        point(self.origin.x + self.scale * x, self.origin.y - self.scale * y)
    }
}

impl OutlineBuilder for Outline<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.at = self.place(x, y);
        self.start = self.at;
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let end = self.place(x, y);
        self.to.draw_line(self.at, end);
        self.at = end;
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (middle, end) = (self.place(x1, y1), self.place(x, y));
        self.to.draw_quad(self.at, middle, end);
        self.at = end;
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let end = self.place(x, y);
        self.to.draw_cubic(self.at, self.place(x1, y1), self.place(x2, y2), end);
        self.at = end;
    }

    fn close(&mut self) {
        self.to.draw_line(self.at, self.start);
        self.at = self.start;
    }
}

/// Draws a line of text with its baseline at `y`, starting at `x`; what lies outside the picture is left out.
pub fn draw(picture: &mut Raster, x: f64, y: f64, size: f64, color: Rgb, text: &str) {
    let scale = size / f64::from(face().units_per_em());
    let mut left = x;
    for letter in text.chars() {
        let id = glyph(letter);
        if let Some(bounds) = face().glyph_bounding_box(id) {
            // Whole pixels around the glyph.
            let [x0, x1] = [bounds.x_min, bounds.x_max].map(|v| left + scale * f64::from(v));
            let [y0, y1] = [bounds.y_max, bounds.y_min].map(|v| y - scale * f64::from(v));
            let (x0, y0, x1, y1) = (x0.floor(), y0.floor(), x1.ceil() + 1.0, y1.ceil() + 1.0);
            let mut rasterizer = Rasterizer::new((x1 - x0) as usize, (y1 - y0) as usize);
            let mut outline = Outline {
                to: &mut rasterizer,
                scale: scale as f32,
                origin: point((left - x0) as f32, (y - y0) as f32),
                start: point(0.0, 0.0),
                at: point(0.0, 0.0),
            };
            face().outline_glyph(id, &mut outline);
            rasterizer.for_each_pixel_2d(|i, j, coverage| {
                picture.blend(x0 as i64 + i64::from(i), y0 as i64 + i64::from(j), color, coverage);
            });
        }
        left += scale * advance(letter);
    }
}

/// Breaks a text into lines no wider than `widest`, after a hyphen, colon, plus, slash or space where there is one in
/// reach.
pub fn wrap(text: &str, size: f64, widest: f64) -> Vec<String> {
    let mut lines = vec![];
    let mut line = String::new();
    for letter in text.chars() {
        line.push(letter);
        while width(&line, size) > widest && line.chars().count() > 1 {
            let last = line.len() - letter.len_utf8();
            let at = line[..last]
                .rfind(['-', ':', '+', '/', ' ', '_'])
                .map_or(last, |i| i + 1);
            let rest = line.split_off(at);
            lines.push(std::mem::replace(&mut line, rest));
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// A style rule that brings the font with a drawing.
pub fn embedded() -> String {
    format!(
        "@font-face {{ font-family: \"{FAMILY}\"; src: url(data:font/ttf;base64,{}); }}",
        base64(BYTES)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Advance widths are those of DejaVu Sans, as fontTools prints them [units of 2048 an em].
    #[test]
    fn widths_are_those_of_the_font() {
        let units = |letter: &str| (width(letter, 2048.0)).round() as i64;
        assert_eq!((units("m"), units("i"), units("0")), (1995, 569, 1303));
        assert_eq!(width("é", 12.0), width("?", 12.0));
    }

    #[test]
    fn letters_leave_ink_within_their_width() {
        let mut picture = Raster::new(200, 40, [255; 3]);
        draw(&mut picture, 3.0, 30.0, 20.0, [0; 3], "Ag-7:+");
        let dark = |x: u32| (0..40).any(|y| picture.pixel(x, y)[0] < 128);
        let inked: Vec<u32> = (0..200).filter(|&x| dark(x)).collect();
        let end = 3.0 + width("Ag-7:+", 20.0);
        assert!(
            inked[0] >= 2 && f64::from(*inked.last().unwrap()) <= end,
            "{inked:?} {end}"
        );
        // Far outside: nothing, and no panic.
        draw(&mut picture, 1e6, -1e6, 30.0, [0; 3], "Ag-7:+");
    }

    proptest! {
        #[test]
        fn wrapping_loses_nothing_and_fits(name in "[a-z:+é -]{0,60}", widest in 20f64..300.0) {
            let lines = wrap(&name, 14.0, widest);
            prop_assert_eq!(lines.concat(), name);
            prop_assert!(lines.iter().all(|l| width(l, 14.0) <= widest), "{:?}", lines);
        }
    }
}
