//! `handstand completions SHELL`: what a shell needs to complete commands and options.
//!
//! ```console
//! $ handstand completions bash > ~/.local/share/bash-completion/completions/handstand
//! $ handstand completions zsh > ~/.zfunc/_handstand
//! $ handstand completions fish > ~/.config/fish/completions/handstand.fish
//! ```

use super::{Cli, Console, ExitStatus};
use clap::CommandFactory as _;
use clap_complete::Shell;
use handstand::Result;

/// Print what a shell needs to complete commands and options.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Prints the shell's script.
pub fn run(args: &CompletionsArgs, console: &Console) -> Result<ExitStatus> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "handstand", &mut script);
    let script = String::from_utf8_lossy(&script);
    if console.json {
        console.data(&serde_json::json!({ "script": script }))?
    } else {
        console.print(&script)?
    }
    Ok(ExitStatus::Done)
}
