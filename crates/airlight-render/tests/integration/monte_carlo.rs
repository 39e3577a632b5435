//! Fog over a picture by Monte Carlo.

use super::common::{Layers, depth, layers, picture};
use airlight_image::Control;
use airlight_render::overlay::{
    ExistingAerial, MonteCarloPass, OverlayImage, OverlayScene, PreparedOverlay,
};

const SIZE: (u32, u32) = (12, 8);

/// A dark picture whose lower half is 40 m away, and sky above, in a slab of fog of an optical depth of 3.
fn hedge(eye_height_m: f64) -> (OverlayScene, OverlayImage) {
    let mut scene = OverlayScene::default();
    scene.overlay.layers = true;
    scene.overlay.sky_light = true;
    scene.overlay.radiance_scale = Some(1e-4);
    scene.scene.sun.elevation_deg = Some(25.0);
    scene.scene.sun.azimuth_deg = Some(200.0);
    scene.scene.observer.eye_height_m = Some(eye_height_m);
    let fog = scene.fog_mut();
    fog.visibility_m = Some(60.0);
    fog.top_m = Some(60.0);
    fog.droplets = Some("fine".parse().unwrap());
    let dark = picture(SIZE, |_, _| [0.02, 0.03, 0.01]);
    let far = depth(SIZE, |_, y| if y < 4 { f32::INFINITY } else { 40.0 });
    let image = OverlayImage::new(&scene.overlay, dark, far).unwrap();
    (scene, image)
}

/// Layers by Monte Carlo, and the standard error.
fn monte_carlo(
    scene: &OverlayScene,
    image: &OverlayImage,
    paths: u64,
    seed: u64,
) -> (Layers, MonteCarloPass) {
    let mut scene = scene.clone();
    scene.scene.solver.name = Some("monte-carlo".to_owned());
    scene.scene.solver.paths = Some(paths);
    scene.scene.solver.seed = Some(seed);
    scene.check().unwrap();
    let sky = scene.solve_sky().unwrap().unwrap();
    let prepared = PreparedOverlay::new(&scene, image, Some(&sky)).unwrap();
    let fog = prepared.monte_carlo(&scene, Some(&sky)).unwrap().unwrap();
    let overlay = prepared.overlay(image).unwrap();
    let (mut last, mut passes) = (None, 0);
    fog.run(&overlay, Control::default(), |pass| {
        passes += 1;
        assert_eq!(pass.is_last, pass.paths >= paths);
        last = Some(pass.clone());
        Ok(())
    })
    .unwrap();
    assert!(passes > 0);
    let pass = last.unwrap();
    let overlay = prepared.overlay(image).unwrap();
    let overlay = overlay.with_path_radiance(&pass.path_radiance).unwrap();
    (Layers::of(&overlay), pass)
}

/// The path radiance is that of the fast solution, which states 3 % in fog as dense as this.
#[test]
fn two_solvers_agree() {
    let (mut scene, image) = hedge(20.0);
    for air in [ExistingAerial::Drawn, ExistingAerial::Missing] {
        scene.overlay.air = air;
        let fast = layers(&scene, &image);
        // Paths that meet the sun by chance make up most of the noise; with few paths it depends on the seed.
        let (paths, pass) = monte_carlo(&scene, &image, 2048, 1);
        let errors = pass.standard_error.iter().skip(1).step_by(3);
        let (mut sums, mut squares) = ([0.0; 2], 0.0);
        for ((fast, paths), error) in fast.channel(7).zip(paths.channel(7)).zip(errors) {
            assert!(*error > 0.0 && *error < paths, "{error} of {paths}");
            sums[0] += f64::from(fast);
            sums[1] += f64::from(paths);
            squares += f64::from(*error).powi(2);
        }
        let (off, noise) = (sums[0] / sums[1] - 1.0, squares.sqrt() / sums[1]);
        assert!(noise < 0.03 && pass.relative_noise() > noise, "{noise}");
        assert!(off.abs() < 0.03 + 3.0 * noise, "{air:?}: {off} +- {noise}");
        // The transmittance is not sampled.
        assert!(fast.channel(4).eq(paths.channel(4)));
        // The picture is made of its layers.
        let [seen, _, _, through, _, _, path, ..] = paths.pixel(5, 0);
        assert!((seen - (0.02 * through + path)).abs() < 1e-5 * seen);
    }
}

/// A point below the ground is as deep in fog as its depth says, although paths do not reach it.
#[test]
fn points_below_the_ground_are_in_fog_too() {
    let (scene, image) = hedge(1.6);
    let fast = layers(&scene, &image);
    let (paths, _) = monte_carlo(&scene, &image, 512, 1);
    // The lowest two rows: 40 m, and the ground 5 to 8 m away.
    let sum = |layers: &Layers| layers.channel(7).skip(6 * 12).sum::<f32>();
    let ratio = sum(&paths) / sum(&fast);
    assert!((0.7..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn the_seed_changes_the_noise_and_the_number_of_threads_does_not() {
    let (scene, image) = hedge(20.0);
    let with_threads = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| monte_carlo(&scene, &image, 128, seed).0)
    };
    let one = with_threads(1, 1);
    assert!(one == with_threads(2, 1) && one != with_threads(2, 2));
}
