//! Whether torque was on when the servos were read, as the reports say it.

use super::rig::*;
use handstand_cm5_sim::{Plant, Robot, SimulatedCm5, VirtualCm5};
use handstand_shared::message::*;

/// A joint whose angle tells whether its motor has torque: 6 position codes, else 0.
#[derive(Debug)]
struct Tell {
    is_on: bool,
}

impl Plant for Tell {
    fn joint_count(&self) -> usize {
        1
    }

    fn delay_s(&self, _joint: usize) -> f64 {
        0.0
    }

    fn set_duty(&mut self, _joint: usize, duty: Option<f64>, _supply_v: f64) {
        self.is_on = duty.is_some();
    }

    fn advance(&mut self, _span_s: f64) {}

    fn angle_rad(&self, _joint: usize) -> f64 {
        0.03 * f64::from(u8::from(self.is_on))
    }

    fn speed_rad_s(&self, _joint: usize) -> f64 {
        0.0
    }

    fn shaft(&self, joint: usize) -> (f64, f64) {
        (self.angle_rad(joint), 0.0)
    }
}

/// The servo that tells, one that balances, and its place in the servo list.
const TELLS: (u8, usize) = (11, 10);

/// A CM-5 ready to be armed, and the token.
fn ready(mode: Mode) -> (VirtualCm5, u16) {
    let mut cm5 = with_wheels();
    let tell = Tell { is_on: false };
    cm5.bus()
        .attach(Robot::new(Box::new(tell), [(0, vec![TELLS.0])]));
    let token = match mode {
        Mode::Balance => ready_to_balance(&mut cm5, &plan()),
        mode => {
            let token = greet(&mut cm5).token;
            assert_eq!(ask(&mut cm5, &Command::Mode(mode)), Some(Ok(())));
            say(&mut cm5, &Command::KeepAlive, 250);
            token
        }
    };
    cm5.clear();
    (cm5, token)
}

/// Of each tick: what its report says of torque at the reading, and what the reading says.
fn told_and_read(cm5: &VirtualCm5) -> Vec<(Option<bool>, bool)> {
    let reports = cm5.reports().into_iter();
    let ticks: Vec<StreamReport> = reports
        .filter_map(|(_, report)| match report {
            Report::Stream(report) => Some(report),
            _ => None,
        })
        .collect();
    let pairs = ticks.windows(2);
    pairs
        .map(|pair| {
            let code = pair[1].position(TELLS.1).expect("it answers");
            (pair[1].torque_was_on(Some(&pair[0])), code > 514)
        })
        .collect()
}

const FALLEN: Command = Command::Attitude(Attitude {
    angle: 20_000,
    rate: 0,
});

/// Torque goes on and off at every time within a tick, in all the ways there are.
#[test]
fn each_tick_says_whether_torque_was_on_when_it_read_the_servos() {
    let ways = [
        (Mode::Stream, Some(Command::Disarm)),
        (Mode::Stream, Some(Command::LetDown)),
        (Mode::Stream, Some(Command::Mode(Mode::Balance))),
        (Mode::Stream, None),
        (Mode::Balance, Some(Command::Disarm)),
        (Mode::Balance, Some(Command::LetDown)),
        (Mode::Balance, Some(FALLEN)),
        (Mode::Balance, None),
    ];
    for (mode, end) in ways {
        for phase in 0..10 {
            let (mut cm5, token) = ready(mode);
            cm5.run_ms(0.3 + f64::from(phase));
            cm5.send(&arm_with(token));
            say(&mut cm5, &UPRIGHT, 100);
            if let Some(end) = &end {
                cm5.send(end);
                let life = if *end == FALLEN { FALLEN } else { UPRIGHT };
                say(&mut cm5, &life, 300);
            }
            cm5.run_ms(400.0);
            let all = told_and_read(&cm5);
            let on = all.iter().filter(|(_, read)| *read).count();
            assert!(on >= 8 && !all[all.len() - 1].1, "{mode:?}, {end:?}: {on}");
            for (tick, (told, read)) in all.iter().enumerate() {
                assert_eq!(
                    *told,
                    Some(*read),
                    "{mode:?}, {end:?}, {phase}: tick {tick}"
                );
            }
        }
    }
}
