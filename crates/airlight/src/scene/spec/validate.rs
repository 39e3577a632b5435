//! Validation of a scene's numbers, and of keys that exclude or need each other.

use super::{
    Exposure, FogLayerSpec, FogPatchesSpec, LightKind, LightSpec, Scene, SunlightKind, ToneKind,
};
use crate::scene::SceneError;

/// Description of the numbers allowed, and their test.
type Allowed = (&'static str, fn(f64) -> bool);

const FINITE: Allowed = ("a number", f64::is_finite);
const NOT_NEGATIVE: Allowed = ("a number, 0 or above", |v| v.is_finite() && v >= 0.0);
const POSITIVE: Allowed = ("a number above 0", |v| v.is_finite() && v > 0.0);
const FRACTION: Allowed = ("a number from 0 to 1", |v| (0.0..=1.0).contains(&v));
const TONE_CONTRAST: Allowed = ("a number from 0.5 to 3", |v| (0.5..=3.0).contains(&v));
const SATURATION: Allowed = ("a number from 0 to 3", |v| (0.0..=3.0).contains(&v));
const ELEVATION: Allowed = ("a number of degrees from -90 to 90", |v| {
    (-90.0..=90.0).contains(&v)
});
const PHASE: Allowed = ("a number of degrees from 0 (full) to 180 (new)", |v| {
    (0.0..=180.0).contains(&v)
});
const SOLAR_FLUX: Allowed = ("a number of solar flux units from 50 to 400", |v| {
    (50.0..=400.0).contains(&v)
});
const SKY_QUALITY: Allowed = (
    "a number of magnitudes per square arcsecond from 14 to 23",
    |v| (14.0..=23.0).contains(&v),
);
const KELVIN: Allowed = ("a number of kelvins from 1667 to 25000", |v| {
    (1667.0..=25_000.0).contains(&v)
});
const LONGITUDE: Allowed = ("a number of degrees from -180 to 360", |v| {
    (-180.0..=360.0).contains(&v)
});
const CONE: Allowed = ("a number of degrees from 0 to 90", |v| {
    (0.0..=90.0).contains(&v)
});
const ALTITUDE: Allowed = ("a number of metres from -12000 to 1e9", |v| {
    (-12e3..=1e9).contains(&v)
});
const LENGTH: Allowed = ("a number of metres above 0 and at most 1e9", |v| {
    v > 0.0 && v <= 1e9
});
const PATCH_STRENGTH: Allowed = ("a number from 0 to 2", |v| (0.0..=2.0).contains(&v));
const CONTRAST: Allowed = ("0.05 or 0.02", |v| v == 0.05 || v == 0.02);

fn number(
    key: impl Into<String>,
    value: Option<f64>,
    (expected, allows): Allowed,
) -> Result<(), SceneError> {
    match value {
        Some(got) if !allows(got) => Err(SceneError::value(key, expected, got.to_string(), "")),
        _ => Ok(()),
    }
}

impl Scene {
    /// Checks every number against its range, and keys that exclude or need each other. [`Scene::resolve`] also checks
    /// conditions that depend on the atmosphere and the solver.
    ///
    /// # Errors
    /// [`SceneError::Value`] for the first invalid value.
    pub fn validate(&self) -> Result<(), SceneError> {
        if self.version != super::SCENE_VERSION {
            return Err(SceneError::value(
                "version",
                "1",
                self.version.to_string(),
                "a newer version of Airlight, or version = 1",
            ));
        }
        self.validate_sun()?;
        number("observer.altitude_m", self.observer.altitude_m, ALTITUDE)?;
        number("observer.eye_height_m", self.observer.eye_height_m, LENGTH)?;
        self.validate_night()?;
        self.validate_air()?;
        if let Some(fog) = &self.fog {
            layer("fog", &fog.first_layer())?;
            for (i, more) in fog.layers.iter().enumerate() {
                layer(&format!("fog.layers[{i}]"), more)?;
            }
            fog.patches.as_ref().map_or(Ok(()), patches)?;
        }
        for (i, spec) in self.lights.iter().enumerate() {
            light(&format!("lights[{i}]"), spec)?;
        }
        self.validate_solver()?;
        self.validate_picture()
    }

    fn validate_sun(&self) -> Result<(), SceneError> {
        let sun = &self.sun;
        number("sun.elevation_deg", sun.elevation_deg, ELEVATION)?;
        number("sun.azimuth_deg", sun.azimuth_deg, FINITE)?;
        number("sun.distance_ratio", sun.distance_ratio, POSITIVE)?;
        number("sun.latitude_deg", sun.latitude_deg, ELEVATION)?;
        number("sun.longitude_deg", sun.longitude_deg, LONGITUDE)?;
        let place = sun.latitude_deg.is_some() || sun.longitude_deg.is_some();
        if place && sun.latitude_deg.is_some() != sun.longitude_deg.is_some() {
            return Err(SceneError::value(
                "sun.latitude_deg",
                "latitude and longitude",
                "one of them",
                "latitude_deg = 48.8584 with longitude_deg = 2.2945",
            ));
        }
        if place && sun.elevation_deg.is_some() {
            return Err(SceneError::value(
                "sun.elevation_deg",
                "either an elevation or a place",
                "both",
                "leaving one of them out",
            ));
        }
        for (key, set) in [
            ("sun.azimuth_deg", sun.azimuth_deg.is_some()),
            ("sun.distance_ratio", sun.distance_ratio.is_some()),
        ] {
            if set && sun.elevation_deg.is_none() {
                return Err(SceneError::value(
                    key,
                    "elevation_deg with this key",
                    "none",
                    "elevation_deg = 10",
                ));
            }
        }
        match sun.time.is_some() && !place {
            true => Err(SceneError::value(
                "sun.time",
                "a place with this key",
                "none",
                "latitude_deg = 48.8584 with longitude_deg = 2.2945",
            )),
            false => Ok(()),
        }
    }

    fn validate_night(&self) -> Result<(), SceneError> {
        let night = &self.night;
        number(
            "night.moon_elevation_deg",
            night.moon_elevation_deg,
            ELEVATION,
        )?;
        number("night.moon_azimuth_deg", night.moon_azimuth_deg, FINITE)?;
        number("night.moon_phase_deg", night.moon_phase_deg, PHASE)?;
        number("night.solar_flux_sfu", night.solar_flux_sfu, SOLAR_FLUX)?;
        number("night.sky_quality_mag", night.sky_quality_mag, SKY_QUALITY)?;
        number("night.latitude_deg", night.latitude_deg, ELEVATION)?;
        let refuse = |key, expected, tip| Err(SceneError::value(key, expected, "none", tip));
        if night.moon_azimuth_deg.is_some() && night.moon_elevation_deg.is_none() {
            return refuse(
                "night.moon_azimuth_deg",
                "moon_elevation_deg with this key",
                "moon_elevation_deg = 30",
            );
        }
        if night.moon == Some(false)
            && (night.moon_elevation_deg.is_some() || night.moon_phase_deg.is_some())
        {
            return Err(SceneError::value(
                "night.moon",
                "a moon for its elevation and phase",
                "false",
                "leaving it out",
            ));
        }
        let place = self.sun.latitude_deg.is_some();
        if night.moon_phase_deg.is_some() && night.moon_elevation_deg.is_none() && !place {
            return refuse(
                "night.moon_phase_deg",
                "moon_elevation_deg with this key, or a place and a time",
                "moon_elevation_deg = 30",
            );
        }
        match night.latitude_deg.is_some() && place {
            true => Err(SceneError::value(
                "night.latitude_deg",
                "a fixed sun with this key",
                "a place",
                "leaving it out",
            )),
            false => Ok(()),
        }
    }

    fn validate_air(&self) -> Result<(), SceneError> {
        let air = &self.air;
        number("air.humidity", air.humidity, FINITE)?;
        number("air.aod_550", air.aod_550, NOT_NEGATIVE)?;
        number("air.turbidity", air.turbidity, POSITIVE)?;
        number("air.haze_visibility_m", air.haze_visibility_m, POSITIVE)?;
        number("air.contrast", air.contrast, CONTRAST)?;
        number("air.ozone_du", air.ozone_du, NOT_NEGATIVE)?;
        number("air.ground_albedo", air.ground_albedo, FRACTION)?;
        number("air.ground_altitude_m", air.ground_altitude_m, ALTITUDE)?;
        let amounts = [
            ("air.aod_550", air.aod_550.is_some()),
            ("air.turbidity", air.turbidity.is_some()),
            ("air.haze_visibility_m", air.haze_visibility_m.is_some()),
        ];
        let mut set = amounts.iter().filter(|(_, set)| *set).map(|(key, _)| *key);
        if let (Some(first), Some(second)) = (set.next(), set.next()) {
            return Err(SceneError::value(
                second,
                "one amount of haze",
                format!("{first} as well"),
                "leaving one of them out",
            ));
        }
        match air.humidity.is_some() && air.aerosol.is_none() {
            true => Err(SceneError::value(
                "air.humidity",
                "aerosol with particles that grow in moist air",
                "none",
                "aerosol = \"urban\"",
            )),
            false => Ok(()),
        }
    }

    fn validate_solver(&self) -> Result<(), SceneError> {
        let solver = &self.solver;
        if let Some(paths) = solver
            .paths
            .filter(|paths| !(128..=1_000_000_000_000).contains(paths))
        {
            let expected = "a whole number from 128 to 1e12";
            return Err(SceneError::value(
                "solver.paths",
                expected,
                paths.to_string(),
                "256",
            ));
        }
        number("solver.zenith_lux", solver.zenith_lux, POSITIVE)?;
        if solver.sunlight == Some(SunlightKind::Measured) && solver.zenith_lux.is_some() {
            return Err(SceneError::value(
                "solver.zenith_lux",
                "a white sun",
                "sunlight = \"measured\"",
                "leaving zenith_lux out, or sunlight = \"white\"",
            ));
        }
        let klassen = &solver.klassen1987;
        for (key, value, allowed) in [
            (
                "haze_extinction_per_m",
                klassen.haze_extinction_per_m,
                NOT_NEGATIVE,
            ),
            ("haze_thickness_m", klassen.haze_thickness_m, POSITIVE),
            ("air_density", klassen.air_density, POSITIVE),
            ("air_thickness_m", klassen.air_thickness_m, POSITIVE),
        ] {
            number(format!("solver.klassen1987.{key}"), value, allowed)?;
        }
        Ok(())
    }

    fn validate_picture(&self) -> Result<(), SceneError> {
        let (camera, output) = (&self.camera, &self.output);
        if let Some([width, height]) = camera.size
            && ![width, height]
                .iter()
                .all(|side| (1..=65536).contains(side))
        {
            return Err(SceneError::value(
                "camera.size",
                "width and height in pixels, each from 1 to 65536",
                format!("[{width}, {height}]"),
                "[2048, 1024]",
            ));
        }
        number("camera.azimuth_deg", camera.azimuth_deg, FINITE)?;
        number("camera.elevation_deg", camera.elevation_deg, ELEVATION)?;
        number("camera.roll_deg", camera.roll_deg, FINITE)?;
        number("camera.fov_deg", camera.fov_deg, POSITIVE)?;
        number("output.scale", output.scale, POSITIVE)?;
        number("output.white_balance_k", output.white_balance_k, KELVIN)?;
        number("output.brighten", output.brighten, FINITE)?;
        let camera_curve = matches!(output.tone, None | Some(ToneKind::Camera));
        for (key, value, allowed) in [
            ("output.tone_contrast", output.tone_contrast, TONE_CONTRAST),
            ("output.saturation", output.saturation, SATURATION),
        ] {
            number(key, value, allowed)?;
            if let (Some(value), false) = (value, camera_curve) {
                return Err(SceneError::value(
                    key,
                    "the tone curve camera with it",
                    format!("{value} with another"),
                    "output.tone = \"camera\"",
                ));
            }
        }
        let ev100 = output.exposure.and_then(Exposure::ev100);
        number("output.exposure", ev100, FINITE)?;
        if let Some(bits) = output.bits.filter(|bits| ![8, 16].contains(bits)) {
            return Err(SceneError::value(
                "output.bits",
                "8 or 16",
                bits.to_string(),
                "8",
            ));
        }
        if let Some(quality) = output
            .quality
            .filter(|quality| !(1..=100).contains(quality))
        {
            return Err(SceneError::value(
                "output.quality",
                "a whole number from 1 to 100",
                quality.to_string(),
                "92",
            ));
        }
        let Some(sequence) = &self.sequence else {
            return Ok(());
        };
        let missing = |key: &str, other: &str, example: &str| {
            let expected = format!("{other} with this key");
            Err(SceneError::value(key, expected, "none", example))
        };
        let times = (sequence.until.is_some(), sequence.every.is_some());
        match times {
            (true, false) => missing("sequence.until", "every", "every = \"10m\""),
            (false, true) => missing("sequence.every", "until", "until = \"+6h\""),
            (false, false) if sequence.meter_each.is_some() => missing(
                "sequence.meter_each",
                "a sequence",
                "until = \"+6h\" and every = \"10m\"",
            ),
            _ => Ok(()),
        }
    }
}

fn layer(key: &str, layer: &FogLayerSpec) -> Result<(), SceneError> {
    number(format!("{key}.visibility_m"), layer.visibility_m, LENGTH)?;
    number(
        format!("{key}.scale_height_m"),
        layer.scale_height_m,
        LENGTH,
    )?;
    number(format!("{key}.base_height_m"), layer.base_height_m, FINITE)?;
    number(format!("{key}.top_m"), layer.top_m, LENGTH)?;
    let implied = layer.profile.is_none();
    let thins = layer.scale_height_m.is_some() || layer.base_height_m.is_some();
    match implied && layer.top_m.is_some() && thins {
        true => Err(SceneError::value(
            format!("{key}.top_m"),
            "a slab of constant density",
            "scale_height_m or base_height_m as well",
            "leaving one of them out, or setting profile",
        )),
        false => Ok(()),
    }
}

fn patches(patches: &FogPatchesSpec) -> Result<(), SceneError> {
    number("fog.patches.strength", patches.strength, PATCH_STRENGTH)?;
    number("fog.patches.size_m", patches.size_m, LENGTH)?;
    number("fog.patches.height_m", patches.height_m, LENGTH)?;
    number("fog.patches.time_s", patches.time_s, FINITE)?;
    for velocity in patches.wind_m_s.into_iter().flatten() {
        number("fog.patches.wind_m_s", Some(velocity), FINITE)?;
    }
    match patches.time_s.is_some() && patches.wind_m_s.is_none() {
        true => Err(SceneError::value(
            "fog.patches.time_s",
            "wind_m_s with this key",
            "none",
            "wind_m_s = [2, 0]",
        )),
        false => Ok(()),
    }
}

fn light(key: &str, light: &LightSpec) -> Result<(), SceneError> {
    let at = |field: &str| format!("{key}.{field}");
    number(at("distance_m"), light.distance_m, LENGTH)?;
    number(at("radius_m"), light.radius_m, LENGTH)?;
    number(at("azimuth_deg"), light.azimuth_deg, FINITE)?;
    number(at("elevation_deg"), light.elevation_deg, ELEVATION)?;
    number(at("inner_deg"), light.inner_deg, CONE)?;
    number(at("outer_deg"), light.outer_deg, CONE)?;
    for coordinate in light
        .position_m
        .iter()
        .flatten()
        .chain(light.pixel.iter().flatten())
    {
        number(key, Some(*coordinate), FINITE)?;
    }
    let bright = light.intensity.iter().any(|v| *v > 0.0);
    if !bright || !light.intensity.iter().all(|v| v.is_finite() && *v >= 0.0) {
        return Err(SceneError::value(
            at("intensity"),
            "three numbers, 0 or above, not all 0",
            format!("{:?}", light.intensity),
            "[3, 2.5, 2]",
        ));
    }
    if light.position_m.is_some() == light.pixel.is_some() {
        let got = if light.pixel.is_some() {
            "both"
        } else {
            "none"
        };
        return Err(SceneError::value(
            at("position_m"),
            "either position_m or pixel",
            got,
            "position_m = [1, 5, -10]",
        ));
    }
    if light.distance_m.is_some() && light.pixel.is_none() {
        return Err(SceneError::value(
            at("distance_m"),
            "pixel with this key",
            "position_m",
            "leaving it out",
        ));
    }
    if light.kind == LightKind::Sphere && light.radius_m.is_none() {
        return Err(SceneError::value(
            at("radius_m"),
            "the radius of the sphere",
            "none",
            "radius_m = 0.2",
        ));
    }
    let cone = [
        light.azimuth_deg,
        light.elevation_deg,
        light.inner_deg,
        light.outer_deg,
    ];
    match light.kind != LightKind::Spot && cone.iter().any(Option::is_some) {
        true => Err(SceneError::value(
            at("kind"),
            "spot with azimuth_deg, elevation_deg, inner_deg and outer_deg",
            "another kind",
            "kind = \"spot\"",
        )),
        false => Ok(()),
    }
}
