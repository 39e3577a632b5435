//! Steps before rows are drawn return an error when the caller cancels.

use super::common::{Folder, black, scene};
use airlight::Control;
use airlight::fog::FogScattering;
use airlight::scene::{FogProfile, Scene};
use airlight_image::output::PictureFormat;
use airlight_render::overlay::{OverlayImage, PreparedOverlay};
use airlight_render::probe::{Probe, ProbeRay};
use airlight_render::{RenderError, Renderer};
use std::sync::atomic::AtomicBool;

static CANCEL: AtomicBool = AtomicBool::new(true);

fn cancelled() -> Control<'static> {
    Control::cancelled_by(&CANCEL)
}

#[test]
fn the_light_in_an_overlay_is_cancelled() {
    let mut scene = scene([1.0; 3]);
    let fog = scene.fog_mut();
    fog.profile = Some(FogProfile::Height);
    fog.scattering = Some(FogScattering::Multiple);
    let image = black((8, 4), &scene.overlay);
    let error = PreparedOverlay::new_with(&scene, &image, None, cancelled()).unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    scene.overlay.colour = Folder::new().file("none.png");
    let error = OverlayImage::read_with(&scene, PictureFormat::PNG, cancelled()).unwrap_err();
    assert!(error.is_cancelled(), "{error}");
}

#[test]
fn views_of_frames_and_probes_are_cancelled() -> Result<(), RenderError> {
    let scene = Scene::from_toml("sun.elevation_deg = 20\nsolver.wavelengths = 'rgb'")?;
    let renderer = Renderer::new(&scene)?;
    let suns = renderer.suns_near(&renderer.sun(None)?);
    let prepared = renderer.prepare(suns, Control::default())?;
    let error = renderer
        .frame_with(prepared.as_ref(), None, cancelled())
        .unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    let ray = ProbeRay {
        azimuth_deg: 0.0,
        elevation_deg: 20.0,
        distance_m: None,
    };
    let error = Probe::new(&scene, vec![ray])?
        .answer(cancelled())
        .unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    Ok(())
}
