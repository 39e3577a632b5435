//! Options of `airlight accuracy`.

use airlight_validation::Suite;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Set of comparisons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SuiteArg {
    /// Skies against tables of an independent Monte Carlo, SASKTRAN2 and libRadtran.
    Tables,
    /// Skies in daylight and twilight against Airlight's Monte Carlo solver.
    MonteCarlo,
    /// Published sky models against the default solver.
    Peers,
    /// The sky measured on 27 May 2013 against the solver and published models.
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

/// Format of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ReportArg {
    /// Plain text.
    Text,
    /// JSON in the format airlight-accuracy/1.
    Json,
    /// Self-contained page with plots.
    Html,
}

/// Options of `airlight accuracy`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct AccuracyArgs {
    /// Comparisons to run [default: all]
    #[arg(value_enum, value_name = "SUITE")]
    pub suites: Vec<SuiteArg>,
    /// Format of the report [default: by the extension of --output, otherwise text]
    #[arg(long, value_enum)]
    pub format: Option<ReportArg>,
    /// Include all compared values in the JSON
    #[arg(long)]
    pub rows: bool,
    /// File to write instead of standard output: .html, .json, .txt
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Errors are Airlight minus the reference. The exit code is 1 if a claim of the documentation does not hold.

Examples:
  airlight accuracy
  airlight accuracy measured -o measured.html
  airlight accuracy tables --format json --rows -o errors.json";
