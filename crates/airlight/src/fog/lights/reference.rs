//! Integrals along a line by brute force, for tests.

use super::geometry::LightRayGeometry;
use super::{Light, ParticipatingMedium, ViewRay};
use crate::atmosphere::{DensityProfile, RaySegment};
use crate::math::quadrature::GaussRule;
use std::f64::consts::PI;

/// `e = t + r - r_0` without cancellation, where the distance from the point closest to the lamp is `u`.
fn excess(geometry: &LightRayGeometry, t: f64, u: f64) -> f64 {
    let h = geometry.nearest_m;
    let ahead = |u: f64| match u < 0.0 {
        true => h * h / (h.hypot(u) - u),
        false => h.hypot(u) + u,
    };
    t * (ahead(geometry.start_m) + ahead(u)) / (geometry.distance_m(0.0) + h.hypot(u))
}

/// The integral along a passage of `f(t, u)`: Gauss's rule of 24 points in stretches that shrink by a quarter towards the
/// start, the end, the point closest to the lamp and the places `more`. It is counted from the point closest to the lamp
/// where that is on the way, from the start elsewhere: what is small is not lost beside what is large.
pub fn along(geometry: &LightRayGeometry, more: &[f64], f: impl Fn(f64, f64) -> f64) -> f64 {
    let length = geometry.length_m.min(1e16);
    let passed = -geometry.start_m;
    let origin = match (0.0..=length).contains(&passed) {
        true => passed,
        false => 0.0,
    };
    let (first, last) = (-origin, length - origin);
    let mut breaks = Vec::new();
    let more = more.iter().map(|t| t - origin);
    for centre in [first, last, passed - origin].into_iter().chain(more) {
        breaks.push(centre);
        for k in 0..200 {
            let step = length * 0.75f64.powi(k);
            breaks.extend([centre - step, centre + step]);
        }
    }
    breaks.sort_by(f64::total_cmp);
    // Stretches shorter than rounding are none.
    breaks.dedup_by(|b, a| (*b - *a).abs() <= 1e-14 * b.abs());
    GaussRule::new(24).integrate_between(first, last, &breaks, |s| {
        f(s + origin, s + (origin - passed))
    })
}

/// What [`super::airlight_isotropic`] is, less the dimming over `r_0`.
pub fn isotropic_beyond(geometry: &LightRayGeometry, extinction: f64) -> f64 {
    // An endless line is cut after 1e16 m; what is beyond counts only in clear air.
    let rest = match geometry.length_m.is_infinite() && extinction == 0.0 {
        true => 1e-16 / (4.0 * PI),
        false => 0.0,
    };
    rest + along(geometry, &[], |t, u| {
        let r2 = u * u + geometry.nearest_m * geometry.nearest_m;
        (-extinction * excess(geometry, t, u)).exp() / (4.0 * PI * r2)
    })
}

/// Every passage that tests try.
pub fn passages(nearest: &[f64]) -> impl Iterator<Item = LightRayGeometry> + '_ {
    const START: [f64; 13] = [
        -1e7, -1e4, -37.0, -1.0, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 1.0, 37.0, 1e4, 1e7,
    ];
    const LENGTH: [f64; 8] = [1e-6, 1e-3, 0.5, 20.0, 74.0, 2e4, 1e7, f64::INFINITY];
    nearest.iter().flat_map(|&nearest_m| {
        START.iter().flat_map(move |&start_m| {
            LENGTH.iter().map(move |&length_m| LightRayGeometry {
                nearest_m,
                start_m,
                length_m,
            })
        })
    })
}

/// A lamp's light in the first lane of a line of sight: the defining integral, less the clamp where the line passes closer
/// than the lamp's radius.
pub fn path_radiance<const N: usize>(
    light: &Light<N>,
    medium: &ParticipatingMedium<N>,
    view_ray: &ViewRay,
) -> f64 {
    let ViewRay { eye, direction, .. } = *view_ray;
    let length = match light {
        Light::Sphere(ball) => ball
            .hit(eye, direction)
            .map_or(view_ray.length_m, |hit| hit.min(view_ray.length_m)),
        _ => view_ray.length_m,
    };
    let true_nearest = (light.position() - eye).cross(direction).length();
    let nearest = match light {
        Light::Sphere(_) => 0.0,
        _ => light.radius_m(),
    };
    let geometry = LightRayGeometry::new(eye, direction, length, light.position(), nearest);
    let own_medium = medium.medium;
    let extinction = f64::from(own_medium.extinction_per_m[0]);
    let line = RaySegment::new(eye.y, direction.y, length, medium.ground_radius_m);
    let edges = edges(light, medium, view_ray, &line);
    let integral = along(&geometry, &edges, |t, u| {
        let r = (geometry.nearest_m * geometry.nearest_m + u * u).sqrt();
        let point = eye + t * direction;
        let towards = (light.position() - point) / r;
        let (leg, part) = match light {
            Light::Point(_) => (r, 1.0),
            Light::Spot(spot) => {
                let closest = true_nearest.max(1e-300) / geometry.nearest_m;
                let off = (point - light.position()) / r;
                assert!(closest > 0.99, "spots are tried off the line");
                (r, spot.falloff(off))
            }
            Light::Sphere(ball) => {
                let x = (ball.radius_m / r).powi(2).min(1.0);
                (r - ball.radius_m, 2.0 / (1.0 + (1.0 - x).sqrt()))
            }
        };
        let height = line.height_at(t);
        let curvature = 0.5 / medium.ground_radius_m;
        let offset = t * (towards.x * direction.x + towards.z * direction.z);
        let to_light = RaySegment {
            height_m: height,
            sin_elevation: towards.y + 2.0 * curvature * offset,
            curvature_per_m: curvature * (1.0 - towards.y * towards.y).max(0.0),
            length_m: leg,
        };
        let way = |profile: &DensityProfile| {
            profile.column_along_m(&RaySegment {
                length_m: t,
                ..line
            }) + match profile.is_uniform() {
                true => leg,
                false => profile.column_along_m(&to_light),
            }
        };
        let others = medium.others.iter();
        let others = others.map(|o| f64::from(o.medium.extinction_per_m[0]) * way(&o.profile));
        let depth = extinction * way(medium.profile) + others.sum::<f64>();
        let phase = own_medium.phase.evaluate(-u / r, medium.wavelengths_nm[0]);
        medium.profile.at(height) * part * phase * (-depth).exp() / (r * r)
    });
    let scattering = f64::from(own_medium.scattering_per_m()[0]);
    scattering * f64::from(light.intensity()[0]) * integral
}

/// Where density or the lamp's intensity has a kink, or fog is densest.
fn edges<const N: usize>(
    light: &Light<N>,
    medium: &ParticipatingMedium<N>,
    view_ray: &ViewRay,
    line: &RaySegment,
) -> Vec<f64> {
    let mut edges = Vec::new();
    let others = medium.others.iter().map(|other| &other.profile);
    for profile in others.chain([medium.profile]) {
        let structure = profile.structure();
        edges.extend(structure.kinks_m.iter().map(|&kink| line.below(kink)));
        if !structure.decays.is_empty() {
            edges.push((-0.5 * line.sin_elevation / line.curvature_per_m, 0.0));
        }
    }
    if let Light::Spot(spot) = light {
        let geometry = LightRayGeometry::new(
            view_ray.eye,
            view_ray.direction,
            view_ray.length_m,
            spot.position,
            spot.radius_m,
        );
        let beam = super::spot::Beam::new(spot, &geometry, view_ray.eye, view_ray.direction);
        edges.extend(beam.lit(&geometry));
    }
    edges
        .into_iter()
        .flat_map(|(a, b)| [a, b])
        .filter(|t| t.is_finite() && *t > 0.0 && *t < view_ray.length_m)
        .collect()
}
