//! Skies where solvers fail: around the sun and at the horizon in coarse aerosol, polarised light, optically thick air; and laws that
//! light obeys, the conservation of energy and reciprocity.
//!
//! The tables are those of tests of the crate `airlight`, which recompute the ones by path tracing.

use crate::check::{At, Check, Row, Suite, Unit};
use crate::skies::{scalar, truth_air};
use crate::solved::Solved;
use crate::table::{Line, Table};
use airlight::atmosphere::{self, Atmosphere, Constituent, ConstituentKind, DensityProfile};
use airlight::optics::PhaseFunction;
use airlight::sky::SkySettings;
use airlight::spectrum::SpectralCurve;
use airlight::{Cancelled, Control};

const AUREOLE: &str = include_str!("../data/sky_aureole_monte_carlo.csv");
const HORIZON: &str = include_str!("../data/sky_horizon_monte_carlo.csv");
const HAZE: &str = include_str!("../data/sky_haze_monte_carlo.csv");
const SMOKE: &str = include_str!("../data/sky_smoke_monte_carlo.csv");
const POLARISED: &str = include_str!("../data/sky_polarised_monte_carlo.csv");
const SLABS: &str = include_str!("../data/sky_slabs_disort.csv");

/// Height of the slabs, m.
const SLAB_M: f64 = 1000.0;

/// All checks of the suite, with these settings.
///
/// # Errors
/// [`Cancelled`].
pub fn checks(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let scalar = &scalar(settings);
    Ok([
        around_the_sun(scalar, control)?,
        at_the_horizon(scalar, control)?,
        polarised(settings, control)?,
        thick(scalar, control)?,
        thick_haze(scalar, control)?,
        smoke(scalar, control)?,
        energy(scalar, control)?,
        reciprocity(scalar, control)?,
    ]
    .concat())
}

/// A check against a table, without rows.
fn check(what: String, against: &str, limit: f64) -> Check {
    Check {
        suite: Suite::Limits,
        what,
        against: against.into(),
        unit: Unit::Percent,
        limit: Some(limit),
        limit_of_rms: None,
        rows: Vec::new(),
    }
}

/// Lines of a table in groups with the same texts in these columns.
fn groups<'a>(table: &'a Table, columns: &[&str]) -> Vec<Vec<Line<'a>>> {
    let key = |line: &Line<'_>| {
        columns
            .iter()
            .map(|name| line.text(name))
            .collect::<Vec<_>>()
    };
    let mut groups: Vec<Vec<Line<'a>>> = Vec::new();
    for line in table.lines() {
        match groups.iter_mut().find(|group| key(&group[0]) == key(&line)) {
            Some(group) => group.push(line),
            None => groups.push(vec![line]),
        }
    }
    groups
}

/// Air in which views are compared with path tracing, and the claim about them.
struct Case {
    air: Atmosphere,
    altitude_m: f64,
    what: String,
    limit: f64,
}

/// Views from 1 to 10 degrees beside the sun.
fn around_the_sun(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let columns = ["air", "aod_550", "sun"];
    against_paths(AUREOLE, &columns, (settings, control), |line| {
        let (air, of) = particles(line);
        let sun = line.number("sun");
        Case {
            air,
            altitude_m: 0.0,
            what: format!("around a sun at {sun} degrees, {of}"),
            limit: if sun < 5.0 { 3.5 } else { 1.5 },
        }
    })
}

/// Views from 0.3 to 8 degrees above the horizon, and from 1 km on both sides of it.
fn at_the_horizon(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let columns = ["air", "aod_550", "sun", "altitude_m"];
    against_paths(HORIZON, &columns, (settings, control), |line| {
        let (air, of) = particles(line);
        let [sun, altitude_m] = ["sun", "altitude_m"].map(|name| line.number(name));
        Case {
            air,
            altitude_m,
            what: format!("at the horizon from {altitude_m} m, sun at {sun} degrees, {of}"),
            limit: 1.5,
        }
    })
}

/// Height of the eye under thick haze and smoke, m.
const EYE_M: f64 = 2.0;

/// The default haze with optical depths of 5 to 30.
fn thick_haze(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    against_paths(HAZE, &["depth", "sun"], (settings, control), |line| {
        let (depth, sun) = (line.text("depth"), line.text("sun"));
        let text = format!("aerosol.aod_550 = {depth}");
        Case {
            air: Atmosphere::from_toml(&text).expect("a haze"),
            altitude_m: EYE_M,
            what: format!("haze of optical depth {depth}, sun at {sun} degrees"),
            limit: 2.0,
        }
    })
}

/// The smoke of forest fires.
fn smoke(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    against_paths(SMOKE, &["sun"], (settings, control), |line| Case {
        air: atmosphere::preset("wildfire").expect("a preset"),
        altitude_m: EYE_M,
        what: format!("smoke of forest fires, sun at {} degrees", line.text("sun")),
        limit: 1.0,
    })
}

/// Air with the particles of a line, and what it is called.
fn particles(line: &Line<'_>) -> (Atmosphere, String) {
    match (line.text("air"), line.text("aod_550")) {
        (name, "") => (atmosphere::preset(name).expect("a preset"), name.to_owned()),
        (name, depth) => {
            let text = format!("aerosol.type = \"{name}\"\naerosol.aod_550 = {depth}");
            (
                Atmosphere::from_toml(&text).expect("an aerosol"),
                format!("{name} aerosol of optical depth {depth}"),
            )
        }
    }
}

/// Views of scalar light by path tracing, in the cases of groups of lines.
fn against_paths(
    text: &'static str,
    columns: &[&str],
    (settings, control): (&SkySettings, Control<'_>),
    case: impl Fn(&Line<'_>) -> Case,
) -> Result<Vec<Check>, Cancelled> {
    const WAVELENGTHS_NM: [f64; 3] = [440.0, 550.0, 680.0];
    let table = Table::new(text);
    let groups = groups(&table, columns);
    let check = |group: &Vec<Line<'_>>| {
        let case = case(&group[0]);
        let zenith_deg = 90.0 - group[0].number("sun");
        let solved = Solved::of_table(&case.air, &WAVELENGTHS_NM, zenith_deg, settings, control)?
            .with_mean_sunlight()
            .seen_from(case.altitude_m);
        let mut check = check(case.what, "Airlight's Monte Carlo", case.limit);
        for line in group {
            let view = (90.0 - line.number("elevation"), line.number("azimuth"));
            let light = solved.look(view.0, view.1);
            for (lane, nm) in WAVELENGTHS_NM.iter().enumerate() {
                check.rows.push(Row {
                    at: solved.at(view.0, view.1, lane),
                    ours: light.all[lane],
                    reference: line.number(&format!("l{nm}")),
                    standard_error: line.number(&format!("se{nm}")),
                });
            }
        }
        Ok(check)
    };
    groups.iter().map(check).collect()
}

/// Radiance of polarised light, and its Q and U.
fn polarised(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    const WAVELENGTHS_NM: [f64; 4] = [360.0, 450.0, 550.0, 650.0];
    const AGAINST: &str = "Airlight's Monte Carlo, polarised";
    let table = Table::new(POLARISED);
    let mut checks = Vec::new();
    for group in groups(&table, &["air", "sun_elevation_deg"]) {
        let (name, sun) = (group[0].text("air"), group[0].number("sun_elevation_deg"));
        let air = truth_air(name).expect("a known atmosphere");
        let solved = Solved::of_table(&air, &WAVELENGTHS_NM, 90.0 - sun, settings, control)?
            .with_mean_sunlight();
        let limit = if sun < 0.0 { 3.0 } else { 1.0 };
        let of = format!("{name}, sun at {sun} degrees");
        let mut radiance = check(format!("polarised light, {of}"), AGAINST, limit);
        let mut linear = Check {
            unit: Unit::Points,
            limit: None,
            limit_of_rms: Some(if name == "clear" { 0.5 } else { 4.5 }),
            ..check(format!("Q and U as parts of I, {of}"), AGAINST, 0.0)
        };
        for line in group {
            let view = (
                90.0 - line.number("elevation_deg"),
                line.number("azimuth_deg"),
            );
            let nm = line.number("wavelength_nm");
            let lane = WAVELENGTHS_NM.iter().position(|known| *known == nm);
            let lane = lane.expect("a known wavelength");
            let (at, intensity) = (solved.at(view.0, view.1, lane), line.number("i"));
            let light = solved.look(view.0, view.1);
            radiance.rows.push(Row {
                at,
                ours: light.all[lane],
                reference: intensity,
                standard_error: line.number("i_error"),
            });
            for (ours, name) in solved.linear(view.0, view.1).iter().zip(["q", "u"]) {
                linear.rows.push(Row {
                    at,
                    ours: ours[lane] / intensity,
                    reference: line.number(name) / intensity,
                    standard_error: line.number(&format!("{name}_error")) / intensity,
                });
            }
        }
        checks.extend([radiance, linear]);
    }
    Ok(checks)
}

/// Uniform slabs seen from the ground.
fn thick(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let table = Table::new(SLABS);
    let mut checks: Vec<Check> = Vec::new();
    for group in groups(&table, &["sun_zenith", "omega", "g", "tau", "albedo"]) {
        let [sun, depth] = ["sun_zenith", "tau"].map(|name| group[0].number(name));
        let of = |name| group[0].number(name);
        let air = slab(of("tau"), of("omega"), of("g"), of("albedo"));
        let solved = Solved::of_table(&air, &[550.0], sun, settings, control)?;
        let limit = match depth {
            ..=5.0 => 1.0,
            ..=100.0 => 1.5,
            _ => 3.0,
        };
        let what = format!("slab of optical depth {depth}, sun zenith {sun}");
        let index = checks
            .iter()
            .position(|check| check.what == what)
            .unwrap_or_else(|| {
                checks.push(check(what, "PythonicDISORT, 48 streams", limit));
                checks.len() - 1
            });
        let seen = group.iter().filter(|line| line.number("above") == 1.0);
        // The iteration does not look for light below 1e-9 of the sun's.
        for line in seen.filter(|line| line.number("scattered") > 1e-9) {
            let view = (line.number("zenith"), line.number("azimuth"));
            checks[index].rows.push(Row {
                at: solved.at(view.0, view.1, 0),
                ours: solved.look(view.0, view.1).path[0],
                reference: line.number("scattered"),
                standard_error: 0.0,
            });
        }
    }
    Ok(checks)
}

/// Light that leaves slabs without absorption and is absorbed by the ground, relative to the sunlight that arrives.
fn energy(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    const SUN_ZENITH_DEG: f64 = 30.0;
    let of_ground = |ground_albedo: f64| {
        let what = format!("energy in slabs without absorption, ground albedo {ground_albedo}");
        let mut check = check(what, "the conservation of energy", 0.3);
        for depth in [0.1, 1.0, 5.0, 20.0, 100.0] {
            for asymmetry in [0.0, 0.7] {
                let air = slab(depth, 1.0, asymmetry, ground_albedo);
                let solved = Solved::of_table(&air, &[550.0], SUN_ZENITH_DEG, settings, control)?;
                let arriving = solved.solar()[0] * SUN_ZENITH_DEG.to_radians().cos();
                let received = solved.ground_irradiance()[0];
                let sent_up = solved.seen_from(SLAB_M).upwelling_irradiance()[0];
                check.rows.push(Row {
                    at: At {
                        sun_zenith_deg: SUN_ZENITH_DEG,
                        wavelength_nm: Some(550.0),
                        ..At::default()
                    },
                    ours: sent_up + (1.0 - ground_albedo) * received,
                    reference: arriving,
                    standard_error: 0.0,
                });
            }
        }
        Ok(check)
    };
    [0.0, 0.5, 1.0].into_iter().map(of_ground).collect()
}

/// Light sent up by plane-parallel air relative to the irradiance of the horizontal, with the directions to the sun and to the eye
/// exchanged.
fn reciprocity(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    const WAVELENGTHS_NM: [f64; 3] = [440.0, 550.0, 680.0];
    /// Zenith angles of the sun and of the direction to the eye, and the azimuth between them.
    const PAIRS: [[f64; 3]; 3] = [[10.0, 60.0, 40.0], [30.0, 75.0, 130.0], [55.0, 80.0, 10.0]];
    let of_air = |(name, mut air): (&str, Atmosphere)| {
        let mut check = check(
            format!("light sent up by {name}, sun and eye exchanged"),
            "reciprocity",
            0.6,
        );
        // So large that the air is plane-parallel.
        air.planet.radius_m *= 1e3;
        let top_m = air.planet.top_altitude_m;
        for [sun, eye, azimuth] in PAIRS {
            let sent = |sun: f64, eye: f64| {
                let solved = Solved::of_table(&air, &WAVELENGTHS_NM, sun, settings, control)?;
                let solved = solved.seen_from(top_m);
                // The view is opposite to the direction to the eye.
                let view = (180.0 - eye, azimuth + 180.0);
                let light = solved.look(view.0, view.1).all;
                let ats = [0, 1, 2].map(|lane| solved.at(view.0, view.1, lane));
                let level = sun.to_radians().cos();
                Ok((ats, light.into_iter().map(move |light| light / level)))
            };
            let ((ats, there), (_, back)) = (sent(sun, eye)?, sent(eye, sun)?);
            let lanes = ats.into_iter().zip(there.zip(back));
            check.rows.extend(lanes.map(|(at, (there, back))| Row {
                at,
                ours: there,
                reference: back,
                standard_error: 0.0,
            }));
        }
        Ok(check)
    };
    let preset = |name| (name, atmosphere::preset(name).expect("a preset"));
    let airs = [
        preset("hazy"),
        preset("wildfire"),
        ("a slab of optical depth 20", slab(20.0, 0.99, 0.7, 0.3)),
    ];
    airs.into_iter().map(of_air).collect()
}

/// A uniform slab with an optical depth, a single-scattering albedo, an asymmetry and a ground albedo, on a planet as large as the Earth.
fn slab(depth: f64, albedo: f64, g: f64, ground_albedo: f64) -> Atmosphere {
    let mut air = Atmosphere::from_toml("base = \"none\"").expect("no air");
    air.planet.top_altitude_m = SLAB_M;
    air.planet.ground_albedo = SpectralCurve::Constant(ground_albedo);
    air.solar_irradiance = SpectralCurve::Constant(1.0);
    air.constituents = vec![Constituent {
        kind: ConstituentKind::Fog,
        density: DensityProfile::slab(2.0 * SLAB_M),
        scattering_per_m: SpectralCurve::Constant(depth / SLAB_M * albedo),
        absorption_per_m: SpectralCurve::Constant(depth / SLAB_M * (1.0 - albedo)),
        phase: PhaseFunction::HenyeyGreenstein { g },
    }];
    air
}
