//! Errors in TOML texts.

use crate::atmosphere::{AerosolError, AerosolTypeError, AtmosphereError, DensityError};
use crate::names::UnknownName;
use crate::optics::PhaseError;
use crate::spectrum::CurveError;

/// A problem in a TOML text, with its place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}, column {column}: {}{problem}", self.subject())]
#[non_exhaustive]
pub struct ConfigError {
    /// Line, counted from 1.
    pub line: usize,
    /// Column, counted from 1 in characters.
    pub column: usize,
    /// The key, such as `aerosol.phase.g`; empty if the text is not TOML.
    pub key: String,
    /// The problem.
    pub problem: Box<ConfigProblem>,
}

/// A problem with a key.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigProblem {
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(String),
    /// An unknown key.
    #[error("unknown key; expected one of {}{}", valid.join(", "), hint(nearest))]
    UnknownKey {
        /// The most similar key, if one is similar.
        nearest: Option<String>,
        /// The keys allowed.
        valid: Vec<String>,
    },
    /// An unknown name of a value, with the names of its set.
    #[error(transparent)]
    UnknownName(UnknownName),
    /// A name that is not among those allowed.
    #[error("expected one of {}, got \"{got}\"{}", valid.join(", "), hint(nearest))]
    UnknownValue {
        /// The name given.
        got: String,
        /// The most similar name, if one is similar.
        nearest: Option<String>,
        /// The names allowed.
        valid: Vec<String>,
    },
    /// A value of the wrong type.
    #[error("expected {expected}, got {got}")]
    WrongType {
        /// The type expected.
        expected: &'static str,
        /// The type given.
        got: &'static str,
    },
    /// A number out of range.
    #[error("expected {expected}, got {got}")]
    OutOfRange {
        /// The range.
        expected: &'static str,
        /// The number given.
        got: f64,
    },
    /// A required key is missing.
    #[error("expected {0}, got nothing")]
    Missing(&'static str),
    /// Two keys that exclude each other.
    #[error("expected only one of this key and {with}, got both")]
    Conflict {
        /// The other key.
        with: &'static str,
    },
    /// A key that has an effect only together with another.
    #[error("expected {with} together with this key, got this key alone")]
    Needs {
        /// The other key.
        with: &'static str,
    },
    /// A humidity for particles that take up no water.
    #[error(
        "expected an aerosol that takes up water, got particles that do not; try leaving this key out"
    )]
    Dry,
    /// An invalid table of samples.
    #[error("{0}")]
    Curve(CurveError),
    /// An invalid density profile.
    #[error("{0}")]
    Density(DensityError),
    /// An invalid phase function.
    #[error("{0}")]
    Phase(PhaseError),
    /// An invalid aerosol.
    #[error("{0}")]
    Aerosol(AerosolError),
    /// An invalid aerosol type or mixture.
    #[error("{0}")]
    AerosolType(AerosolTypeError),
    /// Values that are invalid in combination.
    #[error("{0}")]
    Atmosphere(AtmosphereError),
}

fn hint(nearest: &Option<String>) -> String {
    nearest
        .as_ref()
        .map_or(String::new(), |near| format!("; try \"{near}\""))
}

impl ConfigError {
    /// An error at a byte of the text.
    pub(crate) fn at(text: &str, byte: usize, key: String, problem: ConfigProblem) -> Self {
        let (line, column) = Self::place(text, byte);
        Self {
            line,
            column,
            key,
            problem: Box::new(problem),
        }
    }

    /// Line and column of a byte of a text, counted from 1, columns in characters.
    pub(crate) fn place(text: &str, byte: usize) -> (usize, usize) {
        let mut byte = byte.min(text.len());
        while !text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &text[..byte];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let column = before[line_start..].chars().count() + 1;
        (before.matches('\n').count() + 1, column)
    }

    fn subject(&self) -> String {
        match self.key.is_empty() {
            true => String::new(),
            false => format!("{}: ", self.key),
        }
    }
}
