//! Sunlight scattered by the residual of a phase function, the part that a solver's moments cannot represent.
//!
//! A solver keeps the moments `chi_l` of a phase function up to a degree and treats the fraction `f`, the first moment left
//! out, as unscattered ([`super::delta_m`]). Sunlight scattered once is computed with the exact phase function. Of the light
//! that this adds, with the moments `chi_l - f` of the degrees left out, the solver knows nothing: neither that the forward
//! peak scatters it on, nor what it becomes. Scattering by small angles multiplies moments. Let `t` be the scattering optical
//! depth of the path from the sun to the point of scattering and on to the eye. Light scattered `n` times at small angles
//! has the moments `t^n / n! (chi_l - f)^n`. Counted equally at the points where it is scattered, all orders together have
//! the phase function
//!
//! ```text
//! G(t) = sum_l (2 l + 1) / (4 pi) (exp(t (chi_l - f)) - 1) / t P_l,    sum over the degrees left out
//! ```
//!
//! in the place of that of the residual, `G(0)`. This holds as well for light scattered once by a large angle and otherwise by
//! small ones: bows and glories are blurred. The terms of the series in `t` are those of the TMS and IMS corrections of
//! Nakajima & Tanaka (J. Quant. Spectrosc. Radiat. Transfer 40, 51, 1988), where the second holds for a plane-parallel layer
//! seen towards the sun.
//!
//! `(exp(-x t) - 1) / t` is the mean of `-x exp(-y t)` over rates `y` from 0 to `x`, and `x <= f`. Interpolated between the rates `0`,
//! `f / 2` and `f`, the residual consists of three *streams*, with shares that depend on the angle alone, of which the forward
//! peak removes nothing, half of its fraction, and all. A stream with its own extinction is singly scattered light. The
//! interpolation is exact to first order in thin air and at one depth, `t f` from 2 to 5: that of the whole air towards the sun, if it
//! is known. At a depth of 2 it errs by 0.1 % of all orders of scattering up to there, and by 4 % at 4.

use super::delta_m::peak_fraction;
use crate::math::exponentials::count_exponentials;
use crate::math::interpolation::{Place, lerp, whole};
use crate::math::parallel;
use crate::math::real::Real;
use crate::math::simd::vectorized;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Number of streams.
pub const STREAMS: usize = 3;
/// Shares of the streams, which sum to 1, in the light scattered by a constituent.
pub type Shares<const N: usize> = [Spectrum<N>; STREAMS];
/// Shares of a phase function without forward peak.
pub const ONE_STREAM: [f32; STREAMS] = [1.0, 0.0, 0.0];

/// Part of a stream that the forward peak keeps: that which counts as unscattered.
#[inline(always)]
pub const fn kept_by_peak(stream: usize) -> f32 {
    1.0 - stream as f32 / (STREAMS - 1) as f32
}

/// Sum of streams by their shares, which can be negative.
#[inline(always)]
pub fn combined<const N: usize>(
    streams: &[Spectrum<N>; STREAMS],
    shares: &Shares<N>,
) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for (stream, share) in streams.iter().zip(shares) {
        sum = sum.mul_acc(*stream, *share);
    }
    sum.max_scalar(0.0)
}

/// Transmittance of each stream relative to that of the air without forward peaks, through air in which the optical depth
/// `removed` counts as unscattered.
#[inline(always)]
pub fn stream_transmittances<const N: usize>(removed: Spectrum<N>) -> [Spectrum<N>; STREAMS] {
    let one_step = (removed * (-1.0 / (STREAMS - 1) as f32)).exp();
    let mut out = [Spectrum::ONE; STREAMS];
    for k in 1..STREAMS {
        out[k] = out[k - 1] * one_step;
    }
    out
}

/// Fraction of the light of each stream that the forward peak scatters out of a background, on air in which the optical depth
/// `removed` counts as unscattered: `1 - T/T'`.
#[inline(always)]
pub fn scattered_into_peaks<const N: usize>(removed: Spectrum<N>) -> [Spectrum<N>; STREAMS] {
    count_exponentials(STREAMS * N);
    std::array::from_fn(|k| (removed * kept_by_peak(k)).map(|depth| -(-depth).exp_m1()))
}

/// Number of moments, which resolve a tenth of a degree.
const MOMENTS: usize = 1600;
/// Number of intervals of the table in the angle.
const INTERVALS: usize = 256;
/// Number of angles that are computed at once.
const BLOCK: usize = 8;
/// Smallest fraction of the scattering in a forward peak that matters.
const MIN_FRACTION: f64 = 1e-3;

/// The streams of a phase function at N wavelengths.
#[derive(Clone, Debug)]
pub struct Residual<const N: usize> {
    /// Shares of the second and third stream at even steps of [`HalfAngle::coordinate`].
    shares: Vec<[Spectrum<N>; STREAMS - 1]>,
}

/// Half a scattering angle, by squares that are accurate forwards and backwards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfAngle<T> {
    /// Square of the sine.
    pub sine2: T,
    /// Square of the cosine.
    pub cosine2: T,
}

impl<T: Real> HalfAngle<T> {
    /// Of the cosine of an angle.
    #[inline(always)]
    pub fn of_cosine(cosine: f64) -> Self {
        Self {
            sine2: T::of((0.5 * (1.0 - cosine)).max(0.0)),
            cosine2: T::of((0.5 * (1.0 + cosine)).max(0.0)),
        }
    }

    /// Of the angle between two unit vectors.
    #[inline(always)]
    pub fn between(a: DVec3, b: DVec3) -> Self {
        Self {
            sine2: T::of(0.25 * (a - b).length_squared()),
            cosine2: T::of(0.25 * (a + b).length_squared()),
        }
    }

    /// Coordinate from 0 forwards to 1 backwards, dense at both ends.
    #[inline(always)]
    pub fn coordinate(self) -> T {
        T::of(0.5) * (T::of(1.0) + self.sine2.sqrt().sqrt() - self.cosine2.sqrt().sqrt())
    }
}

impl HalfAngle<f32> {
    /// No angle.
    pub const FORWARDS: Self = Self {
        sine2: 0.0,
        cosine2: 1.0,
    };

    /// Interval that contains the angle, of a number of even ones in [`HalfAngle::coordinate`], and the part of it below the angle. Without
    /// branches: loops over many angles run in vector registers.
    #[inline(always)]
    pub fn among(self, intervals: usize) -> (i32, f32) {
        let position = self.coordinate().clamp(0.0, 1.0) * intervals as f32;
        let below = position.floor().min(intervals as f32 - 1.0);
        (whole(below), position - below)
    }
}

/// Cosine of the angle at a [`HalfAngle::coordinate`].
pub(crate) fn cosine_at(x: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let half_sine: f64 = 0.5 * (low + high);
        let sine2 = half_sine * half_sine;
        let angle = HalfAngle {
            sine2,
            cosine2: 1.0 - sine2,
        };
        match angle.coordinate() < x {
            true => low = half_sine,
            false => high = half_sine,
        }
    }
    let half_sine = 0.5 * (low + high);
    1.0 - 2.0 * half_sine * half_sine
}

/// Optical depths of the forward peak at which the sum of the streams can be exact.
const EXACT: (f64, f64) = (2.0, 5.0);

/// Cosines of the angles of the table.
static COSINES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let cosine = |k: usize| cosine_at(k as f64 / INTERVALS as f64);
    (0..=INTERVALS).map(cosine).collect()
});

/// Integrals from 0 to `s` of the weights of the rates 1 and 2 among 0, 1, 2. The weights sum to 1, have the mean rate `s`, and give
/// `exp(-s depth)` exactly.
fn integrals(s: f64, depth: f64) -> [f64; STREAMS - 1] {
    let lost = |rate: f64| -(-rate * depth).exp_m1();
    let of_first_order = 0.5 * s * s;
    let fast = (of_first_order * lost(1.0) - s + lost(s) / depth) / lost(1.0).powi(2);
    [of_first_order - 2.0 * fast, fast]
}

impl<const N: usize> Residual<N> {
    /// The streams of a phase function whose moments up to `degree` are kept, for light that passes about a scattering optical depth
    /// (0 if unknown); `None` without a forward peak.
    pub fn new(
        phase: &PhaseFunction,
        wavelengths_nm: &[f64; N],
        degree: usize,
        depth: f64,
    ) -> Option<Self> {
        if N > 1 && !phase.depends_on_wavelength() {
            let one = Residual::new(phase, &[wavelengths_nm[0]], degree, depth)?;
            let lanes = |[half, all]: &[Spectrum<1>; 2]| [half, all].map(|s| Spectrum::splat(s[0]));
            return Some(Self {
                shares: one.shares.iter().map(lanes).collect(),
            });
        }
        let chi = wavelengths_nm.map(|nm| phase.legendre_moments(MOMENTS, nm));
        let fractions: [f64; N] = std::array::from_fn(|lane| peak_fraction(chi[lane][degree + 1]));
        if fractions.iter().all(|&f| f < MIN_FRACTION) {
            return None;
        }
        let exact_at = fractions.map(|f| 0.5 * (f * depth).clamp(EXACT.0, EXACT.1));
        let ends = exact_at.map(|depth| integrals(2.0, depth));
        // The series of each share of the residual, times the phase function. Its moments end in a constant, that of a peak in
        // the direction of the sun: without it they vanish, and so the degrees kept gain the constant.
        let mut series: Vec<[[f64; N]; STREAMS - 1]> = (0..MOMENTS)
            .map(|l| {
                let scale = (2 * l + 1) as f64 / (4.0 * PI) * taper(l);
                let mut out = [[0.0; N]; STREAMS - 1];
                for lane in 0..N {
                    let f = fractions[lane];
                    let rate = match l > degree && f > 0.0 {
                        true => (2.0 * (f - chi[lane][l]) / f).clamp(0.0, 2.0),
                        false => 0.0,
                    };
                    let (here, end) = (integrals(rate, exact_at[lane]), ends[lane]);
                    for k in 0..STREAMS - 1 {
                        out[k][lane] = scale * 0.5 * f * (end[k] - here[k]);
                    }
                }
                out
            })
            .collect();
        let counts =
            |terms: &[[f64; N]; STREAMS - 1]| terms.iter().flatten().any(|term| term.abs() > 1e-9);
        let last = series.iter().rposition(counts);
        series.truncate(last.map_or(0, |last| last + 1));
        let cosines = &*COSINES;
        let blocks = parallel::map(cosines.len().div_ceil(BLOCK), |block| {
            let cosines = &cosines[block * BLOCK..];
            let nu: [f64; BLOCK] = std::array::from_fn(|k| *cosines.get(k).unwrap_or(&0.0));
            let sums = vectorized(
                #[inline(always)]
                || sums(&series, &nu),
            );
            let shares = |(sums, &nu): (&[[f64; N]; STREAMS - 1], &f64)| {
                let p = phase.in_lanes(nu, wavelengths_nm);
                sums.map(|sum| Spectrum(sum.map(|value| value as f32)) / p)
            };
            sums.iter().zip(cosines).map(shares).collect::<Vec<_>>()
        });
        Some(Self {
            shares: blocks.concat(),
        })
    }

    /// Shares at the cosine `nu` of the scattering angle.
    #[inline]
    pub fn shares(&self, nu: f64) -> Shares<N> {
        let x = HalfAngle::of_cosine(nu).coordinate();
        let Place { below, fraction } = Place::evenly(x, INTERVALS + 1);
        let (a, b) = (&self.shares[below], &self.shares[below + 1]);
        let [half, all] = [0, 1].map(|k| lerp(a[k], b[k], fraction as f32));
        [Spectrum::ONE - half - all, half, all]
    }
}

impl<const N: usize> Residual<N> {
    /// [`Self::shares`] at several cosines: by stream and lane.
    #[inline(always)]
    pub fn shares_along<const R: usize>(&self, nu: &[f64; R]) -> [[Spectrum<R>; N]; STREAMS] {
        let mut below = [0; R];
        let mut fractions = [0.0; R];
        for i in 0..R {
            (below[i], fractions[i]) = HalfAngle::of_cosine(nu[i]).among(INTERVALS);
        }
        let mut shares = [[Spectrum::ZERO; N]; STREAMS];
        for i in 0..R {
            let at = below[i] as usize;
            let (a, b) = (&self.shares[at], &self.shares[at + 1]);
            for lane in 0..N {
                let (near, far) = (1.0 - fractions[i], fractions[i]);
                let half = a[0][lane] * near + b[0][lane] * far;
                let all = a[1][lane] * near + b[1][lane] * far;
                shares[0][lane][i] = 1.0 - half - all;
                shares[1][lane][i] = half;
                shares[2][lane][i] = all;
            }
        }
        shares
    }
}

/// Sums of series of Legendre polynomials at several cosines.
#[inline(always)]
fn sums<const N: usize>(
    series: &[[[f64; N]; STREAMS - 1]],
    nu: &[f64; BLOCK],
) -> [[[f64; N]; STREAMS - 1]; BLOCK] {
    let mut sums = [[[0.0; N]; STREAMS - 1]; BLOCK];
    let (mut before, mut now) = ([0.0; BLOCK], [1.0; BLOCK]);
    for (l, terms) in series.iter().enumerate() {
        for (sums, now) in sums.iter_mut().zip(&now) {
            for (sums, terms) in sums.iter_mut().zip(terms) {
                for lane in 0..N {
                    sums[lane] += terms[lane] * now;
                }
            }
        }
        let l = l as f64;
        let (a, b) = ((2.0 * l + 1.0) / (l + 1.0), l / (l + 1.0));
        for k in 0..BLOCK {
            (before[k], now[k]) = (now[k], a * nu[k] * now[k] - b * before[k]);
        }
    }
    sums
}

/// Factor of the moments of degree `l`, which ends the series smoothly.
fn taper(l: usize) -> f64 {
    let x = l as f64 / MOMENTS as f64;
    (1.0 - x.powi(4)).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::legendre::legendre_series;

    const DEGREE: usize = 10;

    /// The streams of a phase function whose series converges, against the series of all orders: interpolation between the rates
    /// errs by up to 1 % of singly scattered light at a depth of 1 and 3 % at 4.
    #[test]
    fn streams_hold_all_orders_of_scattering_at_small_angles() {
        let g: f64 = 0.93;
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let residual = Residual::<4>::new(&phase, &[550.0; 4], DEGREE, 0.0).unwrap();
        let f = g.powi(DEGREE as i32 + 1);
        let low = |nu: f64| legendre_series(&[1.0; DEGREE + 1], nu);
        for (depth, limit) in [
            (0.1, 0.001),
            (0.5, 0.004),
            (1.0, 0.01),
            (2.0, 0.02),
            (4.0, 0.03),
        ] {
            // Without the constant to which the moments tend, that of a peak in the direction of the sun.
            let all: Vec<f64> = (0..800)
                .map(|l| match l <= DEGREE {
                    true => 0.0,
                    false => ((depth * (g.powi(l as i32) - f)).exp() - (-depth * f).exp()) / depth,
                })
                .collect();
            let kept = (1.0 - (-depth * f).exp()) / depth;
            for degrees in [0.5f64, 2.0, 5.0, 10.0, 30.0] {
                let nu = degrees.to_radians().cos();
                let p = phase.evaluate(nu, 550.0);
                let chi: Vec<f64> = (0..=DEGREE).map(|l| g.powi(l as i32)).collect();
                let first = p - legendre_series(&chi, nu) + f * low(nu);
                let exact = 1.0 + (legendre_series(&all, nu) + kept * low(nu) - first) / p;
                let streams = stream_transmittances(Spectrum::<4>::splat((depth * f) as f32));
                let got = f64::from(combined(&streams, &residual.shares(nu))[0]);
                assert!(
                    (got - exact).abs() < limit,
                    "{depth} {degrees}: {got} {exact}"
                );
            }
        }
    }

    #[test]
    fn shares_sum_to_one_and_smooth_phase_functions_have_none() {
        for phase in [
            PhaseFunction::Isotropic,
            PhaseFunction::HenyeyGreenstein { g: 0.4 },
        ] {
            assert!(Residual::<4>::new(&phase, &[550.0; 4], DEGREE, 0.0).is_none());
        }
        let phase = PhaseFunction::HenyeyGreenstein { g: 0.8 };
        let residual = Residual::<4>::new(&phase, &[550.0; 4], DEGREE, 0.0).unwrap();
        for nu in [-1.0, -0.3, 0.0, 0.9, 1.0] {
            let [a, b, c] = residual.shares(nu);
            assert!(((a + b + c)[0] - 1.0).abs() < 1e-5, "{nu}");
        }
    }
}
