//! Ctrl-C: exits immediately unless files are being written; then the writer stops and removes unfinished files.

use crate::error::CliError;
use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

/// True after Ctrl-C.
pub static STOP: AtomicBool = AtomicBool::new(false);

/// Whether files are being written. The handler holds the lock while it ends the process, so that no file can be created
/// meanwhile.
static WRITING: Mutex<bool> = Mutex::new(false);

/// Installs the handler of Ctrl-C and, on systems that have them, of termination requests and closed terminals.
///
/// # Errors
/// [`CliError::Failure`] if the system fails to install it.
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

/// Guard during which Ctrl-C does not exit, so that the writer can remove its files.
pub struct WritingFiles(());

/// Declares that files are written until the guard is dropped.
///
/// # Errors
/// [`CliError::Interrupted`] after Ctrl-C.
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
