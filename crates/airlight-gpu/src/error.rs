//! [`SkyRendererError`].

use airlight::fog::FogError;
use airlight::sky::SkyError;
use airlight_shaders::{FogTablesError, SkyTablesError};
use glam::Mat4;
use std::fmt::Debug;

/// Error of [`SkyRenderer`](crate::SkyRenderer).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkyRendererError {
    /// The sky cannot be solved.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// The tables cannot be filled.
    #[error(transparent)]
    Tables(#[from] SkyTablesError),
    /// The fog is invalid.
    #[error(transparent)]
    Fog(#[from] FogError),
    /// The tables of the fog cannot be filled.
    #[error(transparent)]
    FogTables(#[from] FogTablesError),
    /// The fog has another profile.
    #[error(
        "expected fog with an exponential or clamped profile, or a layer with two edges, got another profile; try a high layer for \
         uniform fog, which lets no light in from above"
    )]
    FogProfile,
    /// No layer of fog, or more of different density profiles than there may be.
    #[error("expected 1 to {most} layers of fog of different density profiles, got {count}")]
    FogLayers {
        /// Number of density profiles.
        count: usize,
        /// [`MOST_FOG_LAYERS`](crate::MOST_FOG_LAYERS).
        most: usize,
    },
    /// More lights than a fog can hold.
    #[error("expected at most {most} lights in fog, got {count}; try the nearest and brightest")]
    TooManyLights {
        /// Number of lights.
        count: usize,
        /// [`MOST_LIGHTS`](crate::MOST_LIGHTS).
        most: usize,
    },
    /// A kind of light that the shaders do not have.
    #[error("expected point, spot and sphere lights")]
    LightKind,
    /// Lights in a fog that is not a single exponential layer.
    #[error(
        "expected a single exponential layer of fog around lights, got another fog; try the fog without lights"
    )]
    LightProfile,
    /// The device is lost.
    #[error(
        "expected a device that can draw, got one that is lost; try SkyRenderer::recreate with another"
    )]
    DeviceLost,
    /// The target cannot be blended.
    #[error(
        "expected a target format that the device can blend, got {0:?}; try TextureFormat::Rgba16Float"
    )]
    Format(wgpu::TextureFormat),
    /// The faces of an environment map cannot have this size.
    #[error("expected faces with a power of two from 8 to 2048 texels on a side, got {0}")]
    EnvironmentSide(u32),
    /// The heights are none.
    #[error(
        "expected 2 to 8192 posts a side, 0.01 m to 100 km apart, and heights from 0 to 32 km, got {0}"
    )]
    HeightField(String),
    /// The height of the eye is not a number.
    #[error("expected a finite height of the eye, got {0} m")]
    Height(f64),
    /// A number of the sun, or of the moon, is out of range.
    #[error("expected {expected} of the sun or the moon, got {got}")]
    Source {
        /// The number and its range.
        expected: &'static str,
        /// What it is.
        got: f64,
    },
    /// A number of a [`Camera`](crate::Camera), of [`ToneSettings`](crate::ToneSettings), of a [`ShadowMap`](crate::ShadowMap) or of a
    /// [`TerrainView`](crate::TerrainView) is out of range.
    #[error("expected {expected}, got {got}")]
    OutOfRange {
        /// The number, whose it is, and its range.
        expected: &'static str,
        /// What it is.
        got: String,
    },
    /// The direction to the sun, or to the moon, has no length.
    #[error("expected a direction to the sun or the moon, got {0}")]
    Sun(airlight::glam::DVec3),
}

/// Refuses a number that does not hold what is expected of it.
pub(crate) fn require(
    holds: bool,
    expected: &'static str,
    got: &dyn Debug,
) -> Result<(), SkyRendererError> {
    match holds {
        true => Ok(()),
        false => Err(SkyRendererError::OutOfRange {
            expected,
            got: format!("{got:?}"),
        }),
    }
}

/// Whether a matrix maps space to all of space.
pub(crate) fn is_invertible(matrix: &Mat4) -> bool {
    let determinant = matrix.as_dmat4().determinant();
    determinant.is_finite() && determinant != 0.0
}
