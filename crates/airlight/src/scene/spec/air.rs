//! Gases, haze and ground.

use crate::atmosphere::visibility::Contrast;

/// Gases, haze and ground: a named atmosphere and the values that override it.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AirSpec {
    /// Name of a preset, or of a TOML file beside the scene. Default: average.
    pub atmosphere: Option<String>,
    /// Text of the TOML file that `atmosphere` names, once it has been read ([`Scene::inline_files`](super::Scene::inline_files)).
    pub atmosphere_toml: Option<String>,
    /// Haze of a published type, or a mixture by shares of the extinction: "urban:0.7,desert:0.3".
    pub aerosol: Option<String>,
    /// Relative humidity that determines the size of the particles of `aerosol`, 0 to 0.99. Default: 0.8.
    pub humidity: Option<f64>,
    /// Optical depth of the haze at 550 nm, 0 or above.
    pub aod_550: Option<f64>,
    /// Haze as turbidity at 550 nm: optical depth of air and haze over that of air, 1 or above.
    pub turbidity: Option<f64>,
    /// Haze as visibility at the ground, m, above 0.
    pub haze_visibility_m: Option<f64>,
    /// Contrast threshold that defines all visibilities of the scene: 0.05 (meteorological optical range) or 0.02
    /// (Koschmieder's visual range). Default: 0.05.
    pub contrast: Option<f64>,
    /// Ozone column, Dobson units, 0 or above. Default: the atmosphere's, 300 on the Earth.
    pub ozone_du: Option<f64>,
    /// Albedo of the ground at all wavelengths, 0 to 1. Default: the atmosphere's.
    pub ground_albedo: Option<f64>,
    /// Altitude of the ground above sea level, m, -12000 to 1e9. Default: the atmosphere's, or the observer's if that is
    /// lower.
    pub ground_altitude_m: Option<f64>,
}

impl AirSpec {
    /// Contrast threshold that defines all visibilities of the scene.
    pub fn visibility_contrast(&self) -> Contrast {
        match self.contrast {
            Some(contrast) if contrast == Contrast::TwoPercent.value() => Contrast::TwoPercent,
            _ => Contrast::FivePercent,
        }
    }

    /// Whether the type or the amount of the haze is set.
    pub(crate) fn sets_haze(&self) -> bool {
        self.aerosol.is_some()
            || self.humidity.is_some()
            || self.aod_550.is_some()
            || self.turbidity.is_some()
            || self.haze_visibility_m.is_some()
    }
}
