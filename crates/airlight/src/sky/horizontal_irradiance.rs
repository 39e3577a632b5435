//! Irradiance of horizontal surfaces at the eye.

use super::between_azimuths::BetweenAzimuths;
use super::block::TableRow;
use super::view::View;
use crate::axes;
use crate::math::parallel;
use crate::math::rings::rings;
use std::f64::consts::{FRAC_PI_2, PI};

impl View {
    /// Diffuse downwelling irradiance at the eye: that of a horizontal surface that faces up, without the sun's disc, one value per
    /// wavelength of the sky's grid, W m^-2 nm^-1.
    ///
    /// As [`SkyTable::irradiance`](super::SkyTable::irradiance) of a table of all wavelengths to 0.1 % (tested), without the
    /// tabulation, which takes ten times as long.
    pub fn downwelling_irradiance(&self) -> Vec<f32> {
        let (_, top_m) = self.bounds_m();
        // There is no light from above outside the air.
        let is_inside = self.radius_m() < top_m;
        let spans: &[_] = if is_inside { &[(0.0, FRAC_PI_2)] } else { &[] };
        self.horizontal_irradiance(spans)
    }

    /// Upwelling irradiance at the eye: that of a horizontal surface that faces down, by ground and air, as
    /// [`View::downwelling_irradiance`].
    pub fn upwelling_irradiance(&self) -> Vec<f32> {
        let horizon = self.horizon_elevation_rad();
        let (_, top_m) = self.bounds_m();
        let limb = -(top_m / self.radius_m()).min(1.0).acos();
        self.horizontal_irradiance(&[(horizon, -FRAC_PI_2), (horizon, limb)])
    }

    /// Irradiance by the light between elevations, each from one at which the light changes fast to another, rad.
    fn horizontal_irradiance(&self, spans: &[(f64, f64)]) -> Vec<f32> {
        /// Number of elevations on each side of the sun, and of steps from the sun's azimuth to the opposite one.
        const NODES: usize = 16;
        const STEPS: usize = 64;
        let between = BetweenAzimuths::halfway(STEPS);
        let sun_rad = axes::elevation_rad(self.sun());
        let rings = spans.iter().map(|&span| rings(span, sun_rad, NODES));
        let rings: Vec<_> = rings.flatten().collect();
        let azimuths_rad: Vec<f64> = (0..=STEPS).map(|k| PI * k as f64 / STEPS as f64).collect();
        let light = parallel::map(rings.len(), |index| {
            let ring = &rings[index];
            let row = TableRow::new(self, ring.elevation_rad, &azimuths_rad);
            let projected = (ring.solid_angle * ring.elevation_rad.sin().abs()) as f32;
            let blocks = self.sky().blocks().iter();
            let light = blocks.flat_map(|block| block.mean_over_azimuth(&row, &between, ring));
            light.map(|mean| mean * projected).collect::<Vec<f32>>()
        });
        let mut irradiance = self.solar_irradiance();
        for (wavelength, irradiance) in irradiance.iter_mut().enumerate() {
            *irradiance *= light.iter().map(|ring| ring[wavelength]).sum::<f32>();
        }
        irradiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::{AerosolLoad, AerosolMixture, AerosolType, Atmosphere, presets};
    use crate::sky::{Sky, SkySettings, SkyTable, SunCoverage, TableChannels};
    use crate::spectrum::WavelengthGrid;
    use glam::DVec3;
    use std::f64::consts::TAU;

    /// The average air with desert dust, whose aureole is a few degrees wide.
    fn dusty() -> Atmosphere {
        let mut air = presets::preset("average").unwrap();
        let heights = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
        let load = Some(AerosolLoad::OpticalDepth550(0.3));
        let dust = AerosolMixture::of(AerosolType::Desert, AerosolMixture::USUAL_HUMIDITY).unwrap();
        let dust = dust.constituent(load, None, air.clear_air(), heights.0, heights.1);
        air.put(dust.unwrap());
        air
    }

    /// Irradiance of a surface that faces up (`side` = 1) or down (-1): the sum over 600 elevations and 1440 azimuths of a table of 4
    /// channels.
    fn finely_summed(table: &SkyTable, side: f64) -> Vec<f64> {
        const ELEVATIONS: usize = 600;
        const AZIMUTHS: usize = 1440;
        let mut sum = vec![0.0; 4];
        let mut radiance = [0.0; 4 * AZIMUTHS];
        for row in 0..ELEVATIONS {
            let elevation_deg = side * 90.0 * (row as f64 + 0.5) / ELEVATIONS as f64;
            let azimuth_deg = |k| 360.0 * (k as f64 + 0.5) / AZIMUTHS as f64;
            let ring: Vec<DVec3> = (0..AZIMUTHS)
                .map(|k| axes::direction(azimuth_deg(k), elevation_deg))
                .collect();
            table.samples(&ring, &mut radiance);
            let (sin, cos) = elevation_deg.to_radians().sin_cos();
            let projected =
                side * sin * cos * FRAC_PI_2 / ELEVATIONS as f64 * TAU / AZIMUTHS as f64;
            for radiance in radiance.chunks_exact(4) {
                for (sum, radiance) in sum.iter_mut().zip(radiance) {
                    *sum += projected * f64::from(*radiance);
                }
            }
        }
        sum
    }

    /// A view and its table.
    fn tabulated(air: &Atmosphere, eye_m: f64, sun_deg: f64) -> (View, SkyTable) {
        let grid = WavelengthGrid::from_wavelengths_nm(vec![380.0, 450.0, 550.0, 700.0]).unwrap();
        let settings = SkySettings {
            suns: SunCoverage::near(sun_deg, eye_m),
            ..SkySettings::default()
        };
        let sky = Sky::prepare(air, &grid, &settings).unwrap();
        let view = sky.view(eye_m, axes::direction(70.0, sun_deg));
        let table = view.table(TableChannels::Spectral);
        (view, table)
    }

    #[test]
    fn it_is_the_sum_over_all_directions() {
        for air in [presets::preset("average").unwrap(), dusty()] {
            for (eye_m, sun_deg) in [
                (2.0, 60.0),
                (2.0, 88.0),
                (2.0, 10.0),
                (2.0, 1.0),
                (2.0, -5.0),
                (9e3, 30.0),
            ] {
                let (view, table) = tabulated(&air, eye_m, sun_deg);
                let place = format!("{} {eye_m} {sun_deg}", air.name);
                for (side, found) in [
                    (1.0, view.downwelling_irradiance()),
                    (-1.0, view.upwelling_irradiance()),
                ] {
                    let exact = finely_summed(&table, side);
                    let of_table = table.irradiance(side * DVec3::Y);
                    for ((found, of_table), exact) in found.iter().zip(&of_table).zip(&exact) {
                        let errors = [found, of_table].map(|e| f64::from(*e) / exact - 1.0);
                        let within = errors[0].abs() < 3e-4 && errors[1].abs() < 5e-4;
                        assert!(within, "{place}, side {side}: {errors:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn nothing_shines_from_above_outside_the_air() {
        let (view, table) = tabulated(&presets::preset("clear").unwrap(), 4e5, 40.0);
        assert_eq!(view.downwelling_irradiance(), vec![0.0; 4]);
        assert_eq!(table.irradiance(DVec3::Y), vec![0.0; 4]);
    }
}
