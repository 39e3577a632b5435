//! Long computations: without the global lock of the interpreter, on a number of threads, and stopped by Ctrl-C.

use crate::errors::Failure;
use airlight::Control;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often signals are looked for.
const SIGNALS: Duration = Duration::from_millis(20);

/// Largest number of threads that is not a slip.
const MOST_THREADS: usize = 4096;

/// Thread pools by process and number of threads. A child that was forked, such as a worker of a data loader, has none of the
/// threads of its parent, so it makes pools of its own. Locked only under the lock of the interpreter, under which processes fork.
static POOLS: Mutex<Option<Pools>> = Mutex::new(None);

type Pools = HashMap<(u32, usize), Arc<ThreadPool>>;

fn pool(threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    if threads.is_some_and(|threads| !(1..=MOST_THREADS).contains(&threads)) {
        let got = threads.unwrap_or(0);
        return Err(PyValueError::new_err(format!(
            "threads: expected 1 to {MOST_THREADS}, or None for one per processor, got {got}"
        )));
    }
    let threads = threads.unwrap_or(0);
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let pools = pools.get_or_insert_default();
    let key = (std::process::id(), threads);
    if let Some(pool) = pools.get(&key) {
        return Ok(pool.clone());
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool =
        Arc::new(pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?);
    pools.insert(key, pool.clone());
    Ok(pool)
}

/// Runs a computation on a number of threads (`None`: one per processor) while other threads of the interpreter run. On a signal
/// whose handler raises, as that of Ctrl-C does, the computation is cancelled and the exception is raised.
pub fn compute<T, E>(
    py: Python<'_>,
    threads: Option<usize>,
    work: impl FnOnce(Control<'_>) -> Result<T, E> + Send,
) -> PyResult<T>
where
    T: Send,
    E: Into<Failure> + Send,
{
    let pool = pool(threads)?;
    let cancel = AtomicBool::new(false);
    let (result, raised) = py.detach(|| {
        std::thread::scope(|scope| {
            let (finished, wait) = mpsc::channel::<()>();
            let (pool, cancel) = (&pool, &cancel);
            let worker = scope.spawn(move || {
                let result = pool.install(|| work(Control::cancelled_by(cancel)));
                drop(finished);
                result
            });
            let raised = wait_or_raise(&wait);
            if raised.is_some() {
                cancel.store(true, Ordering::Relaxed);
            }
            (worker.join(), raised)
        })
    });
    match (raised, result) {
        (Some(exception), _) => Err(exception),
        (None, Ok(result)) => result.map_err(|error| error.into().into()),
        (None, Err(panic)) => resume_unwind(panic),
    }
}

/// Waits until the sender is dropped, or a handler of a signal raises an exception.
fn wait_or_raise(wait: &Receiver<()>) -> Option<PyErr> {
    while wait.recv_timeout(SIGNALS) == Err(RecvTimeoutError::Timeout) {
        if let Err(exception) = Python::attach(|py| py.check_signals()) {
            return Some(exception);
        }
    }
    None
}
