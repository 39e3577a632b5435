//! `Sky` and `View`.

use crate::arrays::{self, Numbers, Vectors};
use crate::atmosphere::{AirArgument, Atmosphere};
use crate::compute::compute;
use crate::errors::Failure;
use crate::picture::encode_png;
use airlight::atmosphere;
use airlight::axes;
use airlight::scene::{
    Channels, Effort, Orientation, OutputSpec, RadianceView, SolverSpec, SunState,
};
use airlight::sky::{self, LineOfSight, SunCoverage};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::{Cancelled, Control};
use airlight_image::rows::draw_rows;
use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Frame, Projection};
use airlight_render::channels::PixelChannels;
use airlight_render::exposure::{ExposureSettings, MeteredPicture};
use airlight_render::illuminance::Illuminances;
use airlight_render::sky_rows::{Layer, SkyRows, SkySources, SkyValues};
use airlight_render::sun_disc::SunDiscImage;
use glam::DVec3;
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::sync::{Arc, OnceLock};

/// Names of a grid, or wavelengths in nm.
#[derive(FromPyObject)]
enum GridArgument {
    Name(String),
    Wavelengths(Numbers),
}

impl GridArgument {
    fn grid(self) -> Result<WavelengthGrid, Failure> {
        Ok(match self {
            Self::Name(name) => name.parse()?,
            Self::Wavelengths(nm) => WavelengthGrid::from_wavelengths_nm(arrays::numbers(nm))?,
        })
    }
}

/// The solved light inside an atmosphere.
///
/// Parameters
/// ----------
/// atmosphere : Atmosphere or str
///     The air, or the name of a preset.
/// wavelengths : str or array_like, shape (w,)
///     A grid (``rgb``, ``fast``, ``standard``, ``fine``, ``1nm``) or wavelengths from 300 to 900 nm.
/// sun_elevation_deg : float or None
///     The sun for which to solve; None: all suns and altitudes, which takes several times longer. A view under another
///     sun is as right, but solves again.
/// altitude_m : float
///     Altitude of the eye for which to solve, m above sea level.
/// scattering : {'all', 'single'}
///     Orders of scattering.
/// effort : {'standard', 'fine'}
///     Resolution; the error of ``fine`` is below 0.5 %, and it is twenty times slower.
/// polarisation_correction : bool
///     Whether light is polarised by scattering, which changes its radiance by 1 to 3 %.
/// threads : int or None
///     Number of threads; None: one per processor. Results have the same bits for any number.
///
/// Examples
/// --------
/// >>> sky = airlight.Sky("clear", sun_elevation_deg=30)
/// >>> view = sky.view(sun_elevation_deg=30)
/// >>> view.radiance([[0, 1, 0]]).shape
/// (1, 16)
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct Sky(sky::Sky);

#[pymethods]
impl Sky {
    #[new]
    #[pyo3(signature = (
        atmosphere = AirArgument::Preset("average".to_owned()),
        *,
        wavelengths = GridArgument::Name("standard".to_owned()),
        sun_elevation_deg = None,
        altitude_m = 2.0,
        scattering = "all",
        effort = "standard",
        polarisation_correction = true,
        threads = None
    ), text_signature = "(atmosphere='average', *, wavelengths='standard', sun_elevation_deg=None, altitude_m=2.0, scattering='all', effort='standard', polarisation_correction=True, threads=None)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn new(
        py: Python<'_>,
        atmosphere: AirArgument<'_>,
        wavelengths: GridArgument,
        sun_elevation_deg: Option<f64>,
        altitude_m: f64,
        scattering: &str,
        effort: &str,
        polarisation_correction: bool,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let suns = match sun_elevation_deg {
            Some(elevation_deg) => SunCoverage::near(elevation_deg, altitude_m),
            None => SunCoverage::All,
        };
        let solver = SolverSpec {
            scattering: Some(scattering.parse().map_err(Failure::from)?),
            effort: Some(effort.parse::<Effort>().map_err(Failure::from)?),
            polarisation_correction: Some(polarisation_correction),
            ..SolverSpec::default()
        };
        let settings = solver.sky_settings(suns);
        let (air, grid) = (atmosphere.or_preset(), wavelengths.grid()?);
        compute(py, threads, |control| {
            let air = air.or_else(|preset| atmosphere::preset(&preset))?;
            let sky = sky::Sky::prepare_with(&air, &grid, &settings, control)?;
            Ok::<_, Failure>(Self(sky))
        })
    }

    /// The atmosphere.
    #[getter]
    fn atmosphere(&self) -> Atmosphere {
        Atmosphere(self.0.atmosphere().clone())
    }

    /// Wavelengths, nm: array of shape (w,).
    #[getter]
    fn wavelengths_nm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        arrays::vector(py, self.0.grid().wavelengths_nm().to_vec())
    }

    /// Solar irradiance outside the air at the planet's mean distance, W m^-2 nm^-1: array of shape (w,).
    #[getter]
    fn solar_irradiance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        arrays::vector(py, self.0.grid().solar_irradiance().to_vec())
    }

    /// Estimated relative error of the iteration over orders of scattering.
    #[getter]
    fn iteration_error(&self) -> f32 {
        self.0.iteration_error()
    }

    /// The sky from one altitude under one sun.
    ///
    /// Parameters
    /// ----------
    /// altitude_m : float
    ///     Altitude of the eye, m above sea level; raised to the ground if below it.
    /// sun_elevation_deg, sun_azimuth_deg : float
    ///     Elevation above the horizon, and azimuth clockwise from north, degrees.
    /// distance_ratio : float
    ///     Distance of the sun relative to the planet's mean distance.
    /// threads : int or None
    ///     Number of threads, where the sky has to be solved again.
    ///
    /// Returns
    /// -------
    /// View
    #[pyo3(signature = (altitude_m=2.0, *, sun_elevation_deg, sun_azimuth_deg=180.0, distance_ratio=1.0, threads=None))]
    fn view(
        &self,
        py: Python<'_>,
        altitude_m: f64,
        sun_elevation_deg: f64,
        sun_azimuth_deg: f64,
        distance_ratio: f64,
        threads: Option<usize>,
    ) -> PyResult<View> {
        check_finite(&[
            ("altitude_m", altitude_m),
            ("sun_elevation_deg", sun_elevation_deg),
            ("sun_azimuth_deg", sun_azimuth_deg),
        ])?;
        if !(distance_ratio.is_finite() && distance_ratio > 0.0) {
            return Err(Failure::invalid(format!(
                "distance_ratio: expected a finite number above 0, got {distance_ratio}"
            ))
            .into());
        }
        let sun = SunState {
            direction: axes::direction(sun_azimuth_deg, sun_elevation_deg),
            distance_ratio,
        };
        let view = compute(py, threads, |control| {
            self.0.view_with(altitude_m, sun, control)
        })?;
        Ok(View {
            view,
            spectral: OnceLock::new(),
        })
    }

    fn __repr__(&self) -> String {
        let nm = self.0.grid().wavelengths_nm();
        format!(
            "Sky({:?}, {} wavelengths from {} to {} nm)",
            self.0.atmosphere().name,
            nm.len(),
            nm[0],
            nm[nm.len() - 1]
        )
    }
}

/// Refuses numbers that are not finite.
pub fn check_finite(values: &[(&str, f64)]) -> Result<(), Failure> {
    match values.iter().find(|(_, value)| !value.is_finite()) {
        Some((name, value)) => Err(Failure::invalid(format!(
            "{name}: expected a finite number, got {value}"
        ))),
        None => Ok(()),
    }
}

/// The light at one eye under one sun: ``Sky.view`` makes it.
///
/// Directions are arrays of shape (n, 3), x east, y up, z south, of any length; ``airlight.direction`` makes them from azimuth
/// and elevation. Radiances are in W m^-2 sr^-1 nm^-1 at the wavelengths of the sky, luminances in cd/m^2, without the sun's disc.
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct View {
    view: sky::View,
    /// Tables for irradiances, once they are needed.
    spectral: OnceLock<Arc<dyn RadianceView>>,
}

impl View {
    /// Values of the light along rays, `count` for each.
    fn along(
        &self,
        py: Python<'_>,
        directions: &[DVec3],
        count: usize,
        threads: Option<usize>,
        values: impl Fn(&LineOfSight, &mut [f32]) + Sync,
    ) -> PyResult<Vec<f32>> {
        compute(py, threads, |control| {
            arrays::for_each_direction(directions, count, control, |direction, out| {
                values(&self.view.along(direction, None), out);
                Ok(())
            })
        })
    }

    fn grid(&self) -> &WavelengthGrid {
        self.view.sky().grid()
    }

    /// The view with its tables at the wavelengths of the sky, computed once.
    fn spectral_view(&self, control: Control<'_>) -> Result<&Arc<dyn RadianceView>, Failure> {
        if let Some(view) = self.spectral.get() {
            return Ok(view);
        }
        let view = self.view.radiance_view_with(Channels::Spectral, control)?;
        Ok(self.spectral.get_or_init(|| view))
    }

    /// Linear red, green and blue of a picture, row by row, cd/m^2.
    fn draw(
        &self,
        frame: &Frame,
        view: &Arc<dyn RadianceView>,
        space: RgbSpace,
        layer: Layer,
        control: Control<'_>,
    ) -> Result<Vec<f32>, Failure> {
        control.check()?;
        let disc = SunDiscImage::new(view.clone());
        let sources = SkySources {
            sky: SkyValues::View(view.as_ref()),
            discs: disc.as_slice(),
            stars: None,
        };
        let channels = PixelChannels::rgb(space);
        let rows = SkyRows::new(frame, layer, sources, &channels, 1.0);
        Ok(draw_rows(&rows, frame.size(), control)?)
    }

    /// Irradiance of a horizontal surface, one value per wavelength.
    fn horizontal_irradiance<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
        of: fn(&sky::View) -> Vec<f32>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let values = compute(py, threads, |control| {
            control.check()?;
            Ok::<_, Cancelled>(of(&self.view))
        })?;
        Ok(arrays::vector(py, values))
    }
}

#[pymethods]
impl View {
    /// Wavelengths, nm: array of shape (w,).
    #[getter]
    fn wavelengths_nm<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        arrays::vector(py, self.grid().wavelengths_nm().to_vec())
    }

    /// Unit vector towards the sun: x east, y up, z south.
    #[getter]
    fn sun(&self) -> [f64; 3] {
        self.view.sun().to_array()
    }

    /// Elevation of the horizon, degrees: 0 on the ground, below 0 from above.
    #[getter]
    fn horizon_elevation_deg(&self) -> f64 {
        self.view.horizon_elevation_rad().to_degrees()
    }

    /// Radiance of sky and ground, all orders of scattering.
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
    /// numpy.ndarray, shape (n, w), float32
    ///     W m^-2 sr^-1 nm^-1.
    #[pyo3(signature = (directions, *, threads=None))]
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (directions, count) = (arrays::directions(directions), self.grid().len());
        let values = self.along(py, &directions, count, threads, |light, out| {
            out.copy_from_slice(&light.radiance());
        })?;
        arrays::matrix(py, values, count)
    }

    /// Transmittance of the air to space or to the ground.
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
    /// numpy.ndarray, shape (n, w), float32
    #[pyo3(signature = (directions, *, threads=None))]
    fn transmittance<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (directions, count) = (arrays::directions(directions), self.grid().len());
        let values = self.along(py, &directions, count, threads, |light, out| {
            out.copy_from_slice(&light.transmittance);
        })?;
        arrays::matrix(py, values, count)
    }

    /// Luminance of sky and ground.
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
    /// numpy.ndarray, shape (n,), float32
    ///     cd/m^2.
    #[pyo3(signature = (directions, *, threads=None))]
    fn luminance<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let (directions, grid) = (arrays::directions(directions), self.grid());
        let values = self.along(py, &directions, 1, threads, |light, out| {
            out[0] = grid.to_xyz(&light.radiance())[1] as f32;
        })?;
        Ok(arrays::vector(py, values))
    }

    /// Linear red, green and blue of sky and ground.
    ///
    /// Parameters
    /// ----------
    /// directions : array_like, shape (n, 3)
    ///     View directions.
    /// space : str
    ///     ``srgb``, ``rec2020``, ``acescg`` or ``acescg-unadapted``.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n, 3), float32
    ///     cd/m^2: (1, 1, 1) is 1 cd/m^2 of the white of the space.
    #[pyo3(signature = (directions, space="srgb", *, threads=None))]
    fn rgb<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        space: &str,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let space: RgbSpace = space.parse().map_err(Failure::from)?;
        let (directions, grid) = (arrays::directions(directions), self.grid());
        let values = self.along(py, &directions, 3, threads, |light, out| {
            let rgb = space.from_xyz(grid.to_xyz(&light.radiance()));
            out.copy_from_slice(&rgb.map(|v| v as f32));
        })?;
        arrays::matrix(py, values, 3)
    }

    /// Irradiance by sky and ground of surfaces at the eye, without the sun's disc.
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
    /// numpy.ndarray, shape (n, w), float32
    ///     W m^-2 nm^-1.
    #[pyo3(signature = (normals, *, threads=None))]
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        normals: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (normals, count) = (arrays::directions(normals), self.grid().len());
        let values = compute(py, threads, |control| {
            let view = self.spectral_view(control)?;
            arrays::for_directions(&normals, count, control, |normals, out| {
                view.irradiance(normals, out);
                Ok(())
            })
        })?;
        arrays::matrix(py, values, count)
    }

    /// Diffuse downwelling irradiance at the eye: of a horizontal surface that faces up, without the sun's disc.
    ///
    /// As ``irradiance`` to 1 %, without the tables that it needs first.
    ///
    /// Parameters
    /// ----------
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (w,), float32
    ///     W m^-2 nm^-1.
    #[pyo3(signature = (*, threads=None))]
    fn downwelling_irradiance<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.horizontal_irradiance(py, threads, sky::View::downwelling_irradiance)
    }

    /// Upwelling irradiance at the eye: of a horizontal surface that faces down, by ground and air.
    ///
    /// Parameters
    /// ----------
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (w,), float32
    ///     W m^-2 nm^-1.
    #[pyo3(signature = (*, threads=None))]
    fn upwelling_irradiance<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        self.horizontal_irradiance(py, threads, sky::View::upwelling_irradiance)
    }

    /// Irradiance by the sun's disc of a surface that faces it, W m^-2 nm^-1: array of shape (w,).
    fn sun_irradiance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let values = py.detach(|| self.view.sun_irradiance());
        arrays::vector(py, values)
    }

    /// Illuminance by the sun's disc of a surface that faces it, as red, green and blue.
    ///
    /// Parameters
    /// ----------
    /// space : str
    ///     RGB space, as for ``rgb``.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (3,), float32
    ///     Linear light, lx; below 0 for colours outside the space, such as those of a low sun.
    #[pyo3(signature = (space="srgb"))]
    fn sun_illuminance<'py>(
        &self,
        py: Python<'py>,
        space: &str,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let space: RgbSpace = space.parse().map_err(Failure::from)?;
        let spectrum = py.detach(|| self.view.sun_irradiance());
        let rgb = space.from_xyz(self.grid().to_xyz(&spectrum));
        Ok(arrays::vector(py, rgb.map(|v| v as f32).to_vec()))
    }

    /// Diameter of the sun's disc at its distance, degrees.
    #[getter]
    fn sun_diameter_deg(&self) -> f64 {
        2.0 * self.view.disc().angular_radius_rad.to_degrees()
    }

    /// Radiance of the sun's disc at the eye; 0 outside the disc and behind the planet.
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
    /// numpy.ndarray, shape (n, w), float32
    ///     W m^-2 sr^-1 nm^-1.
    #[pyo3(signature = (directions, *, threads=None))]
    fn sun_disc_radiance<'py>(
        &self,
        py: Python<'py>,
        directions: Vectors,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (directions, count) = (arrays::directions(directions), self.grid().len());
        let values = compute(py, threads, |control| {
            arrays::for_each_direction(&directions, count, control, |direction, out| {
                out.copy_from_slice(&self.view.sun_disc_radiance(direction));
                Ok(())
            })
        })?;
        arrays::matrix(py, values, count)
    }

    /// The whole sphere as an equirectangular picture: the zenith at the top, azimuth increases to the right.
    ///
    /// The values are those of ``airlight sky`` with the same settings, to the bit.
    ///
    /// Parameters
    /// ----------
    /// height : int
    ///     Number of rows; the picture is twice as wide.
    /// space : str
    ///     RGB space.
    /// sun_disc : bool
    ///     Whether the sun's disc is drawn.
    /// orientation : str
    ///     Program for whose axes it is oriented: ``airlight`` (north in the centre), ``blender``, ``mitsuba``, ``three``, ``unreal``,
    ///     ``unity`` or ``godot``.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (height, 2 * height, 3), float32
    ///     Linear light, cd/m^2.
    #[pyo3(signature = (height=512, space="srgb", *, sun_disc=true, orientation="airlight", threads=None))]
    fn panorama<'py>(
        &self,
        py: Python<'py>,
        height: u32,
        space: &str,
        sun_disc: bool,
        orientation: &str,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let space: RgbSpace = space.parse().map_err(Failure::from)?;
        let orientation: Orientation = orientation.parse().map_err(Failure::from)?;
        let center_azimuth_deg = orientation.center_azimuth_deg();
        let projection = Projection::Equirectangular { center_azimuth_deg };
        let frame =
            Frame::new(projection, height.saturating_mul(2), height).map_err(Failure::from)?;
        let layer = if sun_disc { Layer::All } else { Layer::Sky };
        let values = compute(py, threads, |control| {
            let view = self
                .view
                .radiance_view_with(Channels::Rgb(space), control)?;
            self.draw(&frame, &view, space, layer, control)
        })?;
        arrays::picture(py, values, frame.size(), 3)
    }

    /// Radiance on a grid of directions as an xarray, with units as attributes; needs the package xarray.
    ///
    /// Parameters
    /// ----------
    /// azimuth_deg, elevation_deg : array_like or None
    ///     Directions, degrees; None: every 10 degrees of azimuth, every 5 of elevation above the horizon.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// xarray.DataArray
    ///     Dimensions ``azimuth``, ``elevation`` and ``wavelength``.
    #[pyo3(signature = (azimuth_deg=None, elevation_deg=None, *, threads=None))]
    fn to_xarray<'py>(
        slf: &Bound<'py, Self>,
        azimuth_deg: Option<Bound<'py, PyAny>>,
        elevation_deg: Option<Bound<'py, PyAny>>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let tables = slf.py().import("airlight._tables")?;
        tables.call_method1("view_to_xarray", (slf, azimuth_deg, elevation_deg, threads))
    }

    /// The panorama as the bytes of a PNG file, exposed automatically, which a notebook shows.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        /// Rows of the picture.
        const ROWS: u32 = 256;
        let space = RgbSpace::Srgb;
        let frame = Frame::equirectangular(ROWS).map_err(Failure::from)?;
        let bytes = compute(py, None, |control| {
            let view = self
                .view
                .radiance_view_with(Channels::Rgb(space), control)?;
            let draw = |layer| self.draw(&frame, &view, space, layer, control);
            let sky = draw(Layer::Sky)?;
            let metered = MeteredPicture::of_frame(
                &frame,
                sky.as_chunks::<3>().0,
                space,
                self.view.horizon_elevation_rad(),
                Illuminances::of(view.as_ref()).horizontal_lx(),
            );
            let output = OutputSpec::default();
            let exposure = ExposureSettings::of(&output).metered(&metered)?;
            let tone = ToneMapper::new(exposure.factor() as f32, ToneCurve::default())?;
            encode_png(draw(Layer::All)?, frame.size(), &tone, control)
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __repr__(&self) -> String {
        let sun = self.view.sun();
        format!(
            "View({:?}, sun {:.2} degrees high at azimuth {:.2})",
            self.view.sky().atmosphere().name,
            axes::elevation_deg(sun),
            axes::azimuth_deg(sun)
        )
    }
}
