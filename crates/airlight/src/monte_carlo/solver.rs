//! The Monte Carlo solver: settings, and radiance along view rays.

use super::chord::Chord;
use super::estimate::{Estimate, Sample, Tally};
use super::lanes::Lanes;
use super::layers::Layers;
use super::path::{Line, ORDERS, PathScene};
use super::stokes::{Polarisation, Scalar};
use super::sun::SunShape;
use crate::atmosphere::Atmosphere;
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::math::random::Random;
use crate::math::simd::vectorized;
use crate::sky::SkyError;
use crate::spectrum::WavelengthGrid;
use crate::transfer::ray::Ray;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};
use glam::DVec3;

/// Number of paths in a bundle, which share one stream of random numbers. Their first collisions are stratified, so bundles
/// vary less than independent paths; the standard error is computed from the spread among bundles.
pub const BUNDLE: usize = 64;

/// Number of paths, random seed and shape of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonteCarloSettings {
    /// Number of paths for each view ray, rounded up to whole bundles of 64, at least two.
    pub paths: u64,
    /// Random seed. Different seeds give independent estimates; equal seeds give the same bits on any number of threads.
    pub seed: u64,
    /// Whether the sun is a point or a disc.
    pub sun: SunShape,
}

impl Default for MonteCarloSettings {
    fn default() -> Self {
        Self {
            paths: 16_384,
            seed: 1,
            sun: SunShape::Point,
        }
    }
}

/// Monte Carlo solver for one atmosphere; can be shared between threads.
#[derive(Clone, Debug)]
pub struct MonteCarlo {
    atmosphere: Atmosphere,
    grid: WavelengthGrid,
    settings: MonteCarloSettings,
    pub(super) layers: Layers,
    blocks: Vec<Block>,
}

/// Wavelengths that share paths.
#[derive(Clone, Debug)]
enum Block {
    Four(usize, Box<Lanes<4>>),
    Eight(usize, Box<Lanes<8>>),
    Sixteen(usize, Box<Lanes<16>>),
}

/// A view ray and the direction of the sun.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene {
    pub line: Line,
    sun: DVec3,
    /// Identifies the stream of random numbers.
    stream: u64,
}

impl MonteCarlo {
    /// Prepares `atmosphere` at the wavelengths of `grid`, whose solar spectrum is replaced by that of the atmosphere.
    ///
    /// # Errors
    /// [`SkyError`] if the atmosphere is invalid or has too many constituents.
    pub fn new(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        settings: MonteCarloSettings,
    ) -> Result<Self, SkyError> {
        atmosphere.validate()?;
        if atmosphere.constituents.len() > MAX_CONSTITUENTS {
            return Err(SkyError::TooManyConstituents(atmosphere.constituents.len()));
        }
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let extinctions: Vec<PerConstituent> = grid
            .wavelengths_nm()
            .iter()
            .map(|&nm| {
                let mut all = [0.0; MAX_CONSTITUENTS];
                for (value, part) in all.iter_mut().zip(&atmosphere.constituents) {
                    *value = part.extinction_per_m(nm);
                }
                all
            })
            .collect();
        Ok(Self {
            layers: Layers::new(atmosphere, &extinctions),
            blocks: grid
                .wavelengths_nm()
                .chunks(16)
                .map(|chunk| Block::new(atmosphere, chunk))
                .collect(),
            atmosphere: atmosphere.clone(),
            grid,
            settings,
        })
    }

    /// The atmosphere.
    pub fn atmosphere(&self) -> &Atmosphere {
        &self.atmosphere
    }

    /// The wavelength grid, with the solar spectrum of the atmosphere.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.grid
    }

    /// The settings.
    pub fn settings(&self) -> &MonteCarloSettings {
        &self.settings
    }

    /// Radiance at `eye_altitude_m` (m; raised to the ground if below it) along `view`, with the sun in the direction `sun` at
    /// the planet's mean distance (unit vectors in world axes, [`crate::axes`]).
    pub fn radiance(&self, eye_altitude_m: f64, sun: DVec3, view: DVec3) -> Estimate {
        self.radiance_with(eye_altitude_m, sun, view, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`MonteCarlo::radiance`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn radiance_with(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        control: Control<'_>,
    ) -> Result<Estimate, Cancelled> {
        self.mean_over_paths(self.scene(eye_altitude_m, sun, view, None), control)
    }

    /// Mean over one bundle of 64 paths, by order of scattering and wavelength, W m^-2 sr^-1 nm^-1, for custom statistics.
    /// Bundles of different numbers or view rays are independent; the mean over bundles is [`MonteCarlo::radiance`].
    pub fn sample(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        bundle: u64,
    ) -> Vec<Vec<f64>> {
        let scene = self.scene(eye_altitude_m, sun, view, None);
        self.sunlit_bundle(scene, bundle).into()
    }

    /// Radiance with a relative error: adds paths until the largest relative standard error, over wavelengths brighter than
    /// 1e-3 of the brightest, is below `relative_error`, or `most_paths` are traced.
    ///
    /// Where few paths carry much of the light (a narrow peak reflected by the ground, deep twilight) it can stop before
    /// finding one of them, with an underestimated error; a fixed number of paths ([`MonteCarlo::radiance`]) is safer there.
    pub fn radiance_within(
        &self,
        relative_error: f64,
        most_paths: u64,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
    ) -> Estimate {
        let scene = self.scene(eye_altitude_m, sun, view, None);
        let mut tally = Tally::new(self.grid.len());
        let mut bundles = 32;
        loop {
            self.add_bundles(&mut tally, bundles, scene, Control::default())
                .expect("nothing cancels it");
            let estimate = self.estimate(&tally);
            if estimate.worst_relative_error() <= relative_error || estimate.paths >= most_paths {
                return estimate;
            }
            // Increases the number of paths by half.
            bundles =
                (tally.count() / 2).min((most_paths - estimate.paths).div_ceil(BUNDLE as u64));
        }
    }

    fn estimate(&self, tally: &Tally) -> Estimate {
        tally.estimate(self.grid.solar_irradiance(), tally.count() * BUNDLE as u64)
    }

    /// Mean over the number of paths in the settings; 0 for a ray that misses the atmosphere.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn mean_over_paths(
        &self,
        scene: Option<Scene>,
        control: Control<'_>,
    ) -> Result<Estimate, Cancelled> {
        let bundles = self.settings.paths.div_ceil(BUNDLE as u64).max(2);
        let mut tally = Tally::new(self.grid.len());
        self.add_bundles(&mut tally, bundles, scene, control)?;
        Ok(self.estimate(&tally))
    }

    /// Mean over a bundle, multiplied by the solar irradiance.
    pub(super) fn sunlit_bundle(&self, scene: Option<Scene>, bundle: u64) -> Sample {
        let Some(scene) = scene else {
            return std::array::from_fn(|_| vec![0.0; self.grid.len()]);
        };
        let mut sample = self.bundle(&scene, bundle);
        for order in &mut sample {
            for (value, solar) in order.iter_mut().zip(self.grid.solar_irradiance()) {
                *value *= solar;
            }
        }
        sample
    }

    /// Adds the next `bundles` bundles of a view ray to its tally, in order.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn add_bundles(
        &self,
        tally: &mut Tally,
        bundles: u64,
        scene: Option<Scene>,
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        let Some(scene) = scene else {
            let nothing = std::array::from_fn(|_| vec![0.0; self.grid.len()]);
            (0..bundles).for_each(|_| tally.add(&nothing));
            return Ok(());
        };
        let first = tally.count();
        let samples = parallel::try_map(bundles as usize, |bundle| {
            control.check()?;
            Ok(self.bundle(&scene, first + bundle as u64))
        })?;
        samples.iter().for_each(|sample| tally.add(sample));
        Ok(())
    }

    /// View ray from its entry into the atmosphere, at most `reach_m` long from the eye; `None` if it misses the atmosphere.
    pub(super) fn scene(
        &self,
        eye_altitude_m: f64,
        sun: DVec3,
        view: DVec3,
        reach_m: Option<f64>,
    ) -> Option<Scene> {
        let (ground, top) = self.layers.bounds();
        let radius_m = (self.atmosphere.planet.radius_m + eye_altitude_m).max(ground.sqrt());
        let (sun, direction) = (sun.normalize(), view.normalize());
        let mut place = DVec3::Y * radius_m;
        let mut reach_m = reach_m;
        if radius_m * radius_m > top {
            let (enters, leaves) = Ray::new(place, direction, sun).crossings(top.sqrt())?;
            if leaves <= 0.0 || enters >= leaves {
                return None;
            }
            place += direction * enters;
            reach_m = reach_m.map(|reach_m| reach_m - enters);
        }
        if reach_m.is_some_and(|reach_m| reach_m.is_nan() || reach_m <= 0.0) {
            return None;
        }
        let vectors = [place, direction, sun, DVec3::splat(reach_m.unwrap_or(0.0))];
        Some(Scene {
            line: Line {
                place,
                direction,
                reach_m,
            },
            sun,
            stream: stream(&vectors[..if reach_m.is_some() { 4 } else { 3 }]),
        })
    }

    /// Mean over the paths of a bundle, per unit solar irradiance.
    fn bundle(&self, scene: &Scene, number: u64) -> Sample {
        self.bundle_of::<Scalar, Scalar, Scalar>(scene, number).0
    }

    /// As [`Self::bundle`], with the polarisation carried by blocks of 4, 8 and 16 lanes; also returns `I`, `Q`, `U` if they are
    /// carried.
    pub(super) fn bundle_of<A: Polarisation<4>, B: Polarisation<8>, C: Polarisation<16>>(
        &self,
        scene: &Scene,
        number: u64,
    ) -> (Sample, [Vec<f64>; 3]) {
        let empty = |_| Vec::with_capacity(self.grid.len());
        let mut sample = (std::array::from_fn(empty), std::array::from_fn(empty));
        for (index, block) in self.blocks.iter().enumerate() {
            let mut random = Random::new(
                self.settings.seed,
                scene.stream.wrapping_add(index as u64),
                number,
            );
            match block {
                Block::Four(used, lanes) => {
                    self.block_bundle::<4, A>(lanes, *used, scene, &mut random, &mut sample)
                }
                Block::Eight(used, lanes) => {
                    self.block_bundle::<8, B>(lanes, *used, scene, &mut random, &mut sample)
                }
                Block::Sixteen(used, lanes) => {
                    self.block_bundle::<16, C>(lanes, *used, scene, &mut random, &mut sample)
                }
            }
        }
        sample
    }

    fn block_bundle<const N: usize, P: Polarisation<N>>(
        &self,
        lanes: &Lanes<N>,
        used: usize,
        scene: &Scene,
        random: &mut Random,
        (sample, stokes): &mut (Sample, [Vec<f64>; 3]),
    ) {
        let path_scene = PathScene {
            layers: &self.layers,
            lanes,
            sun: scene.sun,
            disc: &self.atmosphere.sun,
            shape: self.settings.sun,
        };
        let mut chord = Chord::default();
        let mut sums = [[0.0f64; N]; ORDERS];
        let mut stokes_sums = [[0.0f64; N]; 3];
        // Each lane is the hero of the same number of paths, and the first collisions of all are stratified. A common random
        // shift keeps each hero from always sampling the same parts of the unit interval.
        let strata = BUNDLE / N;
        let shift = random.unit();
        for path in 0..BUNDLE {
            let (hero, stratum) = (path % N, path / N);
            let spread = (stratum * N + (hero * 5 + stratum) % N) as f64;
            let first = (shift + (spread + random.unit()) / (strata * N) as f64).fract();
            let mut carried = P::begin(scene.line.direction);
            let found = vectorized(
                #[inline(always)]
                || path_scene.follow(&scene.line, hero, first, random, &mut chord, &mut carried),
            );
            if P::CARRIED {
                for (sum, found) in stokes_sums.iter_mut().zip(carried.found()) {
                    for (sum, found) in sum.iter_mut().zip(found.0) {
                        *sum += f64::from(found);
                    }
                }
            }
            for (sum, found) in sums.iter_mut().zip(&found) {
                for (sum, found) in sum.iter_mut().zip(found.0) {
                    *sum += f64::from(found);
                }
            }
        }
        for (order, sum) in sample.iter_mut().zip(&sums) {
            order.extend(sum[..used].iter().map(|sum| sum / BUNDLE as f64));
        }
        if P::CARRIED {
            for (part, sum) in stokes.iter_mut().zip(&stokes_sums) {
                part.extend(sum[..used].iter().map(|sum| sum / BUNDLE as f64));
            }
        }
    }
}

impl Block {
    /// Unused lanes repeat the last wavelength.
    fn new(atmosphere: &Atmosphere, wavelengths_nm: &[f64]) -> Self {
        fn lanes<const N: usize>(atmosphere: &Atmosphere, nm: &[f64]) -> Box<Lanes<N>> {
            let padded = std::array::from_fn(|lane| nm[lane.min(nm.len() - 1)]);
            Box::new(Lanes::new(atmosphere, padded))
        }
        let used = wavelengths_nm.len();
        match used {
            0..=4 => Self::Four(used, lanes(atmosphere, wavelengths_nm)),
            5..=8 => Self::Eight(used, lanes(atmosphere, wavelengths_nm)),
            _ => Self::Sixteen(used, lanes(atmosphere, wavelengths_nm)),
        }
    }
}

impl Estimate {
    /// Largest ratio of standard error to mean over wavelengths brighter than 1e-3 of the brightest; 0 if all are 0.
    fn worst_relative_error(&self) -> f64 {
        let brightest = self.mean.iter().copied().fold(0.0, f64::max);
        self.mean
            .iter()
            .zip(&self.standard_error)
            .filter(|(mean, _)| **mean > 1e-3 * brightest)
            .map(|(mean, error)| error / mean)
            .fold(0.0, f64::max)
    }
}

/// Hash of a view ray: FNV-1a over the bits (Fowler, Noll & Vo), so that the noise of different rays is independent.
fn stream(vectors: &[DVec3]) -> u64 {
    vectors
        .iter()
        .flat_map(|v| v.to_array())
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}
