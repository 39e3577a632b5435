//! [`SceneError`].

use super::input::Input;
use crate::atmosphere::AtmosphereError;
#[cfg(feature = "config")]
use crate::atmosphere::ConfigError;
use crate::control::Cancelled;
use crate::fog::FogError;
use crate::names::UnknownName;
use crate::optics::mie::MieError;
use crate::sky::SkyError;

/// Error of reading a scene or of computing its light.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// An invalid value of the scene.
    #[error("{key}: expected {expected}, got {got}{}", tip(try_instead))]
    Value {
        /// Key in a scene file, such as `air.ozone_du`.
        key: String,
        /// The values allowed.
        expected: String,
        /// The value given.
        got: String,
        /// What to try instead; may be empty.
        try_instead: String,
    },
    /// A value of the scene that another part of the library rejects.
    #[error("{key}: {problem}")]
    Refused {
        /// Key in a scene file.
        key: String,
        /// The reason.
        problem: String,
    },
    /// A text that is not TOML, or has unknown keys or values of the wrong type.
    #[cfg(feature = "config")]
    #[error(transparent)]
    Toml(#[from] ConfigError),
    /// An invalid value of a scene file, with its place.
    #[error("line {line}, column {column}: {error}")]
    At {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1 in characters.
        column: usize,
        /// The problem.
        error: Box<SceneError>,
    },
    /// An unknown name of a solver or published model.
    #[error("solver.name: {unknown}{}", feature_tip(unknown))]
    UnknownModel {
        /// The name, with the names of all solvers.
        unknown: UnknownName,
    },
    /// A value of the scene, the sun or the eye outside a model's domain.
    #[error("{model}: {problem}")]
    Model {
        /// Name of the model.
        model: &'static str,
        /// The reason.
        problem: String,
    },
    /// A spectral view of a model without spectra.
    #[error(
        "output.spectral: expected a solver with spectra, got {0}, which has colours only; try a picture in RGB"
    )]
    NoSpectra(&'static str),
    /// An input that the model would ignore.
    #[error(
        "{}: expected a solver that honours {input}, got {model}; try {}",
        input.key(),
        alternatives(honoured_by, "leaving it out, as no solver does")
    )]
    IgnoredInput {
        /// The input.
        input: Input,
        /// The model that ignores it.
        model: &'static str,
        /// Names of the models that honour it.
        honoured_by: Vec<&'static str>,
    },
    /// A variant that the model does not have.
    #[error(
        "solver.variant: expected a variant of {model}, got \"{got}\"; try {}",
        alternatives(variants, "leaving it out, as it has no variants")
    )]
    UnknownVariant {
        /// The variant requested.
        got: String,
        /// The model.
        model: &'static str,
        /// Its variants.
        variants: &'static [&'static str],
    },
    /// RGB channels in a number of lanes other than 3.
    #[error("channels: expected 3 lanes for red, green and blue, got {0}")]
    RgbLanes(usize),
    /// A first wavelength beyond the end of the sky's grid.
    #[error(
        "channels: expected a first wavelength with an index below {available}, the number of wavelengths of the sky, got {first}"
    )]
    Wavelengths {
        /// Index of the first wavelength.
        first: usize,
        /// Number of wavelengths of the grid.
        available: usize,
    },
    /// A limiting distance that is not positive.
    #[error(
        "limit of the distance: expected a number of metres above 0 (infinite: to the top of the air), got {0}"
    )]
    Distance(f64),
    /// An invalid atmosphere.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// An unknown name of an atmosphere.
    #[error("air.atmosphere: {0}; a file must end in .toml")]
    UnknownAtmosphere(UnknownName),
    /// An invalid fog.
    #[error(transparent)]
    Fog(#[from] FogError),
    /// Invalid droplets of a fog.
    #[error(transparent)]
    Droplets(#[from] MieError),
    /// An error of the sky solver.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// The caller cancelled the computation.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SceneError {
    /// [`SceneError::Value`] with key, values allowed, value given, and what to try (may be empty).
    pub(crate) fn value(
        key: impl Into<String>,
        expected: impl Into<String>,
        got: impl Into<String>,
        try_instead: impl Into<String>,
    ) -> Self {
        Self::Value {
            key: key.into(),
            expected: expected.into(),
            got: got.into(),
            try_instead: try_instead.into(),
        }
    }

    /// [`SceneError::Refused`] for a key.
    pub(crate) fn refused(key: impl Into<String>, problem: impl std::fmt::Display) -> Self {
        Self::Refused {
            key: key.into(),
            problem: problem.to_string(),
        }
    }

    /// [`SceneError::Model`] for a value outside a model's domain.
    pub(crate) fn model(model: &'static str, problem: impl std::fmt::Display) -> Self {
        Self::Model {
            model,
            problem: problem.to_string(),
        }
    }

    /// Whether the caller cancelled the computation.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Sky(SkyError::Cancelled(_))
                | Self::Fog(FogError::Cancelled(_))
                | Self::Droplets(MieError::Cancelled(_))
        )
    }

    /// The scene key that caused the error, such as `air.ozone_du`, if it is a single key.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Value { key, .. } | Self::Refused { key, .. } => Some(key),
            Self::IgnoredInput { input, .. } => Some(input.key()),
            Self::UnknownVariant { .. } => Some("solver.variant"),
            Self::UnknownModel { .. } => Some("solver.name"),
            Self::NoSpectra(_) => Some("output.spectral"),
            Self::UnknownAtmosphere(_) => Some("air.atmosphere"),
            Self::At { error, .. } => error.key(),
            _ => None,
        }
    }
}

/// "; try ...", or nothing for an empty suggestion.
fn tip(try_instead: &str) -> String {
    match try_instead {
        "" => String::new(),
        tip => format!("; try {tip}"),
    }
}

/// "a", "a or b", "a, b or c"; `none` for an empty list.
fn alternatives(names: &[&str], none: &str) -> String {
    match names {
        [] => none.to_owned(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// How to enable a model that needs a feature.
fn feature_tip(unknown: &UnknownName) -> &'static str {
    match unknown.name.as_str() {
        "hosek-wilkie" => "; try a build with the feature hosek-wilkie",
        _ => "",
    }
}
