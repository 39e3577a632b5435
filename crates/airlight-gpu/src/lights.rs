//! Lights in fog: what the pass of `lights.wgsl` reads.

use crate::error::SkyRendererError;
use crate::pass::{UNIFORM, bind_group, group_layout, uniform};
use airlight::fog::lights::{Light, PointLight, SphereLight, SpotLight};
use airlight_shaders::twins::lights::{
    ExponentialFog, LocalLight, point_light, sphere_light, spot_light,
};
use glam::Vec3;

/// Largest number of lights in a fog.
pub const MOST_LIGHTS: usize = 16;

/// Uploads a fog, and lights around an eye at a height above the ground, m.
pub fn upload(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    (fog, eye_height_m): (&ExponentialFog, f32),
    lights: &[LocalLight],
) -> wgpu::BindGroup {
    let label = "airlight lights";
    let numbers = uniform(device, label, &numbers(fog, eye_height_m, lights));
    bind_group(device, layout, label, &[numbers.as_entire_binding()])
}

/// The numbers of the shader's struct `Lights`.
fn numbers(fog: &ExponentialFog, eye_height_m: f32, lights: &[LocalLight]) -> Vec<f32> {
    const LIGHT_NUMBERS: usize = 16;
    let mut all = fog.medium.extinction_per_m.extend(0.0).to_array().to_vec();
    all.extend(fog.medium.scattering_per_m.extend(0.0).to_array());
    all.extend([fog.mean_cosine, fog.reference_height_m, fog.scale_height_m]);
    all.push(0.0);
    all.extend([f32::from_bits(lights.len() as u32), eye_height_m, 0.0, 0.0]);
    let above_ground = Vec3::Y * eye_height_m;
    for light in lights {
        all.extend((light.position + above_ground).to_array());
        all.push(f32::from_bits(light.kind));
        all.extend(light.intensity.extend(light.radius_m).to_array());
        all.extend(light.axis.extend(light.cos_inner).to_array());
        all.extend([light.cos_outer, 0.0, 0.0, 0.0]);
    }
    all.resize(
        all.len() + (MOST_LIGHTS - lights.len()) * LIGHT_NUMBERS,
        0.0,
    );
    all
}

/// Layout of the group of fog and lights.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    group_layout(device, "airlight lights", &[UNIFORM])
}

/// Lights as the shader has them, around the eye.
pub fn local_lights(lights: &[Light<[f32; 3]>]) -> Result<Vec<LocalLight>, SkyRendererError> {
    if lights.len() > MOST_LIGHTS {
        return Err(SkyRendererError::TooManyLights {
            count: lights.len(),
            most: MOST_LIGHTS,
        });
    }
    lights.iter().map(local_light).collect()
}

fn local_light(light: &Light<[f32; 3]>) -> Result<LocalLight, SkyRendererError> {
    let position = light.position().as_vec3();
    let radius_m = light.radius_m() as f32;
    let emission = Vec3::from_array(*light.emission());
    // Their fields are public.
    match light {
        Light::Point(light) => {
            PointLight::new(light.position, light.intensity, light.radius_m)?;
            Ok(point_light(position, radius_m, emission))
        }
        Light::Spot(light) => {
            let (inner, outer) = (light.inner_angle_rad, light.outer_angle_rad);
            let light = SpotLight::new(
                light.position,
                light.axis,
                light.intensity,
                inner,
                outer,
                light.radius_m,
            )?;
            let axis = light.axis.as_vec3();
            let [inner, outer] = [inner, outer].map(|angle| angle.cos() as f32);
            Ok(spot_light(position, radius_m, emission, axis, inner, outer))
        }
        Light::Sphere(light) => {
            SphereLight::new(light.position, light.radius_m, light.radiance)?;
            Ok(sphere_light(position, radius_m, emission))
        }
        _ => Err(SkyRendererError::LightKind),
    }
}
