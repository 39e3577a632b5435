//! Prints how far the sky solver is from the tables of other codes: `cargo run --release -p airlight-validation --example accuracy`.

use airlight_validation::{RunError, Suite, report, run};

fn main() -> Result<(), RunError> {
    let checks = run(&[Suite::Tables])?;
    print!("{}", report::text(&checks));
    for check in checks.iter().filter(|check| check.claims()) {
        let Some(found) = check.statistics() else {
            continue;
        };
        let verdict = if check.holds() {
            "holds"
        } else {
            "does not hold"
        };
        println!("{}: worst {:.3}, {verdict}", check.what, found.worst);
    }
    Ok(())
}
