//! Console output: data to stdout, messages to stderr, progress only to a terminal.

use handstand::{Error, Result};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::io::{ErrorKind, Write as _};

/// Where the output of one run goes, and in which form.
#[derive(Debug, Clone)]
pub struct Talk {
    /// Whether data is JSON.
    pub json: bool,
    /// The command line of this run.
    pub command: String,
    quiet: bool,
    /// Whether data goes to stderr too, as part of a transcript.
    transcript: bool,
}

impl Talk {
    /// Data to stdout, as JSON if asked; messages to stderr unless quiet.
    pub fn new(json: bool, quiet: bool) -> Self {
        let words = std::env::args_os().skip(1);
        let words = words.map(|word| format!(" {}", word.to_string_lossy()));
        Talk {
            json,
            command: format!("handstand{}", words.collect::<String>()),
            quiet,
            transcript: false,
        }
    }

    /// For a step of a longer run: its data go to stderr, as messages do.
    pub fn transcript(&self, command: String) -> Self {
        Talk {
            json: false,
            command,
            quiet: self.quiet,
            transcript: true,
        }
    }

    /// Prints one line to stderr unless quiet.
    pub fn say(&self, line: &str) {
        if !self.quiet {
            // A closed stderr is no error.
            let _ = writeln!(std::io::stderr(), "{line}");
        }
    }

    /// Data for people. A reader who has seen enough and closed the pipe is no error.
    ///
    /// # Errors
    /// Any other refusal of the system.
    pub fn print(&self, text: &str) -> Result<()> {
        let text = format!("{}\n", text.trim_end());
        if self.transcript {
            self.say(text.trim_end());
            return Ok(());
        }
        let mut out = std::io::stdout().lock();
        match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                Err(Error::file("stdout", "write", error))
            }
            _ => Ok(()),
        }
    }

    /// Data for programs.
    ///
    /// # Errors
    /// As [`Talk::print`].
    pub fn data(&self, data: &impl Serialize) -> Result<()> {
        let text = serde_json::to_string_pretty(data)
            .map_err(|error| Error::file("stdout", "write", error.into()))?;
        self.print(&text)
    }

    /// A bar that shows only on a terminal.
    pub fn bar(&self) -> ProgressBar {
        let bar = if self.quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(0) // draws on stderr, and only where that is a terminal
        };
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    }

    /// An error with its remedy. Lines are not broken, so that `file:line:column` can be clicked
    /// and searched.
    pub fn error(&self, error: Error) {
        let handler = miette::MietteHandlerOpts::new().wrap_lines(false).build();
        let shown = Shown(&handler, &error);
        let _ = write!(std::io::stderr(), "{shown}");
    }
}

struct Shown<'a>(&'a miette::MietteHandler, &'a Error);

impl std::fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        use miette::ReportHandler as _;
        self.0.debug(self.1, f)
    }
}
