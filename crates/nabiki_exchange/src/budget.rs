//! The memory limit for reading one file: [`Budget::LEAST`] bytes, plus [`Budget::TIMES`] bytes for each byte of the
//! file.
//!
//! Every reader counts tables, names, arrays and copies of shared data here before it allocates them.

use std::cell::Cell;
use std::fmt;

use nabiki::hair::Values;

use crate::Problem;

/// The memory limit for reading one file. All tables, arrays, names and copies of shared data together count, each
/// before it is allocated.
///
/// Limits for single arrays do not help: a few kilobytes can pack thousands of arrays, or refer to one thousands of
/// times. An honest file needs a few times its own length, because one-byte numbers become eight bytes and names become
/// paths. [`TIMES`](Self::TIMES) is well above that. Data that is stored and used once counts little, so the limit
/// affects only packed or shared data.
///
/// Memory that stays is [kept](Self::keep). Memory for one request is [taken](Self::take) until the
/// [next](Self::next_question) one, so frames that are read one after another do not add up.
#[derive(Debug)]
pub struct Budget {
    file: u64,
    kept: Cell<u64>,
    taken: Cell<u64>,
    /// What all moments of a question but the last took.
    read: Cell<u64>,
}

impl Budget {
    /// Bytes allowed for a file of any length.
    pub const LEAST: u64 = 32 << 20;
    /// Additional bytes allowed per byte of the file.
    pub const TIMES: u64 = 16;

    /// Factor on the limit for all moments of a motion together.
    pub const MOMENTS: u64 = 8;

    /// The limit for a file of this length (bytes), including all its parts.
    pub fn of(file: u64) -> Self {
        Self { file, kept: Cell::new(0), taken: Cell::new(0), read: Cell::new(0) }
    }

    /// The limit in bytes.
    pub fn most(&self) -> u64 {
        self.file.saturating_mul(Self::TIMES).saturating_add(Self::LEAST)
    }

    /// Counts `bytes` that stay while the file is open. `what` describes them, for example "names of prims".
    ///
    /// # Errors
    /// One line, if this exceeds the limit.
    pub fn keep(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        self.check(bytes, what)?;
        self.kept.set(self.kept.get() + bytes);
        Ok(())
    }

    /// Counts `bytes` for the current request.
    ///
    /// # Errors
    /// As for [`keep`](Self::keep).
    pub fn take(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        self.check(bytes, what)?;
        self.taken.set(self.taken.get() + bytes);
        Ok(())
    }

    /// Counts a list of `count` values of a type, like [`take`](Self::take).
    ///
    /// # Errors
    /// As for [`keep`](Self::keep).
    pub fn take_list<T>(&self, count: usize, what: &str) -> Result<(), Problem> {
        self.take((count as u64).saturating_mul(size_of::<T>() as u64), what)
    }

    /// Counts the copies of `words` that `indices` refer to, like [`take`](Self::take).
    ///
    /// # Errors
    /// As for [`keep`](Self::keep).
    pub fn take_words(&self, words: &[String], indices: &[i64], what: &str) -> Result<(), Problem> {
        let copy = |&index: &i64| usize::try_from(index).ok().and_then(|i| words.get(i)).map_or(0, String::len);
        let letters: u64 = indices.iter().map(|index| copy(index) as u64).sum();
        self.take_list::<String>(indices.len(), what)?;
        self.take(letters, what)
    }

    /// Like [`take_words`](Self::take_words), for values of `extent` parts each.
    ///
    /// # Errors
    /// As for [`keep`](Self::keep).
    pub fn take_values(&self, values: &Values, extent: usize, indices: &[i64], what: &str) -> Result<(), Problem> {
        let parts = indices.len().saturating_mul(extent);
        match values {
            Values::Words(words) => self.take_words(words, indices, what),
            Values::Floats(_) => self.take_list::<f32>(parts, what),
            Values::Integers(_) | Values::Doubles(_) => self.take_list::<f64>(parts, what),
        }
    }

    /// Releases the memory of the last request.
    pub fn next_question(&self) {
        self.taken.set(0);
        self.read.set(0);
    }

    /// Starts another moment of the current request, which keeps nothing of the last one. Memory is counted from 0
    /// again. The sum over all moments, which measures time, may be [`MOMENTS`](Self::MOMENTS) times the limit.
    ///
    /// # Errors
    /// One line, if the sum exceeds that.
    pub fn next_moment(&self) -> Result<(), Problem> {
        let read = self.read.get().saturating_add(self.taken.get());
        self.taken.set(0);
        self.read.set(read);
        let most = self.most().saturating_mul(Self::MOMENTS);
        if read <= most {
            return Ok(());
        }
        let [most, file] = [most, self.file].map(Size);
        Err(Problem(format!(
            "needs more than {most} to be read repeatedly, the most for a file of {file}: bake the motion, or export it in \
             several files"
        )))
    }

    fn check(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        let all = self.kept.get().saturating_add(self.taken.get()).saturating_add(bytes);
        if all <= self.most() {
            return Ok(());
        }
        let [all, most, file] = [all, self.most(), self.file].map(Size);
        Err(Problem(format!(
            "needs {all} of memory with its {what}, but a file of {file} may use at most {most}: is it damaged? \
             If not, export it in several files"
        )))
    }
}

/// A number of bytes to two digits.
struct Size(u64);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut size = self.0 as f64;
        for unit in ["bytes", "kB", "MB", "GB"] {
            if size < 1000.0 {
                let digits = usize::from(size < 10.0 && unit != "bytes");
                return write!(f, "{size:.digits$} {unit}");
            }
            size /= 1000.0;
        }
        write!(f, "{size:.0} TB")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_and_what_a_question_takes_is_one_sum() {
        let budget = Budget::of(1 << 20);
        let most = budget.most();
        budget.keep(most / 2, "names").unwrap();
        budget.take(most / 4, "points").unwrap();
        budget.take(most / 4, "points").unwrap();
        assert!(budget.take(1, "points").is_err() && budget.keep(1, "names").is_err());
        budget.next_question();
        budget.take(most / 2, "points").unwrap();
        budget.next_question();
        let refused = budget.take(u64::MAX, "paths of prims").unwrap_err().to_string();
        assert_eq!(
            refused,
            "needs 18446744 TB of memory with its paths of prims, but a file of 1.0 MB may use at most 50 MB: is it damaged? \
             If not, export it in several files"
        );
    }

    #[test]
    fn a_refusal_takes_nothing() {
        let budget = Budget::of(0);
        assert!(budget.take(Budget::LEAST + 1, "points").is_err());
        budget.take(Budget::LEAST, "points").unwrap();
    }

    #[test]
    fn sizes_have_two_digits() {
        let text = |bytes| Size(bytes).to_string();
        assert_eq!([997, 4_750, 33_554_432, 4_400_000_000].map(text), ["997 bytes", "4.8 kB", "34 MB", "4.4 GB"]);
    }
}
