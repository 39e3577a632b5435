//! Functions shared by commands that draw or probe a scene: threads, saving, the command line as text.

use crate::error::CliError;
use crate::report;
use airlight::scene::Scene;
use std::path::Path;

/// Sets the number of threads.
///
/// # Errors
/// [`CliError::Failure`] if the threads cannot be started.
pub fn use_threads(count: Option<u32>) -> Result<(), CliError> {
    let Some(count) = count else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count as usize)
        .build_global()
        .map_err(|error| CliError::failure(format!("cannot start {count} threads: {error}")))
}

/// Writes a scene as TOML.
///
/// # Errors
/// [`CliError`] if the scene is invalid or the file cannot be written.
pub fn save(scene: &Scene, path: &Path) -> Result<(), CliError> {
    scene.validate()?;
    report::write(path, scene.to_toml()?)
}

/// The command line, quoted for a shell.
pub fn command_line() -> String {
    let quoted = |word: std::ffi::OsString| {
        let word = word.to_string_lossy().into_owned();
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+.,:/@%".contains(c);
        match !word.is_empty() && word.chars().all(plain) {
            true => word,
            false => format!("'{}'", word.replace('\'', "'\\''")),
        }
    };
    std::iter::once("airlight".to_owned())
        .chain(std::env::args_os().skip(1).map(quoted))
        .collect::<Vec<_>>()
        .join(" ")
}
