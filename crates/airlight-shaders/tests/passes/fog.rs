//! [`Pass::Fog`].

use crate::camera::{NEAR_M, SIZE, place_of, world_from_clip};
use crate::frame::{Drawn, FORMAT, both_forms, even_scene, texture};
use crate::vulkan;
use airlight::atmosphere::DensityProfile;
use airlight::axes;
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight_shaders::Pass;
use glam::Vec3;

const EYE: Vec3 = Vec3::new(3.0, 12.0, -4.0);
const EXTINCTION: [f32; 3] = [0.02, 0.022, 0.025];
const SCATTERING: [f32; 3] = [0.019, 0.021, 0.024];
const SUNLIGHT: [f32; 3] = [3.0, 2.8, 2.4];
const AMBIENT: [f32; 3] = [0.2, 0.25, 0.3];
const REFERENCE_M: f32 = 2.0;
const SCALE_M: f32 = 25.0;
const MEAN_COSINE: f32 = 0.8;
const COLOUR: [f32; 4] = [0.5, 0.25, 0.125, 1.0];

fn sun() -> DVec3 {
    axes::direction(20.0, 15.0)
}

/// The uniform of the pass, 16 bytes a row.
fn uniform() -> Vec<u8> {
    let mut rows = world_from_clip(EYE).to_cols_array().to_vec();
    let mut row = |vector: [f32; 3], last: f32| {
        rows.extend(vector);
        rows.push(last);
    };
    row(EYE.to_array(), 0.0);
    row(EXTINCTION, 0.0);
    row(SCATTERING, 0.0);
    row(sun().as_vec3().to_array(), REFERENCE_M);
    row(SUNLIGHT, SCALE_M);
    row(AMBIENT, MEAN_COSINE);
    rows.iter().flat_map(|x| x.to_ne_bytes()).collect()
}

/// Frames of one colour, all at one depth each, with fog.
fn draw(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    source: wgpu::ShaderSource,
    depths: &[f32],
) -> Vec<Vec<f32>> {
    let colours = texture(device, SIZE, FORMAT).create_view(&Default::default());
    let depth_format = wgpu::TextureFormat::Depth32Float;
    let depth = texture(device, SIZE, depth_format).create_view(&Default::default());
    let resources = [&colours, &depth].map(wgpu::BindingResource::TextureView);
    let drawn = Drawn::new(
        (device, queue),
        source,
        "add_fog",
        SIZE,
        &uniform(),
        &resources,
    );
    let mut frames = Vec::new();
    for &at in depths {
        let scene = even_scene(device, [&colours, &depth], COLOUR, at);
        frames.push(drawn.frame(scene));
    }
    frames
}

#[test]
fn the_pass_draws_the_fog_of_the_library() {
    let layer = RgbLayer {
        density: DensityProfile::Exponential {
            reference_height_m: f64::from(REFERENCE_M),
            scale_height_m: f64::from(SCALE_M),
        },
        extinction_per_m: EXTINCTION,
        single_scattering_albedo: [0, 1, 2].map(|c| SCATTERING[c] / EXTINCTION[c]),
        phase: PhaseFunction::henyey_greenstein(f64::from(MEAN_COSINE)).expect("a phase function"),
    };
    let lighting = FogLighting {
        sun: Some(DirectionalLight {
            direction: sun(),
            irradiance: SUNLIGHT,
        }),
        ambient: AMBIENT,
        ground_albedo: [0.0; 3],
    };
    let fog = RgbFog::new(&[layer], Ground::FLAT, &lighting, FogScattering::Single).expect("a fog");
    // The sky, 50 m and 2 m.
    let depths = [0.0, NEAR_M / 50.0, NEAR_M / 2.0];
    let (_, device, queue) = vulkan::open();
    let mut worst = 0.0f32;
    let forms = both_forms(Pass::Fog).into_iter();
    let drawn = forms.flat_map(|source| {
        let frames = draw((&device, &queue), source, &depths);
        depths.iter().zip(frames)
    });
    for (depth, frame) in drawn {
        for (pixel, got) in frame.as_chunks::<4>().0.iter().enumerate() {
            let (direction, distance_m) = place_of(EYE, pixel as u32, *depth);
            let direction = direction.as_dvec3().normalize();
            let path = fog.path(f64::from(EYE.y), direction, f64::from(distance_m));
            let right = Vec3::from(path.apply([COLOUR[0], COLOUR[1], COLOUR[2]]));
            assert_eq!(got[3], 1.0);
            let error = ((Vec3::from_slice(got) - right) / right).abs();
            worst = worst.max(error.max_element());
        }
    }
    println!("worst relative difference {worst:e}");
    assert!(worst < 2e-5, "{worst}");
}
