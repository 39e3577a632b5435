//! Draws the Earth in the evening sky of a planet with the air of Mars: two engines over one frame.
//! `cargo run --release -p airlight-gpu --example two_planets -- OUT.png [SUN_DEG]`.

mod picture;

use airlight::glam::{DMat3, Mat4};
use airlight::{atmosphere::Preset, axes};
use airlight_gpu::headless::{FORMAT, Frame, Headless};
use airlight_gpu::{Camera, Projection, SkyRenderer, SkyRendererSettings};
use std::error::Error;

/// From the eye to the middle of the Earth, m.
const DISTANCE_M: f64 = 3e7;
const EXPOSURE: f32 = 1.2e-4;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let output = arguments.first().ok_or("expected OUT.png")?;
    let sun_deg: f64 = arguments.get(1).map_or(Ok(6.0), |text| text.parse())?;
    let sun = axes::direction(250.0, sun_deg);
    let program = Headless::new()?;
    let settings = SkyRendererSettings::new(FORMAT);
    let renderer = |air: Preset| {
        SkyRenderer::new(
            &program.device,
            &program.queue,
            &air.atmosphere(),
            &settings,
        )
    };

    // Of the far planet, up is from its middle to the eye.
    let towards = axes::direction(190.0, 30.0);
    let (up, east) = (-towards, towards.any_orthonormal_vector());
    let to_far = DMat3::from_cols(east, up, east.cross(up)).transpose();
    let mut far = renderer(Preset::Average)?;
    let radius_m = Preset::Average.atmosphere().planet.radius_m;
    far.update(DISTANCE_M - radius_m, to_far * sun)?;

    // The far engine draws the sun, which its planet may hide.
    let mut near = renderer(Preset::Mars)?;
    near.update(50.0, sun)?;
    near.set_discs(false);

    let frame = Frame::towards(axes::direction(205.0, 24.0).as_vec3(), 640);
    let camera = frame.camera(EXPOSURE)?;
    let turn = Mat4::from_mat3(to_far.as_mat3());
    let turned = Projection::Perspective {
        world_from_clip: turn * frame.clip_from_world.inverse(),
        far_depth: 0.0,
    };
    let far_camera = Camera::new(turned, EXPOSURE)?;
    let pixels = program.draw(&frame, None, |encoder, target, depth| {
        far.record(encoder, target, depth, &far_camera);
        near.record(encoder, target, depth, &camera);
    })?;
    picture::write(output, &pixels, 1.0)
}
