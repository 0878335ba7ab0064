//! Pictures of an evaluation: every image and FLIP map as PNG, and a contact sheet that shows a whole scene at a
//! glance.
//!
//! Numbers are never taken from these pictures: they are clamped, sRGB-encoded and rounded to 8 bits for display.
//! [`write_floats`] writes an image as it is.

use super::judge::{MethodResult, by_error};
use super::{EvaluateError, FlipMap, Image, Judged};
use crate::chart::font;
use crate::chart::palette::{NOT_FINITE, Rgb, heat};
use crate::chart::raster::Raster;
use crate::numeric::file::{FileError, Replace, write_atomically};
use crate::numeric::npy::write_npy;
use crate::pixel::FragmentList;
use ndarray::Array3;
use std::path::Path;

/// Linear colour to an 8-bit sRGB display colour (IEC 61966-2-1); magenta where a channel is not finite.
fn display(linear: [f64; 3]) -> [u8; 3] {
    if linear.iter().any(|v| !v.is_finite()) {
        return NOT_FINITE;
    }
    linear.map(|v| {
        let v = v.clamp(0.0, 1.0);
        let encoded = if v <= 0.0031308 {
            12.92 * v
        } else {
            1.055 * v.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * encoded).round() as u8
    })
}

fn picture(width: u32, height: u32, color: impl Fn(usize) -> Rgb) -> Raster {
    Raster::from_fn(width, height, |x, y| color(y as usize * width as usize + x as usize))
}

fn image_picture(image: &Image) -> Raster {
    picture(image.width(), image.height(), |i| display(image.pixels()[i]))
}

fn write_png(path: &Path, replace: Replace, picture: &Raster) -> Result<(), EvaluateError> {
    write_atomically(path, replace, |w| picture.write_png(w)).map_err(|e: FileError| e.into())
}

/// Writes an image as PNG: clamped to [0, 1], sRGB-encoded, 8 bits; magenta where it is not finite.
///
/// # Errors
/// [`EvaluateError::File`].
pub fn write_image(path: &Path, replace: Replace, image: &Image) -> Result<(), EvaluateError> {
    write_png(path, replace, &image_picture(image))
}

/// Writes an image as NumPy's `.npy`: f32 `[height, width, 3]`, linear colour, neither clamped nor encoded.
///
/// # Errors
/// [`EvaluateError::File`].
pub fn write_floats(path: &Path, replace: Replace, image: &Image) -> Result<(), EvaluateError> {
    let channels = image.pixels().iter().flatten().map(|&v| v as f32).collect();
    let shape = (image.height() as usize, image.width() as usize, 3);
    let array = Array3::from_shape_vec(shape, channels).expect("an image has width times height pixels");
    Ok(write_npy(path, replace, array.view())?)
}

/// The FLIP value that maps show brightest, in files and on contact sheets alike; greater ones look the same. On a
/// scale up to 1, which FLIP reaches where black stands for white, every map of a method worth using is black.
pub const FLIP_TOP: f64 = 0.2;

/// Display colour of a value of a FLIP map.
fn flip_color(value: f64) -> Rgb {
    heat(value / FLIP_TOP)
}

/// Writes a FLIP map as PNG, from near black at 0 to pale yellow at [`FLIP_TOP`]; magenta where it is not finite.
///
/// # Errors
/// [`EvaluateError::File`].
pub fn write_flip(path: &Path, replace: Replace, map: &FlipMap) -> Result<(), EvaluateError> {
    write_png(
        path,
        replace,
        &picture(map.width(), map.height(), |i| flip_color(map.values()[i].into())),
    )
}

/// A method's name as part of a file name: what is neither an ASCII letter, a digit, a dot nor a hyphen becomes a
/// hyphen.
///
/// Two names may give one part; the caller who evaluates such methods together must tell them apart.
pub fn file_stem(method: &str) -> String {
    let stem: String = method
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '.' || c == '-' {
                c
            } else {
                '-'
            }
        })
        .collect();
    let stem = stem.trim_matches(['.', '-']);
    if stem.is_empty() {
        "method".to_owned()
    } else {
        stem.to_owned()
    }
}

/// Writes a method's image to `STEM.png` and its FLIP map to `STEM.flip.png` in a folder; nothing where the list makes
/// no image.
///
/// # Errors
/// [`EvaluateError::File`].
pub fn write_method(folder: &Path, stem: &str, replace: Replace, judged: &Judged) -> Result<(), EvaluateError> {
    let Some((image, map)) = &judged.picture else {
        return Ok(());
    };
    write_image(&folder.join(format!("{stem}.png")), replace, image)?;
    write_flip(&folder.join(format!("{stem}.flip.png")), replace, map)
}

/// Greatest width and height of an image on a sheet \[pixels\].
const PANEL: u32 = 288;
/// Between panels \[pixels\].
const GAP: u32 = 8;
/// Around the sheet and between its cells \[pixels\].
const MARGIN: u32 = 28;
/// Sizes of the heading, of names, and of numbers and captions \[pixels an em\].
const HEADING: f64 = 30.0;
const NAMES: f64 = 19.0;
const NUMBERS: f64 = 16.5;
/// Height of a line of names or numbers, and of the heading \[pixels\].
const LINE: u32 = 24;
const HEADING_LINE: u32 = 40;
/// The crop is this share of the image's width and height.
const CROP: u32 = 8;

/// Draws a line of text whose line begins at `y`.
fn write(sheet: &mut Raster, x: u32, y: u32, size: f64, color: Rgb, text: &str) {
    font::draw(sheet, x.into(), f64::from(y) + 0.95 * size, size, color, text);
}

/// Width of a line of text, rounded up \[pixels\].
fn width(text: &str, size: f64) -> u32 {
    font::width(text, size).ceil() as u32
}

const PAGE: Rgb = [245, 245, 247];
const INK: Rgb = [22, 22, 28];
const NAME: Rgb = [14, 66, 150];
const FAINT: Rgb = [98, 98, 110];
const FRAME: Rgb = [186, 186, 194];
const ALARM: Rgb = [190, 0, 60];

/// A contact sheet of one scene: the exact image and those of all methods, the best first, each with its numbers, its
/// FLIP map and an enlarged crop of where the methods together differ most.
///
/// It keeps 7 bytes a pixel and method until it is rendered.
pub struct Sheet {
    scene: String,
    subtitle: String,
    truth: Shown,
    methods: Vec<(MethodResult, Shown, FlipMap)>,
}

/// An image in the two forms that a sheet needs.
struct Shown {
    full: Raster,
    panel: Raster,
}

impl Shown {
    fn of(image: &Image) -> Self {
        let (width, height) = fit(image.width(), image.height(), PANEL);
        let linear = resample(image.pixels(), image.width(), (width, height));
        Self {
            full: image_picture(image),
            panel: picture(width, height, |i| display(linear[i])),
        }
    }
}

/// A rectangle [pixels of the scene's image].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crop {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
}

impl Sheet {
    /// A sheet of a scene: a fragment list, its name and its exact image.
    pub fn new(scene: &str, list: &FragmentList, exact: &Image) -> Self {
        let (width, height, fragments) = (exact.width(), exact.height(), list.len());
        let subtitle = format!(
            "{width} x {height} pixels, {fragments} fragments, up to {} in a pixel",
            list.depth_complexity()
        );
        Self {
            scene: scene.to_owned(),
            subtitle,
            truth: Shown::of(exact),
            methods: vec![],
        }
    }

    /// Adds a method; one without a picture is left out.
    ///
    /// # Errors
    /// [`EvaluateError::SizesDiffer`] where its image is not of the scene's size.
    pub fn add(&mut self, judged: &Judged) -> Result<(), EvaluateError> {
        let Some((image, map)) = &judged.picture else {
            return Ok(());
        };
        let reference = self.truth.full.size();
        if reference != (image.width(), image.height()) {
            return Err(EvaluateError::SizesDiffer {
                reference,
                test: (image.width(), image.height()),
            });
        }
        self.methods
            .push((judged.result.clone(), Shown::of(image), map.clone()));
        Ok(())
    }

    /// Writes the sheet as PNG.
    ///
    /// # Errors
    /// [`EvaluateError::EmptySheet`] without methods, [`EvaluateError::File`].
    pub fn write(&self, path: &Path, replace: Replace) -> Result<(), EvaluateError> {
        write_png(path, replace, &self.render()?)
    }

    /// The sheet as a picture.
    fn render(&self) -> Result<Raster, EvaluateError> {
        if self.methods.is_empty() {
            return Err(EvaluateError::EmptySheet);
        }
        let mut methods: Vec<_> = self.methods.iter().collect();
        methods.sort_by(|a, b| by_error(&a.0, &b.0));
        let crop = self.crop();
        let names: Vec<Vec<String>> = methods.iter().map(|(result, ..)| shortened(&result.method)).collect();

        let panel = self.truth.panel.size();
        let half = fit(panel.0, panel.1, (PANEL - GAP) / 2);
        let name_lines = names.iter().map(|n| n.len() as u32).max().unwrap_or(1);
        let cell = (PANEL, (name_lines + 2) * LINE + GAP + panel.1 + GAP + half.1 + LINE);
        let head = MARGIN + HEADING_LINE + 2 * LINE;
        let columns = columns(methods.len() as u32 + 1, cell);
        let rows = (methods.len() as u32 + 1).div_ceil(columns);
        let place = |i: usize| {
            (
                MARGIN + i as u32 % columns * (cell.0 + MARGIN),
                head + MARGIN + i as u32 / columns * (cell.1 + MARGIN),
            )
        };

        let lines = [
            format!("{}; best image MSE first", self.subtitle),
            format!(
                "crop: the marked {} x {} pixels, where methods differ most",
                crop.width, crop.height
            ),
        ];
        let needed = lines
            .iter()
            .map(|l| width(l, NUMBERS))
            .chain([width(&self.scene, HEADING)])
            .max()
            .unwrap_or(0);
        let width = (MARGIN + columns * (cell.0 + MARGIN)).max(needed.min(4096) + 2 * MARGIN);
        let mut sheet = Raster::new(width, head + MARGIN + rows * (cell.1 + MARGIN), PAGE);
        write(&mut sheet, MARGIN, MARGIN, HEADING, INK, &self.scene);
        for (i, line) in lines.iter().enumerate() {
            let y = MARGIN + HEADING_LINE + i as u32 * LINE;
            write(&mut sheet, MARGIN, y, NUMBERS, FAINT, line);
        }

        let mut draw = Cell {
            sheet: &mut sheet,
            at: place(0),
            panel,
            half,
            name_lines,
        };
        draw.label(
            &["ground truth".to_owned()],
            [("A-buffer in f64".to_owned(), FAINT), (String::new(), FAINT)],
        );
        draw.image(&self.truth, crop);
        draw.scale();
        for (i, ((result, shown, map), name)) in methods.into_iter().zip(&names).enumerate() {
            let mut draw = Cell {
                sheet: &mut sheet,
                at: place(i + 1),
                panel,
                half,
                name_lines,
            };
            draw.label(name, numbers(result));
            draw.image(shown, crop);
            draw.map(map);
        }
        Ok(sheet)
    }

    /// Where the sum of all FLIP maps over a rectangle of the crop's size is greatest.
    fn crop(&self) -> Crop {
        let (width, height) = self.truth.full.size();
        let side = |whole: u32| whole.div_ceil(CROP).max(8).min(whole);
        let (w, h) = (side(width), side(height));
        // Sums over all pixels above and to the left.
        let stride = width as usize + 1;
        let mut sums = vec![0.0f64; stride * (height as usize + 1)];
        for y in 0..height as usize {
            let mut row = 0.0;
            for x in 0..width as usize {
                let here = self
                    .methods
                    .iter()
                    .map(|(.., map)| f64::from(map.values()[y * width as usize + x]));
                row += here.map(|v| if v.is_finite() { v } else { 1.0 }).sum::<f64>();
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
            }
        }
        let sum = |x: u32, y: u32| {
            let at = |x: u32, y: u32| sums[y as usize * stride + x as usize];
            at(x + w, y + h) - at(x, y + h) - at(x + w, y) + at(x, y)
        };
        let mut best = (0, 0);
        let mut greatest = f64::NEG_INFINITY;
        for (y, x) in (0..=height - h).flat_map(|y| (0..=width - w).map(move |x| (y, x))) {
            let here = sum(x, y);
            if here > greatest {
                (best, greatest) = ((x, y), here);
            }
        }
        Crop {
            x: best.0,
            y: best.1,
            width: w,
            height: h,
        }
    }
}

/// A method's name in at most two lines.
fn shortened(name: &str) -> Vec<String> {
    let mut lines = font::wrap(name, NAMES, PANEL.into());
    if lines.len() > 2 {
        lines.truncate(2);
        let second = &mut lines[1];
        second.push('…');
        while width(second, NAMES) > PANEL && second.chars().count() > 2 {
            let kept = second.chars().count() - 2;
            *second = second.chars().take(kept).collect::<String>() + "…";
        }
    }
    lines
}

/// The two lines of numbers below a method's name.
fn numbers(result: &MethodResult) -> [(String, Rgb); 2] {
    let short = |v: Option<f64>| match v {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(v) if v.is_finite() => format!("{v:.2e}"),
        Some(_) => "NaN".to_owned(),
    };
    let flip = result.flip_mean.map_or("-".to_owned(), |v| match v {
        0.0 => "0".to_owned(),
        v if v.is_finite() => format!("{v:.4}"),
        _ => "NaN".to_owned(),
    });
    let first = (format!("MSE {}", short(result.image_mse)), INK);
    let bad = result.nonfinite.max(result.image_nonfinite.unwrap_or(0));
    let second = match (bad, result.transmittance_mse) {
        (0, None) => (format!("FLIP {flip}"), FAINT),
        (0, mse) => (format!("FLIP {flip}  T-MSE {}", short(mse)), FAINT),
        (bad, _) => (format!("{bad} values not finite"), ALARM),
    };
    [first, second]
}

/// Number of columns that brings a sheet of so many cells close to three by two and leaves few places empty.
fn columns(cells: u32, cell: (u32, u32)) -> u32 {
    let shape = |columns: u32| {
        let (w, h) = (columns * (cell.0 + MARGIN), cells.div_ceil(columns) * (cell.1 + MARGIN));
        let places = columns * cells.div_ceil(columns);
        (f64::from(w) / f64::from(h) / 1.5).ln().abs() + f64::from(places - cells) / f64::from(places)
    };
    (1..=cells).min_by(|&a, &b| shape(a).total_cmp(&shape(b))).unwrap_or(1)
}

/// Size of an image that is scaled to fit a square.
fn fit(width: u32, height: u32, side: u32) -> (u32, u32) {
    let scaled = |v: u32| ((u64::from(v) * u64::from(side)) / u64::from(width.max(height))).max(1) as u32;
    (scaled(width), scaled(height))
}

/// An image at another size: the mean over the area that each new pixel covers.
fn resample<const C: usize>(pixels: &[[f64; C]], width: u32, size: (u32, u32)) -> Vec<[f64; C]> {
    let height = (pixels.len() / width as usize) as u32;
    let (across, down) = (covers(width, size.0), covers(height, size.1));
    let mut out = Vec::with_capacity(size.0 as usize * size.1 as usize);
    for down in &down {
        for across in &across {
            let mut sum = [0.0; C];
            for &(y, wy) in down {
                for &(x, wx) in across {
                    let pixel = &pixels[y * width as usize + x];
                    sum.iter_mut().zip(pixel).for_each(|(s, v)| *s += wx * wy * v);
                }
            }
            out.push(sum);
        }
    }
    out
}

/// Which of `from` pixels each of `to` covers, and by which share of its own extent.
fn covers(from: u32, to: u32) -> Vec<Vec<(usize, f64)>> {
    let step = f64::from(from) / f64::from(to);
    let one = |i: u32| {
        let (start, end) = (f64::from(i) * step, (f64::from(i + 1) * step).min(f64::from(from)));
        let pixels = (start as u32).min(from - 1)..(end.ceil() as u32).min(from);
        let shares = pixels.map(|p| {
            (
                p as usize,
                (end.min(f64::from(p + 1)) - start.max(f64::from(p))) / (end - start),
            )
        });
        shares.filter(|s| s.1 > 0.0).collect()
    };
    (0..to).map(one).collect()
}

/// Draws one cell of a sheet, from top to bottom: name, numbers, image, and below it the map (or the scale) beside the
/// crop.
struct Cell<'a> {
    sheet: &'a mut Raster,
    at: (u32, u32),
    panel: (u32, u32),
    half: (u32, u32),
    name_lines: u32,
}

impl Cell<'_> {
    fn label(&mut self, name: &[String], numbers: [(String, Rgb); 2]) {
        let x = self.at.0;
        // Short names stand low, so that all numbers of a row are at one height.
        let mut y = self.at.1 + self.name_lines.saturating_sub(name.len() as u32) * LINE;
        for line in name {
            write(self.sheet, x, y, NAMES, NAME, line);
            y += LINE;
        }
        for (line, color) in &numbers {
            write(self.sheet, x, y, NUMBERS, *color, line);
            y += LINE;
        }
    }

    fn top_of_image(&self) -> u32 {
        self.at.1 + (self.name_lines + 2) * LINE + GAP
    }

    fn image(&mut self, shown: &Shown, crop: Crop) {
        let (width, height) = self.panel;
        let (x, y) = (self.at.0 + (PANEL - width) / 2, self.top_of_image());
        self.paste(x, y, &shown.panel);
        // The crop's place: a light line around a dark one, to be seen on anything.
        let full = shown.full.size();
        let on_panel = |v: u32, panel: u32, full: u32| (u64::from(v) * u64::from(panel) / u64::from(full)) as u32;
        let (left, right) = (
            on_panel(crop.x, width, full.0),
            on_panel(crop.x + crop.width, width, full.0),
        );
        let (top, bottom) = (
            on_panel(crop.y, height, full.1),
            on_panel(crop.y + crop.height, height, full.1),
        );
        let size = (right.saturating_sub(left), bottom.saturating_sub(top));
        self.outline((x + left, y + top), size, [20; 3]);
        if size.0 > 2 && size.1 > 2 {
            self.outline((x + left + 1, y + top + 1), (size.0 - 2, size.1 - 2), [255; 3]);
        }

        let (half, from) = (self.half, &shown.full);
        let place = |i: u32, size: u32, crop: u32| (u64::from(i) * u64::from(crop) / u64::from(size)) as u32;
        let enlarged = Raster::from_fn(half.0, half.1, |i, j| {
            from.pixel(
                crop.x + place(i, half.0, crop.width),
                crop.y + place(j, half.1, crop.height),
            )
        });
        self.lower(1, &enlarged, "crop");
    }

    fn map(&mut self, map: &FlipMap) {
        let values: Vec<[f64; 1]> = map.values().iter().map(|&v| [f64::from(v)]).collect();
        let small = resample(&values, map.width(), self.half);
        let shown = picture(self.half.0, self.half.1, |i| flip_color(small[i][0]));
        self.lower(0, &shown, "FLIP");
    }

    /// The colour scale of all maps, where the maps of the other cells stand.
    fn scale(&mut self) {
        let (x, y) = (self.at.0, self.top_of_image() + self.panel.1 + GAP);
        let across = (PANEL - GAP) / 2;
        let bar = picture(across, 20.min(self.half.1), |i| {
            heat((i as u32 % across) as f64 / f64::from(across - 1))
        });
        self.paste(x, y, &bar);
        let below = y + bar.height() + 6;
        let end = format!("{FLIP_TOP}+");
        write(self.sheet, x, below, NUMBERS, INK, "0");
        write(self.sheet, x + across - width(&end, NUMBERS), below, NUMBERS, INK, &end);
        write(self.sheet, x, below + LINE, NUMBERS, FAINT, "FLIP scale");
    }

    /// Draws one of the two pictures below the image, with a caption.
    fn lower(&mut self, column: u32, picture: &Raster, caption: &str) {
        let column_width = (PANEL - GAP) / 2;
        let x = self.at.0 + column * (column_width + GAP);
        let y = self.top_of_image() + self.panel.1 + GAP;
        self.paste(x + (column_width - picture.width()) / 2, y, picture);
        write(self.sheet, x, y + picture.height() + 3, NUMBERS, FAINT, caption);
    }

    /// Copies a picture, with a thin frame around it.
    fn paste(&mut self, x: u32, y: u32, picture: &Raster) {
        let (width, height) = picture.size();
        self.outline((x - 1, y - 1), (width + 2, height + 2), FRAME);
        self.sheet.paste(x, y, picture);
    }

    fn outline(&mut self, (x, y): (u32, u32), (width, height): (u32, u32), color: Rgb) {
        self.sheet.fill(x, y, width, 1, color);
        self.sheet.fill(x, (y + height).saturating_sub(1), width, 1, color);
        self.sheet.fill(x, y, 1, height, color);
        self.sheet.fill((x + width).saturating_sub(1), y, 1, height, color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Truth;
    use crate::evaluate::judge::tests::{Shifted, colored_list};
    use crate::oit::Context;

    /// Encoding of 0, of the linear part's end, of a middle grey and of 1; control: without encoding the grey is
    /// another.
    #[test]
    fn display_encodes_clamps_and_marks() {
        assert_eq!(display([0.0, 0.0031308, 1.0]), [0, 10, 255]);
        // 18 % grey is 118 in sRGB.
        assert_eq!(display([0.18, 2.0, -1.0]), [118, 255, 0]);
        assert_ne!((255.0f64 * 0.18).round() as u8, 118);
        assert_eq!(display([0.5, f64::NAN, 0.5]), NOT_FINITE);
        assert_eq!(display([f64::INFINITY, 0.0, 0.0]), NOT_FINITE);
    }

    /// The mean survives at any size; control: it is the mean of the covered area and no single pixel's value.
    #[test]
    fn resampling_takes_means() {
        let pixels: Vec<[f64; 1]> = (0..12).map(|i| [f64::from(i * i % 7)]).collect();
        let mean = |p: &[[f64; 1]]| p.iter().map(|p| p[0]).sum::<f64>() / p.len() as f64;
        for size in [(4, 3), (2, 1), (1, 1), (7, 5), (8, 6)] {
            let resampled = resample(&pixels, 4, size);
            assert_eq!(resampled.len() as u32, size.0 * size.1);
            assert!((mean(&resampled) - mean(&pixels)).abs() < 1e-12, "{size:?}");
        }
        assert_eq!(resample(&pixels, 4, (4, 3)), pixels);
        assert_ne!(resample(&pixels, 4, (1, 1))[0], pixels[0]);
    }

    #[test]
    fn names_become_safe_file_names() {
        assert_eq!(file_stem("moment-power-4:nlqm+own"), "moment-power-4-nlqm-own");
        assert_eq!(file_stem("neural:../models/m.json"), "neural-..-models-m.json");
        assert_eq!(
            (file_stem("../.."), file_stem("")),
            ("method".to_owned(), "method".to_owned())
        );
    }

    fn sheet(list: &FragmentList, offsets: &[f64]) -> Sheet {
        let truth = Truth::new(list, [1.0; 3]);
        let mut sheet = Sheet::new("discs", list, truth.image().unwrap());
        for &offset in offsets {
            sheet
                .add(&truth.judge(&Shifted(offset), Context::default()).unwrap())
                .unwrap();
        }
        sheet
    }

    /// Pictures come back from their files as they were; the sheet's crop lies where the methods differ.
    #[test]
    fn files_and_sheet() {
        let folder = tempfile::tempdir().unwrap();
        let list = colored_list(64, 48);
        let truth = Truth::new(&list, [1.0; 3]);
        let judged = truth.judge(&Shifted(0.3), Context::default()).unwrap();
        write_method(folder.path(), "off", Replace::No, &judged).unwrap();
        let read = |name: &str| {
            let bytes = std::fs::read(folder.path().join(name)).unwrap();
            Raster::read_png(std::io::Cursor::new(bytes)).unwrap()
        };
        let (image, map) = judged.picture.as_ref().unwrap();
        assert_eq!(read("off.png"), image_picture(image));
        // The scale ends at 0.2, here as on sheets.
        let shown = read("off.flip.png");
        let value = f64::from(map.values()[24 * 64 + 32]);
        assert_eq!(shown.pixel(32, 24), heat(value / 0.2));
        assert_eq!(
            (flip_color(0.1), flip_color(0.7), flip_color(0.0)),
            (heat(0.5), heat(1.0), heat(0.0))
        );
        assert!(
            map.values()
                .iter()
                .zip(shown.pixels())
                .all(|(&v, &p)| p == flip_color(v.into()))
        );
        assert!(matches!(
            write_method(folder.path(), "off", Replace::No, &judged),
            Err(EvaluateError::File(FileError::Exists { .. }))
        ));

        let sheet = sheet(&list, &[0.3, 0.0]);
        sheet.write(&folder.path().join("sheet.png"), Replace::No).unwrap();
        let crop = sheet.crop();
        let mean = |x0: u32, y0: u32, w: u32, h: u32| {
            let values = (y0..y0 + h).flat_map(|y| (x0..x0 + w).map(move |x| (y * 64 + x) as usize));
            values.map(|i| f64::from(map.values()[i])).sum::<f64>() / f64::from(w * h)
        };
        assert_eq!((crop.width, crop.height), (8, 8));
        assert!(mean(crop.x, crop.y, 8, 8) > 1.5 * mean(0, 0, 64, 48));
        let picture = read("sheet.png");
        assert_eq!(picture, sheet.render().unwrap());
        // All is finite, so nothing is magenta.
        assert!(picture.pixels().iter().all(|p| *p != NOT_FINITE) && picture.pixels().iter().any(|p| *p != PAGE));
    }

    /// Odd shapes, a method that fails everywhere, and names of any length.
    #[test]
    fn any_size_and_any_name_make_a_sheet() {
        for (width, height) in [(1, 1), (1, 200), (700, 2), (9, 7)] {
            let picture = sheet(&colored_list(width, height), &[0.2, f64::NAN, 0.1])
                .render()
                .unwrap();
            assert!(
                picture.width() > PANEL && picture.height() > MARGIN,
                "{width} x {height}"
            );
        }
        let alarmed = sheet(&colored_list(32, 32), &[f64::NAN]).render().unwrap();
        assert!(alarmed.pixels().contains(&ALARM) && alarmed.pixels().contains(&NOT_FINITE));
        let lines = shortened(&"a-very-long-name".repeat(20));
        assert!(
            lines.len() == 2 && lines.iter().all(|l| width(l, NAMES) <= PANEL) && lines[1].ends_with('…'),
            "{lines:?}"
        );
    }

    #[test]
    fn sheets_refuse_what_they_cannot_show() {
        let list = colored_list(8, 6);
        let mut sheet = sheet(&list, &[]);
        assert!(matches!(sheet.render(), Err(EvaluateError::EmptySheet)));
        let other = colored_list(6, 8);
        let judged = Truth::new(&other, [1.0; 3])
            .judge(&Shifted(0.1), Context::default())
            .unwrap();
        assert!(sheet.add(&judged).unwrap_err().to_string().contains("6 x 8"));
        let missing = Truth::new(&other, [1.0; 3])
            .judge(&Shifted(0.1), Context::default())
            .map(|j| Judged { picture: None, ..j })
            .unwrap();
        sheet.add(&missing).unwrap();
        assert!(sheet.methods.is_empty());
    }
}
