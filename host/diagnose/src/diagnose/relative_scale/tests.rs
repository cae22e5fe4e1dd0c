use super::super::words::tests::{effect, said};
use super::*;
use crate::diagnose::Verdict;
use crate::effects::{EFFECTS, Scope};
use crate::model::{EffectInstance, effect_on};
use crate::motion::Motion;
use handstand_sim::sim::{Plant, PlantMemory, StartState, predict};
use std::path::Path;

/// A link driven by this, and a passive one on it.
fn arm(drive: &str) -> Model {
    let input = if drive.contains("passive") {
        ""
    } else {
        "input = { column = \"u\", unit = \"1\" }\n"
    };
    let input = if drive.contains("torque\"") {
        input.replace("\"1\"", "\"N m\"")
    } else {
        input.into()
    };
    let text = format!(
        "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\nstep_s = 0.001\n\
         [[link]]\nlength_m = 0.2\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 1e-3\n\
         [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 8e-4\n\
         [[joint]]\n{drive}\n[[joint]]\ndrive = \"passive\"\n\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         [[log.joint]]\nposition = {{ column = \"q1\", unit = \"rad\" }}\n{input}\
         [[log.joint]]\nposition = {{ column = \"q2\", unit = \"rad\" }}\n"
    );
    Model::parse(&text, Path::new("a.toml")).unwrap()
}

const PASSIVE: &str = "drive = \"passive\"";
const DUTY: &str = "drive = \"duty\"\nstall_torque_nm = 1.5\nno_load_speed_rad_s = 6.0";
const TORQUE: &str = "drive = \"torque\"";

/// Every value of the model whose unit says that it scales, twice as large.
fn doubled(model: &Model) -> Model {
    let mut doubled = model.clone();
    for path in values_of(model)
        .into_iter()
        .filter(|path| scales(path.unit()))
    {
        let value = path.get(model).unwrap();
        assert!(path.set(&mut doubled, 2.0 * value));
    }
    doubled
}

/// Readings of two seconds from a bent start, along a duty that changes its sign.
fn course(model: &Model) -> Vec<f64> {
    let time_s: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
    let input = time_s.iter().map(|t| 0.6 * (5.0 * t).sin()).collect();
    let driven = model.joints[0].drive.is_driven();
    let motion = Motion {
        position_rad: vec![vec![0.0; time_s.len()]; 2],
        velocity_rad_s: vec![None; 2],
        input: vec![driven.then_some(input), None],
        time_s,
        ..Motion::default()
    };
    let start = StartState {
        angle_rad: vec![1.0, -0.6],
        speed_rad_s: vec![0.0; 2],
        reading_slope: None,
    };
    let mut readings = vec![0.0; 2 * motion.len()];
    let (plant, mut memory) = (Plant::new(model, &motion), PlantMemory::default());
    let all = 0..motion.len();
    predict(&plant, &motion, all, &start, &mut memory, &mut readings);
    readings
}

fn off(left: &[f64], right: &[f64]) -> f64 {
    let pairs = left.iter().zip(right);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn twice_all_torques_and_masses_move_alike_with_every_effect() {
    for (drive, driven) in [(PASSIVE, false), (DUTY, true)] {
        let plain = arm(drive);
        for effect in EFFECTS {
            let info = effect.info();
            let at = match info.scope {
                Scope::WholeRig => None,
                Scope::DrivenJoint if !driven => continue,
                Scope::PassiveJoint => Some(1),
                _ => Some(0),
            };
            let Some(effect) = effect_on(*effect, at, &plain.joints) else {
                continue;
            };
            let values = effect.info().parameters.iter().map(|p| p.starts[0]);
            let mut model = plain.clone();
            model.effects.push(EffectInstance {
                effect,
                joint: at,
                values: values.collect(),
            });
            let (once, twice) = (course(&model), course(&doubled(&model)));
            assert!(
                off(&once, &twice) < 1e-6,
                "{}: {}",
                info.id,
                off(&once, &twice)
            );
            // The masses alone do change it, where anything but gravity acts.
            let mut heavier = model.clone();
            heavier.links.iter_mut().for_each(|link| {
                link.mass_kg *= 2.0;
                link.inertia_kg_m2 *= 2.0;
            });
            let acts = effect.info().parameters.iter().any(|p| scales(p.unit));
            if acts && !driven && !["base_compliance", "torque_saturation"].contains(&info.id) {
                let apart = off(&once, &course(&heavier));
                assert!(apart > 1e-6, "{}: {apart}", info.id);
            }
        }
    }
}

fn warned(model: &Model, known: &[&str]) -> Option<String> {
    let known: Vec<ParameterPath> = known.iter().map(|path| path.parse().unwrap()).collect();
    let diagnosis = said(Verdict::Named, vec![effect("coulomb", Some(1))], vec![]);
    warning(&diagnosis, model, &known)
}

#[test]
fn a_rig_without_a_known_torque_is_warned_of() {
    let said = warned(&arm(PASSIVE), &[]).unwrap();
    assert!(
        said.starts_with(
            "coulomb@1.torque_nm scales with the masses and inertias of the links, which these logs \
             do not determine"
        ),
        "{said}"
    );
    assert!(said.contains("--known link1.mass_kg"), "{said}");
}

#[test]
fn a_logged_torque_a_stall_torque_and_a_weighed_link_set_the_scale() {
    assert_eq!(warned(&arm(TORQUE), &[]), None);
    assert_eq!(warned(&arm(DUTY), &[]), None);
    assert_eq!(warned(&arm(PASSIVE), &["link1.mass_kg"]), None);
    // A length that is known says nothing of masses.
    assert!(warned(&arm(PASSIVE), &["link1.com_m"]).is_some());
    // An effect's torque that the file gives.
    let mut model = arm(PASSIVE);
    model.add_effect("cable_spring", 0, vec![0.1, 0.0]);
    assert_eq!(warned(&model, &[]), None);
}

#[test]
fn a_stall_torque_that_is_fitted_sets_no_scale() {
    let mut diagnosis = said(Verdict::Named, vec![effect("coulomb", Some(1))], vec![]);
    let mut stall = diagnosis.effects[0].parameters[0].clone();
    stall.path = "joint1.stall_torque_nm".to_owned();
    diagnosis.base.push(stall);
    let said = warning(&diagnosis, &arm(DUTY), &[]).unwrap();
    assert!(
        said.starts_with("joint1.stall_torque_nm and coulomb@1.torque_nm scale with"),
        "{said}"
    );
}
