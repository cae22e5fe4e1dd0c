//! How do other simulators get a model? MJCF for MuJoCo, URDF for the rest; a robot in space in its
//! own file's format.
//!
//! What a format cannot say is listed with the reason, never left out silently.

mod carried;
mod in_space;
mod mjcf;
mod urdf;
mod xml;

pub use carried::NotCarried;
pub use in_space::robot_file;
pub use mjcf::mjcf;
pub use urdf::urdf;

/// A model in another program's format.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// The file's text.
    pub text: String,
    /// What of the model the text does not hold.
    pub not_carried: Vec<NotCarried>,
    /// Files of meshes and the like that the text names, relative to where it is.
    pub relative_files: Vec<String>,
}
