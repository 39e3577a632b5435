//! Light of sun and sky on surfaces at the eye.

use airlight::axes;
use airlight::sky::{SkyTable, View};

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
    pub fn of(view: &View<'_>, table: &SkyTable, luminance: impl Fn(&[f32]) -> f64) -> Self {
        let sun_normal_lx = view.sky().grid().to_xyz(&view.sun_irradiance())[1];
        Self {
            sun_normal_lx,
            sun_horizontal_lx: sun_normal_lx * view.sun().y.max(0.0),
            sky_horizontal_lx: luminance(&sky_irradiance(table)),
        }
    }
}

/// Irradiance of the sky on a horizontal surface, channel by channel: the table's radiance times the cosine, summed
/// over the upper half of the sphere at the middles of rings half a degree high and of steps of 2 degrees in azimuth.
pub fn sky_irradiance(table: &SkyTable) -> Vec<f32> {
    const RINGS: u32 = 180;
    const STEPS: u32 = 180;
    let mut sum = vec![0.0f64; table.channels()];
    let mut radiance = vec![0.0; table.channels()];
    for ring in 0..RINGS {
        let (low, high) = (f64::from(ring) / f64::from(RINGS), f64::from(ring + 1) / f64::from(RINGS));
        // Integral of sin(e) cos(e) over the ring: half the step of sin^2.
        let sine2 = |part: f64| (0.5 * std::f64::consts::PI * part).sin().powi(2);
        let weight = 0.5 * (sine2(high) - sine2(low)) * std::f64::consts::TAU / f64::from(STEPS);
        for step in 0..STEPS {
            let azimuth = (f64::from(step) + 0.5) * 360.0 / f64::from(STEPS);
            table.sample(axes::direction(azimuth, 45.0 * (low + high)), &mut radiance);
            for (sum, value) in sum.iter_mut().zip(&radiance) {
                *sum += weight * f64::from(*value);
            }
        }
    }
    sum.iter().map(|&v| v as f32).collect()
}
