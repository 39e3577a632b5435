//! Random paths with their polarisation.

use airlight::axes::direction;
use airlight::light::SunDisc;
use airlight::medium::{Atmosphere, Constituent, DensityProfile, Planet, preset, reference};
use airlight::optics::PhaseFunction;
use airlight::sky::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use glam::DVec3;

/// Height of its top, m.
const TOP_M: f64 = 100.0;

/// A layer of even air of a vertical optical depth on a planet so large that it is flat, lit by the sun of unit irradiance.
fn slab(phase: PhaseFunction, optical_depth: f64, ground_albedo: f64) -> Atmosphere {
    Atmosphere {
        name: "slab".to_owned(),
        planet: Planet {
            radius_m: 1e9,
            top_altitude_m: TOP_M,
            ground_altitude_m: 0.0,
            ground_albedo: SpectralCurve::Constant(ground_albedo),
        },
        constituents: vec![Constituent {
            name: "air".to_owned(),
            density: DensityProfile::Layer {
                bottom_m: 0.0,
                top_m: TOP_M,
            },
            scattering_per_m: SpectralCurve::Constant(optical_depth / TOP_M),
            absorption_per_m: SpectralCurve::Constant(0.0),
            phase,
        }],
        solar_irradiance: SpectralCurve::Constant(1.0),
        sun: SunDisc::default(),
    }
}

fn solver(air: &Atmosphere, wavelengths_nm: &[f64], paths: u64) -> MonteCarlo {
    let grid = WavelengthGrid::from_wavelengths_nm(wavelengths_nm.to_vec()).unwrap();
    let settings = MonteCarloSettings {
        paths,
        ..Default::default()
    };
    MonteCarlo::new(air, &grid, settings).unwrap()
}

/// Light scattered once by molecules is polarised across the scattering plane, as much as their depolarization lets it be.
#[test]
fn light_scattered_once_is_polarised_across_its_plane() {
    for rho in [0.0, 0.1] {
        let phase = PhaseFunction::rayleigh(rho).unwrap();
        let air = solver(&slab(phase, 1e-6, 0.0), &[550.0], 256);
        for (azimuth, elevation, sun_deg) in [
            (0.0, 90.0, 20.0),
            (40.0, 30.0, 20.0),
            (250.0, 5.0, 45.0),
            (90.0, 60.0, 0.5),
            (181.0, 50.0, 10.0),
        ] {
            let (view, sun) = (direction(azimuth, elevation), direction(180.0, sun_deg));
            let found = air.polarised(0.0, sun, view, None);
            let mu = view.dot(sun);
            let degree = (1.0 - rho) * (1.0 - mu * mu) / (1.0 + mu * mu + rho * (1.0 - mu * mu));
            assert!((found.degree.mean[0] - degree).abs() < 1e-5, "{degree}");
            // The plane as the eye sees it: from up (at the zenith from the north) to the left.
            let up = match elevation == 90.0 {
                true => DVec3::Z,
                false => (DVec3::Y - view * view.y).normalize(),
            };
            let left = up.cross(view);
            let across = view.cross(sun);
            let angle = across.dot(left).atan2(across.dot(up)).to_degrees();
            let off = (found.angle_deg.mean[0] - angle + 90.0).rem_euclid(180.0) - 90.0;
            assert!(off.abs() < 0.01, "{azimuth} {elevation}: {off}");
            assert!((0.0..180.0).contains(&found.angle_deg.mean[0]));
            let effect = found.effect.mean[0] / found.intensity.mean[0];
            assert!(effect.abs() < 1e-5);
        }
    }
}

/// In the sun's vertical plane nothing says left or right; nor does it matter on which side of it one looks.
#[test]
fn left_and_right_are_alike() {
    let air = solver(&preset("clear").unwrap(), &[450.0, 600.0], 32_768);
    let sun = direction(180.0, 15.0);
    for view in [
        direction(180.0, 60.0),
        direction(0.0, 20.0),
        direction(0.0, 75.0),
    ] {
        let found = air.polarised(2.0, sun, view, None);
        for lane in 0..2 {
            assert!(found.u.mean[lane].abs() < 4.0 * found.u.standard_error[lane]);
            assert!(found.u.standard_error[lane] < 0.01 * found.intensity.mean[lane]);
        }
    }
    let [left, right] = [130.0, 230.0].map(|az| air.polarised(2.0, sun, direction(az, 40.0), None));
    for lane in 0..2 {
        let apart = |a: f64, b: f64, ea: f64, eb: f64| (a - b).abs() / ea.hypot(eb);
        let (l, r) = (&left, &right);
        assert!(
            apart(
                l.q.mean[lane],
                r.q.mean[lane],
                l.q.standard_error[lane],
                r.q.standard_error[lane]
            ) < 4.0
        );
        assert!(
            apart(
                l.u.mean[lane],
                -r.u.mean[lane],
                l.u.standard_error[lane],
                r.u.standard_error[lane]
            ) < 4.0
        );
        assert!(l.u.mean[lane].abs() > 20.0 * l.u.standard_error[lane]);
    }
}

/// The more often light is scattered, the less is left of its polarisation; a bright ground takes from it, too.
#[test]
fn thick_air_and_bright_ground_depolarise() {
    let (sun, view) = (direction(180.0, 30.0), direction(0.0, 60.0));
    let degree = |depth: f64, albedo: f64| {
        let molecules = PhaseFunction::rayleigh(0.03).unwrap();
        let air = solver(&slab(molecules, depth, albedo), &[550.0], 16_384);
        let found = air.polarised(0.0, sun, view, None);
        assert!(found.degree.standard_error[0] < 0.02);
        found.degree.mean[0]
    };
    let dark = [0.01, 0.1, 0.5, 2.0].map(|depth| degree(depth, 0.0));
    assert!(
        dark[0] > 0.9 && dark.is_sorted_by(|a, b| *a > b + 0.02),
        "{dark:?}"
    );
    assert!(degree(0.1, 0.8) < dark[1] - 0.05);
}

/// Without polarisation there is none, and the radiance is the scalar one.
#[test]
fn light_without_polarisation_is_scalar() {
    let lobe = PhaseFunction::HenyeyGreenstein { g: 0.5 };
    let air = solver(&slab(lobe, 0.7, 0.3), &[550.0], 1024);
    let found = air.polarised(0.0, direction(180.0, 40.0), direction(80.0, 30.0), None);
    assert!(found.effect.mean[0].abs() < 1e-6 * found.intensity.mean[0]);
    assert_eq!((found.q.mean[0], found.u.mean[0]), (0.0, 0.0));
    assert_eq!((found.degree.mean[0], found.angle_deg.mean[0]), (0.0, 0.0));
}

/// Whoever asks for polarisation follows the same paths as who does not, on any number of threads.
#[test]
fn paths_do_not_depend_on_what_they_carry() {
    let air = solver(&reference::rayleigh(0.3), &[440.0, 550.0, 680.0], 1024);
    let (sun, view) = (direction(180.0, 12.0), direction(60.0, 8.0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = || air.polarised(0.0, sun, view, Some(30e3));
        pool.build().unwrap().install(found)
    };
    let one = on(1);
    assert_eq!(one, on(2));
    let scalar = air.path_radiance(0.0, sun, view, 30e3);
    for (a, b) in scalar.mean.iter().zip(&one.scalar.mean) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
    let bundles = (0..16).map(|bundle| air.sample_polarised(0.0, sun, view, Some(30e3), bundle));
    let sum: f64 = bundles.map(|sample| sample.stokes[1][2]).sum();
    assert!((sum / 16.0 / one.q.mean[2] - 1.0).abs() < 1e-9);
}

/// Light that a Rayleigh layer of an optical depth of 0.5 sends up under a sun at a cosine of 0.2, for a solar irradiance of
/// pi: Natraj, Li & Yung, Astrophys. J. 691, 1909, 2009, who made the tables of Coulson, Dave & Sekera (1960) anew. Cosine of
/// the view's zenith angle, azimuth from the sun's, then `I`, `Q` and `U` over ground of albedo 0 and `I` and `Q` over one of
/// 0.8. Their `Q` is positive across the vertical plane.
const RAYLEIGH_LAYER: [([f64; 2], [f64; 5]); 6] = [
    (
        [0.02, 0.0],
        [0.44129802, -0.01753141, 0.0, 0.47382125, -0.01553672],
    ),
    (
        [0.4, 0.0],
        [0.16889020, 0.01119511, 0.0, 0.23059806, 0.01144320],
    ),
    (
        [1.0, 0.0],
        [0.05300496, 0.03755859, 0.0, 0.13280858, 0.03755859],
    ),
    (
        [0.02, 60.0],
        [0.30091208, -0.15965601, 0.07365528, 0.33343531, -0.15766132],
    ),
    (
        [0.4, 60.0],
        [0.12752450, -0.06066038, 0.05293867, 0.18923236, -0.06041229],
    ),
    (
        [1.0, 60.0],
        [0.05300496, -0.01877930, 0.03252669, 0.13280858, -0.01877930],
    ),
];

#[test]
fn a_rayleigh_layer_is_as_published() {
    let (mut squares, mut count, mut worst_scalar) = (0.0, 0.0, 0.0f64);
    for albedo in [0.0, 0.8] {
        let molecules = PhaseFunction::rayleigh(0.0).unwrap();
        let air = solver(&slab(molecules, 0.5, albedo), &[550.0], 65_536);
        let sun = direction(180.0, 0.2f64.asin().to_degrees());
        for ([mu, azimuth], table) in RAYLEIGH_LAYER {
            // At the nadir itself there is no vertical plane to count from.
            let elevation = -f64::asin(f64::min(mu, 1.0 - 1e-9)).to_degrees();
            let view = direction(180.0 + azimuth, elevation);
            let found = air.polarised(2.0 * TOP_M, sun, view, None);
            let (i, q, u) = match albedo {
                0.0 => (table[0], table[1], table[2]),
                _ => (table[3], table[4], table[2]),
            };
            for (part, want, name) in [
                (&found.intensity, i, "I"),
                (&found.q, -q, "Q"),
                (&found.u, -u, "U"),
            ] {
                let want = want / std::f64::consts::PI;
                let off = (part.mean[0] - want) / part.standard_error[0];
                println!(
                    "{albedo} {mu} {azimuth} {name}: {:.5} for {want:.5}, {off:.1} standard errors",
                    part.mean[0]
                );
                assert!(part.standard_error[0] < 0.005 * found.intensity.mean[0]);
                assert!(off.abs() < 4.5, "{albedo} {mu} {azimuth} {name}: {off}");
                squares += off * off;
                count += 1.0;
            }
            let effect = found.effect.mean[0] / found.intensity.mean[0];
            worst_scalar = worst_scalar.max(effect.abs());
        }
    }
    let square = squares / count;
    println!(
        "mean square {square:.2}; scalar light off by up to {:.1} %",
        100.0 * worst_scalar
    );
    assert!(square < 1.8, "{square}");
    assert!(worst_scalar > 0.02, "scalar light would do: {worst_scalar}");
}
