//! [`DensityProfile`]: relative density by height, for all constituents from molecules to fog.
//!
//! Heights are altitudes above the planet's radius in an [`Atmosphere`](super::Atmosphere), and heights above the zero of the
//! scene in a fog. Each behaviour of a profile is one `match` in this file; other code that depends on the shape of a profile
//! uses its [`HeightStructure`].

mod column;
mod error;
mod table;

pub use error::DensityError;
pub use table::{AltitudeTable, Interpolation};

use super::ray_segment::RaySegment;
use super::standard_air;
use crate::math::quadrature::FixedRule;
use column::decayed;

/// Relative density of a constituent as a function of height: a factor on its coefficients.
///
/// Densities of exponential profiles are limited to `e^57`, 6e24, which is opaque: deep below the reference height neither a
/// density nor a column overflows.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DensityProfile {
    /// 1 at all heights.
    Uniform,
    /// `e^-((height - reference) / H)` at all heights: exponential height fog (Ishiyama 2018, eq. 7 with reference 0).
    Exponential {
        /// Height at which the density is 1, m.
        reference_height_m: f64,
        /// Height `H` over which the density falls by a factor e, m, above 0.
        scale_height_m: f64,
    },
    /// 1 up to the base, `e^-((height - base) / H)` above: `e^-(f max(0, y - h0))` of the fog note, with falloff `f = 1 / H`.
    Clamped {
        /// Height up to which the density is 1, m.
        base_height_m: f64,
        /// Height `H` over which the density falls by a factor e above the base, m, above 0.
        scale_height_m: f64,
    },
    /// 1 from `bottom_m` up to `top_m`, 0 elsewhere.
    Layer {
        /// Lower edge, m; minus infinity for a layer without one ([`DensityProfile::slab`]).
        bottom_m: f64,
        /// Upper edge, m.
        top_m: f64,
    },
    /// Rises linearly from 0 at `bottom_m` to 1 at `peak_m`, falls linearly to 0 at `top_m`; 0 elsewhere.
    Tent {
        /// Lower edge, m.
        bottom_m: f64,
        /// Height of density 1, m.
        peak_m: f64,
        /// Upper edge, m.
        top_m: f64,
    },
    /// Number density of air in the U.S. Standard Atmosphere 1976, 1 at sea level, by the standard's layer formulas
    /// (to 1e-4 of its tables up to 86 km; from there to 100 km one exponential, within 1 %).
    StandardAir1976,
    /// A table by altitude: the first value below the first altitude, **0 above the last**.
    Tabulated(AltitudeTable),
    /// A weighted sum of profiles.
    Sum(Vec<(f64, DensityProfile)>),
}

/// Features of a profile that quadrature over height or along a ray has to resolve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HeightStructure {
    /// Heights of kinks and jumps, in increasing order, m.
    pub kinks_m: Vec<f64>,
    /// Exponential decays with height.
    pub decays: Vec<Decay>,
    /// Other intervals of height, in increasing order, in which the density is linear or varies by less than a factor of e, m.
    pub ramps_m: Vec<[f64; 2]>,
    /// Height above which the density is 0, m; infinite if there is none.
    pub top_m: f64,
}

/// An exponential decay with height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Decay {
    /// Height above which the density decays, m; minus infinity if it does at all heights.
    pub from_m: f64,
    /// Height at which the density is 1, m.
    pub reference_height_m: f64,
    /// Height over which it falls by a factor e, m.
    pub scale_height_m: f64,
}

impl HeightStructure {
    /// Kinks that are not the start of an exponential decay, m.
    pub fn other_kinks_m(&self) -> impl Iterator<Item = f64> + '_ {
        let begins = |kink: &f64| self.decays.iter().any(|decay| decay.from_m == *kink);
        self.kinks_m
            .iter()
            .copied()
            .filter(move |kink| !begins(kink))
    }
}

impl DensityProfile {
    /// `e^-(height / H)`.
    pub const fn exponential(scale_height_m: f64) -> Self {
        Self::Exponential {
            reference_height_m: 0.0,
            scale_height_m,
        }
    }

    /// 1 below `top_m`, 0 above: a [`DensityProfile::Layer`] without a lower edge, such as the fog of Klassen 1987.
    pub const fn slab(top_m: f64) -> Self {
        Self::Layer {
            bottom_m: f64::NEG_INFINITY,
            top_m,
        }
    }

    /// Height of the top of a slab ([`DensityProfile::slab`]), m; `None` for other profiles.
    pub(crate) fn slab_top_m(&self) -> Option<f64> {
        match *self {
            Self::Layer { bottom_m, top_m } if bottom_m == f64::NEG_INFINITY => Some(top_m),
            _ => None,
        }
    }

    /// A clamped profile with this falloff (1/m), the inverse of the scale height: uniform for 0, a slab for infinity.
    ///
    /// # Errors
    /// [`DensityError`] for a falloff that is negative or NaN, or a base that is not finite.
    pub fn from_falloff(base_height_m: f64, falloff_per_m: f64) -> Result<Self, DensityError> {
        let profile = if falloff_per_m == 0.0 {
            Self::Uniform
        } else if falloff_per_m == f64::INFINITY {
            Self::slab(base_height_m)
        } else {
            Self::Clamped {
                base_height_m,
                scale_height_m: 1.0 / falloff_per_m,
            }
        };
        profile.validate().map(|()| profile)
    }

    /// A table of densities by altitude (m).
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

    /// Whether the density is the same at all heights.
    #[inline]
    pub fn is_uniform(&self) -> bool {
        matches!(self, Self::Uniform)
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`DensityError`] for the first parameter out of range.
    pub fn validate(&self) -> Result<(), DensityError> {
        let scale = |scale_height_m: f64| match scale_height_m.is_finite() && scale_height_m > 0.0 {
            true => Ok(()),
            false => Err(DensityError::ScaleHeight(scale_height_m)),
        };
        let height = |which, got_m: f64| match got_m.is_finite() {
            true => Ok(()),
            false => Err(DensityError::Height { which, got_m }),
        };
        let rising = |edges: &[f64]| match edges.iter().all(|e| e.is_finite())
            && edges.windows(2).all(|w| w[0] <= w[1])
        {
            true => Ok(()),
            false => Err(DensityError::Edges(edges.to_vec())),
        };
        match *self {
            Self::Uniform | Self::StandardAir1976 | Self::Tabulated(_) => Ok(()),
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => height("reference height", reference_height_m).and(scale(scale_height_m)),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => height("base height", base_height_m).and(scale(scale_height_m)),
            Self::Layer {
                bottom_m: f64::NEG_INFINITY,
                top_m,
            } => height("top height", top_m),
            Self::Layer { bottom_m, top_m } => rising(&[bottom_m, top_m]),
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => rising(&[bottom_m, peak_m, top_m]),
            Self::Sum(ref parts) => {
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

    /// Relative density at a height, m.
    #[inline]
    pub fn at(&self, height_m: f64) -> f64 {
        let z = height_m;
        match *self {
            Self::Uniform => 1.0,
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => decayed((z - reference_height_m) / scale_height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => decayed((z - base_height_m).max(0.0) / scale_height_m),
            Self::Layer { bottom_m, top_m } => f64::from(z >= bottom_m && z < top_m),
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => {
                if z <= bottom_m || z >= top_m {
                    // 1 at a peak that is also an edge.
                    f64::from(z == peak_m)
                } else if z < peak_m {
                    (z - bottom_m) / (peak_m - bottom_m)
                } else {
                    (top_m - z) / (top_m - peak_m)
                }
            }
            Self::StandardAir1976 => standard_air::relative_density(z),
            Self::Tabulated(ref table) => table.at(z),
            Self::Sum(ref parts) => parts.iter().map(|(factor, part)| factor * part.at(z)).sum(),
        }
    }

    /// Upper bound of the density at and above a height, m.
    pub(crate) fn max_above(&self, height_m: f64) -> f64 {
        let z = height_m;
        match *self {
            Self::Uniform
            | Self::Exponential { .. }
            | Self::Clamped { .. }
            | Self::StandardAir1976 => self.at(z),
            Self::Layer { top_m, .. } => f64::from(z < top_m),
            Self::Tent { peak_m, .. } => self.at(z.max(peak_m)),
            Self::Tabulated(ref table) => {
                let samples = table.altitudes_m().iter().zip(table.densities());
                samples
                    .filter(|(altitude, _)| **altitude > z)
                    .fold(table.at(z), |most, (_, density)| most.max(*density))
            }
            Self::Sum(ref parts) => parts
                .iter()
                .map(|(factor, part)| factor * part.max_above(z))
                .sum(),
        }
    }

    /// Integral of the density over height, m; 0 if the top is not above the start. Closed forms; the standard atmosphere by
    /// quadrature to 1e-10.
    pub fn column_m(&self, from_height_m: f64, top_height_m: f64) -> f64 {
        let (a, b) = (from_height_m, top_height_m);
        if b <= a || a.is_nan() || b.is_nan() {
            return 0.0;
        }
        match *self {
            Self::Uniform => b - a,
            Self::Exponential {
                reference_height_m,
                scale_height_m: h,
            } => -h * decayed((a - reference_height_m) / h) * (-(b - a) / h).exp_m1(),
            Self::Clamped {
                base_height_m,
                scale_height_m: h,
            } => {
                let (from, to) = (a.max(base_height_m), b.max(base_height_m));
                let falling = match to > from {
                    true => -h * decayed((from - base_height_m) / h) * (-(to - from) / h).exp_m1(),
                    false => 0.0,
                };
                (b.min(base_height_m) - a).max(0.0) + falling
            }
            Self::Layer { bottom_m, top_m } => (b.min(top_m) - a.max(bottom_m)).max(0.0),
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => {
                let ramp = |from: f64, to: f64| match to > from {
                    // The mean density of a linear ramp is that at its middle.
                    true => (to - from) * self.at(0.5 * (from + to)),
                    false => 0.0,
                };
                ramp(a.max(bottom_m), b.min(peak_m)) + ramp(a.max(peak_m), b.min(top_m))
            }
            Self::StandardAir1976 => {
                static RULE: FixedRule<16> = FixedRule::fixed();
                let kinks: Vec<f64> = standard_air::kinks_m().collect();
                let end = b.min(standard_air::END_M).max(a);
                RULE.integrate_between(a, end, &kinks, |z| self.at(z))
            }
            Self::Tabulated(ref table) => table.column_m(a, b),
            Self::Sum(ref parts) => parts
                .iter()
                .filter(|(factor, _)| *factor > 0.0)
                .map(|(factor, part)| factor * part.column_m(a, b))
                .sum(),
        }
    }

    /// Integral of the density above a height (m), m; infinite for [`DensityProfile::Uniform`].
    #[inline]
    pub fn column_above_m(&self, height_m: f64) -> f64 {
        match *self {
            Self::Uniform => f64::INFINITY,
            Self::Exponential { scale_height_m, .. } => scale_height_m * self.at(height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => (base_height_m - height_m).max(0.0) + scale_height_m * self.at(height_m),
            _ => self.column_m(height_m, f64::INFINITY),
        }
    }

    /// Integral of the density along a ray, m. Closed forms with a relative error below 1e-12 for rays of any length, height
    /// and slope; for tents, tables and the standard atmosphere Gauss-Legendre quadrature to 1e-9.
    #[inline]
    pub fn column_along_m(&self, ray: &RaySegment) -> f64 {
        match *self {
            Self::Uniform => ray.length_m,
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => column::exponential(ray, reference_height_m, scale_height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => column::clamped(ray, base_height_m, scale_height_m),
            Self::Layer { bottom_m, top_m } => column::layer(ray, bottom_m, top_m),
            Self::Tent { .. } | Self::StandardAir1976 | Self::Tabulated(_) => {
                by_quadrature(self, ray)
            }
            Self::Sum(ref parts) => parts
                .iter()
                .filter(|(factor, _)| *factor > 0.0)
                .map(|(factor, part)| factor * part.column_along_m(ray))
                .sum(),
        }
    }

    /// Terms of a sum with their factors, resolving nested sums; the profile itself if it is not a sum.
    pub(crate) fn terms(&self) -> Vec<(f64, &Self)> {
        match self {
            Self::Sum(parts) => {
                let terms = parts.iter().flat_map(|(factor, part)| {
                    let terms = part.terms().into_iter();
                    terms.map(move |(inner, profile)| (factor * inner, profile))
                });
                terms.collect()
            }
            _ => vec![(1.0, self)],
        }
    }

    /// Features of the profile.
    pub(crate) fn structure(&self) -> HeightStructure {
        let smooth = HeightStructure {
            kinks_m: Vec::new(),
            decays: Vec::new(),
            ramps_m: Vec::new(),
            top_m: f64::INFINITY,
        };
        let decay = |from_m, reference_height_m, scale_height_m| {
            vec![Decay {
                from_m,
                reference_height_m,
                scale_height_m,
            }]
        };
        match *self {
            Self::Uniform => smooth,
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => HeightStructure {
                decays: decay(f64::NEG_INFINITY, reference_height_m, scale_height_m),
                ..smooth
            },
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => HeightStructure {
                kinks_m: vec![base_height_m],
                decays: decay(base_height_m, base_height_m, scale_height_m),
                ..smooth
            },
            Self::Layer { bottom_m, top_m } => HeightStructure {
                kinks_m: [bottom_m, top_m]
                    .into_iter()
                    .filter(|z| z.is_finite())
                    .collect(),
                top_m,
                ..smooth
            },
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => HeightStructure {
                kinks_m: vec![bottom_m, peak_m, top_m],
                ramps_m: vec![[bottom_m, peak_m], [peak_m, top_m]],
                top_m,
                ..smooth
            },
            Self::StandardAir1976 => HeightStructure {
                // The other kinks change the slope by less than 10 % and are ignored.
                kinks_m: standard_air::kinks_m().skip(1).take(1).collect(),
                ramps_m: standard_air::ramps_m(),
                top_m: standard_air::END_M,
                ..smooth
            },
            Self::Tabulated(ref table) => HeightStructure {
                kinks_m: table.altitudes_m().to_vec(),
                ramps_m: table.ramps_m(),
                top_m: table.altitudes_m()[table.altitudes_m().len() - 1],
                ..smooth
            },
            Self::Sum(ref parts) => {
                let mut sum = HeightStructure {
                    top_m: f64::NEG_INFINITY,
                    ..smooth
                };
                for (_, part) in parts {
                    let part = part.structure();
                    sum.kinks_m.extend(part.kinks_m);
                    sum.decays.extend(part.decays);
                    sum.ramps_m.extend(part.ramps_m);
                    sum.top_m = sum.top_m.max(part.top_m);
                }
                sum.kinks_m.sort_by(f64::total_cmp);
                sum.kinks_m.dedup();
                sum.ramps_m.sort_by(|a, b| a[0].total_cmp(&b[0]));
                sum
            }
        }
    }

    /// Heights of kinks and jumps, in increasing order, m: edges for quadrature panels. For the standard atmosphere only the
    /// tropopause.
    pub(crate) fn breakpoints_m(&self) -> Vec<f64> {
        let mut all = self.structure().kinks_m;
        all.dedup();
        all
    }

    /// The same profile with every height raised by `by_m`, to convert heights above ground to altitudes. `None` for
    /// [`DensityProfile::StandardAir1976`], which is tied to sea level.
    pub fn raised(&self, by_m: f64) -> Option<Self> {
        Some(match *self {
            Self::Uniform => Self::Uniform,
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => Self::Exponential {
                reference_height_m: reference_height_m + by_m,
                scale_height_m,
            },
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => Self::Clamped {
                base_height_m: base_height_m + by_m,
                scale_height_m,
            },
            Self::Layer { bottom_m, top_m } => Self::Layer {
                bottom_m: bottom_m + by_m,
                top_m: top_m + by_m,
            },
            Self::Tent {
                bottom_m,
                peak_m,
                top_m,
            } => Self::Tent {
                bottom_m: bottom_m + by_m,
                peak_m: peak_m + by_m,
                top_m: top_m + by_m,
            },
            Self::StandardAir1976 => return None,
            Self::Tabulated(ref table) => Self::Tabulated(table.raised(by_m)),
            Self::Sum(ref parts) => Self::Sum(
                parts
                    .iter()
                    .map(|(factor, part)| Some((*factor, part.raised(by_m)?)))
                    .collect::<Option<_>>()?,
            ),
        })
    }
}

/// Column along a ray by quadrature between the heights of the profile's ramps. Density is constant below the first and 0 above
/// the last.
fn by_quadrature(profile: &DensityProfile, ray: &RaySegment) -> f64 {
    let ramps = profile.structure().ramps_m;
    let Some(&[lowest_m, _]) = ramps.first() else {
        return 0.0;
    };
    let (mut enter, mut leave) = ray.below(lowest_m);
    let below = profile.at(lowest_m - 1.0);
    let mut sum = match enter < leave && below > 0.0 {
        true => below * (leave - enter),
        false => 0.0,
    };
    let within = |from: f64, to: f64| match to > from {
        true => column::RULE.integrate(from, to, |s| profile.at(ray.height_at(s))),
        false => 0.0,
    };
    for &[_, height_m] in &ramps {
        let (first, last) = ray.below(height_m);
        sum += match enter < leave {
            true => within(first, enter) + within(leave, last),
            false => within(first, last),
        };
        (enter, leave) = (first, last);
    }
    sum
}

/// Profiles of every variant, for the tests: columns and bounds are compared with quadrature.
#[cfg(test)]
fn profiles() -> Vec<DensityProfile> {
    let tent = DensityProfile::Tent {
        bottom_m: 10e3,
        peak_m: 25e3,
        top_m: 40e3,
    };
    let layer = DensityProfile::Layer {
        bottom_m: 2e3,
        top_m: 3e3,
    };
    let table = |kind| {
        DensityProfile::tabulated(vec![0.0, 1e3, 4e3, 5e3], vec![1.0, 0.8, 0.1, 0.0], kind).unwrap()
    };
    vec![
        DensityProfile::exponential(8e3),
        DensityProfile::StandardAir1976,
        table(Interpolation::Linear),
        table(Interpolation::LogLinear),
        DensityProfile::Sum(vec![(0.5, tent.clone()), (2.0, layer.clone())]),
        tent,
        layer,
        DensityProfile::Uniform,
        DensityProfile::slab(7e3),
        DensityProfile::Exponential {
            reference_height_m: 300.0,
            scale_height_m: 2e3,
        },
        DensityProfile::Clamped {
            base_height_m: 2.7e3,
            scale_height_m: 900.0,
        },
    ]
}

/// Profiles whose columns along rays have a closed form, for the tests at all scales.
#[cfg(test)]
fn fog_profiles(scale_height_m: f64) -> [DensityProfile; 5] {
    [
        DensityProfile::Uniform,
        DensityProfile::Exponential {
            reference_height_m: 3.0,
            scale_height_m,
        },
        DensityProfile::Clamped {
            base_height_m: 20.0,
            scale_height_m,
        },
        DensityProfile::slab(35.0),
        DensityProfile::Layer {
            bottom_m: 15.0,
            top_m: 35.0,
        },
    ]
}

#[cfg(test)]
mod tests;
