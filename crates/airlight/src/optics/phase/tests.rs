use super::*;
use crate::math::quadrature::GaussRule;

/// All kinds of phase functions, with demanding parameters.
pub(super) fn kinds() -> Vec<PhaseFunction> {
    let angles: Vec<f64> = (0..=90).map(|i| 2.0 * f64::from(i)).collect();
    let peaked = |g: f64| {
        let of = move |a: &f64| 7.0 * henyey_greenstein(g, a.to_radians().cos());
        angles.iter().map(of).collect::<Vec<f64>>()
    };
    let table = TabulatedPhase::new(
        angles.clone(),
        vec![450.0, 650.0],
        [peaked(0.8), peaked(0.6)].concat(),
    );
    vec![
        PhaseFunction::Isotropic,
        PhaseFunction::Rayleigh(Depolarization::None),
        PhaseFunction::rayleigh(0.2).unwrap(),
        PhaseFunction::Rayleigh(Depolarization::Air),
        PhaseFunction::henyey_greenstein(0.76).unwrap(),
        PhaseFunction::henyey_greenstein(-0.4).unwrap(),
        PhaseFunction::cornette_shanks(0.8).unwrap(),
        PhaseFunction::draine(0.55, 3.0).unwrap(),
        PhaseFunction::mixture(vec![
            (0.75, PhaseFunction::HenyeyGreenstein { g: 0.9 }),
            (0.25, PhaseFunction::CornetteShanks { g: -0.2 }),
        ])
        .unwrap(),
        PhaseFunction::Tabulated(table.unwrap()),
    ]
}

/// `2 pi` times the integral of `p P_l` over the cosine, in panels that refine towards both peaks.
fn moment(phase: &PhaseFunction, l: usize, nm: f64) -> f64 {
    let breaks: Vec<f64> = (1..360)
        .map(|i| (0.5 * f64::from(i)).to_radians().cos())
        .collect();
    2.0 * PI
        * GaussRule::new(16).integrate_between(-1.0, 1.0, &breaks, |mu| {
            let (mut before, mut now) = (0.0, 1.0);
            for k in 0..l {
                let x = k as f64;
                (before, now) = (now, ((2.0 * x + 1.0) * mu * now - x * before) / (x + 1.0));
            }
            phase.evaluate(mu, nm) * now
        })
}

#[test]
fn all_kinds_are_normalised_and_moments_match_quadrature() {
    for phase in kinds() {
        for nm in [400.0, 520.0, 700.0] {
            let moments = phase.legendre_moments(12, nm);
            assert!(
                (moment(&phase, 0, nm) - 1.0).abs() < 2e-10,
                "{phase:?} at {nm} nm"
            );
            for (l, got) in moments.iter().enumerate() {
                let want = moment(&phase, l, nm);
                assert!(
                    (got - want).abs() < 1e-9,
                    "{phase:?} l = {l}: {got} against {want}"
                );
            }
            assert_eq!(phase.asymmetry(nm), moments[1]);
        }
    }
}

#[test]
fn moments_expand_to_the_function() {
    for phase in kinds()
        .iter()
        .filter(|p| !matches!(p, PhaseFunction::Tabulated(_)))
    {
        let moments = phase.legendre_moments(200, 550.0);
        for mu in [-1.0, -0.3, 0.2, 0.9] {
            let (mut before, mut now, mut sum) = (0.0, 1.0, 0.0);
            for (l, chi) in moments.iter().enumerate() {
                let x = l as f64;
                sum += (2.0 * x + 1.0) / (4.0 * PI) * chi * now;
                (before, now) = (now, ((2.0 * x + 1.0) * mu * now - x * before) / (x + 1.0));
            }
            let want = phase.evaluate(mu, 550.0);
            assert!(
                (sum / want - 1.0).abs() < 1e-6,
                "{phase:?} at {mu}: {sum} against {want}"
            );
        }
    }
}

#[test]
fn draine_reduces_to_the_other_kinds() {
    for mu in [-1.0, -0.5, 0.0, 0.3, 0.999, 1.0] {
        let close = |a: PhaseFunction, b: PhaseFunction| {
            let (a, b) = (a.evaluate(mu, 550.0), b.evaluate(mu, 550.0));
            assert!((a / b - 1.0).abs() < 1e-14, "{mu}: {a} against {b}");
        };
        let draine = |g, alpha| PhaseFunction::Draine { g, alpha };
        close(draine(0.7, 0.0), PhaseFunction::HenyeyGreenstein { g: 0.7 });
        close(draine(0.7, 1.0), PhaseFunction::CornetteShanks { g: 0.7 });
        close(
            draine(0.0, 1.0),
            PhaseFunction::Rayleigh(Depolarization::None),
        );
        // Cornette & Shanks as printed.
        let g = 0.7f64;
        let printed = 3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + mu * mu)
            / ((2.0 + g * g) * (1.0 + g * g - 2.0 * g * mu).powf(1.5));
        assert!(
            (PhaseFunction::CornetteShanks { g }.evaluate(mu, 0.0) / printed - 1.0).abs() < 1e-13
        );
    }
    let g = 0.8;
    let mean = 3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g));
    assert!((PhaseFunction::CornetteShanks { g }.asymmetry(550.0) - mean).abs() < 1e-15);
}

#[test]
fn sharp_peaks_do_not_cancel() {
    // The peak value of Henyey-Greenstein is (1 + g) / (4 pi (1 - g)^2).
    for exponent in 1..=12 {
        let distance = 10f64.powi(-exponent);
        for g in [1.0 - distance, distance - 1.0] {
            let gap = 1.0 - g.abs();
            let want = (2.0 - gap) / (4.0 * PI * gap * gap);
            let got = PhaseFunction::HenyeyGreenstein { g }.evaluate(g.signum(), 550.0);
            assert!(
                (got / want - 1.0).abs() < 1e-14,
                "{g}: {got} against {want}"
            );
        }
    }
}

#[test]
fn invalid_parameters_are_refused() {
    for g in [1.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            PhaseFunction::henyey_greenstein(g),
            Err(PhaseError::Asymmetry(_))
        ));
        assert!(matches!(
            PhaseFunction::cornette_shanks(g),
            Err(PhaseError::Asymmetry(_))
        ));
    }
    assert_eq!(
        PhaseFunction::draine(0.5, -1.0),
        Err(PhaseError::Alpha(-1.0))
    );
    assert_eq!(
        PhaseFunction::rayleigh(0.9),
        Err(PhaseError::Depolarization(0.9))
    );
    let half = vec![(0.5, PhaseFunction::Isotropic)];
    assert_eq!(
        PhaseFunction::mixture(half),
        Err(PhaseError::WeightSum(0.5))
    );
    let negative = vec![
        (1.5, PhaseFunction::Isotropic),
        (-0.5, PhaseFunction::Isotropic),
    ];
    assert!(matches!(
        PhaseFunction::mixture(negative),
        Err(PhaseError::Weight { index: 1, .. })
    ));
    let inner = vec![(1.0, PhaseFunction::HenyeyGreenstein { g: 2.0 })];
    assert_eq!(
        PhaseFunction::mixture(inner),
        Err(PhaseError::Asymmetry(2.0))
    );
}
