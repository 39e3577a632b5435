//! Following and cancelling long computations.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

/// Receives the progress of a long computation.
///
/// Closures `Fn(u64, u64)` implement it.
pub trait Progress: Sync {
    /// A stage of the work begins: what is done, in a few words, and how many units it has (0: not known).
    fn stage(&self, _what: &str, _total: u64) {}

    /// `done` of `total` units of work are finished: rows of a picture, permille of a solution. Called from
    /// the threads that finish them.
    fn advanced(&self, done: u64, total: u64);
}

impl<F: Fn(u64, u64) + Sync> Progress for F {
    fn advanced(&self, done: u64, total: u64) {
        self(done, total);
    }
}

/// How the caller follows and cancels a long computation. The default does neither.
///
/// ```
/// use airlight::{Control, atmosphere::reference, sky::{Sky, SkySettings}, spectrum::WavelengthGrid};
/// use std::sync::atomic::AtomicBool;
///
/// let cancel = AtomicBool::new(false); // Another thread may set it to true.
/// let progress = |done, total| println!("{} %", 100 * done / total);
/// let control = Control::cancelled_by(&cancel).reporting_to(&progress);
/// let (air, grid) = (reference::earth_demo(), WavelengthGrid::rgb());
/// let sky = Sky::prepare_with(&air, &grid, &SkySettings::default(), control)?;
/// # Ok::<(), airlight::sky::SkyError>(())
/// ```
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    cancel: Option<&'a AtomicBool>,
    progress: Option<&'a dyn Progress>,
}

/// The caller cancelled the computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl<'a> Control<'a> {
    /// Cancels once `cancel` is true.
    pub fn cancelled_by(cancel: &'a AtomicBool) -> Self {
        Self {
            cancel: Some(cancel),
            progress: None,
        }
    }

    /// The same, reporting to `progress`.
    pub fn reporting_to(self, progress: &'a dyn Progress) -> Self {
        Self {
            progress: Some(progress),
            ..self
        }
    }

    /// The same without reports: for a part of a computation whose progress is reported as a whole.
    pub fn without_progress(self) -> Self {
        Self {
            progress: None,
            ..self
        }
    }

    /// Returns an error once the caller has cancelled.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn check(&self) -> Result<(), Cancelled> {
        match self.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(Cancelled),
            _ => Ok(()),
        }
    }

    /// Reports that a stage of the work begins: see [`Progress::stage`].
    pub fn stage(&self, what: &str, total: u64) {
        if let Some(progress) = self.progress {
            progress.stage(what, total);
        }
    }

    /// Reports that `done` of `total` units of work are finished.
    pub fn report(&self, done: u64, total: u64) {
        if let Some(progress) = self.progress {
            progress.advanced(done, total);
        }
    }
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Control")
            .field("cancel", &self.cancel)
            .field("progress", &self.progress.is_some())
            .finish()
    }
}
