//! Imported robots accelerate as in Pinocchio and in MuJoCo.
//!
//! The robots are drawn: axes and frames turned in space, centres of mass beside the plane, joints
//! that count either way, links of several fixed bodies, branches.

use crate::simulators::{Case, largest_difference, python};
use handstand::Model;
use handstand::dynamics::Workspace;
use handstand::model::import::{ImportPlan, JointDrives, import};
use std::fmt::Write as _;
use std::path::Path;

const ROBOTS: u64 = 24;
/// More of them whose joints may slide.
const SLIDING: u64 = 24;
const STATES: usize = 10;

/// Splitmix64: numbers between -1 and 1.
pub(crate) struct Draws(pub u64);

impl Draws {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn above(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.next() + 1.0)
    }

    pub fn three(&mut self, size: f64) -> String {
        format!(
            "{} {} {}",
            size * self.next(),
            size * self.next(),
            size * self.next()
        )
    }
}

fn joints(draws: &mut Draws) -> usize {
    1 + (draws.above(0.0, 3.999) as usize)
}

/// A turn about x, the axis of all joints, so that frames differ and axes stay parallel. Joints may
/// slide across that axis where `slides` says so.
fn urdf(draws: &mut Draws, slides: bool) -> (String, Vec<String>) {
    let count = joints(draws);
    let mut text = String::from("<robot name=\"drawn\"><link name=\"base\"/>");
    let link = |text: &mut String, name: &str, draws: &mut Draws| {
        let (xx, yy, zz) = (
            draws.above(1e-3, 2e-3),
            draws.above(1e-3, 2e-3),
            draws.above(1e-3, 2e-3),
        );
        let _ = write!(
            text,
            "<link name=\"{name}\"><inertial><origin xyz=\"{}\" rpy=\"{}\"/><mass value=\"{}\"/>\
             <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"1e-4\" ixz=\"-2e-4\" iyz=\"{}\"/>\
             </inertial></link>",
            draws.three(0.2),
            draws.three(1.0),
            draws.above(0.1, 1.0),
            1e-4 * draws.next(),
        );
    };
    let joint = |text: &mut String,
                 kind: &str,
                 name: &str,
                 [parent, child]: [&str; 2],
                 axis: &str,
                 rpy: &str,
                 draws: &mut Draws| {
        let _ = write!(
            text,
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0\"/></joint>",
            draws.three(0.4)
        );
    };
    // The whole robot may lean, so gravity acts in part along the axes.
    link(&mut text, "stand", draws);
    let lean = draws.three(0.5);
    joint(
        &mut text,
        "fixed",
        "stand_joint",
        ["base", "stand"],
        "1 0 0",
        &lean,
        draws,
    );
    let mut parent = "stand".to_string();
    let mut names = Vec::new();
    for index in 0..count {
        let child = format!("link{index}");
        link(&mut text, &child, draws);
        let axis = if draws.next() > 0.0 {
            "2 0 0"
        } else {
            "-1 0 0"
        };
        let kind = if draws.next() > 0.0 {
            "continuous"
        } else {
            "revolute"
        };
        let across = format!("0 {} {}", draws.next(), draws.next() + 1.5);
        let (axis, kind) = if slides && draws.next() > 0.0 {
            (across.as_str(), "prismatic")
        } else {
            (axis, kind)
        };
        let turn = format!("{} 0 0", 3.0 * draws.next());
        joint(
            &mut text,
            kind,
            &format!("joint{index}"),
            [&parent, &child],
            axis,
            &turn,
            draws,
        );
        names.push(format!("joint{index}"));
        if draws.next() > 0.0 {
            // A tool that is fixed, and a joint across the plane that is held.
            let (tool, wing) = (format!("tool{index}"), format!("wing{index}"));
            link(&mut text, &tool, draws);
            link(&mut text, &wing, draws);
            let turn = draws.three(3.0);
            joint(
                &mut text,
                "fixed",
                &format!("grip{index}"),
                [&child, &tool],
                "1 0 0",
                &turn,
                draws,
            );
            joint(
                &mut text,
                "continuous",
                &format!("flap{index}"),
                [&tool, &wing],
                "0 1 0",
                &turn,
                draws,
            );
        }
        parent = child;
    }
    (text + "</robot>", names)
}

fn mjcf(draws: &mut Draws, slides: bool) -> (String, Vec<String>) {
    let count = joints(draws);
    let mut text = format!(
        "<mujoco><compiler angle=\"degree\" eulerseq=\"zyx\"/><option gravity=\"{}\"><flag contact=\"disable\"/></option>\
         <default><geom density=\"700\"/><default class=\"arm\"><joint damping=\"0.05\"/></default></default>\
         <worldbody><body euler=\"{}\" childclass=\"arm\"><geom size=\"0.1\"/>",
        draws.three(9.81),
        draws.three(90.0)
    );
    let mut names = Vec::new();
    for index in 0..count {
        let axis = if draws.next() > 0.0 {
            "0 1 0"
        } else {
            "0 -3 0"
        };
        let across = format!("{} 0 {}\" type=\"slide", draws.next(), draws.next() + 1.5);
        // Degrees, or metres.
        let (axis, most) = if slides && draws.next() > 0.0 {
            (across.as_str(), 0.3)
        } else {
            (axis, 20.0)
        };
        let shape = match index % 4 {
            0 => format!(
                "<geom type=\"capsule\" size=\"0.03\" fromto=\"{} {}\"/>",
                draws.three(0.3),
                draws.three(0.3)
            ),
            1 => format!(
                "<geom type=\"box\" size=\"0.03 0.05 0.1\" pos=\"{}\" axisangle=\"1 2 3 {}\"/>",
                draws.three(0.2),
                50.0 * draws.next()
            ),
            2 => format!(
                "<geom type=\"cylinder\" size=\"0.04 0.1\" mass=\"0.4\" pos=\"{}\" zaxis=\"{}\"/>",
                draws.three(0.2),
                draws.three(1.0)
            ),
            _ => format!(
                "<inertial mass=\"0.5\" pos=\"{}\" fullinertia=\"2e-3 2e-3 2e-3 1e-4 2e-4 -3e-4\"/>",
                draws.three(0.2)
            ),
        };
        let _ = write!(
            text,
            "<body pos=\"{}\" quat=\"{1} 0 {2} 0\"><joint name=\"joint{index}\" axis=\"{axis}\" pos=\"{3}\" \
             ref=\"{4}\" stiffness=\"{5}\" springref=\"{6}\" armature=\"{7}\"/>{shape}\
             <body pos=\"{8}\" xyaxes=\"1 2 0 0 1 1\"><geom type=\"ellipsoid\" size=\"0.02 0.03 0.05\"/></body>",
            draws.three(0.4),
            draws.next(),
            draws.next() + 1.5,
            draws.three(0.1),
            most * draws.next(),
            draws.above(0.1, 2.0),
            most * draws.next(),
            draws.above(0.001, 0.01),
            draws.three(0.2),
        );
        names.push(format!("joint{index}"));
    }
    text += &"</body>".repeat(count + 1);
    (text + "</worldbody></mujoco>", names)
}

/// Accelerations in the file's coordinates.
fn accelerations(model: &Model, q: &[f64], dq: &[f64], tau: &[f64]) -> Vec<f64> {
    let rig = model.rig(false);
    let count = q.len();
    let column = |joint: usize| &model.log.joints[joint].position.as_ref().unwrap().columns()[0];
    let sign = |joint: usize| if column(joint).reversed { -1.0 } else { 1.0 };
    let angle: Vec<f64> = (0..count)
        .map(|joint| column(joint).to_si(q[joint]))
        .collect();
    let speed: Vec<f64> = (0..count).map(|joint| sign(joint) * dq[joint]).collect();
    let mut torque: Vec<f64> = (0..count).map(|joint| sign(joint) * tau[joint]).collect();
    for effect in &model.effects {
        let joint = effect.joint.unwrap();
        match (effect.effect.info().id, effect.values.as_slice()) {
            ("viscous", [damping]) => torque[joint] -= damping * speed[joint],
            ("cable_spring", [stiffness, rest]) => {
                torque[joint] -= stiffness * (angle[joint] - rest)
            }
            ("com_angle" | "armature", _) => {}
            (other, _) => panic!("{other} was not in the file"),
        }
    }
    let mut out = vec![0.0; count];
    let mut work = Workspace::new(count);
    let base = rig.chain.base_m_s2(rig.gravity_turn_rad);
    rig.chain.forward(
        &mut work,
        base,
        &angle,
        &speed,
        &torque,
        &vec![false; count],
        &mut out,
    );
    (0..count).map(|joint| sign(joint) * out[joint]).collect()
}

#[test]
fn imported_robots_accelerate_as_in_pinocchio_and_mujoco() {
    let Some(python) = python() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (mut cases, mut models, mut compared) = (Vec::new(), Vec::new(), [0, 0]);
    let mut slides = 0;
    for robot in 0..ROBOTS + SLIDING {
        let mut draws = Draws(robot);
        let may_slide = robot >= ROBOTS;
        let (text, names) = match robot % 2 {
            0 => urdf(&mut draws, may_slide),
            _ => mjcf(&mut draws, may_slide),
        };
        let ending = ["urdf", "xml"][robot as usize % 2];
        let file = folder.path().join(format!("{robot}.{ending}"));
        std::fs::write(&file, &text).unwrap();
        let plan = ImportPlan {
            joints: names.clone(),
            // A rotor needs a drive.
            drives: JointDrives::OrTorque,
            space: None,
        };
        let imported =
            import(&text, &file, &plan).unwrap_or_else(|error| panic!("{robot}: {error}\n{text}"));
        let held: Vec<&str> = imported
            .left_out
            .iter()
            .map(|part| part.part.as_str())
            .collect();
        assert!(
            !held.contains(&"stiffness") && !held.contains(&"armature"),
            "{held:?}"
        );
        let model = Model::parse(&imported.toml, Path::new("imported.toml")).unwrap();
        slides += model
            .joints
            .iter()
            .filter(|joint| joint.slide.is_some())
            .count();
        let mut many =
            |size: f64| -> Vec<f64> { names.iter().map(|_| size * draws.next()).collect() };
        let states = (0..STATES).map(|_| [many(3.0), many(5.0), many(4.0)]);
        let states = states.collect();
        cases.push(Case {
            file,
            joints: names,
            states,
        });
        models.push(model);
        compared[robot as usize % 2] += 1;
    }
    let worst = largest_difference(&python, &cases, |robot, [q, dq, tau]| {
        accelerations(&models[robot], q, dq, tau)
    });
    println!(
        "{} by Pinocchio, {} by MuJoCo, largest difference {worst:.1e}",
        compared[0], compared[1]
    );
    assert_eq!(compared.iter().sum::<u64>(), ROBOTS + SLIDING);
    assert!(slides > 20, "{slides} joints slide");
}
