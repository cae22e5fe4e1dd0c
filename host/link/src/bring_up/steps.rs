//! The steps of the checklist, in their order: nothing gets torque before what would stop it is
//! known to work.

/// A step.
#[derive(Debug)]
pub struct Step {
    /// Its name, as in `docs/bring-up.md`.
    pub id: &'static str,
    /// What has to be so.
    pub title: &'static str,
    /// How to see it.
    pub instruction: &'static str,
    /// What is expected.
    pub expected: &'static str,
    /// Unit of its number.
    pub unit: &'static str,
    /// What to do where it is not so.
    pub otherwise: &'static str,
    /// Who checks it.
    pub kind: StepKind,
}

/// Who checks a step.
#[derive(Debug, Clone, Copy)]
pub enum StepKind {
    /// A person with instruments.
    ByHand,
    /// The program, over the line.
    Measured(Check),
}

/// What the program can check.
#[derive(Debug, Clone, Copy)]
pub enum Check {
    Firmware,
    Servos,
    Supply,
    Ticks,
    Stack,
    GyroZero,
    ResetFlags,
    Rate,
    Gap,
    GoalTorque,
    LimitedTorque,
    LinkLoss,
}

impl Check {
    /// Whether a servo may have torque in it.
    pub fn gives_torque(self) -> bool {
        match self {
            Check::GoalTorque | Check::LimitedTorque | Check::LinkLoss => true,
            Check::Firmware
            | Check::Servos
            | Check::Supply
            | Check::Ticks
            | Check::Stack
            | Check::ResetFlags
            | Check::Rate
            | Check::Gap
            | Check::GyroZero => false,
        }
    }
}

/// All steps.
pub const STEPS: &[Step] = &[
    Step {
        id: "aref",
        title: "AREF free of any source",
        instruction: "Before the first flash, power off: measure from AREF (pin 62) to AVCC, to ground \
                      and to every pad near it. The firmware connects AVCC to it, which would be \
                      shorted to another source.",
        expected: "more than 10 kohm to all but its capacitor",
        unit: "kohm",
        otherwise: "do not flash: AVCC would be shorted to what is tied to AREF",
        kind: StepKind::ByHand,
    },
    Step {
        id: "fuses",
        title: "fuses as the boot loader needs them",
        instruction: "Read them, never write them: extended fuse FF (M103C unprogrammed), high fuse \
                      with BOOTSZ = 00 and BOOTRST programmed. Note BODEN and BODLEVEL: 4.0 V suits \
                      16 MHz; without it a failing supply may spoil EEPROM, which the plan's and the \
                      log's checks notice.",
        expected: "extended fuse FF, BOOTSZ 00, BOOTRST programmed",
        unit: "",
        otherwise: "do not flash: the boot loader would not be reached",
        kind: StepKind::ByHand,
    },
    Step {
        id: "charger",
        title: "charger off",
        instruction: "Measure PB5 from 100 ms after power-on: it has to be high (5 V) and stay so.",
        expected: "5 V from 100 ms after power-on",
        unit: "V",
        otherwise: "cut the power: batteries would be charged without end",
        kind: StepKind::ByHand,
    },
    Step {
        id: "firmware",
        title: "firmware of this version answers",
        instruction: "Greets it and asks why it last started.",
        expected: "this version; a start by power or reset",
        unit: "",
        otherwise: "flash the firmware that belongs to the program",
        kind: StepKind::Measured(Check::Firmware),
    },
    Step {
        id: "servos",
        title: "servos answer every ping",
        instruction: "Connect one servo alone at first (--ids 1). 20 pings each, as an adapter.",
        expected: "20 of 20",
        unit: "",
        otherwise: "plug, id, baud: `handstand bus doctor` says why",
        kind: StepKind::Measured(Check::Servos),
    },
    Step {
        id: "supply",
        title: "supply of 8.8 V and more",
        instruction: "As the servos report it.",
        expected: "8.8 V and more",
        unit: "V",
        otherwise: "charge, or use a bench supply",
        kind: StepKind::Measured(Check::Supply),
    },
    Step {
        id: "ticks",
        title: "ticks keep their period",
        instruction: "Streams for 3 s: no tick may take longer than 10 ms.",
        expected: "none beyond 10 ms in 3 s",
        unit: "",
        otherwise: "`handstand bus setup`: a return delay of 0",
        kind: StepKind::Measured(Check::Ticks),
    },
    Step {
        id: "stack",
        title: "stack below 80 % of its room",
        instruction: "The deepest it has been since the start.",
        expected: "below 80 %",
        unit: "",
        otherwise: "do not arm: the firmware is another one than was measured",
        kind: StepKind::Measured(Check::Stack),
    },
    Step {
        id: "gyro",
        title: "gyro's zero steady",
        instruction: "At rest for 2 s: codes within 4 of each other, and 100 from the range's ends.",
        expected: "codes within 4, from 100 to 923",
        unit: "",
        otherwise: "balance by the attitude of the host, or mend the wire to the pad",
        kind: StepKind::Measured(Check::GyroZero),
    },
    Step {
        id: "reset-flags",
        title: "flags of the reset survive the boot loader",
        instruction: "Asks the firmware which it found: after power-on bit 0, after the MODE button \
                      bit 1, after the watchdog bit 3.",
        expected: "one of them, not 0",
        unit: "",
        otherwise: "a watchdog's reset looks like power-on: torque goes off, but neither the state nor \
                    the fault log tells of it",
        kind: StepKind::Measured(Check::ResetFlags),
    },
    Step {
        id: "rate",
        title: "the bus gives 100 reports a second",
        instruction: "Streams for 3 s, and counts reports, answers and the time of a tick. --ids 1-18 \
                      tells of a whole robot.",
        expected: "99 and more, 99 % of the answers, at most 350 us for each servo",
        unit: "1/s",
        otherwise: "more time for each servo: its return delay, or a bus slower than 1 Mbaud; answers \
                    that are missing: `handstand bus doctor`",
        kind: StepKind::Measured(Check::Rate),
    },
    Step {
        id: "gap",
        title: "two writes 200 us apart are both obeyed",
        instruction: "Writes the first servo's LED twice, as close as the line allows and then further \
                      apart, 20 times each.",
        expected: "200 us and less",
        unit: "us",
        otherwise: "raise BETWEEN_WRITES_US in firmware/src/design.rs to it; until then arming reads \
                    limits back, and goals and torque off are said again",
        kind: StepKind::Measured(Check::Gap),
    },
    Step {
        id: "watchdog",
        title: "watchdog's period of 24 to 34 ms",
        instruction: "Flash an image that hangs once torque is off, and take the time between two \
                      FF FF FE 04 03 18 00 on the bus with a logic analyser.",
        expected: "28 ms, 24 to 34",
        unit: "ms",
        otherwise: "beyond 34 ms torque stays on longer after a hang: note it",
        kind: StepKind::ByHand,
    },
    Step {
        id: "reset",
        title: "torque off within 150 ms of a reset",
        instruction: "Short-circuit reset, and take the time until FF FF FE 04 03 18 00 on the bus: \
                      it includes the boot loader's.",
        expected: "50 ms, at most 150",
        unit: "ms",
        otherwise: "the boot loader waits longer: never leave an armed robot alone",
        kind: StepKind::ByHand,
    },
    Step {
        id: "goal",
        title: "whether a goal switches torque on",
        instruction: "Writes the first servo's position as its goal, at a tenth of its torque, and \
                      reads torque enable; then switches torque off. Either answer is safe: the \
                      firmware writes limits before goals.",
        expected: "either answer",
        unit: "",
        otherwise: "limits go out before goals in either case",
        kind: StepKind::Measured(Check::GoalTorque),
    },
    Step {
        id: "torque",
        title: "one servo holds its position with a tenth of its torque",
        instruction: "Arms the first servo alone, without goals, for a second, and reads the limits \
                      that it holds: 102 of torque, 1023 of speed.",
        expected: "within 5 codes, limits of 102 and 1023",
        unit: "",
        otherwise: "do not go on: a servo obeys no limit",
        kind: StepKind::Measured(Check::LimitedTorque),
    },
    Step {
        id: "link-loss",
        title: "a silent line switches torque off within 300 ms",
        instruction: "Arms again, says nothing for half a second, and reads the servo's torque and \
                      the fault log.",
        expected: "within 300 ms, and the log says so",
        unit: "",
        otherwise: "do not go on: a lost link would not stop the robot",
        kind: StepKind::Measured(Check::LinkLoss),
    },
    Step {
        id: "buttons",
        title: "every button stops",
        instruction: "Arm with `handstand replay` or `balance`, press each button in turn: torque \
                      has to go off each time.",
        expected: "torque off each time",
        unit: "",
        otherwise: "do not go on: nothing else stops it by hand",
        kind: StepKind::ByHand,
    },
];
