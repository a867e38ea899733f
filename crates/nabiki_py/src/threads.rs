//! The threads that work is shared among, in a process that was forked, too.
//!
//! A fork has its parent's memory and none of its threads: work handed to those would wait for ever. `multiprocessing` forks on
//! Linux unless it is told otherwise (before Python 3.14), so that a fork gets threads of its own.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The process in which rayon's own threads are; 0 before anything was worked on.
static FIRST: AtomicU32 = AtomicU32::new(0);

/// The threads of a fork, and its process: those of a fork's fork are others.
static FORKS: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);

/// Carries out work that may be shared among threads.
pub fn shared<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let here = std::process::id();
    match FIRST.compare_exchange(0, here, Ordering::Relaxed, Ordering::Relaxed) {
        Err(first) if first != here => of_fork(here).install(work),
        _ => work(),
    }
}

/// The same while other threads of Python go on.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    py.detach(|| shared(work))
}

/// What one thread at a time may ask. Who comes meanwhile is not kept waiting: it may be a function that the work itself asks.
pub fn alone<'a, T>(shared: &'a Mutex<T>, thing: &str, method: &str) -> PyResult<MutexGuard<'a, T>> {
    match shared.try_lock() {
        Ok(free) => Ok(free),
        Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(format!(
            "this {thing} is at work: give each thread one of its own, scene.{method}()"
        ))),
    }
}

/// They live as long as the process: those of the process it was forked from are not there to be ended.
fn of_fork(here: u32) -> &'static ThreadPool {
    let mut forks = FORKS.lock().unwrap_or_else(PoisonError::into_inner);
    match *forks {
        Some((process, pool)) if process == here => pool,
        _ => {
            let pool = Box::leak(Box::new(ThreadPoolBuilder::new().build().expect("threads can be started")));
            *forks = Some((here, pool));
            pool
        }
    }
}
