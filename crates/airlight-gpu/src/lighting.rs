//! [`Lighting`].

use airlight::glam::DVec3;
use airlight::sky::{TableChannels, View};
use airlight_shaders::SkyTables;
use airlight_shaders::twins::colour::rgb_from_spectrum;
use glam::{Vec3, Vec4};
use std::f64::consts::TAU;

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

/// The light of sun and sky on a program's own surfaces, at the eye, in the RGB space of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lighting {
    /// Unit vector towards the sun.
    pub sun: Vec3,
    /// Illuminance of a surface that faces the sun by the sun's disc, dimmed by the air, lx; 0 for a sun below the horizon.
    pub sun_illuminance_lx: Vec3,
    /// Illuminance of surfaces by everything else, sky and ground, lx: coefficients of 1, x, y, z, xy, yz, zx, 3 y^2 - 1 and
    /// x^2 - z^2 of the unit normal (x, y, z), y up.
    pub sky_coefficients_lx: [Vec3; 9],
}

impl Lighting {
    /// Light at the eye of a view, from its tables.
    pub(crate) fn new(view: &View, tables: &SkyTables) -> Self {
        let rgb =
            |light: &[f32]| rgb_from_spectrum(tables.radiance_weights, Vec4::from_slice(light));
        let (normals, weights): (Vec<DVec3>, Vec<f64>) = normals().unzip();
        let mut arriving = vec![0.0; 4 * normals.len()];
        view.table(TableChannels::Spectral)
            .irradiances(&normals, &mut arriving);
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
            sun: view.sun().as_vec3(),
            sun_illuminance_lx: rgb(&view.sun_irradiance()),
            sky_coefficients_lx,
        }
    }

    /// Illuminance of a surface with this unit normal by everything but the sun's disc, lx. Nowhere negative.
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
