//! Options of `airlight shaders`.

use crate::parse;
use airlight_shaders::{Language, Part};
use clap::Args;
use std::path::PathBuf;

/// Options of `airlight shaders`.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct ShadersArgs {
    /// Shading language
    #[arg(long, value_name = "LANGUAGE", value_parser = parse::named::<Language>(), default_value_t = Language::Wgsl)]
    pub lang: Language,

    /// Parts to write, with those that they require [default: all]
    #[arg(long, value_name = "PARTS", value_delimiter = ',', value_parser = parse::named::<Part>())]
    pub only: Vec<Part>,

    /// Folder for the file, which is named `airlight` with the ending of the language; it is made if it does not exist
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
}

const NOTES: &str = "\
The functions take all inputs as parameters; include the file in a shader, after its #version line in GLSL. Each function states what
it computes and how many exponentials it evaluates.

Examples:
  airlight shaders -o shaders
  airlight shaders --lang glsl-es300 --only fog,phase -o web/shaders";
