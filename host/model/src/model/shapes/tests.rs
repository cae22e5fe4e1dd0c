use super::*;
use crate::Model;
use crate::model::import::{ImportPlan, SpacePlan, import};
use proptest::prelude::*;

/// Two triangles of a square, 0.1 m wide, in x and y.
const SQUARE: [[[f32; 3]; 3]; 2] = [
    [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0]],
    [[0.0, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]],
];

fn binary(header: &[u8], count: u32, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend(count.to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for value in triangle.as_flattened() {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii(triangles: &[[[f32; 3]; 3]]) -> String {
    let mut text = String::from("solid square of solid\n");
    for triangle in triangles {
        text += "  facet normal nan 0 1e0\n    outer loop\n";
        for [x, y, z] in triangle {
            text += &format!("      vertex {x} {y:e} {z}\r\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid square\n"
}

#[test]
fn both_kinds_of_stl_are_the_same_surface() {
    let wanted = Mesh::of(SQUARE);
    assert_eq!((wanted.corners_m.len(), wanted.triangles.len()), (4, 2));
    assert_eq!(
        read_stl(&binary(b"made by", 2, &SQUARE)),
        Ok(wanted.clone())
    );
    assert_eq!(
        read_stl(&binary(b"solid made", 2, &SQUARE)),
        Ok(wanted.clone())
    );
    assert_eq!(read_stl(ascii(&SQUARE).as_bytes()), Ok(wanted));
}

#[test]
fn what_is_no_stl_is_refused_with_its_place() {
    let refused = |bytes: &[u8]| read_stl(bytes).expect_err("refused").to_string();
    let mut half = SQUARE;
    half[1][2][1] = f32::NAN;
    let mut far = SQUARE;
    far[0][1][0] = 1e7;
    let text = ascii(&SQUARE);
    let whole = binary(b"", 2, &SQUARE);
    for (bytes, wanted) in [
        (b"".to_vec(), "no STL"),
        (b"solid".to_vec(), "has no triangle"),
        (vec![7; 83], "no STL"),
        (binary(b"", 0, &[]), "has no triangle"),
        (
            binary(b"", u32::MAX, &SQUARE),
            "says 4294967295 triangles and holds 2 and 0 bytes",
        ),
        (
            binary(b"", 1, &SQUARE),
            "says 1 triangles and holds 2 and 0 bytes",
        ),
        (
            whole[..whole.len() - 1].to_vec(),
            "says 2 triangles and holds 1 and 49 bytes",
        ),
        (binary(b"", 2, &half), "a corner of triangle 2 is no place"),
        (binary(b"", 2, &far), "a corner of triangle 1 is no place"),
        (
            ascii(&half).into_bytes(),
            "a corner of triangle 2 is no place",
        ),
        (
            text.replacen("1e-1", "one", 1).into_bytes(),
            "line 6: a vertex has three numbers",
        ),
        (
            text.replacen("endloop", "vertex 1 2 3", 1).into_bytes(),
            "line 8: a facet has three corners",
        ),
        (
            text.replacen("facet", "faucet", 1).into_bytes(),
            "line 2: no part of an ASCII STL",
        ),
        (
            text.as_bytes()[..text.find("endloop").unwrap()].to_vec(),
            "ends within a facet",
        ),
        // Flat: its corners are two.
        (
            binary(b"", 1, &[[[0.0; 3], [0.0; 3], [1.0; 3]]]),
            "has no triangle",
        ),
    ] {
        assert_eq!(refused(&bytes), wanted);
    }
}

proptest! {
    /// Whatever the bytes: an answer, and no corner that is none.
    #[test]
    fn no_bytes_are_too_much(
        mut bytes in prop::collection::vec(any::<u8>(), 0..400),
        kind in 0..3,
        cut in 0..200_usize,
    ) {
        match kind {
            0 => {}
            1 => {
                let mut file = binary(b"", 2, &SQUARE);
                for (at, byte) in bytes.iter().enumerate() {
                    let place = 80 + at * 7 % (file.len() - 80);
                    file[place] ^= byte & 1;
                }
                bytes = file;
            }
            _ => {
                let mut text = ascii(&SQUARE).into_bytes();
                text.truncate(cut);
                bytes.splice(0..0, text);
            }
        }
        if let Ok(mesh) = read_stl(&bytes) {
            prop_assert!(!mesh.triangles.is_empty());
            let corners = mesh.corners_m.len() as u32;
            prop_assert!(mesh.triangles.as_flattened().iter().all(|own| *own < corners));
            prop_assert!(mesh.corners_m.as_flattened().iter().all(|own| own.is_finite()));
        }
    }
}

/// A wavy surface of 2 n^2 triangles.
fn waves(n: usize) -> Mesh {
    let corner = |i: usize, k: usize| {
        let (x, y) = (i as f32 / n as f32, k as f32 / n as f32);
        [x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos()]
    };
    let cells = (0..n * n).map(|cell| (cell / n, cell % n));
    Mesh::of(cells.flat_map(|(i, k)| {
        let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(p, q)| corner(i + p, k + q));
        [[a, b, c], [a, c, d]]
    }))
}

#[test]
fn a_thinned_mesh_keeps_its_size_and_nearly_its_shape() {
    let mesh = waves(200);
    assert_eq!(mesh.triangles.len(), 80_000);
    for most in [10, 1000, 20_000] {
        let thin = mesh.thinned(most);
        let count = thin.triangles.len();
        assert!(count <= most && 2 * count >= most, "{count} of {most}");
        if most == 10 {
            continue;
        }
        let [low, high] = thin.bounds_m();
        assert!(
            low[0] < 0.03 && high[0] > 0.97 && high[2] > 0.09,
            "{low:?} {high:?}"
        );
        let off = thin
            .corners_m
            .iter()
            .map(|[x, y, z]| (z - 0.1 * (9.0 * x).sin() * (7.0 * y).cos()).abs());
        assert!(off.fold(0.0, f32::max) < 0.01);
    }
    assert_eq!(mesh.thinned(80_000), mesh);
}

const ARM: &str = r#"<robot name="arm">
<link name="base"><visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual></link>
<link name="upper"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
<visual><origin xyz="1 2 3"/><geometry>
<mesh filename="package://arm/meshes/square.STL" scale="1 -1 2"/></geometry></visual>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<link name="tool">
<visual><geometry><mesh filename="meshes/none.stl"/></geometry></visual>
<visual><geometry><mesh filename="meshes/tool.dae"/></geometry></visual>
<collision><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision></link>
<link name="bare">
<collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<link name="fore"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
<visual><geometry><mesh filename="meshes/none.stl"/></geometry></visual>
<visual><geometry><sphere radius="-1"/></geometry></visual></link>
<joint name="lift" type="revolute"><parent link="base"/><child link="upper"/>
<origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit effort="1" velocity="1"/></joint>
<joint name="fixed" type="fixed"><parent link="upper"/><child link="tool"/>
<origin xyz="0 0 0.5"/></joint>
<joint name="welded" type="fixed"><parent link="upper"/><child link="bare"/></joint>
<joint name="bend" type="revolute"><parent link="upper"/><child link="fore"/>
<origin xyz="0.5 0 0"/><axis xyz="0 1 0"/><limit effort="1" velocity="1"/></joint></robot>"#;

/// The model of a robot's file in a folder.
fn model(folder: &Path, file: &str, text: &str) -> Model {
    std::fs::write(folder.join(file), text).unwrap();
    let plan = ImportPlan {
        space: Some(SpacePlan {
            robot: file.to_string(),
            locked: Vec::new(),
        }),
        ..ImportPlan::default()
    };
    let imported = import(text, &folder.join(file), &plan).unwrap();
    Model::parse(&imported.toml, &folder.join("arm.toml")).unwrap()
}

fn shapes(folder: &Path, file: &str, text: &str) -> RobotShapes {
    let model = model(folder, file, text);
    RobotShapes::read(model.robot.as_ref().unwrap(), &folder.join("arm.toml")).unwrap()
}

#[test]
fn a_urdf_s_shapes_stand_where_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("arm");
    std::fs::create_dir_all(package.join("meshes")).unwrap();
    std::fs::create_dir_all(package.join("urdf")).unwrap();
    let square = binary(b"", 2, &SQUARE);
    std::fs::write(package.join("meshes/square.STL"), square).unwrap();
    let found = shapes(&package.join("urdf"), "arm.urdf", ARM);
    assert_eq!(found.meshes, [Mesh::of(SQUARE)]);
    let at = |x, y, z| Isometry3::translation(x, y, z);
    let half_m = Vector3::new(0.05, 0.1, 0.15);
    let scale = Vector3::new(1.0, -1.0, 2.0);
    let mesh = ShapeForm::Mesh { mesh: 0, scale };
    let tool = Solid::Cylinder {
        radius_m: 0.1,
        half_m: 0.2,
    };
    let wanted = [
        (
            None,
            at(0.0, 0.0, 0.0),
            ShapeForm::Solid(Solid::Box { half_m }),
        ),
        (Some(0), at(1.0, 2.0, 3.0), mesh),
        // In place of its meshes, what collides.
        (Some(0), at(0.0, 0.0, 0.5), ShapeForm::Solid(tool)),
    ];
    let wanted = wanted.map(|(link, pose, form)| LinkShape { link, pose, form });
    assert_eq!(found.shapes, wanted);
    let lacking: Vec<_> = (found.not_drawn.iter())
        .map(|lacks| (lacks.link.as_str(), lacks.mesh.as_deref()))
        .collect();
    assert_eq!(lacking, [("fore", Some("meshes/none.stl")), ("fore", None)]);
    assert!(
        found.not_drawn[1]
            .why
            .contains("a size that is not above 0")
    );
    let text = found.not_drawn_text().unwrap();
    assert!(
        text.contains("fore (meshes/none.stl: no such file), fore ("),
        "{text}"
    );
}

const MJCF: &str = r#"<mujoco><compiler angle="radian" meshdir="assets"/>
<default><geom rgba="1 1 1 1"/><default class="seen"><geom type="mesh" group="2"/></default>
<default class="hit"><geom group="3"/></default></default>
<asset><mesh file="square.stl" scale="2 2 2"/><mesh name="lost" file="lost.obj"/></asset>
<worldbody><geom type="plane" size="1 1 1"/><geom size="9"/>
<body pos="0 0 1" childclass="seen"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
<joint name="a" type="hinge" axis="0 1 0" pos="0 0 0.25"/>
<geom mesh="square" pos="0 0 1"/><geom class="hit" type="sphere" size="0.3"/>
<body pos="1 0 0" childclass="hit"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
<joint name="b" type="slide" axis="1 0 0"/>
<geom class="seen" mesh="lost"/><frame pos="0 1 0">
<geom type="capsule" size="0.1" fromto="0 0 0 0 0 2"/></frame></body>
</body></worldbody></mujoco>"#;

#[test]
fn an_mjcf_s_shapes_stand_where_it_says() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("assets")).unwrap();
    std::fs::write(folder.path().join("assets/square.stl"), ascii(&SQUARE)).unwrap();
    let found = shapes(folder.path(), "arm.xml", MJCF);
    let scale = Vector3::repeat(2.0);
    let [square, capsule] = &found.shapes[..] else {
        panic!("{found:?}");
    };
    assert_eq!(square.form, ShapeForm::Mesh { mesh: 0, scale });
    // Links' frames stand at their joints.
    assert_eq!(square.pose, Isometry3::translation(0.0, 0.0, 0.75));
    let wanted = Solid::Capsule {
        radius_m: 0.1,
        half_m: 1.0,
    };
    assert_eq!(
        (capsule.link, capsule.form),
        (Some(1), ShapeForm::Solid(wanted))
    );
    let at = capsule.pose.translation.vector;
    assert!((at - Vector3::new(0.0, 1.0, 1.0)).norm() < 1e-12, "{at}");
    assert_eq!(found.not_drawn, []);
}

#[test]
fn a_robot_that_was_changed_meanwhile_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let model = model(folder.path(), "arm.urdf", ARM);
    let changed = ARM.replace("xyz=\"0.5 0 0\"", "xyz=\"0.6 0 0\"");
    std::fs::write(folder.path().join("arm.urdf"), changed).unwrap();
    let robot = model.robot.as_ref().unwrap();
    let error = RobotShapes::read(robot, &folder.path().join("arm.toml")).unwrap_err();
    assert!(
        error.to_string().contains("was changed meanwhile"),
        "{error}"
    );
}

#[test]
fn the_largest_meshes_give_way() {
    let mut shapes = RobotShapes {
        meshes: [8, 50, 100, 130, 130, 130, 130, 130, 130].map(waves).into(),
        ..RobotShapes::default()
    };
    shapes.thin();
    let counts = shapes.meshes.iter().map(|mesh| mesh.triangles.len());
    let counts: Vec<usize> = counts.collect();
    assert_eq!(&counts[..2], [128, 5000]);
    assert!(
        counts.iter().all(|count| *count <= MOST_TRIANGLES),
        "{counts:?}"
    );
    let sum: usize = counts.iter().sum();
    assert!(
        (70_000..=MOST_TRIANGLES_OF_ALL).contains(&sum),
        "{counts:?}"
    );
}
