//! Fits the aerosol of 27 May 2013 to each half of the scans and evaluates it on the other: prints the numbers of
//! `airlight_validation::measured::FOLDS`.

use airlight_validation::measured::{FOLDS, Scan, fit::fit, scans};

fn main() {
    let (wavelengths, scans) = scans();
    for fold in &FOLDS {
        let fitted: Vec<&Scan> = scans
            .iter()
            .filter(|scan| fold.fitted.contains(&scan.time))
            .collect();
        let (aerosol, rmse) = fit(fold.aerosol, &wavelengths, &fitted);
        println!(
            "fitted to {:?}, rms there {rmse:.2} mW/(m2 sr nm): {aerosol:?}",
            fold.fitted
        );
    }
}
