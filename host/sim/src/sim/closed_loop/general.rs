//! The general simulation as a closed loop advances it: every effect, friction that sticks.

use crate::effects::MemoryCell;
use crate::sim::drive::DriveInput;
use crate::sim::rows::{DynamicRows, FixedRows, Rows};
use crate::sim::sensor_state::SensorState;
use crate::sim::stepper::Stepper;
use crate::sim::{Plant, StartState};
use std::fmt;

/// A state of any number of joints.
pub(super) trait General: fmt::Debug {
    /// Advances by `steps` steps of `step_s` under constant inputs, one per joint.
    fn advance(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64, steps: usize);

    /// Relative angles, joint 1 from hanging, rad.
    fn angle_rad(&self) -> &[f64];

    /// Relative speeds, rad/s.
    fn speed_rad_s(&self) -> &[f64];

    /// Readings of the encoders, rad in the log's convention.
    fn reading_rad(&self) -> &[f64];

    /// What the effects remember.
    fn memory(&self) -> &[MemoryCell];
}

/// A state whose rows `R` keeps.
#[derive(Debug)]
pub(super) struct GeneralState<R: Rows> {
    stepper: Stepper<R>,
    sensors: SensorState,
}

impl GeneralState<DynamicRows> {
    /// At these relative angles and speeds.
    pub(super) fn boxed(plant: &Plant, angle: Vec<f64>, speed: Vec<f64>) -> Box<dyn General> {
        let start = StartState {
            angle_rad: angle,
            speed_rad_s: speed,
            reading_slope: None,
        };
        match plant.len() {
            1 => Box::new(GeneralState::<FixedRows<1>>::new(plant, &start)),
            2 => Box::new(GeneralState::<FixedRows<2>>::new(plant, &start)),
            3 => Box::new(GeneralState::<FixedRows<3>>::new(plant, &start)),
            4 => Box::new(GeneralState::<FixedRows<4>>::new(plant, &start)),
            _ => Box::new(GeneralState::<DynamicRows>::new(plant, &start)),
        }
    }
}

impl<R: Rows> GeneralState<R> {
    fn new(plant: &Plant, start: &StartState) -> Self {
        let mut sensors = SensorState::default();
        sensors.begin(plant, start);
        sensors.step(plant, (&start.angle_rad, &start.speed_rad_s), 0.0);
        GeneralState {
            stepper: Stepper::new(plant, &start.angle_rad, &start.speed_rad_s),
            sensors,
        }
    }
}

impl<R: Rows + fmt::Debug> General for GeneralState<R> {
    fn advance(&mut self, plant: &Plant, inputs: &[DriveInput], step_s: f64, steps: usize) {
        for _ in 0..steps {
            self.stepper.advance(plant, inputs, step_s);
            if plant.senses {
                self.sensors.step(plant, self.stepper.state(), step_s);
            }
        }
    }

    fn angle_rad(&self) -> &[f64] {
        self.stepper.angle.as_ref()
    }

    fn speed_rad_s(&self) -> &[f64] {
        self.stepper.speed.as_ref()
    }

    fn reading_rad(&self) -> &[f64] {
        &self.sensors.reading
    }

    fn memory(&self) -> &[MemoryCell] {
        self.stepper.remembered()
    }
}
