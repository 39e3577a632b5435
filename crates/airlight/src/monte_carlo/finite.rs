//! View rays that end at a distance: path radiance and transmittance.

use super::chord::{Chord, HalfLine};
use super::estimate::Estimate;
use super::solver::MonteCarlo;
use crate::control::{Cancelled, Control};
use glam::DVec3;

impl MonteCarlo {
    /// Path radiance: light of all orders, including light reflected by the ground, scattered into the view ray within
    /// `distance_m` of the eye (m; infinity for a ray to space). The radiance of what lies at the end, an object or the ground,
    /// is not included. With [`MonteCarlo::transmittance`] `T` and this `S`, an object of radiance `L` appears as `T L + S`.
    ///
    /// Parameters as for [`MonteCarlo::radiance`]; 0 if the distance is not above 0.
    pub fn path_radiance(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: f64,
    ) -> Estimate {
        self.path_radiance_with(eye_altitude_m, sun, view, distance_m, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`MonteCarlo::path_radiance`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn path_radiance_with(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: f64,
        control: Control<'_>,
    ) -> Result<Estimate, Cancelled> {
        let scene = self.scene(eye_altitude_m, sun, view, Some(distance_m));
        self.mean_over_paths(scene, control)
    }

    /// Path radiance from one bundle of paths, as [`MonteCarlo::sample`] for the whole ray.
    pub fn sample_path(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: f64,
        bundle: u64,
    ) -> Vec<Vec<f64>> {
        let scene = self.scene(eye_altitude_m, sun, view, Some(distance_m));
        self.sunlit_bundle(scene, bundle).into()
    }

    /// Transmittance at each wavelength of the grid from the eye to `distance_m` along `view` (infinity: to space), or to the
    /// ground if that is nearer. Deterministic: Gauss quadrature, to 1e-6 of the optical depth.
    pub fn transmittance(&self, eye_altitude_m: f64, view: DVec3, distance_m: f64) -> Vec<f64> {
        let grid = self.grid().wavelengths_nm();
        // The transmittance does not depend on the sun.
        let Some(scene) = self.scene(eye_altitude_m, DVec3::Y, view, Some(distance_m)) else {
            return vec![1.0; grid.len()];
        };
        let line = HalfLine::new(scene.line.place, scene.line.direction);
        let mut chord = Chord::default();
        chord.cross(&self.layers, line);
        chord.cut(
            &self.layers,
            line.start + scene.line.reach_m.unwrap_or(f64::INFINITY),
        );
        let columns = chord.true_columns(&self.layers);
        let depth = |nm: f64| -> f64 {
            let parts = self.atmosphere().constituents.iter().zip(columns);
            parts
                .map(|(part, column)| part.extinction_per_m(nm) * column)
                .sum()
        };
        grid.iter().map(|&nm| (-depth(nm)).exp()).collect()
    }
}
