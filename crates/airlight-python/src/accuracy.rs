//! `accuracy`: the report of the errors.

use crate::compute::compute;
use crate::errors::Failure;
use airlight_validation::report::{html, json, text};
use airlight_validation::{Check, Suite, run_with};
use pyo3::prelude::*;

/// Compares the solvers with measurements and other codes, as ``airlight accuracy`` does.
///
/// Parameters
/// ----------
/// suites : list of str or None
///     ``tables``, ``monte-carlo``, ``limits``, ``random-airs``, ``peers``, ``measured``; None: all of these, which takes minutes.
///     ``fine`` repeats them with the fine settings, which takes longer. The suites of frames of a graphics device are those of the
///     program alone.
/// threads : int or None
///     Number of threads.
///
/// Returns
/// -------
/// AccuracyReport
#[pyfunction]
#[pyo3(signature = (suites=None, *, threads=None))]
pub fn accuracy(
    py: Python<'_>,
    suites: Option<Vec<String>>,
    threads: Option<usize>,
) -> PyResult<AccuracyReport> {
    let suites = match suites {
        Some(names) => names
            .iter()
            .map(|name| name.parse().map_err(Failure::from))
            .collect::<Result<Vec<Suite>, _>>()?,
        None => Suite::USUAL.to_vec(),
    };
    compute(py, threads, |control| run_with(&suites, control)).map(AccuracyReport)
}

/// Errors of the solvers: ``airlight.accuracy`` makes it. A notebook shows it with plots.
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct AccuracyReport(Vec<Check>);

#[pymethods]
impl AccuracyReport {
    /// The report as text.
    ///
    /// Returns
    /// -------
    /// str
    fn text(&self) -> String {
        text(&self.0)
    }

    /// The report as JSON.
    ///
    /// Parameters
    /// ----------
    /// rows : bool
    ///     Whether every compared value is listed.
    ///
    /// Returns
    /// -------
    /// str
    #[pyo3(signature = (rows=false))]
    fn json(&self, rows: bool) -> Result<String, Failure> {
        json(&self.0, rows).map_err(|error| Failure::invalid(error.to_string()))
    }

    /// Whether every accuracy that the documentation states holds.
    #[getter]
    fn holds(&self) -> bool {
        self.0.iter().all(Check::holds)
    }

    /// The report as a page with plots, which a notebook shows.
    fn _repr_html_(&self) -> Result<String, Failure> {
        html(&self.0).map_err(|error| Failure::invalid(error.to_string()))
    }

    fn __repr__(&self) -> String {
        format!("AccuracyReport({} comparisons)", self.0.len())
    }
}
