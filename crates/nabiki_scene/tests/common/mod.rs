//! A scene's text before and after a change.

use std::path::Path;

use nabiki_scene::Scene;

/// The scene, written and read.
pub fn reread(scene: &Scene) -> Scene {
    let text = scene.to_toml().unwrap();
    Scene::parse(&text, Path::new("again.toml"), &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The lines of `old` that `new` has not, and those of `new` that `old` has not, what is common at both ends set aside.
pub fn changed_lines(old: &str, new: &str) -> (Vec<String>, Vec<String>) {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let first = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let last = old[first..].iter().rev().zip(new[first..].iter().rev()).take_while(|(a, b)| a == b).count();
    let middle = |lines: &[&str]| lines[first..lines.len() - last].iter().map(|&line| line.to_owned()).collect();
    (middle(&old), middle(&new))
}

pub fn lines(wanted: &[&str]) -> Vec<String> {
    wanted.iter().map(|&line| line.to_owned()).collect()
}
