//! Direct3D's language.

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
