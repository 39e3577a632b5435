//! Why the light of a scene cannot be computed.

use super::Input;
use crate::fog::FogError;

/// Why the light of a scene cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
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
    /// The fog is refused.
    #[error(transparent)]
    Fog(#[from] FogError),
}

/// "a", "a or b", "a, b or c"; `none` where there is no name.
fn alternatives(names: &[&str], none: &str) -> String {
    match names {
        [] => none.to_owned(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
