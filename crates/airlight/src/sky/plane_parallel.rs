//! Multiple scattering in plane-parallel air, solved directly.
//!
//! Light that does not change horizontally is scattered by a linear operator that leaves each azimuthal mode to itself: a
//! matrix over the radii and the degrees of the moments. Factorising one minus this matrix sums all orders of scattering at once,
//! however thick the air is. The spherical solution differs by little, which a few iterations correct.

use super::harmonics::Harmonics;
use super::light::Light;
use super::polarised::{POLARISED, TensorHarmonics};
use super::ray_bundle::Response;
use crate::math::parallel;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use std::ops::Range;

/// Moments of the light at a number of radii.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub radii: usize,
    /// Degree of the moments of the intensity.
    pub degree: usize,
    /// Degree up to which they are scattered again.
    pub rescattered: usize,
    /// True if the light has moments of polarisation.
    pub polarised: bool,
}

impl Shape {
    /// Number of moments of polarisation in an azimuthal mode.
    fn polarised_in(&self, m: usize) -> usize {
        usize::from(self.polarised && m < POLARISED)
    }

    /// Number of moments of a mode at each radius that are scattered again: those of the intensity, and that of the polarisation.
    fn rescattered_in(&self, m: usize) -> usize {
        self.rescattered + 1 - m + self.polarised_in(m)
    }

    /// Number of columns of a mode: moments at each radius, and the irradiance on the ground.
    fn columns(&self, m: usize) -> usize {
        self.radii * self.rescattered_in(m) + usize::from(m == 0)
    }
}

/// The response of the light at one radius to the light at all radii.
pub struct ResponseRow<const N: usize> {
    shape: Shape,
    /// For each azimuthal mode, `[row][column]`. The rows are the moments of the intensity that are scattered again, the moment of
    /// the polarisation if the mode has one, and the other moments of the intensity; the columns are the former two at each radius,
    /// and the irradiance on the ground in mode 0.
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
    /// No response.
    pub fn new(shape: Shape) -> Self {
        let rows = |m| shape.degree + 1 - m + shape.polarised_in(m);
        Self {
            shape,
            modes: (0..=shape.rescattered)
                .map(|m| vec![Spectrum::ZERO; rows(m) * shape.columns(m)])
                .collect(),
            downward: vec![Spectrum::ZERO; shape.columns(0)],
        }
    }

    /// Adds the light from a direction: its response to the moments of the field, and to the irradiance on the ground.
    #[inline(always)]
    pub fn add(
        &mut self,
        direction: &WeightedDirection<'_>,
        response: &Response<N>,
        ground: Spectrum<N>,
    ) {
        let shape = self.shape;
        let amplitudes = TensorHarmonics::amplitudes(direction.mu as f32);
        for (m, rows) in self.modes.iter_mut().enumerate() {
            // The mean of cos^2(m azimuth), and of sin^2.
            let weight = direction.weight as f32 * if m == 0 { 1.0 } else { 0.5 };
            let columns = shape.columns(m);
            let polarised_row = shape.rescattered + 1 - m;
            for (place, row) in rows.chunks_exact_mut(columns).enumerate() {
                let degree = match shape.polarised_in(m) {
                    1 if place == polarised_row => {
                        let factors = [amplitudes.q[m], amplitudes.u[m]].map(|f| f * weight);
                        accumulate_linear(row, m, &shape, response, factors);
                        continue;
                    }
                    1 if place > polarised_row => m + place - 1,
                    _ => m + place,
                };
                let y = direction.harmonics[Harmonics::index(degree, m)] * weight;
                accumulate(row, m, &shape, (response, ground), y);
            }
        }
        if direction.mu > 0.0 {
            let weight = (direction.weight * direction.mu) as f32;
            accumulate(&mut self.downward, 0, &shape, (response, ground), weight);
        }
    }
}

/// Adds `weight` times the coefficients of one mode in the intensity.
#[inline(always)]
fn accumulate<const N: usize>(
    row: &mut [Spectrum<N>],
    m: usize,
    shape: &Shape,
    (response, ground): (&Response<N>, Spectrum<N>),
    weight: f32,
) {
    let low = shape.rescattered;
    let points = response.intensity.chunks_exact(response.stride);
    for (out, point) in row.chunks_exact_mut(shape.rescattered_in(m)).zip(points) {
        let (intensity, polarised) = out.split_at_mut(low + 1 - m);
        for (l, out) in (m..).zip(intensity) {
            *out = out.scale_acc(point[Harmonics::index(l, m)], weight);
        }
        for out in polarised {
            *out = out.scale_acc(point[Harmonics::index(low, low) + 1 + m], weight);
        }
    }
    if m == 0 {
        let last = row.len() - 1;
        row[last] = row[last].scale_acc(ground, weight);
    }
}

/// Adds the coefficients of one mode in Q and U, times these factors.
#[inline(always)]
fn accumulate_linear<const N: usize>(
    row: &mut [Spectrum<N>],
    m: usize,
    shape: &Shape,
    response: &Response<N>,
    factors: [f32; 2],
) {
    for (coefficients, factor) in response.linear.iter().zip(factors) {
        let columns = row.chunks_exact_mut(shape.rescattered_in(m));
        for (out, [natural, kept]) in columns.zip(coefficients) {
            let places = [2 - m, shape.rescattered + 1 - m];
            for (place, coefficients) in places.into_iter().zip([natural, kept]) {
                out[place] = out[place].scale_acc(coefficients[m], factor);
            }
        }
    }
}

/// The factorised operator of all azimuthal modes that are scattered again.
pub struct PlaneParallel<const N: usize> {
    modes: Vec<Mode<N>>,
}

struct Mode<const N: usize> {
    m: usize,
    /// Number of moments of the intensity.
    moments: usize,
    /// Number of degrees at each radius that are scattered again, and of all.
    low: usize,
    all: usize,
    /// Number of moments of polarisation.
    polarised: usize,
    size: usize,
    /// Factors L (below the diagonal, which is 1) and U of one minus the response among the columns.
    factors: Vec<Spectrum<N>>,
    /// Response of the higher degrees of the intensity, `[radius][degree][column]`.
    beyond: Vec<Spectrum<N>>,
}

impl<const N: usize> PlaneParallel<N> {
    /// Factorises the operator with these rows, one for each radius.
    pub fn new(shape: &Shape, rows: &[ResponseRow<N>]) -> Self {
        let modes = parallel::map(shape.rescattered + 1, |m| {
            vectorized(
                #[inline(always)]
                || Mode::new(m, shape, rows),
            )
        });
        Self { modes }
    }

    /// Sums all orders of scattering of `light` in plane-parallel air, the light itself included, under some of the suns.
    pub fn all_orders(&self, light: &Light<N>, of_suns: &Range<usize>) -> Light<N> {
        let (suns, count) = (light.ground.len(), light.count);
        let radii = light.moments.len() / (suns * count);
        let solved = parallel::map(of_suns.len(), |place| {
            let sun = of_suns.start + place;
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
        for (sun, (column, ground)) in of_suns.clone().zip(&solved) {
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
    fn new(m: usize, shape: &Shape, rows: &[ResponseRow<N>]) -> Self {
        let (low, all) = (shape.rescattered + 1 - m, shape.degree + 1 - m);
        let (polarised, size) = (shape.polarised_in(m), shape.columns(m));
        let mut factors = Vec::with_capacity(size * size);
        let mut beyond = Vec::with_capacity(rows.len() * (all - low) * size);
        for row in rows {
            let (scattered_again, rest) = row.modes[m].split_at((low + polarised) * size);
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
            moments: Harmonics::index(shape.degree, shape.degree) + 1,
            low,
            all,
            polarised,
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
        let scattered_again: Vec<usize> = (0..radii)
            .flat_map(|radius| {
                let intensity = (0..self.low).map(move |degree| at(radius, degree));
                let polarised =
                    (0..self.polarised).map(move |_| radius * count + self.moments + self.m);
                intensity.chain(polarised)
            })
            .collect();
        let mut x: Vec<Spectrum<N>> = scattered_again.iter().map(|&k| column[k]).collect();
        if self.m == 0 {
            x.push(*ground);
        }
        substitute(&self.factors, &mut x);
        for (&k, &x) in scattered_again.iter().zip(&x) {
            column[k] = x;
        }
        for radius in 0..radii {
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

/// Number of pivot rows that are subtracted from a row at a time.
const PIVOTS: usize = 4;

/// Replaces a matrix by its factors L and U. No pivoting is needed: the orders of scattering fall, so the diagonal dominates.
#[inline(always)]
fn factorise<const N: usize>(matrix: &mut [Spectrum<N>], size: usize) {
    let mut first = 0;
    while first < size {
        let end = (first + PIVOTS).min(size);
        let (above, below) = matrix.split_at_mut(end * size);
        let pivots = &mut above[first * size..];
        for k in 1..end - first {
            let (done, rest) = pivots.split_at_mut(k * size);
            eliminate(&mut rest[..size], done, first);
        }
        for row in below.chunks_exact_mut(size) {
            eliminate(row, pivots, first);
        }
        first = end;
    }
}

/// Subtracts factorised rows, the first of which has its diagonal at column `first`, from a row below them.
#[inline(always)]
fn eliminate<const N: usize>(row: &mut [Spectrum<N>], pivots: &[Spectrum<N>], first: usize) {
    let size = row.len();
    let count = pivots.len() / size;
    let mut factors = [Spectrum::ZERO; PIVOTS];
    for k in 0..count {
        let pivot = &pivots[k * size + first..];
        let factor = row[first + k] / pivot[k];
        row[first + k] = factor;
        factors[k] = Spectrum::ZERO - factor;
        for (a, b) in row[first + k + 1..first + count]
            .iter_mut()
            .zip(&pivot[k + 1..])
        {
            *a = a.mul_acc(factors[k], *b);
        }
    }
    let right = &mut row[first + count..];
    let pivot = |k: usize| &pivots[k * size + first + count..(k + 1) * size];
    match count {
        PIVOTS => {
            let pivots = pivot(0).iter().zip(pivot(1)).zip(pivot(2)).zip(pivot(3));
            for (a, (((p, q), r), s)) in right.iter_mut().zip(pivots) {
                *a = a
                    .mul_acc(factors[0], *p)
                    .mul_acc(factors[1], *q)
                    .mul_acc(factors[2], *r)
                    .mul_acc(factors[3], *s);
            }
        }
        _ => {
            for (k, factor) in factors[..count].iter().enumerate() {
                for (a, b) in right.iter_mut().zip(pivot(k)) {
                    *a = a.mul_acc(*factor, *b);
                }
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
