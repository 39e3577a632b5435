//! [`SunShadows`]: shadows in air and fog, of ground or from a shadow map.

use crate::error::{SkyRendererError, is_invertible, require};
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
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for a size that the texture has not, a matrix that has no inverse, and a reach that is not above 0 or
    /// not finite.
    pub fn from_map(device: &wgpu::Device, map: &ShadowMap<'_>) -> Result<Self, SkyRendererError> {
        let texture = map.depth.texture();
        let largest = [texture.width(), texture.height()];
        let fits = |(side, most): (&u32, u32)| (1..=most).contains(side);
        require(
            map.size.iter().zip(largest).all(fits),
            "a width and a height of the shadow map from 1 to those of its texture",
            &map.size,
        )?;
        require(
            is_invertible(&map.clip_from_world),
            "a finite matrix from the world to the clip space of the shadow map that has an inverse",
            &map.clip_from_world,
        )?;
        require(
            map.reach_m > 0.0 && map.reach_m.is_finite(),
            "a finite reach of the shadow map above 0 m",
            &map.reach_m,
        )?;
        let mut numbers = map.clip_from_world.to_cols_array().to_vec();
        numbers.extend(map.size.map(|n| n as f32));
        numbers.extend([map.reach_m, if map.is_reversed { -1.0 } else { 1.0 }]);
        let label = "airlight shadow map";
        let numbers = uniform(device, label, &numbers);
        let resources = [
            numbers.as_entire_binding(),
            wgpu::BindingResource::TextureView(map.depth),
        ];
        Ok(Self {
            caster: Caster::Map,
            group: bind_group(device, &Caster::Map.layout(device), label, &resources),
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::headless::Headless;

    #[test]
    fn maps_that_throw_no_shadows_are_refused() {
        let Headless { device, .. } = Headless::new().unwrap();
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: 16,
                height: 8,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let right = ShadowMap {
            depth: &texture.create_view(&Default::default()),
            size: [16, 8],
            clip_from_world: Mat4::from_diagonal(glam::Vec4::new(1e-3, 1e-3, 1e-4, 1.0)),
            is_reversed: false,
            reach_m: 800.0,
        };
        assert!(SunShadows::from_map(&device, &right).is_ok());
        let refusal = |map| SunShadows::from_map(&device, &map).unwrap_err().to_string();
        for size in [[0, 8], [17, 8], [8, 16]] {
            let refusal = refusal(ShadowMap { size, ..right });
            assert!(refusal.contains("its texture, got ["), "{refusal}");
        }
        for clip_from_world in [
            Mat4::ZERO,
            Mat4::NAN,
            right.clip_from_world * f32::INFINITY,
            Mat4::from_diagonal(glam::Vec4::new(1e-3, 0.0, 1e-4, 1.0)),
        ] {
            let refusal = refusal(ShadowMap {
                clip_from_world,
                ..right
            });
            assert!(refusal.contains("inverse"), "{refusal}");
        }
        for reach_m in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let refusal = refusal(ShadowMap { reach_m, ..right });
            assert!(refusal.contains("reach of the shadow map"), "{refusal}");
        }
    }
}
