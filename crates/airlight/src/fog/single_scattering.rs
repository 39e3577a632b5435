//! Sunlight scattered once into a line, and light from all sides: over layers and ground of every kind.

use super::lanes::Lanes;
use super::lighting::Ground;
use super::merged_layers::MergedLayer;
use super::model::OPAQUE;
use super::{scatter, split_at_heights::split_at_heights};
use crate::atmosphere::RaySegment;
use crate::spectrum::Spectrum;

/// What is scattered once, for a sun of unit irradiance.
pub(super) struct SingleScattering<'a, const N: usize, X, S> {
    pub layers: &'a [MergedLayer<N>],
    pub breakpoints_m: &'a [f64],
    pub ground: &'a Ground,
    /// Sine of the sun's elevation, if there is a sun.
    pub sine_sun: Option<f64>,
    /// Whether the fog dims the sun.
    pub dimmed: bool,
    /// What dims, of each stratum, 1/m.
    pub extinction: X,
    /// What scatters sunlight towards the eye, of each stratum, 1/(m sr).
    pub towards_eye: S,
}

impl<const N: usize, X, S> SingleScattering<'_, N, X, S>
where
    X: Fn(&MergedLayer<N>) -> Spectrum<N>,
    S: Fn(&MergedLayer<N>) -> Spectrum<N>,
{
    /// Sunlight scattered into a line, and the same for a source `even` (1/m of each stratum) that nothing dims on its way
    /// there.
    #[inline]
    pub fn along(
        &self,
        line: &RaySegment,
        even: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        match self.layers {
            [layer] if self.ground.is_flat() => self.single_layer(layer, line, even(layer)),
            _ => self.layered(line, even),
        }
    }

    /// One profile over flat ground: closed form.
    #[inline]
    fn single_layer(
        &self,
        layer: &MergedLayer<N>,
        line: &RaySegment,
        even: Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let extinction = (self.extinction)(layer);
        let column = layer.profile.column_along_m(line).min(OPAQUE);
        let along = extinction * column as f32;
        // Stated for each metre of column, as extinction may be 0.
        let opacity = along.mean_transmittance() * column as f32;
        let Some(sine) = self.sine_sun else {
            return (Spectrum::ZERO, even * opacity);
        };
        let arriving = if !self.dimmed || layer.profile.is_uniform() {
            opacity
        } else if sine <= 0.0 {
            Spectrum::ZERO
        } else {
            let near = layer.profile.column_above_m(line.height_m) / sine;
            let near = extinction * near.min(OPAQUE) as f32;
            let growth = along * (1.0 - line.sin_elevation / sine) as f32;
            scatter::mean_once(near, growth) * column as f32
        };
        ((self.towards_eye)(layer) * arriving, even * opacity)
    }

    /// Several profiles, or round ground: the closed form from level to level.
    fn layered(
        &self,
        line: &RaySegment,
        even: &impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let mut sunlit = Spectrum::ZERO;
        let mut evenly = Spectrum::ZERO;
        let mut before = Spectrum::ZERO;
        split_at_heights(line, self.breakpoints_m, |part| {
            let mut along = Spectrum::ZERO;
            let mut ambient = Spectrum::ZERO;
            let mut direct = Spectrum::ZERO;
            for layer in self.layers {
                let column = layer.profile.column_along_m(part).min(OPAQUE) as f32;
                along = along.scale_acc((self.extinction)(layer), column);
                ambient = ambient.scale_acc(even(layer), column);
                direct = direct.scale_acc((self.towards_eye)(layer), column);
            }
            let seen = before.exp_neg();
            let opacity = along.mean_transmittance();
            evenly += seen * ambient * opacity;
            if let Some(sine) = self.sine_sun {
                let arriving = if self.dimmed {
                    let near = self.depth_to_sun(part.height_m, sine);
                    let far = self.depth_to_sun(part.end_height_m(), sine);
                    scatter::mean_once(near, far - near + along)
                } else {
                    opacity
                };
                sunlit += seen * direct * arriving;
            }
            before += along;
            before.min_element() < 40.0
        });
        (sunlit, evenly)
    }

    /// Optical depth between a height and the sun; [`OPAQUE`] where the ground is in the way. Layers without an upper end
    /// are left out: no light would come through them.
    pub fn depth_to_sun(&self, height_m: f64, sine: f64) -> Spectrum<N> {
        let line = RaySegment::new(height_m, sine, f64::INFINITY, self.ground.radius_m);
        if self.ground.blocks(&line) {
            return Spectrum::splat(OPAQUE as f32);
        }
        if height_m == f64::INFINITY {
            return Spectrum::ZERO;
        }
        self.layers
            .iter()
            .filter(|layer| !layer.profile.is_uniform())
            .fold(Spectrum::ZERO, |sum, layer| {
                let column = layer.profile.column_along_m(&line).min(OPAQUE);
                sum.scale_acc((self.extinction)(layer), column as f32)
            })
    }
}
