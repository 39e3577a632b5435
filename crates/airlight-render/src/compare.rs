//! Differences between two pictures of one sky, for each pixel and as statistics.

use crate::image::RenderedImage;
use crate::summary::short;
use airlight::axes;
use airlight::spectrum::difference::{ciede2000, xyz_to_lab};
use airlight::spectrum::rgb;
use glam::DVec3;
use serde::Serialize;
use std::f64::consts::PI;
use std::fmt::Write;

/// Difference of two pictures of one frame at each pixel.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Difference of luminance, percent of the first; NaN where the first picture is black.
    pub percent: Vec<f64>,
    /// CIEDE2000, relative to the luminance that is white in the exposure of the first picture.
    pub ciede2000: Vec<f64>,
}

/// Statistics over the sky above the horizon, weighted by solid angle.
#[derive(Clone, Debug, Serialize)]
pub struct Statistics {
    /// Name of the reference.
    pub first: String,
    /// Name of the picture that is compared with the reference.
    pub second: String,
    /// Elevation of the sun, degrees.
    pub sun_elevation_deg: f64,
    /// Illuminance of a horizontal surface by each sky, lx.
    pub sky_horizontal_lx: [f64; 2],
    /// Factor by which the second picture was scaled.
    pub second_scaled_by: f64,
    /// Difference of luminance, percent of the first.
    pub luminance_percent: Spread,
    /// CIEDE2000 colour difference.
    pub ciede2000: Spread,
    /// Time to solve and draw each picture, s.
    pub seconds: [f64; 2],
}

/// Distribution of a difference over the sky.
#[derive(Clone, Debug, Serialize)]
pub struct Spread {
    /// Signed mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Bound of the absolute value over 95 % of the sky.
    pub within_95: f64,
    /// Difference with the largest absolute value.
    pub worst: f64,
    /// Direction of [`Self::worst`]: azimuth and elevation, degrees.
    pub worst_at_deg: [f64; 2],
}

impl Difference {
    /// Difference of `second`, multiplied by `scale`, from `first`. Both must have the same frame and RGB space.
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

    /// Statistics of the difference of two named pictures; `None` if they show no sky or only black sky.
    pub fn statistics(
        &self,
        (first, first_name): (&RenderedImage, &str),
        (second, second_name): (&RenderedImage, &str),
        scale: f64,
    ) -> Option<Statistics> {
        Some(Statistics {
            first: first_name.to_owned(),
            second: second_name.to_owned(),
            sun_elevation_deg: first.sun.elevation_deg,
            sky_horizontal_lx: [first, second].map(sky_horizontal_lx),
            second_scaled_by: scale,
            luminance_percent: Spread::new(first, &self.percent)?,
            ciede2000: Spread::new(first, &self.ciede2000)?,
            seconds: [first.time.as_secs_f64(), second.time.as_secs_f64()],
        })
    }
}

/// Illuminance of a horizontal surface by the sky of a picture, lx: summed over its pixels if it shows the whole sky, so that the
/// light is that of the solver that drew it (solvers with noise state the illuminance of the fast solver).
pub fn sky_horizontal_lx(image: &RenderedImage) -> f64 {
    /// Difference of the sum of weights from that of the hemisphere up to which a picture shows the whole sky.
    const WHOLE: f64 = 0.05;
    let weights = image.space.to_xyz_matrix()[1];
    let (mut light, mut whole) = (0.0, 0.0);
    for (rgb, direction, solid_angle) in above_the_horizon(image, &image.rgb) {
        let weight = direction.y * solid_angle;
        let luminance: f64 = (0..3).map(|c| weights[c] * f64::from(rgb[c])).sum();
        whole += weight;
        light += weight * luminance;
    }
    match (whole / PI - 1.0).abs() < WHOLE {
        true => light * PI / whole,
        false => image.light.sky_horizontal_lx,
    }
}

/// The values of the pixels above the horizon, with the direction and solid angle of each.
fn above_the_horizon<'a, T>(
    image: &'a RenderedImage,
    values: &'a [T],
) -> impl Iterator<Item = (&'a T, DVec3, f64)> {
    let (width, height) = (image.frame.size().width(), image.frame.size().height());
    let pixels = (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)));
    pixels.zip(values).filter_map(|((i, j), value)| {
        let direction = image.frame.pixel_direction(i, j)?;
        (direction.y > 0.0).then(|| (value, direction, image.frame.pixel_solid_angle(i, j)))
    })
}

impl Spread {
    /// Distribution of values over the pixels above the horizon; `None` if there are none.
    pub fn new(image: &RenderedImage, values: &[f64]) -> Option<Self> {
        let mut sky: Vec<(f64, f64, [f64; 2])> = above_the_horizon(image, values)
            .filter(|(value, ..)| value.is_finite())
            .map(|(&value, direction, solid_angle)| {
                let at = [
                    axes::azimuth_deg(direction),
                    direction.y.asin().to_degrees(),
                ];
                (value, solid_angle, at)
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
    /// Report in lines of text.
    pub fn lines(&self) -> Vec<String> {
        let [first, second] = self.sky_horizontal_lx;
        let mut light = format!(
            "sky on a horizontal surface: {} lx, {} lx ({:+.2} %)",
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illuminance::Illuminances;
    use airlight::scene::SunAngles;
    use airlight::spectrum::RgbSpace;
    use airlight_image::Frame;
    use airlight_image::tone::{ToneCurve, ToneMapper};
    use std::time::Duration;

    /// A picture whose luminance is a function of the row.
    fn image(value: impl Fn(usize) -> f32) -> RenderedImage {
        let frame = Frame::equirectangular(8).unwrap();
        RenderedImage {
            frame,
            space: RgbSpace::Srgb,
            rgb: (0..128).map(|i| [value(i / 16); 3]).collect(),
            sun: SunAngles {
                azimuth_deg: 180.0,
                elevation_deg: 30.0,
                geometric_elevation_deg: None,
                distance_ratio: 1.0,
            },
            light: Illuminances {
                sun_normal_lx: 1e5,
                sun_horizontal_lx: 5e4,
                sky_horizontal_lx: 1e4,
                moon_normal_lx: None,
                moon_horizontal_lx: None,
            },
            tone: ToneMapper::new(1e-3, ToneCurve::Clip).unwrap(),
            time: Duration::ZERO,
        }
    }

    fn statistics(first: &RenderedImage, second: &RenderedImage, scale: f64) -> Option<Statistics> {
        Difference::new(first, second, scale).statistics((first, "a"), (second, "b"), scale)
    }

    #[test]
    fn equal_pictures_do_not_differ_and_scales_are_percentages() {
        let sky = image(|row| 100.0 + row as f32);
        let same = statistics(&sky, &sky, 1.0).unwrap();
        assert_eq!(
            [same.luminance_percent.worst, same.ciede2000.worst],
            [0.0; 2]
        );
        let brighter = statistics(&sky, &sky, 1.25).unwrap().luminance_percent;
        for value in [
            brighter.mean,
            brighter.rms,
            brighter.within_95,
            brighter.worst,
        ] {
            assert!((value - 25.0).abs() < 1e-4, "{brighter:?}");
        }
    }

    /// A sky of even luminance L lights a horizontal surface with pi L, whatever the solver states.
    #[test]
    fn the_light_is_that_of_the_picture() {
        let even = image(|_| 100.0);
        assert!((sky_horizontal_lx(&even) / (100.0 * PI) - 1.0).abs() < 1e-6);
        let brighter = image(|row| if row < 4 { 110.0 } else { 0.0 });
        let [first, second] = statistics(&even, &brighter, 1.0).unwrap().sky_horizontal_lx;
        assert!((second / first - 1.1).abs() < 1e-6);
        // A picture of part of the sky.
        let size = airlight_image::Size::new(16, 8).unwrap();
        let camera = airlight_image::Camera::with_horizontal_fov(0.0, 20.0, 60.0, size);
        let projection = airlight_image::Projection::Perspective(camera);
        let part = RenderedImage {
            frame: Frame::new(projection, 16, 8).unwrap(),
            ..even
        };
        assert_eq!(sky_horizontal_lx(&part), 1e4);
    }

    #[test]
    fn rows_below_the_horizon_are_ignored_and_the_worst_is_found() {
        let sky = image(|_| 100.0);
        let ground = image(|row| if row < 4 { 100.0 } else { 900.0 });
        assert_eq!(
            statistics(&sky, &ground, 1.0)
                .unwrap()
                .luminance_percent
                .worst,
            0.0
        );
        // The row from 45 to 67.5 degrees.
        let dark = image(|row| if row == 1 { 50.0 } else { 100.0 });
        let found = statistics(&sky, &dark, 1.0).unwrap().luminance_percent;
        assert!((found.worst + 50.0).abs() < 1e-4);
        assert!((found.worst_at_deg[1] - 56.25).abs() < 1e-9);
        assert!(found.mean < -5.0 && found.mean > -15.0);
        let black = image(|_| 0.0);
        assert!(statistics(&black, &sky, 1.0).is_none());
    }
}
