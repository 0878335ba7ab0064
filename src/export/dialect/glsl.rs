//! OpenGL's and Vulkan's language.

use crate::numeric::source::{Dialect, Type};

/// GLSL; 4.50 and ES 3.00 read it.
#[derive(Debug, Clone, Copy)]
pub struct Glsl;

impl Glsl {
    fn array_of(self, of: Type, items: &[String]) -> String {
        format!("{}[{}]({})", self.type_name(of), items.len(), items.join(", "))
    }
}

impl Dialect for Glsl {
    fn type_name(&self, of: Type) -> String {
        match of {
            Type::Real | Type::Reals(_) => "float",
            Type::Word | Type::Words(_) => "uint",
            Type::Truth => "bool",
            Type::Vec4 => "vec4",
            Type::Word4 => "uvec4",
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
        format!("const {} {name} = {value};", self.type_name(of))
    }

    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        format!("({condition} ? {yes} : {no})")
    }

    fn head(&self, name: &str, parameters: &[(&str, Type)], result: Type) -> String {
        let list: Vec<String> = parameters.iter().map(|&(name, of)| self.parameter(name, of)).collect();
        let result = match result {
            Type::Reals(n) | Type::Words(n) => format!("{}[{n}]", self.type_name(result)),
            _ => self.type_name(result),
        };
        format!("{result} {name}({})", list.join(", "))
    }

    fn array(&self, of: Type, _: &str, items: &[String]) -> (Option<String>, String) {
        (None, self.array_of(of, items))
    }

    fn return_array(&self, of: Type, items: &[String]) -> Vec<String> {
        vec![format!("return {};", self.array_of(of, items))]
    }

    fn call_array(&self, of: Type, name: &str, function: &str, arguments: &[String]) -> Vec<String> {
        let variable = self.parameter(name, of);
        vec![format!("{variable} = {function}({});", arguments.join(", "))]
    }

    fn to_bits(&self, number: &str) -> String {
        format!("floatBitsToUint({number})")
    }

    fn bits_to_real(&self, word: &str) -> String {
        format!("uintBitsToFloat({word})")
    }
}
