//! The library as naga reads it: arguments and results of its functions.

use crate::textures;
use airlight::Named;
use airlight_shaders::{Part, source};
use naga::{
    Function, FunctionArgument, Handle, ImageDimension, Module, ScalarKind, Type, TypeInner,
};

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
