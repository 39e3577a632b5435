//! Polarised radiance.

use super::estimate::{Estimate, Measured, Sample, Tally};
use super::solver::{BUNDLE, MonteCarlo, Scene};
use super::stokes::Stokes;
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::optics::plane_of_polarisation_deg;
use glam::DVec3;

/// Mean over the paths of a bundle, at each wavelength, W m^-2 sr^-1 nm^-1.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PolarisedSample {
    /// Radiance with scalar light transport, by order of scattering.
    pub scalar: Sample,
    /// Stokes parameters `I`, `Q` and `U`.
    pub stokes: [Vec<f64>; 3],
}

/// Stokes parameters along a view ray, W m^-2 sr^-1 nm^-1, at each wavelength of the grid, without the direct light of the
/// sun's disc.
///
/// `Q` is positive for light polarised in the vertical plane through the view ray (for a vertical ray, in the north-south
/// plane), `U` for light polarised at 45 degrees from there, anticlockwise as seen by the eye. Circular polarisation is
/// traced, because it turns into linear polarisation, but not returned: it is far weaker.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PolarisedEstimate {
    /// Radiance `I`.
    pub intensity: Measured,
    /// Stokes parameter `Q`.
    pub q: Measured,
    /// Stokes parameter `U`.
    pub u: Measured,
    /// Degree of linear polarisation, `sqrt(Q^2 + U^2) / I`. Noise biases it upwards by about half its variance divided by the
    /// degree.
    pub degree: Measured,
    /// Angle of the plane of polarisation from the vertical plane, anticlockwise as seen by the eye, degrees in `[0, 180)`;
    /// meaningless unless the degree is well above its standard error.
    pub angle_deg: Measured,
    /// Effect of polarisation on the radiance: `I` minus the scalar radiance on the same paths, with a much smaller error than
    /// either.
    pub effect: Measured,
    /// Radiance with scalar light transport on the same paths, as from [`MonteCarlo::radiance`].
    pub scalar: Estimate,
    /// Number of paths.
    pub paths: u64,
}

impl MonteCarlo {
    /// Polarised radiance along `view`, or polarised path radiance if a distance in m is given; parameters as for
    /// [`MonteCarlo::radiance`] and [`MonteCarlo::path_radiance`]. Takes a third longer than these if only molecules polarise.
    ///
    /// Molecules and spheres from Lorenz-Mie theory polarise the light that they scatter
    /// ([`crate::optics::PhaseFunction::matrix_ratios`]); constituents known only by their phase function, and the ground,
    /// scatter without polarisation. Sunlight is unpolarised.
    pub fn polarised(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: Option<f64>,
    ) -> PolarisedEstimate {
        self.polarised_with(eye_altitude_m, sun, view, distance_m, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`MonteCarlo::polarised`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn polarised_with(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<PolarisedEstimate, Cancelled> {
        let bundles = self.settings().paths.div_ceil(BUNDLE as u64).max(2);
        let scene = self.scene(eye_altitude_m, sun, view, distance_m);
        let samples = parallel::try_map(bundles as usize, |bundle| {
            control.check()?;
            Ok(self.polarised_bundle(scene, bundle as u64))
        })?;
        Ok(PolarisedEstimate::of(&samples, self.grid().len()))
    }

    /// Result of one bundle of paths, as [`MonteCarlo::sample`].
    pub fn sample_polarised(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: Option<f64>,
        bundle: u64,
    ) -> PolarisedSample {
        let scene = self.scene(eye_altitude_m, sun, view, distance_m);
        self.polarised_bundle(scene, bundle)
    }

    fn polarised_bundle(&self, scene: Option<Scene>, bundle: u64) -> PolarisedSample {
        let dark = || vec![0.0; self.grid().len()];
        let Some(scene) = scene else {
            return PolarisedSample {
                scalar: std::array::from_fn(|_| dark()),
                stokes: std::array::from_fn(|_| dark()),
            };
        };
        let (mut scalar, mut stokes) =
            self.bundle_of::<Stokes<4>, Stokes<8>, Stokes<16>>(&scene, bundle);
        for part in scalar.iter_mut().chain(&mut stokes) {
            for (value, solar) in part.iter_mut().zip(self.grid().solar_irradiance()) {
                *value *= solar;
            }
        }
        PolarisedSample { scalar, stokes }
    }
}

impl PolarisedEstimate {
    /// The radiance `I` with its orders of scattering, which are those of scalar light.
    pub fn radiance(self) -> Estimate {
        Estimate {
            mean: self.intensity.mean,
            standard_error: self.intensity.standard_error,
            ..self.scalar
        }
    }

    /// Statistics of independent samples. Standard errors of quantities that are not linear in the samples are first-order.
    fn of(samples: &[PolarisedSample], wavelengths: usize) -> Self {
        let mut tally = Tally::new(wavelengths);
        samples.iter().for_each(|sample| tally.add(&sample.scalar));
        let paths = samples.len() as u64 * BUNDLE as u64;
        let scalar = tally.estimate(&vec![1.0; wavelengths], paths);
        let measured = |of: &dyn Fn(&PolarisedSample, usize) -> f64| -> Measured {
            let mut measured = Measured::default();
            for lane in 0..wavelengths {
                let (mean, error) = moments(samples.iter().map(|sample| of(sample, lane)));
                measured.mean.push(mean);
                measured.standard_error.push(error);
            }
            measured
        };
        let [intensity, q, u] = [0, 1, 2].map(|i| measured(&|s, lane| s.stokes[i][lane]));
        let effect = measured(&|s, lane| {
            s.stokes[0][lane] - s.scalar.iter().map(|order| order[lane]).sum::<f64>()
        });
        let linear = |lane: usize| q.mean[lane].hypot(u.mean[lane]);
        let intensity_of = |lane: usize| intensity.mean[lane];
        // Linearised change of the degree and the angle of the mean with a sample.
        let mut degree = measured(&|s, lane| match (linear(lane), intensity_of(lane)) {
            (p, i) if p > 0.0 && i > 0.0 => {
                let along =
                    (q.mean[lane] * s.stokes[1][lane] + u.mean[lane] * s.stokes[2][lane]) / p;
                (along - p / i * s.stokes[0][lane]) / i
            }
            _ => 0.0,
        });
        let mut angle_deg = measured(&|s, lane| match linear(lane) {
            p if p > 0.0 => {
                let across = q.mean[lane] * s.stokes[2][lane] - u.mean[lane] * s.stokes[1][lane];
                (0.5 * across / (p * p)).to_degrees()
            }
            _ => 0.0,
        });
        for lane in 0..wavelengths {
            degree.mean[lane] = match intensity_of(lane) > 0.0 {
                true => linear(lane) / intensity_of(lane),
                false => 0.0,
            };
            angle_deg.mean[lane] = plane_of_polarisation_deg(q.mean[lane], u.mean[lane]);
        }
        Self {
            intensity,
            q,
            u,
            degree,
            angle_deg,
            effect,
            scalar,
            paths,
        }
    }
}

/// Mean and standard error of the mean.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|v| (v - mean).powi(2)).sum();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}
