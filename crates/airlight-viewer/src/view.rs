//! The picture in the window: its projection, looking around, zooming, moving the sun.

use crate::state::{ALTITUDES_M, CompareMode, State};
use airlight::axes;
use airlight::scene::{CameraSpec, OutputSpec};
use airlight_image::{Frame, Projection};
use airlight_render::layout::Layout;
use eframe::egui::{
    self, Color32, CursorIcon, EventFilter, Key, Pos2, Rect, Response, Role, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};
use glam::DVec3;

/// Narrowest and widest field of view of a perspective picture, degrees.
pub const FOV_DEG: [f64; 2] = [0.5, 120.0];
/// The same of a fisheye, degrees.
pub const FISHEYE_FOV_DEG: [f64; 2] = [5.0, 360.0];
/// Azimuth of a sun that is set by hand without one, degrees.
pub const SUN_AZIMUTH_DEG: f64 = 180.0;
/// Part of the field of view by which an arrow key turns.
const KEY_STEP: f64 = 0.05;
/// Factor by which a key zooms, and changes the altitude.
const KEY_FACTOR: f64 = 1.15;

/// Distance by which a key moves the eye over terrain, m, and the part of its altitude that is added.
const WALK_M: f64 = 20.0;
const WALK_PART: f64 = 0.1;
/// Distance from the sun's centre, and from the line of a comparison, within which they are dragged, points.
const SUN_REACH: f32 = 14.0;
const LINE_REACH: f32 = 5.0;

/// What is dragged in the picture, instead of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// The sun, unless it follows from a place and a time.
    Sun,
    /// The line of a comparison.
    Line,
}

/// Name of the picture for screen readers.
pub const NAME: &str = "Picture of the sky";

/// Projection of the state's camera, as the program `airlight` draws it, in a picture of a size, pixels.
///
/// # Errors
/// A sentence for a cube map, for angles out of range and for settings that the projection does not have.
pub fn frame_of(state: &State, size: [u32; 2], sun_azimuth_deg: f64) -> Result<Frame, String> {
    // The faces of a cube are square, of whatever size.
    let is_cube = state.scene.camera.projection == Some(airlight::scene::Projection::Cube);
    let camera = CameraSpec {
        size: Some(if is_cube { [1; 2] } else { size }),
        ..state.scene.camera.clone()
    };
    let layout = Layout::new(&camera, &OutputSpec::default(), sun_azimuth_deg);
    let frame = layout.and_then(|layout| layout.only_frame());
    frame.map_err(|error| error.to_string())
}

/// The part of an area that the picture fills: all of it, or for a whole sphere one that is twice as wide as high.
pub fn part_of(area: Rect, state: &State) -> Rect {
    let is_sphere =
        state.scene.camera.projection == Some(airlight::scene::Projection::Equirectangular);
    match is_sphere {
        true => {
            let height = area.height().min(0.5 * area.width());
            Rect::from_center_size(area.center(), vec2(2.0 * height, height))
        }
        false => area,
    }
}

/// Where a picture looks, as the user changes it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Look {
    azimuth_deg: f64,
    /// Elevation and field of view; `None` for a whole sphere, which has neither.
    angles_deg: Option<[f64; 2]>,
    /// Narrowest and widest field of view, degrees.
    limits_deg: [f64; 2],
    /// Angle that the width of the picture spans, degrees.
    across_deg: f64,
}

impl Look {
    fn of(frame: &Frame) -> Self {
        let [width, height] = [frame.size().width(), frame.size().height()].map(f64::from);
        match frame.projection() {
            Projection::Perspective(camera) => {
                let high = (0.5 * camera.vertical_fov_deg.to_radians()).tan();
                let fov_deg = 2.0 * (high * width / height).atan().to_degrees();
                Self {
                    azimuth_deg: camera.azimuth_deg,
                    angles_deg: Some([camera.elevation_deg, fov_deg]),
                    limits_deg: FOV_DEG,
                    across_deg: fov_deg,
                }
            }
            Projection::AngularFisheye(fisheye) => Self {
                azimuth_deg: fisheye.azimuth_deg,
                angles_deg: Some([fisheye.elevation_deg, fisheye.field_of_view_deg]),
                limits_deg: FISHEYE_FOV_DEG,
                across_deg: fisheye.field_of_view_deg * width / width.min(height),
            },
            Projection::Equirectangular { center_azimuth_deg } => Self {
                azimuth_deg: *center_azimuth_deg,
                ..Self::SPHERE
            },
            _ => Self::SPHERE,
        }
    }

    const SPHERE: Self = Self {
        azimuth_deg: 0.0,
        angles_deg: None,
        limits_deg: [360.0; 2],
        across_deg: 360.0,
    };
}

/// Takes the input on the picture in a rectangle; it changes the state, and what is dragged.
pub fn interact(
    ui: &mut Ui,
    rect: Rect,
    state: &mut State,
    frame: &Frame,
    dragged: &mut Option<Handle>,
) -> Response {
    let response = ui.interact(
        rect,
        egui::Id::unique("airlight picture"),
        Sense::click_and_drag(),
    );
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, NAME));
    let look = Look::of(frame);
    let degrees_per_point = look.across_deg / f64::from(rect.width().max(1.0));
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let command = ui.input(|i| i.modifiers.command);
    let handle = |at: Option<Pos2>| at.and_then(|at| handle_at(rect, at, state, frame));
    if response.drag_started() {
        *dragged = match command {
            true => Some(Handle::Sun),
            false => handle(ui.input(|i| i.pointer.press_origin())),
        };
    }
    let near = dragged.or_else(|| handle(response.hover_pos()));
    match near {
        Some(Handle::Sun) if response.dragged() => ui.set_cursor_icon(CursorIcon::Grabbing),
        Some(Handle::Sun) => ui.set_cursor_icon(CursorIcon::Grab),
        Some(Handle::Line) => ui.set_cursor_icon(CursorIcon::ResizeHorizontal),
        None => {}
    }
    if response.dragged() {
        let at = response.interact_pointer_pos();
        match (*dragged, at, &mut state.compare) {
            (Some(Handle::Sun), Some(at), _) => {
                if let Some(direction) = direction_at(rect, at, frame) {
                    put_sun(state, direction);
                }
            }
            (Some(Handle::Line), Some(at), Some(compare)) => {
                let place = f64::from((at.x - rect.left()) / rect.width());
                compare.split = place.clamp(0.0, 1.0);
            }
            _ => {
                let by = response.drag_delta();
                let by = [-f64::from(by.x), f64::from(by.y)];
                turn(state, look, by.map(|v| v * degrees_per_point));
            }
        }
    } else {
        *dragged = None;
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

/// What a point of the picture drags: the line of a comparison, or the sun that is set by hand.
fn handle_at(rect: Rect, at: Pos2, state: &State, frame: &Frame) -> Option<Handle> {
    let compare = state.compare.as_ref();
    if let Some(compare) = compare.filter(|compare| compare.mode == CompareMode::Split) {
        let line = rect.left() + compare.split as f32 * rect.width();
        if (at.x - line).abs() < LINE_REACH {
            return Some(Handle::Line);
        }
    }
    let sun = sun_at(rect, state, frame)?;
    (sun.distance(at) < SUN_REACH).then_some(Handle::Sun)
}

/// Place of the sun that is set by hand; `None` outside the picture.
fn sun_at(rect: Rect, state: &State, frame: &Frame) -> Option<Pos2> {
    let sun = &state.scene.sun;
    let azimuth_deg = sun.azimuth_deg.unwrap_or(SUN_AZIMUTH_DEG);
    let direction = axes::direction(azimuth_deg, sun.elevation_deg?);
    let (x, y) = frame.pixel_of(direction)?;
    let size = frame.size();
    Some(pos2(
        rect.left() + (x / f64::from(size.width())) as f32 * rect.width(),
        rect.top() + (y / f64::from(size.height())) as f32 * rect.height(),
    ))
}

/// Marks where the sun will be, as its light takes longer to be computed than it takes to drag it.
pub fn mark_sun(ui: &Ui, rect: Rect, state: &State, frame: &Frame) {
    if let Some(at) = sun_at(rect, state, frame) {
        let stroke = Stroke::new(1.0, Color32::from_white_alpha(170));
        ui.painter().circle_stroke(at, SUN_REACH, stroke);
    }
}

/// Direction of a point in the picture; `None` outside it.
pub fn direction_at(rect: Rect, at: Pos2, frame: &Frame) -> Option<DVec3> {
    let place = (at - rect.min) / rect.size();
    let size = frame.size();
    frame.direction(
        f64::from(place.x) * f64::from(size.width()),
        f64::from(place.y) * f64::from(size.height()),
    )
}

fn keys(ui: &Ui, state: &mut State, look: Look, moves_sun: bool) {
    let step = KEY_STEP * look.across_deg;
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
    if let Some(terrain) = &mut state.terrain {
        let altitude_m = state.scene.observer.altitude_m.unwrap_or(0.0);
        let step_m = WALK_M + WALK_PART * altitude_m;
        let ahead = along(Key::W, Key::S) * step_m;
        let aside = along(Key::D, Key::A) * step_m;
        let [sin, cos] = [f64::sin, f64::cos].map(|f| f(look.azimuth_deg.to_radians()));
        terrain.east_m += ahead * sin + aside * cos;
        terrain.south_m += aside * sin - ahead * cos;
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
    let elevation_deg = look.angles_deg.map(|[elevation_deg, _]| elevation_deg);
    let level = elevation_deg.unwrap_or(0.0).to_radians().cos().max(0.2);
    camera.azimuth_deg = Some((look.azimuth_deg + right / level).rem_euclid(360.0));
    camera.orientation = None;
    if let Some(elevation_deg) = elevation_deg {
        camera.elevation_deg = Some((elevation_deg + up).clamp(-90.0, 90.0));
    }
}

fn zoom(state: &mut State, look: Look, factor: f64) {
    if let Some([_, fov_deg]) = look.angles_deg {
        let [narrowest, widest] = look.limits_deg;
        state.scene.camera.fov_deg = Some((fov_deg * factor).clamp(narrowest, widest));
    }
}

/// Puts the sun in a direction, unless it follows from a place and a time.
fn put_sun(state: &mut State, direction: DVec3) {
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
        sun.azimuth_deg =
            Some((sun.azimuth_deg.unwrap_or(SUN_AZIMUTH_DEG) + right).rem_euclid(360.0));
    }
}
