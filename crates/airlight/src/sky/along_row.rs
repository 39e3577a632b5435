//! Light along view rays of one elevation, which share the places where the air is evaluated.

use super::block::SampleLight;
use super::view::View;
use glam::DVec3;

/// Light along a view ray, one entry per wavelength of the sky's grid.
#[derive(Clone, Debug, PartialEq)]
pub struct RowRay {
    /// Air between the eye and each of the distances.
    pub paths: Vec<RowPath>,
    /// Radiance of the whole ray with the ground at its end, without the sun's disc, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<f32>,
}

/// Air between the eye and a point.
#[derive(Clone, Debug, PartialEq)]
pub struct RowPath {
    /// Transmittance.
    pub transmittance: Vec<f32>,
    /// Path radiance, W m^-2 sr^-1 nm^-1.
    pub path_radiance: Vec<f32>,
}

impl View {
    /// Light along unit vectors of one elevation, up to each of the increasing distances `distances_m` (m; what is beyond the end of a ray
    /// counts as its end) and of whole rays: [`View::along`] at the cost of evaluating the air for one of the directions.
    pub fn along_row(&self, directions: &[DVec3], distances_m: &[f64]) -> Vec<RowRay> {
        let solar = self.solar_irradiance();
        let lit = |sample: &SampleLight| -> Vec<f32> {
            sample.path[0]
                .iter()
                .zip(&solar)
                .map(|(l, e)| l * e)
                .collect()
        };
        let path = |sample: &SampleLight| RowPath {
            transmittance: sample.depth.iter().map(|depth| (-depth).exp()).collect(),
            path_radiance: lit(sample),
        };
        let all = 0..self.sky().grid().len();
        let rays = self.samples_along_rays(directions, distances_m, &[], &all);
        let ray = |samples: Vec<SampleLight>| {
            let (whole, points) = samples.split_last().expect("the sample of the whole ray");
            RowRay {
                paths: points.iter().map(path).collect(),
                radiance: lit(whole),
            }
        };
        rays.into_iter().map(ray).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::atmosphere::Preset;
    use crate::axes;
    use crate::sky::{Sky, SkySettings, SunCoverage};
    use crate::spectrum::WavelengthGrid;
    use crate::transfer::medium_evaluations;

    /// Up to points, to the ground and to space, by day and in twilight.
    #[test]
    fn rays_of_a_row_are_those_of_the_view() {
        for (sun_deg, height_m) in [(20.0, 100.0), (-3.0, 8e3)] {
            let settings = SkySettings {
                suns: SunCoverage::near(sun_deg, height_m),
                altitudes: 12,
                ..Default::default()
            };
            let air = Preset::Hazy.atmosphere();
            let sky = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap();
            let view = sky.view(height_m, axes::direction(90.0, sun_deg));
            let mut evaluations = [0; 2];
            for elevation_deg in [-40.0, -4.0, 0.5, 30.0] {
                let directions = [95.0, 140.0, 270.0].map(|a| axes::direction(a, elevation_deg));
                let distances_m = [2e3, 3e4, f64::INFINITY];
                let before = medium_evaluations();
                let row = view.along_row(&directions, &distances_m);
                evaluations[0] += medium_evaluations() - before;
                for (ray, direction) in row.iter().zip(directions) {
                    let close = |got: &[f32], right: &[f32], limit: f32| {
                        let brightest = right.iter().fold(0.0f32, |a, b| a.max(*b));
                        let mut pairs = got.iter().zip(right);
                        assert!(
                            pairs.all(|(g, r)| (g - r).abs() < limit * brightest),
                            "sun {sun_deg}, elevation {elevation_deg}: {got:?}, {right:?}"
                        );
                    };
                    for (path, distance_m) in ray.paths.iter().zip(distances_m) {
                        let before = medium_evaluations();
                        let right = view.along(direction, Some(distance_m));
                        evaluations[1] += medium_evaluations() - before;
                        close(&path.transmittance, &right.transmittance, 1e-4);
                        close(&path.path_radiance, &right.path_radiance(), 3e-3);
                    }
                    let right = view.along(direction, None).radiance();
                    close(&ray.radiance, &right, 3e-3);
                }
            }
            assert!(2 * evaluations[0] < evaluations[1], "{evaluations:?}");
        }
    }
}
