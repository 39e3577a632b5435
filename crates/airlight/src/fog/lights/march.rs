//! Quadrature along view rays, for all lights, phase functions and density profiles.

use super::geometry::{LightRayGeometry, ViewRay};
use super::light::{Light, SpotCone, closeness};
use crate::atmosphere::{Decay, DensityProfile, HeightStructure, RaySegment};
use crate::fog::closed_forms::Lanes;
use crate::fog::closed_forms::OPAQUE;
use crate::fog::layer::LayerLanes;
use crate::math::quadrature::GaussRule;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::PI;

/// Optical depth within the scale of the nodes that is integrated accurately.
const STRIDE: f64 = 12.0;

/// Largest optical depth of a panel whose nodes are dense at the end near the light.
const OUTWARDS: f64 = 4.0;

/// A scattering layer of fog among other layers, prepared for all lights and rays.
#[derive(Clone, Debug)]
pub(super) struct ScatteringLayer<const N: usize> {
    pub(super) layer: LayerLanes<N>,
    structure: HeightStructure,
    pub(super) others: Vec<OtherLayer<N>>,
    /// Radius of the ground, m. The ground is at height 0 below the eye (or the illuminated point) and `d^2 / (2 R)` lower at the
    /// distance `d`.
    pub(super) ground_radius_m: f64,
    /// Largest extinction coefficient of any lane, 1/m; of the sum of all layers if all are uniform.
    max_extinction_per_m: f64,
    /// Smallest extinction coefficient above 0.
    min_extinction_per_m: f64,
    /// Whether all layers are uniform.
    uniform: bool,
    /// Width of the forward peak of the phase function in `tan(Theta / 2)`: `(1 - g) / (1 + g)` of the Henyey-Greenstein function
    /// with the same forward value.
    peak: f64,
    /// Whether the phase function is isotropic.
    isotropic: bool,
}

/// A layer that attenuates light scattered by another layer.
#[derive(Clone, Debug)]
pub(super) struct OtherLayer<const N: usize> {
    pub(super) density: DensityProfile,
    structure: HeightStructure,
    pub(super) extinction_per_m: Spectrum<N>,
    /// Smallest extinction coefficient above 0, 1/m.
    min_extinction_per_m: f64,
}

impl<const N: usize> ScatteringLayer<N> {
    /// A layer among others; `None` if the extinction is 0 in all lanes.
    pub(super) fn new(
        layer: LayerLanes<N>,
        others: &[LayerLanes<N>],
        ground_radius_m: f64,
    ) -> Option<Self> {
        let own = layer.extinction_per_m;
        let uniform =
            layer.density.is_uniform() && others.iter().all(|other| other.density.is_uniform());
        let whole = match uniform {
            true => others.iter().fold(own, |sum, o| sum + o.extinction_per_m),
            false => own,
        };
        let isotropic = layer.phase == PhaseFunction::Isotropic;
        let middle_nm = *layer.wavelengths_nm.get(N / 2)?;
        (own.max_element() > 0.0).then(|| Self {
            structure: layer.density.structure(),
            others: others
                .iter()
                .map(|other| OtherLayer {
                    density: other.density.clone(),
                    structure: other.density.structure(),
                    extinction_per_m: other.extinction_per_m,
                    min_extinction_per_m: smallest_above_0(other.extinction_per_m).min(1e30),
                })
                .collect(),
            ground_radius_m,
            max_extinction_per_m: f64::from(whole.max_element()),
            min_extinction_per_m: smallest_above_0(whole),
            uniform,
            peak: match isotropic {
                true => 1.0,
                false => width_of_peak(4.0 * PI * layer.phase.evaluate(1.0, middle_nm)),
            },
            isotropic,
            layer,
        })
    }

    /// Whether [`super::closed_form`] is valid for point lights: a single layer of uniform, isotropically scattering fog.
    pub(super) fn has_closed_form(&self) -> bool {
        self.isotropic && self.layer.density.is_uniform() && self.others.is_empty()
    }
}

/// Smallest extinction coefficient above 0 of any lane.
fn smallest_above_0<const N: usize>(extinction_per_m: Spectrum<N>) -> f64 {
    let smaller = |least: f32, v: f32| if v > 0.0 && v < least { v } else { least };
    f64::from(extinction_per_m.0.into_iter().fold(f32::INFINITY, smaller))
}

/// `(1 - g) / (1 + g)` of the Henyey-Greenstein function with the forward value `peak / (4 pi)`: `peak = (1 + g) / (1 - g)^2`.
fn width_of_peak(peak: f64) -> f64 {
    let d = ((1.0 + 8.0 * peak).sqrt() - 1.0) / (2.0 * peak);
    (d / (2.0 - d)).min(1.0)
}

/// Directional dependence of a light's intensity.
#[derive(Clone, Copy, Debug)]
enum Emission {
    Point,
    Spot(SpotCone),
    Sphere {
        /// Distance of the ray from the centre, m, not clamped.
        nearest_m: f64,
        radius_m: f64,
    },
}

/// A view ray past a light in a layer of fog.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitRay<'a, const N: usize> {
    fog: &'a ScatteringLayer<N>,
    pub(super) geometry: LightRayGeometry,
    pub(super) ray: RaySegment,
    direction: DVec3,
    to_light: DVec3,
    emission: Emission,
    pub(super) intensity: Spectrum<N>,
}

impl<'a, const N: usize> LitRay<'a, N> {
    pub(super) fn new(
        light: &Light<Spectrum<N>>,
        fog: &'a ScatteringLayer<N>,
        view_ray: &ViewRay,
    ) -> Self {
        let ViewRay {
            eye,
            direction,
            mut length_m,
        } = *view_ray;
        if let Light::Sphere(sphere) = light
            && let Some(hit) = sphere.hit(eye, direction)
        {
            length_m = length_m.min(hit);
        }
        let to_light = light.position() - eye;
        let geometry =
            LightRayGeometry::new(eye, direction, length_m, light.position(), light.radius_m());
        Self {
            fog,
            geometry,
            ray: RaySegment::new(eye.y, direction.y, length_m, fog.ground_radius_m),
            direction,
            to_light,
            emission: match light {
                Light::Point(_) => Emission::Point,
                Light::Spot(spot) => Emission::Spot(SpotCone::new(spot, &geometry, eye, direction)),
                Light::Sphere(sphere) => Emission::Sphere {
                    nearest_m: to_light.cross(direction).length(),
                    radius_m: sphere.radius_m,
                },
            },
            intensity: light.intensity(),
        }
    }

    /// Path radiance: sum over all panels.
    pub(super) fn path_radiance(&self, nodes: &Nodes) -> Spectrum<N> {
        let fog = self.fog;
        let density = fog.layer.density.at(self.ray.height_m);
        let mut cuts = Cuts::of(&fog.structure, density, &self.ray, fog.min_extinction_per_m);
        if let Emission::Spot(cone) = &self.emission {
            let [outer, inner] = cone.lit(&self.geometry);
            cuts.keep(outer);
            cuts.add(inner);
        }
        if !fog.uniform {
            let closest = -self.geometry.start_m;
            cuts.add((closest, closest));
        }
        for other in &fog.others {
            cuts.add_other(&other.structure, &self.ray);
        }
        let mut sum = Spectrum::ZERO;
        cuts.visit(|from, to| self.panel(from, to, nodes, &mut sum));
        sum * fog.layer.scattering_per_m * self.intensity
    }

    /// Upper bound of the path radiance of all lanes: the ray's maximum density without extinction, and the larger of the forward
    /// and backward values of the phase function; in uniform fog with extinction between eye and light.
    pub(super) fn bound(&self) -> f32 {
        let layer = &self.fog.layer;
        let [forward, backward] = [1.0, -1.0].map(|cos| layer.phase_lanes(cos).max_element());
        let mut light = layer.scattering_per_m * self.intensity;
        let density = match layer.density.is_uniform() {
            true => {
                let nearest_m = self.geometry.nearest_m;
                let between_m = (self.geometry.distance_m(0.0) - 2.0 * nearest_m).max(0.0);
                let depth = layer.extinction_per_m * between_m as f32;
                light *= depth.exp_neg();
                1.0
            }
            false => layer.density.max_above(self.ray.lowest_height_m()),
        };
        // A factor of 2 for the scalar irradiance near a sphere, and 2 for clamping the distance to its radius.
        let glow = 4.0 * density * self.geometry.angle() / self.geometry.nearest_m;
        light.max_element() * forward.max(backward) * glow.min(f64::from(f32::MAX)) as f32
    }

    /// Adds the path radiance of one panel for unit intensity and scattering coefficient.
    ///
    /// Nodes are dense at the start. In panels before the light, in fog that is neither uniform nor thick, they are dense at the end:
    /// their spacing increases away from the light, where density changes with distance, not with angle.
    fn panel(&self, from: f64, to: f64, nodes: &Nodes, sum: &mut Spectrum<N>) {
        let fog = self.fog;
        let part = self.geometry.part(from, to);
        let (end, rate) = self.visible_excess(&part, from, nodes.cutoff_depth());
        let outwards = !fog.uniform && part.start_m + part.length_m <= 0.0 && rate * end < OUTWARDS;
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
        // Smallest scale of geometry, phase function and extinction.
        let peak = if outwards { 1.0 } else { fog.peak };
        let rate = if outwards { 0.0 } else { rate };
        let wide = (peak * h).hypot(ahead);
        let scale = wide / (1.0 + (rate * wide / STRIDE).powi(2)).sqrt();
        nodes.visit(scale, end, |excess, step| {
            let s = excess + ahead;
            let (squares, twice) = (h * h + s * s, 2.0 * s);
            let t = origin + sign * 0.5 * excess * (excess + 2.0 * r0) / s;
            let (u, mut r) = (sign * (s - h) * (s + h) / twice, squares / twice);
            let mut weight = 2.0 * step / squares;
            let mut to_light_m = r;
            match &self.emission {
                Emission::Point => {}
                Emission::Spot(cone) => weight *= cone.falloff(u, r),
                Emission::Sphere {
                    nearest_m,
                    radius_m,
                } => {
                    let square = (nearest_m * nearest_m + u * u).max(radius_m * radius_m);
                    weight *= r * r / square;
                    r = square.sqrt();
                    to_light_m = r - radius_m;
                    weight *= closeness(*radius_m, r);
                }
            }
            weight *= fog.layer.density.at(self.ray.height_at(t));
            let column = self.column_m(&fog.layer.density, t, r, to_light_m);
            let mut depth = fog.layer.extinction_per_m * column as f32;
            for other in &fog.others {
                let column = self.column_m(&other.density, t, r, to_light_m);
                depth = depth.scale_acc(other.extinction_per_m, column as f32);
            }
            let cos = (-u / r).clamp(-1.0, 1.0);
            let phase = fog.layer.phase_lanes(cos);
            *sum = sum.scale_acc(phase * depth.exp_neg(), weight as f32);
        });
    }

    /// Column of a profile from the eye to the point at `t` and on to the light, m. `r` is the distance to the light's centre,
    /// `to_light_m` that to its surface.
    #[inline]
    fn column_m(&self, density: &DensityProfile, t: f64, r: f64, to_light_m: f64) -> f64 {
        if density.is_uniform() {
            return (t + to_light_m).min(OPAQUE);
        }
        let view_ray = RaySegment {
            length_m: t,
            ..self.ray
        };
        let towards = (self.to_light - t * self.direction) / r;
        let level = t * (towards.x * self.direction.x + towards.z * self.direction.z);
        let curvature = 0.5 / self.fog.ground_radius_m;
        let to_light = RaySegment {
            height_m: self.ray.height_at(t),
            sin_elevation: towards.y + 2.0 * curvature * level,
            curvature_per_m: curvature * (1.0 - towards.y * towards.y).max(0.0),
            length_m: to_light_m,
        };
        (density.column_along_m(&view_ray) + density.column_along_m(&to_light)).min(OPAQUE)
    }

    /// Excess at which the panel ends or the optical depth of all lanes has increased by `depth`, and the largest mean increase of
    /// optical depth per metre of excess up to there.
    fn visible_excess(&self, part: &LightRayGeometry, from: f64, depth: f64) -> (f64, f64) {
        let fog = self.fog;
        let end = part.excess_m();
        if fog.uniform {
            return (
                end.min(depth / fog.min_extinction_per_m),
                fog.max_extinction_per_m,
            );
        }
        let depth_at = |excess: f64| {
            let t = part.place_m(excess);
            let r = part.distance_m(t);
            let own = fog.min_extinction_per_m * self.column_m(&fog.layer.density, from + t, r, r);
            fog.others.iter().fold(own, |sum, other| {
                sum + other.min_extinction_per_m * self.column_m(&other.density, from + t, r, r)
            })
        };
        let start = depth_at(0.0);
        let increase = |excess: f64| depth_at(excess) - start;
        let density = fog.layer.density.at(self.ray.height_at(from));
        let mut reach = end.min(2.0 * depth / (fog.min_extinction_per_m * density));
        if reach.is_infinite() {
            return (end, 0.0);
        }
        let mut reached = increase(reach);
        for _ in 0..60 {
            if reached < depth && reach < end {
                reach = end.min(2.0 * reach);
            } else if reached > 2.0 * depth {
                reach *= 0.5;
            } else {
                break;
            }
            reached = increase(reach);
        }
        // If doubling and halving would alternate, keep the longer one.
        let rate =
            (reached / reach).max(0.0) * (fog.max_extinction_per_m / fog.min_extinction_per_m);
        (reach, if rate.is_finite() { rate } else { 0.0 })
    }
}

/// Quadrature rule for integrals along rays past lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    rule: GaussRule,
}

impl Nodes {
    /// A Gauss-Legendre rule with `count` nodes, at least 1.
    pub fn new(count: usize) -> Self {
        Self {
            rule: GaussRule::new(count.max(1)),
        }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.rule.len()
    }

    /// Nodes on `[0, 1]` and weights.
    #[inline]
    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.rule.iter()
    }

    /// Optical depth at which integrals are truncated: `e^-depth` is less than the error of the rule.
    #[inline]
    pub(super) fn cutoff_depth(&self) -> f64 {
        10.0 + self.count() as f64 / 3.0
    }

    /// Nodes for `int_0^end f(s) ds` of a function whose scale of variation is `scale` at 0 and increases with `s`: Gauss nodes in
    /// `q`, from 1 at `s = 0` to 0 at infinity, with `s = scale (1 - p) / p` and `p = q^3`. Calls `visit(s, ds)`.
    #[inline(always)]
    pub(super) fn visit(&self, scale: f64, end: f64, mut visit: impl FnMut(f64, f64)) {
        // 0 for infinite rays.
        let inverse = scale / end;
        let covered = 1.0 / (1.0 + inverse);
        let last = (inverse * covered).cbrt();
        let span = covered / (1.0 + last + last * last);
        for (place, weight) in self.rule.iter() {
            let z = span * place;
            let q = 1.0 - z;
            let p = q * q * q;
            let s = scale * z * (3.0 - 3.0 * z + z * z) / p;
            visit(s, 3.0 * weight * span * scale / (q * p));
        }
    }
}

/// Heights above the densest point of a ray, in scale heights, at which the ray is split; fog above the last is negligible.
const HEIGHTS: [f64; 3] = [3.0, 10.0, 40.0];

/// Optical depth from the eye beyond which light is negligible.
const MAX_DEPTH: f64 = 90.0;

/// Largest number of splits: at most 12 for a layer with the cone of a spot light, and 6 for each other layer. Further splits are
/// ignored, which costs some accuracy.
const MAX_CUTS: usize = 40;

/// Panels of a ray: fog and light are smooth in each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuts {
    first: f64,
    last: f64,
    within: [f64; MAX_CUTS],
    count: usize,
}

impl Cuts {
    /// Panels of a ray in a layer; `density` is that at the start, `min_extinction_per_m` the smallest extinction coefficient above 0
    /// of any lane.
    ///
    /// The ray is split at kinks of the density and at a few heights above its densest point, so that the part in dense fog has its
    /// own nodes, however far away the light is. Parts above the top of the layer, more than 40 scale heights above the densest
    /// point, or beyond an optical depth of 90 are omitted.
    pub(super) fn of(
        fog: &HeightStructure,
        density: f64,
        ray: &RaySegment,
        min_extinction_per_m: f64,
    ) -> Self {
        let mut cuts = Self {
            first: 0.0,
            last: ray.length_m,
            within: [0.0; MAX_CUTS],
            count: 0,
        };
        for &kink in &fog.kinks_m {
            cuts.add(ray.below(kink));
        }
        if fog.top_m.is_finite() {
            cuts.keep(ray.below(fog.top_m));
        }
        for decay in &fog.decays {
            let mut floor = ray.lowest_height_m().max(decay.from_m);
            if decay.from_m == f64::NEG_INFINITY && ray.sin_elevation < 0.0 {
                // Density at which even a straight descent has an optical depth of MAX_DEPTH.
                let density = density
                    + MAX_DEPTH * -ray.sin_elevation
                        / (min_extinction_per_m * decay.scale_height_m);
                let dark = decay.reference_height_m - decay.scale_height_m * density.ln();
                if dark > floor {
                    cuts.keep((0.0, ray.below(dark).0));
                    floor = dark;
                }
            }
            cuts.cut_decay(ray, floor, decay);
        }
        cuts
    }

    /// Splits at kinks of another layer and at heights where it has decayed.
    pub(super) fn add_other(&mut self, layer: &HeightStructure, ray: &RaySegment) {
        for kink in layer.other_kinks_m() {
            self.add(ray.below(kink));
        }
        for decay in &layer.decays {
            let base_m = ray.lowest_height_m().max(decay.from_m);
            self.add(ray.below(base_m));
            for height in &HEIGHTS[..2] {
                self.add(ray.below(base_m + height * decay.scale_height_m));
            }
        }
    }

    /// Splits at the heights above the densest point.
    fn cut_decay(&mut self, ray: &RaySegment, densest_height_m: f64, decay: &Decay) {
        let below = |height: f64| ray.below(densest_height_m + height * decay.scale_height_m);
        for height in HEIGHTS {
            self.add(below(height));
        }
        if ray.sin_elevation != 0.0 || ray.curvature_per_m != 0.0 {
            self.keep(below(HEIGHTS[HEIGHTS.len() - 1]));
        }
    }

    /// Restricts the panels to the interval between two distances.
    pub(super) fn keep(&mut self, (first, last): (f64, f64)) {
        self.first = self.first.max(first);
        self.last = self.last.min(last);
    }

    /// Splits at two distances.
    pub(super) fn add(&mut self, (first, last): (f64, f64)) {
        for at in [first, last] {
            if at.is_finite() && self.count < MAX_CUTS {
                self.within[self.count] = at;
                self.count += 1;
            }
        }
    }

    /// Calls `visit(from, to)` for every panel, from near to far.
    #[inline]
    pub(super) fn visit(&mut self, mut visit: impl FnMut(f64, f64)) {
        let within = &mut self.within[..self.count];
        within.sort_unstable_by(f64::total_cmp);
        let mut from = self.first;
        for &at in within.iter() {
            if at > from && at < self.last {
                visit(from, at);
                from = at;
            }
        }
        if self.last > from {
            visit(from, self.last);
        }
    }
}

#[cfg(test)]
mod tests;
