//! Pictures by random paths: in passes, each of as many paths as all before it, so that there is a whole picture soon
//! and a better one later. Ctrl-C leaves that of the last pass.

use super::fog;
use super::layout::PictureFile;
use super::polarisation;
use super::prepared_frame::PreparedFrame;
use super::renderer::Renderer;
use super::rows::Layer;
use crate::args::{FogScatteringArg, ScatteringArg, SkyArgs, SolverArg};
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use crate::report;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings, ORDERS};
use airlight_image::output::Written;
use airlight_image::rows::StoredRows;
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, Frame, write_picture};
use airlight_render::canvas::{ColorMoments, Passes, PixelStokes, pixel_offset};
use airlight_render::pixels::tagged_path;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::Ordering;

/// Paths for each pixel where nothing is said.
pub const PATHS: u64 = 256;

/// Refuses options that do not go together.
///
/// # Errors
/// [`CliError::Usage`]: which.
pub fn check(args: &SkyArgs) -> Result<(), CliError> {
    args.air.monte_carlo(PATHS)?;
    let random = args.air.solver == SolverArg::MonteCarlo;
    if args.polarisation && !random {
        return Err(CliError::usage(
            "--polarisation is for random paths, the other solver's light is scalar: give --solver monte-carlo as well",
        ));
    }
    if args.polarisation && args.air.scattering == ScatteringArg::Single {
        return Err(CliError::usage(
            "--polarisation is that of all light: leave out --scattering single",
        ));
    }
    if random && args.fog.fog_scattering != FogScatteringArg::All {
        return Err(CliError::usage(
            "random paths scatter in fog as often as it happens: leave out --fog-scattering, or give --solver orders",
        ));
    }
    match (random, args.noise_map, &args.output) {
        (false, true, _) => Err(CliError::usage(
            "--noise-map is for random paths: give --solver monte-carlo as well",
        )),
        (true, _, None) => Err(CliError::usage(
            "--solver monte-carlo draws into a file: give --output (the preview in the terminal is by the fast solver)",
        )),
        _ => Ok(()),
    }
}

/// Sums over the bundles of paths of each pixel.
struct Canvas {
    frame: Frame,
    channels: usize,
    /// In the channels of a table.
    sums: Vec<f64>,
    colours: Vec<ColorMoments>,
    /// Where asked for; else empty.
    stokes: Vec<PixelStokes>,
    bundles: u64,
}

/// What follows the paths of a picture.
struct Painter<'a> {
    solver: MonteCarlo,
    weights: &'a [[f32; 3]],
    /// Whether the channels are wavelengths.
    spectral: bool,
    eye_altitude_m: f64,
    sun: DVec3,
    /// The square of the planet's mean distance from the sun over the present one.
    nearness: f64,
    orders: usize,
    polarised: bool,
}

/// Draws the files pass by pass; each pass writes them anew.
///
/// # Errors
/// [`CliError`]: what failed; files written before stay.
pub fn write(
    renderer: &Renderer<'_>,
    prepared: &PreparedFrame,
    files: &[PictureFile],
    settings: MonteCarloSettings,
    bar: &RowsBar,
) -> Result<Vec<Written>, CliError> {
    let painter = Painter::new(renderer, prepared, settings)?;
    let tone = renderer.tone(prepared)?;
    // Writing is short beside the paths: its progress is not told.
    let control = Control::cancelled_by(&STOP);
    let channels = match painter.spectral {
        true => painter.weights.len(),
        false => 3,
    };
    check_memory(files, channels)?;
    let mut canvases: Vec<Option<Canvas>> = files
        .iter()
        .map(|file| {
            (file.layer != Layer::Disc)
                .then(|| Canvas::new(file.frame, channels, painter.polarised))
        })
        .collect();
    let passes = Passes::new(settings.paths);
    let goal = passes.goal();
    let mut written = Vec::new();
    for bundles in passes {
        let until = bundles.end;
        let rows: u64 = files
            .iter()
            .map(|file| u64::from(file.frame.size().height()))
            .sum();
        let pass = RowsBar::for_pass(rows, until, goal);
        written.clear();
        for (file, canvas) in files.iter().zip(&mut canvases) {
            if let Some(canvas) = canvas {
                painter.paint(canvas, until, &pass)?;
            }
            let solved = canvas.as_ref().map(Canvas::means);
            written.push(renderer.write_file(
                prepared,
                file,
                (solved.as_deref(), &tone),
                control,
            )?);
            if let Some(canvas) = canvas.as_ref().filter(|_| renderer.args.noise_map) {
                canvas.write_noise(renderer, prepared, file, &tone)?;
            }
            if let Some(canvas) = canvas.as_ref().filter(|_| painter.polarised) {
                polarisation::write(&file.path, canvas.frame.size(), &canvas.stokes)?;
            }
        }
        if until == goal {
            bar.file_done(rows);
        }
    }
    say_noise(renderer, canvases.iter().flatten());
    Ok(written)
}

/// One frame in memory, in the channels of a table.
///
/// # Errors
/// [`CliError`]: what failed.
pub fn means(
    renderer: &Renderer<'_>,
    prepared: &PreparedFrame,
    frame: Frame,
    settings: MonteCarloSettings,
) -> Result<Vec<f32>, CliError> {
    let painter = Painter::new(renderer, prepared, settings)?;
    let mut canvas = Canvas::new(frame, 3, false);
    let bar = RowsBar::new(u64::from(frame.size().height()));
    bar.say("following random paths".to_owned());
    painter.paint(&mut canvas, Passes::new(settings.paths).goal(), &bar)?;
    Ok(canvas.means())
}

/// Refuses pictures too large to be kept while they are drawn.
fn check_memory(files: &[PictureFile], channels: usize) -> Result<(), CliError> {
    const MOST_GB: f64 = 8.0;
    let drawn = files.iter().filter(|file| file.layer != Layer::Disc);
    let pixels: f64 = drawn
        .map(|file| f64::from(file.frame.size().width()) * f64::from(file.frame.size().height()))
        .sum();
    let bytes = size_of::<ColorMoments>() + channels * size_of::<f64>();
    let need_gb = 1e-9 * pixels * bytes as f64;
    match need_gb <= MOST_GB {
        true => Ok(()),
        false => Err(CliError::usage(format!(
            "pictures by random paths are kept in memory while they are drawn: this one takes {need_gb:.0} GB, and at most \
             {MOST_GB} are taken; give a smaller --size"
        ))),
    }
}

fn say_noise<'a>(renderer: &Renderer<'_>, canvases: impl Iterator<Item = &'a Canvas>) {
    let (mut sum, mut count) = (0.0, 0.0);
    for canvas in canvases {
        for colour in &canvas.colours {
            let (mean, error) = colour.moments(1, canvas.bundles);
            if mean > 0.0 {
                sum += (error / mean).powi(2);
                count += 1.0;
            }
        }
    }
    if !renderer.args.quiet && count > 0.0 {
        report::note(&format!(
            "standard error of a pixel's green: {:.2} % (root mean square over the picture)",
            100.0 * f64::sqrt(sum / count)
        ));
    }
}

impl Canvas {
    fn new(frame: Frame, channels: usize, polarised: bool) -> Self {
        let pixels = frame.size().width() as usize * frame.size().height() as usize;
        Self {
            frame,
            channels,
            sums: vec![0.0; pixels * channels],
            colours: vec![ColorMoments::default(); pixels],
            stokes: vec![PixelStokes::default(); if polarised { pixels } else { 0 }],
            bundles: 0,
        }
    }

    /// The picture as far as it is known.
    fn means(&self) -> Vec<f32> {
        let count = self.bundles.max(1) as f64;
        self.sums.iter().map(|sum| (sum / count) as f32).collect()
    }

    fn write_noise(
        &self,
        renderer: &Renderer<'_>,
        prepared: &PreparedFrame,
        file: &PictureFile,
        tone: &ToneMapper,
    ) -> Result<(), CliError> {
        let size = self.frame.size();
        let scale = renderer.args.picture.scale as f32;
        let error = |colour: &ColorMoments, component| {
            scale * colour.moments(component, self.bundles).1 as f32
        };
        let samples = self
            .colours
            .iter()
            .flat_map(|colour| [0, 1, 2].map(|component| error(colour, component)))
            .collect();
        let rows = StoredRows::new(size.width(), 3, samples)?;
        let path = tagged_path(&file.path, "noise").with_extension("exr");
        let options = renderer.options(prepared, file);
        let control = Control::cancelled_by(&STOP);
        write_picture(&path, size, &rows, tone, &options, control)?;
        Ok(())
    }
}

impl<'a> Painter<'a> {
    fn new(
        renderer: &Renderer<'_>,
        prepared: &'a PreparedFrame,
        settings: MonteCarloSettings,
    ) -> Result<Self, CliError> {
        let scene = renderer.scene;
        let mut air = scene.atmosphere.clone();
        let wavelengths = scene.grid.wavelengths_nm();
        let ground_m = air.planet.ground_altitude_m;
        let fog = fog::constituent(&renderer.args.fog, ground_m, wavelengths)?;
        air.constituents.extend(fog);
        Ok(Self {
            solver: MonteCarlo::new(&air, &scene.grid, settings)?,
            weights: prepared.weights(),
            spectral: renderer.channels.spectral.is_some(),
            eye_altitude_m: scene.eye_altitude_m,
            sun: prepared.sun.direction(),
            nearness: prepared.sun.distance_ratio.powi(-2),
            orders: match renderer.args.air.scattering {
                ScatteringArg::All => ORDERS,
                ScatteringArg::Single => 1,
            },
            polarised: renderer.args.polarisation,
        })
    }

    /// Follows the paths of the bundles up to `until`.
    fn paint(&self, canvas: &mut Canvas, until: u64, bar: &RowsBar) -> Result<(), CliError> {
        let (from, channels) = (canvas.bundles, canvas.channels);
        let width = canvas.frame.size().width() as usize;
        let frame = canvas.frame;
        // One row each, none where there is none.
        let mut stokes: Vec<&mut [PixelStokes]> = canvas.stokes.chunks_mut(width).collect();
        stokes.resize_with(frame.size().height() as usize, Default::default);
        canvas
            .sums
            .par_chunks_mut(width * channels)
            .zip(canvas.colours.par_chunks_mut(width))
            .zip(stokes)
            .enumerate()
            .try_for_each(|(y, ((sums, colours), stokes))| {
                for (x, (sums, colour)) in sums.chunks_mut(channels).zip(colours).enumerate() {
                    if STOP.load(Ordering::Relaxed) {
                        return Err(CliError::Interrupted);
                    }
                    for bundle in from..until {
                        let [u, v] = pixel_offset(bundle);
                        if let Some(view) = frame.direction(x as f64 + u, y as f64 + v) {
                            self.add(view, bundle, sums, colour, stokes.get_mut(x));
                        }
                    }
                }
                bar.advance(1);
                Ok(())
            })?;
        canvas.bundles = until;
        Ok(())
    }

    /// Adds a bundle of paths along a direction to a pixel.
    fn add(
        &self,
        view: DVec3,
        bundle: u64,
        sums: &mut [f64],
        colour: &mut ColorMoments,
        stokes: Option<&mut PixelStokes>,
    ) {
        let found = self.sample(view, bundle, stokes);
        let mut rgb = [0.0; 3];
        for (lane, weight) in self.weights.iter().enumerate() {
            let radiance = self.nearness * found[lane];
            if self.spectral {
                sums[lane] += radiance;
            }
            for (c, w) in rgb.iter_mut().zip(weight) {
                *c += f64::from(*w) * radiance;
            }
        }
        if !self.spectral {
            sums.iter_mut().zip(rgb).for_each(|(sum, c)| *sum += c);
        }
        colour.add(rgb);
    }
}

impl Painter<'_> {
    /// Radiance at each wavelength by a bundle of paths; with its polarisation, where that is asked for.
    fn sample(&self, view: DVec3, bundle: u64, stokes: Option<&mut PixelStokes>) -> Vec<f64> {
        let (eye_m, sun) = (self.eye_altitude_m, self.sun);
        match stokes {
            Some(stokes) => {
                let sample = self.solver.sample_polarised(eye_m, sun, view, None, bundle);
                let weights = self.solver.grid().xyz_weights().iter().map(|w| w[1]);
                stokes.add(&sample, weights);
                let [intensity, _, _] = sample.stokes;
                intensity
            }
            None => {
                let sample = self.solver.sample(eye_m, sun, view, bundle);
                let of = |lane: usize| sample[..self.orders].iter().map(|order| order[lane]).sum();
                (0..self.weights.len()).map(of).collect()
            }
        }
    }
}
