//! Atomic replacement of files.

use crate::ImageError;
use std::{
    collections::{HashMap, HashSet},
    ffi::{OsStr, OsString},
    fs::{self, File, OpenOptions},
    io::ErrorKind,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU64, Ordering},
};

/// A temporary file beside its target, moved there by [`AtomicFile::commit`]. Dropped without commit, on an error or a panic,
/// it is removed and the target stays unchanged.
#[derive(Debug)]
pub struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    /// `None` once committed.
    file: Option<File>,
}

impl AtomicFile {
    /// Creates a temporary file beside `target`.
    ///
    /// # Errors
    /// [`ImageError`] where the target names no file, is a folder, its folder is missing, or the system refuses.
    pub fn create(target: &Path) -> Result<Self, ImageError> {
        let refuse = |reason| ImageError::Target {
            path: target.to_owned(),
            reason,
        };
        let name = target
            .file_name()
            .ok_or_else(|| refuse("the path names no file"))?;
        if target.is_dir() {
            return Err(refuse("it is a folder"));
        }
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(ImageError::NoFolder {
                path: target.to_owned(),
                folder: folder.to_owned(),
            });
        }
        // Names are unique within a process by a count and between processes by their number; files of an earlier, killed
        // process with the same number are skipped.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        for _ in 0..1000 {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let mut hidden = OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{count}.part", std::process::id()));
            let temporary = folder.join(hidden);
            match OpenOptions::new()
                .read(true)
                .write(true)
                .create_new(true)
                .open(&temporary)
            {
                Ok(file) => {
                    return Ok(Self {
                        target: target.to_owned(),
                        temporary,
                        file: Some(file),
                    });
                }
                Err(e) if e.kind() == ErrorKind::AlreadyExists => continue,
                Err(source) => {
                    return Err(ImageError::File {
                        action: "create",
                        path: target.to_owned(),
                        source,
                    });
                }
            }
        }
        Err(refuse(
            "its folder holds too many temporary files of earlier runs; try removing `.*.part`",
        ))
    }

    /// Removes temporary files of these targets that processes left which ended before they could. Returns their number. A folder
    /// that cannot be read has none.
    pub fn remove_leftovers<'p>(targets: impl IntoIterator<Item = &'p Path>) -> u64 {
        let mut by_folder: HashMap<&Path, HashSet<&OsStr>> = HashMap::new();
        for target in targets {
            if let (Some(folder), Some(name)) = (target.parent(), target.file_name()) {
                by_folder.entry(folder).or_default().insert(name);
            }
        }
        let mut removed = 0;
        for (folder, names) in by_folder {
            let folder = match folder.as_os_str().is_empty() {
                true => Path::new("."),
                false => folder,
            };
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let name = entry.file_name();
                let about = name.to_str().and_then(target_and_process);
                let is_left = about.is_some_and(|(target, process)| {
                    names.contains(OsStr::new(target)) && !is_running(process)
                });
                removed += u64::from(is_left && fs::remove_file(entry.path()).is_ok());
            }
        }
        removed
    }

    /// The open file.
    pub fn file(&self) -> &File {
        // Taken only by `commit`, which consumes the value.
        self.file.as_ref().expect("open until committed")
    }

    /// Closes the file and moves it to its target, replacing an existing file.
    ///
    /// # Errors
    /// [`ImageError::File`] where the system refuses; the file is then removed.
    pub fn commit(mut self) -> Result<(), ImageError> {
        self.file = None;
        fs::rename(&self.temporary, &self.target).map_err(|source| {
            let _ = fs::remove_file(&self.temporary);
            ImageError::File {
                action: "move the finished file to",
                path: self.target.clone(),
                source,
            }
        })
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Name of the target and number of the process of a temporary file.
fn target_and_process(name: &str) -> Option<(&str, u32)> {
    let (target, numbers) = name
        .strip_prefix('.')?
        .strip_suffix(".part")?
        .rsplit_once('.')?;
    let (process, count) = numbers.split_once('-')?;
    count.parse::<u64>().ok()?;
    Some((target, process.parse().ok()?))
}

/// Whether a process may be running; where the system does not list processes, it may.
fn is_running(process: u32) -> bool {
    let list = Path::new("/proc");
    !list.join("self").exists() || list.join(process.to_string()).exists()
}
