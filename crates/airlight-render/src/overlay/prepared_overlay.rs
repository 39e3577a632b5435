//! [`PreparedOverlay`]: camera, light level and fog of a description for one picture.

use super::light_level::{self, PhotometricUnit, View};
use super::{
    Channels, FogOverlay, FogSource, LightLevel, MonteCarloFog, MonteCarloPass, Overlay,
    OverlayImage, OverlayOutput, OverlayScene, SkyLight, place_lights, primaries::Primaries,
};
use crate::RenderError;
use crate::pixels::tagged_path;
use airlight::axes;
use airlight::fog::lights::{LightSettings, RgbLightSet};
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{DirectionalLight, FogError, FogLighting, Ground, RgbFog, RgbLayer, legacy};
use airlight::scene::{FogLayers, FogProfile, SceneError};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight_image::Control;
use airlight_image::frame::Intrinsics;
use airlight_image::output::exr::{self, ExrOptions, SamplePrecision};
use airlight_image::output::{Metadata, PictureFormat, Written};
use airlight_image::rows::StoredRows;
use airlight_image::tone::Exposure;
use std::f32::consts::PI;

/// Default albedo of the ground.
const GROUND_ALBEDO: f64 = 0.2;

/// Default strength of the sun.
const SUN_STRENGTH: f64 = 3.0;

/// Camera and fog of a description for one picture.
#[derive(Debug)]
pub struct PreparedOverlay {
    /// Projection of the picture.
    pub camera: Intrinsics,
    /// Level of the light that the fog scatters.
    pub level: LightLevel,
    fog: FogOverlay,
    unit: PhotometricUnit,
    eye_height_m: f64,
    channels: Channels,
    /// The layers of the fog, if it has patches.
    patchy: Option<FogLayers>,
}

impl PreparedOverlay {
    /// Prepares a description for a picture; `sky` is the solved sky that lights the fog, if the description has one.
    ///
    /// # Errors
    /// [`RenderError`] for a description that is invalid, or invalid for this picture.
    pub fn new(
        scene: &OverlayScene,
        image: &OverlayImage,
        sky: Option<&SkyLight>,
    ) -> Result<Self, RenderError> {
        Self::new_with(scene, image, sky, Control::default())
    }

    /// As [`PreparedOverlay::new`], with cancellation.
    ///
    /// # Errors
    /// As [`PreparedOverlay::new`], and if the caller cancelled.
    pub fn new_with(
        scene: &OverlayScene,
        image: &OverlayImage,
        sky: Option<&SkyLight>,
        control: Control<'_>,
    ) -> Result<Self, RenderError> {
        let camera = scene.camera(image.picture.size, image.picture.pixel_aspect)?;
        let ambient = LightLevel {
            colour: image
                .ambient
                .colour
                .map(|c| c * scene.overlay.ambient_scale as f32),
            ..image.ambient
        };
        let view = View {
            picture: &image.picture,
            depth: &image.depth,
            camera: &camera,
            ambient,
        };
        let (fog, level) = fog(scene, sky, &view, control)?;
        Ok(Self {
            camera,
            level,
            unit: PhotometricUnit::new(&fog, &image.picture),
            fog,
            eye_height_m: scene.eye_height_m(),
            patchy: scene.fog_layers()?.filter(|fog| fog.patches.is_some()),
            channels: match scene.overlay.layers {
                true => Channels::Layers,
                false => Channels::Picture,
            },
        })
    }

    /// The fog; `None` for fog of one colour, which does not scatter light.
    pub fn fog(&self) -> Option<&FogSource> {
        match &self.fog {
            FogOverlay::Fog(source, _) => Some(source),
            _ => None,
        }
    }

    /// Rows of the picture in fog.
    ///
    /// # Errors
    /// [`RenderError`] if the picture has another size.
    pub fn overlay<'o>(&'o self, image: &'o OverlayImage) -> Result<Overlay<'o>, RenderError> {
        let overlay = Overlay::new(
            &image.picture,
            &image.depth,
            &self.camera,
            self.eye_height_m,
            &self.fog,
            self.channels,
        )?;
        Ok(match &self.patchy {
            Some(fog) => overlay.with_patches(fog)?,
            None => overlay,
        })
    }

    /// Rows of the picture in fog for a file in a format.
    ///
    /// # Errors
    /// [`RenderError`] if the picture has another size, or a display setting is out of range.
    pub fn output<'o>(
        &'o self,
        scene: &OverlayScene,
        image: &'o OverlayImage,
        format: PictureFormat,
    ) -> Result<OverlayOutput<'o>, RenderError> {
        OverlayOutput::new(self.overlay(image)?, scene, format, self.unit)
    }

    /// Monte Carlo estimate of the description's fog in a solved sky; `None` if the description has another solver.
    ///
    /// # Errors
    /// [`RenderError`] for fog that does not scatter light or has no solved sky, and for too many layers.
    pub fn monte_carlo(
        &self,
        scene: &OverlayScene,
        sky: Option<&SkyLight>,
    ) -> Result<Option<MonteCarloFog>, RenderError> {
        let Some(settings) = scene.monte_carlo() else {
            return Ok(None);
        };
        let (Some(source), Some(sky), Some(fog)) = (self.fog(), sky, scene.fog_layers()?) else {
            return Err(RenderError::setting(
                "solver monte-carlo: expected fog lit by a solved sky, got other fog; try sky-light",
            ));
        };
        let mut air = sky.atmosphere().clone();
        let ground_m = air.planet.ground_altitude_m;
        let grid = WavelengthGrid::fast();
        for layer in fog.layers {
            let part = layer.constituent(grid.wavelengths_nm())?;
            let part = part.raised(ground_m).ok_or_else(|| {
                RenderError::setting("fog.profile: expected fog with a top or a scale height, got fog without an upper end; try height, clamped, unclamped or slab")
            })?;
            air.constituents.push(part);
        }
        let altitude_m = sky.observer_altitude_m();
        MonteCarloFog::new(source, &air, altitude_m, sky.sun(), settings).map(Some)
    }

    /// Writes the picture after a Monte Carlo pass, and its standard error to `NAME.noise.exr` if the description has a noise
    /// map. Returns the exposure of linear light in a PNG or JPEG file.
    ///
    /// # Errors
    /// [`RenderError`] if a file cannot be written; the files are then those of the previous pass.
    pub fn write_pass(
        &self,
        scene: &OverlayScene,
        image: &OverlayImage,
        pass: &MonteCarloPass,
        control: Control<'_>,
    ) -> Result<(Written, Option<Exposure>), RenderError> {
        let output = scene.output()?;
        let overlay = self
            .overlay(image)?
            .with_path_radiance(&pass.path_radiance)?;
        let format = scene.output_format(output)?;
        let rows = OverlayOutput::new(overlay, scene, format, self.unit)?;
        let written = rows.write(output, control)?;
        if scene.scene.output.noise_map == Some(true) {
            let size = image.picture.size;
            let path = tagged_path(output, "noise").with_extension("exr");
            let rows = StoredRows::new(size.width(), 3, pass.standard_error.clone())?;
            let options = ExrOptions {
                precision: SamplePrecision::Float,
                ..ExrOptions::default()
            };
            let names = ["R", "G", "B"];
            let metadata = Metadata {
                chromaticities: Some(RgbSpace::Srgb.into()),
                white_luminance_cd_m2: image.picture.white_luminance_cd_m2,
                ..Metadata::default()
            };
            exr::write(&path, size, &names, &rows, &options, &metadata, control)?;
        }
        Ok((written, rows.exposure()))
    }
}

/// The fog of a description, and the level of its light.
fn fog(
    scene: &OverlayScene,
    sky: Option<&SkyLight>,
    view: &View<'_>,
    control: Control<'_>,
) -> Result<(FogOverlay, LightLevel), RenderError> {
    let primaries = Primaries::of(view.picture);
    let ambient = primaries.to_srgb(view.ambient.colour);
    let Some(layers) = scene.constituents_with(control)? else {
        return Ok((one_colour(scene, ambient)?, view.ambient));
    };
    let rgb = |layer| RgbLayer::from_constituent(layer, RgbSpace::Srgb);
    let rgb: Result<Vec<RgbLayer>, _> = layers.iter().map(rgb).collect();
    let rgb = rgb.map_err(|error| SceneError::from(FogError::from(error)))?;
    let (source, level) = match sky {
        Some(sky) => {
            let sky = sky.with_fog_with(&layers, scene.fog_scattering(), control)?;
            let (radiance_scale, level) = light_level::radiance_scale(&scene.overlay, &sky, view)?;
            let source = FogSource::Sky {
                sky,
                radiance_scale,
                air: scene.overlay.air,
            };
            (source, level)
        }
        None => (alone(scene, &rgb, ambient, control)?, view.ambient),
    };
    let lights = lights_in_fog(scene, &rgb, &source, view)?;
    Ok((FogOverlay::Fog(source, lights), level))
}

/// Fog of one colour, which does not scatter light.
fn one_colour(scene: &OverlayScene, colour: [f32; 3]) -> Result<FogOverlay, RenderError> {
    let (visibility_m, contrast) = (scene.visibility_m()?, scene.contrast());
    Ok(match scene.fog_profile() {
        FogProfile::Exp2 => {
            let density = legacy::exponential_squared_density_per_m(visibility_m, contrast.value());
            FogOverlay::ExponentialSquared(density, colour)
        }
        FogProfile::Linear => FogOverlay::Linear(0.0, visibility_m, colour),
        _ => FogOverlay::Encoded(extinction_per_m(visibility_m, contrast), colour),
    })
}

/// Fog in ambient light and the description's sun.
fn alone(
    scene: &OverlayScene,
    layers: &[RgbLayer],
    ambient: [f32; 3],
    control: Control<'_>,
) -> Result<FogSource, RenderError> {
    let sun_strength = scene.overlay.sun_strength.unwrap_or(SUN_STRENGTH);
    let sun = scene.scene.sun.elevation_deg.map(|elevation_deg| {
        let azimuth_deg = scene.scene.sun.azimuth_deg.unwrap_or(180.0);
        DirectionalLight {
            direction: axes::direction(azimuth_deg, elevation_deg),
            irradiance: ambient.map(|c| c * (PI * sun_strength as f32)),
        }
    });
    let albedo = scene.scene.air.ground_albedo.unwrap_or(GROUND_ALBEDO);
    let light = FogLighting {
        sun,
        ambient,
        ground_albedo: [albedo as f32; 3],
    };
    RgbFog::new_with(
        layers,
        Ground::FLAT,
        &light,
        scene.fog_scattering(),
        control,
    )
    .map(FogSource::Alone)
    .map_err(|error| SceneError::from(error).into())
}

/// The description's lights in the fog.
fn lights_in_fog(
    scene: &OverlayScene,
    layers: &[RgbLayer],
    source: &FogSource,
    view: &View<'_>,
) -> Result<Option<RgbLightSet>, RenderError> {
    if scene.scene.lights.is_empty() {
        return Ok(None);
    }
    let ground = match source {
        FogSource::Alone(_) => Ground::FLAT,
        FogSource::Sky { sky, .. } => *sky.ground(),
    };
    let primaries = Primaries::of(view.picture);
    let mut lights = scene.scene.lights.clone();
    for light in &mut lights {
        let intensity = primaries.to_srgb(light.intensity.map(|v| v as f32));
        light.intensity = intensity.map(|v| f64::from(v.max(0.0)));
    }
    let lights = place_lights::place(&lights, view.camera, view.depth, scene.eye_height_m())?;
    let settings = LightSettings {
        form: scene.overlay.light_form,
        ..LightSettings::default()
    };
    RgbLightSet::new(lights, layers, ground, settings)
        .map(Some)
        .map_err(|error| SceneError::from(error).into())
}
