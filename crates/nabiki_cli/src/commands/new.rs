//! `nabiki new`: a scene to begin with.

use std::io::Write;

use nabiki_file::PartFile;
use nabiki_io::Error;
use nabiki_scene::Scene;
use nabiki_scene::template::template;

use crate::args::New;
use crate::failure::Failure;
use crate::place;
use crate::say::say;

pub fn new(args: &New, quiet: bool) -> Result<(), Failure> {
    if !args.force && std::fs::symlink_metadata(&args.scene).is_ok() {
        let path = args.scene.display();
        return Err(Failure::new(format!("{path}: is there already; choose another name, or replace it with --force")));
    }
    place::file(&args.scene)?;
    let template = template(&args.scene, args.head.as_deref(), &args.group, args.hair.as_deref())?;
    // What is written runs: a few strands show it.
    let few = [("hair.strands".to_owned(), "50".to_owned())];
    Scene::parse(&template.text, &args.scene, &few)?.build()?;
    let write = || {
        let mut file = PartFile::create(&args.scene)?;
        file.write_all(template.text.as_bytes())?;
        file.finish()
    };
    write().map_err(|e| Error::from(e).in_file(&args.scene))?;
    if !quiet {
        for guess in &template.guesses {
            say!("  guessed {guess}");
        }
        say!("  wrote   {}", args.scene.display());
    }
    Ok(())
}
