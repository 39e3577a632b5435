//! Skies that several tests look at.

use airlight::atmosphere::presets;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;

/// The sky of a preset in red, green and blue.
pub fn sky(preset: &str, suns: SunCoverage) -> Sky {
    let settings = SkySettings {
        suns,
        ..Default::default()
    };
    let air = presets::preset(preset).unwrap();
    Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap()
}
