//! OpenEXR pictures: kinds of samples and compression, windows, layers and parts.

use crate::common::{Folder, files::*, size};
use airlight_image::{
    ImageError, Picture,
    input::{LightReference, SampleBits, read_picture},
};
use exr::prelude::{Compression, FlatSamples, f16};

fn read_as(folder: &Folder, bytes: &[u8], layer: Option<&str>) -> Result<Picture, ImageError> {
    let path = folder.0.join("input.bin");
    std::fs::write(&path, bytes).unwrap();
    read_picture(&path, layer)
}

fn ramp(count: usize, from: f32) -> Vec<f32> {
    (0..count).map(|i| from + i as f32).collect()
}

fn halves(values: &[f32]) -> FlatSamples {
    FlatSamples::F16(values.iter().map(|&v| f16::from_f32(v)).collect())
}

#[test]
fn exr_pictures_of_every_kind() {
    let folder = Folder::new("read-exr");
    let size_xy = (37, 41);
    let count = 37 * 41;
    for compression in [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
    ] {
        for tile in [None, Some(16)] {
            let part = Part {
                compression,
                tile,
                ..Part::new(
                    size_xy,
                    vec![
                        ("A", halves(&vec![0.5; count])),
                        ("B", FlatSamples::U32((0..count as u32).collect())),
                        ("G", halves(&ramp(count, 1.0))),
                        ("R", FlatSamples::F32(ramp(count, 0.25))),
                    ],
                )
            };
            let bytes = exr_file((0, 0, 37, 41), vec![part]);
            let picture = read_as(&folder, &bytes, None).unwrap();
            assert_eq!(picture.size, size(37, 41));
            assert_eq!(picture.reference, LightReference::Scene);
            assert_eq!(picture.bits, SampleBits::Float);
            assert_eq!(picture.alpha, Some(vec![0.5; count]));
            for (i, rgb) in picture.rgb.chunks(3).enumerate() {
                let expected = [i as f32 + 0.25, i as f32 + 1.0, i as f32];
                assert_eq!(rgb, expected, "{compression:?} {tile:?}");
            }
            let white = picture.chromaticities.unwrap();
            assert_eq!((white.red, white.blue), ([0.7, 0.3], [0.1, 0.05]));
        }
    }
    let grey = Part::new((2, 1), vec![("Y", halves(&[1.0, 2.0]))]);
    let picture = read_as(&folder, &exr_file((0, 0, 2, 1), vec![grey]), None).unwrap();
    assert_eq!(picture.rgb, [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    assert_eq!(picture.bits, SampleBits::Half);
}

#[test]
fn data_windows_are_brought_to_the_display_window() {
    let folder = Folder::new("windows");
    let (data_w, data_h) = (5, 20);
    for (window_x, window_y) in [
        (0, 0),
        (2, 3),
        (-4, -4),
        (4, 10),
        (-100, 7),
        (3000, 0),
        (7, -6),
    ] {
        for position in [(0, 0), (-3, 8)] {
            for tile in [None, Some(4)] {
                let samples = ramp(data_w * data_h, 1.0);
                let part = Part {
                    position,
                    tile,
                    compression: Compression::ZIP16,
                    ..Part::new((data_w, data_h), vec![("Y", FlatSamples::F32(samples))])
                };
                let window = (window_x, window_y, 7, 9);
                let picture = read_as(&folder, &exr_file(window, vec![part]), None).unwrap();
                assert_eq!(picture.size, size(7, 9));
                for y in 0..9 {
                    for x in 0..7 {
                        let (u, v) = (x + window_x - position.0, y + window_y - position.1);
                        let inside =
                            (0..data_w as i32).contains(&u) && (0..data_h as i32).contains(&v);
                        let expected = if inside {
                            1.0 + (v * data_w as i32 + u) as f32
                        } else {
                            0.0
                        };
                        let got = picture.rgb[((y * 7 + x) * 3) as usize];
                        assert_eq!(got, expected, "{window:?} {position:?} {x} {y}");
                    }
                }
            }
        }
    }
}

#[test]
fn layers_and_parts_are_found_by_name() {
    let folder = Folder::new("layers");
    let one = |v: f32| FlatSamples::F32(vec![v]);
    let pixel = (1, 1);
    let rgb = |prefix: [&'static str; 3], v: f32| {
        prefix
            .into_iter()
            .enumerate()
            .map(|(i, name)| (name, one(v + i as f32)))
            .collect::<Vec<_>>()
    };
    let first = |bytes: &[u8], layer| read_as(&folder, bytes, layer).map(|p| p.rgb);

    let mut channels = rgb(["R", "G", "B"], 1.0);
    channels.extend(rgb(["beauty.R", "beauty.G", "beauty.B"], 10.0));
    channels.push(("beauty.A", one(0.5)));
    channels.push(("fog.Y", one(7.0)));
    let layered = exr_file((0, 0, 1, 1), vec![Part::new(pixel, channels)]);
    assert_eq!(first(&layered, None).unwrap(), [1.0, 2.0, 3.0]);
    assert_eq!(first(&layered, Some("beauty")).unwrap(), [10.0, 11.0, 12.0]);
    assert_eq!(
        first(&layered, Some("beauty.")).unwrap(),
        [10.0, 11.0, 12.0]
    );
    assert_eq!(first(&layered, Some("fog")).unwrap(), [7.0, 7.0, 7.0]);
    assert_eq!(
        read_as(&folder, &layered, Some("beauty")).unwrap().alpha,
        Some(vec![0.5])
    );
    let error = first(&layered, Some("diffuse")).unwrap_err();
    assert!(matches!(error, ImageError::NoChannel { .. }));
    let error = error.to_string();
    assert!(
        error.contains("`diffuse`") && error.contains("beauty.R, fog.Y"),
        "{error}"
    );

    let parts = || {
        vec![
            Part::new(pixel, vec![("Z", one(5.0))]).named("depth"),
            Part::new(pixel, rgb(["R", "G", "B"], 20.0)).named("left"),
            Part::new(pixel, rgb(["hi.R", "hi.G", "hi.B"], 30.0)).named("right"),
        ]
    };
    let many = exr_file((0, 0, 1, 1), parts());
    assert_eq!(first(&many, None).unwrap(), [20.0, 21.0, 22.0]);
    assert_eq!(first(&many, Some("left")).unwrap(), [20.0, 21.0, 22.0]);
    assert_eq!(first(&many, Some("hi")).unwrap(), [30.0, 31.0, 32.0]);
    assert_eq!(first(&many, Some("right.hi")).unwrap(), [30.0, 31.0, 32.0]);
    let error = first(&many, Some("depth")).unwrap_err().to_string();
    assert!(error.contains("depth.Z, left.B"), "{error}");

    // The only layer with colours needs no name; with two, one must be named.
    let only = rgb(["a.R", "a.G", "a.B"], 1.0);
    let mut two = rgb(["a.R", "a.G", "a.B"], 1.0);
    two.extend(rgb(["b.R", "b.G", "b.B"], 2.0));
    let file = |channels| exr_file((0, 0, 1, 1), vec![Part::new(pixel, channels)]);
    assert_eq!(first(&file(only), None).unwrap(), [1.0, 2.0, 3.0]);
    let error = first(&file(two), None).unwrap_err().to_string();
    assert!(error.contains("try naming a layer"), "{error}");
    // The Y of a position is not luminance.
    let position = rgb(["X", "Y", "Z"], 1.0);
    assert!(first(&file(position), None).is_err());
}

#[test]
fn invalid_samples_are_repaired_and_counted() {
    let folder = Folder::new("repaired");
    let odd = vec![f32::NAN, -1.0, f32::INFINITY, f32::NEG_INFINITY, 3.0, -0.0];
    let part = Part::new(
        (6, 1),
        vec![
            (
                "A",
                FlatSamples::F32(vec![f32::INFINITY, 1.0, 0.0, 0.5, -1.0, 1.0]),
            ),
            ("Y", FlatSamples::F32(odd)),
        ],
    );
    let picture = read_as(&folder, &exr_file((0, 0, 6, 1), vec![part]), None).unwrap();
    let grey: Vec<f32> = picture.rgb.chunks(3).map(|rgb| rgb[2]).collect();
    assert_eq!(grey, [0.0, -1.0, 65504.0, -65504.0, 3.0, 0.0]);
    assert_eq!(picture.alpha, Some(vec![1.0, 1.0, 0.0, 0.5, 0.0, 1.0]));
    assert_eq!(
        picture.notes.to_string(),
        "11 NaN or infinite samples repaired"
    );
}
