//! What does not show in the program that a file comes from, and what is said of it.

/// What keeps an object of a file out of a final picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hidden {
    /// The path of the object that says so: it, or one above it.
    pub by: String,
    /// What it says: `visibility` or `purpose`.
    pub name: &'static str,
    /// The file's word for that.
    pub value: String,
    /// Whether it holds in some frames only.
    pub at_times: bool,
}

impl Hidden {
    /// The same as a phrase about what is read all the same.
    pub fn kept(&self) -> String {
        let Self { by, name, value, at_times } = self;
        format!("{name} of {by}: it is \"{value}\" there{}", if *at_times { " at some frames" } else { "" })
    }

    /// The same as a reason.
    fn reason(&self) -> String {
        format!("{} of {} is \"{}\"", self.name, self.by, self.value)
    }
}

/// A mesh of a file, and what keeps it out of pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate<T> {
    /// The mesh, as its reader knows it.
    pub mesh: T,
    /// Its path.
    pub path: String,
    /// What hides it.
    pub hidden: Vec<Hidden>,
}

/// Of the meshes that may make a head or body those that show at any time, or all where none does, and what is said of the
/// others and of what hides those, a phrase each.
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

/// What is said of the faces of a mesh that it names as holes.
pub fn kept_holes(path: &str, holes: usize) -> Option<String> {
    (holes > 0).then(|| format!("holeIndices of {path}: the {holes} faces that they take out are kept"))
}
