//! Whether torque was on when the servos were read, as the reports say it.

use super::rig::*;
use handstand_cm5_sim::{Plant, Robot, SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{GOAL_POSITION, TORQUE_ENABLE};
use handstand_shared::message::*;
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::Position;

/// A joint whose angle tells whether its motor has torque: 6 position codes, else 0.
#[derive(Debug)]
struct Tell {
    is_on: bool,
}

impl Plant for Tell {
    fn joint_count(&self) -> usize {
        1
    }

    fn step_s(&self) -> f64 {
        1e-3
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
            say(&mut cm5, &UPRIGHT, 250);
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

/// Let down between arming and the law's first command no servo has torque, and no report says so.
#[test]
fn a_robot_that_has_no_torque_yet_is_not_soft() {
    let mut without = 0;
    for phase in 0..10 {
        let (mut cm5, token) = ready(Mode::Balance);
        cm5.run_ms(0.3 + f64::from(phase));
        cm5.send(&arm_with(token));
        // It is armed at the end of a tick, and has torque in the next one.
        while !cm5.app.is_armed() {
            say(&mut cm5, &UPRIGHT, 10);
            cm5.run_ms(0.5);
        }
        cm5.send(&Command::LetDown);
        say(&mut cm5, &UPRIGHT, 300);
        assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LetDown));
        let all = told_and_read(&cm5);
        without += usize::from(all.iter().all(|(_, read)| !read));
        for (tick, (told, read)) in all.iter().enumerate() {
            assert_eq!(*told, Some(*read), "{phase}: tick {tick}");
        }
    }
    assert!((1..10).contains(&without), "{without}");
}

/// Where the servos that do not balance stand, and another goal that they were given before.
const STAND: Position = Position(600);
const BEFORE: u16 = 100;

/// Places of the servos that have torque, and of those that do not balance and have their goals.
fn onset(cm5: &mut VirtualCm5) -> (Vec<usize>, Vec<usize>) {
    let places = |is_one: &dyn Fn(&handstand_cm5_sim::Servo) -> bool, cm5: &mut VirtualCm5| {
        let servos = cm5.bus().servos.iter().enumerate();
        let found = servos.filter(|(_, servo)| is_one(servo));
        found.map(|(place, _)| place).collect()
    };
    let torqued = places(&|servo| servo.torque_is_on(), cm5);
    let held = places(&|servo| servo.get(GOAL_POSITION) == STAND.0, cm5);
    (torqued, held)
}

/// A CM-5 ready to balance whose other servos stand elsewhere than their goals.
fn ready_elsewhere() -> (VirtualCm5, u16) {
    let (mut cm5, token) = ready(Mode::Balance);
    for servo in &mut cm5.bus().servos {
        if !DRIVEN.contains(&servo.id()) {
            servo.shaft.angle_rad = STAND.to_rad();
            servo.set(GOAL_POSITION, BEFORE);
            servo.free = false;
        }
    }
    say(&mut cm5, &UPRIGHT, 50);
    (cm5, token)
}

/// Arms, until all servos have said their limits: torque comes on from the next tick on.
fn arm_elsewhere(cm5: &mut VirtualCm5, token: u16) {
    cm5.send(&arm_with(token));
    for _ in 0..20 {
        say(cm5, &UPRIGHT, 10);
        if cm5.app.is_armed() {
            return;
        }
    }
    panic!("it is armed");
}

/// A third of the servo list in a tick, and no servo has torque before its goal is where it stands;
/// a goal switches it on.
#[test]
fn those_that_do_not_balance_come_on_in_thirds() {
    let (mut cm5, token) = ready_elsewhere();
    cm5.send(&arm_with(token));
    let mut steps = vec![onset(&mut cm5)];
    for _ in 0..25 {
        say(&mut cm5, &UPRIGHT, 10);
        let now = onset(&mut cm5);
        if steps.last() != Some(&now) {
            steps.push(now);
        }
    }
    let balancing = DRIVEN.map(|id| usize::from(id) - 1);
    let others = |places: std::ops::Range<usize>| -> Vec<usize> {
        places.filter(|place| !balancing.contains(place)).collect()
    };
    let third = SERVOS / 3;
    let first: Vec<usize> = (0..third).chain([10, 11]).collect();
    let expected = [
        (vec![], vec![]),
        (balancing.to_vec(), vec![]),
        (first, others(0..third)),
        ((0..2 * third).collect(), others(0..2 * third)),
        ((0..SERVOS).collect(), others(0..SERVOS)),
    ];
    assert_eq!(steps, expected);
}

/// A servo that its goal did not switch on, in whichever third, has torque three ticks later.
#[test]
fn a_servo_whose_goal_does_not_switch_it_on_has_torque_too() {
    let (mut cm5, token) = ready_elsewhere();
    cm5.send(&arm_with(token));
    let late = [5, 16];
    let mut ticks = 0;
    while onset(&mut cm5).0.len() < SERVOS {
        say(&mut cm5, &UPRIGHT, 10);
        ticks += 1;
        assert!(ticks < 25, "torque comes on everywhere");
    }
    for id in late {
        cm5.bus().servo(id).unwrap().set(TORQUE_ENABLE, 0);
    }
    for torqued in [SERVOS - 1, SERVOS - 1, SERVOS] {
        say(&mut cm5, &UPRIGHT, 10);
        assert_eq!(onset(&mut cm5).0.len(), torqued);
    }
    // From then on one that has none has lost it.
    cm5.bus().servo(16).unwrap().set(TORQUE_ENABLE, 0);
    say(&mut cm5, &UPRIGHT, 400);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::TorqueLost));
}

/// However far torque has come on, what stops the robot stops it at once, and no servo gets torque
/// after it.
#[test]
fn torque_stops_coming_on_when_the_robot_is_stopped() {
    for end in [Command::Disarm, Command::LetDown, FALLEN] {
        for ticks in 1..=8 {
            let (mut cm5, token) = ready_elsewhere();
            arm_elsewhere(&mut cm5, token);
            say(&mut cm5, &UPRIGHT, 10 * ticks);
            cm5.send(&end);
            cm5.run_ms(20.0);
            let stopped = match end {
                Command::LetDown => Condition::Soft,
                Command::Disarm => Condition::Balance,
                _ => Condition::Fault(Cause::Fallen),
            };
            assert_eq!(cm5.app.condition(), stopped, "{end:?} after {ticks}");
            let (mut before, _) = onset(&mut cm5);
            assert!(end == Command::LetDown || before.is_empty(), "{end:?}");
            for _ in 0..30 {
                say(&mut cm5, &UPRIGHT, 10);
                let (now, _) = onset(&mut cm5);
                let is_fewer = now.iter().all(|place| before.contains(place));
                assert!(is_fewer, "{end:?} after {ticks}: {before:?} {now:?}");
                before = now;
            }
            assert!(before.is_empty(), "{end:?} after {ticks}: {before:?}");
        }
    }
}

/// A servo that gives up while torque comes on, balancing or not, with torque or not yet: the
/// others are let down, and none gets torque any more.
#[test]
fn a_servo_that_gives_up_early_stops_the_others() {
    for id in [1, 4, 12, 17] {
        for ticks in 1..=6 {
            let (mut cm5, token) = ready_elsewhere();
            arm_elsewhere(&mut cm5, token);
            say(&mut cm5, &UPRIGHT, 10 * (ticks - 1));
            cm5.bus().servo(id).unwrap().overload();
            say(&mut cm5, &UPRIGHT, 20);
            let case = format!("servo {id} after {ticks} ticks");
            let (mut before, _) = onset(&mut cm5);
            for _ in 0..30 {
                say(&mut cm5, &UPRIGHT, 10);
                let (now, _) = onset(&mut cm5);
                let is_fewer = now.iter().all(|place| before.contains(place));
                assert!(is_fewer, "{case}: {before:?} {now:?}");
                before = now;
            }
            let stopped = Condition::Fault(Cause::ServoError);
            assert_eq!(cm5.app.condition(), stopped, "{case}");
            assert!(before.is_empty(), "{case}: {before:?}");
            let tripped = telemetry(&mut cm5).tripped.expect("a servo");
            assert_eq!(tripped.id, id, "{case}");
        }
    }
}
