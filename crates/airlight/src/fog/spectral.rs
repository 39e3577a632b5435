//! [`Fog`] and [`RgbFog`], and their tables for pictures.

use super::error::FogError;
use super::even::EvenFog;
use super::fog_lanes::FogLanes;
use super::layer::{LayerLanes, RgbLayer};
use super::lighting::{FogLighting, FogScattering, Ground};
use super::multiple::DEGREES;
use super::table::TableLanes;
use crate::atmosphere::{Constituent, DensityProfile, RaySegment};
use crate::control::Control;
use crate::math::slices::check_length;
use crate::spectrum::{SpectralCurve, Spectrum, WavelengthGrid};
use crate::transfer::residual::STREAMS;
use crate::transfer::{PathOptics, RgbPathOptics};
use glam::DVec3;
use std::fmt::Debug;
use std::sync::Arc;

/// Fog at the wavelengths of a grid: layers of constituents, lit by sun and sky. Cloning is cheap; clones share one solution.
///
/// Queries write one value for each wavelength of the grid; batch queries write the values of one ray after the other. Errors
/// of single scattering: rounding for one profile over flat ground, below 0.2 % for several profiles, below 1 % over round
/// ground.
///
/// # Panics
/// Queries panic if an output slice does not have the documented length.
#[derive(Clone, Debug)]
pub struct Fog {
    shared: Arc<FogShared>,
}

#[derive(Debug)]
struct FogShared {
    grid: WavelengthGrid,
    ground: Ground,
    sun: Option<DVec3>,
    blocks: Vec<Box<dyn FogBlock>>,
}

/// Fog in red, green and blue, for real-time use: layers with RGB coefficients, lit by RGB light. Cloning is cheap; clones
/// share one solution. Queries do not allocate.
///
/// ```
/// use airlight::atmosphere::visibility::{Contrast, extinction_per_m};
/// use airlight::axes::direction;
/// use airlight::fog::{DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
/// use airlight::atmosphere::droplets;
///
/// // Radiation fog with a scale height of 30 m and a visibility of 200 m at the ground, under a morning sun.
/// let layer = RgbLayer {
///     density: DensityProfile::exponential(30.0),
///     extinction_per_m: [extinction_per_m(200.0, Contrast::FivePercent) as f32; 3],
///     single_scattering_albedo: [1.0; 3],
///     phase: droplets::phase(10.0),
/// };
/// let lighting = FogLighting {
///     sun: Some(DirectionalLight { direction: direction(110.0, 12.0), irradiance: [3.0, 2.4, 1.8] }),
///     ambient: [0.2, 0.25, 0.35],
///     ground_albedo: [0.2; 3],
/// };
/// let fog = RgbFog::new(&[layer], Ground::EARTH, &lighting, FogScattering::Multiple)?;
/// // A red wall 80 m away, seen from 1.7 m.
/// let seen = fog.path(1.7, direction(80.0, 0.0), 80.0).apply([0.3, 0.05, 0.04]);
/// assert!(seen[1] > 0.05);
/// # Ok::<(), airlight::fog::FogError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RgbFog {
    lanes: Arc<FogLanes<3>>,
}

/// A [`Fog`] tabulated for one eye height: [`Fog::path`] for many rays in a fraction of the time, with an error below 0.3 % of
/// the path radiance. Tables are computed on demand, for one density profile over flat ground with multiple scattering; other
/// fog is evaluated directly.
#[derive(Clone, Debug)]
pub struct FogTable {
    fog: Fog,
    blocks: Arc<[Box<dyn TableBlock>]>,
}

/// A [`RgbFog`] tabulated for one eye height, see [`FogTable`].
#[derive(Clone, Debug)]
pub struct RgbFogTable {
    lanes: Arc<TableLanes<3>>,
}

impl Fog {
    /// Validates the inputs, and solves for the diffuse light with [`FogScattering::Multiple`].
    ///
    /// # Errors
    /// [`FogError`] for the first value out of range.
    pub fn new(
        layers: &[Constituent],
        ground: Ground,
        lighting: &FogLighting,
        scattering: FogScattering,
        grid: &WavelengthGrid,
    ) -> Result<Self, FogError> {
        Self::new_with(
            layers,
            ground,
            lighting,
            scattering,
            grid,
            Control::default(),
        )
    }

    /// As [`Fog::new`], with cancellation.
    ///
    /// # Errors
    /// As [`Fog::new`], and if the caller cancelled.
    pub fn new_with(
        layers: &[Constituent],
        ground: Ground,
        lighting: &FogLighting,
        scattering: FogScattering,
        grid: &WavelengthGrid,
        control: Control<'_>,
    ) -> Result<Self, FogError> {
        lighting.validate()?;
        let fog = FogInputs {
            layers,
            ground,
            lighting,
            scattering,
            control,
        };
        Ok(Self {
            shared: Arc::new(FogShared {
                blocks: in_blocks(grid.wavelengths_nm(), &fog)?,
                grid: grid.clone(),
                ground,
                sun: lighting.sun.as_ref().map(|sun| sun.direction),
            }),
        })
    }

    /// Wavelengths of the outputs.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.shared.grid
    }

    /// The ground below the fog.
    pub fn ground(&self) -> &Ground {
        &self.shared.ground
    }

    /// Transmittance and path radiance between an eye at a height (m) and a point `distance_m` away (infinite for the sky) along
    /// the unit vector `direction`: one value for each wavelength.
    pub fn path(
        &self,
        eye_height_m: f64,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let ray = self.ray(eye_height_m, direction, distance_m);
        let cos_sun = self.shared.sun.map_or(0.0, |sun| sun.dot(direction));
        self.path_along(&ray, cos_sun, transmittance, path_radiance);
    }

    /// [`Fog::path`] for many rays.
    pub fn paths(
        &self,
        eye_height_m: f64,
        directions: &[DVec3],
        distances_m: &[f64],
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let width = self.shared.grid.len();
        each_ray(
            directions,
            distances_m,
            width,
            transmittance,
            path_radiance,
            |d, m, t, s| {
                self.path(eye_height_m, d, m, t, s);
            },
        );
    }

    /// Transmittance and path radiance along a ray; `cos_sun` is the cosine of the angle between the ray and the direction to the
    /// sun.
    pub fn path_along(
        &self,
        ray: &RaySegment,
        cos_sun: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let width = self.shared.grid.len();
        check_length(transmittance, width);
        check_length(path_radiance, width);
        let outputs = transmittance
            .chunks_mut(BLOCK)
            .zip(path_radiance.chunks_mut(BLOCK));
        for (block, (transmittance, path_radiance)) in self.shared.blocks.iter().zip(outputs) {
            block.path_along(ray, cos_sun, transmittance, path_radiance);
        }
    }

    /// Optical depth along a ray, one value for each wavelength. Exact for all layers, over flat and round ground.
    pub fn optical_depth(&self, ray: &RaySegment, out: &mut [f32]) {
        check_length(out, self.shared.grid.len());
        for (block, out) in self.shared.blocks.iter().zip(out.chunks_mut(BLOCK)) {
            block.optical_depth(ray, out);
        }
    }

    /// Extinction coefficient at a height (m), 1/m, one value for each wavelength.
    pub fn extinction_per_m(&self, height_m: f64, out: &mut [f32]) {
        check_length(out, self.shared.grid.len());
        for (block, out) in self.shared.blocks.iter().zip(out.chunks_mut(BLOCK)) {
            block.extinction_per_m(height_m, out);
        }
    }

    /// Irradiance on the horizontal ground below the fog at each wavelength, with all orders of scattering; `None` without
    /// [`FogScattering::Multiple`].
    pub fn ground_irradiance(&self) -> Option<Vec<f32>> {
        let mut all = vec![0.0; self.shared.grid.len()];
        let mut blocks = self.shared.blocks.iter().zip(all.chunks_mut(BLOCK));
        blocks
            .all(|(block, out)| block.ground_irradiance(out))
            .then_some(all)
    }

    /// The fog tabulated for an eye height (m), for pictures.
    pub fn seen_from(&self, eye_height_m: f64) -> FogTable {
        let blocks = self.shared.blocks.iter();
        FogTable {
            fog: self.clone(),
            blocks: blocks.map(|block| block.seen_from(eye_height_m)).collect(),
        }
    }

    fn ray(&self, eye_height_m: f64, direction: DVec3, distance_m: f64) -> RaySegment {
        let radius_m = self.shared.ground.radius_m;
        RaySegment::new(eye_height_m, direction.y, distance_m, radius_m)
    }
}

impl FogTable {
    /// The fog.
    pub fn fog(&self) -> &Fog {
        &self.fog
    }

    /// Transmittance and path radiance between the eye and a point `distance_m` away (infinite for the sky) along the unit vector
    /// `direction`: one value for each wavelength.
    pub fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let width = self.fog.grid().len();
        check_length(transmittance, width);
        check_length(path_radiance, width);
        let outputs = transmittance
            .chunks_mut(BLOCK)
            .zip(path_radiance.chunks_mut(BLOCK));
        for (block, (transmittance, path_radiance)) in self.blocks.iter().zip(outputs) {
            block.path(direction, distance_m, transmittance, path_radiance);
        }
    }

    /// [`FogTable::path`] for many rays.
    pub fn paths(
        &self,
        directions: &[DVec3],
        distances_m: &[f64],
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let width = self.fog.grid().len();
        each_ray(
            directions,
            distances_m,
            width,
            transmittance,
            path_radiance,
            |d, m, t, s| {
                self.path(d, m, t, s);
            },
        );
    }
}

impl RgbFog {
    /// Validates the inputs, and solves for the diffuse light with [`FogScattering::Multiple`].
    ///
    /// # Errors
    /// [`FogError`] for the first value out of range.
    pub fn new(
        layers: &[RgbLayer],
        ground: Ground,
        lighting: &FogLighting<[f32; 3]>,
        scattering: FogScattering,
    ) -> Result<Self, FogError> {
        Self::new_with(layers, ground, lighting, scattering, Control::default())
    }

    /// As [`RgbFog::new`], with cancellation.
    ///
    /// # Errors
    /// As [`RgbFog::new`], and if the caller cancelled.
    pub fn new_with(
        layers: &[RgbLayer],
        ground: Ground,
        lighting: &FogLighting<[f32; 3]>,
        scattering: FogScattering,
        control: Control<'_>,
    ) -> Result<Self, FogError> {
        let layers: Vec<LayerLanes<3>> = layers.iter().map(LayerLanes::rgb).collect();
        let lighting = lighting.map(|&rgb| Spectrum(rgb));
        let lanes = FogLanes::new(&layers, ground, lighting, scattering, 3, control)?;
        Ok(Self {
            lanes: Arc::new(lanes),
        })
    }

    /// Lighting of the fog.
    pub fn lighting(&self) -> FogLighting<[f32; 3]> {
        self.lanes.lighting().map(|lanes| lanes.0)
    }

    /// The ground below the fog.
    pub fn ground(&self) -> &Ground {
        self.lanes.ground()
    }

    /// Transmittance and path radiance between an eye at a height (m) and a point `distance_m` away (infinite for the sky) along
    /// the unit vector `direction`.
    #[inline]
    pub fn path(&self, eye_height_m: f64, direction: DVec3, distance_m: f64) -> RgbPathOptics {
        self.lanes.path(eye_height_m, direction, distance_m).into()
    }

    /// [`RgbFog::path`] for many rays, to rounding (a few 1e-7). Fog of one profile over flat ground with single scattering takes a
    /// fraction of the time.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn paths(
        &self,
        eye_height_m: f64,
        directions: &[DVec3],
        distances_m: &[f64],
        out: &mut [RgbPathOptics],
    ) {
        check_length(distances_m, directions.len());
        check_length(out, directions.len());
        self.lanes.paths(eye_height_m, directions, distances_m, out);
    }

    /// Transmittance and path radiance along a ray; `cos_sun` is the cosine of the angle between the ray and the direction to the
    /// sun.
    #[inline]
    pub fn path_along(&self, ray: &RaySegment, cos_sun: f64) -> RgbPathOptics {
        self.lanes.path_along(ray, cos_sun).into()
    }

    /// Density profiles of the fog, each once, with the sum of the extinction coefficients (1/m) of its layers at density 1.
    pub fn profiles(&self) -> impl ExactSizeIterator<Item = (&DensityProfile, [f32; 3])> {
        let layers = self.lanes.layers.iter();
        layers.map(|layer| (&layer.density, layer.extinction_per_m.0))
    }

    /// Optical depth along a ray. Exact for all layers, over flat and round ground.
    #[inline]
    pub fn optical_depth(&self, ray: &RaySegment) -> [f32; 3] {
        self.lanes.optical_depth(ray).0
    }

    /// Transmittance along a ray. Exact for all layers, over flat and round ground.
    #[inline]
    pub fn transmittance(&self, ray: &RaySegment) -> [f32; 3] {
        self.lanes.transmittance(ray).0
    }

    /// Extinction coefficient at a height (m), 1/m.
    pub fn extinction_per_m(&self, height_m: f64) -> [f32; 3] {
        self.lanes.extinction_per_m(height_m).0
    }

    /// Irradiance on the horizontal ground below the fog, with all orders of scattering; `None` without
    /// [`FogScattering::Multiple`].
    pub fn ground_irradiance(&self) -> Option<[f32; 3]> {
        self.lanes.ground_irradiance().map(|lanes| lanes.0)
    }

    /// Irradiance of the horizontal ground below the fog relative to that without the fog, with all orders of scattering: 1 where no light
    /// falls; `None` without [`FogScattering::Multiple`].
    pub fn ground_share(&self) -> Option<[f32; 3]> {
        self.lanes.ground_share().map(|lanes| lanes.0)
    }

    /// The fog for whole rows of a picture, if it is the same in every direction: uniform, without a sun.
    pub fn even(&self) -> Option<EvenFog> {
        EvenFog::of(&self.lanes)
    }

    /// The fog tabulated for an eye height (m), for pictures.
    pub fn seen_from(&self, eye_height_m: f64) -> RgbFogTable {
        RgbFogTable {
            lanes: Arc::new(TableLanes::new(self.lanes.clone(), eye_height_m)),
        }
    }
}

impl RgbFogTable {
    /// Transmittance and path radiance between the eye and a point `distance_m` away (infinite for the sky) along the unit vector
    /// `direction`.
    #[inline]
    pub fn path(&self, direction: DVec3, distance_m: f64) -> RgbPathOptics {
        self.lanes.path(direction, distance_m).into()
    }

    /// [`RgbFogTable::path`] for many rays, to rounding (a few 1e-7), in a fraction of the time.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn paths(&self, directions: &[DVec3], distances_m: &[f64], out: &mut [RgbPathOptics]) {
        check_length(distances_m, directions.len());
        check_length(out, directions.len());
        self.lanes.paths(directions, distances_m, out);
    }
}

impl RgbFogTable {
    /// Parts of the path radiance that the layers of a density profile, by its index in [`RgbFog::profiles`], add up to some distances (m,
    /// increasing, not beyond the ground) along rays of one elevation, for tables on other devices. `None` for fog without multiple
    /// scattering, without an upper end, or over round ground, and for an index beyond the last.
    ///
    /// The path radiance along a unit vector is the sum over profiles of `1 - T`, where `T` is the transmittance of the layers of the profile
    /// alone, times the sum of [`RgbFogParts::diffuse`] and, for each phase function and stream, of [`RgbFogParts::streams`] times
    /// [`RgbFogTable::sun_streams`]; negative sums of these count as 0.
    pub fn parts(
        &self,
        profile: usize,
        sin_elevation: f64,
        distances_m: &[f64],
    ) -> Option<Vec<RgbFogParts>> {
        let parts = self.lanes.parts(profile, sin_elevation, distances_m)?;
        let parts = parts.into_iter().map(|parts| RgbFogParts {
            modes: parts.modes.map(|lanes| lanes.0),
            streams: parts
                .streams
                .into_iter()
                .map(|streams| streams.map(|lanes| lanes.0))
                .collect(),
        });
        Some(parts.collect())
    }

    /// Number of different phase functions in the fog.
    pub fn phase_count(&self) -> usize {
        self.lanes.phase_count()
    }

    /// Sunlight times a phase function of the fog, by stream, at a cosine of the angle between ray and sun: irradiance times the stream's share
    /// of the phase function, which can be negative. Phase functions count once, in the order of the layers; 0 for an index beyond the last.
    pub fn sun_streams(&self, phase: usize, cos_sun: f64) -> [[f32; 3]; FOG_STREAMS] {
        self.lanes.sun_streams(phase, cos_sun).map(|lanes| lanes.0)
    }
}

/// Number of streams of sunlight: light from which the forward peak removes nothing, half of its fraction, and all.
pub const FOG_STREAMS: usize = STREAMS;

/// Path radiance that layers of fog of one density profile add, per unit of their opacity, in parts ([`RgbFogTable::parts`]).
#[derive(Clone, Debug, PartialEq)]
pub struct RgbFogParts {
    modes: [[f32; 3]; DEGREES],
    /// Sunlight scattered once, for each phase function of the fog by stream, per unit of [`RgbFogTable::sun_streams`]. With the phase
    /// functions of other layers it is what forward peaks of these layers scatter on into the ray.
    pub streams: Vec<[[f32; 3]; FOG_STREAMS]>,
}

impl RgbFogParts {
    /// Light scattered several times, towards an azimuth from the sun, at the cosine of the elevation of the ray. Not negative.
    pub fn diffuse(&self, cos_elevation: f64, azimuth_rad: f64) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for (m, mode) in (0..).zip(&self.modes) {
            let factor = cos_elevation.powi(m) * (f64::from(m) * azimuth_rad).cos();
            for (sum, mode) in sum.iter_mut().zip(mode) {
                *sum += factor * f64::from(*mode);
            }
        }
        sum.map(|light| light.max(0.0) as f32)
    }
}

/// Number of lanes of the widest block.
pub(super) const BLOCK: usize = 16;

/// Inputs of a computation that is built in blocks of lanes.
pub(super) trait InBlocks {
    /// Trait object of a block.
    type Block: ?Sized;

    /// A block of N lanes with these wavelengths (nm), of which the first `lanes` are used.
    fn block<const N: usize>(
        &self,
        wavelengths_nm: [f64; N],
        lanes: usize,
    ) -> Result<Box<Self::Block>, FogError>;
}

/// Splits wavelengths into blocks of 16, and the rest into the narrowest block that fits; unused lanes repeat the last
/// wavelength.
pub(super) fn in_blocks<I: InBlocks>(
    wavelengths_nm: &[f64],
    inputs: &I,
) -> Result<Vec<Box<I::Block>>, FogError> {
    fn padded<const N: usize>(chunk: &[f64]) -> [f64; N] {
        std::array::from_fn(|lane| chunk[lane.min(chunk.len() - 1)])
    }
    wavelengths_nm
        .chunks(BLOCK)
        .map(|chunk| match chunk.len() {
            1 => inputs.block::<1>(padded(chunk), 1),
            lanes @ 2..=4 => inputs.block::<4>(padded(chunk), lanes),
            lanes @ 5..=8 => inputs.block::<8>(padded(chunk), lanes),
            lanes => inputs.block::<BLOCK>(padded(chunk), lanes),
        })
        .collect()
}

/// A curve at the wavelengths of lanes, nm.
pub(super) fn sampled<const N: usize>(
    curve: &SpectralCurve,
    wavelengths_nm: &[f64; N],
) -> Spectrum<N> {
    Spectrum::from_fn(|lane| curve.at(wavelengths_nm[lane]) as f32)
}

/// Writes the first lanes to a slice.
pub(super) fn store<const N: usize>(lanes: Spectrum<N>, out: &mut [f32]) {
    out.copy_from_slice(&lanes.0[..out.len()]);
}

/// Calls `path` with each direction, its distance and its part of the outputs.
fn each_ray(
    directions: &[DVec3],
    distances_m: &[f64],
    width: usize,
    transmittance: &mut [f32],
    path_radiance: &mut [f32],
    mut path: impl FnMut(DVec3, f64, &mut [f32], &mut [f32]),
) {
    check_length(distances_m, directions.len());
    check_length(transmittance, width * directions.len());
    check_length(path_radiance, width * directions.len());
    let rays = directions.iter().zip(distances_m);
    let outputs = transmittance
        .chunks_mut(width)
        .zip(path_radiance.chunks_mut(width));
    for ((&direction, &distance_m), (transmittance, path_radiance)) in rays.zip(outputs) {
        path(direction, distance_m, transmittance, path_radiance);
    }
}

/// Inputs of a fog.
struct FogInputs<'a> {
    layers: &'a [Constituent],
    ground: Ground,
    lighting: &'a FogLighting,
    scattering: FogScattering,
    control: Control<'a>,
}

impl InBlocks for FogInputs<'_> {
    type Block = dyn FogBlock;

    fn block<const N: usize>(
        &self,
        wavelengths_nm: [f64; N],
        lanes: usize,
    ) -> Result<Box<dyn FogBlock>, FogError> {
        let layers: Vec<LayerLanes<N>> = self
            .layers
            .iter()
            .map(|layer| LayerLanes::new(layer, &wavelengths_nm))
            .collect();
        let lighting = self.lighting.map(|curve| sampled(curve, &wavelengths_nm));
        let fog = FogLanes::new(
            &layers,
            self.ground,
            lighting,
            self.scattering,
            lanes,
            self.control,
        )?;
        Ok(Box::new(SharedLanes(Arc::new(fog))))
    }
}

/// A block of lanes of a fog. Slices have the length of the used lanes.
trait FogBlock: Debug + Send + Sync {
    fn path_along(
        &self,
        ray: &RaySegment,
        cos_sun: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    );
    fn optical_depth(&self, ray: &RaySegment, out: &mut [f32]);
    fn extinction_per_m(&self, height_m: f64, out: &mut [f32]);
    /// Returns whether all orders of scattering are computed.
    fn ground_irradiance(&self, out: &mut [f32]) -> bool;
    fn seen_from(&self, eye_height_m: f64) -> Box<dyn TableBlock>;
}

/// A block, shared with its tables.
#[derive(Debug)]
struct SharedLanes<const N: usize>(Arc<FogLanes<N>>);

impl<const N: usize> FogBlock for SharedLanes<N> {
    fn path_along(
        &self,
        ray: &RaySegment,
        cos_sun: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        store_path(
            self.0.path_along(ray, cos_sun),
            transmittance,
            path_radiance,
        );
    }

    fn optical_depth(&self, ray: &RaySegment, out: &mut [f32]) {
        store(self.0.optical_depth(ray), out);
    }

    fn extinction_per_m(&self, height_m: f64, out: &mut [f32]) {
        store(self.0.extinction_per_m(height_m), out);
    }

    fn ground_irradiance(&self, out: &mut [f32]) -> bool {
        match self.0.ground_irradiance() {
            Some(irradiance) => {
                store(irradiance, out);
                true
            }
            None => false,
        }
    }

    fn seen_from(&self, eye_height_m: f64) -> Box<dyn TableBlock> {
        Box::new(TableLanes::new(self.0.clone(), eye_height_m))
    }
}

/// A block of lanes of a tabulated fog.
trait TableBlock: Debug + Send + Sync {
    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    );
}

impl<const N: usize> TableBlock for TableLanes<N> {
    fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let optics = TableLanes::path(self, direction, distance_m);
        store_path(optics, transmittance, path_radiance);
    }
}

fn store_path<const N: usize>(
    optics: PathOptics<N>,
    transmittance: &mut [f32],
    path_radiance: &mut [f32],
) {
    store(optics.transmittance, transmittance);
    store(optics.path_radiance, path_radiance);
}
