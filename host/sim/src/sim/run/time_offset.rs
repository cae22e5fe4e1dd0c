//! Readings that the log holds of another time than that of their rows.
//!
//! The simulation of a stretch begins before its first sample by as much as the latest column is
//! late, and goes on until the earliest column has its last reading. It stops wherever a reading
//! was taken, between samples too: nothing is interpolated, and nothing extrapolated at the ends of
//! a window. Before a motion's first sample and after its last the inputs are as they are there.

use super::Run;
use crate::sim::StartState;
use crate::sim::memory::PlantMemory;
use crate::sim::rows::Rows;
use std::ops::Range;

impl<R: Rows> Run<'_, R> {
    /// Predicts the readings of a stretch as [`super::predict`] does, from its beginning on.
    pub(super) fn record_offset(
        mut self,
        stretch: Range<usize>,
        memory: &mut PlantMemory,
        readings: &mut [f64],
    ) -> StartState {
        let (plant, motion, samples) = (self.plant, self.motion, stretch.len());
        let due_s = |signal: usize, next: usize| {
            motion.time_s[stretch.start + next] - plant.offset_s(signal)
        };
        let mut now_s = self.begin_s(stretch.start);
        let end_s = self.begin_s(stretch.end - 1);
        let mut next = vec![0; plant.signals()];
        let mut end = None;
        loop {
            let left = (0..plant.signals()).filter(|signal| next[*signal] < samples);
            let first = left.min_by(|a, b| due_s(*a, next[*a]).total_cmp(&due_s(*b, next[*b])));
            let Some(signal) = first else {
                return end.unwrap_or_else(|| self.state());
            };
            let taken_s = due_s(signal, next[signal]);
            self.go(now_s..taken_s);
            now_s = taken_s;
            if self.has_diverged() {
                for (readings, next) in readings.chunks_mut(samples).zip(next) {
                    readings[next..].fill(f64::NAN);
                }
                *memory = PlantMemory::default();
                return self.state();
            }
            readings[signal * samples + next[signal]] = self.sensors.reading[signal];
            next[signal] += 1;
            // Here the simulation of a stretch that follows begins.
            if end.is_none() && taken_s >= end_s {
                let state = self.state();
                *memory = PlantMemory {
                    effects: self.stepper.memory().clone(),
                    sensors: self.sensors.clone(),
                    before: self.before.clone(),
                    ended: Some((stretch.end - 1, state.clone())),
                    begins: Vec::new(),
                };
                end = Some(state);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::named;
    use crate::model::{EffectInstance, Model};
    use crate::motion::Motion;
    use crate::sim::{Plant, predict};
    use std::path::Path;

    /// Two links, the first driven by a torque.
    fn arm(effects: &[(&str, usize, f64)]) -> Model {
        let text = "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\nstep_s = 0.001\n\
             [[link]]\nlength_m = 0.2\ncom_m = 0.1\nmass_kg = 0.3\ninertia_kg_m2 = 1e-3\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 8e-4\n\
             [[joint]]\ndrive = \"torque\"\n[[joint]]\ndrive = \"passive\"\n\
             [log]\ntime = { column = \"t\", unit = \"s\" }\n\
             [[log.joint]]\nposition = { column = \"q1\", unit = \"rad\" }\n\
             input = { column = \"u1\", unit = \"N m\" }\n\
             [[log.joint]]\nposition = { column = \"q2\", unit = \"rad\" }\n";
        let mut model = Model::parse(text, Path::new("a.toml")).unwrap();
        let instance = |&(id, joint, value): &(&str, usize, f64)| EffectInstance {
            effect: named(id).unwrap(),
            joint: Some(joint),
            values: vec![value],
        };
        model.effects = effects.iter().map(instance).collect();
        model
    }

    fn motion(time_s: Vec<f64>, torque_nm: impl Fn(f64) -> f64) -> Motion {
        let input = time_s.iter().map(|t| torque_nm(*t)).collect();
        Motion {
            position_rad: vec![vec![0.0; time_s.len()]; 2],
            velocity_rad_s: vec![None; 2],
            input: vec![Some(input), None],
            time_s,
            ..Motion::default()
        }
    }

    fn start(angle_rad: [f64; 2]) -> StartState {
        StartState {
            angle_rad: angle_rad.to_vec(),
            speed_rad_s: vec![0.0; 2],
            reading_slope: None,
        }
    }

    /// Readings of the whole motion, joint by joint.
    fn read(model: &Model, motion: &Motion, start: &StartState) -> Vec<f64> {
        let mut readings = vec![0.0; 2 * motion.len()];
        let (plant, mut memory) = (Plant::new(model, motion), PlantMemory::default());
        let all = 0..motion.len();
        predict(&plant, motion, all, start, &mut memory, &mut readings);
        readings
    }

    fn assert_near(left: &[f64], right: &[f64], most: f64) {
        assert_eq!(left.len(), right.len());
        let off = left.iter().zip(right).map(|(a, b)| (a - b).abs());
        let largest = off.fold(0.0, |largest: f64, off| {
            if off.is_nan() {
                f64::INFINITY
            } else {
                largest.max(off)
            }
        });
        assert!(largest < most, "{largest}");
    }

    /// Stamps in whole ms, from `begin` on, between 3 and 19 ms apart.
    fn uneven_ms(begin: usize, samples: usize) -> Vec<usize> {
        let step_ms = |k: usize| 3 + (k * 7) % 17;
        let sums = (0..samples).scan(begin, |at, k| Some(std::mem::replace(at, *at + step_ms(k))));
        sums.collect()
    }

    #[test]
    fn each_reading_is_of_its_own_time_however_uneven_the_rows() {
        let free = |time_s| motion(time_s, |_| 0.0);
        let fine = free((0..1000).map(|ms| ms as f64 * 1e-3).collect());
        let swung = read(&arm(&[]), &fine, &start([0.8, -0.3]));
        for (late_ms, offsets_ms) in [(13, [13, -7]), (13, [-7, 13]), (0, [0, -9]), (-5, [-5, -8])]
        {
            let rows_ms = uneven_ms(20, 60);
            let rows = free(rows_ms.iter().map(|ms| *ms as f64 * 1e-3).collect());
            let [one, two] = offsets_ms.map(|ms| f64::from(ms) * 1e-3);
            let model = arm(&[("time_offset", 0, one), ("time_offset", 1, two)]);
            let begin = rows_ms[0] as i32 - late_ms;
            let readings = read(&model, &rows, &start([0.8, -0.3]));
            let wanted = (0..2).flat_map(|joint| {
                let taken = move |ms: &usize| *ms as i32 - offsets_ms[joint] - begin;
                let swung = &swung;
                rows_ms
                    .iter()
                    .map(move |ms| swung[1000 * joint + taken(ms) as usize])
            });
            assert_near(&readings, &wanted.collect::<Vec<_>>(), 1e-8);
        }
    }

    /// Where the first input is that of rest, readings that are all late are those of late inputs;
    /// read early by as much, late inputs are on time.
    #[test]
    fn readings_late_at_every_joint_are_those_of_a_delay() {
        let pushed = |t: f64| if t < 0.1 { 0.0 } else { 0.3 * (9.0 * t).sin() };
        let motion = motion((0..150).map(|k| f64::from(k) * 0.01).collect(), pushed);
        let rest = start([0.0; 2]);
        let late = read(&arm(&[("delay", 0, 0.023)]), &motion, &rest);
        let offsets = |by_s| [("time_offset", 0, by_s), ("time_offset", 1, by_s)];
        assert_near(&read(&arm(&offsets(0.023)), &motion, &rest), &late, 1e-7);
        let [one, two] = offsets(-0.023);
        let early = arm(&[("delay", 0, 0.023), one, two]);
        let on_time = read(&arm(&[]), &motion, &rest);
        // After the last sample the input is held, here as there.
        assert_near(&read(&early, &motion, &rest), &on_time, 1e-7);
    }

    #[test]
    fn what_sensors_remember_goes_on_from_stretch_to_stretch() {
        let stamps = uneven_ms(0, 120).into_iter().map(|ms| ms as f64 * 1e-3);
        let motion = motion(stamps.collect(), |t| 0.3 * (9.0 * t).sin());
        for [first, second] in [[0.0, 0.02], [-0.03, -0.02]] {
            let model = arm(&[
                ("backlash", 1, 0.1),
                ("time_offset", 0, first),
                ("time_offset", 1, second),
            ]);
            let whole = read(&model, &motion, &start([0.3, 0.0]));
            let (plant, mut memory) = (Plant::new(&model, &motion), PlantMemory::default());
            let mut predicted = |stretch: Range<usize>, start: &StartState| {
                let mut readings = vec![0.0; 2 * stretch.len()];
                let end = predict(&plant, &motion, stretch, start, &mut memory, &mut readings);
                (readings, end)
            };
            let (_, mut state) = predicted(0..61, &start([0.3, 0.0]));
            // A start state is what is read; where in its play the joint is, is remembered, and how
            // fast it crosses it while the reading stands still.
            let ahead_rad = (state.angle_rad[1] - whole[180]).abs();
            assert!(ahead_rad > 0.01, "{ahead_rad}");
            state.angle_rad[1] = whole[180];
            if ahead_rad < 0.05 - 1e-9 {
                state.speed_rad_s[1] = 0.0;
            }
            let (readings, _) = predicted(60..120, &state);
            let wanted = [&whole[60..120], &whole[180..240]].concat();
            assert_near(&readings, &wanted, 1e-9);
        }
    }

    #[test]
    fn short_stretches_and_lost_states_are_read() {
        let motion = motion(vec![0.0, 0.01, 0.012], |_| 0.1);
        for offset_s in [0.1, -0.1, f64::NAN] {
            let model = arm(&[("time_offset", 0, offset_s)]);
            let plant = Plant::new(&model, &motion);
            for stretch in [0..1, 2..3, 0..2, 0..3] {
                for angle_rad in [0.2, f64::NAN, 1e300] {
                    let mut readings = vec![0.0; 2 * stretch.len()];
                    let (start, stretch) = (start([angle_rad, 0.0]), stretch.clone());
                    let mut memory = PlantMemory::default();
                    predict(&plant, &motion, stretch, &start, &mut memory, &mut readings);
                    let lost = readings.iter().filter(|reading| reading.is_nan()).count();
                    if angle_rad == 0.2 && !offset_s.is_nan() {
                        assert_eq!(lost, 0, "{offset_s} {readings:?}");
                    } else if offset_s.is_finite() {
                        assert_eq!(lost, readings.len(), "{angle_rad}: {readings:?}");
                    }
                }
            }
        }
    }
}
