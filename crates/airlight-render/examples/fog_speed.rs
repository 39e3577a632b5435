//! Makes pictures of a megapixel with depth, for `airlight fog` to be timed on, and measures on one thread what its parts cost.
//!
//! `cargo run --release -p airlight-render --example fog_speed -- FOLDER [COUNT]` writes `FOLDER/rgb/0001.png` and `.exr` (half),
//! `FOLDER/depth/0001.png` (16 bits, millimetres) and `.exr` (float, metres), and so on to COUNT (default 1).

use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer,
};
use airlight_image::input::{DepthMap, DepthOptions, Picture, read_depth, read_picture};
use airlight_image::output::exr::{ExrOptions, SamplePrecision};
use airlight_image::output::{Metadata, PictureOptions, exr, png};
use airlight_image::rows::{RowFn, StoredRows};
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, ImageError, Intrinsics, RowSource, Size, write_picture};
use airlight_render::overlay::{Channels, FogOverlay, FogSource, Overlay, estimate_ambient};
use glam::DVec3;
use std::error::Error;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: (u32, u32) = (1250, 800);

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    let count = match arguments.next() {
        Some(count) => count.parse()?,
        None => 1,
    };
    for place in ["rgb", "depth"] {
        std::fs::create_dir_all(folder.join(place))?;
    }
    for number in 1..=count {
        make(&folder, number)?;
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| {
        measure(&folder, "png", 0.001)?;
        measure(&folder, "exr", 1.0)
    })?;
    Ok(())
}

/// A picture and its depth: a street of grainy slabs that go away from the camera under a sky.
fn make(folder: &Path, number: u32) -> Result<(), Box<dyn Error>> {
    let size = Size::new(SIZE.0, SIZE.1)?;
    let sky_rows = SIZE.1 / 4 + number % 50;
    let depth_m = |x: u32, y: u32| {
        let slab = (x / 60 + number) % 7;
        let below = f64::from(y.max(sky_rows) - sky_rows + 1) / f64::from(SIZE.1);
        (1.2 / below).min(6.0 + 9.0 * f64::from(slab))
    };
    let colours = RowFn::new(3, move |y, out: &mut [f32]| {
        let mut state = (y + 977 * number).wrapping_mul(0x9e37_79b9) | 1;
        for (x, pixel) in (0..).zip(out.chunks_exact_mut(3)) {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let grain = (state >> 20) as f32 / 4096.0;
            let shade = match y < sky_rows {
                true => 0.7 + 0.2 * y as f32 / sky_rows as f32 + 0.01 * grain,
                false => 0.1 + 0.3 * (((x / 60) * 37 + number) % 11) as f32 / 11.0 + 0.05 * grain,
            };
            pixel.copy_from_slice(&[shade, shade * 0.9, shade * 0.8]);
        }
    });
    let depth = RowFn::new(1, move |y, out: &mut [f32]| {
        for (x, z) in (0..).zip(out) {
            *z = if y < sky_rows {
                1e10
            } else {
                depth_m(x, y) as f32
            };
        }
    });
    let file = |place: &str, ending: &str| folder.join(format!("{place}/{number:04}.{ending}"));
    let (metadata, control) = (Metadata::default(), Control::default());
    let (tone, options) = (ToneMapper::as_displayed(), png::PngOptions::default());
    let path = file("rgb", "png");
    png::write(&path, size, &colours, &tone, &options, &metadata, control)?;
    let (path, options) = (file("rgb", "exr"), ExrOptions::default());
    exr::write(
        &path,
        size,
        &["R", "G", "B"],
        &colours,
        &options,
        &metadata,
        control,
    )?;
    let (path, options) = (
        file("depth", "exr"),
        ExrOptions {
            precision: SamplePrecision::Float,
            ..ExrOptions::default()
        },
    );
    exr::write(&path, size, &["Z"], &depth, &options, &metadata, control)?;
    let millimetres = |x, y| match y < sky_rows {
        true => 65535,
        false => (depth_m(x, y) * 1000.0) as u16,
    };
    let grey = image::ImageBuffer::from_fn(SIZE.0, SIZE.1, |x, y| image::Luma([millimetres(x, y)]));
    grey.save(file("depth", "png"))?;
    Ok(())
}

/// The quickest of five runs, in milliseconds a megapixel, and what came of it.
fn timed<T>(name: &str, work: impl Fn() -> T) -> T {
    let mut best = f64::INFINITY;
    let mut result = None;
    for _ in 0..5 {
        let start = Instant::now();
        result = Some(black_box(work()));
        best = best.min(start.elapsed().as_secs_f64());
    }
    let megapixels = f64::from(SIZE.0 * SIZE.1) / 1e6;
    println!("  {name:32} {:8.2} ms", best * 1e3 / megapixels);
    // It ran.
    result.expect("five runs")
}

fn measure(folder: &Path, ending: &str, scale: f64) -> Result<(), ImageError> {
    println!("{ending}, one thread, a megapixel:");
    let file = |place: &str| folder.join(format!("{place}/0001.{ending}"));
    let picture = timed("read colour", || read_picture(&file("rgb"), None))?;
    let depth_options = DepthOptions {
        scale,
        far_from_m: Some(65.0),
        ..DepthOptions::default()
    };
    let depth = timed("read depth", || read_depth(&file("depth"), &depth_options))?;
    let near = DepthMap {
        metres: depth.metres.iter().map(|z| z.min(65.0)).collect(),
        ..depth.clone()
    };
    let (ambient, _) = timed("ambient from the sky", || {
        estimate_ambient(&picture, &depth)
    });
    timed("ambient from the dark channel", || {
        estimate_ambient(&picture, &near)
    });
    let camera = Intrinsics::from_horizontal_fov(picture.size, 60.0)?;
    let mut even = None;
    for (name, profile, sun) in fogs() {
        let alone = || fog(profile.clone(), sun, ambient);
        let make = || FogOverlay::Fog(FogSource::Alone(alone()), None);
        let overlay = timed(&format!("{name}: prepare"), make);
        // Created again each time, as its table is filled on demand.
        let overlay = || Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Picture);
        let rows = timed(&format!("{name}: fog"), || {
            overlay().map(|overlay| rows(&picture, &overlay))
        })?;
        even.get_or_insert(rows);
        if !profile.is_uniform() {
            let fog = alone();
            timed(&format!("{name}: line by line"), || {
                line_by_line(&fog, &depth, &camera)
            });
        }
    }
    let overlay = FogOverlay::Encoded(0.05, ambient);
    let overlay = Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Picture)?;
    timed("foggy-cityscapes: fog", || rows(&picture, &overlay));
    let stored = StoredRows::new(SIZE.0, 3, even.unwrap_or_default())?;
    let tone = ToneMapper::as_displayed();
    let target = folder.join(format!("out.{ending}"));
    timed("write", || {
        let (options, control) = (PictureOptions::default(), Control::default());
        write_picture(&target, picture.size, &stored, &tone, &options, control)
    })?;
    Ok(())
}

fn fogs() -> [(&'static str, DensityProfile, Option<f64>); 4] {
    const HEIGHT: DensityProfile = DensityProfile::exponential(30.0);
    [
        ("uniform", DensityProfile::Uniform, None),
        ("uniform, sun", DensityProfile::Uniform, Some(30.0)),
        ("height", HEIGHT, None),
        ("height, sun", HEIGHT, Some(30.0)),
    ]
}

fn fog(profile: DensityProfile, sun_elevation_deg: Option<f64>, ambient: [f32; 3]) -> RgbFog {
    let light = FogLighting {
        sun: sun_elevation_deg.map(|elevation| DirectionalLight {
            direction: axes::direction(180.0, elevation),
            irradiance: ambient.map(|c| c * 9.0),
        }),
        ambient,
        ground_albedo: [0.2; 3],
    };
    let layers = [RgbLayer {
        density: profile,
        extinction_per_m: [extinction_per_m(80.0, Contrast::FivePercent) as f32; 3],
        single_scattering_albedo: [1.0; 3],
        phase: Droplets::Radiation.phase(),
    }];
    RgbFog::new(&layers, Ground::FLAT, &light, FogScattering::Multiple)
        .expect("a fog of sound numbers")
}

/// What it would take without a table.
fn line_by_line(fog: &RgbFog, depth: &DepthMap, camera: &Intrinsics) -> f32 {
    let width = depth.size.width() as usize;
    let mut directions = vec![DVec3::ZERO; width];
    let mut lengths = vec![0.0; width];
    let mut sum = 0.0;
    for (y, metres) in (0..).zip(depth.metres.chunks_exact(width)) {
        camera.fill(y, &mut directions, &mut lengths);
        for ((&z, direction), length) in metres.iter().zip(&directions).zip(&lengths) {
            let optics = fog.path(1.6, *direction, f64::from(z) * length);
            sum += optics.path_radiance[0] + optics.transmittance[0];
        }
    }
    sum
}

fn rows(picture: &Picture, overlay: &Overlay<'_>) -> Vec<f32> {
    let row = 3 * picture.size.width() as usize;
    let mut out = vec![0.0; picture.rgb.len()];
    for (y, out) in (0..).zip(out.chunks_exact_mut(row)) {
        overlay.fill_row(y, out);
    }
    out
}
