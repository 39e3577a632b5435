//! Absorption by ozone, which makes the twilight zenith blue.

use crate::spectrum::{SampledCurve, embedded_table};
use std::sync::LazyLock;

/// Molecules per square metre in one Dobson unit (a layer of 10 micrometres of the gas at 273.15 K and 101325 Pa).
pub(crate) const DOBSON_UNIT_M2: f64 = 2.6867e20;

/// Absorption cross-section of an ozone molecule at 233 K, m^2, at a vacuum wavelength in nm.
///
/// Means over 1 nm, every 1 nm from 300 nm to 900 nm, linearly interpolated, constant beyond. 233 K is about the
/// temperature of the ozone layer. From 193 K to 293 K the measured cross-section changes by less than 2 % between 480 nm
/// and 650 nm, where ozone colours the sky; by up to 6 % from 650 nm to 900 nm; by 20 % at 320 nm; and by several times its
/// value about 350 nm. Between 360 nm and 420 nm ozone hardly absorbs, and the table is mostly measurement noise.
///
/// Sources: Gorshelev et al., Atmos. Meas. Tech. 7, 609-624, 2014; Serdyuchenko et al., ibid. 625-636.
pub fn cross_section_m2(nm: f64) -> f64 {
    curve().at(nm)
}

/// Table of [`cross_section_m2`]: cross-section in m^2 by wavelength in nm.
pub fn curve() -> &'static SampledCurve {
    static CURVE: LazyLock<SampledCurve> = LazyLock::new(|| {
        let rows = embedded_table::<2>(include_str!("../../data/optics/ozone_233k.txt"));
        let (nm, m2) = rows.into_iter().map(|[nm, m2]| (nm, m2)).unzip();
        SampledCurve::new(nm, m2).expect("the embedded ozone table is a curve")
    });
    &CURVE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_covers_its_range() {
        let curve = curve();
        assert_eq!(curve.abscissae().len(), 601);
        assert_eq!(curve.abscissae()[0], 300.0);
        assert_eq!(curve.abscissae()[600], 900.0);
        assert!(curve.values().iter().all(|&m2| m2 > 0.0));
    }

    #[test]
    fn ten_nanometre_means_match_published_values() {
        // Means at 233 K over [nm, nm + 10) in E. Bruneton's precomputed atmospheric scattering demo (2017), from an earlier
        // release of the same measurement.
        for (nm, want) in [
            (440, 1.582e-26),
            (500, 1.480e-25),
            (550, 3.500e-25),
            (570, 4.672e-25),
            (680, 1.209e-25),
        ] {
            let bin = (0..100).map(|i| cross_section_m2(nm as f64 + 0.1 * i as f64));
            let mean = bin.sum::<f64>() / 100.0;
            assert!(
                (mean / want - 1.0).abs() < 0.02,
                "{nm}: {mean} against {want}"
            );
        }
    }

    #[test]
    fn chappuis_band_peaks_at_603_nm() {
        let peak = (500..700)
            .max_by(|&a, &b| cross_section_m2(a as f64).total_cmp(&cross_section_m2(b as f64)));
        assert!(matches!(peak, Some(600..=605)), "{peak:?}");
        assert!((cross_section_m2(603.0) / 5.15e-25 - 1.0).abs() < 0.02);
    }
}
