//! Types that most programs need: `use airlight::prelude::*;`.

pub use crate::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Preset};
pub use crate::axes;
pub use crate::control::Control;
pub use crate::fog::{DirectionalLight, Fog, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
pub use crate::monte_carlo::{MonteCarlo, MonteCarloSettings};
pub use crate::names::Named;
pub use crate::optics::PhaseFunction;
pub use crate::scene::{Channels, RadianceModel, RadianceView, RgbFoggySky, Scene};
pub use crate::sky::{RgbView, Sky, SkySettings, SunCoverage, View};
pub use crate::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid};
#[cfg(feature = "ephemeris")]
pub use crate::sun::{Moment, Place, sun_position};
pub use crate::transfer::RgbPathOptics;
pub use glam::DVec3;
