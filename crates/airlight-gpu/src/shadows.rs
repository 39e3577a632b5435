//! [`SunShadows`]: shadows in air and fog, of ground or from a shadow map.

use crate::gpu_tables::{self, FLAT};
use crate::pass::{UNIFORM, bind_group, group_layout, texture, uniform};
use glam::Mat4;

/// Where the sun is hidden, for [`SkyPasses::record_shadowed`](crate::SkyPasses::record_shadowed): by the ground of a
/// [`TerrainPass`](crate::TerrainPass), which finds how far up its shadow reaches above each place, or by what a program has drawn into a
/// [`ShadowMap`].
#[derive(Debug)]
pub struct SunShadows {
    caster: Caster,
    group: wgpu::BindGroup,
}

/// What throws shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caster {
    Ground,
    Map,
}

impl Caster {
    /// All casters, in the order of their values.
    pub const ALL: [Self; 2] = [Self::Ground, Self::Map];

    /// Layout of the group of shadows.
    pub fn layout(self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        match self {
            Self::Ground => gpu_tables::layout(device, &[FLAT]),
            Self::Map => group_layout(
                device,
                "airlight shadow map",
                &[UNIFORM, texture(FLAT, false)],
            ),
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Ground => include_str!("shadow_ground.wgsl"),
            Self::Map => include_str!("shadow_map.wgsl"),
        }
    }

    /// The pass of shadows in air, behind the passes of the sky.
    pub fn in_air(self, sky_shader: &str) -> String {
        const ONCE: &str = "
fn once_to(direction: vec3<f32>, distance_m: f32) -> vec3<f32> {
    return rgb_from_spectrum(sky.radiance_weights, air_to(Pixel(direction, distance_m)).path_radiance);
}
";
        [sky_shader, ONCE, self.text(), SHADOW].concat()
    }

    /// The pass of shadows in fog, behind the passes of the fog.
    pub fn in_fog(self, fog_shader: &str) -> String {
        const ONCE: &str = "
fn once_to(direction: vec3<f32>, distance_m: f32) -> vec3<f32> {
    return path_to(Pixel(direction, distance_m)).path_radiance;
}
";
        [fog_shader, ONCE, self.text(), SHADOW].concat()
    }
}

const SHADOW: &str = include_str!("shadow.wgsl");

/// Depths that a program has drawn as the sun sees its scene.
#[derive(Clone, Copy, Debug)]
pub struct ShadowMap<'a> {
    /// The depths, in a texture of two dimensions that can be bound, such as `Depth32Float`.
    pub depth: &'a wgpu::TextureView,
    /// Width and height of the texture.
    pub size: [u32; 2],
    /// From the world around the eye, in metres, to the clip space of the map. There is no shadow outside the map.
    pub clip_from_world: Mat4,
    /// Whether depths decrease away from the sun, as with reversed depth.
    pub is_reversed: bool,
    /// Distance from the eye up to which rays are marched, m: as far as the map reaches.
    pub reach_m: f32,
}

impl SunShadows {
    /// Shadows by a shadow map. Its texture is read when a frame is drawn.
    pub fn from_map(device: &wgpu::Device, map: &ShadowMap<'_>) -> Self {
        let mut numbers = map.clip_from_world.to_cols_array().to_vec();
        numbers.extend(map.size.map(|n| n as f32));
        numbers.extend([map.reach_m, if map.is_reversed { -1.0 } else { 1.0 }]);
        let label = "airlight shadow map";
        let numbers = uniform(device, label, &numbers);
        let resources = [
            numbers.as_entire_binding(),
            wgpu::BindingResource::TextureView(map.depth),
        ];
        Self {
            caster: Caster::Map,
            group: bind_group(device, &Caster::Map.layout(device), label, &resources),
        }
    }

    /// Shadows of ground by the height of their surface, with the numbers of the shader's struct `Shadow`.
    pub(crate) fn of_ground(
        device: &wgpu::Device,
        sampler: &wgpu::Sampler,
        surface: &wgpu::TextureView,
        numbers: &[f32],
    ) -> Self {
        let layout = Caster::Ground.layout(device);
        let views = std::slice::from_ref(surface);
        Self {
            caster: Caster::Ground,
            group: gpu_tables::bind(device, &layout, numbers, sampler, views),
        }
    }

    pub(crate) fn caster(&self) -> Caster {
        self.caster
    }

    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }
}
