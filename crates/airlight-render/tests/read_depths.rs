//! Depth maps read from files.

mod common;

use airlight_render::{
    DepthMap, DepthOptions, RenderError,
    input::{DepthKind, DepthMeaning, SampleBits, Unknown, read_depth, read_picture},
};
use common::{Folder, files::*, size};
use exr::prelude::{FlatSamples, f16};
use png::{BitDepth, ColorType};

fn read_as(folder: &Folder, bytes: &[u8], options: &DepthOptions) -> Result<DepthMap, RenderError> {
    let path = folder.0.join("depth.bin");
    std::fs::write(&path, bytes).unwrap();
    read_depth(&path, options)
}

fn options() -> DepthOptions {
    DepthOptions::default()
}

const INF: f32 = f32::INFINITY;

#[test]
fn png_depth_of_8_and_16_bits() {
    let folder = Folder::new("depth-png");
    let millimetres = DepthOptions {
        scale: 0.001,
        ..options()
    };
    let map = read_as(&folder, &grey_16((3, 1), &[1, 2345, 65535]), &millimetres).unwrap();
    assert_eq!(map.metres, [0.001, 2.345, 65.535]);
    assert_eq!((map.size, map.kind), (size(3, 1), DepthKind::Z));
    assert_eq!((map.bits, map.holes, map.infinite), (SampleBits::U16, 0, 0));
    let plain = |_: &mut png::Encoder<'_, &mut Vec<u8>>| {};
    let eight = png_file(
        (2, 1),
        ColorType::Grayscale,
        BitDepth::Eight,
        &[1, 255],
        plain,
    );
    let map = read_as(&folder, &eight, &options()).unwrap();
    assert_eq!((map.metres, map.bits), (vec![1.0, 255.0], SampleBits::U8));
    for (color, depth, data, said) in [
        (
            ColorType::Grayscale,
            BitDepth::Four,
            vec![0x12u8],
            "grey of 4 bits",
        ),
        (ColorType::Rgb, BitDepth::Eight, vec![1; 6], "RGB of 8 bits"),
        (
            ColorType::Rgba,
            BitDepth::Sixteen,
            vec![1; 16],
            "RGB and opacity of 16 bits",
        ),
        (
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            vec![1; 4],
            "grey and opacity",
        ),
    ] {
        let bytes = png_file((2, 1), color, depth, &data, plain);
        let error = read_as(&folder, &bytes, &options())
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(said) && error.contains("8 or 16 bits"),
            "{error}"
        );
    }
}

#[test]
fn npy_depth_of_every_kind() {
    let folder = Folder::new("depth-npy");
    let values = [1u8, 2, 3, 4, 5, 6];
    let be = |bytes: Vec<u8>, width: usize| -> Vec<u8> {
        bytes
            .chunks(width)
            .flat_map(|number| number.iter().rev().copied().collect::<Vec<_>>())
            .collect()
    };
    let mut kinds: Vec<(&str, usize, Vec<u8>, SampleBits)> = vec![
        ("u1", 1, values.to_vec(), SampleBits::U8),
        ("i1", 1, values.to_vec(), SampleBits::U8),
    ];
    macro_rules! kind {
        ($name:literal, $type:ty, $bits:ident) => {
            kinds.push((
                $name,
                size_of::<$type>(),
                values
                    .iter()
                    .flat_map(|&v| <$type>::from(v).to_le_bytes())
                    .collect(),
                SampleBits::$bits,
            ))
        };
    }
    kind!("u2", u16, U16);
    kind!("u4", u32, U32);
    kind!("u8", u64, U32);
    kind!("i2", i16, U16);
    kind!("i4", i32, U32);
    kind!("i8", i64, U32);
    kind!("f2", f16, Half);
    kind!("f4", f32, Float);
    kind!("f8", f64, Float);
    for (name, width, little, bits) in kinds {
        let big = be(little.clone(), width);
        for (order, data) in [('<', &little), ('>', &big), ('=', &little)] {
            for version in [1, 2, 3] {
                for shape in ["(2, 3)", "(2, 3, 1)", "(1, 2, 3)", "(2L,3L)"] {
                    let descr = format!("'{order}{name}'");
                    let file = npy_file(version, &descr, false, shape, data);
                    let map = read_as(&folder, &file, &options()).unwrap();
                    assert_eq!(map.size, size(3, 2));
                    assert_eq!(map.metres, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
                    assert_eq!(map.bits, bits, "{descr}");
                    let file = npy_file(version, &descr, true, shape, data);
                    let map = read_as(&folder, &file, &options()).unwrap();
                    assert_eq!(map.metres, [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
                }
            }
        }
    }
    for (version, descr, shape, said) in [
        (1, "'<c8'", "(2, 3)", "f2, f4, f8"),
        (1, "'<f16'", "(2, 3)", "f2, f4, f8"),
        (1, "[('z', '<f4')]", "(2, 3)", "f2, f4, f8"),
        (1, "'|u1'", "(6,)", "(height, width)"),
        (1, "'|u1'", "(2, 3, 3)", "(height, width)"),
        (1, "'|u1'", "()", "(height, width)"),
        (1, "'|u1'", "(2, -3)", "shape"),
        (1, "'|u1'", "(0, 3)", "3 x 0 pixels"),
        (1, "'|u1'", "(99999, 3)", "65536"),
        (4, "'|u1'", "(2, 3)", "version 1, 2 or 3"),
    ] {
        let file = npy_file(version, descr, false, shape, &values);
        let error = read_as(&folder, &file, &options()).unwrap_err();
        assert!(matches!(error, RenderError::Read { .. }), "{error}");
        assert!(error.to_string().contains(said), "{error}");
    }
    let short = npy_file(1, "'<f4'", false, "(2, 3)", &[0; 23]);
    let error = read_as(&folder, &short, &options()).unwrap_err();
    assert!(matches!(error, RenderError::EndsEarly { .. }));
    assert!(error.to_string().contains("24 bytes of samples"), "{error}");
}

#[test]
fn pfm_depth_from_the_bottom_up() {
    let folder = Folder::new("depth-pfm");
    let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    for little in [false, true] {
        let map = read_as(&folder, &pfm_file((3, 2), little, &rows), &options()).unwrap();
        assert_eq!((map.size, map.metres.as_slice()), (size(3, 2), &rows[..]));
        assert_eq!(map.bits, SampleBits::Float);
    }
    for (start, said) in [
        ("PF\n1 1\n-1\n", "holds colours"),
        ("Pf\n1 x\n-1\n", "`x`"),
        ("Pf\n1 0\n-1\n", "1 x 0"),
        ("Pf\n1 1\n0\n", "byte order"),
        ("Pf5\n1 1\n-1\n", "begin with `Pf`"),
        ("Pf\n1 \u{7} \n", "not text"),
    ] {
        let mut bytes = start.as_bytes().to_vec();
        bytes.extend([0; 16]);
        let error = read_as(&folder, &bytes, &options())
            .unwrap_err()
            .to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn exr_depth_by_its_channel() {
    let folder = Folder::new("depth-exr");
    let one = |v: f32| FlatSamples::F32(vec![v]);
    let file = |names: &[&'static str]| {
        let channels = names
            .iter()
            .enumerate()
            .map(|(i, name)| (*name, one(1.0 + i as f32)))
            .collect();
        exr_file((0, 0, 1, 1), vec![Part::new((1, 1), channels)])
    };
    let named = |channel: &str| DepthOptions {
        channel: Some(channel.to_owned()),
        ..options()
    };
    let first = |bytes: &[u8], options: &DepthOptions| {
        read_as(&folder, bytes, options).map(|map| map.metres[0])
    };
    for (names, found) in [
        (&["R", "G", "B", "Z"][..], 4.0),
        (&["R", "G", "B", "z"], 4.0),
        (&["depth.Z", "R", "G", "B"], 1.0),
        (&["R", "G", "B", "Depth.V"], 4.0),
        (&["depth", "Y"], 1.0),
        (&["X", "Y", "Z", "depth.R"], 4.0),
        (
            &["V.Normal.X", "V.Normal.Z", "V.Depth.Z", "V.Combined.R"],
            3.0,
        ),
        (&["Y"], 1.0),
        (&["Y", "A"], 1.0),
        (&["R"], 1.0),
        (&["distance"], 1.0),
    ] {
        assert_eq!(first(&file(names), &options()).unwrap(), found, "{names:?}");
    }
    for names in [
        &["R", "G", "B"][..],
        &["X", "Y", "Z"],
        &["a.Depth.Z", "b.Depth.Z"],
        &["N.X", "N.Y", "N.Z"],
    ] {
        let error = first(&file(names), &options()).unwrap_err();
        let RenderError::NoChannel { there, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(*there, names.join(", ").replace("R, G, B", "B, G, R"));
        assert!(error.to_string().contains("name one"), "{error}");
    }
    let rgb = file(&["R", "G", "B"]);
    assert_eq!(first(&rgb, &named("G")).unwrap(), 2.0);
    let error = first(&rgb, &named("Z")).unwrap_err().to_string();
    assert!(
        error.contains("has no channel `Z`. Its channels: B, G, R"),
        "{error}"
    );
    let parts = || {
        vec![
            Part::new((1, 1), vec![("Z", one(3.0))]).named("near"),
            Part::new((1, 1), vec![("Z", one(9.0))]).named("far"),
        ]
    };
    let parts = exr_file((0, 0, 1, 1), parts());
    assert_eq!(first(&parts, &options()).unwrap(), 3.0);
    assert_eq!(first(&parts, &named("far.Z")).unwrap(), 9.0);
    let png = grey_16((1, 1), &[5]);
    let error = first(&png, &named("Z")).unwrap_err().to_string();
    assert!(error.contains("only EXR files have channels"), "{error}");
}

#[test]
fn each_number_means_what_the_table_says() {
    let folder = Folder::new("depth-numbers");
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
        let map = read(meaning, Unknown::Clear, &odd).unwrap();
        assert_eq!(map.metres, [2.0, 0.0, 0.0, 0.0, INF, INF, INF, INF]);
        assert_eq!((map.holes, map.infinite), (3, 4));
        assert_eq!(
            map.kind == DepthKind::Ray,
            meaning == DepthMeaning::RayDistance
        );
        let map = read(meaning, Unknown::Far, &odd).unwrap();
        assert_eq!(map.metres, [2.0, INF, INF, INF, INF, INF, INF, INF]);
    }
    let stereo = DepthMeaning::Disparity {
        focal_length_px: 1000.0,
        baseline_m: 0.2,
        offset_px: 10.0,
    };
    let values = [30.0, 0.0, INF, f32::NAN, -10.0, -20.0, -5.0];
    let map = read(stereo, Unknown::Clear, &values).unwrap();
    assert_eq!(map.metres, [5.0, 0.0, 0.0, 0.0, INF, INF, 40.0]);
    assert_eq!((map.holes, map.infinite, map.kind), (3, 2, DepthKind::Z));
    let values = [0.5, 0.0, -0.0, f32::NAN, INF, 1e-12];
    let map = read(DepthMeaning::Inverse, Unknown::Clear, &values).unwrap();
    assert_eq!(map.metres, [2.0, INF, INF, 0.0, 0.0, INF]);
    for meaning in [DepthMeaning::ZDepth, DepthMeaning::Inverse, stereo] {
        let error = read(meaning, Unknown::Fill, &[f32::NAN; 4])
            .unwrap_err()
            .to_string();
        assert!(error.contains("all its 4 pixels are holes"), "{error}");
    }
}

#[test]
fn scale_and_sky() {
    let folder = Folder::new("depth-scale");
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
    let folder = Folder::new("depth-negative");
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
        let RenderError::NegativeDepth {
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
    let folder = Folder::new("depth-options");
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
                matches!(result, Err(RenderError::Setting { .. })),
                "{options:?}"
            );
        }
    }
}

#[test]
fn holes_are_filled_from_behind() {
    let folder = Folder::new("depth-fill");
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
    // Between a near and a far thing, the far one; at the edges what is there; the sky is farthest.
    assert_eq!(fill(5, &[2.0, o, o, 9.0, o]), [2.0, 9.0, 9.0, 9.0, 9.0]);
    assert_eq!(fill(5, &[o, 9.0, o, o, 2.0]), [9.0, 9.0, 9.0, 9.0, 2.0]);
    assert_eq!(fill(4, &[INF, o, o, 2.0]), [INF, INF, INF, 2.0]);
    // On one surface, straight in 1/z, as a floor seen at a slant is.
    let floor = |x: usize| 1.0 / (0.2 + 0.002 * x as f32);
    let mut row: Vec<f32> = (0..10).map(floor).collect();
    row[4..8].fill(o);
    for (x, v) in fill(10, &row).into_iter().enumerate() {
        assert!((v / floor(x) - 1.0).abs() < 1e-6, "{x}: {v}");
    }
    // Rows of which nothing is known take the farther of those above and below.
    let rows = [1.0, 8.0, o, o, o, o, 3.0, 2.0];
    assert_eq!(fill(2, &rows), [1.0, 8.0, 3.0, 8.0, 3.0, 8.0, 3.0, 2.0]);
    assert_eq!(fill(2, &[o, o, 3.0, 2.0]), [3.0, 2.0, 3.0, 2.0]);
    assert_eq!(fill(2, &[3.0, 2.0, o, o]), [3.0, 2.0, 3.0, 2.0]);
    // One row whose far side is wrongly near makes no streak.
    let mut streak = [4.0, o, o, 1.0].repeat(9);
    streak[4 * 4] = 1.5;
    let filled = fill(4, &streak);
    for y in 0..9 {
        assert_eq!(filled[y * 4 + 1..y * 4 + 3], [4.0, 4.0], "{y}");
    }
    // What is known stays.
    assert_eq!(filled[16], 1.5);
}

#[test]
fn maps_and_pictures_must_be_as_large() {
    let folder = Folder::new("depth-size");
    let map = read_as(&folder, &grey_16((2, 3), &[5; 6]), &options()).unwrap();
    let path = folder.0.join("colour.png");
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
    // Tail lamp and bench of the motorcycle, 96 x 64 pixels: tests/data/README.md.
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
    // The room ends 6 m away, the lamp begins at 2 m.
    assert!(map.metres.iter().all(|z| (1.5..7.0).contains(z)));
}
