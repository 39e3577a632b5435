//! `Picture`, and reading pictures and depth maps.

use crate::arrays::{self, Linear};
use crate::compute::compute;
use crate::errors::Failure;
use airlight_image::input::DepthOptions;
use airlight_image::output::{Metadata, png};
use airlight_image::rows::StoredRows;
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, PictureOptions, Size};
use airlight_render::RenderedImage;
use airlight_render::overlay::OverlaySpec;
use numpy::{PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::prelude::*;
use std::path::PathBuf;

/// A drawn picture: linear light, and how it is displayed.
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct Picture {
    rgb: Py<PyArray3<f32>>,
    size: Size,
    tone: ToneMapper,
    /// Name of the RGB space.
    #[pyo3(get)]
    space: String,
    /// Azimuth (clockwise from north) and elevation of the sun, degrees.
    #[pyo3(get)]
    sun: (f64, f64),
    /// Illuminance of a horizontal surface at the eye, lx.
    #[pyo3(get)]
    horizontal_illuminance_lx: f64,
}

impl Picture {
    /// A picture in memory as an object of Python, without a copy of its pixels.
    pub fn new(py: Python<'_>, image: RenderedImage) -> PyResult<Self> {
        let size = image.frame.size();
        let rgb = arrays::picture(py, image.rgb.into_flattened(), size, 3)?;
        Ok(Self {
            rgb: rgb.unbind(),
            size,
            tone: image.tone,
            space: image.space.to_string(),
            sun: (image.sun.azimuth_deg, image.sun.elevation_deg),
            horizontal_illuminance_lx: image.light.horizontal_lx(),
        })
    }

    fn pixels<'py>(&self, py: Python<'py>) -> PyReadonlyArray3<'py, f32> {
        self.rgb.bind(py).readonly()
    }
}

#[pymethods]
impl Picture {
    /// Linear red, green and blue, cd/m^2: array of shape (height, width, 3), float32.
    #[getter]
    fn rgb<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f32>> {
        self.rgb.bind(py).clone()
    }

    /// The exposed and tone-mapped picture: array of shape (height, width, 3), uint8, sRGB.
    fn displayed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let pixels = self.pixels(py);
        let rgb = arrays::in_order(&pixels);
        let values = compute(py, None, |control| {
            displayed_u8(&rgb, self.size, &self.tone, control)
        })?;
        arrays::picture(py, values, self.size, 3)
    }

    /// The displayed picture as the bytes of a PNG file, which a notebook shows.
    pub fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let pixels = self.pixels(py);
        let rgb = arrays::in_order(&pixels).into_owned();
        let png = compute(py, None, |control| {
            encode_png(rgb, self.size, &self.tone, control)
        })?;
        Ok(PyBytes::new(py, &png))
    }

    fn __repr__(&self) -> String {
        format!(
            "Picture({} x {}, {}, sun {:.2} degrees high)",
            self.size.width(),
            self.size.height(),
            self.space,
            self.sun.1
        )
    }
}

/// Display values of 8 bits, as they are in a PNG file.
pub fn displayed_u8(
    rgb: &[f32],
    size: Size,
    tone: &ToneMapper,
    control: Control<'_>,
) -> Result<Vec<u8>, Failure> {
    let row = 3 * size.width() as usize;
    let mut out = vec![0; rgb.len()];
    let rows = rgb.par_chunks_exact(row).zip(out.par_chunks_exact_mut(row));
    rows.zip(0..size.height())
        .try_for_each(|((linear, out), y)| {
            control.check()?;
            tone.row_to_u8(y, linear, out);
            Ok::<_, Failure>(())
        })?;
    Ok(out)
}

/// The bytes of a PNG file.
pub fn encode_png(
    rgb: Vec<f32>,
    size: Size,
    tone: &ToneMapper,
    control: Control<'_>,
) -> Result<Vec<u8>, Failure> {
    let rows = StoredRows::new(size.width(), 3, rgb)?;
    let (options, metadata) = (png::PngOptions::default(), Metadata::default());
    let mut bytes = Vec::new();
    png::encode(&mut bytes, size, &rows, tone, &options, &metadata, control)?;
    Ok(bytes)
}

/// Reads a picture: EXR, HDR, PNG, JPEG or TIFF.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The file.
/// layer : str or None
///     Layer of an EXR file.
///
/// Returns
/// -------
/// numpy.ndarray, shape (height, width, 3), float32
///     Linear light: of EXR, HDR and TIFF of floats in the unit of the file, of others relative to white.
#[pyfunction]
#[pyo3(signature = (path, layer=None))]
pub fn read_picture<'py>(
    py: Python<'py>,
    path: PathBuf,
    layer: Option<&str>,
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let picture = compute(py, None, |control| {
        airlight_image::read_picture_with(&path, layer, control)
    })?;
    arrays::picture(py, picture.rgb, picture.size, 3)
}

/// Writes a picture in the format of the ending of its name: EXR or HDR (linear light), PNG or JPEG (sRGB, cut off at white).
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The file.
/// rgb : array_like, shape (height, width, 3)
///     Linear light in sRGB primaries: in any unit for EXR and HDR, relative to white for PNG and JPEG.
#[pyfunction]
pub fn write_picture(py: Python<'_>, path: PathBuf, rgb: Linear) -> PyResult<()> {
    let Linear { size, values } = rgb;
    let options = PictureOptions::default();
    compute(py, None, |control| {
        let rows = StoredRows::new(size.width(), 3, values)?;
        let tone = ToneMapper::as_displayed();
        airlight_image::write_picture(&path, size, &rows, &tone, &options, control)
    })?;
    Ok(())
}

/// Reads a depth map: EXR, PNG, NPY, NPZ, PFM or TIFF.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The file.
/// depth_kind : str
///     ``z`` (along the camera's axis), ``ray`` (distance) or ``inverse``.
/// depth_scale : float
///     Metres for each unit of depth.
/// holes : str
///     Treatment of unknown depth: ``fill``, ``far``, ``sky-above`` or ``clear``.
///
/// Returns
/// -------
/// numpy.ndarray, shape (height, width), float32
///     Depth in metres, infinite for sky.
#[pyfunction]
#[pyo3(signature = (path, depth_kind="z", depth_scale=1.0, holes="fill"))]
pub fn read_depth<'py>(
    py: Python<'py>,
    path: PathBuf,
    depth_kind: &str,
    depth_scale: f64,
    holes: &str,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let spec = OverlaySpec {
        depth_kind: depth_kind.parse().map_err(Failure::from)?,
        depth_scale,
        holes: holes.parse().map_err(Failure::from)?,
        ..OverlaySpec::default()
    };
    let options: DepthOptions = spec.depth_options().map_err(Failure::from)?;
    let depth = compute(py, None, |control| {
        airlight_image::read_depth_with(&path, &options, control)
    })?;
    arrays::matrix(py, depth.metres, depth.size.width() as usize)
}
