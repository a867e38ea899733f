//! `nabiki info`: what is in a file.

use crate::args::Info;
use crate::failure::Failure;
use crate::say;

pub fn info(args: &Info) -> Result<(), Failure> {
    let info = nabiki_scene::info::info(&args.file)?;
    if args.json {
        let text = serde_json::to_string_pretty(&info).map_err(|e| Failure::new(e.to_string()))?;
        say::answer(text)
    } else {
        say::answer(info)
    }
}
