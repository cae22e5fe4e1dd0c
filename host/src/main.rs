//! The command line: `handstand help` lists the commands, each one's file under `cli/` is its
//! manual.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = cli::Cli::typed();
    let console = cli.console();
    match std::panic::catch_unwind(|| cli.run(&console)) {
        Ok(Ok(outcome)) => ExitCode::from(outcome.exit_code()),
        Ok(Err(error)) => {
            let code = error.exit_code();
            console.error(error);
            ExitCode::from(code)
        }
        Err(_) => {
            eprintln!(
                "handstand: this is a bug in the program, not in your files; please report it"
            );
            ExitCode::from(cli::BUG)
        }
    }
}
