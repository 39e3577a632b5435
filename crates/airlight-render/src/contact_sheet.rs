//! Contact sheets: pictures of several scenes side by side, described by one TOML file.
//!
//! ```toml
//! title = "Suns through haze"
//! columns = 3
//!
//! [scene]                     # shared by all pictures
//! air.aod_550 = 0.3
//! camera = { projection = "perspective", size = [320, 180] }
//!
//! [[cell]]                    # a label, and overrides of the scene
//! label = "10 degrees"
//! sun.elevation_deg = 10
//! ```
//!
//! An input of the common scene that the solver of one picture ignores applies only to pictures whose solver honours it.

use crate::error::RenderError;
use crate::scene_file;
use airlight::models::registry;
use airlight::scene::{RadianceModel, Scene, SceneDocument, SceneError};
use serde::Deserialize;
use std::path::Path;

/// Largest number of columns.
const MOST_COLUMNS: usize = 64;
/// Default number of columns.
const COLUMNS: usize = 3;

/// Description of a contact sheet.
#[derive(Clone, Debug)]
pub struct ContactSheetSpec {
    /// Heading above the pictures; may be empty.
    pub title: String,
    /// Number of pictures in a row.
    pub columns: usize,
    /// Label and scene of each picture.
    pub cells: Vec<(String, Scene)>,
}

/// Keys of a file besides scenes.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Sheet {
    title: String,
    columns: Option<usize>,
}

/// Keys of a cell besides its scene.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Cell {
    label: String,
}

impl ContactSheetSpec {
    /// Reads a file and the files that its scenes name.
    ///
    /// # Errors
    /// [`RenderError`] for files that cannot be read, and for invalid keys and values, with their place.
    pub fn load(path: &Path) -> Result<Self, RenderError> {
        let text = scene_file::read_text(path, "TOML")?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut sheet = Self::from_toml(&text).map_err(|error| {
            RenderError::setting(format!("contact sheet `{}`: {error}", path.display()))
        })?;
        for (_, scene) in &mut sheet.cells {
            scene_file::inline_files(scene, folder)?;
        }
        Ok(sheet)
    }

    /// Parses a text. Files that its scenes name are not read.
    ///
    /// # Errors
    /// [`SceneError`] for invalid keys and values, with their place.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let document = SceneDocument::new(text)?;
        let sheet: Sheet = document.read(&[""], &["scene", "cell"])?;
        let count = document.count("cell")?;
        let wrong = |key: &str, expected: &str, got: String, tip: &str| SceneError::Value {
            key: key.to_owned(),
            expected: expected.to_owned(),
            got,
            try_instead: tip.to_owned(),
        };
        if count == 0 {
            let tip = "[[cell]] with sun.elevation_deg = 10";
            return Err(wrong("cell", "a list of pictures", "none".to_owned(), tip));
        }
        let columns = sheet.columns.unwrap_or(COLUMNS.min(count));
        if !(1..=MOST_COLUMNS).contains(&columns) {
            let expected = "a whole number from 1 to 64";
            return Err(wrong("columns", expected, columns.to_string(), "3"));
        }
        // A single layer need not be a valid scene.
        let common = document.partial_scene(&["scene"], &[])?.set_inputs();
        let mut own_inputs = Vec::with_capacity(count);
        let mut cells = (0..count)
            .map(|number| {
                let path = format!("cell[{number}]");
                let own = document.partial_scene(&[&path], &["label"])?;
                own_inputs.push(own.set_inputs());
                let scene = document.scene(&["scene", &path], &["label"])?;
                for (key, set) in [
                    ("output.file", scene.output.file.is_some()),
                    ("sequence", scene.sequence.is_some()),
                ] {
                    if set {
                        let (expected, got) =
                            ("a picture of the sheet", "a file or sequence of its own");
                        let key = format!("{path}.{key}");
                        return Err(wrong(&key, expected, got.to_owned(), "leaving it out"));
                    }
                }
                let cell: Cell = document.read(&[&path], &[])?;
                Ok((cell.label, scene))
            })
            .collect::<Result<Vec<_>, SceneError>>()?;
        let models = cells
            .iter()
            .map(|(_, scene)| {
                registry::find(scene.solver.name.as_deref().unwrap_or(registry::DEFAULT))
            })
            .collect::<Result<Vec<_>, SceneError>>()?;
        for (((_, scene), model), own) in cells.iter_mut().zip(&models).zip(&own_inputs) {
            for &input in common.iter().filter(|input| !own.contains(input)) {
                let honoured = |model: &&dyn RadianceModel| model.capabilities().honours(input);
                if !honoured(model) && models.iter().any(honoured) {
                    *scene = std::mem::take(scene).without(input);
                }
            }
        }
        Ok(Self {
            title: sheet.title,
            columns,
            cells,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_override_the_common_scene() {
        let text = "title = \"Suns\"\ncolumns = 2\n[scene]\nsun.elevation_deg = 5\nair.aod_550 = 0.3\n\
            [[cell]]\nlabel = \"low\"\n[[cell]]\nlabel = \"set\"\nsun.elevation_deg = -1.5\n\
            [[cell]]\nlabel = \"aside\"\nsun.azimuth_deg = 90\n";
        let sheet = ContactSheetSpec::from_toml(text).unwrap();
        assert_eq!((sheet.title.as_str(), sheet.columns), ("Suns", 2));
        let suns: Vec<_> = sheet
            .cells
            .iter()
            .map(|(label, scene)| (label.as_str(), scene.sun.elevation_deg, scene.air.aod_550))
            .collect();
        assert_eq!(
            suns,
            [
                ("low", Some(5.0), Some(0.3)),
                ("set", Some(-1.5), Some(0.3)),
                ("aside", Some(5.0), Some(0.3))
            ]
        );
    }

    #[test]
    fn inputs_of_the_common_scene_apply_to_solvers_that_honour_them() {
        let text = "[scene]\nair.ozone_du = 200\n[[cell]]\nlabel = \"orders\"\n\
            [[cell]]\nlabel = \"formula\"\nsolver.name = \"preetham\"\n\
            [[cell]]\nlabel = \"wrong\"\nsolver.name = \"preetham\"\nair.ozone_du = 300\n";
        let sheet = ContactSheetSpec::from_toml(text).unwrap();
        let ozone: Vec<_> = sheet.cells.iter().map(|(_, s)| s.air.ozone_du).collect();
        // Inputs of a single picture are refused by the renderer.
        assert_eq!(ozone, [Some(200.0), None, Some(300.0)]);
        let alone = "[scene]\nair.ozone_du = 200\n[[cell]]\nsolver.name = \"preetham\"\n";
        let sheet = ContactSheetSpec::from_toml(alone).unwrap();
        assert_eq!(sheet.cells[0].1.air.ozone_du, Some(200.0));
    }

    #[test]
    fn errors_have_a_place() {
        for (text, part) in [
            ("tilte = 1", "line 1"),
            ("title = \"x\"", "expected a list of pictures"),
            ("columns = 0\n[[cell]]", "from 1 to 64"),
            ("[[cell]]\nsun.elevation_deg = 500", "line 2"),
            ("[[cell]]\nsunny = 5", "sunny"),
            ("[[cell]]\noutput.file = \"x.png\"", "cell[0].output.file"),
            ("cell = 3", "list of tables"),
        ] {
            let error = ContactSheetSpec::from_toml(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
