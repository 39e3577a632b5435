//! Diffuse light that forward peaks scatter out of its direction beside the horizon.
//!
//! The moments of a field describe its light up to a degree, and what the forward peaks of phase functions keep of the moments
//! beyond it counts as unscattered ([`crate::transfer::delta_m`]). Diffuse light hardly has such moments except at the horizon, where
//! the bright sky ends and darker ground begins: forward peaks scatter light from the sky's lowest degrees below the horizon, and
//! less comes back. With the fraction `f` of the scattering coefficient `b` that counts as unscattered, and the moments `chi_l` of the
//! phase function, the light changes by
//!
//! ```text
//! b f D,   D = sum of r_l L_l - L,   r_l = 1 up to the degree of the field,   r_l = chi_l / f beyond,
//! ```
//!
//! per metre: the moments `r_l` are those of the part of the phase function that counts as unscattered. This is exact if `L` is the
//! light of the real air. Here it is the light of the solution, integrated along the rays with which the field was solved, so `D` is
//! right to first order. It is tabulated at nodes of the zenith angle on both sides of the horizon for the azimuthal modes 0 to 4, at
//! all radii and suns of the field, and interpolated in views.

use super::air::Air;
use super::settings::Directions;
use crate::math::legendre::associated_recurrence;
use crate::math::parallel;
use crate::math::quadrature::GaussRule;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::delta_m::peak_fraction;
use std::f32::consts::PI;
use std::ops::Range;

/// Number of azimuthal modes.
pub const MODES: usize = 5;
/// Number of intervals of the zenith angle on each side of the horizon.
const INTERVALS: usize = 8;
/// Distance from the horizon beyond which there is no correction, in the cosine of the zenith angle.
const WIDTH: f64 = 0.4;
/// Number of values at each grid point: `[side][node][mode]`, of which those of the last node of each side are 0.
pub const VALUES: usize = 2 * (INTERVALS + 1) * MODES;
/// Optical depth of the peaks below which there is no correction, and the distance for which it holds, m: that through air of a small
/// range of altitudes at most.
const NEGLIGIBLE: f32 = 1e-3;
const LONGEST_M: f32 = 3e5;
/// Highest degree of the light: a peak narrower than a degree counts as unscattered.
const MAX_DEGREE: usize = 72;

/// Place of a direction between two nodes.
#[derive(Clone, Copy, Debug)]
pub struct HorizonPlace {
    /// Index of the values of the first node; those of the second follow.
    pub first: usize,
    /// Position between the nodes, 0 to 1.
    pub fraction: f32,
}

impl HorizonPlace {
    /// Place of a direction with the cosine `mu` of the zenith angle at a radius, if it is near the horizon.
    #[inline(always)]
    pub fn of(radius_m: f64, mu: f64, ground_radius_m: f64) -> Option<Self> {
        let above = mu - horizon(radius_m, ground_radius_m);
        let x = (above.abs() / WIDTH).sqrt() * INTERVALS as f64;
        if x >= INTERVALS as f64 {
            return None;
        }
        let side = usize::from(above >= 0.0) * (INTERVALS + 1);
        Some(Self {
            first: (side + x as usize) * MODES,
            fraction: x.fract() as f32,
        })
    }

    /// Factors of the two nodes.
    #[inline(always)]
    pub fn weights(self) -> [f32; 2] {
        [1.0 - self.fraction, self.fraction]
    }
}

/// `cos(m phi)` of the azimuthal modes for the cosine of the azimuth `phi`.
#[inline(always)]
pub fn modes(cosine: f32) -> [f32; MODES] {
    let mut out = [1.0, cosine, 0.0, 0.0, 0.0];
    for m in 2..MODES {
        out[m] = 2.0 * cosine * out[m - 1] - out[m - 2];
    }
    out
}

/// Cosine of the zenith angle of the horizon at a radius.
#[inline(always)]
pub fn horizon(radius_m: f64, ground_radius_m: f64) -> f64 {
    let sin = (ground_radius_m / radius_m).min(1.0);
    -((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt()
}

/// Ends of the pieces of the zenith angle: below the horizon, just above it, and higher up.
fn piece_edges(horizon: f64) -> [f64; 4] {
    const BAND: f64 = 0.2;
    [-1.0, horizon, horizon + BAND, 1.0]
}

/// Distances below the horizon of two rays that are in no integral, relative to that of the highest ray of the rule: from a little
/// above the ground, ground turns into haze within a few degrees.
const EXTRA: [f64; 2] = [0.3, 0.03];

/// Cosines of the zenith angle and quadrature weights, with a Gauss rule on each piece; the rays of the first piece end with the
/// [`EXTRA`] ones, whose weight is 0.
pub fn zenith_rule(horizon: f64, directions: &Directions) -> [Vec<(f64, f64)>; 3] {
    let edges = piece_edges(horizon);
    let mut rules = std::array::from_fn(|piece| {
        let rule = GaussRule::new(directions.zenith_nodes[piece]);
        rule.on(edges[piece], edges[piece + 1]).collect::<Vec<_>>()
    });
    let below: &mut Vec<_> = &mut rules[0];
    let highest = below.iter().map(|ray| ray.0).fold(-1.0, f64::max);
    below.extend(EXTRA.map(|distance| (horizon - distance * (horizon - highest), 0.0)));
    rules
}

/// Number of rays of a [`zenith_rule`].
fn ray_count(directions: &Directions) -> usize {
    directions.zenith_nodes.iter().sum::<usize>() + EXTRA.len()
}

/// Cosines of the zenith angles of the nodes: on the side below the horizon, then above it, without the last of each side.
fn node_cosines(horizon: f64) -> Vec<f64> {
    let distance = |k: usize| WIDTH * (k as f64 / INTERVALS as f64).powi(2);
    let below = (0..INTERVALS).map(|k| (horizon - distance(k)).max(-1.0));
    below
        .chain((0..INTERVALS).map(|k| horizon + distance(k)))
        .collect()
}

/// For each radius, the light along each path by azimuthal mode, `[sun][path][mode]`.
pub type ByDirection<const N: usize> = Vec<Vec<Spectrum<N>>>;

/// Replaces the light under some of a number of suns.
pub fn replace<const N: usize>(
    light: &mut ByDirection<N>,
    other: &ByDirection<N>,
    (replaced, suns): (&Range<usize>, usize),
) {
    for (row, other) in light.iter_mut().zip(other) {
        let stride = row.len() / suns;
        let part = replaced.start * stride..replaced.end * stride;
        row[part.clone()].copy_from_slice(&other[part]);
    }
}

/// Light by direction, and the directions.
pub type Directed<'a, const N: usize> = (&'a ByDirection<N>, &'a Directions);

/// The correction `D` at the grid points of radii and a number of suns, `[radius][sun][VALUES]`, for light that is a sum of parts along
/// different rays, in `air` without forward peaks beyond degree `peak_degree`; `None` if there are none.
pub fn correction<const N: usize>(
    (real, air): (&Air<N>, &Air<N>),
    (radii_m, suns): (&[f64], usize),
    peak_degree: usize,
    parts: &[Directed<'_, N>],
) -> Option<Vec<Spectrum<N>>> {
    let peaks = Peaks::new(real, air, peak_degree)?;
    let rows = parallel::map(radii_m.len(), |row| {
        let radius_m = radii_m[row];
        let mut out = vec![Spectrum::ZERO; suns * VALUES];
        if let Some(weights) = peaks.weights(air, radius_m) {
            let horizon = horizon(radius_m, air.shell().ground_radius_m);
            vectorized(
                #[inline(always)]
                || {
                    for (light, directions) in parts {
                        add(horizon, &weights, &light[row], directions, &mut out);
                    }
                },
            );
        }
        out
    });
    Some(rows.into_iter().flatten().collect())
}

/// Number of paths whose factors are summed together.
const TOGETHER: usize = 4;

/// Adds the correction for light along the rays at a radius with this horizon, `[sun][path][mode]`, given the moments `r_l` of the
/// highest degrees; those of lower degrees are 1.
#[inline(always)]
fn add<const N: usize>(
    horizon: f64,
    weights: &[Spectrum<N>],
    light: &[Spectrum<N>],
    directions: &Directions,
    out: &mut [Spectrum<N>],
) {
    let first_degree = MAX_DEGREE + 1 - weights.len();
    let nodes = node_cosines(horizon);
    let rays = SingleRays::new(horizon, directions);
    let paths = rays.count;
    let padded = paths.next_multiple_of(TOGETHER);
    let mut node_weights = vec![Spectrum::ZERO; weights.len()];
    // The correction at a node for light along each ray.
    let mut factors = vec![Spectrum::ZERO; paths];
    let mut low_degrees = vec![0.0; paths];
    for (m, moments) in rays.moments.iter().enumerate() {
        let at_nodes = associated(m, &nodes);
        let mut rounded = vec![0.0f32; (MAX_DEGREE + 1) * padded];
        for (rounded, moments) in rounded
            .chunks_exact_mut(padded)
            .zip(moments.chunks_exact(paths))
        {
            for (rounded, moment) in rounded.iter_mut().zip(moments) {
                *rounded = *moment as f32;
            }
        }
        for place in 0..nodes.len() {
            low_degrees.copy_from_slice(&rays.at_nodes[place * paths..][..paths]);
            for low in &mut low_degrees {
                *low = -*low;
            }
            for l in m..first_degree {
                let node = at_nodes[l * nodes.len() + place];
                for (low, moment) in low_degrees.iter_mut().zip(&moments[l * paths..]) {
                    *low += node * moment;
                }
            }
            for (l, (at_node, weight)) in (first_degree..).zip(node_weights.iter_mut().zip(weights))
            {
                *at_node = *weight * at_nodes[l * nodes.len() + place] as f32;
            }
            let groups = factors
                .chunks_mut(TOGETHER)
                .zip(low_degrees.chunks(TOGETHER));
            for (group, (factors, low_degrees)) in groups.enumerate() {
                // In registers.
                let mut sums = [Spectrum::ZERO; TOGETHER];
                for (sum, low) in sums.iter_mut().zip(low_degrees) {
                    *sum = Spectrum::splat(*low as f32);
                }
                for (l, at_node) in (first_degree..).zip(&node_weights) {
                    let moments = &rounded[l * padded + group * TOGETHER..][..TOGETHER];
                    for (sum, moment) in sums.iter_mut().zip(moments) {
                        *sum = sum.scale_acc(*at_node, *moment);
                    }
                }
                factors.copy_from_slice(&sums[..factors.len()]);
            }
            // The last node of each side is left out.
            let at = (place + place / INTERVALS) * MODES + m;
            for (out, light) in out
                .chunks_exact_mut(VALUES)
                .zip(light.chunks_exact(paths * MODES))
            {
                for (factor, light) in factors.iter().zip(light.chunks_exact(MODES)) {
                    out[at] = out[at].mul_acc(*factor, light[m]);
                }
            }
        }
    }
}

/// Forward peaks of the constituents.
struct Peaks<const N: usize> {
    /// For each constituent with a peak, `chi_l / f` for the degrees that the field leaves out.
    factors: Vec<(usize, Vec<Spectrum<N>>)>,
}

impl<const N: usize> Peaks<N> {
    fn new(real: &Air<N>, air: &Air<N>, peak_degree: usize) -> Option<Self> {
        let mut factors = Vec::new();
        for s in &real.scatterers {
            let peak = s.moments[peak_degree + 1].map(peak_fraction);
            if air.peaks.extinction_per_m[s.constituent].max_element() <= 0.0
                || peak.min_element() < 1e-3
            {
                continue;
            }
            let by_lane = s.legendre_moments(real, MAX_DEGREE + 1);
            let of_degree = |l: usize| {
                let moment = Spectrum::from_fn(|lane| by_lane[lane][l] as f32);
                moment / peak * end(l)
            };
            let degrees = (peak_degree + 1..=MAX_DEGREE).map(of_degree).collect();
            factors.push((s.constituent, degrees));
        }
        (!factors.is_empty()).then_some(Self { factors })
    }

    /// Mean of the factors over the constituents at a radius, if there are peaks.
    fn weights(&self, air: &Air<N>, radius_m: f64) -> Option<Vec<Spectrum<N>>> {
        let densities = air.shell().densities_at(radius_m);
        let whole = air.peaks.extinction(&densities);
        if whole.min_element() <= 0.0 || whole.max_element() * LONGEST_M < NEGLIGIBLE {
            return None;
        }
        let count = self.factors[0].1.len();
        let mut mean = vec![Spectrum::ZERO; count];
        for (constituent, factors) in &self.factors {
            let share =
                air.peaks.extinction_per_m[*constituent] * densities[*constituent] as f32 / whole;
            for (mean, factor) in mean.iter_mut().zip(factors) {
                *mean = mean.mul_acc(share, *factor);
            }
        }
        Some(mean)
    }
}

/// Factor that ends the series of moments smoothly, so that the horizon causes no ripples.
fn end(l: usize) -> f32 {
    let from = 2 * MAX_DEGREE / 3;
    if l <= from {
        return 1.0;
    }
    let x = (l - from) as f32 / (MAX_DEGREE + 1 - from) as f32;
    0.5 * (1.0 + (PI * x).cos())
}

/// Associated Legendre functions of a mode with integral 1 of their square at a number of cosines, `[l][cosine]`.
#[inline(always)]
fn associated(m: usize, cosines: &[f64]) -> Vec<f64> {
    let count = cosines.len();
    let mut p = vec![0.0; (MAX_DEGREE + 1) * count];
    for (p, mu) in p[m * count..].iter_mut().zip(cosines) {
        // The square of the first is that of the one before times `(2 m + 1) / (2 m) sin^2`.
        let sin2 = ((1.0 - mu) * (1.0 + mu)).max(0.0);
        let mut square = 0.5;
        for m in 1..=m {
            square *= (2 * m + 1) as f64 / (2 * m) as f64 * sin2;
        }
        *p = square.sqrt();
    }
    for l in m + 1..=MAX_DEGREE {
        let (a, b) = associated_recurrence(l, m);
        let (done, rest) = p.split_at_mut(l * count);
        let one = &done[(l - 1) * count..];
        for ((p, mu), one) in rest[..count].iter_mut().zip(cosines).zip(one) {
            *p = a * mu * one;
        }
        if l > m + 1 {
            let two = &done[(l - 2) * count..][..count];
            for (p, two) in rest[..count].iter_mut().zip(two) {
                *p -= b * two;
            }
        }
    }
    p
}

/// For each ray of a zenith rule, light that is 1 along it and 0 along the others, with a polynomial between those on each piece of the
/// rule.
struct SingleRays {
    /// Number of rays.
    count: usize,
    /// Moments by degree for each azimuthal mode, `[m][degree][ray]`.
    moments: [Vec<f64>; MODES],
    /// The light in the directions of the nodes beside the horizon, `[node][ray]`.
    at_nodes: Vec<f64>,
}

impl SingleRays {
    /// Light along the rays at a radius with this horizon.
    #[inline(always)]
    fn new(horizon: f64, directions: &Directions) -> Self {
        const POINTS: [usize; 3] = [40, 20, 40];
        /// Number of rays whose moments are summed together.
        const RAYS: usize = 8;
        let edges = piece_edges(horizon);
        let nodes = node_cosines(horizon);
        let count = ray_count(directions);
        let mut out = Self {
            count,
            moments: std::array::from_fn(|_| vec![0.0; (MAX_DEGREE + 1) * count]),
            at_nodes: vec![0.0; nodes.len() * count],
        };
        let mut first = 0;
        for (piece, rays) in zenith_rule(horizon, directions).iter().enumerate() {
            let rays: Vec<f64> = rays.iter().map(|ray| ray.0).collect();
            let light = |ray: usize, mu: f64| match piece {
                0 => between_with_extra(&rays, ray, mu, horizon),
                _ => between(&rays, ray, mu),
            };
            for (place, &mu) in nodes.iter().enumerate() {
                let of_node = match place < INTERVALS {
                    true => 0,
                    false => 1 + usize::from(mu > edges[2]),
                };
                if of_node == piece {
                    for ray in 0..rays.len() {
                        out.at_nodes[place * count + first + ray] = light(ray, mu);
                    }
                }
            }
            let rule = GaussRule::new(POINTS[piece]);
            let rule: Vec<_> = rule.on(edges[piece], edges[piece + 1]).collect();
            let cosines: Vec<f64> = rule.iter().map(|(mu, _)| *mu).collect();
            // `[group][point]`: light along some rays times the weights of the rule.
            let groups = (0..rays.len()).step_by(RAYS).map(|first| {
                let of_point = |&(mu, weight): &(f64, f64)| {
                    std::array::from_fn(|k| match first + k < rays.len() {
                        true => weight * light(first + k, mu),
                        false => 0.0,
                    })
                };
                rule.iter().map(of_point).collect()
            });
            let groups: Vec<Vec<[f64; RAYS]>> = groups.collect();
            for (m, moments) in out.moments.iter_mut().enumerate() {
                let associated = associated(m, &cosines);
                let rows = moments.chunks_exact_mut(count);
                for (moments, p) in rows.zip(associated.chunks_exact(cosines.len())) {
                    let moments = moments[first..first + rays.len()].chunks_mut(RAYS);
                    for (moments, weighted) in moments.zip(&groups) {
                        let mut sums = [0.0; RAYS];
                        for (p, weighted) in p.iter().zip(weighted) {
                            for (sum, weighted) in sums.iter_mut().zip(weighted) {
                                *sum += p * weighted;
                            }
                        }
                        moments.copy_from_slice(&sums[..moments.len()]);
                    }
                }
            }
            first += rays.len();
        }
        out
    }
}

/// The polynomial that is 1 at one of `rays` and 0 at the others.
fn between(rays: &[f64], ray: usize, mu: f64) -> f64 {
    let others = rays.iter().enumerate().filter(|(other, _)| *other != ray);
    others
        .map(|(_, other)| (mu - other) / (rays[ray] - other))
        .product()
}

/// The same below the horizon, where the last of the rays are the [`EXTRA`] ones: what they add to the polynomial through the others
/// is linear between them, and 0 from the highest other ray down.
fn between_with_extra(rays: &[f64], ray: usize, mu: f64, horizon: f64) -> f64 {
    let (ordinary, extra) = rays.split_at(rays.len() - EXTRA.len());
    let highest = ordinary.iter().copied().fold(-1.0, f64::max);
    let distance = (horizon - mu) / (horizon - highest);
    let first = if distance > EXTRA[0] {
        ((1.0 - distance) / (1.0 - EXTRA[0])).max(0.0)
    } else {
        ((distance - EXTRA[1]) / (EXTRA[0] - EXTRA[1])).max(0.0)
    };
    let second = ((EXTRA[0] - distance) / (EXTRA[0] - EXTRA[1])).clamp(0.0, 1.0);
    let hats = [first, second];
    match ray.checked_sub(ordinary.len()) {
        Some(place) => hats[place],
        None => {
            let replaced = extra.iter().zip(hats);
            let replaced: f64 = replaced
                .map(|(extra, hat)| hat * between(ordinary, ray, *extra))
                .sum();
            between(ordinary, ray, mu) - replaced
        }
    }
}
