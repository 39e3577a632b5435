//! How much two skies differ, direction by direction and in sum.

use crate::report::short;
use crate::sky::RenderedImage;
use airlight::axes;
use airlight::spectrum::difference::{ciede2000, xyz_to_lab};
use airlight::spectrum::rgb;
use serde::Serialize;
use std::fmt::Write;

/// The difference of two pictures of one frame at each pixel.
pub struct Difference {
    /// Of luminance, percent of the first's; no number where the first is black.
    pub percent: Vec<f64>,
    /// CIEDE2000, against a white that the first picture's exposure makes white.
    pub ciede2000: Vec<f64>,
}

/// Sums over the sky above the horizon, each direction by its solid angle.
#[derive(Debug, Serialize)]
pub struct Statistics {
    /// The solver measured against.
    pub first: String,
    /// The one measured.
    pub second: String,
    /// Elevation of the sun.
    pub sun_elevation_deg: f64,
    /// Light of both skies on the horizontal.
    pub sky_horizontal_lx: [f64; 2],
    /// Factor by which the second was scaled.
    pub second_scaled_by: f64,
    /// Difference of luminance, percent of the first's.
    pub luminance_percent: Spread,
    /// CIEDE2000.
    pub ciede2000: Spread,
    /// Time that both took, s.
    pub seconds: [f64; 2],
}

/// How differences spread over the sky.
#[derive(Debug, Serialize)]
pub struct Spread {
    /// The mean, with its sign.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// What 95 % of the sky stays within.
    pub within_95: f64,
    /// The largest.
    pub worst: f64,
    /// Where that is: azimuth and elevation, degrees.
    pub worst_at_deg: [f64; 2],
}

impl Difference {
    /// Of `second`, `scale` times, from `first`.
    pub fn new(first: &RenderedImage, second: &RenderedImage, scale: f64) -> Self {
        let to_xyz = first.space.to_xyz_matrix();
        let exposure = f64::from(first.tone.exposure());
        let white = rgb::apply(&to_xyz, [1.0; 3]);
        let (mut percent, mut differences) = (Vec::new(), Vec::new());
        for (a, b) in first.rgb.iter().zip(&second.rgb) {
            let xyz = |rgb: &[f32; 3], by: f64| rgb::apply(&to_xyz, rgb.map(|c| by * f64::from(c)));
            let (a, b) = (xyz(a, exposure), xyz(b, scale * exposure));
            percent.push(match a[1] > 0.0 {
                true => 100.0 * (b[1] / a[1] - 1.0),
                false => f64::NAN,
            });
            differences.push(ciede2000(xyz_to_lab(a, white), xyz_to_lab(b, white)));
        }
        Self {
            percent,
            ciede2000: differences,
        }
    }
}

impl Spread {
    /// Of the values of a picture's pixels above the horizon; `None` where it shows none.
    pub fn new(image: &RenderedImage, values: &[f64]) -> Option<Self> {
        let (width, height) = (image.frame.size().width(), image.frame.size().height());
        let pixels = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
        let mut sky: Vec<(f64, f64, [f64; 2])> = pixels
            .zip(values)
            .filter_map(|((i, j), &value)| {
                let direction = image.frame.pixel_direction(i, j)?;
                let above = direction.y > 0.0 && value.is_finite();
                let at = [
                    axes::azimuth_deg(direction),
                    direction.y.asin().to_degrees(),
                ];
                above.then(|| (value, image.frame.pixel_solid_angle(i, j), at))
            })
            .collect();
        let whole: f64 = sky.iter().map(|pixel| pixel.1).sum();
        let mean_of = |f: fn(f64) -> f64| {
            sky.iter().map(|&(v, weight, _)| weight * f(v)).sum::<f64>() / whole
        };
        let (mean, rms) = (mean_of(|v| v), mean_of(|v| v * v).sqrt());
        sky.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let &(worst, _, worst_at_deg) = sky.last()?;
        let mut below = 0.0;
        let within_95 = sky
            .iter()
            .find(|pixel| {
                below += pixel.1;
                below >= 0.95 * whole
            })
            .map_or(worst, |pixel| pixel.0);
        Some(Self {
            mean,
            rms,
            within_95: within_95.abs(),
            worst,
            worst_at_deg,
        })
    }

    fn in_words(&self, unit: &str) -> String {
        format!(
            "mean {}{unit}, rms {}{unit}, 95 % of the sky within {}{unit}, worst {}{unit} at azimuth {:.1}, elevation {:.1} deg",
            short(self.mean),
            short(self.rms),
            short(self.within_95),
            short(self.worst),
            self.worst_at_deg[0],
            self.worst_at_deg[1]
        )
    }
}

impl Statistics {
    /// As lines to read.
    pub fn lines(&self) -> Vec<String> {
        let [first, second] = self.sky_horizontal_lx;
        let mut light = format!(
            "sky on the horizontal: {} lx, {} lx ({:+.2} %)",
            short(first),
            short(second),
            100.0 * (second / first - 1.0)
        );
        if self.second_scaled_by != 1.0 {
            // Writing to a string cannot fail.
            let _ = write!(
                light,
                ", the second scaled by {}",
                short(self.second_scaled_by)
            );
        }
        vec![
            light,
            format!("luminance: {}", self.luminance_percent.in_words(" %")),
            format!("CIEDE2000: {}", self.ciede2000.in_words("")),
        ]
    }
}
