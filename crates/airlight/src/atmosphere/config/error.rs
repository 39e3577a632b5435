//! What can be wrong with a written atmosphere.

use crate::atmosphere::{AerosolError, AerosolTypeError, AtmosphereError, DensityError};
use crate::names::UnknownName;
use crate::optics::PhaseError;
use crate::spectrum::CurveError;

/// What is wrong, where, and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}, column {column}: {}{problem}", self.subject())]
pub struct ConfigError {
    /// Line of the text, counted from 1.
    pub line: usize,
    /// Column, counted from 1 in characters.
    pub column: usize,
    /// The key, as `aerosol.phase.g`; empty where the text is no TOML.
    pub key: String,
    /// What is wrong with it.
    pub problem: Box<ConfigProblem>,
}

/// What is wrong with a key.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigProblem {
    /// The text is no TOML.
    #[error("{0}")]
    Syntax(String),
    /// There is no such key.
    #[error("no such key{}; the keys here are {}", hint(nearest), valid.join(", "))]
    UnknownKey {
        /// The key it may have been meant to be.
        nearest: Option<String>,
        /// The keys there are.
        valid: Vec<String>,
    },
    /// A name that does not exist.
    #[error(transparent)]
    UnknownName(UnknownName),
    /// A value that is not among those there are.
    #[error("expected one of {}, got \"{got}\"{}", valid.join(", "), hint(nearest))]
    UnknownValue {
        /// The value given.
        got: String,
        /// The value it may have been meant to be.
        nearest: Option<String>,
        /// The values there are.
        valid: Vec<String>,
    },
    /// A value of the wrong type.
    #[error("must be {expected}, got {got}")]
    WrongType {
        /// What would be right.
        expected: &'static str,
        /// The type given.
        got: &'static str,
    },
    /// A number out of its domain.
    #[error("must be {expected}, got {got}")]
    OutOfRange {
        /// What would be right.
        expected: &'static str,
        /// The number given.
        got: f64,
    },
    /// Something is needed that is not there.
    #[error("is missing: {0}")]
    Missing(&'static str),
    /// Two keys that exclude each other.
    #[error("cannot stand beside {with}: keep one of them")]
    Conflict {
        /// The other key.
        with: &'static str,
    },
    /// A key that says nothing without another.
    #[error("says nothing without {with}")]
    Needs {
        /// The other key.
        with: &'static str,
    },
    /// Humidity of particles that take up no water.
    #[error("makes no difference to these particles, which take up no water: leave it out")]
    Dry,
    /// A table of samples is refused.
    #[error("{0}")]
    Curve(CurveError),
    /// A density profile is refused.
    #[error("{0}")]
    Density(DensityError),
    /// A phase function is refused.
    #[error("{0}")]
    Phase(PhaseError),
    /// An aerosol is refused.
    #[error("{0}")]
    Aerosol(AerosolError),
    /// An aerosol of a type is refused.
    #[error("{0}")]
    AerosolType(AerosolTypeError),
    /// The whole is refused.
    #[error("{0}")]
    Atmosphere(AtmosphereError),
}

fn hint(nearest: &Option<String>) -> String {
    nearest
        .as_ref()
        .map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"))
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
