//! JSON report.

use crate::check::{Check, Row, Statistics};
use crate::measured::{self, Published};
use serde::Serialize;

#[derive(Serialize)]
struct Report<'a> {
    format: &'static str,
    version: &'static str,
    holds: bool,
    checks: Vec<Entry<'a>>,
    /// Published models compared with the measured sky.
    published: Vec<Published>,
}

#[derive(Serialize)]
struct Entry<'a> {
    #[serde(flatten)]
    check: &'a Check,
    holds: bool,
    statistics: Option<Statistics>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rows: Option<&'a [Row]>,
}

/// The checks as one JSON object, format `airlight-accuracy/1`; includes all rows if `with_rows`.
///
/// # Errors
/// Errors of the JSON writer; numbers that are not finite become `null`.
pub fn json(checks: &[Check], with_rows: bool) -> Result<String, serde_json::Error> {
    let entry = |check| Entry {
        check,
        holds: Check::holds(check),
        statistics: check.statistics(),
        rows: with_rows.then_some(check.rows.as_slice()),
    };
    let mut text = serde_json::to_string_pretty(&Report {
        format: "airlight-accuracy/1",
        version: env!("CARGO_PKG_VERSION"),
        holds: checks.iter().all(Check::holds),
        checks: checks.iter().map(entry).collect(),
        published: measured::published(),
    })?;
    text.push('\n');
    Ok(text)
}
