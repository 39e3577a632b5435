//! [`DiffuseFog`]: fog under an evenly bright sky.

use super::lane_channels::{Converter, LaneChannels};
use super::{FogLayers, SceneError};
use crate::atmosphere::RaySegment;
use crate::fog::{FogLanes, FogLighting, Ground, PatchView};
use crate::sky::View;
use crate::spectrum::{RgbSpace, Spectrum, WavelengthGrid};
use glam::DVec3;

/// Fog that an evenly bright sky of radiance 1 lights, grey: droplets are much larger than the wavelengths.
#[derive(Debug)]
pub(super) struct DiffuseFog {
    fog: FogLanes<3>,
    eye_height_m: f64,
    patches: Option<PatchView>,
}

impl DiffuseFog {
    /// Fog over the ground of a view.
    ///
    /// # Errors
    /// [`SceneError`] for invalid layers.
    pub fn new(fog: &FogLayers, view: &View) -> Result<Self, SceneError> {
        let layers = fog.constituents(WavelengthGrid::standard().wavelengths_nm())?;
        let converter = Converter::<3>::new(view, LaneChannels::Rgb(RgbSpace::Srgb))?;
        let albedo = &view.sky().atmosphere().planet.ground_albedo;
        let ground = Ground {
            height_m: 0.0,
            radius_m: view.bounds_m().0,
        };
        let lighting = FogLighting {
            sun: None,
            ambient: Spectrum::ONE,
            ground_albedo: Spectrum(converter.wavelengths_nm().map(|nm| albedo.at(nm) as f32)),
        };
        let layers = converter.layers(&layers)?;
        let lanes = converter.used().len();
        Ok(Self {
            fog: FogLanes::new(&layers, ground, lighting, fog.scattering, lanes)?,
            eye_height_m: view.radius_m() - ground.radius_m,
            patches: fog.patches_in_view(view)?,
        })
    }

    /// Transmittance and radiance of the fog along a unit vector, up to a distance, m.
    pub fn along(&self, direction: DVec3, distance_m: f64) -> (f32, f32) {
        let radius_m = self.fog.ground().radius_m;
        let ray = RaySegment::new(self.eye_height_m, direction.y, distance_m, radius_m);
        let even = self.fog.path_along(&ray, 0.0);
        let path = match &self.patches {
            Some(patches) => even.at_density(patches.factor(direction, distance_m) as f32),
            None => even,
        };
        (path.transmittance[1], path.path_radiance[1])
    }
}
