//! What is remembered from one start to the next: window, view, files used last. Nothing that is wrong with it stops the
//! start.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::play::Ending;
use crate::view::Navigation;

/// What is remembered.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default)]
pub struct Preferences {
    /// Width and height of the window (points).
    pub window: [f32; 2],
    /// Whether the window fills the screen.
    pub maximised: bool,
    /// Size of everything, as a part of what the system says.
    pub zoom: f32,
    /// Mouse buttons of the view.
    pub navigation: Navigation,
    /// Strands shown; [`ALL`] for all of any scene.
    pub strands: usize,
    /// Whether the paths of the tips are drawn.
    pub ghosts: bool,
    /// Whether the wind is drawn in space.
    pub arrows: bool,
    /// Whether the finished picture comes when the hand rests.
    pub final_picture: bool,
    /// What happens after the last frame.
    pub ending: Ending,
    /// Whether the words of the first start have been read.
    pub welcomed: bool,
    /// Files opened last, the newest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            window: [1440.0, 900.0],
            maximised: false,
            zoom: 1.0,
            navigation: Navigation::Blender,
            strands: 1000,
            ghosts: false,
            arrows: true,
            final_picture: true,
            ending: Ending::Loop,
            welcomed: false,
            recent: Vec::new(),
        }
    }
}

/// Files remembered.
const MOST_RECENT: usize = 10;

/// Fewest strands that the slider shows.
pub const FEWEST: usize = 300;
/// As many strands as this are all of any scene.
pub const ALL: usize = 1_000_000_000;

impl Preferences {
    /// What was remembered in `folder`; what cannot be read, or makes no sense, is as at the first start, and said.
    pub fn load(folder: &Path) -> (Self, Option<String>) {
        let file = folder.join(FILE);
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return (Self::default(), None),
            Err(e) => {
                return (Self::default(), Some(format!("{}: {e}; the default preferences apply", file.display())));
            }
        };
        match toml::from_str::<Self>(&text) {
            Ok(read) => (read.sane(), None),
            Err(e) => {
                let why = e.message().lines().next().unwrap_or_default().to_owned();
                (Self::default(), Some(format!("{}: {why}; the default preferences apply", file.display())))
            }
        }
    }

    /// With sizes that a window and a view can have.
    fn sane(mut self) -> Self {
        let default = Self::default();
        let fits = |side: f32| (200.0..20_000.0).contains(&side);
        if !self.window.iter().all(|side| fits(*side)) {
            self.window = default.window;
        }
        if !(0.5..=4.0).contains(&self.zoom) {
            self.zoom = default.zoom;
        }
        if self.strands == 0 {
            self.strands = default.strands;
        }
        self.recent.truncate(MOST_RECENT);
        self
    }

    /// Writes them into `folder`.
    ///
    /// # Errors
    /// What the disk says.
    pub fn save(&self, folder: &Path) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        let text = toml::to_string(self).map_err(std::io::Error::other)?;
        nabiki_file::write(&folder.join(FILE), text.as_bytes())
    }

    /// How many strands are shown, in words.
    pub fn strands_in_words(&self) -> String {
        if self.strands >= ALL { "all".to_owned() } else { self.strands.to_string() }
    }

    /// Notes that a file was opened or saved.
    pub fn used(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|known| *known != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }
}

const FILE: &str = "studio.toml";

/// The file in which the places of the panels are remembered.
pub const LAYOUT: &str = "layout.json";

/// The folder for what is remembered: `NABIKI_CONFIG`, or the platform's. None where the platform says none.
pub fn folder() -> Option<PathBuf> {
    let named = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    named("NABIKI_CONFIG").or_else(|| {
        if cfg!(target_os = "windows") {
            Some(named("APPDATA")?.join("nabiki"))
        } else if cfg!(target_os = "macos") {
            Some(named("HOME")?.join("Library/Application Support/nabiki"))
        } else {
            Some(named("XDG_CONFIG_HOME").or_else(|| Some(named("HOME")?.join(".config")))?.join("nabiki"))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_remembered_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let mut preferences = Preferences { window: [800.0, 600.0], strands: 300, ..Preferences::default() };
        preferences.used(Path::new("/a.toml"));
        preferences.used(Path::new("/b.toml"));
        preferences.used(Path::new("/a.toml"));
        assert_eq!(preferences.recent, [Path::new("/a.toml"), Path::new("/b.toml")]);
        preferences.save(folder.path()).unwrap();
        assert_eq!(Preferences::load(folder.path()), (preferences, None));
    }

    #[test]
    fn the_files_used_last_are_found_from_any_folder_and_older_ones_are_forgotten() {
        let mut preferences = Preferences::default();
        (0..12).for_each(|n| preferences.used(Path::new(&format!("{n}.toml"))));
        assert_eq!(preferences.recent.len(), MOST_RECENT);
        assert_eq!(preferences.recent[0], std::path::absolute("11.toml").unwrap());
    }

    #[test]
    fn what_is_broken_is_said_and_does_not_matter() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Preferences::load(folder.path()), (Preferences::default(), None));
        std::fs::write(folder.path().join(FILE), "window = \"wide\"").unwrap();
        let (read, said) = Preferences::load(folder.path());
        assert_eq!(read, Preferences::default());
        assert!(said.unwrap().contains("studio.toml"));
        std::fs::write(folder.path().join(FILE), "window = [0.0, nan]\nzoom = 99.0\nstrands = 0\nnews = 1").unwrap();
        assert_eq!(Preferences::load(folder.path()), (Preferences::default(), None));
    }
}
