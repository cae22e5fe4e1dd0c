//! `<option>` and its flags: gravity, media, and which forces MuJoCo switches off.

use super::defaults::Attributes;
use crate::error::Result;
use crate::model::import::remark::Remark;
use crate::model::import::xml::Element;
use nalgebra::Vector3;

/// Settings of the solver: they move no force of a chain without contacts.
const OF_SOLVER: [&str; 22] = [
    "ccd_iterations",
    "ccd_tolerance",
    "cone",
    "impratio",
    "integrator",
    "iterations",
    "jacobian",
    "ls_iterations",
    "ls_tolerance",
    "magnetic",
    "noslip_iterations",
    "noslip_tolerance",
    "o_friction",
    "o_margin",
    "o_solimp",
    "o_solref",
    "sdf_initpoints",
    "sdf_iterations",
    "sleep_tolerance",
    "solver",
    "timestep",
    "tolerance",
];
/// Flags that are read.
const READ: [&str; 9] = [
    "gravity",
    "spring",
    "damper",
    "passive",
    "frictionloss",
    "constraint",
    "limit",
    "actuation",
    "clampctrl",
];
/// Flags of what a chain here does not have, or of how MuJoCo computes.
const OTHER: [&str; 20] = [
    "autoreset",
    "contact",
    "diagexact",
    "energy",
    "equality",
    "eulerdamp",
    "filterparent",
    "fwdinv",
    "invdiscrete",
    "ipc",
    "island",
    "midphase",
    "multiccd",
    "nativeccd",
    "override",
    "refsafe",
    "sensor",
    "sleep",
    "speculative",
    "warmstart",
];

/// What acts in the file.
pub(super) struct Options {
    pub gravity_m_s2: Vector3<f64>,
    pub springs: bool,
    pub dampers: bool,
    pub friction: bool,
    pub limits: bool,
    pub actuation: bool,
    /// Whether controls stop at their range.
    pub clamps: bool,
    /// Groups of actuators that are switched off.
    pub groups_off: Vec<String>,
    pub left_out: Vec<Remark>,
}

impl Options {
    /// # Errors
    /// Gravity that is no vector.
    pub fn of(root: Element) -> Result<Self> {
        let mut options = Options {
            gravity_m_s2: Vector3::new(0.0, 0.0, -9.81),
            springs: true,
            dampers: true,
            friction: true,
            limits: true,
            actuation: true,
            clamps: true,
            groups_off: Vec::new(),
            left_out: Vec::new(),
        };
        let mut gravity_acts = true;
        for option in root.all("option") {
            if let Some(gravity) = option.vector("gravity")? {
                options.gravity_m_s2 = gravity;
            }
            if let Some(groups) = option.text("actuatorgroupdisable") {
                options.groups_off = groups.split_whitespace().map(str::to_string).collect();
            }
            options.media(option);
            for flags in option.all("flag") {
                for flag in flags.node.attributes() {
                    let on = flag.value() != "disable";
                    match flag.name() {
                        "gravity" => gravity_acts = on,
                        "spring" => options.springs = on,
                        "damper" => options.dampers = on,
                        "passive" => (options.springs, options.dampers) = (on, on),
                        "frictionloss" => options.friction &= on,
                        "limit" => options.limits &= on,
                        "constraint" if !on => (options.friction, options.limits) = (on, on),
                        "actuation" => options.actuation = on,
                        "clampctrl" => options.clamps = on,
                        _ => {}
                    }
                }
                options.others(flags, &[&READ[..], &OTHER[..]].concat(), "flag ");
            }
        }
        if !gravity_acts {
            options.gravity_m_s2 = Vector3::zeros();
        }
        Ok(options)
    }

    /// Whether MuJoCo adds passive forces at all, of which `gravcomp` is one.
    pub fn compensates(&self) -> bool {
        self.springs || self.dampers
    }

    fn media(&mut self, option: Element) {
        let media = ["wind", "density", "viscosity"];
        for key in media {
            let is_zero = |word: &str| word.parse::<f64>() == Ok(0.0);
            let text = option.text(key).unwrap_or_default();
            if !text.split_whitespace().all(is_zero) {
                let why = "no medium moves around a chain here";
                let remark = Remark::new(key, None, why);
                self.left_out.push(remark.on(option.line()));
            }
        }
        let read = ["gravity", "actuatorgroupdisable"];
        self.others(option, &[&media[..], &read, &OF_SOLVER].concat(), "option ");
    }

    fn others(&mut self, element: Element, known: &[&str], of: &str) {
        for key in Attributes::own(element).others(known) {
            let remark = Remark::new(&format!("{of}{key}"), None, "a setting that is not read");
            self.left_out.push(remark.on(element.line()));
        }
    }
}
