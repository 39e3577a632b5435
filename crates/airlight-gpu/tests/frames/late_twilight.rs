//! Frames after the end of civil twilight, against the solver.

use super::{draw, reference, renderer, rgb_of};
use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::spectrum::RgbSpace;
use airlight_gpu::headless::{Frame, Headless};

/// The luminance of the sky in frames towards the sun and away from it, with suns down to the end of astronomical twilight.
#[test]
fn skies_after_sunset_are_those_of_the_solver() {
    let gpu = Headless::new().unwrap();
    let (height_m, side) = (2.0, 32);
    for sun_deg in [-9.0, -12.0, -15.0, -18.0] {
        let sun = axes::direction(140.0, sun_deg);
        let mut renderer = renderer(&gpu, Preset::Average, sun_deg, height_m);
        renderer.update(height_m, sun).unwrap();
        let view = reference(Preset::Average, sun_deg, height_m, sun);
        let luminance = |direction| {
            let light = view.along(direction, None).radiance();
            RgbSpace::Srgb.luminance(rgb_of(view.sky().grid(), &light))
        };
        let exposure = 1.0 / luminance(axes::direction(160.0, 30.0));
        let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
        for azimuth_deg in [150.0, 310.0] {
            let frame = Frame::towards(axes::direction(azimuth_deg, 35.0).as_vec3(), side);
            let pixels = draw(&gpu, &mut renderer, &frame, exposure as f32, None);
            for (k, pixel) in pixels.iter().enumerate() {
                let (x, y) = (k as u32 % side, k as u32 / side);
                let direction = frame.direction(x, y).as_dvec3().normalize();
                if direction.y.abs() < 0.01 {
                    continue;
                }
                let got = RgbSpace::Srgb.luminance(pixel.map(f64::from)) / exposure;
                let error = got / luminance(direction) - 1.0;
                squares += error * error;
                worst = worst.max(error.abs());
                count += 1.0;
            }
        }
        let rms = f64::sqrt(squares / count);
        println!("sun {sun_deg}: rms {rms:.4}, worst {worst:.4}");
        assert!(rms < 0.005 && worst < 0.01, "sun {sun_deg}: {rms} {worst}");
    }
}
