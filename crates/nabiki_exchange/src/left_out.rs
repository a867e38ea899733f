//! Objects of a file that are left out, and what is said of them.

use crate::Problem;

/// Objects of a kind that is not read, such as a NURBS surface.
pub struct LeftOut<'a> {
    /// The kind, by the word that its users know.
    pub kind: &'a str,
    /// Paths of the objects.
    pub paths: Vec<String>,
}

impl LeftOut<'_> {
    /// That they are left out beside others, as a phrase; `read`: the kind that is read in their place.
    pub fn unread(&self, read: &str) -> Option<String> {
        let first = self.paths.first()?;
        let more = match self.paths.len() - 1 {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        Some(format!("{} {first}{more}: only {read} are read", self.kind))
    }

    /// That they are all that there is; `read`: as above.
    pub fn refused(&self, read: &str) -> Option<Problem> {
        self.paths.first()?;
        Some(Problem(format!("has {}, but nabiki reads only {read}: convert them", self.kind)))
    }
}
