//! What a manifest says of a picture.

use super::super::picture::{Fogged, Subject};
use super::inputs::Input;
use crate::args::{ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use crate::error::CliError;
use airlight::fog::visibility::extinction_per_m;
use serde::Serialize;
use serde_json::{Map, Value};

/// A picture of a batch.
#[derive(Serialize)]
pub struct Which<'a> {
    /// From the folder of the manifest.
    pub output: &'a str,
    pub name: String,
    pub variant: u32,
    pub colour: String,
    pub depth: String,
}

/// A picture that is made.
#[derive(Serialize)]
struct Made<'a> {
    #[serde(flatten)]
    which: &'a Which<'a>,
    #[serde(flatten)]
    options: &'a OverlayArgs,
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    /// Where the fog is thickest; the looks that have none say nothing.
    extinction_per_m: Option<f64>,
    ambient_rgb: [f32; 3],
    ambient_from: &'static str,
    width: u32,
    height: u32,
    /// Focal lengths across and down, pixels.
    focal_lengths_px: (f64, f64),
    /// Where the axis meets the picture, pixels from its upper left corner.
    axis_px: (f64, f64),
    unknown_depths: u64,
    infinite_depths: u64,
    airlight: &'static str,
}

/// A picture that could not be made.
#[derive(Serialize)]
struct Failed<'a> {
    #[serde(flatten)]
    which: &'a Which<'a>,
    error: &'a str,
    airlight: &'static str,
}

/// Options that lines of older versions do not mention, and what those pictures were made with.
const LATER: [(&str, &str); 2] = [("scattering", "all"), ("lamp_form", "exact")];

const VERSION: &str = env!("CARGO_PKG_VERSION");

impl<'a> Which<'a> {
    pub fn new(input: &Input, variant: u32, output: &'a str) -> Self {
        Self {
            output,
            name: input.name(),
            variant,
            colour: input.colour.to_string_lossy().into_owned(),
            depth: input.depth.to_string_lossy().into_owned(),
        }
    }

    /// What is said of it once it is made, with these options.
    pub fn made(
        &'a self,
        options: &'a OverlayArgs,
        subject: &Subject,
        fogged: &Fogged,
    ) -> impl Serialize + 'a {
        let size = subject.picture.size;
        Made {
            which: self,
            options,
            seed: (!options.batch.vary.is_empty()).then(|| options.batch.seed.unwrap_or_default()),
            extinction_per_m: match options.model {
                ModelArg::Exp2 | ModelArg::Linear => None,
                _ => Some(extinction_per_m(
                    options.visibility_m,
                    contrast(&options.contrast),
                )),
            },
            ambient_rgb: fogged.level.colour.0,
            ambient_from: fogged.level.how,
            width: size.width(),
            height: size.height(),
            focal_lengths_px: fogged.camera.focal_px(),
            axis_px: fogged.camera.principal_px(),
            unknown_depths: subject.depth.holes,
            infinite_depths: subject.depth.infinite,
            airlight: VERSION,
        }
    }

    /// What is said of it where it cannot be made.
    pub fn failed(&'a self, error: &'a str) -> impl Serialize + 'a {
        Failed {
            which: self,
            error,
            airlight: VERSION,
        }
    }

    /// How a line differs from what would be made now, as `visibility_m was 50, is 60`; empty where it does not. What the
    /// line does not mention is taken to be the same, but for options that came later.
    ///
    /// # Errors
    /// [`CliError::Failure`] where the options cannot be put into JSON.
    pub fn differences(
        &self,
        options: &OverlayArgs,
        line: &Map<String, Value>,
    ) -> Result<Vec<String>, CliError> {
        let json = |error| CliError::failure(format!("cannot put the options into JSON: {error}"));
        let mut now = serde_json::to_value(options).map_err(json)?;
        let of_input = serde_json::to_value(self).map_err(json)?;
        if let (Value::Object(now), Value::Object(of_input)) = (&mut now, of_input) {
            now.extend(of_input);
        }
        let now = now.as_object().cloned().unwrap_or_default();
        let later = |name: &str| LATER.iter().find(|(later, _)| *later == name);
        let was = |name: &String| match line.get(name) {
            Some(was) => Some(was.clone()),
            None => later(name).map(|(_, was)| Value::from(*was)),
        };
        Ok(now
            .iter()
            .filter_map(|(name, is)| Some((name, was(name)?, is)))
            .filter(|(_, was, is)| was != *is)
            .map(|(name, was, is)| format!("{name} was {was}, is {is}"))
            .collect())
    }
}
