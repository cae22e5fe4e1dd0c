//! Files this program makes: whole or not at all, and never over another's work unasked. Numbers
//! for people: [`number`].

pub mod append_file;
pub mod number;
mod shortened;
pub mod table;

pub use shortened::{readable, shortened};

use crate::error::{Error, Result};
use std::io::{ErrorKind, Write as _};
use std::path::Path;

/// Writes `text` to `path` through a temporary file beside it, synced before it takes the name.
///
/// # Errors
/// [`Error::Usage`] if the file exists and `force` is false; [`Error::File`] if the system refuses.
pub fn write_new(path: &Path, text: &str, force: bool) -> Result<()> {
    write_new_bytes(path, text.as_bytes(), force)
}

/// Writes bytes as [`write_new`] writes text.
///
/// # Errors
/// As [`write_new`].
pub fn write_new_bytes(path: &Path, bytes: &[u8], force: bool) -> Result<()> {
    not_taken(path, force)?;
    let refused = |source| Error::file(path, "write", source);
    let mut file = beside(path)?;
    file.write_all(bytes).map_err(refused)?;
    file.as_file().sync_all().map_err(refused)?;
    let kept = if force {
        file.persist(path)
    } else {
        file.persist_noclobber(path)
    };
    match kept.map_err(|error| error.error) {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(exists(path)),
        Err(error) => Err(refused(error)),
    }
}

/// Why nothing can be made in a folder, without the temporary file's name, which is not the user's.
fn own_words(folder: &Path, error: &std::io::Error) -> std::io::Error {
    let missing = std::fs::metadata(folder).err();
    missing.unwrap_or_else(|| error.kind().into())
}

/// Refuses a name that is taken, or a folder that takes no file, before the work begins, not after
/// it.
///
/// # Errors
/// [`Error::Usage`] if the file exists and may not be replaced; [`Error::File`] if nothing can be
/// written beside it.
pub fn vacant(path: &Path, force: bool) -> Result<()> {
    not_taken(path, force)?;
    beside(path).map(drop)
}

fn not_taken(path: &Path, force: bool) -> Result<()> {
    if !force && path.symlink_metadata().is_ok() {
        Err(exists(path))
    } else {
        Ok(())
    }
}

fn exists(path: &Path) -> Error {
    Error::usage(
        format!("{} exists", path.display()),
        "choose another name or pass --force",
    )
}

/// A temporary file in the folder that a file is to be in.
fn beside(path: &Path) -> Result<tempfile::NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    temporary(folder).map_err(|error| Error::file(path, "write", own_words(folder, &error)))
}

/// A new file with the permissions any new file gets; a temporary one would be closed to others.
fn temporary(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".handstand-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_existing_file_stays_unless_forced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.toml");
        write_new(&path, "first", false).unwrap();
        let error = write_new(&path, "second", false).unwrap_err();
        assert!(error.to_string().ends_with("exists"), "{error}");
        assert_eq!(error.exit_code(), 2);
        assert!(error.remedy().unwrap().contains("--force"));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "first");
        write_new(&path, "second", true).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "second");
        let left = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(left, 1, "no temporary file stays behind");
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nowhere").join("model.toml");
        let error = write_new(&path, "text", false).unwrap_err();
        // Before the work, too.
        assert_eq!(
            vacant(&path, false).unwrap_err().to_string(),
            error.to_string()
        );
        assert_eq!(error.exit_code(), 3);
        let shown = path.display();
        assert!(
            error
                .to_string()
                .starts_with(&format!("{shown}: cannot write: ")),
            "{error}"
        );
        assert!(!error.to_string().contains(".handstand-"), "{error}");
        let remedy = error.remedy().unwrap();
        assert!(remedy.starts_with("create the folder first: "), "{remedy}");
        assert!(remedy.ends_with("nowhere"), "{remedy}");
    }
}
