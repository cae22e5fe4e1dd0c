//! Joints of MJCF.

use super::defaults::Attributes;
use super::{FLATTEN, Reader};
use crate::error::Result;
use crate::model::import::tree::{FaultyPart, JointMotion, TreeJoint};
use crate::model::import::xml::Element;
use nalgebra::{Point3, Vector3};

/// Attributes that are read, or move no force of a joint between its end stops.
const READ: [&str; 24] = [
    "actuatorfrclimited",
    "actuatorfrcrange",
    "actuatorgravcomp",
    "armature",
    "axis",
    "class",
    "damping",
    "frictionloss",
    "group",
    "limited",
    "margin",
    "name",
    "pos",
    "range",
    "ref",
    "solimpfriction",
    "solimplimit",
    "solreffriction",
    "solreflimit",
    "springdamper",
    "springref",
    "stiffness",
    "type",
    "user",
];

impl Reader<'_> {
    /// A joint; what is wrong with it is noted, and refuses it where a chain needs it.
    pub(super) fn joint(
        &mut self,
        element: Element,
        class: Option<&str>,
        body: usize,
    ) -> Result<TreeJoint> {
        let name = element.text("name");
        let name = name.map_or(
            format!("joint_of_{}", self.bodies[body].name),
            str::to_string,
        );
        let made = |motion| TreeJoint {
            at: element.at(),
            ..TreeJoint::new(name.clone(), element.line(), motion, Vector3::z())
        };
        if element.tag() == "freejoint" {
            return Ok(made(JointMotion::Free));
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
        let mut joint = made(motion);
        if motion != JointMotion::Free
            && let Err(error) = self.read_joint(&own, &mut joint)
        {
            self.fault(body, FaultyPart::Joint, &error);
        }
        Ok(joint)
    }

    fn read_joint(&self, own: &Attributes, joint: &mut TreeJoint) -> Result<()> {
        let element = own.element;
        let axis = own.vector("axis")?.unwrap_or(Vector3::z());
        let turned = axis.try_normalize(1e-9);
        joint.axis = turned
            .ok_or_else(|| element.wrong("an axis of length 0", "give the axis a direction"))?;
        let number = |key: &str| -> Result<f64> {
            let values = own.numbers(key)?;
            Ok(values.and_then(|v| v.first().copied()).unwrap_or(0.0))
        };
        // Of a slide it is metres, whatever the unit of angles.
        let place = |value: f64| match joint.motion {
            JointMotion::Slide => value,
            _ => self.compiler.rad(value),
        };
        joint.anchor_m = Point3::from(own.vector("pos")?.unwrap_or_default());
        joint.reference_rad = place(number("ref")?);
        joint.spring_rest_rad = place(number("springref")?);
        joint.armature_kg_m2 = number("armature")?;
        let options = &self.options;
        if options.springs {
            joint.stiffness_nm = number("stiffness")?;
        }
        if options.dampers {
            joint.damping_nm_s = number("damping")?;
        }
        if options.friction {
            joint.friction_nm = number("frictionloss")?;
        }
        let acts = options.springs || options.dampers;
        let gives = |values: Vec<f64>| values.iter().any(|value| *value != 0.0);
        if acts && own.numbers("springdamper")?.is_some_and(gives) {
            return Err(element.wrong("springdamper is not read", FLATTEN));
        }
        self.limits(own, joint)?;
        self.not_carried(own, joint)
    }

    /// Its largest torque, and end stops.
    fn limits(&self, own: &Attributes, joint: &mut TreeJoint) -> Result<()> {
        let line = own.element.line();
        let limits = |key: &str| self.compiler.limits(own, key);
        if own.text("range").is_some() && limits("limited") && self.options.limits {
            joint.leave("range", line, "links here have no end stops");
            joint.range_rad = own
                .text("range")
                .and_then(|text| self.ends(text, joint.motion));
        }
        let force = own.text("actuatorfrcrange");
        let force = force.filter(|_| limits("actuatorfrclimited"));
        if let Some(text) = force {
            match super::actuators::symmetric(own.element, "actuatorfrcrange", text)? {
                Ok(most) => joint.most_nm = most,
                Err(why) => joint.leave("actuatorfrcrange", line, why),
            }
        }
        Ok(())
    }

    /// The ends of a range, rad or m. They are not carried: what cannot be read is as good as none.
    fn ends(&self, text: &str, motion: JointMotion) -> Option<(f64, f64)> {
        let mut numbers = text.split_whitespace().map(str::parse::<f64>);
        let (low, high) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
        let place = |value: f64| match motion {
            JointMotion::Slide => value,
            _ => self.compiler.rad(value),
        };
        (low < high).then(|| (place(low), place(high)))
    }

    fn not_carried(&self, own: &Attributes, joint: &mut TreeJoint) -> Result<()> {
        let line = own.element.line();
        let more = |key: &str| {
            own.numbers(key)
                .map(|v| v.is_some_and(|v| v.iter().skip(1).any(|v| *v != 0.0)))
        };
        if more("stiffness")? || more("damping")? {
            let why = "only its first, linear coefficient is taken";
            joint.leave("polynomial", line, why);
        }
        if own.text("actuatorgravcomp") == Some("true") {
            let why = "what bears the weight counts as no part of the drive here";
            joint.leave("actuatorgravcomp", line, why);
        }
        for key in own.others(&READ) {
            joint.leave(key, line, "an attribute that is not read");
        }
        Ok(())
    }
}
