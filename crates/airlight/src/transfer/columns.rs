//! Slant columns of each constituent from any point to space, for transmittance to the sun.
//!
//! The shell is divided into panels without kinks, in each of which every density is a cubic in the squared radius. The
//! squared radius is a parabola in the distance along a ray, so the column from a point to the upper edge of its panel is a
//! polynomial. The columns from the edges on depend on one angle only; the table of each edge stores the inverse air mass
//! `N(1) / N(mu)`, which is nearly linear, in intervals of `mu` that grow with it. Nothing is interpolated between radii, so
//! kinks and thin layers are exact. Transmittances are within 5e-4 of quadrature at every height and angle (see the test).

use crate::math::interpolation::interval_of;
use crate::math::parallel;
use crate::math::quadrature::FixedRule;
use crate::math::real::Real;
use crate::spectrum::Spectrum;
use crate::transfer::march::panel_edges;
use crate::transfer::ray::Ray;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent, Shell, count_evaluation, divided};

/// Intervals of the table in an octave of `1 + mu / scale`, as a power of two.
const OCTAVE_BITS: u32 = 2;
/// Bits of a mantissa below those that number the interval.
const FRACTION_BITS: u32 = f32::MANTISSA_DIGITS - 1 - OCTAVE_BITS;
/// Nodes of the cubics in a panel: Gauss nodes, which make the column of the whole panel exact to the seventh degree.
static NODES: FixedRule<4> = FixedRule::fixed();

/// Columns of every constituent from any point of a shell to space.
#[derive(Clone, Debug)]
pub struct SlantColumns {
    /// The shell.
    pub shell: Shell,
    /// Radii of the edges of panels from the ground to the top, m.
    radii_m: Vec<f64>,
    /// One less than there are edges.
    panels: Vec<Panel>,
    /// The air above each panel.
    above: Vec<Above>,
}

/// The air between two radii.
#[derive(Clone, Debug)]
struct Panel {
    /// Radius of the upper edge, m.
    top_m: f64,
    /// Difference of the squared radii of the edges, in squares of the upper radius.
    width: f64,
    per_width: f32,
    /// Densities times the upper radius, m, by power of the fraction of the width below the upper edge.
    columns_m: [Spectrum<MAX_CONSTITUENTS>; 4],
}

/// Columns from a radius to space by zenith angle.
#[derive(Clone, Debug)]
struct Above {
    /// Inverse of the cosine of the zenith angle over which the columns change.
    per_scale: f32,
    /// Vertical columns, m.
    vertical_m: Spectrum<MAX_CONSTITUENTS>,
    /// Inverse air masses in each interval, by power of the fraction of the interval.
    inverse_air_mass: Vec<[Spectrum<MAX_CONSTITUENTS>; 4]>,
}

/// Columns from one radius.
pub struct ColumnRow<'a> {
    all: &'a SlantColumns,
    radius_m: f64,
    panel: &'a Panel,
    above: &'a Above,
    /// The radius, in radii of the upper edge of its panel.
    radius: f32,
    /// Difference of the squared radii of that edge and of the point, in squares of the upper radius.
    drop: f32,
}

/// Columns along a ray to space that misses the ground, from those along rays that climb (`upward(radius_m, mu)`, `mu >= 0`).
/// A ray that starts downwards first passes its lowest point: `N = 2 N(tangent, 0) - N(r, -mu)`.
#[inline(always)]
pub fn slant_columns<T: Real, const C: usize>(
    (radius_m, mu): (f64, f64),
    ground_radius_m: f64,
    upward: impl Fn(f64, f64) -> [T; C],
) -> [T; C] {
    if mu >= 0.0 {
        return upward(radius_m, mu);
    }
    let tangent = (radius_m * ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt()).max(ground_radius_m);
    let (beyond, above) = (upward(tangent, 0.0), upward(radius_m, -mu));
    std::array::from_fn(|c| {
        let column = T::of(2.0) * beyond[c] - above[c];
        if column > T::of(0.0) {
            column
        } else {
            T::of(0.0)
        }
    })
}

/// Integrals of the powers 0 to 3 of `fraction` over a chord of a panel that ends at its upper edge, where the cosine of the
/// zenith angle is `mu`, of a panel with the inverse of this width. The length of the chord is in radii of the edge, and the
/// integrals in the same unit.
#[inline(always)]
fn moments<T: Real>(mu: T, length: T, per_width: T) -> [T; 4] {
    // At the part s of the chord from its end: fraction = a s + b s^2.
    let widths = length * per_width;
    let a = T::of(2.0) * mu * widths;
    let b = -length * widths;
    let (aa, ab, bb) = (a * a, a * b, b * b);
    [
        length,
        length * (a * T::of(1.0 / 2.0) + b * T::of(1.0 / 3.0)),
        length * (aa * T::of(1.0 / 3.0) + ab * T::of(1.0 / 2.0) + bb * T::of(1.0 / 5.0)),
        length
            * (a * (aa * T::of(1.0 / 4.0) + ab * T::of(3.0 / 5.0) + bb * T::of(1.0 / 2.0))
                + b * bb * T::of(1.0 / 7.0)),
    ]
}

/// Coefficients by power of the cubic through four points.
fn cubic_through(x: [f64; 4], values: [f64; 4]) -> [f64; 4] {
    // Newton's divided differences, then Horner's scheme.
    let mut differences = values;
    for order in 1..4 {
        for k in (order..4).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (x[k] - x[k - order]);
        }
    }
    let mut powers = [differences[3], 0.0, 0.0, 0.0];
    for k in (0..3).rev() {
        for power in (0..4).rev() {
            let below = if power > 0 {
                powers[power - 1]
            } else {
                differences[k]
            };
            powers[power] = below - x[k] * powers[power];
        }
    }
    powers
}

/// Cubics of the densities between two radii, by power of the fraction of the squared radius below the upper one.
fn fit(shell: &Shell, below_m: f64, above_m: f64) -> [PerConstituent; 4] {
    let values = NODES
        .pairs()
        .map(|(x, _)| shell.densities_at(radius_below(below_m, above_m, x)));
    cubics_through(NODES.pairs().map(|(x, _)| x), values)
}

/// [`cubic_through`] for every constituent, by power.
fn cubics_through(x: [f64; 4], values: [PerConstituent; 4]) -> [PerConstituent; 4] {
    let mut powers = [[0.0; MAX_CONSTITUENTS]; 4];
    for c in 0..MAX_CONSTITUENTS {
        let cubic = cubic_through(x, values.map(|v| v[c]));
        for (power, value) in powers.iter_mut().zip(cubic) {
            power[c] = value;
        }
    }
    powers
}

/// Radius at a fraction of the squared radius from the upper of two radii to the lower.
fn radius_below(below_m: f64, above_m: f64, fraction: f64) -> f64 {
    above_m
        - fraction * (above_m - below_m) * (above_m + below_m)
            / (above_m
                + (above_m * above_m * (1.0 - fraction) + below_m * below_m * fraction).sqrt())
}

/// Whether cubics represent the densities between two radii, or the error could not be seen through the longest chord.
fn is_cubic(shell: &Shell, below_m: f64, above_m: f64) -> bool {
    /// Largest relative error of a density.
    const TOLERANCE: f64 = 3e-4;
    /// Optical depth that may be neglected.
    const FAINT: f64 = 1e-6;
    let chord_m = 2.0 * ((above_m - below_m) * (above_m + below_m)).sqrt();
    let powers = fit(shell, below_m, above_m);
    // At the ends just inside, as a density may jump there.
    [1e-6, 0.25, 0.5, 0.75, 1.0 - 1e-6].into_iter().all(|x| {
        let densities = shell.densities_at(radius_below(below_m, above_m, x));
        (0..shell.constituents()).all(|c| {
            let [p0, p1, p2, p3] = powers.map(|power| power[c]);
            let error = (p0 + x * (p1 + x * (p2 + x * p3)) - densities[c]).abs();
            error <= TOLERANCE * densities[c]
                || error * shell.max_extinction_per_m[c] * chord_m <= FAINT
        })
    })
}

/// Rounded to single precision.
fn rounded(values: PerConstituent) -> Spectrum<MAX_CONSTITUENTS> {
    Spectrum(values.map(|value| value as f32))
}

impl Panel {
    /// The panel between two radii, without columns above.
    fn new(shell: &Shell, below_m: f64, above_m: f64) -> Self {
        let width = (above_m - below_m) * (above_m + below_m) / (above_m * above_m);
        Self {
            top_m: above_m,
            width,
            per_width: width.recip() as f32,
            columns_m: fit(shell, below_m, above_m)
                .map(|power| rounded(power.map(|value| value * above_m))),
        }
    }
}

impl Above {
    /// Columns through all of `panels` from `radius_m`, the lower edge of the first.
    fn new(radius_m: f64, panels: &[Panel], constituents: usize) -> Self {
        let slant_m = |mu: f64| {
            // Distance from the point of the ray closest to the planet's centre.
            let mut from_m = radius_m * mu;
            let mut columns = [0.0; MAX_CONSTITUENTS];
            for panel in panels {
                let drop = panel.width * panel.top_m * panel.top_m;
                let to_m = (from_m * from_m + drop).sqrt();
                let length = drop / (to_m + from_m) / panel.top_m;
                let moments = moments(to_m / panel.top_m, length, panel.width.recip());
                for (c, column) in columns[..constituents].iter_mut().enumerate() {
                    let powers = panel.columns_m.iter().zip(moments);
                    let inside: f64 = powers.map(|(power, m)| f64::from(power[c]) * m).sum();
                    *column += inside.max(0.0);
                }
                from_m = to_m;
            }
            columns
        };
        // They change most where the closest point is just below the first panel.
        let scale = panels.first().map_or(1.0, |first| first.width.sqrt());
        let vertical_m = slant_m(1.0);
        let inverse_air_mass = |mu: f64| {
            let slant_m = slant_m(mu);
            std::array::from_fn(|c| match vertical_m[c] > 0.0 {
                true => vertical_m[c] / slant_m[c],
                false => 1.0,
            })
        };
        let intervals = 1 + place_in_octaves((1.0 + 1.0 / scale) as f32).0;
        Self {
            per_scale: scale.recip() as f32,
            vertical_m: rounded(vertical_m),
            inverse_air_mass: (0..intervals)
                .map(|interval| {
                    let x = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
                    let values = x.map(|x| {
                        let (octave, part) =
                            (interval >> OCTAVE_BITS, interval % (1 << OCTAVE_BITS));
                        let step = (part as f64 + x) / f64::from(1 << OCTAVE_BITS);
                        let ratio = (1.0 + step) * 2f64.powi(octave as i32);
                        inverse_air_mass((ratio - 1.0) * scale)
                    });
                    cubics_through(x, values).map(rounded)
                })
                .collect(),
        }
    }

    /// Columns in metres at density 1.
    #[inline(always)]
    fn to_space_m(&self, mu: f32) -> Spectrum<MAX_CONSTITUENTS> {
        let (interval, x) = place_in_octaves(1.0 + mu * self.per_scale);
        let [p0, p1, p2, p3] =
            &self.inverse_air_mass[interval.min(self.inverse_air_mass.len() - 1)];
        let inverse = p0.scale_acc(p1.scale_acc(p2.scale_acc(*p3, x), x), x);
        self.vertical_m / inverse
    }
}

/// Index of the interval that contains a number from 1 up, and the fraction of the interval below it. The intervals divide
/// each octave evenly, so both are bits of the number.
#[inline(always)]
fn place_in_octaves(ratio: f32) -> (usize, f32) {
    let bits = ratio.to_bits().saturating_sub(1f32.to_bits());
    let fraction = (bits & ((1 << FRACTION_BITS) - 1)) as f32;
    (
        (bits >> FRACTION_BITS) as usize,
        fraction * (1.0 / (1u32 << FRACTION_BITS) as f32),
    )
}

impl ColumnRow<'_> {
    /// Columns from this radius along `mu` to the top of the atmosphere for a ray that misses the ground, in metres at density 1.
    #[inline(always)]
    pub fn to_space_m(&self, mu: f64) -> [f32; MAX_CONSTITUENTS] {
        slant_columns(
            (self.radius_m, mu),
            self.all.shell.ground_radius_m,
            #[inline(always)]
            |radius_m, mu| match radius_m == self.radius_m {
                true => self.upward_m(mu as f32),
                false => self.all.at(radius_m).upward_m(mu as f32),
            },
        )
    }

    /// The same along `mu >= 0`.
    #[inline(always)]
    fn upward_m(&self, mu: f32) -> [f32; MAX_CONSTITUENTS] {
        let panel = self.panel;
        let from = self.radius * mu;
        let mu_above = (from * from + self.drop).sqrt();
        let length = self.drop / (mu_above + from).max(f32::MIN_POSITIVE);
        let mut inside = Spectrum::ZERO;
        for (power, m) in panel
            .columns_m
            .iter()
            .zip(moments(mu_above, length, panel.per_width))
        {
            inside = inside.scale_acc(*power, m);
        }
        (inside.max_scalar(0.0) + self.above.to_space_m(mu_above)).0
    }
}

impl SlantColumns {
    /// Divides a shell into panels and integrates the columns above each.
    pub fn new(shell: Shell) -> Self {
        let radii_m = divided(&shell.smooth_radii_m(), |below, above| {
            is_cubic(&shell, below, above)
        });
        let panels: Vec<Panel> = radii_m
            .windows(2)
            .map(|edges| Panel::new(&shell, edges[0], edges[1]))
            .collect();
        let above = parallel::map(panels.len(), |i| {
            Above::new(panels[i].top_m, &panels[i + 1..], shell.constituents())
        });
        Self {
            shell,
            radii_m,
            panels,
            above,
        }
    }

    /// Columns from `radius_m` along `mu` to the top of the atmosphere for a ray that misses the ground, in metres at density 1.
    #[inline(always)]
    pub fn to_space_m(&self, radius_m: f64, mu: f64) -> PerConstituent {
        self.at(radius_m).to_space_m(mu).map(f64::from)
    }

    /// Columns between two distances along a ray that lie inside the shell, in metres at density 1. `edges` is scratch space.
    pub fn along_m(
        &self,
        ray: &Ray,
        (start_m, end_m): (f64, f64),
        edges: &mut Vec<f64>,
    ) -> PerConstituent {
        panel_edges(&self.shell, &self.radii_m, ray, (start_m, end_m), edges);
        let mut columns = [0.0; MAX_CONSTITUENTS];
        for edge in edges.windows(2) {
            let middle = ray.radius_at(0.5 * (edge[0] + edge[1]));
            let panel = &self.panels[interval_of(&self.radii_m, middle)];
            let top = panel.top_m;
            for (t, dt) in NODES.on(edge[0], edge[1]) {
                count_evaluation();
                let radius = ray.radius_at(t);
                let x = (top - radius) * (top + radius) / (top * top * panel.width);
                let [p0, p1, p2, p3] = &panel.columns_m;
                for c in 0..self.shell.constituents() {
                    let [p0, p1, p2, p3] = [p0[c], p1[c], p2[c], p3[c]].map(f64::from);
                    let density = (p0 + x * (p1 + x * (p2 + x * p3))) / top;
                    columns[c] += dt * density.max(0.0);
                }
            }
        }
        columns
    }

    /// The columns from one radius, for evaluation at many zenith angles.
    #[inline(always)]
    pub fn at(&self, radius_m: f64) -> ColumnRow<'_> {
        let index = interval_of(&self.radii_m, radius_m);
        let panel = &self.panels[index];
        let top = panel.top_m;
        ColumnRow {
            all: self,
            radius_m,
            panel,
            above: &self.above[index],
            radius: (radius_m / top) as f32,
            drop: (((top - radius_m) * (top + radius_m)).max(0.0) / (top * top)) as f32,
        }
    }
}

#[cfg(test)]
mod tests;
