//! Lengths along rays between concentric spheres (sections 4 to 7, eqs. 14 to 30).

/// Radii of the ground, the top of the haze and the effective top of the air, m: `R_E <= R_H <= R_A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spheres {
    pub earth_m: f64,
    pub haze_m: f64,
    pub air_m: f64,
}

/// Path lengths in the haze integral.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum HazePath {
    /// Eqs. 27 to 29, with the corrected offset of 27, `l = l_max (r - R_E) / (R_H - R_E)`: the distance along the view ray is
    /// taken as linear in the radius. Too dark near the horizon: by 16 % at an elevation of 1 degree, 80 % on the horizon; 0.6 %
    /// or less from 5 degrees up (test `errata`).
    LinearInRadius,
    /// The integral over the exact path.
    #[default]
    Exact,
}

/// Path of sunlight to the point of scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SunRay {
    /// Eqs. 20, 21, 24 and 25: the ray crosses each sphere at the elevation that the sun has at the eye. At sunset the path
    /// through the air above the haze is 70 % too long (test `errata`).
    Printed,
    /// The straight ray with its exact intersections; no light where the planet blocks it.
    #[default]
    Exact,
}

/// Path lengths of sunlight up to a point of scattering, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lengths {
    /// `d_1`, through the air above the haze.
    pub air_m: f64,
    /// `d_2 + d_3`, through the haze.
    pub haze_m: f64,
}

/// A view ray from the ground, under a sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RaySegment {
    /// Sine of its elevation `theta`, at least 0.
    pub sin_elevation: f64,
    /// Sine of the sun's elevation `phi`, at least 0.
    pub sin_sun: f64,
    /// Cosine of the scattering angle `psi`, the angle to the sun.
    pub cos_sun: f64,
}

/// Eq. 19: length of a ray from radius `r`, with this sine of its elevation there, to radius `outer`, m.
pub(super) fn outward_m(r: f64, outer: f64, sin_elevation: f64) -> f64 {
    // R^2 - r^2 cos^2 = (R - r)(R + r) + r^2 sin^2, without cancellation.
    let beyond = ((outer - r) * (outer + r)).max(0.0);
    let along = r * sin_elevation;
    let root = (beyond + along * along).sqrt();
    match along > 0.0 {
        // sqrt(b + a^2) - a without cancellation.
        true => beyond / (root + along),
        false => root - along,
    }
}

impl Spheres {
    /// Eq. 30: `l_max`, from the eye to the top of the haze.
    pub fn haze_length_m(&self, sin_elevation: f64) -> f64 {
        outward_m(self.earth_m, self.haze_m, sin_elevation)
    }

    /// `d_1` and `d_2` of sunlight to the eye on the ground (eqs. 20 and 21, or exact).
    pub fn sun_lengths(&self, sin_sun: f64, ray: SunRay) -> Lengths {
        let haze_m = outward_m(self.earth_m, self.haze_m, sin_sun);
        let air_m = match ray {
            SunRay::Printed => outward_m(self.haze_m, self.air_m, sin_sun),
            SunRay::Exact => outward_m(self.earth_m, self.air_m, sin_sun) - haze_m,
        };
        Lengths { air_m, haze_m }
    }

    /// Path lengths up to the point at the fraction `x` of the view ray's length in the haze, `length_m`; `None` in the planet's
    /// shadow.
    pub fn lengths(
        &self,
        line: &RaySegment,
        length_m: f64,
        x: f64,
        path: HazePath,
        ray: SunRay,
    ) -> Option<Lengths> {
        let along_m = match path {
            // Eq. 26: d_3 at the radius r = R_E + x (R_H - R_E).
            HazePath::LinearInRadius => {
                let r = self.earth_m + x * (self.haze_m - self.earth_m);
                outward_m(self.earth_m, r, line.sin_elevation)
            }
            HazePath::Exact => x * length_m,
        };
        let r2 = self.earth_m * self.earth_m
            + along_m * (along_m + 2.0 * self.earth_m * line.sin_elevation);
        let (air_m, before_m) = match ray {
            // Eqs. 24 and 25.
            SunRay::Printed => (
                outward_m(self.haze_m, self.air_m, line.sin_sun),
                outward_m(r2.sqrt().min(self.haze_m), self.haze_m, line.sin_sun),
            ),
            SunRay::Exact => {
                // The point relative to the planet's centre, along the direction of the sun.
                let towards_sun_m = self.earth_m * line.sin_sun + along_m * line.cos_sun;
                let across2 = r2 - towards_sun_m * towards_sun_m;
                if towards_sun_m < 0.0 && across2 < self.earth_m * self.earth_m {
                    return None;
                }
                let to =
                    |radius_m: f64| (radius_m * radius_m - across2).max(0.0).sqrt() - towards_sun_m;
                let before_m = to(self.haze_m).max(0.0);
                (to(self.air_m) - before_m, before_m)
            }
        };
        Some(Lengths {
            air_m,
            haze_m: before_m + along_m,
        })
    }
}
