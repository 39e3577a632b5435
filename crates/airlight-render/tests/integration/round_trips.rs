//! Skies through files into fog: absolute radiance in every format and space.

use super::common::{Folder, depth};
use airlight::Named;
use airlight::scene::Scene;
use airlight::spectrum::RgbSpace;
use airlight_image::output::PictureFormat;
use airlight_image::{Control, Picture, read_picture};
use airlight_render::Renderer;
use airlight_render::overlay::{LightLevelSource, OverlayImage, OverlayScene, PreparedOverlay};
use glam::{DMat3, DVec3};
use std::path::Path;

const SIZE: (u32, u32) = (24, 16);

const SCENE: &str = "version = 1\nsolver.wavelengths = \"rgb\"\nsun = { elevation_deg = 20, azimuth_deg = 120 }\n\
    observer.eye_height_m = 2\noutput.sun_disc = \"out\"\n\
    [camera]\nprojection = \"perspective\"\nsize = [24, 16]\nfov_deg = 40\nazimuth_deg = 30\nelevation_deg = 18\n";

/// A picture in cd/m^2 in linear sRGB.
fn absolute(picture: &Picture) -> Vec<[f64; 3]> {
    let to_srgb = picture.to_linear_srgb().unwrap_or(DMat3::IDENTITY);
    let unit = f64::from(picture.white_luminance_cd_m2.unwrap());
    let pixels = picture.rgb.as_chunks::<3>().0.iter();
    pixels
        .map(|rgb| (to_srgb * DVec3::from_array(rgb.map(f64::from)) * unit).to_array())
        .collect()
}

/// Largest error of a colour in linear sRGB, relative to its largest value, by rounding in a file: half floats keep 11 bits; RGBE keeps
/// 8 bits, at least 7 of them significant, of the largest value. Conversion to sRGB adds the errors of three values.
fn rounding(format: PictureFormat, picture: &Picture) -> f64 {
    let to_srgb = picture.to_linear_srgb().unwrap_or(DMat3::IDENTITY);
    let rows = to_srgb.transpose().to_cols_array_2d();
    let sums = rows.map(|row| row.iter().map(|factor| factor.abs()).sum::<f64>());
    let most = sums.into_iter().fold(1.0, f64::max);
    match format.endings().contains(&"hdr") {
        true => (most / 256.0 + 1e-3).max(8e-3),
        false => (most / 2048.0).max(1e-3),
    }
}

fn write(scene: &Scene, path: &Path, space: RgbSpace, scale: f64) {
    let mut scene = scene.clone();
    scene.output.file = Some(path.to_str().unwrap().to_owned());
    scene.output.color_space = Some(space);
    scene.output.scale = Some(scale);
    let files = Renderer::new(&scene).unwrap().write(Control::default());
    assert_eq!(files.unwrap().len(), 1);
}

fn assert_same(got: &[[f64; 3]], want: &[[f64; 3]], limit: f64, case: &str) {
    assert_eq!(got.len(), want.len());
    for (got, want) in got.iter().zip(want) {
        let largest = want.iter().copied().fold(0.0, f64::max);
        for (a, b) in got.iter().zip(want) {
            assert!((a - b).abs() / largest < limit, "{case}: {got:?} {want:?}");
        }
    }
}

/// A sky drawn clear, written, read and put into fog, written and read again, is the sky drawn in fog, in cd/m^2.
#[test]
fn skies_keep_their_radiance_through_files_and_fog() {
    let folder = Folder::new();
    let clear = Scene::from_toml(SCENE).unwrap();
    let mut fog = OverlayScene::default();
    fog.overlay.sky_light = true;
    fog.scene = clear.clone();
    fog.scene.output = Default::default();
    fog.scene.camera.size = None;
    fog.scene.camera.projection = None;
    fog.fog_mut().visibility_m = Some(300.0);
    fog.fog_mut().top_m = Some(40.0);
    let sky = fog.solve_sky().unwrap().unwrap();

    let mut foggy = clear.clone();
    foggy.fog = fog.scene.fog.clone();
    let drawn = folder.file("drawn.exr");
    write(&foggy, &drawn, RgbSpace::Srgb, 1.0);
    let drawn = absolute(&read_picture(&drawn, None).unwrap());
    let plain = folder.file("plain.exr");
    write(&clear, &plain, RgbSpace::Srgb, 1.0);
    let plain = absolute(&read_picture(&plain, None).unwrap());

    for &space in RgbSpace::ALL {
        for from in [PictureFormat::EXR, PictureFormat::HDR] {
            for scale in [1.0, 1e-3] {
                let case = format!("{space}, {from}, times {scale}");
                let path = folder.file(format!("clear.{}", from.endings()[0]));
                write(&clear, &path, space, scale);
                let picture = read_picture(&path, None).unwrap();
                let rounded = rounding(from, &picture);
                assert_same(&absolute(&picture), &plain, rounded, &case);
                let far = depth(SIZE, |_, _| f32::INFINITY);
                let image = OverlayImage::new(&fog.overlay, picture, far).unwrap();
                let prepared = PreparedOverlay::new(&fog, &image, Some(&sky)).unwrap();
                assert_eq!(prepared.level.source, LightLevelSource::FileWhite, "{case}");
                for to in [PictureFormat::EXR, PictureFormat::HDR] {
                    let path = folder.file(format!("foggy.{}", to.endings()[0]));
                    let rows = prepared.output(&fog, &image, to).unwrap();
                    rows.write(&path, Control::default()).unwrap();
                    let seen = read_picture(&path, None).unwrap();
                    let limit = rounded + rounding(to, &seen) + 2e-3;
                    // Fog over a picture and fog in a sky agree to 0.2 %.
                    assert_same(&absolute(&seen), &drawn, limit, &case);
                }
            }
        }
    }
}
