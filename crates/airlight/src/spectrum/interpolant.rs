//! Interpolation between the wavelengths of the grid `fast`, whose nodes are too far apart for a spline.
//!
//! The response of sunlit air bends at the absorption bands of ozone, 10 to 20 nm wide, and more so the longer the way of the light is. These
//! bends have a known shape: a linear prediction from the values at the nodes, with the least mean square error for
//! spectra of the sun and of skies by day and in twilight, any smooth function added (kriging), is closer than a spline, and so are the colours.

use super::cie::{FIRST_NM, LAST_NM};
use super::table::embedded;
use crate::math::interpolation::lerp;
use std::sync::LazyLock;

/// Wavelengths between which the table interpolates, nm, found with it by `scripts/choose_wavelengths.py`.
pub(super) const NODES_NM: [f64; 8] = [423.0, 457.0, 499.0, 526.0, 559.0, 596.0, 635.0, 683.0];

/// Factors of the responses at [`NODES_NM`] in the response at a wavelength of the observer, nm; they add up to 1.
fn factors(nm: f64) -> [f64; 8] {
    static TABLE: LazyLock<Vec<[f64; 9]>> =
        LazyLock::new(|| embedded(include_str!("../../data/spectrum/fast_interpolant.txt")));
    let position = nm - FIRST_NM;
    let row = (position as usize).min(TABLE.len() - 2);
    let [below, above] = [&TABLE[row], &TABLE[row + 1]];
    std::array::from_fn(|k| lerp(below[k + 1], above[k + 1], position - row as f64))
}

/// Weights `w_k` of the responses at [`NODES_NM`] such that `sum_k w_k r_k` is the integral of `kernel(nm) r(nm)` over the observer's
/// range, with `r` interpolated; trapezoidal rule in steps of `step_nm`.
pub(super) fn product_weights(step_nm: f64, kernel: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    let mut weights = vec![[0.0; 3]; NODES_NM.len()];
    let steps = ((LAST_NM - FIRST_NM) / step_nm).round() as usize;
    for step in 0..=steps {
        let nm = FIRST_NM + step as f64 * step_nm;
        let end = if step == 0 || step == steps { 0.5 } else { 1.0 };
        let values = kernel(nm);
        for (weight, factor) in weights.iter_mut().zip(factors(nm)) {
            for (sum, value) in weight.iter_mut().zip(values) {
                *sum += end * step_nm * factor * value;
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_at_nodes_and_constants_are_kept() {
        for (k, &node) in NODES_NM.iter().enumerate() {
            for (i, factor) in factors(node).into_iter().enumerate() {
                let exact = f64::from(i == k);
                assert!((factor - exact).abs() < 1e-5, "{node} nm: {i} {factor}");
            }
        }
        for step in 0..=940 {
            let nm = FIRST_NM + 0.5 * f64::from(step);
            let sum: f64 = factors(nm).iter().sum();
            assert!((sum - 1.0).abs() < 1e-5, "{nm} nm: {sum}");
        }
    }
}
