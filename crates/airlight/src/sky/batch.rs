//! Many directions at once, into slices.
//!
//! Values are interleaved: those of one direction are next to each other, in the order of the directions. All calls use all
//! threads and give the same bits as one direction at a time.

use super::view::View;
use crate::math::parallel;
use crate::math::slices::check_length;
use glam::DVec3;

impl View {
    /// Radiance along the unit vectors `directions`, W m^-2 sr^-1 nm^-1, to the ground or to space, without the sun's disc:
    /// [`View::along`] and [`LineOfSight::radiance`](super::LineOfSight::radiance). `out` is `[direction][wavelength]`.
    ///
    /// # Panics
    /// Where `out` has another length.
    pub fn radiances(&self, directions: &[DVec3], out: &mut [f32]) {
        self.each(directions, out, |direction, out| {
            out.copy_from_slice(&self.along(direction, None).radiance());
        });
    }

    /// Transmittance and path radiance (W m^-2 sr^-1 nm^-1) between the eye and the points `distances_m` away (infinite: to the
    /// ground or to space) along the unit vectors `directions`: [`View::along`]. Both outputs are `[direction][wavelength]`.
    ///
    /// # Panics
    /// Where a slice has another length.
    pub fn paths(
        &self,
        directions: &[DVec3],
        distances_m: &[f64],
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let (count, width) = (directions.len(), self.sky().grid().len());
        check_length(distances_m, count);
        check_length(transmittance, count * width);
        check_length(path_radiance, count * width);
        let lines = parallel::map(count, |i| self.along(directions[i], Some(distances_m[i])));
        let outputs = transmittance
            .chunks_exact_mut(width)
            .zip(path_radiance.chunks_exact_mut(width));
        for (line, (transmittance, path_radiance)) in lines.iter().zip(outputs) {
            transmittance.copy_from_slice(&line.transmittance);
            path_radiance.copy_from_slice(&line.path_radiance());
        }
    }

    /// Transmittance from the eye to space along the unit vectors `directions`; 0 where the planet is in the way. `out` is
    /// `[direction][wavelength]`.
    ///
    /// # Panics
    /// Where `out` has another length.
    pub fn transmittances_to_space(&self, directions: &[DVec3], out: &mut [f32]) {
        self.each(directions, out, |direction, out| {
            out.copy_from_slice(&self.transmittance_to_space(direction));
        });
    }

    /// Radiance of the sun's disc as it arrives along the unit vectors `directions`, W m^-2 sr^-1 nm^-1; zero outside the disc
    /// and where the planet hides it. `out` is `[direction][wavelength]`.
    ///
    /// # Panics
    /// Where `out` has another length.
    pub fn sun_disc_radiances(&self, directions: &[DVec3], out: &mut [f32]) {
        self.each(directions, out, |direction, out| {
            out.copy_from_slice(&self.sun_disc_radiance(direction));
        });
    }

    fn each(
        &self,
        directions: &[DVec3],
        out: &mut [f32],
        fill: impl Fn(DVec3, &mut [f32]) + Send + Sync,
    ) {
        let width = self.sky().grid().len();
        check_length(out, directions.len() * width);
        parallel::for_each_chunk(out, width, |index, out| fill(directions[index], out));
    }
}

#[cfg(test)]
mod tests {
    use crate::atmosphere::reference;
    use crate::axes;
    use crate::sky::{Sky, SkySettings, SunCoverage, TableChannels, View};
    use crate::spectrum::{RgbSpace, WavelengthGrid};
    use glam::DVec3;

    fn view() -> View {
        let settings = SkySettings {
            suns: SunCoverage::near(10.0, 0.0),
            altitudes: 6,
            ..Default::default()
        };
        let grid = WavelengthGrid::rgb();
        let sky = Sky::prepare(&reference::earth_demo(), &grid, &settings).unwrap();
        sky.view(500.0, axes::direction(120.0, 10.0))
    }

    /// Above, below and at the horizon, and into the sun.
    fn directions() -> Vec<DVec3> {
        (0..600)
            .map(|k| axes::direction(0.7 * f64::from(k), 90.0 - 0.3 * f64::from(k)))
            .chain([axes::direction(120.0, 10.0)])
            .collect()
    }

    #[test]
    fn batches_are_the_single_calls() {
        let (view, directions) = (view(), directions());
        let mut out = vec![0.0; 3 * directions.len()];
        let single = |f: &dyn Fn(DVec3) -> Vec<f32>| -> Vec<f32> {
            directions.iter().flat_map(|&d| f(d)).collect()
        };
        view.radiances(&directions, &mut out);
        assert_eq!(out, single(&|d| view.along(d, None).radiance()));
        view.transmittances_to_space(&directions, &mut out);
        assert_eq!(out, single(&|d| view.transmittance_to_space(d)));
        view.sun_disc_radiances(&directions, &mut out);
        assert_eq!(out, single(&|d| view.sun_disc_radiance(d)));
        let distances_m: Vec<f64> = (0..directions.len()).map(|k| 20.0 * k as f64).collect();
        let mut path = out.clone();
        view.paths(&directions, &distances_m, &mut out, &mut path);
        for (k, (&direction, &distance_m)) in directions.iter().zip(&distances_m).enumerate() {
            let line = view.along(direction, Some(distance_m));
            assert_eq!(out[3 * k..3 * k + 3], line.transmittance);
            assert_eq!(path[3 * k..3 * k + 3], line.path_radiance());
        }
    }

    #[test]
    fn batches_of_tables_and_rgb_are_the_single_calls() {
        let (view, directions) = (view(), directions());
        let table = view.table(TableChannels::Rgb(RgbSpace::Srgb));
        let mut out = vec![0.0; 3 * directions.len()];
        table.samples(&directions, &mut out);
        let rgb = view.rgb(RgbSpace::Srgb);
        let mut colors = vec![[0.0; 3]; directions.len()];
        rgb.radiances(&directions, &mut colors);
        assert_eq!(colors.as_flattened(), out);
        for (color, &direction) in colors.iter().zip(&directions) {
            assert_eq!(*color, rgb.radiance(direction));
        }
        let normals = [DVec3::Y, DVec3::X, -DVec3::Y];
        let mut irradiances = [0.0; 9];
        table.irradiances(&normals, &mut irradiances);
        let mut colors = [[0.0; 3]; 3];
        rgb.irradiances(&normals, &mut colors);
        assert_eq!(colors.as_flattened(), irradiances);
        for (k, &normal) in normals.iter().enumerate() {
            assert_eq!(irradiances[3 * k..3 * k + 3], table.irradiance(normal));
            assert_eq!(colors[k], rgb.irradiance(normal));
        }
    }

    /// The sun's light in RGB is that of its spectrum.
    #[test]
    fn rgb_sunlight_is_the_spectrums_color() {
        let view = view();
        let rgb = view.rgb(RgbSpace::Rec2020);
        let color = |spectrum: &[f32]| {
            let xyz = view.sky().grid().to_xyz(spectrum);
            RgbSpace::Rec2020.from_xyz(xyz).map(|v| v as f32)
        };
        assert_eq!(rgb.sun_irradiance(), color(&view.sun_irradiance()));
        let disc = rgb.sun_disc_radiance(view.sun());
        assert_eq!(disc, color(&view.sun_disc_radiance(view.sun())));
        assert!(disc[0] > disc[2] && disc[2] > 0.0, "{disc:?}");
        assert_eq!(rgb.sun_disc_radiance(-view.sun()), [0.0; 3]);
    }
}
