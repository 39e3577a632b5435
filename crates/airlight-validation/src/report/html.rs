//! HTML report with plots, in one self-contained file.

use super::plot;
use super::words::{by_suite, claim, short};
use crate::check::{Check, Suite};
use crate::measured;
use std::fmt::Write;

const STYLE: &str = "\
body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}\
h1,h2{font-weight:600}table{border-collapse:collapse;font-size:.85rem;width:100%}\
td,th{padding:.25rem .6rem;border-bottom:1px solid #ddd;text-align:right}td:first-child,th:first-child,td:last-child,th:last-child{text-align:left}\
.no{color:#b00020;font-weight:600}.yes{color:#1b7f3b}.scroll{overflow-x:auto}figure{margin:1.5rem 0}figcaption{font-size:.85rem;color:#555}\
svg{max-width:100%;height:auto}";

/// The checks as a self-contained HTML page.
///
/// # Errors
/// Errors of the plotting library.
pub fn html(checks: &[Check]) -> Result<String, Box<dyn std::error::Error>> {
    let mut out = String::new();
    let title = "Accuracy of Airlight";
    write!(
        out,
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>{STYLE}</style></head><body>\n\
         <h1>{title}</h1>\n<p>Version {}. An error is ours minus the reference, in percent of it, in mW/(m² sr nm) or as CIEDE2000; noise is \
         the root mean square of the reference's standard errors.</p>\n",
        env!("CARGO_PKG_VERSION")
    )?;
    for suite in by_suite(checks) {
        writeln!(out, "<h2>{}</h2>", escaped(suite[0].suite.title()))?;
        table(&mut out, suite)?;
        if suite[0].suite == Suite::Measured {
            figure(
                &mut out,
                plot::models(suite, &measured::published())?,
                "Root mean square error against the measured sky, same scans, same metric.",
            )?;
            figure(
                &mut out,
                plot::spectra(suite)?,
                "Spectra of the measured sky (points) and of the air of the day (lines).",
            )?;
        }
        if suite[0].suite == Suite::Measured {
            figure(
                &mut out,
                plot::errors(&suite[..2.min(suite.len())], true, |check| &check.what)?,
                "Errors against the measured sky by the angle from the sun.",
            )?;
            continue;
        }
        for checks in suite.chunk_by(|a, b| a.unit == b.unit) {
            figure(
                &mut out,
                plot::errors(checks, false, |check| &check.against)?,
                "Errors by the zenith angle of the view.",
            )?;
        }
    }
    out.push_str("</body></html>\n");
    Ok(out)
}

fn figure(out: &mut String, svg: String, caption: &str) -> std::fmt::Result {
    writeln!(
        out,
        "<figure>{svg}<figcaption>{}</figcaption></figure>",
        escaped(caption)
    )
}

fn table(out: &mut String, checks: &[Check]) -> std::fmt::Result {
    out.push_str(
        "<div class=\"scroll\"><table><tr><th>what</th><th>against</th><th>values</th><th>unit</th><th>mean</th><th>rms</th>\
         <th>noise</th><th>95 % within</th><th>worst</th><th>claim</th><th>worst at</th></tr>\n",
    );
    for check in checks {
        let Some(s) = check.statistics() else {
            continue;
        };
        let class = if check.holds() { "yes" } else { "no" };
        writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td class=\"{class}\">{}</td><td>{}</td></tr>",
            escaped(&check.what),
            escaped(&check.against),
            s.count,
            check.unit,
            short(s.mean),
            short(s.rms),
            short(s.noise),
            short(s.percentile_95),
            short(s.worst),
            claim(check),
            escaped(&s.worst_at.to_string()),
        )?;
    }
    out.push_str("</table></div>\n");
    Ok(())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
