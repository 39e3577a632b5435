//! Spectra and profiles given by tables in the code.

use crate::atmosphere::{DensityProfile, Interpolation};
use crate::spectrum::SpectralCurve;

/// A curve of constant samples.
pub(super) fn fixed_table(samples: &[(f64, f64)]) -> SpectralCurve {
    let (wavelengths, values) = samples.iter().copied().unzip();
    SpectralCurve::table(wavelengths, values).expect("constant tables are valid")
}

/// A curve that is sampled from 250 to 1100 nm, every 5 nm.
pub(super) fn sampled(of: impl Fn(f64) -> f64) -> SpectralCurve {
    let nm = (50..=220).map(|i| 5.0 * f64::from(i));
    fixed_table(&nm.map(|nm| (nm, of(nm))).collect::<Vec<_>>())
}

/// A profile at altitudes in kilometres.
pub(super) fn fixed_profile(
    altitudes_km: impl IntoIterator<Item = f64>,
    densities: Vec<f64>,
    interpolation: Interpolation,
) -> DensityProfile {
    let altitudes_m = altitudes_km.into_iter().map(|km| 1e3 * km).collect();
    DensityProfile::tabulated(altitudes_m, densities, interpolation)
        .expect("constant tables are valid")
}
