//! [`Illuminances`] by sun and sky at the eye.

use airlight::scene::RadianceView;

/// Illuminances at the eye, lx.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illuminances {
    /// Illuminance by the sun's disc on a surface that faces it.
    pub sun_normal_lx: f64,
    /// Illuminance by the sun's disc on a horizontal surface.
    pub sun_horizontal_lx: f64,
    /// Illuminance by the sky on a horizontal surface, without the discs of sun and moon and without single stars.
    pub sky_horizontal_lx: f64,
    /// Illuminance by the moon's disc on a surface that faces it; `None` without a moon.
    pub moon_normal_lx: Option<f64>,
    /// Illuminance by the moon's disc on a horizontal surface; `None` without a moon.
    pub moon_horizontal_lx: Option<f64>,
}

impl Illuminances {
    /// Illuminances of a view.
    pub fn of(view: &dyn RadianceView) -> Self {
        let mut values = vec![0.0; view.channel_count()];
        let mut direct = |source: &dyn RadianceView| {
            source.sun_irradiance(&mut values);
            let normal_lx = source.luminance(&values).max(0.0);
            (normal_lx, normal_lx * source.sun().y.max(0.0))
        };
        let (sun_normal_lx, sun_horizontal_lx) = direct(view);
        let moon = view.moon().map(|moon| direct(moon.as_ref()));
        view.horizontal_irradiance(&mut values);
        Self {
            sun_normal_lx,
            sun_horizontal_lx,
            // Above the air, where a solver's rounding has either sign, there is no sky.
            sky_horizontal_lx: view.luminance(&values).max(0.0),
            moon_normal_lx: moon.map(|(normal_lx, _)| normal_lx),
            moon_horizontal_lx: moon.map(|(_, horizontal_lx)| horizontal_lx),
        }
    }

    /// Illuminance by all light on a horizontal surface.
    pub fn horizontal_lx(&self) -> f64 {
        self.sun_horizontal_lx + self.sky_horizontal_lx + self.moon_horizontal_lx.unwrap_or(0.0)
    }
}
