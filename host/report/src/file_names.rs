//! Names of files that stand side by side: each as short as tells it from the others.

use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

/// The last part of a file's path.
pub fn file_name(file: &Path) -> String {
    file.file_name()
        .unwrap_or(file.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// The last part of each file's path, after as many folders as tell it from the others:
/// `d1/model.toml`, `d2/model.toml`. A file that is given again is numbered: `model.toml (2)`.
pub fn file_names(files: &[impl AsRef<Path>]) -> Vec<String> {
    let paths: Vec<Vec<&OsStr>> = files.iter().map(|file| parts(file.as_ref())).collect();
    let named = paths.iter().enumerate().map(|(index, own)| {
        let before = paths[..index].iter().filter(|path| *path == own).count();
        let name = shortest(own, &paths);
        match before {
            0 => name,
            again => format!("{name} ({})", again + 1),
        }
    });
    named.collect()
}

/// A path's parts, without those that say nothing: `./a.toml` is `a.toml`.
fn parts(file: &Path) -> Vec<&OsStr> {
    let parts = file.components();
    let parts = parts.filter(|part| *part != Component::CurDir);
    parts.map(Component::as_os_str).collect()
}

/// The fewest last parts of a path that no other path ends in; all where one ends in them all.
fn shortest(own: &[&OsStr], paths: &[Vec<&OsStr>]) -> String {
    let tail = |count: usize| &own[own.len() - count..];
    let tells = |count: &usize| {
        let mut others = paths.iter().filter(|path| *path != own);
        others.all(|path| !path.ends_with(tail(*count)))
    };
    let count = (1..own.len()).find(tells).unwrap_or(own.len());
    let name: PathBuf = tail(count).iter().collect();
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names with `/` on every system.
    fn named(files: &[&str]) -> Vec<String> {
        let names = file_names(files).into_iter();
        names.map(|name| name.replace('\\', "/")).collect()
    }

    #[test]
    fn files_of_one_name_are_told_apart_by_their_folders() {
        let deep = ["a/x/m.toml", "b/x/m.toml", "b/y/m.toml", "b/other.toml"];
        let told = ["a/x/m.toml", "b/x/m.toml", "y/m.toml", "other.toml"];
        assert_eq!(named(&deep), told);
        let pair = ["runs/d1/m.toml", "runs/d2/m.toml"];
        assert_eq!(named(&pair), ["d1/m.toml", "d2/m.toml"]);
        assert_eq!(named(&["m.toml", "d/m.toml"]), ["m.toml", "d/m.toml"]);
        assert_eq!(named(&["d/m.toml", "/d/m.toml"]), ["d/m.toml", "/d/m.toml"]);
    }

    #[test]
    fn a_file_given_again_is_numbered() {
        let thrice = ["d/m.toml", "./d/m.toml", "d/n.toml", "d/m.toml"];
        let told = ["m.toml", "m.toml (2)", "n.toml", "m.toml (3)"];
        assert_eq!(named(&thrice), told);
    }

    #[test]
    fn odd_paths_have_names() {
        assert_eq!(named(&["", "/", "..", "."]).len(), 4);
    }
}
