//! Single scattering of sunlight and of uniform light into a ray.

use super::closed_forms::{Lanes, mean_attenuated_source};
use super::layer::{MergedLayer, OPAQUE};
use super::lighting::Ground;
use super::ray_cuts::split_at_heights;
use crate::atmosphere::RaySegment;
use crate::spectrum::Spectrum;

/// Single scattering for a sun of unit irradiance.
pub(super) struct SingleScattering<'a, const N: usize, X, S> {
    pub layers: &'a [MergedLayer<N>],
    pub breakpoints_m: &'a [f64],
    pub ground: &'a Ground,
    /// Sine of the sun's elevation, if there is a sun.
    pub sin_sun: Option<f64>,
    /// Whether the fog attenuates sunlight on its way to the ray.
    pub attenuated: bool,
    /// Extinction coefficient of each layer, 1/m.
    pub extinction: X,
    /// Scattering coefficient of each layer times its phase function towards the eye, 1/(m sr).
    pub towards_eye: S,
}

impl<const N: usize, X, S> SingleScattering<'_, N, X, S>
where
    X: Fn(&MergedLayer<N>) -> Spectrum<N>,
    S: Fn(&MergedLayer<N>) -> Spectrum<N>,
{
    /// Radiance of sunlight scattered into a ray, and of a uniform source (`uniform`, 1/m, for each layer) that is not
    /// attenuated on its way to the ray.
    #[inline]
    pub fn along(
        &self,
        ray: &RaySegment,
        uniform: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        match self.layers {
            [layer] if self.ground.is_flat() => self.single_layer(layer, ray, uniform(layer)),
            _ => self.layered(ray, uniform),
        }
    }

    /// One profile over flat ground: closed form.
    #[inline]
    fn single_layer(
        &self,
        layer: &MergedLayer<N>,
        ray: &RaySegment,
        uniform: Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let extinction = (self.extinction)(layer);
        let column = layer.density.column_along_m(ray).min(OPAQUE);
        let along = extinction * column as f32;
        // Per metre of column, as extinction may be 0.
        let opacity = along.mean_transmittance() * column as f32;
        let Some(sin_sun) = self.sin_sun else {
            return (Spectrum::ZERO, uniform * opacity);
        };
        let arriving = if !self.attenuated || layer.density.is_uniform() {
            opacity
        } else if sin_sun <= 0.0 {
            Spectrum::ZERO
        } else {
            let to_sun = |height_m: f64| {
                let column_m = layer.density.column_above_m(height_m) / sin_sun;
                extinction * column_m.min(OPAQUE) as f32
            };
            let (near, far) = (to_sun(ray.height_m), to_sun(ray.end_height_m()));
            mean_attenuated_source(near, far + along) * column as f32
        };
        ((self.towards_eye)(layer) * arriving, uniform * opacity)
    }

    /// Several profiles, or round ground: the closed form between breakpoints.
    fn layered(
        &self,
        ray: &RaySegment,
        uniform: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let mut sunlit = Spectrum::ZERO;
        let mut from_uniform = Spectrum::ZERO;
        let mut before = Spectrum::ZERO;
        split_at_heights(ray, self.breakpoints_m, |part| {
            let mut along = Spectrum::ZERO;
            let mut ambient = Spectrum::ZERO;
            let mut direct = Spectrum::ZERO;
            for layer in self.layers {
                let column = layer.density.column_along_m(part).min(OPAQUE) as f32;
                along = along.scale_acc((self.extinction)(layer), column);
                ambient = ambient.scale_acc(uniform(layer), column);
                direct = direct.scale_acc((self.towards_eye)(layer), column);
            }
            let seen = before.exp_neg();
            let opacity = along.mean_transmittance();
            from_uniform += seen * ambient * opacity;
            if let Some(sin_sun) = self.sin_sun {
                let arriving = if self.attenuated {
                    let near = self.depth_to_sun(part.height_m, sin_sun);
                    let far = self.depth_to_sun(part.end_height_m(), sin_sun);
                    mean_attenuated_source(near, far + along)
                } else {
                    opacity
                };
                sunlit += seen * direct * arriving;
            }
            before += along;
            before.min_element() < 40.0
        });
        (sunlit, from_uniform)
    }

    /// Optical depth between a height and the sun; [`OPAQUE`] if the ground blocks the sun. Layers without an upper end are
    /// ignored, as they would block all light.
    pub fn depth_to_sun(&self, height_m: f64, sin_sun: f64) -> Spectrum<N> {
        let ray = RaySegment::new(height_m, sin_sun, f64::INFINITY, self.ground.radius_m);
        if self.ground.blocks(&ray) {
            return Spectrum::splat(OPAQUE as f32);
        }
        if height_m == f64::INFINITY {
            return Spectrum::ZERO;
        }
        self.layers
            .iter()
            .filter(|layer| !layer.density.is_uniform())
            .fold(Spectrum::ZERO, |sum, layer| {
                let column = layer.density.column_along_m(&ray).min(OPAQUE);
                sum.scale_acc((self.extinction)(layer), column as f32)
            })
    }
}
