//! Sensors with memory (backlash, lag): what they read as the joints move.

use super::plant::Plant;
use super::run::Start;

/// Readings of all sensors, and what sensor effects remember from one step to the next.
#[derive(Debug, Clone, Default)]
pub struct SensorState {
    /// Per sensor effect, its [encoded value, reading] of the step before.
    cells: Vec<Option<[f64; 2]>>,
    /// Per joint, rad in the log's convention; rad/s where the rate is read.
    pub(super) reading: Vec<f64>,
}

impl SensorState {
    /// Prepares for a stretch that begins at `start`: sensors that trail begin as far behind as the
    /// speed of their readings says, for a stretch may begin at speed.
    pub(super) fn begin(&mut self, plant: &Plant, start: &Start) {
        let cells = plant.joints.iter().map(|j| j.sense.len()).sum();
        if self.cells.len() != cells {
            self.cells = vec![None; cells];
        }
        self.reading.resize(plant.len(), 0.0);
        let mut cells = self.cells.iter_mut();
        for (joint, plan) in plant.joints.iter().enumerate() {
            let mut reading = plant.encoded(joint, &start.angle_rad, &start.speed_rad_s);
            let slope = match &start.reading_slope {
                Some(slope) => slope[joint],
                None if plant.rates[joint] => 0.0,
                None => plant.encoded_rad_s(joint, &start.speed_rad_s),
            };
            for (active, cell) in plan.sense.iter().zip(&mut cells) {
                if let Some(trail) = active.effect.trail_rad(active.values(), slope) {
                    *cell = Some([reading, reading - trail]);
                    reading -= trail;
                }
            }
        }
    }

    /// Follows the joints to these relative angles, rad, and speeds, rad/s, reached `step_s` after
    /// the ones before.
    #[inline]
    pub(super) fn step(
        &mut self,
        plant: &Plant,
        (angle_rad, speed_rad_s): (&[f64], &[f64]),
        step_s: f64,
    ) {
        let mut cells = self.cells.iter_mut();
        for (joint, plan) in plant.joints.iter().enumerate() {
            let mut reading = plant.encoded(joint, angle_rad, speed_rad_s);
            for (active, cell) in plan.sense.iter().zip(&mut cells) {
                reading = active.effect.sense(active.values(), cell, reading, step_s);
            }
            self.reading[joint] = reading;
        }
    }

    /// Writes what the log holds as sample `k` of `samples`, joint by joint.
    pub(super) fn record(&self, readings: &mut [f64], k: usize, samples: usize) {
        for (joint, reading) in self.reading.iter().enumerate() {
            readings[joint * samples + k] = *reading;
        }
    }
}
