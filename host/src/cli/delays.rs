//! `handstand delays MODEL`: the longest delay each controller tolerates, and whether the robot's
//! is shorter.
//!
//! Four figures for each controller, in ms. In the linear loop with the nominal plant:
//! uncompensated, designed for a delay of one sample, and designed for each delay as it comes
//! (compensated). In simulation: compensated, up to which delay 95 % of the robots are stabilised
//! under `--condition` (all non-idealities at once). Every shorter delay of the search is tolerated
//! too, except where a shortest one is given: designed for one sample, a controller may need that
//! delay.
//!
//! Then the latency budget: the ways from sample to torque, what each takes with and without the
//! servo's own dead time (17 to 50 ms), how many controllers are stable with that, and which
//! stabilise the robots.
//!
//! ```console
//! $ handstand delays handstand.toml --controller dlqr --controller best
//! ```
//!
//! `--json` prints `controllers` (`controller`, `uncompensated`, `compensated_one_sample`,
//! `compensated`, `stabilised`, each with `shortest_s`, `delay_s` and `open`) and `paths` (`path`,
//! `bus_s`, `line_s`, `servo_s`, `total_s`, `stable`, `stabilised`: the compensated controllers
//! that tolerate the total).

use super::controllers::{chosen_conditions, chosen_designs};
use super::gains_choice::GainsChoice;
use super::{Console, ExitStatus, input, show};
use handstand::report::table::columns_of;
use handstand::study::{
    Case, Judging, Longest, SERVO_DEAD_TIME_S, SIGNAL_PATHS, SignalPath, longest_linear,
    longest_stabilised,
};
use handstand::synth::controllers::{ControllerDesign, DEFAULT, DesignModel};
use handstand::synth::upright;
use handstand::{Model, Result};
use serde::Serialize;
use serde_json::json;
use std::path::PathBuf;

/// Find the delay margin of each controller.
#[derive(Debug, clap::Args)]
pub struct DelaysArgs {
    /// Model file
    model: PathBuf,
    /// A controller, by name; all without it
    #[arg(long = "controller", value_name = "NAME")]
    controllers: Vec<String>,
    #[command(flatten)]
    gains: GainsChoice,
    /// Condition of the simulated robots
    #[arg(long, value_name = "NAME", default_value = "all")]
    condition: String,
    /// Robots simulated at each delay; 0 leaves the simulation out
    #[arg(long, value_name = "N", default_value_t = 100)]
    robots: u32,
    /// Step of the linear search, ms; the simulated one takes steps five times as long
    #[arg(long, value_name = "MS", default_value_t = 0.5, value_parser = input::positive)]
    step_ms: f64,
    /// Longest delay that is tried, ms
    #[arg(long, value_name = "MS", default_value_t = 100.0, value_parser = input::positive)]
    until_ms: f64,
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = input::positive)]
    ts: f64,
    /// Seed of the robots
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// The delays that a controller tolerates.
#[derive(Serialize)]
struct DelayMargins {
    controller: &'static str,
    uncompensated: Longest,
    #[serde(rename = "compensated_one_sample")]
    one_sample: Longest,
    compensated: Longest,
    stabilised: Option<Longest>,
}

/// A way from sample to torque, what it takes, and the compensated controllers that tolerate it.
#[derive(Serialize)]
struct PathBudget {
    path: String,
    bus_s: f64,
    line_s: f64,
    servo_s: f64,
    total_s: f64,
    stable: Vec<&'static str>,
    /// None where no robot was simulated.
    stabilised: Option<Vec<&'static str>>,
}

/// Searches and prints.
pub fn run(args: &DelaysArgs, console: &Console) -> Result<ExitStatus> {
    let designs = chosen_designs(&args.controllers)?;
    let model = Model::load(&args.model)?;
    let designs = args
        .gains
        .designs(&args.controllers, designs, (&model, args.ts))?;
    let margins = search(args, &model, &designs, console)?;
    let budget = |path| dead_times().map(move |servo_s| (path, servo_s));
    let ways = SIGNAL_PATHS.iter().flat_map(budget);
    let paths: Vec<_> = ways
        .map(|(path, s)| PathBudget::of(path, s, &margins))
        .collect();
    let data = json!({ "controllers": margins, "paths": paths });
    console.result(&data, || text(&margins, &paths, args))?;
    Ok(ExitStatus::Done)
}

/// Dead times of a servo, s: none, and as measured.
fn dead_times() -> impl Iterator<Item = f64> {
    std::iter::once(0.0).chain(SERVO_DEAD_TIME_S)
}

fn search(
    args: &DelaysArgs,
    model: &Model,
    designs: &[&'static dyn ControllerDesign],
    console: &Console,
) -> Result<Vec<DelayMargins>> {
    let mut weighed = Case::ideal(model.clone(), DEFAULT, args.ts);
    args.gains.weigh(&mut weighed)?;
    let nominal = DesignModel {
        q: weighed.control.q.clone(),
        r: weighed.control.r.clone(),
        ..DesignModel::new(model, &upright(model), args.ts)?
    };
    let conditions = chosen_conditions(std::slice::from_ref(&args.condition))?;
    let judging = Judging {
        runs: args.robots as usize,
        start_rad: 2f64.to_radians(),
        seconds: 5.0,
        seed: args.seed,
    };
    let (step_s, until_s) = (1e-3 * args.step_ms, 1e-3 * args.until_ms);
    let bar = console.bar(designs.len() as u64);
    let mut margins = Vec::new();
    for design in designs {
        bar.set_message(design.info().title.to_string());
        let linear =
            |known_s: Option<f64>| longest_linear(*design, &nominal, known_s, step_s, until_s);
        let mut case = weighed.clone();
        case.control.design = *design;
        let uncertain = conditions[0].apply(&mut case);
        let simulated = || longest_stabilised(&case, &uncertain, &judging, 5.0 * step_s, until_s);
        margins.push(DelayMargins {
            controller: design.info().id,
            uncompensated: linear(Some(0.0))?,
            one_sample: linear(Some(args.ts))?,
            compensated: linear(None)?,
            stabilised: (args.robots > 0).then(simulated).transpose()?,
        });
        bar.inc(1);
    }
    Ok(margins)
}

impl PathBudget {
    fn of(path: &SignalPath, servo_s: f64, margins: &[DelayMargins]) -> PathBudget {
        let total_s = path.total_s() + servo_s;
        let tolerant = |longest: fn(&DelayMargins) -> Option<Longest>| -> Vec<&'static str> {
            let tolerates =
                |own: &&DelayMargins| longest(own).is_some_and(|l| l.tolerates(total_s));
            let own = margins.iter().filter(tolerates);
            own.map(|own| own.controller).collect()
        };
        PathBudget {
            path: path.title(),
            bus_s: path.bus_s(),
            line_s: path.line_s(),
            servo_s,
            total_s,
            stable: tolerant(|own| Some(own.compensated)),
            stabilised: margins
                .iter()
                .any(|own| own.stabilised.is_some())
                .then(|| tolerant(|own| own.stabilised)),
        }
    }

    fn title(&self) -> String {
        match self.servo_s {
            0.0 => self.path.clone(),
            dead_s => format!("  and a servo's dead time of {:.0} ms", 1e3 * dead_s),
        }
    }
}

fn text(margins: &[DelayMargins], paths: &[PathBudget], args: &DelaysArgs) -> String {
    let longest = columns_of::<DelayMargins>()
        .text("Controller", |o| o.controller.to_string())
        .text("uncompensated", |o| ms(o.uncompensated))
        .text("one sample compensated", |o| ms(o.one_sample))
        .text("compensated", |o| ms(o.compensated))
        .text("stabilised, compensated", |o| {
            o.stabilised.map_or(String::new(), ms)
        });
    let budget = columns_of::<PathBudget>()
        .text("From sample to torque", |p| p.title())
        .text("ms", |p| format!("{:.1}", 1e3 * p.total_s))
        .text("stable", |p| {
            format!("{} of {}", p.stable.len(), margins.len())
        })
        .text("stabilised, compensated", |path| {
            match path.stabilised.as_deref() {
                None => "not simulated".into(),
                Some([]) => "none".into(),
                Some(stabilised) => stabilised.join(", "),
            }
        });
    format!(
        "Longest delay tolerated, ms; the linear loop, and 95 % of robots stabilised under \
         `{}`:\n{}\n\n{}",
        args.condition,
        show::table_of(margins, &longest),
        show::table_of(paths, &budget)
    )
}

fn ms(longest: Longest) -> String {
    let (Some(least), Some(most)) = (longest.shortest_s, longest.delay_s) else {
        return "none".into();
    };
    let sign = if longest.open { ">" } else { "" };
    match least {
        0.0 => format!("{sign}{:.1}", 1e3 * most),
        least => format!("{:.1} to {sign}{:.1}", 1e3 * least, 1e3 * most),
    }
}
