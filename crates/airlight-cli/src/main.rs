//! Command line of Airlight.
//!
//! A thin layer over `airlight-render`: options fill in a [`Scene`], the library draws it, and the program shows progress and
//! reports.
//!
//! Modules, each importing only from those above it:
//! - [`error`]: errors and exit codes; [`option_names`]: options in messages; [`parse`]: parsing of argument values.
//! - [`interrupt`], [`progress`], [`report`]: Ctrl-C, progress bars on standard error, text on standard output.
//! - [`topics`]: recipes. [`args`]: options of all commands, and the scenes that they describe; [`short_help`]: what `-h`
//!   lists of them; [`example_values`]: values that work, in errors.
//! - [`scene`]: saving scenes, threads; [`atmosphere`], [`aerosol`]: lists of names.
//! - [`sky`], [`fog`], [`probe`], [`compare`], [`grid`], [`join`], [`accuracy`], [`view`], [`plot`] and
//!   [`shaders`]: the commands; [`generate`]:
//!   files for shells.

mod accuracy;
mod aerosol;
mod args;
mod atmosphere;
mod compare;
mod error;
mod example_values;
mod fog;
mod generate;
mod grid;
mod interrupt;
mod join;
mod option_names;
mod parse;
mod plot;
mod probe;
mod progress;
mod report;
mod scene;
mod shaders;
mod short_help;
mod sky;
mod topics;
mod view;

use airlight::scene::Scene;
use args::{Cli, Command};
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, FromArgMatches};
use error::CliError;
use std::{ffi::OsString, io::Write, process::ExitCode};

fn main() -> ExitCode {
    let mut command = short_help::command();
    let matches = parse_words(&mut command, std::env::args_os().collect());
    option_names::install(&command, &matches);
    let cli = Cli::from_arg_matches(&matches);
    let cli = cli.unwrap_or_else(|error| error.exit());
    match run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if let Some(sentence) = error.sentence() {
                // Errors of standard error cannot be reported.
                let sentence = option_names::in_error(sentence);
                let _ = writeln!(std::io::stderr(), "airlight: {sentence}");
            }
            ExitCode::from(error.exit_code())
        }
    }
}

/// Parses the words of the command line, or exits. An error of a missing argument or value shows an example. The command `help` of clap does not
/// suggest the command that an unknown one resembles; the unknown command by itself does.
fn parse_words(command: &mut clap::Command, mut words: Vec<OsString>) -> ArgMatches {
    let mut error = match command.try_get_matches_from_mut(&words) {
        Ok(matches) => return matches,
        Err(error) => error,
    };
    let named = short_help::named_command(command, &words);
    example_values::explain(&mut error, named);
    example_values::explain_pattern(&mut error, named);
    if error.kind() == ErrorKind::MissingRequiredArgument
        && let Some(example) = short_help::example(named)
    {
        let tip = vec![StyledStr::from(format!("for example: {example}"))];
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(tip));
    }
    let help = words.iter().position(|word| word == "help");
    if error.kind() == ErrorKind::InvalidSubcommand
        && error.get(ContextKind::SuggestedSubcommand).is_none()
        && let Some(help) = help
    {
        words.remove(help);
        if let Err(suggesting) = command.try_get_matches_from_mut(&words)
            && suggesting.kind() == ErrorKind::InvalidSubcommand
        {
            suggesting.exit();
        }
    }
    error.exit()
}

fn run(cli: &Cli) -> Result<(), CliError> {
    interrupt::install()?;
    scene::use_threads(cli.threads)?;
    match &cli.command {
        Command::Sky(args) => sky::run(args),
        Command::Fog(args) => fog::run(args),
        Command::Probe(args) => probe::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Grid(args) => grid::run(args),
        Command::Join(args) => join::run(args),
        Command::Accuracy(args) => accuracy::run(args),
        Command::View(args) => view::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Shaders(args) => shaders::run(args),
        Command::Atmospheres(args) => atmosphere::list(args),
        Command::Topics => topics::run(),
        Command::Completions(args) => generate::completions(args),
        Command::Man(args) => generate::man(args),
        Command::Schema => report::print(&(Scene::json_schema() + "\n")),
    }
}
