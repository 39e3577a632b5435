//! Spectra given by tables in the code.

use crate::spectrum::SpectralCurve;

/// A curve of constant samples.
pub(super) fn fixed_table(samples: &[(f64, f64)]) -> SpectralCurve {
    let (wavelengths, values) = samples.iter().copied().unzip();
    SpectralCurve::table(wavelengths, values).expect("constant tables are valid")
}
