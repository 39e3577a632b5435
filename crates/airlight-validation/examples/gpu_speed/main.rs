//! Times of `airlight-gpu` and of Hillaire 2020 on one graphics device, pass by pass:
//! `cargo run --release -p airlight-validation --features gpu --example gpu_speed -- [--sizes 1280x720,1920x1080] [--frames 20] [--json]
//! [--pictures FOLDER]`.
//!
//! The scene: mountains below an evening sky in the air of the paper, with fog in the valleys and lights in it as passes of their own. Both
//! draw over the same frame, in turns. Passes are timed by time stamps of the device where these can be trusted.

mod options;
mod report;
mod scene;
mod stopwatch;

use airlight_gpu::SkyPasses;
use airlight_validation::frames::hillaire2020::HillairePasses;
use options::Options;
use report::{Event, Pass, Report, SizeReport};
use scene::{Frame, Scene};
use std::error::Error;
use std::process::ExitCode;
use stopwatch::{Stopwatch, median};

fn main() -> ExitCode {
    match Options::parse(std::env::args().skip(1)).map(|options| options.map(|o| run(&o))) {
        Ok(None) => {
            println!("{}", options::USAGE);
            ExitCode::SUCCESS
        }
        Ok(Some(Ok(()))) => ExitCode::SUCCESS,
        Ok(Some(Err(error))) => failed(&error.to_string()),
        Err(error) => failed(&error),
    }
}

fn failed(error: &str) -> ExitCode {
    eprintln!("gpu_speed: {error}");
    ExitCode::FAILURE
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let watch = Stopwatch::new()?;
    let scene = Scene::new(&watch.device, &watch.queue)?;
    let mut sizes = Vec::new();
    for (index, &size) in options.sizes.iter().enumerate() {
        let frame = scene.frame(size)?;
        if let Some(folder) = options.pictures.as_ref().filter(|_| index == 0) {
            scene.write_pictures(&frame, folder)?;
        }
        sizes.push(measure(&watch, &scene, &frame, options.frames)?);
    }
    let report = Report {
        adapter: watch.adapter.clone(),
        driver: watch.driver.clone(),
        clock: watch.clock().to_owned(),
        frames: options.frames,
        evaluations: scene.medium_evaluations()?,
        sizes,
    };
    match options.json {
        true => println!("{}", serde_json::to_string_pretty(&report)?),
        false => print!("{report}"),
    }
    Ok(())
}

/// The time of a pass in each round, ms.
type Times = Vec<f64>;

/// Times all passes over frames of one size, in turns.
fn measure(
    watch: &Stopwatch,
    scene: &Scene,
    frame: &Frame,
    frames: usize,
) -> Result<SizeReport, Box<dyn Error>> {
    let hillaire = &scene.hillaire;
    scene.set_hillaire_view(frame)?;
    let ours = |passes: &SkyPasses| {
        frame.restore(&watch.device, &watch.queue);
        watch.time(|encoder| passes.record(encoder, &frame.target, &frame.depth, &frame.camera))
    };
    let theirs = |record: &dyn Fn(&HillairePasses, &mut wgpu::CommandEncoder)| {
        frame.restore(&watch.device, &watch.queue);
        watch.time(|encoder| record(hillaire, encoder))
    };
    // Tables are filled before the passes that read them.
    watch.time(|encoder| hillaire.record_tables(encoder))?;
    watch.check(|encoder| hillaire.record_multiple_scattering(encoder))?;
    let mut times: [Times; NAMES.len()] = Default::default();
    // The first rounds warm the device up.
    for round in 0..frames + 2 {
        let measured = [
            scene.time_tables(watch)?,
            ours(&scene.clear)?,
            ours(&scene.foggy)?,
            ours(&scene.lit)?,
            theirs(&|passes, encoder| passes.record_transmittance(encoder))?,
            theirs(&|passes, encoder| passes.record_multiple_scattering(encoder))?,
            theirs(&|passes, encoder| passes.record_sky_view(encoder))?,
            theirs(&|passes, encoder| passes.record_aerial_perspective(encoder))?,
            theirs(&|passes, encoder| passes.record(encoder, &frame.target, &frame.depth))?,
        ];
        if round >= 2 {
            times
                .iter_mut()
                .zip(measured)
                .for_each(|(all, ms)| all.push(ms));
        }
    }
    let [tables, clear, foggy, lit, .., sky_view, aerial, compose] = &times;
    let sum = |parts: &[&Times]| -> Times {
        (0..frames)
            .map(|round| parts.iter().map(|part| part[round]).sum())
            .collect()
    };
    let event = |name: &str, ours: &[&Times], theirs: &[&Times]| {
        let (ours, theirs) = (sum(ours), sum(theirs));
        let ratios = ours.iter().zip(&theirs).map(|(a, b)| a / b).collect();
        Event {
            name: name.to_owned(),
            ours_ms: median(ours),
            hillaire_ms: median(theirs),
            ratio: median(ratios),
        }
    };
    let difference =
        |more: &Times, less: &Times| more.iter().zip(less).map(|(a, b)| a - b).collect();
    let mut passes: Vec<Pass> = NAMES
        .iter()
        .zip(&times)
        .map(|(&name, times)| Pass {
            name: name.to_owned(),
            ms: median(times.clone()),
        })
        .collect();
    for (index, more, less) in [(3, lit, foggy), (2, foggy, clear)] {
        passes[index].ms = median(difference(more, less));
    }
    Ok(SizeReport {
        size: frame.size,
        events: vec![
            event("the camera turns", &[clear], &[aerial, compose]),
            event("the camera moves", &[clear], &[sky_view, aerial, compose]),
            event(
                "the sun moves",
                &[tables, clear],
                &[sky_view, aerial, compose],
            ),
        ],
        passes,
    })
}

/// The passes, in the order in which they are timed.
const NAMES: [&str; 9] = [
    "airlight-gpu: tables for a sun, on the processor",
    "airlight-gpu: sky and aerial perspective over the frame",
    "airlight-gpu: fog over the frame",
    "airlight-gpu: eight lights in fog over the frame",
    "Hillaire 2020: transmittance",
    "Hillaire 2020: multiple scattering",
    "Hillaire 2020: sky view",
    "Hillaire 2020: aerial perspective",
    "Hillaire 2020: sky and aerial perspective over the frame",
];
