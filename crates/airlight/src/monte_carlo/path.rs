//! One random path from the eye into the air, and the sunlight that it finds.
//!
//! A path goes through vertices `x1, x2, ...`; at each the light that comes straight from the sun is added to the order
//! of scattering that it belongs to. Every lane sees the same path. Its geometry is drawn for one lane, the hero, and
//! weighed by what the mean over all possible heroes would have drawn it with (the balance heuristic: Wilkie, Nawaz,
//! Droske, Weidlich & Hanika, Comput. Graph. Forum 33(4), 123, 2014), so no lane's weight is ever more than N times what its own
//! paths would have.

use super::chord::{Chord, End, HalfLine};
use super::lanes::{self, Lanes, PerScatterer};
use super::layers::Layers;
use super::lit::{Lit, Stretch};
use super::stokes::Polarisation;
use super::sun::SunShape;
use crate::math::random::Random;
use crate::spectrum::Spectrum;
use crate::sun::SunDisc;
use crate::transfer::ray::Ray;
use crate::transfer::shell::MAX_CONSTITUENTS;
use glam::DVec3;
use std::f64::consts::PI;

/// Orders of scattering told apart: one to four, and all beyond.
pub const ORDERS: usize = 5;
/// Light found in each order, per unit solar irradiance, 1/sr.
pub type ByOrder<const N: usize> = [Spectrum<N>; ORDERS];

/// With this probability a new direction is drawn about the sun instead of about the way so far.
const TOWARDS_SUN: f64 = 0.2;
/// Paths that carry less than this share of what they carried at the first vertex may be ended.
const ROULETTE_THRESHOLD: f32 = 0.3;

/// The air and the sun that paths run through.
pub struct PathScene<'a, const N: usize> {
    /// Where the air is.
    pub layers: &'a Layers,
    /// What it does.
    pub lanes: &'a Lanes<N>,
    /// Unit vector to the middle of the sun.
    pub sun: DVec3,
    /// Its disc.
    pub disc: &'a SunDisc,
    /// Whether the disc is sampled.
    pub shape: SunShape,
}

/// A line of sight.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where it begins, inside the air: m from the planet's centre.
    pub place: DVec3,
    /// Unit vector along it.
    pub direction: DVec3,
    /// How far it goes, m: only the air up to there is seen. Else, to the ground, which is seen, or to space.
    pub reach_m: Option<f64>,
}

/// A path as far as it has come.
struct Path<const N: usize> {
    place: DVec3,
    direction: DVec3,
    /// What a photon found here is worth in each lane: the product of all that the air does to it, over the mean of
    /// the densities with which the heroes draw this path.
    throughput: Spectrum<N>,
    /// Density with which each hero draws this path, over their mean.
    drawn: Spectrum<N>,
    /// Orders of scattering behind it.
    order: usize,
    /// About what the light at the next vertex may be worth, over that of a path that is not scattered towards the sun.
    pdf: f32,
    /// Its worth at the first vertex.
    first_throughput: f32,
}

impl<const N: usize> Path<N> {
    /// Goes on by a step that is worth `throughput` and that the heroes draw with the densities `drawn`.
    #[inline(always)]
    fn step(&mut self, throughput: Spectrum<N>, drawn: Spectrum<N>) {
        let drawn = self.drawn * drawn;
        let mean = drawn.0.iter().sum::<f32>() / N as f32;
        let scale = 1.0 / mean;
        self.throughput = self.throughput * throughput * scale;
        self.drawn = drawn * scale;
    }

    /// Russian roulette among paths of little promise: those left carry what the others would have.
    #[inline(always)]
    fn survives(&mut self, random: &mut Random) -> bool {
        if self.order == 1 {
            self.first_throughput = self.throughput.max_element();
        }
        let survival = self.pdf / (ROULETTE_THRESHOLD * self.first_throughput);
        if survival >= 1.0 {
            return true;
        }
        // False also where the worth is no number.
        let lives = (random.unit() as f32) < survival;
        if lives {
            self.throughput = self.throughput * (1.0 / survival);
        }
        lives
    }
}

/// What happened on a straight way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    /// Scattered, in this layer.
    Air,
    /// Met the ground.
    Ground,
    /// Nothing to meet.
    None,
}

impl<const N: usize> PathScene<'_, N> {
    /// Follows a path drawn for the lane `hero` along a line of sight. `first`, even in `(0, 1)`, says where it is
    /// scattered first; `chord` is scratch space.
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
            drawn: Spectrum::ONE,
            order: 0,
            pdf: 0.0,
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

    /// From the place along the direction to the next vertex. Where there is nothing to meet at the end of the way, in
    /// space or at the distance `reach_m`, a collision is forced.
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
        let whole_depth = self.lanes.extinction(&chord.columns);
        let absorbed = lanes::absorbed(whole_depth);
        let mut choice = choice;
        let mut collides = Spectrum::ONE;
        if end == End::Ground {
            let hit = 1.0 - absorbed[hero] as f64;
            if choice < hit {
                let passed = self.passed(chord, chord.end(), random);
                path.step(passed, Spectrum::ONE - absorbed);
                path.place += path.direction * (chord.end() - line.start);
                return Event::Ground;
            }
            choice = (choice - hit) / (1.0 - hit);
            collides = absorbed;
        }
        if absorbed[hero] <= 0.0 {
            return Event::None;
        }
        let stretches = self.lit_stretches(path, chord, line);
        let (t, share) = stretches.draw(self, chord, hero, choice, &absorbed);
        let columns = chord.columns_to(layers, t);
        let layer = layers.layer(chord.layer_at(t));
        let stand_in = layer.densities_of(layer.coordinate(line.tangent + t * t));
        let drawn = self.lanes.extinction(&stand_in)
            * self.lanes.transmittance(&columns)
            * share
            * collides;
        path.step(self.passed(chord, t, random), drawn);
        path.place += path.direction * (t - line.start);
        Event::Air
    }

    /// Transmittance from the start of a chord to `t`, without bias: that of the stand-in, and now and then a look at
    /// what it leaves out (residual ratio tracking: Novak, Selle & Jarosz, ACM Trans. Graph. 33(6), 179, 2014).
    #[inline(always)]
    fn passed(&self, chord: &Chord, t: f64, random: &mut Random) -> Spectrum<N> {
        let mut passed = self.lanes.transmittance(&chord.columns_to(self.layers, t));
        chord.residual(self.layers, t, random, |square, layer| {
            passed *= self.residual_weight(square, layer);
        });
        passed
    }

    /// `1 - (extinction - stand-in) / residual` at a place.
    fn residual_weight(&self, square: f64, layer: usize) -> Spectrum<N> {
        let truth = self.layers.densities_at(square.sqrt());
        let layer = self.layers.layer(layer);
        let stand_in = layer.densities_of(layer.coordinate(square));
        let mut difference = [0.0; MAX_CONSTITUENTS];
        for (d, (truth, stand_in)) in difference.iter_mut().zip(truth.iter().zip(stand_in)) {
            *d = truth - stand_in;
        }
        Spectrum::ONE - self.lanes.extinction(&difference) * (1.0 / layer.residual_per_m) as f32
    }

    /// Adds the sun's light at a vertex in the air and draws a new direction; whether the path goes on.
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
            let ways = [path.direction, sun];
            polarisation.sunlight(self.lanes, ways, [&scattering, &phases], light);
        }
        let whole = lanes::sum(&scattering);
        if whole[hero] <= 0.0 {
            return false;
        }
        let axis = match random.unit() < TOWARDS_SUN {
            true => self.sun,
            false => path.direction,
        };
        let cosine = self.lanes.sample(&scattering, hero, random);
        let next = about(axis, cosine, random.unit());
        let phases = self.phases_between(path.direction, next);
        let onward = lanes::phased(&scattering, &phases);
        let sunward = lanes::phased(&scattering, &self.phases_between(self.sun, next));
        let (onward_share, sunward_share) = ((1.0 - TOWARDS_SUN) as f32, TOWARDS_SUN as f32);
        let norm = whole.max_scalar(f32::MIN_POSITIVE);
        let drawn = (onward * onward_share + sunward * sunward_share) / norm;
        path.step(onward, drawn);
        let ways = [path.direction, next];
        polarisation.scattered(self.lanes, ways, [&scattering, &phases]);
        path.direction = next;
        path.order += 1;
        // A path towards the sun will find more light than others.
        let isotropic = (0.25 / PI) as f32;
        path.pdf = path.throughput.max_element() * (sunward / norm).max_element().max(isotropic)
            / isotropic;
        true
    }

    #[inline(always)]
    fn phases_between(&self, a: DVec3, b: DVec3) -> PerScatterer<N> {
        self.lanes.phases(a.dot(b).clamp(-1.0, 1.0))
    }

    /// Adds the sun's light at a vertex on the ground and draws a new direction, as Lambert's law has it.
    #[inline(always)]
    fn reflect<P: Polarisation<N>>(
        &self,
        path: &mut Path<N>,
        random: &mut Random,
        found: &mut ByOrder<N>,
        polarisation: &mut P,
    ) {
        let up = path.place.normalize();
        // Back on the ground exactly, and above it in the arithmetic of the next way.
        path.place = up * self.layers.edge(0).sqrt();
        path.throughput *= self.lanes.ground_albedo;
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
        path.direction = about(up, random.unit().sqrt(), random.unit());
        path.order += 1;
        path.pdf = path.throughput.max_element();
    }

    /// Sunlight that arrives from the direction `sun`, per unit irradiance; `None` in the planet's shadow.
    #[inline(always)]
    fn sunlight(&self, place: DVec3, sun: DVec3, random: &mut Random) -> Option<Spectrum<N>> {
        let line = HalfLine::new(place, sun);
        if line.meets_ground(self.layers) {
            return None;
        }
        let (columns, residual) = line.to_space(self.layers);
        let mut light = self.lanes.transmittance(&columns);
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

    /// The stretches of a chord that the sun shines on, where it is partly in shadow.
    #[inline(always)]
    fn lit_stretches(&self, path: &Path<N>, chord: &Chord, line: HalfLine) -> Lit<N> {
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
                lit.stretches[lit.count] = Stretch {
                    from: cuts[k],
                    to: cuts[k + 1],
                    absorbed: self.lanes.transmittance(&before)
                        * lanes::absorbed(self.lanes.extinction(&between)),
                };
                lit.count += 1;
            }
        }
        lit
    }
}

/// The unit vector at the angle of `cosine` from `axis`, turned about it by `turn` of a full turn.
#[inline(always)]
fn about(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (across, up) = axis.any_orthonormal_pair();
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * turn).sin_cos();
    (across * (sine * cos) + up * (sine * sin) + axis * cosine).normalize()
}
