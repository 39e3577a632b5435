//! Extraterrestrial solar spectrum.

use super::SampledCurve;
use super::table::embedded;
use std::sync::LazyLock;

/// Solar spectral irradiance at 1 AU outside the atmosphere, W m^-2 nm^-1 by wavelength in nm.
///
/// Extraterrestrial column of ASTM G173-03 from 280 nm to 1000 nm, every 0.5 nm up to 400 nm and every 1 nm beyond;
/// constant outside. The full spectrum of the standard integrates to 1348 W m^-2 up to 4000 nm.
pub fn extraterrestrial() -> &'static SampledCurve {
    static CURVE: LazyLock<SampledCurve> = LazyLock::new(|| {
        let rows = embedded::<2>(include_str!("../../data/spectrum/solar_astm_g173.txt"));
        let (nm, irradiance) = rows.into_iter().map(|[nm, e]| (nm, e)).unzip();
        SampledCurve::new(nm, irradiance).expect("the embedded solar table is a curve")
    });
    &CURVE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_astm_g173() {
        let sun = extraterrestrial();
        assert_eq!(sun.abscissae().first(), Some(&280.0));
        assert_eq!(sun.abscissae().last(), Some(&1000.0));
        assert_eq!(sun.abscissae().len(), 841);
        assert_eq!(sun.at(460.0), 1.9973);
        assert_eq!(sun.at(560.0), 1.786);
        assert_eq!(sun.at(860.0), 1.0);
    }

    #[test]
    fn visible_irradiance_is_657_w_per_m2() {
        let sun = extraterrestrial();
        let visible: f64 = (380..780).map(|nm| sun.at(nm as f64 + 0.5)).sum();
        assert!((visible - 657.0).abs() < 15.0, "{visible} W m^-2");
    }
}
