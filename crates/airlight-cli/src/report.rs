//! Text on standard output and standard error, written without panics.

use crate::error::CliError;
use crate::interrupt;
use crate::option_names;
use airlight::Named;
use airlight_image::Notes;
use airlight_image::output::AtomicFile;
use airlight_image::tone::ToneMapper;
use airlight_plot::{ContactSheet, Panel, Raster};
use airlight_render::RenderedImage;
use airlight_render::openjd::JobTemplate;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

pub use airlight_render::summary::short;

/// Writes a text to standard output.
///
/// # Errors
/// [`CliError::ReaderGone`] if the reader has closed it, [`CliError::Failure`] if it cannot be written.
pub fn print(text: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| CliError::from_stdout(&error))
}

/// The noun for a number of pictures.
pub fn pictures(count: usize) -> &'static str {
    match count {
        1 => "picture",
        _ => "pictures",
    }
}

/// Writes a text or bytes to a file, which is renamed into place when it is complete.
///
/// # Errors
/// [`CliError`] if the file cannot be written.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), CliError> {
    write_together([(path, content)])
}

/// Writes texts or bytes to files that belong together, which are renamed into place when all of them are complete.
///
/// # Errors
/// [`CliError`] if one of the files cannot be written.
pub fn write_together<P: AsRef<Path>, C: AsRef<[u8]>>(
    files: impl IntoIterator<Item = (P, C)>,
) -> Result<(), CliError> {
    let _writing = interrupt::start_writing()?;
    let complete = |(path, content): (P, C)| {
        let path = path.as_ref();
        let file = AtomicFile::create(path)?;
        file.file().write_all(content.as_ref()).map_err(|error| {
            CliError::failure(format!("cannot write `{}`: {error}", path.display()))
        })?;
        Ok(file)
    };
    let files = files.into_iter().map(complete);
    let files: Vec<AtomicFile> = files.collect::<Result<_, CliError>>()?;
    files.into_iter().try_for_each(|file| Ok(file.commit()?))
}

/// Writes a job for a render farm, and says so.
///
/// # Errors
/// [`CliError`] if the file cannot be written.
pub fn write_job(path: &Path, job: &JobTemplate, quiet: bool) -> Result<(), CliError> {
    write(path, job.to_json())?;
    match quiet {
        true => Ok(()),
        false => print(&format!("{}: job template\n", path.display())),
    }
}

/// Checks that a file can be written, before anything is computed.
///
/// # Errors
/// [`CliError`] if it cannot be written.
pub fn check_writable(path: &Path) -> Result<(), CliError> {
    let _writing = interrupt::start_writing()?;
    AtomicFile::create(path)?;
    Ok(())
}

/// Checks that a name ends in .png and that the file can be written.
///
/// # Errors
/// [`CliError`] if it does not, or cannot.
pub fn check_png(path: &Path) -> Result<(), CliError> {
    if path.extension().is_none_or(|ending| ending != "png") {
        return Err(CliError::usage(format!(
            "--output: expected a name that ends in .png, got `{}`; try `{}`",
            path.display(),
            path.with_extension("png").display()
        )));
    }
    check_writable(path)
}

/// A panel of a contact sheet with a title.
pub fn panel(title: &str, image: &RenderedImage, tone: &ToneMapper) -> Panel {
    let size = image.frame.size();
    Panel {
        title: title.to_owned(),
        picture: Raster {
            width: size.width(),
            height: size.height(),
            rgb: image.displayed(tone),
        },
        scale: None,
    }
}

/// Writes a contact sheet as PNG.
///
/// # Errors
/// [`CliError`] if the sheet does not fit in memory or the file cannot be written.
pub fn write_contact_sheet(path: &Path, sheet: &ContactSheet) -> Result<(), CliError> {
    let png = sheet
        .draw()
        .and_then(|raster| raster.to_png())
        .map_err(|error| CliError::failure(error.to_string()))?;
    write(path, png)
}

/// Writes a remark to standard error, ignoring errors.
pub fn note(text: &str) {
    let text = option_names::in_message(text);
    let _ = writeln!(std::io::stderr(), "airlight: {text}");
}

/// Writes one line to standard error with what was converted, repaired or passed over in a file or folder.
pub fn remarks(path: &Path, notes: &Notes) {
    if !notes.is_empty() {
        note(&format!("`{}`: {notes}", path.display()));
    }
}

/// Formats a duration.
pub fn seconds(time: Duration) -> String {
    let s = time.as_secs_f64();
    match s {
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 100.0 => format!("{s:.1} s"),
        s => format!("{} min {:02} s", s as u64 / 60, s as u64 % 60),
    }
}

/// Formats a number of bytes.
pub fn bytes(count: u64) -> String {
    match count {
        0..10_000 => format!("{count} bytes"),
        10_000..10_000_000 => format!("{:.0} kB", count as f64 / 1e3),
        _ => format!("{:.1} MB", count as f64 / 1e6),
    }
}

/// The names of a set with their descriptions, one on each line after `indent`.
pub fn named<T: Named>(indent: &str) -> String {
    let lengths = T::ALL.iter().map(|value| value.name().len());
    let width = lengths.max().unwrap_or(0);
    T::ALL
        .iter()
        .map(|value| format!("{indent}{:width$}  {}\n", value.name(), value.summary()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_sizes_have_units() {
        assert_eq!(seconds(Duration::from_secs(125)), "2 min 05 s");
        assert_eq!(seconds(Duration::from_millis(1234)), "1.23 s");
        assert_eq!(bytes(123), "123 bytes");
        assert_eq!(bytes(12_345_678), "12.3 MB");
    }
}
