//! Whole scenes, solved and drawn.

mod monte_carlo;
mod objects;
mod pictures;
mod probe;
mod published;
mod sequence;

pub use super::common::Folder;
use airlight::scene::Scene;
use airlight_image::{Control, Frame, Projection};
use airlight_render::probe::{Probe, ProbeAnswer, ProbeRay};
use airlight_render::{RenderError, RenderedImage, Renderer, WrittenFile};
use std::collections::BTreeMap;
use std::path::Path;

/// Writing scenes into a folder.
impl Folder {
    /// Writes a scene to a file of a name.
    pub fn write(&self, name: &str, scene: &str) -> Vec<WrittenFile> {
        self.try_write(name, scene)
            .unwrap_or_else(|error| panic!("{scene}: {error}"))
    }

    pub fn try_write(&self, name: &str, scene: &str) -> Result<Vec<WrittenFile>, RenderError> {
        let mut scene = parse(scene);
        scene.output.file = Some(self.file(name).to_str().unwrap().to_owned());
        Renderer::new(&scene)?.write(Control::default())
    }

    /// Writes a scene as EXR and reads it.
    pub fn exr(&self, scene: &str) -> Exr {
        self.write("a.exr", scene);
        Exr::read(&self.file("a.exr"))
    }
}

/// A scene from lines of TOML; those of the same key later override earlier ones.
pub fn parse(text: &str) -> Scene {
    let mut lines: BTreeMap<&str, &str> = BTreeMap::new();
    let mut tables = String::new();
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        match line
            .split_once('=')
            .filter(|_| tables.is_empty() && !line.starts_with('['))
        {
            Some((key, value)) => {
                lines.insert(key.trim(), value.trim());
            }
            None => tables.push_str(&format!("{line}\n")),
        }
    }
    let keys: String = lines
        .iter()
        .map(|(key, value)| format!("{key} = {value}\n"))
        .collect();
    let text = keys + &tables;
    Scene::from_toml(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

pub fn render(scene: &str) -> RenderedImage {
    let renderer = Renderer::new(&parse(scene)).unwrap_or_else(|error| panic!("{scene}: {error}"));
    renderer
        .render(Control::default())
        .unwrap_or_else(|error| panic!("{scene}: {error}"))
}

/// Probes a scene along azimuths and elevations.
pub fn probe(scene: &str, rays: &[(f64, f64)]) -> ProbeAnswer {
    let rays = rays.iter().map(|&(azimuth_deg, elevation_deg)| ProbeRay {
        azimuth_deg,
        elevation_deg,
        distance_m: None,
    });
    try_probe(scene, rays.collect()).unwrap_or_else(|error| panic!("{scene}: {error}"))
}

pub fn try_probe(scene: &str, rays: Vec<ProbeRay>) -> Result<ProbeAnswer, RenderError> {
    Probe::new(&parse(scene), rays)?.answer(Control::default())
}

/// Azimuths and elevations of the centres of pixels.
pub fn rays_of(frame: &Frame, pixels: &[(u32, u32)]) -> Vec<(f64, f64)> {
    let ray = |&(x, y): &(u32, u32)| {
        let direction = frame.pixel_direction(x, y).unwrap();
        (
            airlight::axes::azimuth_deg(direction),
            airlight::axes::elevation_deg(direction),
        )
    };
    pixels.iter().map(ray).collect()
}

pub fn equirectangular(width: u32, height: u32) -> Frame {
    let projection = Projection::Equirectangular {
        center_azimuth_deg: 0.0,
    };
    Frame::new(projection, width, height).unwrap()
}

/// An EXR file's samples and texts.
pub struct Exr {
    pub width: u32,
    pub height: u32,
    pub channels: BTreeMap<String, Vec<f32>>,
    pub texts: BTreeMap<String, String>,
    pub attributes: exr::meta::header::LayerAttributes,
    pub shared: exr::meta::header::ImageAttributes,
    pub is_half: bool,
}

impl Exr {
    pub fn read(path: &Path) -> Self {
        use exr::prelude::*;
        let image = read_first_flat_layer_from_file(path).unwrap();
        let layer = image.layer_data;
        let text = |value: &AttributeValue| match value {
            AttributeValue::Text(text) => Some(text.to_string()),
            _ => None,
        };
        Self {
            width: layer.size.0 as u32,
            height: layer.size.1 as u32,
            is_half: matches!(layer.channel_data.list[0].sample_data, FlatSamples::F16(_)),
            channels: layer
                .channel_data
                .list
                .iter()
                .map(|channel| {
                    (
                        channel.name.to_string(),
                        channel.sample_data.values_as_f32().collect(),
                    )
                })
                .collect(),
            texts: layer
                .attributes
                .other
                .iter()
                .filter_map(|(name, value)| Some((name.to_string(), text(value)?)))
                .collect(),
            attributes: layer.attributes,
            shared: image.attributes,
        }
    }

    pub fn rgb(&self, x: u32, y: u32) -> [f32; 3] {
        let at = (y * self.width + x) as usize;
        ["R", "G", "B"].map(|name| self.channels[name][at])
    }

    /// Luminance of linear sRGB.
    pub fn luminance(&self, x: u32, y: u32) -> f64 {
        let [r, g, b] = self.rgb(x, y).map(f64::from);
        0.212_639 * r + 0.715_169 * g + 0.072_192 * b
    }

    /// Sum over the pixels of luminance, solid angle and a weight of the direction.
    pub fn sum(&self, frame: &Frame, weight: impl Fn(glam::DVec3) -> f64) -> f64 {
        let mut sum = 0.0;
        for y in 0..self.height {
            for x in 0..self.width {
                if let Some(direction) = frame.pixel_direction(x, y) {
                    sum += self.luminance(x, y) * frame.pixel_solid_angle(x, y) * weight(direction);
                }
            }
        }
        sum
    }
}
