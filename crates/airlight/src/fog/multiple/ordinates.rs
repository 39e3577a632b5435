//! Discrete ordinates in plane-parallel layers at one wavelength (Chandrasekhar 1960, Stamnes et al. 1988).
//!
//! Each azimuth mode is a two-point boundary value problem in optical depth, solved by invariant imbedding: from the ground up,
//! upward radiance is expressed as a linear function of downward radiance, `up = reflection * down + emission`, which is
//! stable; then radiance is evaluated from the top down. The equation of transfer is discretized by central differences, which
//! keep radiance positive in thin cells; thicker ones are built from thin ones by doubling (van de Hulst 1963).

use super::legendre::{self, COUNT, DEGREES};
use crate::math::quadrature::FixedRule;
use std::f64::consts::PI;

/// Number of polar angles in one hemisphere.
const HALF: usize = DEGREES / 2;

/// Optical depth above which a cell is built by doubling: central differences are positive up to twice the smallest cosine, 0.139.
const THICK: f64 = 0.1;
/// Optical depth to which all thick cells together are limited: about 1e-6 of the light passes without absorption, and rounding,
/// which doubles with the cells, stays far below.
const DEEPEST: f64 = 1e6;

type Vector = [f64; HALF];
type Matrix = [[f64; HALF]; HALF];

/// A homogeneous layer between two heights.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cell {
    /// Vertical optical depth.
    pub extinction: f64,
    /// Scattering optical depth times Legendre moment, for each `l`.
    pub scattering: [f64; DEGREES],
    /// Direct irradiance on a surface facing the sun, mean over the layer's optical depth.
    pub sunlight: f64,
}

impl Cell {
    /// A part of the optical depth of the layer.
    fn part(&self, part: f64) -> Self {
        Self {
            extinction: self.extinction * part,
            scattering: self.scattering.map(|s| s * part),
            sunlight: self.sunlight,
        }
    }
}

/// Boundary conditions: light from above and reflection at the ground.
#[derive(Clone, Copy, Debug)]
pub struct Boundary {
    /// Sine of the sun's elevation.
    pub sin_sun: f64,
    /// Isotropic radiance from above.
    pub sky: f64,
    /// Albedo of the Lambertian ground.
    pub albedo: f64,
    /// Direct irradiance of the sun on the horizontal ground.
    pub sun_on_ground: f64,
}

/// Moments of the diffuse radiance at each height from the top down, `1/2 int Y_lm I_m dmu`, and the total irradiance on the
/// ground.
pub struct Solution {
    pub moments: Vec<[f64; COUNT]>,
    pub ground_irradiance: f64,
}

/// Gauss points on `(0, 1)`, with weights that sum to 1.
struct Angles {
    cosine: Vector,
    weight: Vector,
    down: [[f64; COUNT]; HALF],
}

impl Angles {
    fn new() -> Self {
        static RULE: FixedRule<HALF> = FixedRule::fixed();
        let cosine = RULE.pairs().map(|(cosine, _)| cosine);
        Self {
            cosine,
            weight: RULE.pairs().map(|(_, weight)| weight),
            down: cosine.map(legendre::evaluate),
        }
    }
}

/// `(-1)^(l + m)`: ratio of the function at the opposite polar angle.
fn parity(l: usize, m: usize) -> f64 {
    if (l + m).is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Solves for the light in layers, ordered from the top down.
pub fn solve(cells: &[Cell], boundary: &Boundary) -> Solution {
    let angles = Angles::new();
    let mut solution = Solution {
        moments: vec![[0.0; COUNT]; cells.len() + 1],
        ground_irradiance: 0.0,
    };
    let sun = legendre::evaluate(boundary.sin_sun);
    let cells = &limited(cells);
    for m in 0..DEGREES {
        let lit = |cell: &Cell| {
            let source = (m..DEGREES).map(|l| cell.scattering[l] * sun[legendre::index(l, m)]);
            cell.sunlight != 0.0 && source.map(f64::abs).sum::<f64>() > 1e-9 * cell.extinction
        };
        // Only sunlight depends on azimuth.
        if m == 0 || cells.iter().any(lit) {
            solve_mode(m, cells, boundary, &angles, &sun, &mut solution);
        }
    }
    solution
}

/// Cells whose thick ones have at most [`DEEPEST`] optical depths together.
fn limited(cells: &[Cell]) -> Vec<Cell> {
    let is_thick = |cell: &&Cell| cell.extinction > THICK;
    let thick: f64 = cells.iter().filter(is_thick).map(|c| c.extinction).sum();
    let part = (DEEPEST / thick).min(1.0);
    let limit = |cell: &Cell| match is_thick(&cell) {
        true => cell.part(part),
        false => *cell,
    };
    cells.iter().map(limit).collect()
}

fn solve_mode(
    m: usize,
    cells: &[Cell],
    boundary: &Boundary,
    angles: &Angles,
    sun: &[f64; COUNT],
    solution: &mut Solution,
) {
    // Lambertian ground reflects into the azimuthal mean only.
    let mut reflection = Matrix::default();
    let mut emission = Vector::default();
    if m == 0 {
        for i in 0..HALF {
            for j in 0..HALF {
                reflection[i][j] = 2.0 * boundary.albedo * angles.cosine[j] * angles.weight[j];
            }
            emission[i] = boundary.albedo * boundary.sun_on_ground / PI;
        }
    }
    // From the ground up.
    let mut steps = Vec::with_capacity(cells.len());
    for cell in cells.iter().rev() {
        let step = match cell.extinction > THICK {
            false => Step::new(m, cell, angles, sun, &reflection, &emission),
            true => Step::by_doubling(m, cell, angles, sun).over(&reflection, &emission),
        };
        steps.push((reflection, emission, step.transmission, step.arriving));
        (reflection, emission) = (step.reflection, step.emission);
    }
    // From the top down.
    let mut down = [if m == 0 { boundary.sky } else { 0.0 }; HALF];
    let mut up = add(&emission, &times(&reflection, &down));
    store(m, &down, &up, angles, &mut solution.moments[0]);
    for (k, (reflection, emission, transmission, arriving)) in steps.iter().rev().enumerate() {
        down = add(arriving, &times(transmission, &down));
        up = add(emission, &times(reflection, &down));
        store(m, &down, &up, angles, &mut solution.moments[k + 1]);
    }
    if m == 0 {
        let diffuse: f64 = (0..HALF)
            .map(|j| 2.0 * PI * angles.cosine[j] * angles.weight[j] * down[j])
            .sum();
        solution.ground_irradiance = diffuse + boundary.sun_on_ground;
    }
}

/// A layer added on top of the layers below it.
struct Step {
    /// `up_above = reflection * down_above + emission`.
    reflection: Matrix,
    emission: Vector,
    /// `down_below = transmission * down_above + arriving`.
    transmission: Matrix,
    arriving: Vector,
}

impl Step {
    fn new(
        m: usize,
        cell: &Cell,
        angles: &Angles,
        sun: &[f64; COUNT],
        below: &Matrix,
        from_below: &Vector,
    ) -> Self {
        const TWO: usize = 2 * HALF;
        // Scattering within and between hemispheres, and of sunlight into each.
        let mut same = Matrix::default();
        let mut opposite = Matrix::default();
        let mut source_down = Vector::default();
        let mut source_up = Vector::default();
        let sunlight = cell.sunlight / (4.0 * PI) * if m == 0 { 1.0 } else { 2.0 };
        for l in m..DEGREES {
            let strength = (2 * l + 1) as f64 * cell.scattering[l];
            let at = legendre::index(l, m);
            for i in 0..HALF {
                let to = strength * angles.down[i][at];
                source_down[i] += sunlight * to * sun[at];
                source_up[i] += sunlight * to * sun[at] * parity(l, m);
                for j in 0..HALF {
                    let pair = 0.5 * to * angles.down[j][at] * angles.weight[j];
                    same[i][j] += pair;
                    opposite[i][j] += pair * parity(l, m);
                }
            }
        }
        // P d' - H u = Q d + H u' + s_down,  P u - H d' = Q u' + H d + s_up;  primes: below the layer.
        let part = |i: usize, j: usize, sign: f64| {
            let on = f64::from(u8::from(i == j));
            on * angles.cosine[i] + sign * 0.5 * (on * cell.extinction - same[i][j])
        };
        let p: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| part(i, j, 1.0)));
        let q: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| part(i, j, -1.0)));
        let h = opposite.map(|row| row.map(|v| 0.5 * v));
        let (h_below, q_below) = (product(&h, below), product(&q, below));
        let (h_source, q_source) = (times(&h, from_below), times(&q, from_below));
        // Unknowns: d', u. Right-hand sides: one for each component of d, one for the sources.
        let mut matrix = [[0.0; TWO]; TWO];
        let mut right = [[0.0; HALF + 1]; TWO];
        for i in 0..HALF {
            for j in 0..HALF {
                matrix[i][j] = p[i][j] - h_below[i][j];
                matrix[i][HALF + j] = -h[i][j];
                matrix[HALF + i][j] = -h[i][j] - q_below[i][j];
                matrix[HALF + i][HALF + j] = p[i][j];
                right[i][j] = q[i][j];
                right[HALF + i][j] = h[i][j];
            }
            right[i][HALF] = h_source[i] + source_down[i];
            right[HALF + i][HALF] = q_source[i] + source_up[i];
        }
        eliminate(&mut matrix, &mut right);
        Self {
            transmission: std::array::from_fn(|i| std::array::from_fn(|j| right[i][j])),
            arriving: std::array::from_fn(|i| right[i][HALF]),
            reflection: std::array::from_fn(|i| std::array::from_fn(|j| right[HALF + i][j])),
            emission: std::array::from_fn(|i| right[HALF + i][HALF]),
        }
    }

    /// A cell of any optical depth over nothing.
    fn by_doubling(m: usize, cell: &Cell, angles: &Angles, sun: &[f64; COUNT]) -> Self {
        let doublings = (cell.extinction / THICK).log2().ceil().max(0.0);
        let thin = cell.part((-doublings).exp2());
        let (nothing, dark) = (Matrix::default(), Vector::default());
        let mut slab = Self::new(m, &thin, angles, sun, &nothing, &dark);
        for _ in 0..doublings as usize {
            // Light between the halves, and on through the lower one.
            let middle = slab.over(&slab.reflection, &slab.emission);
            slab = Self {
                transmission: product(&slab.transmission, &middle.transmission),
                arriving: add(&slab.arriving, &times(&slab.transmission, &middle.arriving)),
                ..middle
            };
        }
        slab
    }

    /// A homogeneous layer over nothing, on top of the layers below it. All terms are sums of light that has been reflected
    /// between both, so that nothing cancels.
    fn over(&self, below: &Matrix, from_below: &Vector) -> Self {
        // down_below = transmission * down + arriving + reflection * up_below,  up_below = below * down_below + from_below.
        let echo = product(&self.reflection, below);
        let mut matrix: Matrix = std::array::from_fn(|i| {
            std::array::from_fn(|j| f64::from(u8::from(i == j)) - echo[i][j])
        });
        let source = add(&self.arriving, &times(&self.reflection, from_below));
        let mut right: [[f64; HALF + 1]; HALF] = std::array::from_fn(|i| {
            std::array::from_fn(|j| match j < HALF {
                true => self.transmission[i][j],
                false => source[i],
            })
        });
        eliminate(&mut matrix, &mut right);
        let transmission: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| right[i][j]));
        let arriving: Vector = std::array::from_fn(|i| right[i][HALF]);
        let back = product(&self.transmission, below);
        let returned = product(&back, &transmission);
        let upward = add(from_below, &times(below, &arriving));
        Self {
            reflection: std::array::from_fn(|i| {
                std::array::from_fn(|j| self.reflection[i][j] + returned[i][j])
            }),
            emission: add(&self.emission, &times(&self.transmission, &upward)),
            transmission,
            arriving,
        }
    }
}

/// Stores the moments of mode `m` of the radiance at the polar angles.
fn store(m: usize, down: &Vector, up: &Vector, angles: &Angles, moments: &mut [f64; COUNT]) {
    for l in m..DEGREES {
        let at = legendre::index(l, m);
        moments[at] = (0..HALF)
            .map(|j| 0.5 * angles.weight[j] * angles.down[j][at] * (down[j] + parity(l, m) * up[j]))
            .sum();
    }
}

/// Gaussian elimination with pivoting. Solutions replace the right-hand sides.
fn eliminate<const N: usize, const R: usize>(
    matrix: &mut [[f64; N]; N],
    right: &mut [[f64; R]; N],
) {
    for k in 0..N {
        let largest = |a: &usize, b: &usize| matrix[*a][k].abs().total_cmp(&matrix[*b][k].abs());
        let pivot = (k..N).max_by(largest).unwrap_or(k);
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        for i in k + 1..N {
            let factor = matrix[i][k] / matrix[k][k];
            for j in k..N {
                matrix[i][j] -= factor * matrix[k][j];
            }
            for j in 0..R {
                right[i][j] -= factor * right[k][j];
            }
        }
    }
    for k in (0..N).rev() {
        for j in 0..R {
            let known: f64 = (k + 1..N).map(|i| matrix[k][i] * right[i][j]).sum();
            right[k][j] = (right[k][j] - known) / matrix[k][k];
        }
    }
}

fn times(matrix: &Matrix, vector: &Vector) -> Vector {
    matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|j| (0..HALF).map(|k| row[k] * b[k][j]).sum()))
}

fn add(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One thick cell is many thin ones, and light stays positive and conserved however thick it is.
    #[test]
    fn thick_cells_are_built_from_thin_ones() {
        let boundary = Boundary {
            sin_sun: 0.5,
            sky: 1.0,
            albedo: 0.3,
            sun_on_ground: 0.0,
        };
        for (depth, albedo) in [(1.0, 0.9), (8.0, 1.0), (60.0, 0.999)] {
            let thin = solve(
                &slab(depth, (depth / 0.02) as usize, albedo, 0.8),
                &boundary,
            );
            let thick = solve(&slab(depth, 1, albedo, 0.8), &boundary);
            let (got, want) = (thick.ground_irradiance, thin.ground_irradiance);
            assert!((got / want - 1.0).abs() < 2e-3, "{depth}: {got} {want}");
        }
        let mut last = f64::INFINITY;
        for depth in [1e2, 1e3, 1e5, 1e6, 1e12, 1e24] {
            let light = solve(&slab(depth, 1, 1.0, 0.8), &boundary).ground_irradiance;
            let many = solve(&slab(depth, 300, 1.0, 0.8), &boundary).ground_irradiance;
            assert!((many / light - 1.0).abs() < 0.01, "{depth}: {many} {light}");
            assert!(
                light > 0.0 && light <= last * (1.0 + 1e-5),
                "{depth}: {light} after {last}"
            );
            // Diffusion: the transmittance is about 4 / (3 (1 - g) depth).
            let expected = PI * 4.0 / (3.0 * 0.2 * depth.min(DEEPEST)) / (1.0 - 0.3);
            assert!(
                depth < 1e3 || (light / expected - 1.0).abs() < 0.1,
                "{light} {expected}"
            );
            last = light;
        }
    }

    fn slab(depth: f64, cells: usize, albedo: f64, g: f64) -> Vec<Cell> {
        let each = depth / cells as f64;
        let scattering = std::array::from_fn(|l| each * albedo * g.powi(l as i32));
        vec![
            Cell {
                extinction: each,
                scattering,
                sunlight: 0.0,
            };
            cells
        ]
    }

    #[test]
    fn uniform_light_stays_uniform() {
        for depth in [0.01, 1.0, 100.0] {
            let boundary = Boundary {
                sin_sun: 0.5,
                sky: 2.0,
                albedo: 1.0,
                sun_on_ground: 0.0,
            };
            let solution = solve(&slab(depth, 20, 1.0, 0.6), &boundary);
            assert!((solution.ground_irradiance - 2.0 * PI).abs() < 1e-9);
            for moments in &solution.moments {
                // The moment l = 0 is the radiance; all others are 0.
                assert!((moments[0] - 2.0).abs() < 1e-9, "{}", moments[0]);
                assert!(moments[1..].iter().all(|m| m.abs() < 1e-9));
            }
        }
    }

    #[test]
    fn energy_is_conserved_without_absorption() {
        // Sunlight on a slab without absorption over black ground leaves at the top or reaches the ground.
        let (depth, count, m) = (2.0, 60, 0.6);
        let mut cells = slab(depth, count, 1.0, 0.5);
        let each = depth / count as f64;
        for (k, cell) in cells.iter_mut().enumerate() {
            let top = k as f64 * each / m;
            cell.sunlight = (-top).exp() * -(-each / m).exp_m1() / (each / m);
        }
        let direct = m * f64::exp(-depth / m);
        let boundary = Boundary {
            sin_sun: m,
            sky: 0.0,
            albedo: 0.0,
            sun_on_ground: direct,
        };
        let solution = solve(&cells, &boundary);
        // Net downward flux: 4 pi times the moment l = 1.
        let top = 4.0 * PI * solution.moments[0][1];
        let bottom = 4.0 * PI * solution.moments[count][1];
        assert!((top + m - bottom - direct).abs() < 1e-9, "{top} {bottom}");
        assert!((solution.ground_irradiance - bottom - direct).abs() < 1e-9);
    }
}
