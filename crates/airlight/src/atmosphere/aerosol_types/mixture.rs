//! [`AerosolMixture`]: mixtures of types and components, and their constituents.

use super::modes::{Mode, Optics, WAVELENGTHS_NM};
use super::{AerosolType, AerosolTypeError, Component, layer};
use crate::atmosphere::aerosol::{AerosolLoad, REFERENCE_NM, extinction_at_density_1};
use crate::atmosphere::presets::earth::EARTH_TOP_M;
use crate::atmosphere::{ClearAir, Constituent, ConstituentKind, DensityProfile};
use crate::optics::PhaseFunction;
use crate::optics::mie::SizeDistribution;
use crate::spectrum::{CurveError, SpectralCurve};

/// A part of a mixture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Ingredient {
    /// A type, which is itself a mixture.
    Type(AerosolType),
    /// A single component of OPAC.
    Component(Component),
}

/// A mixture of types and components by their shares of the extinction at 550 nm, at a relative humidity.
#[derive(Clone, Debug, PartialEq)]
pub struct AerosolMixture {
    /// Parts with their shares, which sum to 1.
    parts: Vec<(f64, Ingredient)>,
    relative_humidity: f64,
}

/// Bulk optical properties of an aerosol at 550 nm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AerosolSummary {
    /// Extinction coefficient at the ground at the published number density (mean by shares for a mixture), m^-1.
    pub extinction_per_m: f64,
    /// Ratio of scattering to extinction.
    pub single_scattering_albedo: f64,
    /// Mean cosine of the scattering angle.
    pub asymmetry: f64,
    /// Angstrom exponent of the extinction from 350 to 500 nm.
    pub angstrom_350_500: f64,
    /// Angstrom exponent of the extinction from 500 to 800 nm.
    pub angstrom_500_800: f64,
}

impl AerosolMixture {
    /// Default relative humidity, that of OPAC's tables.
    pub const USUAL_HUMIDITY: f64 = 0.8;

    /// A mixture of parts with these shares of the extinction at 550 nm, which are normalized to sum to 1, at a relative
    /// humidity from 0 to 0.99.
    ///
    /// # Errors
    /// [`AerosolTypeError`] if there are no parts, a share is not positive or the humidity is out of range.
    pub fn new(
        parts: Vec<(f64, Ingredient)>,
        relative_humidity: f64,
    ) -> Result<Self, AerosolTypeError> {
        if !(0.0..=0.99).contains(&relative_humidity) {
            return Err(AerosolTypeError::Humidity(relative_humidity));
        }
        let wrong = |share: f64| !(share.is_finite() && share > 0.0);
        if let Some(&(share, _)) = parts.iter().find(|part| wrong(part.0)) {
            return Err(AerosolTypeError::Share(share));
        }
        // Divided by the largest share, so that the sum does not overflow.
        let most = parts.iter().fold(0.0, |most: f64, part| most.max(part.0));
        let sum: f64 = parts.iter().map(|part| part.0 / most).sum();
        match parts.is_empty() {
            true => Err(AerosolTypeError::Empty),
            false => Ok(Self {
                parts: parts
                    .into_iter()
                    .map(|(share, part)| (share / most / sum, part))
                    .collect(),
                relative_humidity,
            }),
        }
    }

    /// A single type.
    ///
    /// # Errors
    /// [`AerosolTypeError::Humidity`] if the humidity is out of range.
    pub fn of(kind: AerosolType, relative_humidity: f64) -> Result<Self, AerosolTypeError> {
        Self::new(vec![(1.0, Ingredient::Type(kind))], relative_humidity)
    }

    /// Whether any particles take up water, so that optics depend on humidity.
    pub fn grows(&self) -> bool {
        self.parts.iter().any(|&(_, part)| part.grows())
    }

    /// Density profile above ground at this altitude (m): that of the part with the largest share ([`AerosolType::profile`];
    /// single components have that of continental aerosol).
    pub fn profile(&self, ground_altitude_m: f64) -> DensityProfile {
        let most = self.parts.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        match most.map(|part| part.1) {
            Some(part) => part.profile(ground_altitude_m),
            None => layer(ground_altitude_m, 8e3, 2e3),
        }
    }

    /// Default optical depth at 550 nm: OPAC's number densities at this humidity, for smoke an optical depth of 0.5 at 440 nm;
    /// parts are weighted by their shares.
    ///
    /// # Errors
    /// [`AerosolTypeError::Mie`] for invalid particles.
    pub fn usual_optical_depth_550(&self) -> Result<f64, AerosolTypeError> {
        let mut depth = 0.0;
        for &(share, part) in &self.parts {
            let optics = Optics::of(&part.modes(self.relative_humidity))?;
            let column_m = part.profile(0.0).column_m(0.0, EARTH_TOP_M);
            depth += share * column_m * optics.extinction_per_m(reference());
        }
        Ok(depth)
    }

    /// Modes of all parts. Number densities are scaled such that each part has its share of the extinction, and the total
    /// is the mean, by shares, of the published extinctions.
    fn modes(&self) -> Result<Vec<Mode>, AerosolTypeError> {
        let mut all = Vec::new();
        let mut whole_per_m = 0.0;
        for &(share, part) in &self.parts {
            let modes = part.modes(self.relative_humidity);
            let extinction_per_m = Optics::of(&modes)?.extinction_per_m(reference());
            whole_per_m += share * extinction_per_m;
            let factor = share / extinction_per_m;
            all.extend(modes.into_iter().map(|mode| mode.times(factor)));
        }
        Ok(all
            .into_iter()
            .map(|mode| mode.times(whole_per_m))
            .collect())
    }

    /// Bulk optical properties.
    ///
    /// # Errors
    /// [`AerosolTypeError::Mie`] for invalid particles.
    pub fn summary(&self) -> Result<AerosolSummary, AerosolTypeError> {
        let optics = Optics::of(&self.modes()?)?;
        let at = |nm: f64| WAVELENGTHS_NM.iter().position(|&w| w == nm).unwrap_or(0);
        let exponent = |short: f64, long: f64| {
            let ratio = optics.extinction_per_m(at(short)) / optics.extinction_per_m(at(long));
            ratio.ln() / (long / short).ln()
        };
        let extinction_per_m = optics.extinction_per_m(reference());
        Ok(AerosolSummary {
            extinction_per_m,
            single_scattering_albedo: optics.scattering_per_m[reference()] / extinction_per_m,
            asymmetry: optics.asymmetry[reference()],
            angstrom_350_500: exponent(350.0, 500.0),
            angstrom_500_800: exponent(500.0, 800.0),
        })
    }

    /// The aerosol constituent of an atmosphere between two altitudes, m. Defaults: [`Self::usual_optical_depth_550`] and
    /// [`Self::profile`].
    ///
    /// Coefficients are power laws between the wavelengths of the Lorenz-Mie computation, tabulated every 5 nm.
    ///
    /// # Errors
    /// [`AerosolTypeError`] for an invalid amount or density profile.
    pub fn constituent(
        &self,
        load: Option<AerosolLoad>,
        density: Option<DensityProfile>,
        clear: ClearAir,
        ground_altitude_m: f64,
        top_altitude_m: f64,
    ) -> Result<Constituent, AerosolTypeError> {
        let load = match load {
            Some(load) => load,
            None => AerosolLoad::OpticalDepth550(self.usual_optical_depth_550()?),
        };
        let density = density.unwrap_or_else(|| self.profile(ground_altitude_m));
        let extinction_per_m =
            extinction_at_density_1(load, &density, clear, ground_altitude_m, top_altitude_m)?;
        let optics = Optics::of(&self.modes()?)?;
        let scale = extinction_per_m / optics.extinction_per_m(reference());
        Ok(Constituent {
            kind: ConstituentKind::Aerosol,
            density,
            scattering_per_m: curve(&optics.scattering_per_m, scale)?,
            absorption_per_m: curve(&optics.absorption_per_m, scale)?,
            phase: PhaseFunction::Tabulated(optics.phase()?),
        })
    }
}

/// Droplets of 75 % sulfuric acid: with this number per cubic centimetre at density 1.
///
/// # Errors
/// [`AerosolTypeError`] for an invalid size distribution.
pub(in crate::atmosphere) fn sulfuric_acid(
    kind: ConstituentKind,
    sizes: SizeDistribution,
    number_per_cm3: f64,
    density: DensityProfile,
) -> Result<Constituent, AerosolTypeError> {
    let optics = Optics::of(&[Mode {
        number_per_cm3,
        index: Component::Sulfate.index(0.0),
        sizes,
    }])?;
    Ok(Constituent {
        kind,
        density,
        scattering_per_m: curve(&optics.scattering_per_m, 1.0)?,
        absorption_per_m: curve(&optics.absorption_per_m, 1.0)?,
        phase: PhaseFunction::Tabulated(optics.phase()?),
    })
}

impl Ingredient {
    fn modes(self, relative_humidity: f64) -> Vec<Mode> {
        match self {
            Self::Type(kind) => kind.modes(relative_humidity),
            Self::Component(component) => vec![component.mode(relative_humidity, 1.0)],
        }
    }

    /// Density profile above ground at this altitude, m.
    fn profile(self, ground_altitude_m: f64) -> DensityProfile {
        match self {
            Self::Type(kind) => kind.profile(ground_altitude_m),
            Self::Component(_) => layer(ground_altitude_m, 8e3, 2e3),
        }
    }

    fn grows(self) -> bool {
        match self {
            Self::Type(kind) => kind.components().iter().any(|part| part.0.grows()),
            Self::Component(component) => component.grows(),
        }
    }
}

impl Optics {
    fn extinction_per_m(&self, i: usize) -> f64 {
        self.scattering_per_m[i] + self.absorption_per_m[i]
    }
}

/// Index of 550 nm in [`WAVELENGTHS_NM`].
fn reference() -> usize {
    WAVELENGTHS_NM
        .iter()
        .position(|&nm| nm == REFERENCE_NM)
        .unwrap_or(0)
}

/// Curve of positive values at [`WAVELENGTHS_NM`], times `scale`: power laws between them, sampled every 5 nm.
fn curve(values: &[f64], scale: f64) -> Result<SpectralCurve, CurveError> {
    let mut wavelengths = Vec::new();
    let mut samples = Vec::new();
    for (w, v) in WAVELENGTHS_NM.windows(2).zip(values.windows(2)) {
        let exponent = (v[1] / v[0]).ln() / (w[1] / w[0]).ln();
        for step in 0..10 {
            let nm = w[0] + 0.1 * f64::from(step) * (w[1] - w[0]);
            wavelengths.push(nm);
            samples.push(scale * v[0] * (nm / w[0]).powf(exponent));
        }
    }
    wavelengths.push(WAVELENGTHS_NM[WAVELENGTHS_NM.len() - 1]);
    samples.push(scale * values[values.len() - 1]);
    SpectralCurve::table(wavelengths, samples)
}
