//! Anderson mixing of the steps of an iteration (Anderson, J. ACM 12, 547, 1965; Walker & Ni, SIAM J. Numer. Anal. 49, 1715, 2011).
//!
//! The corrections of [`super::orders`] are exact for light that does not change horizontally. Light that differs from sun to sun
//! spreads sideways in thick air that reaches far up, and then falls faster from order to order than in plane-parallel air: the
//! corrections are too large, up to the number of times that light is scattered, and can alternate and grow. The last steps and
//! corrections show by how much, and their combination with the smallest correction is the next step.

use super::light::Light;
use crate::spectrum::Spectrum;

/// Largest number of earlier steps in a combination.
const DEPTH: usize = 3;

/// Largest sum of the factors of earlier steps; larger ones come from steps that are nearly the same.
const MAX_FACTORS: f64 = 30.0;

/// The last steps and corrections.
pub struct Mixing<const N: usize> {
    /// The light before the last step, and its correction.
    last: Option<[Light<N>; 2]>,
    /// Changes from one correction to the next, and the step between them plus that change; the newest last.
    changes: Vec<[Light<N>; 2]>,
}

impl<const N: usize> Mixing<N> {
    /// No steps.
    pub fn new() -> Self {
        Self {
            last: None,
            changes: Vec::new(),
        }
    }

    /// The step for `light` that replaces a correction.
    pub fn step(&mut self, light: &Light<N>, correction: &Light<N>) -> Light<N> {
        if let Some([light_before, before]) = self.last.take() {
            let mut change = correction.clone();
            change.subtract(&before);
            // The step as taken: it may have been limited.
            let mut with_step = light.clone();
            with_step.subtract(&light_before);
            with_step.add(&change);
            if self.changes.len() == DEPTH {
                self.changes.remove(0);
            }
            self.changes.push([change, with_step]);
        }
        let mut step = correction.clone();
        let factors = self.factors(light, correction);
        for ([_, with_step], factor) in self.changes.iter().zip(&factors) {
            step.add_scaled(with_step, Spectrum::ZERO - *factor);
        }
        self.last = Some([light.clone(), correction.clone()]);
        step
    }

    /// Factors of the changes in the combination with the smallest correction of the intensities, relative to the light at each point.
    fn factors(&self, light: &Light<N>, correction: &Light<N>) -> [Spectrum<N>; DEPTH] {
        let mut out = [Spectrum::ZERO; DEPTH];
        let count = self.changes.len();
        let intensities = |of: &Light<N>| of.intensities().collect::<Vec<_>>();
        let [whole, wanted] = [light, correction].map(intensities);
        let changes: Vec<_> = self.changes.iter().map(|[c, _]| intensities(c)).collect();
        let least = light.least();
        for lane in 0..N {
            let relative = |values: &[Spectrum<N>]| -> Vec<f64> {
                let parts = values.iter().zip(&whole).zip(least.iter().cycle());
                parts
                    .map(|((value, whole), least)| {
                        f64::from(value[lane] / whole[lane].max(least[lane]))
                    })
                    .collect()
            };
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let wanted = relative(&wanted);
            let columns: Vec<_> = changes.iter().map(|change| relative(change)).collect();
            // Normal equations, slightly regularised.
            let mut equations = [[0.0; DEPTH + 1]; DEPTH];
            for (i, equation) in equations[..count].iter_mut().enumerate() {
                for (j, column) in columns.iter().enumerate() {
                    equation[j] = product(&columns[i], column);
                }
                equation[i] *= 1.0 + 1e-9;
                equation[DEPTH] = product(&columns[i], &wanted);
            }
            let factors = solved(equations, count);
            if factors.iter().map(|f| f.abs()).sum::<f64>() < MAX_FACTORS {
                for (out, factor) in out.iter_mut().zip(factors) {
                    out[lane] = factor as f32;
                }
            }
        }
        out
    }
}

/// Solution of the first `count` of symmetric positive definite equations, whose right sides come last; 0 for the others.
fn solved(mut equations: [[f64; DEPTH + 1]; DEPTH], count: usize) -> [f64; DEPTH] {
    let mut out = [0.0; DEPTH];
    for pivot in 0..count {
        for below in pivot + 1..count {
            let factor = equations[below][pivot] / equations[pivot][pivot];
            for column in 0..=DEPTH {
                equations[below][column] -= factor * equations[pivot][column];
            }
        }
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|c| equations[row][c] * out[c]).sum();
        out[row] = (equations[row][DEPTH] - known) / equations[row][row];
    }
    // Steps that do not change anything leave no equation.
    match out.iter().all(|factor| factor.is_finite()) {
        true => out,
        false => [0.0; DEPTH],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Light of these intensities at some radii under one sun.
    fn light(intensities: &[f32]) -> Light<4> {
        Light {
            count: 1,
            moments: intensities.iter().map(|&x| Spectrum::splat(x)).collect(),
            ground: vec![Spectrum::ONE],
        }
    }

    #[test]
    fn corrections_that_alternate_and_grow_converge() {
        // Each part is corrected too far, by its own factor, or not far enough.
        let factors = [2.5, 3.0, 0.4];
        let solution = [1.0, 2.0, 3.0];
        let correction = |light: &Light<4>| {
            let mut out = light.clone();
            for (k, value) in out.moments.iter_mut().enumerate() {
                *value = (Spectrum::splat(solution[k]) - *value) * factors[k];
            }
            out.ground[0] = Spectrum::ONE - light.ground[0];
            out
        };
        let mut mixing = Mixing::new();
        let mut guess = light(&[1.1, 2.1, 2.8]);
        for _ in 0..6 {
            let step = mixing.step(&guess, &correction(&guess));
            guess.add(&step);
        }
        for (value, solution) in guess.moments.iter().zip(solution) {
            assert!((value[0] / solution - 1.0).abs() < 1e-4, "{guess:?}");
        }
    }

    #[test]
    fn the_first_step_is_the_correction() {
        let mut mixing = Mixing::new();
        let correction = light(&[0.1, -0.2]);
        let step = mixing.step(&light(&[1.0, 2.0]), &correction);
        assert_eq!(step.moments, correction.moments);
        // The same light again shows nothing.
        let step = mixing.step(&light(&[1.0, 2.0]), &correction);
        assert_eq!(step.moments, correction.moments);
    }
}
