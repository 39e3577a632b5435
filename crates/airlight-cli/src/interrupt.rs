//! Ctrl-C: stops at once while nothing is being written, else asks the writer to stop and clear up.

use crate::error::CliError;
use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

/// True once the user has asked to stop.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// Whether files are being written. Held by the handler while it ends the process, so that no file can come into being
/// meanwhile.
static WRITING: Mutex<bool> = Mutex::new(false);

/// Listens for Ctrl-C and, where there are such, for requests to end and for a closed terminal.
///
/// # Errors
/// [`CliError::Failure`] where the system refuses.
pub fn install() -> Result<(), CliError> {
    ctrlc::set_handler(|| {
        STOP.store(true, Ordering::SeqCst);
        let writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        if !*writing {
            std::process::exit(i32::from(CliError::Interrupted.exit_code()));
        }
    })
    .map_err(|error| CliError::failure(format!("cannot listen for Ctrl-C: {error}")))
}

/// While this lives, Ctrl-C leaves the process to clear up its files.
pub struct WritingFiles(());

/// From here on files are written.
///
/// # Errors
/// [`CliError::Interrupted`] where the user has already asked to stop.
pub fn start_writing() -> Result<WritingFiles, CliError> {
    let mut writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    if STOP.load(Ordering::SeqCst) {
        return Err(CliError::Interrupted);
    }
    *writing = true;
    Ok(WritingFiles(()))
}

impl Drop for WritingFiles {
    fn drop(&mut self) {
        *WRITING.lock().unwrap_or_else(PoisonError::into_inner) = false;
    }
}
