//! The manifest of a batch: a line of JSON for each picture, with all that it was made of.
//!
//! A line is written before its picture appears, so that after a kill no picture is without its line; a last line that breaks
//! off is dropped. At the end of a run the lines are sorted, and those whose picture is not there are left out.

use crate::error::CliError;
use airlight_image::output::AtomicFile;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A manifest that this run works on, and no other.
pub struct Manifest {
    path: PathBuf,
    /// Its folder, absolute: outputs are named from there.
    folder: PathBuf,
    lines: Mutex<Lines>,
}

/// The lines in the file: where the last one of each output is.
struct Lines {
    file: File,
    end: u64,
    of_output: BTreeMap<String, RaySegment>,
}

#[derive(Clone, Copy)]
struct RaySegment {
    start: u64,
    length: u64,
    /// Its picture could not be made.
    is_failure: bool,
}

/// What of a line says which picture it is about.
#[derive(Deserialize)]
struct Key {
    output: String,
    error: Option<String>,
}

impl Manifest {
    /// Opens a manifest or begins one.
    ///
    /// # Errors
    /// [`CliError::Failure`] where it cannot be read or written, holds something else, or another run works on it.
    pub fn open(path: &Path) -> Result<Self, CliError> {
        let failed = |error: io::Error| failure(path, &error);
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(CliError::failure(format!(
                "another run is at work on `{}`: wait for it, or give --manifest another name",
                path.display()
            )));
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

    /// What an output is called in it: the path from the manifest's folder where it is in there, else the whole path.
    pub fn name_of(&self, output: &Path) -> String {
        let absolute = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
        let name = absolute.strip_prefix(&self.folder).unwrap_or(&absolute);
        name.to_string_lossy()
            .replace(std::path::MAIN_SEPARATOR, "/")
    }

    /// The line of an output, unless it tells of a failure.
    ///
    /// # Errors
    /// [`CliError::Failure`] where the file cannot be read.
    pub fn made(&self, output: &str) -> Result<Option<Map<String, Value>>, CliError> {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(line) = lines.of_output.get(output).copied() else {
            return Ok(None);
        };
        if line.is_failure {
            return Ok(None);
        }
        let bytes = lines
            .bytes(line)
            .map_err(|error| failure(&self.path, &error))?;
        serde_json::from_slice(&bytes)
            .map(Some)
            .map_err(|error| failure(&self.path, &error.into()))
    }

    /// Adds the line of an output, which takes the place of an earlier one.
    ///
    /// # Errors
    /// [`CliError::Failure`] where it cannot be written.
    pub fn add(
        &self,
        output: &str,
        is_failure: bool,
        record: &impl Serialize,
    ) -> Result<(), CliError> {
        let failed = |error: io::Error| failure(&self.path, &error);
        let mut text = serde_json::to_vec(record).map_err(|error| failed(error.into()))?;
        text.push(b'\n');
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let line = RaySegment {
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

    /// Leaves it as it was found: takes it away where it holds nothing.
    ///
    /// # Errors
    /// [`CliError::Failure`] where the system refuses.
    pub fn leave(self) -> Result<(), CliError> {
        let lines = self
            .lines
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        match lines.end {
            0 => std::fs::remove_file(&self.path).map_err(|error| failure(&self.path, &error)),
            _ => Ok(()),
        }
    }

    /// Writes it anew: sorted by output, one line each, those of pictures that are not there left out.
    ///
    /// # Errors
    /// [`CliError`] where it cannot be written; it is then as it was.
    pub fn finish(self) -> Result<(), CliError> {
        let failed = |error: io::Error| failure(&self.path, &error);
        let mut lines = self
            .lines
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
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
    /// Reads which line is whose; cuts off a last one that is not whole.
    fn read(&mut self, path: &Path) -> Result<(), CliError> {
        let failed = |error: io::Error| failure(path, &error);
        let mut reader = BufReader::new(&self.file);
        let mut text = Vec::new();
        for number in 1.. {
            text.clear();
            let length = reader.read_until(b'\n', &mut text).map_err(failed)? as u64;
            if text.last() != Some(&b'\n') {
                break;
            }
            if !text.trim_ascii().is_empty() {
                let key: Key = serde_json::from_slice(&text).map_err(|error| {
                    CliError::failure(format!(
                        "line {number} of `{}` is none of a manifest of pictures ({error}): give --manifest another name, or \
                         move that file away",
                        path.display()
                    ))
                })?;
                let line = RaySegment {
                    start: self.end,
                    length,
                    is_failure: key.error.is_some(),
                };
                self.of_output.insert(key.output, line);
            }
            self.end += length;
        }
        // What was to be a line of ours, or somebody's text.
        let torn = text.trim_ascii_start();
        if !torn.is_empty()
            && !torn.starts_with(b"{\"output\":")
            && !b"{\"output\":".starts_with(torn)
        {
            return Err(CliError::failure(format!(
                "the last line of `{}` is none of a manifest of pictures: give --manifest another name, or move that file away",
                path.display()
            )));
        }
        self.file.set_len(self.end).map_err(failed)
    }

    fn bytes(&mut self, line: RaySegment) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; line.length as usize];
        self.file.seek(SeekFrom::Start(line.start))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

/// Whether a picture is there. They appear whole or not at all.
pub fn is_whole(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() > 0)
}

fn failure(path: &Path, error: &io::Error) -> CliError {
    CliError::failure(format!(
        "cannot read or write the manifest `{}`: {error}",
        path.display()
    ))
}
