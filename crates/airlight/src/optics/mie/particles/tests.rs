use super::*;
use crate::math::quadrature::GaussRule;
use crate::optics::mie::{Complex64, Sphere};

fn drops(radius_um: f64) -> Particles {
    Particles::water(SizeDistribution::gamma(radius_um, 0.1)).unwrap()
}

/// Cosines every quarter of a degree.
fn cosines() -> Vec<f64> {
    (0..=720)
        .map(|i| (0.25 * f64::from(i)).to_radians().cos())
        .collect()
}

/// Root mean square and maximum of `b / a - 1`.
fn difference(a: &[ScatteringMatrix], b: &[ScatteringMatrix]) -> [f64; 2] {
    let errors = a.iter().zip(b).map(|(a, b)| b.f11 / a.f11 - 1.0);
    let (squares, worst) = errors.fold((0.0, 0.0f64), |(sum, worst), e| {
        (sum + e * e, worst.max(e.abs()))
    });
    [(squares / a.len() as f64).sqrt(), worst]
}

#[test]
fn sums_over_sizes_converge() {
    let haze = SizeDistribution::log_normal(0.1, 1.8);
    let haze =
        Particles::new(RefractiveIndex::constant(Complex64::new(1.53, 0.006)), haze).unwrap();
    for (particles, rms_limit, worst_limit, bulk_limit) in
        [(drops(2.5), 6e-3, 0.03, 5e-4), (haze, 1e-6, 1e-5, 1e-7)]
    {
        let at = |factor: f64| {
            let (steps, control) = (STEPS.times(factor), Control::default());
            let prepared = particles.prepare(550.0, steps, control).unwrap();
            let matrices = prepared.matrices(&cosines(), control).unwrap();
            (particles.bulk_of(550.0, &prepared), matrices)
        };
        let ((bulk, matrices), (fine, fine_matrices)) = (at(1.0), at(0.2));
        let extinction = bulk.extinction_um2() / fine.extinction_um2() - 1.0;
        let asymmetry = bulk.asymmetry - fine.asymmetry;
        let [rms, worst] = difference(&fine_matrices, &matrices);
        println!(
            "extinction {extinction:.1e}, g {asymmetry:.1e}, phase {rms:.1e}, worst {worst:.1e}"
        );
        assert!(extinction.abs() < bulk_limit && asymmetry.abs() < bulk_limit);
        assert!(rms < rms_limit && worst < worst_limit);
    }
}

/// A monodisperse distribution matches the sphere: sums in single precision keep six digits.
#[test]
fn monodisperse_spheres_match_a_single_sphere() {
    for (radius_um, index) in [
        (1e-3, Complex64::new(1.5, 0.1)),
        (0.4, Complex64::new(1.75, 0.44)),
        (20.0, Complex64::new(1.333, 0.0)),
    ] {
        let sizes = SizeDistribution::Monodisperse { radius_um };
        let particles = Particles::new(RefractiveIndex::constant(index), sizes).unwrap();
        let sphere = Sphere::new(TAU * radius_um / 0.55, index).unwrap();
        let q = sphere.efficiencies();
        let bulk = particles.bulk(550.0).unwrap();
        let area = PI * radius_um * radius_um;
        assert!((bulk.scattering_um2 / (area * q.scattering) - 1.0).abs() < 1e-12);
        assert!((bulk.absorption_um2 - area * q.absorption).abs() < 1e-12 * area * q.extinction);
        assert!((bulk.asymmetry - q.asymmetry).abs() < 1e-12);
        let matrices = particles.matrices(550.0, &cosines()).unwrap();
        for (mu, matrix) in cosines().iter().zip(matrices) {
            let want = sphere.matrix(*mu);
            let mean = 0.5 * (want.f11 + 0.25 / PI);
            assert!(
                (matrix.f11 / want.f11 - 1.0).abs() < 2e-4,
                "{radius_um} {mu}"
            );
            assert!((matrix.f12 - want.f12).abs() < 2e-5 * mean);
            assert!((matrix.f33 - want.f33).abs() < 2e-5 * mean);
            assert!((matrix.f34 - want.f34).abs() < 2e-5 * mean);
        }
    }
}

/// Between its angles and wavelengths the table matches the sum over sizes.
#[test]
fn tables_resolve_peak_bow_and_glory() {
    let particles = drops(5.0);
    let (table, bulk) = particles.table(&[450.0, 480.0]).unwrap();
    assert!(
        table.angles_rad().len() < 600,
        "{}",
        table.angles_rad().len()
    );
    let angles: Vec<f64> = (0..2000)
        .map(|i| PI * (f64::from(i) / 2e3).powi(2))
        .collect();
    let cosines: Vec<f64> = angles.iter().map(|a| a.cos()).collect();
    for (nm, rms_limit, limit) in [(450.0, 1.5e-3, 8e-3), (465.0, 0.01, 0.08)] {
        let exact = particles.matrices(nm, &cosines).unwrap();
        let table: Vec<ScatteringMatrix> = cosines
            .iter()
            .map(|&mu| ScatteringMatrix {
                f11: table.evaluate(mu, nm),
                ..ScatteringMatrix::ZERO
            })
            .collect();
        let [rms, worst] = difference(&exact, &table);
        println!("{nm}: rms {rms:.1e}, worst {worst:.1e}");
        assert!(rms < rms_limit && worst < limit, "{nm}: {rms} {worst}");
    }
    // The mean cosine of the table.
    assert!((table.legendre_moments(2, 450.0)[1] - bulk[0].asymmetry).abs() < 2e-4);
    // The fogbow near 142 degrees and the glory near 180 degrees stand out.
    let at = |degrees: f64| table.evaluate(degrees.to_radians().cos(), 450.0);
    let bow = (130..155).map(|d| at(f64::from(d))).fold(0.0, f64::max);
    assert!(
        bow > 2.0 * at(120.0) && bow > 1.5 * at(165.0),
        "{bow} {} {}",
        at(120.0),
        at(165.0)
    );
    let glory = (1740..=1800)
        .map(|d| at(0.1 * f64::from(d)))
        .fold(0.0, f64::max);
    assert!(glory > 2.0 * at(165.0), "{glory}");
}

/// The sum over sizes is normalised without rescaling.
#[test]
fn phase_function_integrates_to_one() {
    let particles = Particles::water(SizeDistribution::gamma(1.0, 0.1)).unwrap();
    let (nodes, weights): (Vec<f64>, Vec<f64>) = GaussRule::new(200).on(-1.0, 1.0).unzip();
    let matrices = particles.matrices(550.0, &nodes).unwrap();
    let parts = matrices
        .iter()
        .zip(weights)
        .map(|(m, w)| 2.0 * PI * m.f11 * w);
    let whole: f64 = parts.sum();
    assert!((whole - 1.0).abs() < 1e-6, "{whole}");
}

#[test]
fn invalid_parameters_are_refused() {
    let fog = drops(5.0);
    assert!(matches!(fog.bulk(0.0), Err(MieError::Wavelength(_))));
    assert!(matches!(fog.bulk(1e-3), Err(MieError::SizeParameter(_))));
    assert!(matches!(fog.table(&[]), Err(MieError::Phase(_))));
    assert!(matches!(
        fog.table(&[500.0, 400.0]),
        Err(MieError::Phase(_))
    ));
    assert!(Particles::water(SizeDistribution::log_normal(1.0, 0.5)).is_err());
    let air = RefractiveIndex::constant(Complex64::ZERO);
    assert!(matches!(
        Particles::new(air, *fog.sizes()),
        Err(MieError::Index { .. })
    ));
}
