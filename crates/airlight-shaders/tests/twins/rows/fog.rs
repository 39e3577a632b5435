//! Fog.

use super::air::{clamped, divided_difference, exact_ray, exponential, phi, ray};
use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::axes;
use airlight::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RaySegment, RgbFog,
    RgbLayer,
};
use airlight::optics::PhaseFunction;
use airlight_shaders::twins;

flat_struct! {
    twins::fog::FogMedium { extinction_per_m, scattering_per_m }
    twins::fog::FogLight { sunlight, sin_sun, ambient }
    twins::fog::FogLayer { extinction_per_m, profile, scattering_per_m, height_m, phase, scale_m }
    twins::fog::FogLayers { layers, count, ground_height_m, inverse_radius_per_m, light }
}

/// Extinction and scattering, 1/m, from clear air to dense fog.
pub fn medium(r: &mut Random) -> Vec<f32> {
    let extinction = r.rgb(|r| r.or(&[0.0, 0.02], |r| r.decades(1e-6, 0.3)));
    let scattering = extinction.map(|x| x * r.between(0.5, 1.0));
    [extinction, scattering].concat()
}

/// Sunlight, the sine of the sun's elevation, ambient light.
pub fn light(r: &mut Random) -> Vec<f32> {
    let mut all = r.rgb(Random::unit).to_vec();
    all.push(r.or(&[0.0, -0.1, 1.0, 0.01], |r| r.between(0.0, 1.0)));
    all.extend(r.rgb(Random::unit));
    all
}

/// Medium, numbers, light.
fn between<const N: usize>(r: &mut Random, others: [fn(&mut Random) -> f32; N]) -> Vec<f32> {
    let mut all = medium(r);
    all.extend(others.map(|other| other(r)));
    all.extend(light(r));
    all
}

/// Single scattering of one profile in f64: columns along the ray, and to the sun from both ends.
pub fn single(x: &[f64], light: &[f64], column_m: f64, to_sun_m: Option<[f64; 2]>) -> Vec<f64> {
    let transmittance = (0..3).map(|c| (-x[c] * column_m).exp());
    let radiance = (0..3).map(|c| {
        let depth = x[c] * column_m;
        let sunlit = match to_sun_m {
            Some([near, far]) => divided_difference(x[c] * near, x[c] * (far + column_m)),
            None => phi(depth),
        };
        x[c + 3] * column_m * (light[c] * sunlit + light[c + 4] * phi(depth))
    });
    transmittance.chain(radiance).collect()
}

/// A ray over flat ground: height, sine, length from the seventh number on.
fn flat_ray(x: &[f64]) -> RaySegment {
    exact_ray(&[x[6], x[7], 0.0, x[8]])
}

/// Single scattering of a profile over flat ground.
pub fn in_profile(profile: &DensityProfile, x: &[f64], attenuated: bool) -> Vec<f64> {
    let ray = flat_ray(x);
    let light = &x[11..];
    let column_m = profile.column_along_m(&ray).min(1e25);
    let to_sun = |height_m: f64| match light[3] > 0.0 {
        true => (profile.column_above_m(height_m) / light[3]).min(1e25),
        false => 1e25,
    };
    let ends = attenuated.then(|| [to_sun(ray.height_m), to_sun(ray.end_height_m())]);
    single(x, light, column_m, ends)
}

/// Numbers of a layer in an array of layers.
const LAYER: usize = 12;

fn layer(r: &mut Random) -> Vec<f32> {
    let extinction = r.rgb(|r| r.decades(1e-4, 0.05));
    let scattering = extinction.map(|x| x * r.between(0.5, 1.0));
    let mut all = extinction.to_vec();
    all.push(r.one_of(&[0.0, 1.0, 1.0, 2.0, 3.0]));
    all.extend(scattering);
    all.push(r.edge_m());
    // Grey, as a phase function of the library is.
    all.extend([r.between(0.02, 0.5); 3]);
    all.push(r.decades(5.0, 500.0));
    all
}

/// One to four layers over the ground.
fn layers(r: &mut Random) -> Vec<f32> {
    let mut all: Vec<f32> = (0..4).flat_map(|_| layer(r)).collect();
    all.push(r.one_of(&[1.0, 2.0, 3.0, 4.0]));
    all.push(0.0);
    all.push(r.one_of(&[0.0, 0.0, 1.0 / 6.371e6]));
    all.extend(r.rgb(Random::unit));
    all.push(r.or(&[1.0, 0.5], |r| r.between(0.05, 1.0)));
    all.extend(r.rgb(Random::unit));
    all
}

/// A ray that stays above the ground and is no longer than the f64 library states errors for.
fn ray_in_layers(r: &mut Random) -> Vec<f32> {
    loop {
        let mut ray = ray(r);
        ray[2] = 0.0;
        ray[3] = ray[3].min(1e4);
        let end = ray[0] + ray[1] * ray[3];
        if ray[0] >= 0.0 && end >= 0.0 {
            return ray;
        }
    }
}

/// Layers and a ray over the same ground.
fn layers_and_ray(r: &mut Random) -> Vec<f32> {
    let mut all = layers(r);
    let mut ray = ray_in_layers(r);
    let inverse_radius = all[4 * LAYER + 2];
    ray[2] = 0.5 * ((1.0 - ray[1]) * (1.0 + ray[1])).max(0.0) * inverse_radius;
    all.extend(ray);
    all
}

/// The profile of a layer.
fn profile(x: &[f64]) -> DensityProfile {
    let (height, scale) = (x[7], x[11]);
    match x[3] as u32 {
        1 => exponential(height, scale),
        2 => clamped(height, scale),
        3 => DensityProfile::Layer {
            bottom_m: height,
            top_m: height + scale,
        },
        _ => DensityProfile::Uniform,
    }
}

fn layer_profiles(x: &[f64]) -> impl Iterator<Item = (&[f64], DensityProfile)> {
    let count = x[4 * LAYER] as usize;
    x.chunks(LAYER)
        .take(count)
        .map(|layer| (layer, profile(layer)))
}

/// Optical depth of all layers along a ray.
fn depth(x: &[f64], ray: &RaySegment, with_uniform: bool) -> Vec<f64> {
    let mut depth = vec![0.0; 3];
    for (layer, profile) in layer_profiles(x) {
        if with_uniform || !profile.is_uniform() {
            let column_m = profile.column_along_m(ray).min(1e25);
            for (depth, extinction) in depth.iter_mut().zip(layer) {
                *depth += extinction * column_m;
            }
        }
    }
    depth
}

/// Several layers by the f64 library. Its phase functions depend on the angle; here each layer has an isotropic one, times
/// a factor on its scattering, and ambient light is computed apart.
fn in_layers(x: &[f64]) -> Vec<f64> {
    let light = &x[4 * LAYER + 3..];
    let ray = exact_ray(&x[4 * LAYER + 10..]);
    let radius_m = match x[4 * LAYER + 2] > 0.0 {
        true => 1.0 / x[4 * LAYER + 2],
        false => f64::INFINITY,
    };
    let ground = Ground {
        height_m: x[4 * LAYER + 1],
        radius_m,
    };
    let isotropic = PhaseFunction::Isotropic.evaluate(1.0, 550.0);
    let fog = |sunlit: bool| {
        let layers: Vec<RgbLayer> = layer_profiles(x)
            .map(|(layer, density)| RgbLayer {
                density,
                extinction_per_m: [0, 1, 2].map(|c| layer[c] as f32),
                single_scattering_albedo: [0, 1, 2].map(|c| {
                    // The phase functions differ by layer, and an albedo may not exceed 1.
                    let phase = if sunlit { layer[8] / 0.5 } else { 1.0 };
                    ((layer[c + 4] / layer[c]) * phase) as f32
                }),
                phase: PhaseFunction::Isotropic,
            })
            .collect();
        let lighting = FogLighting {
            sun: sunlit.then(|| DirectionalLight {
                direction: axes::direction(90.0, light[3].asin().to_degrees()),
                irradiance: [0, 1, 2].map(|c| (light[c] * 0.5 / isotropic) as f32),
            }),
            ambient: match sunlit {
                true => [0.0; 3],
                false => [4, 5, 6].map(|c| light[c] as f32),
            },
            ground_albedo: [0.0; 3],
        };
        RgbFog::new(&layers, ground, &lighting, FogScattering::Single).expect("a fog")
    };
    let [sunlit, ambient] = [true, false].map(|sunlit| fog(sunlit).path_along(&ray, 0.0));
    let transmittance = sunlit.transmittance.map(f64::from);
    let radiance = [0, 1, 2].map(|c| f64::from(sunlit.path_radiance[c] + ambient.path_radiance[c]));
    [transmittance, radiance].concat()
}

/// Heights at which the f64 library splits rays because of a layer: from its definition.
fn next_break(x: &[f64]) -> Vec<f64> {
    const STEPS: [f64; 14] = [
        0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0,
    ];
    let (base, scale, level, rising, ground) = (x[7], x[11], x[12], x[13] != 0.0, x[14]);
    let heights: Vec<f64> = match x[3] as u32 {
        0 => Vec::new(),
        3 => vec![base, base + scale],
        1 => STEPS.map(|step| ground + step * scale).to_vec(),
        _ => STEPS.map(|step| base.max(ground) + step * scale).to_vec(),
    };
    let heights = heights.into_iter();
    vec![match rising {
        true => heights.filter(|h| *h > level).fold(1e30, f64::min),
        false => heights.filter(|h| *h < level).fold(-1e30, f64::max),
    }]
}

pub fn fog() -> Vec<Row> {
    rows!(twins::fog {
        fog_undimmed: |r| between(r, [column_m]) => |x| single(x, &x[7..], x[6], None);
        fog_single_scattering: |r| between(r, [column_m, column_m, column_m])
            => |x| single(x, &x[9..], x[6], Some([x[7], x[8]]));
        uniform_fog: |r| between(r, [Random::length_m]) => |x| single(x, &x[7..], x[6], None);
        column_to_sun_m: |r| vec![column_m(r), r.or(&[0.0, -1.0, 1e-6], |r| r.between(0.0, 1.0))]
            => |x| vec![if x[1] > 0.0 { (x[0] / x[1]).min(1e25) } else { 1e25 }];
        exponential_fog_undimmed: |r| between(r, [
            Random::height_m, Random::sine, Random::length_m, Random::edge_m, Random::scale_m,
        ]) => |x| in_profile(&exponential(x[9], x[10]), x, false);
        exponential_fog: |r| between(r, [
            Random::height_m, Random::sine, Random::length_m, Random::edge_m, Random::scale_m,
        ]) => |x| in_profile(&exponential(x[9], x[10]), x, true);
        clamped_fog: |r| between(r, [
            Random::height_m, Random::sine, Random::length_m, Random::edge_m, Random::scale_m,
        ]) => |x| in_profile(&clamped(x[9], x[10]), x, true);
        fog_layer_column_m: |r| [layer(r), ray(r)].concat()
            => |x| vec![profile(x).column_along_m(&exact_ray(&x[LAYER..])).min(1e25)];
        fog_optical_depth: |r| layers_and_ray(r)
            => |x| depth(x, &exact_ray(&x[4 * LAYER + 10..]), true);
        fog_depth_to_sun: |r| {
            let mut all = layers(r);
            all.push(r.height_m().max(0.0));
            all
        } => |x| {
            let sine = x[4 * LAYER + 6];
            let inverse_radius = x[4 * LAYER + 2];
            let curvature = 0.5 * (1.0 - sine * sine) * inverse_radius;
            depth(x, &exact_ray(&[x[4 * LAYER + 10], sine, curvature, 1e12]), false)
        };
        next_fog_break_m: |r| {
            let mut all = layer(r);
            let level = r.one_of(&[0.0, 1.0, 2.0]);
            all.push(all[7] + level * all[11] + r.between(-3.0, 3.0));
            all.push(r.one_of(&[0.0, 1.0]));
            all.push(r.one_of(&[0.0, -20.0, 30.0]));
            all
        } => next_break;
        layered_fog: layers_and_ray => in_layers;
    })
}

/// A column, m.
fn column_m(r: &mut Random) -> f32 {
    r.or(&[0.0, 1e25], |r| r.decades(1e-3, 1e6))
}
