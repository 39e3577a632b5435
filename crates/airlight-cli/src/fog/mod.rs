//! `airlight fog`: fog over existing pictures.

mod batch;

use crate::args::OverlayArgs;
use crate::error::CliError;
use crate::interrupt::{self, STOP};
use crate::progress::{Busy, RowsBar};
use crate::report::{self, bytes};
use airlight::Named;
use airlight_image::Control;
use airlight_image::output::{AtomicFile, Written};
use airlight_image::tone::Exposure;
use airlight_render::batch::is_batch;
use airlight_render::overlay::{MonteCarloFog, OverlayImage, OverlayScene, PreparedOverlay};
use airlight_render::scene_file;
use std::path::Path;

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options and files.
pub fn run(args: &OverlayArgs) -> Result<(), CliError> {
    let mut scene = match &args.scene {
        None => OverlayScene::default(),
        Some(path) => read(path)?,
    };
    args.fill(&mut scene);
    let monte_carlo = scene.monte_carlo().is_some();
    if let Some(seed) = args.batch.seed {
        if monte_carlo {
            scene.scene.solver.seed = Some(seed);
        } else if args.batch.vary.is_empty() {
            return Err(CliError::usage(
                "--seed: expected a random input, got none; try --vary or --solver monte-carlo",
            ));
        }
    }
    let many = is_batch(&scene.overlay.colour, scene.output()?)? || args.batch.is_given();
    if many && monte_carlo {
        return Err(CliError::usage(
            "--solver monte-carlo: expected one picture, got several or options of --vary and batches; try leaving out \
             --solver, or one file each for COLOUR, --depth and --output",
        ));
    }
    if !many {
        file_in_folder(&mut scene);
        scene.check()?;
    }
    if let Some(path) = &args.save_scene {
        report::write(path, scene.to_toml()?)?;
    }
    scene_file::inline_files(&mut scene.scene, Path::new(""))?;
    match many {
        true => batch::run(args, scene),
        false => one(args, &scene),
    }
}

/// An output that is a folder means the name of the picture in it.
fn file_in_folder(scene: &mut OverlayScene) {
    let ending = scene.overlay.ending_in_folder(&scene.overlay.colour);
    let colour = scene.overlay.colour.with_extension(ending);
    if let (Some(output), Some(name)) = (&mut scene.scene.output.file, colour.file_name())
        && (output.ends_with(std::path::is_separator) || Path::new(output).is_dir())
    {
        *output = Path::new(output).join(name).to_string_lossy().into_owned();
    }
}

/// Reads a description from a scene file.
fn read(path: &Path) -> Result<OverlayScene, CliError> {
    let text = scene_file::read_text(path, "TOML")?;
    OverlayScene::from_toml(&text)
        .map_err(|error| CliError::usage(format!("`{}`, {error}", path.display())))
}

fn one(args: &OverlayArgs, scene: &OverlayScene) -> Result<(), CliError> {
    let output = scene.output()?;
    let format = scene.output_format(output)?;
    let depth = scene.overlay.depth.as_ref();
    for input in depth.into_iter().chain([&scene.overlay.colour]) {
        if same_file(input, output) {
            return Err(CliError::usage(format!(
                "expected an output that is not an input, got `{}`; try another --output",
                output.display()
            )));
        }
    }
    AtomicFile::remove_leftovers([output]);
    let image = OverlayImage::read(scene, format)?;
    let mut notes = image.notes();
    let sky = match scene.overlay.sky_light {
        true => {
            let _busy = Busy::with("solving for the light in the air");
            scene.solve_sky()?
        }
        false => None,
    };
    let busy = Busy::with("solving for the light in the fog");
    let prepared = PreparedOverlay::new(scene, &image, sky.as_ref())?;
    drop(busy);
    let monte_carlo = prepared.monte_carlo(scene, sky.as_ref())?;
    let writing = interrupt::start_writing()?;
    let control = Control::cancelled_by(&STOP);
    let ((written, exposure), noise) = match monte_carlo {
        None => {
            let rows = prepared.output(scene, &image, format)?;
            let bar = RowsBar::by_stages();
            let written = rows.write(output, control.reporting_to(&bar))?;
            drop(bar);
            notes.merge(&rows.overlay().notes());
            ((written, rows.exposure()), String::new())
        }
        Some(fog) => passes(scene, &image, &prepared, &fog, control)?,
    };
    drop(writing);
    let clamped = format!("samples {}", format.clamping());
    notes.count(written.clamped_samples, clamped);
    report::remarks(&scene.overlay.colour, &notes);
    if args.quiet {
        return Ok(());
    }
    let size = image.picture.size;
    let [red, green, blue] = prepared.level.colour;
    let range = image.depth.range_m().map_or(String::new(), |(near, far)| {
        let [near, far] = [near, far].map(|m| report::short(f64::from(m)));
        format!("{near} to {far} m, ")
    });
    let exposure = exposure.map_or(String::new(), |exposure| {
        format!(
            "  exposure      EV {} at ISO 100\n",
            report::short(exposure.ev100())
        )
    });
    let contrast = 100.0 * scene.contrast().value();
    report::print(&format!(
        "{}: {} x {}, {}\n  visibility    {} m (contrast {contrast} %)\n  light         {red:.4} {green:.4} {blue:.4} ({})\n  \
         depth         {range}{} pixels unknown, {} infinitely far\n{exposure}{noise}",
        output.display(),
        size.width(),
        size.height(),
        bytes(written.bytes),
        report::short(scene.visibility_m()?),
        prepared.level.source.summary(),
        image.depth.holes,
        image.depth.infinite,
    ))
}

/// Writes a Monte Carlo picture in passes; returns a line of the report with the noise of the last one.
fn passes(
    scene: &OverlayScene,
    image: &OverlayImage,
    prepared: &PreparedOverlay,
    fog: &MonteCarloFog,
    control: Control<'_>,
) -> Result<((Written, Option<Exposure>), String), CliError> {
    let (mut written, mut noise) = ((Written::default(), None), String::new());
    let overlay = prepared.overlay(image)?;
    let bar = RowsBar::by_stages();
    fog.run(&overlay, control.reporting_to(&bar), |pass| {
        written = prepared.write_pass(scene, image, pass, control)?;
        if pass.is_last {
            noise = format!(
                "  noise         {:.2} % of the fog's green (root mean square over the picture), {} paths per pixel\n",
                100.0 * pass.relative_noise(),
                pass.paths
            );
        }
        Ok(())
    })?;
    Ok((written, noise))
}

/// Whether two paths are of the same existing file.
fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}
