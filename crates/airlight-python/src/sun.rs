//! Position of the sun, and directions.

use crate::arrays::{self, Numbers};
use crate::compute::compute;
use crate::errors::Failure;
use airlight::axes;
use airlight::sun::{self, Moment, Place, RefractingAir};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Azimuth, apparent and geometric elevation, and distance of the sun.
type Position<'py> = [Bound<'py, PyArray1<f64>>; 4];

/// Position of the sun: the work of ``airlight.sun_position``, which takes times of any kind.
///
/// Parameters
/// ----------
/// unix_s : array_like, shape (n,)
///     Seconds since 1970-01-01T00:00:00Z.
/// latitude_deg, longitude_deg : float
///     Degrees north and east.
/// altitude_m : float
///     Altitude above sea level, m.
/// pressure_pa, temperature_c : float or None
///     Air that refracts sunlight; None: no refraction.
///
/// Returns
/// -------
/// list of numpy.ndarray, shape (n,), float64
///     Azimuth (degrees clockwise from north), elevation, elevation without refraction (degrees), distance (AU).
#[pyfunction]
#[pyo3(
    signature = (unix_s, latitude_deg, longitude_deg, altitude_m=0.0, pressure_pa=Some(101_325.0), temperature_c=15.0),
    text_signature = "(unix_s, latitude_deg, longitude_deg, altitude_m=0.0, pressure_pa=101325.0, temperature_c=15.0)"
)]
pub fn sun_position<'py>(
    py: Python<'py>,
    unix_s: Numbers,
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    pressure_pa: Option<f64>,
    temperature_c: f64,
) -> PyResult<Position<'py>> {
    let place = Place {
        latitude_deg,
        longitude_deg,
        altitude_m,
    };
    let air = pressure_pa.map(|pressure_pa| RefractingAir {
        pressure_pa,
        temperature_c,
    });
    let times = arrays::numbers(unix_s);
    if let Some(index) = times.iter().position(|time| !time.is_finite()) {
        return Err(Failure::invalid(format!(
            "expected times, got {} at index {index}",
            times[index]
        ))
        .into());
    }
    let positions = compute(py, None, |control| {
        let position = |&time: &f64| {
            control.check()?;
            Ok(sun::sun_position(Moment::from_unix_s(time), place, air)?)
        };
        times
            .iter()
            .map(position)
            .collect::<Result<Vec<_>, Failure>>()
    })?;
    let parts = [
        |sun: &sun::SunPosition| sun.azimuth_deg,
        |sun: &sun::SunPosition| sun.elevation_deg,
        |sun: &sun::SunPosition| sun.geometric_elevation_deg,
        |sun: &sun::SunPosition| sun.distance_au,
    ];
    Ok(parts.map(|part| arrays::vector(py, positions.iter().map(part).collect())))
}

/// Seconds since 1970-01-01T00:00:00Z of a time as text.
///
/// Parameters
/// ----------
/// time : str
///     A time with its offset from UTC or its zone: ``2026-06-21T21:15:00+02:00``, ``2026-06-21 21:15 Europe/Paris``, ``now``.
///
/// Returns
/// -------
/// float
#[pyfunction]
pub fn unix_time(time: &str) -> Result<f64, Failure> {
    Ok(Moment::parse(time)?.unix_s())
}

/// Unit vectors of compass directions: x east, y up, z south.
///
/// Parameters
/// ----------
/// azimuth_deg : array_like, shape (n,)
///     Azimuths, degrees clockwise from north.
/// elevation_deg : array_like, shape (n,)
///     Elevations above the horizon, degrees.
///
/// Returns
/// -------
/// numpy.ndarray, shape (n, 3), float64
///
/// Examples
/// --------
/// >>> airlight.direction([90.0], [0.0]).round(6)
/// array([[ 1.,  0., -0.]])
#[pyfunction]
pub fn direction<'py>(
    py: Python<'py>,
    azimuth_deg: Numbers,
    elevation_deg: Numbers,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let [azimuths, elevations] = [azimuth_deg, elevation_deg].map(arrays::numbers);
    if azimuths.len() != elevations.len() {
        return Err(PyValueError::new_err(format!(
            "expected as many azimuths as elevations, got {} and {}",
            azimuths.len(),
            elevations.len()
        )));
    }
    let pairs = azimuths.into_iter().zip(elevations);
    let vectors =
        pairs.flat_map(|(azimuth, elevation)| axes::direction(azimuth, elevation).to_array());
    arrays::matrix(py, vectors.collect(), 3)
}
