//! The sun's disc in a picture: true in size, darkened to the limb, dimmed and cut off by air and horizon, and exact
//! in irradiance at every size of pixel.
//!
//! A pixel gets the mean of the disc's radiance over its solid angle. The integral is taken over cells: a pixel is
//! halved across its longer side until its parts lie outside the disc, or are small against the disc (and, where an edge
//! of the disc runs through, against the pixel), and each part counts with the radiance at its middle and its own solid
//! angle. The sum of radiance times solid angle over all pixels is then the disc's irradiance to 0.3 %.

use super::channels::RgbWeights;
use crate::models;
use airlight::models::PublishedModel;
use airlight::sky::View;
use airlight::spectrum::rgb;
use airlight_image::Frame;
use glam::DVec3;
use std::sync::Arc;

/// Elevations and cosines on the sun at which the disc's radiance is tabulated.
const ELEVATIONS: usize = 129;
const COSINES: usize = 65;
/// Most halvings of a pixel.
const DEEPEST: u32 = 48;

/// The disc of the sun.
pub struct Disc {
    sun: DVec3,
    radius_rad: f64,
    channels: usize,
    horizon_rad: f64,
    radiance: Radiance,
}

/// The disc's radiance.
enum Radiance {
    /// By elevation and by distance from its centre.
    Table(Table),
    /// As a published model has it; with what makes RGB of XYZ.
    Classic(Arc<dyn PublishedModel>, [[f64; 3]; 3]),
}

struct Table {
    /// Lowest and highest elevation, rad.
    range: (f64, f64),
    channels: usize,
    /// `[elevation][cosine][channel]`.
    values: Vec<f32>,
}

/// A part of a pixel, in the picture's coordinates.
#[derive(Clone, Copy)]
struct Cell {
    x: (f64, f64),
    y: (f64, f64),
    halvings: u32,
}

impl Disc {
    /// Tabulates the disc of a view; `horizon_rad` is the elevation of the horizon. `None` where the planet hides all
    /// of it. `fog` is the transmittance of what lies before it besides the air. With `weights` the channels are RGB, or
    /// RGB and then radiances where `spectral`.
    pub fn new(
        view: &View,
        horizon_rad: f64,
        weights: &RgbWeights,
        spectral: bool,
        fog: impl Fn(DVec3) -> f32,
    ) -> Option<Self> {
        let sun = view.sun();
        let radius_rad = view.disc().angular_radius_rad;
        let centre = elevation(sun);
        let lowest = (centre - radius_rad).max(horizon_rad + 1e-7);
        let highest = centre + radius_rad;
        if lowest >= highest {
            return None;
        }
        let channels = 3 + if spectral { weights.len() } else { 0 };
        let table = Table::new(view, (lowest, highest), weights, spectral, fog);
        Some(Self {
            sun,
            radius_rad,
            channels,
            horizon_rad,
            radiance: Radiance::Table(table),
        })
    }

    /// The disc of a published model, in RGB and, where `spectral`, radiances at its wavelengths; `None` where it lies below
    /// the horizontal.
    pub fn of_classic(
        model: Arc<dyn PublishedModel>,
        rgb_from_xyz: [[f64; 3]; 3],
        spectral: bool,
    ) -> Option<Self> {
        let (sun, radius_rad) = (model.sun(), model.disc_edge_rad());
        let lanes = if spectral {
            model.wavelengths_nm().len()
        } else {
            0
        };
        (elevation(sun) + radius_rad > 0.0).then(|| Self {
            sun,
            radius_rad,
            channels: 3 + lanes,
            horizon_rad: 0.0,
            radiance: Radiance::Classic(model, rgb_from_xyz),
        })
    }

    /// Adds the disc to a row of pixels that look along `directions`; values are `scale` times the radiance. A pixel's
    /// corners lie no further than `pixel_reach` (rad) from its middle.
    pub fn add_row(
        &self,
        (frame, y): (&Frame, u32),
        directions: &[DVec3],
        (pixel_reach, scale): (f64, f32),
        out: &mut [f32],
    ) {
        let reach = self.radius_rad + pixel_reach;
        let nearest = if reach < 3.0 { reach.cos() } else { -2.0 };
        for ((i, direction), pixel) in (0..)
            .zip(directions)
            .zip(out.chunks_exact_mut(self.channels))
        {
            if *direction != DVec3::ZERO && direction.dot(self.sun) >= nearest {
                self.add_pixel(frame, (i, y), scale, pixel);
            }
        }
    }

    /// Adds the mean radiance over pixel `(i, j)` to `out`, `factor` times.
    fn add_pixel(&self, frame: &Frame, (i, j): (u32, u32), factor: f32, out: &mut [f32]) {
        let solid_angle = frame.pixel_solid_angle(i, j);
        if solid_angle <= 0.0 {
            return;
        }
        let (x, y) = (f64::from(i), f64::from(j));
        let mut sum = vec![0.0f64; self.channels];
        self.add_cell(
            frame,
            Cell {
                x: (x, x + 1.0),
                y: (y, y + 1.0),
                halvings: 0,
            },
            &mut sum,
        );
        for (out, sum) in out.iter_mut().zip(sum) {
            *out += factor * (sum / solid_angle) as f32;
        }
    }

    fn add_cell(&self, frame: &Frame, cell: Cell, sum: &mut [f64]) {
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
            // The rim of a fisheye: a few halvings show what lies inside.
            if cell.halvings < 10 {
                for half in cell.halves(cell.halvings.is_multiple_of(2)) {
                    self.add_cell(frame, half, sum);
                }
            }
            return;
        };
        let reach = 1.1
            * [a, b, c, d]
                .into_iter()
                .map(|corner| corner.distance(centre))
                .fold(0.0, f64::max);
        if self.is_done(centre, reach, cell, sum, || {
            0.5 * (c - a).cross(d - b).length()
        }) {
            return;
        }
        let across =
            a.distance(b) + d.distance(c) + 2.0 * centre_bulge(a, b, at(middle.0, cell.y.0));
        let down = a.distance(d) + b.distance(c) + 2.0 * centre_bulge(a, d, at(cell.x.0, middle.1));
        for half in cell.halves(across >= down) {
            self.add_cell(frame, half, sum);
        }
    }

    /// Counts a cell if it is small enough, or misses the disc.
    fn is_done(
        &self,
        centre: DVec3,
        reach: f64,
        cell: Cell,
        sum: &mut [f64],
        area: impl Fn() -> f64,
    ) -> bool {
        let whole = cell.halvings >= DEEPEST;
        if reach > 0.4 && !whole {
            return false;
        }
        let from_sun = 2.0 * (0.5 * centre.distance(self.sun)).min(1.0).asin();
        if from_sun > self.radius_rad + reach {
            return true;
        }
        let height = elevation(centre) - self.horizon_rad;
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
        self.add(centre, from_sun, area(), sum);
        true
    }

    /// Adds the radiance in a direction, `area` times.
    fn add(&self, direction: DVec3, from_sun: f64, area: f64, sum: &mut [f64]) {
        let elevation = elevation(direction);
        let s = from_sun.sin() / self.radius_rad.sin();
        if s >= 1.0 || elevation < self.horizon_rad {
            return;
        }
        match &self.radiance {
            Radiance::Table(table) => {
                let mu = ((1.0 - s) * (1.0 + s)).sqrt();
                table.add(elevation, mu, area, sum);
            }
            Radiance::Classic(model, rgb_from_xyz) => {
                let light = models::disc(model.as_ref(), direction);
                let rgb = rgb::apply(rgb_from_xyz, light.xyz);
                // A picture without spectrum has channels for the first three only.
                let values = rgb.into_iter().chain(light.spectrum);
                sum.iter_mut()
                    .zip(values)
                    .for_each(|(sum, v)| *sum += area * v);
            }
        }
    }
}

impl Table {
    fn new(
        view: &View,
        range: (f64, f64),
        weights: &RgbWeights,
        spectral: bool,
        fog: impl Fn(DVec3) -> f32,
    ) -> Self {
        let sun = view.sun();
        let channels = 3 + if spectral { weights.len() } else { 0 };
        let mut values = Vec::new();
        let irradiance = view.solar_irradiance();
        let wavelengths = view.sky().grid().wavelengths_nm();
        let azimuth = airlight::axes::azimuth_deg(sun);
        // Radiance per irradiance at each cosine, wavelength by wavelength.
        let shape: Vec<Vec<f64>> = (0..COSINES)
            .map(|m| {
                let mu = m as f64 / (COSINES - 1) as f64;
                // A hair's breadth inside the limb, beyond which there is nothing.
                let angle =
                    (view.disc().angular_radius_rad.sin() * (1.0 - mu * mu).sqrt() * (1.0 - 1e-12))
                        .asin();
                wavelengths
                    .iter()
                    .map(|&nm| view.disc().radiance_per_irradiance(angle, nm))
                    .collect()
            })
            .collect();
        values.reserve(ELEVATIONS * COSINES * channels);
        for k in 0..ELEVATIONS {
            let part = k as f64 / (ELEVATIONS - 1) as f64;
            let elevation = range.0 + (range.1 - range.0) * part;
            let direction = airlight::axes::direction(azimuth, elevation.to_degrees());
            let transmittance = view.transmittance_to_space(direction);
            let fog = fog(direction);
            for row in &shape {
                let arriving = |lane: usize| {
                    (f64::from(irradiance[lane] * transmittance[lane] * fog) * row[lane]) as f32
                };
                let mut sum = [0.0f32; 3];
                for (lane, weight) in weights.iter().enumerate() {
                    for (sum, w) in sum.iter_mut().zip(weight) {
                        *sum += w * arriving(lane);
                    }
                }
                values.extend(sum);
                if spectral {
                    values.extend((0..weights.len()).map(arriving));
                }
            }
        }
        Self {
            range,
            channels,
            values,
        }
    }

    /// Adds the radiance at an elevation and a cosine on the sun, `area` times.
    fn add(&self, elevation: f64, mu: f64, area: f64, sum: &mut [f64]) {
        let (k, u) = place(
            (elevation - self.range.0) / (self.range.1 - self.range.0),
            ELEVATIONS,
        );
        let (m, v) = place(mu, COSINES);
        for (dk, wk) in [(0, 1.0 - u), (1, u)] {
            for (dm, wm) in [(0, 1.0 - v), (1, v)] {
                let start = ((k + dk) * COSINES + m + dm) * self.channels;
                for (sum, value) in sum
                    .iter_mut()
                    .zip(&self.values[start..start + self.channels])
                {
                    *sum += wk * wm * area * f64::from(*value);
                }
            }
        }
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

/// How far the middle of an edge lies from both its ends: a whole circle's ends are one point.
fn centre_bulge(a: DVec3, b: DVec3, middle: Option<DVec3>) -> f64 {
    middle.map_or(0.0, |m| {
        (m.distance(a) + m.distance(b) - a.distance(b)).max(0.0)
    })
}

/// The node below `x` in `[0, 1]` among `count`, and how far beyond it.
fn place(x: f64, count: usize) -> (usize, f64) {
    let position = x.clamp(0.0, 1.0) * (count - 1) as f64;
    let below = (position as usize).min(count - 2);
    (below, position - below as f64)
}

fn elevation(direction: DVec3) -> f64 {
    direction.y.atan2(direction.x.hypot(direction.z))
}
