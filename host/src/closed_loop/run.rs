//! One run of the loop, from event to event.

use super::outcome::Tally;
use super::pending::Pending;
use super::plant::Body;
use super::{ClosedLoop, Controller, Outcome, Seen, Start};
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
    /// What the controller saw.
    pub seen: Seen<'a>,
    /// What it asks for, N m.
    pub command_nm: &'a [f64],
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
    /// Torques of the drives, N m.
    pub(super) torque: Vec<f64>,
    memory: Vec<f64>,
    seen_rad: Vec<f64>,
    seen_rad_s: Vec<f64>,
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
pub(super) enum Next {
    /// The robot must go on for this long, s, under constant torques.
    Span(f64),
    /// Nothing: it is over.
    Over(Outcome),
}

impl<'a> Run<'a> {
    pub(super) fn new(
        closed: &'a ClosedLoop,
        controller: &'a dyn Controller,
        start: &Start,
        seconds: f64,
        rng: ChaCha8Rng,
    ) -> Self {
        let (joints, drives) = (closed.plant.joints(), closed.plant.drives());
        let mut memory = vec![0.0; controller.memory_len()];
        controller.reset(&mut memory);
        let mut body = Body::new(&closed.plant);
        body.angle_rad.copy_from_slice(&start.angle_rad);
        body.speed_rad_s.copy_from_slice(&start.speed_rad_s);
        let periods = seconds / closed.conditions.clock.period_s;
        Run {
            closed,
            controller,
            rng,
            body,
            torque: vec![0.0; drives],
            memory,
            seen_rad: vec![0.0; joints],
            seen_rad_s: vec![0.0; joints],
            pending: Pending::new(drives, closed.conditions.actuator.delay_periods),
            ends: vec![[f64::INFINITY, f64::NEG_INFINITY]; joints],
            tally: Tally::new(),
            now_s: 0.0,
            late_s: (seconds - 1.0).max(seconds / 2.0),
            sample: 0,
            samples: (periods - 1e-6).ceil().max(1.0) as usize,
            sample_s: 0.0,
        }
    }

    /// Does all that is due now; what comes next. After a span the robot must have moved.
    #[inline]
    pub(super) fn next(&mut self, see: &mut impl FnMut(Sample<'_>)) -> Next {
        loop {
            if self.now_s >= self.sample_s
                && let Some(outcome) = self.take_sample(see)
            {
                return Next::Over(outcome);
            }
            while self.pending.due_s() <= self.now_s + AT_ONCE_S {
                let actuator = &self.closed.conditions.actuator;
                for (torque, command) in self.torque.iter_mut().zip(self.pending.pop()) {
                    *torque = actuator.torque_nm(*command);
                }
            }
            let next_s = match self.pending.due_s() {
                due if due < self.sample_s - AT_ONCE_S => due,
                _ => self.sample_s,
            };
            let span_s = next_s - self.now_s;
            self.now_s = next_s;
            if span_s > 0.0 {
                self.tally.torque(&self.torque, span_s);
                return Next::Span(span_s);
            }
        }
    }

    /// A sample: the robot is judged, seen and commanded. The outcome if that was the end.
    #[inline]
    fn take_sample(&mut self, see: &mut impl FnMut(Sample<'_>)) -> Option<Outcome> {
        let ClosedLoop {
            plant,
            conditions,
            limits,
        } = self.closed;
        if limits.has_fallen(&self.body.angle_rad, &self.body.speed_rad_s) {
            let outcome = self
                .tally
                .outcome(self.now_s, true, plant.drives(), &self.ends);
            return Some(outcome);
        }
        let late = self.now_s >= self.late_s;
        let angle_rad = &self.body.angle_rad;
        self.tally.sample(
            self.now_s,
            angle_rad,
            limits.settle_rad,
            late,
            &mut self.ends,
        );
        conditions.sensor.read(
            conditions.clock.period_s,
            self.sample == 0,
            angle_rad,
            &self.body.speed_rad_s,
            &mut self.seen_rad,
            &mut self.seen_rad_s,
            &mut self.rng,
        );
        let seen = Seen {
            angle_rad: &self.seen_rad,
            speed_rad_s: &self.seen_rad_s,
        };
        let delay_s = conditions.actuator.delay_periods * conditions.clock.period_s;
        let lost = conditions.clock.loses(&mut self.rng);
        let command = self.pending.push(self.now_s + delay_s);
        self.controller.control(&mut self.memory, seen, command);
        see(Sample {
            time_s: self.now_s,
            angle_rad,
            speed_rad_s: &self.body.speed_rad_s,
            seen,
            command_nm: command,
            torque_nm: &self.torque,
        });
        if lost {
            self.pending.lose();
        }
        if self.sample == self.samples {
            let outcome = self
                .tally
                .outcome(self.now_s, false, plant.drives(), &self.ends);
            return Some(outcome);
        }
        self.sample += 1;
        // The run ends on time.
        self.sample_s = match self.sample == self.samples {
            true => self.samples as f64 * conditions.clock.period_s,
            false => conditions.clock.time_s(self.sample, &mut self.rng),
        };
        None
    }

    /// To its end, alone.
    pub(super) fn finish(mut self, mut see: impl FnMut(Sample<'_>)) -> Outcome {
        loop {
            match self.next(&mut see) {
                Next::Over(outcome) => return outcome,
                Next::Span(span_s) => {
                    self.closed
                        .plant
                        .advance(&mut self.body, &self.torque, span_s);
                }
            }
        }
    }
}
