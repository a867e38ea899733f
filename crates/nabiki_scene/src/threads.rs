//! The worker threads. They are created early, because a thread that the system refuses later would end the program.

use rayon::ThreadPoolBuilder;

use crate::error::{Error, Result};

/// Largest number of threads.
pub const MOST: u16 = 512;

/// The environment variable for the number.
const VARIABLE: &str = "RAYON_NUM_THREADS";

fn in_environment() -> Option<u64> {
    std::env::var(VARIABLE).ok()?.parse().ok().filter(|&count| count > 0)
}

/// Creates the requested number of threads, or that of the environment, or one per core. `build` creates the pool.
///
/// # Errors
/// A larger number in the environment than [`MOST`], or a number that the system refuses. One line that ends with the
/// remedy `fewer`.
pub fn made<T>(
    asked: Option<u16>,
    fewer: &str,
    build: impl FnOnce(ThreadPoolBuilder) -> Result<T, rayon::ThreadPoolBuildError>,
) -> Result<T> {
    if let Some(count) = in_environment().filter(|&count| asked.is_none() && count > u64::from(MOST)) {
        let line = format!("{VARIABLE}={count}: at most {MOST} threads: set it lower, or leave it out");
        return Err(Error::refused(line));
    }
    let builder = ThreadPoolBuilder::new();
    let builder = match asked {
        Some(threads) => builder.num_threads(threads.into()),
        None => builder,
    };
    build(builder).map_err(|e| {
        let wanted = match (asked, in_environment()) {
            (Some(threads), _) => format!("--threads {threads}"),
            (None, Some(count)) => format!("{VARIABLE}={count}"),
            (None, None) => "a thread for each core".to_owned(),
        };
        Error::refused(format!("{wanted}: the system cannot start that many ({e}); {fewer}"))
    })
}

/// The message if the system refuses any thread.
pub fn none_given(error: &std::io::Error) -> String {
    format!(
        "the system cannot start a thread ({error}): end other programs, or raise the limit of threads for this user"
    )
}
