//! What a shader exchanges with a program, as text.

use crate::compute::type_name;
use naga::proc::Layouter;
use naga::{
    AddressSpace, Binding, EntryPoint, GlobalVariable, Handle, ImageClass, ImageDimension, Module,
    ShaderStage, StorageAccess, Type, TypeInner,
};
use std::fmt::Write;

/// Entry points, descriptors and layouts of buffers of a module, behind a description. `calls` says what compute entry points evaluate.
pub fn interface(module: &Module, head: &str, calls: &[Call]) -> String {
    let mut text =
        format!("{head}. No push constants, no specialization constants.\n\nEntry points\n");
    for (k, entry) in module.entry_points.iter().enumerate() {
        let what = match entry.stage {
            ShaderStage::Compute => calls[k].in_words(),
            _ => varyings(module, entry),
        };
        line(
            &mut text,
            1,
            format!("{} ({}) {what}", entry.name, stage(entry)),
        );
    }
    text.push_str("\nDescriptors\n");
    for (_, variable) in module.global_variables.iter() {
        descriptor(&mut text, module, variable);
    }
    let structs = structs_in(module, calls);
    if !structs.is_empty() {
        text.push_str("\nStructs\n");
    }
    for (name, members) in structs {
        line(&mut text, 1, format!("{name} {{ {} }}", members.join(", ")));
    }
    text
}

/// What a compute entry point evaluates.
pub struct Call {
    /// Numbers of a row of arguments.
    pub arguments: usize,
    /// Numbers of a row of results.
    pub results: usize,
    /// Signature of the function.
    pub signature: String,
}

impl Call {
    fn in_words(&self) -> String {
        let signature = self.signature.replace("( ", "(").replace(", )", ")");
        format!("{} -> {}: {signature}", self.arguments, self.results)
    }
}

/// Structs of which the rows of calls consist, with their members.
fn structs_in<'a>(module: &'a Module, calls: &[Call]) -> Vec<(&'a str, Vec<String>)> {
    let mut found: Vec<(&str, Vec<String>)> = Vec::new();
    // A struct follows those that it contains.
    for (_, ty) in module.types.iter() {
        if let (TypeInner::Struct { members, .. }, Some(name)) = (&ty.inner, &ty.name) {
            let members = members.iter().map(|member| {
                let name = member.name.as_deref().unwrap_or_default();
                format!("{name}: {}", type_name(module, member.ty))
            });
            found.push((name, members.collect()));
        }
    }
    let holds = |text: &str, name: &str| {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        text.split(|c| !is_part(c)).any(|word| word == name)
    };
    let mut used = vec![false; found.len()];
    for k in (0..found.len()).rev() {
        let (name, _) = found[k];
        let outer = (k + 1..found.len()).filter(|&outer| used[outer]);
        let mut members = outer.flat_map(|outer| &found[outer].1);
        used[k] = calls.iter().any(|call| holds(&call.signature, name))
            || members.any(|member| holds(member, name));
    }
    let all = found.into_iter().zip(used);
    all.filter_map(|(entry, used)| used.then_some(entry))
        .collect()
}

fn line(text: &mut String, depth: usize, words: impl AsRef<str>) {
    writeln!(text, "{:1$}{2}", "", 4 * depth, words.as_ref()).expect("a text");
}

fn stage(entry: &EntryPoint) -> String {
    match entry.stage {
        ShaderStage::Vertex => "vertex".to_owned(),
        ShaderStage::Fragment => "fragment".to_owned(),
        _ => {
            let [x, y, z] = entry.workgroup_size;
            format!("compute, {x} x {y} x {z}")
        }
    }
}

/// Inputs and outputs of a stage that draws.
fn varyings(module: &Module, entry: &EntryPoint) -> String {
    let function = &entry.function;
    let mut taken = Vec::new();
    for argument in &function.arguments {
        let name = argument.name.as_deref().unwrap_or("value");
        bound(
            module,
            name,
            argument.ty,
            argument.binding.as_ref(),
            &mut taken,
        );
    }
    let mut given = Vec::new();
    if let Some(result) = &function.result {
        bound(
            module,
            "value",
            result.ty,
            result.binding.as_ref(),
            &mut given,
        );
    }
    format!("takes {}; gives {}", taken.join(", "), given.join(", "))
}

fn bound(
    module: &Module,
    name: &str,
    ty: Handle<Type>,
    binding: Option<&Binding>,
    list: &mut Vec<String>,
) {
    match (binding, &module.types[ty].inner) {
        (Some(Binding::Location { location, .. }), _) => {
            list.push(format!(
                "location {location}: {name}: {}",
                type_name(module, ty)
            ));
        }
        (Some(Binding::BuiltIn(built_in)), _) => {
            let all = format!("{built_in:?}");
            // Without what the variant holds.
            let name = all.split(' ').next().unwrap_or_default();
            list.push(format!("built-in {name}"));
        }
        (None, TypeInner::Struct { members, .. }) => {
            for member in members {
                let name = member.name.as_deref().unwrap_or("value");
                bound(module, name, member.ty, member.binding.as_ref(), list);
            }
        }
        (None, _) => {}
    }
}

fn descriptor(text: &mut String, module: &Module, variable: &GlobalVariable) {
    let (Some(binding), Some(name)) = (variable.binding, &variable.name) else {
        return;
    };
    let place = format!("set {}, binding {}", binding.group, binding.binding);
    let inner = &module.types[variable.ty].inner;
    let kind = match (variable.space, inner) {
        (AddressSpace::Uniform, _) => "uniform buffer".to_owned(),
        (AddressSpace::Storage { access }, _) => {
            let access = match access.contains(StorageAccess::STORE) {
                true => "read and written",
                false => "read",
            };
            format!("storage buffer, {access}")
        }
        (_, TypeInner::Sampler { .. }) => "sampler".to_owned(),
        (_, TypeInner::Image { dim, class, .. }) => {
            let dimension = match dim {
                ImageDimension::D3 => 3,
                _ => 2,
            };
            let class = match class {
                ImageClass::Depth { .. } => "depth",
                _ => "f32",
            };
            format!("sampled image, {dimension}D, {class}")
        }
        _ => "other".to_owned(),
    };
    let ty = match inner {
        TypeInner::Sampler { .. } | TypeInner::Image { .. } => String::new(),
        _ => format!(": {}", type_name(module, variable.ty)),
    };
    line(text, 1, format!("{place}: {kind}: {name}{ty}"));
    if variable.space == AddressSpace::Uniform {
        let mut layouter = Layouter::default();
        layouter.update(module.to_ctx()).expect("a valid module");
        let size = layouter[variable.ty].size;
        line(text, 2, format!("offset, bytes ({size} in all)"));
        members(text, module, variable.ty, "", 0);
    }
}

/// Offsets of the members of a struct, those of structs inside it one by one.
fn members(text: &mut String, module: &Module, ty: Handle<Type>, before: &str, base: u32) {
    let TypeInner::Struct { members: all, .. } = &module.types[ty].inner else {
        return;
    };
    for member in all {
        let name = format!("{before}{}", member.name.as_deref().unwrap_or_default());
        let offset = base + member.offset;
        match module.types[member.ty].inner {
            TypeInner::Struct { .. } => {
                members(text, module, member.ty, &format!("{name}."), offset);
            }
            _ => line(
                text,
                2,
                format!("{offset:6}  {name}: {}", type_name(module, member.ty)),
            ),
        }
    }
}
