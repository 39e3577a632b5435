//! Path tracing from the eye with next-event estimation of sunlight.
//!
//! A path has vertices `x1, x2, ...`; at each, direct sunlight is added to its order of scattering. All lanes share the
//! path. Its geometry is drawn for one lane, the hero wavelength, and weighted by the mean of the densities of all possible
//! heroes (the balance heuristic: Wilkie, Nawaz, Droske, Weidlich & Hanika, Comput. Graph. Forum 33(4), 123, 2014), so
//! that no lane's weight exceeds N times that of its own paths.

use super::chord::{Chord, End, HalfLine};
use super::lanes::{self, Lanes, PerScatterer};
use super::layers::Layers;
use super::lit::{Lit, LitSegment};
use super::stokes::Polarisation;
use super::sun::SunShape;
use crate::math::random::Random;
use crate::spectrum::Spectrum;
use crate::sun::SunDisc;
use crate::transfer::ray::Ray;
use crate::transfer::shell::MAX_CONSTITUENTS;
use glam::DVec3;
use std::f64::consts::PI;

/// Number of separate orders of scattering: one to four, and all higher ones together.
pub const ORDERS: usize = 5;
/// Radiance of each order per unit solar irradiance, 1/sr.
pub type ByOrder<const N: usize> = [Spectrum<N>; ORDERS];

/// Probability of sampling a new direction about the sun instead of about the current direction.
const TOWARDS_SUN: f64 = 0.2;
/// Number of scatterings and reflections after which directions follow the phase function alone: the weights of thousands of choices
/// between two lobes would vary by orders of magnitude.
const TOWARDS_SUN_ORDERS: usize = 20;
/// Russian roulette applies to paths whose expected contribution is below this fraction of that at the first vertex.
const ROULETTE_THRESHOLD: f32 = 0.3;

/// Atmosphere and sun for path tracing.
pub struct PathScene<'a, const N: usize> {
    /// Densities by layer.
    pub layers: &'a Layers,
    /// Optical coefficients.
    pub lanes: &'a Lanes<N>,
    /// Unit vector to the centre of the sun.
    pub sun: DVec3,
    /// Disc of the sun.
    pub disc: &'a SunDisc,
    /// Whether the disc is sampled, or the sun is a point.
    pub shape: SunShape,
}

/// A view ray.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Origin inside the atmosphere, m from the planet's centre.
    pub place: DVec3,
    /// Unit vector along the ray.
    pub direction: DVec3,
    /// Length in m, for path radiance up to there. `None`: to the ground, whose light is included, or to space.
    pub reach_m: Option<f64>,
}

/// State of a path.
struct Path<const N: usize> {
    place: DVec3,
    direction: DVec3,
    /// Throughput of each lane: the product of the scattering, reflection and transmittance factors, divided by the mean of
    /// the densities with which the heroes draw this path.
    throughput: Spectrum<N>,
    /// Density with which each hero draws this path, divided by their mean.
    pdf: Spectrum<N>,
    /// Number of scatterings and reflections so far.
    order: usize,
    /// Estimated contribution of the next vertex, relative to a path that is not scattered towards the sun.
    expected_contribution: f32,
    /// Throughput at the first vertex.
    first_throughput: f32,
}

impl<const N: usize> Path<N> {
    /// Extends the path by a step with a throughput factor and the density `pdf` of each hero.
    #[inline(always)]
    fn step(&mut self, throughput: Spectrum<N>, pdf: Spectrum<N>) {
        let pdf = self.pdf * pdf;
        let mean = pdf.0.iter().sum::<f32>() / N as f32;
        let scale = 1.0 / mean;
        self.throughput = self.throughput * throughput * scale;
        self.pdf = pdf * scale;
    }

    /// Russian roulette: terminates paths with a small expected contribution and reweights the survivors.
    #[inline(always)]
    fn survives(&mut self, random: &mut Random) -> bool {
        if self.order == 1 {
            self.first_throughput = self.throughput.max_element();
        }
        let survival = self.expected_contribution / (ROULETTE_THRESHOLD * self.first_throughput);
        if survival >= 1.0 {
            return true;
        }
        // False also if the throughput is NaN.
        let survives = (random.unit() as f32) < survival;
        if survives {
            self.throughput = self.throughput * (1.0 / survival);
        }
        survives
    }
}

/// End of a path segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    /// Collision in the air.
    Air,
    /// Hit on the ground.
    Ground,
    /// No collision.
    None,
}

impl<const N: usize> PathScene<'_, N> {
    /// Traces a path along a view ray for the lane `hero`. `first`, uniform in `(0, 1)`, samples the first collision; `chord`
    /// is scratch memory.
    #[inline(always)]
    pub fn follow<P: Polarisation<N>>(
        &self,
        line: &Line,
        hero: usize,
        first: f64,
        random: &mut Random,
        chord: &mut Chord,
        polarisation: &mut P,
    ) -> ByOrder<N> {
        let mut found = [Spectrum::ZERO; ORDERS];
        let mut path = Path {
            place: line.place,
            direction: line.direction,
            throughput: Spectrum::ONE,
            pdf: Spectrum::ONE,
            order: 0,
            expected_contribution: 0.0,
            first_throughput: 0.0,
        };
        let mut choice = first;
        let mut reach_m = line.reach_m;
        loop {
            match self.advance(&mut path, hero, choice, reach_m, random, chord) {
                Event::Air => {
                    if !self.scatter(&mut path, hero, random, &mut found, polarisation) {
                        return found;
                    }
                }
                Event::Ground => self.reflect(&mut path, random, &mut found, polarisation),
                Event::None => return found,
            }
            if !path.survives(random) {
                return found;
            }
            choice = random.unit();
            reach_m = None;
        }
    }

    /// Advances the path to the next vertex. If the segment ends in space or at the distance `reach_m`, a collision is forced.
    #[inline(always)]
    fn advance(
        &self,
        path: &mut Path<N>,
        hero: usize,
        choice: f64,
        reach_m: Option<f64>,
        random: &mut Random,
        chord: &mut Chord,
    ) -> Event {
        let layers = self.layers;
        let line = HalfLine::new(path.place, path.direction);
        let mut end = chord.cross(layers, line);
        if let Some(reach_m) = reach_m {
            chord.cut(layers, line.start + reach_m);
            end = End::Space;
        }
        let whole_depth = self.lanes.coefficients.extinction(&chord.columns);
        let absorbed = lanes::absorbed(whole_depth);
        let mut choice = choice;
        let mut collides = Spectrum::ONE;
        if end == End::Ground {
            let hit_probability = 1.0 - absorbed[hero] as f64;
            if choice < hit_probability {
                let transmittance = self.transmittance_to(chord, chord.end(), random);
                path.step(transmittance, Spectrum::ONE - absorbed);
                path.place += path.direction * (chord.end() - line.start);
                return Event::Ground;
            }
            choice = (choice - hit_probability) / (1.0 - hit_probability);
            collides = absorbed;
        }
        if absorbed[hero] <= 0.0 {
            return Event::None;
        }
        let lit = self.lit_segments(path, chord, line);
        let (t, share) = lit.draw(self.lanes, (layers, chord), hero, choice, &absorbed);
        let columns = chord.columns_to(layers, t);
        let layer = layers.layer(chord.layer_at(t));
        let control = layer.densities_of(layer.coordinate(line.tangent + t * t));
        let pdf = self.lanes.coefficients.extinction(&control)
            * self.lanes.coefficients.transmittance(&columns)
            * share
            * collides;
        path.step(self.transmittance_to(chord, t, random), pdf);
        path.place += path.direction * (t - line.start);
        Event::Air
    }

    /// Unbiased estimate of the transmittance from the start of a chord to `t`: that of the control medium, corrected at
    /// residual collisions (residual ratio tracking: Novak, Selle & Jarosz, ACM Trans. Graph. 33(6), 179, 2014).
    #[inline(always)]
    fn transmittance_to(&self, chord: &Chord, t: f64, random: &mut Random) -> Spectrum<N> {
        let mut transmittance = self
            .lanes
            .coefficients
            .transmittance(&chord.columns_to(self.layers, t));
        chord.residual(self.layers, t, random, |square, layer| {
            transmittance *= self.residual_weight(square, layer);
        });
        transmittance
    }

    /// Weight `1 - (extinction - control extinction) / residual` of a residual collision at a squared radius.
    fn residual_weight(&self, square: f64, layer: usize) -> Spectrum<N> {
        let truth = self.layers.densities_at(square.sqrt());
        let layer = self.layers.layer(layer);
        let control = layer.densities_of(layer.coordinate(square));
        let mut difference = [0.0; MAX_CONSTITUENTS];
        for (d, (truth, control)) in difference.iter_mut().zip(truth.iter().zip(control)) {
            *d = truth - control;
        }
        Spectrum::ONE
            - self.lanes.coefficients.extinction(&difference) * (1.0 / layer.residual_per_m) as f32
    }

    /// Adds direct sunlight at a vertex in the air and samples a new direction; false if the path ends.
    #[inline(always)]
    fn scatter<P: Polarisation<N>>(
        &self,
        path: &mut Path<N>,
        hero: usize,
        random: &mut Random,
        found: &mut ByOrder<N>,
        polarisation: &mut P,
    ) -> bool {
        let densities = self.layers.densities_at(path.place.length());
        let scattering = self.lanes.scattering(&densities);
        let sun = self.shape.draw(self.sun, self.disc, random);
        if let Some(light) = self.sunlight(path.place, sun, random) {
            let phases = self.lanes.phases(path.direction.dot(sun).clamp(-1.0, 1.0));
            let scattered = lanes::phased(&scattering, &phases);
            let light = path.throughput * scattered * light;
            found[path.order.min(ORDERS - 1)] += light;
            let directions = [path.direction, sun];
            polarisation.sunlight(self.lanes, directions, [&scattering, &phases], light);
        }
        let whole = lanes::sum(&scattering);
        if whole[hero] <= 0.0 {
            return false;
        }
        let towards_sun = match path.order < TOWARDS_SUN_ORDERS {
            true => TOWARDS_SUN,
            false => 0.0,
        };
        let axis = match random.unit() < towards_sun {
            true => self.sun,
            false => path.direction,
        };
        let cosine = self.lanes.sample(&scattering, hero, random);
        let next = direction_about(axis, cosine, random.unit());
        let phases = self.phases_between(path.direction, next);
        let onward = lanes::phased(&scattering, &phases);
        let sunward = lanes::phased(&scattering, &self.phases_between(self.sun, next));
        let (onward_share, sunward_share) = ((1.0 - towards_sun) as f32, towards_sun as f32);
        let norm = whole.max_scalar(f32::MIN_POSITIVE);
        let pdf = (onward * onward_share + sunward * sunward_share) / norm;
        path.step(onward, pdf);
        let directions = [path.direction, next];
        polarisation.scattered(self.lanes, directions, [&scattering, &phases]);
        path.direction = next;
        path.order += 1;
        // A path towards the sun will find more light than others.
        let isotropic = (0.25 / PI) as f32;
        path.expected_contribution = path.throughput.max_element();
        if towards_sun > 0.0 {
            path.expected_contribution *= (sunward / norm).max_element().max(isotropic) / isotropic;
        }
        true
    }

    #[inline(always)]
    fn phases_between(&self, a: DVec3, b: DVec3) -> PerScatterer<N> {
        self.lanes.phases(a.dot(b).clamp(-1.0, 1.0))
    }

    /// Adds direct sunlight at a vertex on the ground and samples a cosine-distributed direction.
    #[inline(always)]
    fn reflect<P: Polarisation<N>>(
        &self,
        path: &mut Path<N>,
        random: &mut Random,
        found: &mut ByOrder<N>,
        polarisation: &mut P,
    ) {
        let up = path.place.normalize();
        // Projects the vertex onto the ground, so that rounding does not place it below.
        path.place = up * self.layers.edge(0).sqrt();
        path.throughput *= self.lanes.coefficients.ground_albedo;
        let sun = self.shape.draw(self.sun, self.disc, random);
        let height = up.dot(sun);
        if height > 0.0
            && let Some(light) = self.sunlight(path.place, sun, random)
        {
            let light = path.throughput * light * (height / PI) as f32;
            found[path.order.min(ORDERS - 1)] += light;
            polarisation.sunlight_by_ground(light);
        }
        polarisation.reflected();
        path.direction = direction_about(up, random.unit().sqrt(), random.unit());
        path.order += 1;
        path.expected_contribution = path.throughput.max_element();
    }

    /// Direct sunlight from the direction `sun`, per unit irradiance; `None` in the planet's shadow.
    #[inline(always)]
    fn sunlight(&self, place: DVec3, sun: DVec3, random: &mut Random) -> Option<Spectrum<N>> {
        let line = HalfLine::new(place, sun);
        if line.meets_ground(self.layers) {
            return None;
        }
        let (columns, residual) = line.to_space(self.layers);
        let mut light = self.lanes.coefficients.transmittance(&columns);
        let first = -random.unit().ln();
        if first < residual {
            line.residual_places(self.layers, first, random, |square, layer| {
                light *= self.residual_weight(square, layer);
            });
        }
        Some(
            self.shape
                .limb(light, self.sun, sun, self.disc, &self.lanes.wavelengths_nm),
        )
    }

    /// Sunlit segments of a chord that is partly in shadow.
    #[inline(always)]
    fn lit_segments(&self, path: &Path<N>, chord: &Chord, line: HalfLine) -> Lit<N> {
        let ray = Ray::new(path.place, path.direction, self.sun);
        let ground = self.layers.edge(0).sqrt();
        let mut cuts = [line.start, chord.end(), chord.end(), chord.end()];
        let mut count = 1;
        for edge in ray.shadow_edges(ground).into_iter().flatten() {
            let t = line.start + edge;
            if t > line.start && t < chord.end() {
                cuts[count] = t;
                count += 1;
            }
        }
        if count == 1 {
            return Lit::default();
        }
        if count == 3 && cuts[1] > cuts[2] {
            cuts.swap(1, 2);
        }
        let mut lit = Lit::default();
        for k in 0..count {
            let middle = 0.5 * (cuts[k] + cuts[k + 1]) - line.start;
            let here = ray.advanced(middle);
            if !crate::transfer::ray::in_shadow(here.radius_m, here.mu_sun, ground) {
                let before = chord.columns_to(self.layers, cuts[k]);
                let until = chord.columns_to(self.layers, cuts[k + 1]);
                let mut between = [0.0; MAX_CONSTITUENTS];
                for (b, (u, v)) in between.iter_mut().zip(until.iter().zip(&before)) {
                    *b = (u - v).max(0.0);
                }
                lit.segments[lit.count] = LitSegment {
                    from: cuts[k],
                    to: cuts[k + 1],
                    absorbed: self.lanes.coefficients.transmittance(&before)
                        * lanes::absorbed(self.lanes.coefficients.extinction(&between)),
                };
                lit.count += 1;
            }
        }
        lit
    }
}

/// Unit vector at an angle from `axis` with the given cosine, rotated about it by the fraction `turn` of a full turn.
#[inline(always)]
fn direction_about(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (across, up) = axis.any_orthonormal_pair();
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * turn).sin_cos();
    (across * (sine * cos) + up * (sine * sin) + axis * cosine).normalize()
}
