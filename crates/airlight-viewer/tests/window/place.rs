//! The place of the sun: searched among cities, chosen on the map; files that are opened from memory.

use super::{EVENING, options, settle, window};
use airlight::sun::Moment;
use airlight_viewer::Viewer;
use airlight_viewer::state::Terrain;
use eframe::egui::{Key, Modifiers, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;

const PARIS: &str = "
[sun]
latitude_deg = 48.8584
longitude_deg = 2.2945
time = \"2026-06-21T18:00:00+02:00\"
";

/// A window that shows the place's controls.
fn at_paris() -> Harness<'static, Viewer> {
    let mut options = options(PARIS);
    options.size = [760.0, 900.0];
    let mut window = window(options);
    settle(&mut window);
    window
}

/// Latitude and longitude, degrees, and time.
fn place(window: &Harness<'_, Viewer>) -> ([f64; 2], Moment) {
    let sun = &window.state().state().scene.sun;
    let time = sun.time.as_deref().unwrap();
    (
        [sun.latitude_deg.unwrap(), sun.longitude_deg.unwrap()],
        time.parse().unwrap(),
    )
}

fn search(window: &mut Harness<'_, Viewer>, text: &str) {
    let field = window.get_by_role_and_label(Role::TextInput, "City");
    field.focus();
    window.step();
    let field = window.get_by_role_and_label(Role::TextInput, "City");
    field.type_text(text);
    window.step();
    window.step();
}

/// The evening of Paris becomes that of Tokyo; undo returns.
#[test]
fn a_city_is_found_by_its_name_and_keeps_the_hour() {
    let mut window = at_paris();
    let before = place(&window);
    search(&mut window, "toky");
    let found = "Tokyo, Japan";
    assert!(
        window
            .query_by_role_and_label(Role::Button, found)
            .is_some()
    );
    window.key_press(Key::Enter);
    window.step();
    settle(&mut window);
    let (there, moment) = place(&window);
    assert!(
        (there[0] - 35.7).abs() < 0.1 && (there[1] - 139.7).abs() < 0.1,
        "{there:?}"
    );
    assert_eq!(moment.to_string(), "2026-06-21T18:00:00+09:00");
    // What was found is no longer shown.
    assert!(
        window
            .query_by_role_and_label(Role::Button, found)
            .is_none()
    );
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.step();
    assert_eq!(place(&window), before);
    // Not the first one, by a click.
    search(&mut window, "japan");
    window.get_by_label("Osaka, Japan").click_accesskit();
    window.step();
    window.step();
    assert!((place(&window).0[0] - 34.75).abs() < 0.01);
    search(&mut window, "xyzzy");
    assert!(window.query_by_label_contains("no such city").is_some());
}

/// A click on the map keeps the moment; arrow keys go by a degree.
#[test]
fn a_place_is_chosen_on_the_map() {
    let mut window = at_paris();
    let (_, moment) = place(&window);
    let reached = (0..40).any(|_| {
        window.key_press(Key::Tab);
        window.step();
        window.get_by_label("Map of the world").is_focused()
    });
    assert!(reached, "by Tab");
    let rect = window.get_by_label("Map of the world").rect();
    assert!(
        (rect.width() / rect.height() - 2.0).abs() < 0.02,
        "{rect:?}"
    );
    // 30 degrees north, 90 degrees west.
    let at = rect.min + rect.size() * vec2(0.25, 1.0 / 3.0);
    super::drag(&mut window, at, at);
    window.step();
    let ([north, east], there) = place(&window);
    assert!(
        (north - 30.0).abs() < 1.0 && (east + 90.0).abs() < 1.0,
        "{north} {east}"
    );
    assert_eq!(there.unix_s(), moment.unix_s());
    // Summer time at the Gulf of Mexico.
    assert_eq!(there.offset_s(), -5 * 3600);
    assert!(window.query_by_label_contains("km from Houston").is_some());
    // The click has given it the keyboard.
    window.key_press(Key::ArrowUp);
    window.step();
    window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    window.step();
    window.step();
    let ([up, right], _) = place(&window);
    assert!(
        (up - north - 1.0).abs() < 1e-9 && (right - east - 10.0).abs() < 1e-9,
        "{up} {right}"
    );
}

/// Files that a page opens, which has no disk.
#[test]
fn scenes_and_heights_are_opened_from_memory() {
    let mut window = window(options(EVENING));
    settle(&mut window);
    let scene = window.state().state().to_toml().unwrap();
    let low = scene.replace("elevation_deg = 12", "elevation_deg = 5");
    let opened = window
        .state_mut()
        .open_contents(Path::new("low.toml"), low.into_bytes());
    assert_eq!(opened, Ok(()));
    assert_eq!(window.state().state().scene.sun.elevation_deg, Some(5.0));
    let mut ridge = b"Pf\n3 3\n-1.0\n".to_vec();
    for height_m in [0.0f32, 0.0, 0.0, 0.0, 80.0, 0.0, 0.0, 0.0, 0.0] {
        ridge.extend(height_m.to_le_bytes());
    }
    let opened = window
        .state_mut()
        .open_contents(Path::new("ridge.pfm"), ridge);
    assert_eq!(opened, Ok(()));
    settle(&mut window);
    assert_eq!(window.state().terrain_error(), None);
    let named = |terrain: &Option<Terrain>| terrain.as_ref().and_then(|t| t.file.clone());
    assert_eq!(
        named(&window.state().state().terrain).as_deref(),
        Some("ridge.pfm")
    );
    // The eye stands on the top.
    let altitude_m = window.state().state().scene.observer.altitude_m.unwrap();
    assert!(altitude_m >= 82.0, "{altitude_m}");
    for (name, contents, reason) in [
        ("wrong.toml", b"[sun]\nelevation = 3".to_vec(), "elevation"),
        ("picture.jpg", vec![0xff, 0xd8, 0xff], "picture.jpg"),
    ] {
        let error = window.state_mut().open_contents(Path::new(name), contents);
        let error = error.unwrap_err();
        assert!(error.contains(reason), "{error}");
    }
}
