//! [`ComputeShader`]: the functions of a part as entry points.

use crate::function::functions;
use crate::part::{Part, source};
use naga::{ArraySize, FunctionArgument, Handle, ImageDimension, Module, ScalarKind, Type};
use naga::{Function, TypeInner};
use std::fmt::Write;

/// A compute shader with an entry point for each function of a part, which evaluates it for rows of numbers.
///
/// An invocation reads the arguments of a call from the storage buffer of binding 0 and writes the result to that of binding 1: rows of
/// f32, without padding, one a call. Values stand in the order of arguments, of the members of structs and of components; integers
/// are stored as numbers and booleans as 0 and 1. As many calls are made as rows of results fit into their buffer. Binding 2 is a sampler
/// and [`ComputeShader::textures`] are those from [`ComputeShader::FIRST_TEXTURE`] on; a function needs only the bindings that it uses.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComputeShader {
    /// The shader in WGSL.
    pub wgsl: String,
    /// Its entry points, in the order of the functions.
    pub entry_points: Vec<ComputeEntryPoint>,
    /// The textures that functions take.
    pub textures: Vec<ComputeTexture>,
}

/// An entry point of a [`ComputeShader`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComputeEntryPoint {
    /// Name of the function that it calls.
    pub function: &'static str,
    /// Numbers of a row of arguments.
    pub arguments: usize,
    /// Numbers of a row of results.
    pub results: usize,
    /// Places in [`ComputeShader::textures`] of those that the function takes.
    pub textures: Vec<usize>,
}

/// A texture of a [`ComputeShader`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ComputeTexture {
    /// Name of the arguments that it is passed as.
    pub argument: String,
    /// Its dimension, 2 or 3.
    pub dimension: u32,
}

impl ComputeEntryPoint {
    /// Name of the entry point in WGSL; in SPIR-V it is that of the function.
    pub fn name(&self) -> String {
        format!("{PREFIX}{}", self.function)
    }
}

impl ComputeTexture {
    /// Name of the binding: that of the argument and the dimension.
    pub fn name(&self) -> String {
        format!("{}_{}d", self.argument, self.dimension)
    }
}

/// Start of the names of entry points, which may not be those of functions.
pub(crate) const PREFIX: &str = "run_";

impl ComputeShader {
    /// Invocations of a workgroup.
    pub const WORKGROUP_SIZE: u32 = 64;
    /// Binding of the sampler.
    pub const SAMPLER: u32 = 2;
    /// Binding of the first texture.
    pub const FIRST_TEXTURE: u32 = 3;

    /// The functions of a part, without those of the parts that it requires.
    ///
    /// # Panics
    /// Never: the tests run the shaders of all parts.
    pub fn new(part: Part) -> Self {
        let text = source(&[part]);
        let module = naga::front::wgsl::parse_str(&text).expect("the library");
        let mut shader = Self {
            wgsl: text,
            entry_points: Vec::new(),
            textures: Vec::new(),
        };
        let mut bodies = String::new();
        for function in functions(part) {
            let named = |f: &&Function| f.name.as_deref() == Some(function.name);
            let mut all = module.functions.iter().map(|(_, function)| function);
            let parsed = all.find(named).expect("a function of the part");
            bodies += &shader.add(&module, function.name, parsed);
        }
        shader.declare(&bodies);
        shader
    }

    /// Adds a function; returns its entry point in WGSL.
    fn add(&mut self, module: &Module, name: &'static str, function: &Function) -> String {
        let mut numbers = 0;
        let mut textures = Vec::new();
        let mut values = Vec::new();
        for argument in &function.arguments {
            values.push(match module.types[argument.ty].inner {
                TypeInner::Image { dim, .. } => {
                    let (place, name) = self.texture(argument, dim);
                    textures.push(place);
                    name
                }
                TypeInner::Sampler { .. } => "sampler_of_all".to_owned(),
                _ => read(module, argument.ty, &mut numbers),
            });
        }
        let result = function.result.as_ref().expect("a result");
        let results = written(module, result.ty, "result");
        let mut body = format!(
            "
@compute @workgroup_size({size})
fn {PREFIX}{name}(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (id.x + 1u) * {width}u > arrayLength(&results) {{
        return;
    }}
    let first = id.x * {numbers}u;
    let result = {name}({values});
    let into = id.x * {width}u;
",
            size = Self::WORKGROUP_SIZE,
            width = results.len(),
            values = values.join(", "),
        );
        for (k, number) in results.iter().enumerate() {
            writeln!(body, "    results[into + {k}u] = {number};").expect("a text");
        }
        self.entry_points.push(ComputeEntryPoint {
            function: name,
            arguments: numbers,
            results: results.len(),
            textures,
        });
        body + "}\n"
    }

    /// Place and name of the texture of an argument.
    fn texture(&mut self, argument: &FunctionArgument, dim: ImageDimension) -> (usize, String) {
        let texture = ComputeTexture {
            argument: argument.name.clone().expect("the name of an argument"),
            dimension: match dim {
                ImageDimension::D3 => 3,
                _ => 2,
            },
        };
        let name = texture.name();
        let known = self.textures.iter().position(|known| *known == texture);
        let place = known.unwrap_or_else(|| {
            self.textures.push(texture);
            self.textures.len() - 1
        });
        (place, name)
    }

    /// Appends bindings and entry points to the functions.
    fn declare(&mut self, bodies: &str) {
        let text = &mut self.wgsl;
        text.push_str(
            "
@group(0) @binding(0) var<storage, read> arguments: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<f32>;
",
        );
        if !self.textures.is_empty() {
            let binding = Self::SAMPLER;
            writeln!(
                text,
                "@group(0) @binding({binding}) var sampler_of_all: sampler;"
            )
            .expect("a text");
        }
        for (texture, binding) in self.textures.iter().zip(Self::FIRST_TEXTURE..) {
            let (name, dimension) = (texture.name(), texture.dimension);
            writeln!(
                text,
                "@group(0) @binding({binding}) var {name}: texture_{dimension}d<f32>;"
            )
            .expect("a text");
        }
        text.push_str(bodies);
    }
}

/// WGSL expression of a value made of the next numbers of a row of arguments.
fn read(module: &Module, ty: Handle<Type>, at: &mut usize) -> String {
    let mut next = || {
        *at += 1;
        format!("arguments[first + {}u]", *at - 1)
    };
    let parts: Vec<String> = match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => {
            let number = next();
            return match scalar.kind {
                ScalarKind::Float => number,
                ScalarKind::Bool => format!("({number} != 0.0)"),
                kind => format!("{}({number})", scalar_name(kind)),
            };
        }
        TypeInner::Vector { size, .. } => (0..*size as u8).map(|_| next()).collect(),
        TypeInner::Struct { members, .. } => {
            let members = members.iter();
            members.map(|member| read(module, member.ty, at)).collect()
        }
        TypeInner::Array { base, size, .. } => {
            (0..length(size)).map(|_| read(module, *base, at)).collect()
        }
        other => unreachable!("no function takes {other:?}"),
    };
    format!("{}({})", type_name(module, ty), parts.join(", "))
}

/// WGSL expressions of the numbers of a value.
fn written(module: &Module, ty: Handle<Type>, value: &str) -> Vec<String> {
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
                written(module, member.ty, &format!("{value}.{name}"))
            })
            .collect(),
        TypeInner::Array { base, size, .. } => (0..length(size))
            .flat_map(|k| written(module, *base, &format!("{value}[{k}]")))
            .collect(),
        other => unreachable!("no function returns {other:?}"),
    }
}

/// WGSL name of a type.
pub(crate) fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let ty = &module.types[ty];
    match &ty.inner {
        TypeInner::Scalar(scalar) => scalar_name(scalar.kind).to_owned(),
        TypeInner::Vector { size, scalar } => {
            format!("vec{}<{}>", *size as u8, scalar_name(scalar.kind))
        }
        TypeInner::Matrix {
            columns,
            rows,
            scalar,
        } => format!(
            "mat{}x{}<{}>",
            *columns as u8,
            *rows as u8,
            scalar_name(scalar.kind)
        ),
        TypeInner::Array { base, size, .. } => match size {
            ArraySize::Dynamic => format!("array<{}>", type_name(module, *base)),
            size => format!("array<{}, {}>", type_name(module, *base), length(size)),
        },
        _ => ty.name.clone().expect("the name of a struct"),
    }
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        ScalarKind::Bool => "bool",
        other => unreachable!("no function uses {other:?}"),
    }
}

fn length(size: &ArraySize) -> u32 {
    match size {
        ArraySize::Constant(count) => count.get(),
        other => unreachable!("no array of the functions has the size {other:?}"),
    }
}
