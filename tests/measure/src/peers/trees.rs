//! Forward dynamics of robots in space, out of URDF files that the peers read too.

use super::median_seconds;
use handstand::Model;
use handstand::dynamics::{SpatialEquations, SpatialWorkspace};
use handstand::model::import::{ImportPlan, SpacePlan, import};
use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;

/// A robot on a fixed base: how many joints each of its limbs has.
#[derive(Debug, Clone, Copy)]
pub struct Limbs {
    /// Its name, and that of its file.
    pub name: &'static str,
    limbs: &'static [usize],
}

/// An arm, a quadruped, and a humanoid with the Bioloid's joints: legs of six, arms of three.
pub const ROBOTS: [Limbs; 3] = [
    Limbs {
        name: "arm",
        limbs: &[6],
    },
    Limbs {
        name: "quadruped",
        limbs: &[3, 3, 3, 3],
    },
    Limbs {
        name: "humanoid",
        limbs: &[6, 6, 3, 3],
    },
];

/// Axes of the joints along a limb, over and over: no two neighbours alike in all limbs.
const AXES: [&str; 6] = ["0 0 1", "1 0 0", "0 1 0", "0 1 0", "0.1 1 0", "1 0 0.2"];

impl Limbs {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.limbs.iter().sum()
    }

    /// Its URDF file's name.
    pub fn file(&self) -> String {
        format!("{}.urdf", self.name)
    }

    /// Its URDF file: links of 0.1 to 0.5 kg, moments of inertia about no axis in particular.
    pub fn urdf(&self) -> String {
        let mut text = format!("<robot name=\"{}\"><link name=\"base\"/>", self.name);
        let mut number = 0;
        for limb in self.limbs {
            let mut parent = "base".to_string();
            for axis in AXES.iter().cycle().take(*limb) {
                let wave = |k: f64| (k * (number + 1) as f64).sin();
                let name = format!("link{number}");
                let _ = write!(
                    text,
                    "<link name=\"{name}\"><inertial><origin xyz=\"{} {} -0.05\" rpy=\"{} 0 {}\"/>\
                     <mass value=\"{}\"/><inertia ixx=\"2e-3\" iyy=\"1.5e-3\" izz=\"1e-3\" \
                     ixy=\"1e-4\" ixz=\"-2e-4\" iyz=\"5e-5\"/></inertial></link>\
                     <joint name=\"joint{number}\" type=\"revolute\"><parent link=\"{parent}\"/>\
                     <child link=\"{name}\"/><origin xyz=\"{} {} -0.1\" rpy=\"{} {} 0\"/>\
                     <axis xyz=\"{axis}\"/>\
                     <limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0\"/></joint>",
                    0.02 * wave(1.0),
                    0.03 * wave(2.0),
                    0.5 * wave(3.0),
                    0.7 * wave(4.0),
                    0.3 + 0.2 * wave(5.0),
                    0.05 * wave(6.0),
                    0.05 * wave(7.0),
                    0.4 * wave(8.0),
                    0.6 * wave(9.0),
                );
                parent = name;
                number += 1;
            }
        }
        text + "</robot>"
    }

    /// Median seconds of one evaluation of its accelerations, in the state of
    /// [`forward_seconds`](super::forward_seconds).
    ///
    /// # Panics
    /// The file that it writes itself cannot be read: a bug.
    pub fn forward_seconds(&self) -> f64 {
        let n = self.joints();
        let equations = SpatialEquations::new(&self.model().rig(false).tree.expect("in space"));
        let mut work = SpatialWorkspace::default();
        let wave = |k: f64| move |i: usize| (k * (i + 1) as f64).sin();
        let mut angle: Vec<f64> = (0..n).map(wave(1.0)).collect();
        let speed: Vec<f64> = (0..n).map(wave(2.0)).collect();
        let torque: Vec<f64> = (0..n).map(wave(3.0)).collect();
        let held = black_box(vec![false; n]);
        let mut out = vec![0.0; n];
        let calls = 300_000 / n;
        let seconds = median_seconds(15, || {
            for _ in 0..calls {
                angle[0] += 1e-9;
                let state = [black_box(&angle), &speed, &torque].map(Vec::as_slice);
                equations.forward(&mut work, state, &held, &mut out);
                black_box(&mut out);
            }
        });
        seconds / calls as f64
    }

    fn model(&self) -> Model {
        let file = self.file();
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path().join(&file);
        std::fs::write(&at, self.urdf()).expect("it is written");
        let locked = Vec::new();
        let plan = ImportPlan {
            space: Some(SpacePlan {
                robot: file.clone(),
                locked,
            }),
            ..ImportPlan::default()
        };
        let imported = import(&self.urdf(), Path::new(&file), &plan).expect("a robot");
        let model = folder.path().join("model.toml");
        Model::parse(&imported.toml, &model).expect("a model of its own file")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_have_the_joints_that_their_rows_name() {
        let joints = ROBOTS.map(|robot| (robot.name, robot.joints(), robot.model().joints.len()));
        let expected = [("arm", 6, 6), ("quadruped", 12, 12), ("humanoid", 18, 18)];
        assert_eq!(joints, expected);
    }
}
