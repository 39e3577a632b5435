//! Air and fog in lanes: the table of aerial perspective, fog in a sky, fogbows.

mod aerial;
mod fogbow;
mod foggy_sky;

use super::lane_channels::LaneChannels;
use crate::atmosphere::presets;
use crate::sky::{LineOfSight, Sky, SkySettings, SunCoverage};
use crate::spectrum::{Spectrum, WavelengthGrid};
use crate::transfer::PathOptics;

/// All wavelengths of a grid of N.
const SPECTRAL: LaneChannels = LaneChannels::Wavelengths { first: 0 };

/// The sky of a preset at three wavelengths.
fn sky(preset: &str, suns: SunCoverage) -> Sky {
    let settings = SkySettings {
        suns,
        ..Default::default()
    };
    let air = presets::preset(preset).unwrap();
    Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap()
}

/// Path optics of the air along a ray, for a grid of N wavelengths.
fn path_optics<const N: usize>(line: &LineOfSight) -> PathOptics<N> {
    PathOptics {
        transmittance: Spectrum(line.transmittance.as_slice().try_into().unwrap()),
        path_radiance: Spectrum(line.path_radiance().try_into().unwrap()),
    }
}
