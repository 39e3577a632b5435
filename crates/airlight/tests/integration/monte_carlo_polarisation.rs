//! Monte Carlo with polarisation, and the sky solver, against published values.

use airlight::atmosphere::{
    Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet, preset, reference,
};
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings, PolarisedEstimate};
use airlight::optics::mie::Particles;
use airlight::optics::mie::droplets::Drops;
use airlight::optics::{PhaseFunction, RefractiveIndex};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::sun::SunDisc;
use glam::DVec3;
use num_complex::Complex64;
use std::f64::consts::PI;

/// Height of its top, m.
const TOP_M: f64 = 100.0;

/// A layer of even air of a vertical optical depth on a planet so large that it is flat, lit by the sun of unit irradiance.
fn slab(phase: PhaseFunction, optical_depth: f64, ground_albedo: f64) -> Atmosphere {
    layers(&[(0.0, TOP_M, optical_depth, phase)], ground_albedo)
}

/// The same of several layers: bottom and top (m), optical depth, phase function.
fn layers(parts: &[(f64, f64, f64, PhaseFunction)], ground_albedo: f64) -> Atmosphere {
    Atmosphere {
        name: "slab".to_owned(),
        planet: Planet {
            radius_m: 1e9,
            top_altitude_m: TOP_M,
            ground_altitude_m: 0.0,
            ground_albedo: SpectralCurve::Constant(ground_albedo),
        },
        constituents: parts
            .iter()
            .map(|(bottom_m, top_m, optical_depth, phase)| Constituent {
                kind: ConstituentKind::Fog,
                density: DensityProfile::Layer {
                    bottom_m: *bottom_m,
                    top_m: *top_m,
                },
                scattering_per_m: SpectralCurve::Constant(optical_depth / (top_m - bottom_m)),
                absorption_per_m: SpectralCurve::Constant(0.0),
                phase: phase.clone(),
            })
            .collect(),
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

/// Upward light of a Rayleigh layer with an optical depth of 0.5 under a sun at a cosine of 0.2, for a solar irradiance of
/// pi: Natraj, Li & Yung, Astrophys. J. 691, 1909, 2009, who recomputed the tables of Coulson, Dave & Sekera (1960). Cosine of
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

/// The sky solver against the same: errors in percent of the radiance, which scalar light misses by up to 10 %.
#[test]
fn the_solver_polarises_a_rayleigh_layer_as_published() {
    let molecules = PhaseFunction::rayleigh(0.0).unwrap();
    for (effort, settings, limit) in [
        ("standard", SkySettings::default(), [0.6, 0.4]),
        ("fine", SkySettings::fine(), [0.3, 0.2]),
    ] {
        let mut worst = [0.0f64; 2];
        for albedo in [0.0, 0.8] {
            let air = slab(molecules.clone(), 0.5, albedo);
            let sun = direction(180.0, 0.2f64.asin().to_degrees());
            for ([mu, azimuth], table) in RAYLEIGH_LAYER {
                let (i, q, u) = match albedo {
                    0.0 => (table[0], table[1], table[2]),
                    _ => (table[3], table[4], table[2]),
                };
                let off = solver_off(&air, &settings, (sun, down(mu, azimuth)), [i, -q, -u]);
                worst = [worst[0].max(off[0]), worst[1].max(off[1])];
            }
        }
        println!(
            "{effort}: I off by up to {:.2} %, Q and U by {:.2} %",
            worst[0], worst[1]
        );
        assert!(worst[0] < limit[0] && worst[1] < limit[1], "{worst:?}");
    }
}

/// What the sky solver misses published values of `I`, `Q` and `U` by, percent of `I`: `I`, and the distance of `Q` and `U`.
fn solver_off(
    air: &Atmosphere,
    settings: &SkySettings,
    (sun, view): (DVec3, DVec3),
    [i, q, u]: [f64; 3],
) -> [f64; 2] {
    let grid = WavelengthGrid::from_wavelengths_nm(vec![700.0]).unwrap();
    let settings = SkySettings {
        suns: SunCoverage::near(sun.y.asin().to_degrees(), TOP_M),
        ..settings.clone()
    };
    let sky = Sky::prepare(air, &grid, &settings).unwrap();
    let light = sky.view(2.0 * TOP_M, sun).polarised(view);
    let [fi, fq, fu] = [&light.intensity, &light.q, &light.u].map(|part| PI * f64::from(part[0]));
    [(fi - i).abs(), (fq - q).hypot(fu - u)].map(|off| 100.0 * off / i)
}

#[test]
fn a_rayleigh_layer_is_as_published() {
    let mut compared = Compared::default();
    for albedo in [0.0, 0.8] {
        let molecules = PhaseFunction::rayleigh(0.0).unwrap();
        let air = solver(&slab(molecules, 0.5, albedo), &[550.0], 65_536);
        let sun = direction(180.0, 0.2f64.asin().to_degrees());
        for ([mu, azimuth], table) in RAYLEIGH_LAYER {
            let found = air.polarised(2.0 * TOP_M, sun, down(mu, azimuth), None);
            let (i, q, u) = match albedo {
                0.0 => (table[0], table[1], table[2]),
                _ => (table[3], table[4], table[2]),
            };
            compared.add(&found, [i, -q, -u]);
        }
    }
    compared.judge();
}

/// Light that two layers send up, for a solar irradiance of pi: de Haan, Bosma & Hovenier, Astron. Astrophys. 183, 371, 1987,
/// table 9, as Rossi et al., Astron. Astrophys. 616, A147, 2018, print it in table A.2. Above, molecules (depolarization ratio
/// 0.0279) of an optical depth of 0.1; below, as many and water haze L (index 1.33, 700 nm) of 0.4; ground of albedo 0.1. Cosines of
/// the sun's and the view's zenith angles, azimuth from the sun's, `I`, `Q`, `U`.
const HAZE: [([f64; 3], [f64; 3]); 11] = [
    ([0.5, 0.1, 0.0], [0.532950, -0.028340, 0.0]),
    ([0.5, 0.5, 0.0], [0.208430, -0.036299, 0.0]),
    ([0.5, 1.0, 0.0], [0.093680, -0.024156, 0.0]),
    ([0.5, 0.1, 30.0], [0.418140, -0.000058, -0.073105]),
    ([0.5, 0.5, 30.0], [0.184970, -0.019649, -0.041401]),
    ([0.5, 1.0, 30.0], [0.093680, -0.012078, -0.020920]),
    ([0.1, 0.1, 0.0], [0.522770, 0.011506, 0.0]),
    ([0.1, 0.5, 0.0], [0.106590, -0.005186, 0.0]),
    ([0.1, 1.0, 0.0], [0.026009, -0.014984, 0.0]),
    ([0.1, 0.1, 30.0], [0.276300, 0.034368, -0.016042]),
    ([0.1, 0.5, 30.0], [0.083628, 0.003839, -0.014492]),
];

/// Air of [`HAZE`].
fn haze_under_molecules() -> Atmosphere {
    let index = RefractiveIndex::constant(Complex64::new(1.33, 0.0));
    let haze = Particles::new(index, Drops::HazeL.sizes()).unwrap();
    let haze = PhaseFunction::Tabulated(haze.table(&[700.0]).unwrap().0);
    let molecules = PhaseFunction::rayleigh(0.0279).unwrap();
    let half = 0.5 * TOP_M;
    let parts = [
        (half, TOP_M, 0.1, molecules.clone()),
        (0.0, half, 0.1, molecules),
        (0.0, half, 0.4, haze),
    ];
    layers(&parts, 0.1)
}

/// The sky solver against the same, for suns it solves for.
#[test]
fn the_solver_polarises_haze_under_molecules_nearly_as_published() {
    let air = haze_under_molecules();
    let mut worst = [0.0f64; 2];
    for ([sun, mu, azimuth], published) in HAZE {
        let sun = direction(180.0, f64::asin(sun).to_degrees());
        let view = down(mu, azimuth);
        let off = solver_off(&air, &SkySettings::default(), (sun, view), published);
        println!(
            "{mu} {azimuth}: I off by {:.2} %, Q and U by {:.2} %",
            off[0], off[1]
        );
        worst = [worst[0].max(off[0]), worst[1].max(off[1])];
    }
    assert!(worst[0] < 2.0 && worst[1] < 5.0, "{worst:?}");
}

#[test]
fn haze_under_molecules_is_as_published() {
    let air = solver(&haze_under_molecules(), &[700.0], 65_536);
    let mut compared = Compared::default();
    for ([sun, mu, azimuth], published) in HAZE {
        let sun = direction(180.0, f64::asin(sun).to_degrees());
        let found = air.polarised(2.0 * TOP_M, sun, down(mu, azimuth), None);
        compared.add(&found, published);
    }
    compared.judge();
}

/// Looking down, with the cosine of the line's angle from the vertical, at an azimuth from that of a sun in the south. At the
/// nadir itself there would be no vertical plane to count from.
fn down(mu: f64, azimuth_deg: f64) -> DVec3 {
    direction(
        180.0 + azimuth_deg,
        -f64::asin(mu.min(1.0 - 1e-9)).to_degrees(),
    )
}

/// Ours against published values of `I`, `Q`, `U`.
#[derive(Default)]
struct Compared {
    squares: f64,
    count: f64,
    /// What scalar light is off by at most, as a share.
    scalar: f64,
}

impl Compared {
    fn add(&mut self, found: &PolarisedEstimate, published: [f64; 3]) {
        let parts = [&found.intensity, &found.q, &found.u];
        for ((part, published), name) in parts.into_iter().zip(published).zip(["I", "Q", "U"]) {
            let (mean, error) = (PI * part.mean[0], PI * part.standard_error[0]);
            let off = (mean - published) / error;
            println!("{name} {mean:.5} +- {error:.5} for {published:.5}");
            assert!(error < 0.006 * PI * found.intensity.mean[0]);
            assert!(off.abs() < 4.5, "{name}: {off} standard errors");
            self.squares += off * off;
            self.count += 1.0;
        }
        let effect = (found.effect.mean[0] / found.intensity.mean[0]).abs();
        self.scalar = self.scalar.max(effect);
    }

    /// Differences are noise, and would not be without polarisation.
    fn judge(&self) {
        let square = self.squares / self.count;
        println!(
            "mean square {square:.2}; scalar light is off by up to {:.1} %",
            100.0 * self.scalar
        );
        assert!(square < 1.0 + 4.0 * (2.0 / self.count).sqrt(), "{square}");
        assert!(self.scalar > 0.02, "{}", self.scalar);
    }
}
