//! Published aerosol types, with extinction, albedo and phase function by wavelength.
//!
//! [`AerosolType`] lists ten types of OPAC (M. Hess, P. Koepke & I. Schult, *Optical Properties of
//! Aerosols and Clouds: The Software Package OPAC*, Bull. Amer. Meteor. Soc. 79, 831, 1998), mixed from [`Component`]s that
//! grow in moist air, and three smokes ([`Smoke`]). [`AerosolMixture`] is one type at a relative humidity, or a mixture of
//! several, and builds the aerosol constituent of an atmosphere. Optics are computed by Lorenz-Mie theory
//! ([`crate::optics::mie`]).
//!
//! **Limitations.** All particles are spheres. Grains of desert dust are not: they scatter more sideways and less backwards
//! (Koepke, Gasteiger & Hess, Atmos. Chem. Phys. 15, 5947, 2015); the albedo of spheroids is within 0.005.
//! Optics are computed every 50 nm from 350 to 850 nm and constant beyond.

mod material;
mod mixture;
mod modes;
mod smoke;
#[cfg(test)]
mod tests;

pub use material::Component;
pub(super) use mixture::sulfuric_acid;
pub use mixture::{AerosolMixture, AerosolSummary, Ingredient};
pub use smoke::Smoke;

use super::aerosol::AerosolError;
use super::presets::earth::EARTH_TOP_M;
use super::{DensityProfile, Interpolation};
use crate::names::named;
use crate::optics::mie::MieError;
use crate::spectrum::CurveError;
use modes::Mode;

/// A published aerosol type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AerosolType {
    /// Remote continental air without soot.
    ContinentalClean,
    /// Continental air with some soot.
    ContinentalAverage,
    /// Polluted continental air.
    ContinentalPolluted,
    /// Urban air with much soot.
    Urban,
    /// Desert dust.
    Desert,
    /// Unpolluted marine air.
    MaritimeClean,
    /// Marine air with soot.
    MaritimePolluted,
    /// Tropical marine air, with less sea salt.
    MaritimeTropical,
    /// Arctic haze in spring.
    Arctic,
    /// Antarctica in summer.
    Antarctic,
    /// Smoke of burning vegetation.
    Biomass(Smoke),
}

/// Error of an aerosol type or mixture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AerosolTypeError {
    /// A humidity out of range.
    #[error("expected a relative humidity from 0 to 0.99 (0.8 is 80 %), got {0}")]
    Humidity(f64),
    /// A share that is not positive.
    #[error("expected finite shares of a mixture above 0, got {0}")]
    Share(f64),
    /// No parts.
    #[error("expected a mixture of at least one part, got none")]
    Empty,
    /// Invalid particles.
    #[error("{0}")]
    Mie(#[from] MieError),
    /// An invalid amount or density profile.
    #[error("{0}")]
    Aerosol(#[from] AerosolError),
    /// An invalid spectrum.
    #[error("{0}")]
    Curve(#[from] CurveError),
}

named! { AerosolType, "an aerosol type", [
    ("continental-clean", (ContinentalClean), "remote continental air without soot"),
    ("continental-average", (ContinentalAverage), "continental air with some soot"),
    ("continental-polluted", (ContinentalPolluted), "polluted continental air"),
    ("urban", (Urban), "urban air, much soot"),
    ("desert", (Desert), "desert dust (spheres)"),
    ("maritime-clean", (MaritimeClean), "unpolluted marine air"),
    ("maritime-polluted", (MaritimePolluted), "marine air with soot"),
    ("maritime-tropical", (MaritimeTropical), "tropical marine air"),
    ("arctic", (Arctic), "arctic haze in spring"),
    ("antarctic", (Antarctic), "Antarctica in summer"),
    ("biomass-savanna", (Biomass(Smoke::Savanna)), "smoke of the African savanna"),
    ("biomass-forest", (Biomass(Smoke::Forest)), "smoke of the Amazonian forest"),
    ("biomass-boreal", (Biomass(Smoke::Boreal)), "smoke of boreal forest"),
] }

impl AerosolType {
    /// Components with their number densities in particles per cubic centimetre (Hess, Koepke & Schult 1998, table 4); empty
    /// for smoke.
    pub fn components(self) -> &'static [(Component, f64)] {
        use Component::{
            Insoluble, MineralAccumulation, MineralCoarse, MineralNucleation, MineralTransported,
            SeaSaltAccumulation, SeaSaltCoarse, Soot, Sulfate, WaterSoluble,
        };
        match self {
            Self::ContinentalClean => &[(WaterSoluble, 2600.0), (Insoluble, 0.15)],
            Self::ContinentalAverage => &[(WaterSoluble, 7000.0), (Insoluble, 0.4), (Soot, 8300.0)],
            Self::ContinentalPolluted => {
                &[(WaterSoluble, 15_700.0), (Insoluble, 0.6), (Soot, 34_300.0)]
            }
            Self::Urban => &[
                (WaterSoluble, 28_000.0),
                (Insoluble, 1.5),
                (Soot, 130_000.0),
            ],
            Self::Desert => &[
                (WaterSoluble, 2000.0),
                (MineralNucleation, 269.5),
                (MineralAccumulation, 30.5),
                (MineralCoarse, 0.142),
            ],
            Self::MaritimeClean => &[
                (WaterSoluble, 1500.0),
                (SeaSaltAccumulation, 20.0),
                (SeaSaltCoarse, 3.2e-3),
            ],
            Self::MaritimePolluted => &[
                (WaterSoluble, 3800.0),
                (SeaSaltAccumulation, 20.0),
                (SeaSaltCoarse, 3.2e-3),
                (Soot, 5180.0),
            ],
            Self::MaritimeTropical => &[
                (WaterSoluble, 590.0),
                (SeaSaltAccumulation, 10.0),
                (SeaSaltCoarse, 1.3e-3),
            ],
            Self::Arctic => &[
                (WaterSoluble, 1300.0),
                (Insoluble, 0.01),
                (SeaSaltAccumulation, 1.9),
                (Soot, 5300.0),
            ],
            Self::Antarctic => &[
                (Sulfate, 42.9),
                (SeaSaltAccumulation, 0.047),
                (MineralTransported, 0.0053),
            ],
            Self::Biomass(_) => &[],
        }
    }

    /// Density profile above ground at this altitude (m). OPAC types (table 5) have the mixing layer only: `e^(-h / Z)` up to
    /// 2 km (desert 6 km, antarctic 10 km), with Z = 8 km (desert 2 km, maritime 1 km, arctic 99 km). The aerosol that OPAC
    /// adds in the free troposphere and stratosphere, an optical depth of 0.02 at 550 nm, is omitted. No profile is published
    /// for smoke; `e^(-h / 2 km)` up to 10 km is an assumption made here.
    pub fn profile(self, ground_altitude_m: f64) -> DensityProfile {
        let (scale_height_m, top_m) = match self {
            Self::Desert => (2e3, 6e3),
            Self::MaritimeClean | Self::MaritimePolluted | Self::MaritimeTropical => (1e3, 2e3),
            Self::Arctic => (99e3, 2e3),
            Self::Antarctic => (8e3, 10e3),
            Self::Biomass(_) => (2e3, 10e3),
            Self::ContinentalClean
            | Self::ContinentalAverage
            | Self::ContinentalPolluted
            | Self::Urban => (8e3, 2e3),
        };
        layer(ground_altitude_m, scale_height_m, top_m)
    }

    /// Modes of particles at a relative humidity.
    fn modes(self, relative_humidity: f64) -> Vec<Mode> {
        match self {
            Self::Biomass(smoke) => {
                let column_m = self.profile(0.0).column_m(0.0, EARTH_TOP_M);
                let modes = smoke.modes().into_iter();
                modes.map(|mode| mode.times(1.0 / column_m)).collect()
            }
            _ => {
                let of = |&(part, number): &(Component, f64)| part.mode(relative_humidity, number);
                self.components().iter().map(of).collect()
            }
        }
    }
}

impl Component {
    fn mode(self, relative_humidity: f64, number_per_cm3: f64) -> Mode {
        Mode {
            number_per_cm3,
            index: self.index(relative_humidity),
            sizes: self.sizes(relative_humidity),
        }
    }
}

/// `e^(-h / scale height)` from the ground up to `top_m` above it, 0 above.
fn layer(ground_altitude_m: f64, scale_height_m: f64, top_m: f64) -> DensityProfile {
    DensityProfile::tabulated(
        vec![ground_altitude_m, ground_altitude_m + top_m],
        vec![1.0, (-top_m / scale_height_m).exp()],
        Interpolation::LogLinear,
    )
    // Fails only for a ground altitude that is not finite, which the atmosphere rejects.
    .unwrap_or(DensityProfile::exponential(scale_height_m))
}
