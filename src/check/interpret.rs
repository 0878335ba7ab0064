//! Runs shader functions on the CPU, from naga's intermediate representation: what the source says is computed, not
//! only parsed.
//!
//! Arithmetic is f32; where the source says f16, every result is rounded to it. Many rows run side by side in lanes.
//! The subset of the language that exports use is supported; anything else is an error that names it.

use crate::numeric::quantise::round_f16_of_f32;
use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    BinaryOperator, Expression, Function, Handle, Literal, MathFunction, Module, Statement, TypeInner, UnaryOperator,
};
use std::sync::Arc;

/// A value in every lane.
#[derive(Debug, Clone)]
pub enum Value<const L: usize> {
    /// The same number in every lane.
    Uniform(f32),
    /// A number a lane.
    Lanes(Arc<[f32; L]>),
    /// A truth value a lane.
    Bools(Arc<[bool; L]>),
    /// An index or a word of 32 bits, the same in every lane.
    Index(u32),
    /// A word of 32 bits a lane.
    Words(Arc<[u32; L]>),
    /// A vector, matrix (of columns) or array.
    Composite(Arc<[Self]>),
}

/// Why a function could not be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InterpretError {
    /// There is no such function.
    #[error("there is no function '{0}'")]
    NoFunction(String),
    /// There is no such constant.
    #[error("there is no constant '{0}'")]
    NoConstant(String),
    /// A part of the language that exports do not use.
    #[error("{0} is not supported here")]
    Unsupported(String),
    /// Operands do not fit.
    #[error("operands of {0} do not fit")]
    Operands(&'static str),
    /// Lanes would take different branches.
    #[error("the rows take different branches")]
    Divergent,
    /// The function ends without a value.
    #[error("the function returns no value")]
    NoValue,
}

type Result<T> = std::result::Result<T, InterpretError>;

fn unsupported<T>(what: impl std::fmt::Debug) -> Result<T> {
    // The variant's name is enough; handles and nested data help nobody.
    let name: String = format!("{what:?}")
        .chars()
        .take_while(|c| c.is_alphanumeric() || *c == ':')
        .collect();
    Err(InterpretError::Unsupported(name))
}

impl Value<1> {
    /// A value that is the same in every lane, in any number of lanes.
    fn in_lanes<const L: usize>(&self) -> Result<Value<L>> {
        Ok(match self {
            Self::Uniform(x) => Value::Uniform(*x),
            Self::Index(i) => Value::Index(*i),
            Self::Bools(b) => Value::Bools(Arc::new([b[0]; L])),
            Self::Composite(items) => Value::Composite(items.iter().map(Self::in_lanes).collect::<Result<_>>()?),
            Self::Lanes(x) => Value::Uniform(x[0]),
            Self::Words(x) => Value::Index(x[0]),
        })
    }
}

impl<const L: usize> Value<L> {
    /// A vector or array of numbers, the same in every lane.
    pub fn numbers(values: &[f32]) -> Self {
        Self::Composite(values.iter().map(|&v| Self::Uniform(v)).collect())
    }

    /// Numbers in a row as a parameter of such a type takes them: a matrix takes them column by column, and 0 where
    /// there are no more.
    fn shaped(self, of: &TypeInner) -> Self {
        match (self, of) {
            (Self::Composite(items), TypeInner::Matrix { rows, .. })
                if !items.iter().any(|item| matches!(item, Self::Composite(_))) =>
            {
                let rows = *rows as usize;
                let column = |items: &[Self]| {
                    let padding = vec![Self::Uniform(0.0); rows - items.len()];
                    Self::Composite([items, &padding].concat().into())
                };
                Self::Composite(items.chunks(rows).map(column).collect())
            }
            (value, _) => value,
        }
    }

    /// The number in a lane.
    fn lane(&self, lane: usize) -> Result<f32> {
        match self {
            Self::Uniform(x) => Ok(*x),
            Self::Lanes(x) => Ok(x[lane]),
            _ => Err(InterpretError::Operands("a scalar operation")),
        }
    }

    /// All numbers of a composite that is the same in every lane, as everything is in a single one, in order.
    ///
    /// # Errors
    /// [`InterpretError::Operands`] where it is not made of such numbers.
    pub fn flatten(&self) -> Result<Vec<f32>> {
        match self {
            Self::Uniform(x) => Ok(vec![*x]),
            Self::Lanes(x) if L == 1 => Ok(x.to_vec()),
            Self::Composite(items) => items
                .iter()
                .map(Self::flatten)
                .collect::<Result<Vec<_>>>()
                .map(|v| v.concat()),
            _ => Err(InterpretError::Operands("a constant")),
        }
    }

    fn item(&self, index: usize) -> Result<Self> {
        match self {
            Self::Composite(items) => items.get(index).cloned().ok_or(InterpretError::Operands("an index")),
            _ => Err(InterpretError::Operands("an index")),
        }
    }

    /// A number a lane. A plain loop, which vectorises, where the array's own `map` does not.
    #[inline]
    fn each(f: impl Fn(usize) -> f32) -> Self {
        let mut out = [0.0; L];
        for (lane, out) in out.iter_mut().enumerate() {
            *out = f(lane);
        }
        Self::Lanes(Arc::new(out))
    }

    fn map(&self, f: &impl Fn(f32) -> f32) -> Result<Self> {
        Ok(match self {
            Self::Uniform(x) => Self::Uniform(f(*x)),
            Self::Lanes(x) => Self::each(|l| f(x[l])),
            Self::Composite(items) => Self::Composite(items.iter().map(|i| i.map(f)).collect::<Result<_>>()?),
            _ => return Err(InterpretError::Operands("arithmetic")),
        })
    }

    /// Component by component; a scalar goes with every component.
    fn zip(&self, other: &Self, f: &impl Fn(f32, f32) -> f32) -> Result<Self> {
        Ok(match (self, other) {
            (Self::Composite(a), Self::Composite(b)) if a.len() == b.len() => Self::Composite(
                a.iter()
                    .zip(b.iter())
                    .map(|(a, b)| a.zip(b, f))
                    .collect::<Result<_>>()?,
            ),
            (Self::Composite(a), b @ (Self::Uniform(_) | Self::Lanes(_))) => {
                Self::Composite(a.iter().map(|a| a.zip(b, f)).collect::<Result<_>>()?)
            }
            (a @ (Self::Uniform(_) | Self::Lanes(_)), Self::Composite(b)) => {
                Self::Composite(b.iter().map(|b| a.zip(b, f)).collect::<Result<_>>()?)
            }
            (Self::Uniform(a), Self::Uniform(b)) => Self::Uniform(f(*a, *b)),
            (Self::Uniform(a), Self::Lanes(b)) => Self::each(|l| f(*a, b[l])),
            (Self::Lanes(a), Self::Uniform(b)) => Self::each(|l| f(a[l], *b)),
            (Self::Lanes(a), Self::Lanes(b)) => Self::each(|l| f(a[l], b[l])),
            _ => return Err(InterpretError::Operands("arithmetic")),
        })
    }

    fn compare(&self, other: &Self, f: impl Fn(f32, f32) -> bool) -> Result<Self> {
        let mut out = [false; L];
        for (lane, out) in out.iter_mut().enumerate() {
            *out = f(self.lane(lane)?, other.lane(lane)?);
        }
        Ok(Self::Bools(Arc::new(out)))
    }

    /// The word in every lane, where these are words.
    fn words(&self) -> Option<[u32; L]> {
        match self {
            Self::Index(word) => Some([*word; L]),
            Self::Words(words) => Some(**words),
            _ => None,
        }
    }

    /// The word in a lane.
    ///
    /// # Errors
    /// [`InterpretError::Operands`] where it is no word.
    pub fn word(&self, lane: usize) -> Result<u32> {
        self.words().map(|w| w[lane]).ok_or(InterpretError::Operands("a word"))
    }

    /// Two words a lane make one, or a truth value.
    fn words_with(&self, other: &Self, op: BinaryOperator) -> Option<Result<Self>> {
        let (a, b) = (self.words()?, other.words()?);
        let make = |f: fn(u32, u32) -> u32| Ok(Self::Words(Arc::new(std::array::from_fn(|l| f(a[l], b[l])))));
        let compare = |f: fn(&u32, &u32) -> bool| Ok(Self::Bools(Arc::new(std::array::from_fn(|l| f(&a[l], &b[l])))));
        Some(match op {
            BinaryOperator::Add => make(u32::wrapping_add),
            BinaryOperator::Subtract => make(u32::wrapping_sub),
            BinaryOperator::Multiply => make(u32::wrapping_mul),
            BinaryOperator::And => make(|a, b| a & b),
            BinaryOperator::InclusiveOr => make(|a, b| a | b),
            BinaryOperator::ExclusiveOr => make(|a, b| a ^ b),
            BinaryOperator::ShiftLeft => make(u32::wrapping_shl),
            BinaryOperator::ShiftRight => make(u32::wrapping_shr),
            BinaryOperator::Less => compare(u32::lt),
            BinaryOperator::LessEqual => compare(u32::le),
            BinaryOperator::Greater => compare(u32::gt),
            BinaryOperator::GreaterEqual => compare(u32::ge),
            BinaryOperator::Equal => compare(u32::eq),
            BinaryOperator::NotEqual => compare(u32::ne),
            other => unsupported(other),
        })
    }

    /// Two truth values a lane make one.
    fn bools_with(&self, other: &Self, op: BinaryOperator) -> Option<Result<Self>> {
        let (Self::Bools(a), Self::Bools(b)) = (self, other) else {
            return None;
        };
        let make = |f: fn(bool, bool) -> bool| Ok(Self::Bools(Arc::new(std::array::from_fn(|l| f(a[l], b[l])))));
        Some(match op {
            BinaryOperator::And | BinaryOperator::LogicalAnd => make(|a, b| a & b),
            BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr => make(|a, b| a | b),
            other => unsupported(other),
        })
    }

    fn columns(&self) -> Option<&[Self]> {
        match self {
            Self::Composite(items) if matches!(items.first(), Some(Self::Composite(_))) => Some(items),
            _ => None,
        }
    }

    /// Product as shading languages mean it: a matrix times a vector is the sum of its columns by the vector's
    /// components, in order. Every number on the way is rounded.
    fn multiply(&self, other: &Self, round: &impl Fn(f32) -> f32) -> Result<Self> {
        let times = |a: f32, b: f32| round(a * b);
        match (self.columns(), other) {
            (Some(columns), Self::Composite(x)) if other.columns().is_none() && x.len() == columns.len() => {
                let mut sum = columns[0].zip(&x[0], &times)?;
                for (column, x) in columns.iter().zip(x.iter()).skip(1) {
                    sum = sum.zip(&column.zip(x, &times)?, &|a, b| round(a + b))?;
                }
                Ok(sum)
            }
            (None, _) if other.columns().is_none() => self.zip(other, &times),
            _ => unsupported("MatrixProduct"),
        }
    }

    fn dot(&self, other: &Self, round: &impl Fn(f32) -> f32) -> Result<Self> {
        match self.zip(other, &|a, b| round(a * b))? {
            Self::Composite(terms) => {
                let mut sum = terms[0].clone();
                for term in &terms[1..] {
                    sum = sum.zip(term, &|a, b| round(a + b))?;
                }
                Ok(sum)
            }
            _ => Err(InterpretError::Operands("dot")),
        }
    }

    fn select(condition: &Self, accept: &Self, reject: &Self) -> Result<Self> {
        let Self::Bools(c) = condition else {
            return Err(InterpretError::Operands("select"));
        };
        if let (Some(accept), Some(reject)) = (accept.words(), reject.words()) {
            let chosen = std::array::from_fn(|lane| if c[lane] { accept[lane] } else { reject[lane] });
            return Ok(Self::Words(Arc::new(chosen)));
        }
        let mut out = [0.0; L];
        for (lane, out) in out.iter_mut().enumerate() {
            *out = if c[lane] {
                accept.lane(lane)?
            } else {
                reject.lane(lane)?
            };
        }
        Ok(Self::Lanes(Arc::new(out)))
    }
}

/// A module whose functions can be called.
pub struct Interpreter<'a> {
    module: &'a Module,
    /// Values of its constants, in the order of their handles.
    constants: Vec<Result<Value<1>>>,
    /// For every function, which of its expressions are f16.
    halves: Vec<Vec<bool>>,
}

/// Which expressions of a function are f16.
fn halves(module: &Module, function: &Function) -> Vec<bool> {
    let context = ResolveContext::with_locals(module, &function.local_variables, &function.arguments);
    let mut types = Typifier::new();
    let half = |(handle, _)| {
        let known = types.grow(handle, &function.expressions, &context).is_ok();
        known && types.get(handle, &module.types).scalar() == Some(naga::Scalar::F16)
    };
    function.expressions.iter().map(half).collect()
}

impl<'a> Interpreter<'a> {
    /// An interpreter of a validated module.
    pub fn new(module: &'a Module) -> Self {
        let constants = module
            .constants
            .iter()
            .map(|(_, constant)| global(module, constant.init))
            .collect();
        let halves = module
            .functions
            .iter()
            .map(|(_, function)| halves(module, function))
            .collect();
        Self {
            module,
            constants,
            halves,
        }
    }

    /// A constant that a function names, as it is in every lane.
    fn constant_value<const L: usize>(&self, handle: Handle<naga::Constant>) -> Result<Value<L>> {
        self.constants[handle.index()]
            .as_ref()
            .map_err(Clone::clone)?
            .in_lanes()
    }

    /// All numbers of a module constant, in order.
    ///
    /// # Errors
    /// [`InterpretError::NoConstant`] where there is none of this name.
    pub fn constant(&self, name: &str) -> Result<Vec<f32>> {
        let found = self
            .module
            .constants
            .iter()
            .find(|(_, c)| c.name.as_deref() == Some(name));
        let (handle, _) = found.ok_or_else(|| InterpretError::NoConstant(name.to_owned()))?;
        self.constants[handle.index()].as_ref().map_err(Clone::clone)?.flatten()
    }

    /// Names of the module's constants.
    pub fn constant_names(&self) -> impl Iterator<Item = &str> {
        self.module.constants.iter().filter_map(|(_, c)| c.name.as_deref())
    }

    /// The whole name of the function that has this one, or this one and a number, as translators append them.
    ///
    /// # Errors
    /// [`InterpretError::NoFunction`].
    pub fn function_like(&self, name: &str) -> Result<&'a str> {
        let like = |whole: &str| {
            let rest = whole.strip_prefix(name)?;
            (rest.is_empty() || rest.strip_prefix('_')?.chars().all(|c| c.is_ascii_digit())).then_some(())
        };
        let mut names = self.module.functions.iter().filter_map(|(_, f)| f.name.as_deref());
        names
            .find(|whole| like(whole).is_some())
            .ok_or_else(|| InterpretError::NoFunction(name.to_owned()))
    }

    /// Calls a function on a row of arguments a lane.
    ///
    /// # Errors
    /// [`InterpretError`].
    pub fn call<const L: usize>(&self, name: &str, arguments: Vec<Value<L>>) -> Result<Value<L>> {
        let found = self
            .module
            .functions
            .iter()
            .find(|(_, f)| f.name.as_deref() == Some(name));
        let (function, _) = found.ok_or_else(|| InterpretError::NoFunction(name.to_owned()))?;
        self.run(function, arguments)?.0.ok_or(InterpretError::NoValue)
    }

    /// Calls a function of one argument of `width` numbers on rows of numbers; the result is a number a row.
    ///
    /// # Shapes
    /// `rows: [N, width]`, row by row; the result is `[N]`.
    ///
    /// # Errors
    /// [`InterpretError`].
    pub fn call_rows(&self, name: &str, rows: &[f32], width: usize) -> Result<Vec<f32>> {
        use rayon::prelude::*;
        const L: usize = 64;
        let blocks: Vec<Vec<f32>> = rows
            .par_chunks(L * width)
            .map(|block| self.call_block::<L>(name, block, width))
            .collect::<Result<_>>()?;
        Ok(blocks.concat())
    }

    fn call_block<const L: usize>(&self, name: &str, rows: &[f32], width: usize) -> Result<Vec<f32>> {
        let n = rows.len() / width;
        // Lanes beyond the last row repeat it.
        let lanes = |i: usize| Value::each(|lane| rows[lane.min(n - 1) * width + i]);
        match self.call::<L>(name, vec![Value::Composite((0..width).map(lanes).collect())]) {
            Ok(value) => (0..n).map(|lane| value.lane(lane)).collect(),
            Err(InterpretError::Divergent) if L > 1 => rows
                .chunks_exact(width)
                .map(|row| self.call::<1>(name, vec![Value::numbers(row)])?.lane(0))
                .collect(),
            Err(error) => Err(error),
        }
    }

    /// Runs a function; the result is its value, and what its pointer arguments point to in the end, at their places
    /// among the arguments.
    fn run<const L: usize>(
        &self,
        handle: Handle<Function>,
        arguments: Vec<Value<L>>,
    ) -> Result<(Option<Value<L>>, Vec<Value<L>>)> {
        let function = &self.module.functions[handle];
        if arguments.len() != function.arguments.len() {
            return Err(InterpretError::Operands("a call"));
        }
        let expected = function
            .arguments
            .iter()
            .map(|argument| &self.module.types[argument.ty].inner);
        let arguments: Vec<Value<L>> = arguments
            .into_iter()
            .zip(expected)
            .map(|(value, of)| value.shaped(of))
            .collect();
        let halves = &self.halves[handle.index()];
        let mut locals = Vec::new();
        for (_, local) in function.local_variables.iter() {
            let mut frame = Frame {
                interpreter: self,
                function,
                halves,
                arguments: &[],
                locals: Vec::new(),
                values: Vec::new(),
            };
            locals.push(match local.init {
                Some(init) => frame.value(init)?,
                None => zero(self.module, local.ty)?,
            });
        }
        // What a pointer points to is a variable of the call, copied in and out.
        locals.extend(arguments.iter().cloned());
        let mut frame = Frame {
            interpreter: self,
            function,
            halves,
            arguments: &arguments,
            locals,
            values: vec![None; function.expressions.len()],
        };
        let value = match frame.block(&function.body)? {
            Flow::Return(value) => value,
            Flow::Next => None,
        };
        Ok((value, frame.locals.split_off(function.local_variables.len())))
    }
}

/// A constant expression of a module.
fn global(module: &Module, handle: Handle<Expression>) -> Result<Value<1>> {
    match &module.global_expressions[handle] {
        Expression::Literal(literal) => literal_value(*literal),
        Expression::Constant(constant) => global(module, module.constants[*constant].init),
        Expression::Compose { components, .. } => components
            .iter()
            .map(|&c| global(module, c))
            .collect::<Result<_>>()
            .map(Value::Composite),
        Expression::Splat { size, value } => Ok(splat(global(module, *value)?, *size as usize)),
        Expression::ZeroValue(ty) => zero(module, *ty),
        Expression::Unary {
            op: UnaryOperator::Negate,
            expr,
        } => global(module, *expr)?.map(&|x| -x),
        other => unsupported(other),
    }
}

fn zero<const L: usize>(module: &Module, ty: Handle<naga::Type>) -> Result<Value<L>> {
    let copies = |n: usize, item: Value<L>| Value::Composite((0..n).map(|_| item.clone()).collect());
    match module.types[ty].inner {
        TypeInner::Scalar(naga::Scalar {
            kind: naga::ScalarKind::Float,
            ..
        }) => Ok(Value::Uniform(0.0)),
        TypeInner::Scalar(naga::Scalar {
            kind: naga::ScalarKind::Uint,
            ..
        }) => Ok(Value::Index(0)),
        TypeInner::Scalar(naga::Scalar {
            kind: naga::ScalarKind::Bool,
            ..
        }) => Ok(Value::Bools(Arc::new([false; L]))),
        TypeInner::Vector { size, .. } => Ok(copies(size as usize, Value::Uniform(0.0))),
        TypeInner::Matrix { columns, rows, .. } => {
            Ok(copies(columns as usize, copies(rows as usize, Value::Uniform(0.0))))
        }
        TypeInner::Array {
            base,
            size: naga::ArraySize::Constant(n),
            ..
        } => Ok(copies(n.get() as usize, zero(module, base)?)),
        ref other => unsupported(other),
    }
}

fn literal_value<const L: usize>(literal: Literal) -> Result<Value<L>> {
    match literal {
        Literal::F32(x) => Ok(Value::Uniform(x)),
        Literal::F16(x) => Ok(Value::Uniform(x.to_f32())),
        Literal::U32(x) => Ok(Value::Index(x)),
        Literal::I32(x) => u32::try_from(x)
            .map(Value::Index)
            .map_err(|_| InterpretError::Operands("an index")),
        Literal::Bool(x) => Ok(Value::Bools(Arc::new([x; L]))),
        other => unsupported(other),
    }
}

fn splat<const L: usize>(value: Value<L>, size: usize) -> Value<L> {
    Value::Composite((0..size).map(|_| value.clone()).collect())
}

enum Flow<const L: usize> {
    Next,
    Return(Option<Value<L>>),
}

/// One running call.
struct Frame<'a, 'b, const L: usize> {
    interpreter: &'b Interpreter<'a>,
    function: &'a Function,
    /// Which expressions are f16.
    halves: &'b [bool],
    arguments: &'b [Value<L>],
    locals: Vec<Value<L>>,
    values: Vec<Option<Value<L>>>,
}

impl<'a, const L: usize> Frame<'a, '_, L> {
    fn block(&mut self, block: &naga::Block) -> Result<Flow<L>> {
        for statement in block.iter() {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        // Addresses are worked out where they are used, and so are lists, of which one item may be all
                        // that is wanted.
                        if self.place(handle).is_none() && self.list(handle).is_none() {
                            let value = self.evaluate(handle)?;
                            self.values[handle.index()] = Some(value);
                        }
                    }
                }
                Statement::Block(inner) => {
                    if let flow @ Flow::Return(_) = self.block(inner)? {
                        return Ok(flow);
                    }
                }
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let Value::Bools(c) = self.value(*condition)? else {
                        return Err(InterpretError::Operands("if"));
                    };
                    if c.iter().any(|&b| b != c[0]) {
                        return Err(InterpretError::Divergent);
                    }
                    if let flow @ Flow::Return(_) = self.block(if c[0] { accept } else { reject })? {
                        return Ok(flow);
                    }
                }
                Statement::Return { value } => return Ok(Flow::Return(value.map(|v| self.value(v)).transpose()?)),
                Statement::Store { pointer, value } => {
                    let value = self.value(*value)?;
                    let (local, path) = self.place(*pointer).ok_or(InterpretError::Operands("a store"))?;
                    store(&mut self.locals[local], &path, value)?;
                }
                Statement::Call {
                    function,
                    arguments,
                    result,
                } => {
                    let places: Vec<_> = arguments.iter().map(|&a| self.place(a)).collect();
                    let values = arguments.iter().zip(&places).map(|(&a, place)| match place {
                        Some(place) => self.load(place),
                        None => self.value(a),
                    });
                    let values = values.collect::<Result<Vec<_>>>()?;
                    let (value, pointed) = self.interpreter.run(*function, values)?;
                    for (place, value) in places.into_iter().zip(pointed) {
                        if let Some((local, path)) = place {
                            store(&mut self.locals[local], &path, value)?;
                        }
                    }
                    if let Some(result) = result {
                        self.values[result.index()] = Some(value.ok_or(InterpretError::NoValue)?);
                    }
                }
                other => return unsupported(other),
            }
        }
        Ok(Flow::Next)
    }

    /// The local variable, and the way to a part of it, that an address expression names.
    fn place(&self, handle: Handle<Expression>) -> Option<(usize, Vec<usize>)> {
        match &self.function.expressions[handle] {
            Expression::LocalVariable(local) => Some((local.index(), Vec::new())),
            Expression::FunctionArgument(index) => {
                let ty = self.function.arguments.get(*index as usize)?.ty;
                let pointer = matches!(self.interpreter.module.types[ty].inner, TypeInner::Pointer { .. });
                pointer.then(|| (self.function.local_variables.len() + *index as usize, Vec::new()))
            }
            Expression::AccessIndex { base, index } => self.place(*base).map(|(local, mut path)| {
                path.push(*index as usize);
                (local, path)
            }),
            Expression::Access { base, index } => {
                let (local, mut path) = self.place(*base)?;
                path.push(self.index(*index).ok()?);
                Some((local, path))
            }
            _ => None,
        }
    }

    fn load(&self, (local, path): &(usize, Vec<usize>)) -> Result<Value<L>> {
        path.iter()
            .try_fold(self.locals[*local].clone(), |value, &index| value.item(index))
    }

    /// An index that is the same in every lane.
    fn index(&self, handle: Handle<Expression>) -> Result<usize> {
        match &self.function.expressions[handle] {
            Expression::Literal(Literal::U32(i)) => Ok(*i as usize),
            Expression::Literal(Literal::I32(i)) => {
                usize::try_from(*i).map_err(|_| InterpretError::Operands("an index"))
            }
            Expression::As {
                expr,
                kind: naga::ScalarKind::Sint | naga::ScalarKind::Uint,
                ..
            } => self.index(*expr),
            other => unsupported(other),
        }
    }

    /// The value of an expression that is known already, or needs no statement to become so.
    fn value(&mut self, handle: Handle<Expression>) -> Result<Value<L>> {
        match self.values.get(handle.index()) {
            Some(Some(value)) => Ok(value.clone()),
            _ => {
                let value = self.evaluate(handle)?;
                if let Some(slot) = self.values.get_mut(handle.index()) {
                    *slot = Some(value.clone());
                }
                Ok(value)
            }
        }
    }

    /// The items of an array or a matrix that an expression puts together.
    fn list(&self, handle: Handle<Expression>) -> Option<&'a [Handle<Expression>]> {
        match &self.function.expressions[handle] {
            Expression::Compose { ty, components } => match self.interpreter.module.types[*ty].inner {
                TypeInner::Array { .. } | TypeInner::Matrix { .. } => Some(components),
                _ => None,
            },
            _ => None,
        }
    }

    /// A part of a composite. Of a constant or a list only that part is brought into the lanes: front ends repeat a
    /// whole constant array at each use.
    fn item(&mut self, base: Handle<Expression>, index: usize) -> Result<Value<L>> {
        match &self.function.expressions[base] {
            Expression::Constant(constant) => self.interpreter.constants[constant.index()]
                .as_ref()
                .map_err(Clone::clone)?
                .item(index)?
                .in_lanes(),
            _ => match self.list(base) {
                Some(items) => self.value(*items.get(index).ok_or(InterpretError::Operands("an index"))?),
                None => self.value(base)?.item(index),
            },
        }
    }

    fn evaluate(&mut self, handle: Handle<Expression>) -> Result<Value<L>> {
        let half = self.halves.get(handle.index()).copied().unwrap_or(false);
        match &self.function.expressions[handle] {
            // Results of one operation are rounded once; conversions to f16 too.
            Expression::Binary { .. } | Expression::Math { .. } | Expression::As { .. } if half => {
                self.evaluate_with(handle, &round_f16_of_f32)?.map(&round_f16_of_f32)
            }
            _ => self.evaluate_with(handle, &|x| x),
        }
    }

    /// `round` is applied within operations that are sums of products.
    fn evaluate_with(&mut self, handle: Handle<Expression>, round: &impl Fn(f32) -> f32) -> Result<Value<L>> {
        match &self.function.expressions[handle] {
            Expression::Literal(literal) => literal_value(*literal),
            Expression::Constant(constant) => self.interpreter.constant_value(*constant),
            Expression::ZeroValue(ty) => zero(self.interpreter.module, *ty),
            Expression::Compose { ty, components } => {
                let parts: Vec<Value<L>> = components.iter().map(|&c| self.value(c)).collect::<Result<_>>()?;
                // Vectors are parts of a longer vector number by number.
                let is_vector = matches!(self.interpreter.module.types[*ty].inner, TypeInner::Vector { .. });
                let spliced = parts.into_iter().flat_map(|part| match part {
                    Value::Composite(numbers) if is_vector => numbers.to_vec(),
                    part => vec![part],
                });
                Ok(Value::Composite(spliced.collect()))
            }
            Expression::Splat { size, value } => Ok(splat(self.value(*value)?, *size as usize)),
            Expression::FunctionArgument(index) => self
                .arguments
                .get(*index as usize)
                .cloned()
                .ok_or(InterpretError::Operands("a call")),
            Expression::AccessIndex { base, index } => self.item(*base, *index as usize),
            Expression::Access { base, index } => self.item(*base, self.index(*index)?),
            Expression::Load { pointer } => {
                let place = self.place(*pointer).ok_or(InterpretError::Operands("a load"))?;
                self.load(&place)
            }
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(*vector)?;
                (0..*size as usize)
                    .map(|i| vector.item(pattern[i] as usize))
                    .collect::<Result<_>>()
                    .map(Value::Composite)
            }
            Expression::Unary {
                op: UnaryOperator::Negate,
                expr,
            } => self.value(*expr)?.map(&|x| -x),
            Expression::Binary { op, left, right } => binary(*op, &self.value(*left)?, &self.value(*right)?, round),
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => match self.value(*expr)? {
                Value::Bools(b) => Ok(Value::Bools(Arc::new(b.map(|b| !b)))),
                _ => Err(InterpretError::Operands("!")),
            },
            Expression::As { expr, kind, convert } => converted(self.value(*expr)?, *kind, *convert),
            Expression::Select {
                condition,
                accept,
                reject,
            } => Value::select(&self.value(*condition)?, &self.value(*accept)?, &self.value(*reject)?),
            Expression::Math {
                fun, arg, arg1, arg2, ..
            } => {
                let a = self.value(*arg)?;
                let b = arg1.map(|b| self.value(b)).transpose()?;
                let c = arg2.map(|c| self.value(c)).transpose()?;
                math(*fun, &a, b.as_ref(), c.as_ref(), round)
            }
            other => unsupported(other),
        }
    }
}

/// An operation on two values; `round` is applied within sums of products.
fn binary<const L: usize>(
    op: BinaryOperator,
    a: &Value<L>,
    b: &Value<L>,
    round: &impl Fn(f32) -> f32,
) -> Result<Value<L>> {
    if let Some(value) = a.words_with(b, op).or_else(|| a.bools_with(b, op)) {
        return value;
    }
    match op {
        BinaryOperator::Add => a.zip(b, &|a, b| a + b),
        BinaryOperator::Subtract => a.zip(b, &|a, b| a - b),
        BinaryOperator::Multiply => a.multiply(b, round),
        BinaryOperator::Divide => a.zip(b, &|a, b| a / b),
        BinaryOperator::Less => a.compare(b, |a, b| a < b),
        BinaryOperator::LessEqual => a.compare(b, |a, b| a <= b),
        BinaryOperator::Greater => a.compare(b, |a, b| a > b),
        BinaryOperator::GreaterEqual => a.compare(b, |a, b| a >= b),
        BinaryOperator::Equal => a.compare(b, |a, b| a == b),
        BinaryOperator::NotEqual => a.compare(b, |a, b| a != b),
        other => unsupported(other),
    }
}

/// A value as another kind of number; without a width its bits are taken.
fn converted<const L: usize>(value: Value<L>, kind: naga::ScalarKind, convert: Option<u8>) -> Result<Value<L>> {
    match (kind, convert, value.words()) {
        (naga::ScalarKind::Float, Some(2 | 4), None) => Ok(value),
        (naga::ScalarKind::Float, Some(4), Some(words)) => Ok(Value::each(|lane| words[lane] as f32)),
        (naga::ScalarKind::Float, None, Some(words)) => Ok(Value::each(|lane| f32::from_bits(words[lane]))),
        (naga::ScalarKind::Uint, Some(4), Some(_)) => Ok(value),
        (naga::ScalarKind::Uint, _, None) => {
            let mut words = [0; L];
            for (lane, word) in words.iter_mut().enumerate() {
                let x = value.lane(lane)?;
                *word = if convert.is_some() { x as u32 } else { x.to_bits() };
            }
            Ok(Value::Words(Arc::new(words)))
        }
        _ => unsupported(format_args!("As")),
    }
}

/// A function of the language; `round` is applied within sums of products.
fn math<const L: usize>(
    fun: MathFunction,
    a: &Value<L>,
    b: Option<&Value<L>>,
    c: Option<&Value<L>>,
    round: &impl Fn(f32) -> f32,
) -> Result<Value<L>> {
    match (fun, b, c) {
        (MathFunction::Max | MathFunction::Min, Some(b), None) if a.words().is_some() => {
            let (a, b) = (a.words(), b.words());
            let (Some(a), Some(b)) = (a, b) else {
                return Err(InterpretError::Operands("min or max"));
            };
            let greater = fun == MathFunction::Max;
            let chosen = |l: usize| if greater { a[l].max(b[l]) } else { a[l].min(b[l]) };
            Ok(Value::Words(Arc::new(std::array::from_fn(chosen))))
        }
        (MathFunction::Exp, None, None) => a.map(&libm::expf),
        (MathFunction::Exp2, None, None) => a.map(&libm::exp2f),
        (MathFunction::Log2, None, None) => a.map(&libm::log2f),
        (MathFunction::Floor, None, None) => a.map(&f32::floor),
        (MathFunction::Log, None, None) => a.map(&libm::logf),
        (MathFunction::Abs, None, None) => a.map(&f32::abs),
        (MathFunction::Sqrt, None, None) => a.map(&f32::sqrt),
        (MathFunction::Max, Some(b), None) => a.zip(b, &f32::max),
        (MathFunction::Min, Some(b), None) => a.zip(b, &f32::min),
        (MathFunction::Dot, Some(b), None) => a.dot(b, round),
        (MathFunction::Clamp, Some(b), Some(c)) => a.zip(b, &f32::max)?.zip(c, &f32::min),
        (other, ..) => unsupported(other),
    }
}

fn store<const L: usize>(target: &mut Value<L>, path: &[usize], value: Value<L>) -> Result<()> {
    match path.split_first() {
        None => {
            *target = value;
            Ok(())
        }
        Some((&index, rest)) => match target {
            Value::Composite(items) => {
                let mut changed = items.to_vec();
                store(
                    changed.get_mut(index).ok_or(InterpretError::Operands("an index"))?,
                    rest,
                    value,
                )?;
                *target = Value::Composite(changed.into());
                Ok(())
            }
            _ => Err(InterpretError::Operands("a store")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(source: &str) -> Module {
        naga::front::wgsl::parse_str(source).unwrap()
    }

    fn call(source: &str, arguments: &[f32]) -> Result<f32> {
        let module = module(source);
        Interpreter::new(&module)
            .call::<1>("f", arguments.iter().map(|&a| Value::Uniform(a)).collect())?
            .lane(0)
    }

    #[test]
    fn arithmetic_vectors_and_matrices() {
        assert_eq!(
            call("fn f(x: f32) -> f32 { return -x * 2.0 + max(x, 1.0) / 4.0; }", &[3.0]),
            Ok(-5.25)
        );
        assert_eq!(
            call(
                "fn f(x: f32) -> f32 { return dot(vec3<f32>(x, 2.0, 3.0), vec3<f32>(1.0, x, 2.0)); }",
                &[4.0]
            ),
            Ok(18.0)
        );
        let matrix = "fn f(x: f32) -> f32 { let m = mat2x2<f32>(vec2<f32>(1.0, 2.0), vec2<f32>(3.0, x)); return (m * \
            vec2<f32>(10.0, 1.0)).y; }";
        assert_eq!(call(matrix, &[4.0]), Ok(24.0));
        assert_eq!(
            call(
                "fn f(x: f32) -> f32 { var v = vec4<f32>(x); v.y = 7.0; return v.zyx.y; }",
                &[4.0]
            ),
            Ok(7.0)
        );
        assert_eq!(
            call(
                "fn f(x: f32) -> f32 { let v = vec4<f32>(vec3<f32>(1.0, 2.0, x).yz, x, 5.0); return v.y + 10.0 * v.w; \
                    }",
                &[4.0]
            ),
            Ok(54.0)
        );
        // Numbers in a row fill the columns of a matrix, and 0 the rest.
        let module = module("fn f(m: mat2x4<f32>) -> f32 { return m[0].w + 10.0 * m[1].x + 100.0 * m[1].y; }");
        let rows = [[1.0, 2.0, 3.0, 4.0, 5.0], [0.0; 5]].concat();
        assert_eq!(Interpreter::new(&module).call_rows("f", &rows, 5), Ok(vec![54.0, 0.0]));
        assert_eq!(
            call("fn f(x: f32) -> f32 { return exp(x); }", &[1.0]),
            Ok(std::f32::consts::E)
        );
    }

    /// Words of 32 bits: packing, unpacking, comparison, and the way to numbers and back.
    #[test]
    fn words() {
        let source = "fn f(x: f32, y: f32) -> f32 {
            let code = (bitcast<u32>(x) & 0xfffff000u) | min(u32(y), 4095u);
            let low = code & 0xfffu;
            let sum = f32(low) + bitcast<f32>(code ^ low);
            return select(-1.0, sum, (low << 2u) >> 2u == low && !(code < low));
        }";
        // 1.5 keeps its bits, of which the last twelve are 0.
        assert_eq!(call(source, &[1.5, 7.9]), Ok(8.5));
        assert_eq!(call(source, &[1.5, 5000.0]), Ok(4096.5));
        assert_eq!(
            call("fn f(x: f32) -> f32 { return exp2(floor(log2(x))); }", &[5.0]),
            Ok(4.0)
        );
    }

    #[test]
    fn branches_calls_and_selects() {
        let source = "fn g(x: f32) -> f32 { if x > 1.0 { return 10.0; } return select(1.0, 2.0, x > 0.0); } fn f(x: \
            f32) -> f32 { return g(x) + 0.5; }";
        assert_eq!(call(source, &[2.0]), Ok(10.5));
        assert_eq!(call(source, &[0.5]), Ok(2.5));
        assert_eq!(call(source, &[-1.0]), Ok(1.5));
    }

    /// Every f16 result is rounded, within sums of products too, and what is f32 is not.
    #[test]
    fn half_precision() {
        let half = |body: &str, x: f32| call(&format!("enable f16; fn f(x: f32) -> f32 {{ {body} }}"), &[x]);
        // The spacing of halves is 2 from 2048 on, 1 below.
        assert_eq!(half("return f32(f16(x));", 2049.0), Ok(2048.0));
        assert_eq!(half("return f32(f16(x) + 1.0h) + 1.0;", 2048.0), Ok(2049.0));
        assert_eq!(
            half(
                "return f32(dot(vec3<f16>(f16(x), 1.0h, 1.0h), vec3<f16>(1.0h)));",
                2048.0
            ),
            Ok(2048.0)
        );
        assert_eq!(
            half("return dot(vec3<f32>(x, 1.0, 1.0), vec3<f32>(1.0));", 2048.0),
            Ok(2050.0)
        );
        let product = "let m = mat2x2<f16>(vec2<f16>(1.0h, 2.0h), vec2<f16>(1.0h, 1.0h)); return f32((m * \
            vec2<f16>(f16(x), 1.0h)).x);";
        assert_eq!(half(product, 2048.0), Ok(2048.0));
        assert_eq!(half("return f32(max(f16(x) * 0.1h, 0.0h));", 1.0), Ok(0.099975586));
    }

    /// What a pointer points to comes back from a call.
    #[test]
    fn pointers_are_copied_in_and_out() {
        let source = "fn g(x: f32, y: ptr<function, array<f32, 2>>) { (*y)[1] = x + (*y)[0]; }
            fn f(x: f32) -> f32 { var a = array<f32, 2>(10.0, 0.0); g(x, &a); return a[1]; }";
        assert_eq!(call(source, &[2.0]), Ok(12.0));
        let module = module("fn f_0() -> f32 { return 1.0; } fn ff() -> f32 { return 2.0; }");
        assert_eq!(Interpreter::new(&module).function_like("f"), Ok("f_0"));
        assert!(Interpreter::new(&module).function_like("g").is_err());
    }

    /// Rows that take different branches still get each its own answer.
    #[test]
    fn divergent_rows() {
        let module = module("fn f(x: array<f32, 2>) -> f32 { if x[0] > 0.0 { return x[1]; } return -1.0; }");
        let rows = [1.0, 5.0, -1.0, 6.0, 2.0, 7.0];
        assert_eq!(
            Interpreter::new(&module).call_rows("f", &rows, 2),
            Ok(vec![5.0, -1.0, 7.0])
        );
    }

    #[test]
    fn what_is_not_supported_is_named() {
        assert_eq!(
            call("fn f(x: f32) -> f32 { return sin(x); }", &[1.0]),
            Err(InterpretError::Unsupported("Sin".to_owned()))
        );
        let run_time_index = "const W = array<f32, 2>(1.0, 2.0); fn f(x: f32) -> f32 { return W[u32(x)]; }";
        assert!(matches!(
            call(run_time_index, &[1.0]),
            Err(InterpretError::Unsupported(_))
        ));
        assert!(matches!(
            Interpreter::new(&module("")).call::<1>("f", vec![]),
            Err(InterpretError::NoFunction(_))
        ));
    }
}
