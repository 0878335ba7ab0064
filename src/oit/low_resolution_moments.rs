//! Sharpe's moment transparency with moments at a fraction of the resolution.

use super::capabilities::{Capabilities, sums, targets};
use super::moment_based::{NOTHING_ELSE, Sample, ends, exact, samples, sort, warp};
use super::moment_power::add;
use super::moment_transparency::{BIAS, unit, unit_depth};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError};
use crate::moments::hamburger::PowerCurve;
use crate::pixel::{FragmentList, LogWarp, ViewZ, absorbance, abuffer};
use rayon::prelude::*;

/// Name on the command line.
pub const ENTRY: Entry = Entry {
    head: "low-resolution-moments",
    pattern: "low-resolution-moments:2|4|8[+own]",
    source: "Sharpe, HPG 2018",
    names,
    build,
};

fn names(head: &str) -> Vec<String> {
    ["2", "4", "8"]
        .iter()
        .flat_map(|n| [format!("{head}:{n}"), format!("{head}:{n}+own")])
        .collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    let factor = match arguments.argument {
        Some("2") => 2,
        Some("4") => 4,
        Some("8") => 8,
        _ => return Err(arguments.wrong("expected 2, 4 or 8")),
    };
    Ok(Box::new(LowResolution {
        factor,
        own: arguments.own,
    }))
}

/// Four moments of blocks of N × N pixels, looked up with bilinear filtering.
///
/// A block holds the mean of the moments of its pixels. Sha18 draws the low-resolution pass against the *greatest*
/// opaque depth of the block, so that no fragment that some pixel of it shows is lost; a fragment list holds what each
/// pixel shows, and the mean loses none of it either.
///
/// # Source
/// Sha18 Sec. 4.1.
struct LowResolution {
    factor: usize,
    own: bool,
}

impl Method for LowResolution {
    fn name(&self) -> String {
        format!(
            "low-resolution-moments:{}{}",
            self.factor,
            if self.own { "+own" } else { "" }
        )
    }

    /// Sha18 Table 1: five numbers a block, and coverage at full resolution.
    fn capabilities(&self) -> Capabilities {
        let block = (self.factor * self.factor) as u32;
        Capabilities {
            bits_per_pixel: Some(sums(5).div_ceil(block) + targets(1, self.own)),
            ..Capabilities::of_sums(5, false)
        }
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let (width, height) = list.size().ok_or_else(|| MethodError::NoSize { method: self.name() })?;
        let (width, height) = (width as usize, height as usize);
        let warp = warp(&|| self.name(), list, &context)?;
        let (columns, rows) = (width.div_ceil(self.factor), height.div_ceil(self.factor));
        let block = |index: usize| {
            let (x0, y0) = (index % columns * self.factor, index / columns * self.factor);
            let (x1, y1) = ((x0 + self.factor).min(width), (y0 + self.factor).min(height));
            let mut b = [0.0; 5];
            for p in (y0..y1).flat_map(|y| (x0..x1).map(move |x| y * width + x)) {
                let mut samples = samples(&warp, list.pixel(p));
                sort(&mut samples);
                for sample in samples {
                    add(&mut b, unit(sample));
                }
            }
            let count = ((x1 - x0) * (y1 - y0)) as f64;
            Block {
                moments: b.map(|b| b / count),
                share: 1.0 / count,
            }
        };
        let blocks = (0..columns * rows).into_par_iter().map(block).collect();
        Ok(Box::new(Blocks {
            method: self,
            list,
            warp,
            width,
            columns,
            rows,
            blocks,
        }))
    }
}

/// Mean moments of a block's pixels and the share that one pixel has in them.
struct Block {
    moments: [f64; 5],
    share: f64,
}

struct Blocks<'a> {
    method: &'a LowResolution,
    list: &'a FragmentList,
    warp: LogWarp,
    width: usize,
    columns: usize,
    rows: usize,
    blocks: Vec<Block>,
}

/// The two blocks between whose centres a pixel lies, and the weight of the second.
fn neighbours(pixel: usize, factor: usize, count: usize) -> (usize, usize, f64) {
    let place = (pixel as f64 + 0.5) / factor as f64 - 0.5;
    let low = place.floor();
    let clamp = |i: f64| (i.max(0.0) as usize).min(count - 1);
    (clamp(low), clamp(low + 1.0), place - low)
}

impl Blocks<'_> {
    /// Filtered moments at pixel p, and the share that p's own fragments have in them.
    fn filtered(&self, p: usize) -> ([f64; 5], f64) {
        let factor = self.method.factor;
        let (x, y) = (p % self.width, p / self.width);
        let ((x0, x1, u), (y0, y1, v)) = (neighbours(x, factor, self.columns), neighbours(y, factor, self.rows));
        let own = y / factor * self.columns + x / factor;
        let (mut b, mut share) = ([0.0; 5], 0.0);
        for (x, y, weight) in [
            (x0, y0, (1.0 - u) * (1.0 - v)),
            (x1, y0, u * (1.0 - v)),
            (x0, y1, (1.0 - u) * v),
            (x1, y1, u * v),
        ] {
            let index = y * self.columns + x;
            let block = &self.blocks[index];
            for (b, m) in b.iter_mut().zip(block.moments) {
                *b += weight * m;
            }
            if index == own {
                share += weight * block.share;
            }
        }
        (b, share)
    }
}

impl Accumulated for Blocks<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        let pixel = self.list.pixel(p);
        let (b, share) = self.filtered(p);
        let total = abuffer::total_absorbance(pixel);
        if total == 0.0 {
            out.fill(1.0);
            return;
        }
        let curve = PowerCurve::<f64, 2>::new(&b, &BIAS);
        let ends = ends(pixel);
        for ((out, &v), &alpha) in out.iter_mut().zip(pixel.view_z).zip(pixel.alpha) {
            let z = self.warp.moment(ViewZ(v.into()));
            if !self.method.own {
                *out = curve.transmittance(unit_depth(z), 0.0);
                continue;
            }
            let own = absorbance(alpha);
            *out = exact(v, ends, own, total).unwrap_or_else(|| {
                let mut others = b;
                add(
                    &mut others,
                    unit(Sample {
                        z,
                        absorbance: -own * share,
                    }),
                );
                if others[0] <= NOTHING_ELSE * b[0] {
                    return 1.0;
                }
                PowerCurve::<f64, 2>::new(&others, &BIAS).transmittance(unit_depth(z), 0.0)
            });
        }
    }
}
