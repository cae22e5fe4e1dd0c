//! A motion as a page that plays it: one file, nothing loaded from elsewhere.

mod packed;
pub mod page;
mod scene;
mod surface;
mod tree;

pub use packed::PackedMesh;
pub use page::html;
pub use page::stage;
pub use scene::{DrawnJoint, DrawnLink, DrawnMotion, Input, Scene, Track, TrackKind};
pub use tree::{DrawnPart, DrawnTree, TreeLink};
