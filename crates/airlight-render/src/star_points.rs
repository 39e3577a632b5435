//! Stars as points of light in a picture.

use crate::channels::PixelChannels;
use airlight::scene::StarField;
use airlight_image::{Frame, Projection};

/// The light of a star in one pixel.
#[derive(Clone, Copy, Debug)]
struct StarPixel {
    row: u32,
    column: u32,
    star: usize,
    /// Radiance per irradiance of the star: its share over the solid angle of the pixel, 1/sr.
    weight: f32,
}

/// Standard deviation of the image of a star, pixels: about that of a sharp lens on its sensor.
const DEVIATION_PX: f64 = 0.6;
/// Number of pixels on each side of that of a star over which its image extends.
const REACH: i32 = 3;

/// Shares of the pixels around a coordinate in the image of a star, which add up to 1.
fn shares(at: f64) -> [f64; 2 * REACH as usize + 1] {
    let mut shares = [0.0; 2 * REACH as usize + 1];
    for (share, i) in shares.iter_mut().zip(-REACH..=REACH) {
        let away = (at.floor() + f64::from(i) + 0.5 - at) / DEVIATION_PX;
        *share = (-0.5 * away * away).exp();
    }
    let sum: f64 = shares.iter().sum();
    shares.map(|share| share / sum)
}

/// Stars in one frame. Each is a small spot, so that it moves smoothly, and the sum of radiance times solid angle over its pixels
/// is its irradiance at any resolution.
#[derive(Clone, Debug)]
pub struct StarPoints<'a> {
    stars: &'a StarField,
    /// Sorted by row.
    pixels: Vec<StarPixel>,
}

impl<'a> StarPoints<'a> {
    /// Places stars in a frame.
    pub fn new(frame: &Frame, stars: &'a StarField) -> Self {
        let (width, height) = (frame.size().width(), frame.size().height());
        let wraps = matches!(frame.projection(), Projection::Equirectangular { .. });
        let mut pixels = Vec::new();
        for (star, &direction) in stars.directions.iter().enumerate() {
            let Some((x, y)) = frame.pixel_of(direction) else {
                continue;
            };
            let column = |at: f64| match wraps {
                true => at.rem_euclid(f64::from(width)) as u32,
                false => at.clamp(0.0, f64::from(width - 1)) as u32,
            };
            let row = |at: f64| at.clamp(0.0, f64::from(height - 1)) as u32;
            let (across, down) = (shares(x), shares(y));
            for (j, down) in (-REACH..=REACH).zip(down) {
                for (i, across) in (-REACH..=REACH).zip(across) {
                    let row = row(y.floor() + f64::from(j));
                    let column = column(x.floor() + f64::from(i));
                    let solid_angle = frame.pixel_solid_angle(column, row);
                    if solid_angle > 0.0 {
                        pixels.push(StarPixel {
                            row,
                            column,
                            star,
                            weight: (across * down / solid_angle) as f32,
                        });
                    }
                }
            }
        }
        pixels.sort_by_key(|pixel| pixel.row);
        Self { stars, pixels }
    }

    /// Adds the stars of a row to its pixels; values are radiance multiplied by `scale`.
    pub fn add_row(&self, y: u32, scale: f32, channels: &PixelChannels, out: &mut [f32]) {
        let count = channels.view_count();
        let first = self.pixels.partition_point(|pixel| pixel.row < y);
        for pixel in self.pixels[first..]
            .iter()
            .take_while(|pixel| pixel.row == y)
        {
            let irradiance = &self.stars.irradiance[pixel.star * count..][..count];
            let at = pixel.column as usize * channels.count();
            channels.add(
                irradiance,
                scale * pixel.weight,
                &mut out[at..][..channels.count()],
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::axes;
    use airlight::spectrum::RgbSpace;
    use airlight_image::{Camera, Fisheye, Size};

    #[test]
    fn irradiance_is_kept_in_all_projections() {
        let size = Size::new(80, 60).unwrap();
        let camera = Camera::with_horizontal_fov(100.0, 30.0, 70.0, size);
        let stars = StarField {
            directions: vec![axes::direction(100.0, 30.0), axes::direction(103.7, 41.3)],
            irradiance: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        };
        let seam = StarField {
            directions: vec![axes::direction(0.01, 89.9), axes::direction(180.0, 20.0)],
            ..stars.clone()
        };
        let panorama = Projection::Equirectangular {
            center_azimuth_deg: 0.0,
        };
        for (stars, projection, (width, height)) in [
            (&stars, Projection::Perspective(camera), (80, 60)),
            (
                &stars,
                Projection::AngularFisheye(Fisheye::ALL_SKY),
                (64, 64),
            ),
            (&stars, panorama, (16, 8)),
            (&seam, panorama, (64, 32)),
        ] {
            let frame = Frame::new(projection, width, height).unwrap();
            let points = StarPoints::new(&frame, stars);
            let channels = PixelChannels::rgb(RgbSpace::Srgb);
            let mut sum = [0.0; 3];
            for y in 0..height {
                let mut row = vec![0.0; 3 * width as usize];
                points.add_row(y, 2.0, &channels, &mut row);
                for (x, pixel) in (0..).zip(row.chunks_exact(3)) {
                    let solid_angle = frame.pixel_solid_angle(x, y);
                    for (sum, v) in sum.iter_mut().zip(pixel) {
                        *sum += 0.5 * f64::from(*v) * solid_angle;
                    }
                }
            }
            for (got, want) in sum.iter().zip([5.0, 7.0, 9.0]) {
                assert!(
                    (got / want - 1.0).abs() < 1e-5,
                    "{width}: {got} against {want}"
                );
            }
        }
    }
}
