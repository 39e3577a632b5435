//! Times of `airlight-gpu` and of Hillaire 2020 on one graphics device, pass by pass:
//! `cargo run --release -p airlight-validation --features gpu --example gpu_speed -- [--sizes 1280x720,1920x1080] [--frames 20] [--no-fog]
//! [--json] [--pictures FOLDER]`.
//!
//! The scene: mountains below an evening sky in the air of the paper, with fog in the valleys and lights in it as passes of their own. Both
//! draw over the same frame, in turns. Passes are timed by time stamps of the device where these can be trusted.

mod options;
mod report;
mod scene;
mod stopwatch;

use airlight_gpu::SkyPasses;
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
        sizes.push(measure(&watch, &scene, &frame, options)?);
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

/// Times of the passes of a round, ms.
struct Round {
    /// Our tables for a sun, on the processor.
    tables: f64,
    /// Our passes over the frame: air, and what fog and lights take besides.
    air: f64,
    fog: Option<f64>,
    lights: Option<f64>,
    /// Tables of Hillaire 2020, and its pass over the frame.
    transmittance: f64,
    multiple_scattering: f64,
    sky_view: f64,
    aerial_perspective: f64,
    compose: f64,
}

/// Times all passes over frames of one size, in turns.
fn measure(
    watch: &Stopwatch,
    scene: &Scene,
    frame: &Frame,
    options: &Options,
) -> Result<SizeReport, Box<dyn Error>> {
    let hillaire = &scene.hillaire;
    scene.set_hillaire_view(frame)?;
    // Tables are filled before the passes that read them.
    watch.time(|encoder| hillaire.record_tables(encoder))?;
    watch.check(|encoder| hillaire.record_multiple_scattering(encoder))?;
    let mut rounds = Vec::new();
    for _ in 0..options.frames + WARM_UP {
        rounds.push(round(watch, scene, frame, options.fog)?);
    }
    rounds.drain(..WARM_UP);
    Ok(SizeReport {
        size: frame.size,
        passes: passes(&rounds),
        events: events(&rounds),
    })
}

/// Rounds that only warm the device up.
const WARM_UP: usize = 2;

fn round(
    watch: &Stopwatch,
    scene: &Scene,
    frame: &Frame,
    has_fog: bool,
) -> Result<Round, Box<dyn Error>> {
    let time = |record: &dyn Fn(&mut wgpu::CommandEncoder)| {
        frame.restore(&watch.device, &watch.queue);
        watch.time(record)
    };
    let ours = |passes: &SkyPasses| {
        time(&|encoder| passes.record(encoder, &frame.target, &frame.depth, &frame.camera))
    };
    let hillaire = &scene.hillaire;
    let air = ours(&scene.clear)?;
    let (fog, lights) = match has_fog {
        true => {
            let (foggy, lit) = (ours(&scene.foggy)?, ours(&scene.lit)?);
            (Some(foggy - air), Some(lit - foggy))
        }
        false => (None, None),
    };
    Ok(Round {
        tables: scene.time_tables(watch)?,
        air,
        fog,
        lights,
        transmittance: time(&|encoder| hillaire.record_transmittance(encoder))?,
        multiple_scattering: time(&|encoder| hillaire.record_multiple_scattering(encoder))?,
        sky_view: time(&|encoder| hillaire.record_sky_view(encoder))?,
        aerial_perspective: time(&|encoder| hillaire.record_aerial_perspective(encoder))?,
        compose: time(&|encoder| hillaire.record(encoder, &frame.target, &frame.depth))?,
    })
}

/// What of a round is reported.
type Of<T> = fn(&Round) -> T;

fn passes(rounds: &[Round]) -> Vec<Pass> {
    let all: [(&str, Of<Option<f64>>); 9] = [
        ("airlight-gpu: tables for a sun, on the processor", |r| {
            Some(r.tables)
        }),
        (
            "airlight-gpu: sky and aerial perspective over the frame",
            |r| Some(r.air),
        ),
        ("airlight-gpu: fog over the frame", |r| r.fog),
        ("airlight-gpu: eight lights in fog over the frame", |r| {
            r.lights
        }),
        ("Hillaire 2020: transmittance", |r| Some(r.transmittance)),
        ("Hillaire 2020: multiple scattering", |r| {
            Some(r.multiple_scattering)
        }),
        ("Hillaire 2020: sky view", |r| Some(r.sky_view)),
        ("Hillaire 2020: aerial perspective", |r| {
            Some(r.aerial_perspective)
        }),
        (
            "Hillaire 2020: sky and aerial perspective over the frame",
            |r| Some(r.compose),
        ),
    ];
    let pass = |(name, of): (&str, Of<Option<f64>>)| {
        let times: Option<Vec<f64>> = rounds.iter().map(of).collect();
        times.map(|times| Pass {
            name: name.to_owned(),
            ms: median(times),
        })
    };
    all.into_iter().filter_map(pass).collect()
}

/// What each renderer does after a change: ours fills no tables unless the sun moves.
fn events(rounds: &[Round]) -> Vec<Event> {
    let all: [(&str, Of<[f64; 2]>); 3] = [
        ("the camera turns", |r| {
            [r.air, r.aerial_perspective + r.compose]
        }),
        ("the camera moves", |r| {
            [r.air, r.sky_view + r.aerial_perspective + r.compose]
        }),
        ("the sun moves", |r| {
            let hillaire = r.sky_view + r.aerial_perspective + r.compose;
            [r.tables + r.air, hillaire]
        }),
    ];
    let event = |(name, of): (&str, Of<[f64; 2]>)| {
        let of_rounds = |part: &dyn Fn([f64; 2]) -> f64| {
            median(rounds.iter().map(|round| part(of(round))).collect())
        };
        Event {
            name: name.to_owned(),
            ours_ms: of_rounds(&|[ours, _]| ours),
            hillaire_ms: of_rounds(&|[_, hillaire]| hillaire),
            ratio: of_rounds(&|[ours, hillaire]| ours / hillaire),
        }
    };
    all.into_iter().map(event).collect()
}
