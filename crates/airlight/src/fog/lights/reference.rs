//! Reference integrals along rays, for tests.

use super::geometry::{LightRayGeometry, ViewRay};
use super::light::{Light, SpotCone};
use super::march::ScatteringLayer;
use crate::atmosphere::{DensityProfile, RaySegment};
use crate::math::quadrature::GaussRule;
use crate::spectrum::Spectrum;
use std::f64::consts::PI;

/// `e = t + r - r_0` without cancellation, at `u` from the point closest to the light.
fn excess(geometry: &LightRayGeometry, t: f64, u: f64) -> f64 {
    let h = geometry.nearest_m;
    let ahead = |u: f64| match u < 0.0 {
        true => h * h / (h.hypot(u) - u),
        false => h.hypot(u) + u,
    };
    t * (ahead(geometry.start_m) + ahead(u)) / (geometry.distance_m(0.0) + h.hypot(u))
}

/// Integral of `f(t, u)` along a ray: Gauss-Legendre quadrature with 24 points in intervals that shrink by a quarter towards the
/// start, the end, the point closest to the light and the distances `more`. The origin of the coordinate is the point closest
/// to the light if it is on the ray, otherwise the start, to preserve precision.
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
    // Omit intervals shorter than rounding.
    breaks.dedup_by(|b, a| (*b - *a).abs() <= 1e-14 * b.abs());
    GaussRule::new(24).integrate_between(first, last, &breaks, |s| {
        f(s + origin, s + (origin - passed))
    })
}

/// [`super::airlight_isotropic`] without the attenuation over `r_0`.
pub fn isotropic_beyond(geometry: &LightRayGeometry, extinction: f64) -> f64 {
    // Infinite rays are truncated at 1e16 m; the rest matters only without extinction.
    let rest = match geometry.length_m.is_infinite() && extinction == 0.0 {
        true => 1e-16 / (4.0 * PI),
        false => 0.0,
    };
    rest + along(geometry, &[], |t, u| {
        let r2 = u * u + geometry.nearest_m * geometry.nearest_m;
        (-extinction * excess(geometry, t, u)).exp() / (4.0 * PI * r2)
    })
}

/// Geometries of the tests.
pub fn geometries(nearest: &[f64]) -> impl Iterator<Item = LightRayGeometry> + '_ {
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

/// Path radiance of a light in the first lane by the defining integral, without clamping distances to the light's radius.
pub fn path_radiance<const N: usize>(
    light: &Light<Spectrum<N>>,
    fog: &ScatteringLayer<N>,
    view_ray: &ViewRay,
) -> f64 {
    let ViewRay { eye, direction, .. } = *view_ray;
    let length = match light {
        Light::Sphere(sphere) => sphere
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
    let own = &fog.layer;
    let extinction = f64::from(own.extinction_per_m[0]);
    let ray = RaySegment::new(eye.y, direction.y, length, fog.ground_radius_m);
    let edges = edges(light, fog, view_ray, &ray);
    let integral = along(&geometry, &edges, |t, u| {
        let r = (geometry.nearest_m * geometry.nearest_m + u * u).sqrt();
        let point = eye + t * direction;
        let towards = (light.position() - point) / r;
        let (to_surface_m, part) = match light {
            Light::Point(_) => (r, 1.0),
            Light::Spot(spot) => {
                let closest = true_nearest.max(1e-300) / geometry.nearest_m;
                let off = (point - light.position()) / r;
                assert!(closest > 0.99, "spot lights are not on the ray");
                (r, spot.falloff(off))
            }
            Light::Sphere(sphere) => {
                let x = (sphere.radius_m / r).powi(2).min(1.0);
                (r - sphere.radius_m, 2.0 / (1.0 + (1.0 - x).sqrt()))
            }
        };
        let height = ray.height_at(t);
        let curvature = 0.5 / fog.ground_radius_m;
        let offset = t * (towards.x * direction.x + towards.z * direction.z);
        let to_light = RaySegment {
            height_m: height,
            sin_elevation: towards.y + 2.0 * curvature * offset,
            curvature_per_m: curvature * (1.0 - towards.y * towards.y).max(0.0),
            length_m: to_surface_m,
        };
        let column = |profile: &DensityProfile| {
            profile.column_along_m(&RaySegment { length_m: t, ..ray })
                + match profile.is_uniform() {
                    true => to_surface_m,
                    false => profile.column_along_m(&to_light),
                }
        };
        let others = fog.others.iter();
        let others = others.map(|o| f64::from(o.extinction_per_m[0]) * column(&o.density));
        let depth = extinction * column(&own.density) + others.sum::<f64>();
        let phase = own.phase.evaluate(-u / r, own.wavelengths_nm[0]);
        own.density.at(height) * part * phase * (-depth).exp() / (r * r)
    });
    let scattering = f64::from(own.scattering_per_m[0]);
    scattering * f64::from(light.intensity()[0]) * integral
}

/// Distances at which density or intensity has a kink, or density is largest.
fn edges<const N: usize>(
    light: &Light<Spectrum<N>>,
    fog: &ScatteringLayer<N>,
    view_ray: &ViewRay,
    ray: &RaySegment,
) -> Vec<f64> {
    let mut edges = Vec::new();
    let others = fog.others.iter().map(|other| &other.density);
    for profile in others.chain([&fog.layer.density]) {
        let structure = profile.structure();
        edges.extend(structure.kinks_m.iter().map(|&kink| ray.below(kink)));
        if !structure.decays.is_empty() {
            edges.push((-0.5 * ray.sin_elevation / ray.curvature_per_m, 0.0));
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
        let cone = SpotCone::new(spot, &geometry, view_ray.eye, view_ray.direction);
        edges.extend(cone.lit(&geometry));
    }
    edges
        .into_iter()
        .flat_map(|(a, b)| [a, b])
        .filter(|t| t.is_finite() && *t > 0.0 && *t < view_ray.length_m)
        .collect()
}
