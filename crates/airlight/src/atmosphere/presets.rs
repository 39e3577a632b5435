//! Named atmospheres of the Earth, of other worlds and of published models.

pub(crate) mod earth;
mod fixed_table;
pub(crate) mod mars;
mod molecules;
pub mod published;
pub mod reference;
pub(crate) mod titan;
pub(crate) mod venus;
mod wildfire;

pub use earth::{Earth, average, clear, hazy};
pub use mars::{dust_storm, mars};
pub use titan::titan;
pub use venus::venus;
pub use wildfire::wildfire;

use super::Atmosphere;
use crate::names::{UnknownName, named};

/// Named atmospheres of the Earth, of other worlds and of published models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Preset {
    /// Earth on a clear day: aerosol optical depth 0.05 at 550 nm.
    Clear,
    /// Earth on an average day: aerosol optical depth 0.12 at 550 nm.
    Average,
    /// Earth on a hazy day: aerosol optical depth 0.35 at 550 nm.
    Hazy,
    /// Earth under the smoke of forest fires: smoke optical depth 4 at 550 nm.
    Wildfire,
    /// Mars on a moderately dusty day: dust optical depth 0.5 at 880 nm.
    Mars,
    /// Mars in a planet-encircling dust storm: dust optical depth 8.5 at 880 nm.
    DustStorm,
    /// Venus below its clouds: optical depth 35.
    Venus,
    /// Titan below its haze: optical depth 8 at 550 nm.
    Titan,
    /// Earth of Bruneton's Precomputed Atmospheric Scattering (2017), spectral.
    Bruneton,
    /// Earth of Hillaire's Scalable and Production Ready Sky (2020), red, green and blue.
    Hillaire,
    /// Earth of "Sky and Atmosphere rendering: A physical approach", as printed.
    SkyArticle,
    /// Reference: molecules only, black ground, solar irradiance 1.
    ReferenceRayleigh,
    /// Reference: molecules only, ground albedo 0.3, solar irradiance 1.
    ReferenceRayleighAlbedo03,
    /// Reference: Bruneton's Earth at 680, 550 and 440 nm.
    ReferenceEarthDemo,
    /// Reference: Bruneton's comparison of clear-sky models (2017), 40 wavelengths.
    ReferenceCsm,
}

named! { Preset, "an atmosphere", [
    ("clear", (Clear), "Earth on a clear day: aerosol optical depth 0.05 at 550 nm"),
    ("average", (Average), "Earth on an average day: aerosol optical depth 0.12 at 550 nm"),
    ("hazy", (Hazy), "Earth on a hazy day: aerosol optical depth 0.35 at 550 nm"),
    ("wildfire", (Wildfire), "Earth under the smoke of forest fires: smoke optical depth 4 at 550 nm"),
    ("mars", (Mars), "Mars on a moderately dusty day: dust optical depth 0.5 at 880 nm"),
    ("dust-storm", (DustStorm), "Mars in a planet-encircling dust storm: dust optical depth 8.5 at 880 nm"),
    ("venus", (Venus), "Venus below its clouds: optical depth 35"),
    ("titan", (Titan), "Titan below its haze: optical depth 8 at 550 nm"),
    ("bruneton", (Bruneton), "Earth of Bruneton's Precomputed Atmospheric Scattering (2017), spectral"),
    ("hillaire", (Hillaire), "Earth of Hillaire's Scalable and Production Ready Sky (2020), red, green and blue"),
    ("sky-article", (SkyArticle), "Earth of \"Sky and Atmosphere rendering: A physical approach\", as printed"),
    ("reference-rayleigh", (ReferenceRayleigh), "Reference: molecules only, black ground, solar irradiance 1"),
    ("reference-rayleigh-albedo-0.3", (ReferenceRayleighAlbedo03), "Reference: molecules only, ground albedo 0.3, solar irradiance 1"),
    ("reference-earth-demo", (ReferenceEarthDemo), "Reference: Bruneton's Earth at 680, 550 and 440 nm"),
    ("reference-csm", (ReferenceCsm), "Reference: Bruneton's comparison of clear-sky models (2017), 40 wavelengths"),
] }

impl Preset {
    /// The atmosphere.
    pub fn atmosphere(self) -> Atmosphere {
        match self {
            Self::Clear => earth::clear(),
            Self::Average => earth::average(),
            Self::Hazy => earth::hazy(),
            Self::Wildfire => wildfire::wildfire(),
            Self::Mars => mars::mars(),
            Self::DustStorm => mars::dust_storm(),
            Self::Venus => venus::venus(),
            Self::Titan => titan::titan(),
            Self::Bruneton => published::bruneton(),
            Self::Hillaire => published::hillaire(),
            Self::SkyArticle => published::sky_article(),
            Self::ReferenceRayleigh => reference::rayleigh(0.0),
            Self::ReferenceRayleighAlbedo03 => reference::rayleigh(0.3),
            Self::ReferenceEarthDemo => reference::earth_demo(),
            Self::ReferenceCsm => reference::csm(),
        }
    }
}

impl From<Preset> for Atmosphere {
    fn from(preset: Preset) -> Self {
        preset.atmosphere()
    }
}

/// The atmosphere of the [`Preset`] with this name.
///
/// # Errors
/// [`UnknownName`] with all names and the most similar one.
pub fn preset(name: &str) -> Result<Atmosphere, UnknownName> {
    name.parse().map(Preset::atmosphere)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::ConstituentKind;
    use crate::names::Named;

    #[test]
    fn presets_are_valid_and_carry_their_names() {
        for &preset in Preset::ALL {
            let (name, description) = (preset.name(), preset.summary());
            let atmosphere = preset.atmosphere();
            atmosphere
                .validate()
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(
                name.starts_with(&atmosphere.name),
                "{name} is called {}",
                atmosphere.name
            );
            assert!(!description.is_empty() && !description.contains('\n'));
        }
    }

    #[test]
    fn unknown_names_list_the_presets() {
        let error = preset("claer").unwrap_err();
        assert_eq!(error.nearest.as_deref(), Some("clear"));
        let text = error.to_string();
        assert!(
            text.contains("try \"clear\"") && text.contains("mars"),
            "{text}"
        );
    }

    #[test]
    fn optical_depths_match_the_descriptions() {
        for (name, aerosol) in [
            ("clear", 0.05),
            ("average", 0.12),
            ("hazy", 0.35),
            ("wildfire", 4.0),
        ] {
            let earth = preset(name).unwrap();
            let ozone = earth
                .constituent(&ConstituentKind::Ozone)
                .unwrap()
                .optical_depth(0.0, 100e3, 550.0);
            let depth = earth.vertical_optical_depth(550.0);
            assert!(
                (depth - ozone - aerosol - 0.0973).abs() < 1e-3,
                "{name}: {depth}"
            );
            assert!((0.025..0.03).contains(&ozone), "{ozone}");
        }
    }
}
