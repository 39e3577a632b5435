//! Light of a sky at the top of a fog, and its fraction that reaches the ground below.

use super::lane_channels::Converter;
use crate::control::{Cancelled, Control};
use crate::fog::{
    DirectionalLight, FogLanes, FogLighting, FogScattering, Ground, LayerLanes,
    effective_top_of_layers_m,
};
use crate::sky::View;
use crate::spectrum::Spectrum;
use std::f64::consts::PI;

/// A view of a solved sky, and the rest of the sky's light.
#[derive(Clone, Copy)]
pub(super) struct LitSky<'a> {
    pub view: &'a View,
    /// Mean radiance of the sky that does not come from the view's source, such as that of airglow, in the channels of the fog; empty
    /// for none.
    pub glow: &'a [f32],
}

impl<'a> From<&'a View> for LitSky<'a> {
    fn from(view: &'a View) -> Self {
        Self { view, glow: &[] }
    }
}

impl LitSky<'_> {
    /// Mean radiance of the glow in lanes, of which the first is a channel's index.
    pub fn glow_lanes<const N: usize>(&self, first: usize) -> Spectrum<N> {
        let Some(last) = self.glow.len().checked_sub(1) else {
            return Spectrum::ZERO;
        };
        Spectrum::from_fn(|lane| self.glow[(first + lane).min(last)].max(0.0))
    }
}

/// Light of a sky at the top of a fog, at all wavelengths of its grid.
pub(super) struct TopLight {
    /// Distance of the top from the planet's centre, m.
    radius_m: f64,
    /// Irradiance of the sun's disc on a surface that faces it, W m^-2 nm^-1.
    sun_irradiance: Vec<f32>,
    /// Mean radiance over all directions, W m^-2 sr^-1 nm^-1: the mean of sky and ground, each taken as the irradiance of a
    /// horizontal surface divided by pi.
    mean_radiance: Vec<f32>,
    /// Mean radiance of the sky, W m^-2 sr^-1 nm^-1: its irradiance of a horizontal surface divided by pi.
    sky_radiance: Vec<f32>,
}

impl TopLight {
    /// The light in a view from the fog's top.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn of(top: &View, control: Control<'_>) -> Result<Self, Cancelled> {
        control.check()?;
        let (down, up) = (top.downwelling_irradiance(), top.upwelling_irradiance());
        let mean = |(down, up): (&f32, &f32)| (0.5 * f64::from(down + up) / PI) as f32;
        Ok(Self {
            radius_m: top.radius_m(),
            sun_irradiance: top.sun_irradiance(),
            mean_radiance: down.iter().zip(&up).map(mean).collect(),
            sky_radiance: down.iter().map(|e| (f64::from(*e) / PI) as f32).collect(),
        })
    }

    /// Distance of the top from the planet's centre, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Lighting of a fog in lanes, with a glow of the sky. For multiple scattering the ambient light is that of the sky only, as
    /// the solution includes the light reflected by the ground.
    pub fn on_fog<const N: usize>(
        &self,
        view: &View,
        to: &Converter<N>,
        scattering: FogScattering,
        glow: Spectrum<N>,
    ) -> FogLighting<Spectrum<N>> {
        let even = match scattering {
            FogScattering::Multiple => &self.sky_radiance,
            _ => &self.mean_radiance,
        };
        let albedo = &view.sky().atmosphere().planet.ground_albedo;
        let albedo = to.wavelengths_nm().map(|nm| albedo.at(nm) as f32);
        let solar = view.solar_irradiance();
        let irradiance = to.light(&self.sun_irradiance, &solar);
        let shines = irradiance.max_element() > 0.0;
        FogLighting {
            sun: shines.then_some(DirectionalLight {
                direction: view.sun(),
                irradiance,
            }),
            ambient: to.light(even, &solar) + glow,
            ground_albedo: Spectrum(albedo),
        }
    }
}

/// [`effective_top_of_layers_m`]; the height of the ground for fog without an upper end.
pub(super) fn top_m<const N: usize>(layers: &[LayerLanes<N>], ground: &Ground) -> f64 {
    let each = layers.iter();
    let each = each.map(|layer| (&layer.density, layer.extinction_per_m.max_element()));
    effective_top_of_layers_m(ground.height_m, each)
}

/// Irradiance of the ground below a fog relative to that without the fog.
///
/// With multiple scattering it is that of the fog's solution. Otherwise it is a two-stream estimate (Meador & Weaver 1980,
/// quadrature of their table 1) with reflection between ground and fog: `t / (1 - albedo r)`, which neglects the
/// inclination of sunlight. It tends to 1 in thin fog, and in any fog without absorption over white ground.
pub(super) fn share_on_ground<const N: usize>(
    fog: &FogLanes<N>,
    layers: &[LayerLanes<N>],
) -> Spectrum<N> {
    if let Some(share) = fog.ground_share() {
        return share;
    }
    let (ground, light) = (fog.ground(), fog.lighting());
    Spectrum::from_fn(|lane| {
        let (mut depth, mut scattered, mut forward) = (0.0, 0.0, 0.0);
        for layer in layers {
            let column = layer.density.column_above_m(ground.height_m);
            // Fog without an upper end would transmit no light: it is lit uniformly.
            if column.is_finite() {
                let tau = column * f64::from(layer.scattering_per_m[lane]);
                depth += column * f64::from(layer.extinction_per_m[lane]);
                scattered += tau;
                forward += tau * layer.phase.asymmetry(layer.wavelengths_nm[lane]);
            }
        }
        let (t, r) = two_streams(depth, scattered, forward);
        (t / (1.0 - f64::from(light.ground_albedo[lane]) * r)) as f32
    })
}

/// Transmittance and reflectance of a layer for diffuse light, from its optical depth, its scattering optical depth, and
/// the latter times the mean cosine.
fn two_streams(depth: f64, scattered: f64, forward: f64) -> (f64, f64) {
    let root3 = 3f64.sqrt();
    // gamma_1 tau and gamma_2 tau.
    let loss = root3 * (depth - 0.5 * (scattered + forward));
    let back = root3 * 0.5 * (scattered - forward);
    let k = ((loss - back) * (loss + back)).max(0.0).sqrt();
    if k < 1e-6 * loss.max(1e-30) || k < 1e-9 {
        return (1.0 / (1.0 + loss), back / (1.0 + loss));
    }
    let fall = (-2.0 * k).exp();
    let below = (k + loss) + (k - loss) * fall;
    (2.0 * k * (-k).exp() / below, back * (1.0 - fall) / below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_streams_conserve_energy() {
        for tau in [1e-6, 0.1, 3.0, 80.0] {
            let (t, r) = two_streams(tau, tau, 0.85 * tau);
            assert!((t + r - 1.0).abs() < 1e-9, "{tau}: {t} {r}");
            // Continuous in the absorption.
            let (t2, r2) = two_streams(tau, tau * (1.0 - 1e-6), 0.85 * tau);
            assert!((t2 / t - 1.0).abs() < 0.02 && t2 + r2 < 1.0);
        }
        let (t, r) = two_streams(2.0, 0.0, 0.0);
        assert!((t - (-2.0 * 3f64.sqrt()).exp()).abs() < 1e-12 && r == 0.0);
        assert_eq!(two_streams(0.0, 0.0, 0.0), (1.0, 0.0));
    }
}
