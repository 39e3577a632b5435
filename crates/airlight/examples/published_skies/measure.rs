//! Directions, errors and timing for the comparisons.

use airlight::axes;
use glam::DVec3;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Azimuth of the sun, degrees.
pub const SUN_AZIMUTH_DEG: f64 = 90.0;
/// Elevations of the sun, degrees.
pub const SUNS_DEG: [f64; 4] = [60.0, 30.0, 10.0, 2.0];

/// Directions above the horizon, at least 15 degrees from the sun's azimuth.
pub fn fan() -> Vec<DVec3> {
    let elevations = [1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0];
    let azimuths = [15.0, 60.0, 120.0, 180.0];
    elevations
        .into_iter()
        .flat_map(|e| azimuths.map(|a| axes::direction(SUN_AZIMUTH_DEG + a, e)))
        .collect()
}

/// Unit vector to the sun at an elevation.
pub fn sun(elevation_deg: f64) -> DVec3 {
    axes::direction(SUN_AZIMUTH_DEG, elevation_deg)
}

/// Root mean square and largest relative error, percent.
pub struct Errors {
    pub rms: f64,
    pub worst: f64,
}

impl Errors {
    /// Errors of pairs of a value and its reference.
    pub fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Self {
        let (mut sum, mut worst, mut count) = (0.0, 0.0f64, 0);
        for (got, want) in pairs {
            let error = got / want - 1.0;
            sum += error * error;
            count += 1;
            if error.abs() > worst.abs() {
                worst = error;
            }
        }
        Self {
            rms: 100.0 * (sum / f64::from(count)).sqrt(),
            worst: 100.0 * worst,
        }
    }
}

impl std::fmt::Display for Errors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = |v: f64| match v.abs() {
            9.95.. => 0,
            0.995.. => 1,
            0.0995.. => 2,
            _ => 3,
        };
        let (rms, worst) = (digits(self.rms), digits(self.worst));
        write!(f, "{:.rms$} ({:+.worst$})", self.rms, self.worst)
    }
}

/// Formats a ratio of times with two digits, or more if it has more before the decimal point.
pub fn ratio(v: f64) -> String {
    let before = v.abs().max(1e-9).log10().floor() as i32;
    format!("{v:.0$}", (1 - before).max(0) as usize)
}

/// Prints the head of a table over [`SUNS_DEG`].
pub fn head(columns: &str) {
    let suns = SUNS_DEG.map(|sun| format!("{sun}°")).join(" | ");
    println!("|{columns} | sun {suns} |");
    let count = columns.split('|').count() + SUNS_DEG.len();
    println!("|{}", "---|".repeat(count));
}

/// Seconds per view ray, averaged over the fan: the minimum over many rounds.
pub fn seconds_a_line<T>(mut look: impl FnMut(DVec3) -> T) -> f64 {
    let fan = fan();
    let start = Instant::now();
    let mut fastest = f64::INFINITY;
    while start.elapsed() < Duration::from_millis(800) {
        let round = Instant::now();
        for &direction in &fan {
            black_box(look(black_box(direction)));
        }
        fastest = fastest.min(round.elapsed().as_secs_f64());
    }
    fastest / fan.len() as f64
}
