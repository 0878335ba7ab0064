//! Core and tail without a network: single fragments of a pixel, and the sums of all others shared out by the beta law.

use super::capabilities::{Capabilities, Needs};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError, MethodShader};
use crate::features::core::CoreSet;
use crate::features::core::code::MAX_HEAVY;
use crate::infer::core::{Tail, run};
use crate::infer::{Class, Switches};
use crate::pixel::{FragmentList, LogWarp, ViewZ};

/// Name on the command line.
pub const ENTRY: Entry = Entry {
    head: "core",
    pattern: "core:HEAVY",
    source: "ours, after Maule, Comba, Torchelsen, Bastos, I3D 2013",
    names,
    build,
};

/// A method that keeps single fragments by a chain of atomics besides the sums of all others and their number. Slots
/// are read two at a time, so that a buffer holds an even number. Without heavy fragments blending keeps both ends.
pub(super) fn capabilities(set: &CoreSet) -> Capabilities {
    let of_sums = Capabilities::of_sums(set.moments as u32 + 2, false);
    Capabilities {
        bits_per_pixel: of_sums.bits_per_pixel.map(|bits| bits + 32 * set.stride() as u32),
        needs: Needs {
            atomics: !set.is_blended(),
            ..of_sums.needs
        },
        ..of_sums
    }
}

/// Moments: the beta law has a mean and a spread.
const MOMENTS: usize = 2;

fn names(head: &str) -> Vec<String> {
    ["4", "6"].iter().map(|k| format!("{head}:{k}")).collect()
}

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    match arguments.argument.and_then(|k| k.parse::<usize>().ok()) {
        Some(heavy) if heavy <= MAX_HEAVY => Ok(Box::new(Core {
            set: CoreSet::new(heavy, MOMENTS),
        })),
        _ => Err(arguments.wrong(format!("expected a number of heavy fragments from 0 to {MAX_HEAVY}"))),
    }
}

/// The nearest, the farthest and the heaviest fragments, and the tail by the beta law; see
/// [`features::core`](crate::features::core).
struct Core {
    set: CoreSet,
}

struct Answers<'a> {
    list: &'a FragmentList,
    transmittance: Vec<f32>,
}

impl Accumulated for Answers<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        for (out, &t) in out.iter_mut().zip(&self.transmittance[self.list.range(p)]) {
            *out = t.into();
        }
    }
}

impl Method for Core {
    fn name(&self) -> String {
        format!("core:{}", self.set.heavy)
    }

    fn capabilities(&self) -> Capabilities {
        capabilities(&self.set)
    }

    fn shader(&self) -> Option<MethodShader> {
        Some(MethodShader::of_core(self.name(), self.set))
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        let (v0, v1) = context.depth_range.or(list.depth_range()).unwrap_or((1.0, 1.0));
        LogWarp::new(ViewZ(v0.into()), ViewZ(v1.into())).map_err(|source| MethodError::Depth {
            method: self.name(),
            source,
        })?;
        let codes = self.set.layout.codes(v0, v1);
        let mut transmittance = vec![0.0; list.len()];
        let mut classes = vec![Class::Known; list.len()];
        let pixels = 0..list.pixels();
        let switches = Switches::default();
        run(
            (&self.set, &codes),
            Tail::Law,
            list,
            pixels,
            switches,
            &mut transmittance,
            &mut classes,
        );
        Ok(Box::new(Answers { list, transmittance }))
    }
}
