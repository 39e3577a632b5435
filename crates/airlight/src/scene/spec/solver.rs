//! Solver of a scene and its settings.

use crate::names::named;
use crate::sky::{Scattering, SkySettings, SunCoverage};

/// The solver or published model, and its settings.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SolverSpec {
    /// Name of the solver or published model. Default: orders.
    pub name: Option<String>,
    /// Orders of scattering: "all" or "single". Default: all.
    pub scattering: Option<Scattering>,
    /// Resolution of the orders of scattering. Default: standard.
    pub effort: Option<Effort>,
    /// Whether light is polarised by scattering, which changes its radiance by 1 to 3 % in clear skies, and by up to 13 % in the
    /// violet. Default: true.
    pub polarisation_correction: Option<bool>,
    /// Wavelengths to compute: rgb (3), fast (8), standard (16), fine (95), 1nm (471), or a list in nm: "440,550,680".
    /// Default: fast for pictures in colour, standard for spectra.
    pub wavelengths: Option<String>,
    /// Monte Carlo paths for each pixel or direction, 128 or above. Default: 256 for pixels, 65536 for a probe.
    pub paths: Option<u64>,
    /// Seed of the Monte Carlo paths: the same seed gives the same picture. Default: 1.
    pub seed: Option<u64>,
    /// Variant of a published model. Default: the model's first.
    pub variant: Option<String>,
    /// Colour of the sun of single-scattering. Default: white.
    pub sunlight: Option<SunlightKind>,
    /// Illuminance by a white sun at the zenith of single-scattering, lx, above 0. Default: 120000.
    pub zenith_lux: Option<f64>,
    /// Settings of klassen1987.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "super::is_default"))]
    pub klassen1987: Klassen1987Spec,
}

impl SolverSpec {
    /// Settings of the sky solver for a range of suns.
    pub fn sky_settings(&self, suns: SunCoverage) -> SkySettings {
        SkySettings {
            suns,
            scattering: self.scattering.unwrap_or(Scattering::All),
            polarisation_correction: self.polarisation_correction.unwrap_or(true),
            ..match self.effort.unwrap_or_default() {
                Effort::Standard => SkySettings::default(),
                Effort::Fine => SkySettings::fine(),
            }
        }
    }
}

/// Resolution of the orders of scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Effort {
    /// Error in daylight below 1 % in clear air (1.4 % with the sun at the horizon) and 3 % in haze.
    #[default]
    Standard,
    /// Denser suns, heights and directions, and twice as many moments: error below 0.5 %, in dust and twilight too, twenty times slower.
    Fine,
}

named! { Effort, "an effort", [
    ("standard", (Standard), "error in daylight below 1 % in clear air (1.4 % with the sun at the horizon), 3 % in haze"),
    ("fine", (Fine), "error below 0.5 %, in dust and twilight too, twenty times slower"),
] }

/// Colour of the sun of single-scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SunlightKind {
    /// White on the ground with the sun at the zenith, as printed.
    #[default]
    White,
    /// Measured solar spectrum outside the atmosphere.
    Measured,
}

named! { SunlightKind, "a kind of sunlight", [
    ("white", (White), "white on the ground with the sun at the zenith, as printed"),
    ("measured", (Measured), "measured solar spectrum outside the atmosphere"),
] }

/// Settings of klassen1987, each of which overrides a value derived from the atmosphere.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Klassen1987Spec {
    /// Extinction of the haze at 550 nm, 1/m, 0 or above. Default: that of the atmosphere's haze at the ground.
    pub haze_extinction_per_m: Option<f64>,
    /// Thickness of the haze, m, above 0. Default: the one that preserves the haze's optical depth.
    pub haze_thickness_m: Option<f64>,
    /// Kind of water drops in the haze. Default: particles of the atmosphere's haze.
    pub wet_haze: Option<WetHaze>,
    /// Density of the air relative to the atmosphere's, above 0. Default: 1.
    pub air_density: Option<f64>,
    /// Thickness of the air at its density at the ground, m, above 0. Default: the one that preserves its optical depth.
    pub air_thickness_m: Option<f64>,
    /// Sky behind the haze. Default: solver; paper for the variant printed.
    pub base_blue: Option<BaseBlueKind>,
}

/// Deirmendjian's hazes of water drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WetHaze {
    /// Haze M: marine and coastal.
    HazeM,
    /// Haze L: continental.
    HazeL,
    /// Haze H: high levels, stratosphere.
    HazeH,
}

named! { WetHaze, "a wet haze", [
    ("haze-m", (HazeM), "haze M of Deirmendjian: marine and coastal"),
    ("haze-l", (HazeL), "haze L of Deirmendjian: continental"),
    ("haze-h", (HazeH), "haze H of Deirmendjian: high levels, stratosphere"),
] }

/// Sky behind the haze of klassen1987.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BaseBlueKind {
    /// One blue in all directions, whose luminance falls to a hundredth from noon to sunset.
    Paper,
    /// The solved sky of the air without haze.
    Solver,
}

named! { BaseBlueKind, "a base sky", [
    ("paper", (Paper), "one blue in all directions, whose luminance falls to a hundredth from noon to sunset"),
    ("solver", (Solver), "the solved sky of the air without haze"),
] }
