//! A planet in the sky of another: two engines draw over one frame.

use super::{draw, reference, renderer_for_all_suns, rgb_of};
use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::spectrum::RgbSpace;
use airlight_gpu::headless::{Frame, Headless};
use airlight_gpu::{Camera, Projection};
use glam::{DMat3, Mat4, Vec3};

/// From the eye to the middle of the far planet.
const DISTANCE_M: f64 = 3e7;

/// The same camera in a frame that is turned.
fn turned(camera: &Camera, turn: DMat3) -> Camera {
    let Projection::Perspective {
        world_from_clip,
        far_depth,
    } = camera.projection()
    else {
        panic!("a perspective");
    };
    let turned = Projection::Perspective {
        world_from_clip: Mat4::from_mat3(turn.as_mat3()) * world_from_clip,
        far_depth,
    };
    Camera::new(turned, camera.exposure()).unwrap()
}

#[test]
fn a_planet_in_the_sky_of_another_is_that_of_the_solver() {
    let gpu = Headless::new().unwrap();
    let towards = axes::direction(180.0, 50.0);
    // Axes of the far planet, whose up leads from its middle to the eye.
    let up = -towards;
    let east = up.any_orthonormal_vector();
    let to_far = DMat3::from_cols(east, up, east.cross(up)).transpose();
    let sun = axes::direction(60.0, 20.0);
    let (near_air, far_air) = (Preset::Mars, Preset::Clear);
    let height_m = DISTANCE_M - far_air.atmosphere().planet.radius_m;
    let mut far = renderer_for_all_suns(&gpu, far_air);
    far.update(height_m, to_far * sun).unwrap();
    let mut near = renderer_for_all_suns(&gpu, near_air);
    near.update(2.0, sun).unwrap();
    near.set_discs(false);
    let frame = Frame::towards(towards.as_vec3(), 96);
    let exposure = 1e-4;
    let camera = frame.camera(exposure).unwrap();
    let far_camera = turned(&camera, to_far);
    let view = reference(
        far_air,
        axes::elevation_deg(to_far * sun),
        height_m,
        to_far * sun,
    );
    let grid = view.sky().grid();

    let alone = draw(&gpu, &mut near, &frame, exposure, None);
    let mut planet = gpu
        .draw(&frame, None, |encoder, target, depth| {
            far.record(encoder, target, depth, &far_camera);
        })
        .unwrap();
    let both = gpu
        .draw(&frame, None, |encoder, target, depth| {
            far.record(encoder, target, depth, &far_camera);
            near.record(encoder, target, depth, &camera);
        })
        .unwrap();
    let radius = (view.bounds_m().0 / DISTANCE_M).asin();
    let brightest = planet.iter().map(|rgb| rgb[1]).fold(0.0, f32::max);
    let (mut squares, mut count, mut behind) = (0.0, 0.0, 0);
    for (k, planet) in planet.iter_mut().enumerate() {
        let direction = frame.direction(k as u32 % frame.side, k as u32 / frame.side);
        let direction = direction.as_dvec3().normalize();
        let away = direction.angle_between(towards);
        if away > 1.2 * radius {
            assert_eq!(*planet, [0.0; 3]);
            continue;
        }
        // The lit part of the planet's face, whose limb pixels average.
        let right = rgb_of(grid, &view.along(to_far * direction, None).radiance());
        let luminance = |rgb: [f64; 3]| RgbSpace::Srgb.luminance(rgb) * f64::from(exposure);
        if away < 0.97 * radius && luminance(right) > 0.05 * f64::from(brightest) {
            let error = RgbSpace::Srgb.luminance(planet.map(f64::from)) / luminance(right) - 1.0;
            squares += error * error;
            count += 1.0;
        }
        // What the air of the near planet lets through, and its own light.
        let [behind_air, air, seen] = [*planet, alone[k], both[k]].map(Vec3::from);
        let through = (seen - air) / behind_air.max(Vec3::splat(1e-6));
        if behind_air.y > 0.2 * brightest {
            assert!(through.y > 0.2 && through.y < 1.0, "{direction}: {through}");
            behind += 1;
        }
    }
    let rms: f64 = (squares / f64::max(count, 1.0)).sqrt();
    println!("{count} pixels of the planet: {rms:.4}; {behind} behind air");
    assert!(
        count > 50.0 && rms < 0.004 && behind > 50,
        "{count} {rms} {behind}"
    );
    // With the disc of the sun hidden by the far planet's engine alone.
    let sunlit = Frame::towards(sun.as_vec3(), 257);
    let [with, without] = [true, false].map(|discs| {
        near.set_discs(discs);
        let pixels = draw(&gpu, &mut near, &sunlit, 1e-6, None);
        pixels.iter().map(|rgb| rgb[1]).fold(0.0, f32::max)
    });
    assert!(with > 5.0 * without, "{with} {without}");
}
