//! [`Illuminances`] by sun and sky at the eye.

use airlight::scene::RadianceView;

/// Illuminances at the eye, lx.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illuminances {
    /// Illuminance by the sun's disc on a surface that faces it.
    pub sun_normal_lx: f64,
    /// Illuminance by the sun's disc on a horizontal surface.
    pub sun_horizontal_lx: f64,
    /// Illuminance by the sky on a horizontal surface, without the sun's disc.
    pub sky_horizontal_lx: f64,
}

impl Illuminances {
    /// Illuminances of a view.
    pub fn of(view: &dyn RadianceView) -> Self {
        let mut values = vec![0.0; view.channel_count()];
        view.sun_irradiance(&mut values);
        let sun_normal_lx = view.luminance(&values);
        view.horizontal_irradiance(&mut values);
        Self {
            sun_normal_lx,
            sun_horizontal_lx: sun_normal_lx * view.sun().y.max(0.0),
            sky_horizontal_lx: view.luminance(&values),
        }
    }
}
