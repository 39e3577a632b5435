//! What reading costs: `cargo test --release -p airlight-render --test read_speed -- --ignored --nocapture`.

mod common;

use airlight_image::{
    DepthOptions,
    input::{DepthMeaning, read_depth, read_picture},
    tone::srgb,
};
use common::{Folder, files::*};
use exr::prelude::{Compression, FlatSamples, f16};
use png::{BitDepth, ColorType};

#[test]
#[ignore = "a measurement"]
fn reading_is_fast() {
    let folder = Folder::new("read-time");
    let path = folder.0.join("file");
    let (width, height) = (4000usize, 2500usize);
    let timed = |name: &str, bytes: &[u8], work: &dyn Fn()| {
        std::fs::write(&path, bytes).unwrap();
        work();
        let best = (0..5)
            .map(|_| {
                let start = std::time::Instant::now();
                work();
                start.elapsed()
            })
            .min()
            .unwrap();
        println!(
            "{name}: {:.2} ms a megapixel",
            best.as_secs_f64() * 1e3 / 10.0
        );
    };
    let mut state = 3u32;
    let mut noise = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((state >> 16) % below) as u8
    };
    let shade = |i: usize, noise: u8| {
        let (x, y) = (i % width, i / width);
        (128.0 + 60.0 * (x as f64 * 0.01).sin() + 50.0 * (y as f64 * 0.013).cos()) as u8 + noise
    };
    let rgb: Vec<u8> = (0..width * height)
        .flat_map(|i| [0, 1, 2].map(|_| shade(i, noise(4))))
        .collect();
    let size = (width as u32, height as u32);
    let fast = |encoder: &mut png::Encoder<'_, &mut Vec<u8>>| {
        encoder.set_compression(png::Compression::Balanced);
    };
    let decode_alone = || {
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut row = vec![0; reader.output_line_size(size.0).unwrap()];
        while reader.read_row(&mut row).unwrap().is_some() {}
    };
    let picture = || drop(read_picture(&path, None).unwrap());
    let eight = png_file(size, ColorType::Rgb, BitDepth::Eight, &rgb, fast);
    timed("12 bytes a pixel written once", &[], &|| {
        let mut memory = Vec::with_capacity(width * height * 3);
        memory.extend(rgb.iter().map(|&v| f32::from(v)));
        std::hint::black_box(&memory);
    });
    timed("PNG 8 bits, decoder alone", &eight, &decode_alone);
    timed("PNG 8 bits", &eight, &picture);
    let wide: Vec<u8> = rgb.iter().flat_map(|&v| [v, v]).collect();
    let sixteen = png_file(size, ColorType::Rgb, BitDepth::Sixteen, &wide, fast);
    timed("PNG 16 bits, decoder alone", &sixteen, &decode_alone);
    timed("PNG 16 bits", &sixteen, &picture);
    let mut jpeg = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut jpeg, 90);
    let color = jpeg_encoder::ColorType::Rgb;
    encoder.encode(&rgb, 4000, 2500, color).unwrap();
    timed("JPEG", &jpeg, &picture);
    let plane = |c: usize| -> Vec<f16> {
        let linear = |v: u8| f16::from_f64(srgb::decode(f64::from(v) / 255.0));
        rgb.iter().skip(c).step_by(3).map(|&v| linear(v)).collect()
    };
    for compression in [
        Compression::ZIP16,
        Compression::PIZ,
        Compression::Uncompressed,
    ] {
        let channels = ["R", "G", "B"]
            .into_iter()
            .enumerate()
            .map(|(c, name)| (name, FlatSamples::F16(plane(c))))
            .collect();
        let part = Part {
            compression,
            ..Part::new((width, height), channels)
        };
        let bytes = exr_file((0, 0, width, height), vec![part]);
        timed(&format!("EXR half {compression:?}"), &bytes, &picture);
    }
    let holes: Vec<u16> = (0..width * height)
        .map(|i| match noise(20) {
            0 => 0,
            _ => 2000 + u16::from(shade(i, 0)) * 10,
        })
        .collect();
    let millimetres = DepthOptions {
        scale: 0.001,
        ..DepthOptions::default()
    };
    timed("depth PNG, filled", &grey_16(size, &holes), &|| {
        drop(read_depth(&path, &millimetres).unwrap());
    });
    let floats: Vec<f32> = holes.iter().map(|&v| f32::from(v)).collect();
    let stereo = DepthOptions {
        meaning: DepthMeaning::Disparity {
            focal_length_px: 1000.0,
            baseline_m: 0.2,
            offset_px: 0.0,
        },
        ..millimetres.clone()
    };
    let pfm = pfm_file((width, height), true, &floats);
    timed("disparity PFM, filled", &pfm, &|| {
        drop(read_depth(&path, &stereo).unwrap());
    });
}
