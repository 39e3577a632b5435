//! The library as naga reads it: arguments, results and costs of its functions.

use crate::textures;
use airlight::Named;
use airlight_shaders::{Part, source};
use naga::{
    Block, Expression, Function, FunctionArgument, Handle, ImageDimension, MathFunction, Module,
    ScalarKind, Statement,
};
use naga::{Type, TypeInner};

/// All parts.
pub fn whole() -> Module {
    naga::front::wgsl::parse_str(&source(Part::ALL))
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source(Part::ALL))))
}

/// The function of this name.
pub fn function<'a>(module: &'a Module, name: &str) -> &'a Function {
    let named = |function: &&Function| function.name.as_deref() == Some(name);
    let mut functions = module.functions.iter().map(|(_, function)| function);
    functions.find(named).expect("a function of the library")
}

/// WGSL name of a type.
pub fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let ty = &module.types[ty];
    match &ty.inner {
        TypeInner::Scalar(scalar) => scalar_name(scalar.kind).to_owned(),
        TypeInner::Vector { size, scalar } => {
            format!("vec{}<{}>", *size as u8, scalar_name(scalar.kind))
        }
        TypeInner::Array { base, size, .. } => {
            format!("array<{}, {}>", type_name(module, *base), length(size))
        }
        _ => ty.name.clone().expect("the name of a struct"),
    }
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        ScalarKind::Bool => "bool",
        other => panic!("{other:?}"),
    }
}

fn length(size: &naga::ArraySize) -> u32 {
    match size {
        naga::ArraySize::Constant(count) => count.get(),
        other => panic!("{other:?}"),
    }
}

/// WGSL expression of an argument: a texture or sampler of the tests, or a value as of [`read`].
pub fn argument(
    module: &Module,
    argument: &FunctionArgument,
    numbers: &str,
    at: &mut usize,
) -> String {
    match module.types[argument.ty].inner {
        TypeInner::Image { .. } => texture_name(module, argument),
        TypeInner::Sampler { .. } => "linear_sampler_of_all".to_owned(),
        _ => read(module, argument.ty, numbers, at),
    }
}

/// Name of the test's texture for an argument: its own name and the dimension.
fn texture_name(module: &Module, argument: &FunctionArgument) -> String {
    let TypeInner::Image { dim, .. } = module.types[argument.ty].inner else {
        panic!("a texture");
    };
    let name = argument.name.as_deref().expect("the name of an argument");
    let dimension = match dim {
        ImageDimension::D3 => 3,
        _ => 2,
    };
    format!("{name}_{dimension}d")
}

/// The textures that a function takes: places and names in [`textures::NAMES`].
pub fn textures(module: &Module, function: &Function) -> impl Iterator<Item = (u32, &'static str)> {
    let is_texture = |argument: &&FunctionArgument| {
        matches!(module.types[argument.ty].inner, TypeInner::Image { .. })
    };
    let arguments = function.arguments.iter().filter(is_texture);
    let names: Vec<String> = arguments.map(|a| texture_name(module, a)).collect();
    let all = textures::NAMES.iter().enumerate();
    all.filter(move |(_, name)| names.iter().any(|n| n == *name))
        .map(|(place, name)| (place as u32, *name))
}

/// WGSL expression of a value made of `numbers[at]`, `numbers[at + 1]` ..; advances `at`.
pub fn read(module: &Module, ty: Handle<Type>, numbers: &str, at: &mut usize) -> String {
    let mut parts = Vec::new();
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => {
            let number = format!("{numbers}{at}]");
            *at += 1;
            return match scalar.kind {
                ScalarKind::Float => number,
                ScalarKind::Bool => format!("({number} != 0.0)"),
                kind => format!("{}({number})", scalar_name(kind)),
            };
        }
        TypeInner::Vector { size, .. } => {
            for _ in 0..*size as u8 {
                parts.push(format!("{numbers}{at}]"));
                *at += 1;
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                parts.push(read(module, member.ty, numbers, at));
            }
        }
        TypeInner::Array { base, size, .. } => {
            for _ in 0..length(size) {
                parts.push(read(module, *base, numbers, at));
            }
        }
        other => panic!("{other:?}"),
    }
    format!("{}({})", type_name(module, ty), parts.join(", "))
}

/// WGSL expressions of the numbers of a value.
pub fn write(module: &Module, ty: Handle<Type>, value: &str) -> Vec<String> {
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => match scalar.kind {
            ScalarKind::Float => vec![value.to_owned()],
            ScalarKind::Bool => vec![format!("select(0.0, 1.0, {value})")],
            _ => vec![format!("f32({value})")],
        },
        TypeInner::Vector { size, .. } => ["x", "y", "z", "w"][..*size as usize]
            .iter()
            .map(|component| format!("{value}.{component}"))
            .collect(),
        TypeInner::Struct { members, .. } => members
            .iter()
            .flat_map(|member| {
                let name = member.name.as_deref().expect("the name of a member");
                write(module, member.ty, &format!("{value}.{name}"))
            })
            .collect(),
        TypeInner::Array { base, size, .. } => (0..length(size))
            .flat_map(|k| write(module, *base, &format!("{value}[{k}]")))
            .collect(),
        other => panic!("{other:?}"),
    }
}

/// What a function evaluates at most, along the costliest path through its branches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Exponentials, logarithms and powers of numbers (three for a vector of three).
    pub exp: u32,
    /// The same inside loops, each body once.
    pub exp_a_step: u32,
    /// Texture reads.
    pub reads: u32,
    /// Texture reads inside loops.
    pub reads_a_step: u32,
}

impl Cost {
    fn plus(self, other: Self) -> Self {
        Self {
            exp: self.exp + other.exp,
            exp_a_step: self.exp_a_step + other.exp_a_step,
            reads: self.reads + other.reads,
            reads_a_step: self.reads_a_step + other.reads_a_step,
        }
    }

    fn most(self, other: Self) -> Self {
        match self.total() >= other.total() {
            true => self,
            false => other,
        }
    }

    fn total(self) -> u32 {
        self.exp + self.exp_a_step + self.reads + self.reads_a_step
    }

    /// All of it inside a loop.
    fn a_step(self) -> Self {
        Self {
            exp: 0,
            exp_a_step: self.exp + self.exp_a_step,
            reads: 0,
            reads_a_step: self.reads + self.reads_a_step,
        }
    }

    /// As the documentation states it.
    pub fn words(self) -> String {
        let count = |n: u32, what: &str, suffix: &str| match n {
            0 => String::new(),
            n => format!("{n} {what}{suffix}"),
        };
        let plural = |n: u32| if n == 1 { "read" } else { "reads" };
        let parts = [
            count(self.exp, "exp", ""),
            count(self.exp_a_step, "exp", " a step"),
            count(self.reads, plural(self.reads), ""),
            count(self.reads_a_step, plural(self.reads_a_step), " a step"),
        ];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        match parts.is_empty() {
            true => "no exp".to_owned(),
            false => parts.join(", "),
        }
    }
}

/// Cost of a function with all that it calls.
pub fn cost(module: &Module, function: &Function) -> Cost {
    let layouter = Sizes::new(module, function);
    block(&layouter, &function.body)
}

/// A function whose expressions have known sizes.
struct Sizes<'a> {
    module: &'a Module,
    function: &'a Function,
    info: naga::valid::ModuleInfo,
    handle: Handle<Function>,
}

impl<'a> Sizes<'a> {
    fn new(module: &'a Module, function: &'a Function) -> Self {
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        );
        let info = validator.validate(module).expect("a valid module");
        let (handle, _) = module
            .functions
            .iter()
            .find(|(_, other)| other.name == function.name)
            .expect("a function of the module");
        Self {
            module,
            function,
            info,
            handle,
        }
    }

    fn of(&self, expression: Handle<Expression>) -> Cost {
        let one = |exp: u32, reads: u32| Cost {
            exp,
            reads,
            ..Cost::default()
        };
        match &self.function.expressions[expression] {
            Expression::Math {
                fun:
                    MathFunction::Exp
                    | MathFunction::Exp2
                    | MathFunction::Log
                    | MathFunction::Log2
                    | MathFunction::Pow,
                ..
            } => {
                let types = &self.module.types;
                match self.info[self.handle][expression].ty.inner_with(types) {
                    TypeInner::Vector { size, .. } => one(*size as u32, 0),
                    _ => one(1, 0),
                }
            }
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } => one(0, 1),
            _ => Cost::default(),
        }
    }
}

/// Cost of statements up to the end of the function, along the costliest path.
fn block(sizes: &Sizes, body: &Block) -> Cost {
    let mut total = Cost::default();
    // From the last statement on, as a branch that returns skips what follows.
    for statement in body.iter().rev() {
        let here = match statement {
            Statement::Emit(range) => range
                .clone()
                .map(|expression| sizes.of(expression))
                .fold(Cost::default(), Cost::plus),
            Statement::Call { function, .. } => {
                cost(sizes.module, &sizes.module.functions[*function])
            }
            Statement::Block(inner) => block(sizes, inner),
            Statement::If { accept, reject, .. } => {
                let after = |branch: &Block| {
                    let cost = block(sizes, branch);
                    match returns(branch) {
                        true => cost,
                        false => cost.plus(total),
                    }
                };
                total = after(accept).most(after(reject));
                continue;
            }
            Statement::Switch { cases, .. } => {
                let after = |branch: &Block| {
                    let cost = block(sizes, branch);
                    match returns(branch) {
                        true => cost,
                        false => cost.plus(total),
                    }
                };
                let costs = cases.iter().map(|case| after(&case.body));
                total = costs.fold(Cost::default(), Cost::most);
                continue;
            }
            Statement::Loop {
                body, continuing, ..
            } => block(sizes, body).plus(block(sizes, continuing)).a_step(),
            _ => Cost::default(),
        };
        total = total.plus(here);
    }
    total
}

fn returns(body: &Block) -> bool {
    match body.last() {
        Some(Statement::Return { .. }) => true,
        Some(Statement::Block(inner)) => returns(inner),
        _ => false,
    }
}
