//! What is asked of the numbers of a lamp.

pub(super) use crate::fog::layer::check_light as light;

use crate::fog::layer::FogError;
use glam::DVec3;

/// A position is finite.
pub(super) fn position(position: DVec3) -> Result<(), FogError> {
    match position.is_finite() {
        true => Ok(()),
        false => Err(FogError::Number {
            what: "every coordinate of a lamp's position (m)",
            got: position
                .to_array()
                .into_iter()
                .find(|c| !c.is_finite())
                .unwrap_or(f64::NAN),
            right: "finite",
        }),
    }
}

/// A radius is above 0.
pub(super) fn radius(radius_m: f64) -> Result<(), FogError> {
    match radius_m > 0.0 && radius_m.is_finite() {
        true => Ok(()),
        false => Err(FogError::Number {
            what: "the radius of a lamp (m)",
            got: radius_m,
            right: "finite and above 0",
        }),
    }
}
