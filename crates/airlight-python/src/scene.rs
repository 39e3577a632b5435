//! `Scene` and `RadianceView`: every solver and published model.

use crate::arrays::{self, Vectors};
use crate::compute::compute;
use crate::errors::Failure;
use crate::picture::Picture;
use airlight::models::registry;
use airlight::scene::{self, Channels};
use airlight::sky::SunCoverage;
use airlight_render::probe::{Probe, ProbeRay};
use airlight_render::{Renderer, scene_file};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Names of the solvers and published models, each with one line that describes it.
///
/// Returns
/// -------
/// dict[str, str]
#[pyfunction]
pub fn models() -> BTreeMap<&'static str, &'static str> {
    let models = registry::ALL.iter();
    models
        .map(|model| (model.name(), model.summary()))
        .collect()
}

/// A scene: sun, air, fog, objects, solver and camera, as in a scene file.
///
/// ``Scene.from_toml`` and ``Scene.load`` read one; the book's chapter on scene files lists the keys.
///
/// Examples
/// --------
/// >>> scene = airlight.Scene.from_toml("sun.elevation_deg = 10\ncamera.size = [128, 64]")
/// >>> scene.render().rgb.shape
/// (64, 128, 3)
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct Scene(scene::Scene);

impl Scene {
    /// The scene of the library.
    pub fn scene(&self) -> &scene::Scene {
        &self.0
    }
}

#[pymethods]
impl Scene {
    /// A scene from TOML. Files that it names are read from the working folder.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The TOML text.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     With line, column and key of the problem.
    /// OSError
    ///     For a file that cannot be read.
    #[staticmethod]
    fn from_toml(text: &str) -> Result<Self, Failure> {
        let mut scene = scene::Scene::from_toml(text)?;
        scene_file::inline_files(&mut scene, Path::new(""))?;
        Ok(Self(scene))
    }

    /// A scene from a file, and the files that it names.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The scene file.
    #[staticmethod]
    fn load(path: PathBuf) -> Result<Self, Failure> {
        Ok(Self(scene_file::load(&path)?))
    }

    /// The scene as TOML.
    ///
    /// Returns
    /// -------
    /// str
    fn to_toml(&self) -> Result<String, Failure> {
        Ok(self.0.to_toml()?)
    }

    /// Draws the scene to memory.
    ///
    /// Parameters
    /// ----------
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// Picture
    #[pyo3(signature = (*, threads=None))]
    fn render(&self, py: Python<'_>, threads: Option<usize>) -> PyResult<Picture> {
        let image = compute(py, threads, |control| {
            Renderer::new(&self.0)?.render(control)
        })?;
        Picture::new(py, image)
    }

    /// Writes the scene's picture, or those of its sequence, as ``airlight sky`` does.
    ///
    /// Parameters
    /// ----------
    /// path : str, os.PathLike or None
    ///     The file; None: ``output.file`` of the scene.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// list[pathlib.Path]
    ///     The files that were written.
    #[pyo3(signature = (path=None, *, threads=None))]
    fn write(
        &self,
        py: Python<'_>,
        path: Option<PathBuf>,
        threads: Option<usize>,
    ) -> PyResult<Vec<PathBuf>> {
        let mut scene = self.0.clone();
        if let Some(path) = path {
            scene.output.file = Some(path.to_string_lossy().into_owned());
        }
        let files = compute(py, threads, |control| Renderer::new(&scene)?.write(control))?;
        Ok(files.into_iter().map(|file| file.path).collect())
    }

    /// The light at the eye by the scene's solver or published model.
    ///
    /// Parameters
    /// ----------
    /// channels : str
    ///     ``spectral``, or an RGB space: ``srgb``, ``rec2020``, ``acescg``, with the values of pictures.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// RadianceView
    #[pyo3(signature = (channels="spectral", *, threads=None))]
    fn view(
        &self,
        py: Python<'_>,
        channels: &str,
        threads: Option<usize>,
    ) -> PyResult<RadianceView> {
        let channels = match channels {
            "spectral" => Channels::Spectral,
            space => Channels::Rgb(space.parse().map_err(Failure::from)?),
        };
        let view = compute(py, threads, |control| {
            let mut scene = self.0.resolve()?;
            if channels != Channels::Spectral {
                scene = scene.for_colors();
            }
            let sun = scene.sun.at_start()?;
            let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
            let prepared = registry::prepare(&scene, suns, control)?;
            let (altitude_m, state) = (scene.observer_altitude_m, sun.state());
            Ok::<_, Failure>(match scene.night(&sun) {
                Some(night) => {
                    prepared.night_view_with(altitude_m, &state, &night, channels, control)?
                }
                None => prepared.view_with(altitude_m, &state, channels, control)?,
            })
        })?;
        let solver = self.0.solver.name.as_deref();
        Ok(RadianceView {
            view,
            solver: solver.unwrap_or(registry::DEFAULT).to_owned(),
        })
    }

    /// Light along directions as a table, as ``airlight probe`` prints it; needs the package pandas.
    ///
    /// Parameters
    /// ----------
    /// azimuth_deg, elevation_deg : list of float
    ///     Directions, degrees clockwise from north and above the horizon.
    /// distance_m : float or None
    ///     Length of the rays, m; None: to the ground or to space.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// pandas.DataFrame
    ///     A row for each direction and wavelength; the names of the columns state units.
    #[pyo3(signature = (azimuth_deg, elevation_deg, distance_m=None, *, threads=None))]
    fn probe<'py>(
        &self,
        py: Python<'py>,
        azimuth_deg: Vec<f64>,
        elevation_deg: Vec<f64>,
        distance_m: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let csv = self.probe_csv(py, azimuth_deg, elevation_deg, distance_m, threads)?;
        let tables = py.import("airlight._tables")?;
        tables.call_method1("frame_of_csv", (csv,))
    }

    /// Light along directions as CSV, as ``airlight probe`` prints it.
    ///
    /// Parameters
    /// ----------
    /// azimuth_deg, elevation_deg : list of float
    ///     Directions, degrees clockwise from north and above the horizon.
    /// distance_m : float or None
    ///     Length of the rays, m; None: to the ground or to space.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// str
    #[pyo3(signature = (azimuth_deg, elevation_deg, distance_m=None, *, threads=None))]
    fn probe_csv(
        &self,
        py: Python<'_>,
        azimuth_deg: Vec<f64>,
        elevation_deg: Vec<f64>,
        distance_m: Option<f64>,
        threads: Option<usize>,
    ) -> PyResult<String> {
        if azimuth_deg.len() != elevation_deg.len() {
            return Err(Failure::invalid(format!(
                "expected as many azimuths as elevations, got {} and {}",
                azimuth_deg.len(),
                elevation_deg.len()
            ))
            .into());
        }
        let pairs = azimuth_deg.into_iter().zip(elevation_deg);
        let rays = pairs.map(|(azimuth_deg, elevation_deg)| ProbeRay {
            azimuth_deg,
            elevation_deg,
            distance_m,
        });
        let rays = rays.collect();
        compute(py, threads, |control| {
            Probe::new(&self.0, rays)?.answer(control)
        })
        .map(|answer| answer.to_csv())
    }

    /// The picture as the bytes of a PNG file, at most 512 pixels wide, which a notebook shows.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        /// Largest width of the picture.
        const WIDTH: u32 = 512;
        let image = compute(py, None, |control| {
            let renderer = Renderer::new(&self.0)?;
            let frame = renderer.layout().overview(WIDTH)?;
            let prepared = renderer.prepare(renderer.suns_near(&renderer.sun(None)?), control)?;
            let drawn = renderer.frame_with(prepared.as_ref(), None, control)?;
            drawn.image(&frame, control)
        })?;
        Picture::new(py, image)?._repr_png_(py)
    }

    fn __repr__(&self) -> String {
        let solver = self.0.solver.name.as_deref();
        format!("Scene(solver {:?})", solver.unwrap_or(registry::DEFAULT))
    }
}

/// The light at the eye of a scene: ``Scene.view`` makes it.
///
/// Values have one channel for each wavelength (W m^-2 sr^-1 nm^-1, W m^-2 nm^-1), or three of an RGB space (cd/m^2, lx).
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct RadianceView {
    view: Arc<dyn scene::RadianceView>,
    /// Name of the solver or published model.
    #[pyo3(get)]
    solver: String,
}

#[pymethods]
impl RadianceView {
    /// Wavelengths of a spectral view, nm: array of shape (w,); None for RGB.
    #[getter]
    fn wavelengths_nm<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let grid = self.view.grid()?;
        Some(arrays::vector(py, grid.wavelengths_nm().to_vec()))
    }

    /// Unit vector towards the sun: x east, y up, z south.
    #[getter]
    fn sun(&self) -> [f64; 3] {
        self.view.sun().to_array()
    }

    /// Radiance of sky, fog and ground without the sun's disc.
    ///
    /// Parameters
    /// ----------
    /// directions : array_like, shape (n, 3)
    ///     View directions.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n, channels), float32
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let directions = arrays::directions(directions);
        let count = self.view.channel_count();
        let values = compute(py, threads, |control| {
            arrays::for_directions(&directions, count, control, |directions, out| {
                Ok(self.view.radiance_with(directions, out, control)?)
            })
        })?;
        arrays::matrix(py, values, count)
    }

    /// Monte Carlo estimate of the radiance, of a scene with ``solver.name = "monte-carlo"``.
    ///
    /// Parameters
    /// ----------
    /// directions : array_like, shape (n, 3)
    ///     View directions.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// mean, standard_error : numpy.ndarray, shape (n, w), float64
    ///     W m^-2 sr^-1 nm^-1. The mean is within two standard errors of the true value in 95 % of cases.
    #[pyo3(signature = (directions, *, threads=None))]
    fn estimate<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let directions = arrays::directions(directions);
        let count = self.view.grid().map_or(0, |grid| grid.len());
        let sampler = self.view.sampler().ok_or_else(|| {
            Failure::invalid(format!(
                "estimate: expected a scene with solver.name = \"monte-carlo\", got \"{}\", which has no noise; try radiance",
                self.solver
            ))
        })?;
        let values = compute(py, threads, |control| {
            arrays::for_each_direction(&directions, 2 * count, control, |direction, out| {
                let found = sampler.estimate_with(direction, None, control)?;
                let (mean, error) = out.split_at_mut(count);
                mean.copy_from_slice(&found.mean);
                error.copy_from_slice(&found.standard_error);
                Ok(())
            })
        })?;
        arrays::matrix_pair(py, &values, count)
    }

    /// Irradiance of surfaces at the eye by all light except the sun's disc.
    ///
    /// Parameters
    /// ----------
    /// normals : array_like, shape (n, 3)
    ///     Normals of the surfaces.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n, channels), float32
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let normals = arrays::directions(normals);
        let count = self.view.channel_count();
        let values = compute(py, threads, |control| {
            arrays::for_directions(&normals, count, control, |normals, out| {
                self.view.irradiance(normals, out);
                Ok(())
            })
        })?;
        arrays::matrix(py, values, count)
    }

    /// Irradiance by the sun's disc of a surface that faces it: array of shape (channels,).
    fn sun_irradiance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let mut values = vec![0.0; self.view.channel_count()];
        compute(py, None, |_| {
            self.view.sun_irradiance(&mut values);
            Ok::<_, Failure>(())
        })?;
        Ok(arrays::vector(py, values))
    }

    /// Transmittance and path radiance of the air and fog between the eye and points.
    ///
    /// Parameters
    /// ----------
    /// directions : array_like, shape (n, 3)
    ///     View directions.
    /// distance_m : float
    ///     Distance of the points, m; infinite: to the ground or to space.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// transmittance, path_radiance : numpy.ndarray, shape (n, channels), float32
    #[pyo3(signature = (directions, distance_m, *, threads=None))]
    fn path<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        distance_m: f64,
        threads: Option<usize>,
    ) -> PyResult<[Bound<'py, PyArray2<f32>>; 2]> {
        if distance_m.is_nan() || distance_m < 0.0 {
            return Err(Failure::invalid(format!(
                "distance_m: expected 0 or above, got {distance_m}"
            ))
            .into());
        }
        let directions = arrays::directions(directions);
        let count = self.view.channel_count();
        let values = compute(py, threads, |control| {
            arrays::for_each_direction(&directions, 2 * count, control, |direction, out| {
                let out = out.split_at_mut(count);
                Ok(self.view.path_with(direction, distance_m, out, control)?)
            })
        })?;
        arrays::matrix_pair(py, &values, count)
    }

    fn __repr__(&self) -> String {
        format!(
            "RadianceView({:?}, {} channels)",
            self.solver,
            self.view.channel_count()
        )
    }
}
