//! Simulation along a stretch of a motion: predicted encoder readings at every sample.

mod beside;
mod time_offset;

pub use beside::KnownRun;

use super::drive::DriveInput;
use super::input::{held_mean, share_before};
use super::memory::PlantMemory;
use super::plant::Plant;
use super::rows::{DynamicRows, FixedRows, Rows};
use super::sensor_state::SensorState;
use super::stepper::Stepper;
use crate::model::Drive;
use crate::motion::Motion;
use std::ops::Range;

/// State at the first sample of a stretch: relative angles (joint 1 from hanging), rad, and speeds,
/// rad/s. Where the log's latest column is late by some time, below 0 where all are early, the
/// state is of so much before that sample; see
/// [`Law::reading_offset_s`](crate::effects::Law::reading_offset_s).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StartState {
    /// Per joint, rad.
    pub angle_rad: Vec<f64>,
    /// Per joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// How fast what is read changes, rad/s in the log's convention, rad/s^2 of a rate, where
    /// sensors trail; as the joints do without.
    pub reading_slope: Option<Vec<f64>>,
}

/// Times this near to each other are one, s.
const NEAR_S: f64 = 1e-9;
/// Jitter must not cost steps: one may be longer than the model's step by up to a tenth, shared out
/// over the period.
const SPARED: f64 = 0.1;

/// Predicted readings, rad in the log's convention, at samples `stretch` of the motion; rates,
/// rad/s, of joints whose rate alone is logged.
///
/// `readings[joint * stretch.len() + k]` is joint `joint` at sample `stretch.start + k`; behind the
/// joints come the rate sensors that joints have beside those of their angles, rad/s, so that
/// `readings` holds [`Plant::signals`] values a sample. Inputs are
/// the recorded ones, each held until the next sample. Returns the state at the last sample of the
/// stretch, or as much before it as `start` is before the first. A state that grows beyond all
/// bounds leaves not-a-number in the rest.
pub fn predict(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &StartState,
    memory: &mut PlantMemory,
    readings: &mut [f64],
) -> StartState {
    match plant.len() {
        1 => predicted::<FixedRows<1>>(plant, motion, stretch, start, memory, readings),
        2 => predicted::<FixedRows<2>>(plant, motion, stretch, start, memory, readings),
        3 => predicted::<FixedRows<3>>(plant, motion, stretch, start, memory, readings),
        _ => predicted::<DynamicRows>(plant, motion, stretch, start, memory, readings),
    }
}

/// The same from a start near that of a run that is known, as far as they differ: once its readings
/// have come to those of the other, the rest is that one's.
///
/// Of a plant that [forgets its start](Plant::forgets_its_start).
pub fn predict_beside(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &StartState,
    known: &KnownRun,
    readings: &mut [f64],
) {
    match plant.len() {
        1 => beside::predicted::<FixedRows<1>>(plant, motion, stretch, start, known, readings),
        2 => beside::predicted::<FixedRows<2>>(plant, motion, stretch, start, known, readings),
        3 => beside::predicted::<FixedRows<3>>(plant, motion, stretch, start, known, readings),
        _ => beside::predicted::<DynamicRows>(plant, motion, stretch, start, known, readings),
    }
}

fn predicted<R: Rows>(
    plant: &Plant,
    motion: &Motion,
    stretch: Range<usize>,
    start: &StartState,
    memory: &mut PlantMemory,
    readings: &mut [f64],
) -> StartState {
    let samples = stretch.len();
    let hidden = std::mem::take(&mut memory.begins);
    cross_gap::<R>(plant, motion, stretch.start, memory);
    memory.sensors.put_hidden(plant, &hidden);
    let start = &memory.sensors.beside_slips(plant, start);
    let is_first = stretch.start == 0 && memory.ended.is_none();
    let mut run = Run::<R>::new(plant, motion, start, std::mem::take(memory));
    (run.stepper.memory()).put_hidden(plant, &start.angle_rad, &hidden);
    if is_first {
        run.before = plant.inputs_before(motion, &hidden);
        (run.stepper.memory()).begin_motion(plant, &run.before, &hidden);
    }
    if plant.has_offsets && samples > 0 {
        return run.record_offset(stretch, memory, readings);
    }
    run.sensors.record(readings, 0, samples);
    for k in stretch.start..stretch.end.saturating_sub(1) {
        run.follow(k);
        let at = k + 1 - stretch.start;
        if run.has_diverged() {
            for reading in readings.chunks_mut(samples) {
                reading[at..].fill(f64::NAN);
            }
            return run.state();
        }
        run.sensors.record(readings, at, samples);
    }
    let end = run.state();
    *memory = run.ended(stretch.end.saturating_sub(1), end.clone());
    end
}

/// No stretch holds the time from its last sample to the first of the next: what is remembered
/// there follows the plant on from where that stretch ended.
fn cross_gap<R: Rows>(plant: &Plant, motion: &Motion, until: usize, memory: &mut PlantMemory) {
    if plant.remembers == 0 && !plant.senses {
        return;
    }
    let Some((sample, state)) = memory.ended.clone().filter(|(sample, _)| *sample <= until) else {
        *memory = PlantMemory::default();
        return;
    };
    let mut run = Run::<R>::new(plant, motion, &state, std::mem::take(memory));
    for k in sample..until {
        run.follow(k);
    }
    if !run.has_diverged() {
        let state = run.state();
        *memory = run.ended(until, state);
    }
}

/// A plant on its way along a motion.
struct Run<'a, R: Rows> {
    plant: &'a Plant,
    motion: &'a Motion,
    stepper: Stepper<R>,
    sensors: SensorState,
    inputs: Vec<DriveInput>,
    cursors: Vec<usize>,
    /// The input of each drive before the log begins.
    before: Vec<f64>,
}

impl<'a, R: Rows> Run<'a, R> {
    fn new(plant: &'a Plant, motion: &'a Motion, start: &StartState, memory: PlantMemory) -> Self {
        let mut stepper = Stepper::<R>::new(plant, &start.angle_rad, &start.speed_rad_s);
        if memory.ended.is_some() {
            *stepper.memory() = memory.effects;
        }
        let before = if memory.before.len() == plant.len() {
            memory.before
        } else {
            plant.inputs_before(motion, &[])
        };
        let mut sensors = memory.sensors;
        sensors.begin(plant, start);
        sensors.step(plant, stepper.state(), 0.0);
        Run {
            plant,
            motion,
            stepper,
            sensors,
            inputs: vec![DriveInput::ZERO; plant.len()],
            cursors: vec![0; plant.len()],
            before,
        }
    }

    /// From sample `k` to the next.
    #[inline]
    fn follow(&mut self, k: usize) {
        if self.plant.has_offsets || !self.plant.delays_s.is_empty() {
            return self.go(self.begin_s(k)..self.begin_s(k + 1));
        }
        self.hold(k, self.motion.time_s[k]..self.motion.time_s[k + 1]);
    }

    /// When the simulation of a stretch begins that begins with sample `k`, s.
    fn begin_s(&self, k: usize) -> f64 {
        self.motion.time_s[k] - self.plant.late_s
    }

    /// From one time to another, with a stop wherever an input changes at a drive, late or not.
    fn go(&mut self, span_s: Range<f64>) {
        let (plant, motion) = (self.plant, self.motion);
        let mut now_s = span_s.start;
        while span_s.end - now_s > NEAR_S {
            let after = |delay_s: f64| {
                let known = |t: &f64| t + delay_s <= now_s + NEAR_S;
                motion.time_s.partition_point(known)
            };
            let changes_s = |delay_s: f64| Some(motion.time_s.get(after(delay_s))? + delay_s);
            let delays_s = plant.delays_s.iter().copied().chain([0.0]);
            let until_s = delays_s.filter_map(changes_s).fold(span_s.end, f64::min);
            self.hold(after(0.0).saturating_sub(1), now_s..until_s);
            now_s = until_s;
        }
    }

    /// From one time to another under the inputs of sample `k`.
    #[inline]
    fn hold(&mut self, k: usize, span_s: Range<f64>) {
        let (plant, motion) = (self.plant, self.motion);
        let (from, to) = (span_s.start, span_s.end);
        let steps = ((to - from) / plant.step_s - SPARED).ceil().max(1.0) as usize;
        let h = (to - from) / steps as f64;
        for step in 0..steps {
            let begin = from + step as f64 * h;
            let span = begin..begin + h;
            let late = LateInputs {
                cursors: &mut self.cursors,
                before: &self.before,
            };
            set_inputs(plant, motion, k, span, late, &mut self.inputs);
            self.stepper.advance(plant, &self.inputs, h);
            if plant.senses {
                self.sensors.step(plant, self.stepper.state(), h);
            }
        }
        if !plant.senses {
            self.sensors.step(plant, self.stepper.state(), to - from);
        }
    }

    fn has_diverged(&self) -> bool {
        !self.stepper.angle.as_ref().iter().all(|a| a.abs() < 1e6)
    }

    fn state(&self) -> StartState {
        StartState {
            angle_rad: self.stepper.angle.as_ref().to_vec(),
            speed_rad_s: self.stepper.speed.as_ref().to_vec(),
            reading_slope: None,
        }
    }

    /// What is remembered at sample `k`, where it ended in this state.
    fn ended(mut self, k: usize, state: StartState) -> PlantMemory {
        PlantMemory {
            effects: std::mem::take(self.stepper.memory()),
            sensors: self.sensors,
            before: self.before,
            ended: Some((k, state)),
            begins: Vec::new(),
        }
    }
}

/// What inputs are late by: where in the log each is, and what was before it.
struct LateInputs<'a> {
    cursors: &'a mut [usize],
    before: &'a [f64],
}

/// Sets every drive's input over one integration step, s.
fn set_inputs(
    plant: &Plant,
    motion: &Motion,
    sample: usize,
    span_s: Range<f64>,
    late: LateInputs,
    inputs: &mut [DriveInput],
) {
    for (joint, plan) in plant.joints.iter().enumerate() {
        inputs[joint].time_s = motion.time_s[sample];
        if let Some(shuffled) = plant.shuffled_rad_s.get(joint) {
            inputs[joint].shuffled_rad_s = shuffled[sample];
        }
        if plan.drive == Drive::Passive {
            continue;
        }
        let at = &mut inputs[joint];
        if let Some(input) = &motion.input[joint] {
            at.input = if plan.delay_s == 0.0 {
                input[sample]
            } else {
                let span_s = span_s.start - plan.delay_s..span_s.end - plan.delay_s;
                let before = share_before(&motion.time_s, &span_s);
                let held = held_mean(&motion.time_s, input, span_s, &mut late.cursors[joint]);
                held + before * (late.before[joint] - input[0])
            };
        }
        let nominal = plan.drive.motor().and_then(|m| m.nominal_supply_v);
        if let (Some(supply), Some(nominal)) = (&motion.supply_v, nominal) {
            at.supply_ratio = supply[sample] / nominal;
        }
        at.energised = motion.torque_on.as_ref().is_none_or(|on| on[sample]);
    }
}
