//! What a model is prepared from.

use crate::atmosphere::Atmosphere;
use crate::spectrum::WavelengthGrid;

/// A scene in the terms of the physics: what [`RadianceModel::prepare`](super::RadianceModel::prepare) reads.
#[derive(Clone, Debug)]
pub struct ResolvedScene {
    /// The air over the ground.
    pub atmosphere: Atmosphere,
    /// Wavelengths to compute, for models without wavelengths of their own.
    pub grid: WavelengthGrid,
    /// Altitude of the eye above sea level, m.
    pub observer_altitude_m: f64,
}
