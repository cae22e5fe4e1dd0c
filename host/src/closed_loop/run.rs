//! One run of the loop, and many.

use super::outcome::Tally;
use super::plant::Body;
use super::random::stream;
use super::{Conditions, Controller, Limits, Outcome, Plant, Seen};
use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// A robot under given circumstances, waiting for a controller.
#[derive(Debug, Clone)]
pub struct ClosedLoop {
    /// The robot.
    pub plant: Plant,
    /// Its sensor, its drives and the clock.
    pub conditions: Conditions,
    /// What counts as fallen and as settled.
    pub limits: Limits,
}

/// Where a run begins: deviations from the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Angle of each joint, rad.
    pub angle_rad: Vec<f64>,
    /// Speed of each joint, rad/s.
    pub speed_rad_s: Vec<f64>,
}

impl Start {
    /// At rest at these angles, rad.
    pub fn at(angle_rad: impl Into<Vec<f64>>) -> Self {
        let angle_rad = angle_rad.into();
        Start {
            speed_rad_s: vec![0.0; angle_rad.len()],
            angle_rad,
        }
    }

    /// At rest, each joint evenly anywhere within `spread_rad` of its pose.
    pub fn random(joints: usize, spread_rad: f64, rng: &mut ChaCha8Rng) -> Self {
        let angle = |_| spread_rad * rng.random_range(-1.0..=1.0);
        Start::at((0..joints).map(angle).collect::<Vec<f64>>())
    }
}

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

/// Memory of a run, reused from run to run.
#[derive(Debug, Clone)]
pub struct Workspace {
    body: Body,
    memory: Vec<f64>,
    seen_rad: Vec<f64>,
    seen_rad_s: Vec<f64>,
    torque: Vec<f64>,
    pending: Pending,
    ends: Vec<[f64; 2]>,
}

impl Workspace {
    /// Memory for runs of this loop with this controller.
    pub fn new(closed: &ClosedLoop, controller: &dyn Controller) -> Self {
        let (joints, drives) = (closed.plant.joints(), closed.plant.drives());
        Workspace {
            body: Body::new(&closed.plant),
            memory: vec![0.0; controller.memory_len()],
            seen_rad: vec![0.0; joints],
            seen_rad_s: vec![0.0; joints],
            torque: vec![0.0; drives],
            pending: Pending::new(drives, closed.conditions.actuator.delay_periods),
            ends: vec![[0.0; 2]; joints],
        }
    }
}

/// Commands on their way, in a ring.
#[derive(Debug, Clone)]
struct Pending {
    due_s: Vec<f64>,
    command_nm: Vec<f64>,
    drives: usize,
    first: usize,
    count: usize,
}

impl Pending {
    fn new(drives: usize, delay_periods: f64) -> Self {
        // A jittering sample can be half a period early, so one more may be on its way.
        let places = delay_periods.max(0.0).ceil() as usize + 3;
        Pending {
            due_s: vec![0.0; places],
            command_nm: vec![0.0; places * drives],
            drives,
            first: 0,
            count: 0,
        }
    }

    /// Place for a command that is due at `due_s`.
    #[inline]
    fn push(&mut self, due_s: f64) -> &mut [f64] {
        let place = (self.first + self.count) % self.due_s.len();
        self.due_s[place] = due_s;
        self.count += 1;
        &mut self.command_nm[place * self.drives..][..self.drives]
    }

    /// When the next command is due.
    #[inline]
    fn due_s(&self) -> f64 {
        match self.count {
            0 => f64::INFINITY,
            _ => self.due_s[self.first],
        }
    }

    /// Takes the next command off.
    #[inline]
    fn pop(&mut self) -> &[f64] {
        let place = self.first;
        self.first = (place + 1) % self.due_s.len();
        self.count -= 1;
        &self.command_nm[place * self.drives..][..self.drives]
    }
}

impl ClosedLoop {
    /// A loop under ideal circumstances.
    pub fn ideal(plant: Plant, period_s: f64) -> Self {
        ClosedLoop {
            plant,
            conditions: Conditions::ideal(period_s),
            limits: Limits::default(),
        }
    }

    /// Runs for `seconds` or until it falls; drives give no torque before the first command arrives. `work` must have
    /// been made for this loop and controller.
    pub fn run(
        &self,
        controller: &dyn Controller,
        start: &Start,
        seconds: f64,
        rng: &mut ChaCha8Rng,
        work: &mut Workspace,
    ) -> Outcome {
        self.watch(controller, start, seconds, rng, work, |_| ())
    }

    /// As [`ClosedLoop::run`], showing every sample to `see`.
    pub fn watch(
        &self,
        controller: &dyn Controller,
        start: &Start,
        seconds: f64,
        rng: &mut ChaCha8Rng,
        work: &mut Workspace,
        mut see: impl FnMut(Sample<'_>),
    ) -> Outcome {
        let Conditions {
            sensor,
            actuator,
            clock,
        } = self.conditions;
        work.body.angle_rad.copy_from_slice(&start.angle_rad);
        work.body.speed_rad_s.copy_from_slice(&start.speed_rad_s);
        work.torque.fill(0.0);
        work.ends.fill([f64::INFINITY, f64::NEG_INFINITY]);
        work.pending.count = 0;
        controller.reset(&mut work.memory);

        let samples = (seconds / clock.period_s - 1e-6).ceil().max(1.0) as usize;
        let late_s = (seconds - 1.0).max(seconds / 2.0);
        let delay_s = actuator.delay_periods * clock.period_s;
        let mut tally = Tally::new();
        let mut now_s = 0.0;
        for k in 0..=samples {
            // The run begins and ends on time.
            let sample_s = match k {
                0 => 0.0,
                _ if k == samples => k as f64 * clock.period_s,
                _ => clock.time_s(k, rng),
            };
            self.go_on(now_s, sample_s, &mut tally, work);
            now_s = sample_s;
            if self.has_fallen(&work.body) {
                return tally.outcome(now_s, true, self.plant.drives(), &work.ends);
            }
            let late = now_s >= late_s;
            let settle = self.limits.settle_rad;
            tally.sample(now_s, &work.body.angle_rad, settle, late, &mut work.ends);
            sensor.read(
                clock.period_s,
                k == 0,
                &work.body.angle_rad,
                &work.body.speed_rad_s,
                &mut work.seen_rad,
                &mut work.seen_rad_s,
                rng,
            );
            let seen = Seen {
                angle_rad: &work.seen_rad,
                speed_rad_s: &work.seen_rad_s,
            };
            let lost = clock.loses(rng);
            let command = work.pending.push(now_s + delay_s);
            controller.control(&mut work.memory, seen, command);
            see(Sample {
                time_s: now_s,
                angle_rad: &work.body.angle_rad,
                speed_rad_s: &work.body.speed_rad_s,
                seen,
                command_nm: command,
                torque_nm: &work.torque,
            });
            if lost {
                work.pending.count -= 1;
            }
        }
        tally.outcome(now_s, false, self.plant.drives(), &work.ends)
    }

    /// From `now_s` to `until_s`, commands taking effect as they come due.
    #[inline]
    fn go_on(&self, mut now_s: f64, until_s: f64, tally: &mut Tally, work: &mut Workspace) {
        // Nearer than this is at once.
        const AT_ONCE_S: f64 = 1e-9;
        loop {
            while work.pending.due_s() <= now_s + AT_ONCE_S {
                for (torque, command) in work.torque.iter_mut().zip(work.pending.pop()) {
                    *torque = self.conditions.actuator.torque_nm(*command);
                }
            }
            let next_s = match work.pending.due_s() {
                due if due < until_s - AT_ONCE_S => due,
                _ => until_s,
            };
            if next_s > now_s {
                self.plant
                    .advance(&mut work.body, &work.torque, next_s - now_s);
                tally.torque(&work.torque, next_s - now_s);
            }
            now_s = next_s;
            if now_s >= until_s {
                return;
            }
        }
    }

    /// Whether a link leans too far, or the numbers have run away.
    #[inline]
    fn has_fallen(&self, body: &Body) -> bool {
        let mut lean = 0.0;
        let stands = body.angle_rad.iter().all(|angle| {
            lean += angle;
            f64::abs(lean) <= self.limits.fall_rad
        });
        !stands || !body.speed_rad_s.iter().all(|speed| speed.is_finite())
    }

    /// Runs from every start, on all cores; run `i` has the chances of [`stream`]`(seed, i)`.
    pub fn run_all(
        &self,
        controller: &dyn Controller,
        starts: &[Start],
        seconds: f64,
        seed: u64,
    ) -> Vec<Outcome> {
        starts
            .par_iter()
            .enumerate()
            .map_init(
                || Workspace::new(self, controller),
                |work, (index, start)| {
                    let rng = &mut stream(seed, index as u64);
                    self.run(controller, start, seconds, rng, work)
                },
            )
            .collect()
    }
}
