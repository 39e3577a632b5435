//! Parts that the reports have in common.

use crate::check::Check;

/// The checks of each suite, in their order.
pub(super) fn by_suite(checks: &[Check]) -> impl Iterator<Item = &[Check]> {
    checks.chunk_by(|a, b| a.suite == b.suite)
}

/// A number with as many decimals as errors need.
pub(super) fn short(value: f64) -> String {
    let decimals = if value.abs() < 0.095 { 3 } else { 2 };
    format!("{value:.decimals$}")
}

/// What is claimed of a check, in words.
pub(super) fn claim(check: &Check) -> String {
    let part = |name: &str, limit: Option<f64>| {
        limit.map(|limit| format!("{name} within {limit} {}", check.unit))
    };
    let parts = [part("each", check.limit), part("rms", check.limit_of_rms)];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
