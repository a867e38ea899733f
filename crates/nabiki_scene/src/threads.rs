//! The threads that work is shared among, as many as are asked for: made where they are first wanted, those that the system does not
//! give would end the program.

use rayon::ThreadPoolBuilder;

use crate::error::{Error, Result};

/// The most that are made.
pub const MOST: u16 = 512;

/// What says how many, where nothing else does.
const VARIABLE: &str = "RAYON_NUM_THREADS";

fn in_environment() -> Option<u64> {
    std::env::var(VARIABLE).ok()?.parse().ok().filter(|&count| count > 0)
}

/// Makes as many threads as are asked for, or as the environment says, or one a core. `build`: how, into the pool that is wanted.
///
/// # Errors
/// More in the environment than are made; fewer that the system gives: one line with the way out, `fewer`.
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

/// What is said where the system gives no thread at all.
pub fn none_given(error: &std::io::Error) -> String {
    format!(
        "the system cannot start a thread ({error}): end other programs, or raise the limit of threads for this user"
    )
}
