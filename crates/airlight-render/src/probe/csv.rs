//! Result of a probe as CSV: a line for each ray and wavelength; for a model without spectra, a line for each ray.

use super::{PolarisationAnswer, ProbeAnswer, RayAnswer};
use std::fmt::Write;

/// Names of the first columns.
const HEADER: &str = "view,azimuth_deg,elevation_deg,distance_m,meets_ground,sun_angle_deg,wavelength_nm,\
    radiance_w_m2_sr_nm,radiance_single_w_m2_sr_nm,radiance_multiple_w_m2_sr_nm,radiance_ground_w_m2_sr_nm,transmittance,\
    luminance_cd_m2,x_cd_m2,y_cd_m2,z_cd_m2,red_cd_m2,green_cd_m2,blue_cd_m2,\
    sun_azimuth_deg,sun_elevation_deg,sun_irradiance_outside_w_m2_nm,sun_irradiance_normal_w_m2_nm,\
    sun_irradiance_horizontal_w_m2_nm,sky_irradiance_horizontal_w_m2_nm,sun_illuminance_normal_lx,\
    sun_illuminance_horizontal_lx,sky_illuminance_horizontal_lx,\
    direction_east,direction_up,direction_south,sun_direction_east,sun_direction_up,sun_direction_south,\
    sun_red_normal_lx,sun_green_normal_lx,sun_blue_normal_lx,sky_red_horizontal_lx,sky_green_horizontal_lx,sky_blue_horizontal_lx";
/// Additional columns for Monte Carlo.
const MONTE_CARLO_HEADER: &str =
    ",monte_carlo_radiance_w_m2_sr_nm,monte_carlo_standard_error_w_m2_sr_nm";
/// Additional columns for polarisation.
const POLARISATION_HEADER: &str = ",stokes_i_w_m2_sr_nm,stokes_q_w_m2_sr_nm,stokes_u_w_m2_sr_nm,degree_of_polarisation,\
    degree_standard_error,angle_of_polarisation_deg,angle_standard_error_deg";
/// Last columns.
const MODEL_HEADER: &str = ",solver,variant";

impl ProbeAnswer {
    /// The result as CSV with a header: a self-contained line for each ray and wavelength, or for each ray if the model has no
    /// spectra.
    pub fn to_csv(&self) -> String {
        let mut text = HEADER.to_owned();
        if self.views.iter().any(|view| view.monte_carlo.is_some()) {
            text.push_str(MONTE_CARLO_HEADER);
        }
        let polarised = self.views.iter().any(|view| view.polarisation().is_some());
        if polarised {
            text.push_str(POLARISATION_HEADER);
        }
        text.push_str(MODEL_HEADER);
        text.push('\n');
        let variant = self.variant.as_deref().unwrap_or_default();
        for (number, view) in (1..).zip(&self.views) {
            for lane in 0..self.wavelengths_nm.len().max(1) {
                line(&mut text, self, number, view, lane);
                if polarised {
                    polarisation(&mut text, view, lane);
                }
                // Writing to a string cannot fail.
                let _ = writeln!(text, ",{},{variant}", self.solver);
            }
        }
        text
    }
}

/// The value at a wavelength; empty if there is none.
fn at<T: ToString>(values: &[T], lane: usize) -> String {
    values.get(lane).map_or(String::new(), T::to_string)
}

fn line(text: &mut String, answer: &ProbeAnswer, number: usize, view: &RayAnswer, lane: usize) {
    let (sun, sky) = (&answer.sun, &answer.sky);
    let distance = view.distance_m.map_or(String::new(), |m| m.to_string());
    let part = |values: &Option<Vec<f32>>| at(values.as_deref().unwrap_or_default(), lane);
    let [x, y, z] = view.xyz_cd_m2;
    let [r, g, b] = view.rgb_cd_m2;
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "{number},{},{},{distance},{},{},{},",
        view.azimuth_deg,
        view.elevation_deg,
        view.meets_ground,
        view.sun_angle_deg,
        at(&answer.wavelengths_nm, lane)
    );
    let _ = write!(
        text,
        "{},{},{},{},{},{},{x},{y},{z},{r},{g},{b},",
        at(&view.radiance_w_m2_sr_nm, lane),
        part(&view.radiance_single_w_m2_sr_nm),
        part(&view.radiance_multiple_w_m2_sr_nm),
        part(&view.radiance_ground_w_m2_sr_nm),
        part(&view.transmittance),
        view.luminance_cd_m2
    );
    let _ = write!(
        text,
        "{},{},{},{},{},{},{},{},{}",
        sun.azimuth_deg,
        sun.elevation_deg,
        at(&sun.irradiance_outside_w_m2_nm, lane),
        at(&sun.irradiance_normal_w_m2_nm, lane),
        at(&sun.irradiance_horizontal_w_m2_nm, lane),
        at(&sky.irradiance_horizontal_w_m2_nm, lane),
        sun.illuminance_normal_lx,
        sun.illuminance_horizontal_lx,
        sky.illuminance_horizontal_lx
    );
    for values in [
        view.direction,
        sun.direction,
        sun.rgb_normal_lx,
        sky.rgb_horizontal_lx,
    ] {
        let _ = values.iter().try_for_each(|value| write!(text, ",{value}"));
    }
    if let Some(found) = &view.monte_carlo {
        let _ = write!(
            text,
            ",{},{}",
            found.radiance_w_m2_sr_nm[lane], found.standard_error_w_m2_sr_nm[lane]
        );
    }
}

/// The columns of polarisation, empty where it is not known.
fn polarisation(text: &mut String, view: &RayAnswer, lane: usize) {
    let nothing = PolarisationAnswer::default();
    let found = view.polarisation().unwrap_or(&nothing);
    for values in [
        &found.stokes_i_w_m2_sr_nm,
        &found.stokes_q_w_m2_sr_nm,
        &found.stokes_u_w_m2_sr_nm,
        &found.degree,
        &found.degree_standard_error,
        &found.angle_deg,
        &found.angle_standard_error_deg,
    ] {
        // Writing to a string cannot fail.
        let _ = write!(text, ",{}", at(values, lane));
    }
}
