//! Scattering matrix of spheres stored with a tabulated phase function.

use super::{PhaseError, TabulatedPhase};
use crate::optics::{MatrixRatios, PolarisedMoments};

impl TabulatedPhase {
    /// Adds the polarisation of spheres: `f12`, `f33` and `f34` relative to the phase function, in the order of the values of
    /// [`Self::new`]. Between the angles of the table the ratios are linear in the angle.
    ///
    /// # Errors
    /// [`PhaseError::Length`] if the number of entries is invalid, [`PhaseError::Matrix`] if an element lies outside `[-1, 1]`.
    pub fn with_matrix(self, ratios: &[[f64; 3]]) -> Result<Self, PhaseError> {
        if ratios.len() != self.log_values.len() {
            return Err(PhaseError::Length {
                wavelengths: self.wavelengths_nm.len(),
                angles: self.angles_rad.len(),
                got: ratios.len(),
            });
        }
        // Tolerates the single-precision error of sums over spheres.
        let in_range = |v: &f64| v.abs() <= 1.0 + 1e-4;
        for (index, all) in ratios.iter().enumerate() {
            if let Some(&value) = all.iter().find(|v| !in_range(v)) {
                return Err(PhaseError::Matrix { index, value });
            }
        }
        let stored = ratios
            .iter()
            .map(|all| all.map(|v| v.clamp(-1.0, 1.0) as f32));
        Ok(Self {
            matrix: Some(stored.collect()),
            ..self
        })
    }

    /// True if the table has a scattering matrix.
    pub fn has_matrix(&self) -> bool {
        self.matrix.is_some()
    }

    /// Scattering matrix relative to the phase function, at the cosine of the scattering angle; [`MatrixRatios::NONE`] if the
    /// table has none.
    pub fn matrix_ratios(&self, cos_angle: f64, wavelength_nm: f64) -> MatrixRatios {
        let Some(matrix) = &self.matrix else {
            return MatrixRatios::NONE;
        };
        let (interval, angle) = self.place(cos_angle);
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        let of = |row: usize| self.ratios_of_row(matrix, row, interval, angle);
        let ratios = match t {
            0.0 => of(row),
            _ => {
                // The matrix elements, not their ratios, are linear between wavelengths, as the phase function is.
                let near = (1.0 - t) * self.at_row(row, interval, angle);
                let far = t * self.at_row(row + 1, interval, angle);
                let share = far / (near + far);
                let (near, far) = (of(row), of(row + 1));
                std::array::from_fn(|i| near[i] + share * (far[i] - near[i]))
            }
        };
        of_spheres(ratios)
    }

    /// Ratios of a row of the table, linear in the angle.
    fn ratios_of_row(
        &self,
        matrix: &[[f32; 3]],
        row: usize,
        interval: usize,
        angle: f64,
    ) -> [f64; 3] {
        let [low, high] = [self.angles_rad[interval], self.angles_rad[interval + 1]];
        let part = ((angle - low) / (high - low)) as f32;
        let at = row * self.angles_rad.len() + interval;
        let (near, far) = (matrix[at], matrix[at + 1]);
        std::array::from_fn(|i| f64::from(near[i] + part * (far[i] - near[i])))
    }

    /// Moments of degree 2 of the scattering matrix, see [`crate::optics::PhaseFunction::polarised_moments`].
    pub(crate) fn polarised_moments(&self, wavelength_nm: f64) -> PolarisedMoments {
        let Some(matrix) = &self.matrix else {
            return PolarisedMoments::default();
        };
        let of = |row: usize| {
            let mut sum = PolarisedMoments::default();
            for interval in 0..self.angles_rad.len() - 1 {
                let to = self.angles_rad[interval + 1];
                self.visit_panels(row, interval, to, MAX_PANEL, |angles, measures| {
                    for (&angle, &measure) in angles.iter().zip(measures) {
                        let ratios = of_spheres(self.ratios_of_row(matrix, row, interval, angle));
                        let phase = self.at_row(row, interval, angle);
                        let part = PolarisedMoments::of_angle(angle.cos(), phase, &ratios);
                        sum = sum.plus(part, measure);
                    }
                });
            }
            sum
        };
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        match t {
            0.0 => of(row),
            _ => PolarisedMoments::default()
                .plus(of(row), 1.0 - t)
                .plus(of(row + 1), t),
        }
    }
}

/// Widest panel of an integral over polynomials of the cosine of low degree, rad.
const MAX_PANEL: f64 = 0.4;

/// The matrix of spheres, of which three ratios are independent.
fn of_spheres([f12, f33, f34]: [f64; 3]) -> MatrixRatios {
    MatrixRatios {
        f12,
        f22: 1.0,
        f33,
        f34,
        f44: f33,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_matrices_are_refused() {
        let table = || TabulatedPhase::new(vec![0.0, 180.0], vec![550.0], vec![1.0; 2]).unwrap();
        assert!(matches!(
            table().with_matrix(&[[0.0; 3]; 3]),
            Err(PhaseError::Length { got: 3, .. })
        ));
        for invalid in [1.1, -2.0, f64::NAN] {
            assert!(matches!(
                table().with_matrix(&[[0.0; 3], [0.0, invalid, 0.0]]),
                Err(PhaseError::Matrix { index: 1, .. })
            ));
        }
        let half = table().with_matrix(&[[0.0; 3], [-1.0, 0.5, 0.0]]).unwrap();
        let middle = half.matrix_ratios(0.0, 550.0);
        assert!((middle.f12 + 0.5).abs() < 1e-6 && (middle.f44 - 0.25).abs() < 1e-6);
    }
}
