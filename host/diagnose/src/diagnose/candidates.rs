//! Which effects could be missing, and where.

use crate::effects::{EFFECTS, Effect, EffectInfo, Needs, Parameter, Scope, Site};
use crate::fitting::Candidate;
use crate::model::{Drive, MeasuredSignal, Model, effect_on};
use crate::motion::Motion;

/// Every effect of the library and of the model's file at every place where it can act on this
/// model and be seen in these motions, except those the model holds and those named in `without`;
/// what comes with a servo also at all driven joints with the same values, where these are of one
/// type.
pub fn candidates(model: &Model, motions: &[Motion], without: &[String]) -> Vec<Candidate> {
    let mut found = Vec::new();
    for &effect in EFFECTS
        .iter()
        .chain(&model.laws)
        .filter(|e| !without.iter().any(|id| id == e.info().id))
        .filter(|e| !model.is_in_space() || e.acts_in_space())
    {
        let info = effect.info();
        let joints: Vec<Option<usize>> = match info.scope {
            Scope::WholeRig => vec![None],
            scope => (0..model.link_count())
                .filter(|&joint| suits(scope, model, motions, joint))
                .map(Some)
                .collect(),
        };
        let at = |joint| Candidate {
            effect: effect_on(effect, joint, &model.joints).unwrap_or(effect),
            joint,
        };
        let can_act = |joint| {
            effect_on(effect, joint, &model.joints).is_some()
                && !at(joint).in_model(model)
                && visible(info.needs, model, motions, joint)
                && joint.is_none_or(|joint| is_read(effect, model, joint))
                && joint.is_none_or(|joint| is_timed(effect, model, motions, joint))
                && joint.is_none_or(|joint| info.id != COM_ANGLE || turns(model, joint))
        };
        let twins = twins(model);
        let share = |joint: &usize| joints.contains(&Some(*joint)) && can_act(Some(*joint));
        let shared = effect.is_of_servo() && !twins.is_empty() && twins.iter().all(share);
        found.extend(
            joints
                .iter()
                .copied()
                .filter(|joint| can_act(*joint))
                .map(at),
        );
        found.extend(shared.then(|| at(None)));
    }
    found
}

/// Where the centre of mass of a link lies beside its line.
const COM_ANGLE: &str = "com_angle";

/// Whether the link behind a joint turns: the angles of one that only slides show in nothing.
fn turns(model: &Model, joint: usize) -> bool {
    let until = model.joints.iter().take(joint + 1);
    until.into_iter().any(|joint| joint.slide.is_none())
}

/// Whether an encoder or sensor that this effect changes is read at a joint: by the log, or by the
/// regulator of its drive, to which the times of the log's columns are all one. A rate shows what
/// scales the reading, lets it trail or moves it in time.
fn is_read(effect: Effect, model: &Model, joint: usize) -> bool {
    let info = effect.info();
    let regulated = matches!(model.joints[joint].drive, Drive::Position { .. });
    let signal = model.log.joints[joint].signal();
    if effect.reading_offset_s(&first_values(info)).is_some() {
        return signal != MeasuredSignal::Nothing;
    }
    match info.site {
        Site::Encoder | Site::Sensor if regulated => true,
        Site::Encoder => match signal {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => true,
            MeasuredSignal::Rate => {
                let values = first_values(info);
                effect.encode(&values, 1.0) - effect.encode(&values, 0.0) != 1.0
            }
            MeasuredSignal::Nothing => false,
        },
        Site::Sensor => match signal {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => true,
            MeasuredSignal::Rate => effect.trail_rad(&first_values(info), 1.0).is_some(),
            MeasuredSignal::Nothing => false,
        },
        Site::Rate => signal == MeasuredSignal::Rate || has_rate_sensor(model, joint),
        _ => true,
    }
}

/// Whether something tells the times that an effect of a log's column changes: another joint, the
/// joint's own rate sensor, or the input.
fn is_timed(effect: Effect, model: &Model, motions: &[Motion], joint: usize) -> bool {
    effect
        .reading_offset_s(&first_values(effect.info()))
        .is_none()
        || model.link_count() > 1
        || has_rate_sensor(model, joint)
        || suits(Scope::DrivenJoint, model, motions, joint)
}

/// The values from which a fit of an effect starts first.
fn first_values(info: &EffectInfo) -> Vec<f64> {
    let start = |parameter: &Parameter| parameter.starts.first().copied();
    info.parameters.iter().filter_map(start).collect()
}

/// All driven joints, if there are several and all of one servo type: of drives alike but for the
/// gain, which is set in the servo.
fn twins(model: &Model) -> Vec<usize> {
    let driven = model.driven_joints();
    let drive = |joint: &usize| &model.joints[*joint].drive;
    let alike = |joint: &usize| {
        let (first, own) = (drive(&driven[0]), drive(joint));
        let axis = |joint: usize| model.joints[joint].axis();
        let same = first.name() == own.name() && first.motor() == own.motor();
        same && axis(driven[0]) == axis(*joint)
    };
    if driven.len() > 1 && driven.iter().all(alike) {
        driven
    } else {
        Vec::new()
    }
}

/// Whether an effect of this scope may act at a joint: on a driven joint only if its drive does
/// something in these motions.
fn suits(scope: Scope, model: &Model, motions: &[Motion], joint: usize) -> bool {
    let drive = &model.joints[joint].drive;
    let varies = |input: &Vec<f64>| input.iter().any(|x| *x != input[0]);
    let drives = |motion: &Motion| {
        motion
            .torque_on
            .as_ref()
            .is_none_or(|on| on.contains(&true))
            && motion.input[joint].as_ref().is_some_and(varies)
    };
    match scope {
        Scope::WholeRig | Scope::AnyJoint => true,
        Scope::PassiveJoint => *drive == Drive::Passive,
        Scope::DrivenJoint => drive.is_driven() && motions.iter().any(drives),
    }
}

/// Whether a joint has a rate sensor beside the one of its angle. What scales or filters a rate
/// that is read alone is `encoder_scale`, or `sensor_lag`.
fn has_rate_sensor(model: &Model, joint: usize) -> bool {
    model.log.joints[joint].rate.is_some()
}

fn visible(needs: Needs, model: &Model, motions: &[Motion], joint: Option<usize>) -> bool {
    match needs {
        Needs::Nothing | Needs::GearLoad | Needs::BearingLoad => true,
        Needs::RateSensor => joint.is_some_and(|joint| has_rate_sensor(model, joint)),
        Needs::Supply => {
            let nominal = joint.and_then(|j| model.joints[j].drive.motor()?.nominal_supply_v);
            let logged = motions.iter().filter_map(|m| m.supply_v.as_ref()).flatten();
            let (low, high) = logged.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(*v), high.max(*v))
            });
            // A supply that moves by less than 2 % teaches nothing.
            nominal.is_some_and(|nominal| high - low > 0.02 * nominal)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_model::fixture::motion;
    use std::path::Path;

    /// What a rate sensor may do is offered where its joint has one beside the one of its angle.
    #[test]
    fn rate_sensors_are_doubted_where_they_are() {
        let motion = Motion {
            rate_rad_s: vec![Some(vec![0.1; 50])],
            ..motion("swing", 50)
        };
        let offered = |gyro: &str| {
            let text = format!(
                "[rig]\nname = \"p\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.1\nmass_kg = 0.2\n\
                 inertia_kg_m2 = 0.008\n[[joint]]\ndrive = \"passive\"\n\
                 [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n[[log.joint]]\n\
                 position = {{ column = \"q\", unit = \"rad\" }}\n{gyro}"
            );
            let model = Model::parse(&text, Path::new("p.toml")).unwrap();
            let found = candidates(&model, std::slice::from_ref(&motion), &[]);
            let own = |id: &str| found.iter().any(|c| c.to_string() == format!("{id}@1"));
            ["time_offset", "rate_bias", "rate_scale", "rate_lag"].map(own)
        };
        let gyro = "gyro = { column = \"w\", unit = \"rad/s\" }\n";
        assert_eq!(offered(gyro), [true; 4]);
        assert_eq!(offered(""), [false; 4]);
    }
}
