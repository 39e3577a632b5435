//! The sun's disc in a picture: of its true size, with limb darkening, attenuated by the air, hidden below the horizon, and with
//! the correct irradiance for pixels of any size.
//!
//! A pixel is the mean of the disc's radiance over its solid angle. The integral is a sum over cells: a pixel is halved across its
//! longer side until the parts lie outside the disc or are small compared with the disc (and, if they contain an edge of the disc,
//! with the pixel); each part contributes the radiance at its centre times its solid angle. The sum of radiance times solid angle
//! over all pixels matches the disc's irradiance to 0.3 %.

use crate::channels::PixelChannels;
use airlight::axes;
use airlight::scene::RadianceView;
use airlight_image::Frame;
use glam::DVec3;
use std::sync::Arc;

/// Largest number of halvings of a pixel.
const DEEPEST: u32 = 48;
/// Smallest height of the visible part of the disc that is drawn, rad.
const LEAST_RAD: f64 = 1e-7;

/// The sun's disc of a view, which can be added to pictures.
#[derive(Clone, Debug)]
pub struct SunDiscImage {
    view: Arc<dyn RadianceView>,
    sun: DVec3,
    radius_rad: f64,
    horizon_rad: f64,
}

/// A part of a pixel, in the picture's coordinates.
#[derive(Clone, Copy)]
struct Cell {
    x: (f64, f64),
    y: (f64, f64),
    halvings: u32,
}

/// Directions on the disc with their solid angles.
#[derive(Default)]
struct Samples {
    directions: Vec<DVec3>,
    solid_angles: Vec<f64>,
}

impl SunDiscImage {
    /// The disc of a view; `None` if the planet hides it.
    pub fn new(view: Arc<dyn RadianceView>) -> Option<Self> {
        let sun = view.sun();
        let radius_rad = view.disc().angular_radius_rad;
        let horizon_rad = view.horizon_elevation_rad();
        (axes::elevation_rad(sun) + radius_rad > horizon_rad + LEAST_RAD).then_some(Self {
            view,
            sun,
            radius_rad,
            horizon_rad,
        })
    }

    /// Adds the disc to a row of pixels with these directions; values are radiance multiplied by `scale`. Corners of a pixel must
    /// lie within `pixel_reach` (rad) of its centre.
    pub fn add_row(
        &self,
        (frame, y): (&Frame, u32),
        directions: &[DVec3],
        (pixel_reach, scale): (f64, f32),
        channels: &PixelChannels,
        out: &mut [f32],
    ) {
        let reach = self.radius_rad + pixel_reach;
        let nearest = if reach < 3.0 { reach.cos() } else { -2.0 };
        for ((i, direction), pixel) in (0..)
            .zip(directions)
            .zip(out.chunks_exact_mut(channels.count()))
        {
            if *direction != DVec3::ZERO && direction.dot(self.sun) >= nearest {
                let solid_angle = frame.pixel_solid_angle(i, y);
                if solid_angle > 0.0 {
                    let mean = self.mean_radiance(frame, (i, y), solid_angle);
                    channels.add(&mean, scale, pixel);
                }
            }
        }
    }

    /// Mean radiance over pixel `(i, j)`, in the channels of the view.
    fn mean_radiance(&self, frame: &Frame, (i, j): (u32, u32), solid_angle: f64) -> Vec<f32> {
        let (x, y) = (f64::from(i), f64::from(j));
        let pixel = Cell {
            x: (x, x + 1.0),
            y: (y, y + 1.0),
            halvings: 0,
        };
        let mut samples = Samples::default();
        self.sample_cell(frame, pixel, &mut samples);
        let count = self.view.channel_count();
        let mut radiance = vec![0.0; count * samples.directions.len()];
        self.view.sun_disc(&samples.directions, &mut radiance);
        let mut sum = vec![0.0f64; count];
        for (values, part) in radiance.chunks_exact(count).zip(&samples.solid_angles) {
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += part * f64::from(*value);
            }
        }
        sum.into_iter()
            .map(|sum| (sum / solid_angle) as f32)
            .collect()
    }

    fn sample_cell(&self, frame: &Frame, cell: Cell, samples: &mut Samples) {
        let middle = (0.5 * (cell.x.0 + cell.x.1), 0.5 * (cell.y.0 + cell.y.1));
        let at = |x, y| frame.direction(x, y);
        let corners = (
            at(cell.x.0, cell.y.0),
            at(cell.x.1, cell.y.0),
            at(cell.x.1, cell.y.1),
            at(cell.x.0, cell.y.1),
        );
        let (Some(centre), (Some(a), Some(b), Some(c), Some(d))) =
            (at(middle.0, middle.1), corners)
        else {
            // Edge of a fisheye: a few halvings determine which parts lie inside.
            if cell.halvings < 10 {
                for half in cell.halves(cell.halvings.is_multiple_of(2)) {
                    self.sample_cell(frame, half, samples);
                }
            }
            return;
        };
        let reach = 1.1
            * [a, b, c, d]
                .into_iter()
                .map(|corner| corner.distance(centre))
                .fold(0.0, f64::max);
        let solid_angle = || 0.5 * (c - a).cross(d - b).length();
        if self.is_done(centre, reach, cell, samples, solid_angle) {
            return;
        }
        let across = a.distance(b) + d.distance(c) + 2.0 * edge_bulge(a, b, at(middle.0, cell.y.0));
        let down = a.distance(d) + b.distance(c) + 2.0 * edge_bulge(a, d, at(cell.x.0, middle.1));
        for half in cell.halves(across >= down) {
            self.sample_cell(frame, half, samples);
        }
    }

    /// Adds a cell to the samples if it is small enough. Returns whether the cell is done: added, or outside the disc.
    fn is_done(
        &self,
        centre: DVec3,
        reach: f64,
        cell: Cell,
        samples: &mut Samples,
        solid_angle: impl Fn() -> f64,
    ) -> bool {
        let whole = cell.halvings >= DEEPEST;
        if reach > 0.4 && !whole {
            return false;
        }
        let from_sun = 2.0 * (0.5 * centre.distance(self.sun)).min(1.0).asin();
        if from_sun > self.radius_rad + reach {
            return true;
        }
        let height = axes::elevation_rad(centre) - self.horizon_rad;
        if height < -reach {
            return true;
        }
        let edge = from_sun > self.radius_rad - reach || height < reach;
        let small = match edge {
            true => reach < self.radius_rad / 80.0 && cell.halvings >= 4,
            false => reach < self.radius_rad / 16.0,
        };
        if !small && !whole {
            return false;
        }
        if from_sun < self.radius_rad && height >= 0.0 {
            samples.directions.push(centre);
            samples.solid_angles.push(solid_angle());
        }
        true
    }
}

impl Cell {
    fn halves(self, across: bool) -> [Self; 2] {
        let halvings = self.halvings + 1;
        let split =
            |(low, high): (f64, f64)| [(low, 0.5 * (low + high)), (0.5 * (low + high), high)];
        match across {
            true => split(self.x).map(|x| Self {
                x,
                halvings,
                ..self
            }),
            false => split(self.y).map(|y| Self {
                y,
                halvings,
                ..self
            }),
        }
    }
}

/// Length of an edge through its midpoint minus the distance of its ends, which coincide for a full circle.
fn edge_bulge(a: DVec3, b: DVec3, middle: Option<DVec3>) -> f64 {
    middle.map_or(0.0, |m| {
        (m.distance(a) + m.distance(b) - a.distance(b)).max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_view::TestView;
    use airlight::Named;
    use airlight::axes;
    use airlight::spectrum::RgbSpace;
    use airlight_image::{Camera, CubeFace, Fisheye, Projection, Size};

    /// Irradiance of the disc in a picture relative to that of the view.
    fn share(view: &TestView, frame: &Frame) -> f64 {
        let disc = SunDiscImage::new(Arc::new(view.clone())).unwrap();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let reach = crate::pixels::pixel_reach(frame);
        let (rows, width) = (frame.rows(), frame.size().width());
        let mut directions = vec![DVec3::ZERO; width as usize];
        let mut sum = 0.0;
        for y in 0..frame.size().height() {
            rows.fill(y, &mut directions);
            let mut row = vec![0.0; 3 * width as usize];
            disc.add_row((frame, y), &directions, (reach, 1.0), &channels, &mut row);
            for (x, pixel) in (0..).zip(row.chunks_exact(3)) {
                sum += f64::from(pixel[1]) * frame.pixel_solid_angle(x, y);
            }
        }
        sum / view.disc_irradiance_above_horizon()
    }

    #[test]
    fn irradiance_is_correct_for_pixels_of_any_size() {
        for ((width, height), elevation_deg, azimuth_deg) in [
            ((2, 1), 30.0, 200.0),
            ((16, 8), 45.0, 90.0),
            ((33, 17), 89.9, 0.0),
            ((256, 128), 90.0, 0.0),
            ((256, 128), 0.05, 12.3),
            ((1024, 512), 7.0, 359.9),
            ((2048, 1024), 0.0, 100.0),
        ] {
            let view = TestView::with_sun(axes::direction(azimuth_deg, elevation_deg));
            let projection = Projection::Equirectangular {
                center_azimuth_deg: 0.0,
            };
            let frame = Frame::new(projection, width, height).unwrap();
            let share = share(&view, &frame);
            assert!(
                (share - 1.0).abs() < 5e-3,
                "{width} x {height} at {elevation_deg} deg: {share}"
            );
        }
    }

    #[test]
    fn irradiance_is_correct_in_all_projections() {
        let size = Size::new(200, 100).unwrap();
        let camera = Camera {
            roll_deg: 20.0,
            ..Camera::with_horizontal_fov(170.0, 15.0, 75.0, size)
        };
        let zoomed = Camera::with_horizontal_fov(180.0, 20.0, 2.0, size);
        let view = TestView::with_sun(axes::direction(180.0, 20.0));
        for frame in [
            Frame::new(Projection::AngularFisheye(Fisheye::ALL_SKY), 64, 64),
            Frame::new(Projection::Perspective(camera), 200, 100),
            Frame::new(Projection::Perspective(zoomed), 200, 100),
        ] {
            let frame = frame.unwrap();
            let share = share(&view, &frame);
            assert!((share - 1.0).abs() < 5e-3, "{frame:?}: {share}");
        }
        let cube: f64 = CubeFace::ALL
            .iter()
            .map(|&face| {
                share(
                    &view,
                    &Frame::new(Projection::CubeFace(face), 16, 16).unwrap(),
                )
            })
            .sum();
        assert!((cube - 1.0).abs() < 5e-3, "{cube}");
    }

    #[test]
    fn a_sun_behind_the_planet_has_no_disc() {
        let at = |deg| SunDiscImage::new(Arc::new(TestView::with_sun(axes::direction(0.0, deg))));
        assert!(at(-0.2).is_some() && at(-0.3).is_none());
    }
}
