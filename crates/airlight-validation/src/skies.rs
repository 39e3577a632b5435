//! Skies compared with tables of other solvers.

use crate::check::{Check, Row, Suite, Unit};
use crate::solved::Solved;
use crate::table::{Line, Table};
use airlight::atmosphere::AerosolType;
use airlight::atmosphere::{
    self, AerosolLoad, AerosolMixture, Atmosphere, ConstituentKind, reference,
};
use airlight::sky::SkySettings;
use airlight::{Cancelled, Control};

/// A table of skies computed by one solver.
struct Source {
    suite: Suite,
    text: &'static str,
    against: &'static str,
    /// Error of the source itself, added to the claim, percent.
    own_error: f64,
    /// Zenith angle of the sun up to which the first of `claims` applies, degrees; the second applies beyond.
    low_sun_deg: f64,
    /// Claimed bounds on the error in any direction, all orders, percent.
    claims: [f64; 2],
}

const MONTE_CARLO: [Source; 3] = [
    monte_carlo(include_str!("../data/mc_sphere_rayleigh.csv")),
    monte_carlo(include_str!("../data/mc_sphere_earth_demo.csv")),
    monte_carlo(include_str!("../data/mc_sphere_csm.csv")),
];

const fn monte_carlo(text: &'static str) -> Source {
    Source {
        suite: Suite::Tables,
        text,
        against: "Monte Carlo on the sphere",
        own_error: 0.0,
        low_sun_deg: 80.0,
        claims: [1.0, 2.0],
    }
}

/// Airlight's Monte Carlo, which other tests compare with other codes; computed by the example `sky_truth`.
const TRUTH: [Source; 3] = [
    truth(include_str!("../data/mc_airlight_clear.csv"), [1.0, 3.0]),
    truth(include_str!("../data/mc_airlight_hazy.csv"), [1.5, 3.0]),
    truth(include_str!("../data/mc_airlight_desert.csv"), [2.0, 4.0]),
];

const fn truth(text: &'static str, claims: [f64; 2]) -> Source {
    Source {
        suite: Suite::MonteCarlo,
        text,
        against: "Airlight's Monte Carlo",
        own_error: 0.0,
        low_sun_deg: 88.0,
        claims,
    }
}

/// SASKTRAN2, which agrees with the Monte Carlo to 0.3 % (95th percentile; csm 1.1 %).
const SASKTRAN: [Source; 3] = [
    sasktran(include_str!("../data/sasktran2_rayleigh_sphere.csv"), 0.3),
    sasktran(include_str!("../data/sasktran2_earth_demo.csv"), 0.3),
    sasktran(include_str!("../data/sasktran2_csm.csv"), 1.1),
];

const fn sasktran(text: &'static str, own_error: f64) -> Source {
    Source {
        suite: Suite::Tables,
        text,
        against: "SASKTRAN2",
        own_error,
        low_sun_deg: 80.0,
        claims: [1.0, 2.0],
    }
}

/// libRadtran, plane-parallel: compared only for sun and view within 75 degrees of the zenith.
const LIBRADTRAN: &str = include_str!("../data/libradtran_fixed.csv");
const PEERS: &str = include_str!("../data/csm_sky_radiance_10wl.csv");

/// The atmosphere and the kind of light of a row.
struct Case {
    atmosphere: &'static str,
    single: bool,
    sun_zenith_deg: f64,
}

impl Case {
    fn of(line: Line<'_>, source: &Source) -> Self {
        let config = match line.has("ground_albedo") {
            // One table identifies its atmospheres by the ground albedo.
            true => line.text("ground_albedo"),
            false => line.text("config"),
        };
        Self {
            atmosphere: match config {
                "0" | "0.0" => "a0.0",
                "0.3" => "a0.3",
                other => other,
            },
            single: source.against == "SASKTRAN2" && line.text("mode") == "single",
            sun_zenith_deg: line.number("sun_zenith_deg"),
        }
    }

    fn is(&self, other: &Self) -> bool {
        self.atmosphere == other.atmosphere
            && self.single == other.single
            && self.sun_zenith_deg == other.sun_zenith_deg
    }

    /// Claimed bound on the error: 0.2 % for single scattering; for all orders the claim plus the error of the source.
    fn limit(&self, source: &Source) -> f64 {
        let [high, low] = source.claims;
        match (self.single, self.sun_zenith_deg <= source.low_sun_deg) {
            (true, _) => 0.2,
            (false, true) => high + source.own_error,
            (false, false) => low + source.own_error,
        }
    }
}

/// An atmosphere of the tables, and the three wavelengths of its channels, nm.
pub fn atmosphere(name: &str) -> (Atmosphere, [f64; 3]) {
    match name {
        "a0.0" => (reference::rayleigh(0.0), [440.0, 550.0, 680.0]),
        "a0.3" => (reference::rayleigh(0.3), [440.0, 550.0, 680.0]),
        "earth_demo" => (reference::earth_demo(), [440.0, 550.0, 680.0]),
        "csm" => (reference::csm(), [442.25, 548.0, 677.25]),
        other => match truth_air(other) {
            Some(air) => (air, [440.0, 550.0, 680.0]),
            None => panic!("expected a known atmosphere in an embedded table, got '{other}'"),
        },
    }
}

/// Atmospheres of the tables of Airlight's Monte Carlo: presets; `desert`, which is `average` with desert dust after OPAC with an
/// optical depth of 0.3 at 550 nm instead of its haze; and `continental`, which is `hazy` with continental particles after OPAC of
/// the same optical depth (0.35) and profile instead of its haze.
pub fn truth_air(name: &str) -> Option<Atmosphere> {
    let (base, kind, depth) = match name {
        "desert" => ("average", AerosolType::Desert, 0.3),
        "continental" => ("hazy", AerosolType::ContinentalAverage, 0.35),
        _ => return atmosphere::preset(name).ok(),
    };
    let mut air = atmosphere::preset(base).ok()?;
    let haze = air.constituent(&ConstituentKind::Aerosol)?;
    let density = (name == "continental").then(|| haze.density.clone());
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let load = Some(AerosolLoad::OpticalDepth550(depth));
    let particles = AerosolMixture::of(kind, AerosolMixture::USUAL_HUMIDITY)
        .ok()?
        .constituent(load, density, air.clear_air(), ground, top)
        .ok()?;
    air.constituents
        .retain(|part| part.kind != ConstituentKind::Aerosol);
    air.constituents.push(particles);
    Some(air)
}

/// Index of the wavelength of a channel in [`atmosphere()`].
pub fn lane(channel: &str) -> usize {
    match channel.trim_start_matches("L_").trim_start_matches("beta") {
        "33.1e-6" | "440" | "442.25" => 0,
        "13.5e-6" | "550" | "548" => 1,
        "5.8e-6" | "680" | "677.25" => 2,
        other => panic!("expected a known channel in an embedded table, got '{other}'"),
    }
}

fn light_of(single: bool) -> &'static str {
    match single {
        true => "single scattering",
        false => "all orders",
    }
}

/// All checks of the suite of tables.
///
/// # Errors
/// [`Cancelled`].
pub fn checks(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let mut all = against_monte_carlo(&SkySettings::default(), control)?;
    all.extend(against_all(&SASKTRAN, &SkySettings::default(), control)?);
    all.push(against_libradtran(control)?);
    Ok(all)
}

/// Checks by day and in twilight against Airlight's Monte Carlo.
///
/// # Errors
/// [`Cancelled`].
pub fn against_truth(
    settings: &SkySettings,
    control: Control<'_>,
) -> Result<Vec<Check>, Cancelled> {
    against_all(&TRUTH, settings, control)
}

/// Checks of all orders against another Monte Carlo, with these settings.
///
/// # Errors
/// [`Cancelled`].
pub fn against_monte_carlo(
    settings: &SkySettings,
    control: Control<'_>,
) -> Result<Vec<Check>, Cancelled> {
    against_all(&MONTE_CARLO, settings, control)
}

/// The checks of several tables.
fn against_all(
    sources: &[Source],
    settings: &SkySettings,
    control: Control<'_>,
) -> Result<Vec<Check>, Cancelled> {
    let mut all = Vec::new();
    for source in sources {
        all.extend(against(source, settings, control)?);
    }
    Ok(all)
}

/// These settings without polarisation, which the tables do without.
pub(crate) fn scalar(settings: &SkySettings) -> SkySettings {
    SkySettings {
        polarisation_correction: false,
        ..settings.clone()
    }
}

/// One check for each atmosphere, sun and kind of light of a table.
fn against(
    source: &Source,
    settings: &SkySettings,
    control: Control<'_>,
) -> Result<Vec<Check>, Cancelled> {
    let table = Table::new(source.text);
    let mut checks: Vec<(Case, Solved, Check)> = Vec::new();
    for line in table.lines() {
        control.check()?;
        let case = Case::of(line, source);
        let found = checks.iter().position(|(other, ..)| other.is(&case));
        if found.is_none() {
            let (air, wavelengths) = atmosphere(case.atmosphere);
            let sun = case.sun_zenith_deg;
            let solved = Solved::of_table(&air, &wavelengths, sun, &scalar(settings), control)?;
            let light = if case.single {
                "single scattering"
            } else {
                "all orders"
            };
            let check = Check {
                suite: source.suite,
                what: format!(
                    "{light}, {}, sun zenith {}",
                    case.atmosphere, case.sun_zenith_deg
                ),
                against: source.against.into(),
                unit: Unit::Percent,
                limit: Some(case.limit(source)),
                limit_of_rms: None,
                rows: Vec::new(),
            };
            checks.push((case, solved, check));
        }
        let index = found.unwrap_or(checks.len() - 1);
        let (case, solved, check) = &mut checks[index];
        add_rows(&mut check.rows, &table, line, solved, case.single);
    }
    Ok(checks.into_iter().map(|(.., check)| check).collect())
}

/// Adds the values of a line: one with its standard error, or one per wavelength.
fn add_rows(rows: &mut Vec<Row>, table: &Table, line: Line<'_>, solved: &Solved, single: bool) {
    let (view, azimuth) = (
        line.number("view_zenith_deg"),
        line.number("rel_azimuth_deg"),
    );
    let light = solved.look(view, azimuth);
    let ours = if single { &light.single } else { &light.all };
    let mut add = |lane: usize, reference, standard_error| {
        rows.push(Row {
            at: solved.at(view, azimuth, lane),
            ours: ours[lane],
            reference,
            standard_error,
        })
    };
    if line.has("SE") {
        add(
            lane(line.text("channel")),
            line.number("L"),
            line.number("SE"),
        );
    } else {
        for (column, name) in table.columns_from("L_") {
            add(lane(name), line.at(column), 0.0);
        }
    }
}

fn against_libradtran(control: Control<'_>) -> Result<Check, Cancelled> {
    const FLAT_EARTH_DEG: f64 = 75.0;
    let is_high = |line: &Line<'_>| {
        line.number("sun_zenith_deg") <= FLAT_EARTH_DEG
            && line.number("view_zenith_deg") <= FLAT_EARTH_DEG
    };
    Ok(Check {
        suite: Suite::Tables,
        what: "all orders, csm, sun and view within 75 degrees of the zenith".into(),
        against: "libRadtran 2.0.2, flat".into(),
        unit: Unit::Percent,
        limit: None,
        limit_of_rms: None,
        rows: csm_rows(LIBRADTRAN, false, is_high, control)?,
    })
}

/// Other models of the comparison of clear-sky models, with the same atmosphere.
///
/// # Errors
/// [`Cancelled`].
pub fn peers(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let table = Table::new(PEERS);
    let mut models: Vec<&str> = table.lines().map(|line| line.text("model")).collect();
    models.dedup();
    let check = |model: &&str| {
        // Bruneton's model with single scattering only.
        let single = model.ends_with("_ss");
        let is_of_model = |line: &Line<'_>| line.text("model") == *model;
        Ok(Check {
            suite: Suite::Peers,
            what: format!("{}, csm", light_of(single)),
            against: format!("{model}, as in clear-sky-models"),
            unit: Unit::Percent,
            limit: None,
            limit_of_rms: None,
            rows: csm_rows(PEERS, single, is_of_model, control)?,
        })
    };
    models.iter().map(check).collect()
}

/// Rows of a table of the atmosphere `csm` by wavelength.
///
/// # Errors
/// [`Cancelled`].
fn csm_rows(
    text: &'static str,
    single: bool,
    wanted: impl Fn(&Line<'_>) -> bool,
    control: Control<'_>,
) -> Result<Vec<Row>, Cancelled> {
    let table = Table::new(text);
    let columns = table.radiance_columns();
    let wavelengths: Vec<f64> = columns.iter().map(|(_, nm)| *nm).collect();
    let air = reference::csm();
    let mut solved: Vec<Solved> = Vec::new();
    let mut rows = Vec::new();
    for line in table.lines().filter(wanted) {
        control.check()?;
        let sun = line.number("sun_zenith_deg");
        let found = solved.iter().position(|s| s.sun_zenith_deg() == sun);
        if found.is_none() {
            let settings = scalar(&SkySettings::default());
            solved.push(Solved::of_table(
                &air,
                &wavelengths,
                sun,
                &settings,
                control,
            )?);
        }
        let index = found.unwrap_or(solved.len() - 1);
        let (view, azimuth) = (
            line.number("view_zenith_deg"),
            line.number("rel_azimuth_deg"),
        );
        let light = solved[index].look(view, azimuth);
        rows.extend(columns.iter().enumerate().map(|(lane, (column, _))| Row {
            at: solved[index].at(view, azimuth, lane),
            ours: if single {
                light.single[lane]
            } else {
                light.all[lane]
            },
            reference: line.at(*column),
            standard_error: 0.0,
        }));
    }
    Ok(rows)
}
