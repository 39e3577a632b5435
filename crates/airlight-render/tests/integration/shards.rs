//! A picture drawn in bands of rows.

use super::common::Folder;
use airlight::scene::Scene;
use airlight_image::Control;
use airlight_image::output::exr;
use airlight_render::{Renderer, Shard};
use std::fs;

/// Draws a picture as a whole and in three bands, and compares the bytes of all its files, of these names.
fn compare(toml: &str, names: &[&str]) {
    let folder = Folder::new();
    let drawn = |name: &str, shards: Option<u32>| {
        let mut scene = Scene::from_toml(toml).unwrap();
        let path = folder.file(name);
        scene.output.file = Some(path.display().to_string());
        let renderer = Renderer::new(&scene).unwrap();
        let suns = renderer.suns_near(&renderer.sun(None).unwrap());
        let prepared = renderer.prepare(suns, Control::default()).unwrap();
        let frame = renderer.frame(prepared.as_ref(), None).unwrap();
        match shards {
            None => drop(frame.write(&path, Control::default()).unwrap()),
            Some(count) => Shard::all(count).for_each(|shard| {
                frame.write_shard(&path, shard, Control::default()).unwrap();
            }),
        }
    };
    drawn("whole.exr", None);
    drawn("parts.exr", Some(3));
    for name in names {
        let picture = folder.file(format!("parts{name}"));
        let bands: Vec<_> = Shard::all(3).map(|shard| shard.path_of(&picture)).collect();
        exr::join(&bands, &picture, Control::default()).unwrap();
        let whole = fs::read(folder.file(format!("whole{name}"))).unwrap();
        assert!(fs::read(&picture).unwrap() == whole, "{name}");
    }
    assert_eq!(folder.names("").len(), 5 * names.len());
}

#[test]
fn bands_have_the_bits_of_the_picture() {
    // The horizon and the sun's disc are in different bands.
    compare(
        "sun.elevation_deg = 20\nsolver.wavelengths = 'rgb'\nsolver.scattering = 'single'\ncamera.size = [192, 96]\n\
         output = { sun_disc = 'separate', polarisation = true }\nobserver.altitude_m = 3000",
        &[".exr", ".sun.exr", ".polarisation.exr"],
    );
}

#[test]
fn bands_of_monte_carlo_and_objects_have_the_bits_of_the_picture() {
    let camera = "camera = { projection = 'perspective', size = [8, 96], azimuth_deg = 0, elevation_deg = 0 }\n\
                  sun = { elevation_deg = 30, azimuth_deg = 20 }\n";
    compare(
        &format!(
            "{camera}solver.wavelengths = 'rgb'\nsolver.name = 'monte-carlo'\nsolver.paths = 128\n\
             output = {{ noise_map = true, polarisation = true }}"
        ),
        &[".exr", ".noise.exr", ".polarisation.exr"],
    );
    compare(
        &format!(
            "{camera}solver.wavelengths = 'rgb'\nsolver.scattering = 'single'\noutput.depth_map = true\n\
             [[objects.object]]\nshape = 'sphere'\nat_m = [0, 2, -20]\nradius_m = 4\nreflectance = [0.5, 0.1, 0.1]"
        ),
        &[".exr", ".depth.exr"],
    );
}
