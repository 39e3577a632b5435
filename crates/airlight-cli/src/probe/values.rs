//! What a probe tells: the format `airlight-probe/1`, described in docs/src/probe.md.

use super::views::AskedView;
use crate::args::ProbeArgs;
use crate::scene::{Scene, Sun};
use crate::sky::{SOFTWARE, space_name, space_of};
use airlight::axes;
use airlight::monte_carlo::{MonteCarlo, ORDERS};
use airlight::sky::{LineOfSight, Sky, TableChannels, View};
use airlight::spectrum::RgbSpace;
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

/// Name and version of the format.
pub const FORMAT: &str = "airlight-probe/1";

/// The whole answer.
#[derive(Debug, Serialize)]
pub struct Answer {
    /// Name and version of the format.
    pub format: &'static str,
    /// Program and version.
    pub program: &'static str,
    /// Name of the atmosphere; none where a published model has its own.
    pub atmosphere: Option<String>,
    /// `all` or `single`; none where a published model has neither.
    pub scattering: Option<&'static str>,
    /// How light was solved for.
    pub solver: String,
    /// Whether that is a published model.
    #[serde(skip)]
    pub is_of_model: bool,
    /// Which form of it, where it has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// The RGB space.
    pub color_space: &'static str,
    /// Wavelengths of every list.
    pub wavelengths_nm: Vec<f64>,
    /// Where and when.
    pub observer: Observer,
    /// The sun and its light.
    pub sun: SunLight,
    /// The sky's light.
    pub sky: SkyLight,
    /// Each direction.
    pub views: Vec<ViewLight>,
}

/// Where and when.
#[derive(Debug, Serialize)]
pub struct Observer {
    /// Degrees north, where a place was given.
    pub latitude_deg: Option<f64>,
    /// Degrees east.
    pub longitude_deg: Option<f64>,
    /// Altitude of the eye above sea level.
    pub altitude_m: f64,
    /// Altitude of the ground.
    pub ground_altitude_m: f64,
    /// When, in UTC.
    pub time_utc: Option<String>,
}

/// The sun and its light.
#[derive(Debug, Serialize)]
pub struct SunLight {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal, as seen.
    pub elevation_deg: f64,
    /// The same without refraction.
    pub geometric_elevation_deg: Option<f64>,
    /// Distance over the planet's mean distance.
    pub distance_ratio: f64,
    /// Half the angle across the disc.
    pub angular_radius_deg: f64,
    /// Irradiance outside the air on a surface that faces the sun.
    pub irradiance_outside_w_m2_nm: Vec<f32>,
    /// Irradiance at the eye on a surface that faces the sun.
    pub irradiance_normal_w_m2_nm: Vec<f32>,
    /// Irradiance at the eye on the horizontal.
    pub irradiance_horizontal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on a surface that faces the sun.
    pub illuminance_normal_lx: f64,
    /// Illuminance at the eye on the horizontal.
    pub illuminance_horizontal_lx: f64,
}

/// The sky's light, the sun's disc left out.
#[derive(Debug, Serialize)]
pub struct SkyLight {
    /// Irradiance at the eye on the horizontal.
    pub irradiance_horizontal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on the horizontal.
    pub illuminance_horizontal_lx: f64,
}

/// The light along one direction, the sun's disc left out.
#[derive(Debug, Serialize)]
pub struct ViewLight {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal.
    pub elevation_deg: f64,
    /// How far was looked; nothing: to the ground or to space.
    pub distance_m: Option<f64>,
    /// Whether the line ends on the ground.
    pub meets_ground: bool,
    /// Angle from the sun's centre.
    pub sun_angle_deg: f64,
    /// All that arrives.
    pub radiance_w_m2_sr_nm: Vec<f32>,
    /// Of it, light scattered once on the way. The parts are none where a published model does not tell them.
    pub radiance_single_w_m2_sr_nm: Option<Vec<f32>>,
    /// Light scattered or reflected more than once.
    pub radiance_multiple_w_m2_sr_nm: Option<Vec<f32>>,
    /// Light of the ground.
    pub radiance_ground_w_m2_sr_nm: Option<Vec<f32>>,
    /// Transmittance to the end of the line.
    pub transmittance: Option<Vec<f32>>,
    /// CIE 1931 XYZ.
    pub xyz_cd_m2: [f64; 3],
    /// Linear red, green and blue.
    pub rgb_cd_m2: [f64; 3],
    /// Luminance: Y.
    pub luminance_cd_m2: f64,
    /// The same light by random paths, where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<PathsLight>,
}

/// The light along one direction by random paths.
#[derive(Debug, Serialize)]
pub struct PathsLight {
    /// Number of paths.
    pub paths: u64,
    /// All that arrives.
    pub radiance_w_m2_sr_nm: Vec<f64>,
    /// Standard error of it.
    pub standard_error_w_m2_sr_nm: Vec<f64>,
    /// Of it, light scattered or reflected once, twice, three and four times, and more often.
    pub radiance_by_order_w_m2_sr_nm: [Vec<f64>; ORDERS],
    /// CIE 1931 XYZ.
    pub xyz_cd_m2: [f64; 3],
    /// With its polarisation, where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<PolarisedLight>,
}

/// Polarised light along one direction by random paths. `Q` is positive in the vertical plane through the line of sight; angles
/// are from there, anticlockwise as the eye sees it.
#[derive(Debug, Serialize)]
pub struct PolarisedLight {
    /// Radiance, the first Stokes parameter.
    pub stokes_i_w_m2_sr_nm: Vec<f64>,
    /// Second.
    pub stokes_q_w_m2_sr_nm: Vec<f64>,
    /// Third.
    pub stokes_u_w_m2_sr_nm: Vec<f64>,
    /// Standard error of the first.
    pub standard_error_i_w_m2_sr_nm: Vec<f64>,
    /// Standard error of the second.
    pub standard_error_q_w_m2_sr_nm: Vec<f64>,
    /// Standard error of the third.
    pub standard_error_u_w_m2_sr_nm: Vec<f64>,
    /// Degree of linear polarisation.
    pub degree: Vec<f64>,
    /// Standard error of it.
    pub degree_standard_error: Vec<f64>,
    /// Angle of the plane of polarisation.
    pub angle_deg: Vec<f64>,
    /// Standard error of it.
    pub angle_standard_error_deg: Vec<f64>,
}

impl Answer {
    /// Computes all of it; by random paths too, where there is a Monte Carlo.
    pub fn new(
        args: &ProbeArgs,
        scene: &Scene,
        (sky, paths): (&Sky, Option<&MonteCarlo>),
        sun: &Sun,
        views: &[AskedView],
    ) -> Self {
        let view = scene.view(sky, sun);
        let space = space_of(args.color_space);
        Self {
            format: FORMAT,
            program: SOFTWARE,
            atmosphere: Some(scene.atmosphere.name.clone()),
            scattering: Some(scene.scattering_name()),
            solver: args.air.solver.name(),
            is_of_model: false,
            variant: None,
            color_space: space_name(space),
            wavelengths_nm: sky.grid().wavelengths_nm().to_vec(),
            observer: Observer::of(scene),
            sun: sun_light(&view, sun),
            sky: sky_light(&view),
            views: views
                .par_iter()
                .map(|asked| {
                    let light = view_light(&view, asked, space);
                    let eye_m = scene.eye_altitude_m;
                    let polarised = args.polarisation;
                    let found =
                        paths.map(|paths| paths_light(&view, paths, eye_m, &light, polarised));
                    ViewLight {
                        monte_carlo: found,
                        ..light
                    }
                })
                .collect(),
        }
    }
}

impl Observer {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let place = scene.sun.place();
        Self {
            latitude_deg: place.map(|place| place.latitude_deg),
            longitude_deg: place.map(|place| place.longitude_deg),
            altitude_m: scene.eye_altitude_m,
            ground_altitude_m: scene.atmosphere.planet.ground_altitude_m,
            time_utc: scene.sun.start().map(|time| time.utc().to_string()),
        }
    }
}

fn sun_light(view: &View, sun: &Sun) -> SunLight {
    let normal = view.sun_irradiance();
    let cosine = view.sun().y.max(0.0);
    let illuminance = view.sky().grid().to_xyz(&normal)[1];
    SunLight {
        azimuth_deg: sun.azimuth_deg,
        elevation_deg: sun.elevation_deg,
        geometric_elevation_deg: sun.geometric_elevation_deg,
        distance_ratio: sun.distance_ratio,
        angular_radius_deg: view.disc().angular_radius_rad.to_degrees(),
        irradiance_outside_w_m2_nm: view.solar_irradiance(),
        irradiance_horizontal_w_m2_nm: normal.iter().map(|e| e * cosine as f32).collect(),
        irradiance_normal_w_m2_nm: normal,
        illuminance_normal_lx: illuminance,
        illuminance_horizontal_lx: illuminance * cosine,
    }
}

fn sky_light(view: &View) -> SkyLight {
    let irradiance = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
    SkyLight {
        illuminance_horizontal_lx: view.sky().grid().to_xyz(&irradiance)[1],
        irradiance_horizontal_w_m2_nm: irradiance,
    }
}

fn view_light(view: &View, asked: &AskedView, space: RgbSpace) -> ViewLight {
    let direction = axes::direction(asked.azimuth_deg, asked.elevation_deg);
    let line: LineOfSight = view.along(direction, asked.distance_m);
    let radiance = line.radiance();
    let xyz = view.sky().grid().to_xyz(&radiance);
    ViewLight {
        azimuth_deg: asked.azimuth_deg,
        elevation_deg: asked.elevation_deg,
        distance_m: asked.distance_m,
        meets_ground: line.meets_ground,
        sun_angle_deg: direction.angle_between(view.sun()).to_degrees(),
        radiance_w_m2_sr_nm: radiance,
        radiance_single_w_m2_sr_nm: Some(line.single),
        radiance_multiple_w_m2_sr_nm: Some(line.multiple),
        radiance_ground_w_m2_sr_nm: Some(line.ground),
        transmittance: Some(line.transmittance),
        xyz_cd_m2: xyz,
        rgb_cd_m2: space.from_xyz(xyz),
        luminance_cd_m2: xyz[1],
        monte_carlo: None,
    }
}

fn paths_light(
    view: &View,
    paths: &MonteCarlo,
    eye_altitude_m: f64,
    light: &ViewLight,
    polarised: bool,
) -> PathsLight {
    let direction = axes::direction(light.azimuth_deg, light.elevation_deg);
    let sun = view.sun();
    // Where the line ends on the ground, that is seen.
    let distance_m = light.distance_m.filter(|_| !light.meets_ground);
    let (found, polarised) = match (polarised, distance_m) {
        (true, _) => {
            let found = paths.polarised(eye_altitude_m, sun, direction, distance_m);
            (found.scalar.clone(), Some(found))
        }
        (false, Some(distance_m)) => {
            let found = paths.path_radiance(eye_altitude_m, sun, direction, distance_m);
            (found, None)
        }
        (false, None) => (paths.radiance(eye_altitude_m, sun, direction), None),
    };
    // The Monte Carlo's sun is at its mean distance.
    let solar = view.solar_irradiance();
    let nearness = f64::from(solar[0]) / paths.grid().solar_irradiance()[0];
    let scaled = |values: &[f64]| values.iter().map(|v| nearness * v).collect::<Vec<f64>>();
    let radiance = scaled(&found.mean);
    let single: Vec<f32> = radiance.iter().map(|&v| v as f32).collect();
    PathsLight {
        paths: found.paths,
        standard_error_w_m2_sr_nm: scaled(&found.standard_error),
        radiance_by_order_w_m2_sr_nm: found.orders.map(|order| scaled(&order.mean)),
        xyz_cd_m2: paths.grid().to_xyz(&single),
        radiance_w_m2_sr_nm: radiance,
        polarisation: polarised.map(|found| PolarisedLight {
            stokes_i_w_m2_sr_nm: scaled(&found.intensity.mean),
            stokes_q_w_m2_sr_nm: scaled(&found.q.mean),
            stokes_u_w_m2_sr_nm: scaled(&found.u.mean),
            standard_error_i_w_m2_sr_nm: scaled(&found.intensity.standard_error),
            standard_error_q_w_m2_sr_nm: scaled(&found.q.standard_error),
            standard_error_u_w_m2_sr_nm: scaled(&found.u.standard_error),
            degree: found.degree.mean,
            degree_standard_error: found.degree.standard_error,
            angle_deg: found.angle_deg.mean,
            angle_standard_error_deg: found.angle_deg.standard_error,
        }),
    }
}
