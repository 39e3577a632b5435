//! Pictures read from files.

use crate::common::{Folder, files::*, size};
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use airlight_image::{
    Control, ImageError, Picture,
    input::{LightReference, SampleBits, read_picture},
    output::{self, Metadata, png::PngDepth, png::PngOptions},
    rows::StoredRows,
    tone::ToneMapper,
};
use jpeg_encoder::JpegColorType;
use png::{BitDepth, ColorType};

fn read_as(folder: &Folder, bytes: &[u8], layer: Option<&str>) -> Result<Picture, ImageError> {
    let path = folder.file("input.bin");
    std::fs::write(&path, bytes).unwrap();
    read_picture(&path, layer)
}

fn decoded(v: f64) -> f32 {
    srgb_decode(v) as f32
}

#[test]
fn png_pictures_of_every_kind() {
    let folder = Folder::new();
    let read = |bytes: &[u8]| read_as(&folder, bytes, None).unwrap();
    let plain = |_: &mut png::Encoder<'_, &mut Vec<u8>>| {};

    let rgb = read(&png_file(
        (2, 2),
        ColorType::Rgb,
        BitDepth::Eight,
        &[0, 1, 2, 3, 10, 11, 12, 128, 200, 253, 254, 255],
        plain,
    ));
    assert_eq!(rgb.size, size(2, 2));
    assert_eq!(rgb.bits, SampleBits::U8);
    assert_eq!(rgb.reference, LightReference::Display);
    assert_eq!((rgb.alpha, rgb.chromaticities), (None, None));
    assert_eq!(rgb.rgb[0], 0.0);
    assert_eq!(rgb.rgb[3], decoded(3.0 / 255.0));
    assert_eq!(rgb.rgb[7], decoded(128.0 / 255.0));
    assert_eq!(rgb.rgb[11], 1.0);

    let deep = read(&png_file(
        (1, 1),
        ColorType::Rgba,
        BitDepth::Sixteen,
        &[0x12, 0x34, 0, 1, 0xff, 0xff, 0x80, 0],
        plain,
    ));
    assert_eq!(deep.bits, SampleBits::U16);
    assert_eq!(
        deep.rgb,
        [
            decoded(f64::from(0x1234) / 65535.0),
            decoded(1.0 / 65535.0),
            1.0
        ]
    );
    assert_eq!(deep.alpha, Some(vec![32768.0 / 65535.0]));

    let rgba = read(&png_file(
        (2, 1),
        ColorType::Rgba,
        BitDepth::Eight,
        &[1, 2, 3, 4, 5, 6, 7, 255],
        plain,
    ));
    assert_eq!(rgba.rgb[5], decoded(7.0 / 255.0));
    assert_eq!(rgba.alpha, Some(vec![4.0 / 255.0, 1.0]));

    let grey_alpha = read(&png_file(
        (2, 1),
        ColorType::GrayscaleAlpha,
        BitDepth::Eight,
        &[100, 0, 50, 255],
        plain,
    ));
    let (a, b) = (decoded(100.0 / 255.0), decoded(50.0 / 255.0));
    assert_eq!(grey_alpha.rgb, [a, a, a, b, b, b]);
    assert_eq!(grey_alpha.alpha, Some(vec![0.0, 1.0]));

    for (depth, most, data) in [
        (BitDepth::One, 1.0, vec![0b0100_0000u8]),
        (BitDepth::Two, 3.0, vec![0b0001_0000]),
        (BitDepth::Four, 15.0, vec![0x01]),
        (BitDepth::Eight, 255.0, vec![0, 1]),
        (BitDepth::Sixteen, 65535.0, vec![0, 0, 0, 1]),
    ] {
        let grey = read(&png_file((2, 1), ColorType::Grayscale, depth, &data, plain));
        let light = decoded(1.0 / most);
        assert_eq!(grey.rgb, [0.0, 0.0, 0.0, light, light, light], "{depth:?}");
    }

    let palette = read(&png_file(
        (3, 1),
        ColorType::Indexed,
        BitDepth::Two,
        &[0b0001_1000],
        |encoder| {
            encoder.set_palette(vec![255, 0, 0, 0, 255, 0, 0, 0, 255]);
            encoder.set_trns(vec![255, 51]);
        },
    ));
    assert_eq!(palette.rgb, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(palette.alpha, Some(vec![1.0, 0.2, 1.0]));
}

#[test]
fn a_gamma_applies_only_without_srgb_chunks() {
    let folder = Folder::new();
    let with = |gamma: f32, is_srgb: bool| {
        let (color, depth) = (ColorType::Grayscale, BitDepth::Eight);
        let bytes = png_file((1, 1), color, depth, &[64], |encoder| {
            encoder.set_source_gamma(png::ScaledFloat::new(gamma));
            if is_srgb {
                encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
            }
        });
        read_as(&folder, &bytes, None).unwrap().rgb[0]
    };
    assert_eq!(with(1.0, false), 64.0 / 255.0);
    assert!((with(0.6, false) - (64f32 / 255.0).powf(1.0 / 0.6)).abs() < 1e-6);
    let as_srgb = decoded(64.0 / 255.0);
    assert_eq!(with(0.45455, false), as_srgb);
    assert_eq!(with(1.0, true), as_srgb);
}

#[test]
fn interlaced_pngs_are_read() {
    // Adam7 of an 8 x 8 grey picture by hand: the png crate does not write it.
    let folder = Folder::new();
    let pixel = |x: usize, y: usize| (x * 16 + y * 3) as u8;
    let passes = [
        (0, 0, 8, 8),
        (4, 0, 8, 8),
        (0, 4, 4, 8),
        (2, 0, 4, 4),
        (0, 2, 2, 4),
        (1, 0, 2, 2),
        (0, 1, 1, 2),
    ];
    let mut raw = Vec::new();
    for (x0, y0, dx, dy) in passes {
        for y in (y0..8).step_by(dy) {
            raw.push(0);
            raw.extend((x0..8).step_by(dx).map(|x| pixel(x, y)));
        }
    }
    let mut packed = vec![0x78, 0x01, 1];
    packed.extend((raw.len() as u16).to_le_bytes());
    packed.extend((!(raw.len() as u16)).to_le_bytes());
    packed.extend(&raw);
    let (mut a, mut b) = (1u32, 0u32);
    for &byte in &raw {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    packed.extend((b << 16 | a).to_be_bytes());
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |name: &[u8; 4], data: &[u8]| {
        bytes.extend((data.len() as u32).to_be_bytes());
        let mut crc = !0u32;
        for &byte in name.iter().chain(data) {
            crc ^= u32::from(byte);
            for _ in 0..8 {
                crc = (crc >> 1) ^ (0xedb8_8320 * (crc & 1));
            }
        }
        bytes.extend(name);
        bytes.extend(data);
        bytes.extend((!crc).to_be_bytes());
    };
    chunk(b"IHDR", &[0, 0, 0, 8, 0, 0, 0, 8, 8, 0, 0, 0, 1]);
    chunk(b"IDAT", &packed);
    chunk(b"IEND", &[]);
    let picture = read_as(&folder, &bytes, None).unwrap();
    for y in 0..8 {
        for x in 0..8 {
            let expected = decoded(f64::from(pixel(x, y)) / 255.0);
            assert_eq!(picture.rgb[(y * 8 + x) * 3 + 1], expected, "{x} {y}");
        }
    }
}

#[test]
fn every_level_of_a_png_survives_a_round_trip() {
    let folder = Folder::new();
    for (color, each) in [(ColorType::Rgb, 3), (ColorType::Rgba, 4)] {
        for (depth, levels) in [(BitDepth::Eight, 256u32), (BitDepth::Sixteen, 65536)] {
            // Every level in every component, in a different order in each.
            let values: Vec<u16> = (0..levels)
                .flat_map(|n| [n, levels - 1 - n, (n * 7) % levels, (n * 3) % levels])
                .map(|n| n as u16)
                .collect();
            let values: Vec<u16> = values
                .chunks(4)
                .flat_map(|four| four[..each].to_vec())
                .collect();
            let data: Vec<u8> = match depth {
                BitDepth::Eight => values.iter().map(|&v| v as u8).collect(),
                _ => values.iter().flat_map(|v| v.to_be_bytes()).collect(),
            };
            let (width, height) = (256, levels / 256);
            let bytes = png_file((width, height), color, depth, &data, |_| {});
            let picture = read_as(&folder, &bytes, None).unwrap();
            let samples = match &picture.alpha {
                None => picture.rgb.clone(),
                Some(alpha) => picture
                    .rgb
                    .chunks(3)
                    .zip(alpha)
                    .flat_map(|(rgb, &alpha)| [rgb[0], rgb[1], rgb[2], alpha])
                    .collect(),
            };
            let mut out = Vec::new();
            output::png::encode(
                &mut out,
                picture.size,
                &StoredRows::new(width, each, samples).unwrap(),
                &ToneMapper::as_displayed(),
                &PngOptions {
                    depth: match picture.bits {
                        SampleBits::U8 => PngDepth::Eight,
                        _ => PngDepth::Sixteen,
                    },
                    ..PngOptions::default()
                },
                &Metadata::default(),
                Control::default(),
            )
            .unwrap();
            let decoder = png::Decoder::new(std::io::Cursor::new(&out));
            let mut reader = decoder.read_info().unwrap();
            assert_eq!(reader.output_color_type(), (color, depth));
            let mut got = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut got).unwrap();
            assert!(got == data, "{color:?} {depth:?}");
            assert_eq!(read_as(&folder, &out, None).unwrap().rgb, picture.rgb);
        }
    }
}

#[test]
fn jpegs_agree_with_another_decoder() {
    let folder = Folder::new();
    for color in [JpegColorType::Luma, JpegColorType::Ycbcr] {
        for progressive in [false, true] {
            let bytes = jpeg_file((37, 21), color, progressive, &[]);
            let picture = read_as(&folder, &bytes, None).unwrap();
            assert_eq!(picture.size, size(37, 21));
            assert_eq!(
                (picture.reference, picture.bits),
                (LightReference::Display, SampleBits::U8)
            );
            let other = image::load_from_memory(&bytes).unwrap().into_rgb8();
            let expected = other
                .as_raw()
                .iter()
                .map(|&v| decoded(f64::from(v) / 255.0));
            assert!(
                picture.rgb.iter().copied().eq(expected),
                "{color:?} {progressive}"
            );
            // The encoded colour within the loss of JPEG.
            let near = srgb_encode(f64::from(picture.rgb[0])) * 255.0;
            assert!(near < 4.0, "{near}");
        }
    }
    let cmyk = jpeg_file((16, 16), JpegColorType::Cmyk, false, &[]);
    let error = read_as(&folder, &cmyk, None).unwrap_err().to_string();
    assert!(error.contains("CMYK"), "{error}");
}

#[test]
fn hdr_headers_are_applied() {
    let folder = Folder::new();
    let file = |header: &str, pixels: &[u8]| {
        let mut bytes = format!("#?RADIANCE\n{header}\n").into_bytes();
        bytes.extend(pixels);
        bytes
    };
    let read = |bytes: &[u8]| read_as(&folder, bytes, None);
    let one = [128, 64, 32, 129];
    let plain = read(&file("FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1", &one)).unwrap();
    assert_eq!(plain.rgb, [1.0, 0.5, 0.25]);
    // Exposures multiply; their product is divided out.
    let exposed = "EXPOSURE=2\nEXPOSURE = 0.25\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1";
    assert_eq!(read(&file(exposed, &one)).unwrap().rgb, [2.0, 1.0, 0.5]);
    let xyz = read(&file("FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1", &one)).unwrap();
    // XYZ 1 0.5 0.25 under the white of equal energy, in sRGB of white D65 (Bradford).
    assert_eq!(xyz.chromaticities, None);
    for (got, expected) in xyz.rgb.iter().zip([2.19338, -0.00770, 0.24406]) {
        assert!((got - expected).abs() < 1e-4, "{:?}", xyz.rgb);
    }
    // Runs of the old encoding: 1 pixel, then 3 + 256 * 1 more.
    let mut old = one.to_vec();
    old.extend([1, 1, 1, 3, 1, 1, 1, 1]);
    let runs = read(&file("\n-Y 1 +X 260", &old)).unwrap();
    assert_eq!(runs.rgb.len(), 780);
    assert_eq!(runs.rgb[777..], [1.0, 0.5, 0.25]);
    // Rows narrower than 8 pixels are never run-length encoded, whatever their first bytes.
    let mut narrow = vec![2, 2, 10, 130];
    narrow.extend([4, 208, 233, 130].repeat(3));
    let plain = read(&file("\n-Y 1 +X 4", &narrow)).unwrap();
    assert_eq!(plain.rgb[..3], [2.0 / 64.0, 2.0 / 64.0, 10.0 / 64.0]);
    for (header, said) in [
        ("FORMAT=16-bit\n\n-Y 1 +X 1", "32-bit_rle_rgbe"),
        ("\n+Y 1 +X 1", "-Y HEIGHT +X WIDTH"),
        ("\n-Y 0 +X 1", "0 pixels"),
        ("\n-Y 1 +X 70000", "65536"),
        ("\n-Y 65536 +X 65536", "1073741824"),
        ("\n-Y 1 +X 9999999999999999999999", "-Y HEIGHT +X WIDTH"),
    ] {
        let error = read(&file(header, &one)).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn unreadable_files_are_refused_with_a_reason() {
    let folder = Folder::new();
    let refused = |bytes: &[u8]| read_as(&folder, bytes, None).unwrap_err();
    let missing = read_picture(&folder.file("nothing.png"), None).unwrap_err();
    assert!(matches!(missing, ImageError::File { action: "read", .. }));
    assert!(missing.to_string().contains("nothing.png"), "{missing}");
    assert!(read_picture(&folder.file(""), None).is_err());
    let empty = refused(&[]);
    assert!(matches!(empty, ImageError::EndsEarly { .. }));
    assert!(
        empty.to_string().contains("ends too early: it is empty"),
        "{empty}"
    );
    for bytes in [&b"hello"[..], b"GIF89a", b"\x89PN", b"v"] {
        let error = refused(bytes).to_string();
        assert!(
            error.contains("OpenEXR, Radiance HDR, PNG, JPEG"),
            "{error}"
        );
    }
    let error = refused(b"Pf\n1 1\n-1\n0000").to_string();
    assert!(error.contains("expected a picture"), "{error}");
    let png = grey_16((1, 1), &[5]);
    let error = read_as(&folder, &png, Some("beauty"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("only EXR files have layers"), "{error}");
    // A PNG header with a size out of range; its checksum follows.
    let mut large = png.clone();
    large[16..20].copy_from_slice(&100_000u32.to_be_bytes());
    let mut crc = !0u32;
    for &byte in &large[12..29] {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xedb8_8320 * (crc & 1));
        }
    }
    large[29..33].copy_from_slice(&(!crc).to_be_bytes());
    let error = refused(&large).to_string();
    assert!(
        error.contains("100000 x 1") && error.contains("65536"),
        "{error}"
    );
}
