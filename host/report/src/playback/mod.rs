//! A motion as a page that plays it: one file, nothing loaded from elsewhere.

pub mod page;
mod scene;

pub use page::html;
pub use page::stage;
pub use scene::{DrawnLink, DrawnMotion, Input, Scene, Track, TrackKind};
