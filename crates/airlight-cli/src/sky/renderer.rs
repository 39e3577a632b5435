//! One moment into files.

use super::channels::Channels;
use super::layout::{Layout, PictureFile};
use super::models::{self, ModelRows};
use super::objects::{self, ObjectRows};
use super::prepared_frame::{PreparedFrame, Source};
use super::rows::{Layer, SkyRows};
use super::{exposure, metadata, monte_carlo};
use crate::args::{CompressionArg, PrecisionArg, SkyArgs};
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use crate::report;
use crate::scene::{Scene, Sun};
use airlight_image::output::exr::{ExrCompression, ExrOptions, ExrSample};
use airlight_image::output::jpeg::JpegOptions;
use airlight_image::output::png::{PngDepth, PngOptions};
use airlight_image::output::{Written, spectral};
use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Control, Frame, PictureFormat, PictureOptions, RowSource, write_picture};
use airlight_render::objects::Objects;
use std::path::Path;
use std::sync::Arc;

/// What is drawn and how.
pub struct Renderer<'a> {
    /// The options.
    pub args: &'a SkyArgs,
    /// Air, eye and sun.
    pub scene: &'a Scene,
    /// Files and frames.
    pub layout: &'a Layout,
    /// Values of a pixel.
    pub channels: &'a Channels,
    /// Things before the sky.
    pub objects: Option<&'a Arc<Objects>>,
}

/// What the options come to: what a [`Renderer`] borrows.
pub struct Setup {
    /// Air, eye and sun.
    pub scene: Scene,
    /// The sun at the start.
    pub first: Sun,
    layout: Layout,
    channels: Channels,
    objects: Option<Arc<Objects>>,
}

impl Setup {
    /// Puts the options together.
    ///
    /// # Errors
    /// [`CliError`] where they do not fit together or a file cannot be read.
    pub fn new(args: &SkyArgs) -> Result<Self, CliError> {
        let scene = Scene::new(&args.place, &args.air)?;
        args.air.monte_carlo(monte_carlo::PATHS)?;
        let first = scene.sun.at(None)?;
        let layout = Layout::new(args, &first)?;
        models::check(args, layout.is_spectral())?;
        let channels = Channels::new(&args.picture, layout.is_spectral(), &scene)?;
        Ok(Self {
            scene,
            first,
            layout,
            channels,
            objects: objects::read(args)?,
        })
    }

    /// What is drawn and how.
    pub fn renderer<'a>(&'a self, args: &'a SkyArgs) -> Renderer<'a> {
        Renderer {
            args,
            scene: &self.scene,
            layout: &self.layout,
            channels: &self.channels,
            objects: self.objects.as_ref(),
        }
    }
}

impl Renderer<'_> {
    /// Refuses what would fail after all has been computed: an exposure that is none, files that cannot be made.
    ///
    /// # Errors
    /// [`CliError`]: what.
    pub fn check(&self, first: Option<&Path>) -> Result<(), CliError> {
        exposure::fixed(&self.args.picture)?;
        for file in first
            .map(|path| self.layout.files(path))
            .unwrap_or_default()
        {
            report::check_writable(&file.path)?;
        }
        Ok(())
    }

    /// The rows of a frame; with the sky that another solver has made, where there is one.
    pub fn rows<'s>(
        &self,
        prepared: &'s PreparedFrame,
        frame: &Frame,
        (layer, scale): (Layer, f32),
        solved: Option<&'s [f32]>,
    ) -> Box<dyn RowSource + 's> {
        let sky = self.sky_rows(prepared, frame, (layer, scale), solved);
        let Some(objects) = &prepared.objects else {
            return sky;
        };
        let spectral = self.layout.is_spectral().then_some(prepared.weights());
        Box::new(ObjectRows::new(
            sky,
            objects,
            (frame, layer),
            spectral,
            scale,
        ))
    }

    /// The same without the things before the sky.
    fn sky_rows<'s>(
        &self,
        prepared: &'s PreparedFrame,
        frame: &Frame,
        (layer, scale): (Layer, f32),
        solved: Option<&'s [f32]>,
    ) -> Box<dyn RowSource + 's> {
        let disc = prepared.disc.as_ref();
        match &prepared.source {
            Source::Solved { table, fog } => {
                let spectral = self.layout.is_spectral().then_some(prepared.weights());
                let sky = (table.as_ref(), fog.as_ref());
                let sun = prepared.sun.direction();
                let rows = SkyRows::new(frame, layer, sky, disc, spectral, sun, scale);
                Box::new(rows.with_solved(solved))
            }
            Source::Model(lit) => {
                let (spectral, space) = (self.layout.is_spectral(), self.channels.space);
                let light = (lit.as_ref(), disc);
                Box::new(ModelRows::new(frame, layer, light, spectral, space, scale))
            }
        }
    }

    /// Writes the files of a shot.
    ///
    /// # Errors
    /// [`CliError`]: what failed; files before it are whole, and nothing is left of it.
    pub fn write(
        &self,
        prepared: &PreparedFrame,
        files: &[PictureFile],
        bar: &RowsBar,
    ) -> Result<Vec<Written>, CliError> {
        if let Some(settings) = self.args.air.monte_carlo(monte_carlo::PATHS)? {
            return monte_carlo::write(self, prepared, files, settings, bar);
        }
        let tone = self.tone(prepared)?;
        let control = Control::cancelled_by(&STOP).reporting_to(bar);
        let mut written = Vec::with_capacity(files.len());
        for file in files {
            if let Some(objects) = prepared
                .objects
                .as_ref()
                .filter(|_| self.writes_depth(file))
            {
                objects::write_depth(objects, file)?;
            }
            written.push(self.write_file(prepared, file, (None, &tone), control)?);
            bar.file_done(u64::from(file.frame.size().height()));
        }
        Ok(written)
    }

    /// Whether the depth of things is asked for beside a file: once where the sun's disc has a file of its own.
    fn writes_depth(&self, file: &PictureFile) -> bool {
        self.args.objects.depth_map && file.layer != Layer::Disc
    }

    /// The tone mapper of the files' format.
    ///
    /// # Errors
    /// [`CliError`] for an exposure that is none.
    pub fn tone(&self, prepared: &PreparedFrame) -> Result<ToneMapper, CliError> {
        match self.layout.format {
            Some(format) if !format.is_linear() => exposure::tone(self, prepared),
            _ => Ok(ToneMapper::new(1.0, ToneCurve::Clip)?),
        }
    }

    /// Writes a file; with the sky that another solver has made, where there is one.
    ///
    /// # Errors
    /// [`CliError`]: what failed.
    pub fn write_file(
        &self,
        prepared: &PreparedFrame,
        file: &PictureFile,
        (solved, tone): (Option<&[f32]>, &ToneMapper),
        control: Control<'_>,
    ) -> Result<Written, CliError> {
        let linear = self.layout.format.is_some_and(PictureFormat::is_linear);
        let scale = if linear {
            self.args.picture.scale as f32
        } else {
            1.0
        };
        let rows = self.rows(prepared, &file.frame, (file.layer, scale), solved);
        let options = self.options(prepared, file);
        let size = file.frame.size();
        Ok(match &self.channels.spectral {
            Some(layout) => spectral::write(
                &file.path,
                size,
                layout,
                rows.as_ref(),
                &options.exr,
                &options.metadata,
                control,
            )?,
            None => write_picture(&file.path, size, rows.as_ref(), tone, &options, control)?,
        })
    }

    /// How a file is written.
    pub fn options(&self, prepared: &PreparedFrame, file: &PictureFile) -> PictureOptions {
        PictureOptions {
            metadata: metadata::of(self, prepared, file.layer).with_frame(&file.frame),
            ..self.options_without_metadata()
        }
    }

    fn options_without_metadata(&self) -> PictureOptions {
        let args = &self.args.picture;
        PictureOptions {
            exr: ExrOptions {
                sample: match args.precision {
                    PrecisionArg::Float => ExrSample::Float,
                    PrecisionArg::Half => ExrSample::Half,
                },
                compression: match args.compression {
                    CompressionArg::None => ExrCompression::None,
                    CompressionArg::Rle => ExrCompression::Rle,
                    CompressionArg::Zips => ExrCompression::ZipLine,
                    CompressionArg::Zip => ExrCompression::Zip,
                    CompressionArg::Piz => ExrCompression::Piz,
                },
            },
            png: PngOptions {
                depth: if args.bits == "16" {
                    PngDepth::Sixteen
                } else {
                    PngDepth::Eight
                },
                ..PngOptions::default()
            },
            jpeg: JpegOptions {
                quality: args.quality,
            },
            ..PictureOptions::default()
        }
    }

    /// The files' projection and format in words.
    pub fn kind(&self) -> String {
        use crate::args::ProjectionArg::{Cube, Equirectangular, Fisheye, Perspective};
        let projection = match self.args.picture.projection {
            Equirectangular => "equirectangular",
            Cube => "cube face",
            Fisheye => "fisheye",
            Perspective => "perspective",
        };
        let format = match self.layout.format {
            Some(format) => format.describe(&self.options_without_metadata()),
            None => "picture".to_owned(),
        };
        match &self.channels.spectral {
            Some(_) => format!(
                "{projection}, spectral {format}, {} wavelengths",
                self.scene.grid.len()
            ),
            None => format!("{projection}, {format}"),
        }
    }

    /// Says what the format could not hold.
    pub fn warn_of_clipping(&self, written: &[Written]) {
        let clamped: u64 = written.iter().map(|w| w.clamped_samples).sum();
        let nans: u64 = written.iter().map(|w| w.nan_samples).sum();
        if let Some(format) = self.layout.format.filter(|_| clamped > 0) {
            let hint = match format.holds_channels() {
                true => {
                    ": --precision float keeps them, --scale 1e-5 makes them fit, --sun-disc separate or out keeps the sun apart"
                }
                false => "",
            };
            report::note(&format!("{clamped} samples {}{hint}", format.clamping()));
        }
        if nans > 0 {
            report::note(&format!(
                "{nans} samples were not a number and are 0: please report this"
            ));
        }
    }
}

/// The RGB of a small picture's pixels, row after row.
pub fn stored(rows: &dyn RowSource, frame: &Frame) -> Vec<[f32; 3]> {
    let (width, channels) = (frame.size().width() as usize, rows.channels());
    let mut row = vec![0.0; width * channels];
    let mut pixels = Vec::with_capacity(width * frame.size().height() as usize);
    for y in 0..frame.size().height() {
        rows.fill_row(y, &mut row);
        pixels.extend(row.chunks_exact(channels).map(|p| [p[0], p[1], p[2]]));
    }
    pixels
}
