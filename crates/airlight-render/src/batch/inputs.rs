//! Input files of a batch: pictures with their depth maps.

use super::{BatchError, Pattern, pattern::Match};
use crate::overlay::OverlaySpec;
use airlight_image::input::{is_picture_name, is_tiff_name};
use airlight_image::output::PictureFormat;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// An input path: one file, or several.
#[derive(Clone, Debug)]
pub enum InputPath {
    /// One file.
    File(PathBuf),
    /// All files in a folder, named without their extensions.
    Folder(PathBuf),
    /// The files that match a pattern.
    Pattern(Pattern),
}

impl InputPath {
    /// Interprets a path: an existing folder or file; otherwise a pattern if it has a `*`.
    ///
    /// # Errors
    /// [`BatchError::NotUnicode`] or [`BatchError::AdjacentWildcards`] for an invalid pattern.
    pub fn new(path: &Path) -> Result<Self, BatchError> {
        if path.is_dir() {
            return Ok(Self::Folder(path.to_owned()));
        }
        match Pattern::new(path)? {
            Some(pattern) if !path.is_file() => Ok(Self::Pattern(pattern)),
            _ => Ok(Self::File(path.to_owned())),
        }
    }

    /// Whether the path stands for several files.
    pub fn is_many(&self) -> bool {
        !matches!(self, Self::File(_))
    }

    /// Whether the path stands for several files and a file, which need not exist, is among them.
    pub fn includes(&self, file: &Path) -> bool {
        match self {
            Self::File(_) => false,
            Self::Folder(folder) => file.parent() == Some(folder),
            Self::Pattern(pattern) => pattern.matches(file),
        }
    }
}

/// A colour picture and its depth map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Texts matched by the wildcards of the colour pattern, or the file name without its extension.
    pub captures: Vec<String>,
    /// The colour picture.
    pub colour: PathBuf,
    /// The depth map; the colour picture itself if that holds a depth channel.
    pub depth: PathBuf,
    /// Place among the pictures with depth, from 0, whatever part of them is made.
    pub index: usize,
}

impl Input {
    /// Name of the picture: its captures joined by `/`.
    pub fn name(&self) -> String {
        self.captures.join("/")
    }
}

/// Inputs found for a batch, and files that were left out.
#[derive(Clone, Debug)]
pub struct FoundInputs {
    /// Pictures with depth, sorted by their captures; at least one.
    pub inputs: Vec<Input>,
    /// Pictures left out because they have no depth, each with the reason.
    pub without_depth: Vec<String>,
    /// Depth files that belong to no picture.
    pub unused_depths: Vec<PathBuf>,
    /// Files of the colour folder that are neither pictures nor depth maps.
    pub passed_over: Vec<PathBuf>,
}

/// File extensions of depth maps.
const DEPTH_ENDINGS: [&str; 7] = ["exr", "npy", "npz", "pfm", "png", "tif", "tiff"];

/// Finds the pictures of a file, folder or pattern and the depth map of each: in `depth` (a file for all, a folder with files of
/// the same names, or a pattern), or in the colour files if that is `None`. With `skip_unpaired`, pictures without depth are
/// left out.
///
/// # Errors
/// [`BatchError`] if there is no picture, two have the same name, or one has no depth and is not to be left out.
pub fn find_inputs(
    colour: &Path,
    depth: Option<&Path>,
    skip_unpaired: bool,
) -> Result<FoundInputs, BatchError> {
    let (colours, mut passed_over) = colours(colour)?;
    if colours.is_empty() {
        return Err(BatchError::NoPictures(colour.to_owned()));
    }
    if let Some([a, b]) = colours
        .array_windows()
        .find(|[a, b]| a.captures == b.captures)
    {
        return Err(BatchError::SameName {
            first: a.path.clone(),
            second: b.path.clone(),
            name: a.captures.join("/"),
        });
    }
    let depths = match depth {
        None if !colours.iter().any(|colour| may_hold_depth(&colour.path)) => {
            let spec = OverlaySpec {
                colour: colour.to_owned(),
                ..OverlaySpec::default()
            };
            return Err(spec.without_depth().into());
        }
        None => Depths::Inside,
        Some(path) => Depths::new(path, &colours)?,
    };
    let mut inputs = Vec::with_capacity(colours.len());
    let mut missing = Vec::new();
    for Match { captures, path } in colours {
        match depths.of(&captures, &path) {
            Ok(depth) => inputs.push(Input {
                index: inputs.len(),
                captures,
                colour: path,
                depth,
            }),
            Err(why) => missing.push(format!("`{}`: {why}", path.display())),
        }
    }
    if !missing.is_empty() && (!skip_unpaired || inputs.is_empty()) {
        let total = missing.len() + inputs.len();
        return Err(BatchError::NoDepth { missing, total });
    }
    let used: BTreeSet<&Path> = inputs.iter().map(|input| input.depth.as_path()).collect();
    passed_over.retain(|path| !used.contains(path.as_path()));
    Ok(FoundInputs {
        unused_depths: depths.unused(&inputs),
        passed_over,
        inputs,
        without_depth: missing,
    })
}

/// Whether a picture may have a depth channel besides its colours; of unknown endings the content decides. A grey PNG or TIFF is
/// not the depth of itself.
fn may_hold_depth(colour: &Path) -> bool {
    let holds_channels =
        PictureFormat::from_path(colour).map_or(true, PictureFormat::holds_channels);
    holds_channels && !is_tiff_name(colour)
}

/// The pictures of a path, and the other files of a folder.
fn colours(path: &Path) -> Result<(Vec<Match>, Vec<PathBuf>), BatchError> {
    Ok(match InputPath::new(path)? {
        InputPath::Pattern(pattern) => (pattern.files()?, Vec::new()),
        InputPath::Folder(folder) => {
            let files = files_within(&folder, "*")?;
            let is_picture = |file: &Match| is_picture_name(&file.path);
            let (mut files, others): (Vec<_>, Vec<_>) = files.into_iter().partition(is_picture);
            // With the extension, `a-b.png` would sort before `a.png`.
            files.sort();
            (files, others.into_iter().map(|file| file.path).collect())
        }
        InputPath::File(path) => {
            let name = path.file_stem().and_then(|stem| stem.to_str());
            let name = name.ok_or_else(|| BatchError::NotUnicode(path.clone()))?;
            let captures = vec![name.to_owned()];
            (vec![Match { captures, path }], Vec::new())
        }
    })
}

/// The files of a folder that match a pattern with one wildcard, whose captures are stripped of the file's extension.
fn files_within(folder: &Path, pattern: &str) -> Result<Vec<Match>, BatchError> {
    let Some(pattern) = Pattern::new(&folder.join(pattern))? else {
        return Ok(Vec::new());
    };
    let mut files = pattern.files()?;
    for file in &mut files {
        for capture in &mut file.captures {
            let name = capture.rfind('/').map_or(0, |at| at + 1);
            if let Some(dot) = capture[name..].rfind('.').filter(|&dot| dot > 0) {
                capture.truncate(name + dot);
            }
        }
    }
    Ok(files)
}

/// Location of the depth maps.
enum Depths {
    /// In the colour files.
    Inside,
    /// In one file for all pictures.
    One(PathBuf),
    /// In a folder, by name.
    Named(PathBuf, BTreeMap<String, Vec<PathBuf>>),
    /// In the files of a pattern.
    Pattern(Pattern),
}

impl Depths {
    fn new(path: &Path, colours: &[Match]) -> Result<Self, BatchError> {
        match InputPath::new(path)? {
            InputPath::File(path) => Ok(Self::One(path)),
            InputPath::Folder(folder) => {
                let name = |colour: &Match| colour.captures.join("/");
                let pattern = match colours.iter().any(|colour| name(colour).contains('/')) {
                    true => "**",
                    false => "*",
                };
                let mut named: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
                for file in files_within(&folder, pattern)? {
                    let ending = file.path.extension().unwrap_or_default();
                    let ending = ending.to_ascii_lowercase();
                    if DEPTH_ENDINGS.iter().any(|known| ending == *known) {
                        named
                            .entry(file.captures.join("/"))
                            .or_default()
                            .push(file.path);
                    }
                }
                Ok(Self::Named(folder, named))
            }
            InputPath::Pattern(pattern) => {
                let expected = colours.first().map_or(0, |colour| colour.captures.len());
                pattern.check_wildcards(expected, "depth")?;
                Ok(Self::Pattern(pattern))
            }
        }
    }

    /// The depth map of a picture, or why it has none.
    fn of(&self, captures: &[String], colour: &Path) -> Result<PathBuf, String> {
        match self {
            Self::Inside if may_hold_depth(colour) => Ok(colour.to_owned()),
            Self::Inside => Err("only EXR pictures hold depth; try depth with a file".to_owned()),
            Self::One(path) => Ok(path.clone()),
            Self::Pattern(pattern) => {
                let path = pattern.path(captures);
                match path.is_file() {
                    true => Ok(path),
                    false => Err(format!("there is no `{}`", path.display())),
                }
            }
            Self::Named(folder, named) => {
                let name = captures.join("/");
                match named.get(&name).map(Vec::as_slice) {
                    Some([only]) => Ok(only.clone()),
                    Some([first, second, ..]) => Err(format!(
                        "`{}` and `{}` could both be its depth; try a pattern such as 'depth/*.png'",
                        first.display(),
                        second.display()
                    )),
                    _ => Err(format!(
                        "there is no `{}` with one of the endings {}",
                        folder.join(name).display(),
                        DEPTH_ENDINGS.join(", ")
                    )),
                }
            }
        }
    }

    /// Depth files that belong to no picture.
    fn unused(&self, inputs: &[Input]) -> Vec<PathBuf> {
        let all: Vec<PathBuf> = match self {
            Self::Inside | Self::One(_) => return Vec::new(),
            Self::Named(_, named) => named.values().flatten().cloned().collect(),
            // Used for a remark only, so a folder that cannot be read is ignored.
            Self::Pattern(pattern) => {
                let files = pattern.files().unwrap_or_default();
                files.into_iter().map(|file| file.path).collect()
            }
        };
        let used: BTreeSet<&Path> = inputs.iter().map(|input| input.depth.as_path()).collect();
        all.into_iter()
            .filter(|path| !used.contains(path.as_path()))
            .collect()
    }
}
