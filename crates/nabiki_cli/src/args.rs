//! What may be written after `nabiki`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Arg, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use nabiki::dynamics::Motion;
use nabiki_io::Unit;
use nabiki_io::cache::Shard;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::farm::Engine;
use nabiki_scene::tasks::{Pictures, Twin};
use nabiki_scene::{Result, threads};

/// Hair in the wind: groom it, blow on it, draw it.
#[derive(Parser)]
#[command(
    name = "nabiki",
    version,
    arg_required_else_help = true,
    after_help = "\
Start with:
  nabiki preview scenes/gust.toml                     300 strands: what will the wind do?
  nabiki preview scenes/gust.toml --set 'force.0.vector=[-200,20,0]'
  nabiki run scenes/gust.toml                         the whole movie

A scene is a TOML file. Its tables: head, hair; motion, free, contact, body, neighbours, pseudo_force, disturbance;
force, wind, gust, body_wind, flow, turbulence, point, vortex, fan; picture, output. The files in scenes/ are commented.
Exit codes: 0 done, 1 refused or failed (one line says why), 2 the command line makes no sense; a signal ends it
as it ends others (130 to a shell for Ctrl-C), and what nohup ignores it ignores."
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// No progress bars and no report, only errors
    #[arg(long, short, global = true)]
    pub quiet: bool,

    /// Threads to work with, 512 at the most (default: all cores); the result is the same with any
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=i64::from(threads::MOST)))]
    pub threads: Option<u16>,
}

#[derive(Subcommand)]
pub enum Command {
    /// Write a scene to begin with, about a head and hair of your own or the built-in ones
    New(New),
    /// Groom, simulate and draw a scene: a movie and a contact sheet
    Run(Run),
    /// The same at once, with a few strands that move exactly as they will in the whole
    ///
    /// Before any step it prints how many frames a swing takes under each force of the field, which is how to choose a force by
    /// thinking. In the paper's form it does so for the root, the middle and the tip of a strand: T = 2 pi / acos(1 - c |F| / 2) frames,
    /// about 2 pi / sqrt(c |F|); four times the force halves the time. In the free form it does so for the strand as a whole, which force,
    /// weight, hold and stiffness bring back.
    ///
    /// Pictures are small: of the same shape, 480 pixels on the longer side at the most. 960 x 540 become 480 x 270.
    ///
    /// The motion is the final's, to the bit; the light is a draft. Each strand is drawn thicker and takes the light of many that it
    /// stands for, in cells of 0.8 to 1.5 cm where the final has 0.05 and 0.55, and skin shares hair's shadow between 2 x 2 pixels.
    /// docs/performance.md shows both.
    Preview(Preview),
    /// Grow or import the hair of a scene and write it at rest, into a hair file
    Groom(Groom),
    /// Move the hair of a scene and write every frame into a motion cache
    Simulate(Simulate),
    /// Put the shards of a motion, simulated apart, together into the cache of the whole
    ///
    /// The file is, byte for byte, the one that `nabiki simulate` writes without --shard. A shard that is missing is named with
    /// the command that makes it.
    Join(Join),
    /// Draw a scene, moved by its own simulation or by a motion cache
    Render(Render),
    /// Make a movie of numbered PNG files
    ///
    /// Of PNG files of 16 bits (output.png_bits=16) it is, byte for byte, the movie that `nabiki run` makes of the same scene.
    Movie(Movie),
    /// Write a scene as a job for a render farm: shards, join, frames, movie
    ///
    /// docs/farm.md says how to run it, and what it takes.
    Farm(Farm),
    /// Find the wind that makes the hair do what a wish file asks for, and write the scene with it
    ///
    /// A wish file is TOML: what may change (`[unknowns]` with vectors, borders, interval, gust, stiffness, settle), where
    /// locks should be (`[[wish]]` with frame, strands or near, and moved, mean_moved, mean_at or places) and what should
    /// stay (`[[nail]]` with frames). It prints how far the hair is from the wishes before and after, and the new numbers; a
    /// wish that no motion meets ends with the nearest one, and with the distance left. scenes/wishes/ has commented
    /// examples, docs/solve.md the rest.
    Solve(Solve),
    /// Turn a hair file, or a motion cache or a frame of it, into another format
    Convert(Convert),
    /// Say what is in a scene, hair file, motion cache, mesh or motion of a head
    Info(Info),
    /// List every setting that a scene may have, with its unit, range, default and help
    ///
    /// With --json it prints a JSON Schema, by which editors complete and check scene files: `nabiki schema --json > scene.schema.json`,
    /// and as the first line of a scene `#:schema scene.schema.json`. Units are in `x-unit`, what is taken where a setting is left out in
    /// `x-open`.
    Schema(Schema),
}

/// A scene, and changes to it for a quick try.
#[derive(Args)]
pub struct SceneArgs {
    /// The scene (TOML)
    pub scene: PathBuf,

    /// Frames to simulate, in place of motion.frames; the contact sheet goes without those it does not reach
    #[arg(long, value_name = "N", value_parser = frames)]
    pub frames: Option<u32>,

    /// Any setting of the scene in TOML, as often as wanted: motion.time_step=0.05, or in quotes force.0.vector=[0,-100,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

#[derive(Args)]
pub struct New {
    /// The scene to write (TOML)
    pub scene: PathBuf,

    /// Mesh of the head: .obj, .glb, .gltf, .ply, .tfxmesh, .usd, .usda, .usdc or .abc (default: the built-in bust)
    #[arg(long, value_name = "FILE")]
    pub head: Option<PathBuf>,

    /// Group, object or node of the head's file to keep, as often as wanted (default: all)
    #[arg(long, value_name = "NAME", requires = "head")]
    pub group: Vec<String>,

    /// Hair to import: .hair, .tfx, .obj, .usd, .usda, .usdc or .abc (default: hair is grown)
    #[arg(long, value_name = "FILE")]
    pub hair: Option<PathBuf>,

    /// Replace a file that is there already
    #[arg(long)]
    pub force: bool,
}

#[derive(Args)]
pub struct Run {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Strands to show of the scene's, chosen evenly over the scalp; they move as they do in the whole (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// Folder for the pictures, made if it is not there
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
    /// Write the moving hair for other tools: .usdc, .usd, .usda (text) or .abc, as often as wanted
    #[arg(long, value_name = "FILE")]
    pub export: Vec<PathBuf>,

    /// Write samples alone, to be laid over the groom at this prim path of the USD stage that the hair came from, like
    /// /character/hair; `nabiki info` on the groom's file lists them
    #[arg(long, value_name = "PRIM", value_parser = prim_path)]
    pub export_layer: Option<String>,

    /// Put the head into files that would be without it: the built-in bust, and any head in .abc files, which Unreal then takes for a
    /// mesh and not for a groom
    #[arg(long)]
    pub export_head: bool,
}

impl ExportArgs {
    pub fn options(&self) -> ExportOptions {
        ExportOptions { files: self.export.clone(), layer: self.export_layer.clone(), head: self.export_head }
    }
}

#[derive(Args)]
pub struct Preview {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Strands to show, chosen evenly over the scalp from all of the scene's (default: 300, or all where it has fewer)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// Write their motion into a cache (.nabiki), too
    #[arg(long, value_name = "FILE")]
    pub cache: Option<PathBuf>,

    /// Folder for the pictures, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

#[derive(Args)]
pub struct Groom {
    /// The scene (TOML)
    pub scene: PathBuf,

    /// Any setting of the scene in TOML, as often as wanted: hair.strands=5000, or in quotes hair.origin=[0,1.6,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,

    /// Strands to show of the scene's, chosen evenly over the scalp; they move as they do in the whole (default: all)
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

    /// Strands to show of the scene's, chosen evenly over the scalp; they move as they do in the whole (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The motion cache to write (.nabiki), or moving hair for other tools (.usdc, .usd, .usda, .abc)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,

    /// Which of the twins steps
    #[arg(long, value_enum, default_value_t = StepperName::Fast)]
    pub stepper: StepperName,

    /// One of N shards of the strands alone, 1/N to N/N, for `nabiki join`; each may be made on another machine
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,

    #[command(flatten)]
    pub export: ExportArgs,
}

#[derive(Args)]
pub struct Join {
    /// The shards (.nabiki), all of them, in any order
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

    /// The scene that they show: it says how many there must be, the frame rate and the quality
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,

    /// Any setting of the scene in TOML, as often as wanted
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "scene")]
    pub sets: Vec<String>,

    /// Strands of the scene's that they show, as they were drawn with: said again with the command for a missing frame
    #[arg(long, value_name = "N", requires = "scene", value_parser = positive::<usize>)]
    pub strands: Option<usize>,
}

#[derive(Args)]
pub struct Farm {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Strands to show of the scene's, chosen evenly over the scalp; they move as they do in the whole (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The engine that runs the job
    #[arg(long, value_enum)]
    pub engine: EngineName,

    /// Shards to simulate apart (default: as many as hold 100,000 strands each)
    #[arg(long, value_name = "N", value_parser = positive::<u32>)]
    pub shards: Option<u32>,

    /// Frames that one task draws
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = positive::<u32>)]
    pub frames_a_task: u32,

    /// The job to write: a template (.yaml) for openjd, a script (.sh) for slurm
    #[arg(long, short, value_name = "JOB")]
    pub output: PathBuf,

    /// Folder for the results, made by the job (default: beside the job, under the scene's name)
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The engines of farms.
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
    /// f32, sixteen strands at a time, all cores
    Fast,
    /// The specification: one segment at a time in f64
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

    /// Frames to simulate and draw, in place of motion.frames; or A..B, the frames from A through B alone, as numbered stills
    #[arg(long, value_name = "N|A..B", allow_hyphen_values = true)]
    pub frames: Option<Frames>,

    /// Any setting of the scene in TOML, as often as wanted: motion.time_step=0.05, or in quotes force.0.vector=[0,-100,0]
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,

    /// Strands to show of the scene's, chosen evenly over the scalp; they move as they do in the whole (default: all)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub strands: Option<usize>,

    /// The motion cache to draw, written from the same scene by `simulate`; without it the scene is simulated
    #[arg(long, value_name = "FILE")]
    pub motion: Option<PathBuf>,

    /// Draw this frame only, as a PNG, and as OpenEXR with output.exr_frames = true
    #[arg(long, value_name = "N", value_parser = frame)]
    pub frame: Option<u32>,

    /// Draw one frame (--frame, or else the first) from all around: a movie of N pictures, once round the head, or files
    /// (output.movie = false, output.png_frames = true)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=i64::from(Pictures::MOST_PICTURES)))]
    pub turntable: Option<u32>,

    /// Folder for the pictures, made if it is not there
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
        let way_out = "write one whole number, or two as in 10..19 for the frames from 10 through 19";
        found.ok_or_else(|| format!("{way_out}; {most} at the most"))
    }
}

#[derive(Args)]
pub struct Solve {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// The wish file (TOML)
    #[arg(long, value_name = "FILE")]
    pub wish: PathBuf,

    /// The scene to write (TOML): this one with the numbers found and what --set and --frames say, its comments and layout
    /// as they are
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,

    /// Strands among which locks near a point are looked for, chosen evenly over the scalp
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = positive::<usize>)]
    pub strands: usize,
}

#[derive(Args)]
pub struct Convert {
    /// A hair file (.hair, .tfx, .obj, .usd, .usda, .usdc, .abc) or a motion cache (.nabiki)
    pub input: PathBuf,

    /// The file to write: .hair, .tfx, .usd, .usda, .usdc or .abc; a whole motion cache goes into one of the last four.
    /// Imported hair comes out of a cache in the unit, axes and place of the file it came from
    pub output: PathBuf,

    /// Frame to take out of a motion cache, a USD layer or an Alembic archive, counted from 0: of frames 1001 to 1005 `--frame 2` is
    /// 1003, a number that it keeps where the file that is written has a time line (USD, Alembic)
    #[arg(long, value_name = "N", value_parser = frame)]
    pub frame: Option<u32>,

    /// Segments into which every strand is walked (default: as the file has them)
    #[arg(long, value_name = "N", value_parser = positive::<usize>)]
    pub segments: Option<usize>,

    /// Unit of the input, for a USD layer to name, as other files cannot: mm, cm, dm, m, in, ft or a number of centimetres
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,

    /// Whether z is up in the input, for a USD layer to name
    #[arg(long)]
    pub z_up: bool,

    /// Write samples of a motion cache alone, to be laid over the groom at this prim path of the USD stage that the
    /// hair came from, like /character/hair; `nabiki info` on the groom's file lists them
    #[arg(long, value_name = "PRIM", conflicts_with = "frame", value_parser = prim_path)]
    pub export_layer: Option<String>,

    /// Number of the first frame on the time line of the file that is written, with --frame of the only one (default: as a USD layer,
    /// an Alembic archive or the cache has it; see output.first_frame)
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub first_frame: Option<i32>,
}

#[derive(Args)]
pub struct Info {
    /// A scene, hair file, motion cache, mesh or motion of a head
    pub file: PathBuf,

    /// Write JSON, for programs to read
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Schema {
    /// Write a JSON Schema, for editors and programs to read
    #[arg(long)]
    pub json: bool,
}

/// What no prim path is is refused with what one looks like.
fn prim_path(text: &str) -> Result<String, String> {
    if text.starts_with('/') {
        return Ok(text.to_owned());
    }
    Err("give the path of the groom's curves in its USD stage, like /character/hair; nabiki info on the groom's file lists \
         them"
        .into())
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
