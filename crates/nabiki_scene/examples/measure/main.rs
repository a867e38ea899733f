//! How hair moves, in numbers that an animator sees: does the root lead, do locks part, does it swing as long as hair does?
//!
//!     cargo run --release -p nabiki_scene --example measure -- scenes/gust.toml
//!     cargo run --release -p nabiki_scene --example measure -- scenes/gust.toml --strands 1000
//!     cargo run --release -p nabiki_scene --example measure -- scenes/gust.toml --set free.settle=30
//!     cargo run --release -p nabiki_scene --example measure
//!
//! With a scene: in which frames its hair has come half of its way at three places of the strands, how alike the tips move, how much of
//! the motion is fast, what is inside the head, and how hair comes to rest. A root that leads rises first, and locks that part have tips
//! of low correlation. Without a scene: one strand in a clamp beside a rod and a chain of point masses, which know nothing of the
//! steppers (`reference.rs`).

mod lab;
mod numbers;
mod reference;
mod scene;

use std::path::PathBuf;
use std::process::ExitCode;

use nabiki_scene::Scene;

fn main() -> ExitCode {
    match measure() {
        Ok(()) => ExitCode::SUCCESS,
        Err(refused) => {
            eprintln!("measure: {refused}");
            ExitCode::FAILURE
        }
    }
}

fn measure() -> Result<(), Box<dyn std::error::Error>> {
    let (mut path, mut strands, mut set) = (None, 300, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--strands" => strands = arguments.next().ok_or("--strands needs a number")?.parse()?,
            "--set" => {
                let given = arguments.next().ok_or("--set needs KEY=VALUE")?;
                let (key, value) = given.split_once('=').ok_or("--set needs KEY=VALUE")?;
                set.push((key.to_owned(), value.to_owned()));
            }
            _ => path = Some(PathBuf::from(argument)),
        }
    }
    match path {
        Some(path) => scene::measure(Scene::load(&path, &set)?, strands),
        None => {
            lab::measure();
            Ok(())
        }
    }
}
