//! Console output: data to stdout, messages to stderr; progress as a bar on a terminal, elsewhere
//! as a line now and then.

use handstand::fitting::Progress;
use handstand::output::write_new;
use handstand::{Error, Result};
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt;
use std::io::{ErrorKind, IsTerminal as _, Write as _};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Where the output of one run goes, and in which form.
#[derive(Debug, Clone)]
pub struct Console {
    /// Whether data is JSON.
    pub json: bool,
    /// The command line of this run.
    pub command: String,
    quiet: bool,
    /// Whether data goes to stderr too, as part of a transcript.
    transcript: bool,
}

impl Console {
    /// Data to stdout, as JSON if asked; messages to stderr unless quiet.
    pub fn new(json: bool, quiet: bool) -> Self {
        let words = std::env::args_os().skip(1);
        let words = words.map(|word| format!(" {}", word.to_string_lossy()));
        Console {
            json,
            command: format!("handstand{}", words.collect::<String>()),
            quiet,
            transcript: false,
        }
    }

    /// For a step of a longer run: its data go to stderr, as messages do.
    pub fn transcript(&self, command: String) -> Self {
        Console {
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
    /// As [`Console::print`].
    pub fn data(&self, data: &impl Serialize) -> Result<()> {
        let text = serde_json::to_string_pretty(data)
            .map_err(|error| Error::file("stdout", "write", error.into()))?;
        self.print(&text)
    }

    /// A result: `data` for programs, `text` for people.
    ///
    /// # Errors
    /// As [`Console::print`].
    pub fn result(&self, data: &impl Serialize, text: impl FnOnce() -> String) -> Result<()> {
        if self.json {
            self.data(data)
        } else {
            self.print(&text())
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

    /// A text that a command made and wrote to `file`, if one is named: else people get the text.
    /// Programs get `data` with the keys `file` and `text`, one of which is null.
    ///
    /// # Errors
    /// As [`Console::print`].
    pub fn made(&self, file: Option<&Path>, text: &str, mut data: Value) -> Result<()> {
        data["file"] = json!(file);
        data["text"] = json!(file.is_none().then_some(text));
        match (self.json, file) {
            (true, _) => self.data(&data),
            (false, None) => self.print(text),
            (false, Some(_)) => Ok(()),
        }
    }

    /// A bar of `length` steps that shows only on a terminal, and no longer than it lives.
    pub fn bar(&self, length: u64) -> ProgressBar {
        let bar = if self.quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(length)
        };
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
            .with_finish(ProgressFinish::AndClear)
    }

    /// A bar that shows how far a fit or a diagnosis has come, and what hears that. Where there is
    /// no terminal, a line now and then.
    pub fn progress(&self) -> impl Fn(Progress) + Sync {
        let bar = self.bar(0);
        let lines = (!self.quiet && !std::io::stderr().is_terminal()).then(Lines::default);
        let console = self.clone();
        move |progress| match &lines {
            Some(lines) => {
                if lines.is_due() {
                    console.say(&progress_line(&progress));
                }
            }
            None => show(&bar, progress),
        }
    }

    #[cfg(feature = "robot")]
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
        let _ = write!(
            std::io::stderr(),
            "{:?}",
            miette::Report::new(ShownError(error))
        );
    }
}

/// An error as people see it: with its remedy.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
struct ShownError(Error);

impl miette::Diagnostic for ShownError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let remedy = self.0.remedy()?;
        Some(Box::new(remedy))
    }
}

/// When lines are due that tell how far work has come.
struct Lines {
    begun: Instant,
    /// How long after it began the last one was written, s.
    last_s: Mutex<f64>,
}

/// Work that takes no longer tells nothing, s; then a line is due every so often, s.
const FIRST_LINE_S: f64 = 20.0;
const LINE_S: f64 = 30.0;

impl Default for Lines {
    fn default() -> Self {
        Lines {
            begun: Instant::now(),
            last_s: Mutex::new(FIRST_LINE_S - LINE_S),
        }
    }
}

impl Lines {
    fn is_due(&self) -> bool {
        self.is_due_after(self.begun.elapsed().as_secs_f64())
    }

    fn is_due_after(&self, elapsed_s: f64) -> bool {
        let mut last_s = self.last_s.lock().unwrap_or_else(PoisonError::into_inner);
        let is_due = elapsed_s >= *last_s + LINE_S;
        if is_due {
            *last_s = elapsed_s;
        }
        is_due
    }
}

/// Lets a bar show how far a fit or a diagnosis has come.
pub fn show(bar: &ProgressBar, progress: Progress) {
    bar.set_length(progress.total as u64);
    bar.set_position(progress.done as u64);
    let words = [
        Some(progress.what.to_string()),
        best(&progress),
        left(&progress),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    bar.set_message(words.join(", "));
}

/// "34 %: sets of two effects, best so far ..., at most 6 min left".
fn progress_line(progress: &Progress) -> String {
    let percent = 100 * progress.done / progress.total.max(1);
    let words = [
        Some(progress.what.to_string()),
        best(progress),
        left(progress),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    format!("{percent} %: {}", words.join(", "))
}

fn best(progress: &Progress) -> Option<String> {
    let best = progress.best.as_ref();
    best.map(|best| format!("best so far {best}"))
}

fn left(progress: &Progress) -> Option<String> {
    progress.left_s.map(|left_s| {
        if left_s < 100.0 {
            format!("at most {left_s:.0} s left")
        } else {
            format!("at most {:.0} min left", (left_s / 60.0).ceil())
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand::fitting::BestSoFar;
    use handstand::model::MeasuredSignal;

    #[test]
    fn a_line_is_due_now_and_then() {
        let lines = Lines::default();
        let due = [1.0, 19.9, 20.0, 21.0, 49.0, 51.0, 70.0, 81.5];
        let due: Vec<f64> = due.into_iter().filter(|s| lines.is_due_after(*s)).collect();
        assert_eq!(due, [20.0, 51.0, 81.5]);
    }

    #[test]
    fn a_line_tells_how_far_work_is_what_it_has_and_what_is_left() {
        let begun = Progress {
            done: 34,
            total: 1000,
            what: "every effect alone".into(),
            best: None,
            left_s: None,
        };
        assert_eq!(progress_line(&begun), "3 %: every effect alone");
        let later = Progress {
            done: 340,
            best: Some(BestSoFar {
                names: vec!["coulomb@1".into(), "delay@1".into()],
                before_rad: 0.0412,
                error_rad: 0.00321,
                floor_rad: 0.0015,
                quantity: MeasuredSignal::Angle,
            }),
            left_s: Some(301.0),
            ..begun.clone()
        };
        assert_eq!(
            progress_line(&later),
            "34 %: every effect alone, best so far coulomb@1 + delay@1: 3.21 of 41.2 mrad, floor \
             1.50, at most 6 min left"
        );
        let mut slide = later;
        slide.best.as_mut().unwrap().quantity = MeasuredSignal::Displacement;
        assert!(progress_line(&slide).contains(": 3.21 of 41.2 mm, floor"));
    }
}
