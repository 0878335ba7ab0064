//! OpenGL's and Vulkan's language.

use super::{Precision, ShadingLanguage, guarded, list_of, matrix, structure};
use crate::export::shader;
use crate::export::target::{Description, Reader, names, suffixes};
use crate::numeric::source::{Dialect, Type};

/// GLSL; 4.50 and ES 3.00 read it.
#[derive(Debug, Clone, Copy)]
pub struct Glsl;

/// GLSL as a target. There is no f16: no compiler that could execute GLSL in f16 on the CPU reads it.
pub(super) const TARGET: Description = Description {
    title: "GLSL",
    names: names!("glsl"),
    suffixes: suffixes!("glsl"),
    language: Some(&Glsl),
    text: true,
    plain: true,
    half: false,
    write: shader::encode,
    reader: Reader::Glsl,
};

impl Dialect for Glsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(1) => "float".to_owned(),
            Type::Word => "uint".to_owned(),
            Type::Truth => "bool".to_owned(),
            Type::Vec4 => "vec4".to_owned(),
            Type::Word2 => "uvec2".to_owned(),
            Type::Word4 => "uvec4".to_owned(),
            Type::Reals(n @ 2..=4) => format!("vec{n}"),
            Type::Reals(n) => matrix("mat", n),
        }
    }

    fn let_(&self, of: Type, name: &str, value: &str) -> String {
        format!("{} {name} = {value};", self.type_name(of))
    }

    fn variable(&self, of: Type, name: &str, value: &str) -> String {
        self.let_(of, name, value)
    }

    fn constant(&self, of: Type, name: &str, value: &str) -> String {
        format!("const {} {name} = {value};", self.type_name(of))
    }

    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        format!("({condition} ? {yes} : {no})")
    }

    fn head(&self, name: &str, list: &[(&str, Type)], result: &str) -> String {
        format!("{result} {name}({})", list_of(self, list))
    }

    fn structure(&self, name: &str, fields: &[(String, &str, Type)]) -> String {
        structure(self, name, fields)
    }

    fn return_structure(&self, name: &str, values: &[(&str, String)]) -> Vec<String> {
        let values: Vec<&str> = values.iter().map(|(_, value)| value.as_str()).collect();
        vec![format!("return {name}({});", values.join(", "))]
    }

    fn to_bits(&self, number: &str) -> String {
        format!("floatBitsToUint({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("uintBitsToFloat({word})")
    }
}

impl ShadingLanguage for Glsl {
    fn dialect(&self) -> &'static dyn Dialect {
        &Self
    }

    fn literal(&self, x: f32) -> String {
        format!("{x:?}")
    }

    fn scalar(&self, _: Precision) -> &'static str {
        "float"
    }

    fn vec4(&self, _: Precision) -> String {
        "vec4".to_owned()
    }

    fn mat4(&self, _: Precision) -> String {
        "mat4".to_owned()
    }

    fn scalar_constant(&self, precision: Precision, name: &str, literal: &str) -> String {
        format!("const {} {name} = {literal};\n", self.scalar(precision))
    }

    fn array_constant(&self, name: &str, element: &str, items: usize) -> [String; 2] {
        [
            format!("const {element} {name}[{items}] = {element}[{items}](\n"),
            "\n);\n".to_owned(),
        ]
    }

    /// GLSL ES has no default precision in fragment shaders.
    fn file(&self, text: &str, _: Precision, guard: &str) -> String {
        let precision = "#ifdef GL_ES\nprecision highp float;\nprecision highp int;\n#endif\n\n";
        guarded(&format!("{precision}{text}"), guard)
    }
}
