//! `Atmosphere`.

use crate::arrays::{self, Numbers};
use crate::compute::compute;
use airlight::Named;
use airlight::atmosphere::{self, Preset};
use numpy::PyArray1;
use pyo3::prelude::*;

/// An atmosphere: a preset, or one read from TOML.
///
/// Parameters
/// ----------
/// preset : str
///     Name of a preset; ``Atmosphere.presets()`` lists them.
///
/// Examples
/// --------
/// >>> airlight.Atmosphere("clear").name
/// 'clear'
#[pyclass(frozen, module = "airlight")]
#[derive(Clone, Debug)]
pub struct Atmosphere(pub atmosphere::Atmosphere);

#[pymethods]
impl Atmosphere {
    #[new]
    #[pyo3(signature = (preset="average"))]
    fn new(py: Python<'_>, preset: &str) -> PyResult<Self> {
        compute(py, None, |_| atmosphere::preset(preset)).map(Self)
    }

    /// An atmosphere from TOML: a preset and the values that differ from it.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The TOML text; the book's chapter on atmospheres lists the keys.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     With line, column and key of the problem.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: &str) -> PyResult<Self> {
        compute(py, None, |_| atmosphere::Atmosphere::from_toml(text)).map(Self)
    }

    /// Names of the presets, each with one line that describes it.
    ///
    /// Returns
    /// -------
    /// dict[str, str]
    #[staticmethod]
    fn presets() -> std::collections::BTreeMap<&'static str, &'static str> {
        let presets = Preset::ALL.iter();
        presets
            .map(|preset| (preset.name(), preset.summary()))
            .collect()
    }

    /// Name of the atmosphere.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Optical depth of the whole vertical column of air.
    ///
    /// Parameters
    /// ----------
    /// wavelengths_nm : array_like, shape (n,)
    ///     Wavelengths, nm.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,), float64
    #[pyo3(signature = (wavelengths_nm))]
    fn vertical_optical_depth<'py>(
        &self,
        py: Python<'py>,
        wavelengths_nm: Numbers,
    ) -> Bound<'py, PyArray1<f64>> {
        let depth = |nm: f64| self.0.vertical_optical_depth(nm);
        let values = arrays::numbers(wavelengths_nm);
        arrays::vector(py, values.into_iter().map(depth).collect())
    }

    fn __repr__(&self) -> String {
        format!("Atmosphere({:?})", self.0.name)
    }
}

/// An atmosphere as an argument.
#[derive(FromPyObject)]
pub enum AirArgument<'py> {
    Air(PyRef<'py, Atmosphere>),
    Preset(String),
}

impl AirArgument<'_> {
    /// The atmosphere, or the name of a preset.
    pub fn or_preset(self) -> Result<atmosphere::Atmosphere, String> {
        match self {
            Self::Air(air) => Ok(air.0.clone()),
            Self::Preset(name) => Err(name),
        }
    }
}
