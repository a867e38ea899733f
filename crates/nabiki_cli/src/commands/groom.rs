//! `nabiki groom`: the hair of a scene, at rest.

use crate::args::Groom;
use crate::failure::Failure;
use crate::opening::open;
use crate::place;
use crate::report::Report;

pub fn groom(args: &Groom, quiet: bool) -> Result<(), Failure> {
    place::file(&args.output)?;
    let take = open(&args.scene, args.strands)?;
    let report = Report::new(&take, quiet);
    report.scene();
    report.losses(&nabiki_io::hair::write(&args.output, &take.stage.hair)?);
    report.written(std::slice::from_ref(&args.output));
    Ok(())
}
