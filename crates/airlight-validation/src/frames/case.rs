//! The cases that are compared, and what can fail in one.

use airlight::Cancelled;
use airlight::axes;
use airlight::glam::DVec3;
use airlight::scene::SceneError;
use airlight::sky::SkyError;
use airlight_gpu::SkyRendererError;
use airlight_gpu::headless::HeadlessError;

/// Elevations of the sun, degrees.
pub const SUNS_DEG: [f64; 9] = [60.0, 30.0, 10.0, 5.0, 2.0, 0.0, -2.0, -4.0, -6.0];
/// Heights of the eye above sea level, m.
pub const HEIGHTS_M: [f64; 4] = [2.0, 3e3, 1e4, 4e5];
/// Names of the atmospheres, after [`crate::skies::truth_air`].
pub const AIRS: [&str; 4] = ["clear", "average", "hazy", "desert"];

/// An atmosphere, a sun and an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Name of the atmosphere, after [`crate::skies::truth_air`].
    pub air: &'static str,
    /// Elevation of the sun, degrees.
    pub sun_deg: f64,
    /// Height of the eye above sea level, m.
    pub height_m: f64,
}

impl Case {
    /// All atmospheres, suns and heights.
    pub fn all() -> Vec<Self> {
        AIRS.into_iter().flat_map(Self::in_air).collect()
    }

    /// All suns and heights in an atmosphere.
    pub fn in_air(air: &'static str) -> impl Iterator<Item = Self> {
        SUNS_DEG.into_iter().flat_map(move |sun_deg| {
            HEIGHTS_M.map(|height_m| Self {
                air,
                sun_deg,
                height_m,
            })
        })
    }

    /// Unit vector towards the sun.
    pub(super) fn sun(&self) -> DVec3 {
        axes::direction(SUN_AZIMUTH_DEG, self.sun_deg)
    }
}

/// Azimuth of the sun in all cases, degrees.
pub(super) const SUN_AZIMUTH_DEG: f64 = 140.0;

/// Error of a comparison of frames.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FramesError {
    /// No device to draw with, or a device that is lost.
    #[error(transparent)]
    Device(#[from] HeadlessError),
    /// The renderer refused an atmosphere or a place.
    #[error(transparent)]
    Renderer(#[from] SkyRendererError),
    /// The solver refused it.
    #[error(transparent)]
    Solver(#[from] SkyError),
    /// A published model refused it.
    #[error(transparent)]
    Published(#[from] SceneError),
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
