//! [`Lighting`].

use airlight::glam::DVec3;
use airlight::sky::SkyTable;
use airlight_shaders::SkyTables;
use airlight_shaders::twins::colour::rgb_from_spectrum;
use glam::{Vec3, Vec4};
use std::f64::consts::{PI, TAU};

/// Gauss-Legendre nodes and weights on -1..1: with [`AROUND`] azimuths they integrate harmonics up to degree 9 over the sphere.
const HEIGHTS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189),
    (-0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.0, 0.568_888_888_888_889),
    (0.538_469_310_105_683, 0.478_628_670_499_366),
    (0.906_179_845_938_664, 0.236_926_885_056_189),
];
/// Number of normals at each height.
const AROUND: usize = 10;

/// The light of sun and sky on a program's own surfaces, at the eye, in the RGB space of the target; in fog, that of the fog and
/// what it lets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// Unit vector towards the sun, or to what is in its place.
    pub sun: Vec3,
    /// Illuminance of a surface that faces the sun by the sun's disc, dimmed by the air, lx; 0 for a sun below the horizon.
    pub sun_illuminance_lx: Vec3,
    /// The disc of a second source, such as the moon.
    pub second: Option<DirectLight>,
    /// Illuminance of surfaces by everything else, sky and ground, lx: coefficients of 1, x, y, z, xy, yz, zx, 3 y^2 - 1 and
    /// x^2 - z^2 of the unit normal (x, y, z), y up.
    pub sky_coefficients_lx: [Vec3; 9],
}

/// Light of a disc in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectLight {
    /// Unit vector towards it.
    pub direction: Vec3,
    /// Illuminance of a surface that faces it, dimmed by the air, lx; 0 below the horizon.
    pub illuminance_lx: Vec3,
}

impl Lighting {
    /// Light at the eye of a view, from its light in all directions and its tables, with the illuminance by the sun's disc.
    pub(crate) fn new(sky: &SkyTable, tables: &SkyTables, sun_illuminance_lx: [f64; 3]) -> Self {
        let rgb =
            |light: &[f32]| rgb_from_spectrum(tables.radiance_weights, Vec4::from_slice(light));
        let (normals, weights): (Vec<DVec3>, Vec<f64>) = normals().unzip();
        let mut arriving = vec![0.0; 4 * normals.len()];
        sky.irradiances(&normals, &mut arriving);
        let mut sky_coefficients_lx = [Vec3::ZERO; 9];
        for ((normal, weight), light) in normals.iter().zip(weights).zip(arriving.chunks_exact(4)) {
            let light = rgb(light) * weight as f32;
            let values = polynomials(normal.as_vec3());
            for ((out, value), square) in
                sky_coefficients_lx.iter_mut().zip(values).zip(MEAN_SQUARES)
            {
                *out += light * (value / square);
            }
        }
        Self {
            sun: tables.view.sun,
            sun_illuminance_lx: Vec3::from_array(sun_illuminance_lx.map(|v| v as f32)),
            second: None,
            sky_coefficients_lx,
        }
    }

    /// The disc of the sun, or of what is in its place.
    pub fn first(&self) -> DirectLight {
        DirectLight {
            direction: self.sun,
            illuminance_lx: self.sun_illuminance_lx,
        }
    }

    /// This light and that of a second source: the light of both skies, and both discs.
    pub(crate) fn with(&self, more: &Self) -> Self {
        let coefficients = |k| self.sky_coefficients_lx[k] + more.sky_coefficients_lx[k];
        Self {
            second: Some(DirectLight {
                direction: more.sun,
                illuminance_lx: more.sun_illuminance_lx,
            }),
            sky_coefficients_lx: std::array::from_fn(coefficients),
            ..*self
        }
    }

    /// This light in a fog: the sun dimmed by its transmittance, and all other light from the radiance in the fog along unit vectors.
    pub(crate) fn in_fog(&self, to_sun: Vec3, radiance: impl Fn(Vec3) -> Vec3) -> Self {
        let mut sky_coefficients_lx = [Vec3::ZERO; 9];
        for (direction, weight) in around(self.sun.as_dvec3()) {
            let direction = direction.as_vec3();
            let light = radiance(direction) * weight as f32;
            let values = polynomials(direction);
            let factors = MEAN_SQUARES.iter().zip(COSINE_FACTORS);
            for ((out, value), (square, factor)) in
                sky_coefficients_lx.iter_mut().zip(values).zip(factors)
            {
                *out += light * (factor as f32 * value / square);
            }
        }
        Self {
            sun_illuminance_lx: self.sun_illuminance_lx * to_sun,
            sky_coefficients_lx,
            ..*self
        }
    }

    /// Illuminance of a surface with this unit normal by everything but the discs of sun and moon, lx. Nowhere negative.
    pub fn sky_illuminance_lx(&self, normal: Vec3) -> Vec3 {
        let terms = self.sky_coefficients_lx.iter().zip(polynomials(normal));
        terms
            .map(|(c, value)| *c * value)
            .sum::<Vec3>()
            .max(Vec3::ZERO)
    }
}

/// Unit vectors over the sphere, and their weights in a mean.
fn normals() -> impl Iterator<Item = (DVec3, f64)> {
    HEIGHTS.into_iter().flat_map(|(height, weight)| {
        (0..AROUND).map(move |k| {
            let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
            let across = (1.0 - height * height).sqrt();
            let normal = DVec3::new(across * cos, height, across * sin);
            (normal, 0.5 * weight / AROUND as f64)
        })
    })
}

/// Unit vectors over the sphere, dense towards one of them, where fog is brightest, and their weights in a mean.
fn around(pole: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
    const RINGS: usize = 48;
    const DIRECTIONS: usize = 32;
    let across = pole.any_orthonormal_vector();
    let other = pole.cross(across);
    (0..RINGS).flat_map(move |ring| {
        // Equal steps of the third root of the angle.
        let place = (ring as f64 + 0.5) / RINGS as f64;
        let (sin, cos) = (PI * place.powi(3)).sin_cos();
        let width = 3.0 * PI * place * place / RINGS as f64;
        (0..DIRECTIONS).map(move |k| {
            let azimuth = TAU * (k as f64 + 0.5) / DIRECTIONS as f64;
            let level = across * azimuth.cos() + other * azimuth.sin();
            let weight = 0.5 * sin * width / DIRECTIONS as f64;
            (pole * cos + level * sin, weight)
        })
    })
}

/// Irradiance of a surface by the radiance of a harmonic, relative to it, for each of the polynomials: those of degree 0, 1 and 2.
const COSINE_FACTORS: [f64; 9] = {
    let [flat, first, second] = [PI, 2.0 * PI / 3.0, PI / 4.0];
    [
        flat, first, first, first, second, second, second, second, second,
    ]
};

/// The polynomials of a unit normal that [`Lighting::sky_coefficients_lx`] lists: harmonics up to degree 2.
fn polynomials(n: Vec3) -> [f32; 9] {
    [
        1.0,
        n.x,
        n.y,
        n.z,
        n.x * n.y,
        n.y * n.z,
        n.z * n.x,
        3.0 * n.y * n.y - 1.0,
        n.x * n.x - n.z * n.z,
    ]
}

/// Means of their squares over the sphere.
const MEAN_SQUARES: [f32; 9] = [
    1.0,
    1.0 / 3.0,
    1.0 / 3.0,
    1.0 / 3.0,
    1.0 / 15.0,
    1.0 / 15.0,
    1.0 / 15.0,
    4.0 / 5.0,
    4.0 / 15.0,
];

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::atmosphere::DensityProfile;
    use airlight::axes;
    use airlight::fog::droplets::Droplets;
    use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};

    /// An even sky, with which the library's fog is lit, too: what falls on the ground below. Thin fog under a low sun is left out:
    /// harmonics of degree 2 cannot follow its glow.
    #[test]
    fn light_below_a_fog_is_that_of_the_library() {
        for (sun_deg, extinction_per_m) in [(50.0, 0.03f32), (10.0, 0.03), (50.0, 0.003)] {
            let lighting = Lighting {
                sun: axes::direction(140.0, sun_deg).as_vec3(),
                sun_illuminance_lx: Vec3::splat(1e5),
                second: None,
                sky_coefficients_lx: [Vec3::ZERO; 9],
            };
            let layer = RgbLayer {
                density: DensityProfile::exponential(30.0),
                extinction_per_m: [extinction_per_m; 3],
                single_scattering_albedo: [0.99; 3],
                phase: Droplets::default().phase(),
            };
            let sky = 3e3;
            let light = FogLighting {
                sun: Some(DirectionalLight {
                    direction: lighting.sun.as_dvec3(),
                    irradiance: [1e5; 3],
                }),
                ambient: [sky; 3],
                ground_albedo: [0.2; 3],
            };
            let fog = RgbFog::new(&[layer], Ground::FLAT, &light, FogScattering::Multiple);
            let fog = fog.unwrap();
            let to_end = |d: Vec3| {
                let length_m = if d.y > 0.0 { f64::INFINITY } else { 0.0 };
                fog.path(0.0, d.as_dvec3().normalize(), length_m)
            };
            let even = |d: Vec3| {
                let behind = if d.y > 0.0 { sky } else { 0.0 };
                Vec3::from_array(to_end(d).apply([behind; 3]))
            };
            let to_sun = Vec3::from_array(to_end(lighting.sun).transmittance);
            let below = lighting.in_fog(to_sun, even);
            let got =
                below.sun_illuminance_lx.y * lighting.sun.y + below.sky_illuminance_lx(Vec3::Y).y;
            let error = got / fog.ground_irradiance().unwrap()[1] - 1.0;
            println!("{sun_deg} {extinction_per_m}: {error:.4}");
            assert!(error.abs() < 0.03, "{error}");
        }
    }

    #[test]
    fn directions_around_a_pole_cover_the_sphere() {
        let pole = DVec3::new(0.3, 0.5, -0.8).normalize();
        let mean = |f: &dyn Fn(DVec3) -> f64| around(pole).map(|(d, w)| f(d) * w).sum::<f64>();
        assert!((mean(&|_| 1.0) - 1.0).abs() < 2e-3);
        assert!((mean(&|d| d.y * d.y) - 1.0 / 3.0).abs() < 2e-3);
        // A glow of half a degree, whose mean is 1.
        let glow = |d: DVec3| 2.0 / 7.6e-5 * (-d.distance_squared(pole) / 7.6e-5).exp();
        assert!((mean(&|d| 2.0 * glow(d)) - 1.0).abs() < 0.05);
    }

    #[test]
    fn polynomials_are_orthogonal_over_the_normals() {
        for i in 0..9 {
            for j in 0..9 {
                let product = |(n, w): (DVec3, f64)| {
                    let values = polynomials(n.as_vec3());
                    f64::from(values[i] * values[j]) * w
                };
                let mean: f64 = normals().map(product).sum();
                let right = if i == j { MEAN_SQUARES[i] } else { 0.0 };
                assert!((mean - f64::from(right)).abs() < 1e-6, "{i} {j}: {mean}");
            }
        }
    }
}
