//! A view in red, green and blue.

use super::table::{SkyTable, TableChannels};
use super::view::View;
use crate::math::slices::check_length;
use crate::spectrum::RgbSpace;
use crate::spectrum::rgb::{self, Matrix3};
use glam::DVec3;
use std::sync::Arc;

/// A [`View`] in linear red, green and blue, for real-time use: every answer is a table look-up or a few operations.
///
/// Radiances are in cd/m^2, irradiances in lx: (1, 1, 1) is one unit of the white of the space. For air between the eye and
/// objects see `scene::RgbFoggySky`.
#[derive(Clone, Debug)]
pub struct RgbView {
    view: View,
    space: RgbSpace,
    from_xyz: Matrix3,
    table: Arc<SkyTable>,
}

impl View {
    /// The view in red, green and blue of a space, tabulated for real-time use.
    pub fn rgb(&self, space: RgbSpace) -> RgbView {
        RgbView {
            table: Arc::new(self.table(TableChannels::Rgb(space))),
            from_xyz: space.from_xyz_matrix(),
            space,
            view: self.clone(),
        }
    }
}

impl RgbView {
    /// The RGB space of all values.
    pub fn space(&self) -> RgbSpace {
        self.space
    }

    /// The spectral view.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The table behind [`RgbView::radiance`].
    pub fn table(&self) -> &Arc<SkyTable> {
        &self.table
    }

    /// Radiance along the unit vector `direction`, without the sun's disc.
    #[inline]
    pub fn radiance(&self, direction: DVec3) -> [f32; 3] {
        let mut rgb = [0.0; 3];
        self.table.sample(direction, &mut rgb);
        rgb
    }

    /// [`RgbView::radiance`] along many directions, on all threads.
    ///
    /// # Panics
    /// Where the slices differ in length.
    pub fn radiances(&self, directions: &[DVec3], out: &mut [[f32; 3]]) {
        check_length(out, directions.len());
        self.table.samples(directions, out.as_flattened_mut());
    }

    /// Irradiance of sky and ground on a surface at the eye with the unit normal `normal`, without the sun's disc.
    pub fn irradiance(&self, normal: DVec3) -> [f32; 3] {
        let mut rgb = [[0.0; 3]];
        self.irradiances(&[normal], &mut rgb);
        rgb[0]
    }

    /// [`RgbView::irradiance`] on many surfaces, on all threads.
    ///
    /// # Panics
    /// Where the slices differ in length.
    pub fn irradiances(&self, normals: &[DVec3], out: &mut [[f32; 3]]) {
        check_length(out, normals.len());
        self.table.irradiances(normals, out.as_flattened_mut());
    }

    /// Irradiance of the sun's disc at the eye on a surface that faces it.
    pub fn sun_irradiance(&self) -> [f32; 3] {
        self.color(&self.view.sun_irradiance())
    }

    /// Radiance of the sun's disc as it arrives along the unit vector `direction`; zero outside the disc.
    pub fn sun_disc_radiance(&self, direction: DVec3) -> [f32; 3] {
        self.color(&self.view.sun_disc_radiance(direction))
    }

    fn color(&self, spectrum: &[f32]) -> [f32; 3] {
        let xyz = self.view.sky().grid().to_xyz(spectrum);
        rgb::apply(&self.from_xyz, xyz).map(|v| v as f32)
    }
}
