//! Point, spot and sphere lights in fog.

use super::common::{Layers, black, layers, scene};
use airlight::fog::lights::{LightForm, LightRayGeometry};
use airlight::scene::{LightKind, LightSpec};
use airlight_render::overlay::OverlayScene;
use glam::DVec3;
use std::f64::consts::PI;

const SIZE: (u32, u32) = (32, 24);

/// A point light of equal intensity in all colours.
pub fn point(position_m: [f64; 3], intensity: f64) -> LightSpec {
    LightSpec {
        position_m: Some(position_m),
        intensity: [intensity; 3],
        ..LightSpec::default()
    }
}

fn at_pixel(pixel: [f64; 2], distance_m: Option<f64>) -> LightSpec {
    LightSpec {
        pixel: Some(pixel),
        distance_m,
        intensity: [1.0; 3],
        ..LightSpec::default()
    }
}

fn lit(lights: &[LightSpec], more: impl Fn(&mut OverlayScene)) -> Layers {
    let mut scene = scene([0.0; 3]);
    scene.scene.lights = lights.to_vec();
    more(&mut scene);
    layers(&scene, &black(SIZE, &scene.overlay))
}

/// Pixel (20, 8) of 32 across 60 degrees from a height of 1.6 m, and a light that its view ray passes.
#[test]
fn lights_shine_as_their_form_says() {
    let focal_px = 16.0 / 30f64.to_radians().tan();
    let along = DVec3::new((20.5 - 16.0) / focal_px, (12.0 - 8.5) / focal_px, -1.0);
    let (eye, at) = (DVec3::Y * 1.6, DVec3::new(1.0, 2.0, -4.0));
    let geometry = LightRayGeometry::new(eye, along.normalize(), 10.0 * along.length(), at, 1e-3);
    let extinction = 20f64.recip() * -0.05f64.ln();
    let light = LightSpec {
        intensity: [2.0, 1.0, 0.5],
        radius_m: Some(1e-3),
        ..point(at.to_array(), 1.0)
    };
    for form in [
        LightForm::Exact,
        LightForm::SplitSum,
        LightForm::NoExtinction,
        LightForm::Printed,
    ] {
        let seen = lit(std::slice::from_ref(&light), |s| {
            s.overlay.light_form = form
        });
        let expected = extinction * form.airlight(&geometry, extinction);
        for (lane, intensity) in [2.0, 1.0, 0.5].into_iter().enumerate() {
            let got = f64::from(seen.rgb(20, 8)[lane]);
            assert!(
                (got / (intensity * expected) - 1.0).abs() < 1e-4,
                "{form:?} {lane}: {got} {expected}"
            );
        }
        // Where the ray passes the light the printed form is negative, in the layers as in the picture.
        assert_eq!(expected < 0.0, form == LightForm::Printed);
        assert_eq!(seen.pixel(20, 8)[7], seen.pixel(20, 8)[1]);
    }
    // Behind the wall the ray does not pass it: only the unit is wrong.
    let behind = LightSpec {
        radius_m: Some(1e-3),
        ..point([1.0, 2.0, -40.0], 1.0)
    };
    let [printed, right] = [LightForm::Printed, LightForm::NoExtinction].map(|form| {
        let seen = lit(std::slice::from_ref(&behind), |s| {
            s.overlay.light_form = form
        });
        seen.rgb(20, 8)[1]
    });
    assert!((f64::from(printed / right) / (4.0 * PI * PI) - 1.0).abs() < 1e-5);
}

#[test]
fn a_light_has_a_halo_without_fireflies() {
    let forward = |s: &mut OverlayScene| {
        s.fog_mut().droplets = None;
        s.scene.camera.fov_deg = Some(20.0);
    };
    for light in [
        at_pixel([12.0, 6.0], Some(5.0)),
        LightSpec {
            kind: LightKind::Sphere,
            radius_m: Some(0.005),
            ..at_pixel([12.0, 6.0], Some(5.0))
        },
        LightSpec {
            kind: LightKind::Spot,
            elevation_deg: Some(-90.0),
            inner_deg: Some(60.0),
            outer_deg: Some(85.0),
            ..at_pixel([12.0, 6.0], Some(5.0))
        },
    ] {
        let light = LightSpec {
            intensity: [2.0, 1.0, 0.5],
            ..light
        };
        let seen = lit(std::slice::from_ref(&light), forward);
        let row: Vec<f32> = (12..32).map(|x| seen.rgb(x, 7)[0]).collect();
        assert!(
            row.is_sorted_by(|near, far| near > far || *near == 0.0),
            "{:?}: {row:?}",
            light.kind
        );
        let [r, g, b] = seen.rgb(20, 10);
        assert!((r / g - 2.0).abs() < 1e-4 && (g / b - 2.0).abs() < 1e-4);
        if light.kind == LightKind::Point {
            // The light's own pixel is about the mean of the glow in it: of 25 pixels of a finer picture.
            let mut fine = scene([0.0; 3]);
            forward(&mut fine);
            fine.scene.lights = vec![LightSpec {
                pixel: Some([62.0, 32.0]),
                ..light.clone()
            }];
            let many = layers(&fine, &black((160, 120), &fine.overlay));
            let parts = (0..25).map(|i| many.rgb(60 + i % 5, 30 + i / 5)[0]);
            let ratio = seen.rgb(12, 6)[0] / (parts.sum::<f32>() / 25.0);
            assert!((0.7..1.4).contains(&ratio), "{ratio}");
        }
    }
}

#[test]
fn a_light_is_placed_by_pixel_or_position() {
    // 32 pixels across 60 degrees, looking north: a focal length of 27.7 pixels; 1.6 m above the ground.
    let focal_px = 16.0 / 30f64.to_radians().tan();
    let (right, up) = ((20.5 - 16.0) / focal_px, (12.0 - 8.5) / focal_px);
    let length = (1.0 + right * right + up * up).sqrt();
    let [x, y, z] = [right, up, -1.0].map(|v| 4.0 * v / length);
    let same = |a: &[LightSpec], b: &[LightSpec], factor: f32| {
        let (a, b) = (lit(a, |_| {}), lit(b, |_| {}));
        for (a, b) in a.channel(1).zip(b.channel(1)) {
            assert!(a > 0.0 && (b / a / factor - 1.0).abs() < 1e-4, "{a} {b}");
        }
    };
    let by_pixel = at_pixel([20.0, 8.0], Some(4.0));
    same(&[by_pixel], &[point([x, y + 1.6, z], 1.0)], 1.0);
    // Without a distance: on the wall, 10 m along the axis.
    let on_wall = at_pixel([20.0, 8.0], None);
    same(
        &[on_wall],
        &[at_pixel([20.0, 8.0], Some(10.0 * length))],
        1.0,
    );
    // Two lights in one place are one of twice the intensity; one behind the camera shines, too.
    let behind = point([1.0, 2.0, 6.0], 1.0);
    same(
        std::slice::from_ref(&behind),
        &[behind.clone(), behind.clone()],
        2.0,
    );
}

#[test]
fn lights_without_a_place_in_the_picture_are_refused() {
    let refused = |light: LightSpec| {
        let mut scene = scene([0.0; 3]);
        scene.scene.lights = vec![light];
        let image = black(SIZE, &scene.overlay);
        let prepared = airlight_render::overlay::PreparedOverlay::new(&scene, &image, None);
        prepared.err().unwrap().to_string()
    };
    for (light, part) in [
        (at_pixel([40.0, 2.0], Some(3.0)), "32 x 24"),
        (at_pixel([4.5, 2.0], Some(3.0)), "whole numbers"),
        (
            LightSpec {
                intensity: [1e300; 3],
                ..point([0.0, 1.0, -5.0], 1.0)
            },
            "intensity",
        ),
        (
            LightSpec {
                kind: LightKind::Spot,
                inner_deg: Some(50.0),
                outer_deg: Some(20.0),
                ..point([0.0, 1.0, -5.0], 1.0)
            },
            "inner angle",
        ),
    ] {
        let sentence = refused(light);
        assert!(
            sentence.starts_with("light 1: ") && sentence.contains(part),
            "{sentence}"
        );
    }
    // The sky at a pixel is at no distance.
    let mut scene = scene([0.0; 3]);
    scene.scene.lights = vec![at_pixel([3.0, 3.0], None)];
    let mut image = black(SIZE, &scene.overlay);
    image.depth.metres.fill(f32::INFINITY);
    let prepared = airlight_render::overlay::PreparedOverlay::new(&scene, &image, None);
    assert!(
        prepared
            .err()
            .unwrap()
            .to_string()
            .contains("a distance in metres")
    );
}
