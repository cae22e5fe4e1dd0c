//! MJCF: bodies within bodies, attributes filled from classes of defaults.

mod actuators;
pub(in crate::model) mod defaults;
pub(in crate::model) mod geometry;
mod inertials;
mod joints;
mod option;
pub(in crate::model) mod orientation;

use super::remark::Remark;
use super::tree::{Fault, FaultyPart, Inertial, RobotTree, TreeBody};
use super::xml::Element;
use crate::error::{Error, Result};
use defaults::{Attributes, Defaults};
use nalgebra::{Isometry3, Translation3};
use option::Options;
use orientation::Compiler;

/// Bodies within bodies; deeper, a file is no robot's.
const DEEPEST: usize = 200;

/// Elements of which MuJoCo makes bodies when it compiles the file.
const BUILT: [&str; 3] = ["include", "attach", "replicate"];
/// Elements that give the body around them more masses or forces.
const GROWN: [&str; 3] = ["composite", "flexcomp", "plugin"];
/// Attributes of bodies that are read, or move no force.
const OF_BODY: [&str; 15] = [
    "name",
    "childclass",
    "pos",
    "quat",
    "axisangle",
    "euler",
    "xyaxes",
    "zaxis",
    "gravcomp",
    "mocap",
    "user",
    "fuse",
    "simple",
    "sleep",
    "class",
];
/// Parts of the file that are read, or move no force of a chain.
const READ: [&str; 10] = [
    "compiler",
    "option",
    "size",
    "statistic",
    "visual",
    "default",
    "asset",
    "worldbody",
    "actuator",
    "custom",
];

/// What MuJoCo writes of a file that it has compiled; it leaves out the masses unless told.
pub(super) const FLATTEN: &str = "put <compiler saveinertial=\"true\"/> into it and let MuJoCo \
                                  write it out flat: mujoco.mj_saveLastXML(\"flat.xml\", \
                                  mujoco.MjModel.from_xml_path(\"robot.xml\"))";

/// What is known while bodies are read.
struct Reader<'a> {
    compiler: Compiler,
    defaults: Defaults<'a>,
    options: Options,
    bodies: Vec<TreeBody>,
    left_out: Vec<Remark>,
    faults: Vec<Fault>,
    unnamed: usize,
}

/// The robot of a `<mujoco>` element.
///
/// # Errors
/// Elements that only MuJoCo's compiler understands, numbers that are none, meshes whose masses
/// the file does not give.
pub(super) fn tree(root: Element) -> Result<RobotTree> {
    let compiler = Compiler::of(root)?;
    let mut options = Options::of(root)?;
    let world = TreeBody {
        name: "world".to_string(),
        line: root.line(),
        at: root.at(),
        parent: None,
        pose: Isometry3::identity(),
        inertial: Inertial::NONE,
        joints: Vec::new(),
        borne: 0.0,
        notes: Vec::new(),
    };
    let mut reader = Reader {
        compiler,
        defaults: Defaults::of(root)?,
        left_out: std::mem::take(&mut options.left_out),
        options,
        bodies: vec![world],
        faults: Vec::new(),
        unnamed: 0,
    };
    for part in root.elements().chain(root.foreign()) {
        if BUILT.contains(&part.tag()) {
            return Err(part.wrong(format!("<{}> is not read", part.tag()), FLATTEN));
        }
        if !READ.contains(&part.tag()) && part.elements().next().is_some() {
            let why = "no part of a chain of links";
            let remark = Remark::new(part.tag(), None, why);
            reader.left_out.push(remark.on(part.line()));
        }
    }
    for world in root.all("worldbody") {
        reader.children(world, 0, &Isometry3::identity(), None, 0)?;
    }
    for actuators in root.all("actuator") {
        actuators::read(actuators, &mut reader);
    }
    Ok(RobotTree {
        name: root.text("model").unwrap_or("robot").to_string(),
        bodies: reader.bodies,
        gravity_m_s2: reader.options.gravity_m_s2,
        left_out: reader.left_out,
        faults: reader.faults,
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
                tag if GROWN.contains(&tag) => {
                    let error = child.wrong(format!("<{tag}> is not read"), FLATTEN);
                    self.fault(parent, FaultyPart::Mass, &error);
                    if parent == 0 {
                        let why = "no part of a chain of links";
                        let remark = Remark::new(tag, None, why);
                        self.left_out.push(remark.on(child.line()));
                    }
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
        let index = self.bodies.len();
        self.unnamed += 1;
        let name = body
            .text("name")
            .map_or(format!("body{}", self.unnamed), str::to_string);
        let pose = self.pose(body);
        let pose = pose.unwrap_or_else(|error| {
            self.fault(index, FaultyPart::Pose, &error);
            Isometry3::identity()
        });
        self.bodies.push(TreeBody {
            name: name.clone(),
            line: body.line(),
            at: body.at(),
            parent: Some(parent),
            pose: frame * pose,
            inertial: Inertial::NONE,
            joints: Vec::new(),
            borne: 0.0,
            notes: Vec::new(),
        });
        for joint in body
            .elements()
            .filter(|e| ["joint", "freejoint"].contains(&e.tag()))
        {
            let joint = self.joint(joint, class, index)?;
            self.bodies[index].joints.push(joint);
        }
        match self.inertial(body, class) {
            Ok((inertial, impossible)) => {
                self.bodies[index].inertial = inertial;
                let note = |why| Remark::new("inertia", Some(&name), why).on(body.line());
                self.bodies[index].notes.extend(impossible.map(note));
            }
            Err(error) => self.fault(index, FaultyPart::Mass, &error),
        }
        match body.number("gravcomp") {
            Ok(borne) if self.options.compensates() => {
                self.bodies[index].borne = borne.unwrap_or(0.0);
            }
            Ok(_) => {}
            Err(error) => self.fault(index, FaultyPart::Mass, &error),
        }
        for key in body.others(&OF_BODY) {
            let why = "an attribute that is not read";
            let remark = Remark::new(key, Some(&name), why);
            self.left_out.push(remark.on(body.line()));
        }
        self.children(body, index, &Isometry3::identity(), class, depth)
    }

    /// Notes what is wrong with a part of a body.
    fn fault(&mut self, body: usize, part: FaultyPart, error: &Error) {
        self.faults.push(Fault::new(body, part, error));
    }

    fn pose(&self, element: Element) -> Result<Isometry3<f64>> {
        let pos = element.vector("pos")?.unwrap_or_default();
        let turn = self
            .compiler
            .orientation(&Attributes::own(element))?
            .unwrap_or_default();
        Ok(Isometry3::from_parts(Translation3::from(pos), turn))
    }
}
