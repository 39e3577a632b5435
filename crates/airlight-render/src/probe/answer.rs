//! What a probe says: the format `airlight-probe/1`, described in docs/src/probe.md.

use super::MonteCarloAnswer;
use serde::Serialize;

/// Name and version of the format.
pub const PROBE_FORMAT: &str = "airlight-probe/1";

/// The whole answer. Lists have one value for each of `wavelengths_nm`; those of a model without spectra are empty.
#[derive(Clone, Debug, Serialize)]
pub struct ProbeAnswer {
    /// Name and version of the format.
    pub format: &'static str,
    /// Program and version.
    pub program: &'static str,
    /// Name of the atmosphere; `None` for a model with its own.
    pub atmosphere: Option<String>,
    /// `all` or `single` orders of scattering; `None` for a model without the choice.
    pub scattering: Option<&'static str>,
    /// Name of the solver or published model.
    pub solver: &'static str,
    /// Its form, where it has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// The RGB space.
    pub color_space: &'static str,
    /// Wavelengths of every list.
    pub wavelengths_nm: Vec<f64>,
    /// Place and time.
    pub observer: ObserverAnswer,
    /// The sun and its light.
    pub sun: SunAnswer,
    /// Light of the sky.
    pub sky: SkyAnswer,
    /// Each direction.
    pub views: Vec<RayAnswer>,
}

/// Place and time.
#[derive(Clone, Debug, Serialize)]
pub struct ObserverAnswer {
    /// Degrees north, where the scene has a place.
    pub latitude_deg: Option<f64>,
    /// Degrees east.
    pub longitude_deg: Option<f64>,
    /// Altitude of the eye above sea level.
    pub altitude_m: f64,
    /// Altitude of the ground.
    pub ground_altitude_m: f64,
    /// Time in UTC.
    pub time_utc: Option<String>,
}

/// The sun and its light.
#[derive(Clone, Debug, Serialize)]
pub struct SunAnswer {
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

/// Light of the sky, without the sun's disc.
#[derive(Clone, Debug, Serialize)]
pub struct SkyAnswer {
    /// Irradiance at the eye on the horizontal.
    pub irradiance_horizontal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on the horizontal.
    pub illuminance_horizontal_lx: f64,
}

/// Light along one direction, without the sun's disc. Parts are `None` for models that do not know them.
#[derive(Clone, Debug, Serialize)]
pub struct RayAnswer {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal.
    pub elevation_deg: f64,
    /// Length of the ray; `None`: to the ground or to space.
    pub distance_m: Option<f64>,
    /// Whether it ends on the ground.
    pub meets_ground: bool,
    /// Angle from the sun's centre.
    pub sun_angle_deg: f64,
    /// All light that arrives.
    pub radiance_w_m2_sr_nm: Vec<f32>,
    /// Of it, light scattered once on the way.
    pub radiance_single_w_m2_sr_nm: Option<Vec<f32>>,
    /// Light scattered or reflected more than once.
    pub radiance_multiple_w_m2_sr_nm: Option<Vec<f32>>,
    /// Light of the ground.
    pub radiance_ground_w_m2_sr_nm: Option<Vec<f32>>,
    /// Transmittance to the end of the ray.
    pub transmittance: Option<Vec<f32>>,
    /// CIE 1931 XYZ.
    pub xyz_cd_m2: [f64; 3],
    /// Linear red, green and blue.
    pub rgb_cd_m2: [f64; 3],
    /// Luminance: Y.
    pub luminance_cd_m2: f64,
    /// The same light by Monte Carlo, with that solver.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarloAnswer>,
}
