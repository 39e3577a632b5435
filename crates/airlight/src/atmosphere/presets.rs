//! Named atmospheres, ready to use.

pub(crate) mod earth;
mod fixed_table;
pub(crate) mod mars;
pub mod published;
pub mod reference;

pub use earth::{Earth, average, clear, hazy};
pub use mars::mars;

use super::Atmosphere;
use crate::names::{UnknownName, named};

/// An atmosphere that is ready to use, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Preset {
    /// Earth on a clear day: aerosol optical depth 0.05 at 550 nm.
    Clear,
    /// Earth on an average day: aerosol optical depth 0.12 at 550 nm.
    Average,
    /// Earth on a hazy day: aerosol optical depth 0.35 at 550 nm.
    Hazy,
    /// Mars on a moderately dusty day: dust optical depth 0.5 at 880 nm.
    Mars,
    /// Earth of Bruneton's precomputed scattering (2017), spectral.
    Bruneton,
    /// Earth of Hillaire's production sky (2020), red, green and blue.
    Hillaire,
    /// Earth of "Sky and Atmosphere rendering: A physical approach", as printed.
    SkyArticle,
    /// Reference: air molecules alone over black ground, unit sun.
    ReferenceRayleigh,
    /// Reference: air molecules alone over ground of albedo 0.3, unit sun.
    ReferenceRayleighAlbedo03,
    /// Reference: Bruneton's Earth at 680, 550 and 440 nm.
    ReferenceEarthDemo,
    /// Reference: the comparison of clear-sky models (2017), 40 wavelengths.
    ReferenceCsm,
}

named! { Preset, "an atmosphere", [
    ("clear", (Clear), "Earth on a clear day: aerosol optical depth 0.05 at 550 nm"),
    ("average", (Average), "Earth on an average day: aerosol optical depth 0.12 at 550 nm"),
    ("hazy", (Hazy), "Earth on a hazy day: aerosol optical depth 0.35 at 550 nm"),
    ("mars", (Mars), "Mars on a moderately dusty day: dust optical depth 0.5 at 880 nm"),
    ("bruneton", (Bruneton), "Earth of Bruneton's precomputed scattering (2017), spectral"),
    ("hillaire", (Hillaire), "Earth of Hillaire's production sky (2020), red, green and blue"),
    ("sky-article", (SkyArticle), "Earth of \"Sky and Atmosphere rendering: A physical approach\", as printed"),
    ("reference-rayleigh", (ReferenceRayleigh), "Reference: air molecules alone over black ground, unit sun"),
    ("reference-rayleigh-albedo-0.3", (ReferenceRayleighAlbedo03), "Reference: air molecules alone over ground of albedo 0.3, unit sun"),
    ("reference-earth-demo", (ReferenceEarthDemo), "Reference: Bruneton's Earth at 680, 550 and 440 nm"),
    ("reference-csm", (ReferenceCsm), "Reference: the comparison of clear-sky models (2017), 40 wavelengths"),
] }

impl Preset {
    /// The atmosphere.
    pub fn atmosphere(self) -> Atmosphere {
        match self {
            Self::Clear => earth::clear(),
            Self::Average => earth::average(),
            Self::Hazy => earth::hazy(),
            Self::Mars => mars::mars(),
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

/// The atmosphere of a name: that of [`Preset`].
///
/// # Errors
/// [`UnknownName`], which lists the names and the nearest one.
pub fn preset(name: &str) -> Result<Atmosphere, UnknownName> {
    name.parse().map(Preset::atmosphere)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::ConstituentKind;

    #[test]
    fn every_preset_is_valid_and_bears_its_name() {
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
        for (name, aerosol) in [("clear", 0.05), ("average", 0.12), ("hazy", 0.35)] {
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
