//! A model simulated step by step, its drives commanded from outside: a robot behind simulated
//! servos.

use super::drive::DriveInput;
use super::plant::Plant;
use super::rows::DynamicRows;
use super::run::StartState;
use super::sensor_state::SensorState;
use super::stepper::{Stepper, steps};
use crate::error::{Error, Result};
use crate::model::{Drive, Model};

/// A model in motion. Its drives are commanded a duty, whatever they are in the model.
#[derive(Debug, Clone)]
pub struct Live {
    plant: Plant,
    stepper: Stepper<DynamicRows>,
    sensors: SensorState,
    inputs: Vec<DriveInput>,
    nominal_supply_v: Vec<Option<f64>>,
}

impl Live {
    /// At rest at these angles, rad in the model's convention.
    ///
    /// A position or speed servo becomes its bare motor: who tells the duty is the regulator. A
    /// torque drive must have become a motor before, for it has no full duty.
    ///
    /// # Errors
    /// Another number of angles, or a torque drive.
    pub fn new(model: &Model, angle_rad: &[f64]) -> Result<Live> {
        if angle_rad.len() != model.link_count() {
            return Err(Error::design(
                format!(
                    "{} angles for {} joints",
                    angle_rad.len(),
                    model.link_count()
                ),
                "give one angle per joint",
            ));
        }
        if model
            .joints
            .iter()
            .any(|joint| joint.drive == Drive::Torque)
        {
            return Err(Error::design(
                format!(
                    "`{}` has a joint driven by a torque, not by a servo",
                    model.name
                ),
                "give it `drive = \"position\"` with gain_per_rad, stall_torque_nm, \
                 no_load_speed_rad_s",
            ));
        }
        let model = bare_motors(model);
        let plant = Plant::without_log(&model);
        let angles = plant.decode_rad(angle_rad);
        let supply = |joint: &crate::model::Joint| joint.drive.motor()?.nominal_supply_v;
        let mut sensors = SensorState::default();
        let at_rest = StartState {
            speed_rad_s: vec![0.0; angles.len()],
            angle_rad: angles.clone(),
            ..StartState::default()
        };
        sensors.begin(&plant, &at_rest);
        sensors.step(&plant, (&angles, &at_rest.speed_rad_s), 0.0);
        Ok(Live {
            sensors,
            stepper: Stepper::new(&plant, &angles, &vec![0.0; angles.len()]),
            inputs: vec![
                DriveInput {
                    energised: false,
                    ..DriveInput::ZERO
                };
                angles.len()
            ],
            nominal_supply_v: model.joints.iter().map(supply).collect(),
            plant,
        })
    }

    /// Commands a drive's duty, -1 to 1, at this supply, V; none: it is not energised.
    pub fn command(&mut self, joint: usize, duty: Option<f64>, supply_v: f64) {
        let input = &mut self.inputs[joint];
        input.energised = duty.is_some();
        input.input = duty.unwrap_or(0.0);
        if let Some(nominal) = self.nominal_supply_v[joint] {
            input.supply_ratio = supply_v / nominal;
        }
    }

    /// Goes on for `span_s` under constant duties.
    pub fn advance(&mut self, span_s: f64) {
        let (steps, h) = steps(span_s, self.plant.step_s);
        for _ in 0..steps {
            self.stepper.advance(&self.plant, &self.inputs, h);
            if self.plant.senses {
                self.sensors.step(&self.plant, self.stepper.state(), h);
            }
        }
    }

    /// Longest step of the integration, s.
    pub fn step_s(&self) -> f64 {
        self.plant.step_s
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.inputs.len()
    }

    /// How late the drive of a joint obeys, s.
    pub fn delay_s(&self, joint: usize) -> f64 {
        self.plant.joints[joint].delay_s
    }

    /// Angle of a joint in the model's convention, rad.
    pub fn angle_rad(&self, joint: usize) -> f64 {
        self.plant.encoded_rad(joint, &self.stepper.angle)
    }

    /// How fast that changes, rad/s.
    pub fn speed_rad_s(&self, joint: usize) -> f64 {
        self.plant.encoded_rad_s(joint, &self.stepper.speed)
    }

    /// Angle of a joint in the model's convention as its encoder reads it, rad: behind backlash and
    /// lag.
    pub fn reading_rad(&self, joint: usize) -> f64 {
        if self.plant.senses {
            self.sensors.reading[joint]
        } else {
            self.angle_rad(joint)
        }
    }

    /// Angle and speed of the shaft in a joint as its encoder reads them: from the link before it,
    /// whatever the model's convention, rad and rad/s.
    pub fn shaft(&self, joint: usize) -> (f64, f64) {
        if self.plant.is_absolute() && joint > 0 {
            // Readings of absolute angles differ by the link's before.
            let trail = |at: usize| self.reading_rad(at) - self.angle_rad(at);
            let angle_rad = self.stepper.angle[joint] + trail(joint) - trail(joint - 1);
            (angle_rad, self.stepper.speed[joint])
        } else {
            (self.reading_rad(joint), self.speed_rad_s(joint))
        }
    }
}

/// The model with every position or speed servo replaced by its bare motor, commanded in duty.
pub fn bare_motors(model: &Model) -> Model {
    let mut model = model.clone();
    for joint in &mut model.joints {
        if let Drive::Position { motor, .. } | Drive::Speed { motor, .. } = &joint.drive {
            joint.drive = Drive::Duty(motor.clone());
        }
    }
    model
}
