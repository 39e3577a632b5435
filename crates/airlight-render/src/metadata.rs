//! Metadata of picture files.

use crate::channels::PixelChannels;
use crate::display;
use crate::illuminance::Illuminances;
use crate::renderer::Renderer;
use crate::sky_rows::Layer;
use crate::summary::{self, short};
use airlight::night::NightState;
use airlight::scene::SunAngles;
use airlight::sun::Moment;
use airlight_image::PictureFormat;
use airlight_image::output::Metadata;
use airlight_image::tone::Exposure;

/// Program and version.
pub const SOFTWARE: &str = concat!("airlight ", env!("CARGO_PKG_VERSION"));

/// Data of one moment of a scene from which the metadata of its files are written.
pub(crate) struct FrameMetadata<'a> {
    pub renderer: &'a Renderer,
    pub time: Option<Moment>,
    pub sun: &'a SunAngles,
    pub light: &'a Illuminances,
    /// Celestial sphere and moon of a picture with the lights of the night.
    pub night: Option<&'a NightState>,
    pub channels: &'a PixelChannels,
    /// Exposure of a display format.
    pub exposure: Option<Exposure>,
}

impl FrameMetadata<'_> {
    /// Metadata of a file that shows a layer.
    pub fn of_layer(&self, layer: Layer) -> Metadata {
        let renderer = self.renderer;
        let scene = renderer.resolved();
        let place = scene.sun.place();
        let linear = renderer
            .layout()
            .format()
            .is_none_or(PictureFormat::is_linear);
        let scale = renderer.scene().output.scale.unwrap_or(1.0);
        let mut metadata = Metadata {
            software: Some(SOFTWARE.to_owned()),
            capture_date: self.time.map(|time| time.capture_date()),
            utc_offset_s: self.time.map(|time| time.offset_s() as f32),
            latitude_deg: place.map(|place| place.latitude_deg as f32),
            longitude_deg: place.map(|place| place.longitude_deg as f32),
            altitude_m: Some(scene.observer_altitude_m as f32),
            white_luminance_cd_m2: linear.then_some((1.0 / scale) as f32),
            chromaticities: linear.then(|| self.channels.chromaticities()),
            ..Metadata::default()
        };
        let mut add = |name: &str, text: String| metadata.texts.push((name.to_owned(), text));
        if let Some(time) = self.time {
            add("time", time.to_string());
        }
        add("atmosphere", scene.atmosphere.name.clone());
        if let Some(fog) = &scene.fog {
            add("fog", summary::fog(fog));
        }
        let sun = self.sun;
        add(
            "sunPosition",
            format!(
                "azimuth {:.5} deg, elevation {:.5} deg",
                sun.azimuth_deg, sun.elevation_deg
            ),
        );
        if let Some(moon) = self.night.and_then(|night| night.moon) {
            add("moon", summary::moon(&moon));
        }
        let light = self.light;
        add(
            "illuminance",
            format!(
                "sun {} lx on a surface facing it, {} lx on a horizontal surface; sky {} lx on a horizontal surface",
                short(light.sun_normal_lx),
                short(light.sun_horizontal_lx),
                short(light.sky_horizontal_lx)
            ),
        );
        add("sunDisc", sun_disc(layer).to_owned());
        if let Some(exposure) = self.exposure {
            let (name, text) = display::description(&renderer.scene().output, exposure);
            add(&name, text);
        }
        if linear {
            add("units", units(self.channels.layout().is_some(), scale));
            let space = self.channels.space();
            let [x, y] = space.white_point_xy();
            let meaning = match space.is_adapted() {
                true => "D65 is adapted to it by Bradford's transform",
                false => "colours are colorimetric, not adapted to it",
            };
            add("whitePoint", format!("CIE 1931 x {x}, y {y}; {meaning}"));
        }
        metadata.texts.extend(renderer.texts().iter().cloned());
        metadata
    }
}

fn sun_disc(layer: Layer) -> &'static str {
    match layer {
        Layer::All => "in the picture",
        Layer::Sky => "not in the picture",
        Layer::Disc => "only the sun's disc in the picture",
    }
}

fn units(is_spectral: bool, scale: f64) -> String {
    let factor = match scale {
        1.0 => String::new(),
        scale => format!("{scale} times "),
    };
    let spectral = match is_spectral {
        true => format!(", and {factor}spectral radiance in W m^-2 sr^-1 nm^-1"),
        false => String::new(),
    };
    format!("linear light: {factor}cd/m^2, R = G = B = 1 is 1 cd/m^2 of the white{spectral}")
}
