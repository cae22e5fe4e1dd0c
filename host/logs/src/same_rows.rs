//! Whether two logs asked for count rows twice: of one file, or of two files of equal content.

use super::request::LogRequest;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Bytes that are compared at a time.
const CHUNK: usize = 1 << 16;

/// Why two logs hold the same rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SameBy {
    /// Both name one file.
    Name,
    /// Their files hold the same bytes.
    Content,
}

impl SameBy {
    /// What a message adds that names both.
    pub fn words(self) -> &'static str {
        match self {
            SameBy::Name => "",
            SameBy::Content => "; the two files hold the same bytes",
        }
    }
}

/// A log asked for, with its file's size: only files of one size are opened to be compared.
pub(super) struct SizedRequest<'a> {
    pub request: &'a LogRequest,
    bytes: Option<u64>,
}

impl<'a> SizedRequest<'a> {
    /// These logs, with the sizes of files that hold something.
    pub fn all(requests: &'a [LogRequest]) -> Vec<SizedRequest<'a>> {
        let bytes = |path: &Path| {
            let facts = path.metadata().ok().filter(std::fs::Metadata::is_file)?;
            Some(facts.len()).filter(|bytes| *bytes > 0)
        };
        let sized = requests.iter().map(|request| SizedRequest {
            request,
            bytes: bytes(&request.path),
        });
        sized.collect()
    }

    /// Why some row of both would count twice, if one would.
    pub fn same(&self, other: &SizedRequest) -> Option<SameBy> {
        let (own, theirs) = (self.request, other.request);
        if !own.rows_meet(theirs) {
            return None;
        }
        if own.is_same_file(theirs) {
            return Some(SameBy::Name);
        }
        let one_size = self.bytes.is_some() && self.bytes == other.bytes;
        (one_size && holds_the_same(&own.path, &theirs.path)).then_some(SameBy::Content)
    }
}

/// Whether two files hold the same bytes; what the system refuses is said where it is read.
fn holds_the_same(path: &Path, other: &Path) -> bool {
    let open = |path: &Path| File::open(path).map(|file| BufReader::with_capacity(CHUNK, file));
    let (Ok(mut own), Ok(mut theirs)) = (open(path), open(other)) else {
        return false;
    };
    loop {
        let (Ok(a), Ok(b)) = (own.fill_buf(), theirs.fill_buf()) else {
            return false;
        };
        let common = a.len().min(b.len());
        if common == 0 {
            return a.is_empty() && b.is_empty();
        }
        if a[..common] != b[..common] {
            return false;
        }
        own.consume(common);
        theirs.consume(common);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_equal_content_are_the_same_rows() {
        let folder = tempfile::tempdir().unwrap();
        let mut long = vec![b'1'; 3 * CHUNK];
        let put = |name: &str, bytes: &[u8]| {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        };
        put("a.csv", &long);
        put("b.csv", &long);
        *long.last_mut().unwrap() = b'2';
        put("c.csv", &long);
        put("d.csv", b"");
        put("e.csv", b"");
        let same = |a: (&str, Option<(usize, usize)>), b: (&str, Option<(usize, usize)>)| {
            let both = [a, b].map(|(name, rows)| LogRequest {
                path: folder.path().join(name),
                rows,
            });
            let sized = SizedRequest::all(&both);
            sized[0].same(&sized[1])
        };
        let by_content = Some(SameBy::Content);
        assert_eq!(same(("a.csv", None), ("b.csv", None)), by_content);
        assert_eq!(same(("a.csv", None), ("a.csv", None)), Some(SameBy::Name));
        assert_eq!(same(("a.csv", None), ("c.csv", None)), None);
        assert_eq!(same(("d.csv", None), ("e.csv", None)), None);
        let cut = |rows| ("b.csv", Some(rows));
        assert_eq!(same(("a.csv", Some((0, 5))), cut((5, 9))), by_content);
        assert_eq!(same(("a.csv", Some((0, 5))), cut((6, 9))), None);
    }
}
