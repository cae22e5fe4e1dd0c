//! Which values a first model is given, which of them are fitted, and from where.

use crate::fitting::effect_named;
use crate::log::init::Draft;
use crate::model::{EffectInstance, JointField, LinkField, Model, ParameterPath};
use crate::motion::Motion;

/// Factors on what scales a whole drive, and on friction, that a fit starts from.
const SCALES: [f64; 3] = [1.0, 0.25, 4.0];
const FRICTIONS: [f64; 2] = [1.0, 10.0];
/// A drive's speed without load is at least this many times the fastest motion.
const FASTER: f64 = 1.5;
/// Friction to start from: Coulomb, N m, and viscous, N m s/rad.
const COULOMB_NM: f64 = 0.005;
pub(super) const VISCOUS_NM_S_RAD: f64 = 0.001;

/// Whether an effect is one of those that a first model is given.
pub(super) fn is_friction(effect: &EffectInstance) -> bool {
    ["viscous", "coulomb"].contains(&effect.effect.info().id)
}

/// The model with plain friction at every joint, and no drive slower than the fastest motion. Where
/// the drive itself resists with the speed, viscous friction would say the same and is left out.
pub(super) fn rubbing(drafted: &Model, motions: &[Motion]) -> Model {
    let mut model = drafted.clone();
    for joint in 0..model.link_count() {
        let fastest = fastest_rad_s(motions, joint);
        let no_load = ParameterPath::Joint {
            index: joint,
            field: JointField::NoLoadSpeed,
        };
        let has_limit = no_load.get(&model).is_some_and(f64::is_finite);
        if let (true, Some(speed)) = (has_limit, no_load.get(&model)) {
            let _ = no_load.set(&mut model, speed.max(FASTER * fastest));
        }
        // A speed drive makes up for what its own speed takes away.
        let resists = has_limit && model.joints[joint].drive.name() != "speed";
        let effects = [("coulomb", COULOMB_NM), ("viscous", VISCOUS_NM_S_RAD)];
        for (id, value) in effects {
            if resists && id == "viscous" {
                continue;
            }
            if let Ok(effect) = effect_named(id) {
                model.effects.push(EffectInstance {
                    effect,
                    joint: Some(joint),
                    values: vec![value],
                });
            }
        }
    }
    model
}

/// The fastest that a joint moves over a few samples, rad/s: single steps hold the noise.
fn fastest_rad_s(motions: &[Motion], joint: usize) -> f64 {
    const APART: usize = 4;
    let speeds = motions.iter().flat_map(|motion| {
        let (angle, time_s) = (&motion.position_rad[joint], &motion.time_s);
        let count = angle.len().saturating_sub(APART);
        (0..count).map(move |k| {
            let seconds = time_s[k + APART] - time_s[k];
            ((angle[k + APART] - angle[k]) / seconds).abs()
        })
    });
    speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// What a fit may change, the most important first. All torques of a rig scale together, so its
/// scale stays where the draft has it: a torque drive's input states it, else the last mass does,
/// which all joints before it carry.
pub(super) fn free_of(model: &Model, draft: &Draft) -> Vec<ParameterPath> {
    let links = model.link_count();
    let drive = |index: usize| model.joints[index].drive.name();
    let joint = |index: usize, field: JointField| ParameterPath::Joint { index, field };
    let link = |index: usize, field: LinkField| ParameterPath::Link { index, field };
    let in_newton_metres = (0..links).any(|index| drive(index) == "torque");
    // Where the log itself says what its links are, no fit changes them.
    let known = draft.columns.knows_links;
    let mass_is_known = known || draft.is_known("mass");
    let mass_is_open = |index: usize| !mass_is_known && (index + 1 < links || in_newton_metres);
    let mut free = Vec::new();
    for index in 0..links {
        match drive(index) {
            "duty" => {}
            "position" => free.push(joint(index, JointField::GainPerRad)),
            "speed" => free.push(joint(index, JointField::GainSPerRad)),
            _ if mass_is_open(index) => free.push(link(index, LinkField::Mass)),
            _ if links == 1 && !known => free.push(link(index, LinkField::Com)),
            _ => {}
        }
        if model.joints[index].drive.motor().is_some() {
            free.push(joint(index, JointField::StallTorque));
        }
    }
    free.extend(friction_of(model, "coulomb"));
    // What a speed drive gives per rad/s holds its gain and its speed without load as one.
    let limited = |index: &usize| ["duty", "position"].contains(&drive(*index));
    free.extend(
        (0..links)
            .filter(limited)
            .map(|index| joint(index, JointField::NoLoadSpeed)),
    );
    free.extend(friction_of(model, "viscous"));
    for index in 0..links {
        if !known && (model.joints[index].drive.is_driven() || links > 1) {
            free.push(link(index, LinkField::Inertia));
        }
        let mass = link(index, LinkField::Mass);
        if mass_is_open(index) && !free.contains(&mass) {
            free.push(mass);
        }
        if index + 1 < links && !draft.is_known("length") {
            free.push(link(index, LinkField::Length));
        }
    }
    free
}

fn friction_of<'a>(model: &'a Model, id: &'a str) -> impl Iterator<Item = ParameterPath> + 'a {
    let own = model
        .effects
        .iter()
        .filter(move |effect| effect.effect.info().id == id);
    own.flat_map(ParameterPath::of_effect)
}

/// The models that fits start from: drives, or without a motor levers, an order of magnitude
/// stronger or weaker, and little or much friction. A lever stands for its link's mass, too: with
/// it grow both the pull of gravity and the inertia.
pub(super) fn starts(model: &Model, free: &[ParameterPath]) -> Vec<Model> {
    let link = |index: usize, field: LinkField| ParameterPath::Link { index, field };
    let scaled = |scale: f64, friction: f64| {
        let mut start = model.clone();
        for path in free {
            let factor = match path {
                ParameterPath::Joint {
                    field: JointField::StallTorque,
                    ..
                } => scale,
                ParameterPath::Link {
                    field: LinkField::Com,
                    ..
                } => scale,
                ParameterPath::Link {
                    index,
                    field: LinkField::Mass,
                } if !free.contains(&link(*index, LinkField::Com)) => scale,
                ParameterPath::Link { .. } | ParameterPath::Joint { .. } => 1.0,
                _ => friction,
            };
            if let Some(value) = path.get(model) {
                let _ = path.set(&mut start, factor * value);
            }
        }
        start
    };
    let pairs = SCALES
        .iter()
        .flat_map(|scale| FRICTIONS.map(|friction| (*scale, friction)));
    pairs
        .map(|(scale, friction)| scaled(scale, friction))
        .collect()
}
