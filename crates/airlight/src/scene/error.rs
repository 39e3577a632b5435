//! Why sky and fog cannot be put together.

use crate::fog::FogError;

/// Why sky and fog cannot be put together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
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
