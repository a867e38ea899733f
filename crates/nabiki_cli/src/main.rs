//! The command `nabiki`.

mod args;
mod commands;
mod export;
mod failure;
mod film;
mod opening;
mod place;
mod progress;
mod reel;
mod report;
mod say;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use failure::Failure;

fn main() -> ExitCode {
    let cli = Cli::parse();
    match run(&cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("nabiki: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(cli: &Cli) -> Result<(), Failure> {
    if let Some(threads) = cli.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
            .map_err(|e| Failure::new(format!("--threads {threads}: {e}")))?;
    }
    match &cli.command {
        Command::New(args) => commands::new::new(args, cli.quiet),
        Command::Run(args) => commands::run::run(args, cli.quiet),
        Command::Preview(args) => commands::preview::preview(args, cli.quiet),
        Command::Groom(args) => commands::groom::groom(args, cli.quiet),
        Command::Simulate(args) => commands::simulate::simulate(args, cli.quiet),
        Command::Render(args) => commands::render::render(args, cli.quiet),
        Command::Convert(args) => commands::convert::convert(args, cli.quiet),
        Command::Info(args) => commands::info::info(args),
    }
}
