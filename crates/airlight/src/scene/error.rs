//! Why the light of a scene cannot be computed.

use super::input::Input;
use crate::atmosphere::AtmosphereError;
#[cfg(feature = "config")]
use crate::atmosphere::ConfigError;
use crate::fog::FogError;
use crate::names::UnknownName;
use crate::optics::mie::MieError;
use crate::sky::SkyError;

/// Why a scene is refused, or its light cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A value of the scene.
    #[error("{key}: expected {expected}, got {got}{}", tip(try_instead))]
    Value {
        /// Its key in a scene file, such as `air.ozone_du`.
        key: String,
        /// What would be right.
        expected: String,
        /// What was given.
        got: String,
        /// What to try instead; empty where that is plain.
        try_instead: String,
    },
    /// A value of the scene that another part of the library refuses.
    #[error("{key}: {problem}")]
    Refused {
        /// Its key in a scene file.
        key: String,
        /// Why.
        problem: String,
    },
    /// A text that is not TOML, or has keys or values that a scene does not have.
    #[cfg(feature = "config")]
    #[error(transparent)]
    Toml(#[from] ConfigError),
    /// A value of a scene file, with its place.
    #[error("line {line}, column {column}: {error}")]
    At {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1 in characters.
        column: usize,
        /// What is wrong.
        error: Box<SceneError>,
    },
    /// There is no solver or published model of a name.
    #[error("solver.name: {unknown}{}", feature_tip(unknown))]
    UnknownModel {
        /// The name, with the names of all solvers.
        unknown: UnknownName,
    },
    /// A model refuses a value of the scene, the sun or the eye.
    #[error("{model}: {problem}")]
    Model {
        /// Name of the model.
        model: &'static str,
        /// Why.
        problem: String,
    },
    /// A spectral view of a model that knows colours only.
    #[error(
        "output.spectral: expected a solver with spectra, got {0}, which knows colours only; try a picture in RGB"
    )]
    NoSpectra(&'static str),
    /// An input that the model would ignore.
    #[error(
        "{}: expected a solver that honours {input}, got {model}; try {}",
        input.key(),
        alternatives(honoured_by, "leaving it out, as no solver does")
    )]
    IgnoredInput {
        /// Which input.
        input: Input,
        /// The model that ignores it.
        model: &'static str,
        /// Names of the models that honour it.
        honoured_by: Vec<&'static str>,
    },
    /// A variant that the model does not have.
    #[error(
        "solver.variant: expected a variant of {model}, got \"{got}\"; try {}",
        alternatives(variants, "leaving it out, as it has one form only")
    )]
    UnknownVariant {
        /// The variant requested.
        got: String,
        /// The model.
        model: &'static str,
        /// Its variants.
        variants: &'static [&'static str],
    },
    /// RGB has three lanes.
    #[error("red, green and blue are 3 lanes, got room for {0}")]
    RgbLanes(usize),
    /// Wavelengths asked for that the sky's grid does not have.
    #[error(
        "the sky was solved at {available} wavelengths: there is none to start from at place {first}"
    )]
    Wavelengths {
        /// Which was to be the first, counted from 0.
        first: usize,
        /// How many there are.
        available: usize,
    },
    /// A distance that is none.
    #[error(
        "the farthest distance must be above 0 m (or infinite: to the end of the air), got {0} m"
    )]
    Distance(f64),
    /// The atmosphere is refused.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// There is no atmosphere of that name.
    #[error("air.atmosphere: {0}; a file must end in .toml")]
    UnknownAtmosphere(UnknownName),
    /// The fog is refused.
    #[error(transparent)]
    Fog(#[from] FogError),
    /// The fog's droplets are refused.
    #[error(transparent)]
    Droplets(#[from] MieError),
    /// The solver refuses the scene.
    #[error(transparent)]
    Sky(#[from] SkyError),
}

impl SceneError {
    /// A value of the scene: its key, what would be right, what was given, and what to try (or nothing).
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

    /// A value of the scene that another part of the library refuses.
    pub(crate) fn refused(key: impl Into<String>, problem: impl std::fmt::Display) -> Self {
        Self::Refused {
            key: key.into(),
            problem: problem.to_string(),
        }
    }

    /// A value that a model refuses.
    pub(crate) fn model(model: &'static str, problem: impl std::fmt::Display) -> Self {
        Self::Model {
            model,
            problem: problem.to_string(),
        }
    }

    /// Whether the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Sky(SkyError::Cancelled(_)))
    }

    /// The key of the scene that is wrong, such as `air.ozone_du`, where it is one.
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

/// "; try ...", where there is something to try.
fn tip(try_instead: &str) -> String {
    match try_instead {
        "" => String::new(),
        tip => format!("; try {tip}"),
    }
}

/// "a", "a or b", "a, b or c"; `none` where there is no name.
fn alternatives(names: &[&str], none: &str) -> String {
    match names {
        [] => none.to_owned(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// What may have been meant, or how to get it.
fn feature_tip(unknown: &UnknownName) -> &'static str {
    match unknown.name.as_str() {
        "hosek-wilkie" => "; try a build with the feature hosek-wilkie",
        _ => "",
    }
}
