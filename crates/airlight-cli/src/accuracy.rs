//! `airlight accuracy`: accuracy of the solvers against measurements and other codes.

use crate::args::{AccuracyArgs, ReportArg};
use crate::error::CliError;
use crate::progress::RowsBar;
use crate::report;
use airlight::Control;
use airlight_validation::report::{html, json, text};
use airlight_validation::{Check, RunError, Suite, run_with};

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options, failures, and accuracy claims that do not hold.
pub fn run(args: &AccuracyArgs) -> Result<(), CliError> {
    let format = format(args)?;
    if args.rows && format != ReportArg::Json {
        return Err(CliError::usage(
            "--rows: expected JSON, got another format; try --format json, or an --output that ends in .json",
        ));
    }
    if let Some(path) = &args.output {
        report::check_writable(path)?;
    }
    let suites: Vec<Suite> = match args.suites.as_slice() {
        [] => Suite::USUAL.to_vec(),
        some => some.to_vec(),
    };
    let bar = RowsBar::by_stages();
    let checks = run_with(&suites, Control::default().reporting_to(&bar));
    drop(bar);
    let checks = checks.map_err(|error| match error {
        RunError::WithoutGpu(_) => CliError::failure(format!(
            "{error}; try cargo install --locked --path crates/airlight-cli --features gpu"
        )),
        error => CliError::failure(error.to_string()),
    })?;
    let wrong = |error: &dyn std::fmt::Display| {
        CliError::failure(format!("cannot write the report: {error}"))
    };
    let text = match format {
        ReportArg::Text => text(&checks),
        ReportArg::Json => json(&checks, args.rows).map_err(|error| wrong(&error))?,
        ReportArg::Html => html(&checks).map_err(|error| wrong(&error))?,
    };
    match &args.output {
        Some(path) => report::write(path, &text)?,
        None => report::print(&text)?,
    }
    match checks.iter().filter(|check| !check.holds()).count() {
        0 => Ok(()),
        n => Err(CliError::failure(format!(
            "{n} of {} comparisons violate a claim of the documentation",
            checks.iter().filter(|check| Check::claims(check)).count()
        ))),
    }
}

fn format(args: &AccuracyArgs) -> Result<ReportArg, CliError> {
    let ending = args.output.as_ref().and_then(|path| path.extension());
    match (args.format, ending.and_then(|ending| ending.to_str())) {
        (Some(format), _) => Ok(format),
        (None, Some("html" | "htm")) => Ok(ReportArg::Html),
        (None, Some("json")) => Ok(ReportArg::Json),
        (None, Some("txt")) => Ok(ReportArg::Text),
        (None, _) if args.output.is_none() => Ok(ReportArg::Text),
        (None, _) => Err(CliError::usage(
            "--output: expected a name that ends in .html, .json or .txt, got another; try --format",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_follows_option_ending_and_default() {
        let chosen = |output: Option<&str>, given| {
            format(&AccuracyArgs {
                suites: Vec::new(),
                format: given,
                rows: false,
                output: output.map(Into::into),
            })
        };
        for (output, given, expected) in [
            (None, None, ReportArg::Text),
            (Some("a.json"), None, ReportArg::Json),
            (Some("a.html"), None, ReportArg::Html),
            (Some("a.txt"), None, ReportArg::Text),
            (Some("a.txt"), Some(ReportArg::Json), ReportArg::Json),
        ] {
            assert_eq!(chosen(output, given).ok(), Some(expected), "{output:?}");
        }
        assert!(chosen(Some("a.pdf"), None).is_err());
    }
}
