//! Angular moments of the light inside the atmosphere, on a grid of altitudes and sun zenith angles.

use super::air::Air;
use super::harmonics::Harmonics;
use super::horizon::{self, HorizonPlace, MODES};
use super::polarised::{MAX_RATIO, POLARISED, TensorHarmonics};
use crate::math::interpolation::{Place, interval_of};
use crate::spectrum::Spectrum;
use crate::transfer::ray::Ray;
use crate::transfer::shell::{PerConstituent, Shell, divided};
use std::ops::Range;

/// Grid of the field: radii and cosines of the sun's zenith angle.
#[derive(Clone, Debug)]
pub struct FieldGrid {
    /// Radii, increasing from the ground to the top of the atmosphere, m.
    pub radii_m: Vec<f64>,
    /// Cosines of the sun's zenith angle, increasing.
    pub sun_cosines: Vec<f64>,
    /// For each interval between radii, the nodes that interpolate in it.
    intervals: Vec<Interval>,
}

/// Nodes of Lagrange interpolation in an interval between radii, in the coordinate [`Shell::altitude_coordinate`]: up to four,
/// none beyond a kink of a density, where the light has a kink as well.
#[derive(Clone, Debug)]
struct Interval {
    /// Index of the first of four radii, and those of them that interpolate.
    first: usize,
    nodes: Range<usize>,
    coordinates: [f64; 4],
    /// Reciprocals of the products of differences of coordinates.
    inverse: [f64; 4],
}

/// Four radii and their weights in an interpolation.
#[derive(Clone, Copy, Debug)]
pub struct RadialStencil {
    /// Index of the first radius.
    pub first: usize,
    /// Weights, which sum to 1.
    pub weights: [f32; 4],
}

impl RadialStencil {
    /// The lowest radius alone.
    pub const GROUND: Self = Self {
        first: 0,
        weights: [1.0, 0.0, 0.0, 0.0],
    };
}

impl FieldGrid {
    /// Grid with at least `altitudes` radii, denser where the scatterers are and at the ground, and the given zenith angles of the sun
    /// (degrees, increasing). Radii are added at kinks of the densities and in optically thick air.
    pub fn new<const N: usize>(air: &Air<N>, altitudes: usize, sun_zeniths_deg: &[f64]) -> Self {
        let shell = air.shell();
        let inside = |r: &f64| *r > shell.ground_radius_m && *r < shell.top_radius_m;
        let kinks: Vec<f64> = shell.kink_radii_m.iter().copied().filter(inside).collect();
        let mut radii_m = radii_m(air, altitudes.max(4));
        insert_kinks(&mut radii_m, &kinks);
        divide_lowest(shell, &mut radii_m);
        let radii_m = resolve_depth(air, &radii_m);
        let sun_cosines = sun_zeniths_deg
            .iter()
            .rev()
            .map(|angle| angle.to_radians().cos())
            .collect();
        let coordinates: Vec<f64> = radii_m
            .iter()
            .map(|&r| shell.altitude_coordinate(r))
            .collect();
        // Ends of the pieces without kinks.
        let ends: Vec<usize> = (0..radii_m.len())
            .filter(|&k| k == 0 || k + 1 == radii_m.len() || kinks.contains(&radii_m[k]))
            .collect();
        let intervals = (0..radii_m.len() - 1)
            .map(|below| {
                let end = ends.partition_point(|&end| end <= below);
                Interval::new(&coordinates, below, ends[end - 1]..ends[end] + 1)
            })
            .collect();
        Self {
            radii_m,
            sun_cosines,
            intervals,
        }
    }

    /// Interpolation at a radius in m.
    #[inline(always)]
    pub fn place_of_radius(&self, radius_m: f64) -> RadialStencil {
        let (bottom, top) = (self.radii_m[0], self.radii_m[self.radii_m.len() - 1]);
        let x = ((radius_m - bottom) / (top - bottom))
            .clamp(0.0, 1.0)
            .sqrt();
        self.intervals[interval_of(&self.radii_m, radius_m)].at(x)
    }

    /// Index of the sun nearest to a cosine.
    pub fn nearest_sun(&self, mu_sun: f64) -> usize {
        let place = self.place_of_sun(mu_sun);
        place.below + usize::from(place.fraction > 0.5)
    }

    /// Interpolation interval of a sun cosine.
    #[inline(always)]
    pub fn place_of_sun(&self, mu_sun: f64) -> Place {
        Place::among(&self.sun_cosines, mu_sun)
    }
}

impl Interval {
    /// Interval from node `below` to the next, within the nodes of `piece`.
    fn new(all: &[f64], below: usize, piece: Range<usize>) -> Self {
        let from = below
            .saturating_sub(1)
            .clamp(piece.start, piece.end.saturating_sub(4).max(piece.start));
        let to = (from + 4).min(piece.end);
        let first = from.min(all.len() - 4);
        let nodes = from - first..to - first;
        let coordinates = std::array::from_fn(|k| all[first + k]);
        let inverse = std::array::from_fn(|k| {
            let others = nodes.clone().filter(|&j| j != k);
            let product: f64 = others.map(|j| coordinates[k] - coordinates[j]).product();
            if nodes.contains(&k) {
                1.0 / product
            } else {
                0.0
            }
        });
        Self {
            first,
            nodes,
            coordinates,
            inverse,
        }
    }

    #[inline(always)]
    fn at(&self, x: f64) -> RadialStencil {
        let mut weights = [0.0f32; 4];
        for k in self.nodes.clone() {
            let mut weight = self.inverse[k];
            for j in self.nodes.clone() {
                if j != k {
                    weight *= x - self.coordinates[j];
                }
            }
            weights[k] = weight as f32;
        }
        RadialStencil {
            first: self.first,
            weights,
        }
    }
}

/// Radii at equal steps of a measure that grows with each scatterer's column below and with the coordinate of the altitude.
fn radii_m<const N: usize>(air: &Air<N>, count: usize) -> Vec<f64> {
    const SAMPLES: usize = 2000;
    /// Weight of the coordinate: twilight comes from high, thin air.
    const ALTITUDE_WEIGHT: f64 = 1.5;
    let shell: &Shell = air.shell();
    let columns_above_m = |radius_m: f64| air.columns.at(radius_m).to_space_m(1.0).map(f64::from);
    let ground = columns_above_m(shell.ground_radius_m);
    let share = 1.0 / air.scatterers.len().max(1) as f64;
    let measure = |x: f64| -> f64 {
        let columns = columns_above_m(shell.radius_of_coordinate(x));
        let below: f64 = air
            .scatterers
            .iter()
            .map(|s| share * (1.0 - columns[s.constituent] / ground[s.constituent].max(1e-30)))
            .sum();
        below + ALTITUDE_WEIGHT * x
    };
    let total = measure(1.0);
    let mut radii = vec![shell.ground_radius_m];
    for i in 1..SAMPLES {
        let x = i as f64 / SAMPLES as f64;
        if measure(x) >= total * radii.len() as f64 / (count - 1) as f64 && radii.len() < count - 1
        {
            radii.push(shell.radius_of_coordinate(x));
        }
    }
    radii.push(shell.top_radius_m);
    radii
}

/// Adds `kinks` to increasing radii; each replaces a radius, other than the first and last, that is close to it.
fn insert_kinks(radii_m: &mut Vec<f64>, kinks: &[f64]) {
    for &kink in kinks {
        let above = radii_m.partition_point(|&r| r < kink);
        let gap = radii_m[above] - radii_m[above - 1];
        let near = |r: f64| (r - kink).abs() < 0.3 * gap && !kinks.contains(&r);
        let last = radii_m.len() - 1;
        if radii_m[above] == kink {
            continue;
        }
        if above < last && near(radii_m[above]) {
            radii_m[above] = kink;
        } else if above > 1 && near(radii_m[above - 1]) {
            radii_m[above - 1] = kink;
        } else {
            radii_m.insert(above, kink);
        }
    }
}

/// Divides the interval at the ground in the middle of its coordinate. Light changes fastest there, and a view along the horizon sees
/// nothing else.
fn divide_lowest(shell: &Shell, radii_m: &mut Vec<f64>) {
    let coordinate = shell.altitude_coordinate(radii_m[1]);
    radii_m.insert(1, shell.radius_of_coordinate(0.5 * coordinate));
}

/// Halves intervals between radii that are optically thick, in the lane with the most extinction: the light changes fastest
/// within the first free paths below the top and above the ground.
fn resolve_depth<const N: usize>(air: &Air<N>, radii_m: &[f64]) -> Vec<f64> {
    let shell = air.shell();
    let depth_above = |r: f64| {
        let columns = shell.vertical_columns_m(r);
        f64::from(air.coefficients.extinction(&columns).max_element())
    };
    let whole = depth_above(shell.ground_radius_m);
    let max_step = MAX_STEP.max(whole / MAX_STEPS);
    divided(radii_m, |below, above| {
        let (deep, shallow) = (depth_above(below), depth_above(above));
        let from_end = shallow.min(whole - deep).max(0.0);
        deep - shallow <= (GROWTH * from_end).clamp(MIN_STEP, max_step)
    })
}

/// Smallest limit of the optical depth of a step between radii, the limit as a fraction of the depth from the nearest end, and
/// its largest value.
const MIN_STEP: f64 = 0.1;
const GROWTH: f64 = 0.13;
const MAX_STEP: f64 = 4.0;
/// About the largest number of steps in the interior of very thick air, where the light changes slowly.
const MAX_STEPS: f64 = 60.0;
/// Moments of the radiance, `A_lm = integral of L Y_lm`, and of its polarisation at each node of a grid, and the diffuse irradiance on
/// the ground, both per unit solar irradiance.
///
/// `A_00` is stored as its logarithm and the other moments as ratios to it: light falls by orders of magnitude as the sun
/// sets, so its logarithm is interpolated. Between suns the ratios are linear in the sun cosine, and the logarithm has a [`Bend`].
#[derive(Clone, Debug)]
pub struct RadianceField<const N: usize> {
    /// Grid of the moments.
    pub grid: FieldGrid,
    /// Basis functions of the moments.
    pub basis: Harmonics,
    /// Number of values at each node: the moments of the radiance, after them those of its polarisation ([`super::polarised`]), if
    /// the light is polarised, and the light that forward peaks scatter at the horizon ([`horizon`]), if there is any.
    count: usize,
    polarised: bool,
    /// `[radius][sun][moment]`.
    moments: Vec<Spectrum<N>>,
    /// Bends of the logarithm of the intensity, `[radius][interval between suns]`.
    bends: Vec<Bend<N>>,
    /// Logarithm of the diffuse irradiance on the ground for each sun cosine, and its bends.
    ground_irradiance: Vec<Spectrum<N>>,
    ground_bends: Vec<Bend<N>>,
}

/// Curvature of a logarithm between two sun cosines: the logarithm is higher by the bend times `f (1 - f)` than the line between
/// its ends, where `f` is the fraction of the interval.
#[derive(Clone, Copy, Debug)]
pub struct Bend<const N: usize>(Spectrum<N>);

impl<const N: usize> Bend<N> {
    /// Rise of the logarithm over the line at a fraction of the interval.
    #[inline(always)]
    pub fn at(self, fraction: f32) -> Spectrum<N> {
        self.0 * (fraction * (1.0 - fraction))
    }

    /// Weighted sum.
    #[inline(always)]
    fn sum(bends: impl Iterator<Item = (Self, f32)>) -> Self {
        Self(bends.fold(Spectrum::ZERO, |sum, (Self(bend), w)| {
            sum.scale_acc(bend, w)
        }))
    }

    /// Bends in the intervals between increasing nodes with these logarithms: half the mean of the second derivatives at both ends,
    /// at most twice the smaller one, and none where they differ in sign: the light has kinks where the sun sets on a radius.
    fn of(nodes: &[f64], logs: impl Fn(usize) -> Spectrum<N>) -> Vec<Self> {
        let width = |i: usize| (nodes[i + 1] - nodes[i]) as f32;
        let slope = |i: usize| (logs(i + 1) - logs(i)) * (1.0 / width(i));
        let last = nodes.len() - 1;
        let curvature = |i: usize| match i {
            0 => None,
            _ if i == last => None,
            _ => Some((slope(i) - slope(i - 1)) * (2.0 / (width(i) + width(i - 1)))),
        };
        (0..last)
            .map(|i| {
                let scale = -0.5 * width(i) * width(i);
                let bend = match (curvature(i), curvature(i + 1)) {
                    (Some(a), Some(b)) => Spectrum::from_fn(|lane| limited_mean(a[lane], b[lane])),
                    // Towards the ends of the range the curvature of the next interval is the best guess.
                    (Some(one), None) | (None, Some(one)) => one,
                    (None, None) => Spectrum::ZERO,
                };
                Self(bend * scale)
            })
            .collect()
    }
}

/// The mean of two numbers of the same sign, at most twice the one nearer to 0; 0 if their signs differ.
fn limited_mean(a: f32, b: f32) -> f32 {
    match a * b > 0.0 {
        true => (0.5 * (a + b))
            .abs()
            .min(2.0 * a.abs().min(b.abs()))
            .copysign(a),
        false => 0.0,
    }
}

/// Values between radii: those at four radii, and their weights.
#[derive(Clone, Copy, Debug)]
pub struct AtRadius<'a, const N: usize> {
    points: [&'a [Spectrum<N>]; 4],
    weights: [f32; 4],
}

impl<'a, const N: usize> AtRadius<'a, N> {
    /// Some of the values.
    #[inline(always)]
    pub fn part(&self, start: usize, count: usize) -> Self {
        let [a, b, c, d] = self.points;
        let part = start..start + count;
        Self {
            points: [
                &a[part.clone()],
                &b[part.clone()],
                &c[part.clone()],
                &d[part],
            ],
            weights: self.weights,
        }
    }

    /// One of the values.
    #[inline(always)]
    pub fn at(&self, k: usize) -> Spectrum<N> {
        let ([a, b, c, d], [wa, wb, wc, wd]) = (self.points, self.weights);
        (a[k] * wa + b[k] * wb) + (c[k] * wc + d[k] * wd)
    }
}

/// Smallest stored intensity, to keep the logarithm finite.
const MIN_INTENSITY: f32 = 1e-34;

impl<const N: usize> RadianceField<N> {
    /// Creates a field from moments, `[radius][sun][moment]`, and irradiances on the ground, `[sun]`.
    pub fn new(
        grid: FieldGrid,
        basis: Harmonics,
        mut moments: Vec<Spectrum<N>>,
        ground: &[Spectrum<N>],
    ) -> Self {
        let nodes = grid.radii_m.len() * grid.sun_cosines.len();
        let count = moments.len() / nodes;
        for point in moments.chunks_exact_mut(count) {
            let intensity = point[0].max_scalar(MIN_INTENSITY);
            for l in 1..=basis.degree() {
                // Bound for non-negative radiance; rounding can exceed it where there is almost no light.
                let limit = ((2 * l + 1) as f32).sqrt();
                for ratio in &mut point[basis.span(l)] {
                    *ratio = (*ratio / intensity).map(|r| r.clamp(-limit, limit));
                }
            }
            for ratio in &mut point[basis.count()..] {
                *ratio = (*ratio / intensity).map(|r| r.clamp(-MAX_RATIO, MAX_RATIO));
            }
            point[0] = intensity.ln();
        }
        let ground_irradiance: Vec<Spectrum<N>> = ground
            .iter()
            .map(|e| e.max_scalar(MIN_INTENSITY).ln())
            .collect();
        let suns = &grid.sun_cosines;
        let bends = moments
            .chunks_exact(count * suns.len())
            .flat_map(|suns_at_radius| Bend::of(suns, |sun| suns_at_radius[sun * count]))
            .collect();
        Self {
            ground_bends: Bend::of(suns, |sun| ground_irradiance[sun]),
            bends,
            grid,
            polarised: count > basis.count(),
            basis,
            count,
            moments,
            ground_irradiance,
        }
    }

    /// This field with the light that forward peaks scatter at the horizon, `[radius][sun][value]`.
    pub fn with_horizon(mut self, horizon: &[Spectrum<N>]) -> Self {
        let points = self.moments.chunks_exact(self.count);
        let values = horizon.chunks_exact(horizon::VALUES);
        let mut moments = Vec::with_capacity(self.moments.len() + horizon.len());
        for (point, values) in points.zip(values) {
            let intensity = point[0].exp();
            moments.extend_from_slice(point);
            moments.extend(values.iter().map(|value| *value / intensity));
        }
        self.moments = moments;
        self.count += horizon::VALUES;
        self
    }

    /// Index of the first moment of polarisation at each node, if the field holds the polarisation of its light.
    #[inline(always)]
    pub fn polarised_start(&self) -> Option<usize> {
        self.polarised.then_some(self.basis.count())
    }

    /// Index of the first value of the light at the horizon at each node, if there is any.
    #[inline(always)]
    pub fn horizon_start(&self) -> Option<usize> {
        let start = self.basis.count() + if self.polarised { POLARISED } else { 0 };
        (self.count > start).then_some(start)
    }

    #[inline(always)]
    fn point(&self, radius: usize, sun: usize) -> &[Spectrum<N>] {
        let start = (radius * self.grid.sun_cosines.len() + sun) * self.count;
        &self.moments[start..start + self.count]
    }

    /// Diffuse irradiance on the ground for the sun cosine `mu_sun`.
    #[inline(always)]
    pub fn ground_irradiance(&self, mu_sun: f64) -> Spectrum<N> {
        let at = self.grid.place_of_sun(mu_sun);
        let bend = self.ground_bends[at.below].at(at.fraction as f32);
        (at.value_in_f32(&self.ground_irradiance) + bend).exp()
    }

    /// Bend of the logarithm of the intensity in an interval between suns.
    #[inline(always)]
    pub fn bend(&self, place: RadialStencil, interval: usize) -> Bend<N> {
        let intervals = self.grid.sun_cosines.len() - 1;
        let weights = place.weights.into_iter().enumerate();
        Bend::sum(weights.map(|(k, w)| (self.bends[(place.first + k) * intervals + interval], w)))
    }

    /// Stored values at a radius under one sun.
    #[inline(always)]
    pub fn at_radius(&self, place: RadialStencil, sun: usize) -> AtRadius<'_, N> {
        let RadialStencil { first, weights } = place;
        AtRadius {
            points: [
                self.point(first, sun),
                self.point(first + 1, sun),
                self.point(first + 2, sun),
                self.point(first + 3, sun),
            ],
            weights,
        }
    }

    /// Source function of multiply scattered light: radiance scattered per metre into a view ray at `here` from light that has
    /// been scattered or reflected at least once, per unit solar irradiance. `harmonics` are evaluated in the ray's direction.
    #[inline(always)]
    pub fn source(
        &self,
        air: &Air<N>,
        here: &Ray,
        densities: &PerConstituent,
        harmonics: &[f32],
    ) -> Spectrum<N> {
        let (corners, mut log_intensity) = self.corners(here);
        for &(corner, w) in &corners {
            log_intensity = log_intensity.scale_acc(corner[0], w);
        }
        let mut sum = scattering_moment(air, densities, 0) * harmonics[0];
        for l in 1..=self.basis.degree() {
            let mut degree = Spectrum::ZERO;
            for k in self.basis.span(l) {
                for &(corner, w) in &corners {
                    degree = degree.scale_acc(corner[k], w * harmonics[k]);
                }
            }
            sum = sum.mul_acc(scattering_moment(air, densities, l), degree);
        }
        if self.polarised {
            let mut degree = Spectrum::ZERO;
            for (k, y) in harmonics[Harmonics::index(2, 0)..][..POLARISED]
                .iter()
                .enumerate()
            {
                for &(corner, w) in &corners {
                    degree = degree.scale_acc(corner[self.basis.count() + k], w * y);
                }
            }
            let [natural, _] = polarised_moments(air, densities);
            sum = sum.mul_acc(natural, degree);
        }
        let horizon = self.horizon_start().and_then(|start| {
            let place = HorizonPlace::of(here.radius_m, here.mu, air.shell().ground_radius_m)?;
            Some((start + place.first, place))
        });
        if let Some((start, place)) = horizon {
            let sin = ((1.0 - here.mu) * (1.0 + here.mu)).max(0.0).sqrt();
            let cosine = (here.toward_sun() / sin.max(1e-9)).clamp(-1.0, 1.0) as f32;
            let mut change = Spectrum::ZERO;
            for (node, weight) in place.weights().into_iter().enumerate() {
                for (m, mode) in horizon::modes(cosine).into_iter().enumerate() {
                    for &(corner, w) in &corners {
                        let value = corner[start + node * MODES + m];
                        change = change.scale_acc(value, w * weight * mode);
                    }
                }
            }
            sum = sum.mul_acc(air.peaks.extinction(densities), change);
        }
        // Truncated harmonics can be negative in directions with almost no light.
        sum.max_scalar(0.0) * log_intensity.exp()
    }

    /// Q and U of the light scattered per metre into a view ray at `here` from light that has been scattered at least once, per unit
    /// solar irradiance, in the frame of [`super::polarised`].
    #[inline(always)]
    pub fn linear_source(
        &self,
        air: &Air<N>,
        here: &Ray,
        densities: &PerConstituent,
        harmonics: &TensorHarmonics,
    ) -> [Spectrum<N>; 2] {
        if !self.polarised {
            return [Spectrum::ZERO; 2];
        }
        let (corners, bend) = self.corners(here);
        let sum = |start: Spectrum<N>, moment: usize| {
            corners
                .iter()
                .fold(start, |sum, (corner, w)| sum.scale_acc(corner[moment], *w))
        };
        let between = |moment: usize| sum(Spectrum::ZERO, moment);
        let [natural, kept] = polarised_moments(air, densities);
        let scattered = std::array::from_fn(|m| {
            let intensity = between(Harmonics::index(2, m));
            (between(self.basis.count() + m) * kept).mul_acc(natural, intensity)
        });
        let whole = sum(bend, 0).exp();
        harmonics.of_moments(&scattered).map(|light| light * whole)
    }

    /// The nodes around a place and their weights, and the rise of the logarithm of the intensity over their weighted sum.
    #[inline(always)]
    fn corners(&self, here: &Ray) -> ([(&[Spectrum<N>], f32); 8], Spectrum<N>) {
        let radius = self.grid.place_of_radius(here.radius_m);
        let sun = self.grid.place_of_sun(here.mu_sun);
        let (fr, fs) = (radius.weights, sun.fraction as f32);
        let corners = std::array::from_fn(|k| {
            let side = k % 2;
            let weight = fr[k / 2] * if side == 0 { 1.0 - fs } else { fs };
            (self.point(radius.first + k / 2, sun.below + side), weight)
        });
        (corners, self.bend(radius, sun.below).at(fs))
    }
}

/// Scattering coefficient times the l-th phase moment, summed over the scatterers, 1/m.
#[inline(always)]
pub fn scattering_moment<const N: usize>(
    air: &Air<N>,
    densities: &PerConstituent,
    l: usize,
) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for s in &air.scatterers {
        sum = sum.scale_acc(s.scattering * s.moments[l], densities[s.constituent] as f32);
    }
    sum
}

/// Scattering coefficient times the moments of degree 2 of the scattering matrix, summed over the scatterers, 1/m.
#[inline(always)]
pub fn polarised_moments<const N: usize>(
    air: &Air<N>,
    densities: &PerConstituent,
) -> [Spectrum<N>; 2] {
    let mut sums = [Spectrum::ZERO; 2];
    for s in &air.scatterers {
        let density = densities[s.constituent] as f32;
        for (sum, moment) in sums.iter_mut().zip(&s.polarised) {
            *sum = sum.scale_acc(s.scattering * *moment, density);
        }
    }
    sums
}

/// Light that has been scattered or reflected at least once, other than into a forward peak.
pub struct Diffuse<const N: usize> {
    /// Moments of the light, per unit solar irradiance.
    pub field: RadianceField<N>,
    /// The air for which the field was solved, without forward peaks. The difference between sunlight attenuated by this air
    /// and by the real air is light scattered into forward peaks, which keeps the direction of the sun.
    pub air: Air<N>,
    /// Estimated relative error of the intensity, by which it is not yet a solution; 0 for a given number of orders.
    pub error: f32,
}

/// Irradiance on the ground from sun and sky at the sun cosine `mu_sun`, per unit solar irradiance.
#[inline(always)]
pub fn ground_irradiance<const N: usize>(
    air: &Air<N>,
    diffuse: Option<&Diffuse<N>>,
    mu_sun: f64,
) -> Spectrum<N> {
    match diffuse {
        Some(diffuse) => {
            diffuse.field.ground_irradiance(mu_sun) + diffuse.air.sun_on_ground(mu_sun)
        }
        None => air.sun_on_ground(mu_sun),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [f64; 6] = [-0.3, -0.1, 0.0, 0.15, 0.4, 0.9];

    fn bends(log: impl Fn(f64) -> f64) -> Vec<f32> {
        let bends = Bend::<1>::of(&NODES, |sun| Spectrum::from_fn(|_| log(NODES[sun]) as f32));
        bends.iter().map(|bend| bend.at(0.5)[0]).collect()
    }

    #[test]
    fn bends_make_parabolas_exact() {
        let log = |mu: f64| 2.0 - 3.0 * mu - 4.0 * mu * mu;
        for (i, bend) in bends(log).into_iter().enumerate() {
            let (a, b) = (NODES[i], NODES[i + 1]);
            let rise = log(0.5 * (a + b)) - 0.5 * (log(a) + log(b));
            assert!((f64::from(bend) - rise).abs() < 1e-5, "{i}: {bend} {rise}");
        }
    }

    /// Beside a kink the line stays the line, and it is not bent the wrong way.
    #[test]
    fn kinks_do_not_ring() {
        let kink = |mu: f64| 5.0 * mu.min(0.15);
        for (i, bend) in bends(kink).into_iter().enumerate() {
            assert!(bend.abs() < 1e-5, "{i}: {bend}");
        }
    }

    #[test]
    fn two_suns_are_joined_by_a_line() {
        let bends = Bend::<1>::of(&[0.1, 0.3], |sun| Spectrum::from_fn(|_| sun as f32));
        assert_eq!(bends.len(), 1);
        assert_eq!(bends[0].at(0.5)[0], 0.0);
    }
}
