//! A scene in the coordinates of a planet, millions of metres from their origin, at two places of it.

use crate::shadows::{Disc, sun};
use crate::{SIDE, settings, valley_fog};
use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::fog::lights::{Light, PointLight, SpotLight};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Camera, Projection, ShadowMap, SkyRenderer, SkyRendererSettings, SunShadows};
use glam::{DMat3, DMat4, DVec3, Vec3};

const AIR: Preset = Preset::Average;
const HEIGHT_M: f64 = 12.0;
const EXPOSURE: f32 = 1e-4;

/// A place on the planet: the axes east, up and south there, and the eye, in coordinates around an origin.
struct Place {
    axes: DMat3,
    eye: DVec3,
}

impl Place {
    /// The place in a direction from the middle of the planet, which is `middle` from the origin.
    fn new(up: DVec3, middle: DVec3) -> Self {
        let up = up.normalize();
        let east = DVec3::Z.cross(up).normalize();
        Self {
            axes: DMat3::from_cols(east, up, east.cross(up)),
            eye: middle + up * (AIR.atmosphere().planet.radius_m + HEIGHT_M),
        }
    }

    /// What is around the eye, in metres to the east, up and to the south, in the coordinates of the planet.
    fn point(&self, around_eye: DVec3) -> DVec3 {
        self.eye + self.axes * around_eye
    }

    /// From the coordinates of the planet to those around the eye.
    fn around_eye(&self) -> DMat4 {
        let turn = self.axes.transpose();
        DMat4::from_mat3(turn) * DMat4::from_translation(-self.eye)
    }
}

/// A scene as a program has it: all in the coordinates of the planet.
struct Scene {
    place: Place,
    sun: DVec3,
    point_light: DVec3,
    spot_light: [DVec3; 2],
    clip_from_planet: DMat4,
    map_from_planet: DMat4,
}

impl Scene {
    fn at(place: Place, frame: &Frame, disc: &Disc) -> Self {
        let around_eye = place.around_eye();
        let to_planet = |matrix: glam::Mat4| matrix.as_dmat4() * around_eye;
        let spot = DVec3::new(60.0, -4.0, 20.0);
        Self {
            sun: place.axes * sun(),
            point_light: place.point(DVec3::new(30.0, -4.0, -10.0)),
            spot_light: [spot, spot + DVec3::new(0.3, -1.0, 0.2)].map(|p| place.point(p)),
            clip_from_planet: to_planet(frame.clip_from_world),
            map_from_planet: to_planet(disc.clip_from_world()),
            place,
        }
    }

    /// Draws it, with or without lights and shadows: the place of the eye is subtracted, and up is that of the eye.
    fn draw(
        &self,
        gpu: &Headless,
        frame: &Frame,
        disc: &Disc,
        [has_lights, has_shadows]: [bool; 2],
    ) -> Vec<[f32; 3]> {
        let settings = SkyRendererSettings {
            solver: settings(axes::elevation_deg(sun()), HEIGHT_M),
            shadows: true,
            ..SkyRendererSettings::new(FORMAT)
        };
        let air = AIR.atmosphere();
        let mut renderer = SkyRenderer::new(&gpu.device, &gpu.queue, &air, &settings).unwrap();
        let around_eye = self.place.around_eye();
        let planet_from_eye = around_eye.inverse();
        let at = |point: DVec3| around_eye.transform_point3(point);
        let [spot, ahead] = self.spot_light.map(at);
        let lights = [
            Light::Point(PointLight::new(at(self.point_light), [1e6, 8e5, 5e5], 0.1).unwrap()),
            Light::Spot(SpotLight::new(spot, ahead - spot, [5e6; 3], 0.3, 0.6, 0.2).unwrap()),
        ];
        renderer.set_fog(Some(valley_fog())).unwrap();
        if has_lights {
            renderer.set_lights(&lights).unwrap();
        }
        renderer
            .update(HEIGHT_M, around_eye.transform_vector3(self.sun))
            .unwrap();
        let perspective = Projection::Perspective {
            world_from_clip: (self.clip_from_planet * planet_from_eye)
                .inverse()
                .as_mat4(),
            far_depth: 0.0,
        };
        let camera = Camera::new(perspective, EXPOSURE).unwrap();
        let map = ShadowMap {
            depth: &disc.map(gpu),
            size: [Disc::SIDE; 2],
            clip_from_world: (self.map_from_planet * planet_from_eye).as_mat4(),
            is_reversed: false,
            reach_m: 800.0,
        };
        let shadows = SunShadows::from_map(&gpu.device, &map).unwrap();
        let walls = Geometry {
            colour: [0.2, 0.5, 0.9],
            distance_m: &|x, y| match (x + y) % 3 {
                0 => f32::INFINITY,
                _ => 20.0 + 100.0 * ((x * y) % 61) as f32,
            },
        };
        let pixels = gpu.draw(frame, Some(&walls), |encoder, target, depth| {
            let shadows = has_shadows.then_some(&shadows);
            renderer.record_shadowed(encoder, target, depth, &camera, shadows);
        });
        pixels.unwrap()
    }
}

/// Air, fog, lights in it, and the shadow of a disc: the same pixels within their rounding.
#[test]
fn scenes_far_from_the_origin_and_elsewhere_on_a_planet_look_the_same() {
    let gpu = Headless::new().unwrap();
    let disc = Disc::new();
    let frame = Frame::towards(axes::direction(70.0, 12.0).as_vec3(), SIDE);
    let middle = -DVec3::Y * (AIR.atmosphere().planet.radius_m + HEIGHT_M);
    let place = |up: DVec3, middle: DVec3| Scene::at(Place::new(up, middle), &frame, &disc);
    let draw = |scene: Scene, parts| scene.draw(&gpu, &frame, &disc, parts);
    // With the origin at the eye.
    let near = draw(place(DVec3::Y, middle), [true; 2]);
    let brightest = near.as_flattened().iter().fold(0.0f32, |a, b| a.max(*b));
    let largest_difference = |pixels: &[[f32; 3]]| {
        let pairs = near.iter().zip(pixels);
        let differences = pairs.map(|(a, b)| (Vec3::from(*a) - Vec3::from(*b)).abs());
        differences.map(|d| d.max_element()).fold(0.0, f32::max) / brightest
    };
    for parts in [[false, true], [true, false]] {
        let without = largest_difference(&draw(place(DVec3::Y, middle), parts));
        println!("without lights or shadows: {without:.3}");
        assert!(without > 0.01, "{parts:?}: {without}");
    }
    let far = middle + DVec3::new(1e7, -3e6, 2e6);
    let elsewhere = DVec3::new(-0.48, 0.6, 0.64);
    for (name, up, middle) in [
        ("origin 1e7 m away", DVec3::Y, far),
        ("another place", elsewhere, DVec3::ZERO),
        ("both", elsewhere, far),
    ] {
        let largest = largest_difference(&draw(place(up, middle), [true; 2]));
        println!("{name}: largest difference {largest:.1e} of the brightest");
        assert!(largest < 2e-3, "{name}: {largest}");
    }
}
