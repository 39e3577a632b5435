//! Whatever a file holds, reading it ends in a picture, a depth map or an error, never in a panic.

mod common;

use airlight_render::{
    DepthOptions, RenderError,
    input::{DepthMeaning, Unknown, read_depth, read_picture},
    tone::srgb,
};
use common::{Folder, files::*};
use exr::prelude::{Compression, FlatSamples, f16};
use png::{BitDepth, ColorType};
use std::path::Path;

/// Valid files: a name, the bytes, whether they are pictures.
fn valid_files() -> Vec<(String, Vec<u8>, bool)> {
    let mut files = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>, is_picture: bool| {
        files.push((name.to_owned(), bytes, is_picture));
    };
    let plain = |_: &mut png::Encoder<'_, &mut Vec<u8>>| {};
    let data: Vec<u8> = (0..24 * 18 * 4u32).map(|i| (i * i / 7) as u8).collect();
    let colour = png_file((24, 18), ColorType::Rgba, BitDepth::Eight, &data, plain);
    add("png", colour, true);
    let palette = png_file(
        (30, 9),
        ColorType::Indexed,
        BitDepth::Four,
        &data[..15 * 9],
        |encoder| {
            encoder.set_palette((0..48).collect::<Vec<u8>>());
            encoder.set_trns(vec![1, 2, 3]);
        },
    );
    add("palette", palette, true);
    let grey: Vec<u16> = (0..300).map(|i| 500 + i * 7).collect();
    add("grey", grey_16((20, 15), &grey), false);
    add(
        "jpeg",
        jpeg_file((40, 25), jpeg_encoder::ColorType::Rgb, false),
        true,
    );
    add(
        "progressive",
        jpeg_file((40, 25), jpeg_encoder::ColorType::Rgb, true),
        true,
    );
    add(
        "jpeg grey",
        jpeg_file((17, 9), jpeg_encoder::ColorType::Luma, true),
        true,
    );
    let mut hdr = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 12\n".to_vec();
    for _ in 0..4 {
        hdr.extend([2, 2, 0, 12]);
        for c in 0..4 {
            hdr.extend([128 + 7, c * 30 + 10, 5, 1, 2, 3, 4, 5]);
        }
    }
    add("hdr", hdr, true);
    let mut flat = b"#?RGBE\n\n-Y 5 +X 6\n".to_vec();
    for i in 0..15u8 {
        flat.extend([10 + i, 20, 30, 129, 1, 1, 1, 1]);
    }
    add("hdr flat", flat, true);
    let kinds = [
        (Compression::Uncompressed, None),
        (Compression::RLE, None),
        (Compression::ZIP1, Some(8)),
        (Compression::ZIP16, None),
        (Compression::PIZ, None),
        (Compression::PIZ, Some(16)),
        (Compression::PXR24, None),
        (Compression::B44, None),
        (Compression::B44A, Some(16)),
    ];
    for (compression, tile) in kinds {
        let (width, height) = (21, 19);
        let ramp: Vec<f32> = (0..width * height).map(|i| 1.0 + (i % 50) as f32).collect();
        let half = || FlatSamples::F16(ramp.iter().map(|&v| f16::from_f32(v)).collect());
        let part = Part {
            compression,
            tile,
            position: (-2, 3),
            ..Part::new(
                (width, height),
                vec![
                    ("R", half()),
                    ("G", half()),
                    ("B", half()),
                    ("Z", FlatSamples::F32(ramp.clone())),
                ],
            )
        };
        let name = format!("exr {compression:?} {tile:?}");
        add(&name, exr_file((0, 0, 20, 20), vec![part]), true);
    }
    let part = |name| {
        let samples = FlatSamples::U32((1..=64).collect());
        Part::new((8, 8), vec![("Z", samples)]).named(name)
    };
    let parts = exr_file((0, 0, 8, 8), vec![part("a"), part("b"), part("c")]);
    add("exr parts", parts, false);
    let floats: Vec<f32> = (1..=60).map(|i| i as f32).collect();
    let bytes: Vec<u8> = floats.iter().flat_map(|v| v.to_le_bytes()).collect();
    add("npy", npy_file(1, "'<f4'", false, "(6, 10)", &bytes), false);
    add(
        "npy 3",
        npy_file(3, "'<f2'", true, "(1, 12, 10)", &bytes),
        false,
    );
    add("pfm", pfm_file((10, 6), true, &floats), false);
    files
}

/// Reads a file both ways; the pictures and maps that come out must keep their promises.
fn read_both(path: &Path) -> [Option<RenderError>; 2] {
    let picture = read_picture(path, None).map(|picture| {
        let pixels = (picture.size.width() * picture.size.height()) as usize;
        assert_eq!(picture.rgb.len(), pixels * 3);
        assert!(picture.rgb.iter().all(|v| *v >= 0.0 && v.is_finite()));
        if let Some(alpha) = picture.alpha {
            assert_eq!(alpha.len(), pixels);
        }
    });
    let options = DepthOptions {
        unknown: Unknown::Fill,
        ..DepthOptions::default()
    };
    let depth = read_depth(path, &options).map(|map| {
        let pixels = (map.size.width() * map.size.height()) as usize;
        assert_eq!(map.metres.len(), pixels);
        assert!(map.metres.iter().all(|v| *v >= 0.0));
    });
    [picture.err(), depth.err()]
}

#[test]
fn valid_files_are_read() {
    let folder = Folder::new("robust-valid");
    let path = folder.0.join("file");
    for (name, bytes, is_picture) in valid_files() {
        std::fs::write(&path, bytes).unwrap();
        let [picture, depth] = read_both(&path);
        let error = if is_picture { picture } else { depth };
        assert!(error.is_none(), "{name}: {error:?}");
    }
}

#[test]
fn truncated_files_end_too_early() {
    let folder = Folder::new("robust-short");
    let path = folder.0.join("file");
    for (name, bytes, is_picture) in valid_files() {
        let all = bytes.len();
        // Ends of PNG and JPEG say nothing about the picture, and the last bytes of a PNG's zlib are a checksum.
        let end = match name.as_str() {
            "png" | "palette" | "grey" => 12 + 4 + 4 + 1,
            "jpeg" | "progressive" | "jpeg grey" => 1,
            _ => 1,
        };
        let mut lengths = vec![11, 12, 20, 30, all / 5, all / 3, all / 2, all * 9 / 10];
        lengths.extend([all - end - 1, all - end]);
        for length in lengths {
            std::fs::write(&path, &bytes[..length.min(all - end)]).unwrap();
            let [picture, depth] = read_both(&path);
            let error = if is_picture { picture } else { depth };
            match error {
                Some(RenderError::EndsEarly { .. }) => {}
                other => panic!("{name} cut at {length} of {all}: {other:?}"),
            }
        }
    }
}

/// Numbers without pattern, the same on every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below.max(1)
    }
}

fn corrupt_files(variants: usize, seed: u64) {
    let folder = Folder::new(&format!("robust-{seed}"));
    let path = folder.0.join("file");
    let mut numbers = Numbers(seed);
    for (name, bytes, _) in valid_files() {
        for variant in 0..variants {
            let mut bytes = bytes.clone();
            let all = bytes.len();
            // Headers, where most harm is done, are hit as often as all the rest.
            let reach = if variant % 2 == 0 { all.min(400) } else { all };
            for _ in 0..1 + numbers.next(4) {
                let at = 4 + numbers.next(reach - 4);
                match numbers.next(5) {
                    0 => bytes[at] ^= 1 << numbers.next(8),
                    1 => bytes[at] = [0, 0xff, 0x7f, 0x80, 1][numbers.next(5)],
                    2 => bytes[at] = numbers.next(256) as u8,
                    3 => {
                        let end = (at + 4).min(bytes.len());
                        bytes[at..end].fill([0, 0xff][numbers.next(2)]);
                    }
                    _ => {
                        let from = numbers.next(bytes.len());
                        let end = (at + 1 + numbers.next(12)).min(bytes.len());
                        for i in at..end {
                            bytes[i] = bytes[(from + i) % all];
                        }
                    }
                }
            }
            if numbers.next(8) == 0 {
                bytes.truncate(1 + numbers.next(all));
            }
            std::fs::write(&path, &bytes).unwrap();
            let outcome = std::panic::catch_unwind(|| read_both(&path));
            if outcome.is_err() {
                std::fs::write(std::env::temp_dir().join("airlight-panic.bin"), &bytes).unwrap();
                panic!("{name}, variant {variant}");
            }
            for error in outcome.unwrap().into_iter().flatten() {
                assert!(error.to_string().contains("file"), "{error}");
            }
        }
    }
}

#[test]
fn corrupt_files_never_panic() {
    corrupt_files(300, 42);
}

#[test]
#[ignore = "takes minutes: many more variants"]
fn corrupt_files_never_panic_at_length() {
    for seed in 1..=20 {
        corrupt_files(3000, seed * 7919);
    }
}

#[test]
fn arbitrary_bytes_after_a_magic_number() {
    let folder = Folder::new("robust-magic");
    let path = folder.0.join("file");
    let mut numbers = Numbers(7);
    let magics: [&[u8]; 7] = [
        &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0],
        b"#?RADIANCE\n\n-Y 9 +X 9\n",
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
        &[0xff, 0xd8, 0xff],
        b"\x93NUMPY\x01\0",
        b"Pf\n9 9\n-1\n",
        b"PF",
    ];
    for magic in magics {
        for _ in 0..200 {
            let mut bytes = magic.to_vec();
            bytes.extend((0..numbers.next(600)).map(|_| numbers.next(256) as u8));
            std::fs::write(&path, &bytes).unwrap();
            read_both(&path);
        }
    }
}

/// What reading costs; see the numbers with `--release -- --ignored --nocapture reading_is_fast`.
#[test]
#[ignore = "a measurement"]
fn reading_is_fast() {
    let folder = Folder::new("robust-time");
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
    let mut noise = Numbers(3);
    let shade = |i: usize, noise: usize| {
        let (x, y) = (i % width, i / width);
        (128.0 + 60.0 * (x as f64 * 0.01).sin() + 50.0 * (y as f64 * 0.013).cos()) as u8
            + noise as u8
    };
    let rgb: Vec<u8> = (0..width * height)
        .flat_map(|i| [0, 1, 2].map(|_| shade(i, noise.next(4))))
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
        .map(|i| match noise.next(20) {
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
