//! Reflection by surfaces: Lambertian, as in the pictures of Klassen 1987, with an optional Cook-Torrance coat.
//!
//! R. L. Cook and K. E. Torrance, "A reflection model for computer graphics", Computer Graphics 15(3), 1981: microfacets with
//! Beckmann's distribution of slopes and Fresnel reflection. The printed `R_s = F D G / (pi (n.l)(n.v))` with the printed
//! distribution `e^-(tan^2 a / m^2) / (m^2 cos^4 a)` is four times too large. Here it is `F D G / (4 (n.l)(n.v))` with the
//! distribution divided by pi (Walter et al. 2007, eqs. 20 and 25), whose smooth limit is a mirror.

use airlight::spectrum::SpectralCurve;
use glam::DVec3;
use std::f64::consts::PI;

/// Reflection properties of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Diffuse reflectance, 0 to 1.
    pub reflectance: SpectralCurve,
    /// Checker pattern with a second reflectance.
    pub checker: Option<Checker>,
    /// Glossy coat.
    pub gloss: Option<Gloss>,
}

/// Pattern of squares (or cubes) with two alternating reflectances.
#[derive(Clone, Debug, PartialEq)]
pub struct Checker {
    /// Side of a square, m.
    pub size_m: f64,
    /// The second reflectance, 0 to 1.
    pub reflectance: SpectralCurve,
}

/// A coat of Cook-Torrance microfacets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// Root mean square slope of the facets, `m`.
    pub roughness: f64,
    /// Refractive index of the coat.
    pub index: f64,
}

/// Factors of the light that a surface reflects to the eye. With the diffuse reflectance `r`, the sun's irradiance `E` on a
/// surface that faces it, the irradiance `A` of all other light and its radiance `M` along the mirrored ray,
///
/// ```text
/// L = r / pi (sun E + ambient A) + sun_mirrored E + mirrored M
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// Diffuse reflection of sunlight.
    pub sun: f32,
    /// Diffuse reflection of other light.
    pub ambient: f32,
    /// Mirrored sunlight, 1/sr.
    pub sun_mirrored: f32,
    /// Mirrored other light.
    pub mirrored: f32,
}

impl Surface {
    /// Share of the checker's second reflectance around a point, 0 to 1, averaged over a footprint with this extent along each
    /// axis, m.
    pub fn checker_share(&self, point: DVec3, footprint_m: DVec3) -> f32 {
        let Some(checker) = &self.checker else {
            return 0.0;
        };
        // Mean over the footprint of a square wave of 1 and -1 along each axis.
        let wave = |axis: usize| {
            let (x, w) = (
                0.5 * point[axis] / checker.size_m,
                (0.5 * footprint_m[axis] / checker.size_m).max(1e-6),
            );
            let triangle = |x: f64| (x - x.floor() - 0.5).abs();
            (triangle(x - 0.5 * w) - triangle(x + 0.5 * w)) / w
        };
        (0.5 - 0.5 * wave(0) * wave(1) * wave(2)) as f32
    }

    /// Reflection of sunlight (from the unit vector `to_sun`) and of other light towards the eye (at the unit vector `to_eye`);
    /// `normal` is on the eye's side.
    pub fn shading(&self, normal: DVec3, to_eye: DVec3, to_sun: DVec3) -> Shading {
        let slant = normal.dot(to_sun).max(0.0);
        let Some(gloss) = &self.gloss else {
            return Shading {
                sun: slant as f32,
                ambient: 1.0,
                sun_mirrored: 0.0,
                mirrored: 0.0,
            };
        };
        let facing = normal.dot(to_eye).max(1e-4);
        let seen = fresnel(facing, gloss.index);
        // Light mirrored by the coat does not reach the diffuse surface below, on the way in and out.
        let through = |cosine: f64| (1.0 - seen) * (1.0 - fresnel(cosine, gloss.index));
        Shading {
            sun: (slant * through(slant)) as f32,
            ambient: through(0.5) as f32,
            sun_mirrored: gloss.mirrored_sun(normal, to_eye, to_sun) as f32,
            mirrored: seen as f32,
        }
    }
}

impl Gloss {
    /// Radiance towards the eye per unit of irradiance on a surface that faces the sun: `F D G / (4 n.v)`, 1/sr.
    pub fn mirrored_sun(&self, normal: DVec3, to_eye: DVec3, to_sun: DVec3) -> f64 {
        let (v, l) = (normal.dot(to_eye), normal.dot(to_sun));
        if v <= 0.0 || l <= 0.0 {
            return 0.0;
        }
        let half = (to_eye + to_sun).normalize();
        let (h, vh) = (normal.dot(half), to_eye.dot(half));
        // Shadowing in V-grooves (Torrance and Sparrow).
        let grooves = (2.0 * h * v / vh).min(2.0 * h * l / vh).min(1.0);
        fresnel(vh, self.index) * self.facets(h) * grooves / (4.0 * v)
    }

    /// Beckmann's distribution of facets, by the cosine of their angle to the normal, 1/sr.
    fn facets(&self, cosine: f64) -> f64 {
        if cosine <= 0.0 {
            return 0.0;
        }
        let (m2, c2) = (self.roughness * self.roughness, cosine * cosine);
        (-(1.0 - c2) / (c2 * m2)).exp() / (PI * m2 * c2 * c2)
    }
}

/// Fresnel reflectance of a smooth surface for unpolarised light, by the cosine of incidence.
pub fn fresnel(cosine: f64, index: f64) -> f64 {
    let c = cosine.clamp(0.0, 1.0);
    let g = (index * index - 1.0 + c * c).sqrt();
    let (plus, minus) = (g + c, g - c);
    let ratio = (c * plus - 1.0) / (c * minus + 1.0);
    0.5 * (minus / plus).powi(2) * (1.0 + ratio * ratio)
}
