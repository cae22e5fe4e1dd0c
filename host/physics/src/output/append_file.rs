//! A file to which one program appends, so that what it finished outlives it.

use crate::error::{Error, Result};
use fs4::fs_std::FileExt as _;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// An open file; other programs that append to it are kept out until it is dropped.
#[derive(Debug)]
pub struct AppendFile {
    path: PathBuf,
    file: File,
}

impl AppendFile {
    /// Opens a file or begins it, with the bytes it holds; `None` while another program appends to
    /// it.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn open(path: &Path) -> Result<Option<(AppendFile, Vec<u8>)>> {
        let refused = |error| Error::file(path, "write", error);
        let mut options = File::options();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(path).map_err(refused)?;
        if !file.try_lock_exclusive().map_err(refused)? {
            return Ok(None);
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(refused)?;
        let path = path.to_path_buf();
        Ok(Some((AppendFile { path, file }, bytes)))
    }

    /// Cuts off what lies beyond so many bytes: what a crash tore.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn cut(&mut self, bytes: u64) -> Result<()> {
        let cut = self.file.set_len(bytes);
        cut.and_then(|()| self.file.seek(SeekFrom::End(0)))
            .map(|_| ())
            .map_err(|error| Error::file(&self.path, "write", error))
    }

    /// Appends text, safe on disk when this returns.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn append(&mut self, text: &str) -> Result<()> {
        self.file
            .write_all(text.as_bytes())
            .and_then(|()| self.file.sync_data())
            .map_err(|error| Error::file(&self.path, "write", error))
    }
}

impl Drop for AppendFile {
    /// Lets others append at once: a child that is being started has the file open, too, and would
    /// keep them out until it runs its program.
    fn drop(&mut self) {
        // Where this is refused the lock ends with the last who has the file open.
        let _ = fs4::fs_std::FileExt::unlock(&self.file);
    }
}

#[cfg(test)]
mod tests {
    use super::AppendFile;

    #[test]
    fn one_program_appends_and_what_is_torn_is_cut_off() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lines");
        let (mut file, bytes) = AppendFile::open(&path).unwrap().unwrap();
        assert_eq!(bytes, b"");
        file.append("one\ntw").unwrap();
        assert!(AppendFile::open(&path).unwrap().is_none());
        let in_a_child = file.file.try_clone().unwrap();
        drop(file);
        let (mut file, bytes) = AppendFile::open(&path).unwrap().unwrap();
        assert_eq!(bytes, b"one\ntw");
        file.cut(4).unwrap();
        file.append("two\n").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "one\ntwo\n");
        drop(in_a_child);
    }
}
