//! WebGPU's language.

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

    /// A lone "less than" is turned round, since some linkers take `<` with a later `>` for a list of templates.
    fn select(&self, condition: &str, yes: &str, no: &str) -> String {
        let lone = !condition.contains("&&") && !condition.contains("||");
        let turned = [(" < ", ">"), (" <= ", ">=")].into_iter().find_map(|(less, greater)| {
            let (a, b) = condition.split_once(less)?;
            lone.then(|| format!("{b} {greater} {a}"))
        });
        format!("select({no}, {yes}, {})", turned.as_deref().unwrap_or(condition))
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
