//! [`Probe`]: evaluation of a scene's solver along rays.

use super::answer::{
    MoonAnswer, ObserverAnswer, PROBE_FORMAT, ProbeAnswer, RayAnswer, SkyAnswer, SunAnswer,
};
use super::monte_carlo::{MonteCarloAnswer, PolarisationAnswer};
use super::rays::ProbeRay;
use crate::error::RenderError;
use crate::illuminance::Illuminances;
use crate::metadata::SOFTWARE;
use crate::renderer::LIGHT_AT_THE_EYE;
use airlight::Named;
use airlight::models::registry;
use airlight::night::MoonState;
use airlight::scene::{
    CameraSpec, Channels, Input, OutputSpec, RadianceModel, RadianceView, ResolvedScene, Scene,
    SunAngles, check_inputs,
};
use airlight::sky::{Scattering, SunCoverage};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::{Cancelled, Control, axes};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Default number of Monte Carlo paths for each ray.
const PATHS: u64 = 65_536;

/// A scene whose light is computed along rays. Camera, output and objects have no effect.
#[derive(Clone, Debug)]
pub struct Probe {
    scene: Scene,
    resolved: ResolvedScene,
    model: &'static dyn RadianceModel,
    rays: Vec<ProbeRay>,
}

impl Probe {
    /// Checks a scene and rays as far as possible without solving for light.
    ///
    /// # Errors
    /// [`RenderError`] for values out of range, values that contradict each other, and inputs that the solver would ignore.
    pub fn new(scene: &Scene, rays: Vec<ProbeRay>) -> Result<Self, RenderError> {
        let mut scene = scene.clone();
        // A probe does not draw a picture.
        scene.output = OutputSpec {
            color_space: scene.output.color_space,
            polarisation: scene.output.polarisation,
            ..OutputSpec::default()
        };
        (scene.camera, scene.objects, scene.sequence) = (CameraSpec::default(), None, None);
        let mut resolved = scene.resolve()?;
        if rays.iter().any(|ray| ray.distance_m.is_some()) {
            resolved.set_inputs.push(Input::Distances);
        }
        let model = registry::of_scene(&resolved)?;
        let variant = scene.solver.variant.as_deref();
        check_inputs(model, &resolved.set_inputs, variant, registry::ALL)?;
        resolved.sun.at_start()?;
        scene.solver.paths.get_or_insert(PATHS);
        resolved.solver = scene.solver.clone();
        Ok(Self {
            scene,
            resolved,
            model,
            rays,
        })
    }

    /// Computes the light along the rays.
    ///
    /// # Errors
    /// [`RenderError::Scene`] if the solver fails.
    pub fn answer(&self, control: Control<'_>) -> Result<ProbeAnswer, RenderError> {
        let (scene, resolved) = (&self.scene, &self.resolved);
        let sun = resolved.sun.at_start()?;
        let suns = SunCoverage::near(sun.elevation_deg, resolved.observer_altitude_m);
        control.stage("solving for the light in the air", 0);
        let prepared = self.model.prepare(resolved, suns, control)?;
        control.stage(LIGHT_AT_THE_EYE, 0);
        let space = scene.output.color_space.unwrap_or_default();
        let channels = match prepared.grid() {
            Some(_) => Channels::Spectral,
            None => Channels::Rgb(space),
        };
        let altitude_m = resolved.observer_altitude_m;
        let night = resolved.night(&sun);
        let paths = match &night {
            Some(night) => {
                prepared.night_view_with(altitude_m, &sun.state(), night, channels, control)?
            }
            None => prepared.view_of_rays_with(altitude_m, &sun.state(), channels, control)?,
        };
        let view = match paths.sampler() {
            Some(sampler) => sampler.preview(),
            None => paths.clone(),
        };
        let asked = Asked {
            foggy: resolved.fog.is_some(),
            lit_by_night: night.is_some() && self.model.capabilities().honours(Input::Night),
            view,
            paths,
            space,
            polarised: scene.output.polarisation == Some(true),
        };
        let capabilities = self.model.capabilities();
        let scattering = resolved.solver.scattering.unwrap_or(Scattering::All).name();
        let variants = capabilities.variants;
        let variant = scene.solver.variant.clone();
        let views = self.rays.par_iter().map(|ray| asked.ray(ray, control));
        Ok(ProbeAnswer {
            format: PROBE_FORMAT,
            program: SOFTWARE,
            atmosphere: capabilities
                .honours(Input::Atmosphere)
                .then(|| resolved.atmosphere.name.clone()),
            scattering: capabilities
                .honours(Input::Scattering)
                .then_some(scattering),
            solver: self.model.name(),
            variant: variant.or_else(|| variants.first().map(|name| (*name).to_owned())),
            color_space: space.name(),
            wavelengths_nm: asked.wavelengths_nm(),
            observer: observer(resolved),
            sun: asked.sun(&sun),
            moon: night
                .and_then(|night| night.moon)
                .and_then(|moon| asked.moon(&moon)),
            sky: asked.sky(),
            views: views.collect::<Result<_, Cancelled>>()?,
        })
    }
}

/// Views from which the result is computed.
struct Asked {
    /// View without noise.
    view: Arc<dyn RadianceView>,
    /// View of the scene's solver.
    paths: Arc<dyn RadianceView>,
    space: RgbSpace,
    polarised: bool,
    /// Whether there is fog, which the parts of a ray do not include.
    foggy: bool,
    /// Whether the lights of the night are included, which are not separated into parts.
    lit_by_night: bool,
}

impl Asked {
    fn wavelengths_nm(&self) -> Vec<f64> {
        let grid = self.view.grid().map(WavelengthGrid::wavelengths_nm);
        grid.unwrap_or_default().to_vec()
    }

    /// The values of a view as a spectrum; empty for colours.
    fn spectrum(&self, values: &[f32]) -> Vec<f32> {
        match self.view.grid() {
            Some(_) => values.to_vec(),
            None => Vec::new(),
        }
    }

    fn xyz(&self, values: &[f32]) -> [f64; 3] {
        match (self.view.grid(), values) {
            (Some(grid), spectrum) => grid.to_xyz(spectrum),
            (None, &[r, g, b]) => self.space.to_xyz([r, g, b].map(f64::from)),
            (None, _) => [0.0; 3],
        }
    }

    fn values(&self, fill: impl Fn(&dyn RadianceView, &mut [f32])) -> Vec<f32> {
        let mut values = vec![0.0; self.view.channel_count()];
        fill(self.view.as_ref(), &mut values);
        values
    }

    fn sun(&self, sun: &SunAngles) -> SunAnswer {
        let view = self.view.as_ref();
        let light = Illuminances::of(view);
        let normal = self.values(|view, out| view.sun_irradiance(out));
        let cosine = view.sun().y.max(0.0) as f32;
        let horizontal: Vec<f32> = normal.iter().map(|e| e * cosine).collect();
        let outside = view.grid().map(|grid| {
            let solar = grid.solar_irradiance().iter();
            solar.map(|&e| e as f32).collect()
        });
        SunAnswer {
            azimuth_deg: sun.azimuth_deg,
            elevation_deg: sun.elevation_deg,
            direction: view.sun().to_array(),
            geometric_elevation_deg: sun.geometric_elevation_deg,
            distance_ratio: sun.distance_ratio,
            angular_radius_deg: view.disc().angular_radius_rad.to_degrees(),
            irradiance_outside_w_m2_nm: outside.unwrap_or_default(),
            irradiance_normal_w_m2_nm: self.spectrum(&normal),
            irradiance_horizontal_w_m2_nm: self.spectrum(&horizontal),
            illuminance_normal_lx: light.sun_normal_lx,
            illuminance_horizontal_lx: light.sun_horizontal_lx,
            rgb_normal_lx: self.space.from_xyz(self.xyz(&normal)),
        }
    }

    /// The moon and its light, if it lights the view.
    fn moon(&self, moon: &MoonState) -> Option<MoonAnswer> {
        let lit = self.view.moon()?;
        let light = Illuminances::of(self.view.as_ref());
        let normal = self.values(|_, out| lit.sun_irradiance(out));
        Some(MoonAnswer {
            azimuth_deg: axes::azimuth_deg(moon.direction),
            elevation_deg: axes::elevation_deg(moon.direction),
            phase_angle_deg: moon.phase_angle_rad.to_degrees(),
            lit_fraction: moon.lit_fraction(),
            angular_radius_deg: moon.angular_radius_rad().to_degrees(),
            irradiance_normal_w_m2_nm: self.spectrum(&normal),
            illuminance_normal_lx: light.moon_normal_lx?,
            illuminance_horizontal_lx: light.moon_horizontal_lx?,
        })
    }

    fn sky(&self) -> SkyAnswer {
        let values = self.values(|view, out| view.horizontal_irradiance(out));
        SkyAnswer {
            irradiance_horizontal_w_m2_nm: self.spectrum(&values),
            illuminance_horizontal_lx: Illuminances::of(self.view.as_ref()).sky_horizontal_lx,
            rgb_horizontal_lx: self.space.from_xyz(self.xyz(&values)),
        }
    }

    fn ray(&self, ray: &ProbeRay, control: Control<'_>) -> Result<RayAnswer, Cancelled> {
        control.check()?;
        let direction = axes::direction(ray.azimuth_deg, ray.elevation_deg);
        let clear = self.view.line_of_sight(direction, ray.distance_m);
        let meets_ground = match &clear {
            Some(line) => line.meets_ground,
            None => direction.y.clamp(-1.0, 1.0).asin() < self.view.horizon_elevation_rad(),
        };
        let line = clear.filter(|_| !self.foggy);
        let (values, transmittance) = match &line {
            Some(line) => (line.radiance(), Some(line.transmittance.clone())),
            None => self.as_a_whole(direction, ray.distance_m.filter(|_| !meets_ground)),
        };
        let xyz = self.xyz(&values);
        // A ray that ends on the ground includes its light.
        let limit_m = ray.distance_m.filter(|_| !meets_ground);
        let part =
            |of: fn(&airlight::sky::LineOfSight) -> &Vec<f32>| line.as_ref().map(of).cloned();
        Ok(RayAnswer {
            azimuth_deg: ray.azimuth_deg,
            elevation_deg: ray.elevation_deg,
            direction: direction.to_array(),
            distance_m: ray.distance_m,
            meets_ground,
            sun_angle_deg: direction.angle_between(self.view.sun()).to_degrees(),
            radiance_w_m2_sr_nm: self.spectrum(&values),
            radiance_single_w_m2_sr_nm: part(|line| &line.single),
            radiance_multiple_w_m2_sr_nm: part(|line| &line.multiple),
            radiance_ground_w_m2_sr_nm: part(|line| &line.ground),
            transmittance,
            xyz_cd_m2: xyz,
            rgb_cd_m2: self.space.from_xyz(xyz),
            luminance_cd_m2: xyz[1],
            monte_carlo: self.monte_carlo(direction, limit_m, control)?,
            polarisation: self.polarisation(direction, ray.distance_m),
        })
    }

    /// Radiance along a ray up to a distance (or to the ground or space), and transmittance, in fog or by night.
    fn as_a_whole(
        &self,
        direction: DVec3,
        distance_m: Option<f64>,
    ) -> (Vec<f32>, Option<Vec<f32>>) {
        let mut through = vec![0.0; self.view.channel_count()];
        let mut path = through.clone();
        let length_m = distance_m.unwrap_or(f64::INFINITY);
        self.view.path(direction, length_m, &mut through, &mut path);
        let values = match distance_m {
            Some(_) => path,
            None => self.values(|view, out| view.radiance(&[direction], out)),
        };
        (values, (self.foggy || self.lit_by_night).then_some(through))
    }

    /// Polarisation of the light along a whole ray, if it is wanted and the solver computes it without noise.
    fn polarisation(
        &self,
        direction: DVec3,
        distance_m: Option<f64>,
    ) -> Option<PolarisationAnswer> {
        let wanted = self.polarised && distance_m.is_none() && self.paths.sampler().is_none();
        let light = wanted.then(|| self.view.polarised(direction)).flatten();
        light.map(PolarisationAnswer::from)
    }

    fn monte_carlo(
        &self,
        direction: DVec3,
        limit_m: Option<f64>,
        control: Control<'_>,
    ) -> Result<Option<MonteCarloAnswer>, Cancelled> {
        let (Some(sampler), Some(grid)) = (self.paths.sampler(), self.paths.grid()) else {
            return Ok(None);
        };
        Ok(Some(match self.polarised {
            true => {
                let found = sampler.polarised_estimate_with(direction, limit_m, control)?;
                MonteCarloAnswer::polarised(found, grid)
            }
            false => {
                let found = sampler.estimate_with(direction, limit_m, control)?;
                MonteCarloAnswer::new(found, grid)
            }
        }))
    }
}

fn observer(scene: &ResolvedScene) -> ObserverAnswer {
    let place = scene.sun.place();
    ObserverAnswer {
        latitude_deg: place.map(|place| place.latitude_deg),
        longitude_deg: place.map(|place| place.longitude_deg),
        altitude_m: scene.observer_altitude_m,
        ground_altitude_m: scene.atmosphere.planet.ground_altitude_m,
        time_utc: scene.sun.start().map(|time| time.utc().to_string()),
    }
}
