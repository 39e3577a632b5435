//! The page `sky-article.html`, assembled from its template and the translated shader.

use airlight_shaders::{Language, Part, TranslateError, translate};

/// Mark in the template that the shader functions replace.
const MARK: &str = "/* airlight */\n";

/// Text of the page.
///
/// # Errors
/// [`TranslateError`] of the translation.
pub fn assembled() -> Result<String, TranslateError> {
    let parts = [Part::Article, Part::Tone, Part::Dither];
    let functions = translate(&parts, Language::GlslEs300)?;
    Ok(include_str!("sky-article.template.html").replace(MARK, &functions))
}
