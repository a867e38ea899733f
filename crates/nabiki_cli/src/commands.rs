//! Each subcommand as the task that it asks for.

use nabiki_scene::tasks::{self, ConvertOptions, NewOptions, RenderOptions, SimulateOptions, SolveOptions};
use nabiki_scene::{Error, Result, Shown};

use crate::args::{Convert, Groom, Info, New, Preview, Render, Run, Simulate, Solve};
use crate::say;
use crate::terminal::Terminal;

pub fn new(args: &New, terminal: &mut Terminal) -> Result<()> {
    let options = NewOptions {
        head: args.head.clone(),
        groups: args.group.clone(),
        hair: args.hair.clone(),
        replace: args.force,
    };
    tasks::new(&args.scene, &options, terminal)
}

pub fn run(args: &Run, terminal: &mut Terminal) -> Result<()> {
    tasks::run(args.scene.load()?, shown(args.strands), &args.out, &args.export.options(), terminal)
}

pub fn preview(args: &Preview, terminal: &mut Terminal) -> Result<()> {
    tasks::preview(args.scene.load()?, args.strands, &args.out, args.cache.as_deref(), terminal)
}

pub fn groom(args: &Groom, terminal: &mut Terminal) -> Result<()> {
    tasks::groom(args.scene.load()?, shown(args.strands), &args.output, terminal)
}

pub fn simulate(args: &Simulate, terminal: &mut Terminal) -> Result<()> {
    let options =
        SimulateOptions { output: args.output.clone(), exports: args.export.options(), twin: args.stepper.into() };
    tasks::simulate(args.scene.load()?, shown(args.strands), &options, terminal)
}

pub fn render(args: &Render, terminal: &mut Terminal) -> Result<()> {
    let options = RenderOptions { motion: args.motion.clone(), frame: args.frame };
    tasks::render(args.scene.load()?, shown(args.strands), &options, &args.out, terminal)
}

pub fn solve(args: &Solve, terminal: &mut Terminal) -> Result<()> {
    let options = SolveOptions { wishes: args.wish.clone(), output: args.output.clone(), strands: args.strands };
    tasks::solve(args.scene.load()?, &options, terminal)
}

pub fn convert(args: &Convert, terminal: &mut Terminal) -> Result<()> {
    let options = ConvertOptions {
        input: args.input.clone(),
        output: args.output.clone(),
        frame: args.frame,
        segments: args.segments,
        unit: args.unit,
        z_up: args.z_up,
        layer: args.export_layer.clone(),
    };
    tasks::convert(&options, terminal)
}

pub fn info(args: &Info) -> Result<()> {
    let info = nabiki_scene::info::info(&args.file)?;
    let text = if args.json {
        serde_json::to_string_pretty(&info).map_err(|e| Error::refused(e.to_string()))?
    } else {
        info.to_string()
    };
    say::answer(text)
}

fn shown(strands: Option<usize>) -> Shown {
    strands.map_or(Shown::All, Shown::First)
}
