//! `airlight sky`: pictures of the sky. [`preview`] shows them on the terminal.

mod preview;

use crate::args::SkyArgs;
use crate::error::CliError;
use crate::interrupt::{self, STOP};
use crate::progress::RowsBar;
use crate::report::{self, bytes, seconds};
use crate::scene;
use airlight::scene::Scene;
use airlight_image::Control;
use airlight_image::output::{AtomicFile, Written};
use airlight_image::tone::Exposure;
use airlight_render::exposure::DARKEST_EV100;
use airlight_render::openjd::JobTemplate;
use airlight_render::sequence::{PreparedSequence, Sequence, SequenceSettings};
use airlight_render::summary::{self, short};
use airlight_render::{PreparedFrame, Renderer, WrittenFile};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options and failures.
pub fn run(args: &SkyArgs) -> Result<(), CliError> {
    let scene = args.read()?;
    if let Some(path) = &args.save_scene {
        scene::save(&scene, path)?;
        if scene.output.file.is_none() && !args.preview {
            return Ok(());
        }
    }
    if let Some(path) = &args.machines.openjd {
        return write_job(args, &scene, path);
    }
    let preview = preview::wanted(args.preview, scene.output.file.is_some())?;
    let renderer = match preview {
        Some(_) => Renderer::previewed(&scene)?,
        None => Renderer::new(&scene)?,
    }
    .with_text("command", scene::command_line());
    match renderer.sequence()? {
        Some(sequence) => many(args, &renderer, &sequence, preview),
        None => match args.sequence.of_sequences() {
            Some(option) => Err(CliError::usage(format!(
                "{option}: expected a sequence of pictures, got one picture; try --until with --every"
            ))),
            None => one(args, &renderer, preview),
        },
    }
}

/// Writes a job for a render farm.
fn write_job(args: &SkyArgs, scene: &Scene, path: &Path) -> Result<(), CliError> {
    let job = JobTemplate::of_scene(&Renderer::new(scene)?, args.machines.tasks)?;
    report::write_job(path, &job, args.quiet)
}

fn one(
    args: &SkyArgs,
    renderer: &Renderer,
    preview: Option<preview::Terminal>,
) -> Result<(), CliError> {
    let output = renderer.output_path().ok();
    let shard = args.machines.shard;
    let files = match (output, shard) {
        (Some(path), Some(shard)) => renderer.layout().files_of(path, shard)?,
        (Some(path), None) => renderer.layout().files(path),
        (None, Some(_)) => {
            return Err(CliError::usage(
                "--shard: expected a file to write, got none; try --output sky.exr",
            ));
        }
        (None, None) => Vec::new(),
    };
    AtomicFile::remove_leftovers(files.iter().map(|file| file.path.as_path()));
    for file in &files {
        report::check_writable(&file.path)?;
    }
    let sun = renderer.sun(None)?;
    let bar = RowsBar::by_stages();
    let control = Control::cancelled_by(&STOP).reporting_to(&bar);
    let begun = Instant::now();
    let prepared = renderer.prepare(renderer.suns_near(&sun), control)?;
    let solving = begun.elapsed();
    let start = Instant::now();
    let frame = renderer.frame(prepared.as_ref(), None)?;
    drop(bar);
    if let Some(terminal) = preview {
        report::print(&preview::text(renderer, &frame, terminal)?)?;
    }
    let mut text = String::new();
    let mut exposure = None;
    if let Some(path) = output {
        let bar = RowsBar::by_stages();
        let writing = interrupt::start_writing()?;
        let control = Control::cancelled_by(&STOP).reporting_to(&bar);
        let written = match shard {
            Some(shard) => frame.write_shard(path, shard, control)?,
            None => frame.write(path, control)?,
        };
        drop(writing);
        drop(bar);
        for file in &written.files {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{}: {} x {} {}, {}",
                file.path.display(),
                file.size.width(),
                file.size.height(),
                renderer.kind(),
                bytes(file.written.bytes)
            );
        }
        exposure = written.exposure;
        note_of_night(renderer, exposure);
        warn_of_clipping(renderer, written.files.iter().map(|file| &file.written));
        if let Some(noise) = written.noise.filter(|_| !args.quiet) {
            report::note(&format!(
                "standard error of a pixel's green: {:.2} % (root mean square over the picture)",
                100.0 * noise
            ));
        }
    }
    if args.quiet {
        return Ok(());
    }
    text.push_str(&facts(renderer, &frame));
    if let Some(exposure) = exposure {
        let _ = writeln!(
            text,
            "  exposure      EV {} at ISO 100",
            short(exposure.ev100())
        );
    }
    let _ = writeln!(
        text,
        "  time          {} to solve, {} to draw",
        seconds(solving),
        seconds(start.elapsed())
    );
    report::print(&text)
}

fn many(
    args: &SkyArgs,
    renderer: &Renderer,
    sequence: &Sequence,
    preview: Option<preview::Terminal>,
) -> Result<(), CliError> {
    let settings = SequenceSettings {
        shard: args.machines.shard,
        overwrite: args.sequence.overwrite,
        manifest: args.sequence.manifest.clone(),
    };
    let begun = Instant::now();
    for file in sequence.steps().iter().take(1).flat_map(|step| &step.files) {
        report::check_writable(&file.path)?;
    }
    // To the end, so that no empty manifest remains.
    let writing = interrupt::start_writing()?;
    let run = renderer.start_sequence(sequence, &settings)?;
    if run.removed() > 0 {
        let removed = run.removed();
        report::note(&format!(
            "{removed} unfinished files of an earlier run removed"
        ));
    }
    let (missing, total) = (run.missing(), run.total());
    let mut exposure = None;
    let solving = RowsBar::by_stages();
    let control = Control::cancelled_by(&STOP).reporting_to(&solving);
    let solved = renderer.prepare_sequence(sequence, missing, control)?;
    drop(solving);
    if let Some(PreparedSequence { solution, renderer }) = solved {
        exposure = renderer.common_exposure();
        note_of_night(&renderer, exposure);
        let bar = RowsBar::new(missing.iter().map(|step| step.rows()).sum());
        let mut written: Vec<WrittenFile> = Vec::new();
        for (index, step) in missing.iter().enumerate() {
            bar.say(format!(
                "picture {} of {}",
                step.number,
                sequence.steps().len()
            ));
            let frame = renderer.frame(solution.as_ref(), Some(step.time))?;
            if let Some(terminal) = preview {
                report::print(&preview::text(&renderer, &frame, terminal)?)?;
            }
            let control = Control::cancelled_by(&STOP).reporting_to(&bar);
            written.extend(run.write(index, &frame, control)?.files);
            bar.files_done(step.rows());
        }
        drop(bar);
        warn_of_clipping(&renderer, written.iter().map(|file| &file.written));
    }
    let made = missing.len();
    let manifest = run.manifest().display().to_string();
    run.finish()?;
    drop(writing);
    if args.quiet {
        return Ok(());
    }
    let shard = settings
        .shard
        .map_or(String::new(), |part| format!(" in shard {part}"));
    let skipped = match total - made {
        0 => String::new(),
        n => format!(", {n} existed already (--overwrite replaces them)"),
    };
    let exposure = exposure.map_or(String::new(), |exposure| {
        let ev100 = short(exposure.ev100());
        format!("  exposure      EV {ev100} at ISO 100 in all pictures\n")
    });
    report::print(&format!(
        "{}: {made} of {total} {}{shard} written{skipped}, {}\n{exposure}  manifest      {manifest}\n  time          {}\n",
        renderer.output_path()?.display(),
        report::pictures(total),
        renderer.kind(),
        seconds(begun.elapsed())
    ))
}

/// Describes sun, light and air.
fn facts(renderer: &Renderer, frame: &PreparedFrame) -> String {
    let scene = renderer.resolved();
    let (sun, light) = (frame.sun(), frame.light());
    let mut text = String::new();
    if let (Some(place), Some(time)) = (scene.sun.place(), frame.time()) {
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
        "  illuminance   sun {} lx facing it, {} lx horizontal; sky {} lx horizontal",
        short(light.sun_normal_lx),
        short(light.sun_horizontal_lx),
        short(light.sky_horizontal_lx)
    );
    if let Some(moon) = frame.night().and_then(|night| night.moon) {
        let lux = |lux: Option<f64>| short(lux.unwrap_or(0.0));
        let _ = writeln!(
            text,
            "  moon          {}; {} lx facing it, {} lx horizontal",
            summary::moon(&moon),
            lux(light.moon_normal_lx),
            lux(light.moon_horizontal_lx)
        );
    }
    let _ = writeln!(
        text,
        "  air           {}; eye at {} m",
        scene.atmosphere.name,
        short(scene.observer_altitude_m)
    );
    if let Some(fog) = &scene.fog {
        let _ = writeln!(text, "  fog           {}", summary::fog(fog));
    }
    text
}

/// Says why a picture is dark if its exposure is the longest that is metered.
fn note_of_night(renderer: &Renderer, exposure: Option<Exposure>) {
    let settings = renderer.exposure();
    let is_longest = |exposure: Exposure| {
        exposure.ev100() + settings.brighten_stops < DARKEST_EV100 + 1e-3
            && settings.ev100.is_none()
    };
    if exposure.is_some_and(is_longest) {
        report::note(
            "the sky is so dark that a photograph of 20 s at f/1.4 and ISO 2500 leaves it dark, and so does this picture; --brighten \
             adds stops",
        );
    }
}

/// Warns of samples out of the format's range.
fn warn_of_clipping<'w>(renderer: &Renderer, written: impl Iterator<Item = &'w Written>) {
    let (clamped, nans) = written.fold((0, 0), |sum, written| {
        (sum.0 + written.clamped_samples, sum.1 + written.nan_samples)
    });
    if let Some(format) = renderer.layout().format().filter(|_| clamped > 0) {
        let tip = match format.holds_channels() {
            true => "; try --precision float, --scale 1e-5, or --sun-disc separate or out",
            false => "",
        };
        report::note(&format!("{clamped} samples {}{tip}", format.clamping()));
    }
    if nans > 0 {
        report::note(&format!(
            "{nans} samples were NaN and are 0; please report this"
        ));
    }
}
