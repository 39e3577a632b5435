//! Reports of checks as text, JSON and HTML with plots.

mod html;
mod json;
mod plot;
mod text;

pub use html::html;
pub use json::json;
pub use text::text;

use crate::check::Check;

/// The checks of each suite, in order.
fn by_suite(checks: &[Check]) -> impl Iterator<Item = &[Check]> {
    checks.chunk_by(|a, b| a.suite == b.suite)
}

/// Formats a number with a number of decimals suitable for errors.
fn short(value: f64) -> String {
    let decimals = if value.abs() < 0.095 { 3 } else { 2 };
    format!("{value:.decimals$}")
}

/// The claim of a check, in words.
fn claim(check: &Check) -> String {
    match (check.limit, check.limit_of_rms) {
        (Some(limit), _) => format!("each within {limit} {}", check.unit),
        (None, Some(limit)) => format!("rms within {limit} {}", check.unit),
        (None, None) => String::new(),
    }
}

#[cfg(test)]
mod tests;
