//! Scenes to begin with.

use crate::state::State;

/// Names of the scenes, and their TOML, with their terrain.
pub const EXAMPLES: &[(&str, &str)] = &[
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
    ("a street of lights in fog", STREET),
    (
        "two layers of fog",
        "sun = { elevation_deg = 12, azimuth_deg = 285 }
        observer.altitude_m = 90
        air.atmosphere = \"clear\"
        fog = { visibility_m = 150, scale_height_m = 12, layers = [{ visibility_m = 900, top_m = 60, droplets = \"mist\" }] }
        camera = { azimuth_deg = 265, elevation_deg = -2 }",
    ),
    #[cfg(not(target_arch = "wasm32"))]
    (
        "Klassen's simple scene in fog",
        include_str!("../data/simple_scene.toml"),
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

/// A street that leads to the north, by dusk, in the orange light of sodium.
const STREET: &str = "sun = { elevation_deg = -5, azimuth_deg = 290 }
        observer.altitude_m = 2
        air.atmosphere = \"average\"
        fog = { visibility_m = 150, scale_height_m = 20 }
        camera = { azimuth_deg = 0, elevation_deg = 6, fov_deg = 80 }
        lights = [
            { position_m = [-5, 5, -8], intensity = [900, 420, 60] },
            { position_m = [5, 5, -8], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -22], intensity = [900, 420, 60] },
            { position_m = [5, 5, -22], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -36], intensity = [900, 420, 60] },
            { position_m = [5, 5, -36], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -50], intensity = [900, 420, 60] },
            { position_m = [5, 5, -50], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -64], intensity = [900, 420, 60] },
            { position_m = [5, 5, -64], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -78], intensity = [900, 420, 60] },
            { position_m = [5, 5, -78], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -92], intensity = [900, 420, 60] },
            { position_m = [5, 5, -92], intensity = [900, 420, 60] },
            { position_m = [-5, 5, -106], intensity = [900, 420, 60] },
            { position_m = [5, 5, -106], intensity = [900, 420, 60] },
        ]";

/// The state of an example.
pub fn state(toml: &str) -> Option<State> {
    State::from_toml(toml).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::scene::{ObjectsSpec, Scene};
    use airlight_render::scene_file;
    use std::path::Path;

    #[test]
    fn examples_are_scenes() {
        for &(name, toml) in EXAMPLES {
            let state = state(toml).unwrap_or_else(|| panic!("{name}"));
            let resolved = state.scene.resolve();
            resolved.unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }

    #[test]
    fn the_simple_scene_is_that_of_the_figures() {
        let (_, toml) = EXAMPLES
            .iter()
            .find(|(name, _)| name.starts_with("Klassen"))
            .unwrap();
        let mut right = Scene {
            objects: Some(ObjectsSpec {
                file: Some("simple-scene.toml".to_owned()),
                ..Default::default()
            }),
            ..Default::default()
        };
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/klassen1987");
        scene_file::inline_files(&mut right, &folder).unwrap();
        assert_eq!(state(toml).unwrap().scene.objects, right.objects);
    }
}
