//! Controls of the place on the Earth: a search for cities by name, and a map.

mod cities;
mod map;

use crate::style::ACCENT;
use crate::widgets::{name, quiet};
use airlight::scene::SunSpec;
use airlight::sun::Moment;
use cities::City;
use eframe::egui::{
    self, Color32, EventFilter, Id, Key, Rect, Response, Role, Sense, Stroke, TextureHandle, Ui,
    WidgetInfo, pos2, vec2,
};

/// Latitude and longitude, degrees, of a scene that has none: Paris.
pub const USUAL_DEG: [f64; 2] = [48.8584, 2.2945];
/// Name of the map for screen readers.
pub const MAP_NAME: &str = "Map of the world";

/// Most cities that a search shows.
const MOST_FOUND: usize = 6;
/// Distance from a city up to which a place is that city, km.
const IN_CITY_KM: f64 = 20.0;
/// Steps of the arrow keys on the map, degrees: without and with Shift.
const STEPS_DEG: [f64; 2] = [1.0, 10.0];
/// Time for which the light on the map stays, s.
const MAP_TIME_S: f64 = 60.0;

/// A field that takes part of the name of a city or a country, and the cities that it finds. A city sets the place, and the time to the
/// same hour on its clocks.
pub fn search(ui: &mut Ui, sun: &mut SunSpec) {
    let id = Id::unique("airlight city");
    let mut text: String = ui.data(|data| data.get_temp(id).unwrap_or_default());
    let field = ui
        .horizontal(|ui| {
            let name = name(ui, "City", true);
            let [latitude_deg, longitude_deg] = place_deg(sun);
            let field = egui::TextEdit::singleline(&mut text)
                .hint_text(hint(latitude_deg, longitude_deg))
                .desired_width(f32::INFINITY);
            let help = "Part of the name of a city or of its country; Enter takes the first one that is found.";
            ui.add(field).labelled_by(name.id).on_hover_text(help)
        })
        .inner;
    let found = cities::matching(&text);
    let is_entered = field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
    let mut chosen = found.first().copied().filter(|_| is_entered);
    for city in found.iter().take(MOST_FOUND) {
        let button = egui::Button::new(format!("{}, {}", city.name, city.country));
        if ui.add(button.frame_when_inactive(false)).clicked() {
            chosen = Some(city);
        }
    }
    if found.is_empty() && !text.trim().is_empty() {
        quiet(
            ui,
            "The list has no such city; choose it on the map.".to_owned(),
        );
    }
    if let Some(city) = chosen {
        (sun.latitude_deg, sun.longitude_deg) = (Some(city.latitude_deg), Some(city.longitude_deg));
        change_time(sun, |moment| city.at_same_clock_time(moment));
        text.clear();
    }
    ui.data_mut(|data| data.insert_temp(id, text));
}

/// The map of the world at the time of the scene. A click or the arrow keys set the place; the moment stays, on the clocks of the nearest
/// city.
pub fn map(ui: &mut Ui, sun: &mut SunSpec) {
    let width = ui.available_width().floor();
    let size = vec2(width, (0.5 * width).floor());
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, MAP_NAME));
    if let Some(place_deg) = chosen_deg(ui, rect, &response, place_deg(sun)) {
        let [latitude_deg, longitude_deg] = place_deg;
        (sun.latitude_deg, sun.longitude_deg) = (Some(latitude_deg), Some(longitude_deg));
        let (city, _) = cities::nearest(latitude_deg, longitude_deg);
        change_time(sun, |moment| city.on_its_clocks(moment));
    }
    let painter = ui.painter_at(rect.expand(2.0));
    if let Some(texture) = texture(ui, rect, time(sun)) {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture.id(), rect, whole, Color32::WHITE);
    }
    let [latitude_deg, longitude_deg] = place_deg(sun);
    let at = rect.min
        + size
            * vec2(
                ((longitude_deg + 180.0) / 360.0) as f32,
                ((90.0 - latitude_deg) / 180.0) as f32,
            );
    painter.circle_stroke(at, 4.5, Stroke::new(3.0, Color32::from_black_alpha(160)));
    painter.circle_stroke(at, 4.5, Stroke::new(1.5, ACCENT));
    if response.has_focus() {
        let ring = ui.visuals().widgets.active.bg_stroke;
        painter.rect_stroke(rect, 2.0, ring, egui::StrokeKind::Outside);
    }
    let help =
        "Click, or use the arrow keys (with Shift in larger steps): it is bright where it is day.";
    response.on_hover_text(help);
    quiet(ui, described(latitude_deg, longitude_deg));
}

/// The place that is clicked on the map or reached by keys, degrees.
fn chosen_deg(
    ui: &Ui,
    rect: Rect,
    response: &Response,
    [latitude_deg, longitude_deg]: [f64; 2],
) -> Option<[f64; 2]> {
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let pointer = response.interact_pointer_pos();
    if let Some(at) = pointer.filter(|_| response.clicked() || response.dragged()) {
        let part = ((at - rect.min) / rect.size()).clamp(vec2(0.0, 0.0), vec2(1.0, 1.0));
        return Some([
            tenths(90.0 - 180.0 * f64::from(part.y)),
            tenths(360.0 * f64::from(part.x) - 180.0),
        ]);
    }
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..Default::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let step_deg = STEPS_DEG[usize::from(ui.input(|i| i.modifiers.shift))];
    let along = |plus, minus| {
        let [plus, minus] = [plus, minus].map(|key| ui.input(|i| i.num_presses(key)) as f64);
        (plus - minus) * step_deg
    };
    let east_deg = along(Key::ArrowRight, Key::ArrowLeft);
    let north_deg = along(Key::ArrowUp, Key::ArrowDown);
    (east_deg != 0.0 || north_deg != 0.0).then(|| {
        [
            (latitude_deg + north_deg).clamp(-90.0, 90.0),
            (longitude_deg + east_deg + 180.0).rem_euclid(360.0) - 180.0,
        ]
    })
}

/// Names of the cities and their countries.
#[cfg(test)]
pub fn city_names() -> impl Iterator<Item = &'static str> {
    cities::all()
        .iter()
        .flat_map(|city| [city.name, city.country])
}

/// Latitude and longitude of the scene, degrees.
fn place_deg(sun: &SunSpec) -> [f64; 2] {
    [
        sun.latitude_deg.unwrap_or(USUAL_DEG[0]),
        sun.longitude_deg.unwrap_or(USUAL_DEG[1]),
    ]
}

/// The time of the scene; the present where it has none or one that cannot be read.
fn time(sun: &SunSpec) -> Moment {
    let moment = Moment::parse(sun.time.as_deref().unwrap_or("now"));
    moment.unwrap_or_else(|_| Moment::now())
}

/// Changes the time of a scene that has one: `now` and none stay the present.
fn change_time(sun: &mut SunSpec, change: impl FnOnce(Moment) -> Moment) {
    if let Some(text) = &mut sun.time
        && let Ok(moment) = text.parse()
    {
        *text = change(moment).to_string();
    }
}

/// The map at a time, drawn for the pixels of a rectangle. `None` for times without ephemeris before the first one with it.
fn texture(ui: &Ui, rect: Rect, moment: Moment) -> Option<TextureHandle> {
    type Drawn = ((usize, i64), TextureHandle);
    let id = Id::unique("airlight map");
    let height = (rect.height() * ui.pixels_per_point()).round().max(1.0) as usize;
    let of = (height, (moment.unix_s() / MAP_TIME_S).floor() as i64);
    let drawn: Option<Drawn> = ui.data(|data| data.get_temp(id));
    let before = match drawn {
        Some((known, texture)) if known == of => return Some(texture),
        drawn => drawn.map(|(_, texture)| texture),
    };
    let Ok(sun) = map::sun_over_earth(moment) else {
        return before;
    };
    let image = map::image(height, sun);
    let options = egui::TextureOptions::LINEAR;
    let texture = match before {
        Some(mut texture) => {
            texture.set(image, options);
            texture
        }
        None => ui.ctx().load_texture("map", image, options),
    };
    ui.data_mut(|data| data.insert_temp(id, (of, texture.clone())));
    Some(texture)
}

/// What an empty field of the search shows: the city of the place, or what to type.
fn hint(latitude_deg: f64, longitude_deg: f64) -> &'static str {
    let (city, km) = cities::nearest(latitude_deg, longitude_deg);
    match km < IN_CITY_KM {
        true => city.name,
        false => "name or country",
    }
}

/// A place by the city that it is, or the way to the nearest one.
fn described(latitude_deg: f64, longitude_deg: f64) -> String {
    let (City { name, country, .. }, km) = cities::nearest(latitude_deg, longitude_deg);
    match km < IN_CITY_KM {
        true => format!("{name}, {country}"),
        false => format!("{km:.0} km from {name}, {country}"),
    }
}

fn tenths(degrees: f64) -> f64 {
    (10.0 * degrees).round() / 10.0
}
