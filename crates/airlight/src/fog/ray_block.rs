//! Rays from one eye over flat ground, several at once: lanes are rays, for vector instructions.

use super::closed_forms::{Lanes, OPAQUE};
use crate::atmosphere::{DensityProfile, RaySegment};
use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;
use glam::DVec3;

/// Rays of a block.
pub(super) const RAYS: usize = 16;

/// One value for each ray of a block.
pub(super) type PerRay = Spectrum<RAYS>;

/// Length that stands for an infinite one, m: beyond the range of f32, but without the indeterminate forms of infinity.
const ENDLESS_M: f64 = 1e300;

/// Rays from one eye over flat ground. Where there are fewer, the others have no length.
pub(super) struct RayBlock {
    height_m: f64,
    sin_elevation: [f64; RAYS],
    length_m: [f64; RAYS],
}

impl RayBlock {
    /// Rays from a height in directions (unit vectors) to distances, m.
    #[inline(always)]
    pub fn new(height_m: f64, directions: &[DVec3], distances_m: &[f64]) -> Self {
        let mut block = Self {
            height_m,
            sin_elevation: [0.0; RAYS],
            length_m: [0.0; RAYS],
        };
        for (sine, direction) in block.sin_elevation.iter_mut().zip(directions) {
            *sine = direction.y;
        }
        for (length_m, &distance_m) in block.length_m.iter_mut().zip(distances_m) {
            *length_m = if distance_m < ENDLESS_M {
                distance_m
            } else {
                ENDLESS_M
            };
        }
        block
    }

    /// [`DensityProfile::column_along_m`], at most [`OPAQUE`]. The relative error of the closed forms is a few 1e-7.
    #[inline(always)]
    pub fn columns_m(&self, density: &DensityProfile) -> PerRay {
        let columns_m = match *density {
            DensityProfile::Uniform => PerRay::from_fn(|i| self.length_m[i] as f32),
            DensityProfile::Exponential {
                reference_height_m,
                scale_height_m,
            } => {
                let above_m = [self.height_m - reference_height_m; RAYS];
                self.decaying_m(&above_m, &self.length_m, scale_height_m)
            }
            DensityProfile::Clamped {
                base_height_m,
                scale_height_m,
            } => {
                let below_m = self.lengths_below_m(base_height_m);
                let mut above_m = [0.0; RAYS];
                let mut lengths_m = [0.0; RAYS];
                for i in 0..RAYS {
                    // Rising rays leave the layer of density 1 before they pass the rest, descending ones afterwards.
                    let rises = self.sin_elevation[i] >= 0.0;
                    let before_m = if rises { below_m[i] } else { 0.0 };
                    above_m[i] = self.height_m - base_height_m + before_m * self.sin_elevation[i];
                    lengths_m[i] = if rises {
                        self.length_m[i] - below_m[i]
                    } else {
                        self.passes_at_m(base_height_m, i)
                    };
                }
                let decaying_m = self.decaying_m(&above_m, &lengths_m, scale_height_m);
                PerRay::from_fn(|i| below_m[i] as f32 + decaying_m[i])
            }
            DensityProfile::Layer { bottom_m, top_m } => {
                let below_m = self.lengths_below_m(top_m);
                let under_m = self.lengths_below_m(bottom_m);
                PerRay::from_fn(|i| {
                    let inside_m = match self.sin_elevation[i] < 0.0 {
                        // Not as a difference of lengths that may be infinite.
                        true => self.passes_at_m(bottom_m, i) - self.passes_at_m(top_m, i),
                        false => below_m[i] - under_m[i],
                    };
                    inside_m as f32
                })
            }
            _ => PerRay::from_fn(|i| {
                let length_m = match self.length_m[i] == ENDLESS_M {
                    true => f64::INFINITY,
                    false => self.length_m[i],
                };
                let ray = RaySegment::flat(self.height_m, self.sin_elevation[i], length_m);
                density.column_along_m(&ray) as f32
            }),
        };
        columns_m.smaller(PerRay::splat(OPAQUE as f32))
    }

    /// [`DensityProfile::column_above_m`] at the ends of the rays; infinite where it overflows.
    #[inline(always)]
    pub fn columns_above_end_m(&self, density: &DensityProfile) -> PerRay {
        let end_m = |i: usize| self.height_m + self.sin_elevation[i] * self.length_m[i];
        match *density {
            DensityProfile::Exponential {
                reference_height_m,
                scale_height_m,
            } => {
                decayed(|i| (end_m(i) - reference_height_m) / scale_height_m)
                    * scale_height_m as f32
            }
            DensityProfile::Clamped {
                base_height_m,
                scale_height_m,
            } => {
                let above = decayed(|i| {
                    let above_m = end_m(i) - base_height_m;
                    above_m.max(0.0) / scale_height_m
                });
                PerRay::from_fn(|i| (base_height_m - end_m(i)).max(0.0) as f32)
                    .scale_acc(above, scale_height_m as f32)
            }
            DensityProfile::Layer { bottom_m, top_m } => {
                PerRay::from_fn(|i| (top_m - end_m(i).max(bottom_m)).max(0.0) as f32)
            }
            _ => PerRay::from_fn(|i| density.column_above_m(end_m(i)) as f32),
        }
    }

    /// Distance at which a ray passes a height, within its length; of a descending ray, its length above the height.
    #[inline(always)]
    fn passes_at_m(&self, height_m: f64, i: usize) -> f64 {
        let above_m = self.height_m - height_m;
        let sine = self.sin_elevation[i];
        let at_m = match sine == 0.0 {
            // Level rays below the height never pass it.
            true if above_m < 0.0 => ENDLESS_M,
            true => 0.0,
            false => -above_m / sine,
        };
        at_m.max(0.0).min(self.length_m[i])
    }

    /// Length of each ray below a height.
    #[inline(always)]
    fn lengths_below_m(&self, height_m: f64) -> [f64; RAYS] {
        let mut lengths_m = [0.0; RAYS];
        for (i, length_m) in lengths_m.iter_mut().enumerate() {
            let at_m = self.passes_at_m(height_m, i);
            *length_m = match self.sin_elevation[i] < 0.0 {
                true => self.length_m[i] - at_m,
                false => at_m,
            };
        }
        lengths_m
    }

    /// Columns of a density that decays exponentially from 1 at height 0, along rays from heights `above_m`.
    #[inline(always)]
    fn decaying_m(
        &self,
        above_m: &[f64; RAYS],
        lengths_m: &[f64; RAYS],
        scale_height_m: f64,
    ) -> PerRay {
        let per_scale = 1.0 / scale_height_m;
        let rise = |i: usize| self.sin_elevation[i] * lengths_m[i] * per_scale;
        // From the denser end, to avoid overflow.
        let densest = decayed(|i| above_m[i] * per_scale + rise(i).min(0.0));
        let rises = PerRay::from_fn(|i| rise(i).abs() as f32);
        let lost = rises.map(|rise| -rise).exp();
        let mean = rises.smaller(PerRay::ONE).mean_transmittance();
        let extent_m = PerRay::from_fn(|i| {
            let short_m = mean[i] * lengths_m[i] as f32;
            let long_m = (1.0 - lost[i]) * (scale_height_m / self.sin_elevation[i].abs()) as f32;
            if rises[i] < 1.0 { short_m } else { long_m }
        });
        densest * extent_m
    }
}

/// `e^-heights`, at most `e^57`, as [`DensityProfile::at`] limits it.
#[inline(always)]
fn decayed(heights: impl Fn(usize) -> f64) -> PerRay {
    let exponent = |i: usize| (-heights(i)).clamp(-1000.0, 57.0);
    let rounded = PerRay::from_fn(|i| exponent(i) as f32);
    let rest = PerRay::from_fn(|i| (exponent(i) - f64::from(rounded[i])) as f32);
    let power = rounded.exp();
    power.mul_acc(power, rest)
}

/// A function of the value of each lane, which is evaluated once for equal ones.
#[inline(always)]
pub(super) fn in_lanes<const N: usize, const R: usize>(
    values: Spectrum<N>,
    of: impl Fn(f32) -> Spectrum<R>,
) -> [Spectrum<R>; N] {
    let mut out = [Spectrum::ZERO; N];
    for lane in 0..N {
        out[lane] = match lane > 0 && values[lane] == values[lane - 1] {
            true => out[lane - 1],
            false => of(values[lane]),
        };
    }
    out
}

/// Writes the optics of the rays, given by lane.
#[inline(always)]
pub(super) fn store<const N: usize, T: From<PathOptics<N>>>(
    transmittance: &[PerRay; N],
    path_radiance: &[PerRay; N],
    out: &mut [T],
) {
    for (i, out) in out.iter_mut().enumerate().take(RAYS) {
        *out = T::from(PathOptics {
            transmittance: Spectrum::from_fn(|lane| transmittance[lane][i]),
            path_radiance: Spectrum::from_fn(|lane| path_radiance[lane][i]),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes;

    #[test]
    fn columns_match_those_of_single_rays() {
        let clamped = DensityProfile::Clamped {
            base_height_m: 12.0,
            scale_height_m: 8.0,
        };
        let tent = DensityProfile::Tent {
            bottom_m: 5.0,
            peak_m: 9.0,
            top_m: 30.0,
        };
        let profiles = [
            DensityProfile::Uniform,
            DensityProfile::exponential(30.0),
            DensityProfile::exponential(8000.0),
            clamped,
            DensityProfile::slab(20.0),
            DensityProfile::Layer {
                bottom_m: 10.0,
                top_m: 25.0,
            },
            tent,
        ];
        let elevations = [0.0, 1e-6, 1e-3, 0.3, 4.0, 30.0, 90.0];
        let elevations = elevations.iter().flat_map(|&up| [up, -up]);
        let lengths_m = [0.0, 1e-3, 1.0, 40.0, 3e3, 2e6, f64::INFINITY];
        let rays: Vec<(DVec3, f64)> = elevations
            .flat_map(|up| lengths_m.map(|length_m| (axes::direction(20.0, up), length_m)))
            .collect();
        for profile in &profiles {
            for height_m in [0.0, 1.6, 12.0, 17.0, 25.0, 90.0, 1200.0] {
                for rays in rays.chunks(RAYS) {
                    let (directions, lengths_m): (Vec<_>, Vec<_>) = rays.iter().copied().unzip();
                    let block = RayBlock::new(height_m, &directions, &lengths_m);
                    let columns_m = block.columns_m(profile);
                    let above_m = block.columns_above_end_m(profile);
                    for (i, (direction, length_m)) in rays.iter().enumerate() {
                        let ray = RaySegment::flat(height_m, direction.y, *length_m);
                        let same = |got: f32, exact: f64, what| {
                            let (got, exact) = (f64::from(got).min(OPAQUE), exact.min(OPAQUE));
                            let error = (got - exact).abs();
                            assert!(
                                error <= 1e-6 * exact + 1e-20,
                                "{profile:?} {height_m} {ray:?} {what}: {got} {exact}"
                            );
                        };
                        same(columns_m[i], profile.column_along_m(&ray), "along");
                        same(
                            above_m[i],
                            profile.column_above_m(ray.end_height_m()),
                            "above",
                        );
                    }
                }
            }
        }
    }
}
