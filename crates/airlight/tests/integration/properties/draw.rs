//! Random valid inputs.

use airlight::SplitMix64;
use airlight::atmosphere::{DensityProfile, Interpolation};
use airlight::axes;
use airlight::fog::{Ground, RgbLayer};
use airlight::optics::{Depolarization, PhaseFunction};
use glam::DVec3;
use std::ops::{Deref, DerefMut};

/// Random numbers, and inputs from them.
pub struct Draw(SplitMix64);

impl Deref for Draw {
    type Target = SplitMix64;

    fn deref(&self) -> &SplitMix64 {
        &self.0
    }
}

impl DerefMut for Draw {
    fn deref_mut(&mut self) -> &mut SplitMix64 {
        &mut self.0
    }
}

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::scrambled(seed))
    }

    /// A direction: level, vertical, close to level, or anywhere.
    pub fn direction(&mut self) -> DVec3 {
        let azimuth = self.between(0.0, 360.0);
        let elevation = match self.below(6) {
            0 => 0.0,
            1 => self.pick(&[-90.0, 90.0]),
            2 => self.pick(&[-1.0, 1.0]) * self.scale(1e-6, 1.0),
            _ => self.between(-1.0, 1.0).asin().to_degrees(),
        };
        axes::direction(azimuth, elevation)
    }

    /// A length in metres.
    pub fn length_m(&mut self) -> f64 {
        self.scale(1e-3, 1e6)
    }

    /// A height from the bottom of a valley to the highest clouds, m.
    pub fn height_m(&mut self) -> f64 {
        match self.below(4) {
            0 => self.pick(&[0.0, 1.7, 20.0]),
            1 => -self.scale(0.1, 5e3),
            _ => self.scale(0.1, 2e4),
        }
    }

    pub fn phase(&mut self) -> PhaseFunction {
        match self.below(4) {
            0 => PhaseFunction::Isotropic,
            1 => PhaseFunction::Rayleigh(Depolarization::None),
            2 => PhaseFunction::draine(self.between(0.0, 0.9), self.scale(0.01, 100.0)).unwrap(),
            _ => PhaseFunction::henyey_greenstein(self.between(-0.9, 0.98)).unwrap(),
        }
    }

    /// Strictly increasing heights, m.
    fn heights_m<const N: usize>(&mut self) -> [f64; N] {
        let mut height = self.height_m();
        std::array::from_fn(|_| {
            height += self.scale(0.1, 3e3);
            height
        })
    }

    pub fn density(&mut self) -> DensityProfile {
        match self.below(9) {
            0 => DensityProfile::Uniform,
            1 | 2 => DensityProfile::Exponential {
                reference_height_m: self.height_m(),
                scale_height_m: self.scale(0.1, 1e5),
            },
            3 | 4 => DensityProfile::Clamped {
                base_height_m: self.height_m(),
                scale_height_m: self.scale(0.1, 1e5),
            },
            5 => DensityProfile::slab(self.height_m()),
            6 => {
                let [bottom_m, top_m] = self.heights_m();
                DensityProfile::Layer { bottom_m, top_m }
            }
            7 => {
                let [bottom_m, peak_m, top_m] = self.heights_m();
                DensityProfile::Tent {
                    bottom_m,
                    peak_m,
                    top_m,
                }
            }
            _ => {
                let heights = self.heights_m::<4>();
                let densities = heights.map(|_| match self.chance(0.2) {
                    true => 0.0,
                    false => self.scale(1e-3, 1.0),
                });
                let kind = self.pick(&[Interpolation::Linear, Interpolation::LogLinear]);
                DensityProfile::tabulated(heights.to_vec(), densities.to_vec(), kind).unwrap()
            }
        }
    }

    /// One layer, or up to `more` more.
    pub fn layers(&mut self, more: usize) -> Vec<RgbLayer> {
        (0..=self.below(more + 1))
            .map(|_| {
                let density = self.density();
                self.layer(density)
            })
            .collect()
    }

    pub fn layer(&mut self, density: DensityProfile) -> RgbLayer {
        let extinction = self.scale(1e-8, 10.0) as f32;
        let albedo = match self.below(4) {
            0 => 1.0,
            1 => 0.0,
            _ => self.unit() as f32,
        };
        RgbLayer {
            density,
            extinction_per_m: [extinction, 1.2 * extinction, 0.0],
            single_scattering_albedo: [albedo, 0.9 * albedo, albedo],
            phase: self.phase(),
        }
    }

    pub fn ground(&mut self) -> Ground {
        match self.below(3) {
            0 => Ground::FLAT,
            1 => Ground::EARTH,
            _ => Ground {
                height_m: self.between(-10.0, 10.0),
                radius_m: self.scale(1e5, 1e8),
            },
        }
    }
}
