//! Lines of a manifest.

use super::Input;
use crate::manifest::MANIFEST_VERSION;
use crate::overlay::{LightLevelSource, OverlayImage, OverlayScene, PreparedOverlay};
use airlight_image::tone::Exposure;
use serde::Serialize;
use std::collections::BTreeMap;

/// The line of a picture.
#[derive(Serialize)]
pub(super) struct Record<'a> {
    /// Output relative to the manifest's folder. This is the first key, by which a manifest is recognised.
    output: &'a str,
    manifest_version: u32,
    name: String,
    #[serde(flatten)]
    which: Which,
    /// The description of the picture: its settings and files.
    scene: &'a OverlayScene,
    #[serde(flatten)]
    outcome: Outcome<'a>,
    airlight: &'static str,
}

/// What distinguishes a picture from the others of its input.
#[derive(Serialize)]
pub(super) struct Which {
    /// Number of the draw.
    pub variant: u32,
    /// Values of the settings of which every picture gets each.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub each: BTreeMap<&'static str, super::vary::Value>,
}

/// Result of the picture.
#[derive(Serialize)]
#[serde(untagged)]
enum Outcome<'a> {
    Made(Facts),
    Failed { error: &'a str },
}

/// Values derived from the description and the files.
#[derive(Serialize)]
struct Facts {
    /// Seed of the varied settings; `None` if none vary.
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    /// Extinction where the fog is densest, 1/m; `None` for profiles without one.
    extinction_per_m: Option<f64>,
    ambient_rgb: [f32; 3],
    ambient_from: LightLevelSource,
    width: u32,
    height: u32,
    /// Horizontal and vertical focal length, pixels.
    focal_lengths_px: (f64, f64),
    /// Principal point, pixels from the upper left corner of the picture.
    principal_point_px: (f64, f64),
    unknown_depths: u64,
    infinite_depths: u64,
    /// Exposure value at ISO 100 of linear light in a PNG or JPEG file.
    #[serde(skip_serializing_if = "Option::is_none")]
    exposure_ev100: Option<f64>,
}

const AIRLIGHT: &str = env!("CARGO_PKG_VERSION");

impl<'a> Record<'a> {
    /// Record of a picture that is about to be written.
    pub fn made(
        output: &'a str,
        input: &Input,
        which: Which,
        scene: &'a OverlayScene,
        seed: Option<u64>,
        image: &OverlayImage,
        (prepared, exposure): (&PreparedOverlay, Option<Exposure>),
    ) -> Self {
        let size = image.picture.size;
        let facts = Facts {
            seed,
            extinction_per_m: scene.extinction_per_m(),
            ambient_rgb: prepared.level.colour,
            ambient_from: prepared.level.source,
            width: size.width(),
            height: size.height(),
            focal_lengths_px: prepared.camera.focal_px(),
            principal_point_px: prepared.camera.principal_px(),
            unknown_depths: image.depth.holes,
            infinite_depths: image.depth.infinite,
            exposure_ev100: exposure.map(Exposure::ev100),
        };
        Self::new(output, input, which, scene, Outcome::Made(facts))
    }

    /// Record of a picture that failed.
    pub fn failed(
        output: &'a str,
        input: &Input,
        which: Which,
        scene: &'a OverlayScene,
        error: &'a str,
    ) -> Self {
        Self::new(output, input, which, scene, Outcome::Failed { error })
    }

    fn new(
        output: &'a str,
        input: &Input,
        which: Which,
        scene: &'a OverlayScene,
        outcome: Outcome<'a>,
    ) -> Self {
        Self {
            output,
            manifest_version: MANIFEST_VERSION,
            name: input.name(),
            which,
            scene,
            outcome,
            airlight: AIRLIGHT,
        }
    }
}
