//! [`Cost`]: what the functions of a shader evaluate.

use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Expression, Function, Handle, MathFunction, Module, Statement, TypeInner};
use std::fmt;

/// What a function evaluates at most, with all that it calls, along the costliest path through its branches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
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

/// Error of [`costs`]: what the reader of shaders reports.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a valid WGSL shader, got: {0}")]
pub struct CostError(pub String);

/// Names and costs of the functions of a WGSL shader, and of its entry points.
///
/// # Errors
/// [`CostError`] for an invalid shader.
pub fn costs(wgsl: &str) -> Result<Vec<(String, Cost)>, CostError> {
    let shader = Shader::read(wgsl)?;
    let (module, info) = (&shader.module, &shader.info);
    let functions = module.functions.iter().map(|(handle, function)| {
        let name = function.name.clone().unwrap_or_default();
        (name, shader.function(handle))
    });
    let entries = module.entry_points.iter().enumerate().map(|(k, entry)| {
        let cost = shader.body(&entry.function, info.get_entry_point(k));
        (entry.name.clone(), cost)
    });
    Ok(functions.chain(entries).collect())
}

impl Cost {
    pub(crate) fn plus(self, other: Self) -> Self {
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
}

/// As the documentation of the functions states it: `12 exp, 4 reads`.
impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
            true => f.write_str("no exp"),
            false => f.write_str(&parts.join(", ")),
        }
    }
}

/// A module whose expressions have known types.
pub(crate) struct Shader {
    pub module: Module,
    info: ModuleInfo,
}

impl Shader {
    /// A shader in WGSL.
    pub fn read(wgsl: &str) -> Result<Self, CostError> {
        let module = naga::front::wgsl::parse_str(wgsl)
            .map_err(|error| CostError(error.emit_to_string(wgsl)))?;
        Self::of(module, wgsl)
    }

    /// A valid module, with the text that it is from.
    pub fn of(module: Module, wgsl: &str) -> Result<Self, CostError> {
        let info = Validator::new(ValidationFlags::all(), Capabilities::DUAL_SOURCE_BLENDING)
            .validate(&module)
            .map_err(|error| CostError(error.emit_to_string(wgsl)))?;
        Ok(Self { module, info })
    }

    /// The shader in WGSL.
    pub fn text(&self) -> Result<String, CostError> {
        let flags = naga::back::wgsl::WriterFlags::empty();
        naga::back::wgsl::write_string(&self.module, &self.info, flags)
            .map_err(|error| CostError(error.to_string()))
    }

    /// Costs of the expressions of each function, then of each entry point.
    pub fn costs_of_expressions(&self) -> impl Iterator<Item = Vec<Cost>> {
        let (module, info) = (&self.module, &self.info);
        let functions = module.functions.iter();
        let functions = functions.map(|(handle, function)| (function, &info[handle]));
        let entries = module.entry_points.iter().enumerate();
        let entries = entries.map(|(k, entry)| (&entry.function, info.get_entry_point(k)));
        functions.chain(entries).map(|(function, info)| {
            let all = function.expressions.iter();
            all.map(|(expression, _)| self.expression(function, info, expression))
                .collect()
        })
    }

    fn function(&self, handle: Handle<Function>) -> Cost {
        self.body(&self.module.functions[handle], &self.info[handle])
    }

    fn body(&self, function: &Function, info: &FunctionInfo) -> Cost {
        self.block(function, info, &function.body)
    }

    fn expression(
        &self,
        function: &Function,
        info: &FunctionInfo,
        expression: Handle<Expression>,
    ) -> Cost {
        let one = |exp: u32, reads: u32| Cost {
            exp,
            reads,
            ..Cost::default()
        };
        match &function.expressions[expression] {
            Expression::Math {
                fun:
                    MathFunction::Exp
                    | MathFunction::Exp2
                    | MathFunction::Log
                    | MathFunction::Log2
                    | MathFunction::Pow,
                ..
            } => match info[expression].ty.inner_with(&self.module.types) {
                TypeInner::Vector { size, .. } => one(*size as u32, 0),
                _ => one(1, 0),
            },
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } => one(0, 1),
            _ => Cost::default(),
        }
    }

    /// Cost of statements up to the end of the function, along the costliest path.
    fn block(&self, function: &Function, info: &FunctionInfo, body: &Block) -> Cost {
        let mut total = Cost::default();
        let after = |branch: &Block, rest: Cost| {
            let cost = self.block(function, info, branch);
            match returns(branch) {
                true => cost,
                false => cost.plus(rest),
            }
        };
        // From the last statement on, as a branch that returns skips what follows.
        for statement in body.iter().rev() {
            let here = match statement {
                Statement::Emit(range) => range
                    .clone()
                    .map(|expression| self.expression(function, info, expression))
                    .fold(Cost::default(), Cost::plus),
                Statement::Call { function, .. } => self.function(*function),
                Statement::Block(inner) => self.block(function, info, inner),
                Statement::If { accept, reject, .. } => {
                    total = after(accept, total).most(after(reject, total));
                    continue;
                }
                Statement::Switch { cases, .. } => {
                    let costs = cases.iter().map(|case| after(&case.body, total));
                    total = costs.fold(Cost::default(), Cost::most);
                    continue;
                }
                Statement::Loop {
                    body, continuing, ..
                } => {
                    let [body, continuing] =
                        [body, continuing].map(|inner| self.block(function, info, inner));
                    body.plus(continuing).a_step()
                }
                _ => Cost::default(),
            };
            total = total.plus(here);
        }
        total
    }
}

fn returns(body: &Block) -> bool {
    match body.last() {
        Some(Statement::Return { .. }) => true,
        Some(Statement::Block(inner)) => returns(inner),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_costliest_path_counts() {
        let shader = "
            @group(0) @binding(0) var t: texture_2d<f32>;
            fn read(p: vec2<i32>) -> vec3<f32> { return exp(textureLoad(t, p, 0).xyz); }
            @fragment fn main(@builtin(position) p: vec4<f32>) -> @location(0) vec4<f32> {
                if p.x < 1.0 { return vec4<f32>(0.0); }
                var sum = read(vec2<i32>(p.xy));
                for (var k = 0; k < 8; k++) { sum += exp(p.x * f32(k)); }
                return vec4<f32>(sum, 1.0);
            }";
        let all = costs(shader).unwrap();
        let words: Vec<_> = all
            .iter()
            .map(|(name, cost)| (name.as_str(), cost.to_string()))
            .collect();
        assert_eq!(words[0], ("read", "3 exp, 1 read".to_owned()));
        assert_eq!(words[1], ("main", "3 exp, 1 exp a step, 1 read".to_owned()));
        assert!(costs("fn f(").is_err());
    }
}
