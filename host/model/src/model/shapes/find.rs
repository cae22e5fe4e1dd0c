//! Where the meshes lie that a robot's file names.

use super::mesh::Mesh;
use super::stl::read_stl;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Most bytes of a mesh's file, MB.
const MOST_MB: u64 = 64;
/// Addresses of ROS and Gazebo packages.
const PACKAGES: [&str; 2] = ["package://", "model://"];

/// The mesh of a file, as it is written there, or why it cannot be drawn.
///
/// # Errors
/// No file, one of another format or too large, and what [`read_stl`] refuses.
pub(super) fn mesh(file: &Path) -> Result<Mesh, String> {
    let ending = file.extension().unwrap_or_default();
    if !ending.eq_ignore_ascii_case("stl") {
        return Err("only STL is read".into());
    }
    let unread = |error: std::io::Error| format!("cannot be read: {error}");
    let mut bytes = Vec::new();
    let file = File::open(file).map_err(unread)?;
    let most = MOST_MB * 1_000_000;
    file.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(unread)?;
    if bytes.len() as u64 > most {
        return Err(format!("larger than {MOST_MB} MB"));
    }
    read_stl(&bytes)
}

/// The file that a name stands for in a robot's file; none where there is none.
///
/// A name is relative to the robot's folder, or absolute. The name of a package, as in
/// `package://arm_description/meshes/base.stl`, is that of a folder around the robot's file or
/// beside one of those, or the package itself is one of them.
pub(super) fn file(name: &str, robot: &Path) -> Option<PathBuf> {
    let robot = std::path::absolute(robot).ok()?;
    let folder = robot.parent()?;
    let is_file = |path: &PathBuf| path.is_file();
    if let Some(path) = name.strip_prefix("file://") {
        return Some(PathBuf::from(path)).filter(is_file);
    }
    let Some(within) = PACKAGES.iter().find_map(|begin| name.strip_prefix(begin)) else {
        return Some(folder.join(name)).filter(is_file);
    };
    let (_, without) = within.split_once('/')?;
    let around = folder.ancestors();
    around
        .flat_map(|folder| [folder.join(within), folder.join(without)])
        .find(is_file)
}
