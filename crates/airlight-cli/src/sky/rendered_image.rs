//! A picture in memory instead of in a file.

use super::prepared_frame::{Prepared, PreparedFrame};
use super::renderer::{Setup, stored};
use super::{exposure, monte_carlo};
use crate::args::{ProjectionArg, SkyArgs};
use crate::error::CliError;
use crate::illuminance::Illuminances;
use crate::scene::Sun;
use airlight::spectrum::RgbSpace;
use airlight_image::Frame;
use airlight_image::tone::ToneMapper;
use std::time::{Duration, Instant};

/// A picture in memory.
pub struct RenderedImage {
    /// Where its pixels look.
    pub frame: Frame,
    /// Their RGB space.
    pub space: RgbSpace,
    /// Linear, cd/m^2, row after row.
    pub rgb: Vec<[f32; 3]>,
    /// The sun.
    pub sun: Sun,
    /// Light at the eye.
    pub light: Illuminances,
    /// How it is shown.
    pub tone: ToneMapper,
    /// How long it took, to solve and to draw.
    pub time: Duration,
}

impl RenderedImage {
    /// Draws what the options of `airlight sky` say.
    ///
    /// # Errors
    /// [`CliError`]: what was wrong with the options, or what failed.
    pub fn new(args: &SkyArgs) -> Result<Self, CliError> {
        if args.picture.projection == ProjectionArg::Cube {
            return Err(CliError::usage(
                "--projection cube is six pictures: give equirectangular, fisheye or perspective",
            ));
        }
        let start = Instant::now();
        let setup = Setup::new(args)?;
        let renderer = setup.renderer(args);
        let (sun, scene, layout) = (setup.first, renderer.scene, renderer.layout);
        let (prepared, _) = Prepared::new(&renderer, scene.near(&sun))?;
        let prepared = PreparedFrame::new(&renderer, &prepared, &sun, scene.sun.start())?;
        let frame = layout.only_frame();
        let solved = match args.air.monte_carlo(monte_carlo::PATHS)? {
            Some(settings) => Some(monte_carlo::means(&renderer, &prepared, frame, settings)?),
            None => None,
        };
        let rows = renderer.rows(
            &prepared,
            &frame,
            (layout.main_layer(), 1.0),
            solved.as_deref(),
        );
        Ok(Self {
            frame,
            space: renderer.channels.space,
            rgb: stored(rows.as_ref(), &frame),
            sun,
            light: prepared.light,
            tone: exposure::tone(&renderer, &prepared)?,
            time: start.elapsed(),
        })
    }

    /// As a display shows it, three bytes a pixel.
    pub fn displayed(&self, tone: &ToneMapper) -> airlight_plot::Raster {
        let size = self.frame.size();
        let width = size.width() as usize;
        let mut rgb = vec![0; 3 * self.rgb.len()];
        for ((y, row), out) in (0..)
            .zip(self.rgb.chunks_exact(width))
            .zip(rgb.chunks_exact_mut(3 * width))
        {
            tone.row_to_u8(y, row.as_flattened(), out);
        }
        airlight_plot::Raster {
            width: size.width(),
            height: size.height(),
            rgb,
        }
    }
}
