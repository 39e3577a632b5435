//! Translation of parts to other shading languages.

use crate::function::functions;
use crate::language::{Language, TranslateError};
use crate::part::{Part, source, with_required};
use crate::spirv::spirv_modules;
use naga::back::{glsl, hlsl, msl};
use naga::{
    AddressSpace, Expression, GlobalVariable, MathFunction, Module, ResourceBinding, Span,
    Statement, TypeInner,
};

/// Name of the entry point that keeps all functions; what it is translated to is cut off.
const ENTRY: &str = "keeps_all_functions";

/// Start of the names of its textures and samplers, whose declarations are cut out.
const GLOBAL: &str = "argument_of_entry_";

/// What a line contains that declares them: in MSL and HLSL, in GLSL, in HLSL.
const GLOBALS: [&str; 5] = [
    GLOBAL,
    "_group_0_binding_",
    "nagaSamplerHeap",
    "nagaComparisonSamplerHeap",
    "nagaGroup0SamplerIndexArray",
];

/// Parts, with all parts that they require, in a language: text to include in a shader, after a `#version` line in GLSL (not
/// Godot). Functions and structs keep their names, parameters may get a number; each function is preceded by its documentation.
///
/// # Errors
/// [`TranslateError`] if the language lacks something that a function uses, and for SPIR-V, of which [`spirv_modules`] makes modules.
pub fn translate(parts: &[Part], language: Language) -> Result<String, TranslateError> {
    let failed = |message: String| TranslateError { language, message };
    let module = with_entry_point(parts).map_err(failed)?;
    let text = match language {
        Language::Wgsl => return Ok(source(parts)),
        Language::Spirv => {
            return Err(failed(
                "functions without entry points; try `spirv_modules`".to_owned(),
            ));
        }
        Language::GlslEs300 => to_glsl(&module, 300),
        Language::Glsl450 => to_glsl(&module, 450),
        Language::Godot => to_glsl(&module, 300).map(|text| without_precision(&text)),
        Language::Hlsl => to_hlsl(&module),
        Language::Msl => to_msl(&module),
    }
    .map_err(failed)?;
    Ok(documented(&without_entry_point(&text), parts))
}

/// A file of shaders.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TranslatedFile {
    /// Its name.
    pub name: String,
    /// Its bytes: a text, or SPIR-V.
    pub contents: Vec<u8>,
}

/// The files of parts in a language, as `airlight shaders` writes them: one of functions, or in SPIR-V a module and a text of its interface
/// for each part and its passes.
///
/// # Errors
/// [`TranslateError`] if the language lacks something that a function uses.
pub fn translated_files(
    parts: &[Part],
    language: Language,
) -> Result<Vec<TranslatedFile>, TranslateError> {
    let ending = language.extension();
    if language.has_functions() {
        return Ok(vec![TranslatedFile {
            name: format!("airlight.{ending}"),
            contents: translate(parts, language)?.into_bytes(),
        }]);
    }
    let mut files = Vec::new();
    for module in spirv_modules(parts)? {
        let file = |ending: &str, contents| TranslatedFile {
            name: format!("airlight-{}.{ending}", module.name),
            contents,
        };
        files.push(file(ending, module.bytes()));
        files.push(file("txt", module.interface.clone().into_bytes()));
    }
    Ok(files)
}

/// The parts with a fragment shader that calls every function.
fn with_entry_point(parts: &[Part]) -> Result<Module, String> {
    let text = source(parts) + &format!("\n@fragment fn {ENTRY}() {{}}\n");
    let mut module = naga::front::wgsl::parse_str(&text).map_err(|e| e.emit_to_string(&text))?;
    let Module {
        functions,
        entry_points,
        global_variables,
        types,
        ..
    } = &mut module;
    let entry = &mut entry_points[0].function;
    entry.body = naga::Block::new();
    // Textures and samplers exist only as globals: one of each type.
    let mut globals = Vec::new();
    for (handle, function) in functions.iter() {
        let mut arguments = Vec::new();
        for argument in &function.arguments {
            let of_type = argument.ty;
            let expression = match types[of_type].inner {
                TypeInner::Image { .. } | TypeInner::Sampler { .. } => {
                    let known = globals.iter().position(|&(known, _)| known == of_type);
                    let index = known.unwrap_or_else(|| {
                        let binding = globals.len() as u32;
                        let variable = GlobalVariable {
                            name: Some(format!("{GLOBAL}{binding}")),
                            space: AddressSpace::Handle,
                            binding: Some(ResourceBinding { group: 0, binding }),
                            ty: of_type,
                            init: None,
                            memory_decorations: naga::MemoryDecorations::empty(),
                        };
                        let global = global_variables.append(variable, Span::UNDEFINED);
                        globals.push((of_type, global));
                        globals.len() - 1
                    });
                    Expression::GlobalVariable(globals[index].1)
                }
                _ => Expression::ZeroValue(of_type),
            };
            arguments.push(entry.expressions.append(expression, Span::UNDEFINED));
        }
        let result = function.result.as_ref().map(|_| {
            entry
                .expressions
                .append(Expression::CallResult(handle), Span::UNDEFINED)
        });
        let call = Statement::Call {
            function: handle,
            arguments,
            result,
        };
        entry.body.push(call, Span::UNDEFINED);
    }
    entry
        .body
        .push(Statement::Return { value: None }, Span::UNDEFINED);
    Ok(module)
}

fn validated(module: &Module) -> Result<naga::valid::ModuleInfo, String> {
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(module)
        .map_err(|e| format!("{:?}", e.into_inner()))
}

fn to_glsl(module: &Module, version: u16) -> Result<String, String> {
    let info = validated(module)?;
    let options = glsl::Options {
        version: match version {
            300 => glsl::Version::Embedded {
                version,
                is_webgl: true,
            },
            version => glsl::Version::Desktop(version),
        },
        writer_flags: glsl::WriterFlags::empty(),
        binding_map: glsl::BindingMap::default(),
        zero_initialize_workgroup_memory: true,
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: naga::ShaderStage::Fragment,
        entry_point: ENTRY.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, &info, &options, &pipeline, policies)
        .and_then(|mut writer| writer.write())
        .map_err(|e| e.to_string())?;
    // The host's shader begins with a version of its own.
    let lines = text.lines().filter(|line| !line.starts_with("#version"));
    Ok(lines.map(|line| format!("{line}\n")).collect())
}

/// GLSL ES without the lines that set a precision, which Godot has not.
fn without_precision(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("precision "));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Selection by components: since HLSL 2021 a condition of `?:` is a scalar, and HLSL before that has no `select`.
const SELECT_EACH: &str = "\
float2 select_each(bool2 condition, float2 accept, float2 reject) {
    return float2(condition.x ? accept.x : reject.x, condition.y ? accept.y : reject.y);
}

float3 select_each(bool3 condition, float3 accept, float3 reject) {
    return float3(select_each(condition.xy, accept.xy, reject.xy), condition.z ? accept.z : reject.z);
}

float4 select_each(bool4 condition, float4 accept, float4 reject) {
    return float4(select_each(condition.xyz, accept.xyz, reject.xyz), condition.w ? accept.w : reject.w);
}

";

/// What HLSL calls the function that stands for selections by components while text is written: the library does not use it.
const MARK_OF_SELECTION: (MathFunction, &str) = (MathFunction::Fma, "mad(");

/// Replaces selections by components by calls of a function of three arguments.
fn mark_selections(module: &mut Module, info: &naga::valid::ModuleInfo) {
    let types = &module.types;
    for (handle, function) in module.functions.iter_mut() {
        let is_vector = |expression: naga::Handle<Expression>| {
            let ty = info[handle][expression].ty.inner_with(types);
            matches!(ty, TypeInner::Vector { .. })
        };
        for (_, expression) in function.expressions.iter_mut() {
            if let Expression::Select {
                condition,
                accept,
                reject,
            } = *expression
                && is_vector(condition)
            {
                *expression = Expression::Math {
                    fun: MARK_OF_SELECTION.0,
                    arg: condition,
                    arg1: Some(accept),
                    arg2: Some(reject),
                    arg3: None,
                };
            }
        }
    }
}

fn to_hlsl(module: &Module) -> Result<String, String> {
    let info = validated(module)?;
    let mut module = module.clone();
    mark_selections(&mut module, &info);
    let options = hlsl::Options {
        // The loops of the library end by themselves, and it has no index from outside.
        force_loop_bounding: false,
        restrict_indexing: false,
        ..hlsl::Options::default()
    };
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &hlsl::PipelineOptions::default())
        .write(&module, &info, None)
        .map_err(|e| e.to_string())?;
    match text.contains(MARK_OF_SELECTION.1) {
        true => Ok(SELECT_EACH.to_owned() + &text.replace(MARK_OF_SELECTION.1, "select_each(")),
        false => Ok(text),
    }
}

fn to_msl(module: &Module) -> Result<String, String> {
    let info = validated(module)?;
    let options = msl::Options {
        lang_version: (2, 0),
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    let (text, _) = msl::write_string(module, &info, &options, &msl::PipelineOptions::default())
        .map_err(|e| e.to_string())?;
    Ok(text)
}

/// The text up to the entry point, which is the last function and is called `main` in GLSL.
fn without_entry_point(text: &str) -> String {
    let is_entry = |line: &&str| line.starts_with("void main(") || line.contains(ENTRY);
    let is_global = |line: &str| GLOBALS.iter().any(|global| line.contains(global));
    let lines = text.lines().take_while(|line| !is_entry(line));
    let kept: Vec<&str> = lines.filter(|line| !is_global(line)).collect();
    kept.join("\n").trim().to_owned() + "\n"
}

/// The text with the documentation of each function before it, which the translator drops.
fn documented(text: &str, parts: &[Part]) -> String {
    let all: Vec<_> = with_required(parts)
        .into_iter()
        .flat_map(functions)
        .collect();
    let mut documented = String::from(
        "// Generated from the WGSL of airlight-shaders by its example `translate`: change that, not this.\n\n",
    );
    for line in text.lines() {
        let defined = all.iter().find(|function| {
            !line.starts_with([' ', '/', '#'])
                && !line.ends_with(';')
                && line.contains(&format!(" {}(", function.name))
        });
        if let Some(function) = defined {
            for paragraph in &function.documentation {
                documented.push_str(&format!("// {paragraph}\n"));
            }
            documented.push_str(&format!("// Cost: {}.\n", function.cost));
        }
        documented.push_str(line.trim_end());
        documented.push('\n');
    }
    documented
}
