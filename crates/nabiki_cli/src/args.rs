//! What may be written after `nabiki`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Arg, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use nabiki::dynamics::Motion;
use nabiki_io::Unit;
use nabiki_io::cache::Shard;
use nabiki_io::moving::ChainOptions;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::farm::Engine;
use nabiki_scene::tasks::{Pictures, Twin};
use nabiki_scene::{Result, threads};

/// Simulate and render hair: groom it, blow wind through it, draw it
#[derive(Parser)]
#[command(
    name = "nabiki",
    version,
    arg_required_else_help = true,
    after_help = "\
Start with:
  nabiki preview scenes/gust.toml                     300 strands: a quick look at the wind
  nabiki preview scenes/gust.toml --set \"force.1.vector=[-600,120,80]\"
  nabiki run scenes/gust.toml                         the full movie

A scene is a TOML file. Its tables: head, hair; motion, free, contact, body, aim, neighbours, pseudo_force,
disturbance; force, wind, gust, body_wind, flow, turbulence, point, vortex, fan; picture, output. The files in scenes/ have comments.
Exit codes: 0 success, 1 error (one line gives the reason), 2 wrong command line. Signals act as usual: 130 in a
shell for Ctrl-C; signals that nohup ignores stay ignored."
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// Print only errors: no progress bars, no report
    #[arg(long, short, global = true)]
    pub quiet: bool,

    /// Number of threads, at most 512 (default: all cores). The result does not depend on it
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(threads::MOST)))]
    pub threads: Option<u16>,
}

#[derive(Subcommand)]
pub enum Command {
    /// Write a new scene, with your own head and hair or the built-in ones
    New(New),
    /// Groom, simulate and render a scene: a movie and a contact sheet
    Run(Run),
    /// The same quickly, with a few strands that move exactly as they do in the final
    ///
    /// Before simulating, it prints how many frames a swing takes under each force of the field, to help you choose forces. In the
    /// paper's form it prints them for the root, the middle and the tip of a strand: T = 2 pi / acos(1 - c |F| / 2) frames,
    /// about 2 pi / sqrt(c |F|), so four times the force halves the time. In the free form it prints one number for the strand,
    /// which force, weight, hold and stiffness bring back.
    ///
    /// Pictures keep their shape, with at most 480 pixels on the longer side: 960 x 540 becomes 480 x 270.
    ///
    /// The motion of these strands is bit-identical to the final's. The lighting is a draft: each strand is drawn thicker, for the
    /// many that it represents. Light uses cells of 0.8 to 1.5 cm (the final: 0.05 and 0.55), and skin computes the shadow of hair
    /// once per 2 x 2 pixels. docs/performance.md shows both.
    Preview(Preview),
    /// Grow or import the hair of a scene and write it at rest to a hair file
    Groom(Groom),
    /// Simulate the hair of a scene and write each frame to a motion cache
    Simulate(Simulate),
    /// Join the shards of a motion into one cache
    ///
    /// The file is byte-identical to the one that `nabiki simulate` writes without --shard. If a shard is missing, the error names it
    /// and the command that makes it.
    Join(Join),
    /// Render a scene, with its own simulation or a motion cache
    Render(Render),
    /// Make a movie from numbered PNG files
    ///
    /// With 16-bit PNG files (output.png_bits=16), the movie is byte-identical to the one from `nabiki run`.
    Movie(Movie),
    /// Write a scene as a job for a render farm: shards, join, frames, movie
    ///
    /// docs/farm.md explains how to run it and what it needs.
    Farm(Farm),
    /// Find the wind that makes the hair do what a wish file asks for, and write the scene with it
    ///
    /// A wish file is TOML. `[unknowns]` lists what may change: vectors, borders, interval, gust, stiffness, settle. Each `[[wish]]`
    /// says where locks should be: frame, strands or near, and moved, mean_moved, mean_at or places. Each `[[nail]]` lists frames
    /// that should stay as they are.
    ///
    /// It prints how far the hair is from the wishes before and after, and the new numbers. If no motion meets a wish, it gives the
    /// nearest one and the remaining distance. scenes/wishes/ has commented examples; docs/solve.md explains everything else.
    Solve(Solve),
    /// Convert a hair file, a motion cache or one frame of it to another format
    Convert(Convert),
    /// Print what a scene, hair file, motion cache, mesh or head motion contains
    Info(Info),
    /// List all settings of a scene, with unit, range, default and help
    ///
    /// With --json it prints a JSON Schema, which lets editors complete and check scene files. Run
    /// `nabiki schema --json > scene.schema.json` and make `#:schema scene.schema.json` the first line of a scene. `x-unit` holds the
    /// unit, `x-open` what applies if you leave out a setting.
    Schema(Schema),
}

/// A scene, and changes to it for one run.
#[derive(Args)]
pub struct SceneArgs {
    /// The scene (TOML)
    pub scene: PathBuf,

    /// Number of frames to simulate, instead of motion.frames; the contact sheet leaves out later frames
    #[arg(long, value_name = "N", value_parser = frames)]
    pub frames: Option<u32>,

    /// Set any setting of the scene, in TOML; repeatable: motion.time_step=0.05, or in quotes force.0.vector=[0,-100,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

#[derive(Args)]
pub struct New {
    /// The scene to write (TOML)
    pub scene: PathBuf,

    /// Mesh of the head: .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, .usd, .usda, .usdc or .abc (default: the built-in bust)
    #[arg(long, value_name = "FILE")]
    pub head: Option<PathBuf>,

    /// Group, object or node of the head's file to use; repeatable (default: all)
    #[arg(long, value_name = "NAME", requires = "head")]
    pub group: Vec<String>,

    /// Hair to import: .hair, .tfx, .obj, .usd, .usda, .usdc or .abc (default: grown hair)
    #[arg(long, value_name = "FILE")]
    pub hair: Option<PathBuf>,

    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
}

#[derive(Args)]
pub struct Run {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Number of strands to use, spread evenly over the scalp; they move as they do among all (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// Folder for the pictures, created if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,

    #[command(flatten)]
    pub export: ExportArgs,
}

impl Cli {
    /// What the command line says. A number below 0 is refused by the option that it is given to, with its range, and not taken
    /// for an option itself.
    pub fn read() -> Self {
        let numbers = |arg: Arg| if arg.get_action().takes_values() { arg.allow_negative_numbers(true) } else { arg };
        let command = Self::command().mut_args(numbers).mut_subcommands(|command| command.mut_args(numbers));
        let read = command.try_get_matches().and_then(|matches| Self::from_arg_matches(&matches));
        read.unwrap_or_else(|refused| crate::say::misuse(&refused))
    }

    /// Makes the threads that were asked for, or one a core. Made where they are first wanted, those that the system does not give would
    /// end the program.
    pub fn use_threads(&self) -> Result<()> {
        threads::made(self.threads, "give fewer with --threads N", rayon::ThreadPoolBuilder::build_global)
    }
}

/// Moving hair for other tools.
#[derive(Args)]
pub struct ExportArgs {
    /// Write the moving hair for other tools; repeatable: .usdc, .usd, .usda (text) or .abc; .glb, chains of joints with skinned
    /// hair for games; .exr, a vertex-animation texture with its mesh; .pc2 or .mdd, point caches
    #[arg(long, value_name = "FILE")]
    pub export: Vec<PathBuf>,

    /// Write only samples, as a layer over the groom at this prim path of the USD stage that the hair came from, such as
    /// /character/hair; `nabiki info` on the groom's file lists the paths
    #[arg(long, value_name = "PRIM", value_parser = prim_path)]
    pub export_layer: Option<String>,

    /// Add the head to files that otherwise omit it: the built-in bust, and any head in .abc files. Unreal then reads such an .abc as
    /// a mesh instead of a groom
    #[arg(long)]
    pub export_head: bool,

    /// In a .glb: add VRM's spring bones (VRMC_springBone) with the scene's hold, weight and settling, for games that move the
    /// hair themselves
    #[arg(long)]
    pub export_springs: bool,

    #[command(flatten)]
    pub chains: ChainArgs,
}

/// Chains of joints in a .glb.
#[derive(Args)]
pub struct ChainArgs {
    /// In a .glb: number of chains of joints, and of joints in each
    #[arg(long, value_name = "CHAINSxJOINTS", default_value = "64x8", value_parser = chains)]
    pub export_chains: (u32, u32),

    /// In a .glb, or with an .exr: width of the ribbon that each strand is drawn as; 0 draws lines, which few engines bind to joints
    #[arg(long, value_name = "CM", default_value_t = 0.4)]
    pub export_cards: f32,
}

impl ChainArgs {
    pub fn options(&self) -> ChainOptions {
        let (chains, joints) = self.export_chains;
        ChainOptions { chains, joints, cards: self.export_cards, springs: None }
    }
}

impl ExportArgs {
    pub fn options(&self) -> ExportOptions {
        let (files, layer) = (self.export.clone(), self.export_layer.clone());
        let (head, chains, springs) = (self.export_head, self.chains.options(), self.export_springs);
        ExportOptions { files, layer, head, chains, springs }
    }
}

#[derive(Args)]
pub struct Preview {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Number of strands to use, spread evenly over the scalp (default: 300, or all if there are fewer)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// Also write their motion to a cache (.nabiki)
    #[arg(long, value_name = "FILE")]
    pub cache: Option<PathBuf>,

    /// Folder for the pictures, created if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

#[derive(Args)]
pub struct Groom {
    /// The scene (TOML)
    pub scene: PathBuf,

    /// Set any setting of the scene, in TOML; repeatable: hair.strands=5000, or in quotes hair.origin=[0,1.6,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,

    /// Number of strands to use, spread evenly over the scalp; they move as they do among all (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The hair file to write: .hair, .tfx, .usd, .usda, .usdc or .abc
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Simulate {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Number of strands to use, spread evenly over the scalp; they move as they do among all (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The motion cache to write (.nabiki), or moving hair for other tools (.usdc, .usd, .usda, .abc, .glb, .exr,
    /// .pc2, .mdd)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,

    /// Which implementation of the step to use
    #[arg(long, value_enum, default_value_t = StepperName::Fast)]
    pub stepper: StepperName,

    /// Simulate only shard K of N of the strands, for `nabiki join`; each shard may run on another machine
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,

    #[command(flatten)]
    pub export: ExportArgs,
}

#[derive(Args)]
pub struct Join {
    /// All shards (.nabiki), in any order
    #[arg(required = true)]
    pub shards: Vec<PathBuf>,

    /// The motion cache to write (.nabiki)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct Movie {
    /// Numbered PNG files (0007.png, gust_0007.png), or folders of them
    #[arg(required = true)]
    pub frames: Vec<PathBuf>,

    /// The movie to write (.mp4)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,

    /// The scene that they show: it sets the number of frames, the frame rate and the quality
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,

    /// Set any setting of the scene, in TOML; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "scene")]
    pub sets: Vec<String>,

    /// The --strands they were rendered with, for the command that nabiki prints if a frame is missing
    #[arg(long, value_name = "N", requires = "scene", value_parser = positive::<usize>)]
    pub strands: Option<usize>,
}

#[derive(Args)]
pub struct Farm {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Number of strands to use, spread evenly over the scalp; they move as they do among all (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// Farm system that runs the job
    #[arg(long, value_enum)]
    pub engine: EngineName,

    /// Number of shards to simulate (default: one per 100,000 strands)
    #[arg(long, value_name = "N", value_parser = positive::<u32>)]
    pub shards: Option<u32>,

    /// Frames that one task renders
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = positive::<u32>)]
    pub frames_a_task: u32,

    /// The job to write: a template (.yaml) for openjd, a script (.sh) for slurm
    #[arg(long, short, value_name = "JOB")]
    pub output: PathBuf,

    /// Folder for the results, created by the job (default: next to the job, named after the scene)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The systems that run farm jobs.
#[derive(Clone, Copy, ValueEnum)]
pub enum EngineName {
    /// Open Job Description, jobtemplate-2023-09: AWS Deadline Cloud and others
    Openjd,
    /// Slurm
    Slurm,
}

impl From<EngineName> for Engine {
    fn from(name: EngineName) -> Self {
        match name {
            EngineName::Openjd => Self::OpenJd,
            EngineName::Slurm => Self::Slurm,
        }
    }
}

/// The twins.
#[derive(Clone, Copy, ValueEnum)]
pub enum StepperName {
    /// f32, 16 strands at a time, all cores
    Fast,
    /// The reference: one segment at a time, in f64
    F64,
}

impl From<StepperName> for Twin {
    fn from(name: StepperName) -> Self {
        match name {
            StepperName::Fast => Self::Fast,
            StepperName::F64 => Self::Reference,
        }
    }
}

#[derive(Args)]
pub struct Render {
    /// The scene (TOML)
    pub scene: PathBuf,

    /// Number of frames to simulate and render, instead of motion.frames; or A..B to render only frames A to B, as numbered stills
    #[arg(long, value_name = "N|A..B", allow_hyphen_values = true)]
    pub frames: Option<Frames>,

    /// Set any setting of the scene, in TOML; repeatable: motion.time_step=0.05, or in quotes force.0.vector=[0,-100,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,

    /// Number of strands to use, spread evenly over the scalp; they move as they do among all (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The motion cache to render, written from the same scene by `simulate` (default: simulate the scene)
    #[arg(long, value_name = "FILE")]
    pub motion: Option<PathBuf>,

    /// Render only this frame, as a PNG, and as OpenEXR with output.exr_frames = true
    #[arg(long, value_name = "N", value_parser = frame)]
    pub frame: Option<u32>,

    /// Render one frame (--frame, or else the first) from all sides: a movie of N pictures once around the head, or files (with
    /// output.movie = false, output.png_frames = true)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=i64::from(Pictures::MOST_PICTURES)))]
    pub turntable: Option<u32>,

    /// Folder for the pictures, created if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// How many frames a scene has, or which of them are drawn.
#[derive(Clone, Copy)]
pub enum Frames {
    /// So many.
    Count(u32),
    /// From the first through the second.
    Run(u32, u32),
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = match text.split_once("..") {
            Some((from, through)) => from.parse().ok().zip(through.parse().ok()).map(|(a, b)| Self::Run(a, b)),
            None => text.parse().ok().map(Self::Count),
        };
        let most = Motion::MOST_FRAMES;
        let way_out = "write one whole number, or two as in 10..19 for the frames from 10 to 19";
        found.ok_or_else(|| format!("{way_out}; at most {most}"))
    }
}

#[derive(Args)]
pub struct Solve {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// The wish file (TOML)
    #[arg(long, value_name = "FILE")]
    pub wish: PathBuf,

    /// The scene to write (TOML): this one with the new numbers and the changes of --set and --frames; comments and layout are kept
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,

    /// Number of strands to search for locks near a point, spread evenly over the scalp
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = positive::<usize>)]
    pub strands: usize,
}

#[derive(Args)]
pub struct Convert {
    /// A hair file (.hair, .tfx, .obj, .usd, .usda, .usdc, .abc) or a motion cache (.nabiki)
    pub input: PathBuf,

    /// The file to write: .hair, .tfx, .usd, .usda, .usdc or .abc; or, for all frames of a motion, .glb, .exr, .pc2 or .mdd. A full motion
    /// cache needs one that holds motion, so neither of the first two. Imported hair in a
    /// cache is written in the unit, axes and place of its original file
    pub output: PathBuf,

    /// Frame to take from a motion cache, a USD layer or an Alembic archive, counted from 0: of frames 1001 to 1005, `--frame 2`
    /// takes 1003. A file with a time line (USD, Alembic) keeps that number
    #[arg(long, value_name = "N", value_parser = frame)]
    pub frame: Option<u32>,

    /// Resample each strand to this number of segments (default: as in the file)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub segments: Option<usize>,

    /// Unit of the input, to be named in a USD layer (other files cannot): mm, cm, dm, m, in, ft or a number of centimetres
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,

    /// z is up in the input, to be named in a USD layer
    #[arg(long)]
    pub z_up: bool,

    /// Write only the samples of a motion cache, as a layer over the groom at this prim path of the USD stage that the hair came from,
    /// such as /character/hair; `nabiki info` on the groom's file lists the paths
    #[arg(long, value_name = "PRIM", conflicts_with = "frame", value_parser = prim_path)]
    pub export_layer: Option<String>,

    /// Number of the first frame, or of the one that --frame takes, on the time line of the written file (default: from the USD layer,
    /// Alembic archive or cache; see output.first_frame)
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub first_frame: Option<i32>,

    #[command(flatten)]
    pub chains: ChainArgs,
}

#[derive(Args)]
pub struct Info {
    /// A scene, hair file, motion cache, mesh or head motion
    pub file: PathBuf,

    /// Print JSON, for programs
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Schema {
    /// Print a JSON Schema, for editors and programs
    #[arg(long)]
    pub json: bool,
}

/// What no prim path is is refused with what one looks like.
fn prim_path(text: &str) -> Result<String, String> {
    if text.starts_with('/') {
        return Ok(text.to_owned());
    }
    Err("give the path of the groom's curves in its USD stage, such as /character/hair; nabiki info on the groom's file \
         lists them"
        .into())
}

/// `64x8`: chains, and joints in each.
fn chains(text: &str) -> Result<(u32, u32), String> {
    let both = text.split_once('x').and_then(|(chains, joints)| Some((chains.parse().ok()?, joints.parse().ok()?)));
    both.ok_or_else(|| "give the number of chains and of joints in each, such as 64x8".to_owned())
}

fn positive<N: FromStr + From<bool> + PartialOrd>(text: &str) -> Result<N, String> {
    match text.parse() {
        Ok(n) if n >= N::from(true) => Ok(n),
        _ => Err("must be a whole number of at least 1".into()),
    }
}

/// The number of a frame; which there are is known later.
fn frame(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("must be a whole number, 0 to {}", Motion::MOST_FRAMES))
}

/// A number of frames; the scene's own check refuses one that it cannot have.
fn frames(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("must be a whole number, 1 to {}", Motion::MOST_FRAMES))
}
