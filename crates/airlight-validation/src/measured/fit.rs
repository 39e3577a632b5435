//! Fit of the day's aerosol to scans: damped Gauss-Newton iteration in its three parameters.

use super::{Aerosol, SUN_DISTANCE_AU, Scan, air_of_the_day, compare};
use crate::check::Row;
use airlight::Control;

/// Largest number of steps.
const STEPS: usize = 12;
/// Relative step of the numerical derivatives.
const DIFFERENCE: f64 = 0.01;

/// Aerosol whose skies have the smallest root-mean-square difference from the scans, and that difference in mW m^-2 sr^-1 nm^-1.
pub fn fit(start: Aerosol, wavelengths_nm: &[f64], scans: &[&Scan]) -> (Aerosol, f64) {
    let residuals = |aerosol: &Aerosol| -> Vec<f64> {
        let air = air_of_the_day(aerosol);
        let rows = scans.iter().flat_map(|scan| {
            compare(
                &air,
                wavelengths_nm,
                scan,
                SUN_DISTANCE_AU,
                Control::default(),
            )
            .expect("nothing cancels it")
        });
        rows.map(|row: Row| 1e3 * (row.ours - row.reference))
            .collect()
    };
    let mut at = start;
    let mut here = residuals(&at);
    for _ in 0..STEPS {
        let derivatives = [0, 1, 2].map(|i| {
            let mut factors = [1.0; 3];
            factors[i] += DIFFERENCE;
            let there = residuals(&scaled(at, factors));
            let lanes = there.iter().zip(&here);
            lanes
                .map(|(b, a)| (b - a) / DIFFERENCE)
                .collect::<Vec<f64>>()
        });
        let step = least_squares(&derivatives, &here);
        // No parameter changes by more than a quarter in a step; the albedo stays in range.
        let next = scaled(at, step.map(|s| 1.0 - s.clamp(-0.25, 0.25)));
        let there = residuals(&next);
        let gain = mean_square(&here).sqrt() - mean_square(&there).sqrt();
        if gain <= 0.0 {
            break;
        }
        (at, here) = (next, there);
        if gain < 1e-4 {
            break;
        }
    }
    (at, mean_square(&here).sqrt())
}

fn scaled(aerosol: Aerosol, factors: [f64; 3]) -> Aerosol {
    Aerosol {
        optical_depth_550: aerosol.optical_depth_550 * factors[0],
        angstrom_exponent: aerosol.angstrom_exponent * factors[1],
        single_scattering_albedo: (aerosol.single_scattering_albedo * factors[2]).min(1.0),
    }
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

/// Linear least squares: the `x` for which the sum of `columns[i] x[i]` is nearest to the values, from the normal equations by
/// Cramer's rule.
fn least_squares(columns: &[Vec<f64>; 3], values: &[f64]) -> [f64; 3] {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&columns[i], &columns[j])));
    let right = [0, 1, 2].map(|i| dot(&columns[i], values));
    let determinant = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    [0, 1, 2].map(|column| {
        let mut replaced = matrix;
        for (row, value) in replaced.iter_mut().zip(right) {
            row[column] = value;
        }
        determinant(&replaced) / determinant(&matrix)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_recovers_the_coefficients() {
        let columns = [
            vec![1.0, 2.0, 0.0, 1.0],
            vec![0.0, 1.0, 3.0, -1.0],
            vec![2.0, 0.0, 1.0, 1.0],
        ];
        let x = [0.5, -2.0, 3.0];
        let values: Vec<f64> = (0..4)
            .map(|row| (0..3).map(|i| columns[i][row] * x[i]).sum())
            .collect();
        let got = least_squares(&columns, &values);
        assert!(
            got.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-9),
            "{got:?}"
        );
    }
}
