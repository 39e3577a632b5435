//! Single scattering of sunlight and of uniform light into a ray.

use super::closed_forms::{Lanes, OPAQUE, mean_attenuated_source};
use super::layer::MergedLayer;
use super::lighting::Ground;
use super::ray_cuts::split_at_heights;
use crate::atmosphere::RaySegment;
use crate::spectrum::Spectrum;

/// Single scattering for a sun of unit irradiance, in `K` streams.
pub(super) struct SingleScattering<'a, const N: usize, X, S> {
    pub layers: &'a [MergedLayer<N>],
    pub breakpoints_m: &'a [f64],
    pub ground: &'a Ground,
    /// Sine of the sun's elevation, if there is a sun.
    pub sin_sun: Option<f64>,
    /// Whether the fog attenuates sunlight on its way to the ray.
    pub attenuated: bool,
    /// Extinction coefficients of each layer by stream, 1/m: along rays, and on the way of sunlight to them.
    pub extinction: X,
    /// Scattering coefficient of each layer times its phase function towards the eye, by stream, 1/(m sr).
    pub towards_eye: S,
}

impl<const N: usize, const K: usize, X, S> SingleScattering<'_, N, X, S>
where
    X: Fn(&MergedLayer<N>) -> [[Spectrum<N>; K]; 2],
    S: Fn(&MergedLayer<N>) -> [Spectrum<N>; K],
{
    /// Radiance of sunlight scattered into a ray, by stream, and of a uniform source (`uniform`, 1/m, for each layer) that is not
    /// attenuated on its way to the ray, and on its way to the eye as the first stream.
    #[inline]
    pub fn along(
        &self,
        ray: &RaySegment,
        uniform: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> ([Spectrum<N>; K], Spectrum<N>) {
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
    ) -> ([Spectrum<N>; K], Spectrum<N>) {
        let [extinction, sun_extinction] = (self.extinction)(layer);
        let column = layer.density.column_along_m(ray).min(OPAQUE) as f32;
        // Per metre of column, as extinction may be 0.
        let opacity = |k: usize| (extinction[k] * column).mean_transmittance() * column;
        let Some(sin_sun) = self.sin_sun else {
            return ([Spectrum::ZERO; K], uniform * opacity(0));
        };
        let towards_eye = (self.towards_eye)(layer);
        let sunlit = if !self.attenuated || layer.density.is_uniform() {
            std::array::from_fn(|k| towards_eye[k] * opacity(k))
        } else if sin_sun <= 0.0 {
            [Spectrum::ZERO; K]
        } else {
            let to_sun = |height_m: f64| {
                let column_m = layer.density.column_above_m(height_m) / sin_sun;
                column_m.min(OPAQUE) as f32
            };
            let (near, far) = (to_sun(ray.height_m), to_sun(ray.end_height_m()));
            std::array::from_fn(|k| {
                let [near, far] = [near, far].map(|column| sun_extinction[k] * column);
                let far = far.scale_acc(extinction[k], column);
                towards_eye[k] * mean_attenuated_source(near, far) * column
            })
        };
        (sunlit, uniform * opacity(0))
    }

    /// Several profiles, or round ground: the closed form between breakpoints.
    fn layered(
        &self,
        ray: &RaySegment,
        uniform: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> ([Spectrum<N>; K], Spectrum<N>) {
        let mut sunlit = [Spectrum::ZERO; K];
        let mut from_uniform = Spectrum::ZERO;
        let mut before = [Spectrum::ZERO; K];
        split_at_heights(ray, self.breakpoints_m, |part| {
            let mut along = [Spectrum::ZERO; K];
            let mut ambient = Spectrum::ZERO;
            let mut direct = [Spectrum::ZERO; K];
            for layer in self.layers {
                let column = layer.density.column_along_m(part).min(OPAQUE) as f32;
                let ([extinction, _], towards_eye) =
                    ((self.extinction)(layer), (self.towards_eye)(layer));
                for k in 0..K {
                    along[k] = along[k].scale_acc(extinction[k], column);
                    direct[k] = direct[k].scale_acc(towards_eye[k], column);
                }
                ambient = ambient.scale_acc(uniform(layer), column);
            }
            let seen = before.map(Lanes::exp_neg);
            from_uniform += seen[0] * ambient * along[0].mean_transmittance();
            if let Some(sin_sun) = self.sin_sun {
                let to_sun = |height_m: f64| match self.attenuated {
                    true => self.depth_to_sun(height_m, sin_sun),
                    false => [Spectrum::ZERO; K],
                };
                let (near, far) = (to_sun(part.height_m), to_sun(part.end_height_m()));
                for k in 0..K {
                    let arriving = mean_attenuated_source(near[k], far[k] + along[k]);
                    sunlit[k] += seen[k] * direct[k] * arriving;
                }
            }
            for (before, along) in before.iter_mut().zip(along) {
                *before += along;
            }
            before[0].min_element() < 40.0
        });
        (sunlit, from_uniform)
    }

    /// Optical depth between a height and the sun by stream; [`OPAQUE`] if the ground blocks the sun. Layers without an upper end
    /// are ignored, as they would block all light.
    pub fn depth_to_sun(&self, height_m: f64, sin_sun: f64) -> [Spectrum<N>; K] {
        let ray = RaySegment::new(height_m, sin_sun, f64::INFINITY, self.ground.radius_m);
        if self.ground.blocks(&ray) {
            return [Spectrum::splat(OPAQUE as f32); K];
        }
        let mut depth = [Spectrum::ZERO; K];
        if height_m == f64::INFINITY {
            return depth;
        }
        for layer in self
            .layers
            .iter()
            .filter(|layer| !layer.density.is_uniform())
        {
            let column = layer.density.column_along_m(&ray).min(OPAQUE) as f32;
            let [_, extinction] = (self.extinction)(layer);
            for (depth, extinction) in depth.iter_mut().zip(extinction) {
                *depth = depth.scale_acc(extinction, column);
            }
        }
        depth
    }
}
