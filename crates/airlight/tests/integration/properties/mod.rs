//! Properties of random valid inputs: transmittances from 0 to 1, finite light that is never negative, optics of a path from
//! those of its parts, and transmittances that are the same in both directions.
//!
//! Every input follows from the seed of its case. A failure prints the seed, the property and the input;
//! `AIRLIGHT_SEED=SEED cargo test -p airlight properties::MODEL` runs that case alone.

pub mod draw;
mod fog;
mod lights;
mod sky;
mod thick;

use draw::Draw;

/// Seeds of the ordinary tests, which look at 2e4 inputs, and of the long ones, which look at 1e6 others.
const ORDINARY: std::ops::Range<u64> = 0..100;
const LONG: std::ops::Range<u64> = 1_000..11_000;

/// A property that an input does not have.
type Failure = String;

/// Checks the cases of a range of seeds, or that of `AIRLIGHT_SEED`.
fn check(seeds: std::ops::Range<u64>, case: impl Fn(&mut Draw) -> Result<(), Failure> + Sync) {
    use rayon::prelude::*;
    let seeds = match std::env::var("AIRLIGHT_SEED") {
        Ok(seed) => {
            let seed = seed.parse().expect("AIRLIGHT_SEED is a number");
            seed..seed + 1
        }
        Err(_) => seeds,
    };
    let failures: Vec<(u64, Failure)> = seeds
        .into_par_iter()
        .filter_map(|seed| Some((seed, case(&mut Draw::new(seed)).err()?)))
        .collect();
    let first: Vec<String> = failures
        .iter()
        .take(8)
        .map(|(seed, failure)| format!("AIRLIGHT_SEED={seed}: {failure}"))
        .collect();
    assert!(
        failures.is_empty(),
        "{} cases fail, such as\n{}",
        failures.len(),
        first.join("\n")
    );
}

/// That every value is finite and not negative.
fn light(what: &str, values: &[f32]) -> Result<(), Failure> {
    match values.iter().all(|v| v.is_finite() && *v >= 0.0) {
        true => Ok(()),
        false => Err(format!("{what} {values:?}")),
    }
}

/// That every value is from 0 to 1.
fn transmittance(values: &[f32]) -> Result<(), Failure> {
    match values.iter().all(|v| (0.0..=1.0).contains(v)) {
        true => Ok(()),
        false => Err(format!("transmittance {values:?}")),
    }
}

/// That two lists are equal to a relative error, or to a difference of `floor`.
fn equal(what: &str, got: &[f32], want: &[f32], relative: f32, floor: f32) -> Result<(), Failure> {
    let close = |(a, b): (&f32, &f32)| (a - b).abs() <= relative * a.abs().max(b.abs()) + floor;
    match got.iter().zip(want).all(close) {
        true => Ok(()),
        false => Err(format!("{what}: {got:?} against {want:?}")),
    }
}

/// For each model, a test of the ordinary seeds and one of the long ones.
macro_rules! models {
    ($($model:ident: $case:expr;)*) => {$(
        mod $model {
            use super::*;

            #[test]
            fn has_the_properties() {
                check(ORDINARY, $case);
            }

            #[test]
            #[ignore = "one of the tests that together look at a million inputs, for minutes"]
            fn has_the_properties_for_many_inputs() {
                check(LONG, $case);
            }
        }
    )*};
}

models! {
    single_scattering: fog::single_scattering;
    multiple_scattering: fog::multiple_scattering;
    old_models: fog::old_models;
    patches: fog::patches;
    lights_in_fog: lights::lights;
    skies: sky::view;
}

mod thick_skies {
    use super::*;

    #[test]
    fn random_thick_airs_converge() {
        // Those of this range that take seconds.
        for seed in [1, 8, 10] {
            check(seed..seed + 1, thick::sky);
        }
    }

    #[test]
    #[ignore = "thick skies of random airs, for minutes"]
    fn most_random_thick_airs_converge() {
        let failed: Vec<(u64, Failure)> = (0..40)
            .filter_map(|seed| Some((seed, thick::sky(&mut Draw::new(seed)).err()?)))
            .collect();
        assert!(failed.len() <= 1, "{failed:#?}");
    }
}
