//! Options of `airlight shaders`.

use crate::parse;
use airlight_shaders::{Language, Subject};
use clap::Args;
use std::path::PathBuf;

/// Options of `airlight shaders`.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct ShadersArgs {
    /// Shading language
    #[arg(long, value_name = "LANGUAGE", value_parser = parse::named::<Language>(), default_value_t = Language::Wgsl)]
    pub lang: Language,

    /// Parts to write, or the subject `sky`, with those that they require [default: all]
    #[arg(long, value_name = "PARTS", value_delimiter = ',', value_parser = parse::named::<Subject>())]
    pub only: Vec<Subject>,

    /// Folder for the file, which is named `airlight` with the ending of the language, or for the files of SPIR-V; it is made if it does not exist
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
}

const NOTES: &str = "\
The functions take all inputs as parameters; include the file in a shader, after its #version line in GLSL. Each function states what
it computes and how many exponentials it evaluates.

Vulkan takes SPIR-V with entry points only: `spirv` writes for each part a module airlight-PART.spv, whose compute entry points evaluate
the functions for rows of a storage buffer, and complete passes: airlight-fog-pass.spv with `fog`, airlight-sky-pass.spv with
`sky-tables`, airlight-sky-article-pass.spv with `article`. A text beside each names entry points, descriptors and layouts.

Examples:
  airlight shaders -o shaders
  airlight shaders --lang glsl-es300 --only fog,sky -o web/shaders
  airlight shaders --lang spirv --only fog -o vulkan/shaders";
