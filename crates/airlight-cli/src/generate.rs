//! `airlight completions` and `airlight man`: files generated from the options.

use crate::args::{CompletionsArgs, ManArgs};
use crate::error::CliError;
use crate::report;
use crate::short_help;

/// Prints the completions of a shell.
///
/// # Errors
/// [`CliError`] if standard output cannot be written.
pub fn completions(args: &CompletionsArgs) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(
        args.shell,
        &mut short_help::command(),
        "airlight",
        &mut script,
    );
    report::print(&String::from_utf8_lossy(&script))
}

/// Writes the manual pages of all commands.
///
/// # Errors
/// [`CliError`] if the folder cannot be made or a page cannot be written.
pub fn man(args: &ManArgs) -> Result<(), CliError> {
    let failed = |error: std::io::Error| {
        CliError::failure(format!("cannot write `{}`: {error}", args.folder.display()))
    };
    std::fs::create_dir_all(&args.folder).map_err(failed)?;
    clap_mangen::generate_to(short_help::command(), &args.folder).map_err(failed)
}
