//! Values that are written by their name: `#[serde(with = "named")]` on an `Option`.

use crate::fog::FogScattering;
use crate::fog::droplets::DropletKind;
use crate::optics::mie::droplets::Drops;
use crate::sky::Scattering;
use crate::spectrum::RgbSpace;

/// A value that has a name.
pub(super) trait Named: Copy + PartialEq + 'static {
    /// All values with their names.
    fn all() -> Vec<(&'static str, Self)>;

    /// The value of a name.
    fn of_name(name: &str) -> Option<Self> {
        Self::all()
            .into_iter()
            .find(|(known, _)| *known == name)
            .map(|(_, value)| value)
    }
}

impl Named for FogScattering {
    fn all() -> Vec<(&'static str, Self)> {
        vec![
            ("all", Self::Multiple),
            ("single", Self::Single),
            ("undimmed", Self::Undimmed),
        ]
    }
}

impl Named for Scattering {
    fn all() -> Vec<(&'static str, Self)> {
        vec![("all", Self::All), ("single", Self::Single)]
    }
}

impl Named for RgbSpace {
    fn all() -> Vec<(&'static str, Self)> {
        vec![
            ("srgb", Self::Srgb),
            ("rec2020", Self::Rec2020),
            ("acescg", Self::AcesCg),
        ]
    }
}

impl Named for DropletKind {
    fn all() -> Vec<(&'static str, Self)> {
        DropletKind::all().collect()
    }

    fn of_name(name: &str) -> Option<Self> {
        match name {
            "mist" => Some(Drops::ModerateRadiationFog.into()),
            _ => DropletKind::all()
                .find(|(known, _)| *known == name)
                .map(|(_, value)| value),
        }
    }
}

pub(super) fn serialize<T: Named, S: serde::Serializer>(
    value: &Option<T>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let name = value.and_then(|value| T::all().into_iter().find(|(_, known)| *known == value));
    match name {
        Some((name, _)) => serializer.serialize_some(name),
        None => serializer.serialize_none(),
    }
}

pub(super) fn deserialize<'de, T: Named, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    use serde::de::{Deserialize, Error};
    let Some(name) = Option::<String>::deserialize(deserializer)? else {
        return Ok(None);
    };
    let unknown = || {
        // As serde words it for enums.
        let names: Vec<String> = T::all()
            .iter()
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        D::Error::custom(format!(
            "unknown variant `{name}`, expected one of {}",
            names.join(", ")
        ))
    };
    T::of_name(&name).ok_or_else(unknown).map(Some)
}
