//! What picture files say about themselves.

use super::prepared_frame::PreparedFrame;
use super::renderer::Renderer;
use super::rows::Layer;
use crate::report::short;
use airlight_image::PictureFormat;
use airlight_image::output::Metadata;

/// Program and version.
pub const SOFTWARE: &str = concat!("airlight ", env!("CARGO_PKG_VERSION"));

/// The facts of one file.
pub fn of(renderer: &Renderer<'_>, prepared: &PreparedFrame, layer: Layer) -> Metadata {
    let scene = renderer.scene;
    let place = scene.sun.place();
    let linear = renderer.layout.format.is_none_or(PictureFormat::is_linear);
    let scale = renderer.args.picture.scale;
    let white = renderer.channels.space.white_point_xy();
    let sun = &prepared.sun;
    let light = &prepared.light;
    let mut metadata = Metadata {
        software: Some(SOFTWARE.to_owned()),
        capture_date: prepared.time.map(|time| time.capture_date()),
        utc_offset_s: prepared.time.map(|time| time.offset_s() as f32),
        latitude_deg: place.map(|place| place.latitude_deg as f32),
        longitude_deg: place.map(|place| place.longitude_deg as f32),
        altitude_m: Some(scene.eye_altitude_m as f32),
        white_luminance_cd_m2: linear.then_some((1.0 / scale) as f32),
        chromaticities: linear.then(|| renderer.channels.chromaticities()),
        ..Metadata::default()
    };
    let mut add = |name: &str, text: String| metadata.texts.push((name.to_owned(), text));
    if let Some(time) = prepared.time {
        add("time", time.to_string());
    }
    add("atmosphere", scene.atmosphere.name.clone());
    if let Some(fog) = super::fog::in_words(&renderer.args.fog) {
        add("fog", fog);
    }
    add(
        "sunPosition",
        format!(
            "azimuth {:.5} deg, elevation {:.5} deg",
            sun.azimuth_deg, sun.elevation_deg
        ),
    );
    add(
        "illuminance",
        format!(
            "sun {} lx on a surface facing it, {} lx on the horizontal; sky {} lx on the horizontal",
            short(light.sun_normal_lx),
            short(light.sun_horizontal_lx),
            short(light.sky_horizontal_lx)
        ),
    );
    add("sunDisc", disc(layer).to_owned());
    if linear {
        add("units", units(renderer, scale));
        add(
            "whitePoint",
            format!(
                "CIE 1931 x {}, y {}; colours are colorimetric, not adapted to it",
                white[0], white[1]
            ),
        );
    }
    add("command", command());
    metadata
}

fn disc(layer: Layer) -> &'static str {
    match layer {
        Layer::All => "in the picture",
        Layer::Sky => "left out of the picture",
        Layer::Disc => "alone in the picture",
    }
}

fn units(renderer: &Renderer<'_>, scale: f64) -> String {
    let factor = match scale {
        1.0 => String::new(),
        scale => format!("{scale} times "),
    };
    let spectral = match renderer.layout.is_spectral() {
        true => format!(", and {factor}spectral radiance in W m^-2 sr^-1 nm^-1"),
        false => String::new(),
    };
    format!("linear light: {factor}cd/m^2, R = G = B = 1 being 1 cd/m^2 of the white{spectral}")
}

/// The command line, as a shell would take it.
fn command() -> String {
    let quoted = |word: std::ffi::OsString| {
        let word = word.to_string_lossy().into_owned();
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+.,:/@%".contains(c);
        match !word.is_empty() && word.chars().all(plain) {
            true => word,
            false => format!("'{}'", word.replace('\'', "'\\''")),
        }
    };
    std::iter::once("airlight".to_owned())
        .chain(std::env::args_os().skip(1).map(quoted))
        .collect::<Vec<_>>()
        .join(" ")
}
