//! `nabiki simulate`: the motion of a scene's hair, into a cache.

use nabiki::dynamics::Stepper;
use nabiki_io::cache::{Header, Writer};

use crate::args::{Simulate, StepperName};
use crate::export::Exports;
use crate::failure::Failure;
use crate::opening::open;
use crate::place;
use crate::progress;
use crate::report::Report;

pub fn simulate(args: &Simulate, quiet: bool) -> Result<(), Failure> {
    place::file(&args.output)?;
    let take = open(&args.scene, args.strands)?;
    let mut exports = Exports::begin(&args.export, &[&args.output], &take)?;
    let report = Report::new(&take, quiet);
    report.scene();
    report.swing();
    let mut stepper: Box<dyn Stepper> = match args.stepper {
        StepperName::Fast => Box::new(take.simulation()?),
        StepperName::F64 => Box::new(take.reference()?),
    };
    let frame_rate = take.stage.scene.motion.frame_rate;
    let mut header = Header::new(take.stage.identity()?, frame_rate, &take.stage.hair);
    header.origin = take.stage.hair_origin();
    let mut cache = Writer::create(&args.output, &header)?;
    let bar = progress::bar(u64::from(take.stage.scene.motion.frames) + 1, "simulating", quiet);
    cache.push(&take.pose(0), stepper.strands().points())?;
    exports.frame(0, stepper.strands(), &take.pose(0))?;
    bar.inc(1);
    for frame in 1..=take.stage.scene.motion.frames {
        stepper.step_frame_under(take.force_in_head(frame));
        cache.push(&take.pose(frame), stepper.strands().points())?;
        exports.frame(frame, stepper.strands(), &take.pose(frame))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    cache.finish()?;
    report.inside(stepper.strands());
    let mut written = vec![args.output.clone()];
    written.extend(exports.finish()?);
    report.written(&written);
    Ok(())
}
