//! Atmospheres ready to use, by name.

pub mod earth;
mod fixed_table;
pub mod mars;
pub mod published;
pub mod reference;

use super::{Atmosphere, nearest::nearest};

/// One line of the list of presets.
struct Preset {
    name: &'static str,
    description: &'static str,
    build: fn() -> Atmosphere,
}

/// The presets in the order to list them in.
const PRESETS: [Preset; 11] = [
    Preset {
        name: "clear",
        description: "Earth on a clear day: aerosol optical depth 0.05 at 550 nm",
        build: earth::clear,
    },
    Preset {
        name: "average",
        description: "Earth on an average day: aerosol optical depth 0.12 at 550 nm",
        build: earth::average,
    },
    Preset {
        name: "hazy",
        description: "Earth on a hazy day: aerosol optical depth 0.35 at 550 nm",
        build: earth::hazy,
    },
    Preset {
        name: "mars",
        description: "Mars on a moderately dusty day: dust optical depth 0.5 at 880 nm",
        build: mars::mars,
    },
    Preset {
        name: "bruneton",
        description: "Earth of Bruneton's precomputed scattering (2017), spectral",
        build: published::bruneton,
    },
    Preset {
        name: "hillaire",
        description: "Earth of Hillaire's production sky (2020), red, green and blue",
        build: published::hillaire,
    },
    Preset {
        name: "sky-article",
        description: "Earth of \"Sky and Atmosphere rendering: A physical approach\", as printed",
        build: published::sky_article,
    },
    Preset {
        name: "reference-rayleigh",
        description: "Reference: air molecules alone over black ground, unit sun",
        build: || reference::rayleigh(0.0),
    },
    Preset {
        name: "reference-rayleigh-albedo-0.3",
        description: "Reference: air molecules alone over ground of albedo 0.3, unit sun",
        build: || reference::rayleigh(0.3),
    },
    Preset {
        name: "reference-earth-demo",
        description: "Reference: Bruneton's Earth at 680, 550 and 440 nm",
        build: reference::earth_demo,
    },
    Preset {
        name: "reference-csm",
        description: "Reference: the comparison of clear-sky models (2017), 40 wavelengths",
        build: reference::csm,
    },
];

/// There is no preset of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no atmosphere called \"{name}\"{}; there are: {}", self.hint(), self.names())]
pub struct UnknownPreset {
    /// The name asked for.
    pub name: String,
    /// The name it may have been meant to be.
    pub nearest: Option<&'static str>,
}

impl UnknownPreset {
    fn hint(&self) -> String {
        self.nearest
            .map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"))
    }

    fn names(&self) -> String {
        PRESETS.map(|preset| preset.name).join(", ")
    }
}

/// The atmosphere of a name.
///
/// # Errors
/// [`UnknownPreset`], which lists the names there are and the nearest one.
pub fn preset(name: &str) -> Result<Atmosphere, UnknownPreset> {
    match PRESETS.iter().find(|preset| preset.name == name) {
        Some(preset) => Ok((preset.build)()),
        None => Err(UnknownPreset {
            name: name.to_owned(),
            nearest: nearest(name, PRESETS.iter().map(|preset| preset.name)),
        }),
    }
}

/// Name and one-line description of each preset.
pub fn preset_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    PRESETS
        .iter()
        .map(|preset| (preset.name, preset.description))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::ConstituentKind;

    #[test]
    fn every_preset_is_valid_and_bears_its_name() {
        for (name, description) in preset_names() {
            let atmosphere = preset(name).unwrap();
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
    fn unknown_names_get_help() {
        let error = preset("claer").unwrap_err();
        assert_eq!(error.nearest, Some("clear"));
        let text = error.to_string();
        assert!(
            text.contains("did you mean \"clear\"") && text.contains("mars"),
            "{text}"
        );
    }

    #[test]
    fn earths_have_the_optical_depths_they_state() {
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
