//! Lines of sight that end at a distance: what the air adds before a thing there, and what it leaves of its light.

use super::chord::{Chord, HalfLine};
use super::estimate::{Estimate, Sample};
use super::solver::MonteCarlo;
use glam::DVec3;

impl MonteCarlo {
    /// Path radiance: light that the air scatters into the line of sight within `distance_m` of the eye (m; infinite: up to
    /// space), all orders, that of the ground's light too. What lies at the end is not seen, neither a thing nor the ground,
    /// where the line ends at the latest. With [`MonteCarlo::transmittance`] `T` and this `S`, a thing of the radiance `L` is seen as
    /// `T L + S`.
    ///
    /// Everything else as [`MonteCarlo::radiance`] has it; nothing is scattered into a distance that is not above 0.
    pub fn path_radiance(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: f64,
    ) -> Estimate {
        self.mean_over_paths(self.scene(eye_altitude_m, sun, view, Some(distance_m)))
    }

    /// What one bundle of paths finds of it: as [`MonteCarlo::sample`] of the whole line.
    pub fn sample_path(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        distance_m: f64,
        bundle: u64,
    ) -> Sample {
        let scene = self.scene(eye_altitude_m, sun, view, Some(distance_m));
        self.sunlit_bundle(scene, bundle)
    }

    /// Transmittance at each wavelength of the grid from the eye to `distance_m` along `view` (infinite: to space), or to the
    /// ground where that is nearer. No random numbers: Gauss's rule, to 1e-6 of the optical depth.
    pub fn transmittance(&self, eye_altitude_m: f64, view: DVec3, distance_m: f64) -> Vec<f64> {
        let grid = self.grid().wavelengths_nm();
        // Any sun does.
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
