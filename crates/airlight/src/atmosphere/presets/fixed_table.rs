//! Spectra given by tables in the code.

use crate::spectrum::SpectralCurve;

/// A table whose samples are constants of this crate.
pub(super) fn fixed_table(samples: &[(f64, f64)]) -> SpectralCurve {
    let (wavelengths, values) = samples.iter().copied().unzip();
    SpectralCurve::table(wavelengths, values).expect("tables of this crate are in order")
}
