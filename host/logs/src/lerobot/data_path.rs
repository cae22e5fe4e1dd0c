//! Where a data set's files are: `data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet`.

use std::path::{Component, Path};

/// Widest number of a path.
const WIDEST: usize = 20;

/// A path with the places of two numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DataPath {
    parts: Vec<PathPart>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum PathPart {
    Text(String),
    /// The chunk's number, or the file's, with so many digits.
    Number {
        is_chunk: bool,
        width: usize,
    },
}

impl DataPath {
    /// Takes a template apart as Python's `str.format` does; `names` are those of the chunk's
    /// number and of the file's.
    ///
    /// # Errors
    /// Why it is none: another field, a path that leads out of the folder, one that does not tell
    /// files apart.
    pub fn parse(template: &str, names: [&str; 2]) -> Result<DataPath, String> {
        let [chunk, file] = names;
        let mut parts = Vec::new();
        let mut rest = template;
        while let Some((before, from)) = rest.split_once('{') {
            if before.contains('}') {
                return Err("a brace that is not opened".into());
            }
            let (field, after) = from.split_once('}').ok_or("a brace that is not closed")?;
            let (name, width) = field.split_once(':').unwrap_or((field, "d"));
            let is_chunk = match name {
                name if name == chunk => true,
                name if name == file => false,
                _ => return Err(format!("a field {{{name}}}")),
            };
            parts.push(PathPart::Text(before.to_string()));
            let width = digits(width).ok_or_else(|| format!("a field {{{field}}}"))?;
            parts.push(PathPart::Number { is_chunk, width });
            rest = after;
        }
        if rest.contains('}') {
            return Err("a brace that is not opened".into());
        }
        parts.push(PathPart::Text(rest.to_string()));
        let path = DataPath { parts };
        let of_file = |part: &PathPart| {
            matches!(
                part,
                PathPart::Number {
                    is_chunk: false,
                    ..
                }
            )
        };
        if !path.parts.iter().any(of_file) {
            return Err(format!("no field {{{file}}}, so one file for all"));
        }
        let made = path.of(0, 0);
        let stays = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(&made).components().all(stays) || made.contains('\\') {
            return Err("a path that leads out of the folder".into());
        }
        if !made.ends_with(".parquet") {
            return Err("another ending than .parquet".into());
        }
        Ok(path)
    }

    /// The path of a file.
    pub fn of(&self, chunk: u64, file: u64) -> String {
        let parts = self.parts.iter().map(|part| match part {
            PathPart::Text(text) => text.clone(),
            PathPart::Number { is_chunk, width } => {
                let number = if *is_chunk { chunk } else { file };
                format!("{number:0width$}", width = *width)
            }
        });
        parts.collect()
    }
}

/// How many digits a format of Python's asks for: `03d`, `d`.
fn digits(format: &str) -> Option<usize> {
    let width = format.strip_suffix('d')?;
    if width.is_empty() {
        return Some(0);
    }
    let width = width.strip_prefix('0')?.parse().ok()?;
    (width <= WIDEST).then_some(width)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 2] = ["chunk_index", "file_index"];

    #[test]
    fn numbers_are_put_in_their_places() {
        let template = "data/chunk-{chunk_index:03d}/file-{file_index}.parquet";
        let path = DataPath::parse(template, NAMES).unwrap();
        assert_eq!(path.of(2, 17), "data/chunk-002/file-17.parquet");
        assert_eq!(path.of(1234, 0), "data/chunk-1234/file-0.parquet");
    }

    #[test]
    fn what_is_no_path_within_the_folder_is_refused() {
        for (template, why) in [
            ("../{file_index}.parquet", "leads out"),
            ("data/../../{file_index}.parquet", "leads out"),
            ("/etc/{file_index}.parquet", "leads out"),
            ("c:\\{file_index}.parquet", "leads out"),
            ("{file_index.__class__}.parquet", "a field"),
            ("{0}{file_index}.parquet", "a field"),
            ("{file_index:099999999d}.parquet", "a field"),
            ("{file_index:>3}.parquet", "a field"),
            ("{file_index", "not closed"),
            ("}{file_index}.parquet", "not opened"),
            ("{file_index}}.parquet", "not opened"),
            ("data/{chunk_index}.parquet", "one file for all"),
            ("{file_index}.csv", "ending"),
        ] {
            let found = DataPath::parse(template, NAMES).unwrap_err();
            assert!(found.contains(why), "{template}: {found}");
        }
    }
}
