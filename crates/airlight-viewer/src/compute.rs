//! [`compute`]: the work that takes time, from a [`Request`] to an [`Answer`], both plain data.
//!
//! A thread or a worker of a page holds a [`Computer`], which answers as [`compute`] does and keeps solved skies for the next request.

use airlight::Control;
use airlight::atmosphere::visibility::{self, Contrast};
use airlight::atmosphere::{Atmosphere, ConstituentKind, DensityProfile, gases};
use airlight::fog::RgbLayer;
use airlight::glam::DVec3;
use airlight::models::registry;
use airlight::optics::PhaseError;
use airlight::scene::{
    AirSpec, Channels, OutputSpec, PreparedModel, RadianceSampler, RadianceView, ResolvedScene,
    Scene, SceneError, SolverSpec, SunAngles,
};
use airlight::sky::SunCoverage;
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::transfer::RgbPathOptics;
use airlight_gpu::{Fog, FrameTables, MOST_FOG_LAYERS, SkyRendererError, SkySolver};
use airlight_image::{ImageError, Size};
use airlight_render::RenderError;
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::Renderer;
use airlight_render::canvas::{Canvas, Pass};
use airlight_render::channels::PixelChannels;
#[cfg(target_arch = "wasm32")]
use airlight_render::layout::Layout;
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::sky_rows::Layer;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// RGB space of all colours.
pub const SPACE: RgbSpace = RgbSpace::Srgb;

/// Wavelength at which amounts are stated, nm.
const NM: f64 = 550.0;

/// A request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// Number of the request, which the answer repeats.
    pub number: u64,
    /// The scene; its camera matters for a [`Task::Picture`] alone, its output does not.
    pub scene: Scene,
    /// What is asked of it.
    pub task: Task,
}

/// What a [`Request`] asks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Task {
    /// What frames are drawn with.
    Light {
        /// Whether terrain throws shadows into air and fog.
        has_terrain: bool,
    },
    /// The spectrum of the solver at a point of the picture.
    Spectrum(Target),
    /// Colours of a solver or a published model.
    Colours {
        /// Name of the model.
        model: String,
        /// Directions, unit vectors; those without length are black.
        directions: Vec<[f32; 3]>,
        /// Bundles of paths for each direction by a model with noise, together with those of requests before for the same directions.
        bundles: u64,
    },
    /// The picture of the scene's camera, as the library draws it: with all that the graphics device does not draw. A page leaves out
    /// objects and the lights of the night.
    Picture,
}

/// The answer to a [`Request`].
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Number of the request.
    pub number: u64,
    /// What was asked, or why it cannot be had, as a sentence.
    pub result: Result<Output, String>,
}

/// What is answered to a [`Task`].
#[derive(Clone, Debug, PartialEq)]
pub enum Output {
    /// To [`Task::Light`].
    Light(Box<Light>),
    /// To [`Task::Spectrum`].
    Spectrum(Spectrum),
    /// To [`Task::Colours`], and to [`Task::Picture`] by pixel, row by row.
    Colours(Colours),
}

/// A point of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Its direction, a unit vector.
    pub direction: [f64; 3],
    /// The terrain that is seen there.
    pub ground: Option<GroundLight>,
}

/// A point of terrain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroundLight {
    /// Distance from the eye, m.
    pub distance_m: f64,
    /// Red, green and blue before the air in front of it, cd/m^2.
    pub rgb: [f32; 3],
}

/// Light from a direction, without the sun's disc.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spectrum {
    /// Wavelengths, nm.
    pub wavelengths_nm: Vec<f64>,
    /// Radiance, W m^-2 sr^-1 nm^-1: in front of ground that of the air and fog before it.
    pub radiance: Vec<f32>,
    /// Transmittance of the air and fog before the ground; `None` for the sky.
    pub transmittance: Option<Vec<f32>>,
    /// CIE XYZ, cd/m^2, of the ground behind its air where there is ground.
    pub xyz: [f64; 3],
}

/// Colours by a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Colours {
    /// Red, green and blue by direction, cd/m^2.
    pub rgb: Vec<[f32; 3]>,
    /// Inputs of the scene that the model ignores, and for which it has its defaults.
    pub ignored: Vec<String>,
    /// Standard error of the green of a direction relative to it, root mean square; `None` for models without noise.
    pub noise: Option<f64>,
}

/// The light of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What frames are drawn with.
    pub tables: FrameTables,
    /// Numbers of the scene.
    pub facts: Facts,
}

/// Numbers of a scene that follow from what is set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Apparent elevation of the sun, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun, degrees clockwise from north.
    pub sun_azimuth_deg: f64,
    /// Altitude of the eye above sea level, m.
    pub altitude_m: f64,
    /// Elevation of the horizon, degrees.
    pub horizon_deg: f64,
    /// Vertical optical depth of haze at 550 nm.
    pub haze_depth_550: f64,
    /// Ozone column, Dobson units; 0 in other air than the Earth's.
    pub ozone_du: f64,
    /// Albedo of the ground at 550 nm.
    pub ground_albedo: f64,
    /// Whether the air is the Earth's.
    pub is_earth: bool,
    /// Illuminance of a horizontal surface by the sun's disc, lx.
    pub sun_lx: f64,
    /// Illuminance of a horizontal surface by the sky, lx.
    pub sky_lx: f64,
    /// Whether lights shine in the fog: in a single layer that thins exponentially with height.
    pub holds_lights: bool,
    /// Distance at which the contrast of a black object at the eye's height falls to the scene's threshold, m: in air and fog of that
    /// height, at 550 nm. Infinite in space.
    pub visibility_m: f64,
}

impl Light {
    /// Altitude of the ground of the planet above sea level, m.
    pub fn ground_altitude_m(&self) -> f64 {
        self.facts.altitude_m - f64::from(self.tables.first.sky.view.height_m)
    }
}

/// Computes the answer to a request.
pub fn compute(request: &Request) -> Answer {
    Computer::default().compute(request)
}

/// Computes answers, and keeps what was solved last.
#[derive(Default)]
pub struct Computer {
    solved: Option<Solved>,
    /// Prepared models with what they are prepared for; the last is the newest.
    prepared: Vec<(Prepared, Arc<dyn PreparedModel>)>,
    traced: Option<Traced>,
}

/// Colours of a model with noise, to which paths are added.
struct Traced {
    scene: Scene,
    model: String,
    directions: Vec<[f32; 3]>,
    /// One direction a row.
    canvas: Canvas,
    bundles: u64,
}

/// What a model is prepared for: the scene, reduced to the inputs that it honours, and the name of the model.
type Prepared = (Scene, String);

/// Number of prepared models that are kept.
const PREPARED: usize = 3;

impl fmt::Debug for Computer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let prepared: Vec<&str> = self
            .prepared
            .iter()
            .map(|((_, name), _)| name.as_str())
            .collect();
        f.debug_struct("Computer")
            .field("solved", &self.solved)
            .field("prepared", &prepared)
            .finish()
    }
}

/// A sky, and the air that it is solved for.
#[derive(Debug)]
struct Solved {
    air: AirSpec,
    solver_settings: SolverSpec,
    atmosphere: Atmosphere,
    solver: SkySolver,
    /// The same with what shadows of terrain need, once there is terrain.
    shadowed: Option<SkySolver>,
}

/// Why there is no light.
#[derive(Debug, thiserror::Error)]
enum Refusal {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Renderer(#[from] SkyRendererError),
    #[error(transparent)]
    Image(#[from] ImageError),
    #[error(transparent)]
    Phase(#[from] PhaseError),
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl Computer {
    /// The answer to a request: what [`compute`] returns, sooner if the air is that of the request before.
    pub fn compute(&mut self, request: &Request) -> Answer {
        let scene = &request.scene;
        let result = match &request.task {
            Task::Light { has_terrain } => self
                .light(scene, *has_terrain)
                .map(|light| Output::Light(Box::new(light))),
            Task::Spectrum(target) => self.spectrum(scene, target).map(Output::Spectrum),
            Task::Colours {
                model,
                directions,
                bundles,
            } => {
                let colours = self.colours(scene, model, directions, *bundles);
                colours.map(Output::Colours)
            }
            Task::Picture => self.picture(scene).map(Output::Colours),
        };
        Answer {
            number: request.number,
            result: result.map_err(|error| error.to_string()),
        }
    }

    fn spectrum(&mut self, scene: &Scene, target: &Target) -> Result<Spectrum, Refusal> {
        let direction = DVec3::from_array(target.direction);
        let (view, _) = self.view(scene, registry::DEFAULT, Channels::Spectral)?;
        let grid = view.grid().expect("a spectral view");
        let mut radiance = vec![0.0; view.channel_count()];
        let wavelengths_nm = grid.wavelengths_nm().to_vec();
        let Some(ground) = target.ground else {
            view.radiance(&[direction], &mut radiance);
            return Ok(Spectrum {
                wavelengths_nm,
                xyz: grid.to_xyz(&radiance),
                radiance,
                transmittance: None,
            });
        };
        let mut transmittance = vec![0.0; view.channel_count()];
        view.path(
            direction,
            ground.distance_m,
            &mut transmittance,
            &mut radiance,
        );
        let (view, _) = self.view(scene, registry::DEFAULT, Channels::Rgb(SPACE))?;
        let mut air = RgbPathOptics::CLEAR;
        view.path(
            direction,
            ground.distance_m,
            &mut air.transmittance,
            &mut air.path_radiance,
        );
        Ok(Spectrum {
            wavelengths_nm,
            radiance,
            transmittance: Some(transmittance),
            xyz: SPACE.to_xyz(air.apply(ground.rgb).map(f64::from)),
        })
    }

    fn colours(
        &mut self,
        scene: &Scene,
        model: &str,
        directions: &[[f32; 3]],
        bundles: u64,
    ) -> Result<Colours, Refusal> {
        let (view, ignored) = self.view(scene, model, Channels::Rgb(SPACE))?;
        if let Some(sampler) = view.sampler() {
            let traced = self.traced(scene, model, directions)?;
            let (rgb, noise) = traced.add(sampler, bundles)?;
            return Ok(Colours {
                rgb,
                ignored,
                noise: Some(noise),
            });
        }
        let mut rgb = vec![[0.0; 3]; directions.len()];
        view.radiance(&unit_vectors(directions), rgb.as_flattened_mut());
        Ok(Colours {
            rgb,
            ignored,
            noise: None,
        })
    }

    /// The paths of a model with noise so far; none for another scene, model or directions than those before.
    fn traced(
        &mut self,
        scene: &Scene,
        model: &str,
        directions: &[[f32; 3]],
    ) -> Result<&mut Traced, Refusal> {
        let is_same = |traced: &Traced| {
            traced.scene == *scene && traced.model == model && traced.directions == directions
        };
        let before = self.traced.take().filter(is_same);
        let traced = match before {
            Some(traced) => traced,
            None => Traced::new(scene, model, directions)?,
        };
        Ok(self.traced.insert(traced))
    }

    /// The view of a model without the inputs that it ignores, which are named.
    fn view(
        &mut self,
        scene: &Scene,
        model: &str,
        channels: Channels,
    ) -> Result<(Arc<dyn RadianceView>, Vec<String>), Refusal> {
        let found = registry::find(model)?;
        let mut scene = scene.clone();
        scene.solver.name = Some(model.to_owned());
        let mut ignored = Vec::new();
        for input in scene.resolve()?.set_inputs {
            if !found.capabilities().honours(input) {
                ignored.push(input.to_string());
                scene = scene.without(input);
            }
        }
        let resolved = scene.resolve()?;
        let sun = resolved.sun.at_start()?;
        let altitude_m = resolved.observer_altitude_m;
        let prepared = self.prepared((scene, model.to_owned()), || {
            let suns = SunCoverage::near(sun.elevation_deg, altitude_m);
            Ok(registry::prepare(&resolved, suns, Control::default())?)
        })?;
        let view = prepared.view(altitude_m, &sun.state(), channels)?;
        Ok((view, ignored))
    }

    /// A model that is prepared for a scene, from before or as it is made.
    fn prepared(
        &mut self,
        of: Prepared,
        make: impl FnOnce() -> Result<Arc<dyn PreparedModel>, Refusal>,
    ) -> Result<Arc<dyn PreparedModel>, Refusal> {
        let known = self.prepared.iter().position(|(known, _)| *known == of);
        let prepared = match known {
            Some(place) => self.prepared.remove(place).1,
            None => make()?,
        };
        self.prepared.push((of, prepared.clone()));
        let more = self.prepared.len().saturating_sub(PREPARED);
        self.prepared.drain(..more);
        Ok(prepared)
    }

    /// The picture of a scene, with sun, objects and the lights of the night.
    #[cfg(not(target_arch = "wasm32"))]
    fn picture(&mut self, scene: &Scene) -> Result<Colours, Refusal> {
        let renderer = Renderer::new(&Scene {
            output: OutputSpec::default(),
            ..scene.clone()
        })?;
        let suns = renderer.suns_near(&renderer.sun(None)?);
        let name = renderer.model().name().to_owned();
        let lit = Scene {
            sun: scene.sun.clone(),
            observer: scene.observer.clone(),
            night: scene.night.clone(),
            air: scene.air.clone(),
            fog: scene.fog.clone(),
            solver: SolverSpec {
                name: Some(name.clone()),
                ..scene.solver.clone()
            },
            ..Default::default()
        };
        let prepared = self.prepared((lit, name), || {
            Ok(renderer.prepare(suns, Control::default())?)
        })?;
        let frame = renderer.frame(prepared.as_ref(), None)?;
        Ok(Colours {
            rgb: frame.pixels(&renderer.layout().only_frame()?, Layer::All),
            ignored: Vec::new(),
            noise: None,
        })
    }

    /// The picture of a scene, with sky, air and fog.
    #[cfg(target_arch = "wasm32")]
    fn picture(&mut self, scene: &Scene) -> Result<Colours, Refusal> {
        let sun = scene.resolve()?.sun.at_start()?;
        let layout = Layout::new(&scene.camera, &OutputSpec::default(), sun.azimuth_deg)?;
        let frame = layout.only_frame()?;
        let size = frame.size();
        let pixels = (0..size.height()).flat_map(|j| (0..size.width()).map(move |i| (i, j)));
        let directions: Vec<[f32; 3]> = pixels
            .map(|(i, j)| frame.pixel_direction(i, j).unwrap_or_default())
            .map(|direction| direction.as_vec3().to_array())
            .collect();
        self.colours(scene, registry::DEFAULT, &directions, 0)
    }

    fn light(&mut self, scene: &Scene, has_terrain: bool) -> Result<Light, Refusal> {
        let resolved = scene.resolve()?;
        let sun = resolved.sun.at_start()?;
        let altitude_m = resolved.observer_altitude_m;
        let fog = fog(&resolved)?;
        let solved = self.solved(scene, &resolved, &sun)?;
        let solver = match has_terrain {
            true => solved.shadowed()?,
            false => &solved.solver,
        };
        let tables = solver.tables(altitude_m, sun.state(), fog.as_ref())?;
        let contrast = scene.air.visibility_contrast();
        let facts = facts(&resolved, &sun, &tables, contrast);
        Ok(Light { tables, facts })
    }

    /// A sky that covers the scene. The first one of an air is solved for its sun alone, the second for all suns, as the sun moves.
    fn solved(
        &mut self,
        scene: &Scene,
        resolved: &ResolvedScene,
        sun: &SunAngles,
    ) -> Result<&mut Solved, Refusal> {
        let altitude_m = resolved.observer_altitude_m;
        let is_same = |solved: &&mut Solved| {
            solved.air == scene.air
                && solved.solver_settings == scene.solver
                && solved.atmosphere == resolved.atmosphere
        };
        let before = self.solved.as_mut().filter(is_same);
        let covers = |solver: &SkySolver| solver.sky().covers(altitude_m, sun.elevation_deg);
        let suns = match before {
            Some(solved) if covers(&solved.solver) => None,
            Some(_) => Some(SunCoverage::All),
            None => Some(SunCoverage::near(sun.elevation_deg, altitude_m)),
        };
        if let Some(suns) = suns {
            let settings = scene.solver.sky_settings(suns);
            self.solved = Some(Solved {
                air: scene.air.clone(),
                solver_settings: scene.solver.clone(),
                atmosphere: resolved.atmosphere.clone(),
                solver: SkySolver::new(&resolved.atmosphere, &settings, SPACE)?,
                shadowed: None,
            });
        }
        Ok(self.solved.as_mut().expect("a sky that was solved"))
    }
}

impl Solved {
    /// The sky with what shadows of terrain need.
    fn shadowed(&mut self) -> Result<&SkySolver, SkyRendererError> {
        if self.shadowed.is_none() {
            self.shadowed = Some(self.solver.clone().with_shadows()?);
        }
        Ok(self.shadowed.as_ref().unwrap_or(&self.solver))
    }
}

impl Traced {
    fn new(scene: &Scene, model: &str, directions: &[[f32; 3]]) -> Result<Self, ImageError> {
        let size = Size::new(1, directions.len() as u32)?;
        Ok(Self {
            scene: scene.clone(),
            model: model.to_owned(),
            directions: directions.to_vec(),
            canvas: Canvas::new(size, &PixelChannels::rgb(SPACE), false),
            bundles: 0,
        })
    }

    /// Adds bundles of paths up to a number, and returns the colours and their noise.
    fn add(
        &mut self,
        sampler: &dyn RadianceSampler,
        bundles: u64,
    ) -> Result<(Vec<[f32; 3]>, f64), ImageError> {
        let directions = unit_vectors(&self.directions);
        let pass = Pass {
            bundles: self.bundles..bundles.max(self.bundles),
            goal: bundles,
        };
        let sample = |_, row: u32, bundle, found: &mut [f64], _: Option<&mut [f64; 3]>| {
            let direction = directions[row as usize];
            if direction != DVec3::ZERO {
                sampler.add_bundle(direction, bundle, found);
            }
        };
        self.canvas.add_with(&pass, Control::default(), sample)?;
        self.bundles = pass.bundles.end;
        let (squares, count) = self.canvas.relative_errors();
        let noise = (squares / count.max(1) as f64).sqrt();
        let rgb = self.canvas.means().as_chunks().0.to_vec();
        Ok((rgb, noise))
    }
}

/// Directions in double precision; those without length stay zero.
fn unit_vectors(directions: &[[f32; 3]]) -> Vec<DVec3> {
    let directions = directions.iter();
    directions
        .map(|d| Vec3::from_array(*d).as_dvec3().normalize_or_zero())
        .collect()
}

/// A scene's fog, of as many layers as the device draws.
fn fog(scene: &ResolvedScene) -> Result<Option<Fog>, Refusal> {
    let Some(fog) = &scene.fog else {
        return Ok(None);
    };
    let planet = &scene.atmosphere.planet;
    let ground_height_m = planet.ground_altitude_m;
    let grid = WavelengthGrid::standard();
    let mut layers = Vec::new();
    for layer in fog.layers.iter().take(MOST_FOG_LAYERS) {
        let part = layer.constituent(grid.wavelengths_nm())?;
        let Some(mut part) = part.raised(ground_height_m) else {
            continue;
        };
        // The device's layers have two edges; below the ground nothing is seen.
        if let DensityProfile::Layer { bottom_m, .. } = &mut part.density {
            *bottom_m = bottom_m.max(ground_height_m);
        }
        layers.push(RgbLayer::from_constituent(&part, SPACE)?);
    }
    Ok((!layers.is_empty()).then(|| Fog {
        layers,
        ground_height_m,
        ground_albedo: [planet.ground_albedo.at(NM) as f32; 3],
    }))
}

fn facts(
    scene: &ResolvedScene,
    sun: &SunAngles,
    tables: &FrameTables,
    contrast: Contrast,
) -> Facts {
    let air = &scene.atmosphere;
    let top_m = air.planet.top_altitude_m;
    let ground_m = air.planet.ground_altitude_m;
    let depth = |kind, nm| {
        let part = air.constituent(&kind);
        part.map_or(0.0, |part| part.optical_depth(ground_m, top_m, nm))
    };
    // The middle of ozone's Chappuis bands.
    let per_du = gases::ozone(1.0).optical_depth(ground_m, top_m, 600.0);
    let light = &tables.lighting;
    let luminance = |rgb: Vec3| SPACE.luminance(rgb.to_array().map(f64::from));
    Facts {
        sun_elevation_deg: sun.elevation_deg,
        sun_azimuth_deg: sun.azimuth_deg,
        altitude_m: scene.observer_altitude_m,
        horizon_deg: f64::from(tables.first.sky.view.horizon_rad).to_degrees(),
        haze_depth_550: depth(ConstituentKind::Aerosol, NM),
        ozone_du: depth(ConstituentKind::Ozone, 600.0) / per_du,
        ground_albedo: air.planet.ground_albedo.at(NM),
        is_earth: air.is_earth(),
        sun_lx: luminance(light.sun_illuminance_lx) * f64::from(light.sun.y.max(0.0)),
        sky_lx: luminance(light.sky_illuminance_lx(Vec3::Y)),
        holds_lights: tables
            .first
            .fog
            .as_ref()
            .is_some_and(|fog| fog.around_lights.is_some()),
        visibility_m: visibility::visibility_m(extinction_at_eye_per_m(scene), contrast),
    }
}

/// Extinction of air and fog at the height of the eye at 550 nm, 1/m.
fn extinction_at_eye_per_m(scene: &ResolvedScene) -> f64 {
    let altitude_m = scene.observer_altitude_m;
    let height_m = altitude_m - scene.atmosphere.planet.ground_altitude_m;
    let layers = scene.fog.iter().flat_map(|fog| &fog.layers);
    let fog: f64 = layers
        .map(|layer| layer.extinction_per_m * layer.profile.at(height_m))
        .sum();
    let is_in_air = altitude_m < scene.atmosphere.planet.top_altitude_m;
    let air = match is_in_air {
        true => scene.atmosphere.extinction_per_m(altitude_m, NM),
        false => 0.0,
    };
    air + fog
}
