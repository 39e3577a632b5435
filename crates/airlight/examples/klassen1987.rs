//! Prints the numbers of the book's chapter on the sky of 1987: `cargo run --release -p airlight --example klassen1987`.
//! With the word `speed`, `error`, `blue` or `path` only that part.

use airlight::axes::direction;
use airlight::classic::ClassicSky;
use airlight::classic::klassen1987::{Klassen1987, Klassen1987Error, Klassen1987Settings};
use glam::DVec3;
use std::time::Instant;

fn main() -> Result<(), Klassen1987Error> {
    let part = std::env::args().nth(1);
    let wanted = |name: &str| part.as_deref().is_none_or(|part| part == name);
    if wanted("speed") {
        speed()?;
    }
    Ok(())
}

/// Where the pixels of a picture look: 100 degrees across, 50 high, its lower edge on the horizon, the sun's side in the
/// middle; twice as wide as high, as in the paper's table I.
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

/// Table I: seconds for a picture on one thread, colours remembered and not.
fn speed() -> Result<(), Klassen1987Error> {
    println!("table I: sun, variant, pixels, s, ns a pixel, s without coherence, ns a pixel");
    for (sun, elevation_deg) in [("noon", 60.0), ("sunset", 1.0)] {
        for (variant, settings) in [
            ("printed", Klassen1987Settings::default().printed()),
            ("corrected", Klassen1987Settings::default()),
        ] {
            let toward = direction(180.0, elevation_deg);
            Klassen1987::new(&settings, toward)?;
            for width in [512, 256, 128, 64, 32, 16] {
                let count = width * width / 2;
                // A model of its own, so that its cells are part of the time.
                let model = Klassen1987::new(&settings, toward)?;
                let start = Instant::now();
                let mut walk = model.walk();
                let sum: f64 = pixels(width).map(|look| walk(look)[1]).sum();
                let with_s = start.elapsed().as_secs_f64();
                let start = Instant::now();
                let plain: f64 = pixels(width).map(|look| model.sky_xyz(look)[1]).sum();
                let without_s = start.elapsed().as_secs_f64();
                assert!((sum / plain - 1.0).abs() < 0.01);
                println!(
                    "{sun}, {variant}, {count}, {with_s:.5}, {:.0}, {without_s:.5}, {:.0}",
                    1e9 * with_s / f64::from(count),
                    1e9 * without_s / f64::from(count),
                );
            }
        }
    }
    Ok(())
}
