//! The panel of controls.

use crate::compute::Facts;
use crate::play::{Play, SPEEDS};
use crate::state::{ALTITUDES_M, Compare, CompareMode, State, Terrain};
use crate::terrain::SPACING_M;
use crate::view::{FISHEYE_FOV_DEG, FOV_DEG, SUN_AZIMUTH_DEG};
use crate::widgets::{Number, choice, title};
use airlight::Named;
use airlight::atmosphere::{AerosolType, Preset};
use airlight::models::registry;
use airlight::scene::{CameraSpec, Exposure, FogSpec, Projection, ToneKind};
use airlight::sun::Moment;
use eframe::egui::{self, RichText, Ui};

/// Shows the controls; they change the state.
pub fn show(ui: &mut Ui, state: &mut State, play: &mut Play, facts: &Facts, ev100: f64) {
    sun(ui, state, play, facts);
    eye(ui, state, facts);
    air(ui, state, facts);
    fog(ui, state);
    ground(ui, state);
    display(ui, state, ev100);
    compare(ui, state);
}

/// Place and time of a scene that has only a sun: Paris, on an evening in June.
const PLACE: (f64, f64) = (48.8584, 2.2945);
const TIME: &str = "2026-06-21T21:15:00+02:00";
const DAY_S: f64 = 86_400.0;

/// Cities with latitude and longitude, degrees north and east.
const CITIES: [(&str, f64, f64); 24] = [
    ("Anchorage", 61.2181, -149.9003),
    ("Bangalore", 12.9716, 77.5946),
    ("Beijing", 39.9042, 116.4074),
    ("Berlin", 52.52, 13.405),
    ("Buenos Aires", -34.6037, -58.3816),
    ("Cairo", 30.0444, 31.2357),
    ("Cape Town", -33.9249, 18.4241),
    ("Honolulu", 21.3069, -157.8583),
    ("Istanbul", 41.0082, 28.9784),
    ("Lagos", 6.5244, 3.3792),
    ("London", 51.5074, -0.1278),
    ("Los Angeles", 34.0522, -118.2437),
    ("Mexico City", 19.4326, -99.1332),
    ("Nairobi", -1.2921, 36.8219),
    ("New York", 40.7128, -74.006),
    ("Paris", 48.8584, 2.2945),
    ("Quito", -0.1807, -78.4678),
    ("Reykjavik", 64.1466, -21.9426),
    ("Rome", 41.9028, 12.4964),
    ("Singapore", 1.3521, 103.8198),
    ("Sydney", -33.8688, 151.2093),
    ("Tokyo", 35.6762, 139.6503),
    ("Tromsø", 69.6492, 18.9553),
    ("Wellington", -41.2866, 174.7756),
];

fn sun(ui: &mut Ui, state: &mut State, play: &mut Play, facts: &Facts) {
    if title(ui, "Sun") {
        state.scene.sun = State::default().scene.sun;
    }
    let sun = &mut state.scene.sun;
    let mut by_hand = sun.elevation_deg.is_some();
    ui.horizontal(|ui| {
        let hand = ui.radio_value(&mut by_hand, true, "By hand");
        let place = ui.radio_value(&mut by_hand, false, "Place and time");
        if hand.changed() {
            sun.elevation_deg = Some(rounded(facts.sun_elevation_deg));
            sun.azimuth_deg = Some(rounded(facts.sun_azimuth_deg));
        }
        if place.changed() {
            sun.elevation_deg = None;
            sun.azimuth_deg = None;
            sun.distance_ratio = None;
            sun.latitude_deg.get_or_insert(PLACE.0);
            sun.longitude_deg.get_or_insert(PLACE.1);
            sun.time.get_or_insert_with(|| TIME.to_owned());
        }
    });
    if by_hand {
        let mut elevation_deg = sun.elevation_deg.unwrap_or_default();
        let elevation = Number::new("Elevation", "°", -18.0..=90.0).decimals(2);
        let elevation = elevation.help("Of the sun's centre above the horizontal. Drag the sun in the picture, or Ctrl and drag anywhere.");
        if elevation.show(ui, &mut elevation_deg) {
            sun.elevation_deg = Some(elevation_deg.clamp(-90.0, 90.0));
        }
        Number::new("Azimuth", "°", 0.0..=360.0)
            .help("Clockwise from north.")
            .show_optional(ui, &mut sun.azimuth_deg, SUN_AZIMUTH_DEG);
    } else {
        let named = CITIES.map(|(name, latitude_deg, longitude_deg)| {
            ((Some(latitude_deg), Some(longitude_deg)), name.to_owned())
        });
        let mut place = (sun.latitude_deg, sun.longitude_deg);
        if choice(ui, "City", &mut place, &named) {
            (sun.latitude_deg, sun.longitude_deg) = place;
        }
        Number::new("Latitude", "°", -90.0..=90.0)
            .decimals(4)
            .show_optional(ui, &mut sun.latitude_deg, PLACE.0);
        Number::new("Longitude", "°", -180.0..=180.0)
            .decimals(4)
            .show_optional(ui, &mut sun.longitude_deg, PLACE.1);
        time(ui, &mut sun.time);
        passing(ui, play);
        quiet(
            ui,
            format!(
                "elevation {:.2}°, azimuth {:.2}°",
                facts.sun_elevation_deg, facts.sun_azimuth_deg
            ),
        );
    }
}

/// Day and hour. A time that cannot be read is replaced when it is changed.
fn time(ui: &mut Ui, text: &mut Option<String>) {
    let moment = Moment::parse(text.as_deref().unwrap_or("now"));
    let moment = moment.unwrap_or_else(|_| Moment::now());
    let local_s = moment.unix_s() + f64::from(moment.offset_s());
    let midnight_s = (local_s / DAY_S).floor() * DAY_S;
    let mut hour = (local_s - midnight_s) / 3600.0;
    let mut day_of_year = day_of_year(midnight_s);
    let first_s = midnight_s - (day_of_year - 1.0) * DAY_S;
    let day = Number::new("Day of year", "", 1.0..=365.0).decimals(0);
    let hours = Number::new("Local time", " h", 0.0..=24.0).decimals(2);
    if day.show(ui, &mut day_of_year) | hours.show(ui, &mut hour) {
        let local_s = first_s + (day_of_year.round() - 1.0) * DAY_S + hour * 3600.0;
        let moment = moment.at((local_s - f64::from(moment.offset_s())).round());
        *text = Some(moment.to_string());
    }
    quiet(ui, moment.to_string());
}

/// Whether time passes, and how fast.
fn passing(ui: &mut Ui, play: &mut Play) {
    let named = SPEEDS.map(|(speed, name)| (speed, name.to_owned()));
    choice(ui, "Speed", &mut play.speed, &named);
    let text = if play.is_on { "Pause" } else { "Play" };
    if ui.button(text).clicked() {
        play.is_on = !play.is_on;
    }
}

/// Day of the year, from 1, of a local midnight in seconds since 1970 began.
fn day_of_year(midnight_s: f64) -> f64 {
    let date = Moment::from_unix_s(midnight_s).to_string();
    let year_start = format!(
        "{}-01-01T00:00:00Z",
        date.split('-').next().unwrap_or("1970")
    );
    let start_s = Moment::parse(&year_start).map_or(0.0, Moment::unix_s);
    ((midnight_s - start_s) / DAY_S).round() + 1.0
}

fn eye(ui: &mut Ui, state: &mut State, facts: &Facts) {
    if title(ui, "Eye") {
        let usual = State::default().scene;
        (state.scene.observer, state.scene.camera) = (usual.observer, usual.camera);
    }
    let [lowest, highest] = ALTITUDES_M;
    Number::new("Altitude", " m", lowest..=highest)
        .logarithmic()
        .help("Above sea level. Page Up and Page Down in the picture change it, too.")
        .show_optional(ui, &mut state.scene.observer.altitude_m, facts.altitude_m);
    camera(ui, &mut state.scene.camera, facts);
}

/// Names of the projections. A cube map has six pictures.
const PROJECTIONS: [(Projection, &str); 3] = [
    (Projection::Perspective, "perspective"),
    (Projection::Fisheye, "fisheye"),
    (Projection::Equirectangular, "whole sphere"),
];

fn camera(ui: &mut Ui, camera: &mut CameraSpec, facts: &Facts) {
    let named = PROJECTIONS.map(|(kind, name)| (kind, name.to_owned()));
    let mut kind = camera.projection.unwrap_or_default();
    if choice(ui, "Projection", &mut kind, &named) {
        // Angles of one projection are out of range in, or mean nothing to, another.
        *camera = CameraSpec {
            projection: Some(kind),
            azimuth_deg: camera.azimuth_deg.filter(|_| kind != Projection::Fisheye),
            ..Default::default()
        };
    }
    let [azimuth_deg, elevation_deg, fov_deg] = match kind {
        Projection::Perspective => [facts.sun_azimuth_deg, 10.0, 75.0],
        Projection::Fisheye => [180.0, 90.0, 180.0],
        _ => [0.0, 0.0, 360.0],
    };
    let azimuth = Number::new("Direction", "°", 0.0..=360.0)
        .help("Azimuth of the centre of the picture, clockwise from north. Drag the picture, or use the arrow keys in it.");
    if azimuth.show_optional(ui, &mut camera.azimuth_deg, azimuth_deg) {
        camera.orientation = None;
    }
    let [narrowest, widest] = match kind {
        Projection::Perspective => FOV_DEG,
        Projection::Fisheye => FISHEYE_FOV_DEG,
        _ => return,
    };
    Number::new("Inclination", "°", -90.0..=90.0)
        .help("Elevation of the centre of the picture.")
        .show_optional(ui, &mut camera.elevation_deg, elevation_deg);
    Number::new("Field of view", "°", narrowest..=widest)
        .logarithmic()
        .help("From the left to the right edge, or across the circle of a fisheye. Scroll, pinch, or press + and - in the picture.")
        .show_optional(ui, &mut camera.fov_deg, fov_deg);
}

/// Sizes of pictures that are saved, pixels.
const SIZES: [[u32; 2]; 8] = [
    [1920, 1080],
    [3840, 2160],
    [1024, 1024],
    [2048, 2048],
    [4096, 4096],
    [2048, 1024],
    [4096, 2048],
    [8192, 4096],
];

fn size(ui: &mut Ui, camera: &mut CameraSpec) {
    let text = |[width, height]: [u32; 2]| format!("{width} × {height}");
    let mut named = vec![(None, "as shown".to_owned())];
    named.extend(SIZES.map(|size| (Some(size), text(size))));
    if let Some(size) = camera.size.filter(|size| !SIZES.contains(size)) {
        named.push((Some(size), text(size)));
    }
    choice(ui, "Size of a file", &mut camera.size, &named);
}

fn air(ui: &mut Ui, state: &mut State, facts: &Facts) {
    if title(ui, "Air") {
        state.scene.air = State::default().scene.air;
    }
    let air = &mut state.scene.air;
    let presets: Vec<_> = Preset::ALL
        .iter()
        .map(|preset| (Some(preset.name().to_owned()), preset.name().to_owned()))
        .collect();
    let mut atmosphere = air.atmosphere.clone().or(Some("average".to_owned()));
    if choice(ui, "Atmosphere", &mut atmosphere, &presets) {
        // What is set for the air before would be refused for, or hide, that of another planet.
        *air = Default::default();
        air.atmosphere = atmosphere;
    }
    if facts.is_earth {
        let mut types = vec![(None, "as the atmosphere".to_owned())];
        types.extend(
            AerosolType::ALL
                .iter()
                .map(|kind| (Some(kind.name().to_owned()), kind.name().to_owned())),
        );
        if choice(ui, "Haze", &mut air.aerosol, &types) {
            air.humidity = None;
        }
    }
    let depth = Number::new("Optical depth", "", 0.0..=4.0)
        .logarithmic()
        .decimals(3);
    let depth = depth.help("Vertical optical depth of the haze at 550 nm.");
    if depth.show_optional(ui, &mut air.aod_550, facts.haze_depth_550) {
        air.turbidity = None;
        air.haze_visibility_m = None;
    }
    if facts.is_earth {
        let is_dry = air
            .aerosol
            .as_deref()
            .is_some_and(|name| name.starts_with("biomass"));
        if air.aerosol.is_some() && !is_dry {
            Number::new("Humidity", "", 0.0..=0.99)
                .decimals(2)
                .help("Relative humidity, which decides the size of the haze's particles.")
                .show_optional(ui, &mut air.humidity, 0.8);
        }
        Number::new("Ozone", " DU", 0.0..=600.0)
            .decimals(0)
            .show_optional(ui, &mut air.ozone_du, facts.ozone_du);
    }
    Number::new("Ground albedo", "", 0.0..=1.0)
        .decimals(2)
        .show_optional(ui, &mut air.ground_albedo, facts.ground_albedo);
}

fn fog(ui: &mut Ui, state: &mut State) {
    if title(ui, "Fog") {
        state.scene.fog = State::default().scene.fog;
    }
    let mut has_fog = state.scene.fog.is_some();
    if ui.checkbox(&mut has_fog, "Fog near the ground").changed() {
        state.scene.fog = has_fog.then(|| FogSpec {
            visibility_m: Some(500.0),
            scale_height_m: Some(40.0),
            ..Default::default()
        });
    }
    if let Some(fog) = &mut state.scene.fog {
        Number::new("Visibility", " m", 20.0..=2e4)
            .logarithmic()
            .decimals(0)
            .help("At the ground, where the fog is densest.")
            .show_optional(ui, &mut fog.visibility_m, 500.0);
        fog.visibility_m.get_or_insert(500.0);
        Number::new("Scale height", " m", 5.0..=1000.0)
            .logarithmic()
            .decimals(0)
            .help("Height over which the fog thins by a factor e.")
            .show_optional(ui, &mut fog.scale_height_m, 50.0);
    }
}

fn ground(ui: &mut Ui, state: &mut State) {
    if title(ui, "Terrain") {
        state.terrain = None;
    }
    let mut has_terrain = state.terrain.is_some();
    let mountains = ui.checkbox(&mut has_terrain, "Mountains");
    let help = "The Cumberland Mountains; drop a file of heights on the window for others. W, A, S and D in the picture move the eye.";
    if mountains.on_hover_text(help).changed() {
        state.terrain = has_terrain.then(Terrain::default);
    }
    let Some(terrain) = &mut state.terrain else {
        return;
    };
    if let Some(file) = &terrain.file {
        quiet(ui, file.clone());
        Number::new("Spacing", " m", 0.5..=1000.0)
            .logarithmic()
            .help("Distance between the pixels of the file.")
            .show_optional(ui, &mut terrain.spacing_m, SPACING_M);
    }
    for (name, place_m) in [
        ("East", &mut terrain.east_m),
        ("South", &mut terrain.south_m),
    ] {
        Number::new(name, " m", -15_000.0..=15_000.0)
            .decimals(0)
            .help("Place of the eye from the middle of the terrain.")
            .show(ui, place_m);
    }
}

fn display(ui: &mut Ui, state: &mut State, metered_ev100: f64) {
    if title(ui, "Picture") {
        state.scene.output = State::default().scene.output;
        state.scene.camera.size = None;
    }
    size(ui, &mut state.scene.camera);
    let output = &mut state.scene.output;
    let mut auto = !matches!(output.exposure, Some(Exposure::Ev100(_)));
    if ui.checkbox(&mut auto, "Automatic exposure").changed() {
        output.exposure = (!auto).then_some(Exposure::Ev100(rounded(metered_ev100)));
    }
    if auto {
        Number::new("Brighten", " EV", -4.0..=4.0)
            .help("Stops by which the picture is brighter than metered.")
            .show_optional(ui, &mut output.brighten, 0.0);
        quiet(ui, format!("metered at EV {metered_ev100:.1}"));
    } else if let Some(Exposure::Ev100(ev100)) = &mut output.exposure {
        Number::new("Exposure", " EV", -8.0..=18.0)
            .help("Exposure value at ISO 100: 15 in sunshine, 8 at dusk.")
            .show(ui, ev100);
    }
    let curves: Vec<_> = ToneKind::ALL
        .iter()
        .map(|kind| (*kind, kind.name().to_owned()))
        .collect();
    let mut tone = output.tone.unwrap_or_default();
    if choice(ui, "Tone curve", &mut tone, &curves) {
        output.tone = Some(tone);
        if tone != ToneKind::Camera {
            output.tone_contrast = None;
            output.saturation = None;
        }
    }
    if tone == ToneKind::Camera {
        Number::new("Contrast", "", 0.5..=3.0)
            .decimals(2)
            .show_optional(ui, &mut output.tone_contrast, 1.2);
        Number::new("Saturation", "", 0.0..=3.0)
            .decimals(2)
            .show_optional(ui, &mut output.saturation, 1.0);
    }
    Number::new("White balance", " K", 1667.0..=25_000.0)
        .logarithmic()
        .decimals(0)
        .help("Colour temperature of the light that is shown as neutral.")
        .show_optional(ui, &mut output.white_balance_k, 6504.0);
}

fn compare(ui: &mut Ui, state: &mut State) {
    if title(ui, "Compare") {
        state.compare = None;
    }
    // Monte Carlo takes minutes for a picture.
    let models = registry::ALL.iter().map(|model| model.name());
    let models = models.filter(|name| *name != "monte-carlo");
    let mut named = vec![(None, "nothing".to_owned())];
    named.extend(models.map(|name| {
        let text = match name == registry::DEFAULT {
            true => "the solver".to_owned(),
            false => name.to_owned(),
        };
        (Some(name.to_owned()), text)
    }));
    let mut model = state.compare.as_ref().map(|compare| compare.model.clone());
    if choice(ui, "With", &mut model, &named) {
        let before = state.compare.take();
        state.compare = model.map(|model| Compare {
            model,
            mode: before.as_ref().map_or(CompareMode::Split, |c| c.mode),
            split: before.as_ref().map_or(0.5, |c| c.split),
        });
    }
    if let Some(compare) = &mut state.compare {
        let modes = [
            (CompareMode::Split, "side by side"),
            (CompareMode::Luminance, "difference of luminance"),
            (CompareMode::Colour, "difference of colour"),
        ];
        let modes = modes.map(|(mode, text)| (mode, text.to_owned()));
        choice(ui, "Shown", &mut compare.mode, &modes);
        if compare.mode == CompareMode::Split {
            Number::new("Line", "", 0.0..=1.0)
                .decimals(2)
                .help("Left of it the picture, right of it the model.")
                .show(ui, &mut compare.split);
        }
    }
}

/// A line of less important text.
pub fn quiet(ui: &mut Ui, text: String) {
    let text = RichText::new(text).color(crate::style::QUIET).small();
    ui.add(egui::Label::new(text).wrap());
}

/// A number to hundredths, as users type it.
fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_counted_in_their_year() {
        let midnight = |text: &str| Moment::parse(text).unwrap().unix_s();
        assert_eq!(day_of_year(midnight("2026-01-01T00:00:00Z")), 1.0);
        assert_eq!(day_of_year(midnight("2026-06-21T00:00:00Z")), 172.0);
        assert_eq!(day_of_year(midnight("2024-12-31T00:00:00Z")), 366.0);
    }
}
