//! One moment of a picture, made ready to be drawn.

use super::channels::RgbWeights;
use super::disc::Disc;
use super::fog::Fog;
use super::objects::LitScene;
use super::renderer::Renderer;
use crate::args::SunDiscArg;
use crate::error::CliError;
use crate::illuminance::Illuminances;
use crate::models::Lit;
use crate::scene::Sun;
use airlight::sky::{Sky, SkyTable, SunCoverage};
use airlight::sun::Moment;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;

/// What is made ready once for all moments.
pub enum Prepared {
    /// The light inside the air.
    Solved(Box<Sky>),
    /// Nothing: a published model answers for each moment on its own.
    Classic,
}

impl Prepared {
    /// Solves for the light under these suns, where the solver asked for needs it; tells how long it took.
    ///
    /// # Errors
    /// As [`crate::scene::Scene::prepare`].
    pub fn new(renderer: &Renderer<'_>, suns: SunCoverage) -> Result<(Self, Duration), CliError> {
        if renderer.args.air.solver.is_published_model() {
            return Ok((Self::Classic, Duration::ZERO));
        }
        let (sky, time) = renderer.scene.prepare(suns)?;
        Ok((Self::Solved(Box::new(sky)), time))
    }
}

/// One moment, tabulated.
pub struct PreparedFrame {
    /// Where the sun stands.
    pub sun: Sun,
    /// When.
    pub time: Option<Moment>,
    /// Light at the eye.
    pub light: Illuminances,
    /// Where it comes from.
    pub source: Source,
    /// The sun's disc, where it is drawn and seen.
    pub disc: Option<Disc>,
    /// Things before the sky.
    pub objects: Option<LitScene>,
    weights: RgbWeights,
}

/// Where a shot's light comes from.
pub enum Source {
    /// The solver.
    Solved {
        /// Its sky, tabulated.
        table: Arc<SkyTable>,
        /// The fog before it.
        fog: Option<Fog>,
    },
    /// A published model.
    Model(Arc<Lit>),
}

impl<'a> PreparedFrame {
    /// Tabulates the sky under a sun, and the fog before it.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none, or what a published model refuses.
    pub fn new(
        renderer: &Renderer<'_>,
        prepared: &'a Prepared,
        sun: &Sun,
        time: Option<Moment>,
    ) -> Result<Self, CliError> {
        match prepared {
            Prepared::Solved(sky) => Self::solved(renderer, sky, sun, time),
            Prepared::Classic => Self::classic(renderer, sun, time),
        }
    }

    fn solved(
        renderer: &Renderer<'_>,
        sky: &'a Sky,
        sun: &Sun,
        time: Option<Moment>,
    ) -> Result<Self, CliError> {
        let channels = renderer.channels;
        let grid = &renderer.scene.grid;
        let view = renderer.scene.view(sky, sun);
        let fog = Fog::new(&renderer.args.fog, &view, channels.table())?;
        let table = match &fog {
            Some(fog) => fog.clear(),
            None => Arc::new(view.table(channels.table())),
        };
        let luminance = |values: &[f32]| channels.luminance(grid, values);
        let mut light = Illuminances::of(&view, &table, luminance);
        if let Some(fog) = &fog {
            let left = f64::from(fog.transmittance(view.sun()));
            light = light.through(left, fog.horizontal_lx(luminance));
        }
        let weights = channels.rgb_weights(grid);
        let disc = match renderer.args.picture.sun_disc {
            SunDiscArg::Out => None,
            _ => Disc::new(
                &view,
                table.horizon_elevation_rad(),
                &weights,
                channels.spectral.is_some(),
                |direction| fog.as_ref().map_or(1.0, |fog| fog.transmittance(direction)),
            ),
        };
        let objects = renderer
            .objects
            .map(|objects| LitScene::solved(objects, (renderer.args, channels), &view))
            .transpose()?;
        Ok(Self {
            sun: *sun,
            time,
            light,
            source: Source::Solved { table, fog },
            disc,
            weights,
            objects,
        })
    }

    fn classic(renderer: &Renderer<'_>, sun: &Sun, time: Option<Moment>) -> Result<Self, CliError> {
        let args = renderer.args;
        let (lit, scene1987) = crate::models::lit_in_picture(args, renderer.scene, sun)?;
        let lit = Arc::new(lit);
        let channels = renderer.channels;
        let disc = match args.picture.sun_disc {
            SunDiscArg::Out => None,
            _ => {
                let to_rgb = channels.space.from_xyz_matrix();
                Disc::of_classic(lit.model.clone(), to_rgb, channels.spectral.is_some())
            }
        };
        let weights = channels.rgb_weights(&renderer.scene.grid);
        let objects = renderer.objects.map(|objects| match &scene1987 {
            Some(scene) => LitScene::of_1987(objects, (args, channels), scene, &weights),
            None => LitScene::classic(objects, (args, channels), renderer.scene, &lit),
        });
        Ok(Self {
            sun: *sun,
            time,
            light: lit.illuminances(),
            source: Source::Model(lit),
            disc,
            weights,
            objects,
        })
    }

    /// Weights of wavelengths in RGB.
    pub fn weights(&self) -> &RgbWeights {
        &self.weights
    }

    /// Whether a direction points to the ground.
    pub fn is_below_horizon(&self, direction: DVec3) -> bool {
        let horizon_rad = match &self.source {
            Source::Solved { table, .. } => table.horizon_elevation_rad(),
            Source::Model(_) => 0.0,
        };
        direction.y.clamp(-1.0, 1.0).asin() < horizon_rad
    }
}
