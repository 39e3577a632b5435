//! `airlight shaders`: the shader functions in a shading language, or as SPIR-V.

use crate::args::ShadersArgs;
use crate::error::CliError;
use crate::report;
use airlight::Named;
use airlight_shaders::{Part, Subject, translated_files};

/// Writes the file of functions, or the modules.
///
/// # Errors
/// [`CliError`] if the folder cannot be made or a file cannot be written.
pub fn run(args: &ShadersArgs) -> Result<(), CliError> {
    let parts = match args.only.is_empty() {
        true => Part::ALL.to_vec(),
        false => args.only.iter().flat_map(Subject::parts).copied().collect(),
    };
    let files =
        translated_files(&parts, args.lang).map_err(|e| CliError::failure(e.to_string()))?;
    let folder = args.output.display();
    if args.output.is_file() {
        let sentence =
            format!("expected a folder, got the file `{folder}`; try `{folder}-shaders`");
        return Err(CliError::failure(sentence));
    }
    std::fs::create_dir_all(&args.output)
        .map_err(|error| CliError::failure(format!("cannot write `{folder}`: {error}")))?;
    let files = files.into_iter();
    report::write_together(files.map(|file| (args.output.join(file.name), file.contents)))
}
