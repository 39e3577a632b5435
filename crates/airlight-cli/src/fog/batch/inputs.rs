//! The pictures of a batch, each with its depth.

use super::pattern::{Match, Pattern};
use crate::args::OverlayArgs;
use crate::error::CliError;
use crate::report;
use airlight_image::output::PictureFormat;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What a path on the command line means.
pub enum Place {
    /// One file.
    File(PathBuf),
    /// All files in a folder, called by their names without ending.
    Folder(PathBuf),
    /// Files of a pattern.
    Pattern(Pattern),
}

impl Place {
    /// A place to read from.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a pattern that is none.
    pub fn to_read(path: &Path) -> Result<Self, CliError> {
        if path.is_dir() {
            return Ok(Self::Folder(path.to_owned()));
        }
        match Pattern::new(path)? {
            Some(pattern) if !path.is_file() => Ok(Self::Pattern(pattern)),
            _ => Ok(Self::File(path.to_owned())),
        }
    }

    /// Whether a file, there or not, would be one of several that are read.
    pub fn has(&self, file: &Path) -> bool {
        match self {
            Self::File(_) => false,
            Self::Folder(folder) => file.parent() == Some(folder),
            Self::Pattern(pattern) => pattern.names(file),
        }
    }
}

/// A picture and its depth.
#[derive(Clone, Debug)]
pub struct Input {
    /// What the open parts of the pattern stand for, or the name of the file without its ending.
    pub parts: Vec<String>,
    pub colour: PathBuf,
    pub depth: PathBuf,
}

impl Input {
    /// What the picture is called: its parts, `/` between them.
    pub fn name(&self) -> String {
        self.parts.join("/")
    }
}

/// The endings of depth files.
const DEPTH_ENDINGS: [&str; 4] = ["exr", "npy", "pfm", "png"];

/// Finds them, sorted by name.
///
/// # Errors
/// [`CliError`] where none is found, or some lack depth and are not to be passed over.
pub fn find(args: &OverlayArgs) -> Result<Vec<Input>, CliError> {
    let colours = colours(&args.colour)?;
    if colours.is_empty() {
        return Err(CliError::failure(format!(
            "`{}` names no picture: give a folder of .exr, .hdr, .png or .jpg files, or a pattern such as 'rgb/*.png', in \
             quotes",
            args.colour.display()
        )));
    }
    if let Some([a, b]) = colours.array_windows().find(|[a, b]| a.parts == b.parts) {
        return Err(CliError::usage(format!(
            "`{}` and `{}` are both called `{}`: give a pattern such as 'rgb/*.png' that names one of them",
            a.path.display(),
            b.path.display(),
            a.parts.join("/")
        )));
    }
    let depths = match &args.depth {
        None => Depths::Inside,
        Some(path) => Depths::new(path, &colours)?,
    };
    let mut inputs = Vec::with_capacity(colours.len());
    let mut unpaired = Vec::new();
    for Match { parts, path } in colours {
        match depths.of(&parts, &path) {
            Ok(depth) => inputs.push(Input {
                parts,
                colour: path,
                depth,
            }),
            Err(why) => unpaired.push(format!("`{}`: {why}", path.display())),
        }
    }
    if !unpaired.is_empty() {
        let count = unpaired.len() + inputs.len();
        let list = listed(&unpaired);
        let some = unpaired.len();
        if !args.batch.skip_unpaired {
            return Err(CliError::failure(format!(
                "{some} of {count} pictures have no depth (--skip-unpaired passes over them):{list}"
            )));
        }
        report::note(&format!(
            "{some} of {count} pictures have no depth and are passed over:{list}"
        ));
        if inputs.is_empty() {
            return Err(CliError::failure("no picture is left"));
        }
    }
    let unused = depths.unused(&inputs);
    if !(unused.is_empty() || args.quiet) {
        report::note(&format!(
            "{} depth files have no picture:{}",
            unused.len(),
            listed(&unused)
        ));
    }
    Ok(inputs)
}

/// The first of many lines, and how many more there are.
pub fn listed(lines: &[String]) -> String {
    const MOST: usize = 10;
    let mut text: String = lines
        .iter()
        .take(MOST)
        .map(|l| format!("\n  {l}"))
        .collect();
    if lines.len() > MOST {
        text.push_str(&format!("\n  and {} more", lines.len() - MOST));
    }
    text
}

fn colours(path: &Path) -> Result<Vec<Match>, CliError> {
    Ok(match Place::to_read(path)? {
        Place::Pattern(pattern) => pattern.files()?,
        Place::Folder(folder) => {
            let mut files = within(&folder, "*")?;
            files.retain(|file| PictureFormat::from_path(&file.path).is_ok());
            // Sorted with the ending, `a-b.png` comes before `a.png`.
            files.sort();
            files
        }
        Place::File(path) => {
            let name = path.file_stem().and_then(|stem| stem.to_str());
            let name = name.ok_or_else(|| {
                CliError::usage(format!(
                    "`{}` has no Unicode name, and so cannot be told in a manifest",
                    path.display()
                ))
            })?;
            let parts = vec![name.to_owned()];
            vec![Match { parts, path }]
        }
    })
}

/// The files of a folder that a pattern of one open part names, called by it without their ending.
fn within(folder: &Path, pattern: &str) -> Result<Vec<Match>, CliError> {
    let Some(pattern) = Pattern::new(&folder.join(pattern))? else {
        return Ok(Vec::new());
    };
    let mut files = pattern.files()?;
    for file in &mut files {
        for part in &mut file.parts {
            let name = part.rfind('/').map_or(0, |at| at + 1);
            if let Some(dot) = part[name..].rfind('.').filter(|&dot| dot > 0) {
                part.truncate(name + dot);
            }
        }
    }
    Ok(files)
}

/// Where depth is.
enum Depths {
    /// In the pictures' own files.
    Inside,
    /// In one file, for all.
    One(PathBuf),
    /// In a folder, by name.
    Named(PathBuf, BTreeMap<String, Vec<PathBuf>>),
    /// Where a pattern says.
    Pattern(Pattern),
}

impl Depths {
    fn new(path: &Path, colours: &[Match]) -> Result<Self, CliError> {
        match Place::to_read(path)? {
            Place::File(path) => Ok(Self::One(path)),
            Place::Folder(folder) => {
                let name = |colour: &Match| colour.parts.join("/");
                let pattern = match colours.iter().any(|colour| name(colour).contains('/')) {
                    true => "**",
                    false => "*",
                };
                let mut named: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
                for file in within(&folder, pattern)? {
                    let ending = file.path.extension().unwrap_or_default();
                    let ending = ending.to_ascii_lowercase();
                    if DEPTH_ENDINGS.iter().any(|known| ending == *known) {
                        named
                            .entry(file.parts.join("/"))
                            .or_default()
                            .push(file.path);
                    }
                }
                Ok(Self::Named(folder, named))
            }
            Place::Pattern(pattern) => {
                let parts = colours.first().map_or(0, |colour| colour.parts.len());
                must_have(&pattern, parts, "--depth")?;
                Ok(Self::Pattern(pattern))
            }
        }
    }

    /// The depth of a picture, or why there is none.
    fn of(&self, parts: &[String], colour: &Path) -> Result<PathBuf, String> {
        match self {
            Self::Inside => Ok(colour.to_owned()),
            Self::One(path) => Ok(path.clone()),
            Self::Pattern(pattern) => {
                let path = pattern.path(parts);
                match path.is_file() {
                    true => Ok(path),
                    false => Err(format!("there is no `{}`", path.display())),
                }
            }
            Self::Named(folder, named) => {
                let name = parts.join("/");
                match named.get(&name).map(Vec::as_slice) {
                    Some([only]) => Ok(only.clone()),
                    Some([first, second, ..]) => Err(format!(
                        "`{}` and `{}` could both be its depth: give a pattern such as 'depth/*.png'",
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
    fn unused(&self, inputs: &[Input]) -> Vec<String> {
        let there: Vec<PathBuf> = match self {
            Self::Inside | Self::One(_) => return Vec::new(),
            Self::Named(_, named) => named.values().flatten().cloned().collect(),
            // What is told here is a courtesy: a folder that cannot be read is no reason to stop.
            Self::Pattern(pattern) => {
                let files = pattern.files().unwrap_or_default();
                files.into_iter().map(|file| file.path).collect()
            }
        };
        let used: BTreeSet<&Path> = inputs.iter().map(|input| input.depth.as_path()).collect();
        let unused = there.iter().filter(|path| !used.contains(path.as_path()));
        unused.map(|path| format!("`{}`", path.display())).collect()
    }
}

/// Refuses a pattern with another number of open parts than COLOUR has.
///
/// # Errors
/// [`CliError::Usage`].
pub fn must_have(pattern: &Pattern, parts: usize, option: &str) -> Result<(), CliError> {
    match pattern.open_parts() == parts {
        true => Ok(()),
        false => Err(CliError::usage(format!(
            "{option} `{}` has {} open parts (*), COLOUR has {parts}: each must have as many, as they stand for each other in \
             order",
            pattern.text(),
            pattern.open_parts()
        ))),
    }
}
