//! [`OverlayScene`]: complete description of a picture in fog.

use super::{ExistingAerial, OverlaySpec, SkyLight};
use crate::RenderError;
use crate::exposure::ExposureSettings;
use crate::ignored::refuse_ignored;
use airlight::atmosphere::Constituent;
use airlight::fog::droplets::DropletKind;
use airlight::fog::lights::LightForm;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::fog::{DensityProfile, FogScattering};
use airlight::monte_carlo::{MonteCarloSettings, SunShape};
use airlight::scene::{
    FogLayer, FogLayerSpec, FogLayers, FogPatchesSpec, FogProfile, FogSpec, Input, LightKind,
    NightLights, OutputSpec, Projection, Scene, SceneDocument, SceneError,
};
use airlight::spectrum::WavelengthGrid;
use airlight::{Control, Named, UnknownName};
use airlight_image::frame::Intrinsics;
use airlight_image::output::PictureFormat;
use airlight_image::{ImageError, Size};
use serde::Serialize;
use std::path::Path;
use std::sync::LazyLock;

/// Default height of the eye above the ground, m.
const EYE_HEIGHT_M: f64 = 1.6;
/// Default horizontal field of view, degrees, without a focal length.
const FOV_DEG: f64 = 60.0;
/// Inputs that change the fog itself.
const OF_FOG: [Input; 5] = [
    Input::Fog,
    Input::FogScattering,
    Input::FogPatches,
    Input::Lights,
    Input::GroundAlbedo,
];
/// Inputs that change the solved sky.
const OF_SKY: [Input; 8] = [
    Input::Atmosphere,
    Input::Haze,
    Input::Ozone,
    Input::SunDistance,
    Input::Night,
    Input::Wavelengths,
    Input::Scattering,
    Input::Effort,
];
/// Inputs that change the Monte Carlo estimate.
const OF_MONTE_CARLO: [Input; 2] = [Input::Paths, Input::NoiseMap];
/// Default number of Monte Carlo paths for each pixel.
const PATHS: u64 = 256;

/// Solver of the light scattered by fog over a picture, by its name in [`airlight::scene::SolverSpec`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OverlaySolver {
    /// Closed forms and discrete ordinates for the fog, in a sky solved by orders of scattering: fast, without noise.
    Orders,
    /// Monte Carlo path tracing in fog and air, lit by a solved sky.
    MonteCarlo,
}

airlight::named! { OverlaySolver, "a solver for fog over a picture", [
    ("orders", (Orders), "closed forms and discrete ordinates, in a sky solved by orders of scattering: fast, without noise"),
    ("monte-carlo", (MonteCarlo), "path tracing in fog and air, with sky light: no approximation, with noise of known size; a \
        picture of 160 x 120 pixels takes a minute on two cores, a megapixel an hour"),
] }

/// A picture in fog: a scene with fog, lights, sun, camera and output, and the picture to which the fog is added.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OverlayScene {
    /// Fog, lights, sun, air, camera, solver and output.
    #[serde(flatten)]
    pub scene: Scene,
    /// Colour picture, depth map and light level.
    pub overlay: OverlaySpec,
}

impl OverlayScene {
    /// Reads a description from TOML: a scene, with colour picture and depth map in the table `[overlay]`.
    ///
    /// # Errors
    /// [`SceneError`] with line, column, key and the most similar valid key.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let document = SceneDocument::new(text)?;
        Ok(Self {
            scene: document.scene(&[""], &["overlay"])?,
            overlay: document.read(&["overlay"], &[])?,
        })
    }

    /// Writes the description as TOML; settings without a value are omitted.
    ///
    /// # Errors
    /// [`RenderError::Setting`] for a value that TOML cannot represent, such as a seed of 2^63 or more.
    pub fn to_toml(&self) -> Result<String, RenderError> {
        /// The table of what is not part of the scene.
        #[derive(Serialize)]
        struct Rest<'a> {
            overlay: &'a OverlaySpec,
        }
        let overlay = &self.overlay;
        let rest = toml::to_string(&Rest { overlay })
            .map_err(|error| RenderError::setting(format!("overlay: {error}")))?;
        Ok(format!("{}\n{rest}", self.scene.to_toml()?))
    }

    /// JSON Schema of scene files with a table `[overlay]`, for completion and validation in editors.
    #[cfg(feature = "schema")]
    pub fn json_schema() -> String {
        format!("{:#}", schemars::schema_for!(Self).to_value())
    }

    /// The fog; with no settings if the scene has none.
    pub fn fog(&self) -> &FogSpec {
        static NONE: LazyLock<FogSpec> = LazyLock::new(FogSpec::default);
        self.scene.fog.as_ref().unwrap_or(&NONE)
    }

    /// The fog, added if the scene has none.
    pub fn fog_mut(&mut self) -> &mut FogSpec {
        self.scene.fog.get_or_insert_default()
    }

    /// Profile of the fog. Unlike in a sky, fog without a profile and without heights is uniform.
    pub fn fog_profile(&self) -> FogProfile {
        let fog = self.fog();
        match (
            fog.profile,
            fog.scale_height_m,
            fog.base_height_m,
            fog.top_m,
        ) {
            (None, None, None, None) => FogProfile::Uniform,
            _ => fog.first_layer().implied_profile(),
        }
    }

    /// Visibility in the fog where it is densest, m.
    ///
    /// # Errors
    /// [`RenderError::Setting`] if there is none.
    pub fn visibility_m(&self) -> Result<f64, RenderError> {
        self.fog().visibility_m.ok_or_else(|| {
            RenderError::setting(
                "expected a visibility in the fog, got none; try visibility-m 100, or vary visibility=50..500 in a batch",
            )
        })
    }

    /// Extinction of the fog where it is densest, 1/m; `None` for profiles that have no extinction.
    pub fn extinction_per_m(&self) -> Option<f64> {
        match self.fog_profile() {
            FogProfile::Exp2 | FogProfile::Linear => None,
            _ => Some(extinction_per_m(self.fog().visibility_m?, self.contrast())),
        }
    }

    /// Contrast threshold that defines visibility.
    pub fn contrast(&self) -> Contrast {
        self.scene.air.visibility_contrast()
    }

    /// Orders of scattering in the fog.
    pub fn fog_scattering(&self) -> FogScattering {
        self.fog().scattering.unwrap_or(FogScattering::Multiple)
    }

    /// Height of the eye above the ground, m.
    pub fn eye_height_m(&self) -> f64 {
        self.scene.observer.eye_height_m.unwrap_or(EYE_HEIGHT_M)
    }

    /// The file to write.
    ///
    /// # Errors
    /// [`RenderError::Setting`] if there is none.
    pub fn output(&self) -> Result<&Path, RenderError> {
        match &self.scene.output.file {
            Some(file) => Ok(Path::new(file)),
            None => Err(RenderError::setting(
                "expected a file to write, got none; try output fogged.png",
            )),
        }
    }

    /// Format of an output, from its extension.
    ///
    /// # Errors
    /// [`RenderError`] for an unknown extension, or that of a format that cannot store the layers or would ignore a setting.
    pub fn output_format(&self, output: &Path) -> Result<PictureFormat, RenderError> {
        let format = PictureFormat::from_path(output)?;
        if self.overlay.layers && !format.holds_channels() {
            return Err(RenderError::setting(format!(
                "layers: expected an OpenEXR output, got `{}`; try a name that ends in .exr",
                output.display()
            )));
        }
        refuse_ignored(&self.scene.output, output, format, false)?;
        Ok(format)
    }

    /// The fog with its layers and patches; `None` for fog of one colour, which does not scatter light.
    ///
    /// # Errors
    /// [`RenderError`] for a layer without visibility.
    pub fn fog_layers(&self) -> Result<Option<FogLayers>, RenderError> {
        let profile = self.fog_profile();
        if is_one_colour(profile) {
            return Ok(None);
        }
        self.visibility_m()?;
        let contrast = self.contrast();
        let mut first = self.fog().first_layer();
        first.profile = Some(profile);
        let layers = std::iter::once(first).chain(self.fog().layers.iter().cloned());
        let layers = layers.enumerate().map(|(i, layer)| {
            let key = match i {
                0 => "fog".to_owned(),
                more => format!("fog.layers[{}]", more - 1),
            };
            fog_layer(&layer, &key, contrast)
        });
        Ok(Some(FogLayers {
            layers: layers.collect::<Result<_, _>>()?,
            scattering: self.fog_scattering(),
            patches: self.fog().patches.as_ref().map(FogPatchesSpec::patches),
        }))
    }

    /// Layers of the fog as constituents, with heights above the ground.
    ///
    /// # Errors
    /// [`RenderError`] for an invalid layer.
    pub fn constituents(&self) -> Result<Option<Vec<Constituent>>, RenderError> {
        self.constituents_with(Control::default())
    }

    /// As [`Self::constituents`], with cancellation.
    ///
    /// # Errors
    /// As [`Self::constituents`], and if the caller cancelled.
    pub fn constituents_with(
        &self,
        control: Control<'_>,
    ) -> Result<Option<Vec<Constituent>>, RenderError> {
        let Some(fog) = self.fog_layers()? else {
            return Ok(None);
        };
        let grid = WavelengthGrid::standard();
        let layers = fog.constituents_with(grid.wavelengths_nm(), control)?;
        Ok(Some(layers))
    }

    /// The camera of a picture of this size, with pixels of this width over height.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for numbers out of range.
    pub fn camera(&self, size: Size, pixel_aspect: f32) -> Result<Intrinsics, ImageError> {
        let camera = &self.scene.camera;
        let fov_deg = camera.fov_deg.unwrap_or(FOV_DEG);
        let level = self.overlay.camera(size, fov_deg)?;
        level.with_pixel_aspect(pixel_aspect.into())?.looking(
            camera.azimuth_deg.unwrap_or(0.0),
            camera.elevation_deg.unwrap_or(0.0),
            camera.roll_deg.unwrap_or(0.0),
        )
    }

    /// Settings of Monte Carlo; `None` for the deterministic solution.
    pub fn monte_carlo(&self) -> Option<MonteCarloSettings> {
        let solver = &self.scene.solver;
        (self.solver() == Ok(OverlaySolver::MonteCarlo)).then(|| MonteCarloSettings {
            paths: solver.paths.unwrap_or(PATHS),
            seed: solver.seed.unwrap_or(1),
            sun: SunShape::Disc,
        })
    }

    /// The solved sky that lights the fog; `None` without sky light.
    ///
    /// # Errors
    /// [`RenderError`] for invalid air, sun or place.
    pub fn solve_sky(&self) -> Result<Option<SkyLight>, RenderError> {
        self.solve_sky_with(Control::default())
    }

    /// As [`Self::solve_sky`], with progress and cancellation.
    ///
    /// # Errors
    /// As [`Self::solve_sky`], and if the caller cancelled.
    pub fn solve_sky_with(&self, control: Control<'_>) -> Result<Option<SkyLight>, RenderError> {
        if !self.overlay.sky_light {
            return Ok(None);
        }
        SkyLight::solve_with(&self.sky_scene().resolve()?.for_colors(), control).map(Some)
    }

    /// The scene whose sky lights the fog: without the fog, and with the eye at its height above the ground.
    fn sky_scene(&self) -> Scene {
        let mut scene = self.scene.clone();
        scene.fog = None;
        let ground_m = scene.air.ground_altitude_m.unwrap_or(0.0);
        scene.observer.altitude_m = Some(ground_m + self.eye_height_m());
        scene.observer.eye_height_m = Some(self.eye_height_m());
        if self.monte_carlo().is_some() {
            // Its paths lead to the sun only.
            scene.night.lights = Some(NightLights::Off);
        }
        scene
    }

    /// Checks all settings that do not depend on files.
    ///
    /// # Errors
    /// [`RenderError`] for the first setting that is invalid, contradicts another or would be ignored.
    pub fn check(&self) -> Result<(), RenderError> {
        self.scene.validate()?;
        self.visibility_m()?;
        self.overlay.depth_options()?;
        ExposureSettings::of(&self.scene.output).fixed()?;
        let profile = self.fog_profile();
        let sky_light = self.overlay.sky_light;
        let sun_is_down = self.scene.sun.elevation_deg.is_some_and(|deg| deg <= 0.0);
        if sun_is_down && !sky_light {
            return Err(RenderError::setting(
                "sun-elevation: expected a sun above the horizon, got one below it; try leaving it out for fog in ambient light, or \
                sky-light for twilight",
            ));
        }
        self.check_components()?;
        self.check_solver()?;
        self.check_ignored()?;
        if is_one_colour(profile) {
            self.check_one_colour()?;
        }
        let fog = self.fog_layers()?;
        let mut layers = fog.iter().flat_map(|fog| &fog.layers);
        if sky_light && layers.any(|layer| layer.profile.is_uniform()) {
            return Err(SkyLight::needs_top());
        }
        self.check_patches()?;
        self.check_light_form(profile)
    }

    /// Refuses a colour or a point of which a component is out of range, or missing where only others vary.
    fn check_components(&self) -> Result<(), RenderError> {
        let refuse = |key, expected, got: &[f64], advice| {
            let got: Vec<String> = got.iter().map(f64::to_string).collect();
            Err(RenderError::value(key, expected, got.join(","), advice))
        };
        if let Some(rgb) = &self.overlay.ambient
            && !rgb.iter().all(|c| c.is_finite() && *c >= 0.0)
        {
            let advice = "0.6,0.65,0.7, or varying ambient-red, ambient-green and ambient-blue";
            return refuse(
                "overlay.ambient",
                "red, green and blue, 0 or above",
                rgb,
                advice,
            );
        }
        match &self.overlay.principal_point_px {
            Some(xy) if !xy.iter().all(|v| v.is_finite()) => {
                let advice = "320,240, or varying principal-point-x and principal-point-y";
                refuse(
                    "overlay.principal_point_px",
                    "two numbers of pixels",
                    xy,
                    advice,
                )
            }
            _ => Ok(()),
        }
    }

    /// The scene's solver.
    fn solver(&self) -> Result<OverlaySolver, UnknownName> {
        let name = self.scene.solver.name.as_deref();
        name.map_or(Ok(OverlaySolver::Orders), str::parse)
    }

    fn check_solver(&self) -> Result<(), RenderError> {
        let solver = self.solver();
        match solver.map_err(|error| RenderError::setting(format!("solver: {error}")))? {
            OverlaySolver::MonteCarlo if !self.overlay.sky_light => Err(RenderError::setting(
                "solver monte-carlo: expected fog lit by a solved sky, got fog in ambient light; try sky-light",
            )),
            OverlaySolver::MonteCarlo if self.fog_scattering() != FogScattering::Multiple => {
                Err(RenderError::setting(
                    "solver monte-carlo: expected fog-scattering all, got another; try leaving out fog-scattering, or solver orders",
                ))
            }
            _ => Ok(()),
        }
    }

    /// Refuses settings that would be ignored.
    fn check_ignored(&self) -> Result<(), RenderError> {
        let refuse = |key: &str, expected: &str, got: &str, advice: &str| {
            Err(RenderError::value(key, expected, got, advice))
        };
        let (scene, overlay, sky_light) = (&self.scene, &self.overlay, self.overlay.sky_light);
        for input in scene.set_inputs() {
            let key = input.key();
            if OF_SKY.contains(&input) {
                if !sky_light {
                    return refuse(
                        key,
                        "a solved sky",
                        "ambient light",
                        "sky-light, or leaving it out",
                    );
                }
            } else if OF_MONTE_CARLO.contains(&input) {
                if self.monte_carlo().is_none() {
                    let advice = "solver monte-carlo, or leaving it out";
                    return refuse(key, "solver monte-carlo", "another", advice);
                }
            } else if !OF_FOG.contains(&input) {
                let got = input.to_string();
                return refuse(
                    key,
                    "settings of fog over a picture",
                    &got,
                    "leaving it out",
                );
            }
        }
        let (sun, camera) = (&scene.sun, &scene.camera);
        for (set, key) in [
            (sun.latitude_deg.is_some(), "sun.latitude_deg"),
            (
                scene.air.ground_altitude_m.is_some(),
                "air.ground_altitude_m",
            ),
            (overlay.radiance_scale.is_some(), "overlay.radiance_scale"),
            (overlay.air == ExistingAerial::Missing, "overlay.air"),
        ] {
            if set && !sky_light {
                return refuse(
                    key,
                    "a solved sky",
                    "ambient light",
                    "sky-light, or leaving it out",
                );
            }
        }
        if scene.night.stars.is_some() {
            let expected = "lights that fill the fog";
            return refuse("night.stars", expected, "single stars", "leaving it out");
        }
        if scene.set_inputs().contains(&Input::Night) && self.monte_carlo().is_some() {
            return refuse(
                Input::Night.key(),
                "solver orders",
                "solver monte-carlo, which knows sunlight only",
                "leaving it out, or solver orders",
            );
        }
        if overlay.sun_strength.is_some() && (sky_light || sun.elevation_deg.is_none()) {
            let got = if sky_light { "a solved sky" } else { "no sun" };
            return refuse(
                "overlay.sun_strength",
                "a sun with ambient light",
                got,
                "leaving it out, or sun-elevation without sky-light",
            );
        }
        if overlay.focal_px.is_some() == camera.fov_deg.is_some() && camera.fov_deg.is_some() {
            return refuse(
                "overlay.focal_px",
                "a focal length or a field of view",
                "both",
                "one of them",
            );
        }
        if overlay.principal_point_px.is_some() && overlay.focal_px.is_none() {
            return refuse(
                "overlay.principal_point_px",
                "a focal length with this key",
                "none",
                "focal-px",
            );
        }
        let output = OutputSpec {
            file: None,
            noise_map: None,
            exposure: None,
            brighten: None,
            tone: None,
            tone_contrast: None,
            saturation: None,
            white_balance_k: None,
            scotopic: None,
            quality: None,
            ..scene.output.clone()
        };
        let perspective = [None, Some(Projection::Perspective)];
        for (set, key) in [
            (scene.observer.altitude_m.is_some(), "observer.altitude_m"),
            (
                !perspective.contains(&camera.projection),
                "camera.projection",
            ),
            (camera.size.is_some(), "camera.size"),
            (output != OutputSpec::default(), "output"),
            (scene.sequence.is_some(), "sequence"),
        ] {
            if set {
                let expected =
                    "the projection, size and encoding of the colour picture, and eye_height_m";
                return refuse(key, expected, "others", "leaving it out");
            }
        }
        Ok(())
    }

    /// Refuses patches where something would see even fog.
    fn check_patches(&self) -> Result<(), RenderError> {
        let refuse = |expected, got, advice| {
            Err(RenderError::value(
                "fog.patches",
                expected,
                got,
                format!("{advice}, or leaving the patches out"),
            ))
        };
        if self.fog().patches.is_none() {
            Ok(())
        } else if self.monte_carlo().is_some() {
            refuse("solver orders", "solver monte-carlo", "solver orders")
        } else if !self.scene.lights.is_empty() {
            refuse("fog in daylight", "lights in it", "leaving light out")
        } else {
            Ok(())
        }
    }

    /// Refuses settings that fog of one colour would ignore, as it does not scatter light.
    fn check_one_colour(&self) -> Result<(), RenderError> {
        let given = [
            (!self.scene.lights.is_empty(), "light"),
            (!self.fog().layers.is_empty(), "layer"),
            (self.fog().patches.is_some(), "patches"),
            (self.overlay.sky_light, "sky-light"),
            (
                self.fog_scattering() != FogScattering::Multiple,
                "fog-scattering",
            ),
        ];
        match given.iter().find(|(given, _)| *given) {
            None => Ok(()),
            Some((_, key)) => Err(RenderError::setting(format!(
                "{key}: expected fog that scatters light, got a profile of one colour; try fog-profile uniform, height, clamped, \
                 unclamped or slab, not exp2, linear or foggy-cityscapes"
            ))),
        }
    }

    /// Refuses approximate light forms unless all lights are point lights in one layer of uniform, isotropic fog.
    fn check_light_form(&self, profile: FogProfile) -> Result<(), RenderError> {
        let form = self.overlay.light_form;
        if form == LightForm::Exact {
            return Ok(());
        }
        let fog = self.fog();
        let lights = &self.scene.lights;
        let (expected, got, advice) = if lights.is_empty() {
            ("a light", "none", "light")
        } else if profile != FogProfile::Uniform || self.overlay.sky_light {
            (
                "uniform fog",
                "another profile or sky light",
                "fog-profile uniform without sky-light",
            )
        } else if !fog.layers.is_empty() {
            ("one layer of fog", "several", "leaving out layer")
        } else if fog.droplets != Some(DropletKind::Isotropic) {
            (
                "isotropically scattering fog",
                "other droplets",
                "droplets isotropic",
            )
        } else if lights.iter().any(|light| light.kind != LightKind::Point) {
            ("point lights", "another kind", "kind=point for each light")
        } else {
            return Ok(());
        };
        Err(RenderError::setting(format!(
            "light-form {}: expected {expected}, got {got}; try {advice}, or leaving out light-form",
            form.name()
        )))
    }
}

/// A layer of the fog; unlike in a sky, it needs no upper end.
fn fog_layer(layer: &FogLayerSpec, key: &str, contrast: Contrast) -> Result<FogLayer, SceneError> {
    if layer.implied_profile() != FogProfile::Uniform {
        return layer.resolve(key, contrast);
    }
    let thinning = FogLayerSpec {
        profile: Some(FogProfile::Height),
        ..layer.clone()
    };
    Ok(FogLayer {
        profile: DensityProfile::Uniform,
        ..thinning.resolve(key, contrast)?
    })
}

/// Whether fog with this profile has one colour and does not scatter light.
fn is_one_colour(profile: FogProfile) -> bool {
    matches!(
        profile,
        FogProfile::Exp2 | FogProfile::Linear | FogProfile::FoggyCityscapes
    )
}
