//! Formats of depth maps.

use crate::common::{Folder, files::*, size};
use airlight_image::{
    DepthOptions, ImageError,
    input::{DepthKind, SampleBits},
};
use exr::prelude::{FlatSamples, f16};
use png::{BitDepth, ColorType};

fn options() -> DepthOptions {
    DepthOptions::default()
}

#[test]
fn png_depth_of_8_and_16_bits() {
    let folder = Folder::new();
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
    let folder = Folder::new();
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
        assert!(matches!(error, ImageError::Read { .. }), "{error}");
        assert!(error.to_string().contains(said), "{error}");
    }
    let short = npy_file(1, "'<f4'", false, "(2, 3)", &[0; 23]);
    let error = read_as(&folder, &short, &options()).unwrap_err();
    assert!(matches!(error, ImageError::EndsEarly { .. }));
    assert!(error.to_string().contains("24 bytes of samples"), "{error}");
}

#[test]
fn pfm_depth_from_the_bottom_up() {
    let folder = Folder::new();
    let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    for little in [false, true] {
        let map = read_as(&folder, &pfm_file((3, 2), little, &rows), &options()).unwrap();
        assert_eq!((map.size, map.metres.as_slice()), (size(3, 2), &rows[..]));
        assert_eq!(map.bits, SampleBits::Float);
    }
    for (start, said) in [
        ("PF\n1 1\n-1\n", "got colours"),
        ("Pf\n1 x\n-1\n", "`x`"),
        ("Pf\n1 0\n-1\n", "1 x 0"),
        ("Pf\n1 1\n0\n", "byte order"),
        ("Pf5\n1 1\n-1\n", "expected `Pf`"),
        ("Pf\n1 \u{7} \n", "text header"),
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
    let folder = Folder::new();
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
        &["X", "Y", "Z"][..],
        &["a.Depth.Z", "b.Depth.Z"],
        &["N.X", "N.Y", "N.Z"],
    ] {
        let error = first(&file(names), &options()).unwrap_err();
        let ImageError::NoChannel { available, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(*available, names.join(", "));
        assert!(error.to_string().contains("try depth-channel"), "{error}");
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
fn archives_of_arrays_and_tiff() {
    let folder = Folder::new();
    let values = [1.5f32, 2.0, 3.0, 4.0, 5.0, 6.0];
    let data: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let array = |shape| npy_file(1, "'<f4'", false, shape, &data);
    let named = |channel: &str| DepthOptions {
        channel: Some(channel.to_owned()),
        ..options()
    };
    for deflated in [false, true] {
        let one = npz_file(&[("arr_0.npy", array("(2, 3)"))], deflated);
        let map = read_as(&folder, &one, &options()).unwrap();
        assert_eq!((map.size, map.metres.as_slice()), (size(3, 2), &values[..]));
        let arrays = [("rgb.npy", array("(6,)")), ("Depth.npy", array("(3, 2)"))];
        let two = npz_file(&arrays, deflated);
        assert_eq!(read_as(&folder, &two, &options()).unwrap().size, size(2, 3));
        assert_eq!(
            read_as(&folder, &two, &named("Depth")).unwrap().size,
            size(2, 3)
        );
        let error = read_as(&folder, &two, &named("z")).unwrap_err().to_string();
        assert!(
            error.contains("no array `z`") && error.contains("rgb, Depth"),
            "{error}"
        );
    }
    let unclear = npz_file(
        &[("a.npy", array("(2, 3)")), ("b.npy", array("(2, 3)"))],
        false,
    );
    let error = read_as(&folder, &unclear, &options())
        .unwrap_err()
        .to_string();
    assert!(error.contains("depth-channel"), "{error}");
    let map = read_as(&folder, &tiff_file((3, 2), &values), &options()).unwrap();
    assert_eq!(
        (map.metres.as_slice(), map.bits),
        (&values[..], SampleBits::Float)
    );
}

#[test]
fn pfm_files_with_line_ends_of_two_characters() {
    let folder = Folder::new();
    let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let plain = pfm_file((3, 2), true, &rows);
    let header_end = plain.len() - 24;
    let header = String::from_utf8(plain[..header_end].to_vec()).unwrap();
    let mut bytes = header.replace('\n', "\r\n").into_bytes();
    bytes.extend(&plain[header_end..]);
    assert_eq!(read_as(&folder, &bytes, &options()).unwrap().metres, rows);
}

#[test]
fn grey_exr_pictures_are_depth_in_a_file_of_their_own() {
    let folder = Folder::new();
    let one = |v: f32| FlatSamples::F32(vec![v]);
    let file = |b: f32| {
        let channels = vec![("B", one(b)), ("G", one(7.0)), ("R", one(7.0))];
        exr_file((0, 0, 1, 1), vec![Part::new((1, 1), channels)])
    };
    assert_eq!(
        read_as(&folder, &file(7.0), &options()).unwrap().metres,
        [7.0]
    );
    let error = read_as(&folder, &file(8.0), &options())
        .unwrap_err()
        .to_string();
    assert!(error.contains("got colours"), "{error}");
    let inside = DepthOptions {
        grey_is_depth: false,
        ..options()
    };
    let error = read_as(&folder, &file(7.0), &inside)
        .unwrap_err()
        .to_string();
    assert!(error.contains("clearly depth"), "{error}");
}
