//! Slant columns of each constituent from any point to space, for transmittance to the sun.
//!
//! Integrated once on a grid of altitudes and zenith angles, for all wavelengths. The table stores the inverse air mass
//! `N(r, 1) / N(r, mu)`, which is close to `mu` at high elevations and smooth down to the horizon, so that cubic
//! interpolation is accurate to about 1e-4 (see the test).

use crate::math::interpolation::{Place, cubic, hermite_weights};
use crate::math::parallel;
use crate::math::quadrature::FixedRule;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent, Shell};

/// Number of altitudes, uniform in [`Shell::altitude_coordinate`].
const ALTITUDES: usize = 64;
/// Number of zenith angles, uniform in `sqrt(mu)`: dense near the horizon.
const ANGLES: usize = 64;
/// Number of nodes in the finer table of vertical columns.
const VERTICAL: usize = 1024;
/// Quadrature rule for each panel of a ray.
static RULE: FixedRule<4> = FixedRule::fixed();

/// Columns of every constituent from any point of a shell to space.
#[derive(Clone, Debug)]
pub struct SlantColumns {
    /// The shell.
    pub shell: Shell,
    /// Uniform in the altitude coordinate: the vertical column and its slope in that coordinate.
    vertical: Vec<[PerConstituent; 2]>,
    /// `[altitude][angle]`.
    inverse_air_mass: Vec<[f32; MAX_CONSTITUENTS]>,
}

/// Columns from one altitude.
pub struct ColumnRow {
    vertical: [f32; MAX_CONSTITUENTS],
    inverse_air_mass: [[f32; MAX_CONSTITUENTS]; ANGLES],
}

/// Columns along a ray to space that misses the ground, from those along rays that climb (`upward(radius_m, mu)`, `mu >= 0`).
/// A ray that starts downwards first passes its lowest point: `N = 2 N(tangent, 0) - N(r, -mu)`.
#[inline(always)]
pub fn slant_columns<const C: usize>(
    (radius_m, mu): (f64, f64),
    ground_radius_m: f64,
    upward: impl Fn(f64, f64) -> [f64; C],
) -> [f64; C] {
    if mu >= 0.0 {
        return upward(radius_m, mu);
    }
    let tangent = (radius_m * (1.0 - mu * mu).max(0.0).sqrt()).max(ground_radius_m);
    let (beyond, above) = (upward(tangent, 0.0), upward(radius_m, -mu));
    std::array::from_fn(|c| (2.0 * beyond[c] - above[c]).max(0.0))
}

impl ColumnRow {
    /// Columns from this altitude along `mu >= 0` to the top of the atmosphere, in metres at density 1.
    #[inline(always)]
    pub fn to_space_m(&self, mu: f32) -> [f32; MAX_CONSTITUENTS] {
        let (first, weights) = cubic(f64::from(mu.sqrt()), ANGLES);
        let mut inverse = [0.0f32; MAX_CONSTITUENTS];
        for (entry, w) in self.inverse_air_mass[first..first + 4].iter().zip(weights) {
            for c in 0..MAX_CONSTITUENTS {
                inverse[c] += w as f32 * entry[c];
            }
        }
        let mut columns = self.vertical;
        for c in 0..MAX_CONSTITUENTS {
            columns[c] /= if inverse[c] > 1e-6 { inverse[c] } else { 1e-6 };
        }
        columns
    }
}

impl SlantColumns {
    /// Integrates the columns of a shell.
    pub fn new(shell: Shell) -> Self {
        let vertical = (0..VERTICAL)
            .map(|i| {
                let x = i as f64 / (VERTICAL - 1) as f64;
                let radius_m = shell.radius_of_coordinate(x);
                let stretch = 2.0 * x * shell.thickness_m();
                [
                    shell.vertical_columns_m(radius_m),
                    shell
                        .densities_at(radius_m)
                        .map(|density| -density * stretch),
                ]
            })
            .collect();
        let rows: Vec<Vec<[f32; MAX_CONSTITUENTS]>> = parallel::map(ALTITUDES, |i| {
            let radius_m = shell.radius_of_coordinate(i as f64 / (ALTITUDES - 1) as f64);
            let zenith = shell.integrate_columns_m(radius_m, 1.0, &RULE);
            (0..ANGLES)
                .map(|j| {
                    let mu = (j as f64 / (ANGLES - 1) as f64).powi(2);
                    let slant = shell.integrate_columns_m(radius_m, mu, &RULE);
                    std::array::from_fn(|c| (zenith[c] / slant[c]) as f32)
                })
                .collect()
        });
        let mut inverse_air_mass = rows.concat();
        // Above the last air of a constituent its air mass is undefined: the value below is continued upwards, so that
        // interpolation just beneath stays smooth.
        let mut below = [[1.0f32; MAX_CONSTITUENTS]; ANGLES];
        for row in inverse_air_mass.chunks_exact_mut(ANGLES) {
            for (entry, below) in row
                .as_flattened_mut()
                .iter_mut()
                .zip(below.as_flattened_mut())
            {
                if entry.is_finite() {
                    *below = *entry;
                } else {
                    *entry = *below;
                }
            }
        }
        Self {
            shell,
            vertical,
            inverse_air_mass,
        }
    }

    /// Columns from `radius_m` along `mu` to the top of the atmosphere for a ray that misses the ground, in metres at density 1.
    #[inline(always)]
    pub fn to_space_m(&self, radius_m: f64, mu: f64) -> PerConstituent {
        slant_columns(
            (radius_m, mu),
            self.shell.ground_radius_m,
            #[inline(always)]
            |radius_m, mu| self.upward_m(radius_m, mu),
        )
    }

    #[inline(always)]
    fn upward_m(&self, radius_m: f64, mu: f64) -> PerConstituent {
        let x = self.shell.altitude_coordinate(radius_m);
        let vertical = self.vertical_m(x);
        let (row, row_weights) = cubic(x, ALTITUDES);
        let (column, column_weights) = cubic(mu.sqrt(), ANGLES);
        let mut inverse = [0.0f32; MAX_CONSTITUENTS];
        for (i, wi) in row_weights.iter().enumerate() {
            let entries = &self.inverse_air_mass[(row + i) * ANGLES + column..][..4];
            for (entry, wj) in entries.iter().zip(&column_weights) {
                let w = (wi * wj) as f32;
                for c in 0..MAX_CONSTITUENTS {
                    inverse[c] += w * entry[c];
                }
            }
        }
        let mut columns = vertical;
        for c in 0..MAX_CONSTITUENTS {
            columns[c] /= f64::from(if inverse[c] > 1e-6 { inverse[c] } else { 1e-6 });
        }
        columns
    }

    /// The columns from one radius, for evaluation at many zenith angles.
    #[inline(always)]
    pub fn at(&self, radius_m: f64) -> ColumnRow {
        let x = self.shell.altitude_coordinate(radius_m);
        let (first, weights) = cubic(x, ALTITUDES);
        let mut row = ColumnRow {
            vertical: self.vertical_m(x).map(|column| column as f32),
            inverse_air_mass: [[0.0; MAX_CONSTITUENTS]; ANGLES],
        };
        for (i, w) in weights.iter().enumerate() {
            let entries = &self.inverse_air_mass[(first + i) * ANGLES..][..ANGLES];
            for (sum, entry) in row.inverse_air_mass.iter_mut().zip(entries) {
                for c in 0..MAX_CONSTITUENTS {
                    sum[c] += *w as f32 * entry[c];
                }
            }
        }
        row
    }

    /// Hermite interpolation of the vertical columns, with the densities as slopes.
    #[inline(always)]
    fn vertical_m(&self, x: f64) -> PerConstituent {
        let Place { below, fraction } = Place::evenly(x, VERTICAL);
        let ([h0, h1], slopes) = hermite_weights(fraction);
        let [s0, s1] = slopes.map(|s| s * (1.0 / (VERTICAL - 1) as f64));
        let ([v0, d0], [v1, d1]) = (&self.vertical[below], &self.vertical[below + 1]);
        std::array::from_fn(|c| (h0 * v0[c] + h1 * v1[c] + s0 * d0[c] + s1 * d1[c]).max(0.0))
    }
}
