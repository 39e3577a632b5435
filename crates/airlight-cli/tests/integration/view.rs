//! Commands that the viewer copies, run as a user runs them.

use crate::common::{Folder, succeed};
use airlight::scene::Scene;
use airlight_viewer::state::Terrain;
use airlight_viewer::{State, command_line};
use std::path::Path;
use std::process::Command;

/// Runs a copied command in a shell.
fn in_shell(folder: &Folder, line: &str) {
    let program = Path::new(env!("CARGO_BIN_EXE_airlight"));
    let path = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{path}", program.parent().unwrap().display());
    let output = Command::new("sh")
        .args(["-c", line])
        .env("PATH", path)
        .current_dir(folder.file(""))
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}: {error}");
}

fn pixels(folder: &Folder, name: &str) -> image::RgbImage {
    image::open(folder.file(name)).unwrap().into_rgb8()
}

/// The command draws what the saved scene says.
#[test]
fn copied_commands_draw_the_saved_scene() {
    let folder = Folder::new();
    let scenes = [
        "sun = { elevation_deg = 3.5, azimuth_deg = 285 }
        observer.altitude_m = 11000
        air = { aerosol = \"urban:0.7,desert:0.3\", aod_550 = 0.3, humidity = 0.7 }
        camera = { projection = \"perspective\", azimuth_deg = 255, fov_deg = 60, size = [24, 12] }
        output = { exposure = \"f/8 1/250 s ISO 100\", white_balance_k = 5000 }",
        "sun = { latitude_deg = 48.9, longitude_deg = 2.3, time = \"2026-06-21T20:15:00+02:00\" }
        fog = { visibility_m = 400, scale_height_m = 20 }
        camera = { projection = \"fisheye\", size = [16, 16] }
        output = { tone_contrast = 1.5, brighten = -0.5 }",
    ];
    for scene in scenes {
        let state = State {
            scene: Scene::from_toml(scene).unwrap(),
            ..State::default()
        };
        let line = command_line(&state);
        assert!(!line.contains(".toml"), "{line}");
        in_shell(&folder, &line);
        std::fs::write(folder.file("scene.toml"), state.to_toml().unwrap()).unwrap();
        succeed(&folder, "sky --scene scene.toml -o right.png");
        assert!(
            pixels(&folder, "sky.png") == pixels(&folder, "right.png"),
            "{line}"
        );
    }
}

/// With terrain and lights it is the viewer that draws, without a window.
#[test]
fn copied_commands_draw_terrain_and_lights() {
    let folder = Folder::new();
    let scene = "
        sun = { elevation_deg = 8, azimuth_deg = 100 }
        observer.altitude_m = 700
        air.atmosphere = \"clear\"
        fog = { visibility_m = 2000, scale_height_m = 300 }
        camera = { projection = \"perspective\", azimuth_deg = 70, elevation_deg = -3, fov_deg = 60, size = [96, 64] }";
    let ridge = State {
        scene: Scene::from_toml(scene).unwrap(),
        terrain: Some(Terrain::default()),
        ..State::default()
    };
    std::fs::write(folder.file("scene.toml"), ridge.to_toml().unwrap()).unwrap();
    succeed(&folder, "view scene.toml --no-panel --screenshot right.png");
    let line = command_line(&ridge);
    assert!(!line.contains(".toml"), "{line}");
    in_shell(&folder, &line);
    let right = pixels(&folder, "right.png");
    assert_eq!(right.dimensions(), (96, 64));
    assert!(pixels(&folder, "view.png") == right, "{line}");
    let light = "lights = [{ position_m = [-3, 705, -20], intensity = [1e9, 1e9, 1e9] }]";
    let lit = State {
        scene: Scene::from_toml(&format!("{light}\n{scene}")).unwrap(),
        ..ridge
    };
    std::fs::write(folder.file("scene.toml"), lit.to_toml().unwrap()).unwrap();
    in_shell(&folder, &command_line(&lit));
    assert!(pixels(&folder, "view.png") != right);
}
