//! The panel of controls.

use crate::compute::Facts;
use crate::place;
use crate::play::{Play, SPEEDS};
use crate::state::{ALTITUDES_M, Compare, CompareMode, State, Terrain};
use crate::terrain::SPACING_M;
use crate::timers::Times;
use crate::view::{FISHEYE_FOV_DEG, FOV_DEG, Navigation, SUN_AZIMUTH_DEG};
use crate::widgets::{Number, choice, quiet, title};
use airlight::Named;
use airlight::atmosphere::{AerosolType, Preset};
use airlight::axes;
use airlight::fog::droplets::DropletKind;
use airlight::models::registry;
#[cfg(not(target_arch = "wasm32"))]
use airlight::scene::SequenceSpec;
use airlight::scene::{
    CameraExposure, CameraSpec, Exposure, FogLayerSpec, FogProfile, FogSpec, LightKind, LightSpec,
    MeteringMode, Projection, Scene, ToneKind,
};
use airlight::sun::Moment;
use airlight_gpu::MOST_LIGHTS;
use airlight_render::overlay::{DepthFileKind, OverlaySpec};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::sequence::parse_span_s;
use eframe::egui::{self, Ui};

/// What is set besides the state.
#[derive(Debug)]
pub struct Shown<'a> {
    /// Whether time passes.
    pub play: &'a mut Play,
    /// What dragging does.
    pub navigation: &'a mut Navigation,
    /// Pixels of the picture along a pixel of the display.
    pub resolution: &'a mut f32,
    /// Times of the passes of the picture.
    pub times: &'a mut Times,
}

/// Shows the controls; they change the state.
pub fn show(ui: &mut Ui, state: &mut State, shown: Shown<'_>, facts: &Facts, ev100: f64) {
    if let Some(photograph) = &mut state.photograph {
        self::photograph(ui, photograph, &mut state.scene);
        fog(ui, state);
        return;
    }
    sun(ui, state, shown.play, facts);
    eye(ui, state, shown.navigation, facts);
    air(ui, state, facts);
    fog(ui, state);
    lights(ui, state, facts);
    ground(ui, state);
    display(ui, state, ev100);
    let named = [
        (2.0, "double"),
        (1.0, "full"),
        (0.5, "half"),
        (0.25, "a quarter"),
    ];
    let named = named.map(|(pixels, text)| (pixels, text.to_owned()));
    choice(ui, "Resolution", shown.resolution, &named);
    timing(ui, shown.times);
    compare(ui, state);
}

/// Time of a scene that has only a sun: an evening in June.
const TIME: &str = "2026-06-21T21:15:00+02:00";
const DAY_S: f64 = 86_400.0;

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
            let [latitude_deg, longitude_deg] = place::USUAL_DEG;
            sun.latitude_deg.get_or_insert(latitude_deg);
            sun.longitude_deg.get_or_insert(longitude_deg);
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
        place::search(ui, sun);
        let [latitude_deg, longitude_deg] = place::USUAL_DEG;
        Number::new("Latitude", "°", -90.0..=90.0)
            .decimals(4)
            .show_optional(ui, &mut sun.latitude_deg, latitude_deg);
        Number::new("Longitude", "°", -180.0..=180.0)
            .decimals(4)
            .show_optional(ui, &mut sun.longitude_deg, longitude_deg);
        place::map(ui, sun);
        time(ui, &mut sun.time);
        passing(ui, play);
        #[cfg(not(target_arch = "wasm32"))]
        time_lapse(ui, &mut state.scene.sequence);
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

/// Times of pictures that are saved together.
#[cfg(not(target_arch = "wasm32"))]
fn time_lapse(ui: &mut Ui, sequence: &mut Option<SequenceSpec>) {
    let mut is_set = sequence.is_some();
    let help = "\"Save\" writes pictures of a range of times from this one on, as NAME.0001.png and so on.";
    let set = ui.checkbox(&mut is_set, "Time-lapse").on_hover_text(help);
    if set.changed() {
        *sequence = is_set.then(|| SequenceSpec {
            until: Some("+6h".to_owned()),
            every: Some("10m".to_owned()),
            ..Default::default()
        });
    }
    let Some(sequence) = sequence else {
        return;
    };
    let seconds = |span: Option<&str>| parse_span_s(span?).ok().map(|span_s| span_s as f64);
    let until = sequence.until.as_deref();
    let lasts_s = seconds(until.and_then(|until| until.trim().strip_prefix('+')));
    let every_s = seconds(sequence.every.as_deref());
    if let Some(lasts_s) = lasts_s {
        let mut hours = lasts_s / 3600.0;
        let number = Number::new("Lasts", " h", 0.1..=48.0).logarithmic();
        if number.show(ui, &mut hours) {
            let minutes = (60.0 * hours).round().max(1.0);
            sequence.until = Some(format!("+{minutes}m"));
        }
    } else {
        quiet(ui, format!("until {}", until.unwrap_or("then")));
    }
    let mut minutes = every_s.unwrap_or(600.0) / 60.0;
    let number = Number::new("Every", " min", 0.1..=120.0).logarithmic();
    if number.show(ui, &mut minutes) {
        let seconds = (60.0 * minutes).round().max(1.0);
        sequence.every = Some(format!("{seconds}s"));
    }
    let mut meters_each = sequence.meter_each == Some(true);
    let meter = ui.checkbox(&mut meters_each, "Meter each picture");
    let help = "Otherwise all are exposed as the brightest of the first, the middle and the last.";
    if meter.on_hover_text(help).changed() {
        sequence.meter_each = meters_each.then_some(true);
    }
    if let (Some(lasts_s), Some(every_s)) = (lasts_s, every_s) {
        quiet(
            ui,
            format!("{} pictures", (lasts_s / every_s).floor() + 1.0),
        );
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

fn eye(ui: &mut Ui, state: &mut State, navigation: &mut Navigation, facts: &Facts) {
    if title(ui, "Eye") {
        let usual = State::default().scene;
        (state.scene.observer, state.scene.camera) = (usual.observer, usual.camera);
    }
    let [lowest, highest] = ALTITUDES_M;
    Number::new("Altitude", " m", lowest..=highest)
        .logarithmic()
        .help("Above sea level. Page Up and Page Down in the picture change it, too.")
        .show_optional(ui, &mut state.scene.observer.altitude_m, facts.altitude_m);
    let named = [
        (Navigation::Look, "looks around"),
        (Navigation::Orbit, "orbits what is ahead"),
    ];
    let named = named.map(|(navigation, text)| (navigation, text.to_owned()));
    choice(ui, "Dragging", navigation, &named);
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
    let is_photograph = state.photograph.is_some();
    if let Some(fog) = &mut state.scene.fog {
        fog_layers(ui, fog, is_photograph);
    }
}

/// Visibility in a layer that is added, m.
const LAYER_VISIBILITY_M: f64 = 500.0;

fn fog_layers(ui: &mut Ui, fog: &mut FogSpec, is_photograph: bool) {
    let id = egui::Id::unique("airlight fog layer");
    let mut chosen: usize = ui.data(|data| data.get_temp(id).unwrap_or(0));
    chosen = chosen.min(fog.layers.len());
    ui.horizontal(|ui| {
        if ui.button("Add a layer").clicked() {
            fog.layers.push(FogLayerSpec {
                visibility_m: Some(LAYER_VISIBILITY_M),
                ..Default::default()
            });
            chosen = fog.layers.len();
        }
        let has_more = !fog.layers.is_empty();
        let remove = ui.add_enabled(has_more, egui::Button::new("Remove the layer"));
        if remove.clicked() {
            match chosen {
                0 => {
                    let next = fog.layers.remove(0);
                    set_layer(fog, 0, next);
                }
                more => {
                    fog.layers.remove(more - 1);
                }
            }
            chosen = chosen.min(fog.layers.len());
        }
    });
    let count = 1 + fog.layers.len();
    if count > 1 {
        let named: Vec<_> = (0..count)
            .map(|k| (k, format!("{} of {count}", k + 1)))
            .collect();
        choice(ui, "Layer", &mut chosen, &named);
    }
    ui.data_mut(|data| data.insert_temp(id, chosen));
    let mut layer = match chosen {
        0 => fog.first_layer(),
        more => fog.layers[more - 1].clone(),
    };
    fog_layer(ui, &mut layer, is_photograph);
    set_layer(fog, chosen, layer);
}

/// Replaces a layer: the first, or a further one.
fn set_layer(fog: &mut FogSpec, place: usize, layer: FogLayerSpec) {
    match place {
        0 => {
            *fog = FogSpec {
                visibility_m: layer.visibility_m,
                profile: layer.profile,
                scale_height_m: layer.scale_height_m,
                base_height_m: layer.base_height_m,
                top_m: layer.top_m,
                droplets: layer.droplets,
                ..std::mem::take(fog)
            }
        }
        more => fog.layers[more - 1] = layer,
    }
}

/// Profiles that let the sky be seen; the others are for photographs.
const SKY_PROFILES: [FogProfile; 4] = [
    FogProfile::Height,
    FogProfile::Clamped,
    FogProfile::Unclamped,
    FogProfile::Slab,
];

fn fog_layer(ui: &mut Ui, layer: &mut FogLayerSpec, is_photograph: bool) {
    let nearest_m = if is_photograph { 1.0 } else { 20.0 };
    Number::new("Visibility", " m", nearest_m..=2e4)
        .logarithmic()
        .decimals(0)
        .help("Where the layer is densest.")
        .show_optional(ui, &mut layer.visibility_m, LAYER_VISIBILITY_M);
    layer.visibility_m.get_or_insert(LAYER_VISIBILITY_M);
    let profiles = FogProfile::ALL.iter();
    let named: Vec<_> = profiles
        .filter(|profile| is_photograph || SKY_PROFILES.contains(profile))
        .map(|profile| (*profile, profile.name().to_owned()))
        .collect();
    let heights_m = [layer.scale_height_m, layer.base_height_m, layer.top_m];
    let is_plain = layer.profile.is_none() && heights_m.iter().all(Option::is_none);
    let mut profile = match is_photograph && is_plain {
        // As `airlight fog` has it.
        true => FogProfile::Uniform,
        false => layer.implied_profile(),
    };
    if choice(ui, "Profile", &mut profile, &named) {
        // Heights of one profile mean nothing to another.
        *layer = FogLayerSpec {
            visibility_m: layer.visibility_m,
            droplets: layer.droplets,
            profile: Some(profile),
            ..Default::default()
        };
    }
    use FogProfile::{Clamped, Height, Slab, Unclamped};
    if matches!(profile, Height | Clamped | Unclamped) {
        Number::new("Scale height", " m", 5.0..=1000.0)
            .logarithmic()
            .decimals(0)
            .help("Height over which the fog thins by a factor e.")
            .show_optional(ui, &mut layer.scale_height_m, 50.0);
    }
    if matches!(profile, Clamped | Unclamped) {
        Number::new("Base", " m", 0.0..=1000.0)
            .decimals(0)
            .help("Height from which the fog thins.")
            .show_optional(ui, &mut layer.base_height_m, 0.0);
    }
    if profile == Slab {
        Number::new("Top", " m", 1.0..=1000.0)
            .logarithmic()
            .decimals(0)
            .help("Height up to which the fog is even.")
            .show_optional(ui, &mut layer.top_m, 50.0);
    }
    let kinds = DropletKind::ALL.iter();
    let mut named = vec![(None, "radiation (default)".to_owned())];
    named.extend(kinds.map(|kind| (Some(*kind), kind.name().to_owned())));
    choice(ui, "Droplets", &mut layer.droplets, &named);
}

/// Light of the fog over a photograph.
#[derive(Clone, Copy, PartialEq)]
enum PhotographLight {
    Ambient,
    Sun,
    Sky,
}

/// Depth, camera and light of a photograph.
fn photograph(ui: &mut Ui, photograph: &mut OverlaySpec, scene: &mut Scene) {
    title(ui, "Photograph");
    quiet(ui, photograph.colour.display().to_string());
    match &photograph.depth {
        Some(file) => quiet(ui, file.display().to_string()),
        None => quiet(ui, "Drop its depth map on the window.".to_owned()),
    }
    let kinds: Vec<_> = DepthFileKind::ALL
        .iter()
        .map(|kind| (*kind, kind.name().to_owned()))
        .collect();
    choice(ui, "Depth", &mut photograph.depth_kind, &kinds);
    Number::new("Unit", " m", 1e-4..=1e3)
        .logarithmic()
        .decimals(4)
        .help("Metres for each unit of the depth map: 0.001 for millimetres.")
        .show(ui, &mut photograph.depth_scale);
    match &mut photograph.focal_px {
        Some(focal_px) => {
            Number::new("Focal length", " px", 10.0..=20_000.0)
                .logarithmic()
                .show(ui, focal_px);
        }
        None => {
            let [_, widest] = FOV_DEG;
            Number::new("Field of view", "°", 5.0..=widest)
                .help("From the left to the right edge.")
                .show_optional(ui, &mut scene.camera.fov_deg, 60.0);
        }
    }
    Number::new("Inclination", "°", -90.0..=90.0)
        .help("Elevation of the centre of the picture, which fog of a scale height depends on.")
        .show_optional(ui, &mut scene.camera.elevation_deg, 0.0);
    let mut light = match (photograph.sky_light, photograph.sun_strength) {
        (true, _) => PhotographLight::Sky,
        (false, Some(_)) => PhotographLight::Sun,
        (false, None) => PhotographLight::Ambient,
    };
    let named = [
        (PhotographLight::Ambient, "of the photograph"),
        (PhotographLight::Sun, "with a sun"),
        (PhotographLight::Sky, "of the sky"),
    ];
    if choice(
        ui,
        "Light",
        &mut light,
        &named.map(|(kind, text)| (kind, text.to_owned())),
    ) {
        photograph.sky_light = light == PhotographLight::Sky;
        photograph.sun_strength = (light == PhotographLight::Sun).then_some(SUN_STRENGTH);
        scene.sun.elevation_deg.get_or_insert(30.0);
    }
    if light != PhotographLight::Ambient {
        Number::new("Elevation", "°", 0.1..=90.0)
            .help("Of the sun above the horizontal.")
            .show_optional(ui, &mut scene.sun.elevation_deg, 30.0);
        scene.sun.elevation_deg.get_or_insert(30.0);
        Number::new("Azimuth", "°", 0.0..=360.0)
            .help("Of the sun, clockwise from north; the camera looks to the north.")
            .show_optional(ui, &mut scene.sun.azimuth_deg, SUN_AZIMUTH_DEG);
    }
}

/// Irradiance by a sun over a photograph, relative to that of its ambient light.
const SUN_STRENGTH: f64 = 3.0;

/// A light that is added: a street light in a direction.
fn new_light(azimuth_deg: f64) -> LightSpec {
    let [distance_m, height_m] = [15.0, 5.0];
    let at = axes::direction(azimuth_deg, 0.0) * distance_m;
    LightSpec {
        position_m: Some([rounded(at.x), height_m, rounded(at.z)]),
        intensity: [1000.0; 3],
        ..Default::default()
    }
}

fn lights(ui: &mut Ui, state: &mut State, facts: &Facts) {
    if title(ui, "Lights") {
        state.scene.lights.clear();
    }
    let ahead_deg = state.scene.camera.azimuth_deg;
    let ahead_deg = ahead_deg.unwrap_or(facts.sun_azimuth_deg);
    let lights = &mut state.scene.lights;
    let id = egui::Id::unique("airlight light");
    let mut chosen: usize = ui.data(|data| data.get_temp(id).unwrap_or(0));
    ui.horizontal(|ui| {
        let has_room = lights.len() < MOST_LIGHTS;
        let add = ui.add_enabled(has_room, egui::Button::new("Add a light"));
        if add.clicked() {
            chosen = lights.len();
            lights.push(new_light(ahead_deg));
        }
        let remove = ui.add_enabled(!lights.is_empty(), egui::Button::new("Remove it"));
        if remove.clicked() && chosen < lights.len() {
            lights.remove(chosen);
        }
    });
    chosen = chosen.min(lights.len().saturating_sub(1));
    if !lights.is_empty() {
        let named: Vec<_> = (0..lights.len())
            .map(|k| (k, format!("{} of {}", k + 1, lights.len())))
            .collect();
        choice(ui, "Light", &mut chosen, &named);
    }
    ui.data_mut(|data| data.insert_temp(id, chosen));
    if let Some(light) = lights.get_mut(chosen) {
        self::light(ui, light);
        if !facts.holds_lights {
            quiet(
                ui,
                "Lights shine in fog that has a scale height.".to_owned(),
            );
        }
    }
}

fn light(ui: &mut Ui, light: &mut LightSpec) {
    let kinds: Vec<_> = LightKind::ALL
        .iter()
        .map(|kind| (*kind, kind.name().to_owned()))
        .collect();
    choice(ui, "Kind", &mut light.kind, &kinds);
    if let Some(position_m) = &mut light.position_m {
        let [east_m, height_m, south_m] = position_m;
        for (name, place_m, range) in [
            ("To the east", east_m, -200.0..=200.0),
            ("Height", height_m, 0.0..=100.0),
            ("To the south", south_m, -200.0..=200.0),
        ] {
            Number::new(name, " m", range).show(ui, place_m);
        }
    }
    let brightest = light.intensity.iter().copied().fold(0.0, f64::max);
    let mut intensity = brightest;
    let changed = Number::new("Intensity", " cd", 1.0..=1e6)
        .logarithmic()
        .decimals(0)
        .help("Of its brightest colour.")
        .show(ui, &mut intensity);
    let mut colour = light.intensity.map(|v| match brightest > 0.0 {
        true => (v / brightest) as f32,
        false => 1.0,
    });
    let recoloured = ui
        .horizontal(|ui| {
            let name = crate::widgets::name(ui, "Colour", true);
            let button = ui.color_edit_button_rgb(&mut colour);
            button.labelled_by(name.id).changed()
        })
        .inner;
    if changed || recoloured {
        let largest = colour.iter().copied().fold(1e-3, f32::max);
        light.intensity = colour.map(|v| intensity * f64::from(v / largest));
    }
    if light.kind == LightKind::Spot {
        Number::new("Axis azimuth", "°", 0.0..=360.0)
            .help("Clockwise from north.")
            .show_optional(ui, &mut light.azimuth_deg, 0.0);
        Number::new("Axis elevation", "°", -90.0..=90.0).show_optional(
            ui,
            &mut light.elevation_deg,
            -90.0,
        );
        let inner_deg = light.inner_deg.unwrap_or(20.0);
        Number::new("Cone", "°", inner_deg..=90.0)
            .help("Angle from the axis beyond which it does not shine.")
            .show_optional(ui, &mut light.outer_deg, 40.0);
    }
    if light.kind == LightKind::Sphere {
        Number::new("Radius", " m", 0.01..=10.0)
            .logarithmic()
            .decimals(2)
            .show_optional(ui, &mut light.radius_m, 0.1);
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

/// How the exposure is found, and its numbers; `None` is automatic. A value or a camera starts where the picture is metered.
fn exposure(ui: &mut Ui, exposure: &mut Option<Exposure>, metered_ev100: f64) {
    let mut chosen = exposure.unwrap_or(Exposure::AUTO);
    let (value, camera) = match chosen {
        Exposure::Metered(_) => (rounded(metered_ev100), camera_at(metered_ev100)),
        Exposure::Ev100(ev100) => (ev100, camera_at(ev100)),
        Exposure::Camera(camera) => (rounded(camera.ev100()), camera),
    };
    let mut named: Vec<_> = MeteringMode::ALL
        .iter()
        .map(|mode| (Exposure::Metered(*mode), mode.name().to_owned()))
        .collect();
    named.push((Exposure::Ev100(value), "by exposure value".to_owned()));
    named.push((Exposure::Camera(camera), "as a camera".to_owned()));
    if choice(ui, "Exposure", &mut chosen, &named) {
        *exposure = (chosen != Exposure::AUTO).then_some(chosen);
    }
    match exposure {
        Some(Exposure::Ev100(ev100)) => {
            Number::new("EV", " EV", -8.0..=18.0)
                .help("Exposure value at ISO 100: 15 in sunshine, 8 at dusk.")
                .show(ui, ev100);
        }
        Some(Exposure::Camera(camera)) => {
            Number::new("f-number", "", 1.0..=32.0)
                .logarithmic()
                .help("Focal length over the diameter of the aperture.")
                .show(ui, &mut camera.f_number);
            Number::new("Exposure time", " s", 1.25e-4..=30.0)
                .logarithmic()
                .fractions()
                .show(ui, &mut camera.time_s);
            Number::new("ISO speed", "", 25.0..=25_600.0)
                .logarithmic()
                .decimals(0)
                .show(ui, &mut camera.iso);
            quiet(ui, format!("EV {:.1} at ISO 100", camera.ev100()));
        }
        _ => quiet(ui, format!("metered at EV {metered_ev100:.1}")),
    }
}

/// A camera of an exposure value: f/8 and ISO 100, or a longer time and a wider aperture by little light.
fn camera_at(ev100: f64) -> CameraExposure {
    let [f_number, iso] = match ev100 {
        8.0.. => [8.0, 100.0],
        0.0..8.0 => [2.8, 400.0],
        _ => [1.4, 3200.0],
    };
    let time_s = f_number * f_number * 100.0 / (iso * ev100.exp2());
    let time_s = match time_s < 0.5 {
        true => time_s.recip().round().recip(),
        false => rounded(time_s),
    };
    CameraExposure {
        f_number,
        time_s,
        iso,
    }
}

fn display(ui: &mut Ui, state: &mut State, metered_ev100: f64) {
    if title(ui, "Picture") {
        state.scene.output = State::default().scene.output;
        state.scene.camera.size = None;
    }
    size(ui, &mut state.scene.camera);
    let output = &mut state.scene.output;
    exposure(ui, &mut output.exposure, metered_ev100);
    Number::new("Brighten", " EV", -4.0..=4.0)
        .help("Stops by which the picture is brighter than exposed.")
        .show_optional(ui, &mut output.brighten, 0.0);
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

/// Times of the passes on the device.
fn timing(ui: &mut Ui, times: &mut Times) {
    let mut is_on = *times != Times::Off;
    if ui.checkbox(&mut is_on, "Time the passes").changed() {
        *times = match is_on {
            true => Times::On(None),
            false => Times::Off,
        };
    }
    match times {
        Times::Off => {}
        Times::Missing => quiet(ui, "This graphics device has no timers.".to_owned()),
        Times::On(None) => quiet(ui, "timing …".to_owned()),
        Times::On(Some(times)) => quiet(
            ui,
            format!(
                "ground {:.2} ms, air {:.2} ms, tone {:.2} ms",
                times.ground_ms, times.air_ms, times.tone_ms
            ),
        ),
    }
}

fn compare(ui: &mut Ui, state: &mut State) {
    if title(ui, "Compare") {
        state.compare = None;
    }
    let mut named = vec![(None, "nothing".to_owned())];
    named.extend(registry::ALL.iter().map(|model| {
        let name = model.name();
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
            left: before.as_ref().and_then(|c| c.left.clone()),
            model,
            mode: before.as_ref().map_or(CompareMode::Split, |c| c.mode),
            split: before.as_ref().map_or(0.5, |c| c.split),
        });
    }
    if let Some(compare) = &mut state.compare {
        named[0].1 = "the picture".to_owned();
        choice(ui, "On the left", &mut compare.left, &named);
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
                .help("Left of it the picture or a model, right of it the other.")
                .show(ui, &mut compare.split);
        }
    }
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
