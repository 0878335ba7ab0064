//! Constants of recentred networks in shader source.

use super::dialect::Wgsl;
pub use crate::features::recentred::source::{FAINT_SWITCH, HIDDEN_SWITCH, ROUNDING};
use crate::numeric::source::{Dialect, Type};

/// WGSL of a recentred network whose sums are rounded to `unit` of b0 where they are stored, instead of as f32; other
/// source stays as it is.
pub fn with_rounding(wgsl: &str, unit: f32) -> String {
    let constant = |unit| Wgsl.constant(Type::Real, ROUNDING, &Wgsl.number(unit));
    wgsl.replace(&constant(f32::EPSILON), &constant(unit))
}
