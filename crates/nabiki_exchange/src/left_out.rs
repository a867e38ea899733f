//! Objects of a file that are left out, and the messages about them.

use crate::Problem;

/// Objects of a kind that is not supported, such as a NURBS surface.
pub struct LeftOut<'a> {
    /// The kind, in the users' terms.
    pub kind: &'a str,
    /// Paths of the objects.
    pub paths: Vec<String>,
}

impl LeftOut<'_> {
    /// A phrase that reports that they are left out. `read` is the kind that is read instead.
    pub fn unread(&self, read: &str) -> Option<String> {
        let first = self.paths.first()?;
        let more = match self.paths.len() - 1 {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        Some(format!("{} {first}{more}: only {read} are read", self.kind))
    }

    /// The error if the file has only such objects. `read` is as above.
    pub fn refused(&self, read: &str) -> Option<Problem> {
        self.paths.first()?;
        Some(Problem(format!("has {}, but nabiki reads only {read}: convert them", self.kind)))
    }
}
