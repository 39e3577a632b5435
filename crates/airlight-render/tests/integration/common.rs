//! Pictures in memory, fog over them, and their layers.

#[path = "../../../airlight-image/tests/integration/common/folder.rs"]
mod folder;

pub use folder::Folder;

use airlight_image::input::{DepthKind, DepthMap, LightReference, Picture, SampleBits};
use airlight_image::{RowSource, Size};
use airlight_render::overlay::{Overlay, OverlayImage, OverlayScene, OverlaySpec, PreparedOverlay};

/// A linear picture.
pub fn picture((width, height): (u32, u32), rgb: impl Fn(u32, u32) -> [f32; 3]) -> Picture {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let size = Size::new(width, height).unwrap();
    let rgb = pixels.flat_map(|(x, y)| rgb(x, y)).collect();
    Picture::new(size, rgb, LightReference::Scene, SampleBits::Float)
}

/// A map of depths along the camera's axis.
pub fn depth((width, height): (u32, u32), metres: impl Fn(u32, u32) -> f32) -> DepthMap {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let size = Size::new(width, height).unwrap();
    let metres = pixels.map(|(x, y)| metres(x, y)).collect();
    DepthMap::new(size, metres, DepthKind::Z)
}

/// A black picture, 10 m away everywhere.
pub fn black(size: (u32, u32), spec: &OverlaySpec) -> OverlayImage {
    let picture = picture(size, |_, _| [0.0; 3]);
    OverlayImage::new(spec, picture, depth(size, |_, _| 10.0)).unwrap()
}

/// Isotropic fog of 20 m visibility in an ambient light.
pub fn scene(ambient: [f64; 3]) -> OverlayScene {
    let mut scene = OverlayScene::default();
    scene.overlay.layers = true;
    scene.overlay.ambient = Some(ambient);
    let fog = scene.fog_mut();
    fog.visibility_m = Some(20.0);
    fog.droplets = Some(airlight::fog::droplets::DropletKind::Isotropic);
    scene
}

/// Pixels of an overlay with layers: colour, transmittance, path radiance, distance.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers(pub Vec<[f32; 10]>, pub u32);

impl Layers {
    pub fn of(overlay: &Overlay<'_>) -> Self {
        let size = overlay.size();
        let mut row = vec![0.0; 10 * size.width() as usize];
        let mut pixels = Vec::new();
        for y in 0..size.height() {
            overlay.fill_row(y, &mut row);
            pixels.extend(row.as_chunks::<10>().0);
        }
        Self(pixels, size.width())
    }

    pub fn pixel(&self, x: u32, y: u32) -> [f32; 10] {
        self.0[(y * self.1 + x) as usize]
    }

    pub fn rgb(&self, x: u32, y: u32) -> [f32; 3] {
        let [r, g, b, ..] = self.pixel(x, y);
        [r, g, b]
    }

    /// One channel of all pixels.
    pub fn channel(&self, channel: usize) -> impl Iterator<Item = f32> {
        self.0.iter().map(move |pixel| pixel[channel])
    }

    /// Path radiance over opacity in each pixel, green.
    pub fn sources(&self) -> impl Iterator<Item = f64> {
        let source = |pixel: &[f32; 10]| f64::from(pixel[7]) / (1.0 - f64::from(pixel[4]));
        self.0.iter().map(source)
    }
}

/// The layers of a description over a picture.
pub fn layers(scene: &OverlayScene, image: &OverlayImage) -> Layers {
    scene.check().unwrap();
    let sky = scene.solve_sky().unwrap();
    let prepared = PreparedOverlay::new(scene, image, sky.as_ref()).unwrap();
    Layers::of(&prepared.overlay(image).unwrap())
}
