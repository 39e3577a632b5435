//! Depth maps: meaning of their numbers, and filling of holes.

use crate::common::{Folder, files::*, size};
use airlight_image::{
    DepthMap, DepthOptions, ImageError, Picture,
    input::{
        DepthKind, DepthMeaning, DepthPacking, LightReference, SampleBits, UnknownDepth,
        read_depth, read_picture,
    },
};

fn options() -> DepthOptions {
    DepthOptions::default()
}

const INF: f32 = f32::INFINITY;

#[test]
fn arrays_have_the_meaning_of_files() {
    let folder = Folder::new();
    let values = [2.0, f32::NAN, 0.0, 3.0, INF, 1e10];
    let options = DepthOptions {
        scale: 0.5,
        ..options()
    };
    let file = read_as(&folder, &pfm_file((6, 1), true, &values), &options).unwrap();
    let array = |values: &[f32]| {
        DepthMap::from_numbers(size(6, 1), values.to_vec(), SampleBits::Float, &options)
    };
    assert_eq!(array(&values).unwrap().metres, file.metres);
    assert!(matches!(
        array(&[-1.0; 6]),
        Err(ImageError::NegativeDepth { count: 6, .. })
    ));
    assert!(array(&values[1..]).is_err());
}

#[test]
fn each_number_has_the_documented_meaning() {
    let folder = Folder::new();
    let mut bits = options();
    let mut read = |meaning, unknown, values: &[f32]| {
        bits = DepthOptions {
            meaning,
            unknown,
            ..options()
        };
        read_as(&folder, &pfm_file((values.len(), 1), true, values), &bits)
    };
    let odd = [2.0, f32::NAN, 0.0, -0.0, INF, 1e10, 2e9, 3.4e38];
    for meaning in [DepthMeaning::ZDepth, DepthMeaning::RayDistance] {
        let map = read(meaning, UnknownDepth::Clear, &odd).unwrap();
        assert_eq!(map.metres, [2.0, 0.0, 0.0, 0.0, INF, INF, INF, INF]);
        assert_eq!((map.holes, map.infinite), (3, 4));
        assert_eq!(
            map.kind == DepthKind::Ray,
            meaning == DepthMeaning::RayDistance
        );
        let map = read(meaning, UnknownDepth::Far, &odd).unwrap();
        assert_eq!(map.metres, [2.0, INF, INF, INF, INF, INF, INF, INF]);
    }
    let stereo = DepthMeaning::Disparity {
        focal_length_px: 1000.0,
        baseline_m: 0.2,
        offset_px: 10.0,
    };
    let values = [30.0, 0.0, INF, f32::NAN, -10.0, -20.0, -5.0];
    let map = read(stereo, UnknownDepth::Clear, &values).unwrap();
    assert_eq!(map.metres, [5.0, 0.0, 0.0, 0.0, INF, INF, 40.0]);
    assert_eq!((map.holes, map.infinite, map.kind), (3, 2, DepthKind::Z));
    let values = [0.5, 0.0, -0.0, f32::NAN, INF, 1e-12];
    let map = read(DepthMeaning::Inverse, UnknownDepth::Clear, &values).unwrap();
    assert_eq!(map.metres, [2.0, INF, INF, 0.0, 0.0, INF]);
    for meaning in [DepthMeaning::ZDepth, DepthMeaning::Inverse, stereo] {
        let error = read(meaning, UnknownDepth::Fill, &[f32::NAN; 4])
            .unwrap_err()
            .to_string();
        assert!(error.contains("got 4 holes"), "{error}");
    }
}

#[test]
fn scale_and_sky() {
    let folder = Folder::new();
    let read = |options: &DepthOptions, values: &[u16]| {
        let size = (values.len() as u32, 1);
        read_as(&folder, &grey_16(size, values), options).unwrap()
    };
    let far = DepthOptions {
        scale: 0.01,
        far_from_m: Some(600.0),
        ..options()
    };
    let map = read(&far, &[100, 59_999, 60_000, 65_535]);
    assert_eq!(map.metres, [1.0, 599.99, INF, INF]);
    assert_eq!(map.infinite, 2);
    // KITTI: disparity in 1/256 pixels.
    let kitti = DepthOptions {
        meaning: DepthMeaning::Disparity {
            focal_length_px: 721.5,
            baseline_m: 0.54,
            offset_px: 0.0,
        },
        scale: 1.0 / 256.0,
        ..options()
    };
    let map = read(&kitti, &[256, 25_600]);
    assert!((map.metres[0] - 389.61).abs() < 1e-3);
    assert!((map.metres[1] - 3.8961).abs() < 1e-5);
    let inverse = DepthOptions {
        meaning: DepthMeaning::Inverse,
        scale: 0.25,
        ..options()
    };
    assert_eq!(read(&inverse, &[0, 1, 8]).metres, [INF, 4.0, 0.5]);
}

#[test]
fn negative_depth_is_an_error_that_names_its_pixel() {
    let folder = Folder::new();
    let mut values = vec![1.0f32; 200 * 150];
    values[120 * 200 + 7] = -2.5;
    values[130 * 200] = f32::NEG_INFINITY;
    let bytes = pfm_file((200, 150), true, &values);
    for meaning in [
        DepthMeaning::ZDepth,
        DepthMeaning::RayDistance,
        DepthMeaning::Inverse,
    ] {
        let mut options = DepthOptions {
            meaning,
            ..options()
        };
        let error = read_as(&folder, &bytes, &options).unwrap_err();
        let ImageError::NegativeDepth {
            count, x, y, value, ..
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!((count, x, y, value), (2, 7, 120, -2.5));
        let text = error.to_string();
        assert!(
            text.contains("in 2 of its pixels, the first at x 7, y 120: -2.5"),
            "{text}"
        );
        options.negative_is_unknown = true;
        let map = read_as(&folder, &bytes, &options).unwrap();
        assert_eq!((map.holes, map.metres[120 * 200 + 7]), (2, 1.0));
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = Folder::new();
    let png = grey_16((1, 1), &[5]);
    let stereo = |focal_length_px, baseline_m, offset_px| DepthMeaning::Disparity {
        focal_length_px,
        baseline_m,
        offset_px,
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for options in [
            DepthOptions {
                scale: bad,
                ..options()
            },
            DepthOptions {
                far_from_m: Some(bad),
                ..options()
            },
            DepthOptions {
                meaning: stereo(bad, 1.0, 0.0),
                ..options()
            },
            DepthOptions {
                meaning: stereo(1.0, bad, 0.0),
                ..options()
            },
            DepthOptions {
                meaning: stereo(1.0, 1.0, f64::NAN),
                ..options()
            },
        ] {
            let result = read_as(&folder, &png, &options);
            assert!(
                matches!(result, Err(ImageError::Setting { .. })),
                "{options:?}"
            );
        }
    }
}

#[test]
fn holes_are_filled_from_the_farther_side() {
    let folder = Folder::new();
    let o = f32::NAN;
    let fill = |width: usize, values: &[f32]| {
        let height = values.len() / width;
        let map = read_as(
            &folder,
            &pfm_file((width, height), true, values),
            &options(),
        )
        .unwrap();
        assert!(map.metres.iter().all(|v| *v > 0.0));
        map.metres
    };
    // Between a near and a far object, the far one; at the edges the only neighbour; the sky is farthest.
    assert_eq!(fill(5, &[2.0, o, o, 9.0, o]), [2.0, 9.0, 9.0, 9.0, 9.0]);
    assert_eq!(fill(5, &[o, 9.0, o, o, 2.0]), [9.0, 9.0, 9.0, 9.0, 2.0]);
    assert_eq!(fill(4, &[INF, o, o, 2.0]), [INF, INF, INF, 2.0]);
    // On one surface, linear in 1/z, as a floor seen at a slant.
    let floor = |x: usize| 1.0 / (0.2 + 0.002 * x as f32);
    let mut row: Vec<f32> = (0..10).map(floor).collect();
    row[4..8].fill(o);
    for (x, v) in fill(10, &row).into_iter().enumerate() {
        assert!((v / floor(x) - 1.0).abs() < 1e-6, "{x}: {v}");
    }
    // Rows without known pixels take the farther of those above and below.
    let rows = [1.0, 8.0, o, o, o, o, 3.0, 2.0];
    assert_eq!(fill(2, &rows), [1.0, 8.0, 3.0, 8.0, 3.0, 8.0, 3.0, 2.0]);
    assert_eq!(fill(2, &[o, o, 3.0, 2.0]), [3.0, 2.0, 3.0, 2.0]);
    assert_eq!(fill(2, &[3.0, 2.0, o, o]), [3.0, 2.0, 3.0, 2.0]);
    // A row whose far side is wrongly near gives no streak.
    let mut streak = [4.0, o, o, 1.0].repeat(9);
    streak[4 * 4] = 1.5;
    let filled = fill(4, &streak);
    for y in 0..9 {
        assert_eq!(filled[y * 4 + 1..y * 4 + 3], [4.0, 4.0], "{y}");
    }
    // Known pixels stay unchanged.
    assert_eq!(filled[16], 1.5);
}

#[test]
fn maps_and_pictures_must_have_equal_sizes() {
    let folder = Folder::new();
    let map = read_as(&folder, &grey_16((2, 3), &[5; 6]), &options()).unwrap();
    let path = folder.file("colour.png");
    let check = |width: u32, height: u32| {
        let values = vec![9; (width * height) as usize];
        std::fs::write(&path, grey_16((width, height), &values)).unwrap();
        map.check_against(&read_picture(&path, None).unwrap())
    };
    check(2, 3).unwrap();
    let error = check(3, 2).unwrap_err().to_string();
    assert!(
        error.contains("2 x 3") && error.contains("3 x 2"),
        "{error}"
    );
}

#[test]
fn a_measured_map_is_filled() {
    // Tail light and bench of the motorcycle, 96 x 64 pixels: data/README.md.
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/motorcycle_depth_mm.png"
    );
    let options = DepthOptions {
        scale: 0.001,
        ..options()
    };
    let map = read_depth(path.as_ref(), &options).unwrap();
    assert_eq!((map.size, map.infinite), (size(96, 64), 0));
    assert!(map.holes > 300, "{}", map.holes);
    // The wall is 6 m away, the tail light at 2 m and beyond.
    assert!(map.metres.iter().all(|z| (1.5..7.0).contains(z)));
}

#[test]
fn holes_on_one_surface_are_exact_in_every_row() {
    let folder = Folder::new();
    // The ground below a level camera: 800 m over the row. A column of holes between equal neighbours.
    let (width, height) = (8, 6);
    let ground = |y: usize| if y == 0 { 1e9 } else { 800.0 / y as f32 };
    let mut values: Vec<f32> = (0..width * height).map(|i| ground(i / width)).collect();
    for y in 1..height {
        values[y * width + 4] = 0.0;
    }
    let map = read_as(
        &folder,
        &pfm_file((width, height), true, &values),
        &options(),
    )
    .unwrap();
    for y in 1..height {
        assert_eq!(map.metres[y * width + 4], ground(y), "{y}");
    }
}

#[test]
fn unknown_pixels_above_a_column_are_sky() {
    let folder = Folder::new();
    let o = 0.0;
    let values = [o, o, 5.0, o, 4.0, o, 2.0, o, 5.0];
    let options = DepthOptions {
        unknown: UnknownDepth::SkyAbove,
        ..options()
    };
    let map = read_as(&folder, &pfm_file((3, 3), true, &values), &options).unwrap();
    assert_eq!(map.metres, [INF, INF, 5.0, INF, 4.0, 4.0, 2.0, 5.0, 5.0]);
    assert_eq!((map.holes, map.infinite), (5, 3));
}

#[test]
fn affine_normalised_and_inverted_depths() {
    let folder = Folder::new();
    let read = |meaning, scale, offset, values: &[f32]| {
        let options = DepthOptions {
            meaning,
            scale,
            offset: Some(offset),
            ..options()
        };
        read_as(
            &folder,
            &pfm_file((values.len(), 1), true, values),
            &options,
        )
    };
    // From 0 at 2 m to 1 at 10 m, and from 1 at 2 m to 0 at 10 m.
    let map = read(DepthMeaning::ZDepth, 8.0, 2.0, &[0.0, 0.5, 1.0]).unwrap();
    assert_eq!((map.metres, map.holes), (vec![2.0, 6.0, 10.0], 0));
    let map = read(DepthMeaning::ZDepth, -8.0, 10.0, &[0.0, 0.5, 1.0]).unwrap();
    assert_eq!(map.metres, [10.0, 6.0, 2.0]);
    let error = read(DepthMeaning::ZDepth, -8.0, 4.0, &[0.0, 1.0]).unwrap_err();
    assert!(matches!(error, ImageError::NegativeDepth { .. }));
    // Affine inverse depth, as networks estimate it.
    let map = read(DepthMeaning::Inverse, 0.25, -0.25, &[0.0, 1.0, 2.0, 3.0]).unwrap();
    assert_eq!(map.metres, [INF, INF, 4.0, 2.0]);
}

/// The number in a depth buffer of a depth.
type Project<'a> = &'a dyn Fn(f64) -> f64;

/// The depths that perspective projections of graphics interfaces map to the numbers of their depth buffers.
#[test]
fn depth_buffers_are_linearised() {
    let folder = Folder::new();
    let read = |near_m, far_m, is_reversed, file: &[u8]| {
        let options = DepthOptions {
            meaning: DepthMeaning::Buffer {
                near_m,
                far_m,
                is_reversed,
            },
            ..options()
        };
        read_as(&folder, file, &options)
    };
    let (near, far) = (0.5, 200.0);
    let depths = [0.5, 0.75, 3.0, 40.0, 199.0];
    // The projections of Direct3D and Vulkan, and those with reversed depth.
    let finite = |z: f64| far / (far - near) * (1.0 - near / z);
    let infinite = |z: f64| 1.0 - near / z;
    let cases: [(f64, bool, Project<'_>); 4] = [
        (far, false, &finite),
        (far, true, &|z| 1.0 - finite(z)),
        (f64::INFINITY, false, &infinite),
        (f64::INFINITY, true, &|z| near / z),
    ];
    for (far_m, is_reversed, project) in cases {
        let beyond = if is_reversed { 0.0 } else { 1.0 };
        let numbers = depths.iter().map(|&z| project(z) as f32);
        let numbers: Vec<f32> = numbers.chain([beyond, f32::NAN]).collect();
        let map = read(near, far_m, is_reversed, &pfm_file((7, 1), true, &numbers)).unwrap();
        for (got, expected) in map.metres.iter().zip(depths) {
            // Single precision leaves 6e-8 of the distance between the planes at 1.
            let error = (f64::from(*got) / expected - 1.0).abs();
            assert!(error < 1e-7 * (expected / near + 4.0), "{got} {expected}");
        }
        assert_eq!((map.metres[5], map.holes, map.infinite), (INF, 1, 1));
    }
    // Integers stand for 0 to 1.
    let map = read(
        0.5,
        f64::INFINITY,
        true,
        &grey_16((3, 1), &[65_535, 6_553, 0]),
    )
    .unwrap();
    assert_eq!((map.metres[0], map.metres[2]), (0.5, INF));
    assert!(
        (map.metres[1] / 5.000_38 - 1.0).abs() < 1e-5,
        "{}",
        map.metres[1]
    );
    let error = read(0.5, 9.0, false, &pfm_file((1, 1), true, &[-0.1])).unwrap_err();
    assert!(matches!(error, ImageError::NegativeDepth { .. }));
    for (near_m, far_m) in [
        (0.0, 9.0),
        (-1.0, 9.0),
        (f64::INFINITY, INF.into()),
        (1.0, 1.0),
        (1.0, f64::NAN),
    ] {
        let error = read(near_m, far_m, false, &grey_16((1, 1), &[5])).unwrap_err();
        assert!(
            matches!(error, ImageError::Setting { .. }),
            "{near_m} {far_m}"
        );
    }
}

#[test]
fn depth_in_the_bits_of_colours() {
    let folder = Folder::new();
    let rgb = |data: &[u8]| {
        let (color, depth) = (png::ColorType::Rgb, png::BitDepth::Eight);
        png_file((data.len() as u32 / 3, 1), color, depth, data, |_| {})
    };
    let carla = DepthOptions {
        packing: DepthPacking::Carla,
        ..options()
    };
    let data = [0, 0, 128, 255, 255, 255, 1, 0, 0];
    let map = read_as(&folder, &rgb(&data), &carla).unwrap();
    let metres = |number: f64| (1000.0 * number / f64::from((1 << 24) - 1)) as f32;
    assert!((map.metres[0] - metres(128.0 * 65_536.0)).abs() < 1e-4);
    assert_eq!(map.metres[1], INF);
    assert!((map.metres[2] / metres(1.0) - 1.0).abs() < 1e-6);
    let map = read_as(&folder, &rgb(&[7, 7, 7, 9, 9, 9]), &options()).unwrap();
    assert_eq!(map.metres, [7.0, 9.0]);
    let error = read_as(&folder, &rgb(&data), &options()).unwrap_err();
    assert!(error.to_string().contains("depth-packing"), "{error}");
    let error = read_as(&folder, &grey_16((1, 1), &[5]), &carla).unwrap_err();
    assert!(error.to_string().contains("packed depth"), "{error}");
}

#[test]
fn maps_of_another_size_take_the_nearest_depth() {
    let picture = |width, height| {
        let rgb = vec![0.0; (3 * width * height) as usize];
        Picture::new(
            size(width, height),
            rgb,
            LightReference::Display,
            SampleBits::U8,
        )
    };
    let map = DepthMap::new(size(2, 1), vec![1.0, INF], DepthKind::Z);
    let large = map.clone().resized_like(&picture(4, 2));
    assert_eq!(large.metres, [1.0, 1.0, INF, INF, 1.0, 1.0, INF, INF]);
    assert_eq!((large.infinite, large.range_m()), (4, Some((1.0, 1.0))));
    assert!(
        large.notes.to_string().contains("2 x 1 to 4 x 2"),
        "{}",
        large.notes
    );
    // Another aspect ratio is another picture.
    assert!(
        map.clone()
            .resized_like(&picture(4, 3))
            .check_against(&picture(4, 3))
            .is_err()
    );
    assert_eq!(map.resized_like(&picture(2, 1)).notes.to_string(), "");
}
