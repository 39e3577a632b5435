//! Tabulated phase functions.

mod integrals;
mod matrix;
mod moments;
mod sample;

use self::integrals::Integrals;
use super::phase_error::PhaseError;
use crate::math::interpolation::{Place, hermite, interval_of, lerp, monotone_slopes};
use crate::math::quadrature::FixedRule;
use std::sync::Arc;

/// A phase function tabulated at angles from 0 to 180 degrees and at one or more wavelengths.
///
/// Between angles `ln p` follows a monotone cubic (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 300, 1984) with slope
/// 0 at both ends, about which every phase function is even, so peaks of many decades stay smooth and nothing overshoots.
/// Between wavelengths `p` is linear, which preserves its integral of 1; beyond the first and last wavelength it is
/// constant. The constructor scales each wavelength so that the integral over the sphere is 1 (to 1e-12).
///
/// Clones share the table.
#[derive(Clone, Debug, PartialEq)]
pub struct TabulatedPhase {
    wavelengths_nm: Arc<[f64]>,
    angles_rad: Arc<[f64]>,
    /// `ln p` and its slope, with the angle varying fastest.
    log_values: Arc<[f64]>,
    slopes: Arc<[f64]>,
    integrals: Arc<Integrals>,
    /// `f12`, `f33` and `f34` of spheres relative to the phase function, with the angle varying fastest, if known.
    matrix: Option<Arc<[[f32; 3]]>>,
}

/// Number of points of the Gauss-Legendre rule in each panel.
const PANEL_POINTS: usize = 12;
static PANEL_RULE: FixedRule<PANEL_POINTS> = FixedRule::fixed();

impl TabulatedPhase {
    /// Creates a phase function from `values[w * angles + a]` at wavelength `w` and angle `a`, in any common unit.
    ///
    /// # Errors
    /// [`PhaseError`] if the angles do not increase strictly from 0 to 180, the wavelengths are not positive and strictly
    /// increasing, the number of values is wrong, or a value is not positive and finite.
    pub fn new(
        angles_deg: Vec<f64>,
        wavelengths_nm: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Self, PhaseError> {
        let last = angles_deg.len().saturating_sub(1);
        for (index, &value) in angles_deg.iter().enumerate() {
            let wrong_end = (index == 0 && value != 0.0) || (index == last && value != 180.0);
            if !value.is_finite() || wrong_end || (index > 0 && value <= angles_deg[index - 1]) {
                return Err(PhaseError::Angles { index, value });
            }
        }
        for (index, &value) in wavelengths_nm.iter().enumerate() {
            let low = if index == 0 {
                0.0
            } else {
                wavelengths_nm[index - 1]
            };
            if !value.is_finite() || value <= low {
                return Err(PhaseError::Wavelengths { index, value });
            }
        }
        let (wavelengths, angles) = (wavelengths_nm.len(), angles_deg.len());
        if values.len() != wavelengths * angles || wavelengths == 0 || angles < 2 {
            return Err(PhaseError::Length {
                wavelengths,
                angles,
                got: values.len(),
            });
        }
        if let Some(index) = values.iter().position(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(PhaseError::Value {
                index,
                value: values[index],
            });
        }
        let angles_rad: Vec<f64> = angles_deg.iter().map(|a| a.to_radians()).collect();
        let log_values: Vec<f64> = values.iter().map(|v| v.ln()).collect();
        let mut slopes = Vec::with_capacity(values.len());
        for row in log_values.chunks(angles) {
            slopes.extend(monotone_slopes(&angles_rad, row));
        }
        let mut table = Self {
            wavelengths_nm: wavelengths_nm.into(),
            angles_rad: angles_rad.into(),
            log_values: log_values.into(),
            slopes: slopes.into(),
            integrals: Arc::new(Integrals::new(Vec::new(), 0)),
            matrix: None,
        };
        table.normalize();
        Ok(table)
    }

    /// Scales each row to an integral of 1 and stores its running integral.
    fn normalize(&mut self) {
        let angles = self.angles_rad.len();
        let mut log_values = self.log_values.to_vec();
        let mut cumulative = Vec::with_capacity(log_values.len());
        for row in 0..self.wavelengths_nm.len() {
            let mut running = vec![0.0];
            let mut sum = 0.0;
            for interval in 0..angles - 1 {
                sum += self.mass(row, interval, self.angles_rad[interval + 1]);
                running.push(sum);
            }
            cumulative.extend(running.iter().map(|part| part / sum));
            let logs = &mut log_values[row * angles..(row + 1) * angles];
            logs.iter_mut().for_each(|log| *log -= sum.ln());
        }
        self.log_values = log_values.into();
        self.integrals = Arc::new(Integrals::new(cumulative, self.wavelengths_nm.len()));
    }

    /// Wavelengths of the table, nm.
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// Angles of the table, rad.
    pub fn angles_rad(&self) -> &[f64] {
        &self.angles_rad
    }

    /// Value in sr^-1 at the cosine of the scattering angle.
    pub fn evaluate(&self, cos_angle: f64, wavelength_nm: f64) -> f64 {
        self.at_place(self.place(cos_angle), wavelength_nm)
    }

    /// As [`Self::evaluate`] at several wavelengths, with one look-up of the angle.
    #[inline]
    pub(crate) fn evaluate_all<const N: usize>(
        &self,
        cos_angle: f64,
        wavelengths_nm: &[f64; N],
    ) -> [f64; N] {
        let place = self.place(cos_angle);
        wavelengths_nm.map(|nm| self.at_place(place, nm))
    }

    /// Interval of the table and the scattering angle, rad.
    fn place(&self, cos_angle: f64) -> (usize, f64) {
        let mu = cos_angle.clamp(-1.0, 1.0);
        // More accurate than acos near both ends.
        let angle = ((1.0 - mu) * (1.0 + mu)).sqrt().atan2(mu);
        (interval_of(&self.angles_rad, angle), angle)
    }

    fn at_place(&self, (interval, angle): (usize, f64), wavelength_nm: f64) -> f64 {
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        let near = self.at_row(row, interval, angle);
        match t {
            0.0 => near,
            _ => lerp(near, self.at_row(row + 1, interval, angle), t),
        }
    }

    /// Row at or below a wavelength, and the interpolation weight of the next row.
    fn bracket_wavelength(&self, wavelength_nm: f64) -> (usize, f64) {
        let last = self.wavelengths_nm.len() - 1;
        if last == 0 || wavelength_nm >= self.wavelengths_nm[last] {
            return (last, 0.0);
        }
        let place = Place::among(&self.wavelengths_nm, wavelength_nm);
        (place.below, place.fraction)
    }

    fn at_row(&self, row: usize, interval: usize, angle: f64) -> f64 {
        let count = self.angles_rad.len();
        let row = row * count..(row + 1) * count;
        hermite(
            &self.angles_rad,
            &self.log_values[row.clone()],
            &self.slopes[row],
            interval,
            angle,
        )
        .exp()
    }

    /// Calls `visit` with the nodes of the quadrature rule and their weights `2 pi sin(angle) d angle` in panels of an
    /// interval, up to the angle `to`. No panel is wider than `max_width`, and `ln p` changes by at most about 2 over each.
    #[inline(always)]
    fn visit_panels(
        &self,
        row: usize,
        interval: usize,
        to: f64,
        max_width: f64,
        mut visit: impl FnMut(&[f64; PANEL_POINTS], &[f64; PANEL_POINTS]),
    ) {
        let low = self.angles_rad[interval];
        let at = row * self.angles_rad.len() + interval;
        let rise = (self.log_values[at + 1] - self.log_values[at]).abs();
        let count = ((to - low) / max_width).max(rise / 2.0).ceil().max(1.0);
        let width = (to - low) / count;
        let rule = PANEL_RULE.pairs();
        for k in 0..count as usize {
            let start = low + width * k as f64;
            let angles = rule.map(|(node, _)| start + width * node);
            let measures = std::array::from_fn(|i| {
                rule[i].1 * std::f64::consts::TAU * width * angles[i].sin()
            });
            visit(&angles, &measures);
        }
    }
}

/// Interpolates `ln p` from increasing sample angles to increasing points, as a table does.
pub(super) fn between_samples(angles: &[f64], logs: &[f64], points: &[f64]) -> Vec<f64> {
    let slopes = monotone_slopes(angles, logs);
    let at = |&point: &f64| hermite(angles, logs, &slopes, interval_of(angles, point), point);
    points.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn smooth_functions_are_interpolated_accurately() {
        // Henyey-Greenstein, g = 0.8, every 2 degrees.
        let g: f64 = 0.8;
        let hg = |a: f64| {
            (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * a.to_radians().cos()).powf(1.5))
        };
        let angles: Vec<f64> = (0..=90).map(|i| 2.0 * f64::from(i)).collect();
        let values = angles.iter().map(|&a| hg(a)).collect();
        let table = TabulatedPhase::new(angles, vec![550.0], values).unwrap();
        let mut worst: f64 = 0.0;
        for i in 0..1800 {
            let a = 0.1 * f64::from(i);
            worst = worst.max((table.evaluate(a.to_radians().cos(), 550.0) / hg(a) - 1.0).abs());
        }
        assert!(worst < 4e-3, "{worst}");
    }

    #[test]
    fn values_are_linear_between_wavelengths_and_constant_beyond() {
        let table = TabulatedPhase::new(
            vec![0.0, 90.0, 180.0],
            vec![400.0, 600.0],
            vec![3.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        );
        let table = table.unwrap();
        let [low, middle, high] = [400.0, 500.0, 600.0].map(|nm| table.evaluate(0.9, nm));
        assert!((middle - 0.5 * (low + high)).abs() < 1e-15);
        assert_eq!(table.evaluate(0.9, 300.0), low);
        assert_eq!(table.evaluate(0.9, 900.0), high);
        assert!((high * 4.0 * PI - 1.0).abs() < 1e-12);
    }

    #[test]
    fn invalid_tables_are_refused() {
        let new = |angles: &[f64], wavelengths: &[f64], values: &[f64]| {
            TabulatedPhase::new(angles.to_vec(), wavelengths.to_vec(), values.to_vec()).unwrap_err()
        };
        assert!(matches!(
            new(&[1.0, 180.0], &[5.0], &[1.0; 2]),
            PhaseError::Angles { index: 0, .. }
        ));
        assert!(matches!(
            new(&[0.0, 170.0], &[5.0], &[1.0; 2]),
            PhaseError::Angles { index: 1, .. }
        ));
        assert!(matches!(
            new(&[0.0], &[5.0], &[1.0]),
            PhaseError::Angles { .. }
        ));
        assert!(matches!(new(&[], &[5.0], &[]), PhaseError::Length { .. }));
        assert!(matches!(
            new(&[0.0, 180.0], &[5.0, 5.0], &[1.0; 4]),
            PhaseError::Wavelengths { index: 1, .. }
        ));
        assert!(matches!(
            new(&[0.0, 180.0], &[5.0], &[1.0; 3]),
            PhaseError::Length { got: 3, .. }
        ));
        assert!(matches!(
            new(&[0.0, 180.0], &[5.0], &[1.0, 0.0]),
            PhaseError::Value { index: 1, .. }
        ));
    }
}
