//! OpenEXR pictures: kinds of samples and compression, windows, layers and parts.

use crate::common::{Folder, files, files::*, size};
use airlight_image::{
    Control, DepthOptions, ImageError, Picture,
    input::{ExrLayer, LightReference, SampleBits, read_picture},
    output::{self, Metadata, exr::ExrOptions},
    rows::StoredRows,
};
use exr::prelude::{Compression, FlatSamples, f16};

fn read_as(folder: &Folder, bytes: &[u8], layer: Option<&str>) -> Result<Picture, ImageError> {
    let path = folder.file("input.bin");
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
    let folder = Folder::new();
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
    let folder = Folder::new();
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
    let folder = Folder::new();
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
    assert!(error.contains("try colour-layer"), "{error}");
    // The Y of a position is not luminance.
    let position = rgb(["X", "Y", "Z"], 1.0);
    assert!(first(&file(position), None).is_err());
}

#[test]
fn invalid_samples_are_repaired_and_counted() {
    let folder = Folder::new();
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

#[test]
fn depth_is_that_of_the_view_of_the_colours() {
    let folder = Folder::new();
    let one = |v: f32| FlatSamples::F32(vec![v]);
    let colours = || vec![("B", one(1.0)), ("G", one(1.0)), ("R", one(1.0))];
    let depth = |v| vec![("Z", one(v))];
    let part = |channels| Part::new((1, 1), channels);
    let depth_of = |bytes: &[u8], layer: Option<&ExrLayer>| {
        let options = DepthOptions {
            beside: layer.cloned(),
            ..DepthOptions::default()
        };
        files::read_as(&folder, bytes, &options).map(|map| map.metres[0])
    };
    let right = exr_file(
        (0, 0, 1, 1),
        vec![
            part(colours()).named("a").of_view("right"),
            part(depth(10.0)).named("b").of_view("left"),
            part(colours()).named("c").of_view("left"),
            part(depth(100.0)).named("d").of_view("right"),
        ],
    );
    let picture = read_as(&folder, &right, None).unwrap();
    assert_eq!(depth_of(&right, picture.layer.as_ref()).unwrap(), 100.0);
    let left = read_as(&folder, &right, Some("c")).unwrap();
    assert_eq!(depth_of(&right, left.layer.as_ref()).unwrap(), 10.0);
    let error = depth_of(&right, None).unwrap_err().to_string();
    assert!(error.contains("several views"), "{error}");
    // No depth of the colours' view.
    let other = exr_file(
        (0, 0, 1, 1),
        vec![
            part(colours()).named("a").of_view("right"),
            part(depth(10.0)).named("b").of_view("left"),
        ],
    );
    let picture = read_as(&folder, &other, None).unwrap();
    let error = depth_of(&other, picture.layer.as_ref()).unwrap_err();
    assert!(error.to_string().contains("view `right`"), "{error}");
}

#[test]
fn the_combined_layer_is_preferred_and_has_its_depth() {
    let folder = Folder::new();
    let one = |v: f32| FlatSamples::F32(vec![v]);
    let mut channels = Vec::new();
    for (v, names) in [
        (1.0, ["A.Combined.R", "A.Combined.G", "A.Combined.B"]),
        (2.0, ["A.DiffCol.R", "A.DiffCol.G", "A.DiffCol.B"]),
    ] {
        channels.extend(names.map(|name| (name, one(v))));
    }
    channels.push(("A.Depth.Z", one(10.0)));
    let single = exr_file((0, 0, 1, 1), vec![Part::new((1, 1), channels.clone())]);
    let picture = read_as(&folder, &single, None).unwrap();
    assert_eq!(picture.rgb, [1.0; 3]);
    let albedo = read_as(&folder, &single, Some("A.DiffCol")).unwrap();
    assert_eq!(albedo.rgb, [2.0; 3]);
    // Two layers: none is preferred, and each has its own depth.
    channels.extend(["B.Combined.R", "B.Combined.G", "B.Combined.B"].map(|name| (name, one(3.0))));
    channels.push(("B.Depth.Z", one(30.0)));
    let double = exr_file((0, 0, 1, 1), vec![Part::new((1, 1), channels)]);
    let error = read_as(&folder, &double, None).unwrap_err().to_string();
    assert!(error.contains("try colour-layer"), "{error}");
    for (layer, expected) in [("A.Combined", 10.0), ("B.Combined", 30.0)] {
        let picture = read_as(&folder, &double, Some(layer)).unwrap();
        let options = DepthOptions {
            beside: picture.layer,
            ..DepthOptions::default()
        };
        let map = files::read_as(&folder, &double, &options).unwrap();
        assert_eq!(map.metres, [expected]);
    }
}

/// Bytes of an uncompressed file of luminance and chroma at every other pixel, in blocks of one line.
fn luma_chroma_file(
    (width, height): (usize, usize),
    rgb: impl Fn(usize, usize) -> [f32; 3],
) -> Vec<u8> {
    let weights = [0.212_639, 0.715_168_7, 0.072_192_3];
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend(name.bytes().chain([0]).chain(kind.bytes()).chain([0]));
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
    };
    let mut list = Vec::new();
    for (name, step) in [("BY", 2u32), ("RY", 2), ("Y", 1)] {
        list.extend(name.bytes().chain([0, 2, 0, 0, 0, 0, 0, 0, 0]));
        list.extend(step.to_le_bytes().iter().chain(&step.to_le_bytes()));
    }
    list.push(0);
    let window: Vec<u8> = [0, 0, width as i32 - 1, height as i32 - 1]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    bytes.push(0);
    let mut at = (bytes.len() + 8 * height) as u64;
    let mut table = Vec::new();
    let mut blocks = Vec::new();
    for y in 0..height {
        let luma = |x: usize| -> f32 { rgb(x, y).iter().zip(weights).map(|(v, w)| v * w).sum() };
        let chroma = |x: usize, c: usize| (rgb(x, y)[c] - luma(x)) / luma(x);
        let mut data = Vec::new();
        if y % 2 == 0 {
            for c in [2, 0] {
                data.extend(
                    (0..width)
                        .step_by(2)
                        .flat_map(|x| chroma(x, c).to_le_bytes()),
                );
            }
        }
        data.extend((0..width).flat_map(|x| luma(x).to_le_bytes()));
        table.extend(at.to_le_bytes());
        at += 8 + data.len() as u64;
        blocks.extend((y as u32).to_le_bytes());
        blocks.extend((data.len() as u32).to_le_bytes());
        blocks.extend(data);
    }
    bytes.extend(table);
    bytes.extend(blocks);
    bytes
}

#[test]
fn luminance_and_chroma_become_red_green_and_blue() {
    let folder = Folder::new();
    let expected = [0.5f32, 0.25, 0.125];
    // By the definition of the OpenEXR documentation, with the weights of BT.709 primaries.
    let file = |rgb: &dyn Fn(usize, usize) -> [f32; 3]| {
        let bytes = luma_chroma_file((8, 6), rgb);
        read_as(&folder, &bytes, None).unwrap()
    };
    let picture = file(&|_, _| expected);
    assert_eq!(picture.size, size(8, 6));
    for rgb in picture.rgb.chunks(3) {
        for (got, expected) in rgb.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-5, "{rgb:?}");
        }
    }
    assert!(picture.notes.to_string().contains("luminance and chroma"));
    // Chroma that changes linearly is interpolated; beyond its last sample it is constant.
    let wedge = |x: usize, y: usize| {
        let red = 1.0 + 0.02 * x as f32 + 0.03 * y as f32;
        [
            red,
            (1.0 - 0.212_639 * red - 0.072_192_3) / 0.715_168_7,
            1.0,
        ]
    };
    let picture = file(&wedge);
    for y in 0..5 {
        for x in 0..7 {
            let got = picture.rgb[(y * 8 + x) * 3];
            assert!((got - wedge(x, y)[0]).abs() < 1e-5, "{x} {y}: {got}");
        }
    }
    assert!((picture.rgb[(5 * 8 + 7) * 3] - wedge(6, 4)[0]).abs() < 1e-5);
}

#[test]
fn attributes_channels_and_windows_are_carried() {
    use exr::prelude::*;
    let folder = Folder::new();
    let count = 6 * 4;
    let ids: Vec<u32> = (0..count as u32).map(|i| 0xfff0_0001 + i).collect();
    let halves =
        |from: f32| FlatSamples::F16((0..count).map(|i| f16::from_f32(from + i as f32)).collect());
    let list = vec![
        AnyChannel::new("R", halves(0.0)),
        AnyChannel::new("G", halves(1.0)),
        AnyChannel::new("B", halves(2.0)),
        AnyChannel::new("Z", FlatSamples::F32(vec![7.25; count])),
        AnyChannel::new("id", FlatSamples::U32(ids.clone())),
        AnyChannel::new("N.X", halves(-3.0)),
    ];
    let mut own = LayerAttributes {
        owner: Some("me".into()),
        layer_position: Vec2(5, 7),
        screen_window_width: 3.0,
        world_to_camera: Some([2.0; 16]),
        preview: Some(exr::meta::attribute::Preview {
            size: Vec2(1, 1),
            pixel_data: vec![1; 4],
        }),
        ..LayerAttributes::default()
    };
    own.other.insert("shot".into(), AttributeValue::I32(12));
    let layer = Layer::new(
        (6, 4),
        own,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.into()),
    );
    let mut attributes = ImageAttributes::new(IntegerBounds::new(Vec2(5, 7), Vec2(6, 4)));
    attributes.pixel_aspect = 2.0;
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = Image {
        attributes,
        layer_data: layer,
    };
    image
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .unwrap();
    let picture = read_as(&folder, &bytes.into_inner(), None).unwrap();
    assert_eq!(picture.pixel_aspect, 2.0);
    let doubled = picture.rgb.iter().map(|v| 2.0 * v).collect();
    let metadata = Metadata {
        pixel_aspect: Some(picture.pixel_aspect),
        carried: picture.carried.clone(),
        ..Metadata::default()
    };
    let path = folder.file("out.exr");
    let rows = StoredRows::new(6, 3, doubled).unwrap();
    let (options, control) = (ExrOptions::default(), Control::default());
    output::exr::write(
        &path,
        picture.size,
        &["R", "G", "B"],
        &rows,
        &options,
        &metadata,
        control,
    )
    .unwrap();
    let written = read_first_flat_layer_from_file(&path).unwrap();
    let channel = |name: &str| {
        let mut list = written.layer_data.channel_data.list.iter();
        &list.find(|c| c.name == *name).unwrap().sample_data
    };
    assert_eq!(channel("id"), &FlatSamples::U32(ids));
    assert_eq!(channel("Z"), &FlatSamples::F32(vec![7.25; count]));
    assert_eq!(channel("N.X"), &halves(-3.0));
    assert_eq!(channel("G").values_as_f32().nth(3), Some(8.0));
    let (shared, own) = (&written.attributes, &written.layer_data.attributes);
    assert_eq!(shared.pixel_aspect, 2.0);
    assert_eq!(
        shared.display_window,
        IntegerBounds::new(Vec2(5, 7), Vec2(6, 4))
    );
    assert_eq!(own.owner, Some("me".into()));
    assert_eq!(
        (own.screen_window_width, own.world_to_camera),
        (3.0, Some([2.0; 16]))
    );
    assert_eq!(
        own.other.get(&Text::from("shot")),
        Some(&AttributeValue::I32(12))
    );
    // A thumbnail shows the original colours.
    assert_eq!(own.preview, None);
    // The names of carried channels are taken.
    let taken = ["R", "G", "Z"];
    assert!(
        output::exr::write(
            &path,
            picture.size,
            &taken,
            &rows,
            &options,
            &metadata,
            control
        )
        .is_err()
    );
    let without = picture.carried.unwrap().without_channels(&["Z"]);
    assert_eq!(without.channel_names().collect::<Vec<_>>(), ["N.X", "id"]);
}
