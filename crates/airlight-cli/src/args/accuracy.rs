//! Options of `airlight accuracy`.

use airlight_validation::Suite;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SuiteArg {
    /// Skies against a Monte Carlo, SASKTRAN2 and libRadtran, from tables.
    Tables,
    /// Skies by day and in twilight against Airlight's own Monte Carlo.
    MonteCarlo,
    /// Other models of the sky beside ours.
    Peers,
    /// The sky measured on 27 May 2013, beside what published models make of it.
    Measured,
}

impl From<SuiteArg> for Suite {
    fn from(arg: SuiteArg) -> Self {
        match arg {
            SuiteArg::Tables => Self::Tables,
            SuiteArg::MonteCarlo => Self::MonteCarlo,
            SuiteArg::Peers => Self::Peers,
            SuiteArg::Measured => Self::Measured,
        }
    }
}

/// How the report is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ReportArg {
    /// A text to read.
    Text,
    /// One JSON object, format airlight-accuracy/1.
    Json,
    /// A page with plots, complete in one file.
    Html,
}

/// Options of `airlight accuracy`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct AccuracyArgs {
    /// What to compare [default: everything]
    #[arg(value_enum, value_name = "SUITE")]
    pub suites: Vec<SuiteArg>,
    /// How the report is written [default: by the ending of --output, else text]
    #[arg(long, value_enum)]
    pub format: Option<ReportArg>,
    /// Put every compared value into the JSON
    #[arg(long)]
    pub rows: bool,
    /// File to write instead of standard output: .html, .json, .txt
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Errors are ours minus the reference. Ends with exit code 1 where a claim of the documentation does not hold.

Examples:
  airlight accuracy
  airlight accuracy measured -o measured.html
  airlight accuracy tables --format json --rows -o errors.json";
