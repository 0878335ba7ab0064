//! Fourier opacity mapping.

use super::Method;
use super::capabilities::Capabilities;
use super::moment_based::{MomentBased, PerPixel, Sample};
use super::registry::{Arguments, Entry, ParseError};
use crate::pixel::MomentDepth;
use std::f64::consts::PI;

/// Most harmonics.
const MOST: usize = 32;

/// Name on the command line; 3 and 7 harmonics are the 7 and 15 coefficients of MKKP18 Table 2.
pub const ENTRY: Entry = Entry {
    head: "fourier-opacity",
    pattern: "fourier-opacity:HARMONICS[+own]",
    source: "Jansen, Bavoil, I3D 2010",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    ["3", "7"]
        .iter()
        .flat_map(|k| [format!("{head}:{k}"), format!("{head}:{k}+own")])
        .collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    match arguments.argument.and_then(|k| k.parse::<usize>().ok()) {
        Some(harmonics) if (1..=MOST).contains(&harmonics) => Ok(Box::new(PerPixel {
            family: FourierOpacity { harmonics },
            own: arguments.own,
        })),
        _ => Err(arguments.wrong("expected a number of harmonics from 1 to 32")),
    }
}

/// The density of absorbance over depth as a truncated Fourier series, integrated up to a depth; an integral that rings
/// below nothing is nothing.
///
/// # Source
/// J. Jansen, L. Bavoil, *Fourier opacity mapping*, I3D 2010.
struct FourierOpacity {
    harmonics: usize,
}

/// a_0/2 = Σ A, a_k = 2 Σ A cos 2πkd and b_k = 2 Σ A sin 2πkd, d in [0, 1].
#[derive(Debug, Clone, Copy)]
struct Series {
    total: f64,
    a: [f64; MOST],
    b: [f64; MOST],
}

/// Calls f(k, sin 2πkd, cos 2πkd) for k = 1..=harmonics.
fn harmonics(count: usize, MomentDepth(z): MomentDepth, mut f: impl FnMut(usize, f64, f64)) {
    let (sin, cos) = libm::sincos(PI * (z + 1.0));
    let (mut s, mut c) = (sin, cos);
    for k in 1..=count {
        f(k, s, c);
        (s, c) = (s * cos + c * sin, c * cos - s * sin);
    }
}

impl FourierOpacity {
    fn add(&self, series: &mut Series, sample: Sample) {
        series.total += sample.absorbance;
        harmonics(self.harmonics, sample.z, |k, sin, cos| {
            series.a[k - 1] += 2.0 * sample.absorbance * cos;
            series.b[k - 1] += 2.0 * sample.absorbance * sin;
        });
    }
}

impl MomentBased for FourierOpacity {
    type Moments = Series;
    type Curve = Series;

    fn name(&self) -> String {
        format!("fourier-opacity:{}", self.harmonics)
    }

    /// One number and two a harmonic, in f32; here they are not rounded.
    fn capabilities(&self, own: bool) -> Capabilities {
        Capabilities::of_sums(2 * self.harmonics as u32 + 1, own)
    }

    fn accumulate(&self, samples: &[Sample]) -> Series {
        let mut series = Series {
            total: 0.0,
            a: [0.0; MOST],
            b: [0.0; MOST],
        };
        for &sample in samples {
            self.add(&mut series, sample);
        }
        series
    }

    fn total(&self, series: &Series) -> f64 {
        series.total
    }

    fn without(&self, series: &Series, own: Sample) -> Series {
        let mut others = *series;
        self.add(
            &mut others,
            Sample {
                absorbance: -own.absorbance,
                ..own
            },
        );
        others
    }

    fn curve(&self, series: &Series) -> Series {
        *series
    }

    fn transmittance(&self, series: &Series, z: MomentDepth) -> f64 {
        let mut absorbance = series.total * 0.5 * (z.0 + 1.0);
        harmonics(self.harmonics, z, |k, sin, cos| {
            absorbance += (series.a[k - 1] * sin + series.b[k - 1] * (1.0 - cos)) / (2.0 * PI * k as f64);
        });
        libm::exp(-absorbance).min(1.0)
    }
}
