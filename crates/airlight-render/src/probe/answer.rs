//! [`ProbeAnswer`]: result of a probe in the format `airlight-probe/1`, described in docs/src/probe.md.

use super::{MonteCarloAnswer, PolarisationAnswer};
use serde::Serialize;

/// Name and version of the format.
pub const PROBE_FORMAT: &str = "airlight-probe/1";

/// Result of a probe. Lists have one value for each of `wavelengths_nm`; they are empty for a model without spectra.
#[derive(Clone, Debug, Serialize)]
pub struct ProbeAnswer {
    /// Name and version of the format.
    pub format: &'static str,
    /// Program and version.
    pub program: &'static str,
    /// Name of the atmosphere; `None` for a model with its own.
    pub atmosphere: Option<String>,
    /// Orders of scattering, `all` or `single`; `None` for a model without this input.
    pub scattering: Option<&'static str>,
    /// Name of the solver or published model.
    pub solver: &'static str,
    /// Variant of the model; `None` for a model without variants.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// Name of the RGB space.
    pub color_space: &'static str,
    /// Wavelengths of all lists.
    pub wavelengths_nm: Vec<f64>,
    /// Place and time.
    pub observer: ObserverAnswer,
    /// The sun and its light.
    pub sun: SunAnswer,
    /// The moon and its light; `None` by day and without a moon.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moon: Option<MoonAnswer>,
    /// Light of the sky without the discs of sun and moon and without single stars.
    pub sky: SkyAnswer,
    /// Light along each direction.
    pub views: Vec<RayAnswer>,
}

/// Place and time.
#[derive(Clone, Debug, Serialize)]
pub struct ObserverAnswer {
    /// Latitude, degrees north; `None` without a place.
    pub latitude_deg: Option<f64>,
    /// Longitude, degrees east.
    pub longitude_deg: Option<f64>,
    /// Altitude of the eye above sea level.
    pub altitude_m: f64,
    /// Altitude of the ground.
    pub ground_altitude_m: f64,
    /// Time in UTC; `None` for a fixed sun.
    pub time_utc: Option<String>,
}

/// The sun and its light.
#[derive(Clone, Debug, Serialize)]
pub struct SunAnswer {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Apparent elevation above the horizontal, degrees.
    pub elevation_deg: f64,
    /// Unit vector towards its centre: east, up, south.
    pub direction: [f64; 3],
    /// Elevation without refraction, degrees; `None` for a fixed sun.
    pub geometric_elevation_deg: Option<f64>,
    /// Distance relative to the planet's mean distance.
    pub distance_ratio: f64,
    /// Angular radius of the disc.
    pub angular_radius_deg: f64,
    /// Irradiance outside the air on a surface that faces the sun.
    pub irradiance_outside_w_m2_nm: Vec<f32>,
    /// Irradiance at the eye on a surface that faces the sun.
    pub irradiance_normal_w_m2_nm: Vec<f32>,
    /// Irradiance at the eye on a horizontal surface.
    pub irradiance_horizontal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on a surface that faces the sun.
    pub illuminance_normal_lx: f64,
    /// Illuminance at the eye on a horizontal surface.
    pub illuminance_horizontal_lx: f64,
    /// Red, green and blue at the eye on a surface that faces the sun: 1, 1, 1 is 1 lx of the white of the space.
    pub rgb_normal_lx: [f64; 3],
}

/// The moon and its light.
#[derive(Clone, Debug, Serialize)]
pub struct MoonAnswer {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Apparent elevation above the horizontal, degrees.
    pub elevation_deg: f64,
    /// Angle at the moon between sun and eye, degrees: 0 is full.
    pub phase_angle_deg: f64,
    /// Part of the disc that is lit.
    pub lit_fraction: f64,
    /// Angular radius of the disc.
    pub angular_radius_deg: f64,
    /// Irradiance at the eye on a surface that faces the moon.
    pub irradiance_normal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on a surface that faces the moon.
    pub illuminance_normal_lx: f64,
    /// Illuminance at the eye on a horizontal surface.
    pub illuminance_horizontal_lx: f64,
}

/// Light of the sky, without discs.
#[derive(Clone, Debug, Serialize)]
pub struct SkyAnswer {
    /// Irradiance at the eye on a horizontal surface.
    pub irradiance_horizontal_w_m2_nm: Vec<f32>,
    /// Illuminance at the eye on a horizontal surface.
    pub illuminance_horizontal_lx: f64,
    /// Red, green and blue at the eye on a horizontal surface.
    pub rgb_horizontal_lx: [f64; 3],
}

/// Light along one direction, without the sun's disc. Parts are `None` for models that do not separate them.
#[derive(Clone, Debug, Serialize)]
pub struct RayAnswer {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Elevation, degrees above the horizontal.
    pub elevation_deg: f64,
    /// Unit vector away from the eye: east, up, south.
    pub direction: [f64; 3],
    /// Length of the ray; `None`: to the ground or to space.
    pub distance_m: Option<f64>,
    /// Whether the ray ends on the ground.
    pub meets_ground: bool,
    /// Angle from the sun's centre, degrees.
    pub sun_angle_deg: f64,
    /// Total radiance.
    pub radiance_w_m2_sr_nm: Vec<f32>,
    /// Radiance of single scattering.
    pub radiance_single_w_m2_sr_nm: Option<Vec<f32>>,
    /// Radiance of light scattered or reflected more than once.
    pub radiance_multiple_w_m2_sr_nm: Option<Vec<f32>>,
    /// Radiance of the ground.
    pub radiance_ground_w_m2_sr_nm: Option<Vec<f32>>,
    /// Transmittance to the end of the ray.
    pub transmittance: Option<Vec<f32>>,
    /// CIE 1931 XYZ of the total radiance.
    pub xyz_cd_m2: [f64; 3],
    /// Linear red, green and blue of the total radiance.
    pub rgb_cd_m2: [f64; 3],
    /// Luminance, equal to Y.
    pub luminance_cd_m2: f64,
    /// Monte Carlo estimate; `None` for other solvers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<MonteCarloAnswer>,
    /// The same light with its polarisation, if that was wanted and the solver is not Monte Carlo; only of whole rays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<PolarisationAnswer>,
}

impl RayAnswer {
    /// The polarisation of the light, by whichever solver.
    pub fn polarisation(&self) -> Option<&PolarisationAnswer> {
        let found = self.monte_carlo.as_ref();
        found
            .and_then(|found| found.polarisation.as_ref())
            .or(self.polarisation.as_ref())
    }
}
