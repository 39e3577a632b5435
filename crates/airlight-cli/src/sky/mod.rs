//! `airlight sky`: pictures of the sky.
//!
//! - [`channels`]: what the values of a pixel are, and how spectra become them.
//! - [`disc`]: the sun's disc in a picture, exact in irradiance at every size; [`rows`]: sky and disc, row by row.
//! - [`fog`]: fog before the sky.
//! - [`layout`]: which files a picture consists of and where each looks.
//! - [`metadata`]: what the files say about themselves; [`exposure`]: how bright PNG, JPEG and preview are.
//! - [`objects`]: things before the sky.
//! - [`monte_carlo`]: pictures by random paths; [`polarisation`]: what is told of it beside them; [`classic`]: pictures by
//!   published models.
//! - [`prepared`]: one moment, made ready; [`image`]: a picture in memory; [`draw`]: one moment into files; [`preview`]: onto the terminal; [`sequence`]: many
//!   moments.

mod channels;
mod disc;
mod exposure;
mod fog;
mod layout;
mod metadata;
mod models;
mod monte_carlo;
mod objects;
mod polarisation;
mod prepared_frame;
mod preview;
mod rendered_image;
mod renderer;
mod rows;
mod sequence;

use crate::args::SkyArgs;
use crate::error::CliError;
use crate::illuminance::Illuminances;
use crate::interrupt;
use crate::progress::RowsBar;
use crate::report::{self, bytes, seconds, short};
use crate::scene::Sun;
pub use channels::{space_name, space_of};
pub use exposure::curve as tone_curve;
pub use metadata::SOFTWARE;
use prepared_frame::{Prepared, PreparedFrame};
pub use rendered_image::RenderedImage;
use renderer::{Renderer, Setup};
use std::fmt::Write;
use std::time::Instant;

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the options, or what failed.
pub fn run(args: &SkyArgs) -> Result<(), CliError> {
    crate::scene::use_threads(args.air.threads)?;
    let preview = preview::wanted(args)?;
    let setup = Setup::new(args)?;
    monte_carlo::check(args)?;
    let renderer = setup.renderer(args);
    match &args.sequence.until {
        Some(until) => sequence::run(&renderer, until, preview),
        None => single(&renderer, &setup.first, preview),
    }
}

fn single(
    renderer: &Renderer<'_>,
    sun: &Sun,
    preview: Option<preview::Terminal>,
) -> Result<(), CliError> {
    let scene = renderer.scene;
    renderer.check(renderer.layout.output.as_deref())?;
    let (prepared, solving) = Prepared::new(renderer, scene.near(sun))?;
    let start = Instant::now();
    let prepared = PreparedFrame::new(renderer, &prepared, sun, scene.sun.start())?;
    if let Some(terminal) = preview {
        report::print(&preview::text(renderer, &prepared, terminal)?)?;
    }
    let mut text = String::new();
    if let Some(path) = &renderer.layout.output {
        let files = renderer.layout.files(path);
        let rows = files
            .iter()
            .map(|file| u64::from(file.frame.size().height()))
            .sum();
        let bar = RowsBar::new(rows);
        bar.say("drawing".to_owned());
        let writing = interrupt::start_writing()?;
        let written = renderer.write(&prepared, &files, &bar)?;
        drop(writing);
        drop(bar);
        for (file, written) in files.iter().zip(&written) {
            let size = file.frame.size();
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{}: {} x {} {}, {}",
                file.path.display(),
                size.width(),
                size.height(),
                renderer.kind(),
                bytes(written.bytes)
            );
        }
        renderer.warn_of_clipping(&written);
    }
    if renderer.args.quiet {
        return Ok(());
    }
    text.push_str(&said(renderer, sun, &prepared.light));
    let _ = writeln!(
        text,
        "  time          {} to solve, {} to draw",
        seconds(solving),
        seconds(start.elapsed())
    );
    report::print(&text)
}

/// Sun and light in words.
fn said(renderer: &Renderer<'_>, sun: &Sun, light: &Illuminances) -> String {
    let scene = renderer.scene;
    let mut text = String::new();
    if let (Some(place), Some(time)) = (scene.sun.place(), scene.sun.start()) {
        let _ = writeln!(
            text,
            "  place, time   latitude {}, longitude {}, {time}",
            place.latitude_deg, place.longitude_deg
        );
    }
    let geometric = match sun.geometric_elevation_deg {
        Some(deg) if deg != sun.elevation_deg => format!(" ({deg:.3} without refraction)"),
        _ => String::new(),
    };
    let _ = writeln!(
        text,
        "  sun           elevation {:.3} deg{geometric}, azimuth {:.3} deg",
        sun.elevation_deg, sun.azimuth_deg
    );
    let _ = writeln!(
        text,
        "  illuminance   sun {} lx facing it, {} lx on the horizontal; sky {} lx on the horizontal",
        short(light.sun_normal_lx),
        short(light.sun_horizontal_lx),
        short(light.sky_horizontal_lx)
    );
    let _ = writeln!(
        text,
        "  air           {}; eye at {} m",
        scene.atmosphere.name,
        short(scene.eye_altitude_m)
    );
    if let Some(fog) = fog::in_words(&renderer.args.fog) {
        let _ = writeln!(text, "  fog           {fog}");
    }
    text
}
