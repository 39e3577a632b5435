//! Light at the nodes of the grid while it is being solved for.

use super::field::{FieldGrid, RadianceField};
use super::harmonics::Harmonics;
use crate::spectrum::Spectrum;
use std::ops::Range;

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

    /// Adds other light times factors.
    pub fn add_scaled(&mut self, other: &Self, factors: Spectrum<N>) {
        let all = self.moments.iter_mut().chain(&mut self.ground);
        for (a, b) in all.zip(other.moments.iter().chain(&other.ground)) {
            *a = a.mul_acc(*b, factors);
        }
    }

    /// Intensities at all points.
    pub fn intensities(&self) -> impl Iterator<Item = Spectrum<N>> {
        self.moments.chunks_exact(self.count).map(|point| point[0])
    }

    /// Under each sun the intensity below which a point does not count: [`DARK`], or at [`NIGHT`].
    pub fn least(&self) -> Vec<Spectrum<N>> {
        let suns = self.ground.len();
        let mut brightest = vec![Spectrum::<N>::splat(f32::MIN_POSITIVE / DARK); suns];
        for (place, intensity) in self.intensities().enumerate() {
            let most = &mut brightest[place % suns];
            *most = brighter(*most, intensity);
        }
        let day = brightest.iter().copied().fold(Spectrum::ZERO, brighter);
        brightest
            .into_iter()
            .map(|brightest| brighter(brightest * DARK, day * NIGHT))
            .collect()
    }

    /// Under each sun the largest fraction of the intensity that a correction changes at any point that counts ([`Light::least`]); of that
    /// under `eye_sun` at the same radius where it is larger.
    pub fn changes_by(&self, correction: &Self, eye_sun: Option<usize>) -> Vec<f32> {
        let (count, suns, least) = (self.count, self.ground.len(), self.least());
        let mut changes = vec![0.0f32; suns];
        let points = self.moments.chunks_exact(count);
        let corrections = correction.moments.chunks_exact(count);
        for (place, (point, correction)) in points.zip(corrections).enumerate() {
            let (radius, sun) = (place / suns, place % suns);
            let scale = admissible(point[0], correction[0]);
            let corrected = point[0].mul_acc(correction[0], scale);
            let mut value = brighter(corrected, least[sun]);
            if let Some(eye_sun) = eye_sun {
                value = brighter(value, self.moments[(radius * suns + eye_sun) * count]);
            }
            changes[sun] = (0..N).fold(changes[sun], |change, lane| {
                let fraction = (correction[0][lane] * scale[lane] / value[lane]).abs();
                change.max(if fraction.is_nan() {
                    f32::INFINITY
                } else {
                    fraction
                })
            });
        }
        changes
    }

    /// Removes the light under other suns.
    pub fn keep(&mut self, kept: &Range<usize>) {
        let suns = self.ground.len();
        for (place, point) in self.moments.chunks_exact_mut(self.count).enumerate() {
            if !kept.contains(&(place % suns)) {
                point.fill(Spectrum::ZERO);
            }
        }
        for (sun, ground) in self.ground.iter_mut().enumerate() {
            if !kept.contains(&sun) {
                *ground = Spectrum::ZERO;
            }
        }
    }

    /// Adds a correction, limited where it would leave no light or more moments than light has.
    pub fn correct(&mut self, correction: &Self) {
        let points = self.moments.chunks_exact_mut(self.count);
        let corrections = correction.moments.chunks_exact(self.count);
        for (point, correction) in points.zip(corrections) {
            let scale = admissible(point[0], correction[0]);
            for (a, b) in point.iter_mut().zip(correction) {
                *a = a.mul_acc(*b, scale);
            }
            limit_moments(point);
        }
        for (a, b) in self.ground.iter_mut().zip(&correction.ground) {
            *a = a.mul_acc(*b, admissible(*a, *b));
        }
    }
}

/// Fraction of the brightest light under the same sun below which a point does not count.
const DARK: f32 = 1e-8;

/// Fraction of the brightest light under any sun below which a point does not count: a twentieth of what the sky of a moonless night
/// has.
const NIGHT: f32 = 1e-9;

/// Reduces the other moments of a point to what light of its intensity can have. Where little light is the difference of much, they
/// could otherwise grow without bounds.
#[inline(always)]
fn limit_moments<const N: usize>(point: &mut [Spectrum<N>]) {
    /// Largest ratio of a moment of light that is nowhere negative to its intensity, the first moment:
    /// `max |Y_lm| / Y_00 <= sqrt(2 (2 l + 1))`, up to degree 16.
    const MAX_RATIO: f32 = 8.2;
    let (intensity, others) = point.split_first_mut().expect("a moment");
    let mut largest = Spectrum::ZERO;
    for moment in others.iter() {
        largest = brighter(largest, moment.map(f32::abs));
    }
    let most = *intensity * MAX_RATIO;
    if (0..N).all(|lane| largest[lane] <= most[lane]) {
        return;
    }
    let scale = Spectrum::from_fn(|lane| (most[lane].max(0.0) / largest[lane]).min(1.0));
    for moment in others {
        *moment *= scale;
    }
}

/// The larger of two values in each lane.
#[inline(always)]
fn brighter<const N: usize>(a: Spectrum<N>, b: Spectrum<N>) -> Spectrum<N> {
    Spectrum::from_fn(|lane| a[lane].max(b[lane]))
}

/// Factor of a change that keeps at least a tenth of a value.
#[inline(always)]
fn admissible<const N: usize>(value: Spectrum<N>, change: Spectrum<N>) -> Spectrum<N> {
    Spectrum::from_fn(|lane| match change[lane] < -0.9 * value[lane] {
        true => -0.9 * value[lane] / change[lane],
        false => 1.0,
    })
}
