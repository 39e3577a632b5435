//! Light at the nodes of the grid while it is being solved for.

use super::field::{FieldGrid, RadianceField};
use super::harmonics::Harmonics;
use crate::spectrum::Spectrum;

/// Moments of the radiance and of its polarisation `[radius][sun][moment]`, and irradiances on the ground `[sun]`, per unit solar
/// irradiance.
#[derive(Clone, Debug)]
pub struct Light<const N: usize> {
    /// Number of moments at each grid point.
    pub count: usize,
    pub moments: Vec<Spectrum<N>>,
    pub ground: Vec<Spectrum<N>>,
}

impl<const N: usize> Light<N> {
    /// The field of this light.
    pub fn field(&self, grid: &FieldGrid, basis: &Harmonics) -> RadianceField<N> {
        RadianceField::new(
            grid.clone(),
            basis.clone(),
            self.moments.clone(),
            &self.ground,
        )
    }

    /// Adds other light.
    pub fn add(&mut self, other: &Self) {
        let all = self.moments.iter_mut().chain(&mut self.ground);
        for (a, b) in all.zip(other.moments.iter().chain(&other.ground)) {
            *a += *b;
        }
    }

    /// Subtracts other light.
    pub fn subtract(&mut self, other: &Self) {
        let all = self.moments.iter_mut().chain(&mut self.ground);
        for (a, b) in all.zip(other.moments.iter().chain(&other.ground)) {
            *a -= *b;
        }
    }

    /// Adds other light under one sun times these factors.
    pub fn add_scaled(&mut self, other: &Self, sun: usize, factor: Spectrum<N>) {
        let (count, suns) = (self.count, self.ground.len());
        let points = self.moments.chunks_exact_mut(count).skip(sun).step_by(suns);
        let others = other.moments.chunks_exact(count).skip(sun).step_by(suns);
        for (a, b) in points.flatten().zip(others.flatten()) {
            *a = a.mul_acc(*b, factor);
        }
        self.ground[sun] = self.ground[sun].mul_acc(other.ground[sun], factor);
    }

    /// Intensities at all radii under one sun.
    pub fn intensities(&self, sun: usize) -> impl Iterator<Item = Spectrum<N>> {
        let points = self.moments.chunks_exact(self.count);
        points.skip(sun).step_by(self.ground.len()).map(|p| p[0])
    }

    /// Largest fraction of the intensity, at any point that is not [`DARK`], that a correction changes.
    pub fn change_by(&self, correction: &Self) -> f32 {
        let (count, suns) = (self.count, self.ground.len());
        let mut brightest = vec![Spectrum::<N>::splat(f32::MIN_POSITIVE); suns];
        for (place, point) in self.moments.chunks_exact(count).enumerate() {
            let most = &mut brightest[place % suns];
            *most = Spectrum::from_fn(|lane| most[lane].max(point[0][lane]));
        }
        let mut change = 0.0f32;
        let points = self.moments.chunks_exact(count);
        let corrections = correction.moments.chunks_exact(count);
        for (place, (point, correction)) in points.zip(corrections).enumerate() {
            let scale = admissible(point[0], correction[0]);
            let corrected = point[0].mul_acc(correction[0], scale);
            let least = brightest[place % suns] * DARK;
            change = (0..N).fold(change, |change, lane| {
                let value = corrected[lane].max(least[lane]);
                change.max((correction[0][lane] * scale[lane] / value).abs())
            });
        }
        change
    }

    /// Adds a correction, limited where it would leave no light.
    pub fn correct(&mut self, correction: &Self) {
        let points = self.moments.chunks_exact_mut(self.count);
        let corrections = correction.moments.chunks_exact(self.count);
        for (point, correction) in points.zip(corrections) {
            let scale = admissible(point[0], correction[0]);
            for (a, b) in point.iter_mut().zip(correction) {
                *a = a.mul_acc(*b, scale);
            }
        }
        for (a, b) in self.ground.iter_mut().zip(&correction.ground) {
            *a = a.mul_acc(*b, admissible(*a, *b));
        }
    }
}

/// Fraction of the brightest light under the same sun below which a point does not count.
pub const DARK: f32 = 1e-9;

/// Factor of a change that keeps at least a tenth of a value.
#[inline(always)]
fn admissible<const N: usize>(value: Spectrum<N>, change: Spectrum<N>) -> Spectrum<N> {
    Spectrum::from_fn(|lane| match change[lane] < -0.9 * value[lane] {
        true => -0.9 * value[lane] / change[lane],
        false => 1.0,
    })
}
