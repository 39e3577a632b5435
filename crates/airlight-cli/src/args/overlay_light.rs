//! Options of `airlight fog` that say what shines on the fog, and what other layers there are.

use super::fog::DropletsArg;
use crate::parse::{self, LatLon, words::Words};
use airlight::fog::lights::LightForm;
use clap::{Args, ValueEnum};
use serde::Serialize;

/// Whether the clear air before things is in the picture already.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum AirArg {
    /// It is, as in every photograph.
    Drawn,
    /// It is left out, as in many a rendered picture: it is added.
    Missing,
}

/// How the light of lamps that fog scatters is worked out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum LightFormArg {
    /// Dimmed by the fog from the lamp and to the eye, in any fog (Sun et al. 2005 in even fog).
    #[default]
    Exact,
    /// Opacity of the line of sight times the mean of its source: the fog note's split sum.
    SplitSum,
    /// Not dimmed by the fog; the fog note's with the right angle and unit.
    NoExtinction,
    /// As the fog note prints it, too bright by 40, and negative where the lamp is passed.
    Printed,
}

impl LightFormArg {
    /// In the lamps' words.
    pub fn form(self) -> LightForm {
        match self {
            Self::Exact => LightForm::Exact,
            Self::SplitSum => LightForm::SplitSum,
            Self::NoExtinction => LightForm::NoExtinction,
            Self::Printed => LightForm::Printed,
        }
    }
}

/// Light and layers.
#[derive(Clone, Debug, Args, Serialize)]
pub struct OverlayLightArgs {
    /// A layer of fog more, as in 'visibility=500 scale-height=20': may be given many times
    ///
    /// Words KEY=VALUE: visibility (m, as --visibility-m); scale-height (m: thins to 1/e), base (m: from there on) or top
    /// (m: nothing above); droplets (as --droplets). With neither scale-height nor top it is the same
    /// everywhere.
    #[arg(long, value_name = "WORDS", value_parser = LayerArg::parse, help_heading = "Fog")]
    pub layer: Vec<LayerArg>,

    /// A lamp in the fog, as in 'pixel=320,120 distance=6 intensity=3,2.5,2': may be given many times
    ///
    /// Words KEY=VALUE. Where: pixel=X,Y with distance (m along the ray; without it, that of what the picture shows there),
    /// or at=EAST,UP,SOUTH (m from the ground under the camera; a camera of azimuth 0 looks north, to negative south).
    /// intensity=R,G,B or one number: radiant intensity in the picture's unit times m^2; it gives the irradiance
    /// intensity / r^2, and pi makes a white wall 1 m away as bright as 1. kind: point, spot or sphere. radius (m): its
    /// size; of a point or spot, no line of sight passes closer [default: a quarter of a pixel]. A spot shines to azimuth
    /// and elevation (degrees) [default: straight down], with all its intensity up to inner [default: 20] and none from
    /// outer [default: 40] degrees off its axis.
    #[arg(long, value_name = "WORDS", value_parser = LightArg::parse, help_heading = "Light")]
    pub lamp: Vec<LightArg>,
    /// How the light of lamps is worked out; all but exact are for --model uniform --droplets isotropic and point lamps
    #[arg(
        long,
        value_enum,
        value_name = "FORM",
        default_value_t,
        help_heading = "Light"
    )]
    pub lamp_form: LightFormArg,

    /// Light the fog by the sun and the sky that the solver finds for --sun-elevation, or for --at and --when
    #[arg(long, help_heading = "Light", conflicts_with = "sun_strength")]
    pub sky_light: bool,
    /// Atmosphere of --sky-light: a name or a TOML file, as `airlight sky` has it
    #[arg(
        long,
        value_name = "NAME|FILE.toml",
        default_value = "average",
        help_heading = "Light"
    )]
    pub atmosphere: String,
    /// Optical depth of its haze at 550 nm
    #[arg(long, value_name = "DEPTH", value_parser = parse::not_negative, help_heading = "Light", requires = "sky_light")]
    pub aod_550: Option<f64>,
    /// Place of --sky-light: latitude,longitude in degrees, instead of --sun-elevation
    #[arg(long, value_name = "LAT,LON", value_parser = parse::lat_lon, help_heading = "Light", requires = "sky_light")]
    #[arg(conflicts_with = "sun_elevation", requires = "when")]
    pub at: Option<LatLon>,
    /// Time at that place, as in 2026-06-21T21:15:00+02:00
    #[arg(long, value_name = "TIME", help_heading = "Light", requires = "at")]
    pub when: Option<String>,
    /// Altitude of the ground above sea level, m
    #[arg(long, value_name = "M", value_parser = parse::altitude_m, help_heading = "Light", requires = "sky_light")]
    pub ground_altitude_m: Option<f64>,
    /// Units of the picture in one cd/m^2 [default: as an EXR file states its white; else matched to the picture's sky]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive, help_heading = "Light", requires = "sky_light")]
    pub radiance_scale: Option<f64>,
    /// Whether the clear air before things is drawn in the picture already, or missing and to be added
    #[arg(long, value_enum, default_value_t = AirArg::Drawn, help_heading = "Light", requires = "sky_light")]
    pub air: AirArg,
}

/// A layer of fog.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerArg {
    /// How far one sees where it is thickest, m.
    pub visibility_m: f64,
    /// How it thins.
    pub shape: LayerShape,
    /// Its drops.
    pub droplets: DropletsArg,
}

/// How a layer thins with height.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LayerShape {
    /// Not at all.
    Uniform,
    /// Exponentially from height 0, m.
    Height { scale_height_m: f64 },
    /// The same up to a height, and exponentially above.
    Clamped { base_m: f64, scale_height_m: f64 },
    /// Exponentially, above the height and below it.
    Unclamped { base_m: f64, scale_height_m: f64 },
    /// The same up to a height, and nothing above.
    Slab { top_m: f64 },
}

impl LayerArg {
    fn parse(text: &str) -> Result<Self, String> {
        let mut words = Words::new(
            text,
            &["visibility", "scale-height", "base", "top", "droplets"],
        )?;
        let visibility_m = words
            .take("visibility", parse::length_m)?
            .ok_or("needs visibility=METRES, how far one sees where the layer is thickest")?;
        let scale_height_m = words.take("scale-height", parse::length_m)?;
        let base_m = words.take("base", parse::number)?;
        let top_m = words.take("top", parse::length_m)?;
        let droplets = words.take("droplets", DropletsArg::parse)?;
        let shape = match (scale_height_m, base_m, top_m) {
            (None, None, None) => LayerShape::Uniform,
            (Some(scale_height_m), None, None) => LayerShape::Height { scale_height_m },
            (Some(scale_height_m), Some(base_m), None) => LayerShape::Clamped {
                base_m,
                scale_height_m,
            },
            (None, None, Some(top_m)) => LayerShape::Slab { top_m },
            (None, Some(_), None) => return Err("base needs scale-height=METRES".to_owned()),
            (_, _, Some(_)) => {
                return Err(
                    "a layer with a top is even below it: leave out scale-height and base"
                        .to_owned(),
                );
            }
        };
        Ok(Self {
            visibility_m,
            shape,
            droplets: droplets.unwrap_or_default(),
        })
    }
}

/// A lamp.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightArg {
    /// Where it is.
    pub place: LightPlace,
    /// Radiant intensity in the picture's unit times m^2.
    pub intensity: [f64; 3],
    /// Its size, m.
    pub radius_m: Option<f64>,
    /// What shines how.
    pub kind: LightKind,
}

/// Where a lamp is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightPlace {
    /// Metres east, up and south of the ground under the camera.
    At([f64; 3]),
    /// On the ray of a pixel, so many metres away; else where the picture's surface is.
    Pixel {
        x: f64,
        y: f64,
        distance_m: Option<f64>,
    },
}

/// What shines how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightKind {
    /// Equally in all directions.
    Point,
    /// Into a cone; degrees.
    Spot {
        azimuth: f64,
        elevation: f64,
        inner: f64,
        outer: f64,
    },
    /// A glowing ball.
    Sphere,
}

impl LightArg {
    fn parse(text: &str) -> Result<Self, String> {
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
        let place = match (
            words.take("pixel", parse::two_numbers)?,
            words.take("at", parse::three_coordinates)?,
            words.take("distance", parse::length_m)?,
        ) {
            (Some((x, y)), None, distance_m) => LightPlace::Pixel { x, y, distance_m },
            (None, Some(at), None) => LightPlace::At(at),
            (None, Some(_), Some(_)) => {
                return Err("distance goes with pixel=X,Y, not with at".to_owned());
            }
            (Some(_), Some(_), _) => {
                return Err("pixel and at both say where the lamp is: leave one out".to_owned());
            }
            (None, None, _) => {
                return Err(
                    "needs pixel=X,Y or at=EAST,UP,SOUTH to say where the lamp is".to_owned(),
                );
            }
        };
        let intensity = words
            .take("intensity", intensity)?
            .ok_or("needs intensity=R,G,B: radiant intensity in the picture's unit times m^2")?;
        let radius_m = words.take("radius", parse::length_m)?;
        let angle = |right, most: f64| {
            move |text: &str| match parse::number(text) {
                Ok(angle) if (0.0..=most).contains(&angle) => Ok(angle),
                _ => Err(format!("must be {right}")),
            }
        };
        let azimuth = words.take("azimuth", parse::number)?;
        let elevation = words.take("elevation", parse::elevation_deg)?;
        let inner = words.take("inner", angle("a number of degrees from 0 to 90", 90.0))?;
        let outer = words.take("outer", angle("a number of degrees from 0 to 90", 90.0))?;
        let beam = [azimuth, elevation, inner, outer]
            .iter()
            .any(Option::is_some);
        let kind = match words.take("kind", |kind| Ok(kind.to_owned()))?.as_deref() {
            None | Some("point") if beam => {
                return Err("azimuth, elevation, inner and outer are for kind=spot".to_owned());
            }
            Some("sphere") if beam => {
                return Err("a sphere shines everywhere: azimuth, elevation, inner and outer are for kind=spot".to_owned());
            }
            Some("sphere") if radius_m.is_none() => {
                return Err("a sphere needs radius=METRES".to_owned());
            }
            None | Some("point") => LightKind::Point,
            Some("sphere") => LightKind::Sphere,
            Some("spot") => {
                let outer = outer.unwrap_or_else(|| inner.map_or(40.0, |inner| inner.max(40.0)));
                LightKind::Spot {
                    azimuth: azimuth.unwrap_or(0.0),
                    elevation: elevation.unwrap_or(-90.0),
                    inner: inner.unwrap_or(20.0_f64.min(outer)),
                    outer,
                }
            }
            Some(other) => {
                return Err(format!(
                    "kind must be point, spot or sphere, got \"{other}\""
                ));
            }
        };
        Ok(Self {
            place,
            intensity,
            radius_m,
            kind,
        })
    }
}

/// Three numbers or one for all, at least one of them above 0.
fn intensity(text: &str) -> Result<[f64; 3], String> {
    let numbers = match text.contains(',') {
        true => parse::three_numbers(text)?,
        false => [parse::not_negative(text)?; 3],
    };
    match numbers.iter().any(|v| *v > 0.0) {
        true => Ok(numbers),
        false => Err("must be above 0: a lamp that is dark does nothing".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_what_their_words_say() {
        let shape = |text| LayerArg::parse(text).map(|layer| layer.shape);
        assert_eq!(shape("visibility=200"), Ok(LayerShape::Uniform));
        assert_eq!(
            shape("top=9  visibility=200"),
            Ok(LayerShape::Slab { top_m: 9.0 })
        );
        let clamped = LayerShape::Clamped {
            base_m: -3.0,
            scale_height_m: 20.0,
        };
        assert_eq!(shape("visibility=5 scale-height=20 base=-3"), Ok(clamped));
        for (text, sentence) in [
            ("", "visibility="),
            ("visibility=0", "above 0"),
            ("visibility=NaN", "above 0"),
            ("visibility=5 base=3", "scale-height"),
            ("visibility=5 top=3 scale-height=3", "even below"),
            (
                "visibility=5 droplets=soup",
                "droplets knows no soup: there are fine,",
            ),
            ("visibility=5 visibility=6", "twice"),
            ("visibility=5 colour=red", "colour"),
            ("visibility", "KEY=VALUE"),
        ] {
            let error = LayerArg::parse(text).unwrap_err();
            assert!(error.contains(sentence), "{text}: {error}");
        }
    }

    #[test]
    fn lamps_are_what_their_words_say() {
        let lamp = LightArg::parse("pixel=3,4 intensity=2").unwrap();
        assert_eq!((lamp.intensity, lamp.kind), ([2.0; 3], LightKind::Point));
        let spot = LightArg::parse("at=1,2,-5 intensity=0,1,2 kind=spot outer=10").unwrap();
        assert_eq!(spot.place, LightPlace::At([1.0, 2.0, -5.0]));
        let LightKind::Spot {
            inner,
            outer,
            elevation,
            ..
        } = spot.kind
        else {
            panic!("{spot:?}");
        };
        assert_eq!((inner, outer, elevation), (10.0, 10.0, -90.0));
        for (text, sentence) in [
            ("intensity=1", "pixel=X,Y or at="),
            ("pixel=1,2", "intensity="),
            ("pixel=1,2 at=1,2,3 intensity=1", "leave one out"),
            ("at=1,2,3 distance=4 intensity=1", "pixel"),
            ("at=1,2 intensity=1", "three numbers"),
            ("at=1,NaN,2 intensity=1", "three numbers"),
            ("at=1,2,3 intensity=0", "above 0"),
            ("at=1,2,3 intensity=0,0,0", "above 0"),
            ("at=1,2,3 intensity=-1", "0 or above"),
            ("at=1,2,3 intensity=nan", "0 or above"),
            ("at=1,2,3 intensity=1 kind=sphere", "radius"),
            ("at=1,2,3 intensity=1 kind=tube", "point, spot or sphere"),
            ("at=1,2,3 intensity=1 outer=4", "kind=spot"),
            ("at=1,2,3 intensity=1 kind=spot outer=95", "from 0 to 90"),
            ("at=1,2,3 intensity=1 radius=0", "above 0"),
        ] {
            let error = LightArg::parse(text).unwrap_err();
            assert!(error.contains(sentence), "{text}: {error}");
        }
    }
}
