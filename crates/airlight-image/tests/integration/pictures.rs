//! Pictures read back by decoders that share no code with the writers.

use crate::common::{Folder, full_metadata, sample, size, sky, tone};
use airlight::spectrum::{RgbSpace, rgb::srgb_decode};
use airlight_image::{
    Control,
    output::{
        Metadata,
        exr::{self, ExrCompression, ExrOptions, SamplePrecision},
        hdr,
        jpeg::{self, JpegOptions},
        png::{self, PngDepth, PngOptions},
        spectral::{self, SpectralLayout},
    },
    rows::{RowFn, RowSource, StoredRows},
    tone::ToneMapper,
};
use image::ImageDecoder;
use std::io::Cursor;

/// The first layer of an EXR file.
fn read_back(
    bytes: Cursor<Vec<u8>>,
) -> ::exr::image::Image<::exr::image::Layer<::exr::image::AnyChannels<::exr::image::FlatSamples>>>
{
    use ::exr::prelude::*;
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes.into_inner()))
        .unwrap()
}

#[test]
fn exr_files_are_decoded_to_the_given_samples() {
    use ::exr::prelude::*;
    for (width, height) in [(1, 1), (37, 50), (130, 33)] {
        for sample_kind in [SamplePrecision::Half, SamplePrecision::Float] {
            for compression in [
                ExrCompression::None,
                ExrCompression::Rle,
                ExrCompression::Zips,
                ExrCompression::Zip,
                ExrCompression::Piz,
            ] {
                let size = size(width, height);
                let options = ExrOptions {
                    precision: sample_kind,
                    compression,
                };
                let mut bytes = Cursor::new(Vec::new());
                exr::encode(
                    &mut bytes,
                    size,
                    &["R", "G", "B", "depth"],
                    &sky(size, 4),
                    &options,
                    &full_metadata(),
                    Control::default(),
                )
                .unwrap();
                let image = read_back(bytes);
                let layer = &image.layer_data;
                assert_eq!(layer.size, Vec2(width as usize, height as usize));
                for (c, name) in ["R", "G", "B", "depth"].into_iter().enumerate() {
                    let channel = layer
                        .channel_data
                        .list
                        .iter()
                        .find(|channel| channel.name.eq(name))
                        .unwrap();
                    for (i, got) in channel.sample_data.values_as_f32().enumerate() {
                        let want = sample(size, i as u32 % width, i as u32 / width, c);
                        let tolerance = match sample_kind {
                            SamplePrecision::Half => want * 5e-4,
                            _ => 0.0,
                        };
                        assert!((got - want).abs() <= tolerance, "{name} {i}: {got} {want}");
                    }
                }
            }
        }
    }
}

#[test]
fn exr_files_have_the_standard_attributes() {
    use ::exr::meta::attribute::*;
    let size = size(8, 4);
    let mut bytes = Cursor::new(Vec::new());
    exr::encode(
        &mut bytes,
        size,
        &["R", "G", "B"],
        &sky(size, 3),
        &ExrOptions::default(),
        &full_metadata(),
        Control::default(),
    )
    .unwrap();
    let image = read_back(bytes);
    let own = &image.layer_data.attributes;
    assert_eq!(own.utc_offset, Some(-7200.0));
    assert_eq!(own.latitude, Some(52.5));
    assert_eq!(own.longitude, Some(13.4));
    assert_eq!(own.altitude, Some(34.0));
    assert_eq!(own.white_luminance, Some(1.0));
    assert_eq!(own.adopted_neutral, None);
    // Its layout has samples on the poles and the seam, not pixels between them.
    assert_eq!(own.environment_map, None);
    let text = |text: &Option<Text>| String::from_utf8(text.as_ref().unwrap().bytes().into());
    assert_eq!(text(&own.software_name).unwrap(), "airlight test");
    assert_eq!(text(&own.owner).unwrap(), "Zażółć");
    assert_eq!(text(&own.capture_date).unwrap(), "2024:06:21 14:00:00");
    assert_eq!(image.attributes.chromaticities.unwrap().red.x(), 0.64);
    let named = |name: &str| match own.other.get(&Text::new_or_panic(name)) {
        Some(AttributeValue::Text(text)) => String::from_utf8(text.bytes().into()).unwrap(),
        other => panic!("{name}: {other:?}"),
    };
    assert_eq!(named("units"), "cd/m^2");
    assert_eq!(named("place"), "Łódź");
    assert_eq!(named("airlight:channels"), "not really");
    assert!(named("projection").contains("equirectangular"));
}

#[test]
fn exr_files_of_unadapted_colours_adopt_d65_as_neutral() {
    let size = size(8, 4);
    let mut bytes = Cursor::new(Vec::new());
    let metadata = Metadata {
        chromaticities: Some(RgbSpace::AcesCgUnadapted.into()),
        ..Metadata::default()
    };
    exr::encode(
        &mut bytes,
        size,
        &["R", "G", "B"],
        &sky(size, 3),
        &ExrOptions::default(),
        &metadata,
        Control::default(),
    )
    .unwrap();
    let image = read_back(bytes);
    let neutral = image.layer_data.attributes.adopted_neutral;
    assert_eq!(neutral, Some(::exr::math::Vec2(0.3127, 0.329)));
    let white = image.attributes.chromaticities.unwrap().white;
    assert_eq!(white, ::exr::math::Vec2(0.32168, 0.33767));
}

#[test]
fn spectral_files_follow_the_layout() {
    use ::exr::meta::attribute::*;
    let folder = Folder::new();
    let path = folder.file("sky.exr");
    let layout = SpectralLayout::new(&[380.0, 550.0, 1000.25]).unwrap();
    let size = size(20, 10);
    let options = ExrOptions {
        precision: SamplePrecision::Float,
        ..ExrOptions::default()
    };
    spectral::write(
        &path,
        size,
        &layout,
        &sky(size, 6),
        &options,
        &Metadata::default(),
        Control::default(),
    )
    .unwrap();
    let image = read_back(Cursor::new(std::fs::read(&path).unwrap()));
    let channels = &image.layer_data.channel_data.list;
    let names: Vec<String> = channels
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    assert_eq!(
        names,
        [
            "B",
            "G",
            "R",
            "S0.1000,250000nm",
            "S0.380,000000nm",
            "S0.550,000000nm"
        ]
    );
    for (name, value) in [
        ("spectralLayoutVersion", "1.0"),
        ("emissiveUnits", "W.m^-2.sr^-1"),
    ] {
        let attribute = &image.layer_data.attributes.other[&Text::new_or_panic(name)];
        assert_eq!(*attribute, AttributeValue::Text(Text::new_or_panic(value)));
    }
    let got: Vec<f32> = channels[5].sample_data.values_as_f32().collect();
    assert_eq!(got[47], sample(size, 7, 2, 4));
    assert!(SpectralLayout::new(&[]).is_err());
    assert!(SpectralLayout::new(&[500.0, 500.0]).is_err());
    assert!(SpectralLayout::new(&[f64::NAN]).is_err());
}

#[test]
fn clamped_samples_are_counted() {
    let half = ExrOptions {
        precision: SamplePrecision::Half,
        ..ExrOptions::default()
    };
    let odd = vec![1e6, f32::NAN, -2.0, f32::INFINITY, 3.0, f32::NEG_INFINITY];
    let rows = StoredRows::new(2, 3, odd).unwrap();
    let mut bytes = Cursor::new(Vec::new());
    let written = exr::encode(
        &mut bytes,
        size(2, 1),
        &["R", "G", "B"],
        &rows,
        &half,
        &Metadata::default(),
        Control::default(),
    )
    .unwrap();
    assert_eq!((written.clamped_samples, written.nan_samples), (3, 1));
    let mut bytes = Vec::new();
    let written = hdr::encode(
        &mut bytes,
        size(2, 1),
        &rows,
        &Metadata::default(),
        Control::default(),
    )
    .unwrap();
    assert_eq!((written.clamped_samples, written.nan_samples), (3, 1));
}

#[test]
fn single_precision_exr_stores_infinity() {
    let odd = vec![1e6, f32::INFINITY, f32::NEG_INFINITY, f32::MAX];
    let rows = StoredRows::new(2, 2, odd.clone()).unwrap();
    let mut bytes = Cursor::new(Vec::new());
    let options = ExrOptions {
        precision: SamplePrecision::Float,
        ..ExrOptions::default()
    };
    let written = exr::encode(
        &mut bytes,
        size(2, 1),
        &["Y", "Z"],
        &rows,
        &options,
        &Metadata::default(),
        Control::default(),
    )
    .unwrap();
    assert_eq!((written.clamped_samples, written.nan_samples), (0, 0));
    let image = read_back(bytes);
    let values = image
        .layer_data
        .channel_data
        .list
        .iter()
        .map(|channel| channel.sample_data.values_as_f32().collect::<Vec<_>>());
    assert_eq!(
        values.collect::<Vec<_>>(),
        [[odd[0], odd[2]], [odd[1], odd[3]]]
    );
}

#[test]
fn hdr_files_are_decoded_to_the_given_samples() {
    for (width, height) in [(1, 1), (7, 3), (8, 2), (300, 40), (33_000, 2)] {
        let size = size(width, height);
        // Steps give runs; a wide range covers the exponents.
        let source = RowFn::new(3, move |y, out: &mut [f32]| {
            for (x, pixel) in out.chunks_mut(3).enumerate() {
                let base = 2f32.powi((x / 20 % 60) as i32 - 30);
                pixel[0] = base * (1.0 + y as f32 * 0.01);
                pixel[1] = base * 0.3;
                pixel[2] = sample(size, x as u32, y, 0);
            }
        });
        let mut bytes = Vec::new();
        hdr::encode(
            &mut bytes,
            size,
            &source,
            &full_metadata(),
            Control::default(),
        )
        .unwrap();
        let decoder = image::codecs::hdr::HdrDecoder::new(Cursor::new(bytes)).unwrap();
        assert_eq!(decoder.dimensions(), (width, height));
        let mut raw = vec![0; decoder.total_bytes() as usize];
        decoder.read_image(&mut raw).unwrap();
        let got: Vec<f32> = raw
            .chunks(4)
            .map(|b| f32::from_ne_bytes(b.try_into().unwrap()))
            .collect();
        let mut row = vec![0.0; width as usize * 3];
        for y in 0..height {
            source.fill_row(y, &mut row);
            let start = y as usize * row.len();
            for (x, want) in row.chunks(3).enumerate() {
                let most = want.iter().copied().fold(0.0, f32::max);
                for c in 0..3 {
                    let got = got[start + x * 3 + c];
                    assert!((got - want[c]).abs() <= most * 0.004, "{got} {}", want[c]);
                }
            }
        }
    }
}

#[test]
fn png_files_are_decoded_to_the_given_samples() {
    let tone = tone();
    // One band and several; those of the widest picture have fewer rows than the limit.
    for (width, height) in [(1, 1), (5, 3), (64, 700), (1500, 300)] {
        for depth in [PngDepth::Eight, PngDepth::Sixteen] {
            for compression_level in [0, 1, 4, 9] {
                if compression_level == 9 && width == 1500 {
                    continue;
                }
                let size = size(width, height);
                let source = sky(size, 3);
                let options = PngOptions {
                    depth,
                    compression_level,
                };
                let mut bytes = Vec::new();
                png::encode(
                    &mut bytes,
                    size,
                    &source,
                    &tone,
                    &options,
                    &full_metadata(),
                    Control::default(),
                )
                .unwrap();
                let mut strict = ::png::Decoder::new(Cursor::new(&bytes));
                strict.ignore_checksums(false);
                let mut strict = strict.read_info().unwrap();
                let mut pixels = vec![0; strict.output_buffer_size().unwrap()];
                strict.next_frame(&mut pixels).unwrap();
                strict.finish().unwrap();
                let image = image::load_from_memory(&bytes).unwrap();
                assert_eq!((image.width(), image.height()), (width, height));
                let mut linear = vec![0.0; width as usize * 3];
                let mut want = vec![0u8; linear.len()];
                let mut wide = vec![0u16; linear.len()];
                for y in 0..height {
                    source.fill_row(y, &mut linear);
                    let row = y as usize * linear.len()..(y as usize + 1) * linear.len();
                    match depth {
                        PngDepth::Eight => {
                            tone.row_to_u8(y, &linear, &mut want);
                            assert_eq!(&image.as_rgb8().unwrap().as_raw()[row], want);
                        }
                        PngDepth::Sixteen => {
                            tone.row_to_u16(&linear, &mut wide);
                            assert_eq!(&image.as_rgb16().unwrap().as_raw()[row], wide);
                        }
                    }
                }
            }
        }
    }
}

/// Level of a sample by its place in the row and its row.
type Level<'a> = &'a (dyn Fn(u32, u32) -> u32 + Sync);

/// Bytes for a compressor: noise of several widths, runs of every length up to the longest match and beyond, and one value.
#[test]
fn png_files_of_noise_and_runs_are_decoded_to_the_given_samples() {
    let tone = ToneMapper::as_displayed();
    let hash = |x: u32, y: u32| {
        let mixed = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b);
        mixed.wrapping_mul(0x21f0_aaad)
    };
    // With the largest size relative to that of a search for repetitions: runs of several bytes are not found.
    let levels: [(f64, Level<'_>); 4] = [
        (1.01, &|x, y| hash(x, y) >> 24),
        (1.25, &|x, y| 128 + (hash(x, y) >> 30)),
        (2.5, &|x, y| {
            if x.is_multiple_of(y + 1) { 17 * y } else { 90 }
        }),
        (2.0, &|_, _| 255),
    ];
    for (largest, level) in levels {
        let (width, height) = (800, 300);
        let source = RowFn::new(3, move |y, out: &mut [f32]| {
            for (x, value) in (0..).zip(out) {
                *value = srgb_decode(f64::from(level(x, y) % 256) / 255.0) as f32;
            }
        });
        let mut sizes = Vec::new();
        for compression_level in [1, 3] {
            let options = PngOptions {
                depth: PngDepth::Eight,
                compression_level,
            };
            let (size, metadata) = (size(width, height), Metadata::default());
            let mut bytes = Vec::new();
            let control = Control::default();
            png::encode(
                &mut bytes, size, &source, &tone, &options, &metadata, control,
            )
            .unwrap();
            let image = image::load_from_memory(&bytes).unwrap();
            let got = image.as_rgb8().unwrap().as_raw();
            for (at, &got) in (0..).zip(got) {
                let (x, y) = (at % (3 * width), at / (3 * width));
                assert_eq!(u32::from(got), level(x, y) % 256, "{x} {y}");
            }
            sizes.push(bytes.len() as f64);
        }
        assert!(sizes[0] < largest * sizes[1], "{sizes:?}");
    }
}

mod guards {
    use super::*;

    #[test]
    fn jpeg_files_are_close_to_the_given_samples() {
        for (width, height) in [(1, 1), (17, 9), (64, 48), (1000, 700)] {
            for (quality, most) in [(100, 1.5), (95, 2.5), (80, 6.0)] {
                let size = size(width, height);
                // No sun: JPEG is bad at its hard edge.
                let source = RowFn::new(3, |y, out: &mut [f32]| {
                    for (x, pixel) in out.chunks_mut(3).enumerate() {
                        let v = 0.05 + 0.3 * (x as f32 + y as f32) / (width + height) as f32;
                        pixel.copy_from_slice(&[v * 0.6, v, v * 1.5]);
                    }
                });
                let mut bytes = Vec::new();
                jpeg::encode(
                    &mut bytes,
                    size,
                    &source,
                    &tone(),
                    &JpegOptions { quality },
                    &full_metadata(),
                    Control::default(),
                )
                .unwrap();
                let image = image::load_from_memory(&bytes).unwrap().into_rgb8();
                assert_eq!(image.dimensions(), (width, height));
                let mut linear = vec![0.0; width as usize * 3];
                let mut want = vec![0u8; linear.len()];
                let mut sum = 0.0;
                let tone = tone();
                for y in 0..height {
                    source.fill_row(y, &mut linear);
                    tone.row_to_u8(y, &linear, &mut want);
                    let start = y as usize * want.len();
                    for (got, want) in image.as_raw()[start..].iter().zip(&want) {
                        sum += (f64::from(*got) - f64::from(*want)).powi(2);
                    }
                }
                let rms = (sum / f64::from(width * height * 3)).sqrt();
                assert!(rms < most, "{width} x {height} at {quality}: {rms}");
            }
        }
    }
}
