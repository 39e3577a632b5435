//! What files say about their colours and their orientation.

use crate::common::{Folder, files::*, size};
use airlight::spectrum::rgb::srgb_encode;
use airlight_image::{
    Control, DepthOptions, Picture, PictureOptions,
    input::{Orientation, read_depth, read_picture},
    output::Metadata,
    rows::StoredRows,
    tone::ToneMapper,
    write_picture,
};
use jpeg_encoder::JpegColorType;
use moxcms::{ColorProfile, ToneReprCurve};
use png::{BitDepth, ColorType, ScaledFloat, SourceChromaticities};

fn read_as(folder: &Folder, bytes: &[u8]) -> Picture {
    let path = folder.file("input.bin");
    std::fs::write(&path, bytes).unwrap();
    read_picture(&path, None).unwrap()
}

/// A picture of one colour, 200 50 50.
fn red(also: impl FnOnce(&mut png::Info<'_>)) -> Vec<u8> {
    let mut info = png::Info::with_size(1, 1);
    (info.color_type, info.bit_depth) = (ColorType::Rgb, BitDepth::Eight);
    also(&mut info);
    let mut bytes = Vec::new();
    let mut writer = png::Encoder::with_info(&mut bytes, info)
        .unwrap()
        .write_header()
        .unwrap();
    writer.write_image_data(&[200, 50, 50]).unwrap();
    writer.finish().unwrap();
    bytes
}

/// The first pixel as 8-bit sRGB.
fn shown(picture: &Picture) -> [i32; 3] {
    let pixel = picture.rgb.first_chunk::<3>().unwrap();
    pixel.map(|v| (srgb_encode(f64::from(v)) * 255.0).round() as i32)
}

fn icc(profile: &ColorProfile) -> Vec<u8> {
    red(|info| info.icc_profile = Some(profile.encode().unwrap().into()))
}

/// A chunk before the first chunk of pixels, which the encoder does not write.
fn with_chunk(png: &[u8], name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let at = png.windows(4).position(|four| four == b"IDAT").unwrap() - 4;
    let mut crc = flate2::Crc::new();
    crc.update(name);
    crc.update(data);
    let mut bytes = png[..at].to_vec();
    bytes.extend((data.len() as u32).to_be_bytes());
    bytes.extend(name);
    bytes.extend(data);
    bytes.extend(crc.sum().to_be_bytes());
    bytes.extend(&png[at..]);
    bytes
}

#[test]
fn colours_are_converted_to_srgb() {
    let folder = Folder::new();
    let straight = || Some(ToneReprCurve::Lut(Vec::new()));
    let mut linear = ColorProfile::new_srgb();
    (linear.red_trc, linear.green_trc, linear.blue_trc) = (straight(), straight(), straight());
    let adobe =
        SourceChromaticities::new((0.3127, 0.329), (0.64, 0.33), (0.21, 0.71), (0.15, 0.06));
    let plain = red(|_| {});
    let mut power = ColorProfile::new_display_p3();
    let curve = || Some(moxcms::curve_from_gamma(2.2));
    (power.red_trc, power.green_trc, power.blue_trc) = (curve(), curve(), curve());
    // Expected: matrices from the published primaries, in double precision.
    for (what, bytes, expected) in [
        ("sRGB", icc(&ColorProfile::new_srgb()), [200, 50, 50]),
        ("P3", icc(&ColorProfile::new_display_p3()), [218, 24, 40]),
        ("P3, gamma 2.2", icc(&power), [219, 14, 35]),
        (
            "cICP P3",
            with_chunk(&plain, b"cICP", &[12, 13, 0, 1]),
            [218, 24, 40],
        ),
        (
            "cICP sRGB",
            with_chunk(
                &icc(&ColorProfile::new_display_p3()),
                b"cICP",
                &[1, 13, 0, 1],
            ),
            [200, 50, 50],
        ),
        ("linear", icc(&linear), [229, 122, 122]),
        (
            "Adobe",
            red(|info| {
                info.source_chromaticities = Some(adobe);
                info.source_gamma = Some(ScaledFloat::new(1.0 / 2.2));
            }),
            [232, 46, 46],
        ),
    ] {
        let picture = read_as(&folder, &bytes);
        let near = shown(&picture)
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() <= 1);
        assert!(near, "{what}: {:?}", shown(&picture));
        assert_eq!(
            picture.notes.is_empty(),
            what.contains("sRGB"),
            "{what}: {}",
            picture.notes
        );
    }
}

#[test]
fn high_dynamic_range_is_relative_to_the_reference_white() {
    let folder = Folder::new();
    let plain = red(|_| {});
    for (points, expected) in [
        // 1347 2.28 2.28 cd/m^2 in BT.2020 over 203 cd/m^2, and hybrid log-gamma on a display of 1000 cd/m^2.
        ([9, 16, 0, 1], [11.0101, -0.8138, -0.1090]),
        ([9, 18, 0, 1], [1.5796, -0.0763, 0.0224]),
    ] {
        let picture = read_as(&folder, &with_chunk(&plain, b"cICP", &points));
        for (got, expected) in picture.rgb.iter().zip(expected) {
            assert!(
                (got - expected).abs() < 2e-3 * expected.abs().max(0.5),
                "{:?}",
                picture.rgb
            );
        }
    }
    // Unknown code points are ignored, and that is noted.
    let picture = read_as(&folder, &with_chunk(&plain, b"cICP", &[3, 16, 0, 1]));
    assert_eq!(shown(&picture), [200, 50, 50]);
    assert!(
        picture.notes.to_string().contains("unknown"),
        "{}",
        picture.notes
    );
}

#[test]
fn jpegs_are_converted_by_profile_or_exif() {
    let folder = Folder::new();
    let file = |profile: &[u8]| jpeg_file((8, 8), JpegColorType::Ycbcr, false, profile);
    let plain = read_as(&folder, &file(&[]));
    let p3 = read_as(
        &folder,
        &file(&ColorProfile::new_display_p3().encode().unwrap()),
    );
    assert!(p3.notes.to_string().contains("P3"), "{}", p3.notes);
    // The matrix from Display P3 to sRGB, from the published primaries.
    let from_p3 = [
        [1.22494, -0.22494, 0.0],
        [-0.042057, 1.042057, 0.0],
        [-0.019638, -0.078636, 1.098274],
    ];
    for (was, is) in plain.rgb.chunks(3).zip(p3.rgb.chunks(3)) {
        for (row, is) in from_p3.iter().zip(is) {
            let expected: f32 = row.iter().zip(was).map(|(a, b)| a * b).sum();
            assert!((expected - is).abs() < 1e-4, "{was:?} {is}");
        }
    }
    let broken = read_as(&folder, &file(&[7; 200]));
    assert_eq!(broken.rgb, plain.rgb);
    assert!(
        broken.notes.to_string().contains("ICC profile ignored"),
        "{}",
        broken.notes
    );
    // Interoperability index R03 in the EXIF data.
    let mut exif =
        b"Exif\0\0II*\0\x08\0\0\0\x01\0\x69\x87\x04\0\x01\0\0\0\x1a\0\0\0\0\0\0\0".to_vec();
    exif.extend(b"\x01\0\x05\xa0\x04\0\x01\0\0\0\x2c\0\0\0\0\0\0\0");
    exif.extend(b"\x01\0\x01\0\x02\0\x04\0\0\0R03\0\0\0\0\0");
    let adobe = read_as(&folder, &with_exif(&file(&[]), &exif));
    assert!(
        adobe.notes.to_string().contains("Adobe RGB"),
        "{}",
        adobe.notes
    );
}

/// A JPEG file with EXIF data.
fn with_exif(jpeg: &[u8], exif: &[u8]) -> Vec<u8> {
    let mut bytes = jpeg[..2].to_vec();
    bytes.extend([0xff, 0xe1]);
    bytes.extend((exif.len() as u16 + 2).to_be_bytes());
    bytes.extend(exif);
    bytes.extend(&jpeg[2..]);
    bytes
}

/// EXIF data with an orientation.
fn orientation(value: u8) -> Vec<u8> {
    let mut exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([value, 0, 0, 0, 0, 0, 0]);
    exif
}

#[test]
fn pictures_are_turned_upright_and_depth_with_them() {
    let folder = Folder::new();
    let jpeg = jpeg_file((16, 8), JpegColorType::Ycbcr, false, &[]);
    let stored = read_as(&folder, &jpeg);
    let at = |picture: &Picture, x: u32, y: u32| {
        let at = 3 * (y * picture.size.width() + x) as usize;
        picture.rgb[at..at + 3].to_vec()
    };
    // The stored pixel that is shown in the upper left corner, and the one beside it (EXIF 2.32, tag 274).
    for (value, corner, beside) in [
        (1, (0, 0), (1, 0)),
        (2, (15, 0), (14, 0)),
        (3, (15, 7), (14, 7)),
        (4, (0, 7), (1, 7)),
        (5, (0, 0), (0, 1)),
        (6, (0, 7), (0, 6)),
        (7, (15, 7), (15, 6)),
        (8, (15, 0), (15, 1)),
    ] {
        let upright = read_as(&folder, &with_exif(&jpeg, &orientation(value)));
        let turned = value >= 5;
        assert_eq!(upright.size, if turned { size(8, 16) } else { size(16, 8) });
        assert_eq!(
            upright.orientation,
            Orientation::from_exif(value.into()).unwrap()
        );
        assert_eq!(upright.notes.is_empty(), value == 1);
        assert_eq!(
            at(&upright, 0, 0),
            at(&stored, corner.0, corner.1),
            "{value}"
        );
        assert_eq!(
            at(&upright, 1, 0),
            at(&stored, beside.0, beside.1),
            "{value}"
        );
        // A depth map that lies as the file does is turned too; an upright one is not.
        let values: Vec<f32> = (1..=128).map(|v| v as f32).collect();
        let map = |width, height| {
            let path = folder.file("depth.pfm");
            std::fs::write(&path, pfm_file((width, height), true, &values)).unwrap();
            read_depth(&path, &DepthOptions::default())
                .unwrap()
                .turned_like(&upright)
        };
        if turned {
            let expected = (corner.1 * 16 + corner.0 + 1) as f32;
            assert_eq!(map(16, 8).metres[0], expected, "{value}");
            assert_eq!(map(8, 16).metres, values);
        } else {
            assert_eq!(map(16, 8).metres, values);
            let refused = map(8, 16).check_against(&upright).unwrap_err().to_string();
            assert_eq!(refused.contains("EXIF"), value != 1, "{refused}");
        }
    }
}

#[test]
fn pixel_shapes_are_read_and_written() {
    let folder = Folder::new();
    let plain = read_as(&folder, &red(|_| {}));
    assert_eq!(plain.pixel_aspect, 1.0);
    for ending in ["exr", "hdr", "png", "jpg"] {
        for aspect in [2.0, 0.5] {
            let path = folder.file(format!("wide.{ending}"));
            let options = PictureOptions {
                metadata: Metadata {
                    pixel_aspect: Some(aspect),
                    ..Metadata::default()
                },
                ..PictureOptions::default()
            };
            let rows = StoredRows::new(1, 3, vec![0.5; 3]).unwrap();
            let tone = ToneMapper::as_displayed();
            write_picture(
                &path,
                size(1, 1),
                &rows,
                &tone,
                &options,
                Control::default(),
            )
            .unwrap();
            let read = read_picture(&path, None).unwrap();
            assert!(
                (read.pixel_aspect - aspect).abs() < 1e-3,
                "{ending} {aspect}"
            );
        }
    }
    // Turned upright, wide pixels are high.
    let mut jpeg = jpeg_file((8, 8), JpegColorType::Ycbcr, false, &[]);
    let header = jpeg.windows(4).position(|four| four == b"JFIF").unwrap();
    jpeg[header + 8..header + 12].copy_from_slice(&[0, 1, 0, 3]);
    assert_eq!(read_as(&folder, &jpeg).pixel_aspect, 3.0);
    let turned = read_as(&folder, &with_exif(&jpeg, &orientation(6)));
    assert!((turned.pixel_aspect - 1.0 / 3.0).abs() < 1e-6);
}
