//! Size distributions of spheres.

use super::MieError;
use libm::{erf, lgamma};
use std::f64::consts::{PI, SQRT_2};

/// Number distribution of radii, a density with integral 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SizeDistribution {
    /// A single radius.
    Monodisperse {
        /// Radius, micrometres.
        radius_um: f64,
    },
    /// `n(r) ~ r^alpha exp(-(alpha / gamma) (r / r_c)^gamma)`, the modified gamma distribution (Deirmendjian,
    /// *Electromagnetic Scattering on Spherical Polydispersions*, 1969, eqs. 62 and 63).
    ModifiedGamma {
        /// Power of the radius, `alpha > 0`.
        alpha: f64,
        /// Power in the exponential, `gamma > 0`.
        gamma: f64,
        /// Mode radius `r_c`, micrometres.
        mode_radius_um: f64,
    },
    /// `n(r) ~ exp(-ln^2(r / r_m) / (2 ln^2 sigma)) / r` between two radii.
    LogNormal {
        /// Median radius `r_m`, micrometres.
        median_radius_um: f64,
        /// Geometric standard deviation `sigma > 1`.
        geometric_deviation: f64,
        /// Smallest and largest radius, micrometres; 0 and infinity for the untruncated distribution.
        range_um: [f64; 2],
    },
}

/// A radius and the fraction of the number that it represents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeNode {
    /// Radius, micrometres.
    pub radius_um: f64,
    /// Fraction of all spheres; the fractions sum to 1.
    pub share: f64,
}

/// Sums are truncated where the density of the fourth moment, which determines the forward peak, has fallen to this fraction
/// of its maximum, and at the small end where that of the second moment has.
const NEGLIGIBLE: f64 = 1e-8;

/// Smallest number of radii in a sum over sizes.
pub(super) const MIN_SIZES: usize = 16;

impl SizeDistribution {
    /// The gamma distribution of Hansen (J. Atmos. Sci. 28, 1400, 1971; Hansen & Travis, Space Sci. Rev. 16, 527, 1974, eq.
    /// 2.56): `n(r) ~ r^((1 - 3 v) / v) exp(-r / (a v))` with effective radius `a` and effective variance `v`.
    pub fn gamma(effective_radius_um: f64, effective_variance: f64) -> Self {
        let (a, v) = (effective_radius_um, effective_variance);
        Self::ModifiedGamma {
            alpha: (1.0 - 3.0 * v) / v,
            gamma: 1.0,
            mode_radius_um: a * (1.0 - 3.0 * v),
        }
    }

    /// The untruncated lognormal distribution.
    pub fn log_normal(median_radius_um: f64, geometric_deviation: f64) -> Self {
        Self::LogNormal {
            median_radius_um,
            geometric_deviation,
            range_um: [0.0, f64::INFINITY],
        }
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`MieError::Sizes`] for the first parameter out of range.
    pub fn validate(&self) -> Result<(), MieError> {
        let check = |what, got: f64, least: f64, right| match got.is_finite() && got > least {
            true => Ok(()),
            false => Err(MieError::Sizes { what, got, right }),
        };
        match *self {
            Self::Monodisperse { radius_um } => check(
                "the radius (micrometres)",
                radius_um,
                0.0,
                "finite and above 0",
            ),
            Self::ModifiedGamma {
                alpha,
                gamma,
                mode_radius_um,
            } => {
                check(
                    "the power alpha of the gamma distribution",
                    alpha,
                    0.0,
                    "finite and above 0 (an effective variance below 1/3)",
                )?;
                check(
                    "the power gamma of the gamma distribution",
                    gamma,
                    0.0,
                    "finite and above 0",
                )?;
                check(
                    "the mode radius (micrometres)",
                    mode_radius_um,
                    0.0,
                    "finite and above 0",
                )
            }
            Self::LogNormal {
                median_radius_um,
                geometric_deviation,
                range_um: [least, most],
            } => {
                check(
                    "the median radius (micrometres)",
                    median_radius_um,
                    0.0,
                    "finite and above 0",
                )?;
                check(
                    "the geometric standard deviation",
                    geometric_deviation,
                    1.0,
                    "finite and above 1",
                )?;
                let right = "from 0 to below the largest radius";
                match (0.0..most).contains(&least) {
                    true => Ok(()),
                    false => Err(MieError::Sizes {
                        what: "the smallest radius (micrometres)",
                        got: least,
                        right,
                    }),
                }
            }
        }
    }

    /// Mean of a power of the radius, micrometres to that power; negative powers must keep the mean finite.
    ///
    /// Closed forms: `r_c^k (gamma / alpha)^(k / gamma) Gamma((alpha + k + 1) / gamma) / Gamma((alpha + 1) / gamma)` for the
    /// modified gamma distribution, `r_m^k exp(k^2 ln^2 sigma / 2)` for the untruncated lognormal distribution, times the ratio of
    /// two normal distributions if it is truncated.
    pub fn mean_power(&self, power: f64) -> f64 {
        match *self {
            Self::Monodisperse { radius_um } => radius_um.powf(power),
            Self::ModifiedGamma {
                alpha,
                gamma,
                mode_radius_um,
            } => {
                let scale = mode_radius_um.ln() + (gamma / alpha).ln() / gamma;
                let gammas = lgamma((alpha + power + 1.0) / gamma) - lgamma((alpha + 1.0) / gamma);
                (power * scale + gammas).exp()
            }
            Self::LogNormal {
                median_radius_um,
                geometric_deviation,
                ..
            } => {
                let width = geometric_deviation.ln();
                let whole = median_radius_um.powf(power) * (0.5 * (power * width).powi(2)).exp();
                whole * self.share_of_range(power) / self.share_of_range(0.0)
            }
        }
    }

    /// Fraction of the untruncated lognormal distribution's mean power that lies in the range.
    fn share_of_range(&self, power: f64) -> f64 {
        let Self::LogNormal {
            median_radius_um,
            geometric_deviation,
            range_um,
        } = *self
        else {
            return 1.0;
        };
        let width = geometric_deviation.ln();
        let below = |radius_um: f64| {
            let z = (radius_um / median_radius_um).ln() / width - power * width;
            0.5 * (1.0 + erf(z / SQRT_2))
        };
        below(range_um[1]) - below(range_um[0])
    }

    /// Mode radius, micrometres; for the lognormal distribution `r_m exp(-ln^2 sigma)`, clamped to its range.
    pub fn mode_radius_um(&self) -> f64 {
        match *self {
            Self::Monodisperse { radius_um } => radius_um,
            Self::ModifiedGamma { mode_radius_um, .. } => mode_radius_um,
            Self::LogNormal {
                median_radius_um,
                geometric_deviation,
                range_um: [least, most],
            } => {
                let mode_um = median_radius_um * (-geometric_deviation.ln().powi(2)).exp();
                mode_um.clamp(least, most)
            }
        }
    }

    /// Effective radius `<r^3> / <r^2>`, micrometres (Hansen & Travis 1974, eq. 2.53).
    pub fn effective_radius_um(&self) -> f64 {
        self.mean_power(3.0) / self.mean_power(2.0)
    }

    /// Effective variance `<r^4> <r^2> / <r^3>^2 - 1` (Hansen & Travis 1974, eq. 2.54).
    pub fn effective_variance(&self) -> f64 {
        let third = self.mean_power(3.0);
        self.mean_power(4.0) * self.mean_power(2.0) / (third * third) - 1.0
    }

    /// Mean volume of a sphere, um^3.
    pub(crate) fn mean_volume_um3(&self) -> f64 {
        4.0 / 3.0 * PI * self.mean_power(3.0)
    }

    /// Logarithm of the number per interval of `ln r`, up to a constant.
    fn log_density(&self, log_radius: f64) -> f64 {
        match *self {
            Self::Monodisperse { .. } => 0.0,
            Self::ModifiedGamma {
                alpha,
                gamma,
                mode_radius_um,
            } => {
                let z = log_radius - mode_radius_um.ln();
                (alpha + 1.0) * z - alpha / gamma * (gamma * z).exp()
            }
            Self::LogNormal {
                median_radius_um,
                geometric_deviation,
                ..
            } => {
                let z = (log_radius - median_radius_um.ln()) / geometric_deviation.ln();
                -0.5 * z * z
            }
        }
    }

    /// Logarithms of the radii between which spheres contribute to scattering.
    fn log_range(&self) -> [f64; 2] {
        let (center, limits) = match *self {
            Self::Monodisperse { radius_um } => return [radius_um.ln(); 2],
            Self::ModifiedGamma { mode_radius_um, .. } => {
                (mode_radius_um.ln(), [f64::NEG_INFINITY, f64::INFINITY])
            }
            Self::LogNormal {
                median_radius_um,
                range_um,
                ..
            } => (median_radius_um.ln(), range_um.map(f64::ln)),
        };
        const STEP: f64 = 1.0 / 64.0;
        // Outwards from the maximum of `power * u + log_density(u)`, which is concave.
        let end = |power: f64, direction: f64| {
            let weighted = |u: f64| power * u + self.log_density(u);
            let mut at = center;
            let mut top = weighted(at);
            while weighted(at + STEP) > top {
                at += STEP;
                top = weighted(at);
            }
            while weighted(at) > top + NEGLIGIBLE.ln() {
                at += direction * STEP;
            }
            at
        };
        [end(2.0, -1.0).max(limits[0]), end(4.0, 1.0).min(limits[1])]
    }

    /// Radii for sums over the sizes, in steps of at most `size` times the effective radius (relative to the radius far above it)
    /// and of at most `log` in the logarithm of the radius. At equal steps of
    /// `t = ln r / log + (F / size) ln(1 + r / (F r_eff))` the sum of a smooth function converges faster than any power.
    pub(super) fn nodes(&self, steps: Steps) -> Vec<SizeNode> {
        if let Self::Monodisperse { radius_um } = *self {
            return vec![SizeNode {
                radius_um,
                share: 1.0,
            }];
        }
        let [least, most] = self.log_range();
        const F: f64 = 3.0;
        let scale_um = F * self.effective_radius_um();
        let place = |u: f64| u / steps.log + F / steps.size * (u.exp() / scale_um).ln_1p();
        let per_log = |u: f64| {
            let r = u.exp();
            1.0 / steps.log + F / steps.size * r / (scale_um + r)
        };
        let (from, to) = (place(least), place(most));
        let count = (to - from).ceil().max(MIN_SIZES as f64);
        let step = (to - from) / count;
        let mut u = least;
        let mut nodes = Vec::with_capacity(count as usize);
        for i in 0..count as usize {
            let target = from + (i as f64 + 0.5) * step;
            for _ in 0..8 {
                let change = (target - place(u)) / per_log(u);
                u += change.clamp(-0.5, 0.5);
                if change.abs() < 1e-13 {
                    break;
                }
            }
            nodes.push(SizeNode {
                radius_um: u.exp(),
                share: step / per_log(u) * self.log_density(u).exp(),
            });
        }
        self.scale(nodes)
    }

    /// Normalises the fractions of the number by the mean geometric cross-section, because the smallest spheres are omitted.
    fn scale(&self, mut nodes: Vec<SizeNode>) -> Vec<SizeNode> {
        let sum: f64 = nodes
            .iter()
            .map(|node| node.share * node.radius_um * node.radius_um)
            .sum();
        let factor = self.mean_power(2.0) / sum;
        nodes.iter_mut().for_each(|node| node.share *= factor);
        nodes
    }
}

/// Largest steps of a sum over sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steps {
    /// Step of the radius, relative to the effective radius.
    pub size: f64,
    /// Step of the logarithm of the radius.
    pub log: f64,
}

impl Steps {
    /// Steps wider by a factor.
    pub fn times(self, factor: f64) -> Self {
        Self {
            size: factor * self.size,
            log: factor * self.log,
        }
    }
}

#[cfg(test)]
mod tests;
