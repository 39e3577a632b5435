//! Multiple scattering in plane-parallel air, solved directly.
//!
//! Light that does not change horizontally is scattered by a linear operator that leaves each azimuthal mode to itself: a
//! matrix over the radii and the degrees of the moments. Factorising one minus this matrix sums all orders of scattering at once,
//! however thick the air is. The spherical solution differs by little, which a few iterations correct.

use super::harmonics::Harmonics;
use super::light::Light;
use crate::math::parallel;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;

/// The response of the light at one radius to the light at all radii.
pub struct ResponseRow<const N: usize> {
    /// For each azimuthal mode, `[degree][column]`; the columns are `[radius][degree]`, and the irradiance on the ground in
    /// mode 0.
    modes: Vec<Vec<Spectrum<N>>>,
    /// Downward irradiance: columns of mode 0.
    downward: Vec<Spectrum<N>>,
}

/// A direction: the cosine of its zenith angle, its weight in an integral over solid angle, and its harmonics at azimuth 0.
pub struct WeightedDirection<'a> {
    pub mu: f64,
    pub weight: f64,
    pub harmonics: &'a [f32],
}

impl<const N: usize> ResponseRow<N> {
    /// No response, for light at `radii` radii, of moments in `basis` to moments in `rescattered`.
    pub fn new(radii: usize, basis: &Harmonics, rescattered: &Harmonics) -> Self {
        let low = rescattered.degree();
        Self {
            modes: (0..=low)
                .map(|m| vec![Spectrum::ZERO; (basis.degree() + 1 - m) * columns(radii, low, m)])
                .collect(),
            downward: vec![Spectrum::ZERO; columns(radii, low, 0)],
        }
    }

    /// Adds the light from a direction: its coefficients for the moments of the field, `[radius][harmonic]`, and for the
    /// irradiance on the ground.
    #[inline(always)]
    pub fn add(
        &mut self,
        direction: &WeightedDirection<'_>,
        coefficients: &[Spectrum<N>],
        ground: Spectrum<N>,
    ) {
        let low = self.modes.len() - 1;
        let count = Harmonics::index(low, low) + 1;
        let radii = coefficients.len() / count;
        for (m, rows) in self.modes.iter_mut().enumerate() {
            // The mean of cos^2(m azimuth).
            let weight = direction.weight * if m == 0 { 1.0 } else { 0.5 };
            let columns = columns(radii, low, m);
            for (degree, row) in rows.chunks_exact_mut(columns).enumerate() {
                let y = direction.harmonics[Harmonics::index(m + degree, m)] * weight as f32;
                accumulate(row, (m, low), coefficients, ground, y);
            }
        }
        if direction.mu > 0.0 {
            let weight = (direction.weight * direction.mu) as f32;
            accumulate(&mut self.downward, (0, low), coefficients, ground, weight);
        }
    }
}

/// Adds `weight` times the coefficients of one mode, up to a degree.
#[inline(always)]
fn accumulate<const N: usize>(
    row: &mut [Spectrum<N>],
    (m, low): (usize, usize),
    coefficients: &[Spectrum<N>],
    ground: Spectrum<N>,
    weight: f32,
) {
    let count = Harmonics::index(low, low) + 1;
    let points = coefficients.chunks_exact(count);
    for (out, point) in row.chunks_exact_mut(low + 1 - m).zip(points) {
        for (l, out) in (m..).zip(out) {
            *out = out.scale_acc(point[Harmonics::index(l, m)], weight);
        }
    }
    if m == 0 {
        let last = row.len() - 1;
        row[last] = row[last].scale_acc(ground, weight);
    }
}

/// Number of columns of a mode: moments at each radius, and the irradiance on the ground.
fn columns(radii: usize, low: usize, m: usize) -> usize {
    radii * (low + 1 - m) + usize::from(m == 0)
}

/// The factorised operator of all azimuthal modes that are scattered again.
pub struct PlaneParallel<const N: usize> {
    modes: Vec<Mode<N>>,
}

struct Mode<const N: usize> {
    m: usize,
    /// Number of degrees at each radius that are scattered again, and of all.
    low: usize,
    all: usize,
    size: usize,
    /// Factors L (below the diagonal, which is 1) and U of one minus the response among the columns.
    factors: Vec<Spectrum<N>>,
    /// Response of the higher degrees, `[radius][degree][column]`.
    beyond: Vec<Spectrum<N>>,
}

impl<const N: usize> PlaneParallel<N> {
    /// Factorises the operator with these rows, one for each radius.
    pub fn new(basis: &Harmonics, rescattered: &Harmonics, rows: &[ResponseRow<N>]) -> Self {
        let modes = parallel::map(rescattered.degree() + 1, |m| {
            vectorized(
                #[inline(always)]
                || Mode::new(m, basis.degree(), rescattered.degree(), rows),
            )
        });
        Self { modes }
    }

    /// Sums all orders of scattering of `light` in plane-parallel air, the light itself included.
    pub fn all_orders(&self, light: &Light<N>) -> Light<N> {
        let (suns, count) = (light.ground.len(), light.count);
        let radii = light.moments.len() / (suns * count);
        let solved = parallel::map(suns, |sun| {
            vectorized(
                #[inline(always)]
                || {
                    let mut column: Vec<Spectrum<N>> = (0..radii)
                        .flat_map(|r| &light.moments[(r * suns + sun) * count..][..count])
                        .copied()
                        .collect();
                    let mut ground = light.ground[sun];
                    for mode in &self.modes {
                        mode.all_orders(count, &mut column, &mut ground);
                    }
                    (column, ground)
                },
            )
        });
        let mut out = light.clone();
        for (sun, (column, ground)) in solved.iter().enumerate() {
            for r in 0..radii {
                out.moments[(r * suns + sun) * count..][..count]
                    .copy_from_slice(&column[r * count..][..count]);
            }
            out.ground[sun] = *ground;
        }
        out
    }
}

impl<const N: usize> Mode<N> {
    #[inline(always)]
    fn new(m: usize, degree: usize, rescattered: usize, rows: &[ResponseRow<N>]) -> Self {
        let (low, all) = (rescattered + 1 - m, degree + 1 - m);
        let size = columns(rows.len(), rescattered, m);
        let mut factors = Vec::with_capacity(size * size);
        let mut beyond = Vec::with_capacity(rows.len() * (all - low) * size);
        for row in rows {
            let (scattered_again, rest) = row.modes[m].split_at(low * size);
            factors.extend(
                scattered_again
                    .iter()
                    .map(|&response| Spectrum::ZERO - response),
            );
            beyond.extend_from_slice(rest);
        }
        if m == 0 {
            let downward = &rows[0].downward;
            factors.extend(downward.iter().map(|&response| Spectrum::ZERO - response));
        }
        for k in 0..size {
            factors[k * size + k] += Spectrum::ONE;
        }
        factorise(&mut factors, size);
        Self {
            m,
            low,
            all,
            size,
            factors,
            beyond,
        }
    }

    /// Replaces this mode of the light of one sun, `[radius][harmonic]`, by all orders of its scattering.
    #[inline(always)]
    fn all_orders(&self, count: usize, column: &mut [Spectrum<N>], ground: &mut Spectrum<N>) {
        let at = |radius: usize, degree: usize| {
            radius * count + Harmonics::index(self.m + degree, self.m)
        };
        let radii = column.len() / count;
        let mut x: Vec<Spectrum<N>> = (0..radii)
            .flat_map(|radius| (0..self.low).map(move |degree| (radius, degree)))
            .map(|(radius, degree)| column[at(radius, degree)])
            .collect();
        if self.m == 0 {
            x.push(*ground);
        }
        substitute(&self.factors, &mut x);
        for radius in 0..radii {
            for degree in 0..self.low {
                column[at(radius, degree)] = x[radius * self.low + degree];
            }
            let rows = &self.beyond[radius * (self.all - self.low) * self.size..];
            for degree in self.low..self.all {
                let row = &rows[(degree - self.low) * self.size..][..self.size];
                let mut sum = column[at(radius, degree)];
                for (response, x) in row.iter().zip(&x) {
                    sum = sum.mul_acc(*response, *x);
                }
                column[at(radius, degree)] = sum;
            }
        }
        if self.m == 0 {
            *ground = x[self.size - 1];
        }
    }
}

/// Replaces a matrix by its factors L and U. No pivots are needed: the orders of scattering fall, so the diagonal dominates.
#[inline(always)]
fn factorise<const N: usize>(matrix: &mut [Spectrum<N>], size: usize) {
    for k in 0..size {
        let (above, below) = matrix.split_at_mut((k + 1) * size);
        let pivot_row = &above[k * size..];
        let inverse = Spectrum::ONE / pivot_row[k];
        for row in below.chunks_exact_mut(size) {
            let factor = row[k] * inverse;
            row[k] = factor;
            let factor = Spectrum::ZERO - factor;
            for (a, b) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                *a = a.mul_acc(factor, *b);
            }
        }
    }
}

/// Solves a factorised system in place.
#[inline(always)]
fn substitute<const N: usize>(factors: &[Spectrum<N>], x: &mut [Spectrum<N>]) {
    let size = x.len();
    for i in 1..size {
        let (done, rest) = x.split_at_mut(i);
        let mut sum = Spectrum::ZERO;
        for (a, x) in factors[i * size..][..i].iter().zip(done) {
            sum = sum.mul_acc(*a, *x);
        }
        rest[0] -= sum;
    }
    for i in (0..size).rev() {
        let (left, done) = x.split_at_mut(i + 1);
        let row = &factors[i * size..][..size];
        let mut sum = Spectrum::ZERO;
        for (a, x) in row[i + 1..].iter().zip(done) {
            sum = sum.mul_acc(*a, *x);
        }
        left[i] = (left[i] - sum) / row[i];
    }
}
