//! The shading languages, a file each: how one spells what formulas and networks are made of, and all else that is
//! known of it as a target. A new one is a file here, its `mod` and its line in the table of targets.

mod glsl;
mod hlsl;
mod metal;
mod spirv;
mod wgsl;

pub use glsl::Glsl;
pub use hlsl::Hlsl;
pub use wgsl::Wgsl;

use super::target::{Description, JSON, targets};
use super::{Precision, onnx};
use crate::numeric::source::{Dialect, Type};

targets! {
    Wgsl: wgsl::TARGET, "WGSL, WebGPU's language.";
    Glsl: glsl::TARGET, "GLSL of OpenGL, OpenGL ES, WebGL 2 and Vulkan.";
    Hlsl: hlsl::TARGET, "HLSL, Direct3D's language.";
    Metal: metal::TARGET, "Metal's language, through naga.";
    Spirv: spirv::TARGET, "A SPIR-V module with compute shaders, through naga.";
    Json: JSON, "The model file.";
    Onnx: onnx::TARGET, "ONNX.";
}

/// A shading language that networks are written in.
pub trait ShadingLanguage: Dialect {
    /// This language as a writer of formulas takes it.
    fn dialect(&self) -> &'static dyn Dialect;
    /// A literal that parses back to the same bits: the shortest decimal that names the f32.
    fn literal(&self, x: f32) -> String;
    /// A number of a precision.
    fn scalar(&self, precision: Precision) -> &'static str;
    /// Four numbers of a precision.
    fn vec4(&self, precision: Precision) -> String;
    /// Sixteen numbers of a precision, which a block of 4 × 4 weights is kept in, input by input: the columns of a
    /// matrix, but HLSL's rows.
    fn mat4(&self, precision: Precision) -> String;
    /// A block of weights times four activations.
    fn product(&self, block: &str, activations: &str) -> String {
        format!("{block} * {activations}")
    }
    /// Four times the number of a literal.
    fn splat(&self, precision: Precision, literal: &str) -> String {
        format!("{}({literal})", self.vec4(precision))
    }
    /// A statement that names a value of a type of either precision.
    fn bind(&self, of: &str, name: &str, value: &str) -> String {
        format!("    {of} {name} = {value};\n")
    }
    /// `const NAME: TYPE = value;` of a scalar.
    fn scalar_constant(&self, precision: Precision, name: &str, literal: &str) -> String;
    /// What stands before and behind the items of a constant array.
    fn array_constant(&self, name: &str, element: &str, items: usize) -> [String; 2];
    /// What a line of the comment at the head of a file begins with.
    fn comment(&self) -> &'static str {
        "//"
    }
    /// What the head of a file says about the language.
    fn notes(&self, _: Precision) -> Vec<String> {
        Vec::new()
    }
    /// A file of this text: its directives, and what keeps a second inclusion from declaring everything again.
    fn file(&self, text: &str, precision: Precision, guard: &str) -> String;
}

/// Name of the columns of a value of [`Type::Reals`] of more than four numbers, as `mat2x4`.
fn matrix(name: &str, numbers: usize) -> String {
    assert!((5..=16).contains(&numbers), "{numbers} numbers in one value");
    format!("{name}{}x4", numbers.div_ceil(4))
}

/// Every parameter of a function.
fn list_of(language: &dyn Dialect, parameters: &[(&str, Type)]) -> String {
    let list: Vec<String> = parameters
        .iter()
        .map(|&(name, of)| language.parameter(&language.type_name(of), name))
        .collect();
    list.join(", ")
}

/// `struct` as languages have it that put the type first.
fn structure(language: &dyn Dialect, name: &str, fields: &[(String, &str, Type)]) -> String {
    let fields: String = fields
        .iter()
        .map(|(about, name, of)| format!("{about}    {} {name};\n", language.type_name(*of)))
        .collect();
    format!("struct {name} {{\n{fields}}};\n")
}

/// The text between the lines that keep a second inclusion out.
fn guarded(text: &str, guard: &str) -> String {
    format!("#ifndef {guard}\n#define {guard}\n\n{text}\n#endif\n")
}
