//! A kind of number that is text: formulas over [`Real`] become functions of a shading language.
//!
//! A [`Source`] is a piece of shader source that is being written; an [`Expression`] is a number in it, a [`Condition`]
//! a truth value, a [`Code`] a word of 32 bits. Arithmetic on them joins text, and [`Real::named`] writes a statement:
//!
//! ```
//! use nmt::export::dialect::Wgsl;
//! use nmt::numeric::real::{Real, c};
//! use nmt::numeric::source::{Source, Type};
//!
//! fn length<R: Real>(x: R, y: R) -> R {
//!     let squares = (x * x + y * y).named("squares");
//!     R::select(squares.gt(c(0.0)), squares.sqrt(), squares.like(0.0))
//! }
//!
//! let source = Source::new(&Wgsl, "nmt");
//! source.begin_function("nmt_length", "Length of a vector.", &[("x", Type::Real), ("y", Type::Real)], Type::Real);
//! source.return_value(length(source.real("x"), source.real("y")));
//! assert_eq!(source.into_text(), "
//! // Length of a vector.
//! fn nmt_length(x: f32, y: f32) -> f32 {
//!     let squares = x * x + y * y;
//!     return select(0.0, sqrt(squares), squares > 0.0);
//! }
//! ");
//! ```
//!
//! What only shaders do, branches and variables among it, is written by the methods of [`Source`]. The spelling of a
//! language is a [`Dialect`].

use super::real::{Mask, Operand, Real, Word, constant_on_the_right};
use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::ops::{Add, AddAssign, BitAnd, BitOr, BitXor, Div, Mul, MulAssign, Neg, Not, Shl, Shr, Sub, SubAssign};

/// Type of a parameter, a result or a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// A number in single precision.
    Real,
    /// An unsigned word of 32 bits.
    Word,
    /// A truth value.
    Truth,
    /// Four numbers x, y, z, w.
    Vec4,
    /// Two words x, y.
    Word2,
    /// Four words x, y, z, w.
    Word4,
    /// So many numbers, 16 at most: a number, a vector, or a matrix with a vector for every four, the last of them
    /// filled up with 0. By value in every language, and no array.
    Reals(usize),
}

/// The lanes of a vector.
const LANES: [&str; 4] = ["x", "y", "z", "w"];

/// Number `i` of the `n` numbers of a value, by its name; see [`Type::Reals`].
pub fn component(name: &str, n: usize, i: usize) -> String {
    match n {
        1 => name.to_owned(),
        2..=4 => format!("{name}.{}", LANES[i]),
        _ => format!("{name}[{}].{}", i / 4, LANES[i % 4]),
    }
}

/// Numbers with those that follow one another in one vector drawn together: `a.x, b.y, b.z` is `a.x, b.yz`.
fn swizzled(items: &[String]) -> Vec<String> {
    let lane = |text: &str| {
        let (vector, lane) = text.rsplit_once('.')?;
        let is_name = vector.chars().all(|c| c.is_ascii_alphanumeric() || "_[]".contains(c));
        Some((vector.to_owned(), LANES.iter().position(|&l| l == lane)?)).filter(|_| is_name)
    };
    let mut out: Vec<String> = Vec::new();
    let mut before = None;
    for item in items {
        let found = lane(item);
        match (&before, &found) {
            (Some((vector, last)), Some((same, next))) if vector == same && *next == last + 1 => {
                out.last_mut().expect("an item before").push_str(LANES[*next]);
            }
            _ => out.push(item.clone()),
        }
        before = found;
    }
    out
}

/// How a shading language spells what formulas are made of.
pub trait Dialect: Sync {
    /// The name of a type.
    fn type_name(&self, of: Type) -> String;
    /// A parameter of a type, by the type's name.
    fn parameter(&self, of: &str, name: &str) -> String {
        format!("{of} {name}")
    }
    /// A statement that names a value for good.
    fn let_(&self, of: Type, name: &str, value: &str) -> String;
    /// A statement that makes a variable.
    fn variable(&self, of: Type, name: &str, value: &str) -> String;
    /// A constant of the module.
    fn constant(&self, of: Type, name: &str, value: &str) -> String;
    /// An expression for one of two values that are both computed.
    fn select(&self, condition: &str, yes: &str, no: &str) -> String;
    /// The head of a function, up to its brace; the result's type by its name.
    fn head(&self, name: &str, parameters: &[(&str, Type)], result: &str) -> String;
    /// A structure of values, each with the lines of a comment before it.
    fn structure(&self, name: &str, fields: &[(String, &str, Type)]) -> String;
    /// The last statements of a function that gives a structure of values with these names.
    fn return_structure(&self, name: &str, values: &[(&str, String)]) -> Vec<String>;
    /// Numbers as one value of [`Type::Reals`].
    fn numbers(&self, items: &[String]) -> String {
        let whole = |n: usize| self.type_name(Type::Reals(n));
        match items {
            [number] => number.clone(),
            [_, _, _, _, _, ..] => {
                let zero = self.number(0.0);
                let column = |items: &[String]| {
                    let items: Vec<String> = (0..4).map(|i| items.get(i).unwrap_or(&zero).clone()).collect();
                    format!("{}({})", whole(4), swizzled(&items).join(", "))
                };
                let columns: Vec<String> = items.chunks(4).map(column).collect();
                format!("{}({})", whole(items.len()), columns.join(", "))
            }
            _ => format!("{}({})", whole(items.len()), swizzled(items).join(", ")),
        }
    }
    /// The bits of a number as a word.
    fn to_bits(&self, number: &str) -> String;
    /// The number that has the bits of a word.
    fn bits_to_real(&self, word: &str) -> String;
    /// A literal of a number that reads back to the same bits, where the language rounds it to single precision: the
    /// shortest decimal.
    fn number(&self, x: f32) -> String {
        if x.abs() >= 1e6 {
            format!("{x:e}")
        } else {
            format!("{x:?}")
        }
    }
    /// A literal of a word.
    fn word(&self, x: u32) -> String {
        format!("{x}u")
    }
}

/// Words that no value may be called by, since one of the languages keeps them for itself.
const RESERVED: [&str; 26] = [
    "active", "asm", "auto", "buffer", "centroid", "common", "export", "filter", "fixed", "half", "input", "line",
    "linear", "matrix", "output", "packed", "pass", "point", "precise", "resource", "sample", "shared", "super",
    "texture", "triangle", "vector",
];

/// How tightly the outermost operator of an expression binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    /// &, |, ^, << and >>, which languages disagree about: always in brackets beside others.
    Bitwise,
    Or,
    And,
    Comparison,
    Sum,
    Product,
    Unary,
    Atom,
}

/// Text of an expression.
struct Node {
    text: String,
    binding: Binding,
    /// Whether it is a name or a literal, which may stand anywhere at no cost.
    simple: bool,
    used: bool,
}

/// A function that is being written.
struct Function {
    text: String,
    /// Blocks that are open inside of it.
    depth: usize,
    /// How often each name has been given.
    names: HashMap<String, u32>,
    /// How many numbers the values hold that are no single ones.
    widths: HashMap<String, usize>,
}

struct Inner {
    nodes: Vec<Node>,
    /// Finished functions and constants.
    text: String,
    /// Functions that are being written, the innermost last.
    open: Vec<Function>,
    steps: HashSet<String>,
    repeated: Vec<String>,
}

/// A piece of shader source that is being written; see the [module](self).
///
/// # Panics
/// Its methods panic where statements stand outside of a function, and where a name of a parameter is given twice.
pub struct Source {
    dialect: &'static dyn Dialect,
    prefix: &'static str,
    inner: RefCell<Inner>,
}

impl Source {
    /// An empty piece of source. Names of the functions that [`Real::step`] makes begin with `prefix` and an
    /// underscore.
    pub fn new(dialect: &'static dyn Dialect, prefix: &'static str) -> Self {
        Self {
            dialect,
            prefix,
            inner: RefCell::new(Inner {
                nodes: Vec::new(),
                text: String::new(),
                open: Vec::new(),
                steps: HashSet::new(),
                repeated: Vec::new(),
            }),
        }
    }

    /// The text of the constants and functions, each after what it uses.
    ///
    /// # Panics
    /// If a function is not finished.
    pub fn into_text(self) -> String {
        let inner = self.inner.into_inner();
        assert!(inner.open.is_empty(), "a function has no end");
        inner.text
    }

    /// Expressions that were written more than once because they have no name: the program computes them again.
    pub fn repeated(&self) -> Vec<String> {
        self.inner.borrow().repeated.clone()
    }

    fn node(&self, text: String, binding: Binding, simple: bool) -> usize {
        let nodes = &mut self.inner.borrow_mut().nodes;
        nodes.push(Node {
            text,
            binding,
            simple,
            used: false,
        });
        nodes.len() - 1
    }

    /// Text of a node as an operand, in brackets where it binds less than it must.
    fn operand(&self, node: usize, least: Binding) -> String {
        let inner = &mut *self.inner.borrow_mut();
        let Node {
            text,
            binding,
            simple,
            used,
        } = &mut inner.nodes[node];
        if *used && !*simple {
            inner.repeated.push(text.clone());
        }
        *used = true;
        if *binding < least {
            format!("({text})")
        } else {
            text.clone()
        }
    }

    fn text(&self, node: usize) -> String {
        self.operand(node, Binding::Bitwise)
    }

    fn name(&self, text: &str) -> usize {
        self.node(text.to_owned(), Binding::Atom, true)
    }

    /// A number by its name or other simple text: a parameter, a constant, `b[2]`.
    pub fn real(&self, text: &str) -> Expression<'_> {
        self.expression(self.name(text))
    }

    /// A word by its name or other simple text.
    pub fn word(&self, text: &str) -> Code<'_> {
        self.code(self.name(text))
    }

    /// The numbers of a value of [`Type::Reals`] that is known by its name.
    pub fn reals<const K: usize>(&self, name: &str) -> [Expression<'_>; K] {
        std::array::from_fn(|k| self.real(&component(name, K, k)))
    }

    /// The numbers of a vector that is known by its name.
    pub fn vec4(&self, name: &str) -> [Expression<'_>; 4] {
        self.reals(name)
    }

    /// The words of a vector that is known by its name.
    pub fn word4(&self, name: &str) -> [Code<'_>; 4] {
        LANES.map(|lane| self.word(&format!("{name}.{lane}")))
    }

    fn expression(&self, node: usize) -> Expression<'_> {
        Expression { source: self, node }
    }

    fn code(&self, node: usize) -> Code<'_> {
        Code { source: self, node }
    }

    fn condition(&self, node: usize) -> Condition<'_> {
        Condition { source: self, node }
    }

    /// A name that the function does not have yet.
    fn free_name(&self, wanted: &str) -> String {
        let mut inner = self.inner.borrow_mut();
        let function = inner.open.last_mut().expect("names stand in a function");
        let wanted = if RESERVED.contains(&wanted) {
            format!("{wanted}_")
        } else {
            wanted.to_owned()
        };
        let count = function.names.entry(wanted.clone()).or_insert(0);
        *count += 1;
        if *count == 1 {
            return wanted;
        }
        let name = format!("{wanted}_{count}");
        function.names.insert(name.clone(), 1);
        name
    }

    /// A statement as it stands, indented.
    pub fn statement(&self, statement: &str) {
        let mut inner = self.inner.borrow_mut();
        let function = inner.open.last_mut().expect("statements stand in a function");
        let indent = "    ".repeat(1 + function.depth);
        function.text += &folded(statement, &indent);
    }

    /// A comment between statements.
    pub fn comment(&self, text: &str) {
        let depth = self.inner.borrow().open.last().map_or(0, |f| 4 * (1 + f.depth));
        wrap(text, 117 - depth)
            .iter()
            .for_each(|line| self.statement(&format!("// {line}")));
    }

    /// Text between functions as it stands.
    pub fn between(&self, text: &str) {
        self.inner.borrow_mut().text += text;
    }

    /// A constant of the module, with a comment.
    pub fn constant(&self, name: &str, about: &str, value: f32) -> Expression<'_> {
        self.between("\n");
        wrap(about, 117)
            .iter()
            .for_each(|line| self.between(&format!("// {line}\n")));
        let value = self.dialect.number(value);
        self.between(&format!("{}\n", self.dialect.constant(Type::Real, name, &value)));
        self.real(name)
    }

    /// Begins a function. Its parameters are then known by their names; [`Self::real`] and its like make numbers of
    /// them.
    pub fn begin_function(&self, name: &str, about: &str, parameters: &[(&str, Type)], result: Type) {
        self.begin_structure_function(name, about, parameters, &self.dialect.type_name(result));
    }

    /// Begins a function whose result is a type of its own, by the type's name.
    pub fn begin_structure_function(&self, name: &str, about: &str, parameters: &[(&str, Type)], result: &str) {
        let mut text = String::from("\n");
        wrap(about, 117).iter().for_each(|line| text += &format!("// {line}\n"));
        text += &folded(&format!("{} {{", self.dialect.head(name, parameters, result)), "");
        let (mut names, mut widths) = (HashMap::new(), HashMap::new());
        for &(name, of) in parameters {
            assert!(
                names.insert(name.to_owned(), 1).is_none(),
                "parameter '{name}' is there already"
            );
            match of {
                Type::Reals(n) => drop(widths.insert(name.to_owned(), n)),
                Type::Vec4 => drop(widths.insert(name.to_owned(), 4)),
                _ => {}
            }
        }
        self.inner.borrow_mut().open.push(Function {
            text,
            depth: 0,
            names,
            widths,
        });
    }

    /// A structure of values, each with a comment.
    pub fn structure(&self, name: &str, about: &str, fields: &[(&str, &str, Type)]) {
        self.between("\n");
        wrap(about, 117)
            .iter()
            .for_each(|line| self.between(&format!("// {line}\n")));
        let fields: Vec<_> = fields
            .iter()
            .map(|&(about, name, of)| {
                let lines = wrap(about, 113);
                (lines.iter().map(|line| format!("    // {line}\n")).collect(), name, of)
            })
            .collect();
        self.between(&self.dialect.structure(name, &fields));
    }

    /// Ends the function with a structure of values by their names, each of numbers.
    pub fn return_structure(&self, name: &str, values: &[(&str, &[Expression<'_>])]) {
        let values: Vec<(&str, String)> = values
            .iter()
            .map(|&(name, items)| (name, self.dialect.numbers(&self.texts(items))))
            .collect();
        let statements = self.dialect.return_structure(name, &values);
        statements.iter().for_each(|statement| self.statement(statement));
        self.end_function();
    }

    fn texts(&self, items: &[Expression<'_>]) -> Vec<String> {
        items.iter().map(|item| self.text(item.node)).collect()
    }

    fn end_function(&self) {
        let mut inner = self.inner.borrow_mut();
        let function = inner.open.pop().expect("a function ends once");
        assert_eq!(function.depth, 0, "a block has no end");
        inner.text += &function.text;
        inner.text += "}\n";
    }

    /// Ends the function with a number, a word or a truth value.
    pub fn return_value<'s>(&'s self, value: impl Into<Value<'s>>) {
        let value = value.into();
        let text = self.text(value.node);
        self.statement(&format!("return {text};"));
        self.end_function();
    }

    /// Ends the function with several numbers.
    pub fn return_numbers(&self, items: &[Expression<'_>]) {
        let value = self.dialect.numbers(&self.texts(items));
        self.statement(&format!("return {value};"));
        self.end_function();
    }

    /// A variable.
    pub fn variable<'s>(&'s self, name: &str, value: Expression<'s>) -> Expression<'s> {
        let (name, value) = (self.free_name(name), self.text(value.node));
        self.statement(&self.dialect.variable(Type::Real, &name, &value));
        self.real(&name)
    }

    /// Gives a variable another value.
    pub fn assign<'s>(&'s self, variable: Expression<'s>, value: Expression<'s>) {
        let (name, value) = (self.text(variable.node), self.text(value.node));
        self.statement(&format!("{name} = {value};"));
    }

    /// Opens a block that runs under a condition.
    pub fn begin_if(&self, condition: Condition<'_>) {
        let condition = self.text(condition.node);
        self.statement(&format!("if ({condition}) {{"));
        self.inner
            .borrow_mut()
            .open
            .last_mut()
            .expect("blocks stand in a function")
            .depth += 1;
    }

    /// Closes the block that was opened last.
    pub fn end_if(&self) {
        self.inner
            .borrow_mut()
            .open
            .last_mut()
            .expect("blocks stand in a function")
            .depth -= 1;
        self.statement("}");
    }

    /// Closes every block of the function.
    pub fn end_all_ifs(&self) {
        while self
            .inner
            .borrow()
            .open
            .last()
            .is_some_and(|function| function.depth > 0)
        {
            self.end_if();
        }
    }

    /// A function's result, by its whole name.
    pub fn call<'s>(&'s self, function: &str, arguments: &[Value<'s>]) -> Expression<'s> {
        let arguments: Vec<String> = arguments.iter().map(|a| self.text(a.node)).collect();
        self.expression(self.node(format!("{function}({})", arguments.join(", ")), Binding::Atom, false))
    }

    /// The numbers that a function gives, under a name.
    pub fn call_numbers<'s, const K: usize>(
        &'s self,
        name: &str,
        function: &str,
        arguments: &[Value<'s>],
    ) -> [Expression<'s>; K] {
        let call = self.call(function, arguments);
        let (name, value) = (self.free_name(name), self.text(call.node));
        self.statement(&self.dialect.let_(Type::Reals(K), &name, &value));
        let mut inner = self.inner.borrow_mut();
        let function = inner.open.last_mut().expect("calls stand in a function");
        function.widths.insert(name.clone(), K);
        drop(inner);
        self.reals(&name)
    }

    /// A value of several numbers that is known by its name, as an argument.
    pub fn whole(&self, name: &str) -> Value<'_> {
        Value {
            source: self,
            node: self.name(name),
        }
    }

    /// Several numbers as one argument.
    pub fn numbers(&self, items: &[Expression<'_>]) -> Value<'_> {
        let texts = self.texts(items);
        if let Some(whole) = self.whole_of(&texts) {
            return self.whole(&whole);
        }
        Value {
            source: self,
            node: self.node(self.dialect.numbers(&texts), Binding::Atom, false),
        }
    }

    /// The name of the value whose numbers these are, all of them in order.
    fn whole_of(&self, texts: &[String]) -> Option<String> {
        let inner = self.inner.borrow();
        let (name, _) = texts.first()?.split_once(['.', '['])?;
        let width = *inner.open.last()?.widths.get(name)?;
        let all = (0..width).map(|i| component(name, width, i));
        all.eq(texts.iter().cloned()).then(|| name.to_owned())
    }

    fn let_(&self, of: Type, name: &str, node: usize) -> usize {
        if self.inner.borrow().nodes[node].simple {
            return node;
        }
        let (name, value) = (self.free_name(name), self.text(node));
        self.statement(&self.dialect.let_(of, &name, &value));
        self.name(&name)
    }

    fn unary(&self, operator: &str, a: usize) -> usize {
        let a = self.operand(a, Binding::Atom);
        self.node(format!("{operator}{a}"), Binding::Unary, false)
    }

    /// Operators of one binding are taken from the left; brackets keep every other order, which rounding tells apart.
    fn binary(&self, operator: &str, binding: Binding, a: usize, b: usize) -> usize {
        let (left, right) = match binding {
            Binding::Bitwise => (Binding::Atom, Binding::Atom),
            Binding::Or | Binding::And => (Binding::Comparison, Binding::Comparison),
            Binding::Comparison => (Binding::Sum, Binding::Sum),
            Binding::Sum => (Binding::Sum, Binding::Product),
            _ => (Binding::Product, Binding::Unary),
        };
        let (a, b) = (self.operand(a, left), self.operand(b, right));
        // a + -1.5 * b is a - 1.5 * b.
        match (operator, b.strip_prefix('-')) {
            ("+", Some(b)) => self.node(format!("{a} - {b}"), binding, false),
            _ => self.node(format!("{a} {operator} {b}"), binding, false),
        }
    }

    fn function(&self, name: &str, arguments: &[usize]) -> usize {
        let arguments: Vec<String> = arguments.iter().map(|&a| self.text(a)).collect();
        self.node(format!("{name}({})", arguments.join(", ")), Binding::Atom, false)
    }

    fn select(&self, condition: usize, yes: usize, no: usize) -> usize {
        let (yes, no) = (self.text(yes), self.text(no));
        let text = self.dialect.select(&self.text(condition), &yes, &no);
        self.node(text, Binding::Atom, false)
    }

    /// Whether a step must be written, which is so once.
    fn is_new_step(&self, function: &str) -> bool {
        self.inner.borrow_mut().steps.insert(function.to_owned())
    }
}

/// A statement or a head in lines of 120 characters, broken behind commas and before operators; a comment as it stands.
fn folded(statement: &str, indent: &str) -> String {
    let width = 120 - indent.chars().count();
    if statement.chars().count() <= width || statement.starts_with("//") {
        return format!("{indent}{statement}\n");
    }
    // A blank where no line may end is held by a character that no source has.
    const HELD: &str = "\u{1}";
    let mut held = statement.to_owned();
    for glued in [": ", " -> ", " = ", " {"] {
        held = held.replace(glued, &glued.replace(' ', HELD));
    }
    for operator in ["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "!=", "&&", "||", "?"] {
        held = held.replace(&format!(" {operator} "), &format!(" {operator}{HELD}"));
    }
    let lines = wrap(&held, width - 4);
    format!(
        "{indent}{}\n",
        lines.join(&format!("\n{indent}    ")).replace(HELD, " ")
    )
}

/// Breaks text into lines of so many characters at most.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

macro_rules! handles {
    ($($(#[$about:meta])* $name:ident),*) => {$(
        $(#[$about])*
        #[derive(Clone, Copy)]
        pub struct $name<'s> {
            source: &'s Source,
            node: usize,
        }

        impl std::fmt::Debug for $name<'_> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(&self.source.inner.borrow().nodes[self.node].text)
            }
        }
    )*};
}

handles!(
    /// A number in shader source.
    Expression,
    /// A word of 32 bits in shader source.
    Code,
    /// A truth value in shader source.
    Condition,
    /// Any value in shader source: what functions take and give.
    Value
);

impl<'s> From<Expression<'s>> for Value<'s> {
    fn from(Expression { source, node }: Expression<'s>) -> Self {
        Self { source, node }
    }
}

impl<'s> From<Code<'s>> for Value<'s> {
    fn from(Code { source, node }: Code<'s>) -> Self {
        Self { source, node }
    }
}

impl<'s> From<Condition<'s>> for Value<'s> {
    fn from(Condition { source, node }: Condition<'s>) -> Self {
        Self { source, node }
    }
}

impl<'s> Condition<'s> {
    /// The same truth value under a name.
    pub fn named(self, name: &str) -> Self {
        self.source.condition(self.source.let_(Type::Truth, name, self.node))
    }
}

macro_rules! operators {
    ($t:ident, $make:ident: $($op:ident $f:ident $text:literal $binding:ident),*) => {$(
        impl<'s> $op for $t<'s> {
            type Output = Self;
            fn $f(self, other: Self) -> Self {
                self.source.$make(self.source.binary($text, Binding::$binding, self.node, other.node))
            }
        }
    )*};
}

operators!(Expression, expression: Add add "+" Sum, Sub sub "-" Sum, Mul mul "*" Product, Div div "/" Product);
operators!(Code, code: Add add "+" Sum, Sub sub "-" Sum, Mul mul "*" Product);
operators!(Code, code: BitAnd bitand "&" Bitwise, BitOr bitor "|" Bitwise, BitXor bitxor "^" Bitwise);
operators!(Condition, condition: BitAnd bitand "&&" And, BitOr bitor "||" Or);
constant_on_the_right!(['s] Expression<'s>);

macro_rules! word_on_the_right {
    ($($op:ident $f:ident),*) => {$(
        impl<'s> $op<u32> for Code<'s> {
            type Output = Self;
            fn $f(self, constant: u32) -> Self {
                $op::$f(self, self.like(constant))
            }
        }
    )*};
}

word_on_the_right!(Add add, Sub sub, Mul mul, BitAnd bitand, BitOr bitor, BitXor bitxor);

impl<'s> Shl<u32> for Code<'s> {
    type Output = Self;
    fn shl(self, bits: u32) -> Self {
        let bits = self.like(bits);
        self.source
            .code(self.source.binary("<<", Binding::Bitwise, self.node, bits.node))
    }
}

impl<'s> Shr<u32> for Code<'s> {
    type Output = Self;
    fn shr(self, bits: u32) -> Self {
        let bits = self.like(bits);
        self.source
            .code(self.source.binary(">>", Binding::Bitwise, self.node, bits.node))
    }
}

impl Neg for Expression<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.source.expression(self.source.unary("-", self.node))
    }
}

impl Not for Condition<'_> {
    type Output = Self;
    fn not(self) -> Self {
        self.source.condition(self.source.unary("!", self.node))
    }
}

impl AddAssign for Expression<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Expression<'_> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Expression<'_> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Mask for Condition<'_> {}

impl<'s> Expression<'s> {
    fn function(self, name: &str, others: &[Self]) -> Self {
        let arguments: Vec<usize> = std::iter::once(self.node)
            .chain(others.iter().map(|o| o.node))
            .collect();
        self.source.expression(self.source.function(name, &arguments))
    }

    fn compare(self, operator: &str, other: impl Operand<Self>) -> Condition<'s> {
        let other = other.of(self);
        self.source
            .condition(self.source.binary(operator, Binding::Comparison, self.node, other.node))
    }
}

impl<'s> Real for Expression<'s> {
    type Mask = Condition<'s>;
    type Word = Code<'s>;
    const ROUNDING: f64 = f32::EPSILON as f64;

    fn like(self, value: f64) -> Self {
        let text = self.source.dialect.number(value as f32);
        let binding = if text.starts_with('-') {
            Binding::Unary
        } else {
            Binding::Atom
        };
        self.source.expression(self.source.node(text, binding, true))
    }

    fn min(self, other: impl Operand<Self>) -> Self {
        self.function("min", &[other.of(self)])
    }

    fn max(self, other: impl Operand<Self>) -> Self {
        self.function("max", &[other.of(self)])
    }

    fn clamp(self, low: impl Operand<Self>, high: impl Operand<Self>) -> Self {
        self.function("clamp", &[low.of(self), high.of(self)])
    }

    fn abs(self) -> Self {
        self.function("abs", &[])
    }

    fn sqrt(self) -> Self {
        self.function("sqrt", &[])
    }

    fn exp(self) -> Self {
        self.function("exp", &[])
    }

    fn ln(self) -> Self {
        self.function("log", &[])
    }

    fn exp2(self) -> Self {
        self.function("exp2", &[])
    }

    fn log2(self) -> Self {
        self.function("log2", &[])
    }

    fn floor(self) -> Self {
        self.function("floor", &[])
    }

    fn lt(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare("<", other)
    }

    fn le(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare("<=", other)
    }

    fn gt(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare(">", other)
    }

    fn ge(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare(">=", other)
    }

    fn eq(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare("==", other)
    }

    fn ne(self, other: impl Operand<Self>) -> Condition<'s> {
        self.compare("!=", other)
    }

    fn select(mask: Condition<'s>, yes: Self, no: Self) -> Self {
        mask.source.expression(mask.source.select(mask.node, yes.node, no.node))
    }

    fn to_bits(self) -> Code<'s> {
        let text = self.source.dialect.to_bits(&self.source.text(self.node));
        self.source.code(self.source.node(text, Binding::Atom, false))
    }

    fn to_word(self) -> Code<'s> {
        let name = self.source.dialect.type_name(Type::Word);
        self.source.code(self.source.function(&name, &[self.node]))
    }

    fn named(self, name: &str) -> Self {
        self.source.expression(self.source.let_(Type::Real, name, self.node))
    }

    fn named_at(self, stem: &str, index: usize) -> Self {
        self.named(&format!("{stem}{index}"))
    }

    fn note(self, text: &str) -> Self {
        self.source.comment(text);
        self
    }

    /// The closure may use nothing but what it is handed.
    fn step<const N: usize>(
        name: &str,
        about: &str,
        parameters: [(&str, Self); N],
        body: impl FnOnce([Self; N]) -> Self,
    ) -> Self {
        let source = parameters[0].1.source;
        let function = format!("{}_{name}", source.prefix);
        if source.is_new_step(&function) {
            let list = parameters.map(|(name, _)| (name, Type::Real));
            source.begin_function(&function, about, &list, Type::Real);
            source.return_value(body(parameters.map(|(name, _)| source.real(name))));
        }
        source.call(&function, &parameters.map(|(_, value)| value.into()))
    }

    /// The closure may use nothing but what it is handed.
    fn step_array<const N: usize, const K: usize, const M: usize>(
        name: &str,
        about: &str,
        parameters: [(&str, Self); N],
        array: (&str, [Self; K]),
        result: &str,
        body: impl FnOnce([Self; N], [Self; K]) -> [Self; M],
    ) -> [Self; M] {
        let source = parameters.first().map_or_else(|| array.1[0].source, |p| p.1.source);
        let function = format!("{}_{name}", source.prefix);
        if source.is_new_step(&function) {
            let mut list = parameters.map(|(name, _)| (name, Type::Real)).to_vec();
            if K > 0 {
                list.push((array.0, Type::Reals(K)));
            }
            source.begin_function(&function, about, &list, Type::Reals(M));
            let items = body(parameters.map(|(name, _)| source.real(name)), source.reals(array.0));
            source.return_numbers(&items);
        }
        let mut arguments: Vec<Value<'_>> = parameters.iter().map(|&(_, value)| value.into()).collect();
        if K > 0 {
            arguments.push(source.numbers(&array.1));
        }
        source.call_numbers(result, &function, &arguments)
    }
}

impl<'s> Word<Expression<'s>> for Code<'s> {
    fn like(self, value: u32) -> Self {
        self.source.word(&self.source.dialect.word(value))
    }

    fn min(self, other: Self) -> Self {
        self.source.code(self.source.function("min", &[self.node, other.node]))
    }

    fn max(self, other: Self) -> Self {
        self.source.code(self.source.function("max", &[self.node, other.node]))
    }

    fn lt(self, other: Self) -> Condition<'s> {
        self.source
            .condition(self.source.binary("<", Binding::Comparison, self.node, other.node))
    }

    fn eq(self, other: Self) -> Condition<'s> {
        self.source
            .condition(self.source.binary("==", Binding::Comparison, self.node, other.node))
    }

    fn select(mask: Condition<'s>, yes: Self, no: Self) -> Self {
        mask.source.code(mask.source.select(mask.node, yes.node, no.node))
    }

    fn to_real(self) -> Expression<'s> {
        let name = self.source.dialect.type_name(Type::Real);
        self.source.expression(self.source.function(&name, &[self.node]))
    }

    fn bits_to_real(self) -> Expression<'s> {
        let text = self.source.dialect.bits_to_real(&self.source.text(self.node));
        self.source.expression(self.source.node(text, Binding::Atom, false))
    }

    fn named(self, name: &str) -> Self {
        self.source.code(self.source.let_(Type::Word, name, self.node))
    }

    fn note(self, text: &str) -> Self {
        self.source.comment(text);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::interpret::{Interpreter, Value as Row};
    use crate::export::dialect::{Glsl, Hlsl, Wgsl};
    use crate::numeric::lanes::{LANES, Lanes};
    use crate::numeric::real::{Divisor, c, square};
    use crate::numeric::rng::stream;
    use crate::stress::arithmetic::Device;
    use fearless_simd::{Level, dispatch};
    use rand::RngExt;

    /// A formula of everything that there is.
    #[inline(always)]
    fn formula<R: Real>([x, y, z]: [R; 3], b: [R; 2]) -> R {
        let half = ((x + y) * c(0.5)).named("half");
        let per_z = Divisor::new(z.abs().max(c(0.1))).named("per_z");
        let near = near_one(x.over(per_z), y).named("near");
        let [low, high] = R::step_array("ends", "Both, in order.", [("x", x)], ("b", b), "ends", |[x], b| {
            let scaled = (x * b[0]).named("scaled");
            [scaled.min(b[1]), scaled.max(b[1])]
        });
        let word = (x.abs().to_bits() & 0xffff_f000)
            .note("Twelve bits hold another number.")
            .named("word");
        let code = (word | ((y.abs() * c(64.0)).to_word().min(word.like(4095)))).named("code");
        let unpacked = (code >> 12 << 12).bits_to_real() + (code & 0xfff).to_real() / c(64.0);
        let between = (half.ge(low) & half.le(high)) | !x.gt(c(0.0));
        let chosen = R::select(between, unpacked.sqrt() - (x - (y - z)), near.clamp(c(-2.0), c(2.0)));
        let whole = R::select(word.lt(code), (x * c(8.0)).floor(), -(half.exp2()));
        chosen + whole * ((square(near) + c(1.0)).log2() + (-half).exp() / (c(2.0) - y / c(4.0)))
    }

    #[inline(always)]
    fn near_one<R: Real>(a: R, b: R) -> R {
        R::step(
            "near_one",
            "ln(a^2 + 1), 0 where b is.",
            [("a", a), ("b", b)],
            #[inline(always)]
            |[a, b]| R::select(b.eq(c(0.0)), b.like(0.0), (a * a + c(1.0)).ln()),
        )
    }

    fn written(dialect: &'static dyn Dialect) -> (String, Vec<String>) {
        let source = Source::new(dialect, "test");
        let parameters = [
            ("x", Type::Real),
            ("y", Type::Real),
            ("z", Type::Real),
            ("b", Type::Reals(2)),
        ];
        source.begin_function("test_formula", "Everything that there is.", &parameters, Type::Real);
        let value = formula(["x", "y", "z"].map(|name| source.real(name)), source.reals("b"));
        source.return_value(value);
        let repeated = source.repeated();
        (source.into_text(), repeated)
    }

    fn parsed(dialect: &'static dyn Dialect, glsl: bool) -> naga::Module {
        let (text, _) = written(dialect);
        let module = if glsl {
            let whole = format!("#version 450\n{text}\nvoid main() {{}}\n");
            let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
            naga::front::glsl::Frontend::default().parse(&options, &whole).unwrap()
        } else {
            naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)))
        };
        let flags = naga::valid::ValidationFlags::all();
        naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap();
        module
    }

    /// Every kind gives the same numbers: f64 to 1e-12 of itself, single precision to 2e-5 of f64, and written source,
    /// run by the interpreter, what f32 gives to 1e-6. Control: the same formula of other arguments.
    #[test]
    fn one_formula_in_every_kind() {
        let modules = [parsed(&Wgsl, false), parsed(&Glsl, true)];
        let interpreters = [Interpreter::new(&modules[0]), Interpreter::new(&modules[1])];
        let mut rng = stream(1, 140, 0);
        let mut before = f64::NAN;
        let mut controls = 0;
        for _ in 0..500 {
            let v: [f32; 5] = std::array::from_fn(|_| rng.random_range(-1.5..1.5));
            let wide = formula([v[0], v[1], v[2]].map(f64::from), [v[3], v[4]].map(f64::from));
            let narrow = formula([v[0], v[1], v[2]], [v[3], v[4]]);
            let mut lanes = [Lanes::ZERO; 5];
            lanes
                .iter_mut()
                .zip(v)
                .for_each(|(lanes, v)| *lanes = Lanes([v; LANES]));
            let mut out = Lanes::ZERO;
            dispatch!(Level::new(), simd => {
                let [x, y, z, b0, b1] = std::array::from_fn(|i| lanes[i].load(simd));
                out.store(formula([x, y, z], [b0, b1]));
            });
            let d = v.map(crate::numeric::Scalar::from_f32);
            let device: Device<false, false, false> = formula([d[0], d[1], d[2]], [d[3], d[4]]);
            let close = |a: f64, b: f64, bar: f64| (a - b).abs() <= bar * (1.0 + b.abs());
            // Words hold less of a number than f64 does.
            for single in [narrow, out.0[7], crate::numeric::Scalar::to_f64(device) as f32] {
                assert!(close(single.into(), wide, 2e-5), "{single} for {wide} of {v:?}");
            }
            for interpreter in &interpreters {
                let arguments = [v[0], v[1], v[2]].map(Row::<1>::Uniform).to_vec();
                let arguments = [arguments, vec![Row::numbers(&v[3..])]].concat();
                let found = interpreter.call("test_formula", arguments).unwrap().flatten().unwrap()[0];
                assert!(
                    close(found.into(), narrow.into(), 1e-6),
                    "{found} for {narrow} of {v:?}"
                );
            }
            controls += usize::from(!close(wide, before, 2e-5));
            before = wide;
        }
        assert!(controls > 490, "{controls}");
    }

    #[test]
    fn written_source() {
        for (dialect, name) in [
            (&Wgsl as &'static dyn Dialect, "wgsl"),
            (&Glsl, "glsl"),
            (&Hlsl, "hlsl"),
        ] {
            let (text, repeated) = written(dialect);
            assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
            assert!(repeated.is_empty(), "{repeated:?}");
            insta::assert_snapshot!(name, text);
        }
    }

    /// Order of operations is kept by brackets, names are made free, and what has no name and is written twice is told.
    #[test]
    fn brackets_names_and_repetition() {
        let source = Source::new(&Wgsl, "t");
        source.begin_function("f", "", &[("a", Type::Real), ("n", Type::Word)], Type::Real);
        let (a, n) = (source.real("a"), source.word("n"));
        let text = |e: Expression<'_>| format!("{e:?}");
        assert_eq!(text(a + (a + a) - (a - a)), "a + (a + a) - (a - a)");
        assert_eq!(text(a * (a / a) / (a * a)), "a * (a / a) / (a * a)");
        assert_eq!(text((a + a) * -(a * a) - c(-1.5) * a), "(a + a) * -(a * a) - -1.5 * a");
        assert_eq!(text(-(-a)), "-(-a)");
        assert_eq!(format!("{:?}", ((n & 3) + 1) << 2), "((n & 3u) + 1u) << 2u");
        assert_eq!(format!("{:?}", !(a.lt(c(1.0)) & a.gt(c(0.0)))), "!(a < 1.0 && a > 0.0)");
        let first = (a + c(1.0)).named("sample");
        let second = (a + c(2.0)).named("sample");
        assert_eq!(
            (text(first), text(second), text(a.named("b"))),
            ("sample_".into(), "sample__2".into(), "a".into())
        );
        assert!(source.repeated().is_empty());
        let unnamed = a.exp();
        source.return_value(unnamed * unnamed);
        assert_eq!(source.repeated(), ["exp(a)"]);
        assert_eq!(wrap("a comment of words", 9), ["a comment", "of words"]);
    }
}
