//! What a command measured: tables and lines, for the terminal and for `docs/measured/`.

use comfy_table::{Cell, Row, Table};
use handstand_xtask::root;
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Tables and the lines between them, in order.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    parts: Vec<Part>,
}

#[derive(Debug, Clone)]
enum Part {
    Table(Box<Table>),
    Line(String),
}

/// Line of a document behind which a command puts what it measured.
pub const BEGIN: &str = "<!-- measured -->";
/// Line that ends it.
pub const END: &str = "<!-- end of measured -->";

/// Where a table comes from: what a reader needs to measure it again.
#[derive(Debug, Clone)]
pub struct Provenance {
    /// The command that measures it, as typed.
    pub command: String,
    /// Version of the project, with the commit where one is known.
    pub version: String,
    /// Day, as in 2026-11-22, UTC.
    pub date: String,
}

impl Measured {
    /// With one more table.
    #[must_use]
    pub fn table(mut self, table: Table) -> Self {
        self.parts.push(Part::Table(Box::new(table)));
        self
    }

    /// With one more line of text.
    #[must_use]
    pub fn line(mut self, line: impl Into<String>) -> Self {
        self.parts.push(Part::Line(line.into()));
        self
    }

    /// With more lines of text.
    #[must_use]
    pub fn lines(self, lines: impl IntoIterator<Item = String>) -> Self {
        lines.into_iter().fold(self, Measured::line)
    }

    /// As it is printed: a blank line after every table.
    pub fn text(&self) -> String {
        let text = self.parts.iter().map(|part| match part {
            Part::Table(table) => format!("{table}\n\n"),
            Part::Line(line) => format!("{line}\n"),
        });
        text.collect()
    }

    /// As a page of `docs/measured`.
    pub fn markdown(&self, title: &str, from: &Provenance) -> String {
        let Provenance {
            command,
            version,
            date,
        } = from;
        let mut page = format!(
            "# {title}\n\nMeasured on {date} with version {version} by\n\n```sh\n{command}\n```\n\n\
             which wrote this page. Do not edit it: measure again with `--write`.\n"
        );
        page += &self.markdown_parts();
        page
    }

    /// Tables and lines in Markdown, each after a blank line.
    fn markdown_parts(&self) -> String {
        let parts = self.parts.iter().map(|part| match part {
            Part::Table(table) => format!("\n{}", markdown_table(table)),
            Part::Line(line) => format!("\n{}\n", line.trim_end()),
        });
        parts.collect()
    }

    /// Puts it into a document in place of what stands between the lines [`BEGIN`] and [`END`].
    ///
    /// # Errors
    /// What the system refuses, or a document without these lines.
    pub fn insert(&self, file: &Path, from: &Provenance) -> Result<(), String> {
        let refused = |error: std::io::Error| format!("{}: {error}", file.display());
        let text = std::fs::read_to_string(file).map_err(refused)?;
        let parts = text
            .split_once(BEGIN)
            .and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
        let Some((before, after)) = parts else {
            let file = file.display();
            return Err(format!(
                "{file}: the lines `{BEGIN}` and `{END}` are missing"
            ));
        };
        let Provenance {
            command,
            version,
            date,
        } = from;
        let measured = self.markdown_parts();
        let text = format!(
            "{before}{BEGIN}\nMeasured on {date} with version {version} by `{command}`:\n{measured}\n{END}{after}"
        );
        std::fs::write(file, text).map_err(refused)
    }

    /// Writes the page NAME.md into a folder; its path.
    ///
    /// # Errors
    /// What the system refuses, with the path.
    pub fn write(
        &self,
        folder: &Path,
        name: &str,
        title: &str,
        from: &Provenance,
    ) -> Result<PathBuf, String> {
        let path = folder.join(name).with_extension("md");
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&path, self.markdown(title, from)))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(path)
    }
}

impl Provenance {
    /// Of this run of `cargo xtask`, without the option that asks for the page.
    pub fn here() -> Self {
        let words = std::env::args().skip(1).filter(|word| word != "--write");
        let words = words.map(|word| {
            // Only what is written has to be within the project, and that was asked before.
            let word = in_project(&word, root()).unwrap_or(word);
            if word.contains(char::is_whitespace) {
                format!("\"{word}\"")
            } else {
                word
            }
        });
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Provenance {
            command: format!("cargo xtask {}", words.collect::<Vec<_>>().join(" ")),
            version: version().to_string(),
            date: date(since.map_or(0, |since| since.as_secs() / 86_400)),
        }
    }
}

/// A word of a command as a page may show it: a path from the folder `root` of the project on.
///
/// # Errors
/// A path that leads out of the project: no other machine has it.
pub fn in_project(word: &str, root: &Path) -> Result<String, String> {
    let (option, value) = match word.split_once('=') {
        Some((option, value)) if option.starts_with("--") => (format!("{option}="), value),
        _ => (String::new(), word),
    };
    let path = Path::new(value);
    let climbs = path.components().any(|part| part == Component::ParentDir);
    if !path.is_absolute() && !climbs {
        return Ok(word.to_string());
    }
    match path.strip_prefix(root) {
        Ok(inner) if !climbs => Ok(format!("{option}{}", inner.display())),
        _ => Err(format!(
            "`{value}` is outside of the project, and the page would name it: give a path from the \
             project's folder on, such as target/{}",
            path.file_name().unwrap_or_default().to_string_lossy()
        )),
    }
}

/// Version of the project that this was built from, with the commit where one is known.
pub fn version() -> &'static str {
    env!("HANDSTAND_VERSION")
}

/// The day so many days after 1970-01-01 (Gregorian), as 1970-01-01.
fn date(days: u64) -> String {
    // 400 years have 146,097 days. They are counted from a March, so that the leap day is a year's
    // last.
    const FROM_MARCH_0000: u64 = 719_468;
    let days = days + FROM_MARCH_0000;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    // March to July and August to December have 153 days each.
    let month = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    format!(
        "{:04}-{month:02}-{day_of_month:02}",
        400 * era + year + next
    )
}

fn markdown_table(table: &Table) -> String {
    let cells = |row: &Row| -> Vec<String> { row.cell_iter().map(markdown_cell).collect() };
    let header = table.header().map(cells).unwrap_or_default();
    let rule = vec!["---".to_string(); header.len()];
    let rows = [header, rule]
        .into_iter()
        .chain(table.row_iter().map(cells));
    rows.fold(String::new(), |mut text, row| {
        let _ = writeln!(text, "| {} |", row.join(" | "));
        text
    })
}

/// A cell may hold bars and line breaks; Markdown's may not.
fn markdown_cell(cell: &Cell) -> String {
    cell.content().replace('|', "\\|").replace('\n', "<br>")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured() -> Measured {
        let mut table = Table::new();
        table.set_header(["task", "ratio"]);
        table.add_row(["one|two\nthree", "1.5"]);
        Measured::default().table(table).line("Times are medians.")
    }

    fn provenance() -> Provenance {
        Provenance {
            command: "cargo xtask peers --rounds 5".into(),
            version: "0.1.0 (abc)".into(),
            date: "2026-11-22".into(),
        }
    }

    #[test]
    fn a_page_says_what_was_measured_by_what_and_when() {
        let page = measured().markdown("Peers", &provenance());
        assert_eq!(
            page,
            "# Peers\n\nMeasured on 2026-11-22 with version 0.1.0 (abc) by\n\n```sh\n\
             cargo xtask peers --rounds 5\n```\n\n\
             which wrote this page. Do not edit it: measure again with `--write`.\n\n\
             | task | ratio |\n| --- | --- |\n| one\\|two<br>three | 1.5 |\n\nTimes are medians.\n"
        );
    }

    #[test]
    fn a_page_is_written_over_the_last_one_and_a_refusal_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let within = folder.path().join("measured");
        for _ in 0..2 {
            let path = measured()
                .write(&within, "peers", "Peers", &provenance())
                .unwrap();
            assert_eq!(path, within.join("peers.md"));
            assert!(std::fs::read_to_string(path).unwrap().contains("| 1.5 |"));
        }
        let file = within.join("peers.md");
        let refused = measured().write(&file, "peers", "Peers", &provenance());
        assert!(refused.unwrap_err().contains("peers.md"));
    }

    #[test]
    fn a_document_gets_the_table_between_its_marks() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("firmware.md");
        std::fs::write(&file, format!("a\n{BEGIN}\nold\n{END}\nb\n")).unwrap();
        for _ in 0..2 {
            measured().insert(&file, &provenance()).unwrap();
            let text = std::fs::read_to_string(&file).unwrap();
            assert!(text.starts_with(&format!("a\n{BEGIN}\nMeasured on 2026-11-22")));
            assert!(
                text.ends_with(&format!("Times are medians.\n\n{END}\nb\n")),
                "{text}"
            );
            assert_eq!(text.matches("| ratio |").count(), 1, "{text}");
            assert!(!text.contains("old"));
        }
        std::fs::write(&file, "a\nb\n").unwrap();
        let refused = measured().insert(&file, &provenance()).unwrap_err();
        assert!(
            refused.contains("firmware.md") && refused.contains(BEGIN),
            "{refused}"
        );
    }

    #[test]
    fn a_page_names_no_path_outside_of_the_project() {
        let root = Path::new("/home/me/handstand");
        for (word, shown) in [
            ("target/a.jsonl", "target/a.jsonl"),
            ("viscous,coulomb", "viscous,coulomb"),
            ("/home/me/handstand/target/a.jsonl", "target/a.jsonl"),
            (
                "--outcomes=/home/me/handstand/a.jsonl",
                "--outcomes=a.jsonl",
            ),
        ] {
            assert_eq!(in_project(word, root).as_deref(), Ok(shown));
        }
        for word in [
            "/elsewhere/a.jsonl",
            "../a.jsonl",
            "--outcomes=/elsewhere/a.jsonl",
            "/home/me/handstand/../a.jsonl",
            "/home/me/handstand2/a.jsonl",
        ] {
            let refused = in_project(word, root).unwrap_err();
            assert!(refused.contains("such as target/a.jsonl"), "{refused}");
        }
    }

    #[test]
    fn days_are_dates() {
        for (days, expected) in [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_779, "2026-11-22"),
            (47_540, "2100-02-28"),
            (47_541, "2100-03-01"),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
