//! Fog over pictures in other primaries and with other pixels than square ones.

use super::common::{Folder, depth, layers, picture, scene};
use airlight::Named;
use airlight::spectrum::RgbSpace;
use airlight_image::Control;
use airlight_image::output::PictureFormat;
use airlight_render::overlay::{OverlayImage, PreparedOverlay};
use glam::Vec3;

/// Fog that is grey gives the same picture in all primaries.
#[test]
fn fog_is_the_same_light_in_all_primaries() {
    for &space in RgbSpace::ALL {
        assert_same_light_in(space);
    }
}

fn assert_same_light_in(space: RgbSpace) {
    let size = (4, 3);
    let colour = |x: u32, y: u32| [0.1 + 0.2 * x as f32, 0.5, 0.3 * y as f32];
    let plain = picture(size, colour);
    let mut wide = plain.clone();
    wide.chromaticities = Some(space.into());
    let to_srgb = wide.to_linear_srgb().unwrap_or_default().as_mat3();
    let from_srgb = to_srgb.inverse();
    for rgb in wide.rgb.as_chunks_mut::<3>().0 {
        *rgb = (from_srgb * Vec3::from(*rgb)).into();
    }
    let ambient = [0.9f32, 0.7, 0.4];
    let far = || depth(size, |x, y| 5.0 + (x + 4 * y) as f32);
    let as_f64 = |colour: [f32; 3]| colour.map(f64::from);
    let of = |picture, ambient| {
        let scene = scene(ambient);
        let image = OverlayImage::new(&scene.overlay, picture, far()).unwrap();
        layers(&scene, &image)
    };
    let narrow = of(plain, as_f64(ambient));
    let ambient = from_srgb * Vec3::from(ambient);
    let wide = of(wide, as_f64(ambient.into()));
    for (a, b) in narrow.0.iter().zip(&wide.0) {
        for at in [0, 6] {
            let converted = to_srgb * Vec3::new(b[at], b[at + 1], b[at + 2]);
            let expected = Vec3::new(a[at], a[at + 1], a[at + 2]);
            assert!(
                converted.abs_diff_eq(expected, 2e-6),
                "{converted} {expected}"
            );
        }
        assert!((a[4] - b[4]).abs() < 1e-6);
    }
}

/// Pixels twice as wide as high: the picture covers twice the angle across.
#[test]
fn pixel_shape_is_used_for_rays() {
    let mut wide = picture((4, 4), |_, _| [0.5; 3]);
    wide.pixel_aspect = 2.0;
    let mut scene = scene([0.5; 3]);
    scene.scene.camera.fov_deg = Some(90.0);
    let image = OverlayImage::new(&scene.overlay, wide, depth((4, 4), |_, _| 8.0)).unwrap();
    let layers = layers(&scene, &image);
    // The corner pixel: 3/4 of the half width, 1 at the edge; 3/8 up. Optical depth is proportional to distance.
    let ratio = |x, y| layers.pixel(x, y)[3].ln() / layers.pixel(1, 1)[3].ln();
    let [corner, inner] =
        [[0.75f32, 0.375], [0.25, 0.125]].map(|[x, y]| (1.0 + x * x + y * y).sqrt());
    assert!((ratio(0, 0) - corner / inner).abs() < 1e-5);
    assert_eq!(layers.pixel(0, 0)[9], 8.0);
}

/// Attributes of a file hold for its picture in fog, so that fog over the result has the same light.
#[test]
fn what_a_file_states_is_written_again() {
    let folder = Folder::new();
    let mut scene = scene([0.5; 3]);
    let mut colours = picture((4, 4), |_, _| [0.5, 0.25, -0.125]);
    colours.chromaticities = Some(RgbSpace::AcesCg.into());
    colours.white_luminance_cd_m2 = Some(100.0);
    colours.pixel_aspect = 2.0;
    let image = OverlayImage::new(&scene.overlay, colours, depth((4, 4), |_, _| 1e-9)).unwrap();
    let prepared = PreparedOverlay::new(&scene, &image, None).unwrap();
    let path = folder.file("out.exr");
    let rows = prepared.output(&scene, &image, PictureFormat::EXR).unwrap();
    rows.write(&path, Control::default()).unwrap();
    scene.overlay.colour = path;
    let again = OverlayImage::read(&scene, PictureFormat::EXR).unwrap();
    assert_eq!(again.picture.chromaticities, image.picture.chromaticities);
    assert_eq!(again.picture.white_luminance_cd_m2, Some(100.0));
    assert_eq!(again.picture.pixel_aspect, 2.0);
    assert_eq!(again.picture.rgb[2], -0.125);
}
