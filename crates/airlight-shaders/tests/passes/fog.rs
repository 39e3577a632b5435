//! [`Pass::Fog`].

use crate::frame::{Drawn, FORMAT, both_forms, cleared, texture};
use crate::vulkan;
use airlight::atmosphere::DensityProfile;
use airlight::axes;
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight_shaders::Pass;
use glam::{Mat4, Vec3, Vec4};

const SIZE: u32 = 64;
const EYE: Vec3 = Vec3::new(3.0, 12.0, -4.0);
const EXTINCTION: [f32; 3] = [0.02, 0.022, 0.025];
const SCATTERING: [f32; 3] = [0.019, 0.021, 0.024];
const SUNLIGHT: [f32; 3] = [3.0, 2.8, 2.4];
const AMBIENT: [f32; 3] = [0.2, 0.25, 0.3];
const REFERENCE_M: f32 = 2.0;
const SCALE_M: f32 = 25.0;
const MEAN_COSINE: f32 = 0.8;
const NEAR_M: f32 = 0.5;
const COLOUR: [f32; 4] = [0.5, 0.25, 0.125, 1.0];

fn sun() -> DVec3 {
    axes::direction(20.0, 15.0)
}

/// From clip coordinates of a reversed, infinite perspective to the world: a point at the depth `d` is `NEAR_M / d` before the eye.
fn world_from_clip() -> Mat4 {
    let forward = Vec3::new(0.2, -0.1, -1.0).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let tangent = 0.6 * NEAR_M;
    Mat4::from_cols(
        (tangent * right).extend(0.0),
        (tangent * up).extend(0.0),
        EYE.extend(1.0),
        (NEAR_M * forward).extend(0.0),
    )
}

/// The uniform of the pass, 16 bytes a row.
fn uniform() -> Vec<u8> {
    let mut rows = world_from_clip().to_cols_array().to_vec();
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
    let textures = [colours.clone(), depth.clone()];
    let drawn = Drawn::new(
        (device, queue),
        source,
        "add_fog",
        SIZE,
        &uniform(),
        &textures,
    );
    let mut frames = Vec::new();
    for &at in depths {
        let mut encoder = device.create_command_encoder(&Default::default());
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[cleared(&colours, COLOUR.map(f64::from))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(at),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        }));
        frames.push(drawn.frame(encoder));
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
    let world_from_clip = world_from_clip().as_dmat4();
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
        for row in 0..SIZE {
            for column in 0..SIZE {
                let at = |x: u32| 2.0 * (f64::from(x) + 0.5) / f64::from(SIZE) - 1.0;
                let position = |depth: f64| {
                    world_from_clip.project_point3(DVec3::new(at(column), -at(row), depth))
                        - EYE.as_dvec3()
                };
                let to_point = position(if *depth > 0.0 { f64::from(*depth) } else { 1.0 });
                let distance_m = match *depth > 0.0 {
                    true => to_point.length(),
                    false => f64::INFINITY,
                };
                let path = fog.path(f64::from(EYE.y), to_point.normalize(), distance_m);
                let right = Vec3::from(path.apply([COLOUR[0], COLOUR[1], COLOUR[2]]));
                let pixel = (row * SIZE + column) as usize;
                let got = Vec4::from_slice(&frame[4 * pixel..]);
                assert_eq!(got.w, 1.0);
                let error = ((got.truncate() - right) / right).abs().max_element();
                worst = worst.max(error);
            }
        }
    }
    println!("worst relative difference {worst:e}");
    assert!(worst < 2e-5, "{worst}");
}
