//! Any lamp, any phase function, any profile: quadrature along the line of sight.

use super::geometry::LightRayGeometry;
use super::medium::ParticipatingMedium;
use super::nodes::Nodes;
use super::panels::Cuts;
use super::sphere::closeness;
use super::spot::Beam;
use super::{Light, ViewRay};
use crate::atmosphere::RaySegment;
use crate::atmosphere::{DensityProfile, HeightStructure};
use crate::fog::lanes::Lanes;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::PI;

/// The optical depth within a node's scale that Gauss's rule takes in its stride.
const STRIDE: f64 = 12.0;

/// The optical depth of a panel up to which its nodes may crowd at the lamp's end.
const OUTWARDS: f64 = 4.0;

/// What of the fog is the same for all lamps and lines.
#[derive(Clone, Debug)]
pub(super) struct Haze<'a, const N: usize> {
    pub(super) medium: &'a ParticipatingMedium<'a, N>,
    /// How the fog changes with height, and each other layer.
    structure: HeightStructure,
    others: Vec<HeightStructure>,
    pub(super) scattering_per_m: Spectrum<N>,
    /// The largest extinction of any lane, 1/m; of all layers where the air is even.
    pub(super) thickest_per_m: f64,
    /// The smallest above 0.
    pub(super) thinnest_per_m: f64,
    /// Whether all layers are the same everywhere.
    even: bool,
    /// `tan(Theta / 2)` over which the phase function falls off from its forward peak: `(1 - g) / (1 + g)` of the
    /// Henyey-Greenstein function with the same peak.
    peak: f64,
    /// Whether it is the same in all directions.
    pub(super) isotropic: bool,
}

impl<'a, const N: usize> Haze<'a, N> {
    /// Nothing where no lane scatters.
    pub(super) fn new(medium: &'a ParticipatingMedium<'a, N>) -> Option<Self> {
        let own_medium = medium.medium;
        let own = own_medium.extinction_per_m;
        let even = [medium.profile]
            .into_iter()
            .chain(medium.others.iter().map(|other| &other.profile))
            .all(|profile| profile.is_uniform());
        let others = match even {
            true => medium.others,
            false => &[],
        };
        let all = others
            .iter()
            .fold(own, |all, o| all + o.medium.extinction_per_m);
        let isotropic = own_medium.phase == crate::optics::PhaseFunction::Isotropic;
        (N > 0 && own.max_element() > 0.0).then(|| Self {
            medium,
            structure: medium.profile.structure(),
            others: medium
                .others
                .iter()
                .map(|o| o.profile.structure())
                .collect(),
            scattering_per_m: own_medium.scattering_per_m(),
            thickest_per_m: f64::from(all.max_element()),
            thinnest_per_m: thinnest(all),
            even,
            peak: match isotropic {
                true => 1.0,
                false => {
                    width(4.0 * PI * own_medium.phase.evaluate(1.0, medium.wavelengths_nm[N / 2]))
                }
            },
            isotropic,
        })
    }
}

/// The smallest extinction above 0 of any lane.
fn thinnest<const N: usize>(extinction_per_m: Spectrum<N>) -> f64 {
    let smaller = |least: f32, v: f32| if v > 0.0 && v < least { v } else { least };
    f64::from(extinction_per_m.0.into_iter().fold(f32::INFINITY, smaller))
}

/// `(1 - g) / (1 + g)` of the Henyey-Greenstein function that is `peak / (4 pi)` forward: `peak = (1 + g) / (1 - g)^2`.
fn width(peak: f64) -> f64 {
    let d = ((1.0 + 8.0 * peak).sqrt() - 1.0) / (2.0 * peak);
    (d / (2.0 - d)).min(1.0)
}

/// How much of a lamp's intensity reaches a point, besides `1 / r^2`.
#[derive(Clone, Copy, Debug)]
enum Emission {
    Even,
    Beam(Beam),
    /// The true distance of the line from the centre, and the radius.
    Ball {
        nearest_m: f64,
        radius_m: f64,
    },
}

/// A lamp and a line of sight past it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray<'a, const N: usize> {
    haze: &'a Haze<'a, N>,
    pub(super) geometry: LightRayGeometry,
    pub(super) line: RaySegment,
    direction: DVec3,
    to_light: DVec3,
    emission: Emission,
    pub(super) intensity: Spectrum<N>,
}

impl<'a, const N: usize> Ray<'a, N> {
    pub(super) fn new(light: &Light<N>, haze: &'a Haze<'a, N>, view_ray: &ViewRay) -> Self {
        let ViewRay {
            eye,
            direction,
            mut length_m,
        } = *view_ray;
        if let Light::Sphere(ball) = light
            && let Some(hit) = ball.hit(eye, direction)
        {
            length_m = length_m.min(hit);
        }
        let to_light = light.position() - eye;
        let geometry =
            LightRayGeometry::new(eye, direction, length_m, light.position(), light.radius_m());
        Self {
            haze,
            geometry,
            line: RaySegment::new(eye.y, direction.y, length_m, haze.medium.ground_radius_m),
            direction,
            to_light,
            emission: match light {
                Light::Point(_) => Emission::Even,
                Light::Spot(spot) => Emission::Beam(Beam::new(spot, &geometry, eye, direction)),
                Light::Sphere(ball) => Emission::Ball {
                    nearest_m: to_light.cross(direction).length(),
                    radius_m: ball.radius_m,
                },
            },
            intensity: light.intensity(),
        }
    }

    /// Path radiance: the sum over all panels.
    pub(super) fn path_radiance(&self, nodes: &Nodes) -> Spectrum<N> {
        let haze = self.haze;
        let density = haze.medium.profile.at(self.line.height_m);
        let mut cuts = Cuts::of(&haze.structure, density, &self.line, haze.thinnest_per_m);
        if let Emission::Beam(beam) = &self.emission {
            let [outer, inner] = beam.lit(&self.geometry);
            cuts.keep(outer);
            cuts.add(inner);
        }
        if !haze.even {
            let closest = -self.geometry.start_m;
            cuts.add((closest, closest));
        }
        for other in &haze.others {
            cuts.dimmed_by(other, &self.line);
        }
        let mut sum = Spectrum::ZERO;
        cuts.visit(|from, to| self.panel(from, to, nodes, &mut sum));
        sum * haze.scattering_per_m * self.intensity
    }

    /// Adds what one panel scatters, for an intensity and a scattering coefficient of 1.
    ///
    /// Its nodes crowd at its start, or, where it lies before the lamp in fog that is not uniform and not thick, at its end:
    /// outwards from the lamp they reach ever farther, and density changes with distance, not with the angle.
    fn panel(&self, from: f64, to: f64, nodes: &Nodes, sum: &mut Spectrum<N>) {
        let haze = self.haze;
        let medium = haze.medium;
        let part = self.geometry.part(from, to);
        let (end, rate) = self.spent(&part, from, nodes.spent());
        let outwards = !haze.even && part.start_m + part.length_m <= 0.0 && rate * end < OUTWARDS;
        let (anchor, origin, sign, end) = match outwards {
            false => (part, from, 1.0, end),
            true => {
                let reach = part.place_m(end).min(part.length_m);
                let back = part.part(0.0, reach).reversed();
                (back, from + reach, -1.0, back.excess_m())
            }
        };
        let h = anchor.nearest_m;
        let (r0, ahead) = (anchor.distance_m(0.0), anchor.ahead_at_start());
        // The smaller of the scales over which geometry, phase function and extinction change.
        let peak = if outwards { 1.0 } else { haze.peak };
        let rate = if outwards { 0.0 } else { rate };
        let wide = (peak * h).hypot(ahead);
        let scale = wide / (1.0 + (rate * wide / STRIDE).powi(2)).sqrt();
        nodes.visit(scale, end, |excess, step| {
            let s = excess + ahead;
            let (squares, twice) = (h * h + s * s, 2.0 * s);
            let t = origin + sign * 0.5 * excess * (excess + 2.0 * r0) / s;
            let (u, mut r) = (sign * (s - h) * (s + h) / twice, squares / twice);
            let mut weight = 2.0 * step / squares;
            let mut leg = r;
            match &self.emission {
                Emission::Even => {}
                Emission::Beam(beam) => weight *= beam.falloff(u, r),
                Emission::Ball {
                    nearest_m,
                    radius_m,
                } => {
                    let square = (nearest_m * nearest_m + u * u).max(radius_m * radius_m);
                    weight *= r * r / square;
                    r = square.sqrt();
                    leg = r - radius_m;
                    weight *= closeness(*radius_m, r);
                }
            }
            weight *= medium.profile.at(self.line.height_at(t));
            let mut depth =
                medium.medium.extinction_per_m * self.way_m(medium.profile, t, r, leg) as f32;
            for other in medium.others {
                let way_m = self.way_m(&other.profile, t, r, leg);
                depth = depth.scale_acc(other.medium.extinction_per_m, way_m as f32);
            }
            let cos = (-u / r).clamp(-1.0, 1.0);
            let phase = medium.medium.phase_lanes(cos, medium.wavelengths_nm);
            *sum = sum.scale_acc(phase * depth.exp_neg(), weight as f32);
        });
    }

    /// The fog of a profile on the way from the eye to the point `t` on and from there to the lamp, `r` away (its surface
    /// `leg`), m of density 1.
    #[inline]
    fn way_m(&self, profile: &DensityProfile, t: f64, r: f64, leg: f64) -> f64 {
        if profile.is_uniform() {
            return t + leg;
        }
        let view_ray = RaySegment {
            length_m: t,
            ..self.line
        };
        let towards = (self.to_light - t * self.direction) / r;
        let level = t * (towards.x * self.direction.x + towards.z * self.direction.z);
        let curvature = 0.5 / self.haze.medium.ground_radius_m;
        let to_light = RaySegment {
            height_m: self.line.height_at(t),
            sin_elevation: towards.y + 2.0 * curvature * level,
            curvature_per_m: curvature * (1.0 - towards.y * towards.y).max(0.0),
            length_m: leg,
        };
        profile.column_along_m(&view_ray) + profile.column_along_m(&to_light)
    }

    /// The excess at which a panel ends or the light of every lane is spent, and the largest optical depth that a metre of
    /// excess adds on average up to there.
    fn spent(&self, part: &LightRayGeometry, from: f64, depth: f64) -> (f64, f64) {
        let haze = self.haze;
        let end = part.excess_m();
        if haze.even {
            return (end.min(depth / haze.thinnest_per_m), haze.thickest_per_m);
        }
        let way = |excess: f64| {
            let t = part.place_m(excess);
            let r = part.distance_m(t);
            let own = haze.thinnest_per_m * self.way_m(haze.medium.profile, from + t, r, r);
            haze.medium.others.iter().fold(own, |sum, other| {
                let way_m = self.way_m(&other.profile, from + t, r, r);
                sum + thinnest(other.medium.extinction_per_m).min(1e30) * way_m
            })
        };
        let start = way(0.0);
        let passed = |excess: f64| way(excess) - start;
        let density = haze.medium.profile.at(self.line.height_at(from));
        let mut reach = end.min(2.0 * depth / (haze.thinnest_per_m * density));
        if reach.is_infinite() {
            return (end, 0.0);
        }
        let mut spent = passed(reach);
        for _ in 0..60 {
            if spent < depth && reach < end {
                reach = end.min(2.0 * reach);
            } else if spent > 2.0 * depth {
                reach *= 0.5;
            } else {
                break;
            }
            spent = passed(reach);
        }
        // Where only doubling and halving again would do, the longer one stands.
        let rate = (spent / reach).max(0.0) * (haze.thickest_per_m / haze.thinnest_per_m);
        (reach, if rate.is_finite() { rate } else { 0.0 })
    }
}

#[cfg(test)]
mod tests;
