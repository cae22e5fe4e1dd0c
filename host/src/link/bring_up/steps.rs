//! The steps of the checklist, in their order: nothing gets torque before what would stop it is known
//! to work.

/// A step.
#[derive(Debug)]
pub struct Step {
    /// Its name, as in `docs/bring-up.md`.
    pub id: &'static str,
    /// What has to be so.
    pub title: &'static str,
    /// How to see it.
    pub instruction: &'static str,
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
            | Check::GyroZero => false,
        }
    }
}

/// All steps.
pub const STEPS: &[Step] = &[
    Step {
        id: "fuses",
        title: "fuses as the boot loader needs them",
        instruction: "Read them, never write them: extended fuse FF (M103C unprogrammed), high fuse \
                      with BOOTSZ = 00 and BOOTRST programmed. Note BODEN and BODLEVEL: 4.0 V suits \
                      16 MHz; without it a failing supply may spoil EEPROM, which the plan's and the \
                      log's checks notice.",
        kind: StepKind::ByHand,
    },
    Step {
        id: "charger",
        title: "charger off",
        instruction: "Measure PB5 from 100 ms after power-on: it has to be high (5 V) and stay so.",
        kind: StepKind::ByHand,
    },
    Step {
        id: "firmware",
        title: "firmware of this version answers",
        instruction: "Greets it and asks why it last started.",
        kind: StepKind::Measured(Check::Firmware),
    },
    Step {
        id: "servos",
        title: "servos answer every ping",
        instruction: "Connect one servo alone at first (--ids 1). 20 pings each, as an adapter.",
        kind: StepKind::Measured(Check::Servos),
    },
    Step {
        id: "supply",
        title: "supply of 8.8 V and more",
        instruction: "As the servos report it.",
        kind: StepKind::Measured(Check::Supply),
    },
    Step {
        id: "ticks",
        title: "ticks keep their period",
        instruction: "Streams for 3 s: no tick may take longer than 10 ms.",
        kind: StepKind::Measured(Check::Ticks),
    },
    Step {
        id: "stack",
        title: "stack below 80 % of its room",
        instruction: "The deepest it has been since the start.",
        kind: StepKind::Measured(Check::Stack),
    },
    Step {
        id: "gyro",
        title: "gyro's zero steady",
        instruction: "At rest for 2 s: codes within 4 of each other, and 100 from the range's ends.",
        kind: StepKind::Measured(Check::GyroZero),
    },
    Step {
        id: "watchdog",
        title: "watchdog's period of 24 to 34 ms",
        instruction: "Flash an image that hangs once torque is off, and take the time between two \
                      FF FF FE 04 03 18 00 on the bus with a logic analyser.",
        kind: StepKind::ByHand,
    },
    Step {
        id: "reset",
        title: "torque off within 150 ms of a reset",
        instruction: "Short-circuit reset, and take the time until FF FF FE 04 03 18 00 on the bus: \
                      it includes the boot loader's.",
        kind: StepKind::ByHand,
    },
    Step {
        id: "goal",
        title: "whether a goal switches torque on",
        instruction: "Writes the first servo's position as its goal, at a tenth of its torque, and \
                      reads torque enable; then switches torque off. Either answer is safe: the \
                      firmware writes limits before goals.",
        kind: StepKind::Measured(Check::GoalTorque),
    },
    Step {
        id: "torque",
        title: "one servo holds its position with a tenth of its torque",
        instruction: "Arms the first servo alone, without goals, for a second, and reads the limits \
                      that it holds: 102 of torque, 1023 of speed.",
        kind: StepKind::Measured(Check::LimitedTorque),
    },
    Step {
        id: "link-loss",
        title: "a silent line switches torque off within 300 ms",
        instruction: "Arms again, says nothing for half a second, and reads the servo's torque and \
                      the fault log.",
        kind: StepKind::Measured(Check::LinkLoss),
    },
    Step {
        id: "buttons",
        title: "every button stops",
        instruction: "Arm with `handstand replay` or `balance`, press each button in turn: torque \
                      has to go off each time.",
        kind: StepKind::ByHand,
    },
];
