//! Options of `airlight accuracy`.

use crate::parse;
use airlight_validation::Suite;
use clap::Args;
use std::path::PathBuf;

/// Format of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportArg {
    /// Plain text.
    Text,
    /// JSON in the format airlight-accuracy/1.
    Json,
    /// Self-contained page with plots.
    Html,
}

airlight::named! { ReportArg, "a format of a report", [
    ("text", (Text), "plain text"),
    ("json", (Json), "the format airlight-accuracy/1"),
    ("html", (Html), "a self-contained page with plots"),
] }

/// Options of `airlight accuracy`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct AccuracyArgs {
    /// Comparisons to run [default: all that need no graphics device]
    #[arg(value_name = "SUITE", value_parser = parse::named::<Suite>())]
    pub suites: Vec<Suite>,
    /// Format of the report [default: by the extension of --output, otherwise text]
    #[arg(long, value_parser = parse::named::<ReportArg>())]
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
  airlight accuracy gpu -o frames.html
  airlight accuracy tables --format json --rows -o errors.json";
