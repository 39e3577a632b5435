//! [`ColourFit`]: colours from the four wavelengths of sky tables.

use crate::wavelengths::{WAVELENGTHS_NM, wavelength_grid};
use airlight::atmosphere::Atmosphere;
use airlight::glam::DVec3;
use airlight::sky::{Scattering, Sky, SkyError, SkySettings, View};
use airlight::spectrum::WavelengthGrid;
use std::f64::consts::{FRAC_PI_2, PI};

/// What fits the weights from four wavelengths to colours for each height of the eye and sun: an atmosphere's singly scattered light,
/// at four wavelengths and at sixteen, which takes no time to solve for.
#[derive(Clone, Debug)]
pub struct ColourFit {
    few: Sky,
    many: Sky,
}

/// Azimuths from the sun of the directions of the fit, in half turns.
const AZIMUTHS: [f64; 4] = [0.05, 0.25, 0.6, 1.0];
/// Elevations above and below the horizon, as parts of the way to the zenith or the limb, and to the nadir.
const ABOVE: [f64; 6] = [0.005, 0.03, 0.1, 0.3, 0.6, 0.95];
const BELOW: [f64; 2] = [-0.02, -0.2];
/// Powers of the wavelength by which light of further orders differs from that scattered once.
const TILTS: [f64; 4] = [-0.8, -0.4, 0.0, 0.4];
/// Least ratio of the radiances at the first and the last wavelength of ground that sunlight lights more than the sky.
const LEAST_BLUE: f32 = 0.2;
/// Least light of a direction, relative to the brightest.
const FAINTEST: f32 = 0.01;
/// Weight of light whose spectrum is the sun's, relative to that of one direction.
const SUNLIGHT: f64 = 10.0;

impl ColourFit {
    /// The fit of an atmosphere.
    ///
    /// # Errors
    /// [`SkyError`] for an invalid atmosphere.
    pub fn new(atmosphere: &Atmosphere) -> Result<Self, SkyError> {
        let settings = SkySettings {
            scattering: Scattering::Single,
            ..Default::default()
        };
        Ok(Self {
            few: Sky::prepare(atmosphere, &wavelength_grid(), &settings)?,
            many: Sky::prepare(atmosphere, &WavelengthGrid::standard(), &settings)?,
        })
    }

    /// XYZ, in cd/m^2, of a radiance equal to the solar irradiance at one of the four wavelengths: least squares of the relative error
    /// over the singly scattered light of the view, also tilted in wavelength, the light of the ground, and light of the sun's spectrum.
    pub(crate) fn xyz_weights(&self, view: &View) -> [[f64; 3]; 4] {
        let altitude_m = view.radius_m() - self.few.atmosphere().planet.radius_m;
        let [few, many] =
            [&self.few, &self.many].map(|sky| sky.view(altitude_m, *view.sun_state()));
        let mut fit = LeastSquares::default();
        let tilted = |view: &View, light: &[f32], tilt: f64| -> Vec<f32> {
            let wavelengths = view.sky().grid().wavelengths_nm().iter();
            let tilts = wavelengths.map(|nm| (nm / 550.0).powf(tilt) as f32);
            light.iter().zip(tilts).map(|(l, t)| l * t).collect()
        };
        let mut add = |[light_few, light_many]: [&[f32]; 2], tilt: f64, weight: f64| {
            let solar = few.solar_irradiance();
            let light = tilted(&few, light_few, tilt);
            let response: [f64; 4] = std::array::from_fn(|k| f64::from(light[k] / solar[k]));
            let light = tilted(&many, light_many, tilt);
            fit.add(response, self.many.grid().to_xyz(&light), weight);
        };
        let solar = [few.solar_irradiance(), many.solar_irradiance()];
        add([&solar[0], &solar[1]], 0.0, SUNLIGHT);
        let rays: Vec<_> = directions(view)
            .map(|direction| [&few, &many].map(|view| view.along(direction, None)))
            .collect();
        let brightest = rays
            .iter()
            .map(|[few, _]| few.single[1])
            .fold(0.0, f32::max);
        for light in rays {
            // Light out of the planet's shadow is too faint to matter, and its colour extreme.
            if light[0].single[1] < FAINTEST * brightest {
                continue;
            }
            for tilt in TILTS {
                add([&light[0].single, &light[1].single], tilt, 1.0);
            }
            // Under a low sun the ground gets its light from the sky.
            let ground = &light[0].ground;
            if light[0].meets_ground && ground[0] > LEAST_BLUE * ground[3] {
                add([&light[0].ground, &light[1].ground], 0.0, 1.0);
                let all = light.map(|light| light.radiance());
                add([&all[0], &all[1]], 0.0, 1.0);
            }
        }
        fit.solved()
    }
}

/// Directions over the part of a view in which there is air.
fn directions(view: &View) -> impl Iterator<Item = DVec3> {
    let (_, top_radius_m) = view.bounds_m();
    let horizon = view.horizon_elevation_rad();
    let highest = match view.radius_m() >= top_radius_m {
        true => -(top_radius_m / view.radius_m()).acos(),
        false => FRAC_PI_2,
    };
    let sun = view.sun();
    let towards = DVec3::new(sun.x, 0.0, sun.z).normalize_or(DVec3::X);
    let across = DVec3::new(-towards.z, 0.0, towards.x);
    AZIMUTHS.into_iter().flat_map(move |azimuth| {
        let (sin, cos) = (PI * azimuth).sin_cos();
        let level = towards * cos + across * sin;
        ABOVE.into_iter().chain(BELOW).map(move |part| {
            let end = if part > 0.0 { highest } else { -FRAC_PI_2 };
            let elevation = horizon + (end - horizon) * part.abs();
            level * elevation.cos() + DVec3::Y * elevation.sin()
        })
    })
}

/// Linear least squares: XYZ of a response at four wavelengths.
#[derive(Default)]
struct LeastSquares {
    normal: [[f64; WAVELENGTHS_NM.len()]; 4],
    right: [[f64; 3]; 4],
}

impl LeastSquares {
    /// Adds a spectrum, whose errors count relative to its luminance. A spectrum without light is ignored.
    fn add(&mut self, response: [f64; 4], xyz: [f64; 3], weight: f64) {
        if xyz[1] <= 0.0 {
            return;
        }
        let scale = weight / (xyz[1] * xyz[1]);
        for i in 0..4 {
            for j in 0..4 {
                self.normal[i][j] += scale * response[i] * response[j];
            }
            for c in 0..3 {
                self.right[i][c] += scale * response[i] * xyz[c];
            }
        }
    }

    /// The solution, by elimination with pivots.
    fn solved(self) -> [[f64; 3]; 4] {
        let (mut a, mut b) = (self.normal, self.right);
        for k in 0..4 {
            let pivot = (k..4).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()));
            let pivot = pivot.unwrap_or(k);
            a.swap(k, pivot);
            b.swap(k, pivot);
            for i in 0..4 {
                if i != k && a[k][k] != 0.0 {
                    let factor = a[i][k] / a[k][k];
                    for j in 0..4 {
                        a[i][j] -= factor * a[k][j];
                    }
                    for c in 0..3 {
                        b[i][c] -= factor * b[k][c];
                    }
                }
            }
        }
        std::array::from_fn(|k| b[k].map(|v| if a[k][k] == 0.0 { 0.0 } else { v / a[k][k] }))
    }
}
