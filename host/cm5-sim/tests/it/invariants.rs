//! The state machine under random commands, times and faults: docs/firmware.md, "Invariants", each
//! checked after every step.
//!
//! Two tests, which run beside each other, of 500 runs of 1000 steps; `PROPTEST_CASES` sets another
//! number of runs.

use super::rig::{DRIVEN, bytes, plan};
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::app::{State, Torque};
use handstand_shared::control_table::{
    CCW_LIMIT, CW_LIMIT, GOAL_POSITION, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::crc::crc32;
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::plan::Plan;
use handstand_shared::raw::{MovingSpeed, Position, TorqueLimit};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use proptest_state_machine::{ReferenceStateMachine, StateMachineTest};

/// Runs in each of two tests, of [`STEPS`] each.
const RUNS: u32 = 500;
const STEPS: usize = 1000;

/// The servos of the list: those a plan drives, and one more.
const IDS: [u8; 5] = [1, 2, 11, 12, 5];

/// Which token is said.
#[derive(Debug, Clone, Copy)]
enum Token {
    /// The one of the last greeting.
    Last,
    /// One of an earlier greeting, so many before.
    Earlier(usize),
    Any(u16),
}

/// What happens next.
#[derive(Debug, Clone)]
enum Step {
    Wait(f64),
    Hello(u8),
    Mode(Mode),
    Arm(Token, ArmLimits),
    Disarm,
    LetDown,
    KeepAlive,
    Attitude(i16),
    Goals(u16),
    /// Greets, chooses the mode, waits until all is known, and arms: else random commands seldom
    /// arm.
    Ready(Mode),
    Ask,
    PlanRead(u16),
    /// A piece of the plan, or of another one.
    Chunk(usize, bool),
    Store(bool),
    List(bool),
    Button(u8),
    Supply(f64),
    Dead(usize, bool),
    Overload(usize),
    Hot(usize, bool),
    TorqueLost(usize),
    Shaft(usize, u16),
    Noise(Option<u64>),
    Garbage(Vec<u8>),
    /// The controller restarts.
    Restart(u8),
}

/// Steps do not depend on what went before: the model is the system's own account.
#[derive(Debug)]
struct Steps;

fn limits() -> impl Strategy<Value = ArmLimits> {
    let full = Just(ArmLimits::FULL);
    let any = (0u16..1100, 0u16..1100).prop_map(|(torque, speed)| ArmLimits {
        torque: TorqueLimit(torque),
        speed: MovingSpeed(speed),
    });
    prop_oneof![3 => full, 1 => any]
}

impl ReferenceStateMachine for Steps {
    type State = ();
    type Transition = Step;

    fn init_state() -> BoxedStrategy<()> {
        Just(()).boxed()
    }

    fn transitions((): &()) -> BoxedStrategy<Step> {
        let mode = prop_oneof![
            1 => Just(Mode::Bridge),
            3 => Just(Mode::Stream),
            3 => Just(Mode::Balance)
        ];
        let token = prop_oneof![
            6 => Just(Token::Last),
            2 => (1usize..4).prop_map(Token::Earlier),
            1 => any::<u16>().prop_map(Token::Any)
        ];
        let servo = 0..IDS.len();
        prop_oneof![
            12 => (0.0..12.0).prop_map(Step::Wait),
            1 => (12.0..120.0).prop_map(Step::Wait),
            4 => prop_oneof![8 => Just(VERSION), 1 => any::<u8>()].prop_map(Step::Hello),
            3 => mode.clone().prop_map(Step::Mode),
            6 => (token, limits()).prop_map(|(token, limits)| Step::Arm(token, limits)),
            1 => Just(Step::Disarm),
            1 => Just(Step::LetDown),
            14 => Just(Step::KeepAlive),
            24 => prop_oneof![6 => -400i16..400, 1 => any::<i16>()].prop_map(Step::Attitude),
            8 => (0u16..1024).prop_map(Step::Goals),
            2 => mode.prop_map(Step::Ready),
            2 => Just(Step::Ask),
            1 => any::<u16>().prop_map(Step::PlanRead),
            2 => (0usize..8, any::<bool>()).prop_map(|(at, own)| Step::Chunk(at, own)),
            1 => any::<bool>().prop_map(Step::Store),
            1 => any::<bool>().prop_map(Step::List),
            1 => (0u8..32).prop_map(Step::Button),
            1 => prop_oneof![3 => Just(9.6), 1 => 7.0..12.0].prop_map(Step::Supply),
            2 => (servo.clone(), prop::bool::weighted(0.3)).prop_map(|(at, on)| Step::Dead(at, on)),
            1 => servo.clone().prop_map(Step::Overload),
            1 => (servo.clone(), prop::bool::weighted(0.2)).prop_map(|(at, on)| Step::Hot(at, on)),
            1 => servo.clone().prop_map(Step::TorqueLost),
            4 => (servo, prop_oneof![8 => 505u16..520, 1 => 0u16..1024])
                .prop_map(|(at, code)| Step::Shaft(at, code)),
            1 => prop_oneof![3 => Just(None), 1 => (10u64..400).prop_map(Some)]
                .prop_map(Step::Noise),
            1 => prop::collection::vec(any::<u8>(), 0..20).prop_map(Step::Garbage),
            1 => prop_oneof![Just(1u8), Just(4), Just(8)].prop_map(Step::Restart),
        ]
        .boxed()
    }

    fn apply((): (), _: &Step) {}
}

/// The firmware, and what must be remembered to judge it.
#[derive(Debug)]
struct Judged {
    cm5: VirtualCm5,
    tokens: Vec<u16>,
    /// The token that may arm: of the last greeting, unless it has armed.
    fresh: Option<u16>,
    armed: bool,
    /// Fingerprint of the plan when it was armed.
    plan: Option<u32>,
    /// When the last sign of life, and the last attitude, were said.
    life_ms: f64,
    attitude_ms: f64,
    /// Since when torque may be on in a servo that hears: torque off was ordered.
    off_ms: Option<f64>,
    /// Servos whose torque is not the firmware's doing: deaf, or switched by a fault.
    odd: Vec<u8>,
    button_ms: Option<f64>,
    /// Since when a driven joint is out of its range.
    out_ms: Option<f64>,
    goals: Vec<u16>,
    was_streaming: bool,
    looked_ms: f64,
    limit: u16,
    /// When the supply was changed last.
    supply_ms: f64,
    /// Commands to arm that may still be taken: until when, token, limits.
    arms: Vec<(f64, u16, ArmLimits)>,
    /// Servos that gave up since arming.
    gave_up: Vec<u8>,
}

impl Judged {
    fn new() -> Self {
        let mut compiled = bytes(&plan());
        // One that differs from the one that is uploaded.
        let last = compiled.len() - 1;
        compiled[last] ^= 1;
        let mut cm5 = VirtualCm5::with_plan(compiled, vec![0xff; 4096], ResetCause(1));
        cm5.board.bus = Bus::new(IDS);
        for id in DRIVEN {
            let servo = cm5.bus().servo(id).expect("it is there");
            servo.set(CW_LIMIT, 0);
            servo.set(CCW_LIMIT, 0);
            servo.free = false;
        }
        let mut judged = Judged {
            cm5,
            tokens: Vec::new(),
            fresh: None,
            armed: false,
            plan: None,
            life_ms: f64::NEG_INFINITY,
            attitude_ms: f64::NEG_INFINITY,
            off_ms: Some(0.0),
            odd: Vec::new(),
            button_ms: None,
            out_ms: None,
            goals: vec![512; IDS.len()],
            was_streaming: false,
            looked_ms: 0.0,
            limit: 0,
            supply_ms: 0.0,
            arms: Vec::new(),
            gave_up: Vec::new(),
        };
        judged.hello(VERSION);
        judged.send(&Command::Mode(Mode::Stream));
        judged.send(&list());
        judged
    }

    /// Says it, until it has arrived and was taken; but for arming, torque comes on by nothing.
    fn send(&mut self, command: &Command) -> Option<Result<(), Refusal>> {
        self.cm5.clear();
        let sequence = self.cm5.send(command);
        let arrived_ms = self.cm5.board.last_byte_ns() as f64 * 1e-6;
        let before_ms = self.cm5.now_ms();
        self.run((arrived_ms - before_ms).max(0.0) + 0.01);
        if command.is_life() {
            self.life_ms = self.cm5.now_ms();
        }
        if let Command::Attitude(_) = command {
            self.attitude_ms = self.cm5.now_ms();
        }
        self.cm5
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            })
    }

    fn run(&mut self, ms: f64) {
        // Looked at often enough to see what lasts for a tick.
        let until_ms = self.cm5.now_ms() + ms;
        loop {
            let left_ms = until_ms - self.cm5.now_ms();
            if left_ms <= 0.0 {
                break;
            }
            self.cm5.run_ms(left_ms.clamp(0.01, 10.0));
            self.judge();
        }
    }

    fn hello(&mut self, version: u8) {
        // Its answer must be told from those before it: the line empties, noise ends, and an
        // adapter gives up what was begun.
        let now_ns = self.cm5.board.now_ns();
        self.cm5.board.bus.set_noise(now_ns, None);
        self.run(75.0);
        // What an adapter passed on may have spoilt the first.
        for _ in 0..3 {
            self.send(&Command::Hello { version });
            self.run(70.0);
            let mut reports = self.cm5.reports().into_iter();
            let hello = reports.find_map(|(_, report)| match report {
                Report::Hello(hello) => Some(hello),
                _ => None,
            });
            if let Some(hello) = hello {
                self.tokens.push(hello.token);
                self.fresh = (version == VERSION).then_some(hello.token);
                return;
            }
        }
        panic!("no answer to a greeting in {:?}", self.cm5.app.state());
    }

    fn arm(&mut self, token: Token, limits: ArmLimits) {
        let token = match token {
            Token::Last => self.tokens.last().copied(),
            Token::Earlier(back) => self.tokens.iter().rev().nth(back).copied(),
            Token::Any(token) => Some(token),
        };
        let token = token.unwrap_or(0);
        self.judge();
        self.cm5.clear();
        self.cm5.send(&Command::Arm { token, limits });
        let arrived_ms = self.cm5.board.last_byte_ns() as f64 * 1e-6;
        // A frame that arrives during a tick is taken at its end.
        self.arms.push((arrived_ms + 25.0, token, limits));
        while self.cm5.now_ms() < arrived_ms + 0.01 {
            let left_ms = arrived_ms + 0.01 - self.cm5.now_ms();
            self.cm5.run_ms(left_ms.clamp(0.01, 10.0));
            self.judge();
        }
    }

    /// What the firmware must have refused, had it been so when it was armed.
    fn judge_arming(&mut self, limits: ArmLimits) {
        // A token arms once, and only the last one.
        self.fresh = None;
        let now_ms = self.cm5.now_ms();
        let supply_v = self.cm5.board.bus.servos.iter().map(|servo| servo.supply_v);
        let lowest_v = supply_v.fold(f64::INFINITY, f64::min);
        // As a round of the housekeeping told: it takes up to three ticks here, noise lets it last.
        assert!(
            lowest_v >= 8.75 || now_ms - self.supply_ms < 500.0,
            "armed at {lowest_v} V"
        );
        self.plan = self.cm5.app.plan_fingerprint();
        self.limit = limits.torque.0;
        self.gave_up.clear();
        self.off_ms = None;
        self.odd.clear();
        self.life_ms = self.cm5.now_ms();
        let is_balance = matches!(self.cm5.app.state(), State::Balance(_));
        if is_balance {
            assert!(self.plan.is_some(), "balancing without a plan");
            let age_ms = self.cm5.now_ms() - self.attitude_ms;
            assert!(age_ms <= 30.5, "armed with an attitude {age_ms} ms old");
        }
        // Who did not answer was not switched on.
        let bus = &self.cm5.board.bus;
        let deaf = bus.servos.iter().filter(|servo| servo.faults.dead);
        self.odd.extend(deaf.map(|servo| servo.id()));
    }

    fn judge(&mut self) {
        let now_ms = self.cm5.now_ms();
        self.arms.retain(|(until_ms, ..)| now_ms <= *until_ms);
        let is_armed = self.cm5.app.is_armed();
        if is_armed && !self.armed {
            let fresh = self.fresh;
            let arms = self.arms.iter();
            // Of two that came during one tick the first arms, or the second if the first was
            // refused: which one is not known here.
            let own = arms.filter(|(_, token, limits)| Some(*token) == fresh && limits.is_sound());
            let arm = own.max_by_key(|(_, _, limits)| limits.torque.0);
            let Some((_, _, limits)) = arm.copied() else {
                panic!(
                    "armed by none of {:?}, the token being {fresh:?}",
                    self.arms
                );
            };
            self.judge_arming(limits);
        }
        if self.armed && !is_armed {
            self.off_ms = Some(now_ms);
        }
        self.armed = is_armed;
        self.judge_torque(now_ms);
        if is_armed {
            self.judge_armed(now_ms);
        }
        self.goals = self.goals_now();
        self.was_streaming = self.cm5.app.state() == State::Stream(Torque::On);
        self.looked_ms = now_ms;
        let unfed_ms = self.cm5.board.longest_unfed_ns as f64 * 1e-6;
        assert!(
            unfed_ms <= 22.0,
            "{unfed_ms} ms without feeding the watchdog"
        );
    }

    /// Torque is off where nothing is armed, in every servo that hears.
    fn judge_torque(&self, now_ms: f64) {
        let Some(off_ms) = self.off_ms else { return };
        for servo in &self.cm5.board.bus.servos {
            let id = servo.id();
            let is_odd = servo.faults.dead || self.odd.contains(&id);
            assert!(
                is_odd || !servo.torque_is_on(),
                "servo {id} is torqued, {:.1} ms after torque off, in {:?}",
                now_ms - off_ms,
                self.cm5.app.state()
            );
        }
    }

    fn judge_armed(&mut self, now_ms: f64) {
        let state = self.cm5.app.state();
        assert_eq!(
            self.cm5.app.plan_fingerprint(),
            self.plan,
            "the plan changed under an armed robot"
        );
        assert!(
            !self.cm5.app.is_writing(),
            "a plan is written under an armed robot"
        );
        let is_on = matches!(
            state,
            State::Stream(Torque::On) | State::Balance(Torque::On)
        );
        // Until it is noticed: a period, at most two ticks long; and one step of this test.
        let silent_ms = now_ms - self.life_ms;
        assert!(
            !is_on || silent_ms <= 80.0 + 30.0,
            "{silent_ms} ms without life"
        );
        assert!(
            silent_ms <= 300.0 + 20.0,
            "torque is on {silent_ms} ms after the last life"
        );
        if state == State::Balance(Torque::On) {
            let age_ms = now_ms - self.attitude_ms;
            assert!(
                age_ms <= 30.0 + 30.0,
                "balances with an attitude {age_ms} ms old"
            );
            let out_ms = self.out_ms.map_or(0.0, |since_ms| now_ms - since_ms);
            assert!(
                out_ms <= 60.0,
                "a joint is out of its range for {out_ms} ms"
            );
        }
        if let Some(since_ms) = self.button_ms {
            assert!(now_ms - since_ms <= 70.0, "a button does not stop it");
        }
        let periods = ((now_ms - self.looked_ms) / 10.0).ceil() as u16 + 1;
        for (servo, before) in self.cm5.board.bus.servos.iter().zip(&self.goals) {
            let id = servo.id();
            let limit = servo.get(TORQUE_LIMIT);
            if !servo.faults.dead && !self.odd.contains(&id) && servo.torque_is_on() {
                assert!(limit <= self.limit, "servo {id}: torque limit {limit}");
            }
            // Arming itself sets them to where the servos stand.
            if self.was_streaming && state == State::Stream(Torque::On) {
                let step = servo.get(GOAL_POSITION).abs_diff(*before);
                let is_deaf = servo.faults.dead || self.odd.contains(&id);
                assert!(is_deaf || step <= 20 * periods, "a goal jumped by {step}");
            }
        }
        for id in &self.gave_up {
            let servo = self
                .cm5
                .board
                .bus
                .servos
                .iter()
                .find(|servo| servo.id() == *id);
            let since = servo.is_some_and(|servo| servo.torque_is_on() && !servo.faults.dead);
            assert!(
                !since || self.odd.contains(id) || is_on,
                "servo {id} was woken"
            );
        }
    }

    fn goals_now(&self) -> Vec<u16> {
        let servos = self.cm5.board.bus.servos.iter();
        servos.map(|servo| servo.get(GOAL_POSITION)).collect()
    }

    fn servo(&mut self, at: usize) -> &mut handstand_cm5_sim::Servo {
        &mut self.cm5.board.bus.servos[at]
    }

    fn set_shaft(&mut self, at: usize, code: u16) {
        self.servo(at).shaft.angle_rad = Position(code).to_rad();
        let [low, high] = [312, 692];
        let out = [0, 2].into_iter().any(|at| {
            let code = Position::from_rad(self.servo(at).shaft.angle_rad).0;
            code < low || code > high
        });
        let now_ms = self.cm5.now_ms();
        self.out_ms = match out {
            true => Some(self.out_ms.unwrap_or(now_ms)),
            false => None,
        };
    }

    fn ready(&mut self, mode: Mode) {
        for at in 0..IDS.len() {
            let servo = self.servo(at);
            servo.faults.dead = false;
            servo.temperature = 30.0;
            servo.supply_v = 9.6;
            self.set_shaft(at, 512);
        }
        let now_ns = self.cm5.board.now_ns();
        self.cm5.board.bus.set_noise(now_ns, None);
        self.release_buttons();
        self.supply_ms = self.cm5.now_ms();
        self.hello(VERSION);
        self.send(&Command::Mode(mode));
        for _ in 0..16 {
            self.send(&Command::Attitude(Attitude::default()));
            self.run(8.0);
        }
        self.arm(Token::Last, ArmLimits::FULL);
    }

    fn release_buttons(&mut self) {
        self.cm5.board.buttons = 0;
        self.button_ms = None;
    }

    fn restart(&mut self, cause: u8) {
        let bus = std::mem::replace(&mut self.cm5.board.bus, Bus::new([]));
        let eeprom = std::mem::take(&mut self.cm5.board.eeprom);
        let compiled = std::mem::take(&mut self.cm5.board.compiled);
        let tokens = std::mem::take(&mut self.tokens);
        let now_ns = self.cm5.board.now_ns();
        let mut board = HostBoard::at(now_ns, bus);
        (board.eeprom, board.compiled) = (eeprom, compiled);
        board.reset_cause = ResetCause(cause);
        let deaf = board.bus.servos.iter().filter(|servo| servo.faults.dead);
        let odd = deaf.map(|servo| servo.id()).collect();
        self.cm5 = VirtualCm5::start(board);
        assert!(!self.cm5.app.is_armed());
        (self.armed, self.fresh, self.tokens) = (false, None, tokens);
        (self.off_ms, self.odd) = (Some(self.cm5.now_ms()), odd);
        self.button_ms = None;
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Wait(ms) => self.run(*ms),
            Step::Hello(version) => self.hello(*version),
            Step::Mode(mode) => {
                self.send(&Command::Mode(*mode));
            }
            Step::Arm(token, limits) => self.arm(*token, *limits),
            Step::Disarm => {
                self.send(&Command::Disarm);
            }
            Step::LetDown => {
                self.send(&Command::LetDown);
            }
            Step::KeepAlive => {
                self.send(&Command::KeepAlive);
            }
            Step::Attitude(angle) => {
                let (angle, rate) = (*angle, 0);
                self.send(&Command::Attitude(Attitude { angle, rate }));
            }
            Step::Goals(code) => {
                self.send(&Command::Goals(Positions::pack([*code; SERVOS])));
            }
            Step::Ready(mode) => self.ready(*mode),
            Step::Ask => {
                self.send(&Command::Ask(Subject::Telemetry));
            }
            Step::PlanRead(offset) => {
                self.send(&Command::PlanRead { offset: *offset });
            }
            Step::Chunk(at, own) => {
                let table = table(*own);
                let mut bytes = [0; PLAN_CHUNK];
                let piece = table.chunks(PLAN_CHUNK).nth(*at).unwrap_or(&[]);
                bytes[..piece.len()].copy_from_slice(piece);
                let offset = (at * PLAN_CHUNK) as u16;
                self.send(&Command::PlanChunk { offset, bytes });
            }
            Step::Store(own) => {
                let table = table(*own);
                let (length, check) = (table.len() as u16, crc32(&table));
                self.send(&Command::PlanStore { length, check });
            }
            Step::List(whole) => {
                let list = if *whole {
                    Command::ServoList(ServoList::default())
                } else {
                    list()
                };
                self.send(&list);
            }
            Step::Button(down) => {
                self.release_buttons();
                self.cm5.board.buttons = *down;
                self.button_ms = (*down != 0).then(|| self.cm5.now_ms());
            }
            Step::Supply(volts) => {
                self.supply_ms = self.cm5.now_ms();
                (0..IDS.len()).for_each(|at| self.servo(at).supply_v = *volts);
            }
            Step::Dead(at, dead) => {
                let id = IDS[*at];
                // What it missed it may hear again in 200 ms, or for ever in a fault.
                if *dead || self.servo(*at).faults.dead {
                    self.odd.push(id);
                }
                self.servo(*at).faults.dead = *dead;
            }
            Step::Overload(at) => {
                // Without torque there was nothing to give up: arming, which for balancing switches
                // torque on a tick later, brings it back.
                let had_torque = self.servo(*at).torque_is_on();
                self.servo(*at).overload();
                if had_torque {
                    self.gave_up.push(IDS[*at]);
                }
            }
            Step::Hot(at, hot) => {
                self.servo(*at).temperature = if *hot { 90.0 } else { 30.0 };
            }
            Step::TorqueLost(at) => self.servo(*at).set(TORQUE_ENABLE, 0),
            Step::Shaft(at, code) => self.set_shaft(*at, *code),
            Step::Noise(every_us) => {
                let now_ns = self.cm5.board.now_ns();
                let every_ns = every_us.map(|us| us * 1000);
                self.cm5.board.bus.set_noise(now_ns, every_ns);
            }
            Step::Garbage(bytes) => {
                self.garbage(bytes);
            }
            Step::Restart(cause) => self.restart(*cause),
        }
        self.judge();
    }

    /// As an adapter it passes them on: any could be a packet that switches torque on.
    fn garbage(&mut self, bytes: &[u8]) {
        if self.cm5.app.state() == State::Bridge {
            return;
        }
        self.cm5.send_bytes(bytes);
        self.cm5.send_bytes(&[0]);
        self.run(4.0);
    }
}

/// The list of the servos that are there.
fn list() -> Command {
    let mut list = ServoList {
        count: IDS.len() as u8,
        ids: [0; SERVOS],
    };
    list.ids[..IDS.len()].copy_from_slice(&IDS);
    Command::ServoList(list)
}

/// A plan's bytes: one that can be balanced with, or another one, shorter.
fn table(own: bool) -> Vec<u8> {
    match own {
        true => bytes(&plan()),
        false => {
            let other = Plan {
                range: 7000,
                ..plan()
            };
            bytes(&other)[..60].to_vec()
        }
    }
}

impl StateMachineTest for Judged {
    type SystemUnderTest = Judged;
    type Reference = Steps;

    fn init_test((): &()) -> Judged {
        Judged::new()
    }

    fn apply(mut judged: Judged, (): &(), step: Step) -> Judged {
        judged.step(&step);
        judged
    }
}

fn the_invariants_hold(seed: u8) {
    let mut config = ProptestConfig {
        failure_persistence: None,
        max_shrink_iters: 300,
        ..ProptestConfig::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = RUNS;
    }
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
    let mut runner = TestRunner::new_with_rng(config.clone(), rng);
    let outcome = runner.run(
        &Steps::sequential_strategy(STEPS),
        |(initial, transitions, seen)| {
            Judged::test_sequential(config.clone(), initial, transitions, seen);
            Ok(())
        },
    );
    if let Err(why) = outcome {
        panic!("{why}");
    }
}

#[test]
fn the_invariants_hold_whatever_happens() {
    the_invariants_hold(1);
}

#[test]
fn the_invariants_hold_whatever_else_happens() {
    the_invariants_hold(2);
}
