//! MJCF: bodies within bodies, attributes filled from classes of defaults.

mod actuators;
mod defaults;
mod geometry;
mod inertials;
mod orientation;

use super::tree::{Inertial, JointMotion, LeftOut, RobotTree, TreeBody, TreeJoint};
use super::xml::Element;
use crate::error::Result;
use defaults::{Attributes, Defaults};
use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use orientation::Compiler;

/// Bodies within bodies; deeper, a file is no robot's.
const DEEPEST: usize = 200;

/// Elements that build other bodies, or change masses, when MuJoCo compiles the file.
const BUILT: [&str; 6] = [
    "include",
    "attach",
    "replicate",
    "composite",
    "flexcomp",
    "plugin",
];

/// What `mujoco` writes of a file that it has compiled.
pub(super) const FLATTEN: &str = "let MuJoCo write it out flat: mujoco.mj_saveLastXML(\"flat.xml\", \
                                  mujoco.MjModel.from_xml_path(\"robot.xml\"))";

/// What is known while bodies are read.
struct Reader<'a> {
    compiler: Compiler,
    defaults: Defaults<'a>,
    bodies: Vec<TreeBody>,
    left_out: Vec<LeftOut>,
    unnamed: usize,
}

/// The robot of a `<mujoco>` element.
///
/// # Errors
/// Elements that only MuJoCo's compiler understands, numbers that are none, meshes whose masses
/// the file does not give.
pub(super) fn tree(root: Element) -> Result<RobotTree> {
    let compiler = Compiler::of(root)?;
    let mut reader = Reader {
        compiler,
        defaults: Defaults::of(root)?,
        bodies: vec![TreeBody {
            name: "world".to_string(),
            parent: None,
            pose: Isometry3::identity(),
            inertial: Inertial::NONE,
            joints: Vec::new(),
        }],
        left_out: Vec::new(),
        unnamed: 0,
    };
    let built = root
        .elements()
        .find(|element| BUILT.contains(&element.tag()));
    if let Some(element) = built {
        return Err(element.wrong(format!("<{}> is not read", element.tag()), FLATTEN));
    }
    let mut gravity_m_s2 = Vector3::new(0.0, 0.0, -9.81);
    for option in root.all("option") {
        gravity_m_s2 = option.vector("gravity")?.unwrap_or(gravity_m_s2);
        for key in ["wind", "density", "viscosity"] {
            if option
                .numbers(key)?
                .is_some_and(|values| values.iter().any(|v| *v != 0.0))
            {
                reader.left_out.push(LeftOut::new(
                    key,
                    None,
                    "no medium moves around a chain here",
                ));
            }
        }
    }
    for world in root.all("worldbody") {
        reader.children(world, 0, &Isometry3::identity(), None, 0)?;
    }
    for actuators in root.all("actuator") {
        actuators::read(actuators, &mut reader)?;
    }
    for tag in [
        "equality",
        "tendon",
        "contact",
        "sensor",
        "keyframe",
        "deformable",
    ] {
        if root.all(tag).any(|part| part.elements().next().is_some()) {
            reader
                .left_out
                .push(LeftOut::new(tag, None, "no part of a chain of links"));
        }
    }
    Ok(RobotTree {
        name: root.text("model").unwrap_or("robot").to_string(),
        bodies: reader.bodies,
        gravity_m_s2,
        left_out: reader.left_out,
    })
}

impl Reader<'_> {
    /// The bodies and the shapes within an element, whose frame has this pose in its body's.
    fn children(
        &mut self,
        element: Element,
        parent: usize,
        pose: &Isometry3<f64>,
        class: Option<&str>,
        depth: usize,
    ) -> Result<()> {
        if depth > DEEPEST {
            return Err(element.wrong("bodies lie too deep within each other", FLATTEN));
        }
        for child in element.elements() {
            match child.tag() {
                "body" => self.body(child, parent, pose, class, depth + 1)?,
                "frame" => {
                    let own = pose * self.pose(child)?;
                    let class = child.text("childclass").or(class);
                    if child.first("joint").or(child.first("freejoint")).is_some() {
                        return Err(child.wrong("a joint within a <frame> is not read", FLATTEN));
                    }
                    self.children(child, parent, &own, class, depth + 1)?;
                }
                tag if BUILT.contains(&tag) => {
                    return Err(child.wrong(format!("<{tag}> is not read"), FLATTEN));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn body(
        &mut self,
        body: Element,
        parent: usize,
        frame: &Isometry3<f64>,
        class: Option<&str>,
        depth: usize,
    ) -> Result<()> {
        let class = body.text("childclass").or(class);
        let pose = frame * self.pose(body)?;
        let index = self.bodies.len();
        self.unnamed += 1;
        let name = body
            .text("name")
            .map_or(format!("body{}", self.unnamed), str::to_string);
        self.bodies.push(TreeBody {
            name,
            parent: Some(parent),
            pose,
            inertial: Inertial::NONE,
            joints: Vec::new(),
        });
        for joint in body
            .elements()
            .filter(|e| ["joint", "freejoint"].contains(&e.tag()))
        {
            let joint = self.joint(joint, class, index)?;
            self.bodies[index].joints.push(joint);
        }
        self.bodies[index].inertial = self.inertial(body, class)?;
        self.children(body, index, &Isometry3::identity(), class, depth)
    }

    fn pose(&self, element: Element) -> Result<Isometry3<f64>> {
        let pos = element.vector("pos")?.unwrap_or_default();
        let turn = self
            .compiler
            .orientation(&Attributes::own(element))?
            .unwrap_or_default();
        Ok(Isometry3::from_parts(Translation3::from(pos), turn))
    }

    fn joint(&mut self, element: Element, class: Option<&str>, body: usize) -> Result<TreeJoint> {
        let name = element.text("name");
        let name = name.map_or(
            format!("joint_of_{}", self.bodies[body].name),
            str::to_string,
        );
        if element.tag() == "freejoint" {
            return Ok(TreeJoint::new(name, JointMotion::Free, Vector3::x()));
        }
        let own = self.defaults.attributes(element, class)?;
        let motion = match own.text("type").unwrap_or("hinge") {
            "hinge" => JointMotion::Hinge,
            "slide" => JointMotion::Slide,
            "ball" | "free" => JointMotion::Free,
            other => {
                let what = format!("a joint of type \"{other}\"");
                return Err(element.wrong(what, "hinge, slide, ball or free"));
            }
        };
        let axis = own.vector("axis")?.unwrap_or(Vector3::z());
        if axis.norm() < 1e-9 {
            return Err(element.wrong("an axis of length 0", "give the axis a direction"));
        }
        let number = |key: &str| -> Result<f64> {
            Ok(own
                .numbers(key)?
                .and_then(|v| v.first().copied())
                .unwrap_or(0.0))
        };
        // Of a slide it is metres, whatever the unit of angles.
        let place = |value: f64| match motion {
            JointMotion::Slide => value,
            _ => self.compiler.rad(value),
        };
        let angle = |key: &str| -> Result<f64> { Ok(place(number(key)?)) };
        let mut joint = TreeJoint::new(name, motion, axis.normalize());
        joint.anchor_m = Point3::from(own.vector("pos")?.unwrap_or_default());
        joint.reference_rad = angle("ref")?;
        joint.spring_rest_rad = angle("springref")?;
        joint.stiffness_nm = number("stiffness")?;
        joint.damping_nm_s = number("damping")?;
        joint.friction_nm = number("frictionloss")?;
        joint.armature_kg_m2 = number("armature")?;
        let limited = own.text("limited").unwrap_or("auto");
        if let Some([low, high]) = own.numbers("range")?.as_deref() {
            let on = limited == "true" || (limited == "auto" && self.compiler.autolimits);
            let range = (place(*low), place(*high));
            joint.range_rad = on.then_some(range);
        }
        if own
            .numbers("springdamper")?
            .is_some_and(|v| v.iter().any(|v| *v != 0.0))
        {
            return Err(element.wrong("springdamper is not read", FLATTEN));
        }
        let more = |key: &str| own.numbers(key).map(|v| v.is_some_and(|v| v.len() > 1));
        if more("stiffness")? || more("damping")? {
            let why = "only its first, linear coefficient is taken";
            self.left_out
                .push(LeftOut::new("polynomial", Some(&joint.name), why));
        }
        Ok(joint)
    }
}
