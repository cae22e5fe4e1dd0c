//! Console output: data to stdout, messages to stderr, progress only to a terminal.

use handstand::fitting::Progress;
use handstand::output::write_new;
use handstand::{Error, Result};
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde::Serialize;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

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

    /// A result: `data` for programs, `text` for people.
    ///
    /// # Errors
    /// As [`Talk::print`].
    pub fn result(&self, data: &impl Serialize, text: impl FnOnce() -> String) -> Result<()> {
        match self.json {
            true => self.data(data),
            false => self.print(&text()),
        }
    }

    /// Writes a file whole, and says so.
    ///
    /// # Errors
    /// As [`write_new`].
    pub fn write(&self, file: &Path, text: &str, force: bool) -> Result<()> {
        write_new(file, text, force)?;
        self.say(&format!("wrote {}", file.display()));
        Ok(())
    }

    /// A bar of `length` steps that shows only on a terminal, and no longer than it lives.
    pub fn bar(&self, length: u64) -> ProgressBar {
        let bar = match self.quiet {
            true => ProgressBar::hidden(),
            // Draws on stderr, and only where that is a terminal.
            false => ProgressBar::new(length),
        };
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
            .with_finish(ProgressFinish::AndClear)
    }

    /// A bar that shows how far a fit or a diagnosis has come, and what hears that.
    pub fn progress(&self) -> impl Fn(Progress) + Sync {
        let bar = self.bar(0);
        move |progress| show(&bar, progress)
    }

    /// A place for lines that are written over again and again; shows only on a terminal, and no
    /// longer than it lives.
    pub fn live(&self) -> ProgressBar {
        let style = ProgressStyle::with_template("{msg}");
        self.bar(0)
            .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    }

    /// An error with its remedy. Lines are not broken, so that `file:line:column` can be clicked
    /// and searched.
    pub fn error(&self, error: Error) {
        // Set once, and only here.
        let _ = miette::set_hook(Box::new(|_| {
            Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).build())
        }));
        let _ = write!(std::io::stderr(), "{:?}", miette::Report::new(error));
    }
}

/// Lets a bar show how far a fit or a diagnosis has come.
pub fn show(bar: &ProgressBar, progress: Progress) {
    bar.set_length(progress.total as u64);
    bar.set_position(progress.done as u64);
    bar.set_message(progress.what);
}
