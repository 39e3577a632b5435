//! Bundles of rays that share their starting radius and zenith angle, and the light along them.
//!
//! In a spherically symmetric atmosphere such rays cross the same radii at the same distances: quadrature nodes,
//! transmittances to the eye and radial interpolation are computed once, in a [`Path`], for the whole [`RayBundle`]. What
//! depends on the sun remains for each ray and is stored in arrays over the rays, so that the compiler vectorises it.

use super::air::Air;
use super::field::{FieldGrid, RadialStencil, RadianceField, polarised_moments, scattering_moment};
use super::harmonics::Harmonics;
use super::horizon::{self, HorizonPlace, MODES};
use super::polarised::{POLARISED, TensorHarmonics};
use crate::math::interpolation::lerp;
use crate::spectrum::Spectrum;
use crate::transfer::march::{MAX_NODES, Marcher};
use crate::transfer::ray::{Ray, in_shadow};
use crate::transfer::residual::stream_transmittances;
use crate::transfer::shell::PerConstituent;
use std::ops::{ControlFlow, Range};

/// What the rays of a bundle have in common: quadrature nodes, transmittances and densities along the path.
pub struct Path<const N: usize> {
    /// Radius of the start, m.
    pub radius_m: f64,
    /// Cosine of the zenith angle at the start.
    pub mu: f64,
    nodes: Vec<PathNode<N>>,
    /// Distance to the ground and transmittance to it, if the rays end there.
    ground: Option<(f64, Spectrum<N>)>,
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
    /// `weight` times the l-th phase moment of the scattering coefficients.
    source_weights: Vec<Spectrum<N>>,
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
    azimuthal: [Vec<f32>; 3],
    /// Basis functions, `[harmonic][ray]`.
    y: Vec<f32>,
    /// What a node scatters of the field at its radius, `[sun][moment]`.
    row: Vec<Spectrum<N>>,
    /// Intensity of the field at the node of each ray.
    intensity: Vec<Spectrum<N>>,
    tensor: TensorBundle,
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

impl<const N: usize> Path<N> {
    /// Traces a path from `radius_m` along `mu` through the whole atmosphere.
    #[inline(always)]
    pub fn new(
        air: &Air<N>,
        grid: Option<&FieldGrid>,
        marcher: &Marcher<'_>,
        (radius_m, mu): (f64, f64),
        degree: usize,
    ) -> Self {
        let mut path = Self {
            radius_m,
            mu,
            nodes: Vec::new(),
            ground: None,
        };
        // With the sun at the zenith no shadow edge crosses the ray, so the panels serve all sun angles.
        let ray = Ray {
            radius_m,
            mu,
            mu_sun: 1.0,
            nu: mu,
        };
        let Some(segment) = air.shell().segment(&ray, f64::INFINITY) else {
            return path;
        };
        // Optical depth from the start.
        let mut before = Spectrum::ZERO;
        let columns = marcher.march(
            air.shell(),
            &ray,
            (segment.start_m, segment.end_m),
            &mut Vec::new(),
            #[inline(always)]
            |nodes| {
                let first = path.nodes.len();
                let mut panel = Panel::<N>::default();
                for node in nodes {
                    let depth = air.coefficients.extinction(&node.columns_m);
                    let weight = (Spectrum::ZERO - depth).exp() * node.dt as f32;
                    let extinction = air.coefficients.extinction(&node.densities);
                    panel.add(
                        weight * extinction,
                        depth - before,
                        extinction * node.dt as f32,
                    );
                    let radius_m = node.here.radius_m;
                    path.nodes.push(PathNode {
                        t: node.t,
                        radius_m,
                        mu: node.here.mu as f32,
                        densities: node.densities,
                        place: grid.map_or(RadialStencil::GROUND, |g| g.place_of_radius(radius_m)),
                        weight,
                        removed: air.peaks.extinction(&node.columns_m),
                        source_weights: Vec::new(),
                        polarised_weights: [Spectrum::ZERO; 3],
                        linear_gain: linear_gain(air, &node.columns_m),
                        horizon: HorizonPlace::of(
                            radius_m,
                            node.here.mu,
                            air.shell().ground_radius_m,
                        ),
                        peak_weight: air.peaks.extinction(&node.densities),
                    });
                }
                let correct = panel.correction((Spectrum::ZERO - before).exp());
                for (node, &depth) in path.nodes[first..].iter_mut().zip(&panel.depths) {
                    node.weight *= correct.at(depth);
                    node.peak_weight *= node.weight;
                    node.source_weights = (0..=degree)
                        .map(|l| node.weight * scattering_moment(air, &node.densities, l))
                        .collect();
                    let [natural, kept] =
                        polarised_moments(air, &node.densities).map(|moment| node.weight * moment);
                    node.polarised_weights =
                        [natural, natural * node.linear_gain, kept * node.linear_gain];
                }
                before += panel.whole;
                if before.min_element() > 16.0 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        if segment.meets_ground {
            path.ground = Some((segment.end_m, air.coefficients.transmittance(&columns)));
        }
        path
    }

    /// True if the sun is above the planet's limb at all nodes of all rays.
    #[inline(always)]
    pub fn is_lit(&self, air: &Air<N>, bundle: &RayBundle) -> bool {
        let ground_radius_m = air.shell().ground_radius_m;
        self.nodes.iter().all(|node| {
            (0..bundle.len()).all(|slot| {
                let mu_sun = (self.radius_m * bundle.mu_sun[slot] + node.t * bundle.nu[slot])
                    / node.radius_m;
                !in_shadow(node.radius_m, mu_sun, ground_radius_m)
            })
        })
    }

    /// The first `K` streams of singly scattered sunlight along each ray, per unit scattering coefficient and without phase
    /// functions, into `out`: `[scatterer][stream][ray]`. With `LINEAR` one more stream is attenuated on its way to the eye as
    /// polarised light is.
    #[inline(always)]
    pub fn accumulate_sunlight<const K: usize, const LINEAR: bool>(
        &self,
        air: &Air<N>,
        bundle: &RayBundle,
        out: &mut Vec<Spectrum<N>>,
    ) {
        let shell = air.shell();
        out.clear();
        let count = K + usize::from(LINEAR);
        out.resize(air.scatterers.len() * count * bundle.len(), Spectrum::ZERO);
        for node in &self.nodes {
            let columns = air.columns.at(node.radius_m);
            for slot in 0..bundle.len() {
                let mu_sun = (self.radius_m * bundle.mu_sun[slot] + node.t * bundle.nu[slot])
                    / node.radius_m;
                let to_sun = if mu_sun >= 0.0 {
                    columns.to_space_m(mu_sun as f32)
                } else if in_shadow(node.radius_m, mu_sun, shell.ground_radius_m) {
                    continue;
                } else {
                    let to_sun = air.columns.to_space_m(node.radius_m, mu_sun);
                    to_sun.map(|column| column as f32)
                };
                let depth = air.coefficients.extinction_f32(&to_sun);
                let arriving = node.weight * (Spectrum::ZERO - depth).exp();
                let streams =
                    stream_transmittances(node.removed + air.peaks.extinction_f32(&to_sun));
                for (place, s) in air.scatterers.iter().enumerate() {
                    let density = node.densities[s.constituent] as f32;
                    let mut add = |k: usize, factor: Spectrum<N>| {
                        let sum = &mut out[(place * count + k) * bundle.len() + slot];
                        *sum = sum.scale_acc(arriving * factor, density);
                    };
                    for (k, stream) in streams[..K].iter().enumerate() {
                        add(k, *stream);
                    }
                    if LINEAR {
                        add(K, node.linear_gain);
                    }
                }
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
        let (rays, count) = (bundle.len(), basis.count());
        let polarised_end = count + if field.is_polarised() { POLARISED } else { 0 };
        scratch.resize(rays, count);
        for node in &self.nodes {
            let suns = scratch.locate(&field.grid, self, node, bundle);
            let first_sun = suns.start;
            let horizon = node.horizon.filter(|_| field.horizon_start().is_some());
            field.at_radius(node.place, suns, count, horizon, &mut scratch.row);
            let stride = polarised_end + horizon.map_or(0, |_| 2 * MODES);
            for point in scratch.row.chunks_exact_mut(stride) {
                let (moments, beside) = point.split_at_mut(polarised_end);
                node.scatter(basis, moments);
                if let Some(place) = horizon {
                    node.scatter_at_horizon(place, beside);
                }
            }
            basis.evaluate_bundle(
                node.mu,
                &scratch.toward_sun,
                &mut scratch.azimuthal,
                &mut scratch.y,
            );
            let inverse_sin = 1.0 / (1.0 - node.mu * node.mu).max(1e-9).sqrt();
            let interval = |slot: usize| {
                let below = (scratch.below[slot] as usize - first_sun) * stride;
                scratch.row[below..below + 2 * stride].split_at(stride)
            };
            for (slot, out) in out.iter_mut().enumerate() {
                let (a, b) = interval(slot);
                let fraction = scratch.fraction[slot];
                let (mut below, mut above) = (node.source_weights[0], node.source_weights[0]);
                let y = scratch.y[slot];
                (below, above) = (below * y, above * y);
                for k in 1..count {
                    let y = scratch.y[k * rays + slot];
                    below = below.scale_acc(a[k], y);
                    above = above.scale_acc(b[k], y);
                }
                if horizon.is_some() {
                    let cosine = (scratch.toward_sun[slot] * inverse_sin).clamp(-1.0, 1.0);
                    for (m, mode) in horizon::modes(cosine).into_iter().enumerate() {
                        below = below.scale_acc(a[polarised_end + m], mode);
                        above = above.scale_acc(b[polarised_end + m], mode);
                    }
                }
                let intensity = lerp(a[0], b[0], fraction).exp();
                scratch.intensity[slot] = intensity;
                *out = out.mul_acc(lerp(below, above, fraction).max_scalar(0.0), intensity);
            }
            if let Some(linear) = &mut linear {
                scratch.tensor.evaluate(node.mu, &scratch.toward_sun);
                let TensorBundle {
                    q0,
                    q: [q1, q2],
                    u: [u1, u2],
                } = &scratch.tensor;
                for (slot, linear) in linear.iter_mut().enumerate() {
                    let (a, b) = interval(slot);
                    let q = |e: &[Spectrum<N>]| {
                        (e[count] * *q0)
                            .scale_acc(e[count + 1], q1[slot])
                            .scale_acc(e[count + 2], q2[slot])
                    };
                    let u = |e: &[Spectrum<N>]| {
                        (e[count + 1] * u1[slot]).scale_acc(e[count + 2], u2[slot])
                    };
                    let (fraction, intensity) = (scratch.fraction[slot], scratch.intensity[slot]);
                    linear[0] = linear[0].mul_acc(lerp(q(a), q(b), fraction), intensity);
                    linear[1] = linear[1].mul_acc(lerp(u(a), u(b), fraction), intensity);
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
        for node in &self.nodes {
            let sin = (1.0 - node.mu * node.mu).max(0.0).sqrt();
            basis.evaluate(node.mu, sin, y);
            let RadialStencil { first, weights } = node.place;
            let points = out.intensity[first * stride..].chunks_exact_mut(stride);
            for (out, w) in points.zip(weights) {
                for (l, source) in node.source_weights.iter().enumerate() {
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
    /// Replaces the values at the two nodes beside the horizon by what the node adds of them in each azimuthal mode.
    #[inline(always)]
    fn scatter_at_horizon(&self, place: HorizonPlace, values: &mut [Spectrum<N>]) {
        let [first, second] = place.weights();
        for m in 0..MODES {
            let value = (values[m] * first).scale_acc(values[MODES + m], second);
            values[m] = value * self.peak_weight;
        }
    }

    /// Replaces the stored moments of a field, of which the first are those of `basis` and the last those of polarisation, by what the
    /// node scatters of them relative to the intensity; the logarithm of the intensity remains.
    #[inline(always)]
    fn scatter(&self, basis: &Harmonics, point: &mut [Spectrum<N>]) {
        let (intensity, polarised) = point.split_at_mut(basis.count());
        let [to_intensity, natural, kept] = self.polarised_weights;
        for (l, weight) in self.source_weights.iter().enumerate().skip(1) {
            let degree = &mut intensity[basis.span(l)];
            if l == 2 && !polarised.is_empty() {
                for (moment, e) in degree.iter_mut().zip(polarised.iter_mut()) {
                    let scattered = (*moment * natural).mul_acc(*e, kept);
                    *moment = (*moment * *weight).mul_acc(*e, to_intensity);
                    *e = scattered;
                }
            } else {
                for moment in degree {
                    *moment *= *weight;
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

/// [`TensorHarmonics`] of the rays of a bundle: those that differ from 0, of order 0 for all rays, then for each ray.
#[derive(Default)]
struct TensorBundle {
    q0: f32,
    q: [Vec<f32>; 2],
    u: [Vec<f32>; 2],
}

impl TensorBundle {
    #[inline(always)]
    fn evaluate(&mut self, mu: f32, toward_sun: &[f32]) {
        let rays = toward_sun.len();
        for list in self.q.iter_mut().chain(&mut self.u) {
            list.resize(rays, 0.0);
        }
        let amplitudes = TensorHarmonics::amplitudes(mu);
        let inverse = 1.0 / (1.0 - mu * mu).max(1e-9).sqrt();
        self.q0 = amplitudes.q[0];
        let [[q1, q2], [u1, u2]] = [&mut self.q, &mut self.u];
        let (q1, q2) = (&mut q1[..rays], &mut q2[..rays]);
        let (u1, u2) = (&mut u1[..rays], &mut u2[..rays]);
        for slot in 0..rays {
            let harmonics = amplitudes.at(toward_sun[slot] * inverse);
            (q1[slot], q2[slot]) = (harmonics.q[1], harmonics.q[2]);
            (u1[slot], u2[slot]) = (harmonics.u[1], harmonics.u[2]);
        }
    }
}

impl<const N: usize> Scratch<N> {
    #[inline(always)]
    fn resize(&mut self, rays: usize, harmonics: usize) {
        for list in [&mut self.mu_sun, &mut self.toward_sun, &mut self.fraction] {
            list.resize(rays, 0.0);
        }
        for list in &mut self.azimuthal {
            list.resize(rays, 0.0);
        }
        self.below.resize(rays, 0);
        self.intensity.resize(rays, Spectrum::ZERO);
        self.y.resize(rays * harmonics, 0.0);
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
