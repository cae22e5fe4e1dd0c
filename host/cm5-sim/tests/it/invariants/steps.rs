//! What may happen, drawn at random.

use super::IDS;
use handstand_shared::message::*;
use handstand_shared::raw::{MovingSpeed, TorqueLimit};
use proptest::prelude::*;
use proptest_state_machine::ReferenceStateMachine;

/// Which token is said.
#[derive(Debug, Clone, Copy)]
pub(super) enum Token {
    /// The one of the last greeting.
    Last,
    /// One of an earlier greeting, so many before.
    Earlier(usize),
    Any(u16),
}

/// What real servos and their cables do.
#[derive(Debug, Clone, Copy)]
pub(super) enum ServoFault {
    /// It loses its RAM.
    Restarts,
    /// So many of the requests to it arrive corrupted.
    Corrupt(f64),
    /// So many of its answers have a stray byte before them.
    Stray(f64),
    /// So many of its answers come a millisecond late, and meet what is sent then.
    Late(f64),
    /// It ignores a write that comes so soon after another, ns.
    NeedsTime(u64),
    /// Whether a goal switches its torque on.
    GoalSwitchesOn(bool),
}

/// What is asked as fast as the line takes it; none of it is a sign of life.
#[derive(Debug, Clone, Copy)]
pub(super) enum Flood {
    Telemetry,
    Statistics,
    PlanRead,
    FaultRead,
    /// A plan that is read whole to find that it is another one.
    WrongPlan,
    /// To arm by a token that is none.
    Arm,
}

/// Which plan is uploaded.
#[derive(Debug, Clone, Copy)]
pub(super) enum Upload {
    /// One to balance with by the host's attitude.
    ByHost,
    /// One to balance with by the gyro.
    ByGyro,
    /// The beginning of another one, which is none.
    Part,
}

/// What happens next.
#[derive(Debug, Clone)]
pub(super) enum Step {
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
    Chunk(usize, Upload),
    Store(Upload),
    /// For so long, ms.
    Flood(Flood, f64),
    /// The gyro's code.
    Gyro(u16),
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
    /// A servo's faults.
    Servo(usize, ServoFault),
    /// The controller restarts.
    Restart(u8),
    /// Its EEPROM is erased, and it is flashed with a plan compiled in, by the gyro or not.
    Flash(bool),
}

/// Steps do not depend on what went before: the model is the system's own account.
#[derive(Debug)]
pub(super) struct Steps;

fn limits() -> impl Strategy<Value = ArmLimits> {
    let full = Just(ArmLimits::FULL);
    let any = (0u16..1100, 0u16..1100).prop_map(|(torque, speed)| ArmLimits {
        torque: TorqueLimit(torque),
        speed: MovingSpeed(speed),
    });
    prop_oneof![3 => full, 1 => any]
}

fn upload() -> impl Strategy<Value = Upload> {
    prop_oneof![
        2 => Just(Upload::ByHost),
        1 => Just(Upload::ByGyro),
        2 => Just(Upload::Part),
    ]
}

fn flood() -> impl Strategy<Value = Flood> {
    prop_oneof![
        Just(Flood::Telemetry),
        Just(Flood::Statistics),
        Just(Flood::PlanRead),
        Just(Flood::FaultRead),
        Just(Flood::WrongPlan),
        Just(Flood::Arm),
    ]
}

fn servo_fault() -> impl Strategy<Value = ServoFault> {
    let share = || prop_oneof![2 => Just(0.0), 1 => 0.0..0.5];
    prop_oneof![
        3 => Just(ServoFault::Restarts),
        1 => share().prop_map(ServoFault::Corrupt),
        1 => share().prop_map(ServoFault::Stray),
        1 => share().prop_map(ServoFault::Late),
        1 => (0u64..180_000).prop_map(ServoFault::NeedsTime),
        1 => any::<bool>().prop_map(ServoFault::GoalSwitchesOn),
    ]
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
            2 => (0usize..8, upload()).prop_map(|(at, which)| Step::Chunk(at, which)),
            1 => upload().prop_map(Step::Store),
            1 => (flood(), 10.0..150.0).prop_map(|(what, ms)| Step::Flood(what, ms)),
            3 => prop_oneof![16 => 508u16..517, 1 => 400u16..624, 1 => 0u16..1024]
                .prop_map(Step::Gyro),
            1 => any::<bool>().prop_map(Step::List),
            1 => (0u8..32).prop_map(Step::Button),
            1 => prop_oneof![3 => Just(9.6), 1 => 7.0..12.0].prop_map(Step::Supply),
            2 => (servo.clone(), prop::bool::weighted(0.3)).prop_map(|(at, on)| Step::Dead(at, on)),
            1 => servo.clone().prop_map(Step::Overload),
            1 => (servo.clone(), prop::bool::weighted(0.2)).prop_map(|(at, on)| Step::Hot(at, on)),
            1 => servo.clone().prop_map(Step::TorqueLost),
            2 => (servo.clone(), servo_fault()).prop_map(|(at, fault)| Step::Servo(at, fault)),
            4 => (servo, prop_oneof![8 => 505u16..520, 1 => 0u16..1024])
                .prop_map(|(at, code)| Step::Shaft(at, code)),
            1 => prop_oneof![3 => Just(None), 1 => (10u64..400).prop_map(Some)]
                .prop_map(Step::Noise),
            1 => prop::collection::vec(any::<u8>(), 0..20).prop_map(Step::Garbage),
            1 => prop_oneof![
                4 => prop_oneof![Just(1u8), Just(4), Just(8)].prop_map(Step::Restart),
                1 => any::<bool>().prop_map(Step::Flash),
            ],
        ]
        .boxed()
    }

    fn apply((): (), _: &Step) {}
}
