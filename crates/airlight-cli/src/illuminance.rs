//! Light of sun and sky on surfaces at the eye.

use airlight::sky::{SkyTable, View};
use glam::DVec3;

/// Illuminances at the eye, lx.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illuminances {
    /// Of the sun's disc on a surface that faces it.
    pub sun_normal_lx: f64,
    /// Of the sun's disc on a horizontal surface.
    pub sun_horizontal_lx: f64,
    /// Of the sky on a horizontal surface, the sun's disc left out.
    pub sky_horizontal_lx: f64,
}

impl Illuminances {
    /// Of a view; `luminance` makes cd/m^2 of the table's channels.
    pub fn of(view: &View, table: &SkyTable, luminance: impl Fn(&[f32]) -> f64) -> Self {
        let sun_normal_lx = view.sky().grid().to_xyz(&view.sun_irradiance())[1];
        Self {
            sun_normal_lx,
            sun_horizontal_lx: sun_normal_lx * view.sun().y.max(0.0),
            sky_horizontal_lx: luminance(&table.irradiance(DVec3::Y)),
        }
    }

    /// The same in fog that lets a part of the sun's disc through, under a sky that sheds `sky_horizontal_lx`.
    pub fn through(self, transmittance: f64, sky_horizontal_lx: f64) -> Self {
        Self {
            sun_normal_lx: self.sun_normal_lx * transmittance,
            sun_horizontal_lx: self.sun_horizontal_lx * transmittance,
            sky_horizontal_lx,
        }
    }
}
