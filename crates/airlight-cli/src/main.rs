//! The airlight program: skies from the command line.
//!
//! Rooms, each importing only from those above it:
//! - [`error`]: why a command ends, and its exit code; [`parse`]: values on the command line; [`moment`]: times.
//! - [`args`]: every option of every command.
//! - [`interrupt`], [`progress`], [`report`]: Ctrl-C, bars on standard error, text on standard output.
//! - [`atmosphere`], [`scene`], [`models`], [`illuminance`]: what is asked for, from options to the solver or the published
//!   model; sums over the sky.
//! - [`sky`], [`fog`], [`probe`], [`compare`], [`grid`], [`accuracy`] and [`plot`]: the commands.

mod accuracy;
mod aerosol;
mod args;
mod atmosphere;
mod compare;
mod error;
mod fog;
mod grid;
mod illuminance;
mod interrupt;
mod models;
mod parse;
mod plot;
mod probe;
mod progress;
mod report;
mod scene;
mod sky;

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
    match &cli.command {
        Command::Sky(args) => sky::run(args),
        Command::Fog(args) => fog::run(args),
        Command::Probe(args) => probe::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Grid(args) => grid::run(args),
        Command::Accuracy(args) => accuracy::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Atmospheres(args) => atmosphere::list(args),
    }
}
