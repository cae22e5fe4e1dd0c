//! A crane as URDF and as MJCF, for the tests of exports.

use super::robot_file;
use crate::model::Model;
use crate::model::export::NotCarried;
use crate::model::import::{ImportPlan, JointDrives, SpacePlan, import};
use std::path::{Path, PathBuf};

/// A mast, a boom with a fixed counterweight, a cart that slides and a jaw that is locked; a prefix
/// of a vendor's that is not declared, comments, and ends of lines of both kinds.
pub const URDF: &str = "\u{feff}<?xml version=\"1.0\"?>\r\n\
<robot name=\"crane\">\n<!-- base & all -->
<link name=\"base\"/><acme:tag x='1'/>
<link name=\"mast\"><inertial><origin xyz=\"0 0.01 0.2\" rpy=\"0.1 0 0\"/><mass value=\"2\"/>
  <inertia ixx=\"0.02\" iyy=\"0.02\" izz=\"0.004\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>
  <visual><geometry><mesh filename=\"meshes/mast.stl\"/></geometry></visual></link>
<link name=\"boom\"><inertial>
  <origin rpy=\"0 0.3 0\" xyz=\"0.3 0 0\"/>
  <mass value='1'/> <!-- weighed -->
  <inertia ixx=\"0.001\" iyy=\"0.03\" izz=\"0.03\" ixy=\"1e-4\" ixz=\"0\" iyz=\"0\"/>
  </inertial></link>
<link name=\"weight\"><inertial><mass value=\"0.4\"/>
  <inertia ixx=\"1e-3\" iyy=\"1e-3\" izz=\"1e-3\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>
<link name=\"cart\"><inertial><mass value=\"0.5\"/>
  <inertia ixx=\"0.001\" iyy=\"0.001\" izz=\"0.001\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>
  </inertial></link>
<link name=\"jaw\"><inertial><origin xyz=\"0 0.1 0\"/><mass value=\"0.1\"/>
  <inertia ixx=\"1e-4\" iyy=\"2e-4\" izz=\"1e-4\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>
<joint name=\"slew\" type=\"continuous\"><parent link=\"base\"/><child link=\"mast\"/>
  <axis xyz=\"0 0 1\"/><dynamics friction=\"0.2\"/></joint>
<joint name=\"luff\" type=\"continuous\">
  <parent link=\"mast\"/><child link=\"boom\"/><origin xyz=\"0 0 0.4\"/><axis xyz=\"0 1 0.2\"/>
</joint>
<joint name=\"back\" type=\"fixed\"><parent link=\"boom\"/><child link=\"weight\"/>
  <origin xyz=\"-0.2 0.02 0\" rpy=\"0.4 0.1 1\"/></joint>
<joint name=\"trolley\" type=\"prismatic\"><parent link=\"boom\"/><child link=\"cart\"/>
  <axis xyz=\"1 0 0\"/><limit lower=\"0\" upper=\"1\" effort=\"9\" velocity=\"0\"/></joint>
<joint name=\"grip\" type=\"continuous\"><parent link=\"cart\"/><child link=\"jaw\"/>
  <origin xyz=\"0 0 -0.1\" rpy=\"0.3 0 0\"/><axis xyz=\"1 0 0\"/></joint>
</robot>\n";

/// Masses given in three ways, classes, degrees, a body with two joints, actuators of every kind.
pub const MJCF: &str = "<mujoco model=\"crane\">
  <option gravity=\"0 0.5 -9.7\"/>
  <default><joint damping=\"0.1\"/><default class=\"arm\"><position kp=\"8\" forcerange=\"-2 2\"/>
  </default></default>
  <worldbody><body name=\"mast\"><joint name=\"slew\" axis=\"0 0 1\" armature=\"0.01\"/>
    <inertial mass=\"2\" pos=\"0 0.02 0.2\" diaginertia=\"0.02 0.02 0.01\" euler=\"10 20 0\"/>
    <body name=\"boom\" pos=\"0 0 0.4\" euler=\"0 0 20\">
      <joint name=\"luff\" axis=\"0 1 0\" stiffness=\"2\" springref=\"10\" frictionloss=\"0.1\"/>
      <joint name=\"roll\" axis=\"1 0 0\" pos=\"0 0 0.01\"/>
      <!-- of its shapes -->
      <geom type=\"capsule\" fromto=\"0 0 0 0.5 0 0\" size=\"0.02\"/>
      <body name=\"cart\" pos=\"0.3 0 0\"><joint name=\"trolley\" type=\"slide\" axis=\"1 0 0\"/>
        <inertial mass=\"0.5\" pos=\"0 0 0\" fullinertia=\"2e-3 2e-3 2e-3 1e-4 0 0\"/>
        <body name=\"jaw\" pos=\"0 0.1 0\"><geom type=\"box\" size=\".02 .03 .04\" mass=\".1\"/>
        </body></body></body></body></worldbody>
  <actuator>
    <position name=\"a\" joint=\"slew\" class=\"arm\" kv=\"0.5\"/>
    <velocity name='b' joint='luff' kv='0.4' forcerange='-3 3'/>
    <general joint=\"trolley\" gainprm=\"5\" biastype=\"affine\" biasprm=\"0 0 -2\"
      ctrlrange=\"-1 1\"/>
  </actuator>
</mujoco>";

/// A folder with the robot and the model that an import makes of it.
pub struct Crane {
    folder: tempfile::TempDir,
    toml: String,
    format: &'static str,
    driven: bool,
}

impl Crane {
    pub fn of(text: &str, locked: &[(&str, f64)], driven: bool) -> Crane {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("crane.xml"), text).unwrap();
        let (toml, format) = imported(text, locked, driven);
        Crane {
            folder,
            toml,
            format,
            driven,
        }
    }

    pub fn path(&self) -> PathBuf {
        self.folder.path().join("crane.toml")
    }

    pub fn model(&self) -> Model {
        Model::parse(&self.toml, &self.path()).unwrap()
    }

    /// What a model of this file is exported as, and a fresh import of that.
    pub fn exported(&self, model: &Model) -> (String, Vec<NotCarried>, Model) {
        let exported = robot_file(model, &self.path(), self.format).unwrap();
        let robot = model.robot.as_ref().unwrap();
        let locked: Vec<(&str, f64)> = (robot.locked.iter())
            .map(|(name, at)| (name.as_str(), *at))
            .collect();
        let (toml, _) = imported(&exported.text, &locked, self.driven);
        let other = self.folder.path().join("other");
        std::fs::create_dir_all(&other).unwrap();
        std::fs::write(other.join("crane.xml"), &exported.text).unwrap();
        let read = Model::parse(&toml, &other.join("crane.toml")).unwrap();
        (exported.text, exported.not_carried, read)
    }
}

fn imported(text: &str, locked: &[(&str, f64)], driven: bool) -> (String, &'static str) {
    let locked = locked.iter().map(|(name, at)| (name.to_string(), *at));
    let plan = ImportPlan {
        drives: if driven {
            JointDrives::OrTorque
        } else {
            JointDrives::OfFile
        },
        space: Some(SpacePlan {
            robot: "crane.xml".into(),
            locked: locked.collect(),
        }),
        ..ImportPlan::default()
    };
    let imported = import(text, Path::new("crane.xml"), &plan).unwrap();
    (imported.toml, imported.format)
}
