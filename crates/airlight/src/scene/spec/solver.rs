//! How the light of a scene is solved for.

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
    /// Which light is computed: "all" orders of scattering, or "single". Default: all.
    pub scattering: Option<Scattering>,
    /// How finely the orders of scattering are solved. Default: standard.
    pub effort: Option<Effort>,
    /// Wavelengths to compute: rgb (3), fast (8), standard (16), fine (95), 1nm (471), or a list in nm: "440,550,680".
    /// Default: standard.
    pub wavelengths: Option<String>,
    /// Monte Carlo paths for each pixel or direction, 128 or above. Default: 256 for pixels, 65536 for a probe.
    pub paths: Option<u64>,
    /// Seed of the Monte Carlo paths: the same seed gives the same picture. Default: 1.
    pub seed: Option<u64>,
    /// Form of a published model. Default: corrected.
    pub variant: Option<String>,
    /// single-scattering: colour of the sun. Default: white.
    pub sunlight: Option<SunlightKind>,
    /// single-scattering: illuminance by a white sun in the zenith, lx, above 0. Default: 120000.
    pub zenith_lux: Option<f64>,
    /// Settings of the model of 1987.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "super::is_default"))]
    pub klassen1987: Klassen1987Spec,
}

impl SolverSpec {
    /// How a sky is solved for a range of suns.
    pub fn sky_settings(&self, suns: SunCoverage) -> SkySettings {
        SkySettings {
            suns,
            scattering: self.scattering.unwrap_or(Scattering::All),
            ..match self.effort.unwrap_or_default() {
                Effort::Standard => SkySettings::default(),
                Effort::Fine => SkySettings::fine(),
            }
        }
    }
}

/// How finely the orders of scattering are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Effort {
    /// By day within 1 % in clear air (1.4 % under a sun at the horizon), 3 % in haze.
    #[default]
    Standard,
    /// Twice the heights, more directions and moments: within 1 % by day in haze too, five times as long.
    Fine,
}

named! { Effort, "an effort", [
    ("standard", (Standard), "by day within 1 % in clear air (1.4 % with the sun at the horizon), 3 % in haze"),
    ("fine", (Fine), "within 1 % by day in haze too, five times as long"),
] }

/// Colour of the sun of the single-scattering shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SunlightKind {
    /// White on the ground when it stands in the zenith, as printed.
    #[default]
    White,
    /// As bright and as coloured as measured outside the air.
    Measured,
}

named! { SunlightKind, "a kind of sunlight", [
    ("white", (White), "white on the ground with the sun in the zenith, as printed"),
    ("measured", (Measured), "as measured outside the atmosphere"),
] }

/// Settings of the model of 1987: each in place of what the atmosphere has.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Klassen1987Spec {
    /// Extinction of its haze at 550 nm, 1/m, 0 or above. Default: that of the atmosphere's haze at the ground.
    pub haze_extinction_per_m: Option<f64>,
    /// Thickness of its haze, m, above 0. Default: that which gives the atmosphere's optical depth of haze.
    pub haze_thickness_m: Option<f64>,
    /// Its haze consists of water drops of this kind. Default: the atmosphere's haze.
    pub wet_haze: Option<WetHaze>,
    /// Density of its air over the atmosphere's, above 0. Default: 1.
    pub air_density: Option<f64>,
    /// Thickness of its air were it all as dense as at the ground, m, above 0. Default: that which gives the atmosphere's.
    pub air_thickness_m: Option<f64>,
    /// The sky behind its haze. Default: solver; paper for the variant printed.
    pub base_blue: Option<BaseBlueKind>,
}

/// Deirmendjian's wet hazes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WetHaze {
    /// Haze M: by the sea.
    HazeM,
    /// Haze L: over land.
    HazeL,
    /// Haze H: aloft.
    HazeH,
}

named! { WetHaze, "a wet haze", [
    ("haze-m", (HazeM), "haze M of Deirmendjian: maritime"),
    ("haze-l", (HazeL), "haze L of Deirmendjian: continental"),
    ("haze-h", (HazeH), "haze H of Deirmendjian: high altitudes"),
] }

/// The sky behind the haze of 1987.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BaseBlueKind {
    /// One constant blue, dimmed to a hundredth from noon to sunset.
    Paper,
    /// The air without haze, solved for.
    Solver,
}

named! { BaseBlueKind, "a base sky", [
    ("paper", (Paper), "one constant blue, dimmed to a hundredth from noon to sunset"),
    ("solver", (Solver), "the air without haze, solved for"),
] }
