//! [`SkyRenderer`].

use crate::camera::Camera;
use crate::device_loss::is_device_lost;
use crate::environment::EnvironmentMap;
use crate::error::SkyRendererError;
use crate::fog::Fog;
use crate::frame_tables::{FrameTables, SkySolver, check};
use crate::lighting::Lighting;
use crate::passes::SkyPasses;
use crate::shadows::SunShadows;
use airlight::atmosphere::Atmosphere;
use airlight::fog::lights::Light;
use airlight::sky::{LightSource, Sky, SkySettings};
use airlight::spectrum::RgbSpace;
use std::panic::resume_unwind;
use std::thread::JoinHandle;

/// Settings of a [`SkyRenderer`].
#[derive(Clone, Debug, PartialEq)]
pub struct SkyRendererSettings {
    /// Format of the target: linear, and blendable, such as `Rgba16Float`.
    pub target_format: wgpu::TextureFormat,
    /// RGB space of the target.
    pub space: RgbSpace,
    /// Settings of the solver: [`SkySolver::default_settings`] unless set. With the default suns it solves once for all suns and heights.
    pub solver: SkySettings,
    /// Whether tables hold what shadows in the air need: [`SkyRenderer::record_shadowed`].
    pub shadows: bool,
}

impl SkyRendererSettings {
    /// Linear sRGB in a target of a format.
    pub fn new(target_format: wgpu::TextureFormat) -> Self {
        Self {
            target_format,
            space: RgbSpace::Srgb,
            solver: SkySolver::default_settings(),
            shadows: false,
        }
    }
}

/// What a [`SkyRenderer`] has computed since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Tables filled and uploaded.
    pub tables: u64,
    /// Frames recorded.
    pub frames: u64,
}

/// Draws air, sky and sun over frames.
#[derive(Debug)]
pub struct SkyRenderer {
    solver: SkySolver,
    passes: SkyPasses,
    second: Option<LightSource>,
    fog: Option<Fog>,
    has_lights: bool,
    drawn: Option<Place>,
    /// Tables that are being filled, and what they are for.
    filling: Option<(JoinHandle<Result<FrameTables, SkyRendererError>>, Place)>,
    /// Number of the air of the solver.
    air: u64,
    /// Air that is being solved for.
    solving: Option<(JoinHandle<Result<SkySolver, SkyRendererError>>, Atmosphere)>,
    /// Air to solve for next.
    next_air: Option<Atmosphere>,
    work: Work,
}

/// What tables are for.
#[derive(Clone, Debug, PartialEq)]
struct Place {
    /// Number of the air.
    air: u64,
    /// Height of the eye above sea level, m.
    height_m: f64,
    first: LightSource,
    second: Option<LightSource>,
    fog: Option<Fog>,
}

impl SkyRenderer {
    /// Solves for the light in an atmosphere, which takes a second or more, and makes the pipelines.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved, or for a target that cannot be blended.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        atmosphere: &Atmosphere,
        settings: &SkyRendererSettings,
    ) -> Result<Self, SkyRendererError> {
        let solver = SkySolver::new(atmosphere, &settings.solver, settings.space)?;
        Ok(Self {
            passes: SkyPasses::new(device, queue, settings.target_format)?,
            solver: match settings.shadows {
                true => solver.with_shadows()?,
                false => solver,
            },
            second: None,
            fog: None,
            has_lights: false,
            drawn: None,
            filling: None,
            air: 0,
            solving: None,
            next_air: None,
            work: Work::default(),
        })
    }

    /// Draws on another device from now on, as after a loss of the one before, with the same air, lights and discs, and with tables for the
    /// same eye and sun, which it fills again. What else is on a device, such as a [`TerrainPass`](crate::TerrainPass), a
    /// [`TonePass`](crate::TonePass) or an [`EnvironmentMap`], is made again by its own constructor.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::update`]. The renderer is as before then.
    pub fn recreate(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<(), SkyRendererError> {
        let mut passes = self.passes.on_device(device, queue)?;
        if let Some(place) = &self.drawn {
            let place = Place {
                air: self.air,
                ..place.clone()
            };
            passes.set_tables(&self.fill(&place)()?);
            self.drawn = Some(place);
            self.work.tables += 1;
        }
        self.passes = passes;
        Ok(())
    }

    /// Draws other air from the next update on, which it solves for with the same settings: a second or more. Until then, frames are drawn
    /// with the last tables.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved.
    pub fn set_atmosphere(&mut self, atmosphere: &Atmosphere) -> Result<(), SkyRendererError> {
        self.set_solver(self.solver.in_atmosphere(atmosphere)?);
        Ok(())
    }

    /// As [`Self::set_atmosphere`], with what another thread has solved: see [`SkySolver::in_atmosphere`] of [`Self::solver`].
    pub fn set_solver(&mut self, solver: SkySolver) {
        (self.solving, self.next_air) = (None, None);
        self.replace_solver(solver);
    }

    /// As [`Self::set_atmosphere`], but solves on a thread of its own and returns at once, so that a program that calls this and
    /// [`Self::update_in_background`] before each frame keeps its pace while the air changes, as when a slider is dragged. Frames are drawn
    /// with the last tables until those in other air are filled. While air is being solved for, the last one that was set waits; each that
    /// has been solved for is drawn, and the last one in the end. Where threads cannot be started, as in a browser, it solves at once.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved, in this call or in a later one of [`Self::update_in_background`]; frames go on in
    /// the air before.
    pub fn set_atmosphere_in_background(
        &mut self,
        atmosphere: &Atmosphere,
    ) -> Result<(), SkyRendererError> {
        let solving = self.solving.as_ref().map(|(_, air)| air);
        let solved = self.solver.sky().atmosphere();
        if self.next_air.as_ref().or(solving).unwrap_or(solved) != atmosphere {
            self.next_air = Some(atmosphere.clone());
        }
        self.solve_next()
    }

    /// Starts to solve for the air that waits, unless other air is being solved for.
    fn solve_next(&mut self) -> Result<(), SkyRendererError> {
        if self.solving.is_some() {
            return Ok(());
        }
        let Some(air) = self.next_air.take() else {
            return Ok(());
        };
        let (solver, of_thread) = (self.solver.clone(), air.clone());
        match std::thread::Builder::new().spawn(move || solver.in_atmosphere(&of_thread)) {
            Ok(thread) => self.solving = Some((thread, air)),
            Err(_) => self.replace_solver(self.solver.in_atmosphere(&air)?),
        }
        Ok(())
    }

    /// Takes what has been solved in the background, and goes on with the air that waits.
    fn take_solved(&mut self) -> Result<(), SkyRendererError> {
        let Some((thread, _)) = self.solving.take_if(|(t, _)| t.is_finished()) else {
            return Ok(());
        };
        let solved = thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        if let Ok(solver) = &solved {
            self.replace_solver(solver.clone());
        }
        self.solve_next()?;
        solved.map(|_| ())
    }

    /// Fills tables with another solver. Those that are being filled with the one before are drawn until then.
    fn replace_solver(&mut self, solver: SkySolver) {
        self.solver = solver;
        self.air += 1;
    }

    /// Sets the height of the eye above sea level, m, and the sun, by its direction or with its distance, or another source in its
    /// place. Fills the tables if any of these has changed, or the second source, or the fog.
    ///
    /// # Errors
    /// [`SkyRendererError`] for numbers that are no place or direction, for a place that the sky is not prepared for and cannot be
    /// solved for, and [`SkyRendererError::DeviceLost`], after which [`Self::recreate`] goes on with another device.
    pub fn update(
        &mut self,
        height_m: f64,
        sun: impl Into<LightSource>,
    ) -> Result<(), SkyRendererError> {
        let sun = sun.into();
        self.check_device()?;
        check(height_m, &sun)?;
        self.take_solved()?;
        let place = self.place(height_m, sun);
        if !self.is_drawn(&place) {
            let tables = self.fill(&place)()?;
            // Those that are being filled are for a moment before.
            self.filling = None;
            self.show(&tables, place);
        }
        Ok(())
    }

    /// Sets or removes a second source of light, from the next update on: the moon beside the sun, or a second sun. The sun should be the
    /// brighter one of the two, as its light gives geometry its colours behind air; once the moon is, it may take its place in
    /// [`SkyRenderer::update`].
    ///
    /// # Errors
    /// [`SkyRendererError::Sun`] for a source without a direction.
    pub fn set_second_source(
        &mut self,
        source: Option<LightSource>,
    ) -> Result<(), SkyRendererError> {
        source
            .as_ref()
            .map_or(Ok(()), |source| check(0.0, source))?;
        self.second = source;
        Ok(())
    }

    /// Sets or removes a fog in front of everything, from the next update on.
    ///
    /// # Errors
    /// [`SkyRendererError::Fog`], [`SkyRendererError::FogProfile`] and [`SkyRendererError::FogLayers`] for an invalid fog, and
    /// [`SkyRendererError::LightProfile`] for one that lights cannot be in.
    pub fn set_fog(&mut self, fog: Option<Fog>) -> Result<(), SkyRendererError> {
        fog.as_ref().map_or(Ok(()), Fog::validate)?;
        check_lights(fog.as_ref(), self.has_lights)?;
        self.fog = fog;
        Ok(())
    }

    /// Sets the lights that shine in the fog from the next frame on, at most [`MOST_LIGHTS`](crate::MOST_LIGHTS), instead of those before:
    /// see [`SkyPasses::set_lights`]. No tables are filled.
    ///
    /// # Errors
    /// [`SkyRendererError`] for invalid lights, for more than there may be, and for a fog that they cannot be in.
    pub fn set_lights(&mut self, lights: &[Light<[f32; 3]>]) -> Result<(), SkyRendererError> {
        check_lights(self.fog.as_ref(), !lights.is_empty())?;
        self.passes.set_lights(lights)?;
        self.has_lights = !lights.is_empty();
        Ok(())
    }

    /// Sets whether frames show the discs of sun and moon: see [`SkyPasses::set_discs`].
    pub fn set_discs(&mut self, has_discs: bool) {
        self.passes.set_discs(has_discs);
    }

    /// As [`SkyRenderer::update`], but fills the tables on a thread of their own. Until they are filled, frames are drawn with the last
    /// ones, so that a program that calls this before each frame keeps its pace while the sun moves. True if the tables are those
    /// of this eye and sun, in the air that was set last. Where threads cannot be started, as in a browser, it fills the tables at once.
    ///
    /// # Errors
    /// As [`SkyRenderer::update`], in this or in a later call.
    ///
    /// # Panics
    /// Where the thread has panicked.
    pub fn update_in_background(
        &mut self,
        height_m: f64,
        sun: impl Into<LightSource>,
    ) -> Result<bool, SkyRendererError> {
        let sun = sun.into();
        self.check_device()?;
        check(height_m, &sun)?;
        self.take_solved()?;
        let place = self.place(height_m, sun);
        if let Some((thread, filled_for)) = self.filling.take_if(|(t, _)| t.is_finished()) {
            let tables = thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
            self.show(&tables, filled_for);
        }
        if !self.is_drawn(&place) && self.filling.is_none() {
            match std::thread::Builder::new().spawn(self.fill(&place)) {
                Ok(thread) => self.filling = Some((thread, place.clone())),
                Err(_) => self.update(height_m, place.first)?,
            }
        }
        Ok(self.is_drawn(&place) && self.solving.is_none())
    }

    fn check_device(&self) -> Result<(), SkyRendererError> {
        match is_device_lost(self.passes.device()) {
            true => Err(SkyRendererError::DeviceLost),
            false => Ok(()),
        }
    }

    fn place(&self, height_m: f64, first: LightSource) -> Place {
        Place {
            air: self.air,
            height_m,
            first,
            second: self.second,
            fog: self.fog.clone(),
        }
    }

    fn is_drawn(&self, place: &Place) -> bool {
        self.drawn.as_ref() == Some(place)
    }

    /// The work that fills tables.
    fn fill(
        &self,
        place: &Place,
    ) -> impl FnOnce() -> Result<FrameTables, SkyRendererError> + Send + use<> {
        let (solver, place) = (self.solver.clone(), place.clone());
        move || {
            let (height_m, fog) = (place.height_m, place.fog.as_ref());
            match place.second {
                Some(second) => solver.tables_under_two(height_m, [place.first, second], fog),
                None => solver.tables(height_m, place.first, fog),
            }
        }
    }

    /// Draws with tables from now on.
    fn show(&mut self, tables: &FrameTables, place: Place) {
        self.passes.set_tables(tables);
        self.drawn = Some(place);
        self.work.tables += 1;
    }

    /// The light of sun and sky at the eye that frames are drawn for; `None` before the first tables.
    pub fn lighting(&self) -> Option<&Lighting> {
        self.passes.lighting()
    }

    /// Records the air, sky and sun of a frame into `target`, which holds what the program has rendered, with its depth. Before the
    /// first tables it draws nothing.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
    ) {
        self.record_shadowed(encoder, target, depth, camera, None);
    }

    /// As [`SkyRenderer::record`], with shadows in air and fog: see [`SkyPasses::record_shadowed`].
    pub fn record_shadowed(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
        shadows: Option<&SunShadows>,
    ) {
        let passes = &self.passes;
        passes.record_shadowed(encoder, target, depth, camera, shadows);
        self.work.frames += u64::from(self.lighting().is_some());
    }

    /// A map of light from all directions, with faces of `side` texels on a side: a power of two from 8 to 2048.
    ///
    /// # Errors
    /// [`SkyRendererError::EnvironmentSide`] for another side.
    pub fn environment_map(&self, side: u32) -> Result<EnvironmentMap, SkyRendererError> {
        self.passes.environment_map(side)
    }

    /// Records the light of sky, ground and fog around the eye into a map, in cd/m^2 times an exposure. Before the first tables it records
    /// nothing.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for an exposure that is negative or not finite.
    pub fn record_environment(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        map: &mut EnvironmentMap,
        exposure: f32,
    ) -> Result<(), SkyRendererError> {
        self.passes.record_environment(encoder, map, exposure)
    }

    /// What has been computed so far.
    pub fn work(&self) -> Work {
        self.work
    }

    /// The solved sky.
    pub fn sky(&self) -> &Sky {
        self.solver.sky()
    }

    /// What fills the tables. Cloning is cheap, so that a thread can solve for other air with its settings.
    pub fn solver(&self) -> &SkySolver {
        &self.solver
    }
}

/// Refuses lights in a fog that is not a single exponential layer.
fn check_lights(fog: Option<&Fog>, has_lights: bool) -> Result<(), SkyRendererError> {
    match fog.filter(|_| has_lights).map(Fog::around_lights) {
        Some(None) => Err(SkyRendererError::LightProfile),
        _ => Ok(()),
    }
}
