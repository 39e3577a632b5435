//! `airlight shaders`: the shader functions in a shading language.

use crate::args::ShadersArgs;
use crate::error::CliError;
use crate::report;
use airlight::Named;
use airlight_shaders::{Part, translate};

/// Writes the file of functions.
///
/// # Errors
/// [`CliError`] if the folder cannot be made or the file cannot be written.
pub fn run(args: &ShadersArgs) -> Result<(), CliError> {
    let parts = match args.only.is_empty() {
        true => Part::ALL,
        false => &args.only,
    };
    let text = translate(parts, args.lang).map_err(|e| CliError::failure(e.to_string()))?;
    std::fs::create_dir_all(&args.output).map_err(|error| {
        CliError::failure(format!("cannot write `{}`: {error}", args.output.display()))
    })?;
    let name = format!("airlight.{}", args.lang.extension());
    report::write(&args.output.join(name), text)
}
