//! How fog thins with height, and how much of it lies along a line.

use super::ray_segment::RaySegment;
use crate::math::quadrature::FixedRule;

/// Density against height, relative to the density that a fog's coefficients are stated for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Profile {
    /// The same everywhere, without an upper end.
    Uniform,
    /// `e^-((y - reference) / H)`: exponential height fog (Ishiyama 2018, eq. 7 with reference 0). With the base as the
    /// reference it is what the note's formula says of any line, above the base or not.
    Exponential {
        /// Height at which the density is 1, m.
        reference_height_m: f64,
        /// Height over which it falls to 1/e, m.
        scale_height_m: f64,
    },
    /// 1 up to the base, `e^-((y - base) / H)` above it: the note's `e^-(f max(0, y - h0))` with falloff `f = 1 / H`. (The
    /// note's formula for it holds for lines wholly above the base; here lines are cut there.)
    Clamped {
        /// Height up to which the density is 1, m.
        base_height_m: f64,
        /// Height over which it falls to 1/e above the base, m.
        scale_height_m: f64,
    },
    /// 1 up to the top, nothing above: the fog of Klassen 1987.
    Slab {
        /// Height of the top, m.
        top_height_m: f64,
    },
}

/// Why numbers do not make a profile.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// The scale height is not above 0.
    #[error(
        "the scale height must be above 0 m and finite, got {0} m: for a sharp top ask for a slab, for none a uniform fog"
    )]
    ScaleHeight(f64),
    /// A height is not a finite number.
    #[error("the {which} must be a finite number of metres, got {got_m}")]
    Height {
        /// Which height.
        which: &'static str,
        /// What was given, m.
        got_m: f64,
    },
}

impl Profile {
    /// The clamped profile of a falloff (1/m) instead of a scale height: 0 is a fog without end, infinity a slab.
    ///
    /// # Errors
    /// [`ProfileError`] for a falloff below 0 or not a number, or a base that is not finite.
    pub fn from_falloff(base_height_m: f64, falloff_per_m: f64) -> Result<Self, ProfileError> {
        let profile = if falloff_per_m == 0.0 {
            Self::Uniform
        } else if falloff_per_m == f64::INFINITY {
            Self::Slab {
                top_height_m: base_height_m,
            }
        } else {
            Self::Clamped {
                base_height_m,
                scale_height_m: 1.0 / falloff_per_m,
            }
        };
        profile.validate().map(|()| profile)
    }

    /// Checks the numbers of a profile.
    ///
    /// # Errors
    /// [`ProfileError`] for the first that cannot be.
    pub fn validate(&self) -> Result<(), ProfileError> {
        let (which, height_m, scale) = match *self {
            Self::Uniform => return Ok(()),
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => ("reference height", reference_height_m, scale_height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => ("base height", base_height_m, scale_height_m),
            Self::Slab { top_height_m } => ("height of the top", top_height_m, 1.0),
        };
        if !height_m.is_finite() {
            return Err(ProfileError::Height {
                which,
                got_m: height_m,
            });
        }
        match scale > 0.0 && scale.is_finite() {
            true => Ok(()),
            false => Err(ProfileError::ScaleHeight(scale)),
        }
    }

    /// Density at a height.
    #[inline]
    pub fn density(&self, height_m: f64) -> f64 {
        match *self {
            Self::Uniform => 1.0,
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => (-(height_m - reference_height_m) / scale_height_m).exp(),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => (-(height_m - base_height_m).max(0.0) / scale_height_m).exp(),
            Self::Slab { top_height_m } => f64::from(height_m < top_height_m),
        }
    }

    /// Density integrated straight up from a height, m; infinite for a fog without an upper end.
    #[inline]
    pub fn column_above(&self, height_m: f64) -> f64 {
        match *self {
            Self::Uniform => f64::INFINITY,
            Self::Exponential { scale_height_m, .. } => scale_height_m * self.density(height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => (base_height_m - height_m).max(0.0) + scale_height_m * self.density(height_m),
            Self::Slab { top_height_m } => (top_height_m - height_m).max(0.0),
        }
    }

    /// Density integrated along a line, m: relative error below 1e-12 for lines of any length, height and slope.
    #[inline]
    pub fn column(&self, line: &RaySegment) -> f64 {
        match *self {
            Self::Uniform => line.length_m,
            Self::Slab { top_height_m } => {
                let (first, last) = line.below(top_height_m);
                last - first
            }
            Self::Exponential {
                reference_height_m,
                scale_height_m,
            } => thinning(line, reference_height_m, scale_height_m),
            Self::Clamped {
                base_height_m,
                scale_height_m,
            } => {
                let (first, last) = line.below(base_height_m);
                if first == last {
                    return thinning(line, base_height_m, scale_height_m);
                }
                let mut column = last - first;
                if first > 0.0 {
                    column += thinning(&line.part(0.0, first), base_height_m, scale_height_m);
                }
                if last < line.length_m {
                    let beyond = line.part(last, line.length_m);
                    column += thinning(&beyond, base_height_m, scale_height_m);
                }
                column
            }
        }
    }
}

/// The integral of `e^-((y - reference) / scale)` along a line.
#[inline]
fn thinning(line: &RaySegment, reference_height_m: f64, scale_height_m: f64) -> f64 {
    let steep = line.sin_elevation / scale_height_m;
    let curvature = line.curvature_per_m / scale_height_m;
    let start = (line.height_m - reference_height_m) / scale_height_m;
    let length = line.length_m;
    if curvature == 0.0 && length.is_finite() {
        // Flat ground: from the denser end, so that nothing overflows before it must.
        let rise = steep * length;
        let densest = start + rise.min(0.0);
        let rise = rise.abs();
        let mean = if rise < 1e-8 {
            1.0 - 0.5 * rise
        } else {
            -(-rise).exp_m1() / rise
        };
        return (-densest).exp() * length * mean;
    }
    if curvature == 0.0 {
        return match steep > 0.0 {
            true => (-start).exp() / steep,
            false => f64::INFINITY,
        };
    }
    // Round ground: a parabola in the exponent, walked away from its lowest point on either side.
    let lowest = -0.5 * steep / curvature;
    let exponent_at = |s: f64| start + s * (steep + s * curvature);
    let column = if lowest <= 0.0 {
        (-start).exp() * falling(steep, curvature, length)
    } else if lowest >= length {
        let back = -(steep + 2.0 * curvature * length);
        (-exponent_at(length)).exp() * falling(back, curvature, length)
    } else {
        (-exponent_at(lowest)).exp()
            * (falling(0.0, curvature, lowest) + falling(0.0, curvature, length - lowest))
    };
    column.min(f64::MAX)
}

/// `int_0^length e^-(a s + b s^2) ds` for `a >= 0`, `b > 0`: by the scaled complementary error function, or by Gauss's
/// rule where its two values would nearly cancel.
fn falling(a: f64, b: f64, length: f64) -> f64 {
    static RULE: FixedRule<8> = FixedRule::fixed();
    const HALF_SQRT_PI: f64 = 0.886_226_925_452_758;
    let fall = length * (a + b * length);
    if fall < 0.5 {
        return RULE.integrate(0.0, length, |s| (-s * (a + b * s)).exp());
    }
    let root = b.sqrt();
    let near = 0.5 * a / root;
    if near > 1e7 {
        return -(-fall).exp_m1() / a;
    }
    let far = if length.is_finite() {
        (-fall).exp() * scaled_erfc(near + root * length)
    } else {
        0.0
    };
    HALF_SQRT_PI / root * (scaled_erfc(near) - far)
}

/// `e^(z^2) erfc(z)` for `z >= 0`; relative error below 1e-12.
fn scaled_erfc(z: f64) -> f64 {
    const SQRT_PI: f64 = 1.772_453_850_905_516;
    if z < 25.0 {
        (z * z).exp() * libm::erfc(z)
    } else {
        let w = 0.5 / (z * z);
        (1.0 - w * (1.0 - 3.0 * w * (1.0 - 5.0 * w * (1.0 - 7.0 * w)))) / (z * SQRT_PI)
    }
}

#[cfg(test)]
mod tests;
