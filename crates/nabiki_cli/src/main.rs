//! The command `nabiki`: arguments in, lines out. What it does is done by `nabiki_scene`.

mod args;
mod commands;
mod ending;
mod say;
mod scene_args;
mod terminal;

use std::process::ExitCode;

use nabiki_scene::Result;

use args::{Cli, Command};
use terminal::Terminal;

fn main() -> ExitCode {
    let cli = Cli::read();
    ending::remove_parts_on_signals();
    match run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say::failure(error);
            ExitCode::FAILURE
        }
    }
}

fn run(cli: &Cli) -> Result<()> {
    cli.use_threads()?;
    let mut terminal = Terminal::new(cli.quiet);
    match &cli.command {
        Command::New(args) => commands::new(args, &mut terminal),
        Command::Run(args) => commands::run(args, &mut terminal),
        Command::Preview(args) => commands::preview(args, &mut terminal),
        Command::Groom(args) => commands::groom(args, &mut terminal),
        Command::Simulate(args) => commands::simulate(args, &mut terminal),
        Command::Join(args) => commands::join(args, &mut terminal),
        Command::Render(args) => commands::render(args, &mut terminal),
        Command::Movie(args) => commands::movie(args, &mut terminal),
        Command::Farm(args) => commands::farm(args, &mut terminal),
        Command::Solve(args) => commands::solve(args, &mut terminal),
        Command::Convert(args) => commands::convert(args, &mut terminal),
        Command::Info(args) => commands::info(args),
        Command::Schema(args) => commands::schema(args),
    }
}
