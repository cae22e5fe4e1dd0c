//! One run of the loop, from event to event.

use super::body::Body;
use super::outcome::Tally;
use super::pending::Pending;
use super::{ClosedLoop, Controller, InitialState, Measurement, Outcome};
use crate::sim::drive::DriveInput;
use rand_chacha::ChaCha8Rng;

/// Times nearer than this are the same, s.
const AT_ONCE_S: f64 = 1e-9;

/// The loop at a sample, as deviations from the pose.
#[derive(Debug, Clone, Copy)]
pub struct Sample<'a> {
    /// Time, s.
    pub time_s: f64,
    /// True angles, rad.
    pub angle_rad: &'a [f64],
    /// True speeds, rad/s.
    pub speed_rad_s: &'a [f64],
    /// What the controller was given.
    pub measured: Measurement<'a>,
    /// What it commands, N m or what the loop's commands are.
    pub command: &'a [f64],
    /// Torque that acts as the sample is taken, N m.
    pub torque_nm: &'a [f64],
}

/// A run on its way. All memory is taken at the beginning.
#[derive(Debug)]
pub(super) struct Run<'a> {
    pub(super) closed: &'a ClosedLoop,
    controller: &'a dyn Controller,
    rng: ChaCha8Rng,
    /// The robot now.
    pub(super) body: Body,
    /// Inputs of the drives, and of all joints for the general simulation.
    inputs: Vec<DriveInput>,
    command: Vec<f64>,
    memory: Vec<f64>,
    reading_rad: Vec<f64>,
    reading_rad_s: Vec<f64>,
    measured_rad: Vec<f64>,
    measured_rad_s: Vec<f64>,
    pending: Pending,
    ends: Vec<[f64; 2]>,
    tally: Tally,
    now_s: f64,
    late_s: f64,
    sample: usize,
    samples: usize,
    sample_s: f64,
}

/// What a run needs next.
#[derive(Debug, Clone, Copy)]
pub(super) enum RunStep {
    /// The robot must go on for this long, s, under constant inputs.
    Span(f64),
    /// Nothing: it is over.
    Over(Outcome),
}

impl<'a> Run<'a> {
    pub(super) fn new(
        closed: &'a ClosedLoop,
        controller: &'a dyn Controller,
        start: &InitialState,
        seconds: f64,
        rng: ChaCha8Rng,
    ) -> Self {
        let plant = &closed.plant;
        let (joints, drives) = (plant.joints(), plant.drives());
        let mut memory = vec![0.0; controller.memory_len()];
        controller.reset(&mut memory);
        let period_s = closed.clock.period_s;
        let delays_s = plant.drives.iter().map(|drive| drive.delay_s);
        let mut run = Run {
            closed,
            controller,
            rng,
            body: Body::new(plant, &start.angle_rad, &start.speed_rad_s),
            inputs: plant
                .disturbance_nm
                .iter()
                .map(|&disturbance_nm| DriveInput {
                    disturbance_nm,
                    ..DriveInput::ZERO
                })
                .collect(),
            command: vec![0.0; drives],
            memory,
            reading_rad: vec![0.0; joints],
            reading_rad_s: vec![0.0; joints],
            measured_rad: vec![0.0; joints],
            measured_rad_s: vec![0.0; joints],
            pending: Pending::new(delays_s, period_s),
            ends: vec![[f64::INFINITY, f64::NEG_INFINITY]; joints],
            tally: Tally::new(),
            now_s: 0.0,
            late_s: (seconds - 1.0).max(seconds / 2.0),
            sample: 0,
            samples: (seconds / period_s - 1e-6).ceil().max(1.0) as usize,
            sample_s: 0.0,
        };
        for drive in 0..drives {
            let command = start.command.get(drive).copied().unwrap_or(0.0);
            plant.obey(drive, command, &mut run.inputs, &mut run.body);
        }
        run
    }

    /// Does all that is due now; what comes next. After a span the robot must have moved.
    #[inline]
    pub(super) fn next(&mut self, see: &mut impl FnMut(Sample<'_>)) -> RunStep {
        loop {
            if self.now_s >= self.sample_s
                && let Some(outcome) = self.take_sample(see)
            {
                return RunStep::Over(outcome);
            }
            self.obey_due();
            let next_s = match self.pending.due_s() {
                due if due < self.sample_s - AT_ONCE_S => due,
                _ => self.sample_s,
            };
            let span_s = next_s - self.now_s;
            self.now_s = next_s;
            if span_s > 0.0 {
                self.tally.torque(&self.body.drive_nm, span_s);
                return RunStep::Span(span_s);
            }
        }
    }

    /// Commands that are due reach their drives.
    #[inline]
    fn obey_due(&mut self) {
        let plant = &self.closed.plant;
        let (inputs, body) = (&mut self.inputs, &mut self.body);
        self.pending.pop(self.now_s + AT_ONCE_S, |drive, command| {
            plant.obey(drive, command, inputs, body);
        });
    }

    /// A sample: the robot is judged, measured and commanded. The outcome if that was the end.
    #[inline]
    fn take_sample(&mut self, see: &mut impl FnMut(Sample<'_>)) -> Option<Outcome> {
        let ClosedLoop {
            plant,
            sensor,
            clock,
            limits,
            command_step,
        } = self.closed;
        let angle_rad = &self.body.angle_rad;
        if limits.has_fallen(plant, angle_rad, &self.body.speed_rad_s) {
            return Some(self.outcome(true));
        }
        let late = self.now_s >= self.late_s;
        self.tally
            .sample(self.now_s, angle_rad, limits, late, &mut self.ends);
        plant.readings(&self.body, &mut self.reading_rad, &mut self.reading_rad_s);
        sensor.read(
            clock.period_s,
            self.sample == 0,
            &self.reading_rad,
            &self.reading_rad_s,
            self.body.speed_rad_s[0],
            &mut self.measured_rad,
            &mut self.measured_rad_s,
            &mut self.rng,
        );
        let measured = Measurement {
            angle_rad: &self.measured_rad,
            speed_rad_s: &self.measured_rad_s,
        };
        let lost = clock.loses(&mut self.rng);
        self.controller
            .control(&mut self.memory, measured, &mut self.command);
        see(Sample {
            time_s: self.now_s,
            angle_rad: &self.body.angle_rad,
            speed_rad_s: &self.body.speed_rad_s,
            measured,
            command: &self.command,
            torque_nm: &self.body.drive_nm,
        });
        if *command_step > 0.0 {
            for command in &mut self.command {
                *command = (*command / command_step).round() * command_step;
            }
        }
        if !lost {
            self.pending.push(self.now_s, &self.command);
        }
        if self.sample == self.samples {
            return Some(self.outcome(false));
        }
        self.sample += 1;
        // The run ends on time.
        self.sample_s = if self.sample == self.samples {
            self.samples as f64 * clock.period_s
        } else {
            clock.time_s(self.sample, &mut self.rng)
        };
        None
    }

    fn outcome(&self, fell: bool) -> Outcome {
        let ClosedLoop { plant, limits, .. } = self.closed;
        let (end_s, drives) = (self.now_s, plant.drives());
        self.tally.outcome(end_s, fell, drives, limits, &self.ends)
    }

    /// To its end, alone.
    pub(super) fn finish(mut self, mut see: impl FnMut(Sample<'_>)) -> Outcome {
        loop {
            match self.next(&mut see) {
                RunStep::Over(outcome) => return outcome,
                RunStep::Span(span_s) => {
                    let plant = &self.closed.plant;
                    plant.advance(&mut self.body, &self.inputs, span_s);
                }
            }
        }
    }
}
