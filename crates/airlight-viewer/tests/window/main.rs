//! The viewer in a window that is not shown, on a Vulkan device.

mod place;

use airlight::atmosphere::{DensityProfile, Preset};
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::lights::{LightSettings, RgbLightSet, ViewRay};
use airlight::fog::visibility::{self, Contrast};
use airlight::fog::{Ground, RgbLayer};
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight::scene::{Scene, SunState};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::sun::Moment;
use airlight_image::output::PictureFormat;
use airlight_image::{Camera, Control, Frame, Projection, Size, read_picture};
use airlight_render::Renderer;
use airlight_render::overlay::{OverlayImage, OverlayScene, PreparedOverlay};
use airlight_render::sky_rows::Layer;
use airlight_viewer::state::{Compare, CompareMode, Terrain};
use airlight_viewer::{Options, State, Viewer, screenshot};
use eframe::egui::{self, Key, Modifiers, Pos2, Role, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

const SIZE: [f32; 2] = [640.0, 420.0];

fn options(toml: &str) -> Options {
    Options {
        state: State::of_scene(Scene::from_toml(toml).unwrap()),
        size: SIZE,
        panel: true,
    }
}

fn window(options: Options) -> Harness<'static, Viewer> {
    Harness::builder()
        .with_size(vec2(options.size[0], options.size[1]))
        .wgpu()
        .build_eframe(|context| {
            let render = context.wgpu_render_state.clone().unwrap();
            Viewer::new(&context.egui_ctx, render, options).unwrap()
        })
}

/// Lets the window draw until it shows its state.
fn settle(window: &mut Harness<'_, Viewer>) {
    for _ in 0..100 {
        window.step();
        if window.state().is_current() && window.state().error().is_none() {
            window.step();
            return;
        }
        window.state_mut().wait();
    }
    panic!("no light: {:?}", window.state().error());
}

const EVENING: &str = "
sun.elevation_deg = 12
sun.azimuth_deg = 250
sun.distance_ratio = 1.0167
observer.altitude_m = 2
air.atmosphere = \"clear\"
camera.projection = \"perspective\"
camera.azimuth_deg = 200
camera.elevation_deg = 20
camera.fov_deg = 80
";

/// Probe points over the picture, against the solver at sixteen wavelengths.
#[test]
fn the_picture_is_that_of_the_solver() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let (size, pixels) = window.state().pixels().unwrap();
    let camera =
        Camera::with_horizontal_fov(200.0, 20.0, 80.0, Size::new(size[0], size[1]).unwrap());
    let frame = Frame::new(Projection::Perspective(camera), size[0], size[1]).unwrap();
    let settings = SkySettings {
        suns: SunCoverage::near(12.0, 2.0),
        ..Default::default()
    };
    let grid = WavelengthGrid::standard();
    let sky = Sky::prepare(&Preset::Clear.atmosphere(), &grid, &settings).unwrap();
    let view = sky.view(
        2.0,
        SunState {
            direction: axes::direction(250.0, 12.0),
            distance_ratio: 1.0167,
        },
    );
    let mut worst = 0.0f64;
    for k in 0..40 {
        let (x, y) = (13 * k % size[0], (17 * k + 5) % size[1]);
        let direction = frame.pixel_direction(x, y).unwrap();
        let right = grid.to_xyz(&view.along(direction, None).radiance())[1];
        let got = RgbSpace::Srgb.luminance(pixels[(y * size[0] + x) as usize].map(f64::from));
        worst = worst.max((got / right - 1.0).abs());
    }
    println!("{size:?}: worst luminance error {worst:.4}");
    assert!(worst < 0.03, "{worst}");
}

/// Saved pictures of all projections against those of the program, without pixels that horizon and sun cross, whose means it draws.
#[test]
fn saved_projections_are_those_of_the_program() {
    let folder = std::env::temp_dir().join(format!("airlight-projections-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("picture.exr");
    let mut window = window(options(EVENING));
    settle(&mut window);
    let cameras = [
        "projection = \"equirectangular\"\nsize = [96, 48]\nazimuth_deg = 70",
        "projection = \"fisheye\"\nsize = [64, 48]",
        "projection = \"fisheye\"\nsize = [48, 64]\nazimuth_deg = 30\nelevation_deg = -20\nfov_deg = 250",
        "projection = \"perspective\"\nsize = [70, 40]\nazimuth_deg = 215\nroll_deg = 30\nfov_deg = 90",
    ];
    for camera in cameras {
        let mut state = window.state().state().clone();
        let scene = Scene::from_toml(&format!("[camera]\n{camera}")).unwrap();
        state.scene.camera = scene.camera;
        window.state_mut().set_state(state);
        settle(&mut window);
        window.state_mut().save(&file).unwrap();
        let got = read_picture(&file, None).unwrap();
        let renderer = Renderer::new(&window.state().state().scene).unwrap();
        let right = renderer.render(Control::default()).unwrap();
        assert_eq!(got.size, right.frame.size());
        let sun = axes::direction(250.0, 12.0);
        let width = right.frame.size().width();
        let mut errors = Vec::new();
        let pixels = got.rgb.as_chunks::<3>().0.iter().zip(&right.rgb);
        for (k, (got, right_rgb)) in (0..).zip(pixels) {
            let (x, y) = (k % width, k / width);
            let Some(direction) = right.frame.pixel_direction(x, y) else {
                assert_eq!(*got, [0.0; 3], "{camera}: {x} {y}");
                continue;
            };
            let near_horizon = axes::elevation_deg(direction).abs() < 5.0;
            if near_horizon || direction.dot(sun) > 0.99 {
                continue;
            }
            let [got, right] =
                [*got, *right_rgb].map(|rgb| RgbSpace::Srgb.luminance(rgb.map(f64::from)));
            errors.push(got / right - 1.0);
        }
        let worst = errors.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let rms = (squares / errors.len() as f64).sqrt();
        println!(
            "{camera}: {} pixels, rms {rms:.5}, worst {worst:.5}",
            errors.len()
        );
        assert!(
            errors.len() > 1000 && rms < 0.002 && worst < 0.01,
            "{camera}"
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_cube_map_is_refused() {
    let state = State::of_scene(Scene::from_toml("camera.projection = \"cube\"").unwrap());
    let file = std::env::temp_dir().join(format!("airlight-cube-{}.png", std::process::id()));
    let options = Options {
        state,
        size: SIZE,
        panel: true,
    };
    let error = screenshot(options, &file).unwrap_err().to_string();
    assert!(error.contains("fisheye"), "{error}");
    assert!(!file.exists());
}

/// The picture beside that of the solver, and of a published model.
#[test]
fn models_are_compared_with_the_picture() {
    let mut options = options(EVENING);
    let compare = |model: &str, mode| {
        Some(Compare {
            left: None,
            model: model.to_owned(),
            mode,
            split: 0.5,
        })
    };
    options.state.compare = compare("orders", CompareMode::Split);
    let mut window = window(options);
    settle(&mut window);
    let text = window.state().judgement().unwrap();
    let errors = |text: &str| -> Vec<f64> {
        let lines = text.lines();
        lines.map(stated_error).collect()
    };
    let [check, solver] = errors(&text)[..] else {
        panic!("{text}");
    };
    assert!(check < 0.5 && solver < 0.5, "{text}");
    // The right half is the solver's picture, which continues the left one.
    let image = window.render().unwrap();
    let at = |x: u32| image.get_pixel(x, 80).0;
    let middle = (SIZE[0] as u32 - 316) / 2;
    for (left, right) in at(middle - 3).into_iter().zip(at(middle + 3)) {
        assert!(
            left.abs_diff(right) <= 3,
            "{:?} {:?}",
            at(middle - 3),
            at(middle + 3)
        );
    }
    let mut state = window.state().state().clone();
    state.compare = compare("hillaire2020", CompareMode::Luminance);
    window.state_mut().set_state(state);
    settle(&mut window);
    let text = window.state().judgement().unwrap();
    assert!(errors(&text)[1] > 5.0 && text.contains("red"), "{text}");
}

/// Two models beside each other, the difference between them, and Monte Carlo, whose noise falls.
#[test]
fn any_two_sides_are_compared() {
    let mut options = options(EVENING);
    options.size = [440.0, 200.0];
    options.state.compare = Some(Compare {
        left: Some("orders".to_owned()),
        model: "orders".to_owned(),
        mode: CompareMode::Split,
        split: 0.5,
    });
    let mut window = window(options);
    settle(&mut window);
    let text = window.state().judgement().unwrap();
    assert!(
        text.contains("orders from orders: luminance 0.00 % rms"),
        "{text}"
    );
    let set = |window: &mut Harness<'_, Viewer>, left: &str, model: &str| {
        let mut state = window.state().state().clone();
        let compare = state.compare.as_mut().unwrap();
        (compare.left, compare.model) = (Some(left.to_owned()), model.to_owned());
        window.state_mut().set_state(state);
        settle(window);
        window.state().judgement().unwrap()
    };
    let number_before = |text: &str, end: &str| -> f64 {
        let (before, _) = text.split_once(end).expect(text);
        before.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let text = set(&mut window, "hillaire2020", "orders");
    let line = text.lines().last().unwrap();
    assert!(
        line.starts_with("difference of hillaire2020 from orders"),
        "{text}"
    );
    assert!(number_before(line, " % rms") > 5.0, "{text}");
    let text = set(&mut window, "monte-carlo", "orders");
    let line = text.lines().last().unwrap();
    let (paths, noise) = (
        number_before(line, " paths"),
        number_before(line.rsplit_once("noise ").unwrap().1, " %"),
    );
    // The difference is noise.
    let rms = number_before(line, " % rms");
    println!("{paths} paths: noise {noise} %, rms {rms} %");
    assert!(rms < 2.0 * noise + 0.5, "{text}");
    for _ in 0..2 {
        window.step();
        window.state_mut().wait();
    }
    let text = window.state().judgement().unwrap();
    let line = text.lines().last().unwrap();
    let less_noise = number_before(line.rsplit_once("noise ").unwrap().1, " %");
    assert!(number_before(line, " paths") > paths, "{text}");
    assert!(less_noise < noise, "{text}");
}

/// A click on a pixel against the solver there.
#[test]
fn a_click_reads_the_spectrum() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    click(&mut window, pos2(120.0, 150.0));
    settle(&mut window);
    window.get_by_label("Copy spectrum as CSV");
    let (size, pixels) = window.state().pixels().unwrap();
    let drawn = pixels[150 * size[0] as usize + 120].map(f64::from);
    let right = window.state().spectrum().unwrap().xyz[1];
    let error = RgbSpace::Srgb.luminance(drawn) / right - 1.0;
    assert!(error.abs() < 0.01, "{error}");
}

/// Presses and releases the primary button at a point.
fn click(window: &mut Harness<'_, Viewer>, at: Pos2) {
    window.hover_at(at);
    window.step();
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
}

/// A click on a mountain: its light through the solver's air against the picture, under a sun whose shadows are short, and in the shadows
/// of a low one, which darken the air.
#[test]
fn a_click_reads_terrain_through_its_air() {
    let mut options = options(EVENING);
    let scene = &mut options.state.scene;
    (scene.observer.altitude_m, scene.camera.elevation_deg) = (Some(900.0), Some(-3.0));
    options.state.terrain = Some(Terrain::default());
    options.size = [800.0, 420.0];
    let mut window = window(options);
    // Not where the window of the reading opens.
    for (sun_deg, [x, y], errors) in [
        (60.0, [400, 350], -0.01..0.01),
        (60.0, [440, 250], -0.01..0.01),
        (12.0, [400, 350], -0.1..-0.01),
    ] {
        let mut state = window.state().state().clone();
        state.scene.sun.elevation_deg = Some(sun_deg);
        window.state_mut().set_state(state);
        settle(&mut window);
        click(&mut window, pos2(x as f32 + 0.5, y as f32 + 0.5));
        settle(&mut window);
        let (size, pixels) = window.state().pixels().unwrap();
        let drawn = pixels[(y * size[0] + x) as usize].map(f64::from);
        let spectrum = window.state().spectrum().unwrap();
        let transmittance = spectrum.transmittance.as_ref().unwrap();
        let [blue, red] = [transmittance[1], transmittance[12]];
        assert!(0.0 < blue && blue < red && red < 1.0, "{transmittance:?}");
        let error = RgbSpace::Srgb.luminance(drawn) / spectrum.xyz[1] - 1.0;
        println!("{x} {y}: transmittance {blue:.3} {red:.3}, luminance error {error:.5}");
        assert!(errors.contains(&error), "{error}");
        window.get_by_label_contains("terrain at");
        window.get_by_label_contains("horizontal visibility");
    }
    // The sky beside it.
    click(&mut window, pos2(440.0, 40.0));
    settle(&mut window);
    assert!(window.state().spectrum().unwrap().transmittance.is_none());
}

/// The error that is stated, percent of luminance.
fn stated_error(text: &str) -> f64 {
    let (_, after) = text.split_once("luminance ").expect(text);
    after.split_once(' ').unwrap().0.parse().unwrap()
}

/// Fog of the profiles and droplets that the device draws, and of several layers, against the solver.
#[test]
fn fog_is_that_of_the_solver() {
    let mut window = window(options(EVENING));
    for (fog, most_percent) in [
        ("scale_height_m = 30, droplets = \"coarse\"", 0.3),
        ("scale_height_m = 30, droplets = \"mist\"", 0.3),
        ("base_height_m = 20", 0.5),
        ("base_height_m = 20, droplets = \"mist\"", 0.5),
        ("top_m = 40, droplets = \"cloud-c1\"", 0.4),
        ("top_m = 40, droplets = \"isotropic\"", 0.4),
        (
            "scale_height_m = 10, layers = [{ visibility_m = 2000, top_m = 60, droplets = \"mist\" }]",
            0.4,
        ),
        (
            "top_m = 20, layers = [{ visibility_m = 900, base_height_m = 10 }, { visibility_m = 4000, scale_height_m = 200 }]",
            0.4,
        ),
    ] {
        let text = format!("{EVENING}\nfog = {{ visibility_m = 600, {fog} }}");
        let state = State::of_scene(Scene::from_toml(&text).unwrap());
        window.state_mut().set_state(state);
        settle(&mut window);
        let text = window.state().judgement().unwrap();
        println!("{fog}: {text}");
        assert!(stated_error(&text) < most_percent, "{fog}: {text}");
    }
}

/// More layers of fog than the device draws: the window shows what the program draws, and saves it.
#[test]
fn many_layers_of_fog_are_drawn_by_the_library() {
    let thin = |top_m: f64| format!("[[fog.layers]]\nvisibility_m = 8000\ntop_m = {top_m}\n");
    let text = format!(
        "{EVENING}\noutput.exposure = 13\n[fog]\nvisibility_m = 800\ntop_m = 20\n{}[[fog.layers]]\nvisibility_m = 300\nbase_height_m = 10",
        [30.0, 40.0, 50.0].map(thin).concat()
    );
    let mut window = window(options(&text));
    settle(&mut window);
    let judgement = window.state().judgement().unwrap();
    assert!(judgement.contains("drawn by the library"), "{judgement}");
    let folder = std::env::temp_dir().join(format!("airlight-layers-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [saved, right] = ["saved.png", "right.png"].map(|name| folder.join(name));
    window.state_mut().save(&saved).unwrap();
    let ([width, height], device) = window.state().pixels().unwrap();
    let mut scene = window.state().state().scene.clone();
    scene.camera.size = Some([width, height]);
    scene.output.file = Some(right.display().to_string());
    let renderer = Renderer::new(&scene).unwrap();
    let sun = renderer.sun(None).unwrap();
    let prepared = renderer.prepare(renderer.suns_near(&sun), Control::default());
    let frame = renderer.frame(prepared.unwrap().as_ref(), None).unwrap();
    frame.write(&right, Control::default()).unwrap();
    assert_eq!(
        std::fs::read(&saved).unwrap(),
        std::fs::read(&right).unwrap()
    );
    let right = read_picture(&right, None).unwrap();
    let shown = window.render().unwrap();
    let (mut worst, mut squares, mut count) = (0.0f64, 0.0, 0);
    // Above the sentences in the corner.
    for k in (0..width * (height - 100)).step_by(37) {
        let (x, y) = (k % width, k / width);
        for (channel, right) in shown.get_pixel(x, y).0[..3]
            .iter()
            .zip(&right.rgb[3 * k as usize..])
        {
            let right = 255.0 * srgb_encode(f64::from(*right));
            let apart = (f64::from(*channel) - right).abs();
            (worst, squares, count) = (worst.max(apart), squares + apart * apart, count + 1);
        }
    }
    let rms = (squares / f64::from(count)).sqrt();
    println!("levels: rms {rms:.2}, worst {worst:.1}");
    assert!(rms < 2.0, "{rms}");
    // The first four, which the device draws while the picture changes, make another picture.
    let luminance = |k: usize| RgbSpace::Srgb.luminance(device[k].map(f64::from));
    let first = (0..device.len()).step_by(997).map(luminance).sum::<f64>();
    let solved = frame.pixels(&renderer.layout().only_frame().unwrap(), Layer::Sky);
    let luminance = |k: usize| RgbSpace::Srgb.luminance(solved[k].map(f64::from));
    let all = (0..device.len()).step_by(997).map(luminance).sum::<f64>();
    assert!((first / all - 1.0).abs() > 0.05, "{first} {all}");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The eye moves around the point of the ground in the centre of the picture, which stays where it is among the lights.
#[test]
fn the_eye_orbits_what_is_ahead() {
    let mut options = options(NIGHT);
    let scene = &mut options.state.scene;
    (scene.observer.altitude_m, scene.camera.elevation_deg) = (Some(40.0), Some(-30.0));
    scene.lights = Scene::from_toml(LIGHTS).unwrap().lights;
    let mut window = window(options);
    settle(&mut window);
    // The point in the centre from the first light.
    let centre = |window: &Harness<'_, Viewer>| {
        let scene = &window.state().state().scene;
        let camera = &scene.camera;
        let direction = axes::direction(camera.azimuth_deg.unwrap(), camera.elevation_deg.unwrap());
        let eye_m = DVec3::Y * scene.observer.altitude_m.unwrap();
        let light_m = DVec3::from_array(scene.lights[0].position_m.unwrap());
        eye_m - direction * (eye_m.y / direction.y) - light_m
    };
    let before = (centre(&window), window.state().state().clone());
    window.get_by_label("Picture of the sky").focus();
    window.step();
    for key in [Key::ArrowRight, Key::ArrowRight, Key::ArrowUp] {
        window.key_press_modifiers(Modifiers::SHIFT, key);
        settle(&mut window);
    }
    let scene = &window.state().state().scene;
    assert!((scene.camera.azimuth_deg.unwrap() - 350.0).abs() < 1e-6);
    assert!((scene.camera.elevation_deg.unwrap() + 35.0).abs() < 1e-6);
    assert!(scene.observer.altitude_m.unwrap() > 45.0);
    let apart_m = (centre(&window) - before.0).length();
    assert!(apart_m < 0.1, "{apart_m}");
    // By dragging, in the mode that is chosen; the eye stays above the ground.
    window.state_mut().set_state(before.1);
    settle(&mut window);
    choose(&mut window, "Dragging", "orbits what is ahead");
    drag(&mut window, pos2(150.0, 200.0), pos2(150.0, 20.0));
    settle(&mut window);
    let altitude_m = window.state().state().scene.observer.altitude_m.unwrap();
    assert!((2.0..2.1).contains(&altitude_m), "{altitude_m}");
}

#[test]
fn scenes_and_pictures_are_saved_and_opened() {
    let folder = std::env::temp_dir().join(format!("airlight-saved-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut window = window(options(EVENING));
    settle(&mut window);
    let [scene, exr, png] = ["a.toml", "a.exr", "a.png"].map(|name| folder.join(name));
    for file in [&scene, &exr, &png] {
        window.state_mut().save(file).unwrap();
    }
    // Light in the one file, what is shown in the other.
    let (_, pixels) = window.state().pixels().unwrap();
    let stored = read_picture(&exr, None).unwrap();
    let rounding = f32::from(half::f16::EPSILON);
    for (stored, shown) in stored.rgb.iter().zip(pixels.as_flattened()) {
        assert!((stored / shown - 1.0).abs() <= rounding, "{stored} {shown}");
    }
    let shown = read_picture(&png, None).unwrap();
    assert!(shown.rgb.iter().all(|v| (0.0..=1.0).contains(v)));
    let before = window.state().state().clone();
    window.get_by_label("Reset").click();
    settle(&mut window);
    assert_ne!(window.state().state(), &before);
    window.state_mut().open(&scene).unwrap();
    settle(&mut window);
    assert_eq!(window.state().state(), &before);
    assert!(window.state_mut().open(&folder.join("none.toml")).is_err());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn only_changes_are_drawn() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let drawn = window.state().frames();
    for _ in 0..5 {
        window.step();
    }
    assert_eq!(window.state().frames(), drawn);
    let before = window.state().pixels().unwrap();
    let mut state = window.state().state().clone();
    state.scene.sun.elevation_deg = Some(2.0);
    window.state_mut().set_state(state);
    settle(&mut window);
    assert!(window.state().frames() > drawn);
    assert_ne!(window.state().pixels().unwrap(), before);
    // A turn needs no new light.
    let light = window.state().light().unwrap().clone();
    window.get_by_label("Picture of the sky").focus();
    window.step();
    window.key_press(Key::ArrowRight);
    window.step();
    let azimuth_deg = window.state().state().scene.camera.azimuth_deg.unwrap();
    assert!((azimuth_deg - 204.0).abs() < 1.0, "{azimuth_deg}");
    assert_eq!(window.state().light(), Some(&light));
}

#[test]
fn changes_are_undone_and_redone() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let first = window.state().state().clone();
    window.get_by_label("Fog near the ground").click_accesskit();
    settle(&mut window);
    let foggy = window.state().state().clone();
    assert!(foggy.scene.fog.is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.step();
    assert_eq!(window.state().state(), &first);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    settle(&mut window);
    assert_eq!(window.state().state(), &foggy);
}

/// Presses at a point, moves to another and releases.
fn drag(window: &mut Harness<'_, Viewer>, from: Pos2, to: Pos2) {
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.hover_at(from);
    window.step();
    window.event(button(from, true));
    window.step();
    for part in 1..=4 {
        window.hover_at(from.lerp(to, 0.25 * part as f32));
        window.step();
    }
    window.event(button(to, false));
    window.step();
}

#[test]
fn the_sun_and_the_line_of_a_comparison_are_dragged() {
    let mut options = options(EVENING);
    options.state.scene.camera.azimuth_deg = Some(240.0);
    let mut window = window(options);
    settle(&mut window);
    let rect = window.get_by_label("Picture of the sky").rect();
    let size = [rect.width(), rect.height()].map(|v| v as u32);
    let camera =
        Camera::with_horizontal_fov(240.0, 20.0, 80.0, Size::new(size[0], size[1]).unwrap());
    let frame = Frame::new(Projection::Perspective(camera), size[0], size[1]).unwrap();
    let place = |azimuth_deg, elevation_deg| {
        let direction = axes::direction(azimuth_deg, elevation_deg);
        let (x, y) = frame.pixel_of(direction).unwrap();
        rect.min + vec2(x as f32, y as f32)
    };
    drag(&mut window, place(250.0, 12.0), place(225.0, 30.0));
    let sun = window.state().state().scene.sun.clone();
    assert!((sun.azimuth_deg.unwrap() - 225.0).abs() < 0.5, "{sun:?}");
    assert!((sun.elevation_deg.unwrap() - 30.0).abs() < 0.5, "{sun:?}");
    let camera = window.state().state().scene.camera.clone();
    assert_eq!(camera.azimuth_deg, Some(240.0));
    // Beside the sun, the picture is dragged.
    drag(&mut window, place(250.0, 12.0), place(225.0, 30.0));
    assert_eq!(window.state().state().scene.sun, sun);
    assert_ne!(window.state().state().scene.camera, camera);
    let mut state = window.state().state().clone();
    state.compare = Some(Compare {
        left: None,
        model: "preetham".to_owned(),
        mode: CompareMode::Split,
        split: 0.5,
    });
    window.state_mut().set_state(state);
    window.step();
    let at = |split: f32| pos2(rect.left() + split * rect.width(), rect.top() + 30.0);
    drag(&mut window, at(0.5), at(0.2));
    let split = window.state().state().compare.as_ref().unwrap().split;
    assert!((split - 0.2).abs() < 0.01, "{split}");
}

#[test]
fn time_passes_while_it_is_played() {
    let start = "2026-06-21T21:15:00+02:00";
    let scene = format!("sun = {{ latitude_deg = 48.9, longitude_deg = 2.3, time = \"{start}\" }}");
    let mut window = window(options(&scene));
    settle(&mut window);
    window.get_by_label("Play").click_accesskit();
    window.step();
    for _ in 0..5 {
        window.step();
    }
    window.get_by_label("Pause").click_accesskit();
    window.step();
    let moment = |window: &Harness<'_, Viewer>| {
        let time = window.state().state().scene.sun.time.clone();
        Moment::parse(&time.unwrap()).unwrap()
    };
    let passed_s = moment(&window).unix_s() - Moment::parse(start).unwrap().unix_s();
    assert!(passed_s >= 30.0, "{passed_s}");
    let stopped = moment(&window);
    window.step();
    assert_eq!(moment(&window), stopped);
    // One step for undo.
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.step();
    assert_eq!(moment(&window), Moment::parse(start).unwrap());
}

/// Ground in front of the sky, above which the eye stays and over which it moves.
#[test]
fn the_eye_stands_on_terrain() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let (_, sky) = window.state().pixels().unwrap();
    window.get_by_label("Mountains").click_accesskit();
    settle(&mut window);
    let state = window.state().state().clone();
    let altitude_m = state.scene.observer.altitude_m.unwrap();
    assert!(altitude_m > 50.0, "{altitude_m}");
    let (size, pixels) = window.state().pixels().unwrap();
    let row = |y: u32| (y * size[0]) as usize..((y + 1) * size[0]) as usize;
    // The sky stays, up to what the eye's greater altitude makes of it; the ground is darker than the level one.
    for (got, before) in pixels[row(10)].iter().zip(&sky[row(10)]) {
        assert!((got[1] / before[1] - 1.0).abs() < 0.2, "{got:?} {before:?}");
    }
    assert_ne!(pixels[row(size[1] - 10)], sky[row(size[1] - 10)]);
    window.get_by_label("Picture of the sky").focus();
    window.step();
    window.key_press(Key::W);
    settle(&mut window);
    let moved = window.state().state().terrain.clone().unwrap();
    // The camera looks to the south and a little to the west.
    assert!(moved.south_m > 10.0 && moved.east_m < -1.0, "{moved:?}");
    assert_ne!(window.state().pixels().unwrap().1, pixels);
    // A file that is not there is named.
    let mut state = window.state().state().clone();
    state.terrain = Some(Terrain {
        file: Some("none.png".to_owned()),
        ..Default::default()
    });
    window.state_mut().set_state(state);
    settle(&mut window);
    let error = window.state().terrain_error().unwrap();
    assert!(error.contains("none.png"), "{error}");
}

/// A night in fog.
const NIGHT: &str = "
        sun = { elevation_deg = -12, azimuth_deg = 250 }
        observer.altitude_m = 3
        air.atmosphere = \"clear\"
        fog = { visibility_m = 300, scale_height_m = 40 }
        camera = { azimuth_deg = 0, elevation_deg = 4, fov_deg = 80 }
        output.exposure = 4
";

const LIGHTS: &str = "
        [[lights]]
        position_m = [-5, 5, -20]
        intensity = [1e5, 8e4, 5e4]
        [[lights]]
        kind = \"spot\"
        position_m = [8, 12, -40]
        intensity = [1e6, 1e6, 1.2e6]";

/// What street lights add to the picture, against the library's lights in the same fog: with Henyey and Greenstein's function of the mean
/// cosine of its droplets, which the picture has, and with that of the droplets.
#[test]
fn lights_in_fog_are_those_of_the_library() {
    let scene = format!("{NIGHT}{LIGHTS}");
    let mut options = options(&scene);
    options.size = [200.0, 100.0];
    options.panel = false;
    let lit = options.state.scene.lights.clone();
    let mut window = window(options);
    settle(&mut window);
    let ([width, height], with) = window.state().pixels().unwrap();
    let mut state = window.state().state().clone();
    state.scene.lights.clear();
    window.state_mut().set_state(state);
    settle(&mut window);
    let (_, without) = window.state().pixels().unwrap();
    let camera = Camera::with_horizontal_fov(0.0, 4.0, 80.0, Size::new(width, height).unwrap());
    let frame = Frame::new(Projection::Perspective(camera), width, height).unwrap();
    let extinction_per_m = visibility::extinction_per_m(300.0, Contrast::default());
    let droplets = Droplets::default().phase();
    let mean_cosine = droplets.asymmetry(550.0);
    let drawn = PhaseFunction::henyey_greenstein(mean_cosine).unwrap();
    let eye = DVec3::Y * 3.0;
    for (phase, rms_at_most) in [(drawn, 0.002), (droplets, 0.4)] {
        let fog = RgbLayer {
            density: DensityProfile::exponential(40.0),
            extinction_per_m: [extinction_per_m as f32; 3],
            single_scattering_albedo: [1.0; 3],
            phase,
        };
        let lights = lit.iter().map(|light| {
            let position = DVec3::from_array(light.position_m.unwrap());
            // No ray that is compared passes so close.
            light.at(position, 0.01).unwrap()
        });
        let set = RgbLightSet::new(
            lights.collect(),
            &[fog],
            Ground::FLAT,
            LightSettings::default(),
        );
        let set = set.unwrap();
        let (mut squares, mut count, mut worst) = (0.0, 0, 0.0f64);
        for k in (0..width * height).step_by(3) {
            let direction = frame.pixel_direction(k % width, k / width).unwrap();
            let towards = |light: &airlight::scene::LightSpec| {
                let from_eye = DVec3::from_array(light.position_m.unwrap()) - eye;
                from_eye.normalize().dot(direction)
            };
            if lit.iter().any(|light| towards(light) > 0.9999) {
                continue;
            }
            let length_m = match direction.y < 0.0 {
                true => 3.0 / -direction.y,
                false => f64::INFINITY,
            };
            let right = set.path_radiance(&ViewRay {
                eye,
                direction,
                length_m,
            });
            let luminance = |rgb: [f32; 3]| RgbSpace::Srgb.luminance(rgb.map(f64::from));
            let [with, without] = [&with, &without].map(|all| luminance(all[k as usize]));
            // Differences of half floats.
            if with < 2.0 * without {
                continue;
            }
            let error = (with - without) / luminance(right) - 1.0;
            squares += error * error;
            count += 1;
            worst = worst.max(error.abs());
        }
        let rms = (squares / f64::from(count)).sqrt();
        println!("{count} pixels: rms {rms:.4}, worst {worst:.4}");
        assert!(count > 1000 && rms < rms_at_most, "{count} {rms}");
    }
    assert_eq!(window.state().light_error(), None);
}

#[test]
fn lights_are_set_by_controls() {
    let mut options = options(NIGHT);
    // Room for all controls.
    options.size = [640.0, 2000.0];
    let mut window = window(options);
    settle(&mut window);
    let before = window.state().pixels().unwrap();
    window.get_by_label("Add a light").click_accesskit();
    settle(&mut window);
    assert_eq!(window.state().state().scene.lights.len(), 1);
    assert!(window.state().pixels().unwrap() != before);
    window.get_by_label("Remove it").click_accesskit();
    settle(&mut window);
    assert_eq!(window.state().state().scene.lights, Vec::new());
    assert!(window.state().pixels().unwrap() == before);
}

fn motorcycle() -> [PathBuf; 2] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/motorcycle");
    ["left.png", "depth_mm.png"].map(|name| folder.join(name))
}

/// A file on a disk that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// A photograph and its depth map are dropped on the window and fogged, as the library fogs them; the fog follows its controls.
#[test]
fn a_photograph_is_fogged_as_the_library_does() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    for file in motorcycle() {
        window
            .input_mut()
            .dropped_files
            .push(Arc::new(Dropped(file)));
        window.step();
    }
    let mut state = window.state().state().clone();
    let [colour, depth] = motorcycle();
    let photograph = state.photograph.as_mut().unwrap();
    assert_eq!(
        (&photograph.colour, photograph.depth.as_ref()),
        (&colour, Some(&depth))
    );
    photograph.depth_scale = 0.001;
    photograph.focal_px = Some(994.978);
    let folder = std::env::temp_dir().join(format!("airlight-fogged-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let [right, saved, toml] =
        ["right.png", "saved.png", "scene.toml"].map(|name| folder.join(name));
    let mut before = Vec::new();
    for (visibility_m, scale_height_m, sun_strength) in [
        (8.0, None, None),
        (4.0, None, None),
        (4.0, Some(0.5), Some(3.0)),
    ] {
        let fog = state.scene.fog.as_mut().unwrap();
        (fog.visibility_m, fog.scale_height_m) = (Some(visibility_m), scale_height_m);
        state.photograph.as_mut().unwrap().sun_strength = sun_strength;
        window.state_mut().set_state(state.clone());
        settle(&mut window);
        let fogged = window.state().photograph().unwrap().unwrap().clone();
        assert_eq!(fogged.size, [741, 500]);
        assert_ne!(fogged.rgb, before);
        // The description that is saved, read and fogged by the library.
        window.state_mut().save(&toml).unwrap();
        let text = std::fs::read_to_string(&toml).unwrap();
        let scene = OverlayScene::from_toml(&text).unwrap();
        scene.check().unwrap();
        let image = OverlayImage::read(&scene, PictureFormat::PNG).unwrap();
        let prepared = PreparedOverlay::new(&scene, &image, None).unwrap();
        let rows = prepared.output(&scene, &image, PictureFormat::PNG).unwrap();
        rows.write(&right, Control::default()).unwrap();
        window.state_mut().save(&saved).unwrap();
        assert_eq!(
            std::fs::read(&saved).unwrap(),
            std::fs::read(&right).unwrap()
        );
        let right = read_picture(&right, None).unwrap();
        for (level, right) in fogged.rgb.iter().zip(&right.rgb) {
            let light = srgb_decode(f64::from(*level) / 255.0) as f32;
            assert!((light - right).abs() < 1e-5, "{light} {right}");
        }
        before = fogged.rgb;
    }
    // Without depth there is no fog.
    state.photograph.as_mut().unwrap().depth = None;
    window.state_mut().set_state(state);
    window.step();
    window.state_mut().wait();
    window.step();
    let error = window.state().photograph().unwrap().unwrap_err().to_owned();
    assert!(error.contains("depth"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn groups_of_controls_are_reset() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    window.get_by_label("Reset sun").click_accesskit();
    window.step();
    let (scene, usual) = (window.state().state().scene.clone(), State::default().scene);
    assert_eq!(scene.sun, usual.sun);
    assert_ne!(scene.air, usual.air);
}

#[test]
fn every_control_has_a_name_and_is_reached_by_keyboard() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let mut reached = HashSet::new();
    for _ in 0..200 {
        window.key_press(Key::Tab);
        window.step();
        let focused = window
            .root()
            .children_recursive()
            .find(|node| node.is_focused());
        let Some(node) = focused else {
            continue;
        };
        let node = node.accesskit_node();
        let name = node.label().or_else(|| node.value()).unwrap_or_default();
        assert!(!name.is_empty(), "{node:?}");
        // Once around; nothing else comes first.
        if name == "Reset" && !reached.is_empty() {
            break;
        }
        reached.insert(name);
    }
    for name in [
        "Elevation",
        "Altitude",
        "Ozone",
        "Picture of the sky",
        "White balance",
    ] {
        assert!(reached.contains(name), "{name}: {reached:?}");
    }
}

/// Chooses a value of a control.
fn choose(window: &mut Harness<'_, Viewer>, name: &str, value: &str) {
    window
        .get_by_role_and_label(Role::ComboBox, name)
        .click_accesskit();
    window.step();
    window.step();
    window.get_by_label(value).click_accesskit();
    window.step();
    // A list closes by itself where the pointer clicks.
    window.key_press(Key::Escape);
    window.step();
    window.step();
}

#[test]
fn the_resolution_of_the_picture_is_chosen() {
    let mut options = options(EVENING);
    // Room for all controls.
    options.size = [640.0, 1600.0];
    let mut window = window(options);
    settle(&mut window);
    let (full, _) = window.state().pixels().unwrap();
    let shown = window.render().unwrap();
    choose(&mut window, "Resolution", "half");
    let (half, _) = window.state().pixels().unwrap();
    assert_eq!(half, full.map(|side| side / 2));
    // Four pixels are shown as their mean, which in a smooth sky is that of one.
    choose(&mut window, "Resolution", "double");
    let (double, _) = window.state().pixels().unwrap();
    assert_eq!(double, full.map(|side| side * 2));
    let smoothed = window.render().unwrap();
    let row = 4 * SIZE[0] as usize;
    let part = |y: usize| y * row..y * row + 4 * full[0] as usize;
    for y in (0..full[1] as usize / 4).step_by(7) {
        let [one, mean] = [&shown, &smoothed].map(|image| &image.as_raw()[part(y)]);
        let apart = one.iter().zip(mean).map(|(a, b)| a.abs_diff(*b));
        assert!(apart.max() <= Some(2), "{y}");
    }
}

#[test]
fn the_picture_follows_the_size_of_the_window() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    for size in [vec2(1000.0, 500.0), vec2(500.0, 400.0)] {
        window.set_size(size);
        window.step();
        window.step();
        let ([width, height], pixels) = window.state().pixels().unwrap();
        assert_eq!(height as f32, size.y);
        assert!(width > 100 && (width as f32) < size.x, "{width}");
        assert_eq!(pixels.len(), (width * height) as usize);
    }
}

#[test]
fn a_lost_device_is_reported() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let device = window.state().device().clone();
    device.destroy();
    let _ = device.poll(eframe::wgpu::PollType::wait_indefinitely());
    window.get_by_label("Picture of the sky").focus();
    window.key_press(Key::ArrowRight);
    window.step();
    window.step();
    let error = window.state().error().unwrap();
    assert!(error.contains("device was lost"), "{error}");
}

/// What a window showed whose device is lost, in another window.
#[test]
fn a_window_is_opened_again_when_its_device_is_lost() {
    let mut options = options(EVENING);
    options.state.scene.observer.altitude_m = Some(900.0);
    options.state.terrain = Some(Terrain::default());
    let mut window = window(options);
    settle(&mut window);
    let mut state = window.state().state().clone();
    state.scene.camera.azimuth_deg = Some(215.0);
    window.state_mut().set_state(state.clone());
    settle(&mut window);
    let before = window.state().pixels().unwrap();
    let left = Arc::new(Mutex::new(None));
    window.state_mut().close_on_loss(left.clone());
    window.step();
    assert!(left.lock().unwrap().is_none());
    let device = window.state().device().clone();
    device.destroy();
    let _ = device.poll(eframe::wgpu::PollType::wait_indefinitely());
    window.step();
    let options = left.lock().unwrap().take().unwrap();
    assert_eq!((&options.state, options.size), (&state, SIZE));
    let mut again = self::window(options);
    settle(&mut again);
    assert!(again.state().pixels().unwrap() == before);
}

#[test]
fn a_device_without_timers_says_so() {
    let mut options = options(EVENING);
    // Room for all controls.
    options.size = [640.0, 1600.0];
    let mut window = window(options);
    settle(&mut window);
    window.get_by_label("Time the passes").click_accesskit();
    window.step();
    window.step();
    window.get_by_label("This graphics device has no timers.");
}

/// The pictures of a time-lapse, with the names and the light of those of the program.
#[test]
fn a_time_lapse_is_saved_picture_by_picture() {
    let folder = std::env::temp_dir().join(format!("airlight-lapse-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let scene = "
        sun = { latitude_deg = 48.9, longitude_deg = 2.3, time = \"2026-06-21T18:30:00+02:00\" }
        air.atmosphere = \"clear\"
        camera = { azimuth_deg = 40, elevation_deg = 30, size = [24, 16] }
        sequence = { until = \"+2h\", every = \"1h\" }";
    let mut window = window(options(scene));
    settle(&mut window);
    let before = window.state().state().clone();
    let file = folder.join("sky.exr");
    window.state_mut().save_all(&file).unwrap();
    for _ in 0..100 {
        if !window.state().is_saving() {
            break;
        }
        window.step();
        window.state_mut().wait();
    }
    assert_eq!(window.state().state(), &before);
    let mut scene = before.scene;
    scene.output.file = Some(file.display().to_string());
    let renderer = Renderer::new(&scene).unwrap();
    let sequence = renderer.sequence().unwrap().unwrap();
    assert_eq!(sequence.steps().len(), 3);
    for step in sequence.steps() {
        let sun = renderer.sun(Some(step.time)).unwrap();
        let prepared = renderer.prepare(renderer.suns_near(&sun), Control::default());
        let frame = renderer.frame(prepared.unwrap().as_ref(), Some(step.time));
        let frame = frame.unwrap();
        let right = frame.pixels(&renderer.layout().only_frame().unwrap(), Layer::All);
        let saved = read_picture(&step.path, None).unwrap();
        let mut worst = 0.0f32;
        for (got, right) in saved.rgb.as_chunks::<3>().0.iter().zip(&right) {
            worst = worst.max((got[1] / right[1] - 1.0).abs());
        }
        println!(
            "{}: sun at {:.2} degrees, worst {worst:.4}",
            step.time, sun.elevation_deg
        );
        assert!(worst < 0.02, "{} {worst}", step.time);
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_scene_without_light_says_why() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let mut state = window.state().state().clone();
    state.scene.air.atmosphere = Some("claer".to_owned());
    window.state_mut().set_state(state);
    window.step();
    window.state_mut().wait();
    window.step();
    let error = window.state().error().unwrap();
    assert!(error.contains("clear"), "{error}");
    // The last light stays.
    assert!(window.state().light().is_some());
}

#[test]
fn a_screenshot_that_is_too_large_is_refused() {
    let file = std::env::temp_dir().join(format!("airlight-large-{}.png", std::process::id()));
    let large = Options {
        size: [65536.0, 300.0],
        ..options(EVENING)
    };
    let error = screenshot(large, &file).unwrap_err().to_string();
    assert!(error.contains("got 65536 x 300"), "{error}");
    assert!(!file.exists());
}

#[test]
fn a_screenshot_shows_sky_and_controls() {
    let folder = std::env::temp_dir().join(format!("airlight-viewer-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("window.png");
    screenshot(options(EVENING), &file).unwrap();
    let picture = read_picture(&file, None).unwrap();
    let size = picture.size;
    assert_eq!([size.width(), size.height()], SIZE.map(|v| v as u32));
    let pixel = |x: u32, y: u32| {
        let k = 3 * (y * size.width() + x) as usize;
        &picture.rgb[k..k + 3]
    };
    let [sky, low, panel] = [pixel(100, 60), pixel(100, 300), pixel(635, 415)];
    assert!(
        sky[2] > 1.2 * sky[0] && sky[2] > 0.1,
        "the sky is blue: {sky:?}"
    );
    assert!(
        low != sky && panel.iter().all(|v| *v < 0.02),
        "{low:?} {panel:?}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
