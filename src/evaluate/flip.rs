//! LDR-FLIP: how large a person finds the difference between two images when flipping between them.
//!
//! Images are clamped to [0, 1], rounded to f32 and taken as the display values that FLIP expects, without any encoding
//! before: so the numbers are those of FLIP's own tool on arrays of these values. Everything after that is in f64.
//!
//! # Source
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, *FLIP: A Difference Evaluator for Alternating
//! Images*, PACMCGIT 3(2) 2020; section and constant names below are the paper's. Tools: CIELAB (CIE 15), sRGB (IEC
//! 61966-2-1).

use super::EvaluateError;
use super::image::{Image, same_size};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels per degree of visual angle of the observer whose FLIP is stated.
pub const PIXELS_PER_DEGREE: f64 = 67.0;

/// Visual difference of every pixel of two images, row by row; 0 is none, 1 the greatest.
#[derive(Debug, Clone, PartialEq)]
pub struct FlipMap {
    width: u32,
    height: u32,
    values: Vec<f32>,
}

impl FlipMap {
    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Differences, row by row; NaN around a pixel that is not finite in one of the images.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Mean difference; NaN as soon as one is.
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|&v| f64::from(v)).sum::<f64>() / self.values.len() as f64
    }
}

/// Visual difference of an image from a reference, on all cores, seen at [`PIXELS_PER_DEGREE`].
///
/// # Domain
/// Values outside [0, 1] are clamped; one that is not finite makes the map NaN within the reach of the filters (10
/// pixels).
///
/// # Accuracy
/// The mean and single pixels agree with flip-evaluator 1.7 to 2.5e-5 (test `agrees_with_flip_evaluator`). It computes
/// in f32, and of what rounding leaves of its feature detectors on flat ground, about 1e-8, the square root is taken.
///
/// # Errors
/// [`EvaluateError::SizesDiffer`].
pub fn flip(reference: &Image, test: &Image) -> Result<FlipMap, EvaluateError> {
    flip_at(reference, test, PIXELS_PER_DEGREE)
}

/// Rows that one thread filters at once: enough that the filters' overlap costs little, few enough that a band stays in
/// the cache.
const BAND: usize = 48;

fn flip_at(reference: &Image, test: &Image, pixels_per_degree: f64) -> Result<FlipMap, EvaluateError> {
    same_size(reference, test)?;
    let (width, height) = (reference.width(), reference.height());
    let columns = width as usize;
    let observer = Observer::new(pixels_per_degree);
    let mut values = vec![0.0; reference.pixels().len()];
    values
        .par_chunks_mut(BAND * columns)
        .enumerate()
        .for_each(|(band, out)| {
            let rows = band * BAND..band * BAND + out.len() / columns;
            let (reference, test) = (observer.percept(reference, rows.clone()), observer.percept(test, rows));
            for (out, (a, b)) in out.iter_mut().zip(reference.iter().zip(&test)) {
                *out = observer.difference(a, b) as f32;
            }
        });
    Ok(FlipMap { width, height, values })
}

/// What an observer makes of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Percept {
    /// CIELAB colour after the contrast sensitivity filters, chroma scaled for the Hunt effect.
    lab: [f64; 3],
    /// Strength of an edge.
    edge: f64,
    /// Strength of a point or line.
    point: f64,
}

/// Taps of a filter in one dimension, an odd number of them around the centre.
type Taps = Vec<f64>;

/// The filters and constants for one viewing distance.
struct Observer {
    /// Contrast sensitivity, one normalised Gaussian each: achromatic, red-green, and the two that blue-yellow is the
    /// mix of.
    sensitivity: [Taps; 4],
    /// Shares of the two Gaussians of blue-yellow, together 1.
    mix: [f64; 2],
    /// Gaussian, its first and its second derivative.
    feature: [Taps; 3],
    /// Greatest colour difference there is, that of green and blue, to the power of [`Q_C`].
    greatest: f64,
    to_xyz: [[f64; 3]; 3],
    from_xyz: [[f64; 3]; 3],
    white: [f64; 3],
}

/// Exponent that compresses large colour differences.
const Q_C: f64 = 0.7;
/// Share of the greatest colour difference below which the map is steep.
const P_C: f64 = 0.4;
/// What that share is mapped to.
const P_T: f64 = 0.95;
/// Exponent of feature differences.
const Q_F: f64 = 0.5;
/// Width of the feature detector \[degrees\].
const FEATURE_WIDTH: f64 = 0.082;

/// Contrast sensitivities as sums of Gaussians in space: (a, b) of a √(π/b) exp(−π² x²/b), x in degrees.
const ACHROMATIC: (f64, f64) = (1.0, 0.0047);
const RED_GREEN: (f64, f64) = (1.0, 0.0053);
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// Chromaticities of the sRGB primaries.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
/// Chromaticity of D65 to five digits, for the 2 degree observer; FLIP's tool uses it rather than sRGB's four digits.
const WHITE: [f64; 2] = [0.31271, 0.32902];

impl Observer {
    fn new(pixels_per_degree: f64) -> Self {
        // CSF filters: all reach as far as three standard deviations of the widest.
        let widest = [ACHROMATIC, RED_GREEN, BLUE_YELLOW[0], BLUE_YELLOW[1]]
            .iter()
            .fold(0.0f64, |w, g| w.max(g.1));
        let reach = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let gaussian = |b: f64| -> Taps {
            (-reach..=reach)
                .map(|x| (-PI * PI * (f64::from(x) / pixels_per_degree).powi(2) / b).exp())
                .collect()
        };
        let [wide, narrow] = BLUE_YELLOW.map(|(a, b)| {
            (
                a * (PI / b).sqrt() * gaussian(b).iter().sum::<f64>().powi(2),
                gaussian(b),
            )
        });
        let mix = [wide.0 / (wide.0 + narrow.0), narrow.0 / (wide.0 + narrow.0)];
        let sensitivity = [gaussian(ACHROMATIC.1), gaussian(RED_GREEN.1), wide.1, narrow.1].map(|taps| {
            let sum: f64 = taps.iter().sum();
            taps.iter().map(|t| t / sum).collect()
        });

        // Feature detectors: positive taps sum to 1, negative ones to −1.
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let reach = (3.0 * deviation).ceil() as i32;
        let feature = [0, 1, 2].map(|order| {
            let taps = (-reach..=reach).map(|x| {
                let u = f64::from(x) / deviation;
                let polynomial = [1.0, -u, u * u - 1.0][order];
                polynomial * (-u * u / 2.0).exp()
            });
            let taps: Taps = taps.collect();
            let positive: f64 = taps.iter().filter(|t| **t > 0.0).sum();
            let negative: f64 = -taps.iter().filter(|t| **t < 0.0).sum::<f64>();
            taps.into_iter()
                .map(|t| {
                    t / if t > 0.0 {
                        positive
                    } else {
                        negative.max(f64::MIN_POSITIVE)
                    }
                })
                .collect()
        });

        let to_xyz = primaries_to_xyz();
        let mut observer = Self {
            sensitivity,
            mix,
            feature,
            greatest: 1.0,
            from_xyz: inverse(&to_xyz),
            white: apply(&to_xyz, [1.0; 3]),
            to_xyz,
        };
        observer.greatest = hyab(&observer.lab([0.0, 1.0, 0.0]), &observer.lab([0.0, 0.0, 1.0])).powf(Q_C);
        observer
    }

    /// What the observer makes of some rows of an image; beyond the border the image goes on as its outermost pixels.
    fn percept(&self, image: &Image, rows: std::ops::Range<usize>) -> Vec<Percept> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let reach = self.reach();
        let above = rows.start.saturating_sub(reach);
        let source = above..(rows.end + reach).min(height);

        // Along rows: four blurred colour planes, then the lightness under the three feature filters.
        let mut planes: [Vec<f64>; 7] = std::array::from_fn(|_| vec![0.0; source.len() * width]);
        let mut padded = [const { Vec::new() }; 3].map(|_: Vec<f64>| vec![0.0; width + 2 * reach]);
        for (i, y) in source.clone().enumerate() {
            for (x, &pixel) in image.pixels()[y * width..(y + 1) * width].iter().enumerate() {
                for (padded, value) in padded.iter_mut().zip(self.opponent(pixel)) {
                    padded[reach + x] = value;
                }
            }
            for padded in &mut padded {
                let (first, last) = (padded[reach], padded[reach + width - 1]);
                padded[..reach].fill(first);
                padded[reach + width..].fill(last);
            }
            for (k, plane) in planes.iter_mut().enumerate() {
                let (taps, channel) = if k < 4 {
                    (&self.sensitivity[k], k.min(2))
                } else {
                    (&self.feature[k - 4], 0)
                };
                let start = reach - taps.len() / 2;
                let out = &mut plane[i * width..(i + 1) * width];
                for (j, &tap) in taps.iter().enumerate() {
                    accumulate(out, tap, &padded[channel][start + j..start + j + width]);
                }
            }
        }

        // Along columns.
        let mut percepts = vec![Percept::default(); rows.len() * width];
        let mut sums: [Vec<f64>; 8] = std::array::from_fn(|_| vec![0.0; width]);
        // Which plane each sum is of, and the filter across: the colours, then G'x, G'y, G''x, G''y.
        let [smooth, slope, bend] = &self.feature;
        let [a, rg, wide, narrow] = &self.sensitivity;
        let passes = [
            (0, a),
            (1, rg),
            (2, wide),
            (3, narrow),
            (5, smooth),
            (4, slope),
            (6, smooth),
            (4, bend),
        ];
        for (y, out) in rows.zip(percepts.chunks_exact_mut(width)) {
            for (sum, (plane, taps)) in sums.iter_mut().zip(passes) {
                sum.fill(0.0);
                for (j, &tap) in taps.iter().enumerate() {
                    let from = (y + j)
                        .saturating_sub(taps.len() / 2)
                        .clamp(source.start, source.end - 1)
                        - above;
                    accumulate(sum, tap, &planes[plane][from * width..(from + 1) * width]);
                }
            }
            for (x, out) in out.iter_mut().enumerate() {
                let blue_yellow = self.mix[0] * sums[2][x] + self.mix[1] * sums[3][x];
                out.lab = self.lab(self.linear([sums[0][x], sums[1][x], blue_yellow]));
                // The detectors work on lightness from 0 to 1; its offset drops out, being constant.
                out.edge = sums[4][x].hypot(sums[5][x]) / 116.0;
                out.point = sums[6][x].hypot(sums[7][x]) / 116.0;
            }
        }
        percepts
    }

    /// Pixels that the widest filter reaches to each side.
    fn reach(&self) -> usize {
        self.sensitivity
            .iter()
            .chain(&self.feature)
            .map(|taps| taps.len() / 2)
            .max()
            .unwrap_or(0)
    }

    /// Display colour to the linear opponent space YCxCz (lightness, red-green, blue-yellow), in which the eye's blur
    /// is described.
    fn opponent(&self, color: [f64; 3]) -> [f64; 3] {
        let linear = color.map(|v| {
            if !v.is_finite() {
                return f64::NAN;
            }
            let v = f64::from(v.clamp(0.0, 1.0) as f32);
            if v <= 0.04045 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            }
        });
        let [x, y, z] = apply(&self.to_xyz, linear);
        let (x, y, z) = (x / self.white[0], y / self.white[1], z / self.white[2]);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// YCxCz to linear RGB, kept within [0, 1].
    fn linear(&self, [lightness, red_green, blue_yellow]: [f64; 3]) -> [f64; 3] {
        let y = (lightness + 16.0) / 116.0;
        let xyz = [
            (y + red_green / 500.0) * self.white[0],
            y * self.white[1],
            (y - blue_yellow / 200.0) * self.white[2],
        ];
        apply(&self.from_xyz, xyz).map(|v| v.clamp(0.0, 1.0))
    }

    /// Linear RGB to CIELAB, with chroma scaled by a hundredth of the lightness: colours of dark things differ less
    /// (Hunt effect).
    fn lab(&self, linear: [f64; 3]) -> [f64; 3] {
        const DELTA: f64 = 6.0 / 29.0;
        let xyz = apply(&self.to_xyz, linear);
        let [x, y, z] = std::array::from_fn(|i| {
            let t: f64 = xyz[i] / self.white[i];
            if t > DELTA * DELTA * DELTA {
                t.cbrt()
            } else {
                t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
            }
        });
        let lightness = 116.0 * y - 16.0;
        [
            lightness,
            0.01 * lightness * 500.0 * (x - y),
            0.01 * lightness * 200.0 * (y - z),
        ]
    }

    /// The difference of two pixels: that of their colours, raised where features differ.
    fn difference(&self, a: &Percept, b: &Percept) -> f64 {
        let color = hyab(&a.lab, &b.lab).powf(Q_C);
        let knee = P_C * self.greatest;
        let color = if color < knee {
            P_T * color / knee
        } else {
            P_T + (color - knee) / (self.greatest - knee) * (1.0 - P_T)
        };
        // Not f64::max, which would drop a NaN.
        let (edge, point) = ((a.edge - b.edge).abs(), (a.point - b.point).abs());
        let feature = if edge > point { edge } else { point };
        let feature = (feature / std::f64::consts::SQRT_2).powf(Q_F);
        color.powf(1.0 - feature).clamp(0.0, 1.0)
    }
}

/// out += tap · values.
fn accumulate(out: &mut [f64], tap: f64, values: &[f64]) {
    for (out, &value) in out.iter_mut().zip(values) {
        *out += tap * value;
    }
}

/// Distance that takes lightness apart from chroma: |ΔL| + √(Δa² + Δb²).
fn hyab(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn apply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Linear sRGB to CIE XYZ: columns are the primaries, scaled so that their sum is the white of luminance 1.
fn primaries_to_xyz() -> [[f64; 3]; 3] {
    let xyz = |[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y];
    let columns = PRIMARIES.map(xyz);
    let unscaled: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
    let scale = apply(&inverse(&unscaled), xyz(WHITE));
    unscaled.map(|row| std::array::from_fn(|j| row[j] * scale[j]))
}

/// Inverse by cofactors.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// 0 to 255 without visible order; the same arithmetic as in `scripts/flip_reference.py`.
    fn noise(x: i64, y: i64, c: i64, salt: i64) -> i64 {
        let h = (x * 374_761_393 + y * 668_265_263 + c * 2_147_483_647 + salt * 1_274_126_177) & 0xFFFF_FFFF;
        let h = ((h ^ (h >> 13)) * 1_103_515_245) & 0xFFFF_FFFF;
        (h ^ (h >> 16)) & 255
    }

    type Channel = fn(i64, i64, i64) -> i64;

    fn image(width: u32, height: u32, channel: Channel) -> Image {
        let pixels = (0..i64::from(height))
            .flat_map(|y| {
                (0..i64::from(width)).map(move |x| [0, 1, 2].map(|c| f64::from(channel(x, y, c) as f32 / 255.0)))
            })
            .collect();
        Image::new(width, height, pixels).unwrap()
    }

    fn disc(x: i64, y: i64, inside: i64) -> i64 {
        if (x - 20).pow(2) + (y - 17).pow(2) < 150 {
            inside
        } else {
            255
        }
    }

    /// Name, size, both images, and what flip-evaluator says of them: mean, map at the first pixel, at (width/3,
    /// height/2), at the last.
    type Case = (&'static str, u32, u32, Channel, Channel, f64, [f64; 3]);

    /// Printed by `scripts/flip_reference.py` with PyPI flip-evaluator 1.7 (f32 arrays, LDR, sRGB, 67 pixels per
    /// degree).
    const CASES: [Case; 7] = [
        (
            "noise on a gradient",
            61,
            43,
            |x, y, c| (x * (c + 2) + y * 3) % 256,
            |x, y, c| ((x * (c + 2) + y * 3) % 256 + noise(x, y, c, 1) / 8 - 16).clamp(0, 255),
            0.09094811,
            [0.0752472, 0.0843241, 0.1075489],
        ),
        (
            "two noises",
            64,
            48,
            |x, y, c| noise(x, y, c, 2),
            |x, y, c| noise(x, y, c, 3),
            0.43256364,
            [0.7078713, 0.3295628, 0.7057306],
        ),
        (
            "a checkerboard moved by a pixel",
            64,
            48,
            |x, y, c| (x / 6 + y / 6) % 2 * 200 + 20 * c,
            |x, y, c| ((x + 1) / 6 + y / 6) % 2 * 200 + 20 * c,
            0.30432461,
            [0.0870302, 0.1068377, 0.0859274],
        ),
        (
            "a disc on white, slightly off",
            40,
            40,
            |x, y, c| disc(x, y, 200 - 60 * c),
            |x, y, c| disc(x, y, 203 - 60 * c),
            0.02980995,
            [0.0, 0.0870452, 0.0],
        ),
        (
            "green against blue",
            32,
            24,
            |_, _, c| 255 * i64::from(c == 1),
            |_, _, c| 255 * i64::from(c == 2),
            1.0,
            [1.0; 3],
        ),
        (
            "smaller than the filters",
            5,
            3,
            |x, y, c| noise(x, y, c, 4),
            |x, y, c| noise(x, y, c, 5),
            0.61657410,
            [0.6371025, 0.3731822, 0.6282905],
        ),
        (
            "one pixel",
            1,
            1,
            |_, _, c| 10 + 90 * c,
            |_, _, c| 100 - 20 * c,
            0.69897366,
            [0.6989737; 3],
        ),
    ];

    /// Greatest distance of our mean, and of our map at the pinned pixels, from flip-evaluator's over all cases.
    fn worst(pixels_per_degree: f64) -> (f64, f64) {
        let (mut mean, mut pixel) = (0.0f64, 0.0f64);
        for (name, width, height, reference, test, expected, places) in CASES {
            let map = flip_at(
                &image(width, height, reference),
                &image(width, height, test),
                pixels_per_degree,
            )
            .unwrap();
            let at = |x: u32, y: u32| f64::from(map.values()[(y * width + x) as usize]);
            let ours = [at(0, 0), at(width / 3, height / 2), at(width - 1, height - 1)];
            assert!(map.mean().is_finite() && ours.iter().all(|v| v.is_finite()), "{name}");
            let (of_mean, of_pixels) = (
                (map.mean() - expected).abs(),
                ours.iter().zip(places).fold(0.0f64, |w, (a, b)| w.max((a - b).abs())),
            );
            println!(
                "{pixels_per_degree} pixels per degree, {name}: mean off by {of_mean:.1e}, single pixels by \
                    {of_pixels:.1e}"
            );
            (mean, pixel) = (mean.max(of_mean), pixel.max(of_pixels));
        }
        (mean, pixel)
    }

    /// Tolerance 4e-5 for the mean and for single pixels. Control: at 60 pixels per degree the numbers are others by
    /// more than 1e-3.
    #[test]
    fn agrees_with_flip_evaluator() {
        let (mean, pixel) = worst(PIXELS_PER_DEGREE);
        assert!(mean <= 4e-5, "mean off by {mean}");
        assert!(pixel <= 4e-5, "a pixel is off by {pixel}");
        let (mean, pixel) = worst(60.0);
        assert!(mean > 1e-3 && pixel > 1e-3, "{mean} {pixel}");
    }

    /// Bands must not show: one row more or less in the image changes nothing far from it.
    #[test]
    fn bands_leave_no_seam() {
        let (a, b): (Channel, Channel) = (|x, y, c| noise(x, y, c, 2), |x, y, c| noise(x, y, c, 3));
        let (short, long) = (BAND as u32 + 12, BAND as u32 + 40);
        let short = flip(&image(9, short, a), &image(9, short, b)).unwrap();
        let long = flip(&image(9, long, a), &image(9, long, b)).unwrap();
        assert_eq!(short.values()[..BAND * 9], long.values()[..BAND * 9]);
        assert_ne!(
            short.values()[BAND * 9..],
            long.values()[BAND * 9..short.values().len()]
        );
    }

    proptest! {
        /// Within [0, 1], the same both ways, and 0 between equal images; values far outside [0, 1] are clamped.
        #[test]
        fn bounded_symmetric_and_zero_for_equal_images(width in 1u32..30, height in 1u32..30, salt in any::<u64>(),
            scale in 0.0f64..3.0) {
            let pixels = |purpose: i64| -> Vec<[f64; 3]> {
                let salt = (salt % 1000) as i64;
                (0..i64::from(width * height)).map(|p| [0, 1, 2].map(|c| scale * (noise(p, purpose, c,
                    salt) as f64 / 255.0) - 0.2)).collect()
            };
            let a = Image::new(width, height, pixels(0)).unwrap();
            let b = Image::new(width, height, pixels(1)).unwrap();
            prop_assert!(flip(&a, &a).unwrap().values().iter().all(|&v| v == 0.0));
            let map = flip(&a, &b).unwrap();
            prop_assert!(map.values().iter().all(|v| (0.0..=1.0).contains(v)));
            prop_assert_eq!(&map, &flip(&b, &a).unwrap());
            prop_assert!((0.0..=1.0).contains(&map.mean()));
        }
    }

    #[test]
    fn a_pixel_that_is_not_finite_is_seen() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let reference = image(40, 40, |_, _, _| 128);
            let mut pixels = reference.pixels().to_vec();
            pixels[20 * 40 + 20][1] = bad;
            let map = flip(&reference, &Image::new(40, 40, pixels).unwrap()).unwrap();
            assert!(map.mean().is_nan());
            assert!(map.values()[20 * 40 + 20].is_nan() && map.values()[0] == 0.0);
        }
    }

    #[test]
    fn images_of_different_size_are_refused() {
        let error = flip(&image(2, 3, |_, _, _| 0), &image(3, 2, |_, _, _| 0)).unwrap_err();
        assert!(matches!(
            error,
            EvaluateError::SizesDiffer {
                reference: (2, 3),
                test: (3, 2)
            }
        ));
    }
}
