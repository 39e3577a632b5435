//! The mathematics of each projection, with everything that does not depend on the pixel worked out beforehand.

use super::projection::{CubeFace, Projection};
use super::solid_angle;
use crate::Size;
use airlight::axes;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// How far beyond a fisheye's circle rounding may put a direction on it, relatively.
const RIM: f64 = 1e-12;

/// A projection made ready for one picture size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lens {
    Equirectangular {
        center_azimuth: f64,
        size: (f64, f64),
    },
    Cube {
        face: CubeFace,
        side: f64,
    },
    Fisheye {
        view: View,
        center: (f64, f64),
        radians_per_pixel: f64,
        half_angle: f64,
    },
    Perspective {
        view: View,
        size: (f64, f64),
        /// Tangents of half the angle across and down.
        tangents: (f64, f64),
    },
}

/// Right, up and forward of a camera: unit vectors, each square to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
}

impl View {
    pub(super) fn new(azimuth_deg: f64, elevation_deg: f64, roll_deg: f64) -> Self {
        let forward = axes::direction(azimuth_deg, elevation_deg);
        let level = axes::direction(azimuth_deg + 90.0, 0.0);
        let upright = level.cross(forward);
        let (sin, cos) = roll_deg.to_radians().sin_cos();
        Self {
            right: level * cos - upright * sin,
            up: upright * cos + level * sin,
            forward,
        }
    }

    /// Components of a direction to the right, up and forward.
    fn split(&self, direction: DVec3) -> (f64, f64, f64) {
        (
            direction.dot(self.right),
            direction.dot(self.up),
            direction.dot(self.forward),
        )
    }
}

/// The direction whose azimuth and elevation have these sines and cosines.
pub(super) fn from_sines(azimuth: (f64, f64), elevation: (f64, f64)) -> DVec3 {
    DVec3::new(
        elevation.1 * azimuth.0,
        elevation.0,
        -elevation.1 * azimuth.1,
    )
}

impl Lens {
    pub(super) fn new(projection: &Projection, size: Size) -> Self {
        let (width, height) = (f64::from(size.width()), f64::from(size.height()));
        match projection {
            Projection::Equirectangular { center_azimuth_deg } => Self::Equirectangular {
                center_azimuth: center_azimuth_deg.rem_euclid(360.0).to_radians(),
                size: (width, height),
            },
            Projection::CubeFace(face) => Self::Cube {
                face: *face,
                side: width,
            },
            Projection::AngularFisheye(fisheye) => {
                let half_angle = fisheye.field_of_view_deg.to_radians() / 2.0;
                Self::Fisheye {
                    view: View::new(fisheye.azimuth_deg, fisheye.elevation_deg, 0.0),
                    center: (width / 2.0, height / 2.0),
                    radians_per_pixel: half_angle / (width.min(height) / 2.0),
                    half_angle,
                }
            }
            Projection::Perspective(camera) => {
                let down = (camera.vertical_fov_deg.to_radians() / 2.0).tan();
                Self::Perspective {
                    view: View::new(camera.azimuth_deg, camera.elevation_deg, camera.roll_deg),
                    size: (width, height),
                    tangents: (down * width / height, down),
                }
            }
        }
    }

    pub(super) fn direction(&self, px: f64, py: f64) -> Option<DVec3> {
        match self {
            Self::Equirectangular { .. } => Some(from_sines(
                self.azimuth(px).sin_cos(),
                self.elevation(py).sin_cos(),
            )),
            Self::Cube { face, side } => {
                let (s, t) = (2.0 * px / side - 1.0, 2.0 * py / side - 1.0);
                Some(from_face(*face, s, t).normalize())
            }
            Self::Fisheye {
                view,
                center,
                radians_per_pixel,
                half_angle,
            } => {
                let (x, y) = (px - center.0, center.1 - py);
                let radius = x.hypot(y);
                let theta = radius * radians_per_pixel;
                if theta > half_angle * (1.0 + RIM) {
                    return None;
                }
                if radius == 0.0 {
                    return Some(view.forward);
                }
                let (sin, cos) = theta.sin_cos();
                let sideways = (view.right * x + view.up * y) / radius;
                Some(view.forward * cos + sideways * sin)
            }
            Self::Perspective {
                view,
                size,
                tangents,
            } => {
                let x = (2.0 * px / size.0 - 1.0) * tangents.0;
                let y = (1.0 - 2.0 * py / size.1) * tangents.1;
                Some((view.forward + view.right * x + view.up * y).normalize())
            }
        }
    }

    pub(super) fn pixel_of(&self, direction: DVec3) -> Option<(f64, f64)> {
        match self {
            Self::Equirectangular {
                center_azimuth,
                size,
            } => {
                let turn = (direction.x.atan2(-direction.z) - center_azimuth) / TAU + 0.5;
                let elevation = direction.y.atan2(direction.x.hypot(direction.z));
                Some((
                    turn.rem_euclid(1.0) * size.0,
                    (0.5 - elevation / PI) * size.1,
                ))
            }
            Self::Cube { face, side } => {
                let (s, t) = on_face(*face, direction)?;
                Some(((s + 1.0) / 2.0 * side, (t + 1.0) / 2.0 * side))
            }
            Self::Fisheye {
                view,
                center,
                radians_per_pixel,
                half_angle,
            } => {
                let (x, y, z) = view.split(direction);
                let sideways = x.hypot(y);
                let theta = sideways.atan2(z);
                if theta > half_angle * (1.0 + RIM) {
                    return None;
                }
                let radius = theta / radians_per_pixel;
                let (x, y) = if sideways > 0.0 {
                    (x / sideways, y / sideways)
                } else {
                    // Straight ahead the radius is 0; straight behind, any point of the circle will do.
                    (1.0, 0.0)
                };
                Some((center.0 + x * radius, center.1 - y * radius))
            }
            Self::Perspective {
                view,
                size,
                tangents,
            } => {
                let (x, y, z) = view.split(direction);
                (z > 0.0).then(|| {
                    (
                        (x / z / tangents.0 + 1.0) / 2.0 * size.0,
                        (1.0 - y / z / tangents.1) / 2.0 * size.1,
                    )
                })
            }
        }
    }

    pub(super) fn solid_angle(&self, i: u32, j: u32) -> f64 {
        let (i, j) = (f64::from(i), f64::from(j));
        match self {
            Self::Equirectangular { size, .. } => {
                solid_angle::band(self.elevation(j + 1.0), self.elevation(j)) / size.0
            }
            Self::Cube { side, .. } => {
                let at = |n: f64| 2.0 * n / side - 1.0;
                solid_angle::rectangle((at(i), at(i + 1.0)), (at(j), at(j + 1.0)))
            }
            Self::Perspective { size, tangents, .. } => {
                let x = |n: f64| (2.0 * n / size.0 - 1.0) * tangents.0;
                let y = |n: f64| (2.0 * n / size.1 - 1.0) * tangents.1;
                solid_angle::rectangle((x(i), x(i + 1.0)), (y(j), y(j + 1.0)))
            }
            Self::Fisheye {
                center,
                radians_per_pixel,
                half_angle,
                ..
            } => solid_angle::equidistant_pixel(
                (i - center.0, j - center.1),
                *radians_per_pixel,
                *half_angle,
            ),
        }
    }

    /// Sine and cosine of the azimuth at the centre of each column, where azimuth depends on the column alone.
    pub(super) fn columns(&self, width: u32) -> Vec<(f64, f64)> {
        match self {
            Self::Equirectangular { .. } => (0..width)
                .map(|i| self.azimuth(f64::from(i) + 0.5).sin_cos())
                .collect(),
            _ => Vec::new(),
        }
    }

    /// Azimuth in radians at a column of an equirectangular picture; 0 for others.
    fn azimuth(&self, px: f64) -> f64 {
        match self {
            Self::Equirectangular {
                center_azimuth,
                size,
            } => center_azimuth + (px / size.0 - 0.5) * TAU,
            _ => 0.0,
        }
    }

    /// Elevation in radians at a row of an equirectangular picture; 0 for others.
    pub(super) fn elevation(&self, py: f64) -> f64 {
        match self {
            Self::Equirectangular { size, .. } => (0.5 - py / size.1) * PI,
            _ => 0.0,
        }
    }
}

fn from_face(face: CubeFace, s: f64, t: f64) -> DVec3 {
    match face {
        CubeFace::PositiveX => DVec3::new(1.0, -t, -s),
        CubeFace::NegativeX => DVec3::new(-1.0, -t, s),
        CubeFace::PositiveY => DVec3::new(s, 1.0, t),
        CubeFace::NegativeY => DVec3::new(s, -1.0, -t),
        CubeFace::PositiveZ => DVec3::new(s, -t, 1.0),
        CubeFace::NegativeZ => DVec3::new(-s, -t, -1.0),
    }
}

/// The inverse of [`from_face`]; `None` for a direction that leaves the cube through the far half.
fn on_face(face: CubeFace, d: DVec3) -> Option<(f64, f64)> {
    let (s, t, depth) = match face {
        CubeFace::PositiveX => (-d.z, -d.y, d.x),
        CubeFace::NegativeX => (d.z, -d.y, -d.x),
        CubeFace::PositiveY => (d.x, d.z, d.y),
        CubeFace::NegativeY => (d.x, -d.z, -d.y),
        CubeFace::PositiveZ => (d.x, -d.y, d.z),
        CubeFace::NegativeZ => (-d.x, -d.y, -d.z),
    };
    (depth > 0.0).then(|| (s / depth, t / depth))
}
