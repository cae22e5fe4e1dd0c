//! What is hidden in which rig: families of cases, each with its target.

use super::approximate::Stated;
use super::case::{Case, Truth};
use super::robot::ROBOT_KINDS;
use handstand::challenge::{KINDS, Motions};

/// A family of cases.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// One effect at the bench arm.
    Single,
    /// One effect at the robot of three links, hanging.
    Hanging,
    /// The same, with logs of balancing too.
    Balancing,
    /// Two effects at the bench arm.
    Pairs,
    /// Three effects at the bench arm.
    Triples,
    /// The bench arm that hides nothing.
    Nothing,
    /// The hanging robot that hides nothing.
    NothingHanging,
    /// The hanging and balancing robot that hides nothing.
    NothingBalancing,
    /// One effect at the bench arm that the library lacks.
    Outside,
    /// One effect at the bench arm, of whose file every other value is a little wrong, too.
    Approximate,
    /// The same, where the file frees them all.
    ApproximateFree,
    /// One effect at the hanging robot of three links, whose file is a little wrong everywhere.
    ApproximateHanging,
    /// The bench arm that hides nothing, whose file is a little wrong everywhere.
    NothingApproximate,
    /// One effect at a desk arm in space of five joints.
    Space,
    /// That arm, which hides nothing.
    NothingSpace,
    /// One effect at the SO-101, of six joints.
    So101,
    /// That arm, which hides nothing.
    NothingSo101,
    /// One effect at an arm of seven joints like the Panda.
    Panda,
    /// That arm, which hides nothing.
    NothingPanda,
    /// One effect at the virtual robot, hanging, recorded through the firmware's logic.
    Robot,
    /// That robot, which hides nothing.
    NothingRobot,
}

/// A robot in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpaceArm {
    /// Five joints, the scripts' own.
    Desk,
    /// The SO-101's URDF of `HANDSTAND_DATA`.
    So101,
    /// Seven joints, the scripts' own.
    Panda,
}

/// All families, in the order of the tables.
pub const FAMILIES: [Family; 21] = [
    Family::Single,
    Family::Hanging,
    Family::Balancing,
    Family::Pairs,
    Family::Triples,
    Family::Nothing,
    Family::NothingHanging,
    Family::NothingBalancing,
    Family::Outside,
    Family::Approximate,
    Family::ApproximateFree,
    Family::ApproximateHanging,
    Family::NothingApproximate,
    Family::Space,
    Family::NothingSpace,
    Family::So101,
    Family::NothingSo101,
    Family::Panda,
    Family::NothingPanda,
    Family::Robot,
    Family::NothingRobot,
];

/// Effects that MuJoCo simulates and the library does not know.
pub const OUTSIDE: [&str; 6] = [
    "position_trap",
    "quadratic_stiffness",
    "viscoelastic",
    "hidden_pendulum",
    "rub",
    "warm_up",
];

/// Effects that MuJoCo hides in an arm in space; its file states armatures, so another one is a
/// wrong value, and no effect.
const IN_SPACE: [&str; 9] = [
    "coulomb",
    "viscous",
    "armature",
    "gear_backlash",
    "delay",
    "dead_zone",
    "mass",
    "encoder_zero",
    "torque_saturation",
];

/// Effects that say what one value of the file says: where each is a little wrong, nothing hides in
/// one more.
const OF_VALUES: [&str; 3] = ["mass", "armature", "torque_scale"];

/// What counts as right in a family, and how often it must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// What the share is of.
    pub name: &'static str,
    /// Least share.
    pub share: f64,
}

impl Family {
    /// Its name in options and tables.
    pub fn name(self) -> &'static str {
        match self {
            Family::Single => "single",
            Family::Hanging => "hanging",
            Family::Balancing => "balancing",
            Family::Pairs => "pairs",
            Family::Triples => "triples",
            Family::Nothing => "nothing",
            Family::NothingHanging => "nothing-hanging",
            Family::NothingBalancing => "nothing-balancing",
            Family::Outside => "outside",
            Family::Approximate => "approximate",
            Family::ApproximateFree => "approximate-free",
            Family::ApproximateHanging => "approximate-hanging",
            Family::NothingApproximate => "nothing-approximate",
            Family::Space => "space",
            Family::NothingSpace => "nothing-space",
            Family::So101 => "so101",
            Family::NothingSo101 => "nothing-so101",
            Family::Panda => "panda",
            Family::NothingPanda => "nothing-panda",
            Family::Robot => "robot",
            Family::NothingRobot => "nothing-robot",
        }
    }

    /// The family of this name.
    pub fn named(name: &str) -> Option<Family> {
        FAMILIES.into_iter().find(|family| family.name() == name)
    }

    /// Which rig moves how.
    pub fn motions(self) -> Motions {
        match self {
            Family::Hanging | Family::NothingHanging | Family::ApproximateHanging => {
                Motions::Hanging
            }
            Family::Balancing | Family::NothingBalancing => Motions::Balancing,
            _ => Motions::Arm,
        }
    }

    /// Whether its cases hide nothing.
    pub fn hides_nothing(self) -> bool {
        matches!(
            self,
            Family::Nothing
                | Family::NothingHanging
                | Family::NothingBalancing
                | Family::NothingApproximate
                | Family::NothingSpace
                | Family::NothingSo101
                | Family::NothingPanda
                | Family::NothingRobot
        )
    }

    /// What its files say of values that are a little wrong; `None` where they are right.
    pub(super) fn stated(self) -> Option<Stated> {
        match self {
            Family::ApproximateFree => Some(Stated::Free),
            Family::Approximate | Family::ApproximateHanging | Family::NothingApproximate => {
                Some(Stated::Uncertain)
            }
            _ => None,
        }
    }

    /// Whether its files are a little wrong everywhere.
    pub fn is_approximate(self) -> bool {
        self.stated().is_some()
    }

    /// Which robot in space its rig is, which MuJoCo alone makes.
    pub fn arm(self) -> Option<SpaceArm> {
        match self {
            Family::Space | Family::NothingSpace => Some(SpaceArm::Desk),
            Family::So101 | Family::NothingSo101 => Some(SpaceArm::So101),
            Family::Panda | Family::NothingPanda => Some(SpaceArm::Panda),
            _ => None,
        }
    }

    /// Whether its rig is a robot in space.
    pub fn is_in_space(self) -> bool {
        self.arm().is_some()
    }

    /// Whether its logs are recordings of the virtual robot.
    pub fn is_recorded(self) -> bool {
        matches!(self, Family::Robot | Family::NothingRobot)
    }

    /// What must be reached.
    pub fn target(self) -> Target {
        let (name, share) = match self {
            Family::Single => ("named, or in an equivalent set", 0.97),
            Family::Hanging
            | Family::Balancing
            | Family::Pairs
            | Family::Space
            | Family::So101
            | Family::Panda
            | Family::Approximate
            | Family::ApproximateFree => ("named, or in an equivalent set", 0.9),
            Family::Triples => ("named, or in an equivalent set", 0.75),
            Family::ApproximateHanging => ("named, or in an equivalent set", 0.8),
            Family::Robot => ("named, or in an equivalent set", 0.85),
            Family::Nothing
            | Family::NothingApproximate
            | Family::NothingHanging
            | Family::NothingBalancing
            | Family::NothingSpace
            | Family::NothingSo101
            | Family::NothingPanda
            | Family::NothingRobot => ("nothing is said to be missing", 0.99),
            Family::Outside => ("unexplained", 0.95),
        };
        Target { name, share }
    }
}

/// Which cases to try.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Who makes the logs.
    pub truth: Truth,
    /// Families.
    pub families: Vec<Family>,
    /// Effects to hide singly; all that the truth has if empty.
    pub effects: Vec<String>,
    /// Rigs per effect; of pairs and triples ten sets per seed.
    pub seeds: u64,
    /// Arms that hide nothing; of the robot as many as seeds.
    pub nominal: u64,
    /// First seed of each kind.
    pub seed0: u64,
}

impl Plan {
    /// Every case, family by family.
    pub fn cases(&self) -> Vec<Case> {
        self.families
            .iter()
            .flat_map(|&family| self.of(family))
            .collect()
    }

    /// An error that names the first family of which there is nothing to try, and why.
    pub fn check(&self) -> Result<(), String> {
        let mut families = self.families.iter();
        let Some(&family) = families.find(|family| self.of(**family).is_empty()) else {
            return Ok(());
        };
        let why = match self.other_truth(family) {
            Some(needed) => format!("its logs are made with --truth {}", needed.name()),
            None => "it hides none of these --effects, or --seeds or --nominal is 0".into(),
        };
        Err(format!("{}: nothing to try; {why}", family.name()))
    }

    /// Who makes a family's logs, where this plan's truth does not.
    fn other_truth(&self, family: Family) -> Option<Truth> {
        let makers: &[Truth] = if family.is_recorded() {
            &[Truth::Robot]
        } else if family.is_in_space() {
            &[Truth::Mujoco]
        } else {
            &[Truth::Own, Truth::Mujoco]
        };
        (!makers.contains(&self.truth)).then(|| makers[0])
    }

    fn of(&self, family: Family) -> Vec<Case> {
        let case = |hidden: Vec<&'static str>, seed| Case {
            truth: self.truth,
            family,
            hidden,
            seed,
            skipped: Vec::new(),
        };
        let seeds = self.seed0..self.seed0 + self.seeds;
        let wanted = |kind: &&str| {
            self.effects.is_empty() || self.effects.iter().any(|effect| effect == kind)
        };
        let each = |kinds: &[&'static str]| -> Vec<Case> {
            let kinds = kinds.iter().filter(|kind| wanted(kind));
            kinds
                .flat_map(|kind| seeds.clone().map(|seed| case(vec![kind], seed)))
                .collect()
        };
        if self.other_truth(family).is_some() {
            return Vec::new();
        }
        match family {
            Family::Robot => each(&kinds(self.truth)),
            Family::Space | Family::So101 | Family::Panda => each(&IN_SPACE),
            Family::Approximate | Family::ApproximateFree | Family::ApproximateHanging => {
                let mut kinds = kinds(self.truth);
                kinds.retain(|kind| !OF_VALUES.contains(kind));
                each(&kinds)
            }
            Family::Single | Family::Hanging | Family::Balancing => each(&kinds(self.truth)),
            Family::Outside => match self.truth {
                Truth::Own => {
                    // The file's stall torque says what a torque scale does.
                    let kinds = kinds(self.truth).into_iter();
                    each(
                        &kinds
                            .filter(|kind| *kind != "torque_scale")
                            .collect::<Vec<_>>(),
                    )
                }
                Truth::Mujoco => each(&OUTSIDE),
                Truth::Robot => Vec::new(),
            },
            Family::Pairs => self.sets(2, &case),
            Family::Triples => self.sets(3, &case),
            Family::Nothing | Family::NothingApproximate => (self.seed0..self.seed0 + self.nominal)
                .map(|seed| case(Vec::new(), seed))
                .collect(),
            Family::NothingHanging
            | Family::NothingBalancing
            | Family::NothingSpace
            | Family::NothingSo101
            | Family::NothingPanda
            | Family::NothingRobot => seeds.map(|seed| case(Vec::new(), seed)).collect(),
        }
    }

    /// Ten random sets of so many effects per seed.
    fn sets(&self, size: usize, case: &dyn Fn(Vec<&'static str>, u64) -> Case) -> Vec<Case> {
        use rand::{SeedableRng, seq::IndexedRandom};
        let kinds = kinds(self.truth);
        let first = 10 * (self.seed0 - 1) + 1;
        (first..first + 10 * self.seeds)
            .map(|seed| {
                let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
                rng.set_stream(size as u64);
                let mut set: Vec<&str> = kinds.choose_multiple(&mut rng, size).copied().collect();
                set.sort_unstable();
                case(set, seed)
            })
            .collect()
    }
}

/// Effects of the library that this truth can hide.
pub fn kinds(truth: Truth) -> Vec<&'static str> {
    match truth {
        Truth::Own => KINDS.to_vec(),
        Truth::Mujoco => {
            let has = |kind: &&str| !["load_friction", "drive_asymmetry"].contains(kind);
            KINDS.into_iter().filter(has).collect()
        }
        Truth::Robot => ROBOT_KINDS.to_vec(),
    }
}
