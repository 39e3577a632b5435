//! Files of every writer come back through the readers with the same colours, unit and shape of pixels.

use crate::common::{Folder, size};
use airlight::Named;
use airlight::spectrum::{RgbSpace, rgb::srgb_encode};
use airlight_image::{
    Control, ImageError, Picture, PictureFormat, PictureOptions,
    input::{LightReference, SampleBits, read_picture},
    output::{
        Metadata,
        exr::{ExrCompression, ExrOptions, SamplePrecision},
        jpeg::JpegOptions,
        png::{PngDepth, PngOptions},
    },
    rows::StoredRows,
    tone::ToneMapper,
    write_picture,
};
use glam::{DMat3, DVec3};

/// Colours in linear sRGB that are within the gamut of every space; the first three are within a display's range.
const COLOURS: [[f64; 3]; 5] = [
    [1.0, 1.0, 1.0],
    [0.7, 0.2, 0.05],
    [0.02, 0.4, 0.3],
    [30.0, 45.0, 80.0],
    [3e4, 2e4, 1e4],
];

/// Side of the square of a colour: blocks of JPEG with subsampled chroma.
const SQUARE: u32 = 16;

/// Settings of a format, and what its rounding may do.
struct Form {
    format: PictureFormat,
    options: PictureOptions,
    bits: SampleBits,
    /// Of linear files, relative to the largest component; of display files, in encoded values.
    tolerance: f64,
}

fn forms() -> Vec<Form> {
    let mut forms = Vec::new();
    for format in PictureFormat::ALL {
        let mut add = |options, bits, tolerance| {
            forms.push(Form {
                format,
                options,
                bits,
                tolerance,
            });
        };
        match format.name() {
            "OpenEXR" => {
                for &compression in ExrCompression::ALL {
                    for (precision, bits, tolerance) in [
                        (SamplePrecision::Float, SampleBits::Float, 3e-6),
                        (SamplePrecision::Half, SampleBits::Half, 1e-3),
                    ] {
                        let exr = ExrOptions {
                            precision,
                            compression,
                        };
                        let options = PictureOptions {
                            exr,
                            ..PictureOptions::default()
                        };
                        add(options, bits, tolerance);
                    }
                }
            }
            "PNG" => {
                for (depth, bits, tolerance) in [
                    (PngDepth::Eight, SampleBits::U8, 0.51 / 255.0),
                    (PngDepth::Sixteen, SampleBits::U16, 0.51 / 65_535.0),
                ] {
                    for compression_level in [0, 1, 3] {
                        let png = PngOptions {
                            depth,
                            compression_level,
                        };
                        let options = PictureOptions {
                            png,
                            ..PictureOptions::default()
                        };
                        add(options, bits, tolerance);
                    }
                }
            }
            "JPEG" => {
                for (quality, levels) in [(100, 2.0), (92, 3.0), (75, 6.0)] {
                    let options = PictureOptions {
                        jpeg: JpegOptions { quality },
                        ..PictureOptions::default()
                    };
                    add(options, SampleBits::U8, levels / 255.0);
                }
            }
            // Half a step of the largest component, in each component of the file's space.
            _ => add(PictureOptions::default(), SampleBits::Float, 8e-3),
        }
    }
    forms
}

/// Writes colours in a space and a unit; reads them by the contents of the file.
fn round_trip(
    folder: &Folder,
    form: &Form,
    space: RgbSpace,
    colours: &[[f64; 3]],
    white_luminance_cd_m2: f32,
) -> Result<Picture, ImageError> {
    let unit = match form.format.is_linear() {
        true => f64::from(white_luminance_cd_m2),
        false => 1.0,
    };
    let width = SQUARE * colours.len() as u32;
    let row = colours.iter().flat_map(|&colour| {
        let rgb = space.from_xyz(RgbSpace::Srgb.to_xyz(colour));
        vec![rgb.map(|c| (c / unit) as f32); SQUARE as usize]
    });
    let row: Vec<f32> = row.flatten().collect();
    let rows = StoredRows::new(width, 3, row.repeat(SQUARE as usize)).unwrap();
    let path = folder.file(format!("picture.{}", form.format.endings()[0]));
    let options = PictureOptions {
        metadata: Metadata {
            chromaticities: Some(space.into()),
            white_luminance_cd_m2: Some(white_luminance_cd_m2),
            pixel_aspect: Some(2.0),
            ..Metadata::default()
        },
        ..form.options.clone()
    };
    let size = size(width, SQUARE);
    let tone = ToneMapper::as_displayed();
    write_picture(&path, size, &rows, &tone, &options, Control::default())?;
    let moved = folder.file("picture.txt");
    std::fs::rename(&path, &moved).unwrap();
    let picture = read_picture(&moved, None)?;
    assert_eq!(picture.size, size);
    Ok(picture)
}

/// A pixel in the middle of a square, in linear sRGB, in cd/m^2 where the file states its unit.
fn middle(picture: &Picture, square: usize) -> [f64; 3] {
    let (width, half) = (picture.size.width() as usize, SQUARE as usize / 2);
    let pixel = half * width + square * SQUARE as usize + half;
    let rgb = &picture.rgb[3 * pixel..3 * pixel + 3];
    let unit = picture.white_luminance_cd_m2.map_or(1.0, f64::from);
    let colour = DVec3::new(rgb[0].into(), rgb[1].into(), rgb[2].into()) * unit;
    let to_srgb = picture.to_linear_srgb().unwrap_or(DMat3::IDENTITY);
    (to_srgb * colour).to_array()
}

#[test]
fn every_format_returns_the_colours_of_every_space() {
    let folder = Folder::new();
    for form in forms() {
        for &space in RgbSpace::ALL {
            for white_luminance_cd_m2 in [1.0, 250.0] {
                let case = format!("{} {:?} {space}", form.format, form.options);
                let is_linear = form.format.is_linear();
                let colours = if is_linear {
                    &COLOURS[..]
                } else {
                    &COLOURS[..3]
                };
                let picture = round_trip(&folder, &form, space, colours, white_luminance_cd_m2);
                if !is_linear && space != RgbSpace::Srgb {
                    // Refused, as the file would be taken for sRGB.
                    let error = picture.unwrap_err().to_string();
                    assert!(
                        error.contains("sRGB") && error.contains("try EXR"),
                        "{error}"
                    );
                    assert!(folder.names("").iter().all(|name| name == "picture.txt"));
                    continue;
                }
                let picture = picture.unwrap();
                assert!(picture.notes.is_empty(), "{case}: {}", picture.notes);
                assert_eq!(picture.bits, form.bits, "{case}");
                assert!((picture.pixel_aspect - 2.0).abs() < 1e-3, "{case}");
                let stated = picture.chromaticities;
                if is_linear {
                    assert_eq!(picture.reference, LightReference::Scene, "{case}");
                    assert_eq!(stated, Some(space.into()), "{case}");
                    let white = picture.white_luminance_cd_m2;
                    assert_eq!(white, Some(white_luminance_cd_m2), "{case}");
                } else {
                    assert_eq!(picture.reference, LightReference::Display, "{case}");
                    assert_eq!(stated, None, "{case}");
                }
                for (square, colour) in colours.iter().enumerate() {
                    let got = middle(&picture, square);
                    let largest = colour.iter().copied().fold(0.0, f64::max);
                    for (got, want) in got.iter().zip(colour) {
                        let off = match is_linear {
                            true => (got - want).abs() / largest,
                            false => (srgb_encode(*got) - srgb_encode(*want)).abs(),
                        };
                        assert!(off < form.tolerance, "{case}: {got} {want}");
                    }
                }
            }
        }
    }
}

/// Light that looks white in one space looks white in all: D65, or what a file says that it adopts as neutral.
#[test]
fn unadapted_colours_differ_from_adapted_ones() {
    let folder = Folder::new();
    let white = [[1.0; 3]];
    for form in forms().into_iter().filter(|form| form.format.is_linear()) {
        let stored = |space| {
            let picture = round_trip(&folder, &form, space, &white, 1.0).unwrap();
            [picture.rgb[0], picture.rgb[2]]
        };
        let [adapted, unadapted] = [RgbSpace::AcesCg, RgbSpace::AcesCgUnadapted].map(stored);
        // The numbers in the files differ: D65 is bluish beside the white of ACEScg.
        assert!((adapted[1] / adapted[0] - 1.0).abs() < 0.01, "{adapted:?}");
        assert!(unadapted[1] / unadapted[0] > 1.1, "{unadapted:?}");
    }
}

#[test]
fn a_neutral_colour_outside_the_gamut_is_ignored() {
    let folder = Folder::new();
    let file = |neutral: &str| {
        let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nPRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n";
        let mut bytes = format!("{header}{neutral}\n\n-Y 1 +X 1\n").into_bytes();
        bytes.extend([128, 128, 128, 129]);
        let path = folder.file("a.hdr");
        std::fs::write(&path, bytes).unwrap();
        read_picture(&path, None).unwrap()
    };
    let equal_energy = file("ADOPTED_NEUTRAL=0.3333 0.3333");
    assert!(equal_energy.notes.is_empty() && equal_energy.to_linear_srgb().is_some());
    for neutral in ["ADOPTED_NEUTRAL=0.7 0.3", "ADOPTED_NEUTRAL=0.3 0"] {
        let picture = file(neutral);
        assert_eq!(picture.chromaticities, None, "{neutral}");
        assert!(
            picture.notes.to_string().contains("impossible"),
            "{neutral}"
        );
    }
    // Not two numbers: no statement.
    assert!(file("ADOPTED_NEUTRAL=x").to_linear_srgb().is_none());
}
