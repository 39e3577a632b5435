//! Lorenz-Mie theory: one sphere, and spheres of all sizes.

use crate::arrays::{self, Numbers};
use crate::compute::compute;
use crate::errors::Failure;
use airlight::optics::RefractiveIndex;
use airlight::optics::mie::{self, Complex64, SizeDistribution};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Efficiencies of a sphere in a plane wave, as ``airlight.mie_sphere`` returns them.
type Efficiencies = (f64, f64, f64, f64, f64);

/// Efficiencies and scattering of a homogeneous sphere (Lorenz-Mie theory), to 1e-13 for size parameters from 0.001 to 20000.
///
/// Parameters
/// ----------
/// size_parameter : float
///     Circumference over wavelength, above 0 and at most 1e5.
/// index : complex
///     Refractive index ``n + ik`` relative to the surroundings.
///
/// Returns
/// -------
/// extinction, scattering, absorption, backscattering, asymmetry : float
///     Cross-sections divided by the geometric one, and the mean cosine of the scattering angle.
///
/// Examples
/// --------
/// >>> extinction, *_ = airlight.mie_sphere(10.0, 1.5 + 0j)
/// >>> round(extinction, 3)
/// 2.882
#[pyfunction]
pub fn mie_sphere(size_parameter: f64, index: Complex64) -> Result<Efficiencies, Failure> {
    let found = mie::Sphere::new(size_parameter, index)?.efficiencies();
    Ok((
        found.extinction,
        found.scattering,
        found.absorption,
        found.backscattering,
        found.asymmetry,
    ))
}

/// Phase function of a homogeneous sphere for natural light.
///
/// Parameters
/// ----------
/// size_parameter : float
///     Circumference over wavelength.
/// index : complex
///     Refractive index ``n + ik``.
/// angle_deg : array_like, shape (n,)
///     Scattering angles, degrees.
///
/// Returns
/// -------
/// numpy.ndarray, shape (n,), float64
///     1/sr; the integral over the sphere is 1.
#[pyfunction]
pub fn mie_phase<'py>(
    py: Python<'py>,
    size_parameter: f64,
    index: Complex64,
    angle_deg: Numbers,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let sphere = mie::Sphere::new(size_parameter, index).map_err(Failure::from)?;
    let angles = arrays::numbers(angle_deg);
    let values = compute(py, None, |control| {
        let phase = |degrees: &f64| {
            control.check()?;
            Ok(sphere.phase(degrees.to_radians().cos()))
        };
        angles.iter().map(phase).collect::<Result<_, Failure>>()
    })?;
    Ok(arrays::vector(py, values))
}

/// Spheres of one material with a size distribution.
///
/// Parameters
/// ----------
/// radius_um : float
///     Effective radius (gamma) or median radius (log-normal), or the radius of all spheres, micrometres.
/// spread : float
///     Effective variance of the gamma distribution, geometric standard deviation of the log-normal one.
/// distribution : {'gamma', 'log-normal', 'single'}
///     Number distribution of the radii.
/// index : complex or None
///     Refractive index; None: water.
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct Particles(mie::Particles);

#[pymethods]
impl Particles {
    #[new]
    #[pyo3(signature = (radius_um, spread=0.1, *, distribution="gamma", index=None))]
    fn new(
        radius_um: f64,
        spread: f64,
        distribution: &str,
        index: Option<Complex64>,
    ) -> Result<Self, Failure> {
        let sizes = match distribution {
            "gamma" => SizeDistribution::gamma(radius_um, spread),
            "log-normal" => SizeDistribution::log_normal(radius_um, spread),
            "single" => SizeDistribution::Monodisperse { radius_um },
            other => {
                return Err(Failure::invalid(format!(
                    "distribution: expected gamma, log-normal or single, got \"{other}\""
                )));
            }
        };
        Ok(Self(match index {
            Some(index) => mie::Particles::new(RefractiveIndex::constant(index), sizes)?,
            None => mie::Particles::water(sizes)?,
        }))
    }

    /// Mean optical properties of a sphere at wavelengths.
    ///
    /// Parameters
    /// ----------
    /// wavelengths_nm : array_like, shape (w,)
    ///     Wavelengths, nm.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// dict[str, numpy.ndarray]
    ///     ``scattering_um2`` and ``absorption_um2`` (cross-sections, um^2), ``asymmetry``; arrays of shape (w,).
    #[pyo3(signature = (wavelengths_nm, *, threads=None))]
    fn bulk<'py>(
        &self,
        py: Python<'py>,
        wavelengths_nm: Numbers,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let nm = arrays::numbers(wavelengths_nm);
        let found = compute(py, threads, |control| {
            let bulk = |&nm: &f64| self.0.bulk_with(nm, control).map_err(Failure::from);
            nm.iter().map(bulk).collect::<Result<Vec<_>, Failure>>()
        })?;
        let table = PyDict::new(py);
        let of = |value: fn(&mie::BulkOptics) -> f64| {
            arrays::vector(py, found.iter().map(value).collect())
        };
        table.set_item("scattering_um2", of(|bulk| bulk.scattering_um2))?;
        table.set_item("absorption_um2", of(|bulk| bulk.absorption_um2))?;
        table.set_item("asymmetry", of(|bulk| bulk.asymmetry))?;
        Ok(table)
    }

    /// Scattering matrices.
    ///
    /// Parameters
    /// ----------
    /// wavelength_nm : float
    ///     Wavelength, nm.
    /// angle_deg : array_like, shape (n,)
    ///     Scattering angles, degrees.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n, 4), float64
    ///     F11 (phase function, 1/sr), F12, F33 and F34.
    #[pyo3(signature = (wavelength_nm, angle_deg, *, threads=None))]
    fn scattering_matrix<'py>(
        &self,
        py: Python<'py>,
        wavelength_nm: f64,
        angle_deg: Numbers,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let angles = arrays::numbers(angle_deg).into_iter();
        let cosines: Vec<f64> = angles.map(|degrees| degrees.to_radians().cos()).collect();
        let found = compute(py, threads, |control| {
            self.0.matrices_with(wavelength_nm, &cosines, control)
        })?;
        let elements = found.iter().flat_map(|m| [m.f11, m.f12, m.f33, m.f34]);
        arrays::matrix(py, elements.collect(), 4)
    }

    fn __repr__(&self) -> String {
        let sizes = self.0.sizes();
        format!(
            "Particles(effective radius {:.4} um, effective variance {:.4})",
            sizes.effective_radius_um(),
            sizes.effective_variance()
        )
    }
}
