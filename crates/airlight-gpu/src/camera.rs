//! [`Camera`] and [`Projection`].

use crate::error::{SkyRendererError, is_invertible, require};
use airlight::axes;
use glam::{DVec2, DVec3, Mat4};
use std::f32::consts::{FRAC_PI_2, PI};
use std::f64::consts::TAU;

/// Points around the edge of a disc.
const EDGE_POINTS: usize = 16;
/// Factor on the radius of a disc, whose edge is inside the polygon of its points then.
const PADDING: f64 = 1.1;
/// Pixels around a disc that its light may reach, and rounding.
const MARGIN: f64 = 2.0;

/// Where the pixels of a frame look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    projection: Projection,
    exposure: f32,
}

/// Mapping of directions to the pixels of a frame, and what their depth means.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Projection {
    /// What graphics pipelines draw: a matrix, usually perspective.
    Perspective {
        /// From clip space to the world around the eye: the inverse of projection times rotation. World axes: y up at the eye, the
        /// unit is the metre.
        world_from_clip: Mat4,
        /// Depth of a pixel without geometry: 0 with reversed depth, otherwise 1.
        far_depth: f32,
    },
    /// Equidistant: the angle from the central direction is proportional to the distance from the centre of the picture. Pixels
    /// beyond the largest angle stay as they are. The depth is the distance of the geometry, m, and 0 without any.
    Fisheye {
        /// Right, up and forward of the centre: unit vectors in the world.
        axes: [DVec3; 3],
        /// Angles from the centre to the right and to the upper edge, rad.
        half_angles_rad: [f32; 2],
        /// Angle from the centre to the edge of the circle, rad.
        largest_rad: f32,
    },
    /// The whole sphere: azimuth increases linearly from left to right, elevation decreases linearly from the zenith to the nadir. The
    /// depth is the distance of the geometry, m, and 0 without any.
    Equirectangular {
        /// Azimuth of the centre, degrees clockwise from north.
        center_azimuth_deg: f64,
    },
}

impl Projection {
    fn check(&self) -> Result<(), SkyRendererError> {
        match self {
            Self::Perspective {
                world_from_clip,
                far_depth,
            } => {
                require(
                    is_invertible(world_from_clip),
                    "a finite matrix from clip space to the world that has an inverse",
                    world_from_clip,
                )?;
                require(
                    (0.0..=1.0).contains(far_depth),
                    "a depth without geometry from 0 to 1, with reversed depth 0",
                    far_depth,
                )
            }
            Self::Fisheye {
                axes,
                half_angles_rad,
                largest_rad,
            } => {
                const TOLERANCE: f64 = 1e-3;
                let [right, up, forward] = *axes;
                let across = [right.dot(up), up.dot(forward), forward.dot(right)];
                let lengths = axes.map(|axis| axis.length_squared() - 1.0);
                let errors = across.into_iter().chain(lengths);
                require(
                    { errors }.all(|error| error.abs() < TOLERANCE),
                    "unit vectors to the right, up and forward of the fisheye at right angles",
                    axes,
                )?;
                require(
                    half_angles_rad.iter().all(|a| *a > 0.0 && a.is_finite()),
                    "finite angles above 0 from the centre to the edges of the fisheye",
                    half_angles_rad,
                )?;
                require(
                    *largest_rad > 0.0 && *largest_rad <= PI,
                    "an angle from the centre of the fisheye to its circle above 0, up to pi",
                    largest_rad,
                )
            }
            Self::Equirectangular { center_azimuth_deg } => require(
                center_azimuth_deg.is_finite(),
                "a finite azimuth of the centre",
                center_azimuth_deg,
            ),
        }
    }
}

impl Camera {
    /// A camera with an exposure: what luminances in cd/m^2 are multiplied by before they reach the target, which a half float holds up to
    /// 65504.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for an exposure that is negative or not finite, and for a projection that maps no pixels to directions.
    pub fn new(projection: Projection, exposure: f32) -> Result<Self, SkyRendererError> {
        require(
            exposure >= 0.0 && exposure.is_finite(),
            "a finite exposure of the camera, 0 or more",
            &exposure,
        )?;
        projection.check()?;
        Ok(Self {
            projection,
            exposure,
        })
    }

    /// Directions of the pixels.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// What luminances in cd/m^2 are multiplied by.
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// The numbers of the shader's struct `Camera`.
    pub(crate) fn numbers(&self) -> Vec<f32> {
        let (kind, matrix, far_depth, [across, up], largest) = match self.projection {
            Projection::Perspective {
                world_from_clip,
                far_depth,
            } => (0, world_from_clip, far_depth, [0.0; 2], 0.0),
            Projection::Fisheye {
                axes,
                half_angles_rad,
                largest_rad,
            } => (1, turn(axes), 0.0, half_angles_rad, largest_rad),
            Projection::Equirectangular { center_azimuth_deg } => {
                let right = axes::direction(center_azimuth_deg + 90.0, 0.0);
                let forward = axes::direction(center_azimuth_deg, 0.0);
                let turn = turn([right, DVec3::Y, forward]);
                (2, turn, 0.0, [PI, FRAC_PI_2], 0.0)
            }
        };
        let mut numbers = matrix.to_cols_array().to_vec();
        numbers.extend([self.exposure, far_depth, f32::from_bits(kind), 0.0]);
        numbers.extend([across, up, largest, 0.0]);
        numbers
    }

    /// Column, row, width and height of the pixels that may see a disc around a direction, in a frame of a size; `None` if none do. In
    /// projections other than perspective it is the whole frame.
    pub(crate) fn rectangle(
        &self,
        size: [u32; 2],
        towards: DVec3,
        radius_rad: f64,
    ) -> Option<[u32; 4]> {
        let whole = Some([0, 0, size[0], size[1]]);
        let Projection::Perspective {
            world_from_clip, ..
        } = self.projection
        else {
            return whole;
        };
        let clip_from_world = world_from_clip.as_dmat4().inverse();
        let (across, up) = towards.any_orthonormal_pair();
        let (sin, cos) = (PADDING * radius_rad).sin_cos();
        let edge = (0..EDGE_POINTS).map(|k| {
            let (y, x) = (TAU * k as f64 / EDGE_POINTS as f64).sin_cos();
            let direction = towards * cos + (across * x + up * y) * sin;
            clip_from_world * direction.extend(0.0)
        });
        let edge: Vec<_> = edge.collect();
        if edge.iter().all(|clip| clip.w < -1e-6) {
            return None;
        }
        if edge.iter().any(|clip| clip.w < 1e-6) {
            return whole;
        }
        let [width, height] = size.map(f64::from);
        let pixels = edge.iter().map(|clip| {
            let place = DVec2::new(clip.x, -clip.y) / clip.w;
            (0.5 + 0.5 * place) * DVec2::new(width, height)
        });
        let (least, most) = pixels.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
            (a.min(p), b.max(p))
        });
        let end = DVec2::new(width, height);
        let least = (least - MARGIN).floor().clamp(DVec2::ZERO, end);
        let most = (most + MARGIN).ceil().clamp(DVec2::ZERO, end);
        let extent = most - least;
        (extent.min_element() > 0.0)
            .then(|| [least.x, least.y, extent.x, extent.y].map(|side| side as u32))
    }
}

/// From components to the right, up and forward to the world.
fn turn([right, up, forward]: [DVec3; 3]) -> Mat4 {
    let column = |axis: DVec3| axis.as_vec3().extend(0.0);
    Mat4::from_cols(column(right), column(up), column(forward), glam::Vec4::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// A frame of 90 degrees to the north, as wide as high, with reversed depth.
    fn camera() -> Camera {
        let view = glam::camera::rh::view::look_to_mat4(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y);
        let projection = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ]);
        let perspective = Projection::Perspective {
            world_from_clip: (projection * view).inverse(),
            far_depth: 0.0,
        };
        Camera::new(perspective, 1.0).unwrap()
    }

    fn refusal(projection: Projection, exposure: f32) -> String {
        Camera::new(projection, exposure).unwrap_err().to_string()
    }

    #[test]
    fn cameras_that_see_nothing_are_refused() {
        let perspective = camera().projection();
        for exposure in [-1.0, f32::NAN, f32::INFINITY] {
            let refusal = refusal(perspective, exposure);
            assert!(
                refusal.starts_with("expected a finite exposure"),
                "{refusal}"
            );
        }
        let Projection::Perspective {
            world_from_clip, ..
        } = perspective
        else {
            panic!("a perspective");
        };
        let flat = Mat4::from_diagonal(glam::Vec4::new(1.0, 1.0, 0.0, 1.0));
        for (world_from_clip, far_depth, word) in [
            (flat, 0.0, "inverse"),
            (world_from_clip * f32::NAN, 0.0, "inverse"),
            (world_from_clip * f32::INFINITY, 0.0, "inverse"),
            (world_from_clip, -1.0, "depth"),
            (world_from_clip, f32::NAN, "depth"),
        ] {
            let projection = Projection::Perspective {
                world_from_clip,
                far_depth,
            };
            let refusal = refusal(projection, 1.0);
            assert!(refusal.contains(word), "{refusal}");
        }
        let fisheye = |axes, half_angle: f32, largest_rad| Projection::Fisheye {
            axes,
            half_angles_rad: [1.0, half_angle],
            largest_rad,
        };
        let straight = [DVec3::X, DVec3::Y, DVec3::NEG_Z];
        assert!(Camera::new(fisheye(straight, 1.0, PI), 0.0).is_ok());
        for (axes, half_angle, largest_rad, word) in [
            ([DVec3::X, DVec3::X, DVec3::NEG_Z], 1.0, 1.0, "right angles"),
            ([DVec3::X, DVec3::Y, DVec3::ZERO], 1.0, 1.0, "right angles"),
            (
                [DVec3::X, DVec3::NAN, DVec3::NEG_Z],
                1.0,
                1.0,
                "right angles",
            ),
            (straight, 0.0, 1.0, "edges"),
            (straight, f32::NAN, 1.0, "edges"),
            (straight, 1.0, f32::NAN, "circle"),
            (straight, 1.0, 4.0, "circle"),
        ] {
            let refusal = refusal(fisheye(axes, half_angle, largest_rad), 1.0);
            assert!(refusal.contains(word), "{refusal}");
        }
        let turned = Projection::Equirectangular {
            center_azimuth_deg: f64::INFINITY,
        };
        assert!(refusal(turned, 1.0).contains("azimuth"));
    }

    #[test]
    fn rectangles_hold_what_sees_a_disc() {
        const SIDE: u32 = 400;
        const RADIUS: f64 = 0.02;
        let direction = |x: u32, y: u32| {
            let place = |p: u32| 2.0 * (f64::from(p) + 0.5) / f64::from(SIDE) - 1.0;
            DVec3::new(place(x), -place(y), -1.0).normalize()
        };
        for (azimuth, elevation) in [
            (0.0, 0.0),
            (20.0, -10.0),
            (44.9, 0.0),
            (-45.5, 3.0),
            (0.0, 45.7),
            (-44.0, -34.0),
            (46.0, 0.0),
            (60.0, 0.0),
            (89.5, 0.0),
            (91.5, 0.0),
            (180.0, 0.0),
            (0.0, 90.0),
        ] {
            let towards = axes::direction(azimuth, elevation);
            let rectangle = camera().rectangle([SIDE; 2], towards, RADIUS);
            let holds = |x: u32, y: u32| {
                rectangle.is_some_and(|[left, top, width, height]| {
                    (left..left + width).contains(&x) && (top..top + height).contains(&y)
                })
            };
            let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
            let sees = |&(x, y): &(u32, u32)| direction(x, y).angle_between(towards) < RADIUS;
            let seen: Vec<_> = pixels.filter(sees).collect();
            assert!(
                seen.iter().all(|&(x, y)| holds(x, y)),
                "{azimuth} {elevation}"
            );
            let area = rectangle.map_or(0, |[left, top, width, height]| {
                assert!(left + width <= SIDE && top + height <= SIDE);
                width * height
            });
            // Only beside the plane of the eye is it the whole frame.
            let beside = (azimuth.abs() - 90.0).abs() < 1.2 || elevation == 90.0;
            assert!(area < 800 || beside, "{azimuth} {elevation}: {rectangle:?}");
            if azimuth == 180.0 || azimuth == 60.0 {
                assert_eq!(rectangle, None);
            }
        }
    }
}
