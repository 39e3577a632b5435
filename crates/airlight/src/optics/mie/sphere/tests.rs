use super::*;
use crate::math::quadrature::GaussRule;
use crate::optics::mie::recurrence::terms;
use crate::optics::{Depolarization, PhaseFunction};

/// Rows of a test table whose first field is `source`.
fn rows(text: &str, source: &str) -> Vec<Vec<f64>> {
    let fields = text.lines().filter_map(|line| line.strip_prefix(source));
    let numeric = fields.filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    numeric
        .map(|line| {
            let numbers = line.split(',').filter(|field| !field.is_empty());
            numbers.map(|field| field.parse().unwrap()).collect()
        })
        .collect()
}

/// Against 60-digit arithmetic in extreme cases: x from 0.001 to 20000, metals, soot, weakly absorbing water.
#[test]
fn corners_agree_with_sixty_digits() {
    let text = include_str!("../../../../tests/data/mie_corners.csv");
    let mut worst = [0.0f64; 6];
    let all = rows(text, "mpmath,");
    assert_eq!(all.len(), 18);
    for row in all {
        let (x, m) = (row[0], Complex64::new(row[1], row[2]));
        let sphere = Sphere::new(x, m).unwrap();
        let q = sphere.efficiencies();
        let absorption = match m.im == 0.0 {
            true => q.absorption + 1.0,
            false => q.absorption / row[5],
        };
        let mut errors = [
            q.extinction / row[3] - 1.0,
            q.scattering / row[4] - 1.0,
            absorption - 1.0,
            q.backscattering / row[6] - 1.0,
            q.asymmetry - row[7],
            0.0,
        ];
        // Amplitudes, relative to the square root of the forward intensity, the scale of their terms.
        for (i, angle) in [0.0f64, 60.0, 137.0, 180.0].into_iter().enumerate() {
            let [s1, s2] = sphere.amplitudes(angle.to_radians().cos());
            let at = 8 + 4 * i;
            let want = [
                Complex64::new(row[at], row[at + 1]),
                Complex64::new(row[at + 2], row[at + 3]),
            ];
            let size = (want[0].norm_sqr() + want[1].norm_sqr()).sqrt();
            for (got, want) in [s1, s2].into_iter().zip(want) {
                errors[5] = errors[5].max((got - want).norm() / size);
            }
        }
        println!("{x} {m}: {errors:?}");
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
    }
    println!("worst of Qext, Qsca, Qabs, Qback, g, S: {worst:?}");
    let [ext, sca, abs, back, g, amplitude] = worst;
    assert!(ext < 1e-13 && sca < 1e-13 && abs < 1e-13 && g < 1e-13);
    assert!(back < 3e-11 && amplitude < 3e-11);
}

/// miepython 3.3.0, whose own errors are about 1e-10, and 2e-7 in one case (x = 0.05, a series for small spheres).
#[test]
fn corners_agree_with_miepython() {
    let text = include_str!("../../../../tests/data/mie_corners.csv");
    let all = rows(text, "miepython,");
    assert_eq!(all.len(), 18);
    for row in all {
        let q = Sphere::new(row[0], Complex64::new(row[1], row[2]))
            .unwrap()
            .efficiencies();
        let got = [q.extinction, q.scattering, q.backscattering, q.asymmetry];
        for (got, want) in got.into_iter().zip([row[3], row[4], row[6], row[7]]) {
            assert!((got / want - 1.0).abs() < 2.5e-6, "{row:?}: {got} {want}");
        }
    }
}

/// Water with index 1.333, by miepython: efficiencies to 1e-6, phase function to 1e-4 at every whole degree.
#[test]
fn water_agrees_with_the_reference_tables() {
    let text = include_str!("../../../../tests/data/mie_water_n1.333_efficiencies.csv");
    let water = Complex64::new(1.333, 0.0);
    let mut count = 0;
    for row in rows(text, "") {
        let q = Sphere::new(row[0], water).unwrap().efficiencies();
        let got = [q.extinction, q.scattering, q.backscattering, q.asymmetry];
        for (got, want) in got.into_iter().zip(&row[1..5]) {
            assert!((got / want - 1.0).abs() < 1e-6, "{row:?}: {got}");
        }
        count += 1;
    }
    assert_eq!(count, 4);
    let text = include_str!("../../../../tests/data/mie_water_n1.333_phase.csv");
    let (mut worst, mut count) = (0.0f64, 0);
    for row in rows(text, "") {
        let got = Sphere::new(row[0], water)
            .unwrap()
            .phase(row[1].to_radians().cos());
        worst = worst.max((got / row[2] - 1.0).abs());
        count += 1;
    }
    println!("phase function, worst of {count}: {worst:.1e}");
    assert!(count == 724 && worst < 1e-4, "{count} {worst}");
}

/// Example of Bohren & Huffman (1983, appendix A): a sphere of radius 0.525 micrometres and index 1.55 in a medium of index
/// 1 at 632.8 nm.
#[test]
#[expect(
    clippy::approx_constant,
    reason = "a printed value that resembles pi / 4"
)]
fn bohren_and_huffmans_example_is_reproduced() {
    let x = 2.0 * PI * 0.525 / 0.6328;
    let sphere = Sphere::new(x, Complex64::new(1.55, 0.0)).unwrap();
    let q = sphere.efficiencies();
    assert!((x - 5.213).abs() < 5e-4);
    assert!((q.scattering - 3.10543).abs() < 1e-5, "{q:?}");
    assert!((q.backscattering - 2.92534).abs() < 1e-5, "{q:?}");
    // The printed table of angles at 9 degrees: S11 relative to 0 degrees, polarisation, S33 and S34 relative to S11.
    let forward = sphere.matrix(1.0).f11;
    let m = sphere.matrix(9.0f64.to_radians().cos());
    let got = [
        m.f11 / forward,
        -m.f12 / m.f11,
        m.f33 / m.f11,
        m.f34 / m.f11,
    ];
    for (got, want) in got
        .into_iter()
        .zip([0.785390, -0.00459811, 0.999400, 0.0343261])
    {
        assert!((got - want).abs() < 1e-6, "{got} {want}");
    }
}

/// The extinction cross-section of large spheres is twice their geometric cross-section.
#[test]
fn extinction_efficiency_of_large_spheres_tends_to_two() {
    for m in [Complex64::new(1.333, 0.0), Complex64::new(1.75, 0.44)] {
        for x in [30.0, 300.0, 3e3, 3e4] {
            let excess = Sphere::new(x, m).unwrap().efficiencies().extinction - 2.0;
            // Edge contribution 1.99 x^(-2/3) (Nussenzveig & Wiscombe 1980).
            assert!(
                excess.abs() < 4.0 * f64::powf(x, -2.0 / 3.0),
                "{x}: {excess}"
            );
        }
    }
}

/// `Q_sca = 8/3 x^4 |K|^2` and `Q_abs = 4 x Im K`, `K = (m^2 - 1) / (m^2 + 2)` (BH eqs. 5.7 and 5.8).
#[test]
fn small_spheres_follow_the_rayleigh_limit() {
    for m in [Complex64::new(1.333, 0.0), Complex64::new(1.75, 0.44)] {
        let x = 1e-3;
        let sphere = Sphere::new(x, m).unwrap();
        let k = (m * m - 1.0) / (m * m + 2.0);
        let q = sphere.efficiencies();
        assert!((q.scattering / (8.0 / 3.0 * x.powi(4) * k.norm_sqr()) - 1.0).abs() < 1e-5);
        let absorbed = 4.0 * x * k.im;
        assert!((q.absorption - absorbed).abs() <= 1e-5 * absorbed);
        let dipole = PhaseFunction::Rayleigh(Depolarization::None);
        for mu in [-1.0, -0.3, 0.0, 0.7, 1.0] {
            let ratio = sphere.phase(mu) / dipole.evaluate(mu, 550.0);
            assert!((ratio - 1.0).abs() < 2e-6, "{mu}: {ratio}");
        }
        assert!((sphere.matrix(0.0).f12 / sphere.matrix(0.0).f11 + 1.0).abs() < 1e-6);
    }
}

/// The forward amplitude gives the extinction, `Q_ext = 4 Re S(0) / x^2` (optical theorem); the phase function integrates to
/// 1 with mean cosine `g`; the matrix satisfies `f11^2 = f12^2 + f33^2 + f34^2`.
#[test]
fn amplitudes_and_efficiencies_are_consistent() {
    for (x, m) in [
        (0.01, Complex64::new(1.5, 0.1)),
        (3.0, Complex64::new(1.33, 0.0)),
        (60.0, Complex64::new(1.53, 0.008)),
        (400.0, Complex64::new(1.333, 1e-8)),
    ] {
        let sphere = Sphere::new(x, m).unwrap();
        let q = sphere.efficiencies();
        let [s1, s2] = sphere.amplitudes(1.0);
        assert!((s1 - s2).norm() < 1e-12 * s1.norm());
        assert!(
            (4.0 * s1.re / (x * x) / q.extinction - 1.0).abs() < 1e-11,
            "{x}"
        );
        assert!((q.scattering + q.absorption - q.extinction).abs() < 1e-14 * q.extinction);
        // The integrand is a polynomial of degree 2 N in the cosine.
        let (mut whole, mut mean) = (0.0, 0.0);
        for (mu, weight) in GaussRule::new(terms(x) + 2).on(-1.0, 1.0) {
            let matrix = sphere.matrix(mu);
            whole += 2.0 * PI * weight * matrix.f11;
            mean += 2.0 * PI * weight * matrix.f11 * mu;
            let squares = matrix.f12.powi(2) + matrix.f33.powi(2) + matrix.f34.powi(2);
            assert!((squares.sqrt() / matrix.f11 - 1.0).abs() < 1e-12);
        }
        assert!(
            (whole - 1.0).abs() < 1e-10 && (mean - q.asymmetry).abs() < 1e-10,
            "{x}: {whole} {mean}"
        );
    }
}

#[test]
fn weak_absorption_keeps_relative_accuracy() {
    // To first order in k, a water drop absorbs 4/3 x 4 n k: proportional to k however small.
    let absorbed = |k: f64| {
        Sphere::new(50.0, Complex64::new(1.333, k))
            .unwrap()
            .efficiencies()
            .absorption
    };
    let ratio = absorbed(1e-12) / absorbed(1e-9);
    assert!((ratio * 1e3 - 1.0).abs() < 1e-6, "{ratio}");
    assert_eq!(absorbed(0.0), 0.0);
}

#[test]
fn invalid_parameters_are_refused() {
    let m = Complex64::new(1.33, 0.0);
    for x in [0.0, -1.0, f64::NAN, f64::INFINITY, 2e5] {
        assert!(matches!(Sphere::new(x, m), Err(MieError::SizeParameter(_))));
    }
    for (n, k) in [
        (0.0, 0.0),
        (1.3, -0.1),
        (f64::NAN, 0.0),
        (1.0, f64::INFINITY),
        (-1.3, 0.0),
    ] {
        let index = Complex64::new(n, k);
        assert!(matches!(
            Sphere::new(1.0, index),
            Err(MieError::Index { .. })
        ));
    }
}
