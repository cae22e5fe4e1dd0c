//! Simulation along a stretch of a motion: predicted encoder readings at every sample.

use super::drive::Told;
use super::input::held_mean;
use super::plant::Plant;
use super::rows::{Many, One, Rows};
use super::stepper::Stepper;
use crate::log::Motion;
use crate::model::Drive;
use std::ops::Range;

/// State at the first sample of a stretch: relative angles (joint 1 from hanging), rad, and speeds, rad/s.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Start {
    /// Per joint, rad.
    pub angle_rad: Vec<f64>,
    /// Per joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// How fast the readings change, rad/s in the log's convention, where sensors trail; as fast as the joints without.
    pub reading_rad_s: Option<Vec<f64>>,
}

/// What sensor effects remember from one stretch to the next.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    cells: Vec<Option<[f64; 2]>>,
}

/// Jitter must not cost steps: one may be longer than the model's step by up to a tenth, shared out over the period.
const SPARED: f64 = 0.1;

/// Predicted readings, rad in the log's convention, at samples `stretch` of the motion.
///
/// `readings[joint * stretch.len() + k]` is joint `joint` at sample `stretch.start + k`. Inputs are the recorded
/// ones, each held until the next sample. Returns the state at the last sample of the stretch. A state that
/// grows beyond all bounds leaves not-a-number in the rest.
pub fn predict(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &Start,
    memory: &mut Memory,
    readings: &mut [f64],
) -> Start {
    match plant.len() {
        1 => predicted::<One>(plant, motion, stretch, start, memory, readings),
        _ => predicted::<Many>(plant, motion, stretch, start, memory, readings),
    }
}

fn predicted<R: Rows>(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &Start,
    memory: &mut Memory,
    readings: &mut [f64],
) -> Start {
    let n = plant.len();
    let samples = stretch.len();
    let mut stepper = Stepper::<R>::new(plant, &start.angle_rad, &start.speed_rad_s);
    let mut recorder = Recorder::new(plant, memory);
    let mut told = vec![
        Told {
            input: 0.0,
            supply_ratio: 1.0,
            energised: true,
            shuffled_rad_s: 0.0,
        };
        n
    ];
    let mut cursors = vec![0; n];
    recorder.begin(plant, start);
    recorder.step(plant, stepper.angle.as_ref(), 0.0);
    recorder.record(readings, 0, samples);
    for k in stretch.start..stretch.end.saturating_sub(1) {
        let (from, to) = (motion.time_s[k], motion.time_s[k + 1]);
        let steps = ((to - from) / plant.step_s - SPARED).ceil().max(1.0) as usize;
        let h = (to - from) / steps as f64;
        for step in 0..steps {
            let begin = from + step as f64 * h;
            tell(plant, motion, k, begin, begin + h, &mut cursors, &mut told);
            stepper.advance(plant, &told, h);
            if plant.senses {
                recorder.step(plant, stepper.angle.as_ref(), h);
            }
        }
        if !plant.senses {
            recorder.step(plant, stepper.angle.as_ref(), to - from);
        }
        if !stepper.angle.as_ref().iter().all(|a| a.abs() < 1e6) {
            for joint in 0..n {
                readings[joint * samples + k + 1 - stretch.start..(joint + 1) * samples]
                    .fill(f64::NAN);
            }
            break;
        }
        recorder.record(readings, k + 1 - stretch.start, samples);
    }
    Start {
        angle_rad: stepper.angle.as_ref().to_vec(),
        speed_rad_s: stepper.speed.as_ref().to_vec(),
        reading_rad_s: None,
    }
}

/// What each drive is told over one integration step.
fn tell(
    plant: &Plant,
    motion: &Motion,
    sample: usize,
    from_s: f64,
    to_s: f64,
    cursors: &mut [usize],
    told: &mut [Told],
) {
    for (joint, plan) in plant.joints.iter().enumerate() {
        if let Some(shuffled) = plant.shuffled_rad_s.get(joint) {
            told[joint].shuffled_rad_s = shuffled[sample];
        }
        if plan.drive == Drive::Passive {
            continue;
        }
        let told = &mut told[joint];
        if let Some(input) = &motion.input[joint] {
            told.input = if plan.delay_s == 0.0 {
                input[sample]
            } else {
                held_mean(
                    &motion.time_s,
                    input,
                    from_s - plan.delay_s,
                    to_s - plan.delay_s,
                    &mut cursors[joint],
                )
            };
        }
        let nominal = plan.drive.motor().and_then(|m| m.nominal_supply_v);
        if let (Some(supply), Some(nominal)) = (&motion.supply_v, nominal) {
            told.supply_ratio = supply[sample] / nominal;
        }
        told.energised = motion.torque_on.as_ref().is_none_or(|on| on[sample]);
    }
}

/// Follows the encoders and remembers what their effects with memory need.
struct Recorder<'a> {
    memory: &'a mut Memory,
    reading: Vec<f64>,
}

impl<'a> Recorder<'a> {
    fn new(plant: &Plant, memory: &'a mut Memory) -> Self {
        let cells = plant.joints.iter().map(|j| j.sense.len()).sum();
        if memory.cells.len() != cells {
            memory.cells = vec![None; cells];
        }
        Recorder {
            memory,
            reading: vec![0.0; plant.len()],
        }
    }

    /// Sensors that trail begin as far behind as their readings' speed says: a stretch may begin at speed.
    fn begin(&mut self, plant: &Plant, start: &Start) {
        let mut cells = self.memory.cells.iter_mut();
        for (joint, plan) in plant.joints.iter().enumerate() {
            let mut reading = plant.encoded_rad(joint, &start.angle_rad);
            let speed = match &start.reading_rad_s {
                Some(speed) => speed[joint],
                None => plant.encoded_rad_s(joint, &start.speed_rad_s),
            };
            for (active, cell) in plan.sense.iter().zip(&mut cells) {
                if let Some(trail) = active.effect.trail_rad(active.values(), speed) {
                    *cell = Some([reading, reading - trail]);
                    reading -= trail;
                }
            }
        }
    }

    #[inline]
    fn step(&mut self, plant: &Plant, angle_rad: &[f64], step_s: f64) {
        let mut cells = self.memory.cells.iter_mut();
        for (joint, plan) in plant.joints.iter().enumerate() {
            let mut reading = plant.encoded_rad(joint, angle_rad);
            for (active, cell) in plan.sense.iter().zip(&mut cells) {
                reading = active.effect.sense(active.values(), cell, reading, step_s);
            }
            self.reading[joint] = reading;
        }
    }

    fn record(&self, readings: &mut [f64], k: usize, samples: usize) {
        for (joint, reading) in self.reading.iter().enumerate() {
            readings[joint * samples + k] = *reading;
        }
    }
}
