//! Plain-text report.

use super::words::{by_suite, claim, short};
use crate::check::{Check, Suite};
use crate::measured;
use std::fmt::Write;

/// The checks as text, with two lines for each.
pub fn text(checks: &[Check]) -> String {
    let mut out = String::new();
    for suite in by_suite(checks) {
        let name = suite[0].suite.title();
        let _ = writeln!(out, "{name}");
        for check in suite {
            line(&mut out, check);
        }
        if suite[0].suite == Suite::Measured {
            published(&mut out);
        }
        out.push('\n');
    }
    let broken: Vec<&Check> = checks.iter().filter(|check| !check.holds()).collect();
    let claimed = checks
        .iter()
        .filter(|check| !claim(check).is_empty())
        .count();
    let _ = match (broken.as_slice(), claimed) {
        ([], 0) => writeln!(
            out,
            "Differences between models; nothing is claimed about them."
        ),
        ([], _) => writeln!(out, "{claimed} claims hold."),
        _ => writeln!(out, "{} of {claimed} claims do not hold:", broken.len()),
    };
    for check in broken {
        let _ = writeln!(
            out,
            "  {} against {}: {}",
            check.what,
            check.against,
            claim(check)
        );
    }
    out
}

fn line(out: &mut String, check: &Check) {
    let Some(s) = check.statistics() else { return };
    let noise = match s.noise > 0.0 {
        true => format!(", of it noise {}", short(s.noise)),
        false => String::new(),
    };
    let _ = writeln!(
        out,
        "  {} | {}\n    {} values, {}: mean {}, rms {}{noise}, 95 % within {}, worst {} at {}{}",
        check.what,
        check.against,
        s.count,
        check.unit,
        short(s.mean),
        short(s.rms),
        short(s.percentile_95),
        short(s.worst),
        s.worst_at,
        match (claim(check).as_str(), check.holds()) {
            ("", _) => String::new(),
            (claim, true) => format!("\n    {claim}: holds"),
            (claim, false) => format!("\n    {claim}: DOES NOT HOLD"),
        }
    );
}

fn published(out: &mut String) {
    let _ = writeln!(
        out,
        "  for comparison, rms of published models on the same scans (on all 15):"
    );
    for model in measured::published() {
        let _ = writeln!(
            out,
            "    {:<40} {:6.2} ({:.2})",
            model.model, model.rmse, model.rmse_all_scans
        );
    }
}
