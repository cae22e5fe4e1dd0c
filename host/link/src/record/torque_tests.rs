//! Whether torque was on, in a recording through a simulated CM-5, against the servos' own account.

use super::*;
use crate::SerialLink as _;
use crate::virtual_cm5::{Cm5Port, RobotState, SimLink, set_up, spec};
use std::sync::mpsc::channel;

/// From the reading of a servo to the report's arrival, s: the rest of the round, and the line.
const AGE_S: (f64, f64) = (0.0083, 0.0113);

#[test]
fn torque_is_on_in_every_row_whose_sample_was_taken_with_torque() {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/robot.toml");
    let spec = spec(&format!("ids=1-2+11-12,delay=0,robot={model}")).unwrap();
    for phase in 0..5 {
        let mut bus = set_up(&spec).unwrap();
        let (tell, states) = channel();
        bus.robot().unwrap().watch_every(1e-3, tell);
        let mut source = Stream::new(SimLink(Cm5Port::new(bus)), &[1, 2, 11, 12]).unwrap();
        let begun_s = source.session().link().now().as_secs_f64() + STARTED_S;
        let mut rows = Vec::new();
        source.arm().unwrap();
        for _ in 0..60 {
            rows.push(
                source
                    .sample(Some(&[0.5, -0.5, 0.5, -0.5]))
                    .unwrap()
                    .unwrap(),
            );
        }
        source
            .session()
            .link()
            .pause(std::time::Duration::from_millis(2 * phase));
        source.disarm().unwrap();
        for _ in 0..30 {
            rows.push(source.sample(None).unwrap().unwrap());
        }
        let states: Vec<RobotState> = states.try_iter().collect();
        let is_on = |time_s: f64| {
            let after = states.partition_point(|state| state.time_s < time_s);
            states[after].drive[1].unwrap().torque_on
        };
        for row in &rows {
            let (near_s, far_s) = (
                row.time_s + begun_s - AGE_S.0,
                row.time_s + begun_s - AGE_S.1,
            );
            // Where it changed about then, either may be meant.
            let truth = [is_on(near_s), is_on(far_s)];
            assert!(
                truth.contains(&row.torque_on.unwrap()),
                "{phase}: {} s",
                row.time_s
            );
        }
        let changes = rows
            .windows(2)
            .filter(|pair| pair[0].torque_on != pair[1].torque_on);
        assert_eq!(changes.count(), 1, "{phase}");
        // No tick is missing, not even those in which the answer to disarming was awaited.
        for pair in rows.windows(2) {
            let step_s = pair[1].time_s - pair[0].time_s;
            assert!(
                (0.008..0.0125).contains(&step_s),
                "{phase}: {} s",
                pair[1].time_s
            );
        }
    }
}

/// A simulated CM-5's time when its port is there.
const STARTED_S: f64 = handstand_cm5_sim::STARTED_MS / 1000.0;
