//! The manifest of a batch or a sequence: one line of JSON for each picture, with its settings, by which a later run recognises the
//! pictures that it would make.
//!
//! A line is written before its picture is renamed into place, so that every picture has a line even if the process is killed;
//! an unfinished last line is dropped. At the end of a run the lines are sorted, and those without a picture are removed.

mod error;
mod settings;

pub use error::{ManifestError, listed};

use crate::shard::Shard;
use airlight_image::output::AtomicFile;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Version of the lines, incremented when keys change their meaning. Lines of version 1 had no version and contained options of
/// the command line; version 2 had the tables of the scene among its other keys.
pub(crate) const MANIFEST_VERSION: u32 = 3;

/// Name of the manifest of pictures in a folder, or of a part of them.
pub(crate) fn name(shard: Option<&Shard>) -> String {
    match shard {
        Some(shard) => format!("manifest-{}-of-{}.jsonl", shard.number(), shard.count()),
        None => "manifest.jsonl".to_owned(),
    }
}

/// What is wrong with pictures that exist.
#[derive(Debug, Default)]
pub(crate) struct Existing {
    different: Vec<String>,
    unknown: Vec<String>,
}

impl Existing {
    /// Whether all pictures are those that the run would make.
    ///
    /// # Errors
    /// [`ManifestError::DifferentSettings`] or [`ManifestError::NotInManifest`].
    pub fn check(self) -> Result<(), ManifestError> {
        if !self.different.is_empty() {
            return Err(ManifestError::DifferentSettings(self.different));
        }
        if !self.unknown.is_empty() {
            return Err(ManifestError::NotInManifest(self.unknown));
        }
        Ok(())
    }
}

/// A manifest, locked for this run.
#[derive(Debug)]
pub(crate) struct Manifest {
    path: PathBuf,
    /// Absolute path of its folder, to which names of outputs are relative.
    folder: PathBuf,
    lines: Mutex<Lines>,
}

/// The lines in the file: the last one of each output.
#[derive(Debug)]
struct Lines {
    file: File,
    end: u64,
    of_output: BTreeMap<String, Line>,
}

#[derive(Clone, Copy, Debug)]
struct Line {
    start: u64,
    length: u64,
    is_failure: bool,
}

/// The keys of a line that identify its picture.
#[derive(Deserialize)]
struct Key {
    output: String,
    #[serde(default = "first_version")]
    manifest_version: u32,
    error: Option<String>,
}

fn first_version() -> u32 {
    1
}

impl Manifest {
    /// Opens a manifest, or creates one.
    ///
    /// # Errors
    /// [`ManifestError`] if the file cannot be read or written, is not a manifest of this version, or is locked by another run.
    pub fn open(path: &Path) -> Result<Self, ManifestError> {
        let failed = |error: io::Error| ManifestError::file(path, error);
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(ManifestError::Locked(path.to_owned()));
        }
        let folder = std::path::absolute(path).map_err(failed)?;
        let mut lines = Lines {
            file,
            end: 0,
            of_output: BTreeMap::new(),
        };
        lines.read(path)?;
        Ok(Self {
            path: path.to_owned(),
            folder: folder.parent().map(Path::to_owned).unwrap_or_default(),
            lines: Mutex::new(lines),
        })
    }

    /// Name of an output in the manifest: its path relative to the manifest's folder.
    pub fn name_of(&self, output: &Path) -> String {
        let absolute = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
        let common = self
            .folder
            .components()
            .zip(absolute.components())
            .take_while(|(a, b)| a == b)
            .count();
        let up = self
            .folder
            .components()
            .skip(common)
            .map(|_| Path::new(".."));
        let down = absolute.components().skip(common);
        let name: PathBuf = match common {
            // On another drive.
            0 => absolute.clone(),
            _ => up
                .chain(down.map(|part| Path::new(part.as_os_str())))
                .collect(),
        };
        name.to_string_lossy()
            .replace(std::path::MAIN_SEPARATOR, "/")
    }

    /// The line of an output; `None` if there is none or it records a failure.
    ///
    /// # Errors
    /// [`ManifestError::Manifest`] if the file cannot be read.
    pub fn line(&self, output: &str) -> Result<Option<Map<String, Value>>, ManifestError> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(line) = lines.of_output.get(output).copied() else {
            return Ok(None);
        };
        if line.is_failure {
            return Ok(None);
        }
        let failed = |error: io::Error| ManifestError::file(&self.path, error);
        let bytes = lines.bytes(line).map_err(failed)?;
        serde_json::from_slice(&bytes)
            .map(Some)
            .map_err(|error| failed(error.into()))
    }

    /// Compares the settings of an existing picture with those in its line, and adds what is wrong to `existing`.
    ///
    /// # Errors
    /// [`ManifestError::File`] if the manifest cannot be read or the settings are not JSON.
    pub fn compare(
        &self,
        output: &Path,
        settings: &impl Serialize,
        existing: &mut Existing,
    ) -> Result<(), ManifestError> {
        let name = format!("`{}`", output.display());
        let Some(line) = self.line(&self.name_of(output))? else {
            existing.unknown.push(name);
            return Ok(());
        };
        let differences = settings::differences(&line, settings)
            .map_err(|error| ManifestError::file(&self.path, error.into()))?;
        if !differences.is_empty() {
            let differences = differences.join("; ");
            existing.different.push(format!("{name}: {differences}"));
        }
        Ok(())
    }

    /// Adds the line of a picture that is about to be written, and removes its old files first: if the process is killed after the
    /// new line is written, the old picture must not be taken for the new one.
    ///
    /// # Errors
    /// [`ManifestError`] if a file cannot be removed or the line cannot be written.
    pub fn begin<'p>(
        &self,
        old: impl IntoIterator<Item = &'p Path>,
        name: &str,
        record: &impl Serialize,
    ) -> Result<(), ManifestError> {
        for path in old {
            match std::fs::remove_file(path) {
                Err(source) if source.kind() != io::ErrorKind::NotFound => {
                    return Err(ManifestError::Overwrite {
                        path: path.to_owned(),
                        source,
                    });
                }
                _ => {}
            }
        }
        self.add(name, false, record)
    }

    /// Adds the line of an output, which replaces an earlier one. `record` must begin with the key `output`.
    ///
    /// # Errors
    /// [`ManifestError::Manifest`] if it cannot be written.
    pub fn add(
        &self,
        output: &str,
        is_failure: bool,
        record: &impl Serialize,
    ) -> Result<(), ManifestError> {
        let failed = |error: io::Error| ManifestError::file(&self.path, error);
        let mut text = serde_json::to_vec(record).map_err(|error| failed(error.into()))?;
        text.push(b'\n');
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let line = Line {
            start: lines.end,
            length: text.len() as u64,
            is_failure,
        };
        lines
            .file
            .seek(SeekFrom::Start(line.start))
            .map_err(failed)?;
        lines.file.write_all(&text).map_err(failed)?;
        lines.end += line.length;
        lines.of_output.insert(output.to_owned(), line);
        Ok(())
    }

    /// Closes the manifest unchanged; an empty file is removed.
    ///
    /// # Errors
    /// [`ManifestError::Manifest`] if the file cannot be removed.
    pub fn close(self) -> Result<(), ManifestError> {
        let lines = self
            .lines
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        match lines.end {
            0 => std::fs::remove_file(&self.path)
                .map_err(|error| ManifestError::file(&self.path, error)),
            _ => Ok(()),
        }
    }

    /// Rewrites the manifest sorted by output, with one line for each picture that exists; without any line it is removed.
    ///
    /// # Errors
    /// [`ManifestError`] if it cannot be written; the file is then unchanged.
    pub fn finish(self) -> Result<(), ManifestError> {
        let failed = |error: io::Error| ManifestError::file(&self.path, error);
        let mut lines = self
            .lines
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        if lines.of_output.is_empty() {
            return std::fs::remove_file(&self.path).map_err(failed);
        }
        let sorted = AtomicFile::create(&self.path)?;
        let mut out = BufWriter::new(sorted.file());
        for (output, line) in std::mem::take(&mut lines.of_output) {
            if line.is_failure || is_whole(&self.folder.join(&output)) {
                out.write_all(&lines.bytes(line).map_err(failed)?)
                    .map_err(failed)?;
            }
        }
        out.flush().map_err(failed)?;
        drop(out);
        Ok(sorted.commit()?)
    }
}

impl Lines {
    /// Reads the position of each output's line and truncates an unfinished last line.
    fn read(&mut self, path: &Path) -> Result<(), ManifestError> {
        let failed = |error: io::Error| ManifestError::file(path, error);
        let not_ours = |line: usize, reason: String| ManifestError::NotAManifest {
            path: path.to_owned(),
            line,
            reason,
        };
        let mut reader = BufReader::new(&self.file);
        let mut text = Vec::new();
        let mut number = 0;
        loop {
            number += 1;
            text.clear();
            let length = reader.read_until(b'\n', &mut text).map_err(failed)? as u64;
            if text.last() != Some(&b'\n') {
                break;
            }
            if !text.trim_ascii().is_empty() {
                let key: Key = serde_json::from_slice(&text)
                    .map_err(|error| not_ours(number, error.to_string()))?;
                if key.manifest_version != MANIFEST_VERSION {
                    return Err(ManifestError::Version {
                        path: path.to_owned(),
                        line: number,
                        expected: MANIFEST_VERSION,
                        got: key.manifest_version,
                    });
                }
                let line = Line {
                    start: self.end,
                    length,
                    is_failure: key.error.is_some(),
                };
                self.of_output.insert(key.output, line);
            }
            self.end += length;
        }
        // An unfinished line of a manifest, or another file.
        let torn = text.trim_ascii_start();
        if !torn.is_empty()
            && !torn.starts_with(b"{\"output\":")
            && !b"{\"output\":".starts_with(torn)
        {
            return Err(not_ours(number, "it has no output".to_owned()));
        }
        self.file.set_len(self.end).map_err(failed)
    }

    fn bytes(&mut self, line: Line) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; line.length as usize];
        self.file.seek(SeekFrom::Start(line.start))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

/// Whether a picture exists. Pictures are renamed into place, so one that exists is complete.
pub(crate) fn is_whole(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() > 0)
}
