//! What Monte Carlo says of a ray, with standard errors.

use airlight::monte_carlo::{Estimate, PolarisedEstimate};
use airlight::spectrum::WavelengthGrid;
use serde::Serialize;

/// Light along one direction by Monte Carlo.
#[derive(Clone, Debug, Serialize)]
pub struct MonteCarloAnswer {
    /// Number of paths.
    pub paths: u64,
    /// All light that arrives.
    pub radiance_w_m2_sr_nm: Vec<f64>,
    /// Its standard error.
    pub standard_error_w_m2_sr_nm: Vec<f64>,
    /// Of it, light scattered or reflected once, twice, three and four times, and more often.
    pub radiance_by_order_w_m2_sr_nm: Vec<Vec<f64>>,
    /// CIE 1931 XYZ.
    pub xyz_cd_m2: [f64; 3],
    /// Its polarisation, where that is followed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<PolarisationAnswer>,
}

/// Polarised light along one direction. `Q` is positive in the vertical plane through the ray; angles are from there,
/// anticlockwise as the eye sees it.
#[derive(Clone, Debug, Serialize)]
pub struct PolarisationAnswer {
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
    /// Its standard error.
    pub degree_standard_error: Vec<f64>,
    /// Angle of the plane of polarisation.
    pub angle_deg: Vec<f64>,
    /// Its standard error.
    pub angle_standard_error_deg: Vec<f64>,
}

impl MonteCarloAnswer {
    /// Of an estimate at the wavelengths of a grid.
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

    /// Of an estimate with polarisation.
    pub fn polarised(found: PolarisedEstimate, grid: &WavelengthGrid) -> Self {
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
            ..Self::new(found.scalar, grid)
        }
    }
}
