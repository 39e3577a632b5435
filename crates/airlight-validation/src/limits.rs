//! Skies where solvers fail: around the sun and at the horizon in coarse aerosol, polarised light, optically thick air.
//!
//! The tables are those of tests of the crate `airlight`, which recompute the ones by path tracing.

use crate::check::{Check, Row, Suite, Unit};
use crate::skies::truth_air;
use crate::solved::Solved;
use crate::table::{Line, Table};
use airlight::atmosphere::{self, Atmosphere, Constituent, ConstituentKind, DensityProfile};
use airlight::optics::PhaseFunction;
use airlight::sky::SkySettings;
use airlight::spectrum::SpectralCurve;
use airlight::{Cancelled, Control};

const AUREOLE: &str = include_str!("../data/sky_aureole_monte_carlo.csv");
const HORIZON: &str = include_str!("../data/sky_horizon_monte_carlo.csv");
const POLARISED: &str = include_str!("../data/sky_polarised_monte_carlo.csv");
const SLABS: &str = include_str!("../data/sky_slabs_disort.csv");

/// Height of the slabs, m.
const SLAB_M: f64 = 1000.0;

/// All checks of the suite.
///
/// # Errors
/// [`Cancelled`].
pub fn checks(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    Ok([
        around_the_sun(control)?,
        at_the_horizon(control)?,
        polarised(control)?,
        thick(control)?,
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

fn scalar() -> SkySettings {
    SkySettings {
        polarisation_correction: false,
        ..SkySettings::default()
    }
}

/// Views from 1 to 10 degrees beside the sun.
fn around_the_sun(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let columns = ["air", "aod_550", "sun"];
    in_particles(AUREOLE, &columns, control, |group, of| {
        let sun = group.number("sun");
        let limit = if sun < 5.0 { 3.5 } else { 1.5 };
        (format!("around a sun at {sun} degrees, {of}"), limit)
    })
}

/// Views from 0.3 to 8 degrees above the horizon, and from 1 km on both sides of it.
fn at_the_horizon(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let columns = ["air", "aod_550", "sun", "altitude_m"];
    in_particles(HORIZON, &columns, control, |group, of| {
        let [sun, altitude_m] = ["sun", "altitude_m"].map(|name| group.number(name));
        (
            format!("at the horizon from {altitude_m} m, sun at {sun} degrees, {of}"),
            1.5,
        )
    })
}

/// Views in air with particles, whose name and limit follow from the first line of a group and the name of the air.
fn in_particles(
    text: &'static str,
    columns: &[&str],
    control: Control<'_>,
    claim: impl Fn(&Line<'_>, &str) -> (String, f64),
) -> Result<Vec<Check>, Cancelled> {
    const WAVELENGTHS_NM: [f64; 3] = [440.0, 550.0, 680.0];
    let table = Table::new(text);
    let groups = groups(&table, columns);
    let check = |group: &Vec<Line<'_>>| {
        let (name, depth) = (group[0].text("air"), group[0].text("aod_550"));
        let altitude_m = match group[0].has("altitude_m") {
            true => group[0].number("altitude_m"),
            false => 0.0,
        };
        let air = match depth {
            "" => atmosphere::preset(name).expect("a preset"),
            _ => {
                let text = format!("aerosol.type = \"{name}\"\naerosol.aod_550 = {depth}");
                Atmosphere::from_toml(&text).expect("an aerosol")
            }
        };
        let zenith_deg = 90.0 - group[0].number("sun");
        let solved = Solved::of_table(&air, &WAVELENGTHS_NM, zenith_deg, &scalar(), control)?
            .with_mean_sunlight()
            .seen_from(altitude_m);
        let of = match depth {
            "" => name.to_owned(),
            _ => format!("{name} aerosol of optical depth {depth}"),
        };
        let (what, limit) = claim(&group[0], &of);
        let mut check = check(what, "Airlight's Monte Carlo", limit);
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

/// Radiance of polarised light.
fn polarised(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    const WAVELENGTHS_NM: [f64; 4] = [360.0, 450.0, 550.0, 650.0];
    let table = Table::new(POLARISED);
    let groups = groups(&table, &["air", "sun_elevation_deg"]);
    let check = |group: &Vec<Line<'_>>| {
        let (name, sun) = (group[0].text("air"), group[0].number("sun_elevation_deg"));
        let air = truth_air(name).expect("a known atmosphere");
        let settings = SkySettings::default();
        let solved = Solved::of_table(&air, &WAVELENGTHS_NM, 90.0 - sun, &settings, control)?
            .with_mean_sunlight();
        let limit = if sun < 0.0 { 3.0 } else { 1.0 };
        let what = format!("polarised light, {name}, sun at {sun} degrees");
        let mut check = check(what, "Airlight's Monte Carlo, polarised", limit);
        for line in group {
            let view = (
                90.0 - line.number("elevation_deg"),
                line.number("azimuth_deg"),
            );
            let nm = line.number("wavelength_nm");
            let lane = WAVELENGTHS_NM.iter().position(|known| *known == nm);
            let lane = lane.expect("a known wavelength");
            check.rows.push(Row {
                at: solved.at(view.0, view.1, lane),
                ours: solved.look(view.0, view.1).all[lane],
                reference: line.number("i"),
                standard_error: line.number("i_error"),
            });
        }
        Ok(check)
    };
    groups.iter().map(check).collect()
}

/// Uniform slabs seen from the ground.
fn thick(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let table = Table::new(SLABS);
    let mut checks: Vec<Check> = Vec::new();
    for group in groups(&table, &["sun_zenith", "omega", "g", "tau", "albedo"]) {
        let [sun, depth] = ["sun_zenith", "tau"].map(|name| group[0].number(name));
        let air = slab(&group[0]);
        let solved = Solved::of_table(&air, &[550.0], sun, &scalar(), control)?;
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

/// The slab of a line of its table, on a planet as large as the Earth.
fn slab(line: &Line<'_>) -> Atmosphere {
    let mut air = Atmosphere::from_toml("base = \"none\"").expect("no air");
    air.planet.top_altitude_m = SLAB_M;
    air.planet.ground_albedo = SpectralCurve::Constant(line.number("albedo"));
    air.solar_irradiance = SpectralCurve::Constant(1.0);
    let (depth, albedo) = (line.number("tau"), line.number("omega"));
    air.constituents = vec![Constituent {
        kind: ConstituentKind::Fog,
        density: DensityProfile::slab(2.0 * SLAB_M),
        scattering_per_m: SpectralCurve::Constant(depth / SLAB_M * albedo),
        absorption_per_m: SpectralCurve::Constant(depth / SLAB_M * (1.0 - albedo)),
        phase: PhaseFunction::HenyeyGreenstein {
            g: line.number("g"),
        },
    }];
    air
}
