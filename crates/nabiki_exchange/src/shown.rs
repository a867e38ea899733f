//! Objects that are hidden in the program that wrote a file, and the messages about them.

/// Why an object of a file is hidden in final renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hidden {
    /// The path of the object that hides it: itself, or one above it.
    pub by: String,
    /// The property: `visibility` or `purpose`.
    pub name: &'static str,
    /// The value in the file.
    pub value: String,
    /// Whether it applies only in some frames.
    pub at_times: bool,
}

impl Hidden {
    /// A phrase that reports that the object is read nevertheless.
    pub fn kept(&self) -> String {
        let Self { by, name, value, at_times } = self;
        format!("{name} of {by}, which is \"{value}\"{}", if *at_times { " at some frames" } else { "" })
    }

    /// The same as a reason.
    fn reason(&self) -> String {
        format!("{} of {} is \"{}\"", self.name, self.by, self.value)
    }
}

/// A mesh of a file, and why it is hidden.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate<T> {
    /// The mesh, in the reader's type.
    pub mesh: T,
    /// Its path.
    pub path: String,
    /// The reasons for hiding it.
    pub hidden: Vec<Hidden>,
}

/// The meshes for a head or body that are visible at any time, or all if none is. Also returns phrases about the
/// others, and about what hides meshes that are used.
pub fn those_that_show<T>(all: Vec<Candidate<T>>) -> (Vec<T>, Vec<String>) {
    let any_shows = all.iter().any(|mesh| mesh.hidden.iter().all(|hidden| hidden.at_times));
    let (mut chosen, mut unread) = (Vec::new(), Vec::new());
    for Candidate { mesh, path, hidden } in all {
        match hidden.iter().find(|hidden| !hidden.at_times) {
            Some(hidden) if any_shows => {
                unread.push(format!("mesh {path}, which is hidden: {}", hidden.reason()));
            }
            _ => {
                unread.extend(hidden.iter().map(Hidden::kept));
                chosen.push(mesh);
            }
        }
    }
    (chosen, unread)
}

/// The message about faces of a mesh that are marked as holes.
pub fn kept_holes(path: &str, holes: usize) -> Option<String> {
    (holes > 0).then(|| format!("holeIndices of {path}: the {holes} faces they remove are kept"))
}
