use super::*;
use crate::math::quadrature::GaussRule;

fn kinds() -> Vec<DensityProfile> {
    let tent = DensityProfile::Tent {
        bottom_m: 10e3,
        peak_m: 25e3,
        top_m: 40e3,
    };
    let layer = DensityProfile::Layer {
        bottom_m: 2e3,
        top_m: 3e3,
    };
    let table = |kind| {
        DensityProfile::tabulated(vec![0.0, 1e3, 4e3, 5e3], vec![1.0, 0.8, 0.1, 0.0], kind).unwrap()
    };
    vec![
        DensityProfile::Exponential {
            scale_height_m: 8e3,
        },
        DensityProfile::StandardAir1976,
        table(Interpolation::Linear),
        table(Interpolation::LogLinear),
        DensityProfile::Sum(vec![(0.5, tent.clone()), (2.0, layer.clone())]),
        tent,
        layer,
    ]
}

#[test]
fn columns_are_integrals_of_the_density() {
    for profile in kinds() {
        for (a, b) in [(-500.0, 700.0), (0.0, 90e3), (2.5e3, 30e3), (4.5e3, 4.6e3)] {
            let mut breaks = profile.breakpoints_m();
            breaks.extend(standard_air::kinks_m());
            breaks.extend((1..90).map(|i| f64::from(i) * 1e3));
            let want = GaussRule::new(12).integrate_between(a, b, &breaks, |z| profile.at(z));
            let got = profile.column_m(a, b);
            assert!(
                (got - want).abs() <= 1e-10 * want,
                "{profile:?} {a} {b}: {got} against {want}"
            );
        }
        assert_eq!(profile.column_m(5e3, 5e3), 0.0);
        assert_eq!(profile.column_m(6e3, 5e3), 0.0);
    }
}

#[test]
fn profiles_hold_what_they_promise_beyond_their_ends() {
    let exponential = DensityProfile::Exponential {
        scale_height_m: 8e3,
    };
    assert!(exponential.at(-400.0) > 1.0);
    let [_, air, table, ..] = &kinds()[..] else {
        unreachable!()
    };
    assert!(air.at(-400.0) > 1.03 && air.at(-400.0) < 1.05);
    assert_eq!(air.at(0.0), 1.0);
    assert_eq!(
        (table.at(-1e3), table.at(5e3), table.at(6e3)),
        (1.0, 0.0, 0.0)
    );
    assert_eq!(table.breakpoints_m(), [0.0, 1e3, 4e3, 5e3]);
    let edge = DensityProfile::Tent {
        bottom_m: 0.0,
        peak_m: 0.0,
        top_m: 2e3,
    };
    assert_eq!(
        (edge.at(0.0), edge.at(1e3), edge.column_m(0.0, 9e3)),
        (1.0, 0.5, 1e3)
    );
}

#[test]
fn thin_columns_keep_their_digits() {
    let profile = DensityProfile::Exponential {
        scale_height_m: 8e3,
    };
    assert!(
        (profile.column_m(100.0, 100.0 + 1e-6) / (1e-6 * profile.at(100.0)) - 1.0).abs() < 1e-7
    );
    let flat = DensityProfile::tabulated(vec![0.0, 1e3], vec![0.3, 0.3], Interpolation::LogLinear)
        .unwrap();
    assert_eq!(flat.column_m(0.0, 1e3), 0.3e3);
}

#[test]
fn bad_profiles_are_refused() {
    for scale_height_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let profile = DensityProfile::Exponential { scale_height_m };
        assert!(matches!(
            profile.validate(),
            Err(DensityError::ScaleHeight(_))
        ));
    }
    let upside_down = DensityProfile::Layer {
        bottom_m: 2.0,
        top_m: 1.0,
    };
    assert_eq!(
        upside_down.validate(),
        Err(DensityError::Edges(vec![2.0, 1.0]))
    );
    let sum = DensityProfile::Sum(vec![(-1.0, DensityProfile::StandardAir1976)]);
    assert!(matches!(
        sum.validate(),
        Err(DensityError::Negative { index: 0, .. })
    ));
    let table = |z: &[f64], d: &[f64]| {
        AltitudeTable::new(z.to_vec(), d.to_vec(), Interpolation::Linear).unwrap_err()
    };
    assert!(matches!(
        table(&[0.0], &[1.0]),
        DensityError::Altitudes { .. }
    ));
    assert!(matches!(
        table(&[0.0, 0.0], &[1.0; 2]),
        DensityError::Altitudes { index: 1, .. }
    ));
    assert!(matches!(
        table(&[0.0, 1.0], &[1.0]),
        DensityError::Length { .. }
    ));
    assert!(matches!(
        table(&[0.0, 1.0], &[1.0, -1.0]),
        DensityError::Negative { index: 1, .. }
    ));
}
