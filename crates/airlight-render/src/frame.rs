//! [`PreparedFrame`]: one moment of a scene, ready to draw.

use crate::canvas::{Canvas, POLARISATION_CHANNELS, Passes, polarisation};
use crate::channels::PixelChannels;
use crate::error::RenderError;
use crate::exposure::{METERED_WIDTH, MeteredPicture};
use crate::gamut::InGamut;
use crate::illuminance::Illuminances;
use crate::image::RenderedImage;
use crate::layout::PictureFile;
use crate::metadata::FrameMetadata;
use crate::objects::{LitObjects, ObjectRows, write_depth};
use crate::renderer::Renderer;
use crate::shard::Shard;
use crate::sky_rows::{Layer, SkyRows, SkySources, SkyValues};
use crate::sun_disc::SunDiscImage;
use airlight::Cancelled;
use airlight::night::NightState;
use airlight::scene::{
    Channels, FogLayers, Gamut, PreparedModel, RadianceSampler, RadianceView, SunAngles,
    SunDiscPlacement,
};
use airlight::sky::PolarisationTable;
use airlight::sun::Moment;
use airlight_image::output::exr::{self, ExrOptions, SamplePrecision};
use airlight_image::output::{Metadata, Written, spectral};
use airlight_image::rows::{RowsFrom, StoredRows, draw_rows};
use airlight_image::tone::{Exposure, ToneCurve, ToneMapper};
use airlight_image::{
    Control, Frame, ImageError, PictureOptions, Progress, RowSource, Size, write_picture,
};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// One moment of a scene: the light at the eye, and objects.
#[derive(Debug)]
pub struct PreparedFrame<'r> {
    renderer: &'r Renderer,
    sun: SunAngles,
    time: Option<Moment>,
    view: Arc<dyn RadianceView>,
    /// View without noise.
    preview: Arc<dyn RadianceView>,
    channels: PixelChannels,
    light: Illuminances,
    /// Discs of sun and moon.
    discs: Vec<SunDiscImage>,
    night: Option<NightState>,
    objects: Option<LitObjects>,
}

/// A picture file that was written.
#[derive(Clone, Debug)]
pub struct WrittenFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Width and height, pixels.
    pub size: Size,
    /// Number of bytes, and of samples out of the format's range.
    pub written: Written,
}

/// Files written for one moment.
#[derive(Clone, Debug, Default)]
pub struct WrittenFrame {
    /// The files, with the main file last.
    pub files: Vec<WrittenFile>,
    /// Root mean square over the picture of the relative standard error of a pixel's green; `None` without noise.
    pub noise: Option<f64>,
    /// Exposure of a display format; `None` for linear formats.
    pub exposure: Option<Exposure>,
}

impl Renderer {
    /// The scene at a time (`None`: at its own time), ready to draw.
    ///
    /// # Errors
    /// [`RenderError::Scene`] for a sun outside the solver's domain.
    pub fn frame<'r>(
        &'r self,
        prepared: &dyn PreparedModel,
        time: Option<Moment>,
    ) -> Result<PreparedFrame<'r>, RenderError> {
        self.frame_with(prepared, time, Control::default())
    }

    /// As [`Renderer::frame`], with cancellation.
    ///
    /// # Errors
    /// As [`Renderer::frame`], and if the caller cancelled.
    pub fn frame_with<'r>(
        &'r self,
        prepared: &dyn PreparedModel,
        time: Option<Moment>,
        control: Control<'_>,
    ) -> Result<PreparedFrame<'r>, RenderError> {
        PreparedFrame::new(self, prepared, time, control)
    }
}

impl<'r> PreparedFrame<'r> {
    fn new(
        renderer: &'r Renderer,
        prepared: &dyn PreparedModel,
        time: Option<Moment>,
        control: Control<'_>,
    ) -> Result<Self, RenderError> {
        let scene = renderer.resolved();
        let sun = renderer.sun(time)?;
        let space = renderer.scene().output.color_space.unwrap_or_default();
        let channels = match (renderer.layout().is_spectral(), prepared.grid()) {
            (true, Some(grid)) => PixelChannels::spectral(space, grid)?,
            _ => PixelChannels::rgb(space),
        };
        let state = sun.state();
        let night = match time {
            Some(time) => scene.night_at(&sun, time),
            None => scene.night(&sun),
        };
        let moved = renderer.patches_at(time).and_then(|patches| {
            let fog = FogLayers {
                patches: Some(patches.patches()),
                ..scene.fog.clone()?
            };
            prepared.with_fog(Some(&fog))
        });
        let prepared = moved.as_deref().unwrap_or(prepared);
        let view_at = |altitude_m: f64, channels: Channels| match &night {
            Some(night) => prepared.night_view_with(altitude_m, &state, night, channels, control),
            None => prepared.view_with(altitude_m, &state, channels, control),
        };
        let view = view_at(scene.observer_altitude_m, channels.of_views())?;
        let preview = match view.sampler() {
            Some(sampler) => sampler.preview(),
            None => view.clone(),
        };
        let discs = match renderer.scene().output.sun_disc {
            Some(SunDiscPlacement::Out) => Vec::new(),
            _ => [Some(&preview), preview.moon()]
                .into_iter()
                .flatten()
                .filter_map(|view| SunDiscImage::new(view.clone()))
                .collect(),
        };
        let objects = renderer
            .objects()
            .map(|objects| {
                let light = prepared.object_channels(channels.of_views());
                let at = |altitude_m| view_at(altitude_m, light);
                LitObjects::in_scene(objects.clone(), scene, at, renderer.casts_shadows())
                    .map(|lit| lit.in_picture(&channels))
            })
            .transpose()?;
        Ok(Self {
            renderer,
            sun,
            time: time.or(scene.sun.start()),
            light: Illuminances::of(preview.as_ref()),
            view,
            preview,
            channels,
            discs,
            night,
            objects,
        })
    }

    /// Celestial sphere and moon, if the picture shows the lights of the night.
    pub fn night(&self) -> Option<&NightState> {
        self.night.as_ref()
    }

    /// Position of the sun.
    pub fn sun(&self) -> &SunAngles {
        &self.sun
    }

    /// Time of the picture; `None` for a fixed sun.
    pub fn time(&self) -> Option<Moment> {
        self.time
    }

    /// Illuminances at the eye.
    pub fn light(&self) -> &Illuminances {
        &self.light
    }

    /// View of the solver.
    pub fn view(&self) -> &Arc<dyn RadianceView> {
        &self.view
    }

    /// Values of a pixel.
    pub fn channels(&self) -> &PixelChannels {
        &self.channels
    }

    /// Rows of a layer in a frame, without noise: by the scene's solver, or a deterministic solver instead of Monte Carlo. Values
    /// are radiance or luminance multiplied by `scale`.
    pub fn rows<'s>(&'s self, frame: &Frame, layer: Layer, scale: f32) -> Box<dyn RowSource + 's> {
        let view = self.preview.as_ref();
        self.rows_over(frame, layer, SkyValues::View(view), scale)
    }

    fn rows_over<'s>(
        &'s self,
        frame: &Frame,
        layer: Layer,
        sky: SkyValues<'s>,
        scale: f32,
    ) -> Box<dyn RowSource + 's> {
        let channels = &self.channels;
        let sources = SkySources {
            sky,
            discs: &self.discs,
            stars: self.preview.stars(),
        };
        let sky = SkyRows::new(frame, layer, sources, channels, scale);
        match &self.objects {
            None => Box::new(sky),
            Some(objects) => Box::new(ObjectRows::new(
                Box::new(sky),
                objects,
                (frame, layer),
                channels,
                scale,
            )),
        }
    }

    /// Red, green and blue of a small picture, row by row, without noise.
    pub fn pixels(&self, frame: &Frame, layer: Layer) -> Vec<[f32; 3]> {
        let drawn = stored(
            self.rows(frame, layer, 1.0).as_ref(),
            frame,
            Control::default(),
        );
        drawn.expect("nothing cancels it")
    }

    /// The exposure of display pictures.
    ///
    /// # Errors
    /// [`RenderError`] for an exposure out of range.
    pub fn exposure(&self) -> Result<Exposure, RenderError> {
        let settings = self.renderer.exposure();
        if let Some(exposure) = self.renderer.given_exposure()? {
            return Ok(exposure);
        }
        let frame = self.renderer.layout().overview(METERED_WIDTH)?;
        let pixels = self.pixels(&frame, Layer::Sky);
        Ok(settings.metered(&MeteredPicture::of_frame(
            &frame,
            &pixels,
            self.channels.space(),
            self.preview.horizon_elevation_rad(),
            self.light.horizontal_lx(),
        ))?)
    }

    /// The tone mapper from linear light to display values.
    ///
    /// # Errors
    /// As [`PreparedFrame::exposure`].
    pub fn tone(&self) -> Result<ToneMapper, RenderError> {
        self.renderer.tone_mapper(self.exposure()?)
    }

    /// Draws a frame to memory.
    ///
    /// # Errors
    /// [`RenderError`] for an exposure out of range, and if the caller cancelled.
    pub fn image(&self, frame: &Frame, control: Control<'_>) -> Result<RenderedImage, RenderError> {
        let layer = self.renderer.layout().main_layer();
        let means = match self.view.sampler() {
            Some(sampler) => {
                Canvas::check_memory(std::iter::once(frame.size()), &self.channels)?;
                let mut canvas = Canvas::new(frame.size(), &self.channels, false);
                let pass = Passes::new(sampler.paths()).at_once();
                let rows = u64::from(frame.size().height());
                control.stage("tracing Monte Carlo paths", rows);
                canvas.add(frame, sampler, &pass, control)?;
                Some(canvas.means())
            }
            None => None,
        };
        let sky = match &means {
            Some(means) => SkyValues::Stored {
                values: means,
                first_row: 0,
            },
            None => SkyValues::View(self.preview.as_ref()),
        };
        let rows = self.rows_over(frame, layer, sky, 1.0);
        Ok(RenderedImage {
            frame: *frame,
            space: self.channels.space(),
            rgb: stored(rows.as_ref(), frame, control)?,
            sun: self.sun,
            light: self.light,
            tone: self.tone()?,
            time: Duration::ZERO,
        })
    }

    /// Writes the files of a picture called `path`.
    ///
    /// # Errors
    /// [`RenderError`]; files that are already written remain, and unfinished ones are removed.
    pub fn write(&self, path: &Path, control: Control<'_>) -> Result<WrittenFrame, RenderError> {
        self.write_files(&self.renderer.layout().files(path), control)
    }

    /// Writes the files of a shard's band of rows of a picture called `path`, as [`Layout::files_of`](crate::layout::Layout::files_of) names
    /// them. Their pixels have the bits of [`PreparedFrame::write`].
    ///
    /// # Errors
    /// As [`PreparedFrame::write`] and [`Layout::files_of`](crate::layout::Layout::files_of).
    pub fn write_shard(
        &self,
        path: &Path,
        shard: Shard,
        control: Control<'_>,
    ) -> Result<WrittenFrame, RenderError> {
        self.write_files(&self.renderer.layout().files_of(path, shard)?, control)
    }

    fn write_files(
        &self,
        files: &[PictureFile],
        control: Control<'_>,
    ) -> Result<WrittenFrame, RenderError> {
        match self.view.sampler() {
            Some(sampler) => self.write_passes(files, sampler, control),
            None => self.write_once(files, control),
        }
    }

    fn write_once(
        &self,
        files: &[PictureFile],
        control: Control<'_>,
    ) -> Result<WrittenFrame, RenderError> {
        let tone = self.file_tone()?;
        let total = rows_of(files);
        control.stage("drawing", total);
        let mut whole = WrittenFrame {
            exposure: self.file_exposure(&tone),
            ..WrittenFrame::default()
        };
        let polarisation = match self.renderer.scene().output.polarisation {
            Some(true) => self.preview.polarisation_table(),
            _ => None,
        };
        let mut done = 0;
        for file in files {
            if let Some(table) = polarisation.as_ref().filter(|_| file.layer != Layer::Disc) {
                let rows = polarisation_rows(file, table)?;
                write_polarisation(file, &rows, control)?;
            }
            if let Some(objects) = self.depth_of(file) {
                write_depth(file, objects, control.reporting_to(&SILENT))?;
            }
            let part = Part {
                control,
                done,
                total,
            };
            let control = control.reporting_to(&part);
            let sky = SkyValues::View(self.preview.as_ref());
            whole
                .files
                .push(self.write_file(file, sky, &tone, control)?);
            done += u64::from(file.size().height());
        }
        Ok(whole)
    }

    /// Writes the files of a Monte Carlo picture in passes, each of which replaces them.
    fn write_passes(
        &self,
        files: &[PictureFile],
        sampler: &dyn RadianceSampler,
        control: Control<'_>,
    ) -> Result<WrittenFrame, RenderError> {
        let tone = self.file_tone()?;
        let drawn = || files.iter().filter(|file| file.layer != Layer::Disc);
        Canvas::check_memory(drawn().map(PictureFile::size), &self.channels)?;
        let polarised = self.renderer.scene().output.polarisation == Some(true);
        let mut canvases: Vec<Option<Canvas>> = files
            .iter()
            .map(|file| {
                (file.layer != Layer::Disc).then(|| {
                    Canvas::new(file.size(), &self.channels, polarised).from_row(file.rows().start)
                })
            })
            .collect();
        let total = rows_of(drawn());
        // Writing takes little time compared with tracing: its progress is not reported.
        let quiet = control.reporting_to(&SILENT);
        let mut whole = WrittenFrame {
            exposure: self.file_exposure(&tone),
            ..WrittenFrame::default()
        };
        for pass in Passes::new(sampler.paths()) {
            control.stage(&pass.to_string(), total);
            whole.files.clear();
            let mut done = 0;
            for (file, canvas) in files.iter().zip(&mut canvases) {
                let means = match canvas {
                    None => None,
                    Some(canvas) => {
                        let part = Part {
                            control,
                            done,
                            total,
                        };
                        canvas.add(&file.frame, sampler, &pass, control.reporting_to(&part))?;
                        done += u64::from(file.size().height());
                        self.write_maps(file, canvas, &tone, quiet)?;
                        Some(canvas.means())
                    }
                };
                let sky = match &means {
                    Some(means) => SkyValues::Stored {
                        values: means,
                        first_row: file.rows().start,
                    },
                    None => SkyValues::View(self.preview.as_ref()),
                };
                whole.files.push(self.write_file(file, sky, &tone, quiet)?);
            }
        }
        let errors = canvases.iter().flatten().map(Canvas::relative_errors);
        let (sum, count) = errors.fold((0.0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        whole.noise = (count > 0).then(|| f64::sqrt(sum / count as f64));
        Ok(whole)
    }

    /// Writes noise and polarisation maps beside a file, if the scene requests them.
    fn write_maps(
        &self,
        file: &PictureFile,
        canvas: &Canvas,
        tone: &ToneMapper,
        control: Control<'_>,
    ) -> Result<(), RenderError> {
        let output = &self.renderer.scene().output;
        if output.noise_map == Some(true) {
            let rows = canvas.noise(output.scale.unwrap_or(1.0) as f32)?;
            let (path, size) = (file.map_path("noise"), file.size());
            write_picture(&path, size, &rows, tone, &self.options(file, tone), control)?;
        }
        if let Some(rows) = canvas.polarisation() {
            write_polarisation(file, &rows?, control)?;
        }
        Ok(())
    }

    fn write_file(
        &self,
        file: &PictureFile,
        sky: SkyValues<'_>,
        tone: &ToneMapper,
        control: Control<'_>,
    ) -> Result<WrittenFile, RenderError> {
        let renderer = self.renderer;
        let is_linear = renderer.layout().format().is_some_and(|f| f.is_linear());
        let scale = match is_linear {
            true => renderer.scene().output.scale.unwrap_or(1.0) as f32,
            false => 1.0,
        };
        let mut rows = self.rows_over(&file.frame, file.layer, sky, scale);
        if is_linear && renderer.scene().output.gamut == Some(Gamut::Desaturate) {
            rows = Box::new(InGamut::new(rows, self.channels.space()));
        }
        let rows = RowsFrom::new(rows.as_ref(), file.rows().start);
        let options = self.options(file, tone);
        let (path, size) = (&file.path, file.size());
        let written = match self.channels.layout() {
            Some(layout) => spectral::write(
                path,
                size,
                layout,
                &rows,
                &options.exr,
                &options.metadata,
                control,
            )?,
            None => write_picture(path, size, &rows, tone, &options, control)?,
        };
        Ok(WrittenFile {
            path: path.clone(),
            size,
            written,
        })
    }

    /// Tone mapper for the format of the files.
    fn file_tone(&self) -> Result<ToneMapper, RenderError> {
        match self.renderer.layout().format() {
            Some(format) if !format.is_linear() => self.tone(),
            _ => Ok(ToneMapper::new(1.0, ToneCurve::Clip)?),
        }
    }

    /// The exposure of a tone mapper for the files; `None` for linear formats.
    fn file_exposure(&self, tone: &ToneMapper) -> Option<Exposure> {
        let format = self.renderer.layout().format();
        format
            .filter(|format| !format.is_linear())
            .and_then(|_| Exposure::from_factor(tone.exposure().into()).ok())
    }

    fn options(&self, file: &PictureFile, tone: &ToneMapper) -> PictureOptions {
        let metadata = FrameMetadata {
            renderer: self.renderer,
            time: self.time,
            sun: &self.sun,
            light: &self.light,
            night: self.night.as_ref(),
            channels: &self.channels,
            exposure: self.file_exposure(tone),
        };
        PictureOptions {
            metadata: Metadata {
                band: file.band(),
                ..metadata.of_layer(file.layer).with_frame(&file.frame)
            },
            ..self.renderer.picture_options()
        }
    }

    /// Objects whose depth is written beside a file; `None` for the second file of a separate sun's disc.
    fn depth_of(&self, file: &PictureFile) -> Option<&LitObjects> {
        let wanted = self.renderer.scene().output.depth_map == Some(true);
        self.objects
            .as_ref()
            .filter(|_| wanted && file.layer != Layer::Disc)
    }
}

/// Values of [`POLARISATION_CHANNELS`] at the centre of each pixel of a file.
fn polarisation_rows(
    file: &PictureFile,
    table: &PolarisationTable,
) -> Result<StoredRows, ImageError> {
    let (frame, width) = (&file.frame, file.size().width());
    let pixels = file.rows().flat_map(|y| (0..width).map(move |x| (x, y)));
    let values =
        pixels.flat_map(
            |(x, y)| match frame.direction(f64::from(x) + 0.5, f64::from(y) + 0.5) {
                Some(direction) => {
                    let [q, u] = table.sample(direction);
                    polarisation(&[1.0, q.into(), u.into()])
                }
                None => [0.0; 4],
            },
        );
    StoredRows::new(width, POLARISATION_CHANNELS.len(), values.collect())
}

/// Writes a map of polarisation beside a picture.
fn write_polarisation(
    file: &PictureFile,
    rows: &StoredRows,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let options = ExrOptions {
        precision: SamplePrecision::Float,
        ..ExrOptions::default()
    };
    let metadata = Metadata {
        band: file.band(),
        ..Metadata::default()
    };
    exr::write(
        &file.map_path("polarisation"),
        file.size(),
        &POLARISATION_CHANNELS,
        rows,
        &options,
        &metadata,
        control,
    )
}

/// Progress of one file among several.
struct Part<'a> {
    control: Control<'a>,
    /// Rows of earlier files.
    done: u64,
    /// Rows of all files.
    total: u64,
}

impl Progress for Part<'_> {
    fn advanced(&self, done: u64, _total: u64) {
        self.control.report(self.done + done, self.total);
    }
}

/// Progress callback that does nothing.
static SILENT: fn(u64, u64) = |_, _| {};

fn rows_of<'f>(files: impl IntoIterator<Item = &'f PictureFile>) -> u64 {
    files
        .into_iter()
        .map(|file| u64::from(file.size().height()))
        .sum()
}

/// Red, green and blue of the pixels of rows.
fn stored(
    rows: &dyn RowSource,
    frame: &Frame,
    control: Control<'_>,
) -> Result<Vec<[f32; 3]>, Cancelled> {
    let samples = draw_rows(rows, frame.size(), control)?;
    let pixels = samples.par_chunks_exact(rows.channels());
    Ok(pixels
        .map(|values| [values[0], values[1], values[2]])
        .collect())
}
