//! TIFF pictures.

use crate::common::{Folder, files::*, size};
use airlight::Control;
use airlight::spectrum::rgb::srgb_encode;
use airlight_image::input::{
    DepthOptions, LightReference, Orientation, Picture, SampleBits, read_picture,
    read_picture_with_depth,
};
use moxcms::{ColorProfile, ToneReprCurve};
use png::{BitDepth, ColorType};
use tiff::encoder::colortype::{
    self, CMYK8, Gray8, Gray16, Gray32Float, GrayI16, RGB8, RGB16, RGB32, RGB32Float, RGBA8,
    RGBA32Float, YCbCr8,
};
use tiff::tags::{ExtraSamples, Tag};

const SIZE: (u32, u32) = (3, 2);

fn read(bytes: &[u8]) -> Result<Picture, String> {
    let folder = Folder::new();
    let path = folder.file("a.tif");
    std::fs::write(&path, bytes).unwrap();
    read_picture(&path, None).map_err(|error| error.to_string())
}

fn of<C: colortype::ColorType>(
    values: &[C::Inner],
    extra: &[ExtraSamples],
    tags: &[(Tag, TiffTag<'_>)],
) -> Picture
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    read(&tiff_of::<C>(SIZE, values, extra, tags)).unwrap()
}

/// The same pixels in a PNG file.
fn png(color: ColorType, depth: BitDepth, bytes: &[u8]) -> Picture {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, SIZE.0, SIZE.1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(bytes).unwrap();
    writer.finish().unwrap();
    read(&file).unwrap()
}

/// Values from 0 to 255 without a pattern.
fn bytes(count: u32) -> Vec<u8> {
    (0..count).map(|n| (n * 97 + 13) as u8).collect()
}

#[test]
fn integers_are_the_picture_of_a_png() {
    let words: Vec<u16> = (0..18).map(|n: u16| n.wrapping_mul(7919)).collect();
    let big_endian =
        |words: &[u16]| -> Vec<u8> { words.iter().flat_map(|word| word.to_be_bytes()).collect() };
    let none: &[ExtraSamples] = &[];
    for (tiff, png) in [
        (
            of::<RGB8>(&bytes(18), none, &[]),
            png(ColorType::Rgb, BitDepth::Eight, &bytes(18)),
        ),
        (
            of::<Gray8>(&bytes(6), none, &[]),
            png(ColorType::Grayscale, BitDepth::Eight, &bytes(6)),
        ),
        (
            of::<RGBA8>(&bytes(24), none, &[]),
            png(ColorType::Rgba, BitDepth::Eight, &bytes(24)),
        ),
        (
            of::<Gray8>(&bytes(12), &[ExtraSamples::UnassociatedAlpha], &[]),
            png(ColorType::GrayscaleAlpha, BitDepth::Eight, &bytes(12)),
        ),
        (
            of::<RGB16>(&words, none, &[]),
            png(ColorType::Rgb, BitDepth::Sixteen, &big_endian(&words)),
        ),
        (
            of::<Gray16>(&words[..6], none, &[]),
            png(
                ColorType::Grayscale,
                BitDepth::Sixteen,
                &big_endian(&words[..6]),
            ),
        ),
    ] {
        assert_eq!(tiff, png);
    }
}

#[test]
fn profile_orientation_and_shape_of_pixels_are_used() {
    let p3 = ColorProfile::new_display_p3().encode().unwrap();
    let red: Vec<u8> = (0..6).flat_map(|_| [200, 50, 50]).collect();
    let tags = [
        (Tag::IccProfile, TiffTag::Bytes(&p3)),
        (Tag::Orientation, TiffTag::Short(6)),
        (Tag::XResolution, TiffTag::Fraction(150, 1)),
        (Tag::YResolution, TiffTag::Fraction(300, 1)),
    ];
    let picture = of::<RGB8>(&red, &[], &tags);
    let shown = picture.rgb.first_chunk::<3>().unwrap();
    let shown = shown.map(|v| (srgb_encode(v.into()) * 255.0).round() as i32);
    assert_eq!(shown, [218, 24, 40]);
    assert_eq!((picture.size, picture.pixel_aspect), (size(2, 3), 0.5));
    assert_eq!(Some(picture.orientation), Orientation::from_exif(6));
    let notes = picture.notes.to_string();
    assert!(
        notes.contains("from Display P3 to sRGB") && notes.contains("orientation 6"),
        "{notes}"
    );
}

/// Opacity that multiplies the colours, and components without a meaning.
#[test]
fn further_components_are_what_the_file_says() {
    let plain = bytes(24);
    let mut multiplied = plain.clone();
    for pixel in multiplied.as_chunks_mut::<4>().0 {
        let opacity = u32::from(pixel[3]);
        for colour in &mut pixel[..3] {
            *colour = ((u32::from(*colour) * opacity + 127) / 255) as u8;
        }
    }
    let straight = of::<RGB8>(&plain, &[ExtraSamples::UnassociatedAlpha], &[]);
    let associated = of::<RGB8>(&multiplied, &[ExtraSamples::AssociatedAlpha], &[]);
    assert_eq!(associated.alpha, straight.alpha);
    let opacities = straight.alpha.as_ref().unwrap();
    for (i, (a, b)) in associated.rgb.iter().zip(&straight.rgb).enumerate() {
        // Half a level of rounding, divided by the opacity, in encoded values.
        let [a, b] = [a, b].map(|v| srgb_encode(f64::from(*v)));
        let most = 0.51 / 255.0 / f64::from(opacities[i / 3]) + 0.51 / 255.0;
        assert!((a - b).abs() <= most, "{a} {b} {most}");
    }
    let other = of::<RGB8>(&plain, &[ExtraSamples::Unspecified], &[]);
    assert_eq!((other.alpha, other.rgb), (None, straight.rgb));
    assert!(other.notes.to_string().contains("1 other component of"));
}

#[test]
fn floats_are_linear_light() {
    let mut values: Vec<f32> = (0..24).map(|n| 0.25 * n as f32 - 1.0).collect();
    values[8] = f32::NAN;
    for (i, opacity) in [0.5, 1.0, 0.0, 0.25, 1.0, 1.0].into_iter().enumerate() {
        values[4 * i + 3] = opacity;
    }
    let picture = of::<RGBA32Float>(&values, &[], &[]);
    assert_eq!(
        (picture.reference, picture.bits),
        (LightReference::Scene, SampleBits::Float)
    );
    assert_eq!(picture.rgb[..6], [-0.5, -0.375, -0.25, 0.0, 0.25, 0.5]);
    assert_eq!(picture.alpha.unwrap(), [0.5, 1.0, 0.0, 0.25, 1.0, 1.0]);
    assert!(
        picture
            .notes
            .to_string()
            .contains("1 NaN or infinite sample repaired")
    );
    let grey = of::<Gray32Float>(&values[..6], &[], &[]);
    assert_eq!(grey.rgb[15..], [0.25; 3]);
    // By a linear profile; a curve is not linear light.
    let mut profile = ColorProfile::new_display_p3();
    let curves = |profile: &mut ColorProfile, curve: ToneReprCurve| {
        profile.red_trc = Some(curve.clone());
        profile.green_trc = Some(curve.clone());
        profile.blue_trc = Some(curve);
        profile.cicp = None;
        profile.encode().unwrap()
    };
    let light: Vec<f32> = (0..6).flat_map(|_| [2.0, 0.5, 0.1]).collect();
    let linear = curves(&mut profile, ToneReprCurve::Lut(Vec::new()));
    let tags = [(Tag::IccProfile, TiffTag::Bytes(&linear))];
    let picture = of::<RGB32Float>(&light, &[], &tags);
    // Display P3 to sRGB, as published with the CSS color specification.
    let expected = [
        1.224_94 * 2.0 - 0.224_94 * 0.5,
        -0.042_057 * 2.0 + 1.042_057 * 0.5,
        -0.019_638 * 2.0 - 0.078_636 * 0.5 + 1.098_274 * 0.1,
    ];
    for (got, expected) in picture.rgb.iter().zip(expected) {
        assert!((got - expected).abs() < 1e-3, "{got} {expected}");
    }
    let gamma = curves(&mut profile, ToneReprCurve::Parametric(vec![2.2]));
    let tags = [(Tag::IccProfile, TiffTag::Bytes(&gamma))];
    let error = read(&tiff_of::<RGB32Float>(SIZE, &light, &[], &tags)).unwrap_err();
    assert!(error.contains("floats encoded by the curve"), "{error}");
}

/// A file of strips, each a plane of its own, with one number of bits for all samples.
fn of_planes(bits: u16, planes: &[&[u8]]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    let mut directory = encoder.image_directory().unwrap();
    let count = planes.len() as u16;
    for (tag, number) in [
        (Tag::ImageWidth, SIZE.0 as u16),
        (Tag::ImageLength, SIZE.1 as u16),
        (Tag::Compression, 1),
        (
            Tag::PhotometricInterpretation,
            if count == 1 { 1 } else { 2 },
        ),
        (Tag::SamplesPerPixel, count),
        (Tag::RowsPerStrip, SIZE.1 as u16),
        (Tag::PlanarConfiguration, 2),
    ] {
        directory.write_tag(tag, number).unwrap();
    }
    let write = |plane: &&[u8]| directory.write_data(*plane).unwrap() as u32;
    let offsets: Vec<u32> = planes.iter().map(write).collect();
    let lengths: Vec<u32> = planes.iter().map(|plane| plane.len() as u32).collect();
    let bits = vec![bits; planes.len()];
    directory.write_tag(Tag::BitsPerSample, &bits[..]).unwrap();
    directory
        .write_tag(Tag::StripOffsets, &offsets[..])
        .unwrap();
    directory
        .write_tag(Tag::StripByteCounts, &lengths[..])
        .unwrap();
    directory.finish().unwrap();
    bytes.into_inner()
}

#[test]
fn other_kinds_are_refused_by_name() {
    let refused = |file: Vec<u8>| read(&file).unwrap_err();
    let many = [ExtraSamples::Unspecified; 2];
    for (error, part) in [
        (
            refused(tiff_of::<CMYK8>(SIZE, &bytes(24), &[], &[])),
            "got CMYK",
        ),
        (
            refused(tiff_of::<YCbCr8>(SIZE, &bytes(18), &[], &[])),
            "YCbCr",
        ),
        (
            refused(tiff_of::<RGB32>(SIZE, &[7; 18], &[], &[])),
            "more than 16 bits",
        ),
        (
            refused(tiff_of::<GrayI16>(SIZE, &[-7; 6], &[], &[])),
            "signed integers",
        ),
    ] {
        assert!(
            error.contains(part) && error.contains("or as PNG or EXR"),
            "{error}"
        );
    }
    let grey = of::<Gray8>(&bytes(18), &many, &[]);
    assert_eq!((grey.alpha, grey.rgb.len()), (None, 18));
    // Grey or coloured pixels of which a tag says something else.
    let palette = [0; 3 * 256];
    let [grey, coloured] = [bytes(6), bytes(18)];
    for (file, part) in [
        (
            of_planes(8, &[&[10; 6], &[20; 6], &[30; 6]]),
            "components in planes of their own",
        ),
        (
            tiff_of::<Gray8>(
                SIZE,
                &grey,
                &[],
                &[
                    (Tag::PhotometricInterpretation, TiffTag::Short(3)),
                    (Tag::ColorMap, TiffTag::Shorts(&palette)),
                ],
            ),
            "got a palette",
        ),
        (
            tiff_of::<RGB8>(
                SIZE,
                &coloured,
                &[],
                &[(Tag::PhotometricInterpretation, TiffTag::Short(8))],
            ),
            "CIE L*a*b*",
        ),
        (of_planes(4, &[&[0x12, 0x30, 0x45, 0x60]]), "got 4 bits"),
        (
            tiff_of::<RGB8>(
                SIZE,
                &coloured,
                &[],
                &[(Tag::PhotometricInterpretation, TiffTag::Short(1))],
            ),
            "got 3 bands",
        ),
    ] {
        let error = refused(file);
        assert!(
            error.contains(part) && error.contains("or as PNG or EXR"),
            "{part}: {error}"
        );
    }
    // The numbers of a picture are not its depth.
    let folder = Folder::new();
    let path = folder.file("a.tif");
    std::fs::write(&path, tiff_of::<Gray32Float>(SIZE, &[1.0; 6], &[], &[])).unwrap();
    let options = |_: &Picture| DepthOptions {
        grey_is_depth: false,
        ..DepthOptions::default()
    };
    let (_, depth) = read_picture_with_depth(&path, None, options, Control::default()).unwrap();
    let error = depth.unwrap_err().to_string();
    assert!(error.contains("a TIFF picture without depth"), "{error}");
}
