//! A lamp that shines into a cone.

use super::check;
use super::geometry::LightRayGeometry;
use crate::fog::layer::FogError;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// A small lamp that shines into a cone: the full intensity inside the inner angle, nothing outside the outer one.
///
/// Between them the intensity falls as in glTF's `KHR_lights_punctual`:
/// `clamp((cos beta - cos outer) / (cos inner - cos outer), 0, 1)^2` at the angle `beta` off the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight<const N: usize> {
    /// Where it is, m; y is the height.
    pub position: DVec3,
    /// Unit vector of the direction in which it shines.
    pub axis: DVec3,
    /// Radiant intensity on the axis, W sr^-1 nm^-1 (or candela).
    pub intensity: Spectrum<N>,
    /// Angle off the axis up to which the intensity is full, radians.
    pub inner_angle_rad: f64,
    /// Angle off the axis from which it is dark, radians, at most a right angle.
    pub outer_angle_rad: f64,
    /// Its size, m, as of [`super::PointLight`].
    pub radius_m: f64,
}

impl<const N: usize> SpotLight<N> {
    /// A lamp whose numbers are checked; `towards` need not be a unit vector.
    ///
    /// # Errors
    /// [`FogError`] unless `towards` has a direction, `0 <= inner <= outer <= pi/2`, `outer > 0` and all else is as for
    /// [`super::PointLight::new`].
    pub fn new(
        position: DVec3,
        towards: DVec3,
        intensity: Spectrum<N>,
        inner_angle_rad: f64,
        outer_angle_rad: f64,
        radius_m: f64,
    ) -> Result<Self, FogError> {
        check::position(position)?;
        check::radius(radius_m)?;
        check::light("the intensity of a lamp", intensity)?;
        let axis = towards.try_normalize().ok_or(FogError::Number {
            what: "the length of a spot lamp's axis",
            got: towards.length(),
            right: "finite and above 0",
        })?;
        if !(outer_angle_rad > 0.0 && outer_angle_rad <= FRAC_PI_2) {
            return Err(FogError::Number {
                what: "the outer angle of a spot lamp (radians)",
                got: outer_angle_rad,
                right: "above 0 and at most pi/2",
            });
        }
        if !(inner_angle_rad >= 0.0 && inner_angle_rad <= outer_angle_rad) {
            return Err(FogError::Number {
                what: "the inner angle of a spot lamp (radians)",
                got: inner_angle_rad,
                right: "from 0 to the outer angle",
            });
        }
        Ok(Self {
            position,
            axis,
            intensity,
            inner_angle_rad,
            outer_angle_rad,
            radius_m,
        })
    }

    /// The part of the intensity that goes into a direction (unit vector).
    pub fn falloff(&self, direction: DVec3) -> f64 {
        falloff(
            direction.dot(self.axis),
            self.inner_angle_rad.cos(),
            self.outer_angle_rad.cos(),
        )
    }
}

/// The falloff at a cosine of the angle off the axis.
#[inline]
fn falloff(cos: f64, cos_inner: f64, cos_outer: f64) -> f64 {
    if cos >= cos_inner {
        1.0
    } else if cos <= cos_outer {
        0.0
    } else {
        ((cos - cos_outer) / (cos_inner - cos_outer)).powi(2)
    }
}

/// A spot lamp's cone along a line that passes it.
///
/// The cosine of the angle off the axis is `(across + u along) / r`: in the angle `theta = atan(u / h)` a pure sinusoid,
/// `rho cos(theta - phi)`, `rho cos(phi) = across / h`, `rho sin(phi) = along`. So the line is inside a cone of half-angle
/// `alpha` where `|theta - phi| <= acos(cos(alpha) / rho)`: never twice, and never in the cone that points the other way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Beam {
    /// From the lamp to the closest point of the line, along the axis, m.
    across_m: f64,
    /// Cosine between line and axis.
    along: f64,
    cos_inner: f64,
    cos_outer: f64,
}

impl Beam {
    pub(super) fn new<const N: usize>(
        light: &SpotLight<N>,
        geometry: &LightRayGeometry,
        eye: DVec3,
        direction: DVec3,
    ) -> Self {
        let closest = eye - light.position - geometry.start_m * direction;
        Self {
            across_m: closest.dot(light.axis),
            along: direction.dot(light.axis),
            cos_inner: light.inner_angle_rad.cos(),
            cos_outer: light.outer_angle_rad.cos(),
        }
    }

    /// The part of the intensity that goes to the point `u` beyond the closest one, `r` away.
    #[inline]
    pub(super) fn falloff(&self, u: f64, r: f64) -> f64 {
        falloff(
            (self.across_m + u * self.along) / r,
            self.cos_inner,
            self.cos_outer,
        )
    }

    /// Where a passage is inside the outer cone, in metres from its start (from above to, where nowhere), and where inside
    /// the inner one.
    pub(super) fn lit(&self, geometry: &LightRayGeometry) -> [(f64, f64); 2] {
        [self.cos_outer, self.cos_inner].map(|cos| match self.inside(geometry.nearest_m, cos) {
            Some((first, last)) => (first - geometry.start_m, last - geometry.start_m),
            None => (f64::INFINITY, f64::NEG_INFINITY),
        })
    }

    /// The stretch of `u` inside the cone of a cosine.
    fn inside(&self, nearest_m: f64, cos_angle: f64) -> Option<(f64, f64)> {
        let (across, along) = (self.across_m / nearest_m, self.along);
        let size = across.hypot(along);
        if cos_angle >= size {
            return None;
        }
        let (cos_phi, sin_phi) = (across / size, along / size);
        let cos_width = cos_angle / size;
        let sin_width = (1.0 - cos_width * cos_width).max(0.0).sqrt();
        // cos and sin of theta at either edge.
        let cos_first = cos_phi * cos_width + sin_phi * sin_width;
        let sin_first = sin_phi * cos_width - cos_phi * sin_width;
        let cos_last = cos_phi * cos_width - sin_phi * sin_width;
        let sin_last = sin_phi * cos_width + cos_phi * sin_width;
        // An edge beyond a right angle is at infinity on its own side, or the whole stretch is.
        let first = match cos_first > 0.0 {
            true => nearest_m * sin_first / cos_first,
            false if across > 0.0 || along < 0.0 => f64::NEG_INFINITY,
            false => return None,
        };
        let last = match cos_last > 0.0 {
            true => nearest_m * sin_last / cos_last,
            false if across > 0.0 || along > 0.0 => f64::INFINITY,
            false => return None,
        };
        (last > first).then_some((first, last))
    }
}

#[cfg(test)]
mod tests;
