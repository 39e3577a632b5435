//! How surfaces reflect: Lambert's law, as in the pictures of 1987, and the shading of Cook and Torrance.
//!
//! R. L. Cook and K. E. Torrance, "A reflection model for computer graphics", Computer Graphics 15(3), 1981: facets of
//! Beckmann's slopes that mirror after Fresnel. Their `R_s = F D G / (pi (n.l)(n.v))` with Beckmann's distribution as they print it,
//! `e^-(tan^2 a / m^2) / (m^2 cos^4 a)`, reflects four times too much; here it is `F D G / (4 (n.l)(n.v))` with that over pi
//! (Walter et al. 2007, eqs. 20 and 25), which a smooth surface turns into a mirror.

use airlight::spectrum::SpectralCurve;
use glam::DVec3;
use std::f64::consts::PI;

/// What a thing is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Diffuse reflectance, 0 to 1.
    pub reflectance: SpectralCurve,
    /// Squares of another reflectance.
    pub checker: Option<Checker>,
    /// A coat that mirrors.
    pub gloss: Option<Gloss>,
}

/// Squares (or cubes) of two reflectances by turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Checker {
    /// Their side, m.
    pub size_m: f64,
    /// The other reflectance, 0 to 1.
    pub reflectance: SpectralCurve,
}

/// A coat of Cook and Torrance's facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// Root mean square slope of the facets, `m`.
    pub roughness: f64,
    /// Refractive index.
    pub index: f64,
}

/// How much of the light that arrives at a surface goes to the eye. With the diffuse reflectance `r`, the sun's irradiance
/// `E` of a surface that faces it, the irradiance `A` of all else and the radiance `M` of all else around the mirrored ray,
///
/// ```text
/// L = r / pi (sun E + ambient A) + sun_mirrored E + mirrored M
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// Of the sun, diffusely.
    pub sun: f32,
    /// Of all else, diffusely.
    pub ambient: f32,
    /// Of the sun, mirrored, 1/sr.
    pub sun_mirrored: f32,
    /// Of all else, mirrored.
    pub mirrored: f32,
}

impl Surface {
    /// How much of the checker's own reflectance there is about a point, 0 to 1, where a ray's footprint covers so much of
    /// each axis (m): squares too small to be seen become their mean.
    pub fn checker_share(&self, point: DVec3, footprint_m: DVec3) -> f32 {
        let Some(checker) = &self.checker else {
            return 0.0;
        };
        // The mean over the footprint of a wave of 1 and -1 along each axis.
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

    /// How it reflects light of the sun (at the unit vector `to_sun`) and of all else towards the eye (at `to_eye`); `normal`
    /// is on the eye's side.
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
        // What the coat mirrors does not reach the matter under it, on the way in and out.
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
    /// Radiance towards the eye for each unit of irradiance that faces the sun: `F D G / (4 n.v)`, 1/sr.
    pub fn mirrored_sun(&self, normal: DVec3, to_eye: DVec3, to_sun: DVec3) -> f64 {
        let (v, l) = (normal.dot(to_eye), normal.dot(to_sun));
        if v <= 0.0 || l <= 0.0 {
            return 0.0;
        }
        let half = (to_eye + to_sun).normalize();
        let (h, vh) = (normal.dot(half), to_eye.dot(half));
        // Torrance and Sparrow's shadowing in grooves.
        let grooves = (2.0 * h * v / vh).min(2.0 * h * l / vh).min(1.0);
        fresnel(vh, self.index) * self.facets(h) * grooves / (4.0 * v)
    }

    /// Beckmann's distribution of facets by the cosine of their angle to the normal, 1/sr.
    fn facets(&self, cosine: f64) -> f64 {
        if cosine <= 0.0 {
            return 0.0;
        }
        let (m2, c2) = (self.roughness * self.roughness, cosine * cosine);
        (-(1.0 - c2) / (c2 * m2)).exp() / (PI * m2 * c2 * c2)
    }
}

/// What a smooth surface of a refractive index mirrors of unpolarised light, by the cosine of incidence (Fresnel).
pub fn fresnel(cosine: f64, index: f64) -> f64 {
    let c = cosine.clamp(0.0, 1.0);
    let g = (index * index - 1.0 + c * c).sqrt();
    let (plus, minus) = (g + c, g - c);
    let ratio = (c * plus - 1.0) / (c * minus + 1.0);
    0.5 * (minus / plus).powi(2) * (1.0 + ratio * ratio)
}
