//! Fog compared with independent reference values: Henyey-Greenstein slabs and exponential fog under a sun of unit irradiance,
//! by Mitsuba (path tracing, with standard errors) and PythonicDISORT. Sources of the tables: `data/README.md`.

use crate::common::{green_fog, green_path, grey_layer, numbers, rows};
use airlight::axes::direction;
use airlight::fog::{DensityProfile, Fog, FogScattering, Ground, droplets};
use airlight::optics::PhaseFunction;
use glam::DVec3;

const SLAB: DensityProfile = DensityProfile::slab(100.0);

/// Fog 100 m high over flat ground.
struct Scene {
    profile: DensityProfile,
    /// Vertical optical depth.
    depth: f64,
    single_scattering_albedo: f64,
    phase: PhaseFunction,
    /// A sun of unit irradiance in the north; if `None`, an isotropic sky of unit radiance.
    sun_zenith_deg: Option<f64>,
    ground_albedo: f64,
}

impl Scene {
    fn fog(self, scattering: FogScattering) -> Fog {
        let sun = self.sun_zenith_deg;
        let sun = sun.map(|zenith| direction(0.0, 90.0 - zenith));
        let (extinction, albedo) = (self.depth / 100.0, self.single_scattering_albedo);
        let layer = grey_layer(self.profile, extinction, albedo, self.phase);
        green_fog(layer, Ground::FLAT, sun, self.ground_albedo, scattering)
    }
}

/// Path radiance up to the edge of a slab, a fraction `above` of which is above the eye.
fn to_the_edge(fog: &Fog, above: f64, view: DVec3) -> f64 {
    let height = 100.0 * (1.0 - above);
    let length = match view.y < 0.0 {
        true => height / -view.y,
        false => f64::INFINITY,
    };
    green_path(fog, height, view, length)[1]
}

/// Path radiance for a row of Mitsuba's table, from the ground through all of the fog.
fn from_ground(row: &[&str], scattering: FogScattering) -> f64 {
    let number = |column: usize| row[column].parse::<f64>().unwrap();
    let (profile, depth) = match row[0] {
        "slab" => (SLAB, number(3)),
        "expfog" => {
            let profile = DensityProfile::Exponential {
                reference_height_m: 0.0,
                scale_height_m: 100.0,
            };
            // In Mitsuba the fog ends at ten scale heights.
            (profile, number(3) * (1.0 - f64::exp(-10.0)))
        }
        other => panic!("unknown case {other}"),
    };
    let fog = Scene {
        profile,
        depth,
        single_scattering_albedo: number(2),
        phase: PhaseFunction::HenyeyGreenstein { g: number(1) },
        sun_zenith_deg: Some(number(4)),
        ground_albedo: 0.0,
    }
    .fog(scattering);
    to_the_edge(&fog, 1.0, direction(number(6), 90.0 - number(5)))
}

#[test]
fn single_scattering_matches_the_closed_form_and_mitsuba() {
    for row in rows(include_str!("../data/mitsuba_fog_checks.csv")) {
        let got = from_ground(&row, FogScattering::Single);
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let (closed, mitsuba, error) = (number(7), number(8), number(9));
        assert!((got / closed - 1.0).abs() < 1e-6, "{row:?}: {got}");
        assert!((got - mitsuba).abs() < 3.0 * error, "{row:?}: {got}");
    }
}

/// Relative errors of the path radiance of a ray, and of the irradiance on the ground.
struct Compared {
    g: f64,
    tau: f64,
    /// Angle between the ray and the sun, degrees; `None` without sun.
    from_sun_deg: Option<f64>,
    scattered: f64,
    irradiance: f64,
}

/// Relative errors for every row of the table of slabs.
fn slabs() -> Vec<Compared> {
    rows(include_str!("../data/fog_slabs_disort.csv"))
        .map(|row| {
            let number = |column: usize| row[column].parse::<f64>().unwrap();
            let (g, tau) = (number(1), number(2));
            // `sky` in place of an angle.
            let sun_zenith_deg = row[3].parse().ok();
            let fog = Scene {
                profile: SLAB,
                depth: tau,
                single_scattering_albedo: number(0),
                phase: PhaseFunction::HenyeyGreenstein { g },
                sun_zenith_deg,
                ground_albedo: number(4),
            }
            .fog(FogScattering::Multiple);
            let view = direction(number(7), 90.0 - number(6));
            let sun = sun_zenith_deg.map(|zenith| direction(0.0, 90.0 - zenith));
            let ground = fog.ground_irradiance().unwrap()[0];
            Compared {
                g,
                tau,
                from_sun_deg: sun.map(|sun| view.angle_between(sun).to_degrees()),
                scattered: to_the_edge(&fog, number(5), view) / number(8) - 1.0,
                irradiance: f64::from(ground) / number(9) - 1.0,
            }
        })
        .collect()
}

/// Median, 90th percentile and maximum of the absolute errors, in percent.
fn spread(errors: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut errors: Vec<f64> = errors.map(|e| 100.0 * e.abs()).collect();
    errors.sort_by(f64::total_cmp);
    let last = errors.len() - 1;
    [errors[last / 2], errors[last * 9 / 10], errors[last]]
}

/// Prints a table of the book with `--nocapture`. Limits are the measured errors (median, 90th percentile, maximum), rounded up.
#[test]
fn multiple_scattering_matches_disort() {
    let slabs = slabs();
    let towards = |c: &Compared, near: bool| c.from_sun_deg.is_some_and(|a| (a < 20.0) == near);
    let far = |c: &Compared| towards(c, false);
    let near = |c: &Compared| towards(c, true);
    let scattered = |of: &dyn Fn(&Compared) -> bool| -> Vec<f64> {
        slabs
            .iter()
            .filter(|c| of(c))
            .map(|c| c.scattered)
            .collect()
    };
    let [level, level_peaked] = nearly_level();
    println!("\n| lines | median | 90 % below | worst |\n|---|---|---|---|");
    for (name, errors, limits) in [
        ("20° or more from the sun", scattered(&far), [0.2, 1.6, 9.0]),
        (
            "asymmetry 0.7 or less",
            scattered(&|c| far(c) && c.g <= 0.7),
            [0.15, 0.6, 1.8],
        ),
        (
            "optical depth 5 or more",
            scattered(&|c| far(c) && c.tau >= 5.0),
            [0.15, 0.8, 6.5],
        ),
        (
            "less than 20° from the sun",
            scattered(&near),
            [0.2, 1.5, 6.0],
        ),
        (
            "asymmetry 0.7 or less",
            scattered(&|c| near(c) && c.g <= 0.7),
            [0.2, 1.0, 2.0],
        ),
        (
            "under an even sky, no sun",
            scattered(&|c| c.from_sun_deg.is_none()),
            [0.05, 0.2, 0.5],
        ),
        (
            "irradiance on the ground",
            slabs.iter().map(|c| c.irradiance).collect(),
            [0.1, 0.2, 1.0],
        ),
        (
            "droplets of 10 µm, 5° or more from the sun",
            droplets_of_ten(),
            [0.3, 2.5, 8.0],
        ),
        (
            "nearly level (0.5° to 15°), asymmetry 0.7",
            level,
            [0.6, 2.2, 3.5],
        ),
        (
            "nearly level, asymmetry 0.85",
            level_peaked,
            [1.0, 4.2, 8.0],
        ),
    ] {
        let measured @ [median, most, worst] = spread(errors.iter().copied());
        let digits = if worst < 9.95 { 1 } else { 0 };
        println!("| {name} | {median:.2} | {most:.1} | {worst:.digits$} |");
        for (error, limit) in measured.into_iter().zip(limits) {
            assert!(error < limit, "{name}: {error} % above {limit} %");
        }
    }
}

/// Relative errors of nearly level rays in thin fog, for asymmetries of 0.7 and 0.85. The most difficult case, as the forward
/// peak is wider than the bright band along the horizon.
fn nearly_level() -> [Vec<f64>; 2] {
    let mut errors = [Vec::new(), Vec::new()];
    for row in numbers::<7>(include_str!("../data/fog_level_disort.csv")) {
        let [g, tau, sun_zenith, zenith, azimuth, length, scattered] = row;
        let fog = Scene {
            profile: SLAB,
            depth: tau,
            single_scattering_albedo: 0.999999,
            phase: PhaseFunction::HenyeyGreenstein { g },
            sun_zenith_deg: Some(sun_zenith),
            ground_albedo: 0.2,
        }
        .fog(FogScattering::Multiple);
        let length = match length > 1e8 {
            true => f64::INFINITY,
            false => length / tau * 100.0,
        };
        let view = direction(azimuth, 90.0 - zenith);
        let path = green_path(&fog, 0.0, view, length)[1];
        errors[usize::from(g > 0.8)].push(path / scattered - 1.0);
    }
    errors
}

/// Relative errors for the phase function of droplets, whose peak is much narrower than that of Henyey-Greenstein.
fn droplets_of_ten() -> Vec<f64> {
    let rows = numbers::<7>(include_str!("../data/fog_droplets_disort.csv"));
    let error = |row: [f64; 7]| {
        let [
            tau,
            sun_zenith,
            above,
            zenith,
            azimuth,
            scattered,
            irradiance,
        ] = row;
        let fog = Scene {
            profile: SLAB,
            depth: tau,
            single_scattering_albedo: 0.999999,
            phase: droplets::phase(10.0),
            sun_zenith_deg: Some(sun_zenith),
            ground_albedo: 0.2,
        }
        .fog(FogScattering::Multiple);
        let ground = f64::from(fog.ground_irradiance().unwrap()[0]);
        assert!(
            (ground / irradiance - 1.0).abs() < 2e-3,
            "{row:?}: {ground}"
        );
        to_the_edge(&fog, above, direction(azimuth, 90.0 - zenith)) / scattered - 1.0
    };
    rows.map(error).collect()
}

/// Mitsuba and PythonicDISORT on the same four scenes.
#[test]
fn multiple_scattering_matches_path_tracing() {
    for row in rows(include_str!("../data/mitsuba_fog_checks.csv")) {
        let got = from_ground(&row, FogScattering::Multiple);
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let (mitsuba, error) = (number(11), number(12));
        println!(
            "{}: {:+.2} % of {mitsuba}",
            row[0],
            100.0 * (got / mitsuba - 1.0)
        );
        assert!(
            (got - mitsuba).abs() < 3.0 * error + 0.01 * mitsuba,
            "{row:?}: {got}"
        );
    }
    for row in rows(include_str!("../data/disort_vs_mitsuba.csv")) {
        let got = from_ground(&row, FogScattering::Multiple);
        let disort: f64 = row[7].parse().unwrap();
        assert!((got / disort - 1.0).abs() < 0.01, "{row:?}: {got}");
    }
}
