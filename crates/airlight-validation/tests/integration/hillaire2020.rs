//! Hillaire 2020 on a graphics device against the same model on the processor, which marches each ray. Run with `--nocapture` for the
//! differences.

use airlight::atmosphere::{Atmosphere, Preset};
use airlight::axes;
use airlight::glam::{DVec3, Vec3};
use airlight::models::hillaire2020::Hillaire2020;
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Camera, Projection};
use airlight_shaders::Counts;
use airlight_validation::frames::hillaire2020::{HillairePasses, HillairePassesError};

/// Suns, degrees.
const SUNS_DEG: [f64; 3] = [60.0, 5.0, 0.0];
/// Eyes, m.
const EYES_M: [f64; 2] = [2.0, 10_000.0];
/// Pixels on a side of a frame: a froxel each.
const SIDE: u32 = 32;
/// Light per unit of sunlight below which a pixel counts as black: half floats do not resolve it.
const DARK: f64 = 1e-5;

/// The model on the device and on the processor.
struct Pair {
    device: Headless,
    passes: HillairePasses,
    air: Atmosphere,
    grid: WavelengthGrid,
    ground_m: f64,
    /// Red, green and blue of sunlight outside the air, lx.
    sunlight: [f64; 3],
}

impl Pair {
    fn new() -> Self {
        let device = Headless::new().unwrap();
        let air = Preset::Hillaire.atmosphere();
        let all = WavelengthGrid::standard().with_solar(&air.solar_irradiance);
        let solar: Vec<f32> = all.solar_irradiance().iter().map(|&e| e as f32).collect();
        Self {
            passes: HillairePasses::new(&device.device, &device.queue, &air, FORMAT).unwrap(),
            grid: WavelengthGrid::rgb().with_solar(&air.solar_irradiance),
            ground_m: air.planet.radius_m,
            sunlight: RgbSpace::Srgb.from_xyz(all.to_xyz(&solar)),
            air,
            device,
        }
    }

    fn model(&self, height_m: f64, sun: DVec3) -> Hillaire2020 {
        Hillaire2020::new(&self.air, &self.grid, height_m, sun).unwrap()
    }

    /// Light at the wavelengths of the grid as red, green and blue per unit of sunlight in each, as real-time programs take it.
    fn rgb(&self, light: &[f32]) -> [f64; 3] {
        let solar = self.grid.solar_irradiance();
        // Wavelengths are in order: the last is red.
        std::array::from_fn(|c| f64::from(light[2 - c]) / solar[2 - c])
    }

    /// Pixels of a frame, per unit of sunlight in red, green and blue. Light of green is drawn as 1.
    fn draw(
        &self,
        frame: &Frame,
        (height_m, sun): (f64, DVec3),
        walls: Option<&Geometry<'_>>,
    ) -> Vec<[f64; 3]> {
        let green = self.sunlight[1];
        let camera = frame.camera((1.0 / green) as f32).unwrap();
        self.passes.set_view(height_m, sun, &camera).unwrap();
        let pixels = self.device.draw(frame, walls, |encoder, target, depth| {
            self.passes.record_tables(encoder);
            self.passes.record(encoder, target, depth);
        });
        let relative = |pixel: [f32; 3]| {
            std::array::from_fn(|c| f64::from(pixel[c]) * green / self.sunlight[c])
        };
        pixels.unwrap().into_iter().map(relative).collect()
    }
}

/// Relative errors of light, none of which counts as darker than [`DARK`].
fn errors_of(light: [f64; 3], right: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| light[c].max(DARK) / right[c].max(DARK) - 1.0)
}

/// Root mean square and largest.
fn statistics(errors: &[f64]) -> (f64, f64) {
    let squares: f64 = errors.iter().map(|e| e * e).sum();
    let largest = errors.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    ((squares / errors.len() as f64).sqrt(), largest)
}

#[test]
fn the_sky_of_hillaire_on_a_device_is_that_of_the_processor() {
    let pair = Pair::new();
    for height_m in EYES_M {
        let horizon = -(pair.ground_m / (pair.ground_m + height_m)).acos();
        for sun_deg in SUNS_DEG {
            let sun = axes::direction(140.0, sun_deg);
            let model = pair.model(height_m, sun);
            let mut errors = Vec::new();
            for (azimuth, elevation) in [(140.0, 0.0), (250.0, 20.0), (320.0, -30.0)] {
                let frame = Frame::towards(axes::direction(azimuth, elevation).as_vec3(), SIDE);
                let pixels = pair.draw(&frame, (height_m, sun), None);
                for (index, pixel) in pixels.iter().enumerate().step_by(11) {
                    let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
                    let direction = frame.direction(x, y).as_dvec3().normalize();
                    // The table blurs the horizon, and the disc is drawn over it.
                    let beside_horizon = (direction.y.asin() - horizon).abs() > 0.01;
                    if beside_horizon && direction.angle_between(sun) > 0.06 {
                        errors.extend(errors_of(*pixel, pair.rgb(&model.radiance(direction))));
                    }
                }
            }
            let (rms, worst) = statistics(&errors);
            println!("eye {height_m} m, sun {sun_deg}: sky rms {rms:.4}, worst {worst:.4}");
            assert!(errors.len() > 500 && rms < 0.002 && worst < 0.02);
        }
    }
}

/// Light and transmittance of the air in front of walls at a distance, rms and worst.
fn errors_of_air(
    pair: &Pair,
    (height_m, sun): (f64, DVec3),
    distance_m: &dyn Fn(u32, u32) -> f32,
) -> [(f64, f64); 2] {
    let model = pair.model(height_m, sun);
    let frame = Frame::towards(axes::direction(200.0, 0.0).as_vec3(), SIDE);
    let [black, white] = [0.0, 1.0].map(|grey| {
        let walls = Geometry {
            colour: [grey; 3],
            distance_m,
        };
        pair.draw(&frame, (height_m, sun), Some(&walls))
    });
    let (mut light, mut transmittance) = (Vec::new(), Vec::new());
    for index in (0..black.len()).step_by(7) {
        let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
        let direction = frame.direction(x, y).as_dvec3().normalize();
        let line = model.along(direction, Some(f64::from(distance_m(x, y))));
        if line.meets_ground {
            continue;
        }
        let scattered = line.single.iter().zip(&line.multiple).map(|(a, b)| a + b);
        let right = pair.rgb(&scattered.collect::<Vec<_>>());
        light.extend(errors_of(black[index], right));
        let mean = line.transmittance.iter().sum::<f32>() / 3.0;
        let through = white[index][1] - black[index][1];
        transmittance.push(through - f64::from(mean));
    }
    assert!(transmittance.len() > 50);
    [light, transmittance].map(|errors| statistics(&errors))
}

#[test]
fn the_air_of_hillaire_on_a_device_is_that_of_the_processor() {
    let pair = Pair::new();
    // The slice that has as many steps as a ray of the processor.
    let slice_m = |_: u32, _: u32| 128e3 * (14.5f32 / 32.0).powi(2);
    let anywhere_m = |x: u32, y: u32| 500.0 * 200f32.powf(((3 * x + 7 * y) % 101) as f32 / 100.0);
    for height_m in EYES_M {
        for sun_deg in SUNS_DEG {
            let at = (height_m, axes::direction(140.0, sun_deg));
            let [light, transmittance] = errors_of_air(&pair, at, &slice_m);
            let blurred = errors_of_air(&pair, at, &anywhere_m);
            println!(
                "eye {height_m} m, sun {sun_deg}: light {light:.4?}, transmittance {transmittance:.4?}; between slices {blurred:.4?}"
            );
            assert!(light.1 < 0.004 && transmittance.1 < 0.002);
            // What the published volume loses between its slices, of which the first end at 31, 281 and 781 m.
            assert!(blurred[0].0 < 0.03 && blurred[1].0 < 0.002);
        }
    }
}

#[test]
fn what_hillaire_cannot_draw_is_refused() {
    let Headless { device, queue, .. } = Headless::new().unwrap();
    let passes = |air: Preset| HillairePasses::new(&device, &queue, &air.atmosphere(), FORMAT);
    let refused = passes(Preset::Clear).unwrap_err();
    assert!(matches!(refused, HillairePassesError::Air(_)), "{refused}");
    let passes = passes(Preset::Hillaire).unwrap();
    let camera = Frame::towards(Vec3::X, SIDE).camera(1.0).unwrap();
    let sun = axes::direction(140.0, 30.0);
    for height_m in [-1.0, 100e3, f64::NAN] {
        let refused = passes.set_view(height_m, sun, &camera).unwrap_err();
        assert!(
            matches!(refused, HillairePassesError::Eye { .. }),
            "{refused}"
        );
    }
    let refused = passes.set_view(2.0, DVec3::ZERO, &camera).unwrap_err();
    assert_eq!(refused, HillairePassesError::Sun(DVec3::ZERO));
    let around = Projection::Equirectangular {
        center_azimuth_deg: 0.0,
    };
    let around = Camera::new(around, 1.0).unwrap();
    let refused = passes.set_view(2.0, sun, &around).unwrap_err();
    assert_eq!(refused, HillairePassesError::Projection);
}

/// Counts of each pass of a frame whose lower half are walls, as the book states them, for the sizes of the paper.
#[test]
fn hillaire_evaluates_what_the_book_states() {
    let gpu = Headless::new().unwrap();
    let (device, queue) = (&gpu.device, &gpu.queue);
    let counts = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: Counts::BYTES,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let read = || {
        let bytes = gpu.read_buffer(&counts).unwrap();
        Counts::from_bytes(bytes.try_into().unwrap())
    };
    let air = Preset::Hillaire.atmosphere();
    let passes = HillairePasses::counting(device, queue, &air, FORMAT, &counts).unwrap();
    let side = 1024;
    let frame = Frame::towards(axes::direction(140.0, 0.0).as_vec3(), side);
    let walls = Geometry {
        colour: [1.0; 3],
        distance_m: &|_, y| if y < side / 2 { f32::INFINITY } else { 5e3 },
    };
    let sun = axes::direction(140.0, 5.0);
    passes
        .set_view(2.0, sun, &frame.camera(1.0).unwrap())
        .unwrap();
    let of = |record: &dyn Fn(&mut wgpu::CommandEncoder)| {
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&counts, 0, None);
        record(&mut encoder);
        queue.submit([encoder.finish()]);
        read()
    };
    let air = of(&|encoder| {
        passes.record_transmittance(encoder);
        passes.record_multiple_scattering(encoder);
    });
    let sky = of(&|encoder| passes.record_sky_view(encoder));
    let aerial = of(&|encoder| passes.record_aerial_perspective(encoder));
    gpu.draw(&frame, Some(&walls), |encoder, target, depth| {
        encoder.clear_buffer(&counts, 0, None);
        passes.record(encoder, target, depth);
    })
    .unwrap();
    let last = read();
    let places = [sky.calls, aerial.calls].map(u64::from);
    assert_eq!(HillairePasses::medium_evaluations(), places);
    assert_eq!(places, [600_000, 1_081_344]);
    let book = include_str!("../../../../docs/src/gpu.md");
    let pixels = 1920.0 * 1080.0 / f64::from(side * side);
    for (name, counts, share) in [
        ("last pass", last, pixels),
        ("aerial perspective", aerial, 1.0),
        ("sky-view", sky, 1.0),
        ("tables of the air", air, 1.0),
    ] {
        let [exp, reads] = [counts.exp, counts.reads].map(|n| 1e-6 * share * f64::from(n));
        let row = format!("| Hillaire 2020, {name} | {exp:.1} | {reads:.1} |");
        println!("{row}");
        assert!(book.contains(&row), "{row}");
    }
}
