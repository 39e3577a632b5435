//! [`compute`]: the work that takes time, from a [`Request`] to an [`Answer`], both plain data.
//!
//! A thread or a worker of a page holds a [`Computer`], which answers as [`compute`] does and keeps solved skies for the next request.

use airlight::atmosphere::{Atmosphere, ConstituentKind, gases};
use airlight::fog::RgbLayer;
use airlight::scene::{AirSpec, ResolvedScene, Scene, SceneError, SolverSpec, SunAngles};
use airlight::sky::SunCoverage;
use airlight::spectrum::RgbSpace;
use airlight_gpu::{Fog, FrameTables, SkyRendererError, SkySolver};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// RGB space of all colours.
pub const SPACE: RgbSpace = RgbSpace::Srgb;

/// Wavelength at which amounts are stated, nm.
const NM: f64 = 550.0;

/// A request for light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// Number of the request, which the answer repeats.
    pub number: u64,
    /// The scene; its camera and output do not matter.
    pub scene: Scene,
}

/// The answer to a [`Request`].
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Number of the request.
    pub number: u64,
    /// The light, or why there is none, as a sentence.
    pub result: Result<Box<Light>, String>,
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
}

/// Computes the answer to a request.
pub fn compute(request: &Request) -> Answer {
    Computer::default().compute(request)
}

/// Computes answers, and keeps the last solved sky.
#[derive(Debug, Default)]
pub struct Computer {
    solved: Option<Solved>,
}

/// A sky, and the air that it is solved for.
#[derive(Debug)]
struct Solved {
    air: AirSpec,
    solver_settings: SolverSpec,
    atmosphere: Atmosphere,
    solver: SkySolver,
}

/// Why there is no light.
#[derive(Debug, thiserror::Error)]
enum Refusal {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Renderer(#[from] SkyRendererError),
}

impl Computer {
    /// The answer to a request: what [`compute`] returns, sooner if the air is that of the request before.
    pub fn compute(&mut self, request: &Request) -> Answer {
        let light = self.light(&request.scene).map(Box::new);
        Answer {
            number: request.number,
            result: light.map_err(|error| error.to_string()),
        }
    }

    fn light(&mut self, scene: &Scene) -> Result<Light, Refusal> {
        let resolved = scene.resolve()?;
        let sun = resolved.sun.at_start()?;
        let altitude_m = resolved.observer_altitude_m;
        let fog = fog(&resolved)?;
        let solver = self.solver(scene, &resolved, &sun)?;
        let tables = solver.tables(altitude_m, sun.direction(), fog.as_ref())?;
        let facts = facts(&resolved, &sun, &tables);
        Ok(Light { tables, facts })
    }

    /// A sky that covers the scene. The first one of an air is solved for its sun alone, the second for all suns, as the sun moves.
    fn solver(
        &mut self,
        scene: &Scene,
        resolved: &ResolvedScene,
        sun: &SunAngles,
    ) -> Result<&SkySolver, Refusal> {
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
            });
        }
        Ok(&self.solved.as_ref().expect("a sky that was solved").solver)
    }
}

/// The first layer of a scene's fog.
fn fog(scene: &ResolvedScene) -> Result<Option<Fog>, SceneError> {
    let Some(layer) = scene.fog.as_ref().and_then(|fog| fog.layers.first()) else {
        return Ok(None);
    };
    let planet = &scene.atmosphere.planet;
    let ground_height_m = planet.ground_altitude_m;
    let part = layer.constituent(&[NM])?;
    let density = part.density.raised(ground_height_m);
    Ok(density.map(|density| Fog {
        layer: RgbLayer {
            density,
            extinction_per_m: [layer.extinction_per_m as f32; 3],
            single_scattering_albedo: [1.0; 3],
            phase: part.phase,
        },
        ground_height_m,
        ground_albedo: [planet.ground_albedo.at(NM) as f32; 3],
    }))
}

fn facts(scene: &ResolvedScene, sun: &SunAngles, tables: &FrameTables) -> Facts {
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
        horizon_deg: f64::from(tables.sky.view.horizon_rad).to_degrees(),
        haze_depth_550: depth(ConstituentKind::Aerosol, NM),
        ozone_du: depth(ConstituentKind::Ozone, 600.0) / per_du,
        ground_albedo: air.planet.ground_albedo.at(NM),
        is_earth: air.is_earth(),
        sun_lx: luminance(light.sun_illuminance_lx) * f64::from(light.sun.y.max(0.0)),
        sky_lx: luminance(light.sky_illuminance_lx(Vec3::Y)),
    }
}
