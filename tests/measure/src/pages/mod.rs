//! The pages of `docs/measured`: which renew in minutes, and one row of each that a test measures
//! again.

/// One page.
#[derive(Debug)]
pub struct MeasuredPage {
    /// Its file, without the ending.
    pub name: &'static str,
    /// How it is renewed.
    pub cost: Cost,
    /// A row that is the same on every machine and takes seconds; none where every row is a time or
    /// a count over many cases.
    pub row: Option<SampleRow>,
}

/// How a page is renewed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// In minutes, by the command that stands on the page.
    Cheap,
    /// As said here; by the command that stands on the page.
    Dear(&'static str),
    /// By a script of its own.
    Script(&'static str, &'static str),
}

/// A row that a test measures again.
#[derive(Debug)]
pub struct SampleRow {
    /// What `cargo xtask` is told, to measure no more than this row.
    pub words: &'static [&'static str],
    /// How the row begins, its cells with a blank between them.
    pub begins: &'static str,
}

const fn page(name: &'static str, cost: Cost) -> MeasuredPage {
    MeasuredPage {
        name,
        cost,
        row: None,
    }
}

/// All pages.
pub const PAGES: &[MeasuredPage] = &[
    page("bench-firmware", Cost::Dear("an hour; an ELF and simavr")),
    page("bench-read", Cost::Cheap),
    page("bench-record", Cost::Dear("some 10 minutes")),
    page(
        "control",
        Cost::Script(
            "minutes, after `cargo build --release -p handstand`",
            "docs/measured/control.sh",
        ),
    ),
    page("detection", Cost::Dear("some two hours")),
    page("first-hour", Cost::Dear("half an hour")),
    page("hidden", Cost::Dear("hours")),
    page("hidden-approximate", Cost::Dear("an hour or two")),
    page("hidden-approximate-mujoco", Cost::Dear("hours; MuJoCo")),
    page("hidden-space", Cost::Dear("half an hour; MuJoCo")),
    page("hidden-chain", Cost::Dear("hours")),
    page("hidden-chain-mujoco", Cost::Dear("hours; MuJoCo")),
    page("hidden-mujoco", Cost::Dear("hours; MuJoCo")),
    page("hidden-robot", Cost::Dear("an hour or so")),
    page("lab", Cost::Cheap),
    page("next", Cost::Dear("half an hour")),
    page(
        "peers",
        Cost::Dear("some 20 minutes; 600 MB of packages, and a machine without other work"),
    ),
    page("real", Cost::Dear("some 10 minutes; HANDSTAND_DATA")),
    page("refit", Cost::Dear("some 10 minutes")),
    page("robot-demo", Cost::Dear("some 10 minutes")),
    page("spoiled", Cost::Dear("half an hour; HANDSTAND_DATA")),
    MeasuredPage {
        name: "verdicts",
        cost: Cost::Cheap,
        row: Some(SampleRow {
            words: &["verdicts", "--gains", "--robots", "1"],
            begins: "viscous joint 3 coefficient_nm_s_rad 0.047547;",
        }),
    },
    page("within", Cost::Dear("two hours or so")),
];

/// The command that stands on a page of `docs/measured`, without `cargo xtask`.
///
/// # Errors
/// A page that names none, or one with quotes, which no one shell reads as another.
pub fn command(page: &str) -> Result<Vec<String>, String> {
    let mut lines = page.lines().skip_while(|line| *line != "```sh").skip(1);
    let typed = lines.next().unwrap_or_default();
    let words = typed.strip_prefix("cargo xtask ").ok_or(
        "the page names no command: write `cargo xtask ...` behind its first line ```sh"
            .to_string(),
    )?;
    if words.contains('"') {
        return Err(format!(
            "`{typed}` holds quotes: run it by hand, with --write"
        ));
    }
    Ok(words.split_whitespace().map(String::from).collect())
}

/// Rows of a page, or of a table as it is printed: the cells of each line with a blank between.
pub fn rows(text: &str) -> Vec<String> {
    let lines = text.lines().map(|line| line.replace(['|', '\\'], " "));
    let rows = lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    rows.filter(|row| !row.is_empty()).collect()
}

/// The row of a page and of what was printed that begins so; both must have it, and alike.
///
/// # Errors
/// Which of them lacks it, or both rows where they differ, and what renews the page.
pub fn same_row(page: &str, printed: &str, row: &SampleRow) -> Result<(), String> {
    let find = |text: &str| rows(text).into_iter().find(|it| it.starts_with(row.begins));
    let command = format!("cargo xtask {}", row.words.join(" "));
    let renew = "renew the page: its own command with --write";
    match (find(page), find(printed)) {
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
    fn a_pages_command_is_read_from_it() {
        let page = "# Peers\n\nMeasured by\n\n```sh\ncargo xtask peers --rounds 5\n```\n";
        assert_eq!(command(page).unwrap(), ["peers", "--rounds", "5"]);
        let bare = command("# Peers\n").unwrap_err();
        assert!(bare.contains("cargo xtask ..."), "{bare}");
        let quoted = command("```sh\ncargo xtask real --only \"MX 106\"\n```").unwrap_err();
        assert!(quoted.contains("by hand"), "{quoted}");
    }

    #[test]
    fn rows_are_compared_whatever_drew_them() {
        let row = SampleRow {
            words: &["next"],
            begins: "arm 2",
        };
        let page = "| arm | 2 | a \\| b | yes |\n| arm | 3 | c | no |\n";
        assert_eq!(same_row(page, " arm   2   a | b   yes \n", &row), Ok(()));
        let other = same_row(page, " arm   2   b   yes \n", &row).unwrap_err();
        assert!(
            other.contains("arm 2 a b yes") && other.contains("--write"),
            "{other}"
        );
        let none = same_row(page, "arm 3 c no", &row).unwrap_err();
        assert!(none.contains("prints no row"), "{none}");
        let unknown = same_row("| arm | 3 |", "arm 2", &row).unwrap_err();
        assert!(unknown.contains("no row begins"), "{unknown}");
    }
}
