use super::super::edit::set_values;
use super::super::{LinkField, Model, ParameterPath};
use std::path::{Path, PathBuf};

/// Two hinges across each other, and a slide that carries a gripper.
const URDF: &str = r#"<robot name="crane">
<link name="base"/>
<link name="mast"><inertial><origin xyz="0 0 0.2"/><mass value="2"/>
<inertia ixx="0.02" iyy="0.02" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="boom"><inertial><origin xyz="0.3 0 0"/><mass value="1"/>
<inertia ixx="0.001" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="cart"><inertial><mass value="0.5"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="jaw"><inertial><origin xyz="0 0.1 0"/><mass value="0.1"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slew" type="continuous"><parent link="base"/><child link="mast"/>
<axis xyz="0 0 1"/></joint>
<joint name="luff" type="continuous"><parent link="mast"/><child link="boom"/>
<origin xyz="0 0 0.4"/><axis xyz="0 1 0"/></joint>
<joint name="trolley" type="prismatic"><parent link="boom"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" effort="9" velocity="1"/></joint>
<joint name="grip" type="continuous"><parent link="cart"/><child link="jaw"/>
<axis xyz="1 0 0"/></joint>
</robot>"#;

const MODEL: &str = r#"[rig]
name = "crane"
robot = "crane.urdf"
locked = { grip = 0.5 }

[[joint]]
name = "slew"
drive = "torque"
[[joint]]
name = "luff"
drive = "torque"
[[joint]]
name = "trolley"
drive = "torque"

[log]
time = { column = "t", unit = "s" }
[[log.joint]]
position = { column = "slew", unit = "rad" }
input = { column = "u1", unit = "N m" }
[[log.joint]]
position = { column = "luff", unit = "rad" }
input = { column = "u2", unit = "N m" }
[[log.joint]]
position = { column = "trolley", unit = "m" }
input = { column = "u3", unit = "N" }
"#;

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("crane.urdf"), URDF).unwrap();
    let file = folder.path().join("crane.toml");
    (folder, file)
}

fn refused(text: &str, file: &Path) -> String {
    let error = Model::parse(text, file).unwrap_err();
    format!("{error}; {}", error.remedy().unwrap_or_default())
}

#[test]
fn a_robot_has_the_joints_and_masses_of_its_file() {
    let (_folder, file) = folder();
    let model = Model::parse(MODEL, &file).unwrap();
    assert_eq!(model.link_count(), 3);
    assert!(model.is_in_space() && model.slides());
    assert_eq!(model.joint_name(1), Some("luff"));
    let masses: Vec<f64> = model.links.iter().map(|link| link.mass_kg).collect();
    assert_eq!(masses, [2.0, 1.0, 0.6]);
    assert_eq!(model.links[1].com_m, 0.3);
    assert_eq!(model.links[1].inertia_kg_m2, 0.03);
    assert_eq!(model.gravity_m_s2, 9.81);
    let tree = model.tree().unwrap();
    // The jaw is held at 0.5 rad about x.
    let jaw = nalgebra::Vector3::new(0.0, 0.1 * 0.5f64.cos(), 0.1 * 0.5f64.sin());
    assert!((tree.links[2].com_m - jaw / 6.0).norm() < 1e-12);
}

#[test]
fn the_models_values_take_the_place_of_the_files() {
    let (_folder, file) = folder();
    let links = "[[link]]\nname = \"mast\"\n[[link]]\nname = \"boom\"\nmass_kg = 1.5\n\
                 com_m = 0.6\ninertia_kg_m2 = 0.06\n[[link]]\nname = \"cart\"\n";
    let text = MODEL.replace(
        "[[joint]]\nname = \"slew\"",
        &format!("{links}[[joint]]\nname = \"slew\""),
    );
    let model = Model::parse(&text, &file).unwrap();
    let boom = &model.tree().unwrap().links[1];
    assert_eq!(boom.mass_kg, 1.5);
    assert!((boom.com_m.x - 0.6).abs() < 1e-12);
    let moments = [0, 1, 2].map(|axis| boom.inertia_kg_m2[(axis, axis)]);
    for (found, wanted) in moments.iter().zip([0.002, 0.06, 0.06]) {
        assert!((found - wanted).abs() < 1e-12, "{moments:?}");
    }
    let free = |text: &str| text.parse::<ParameterPath>().unwrap().get(&model);
    assert_eq!(free("link2.mass_kg"), Some(1.5));
    assert_eq!(free("link2.length_m"), None);
    // A fit may find the centre of mass on the other side, and what it writes is read again.
    let behind = Model::parse(&text.replace("com_m = 0.6", "com_m = -0.6"), &file).unwrap();
    assert!((behind.tree().unwrap().links[1].com_m.x + 0.6).abs() < 1e-12);
    let mast = ParameterPath::Link {
        index: 0,
        field: LinkField::Com,
    };
    assert_eq!(mast.get(&model), Some(0.2));
}

/// A file lists the links that differ from the robot's, in any order; a fit lists one more.
#[test]
fn links_are_told_by_their_names() {
    let (_folder, file) = folder();
    let listed = |tables: &str| {
        MODEL.replace(
            "[[joint]]\nname = \"slew\"",
            &format!("{tables}[[joint]]\nname = \"slew\""),
        )
    };
    let masses = |text: &str| {
        let model = Model::parse(text, &file).unwrap();
        [0, 1, 2].map(|index| model.links[index].mass_kg)
    };
    let [mast, boom, cart] = masses(MODEL);
    let text = listed("[[link]]\nname = \"boom\"\nmass_kg = 1.5\n");
    assert_eq!(masses(&text), [mast, 1.5, cart]);
    let both = listed(
        "[[link]]\nname = \"boom\"\nmass_kg = 1.5\n[[link]]\nname = \"mast\"\nmass_kg = 9.0\n",
    );
    assert_eq!(masses(&both), [9.0, 1.5, cart]);

    let set = |text: &str, address: &str, value: f64| {
        let path = address.parse().unwrap();
        set_values(text, &file, &[(path, value)]).unwrap()
    };
    assert_eq!(
        masses(&set(MODEL, "link2.mass_kg", 1.25)),
        [mast, 1.25, cart]
    );
    let inline = MODEL.replace(
        "[rig]",
        "link = [{ name = \"mast\", mass_kg = 8.0 }]\n[rig]",
    );
    assert_eq!(
        masses(&set(&inline, "link3.mass_kg", 0.7)),
        [8.0, boom, 0.7]
    );
    let mut text = set(&text, "link1.mass_kg", 7.0);
    text = set(&text, "link2.mass_kg", 1.75);
    assert_eq!(masses(&text), [7.0, 1.75, cart]);
    assert_eq!(text.matches("[[link]]").count(), 2);

    for (tables, told) in [
        ("[[link]]\nname = \"bom\"\n", "moves a link `bom`"),
        ("[[link]]\nmass_kg = 1.0\n", "lacks `name`"),
        (
            "[[link]]\nname = \"boom\"\n[[link]]\nname = \"boom\"\n",
            "`boom` has another table",
        ),
    ] {
        let found = refused(&listed(tables), &file);
        assert!(found.contains(told), "{told}: {found}");
    }
}

#[test]
fn effects_act_on_the_joints_that_they_name() {
    let (_folder, file) = folder();
    let text = format!(
        "{MODEL}\n[[effect]]\nkind = \"armature\"\njoint = \"luff\"\ninertia_kg_m2 = 0.02\n\
         [[effect]]\nkind = \"mass\"\njoint = 3\nadded_kg = 0.6\n"
    );
    let tree = Model::parse(&text, &file).unwrap().rig(false).tree.unwrap();
    assert_eq!(tree.links[1].armature_kg_m2, 0.02);
    assert!((tree.links[2].mass_kg - 1.2).abs() < 1e-12);
    let before = Model::parse(MODEL, &file).unwrap().tree().unwrap();
    let ratio = tree.links[2].inertia_kg_m2[(0, 0)] / before.links[2].inertia_kg_m2[(0, 0)];
    assert!((ratio - 2.0).abs() < 1e-12);
}

#[test]
fn what_makes_no_robot_is_refused_with_the_remedy() {
    let (_folder, file) = folder();
    let effect = |kind: &str| format!("{MODEL}\n[[effect]]\nkind = \"{kind}\"\nangle_rad = 0.1\n");
    let noted = "robot = \"crane.urdf\"\nrobot_sha256 = \"00\"";
    for (text, told) in [
        (MODEL.replace("crane.urdf", "none.urdf"), "none.urdf"),
        (
            MODEL.replace("robot = \"crane.urdf\"", noted),
            "its SHA-256 is ",
        ),
        (
            MODEL.replace("\"luff\"\ndrive", "\"lift\"\ndrive"),
            "`lift` is not the robot's `luff`",
        ),
        (
            MODEL.replace("locked = { grip = 0.5 }\n", ""),
            "slew, luff, trolley, grip",
        ),
        (
            MODEL.replace("grip = 0.5", "claw = 0.5"),
            "no joint \"claw\"",
        ),
        (
            MODEL.replace(
                "name = \"crane\"",
                "name = \"crane\"\nangle_zero = \"hanging\"",
            ),
            "angle_zero",
        ),
        (
            MODEL.replace(
                "[log]",
                "[log]\npayload = { column = \"m\", unit = \"kg\", at_m = 0.1 }",
            ),
            "lacks `link`",
        ),
        (effect("base_tilt"), "a robot in space"),
        (
            MODEL.replace(
                "input = { column = \"u2\"",
                "gyro = { column = \"g\", unit = \"rad/s\" }\ninput = { column = \"u2\"",
            ),
            "a gyro feels",
        ),
    ] {
        let found = refused(&text, &file);
        assert!(found.contains(told), "{told}: {found}");
        assert!(found.contains("crane.toml:"), "{found}");
    }
    let motor = "\"luff\"\ndrive = \"duty\"\nstall_torque_nm = 200.0\nno_load_speed_rad_s = 1.0";
    let stiff = MODEL
        .replace("\"luff\"\ndrive = \"torque\"", motor)
        .replace("u2\", unit = \"N m\"", "u2\", unit = \"1\"");
    let found = refused(&stiff, &file);
    assert!(
        found.contains("joint `luff`") && found.contains("armature"),
        "{found}"
    );
    let slow = stiff.replace("[rig]", "[rig]\nstep_s = 0.0005");
    assert!(Model::parse(&slow, &file).is_ok());
    let planar = Model::parse(MODEL, &file)
        .unwrap()
        .planar_only("gains hold chains");
    assert!(
        planar
            .unwrap_err()
            .to_string()
            .contains("and gains hold chains")
    );
}

#[test]
fn addresses_name_links_and_joints() {
    let (_folder, file) = folder();
    let links = "[[link]]\nname = \"mast\"\n[[link]]\nname = \"boom\"\nmass_kg = 1.5\n\
                 [[link]]\nname = \"cart\"\n";
    let text = MODEL.replace(
        "[[joint]]\nname = \"slew\"",
        &format!("{links}[[joint]]\nname = \"slew\""),
    ) + "[[effect]]\nkind = \"viscous\"\njoint = \"luff\"\ncoefficient_nm_s_rad = 0.5\n\
         [fit]\nfree = [\"link.boom.mass_kg\", \"viscous@luff.coefficient_nm_s_rad\"]\n\
         [fit.bounds]\n\"link.boom.mass_kg\" = [1.0, 2.0]\n";
    let model = Model::parse(&text, &file).unwrap();
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert_eq!(free, ["link2.mass_kg", "viscous@2.coefficient_nm_s_rad"]);
    assert_eq!(model.free[0].bounds(&model), (1.0, 2.0));
    let read = |text: &str| ParameterPath::read(text, &model);
    assert_eq!(read("link.boom.mass_kg").unwrap(), model.free[0]);
    assert_eq!(read("link2.mass_kg").unwrap(), model.free[0]);
    for (text, told) in [
        ("link.bom.mass_kg", "no link `bom`; did you mean `boom`"),
        ("joint.lift.gain_per_rad", "no joint `lift`"),
        (
            "viscous@lufff.coefficient_nm_s_rad",
            "no joint `lufff`; did you mean `luff`",
        ),
    ] {
        let error = read(text).unwrap_err();
        let found = format!("{error}; {}", error.remedy().unwrap_or_default());
        assert!(found.contains(told), "{found}");
    }
    // What a fit finds is written where the names stand, and bounds are not doubled.
    let values = [(model.free[0], 1.25), (model.free[1], 0.75)];
    let fitted = crate::model::edit::set_values(&text, &file, &values).unwrap();
    assert!(fitted.contains("mass_kg = 1.25"), "{fitted}");
    assert!(
        fitted.contains("joint = \"luff\"\ncoefficient_nm_s_rad = 0.75"),
        "{fitted}"
    );
    let bounds = [(model.free[0], Some((0.5, 3.0)))];
    let bounded = crate::model::edit::set_bounds(&text, &file, &bounds).unwrap();
    let again = Model::parse(&bounded, &file).unwrap();
    assert_eq!(again.bounds, [(model.free[0], (0.5, 3.0))]);
    let twice = text + "\"link2.mass_kg\" = [1.0, 3.0]\n";
    assert!(refused(&twice, &file).contains("link2.mass_kg"));
}

/// An import of the crane with other moments of the boom.
fn imported(moments: &str) -> crate::error::Result<crate::model::import::Imported> {
    let boom = "ixx=\"0.001\" iyy=\"0.03\" izz=\"0.03\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
    let text = URDF.replace(boom, moments);
    assert_ne!(text, URDF);
    let space = Some(crate::model::import::SpacePlan::default());
    let plan = crate::model::import::ImportPlan {
        space,
        ..Default::default()
    };
    crate::model::import::import(&text, Path::new("crane.urdf"), &plan)
}

#[test]
fn moments_that_no_body_has_are_told_with_the_link_and_the_remedy() {
    for (moments, told) in [
        ("ixx=\"0.1\" iyy=\"0.03\" izz=\"0.03\"", "triangle"),
        (
            "ixx=\"0.03\" iyy=\"0.03\" izz=\"0.03\" ixz=\"0.04\"",
            "not all above 0",
        ),
    ] {
        let found = imported(moments).unwrap();
        let note = found.notes[0].to_string();
        assert!(note.starts_with("inertia of boom, line 5: "), "{note}");
        assert!(note.contains(told) && note.contains("in the CAD"), "{note}");
        assert!(
            found.toml.contains("# Note: inertia of boom"),
            "{}",
            found.toml
        );
        assert!(found.left_out.iter().all(|part| part.part != "inertia"));
    }
    assert!(
        imported("ixx=\"0.03\" iyy=\"0.03\" izz=\"0.04\"")
            .unwrap()
            .notes
            .is_empty()
    );
}

/// The boom turns about y: 0.03 there, and less than nothing about an axis between x and z.
#[test]
fn a_moment_below_0_about_its_own_axis_is_refused_in_the_robots_file() {
    let tilted = URDF.replace("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"1 0 -1\"/>");
    let boom = "ixx=\"0.001\" iyy=\"0.03\" izz=\"0.03\" ixy=\"0\" ixz=\"0\"";
    let tilted = tilted.replace(boom, "ixx=\"0.01\" iyy=\"0.03\" izz=\"0.01\" ixz=\"0.04\"");
    let locked = [("grip".to_string(), 0.0)];
    let path = Path::new("crane.urdf");
    let error = crate::model::import::robot_in_space(&tilted, path, &locked);
    let error = error.err().unwrap();
    let found = format!("{error}; {}", error.remedy().unwrap_or_default());
    for told in [
        "crane.urdf:5",
        "the link boom",
        "-3.000e-2 kg m^2",
        "axis of luff",
        "products",
    ] {
        assert!(found.contains(told), "{told}: {found}");
    }
}

#[test]
fn a_payload_sits_at_a_place_of_a_link() {
    let (_folder, file) = folder();
    let with = |rest: &str| {
        let payload = format!("[log]\npayload = {{ column = \"m\", unit = \"kg\", {rest} }}");
        MODEL.replace("[log]", &payload)
    };
    let model = Model::parse(&with("link = \"boom\", at_m = [0.6, 0, -0.1]"), &file).unwrap();
    let place = model.log.payload_on.unwrap();
    assert_eq!((place.link, place.at_m), (1, [0.6, 0.0, -0.1]));
    let mass_kg =
        |payload_kg: f64| model.rig_with(false, payload_kg).tree.unwrap().links[1].mass_kg;
    assert_eq!([mass_kg(0.0), mass_kg(0.25)], [1.0, 1.25]);
    for (rest, wanted) in [
        ("link = \"jib\", at_m = [0, 0, 0]", "mast, boom, cart"),
        ("link = \"boom\", at_m = [0, 0]", "three distances"),
        ("link = \"boom\", at_m = [0, 0, 1e9]", "three distances"),
        ("link = \"boom\"", "at_m"),
    ] {
        let found = refused(&with(rest), &file);
        assert!(found.contains(wanted), "{rest}: {found}");
    }
}
