//! What files of real robots hold: switches, limits and figures beyond ours, rounding, vendors'
//! elements.

use super::{imported, refused};
use crate::Model;
use crate::model::import::{ImportPlan, Imported, import};
use crate::model::import::{JointDrives, SpacePlan, import_whole};
use std::path::Path;

/// Two links, the attributes of the second joint's body and joint, and what else is in the file.
fn mjcf(head: &str, body: &str, joint: &str, tail: &str) -> String {
    format!(
        "<mujoco>{head}<worldbody><body name='a'>\n<joint name='j1' axis='0 1 0'/>\
         <geom size='0.05' pos='0 0 -0.3'/>\n<body name='b' pos='0 0 -0.3' {body}>\n\
         <joint name='j2' axis='0 1 0' {joint}/><geom size='0.04' pos='0 0 -0.2'/></body></body>\
         </worldbody>{tail}</mujoco>"
    )
}

fn values(model: &Model, id: &str) -> Vec<f64> {
    let mut found = model.effects.iter().filter(|e| e.effect.info().id == id);
    found.next().map(|e| e.values.clone()).unwrap_or_default()
}

fn kinds(model: &Model) -> Vec<&'static str> {
    let effects = model.effects.iter();
    effects.map(|effect| effect.effect.info().id).collect()
}

/// What is said of a part, with its line.
fn told(imported: &Imported, part: &str) -> Option<(Option<usize>, String)> {
    let mut all = imported.left_out.iter().chain(&imported.notes);
    let found = all.find(|remark| remark.part == part)?;
    Some((found.line, found.why.clone()))
}

#[test]
fn flags_that_switch_forces_off_are_obeyed() {
    let joint = "stiffness='2' damping='0.1' frictionloss='0.2' range='-10 10'";
    let motor = "<actuator><motor joint='j2' ctrlrange='-3 3'/></actuator>";
    let with = |flag: &str| {
        let head = format!("<option><flag {flag}/></option>");
        imported(&mjcf(&head, "", joint, motor), &[])
    };
    let (plain, model) = with("energy='enable'");
    let all = ["viscous", "coulomb", "cable_spring", "torque_saturation"];
    assert_eq!(kinds(&model), all);
    assert_eq!(
        (model.gravity_m_s2, values(&model, "torque_saturation")),
        (9.81, vec![3.0])
    );
    assert!(told(&plain, "range").is_some() && told(&plain, "motor").is_none());
    assert_eq!(with("gravity='disable'").1.gravity_m_s2, 0.0);
    let without = |flag: &str, off: &[&str]| {
        let left: Vec<&str> = all.into_iter().filter(|kind| !off.contains(kind)).collect();
        assert_eq!(kinds(&with(flag).1), left, "{flag}");
    };
    without("spring='disable'", &["cable_spring"]);
    without("damper='disable'", &["viscous"]);
    without("passive='disable'", &["viscous", "cable_spring"]);
    without("frictionloss='disable'", &["coulomb"]);
    without("constraint='disable'", &["coulomb"]);
    without("clampctrl='disable'", &["torque_saturation"]);
    without("actuation='disable'", &["torque_saturation"]);
    let (off, model) = with("actuation='disable'");
    assert_eq!(model.joints[1].drive.name(), "passive");
    assert_eq!(told(&off, "motor").unwrap().0, Some(4));
    assert!(told(&with("limit='disable'").0, "range").is_none());
    assert!(told(&with("hovering='enable'").0, "flag hovering").is_some());
    let head = "<option actuatorgroupdisable='0 2'/>";
    let (_, model) = imported(&mjcf(head, "", "", motor), &[]);
    assert_eq!(model.joints[1].drive.name(), "passive");
}

#[test]
fn a_weight_that_is_borne_is_no_gravity_and_one_borne_in_part_is_told() {
    let all = mjcf("", "gravcomp='1'", "", "").replace("name='a'", "name='a' gravcomp='1'");
    assert_eq!(imported(&all, &[]).1.gravity_m_s2, 0.0);
    // Behind this joint all that moves is borne.
    let (_, model) = imported(&mjcf("", "gravcomp='0.25'", "", ""), &["j2"]);
    assert_eq!(model.gravity_m_s2, 0.75 * 9.81);
    let (part, model) = imported(&mjcf("", "gravcomp='1'", "", ""), &[]);
    assert_eq!(model.gravity_m_s2, 9.81);
    assert_eq!(told(&part, "gravcomp").unwrap().0, Some(3));
    let off = "<option><flag spring='disable' damper='disable'/></option>";
    let (_, model) = imported(&mjcf(off, "gravcomp='1'", "", ""), &["j2"]);
    assert_eq!(model.gravity_m_s2, 9.81, "MuJoCo then bears nothing");
}

#[test]
fn limits_of_torque_act_as_the_file_says() {
    let with = |joint: &str, motor: &str| {
        let tail = format!("<actuator><motor joint='j2' {motor}/></actuator>");
        imported(&mjcf("", "", joint, &tail), &[])
    };
    let limit = |joint: &str, motor: &str| values(&with(joint, motor).1, "torque_saturation");
    assert_eq!(limit("", "forcerange='-0.7 0.7'"), [0.7]);
    assert!(limit("", "forcerange='-0.7 0.7' forcelimited='false'").is_empty());
    assert!(limit("", "ctrlrange='-1 1' ctrllimited='false'").is_empty());
    assert_eq!(
        limit("", "gear='-5' forcerange='-1 1' ctrlrange='-0.5 0.5'"),
        [2.5]
    );
    assert_eq!(
        limit("actuatorfrcrange='-0.4 0.4'", "forcerange='-0.7 0.7'"),
        [0.4]
    );
    let free = "actuatorfrcrange='-0.4 0.4' actuatorfrclimited='false'";
    assert!(limit(free, "").is_empty());
    for (joint, motor, part) in [
        ("", "forcerange='-1 2'", "forcerange"),
        ("", "ctrlrange='0 2'", "ctrlrange"),
        ("actuatorfrcrange='0 2'", "", "actuatorfrcrange"),
        ("", "delay='0.01'", "delay"),
        ("springyield='1'", "", "springyield"),
    ] {
        let (found, model) = with(joint, motor);
        assert!(values(&model, "torque_saturation").is_empty(), "{part}");
        let (line, why) = told(&found, part).unwrap_or_else(|| panic!("{part} is not told"));
        assert_eq!(line, Some(4), "{part}: {why}");
    }
    let (found, _) = with("", "ctrlrange='-1e10 1e10' forcerange='-inf inf'");
    assert_eq!(
        (told(&found, "ctrlrange"), told(&found, "forcerange")),
        (None, None)
    );
    let position = "<actuator><position joint='j2' kp='8' kv='0.5' forcerange='-2 2' \
                    ctrlrange='-1 1'/></actuator>";
    let (found, model) = imported(&mjcf("", "", "actuatorfrcrange='-1 1'", position), &[]);
    assert_eq!(model.joints[1].drive.motor().unwrap().stall_torque_nm, 1.0);
    assert!(told(&found, "ctrlrange").is_some());
}

#[test]
fn a_speed_without_load_that_no_model_has_is_told() {
    let servo = |kv: &str| {
        let tail = format!(
            "\n<actuator><position joint='j2' kp='8' kv='{kv}' forcerange='-2 2'/></actuator>"
        );
        imported(&mjcf("", "", "", &tail), &[])
    };
    let speed = |model: &Model| model.joints[1].drive.motor().unwrap().no_load_speed_rad_s;
    let (found, model) = servo("0.001");
    assert_eq!(speed(&model), f64::INFINITY);
    let (line, why) = told(&found, "speed without load").unwrap();
    assert!(line.is_some() && why.contains("2.0000e3 rad/s"), "{why}");
    // A speed that a model has is kept, and without damping there is none.
    for (kv, kept) in [("0.5", 4.0), ("0", f64::INFINITY)] {
        let (found, model) = servo(kv);
        assert_eq!(speed(&model), kept);
        assert_eq!(told(&found, "speed without load"), None, "{kv}");
    }
}

#[test]
fn what_no_model_has_is_left_out_with_its_place() {
    let joint = "damping='240' frictionloss='12' armature='3' stiffness='180'";
    let motor = "<actuator><motor joint='j2' gear='330' ctrlrange='-1 1'/></actuator>";
    let (found, model) = imported(&mjcf("", "", joint, motor), &[]);
    assert_eq!(
        values(&model, "torque_saturation"),
        [330.0],
        "a real arm's torque"
    );
    for part in ["damping", "frictionloss", "armature", "stiffness"] {
        let (line, why) = told(&found, part).unwrap_or_else(|| panic!("{part} is not told"));
        assert_eq!(line, Some(4), "{part}");
        assert!(why.contains("here has"), "{why}");
    }
    let motor = "<actuator><motor joint='j2' ctrlrange='-3e5 3e5'/></actuator>";
    let (found, model) = imported(&mjcf("", "", "damping='-1'", motor), &[]);
    assert!(kinds(&model).is_empty());
    assert!(told(&found, "ctrlrange").unwrap().1.contains("300000"));
    assert!(told(&found, "damping").is_some());
    let stiff = "<actuator><position joint='j2' kp='9e4' forcerange='-1 1'/></actuator>";
    let (found, model) = imported(&mjcf("", "", "", stiff), &[]);
    assert_eq!(model.joints[1].drive.name(), "torque");
    assert!(told(&found, "actuator").is_some());
    let heavy = mjcf("", "", "", "").replace("size='0.05'", "size='0.05' mass='5000'");
    let said = refused(&heavy, &[]);
    assert!(
        said.contains("robot.xml:1") && said.contains("5.0000e3 kg"),
        "{said}"
    );
}

#[test]
fn what_the_chain_does_not_need_refuses_nothing() {
    let broken = "<body name='c'><inertial mass='1' diaginertia='-1 1 1' pos='0 0 0'/>\
                  <joint name='k' axis='0 0 0'/><geom type='mesh' mesh='m'/></body>";
    let text = mjcf("", "", "", "<actuator><motor joint='none'/></actuator>")
        .replace("<worldbody>", &format!("<worldbody>{broken}"));
    let (found, _) = imported(&text, &["j1", "j2"]);
    assert!(told(&found, "motor").unwrap().1.contains("no joint"));
    assert!(refused(&text, &["k"]).contains("length 0"));
    let text = text.replace("axis='0 0 0'", "");
    assert!(refused(&text, &["k"]).contains("below 0"));
    let huge = mjcf("", "", "range='-1e10 1e300' limited='true'", "");
    assert!(told(&imported(&huge, &[]).0, "range").is_some());
}

#[test]
fn a_mesh_leads_out_by_a_setting_that_writes_its_mass() {
    let text = mjcf("", "", "", "").replace("size='0.04'", "type='mesh' mesh='m' mass='0.2'");
    let plan = ImportPlan::default();
    let error = import(&text, Path::new("robot.xml"), &plan).unwrap_err();
    assert!(error.to_string().contains("has the mass, not its centre"));
    assert!(error.remedy().unwrap().contains("saveinertial=\"true\""));
    let fitted = text.replace("type='mesh'", "type='box'");
    assert!(refused(&fitted, &[]).contains("mesh"), "a box fitted to it");
    for light in ["mass='0'", "density='0'"] {
        let visual = "<geom type='mesh' mesh='m' MASS/><geom size='0.04'";
        let text =
            mjcf("", "", "", "").replace("<geom size='0.04'", &visual.replace("MASS", light));
        imported(&text, &[]);
    }
}

#[test]
fn shapes_take_the_sizes_that_they_have() {
    let of = |shape: &str| {
        let text = mjcf("", "", "", "").replace("size='0.04'", shape);
        imported(&text, &[]).1.links[1].mass_kg
    };
    assert_eq!(of("size='0.04 0 0'"), of("size='0.04'"));
    for kind in ["capsule", "cylinder"] {
        let short = of(&format!("type='{kind}' size='0.02 0.1'"));
        assert_eq!(of(&format!("type='{kind}' size='0.02 0.1 0'")), short);
    }
    let text = mjcf("", "", "", "").replace("size='0.04'", "type='box' size='0.04 0 0.1'");
    assert!(refused(&text, &[]).contains("no size"));
}

#[test]
fn compilers_settings_of_masses_are_obeyed() {
    let mass = |head: &str, geom: &str| {
        let text = mjcf(head, "", "", "").replace("size='0.04'", geom);
        let model = imported(&text, &[]).1;
        (model.links[1].mass_kg, model.links[1].inertia_kg_m2)
    };
    let groups = "<compiler inertiagrouprange='1 2'/>";
    let both = "size='0.04' group='1'/><geom type='mesh' group='0' mesh='m'";
    let text = mjcf(groups, "", "", "").replace("size='0.04'", both);
    let text = text.replace("size='0.05'", "size='0.05' group='2'");
    assert_eq!(
        imported(&text, &[]).1.links[1].mass_kg,
        mass("", "size='0.04'").0
    );
    let bounds = "<compiler boundmass='2' boundinertia='0.5'/>";
    assert_eq!(mass(bounds, "size='0.04'"), (2.0, 0.5));
}

const ARM: &str = r#"<robot name="r"><link name="base"/>
<joint name="pan" type="revolute"><parent link="base"/><child link="p"/><axis xyz="0 0 1"/><limit lower="-1e+16" upper="inf" effort="330" velocity="inf"/></joint>
<link name="p"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>
<joint name="lift" type="revolute"><parent link="p"/><child link="l"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="330" velocity="3"/></joint>
<link name="l"><inertial><origin xyz="0 0 -0.1"/><mass value="1"/><inertia ixx="0.01" iyy="-5.42101e-20" izz="0.01"/></inertial></link>
<joint name="elbow" type="revolute"><parent link="l"/><child link="e"/><origin xyz="0 0 -0.3" rpy="1.5708 0 0"/><axis xyz="0 0 -1"/><limit effort="1e16"/></joint>
<link name="e"><inertial><origin xyz="0 0.1 0"/><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.01"/></inertial></link>
</robot>"#;

#[test]
fn a_robot_that_is_not_planar_is_refused_with_the_joints_that_are() {
    let error = import(ARM, Path::new("arm.urdf"), &ImportPlan::default()).unwrap_err();
    let remedy = error.remedy().unwrap();
    assert!(error.to_string().contains("90.0 degrees"), "{error}");
    assert!(
        remedy.ends_with("parallel axes: --joints lift elbow"),
        "{remedy}"
    );
    let spaced = ARM.replace("\"elbow\"", "\"el bow\"");
    let error = import(&spaced, Path::new("arm.urdf"), &ImportPlan::default()).unwrap_err();
    assert!(error.remedy().unwrap().ends_with("--joints lift 'el bow'"));
}

#[test]
fn rounded_axes_are_parallel_and_the_rounding_is_told() {
    let (found, model) = imported(ARM, &["lift", "elbow"]);
    let (_, why) = told(&found, "axes").unwrap();
    assert!(why.contains("3.67e-6 rad"), "{why}");
    assert!(found.toml.contains("# Note: axes"), "{}", found.toml);
    assert_eq!(values(&model, "torque_saturation"), [330.0]);
    assert_eq!(model.joints[1].drive.name(), "torque");
    let coarse = ARM.replace("1.5708", "1.57");
    assert!(told(&imported(&coarse, &["lift", "elbow"]).0, "axes").is_some());
    let off = ARM.replace("1.5708", "1.5668");
    assert!(refused(&off, &["lift", "elbow"]).contains("4.00e-3 rad"));
    let exact = ARM.replace("1.5708", "1.5707963267948966");
    assert_eq!(told(&imported(&exact, &["lift", "elbow"]).0, "axes"), None);
    // The limit of 1e16 N m is none.
    assert_eq!(told(&found, "effort"), None);
}

#[test]
fn impossible_moments_are_told_and_negative_ones_refused() {
    let (found, _) = imported(ARM, &["lift", "elbow"]);
    let (line, why) = told(&found, "inertia").unwrap();
    assert!(why.contains("triangle") && line == Some(7), "{why}");
    let indefinite = ARM.replace(
        "izz=\"0.01\"/></inertial></link>\n</robot>",
        "izz=\"0.01\" ixz=\"1\"/></inertial></link>\n</robot>",
    );
    let (found, _) = imported(&indefinite, &["lift", "elbow"]);
    assert!(
        told(&found, "inertia")
            .unwrap()
            .1
            .contains("not all above 0")
    );
    let negative = ARM.replace("-5.42101e-20", "-1e-3");
    assert!(refused(&negative, &["lift"]).contains("robot.xml:5"));
}

#[test]
fn a_link_without_mass_is_named() {
    let bare = ARM.replace(
        "<link name=\"l\"><inertial>",
        "<link name=\"l\"/><link name=\"m\"><inertial>",
    );
    let bare = bare.replace("</robot>", "<joint name=\"fix\" type=\"fixed\"><parent link=\"base\"/><child link=\"m\"/></joint></robot>");
    let said = refused(&bare, &["lift", "elbow"]);
    assert!(
        said.contains("the link l, which joint lift moves, has no mass"),
        "{said}"
    );
    assert!(said.starts_with("robot.xml:5"), "{said}");
    imported(&bare, &["elbow"]);
}

#[test]
fn only_the_namespace_of_xacro_is_xacro() {
    for address in ["http://www.ros.org", "https://drake.mit.edu"] {
        let text = ARM.replace("<robot ", &format!("<robot xmlns=\"{address}\" "));
        assert_eq!(imported(&text, &["lift", "elbow"]).0.joints.len(), 2);
    }
    let vendors = ARM.replace("<robot ", "<robot xmlns:drake=\"https://drake.mit.edu\" ");
    let vendors = vendors
        .replace("</robot>", "<drake:link name='base'/>\n</robot>")
        .replace("<limit effort=\"1e16\"/>", "<drake:gear_ratio value='3'/>");
    let (found, _) = imported(&vendors, &["lift", "elbow"]);
    assert_eq!(told(&found, "link").unwrap().0, Some(8));
    assert_eq!(told(&found, "gear_ratio").unwrap().0, Some(6));
    // Old files use prefixes that nothing declares.
    let undeclared = vendors.replace(" xmlns:drake=\"https://drake.mit.edu\"", "");
    let (found, _) = imported(&undeclared, &["lift", "elbow"]);
    assert_eq!(told(&found, "link").unwrap().0, Some(8));
    assert_eq!(told(&found, "gear_ratio").unwrap().0, Some(6));
    let undeclared = ARM.replace("<limit effort=\"1e16\"/>", "<xacro:limits/>");
    assert!(refused(&undeclared, &["lift", "elbow"]).contains("<xacro:limits>"));
    let doctype = ARM.replacen("<robot ", "<!DOCTYPE robot>\n<robot ", 1);
    let error = import(&doctype, Path::new("r.urdf"), &ImportPlan::default()).unwrap_err();
    assert!(error.remedy().unwrap().contains("delete the <!DOCTYPE"));
    let xacro = ARM.replace(
        "<robot ",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" ",
    );
    imported(&xacro, &["lift", "elbow"]);
    let inner = xacro.replace("<limit effort=\"1e16\"/>", "<xacro:limits/>");
    assert!(refused(&inner, &["lift", "elbow"]).contains("<xacro:limits>"));
    let property = ARM.replace("xyz=\"0 0 -0.3\"", "xyz=\"${length} 0 0\"");
    assert!(refused(&property, &["lift", "elbow"]).contains("property of xacro"));
}

fn whole(text: &str, locked: &[(&str, f64)]) -> Imported {
    let locked = locked.iter().map(|(name, at)| (name.to_string(), *at));
    let space = SpacePlan {
        robot: "arm.urdf".into(),
        locked: locked.collect(),
    };
    import_whole(text, Path::new("arm.urdf"), JointDrives::OfFile, &space).unwrap()
}

#[test]
fn a_whole_robot_is_a_planar_chain_where_its_joints_make_one() {
    let found = whole(ARM, &[]);
    assert!(found.in_space, "{}", found.toml);
    assert_eq!(found.joints, ["pan", "lift", "elbow"]);
    let note = found.notes.iter().find(|note| note.part == "robot");
    let why = &note.unwrap().why;
    assert!(
        why.contains("--joints lift elbow takes a planar chain"),
        "{why}"
    );
    let planar = ARM.replace("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>");
    let chain = whole(&planar, &[]);
    assert!(!chain.in_space, "{}", chain.toml);
    let plan = ImportPlan {
        joints: ["pan", "lift", "elbow"].map(String::from).to_vec(),
        ..ImportPlan::default()
    };
    let named = import(&planar, Path::new("arm.urdf"), &plan).unwrap();
    assert_eq!(chain, named);
    // What is held, follows another, or branches off is known in space alone.
    assert!(whole(&planar, &[("elbow", 0.3)]).in_space);
    let lift = "<joint name=\"lift\" type=\"revolute\">";
    let follows = planar.replace(lift, &format!("{lift}<mimic joint=\"pan\"/>"));
    assert_eq!(whole(&follows, &[]).joints, ["pan", "elbow"]);
    let branch = planar.replace("<parent link=\"l\"/>", "<parent link=\"p\"/>");
    assert!(whole(&branch, &[]).in_space);
}
