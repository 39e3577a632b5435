//! Any file gives a picture, a depth map or an error, never a panic.

use crate::common::{Folder, files::*};
use airlight_image::{
    DepthOptions, ImageError,
    input::{UnknownDepth, read_depth, read_picture},
};
use exr::prelude::{Compression, FlatSamples, f16};
use jpeg_encoder::JpegColorType;
use png::{BitDepth, ColorType};
use std::path::Path;

/// Valid files: name, bytes, whether they are pictures.
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
        jpeg_file((40, 25), JpegColorType::Ycbcr, false, &[]),
        true,
    );
    add(
        "progressive",
        jpeg_file((40, 25), JpegColorType::Ycbcr, true, &[]),
        true,
    );
    add(
        "jpeg grey",
        jpeg_file((17, 9), JpegColorType::Luma, true, &[]),
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
    let array = npy_file(1, "'<f4'", false, "(6, 10)", &bytes);
    for deflated in [false, true] {
        let archive = npz_file(&[("depth.npy", array.clone())], deflated);
        add(&format!("npz {deflated}"), archive, false);
    }
    add("tiff", tiff_file((10, 6), &floats), false);
    let bytes: Vec<u8> = (0..180).collect();
    let colours = tiff_of::<tiff::encoder::colortype::RGB8>((10, 6), &bytes, &[], &[]);
    add("tiff rgb", colours, true);
    add("pfm", pfm_file((10, 6), true, &floats), false);
    files
}

/// Reads a file both ways; checks the documented properties of the pictures and maps.
fn read_both(path: &Path) -> [Option<ImageError>; 2] {
    let picture = read_picture(path, None).map(|picture| {
        let pixels = (picture.size.width() * picture.size.height()) as usize;
        assert_eq!(picture.rgb.len(), pixels * 3);
        assert!(picture.rgb.iter().all(|v| v.is_finite()));
        if let Some(alpha) = picture.alpha {
            assert_eq!(alpha.len(), pixels);
        }
    });
    let options = DepthOptions {
        unknown: UnknownDepth::Fill,
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
    let folder = Folder::new();
    let path = folder.file("file");
    for (name, bytes, is_picture) in valid_files() {
        std::fs::write(&path, bytes).unwrap();
        let [picture, depth] = read_both(&path);
        let error = if is_picture { picture } else { depth };
        assert!(error.is_none(), "{name}: {error:?}");
    }
}

#[test]
fn truncated_files_end_too_early() {
    let folder = Folder::new();
    let path = folder.file("file");
    for (name, bytes, is_picture) in valid_files() {
        let all = bytes.len();
        // The last chunk of a PNG is empty.
        let end = match name.as_str() {
            "png" | "palette" | "grey" => 12,
            // Only the first part is read.
            "exr parts" => all / 2,
            _ => 1,
        };
        let mut lengths = vec![11, 12, 20, 30, all / 5, all / 3, all / 2, all * 9 / 10];
        lengths.extend([all - end - 1, all - end]);
        for length in lengths {
            std::fs::write(&path, &bytes[..length.min(all - end)]).unwrap();
            let [picture, depth] = read_both(&path);
            let error = if is_picture { picture } else { depth };
            match error {
                Some(ImageError::EndsEarly { .. }) => {}
                other => panic!("{name} cut at {length} of {all}: {other:?}"),
            }
        }
    }
}

/// Pseudo-random numbers, the same on every run.
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
    let folder = Folder::new();
    let path = folder.file("file");
    let mut numbers = Numbers(seed);
    for (_, bytes, _) in valid_files() {
        for variant in 0..variants {
            let mut bytes = bytes.clone();
            let all = bytes.len();
            // Headers, the most sensitive part, are changed as often as all the rest.
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
            for error in read_both(&path).into_iter().flatten() {
                assert!(error.to_string().contains("file"), "{error}");
            }
        }
    }
}

#[test]
fn corrupt_files_never_panic() {
    corrupt_files(150, 42);
}

#[test]
#[ignore = "takes minutes: many more variants"]
fn corrupt_files_never_panic_at_length() {
    for seed in 1..=4 {
        corrupt_files(3000, seed * 7919);
    }
}

#[test]
fn arbitrary_bytes_after_a_magic_number() {
    let folder = Folder::new();
    let path = folder.file("file");
    let mut numbers = Numbers(7);
    let magics: [&[u8]; 9] = [
        b"PK\x03\x04",
        b"II*\0\x08\0\0\0",
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
