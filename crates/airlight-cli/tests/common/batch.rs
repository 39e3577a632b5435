//! Pictures with depth for batches of `airlight fog`, and their manifests.

use super::{Folder, run};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// A folder with pictures `rgb/NAME.png` and depths `depth/NAME.png`.
pub fn pictures(names: &[&str]) -> Folder {
    let folder = Folder::new();
    for (number, name) in (1..).zip(names) {
        picture(&folder.file(&format!("rgb/{name}.png")), (40, 30), number);
        depth(&folder.file(&format!("depth/{name}.png")), (40, 30));
    }
    folder
}

/// Writes a picture.
pub fn picture(path: &Path, (width, height): (u32, u32), number: u8) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let colour = |x, y| image::Rgb([(x * 5) as u8, (y * 7) as u8, 20 * number]);
    image::RgbImage::from_fn(width, height, colour)
        .save(path)
        .unwrap();
}

/// Writes its depth, millimetres.
pub fn depth(path: &Path, (width, height): (u32, u32)) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let millimetres = |x, y| image::Luma([(2000 + 100 * x + 50 * y) as u16]);
    image::ImageBuffer::from_fn(width, height, millimetres)
        .save(path)
        .unwrap();
}

/// A batch of them, all but its fog.
pub const WORDS: &str = "fog rgb/*.png --depth depth/*.png --depth-scale 0.001 -o out/*.png";

/// The lines of a manifest, by output.
pub fn manifest(path: &Path) -> BTreeMap<String, Map<String, Value>> {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.ends_with('\n'));
    let lines: Vec<Map<String, Value>> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let count = lines.len();
    let by_output: BTreeMap<_, _> = lines
        .into_iter()
        .map(|line| (line["output"].as_str().unwrap().to_owned(), line))
        .collect();
    assert_eq!(by_output.len(), count, "an output has two lines");
    by_output
}

/// The names in a subfolder, hidden ones too.
pub fn names(folder: &Folder, below: &str) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder.file(below))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// What is in a file.
pub fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.file(name)).unwrap()
}

/// Runs what must fail, and returns the sentence.
pub fn fails(folder: &Folder, words: &str, code: i32) -> String {
    let output = run(folder, words);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{words}: {text}");
    text
}

/// Runs what must be refused before anything is written.
pub fn refused(folder: &Folder, words: &str, code: i32) -> String {
    let before = folder.names();
    let text = fails(folder, words, code);
    assert_eq!(folder.names(), before, "{words} left something behind");
    text
}
