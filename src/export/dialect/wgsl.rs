//! WebGPU's language.

use super::{Precision, ShadingLanguage, list_of, matrix};
use crate::export::shader;
use crate::export::target::{Description, Reader, names, suffixes};
use crate::numeric::source::{Dialect, Type};

/// WGSL.
#[derive(Debug, Clone, Copy)]
pub struct Wgsl;

/// WGSL as a target.
pub(super) const TARGET: Description = Description {
    title: "WGSL",
    names: names!("wgsl"),
    suffixes: suffixes!("wgsl"),
    language: Some(&Wgsl),
    text: true,
    plain: true,
    half: true,
    write: shader::encode,
    reader: Reader::Wgsl,
};

impl Dialect for Wgsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(1) => "f32".to_owned(),
            Type::Word => "u32".to_owned(),
            Type::Truth => "bool".to_owned(),
            Type::Vec4 => "vec4<f32>".to_owned(),
            Type::Word2 => "vec2<u32>".to_owned(),
            Type::Word4 => "vec4<u32>".to_owned(),
            Type::Reals(n @ 2..=4) => format!("vec{n}<f32>"),
            Type::Reals(n) => matrix("mat", n) + "<f32>",
        }
    }

    fn parameter(&self, of: &str, name: &str) -> String {
        format!("{name}: {of}")
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

    /// A lone "less than" is turned round, since some linkers take `<` with a later `>` for a list of templates.
    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        let lone = !condition.contains("&&") && !condition.contains("||");
        let turned = [(" < ", ">"), (" <= ", ">=")].into_iter().find_map(|(less, greater)| {
            let (a, b) = condition.split_once(less)?;
            lone.then(|| format!("{b} {greater} {a}"))
        });
        format!("select({no}, {yes}, {})", turned.as_deref().unwrap_or(condition))
    }

    fn head(&self, name: &str, parameters: &[(&str, Type)], result: &str) -> String {
        format!("fn {name}({}) -> {result}", list_of(self, parameters))
    }

    fn structure(&self, name: &str, fields: &[(String, &str, Type)]) -> String {
        let fields: String = fields
            .iter()
            .map(|(about, name, of)| format!("{about}    {name}: {},\n", self.type_name(*of)))
            .collect();
        format!("struct {name} {{\n{fields}}}\n")
    }

    fn return_structure(&self, name: &str, values: &[(&str, String)]) -> Vec<String> {
        let values: Vec<&str> = values.iter().map(|(_, value)| value.as_str()).collect();
        vec![format!("return {name}({});", values.join(", "))]
    }

    fn to_bits(&self, number: &str) -> String {
        format!("bitcast<u32>({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("bitcast<f32>({word})")
    }
}

impl ShadingLanguage for Wgsl {
    fn dialect(&self) -> &'static dyn Dialect {
        &Self
    }

    fn literal(&self, x: f32) -> String {
        format!("{x:?}f")
    }

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

    fn bind(&self, _: &str, name: &str, value: &str) -> String {
        format!("    let {name} = {value};\n")
    }

    fn scalar_constant(&self, precision: Precision, name: &str, literal: &str) -> String {
        format!("const {name}: {} = {literal};\n", self.scalar(precision))
    }

    fn array_constant(&self, name: &str, element: &str, items: usize) -> [String; 2] {
        [
            format!("const {name} = array<{element}, {items}>(\n"),
            "\n);\n".to_owned(),
        ]
    }

    fn file(&self, text: &str, precision: Precision, _: &str) -> String {
        match precision {
            Precision::F32 => text.to_owned(),
            Precision::F16 => format!("enable f16;\n\n{text}"),
        }
    }
}
