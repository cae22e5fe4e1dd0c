use super::*;
use crate::model::import::{ImportPlan, JointDrives, SpacePlan, import};
use crate::model::shapes::{Mesh, NotDrawn};
use crate::playback::{Scene, html};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::path::Path;

/// A shoulder of two hinges at one place, an arm that slides out, two fingers.
const ROBOT: &str = r#"<robot name="fork"><link name="base"/>
<link name="cross"><inertial><mass value="0.01"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6"/></inertial></link>
<link name="arm"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
<inertia ixx="1e-4" iyy="1e-2" izz="1e-2"/></inertial></link>
<link name="hand"><inertial><origin xyz="0.05 0 0"/><mass value="0.2"/>
<inertia ixx="1e-5" iyy="1e-5" izz="1e-5"/></inertial></link>
<link name="left"><inertial><origin xyz="0.03 0 0"/><mass value="0.03"/>
<inertia ixx="1e-9" iyy="9e-6" izz="9e-6"/></inertial></link>
<link name="right"><inertial><mass value="0.03"/>
<inertia ixx="9e-6" iyy="1e-9" izz="9e-6"/></inertial></link>
<joint name="pan" type="continuous"><parent link="base"/><child link="cross"/>
<origin xyz="0 0 0.3"/><axis xyz="0 0 1"/></joint>
<joint name="&lt;b&gt;lift" type="continuous"><parent link="cross"/><child link="arm"/>
<axis xyz="0 1 0"/></joint>
<joint name="reach" type="prismatic"><parent link="arm"/><child link="hand"/>
<origin xyz="0.4 0 0"/><axis xyz="1 0 0"/><limit effort="9" velocity="1"/></joint>
<joint name="left" type="continuous"><parent link="hand"/><child link="left"/>
<origin xyz="0.1 0.02 0"/><axis xyz="0 0 1"/></joint>
<joint name="right" type="continuous"><parent link="hand"/><child link="right"/>
<origin xyz="0.1 -0.02 0"/><axis xyz="0 0 1"/></joint></robot>"#;

fn model() -> Model {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("fork.urdf"), ROBOT).unwrap();
    let plan = ImportPlan {
        drives: JointDrives::OrTorque,
        space: Some(SpacePlan {
            robot: "fork.urdf".into(),
            locked: Vec::new(),
        }),
        ..ImportPlan::default()
    };
    let imported = import(ROBOT, Path::new("fork.urdf"), &plan).unwrap();
    Model::parse(&imported.toml, &folder.path().join("fork.toml")).unwrap()
}

fn drawn(shapes: &RobotShapes) -> DrawnTree {
    DrawnTree::of(&model(), shapes).unwrap()
}

#[test]
fn links_reach_from_joint_to_joint_and_to_their_ends() {
    let drawn = drawn(&RobotShapes::default());
    assert_eq!(drawn.up, [0.0, 0.0, 1.0]);
    assert_eq!(drawn.base_bones_m, [[0.0, 0.0, 0.3]]);
    let bones: Vec<_> = drawn
        .links
        .iter()
        .map(|link| link.bones_m.clone())
        .collect();
    // Its only joint is where its own is.
    assert_eq!(bones[0], [[0.0; 3]; 0]);
    assert_eq!(bones[1], [[0.4, 0.0, 0.0]]);
    assert_eq!(bones[2], [[0.1, 0.02, 0.0], [0.1, -0.02, 0.0]]);
    // An even rod about its centre: 9e-6 kg m^2 = 0.03 kg (2 * 0.03 m)^2 / 12.
    assert_eq!(bones[3], [[0.06, 0.0, 0.0]]);
    let [end] = bones[4][..] else {
        panic!("{bones:?}")
    };
    assert_eq!(end.map(f64::abs), [0.0, 0.03, 0.0]);
    let last: Vec<bool> = drawn.links.iter().map(|link| link.is_last).collect();
    assert_eq!(last, [false, false, false, true, true]);
    assert!(drawn.links[2].slides && drawn.links[2].parent == Some(1));
    // The heaviest is the stoutest; none is longer across than along.
    let radii: Vec<f64> = drawn.links.iter().map(|link| link.radius_m).collect();
    assert!(radii.iter().all(|own| *own <= radii[1]), "{radii:?}");
    assert!(radii[3] < 0.02, "{radii:?}");
}

#[test]
fn links_without_a_shape_are_capsules_and_a_ball() {
    let bare = drawn(&RobotShapes::default());
    let of = |drawn: &DrawnTree, link| drawn.parts.iter().filter(|p| p.link == link).count();
    let counts = [None, Some(0), Some(1), Some(2), Some(3), Some(4)];
    assert_eq!(counts.map(|link| of(&bare, link)), [1, 1, 1, 2, 1, 1]);
    let mesh = Mesh::of([[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.5]]]);
    let shape = LinkShape {
        link: Some(2),
        pose: Isometry3::translation(1.0, 2.0, 3.0),
        form: ShapeForm::Mesh {
            mesh: 0,
            scale: Vector3::new(1.0, -1.0, 1.0),
        },
    };
    let dressed = drawn(&RobotShapes {
        shapes: vec![shape],
        meshes: vec![mesh],
        not_drawn: Vec::new(),
    });
    assert_eq!(counts.map(|link| of(&dressed, link)), [1, 1, 1, 1, 1, 1]);
    let part = dressed.parts.iter().find(|part| part.link == Some(2));
    let wanted = DrawnPart {
        link: Some(2),
        mesh: 0,
        pose: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0],
        scale: [1.0, -1.0, 1.0],
    };
    assert_eq!(part, Some(&wanted));
    let packed = &dressed.meshes[0];
    assert_eq!(packed.low_m, [0.0; 3]);
    assert_eq!(packed.size_m, [1.0, 2.0, 0.5]);
    let numbers = |text: &str| -> Vec<u16> {
        let bytes = STANDARD.decode(text).unwrap();
        let pairs = bytes.chunks_exact(2);
        pairs
            .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
            .collect()
    };
    const MOST: u16 = u16::MAX;
    assert_eq!(
        numbers(&packed.corners),
        [0, 0, 0, MOST, 0, 0, 0, MOST, MOST]
    );
    assert_eq!(numbers(&packed.triangles), [0, 1, 2]);
}

/// Of a trunk whose mesh is lost a sensor's box is no picture.
#[test]
fn a_link_of_which_only_a_part_is_seen_is_a_capsule_too() {
    let half_m = Vector3::repeat(0.01);
    let sensor = LinkShape {
        link: Some(1),
        pose: Isometry3::identity(),
        form: ShapeForm::Solid(Solid::Box { half_m }),
    };
    let lost = NotDrawn {
        link: "arm".into(),
        moves_with: Some(1),
        mesh: Some("arm.dae".into()),
        why: "only STL is read".into(),
    };
    let parts = |not_drawn| {
        let drawn = drawn(&RobotShapes {
            shapes: vec![sensor.clone()],
            meshes: Vec::new(),
            not_drawn,
        });
        drawn
            .parts
            .iter()
            .filter(|part| part.link == Some(1))
            .count()
    };
    assert_eq!([parts(vec![lost]), parts(Vec::new())], [2, 1]);
}

/// The end of the trail is where the eye sees it.
#[test]
fn a_last_link_with_a_shape_ends_where_that_does() {
    let half_m = Vector3::new(0.1, 0.01, 0.01);
    let shape = LinkShape {
        link: Some(3),
        pose: Isometry3::translation(0.05, 0.02, 0.0),
        form: ShapeForm::Solid(Solid::Box { half_m }),
    };
    let drawn = drawn(&RobotShapes {
        shapes: vec![shape],
        ..RobotShapes::default()
    });
    let [end] = drawn.links[3].bones_m[..] else {
        panic!("{:?}", drawn.links[3])
    };
    assert_eq!(end, [0.15, 0.02, 0.0]);
}

#[test]
fn a_page_names_joints_and_cannot_be_broken_out_of() {
    let scene = Scene::measured(&model(), &[]);
    let joints: Vec<_> = (scene.joints.iter())
        .map(|joint| (joint.name.as_str(), joint.slides))
        .collect();
    assert_eq!(joints[1..3], [("<b>lift", false), ("reach", true)]);
    assert!(scene.links.is_empty() && !scene.on_bar && !scene.head);
    let page = html(&scene, "handstand view").unwrap();
    assert!(page.contains("id=\"surfaces\"") && page.contains("const linkPoses"));
    assert!(page.contains("\\u003cb>lift") && !page.contains("<b>lift"));
    assert_eq!(page.matches("</script>").count(), 2, "its own two");
}

/// What a day's log of a humanoid takes.
#[test]
fn a_page_of_eighteen_joints_stays_below_five_megabytes() {
    let mut scene = Scene::measured(&model(), &[]);
    let wave = |joint: usize| -> Vec<f64> {
        let at = |k: usize| ((k as f64 * 0.01 + joint as f64).sin() * 1e5).round() / 1e5;
        (0..8000).map(at).collect()
    };
    let track = |kind| crate::playback::Track {
        name: "a".into(),
        kind,
        time_s: (0..8000).map(|k| f64::from(k) / 100.0).collect(),
        link_rad: Vec::new(),
        joint_rad: (0..18).map(wave).collect(),
    };
    scene.motions.push(crate::playback::DrawnMotion {
        name: "a".into(),
        tracks: vec![
            track(crate::playback::TrackKind::Measured),
            track(crate::playback::TrackKind::Model),
        ],
        inputs: (0..18)
            .map(|joint| crate::playback::Input {
                joint: joint + 1,
                what: "torque",
                unit: "N m",
                values: wave(joint),
            })
            .collect(),
    });
    let page = html(&scene, "handstand view").unwrap();
    assert!(page.len() < 5_000_000, "{}", page.len());
}
