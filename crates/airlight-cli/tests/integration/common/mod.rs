//! Running the program in folders that go away, reading what it wrote.

#[path = "../../../../airlight-image/tests/integration/common/folder.rs"]
mod folder;

pub use folder::Folder;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

/// The program, to be run in a folder, with words split at spaces.
pub fn command(folder: &Folder, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airlight"));
    command
        .current_dir(folder.file(""))
        .args(words.split_whitespace());
    for variable in ["COLORTERM", "TERM", "NO_COLOR"] {
        command.env_remove(variable);
    }
    command
}

/// Runs it.
pub fn run(folder: &Folder, words: &str) -> Output {
    command(folder, words).output().unwrap()
}

/// Runs it and expects success; standard output.
pub fn succeed(folder: &Folder, words: &str) -> String {
    let output = run(folder, words);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// The number after a text.
pub fn number_after(text: &str, before: &str) -> f64 {
    let start = text
        .find(before)
        .unwrap_or_else(|| panic!("no `{before}` in {text}"))
        + before.len();
    let word: String = text[start..]
        .trim_start()
        .chars()
        .take_while(|c| !c.is_whitespace())
        .collect();
    word.parse()
        .unwrap_or_else(|_| panic!("`{word}` after `{before}`"))
}

/// An EXR file's samples and texts.
pub struct Exr {
    pub width: u32,
    pub height: u32,
    pub channels: BTreeMap<String, Vec<f32>>,
    pub texts: BTreeMap<String, String>,
}

impl Exr {
    pub fn read(path: &Path) -> Self {
        use exr::prelude::*;
        let image = read_first_flat_layer_from_file(path).unwrap();
        let layer = image.layer_data;
        let text = |value: &AttributeValue| match value {
            AttributeValue::Text(text) => Some(text.to_string()),
            _ => None,
        };
        Self {
            width: layer.size.0 as u32,
            height: layer.size.1 as u32,
            channels: layer
                .channel_data
                .list
                .iter()
                .map(|channel| {
                    (
                        channel.name.to_string(),
                        channel.sample_data.values_as_f32().collect(),
                    )
                })
                .collect(),
            texts: layer
                .attributes
                .other
                .iter()
                .filter_map(|(name, value)| Some((name.to_string(), text(value)?)))
                .collect(),
        }
    }

    /// Luminance of linear sRGB.
    pub fn luminance(&self, x: u32, y: u32) -> f64 {
        let at = (y * self.width + x) as usize;
        let [r, g, b] = ["R", "G", "B"].map(|name| f64::from(self.channels[name][at]));
        0.212_639 * r + 0.715_169 * g + 0.072_192 * b
    }
}
