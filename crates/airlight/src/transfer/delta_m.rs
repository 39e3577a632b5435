//! Delta-M: the forward peak of a phase function, which a solver's moments cannot resolve, counts as unscattered.
//!
//! Wiscombe (J. Atmos. Sci. 34, 1408, 1977): with `f` the moment of the first degree that the solver leaves out, the fraction
//! `f` of the scattering continues straight on, the scattering coefficient shrinks by `1 - f`, and the moments become
//! `(chi_l - f) / (1 - f)`. Sunlight scattered once beyond the peak is then computed with the exact phase function
//! ([`super::residual`]).

use crate::math::real::Real;

/// Largest fraction of the scattering that counts as unscattered.
const MOST: f64 = 0.99;

/// The fraction of the scattering in the forward peak: the moment of the first degree left out.
#[inline(always)]
pub fn peak_fraction<T: Real>(first_moment_left_out: T) -> T {
    let (none, most) = (T::of(0.0), T::of(MOST));
    match first_moment_left_out {
        moment if moment < none => none,
        moment if moment > most => most,
        moment => moment,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fraction_is_between_none_and_most() {
        let fractions = [-0.1f32, 0.3, 1.0].map(peak_fraction);
        assert_eq!(fractions, [0.0, 0.3, 0.99]);
    }
}
