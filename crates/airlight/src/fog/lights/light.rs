//! Point, spot and sphere lights, and their direct light.

use super::geometry::LightRayGeometry;
use crate::fog::error::{FogError, check_light, check_position, check_radius};
use crate::fog::values::ChannelValues;
use crate::spectrum::{SpectralCurve, Spectrum};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// A light. `C` is a [`SpectralCurve`], or `[f32; 3]` for red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Light<C = SpectralCurve> {
    /// A small light with the same intensity in all directions.
    Point(PointLight<C>),
    /// A small light with its intensity in a cone.
    Spot(SpotLight<C>),
    /// A sphere of uniform radiance.
    Sphere(SphereLight<C>),
}

/// A small light with the same intensity in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight<C = SpectralCurve> {
    /// Position, m; y is the height.
    pub position: DVec3,
    /// Radiant intensity, W sr^-1 nm^-1 (or candela, for colours): the irradiance at the distance `r` is `I / r^2`.
    pub intensity: C,
    /// Radius, m, above 0. Distances of rays and surfaces are clamped to it, which avoids infinite values; at larger distances it
    /// has no effect.
    pub radius_m: f64,
}

/// A small light that shines into a cone: full intensity inside the inner angle, none outside the outer angle.
///
/// Between them the intensity falls as in glTF's `KHR_lights_punctual`:
/// `clamp((cos beta - cos outer) / (cos inner - cos outer), 0, 1)^2` at the angle `beta` from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight<C = SpectralCurve> {
    /// Position, m; y is the height.
    pub position: DVec3,
    /// Unit vector along the axis of the cone, away from the light.
    pub axis: DVec3,
    /// Radiant intensity on the axis, W sr^-1 nm^-1 (or candela).
    pub intensity: C,
    /// Angle from the axis up to which the intensity is full, radians.
    pub inner_angle_rad: f64,
    /// Angle from the axis beyond which the intensity is 0, radians, at most a right angle.
    pub outer_angle_rad: f64,
    /// Radius, m, as for [`PointLight`].
    pub radius_m: f64,
}

/// A sphere of uniform radiance.
///
/// At the distance `r` it subtends the solid angle `2 pi (1 - sqrt(1 - R^2 / r^2))`, so that the scalar irradiance in the fog is
/// `I / r^2` with `I = pi R^2 L`, times `2 / (1 + sqrt(1 - R^2 / r^2))`, which is 2 at the surface. Light is assumed to come from
/// the centre, attenuated up to the nearest point of the surface: the error is of the order `(R / r)^2`, and large within one
/// radius of the surface.
///
/// A ray that hits the sphere ends there. Shadows that a sphere casts in the light of *other* lights are neglected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight<C = SpectralCurve> {
    /// Position of the centre, m; y is the height.
    pub position: DVec3,
    /// Radius, m.
    pub radius_m: f64,
    /// Radiance, W m^-2 sr^-1 nm^-1 (or candela per square metre).
    pub radiance: C,
}

impl<C> Light<C> {
    /// Position of the light (the centre of a sphere), m.
    pub fn position(&self) -> DVec3 {
        match self {
            Self::Point(light) => light.position,
            Self::Spot(light) => light.position,
            Self::Sphere(light) => light.position,
        }
    }

    /// Radius, m.
    pub fn radius_m(&self) -> f64 {
        match self {
            Self::Point(light) => light.radius_m,
            Self::Spot(light) => light.radius_m,
            Self::Sphere(light) => light.radius_m,
        }
    }

    /// Radiant intensity of point and spot lights, radiance of sphere lights.
    pub fn emission(&self) -> &C {
        match self {
            Self::Point(light) => &light.intensity,
            Self::Spot(light) => &light.intensity,
            Self::Sphere(light) => &light.radiance,
        }
    }

    /// Converts the values of the emission.
    pub(super) fn map<D>(&self, values: impl FnOnce(&C) -> D) -> Light<D> {
        match self {
            Self::Point(light) => Light::Point(PointLight {
                position: light.position,
                intensity: values(&light.intensity),
                radius_m: light.radius_m,
            }),
            Self::Spot(light) => Light::Spot(SpotLight {
                position: light.position,
                axis: light.axis,
                intensity: values(&light.intensity),
                inner_angle_rad: light.inner_angle_rad,
                outer_angle_rad: light.outer_angle_rad,
                radius_m: light.radius_m,
            }),
            Self::Sphere(light) => Light::Sphere(SphereLight {
                position: light.position,
                radius_m: light.radius_m,
                radiance: values(&light.radiance),
            }),
        }
    }
}

impl<const N: usize> Light<Spectrum<N>> {
    /// Radiant intensity (on the axis of a spot light), W sr^-1 nm^-1; `pi R^2 L` for a sphere light.
    pub(super) fn intensity(&self) -> Spectrum<N> {
        match self {
            Self::Point(light) => light.intensity,
            Self::Spot(light) => light.intensity,
            Self::Sphere(light) => light.radiance * (PI * light.radius_m * light.radius_m) as f32,
        }
    }
}

impl<C: ChannelValues> PointLight<C> {
    /// A light with checked parameters.
    ///
    /// # Errors
    /// [`FogError`] unless the position is finite, the radius positive and finite, and the intensity finite and not negative.
    pub fn new(position: DVec3, intensity: C, radius_m: f64) -> Result<Self, FogError> {
        check_position(position)?;
        check_radius(radius_m)?;
        check_light("intensity of a light", &intensity)?;
        Ok(Self {
            position,
            intensity,
            radius_m,
        })
    }
}

impl<C: ChannelValues> SpotLight<C> {
    /// A light with checked parameters. `towards` need not be a unit vector.
    ///
    /// # Errors
    /// [`FogError`] unless `towards` is finite and not zero, `0 <= inner <= outer <= pi/2`, `outer > 0`, and the other parameters
    /// are valid for [`PointLight::new`].
    pub fn new(
        position: DVec3,
        towards: DVec3,
        intensity: C,
        inner_angle_rad: f64,
        outer_angle_rad: f64,
        radius_m: f64,
    ) -> Result<Self, FogError> {
        check_position(position)?;
        check_radius(radius_m)?;
        check_light("intensity of a light", &intensity)?;
        let axis = towards.try_normalize().ok_or(FogError::Number {
            what: "length of the axis of a spot light",
            got: towards.length(),
            expected: "a finite number above 0",
        })?;
        if !(outer_angle_rad > 0.0 && outer_angle_rad <= FRAC_PI_2) {
            return Err(FogError::Number {
                what: "outer angle of a spot light (radians)",
                got: outer_angle_rad,
                expected: "a number above 0 and at most pi/2",
            });
        }
        if !(inner_angle_rad >= 0.0 && inner_angle_rad <= outer_angle_rad) {
            return Err(FogError::Number {
                what: "inner angle of a spot light (radians)",
                got: inner_angle_rad,
                expected: "a number from 0 to the outer angle",
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
}

impl<C> SpotLight<C> {
    /// Intensity in a direction (unit vector), relative to that on the axis.
    pub fn falloff(&self, direction: DVec3) -> f64 {
        falloff(
            direction.dot(self.axis),
            self.inner_angle_rad.cos(),
            self.outer_angle_rad.cos(),
        )
    }
}

/// Falloff at a cosine of the angle from the axis.
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

impl<C: ChannelValues> SphereLight<C> {
    /// A light with checked parameters.
    ///
    /// # Errors
    /// [`FogError`] unless the position is finite, the radius positive and finite, and the radiance finite and not negative.
    pub fn new(position: DVec3, radius_m: f64, radiance: C) -> Result<Self, FogError> {
        check_position(position)?;
        check_radius(radius_m)?;
        check_light("radiance of a light", &radiance)?;
        Ok(Self {
            position,
            radius_m,
            radiance,
        })
    }
}

impl<C> SphereLight<C> {
    /// Distance at which the ray from `eye` along the unit vector `direction` hits the sphere, m; 0 from the inside.
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<f64> {
        let to_light = self.position - eye;
        let distance = to_light.length();
        if distance <= self.radius_m {
            return Some(0.0);
        }
        let ahead = to_light.dot(direction);
        let inside = self.radius_m.powi(2) - to_light.cross(direction).length_squared();
        (ahead > 0.0 && inside > 0.0).then(|| {
            (distance - self.radius_m) * (distance + self.radius_m) / (ahead + inside.sqrt())
        })
    }
}

/// Scalar irradiance of a sphere relative to that of a point light of the same intensity: `2 / (1 + sqrt(1 - R^2 / r^2))`.
#[inline]
pub(super) fn closeness(radius_m: f64, distance_m: f64) -> f64 {
    let sine = radius_m / distance_m;
    2.0 / (1.0 + (1.0 - sine * sine).max(0.0).sqrt())
}

/// The cone of a spot light along a ray.
///
/// The cosine of the angle from the axis is `(across + u along) / r`: a sinusoid `rho cos(theta - phi)` of the angle
/// `theta = atan(u / h)`, with `rho cos(phi) = across / h` and `rho sin(phi) = along`. So the ray is inside a cone of half-angle
/// `alpha` for `|theta - phi| <= acos(cos(alpha) / rho)`: one interval, never in the opposite cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpotCone {
    /// Component along the axis of the vector from the light to the closest point of the ray, m.
    across_m: f64,
    /// Cosine between ray and axis.
    along: f64,
    cos_inner: f64,
    cos_outer: f64,
}

impl SpotCone {
    pub(super) fn new<C>(
        light: &SpotLight<C>,
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

    /// Relative intensity towards the point at `u` from the closest point, at a distance `r` from the light.
    #[inline]
    pub(super) fn falloff(&self, u: f64, r: f64) -> f64 {
        falloff(
            (self.across_m + u * self.along) / r,
            self.cos_inner,
            self.cos_outer,
        )
    }

    /// Intervals of the ray inside the outer and the inner cone, in metres from its start; an empty interval if it is outside.
    pub(super) fn lit(&self, geometry: &LightRayGeometry) -> [(f64, f64); 2] {
        [self.cos_outer, self.cos_inner].map(|cos| match self.inside(geometry.nearest_m, cos) {
            Some((first, last)) => (first - geometry.start_m, last - geometry.start_m),
            None => (f64::INFINITY, f64::NEG_INFINITY),
        })
    }

    /// Interval of `u` inside the cone with this cosine of the half-angle.
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
        // Beyond a right angle an edge, or the whole interval, is at infinity.
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
mod tests {
    use super::*;

    fn light(axis: DVec3, inner_deg: f64, outer_deg: f64) -> SpotLight<[f32; 3]> {
        SpotLight::new(
            DVec3::new(1.0, 2.0, 3.0),
            axis,
            [1.0; 3],
            inner_deg.to_radians(),
            outer_deg.to_radians(),
            1e-3,
        )
        .expect("a light")
    }

    #[test]
    fn intervals_in_cones_match_points() {
        let directions = [
            DVec3::X,
            DVec3::NEG_X,
            DVec3::new(0.0, -1.0, 1e-9),
            DVec3::new(0.3, -0.8, 0.1),
            DVec3::new(-0.3, 0.2, 0.9),
            DVec3::new(0.5, 0.5, -0.5),
        ];
        let mut inside = 0;
        for axis in directions {
            for outer in [1.0, 20.0, 60.0, 89.0, 90.0] {
                let light = light(axis, 0.5 * outer, outer);
                for offset in [
                    DVec3::new(0.0, 0.0, 0.01),
                    DVec3::new(0.2, 0.1, 0.0),
                    DVec3::new(-3.0, 0.0, 1.0),
                    DVec3::new(1.0, -7.0, 2.0),
                    DVec3::new(0.0, 40.0, 0.0),
                ] {
                    for direction in directions.map(DVec3::normalize) {
                        let eye = light.position + offset;
                        let geometry =
                            LightRayGeometry::new(eye, direction, 100.0, light.position, 1e-3);
                        let cone = SpotCone::new(&light, &geometry, eye, direction);
                        let [outer_interval, inner_interval] = cone.lit(&geometry);
                        if geometry.nearest_m == light.radius_m {
                            // Distances are clamped for rays through the light.
                            continue;
                        }
                        for step in -400..400 {
                            let t = 0.25 * f64::from(step) + 0.013;
                            let off = (eye + t * direction - light.position).normalize();
                            let cos = off.dot(light.axis);
                            for ((first, last), edge) in
                                [(outer_interval, outer), (inner_interval, 0.5 * outer)]
                            {
                                let edge = edge.to_radians().cos();
                                if (cos - edge).abs() < 1e-9 {
                                    continue;
                                }
                                let got = t > first && t < last;
                                assert_eq!(got, cos > edge, "{light:?} {eye} {direction} {t}");
                                inside += usize::from(got);
                            }
                            let u = t + geometry.start_m;
                            let r = geometry.distance_m(t);
                            assert!((cone.falloff(u, r) - light.falloff(off)).abs() < 1e-6);
                        }
                    }
                }
            }
        }
        assert!(inside > 10_000, "{inside}");
    }

    #[test]
    fn rays_through_the_light_are_lit_on_one_side() {
        let light = light(DVec3::X, 10.0, 30.0);
        let eye = light.position - 5.0 * DVec3::X;
        let geometry = LightRayGeometry::new(eye, DVec3::X, 50.0, light.position, light.radius_m);
        let [(first, last), _] = SpotCone::new(&light, &geometry, eye, DVec3::X).lit(&geometry);
        assert!((first - 5.0).abs() < 2.0 * light.radius_m && last.is_infinite());
        let geometry = LightRayGeometry::new(eye, DVec3::Y, 50.0, light.position, light.radius_m);
        let [(first, last), _] = SpotCone::new(&light, &geometry, eye, DVec3::Y).lit(&geometry);
        assert!(first > last);
    }

    #[test]
    fn the_falloff_is_that_of_gltf() {
        let light = light(DVec3::X, 20.0, 40.0);
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            light.falloff(DVec3::new(cos, sin, 0.0))
        };
        assert_eq!(at(0.0), 1.0);
        assert_eq!(at(19.9), 1.0);
        assert_eq!(at(40.1), 0.0);
        assert_eq!(at(180.0), 0.0);
        let (c, i, o) = (30f64, 20f64, 40f64);
        let [c, i, o] = [c, i, o].map(|a| a.to_radians().cos());
        assert!((at(30.0) - ((c - o) / (i - o)).powi(2)).abs() < 1e-12);
    }

    #[test]
    fn invalid_spot_lights_are_rejected() {
        let make =
            |axis, inner, outer| SpotLight::new(DVec3::ZERO, axis, [1.0f32; 3], inner, outer, 0.1);
        assert!(make(DVec3::Y * 7.0, 0.0, 1.0).is_ok_and(|light| light.axis == DVec3::Y));
        assert!(make(DVec3::ZERO, 0.0, 1.0).is_err());
        assert!(make(DVec3::Y, 0.5, 0.4).is_err());
        assert!(make(DVec3::Y, -0.1, 0.4).is_err());
        assert!(make(DVec3::Y, 0.1, 1.6).is_err());
        assert!(make(DVec3::Y, 0.0, 0.0).is_err());
        assert!(make(DVec3::Y, 0.4, 0.4).is_ok());
        let error = make(DVec3::Y, f64::NAN, 0.4).expect_err("no angle");
        assert!(error.to_string().contains("inner angle"), "{error}");
    }

    #[test]
    fn rays_hit_the_surface_of_the_sphere() {
        let light = SphereLight::new(DVec3::new(0.0, 2.0, -10.0), 0.5, [1.0f32; 3]).unwrap();
        let eye = DVec3::new(0.0, 2.0, 0.0);
        assert_eq!(light.hit(eye, DVec3::NEG_Z), Some(9.5));
        assert_eq!(light.hit(eye, DVec3::Z), None);
        assert_eq!(light.hit(eye, DVec3::Y), None);
        assert_eq!(light.hit(light.position, DVec3::Y), Some(0.0));
        // From far away the error is the rounding of the distance.
        let far = DVec3::new(0.0, 2.0, 1e7);
        let hit = light.hit(far, DVec3::NEG_Z).unwrap();
        assert!((hit - (1e7 + 9.5)).abs() < 1e-8);
        let grazing = DVec3::new(0.05, 0.0, -1.0).normalize();
        assert!(light.hit(eye, grazing).is_some());
        let missing = DVec3::new(0.051, 0.0, -1.0).normalize();
        assert!(light.hit(eye, missing).is_none());
    }

    #[test]
    fn the_scalar_irradiance_of_a_sphere_is_exact() {
        for (radius, distance) in [(0.5f64, 0.5f64), (0.5, 0.7), (0.5, 40.0)] {
            let solid = 2.0 * PI * (1.0 - (1.0 - (radius / distance).powi(2)).sqrt());
            let got = PI * radius * radius / (distance * distance) * closeness(radius, distance);
            assert!((got / solid - 1.0).abs() < 1e-12, "{got} against {solid}");
        }
        assert_eq!(closeness(1.0, 1e9), 1.0);
    }

    #[test]
    fn invalid_sphere_lights_are_rejected() {
        let dark = [1.0f32; 3];
        assert!(SphereLight::new(DVec3::ZERO, 0.0, dark).is_err());
        assert!(SphereLight::new(DVec3::new(0.0, f64::NAN, 0.0), 1.0, dark).is_err());
        assert!(SphereLight::new(DVec3::ZERO, 1.0, [1.0, -1.0, 1.0]).is_err());
    }
}
