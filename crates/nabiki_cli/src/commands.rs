//! Each subcommand as the task that it asks for.

use nabiki_io::screen::is_unsafe;
use nabiki_io::shell;
use nabiki_scene::tasks::{
    self, ConvertOptions, FarmOptions, MovieOptions, NewOptions, PREVIEW_STRANDS, Pictures, RenderOptions,
    ShardOptions, SimulateOptions, SolveOptions,
};
use nabiki_scene::{Error, Result, Shown, schema};
use serde::Serialize;

use crate::args::{
    Convert, Farm, Frames, Groom, Info, Join, Movie, New, Preview, Render, Run, SceneArgs, Schema, Simulate, Solve,
    StepperName,
};
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
    let shown = args.strands.map_or(Shown::AtMost(PREVIEW_STRANDS), Shown::First);
    tasks::preview(args.scene.load()?, shown, &args.out, args.cache.as_deref(), terminal)
}

pub fn groom(args: &Groom, terminal: &mut Terminal) -> Result<()> {
    // Hair at rest has no frames.
    let scene = SceneArgs { scene: args.scene.clone(), frames: None, sets: args.sets.clone() };
    tasks::groom(scene.load()?, shown(args.strands), &args.output, terminal)
}

pub fn simulate(args: &Simulate, terminal: &mut Terminal) -> Result<()> {
    let shard =
        args.shard.map(|shard| Ok::<_, Error>(ShardOptions { shard, command: without_shard(args)? })).transpose()?;
    let options = SimulateOptions {
        output: args.output.clone(),
        exports: args.export.options(),
        twin: args.stepper.into(),
        shard,
    };
    tasks::simulate(args.scene.load()?, shown(args.strands), &options, terminal)
}

/// The command that simulates this scene, up to which shard of it and into which file.
fn without_shard(args: &Simulate) -> Result<String> {
    let SceneArgs { scene, .. } = &args.scene;
    let mut words = vec!["nabiki".to_owned(), "simulate".to_owned(), shell::operand(&scene.to_string_lossy())];
    words.extend(args.strands.into_iter().flat_map(|count| ["--strands".to_owned(), count.to_string()]));
    words.extend(args.scene.as_sets()?.into_iter().flat_map(|set| ["--set".to_owned(), set]));
    if matches!(args.stepper, StepperName::F64) {
        words.extend(["--stepper".to_owned(), "f64".to_owned()]);
    }
    Ok(shell::command(&words))
}

pub fn join(args: &Join, terminal: &mut Terminal) -> Result<()> {
    tasks::join(&args.shards, &args.output, terminal)
}

pub fn render(args: &Render, terminal: &mut Terminal) -> Result<()> {
    if let (Some(Frames::Run(from, through)), Some(pictures)) = (args.frames, args.turntable) {
        let line =
            format!("--turntable {pictures} and --frames {from}..{through}: a turntable shows one frame; give --frame");
        return Err(Error::refused(line));
    }
    let one = |frame| match args.turntable {
        Some(pictures) => Pictures::Turntable { frame, pictures },
        None => Pictures::One(frame),
    };
    let (frames, pictures) = match (args.frames, args.frame.or(args.turntable.map(|_| 0))) {
        (Some(Frames::Run(from, through)), Some(frame)) => {
            let line = format!("--frame {frame} and --frames {from}..{through}: give one of them");
            return Err(Error::refused(line));
        }
        (Some(Frames::Run(from, through)), None) => (None, Pictures::Run(from, through)),
        (Some(Frames::Count(frames)), frame) => (Some(frames), frame.map_or(Pictures::All, one)),
        (None, frame) => (None, frame.map_or(Pictures::All, one)),
    };
    let scene = SceneArgs { scene: args.scene.clone(), frames, sets: args.sets.clone() };
    let options = RenderOptions { motion: args.motion.clone(), pictures };
    tasks::render(scene.load()?, shown(args.strands), &options, &args.out, terminal)
}

pub fn movie(args: &Movie, terminal: &mut Terminal) -> Result<()> {
    let scene = args.scene.as_ref().map(|scene| {
        let scene = SceneArgs { scene: scene.clone(), frames: None, sets: args.sets.clone() };
        scene.load()
    });
    let options = MovieOptions {
        frames: args.frames.clone(),
        output: args.output.clone(),
        scene: scene.transpose()?,
        sets: args.sets.clone(),
        strands: args.strands,
    };
    tasks::movie(&options, terminal)
}

pub fn farm(args: &Farm, terminal: &mut Terminal) -> Result<()> {
    let options = FarmOptions {
        engine: args.engine.into(),
        shards: args.shards,
        frames_a_task: args.frames_a_task,
        strands: args.strands,
        sets: args.scene.as_sets()?,
        output: args.output.clone(),
        results: args.out.clone(),
    };
    tasks::farm(args.scene.load()?, &options, terminal)
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
        first_frame: args.first_frame,
        chains: args.chains.options(),
    };
    tasks::convert(&options, terminal)
}

pub fn info(args: &Info) -> Result<()> {
    let info = nabiki_scene::info::info(&args.file)?;
    let text = if args.json { json(&info)? } else { info.to_string() };
    say::answer(text)?;
    // What is wrong with a scene comes after all that is known of it.
    info.problem().map_or(Ok(()), |problem| Err(Error::refused(problem)))
}

pub fn schema(args: &Schema) -> Result<()> {
    say::answer(if args.json { json(&schema::json())? } else { schema::text() })
}

/// Of what a terminal obeys JSON itself escapes only a part. All of it can stand in strings alone.
fn json(answer: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string_pretty(answer).map_err(|e| Error::refused(e.to_string()))?;
    let escaped = |c: char| match c {
        '\n' => "\n".to_owned(),
        c if is_unsafe(c) => format!("\\u{:04x}", u32::from(c)),
        c => c.to_string(),
    };
    Ok(text.chars().map(escaped).collect())
}

fn shown(strands: Option<usize>) -> Shown {
    strands.map_or(Shown::All, Shown::First)
}
