//! [`Fog`], and its tables on the device.

use crate::error::SkyRendererError;
use crate::gpu_tables::{self, FLAT, SOLID, Tables};
use crate::lighting::DirectLight;
use airlight::atmosphere::DensityProfile;
use airlight::fog::droplets::Droplets;
use airlight::fog::visibility::{self, Contrast};
use airlight::fog::{
    DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer,
    effective_top_of_layers_m,
};
use airlight_shaders::twins::columns::{INFINITE_M, ray_segment};
use airlight_shaders::twins::exponentials::OPAQUE;
use airlight_shaders::twins::fog::{
    FOG_CLAMPED, FOG_EXPONENTIAL, FOG_SLAB, FogLayer, FogMedium, fog_layer_column_m,
};
use airlight_shaders::twins::fog_table::FogTableView;
use airlight_shaders::twins::lights::ExponentialFog;
use airlight_shaders::twins::path_optics::{PathOptics, apply_path_optics};
use airlight_shaders::{FogTables, SkyTables};
use glam::Vec3;
use std::f32::consts::PI;

/// Largest number of density profiles in a fog. Layers of one profile count as one.
pub const MOST_FOG_LAYERS: usize = 4;

/// Layers of fog over flat ground, with all orders of scattering of the light of sun and sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Fog {
    /// The layers, at most [`MOST_FOG_LAYERS`] of different density profiles, in the RGB space of the target: each exponential, clamped or
    /// with two edges. Uniform fog, without an upper edge, lets no light in. Heights are above sea level, m.
    pub layers: Vec<RgbLayer>,
    /// Height of the ground, m.
    pub ground_height_m: f64,
    /// Albedo of the ground, 0 to 1.
    pub ground_albedo: [f32; 3],
}

impl Fog {
    /// Fog of droplets over grass at sea level, with a visibility (m) at the ground, that thins by a factor e over each scale height, m.
    pub fn new(visibility_m: f64, scale_height_m: f64) -> Self {
        let extinction_per_m = visibility::extinction_per_m(visibility_m, Contrast::default());
        Self {
            layers: vec![RgbLayer {
                density: DensityProfile::exponential(scale_height_m),
                extinction_per_m: [extinction_per_m as f32; 3],
                single_scattering_albedo: [1.0; 3],
                phase: Droplets::default().phase(),
            }],
            ground_height_m: 0.0,
            ground_albedo: [0.05, 0.1, 0.03],
        }
    }

    /// Checks the values.
    pub(crate) fn validate(&self) -> Result<(), SkyRendererError> {
        for layer in &self.layers {
            profile(&layer.density).ok_or(SkyRendererError::FogProfile)?;
        }
        let dark = FogLighting {
            sun: None,
            ambient: [0.0; 3],
            ground_albedo: self.ground_albedo,
        };
        let fog = self.under(&dark, FogScattering::Single)?;
        match fog.profiles().len() {
            1..=MOST_FOG_LAYERS => Ok(()),
            count => Err(SkyRendererError::FogLayers {
                count,
                most: MOST_FOG_LAYERS,
            }),
        }
    }

    fn under(
        &self,
        lighting: &FogLighting<[f32; 3]>,
        scattering: FogScattering,
    ) -> Result<RgbFog, SkyRendererError> {
        let ground = Ground {
            height_m: self.ground_height_m,
            ..Ground::FLAT
        };
        Ok(RgbFog::new(&self.layers, ground, lighting, scattering)?)
    }

    /// Height of the fog's effective top, m: sun and sky light the fog as they do there.
    pub(crate) fn top_m(&self) -> f64 {
        let each = self.layers.iter().map(|layer| {
            let largest = layer.extinction_per_m.into_iter().fold(0.0, f32::max);
            (&layer.density, largest)
        });
        effective_top_of_layers_m(self.ground_height_m, each)
    }

    /// The fog in the light of sun and sky at its top.
    pub(crate) fn lit(
        &self,
        at_top: &DirectLight,
        sky_illuminance_lx: Vec3,
    ) -> Result<RgbFog, SkyRendererError> {
        let sun = (at_top.direction.y > 0.0).then(|| DirectionalLight {
            direction: at_top.direction.as_dvec3().normalize(),
            irradiance: at_top.illuminance_lx.max(Vec3::ZERO).to_array(),
        });
        let lighting = FogLighting {
            sun,
            ambient: (sky_illuminance_lx.max(Vec3::ZERO) / PI).to_array(),
            ground_albedo: self.ground_albedo,
        };
        self.under(&lighting, FogScattering::Multiple)
    }

    /// The lit fog in air of a frame, for an eye at a height above sea level, m.
    pub(crate) fn frame(
        &self,
        height_m: f64,
        lit: &RgbFog,
        air: &SkyTables,
    ) -> Result<FogFrame, SkyRendererError> {
        let layer = |(density, extinction_per_m): (&DensityProfile, [f32; 3])| {
            let (profile, from_m, scale_m) = profile(density).expect("a profile that was checked");
            FogLayer {
                extinction_per_m: Vec3::from_array(extinction_per_m),
                profile,
                // The tables hold scattering and phase function.
                scattering_per_m: Vec3::ZERO,
                height_m: (from_m - self.ground_height_m) as f32,
                phase: Vec3::ZERO,
                scale_m: scale_m as f32,
            }
        };
        Ok(FogFrame {
            tables: FogTables::in_air(lit, height_m.max(self.ground_height_m), air)?,
            layers: lit.profiles().map(layer).collect(),
            eye_height_m: (height_m - self.ground_height_m).max(0.0) as f32,
            around_lights: self.around_lights(),
        })
    }

    /// The fog as lights see it, in which heights count from the ground; `None` for a fog that is not a single layer that is exponential
    /// above the ground.
    pub(crate) fn around_lights(&self) -> Option<ExponentialFog> {
        /// Wavelength at which the mean cosine of the phase function is taken, nm.
        const MEAN_COSINE_NM: f64 = 550.0;
        let [layer] = &self.layers[..] else {
            return None;
        };
        let (profile, reference_height_m, scale_height_m) = profile(&layer.density)?;
        let is_exponential = match profile {
            FOG_EXPONENTIAL => true,
            FOG_CLAMPED => reference_height_m <= self.ground_height_m,
            _ => false,
        };
        let extinction_per_m = Vec3::from_array(layer.extinction_per_m);
        let albedo = Vec3::from_array(layer.single_scattering_albedo);
        is_exponential.then_some(ExponentialFog {
            medium: FogMedium {
                extinction_per_m,
                scattering_per_m: extinction_per_m * albedo,
            },
            // The range of the shader's function.
            mean_cosine: layer.phase.asymmetry(MEAN_COSINE_NM).clamp(-0.3, 0.95) as f32,
            reference_height_m: (reference_height_m - self.ground_height_m) as f32,
            scale_height_m: scale_height_m as f32,
        })
    }
}

/// Fog of a frame: plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct FogFrame {
    /// Light of the fog for the eye and the sun.
    pub tables: FogTables,
    /// Extinction and profile of the layers that the tables have views of; heights are above the ground.
    pub layers: Vec<FogLayer>,
    /// Height of the eye above the ground, m.
    pub eye_height_m: f32,
    /// The fog around lights; `None` if it is not a single layer that is exponential above the ground.
    pub around_lights: Option<ExponentialFog>,
}

impl FogFrame {
    /// Light of a direction behind the fog, for an eye that sees no geometry.
    pub(crate) fn in_front_of(&self, behind: Vec3, direction: Vec3) -> Vec3 {
        apply_path_optics(self.path(direction), behind)
    }

    /// Fog along a direction up to the ground or through all of it.
    pub(crate) fn path(&self, direction: Vec3) -> PathOptics {
        let length_m = match direction.y < 0.0 {
            true => (self.eye_height_m / -direction.y).min(INFINITE_M),
            false => INFINITE_M,
        };
        let ray = ray_segment(self.eye_height_m, direction.y, length_m, 0.0);
        let depth = |layer: &FogLayer| {
            let column_m = fog_layer_column_m(*layer, ray);
            (layer.extinction_per_m * column_m).min(Vec3::splat(OPAQUE))
        };
        self.tables.path(direction, self.layers.iter().map(depth))
    }

    /// Uploads the tables: for all light of the fog, and for the sunlight that it scatters once.
    pub(crate) fn upload(
        &self,
        device: (&wgpu::Device, &wgpu::Queue),
        layout: &wgpu::BindGroupLayout,
    ) -> [wgpu::BindGroup; 2] {
        let tables = &self.tables;
        let textures = [&tables.diffuse, &tables.streams, &tables.stream_phase];
        let textures = Tables::new(device, &textures);
        let once = |view: &FogTableView| FogTableView {
            diffuse_scale: 0.0,
            ..*view
        };
        [
            tables.views.clone(),
            tables.views.iter().map(once).collect(),
        ]
        .map(|views| textures.group(device.0, layout, &self.numbers(&views)))
    }

    /// The numbers of the shader's struct `Fog`.
    fn numbers(&self, views: &[FogTableView]) -> Vec<f32> {
        let mut all = Vec::with_capacity(MOST_FOG_LAYERS * LAYER_NUMBERS + 4);
        for (view, layer) in views.iter().zip(&self.layers) {
            all.extend(view.sun.extend(view.below_per_sine).to_array());
            all.extend(view.depth_below.extend(view.above_per_sine).to_array());
            all.extend(view.depth_above.extend(view.diffuse_scale).to_array());
            all.extend([
                view.sunlit_scale,
                view.layer,
                view.layer_count,
                view.phase_count,
            ]);
            let profile = f32::from_bits(layer.profile);
            all.extend(layer.extinction_per_m.extend(profile).to_array());
            all.extend(layer.scattering_per_m.extend(layer.height_m).to_array());
            all.extend(layer.phase.extend(layer.scale_m).to_array());
        }
        all.resize(MOST_FOG_LAYERS * LAYER_NUMBERS, 0.0);
        let count = f32::from_bits(self.layers.len() as u32);
        all.extend([count, self.eye_height_m, 0.0, 0.0]);
        all
    }
}

/// Numbers of the shader's struct `SeenLayer`.
const LAYER_NUMBERS: usize = 28;

/// Profile, height (m) and scale (m) of the shader's struct `FogLayer`.
fn profile(density: &DensityProfile) -> Option<(u32, f64, f64)> {
    match *density {
        DensityProfile::Exponential {
            reference_height_m,
            scale_height_m,
        } => Some((FOG_EXPONENTIAL, reference_height_m, scale_height_m)),
        DensityProfile::Clamped {
            base_height_m,
            scale_height_m,
        } => Some((FOG_CLAMPED, base_height_m, scale_height_m)),
        DensityProfile::Layer { bottom_m, top_m } if bottom_m.is_finite() => {
            Some((FOG_SLAB, bottom_m, top_m - bottom_m))
        }
        _ => None,
    }
}

/// Layout of the tables.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    gpu_tables::layout(device, &[SOLID, SOLID, FLAT])
}
