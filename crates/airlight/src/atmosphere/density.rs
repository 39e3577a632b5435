//! How dense a constituent is at an altitude, relative to the density its coefficients are stated for.

use super::standard_air;
use crate::math::quadrature::FixedRule;

/// Relative density as a function of the altitude above the planet's radius, m.
#[derive(Clone, Debug, PartialEq)]
pub enum DensityProfile {
    /// `exp(-altitude / H)`; goes on rising below altitude 0.
    Exponential {
        /// Height in which the density falls by e, m, positive.
        scale_height_m: f64,
    },
    /// 1 from `bottom_m` up to `top_m`, 0 elsewhere.
    Layer {
        /// Lower edge, m.
        bottom_m: f64,
        /// Upper edge, m.
        top_m: f64,
    },
    /// Rises linearly from 0 at `bottom_m` to 1 at `peak_m`, falls to 0 at `top_m`; 0 elsewhere.
    Tent {
        /// Where it begins, m.
        bottom_m: f64,
        /// Where it is 1, m.
        peak_m: f64,
        /// Where it ends, m.
        top_m: f64,
    },
    /// Number density of air in the U.S. Standard Atmosphere 1976, 1 at sea level, by the standard's layer formulas
    /// (to 1e-4 of its tables up to 86 km; from there to 100 km one exponential, within 1 %).
    StandardAir1976,
    /// Given at altitudes: the first value below the first altitude, **0 above the last**.
    Tabulated(AltitudeTable),
    /// A sum of profiles, each with its factor.
    Sum(Vec<(f64, DensityProfile)>),
}

/// How a table goes from one sample to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Straight lines in the logarithm; linear next to a sample that is 0.
    LogLinear,
}

/// Densities at strictly rising altitudes.
#[derive(Clone, Debug, PartialEq)]
pub struct AltitudeTable {
    altitudes_m: Vec<f64>,
    densities: Vec<f64>,
    interpolation: Interpolation,
}

/// Why numbers do not make a density profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DensityError {
    /// A scale height that is not positive and finite.
    #[error("a scale height must be positive and finite, got {0} m")]
    ScaleHeight(f64),
    /// Edges out of order, or not finite.
    #[error("the altitudes of a layer must be finite and rise from bottom to top, got {0:?} m")]
    Edges(Vec<f64>),
    /// Altitudes of a table not strictly increasing, or fewer than two.
    #[error(
        "a table needs two or more finite, strictly rising altitudes: entry {index} is {value} m"
    )]
    Altitudes {
        /// Which entry, counted from 0.
        index: usize,
        /// Its altitude (not a number where it is missing).
        value: f64,
    },
    /// Not one density for each altitude.
    #[error("a table of {altitudes} altitudes needs as many densities, got {densities}")]
    Length {
        /// Number of altitudes.
        altitudes: usize,
        /// Number of densities.
        densities: usize,
    },
    /// A density or factor that is negative or not finite.
    #[error("densities and factors must be finite and not negative: entry {index} is {value}")]
    Negative {
        /// Which entry, counted from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
}

impl DensityProfile {
    /// A table of densities. See [`DensityProfile::Tabulated`] for what holds beyond its ends.
    ///
    /// # Errors
    /// As [`AltitudeTable::new`].
    pub fn tabulated(
        altitudes_m: Vec<f64>,
        densities: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Self, DensityError> {
        AltitudeTable::new(altitudes_m, densities, interpolation).map(Self::Tabulated)
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// The first one that is out of its domain.
    pub fn validate(&self) -> Result<(), DensityError> {
        let rising = |edges: &[f64]| match edges.iter().all(|e| e.is_finite())
            && edges.windows(2).all(|w| w[0] <= w[1])
        {
            true => Ok(()),
            false => Err(DensityError::Edges(edges.to_vec())),
        };
        match self {
            Self::Exponential { scale_height_m } => {
                match scale_height_m.is_finite() && *scale_height_m > 0.0 {
                    true => Ok(()),
                    false => Err(DensityError::ScaleHeight(*scale_height_m)),
                }
            }
            Self::Layer { bottom_m, top_m } => rising(&[*bottom_m, *top_m]),
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => rising(&[*bottom_m, *peak_m, *top_m]),
            Self::StandardAir1976 | Self::Tabulated(_) => Ok(()),
            Self::Sum(parts) => {
                for (index, (factor, part)) in parts.iter().enumerate() {
                    if !(factor.is_finite() && *factor >= 0.0) {
                        return Err(DensityError::Negative {
                            index,
                            value: *factor,
                        });
                    }
                    part.validate()?;
                }
                Ok(())
            }
        }
    }

    /// The relative density at an altitude, m.
    pub fn at(&self, altitude_m: f64) -> f64 {
        let z = altitude_m;
        match self {
            Self::Exponential { scale_height_m } => (-z / scale_height_m).exp(),
            Self::Layer { bottom_m, top_m } => match z >= *bottom_m && z < *top_m {
                true => 1.0,
                false => 0.0,
            },
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => {
                if z <= *bottom_m || z >= *top_m {
                    // A tent whose peak is its edge is 1 there.
                    if z == *peak_m { 1.0 } else { 0.0 }
                } else if z < *peak_m {
                    (z - bottom_m) / (peak_m - bottom_m)
                } else {
                    (top_m - z) / (top_m - peak_m)
                }
            }
            Self::StandardAir1976 => standard_air::relative_density(z),
            Self::Tabulated(table) => table.at(z),
            Self::Sum(parts) => parts.iter().map(|(factor, part)| factor * part.at(z)).sum(),
        }
    }

    /// Integral of the relative density over altitude, m: the length of a column of density 1 that holds as much.
    /// 0 where the top is not above the start. Closed forms; the standard atmosphere by quadrature to 1e-10.
    pub fn column_m(&self, from_altitude_m: f64, top_altitude_m: f64) -> f64 {
        let (a, b) = (from_altitude_m, top_altitude_m);
        if b <= a || a.is_nan() || b.is_nan() {
            return 0.0;
        }
        match self {
            Self::Exponential { scale_height_m: h } => {
                -h * (-a / h).exp() * (-(b - a) / h).exp_m1()
            }
            Self::Layer { bottom_m, top_m } => (b.min(*top_m) - a.max(*bottom_m)).max(0.0),
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => {
                let ramp = |from: f64, to: f64| match to > from {
                    // Mean density of a linear stretch is the density at its middle.
                    true => (to - from) * self.at(0.5 * (from + to)),
                    false => 0.0,
                };
                ramp(a.max(*bottom_m), b.min(*peak_m)) + ramp(a.max(*peak_m), b.min(*top_m))
            }
            Self::StandardAir1976 => {
                static RULE: FixedRule<16> = FixedRule::fixed();
                let kinks: Vec<f64> = standard_air::kinks_m().collect();
                RULE.integrate_between(a, b, &kinks, |z| self.at(z))
            }
            Self::Tabulated(table) => table.column(a, b),
            Self::Sum(parts) => parts
                .iter()
                .map(|(factor, part)| factor * part.column_m(a, b))
                .sum(),
        }
    }

    /// Altitudes at which the profile has a kink or a jump, m, rising: edges for quadrature panels. Of the standard
    /// atmosphere only the tropopause.
    pub fn breakpoints_m(&self) -> Vec<f64> {
        let mut all = match self {
            Self::Exponential { .. } => vec![],
            Self::Layer { bottom_m, top_m } => vec![*bottom_m, *top_m],
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => vec![*bottom_m, *peak_m, *top_m],
            // The other kinks change the slope by less than 10 %: not worth a panel edge each.
            Self::StandardAir1976 => standard_air::kinks_m().skip(1).take(1).collect(),
            Self::Tabulated(table) => table.altitudes_m.clone(),
            Self::Sum(parts) => parts
                .iter()
                .flat_map(|(_, part)| part.breakpoints_m())
                .collect(),
        };
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The smallest height over which the profile changes much, m: a bound for the width of quadrature panels between
    /// breakpoints (the scale height of an exponential, the width of a layer).
    pub fn scale_m(&self) -> f64 {
        match self {
            Self::Exponential { scale_height_m } => *scale_height_m,
            Self::Layer { bottom_m, top_m } => top_m - bottom_m,
            Self::Tent {
                bottom_m, top_m, ..
            } => 0.5 * (top_m - bottom_m),
            Self::StandardAir1976 => 6000.0,
            Self::Tabulated(table) => table.scale_m(),
            Self::Sum(parts) => parts
                .iter()
                .map(|(_, part)| part.scale_m())
                .fold(f64::INFINITY, f64::min),
        }
    }
}

impl AltitudeTable {
    /// Checks and takes the samples.
    ///
    /// # Errors
    /// [`DensityError`] where altitudes do not rise, the lengths differ or a density is negative or not finite.
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

    /// Where the samples lie, m.
    pub fn altitudes_m(&self) -> &[f64] {
        &self.altitudes_m
    }

    /// The samples.
    pub fn densities(&self) -> &[f64] {
        &self.densities
    }

    fn at(&self, z: f64) -> f64 {
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
            true => d0 * (t * (d1 / d0).ln()).exp(),
            false => d0 * (1.0 - t) + d1 * t,
        }
    }

    fn is_log(&self, d0: f64, d1: f64) -> bool {
        self.interpolation == Interpolation::LogLinear && d0 > 0.0 && d1 > 0.0
    }

    fn column(&self, from: f64, to: f64) -> f64 {
        let last = self.altitudes_m.len() - 1;
        let mut sum = (self.altitudes_m[0].min(to) - from).max(0.0) * self.densities[0];
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

    fn scale_m(&self) -> f64 {
        let span = self.altitudes_m[self.altitudes_m.len() - 1] - self.altitudes_m[0];
        let samples = self.altitudes_m.windows(2).zip(self.densities.windows(2));
        samples
            .filter(|(_, d)| self.is_log(d[0], d[1]) && d[0] != d[1])
            .map(|(z, d)| (z[1] - z[0]) / (d[1] / d[0]).ln().abs())
            .fold(span, f64::min)
    }
}

#[cfg(test)]
mod tests;
