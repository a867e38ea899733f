//! A scene as a table of settings by key, for front ends that show and change them; and moving a scene to another
//! folder.

use std::path::{Component, Path, PathBuf};

use toml::{Table, Value};

use super::error::Problem;
use super::tree::{self, Unwritable};
use super::{HairSource, HeadSource, Scene, SceneError};

impl Scene {
    /// All settings with their values, whether given or default, as in a complete file. Tables that the scene does not
    /// have, and keys without a value, are left out.
    ///
    /// # Errors
    /// As for [`to_toml`](Self::to_toml).
    pub fn settings(&self) -> Result<Table, SceneError> {
        self.tree().map_err(|Unwritable(why)| self.origins.error("", Problem::Other(why)))
    }

    /// The value of one setting, named as for [`with_setting`](Self::with_setting). `None` if it has none or its table
    /// is not in the scene.
    ///
    /// # Errors
    /// No such setting, or as for [`to_toml`](Self::to_toml).
    pub fn setting(&self, key: &str) -> Result<Option<Value>, SceneError> {
        tree::check_path(key).map_err(|what| self.origins.error(&tree::short(key), Problem::Other(what)))?;
        if let Some(value) = tree::at(&self.settings()?, key) {
            return Ok(Some(value.clone()));
        }
        // Any value shows whether the setting exists.
        match self.with_setting(key, Some(true.into())) {
            Err(refused) if matches!(*refused.problem, Problem::UnknownKey { .. }) => Err(refused),
            _ => Ok(None),
        }
    }

    /// The scene with another value of one setting, named as in a file: `motion.time_step`, `force[1].vector`. An index
    /// one past the end appends to a list. Without a value, the key, table or entry of a list is removed. Regions then
    /// forget a field that is removed, and keep to those after it. Ranges are not checked; use [`check`](Self::check).
    ///
    /// # Errors
    /// No such setting, or a value of the wrong type.
    pub fn with_setting(&self, key: &str, value: Option<Value>) -> Result<Self, SceneError> {
        let (mut tree, mut origins) = (self.settings()?, self.origins.clone());
        origins.set_anew(key);
        let removed = value.is_none().then_some(key);
        tree::put(&mut tree, key, value).map_err(|what| origins.error(&tree::short(key), Problem::Other(what)))?;
        match Self::of_tree(tree) {
            Ok(mut scene) => {
                scene.field.own.clone_from(&self.field.own);
                removed.into_iter().for_each(|key| scene.free.forget_field(key));
                Ok(Self { text: self.text.clone(), origins, ..scene })
            }
            Err(refusal) => Err(Self::unreadable(refusal, &origins)),
        }
    }

    /// The scene with `path` as its file, which need not exist. Relative paths are adapted to lead to the same files.
    pub fn moved_to(mut self, path: &Path) -> Self {
        // A bare name is in the working folder, and so are the paths of a scene without a file.
        let folder = |file: &Path| {
            let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty());
            std::path::absolute(parent.unwrap_or(Path::new("."))).unwrap_or_default()
        };
        let (from, to) = (folder(self.file()), folder(path));
        self.origins.file = path.to_owned();
        if from == to {
            return self;
        }
        let mend = |file: &mut PathBuf| {
            if file.is_relative() && !file.as_os_str().is_empty() {
                *file = from_folder(&to, &from.join(&*file));
            }
        };
        if let HairSource::Imported(hair) = &mut self.hair.source {
            mend(&mut hair.file);
        }
        if let HeadSource::Imported(head) = &mut self.head.source {
            mend(&mut head.mesh);
        }
        self.bodies.iter_mut().for_each(|body| mend(&mut body.mesh));
        self.free.regions.iter_mut().filter_map(|region| region.map.as_mut()).for_each(mend);
        self.aims.iter_mut().for_each(|aim| mend(&mut aim.file));
        let motions = self.bodies.iter_mut().filter_map(|body| body.motion.as_mut());
        for motion in motions.chain(&mut self.head.motion) {
            mend(&mut motion.file);
            motion.skeleton.iter_mut().for_each(mend);
        }
        self
    }
}

/// The relative path from an absolute folder to an absolute path; the path itself if they share only the root.
fn from_folder(folder: &Path, path: &Path) -> PathBuf {
    let clean = |path: &Path| {
        let mut steps: Vec<Component> = Vec::new();
        for step in path.components() {
            match step {
                Component::ParentDir => drop(steps.pop()),
                Component::CurDir => {}
                step => steps.push(step),
            }
        }
        steps.into_iter().map(|step| step.as_os_str().to_owned()).collect::<Vec<_>>()
    };
    let (folder, steps) = (clean(folder), clean(path));
    let shared = folder.iter().zip(&steps).take_while(|(a, b)| a == b).count();
    if shared <= 1 {
        return steps.iter().collect();
    }
    let up = folder[shared..].iter().map(|_| Component::ParentDir.as_os_str());
    up.chain(steps[shared..].iter().map(|step| step.as_os_str())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "# wind\n[[force]]\nthrough = 50\nvector = [-100, 0, 0] # back\n\n[free]\nstiffness = 3\n";
        Scene::parse(text, "/a/b/gust.toml".as_ref(), &[]).unwrap()
    }

    #[test]
    fn every_setting_put_back_as_it_is_leaves_the_scene_as_it_was() {
        let scene = scene();
        for (key, value) in scene.settings().unwrap() {
            let again = scene.with_setting(&key, Some(value)).unwrap();
            assert_eq!(again, scene, "{key}");
            assert_eq!(again.to_toml().unwrap(), scene.to_toml().unwrap());
        }
    }

    #[test]
    fn one_setting_changes_one_place_of_the_text() {
        let changed = scene().with_setting("force[0].vector", Some(vec![-80.0, 0.0, 0.0].into())).unwrap();
        let text = changed.to_toml().unwrap();
        assert!(text.contains("[-80, 0, 0] # back") || text.contains("[-80.0, 0.0, 0.0] # back"), "{text}");
        let gust = scene().with_setting("gust", Some(Table::new().into())).unwrap();
        assert_eq!(gust.field.gust, Some(nabiki::field::Gust::default()));
        assert_eq!(gust.with_setting("gust", None).unwrap(), scene());
        let two = scene().with_setting("force[1]", Some(scene().settings().unwrap()["force"][0].clone())).unwrap();
        assert_eq!(two.field.force.len(), 2);
        assert_eq!(two.with_setting("force[1]", None).unwrap(), scene());
    }

    #[test]
    fn what_no_setting_is_called_and_values_of_the_wrong_kind_are_refused_by_name() {
        let refused = |key: &str, value: Value| scene().with_setting(key, Some(value)).unwrap_err();
        assert!(matches!(*refused("motion.timestep", 1.0.into()).problem, Problem::UnknownKey { .. }));
        assert_eq!(scene().setting("motion.timestep").unwrap_err(), refused("motion.timestep", true.into()));
        assert_eq!(scene().setting("force[0].through").unwrap(), Some(50.into()));
        assert!(["gust.seed", "force[7].vector"].iter().all(|key| scene().setting(key).unwrap().is_none()));
        for key in ["free.".to_owned() + &"a.".repeat(100_000) + "b", "force".to_owned() + &"[0]".repeat(100_000)] {
            let line = refused(&key, 1.into()).to_string();
            assert!(line.contains("no setting is nested so deep") && line.len() < 300, "{line}");
            assert_eq!(scene().setting(&key).unwrap_err().to_string(), line);
            let open = [(key.clone(), "1".to_owned())];
            assert!(Scene::parse("", "".as_ref(), &open).unwrap_err().to_string().len() < 300);
        }
        let kind = refused("motion.frames", "many".into());
        assert_eq!(kind.key, "motion.frames");
        assert!(matches!(*kind.problem, Problem::Kind { .. }));
        // The place of a value in the file is its line.
        assert_eq!(refused("force[0].vector", 1.into()).line, Some(4));
    }

    #[test]
    fn a_scene_that_moves_leads_to_the_same_files() {
        let text = "[head.motion]\nfile = \"../motion/turn.csv\"\n[[body]]\nmesh = \"ball.obj\"\n[[force]]\nthrough = 1\nvector = [0, 0, 0]\n";
        let scene = Scene::parse(text, "/a/b/c.toml".as_ref(), &[]).unwrap();
        let moved = scene.clone().moved_to("/a/x/y/c.toml".as_ref());
        assert_eq!(moved.bodies[0].mesh, Path::new("../../b/ball.obj"));
        assert_eq!(moved.head.motion.as_ref().unwrap().file, Path::new("../../motion/turn.csv"));
        assert_eq!(moved.moved_to("/a/b/d.toml".as_ref()), Scene::parse(text, "/a/b/d.toml".as_ref(), &[]).unwrap());
        assert_eq!(scene.clone().moved_to("/a/b/d.toml".as_ref()), scene);
        // A bare name, or none, is in the working folder.
        for file in ["c.toml", ""] {
            let here = Scene::parse(text, file.as_ref(), &[]).unwrap();
            let below = here.clone().moved_to("x/c.toml".as_ref());
            assert_eq!(below.bodies[0].mesh, Path::new("../ball.obj"), "{file}");
            assert_eq!(below.moved_to("d.toml".as_ref()).bodies, here.bodies);
        }
        let far = scene.moved_to("/z/c.toml".as_ref());
        assert_eq!(far.bodies[0].mesh, Path::new("/a/b/ball.obj"));
    }
}
