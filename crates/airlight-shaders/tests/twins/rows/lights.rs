//! Lights in fog.

use super::air::exponential;
use super::fog::medium;
use super::{Row, rows};
use crate::flat::{Flat, flat_struct};
use crate::random::Random;
use airlight::fog::lights::{
    Light, LightRayGeometry as ExactGeometry, LightSettings, PointLight, RgbLightSet, SphereLight,
    SpotLight, ViewRay, airlight_isotropic as exact_isotropic,
    airlight_without_extinction as exact_without_extinction,
};
use airlight::fog::{DensityProfile, Ground, RgbLayer};
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight_shaders::twins;
use glam::Vec3;
use std::f64::consts::PI;
use twins::lights::{LocalLight, light_ray};

flat_struct! {
    twins::lights::LocalLight { position, kind, intensity, radius_m, axis, cos_inner, cos_outer }
    twins::lights::LightRayGeometry { nearest_m, start_m, length_m }
    twins::lights::LightRay { geometry, light, nearest_m, across_m, along }
    twins::lights::ExponentialFog { medium, mean_cosine, reference_height_m, scale_height_m }
}

const POINT: f32 = 0.0;
const SPOT: f32 = 1.0;
const SPHERE: f32 = 2.0;

/// Numbers of a light.
const LIGHT: usize = 13;
/// Numbers of a ray past a light.
const RAY: usize = 19;

fn infinite(length_m: f64) -> f64 {
    if length_m >= 1e12 {
        f64::INFINITY
    } else {
        length_m
    }
}

/// A segment past a light: beside, before, behind it; short to infinite.
fn segment(r: &mut Random) -> Vec<f32> {
    let start = r.decades(1e-2, 1e3);
    vec![
        r.decades(1e-2, 100.0),
        r.one_of(&[0.0, start, -start, -start]),
        r.or(&[0.1, 1e12], |r| r.decades(1e-2, 1e4)),
    ]
}

fn exact_segment(x: &[f64]) -> ExactGeometry {
    ExactGeometry {
        nearest_m: x[0],
        start_m: x[1],
        length_m: infinite(x[2]),
    }
}

fn vector(x: &[f64]) -> DVec3 {
    DVec3::new(x[0], x[1], x[2])
}

/// A place of a scene, m.
fn position(r: &mut Random) -> [f32; 3] {
    [
        r.between(-40.0, 40.0),
        r.or(&[1.7, -2.0], |r| r.between(0.0, 30.0)),
        r.between(-40.0, 40.0),
    ]
}

/// A light of one of some kinds.
fn light(r: &mut Random, kinds: &[f32]) -> Vec<f32> {
    let kind = r.one_of(kinds);
    let mut all = position(r).to_vec();
    all.push(kind);
    all.extend(r.rgb(|r| r.between(0.1, 1.0)));
    all.push(r.one_of(&[0.1, 0.3]));
    if kind == SPOT {
        // Also half of all directions, and a hard edge.
        let outer = match r.unit() < 0.1 {
            true => std::f32::consts::FRAC_PI_2,
            false => r.between(0.1, 1.5),
        };
        let inner = match r.unit() < 0.1 {
            true => outer,
            false => outer * r.between(0.3, 0.9),
        };
        all.extend(r.direction());
        all.extend([inner, outer].map(|angle| angle.cos().max(0.0)));
    } else {
        all.extend([0.0; 5]);
    }
    all
}

/// Eye and direction: often at the light, or straight towards or away from it; of a spot light also along and across its axis.
fn view(r: &mut Random, light: &[f32]) -> Vec<f32> {
    let position = Vec3::from_slice(light);
    let eye = match r.unit() < 0.1 {
        true => position,
        false => Vec3::from(self::position(r)),
    };
    let to_light = (position - eye).try_normalize();
    let direction = match (to_light, r.unit()) {
        (Some(to_light), x) if x < 0.1 => to_light,
        (Some(to_light), x) if x < 0.15 => -to_light,
        (_, x) if x < 0.25 && light[3] == SPOT => {
            let axis = Vec3::from_slice(&light[8..]);
            let across = axis.cross(Vec3::from(r.direction()));
            match (r.unit(), across.try_normalize()) {
                (x, Some(across)) if x < 0.5 => across,
                (x, _) if x < 0.75 => -axis,
                _ => axis,
            }
        }
        (Some(to_light), x) if x < 0.5 => {
            let beside = Vec3::from(r.direction()) * 0.1;
            (to_light + beside).normalize()
        }
        _ => Vec3::from(r.direction()),
    };
    let mut all = eye.to_array().to_vec();
    all.extend(direction.to_array());
    all.push(r.or(&[1e12], |r| r.decades(1.0, 300.0)));
    all
}

fn light_and_view(r: &mut Random, kinds: &[f32]) -> Vec<f32> {
    let light = light(r, kinds);
    let view = view(r, &light);
    [light, view].concat()
}

/// The numbers of a ray past a light.
fn ray_of(light_and_view: &[f32]) -> Vec<f32> {
    let mut numbers = light_and_view.iter();
    let light = LocalLight::read(&mut numbers);
    let [eye, direction] = [Vec3::read(&mut numbers), Vec3::read(&mut numbers)];
    let ray = light_ray(light, eye, direction, f32::read(&mut numbers));
    let mut all = Vec::new();
    ray.write(&mut all);
    all
}

/// A light of the library. `axis` of a spot light.
fn exact_light(x: &[f64], position: DVec3, axis: DVec3) -> Light<[f32; 3]> {
    let radius_m = x[7];
    let intensity = [x[4], x[5], x[6]];
    let plain = intensity.map(|v| v as f32);
    match x[3] as f32 {
        SPOT => Light::Spot(
            SpotLight::new(position, axis, plain, x[11].acos(), x[12].acos(), radius_m)
                .expect("a light"),
        ),
        SPHERE => {
            let radiance = intensity.map(|v| (v / (PI * radius_m * radius_m)) as f32);
            Light::Sphere(SphereLight::new(position, radius_m, radiance).expect("a light"))
        }
        _ => Light::Point(PointLight::new(position, plain, radius_m).expect("a light")),
    }
}

/// Path radiance of a light in fog that scatters all light it removes, by the library with many nodes.
fn exact_radiance(
    light: Light<[f32; 3]>,
    density: DensityProfile,
    extinction: &[f64],
    phase: PhaseFunction,
    view_ray: &ViewRay,
) -> [f64; 3] {
    let layer = RgbLayer {
        density,
        extinction_per_m: [0, 1, 2].map(|c| extinction[c] as f32),
        single_scattering_albedo: [1.0; 3],
        phase,
    };
    let settings = LightSettings {
        nodes: 32,
        ..LightSettings::default()
    };
    let set = RgbLightSet::new(vec![light], &[layer], Ground::FLAT, settings).expect("lights");
    set.path_radiance(view_ray).map(f64::from)
}

/// Scattering divided by extinction, by which the radiance of `exact_radiance` is multiplied.
fn albedo(medium: &[f64], c: usize) -> f64 {
    medium[3 + c] / medium[c]
}

fn henyey_greenstein(g: f64) -> PhaseFunction {
    PhaseFunction::henyey_greenstein(g).expect("a phase function")
}

/// A light in fog of a profile: medium, then (in order) mean cosine, light and view.
fn in_fog(medium: &[f64], g: f64, density: DensityProfile, light: &[f64]) -> Vec<f64> {
    let view = &light[LIGHT..];
    let exact = exact_light(light, vector(light), vector(&light[8..]));
    let view_ray = ViewRay {
        eye: vector(view),
        direction: vector(&view[3..]),
        length_m: infinite(view[6]),
    };
    let radiance = exact_radiance(exact, density, medium, henyey_greenstein(g), &view_ray);
    (0..3).map(|c| radiance[c] * albedo(medium, c)).collect()
}

/// A panel of a ray past a light for unit intensity and scattering: the ray of the library that starts there, behind what is
/// before. The scene is one with the numbers of the ray: `a` is the part of the vector from the light to the closest point that is
/// in the vertical plane of the ray.
fn panel(
    ray: &[f64],
    [eye_height_m, sine]: [f64; 2],
    [from, to]: [f64; 2],
    extinction: &[f64],
    g: f64,
    density: DensityProfile,
) -> Vec<f64> {
    let (start, nearest, light) = (ray[1], ray[16], &ray[3..]);
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let direction = DVec3::new(cosine, sine, 0.0);
    let closest_height_m = eye_height_m - sine * start;
    let a = match density.is_uniform() || nearest * cosine < 1e-9 {
        true => 0.0,
        false => ((closest_height_m - light[1]) / (nearest * cosine)).clamp(-1.0, 1.0),
    };
    let across = DVec3::new(-sine * a, cosine * a, (1.0 - a * a).sqrt());
    let eye = DVec3::new(0.0, eye_height_m, 0.0);
    let position = eye - start * direction - nearest * across;
    let mut unit = light.to_vec();
    unit[4..7].fill(1.0);
    let view_ray = ViewRay {
        eye: eye + from * direction,
        direction,
        length_m: infinite(to - from),
    };
    let before = airlight::fog::RaySegment::new(eye_height_m, sine, from, f64::INFINITY);
    let column_m = density.column_along_m(&before);
    let exact = exact_light(&unit, position, DVec3::Y);
    let radiance = exact_radiance(exact, density, extinction, henyey_greenstein(g), &view_ray);
    (0..3)
        .map(|c| radiance[c] / extinction[c] * (-extinction[c] * column_m).exp())
        .collect()
}

/// Extinction of three channels that differ by at most a factor of 3, 1/m.
fn extinction(r: &mut Random) -> [f32; 3] {
    let grey = r.decades(1e-3, 0.2);
    r.rgb(|r| grey * r.between(1.0, 3.0))
}

/// Extinction and scattering, 1/m.
fn coloured(r: &mut Random) -> Vec<f32> {
    let extinction = extinction(r);
    let scattering = extinction.map(|x| x * r.between(0.5, 1.0));
    [extinction, scattering].concat()
}

fn mean_cosine(r: &mut Random) -> f32 {
    r.one_of(&[0.0, 0.5, 0.8, 0.9, -0.3])
}

/// Coefficients, mean cosine, reference and scale height, m.
fn exponential_fog(r: &mut Random) -> Vec<f32> {
    let mut all = coloured(r);
    all.extend([
        mean_cosine(r),
        r.or(&[0.0], |r| r.between(0.0, 10.0)),
        r.decades(3.0, 300.0),
    ]);
    all
}

fn place(r: &mut Random) -> f32 {
    let size = r.decades(1e-2, 1e3);
    r.one_of(&[0.0, size, -size])
}

/// `r + u` of a place beside a light.
fn ahead(h: f64, u: f64) -> f64 {
    let far = h.hypot(u) + u.abs();
    if u < 0.0 { h * h / far } else { far }
}

fn excess(x: &[f64]) -> f64 {
    let end = x[1] + x[2];
    x[2] * (ahead(x[0], x[1]) + ahead(x[0], end)) / (x[0].hypot(x[1]) + x[0].hypot(end))
}

/// Gauss-Legendre nodes on the unit interval, of the eighth Legendre polynomial by Newton's method.
fn gauss(i: usize) -> [f64; 2] {
    let mut x = -((PI * (i as f64 + 0.75)) / 8.5).cos();
    let mut slope = 1.0;
    for _ in 0..50 {
        let (mut before, mut here) = (1.0, x);
        for k in 2..=8 {
            let k = f64::from(k);
            (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
        }
        slope = 8.0 * (x * here - before) / (x * x - 1.0);
        x -= here / slope;
    }
    [0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)]
}

fn span(scale: f64, end: f64) -> f64 {
    let covered = 1.0 / (1.0 + scale / end);
    let last = (scale / end * covered).cbrt();
    covered / (1.0 + last + last * last)
}

/// Distances at which a ray is in a cone: where `across + u along` is at least `cos r`, from a quadratic equation.
fn in_cone(ray: &[f64], cos: f64) -> Vec<f64> {
    let (h, start, length) = (ray[0], ray[1], ray[2]);
    if ray[6] != f64::from(SPOT) {
        return vec![0.0, length];
    }
    let (across, along) = (ray[17], ray[18]);
    let inside = |u: f64| across + u * along >= cos * h.hypot(u);
    let (a, b, c) = (
        along * along - cos * cos,
        across * along,
        across * across - cos * cos * h * h,
    );
    let mut edges = vec![start, start + length];
    // b^2 - a c; 0 at a cone of a right angle, a plane that the ray meets once.
    let root = cos * cos * (h * h * along * along + across * across - cos * cos * h * h);
    if root >= 0.0 {
        let q = -b - root.sqrt().copysign(b);
        edges.extend([q / a, c / q]);
    }
    edges.retain(|u| (start..=start + length).contains(u));
    edges.sort_by(f64::total_cmp);
    for pair in edges.windows(2) {
        if pair[1] > pair[0] && inside(0.5 * (pair[0] + pair[1])) {
            return vec![pair[0] - start, pair[1] - start];
        }
    }
    vec![0.0, 0.0]
}

fn at_light(x: &[f64]) -> Vec<f64> {
    let (h, u, nearest, light) = (x[0], x[RAY], x[16], &x[3..]);
    let r = h.hypot(u);
    match light[3] as f32 {
        SPOT => {
            let cos = (x[17] + u * x[18]) / r;
            let part = match cos >= light[11] {
                true => 1.0,
                false => ((cos - light[12]) / (light[11] - light[12])).max(0.0),
            };
            vec![part * part, r, ahead(h, u) / r]
        }
        SPHERE => {
            let radius = light[7];
            let centre = nearest.hypot(u).max(radius);
            let closeness = 2.0 / (1.0 + (1.0 - (radius / centre).powi(2)).max(0.0).sqrt());
            let closer = closeness * (r / centre).powi(2);
            vec![closer, centre - radius, (1.0 + u / centre).min(2.0)]
        }
        _ => vec![1.0, r, ahead(h, u) / r],
    }
}

fn exact_ray(x: &[f64]) -> Vec<f64> {
    let (light, view) = (&x[..LIGHT], &x[LIGHT..]);
    let [position, axis] = [vector(light), vector(&light[8..])];
    let [eye, direction] = [vector(view), vector(&view[3..])];
    let to_light = position - eye;
    let nearest = to_light.cross(direction).length();
    let start = -to_light.dot(direction);
    let mut length = view[6];
    if light[3] == f64::from(SPHERE) {
        let sphere = SphereLight::new(position, light[7], [1.0f32; 3]).expect("a light");
        length = length.min(sphere.hit(eye, direction).unwrap_or(length));
    }
    let closest = -to_light - start * direction;
    let mut all = vec![nearest.max(light[7]), start, length];
    all.extend(light);
    all.extend([nearest, closest.dot(axis), direction.dot(axis)]);
    all
}

fn local(kind: f32, x: &[f64], intensity: [f64; 3], rest: [f64; 5]) -> Vec<f64> {
    let mut all = x[..3].to_vec();
    all.push(f64::from(kind));
    all.extend(intensity);
    all.push(x[3]);
    all.extend(rest);
    all
}

pub fn lights() -> Vec<Row> {
    rows!(twins::lights {
        point_light: |r| (0..7).map(|_| r.unit()).collect()
            => |x| local(POINT, x, [x[4], x[5], x[6]], [0.0; 5]);
        spot_light: |r| (0..12).map(|_| r.unit()).collect()
            => |x| local(SPOT, x, [x[4], x[5], x[6]], [x[7], x[8], x[9], x[10], x[11]]);
        sphere_light: |r| (0..7).map(|_| r.unit()).collect() => |x| {
            let area = PI * x[3] * x[3];
            local(SPHERE, x, [4, 5, 6].map(|c| area * x[c]), [0.0; 5])
        };
        light_ray_geometry: |r| {
            let all = light_and_view(r, &[POINT]);
            let mut row = all[LIGHT..].to_vec();
            row.extend(&all[..3]);
            row.push(all[7]);
            row
        } => |x| {
            let geometry = ExactGeometry::new(vector(x), vector(&x[3..]), x[6], vector(&x[7..]), x[10]);
            vec![geometry.nearest_m, geometry.start_m, geometry.length_m]
        };
        light_distance_m: |r| vec![r.decades(1e-2, 100.0), place(r)] => |x| vec![x[0].hypot(x[1])];
        light_ahead_m: |r| vec![r.decades(1e-2, 100.0), place(r)] => |x| vec![ahead(x[0], x[1])];
        light_excess_m: segment => |x| vec![excess(x)];
        light_angle: segment => |x| vec![exact_segment(x).angle()];
        airlight_without_extinction: segment => |x| vec![exact_without_extinction(&exact_segment(x))];
        light_gauss_node: |r| vec![(r.unit() * 8.0).floor()] => |x| gauss(x[0] as usize).to_vec();
        light_node_span: |r| vec![r.decades(1e-3, 1e3), r.or(&[1e12], |r| r.decades(1e-3, 1e4))]
            => |x| vec![span(x[0], x[1])];
        light_node: |r| vec![(r.unit() * 8.0).floor(), r.decades(1e-3, 1e3), r.between(0.01, 1.0)] => |x| {
            let [place, weight] = gauss(x[0] as usize);
            let q = 1.0 - x[2] * place;
            let scaled = x[1] * x[2] * 3.0 * weight;
            vec![x[1] * (1.0 / q.powi(3) - 1.0), scaled / q.powi(4)]
        };
        airlight_isotropic: |r| [segment(r), r.rgb(|r| r.decades(1e-5, 1.0)).to_vec()].concat() => |x| {
            let segment = exact_segment(x);
            (3..6).map(|c| exact_isotropic(&segment, x[c])).collect()
        };
        point_light_in_isotropic_fog: |r| [medium(r), light_and_view(r, &[POINT])].concat() => |x| {
            let view = &x[6 + LIGHT..];
            let light = vector(&x[6..]);
            let geometry = ExactGeometry::new(
                vector(view), vector(&view[3..]), infinite(view[6]), light, x[6 + 7],
            );
            (0..3).map(|c| x[3 + c] * x[10 + c] * exact_isotropic(&geometry, x[c])).collect()
        };
        light_ray: |r| light_and_view(r, &[POINT, SPOT, SPHERE]) => exact_ray;
        lit_interval: |r| loop {
            let mut ray = ray_of(&light_and_view(r, &[POINT, SPOT]));
            let cos = ray[15];
            let (h, across, along) = (ray[0], ray[17], ray[18]);
            // Not where the ray almost touches the cone, or its end is almost parallel to it.
            let touches = (across / h).hypot(along) - cos;
            if touches.abs() > 0.02 && (along.abs() - cos).abs() > 0.02 {
                ray.push(cos);
                return ray;
            }
        } => |x| in_cone(x, x[RAY]);
        light_at: |r| {
            let mut all = ray_of(&light_and_view(r, &[POINT, SPOT, SPHERE]));
            all.push(place(r));
            // Not at a hard edge, where light jumps.
            let (h, u) = (all[0], all[RAY]);
            let cos_angle = (all[17] + u * all[18]) / h.hypot(u);
            let is_hard = all[3 + 3] == SPOT && all[14] == all[15];
            if is_hard && (cos_angle - all[15]).abs() < 1e-4 {
                all[14] = 0.5 * (1.0 + all[15]);
            }
            all
        } => at_light;
        light_peak: |r| vec![mean_cosine(r)] => |x| vec![((1.0 - x[0]) / (1.0 + x[0])).min(1.0)];
        light_panel_in_uniform_fog: |r| {
            let ray = ray_of(&light_and_view(r, &[POINT, SPHERE]));
            let mut all = extinction(r).to_vec();
            all.push(mean_cosine(r));
            let from = r.or(&[0.0], Random::unit) * ray[2].min(100.0);
            let to = ray[2];
            all.extend(ray);
            all.extend([from, to]);
            all
        } => |x| {
            let ends = [x[4 + RAY], x[5 + RAY]];
            panel(&x[4..], [0.0, 0.0], ends, x, x[3], DensityProfile::Uniform)
        };
        light_in_uniform_fog: |r| {
            let mut all = coloured(r);
            all.push(mean_cosine(r));
            all.extend(light_and_view(r, &[POINT, SPOT, SPHERE]));
            all
        } => |x| in_fog(x, x[6], DensityProfile::Uniform, &x[7..]);
        column_by_light_m: |r| {
            let mut all = exponential_fog(r);
            all.extend([r.between(0.0, 30.0), r.sine(), r.decades(0.1, 300.0)]);
            let height = all[9] + all[10] * all[11];
            let centre = r.decades(0.2, 100.0);
            all.extend([height + centre * r.between(-1.0, 1.0), centre, centre - r.one_of(&[0.0, 0.1])]);
            all
        } => |x| {
            let profile = exponential(x[7], x[8]);
            let flat = |height, sine, length| {
                let ray = airlight::fog::RaySegment::new(height, sine, length, f64::INFINITY);
                profile.column_along_m(&ray).min(1e25)
            };
            let height = x[9] + x[10] * x[11];
            vec![flat(x[9], x[10], x[11]) + flat(height, (x[12] - height) / x[13], x[14])]
        };
        light_panel_in_exponential_fog: |r| {
            let scene = light_and_view(r, &[POINT, SPHERE]);
            let ray = ray_of(&scene);
            let mut all = exponential_fog(r);
            let (height, sine) = (scene[LIGHT + 1], scene[LIGHT + 4]);
            all.extend([height, sine]);
            // Up to the point closest to the light or from there, over at most three scale heights.
            let closest = (-ray[1]).clamp(0.0, ray[2]);
            let most = 3.0 * all[8] / sine.abs().max(1e-6);
            let [from, to] = match r.unit() < 0.5 {
                true => [(closest - most).max(0.0), closest],
                false => [closest, ray[2].min(closest + most)],
            };
            all.extend(ray);
            all.extend([from, to]);
            all
        } => |x| {
            let ends = [x[11 + RAY], x[12 + RAY]];
            panel(&x[11..], [x[9], x[10]], ends, x, x[6], exponential(x[7], x[8]))
        };
        light_in_exponential_fog: |r| [exponential_fog(r), light_and_view(r, &[POINT, SPOT, SPHERE])].concat()
            => |x| in_fog(x, x[6], exponential(x[7], x[8]), &x[9..]);
    })
}

/// Of the inputs of each kind of light, dozens have it on the ray ahead, behind, and at the eye.
#[test]
fn lights_on_the_ray_and_at_the_eye_are_among_the_inputs() {
    let mut random = Random::new(1);
    let mut counts = [[0; 3]; 3];
    for _ in 0..2000 {
        let all = light_and_view(&mut random, &[POINT, SPOT, SPHERE]);
        let [position, eye, direction] =
            [0, LIGHT, LIGHT + 3].map(|at| Vec3::from_slice(&all[at..]));
        let to_light = position - eye;
        let along = to_light.normalize_or_zero().dot(direction);
        let counts = &mut counts[all[3] as usize];
        counts[0] += usize::from(to_light == Vec3::ZERO);
        counts[1] += usize::from(along > 1.0 - 1e-6);
        counts[2] += usize::from(along < 1e-6 - 1.0);
    }
    assert!(
        counts.iter().flatten().all(|&count| count > 20),
        "{counts:?}"
    );
}
