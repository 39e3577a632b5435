//! [`counting`]: shaders that count what they evaluate while they run.

use crate::cost::{Cost, CostError, Shader};
use naga::{
    AddressSpace, Arena, AtomicFunction, BinaryOperator, Block, Expression, Function,
    GlobalVariable, Handle, Literal, Module, Range, ResourceBinding, Scalar, ShaderStage, Span,
    Statement, StorageAccess, SwitchCase, Type, TypeInner,
};

/// What the invocations of a [`counting`] shader have evaluated: the words of its buffer, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Invocations of entry points of the fragment and the compute stage.
    pub invocations: u32,
    /// Exponentials, logarithms and powers of numbers (three for a vector of three).
    pub exp: u32,
    /// Texture reads.
    pub reads: u32,
    /// Calls of the named function.
    pub calls: u32,
}

impl Counts {
    /// Size of the buffer.
    pub const BYTES: u64 = 4 * COUNTS as u64;

    /// The counts that a buffer holds.
    pub fn from_bytes(bytes: [u8; Self::BYTES as usize]) -> Self {
        let (words, _) = bytes.as_chunks::<4>();
        let [invocations, exp, reads, calls] =
            std::array::from_fn(|k| u32::from_ne_bytes(words[k]));
        Self {
            invocations,
            exp,
            reads,
            calls,
        }
    }
}

/// Number of words of the buffer.
const COUNTS: usize = 4;

/// A WGSL shader that does what another one does and counts what it evaluates, in the steps that its loops take and the branches that it
/// goes through, also up to where it discards: each invocation of the fragment and the compute stage adds its [`Counts`] to a storage
/// buffer that is bound at a group and a binding. `called` names a function whose calls are counted. Counts wrap beyond 32 bits.
///
/// # Errors
/// [`CostError`] for an invalid shader.
pub fn counting(
    wgsl: &str,
    (group, binding): (u32, u32),
    called: &str,
) -> Result<String, CostError> {
    let shader = Shader::read(wgsl)?;
    let costs: Vec<Vec<Cost>> = shader.costs_of_expressions().collect();
    let mut module = shader.module;
    let called = module
        .functions
        .iter()
        .find(|(_, function)| function.name.as_deref() == Some(called))
        .map(|(handle, _)| handle);
    let counters = Counters::new(&mut module, ResourceBinding { group, binding });
    let entries = module.entry_points.iter_mut().map(|entry| {
        let is_counted = entry.stage != ShaderStage::Vertex;
        (&mut entry.function, is_counted)
    });
    let functions = module.functions.iter_mut().map(|(_, f)| (f, false));
    for ((function, is_counted_entry), costs) in functions.chain(entries).zip(&costs) {
        let mut counting = Counting {
            counters: &counters,
            expressions: &mut function.expressions,
            costs,
            called,
            is_counted_entry,
        };
        function.body = counting.block(&function.body);
    }
    Shader::of(module, wgsl)?.text()
}

/// What shaders count with.
struct Counters {
    /// Of an invocation: exponentials, reads and calls.
    own: [Handle<GlobalVariable>; COUNTS - 1],
    /// Of all of them: the buffer of [`Counts`].
    all: Handle<GlobalVariable>,
    number: Handle<Type>,
}

impl Counters {
    /// Adds the counters to a module.
    fn new(module: &mut Module, binding: ResourceBinding) -> Self {
        let mut add_type = |inner| {
            module
                .types
                .insert(Type { name: None, inner }, Span::UNDEFINED)
        };
        let number = add_type(TypeInner::Scalar(Scalar::U32));
        let base = add_type(TypeInner::Atomic(Scalar::U32));
        let size = naga::ArraySize::Constant(
            std::num::NonZeroU32::new(COUNTS as u32).expect("more counts than none"),
        );
        let array = add_type(TypeInner::Array {
            base,
            size,
            stride: 4,
        });
        let mut add = |name: String, space, binding, ty| {
            let variable = GlobalVariable {
                name: Some(name),
                space,
                binding,
                ty,
                init: None,
                memory_decorations: naga::MemoryDecorations::empty(),
            };
            module.global_variables.append(variable, Span::UNDEFINED)
        };
        let space = AddressSpace::Storage {
            access: StorageAccess::LOAD | StorageAccess::STORE,
        };
        Self {
            all: add("all_counts".to_owned(), space, Some(binding), array),
            own: std::array::from_fn(|k| {
                add(
                    format!("own_count_{k}"),
                    AddressSpace::Private,
                    None,
                    number,
                )
            }),
            number,
        }
    }
}

/// A function that is made to count.
struct Counting<'a> {
    counters: &'a Counters,
    expressions: &'a mut Arena<Expression>,
    /// Of each expression that it had.
    costs: &'a [Cost],
    called: Option<Handle<Function>>,
    /// Whether its end is that of an invocation that counts.
    is_counted_entry: bool,
}

impl Counting<'_> {
    /// Statements that count what they evaluate.
    fn block(&mut self, body: &Block) -> Block {
        let mut out = Block::new();
        for statement in body {
            let counted = match statement {
                Statement::Block(inner) => Statement::Block(self.block(inner)),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => Statement::If {
                    condition: *condition,
                    accept: self.block(accept),
                    reject: self.block(reject),
                },
                Statement::Switch { selector, cases } => {
                    let cases = cases.iter().map(|case| SwitchCase {
                        body: self.block(&case.body),
                        ..case.clone()
                    });
                    Statement::Switch {
                        selector: *selector,
                        cases: cases.collect(),
                    }
                }
                Statement::Loop {
                    body,
                    continuing,
                    break_if,
                } => Statement::Loop {
                    body: self.block(body),
                    continuing: self.block(continuing),
                    break_if: *break_if,
                },
                other => other.clone(),
            };
            let ends = match statement {
                Statement::Return { .. } => self.is_counted_entry,
                Statement::Kill => true,
                _ => false,
            };
            if ends {
                self.add_to_all(&mut out);
            }
            out.push(counted, Span::UNDEFINED);
            match statement {
                Statement::Emit(range) => {
                    let costs = range.clone().map(|e| self.costs[e.index()]);
                    let cost = costs.fold(Cost::default(), Cost::plus);
                    self.add_to_own(&mut out, 0, cost.exp);
                    self.add_to_own(&mut out, 1, cost.reads);
                }
                Statement::Call { function, .. } if Some(*function) == self.called => {
                    self.add_to_own(&mut out, 2, 1);
                }
                _ => {}
            }
        }
        out
    }

    fn append(&mut self, expression: Expression) -> Handle<Expression> {
        self.expressions.append(expression, Span::UNDEFINED)
    }

    /// Adds a number to a counter of the invocation.
    fn add_to_own(&mut self, out: &mut Block, counter: usize, more: u32) {
        if more == 0 {
            return;
        }
        let pointer = self.append(Expression::GlobalVariable(self.counters.own[counter]));
        let right = self.append(Expression::Literal(Literal::U32(more)));
        let left = self.append(Expression::Load { pointer });
        let value = self.append(Expression::Binary {
            op: BinaryOperator::Add,
            left,
            right,
        });
        for statement in [
            Statement::Emit(Range::new_from_bounds(left, value)),
            Statement::Store { pointer, value },
        ] {
            out.push(statement, Span::UNDEFINED);
        }
    }

    /// Adds the counters of the invocation to those of all.
    fn add_to_all(&mut self, out: &mut Block) {
        let base = self.append(Expression::GlobalVariable(self.counters.all));
        let one = self.append(Expression::Literal(Literal::U32(1)));
        let own = self.counters.own.map(Expression::GlobalVariable);
        let own = own.map(|counter| self.append(counter));
        for index in 0..COUNTS {
            let pointer = self.append(Expression::AccessIndex {
                base,
                index: index as u32,
            });
            let (value, last) = match index {
                0 => (one, pointer),
                _ => {
                    let pointer = own[index - 1];
                    let value = self.append(Expression::Load { pointer });
                    (value, value)
                }
            };
            let result = self.append(Expression::AtomicResult {
                ty: self.counters.number,
                comparison: false,
            });
            for statement in [
                Statement::Emit(Range::new_from_bounds(pointer, last)),
                Statement::Atomic {
                    pointer,
                    fun: AtomicFunction::Add,
                    value,
                    result: Some(result),
                },
            ] {
                out.push(statement, Span::UNDEFINED);
            }
        }
    }
}
