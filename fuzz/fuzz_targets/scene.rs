//! Scenes: text first, then, behind a zero byte, an override. Every error is one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_scene::Scene;

fuzz_target!(|text: &str| {
    within_budget(text.len(), || {
        let (text, over) = text.split_once('\0').unwrap_or((text, ""));
        let overrides: Vec<(String, String)> =
            over.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned())).into_iter().collect();
        if let Err(error) = Scene::parse(text, "scene.toml".as_ref(), &overrides) {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    });
});
