//! The CIE 1931 2-degree standard observer.

use super::table::embedded;
use crate::math::interpolation::lerp;
use std::sync::LazyLock;

/// Maximum luminous efficacy K_m, lm/W: `Y = 683.002 * integral L ybar dl` is in cd/m^2 for `L` in W m^-2 sr^-1 nm^-1.
///
/// From CIE 018:2019: 683 lm/W at 540 THz, converted to the peak of V(lambda) at 555 nm in air.
pub(crate) const LUMINOUS_EFFICACY_LM_PER_W: f64 = 683.002;

/// Shortest wavelength of the tabulated observer, nm.
pub(crate) const FIRST_NM: f64 = 360.0;
/// Longest wavelength of the tabulated observer, nm.
pub(crate) const LAST_NM: f64 = 830.0;

/// Colour-matching functions (x-bar, y-bar, z-bar) at a wavelength in nm: ISO/CIE 11664-1:2019, tabulated every 1 nm from
/// 360 nm to 830 nm, linearly interpolated, zero outside.
pub fn color_matching(nm: f64) -> [f64; 3] {
    static TABLE: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
        embedded::<4>(include_str!("../../data/spectrum/cie_1931_2deg.txt"))
            .into_iter()
            .map(|[_, x, y, z]| [x, y, z])
            .collect()
    });
    // The negated test also catches NaN.
    if !(FIRST_NM..=LAST_NM).contains(&nm) {
        return [0.0; 3];
    }
    let position = nm - FIRST_NM;
    let row = (position as usize).min(TABLE.len() - 2);
    let t = position - row as f64;
    std::array::from_fn(|i| lerp(TABLE[row][i], TABLE[row + 1][i], t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_the_1931_observer() {
        let rows = embedded::<4>(include_str!("../../data/spectrum/cie_1931_2deg.txt"));
        assert_eq!(rows.len(), 471);
        assert!(
            rows.iter()
                .enumerate()
                .all(|(i, row)| row[0] == 360.0 + i as f64)
        );
        assert_eq!(color_matching(555.0), [0.5120501, 1.0, 0.005749999]);
        assert_eq!(color_matching(360.0), [1.299e-4, 3.917e-6, 6.061e-4]);
        assert!(color_matching(830.0)[0] > 0.0);
        for outside in [359.999, 830.001, f64::NAN, f64::INFINITY] {
            assert_eq!(color_matching(outside), [0.0; 3]);
        }
        let between = color_matching(555.5)[1];
        assert!((between - (1.0 + color_matching(556.0)[1]) / 2.0).abs() < 1e-15);
    }

    #[test]
    fn equal_energy_stimulus_has_chromaticity_one_third() {
        // The chromaticity of the equal-energy stimulus is 1/3, 1/3, to the 1e-4 of CIE 015.
        let mut sum = [0.0; 3];
        for nm in 360..=830 {
            let cmf = color_matching(nm as f64);
            for i in 0..3 {
                sum[i] += cmf[i];
            }
        }
        let total: f64 = sum.iter().sum();
        assert!(sum.iter().all(|v| (v / total - 1.0 / 3.0).abs() < 1e-4));
        assert!((sum[1] - 106.857).abs() < 1e-3, "{}", sum[1]);
    }
}
