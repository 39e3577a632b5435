//! Fog that is the same in every direction: the rays of a picture by vector instructions.

use super::closed_forms::Lanes;
use super::closed_forms::OPAQUE;
use super::fog_lanes::FogLanes;
use crate::math::simd::vectorized;
use crate::math::slices::check_length;
use crate::spectrum::Spectrum;

/// Rays computed together.
const BLOCK: usize = 64;

/// Uniform fog in ambient light alone, in red, green and blue: transmittance and path radiance depend on the distance only.
///
/// Results are the same bits as those of [`RgbFog::path`](super::RgbFog::path), in a tenth of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenFog {
    extinction_per_m: [f32; 3],
    scattering_per_m: [f32; 3],
    ambient: [f32; 3],
}

impl EvenFog {
    /// `None` for fog whose light depends on height or direction.
    pub(super) fn of(fog: &FogLanes<3>) -> Option<Self> {
        let [layer] = &fog.layers[..] else {
            return None;
        };
        let is_even = layer.density.is_uniform() && fog.ground.is_flat();
        (is_even && fog.lighting.sun.is_none()).then_some(Self {
            extinction_per_m: layer.extinction_per_m.0,
            scattering_per_m: layer.scattering_per_m.0,
            ambient: fog.lighting.ambient.0,
        })
    }

    /// Colours through the fog, at distances in metres (infinite for the sky). Colours are linear, interleaved, in the unit of the
    /// ambient light.
    ///
    /// # Panics
    /// If there are not three numbers of `colours` and of `out` for each distance.
    pub fn apply(&self, distances_m: &[f64], colours: &[f32], out: &mut [f32]) {
        check_length(colours, 3 * distances_m.len());
        check_length(out, 3 * distances_m.len());
        vectorized(
            #[inline(always)]
            || {
                let blocks = colours.chunks(3 * BLOCK).zip(out.chunks_mut(3 * BLOCK));
                for (distances_m, (colours, out)) in distances_m.chunks(BLOCK).zip(blocks) {
                    self.apply_block(distances_m, colours, out);
                }
            },
        );
    }

    #[inline(always)]
    fn apply_block(&self, distances_m: &[f64], colours: &[f32], out: &mut [f32]) {
        let mut columns_m = Spectrum::<BLOCK>::ZERO;
        for (column_m, &distance_m) in columns_m.0.iter_mut().zip(distances_m) {
            *column_m = distance_m.min(OPAQUE) as f32;
        }
        let [red, green, blue] = self.extinction_per_m;
        let first = along(columns_m, red);
        let channels = match red == green && red == blue {
            true => [first; 3],
            false => [first, along(columns_m, green), along(columns_m, blue)],
        };
        let pixels = colours
            .as_chunks::<3>()
            .0
            .iter()
            .zip(out.as_chunks_mut::<3>().0);
        for (i, (colour, out)) in pixels.enumerate().take(BLOCK) {
            for c in 0..3 {
                let (transmittance, opacity) = &channels[c];
                let light = (self.scattering_per_m[c] * opacity[i]) * self.ambient[c];
                out[c] = transmittance[i] * colour[c] + light;
            }
        }
    }
}

/// Transmittance, and opacity per extinction (m), of columns of a uniform extinction (1/m).
#[inline(always)]
fn along(columns_m: Spectrum<BLOCK>, extinction_per_m: f32) -> (Spectrum<BLOCK>, Spectrum<BLOCK>) {
    let depth = columns_m * extinction_per_m;
    (depth.exp_neg(), depth.mean_transmittance() * columns_m)
}

#[cfg(test)]
mod tests {
    use crate::axes;
    use crate::fog::{
        DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer,
    };
    use crate::optics::PhaseFunction;
    use glam::DVec3;

    fn fog(density: DensityProfile, extinction_per_m: [f32; 3], sun: bool) -> RgbFog {
        let layer = RgbLayer {
            density,
            extinction_per_m,
            single_scattering_albedo: [1.0, 0.9, 0.8],
            phase: PhaseFunction::Isotropic,
        };
        let lighting = FogLighting {
            sun: sun.then_some(DirectionalLight {
                direction: axes::direction(150.0, 20.0),
                irradiance: [1.0; 3],
            }),
            ambient: [0.2, 0.25, 0.4],
            ground_albedo: [0.2; 3],
        };
        RgbFog::new(&[layer], Ground::FLAT, &lighting, FogScattering::Multiple).unwrap()
    }

    #[test]
    fn rows_are_the_same_bits_as_single_rays() {
        let mut distances_m: Vec<f64> = (0..150).map(|k| 0.003 * 1.2f64.powi(k)).collect();
        distances_m.extend([0.0, f64::INFINITY]);
        let colours: Vec<f32> = (0..3 * distances_m.len())
            .map(|k| 0.01 * k as f32 - 0.3)
            .collect();
        for extinction_per_m in [[0.02; 3], [0.02, 0.021, 0.025], [0.0; 3]] {
            let fog = fog(DensityProfile::Uniform, extinction_per_m, false);
            let mut out = vec![0.0; colours.len()];
            fog.even().unwrap().apply(&distances_m, &colours, &mut out);
            let pixels = colours
                .as_chunks::<3>()
                .0
                .iter()
                .zip(out.as_chunks::<3>().0);
            for (&distance_m, (&colour, &out)) in distances_m.iter().zip(pixels) {
                assert_eq!(
                    out,
                    fog.path(1.6, DVec3::NEG_Z, distance_m).apply(colour),
                    "{distance_m}"
                );
            }
        }
    }

    #[test]
    fn fog_that_depends_on_direction_is_not_even() {
        assert!(
            fog(DensityProfile::Uniform, [0.02; 3], true)
                .even()
                .is_none()
        );
        let high = DensityProfile::exponential(30.0);
        assert!(fog(high, [0.02; 3], false).even().is_none());
    }
}
