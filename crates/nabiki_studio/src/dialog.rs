//! What is asked in front of everything else.

use std::path::{Path, PathBuf};

use crate::recovery::Kept;
use crate::tasks;

/// A question, with what has been answered so far.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// Which file?
    File(Chooser),
    /// Somebody else has written the file that is to be saved; what comes after it.
    Conflict(PathBuf, Option<Next>),
    /// Something is not saved, and would be lost by what is to come.
    Unsaved(Next),
    /// An export runs, and would end with the window.
    Exporting,
    /// Scenes that were not saved when windows were killed.
    Recover(Vec<Kept>),
    /// Which command?
    Palette {
        /// The letters typed.
        query: String,
        /// The line chosen.
        line: usize,
    },
    /// The list of keys.
    Keys,
    /// Shows the note with first steps.
    Welcome,
    /// The preferences.
    Preferences,
    /// What is exported, and where?
    Export(tasks::Order),
    /// How does a dropped file lie?
    Import(Import),
}

/// What comes after a question whether to save.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Another scene.
    Open(PathBuf),
    /// What was recovered.
    Recover(Box<Kept>),
    /// The text that was mended.
    UseMended,
    /// The scene behind the text that is being mended.
    LeaveText,
    /// The end.
    Quit,
}

/// What a file is chosen for.
#[derive(Clone, Debug, PartialEq)]
pub enum Purpose {
    /// To be opened.
    Open,
    /// To be written; what comes after it.
    SaveAs(Option<Box<Next>>),
    /// To be named by a setting.
    Setting(String),
    /// To be exported into; for which order.
    Export(tasks::Order),
}

/// A file being chosen: a path that is typed or put together from what is in a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Chooser {
    /// What for.
    pub purpose: Purpose,
    /// The path as it stands.
    pub path: String,
    /// Endings of the files that are shown; all if there are none.
    pub endings: Vec<&'static str>,
}

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    /// Its name.
    pub name: String,
    /// Its path.
    pub path: PathBuf,
    /// Whether it is a folder.
    pub folder: bool,
}

impl Chooser {
    /// What is asked, in a word or two.
    pub fn title(&self) -> &'static str {
        match self.purpose {
            Purpose::Open => "Open",
            Purpose::SaveAs(_) => "Save as",
            Purpose::Setting(_) => "Choose a file",
            Purpose::Export(_) => "Export to",
        }
    }

    /// The folder that is shown: that of the path, or the path itself where it ends like one.
    pub fn folder(&self) -> PathBuf {
        let path = Path::new(&self.path);
        if self.path.ends_with(std::path::is_separator) || self.path.is_empty() {
            return path.to_owned();
        }
        path.parent().map(Path::to_owned).unwrap_or_default()
    }

    /// Whether that folder is there.
    pub fn has_folder(&self) -> bool {
        let folder = self.folder();
        folder.as_os_str().is_empty() || folder.is_dir()
    }

    /// What is in the folder, folders first, by name; what is hidden is left out.
    pub fn listed(&self) -> Vec<Listed> {
        let folder = self.folder();
        let there = if folder.as_os_str().is_empty() { Path::new(".") } else { &folder };
        let look = |entry: std::fs::DirEntry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = folder.join(&name);
            let is_folder = path.is_dir();
            let fits = self.endings.is_empty()
                || path.extension().is_some_and(|e| self.endings.iter().any(|ending| e.eq_ignore_ascii_case(ending)));
            (!name.starts_with('.') && (is_folder || fits)).then_some(Listed { name, path, folder: is_folder })
        };
        let mut listed: Vec<Listed> =
            std::fs::read_dir(there).into_iter().flatten().flatten().filter_map(look).collect();
        listed.sort_by_cached_key(|entry| (!entry.folder, entry.name.to_lowercase()));
        listed
    }

    /// The same in the folder above.
    pub fn up(&self) -> Self {
        let folder = std::path::absolute(self.folder()).unwrap_or_default();
        let above = folder.parent().unwrap_or(&folder);
        Self { path: as_folder(above), ..self.clone() }
    }

    /// The same with an entry of the folder taken.
    pub fn with(&self, entry: &Listed) -> Self {
        let path = if entry.folder { as_folder(&entry.path) } else { entry.path.display().to_string() };
        Self { path, ..self.clone() }
    }
}

/// A path that ends as a folder's.
pub fn as_folder(path: &Path) -> String {
    let mut text = path.display().to_string();
    if !text.is_empty() && !text.ends_with(std::path::is_separator) {
        text.push(std::path::MAIN_SEPARATOR);
    }
    text
}

/// The file that a scene is saved into under a name: one without an ending has that of a scene.
pub fn as_scene_file(path: &Path) -> PathBuf {
    if path.extension().is_none() { path.with_extension("toml") } else { path.to_owned() }
}

/// What a dropped file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The hair at rest.
    Hair,
    /// The head.
    Head,
    /// What moves the head.
    Motion,
    /// A body that hair does not enter.
    Body,
}

impl Role {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hair => "Hair",
            Self::Head => "Head",
            Self::Motion => "Head motion",
            Self::Body => "Body",
        }
    }

    /// What a file may be, by its ending, the likeliest first.
    pub fn of(path: &Path) -> Vec<Self> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "hair" | "tfx" => vec![Self::Hair],
            "bvh" | "amc" | "tof" | "csv" => vec![Self::Motion],
            "ply" | "tfxmesh" => vec![Self::Head, Self::Body],
            "obj" => vec![Self::Head, Self::Hair, Self::Body],
            "glb" | "gltf" | "fbx" => vec![Self::Head, Self::Motion, Self::Body],
            "usd" | "usda" | "usdc" | "abc" => vec![Self::Hair, Self::Head, Self::Motion, Self::Body],
            _ => Vec::new(),
        }
    }
}

/// How a dropped file lies, as far as it does not say so itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The file.
    pub path: PathBuf,
    /// What it may be.
    pub roles: Vec<Role>,
    /// What it is.
    pub role: Role,
    /// Its unit; empty: what the file says.
    pub unit: String,
    /// Its axis that points up; empty: what the file says.
    pub up: String,
    /// Its axis along which the face looks; empty: what the file says.
    pub facing: String,
    /// The joint that carries the head.
    pub node: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_shows_what_can_be_chosen() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.toml", "a.TOML", "c.txt", ".hidden.toml"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("z")).unwrap();
        let chooser = Chooser { purpose: Purpose::Open, path: as_folder(folder.path()), endings: vec!["toml"] };
        let names: Vec<String> = chooser.listed().into_iter().map(|entry| entry.name).collect();
        assert_eq!(names, ["z", "a.TOML", "b.toml"]);
        let below = chooser.with(&chooser.listed()[0]);
        assert!(below.listed().is_empty());
        assert_eq!(below.up().path, chooser.path);
        let chosen = chooser.with(&chooser.listed()[1]);
        assert_eq!(chosen.folder(), folder.path());
    }

    #[test]
    fn a_folder_that_is_not_there_shows_nothing() {
        let chooser = Chooser { purpose: Purpose::Open, path: "/no/such/place/".to_owned(), endings: Vec::new() };
        assert!(chooser.listed().is_empty() && !chooser.has_folder());
        assert!(Chooser { path: "name.toml".to_owned(), ..chooser }.has_folder(), "that of the program");
    }
}
