//! The threads that work is shared among, in a process that was forked, too.
//!
//! A fork has its parent's memory and none of its threads: work handed to those would wait for ever. `multiprocessing` forks on
//! Linux unless it is told otherwise (before Python 3.14), so that a fork gets threads of its own.

use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use nabiki_scene::{Result, threads};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error;

/// The threads of a process, and which it is: those of a fork are others. None are made before anything is worked on.
static OWN: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Carries out work that may be shared among threads.
///
/// # Errors
/// One line, where the system does not give them.
pub fn shared<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T> {
    Ok(of_process(std::process::id())?.install(work))
}

/// The same while other threads of Python go on.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| shared(work)).map_err(|refused| error::raised(py, refused))
}

/// What one thread at a time may ask. Who comes meanwhile is not kept waiting: it may be a function that the work itself asks.
pub fn alone<'a, T>(shared: &'a Mutex<T>, thing: &str, method: &str) -> PyResult<MutexGuard<'a, T>> {
    match shared.try_lock() {
        Ok(free) => Ok(free),
        Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => {
            Err(PyRuntimeError::new_err(format!("this {thing} is in use: give each thread its own, scene.{method}()")))
        }
    }
}

/// They live as long as the process: those of the process it was forked from are not there to be ended.
fn of_process(here: u32) -> Result<&'static ThreadPool> {
    let mut own = OWN.lock().unwrap_or_else(PoisonError::into_inner);
    match *own {
        Some((process, pool)) if process == here => Ok(pool),
        _ => {
            let fewer = "set RAYON_NUM_THREADS to fewer before the first use";
            let pool: &'static ThreadPool = Box::leak(Box::new(threads::made(None, fewer, ThreadPoolBuilder::build)?));
            *own = Some((here, pool));
            Ok(pool)
        }
    }
}
