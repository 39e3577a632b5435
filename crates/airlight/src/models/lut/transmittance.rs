//! Table of the transmittance to space by altitude and zenith angle.

use crate::math::interpolation::bilinear;
use crate::math::parallel;

/// Transmittance from any altitude and direction to the top of the atmosphere, for several wavelengths.
///
/// Parametrised as in E. Bruneton, "Precomputed Atmospheric Scattering: a New Implementation" (2017), section on
/// transmittance: by the distance to the horizon, and by the distance to the top between its smallest and its largest value.
/// Covers only rays that miss the ground. Bilinear interpolation.
pub struct TransmittanceTable {
    ground_radius_m: f64,
    top_radius_m: f64,
    size: [usize; 2],
    lanes: usize,
    values: Vec<f32>,
}

impl TransmittanceTable {
    /// Computes a table of `size` (zenith angles, altitudes; at least 2 each): `depth(radius_m, mu, out)` writes the optical
    /// depths to the top at the `lanes` wavelengths.
    pub fn new(
        (ground_radius_m, top_radius_m): (f64, f64),
        size: [usize; 2],
        lanes: usize,
        depth: impl Fn(f64, f64, &mut [f32]) + Sync,
    ) -> Self {
        let mut table = Self {
            ground_radius_m,
            top_radius_m,
            size,
            lanes,
            values: Vec::new(),
        };
        let mut values = vec![0.0; size[0] * size[1] * lanes];
        parallel::for_each_chunk(&mut values, lanes, |index, out| {
            let u = (index % size[0]) as f64 / (size[0] - 1) as f64;
            let v = (index / size[0]) as f64 / (size[1] - 1) as f64;
            let (radius_m, mu) = table.ray_at(u, v);
            depth(radius_m, mu, out);
            out.iter_mut().for_each(|tau| *tau = (-*tau).exp());
        });
        table.values = values;
        table
    }

    /// Interpolates the transmittance to space from `radius_m` (m, between ground and top) in a direction with zenith cosine
    /// `mu` that misses the ground, into `out`.
    pub fn look_up(&self, radius_m: f64, mu: f64, out: &mut [f32]) {
        out.fill(0.0);
        let (u, v) = self.coordinates(radius_m, mu);
        for (index, weight) in bilinear(u, v, self.size) {
            let sample = &self.values[index * self.lanes..][..self.lanes];
            for (o, s) in out.iter_mut().zip(sample) {
                *o += weight * s;
            }
        }
    }

    /// Half of the longest chord: from the horizon of the ground to the top.
    fn longest(&self) -> f64 {
        square_difference(self.top_radius_m, self.ground_radius_m).sqrt()
    }

    fn coordinates(&self, radius_m: f64, mu: f64) -> (f64, f64) {
        let r = radius_m.clamp(self.ground_radius_m, self.top_radius_m);
        let longest = self.longest();
        let horizon = square_difference(r, self.ground_radius_m).sqrt();
        let to_top = {
            let b = r * mu;
            let root = (b * b + square_difference(self.top_radius_m, r)).sqrt();
            // sqrt(b^2 + c) - b without cancellation.
            if b > 0.0 {
                square_difference(self.top_radius_m, r) / (root + b)
            } else {
                root - b
            }
        };
        let (least, greatest) = (self.top_radius_m - r, horizon + longest);
        ((to_top - least) / (greatest - least), horizon / longest)
    }

    /// Ray for coordinates of the table: inverse of [`Self::coordinates`].
    fn ray_at(&self, u: f64, v: f64) -> (f64, f64) {
        let longest = self.longest();
        let horizon = v * longest;
        let r = self.ground_radius_m.hypot(horizon);
        let (least, greatest) = (self.top_radius_m - r, horizon + longest);
        let d = least + u * (greatest - least);
        let mu = match d > 0.0 {
            true => (square_difference(self.top_radius_m, r) - d * d) / (2.0 * r * d),
            false => 1.0,
        };
        (r.min(self.top_radius_m), mu.clamp(-1.0, 1.0))
    }
}

/// `a^2 - b^2`, clamped to 0.
fn square_difference(a: f64, b: f64) -> f64 {
    ((a - b) * (a + b)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_round_trip() {
        let table = TransmittanceTable::new((6360e3, 6420e3), [9, 5], 1, |_, _, out| out.fill(0.0));
        for u in [0.0, 0.1, 0.5, 0.99, 1.0] {
            for v in [0.0, 0.2, 0.7, 0.999] {
                let (r, mu) = table.ray_at(u, v);
                let (u2, v2) = table.coordinates(r, mu);
                // For nearly vertical rays at the top the zenith angle has few significant digits.
                assert!(
                    (u - u2).abs() < 1e-6 && (v - v2).abs() < 1e-6,
                    "{u} {v}: {u2} {v2}"
                );
            }
        }
        let mut out = [0.0];
        table.look_up(6370e3, 0.3, &mut out);
        assert!((out[0] - 1.0).abs() < 1e-6);
    }
}
