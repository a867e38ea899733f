//! The memory that reading one file may take, in sum: [`Budget::LEAST`] bytes, and [`Budget::TIMES`] for each byte of the file.
//!
//! Every reader counts tables, names, arrays and copies of shared data here before it makes them.

use std::cell::Cell;
use std::fmt;

use nabiki::hair::Values;

use crate::Problem;

/// The memory that reading one file may take: all tables, arrays, names and copies of shared data together, each counted before it is
/// made.
///
/// Bounds of single arrays do not help: a few kilobytes can pack thousands of them, or name one thousands of times. An honest file
/// takes a few times its own length, as numbers of one byte become some of eight and names become paths; [`TIMES`](Self::TIMES)
/// is well above that. What lies in a file once and is used once counts little, so this is felt where data is packed or shared.
///
/// What is made to stay is [kept](Self::keep); what one question takes is [taken](Self::take) until the [next](Self::next_question), so that
/// frames, which are read one after another, are not added up.
#[derive(Debug)]
pub struct Budget {
    file: u64,
    kept: Cell<u64>,
    taken: Cell<u64>,
    /// What all moments of a question but the last took.
    read: Cell<u64>,
}

impl Budget {
    /// Bytes that a file of any length may take.
    pub const LEAST: u64 = 32 << 20;
    /// Bytes that it may take beyond, for each of its own.
    pub const TIMES: u64 = 16;

    /// How many times what it may take at once all moments of a motion may take.
    pub const MOMENTS: u64 = 8;

    /// That of a file of so many bytes, all its parts together.
    pub fn of(file: u64) -> Self {
        Self { file, kept: Cell::new(0), taken: Cell::new(0), read: Cell::new(0) }
    }

    /// Bytes that may be taken in all.
    pub fn most(&self) -> u64 {
        self.file.saturating_mul(Self::TIMES).saturating_add(Self::LEAST)
    }

    /// Counts `bytes` that stay as long as the file is open. `what` they are: "names of prims".
    ///
    /// # Errors
    /// One line, where that would be more than the file may take.
    pub fn keep(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        self.check(bytes, what)?;
        self.kept.set(self.kept.get() + bytes);
        Ok(())
    }

    /// Counts `bytes` that the question at hand takes.
    ///
    /// # Errors
    /// As [`keep`](Self::keep).
    pub fn take(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        self.check(bytes, what)?;
        self.taken.set(self.taken.get() + bytes);
        Ok(())
    }

    /// Counts a list of `count` values of a type, as [`take`](Self::take) does.
    ///
    /// # Errors
    /// As [`keep`](Self::keep).
    pub fn take_list<T>(&self, count: usize, what: &str) -> Result<(), Problem> {
        self.take((count as u64).saturating_mul(size_of::<T>() as u64), what)
    }

    /// Counts the copies of `words` for which `indices` stand, as [`take`](Self::take) does.
    ///
    /// # Errors
    /// As [`keep`](Self::keep).
    pub fn take_words(&self, words: &[String], indices: &[i64], what: &str) -> Result<(), Problem> {
        let copy = |&index: &i64| usize::try_from(index).ok().and_then(|i| words.get(i)).map_or(0, String::len);
        let letters: u64 = indices.iter().map(|index| copy(index) as u64).sum();
        self.take_list::<String>(indices.len(), what)?;
        self.take(letters, what)
    }

    /// The same for values of `extent` parts each.
    ///
    /// # Errors
    /// As [`keep`](Self::keep).
    pub fn take_values(&self, values: &Values, extent: usize, indices: &[i64], what: &str) -> Result<(), Problem> {
        let parts = indices.len().saturating_mul(extent);
        match values {
            Values::Words(words) => self.take_words(words, indices, what),
            Values::Floats(_) => self.take_list::<f32>(parts, what),
            Values::Integers(_) | Values::Doubles(_) => self.take_list::<f64>(parts, what),
        }
    }

    /// Forgets what the last question took.
    pub fn next_question(&self) {
        self.taken.set(0);
        self.read.set(0);
    }

    /// Begins another moment of the question at hand, which keeps nothing of the last: memory is counted anew, and all that moments
    /// take together, which is time, may be [`MOMENTS`](Self::MOMENTS) times as much.
    ///
    /// # Errors
    /// One line, where that is more.
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
            "needs more than {most} to be read over and over, which is the most for a file of {file}: bake the motion, or export it \
             again in several files"
        )))
    }

    fn check(&self, bytes: u64, what: &str) -> Result<(), Problem> {
        let all = self.kept.get().saturating_add(self.taken.get()).saturating_add(bytes);
        if all <= self.most() {
            return Ok(());
        }
        let [all, most, file] = [all, self.most(), self.file].map(Size);
        Err(Problem(format!(
            "with its {what} it takes {all} of memory, and a file of {file} may take {most} in all: is it damaged? \
             If it is not, export it again in several files"
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
            "with its paths of prims it takes 18446744 TB of memory, and a file of 1.0 MB may take 50 MB in all: is it damaged? \
             If it is not, export it again in several files"
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
