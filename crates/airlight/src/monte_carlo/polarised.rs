//! Light with its polarisation.

use super::estimate::{Estimate, Measured, Sample, Tally};
use super::solver::{BUNDLE, MonteCarlo, Scene};
use super::stokes::Stokes;
use crate::math::parallel;
use glam::DVec3;

/// What the paths of a bundle found, one value a wavelength, W m^-2 sr^-1 nm^-1.
#[derive(Clone, Debug, PartialEq)]
pub struct PolarisedSample {
    /// As if light were scalar, by order of scattering.
    pub scalar: Sample,
    /// Stokes parameters `I`, `Q` and `U`.
    pub stokes: [Vec<f64>; 3],
}

/// Stokes parameters along a line of sight, W m^-2 sr^-1 nm^-1, one value a wavelength of the grid; without the sun's own disc.
///
/// `Q` is positive for light polarised in the vertical plane through the line of sight (where the line is vertical, in that of
/// north and south), `U` for light polarised at 45 degrees from there, anticlockwise as the eye sees it. Circular polarisation
/// is followed, as it turns into linear, but not told: it is far weaker.
#[derive(Clone, Debug, PartialEq)]
pub struct PolarisedEstimate {
    /// `I`, the radiance.
    pub intensity: Measured,
    /// `Q`.
    pub q: Measured,
    /// `U`.
    pub u: Measured,
    /// Degree of linear polarisation, `sqrt(Q^2 + U^2) / I`. Noise makes it too great: by about half its standard error
    /// squared over itself.
    pub degree: Measured,
    /// Angle of the plane of polarisation from the vertical plane, anticlockwise as the eye sees it, degrees in `[0, 180)`; of
    /// no meaning where the degree is not well above its standard error.
    pub angle_deg: Measured,
    /// What polarisation adds to the radiance: `I` less the scalar radiance on the same paths. Known far better than both.
    pub effect: Measured,
    /// As if light were scalar, on the same paths: what [`MonteCarlo::radiance`] finds.
    pub scalar: Estimate,
    /// Paths followed.
    pub paths: u64,
}

impl MonteCarlo {
    /// As [`MonteCarlo::radiance`], or with a distance (m) [`MonteCarlo::path_radiance`], with the polarisation of light; it
    /// takes a third longer where molecules alone polarise.
    ///
    /// Molecules and spheres known by Lorenz-Mie theory polarise what they scatter
    /// ([`crate::optics::PhaseFunction::matrix_ratios`]); constituents of which a phase function is all that is known, and the ground,
    /// scatter without polarisation. Sunlight has none.
    pub fn polarised(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: Option<f64>,
    ) -> PolarisedEstimate {
        let bundles = self.settings().paths.div_ceil(BUNDLE as u64).max(2);
        let scene = self.scene(eye_altitude_m, sun, view, distance_m);
        let samples = parallel::map(bundles as usize, |bundle| {
            self.polarised_bundle(scene, bundle as u64)
        });
        PolarisedEstimate::of(&samples, self.grid().len())
    }

    /// What one bundle of paths finds of it: as [`MonteCarlo::sample`].
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
    /// From independent samples. Errors of what is not linear in them are those of its linear part.
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
        let polarised = |lane: usize| q.mean[lane].hypot(u.mean[lane]);
        let whole = |lane: usize| intensity.mean[lane];
        // How the degree and the angle of the mean change with a sample.
        let mut degree = measured(&|s, lane| match (polarised(lane), whole(lane)) {
            (p, i) if p > 0.0 && i > 0.0 => {
                let along =
                    (q.mean[lane] * s.stokes[1][lane] + u.mean[lane] * s.stokes[2][lane]) / p;
                (along - p / i * s.stokes[0][lane]) / i
            }
            _ => 0.0,
        });
        let mut angle_deg = measured(&|s, lane| match polarised(lane) {
            p if p > 0.0 => {
                let across = q.mean[lane] * s.stokes[2][lane] - u.mean[lane] * s.stokes[1][lane];
                (0.5 * across / (p * p)).to_degrees()
            }
            _ => 0.0,
        });
        for lane in 0..wavelengths {
            degree.mean[lane] = match whole(lane) > 0.0 {
                true => polarised(lane) / whole(lane),
                false => 0.0,
            };
            let angle = 0.5 * u.mean[lane].atan2(q.mean[lane]).to_degrees();
            // A second time for what the first rounds up to 180.
            angle_deg.mean[lane] = angle.rem_euclid(180.0).rem_euclid(180.0);
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

/// Mean and its standard error.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|v| (v - mean).powi(2)).sum();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}
