//! [`Renderer`]: a checked scene, its solver and the layout of its files.

use crate::display;
use crate::error::RenderError;
use crate::exposure::ExposureSettings;
use crate::ignored::refuse_ignored;
use crate::layout::{Layout, is_spectral};
use crate::objects::Objects;
use airlight::models::registry;
use airlight::scene::{
    FogPatchesSpec, PreparedModel, RadianceModel, ResolvedScene, Scene, SunAngles, check_inputs,
};
use airlight::sky::SunCoverage;
use airlight::sun::Moment;
use airlight_image::output::exr::ExrOptions;
use airlight_image::output::jpeg::JpegOptions;
use airlight_image::output::png::{PngDepth, PngOptions};
use airlight_image::tone::{self, ToneMapper};
use airlight_image::{Control, PictureOptions};
use std::path::Path;
use std::sync::Arc;

/// Stage between solving and drawing: the light at the eye, in tables, and that of the fog.
pub(crate) const LIGHT_AT_THE_EYE: &str = "tabulating the light at the eye";

/// Draws a scene.
///
/// ```no_run
/// # use airlight::scene::Scene;
/// # use airlight_image::Control;
/// # use airlight_render::Renderer;
/// let scene = Scene::from_toml("sun.elevation_deg = 10\noutput.file = \"sky.exr\"")?;
/// Renderer::new(&scene)?.write(Control::default())?;
/// # Ok::<(), airlight_render::RenderError>(())
/// ```
///
/// [`Renderer::write`] and [`Renderer::render`] draw a scene in one call. In steps: [`Renderer::prepare`] solves for the light
/// under a range of suns, [`Renderer::frame`] returns one moment, which can be written, drawn to memory or previewed, and
/// [`Renderer::sequence`] lists the moments of a sequence.
#[derive(Clone, Debug)]
pub struct Renderer {
    scene: Scene,
    resolved: ResolvedScene,
    model: &'static dyn RadianceModel,
    layout: Layout,
    objects: Option<Arc<Objects>>,
    texts: Vec<(String, String)>,
    common_exposure: Option<tone::Exposure>,
}

impl Renderer {
    /// Checks a scene as far as possible without solving for light.
    ///
    /// # Errors
    /// [`RenderError`] for values out of range, values that contradict each other, inputs that the solver would ignore, and options
    /// that the format of the file would ignore.
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        Self::checked(scene, false)
    }

    /// As [`Renderer::new`], for a picture that is also previewed, so that options of display formats act on the preview even if
    /// the file holds linear light.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn previewed(scene: &Scene) -> Result<Self, RenderError> {
        Self::checked(scene, true)
    }

    fn checked(scene: &Scene, is_previewed: bool) -> Result<Self, RenderError> {
        let mut scene = scene.clone();
        // Also selected by the file name.
        if is_spectral(&scene.output) {
            scene.output.spectral = Some(true);
        }
        let mut resolved = scene.resolve()?;
        if scene.output.spectral != Some(true) {
            resolved = resolved.for_colors();
        }
        let model = registry::of_scene(&resolved)?;
        let variant = scene.solver.variant.as_deref();
        check_inputs(model, &resolved.set_inputs, variant, registry::ALL)?;
        let sun = resolved.sun.at_start()?;
        let layout = Layout::new(&scene.camera, &scene.output, sun.azimuth_deg)?;
        if let (Some(file), Some(format)) = (&scene.output.file, layout.format()) {
            refuse_ignored(&scene.output, Path::new(file), format, is_previewed)?;
        }
        let objects = match &scene.objects {
            Some(spec) if spec.is_set() => Some(Arc::new(Objects::from_specs(&spec.object)?)),
            _ => None,
        };
        let renderer = Self {
            scene,
            resolved,
            model,
            layout,
            objects,
            texts: Vec::new(),
            common_exposure: None,
        };
        renderer.exposure().fixed()?;
        Ok(renderer)
    }

    /// The same renderer with a named text in the metadata of every file.
    pub fn with_text(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.texts.push((name.into(), text.into()));
        self
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene in physical quantities.
    pub fn resolved(&self) -> &ResolvedScene {
        &self.resolved
    }

    /// The solver or published model.
    pub fn model(&self) -> &'static dyn RadianceModel {
        self.model
    }

    /// Frames, names and formats of the files.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Objects in front of the sky.
    pub fn objects(&self) -> Option<&Arc<Objects>> {
        self.objects.as_ref()
    }

    /// Position of the sun at a time, or at that of the scene for `None`.
    ///
    /// # Errors
    /// [`RenderError::Scene`] for a time outside the range of the ephemeris.
    pub fn sun(&self, time: Option<Moment>) -> Result<SunAngles, RenderError> {
        Ok(match time {
            Some(time) => self.resolved.sun.at(time)?,
            None => self.resolved.sun.at_start()?,
        })
    }

    /// The patches of the fog at a time of a sequence, moved by the wind since its start; `None` if they do not move.
    pub(crate) fn patches_at(&self, time: Option<Moment>) -> Option<FogPatchesSpec> {
        let patches = self.scene.fog.as_ref()?.patches.as_ref()?;
        let (time, start) = (time?, self.resolved.sun.start()?);
        let elapsed_s = time.unix_s() - start.unix_s().floor();
        patches.wind_m_s.map(|_| patches.after(elapsed_s))
    }

    /// The smallest range of suns that includes one sun.
    pub fn suns_near(&self, sun: &SunAngles) -> SunCoverage {
        SunCoverage::near(sun.elevation_deg, self.resolved.observer_altitude_m)
    }

    /// Solves for the light under a range of suns, which all moments share.
    ///
    /// # Errors
    /// [`RenderError::Scene`] if the solver fails or the caller cancelled.
    pub fn prepare(
        &self,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, RenderError> {
        control.stage("solving for the light in the air", 0);
        let prepared = self.model.prepare(&self.resolved, suns, control)?;
        control.stage(LIGHT_AT_THE_EYE, 0);
        Ok(prepared)
    }

    /// The scene's output file.
    ///
    /// # Errors
    /// [`RenderError`] if the scene has none.
    pub fn output_path(&self) -> Result<&Path, RenderError> {
        self.scene
            .output
            .file
            .as_deref()
            .map(Path::new)
            .ok_or_else(|| {
                RenderError::value(
                    "output.file",
                    "a file to write",
                    "none",
                    "file = \"sky.exr\"",
                )
            })
    }

    /// Exposure settings of display pictures.
    pub fn exposure(&self) -> ExposureSettings {
        ExposureSettings::of(&self.scene.output)
    }

    /// The same renderer with one exposure for all pictures.
    pub fn with_exposure(mut self, exposure: tone::Exposure) -> Self {
        self.common_exposure = Some(exposure);
        self
    }

    /// The exposure given by [`Renderer::with_exposure`], or metered for a whole sequence.
    pub fn common_exposure(&self) -> Option<tone::Exposure> {
        self.common_exposure
    }

    /// The exposure if it does not depend on the picture.
    pub(crate) fn given_exposure(&self) -> Result<Option<tone::Exposure>, RenderError> {
        match self.common_exposure {
            Some(exposure) => Ok(Some(exposure)),
            None => Ok(self.exposure().fixed()?),
        }
    }

    /// The tone mapper of display pictures with an exposure.
    ///
    /// # Errors
    /// [`RenderError`] for a setting out of range.
    pub fn tone_mapper(&self, exposure: tone::Exposure) -> Result<ToneMapper, RenderError> {
        Ok(display::tone_mapper(&self.scene.output, exposure)?)
    }

    /// Encoding of the files, without metadata.
    pub fn picture_options(&self) -> PictureOptions {
        let output = &self.scene.output;
        PictureOptions {
            exr: ExrOptions {
                precision: output.precision.unwrap_or_default(),
                compression: output.compression.unwrap_or_default(),
            },
            png: PngOptions {
                depth: match output.bits {
                    Some(16) => PngDepth::Sixteen,
                    _ => PngDepth::Eight,
                },
                ..PngOptions::default()
            },
            jpeg: JpegOptions {
                quality: output.quality.unwrap_or(92),
            },
            ..PictureOptions::default()
        }
    }

    /// Projection and format of the files for reports, such as "equirectangular, float EXR".
    pub fn kind(&self) -> String {
        let format = match self.layout.format() {
            Some(format) => format.describe(&self.picture_options()),
            None => "picture".to_owned(),
        };
        let spectral = if self.layout.is_spectral() {
            "spectral "
        } else {
            ""
        };
        format!("{}, {spectral}{format}", self.layout.projection_name())
    }

    pub(crate) fn texts(&self) -> &[(String, String)] {
        &self.texts
    }

    pub(crate) fn casts_shadows(&self) -> bool {
        let objects = self.scene.objects.as_ref();
        objects.and_then(|objects| objects.shadows).unwrap_or(true)
    }
}
