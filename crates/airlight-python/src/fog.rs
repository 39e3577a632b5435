//! `Fog`: fog over pictures with depth, as arrays.

use crate::arrays::{self, Depths};
use crate::compute::compute;
use crate::errors::Failure;
use crate::picture::displayed_u8;
use airlight::Control;
use airlight::scene::FogPatchesSpec;
use airlight_image::Size;
use airlight_image::input::{DepthMap, Picture, SampleBits};
use airlight_image::rows::draw_rows;
use airlight_image::tone::ToneMapper;
use airlight_render::overlay::{OverlayImage, OverlayScene, PreparedOverlay, SkyLight};
use airlight_render::scene_file;
use numpy::{PyArray2, PyArray3, PyReadonlyArray3, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::borrow::Cow;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// A colour picture as an argument.
enum Colours<'py> {
    U8(PyReadonlyArray3<'py, u8>),
    U16(PyReadonlyArray3<'py, u16>),
    F32(PyReadonlyArray3<'py, f32>),
}

/// A picture in fog, in the type of the picture that was given.
#[derive(IntoPyObject)]
enum Foggy<'py> {
    U8(Bound<'py, PyArray3<u8>>),
    U16(Bound<'py, PyArray3<u16>>),
    F32(Bound<'py, PyArray3<f32>>),
}

impl<'py> FromPyObject<'_, 'py> for Colours<'py> {
    type Error = PyErr;

    fn extract(argument: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(array) = argument.extract() {
            return Ok(Self::U8(array));
        }
        if let Ok(array) = argument.extract() {
            return Ok(Self::F32(array));
        }
        if let Ok(array) = argument.extract() {
            return Ok(Self::U16(array));
        }
        let got = match argument.cast::<PyUntypedArray>() {
            Ok(array) => format!("{} of shape {:?}", array.dtype(), array.shape()),
            Err(_) => argument.get_type().name()?.to_string(),
        };
        Err(PyValueError::new_err(format!(
            "picture: expected an array of uint8, uint16 or float32 of shape (height, width, 3), got {got}"
        )))
    }
}

impl Colours<'_> {
    fn shape(&self) -> &[usize] {
        match self {
            Self::U8(array) => array.shape(),
            Self::U16(array) => array.shape(),
            Self::F32(array) => array.shape(),
        }
    }

    /// The values, which another thread may read.
    fn pixels(&self) -> Result<Pixels<'_>, Failure> {
        let shape = self.shape();
        if shape[2] != 3 {
            return Err(Failure::invalid(format!(
                "expected a picture of shape (height, width, 3), got ({}, {}, {})",
                shape[0], shape[1], shape[2]
            )));
        }
        Ok(Pixels {
            size: arrays::size_of(shape)?,
            values: match self {
                Self::U8(array) => Values::U8(arrays::in_order(array)),
                Self::U16(array) => Values::U16(arrays::in_order(array)),
                Self::F32(array) => Values::F32(arrays::in_order(array)),
            },
        })
    }
}

/// Values of a colour picture, row by row.
struct Pixels<'a> {
    size: Size,
    values: Values<'a>,
}

/// Values in the type of an array.
enum Values<'a> {
    U8(Cow<'a, [u8]>),
    U16(Cow<'a, [u16]>),
    F32(Cow<'a, [f32]>),
}

impl Pixels<'_> {
    fn picture(&self) -> Result<Picture, Failure> {
        Ok(match &self.values {
            Values::U8(values) => Picture::from_srgb_u8(self.size, values)?,
            Values::U16(values) => Picture::from_srgb_u16(self.size, values)?,
            Values::F32(values) => Picture::from_linear(self.size, values)?,
        })
    }

    /// Linear light in the type of these values.
    fn encoded(&self, linear: Vec<f32>, control: Control<'_>) -> Result<Values<'static>, Failure> {
        let tone = ToneMapper::as_displayed();
        Ok(match &self.values {
            Values::U8(_) => Values::U8(displayed_u8(&linear, self.size, &tone, control)?.into()),
            Values::U16(_) => {
                let mut values = vec![0; linear.len()];
                tone.row_to_u16(&linear, &mut values);
                Values::U16(values.into())
            }
            Values::F32(_) => Values::F32(linear.into()),
        })
    }
}

/// Fog over pictures with depth.
///
/// Parameters
/// ----------
/// visibility_m : float
///     Visibility where the fog is densest, m: the distance at which contrast falls to 5 %.
/// profile : str or None
///     ``uniform``, ``height``, ``clamped``, ``unclamped``, ``slab``, ``exp2``, ``linear`` or ``foggy-cityscapes``;
///     None: uniform, or what the heights imply.
/// scale_height_m, base_height_m, top_m : float or None
///     Heights of the profile above the ground, m.
/// droplets : str or None
///     Kind of droplets; None: radiation fog.
/// scattering : str or None
///     ``all``, ``single`` or ``undimmed``; None: all.
/// patch_strength, patch_size_m, patch_seed : float, float, int or None
///     Patches: standard deviation of the density relative to its mean, width (m), and seed. None: even fog.
/// fov_deg, focal_px : float or None
///     Horizontal field of view (degrees; None: 60), or focal length in pixels.
/// eye_height_m : float or None
///     Height of the camera above the ground, m; None: 1.6.
/// camera_azimuth_deg, camera_elevation_deg, camera_roll_deg : float or None
///     Direction of the camera's axis, degrees; None: 0.
/// ambient : (float, float, float) or None
///     Linear radiance of the ambient light in the picture's unit; None: estimated from each picture.
/// ambient_scale : float
///     Factor on the ambient light.
/// sun_elevation_deg, sun_azimuth_deg, sun_strength : float or None
///     A sun that lights the fog; its irradiance relative to that of the ambient light (None: 3).
/// depth_kind : str
///     ``z`` (along the camera's axis), ``ray`` (distance) or ``inverse``.
/// depth_scale : float
///     Metres for each unit of depth.
/// holes : str
///     Treatment of unknown depth (0 or NaN): ``fill``, ``far``, ``sky-above`` or ``clear``.
/// far_m : float or None
///     Pixels at this distance or beyond are sky, m.
///
/// Examples
/// --------
/// >>> fog = airlight.Fog(visibility_m=120)
/// >>> foggy = fog(picture, depth)
#[pyclass(frozen, module = "airlight")]
#[derive(Debug)]
pub struct Fog {
    scene: OverlayScene,
    /// The solved sky, once it is needed.
    sky: Mutex<Option<Arc<SkyLight>>>,
}

impl Fog {
    fn of_scene(scene: OverlayScene) -> Result<Self, Failure> {
        scene.check()?;
        Ok(Self {
            scene,
            sky: Mutex::new(None),
        })
    }

    fn sky_light(&self, control: Control<'_>) -> Result<Option<Arc<SkyLight>>, Failure> {
        // Solved without the lock: threads of the pool would wait for each other.
        let known = || self.sky.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(sky) = known().clone() {
            return Ok(Some(sky));
        }
        let solved = self.scene.solve_sky_with(control)?.map(Arc::new);
        known().clone_from(&solved);
        Ok(solved)
    }

    /// Rows of a picture in fog: colours, or with `layers` ten channels.
    fn draw(
        &self,
        picture: Picture,
        depth: Depths,
        layers: bool,
        control: Control<'_>,
    ) -> Result<Vec<f32>, Failure> {
        let mut scene = Cow::Borrowed(&self.scene);
        if layers {
            scene.to_mut().overlay.layers = true;
        }
        let options = scene.overlay.depth_options()?;
        let depth = DepthMap::from_numbers(depth.size, depth.values, SampleBits::Float, &options)?;
        let image = OverlayImage::new(&scene.overlay, picture, depth)?;
        let sky = self.sky_light(control)?;
        let prepared = PreparedOverlay::new_with(&scene, &image, sky.as_deref(), control)?;
        let rows = prepared.overlay(&image)?;
        Ok(draw_rows(&rows, image.picture.size, control)?)
    }
}

#[pymethods]
impl Fog {
    #[new]
    #[pyo3(signature = (
        visibility_m,
        *,
        profile = None,
        scale_height_m = None,
        base_height_m = None,
        top_m = None,
        droplets = None,
        scattering = None,
        patch_strength = None,
        patch_size_m = None,
        patch_seed = None,
        fov_deg = None,
        focal_px = None,
        eye_height_m = None,
        camera_azimuth_deg = None,
        camera_elevation_deg = None,
        camera_roll_deg = None,
        ambient = None,
        ambient_scale = 1.0,
        sun_elevation_deg = None,
        sun_azimuth_deg = None,
        sun_strength = None,
        depth_kind = "z",
        depth_scale = 1.0,
        holes = "fill",
        far_m = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn new(
        visibility_m: f64,
        profile: Option<&str>,
        scale_height_m: Option<f64>,
        base_height_m: Option<f64>,
        top_m: Option<f64>,
        droplets: Option<&str>,
        scattering: Option<&str>,
        patch_strength: Option<f64>,
        patch_size_m: Option<f64>,
        patch_seed: Option<u64>,
        fov_deg: Option<f64>,
        focal_px: Option<f64>,
        eye_height_m: Option<f64>,
        camera_azimuth_deg: Option<f64>,
        camera_elevation_deg: Option<f64>,
        camera_roll_deg: Option<f64>,
        ambient: Option<[f64; 3]>,
        ambient_scale: f64,
        sun_elevation_deg: Option<f64>,
        sun_azimuth_deg: Option<f64>,
        sun_strength: Option<f64>,
        depth_kind: &str,
        depth_scale: f64,
        holes: &str,
        far_m: Option<f64>,
    ) -> Result<Self, Failure> {
        let mut scene = OverlayScene::default();
        let fog = scene.fog_mut();
        fog.visibility_m = Some(visibility_m);
        fog.profile = profile.map(str::parse).transpose()?;
        fog.scale_height_m = scale_height_m;
        fog.base_height_m = base_height_m;
        fog.top_m = top_m;
        fog.droplets = droplets.map(str::parse).transpose()?;
        fog.scattering = scattering.map(str::parse).transpose()?;
        if patch_strength.is_some() || patch_size_m.is_some() || patch_seed.is_some() {
            fog.patches = Some(FogPatchesSpec {
                strength: patch_strength,
                size_m: patch_size_m,
                seed: patch_seed,
                ..FogPatchesSpec::default()
            });
        }
        let camera = &mut scene.scene.camera;
        camera.fov_deg = fov_deg;
        camera.azimuth_deg = camera_azimuth_deg;
        camera.elevation_deg = camera_elevation_deg;
        camera.roll_deg = camera_roll_deg;
        scene.scene.observer.eye_height_m = eye_height_m;
        scene.scene.sun.elevation_deg = sun_elevation_deg;
        scene.scene.sun.azimuth_deg = sun_azimuth_deg;
        let overlay = &mut scene.overlay;
        overlay.focal_px = focal_px;
        overlay.ambient = ambient;
        overlay.ambient_scale = ambient_scale;
        overlay.sun_strength = sun_strength;
        overlay.depth_kind = depth_kind.parse()?;
        overlay.depth_scale = depth_scale;
        overlay.holes = holes.parse()?;
        overlay.far_m = far_m;
        Self::of_scene(scene)
    }

    /// Fog from TOML: a scene file with a table ``[overlay]``, which also has lights in the fog and the light of a solved sky.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The TOML text; files of pictures that it names are ignored.
    #[staticmethod]
    fn from_toml(text: &str) -> Result<Self, Failure> {
        let mut scene = OverlayScene::from_toml(text)?;
        scene_file::inline_files(&mut scene.scene, Path::new(""))?;
        Self::of_scene(scene)
    }

    /// The fog as TOML, from which ``Fog.from_toml`` makes the same fog.
    ///
    /// Returns
    /// -------
    /// str
    fn to_toml(&self) -> Result<String, Failure> {
        Ok(self.scene.to_toml()?)
    }

    /// Visibility where the fog is densest, m.
    #[getter]
    fn visibility_m(&self) -> Result<f64, Failure> {
        Ok(self.scene.visibility_m()?)
    }

    /// A picture in this fog.
    ///
    /// The values are those of ``airlight fog`` with the same settings, to the bit.
    ///
    /// Parameters
    /// ----------
    /// picture : numpy.ndarray, shape (height, width, 3)
    ///     uint8 or uint16: sRGB; float32: linear light in sRGB primaries, in any unit.
    /// depth : array_like, shape (height, width)
    ///     Depth of each pixel; infinite: sky; 0 or NaN: unknown.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (height, width, 3)
    ///     In the type of ``picture``.
    #[pyo3(signature = (picture, depth, *, threads=None))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        picture: Colours<'py>,
        depth: Depths,
        threads: Option<usize>,
    ) -> PyResult<Foggy<'py>> {
        let pixels = picture.pixels()?;
        let values = compute(py, threads, |control| {
            let linear = self.draw(pixels.picture()?, depth, false, control)?;
            pixels.encoded(linear, control)
        })?;
        let size = pixels.size;
        Ok(match values {
            Values::U8(values) => Foggy::U8(arrays::picture(py, values.into_owned(), size, 3)?),
            Values::U16(values) => Foggy::U16(arrays::picture(py, values.into_owned(), size, 3)?),
            Values::F32(values) => Foggy::F32(arrays::picture(py, values.into_owned(), size, 3)?),
        })
    }

    /// Transmittance and path radiance of the fog in front of each pixel.
    ///
    /// Parameters
    /// ----------
    /// picture : numpy.ndarray, shape (height, width, 3)
    ///     As for a call; its light sets the level of the ambient light.
    /// depth : array_like, shape (height, width)
    ///     Depth of each pixel.
    /// threads : int or None
    ///     Number of threads.
    ///
    /// Returns
    /// -------
    /// transmittance, path_radiance : numpy.ndarray, shape (height, width, 3), float32
    ///     The picture in fog is ``transmittance * picture + path_radiance``, in linear light.
    /// depth_m : numpy.ndarray, shape (height, width), float32
    ///     Depth along the camera's axis, m.
    #[pyo3(signature = (picture, depth, *, threads=None))]
    #[expect(clippy::type_complexity, reason = "three arrays of Python")]
    fn layers<'py>(
        &self,
        py: Python<'py>,
        picture: Colours<'py>,
        depth: Depths,
        threads: Option<usize>,
    ) -> PyResult<(
        Bound<'py, PyArray3<f32>>,
        Bound<'py, PyArray3<f32>>,
        Bound<'py, PyArray2<f32>>,
    )> {
        /// Channels of a picture with layers.
        const CHANNELS: usize = 10;
        let pixels = picture.pixels()?;
        let picture_size = pixels.size;
        let values = compute(py, threads, |control| {
            self.draw(pixels.picture()?, depth, true, control)
        })?;
        let part = |first: usize, count: usize| -> Vec<f32> {
            let pixels = values.chunks_exact(CHANNELS);
            pixels
                .flat_map(|pixel| pixel[first..first + count].iter().copied())
                .collect()
        };
        Ok((
            arrays::picture(py, part(3, 3), picture_size, 3)?,
            arrays::picture(py, part(6, 3), picture_size, 3)?,
            arrays::matrix(py, part(9, 1), picture_size.width() as usize)?,
        ))
    }

    /// Pickles the fog as its TOML, for workers of data loaders.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let maker = slf.get_type().getattr("from_toml")?;
        Ok((maker, (slf.get().to_toml()?,)))
    }

    fn __repr__(&self) -> String {
        let visibility = self.scene.visibility_m();
        format!(
            "Fog(visibility_m={}, profile={:?})",
            visibility.unwrap_or(f64::INFINITY),
            self.scene.fog_profile().to_string()
        )
    }
}
