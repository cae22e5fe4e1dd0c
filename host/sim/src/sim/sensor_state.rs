//! Sensors with memory (backlash, lag): what they read as the joints move.

use super::joint_plan::{ActiveEffect, JointPlan};
use super::plant::Plant;
use super::run::StartState;
use crate::effects::{Encoded, SenseMemory};

/// Readings of all sensors, and what sensor effects remember from one step to the next.
#[derive(Debug, Clone, Default)]
pub struct SensorState {
    /// Per sensor effect, what it remembers of the step before.
    pub(super) cells: Vec<Option<SenseMemory>>,
    /// Per joint, rad in the log's convention; rad/s where the rate is read. Then what the rate
    /// sensors read that joints have beside those of their angles, rad/s.
    pub(super) reading: Vec<f64>,
    /// Per signal that is a rate, the angle that it is the rate of, rad, at the last step.
    turned: Vec<f64>,
}

impl SensorState {
    /// Prepares for a stretch that begins at `start`: sensors that trail begin as far behind as the
    /// speed of their readings says, for a stretch may begin at speed.
    pub(super) fn begin(&mut self, plant: &Plant, start: &StartState) {
        self.fit_to(plant);
        self.reading.resize(plant.signals(), 0.0);
        self.turned.resize(plant.signals(), 0.0);
        for (signal, turned) in self.turned.iter_mut().enumerate() {
            *turned = plant.turned_of(signal, &start.angle_rad).unwrap_or(0.0);
        }
        let mut cells = self.cells.iter_mut();
        for (joint, plan) in plant.joints.iter().enumerate() {
            let reading = plant.encoded(joint, &start.angle_rad, &start.speed_rad_s);
            let slope = match &start.reading_slope {
                Some(slope) => slope[joint],
                None if plant.rates[joint] => 0.0,
                None => plant.encoded_rad_s(joint, &start.speed_rad_s),
            };
            trail_behind(&plan.sense, &mut cells, reading, slope);
        }
        for (index, rate) in plant.rate_readings.iter().enumerate() {
            let reading = rate.encoded_rad_s(&start.speed_rad_s);
            let slopes = start.reading_slope.as_ref();
            let slope = slopes.and_then(|slopes| slopes.get(plant.len() + index));
            trail_behind(
                &rate.sense,
                &mut cells,
                reading,
                slope.copied().unwrap_or(0.0),
            );
        }
    }

    /// Has a cell for each sensor effect of the plant.
    pub(super) fn fit_to(&mut self, plant: &Plant) {
        let of_joints = plant.joints.iter().map(|j| j.sense.len());
        let of_rates = plant.rate_readings.iter().map(|rate| rate.sense.len());
        let cells = of_joints.chain(of_rates).sum();
        if self.cells.len() != cells {
            self.cells = vec![None; cells];
        }
    }

    /// A start state that was taken from readings, with what has slipped until then.
    pub(super) fn beside_slips(&self, plant: &Plant, start: &StartState) -> StartState {
        let mut start = start.clone();
        let mut cells = self.cells.iter();
        let slipped = |plan: &JointPlan| {
            let own = plan.sense.iter().zip(&mut cells);
            let own = own.filter_map(|(e, cell)| Some(e.effect.slipped((*cell)?)));
            own.fold((0.0, 0.0), |sum, [rad, rad_s]| (sum.0 + rad, sum.1 + rad_s))
        };
        let (rad, rad_s): (Vec<f64>, Vec<f64>) = plant.joints.iter().map(slipped).unzip();
        for (of, slipped) in [(&mut start.angle_rad, rad), (&mut start.speed_rad_s, rad_s)] {
            if slipped.iter().any(|slipped| *slipped != 0.0) {
                let turned = plant.turned_rad(&slipped);
                of.iter_mut()
                    .zip(turned)
                    .for_each(|(of, turned)| *of += turned);
            }
        }
        start
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
            let mut encoded = Encoded::still(plant.encoded(joint, angle_rad, speed_rad_s));
            if !plan.sense.is_empty() {
                encoded.speed_rad_s = plant.encoded_rad_s(joint, speed_rad_s);
                encoded.mean = mean(&mut self.turned, plant, (joint, angle_rad), step_s);
            }
            self.reading[joint] = sensed(&plan.sense, &mut cells, encoded, step_s);
        }
        for (index, rate) in plant.rate_readings.iter().enumerate() {
            let signal = plant.len() + index;
            let mut encoded = Encoded::still(rate.encoded_rad_s(speed_rad_s));
            if !rate.sense.is_empty() {
                encoded.mean = mean(&mut self.turned, plant, (signal, angle_rad), step_s);
            }
            self.reading[signal] = sensed(&rate.sense, &mut cells, encoded, step_s);
        }
    }

    /// Writes what the log holds as sample `k` of `samples`, signal by signal.
    pub(super) fn record(&self, readings: &mut [f64], k: usize, samples: usize) {
        for (joint, reading) in self.reading.iter().enumerate() {
            readings[joint * samples + k] = *reading;
        }
    }
}

/// What is read through these effects of what has come to be `encoded`.
fn sensed<'a>(
    sense: &[ActiveEffect],
    cells: &mut impl Iterator<Item = &'a mut Option<SenseMemory>>,
    mut encoded: Encoded,
    step_s: f64,
) -> f64 {
    for (active, cell) in sense.iter().zip(cells) {
        encoded.angle_rad = active.effect.sense(active.values(), cell, encoded, step_s);
        encoded.mean = None;
    }
    encoded.angle_rad
}

/// Mean of a signal over a step that ends at these angles, where the signal is a rate: what has
/// turned meanwhile over the time.
fn mean(
    turned: &mut [f64],
    plant: &Plant,
    (signal, angle_rad): (usize, &[f64]),
    step_s: f64,
) -> Option<f64> {
    let now = plant.turned_of(signal, angle_rad)?;
    let before = std::mem::replace(&mut turned[signal], now);
    Some((now - before) / step_s + plant.rate_bias_of(signal)).filter(|mean| mean.is_finite())
}

/// Lets sensors begin as far behind a `reading` as they come to be while it changes by `slope` a
/// second; what slips before them stays as far behind as it is.
fn trail_behind<'a>(
    sense: &[ActiveEffect],
    cells: &mut impl Iterator<Item = &'a mut Option<SenseMemory>>,
    mut reading: f64,
    slope: f64,
) {
    for (active, cell) in sense.iter().zip(cells) {
        if let Some(trail) = active.effect.trail_rad(active.values(), slope) {
            *cell = Some(SenseMemory::reads(reading - trail, reading));
            reading -= trail;
        } else if let Some(memory) = *cell {
            let [slipped_rad, _] = active.effect.slipped(memory);
            reading -= slipped_rad;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::model::Model;
    use crate::motion::Motion;
    use crate::sim::{Plant, PlantMemory, StartState, predict};
    use std::path::Path;

    /// An arm with friction, pushed to and fro, whose sensor's shaft slips.
    fn read(step_s: f64) -> Vec<f64> {
        let text = format!(
            "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\nstep_s = {step_s}\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 1e-3\n\
             [[joint]]\ndrive = \"torque\"\n\
             [[effect]]\nkind = \"coulomb\"\njoint = 1\ntorque_nm = 0.05\n\
             [[effect]]\nkind = \"grip_slip\"\njoint = 1\nacceleration_rad_s2 = 60.0\n\
             [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             [[log.joint]]\nposition = {{ column = \"q\", unit = \"rad\" }}\n\
             input = {{ column = \"u\", unit = \"N m\" }}\n"
        );
        let model = Model::parse(&text, Path::new("a.toml")).unwrap();
        let time_s: Vec<f64> = (0..1000).map(|k| f64::from(k) * 0.01).collect();
        let pushed = |t: &f64| 0.25 * (9.0 * t).sin() + 0.2 * (23.0 * t).cos();
        let motion = Motion {
            position_rad: vec![vec![0.0; time_s.len()]],
            velocity_rad_s: vec![None],
            input: vec![Some(time_s.iter().map(pushed).collect())],
            time_s,
            ..Motion::default()
        };
        let start = StartState {
            angle_rad: vec![0.0],
            speed_rad_s: vec![0.0],
            reading_slope: None,
        };
        let (plant, mut memory) = (Plant::new(&model, &motion), PlantMemory::default());
        let mut readings = vec![0.0; motion.len()];
        let all = 0..motion.len();
        predict(&plant, &motion, all, &start, &mut memory, &mut readings);
        readings
    }

    /// What has slipped never comes back, so no step may be longer than the law follows.
    #[test]
    fn a_shaft_that_slips_reads_the_same_in_long_steps() {
        let (long, short) = (read(0.005), read(0.0002));
        let off = long.iter().zip(&short).map(|(a, b)| (a - b).abs());
        let most_rad = off.fold(0.0, f64::max);
        assert!(most_rad < 1e-3, "{most_rad}");
    }
}
