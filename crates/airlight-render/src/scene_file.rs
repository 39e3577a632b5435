//! Reading scenes and the files that they name.

use crate::error::RenderError;
use airlight::scene::{Scene, SceneError};
use airlight_image::ImageError;
use std::path::Path;

/// Reads a scene from a TOML file, and the atmosphere and objects that it names.
///
/// # Errors
/// [`RenderError`] for files that cannot be read or are invalid.
pub fn load(path: &Path) -> Result<Scene, RenderError> {
    let in_file =
        |error: SceneError| RenderError::setting(format!("scene `{}`: {error}", path.display()));
    let text = read_text(path, "TOML")?;
    let mut scene = Scene::from_toml(&text).map_err(in_file)?;
    inline_files(&mut scene, path.parent().unwrap_or(Path::new("")))?;
    Ok(scene)
}

/// Reads the atmosphere and the objects that a scene names, with paths relative to a folder.
///
/// # Errors
/// [`RenderError`] for files that cannot be read or are invalid.
pub fn inline_files(scene: &mut Scene, folder: &Path) -> Result<(), RenderError> {
    // Error of the loader, of which the scene's error has only the text.
    let mut unreadable = None;
    let inlined = scene.inline_files(|name| {
        read_text(&folder.join(name), "TOML").map_err(|error| {
            let sentence = error.to_string();
            unreadable = Some(error);
            sentence
        })
    });
    match unreadable {
        Some(error) => Err(error),
        None => Ok(inlined?),
    }
}

/// Reads a text file of a format, such as "TOML".
///
/// # Errors
/// [`RenderError`] if it cannot be read or is not UTF-8.
pub fn read_text(path: &Path, format: &str) -> Result<String, RenderError> {
    let bytes = std::fs::read(path).map_err(|source| ImageError::File {
        action: "read",
        path: path.to_owned(),
        source,
    })?;
    String::from_utf8(bytes).map_err(|error| {
        RenderError::setting(format!(
            "`{}`: expected text in UTF-8, got an invalid byte at position {}; try a file in {format}",
            path.display(),
            error.utf8_error().valid_up_to()
        ))
    })
}
