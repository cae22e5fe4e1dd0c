//! `handstand completions SHELL`: what a shell needs to complete commands and options.
//!
//! ```console
//! $ handstand completions bash > ~/.local/share/bash-completion/completions/handstand
//! $ handstand completions zsh > ~/.zfunc/_handstand
//! $ handstand completions fish > ~/.config/fish/completions/handstand.fish
//! ```

use super::{Cli, ExitStatus, Talk};
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
pub fn run(args: &CompletionsArgs, talk: &Talk) -> Result<ExitStatus> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "handstand", &mut script);
    let script = String::from_utf8_lossy(&script);
    if talk.json {
        talk.data(&serde_json::json!({ "script": script }))?
    } else {
        talk.print(&script)?
    }
    Ok(ExitStatus::Done)
}
