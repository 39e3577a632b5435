//! Scattering amplitudes of spheres by angle.
//!
//! `S_1 = sum c_n (a_n pi_n + b_n tau_n)`, `S_2 = sum c_n (a_n tau_n + b_n pi_n)` with `c_n = (2 n + 1) / (n (n + 1))` (BH eq.
//! 4.74), summed as `S_1 + S_2 = sum c_n (a_n + b_n) (pi_n + tau_n)` and `S_1 - S_2 = sum c_n (a_n - b_n) (pi_n - tau_n)`: half
//! the work (Wiscombe 1980), without cancellation near 0 and 180 degrees, where one of the two vanishes.

use super::coefficients::Coefficients;
use super::matrix::ScatteringMatrix;
use num_complex::Complex64;

/// Number of angles summed in parallel.
pub(super) const LANES: usize = 16;
type Lanes = [f32; LANES];

/// `c_n (pi_n + tau_n)` and `c_n (pi_n - tau_n)` at some angles, for `n = 1, 2 ..`, which do not depend on the sphere.
///
/// In single precision, for sums over many spheres: amplitudes are accurate to about 1e-6 of their largest term.
pub(super) struct Angles(Vec<[Lanes; 2]>);

/// `a_n + b_n` and `a_n - b_n`, real and imaginary parts, times a common factor.
pub(super) type Pair = [f32; 4];

/// The pairs of all orders, times a factor.
pub(super) fn pairs(coefficients: &Coefficients, factor: f64) -> impl Iterator<Item = Pair> {
    let both = coefficients.a.iter().zip(&coefficients.b);
    both.map(move |(a, b)| {
        let (sum, difference) = ((a + b) * factor, (a - b) * factor);
        [sum.re, sum.im, difference.re, difference.im].map(|part| part as f32)
    })
}

impl Angles {
    /// Computes `terms` orders at the given cosines.
    pub fn new(cosines: &[f64; LANES], terms: usize) -> Self {
        let mut waves = cosines.map(Wave::new);
        let both = |_| {
            let mut rows = [[0.0; LANES]; 2];
            for (lane, wave) in waves.iter_mut().enumerate() {
                [rows[0][lane], rows[1][lane]] = wave.next_pair().map(|part| part as f32);
            }
            rows
        };
        Self((0..terms).map(both).collect())
    }

    /// Adds the unnormalised scattering matrix of a sphere (`S_11` etc.) at each angle, times `weight`.
    ///
    /// Inlined into its caller, which runs it with wide vectors.
    #[inline(always)]
    pub fn add(&self, pairs: &[Pair], weight: f64, into: &mut [ScatteringMatrix; LANES]) {
        let mut sums = [[0.0; LANES]; 4];
        for ([plus, minus], pair) in self.0.iter().zip(pairs) {
            for lane in 0..LANES {
                sums[0][lane] += pair[0] * plus[lane];
                sums[1][lane] += pair[1] * plus[lane];
                sums[2][lane] += pair[2] * minus[lane];
                sums[3][lane] += pair[3] * minus[lane];
            }
        }
        for lane in 0..LANES {
            let [re, im, re_difference, im_difference] = sums.map(|part| f64::from(part[lane]));
            let (sum, difference) = (
                Complex64::new(re, im),
                Complex64::new(re_difference, im_difference),
            );
            let amplitudes = [0.5 * (sum + difference), 0.5 * (sum - difference)];
            let matrix = ScatteringMatrix::of(amplitudes);
            into[lane].f11 += weight * matrix.f11;
            into[lane].f12 += weight * matrix.f12;
            into[lane].f33 += weight * matrix.f33;
            into[lane].f34 += weight * matrix.f34;
        }
    }
}

/// `S_1` and `S_2` at one cosine.
pub(super) fn amplitudes(coefficients: &Coefficients, cos_angle: f64) -> [Complex64; 2] {
    let mut wave = Wave::new(cos_angle);
    let (mut plus, mut minus) = (Complex64::ZERO, Complex64::ZERO);
    for (a, b) in coefficients.a.iter().zip(&coefficients.b) {
        let [sum, difference] = wave.next_pair();
        plus += (a + b) * sum;
        minus += (a - b) * difference;
    }
    [0.5 * (plus + minus), 0.5 * (plus - minus)]
}

/// Upward recurrence of `pi_n` and `tau_n` from `n = 1` (BH eq. 4.47).
struct Wave {
    cosine: f64,
    order: f64,
    now: f64,
    before: f64,
}

impl Wave {
    fn new(cosine: f64) -> Self {
        Self {
            cosine,
            order: 1.0,
            now: 1.0,
            before: 0.0,
        }
    }

    /// Returns `c_n (pi_n + tau_n)` and `c_n (pi_n - tau_n)` and advances to the next order. With `s = mu pi_n` and
    /// `t = s - pi_(n-1)`, `tau_n = n t - pi_(n-1)` and `pi_(n+1) = s + (n + 1) / n t`.
    fn next_pair(&mut self) -> [f64; 2] {
        let n = self.order;
        let scaled = self.cosine * self.now;
        let turned = scaled - self.before;
        let tau = n * turned - self.before;
        let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
        let pair = [weight * (self.now + tau), weight * (self.now - tau)];
        self.before = self.now;
        self.now = scaled + (n + 1.0) / n * turned;
        self.order = n + 1.0;
        pair
    }
}
