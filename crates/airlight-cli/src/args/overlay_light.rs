//! Options of `airlight fog` for light: ambient light, sun, sky, and lights in the fog.

use crate::parse::{self, LatLon, words::Words};
use airlight::fog::lights::LightForm;
use airlight::scene::{LightKind, LightSpec};
use airlight_render::overlay::{ExistingAerial, OverlayScene};
use clap::Args;

/// The ambient light of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AmbientArg {
    /// Estimated from the picture.
    Auto,
    /// Red, green and blue.
    Rgb([f64; 3]),
}

impl AmbientArg {
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            _ => parse::three_numbers(text)
                .map(Self::Rgb)
                .map_err(|error| format!("{error}; try auto")),
        }
    }
}

/// Light of a picture in fog.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Light")]
pub struct OverlayLightArgs {
    /// Radiance of the ambient light, linear, in the picture's unit [default: estimated from the picture]
    #[arg(long, value_name = "auto|R,G,B", value_parser = AmbientArg::parse, allow_hyphen_values = true)]
    pub ambient: Option<AmbientArg>,
    /// Factor on the ambient light [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub ambient_scale: Option<f64>,
    /// Elevation of the sun, degrees [default: no sun]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg)]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun, degrees clockwise from north [default: 180]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub sun_azimuth: Option<f64>,
    /// Irradiance of the sun on a surface that faces it, relative to that of the ambient light (pi times its radiance) [default: 3]
    #[arg(long, value_name = "RATIO", value_parser = parse::not_negative)]
    pub sun_strength: Option<f64>,
    /// Albedo of the ground below fog with a top [default: 0.2; with --sky-light that of the atmosphere]
    #[arg(long, value_name = "ALBEDO", value_parser = parse::fraction)]
    pub ground_albedo: Option<f64>,

    /// Light in the fog, as in 'pixel=320,120 distance=6 intensity=3,2.5,2'; can be repeated
    ///
    /// KEY=VALUE pairs. Position: pixel=X,Y with distance (m along the ray) [default: that of the surface in the picture], or
    /// at=EAST,UP,SOUTH (m from the ground below the camera; a camera with azimuth 0 looks north, to negative south).
    /// intensity=R,G,B or one number: radiant intensity in the picture's unit times m^2, which causes the irradiance
    /// intensity / r^2; with pi, a white wall 1 m away has radiance 1. kind: point, spot or sphere. radius (m): that of a
    /// sphere, or the smallest distance of rays from a point or spot light [default: a quarter of a pixel]. azimuth and
    /// elevation (degrees): axis of a spot light [default: straight down]; its intensity is full up to inner [default: 20] and
    /// 0 beyond outer [default: 40] degrees from the axis.
    #[arg(long, value_name = "LIGHT", value_parser = light)]
    pub light: Vec<LightSpec>,
    /// Form of the light scattered from --light; all but exact are for point lights in uniform isotropic fog [default: exact]
    #[arg(long, value_name = "FORM", value_parser = parse::named::<LightForm>())]
    pub light_form: Option<LightForm>,

    /// Light the fog by the solved sky with its sun (--sun-elevation, or --at and --when), moon and stars instead of the ambient light
    #[arg(long)]
    pub sky_light: bool,
    /// Atmosphere of --sky-light: a name or a TOML file, as for `airlight sky` [default: average]
    #[arg(long, value_name = "NAME|FILE.toml")]
    pub atmosphere: Option<String>,
    /// Optical depth of the haze of --sky-light at 550 nm
    #[arg(long, value_name = "DEPTH", value_parser = parse::not_negative, conflicts_with = "haze_visibility_m")]
    pub aod_550: Option<f64>,
    /// Visibility in the haze of --sky-light at the ground, m: the distance at which contrast falls to --contrast at 550 nm
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub haze_visibility_m: Option<f64>,
    /// Place of --sky-light: latitude,longitude in degrees, instead of --sun-elevation
    #[arg(long, value_name = "LAT,LON", value_parser = parse::lat_lon, allow_hyphen_values = true)]
    #[arg(conflicts_with = "sun_elevation", requires = "when")]
    pub at: Option<LatLon>,
    /// Time at that place, as in 2026-06-21T21:15:00+02:00
    #[arg(long, value_name = "TIME", requires = "at")]
    pub when: Option<String>,
    /// Altitude of the ground above sea level, m [default: 0]
    #[arg(long, value_name = "M", value_parser = parse::altitude_m)]
    pub ground_altitude_m: Option<f64>,
    /// Units of the picture in one cd/m^2 [default: from the white luminance stated in an EXR file, otherwise matched to the
    /// picture's sky]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub radiance_scale: Option<f64>,
    /// Whether the picture shows the clear air in front of its objects, or --sky-light adds it [default: drawn]
    #[arg(long, value_parser = parse::named::<ExistingAerial>())]
    pub air: Option<ExistingAerial>,
}

impl OverlayLightArgs {
    /// Overrides values of a description.
    pub fn fill(&self, to: &mut OverlayScene) {
        let put = |value: &mut Option<f64>, given: Option<f64>| *value = given.or(*value);
        let (scene, overlay) = (&mut to.scene, &mut to.overlay);
        match self.ambient {
            Some(AmbientArg::Auto) => overlay.ambient = None,
            Some(AmbientArg::Rgb(rgb)) => overlay.ambient = Some(rgb),
            None => {}
        }
        overlay.ambient_scale = self.ambient_scale.unwrap_or(overlay.ambient_scale);
        put(&mut overlay.sun_strength, self.sun_strength);
        overlay.sky_light |= self.sky_light;
        put(&mut overlay.radiance_scale, self.radiance_scale);
        overlay.air = self.air.unwrap_or(overlay.air);
        overlay.light_form = self.light_form.unwrap_or(overlay.light_form);
        if !self.light.is_empty() {
            scene.lights = self.light.clone();
        }
        let sun = &mut scene.sun;
        if self.sun_elevation.is_some() {
            (sun.latitude_deg, sun.longitude_deg, sun.time) = (None, None, None);
        }
        if let Some(place) = self.at {
            sun.elevation_deg = None;
            sun.latitude_deg = Some(place.latitude_deg);
            sun.longitude_deg = Some(place.longitude_deg);
        }
        put(&mut sun.elevation_deg, self.sun_elevation);
        put(&mut sun.azimuth_deg, self.sun_azimuth);
        sun.time = self.when.clone().or(sun.time.take());
        let air = &mut scene.air;
        if self.aod_550.is_some() || self.haze_visibility_m.is_some() {
            (air.aod_550, air.haze_visibility_m, air.turbidity) = (None, None, None);
        }
        put(&mut air.aod_550, self.aod_550);
        put(&mut air.haze_visibility_m, self.haze_visibility_m);
        put(&mut air.ground_albedo, self.ground_albedo);
        put(&mut air.ground_altitude_m, self.ground_altitude_m);
        if let Some(atmosphere) = &self.atmosphere {
            air.atmosphere = Some(atmosphere.clone());
            air.atmosphere_toml = None;
        }
    }
}

/// A light from KEY=VALUE pairs.
fn light(text: &str) -> Result<LightSpec, String> {
    const KEYS: [&str; 10] = [
        "pixel",
        "distance",
        "at",
        "intensity",
        "kind",
        "radius",
        "azimuth",
        "elevation",
        "inner",
        "outer",
    ];
    let mut words = Words::new(text, &KEYS)?;
    let angle = |text: &str| match parse::number(text) {
        Ok(angle) if (0.0..=90.0).contains(&angle) => Ok(angle),
        _ => Err("expected a number of degrees from 0 to 90".to_owned()),
    };
    let pixel = words.take("pixel", parse::two_numbers)?;
    Ok(LightSpec {
        kind: words
            .take("kind", parse::value_of::<LightKind>)?
            .unwrap_or_default(),
        position_m: words.take("at", parse::three_coordinates)?,
        pixel: pixel.map(|(x, y)| [x, y]),
        distance_m: words.take("distance", parse::length_m)?,
        intensity: words
            .take("intensity", intensity)?
            .ok_or("expected intensity=R,G,B, got none; try intensity=1")?,
        radius_m: words.take("radius", parse::length_m)?,
        azimuth_deg: words.take("azimuth", parse::number)?,
        elevation_deg: words.take("elevation", parse::elevation_deg)?,
        inner_deg: words.take("inner", angle)?,
        outer_deg: words.take("outer", angle)?,
    })
}

/// Three numbers or one for all.
fn intensity(text: &str) -> Result<[f64; 3], String> {
    match text.contains(',') {
        true => parse::three_numbers(text),
        false => Ok([parse::not_negative(text)?; 3]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_are_parsed() {
        let point = light("pixel=3,4 intensity=2").unwrap();
        assert_eq!((point.intensity, point.kind), ([2.0; 3], LightKind::Point));
        let spot = light("at=1,2,-5 intensity=0,1,2 kind=spot outer=10").unwrap();
        assert_eq!(spot.position_m, Some([1.0, 2.0, -5.0]));
        assert_eq!((spot.kind, spot.outer_deg), (LightKind::Spot, Some(10.0)));
        for (text, part) in [
            ("pixel=1,2", "intensity="),
            ("at=1,2 intensity=1", "three numbers"),
            ("at=1,NaN,2 intensity=1", "three numbers"),
            ("at=1,2,3 intensity=-1", "0 or above"),
            ("at=1,2,3 intensity=nan", "0 or above"),
            ("at=1,2,3 intensity=1 kind=tube", "(point, spot, sphere)"),
            ("at=1,2,3 intensity=1 kind=spot outer=95", "from 0 to 90"),
            ("at=1,2,3 intensity=1 radius=0", "above 0"),
            ("at=1,2,3 intensity=1 wattage=60", "wattage"),
        ] {
            let error = light(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
