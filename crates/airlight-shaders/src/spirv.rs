//! [`spirv_modules`]: SPIR-V for Vulkan.

use crate::compute::{ComputeShader, PREFIX};
use crate::function::functions;
use crate::interface::{Call, interface};
use crate::language::{Language, TranslateError};
use crate::part::Part;
use crate::pass::Pass;
use airlight::Named;
use naga::back::spv;
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// A module that `vkCreateShaderModule` takes, of SPIR-V 1.0.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SpirvModule {
    /// Name of the part or of the pass.
    pub name: &'static str,
    /// The module.
    pub words: Vec<u32>,
    /// Entry points, descriptors and layouts of buffers, as text.
    pub interface: String,
}

impl SpirvModule {
    /// The words in little-endian order, as files hold them.
    pub fn bytes(&self) -> Vec<u8> {
        let words = self.words.iter();
        words.flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// Modules of parts: once for each a [`ComputeShader`], and the passes whose subject it is. Functions alone have no form that Vulkan takes.
///
/// # Errors
/// [`TranslateError`] with what the translator reports.
pub fn spirv_modules(parts: &[Part]) -> Result<Vec<SpirvModule>, TranslateError> {
    let mut modules = Vec::new();
    for (index, &part) in parts.iter().enumerate() {
        if parts[..index].contains(&part) {
            continue;
        }
        modules.push(compute_module(part)?);
        let passes = Pass::ALL.iter().filter(|pass| pass.parts()[0] == part);
        for &pass in passes {
            modules.push(pass_module(pass)?);
        }
    }
    Ok(modules)
}

fn pass_module(pass: Pass) -> Result<SpirvModule, TranslateError> {
    let module = parsed(&pass.source())?;
    let head = format!("{}. {FRAME}\n\nVulkan 1.0", sentence(pass.summary()));
    Ok(SpirvModule {
        name: pass.name(),
        words: words(&module)?,
        interface: interface(&module, &head, &[]),
    })
}

fn compute_module(part: Part) -> Result<SpirvModule, TranslateError> {
    let shader = ComputeShader::new(part);
    let mut module = parsed(&shader.wgsl)?;
    for entry in &mut module.entry_points {
        if let Some(function) = entry.name.strip_prefix(PREFIX) {
            entry.name = function.to_owned();
        }
    }
    let head = format!(
        "{}: an entry point for each function.\n\n{ROWS}\n\n\
         Vulkan 1.1, or 1.0 with VK_KHR_storage_buffer_storage_class",
        sentence(part.summary())
    );
    let entries = shader.entry_points.iter().zip(functions(part));
    let calls: Vec<Call> = entries
        .map(|(entry, function)| Call {
            arguments: entry.arguments,
            results: entry.results,
            signature: function.signature,
        })
        .collect();
    Ok(SpirvModule {
        name: part.name(),
        words: words(&module)?,
        interface: interface(&module, &head, &calls),
    })
}

const FRAME: &str = "\
Draw three vertices without attributes: they make a triangle
that covers the frame. Clip coordinates are those of Vulkan: (-1, -1) is the upper left corner, depths are from 0 to 1.";

const ROWS: &str = "\
An invocation evaluates its function once: from a row of f32 in the buffer `arguments` it makes a row in the buffer `results`. Rows follow
each other without padding and hold values in the order of arguments, of the members of structs and of components; integers are
stored as numbers and booleans as 0 and 1. As many rows are computed as fit into the range of `results`, up to 64 a workgroup along x.
`3 -> 1` below: rows of 3 and of 1 numbers. A function needs only the descriptors that it uses: textures go by the names of its
arguments. Their sampler is linear and clamps to the edge.";

fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

fn failed(message: String) -> TranslateError {
    TranslateError {
        language: Language::Spirv,
        message,
    }
}

/// A shader without what its entry points do not use.
fn parsed(text: &str) -> Result<naga::Module, TranslateError> {
    let parsed = naga::front::wgsl::parse_str(text);
    let mut module = parsed.map_err(|e| failed(e.emit_to_string(text)))?;
    compact(&mut module, KeepUnused::No);
    Ok(module)
}

fn words(module: &naga::Module) -> Result<Vec<u32>, TranslateError> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(module)
        .map_err(|e| failed(format!("{:?}", e.into_inner())))?;
    let options = spv::Options {
        lang_version: (1, 0),
        // No names, which would be half of a module, and the clip coordinates of Vulkan.
        flags: spv::WriterFlags::empty(),
        // The loops of the library end by themselves.
        force_loop_bounding: false,
        ..spv::Options::default()
    };
    spv::write_vec(module, &info, &options, None).map_err(|e| failed(e.to_string()))
}
