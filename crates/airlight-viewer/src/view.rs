//! The picture in the window: its projection, looking around, moving the eye, zooming, moving the sun.

use crate::state::{ALTITUDES_M, CompareMode, State};
use airlight::axes;
use airlight::scene::{CameraSpec, OutputSpec};
use airlight_image::{Frame, Projection};
use airlight_render::layout::Layout;
use eframe::egui::{
    self, Color32, CursorIcon, EventFilter, Key, PointerButton, Pos2, Rect, Response, Role, Sense,
    Stroke, Ui, WidgetInfo, pos2, vec2,
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

/// Distance by which a key moves the eye over the ground, m, and the part of its altitude that is added.
const WALK_M: f64 = 20.0;
const WALK_PART: f64 = 0.1;
/// Distance from the sun's centre, and from the line of a comparison, within which they are dragged, points.
const SUN_REACH: f32 = 14.0;
const LINE_REACH: f32 = 5.0;

/// Angle by which the eye orbits for each point of a drag, and for a key, degrees.
const ORBIT_DEG_PER_POINT: f64 = 0.4;
const ORBIT_KEY_DEG: f64 = 5.0;
/// Steepest elevation of an orbit, degrees: beyond it the azimuth has no meaning.
const STEEPEST_DEG: f64 = 89.0;

/// What is dragged in the picture, instead of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Handle {
    /// The sun, unless it follows from a place and a time.
    Sun,
    /// The line of a comparison.
    Line,
    /// The eye, around a point at a distance, m.
    Eye(f64),
}

/// What dragging the picture, and the arrow keys in it, do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Navigation {
    /// Turn the camera.
    #[default]
    Look,
    /// Move the eye around the point in the centre of the picture.
    Orbit,
}

/// The eye, and what it orbits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Distance of the point in the centre of the picture, m.
    pub distance_m: f64,
    /// Altitude of the eye, m.
    pub altitude_m: f64,
    /// Lowest altitude of the eye, m.
    pub lowest_m: f64,
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

/// Direction of the centre of a picture.
pub fn centre(frame: &Frame) -> DVec3 {
    let look = Look::of(frame);
    let elevation_deg = look
        .angles_deg
        .map_or(0.0, |[elevation_deg, _]| elevation_deg);
    axes::direction(look.azimuth_deg, elevation_deg)
}

/// Takes the input on the picture in a rectangle; it changes the state, and what is dragged.
pub fn interact(
    ui: &mut Ui,
    rect: Rect,
    state: &mut State,
    frame: &Frame,
    (navigation, orbit): (Navigation, &Orbit),
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
    let (command, shift) = ui.input(|i| (i.modifiers.command, i.modifiers.shift));
    let orbits = navigation == Navigation::Orbit || shift;
    let handle = |at: Option<Pos2>| at.and_then(|at| handle_at(rect, at, state, frame));
    if response.drag_started() {
        let grasped = match command {
            true => Some(Handle::Sun),
            false => handle(ui.input(|i| i.pointer.press_origin())),
        };
        let by_second = response.drag_started_by(PointerButton::Secondary);
        let eye = (orbits || by_second).then_some(Handle::Eye(orbit.distance_m));
        *dragged = match by_second {
            true => eye,
            false => grasped.or(eye),
        };
    }
    let near = dragged.or_else(|| handle(response.hover_pos()));
    match near {
        Some(Handle::Sun) if response.dragged() => ui.set_cursor_icon(CursorIcon::Grabbing),
        Some(Handle::Sun) => ui.set_cursor_icon(CursorIcon::Grab),
        Some(Handle::Line) => ui.set_cursor_icon(CursorIcon::ResizeHorizontal),
        Some(Handle::Eye(_)) => ui.set_cursor_icon(CursorIcon::Move),
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
            (Some(Handle::Eye(distance_m)), ..) => {
                let by = response.drag_delta();
                let by = [by.x, -by.y].map(|v| ORBIT_DEG_PER_POINT * f64::from(v));
                let orbit = Orbit {
                    distance_m,
                    ..*orbit
                };
                self::orbit(state, look, &orbit, by);
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
        keys(ui, state, look, command, orbits.then_some(orbit));
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

/// Direction of the centre of the pixel at a point in the picture; `None` outside it.
pub fn pixel_direction_at(rect: Rect, at: Pos2, frame: &Frame) -> Option<DVec3> {
    let place = (at - rect.min) / rect.size();
    let size = frame.size();
    let pixel = |part: f32, count: u32| {
        let k = (part * count as f32).floor();
        (k >= 0.0 && k < count as f32).then_some(k as u32)
    };
    frame.pixel_direction(
        pixel(place.x, size.width())?,
        pixel(place.y, size.height())?,
    )
}

fn keys(ui: &Ui, state: &mut State, look: Look, moves_sun: bool, orbit: Option<&Orbit>) {
    let step = KEY_STEP * look.across_deg;
    let pressed = |key| f64::from(ui.input(|i| i.num_presses(key)) as u32);
    let along = |plus, minus| pressed(plus) - pressed(minus);
    let across = along(Key::ArrowRight, Key::ArrowLeft);
    let up = along(Key::ArrowUp, Key::ArrowDown);
    if across != 0.0 || up != 0.0 {
        match (moves_sun, orbit) {
            (true, _) => move_sun(state, [across, up].map(|v| v * 0.5)),
            (false, Some(orbit)) => {
                let by = [across, up].map(|v| -v * ORBIT_KEY_DEG);
                self::orbit(state, look, orbit, by);
            }
            (false, None) => turn(state, look, [across, up].map(|v| v * step)),
        }
    }
    let zooms = along(Key::Minus, Key::Plus) - pressed(Key::Equals);
    if zooms != 0.0 {
        zoom(state, look, KEY_FACTOR.powf(zooms));
    }
    let altitude_m = state.scene.observer.altitude_m.unwrap_or(0.0);
    let step_m = WALK_M + WALK_PART * altitude_m;
    let ahead = along(Key::W, Key::S) * step_m;
    let aside = along(Key::D, Key::A) * step_m;
    if ahead != 0.0 || aside != 0.0 {
        let [sin, cos] = [f64::sin, f64::cos].map(|f| f(look.azimuth_deg.to_radians()));
        let [east_m, north_m] = [ahead * sin + aside * cos, ahead * cos - aside * sin];
        move_eye(state, [east_m, -north_m]);
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

/// Moves the eye over the ground, m to the east and to the south: over terrain, or else away from the lights, whose places count from
/// the ground below the eye.
fn move_eye(state: &mut State, [east_m, south_m]: [f64; 2]) {
    if let Some(terrain) = &mut state.terrain {
        terrain.east_m += east_m;
        terrain.south_m += south_m;
        return;
    }
    for position_m in state
        .scene
        .lights
        .iter_mut()
        .flat_map(|l| &mut l.position_m)
    {
        position_m[0] -= east_m;
        position_m[2] -= south_m;
    }
}

/// Moves the eye around the point in the centre of the picture: turns the camera, degrees to the right and up, and keeps the point where
/// it is. A whole sphere has no centre and is turned.
fn orbit(state: &mut State, look: Look, orbit: &Orbit, [right, up]: [f64; 2]) {
    let Some([elevation_deg, _]) = look.angles_deg else {
        return turn(state, look, [right, up]);
    };
    let before = axes::direction(look.azimuth_deg, elevation_deg);
    let elevation_at = |altitude_m: f64| {
        let sine = before.y + (orbit.altitude_m - altitude_m) / orbit.distance_m;
        let elevation_deg = sine.clamp(-1.0, 1.0).asin().to_degrees();
        elevation_deg.clamp(-STEEPEST_DEG, STEEPEST_DEG)
    };
    let [least_deg, most_deg] = [ALTITUDES_M[1], orbit.lowest_m].map(elevation_at);
    let elevation_deg = (elevation_deg + up).max(least_deg).min(most_deg);
    let azimuth_deg = (look.azimuth_deg + right).rem_euclid(360.0);
    let moved_m = (before - axes::direction(azimuth_deg, elevation_deg)) * orbit.distance_m;
    let camera = &mut state.scene.camera;
    (camera.azimuth_deg, camera.elevation_deg) = (Some(azimuth_deg), Some(elevation_deg));
    camera.orientation = None;
    state.scene.observer.altitude_m = Some(orbit.altitude_m + moved_m.y);
    move_eye(state, [moved_m.x, moved_m.z]);
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
