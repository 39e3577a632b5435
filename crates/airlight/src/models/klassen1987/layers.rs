//! Conversion of an atmosphere to the two layers of the model, and back.

use super::settings::{Haze, Klassen1987Error, Klassen1987Settings, scatters};
use crate::atmosphere::REFERENCE_NM;
use crate::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet};
use crate::control::Control;
use crate::optics::PhaseFunction;
use crate::spectrum::SpectralCurve;

impl Klassen1987Settings {
    /// Settings for an atmosphere.
    ///
    /// Aerosol becomes the haze, everything else the clear air. Each layer has the density of its constituents at the ground and
    /// the thickness that preserves its vertical optical depth, which is the scale height for an exponential profile. Haze with
    /// no density at the ground gets twice its mean height; haze that would extend above the air is cut to the air's height.
    /// Both keep their optical depth.
    pub fn of(atmosphere: &Atmosphere) -> Self {
        let (haze, clear): (Vec<_>, Vec<_>) = atmosphere
            .constituents
            .iter()
            .cloned()
            .partition(|part| scatters(part) && part.kind != ConstituentKind::Molecules);
        let clear_air = Atmosphere {
            constituents: clear,
            ..atmosphere.clone()
        };
        let air = layer(
            clear_air.constituents.iter().filter(|p| scatters(p)),
            &clear_air.planet,
        );
        let mut settings = Self {
            air_thickness_m: air.thickness_m.unwrap_or(8.4e3),
            clear_air,
            ..Self::default()
        };
        if haze.is_empty() {
            settings.haze_extinction_per_m = 0.0;
            return settings;
        }
        let of_haze = layer(haze.iter(), &atmosphere.planet);
        let thickness_m = of_haze
            .thickness_m
            .unwrap_or(2.0 * of_haze.mean_height_m)
            .min(settings.air_thickness_m);
        settings.haze_thickness_m = thickness_m;
        settings.haze_extinction_per_m = of_haze.optical_depth / thickness_m;
        settings.haze = combined(&haze, &atmosphere.planet);
        settings
    }

    /// Atmosphere of these settings, for the solver: the clear air with its density, and the haze as a uniform layer. Phase
    /// functions are those of the particles.
    ///
    /// # Errors
    /// [`Klassen1987Error`] if a setting is outside its domain.
    pub fn atmosphere(&self) -> Result<Atmosphere, Klassen1987Error> {
        self.validate()?;
        let mut atmosphere = self.dense_clear_air();
        let (extinction, albedo, phase) = self.haze.optics(Control::default())?;
        let scale = self.haze_extinction_per_m / extinction.at(REFERENCE_NM);
        let ground_m = atmosphere.planet.ground_altitude_m;
        atmosphere.constituents.push(Constituent {
            kind: ConstituentKind::Aerosol,
            density: DensityProfile::Layer {
                bottom_m: ground_m,
                top_m: ground_m + self.haze_thickness_m,
            },
            scattering_per_m: sampled(|nm| scale * extinction.at(nm) * albedo.at(nm)),
            absorption_per_m: sampled(|nm| {
                scale * extinction.at(nm) * (1.0 - albedo.at(nm)).max(0.0)
            }),
            phase,
        });
        atmosphere.validate()?;
        Ok(atmosphere)
    }
}

/// Combined properties of constituents at 550 nm.
struct Layer {
    optical_depth: f64,
    /// Optical depth divided by the extinction at the ground; `None` if that is 0.
    thickness_m: Option<f64>,
    mean_height_m: f64,
}

fn layer<'a>(parts: impl Iterator<Item = &'a Constituent>, planet: &Planet) -> Layer {
    const HEIGHTS: u32 = 400;
    let (ground_m, top_m) = (planet.ground_altitude_m, planet.top_altitude_m);
    let (mut depth, mut at_ground, mut moment) = (0.0, 0.0, 0.0);
    for part in parts {
        let extinction = part.extinction_per_m(REFERENCE_NM);
        let column_m = part.density.column_m(ground_m, top_m);
        depth += extinction * column_m;
        at_ground += extinction * part.density.at(ground_m);
        // The mean height is the integral of the column above.
        let step_m = (top_m - ground_m) / f64::from(HEIGHTS);
        for i in 0..HEIGHTS {
            let height_m = (f64::from(i) + 0.5) * step_m;
            moment += extinction * step_m * part.density.column_m(ground_m + height_m, top_m);
        }
    }
    let thickness_m = depth / at_ground;
    Layer {
        optical_depth: depth,
        thickness_m: (at_ground > 0.0 && thickness_m.is_finite()).then_some(thickness_m),
        mean_height_m: if depth > 0.0 { moment / depth } else { 0.0 },
    }
}

/// Combines hazes: curves are summed by column, phase functions mixed by scattering at 550 nm.
fn combined(parts: &[Constituent], planet: &Planet) -> Haze {
    let column = |part: &Constituent| {
        part.density
            .column_m(planet.ground_altitude_m, planet.top_altitude_m)
    };
    let sum = |of: &dyn Fn(&Constituent) -> f64| -> f64 {
        parts.iter().map(|part| column(part) * of(part)).sum()
    };
    let scattered = |nm: f64| sum(&|part| part.scattering_per_m.at(nm));
    let extinction = |nm: f64| sum(&|part| part.extinction_per_m(nm));
    let whole = scattered(REFERENCE_NM);
    let share = |part: &Constituent| column(part) * part.scattering_per_m.at(REFERENCE_NM) / whole;
    let phase = match parts {
        [one] => one.phase.clone(),
        _ => PhaseFunction::Mixture(
            parts
                .iter()
                .map(|part| (share(part), part.phase.clone()))
                .collect(),
        ),
    };
    Haze::Given {
        extinction: sampled(extinction),
        single_scattering_albedo: sampled(|nm| scattered(nm) / extinction(nm)),
        phase,
    }
}

/// Samples a curve at the model's wavelengths.
fn sampled(curve: impl Fn(f64) -> f64) -> SpectralCurve {
    let nm: Vec<f64> = super::wavelengths_nm().collect();
    let values = nm.iter().map(|&nm| curve(nm)).collect();
    SpectralCurve::table(nm, values).unwrap_or(SpectralCurve::Constant(1.0))
}
