//! A row of a page that is measured again.

use handstand_xtask::root;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// A row that is the same on every machine.
#[derive(Debug)]
pub struct SampleRow {
    /// Which program measures it.
    pub program: Program,
    /// What the program is told, to measure no more than this row: words with blanks between them;
    /// `{handstand}` is the path of the program `handstand`.
    pub command: &'static str,
    /// How the row begins, its cells with a blank between them.
    pub begins: &'static str,
    /// Whether it takes the public logs of `HANDSTAND_DATA`.
    pub public_logs: bool,
}

/// A program that measures rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// `cargo xtask`.
    Xtask,
    /// `handstand`, in the folder of the models.
    Handstand,
}

/// The word that stands for the path of the program `handstand`.
const HANDSTAND: &str = "{handstand}";

/// Where the programs that measure rows lie.
#[derive(Debug)]
pub struct Programs<'a> {
    /// What `cargo xtask` runs.
    pub measure: &'a Path,
    /// The program that is measured.
    pub handstand: &'a Path,
}

/// What becomes of a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// It is what the page says.
    Same,
    /// It is not measured, and why.
    LeftOut(&'static str),
}

/// A row that `cargo xtask` measures.
pub(super) const fn row(command: &'static str, begins: &'static str) -> SampleRow {
    SampleRow {
        program: Program::Xtask,
        command,
        begins,
        public_logs: false,
    }
}

/// Rows of a page, or of a table as it is printed: the cells of each line with a blank between.
fn rows(text: &str) -> Vec<String> {
    let lines = text.lines().map(|line| line.replace(['|', '\\'], " "));
    let rows = lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    rows.filter(|row| !row.is_empty()).collect()
}

impl SampleRow {
    /// Measures the row again and compares it with the page.
    ///
    /// # Errors
    /// A row that only the page or only the program has, or that differs: both, and what renews the
    /// page; a program that cannot be run.
    pub fn measured_again(&self, page: &str, programs: &Programs) -> Result<Answer, String> {
        if self.public_logs && std::env::var_os("HANDSTAND_DATA").is_none() {
            return Ok(Answer::LeftOut(
                "HANDSTAND_DATA names no folder of public logs",
            ));
        }
        let (program, folder) = match self.program {
            Program::Xtask => (programs.measure, root().to_path_buf()),
            Program::Handstand => (programs.handstand, root().join("host/models")),
        };
        let words = self.command.split_whitespace().map(|word| match word {
            HANDSTAND => programs.handstand.as_os_str(),
            word => OsStr::new(word),
        });
        let output = Command::new(program)
            .args(words)
            .current_dir(folder)
            .output()
            .map_err(|why| format!("`{}`: {why}", self.typed()))?;
        let printed = String::from_utf8_lossy(&output.stdout);
        same_row(page, &printed, self)
            .map(|()| Answer::Same)
            .map_err(|why| format!("{why}\n{}", String::from_utf8_lossy(&output.stderr)))
    }

    /// The row in a page or in what was printed.
    pub fn find(&self, text: &str) -> Option<String> {
        rows(text)
            .into_iter()
            .find(|it| it.starts_with(self.begins))
    }

    /// The command as typed.
    pub fn typed(&self) -> String {
        let program = match self.program {
            Program::Xtask => "cargo xtask",
            Program::Handstand => "handstand",
        };
        format!("{program} {}", self.command)
    }
}

/// The row of a page and of what was printed that begins so; both must have it, and alike.
///
/// # Errors
/// Which of them lacks it, or both rows where they differ, and what renews the page.
fn same_row(page: &str, printed: &str, row: &SampleRow) -> Result<(), String> {
    let command = row.typed();
    let renew = "renew the page, by the command that stands on it";
    match (row.find(page), row.find(printed)) {
        (None, _) => Err(format!("no row begins with `{}`; {renew}", row.begins)),
        (_, None) => Err(format!(
            "`{command}` prints no row `{}`:\n{printed}",
            row.begins
        )),
        (Some(old), Some(today)) if old != today => Err(format!(
            "the page says\n  {old}\nand `{command}` says\n  {today}\n{renew}"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_compared_whatever_drew_them() {
        let row = row("next", "arm 2");
        let page = "| arm | 2 | a \\| b | yes |\n| arm | 3 | c | no |\n";
        assert_eq!(same_row(page, " arm   2   a | b   yes \n", &row), Ok(()));
        let other = same_row(page, " arm   2   b   yes \n", &row).unwrap_err();
        assert!(
            other.contains("arm 2 a b yes") && other.contains("renew the page"),
            "{other}"
        );
        let none = same_row(page, "arm 3 c no", &row).unwrap_err();
        assert!(none.contains("prints no row"), "{none}");
        let unknown = same_row("| arm | 3 |", "arm 2", &row).unwrap_err();
        assert!(unknown.contains("no row begins"), "{unknown}");
    }
}
