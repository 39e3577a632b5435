//! Skies of random airs, suns, eyes and views compared with Airlight's Monte Carlo.
//!
//! Every case follows from its number: an atmosphere in the format of atmosphere files, a sun, an eye and directions.

use crate::check::{At, Check, Row, Suite, Unit};
use crate::skies::scalar;
use crate::table::Table;
use airlight::atmosphere::{AerosolType, Atmosphere, ConstituentKind};
use airlight::axes::direction;
use airlight::sky::{Sky, SkyError, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use airlight::{Cancelled, Control, Named, SplitMix64};
use std::ops::Range;

/// Radiances of some of the cases by path tracing: the example `random_airs`.
const TRUTH: &str = include_str!("../data/random_airs_monte_carlo.csv");

/// Wavelengths of the comparison, nm.
pub const WAVELENGTHS_NM: [f64; 4] = [400.0, 470.0, 550.0, 680.0];

/// Claimed bounds on the error of each value, beyond three standard errors, and on the root-mean-square error with the noise of the
/// table, percent.
const LIMIT: f64 = 1.0;
const LIMIT_OF_RMS: f64 = 0.4;

/// Numbers of the cases with an aerosol of a published type, and of those with layers of several kinds of particles.
pub const AEROSOLS: Range<u64> = 0..85;
/// See [`AEROSOLS`].
pub const LAYERS: Range<u64> = 85..115;

/// A random air under a random sun.
#[derive(Clone, Debug)]
pub struct RandomSky {
    /// The air, as an atmosphere file.
    pub air: String,
    /// Elevation of the sun, degrees: half of the suns are between 6 degrees below the horizon and 10 above it.
    pub sun_elevation_deg: f64,
    /// Altitude of the eye, m: half of the eyes are 2 m above the ground, the others up to 15 km.
    pub altitude_m: f64,
    /// Elevation of the view, degrees: dense at the horizon, above it, and for one in three of the higher eyes below it.
    pub elevation_deg: f64,
    /// Azimuth of the view from that of the sun, degrees.
    pub azimuth_deg: f64,
}

impl RandomSky {
    /// The case of a number.
    pub fn new(number: u64) -> Self {
        let mut draw = SplitMix64::scrambled(number);
        let sun_elevation_deg = match draw.chance(0.5) {
            true => draw.between(-6.0, 10.0),
            false => draw.between(10.0, 90.0),
        };
        let altitude_m = match draw.chance(0.5) {
            true => 2.0,
            false => draw.between(0.0, 15e3),
        };
        let dip = (6371e3 / (6371e3 + altitude_m)).acos().to_degrees();
        let looks_down = altitude_m > 100.0 && draw.chance(1.0 / 3.0);
        let from_horizon = draw.between(0.05, 1.0).powi(2);
        let elevation_deg = match looks_down {
            true => -dip - (90.0 - dip) * from_horizon,
            false => (90.0 + dip) * from_horizon - dip,
        };
        let azimuth_deg = draw.between(0.0, 180.0);
        let albedo = draw.between(0.0, 0.95).powi(2);
        let air = match LAYERS.contains(&number) {
            true => layers(&mut draw),
            false => {
                let kind = draw.pick(AerosolType::ALL);
                let depth = draw.between(0.0, 1.0);
                let humidity = draw.between(0.0, 0.95);
                let humidity = match kind.components().is_empty() {
                    true => String::new(),
                    false => format!("aerosol.relative_humidity = {humidity:.2}\n"),
                };
                format!(
                    "base = \"clear\"\naerosol.type = \"{}\"\naerosol.aod_550 = {depth:.3}\n{humidity}",
                    kind.name()
                )
            }
        };
        Self {
            air: format!("{air}planet.ground_albedo = {albedo:.2}\n"),
            sun_elevation_deg,
            altitude_m,
            elevation_deg,
            azimuth_deg,
        }
    }

    /// The atmosphere.
    ///
    /// # Panics
    /// If the text that this module writes is no atmosphere.
    pub fn atmosphere(&self) -> Atmosphere {
        Atmosphere::from_toml(&self.air).expect("a valid atmosphere file")
    }

    /// Identifies the value at a wavelength.
    fn at(&self, wavelength_nm: f64) -> At {
        At {
            altitude_m: self.altitude_m,
            sun_zenith_deg: 90.0 - self.sun_elevation_deg,
            view_zenith_deg: 90.0 - self.elevation_deg,
            relative_azimuth_deg: self.azimuth_deg,
            wavelength_nm: Some(wavelength_nm),
            ..Default::default()
        }
    }

    /// Radiance by the fast solver at [`WAVELENGTHS_NM`], W m^-2 sr^-1 nm^-1.
    ///
    /// # Errors
    /// [`SkyError`] for settings that the solver refuses, for light that does not converge, and if the caller cancelled.
    pub fn solved(
        &self,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Vec<f64>, SkyError> {
        let grid = WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec());
        let settings = SkySettings {
            suns: SunCoverage::near(self.sun_elevation_deg, self.altitude_m),
            ..settings.clone()
        };
        let grid = grid.expect("wavelengths within the range of the spectra");
        let sky = Sky::prepare_with(&self.atmosphere(), &grid, &settings, control)?;
        let view = sky.view(self.altitude_m, direction(0.0, self.sun_elevation_deg));
        let line = view.along(direction(self.azimuth_deg, self.elevation_deg), None);
        Ok(line.radiance().iter().map(|&l| l.into()).collect())
    }
}

/// Checks of the fast solver with these settings, for scalar light: one for airs with an aerosol, one for airs of layers.
///
/// # Errors
/// [`Cancelled`].
///
/// # Panics
/// Where the solver refuses the air or the settings.
pub fn checks(settings: &SkySettings, control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let settings = scalar(settings);
    let check = |what: &str| Check {
        suite: Suite::RandomAirs,
        what: what.into(),
        against: "Airlight's Monte Carlo".into(),
        unit: Unit::Percent,
        limit: Some(LIMIT),
        limit_of_rms: Some(LIMIT_OF_RMS),
        rows: Vec::new(),
    };
    let mut checks = vec![
        check("random aerosols, suns, eyes and views"),
        check("random layers, suns, eyes and views"),
    ];
    for line in Table::new(TRUTH).lines() {
        let number = line.number("number") as u64;
        let case = RandomSky::new(number);
        let ours = match case.solved(&settings, control) {
            Err(SkyError::Cancelled(cancelled)) => return Err(cancelled),
            solved => solved.expect("the random skies can be solved"),
        };
        let rows = WAVELENGTHS_NM.iter().zip(ours).map(|(&nm, ours)| Row {
            at: case.at(nm),
            ours,
            reference: line.number(&format!("l{nm}")),
            standard_error: line.number(&format!("se{nm}")),
        });
        let kind = usize::from(LAYERS.contains(&number));
        checks[kind].rows.extend(rows);
    }
    Ok(checks)
}

/// One to three layers of particles in clear air, with an optical depth of 0.02 to 0.5 each at 550 nm, 1 at most.
fn layers(draw: &mut SplitMix64) -> String {
    let mut text = "base = \"clear\"\n".to_owned();
    let mut left = 1.0;
    for number in 1..=1 + draw.below(3) {
        let density = density(draw);
        let depth = draw.scale(0.02, 0.5).min(left);
        left -= depth;
        let albedo = draw.pick(&[1.0, 0.95, 0.8]);
        let exponent = draw.between(0.0, 1.8);
        let phase = match draw.below(4) {
            0 => "kind = \"continental\"".to_owned(),
            1 => format!(
                "kind = \"draine\", g = {:.2}, alpha = {:.1}",
                draw.between(0.3, 0.85),
                draw.between(0.0, 2.0)
            ),
            _ => format!(
                "kind = \"henyey-greenstein\", g = {:.2}",
                draw.between(-0.2, 0.9)
            ),
        };
        let constituent = |scattering: f64, absorption: f64| {
            let spectrum = |value: f64| {
                format!("{{ at_550_nm = {value:.4e}, angstrom_exponent = {exponent:.1} }}")
            };
            format!(
                "{{ name = \"layer {number}\", density = {{ {density} }}, phase = {{ {phase} }}, scattering_per_m = {}, \
                 absorption_per_m = {} }}",
                spectrum(scattering),
                spectrum(absorption),
            )
        };
        let unit = format!(
            "base = \"none\"\nconstituent = [{}]\n",
            constituent(1.0, 0.0)
        );
        let air = Atmosphere::from_toml(&unit).expect("a valid layer");
        let part = air.constituent(&ConstituentKind::from(format!("layer {number}").as_str()));
        let column_m = part.expect("the layer").density.column_m(0.0, 100e3);
        let extinction = depth / column_m;
        let separator = if number == 1 { "constituent = [\n" } else { "" };
        text.push_str(&format!(
            "{separator}    {},\n",
            constituent(albedo * extinction, (1.0 - albedo) * extinction)
        ));
    }
    text + "]\n"
}

/// A density profile, in the format of atmosphere files.
fn density(draw: &mut SplitMix64) -> String {
    let bottom_m = draw.scale(100.0, 12e3);
    match draw.below(5) {
        0 => format!(
            "kind = \"exponential\", scale_height_m = {:.0}",
            draw.scale(300.0, 8e3)
        ),
        1 => format!(
            "kind = \"layer\", bottom_m = {bottom_m:.0}, top_m = {:.0}",
            bottom_m + draw.scale(200.0, 5e3)
        ),
        2 => {
            let peak_m = bottom_m + draw.scale(200.0, 4e3);
            let top_m = peak_m + draw.scale(200.0, 4e3);
            format!(
                "kind = \"tent\", bottom_m = {bottom_m:.0}, peak_m = {peak_m:.0}, top_m = {top_m:.0}"
            )
        }
        _ => {
            let kind = draw.pick(&["linear", "log-linear"]);
            let knots = 3 + draw.below(6);
            let highest_m = draw.between(2e3, 18e3);
            let altitudes: Vec<String> = (0..knots)
                .map(|k| format!("{:.0}", highest_m * k as f64 / (knots - 1) as f64))
                .collect();
            let densities: Vec<String> = (0..knots)
                .map(|_| format!("{:.3}", draw.scale(0.02, 1.0)))
                .collect();
            format!(
                "kind = \"table\", interpolation = \"{kind}\", altitudes_m = [{}], densities = [{}]",
                altitudes.join(", "),
                densities.join(", ")
            )
        }
    }
}
