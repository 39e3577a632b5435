//! Bundles of rays that share their starting radius and zenith angle, and the light along them.
//!
//! In a spherically symmetric atmosphere such rays cross the same radii at the same distances: quadrature nodes,
//! transmittances to the eye and radial interpolation are computed once, in a [`Path`], for the whole [`RayBundle`]. What
//! depends on the sun remains for each ray and is stored in arrays over the rays, so that the compiler vectorises it.

use super::air::Air;
use super::field::{
    Bend, FieldGrid, RadialStencil, RadianceField, polarised_moments, scattering_moment,
};
use super::harmonics::Harmonics;
use super::horizon::{HorizonPlace, MODES};
use super::polarised::{POLARISED, TensorHarmonics};
use crate::math::interpolation::lerp;
use crate::spectrum::Spectrum;
use crate::transfer::columns::ColumnRow;
use crate::transfer::march::{MAX_NODES, Marcher, Node, StepDensities};
use crate::transfer::ray::{Ray, in_shadow};
use crate::transfer::residual::{STREAMS, stream_transmittances};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent, Shell};
use std::ops::{ControlFlow, Range};

/// What the rays of a bundle have in common: quadrature nodes, transmittances and densities along the path.
pub struct Path<const N: usize> {
    /// Radius of the start, m.
    pub radius_m: f64,
    /// Cosine of the zenith angle at the start.
    pub mu: f64,
    nodes: Vec<PathNode<N>>,
    /// For each node, its weight times the phase moments of the scattering coefficients up to the degree of the field.
    source_weights: Vec<Spectrum<N>>,
    /// Number of those moments.
    degrees: usize,
    steps: Vec<PathStep>,
    /// Distance to the ground and transmittance to it, if the rays end there.
    ground: Option<(f64, Spectrum<N>)>,
}

/// A step of a [`Path`]: the distances to its ends, the columns before it, m, and its nodes.
struct PathStep {
    from_m: f64,
    to_m: f64,
    columns_m: PerConstituent,
    nodes: Range<usize>,
}

/// A quadrature node of a [`Path`].
struct PathNode<const N: usize> {
    t: f64,
    radius_m: f64,
    mu: f32,
    densities: PerConstituent,
    place: RadialStencil,
    /// Transmittance from the start times the length of the node's interval, m.
    weight: Spectrum<N>,
    /// Optical depth from the start that counts as unscattered.
    removed: Spectrum<N>,
    /// Length of the node's interval times the moments of degree 2 of the scattering matrix: of the intensity that arises from
    /// polarised light, attenuated as the intensity, and of the polarisation that arises from natural and from polarised light, which
    /// is attenuated less.
    polarised_weights: [Spectrum<N>; 3],
    /// Factor by which polarised light is attenuated less.
    linear_gain: Spectrum<N>,
    /// Place beside the horizon, and `weight` times the extinction that counts as unscattered.
    horizon: Option<HorizonPlace>,
    peak_weight: Spectrum<N>,
}

/// Sums over the nodes of a panel of a path.
struct Panel<const N: usize> {
    /// Optical depth of each node from the start of the panel.
    depths: [Spectrum<N>; MAX_NODES],
    count: usize,
    /// Optical depth of the panel.
    whole: Spectrum<N>,
    /// Sums of what the nodes take from the light at the start of the path, times powers of their optical depth.
    sums: [Spectrum<N>; 3],
}

/// Factor `constant + slope * depth` of the weights of a panel.
struct Correction<const N: usize> {
    constant: Spectrum<N>,
    slope: Spectrum<N>,
}

impl<const N: usize> Default for Panel<N> {
    fn default() -> Self {
        Self {
            depths: [Spectrum::ZERO; MAX_NODES],
            count: 0,
            whole: Spectrum::ZERO,
            sums: [Spectrum::ZERO; 3],
        }
    }
}

impl<const N: usize> Panel<N> {
    /// Adds a node that takes `taken` from the light, at an optical depth in the panel, for a step of the optical depth `step`.
    #[inline(always)]
    fn add(&mut self, taken: Spectrum<N>, depth: Spectrum<N>, step: Spectrum<N>) {
        self.depths[self.count] = depth;
        self.count += 1;
        self.whole += step;
        let mut power = taken;
        for sum in &mut self.sums {
            *sum += power;
            power *= depth;
        }
    }

    /// The correction of the weights that makes the light of a source exact that is linear in the optical depth, given the
    /// transmittance to the start of the panel. Without it the solution in thick air, where light is scattered thousands of times,
    /// neither conserves energy nor diffuses at the right rate.
    #[inline(always)]
    fn correction(&self, transmittance: Spectrum<N>) -> Correction<N> {
        let [s0, s1, s2] = &self.sums;
        let mut out = Correction {
            constant: Spectrum::ONE,
            slope: Spectrum::ZERO,
        };
        let kept = (Spectrum::ZERO - self.whole).exp();
        for lane in 0..N {
            if s0[lane] < 1e-30 {
                continue;
            }
            let whole = self.whole[lane];
            let mean = s1[lane] / s0[lane];
            let variance = s2[lane] - mean * s1[lane];
            // In thin panels the rule is exact enough, and differences would be rounding errors.
            if whole < 0.1 || variance <= 0.0 {
                let exact = whole * (1.0 - whole * (0.5 - whole * (1.0 / 6.0 - whole / 24.0)));
                let exact = if whole < 0.1 { exact } else { 1.0 - kept[lane] };
                out.constant[lane] = transmittance[lane] * exact / s0[lane];
            } else {
                let exact = transmittance[lane] * (1.0 - kept[lane]);
                let first = transmittance[lane] * (1.0 - (1.0 + whole) * kept[lane]);
                // Weights stay positive, even of a panel that is too thick for its nodes.
                let limit = exact / (s0[lane] * whole);
                let slope = ((first - mean * exact) / variance).clamp(-limit, limit);
                out.slope[lane] = slope;
                out.constant[lane] = exact / s0[lane] - slope * mean;
            }
        }
        out
    }
}

impl<const N: usize> Correction<N> {
    #[inline(always)]
    fn at(&self, depth: Spectrum<N>) -> Spectrum<N> {
        self.constant.mul_acc(self.slope, depth)
    }
}

/// The rays of one path: the position of the sun at the start for each.
#[derive(Clone, Debug, Default)]
pub struct RayBundle {
    /// Cosine of the sun's zenith angle at the start.
    pub mu_sun: Vec<f64>,
    /// Cosine of the angle between the ray and the sun.
    pub nu: Vec<f64>,
}

impl RayBundle {
    /// Number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.nu.len()
    }

    /// Adds a ray.
    #[inline(always)]
    pub fn push(&mut self, mu_sun: f64, nu: f64) {
        self.mu_sun.push(mu_sun);
        self.nu.push(nu);
    }

    /// `count` evenly spaced rays, from the first to the last.
    pub fn evenly_spaced(&self, count: usize) -> Self {
        let stride = (self.len() - 1) / (count - 1);
        let some = |all: &[f64]| all.iter().copied().step_by(stride).collect();
        Self {
            mu_sun: some(&self.mu_sun),
            nu: some(&self.nu),
        }
    }

    /// Ray by index, for the start (radius in m, cosine of the zenith angle).
    #[inline(always)]
    pub fn ray(&self, (radius_m, mu): (f64, f64), slot: usize) -> Ray {
        Ray {
            radius_m,
            mu,
            mu_sun: self.mu_sun[slot],
            nu: self.nu[slot],
        }
    }
}

/// Reused buffers over the rays of a bundle.
#[derive(Default)]
pub struct Scratch<const N: usize> {
    mu_sun: Vec<f32>,
    toward_sun: Vec<f32>,
    below: Vec<u32>,
    fraction: Vec<f32>,
    /// Cosines of the multiples of the azimuth from the sun, `[multiple][ray]`.
    cosines: Vec<f32>,
    /// Harmonics at azimuth 0.
    y: Vec<f32>,
    /// What a node scatters of each moment into its azimuthal mode.
    factors: Vec<Spectrum<N>>,
    /// What a node scatters of the field at its radius, for each sun: [`Modes`]; and the bends of the logarithm between suns.
    row: Vec<Modes<N>>,
    bends: Vec<Bend<N>>,
}

/// Light that a node scatters into the rays of a bundle, of a field under one sun: all rays have the same zenith angle there, so it
/// only varies with the azimuth.
#[derive(Clone, Copy, Debug)]
struct Modes<const N: usize> {
    /// Logarithm of the intensity of the field, to which the others are relative.
    log_intensity: Spectrum<N>,
    /// Intensity by azimuthal mode.
    intensity: [Spectrum<N>; Harmonics::MAX_DEGREE + 1],
    /// Q by mode, and U of modes 1 and 2, which vary with the sine of the azimuth.
    q: [Spectrum<N>; POLARISED],
    u: [Spectrum<N>; POLARISED - 1],
}

impl<const N: usize> Modes<N> {
    const NONE: Self = Self {
        log_intensity: Spectrum::ZERO,
        intensity: [Spectrum::ZERO; Harmonics::MAX_DEGREE + 1],
        q: [Spectrum::ZERO; POLARISED],
        u: [Spectrum::ZERO; POLARISED - 1],
    };

    /// Q and U, given the cosines and sines of the azimuth and of twice the azimuth.
    #[inline(always)]
    fn linear(&self, (cosines, sines): ([f32; 2], [f32; 2])) -> [Spectrum<N>; 2] {
        let q = self.q[0].scale_acc(self.q[1], cosines[0]);
        [
            q.scale_acc(self.q[2], cosines[1]),
            (self.u[0] * sines[0]).scale_acc(self.u[1], sines[1]),
        ]
    }
}

/// Distances at which each ray of a bundle enters or leaves the shadow of one of [`Shell::shadow_radii_m`].
///
/// [`Shell::shadow_radii_m`]: crate::transfer::shell::Shell::shadow_radii_m
struct ShadowEdges {
    /// For each ray, as many as there can be; those that do not exist are infinite.
    distances_m: Vec<f64>,
    per_ray: usize,
}

impl ShadowEdges {
    #[inline(always)]
    fn new(shell: &Shell, rays: impl Iterator<Item = Ray>) -> Self {
        let distances = rays.flat_map(|ray| {
            let edges = shell
                .shadow_radii_m
                .iter()
                .map(move |&radius_m| ray.shadow_edges(radius_m));
            edges.flatten().map(|edge| edge.unwrap_or(f64::INFINITY))
        });
        Self {
            distances_m: distances.collect(),
            per_ray: 2 * shell.shadow_radii_m.len(),
        }
    }

    /// The distances of a ray that lie in a step, m.
    #[inline(always)]
    fn inside(&self, step: &PathStep, slot: usize) -> impl Iterator<Item = f64> + use<'_> {
        let (from_m, to_m) = (step.from_m, step.to_m);
        let all = &self.distances_m[slot * self.per_ray..][..self.per_ray];
        let inside = move |t: &f64| from_m < *t && *t < to_m;
        all.iter().copied().filter(inside)
    }
}

/// Streams of singly scattered sunlight by scatterer, without phase functions; the one after those of the intensity is that of polarised
/// light.
type Streams<const N: usize> = [[Spectrum<N>; STREAMS + 1]; MAX_CONSTITUENTS];

/// Adds the sunlight that a point scatters into a ray. Light on its way from there is attenuated by a transmittance, which is given times
/// the length that the point stands for; by the optical depth that counts as unscattered, depending on the stream; and less by a factor if
/// it is polarised.
#[inline(always)]
fn add_sunlight<const K: usize, const LINEAR: bool, const N: usize>(
    air: &Air<N>,
    (weight, removed, linear_gain): (Spectrum<N>, Spectrum<N>, Spectrum<N>),
    densities: &PerConstituent,
    to_sun: &[f32; MAX_CONSTITUENTS],
    out: &mut Streams<N>,
) {
    let depth = air.coefficients.extinction_f32(to_sun);
    let arriving = weight * (Spectrum::ZERO - depth).exp();
    let streams = stream_transmittances(removed + air.peaks.extinction_f32(to_sun));
    for (s, sums) in air.scatterers.iter().zip(out) {
        let density = densities[s.constituent] as f32;
        for k in 0..s.streams().min(K) {
            sums[k] = sums[k].scale_acc(arriving * streams[k], density);
        }
        if LINEAR {
            sums[K] = sums[K].scale_acc(arriving * linear_gain, density);
        }
    }
}

/// Factor by which polarised light is attenuated less than natural light behind these columns.
#[inline(always)]
pub fn linear_gain<const N: usize>(air: &Air<N>, columns_m: &PerConstituent) -> Spectrum<N> {
    // The attenuation of both exceeds the range of single precision in much thicker air.
    air.linear_peaks
        .extinction(columns_m)
        .map(|depth| depth.min(60.0))
        .exp()
}

/// A ray with the sun at the zenith, so that no shadow edge crosses it and its steps serve all sun angles.
fn zenith_sun_ray((radius_m, mu): (f64, f64)) -> Ray {
    Ray {
        radius_m,
        mu,
        mu_sun: 1.0,
        nu: mu,
    }
}

impl<const N: usize> Path<N> {
    /// Traces a path from `radius_m` along `mu` through the whole atmosphere.
    #[inline(always)]
    pub fn new(
        air: &Air<N>,
        grid: Option<&FieldGrid>,
        marcher: &Marcher<'_>,
        start: (f64, f64),
        degree: usize,
    ) -> Self {
        let ray = zenith_sun_ray(start);
        let mut path = Self::empty(start, degree);
        let Some(segment) = air.shell().segment(&ray, f64::INFINITY) else {
            return path;
        };
        let span = (segment.start_m, segment.end_m);
        let before = [0.0; MAX_CONSTITUENTS];
        let columns = path.trace(air, grid, marcher, (span, before));
        if segment.meets_ground {
            path.ground = Some((segment.end_m, air.coefficients.transmittance(&columns)));
        }
        path
    }

    /// The same path in pieces that end at the increasing distances `stops_m`, m, and one from the last of them on, with the columns before
    /// each, m: their light adds up. Stops are clamped to the ends of the path.
    #[inline(always)]
    pub fn pieces(
        air: &Air<N>,
        grid: Option<&FieldGrid>,
        marcher: &Marcher<'_>,
        start: (f64, f64),
        degree: usize,
        stops_m: &[f64],
    ) -> Vec<(PerConstituent, Self)> {
        let ray = zenith_sun_ray(start);
        let mut columns = [0.0; MAX_CONSTITUENTS];
        let mut pieces = Vec::with_capacity(stops_m.len() + 1);
        let Some(segment) = air.shell().segment(&ray, f64::INFINITY) else {
            pieces.resize_with(stops_m.len() + 1, || (columns, Self::empty(start, degree)));
            return pieces;
        };
        let mut from_m = segment.start_m;
        let mut edges = Vec::new();
        for stop_m in stops_m.iter().copied().chain([f64::INFINITY]) {
            let span = (from_m, stop_m.clamp(from_m, segment.end_m));
            let mut piece = Self::empty(start, degree);
            let before = columns;
            if span.1 > span.0 {
                piece.trace(air, grid, marcher, (span, before));
                let inside = air.columns.along_m(&ray, span, &mut edges);
                for (sum, column) in columns.iter_mut().zip(inside) {
                    *sum += column;
                }
            }
            from_m = span.1;
            pieces.push((before, piece));
        }
        if segment.meets_ground
            && let Some((_, last)) = pieces.last_mut()
        {
            last.ground = Some((segment.end_m, air.coefficients.transmittance(&columns)));
        }
        pieces
    }

    fn empty((radius_m, mu): (f64, f64), degree: usize) -> Self {
        Self {
            radius_m,
            mu,
            nodes: Vec::new(),
            source_weights: Vec::new(),
            degrees: degree + 1,
            steps: Vec::new(),
            ground: None,
        }
    }

    /// Adds the nodes of a span of distances (m), which has columns before it (m), up to where the path is opaque; returns the columns up
    /// to there.
    #[inline(always)]
    fn trace(
        &mut self,
        air: &Air<N>,
        grid: Option<&FieldGrid>,
        marcher: &Marcher<'_>,
        (span, columns_m): ((f64, f64), PerConstituent),
    ) -> PerConstituent {
        /// Optical depth beyond which no light arrives.
        const OPAQUE: f32 = 16.0;
        // Optical depth from the start.
        let mut before = air.coefficients.extinction(&columns_m);
        if before.min_element() > OPAQUE {
            return columns_m;
        }
        let ray = zenith_sun_ray((self.radius_m, self.mu));
        let from_start = |columns: &PerConstituent| -> PerConstituent {
            std::array::from_fn(|c| columns_m[c] + columns[c])
        };
        let columns = marcher.march(
            air.shell(),
            &ray,
            span,
            &mut Vec::new(),
            #[inline(always)]
            |step| {
                let first = self.nodes.len();
                let mut panel = Panel::<N>::default();
                for node in step.nodes {
                    let columns_m = from_start(&node.columns_m);
                    let depth = air.coefficients.extinction(&columns_m);
                    let weight = (Spectrum::ZERO - depth).exp() * node.dt as f32;
                    let extinction = air.coefficients.extinction(&node.densities);
                    panel.add(
                        weight * extinction,
                        depth - before,
                        extinction * node.dt as f32,
                    );
                    let radius_m = node.here.radius_m;
                    self.nodes.push(PathNode {
                        t: node.t,
                        radius_m,
                        mu: node.here.mu as f32,
                        densities: node.densities,
                        place: grid.map_or(RadialStencil::GROUND, |g| g.place_of_radius(radius_m)),
                        weight,
                        removed: air.peaks.extinction(&columns_m),
                        polarised_weights: [Spectrum::ZERO; 3],
                        linear_gain: linear_gain(air, &columns_m),
                        horizon: HorizonPlace::of(
                            radius_m,
                            node.here.mu,
                            air.shell().ground_radius_m,
                        ),
                        peak_weight: air.peaks.extinction(&node.densities),
                    });
                }
                let correct = panel.correction((Spectrum::ZERO - before).exp());
                for (node, &depth) in self.nodes[first..].iter_mut().zip(&panel.depths) {
                    node.weight *= correct.at(depth);
                    node.peak_weight *= node.weight;
                    let moments = (0..self.degrees)
                        .map(|l| node.weight * scattering_moment(air, &node.densities, l));
                    self.source_weights.extend(moments);
                    let [natural, kept] =
                        polarised_moments(air, &node.densities).map(|moment| node.weight * moment);
                    node.polarised_weights =
                        [natural, natural * node.linear_gain, kept * node.linear_gain];
                }
                self.steps.push(PathStep {
                    from_m: step.from_m,
                    to_m: step.to_m,
                    columns_m: from_start(&step.columns_m),
                    nodes: first..self.nodes.len(),
                });
                before += panel.whole;
                if before.min_element() > OPAQUE {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        from_start(&columns)
    }

    /// True if the sun is above the horizontal plane at all nodes of some of the rays.
    #[inline(always)]
    pub fn has_sun_above_horizon(&self, bundle: &RayBundle, rays: Range<usize>) -> bool {
        // The product of the radius and the sun cosine is linear in the distance.
        let last = self.nodes.last().map_or(0.0, |node| node.t);
        rays.into_iter().all(|slot| {
            let at_start = self.radius_m * bundle.mu_sun[slot];
            at_start >= 0.0 && at_start + last * bundle.nu[slot] >= 0.0
        })
    }

    /// The first `K` streams of singly scattered sunlight along each ray, per unit scattering coefficient and without phase
    /// functions, into `out`: `[scatterer][stream][ray]`. With `LINEAR` one more stream is attenuated on its way to the eye as
    /// polarised light is. `marcher` is that of the path.
    #[inline(always)]
    pub fn accumulate_sunlight<const K: usize, const LINEAR: bool>(
        &self,
        air: &Air<N>,
        marcher: &Marcher<'_>,
        bundle: &RayBundle,
        out: &mut Vec<Spectrum<N>>,
    ) {
        let shell = air.shell();
        let rays = bundle.len();
        out.clear();
        out.resize(
            air.scatterers.len() * (K + usize::from(LINEAR)) * rays,
            Spectrum::ZERO,
        );
        let all = (0..rays).map(|slot| bundle.ray((self.radius_m, self.mu), slot));
        let edges = ShadowEdges::new(shell, all);
        let columns = |node: &PathNode<N>| air.columns.at(node.radius_m);
        let columns: Vec<ColumnRow<'_>> = self.nodes.iter().map(columns).collect();
        let count = K + usize::from(LINEAR);
        let mut ends_m = Vec::new();
        // By step, once they are needed.
        let mut densities: Vec<Option<Option<StepDensities>>> = vec![None; self.steps.len()];
        for slot in 0..rays {
            let mut sums = [[Spectrum::ZERO; STREAMS + 1]; MAX_CONSTITUENTS];
            let (mu_sun, nu) = (bundle.mu_sun[slot], bundle.nu[slot]);
            for (step, densities) in self.steps.iter().zip(&mut densities) {
                ends_m.clear();
                ends_m.extend(edges.inside(step, slot));
                if !ends_m.is_empty() {
                    ends_m.push(step.to_m);
                    ends_m.sort_unstable_by(f64::total_cmp);
                    let densities =
                        densities.get_or_insert_with(|| self.densities(air, marcher, step));
                    self.accumulate_partly_lit::<K, LINEAR>(
                        air,
                        marcher,
                        (step, densities.as_ref()),
                        (bundle, slot),
                        &ends_m,
                        &mut sums,
                    );
                    continue;
                }
                for k in step.nodes.clone() {
                    let (node, columns) = (&self.nodes[k], &columns[k]);
                    let mu_sun = (self.radius_m * mu_sun + node.t * nu) / node.radius_m;
                    if in_shadow(node.radius_m, mu_sun, shell.ground_radius_m) {
                        continue;
                    }
                    let to_sun = columns.to_space_m(mu_sun);
                    let attenuated = (node.weight, node.removed, node.linear_gain);
                    let densities = &node.densities;
                    add_sunlight::<K, LINEAR, N>(air, attenuated, densities, &to_sun, &mut sums);
                }
            }
            for (place, sums) in sums[..air.scatterers.len()].iter().enumerate() {
                for (k, sum) in sums[..count].iter().enumerate() {
                    out[(place * count + k) * rays + slot] = *sum;
                }
            }
        }
    }

    /// Densities between the nodes of a step, if it resolves the air.
    fn densities(
        &self,
        air: &Air<N>,
        marcher: &Marcher<'_>,
        step: &PathStep,
    ) -> Option<StepDensities> {
        let nodes = self.nodes[step.nodes.clone()].iter();
        let nodes = nodes.map(|node| (node.t, node.densities));
        marcher.densities_between(air.shell(), (step.from_m, step.to_m), nodes)
    }

    /// The same of a step in which a ray crosses edges of shadows, which divide it into parts with these ends.
    #[inline(always)]
    fn accumulate_partly_lit<const K: usize, const LINEAR: bool>(
        &self,
        air: &Air<N>,
        marcher: &Marcher<'_>,
        (step, densities): (&PathStep, Option<&StepDensities>),
        (bundle, slot): (&RayBundle, usize),
        ends_m: &[f64],
        out: &mut Streams<N>,
    ) {
        let shell = air.shell();
        let ray = bundle.ray((self.radius_m, self.mu), slot);
        let mut columns_m = step.columns_m;
        let mut from_m = step.from_m;
        for &to_m in ends_m {
            let mut nodes = [Node::default(); MAX_NODES];
            let span_m = (from_m, to_m);
            let at = |t, radius_m| match densities {
                Some(densities) => densities.at(t),
                None => shell.densities_at(radius_m),
            };
            let part = marcher.step_through(shell, &ray, span_m, &columns_m, at, &mut nodes);
            columns_m = part.columns_behind_m();
            from_m = to_m;
            for node in part.nodes {
                if !node.lit {
                    continue;
                }
                let Ray {
                    radius_m, mu_sun, ..
                } = node.here;
                let to_sun = air.columns.at(radius_m).to_space_m(mu_sun);
                let attenuated = (
                    air.coefficients.transmittance(&node.columns_m) * node.dt as f32,
                    air.peaks.extinction(&node.columns_m),
                    match LINEAR {
                        true => linear_gain(air, &node.columns_m),
                        false => Spectrum::ONE,
                    },
                );
                add_sunlight::<K, LINEAR, N>(air, attenuated, &node.densities, &to_sun, out);
            }
        }
    }

    /// Adds the light of `field` scattered into each ray; `basis` is that of the field, or its low degrees. `linear` receives its
    /// Q and U, if wanted.
    #[inline(always)]
    pub fn accumulate_scattered(
        &self,
        field: &RadianceField<N>,
        basis: &Harmonics,
        bundle: &RayBundle,
        scratch: &mut Scratch<N>,
        out: &mut [Spectrum<N>],
        mut linear: Option<&mut [[Spectrum<N>; 2]]>,
    ) {
        let rays = bundle.len();
        // Those of the light at the horizon, and of polarised light, are among them.
        let modes = MODES.max(basis.degree() + 1);
        scratch.resize(rays, modes, basis.count());
        for (node, source_weights) in self.nodes_with_weights() {
            let suns = scratch.locate(&field.grid, self, node, bundle);
            let first_sun = suns.start;
            node.scatter(field, (basis, source_weights), suns, scratch);
            scratch.evaluate_cosines(node.mu, modes);
            for (slot, out) in out.iter_mut().enumerate() {
                let first = scratch.below[slot] as usize - first_sun;
                let (a, b) = (&scratch.row[first], &scratch.row[first + 1]);
                let fraction = scratch.fraction[slot];
                let (mut below, mut above) = (a.intensity[0], b.intensity[0]);
                for m in 1..modes {
                    let cosine = scratch.cosines[m * rays + slot];
                    below = below.scale_acc(a.intensity[m], cosine);
                    above = above.scale_acc(b.intensity[m], cosine);
                }
                let line = lerp(a.log_intensity, b.log_intensity, fraction);
                let intensity = (line + scratch.bends[first].at(fraction)).exp();
                *out = out.mul_acc(lerp(below, above, fraction).max_scalar(0.0), intensity);
                if let Some(linear) = &mut linear {
                    let one = scratch.cosines[rays + slot];
                    let two = scratch.cosines[2 * rays + slot];
                    let sine = (1.0 - one * one).max(0.0).sqrt();
                    let azimuth = ([one, two], [sine, 2.0 * sine * one]);
                    let [qa, ua] = a.linear(azimuth);
                    let [qb, ub] = b.linear(azimuth);
                    let linear = &mut linear[slot];
                    linear[0] = linear[0].mul_acc(lerp(qa, qb, fraction), intensity);
                    linear[1] = linear[1].mul_acc(lerp(ua, ub, fraction), intensity);
                }
            }
        }
    }

    /// Adds the light at the start of the path scattered from a field that is the same for all places with the same radius: the
    /// coefficients of its moments, `[radius][moment]`, for harmonics of `basis` and a direction at azimuth 0.
    #[inline(always)]
    pub fn accumulate_response(&self, basis: &Harmonics, y: &mut [f32], out: &mut Response<N>) {
        let count = basis.count();
        let stride = out.stride;
        for (node, source_weights) in self.nodes_with_weights() {
            let sin = (1.0 - node.mu * node.mu).max(0.0).sqrt();
            basis.evaluate(node.mu, sin, y);
            let RadialStencil { first, weights } = node.place;
            let points = out.intensity[first * stride..].chunks_exact_mut(stride);
            for (out, w) in points.zip(weights) {
                for (l, source) in source_weights.iter().enumerate() {
                    for k in basis.span(l) {
                        out[k] = out[k].scale_acc(*source, w * y[k]);
                    }
                }
                let [to_intensity, ..] = &node.polarised_weights;
                for (m, out) in out[count..].iter_mut().enumerate() {
                    *out = out.scale_acc(*to_intensity, w * y[Harmonics::index(2, m)]);
                }
            }
            let linear = &node.polarised_weights[1..];
            if stride > count {
                let amplitudes = TensorHarmonics::amplitudes(node.mu);
                for (factors, out) in [&amplitudes.q, &amplitudes.u]
                    .into_iter()
                    .zip(&mut out.linear)
                {
                    for (out, w) in out[first..].iter_mut().zip(weights) {
                        for (sums, weight) in out.iter_mut().zip(linear) {
                            for (sum, factor) in sums.iter_mut().zip(factors) {
                                *sum = sum.scale_acc(*weight, w * factor);
                            }
                        }
                    }
                }
            }
        }
    }

    /// The nodes with their source weights by degree.
    #[inline(always)]
    fn nodes_with_weights(&self) -> impl Iterator<Item = (&PathNode<N>, &[Spectrum<N>])> {
        self.nodes
            .iter()
            .zip(self.source_weights.chunks_exact(self.degrees))
    }

    /// Transmittance to the ground, if the path ends there.
    #[inline(always)]
    pub fn transmittance_to_ground(&self) -> Option<Spectrum<N>> {
        self.ground.map(|(_, transmittance)| transmittance)
    }

    /// Adds the attenuated ground radiance to each ray, for the irradiance on the ground `irradiance(sun cosine)`.
    #[inline(always)]
    pub fn accumulate_ground(
        &self,
        air: &Air<N>,
        bundle: &RayBundle,
        irradiance: impl Fn(f64) -> Spectrum<N>,
        out: &mut [Spectrum<N>],
    ) {
        let Some((t, transmittance)) = self.ground else {
            return;
        };
        for (slot, out) in out.iter_mut().enumerate() {
            let mu_sun = bundle
                .ray((self.radius_m, self.mu), slot)
                .advanced(t)
                .mu_sun;
            *out = out.mul_acc(
                transmittance,
                air.coefficients.reflected(irradiance(mu_sun)),
            );
        }
    }
}

impl<const N: usize> PathNode<N> {
    /// Computes what the node scatters of the light of `field`, of the moments up to the degree of `basis`, under each of `suns`.
    #[inline(always)]
    fn scatter(
        &self,
        field: &RadianceField<N>,
        (basis, source_weights): (&Harmonics, &[Spectrum<N>]),
        suns: Range<usize>,
        scratch: &mut Scratch<N>,
    ) {
        let count = basis.count();
        let sin = (1.0 - self.mu * self.mu).max(0.0).sqrt();
        let y = &mut scratch.y[..count];
        basis.evaluate(self.mu, sin, y);
        let factors = &mut scratch.factors[..count];
        for (l, weight) in source_weights.iter().enumerate() {
            for k in basis.span(l) {
                factors[k] = *weight * y[k];
            }
        }
        let [to_intensity, natural, kept] = self.polarised_weights;
        let amplitudes = TensorHarmonics::amplitudes(self.mu);
        scratch.bends.clear();
        let intervals = suns.start..suns.end - 1;
        scratch
            .bends
            .extend(intervals.map(|interval| field.bend(self.place, interval)));
        scratch.row.resize(suns.len(), Modes::NONE);
        for (modes, sun) in scratch.row.iter_mut().zip(suns) {
            let points = field.at_radius(self.place, sun);
            let moments = points.part(0, count);
            modes.log_intensity = moments.at(0);
            modes.intensity = [Spectrum::ZERO; Harmonics::MAX_DEGREE + 1];
            modes.intensity[0] = factors[0];
            for l in 1..=basis.degree() {
                let first = Harmonics::index(l, 0);
                for m in 0..=l {
                    let sum = &mut modes.intensity[m];
                    *sum = sum.mul_acc(factors[first + m], moments.at(first + m));
                }
            }
            if let Some(start) = field.polarised_start() {
                let polarised = points.part(start, POLARISED);
                for m in 0..POLARISED {
                    let e = polarised.at(m);
                    let degree_2 = Harmonics::index(2, m);
                    let sum = &mut modes.intensity[m];
                    *sum = sum.mul_acc(to_intensity * y[degree_2], e);
                    let scattered = (moments.at(degree_2) * natural).mul_acc(e, kept);
                    modes.q[m] = scattered * amplitudes.q[m];
                    if m > 0 {
                        modes.u[m - 1] = scattered * amplitudes.u[m];
                    }
                }
            }
            if let (Some(place), Some(start)) = (self.horizon, field.horizon_start()) {
                let beside = points.part(start + place.first, 2 * MODES);
                let [first, second] = place.weights();
                for m in 0..MODES {
                    let value = (beside.at(m) * first).scale_acc(beside.at(MODES + m), second);
                    let sum = &mut modes.intensity[m];
                    *sum = sum.mul_acc(value, self.peak_weight);
                }
            }
        }
    }
}

/// Response of the light along a path to the moments of a field that is the same for all places with the same radius. Azimuthal mode m
/// of a field gives light with the same mode: `I` and `Q` with the cosine of `m` times the azimuth, `U` with the sine.
pub struct Response<const N: usize> {
    /// Number of moments at each radius: those of the intensity, and those of the polarisation if light is polarised.
    pub stride: usize,
    /// Coefficients of the moments in `I`, `[radius][moment]`.
    pub intensity: Vec<Spectrum<N>>,
    /// Coefficients in `Q` and in `U` of the moments of degree 2 of the intensity, and of those of polarisation:
    /// `[radius][which][m]`.
    pub linear: [Vec<[[Spectrum<N>; POLARISED]; 2]>; 2],
}

impl<const N: usize> Response<N> {
    /// No response, for light at `radii` radii with `stride` moments.
    pub fn new(radii: usize, stride: usize) -> Self {
        let linear = || vec![[[Spectrum::ZERO; POLARISED]; 2]; radii];
        Self {
            stride,
            intensity: vec![Spectrum::ZERO; radii * stride],
            linear: [linear(), linear()],
        }
    }

    /// Sets all coefficients to 0.
    pub fn clear(&mut self) {
        self.intensity.fill(Spectrum::ZERO);
        for part in &mut self.linear {
            part.fill([[Spectrum::ZERO; POLARISED]; 2]);
        }
    }
}

impl<const N: usize> Scratch<N> {
    #[inline(always)]
    fn resize(&mut self, rays: usize, modes: usize, harmonics: usize) {
        for list in [&mut self.mu_sun, &mut self.toward_sun, &mut self.fraction] {
            list.resize(rays, 0.0);
        }
        self.below.resize(rays, 0);
        self.cosines.resize(modes * rays, 0.0);
        self.y.resize(harmonics, 0.0);
        self.factors.resize(harmonics, Spectrum::ZERO);
    }

    /// Computes the cosines of the multiples of the azimuth of each ray where the cosine of its zenith angle is `mu`.
    #[inline(always)]
    fn evaluate_cosines(&mut self, mu: f32, modes: usize) {
        let rays = self.toward_sun.len();
        let inverse_sin = 1.0 / (1.0 - mu * mu).max(1e-9).sqrt();
        let (ones, rest) = self.cosines.split_at_mut(rays);
        ones.fill(1.0);
        for (cosine, toward_sun) in rest.iter_mut().zip(&self.toward_sun) {
            *cosine = (toward_sun * inverse_sin).clamp(-1.0, 1.0);
        }
        for m in 2..modes {
            let (done, rest) = self.cosines.split_at_mut(m * rays);
            let (one, two) = (&done[(m - 1) * rays..], &done[(m - 2) * rays..][..rays]);
            let first = &done[rays..2 * rays];
            for (slot, cosine) in rest[..rays].iter_mut().enumerate() {
                *cosine = 2.0 * first[slot] * one[slot] - two[slot];
            }
        }
    }

    /// Computes for each ray the position of the sun relative to `node` and its interval in the sun cosines of the grid; returns
    /// the sun cosines that are used.
    #[inline(always)]
    fn locate(
        &mut self,
        grid: &FieldGrid,
        path: &Path<N>,
        node: &PathNode<N>,
        bundle: &RayBundle,
    ) -> Range<usize> {
        let rays = bundle.len();
        let (mu_suns, towards) = (&mut self.mu_sun[..rays], &mut self.toward_sun[..rays]);
        let (nus, starts) = (&bundle.nu[..rays], &bundle.mu_sun[..rays]);
        let inverse = 1.0 / node.radius_m;
        let sin = (1.0 - node.mu * node.mu).max(0.0).sqrt();
        for slot in 0..rays {
            let mu_sun = ((path.radius_m * starts[slot] + node.t * nus[slot]) * inverse) as f32;
            let sin_sun = (1.0 - mu_sun * mu_sun).max(1e-9).sqrt();
            let toward = (nus[slot] as f32 - node.mu * mu_sun) / sin_sun;
            mu_suns[slot] = mu_sun;
            towards[slot] = toward.max(-sin).min(sin);
        }
        let nodes = &grid.sun_cosines;
        let (below, fraction) = (&mut self.below[..rays], &mut self.fraction[..rays]);
        below.fill(0);
        for &cosine in &nodes[1..nodes.len() - 1] {
            let cosine = cosine as f32;
            for slot in 0..rays {
                below[slot] += u32::from(mu_suns[slot] >= cosine);
            }
        }
        for slot in 0..rays {
            let (a, b) = (
                nodes[below[slot] as usize] as f32,
                nodes[below[slot] as usize + 1] as f32,
            );
            fraction[slot] = ((mu_suns[slot] - a) / (b - a)).clamp(0.0, 1.0);
        }
        let first = below.iter().min().map_or(0, |&sun| sun as usize);
        let last = below.iter().max().map_or(0, |&sun| sun as usize);
        first..last + 2
    }
}
