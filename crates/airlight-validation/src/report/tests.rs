use super::*;
use crate::check::{At, Check, Row, Suite, Unit};

fn checks() -> Vec<Check> {
    let row = |view_zenith_deg, ours| Row {
        at: At {
            sun_zenith_deg: 60.0,
            view_zenith_deg,
            wavelength_nm: Some(550.0),
            ..Default::default()
        },
        ours,
        reference: 1.0,
        standard_error: 0.0,
    };
    vec![Check {
        suite: Suite::Tables,
        what: "all orders, <air>".into(),
        against: "truth".into(),
        unit: Unit::Percent,
        limit: Some(1.0),
        limit_of_rms: None,
        rows: vec![row(10.0, 1.005), row(80.0, 1.03)],
    }]
}

#[test]
fn comparisons_without_claims_do_not_read_as_failures() {
    let mut checks = checks();
    checks[0].limit = None;
    let text = text(&checks);
    assert!(text.ends_with("nothing is claimed about them.\n"), "{text}");
    assert!(!text.contains("0 claims"), "{text}");
}

#[test]
fn broken_claims_appear_in_all_formats() {
    let checks = checks();
    let text = text(&checks);
    assert!(
        text.contains("worst 3.00") && text.contains("view zenith 80.0"),
        "{text}"
    );
    assert!(text.contains("1 of 1 claims do not hold"));
    let json: serde_json::Value = serde_json::from_str(&json(&checks, true).unwrap()).unwrap();
    assert_eq!(json["holds"], false);
    assert_eq!(json["checks"][0]["statistics"]["count"], 2);
    assert_eq!(json["checks"][0]["rows"][1]["view_zenith_deg"], 80.0);
    let page = html(&checks).unwrap();
    assert!(page.contains("class=\"no\"") && page.contains("&lt;air&gt;") && page.contains("<svg"));
}
