//! Prints the numbers of the book's chapter on the sky of 1987 (`scripts/book`): `cargo run --release -p airlight --example
//! klassen1987`; with the argument `path`, `blue`, `error`, `coherence` or `speed` only that part.

use airlight::atmosphere::presets;
use airlight::axes::direction;
use airlight::models::PublishedModel;
use airlight::models::klassen1987::{BaseBlue, Klassen1987, Klassen1987Error, Klassen1987Settings};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::difference::{D65_WHITE, ciede2000, xyz_to_lab};
use airlight::spectrum::rgb::{apply, srgb_encode};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use glam::DVec3;
use std::collections::HashSet;
use std::error::Error;
use std::time::Instant;

type Part = fn() -> Result<(), Klassen1987Error>;

const PARTS: [(&str, Part); 5] = [
    ("path", path),
    ("blue", blue),
    ("error", error),
    ("coherence", coherence),
    ("speed", speed),
];

fn main() -> Result<(), Box<dyn Error>> {
    let only = std::env::args().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    if !PARTS.iter().any(|(name, _)| wanted(name)) {
        return Err(format!("expected one of {}", PARTS.map(|(name, _)| name).join(", ")).into());
    }
    for (_, part) in PARTS.iter().filter(|(name, _)| wanted(name)) {
        part()?;
    }
    Ok(())
}

/// Formats a number with two digits, or more if it has more before the decimal point.
fn short(v: f64) -> String {
    let before = v.abs().log10().floor() as i32;
    format!("{v:.0$}", (1 - before).clamp(0, 4) as usize)
}

/// Directions of the pixels of a picture: 100 degrees wide, 50 high, lower edge on the horizon, centred on the sun's azimuth;
/// twice as wide as high, as in the paper's table I.
fn pixels(width: u32) -> impl Iterator<Item = DVec3> {
    let height = width / 2;
    (0..height).flat_map(move |j| {
        (0..width).map(move |i| {
            let across = (f64::from(i) + 0.5) / f64::from(width);
            let up = 1.0 - (f64::from(j) + 0.5) / f64::from(height);
            direction(130.0 + 100.0 * across, 50.0 * up)
        })
    })
}

/// Table I: seconds for a picture on one thread, with and without coherence, compared with the paper's.
fn speed() -> Result<(), Klassen1987Error> {
    println!(
        "| pixels | 1987, s | µs a pixel | printed, s | µs a pixel | without coherence | corrected, s | µs a pixel | without coherence |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    // The paper's seconds, and microseconds per pixel.
    for (sun, elevation_deg, paper) in [
        (
            "noon: ",
            60.0,
            [
                (153, 1167),
                (60, 1831),
                (25, 3015),
                (11, 5225),
                (5, 10547),
                (3, 20313),
            ],
        ),
        (
            "sunset: ",
            1.0,
            [
                (654, 4990),
                (309, 9430),
                (144, 17578),
                (64, 31250),
                (31, 61328),
                (13, 101_563),
            ],
        ),
    ] {
        let toward = direction(180.0, elevation_deg);
        let forms = [
            Klassen1987Settings::default().printed(),
            Klassen1987Settings::default(),
        ];
        for (row, (paper_s, paper_us)) in paper.into_iter().enumerate() {
            let width = 512 >> row;
            let count = width * width / 2;
            let a_pixel = |seconds: f64| 1e6 * seconds / f64::from(count);
            print!(
                "| {}{count} | {paper_s} | {paper_us} |",
                if row == 0 { sun } else { "" },
            );
            for settings in &forms {
                // A first model initialises the shared tables; the second is timed together with its own cells.
                Klassen1987::new(settings, toward)?;
                let model = Klassen1987::new(settings, toward)?;
                let start = Instant::now();
                let mut walk = model.walk();
                let sum: f64 = pixels(width).map(|look| walk(look)[1]).sum();
                let with_s = start.elapsed().as_secs_f64();
                let start = Instant::now();
                let plain: f64 = pixels(width).map(|look| model.sky_xyz(look)[1]).sum();
                let without_s = start.elapsed().as_secs_f64();
                assert!((sum / plain - 1.0).abs() < 0.01);
                print!(
                    " {} | {} | {} |",
                    short(with_s),
                    short(a_pixel(with_s)),
                    short(a_pixel(without_s))
                );
            }
            println!();
        }
    }
    Ok(())
}

/// Eqs. 24 and 27 to 29 compared with the exact path, in the light of the haze.
fn path() -> Result<(), Klassen1987Error> {
    println!("haze of eqs. 24 to 29 against the exact one, %: sun, elevation, 450, 550, 650 nm");
    for sun_deg in [2.0, 20.0, 60.0] {
        let toward = direction(180.0, sun_deg);
        let plain = Klassen1987Settings {
            base_blue: BaseBlue::PAPER,
            ..Klassen1987Settings::default()
        };
        let exact = Klassen1987::new(&plain, toward)?;
        let printed = Klassen1987::new(&plain.printed(), toward)?;
        for elevation_deg in [0.0, 0.5, 1.0, 2.0, 5.0, 10.0] {
            let look = direction(90.0, elevation_deg);
            let (printed, exact) = (printed.haze_spectrum(look), exact.haze_spectrum(look));
            let [a, b, c] = [7, 17, 27].map(|lane| 100.0 * (printed[lane] / exact[lane] - 1.0));
            println!("{sun_deg}, {elevation_deg}, {a:.1}, {b:.1}, {c:.1}");
        }
    }
    Ok(())
}

/// Equal-area directions of the upper hemisphere, at least 2 degrees from the sun.
fn sky_directions(sun: DVec3) -> Vec<DVec3> {
    let rows = (0..20).map(|i| ((f64::from(i) + 0.5) / 20.0).asin().to_degrees());
    rows.flat_map(|elevation| (0..24).map(move |k| direction(15.0 * f64::from(k) + 7.5, elevation)))
        .filter(|look| look.angle_between(sun) > 2f64.to_radians())
        .collect()
}

/// The paper's blue compared with the solver's clear sky: mean luminance and colour.
fn blue() -> Result<(), Klassen1987Error> {
    println!("| sun | solver, cd/m² | x, y | paper's blue, cd/m² | x, y |");
    println!("|---|---|---|---|---|");
    for sun_deg in [90.0, 40.0, 20.0, 5.0, 0.0] {
        let sun = direction(180.0, sun_deg);
        let clear = Klassen1987Settings {
            haze_extinction_per_m: 0.0,
            ..Klassen1987Settings::default()
        };
        let mean = |settings: &Klassen1987Settings| -> Result<[f64; 3], Klassen1987Error> {
            let model = Klassen1987::new(settings, sun)?;
            let looks = sky_directions(sun);
            let mut sum = [0.0; 3];
            for look in &looks {
                let xyz = model.sky_xyz(*look);
                (0..3).for_each(|i| sum[i] += xyz[i] / looks.len() as f64);
            }
            Ok(sum)
        };
        let (ours, paper) = (mean(&clear)?, mean(&clear.clone().printed())?);
        let xy = |c: [f64; 3]| {
            let sum: f64 = c.iter().sum();
            format!("{:.3}, {:.3}", c[0] / sum, c[1] / sum)
        };
        println!(
            "| {sun_deg}° | {:.0} | {} | {:.0} | {} |",
            ours[1],
            xy(ours),
            paper[1],
            xy(paper)
        );
    }
    Ok(())
}

/// The model compared with the solver, in its own layers of haze and in average air.
fn error() -> Result<(), Klassen1987Error> {
    println!("| air | sun | form | mean | rms | CIEDE2000 | colour alone | sun |");
    println!("|---|---|---|---|---|---|---|---|");
    let layers = Klassen1987Settings::default();
    let average = presets::average();
    for (air, atmosphere, settings) in [
        ("layers", layers.atmosphere()?, layers),
        (
            "average",
            average.clone(),
            Klassen1987Settings::of(&average),
        ),
    ] {
        let mut air = air;
        for sun_deg in [1.0, 5.0, 20.0, 60.0] {
            let sun = direction(180.0, sun_deg);
            let mut sun_text = format!("{sun_deg}°");
            let solved = SkySettings {
                suns: SunCoverage::near(sun_deg, 0.0),
                ..SkySettings::default()
            };
            let sky = Sky::prepare(&atmosphere, &WavelengthGrid::standard(), &solved)?;
            let view = sky.view(0.0, sun);
            let looks = sky_directions(sun);
            let truth: Vec<[f64; 3]> = looks
                .iter()
                .map(|&look| sky.grid().to_xyz(&view.along(look, None).radiance()))
                .collect();
            let true_sun = sky.grid().to_xyz(&view.sun_irradiance());
            for (variant, settings) in [
                ("printed", settings.clone().printed()),
                ("corrected", settings.clone()),
            ] {
                let model = Klassen1987::new(&settings, sun)?;
                let colours: Vec<[f64; 3]> = looks.iter().map(|&l| model.sky_xyz(l)).collect();
                let sunlight: Vec<f32> = model.sun_irradiance().iter().map(|&e| e as f32).collect();
                let [bias, rms, seen, colour] = differences(&colours, &truth);
                let got_sun = model.grid().to_xyz(&sunlight);
                println!(
                    "| {} | {} | {variant} | {bias:+.0} % | {rms:.0} % | {} | {} | {:+.0} % |",
                    std::mem::take(&mut air),
                    std::mem::take(&mut sun_text),
                    short(seen),
                    short(colour),
                    100.0 * (got_sun[1] / true_sun[1] - 1.0),
                );
            }
        }
    }
    Ok(())
}

/// CIELAB of a colour, exposed so that the luminance `half` is at half of white.
fn lab(xyz: [f64; 3], half: f64) -> [f64; 3] {
    xyz_to_lab(xyz.map(|v| 50.0 * v / half), D65_WHITE)
}

/// Mean luminance and its relative error (root mean square) in percent; mean CIEDE2000 with the mean luminance of the
/// reference at half of white, and with the luminance of each colour there.
fn differences(colours: &[[f64; 3]], truth: &[[f64; 3]]) -> [f64; 4] {
    let count = truth.len() as f64;
    let mean = |all: &[[f64; 3]]| all.iter().map(|xyz| xyz[1]).sum::<f64>() / count;
    let level = mean(truth);
    let (mut squares, mut seen, mut colour) = (0.0, 0.0, 0.0);
    for (got, want) in colours.iter().zip(truth) {
        squares += (got[1] / want[1] - 1.0).powi(2) / count;
        seen += ciede2000(lab(*got, level), lab(*want, level)) / count;
        colour += ciede2000(lab(*got, got[1]), lab(*want, want[1])) / count;
    }
    let bias = 100.0 * (mean(colours) / level - 1.0);
    [bias, 100.0 * squares.sqrt(), seen, colour]
}

/// 8-bit pictures with coherence, compared with every pixel computed.
fn coherence() -> Result<(), Klassen1987Error> {
    let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
    println!(
        "coherence, 512 x 256: sun, variant, values that differ by one code %, worst, cells seen"
    );
    for sun_deg in [1.0, 5.0, 20.0, 60.0] {
        for (variant, settings) in [
            ("printed", Klassen1987Settings::default().printed()),
            ("corrected", Klassen1987Settings::default()),
        ] {
            let model = Klassen1987::new(&settings, direction(180.0, sun_deg))?;
            let mut walk = model.walk();
            let looks: Vec<DVec3> = pixels(512).collect();
            let plain: Vec<[f64; 3]> = looks
                .iter()
                .map(|&l| apply(&from_xyz, model.sky_xyz(l)))
                .collect();
            let walked: Vec<[f64; 3]> = looks.iter().map(|&l| walk(l)).collect();
            let white = 5.0 * plain.iter().map(|rgb| rgb[1]).sum::<f64>() / plain.len() as f64;
            let code = |v: f64| (255.0 * srgb_encode((v / white).clamp(0.0, 1.0))).round();
            let (mut worst, mut differing) = (0.0f64, 0);
            for (a, b) in plain.iter().zip(&walked) {
                for (a, b) in a.iter().zip(apply(&from_xyz, *b)) {
                    let step = (code(*a) - code(b)).abs();
                    worst = worst.max(step);
                    differing += u32::from(step > 0.0);
                }
            }
            let cells: HashSet<[u64; 3]> = walked.iter().map(|c| c.map(f64::to_bits)).collect();
            println!(
                "{sun_deg}, {variant}, {:.2}, {worst}, {}",
                100.0 * f64::from(differing) / (3 * plain.len()) as f64,
                cells.len()
            );
        }
    }
    Ok(())
}
