//! The airlight program: skies from the command line.
//!
//! A thin program over `airlight-render`: options fill in a [`Scene`], the library draws it, the
//! program shows progress and reports.
//!
//! Modules, each importing only from those above it:
//! - [`error`]: why a command ends, and its exit code; [`parse`]: values on the command line.
//! - [`interrupt`], [`progress`], [`report`]: Ctrl-C, bars on standard error, text on standard output.
//! - [`args`]: every option of every command, and the scenes that they fill in.
//! - [`scene`]: saving scenes, threads; [`atmosphere`], [`aerosol`]: lists of what has a name.
//! - [`sky`], [`fog`], [`probe`], [`compare`], [`grid`], [`accuracy`] and [`plot`]: the commands.

mod accuracy;
mod aerosol;
mod args;
mod atmosphere;
mod compare;
mod error;
mod fog;
mod grid;
mod interrupt;
mod parse;
mod plot;
mod probe;
mod progress;
mod report;
mod scene;
mod sky;

use airlight::scene::Scene;
use args::{Cli, Command};
use clap::Parser;
use error::CliError;
use std::{io::Write, process::ExitCode};

fn main() -> ExitCode {
    let cli = Cli::parse();
    match run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if let Some(sentence) = error.sentence() {
                // Where standard error is gone there is nobody left to tell.
                let _ = writeln!(std::io::stderr(), "airlight: {sentence}");
            }
            ExitCode::from(error.exit_code())
        }
    }
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
        Command::Accuracy(args) => accuracy::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Atmospheres(args) => atmosphere::list(args),
        Command::Schema => report::print(&(Scene::json_schema() + "\n")),
    }
}
