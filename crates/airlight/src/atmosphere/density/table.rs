//! [`AltitudeTable`]: densities tabulated by altitude.

use super::error::DensityError;
use crate::math::exponentials::count_exponentials;
use crate::math::interpolation::lerp;
use crate::names::named;

/// Interpolation between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// Linear in the density.
    Linear,
    /// Linear in the logarithm of the density; linear in the density next to a sample that is 0.
    LogLinear,
}

named! { Interpolation, "an interpolation", [
    ("linear", (Linear), "linear in the density"),
    ("log-linear", (LogLinear), "linear in the logarithm of the density"),
] }

/// Densities at strictly increasing altitudes: the first value below the first altitude, 0 above the last.
#[derive(Clone, Debug, PartialEq)]
pub struct AltitudeTable {
    altitudes_m: Vec<f64>,
    densities: Vec<f64>,
    interpolation: Interpolation,
}

impl AltitudeTable {
    /// A table of densities at altitudes, m.
    ///
    /// # Errors
    /// [`DensityError`] if altitudes do not increase, the lengths differ, or a density is negative or not finite.
    pub fn new(
        altitudes_m: Vec<f64>,
        densities: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, DensityError> {
        if altitudes_m.len() < 2 {
            return Err(DensityError::Altitudes {
                index: altitudes_m.len(),
                value: f64::NAN,
            });
        }
        for (index, &value) in altitudes_m.iter().enumerate() {
            if !value.is_finite() || (index > 0 && value <= altitudes_m[index - 1]) {
                return Err(DensityError::Altitudes { index, value });
            }
        }
        if altitudes_m.len() != densities.len() {
            return Err(DensityError::Length {
                altitudes: altitudes_m.len(),
                densities: densities.len(),
            });
        }
        if let Some(index) = densities.iter().position(|d| !(d.is_finite() && *d >= 0.0)) {
            return Err(DensityError::Negative {
                index,
                value: densities[index],
            });
        }
        Ok(Self {
            altitudes_m,
            densities,
            interpolation,
        })
    }

    /// Altitudes of the samples, m.
    pub fn altitudes_m(&self) -> &[f64] {
        &self.altitudes_m
    }

    /// Densities at the altitudes.
    pub fn densities(&self) -> &[f64] {
        &self.densities
    }

    pub(super) fn at(&self, z: f64) -> f64 {
        let above = self.altitudes_m.partition_point(|&a| a <= z);
        let last = self.altitudes_m.len() - 1;
        if above == 0 {
            return self.densities[0];
        }
        if above > last {
            return if z == self.altitudes_m[last] {
                self.densities[last]
            } else {
                0.0
            };
        }
        let (z0, z1) = (self.altitudes_m[above - 1], self.altitudes_m[above]);
        let (d0, d1) = (self.densities[above - 1], self.densities[above]);
        let t = (z - z0) / (z1 - z0);
        match self.is_log(d0, d1) {
            true => {
                count_exponentials(2);
                d0 * (t * (d1 / d0).ln()).exp()
            }
            false => lerp(d0, d1, t),
        }
    }

    fn is_log(&self, d0: f64, d1: f64) -> bool {
        self.interpolation == Interpolation::LogLinear && d0 > 0.0 && d1 > 0.0
    }

    /// Integral of the density between two altitudes, m.
    pub(super) fn column_m(&self, from: f64, to: f64) -> f64 {
        let last = self.altitudes_m.len() - 1;
        // Without density below the table nothing is added, not even of an infinite height.
        let mut sum = match self.densities[0] > 0.0 {
            true => (self.altitudes_m[0].min(to) - from).max(0.0) * self.densities[0],
            false => 0.0,
        };
        for i in 0..last {
            let (a, b) = (
                self.altitudes_m[i].max(from),
                self.altitudes_m[i + 1].min(to),
            );
            if b <= a {
                continue;
            }
            let (d0, d1) = (self.densities[i], self.densities[i + 1]);
            let width = self.altitudes_m[i + 1] - self.altitudes_m[i];
            sum += match self.is_log(d0, d1) {
                true => {
                    let x = (d1 / d0).ln() * (b - a) / width;
                    let mean = if x.abs() < 1e-12 { 1.0 } else { x.exp_m1() / x };
                    let start = d0 * ((a - self.altitudes_m[i]) / width * (d1 / d0).ln()).exp();
                    (b - a) * start * mean
                }
                false => (b - a) * (d0 + (d1 - d0) * (0.5 * (a + b) - self.altitudes_m[i]) / width),
            };
        }
        sum
    }

    /// Intervals of height, in increasing order, in which the density is linear or varies by less than a factor of e.
    pub(super) fn ramps_m(&self) -> Vec<[f64; 2]> {
        let samples = self.altitudes_m.windows(2).zip(self.densities.windows(2));
        samples
            .flat_map(|(z, d)| {
                let folds = match self.is_log(d[0], d[1]) {
                    true => (d[1] / d[0]).ln().abs().ceil().clamp(1.0, 64.0),
                    false => 1.0,
                };
                let edge = move |i: u32| z[0] + (z[1] - z[0]) * f64::from(i) / folds;
                (0..folds as u32).map(move |i| [edge(i), edge(i + 1)])
            })
            .collect()
    }

    /// The same samples at altitudes that are `by_m` higher.
    pub(super) fn raised(&self, by_m: f64) -> Self {
        Self {
            altitudes_m: self.altitudes_m.iter().map(|z| z + by_m).collect(),
            ..self.clone()
        }
    }
}
