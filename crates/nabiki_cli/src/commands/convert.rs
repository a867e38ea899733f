//! `nabiki convert`: from one hair format to another, or a frame out of a cache.

use nabiki::Hair;
use nabiki_io::cache::Reader;
use nabiki_io::hair;

use crate::args::Convert;
use crate::failure::Failure;

pub fn convert(args: &Convert, quiet: bool) -> Result<(), Failure> {
    let hair = read(args)?;
    let losses = hair::write(&args.output, &hair)?;
    if !quiet {
        for loss in losses {
            println!("{} cannot hold {loss}", args.output.display());
        }
        println!("wrote {}: {} strands", args.output.display(), hair.strands.len());
    }
    Ok(())
}

fn read(args: &Convert) -> Result<Hair, Failure> {
    let is_cache = args.input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki"));
    let line = |text: &str| Failure::new(format!("{}: {text}", args.input.display()));
    match (is_cache, args.frame) {
        (true, Some(frame)) => Ok(Reader::open(&args.input)?.hair(frame.into())?),
        (true, None) => Err(line("a motion cache holds many frames; say which with --frame N")),
        (false, None) => Ok(hair::read(&args.input)?),
        (false, Some(frame)) => {
            Err(line(&format!("--frame {frame} is for motion caches; a hair file holds one frame")))
        }
    }
}
