//! A model as the robot on simulated servos.

use crate::error::{Error, Result};
use crate::model::{Drive, Model, Motor};
use crate::model::{hanging, upright};
use crate::sim::Live;
use handstand_cm5_sim::{Bus, BusSpec, Plant, Robot, RobotSpec, Start};
use std::path::Path;

/// Torque of a joint at full duty cycle, N m, where the model states none: the paper's limit.
const FULL_NM: f64 = 2.0;

/// Parse the description of a simulated bus.
///
/// # Errors
/// [`Error::Usage`] with the key and what it takes.
pub fn spec(text: &str) -> Result<BusSpec> {
    spec_with_robot(text, None)
}

/// The same with this model as its robot; `text` may say where it hangs and starts.
///
/// # Errors
/// As [`spec`].
pub fn spec_with_robot(text: &str, model: Option<&Path>) -> Result<BusSpec> {
    let wrong = |error: handstand_cm5_sim::SpecError| {
        Error::usage(error.to_string(), "such as sim:ids=1-3,delay=0,dead=2")
    };
    BusSpec::with_robot(text, model).map_err(wrong)
}

/// The bus that `spec` describes, with its robot.
///
/// # Errors
/// The robot's model cannot be read or does not fit, or it needs servos that are not there.
pub fn set_up(spec: &BusSpec) -> Result<Bus> {
    match &spec.robot {
        Some(robot) => set_up_model(spec, Model::load(&robot.model)?),
        None => Ok(spec.bus()),
    }
}

/// The bus that `spec` describes, with this model as its robot whatever file it names.
///
/// # Errors
/// The model does not fit, or it needs servos that are not there.
pub fn set_up_model(spec: &BusSpec, model: Model) -> Result<Bus> {
    let mut bus = spec.bus();
    let described = spec.robot.clone().unwrap_or_default();
    bus.attach(robot(&described, model, &spec.ids)?);
    Ok(bus)
}

fn robot(spec: &RobotSpec, model: Model, ids: &[u8]) -> Result<Robot> {
    model.planar_only("what hangs on simulated servos moves in a plane")?;
    model.hinges_only("simulated servos turn")?;
    let driven: Vec<usize> = (0..model.joints.len())
        .filter(|at| model.joints[*at].drive.is_driven())
        .collect();
    let servos = match (&spec.joints, driven.len()) {
        (Some(joints), _) => joints.clone(),
        (None, 1) => vec![vec![1]],
        (None, 2) => vec![vec![1, 2], vec![11, 12]],
        (None, _) => Vec::new(),
    };
    let absent = servos.iter().flatten().find(|id| !ids.contains(id));
    if let Some(id) = absent {
        return Err(Error::usage(
            format!("the robot hangs on servo {id}, which is not there"),
            "name the servos of each driven joint: joints=1+2/11+12",
        ));
    }
    if driven.len() != servos.len() {
        return Err(Error::usage(
            format!(
                "`{}` has {} driven joints, and servos are given for {}",
                model.name,
                driven.len(),
                servos.len()
            ),
            "say which servos move each, from the base outwards: joints=1+2/11+12",
        ));
    }
    let mut angle_rad = match spec.start {
        Start::Hanging => hanging(&model),
        Start::Upright | Start::Held => upright(&model),
    };
    if spec.lean_rad.len() > angle_rad.len() {
        return Err(Error::usage(
            format!(
                "lean names {} joints, and `{}` has {}",
                spec.lean_rad.len(),
                model.name,
                angle_rad.len()
            ),
            "give degrees for each joint from the base outwards: lean=1/-1/0.5",
        ));
    }
    let leans = angle_rad.iter_mut().zip(&spec.lean_rad);
    leans.for_each(|(angle, lean)| *angle += lean);
    let live = Live::new(&with_motors(model), &angle_rad)?;
    let mut robot = Robot::new(Box::new(LivePlant(live)), driven.into_iter().zip(servos));
    robot.set_lag(spec.lag_s);
    robot.set_gyro(spec.gyro);
    if spec.start == Start::Held {
        robot.hold();
    }
    Ok(robot)
}

/// A joint driven by a torque gets a motor with the paper's limit.
fn with_motors(mut model: Model) -> Model {
    for joint in &mut model.joints {
        if joint.drive == Drive::Torque {
            joint.drive = Drive::Duty(Motor {
                stall_torque_nm: FULL_NM,
                no_load_speed_rad_s: f64::INFINITY,
                nominal_supply_v: None,
            });
        }
    }
    model
}

/// A model in real time as the plant of simulated servos.
#[derive(Debug)]
struct LivePlant(Live);

impl Plant for LivePlant {
    fn joint_count(&self) -> usize {
        self.0.joint_count()
    }

    fn step_s(&self) -> f64 {
        self.0.step_s()
    }

    fn delay_s(&self, joint: usize) -> f64 {
        self.0.delay_s(joint)
    }

    fn set_duty(&mut self, joint: usize, duty: Option<f64>, supply_v: f64) {
        self.0.command(joint, duty, supply_v);
    }

    fn advance(&mut self, span_s: f64) {
        self.0.advance(span_s);
    }

    fn angle_rad(&self, joint: usize) -> f64 {
        self.0.angle_rad(joint)
    }

    fn speed_rad_s(&self, joint: usize) -> f64 {
        self.0.speed_rad_s(joint)
    }

    fn shaft(&self, joint: usize) -> (f64, f64) {
        self.0.shaft(joint)
    }
}
