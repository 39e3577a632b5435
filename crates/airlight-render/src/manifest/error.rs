//! [`ManifestError`].

use airlight_image::ImageError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a manifest is not usable, or does not allow a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ManifestError {
    /// Outputs that exist and were made with other settings.
    #[error(
        "expected existing pictures to have the same settings, got {} that differ; try overwrite to make them again, or \
         another output:{}", .0.len(), listed(.0)
    )]
    DifferentSettings(Vec<String>),
    /// Outputs that exist and are not in the manifest.
    #[error(
        "expected existing pictures to be in the manifest, got {} that are not; try overwrite to replace them, or another \
         output:{}", .0.len(), listed(.0)
    )]
    NotInManifest(Vec<String>),
    /// A manifest that cannot be read or written.
    #[error("cannot read or write the manifest `{path}`: {source}", path = .path.display())]
    File {
        /// The manifest.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A file that is not a manifest.
    #[error(
        "expected a manifest of pictures, got `{path}`, whose line {line} is something else ({reason}); try another manifest \
         name, or move that file away", path = .path.display()
    )]
    NotAManifest {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// Why it is not a manifest's.
        reason: String,
    },
    /// A manifest of an earlier version, whose lines name settings differently.
    #[error(
        "expected a manifest of version {expected}, got version {got} in line {line} of `{path}`; try another output folder or \
         manifest name, or delete that manifest and its pictures", path = .path.display()
    )]
    Version {
        /// The manifest.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The version that can be resumed.
        expected: u32,
        /// The version of the line.
        got: u32,
    },
    /// A manifest that another run holds.
    #[error(
        "another run is writing to the manifest `{path}`; try again when it has ended, or another manifest name",
        path = .0.display()
    )]
    Locked(PathBuf),
    /// An old picture that cannot be removed.
    #[error("cannot overwrite `{path}`: {source}", path = .path.display())]
    Overwrite {
        /// The picture.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A manifest that cannot be replaced by a sorted one.
    #[error(transparent)]
    Image(#[from] ImageError),
}

impl ManifestError {
    /// Whether the request contradicts existing pictures, so that it would fail again; otherwise a file or the system failed.
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::DifferentSettings(_) | Self::NotInManifest(_))
    }

    pub(super) fn file(path: &Path, source: io::Error) -> Self {
        Self::File {
            path: path.to_owned(),
            source,
        }
    }
}

/// The first ten lines of a list, indented, and the number of remaining lines.
pub fn listed(lines: &[String]) -> String {
    const SHOWN: usize = 10;
    let mut text: String = lines
        .iter()
        .take(SHOWN)
        .map(|line| format!("\n  {line}"))
        .collect();
    if lines.len() > SHOWN {
        text.push_str(&format!("\n  and {} more", lines.len() - SHOWN));
    }
    text
}
