//! Sunlight scattered once into a line, and light from all sides: over layers and ground of every kind.

use super::lanes::Lanes;
use super::light::Ground;
use super::line::Line;
use super::model::OPAQUE;
use super::profile::Profile;
use super::strata::Stratum;
use super::{scatter, walk};
use crate::spectrum::Spectrum;

/// What is scattered once, for a sun of unit irradiance.
pub(super) struct Once<'a, const N: usize, X, S> {
    pub strata: &'a [Stratum<N>],
    pub levels_m: &'a [f64],
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

impl<const N: usize, X, S> Once<'_, N, X, S>
where
    X: Fn(&Stratum<N>) -> Spectrum<N>,
    S: Fn(&Stratum<N>) -> Spectrum<N>,
{
    /// Sunlight scattered into a line, and the same for a source `even` (1/m of each stratum) that nothing dims on its way
    /// there.
    #[inline]
    pub fn along(
        &self,
        line: &Line,
        even: &impl Fn(&Stratum<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        match self.strata {
            [stratum] if self.ground.is_flat() => self.in_one(stratum, line, even(stratum)),
            _ => self.in_several(line, even),
        }
    }

    /// One profile over flat ground: closed form.
    #[inline]
    fn in_one(
        &self,
        stratum: &Stratum<N>,
        line: &Line,
        even: Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let extinction = (self.extinction)(stratum);
        let column = stratum.profile.column(line).min(OPAQUE);
        let along = extinction * column as f32;
        // Stated for each metre of column, as extinction may be 0.
        let opacity = along.mean_transmittance() * column as f32;
        let Some(sine) = self.sine_sun else {
            return (Spectrum::ZERO, even * opacity);
        };
        let arriving = if !self.dimmed || stratum.profile == Profile::Uniform {
            opacity
        } else if sine <= 0.0 {
            Spectrum::ZERO
        } else {
            let near = stratum.profile.column_above(line.height_m) / sine;
            let near = extinction * near.min(OPAQUE) as f32;
            let growth = along * (1.0 - line.climb / sine) as f32;
            scatter::mean_once(near, growth) * column as f32
        };
        ((self.towards_eye)(stratum) * arriving, even * opacity)
    }

    /// Several profiles, or round ground: the closed form from level to level.
    fn in_several(
        &self,
        line: &Line,
        even: &impl Fn(&Stratum<N>) -> Spectrum<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let mut sunlit = Spectrum::ZERO;
        let mut evenly = Spectrum::ZERO;
        let mut before = Spectrum::ZERO;
        walk::parts(line, self.levels_m, |part| {
            let mut along = Spectrum::ZERO;
            let mut ambient = Spectrum::ZERO;
            let mut direct = Spectrum::ZERO;
            for stratum in self.strata {
                let column = stratum.profile.column(part).min(OPAQUE) as f32;
                along = along.scale_acc((self.extinction)(stratum), column);
                ambient = ambient.scale_acc(even(stratum), column);
                direct = direct.scale_acc((self.towards_eye)(stratum), column);
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
        let line = Line::new(height_m, sine, f64::INFINITY, self.ground.radius_m);
        if self.ground.blocks(&line) {
            return Spectrum::splat(OPAQUE as f32);
        }
        if height_m == f64::INFINITY {
            return Spectrum::ZERO;
        }
        self.strata
            .iter()
            .filter(|stratum| stratum.profile != Profile::Uniform)
            .fold(Spectrum::ZERO, |sum, stratum| {
                let column = stratum.profile.column(&line).min(OPAQUE);
                sum.scale_acc((self.extinction)(stratum), column as f32)
            })
    }
}
