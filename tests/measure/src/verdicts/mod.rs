//! Are the verdicts on designs right? Random robots with one to three non-idealities, designed for
//! by `handstand`, simulated by equations and an integrator of this folder's own, which know
//! nothing of the library's.
//!
//! `robot` (what a robot is, as TOML and as numbers) -> `table` (the exported table and its
//! arithmetic) -> `chain` (equations of motion) -> `simulator` (drives, friction, sensors, time) ->
//! [`judge`].

pub mod chain;
pub mod robot;
pub mod simulator;
pub mod table;

use handstand::Model;
use handstand::study::{Verification, left_out, verify};
use handstand::synth::export::{self, Provenance};
use handstand::synth::{CostWeights, Design, Request, Weight};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use robot::Robot;
use simulator::Simulation;
use std::path::Path;
use table::Table;

/// Length of a run, s.
pub const SECONDS: f64 = 15.0;
/// Share of the runs that have to stand.
const ENOUGH: f64 = 0.95;

/// One robot, judged twice.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The robot.
    pub robot: Robot,
    /// What `gains` says.
    pub gains: bool,
    /// Share of 40 starts that `gains` sees stabilised.
    pub gains_share: f64,
    /// Share of the starts that stand in the simulation of this folder.
    pub stood: f64,
    /// Whether as many stand without any command.
    pub held: bool,
}

impl Judged {
    /// The verdict of the simulation of this folder.
    pub fn stands(&self) -> bool {
        self.stood >= ENOUGH && !self.held
    }

    /// Whether both say the same.
    pub fn agrees(&self) -> bool {
        self.gains == self.stands()
    }
}

/// Designs for a robot and judges it twice; `runs` starts are simulated here.
///
/// # Errors
/// Why there is no design.
pub fn judge(robot: Robot, runs: usize, seed: u64) -> Result<Judged, String> {
    let (verified, table) = designed(&robot)?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let most_rad = verified.near_rad;
    let starts: Vec<[f64; 3]> = (0..runs)
        .map(|_| std::array::from_fn(|_| random.random_range(-most_rad..=most_rad)))
        .collect();
    let share = |table: Option<&Table>| {
        let stands = |start: &&[f64; 3]| Simulation::new(&robot, **start).stands(table, SECONDS);
        starts.iter().filter(stands).count() as f64 / runs as f64
    };
    let stood = share(Some(&table));
    Ok(Judged {
        gains: verified.stabilised,
        gains_share: verified.near.stabilised_share,
        held: stood >= ENOUGH && share(None) >= ENOUGH,
        stood,
        robot,
    })
}

/// What `handstand gains` says of the robot, and the table that it exports.
fn designed(robot: &Robot) -> Result<(Verification, Table), String> {
    let said = |error: handstand::Error| error.to_string();
    let model = Model::parse(&robot.toml(), Path::new("robot.toml")).map_err(said)?;
    let request = Request {
        weights: CostWeights::Given {
            q: Weight::Diagonal(robot.q.to_vec()),
            r: Weight::Scalar(1.0),
        },
        ..Request::standard(&model)
    };
    let design = Design::of(&model, &request).map_err(|error| error.to_string())?;
    let left_out = left_out(&model, &model, &design);
    let verified = verify(&model, &design, &request, &left_out, &|| ()).map_err(said)?;
    let made = Provenance {
        model: "robot.toml".into(),
        sha256: String::new(),
        command: String::new(),
    };
    let table = Table::read(&export::json(&design, &made)["fixed"]);
    Ok((verified, table.ok_or("the JSON holds no table")?))
}
