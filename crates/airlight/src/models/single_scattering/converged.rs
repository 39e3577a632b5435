//! The article's integrals with converged quadrature and the planet's shadow, and the article's two further improvements.

use super::constants as c;
use super::nodes::{self, Columns};
use super::printed::smoothstep;
use super::settings::{Settings, Variant};
use crate::atmosphere::presets::published;
use crate::control::Control;
use crate::math::quadrature::{GaussRule, RunningRule};
use crate::models::lut::{
    AirLanes, MultipleScatteringSettings, MultipleScatteringTable, TransmittanceTable,
};
use crate::optics::PhaseFunction;
use crate::transfer::ray::{AirSegment, Ray, in_shadow};
use glam::DVec3;
use std::f64::consts::PI;

/// Number of nodes on each segment of the view ray.
pub const VIEW_NODES: usize = 12;
/// Number of nodes on each ray to the sun.
pub const SUN_NODES: usize = 10;
/// Zenith angles and altitudes of the transmittance table.
pub const TABLE_SIZE: [usize; 2] = [256, 64];
/// Wavelengths of red, green and blue in the article's preset.
const CHANNELS_NM: [f64; 3] = [680.0, 550.0, 440.0];

/// The article's sky with converged quadrature.
pub struct Converged {
    eye_altitude_m: f64,
    view_rule: RunningRule,
    sun_rule: GaussRule,
    /// Illuminances outside the atmosphere, on a surface that faces the sun.
    illuminance: [f64; 3],
    transmittance: Option<TransmittanceTable>,
    multiple: Option<MultipleScatteringTable>,
}

impl Converged {
    /// Prepares the tables of the variant.
    pub fn new(variant: Variant, settings: &Settings) -> Self {
        Self::with_nodes(variant, settings, (VIEW_NODES, SUN_NODES))
    }

    /// As [`Self::new`], with other numbers of nodes on the view ray and on rays to the sun.
    pub fn with_nodes(variant: Variant, settings: &Settings, nodes: (usize, usize)) -> Self {
        let rules = (RunningRule::new(nodes.0), GaussRule::new(nodes.1));
        let transmittance = matches!(variant, Variant::Table | Variant::Multiple).then(|| {
            TransmittanceTable::new(
                (c::PLANET_RADIUS_M, c::TOP_RADIUS_M),
                TABLE_SIZE,
                3,
                |radius_m, mu, out| {
                    let depths = optical_depths(nodes::columns_to_space(&rules.1, radius_m, mu));
                    for (out, depth) in out.iter_mut().zip(depths) {
                        *out = depth as f32;
                    }
                },
            )
        });
        let multiple = match (&transmittance, variant) {
            (Some(table), Variant::Multiple) => {
                let air = AirLanes::new(&published::sky_article(), &CHANNELS_NM);
                let settings = MultipleScatteringSettings::default();
                let table =
                    MultipleScatteringTable::new(&air, table, &settings, Control::default());
                Some(table.expect("nothing cancels it"))
            }
            _ => None,
        };
        Self {
            eye_altitude_m: settings.eye_altitude_m,
            view_rule: rules.0,
            sun_rule: rules.1,
            illuminance: settings.sunlight.illuminance_outside(),
            transmittance,
            multiple,
        }
    }

    /// Luminances scattered into a direction.
    pub fn luminance(&self, direction: DVec3, sun: DVec3) -> [f64; 3] {
        let ray = self.ray(direction, sun);
        let end_m = in_air(&ray).map_or(0.0, |segment| segment.end_m);
        let rayleigh = rayleigh_phase(ray.nu);
        let mie = PhaseFunction::HenyeyGreenstein { g: c::MIE_G }.evaluate(ray.nu, 550.0);
        let mut sum = [0.0; 3];
        nodes::march(&self.view_rule, &ray, end_m, |node| {
            let way = optical_depths(node.columns).map(|tau| (-tau).exp());
            let sunlight = self.transmittance_to_sun(&node.here);
            let mut psi = [0.0f32; 3];
            if let Some(table) = &self.multiple {
                table.look_up(node.here.radius_m, node.here.mu_sun, &mut psi);
            }
            let scatters = c::MIE_PER_MEGAMETRE * 1e-6 * node.densities[1];
            for i in 0..3 {
                let air = c::RAYLEIGH_PER_MEGAMETRE[i] * 1e-6 * node.densities[0];
                let once = sunlight[i] * (air * rayleigh + scatters * mie);
                let more = f64::from(psi[i]) * (air + scatters);
                sum[i] += node.dt * way[i] * (once + more);
            }
        });
        [0, 1, 2].map(|i| sum[i] * self.illuminance[i])
    }

    /// Luminances of the sun's disc, attenuated; black where the planet hides it.
    pub fn disc(&self, direction: DVec3, sun: DVec3) -> [f64; 3] {
        let radius = (0.5 * c::SUN_WIDTH_DEG).to_radians();
        let [inner, outer] = c::SUN_EDGE.map(|edge| radius * edge);
        let disc = 1.0 - smoothstep(inner, outer, direction.angle_between(sun));
        let ray = self.ray(direction, sun);
        let hidden = in_air(&ray).is_some_and(|segment| segment.meets_ground);
        if disc == 0.0 || hidden {
            return [0.0; 3];
        }
        let depths = optical_depths(nodes::columns_to_space(
            &self.sun_rule,
            ray.radius_m,
            ray.mu,
        ));
        let solid_angle = 2.0 * PI * (1.0 - radius.cos());
        [0, 1, 2].map(|i| disc * self.illuminance[i] / solid_angle * (-depths[i]).exp())
    }

    /// Transmittance to the sun from a point; 0 in the planet's shadow.
    fn transmittance_to_sun(&self, here: &Ray) -> [f64; 3] {
        if in_shadow(here.radius_m, here.mu_sun, c::PLANET_RADIUS_M) {
            return [0.0; 3];
        }
        match &self.transmittance {
            Some(table) => {
                let mut light = [0.0f32; 3];
                table.look_up(here.radius_m, here.mu_sun, &mut light);
                light.map(f64::from)
            }
            None => optical_depths(nodes::columns_to_space(
                &self.sun_rule,
                here.radius_m,
                here.mu_sun,
            ))
            .map(|tau| (-tau).exp()),
        }
    }

    fn ray(&self, direction: DVec3, sun: DVec3) -> Ray {
        let eye = DVec3::Y * (c::PLANET_RADIUS_M + self.eye_altitude_m);
        Ray::new(eye, direction, sun)
    }
}

/// Segment of a ray inside the atmosphere.
fn in_air(ray: &Ray) -> Option<AirSegment> {
    ray.segment_in_air(c::PLANET_RADIUS_M, c::TOP_RADIUS_M, f64::INFINITY)
}

/// Optical depths for columns of the two densities.
pub fn optical_depths([air, haze]: Columns) -> [f64; 3] {
    let haze = c::MIE_EXTINCTION * c::MIE_PER_MEGAMETRE * 1e-6 * haze;
    [0, 1, 2].map(|i| (c::RAYLEIGH_PER_MEGAMETRE[i] * 1e-6 + c::OZONE[i] * 0.06e-5) * air + haze)
}

fn rayleigh_phase(mu: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + mu * mu)
}
