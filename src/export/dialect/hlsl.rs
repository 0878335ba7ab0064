//! Direct3D's language.

use super::Language;
use crate::export::Precision;
use crate::features::MomentDepthKind;
use crate::numeric::source::{Dialect, Type};

/// HLSL, shader model 5 and later. A function that gives an array writes it to its last parameter, `out float
/// result[n]`.
#[derive(Debug, Clone, Copy)]
pub struct Hlsl;

impl Dialect for Hlsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(_) => "float",
            Type::Word | Type::Words(_) => "uint",
            Type::Truth => "bool",
            Type::Vec4 => "float4",
            Type::Word4 => "uint4",
        }
        .to_owned()
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

    fn head(&self, name: &str, parameters: &[(&str, Type)], result: Type) -> String {
        let mut list: Vec<String> = parameters.iter().map(|&(name, of)| self.parameter(name, of)).collect();
        let result = if matches!(result, Type::Reals(_) | Type::Words(_)) {
            list.push(format!("out {}", self.parameter("result", result)));
            "void".to_owned()
        } else {
            self.type_name(result)
        };
        format!("{result} {name}({})", list.join(", "))
    }

    fn array(&self, of: Type, name: &str, items: &[String]) -> (Option<String>, String) {
        let statement = format!("{} = {{ {} }};", self.parameter(name, of), items.join(", "));
        (Some(statement), name.to_owned())
    }

    fn return_array(&self, _: Type, items: &[String]) -> Vec<String> {
        let assign = |(i, item): (usize, &String)| format!("result[{i}] = {item};");
        items.iter().enumerate().map(assign).collect()
    }

    fn call_array(&self, of: Type, name: &str, function: &str, arguments: &[String]) -> Vec<String> {
        let variable = self.parameter(name, of);
        let arguments = [arguments, &[name.to_owned()]].concat();
        vec![format!("{variable};"), format!("{function}({});", arguments.join(", "))]
    }

    fn to_bits(&self, number: &str) -> String {
        format!("asuint({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("asfloat({word})")
    }
}

impl Language for Hlsl {
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

    fn splat(&self, vec4: &str, literal: &str) -> String {
        format!("{vec4}({})", [literal; 4].join(", "))
    }

    fn product(&self, block: &str, activations: &str) -> String {
        format!("mul({activations}, {block})")
    }

    fn module_constant(&self, of: &str, name: &str, value: &str) -> String {
        format!("static const {of} {name} = {value};\n")
    }

    fn module_array(&self, element: &str, name: &str, count: usize) -> (String, &'static str) {
        (format!("static const {element} {name}[{count}] = {{\n"), "\n};\n")
    }

    fn guarded(&self, guard: &str, text: String) -> String {
        format!("#ifndef {guard}\n#define {guard}\n\n{text}\n#endif\n")
    }

    fn notes(&self) -> &'static [&'static str] {
        &[
            "HLSL, shader model 5 and later. A function that gives an array writes it to its last parameter, an out \
             float[n].",
        ]
    }

    fn half_notes(&self) -> &'static [&'static str] {
        &["DXC: shader model 6.2 with -enable-16bit-types; without it half is float, which is only more precise."]
    }

    fn calls(&self, depth: MomentDepthKind) -> Option<&'static str> {
        match depth {
            MomentDepthKind::Log => Some(include_str!("../calls/recentred.hlsl")),
            MomentDepthKind::Window => Some(include_str!("../calls/paper.hlsl")),
            MomentDepthKind::None => None,
        }
    }

    fn resolve(&self) -> &'static str {
        include_str!("../calls/resolve.hlsl")
    }

    /// There are no constructors.
    fn members(&self, of: &str, values: &[(String, String)]) -> String {
        let assign = |(name, value): &(String, String)| format!("    {of}.{name} = {value};");
        values.iter().map(assign).collect::<Vec<_>>().join("\n")
    }
}
