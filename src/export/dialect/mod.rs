//! The shading languages, a file each: how one spells formulas, layers of weights, and the calls of the passes.

mod glsl;
mod hlsl;
mod wgsl;

pub use glsl::Glsl;
pub use hlsl::Hlsl;
pub use wgsl::Wgsl;

use super::Precision;
use crate::features::MomentDepthKind;
use crate::numeric::source::{Dialect, Type};

/// What an export needs of a language beside the spelling of formulas.
pub trait Language: Dialect + std::fmt::Debug {
    /// The type of a number.
    fn scalar(&self, precision: Precision) -> &'static str;
    /// The type of four numbers.
    fn vec4(&self, precision: Precision) -> String;
    /// The type of a matrix of 4 × 4 numbers.
    fn mat4(&self, precision: Precision) -> String;
    /// A literal in single precision that parses back to the same bits.
    fn literal(&self, x: f32) -> String {
        format!("{x:?}f")
    }
    /// A vector of four equal numbers.
    fn splat(&self, vec4: &str, literal: &str) -> String {
        format!("{vec4}({literal})")
    }
    /// A block of weights times four activations. Blocks are written input by input: the columns of a matrix, but
    /// HLSL's rows.
    fn product(&self, block: &str, activations: &str) -> String {
        format!("{block} * {activations}")
    }
    /// `let name = value;`, with the type where the language wants it.
    fn named(&self, of: &str, name: &str, value: &str) -> String {
        format!("{of} {name} = {value};")
    }
    /// A constant of the module.
    fn module_constant(&self, of: &str, name: &str, value: &str) -> String;
    /// A constant array of the module: what stands before its items, and behind them.
    fn module_array(&self, element: &str, name: &str, count: usize) -> (String, &'static str);
    /// What must stand at the head of source with numbers of this precision.
    fn directives(&self, precision: Precision) -> &'static str {
        let _ = precision;
        ""
    }
    /// An include file that may be included twice, by a macro of its own.
    fn guarded(&self, guard: &str, text: String) -> String;
    /// What is to be known of the language.
    fn notes(&self) -> &'static [&'static str] {
        &[]
    }
    /// What is to be known of it with hidden layers in f16.
    fn half_notes(&self) -> &'static [&'static str] {
        &[]
    }
    /// Text of pass 1 and pass 2 in one call each, for moments of this depth; none where there are no passes.
    fn calls(&self, depth: MomentDepthKind) -> Option<&'static str>;
    /// Text of the resolve in one call.
    fn resolve(&self) -> &'static str;
    /// A member of a struct, with what stands behind it.
    fn member(&self, name: &str, of: Type) -> String {
        format!("{};", self.parameter(name, of))
    }
    /// A parameter of a function.
    fn declared(&self, name: &str, of: Type) -> String {
        self.parameter(name, of)
    }
    /// The values of a struct's first members, as arguments of its constructor or as statements.
    fn members(&self, of: &str, values: &[(String, String)]) -> String {
        let _ = of;
        values
            .iter()
            .map(|(_, value)| value.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    }
}
