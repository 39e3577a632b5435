//! [`SkySolver`] and [`FrameTables`]: what frames are drawn with, computed without a device.

use crate::disc::DiscTable;
use crate::error::SkyRendererError;
use crate::fog::{Fog, FogFrame};
use crate::lighting::{DirectLight, Lighting};
use airlight::atmosphere::Atmosphere;
use airlight::fog::RgbFog;
use airlight::glam::DVec3;
use airlight::sky::{LightSource, Scattering, Sky, SkySettings};
use airlight::spectrum::RgbSpace;
use airlight_shaders::twins::colour::rgb_from_spectrum;
use airlight_shaders::{ColourFit, SingleScatteringTable, SkyTables, wavelength_grid};
use glam::{Vec3, Vec4};
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// A solved sky that fills the tables of frames. It needs no device, so that a thread or a worker of a web page can hold it. Cloning is
/// cheap. It keeps the tables of the last two sources, so that those of a moon are not filled again when only the sun has moved, and those of
/// the air not when only the fog has changed.
#[derive(Clone, Debug)]
pub struct SkySolver {
    sky: Sky,
    /// The sky without light that is scattered more than once, for shadows.
    single: Option<Sky>,
    settings: SkySettings,
    fit: Arc<ColourFit>,
    space: RgbSpace,
    kept: Kept<(f64, LightSource), (SourceTables, Lighting)>,
    kept_in_fog: Kept<(f64, LightSource, Fog), (SourceTables, Lighting)>,
}

/// What was computed for the last sources, the latest last. Clones share it.
#[derive(Clone, Debug)]
struct Kept<K, T>(Arc<Mutex<VecDeque<KeptValue<K, T>>>>);

/// What was computed, and for what.
type KeptValue<K, T> = (K, Arc<T>);

impl<K, T> Default for Kept<K, T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<K: PartialEq, T> Kept<K, T> {
    /// Number of sources that are kept.
    const MOST: usize = 2;

    /// What is kept for a place, or else is made.
    fn get_or<E>(&self, place: K, make: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
        // A panic of another thread has left whole values behind.
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let find = || Some(lock().iter().find(|(of, _)| *of == place)?.1.clone());
        let found = match find() {
            Some(found) => found,
            None => Arc::new(make()?),
        };
        let mut kept = lock();
        kept.retain(|(of, _)| *of != place);
        if kept.len() == Self::MOST {
            kept.pop_front();
        }
        kept.push_back((place, found.clone()));
        Ok(found)
    }
}

/// Tables of a frame for one eye: plain data, which [`SkyPasses`](crate::SkyPasses) uploads.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTables {
    /// Light of the sun.
    pub first: SourceTables,
    /// Light of a second source, such as the moon, which is added to that of the first.
    pub second: Option<SourceTables>,
    /// Light of both on surfaces at the eye.
    pub lighting: Lighting,
}

/// Tables of the light of one source.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceTables {
    /// Sky and aerial perspective.
    pub sky: SkyTables,
    /// The disc of the source.
    pub disc: DiscTable,
    /// Light that the air scatters once, for shadows in it.
    pub single: Option<SingleScatteringTable>,
    /// Fog, with the light of this sky.
    pub fog: Option<FogFrame>,
}

impl SkySolver {
    /// Settings of the solver for all suns, with more moments and directions than its own: in dust under a low sun, where light is up to
    /// 2.7 % off that of denser settings without them, it is within 0.5 %, for half as much time again. Of the first order, the eleventh
    /// direction above the horizon is for the air just above it in dust under a sun at -6 degrees, 2 % off with ten.
    pub fn default_settings() -> SkySettings {
        let mut settings = SkySettings::default();
        let orders = &mut settings.orders;
        (orders.degree, orders.peak_degree, orders.rescattered_degree) = (12, 12, 8);
        orders.first.zenith_nodes = [7, 11, 5];
        orders.later.zenith_nodes = [6, 8, 6];
        (orders.first.azimuths, orders.later.azimuths) = (12, 9);
        settings
    }

    /// Solves for the light in an atmosphere, which takes a second or more.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved.
    pub fn new(
        atmosphere: &Atmosphere,
        settings: &SkySettings,
        space: RgbSpace,
    ) -> Result<Self, SkyRendererError> {
        Ok(Self {
            sky: Sky::prepare(atmosphere, &wavelength_grid(), settings)?,
            single: None,
            settings: settings.clone(),
            fit: Arc::new(ColourFit::new(atmosphere, settings.suns)?),
            space,
            kept: Kept::default(),
            kept_in_fog: Kept::default(),
        })
    }

    /// A solver with the settings of this one in another atmosphere, for which it solves.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn in_atmosphere(&self, atmosphere: &Atmosphere) -> Result<Self, SkyRendererError> {
        let solver = Self::new(atmosphere, &self.settings, self.space)?;
        match self.single {
            Some(_) => solver.with_shadows(),
            None => Ok(solver),
        }
    }

    /// This solver, whose tables hold what shadows in the air need, too.
    ///
    /// # Errors
    /// [`SkyRendererError::Sky`] if the sky cannot be solved.
    pub fn with_shadows(self) -> Result<Self, SkyRendererError> {
        let settings = SkySettings {
            scattering: Scattering::Single,
            ..self.settings.clone()
        };
        let single = Sky::prepare(self.sky.atmosphere(), &wavelength_grid(), &settings)?;
        Ok(Self {
            single: Some(single),
            kept: Kept::default(),
            kept_in_fog: Kept::default(),
            ..self
        })
    }

    /// Tables for an eye at a height above sea level, m, a source of light, and a fog. The source is the sun, by its direction or with its
    /// distance, or the moon.
    ///
    /// # Errors
    /// [`SkyRendererError`] for numbers that are no place or direction, for an invalid fog, and for a place that the sky is not
    /// prepared for and cannot be solved for.
    pub fn tables(
        &self,
        height_m: f64,
        source: impl Into<LightSource>,
        fog: Option<&Fog>,
    ) -> Result<FrameTables, SkyRendererError> {
        let first = self.lit_by(height_m, source.into(), fog)?;
        let (first, lighting) = &*first;
        Ok(FrameTables {
            first: first.clone(),
            second: None,
            lighting: *lighting,
        })
    }

    /// As [`SkySolver::tables`], under two sources, such as sun and moon: the brighter one first, whose light gives geometry its colours
    /// behind air.
    ///
    /// # Errors
    /// As [`SkySolver::tables`].
    pub fn tables_under_two(
        &self,
        height_m: f64,
        sources: [LightSource; 2],
        fog: Option<&Fog>,
    ) -> Result<FrameTables, SkyRendererError> {
        let [first, second] = sources.map(|source| self.lit_by(height_m, source, fog));
        let (first, second) = (first?, second?);
        let ((first, lighting), (second, more)) = (&*first, &*second);
        Ok(FrameTables {
            first: first.clone(),
            second: Some(second.clone()),
            lighting: lighting.with(more),
        })
    }

    /// Tables of the light of a source, and its light at the eye: those that are kept, or else filled.
    fn lit_by(
        &self,
        height_m: f64,
        source: LightSource,
        fog: Option<&Fog>,
    ) -> Result<Arc<(SourceTables, Lighting)>, SkyRendererError> {
        check(height_m, &source)?;
        let in_air = || {
            let fill = || self.fill(height_m, source);
            self.kept.get_or((height_m, source), fill)
        };
        match fog {
            Some(fog) => {
                let place = (height_m, source, fog.clone());
                let put = || {
                    fog.validate()?;
                    self.in_fog(height_m, source, fog, &*in_air()?)
                };
                self.kept_in_fog.get_or(place, put)
            }
            None => in_air(),
        }
    }

    /// The tables of a source and its light at the eye with fog, from those without.
    fn in_fog(
        &self,
        height_m: f64,
        source: LightSource,
        fog: &Fog,
        in_air: &(SourceTables, Lighting),
    ) -> Result<(SourceTables, Lighting), SkyRendererError> {
        let (mut tables, lighting) = in_air.clone();
        let lit = self.lit_fog(fog, source, &tables.sky)?;
        let sky = tables.sky.over_ground_in_part(ground_share(&lit));
        let frame = fog.frame(height_m, &lit, &sky)?;
        let to_sun = frame.path(lighting.sun).transmittance;
        let lighting = lighting.in_fog(to_sun, |d| frame.in_front_of(sky.rgb_radiance(d), d));
        (tables.sky, tables.fog) = (sky, Some(frame));
        Ok((tables, lighting))
    }

    /// Fills the tables of the light of a source in the air, without fog.
    fn fill(
        &self,
        height_m: f64,
        source: LightSource,
    ) -> Result<(SourceTables, Lighting), SkyRendererError> {
        let view = self.sky.try_view(height_m, source)?;
        let split = view.split();
        let sky = SkyTables::of(&split, &self.fit, self.space)?;
        let direct = self.fit.sun_illuminance_lx(&view, self.space)?;
        let lighting = Lighting::new(split.table(), &sky, direct);
        let single = match &self.single {
            Some(single) => {
                let view = single.try_view(height_m, source)?;
                Some(SingleScatteringTable::new(&view.split(), &sky))
            }
            None => None,
        };
        let tables = SourceTables {
            sky,
            disc: DiscTable::new(&view),
            single,
            fog: None,
        };
        Ok((tables, lighting))
    }

    /// A fog in the light of a source and its sky at the fog's top, in the colours of `tables`.
    fn lit_fog(
        &self,
        fog: &Fog,
        source: LightSource,
        tables: &SkyTables,
    ) -> Result<RgbFog, SkyRendererError> {
        let top = self.sky.try_view(fog.top_m(), source)?;
        let direct = self.fit.sun_illuminance_lx(&top, self.space)?;
        let sky = top.downwelling_irradiance();
        let at_top = DirectLight {
            direction: tables.view.sun,
            illuminance_lx: Vec3::from_array(direct.map(|v| v as f32)),
        };
        fog.lit(
            &at_top,
            rgb_from_spectrum(tables.radiance_weights, Vec4::from_slice(&sky)),
        )
    }

    /// The solved sky.
    pub fn sky(&self) -> &Sky {
        &self.sky
    }
}

impl FrameTables {
    /// Red, green and blue along a unit vector without geometry and without the discs, cd/m^2: what the passes draw.
    pub fn rgb_radiance(&self, direction: Vec3) -> Vec3 {
        let sources = [Some(&self.first), self.second.as_ref()];
        let each = sources.into_iter().flatten();
        each.map(|source| source.rgb_radiance(direction)).sum()
    }
}

impl SourceTables {
    /// Direction to the disc of the source and its angular radius, rad; none below the horizon.
    pub(crate) fn disc_above_horizon(&self) -> Option<(DVec3, f64)> {
        let towards = self.sky.view.sun.as_dvec3().normalize();
        let radius_rad = (1.0 - f64::from(self.disc.one_minus_cos)).acos();
        let is_up = towards.y.asin() + radius_rad > f64::from(self.sky.view.horizon_rad);
        is_up.then_some((towards, radius_rad))
    }

    /// As [`FrameTables::rgb_radiance`], of this source.
    fn rgb_radiance(&self, direction: Vec3) -> Vec3 {
        let behind = self.sky.rgb_radiance(direction);
        match &self.fog {
            Some(fog) => fog.in_front_of(behind, direction),
            None => behind,
        }
    }
}

/// [`RgbFog::ground_share`] at the four wavelengths, of which those of red, green and blue are
/// the fourth, the third and the first.
fn ground_share(fog: &RgbFog) -> Vec4 {
    let [red, green, blue] = fog.ground_share().unwrap_or([1.0; 3]);
    Vec4::new(blue, 0.5 * (blue + green), green, red)
}

/// Refuses a height that is not a number, and a source without a direction or with numbers out of range.
pub(crate) fn check(height_m: f64, source: &LightSource) -> Result<(), SkyRendererError> {
    if !height_m.is_finite() {
        return Err(SkyRendererError::Height(height_m));
    }
    let (distances, phase_rad, to_sun) = match source {
        LightSource::Moon(moon) => {
            let distances = [moon.distance_m, moon.sun_distance_m];
            (distances, moon.phase_angle_rad, moon.to_sun)
        }
        LightSource::Sun(sun) => ([sun.distance_ratio; 2], 0.0, DVec3::Y),
        _ => ([1.0; 2], 0.0, DVec3::Y),
    };
    for direction in [source.direction(), to_sun] {
        if direction.try_normalize().is_none() {
            return Err(SkyRendererError::Sun(direction));
        }
    }
    let refuse = |expected, got| Err(SkyRendererError::Source { expected, got });
    let is_wrong = |distance: &f64| !(*distance > 0.0 && distance.is_finite());
    match distances.into_iter().find(is_wrong) {
        Some(wrong) => refuse("a finite distance above 0", wrong),
        None if !(0.0..=PI).contains(&phase_rad) => refuse("a phase angle from 0 to pi", phase_rad),
        None => Ok(()),
    }
}
