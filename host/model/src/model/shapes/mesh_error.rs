//! Why a mesh is not drawn.

/// Most bytes of a mesh's file, MB.
pub const MOST_MB: u64 = 64;

/// Why a mesh cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// Nothing where the robot's file says.
    #[error("no such file")]
    Missing,
    /// The system's refusal.
    #[error("cannot be read: {0}")]
    Unread(String),
    /// A file that would make a page too slow.
    #[error("larger than {MOST_MB} MB")]
    TooLarge,
    /// Another format.
    #[error("only STL is read")]
    Format,
    /// Bytes of something else.
    #[error("no STL")]
    NoStl,
    /// A binary file whose length is not what its count says.
    #[error("says {promised} triangles and holds {found} and {more_bytes} bytes")]
    Count {
        /// By its header.
        promised: usize,
        /// Whole ones.
        found: usize,
        /// Behind them.
        more_bytes: usize,
    },
    /// A corner that is not finite, or farther off than 1e6.
    #[error("a corner of triangle {triangle} is no place")]
    Corner {
        /// Counted from 1.
        triangle: usize,
    },
    /// A line of an ASCII file.
    #[error("line {line}: {what}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What it should be.
        what: String,
    },
    /// An ASCII file that stops.
    #[error("ends within a facet")]
    EndsInFacet,
    /// Nothing to draw.
    #[error("has no triangle")]
    Empty,
}
