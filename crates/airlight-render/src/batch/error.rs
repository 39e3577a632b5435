//! Errors of planning and running a batch.

use crate::RenderError;
use crate::manifest::{ManifestError, listed};
use airlight_image::ImageError;
use std::io;
use std::path::PathBuf;

/// Why a batch could not be planned, or did not run to its end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// A name that a manifest, which is UTF-8, cannot hold.
    #[error("expected a name in Unicode, got `{path}`; try renaming it", path = .0.display())]
    NotUnicode(PathBuf),
    /// A pattern whose wildcards touch, so that a name can be divided between them in several ways.
    #[error("expected text between the wildcards of a pattern, got `{0}`; try leaving one * out")]
    AdjacentWildcards(String),
    /// A depth or output pattern with another number of wildcards than the colour pattern.
    #[error(
        "expected as many wildcards (*) in the {role} pattern as in the colour pattern, which has {expected}, got {got} in \
         `{pattern}`; try one * for each * of the colour pattern"
    )]
    WildcardCount {
        /// `depth` or `output`.
        role: &'static str,
        /// The pattern.
        pattern: String,
        /// Wildcards of the colour pattern.
        expected: usize,
        /// Wildcards of this one.
        got: usize,
    },
    /// A folder or pattern without any picture in it.
    #[error(
        "expected pictures, got none in `{path}`; try a folder of .exr, .hdr, .png, .jpg or .tif files, or a quoted pattern such as \
         'rgb/*.png'", path = .0.display()
    )]
    NoPictures(PathBuf),
    /// Two pictures with the same name.
    #[error(
        "expected pictures with different names, got `{first}` and `{second}`, both called `{name}`; try a pattern such as \
         'rgb/*.png' that matches only one of them", first = .first.display(), second = .second.display()
    )]
    SameName {
        /// One of them.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// Their name.
        name: String,
    },
    /// Pictures without a depth map.
    #[error(
        "expected a depth map for each of {total} pictures, got none for {}; try skip-unpaired to leave these pictures out:{}",
        .missing.len(), listed(.missing)
    )]
    NoDepth {
        /// Each picture without depth, and why it has none.
        missing: Vec<String>,
        /// Pictures in all.
        total: usize,
    },
    /// One output file for several pictures.
    #[error(
        "expected an output for each picture, got one file for all, `{path}`; try a folder, or a pattern such as 'out/*.png'",
        path = .0.display()
    )]
    OneOutput(PathBuf),
    /// An output for several pictures whose ending is not that of a picture: probably a folder.
    #[error(
        "expected a folder or a pattern for several pictures, got `{path}`, whose ending is not that of a picture; try `{path}/` for \
         a folder, or `{path}/*.png`",
        path = .0.display()
    )]
    OutputEnding(PathBuf),
    /// An output that is also an input.
    #[error("expected an output that is not an input, got `{path}`; try another output name", path = .0.display())]
    OutputIsInput(PathBuf),
    /// An output that the colour pattern matches, so that the next run would add fog to it again.
    #[error(
        "expected outputs that the colour pattern `{colour}` does not match, got `{output}`, an input of the next run; try \
         another output folder", output = .output.display(), colour = .colour.display()
    )]
    OutputMatchesInput {
        /// The output.
        output: PathBuf,
        /// The colour folder or pattern.
        colour: PathBuf,
    },
    /// Two pictures with the same output.
    #[error(
        "expected different outputs, got `{output}` for both `{first}` and `{second}`; try an output pattern that keeps them \
         apart", first = .first.display(), second = .second.display(), output = .output.display()
    )]
    SameOutput {
        /// One input.
        first: PathBuf,
        /// The other input.
        second: PathBuf,
        /// The output of both.
        output: PathBuf,
    },
    /// A variation that contradicts the settings or another variation, or changes nothing.
    #[error("{option} {name}: expected {expected}, got {got}; try {advice}")]
    Variation {
        /// How it is given: `vary` or `each`.
        option: &'static str,
        /// The varied setting.
        name: String,
        /// What is valid.
        expected: String,
        /// The value given.
        got: String,
        /// What to do.
        advice: String,
    },
    /// More pictures of an input than make sense.
    #[error(
        "expected at most {most} pictures of an input, got {combinations} combinations of values times {variants} variants; try \
         fewer values"
    )]
    TooManyVariants {
        /// Combinations of the values of which every picture gets each.
        combinations: u64,
        /// Variants of each.
        variants: u64,
        /// Greatest number of their product.
        most: u64,
    },
    /// A manifest that is not usable, or existing pictures with other settings.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// A folder or file that the operating system cannot access.
    #[error("cannot {action} `{path}`: {source}", path = .path.display())]
    File {
        /// What was tried, as a verb with its object.
        action: &'static str,
        /// The path.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The threads could not be started.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// The first picture that failed, in a batch that stops there.
    #[error("stopped at the first failure: {0}")]
    FirstFailure(String),
    /// A picture with invalid settings, or one that could not be written.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl From<ImageError> for BatchError {
    fn from(error: ImageError) -> Self {
        Self::Render(error.into())
    }
}

impl BatchError {
    /// Whether the request is invalid or contradicts existing files, so that it would fail again; otherwise a file or the system
    /// failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::NotUnicode(_)
            | Self::NoPictures(_)
            | Self::NoDepth { .. }
            | Self::File { .. }
            | Self::Threads(_)
            | Self::FirstFailure(_) => false,
            Self::Manifest(error) => error.is_refusal(),
            Self::Render(error) => error.is_refusal(),
            _ => true,
        }
    }

    /// Whether the caller cancelled the batch.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Render(error) if error.is_cancelled())
    }
}
