//! WebGPU's language.

use super::Language;
use crate::export::Precision;
use crate::features::MomentDepthKind;
use crate::numeric::source::{Dialect, Type};

/// WGSL.
#[derive(Debug, Clone, Copy)]
pub struct Wgsl;

impl Wgsl {
    /// A type with its number of items.
    fn whole_type(self, of: Type) -> String {
        match of {
            Type::Reals(n) | Type::Words(n) => format!("array<{}, {n}>", self.type_name(of)),
            _ => self.type_name(of),
        }
    }
}

impl Dialect for Wgsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(_) => "f32",
            Type::Word | Type::Words(_) => "u32",
            Type::Truth => "bool",
            Type::Vec4 => "vec4<f32>",
            Type::Word4 => "vec4<u32>",
        }
        .to_owned()
    }

    fn let_(&self, _: Type, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn variable(&self, _: Type, name: &str, value: &str) -> String {
        format!("var {name} = {value};")
    }

    fn constant(&self, of: Type, name: &str, value: &str) -> String {
        format!("const {name}: {} = {value};", self.type_name(of))
    }

    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        format!("select({no}, {yes}, {condition})")
    }

    fn head(&self, name: &str, parameters: &[(&str, Type)], result: Type) -> String {
        let list = parameters
            .iter()
            .map(|&(name, of)| format!("{name}: {}", self.whole_type(of)));
        let list = list.collect::<Vec<_>>().join(", ");
        format!("fn {name}({list}) -> {}", self.whole_type(result))
    }

    fn array(&self, of: Type, _: &str, items: &[String]) -> (Option<String>, String) {
        (None, format!("{}({})", self.whole_type(of), items.join(", ")))
    }

    fn return_array(&self, of: Type, items: &[String]) -> Vec<String> {
        vec![format!("return {}({});", self.whole_type(of), items.join(", "))]
    }

    fn call_array(&self, _: Type, name: &str, function: &str, arguments: &[String]) -> Vec<String> {
        vec![format!("let {name} = {function}({});", arguments.join(", "))]
    }

    fn to_bits(&self, number: &str) -> String {
        format!("bitcast<u32>({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("bitcast<f32>({word})")
    }
}

impl Language for Wgsl {
    fn scalar(&self, precision: Precision) -> &'static str {
        match precision {
            Precision::F32 => "f32",
            Precision::F16 => "f16",
        }
    }

    fn vec4(&self, precision: Precision) -> String {
        format!("vec4<{}>", self.scalar(precision))
    }

    fn mat4(&self, precision: Precision) -> String {
        format!("mat4x4<{}>", self.scalar(precision))
    }

    fn named(&self, _: &str, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn module_constant(&self, of: &str, name: &str, value: &str) -> String {
        format!("const {name}: {of} = {value};\n")
    }

    fn module_array(&self, element: &str, name: &str, count: usize) -> (String, &'static str) {
        (format!("const {name} = array<{element}, {count}>(\n"), "\n);\n")
    }

    fn directives(&self, precision: Precision) -> &'static str {
        match precision {
            Precision::F32 => "",
            Precision::F16 => "enable f16;\n\n",
        }
    }

    /// Modules are not included; linkers know them by their names.
    fn guarded(&self, _: &str, text: String) -> String {
        text
    }

    fn calls(&self, depth: MomentDepthKind) -> Option<&'static str> {
        match depth {
            MomentDepthKind::Log => Some(include_str!("../calls/recentred.wgsl")),
            MomentDepthKind::Window => Some(include_str!("../calls/paper.wgsl")),
            MomentDepthKind::None => None,
        }
    }

    fn resolve(&self) -> &'static str {
        include_str!("../calls/resolve.wgsl")
    }

    fn member(&self, name: &str, of: Type) -> String {
        format!("{},", self.declared(name, of))
    }

    fn declared(&self, name: &str, of: Type) -> String {
        format!("{name}: {}", self.whole_type(of))
    }
}
