//! One moment of a picture, made ready to be drawn.

use super::channels::RgbWeights;
use super::disc::Disc;
use super::draw::Drawing;
use super::fog::Fog;
use super::objects::Things;
use crate::args::SunDiscArg;
use crate::classic::Lit;
use crate::error::CliError;
use crate::light::Illuminances;
use crate::moment::Moment;
use crate::scene::Sun;
use airlight::sky::{Sky, SkyTable, SunCoverage};
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
    pub fn new(drawing: &Drawing<'_>, suns: SunCoverage) -> Result<(Self, Duration), CliError> {
        if drawing.args.air.solver.is_classic() {
            return Ok((Self::Classic, Duration::ZERO));
        }
        let (sky, time) = drawing.scene.prepare(suns)?;
        Ok((Self::Solved(Box::new(sky)), time))
    }
}

/// One moment, tabulated.
pub struct Shot<'a> {
    /// Where the sun stands.
    pub sun: Sun,
    /// When.
    pub time: Option<Moment>,
    /// Light at the eye.
    pub light: Illuminances,
    /// Where it comes from.
    pub source: Source<'a>,
    /// The sun's disc, where it is drawn and seen.
    pub disc: Option<Disc>,
    /// Things before the sky.
    pub things: Option<Things<'a>>,
    weights: RgbWeights,
}

/// Where a shot's light comes from.
pub enum Source<'a> {
    /// The solver.
    Solved {
        /// Its sky, tabulated.
        table: Arc<SkyTable>,
        /// The fog before it.
        fog: Option<Fog<'a>>,
    },
    /// A published model.
    Classic(Arc<Lit>),
}

impl<'a> Shot<'a> {
    /// Tabulates the sky under a sun, and the fog before it.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none, or what a published model refuses.
    pub fn new(
        drawing: &Drawing<'_>,
        prepared: &'a Prepared,
        sun: &Sun,
        time: Option<Moment>,
    ) -> Result<Self, CliError> {
        match prepared {
            Prepared::Solved(sky) => Self::solved(drawing, sky, sun, time),
            Prepared::Classic => Self::classic(drawing, sun, time),
        }
    }

    fn solved(
        drawing: &Drawing<'_>,
        sky: &'a Sky,
        sun: &Sun,
        time: Option<Moment>,
    ) -> Result<Self, CliError> {
        let channels = drawing.channels;
        let grid = &drawing.scene.grid;
        let view = drawing.scene.view(sky, sun);
        let fog = Fog::new(&drawing.args.fog, &view, channels.table())?;
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
        let disc = match drawing.args.picture.sun_disc {
            SunDiscArg::Out => None,
            _ => Disc::new(
                &view,
                table.horizon_elevation_rad(),
                &weights,
                channels.spectral.is_some(),
                |direction| fog.as_ref().map_or(1.0, |fog| fog.transmittance(direction)),
            ),
        };
        let things = drawing
            .objects
            .map(|objects| Things::solved(objects, (drawing.args, channels), &view))
            .transpose()?;
        Ok(Self {
            sun: *sun,
            time,
            light,
            source: Source::Solved { table, fog },
            disc,
            weights,
            things,
        })
    }

    fn classic(drawing: &Drawing<'_>, sun: &Sun, time: Option<Moment>) -> Result<Self, CliError> {
        let args = drawing.args;
        let (lit, scene1987) = crate::classic::lit_in_picture(args, drawing.scene, sun)?;
        let lit = Arc::new(lit);
        let channels = drawing.channels;
        let disc = match args.picture.sun_disc {
            SunDiscArg::Out => None,
            _ => {
                let to_rgb = channels.space.from_xyz_matrix();
                Disc::of_classic(lit.model.clone(), to_rgb, channels.spectral.is_some())
            }
        };
        let weights = channels.rgb_weights(&drawing.scene.grid);
        let things = drawing.objects.map(|objects| match &scene1987 {
            Some(scene) => Things::of_1987(objects, (args, channels), scene, &weights),
            None => Things::classic(objects, (args, channels), drawing.scene, &lit),
        });
        Ok(Self {
            sun: *sun,
            time,
            light: lit.illuminances(),
            source: Source::Classic(lit),
            disc,
            weights,
            things,
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
            Source::Classic(_) => 0.0,
        };
        direction.y.clamp(-1.0, 1.0).asin() < horizon_rad
    }
}
