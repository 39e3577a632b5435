//! Projections prepared for one picture size: from pixels to directions and back, and solid angles of pixels.

use super::axes::CameraAxes;
use super::projection::{CubeFace, Projection};
use crate::Size;
use airlight::axes as world;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Relative tolerance for rounding at the circle of a fisheye.
const RIM: f64 = 1e-12;

/// A projection with the quantities that do not depend on the pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lens {
    Equirectangular {
        center_azimuth: f64,
        size: (f64, f64),
    },
    Cube {
        face: CubeFace,
        side: f64,
        /// Factor on the x component of directions: -1 for mirrored faces.
        x_factor: f64,
    },
    Fisheye {
        axes: CameraAxes,
        center: (f64, f64),
        radians_per_pixel: f64,
        half_angle: f64,
    },
    Perspective {
        axes: CameraAxes,
        size: (f64, f64),
        /// Tangents of half the horizontal and the vertical angle of axes.
        tangents: (f64, f64),
    },
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
                x_factor: 1.0,
            },
            Projection::MirroredCubeFace(face) => Self::Cube {
                face: *face,
                side: width,
                x_factor: -1.0,
            },
            Projection::AngularFisheye(fisheye) => {
                let half_angle = fisheye.field_of_view_deg.to_radians() / 2.0;
                Self::Fisheye {
                    axes: CameraAxes::new(fisheye.azimuth_deg, fisheye.elevation_deg, 0.0),
                    center: (width / 2.0, height / 2.0),
                    radians_per_pixel: half_angle / (width.min(height) / 2.0),
                    half_angle,
                }
            }
            Projection::Perspective(camera) => {
                let down = (camera.vertical_fov_deg.to_radians() / 2.0).tan();
                Self::Perspective {
                    axes: CameraAxes::new(
                        camera.azimuth_deg,
                        camera.elevation_deg,
                        camera.roll_deg,
                    ),
                    size: (width, height),
                    tangents: (down * width / height, down),
                }
            }
        }
    }

    pub(super) fn direction(&self, px: f64, py: f64) -> Option<DVec3> {
        match self {
            Self::Equirectangular { .. } => Some(world::from_sines(
                self.azimuth(px).sin_cos(),
                self.elevation(py).sin_cos(),
            )),
            Self::Cube {
                face,
                side,
                x_factor,
            } => {
                let (s, t) = (2.0 * px / side - 1.0, 2.0 * py / side - 1.0);
                let mut direction = from_face(*face, s, t).normalize();
                direction.x *= x_factor;
                Some(direction)
            }
            Self::Fisheye {
                axes,
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
                    return Some(axes.forward);
                }
                let (sin, cos) = theta.sin_cos();
                let sideways = (axes.right * x + axes.up * y) / radius;
                Some(axes.forward * cos + sideways * sin)
            }
            Self::Perspective {
                axes,
                size,
                tangents,
            } => {
                let x = (2.0 * px / size.0 - 1.0) * tangents.0;
                let y = (1.0 - 2.0 * py / size.1) * tangents.1;
                Some((axes.forward + axes.right * x + axes.up * y).normalize())
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
                let elevation = world::elevation_rad(direction);
                Some((
                    turn.rem_euclid(1.0) * size.0,
                    (0.5 - elevation / PI) * size.1,
                ))
            }
            Self::Cube {
                face,
                side,
                x_factor,
            } => {
                let direction = DVec3::new(direction.x * x_factor, direction.y, direction.z);
                let (s, t) = on_face(*face, direction)?;
                Some(((s + 1.0) / 2.0 * side, (t + 1.0) / 2.0 * side))
            }
            Self::Fisheye {
                axes,
                center,
                radians_per_pixel,
                half_angle,
            } => {
                let (x, y, z) = axes.split(direction);
                let sideways = x.hypot(y);
                let theta = sideways.atan2(z);
                if theta > half_angle * (1.0 + RIM) {
                    return None;
                }
                let radius = theta / radians_per_pixel;
                let (x, y) = if sideways > 0.0 {
                    (x / sideways, y / sideways)
                } else {
                    // Ahead, the radius is 0; behind, any point of the circle is valid.
                    (1.0, 0.0)
                };
                Some((center.0 + x * radius, center.1 - y * radius))
            }
            Self::Perspective {
                axes,
                size,
                tangents,
            } => {
                let (x, y, z) = axes.split(direction);
                (z > 0.0).then(|| {
                    (
                        (x / z / tangents.0 + 1.0) / 2.0 * size.0,
                        (1.0 - y / z / tangents.1) / 2.0 * size.1,
                    )
                })
            }
        }
    }

    /// Solid angle of the rectangle between two columns and two rows.
    pub(super) fn solid_angle(&self, x: (f64, f64), y: (f64, f64)) -> f64 {
        match self {
            Self::Equirectangular { size, .. } => {
                let turn = (x.1 - x.0) / size.0;
                turn * band_solid_angle(self.elevation(y.1), self.elevation(y.0))
            }
            Self::Cube { side, .. } => {
                let at = |n: f64| 2.0 * n / side - 1.0;
                rectangle_solid_angle((at(x.0), at(x.1)), (at(y.0), at(y.1)))
            }
            Self::Perspective { size, tangents, .. } => {
                let across = |n: f64| (2.0 * n / size.0 - 1.0) * tangents.0;
                let down = |n: f64| (2.0 * n / size.1 - 1.0) * tangents.1;
                rectangle_solid_angle((across(x.0), across(x.1)), (down(y.0), down(y.1)))
            }
            Self::Fisheye {
                center,
                radians_per_pixel,
                half_angle,
                ..
            } => {
                let across = |n: f64| (n - center.0) * radians_per_pixel;
                let down = |n: f64| (n - center.1) * radians_per_pixel;
                fisheye_solid_angle(
                    (across(x.0), across(x.1)),
                    (down(y.0), down(y.1)),
                    *half_angle,
                )
            }
        }
    }

    /// Sine and cosine of the azimuth at the centre of each column, where azimuth depends only on the column.
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

/// Solid angle of the band of the sphere between two elevations (rad).
fn band_solid_angle(bottom: f64, top: f64) -> f64 {
    // sin(top) - sin(bottom), without cancellation.
    TAU * 2.0 * ((top + bottom) / 2.0).cos() * ((top - bottom) / 2.0).sin()
}

/// Solid angle of a rectangle in the plane at distance 1, given by its edges.
fn rectangle_solid_angle(x: (f64, f64), y: (f64, f64)) -> f64 {
    /// Longest side up to which quadrature is exact to rounding, where the closed form cancels.
    const SMALL: f64 = 0.01;
    if x.1 - x.0 <= SMALL && y.1 - y.0 <= SMALL {
        return over_rectangle(x, y, |x, y| {
            let squared = 1.0 + x * x + y * y;
            1.0 / (squared * squared.sqrt())
        });
    }
    // The rectangle from the axis to the corner (x, y) has the solid angle atan(x y / sqrt(1 + x^2 + y^2)).
    let corner = |x: f64, y: f64| (x * y).atan2((1.0 + x * x + y * y).sqrt());
    corner(x.1, y.1) - corner(x.0, y.1) - corner(x.1, y.0) + corner(x.0, y.0)
}

/// Solid angle of a rectangle of an equidistant fisheye, given by its edges (rad from the axis): the integral of
/// `sin(theta) / theta` inside the circle.
fn fisheye_solid_angle(x: (f64, f64), y: (f64, f64), half_angle: f64) -> f64 {
    over_rectangle(x, y, |x, y| match x.hypot(y) {
        theta if theta > half_angle => 0.0,
        theta if theta < 1e-4 => 1.0 - theta * theta / 6.0,
        theta => theta.sin() / theta,
    })
}

/// Integral of a density over a rectangle, by 9-point Gauss-Legendre quadrature.
fn over_rectangle(
    (left, right): (f64, f64),
    (top, bottom): (f64, f64),
    density: impl Fn(f64, f64) -> f64,
) -> f64 {
    let offset = 0.5 * 0.6f64.sqrt();
    let points = [(0.5 - offset, 5.0), (0.5, 8.0), (0.5 + offset, 5.0)];
    let (width, height) = (right - left, bottom - top);
    let mut sum = 0.0;
    for (x, weight_x) in points {
        for (y, weight_y) in points {
            sum += weight_x * weight_y * density(left + x * width, top + y * height);
        }
    }
    sum * width * height / 324.0
}
