//! Random lights in random fog.

use super::draw::Draw;
use super::{Failure, light};
use airlight::fog::lights::{
    Light, LightSettings, PointLight, RgbLightSet, SphereLight, SpotLight, ViewRay,
};
use glam::DVec3;

/// Rays looked at around one set of lights.
const RAYS: usize = 20;

fn position(draw: &mut Draw) -> DVec3 {
    let scale = draw.scale(0.1, 1e3);
    draw.direction() * scale
}

fn one(draw: &mut Draw) -> Light<[f32; 3]> {
    let (place, radius_m) = (position(draw), draw.scale(1e-3, 3.0));
    match draw.below(3) {
        0 => Light::Point(PointLight::new(place, [100.0, 50.0, 10.0], radius_m).unwrap()),
        1 => Light::Sphere(SphereLight::new(place, radius_m, [100.0, 50.0, 10.0]).unwrap()),
        _ => {
            let outer = draw.between(0.05, 1.5);
            let inner = outer * draw.unit();
            let axis = draw.direction();
            let spot = SpotLight::new(place, axis, [100.0, 50.0, 10.0], inner, outer, radius_m);
            Light::Spot(spot.unwrap())
        }
    }
}

/// Light scattered from lights into rays, and their irradiance.
pub fn lights(draw: &mut Draw) -> Result<(), Failure> {
    let lights: Vec<_> = (0..=draw.below(2)).map(|_| one(draw)).collect();
    let layers = draw.layers(1);
    let ground = draw.ground();
    let settings = LightSettings::default();
    let set =
        RgbLightSet::new(lights.clone(), &layers, ground, settings).map_err(|e| e.to_string())?;
    for _ in 0..RAYS {
        let mut eye = position(draw);
        let mut direction = draw.direction();
        if draw.chance(0.2) {
            // Through the middle of a light.
            direction = (lights[0].position() - eye).normalize();
        }
        if draw.chance(0.05) {
            eye = lights[0].position();
        }
        let ray = ViewRay {
            eye,
            direction,
            length_m: match draw.chance(0.3) {
                true => f64::INFINITY,
                false => draw.length_m(),
            },
        };
        let checked = || {
            light("path radiance", &set.path_radiance(&ray))?;
            light("irradiance", &set.irradiance(0, eye))
        };
        checked().map_err(|failure: Failure| {
            format!("{failure}\n    {ray:?}, {lights:?}, {layers:?}, {ground:?}")
        })?;
    }
    Ok(())
}
