//! Direct3D's language.

use super::{Precision, ShadingLanguage, guarded, list_of, matrix, structure};
use crate::export::shader;
use crate::export::target::{Description, Reader, names, suffixes};
use crate::numeric::source::{Dialect, Type};

/// HLSL, shader model 5 and later. More than four numbers are the rows of a matrix, where other languages have columns:
/// `m[0]` is the first four of them in all.
#[derive(Debug, Clone, Copy)]
pub struct Hlsl;

/// HLSL as a target.
pub(super) const TARGET: Description = Description {
    title: "HLSL",
    names: names!("hlsl"),
    suffixes: suffixes!("hlsl"),
    language: Some(&Hlsl),
    text: true,
    plain: true,
    half: true,
    write: shader::encode,
    reader: Reader::Hlsl,
};

impl Dialect for Hlsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(1) => "float".to_owned(),
            Type::Word => "uint".to_owned(),
            Type::Truth => "bool".to_owned(),
            Type::Vec4 => "float4".to_owned(),
            Type::Word2 => "uint2".to_owned(),
            Type::Word4 => "uint4".to_owned(),
            Type::Reals(n @ 2..=4) => format!("float{n}"),
            Type::Reals(n) => matrix("float", n),
        }
    }

    fn let_(&self, of: Type, name: &str, value: &str) -> String {
        format!("{} {name} = {value};", self.type_name(of))
    }

    fn variable(&self, of: Type, name: &str, value: &str) -> String {
        self.let_(of, name, value)
    }

    fn constant(&self, of: Type, name: &str, value: &str) -> String {
        format!("static const {} {name} = {value};", self.type_name(of))
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
        let mut statements = vec![format!("{name} result;")];
        statements.extend(values.iter().map(|(name, value)| format!("result.{name} = {value};")));
        statements.push("return result;".to_owned());
        statements
    }

    fn to_bits(&self, number: &str) -> String {
        format!("asuint({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("asfloat({word})")
    }
}

impl ShadingLanguage for Hlsl {
    fn dialect(&self) -> &'static dyn Dialect {
        &Self
    }

    fn literal(&self, x: f32) -> String {
        format!("{x:?}f")
    }

    fn scalar(&self, precision: Precision) -> &'static str {
        match precision {
            Precision::F32 => "float",
            Precision::F16 => "half",
        }
    }

    fn vec4(&self, precision: Precision) -> String {
        format!("{}4", self.scalar(precision))
    }

    fn mat4(&self, precision: Precision) -> String {
        format!("{}4x4", self.scalar(precision))
    }

    fn product(&self, block: &str, activations: &str) -> String {
        format!("mul({activations}, {block})")
    }

    fn splat(&self, precision: Precision, literal: &str) -> String {
        format!("{}({})", self.vec4(precision), [literal; 4].join(", "))
    }

    fn scalar_constant(&self, precision: Precision, name: &str, literal: &str) -> String {
        format!("static const {} {name} = {literal};\n", self.scalar(precision))
    }

    fn array_constant(&self, name: &str, element: &str, items: usize) -> [String; 2] {
        [
            format!("static const {element} {name}[{items}] = {{\n"),
            "\n};\n".to_owned(),
        ]
    }

    fn notes(&self, precision: Precision) -> Vec<String> {
        let mut notes = vec!["HLSL, shader model 5 and later.".to_owned()];
        if precision == Precision::F16 {
            notes.push(
                "DXC: shader model 6.2 with -enable-16bit-types; without it half is float, which is only more precise."
                    .to_owned(),
            );
        }
        notes
    }

    fn file(&self, text: &str, _: Precision, guard: &str) -> String {
        guarded(text, guard)
    }
}
