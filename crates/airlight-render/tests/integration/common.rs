//! Folders that are removed at the end, pictures in memory, fog over them, and their layers.

use airlight_image::input::{DepthKind, DepthMap, LightReference, Picture, SampleBits};
use airlight_image::{RowSource, Size};
use airlight_render::overlay::{Overlay, OverlayImage, OverlayScene, OverlaySpec, PreparedOverlay};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of a test's own. The tests of all modules share one process, and so one count.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!(
            "airlight-render-{}-{}",
            std::process::id(),
            COUNT.fetch_add(1, Ordering::Relaxed)
        );
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Names of the files in a folder below it (`""`: in itself), hidden ones too.
    pub fn names(&self, below: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.file(below)).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

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
