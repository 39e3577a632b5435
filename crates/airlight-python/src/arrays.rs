//! Arrays of directions and pictures.

use crate::errors::Failure;
use airlight::Control;
use airlight_image::Size;
use glam::DVec3;
use numpy::ndarray::Dimension;
use numpy::{
    Element, IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray,
    PyReadonlyArrayDyn, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use std::borrow::Cow;

/// Unit vectors as an argument: anything that converts to an array of shape `(n, 3)`.
#[derive(Debug)]
pub struct Vectors(Vec<DVec3>);

/// Numbers as an argument: a number, or anything that converts to an array of shape `(n,)`.
#[derive(Debug)]
pub struct Numbers(Vec<f64>);

/// Depth as an argument: anything that converts to an array of shape `(height, width)`.
#[derive(Debug)]
pub struct Depths {
    /// Width and height.
    pub size: Size,
    /// Values, row by row.
    pub values: Vec<f32>,
}

/// Linear light as an argument: anything that converts to an array of shape `(height, width, 3)`.
#[derive(Debug)]
pub struct Linear {
    /// Width and height.
    pub size: Size,
    /// Red, green and blue, pixel by pixel, row by row.
    pub values: Vec<f32>,
}

/// The array that NumPy makes of an argument, of one of the numbers of dimensions.
fn as_array<'py, T: Element>(
    argument: Borrowed<'_, 'py, PyAny>,
    shape: &str,
    dimensions: &[usize],
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let py = argument.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (argument, T::get_dtype(py)))?;
    let array: PyReadonlyArrayDyn<'py, T> = array.extract()?;
    match dimensions.contains(&array.ndim()) {
        true => Ok(array),
        false => Err(PyValueError::new_err(format!(
            "expected an array of shape {shape}, got {:?}",
            array.shape()
        ))),
    }
}

impl<'py> FromPyObject<'_, 'py> for Vectors {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = as_array::<f64>(argument, "(n, 3)", &[2])?;
        if array.shape()[1] != 3 {
            return Err(PyValueError::new_err(format!(
                "expected directions of shape (n, 3): x east, y up, z south, got {:?}",
                array.shape()
            )));
        }
        let values = in_order(&array);
        let vectors = values.as_chunks::<3>().0.iter().enumerate();
        let unit = |(index, v): (usize, &[f64; 3])| {
            DVec3::from_array(*v).try_normalize().ok_or_else(|| {
                PyValueError::new_err(format!(
                    "expected directions that are finite and not zero, got {v:?} at index {index}"
                ))
            })
        };
        vectors.map(unit).collect::<PyResult<_>>().map(Self)
    }
}

impl<'py> FromPyObject<'_, 'py> for Numbers {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = as_array::<f64>(argument, "(n,)", &[0, 1])?;
        Ok(Self(in_order(&array).into_owned()))
    }
}

impl<'py> FromPyObject<'_, 'py> for Depths {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = as_array::<f32>(argument, "(height, width)", &[2])?;
        Ok(Self {
            size: size_of(array.shape())?,
            values: in_order(&array).into_owned(),
        })
    }
}

impl<'py> FromPyObject<'_, 'py> for Linear {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array = as_array::<f32>(argument, "(height, width, 3)", &[3])?;
        if array.shape()[2] != 3 {
            return Err(PyValueError::new_err(format!(
                "expected a picture of shape (height, width, 3), got {:?}",
                array.shape()
            )));
        }
        Ok(Self {
            size: size_of(array.shape())?,
            values: in_order(&array).into_owned(),
        })
    }
}

/// Directions that a thread takes at a time.
const CHUNK: usize = 16;

/// The directions of an argument.
pub fn directions(vectors: Vectors) -> Vec<DVec3> {
    vectors.0
}

/// The numbers of an argument.
pub fn numbers(values: Numbers) -> Vec<f64> {
    values.0
}

/// An array of shape `(n, columns)`.
pub fn matrix<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = values.len().checked_div(columns).unwrap_or(0);
    values.into_pyarray(py).reshape([rows, columns])
}

/// Two arrays of shape `(n, columns)`, from rows that hold those of both.
pub fn matrix_pair<'py, T: Element + Copy>(
    py: Python<'py>,
    values: &[T],
    columns: usize,
) -> PyResult<[Bound<'py, PyArray2<T>>; 2]> {
    let part = |first: usize| {
        let rows = values.chunks_exact(2 * columns);
        let part = rows.flat_map(|row| row[first..first + columns].iter().copied());
        matrix(py, part.collect(), columns)
    };
    Ok([part(0)?, part(columns)?])
}

/// An array of shape `(height, width, channels)`.
pub fn picture<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    size: Size,
    channels: usize,
) -> PyResult<Bound<'_, PyArray3<T>>> {
    let (width, height) = (size.width() as usize, size.height() as usize);
    values.into_pyarray(py).reshape([height, width, channels])
}

/// The values of a function of each direction, `count` for each, computed on all threads.
///
/// # Errors
/// Those of the function, and [`Failure::Cancelled`].
pub fn for_directions<T: Default + Clone + Send>(
    directions: &[DVec3],
    count: usize,
    control: Control<'_>,
    fill: impl Fn(&[DVec3], &mut [T]) -> Result<(), Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let mut out = vec![T::default(); directions.len() * count];
    if out.is_empty() {
        return Ok(out);
    }
    out.par_chunks_mut(CHUNK * count)
        .zip(directions.par_chunks(CHUNK))
        .try_for_each(|(out, directions)| {
            control.check()?;
            fill(directions, out)
        })?;
    Ok(out)
}

/// As [`for_directions`], of a function of one direction.
///
/// # Errors
/// As [`for_directions`].
pub fn for_each_direction<T: Default + Clone + Send>(
    directions: &[DVec3],
    count: usize,
    control: Control<'_>,
    fill: impl Fn(DVec3, &mut [T]) -> Result<(), Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    for_directions(directions, count, control, |directions, out| {
        let mut pairs = directions.iter().zip(out.chunks_exact_mut(count));
        pairs.try_for_each(|(&direction, out)| fill(direction, out))
    })
}

/// Width and height of an array of shape `(height, width, ..)`.
///
/// # Errors
/// [`Failure::Invalid`] for sides that no picture has.
pub fn size_of(shape: &[usize]) -> Result<Size, Failure> {
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Ok(Size::new(side(shape[1]), side(shape[0]))?)
}

/// The values of an array in row order, without a copy if they lie in that order.
pub fn in_order<'a, T: Element + Clone, D: Dimension>(
    array: &'a PyReadonlyArray<'_, T, D>,
) -> Cow<'a, [T]> {
    match array.as_slice() {
        Ok(slice) => Cow::Borrowed(slice),
        Err(_) => Cow::Owned(array.as_array().iter().cloned().collect()),
    }
}

/// An array of shape `(n,)`.
pub fn vector<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    values.into_pyarray(py)
}
