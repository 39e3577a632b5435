//! Scenes to begin with.

use crate::state::State;
use airlight::scene::Scene;
use toml::{Table, Value};

/// Names of the scenes, and their TOML, with their terrain.
pub const EXAMPLES: [(&str, &str); 8] = [
    (
        "noon in the mountains",
        "sun = { elevation_deg = 55, azimuth_deg = 180 }
        observer.altitude_m = 2500
        air.atmosphere = \"clear\"
        camera = { azimuth_deg = 120, elevation_deg = 8 }",
    ),
    (
        "ground fog in the morning",
        "sun = { elevation_deg = 8, azimuth_deg = 100 }
        observer.altitude_m = 60
        air.atmosphere = \"clear\"
        fog = { visibility_m = 400, scale_height_m = 20 }
        camera = { azimuth_deg = 85, elevation_deg = 4 }",
    ),
    (
        "fog in the valleys",
        "sun = { elevation_deg = 8, azimuth_deg = 100 }
        observer.altitude_m = 420
        air.atmosphere = \"clear\"
        fog = { visibility_m = 400, scale_height_m = 40 }
        camera = { azimuth_deg = 70, elevation_deg = -4 }
        terrain = { east_m = 2000, south_m = 3000 }",
    ),
    (
        "dusk",
        "sun = { elevation_deg = -4, azimuth_deg = 285 }
        observer.altitude_m = 20
        air.atmosphere = \"average\"
        camera = { azimuth_deg = 270, elevation_deg = 14 }",
    ),
    (
        "desert dust",
        "sun = { elevation_deg = 15, azimuth_deg = 250 }
        observer.altitude_m = 10
        air = { aerosol = \"desert\", aod_550 = 0.6, ground_albedo = 0.35 }
        camera = { azimuth_deg = 225, elevation_deg = 10 }",
    ),
    (
        "an airliner",
        "sun = { elevation_deg = 3, azimuth_deg = 285 }
        observer.altitude_m = 11000
        air.atmosphere = \"average\"
        camera = { azimuth_deg = 255, elevation_deg = 0 }",
    ),
    (
        "sunrise from a space station",
        "sun = { elevation_deg = -18.5, azimuth_deg = 90 }
        observer.altitude_m = 400000
        air.atmosphere = \"average\"
        camera = { azimuth_deg = 90, elevation_deg = -17, fov_deg = 50 }
        output.exposure = 9",
    ),
    (
        "sunset on Mars",
        "sun = { elevation_deg = 3, azimuth_deg = 285 }
        air.atmosphere = \"mars\"
        camera = { azimuth_deg = 275, elevation_deg = 8 }",
    ),
];

/// The state of an example.
pub fn state(toml: &str) -> Option<State> {
    let mut table: Table = toml.parse().ok()?;
    let terrain = table.remove("terrain").map(Value::try_into).transpose();
    let scene = Scene::from_toml(&table.to_string()).ok()?;
    Some(State {
        terrain: terrain.ok()?,
        ..State::of_scene(scene)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_scenes() {
        for (name, toml) in EXAMPLES {
            let state = state(toml).unwrap_or_else(|| panic!("{name}"));
            let resolved = state.scene.resolve();
            resolved.unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
}
