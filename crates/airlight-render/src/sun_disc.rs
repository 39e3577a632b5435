//! The sun's disc in a picture: of its true size, with limb darkening, attenuated by the air, hidden below the horizon, and with
//! the correct irradiance for pixels of any size.
//!
//! A pixel is the mean of the disc's radiance over its solid angle. The integral is a sum over cells: a pixel is halved across its
//! longer side until the parts lie outside the disc or are small compared with the disc; each part contributes the radiance at its
//! centre times its solid angle, and a part on an edge (of the disc, or the horizon) the fraction inside. The solid angles of parts
//! add up to that of the pixel, so that the sum of radiance times solid angle over all pixels is the disc's irradiance: to 1e-4 at
//! any size, in any projection and at any place.

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
/// Radius of the disc relative to the reach of the largest cells inside it, and of those on an edge.
const PARTS: f64 = 8.0;
const EDGE_PARTS: f64 = 120.0;
/// Points across a cell on an edge.
const EDGE_POINTS: u32 = 4;

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

    /// Whether the disc may be seen in a row of pixels whose corners lie within `pixel_reach` (rad) of their centres.
    pub fn reaches_row(&self, frame: &Frame, y: u32, pixel_reach: f64) -> bool {
        let sun_rad = axes::elevation_rad(self.sun);
        frame.row_elevation_rad(y).is_none_or(|elevation_rad| {
            (elevation_rad - sun_rad).abs() <= self.radius_rad + pixel_reach
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
        let directions = Directions {
            centre,
            corners: [a, b, c, d],
        };
        match self.place(&directions, cell.halvings) {
            Place::Outside => return,
            Place::Inside => return samples.add_inside(frame, cell),
            Place::Edge => return self.add_edge(frame, cell, &directions, samples),
            Place::TooLarge => {}
        }
        let across = a.distance(b) + d.distance(c) + 2.0 * edge_bulge(a, b, at(middle.0, cell.y.0));
        let down = a.distance(d) + b.distance(c) + 2.0 * edge_bulge(a, d, at(cell.x.0, middle.1));
        for half in cell.halves(across >= down) {
            self.sample_cell(frame, half, samples);
        }
    }

    /// Where a cell lies.
    fn place(&self, cell: &Directions, halvings: u32) -> Place {
        let whole = halvings >= DEEPEST;
        let reach = cell.reach();
        if reach > 0.4 && !whole {
            return Place::TooLarge;
        }
        let inside = -self.beyond(cell.centre).max(self.below(cell.centre));
        if inside < -reach {
            return Place::Outside;
        }
        let (place, largest) = match inside < reach {
            true => (Place::Edge, self.radius_rad / EDGE_PARTS),
            // The radiance falls steeply at the limb.
            false => (Place::Inside, (self.radius_rad / PARTS).min(0.7 * inside)),
        };
        if reach < largest || whole {
            place
        } else {
            Place::TooLarge
        }
    }

    /// Angle of a direction beyond the edge of the disc, rad.
    fn beyond(&self, direction: DVec3) -> f64 {
        angle(direction, self.sun) - self.radius_rad
    }

    /// Angle of a direction below the horizon, rad.
    fn below(&self, direction: DVec3) -> f64 {
        self.horizon_rad - axes::elevation_rad(direction)
    }

    /// Adds the part of a cell inside the disc and above the horizon: the exact fraction of its solid angle, with the mean radiance of
    /// evenly spaced points inside.
    fn add_edge(&self, frame: &Frame, cell: Cell, around: &Directions, samples: &mut Samples) {
        let beyond = Signed::of(around, |direction| self.beyond(direction));
        let below = Signed::of(around, |direction| self.below(direction));
        let share = beyond.share_below_0() * below.share_below_0();
        if share <= 0.0 {
            return;
        }
        let first = samples.directions.len();
        let at = |(low, high): (f64, f64), k: u32| {
            low + (high - low) * (f64::from(k) + 0.5) / f64::from(EDGE_POINTS)
        };
        for k in 0..EDGE_POINTS * EDGE_POINTS {
            let (x, y) = (at(cell.x, k % EDGE_POINTS), at(cell.y, k / EDGE_POINTS));
            let direction = frame.direction(x, y);
            let inside = |d: &DVec3| self.beyond(*d) < 0.0 && self.below(*d) < 0.0;
            samples.directions.extend(direction.filter(inside));
        }
        if samples.directions.len() == first {
            let inside = towards(around.centre, self.sun, beyond.to_inside());
            let inside = towards(inside, DVec3::Y, below.to_inside());
            samples.directions.push(inside);
        }
        let count = samples.directions.len() - first;
        let each = share * frame.solid_angle(cell.x, cell.y) / count as f64;
        samples.solid_angles.resize(samples.directions.len(), each);
    }
}

/// Where a cell lies.
enum Place {
    /// Outside the disc, or below the horizon.
    Outside,
    /// Inside, and small enough for a sample.
    Inside,
    /// On an edge, and small enough for a sample.
    Edge,
    /// Possibly inside, but to be halved first.
    TooLarge,
}

impl Samples {
    /// Adds a cell inside the disc: four points of Gauss-Legendre quadrature, weighted by the solid angle around each, which varies
    /// strongly near the zenith of a panorama. The weights add up to the cell's solid angle.
    fn add_inside(&mut self, frame: &Frame, cell: Cell) {
        let points = |(low, high): (f64, f64)| {
            let (middle, offset) = (0.5 * (low + high), (high - low) / 12f64.sqrt());
            [middle - offset, middle + offset]
        };
        let around = |at: f64, (low, high): (f64, f64)| {
            let half = 0.01 * (high - low);
            (at - half, at + half)
        };
        let first = self.solid_angles.len();
        for x in points(cell.x) {
            for y in points(cell.y) {
                if let Some(direction) = frame.direction(x, y) {
                    self.directions.push(direction);
                    self.solid_angles
                        .push(frame.solid_angle(around(x, cell.x), around(y, cell.y)));
                }
            }
        }
        let added = &mut self.solid_angles[first..];
        let factor = frame.solid_angle(cell.x, cell.y) / added.iter().sum::<f64>();
        added.iter_mut().for_each(|weight| *weight *= factor);
    }
}

/// Directions of the centre and the corners of a cell, the corners in their order around it.
struct Directions {
    centre: DVec3,
    corners: [DVec3; 4],
}

impl Directions {
    /// Upper bound of the angle from the centre to any point of the cell, rad, for cells that are small.
    fn reach(&self) -> f64 {
        let far = |most: f64, corner: &DVec3| most.max(corner.distance(self.centre));
        1.1 * self.corners.iter().fold(0.0, far)
    }
}

/// A function over a cell, the unit square around (0, 0), approximated by its mean and its gradient. It is negative inside a shape.
struct Signed {
    mean: f64,
    /// Absolute differences across the cell in the two directions, the larger one first.
    gradient: [f64; 2],
    centre: f64,
    least: f64,
}

impl Signed {
    fn of(cell: &Directions, value: impl Fn(DVec3) -> f64) -> Self {
        let [a, b, c, d] = cell.corners.map(&value);
        let centre = value(cell.centre);
        let (across, down) = (0.5 * (b + c - a - d).abs(), 0.5 * (c + d - a - b).abs());
        Self {
            // Exact for quadratic functions.
            mean: (0.25 * (a + b + c + d) + 2.0 * centre) / 3.0,
            gradient: [across.max(down), across.min(down)],
            centre,
            least: [a, b, c, d].into_iter().fold(centre, f64::min),
        }
    }

    /// Fraction of the cell in which the function is negative.
    fn share_below_0(&self) -> f64 {
        let [large, small] = self.gradient;
        let t = self.mean.abs();
        let tail = if t >= 0.5 * (large + small) {
            0.0
        } else if t <= 0.5 * (large - small) {
            0.5 - t / large
        } else {
            (0.5 * (large + small) - t).powi(2) / (2.0 * large * small)
        };
        if self.mean < 0.0 { 1.0 - tail } else { tail }
    }

    /// Distance from the centre of the cell to the middle of the negative part; 0 if the centre lies deeper.
    fn to_inside(&self) -> f64 {
        (self.centre - 0.5 * self.least.min(0.0)).max(0.0)
    }
}

/// Angle between unit vectors, rad, also accurate where it is small.
fn angle(a: DVec3, b: DVec3) -> f64 {
    2.0 * (0.5 * a.distance(b)).min(1.0).asin()
}

/// A unit vector moved by a small angle towards another.
fn towards(direction: DVec3, target: DVec3, angle_rad: f64) -> DVec3 {
    if angle_rad == 0.0 {
        return direction;
    }
    let tangent = (target - direction * direction.dot(target)).normalize_or_zero();
    (direction + tangent * angle_rad).normalize()
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

    /// Suns at the zenith, beside it, in the middle of the sky, on the seam of a panorama, on edges and corners of cube faces, and
    /// at the horizon.
    const SUNS: [(f64, f64); 10] = [
        (0.0, 90.0),
        (77.0, 89.9),
        (30.0, 89.5),
        (200.0, 30.0),
        (180.0, 7.0),
        (45.0, 20.0),
        (45.0, 35.264_389_7),
        (270.0, 45.0),
        (12.3, 0.05),
        (100.0, 0.0),
    ];

    fn assert_whole(frames: &[Frame], sun: (f64, f64)) {
        let view = TestView::with_sun(axes::direction(sun.0, sun.1));
        for view in [view.clone().with_limb_darkening(), view] {
            let sum: f64 = frames.iter().map(|frame| share(&view, frame)).sum();
            assert!(
                (sum - 1.0).abs() < 1e-4,
                "{:?} of {:?}, sun at {sun:?}: {sum}",
                frames[0].projection(),
                frames[0].size()
            );
        }
    }

    #[test]
    fn panoramas_of_any_size_have_the_irradiance_of_the_disc() {
        for sun in SUNS {
            for (width, height) in [(1, 1), (2, 1), (7, 3), (16, 8), (64, 32), (512, 256)] {
                for center_azimuth_deg in [0.0, 90.0] {
                    let projection = Projection::Equirectangular { center_azimuth_deg };
                    assert_whole(&[Frame::new(projection, width, height).unwrap()], sun);
                }
            }
        }
    }

    #[test]
    fn large_panoramas_have_the_irradiance_of_the_disc() {
        let projection = Projection::Equirectangular {
            center_azimuth_deg: 0.0,
        };
        for sun in [SUNS[0], SUNS[4], SUNS[9]] {
            assert_whole(&[Frame::new(projection, 4096, 2048).unwrap()], sun);
        }
    }

    #[test]
    fn cubes_and_fisheyes_have_the_irradiance_of_the_disc() {
        let sphere = Fisheye {
            azimuth_deg: 33.0,
            elevation_deg: -20.0,
            field_of_view_deg: 360.0,
        };
        for sun in SUNS {
            for side in [1, 2, 9, 64, 256] {
                let faces = CubeFace::ALL.iter();
                let faces: Vec<Frame> = faces
                    .map(|&face| Frame::new(Projection::CubeFace(face), side, side).unwrap())
                    .collect();
                assert_whole(&faces, sun);
            }
            for side in [64, 301] {
                let frame = Frame::new(Projection::AngularFisheye(sphere), side, side).unwrap();
                assert_whole(&[frame], sun);
            }
        }
    }

    #[test]
    fn cameras_have_the_irradiance_of_the_disc() {
        for (width, height, fov_deg) in [(3, 2, 75.0), (200, 100, 75.0), (200, 100, 2.0)] {
            let size = Size::new(width, height).unwrap();
            for sun in SUNS {
                let camera = Camera {
                    roll_deg: 20.0,
                    ..Camera::with_horizontal_fov(
                        sun.0 + 0.1,
                        (sun.1 - 0.1).max(0.1),
                        fov_deg,
                        size,
                    )
                };
                let frame = Frame::new(Projection::Perspective(camera), width, height).unwrap();
                assert_whole(&[frame], sun);
            }
        }
    }

    #[test]
    fn the_share_of_a_square_beside_a_line_is_exact() {
        let signed = |mean, gradient| Signed {
            mean,
            gradient,
            centre: mean,
            least: mean,
        };
        for (mean, gradient, share) in [
            (0.0, [1.0, 0.3], 0.5),
            (0.25, [1.0, 0.0], 0.25),
            (-0.25, [1.0, 0.0], 0.75),
            // A corner: legs of 0.5 in units of the side.
            (0.75, [1.0, 1.0], 0.5 * 0.25 * 0.25),
            (2.0, [1.0, 1.0], 0.0),
            (-2.0, [0.0, 0.0], 1.0),
        ] {
            let got = signed(mean, gradient).share_below_0();
            assert!((got - share).abs() < 1e-12, "{mean} {gradient:?}: {got}");
        }
    }

    #[test]
    fn a_sun_behind_the_planet_has_no_disc() {
        let at = |deg| SunDiscImage::new(Arc::new(TestView::with_sun(axes::direction(0.0, deg))));
        assert!(at(-0.2).is_some() && at(-0.3).is_none());
    }
}
