//! Linear pictures in fog as PNG: exposure and tone curve.

use super::common::{Folder, depth, picture, scene};
use airlight::scene::{Exposure, MeteringMode, ToneKind};
use airlight::spectrum::rgb::srgb_encode;
use airlight_image::input::Picture;
use airlight_image::output::PictureFormat;
use airlight_image::tone::{self, CameraSettings, MIDDLE_GREY, ToneCurve, ToneMapper};
use airlight_image::{Control, RowSource};
use airlight_render::overlay::{OverlayImage, OverlayScene, PreparedOverlay};

const SIZE: (u32, u32) = (12, 8);
/// Luminance of 1 in a picture that states no unit: the saturation of EV 15.
const SUNNY_CD_M2: f64 = 1.2 * 32768.0;

/// No fog to speak of, and an ambient light.
fn clear(ambient: f64) -> OverlayScene {
    let mut scene = scene([ambient; 3]);
    scene.overlay.layers = false;
    scene.fog_mut().visibility_m = Some(1e9);
    scene
}

fn colours() -> Picture {
    picture(SIZE, |x, y| [0.02 + 0.1 * x as f32, 0.3, 0.1 * y as f32])
}

/// The PNG of a picture 2 m away, 16 bits per component.
fn png(scene: &OverlayScene, picture: Picture) -> Vec<u16> {
    let folder = Folder::new();
    let near = depth(SIZE, |_, _| 2.0);
    let image = OverlayImage::new(&scene.overlay, picture, near).unwrap();
    let prepared = PreparedOverlay::new(scene, &image, None).unwrap();
    let rows = prepared.output(scene, &image, PictureFormat::PNG).unwrap();
    let path = folder.file("a.png");
    rows.write(&path, Control::default()).unwrap();
    image::open(path).unwrap().into_rgb16().into_raw()
}

/// Factor on cd/m^2 with which a picture is exposed, `metres` away.
fn factor(scene: &OverlayScene, picture: Picture, metres: impl Fn(u32, u32) -> f32) -> f64 {
    let image = OverlayImage::new(&scene.overlay, picture, depth(SIZE, metres)).unwrap();
    let prepared = PreparedOverlay::new(scene, &image, None).unwrap();
    let rows = prepared.output(scene, &image, PictureFormat::PNG).unwrap();
    rows.exposure().unwrap().factor()
}

fn near(got: &[u16], expected: &[f32]) {
    for (got, expected) in got.iter().zip(expected) {
        let expected = 65535.0 * expected;
        assert!((f32::from(*got) - expected).abs() < 2.0, "{got} {expected}");
    }
}

/// The same exposure, curve and encoding as a sky of the same light.
#[test]
fn light_in_a_stated_unit_is_shown_as_a_sky_of_that_luminance() {
    let mut scene = clear(0.5);
    let mut lit = colours();
    lit.white_luminance_cd_m2 = Some(100.0);
    let output = &mut scene.scene.output;
    output.exposure = Some(Exposure::Ev100(6.5));
    output.brighten = Some(0.5);
    output.saturation = Some(0.8);
    let curve = CameraSettings {
        saturation: 0.8,
        ..CameraSettings::default()
    };
    let exposed = tone::Exposure::from_ev100(6.0).unwrap();
    let mapper = ToneMapper::new(exposed.factor() as f32, ToneCurve::Camera(curve)).unwrap();
    let pixels = lit.rgb.as_chunks::<3>().0.iter();
    let expected: Vec<f32> = pixels
        .flat_map(|rgb| mapper.map(rgb.map(|v| 100.0 * v)))
        .collect();
    near(&png(&scene, lit), &expected);
}

#[test]
fn light_without_a_unit_is_that_of_a_sunny_day() {
    let mut scene = clear(0.5);
    scene.scene.output.exposure = Some(Exposure::Ev100(15.0));
    scene.scene.output.tone = Some(ToneKind::Clip);
    let encode = |v: &f32| srgb_encode(f64::from(v.min(1.0))) as f32;
    let plain = colours();
    let expected: Vec<f32> = plain.rgb.iter().map(encode).collect();
    near(&png(&scene, plain), &expected);
}

#[test]
fn exposure_is_metered_from_the_picture_in_fog() {
    let even = || picture(SIZE, |_, _| [0.25; 3]);
    let metered = |mode| {
        let mut scene = clear(0.8);
        scene.scene.output.exposure = Some(Exposure::Metered(mode));
        scene
    };
    let shown = |factor: f64, light: f64| factor * light * SUNNY_CD_M2;
    for mode in [
        MeteringMode::Average,
        MeteringMode::Spot,
        MeteringMode::Evaluative,
    ] {
        let value = shown(factor(&metered(mode), even(), |_, _| 2.0), 0.25);
        assert!((value / MIDDLE_GREY - 1.0).abs() < 1e-5, "{mode}: {value}");
    }
    // A white card in the ambient light is white.
    let incident = metered(MeteringMode::Incident);
    let value = shown(factor(&incident, even(), |_, _| 2.0), 0.8);
    assert!((value - 1.0).abs() < 1e-5, "{value}");
    // Sky is brighter than middle grey; thick fog is metered, not what it hides.
    let auto = clear(0.8);
    let [ground, sky] = [2.0, f32::INFINITY].map(|m| factor(&auto, even(), |_, _| m));
    assert!(
        (sky / ground - 2.0 * 0.25 / 0.8).abs() < 1e-4,
        "{}",
        sky / ground
    );
    let mut hidden = metered(MeteringMode::Average);
    hidden.fog_mut().visibility_m = Some(0.1);
    let value = shown(factor(&hidden, even(), |_, _| 2.0), 0.8);
    assert!((value / MIDDLE_GREY - 1.0).abs() < 1e-5, "{value}");
}

/// Linear files keep the light.
#[test]
fn linear_outputs_have_no_exposure() {
    let scene = clear(0.5);
    let near = depth(SIZE, |_, _| 1e-9);
    let image = OverlayImage::new(&scene.overlay, colours(), near).unwrap();
    let prepared = PreparedOverlay::new(&scene, &image, None).unwrap();
    for format in [PictureFormat::EXR, PictureFormat::HDR] {
        let rows = prepared.output(&scene, &image, format).unwrap();
        assert_eq!(rows.exposure(), None);
        let mut row = vec![0.0; 3 * SIZE.0 as usize];
        rows.fill_row(5, &mut row);
        assert_eq!(row, image.picture.rgb[5 * row.len()..][..row.len()]);
    }
}
