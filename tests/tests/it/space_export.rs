//! Exported robots in space are in Pinocchio and in MuJoCo what they are here, whatever the model
//! changes in them.

use crate::import::Draws;
use crate::simulators::{Case, State, largest_difference, python};
use crate::space::{CRANE, accelerations, mjcf, model, refused, run, urdf};
use handstand::Model;
use handstand::model::export::{NotCarried, robot_file};
use handstand::model::{Drive, Motor};

const TREES: u64 = 100;
const STATES: usize = 3;

/// Changes what a fit may change: links, and of MJCF rotors, damping and drives too.
fn change(model: &mut Model, draws: &mut Draws, is_mjcf: bool) {
    for joint in 0..model.links.len() {
        // Of a body with two joints the first carries nothing.
        if model.links[joint].mass_kg > 0.0 && draws.next() > -0.5 {
            let link = &mut model.links[joint];
            link.mass_kg *= draws.above(0.5, 2.0);
            link.com_m *= draws.above(-1.5, 1.5);
            link.inertia_kg_m2 *= draws.above(0.5, 2.0);
        }
        if is_mjcf {
            model.joints[joint].drive = Drive::Torque;
        }
        if is_mjcf && draws.next() > 0.0 {
            model.add_effect("armature", joint, vec![draws.above(1e-3, 1e-2)]);
            model.add_effect("viscous", joint, vec![draws.above(0.01, 0.1)]);
        }
        if is_mjcf && draws.next() > 0.0 {
            // So strong that no state reaches its limit.
            model.joints[joint].drive = Drive::Position {
                gain_per_rad: draws.above(1e-3, 5e-3),
                motor: Motor {
                    stall_torque_nm: draws.above(500.0, 900.0),
                    no_load_speed_rad_s: draws.above(300.0, 900.0),
                    nominal_supply_v: None,
                },
            };
        }
    }
    if is_mjcf {
        model.gravity_m_s2 = draws.above(1.0, 20.0);
    }
}

/// Accelerations with what acts in MuJoCo while the goals are 0.
fn driven(model: &Model, [q, dq, tau]: &State) -> Vec<f64> {
    let mut torque = tau.clone();
    for (joint, torque) in torque.iter_mut().enumerate() {
        let viscous = (model.effects_at(joint)).find(|e| e.effect.info().id == "viscous");
        *torque -= viscous.map_or(0.0, |effect| effect.values[0]) * dq[joint];
        if let Drive::Position {
            gain_per_rad,
            motor,
        } = &model.joints[joint].drive
        {
            let stall_nm = motor.stall_torque_nm;
            *torque -= stall_nm * gain_per_rad * q[joint];
            *torque -= stall_nm / motor.no_load_speed_rad_s * dq[joint];
        }
    }
    accelerations(model, &[q.clone(), dq.clone(), torque])
}

/// Accelerations of two models differ at most so, as a share.
fn off(own: &Model, other: &Model, states: &[State]) -> f64 {
    let mut worst = 0.0f64;
    for state in states {
        let (own, other) = (driven(own, state), driven(other, state));
        let size = own.iter().fold(1.0, |most: f64, a| most.max(a.abs()));
        let off = own.iter().zip(&other).map(|(a, b)| (a - b).abs() / size);
        worst = off.fold(worst, f64::max);
    }
    worst
}

fn unexpected(missing: &[NotCarried], locked: usize) -> Vec<&NotCarried> {
    // MuJoCo limits the whole torque of a position servo, which is told of each.
    let known = |part: &&NotCarried| part.part != "position";
    let all: Vec<&NotCarried> = missing.iter().filter(known).collect();
    assert!(
        all[..locked]
            .iter()
            .all(|part| part.part.starts_with("lock of "))
    );
    all[locked..].to_vec()
}

#[test]
fn exported_trees_accelerate_in_pinocchio_and_mujoco_as_the_changed_models() {
    let folder = tempfile::tempdir().unwrap();
    let (mut cases, mut models, mut again) = (Vec::new(), Vec::new(), 0.0f64);
    for number in 0..TREES {
        let mut draws = Draws(1000 + number);
        let is_mjcf = number % 2 == 1;
        let ((text, names), format, ending) = if is_mjcf {
            (mjcf(&mut draws), "mjcf", "xml")
        } else {
            (urdf(&mut draws), "urdf", "urdf")
        };
        let at = folder.path().join(number.to_string());
        std::fs::create_dir_all(at.join("new")).unwrap();
        let file = at.join(format!("robot.{ending}"));
        std::fs::write(&file, &text).unwrap();
        // Pinocchio holds joints, too; MuJoCo has them all.
        let held = |_: &&String| !is_mjcf && draws.next() > 0.6;
        let locked: Vec<String> = names[1..].iter().filter(held).cloned().collect();
        let (mut own, joints) = model(&text, &file, &locked);
        let path = at.join("model.toml");
        let unchanged = robot_file(&own, &path, format).unwrap();
        assert_eq!(unchanged.text, text, "{number}");
        change(&mut own, &mut draws, is_mjcf);
        let exported = robot_file(&own, &path, format).unwrap();
        let missing = unexpected(&exported.not_carried, locked.len());
        assert!(missing.is_empty(), "{number}: {missing:?}");
        let file = at.join(format!("new/robot.{ending}"));
        std::fs::write(&file, &exported.text).unwrap();
        let mut many =
            |size: f64| -> Vec<f64> { joints.iter().map(|_| size * draws.next()).collect() };
        let states: Vec<State> = (0..STATES)
            .map(|_| [many(3.0), many(5.0), many(4.0)])
            .collect();
        let (mut fresh, _) = model(&exported.text, &file, &locked);
        if is_mjcf {
            // A joint without a drive has no rotor in a model.
            for effect in own
                .effects
                .iter()
                .filter(|e| e.effect.info().id == "armature")
            {
                let joint = effect.joint.unwrap();
                if !fresh.joints[joint].drive.is_driven() {
                    fresh.add_effect("armature", joint, effect.values.clone());
                }
            }
        }
        again = again.max(off(&own, &fresh, &states));
        assert!(again < 1e-9, "{number}: {again}");
        cases.push(Case {
            file,
            joints,
            states,
        });
        models.push(own);
    }
    let Some(python) = python() else { return };
    let ours = |robot: usize, state: &State| driven(&models[robot], state);
    let worst = largest_difference(&python, &cases, ours);
    println!("{TREES} exported trees: simulators differ by {worst:.1e}, imports by {again:.1e}");
}

/// The export as a user calls it: elsewhere, onto the robot's own file, in the other format.
#[test]
fn a_robot_in_space_is_exported_and_its_own_file_stays() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mesh = "<visual><geometry><mesh filename=\"m/mast.stl\"/></geometry></visual></link>";
    let text = CRANE.replacen("</inertial></link>", &format!("</inertial>{mesh}"), 1);
    std::fs::write(at.join("crane.urdf"), &text).unwrap();
    let import = [
        "import",
        "crane.urdf",
        "--space",
        "--lock",
        "roll=0.3",
        "-o",
        "crane.toml",
    ];
    run(at, &import);
    let export = ["model", "export", "crane.toml", "--to", "urdf"];
    let (_, told) = run(at, &[&export[..], &["-o", "same.urdf"]].concat());
    assert!(!told.contains("m/mast.stl"), "{told}");
    assert_eq!(std::fs::read_to_string(at.join("same.urdf")).unwrap(), text);
    let model = std::fs::read_to_string(at.join("crane.toml")).unwrap();
    let heavier = model.replacen("mass_kg = 0.4\n", "mass_kg = 0.9\n", 1)
        + "[[effect]]\nkind = \"backlash\"\njoint = \"luff\"\ngap_rad = 0.01\n";
    assert!(heavier.contains("0.9"));
    std::fs::write(at.join("heavier.toml"), heavier).unwrap();
    std::fs::create_dir(at.join("new")).unwrap();
    let export = ["model", "export", "heavier.toml", "--to", "urdf", "--json"];
    let (data, told) = run(at, &[&export[..], &["-o", "new/heavier.urdf"]].concat());
    assert!(
        told.contains("not carried: backlash of joint 2 luff (URDF"),
        "{told}"
    );
    assert!(
        told.contains("not carried: lock of roll (it is held at 0.3"),
        "{told}"
    );
    assert!(
        told.contains("m/mast.stl: names relative to the folder of crane.urdf"),
        "{told}"
    );
    assert_eq!(data["not_carried"][1]["joint_name"], "luff");
    assert_eq!(data["relative_files"][0], "m/mast.stl");
    let written = std::fs::read_to_string(at.join("new/heavier.urdf")).unwrap();
    assert_eq!(
        written,
        text.replacen("<mass value=\"0.4\"/>", "<mass value=\"0.9\"/>", 1)
    );
    for (arguments, told) in [
        (
            ["--to", "urdf", "--force", "-o", "crane.urdf"],
            "robot's file that the model starts",
        ),
        (
            ["--to", "urdf", "--force", "-o", "new/../crane.urdf"],
            "robot's file that the model",
        ),
        (
            ["--to", "mjcf", "--force", "-o", "crane.xml"],
            "crane.urdf is URDF, not MJCF",
        ),
    ] {
        let export = ["model", "export", "heavier.toml"];
        let (code, said) = refused(at, &[&export[..], &arguments].concat());
        assert_eq!(code, 2, "{arguments:?}");
        assert!(said.contains(told), "{said}");
    }
    assert_eq!(
        std::fs::read_to_string(at.join("crane.urdf")).unwrap(),
        text
    );
    assert!(!at.join("crane.xml").exists());
}
