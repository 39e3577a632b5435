//! Monte Carlo estimates along a ray, with standard errors.

use airlight::monte_carlo::{Estimate, PolarisedEstimate};
use airlight::sky::PolarisedLight;
use airlight::spectrum::WavelengthGrid;
use serde::Serialize;

/// Monte Carlo estimate of the light along one direction.
#[derive(Clone, Debug, Serialize)]
pub struct MonteCarloAnswer {
    /// Number of paths.
    pub paths: u64,
    /// Total radiance.
    pub radiance_w_m2_sr_nm: Vec<f64>,
    /// Its standard error.
    pub standard_error_w_m2_sr_nm: Vec<f64>,
    /// Radiance of light scattered or reflected once, twice, three times, four times and more often.
    pub radiance_by_order_w_m2_sr_nm: Vec<Vec<f64>>,
    /// CIE 1931 XYZ.
    pub xyz_cd_m2: [f64; 3],
    /// Polarisation; `None` unless it is traced.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<PolarisationAnswer>,
}

/// Polarised light along one direction. `Q` is positive for polarisation in the vertical plane through the ray, from which
/// angles are measured anticlockwise as seen by the eye.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PolarisationAnswer {
    /// Stokes parameter `I`, the radiance.
    pub stokes_i_w_m2_sr_nm: Vec<f64>,
    /// Stokes parameter `Q`.
    pub stokes_q_w_m2_sr_nm: Vec<f64>,
    /// Stokes parameter `U`.
    pub stokes_u_w_m2_sr_nm: Vec<f64>,
    /// Standard error of `I`; empty without noise, as the others.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub standard_error_i_w_m2_sr_nm: Vec<f64>,
    /// Standard error of `Q`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub standard_error_q_w_m2_sr_nm: Vec<f64>,
    /// Standard error of `U`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub standard_error_u_w_m2_sr_nm: Vec<f64>,
    /// Degree of linear polarisation, 0 to 1.
    pub degree: Vec<f64>,
    /// Its standard error.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub degree_standard_error: Vec<f64>,
    /// Angle of the plane of polarisation, degrees.
    pub angle_deg: Vec<f64>,
    /// Its standard error.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub angle_standard_error_deg: Vec<f64>,
}

impl From<PolarisedLight> for PolarisationAnswer {
    fn from(light: PolarisedLight) -> Self {
        let double = |values: &[f32]| values.iter().copied().map(f64::from).collect();
        Self {
            degree: double(&light.degree()),
            angle_deg: double(&light.angle_deg()),
            stokes_i_w_m2_sr_nm: double(&light.intensity),
            stokes_q_w_m2_sr_nm: double(&light.q),
            stokes_u_w_m2_sr_nm: double(&light.u),
            ..Self::default()
        }
    }
}

impl MonteCarloAnswer {
    /// Converts an estimate at the wavelengths of a grid.
    pub fn new(found: Estimate, grid: &WavelengthGrid) -> Self {
        let single: Vec<f32> = found.mean.iter().map(|&v| v as f32).collect();
        Self {
            paths: found.paths,
            xyz_cd_m2: grid.to_xyz(&single),
            radiance_w_m2_sr_nm: found.mean,
            standard_error_w_m2_sr_nm: found.standard_error,
            radiance_by_order_w_m2_sr_nm: found
                .orders
                .into_iter()
                .map(|order| order.mean)
                .collect(),
            polarisation: None,
        }
    }

    /// Converts an estimate with polarisation.
    pub fn polarised(found: PolarisedEstimate, grid: &WavelengthGrid) -> Self {
        let radiance = found.clone().radiance();
        Self {
            polarisation: Some(PolarisationAnswer {
                stokes_i_w_m2_sr_nm: found.intensity.mean,
                stokes_q_w_m2_sr_nm: found.q.mean,
                stokes_u_w_m2_sr_nm: found.u.mean,
                standard_error_i_w_m2_sr_nm: found.intensity.standard_error,
                standard_error_q_w_m2_sr_nm: found.q.standard_error,
                standard_error_u_w_m2_sr_nm: found.u.standard_error,
                degree: found.degree.mean,
                degree_standard_error: found.degree.standard_error,
                angle_deg: found.angle_deg.mean,
                angle_standard_error_deg: found.angle_deg.standard_error,
            }),
            ..Self::new(radiance, grid)
        }
    }
}
