//! The picture in the window: looking around, zooming, moving the sun.

use crate::picture::Look;
use crate::state::{ALTITUDES_M, State};
use airlight::axes;
use eframe::egui::{self, EventFilter, Key, Rect, Response, Role, Sense, Ui, WidgetInfo};

/// Field of view, degrees.
const FOV_DEG: [f64; 2] = [0.5, 120.0];
/// Part of the field of view by which an arrow key turns.
const KEY_STEP: f64 = 0.05;
/// Factor by which a key zooms, and changes the altitude.
const KEY_FACTOR: f64 = 1.15;

/// Name of the picture for screen readers.
pub const NAME: &str = "Picture of the sky";

/// Where the state's camera looks.
pub fn look_of(state: &State, sun_azimuth_deg: f64) -> Look {
    let camera = &state.scene.camera;
    Look {
        azimuth_deg: camera.azimuth_deg.unwrap_or(sun_azimuth_deg),
        elevation_deg: camera.elevation_deg.unwrap_or(10.0).clamp(-90.0, 90.0),
        fov_deg: camera.fov_deg.unwrap_or(75.0).clamp(0.1, 170.0),
    }
}

/// Takes the input on the picture in a rectangle; it changes the state.
pub fn interact(ui: &mut Ui, rect: Rect, state: &mut State, look: Look) -> Response {
    let response = ui.interact(
        rect,
        egui::Id::unique("airlight picture"),
        Sense::click_and_drag(),
    );
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, NAME));
    let size = [rect.width(), rect.height()].map(|v| v.max(1.0) as u32);
    let degrees_per_point = look.fov_deg / f64::from(rect.width().max(1.0));
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let command = ui.input(|i| i.modifiers.command);
    if response.dragged() {
        let by = response.drag_delta();
        if command {
            if let Some(at) = response.interact_pointer_pos() {
                put_sun(state, direction_at(rect, at, size, look));
            }
        } else {
            turn(
                state,
                look,
                [-f64::from(by.x), f64::from(by.y)].map(|v| v * degrees_per_point),
            );
        }
    }
    if response.hovered() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = f64::from(-scroll / 400.0).exp() / f64::from(pinch);
        if factor != 1.0 {
            zoom(state, look, factor);
        }
    }
    if response.has_focus() {
        let filter = EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            ..Default::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        keys(ui, state, look, command);
    }
    response
}

/// Direction of a point in the picture.
pub fn direction_at(rect: Rect, at: egui::Pos2, size: [u32; 2], look: Look) -> glam::DVec3 {
    let [right, up, forward] = look.axes();
    let [across, high] = look.tangents(size);
    let place = (at - rect.center()) / (0.5 * rect.size());
    let x = f64::from(place.x) * across;
    let y = -f64::from(place.y) * high;
    (forward + right * x + up * y).normalize()
}

fn keys(ui: &Ui, state: &mut State, look: Look, moves_sun: bool) {
    let step = KEY_STEP * look.fov_deg;
    let pressed = |key| f64::from(ui.input(|i| i.num_presses(key)) as u32);
    let along = |plus, minus| pressed(plus) - pressed(minus);
    let across = along(Key::ArrowRight, Key::ArrowLeft);
    let up = along(Key::ArrowUp, Key::ArrowDown);
    if across != 0.0 || up != 0.0 {
        match moves_sun {
            true => move_sun(state, [across, up].map(|v| v * 0.5)),
            false => turn(state, look, [across, up].map(|v| v * step)),
        }
    }
    let zooms = along(Key::Minus, Key::Plus) - pressed(Key::Equals);
    if zooms != 0.0 {
        zoom(state, look, KEY_FACTOR.powf(zooms));
    }
    let climbs = along(Key::PageUp, Key::PageDown);
    if climbs != 0.0 {
        let [lowest, highest] = ALTITUDES_M;
        let altitude_m = state.scene.observer.altitude_m.unwrap_or(lowest);
        let climbed = altitude_m.max(lowest) * KEY_FACTOR.powf(2.0 * climbs);
        state.scene.observer.altitude_m = Some(climbed.clamp(lowest, highest));
    }
}

/// Turns the camera, degrees to the right and up.
fn turn(state: &mut State, look: Look, [right, up]: [f64; 2]) {
    let camera = &mut state.scene.camera;
    let level = look.elevation_deg.to_radians().cos().max(0.2);
    camera.azimuth_deg = Some((look.azimuth_deg + right / level).rem_euclid(360.0));
    camera.elevation_deg = Some((look.elevation_deg + up).clamp(-90.0, 90.0));
}

fn zoom(state: &mut State, look: Look, factor: f64) {
    let [narrowest, widest] = FOV_DEG;
    state.scene.camera.fov_deg = Some((look.fov_deg * factor).clamp(narrowest, widest));
}

/// Puts the sun in a direction, unless it follows from a place and a time.
fn put_sun(state: &mut State, direction: glam::DVec3) {
    let sun = &mut state.scene.sun;
    if sun.elevation_deg.is_some() {
        sun.elevation_deg = Some(axes::elevation_deg(direction));
        sun.azimuth_deg = Some(axes::azimuth_deg(direction));
    }
}

fn move_sun(state: &mut State, [right, up]: [f64; 2]) {
    let sun = &mut state.scene.sun;
    if let Some(elevation_deg) = sun.elevation_deg {
        sun.elevation_deg = Some((elevation_deg + up).clamp(-90.0, 90.0));
        sun.azimuth_deg = Some((sun.azimuth_deg.unwrap_or(180.0) + right).rem_euclid(360.0));
    }
}
