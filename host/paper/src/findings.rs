//! The sixteen things the paper measured, simulated or left open: our command for each, and what it
//! says.

use super::case::{RunCurves, TS_S, sampled};
use super::computed::Computed;
use super::figure::{Holds, PaperFigure};
use super::pushed_servo::position_and_velocity;
use super::robot::edge;
use crate::error::Result;
use crate::output::number::short;
use crate::study::{SIGNAL_PATHS, SignalPath, longest_linear};
use crate::synth::controllers::{DEFAULT, DesignModel};
use crate::synth::{linearise, poles, upright, zoh};
use serde::Serialize;

/// Centres of mass are right to this, m.
const CENTROID_M: f64 = 0.5e-3;
/// Longest delay that is tried, s.
const MOST_DELAY_S: f64 = 0.05;

/// One of the sixteen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Counted from 1.
    pub number: usize,
    /// What the paper found or asked.
    pub found: &'static str,
    /// The command that shows it.
    pub command: &'static str,
    /// What comes of it.
    #[serde(rename = "sentence")]
    pub said: String,
    /// Whether it holds here.
    #[serde(rename = "verdict")]
    pub holds: Holds,
}

/// What comes of a finding, and whether it holds.
pub(super) type Conclusion = (String, Holds);

/// What was found or asked, the command, and what comes of it.
type FindingRow = (&'static str, &'static str, Conclusion);

/// All sixteen.
///
/// # Errors
/// None is known.
pub fn findings(computed: &Computed, figures: &[PaperFigure]) -> Result<Vec<Finding>> {
    let mut all = on_servos(computed, figures)?;
    all.extend(on_the_robot(computed, figures));
    let numbered = all.into_iter().zip(1..);
    let finding = |((found, command, (said, holds)), number)| Finding {
        number,
        found,
        command,
        said,
        holds,
    };
    Ok(numbered.map(finding).collect())
}

/// The verdict of a figure.
fn figure(figures: &[PaperFigure], number: &str) -> Conclusion {
    let found = figures.iter().find(|figure| figure.number == number);
    found.map_or((String::new(), Holds::NotReproducible), |figure| {
        (figure.sentence.clone(), figure.holds)
    })
}

fn shown_elsewhere(said: &str) -> Conclusion {
    (said.to_string(), Holds::ShownElsewhere)
}

/// Timing, signals and servos.
fn on_servos(computed: &Computed, figures: &[PaperFigure]) -> Result<Vec<FindingRow>> {
    let figure = |number| figure(figures, number);
    Ok(vec![
        (
            "Are the delays of serial line, CM-5 and RS485 compatible with the sampling time?",
            "handstand delays",
            delays(computed)?,
        ),
        (
            "Position, temperature and voltage at 100 Hz, velocity and load at 10 Hz, in raw units",
            "handstand log check",
            shown_elsewhere(
                "Models declare each column's unit and offset; the 100 Hz position gives the speed \
                 (eq. 1), so the 10 Hz columns are not needed.",
            ),
        ),
        (
            "Closed-loop position control follows a sine under an outside torque; open-loop \
             velocity control does not",
            "handstand paper",
            position_and_velocity()?,
        ),
        (
            "Stiction: a dead zone of 7-10 % of full range (Figure 4)",
            "handstand map dead-zone",
            figure("4"),
        ),
        (
            "Velocity error proportional to the supply, right only near 9.8 V (Figure 5)",
            "handstand map supply",
            figure("5"),
        ),
        (
            "Temperature, 25-40 C: no visible effect",
            "handstand diagnose",
            shown_elsewhere(
                "A diagnosis can say no: `nominal` where no effect predicts held-out motions \
                 better; `cargo xtask hidden` counts its false alarms.",
            ),
        ),
        (
            "Torque from commanded speed: linear outside the dead zone, 2 N m at most (Figure 7)",
            "handstand map dead-zone",
            figure("7"),
        ),
        (
            "Masses, centres of mass within 0.5 mm, inertia tensors (Table 1)",
            "handstand paper",
            centroids(computed)?,
        ),
        (
            "Servo identified by prediction error: Box-Jenkins (2,1,2,1), validated (Figures 9, \
             10)",
            "handstand identify",
            figure("10"),
        ),
    ])
}

/// The robot: equations, balance, outlook.
fn on_the_robot(computed: &Computed, figures: &[PaperFigure]) -> Vec<FindingRow> {
    let figure = |number| figure(figures, number);
    vec![
        (
            "n-link equations, linearised upright; poles and zeros: non-minimum phase",
            "handstand paper",
            zeros(computed),
        ),
        (
            "LQR fails with eccentric masses, works with angle compensation (Figure 12)",
            "handstand paper",
            figure("12"),
        ),
        (
            "DLQR at 0.01 s; with 300 deg / 2^10 it chatters (Figure 13)",
            "handstand paper",
            figure("13"),
        ),
        (
            "Gyro of 10 deg/s with constant perturbation: larger control, still stable (Figure 14 \
             a,c,e)",
            "handstand paper",
            figure("14 a,c,e"),
        ),
        (
            "Dead zone of 10 % and 2 N m: not stabilised (Figure 14 b,d,f)",
            "handstand paper",
            figure("14 b,d,f"),
        ),
        (
            "An animation of the handstand",
            "handstand view",
            shown_elsewhere("A page that plays a log, with a model or another log drawn over it."),
        ),
        (
            "Future work: sliding-mode control; the servo's transfer function in the controller's \
             model",
            "handstand controllers",
            shown_elsewhere(
                "Both are among the controllers there: a sliding mode, alone and with an observer, \
                 and an LQR whose model has the servo's transfer function; each is simulated under \
                 every non-ideality, alone and together.",
            ),
        ),
    ]
}

/// The largest delay the sampled loop stands, with gains that do not know of it, and the delays of
/// the robot.
fn delays(computed: &Computed) -> Result<Conclusion> {
    let falls = |delay_s: f64| {
        let mut case = sampled()?;
        case.drives.delay_periods = delay_s / TS_S;
        let run = RunCurves::leaning(&case, 0.1f64.to_radians())?;
        Ok(run.outcome.fell_s.is_some())
    };
    let falls_s = edge(falls, 0.0, MOST_DELAY_S)?;
    let nominal = DesignModel::new(&computed.model, &upright(&computed.model), TS_S)?;
    let stable = longest_linear(
        DEFAULT,
        &nominal,
        Some(0.0),
        1e-3 * MOST_DELAY_S,
        MOST_DELAY_S,
    )?;
    let stable_s = stable.delay_s.unwrap_or(0.0);
    let path_s = |servos: usize, baud: Option<f64>, factory: bool| {
        let wanted =
            |path: &&SignalPath| (path.servos, path.baud, path.factory) == (servos, baud, factory);
        let path = SIGNAL_PATHS.iter().find(wanted);
        path.map_or(f64::NAN, SignalPath::total_s)
    };
    let on_board_s = path_s(4, None, false);
    let over_pc_s = path_s(18, Some(57_600.0), false);
    let ms = |seconds: f64| format!("{:.1} ms", 1e3 * seconds);
    let said = format!(
        "The sampled loop is stable up to {} from sample to torque; later it swings, and from {} \
         on it falls. Reading four servos and telling them takes {} on the bus ({} with the \
         factory's return delay): on board the delays are compatible. By way of a PC at 57600 \
         baud, with all 18 servos, it takes {}: {}.",
        ms(stable_s),
        ms(falls_s),
        ms(on_board_s),
        ms(path_s(4, None, true)),
        ms(over_pc_s),
        if over_pc_s < stable_s {
            "they are, too"
        } else {
            "there they are not"
        }
    );
    let holds = match (on_board_s < stable_s, over_pc_s < stable_s) {
        (true, over_pc) => Holds::at_least_in_part(over_pc),
        _ => Holds::No,
    };
    Ok((said, holds))
}

/// How little 0.5 mm of each centre of mass matter: the spectral radius of the sampled loop at the
/// corners.
fn centroids(computed: &Computed) -> Result<Conclusion> {
    let mut worst: f64 = 0.0;
    for corner in 0..8 {
        let mut model = computed.model.clone();
        for (k, link) in model.links.iter_mut().enumerate() {
            let sign = if corner >> k & 1 == 0 { 1.0 } else { -1.0 };
            link.com_m += sign * CENTROID_M;
        }
        let off = zoh(&linearise(&model, &upright(&model))?.plant, TS_S, 0.0)?;
        let closed = &off.a - &off.b * &computed.dlqr.k;
        let radii = poles(&closed)?.into_iter().map(|pole| pole.norm());
        worst = radii.fold(worst, f64::max);
    }
    let nominal = computed.dlqr.poles.iter().map(|pole| pole.norm());
    let nominal = nominal.fold(0.0, f64::max);
    let stable = worst < 1.0;
    let said = format!(
        "The model file holds Table 1 to every digit. With each centre of mass off by 0.5 mm \
         either way the sampled loop's spectral radius goes from {nominal:.4} to {worst:.4} at \
         worst: {}.",
        if stable {
            "it stays stable"
        } else {
            "it is lost"
        }
    );
    Ok((said, Holds::when(stable)))
}

fn zeros(computed: &Computed) -> Conclusion {
    let unstable = computed.poles.iter().filter(|pole| pole.re > 0.0).count();
    let right = computed.zeros.iter().filter(|zeros| zeros.squared > 0.0);
    let right = right.map(|zeros| {
        let [a, b] = zeros.outputs;
        format!("+{} 1/s to (q{a}, q{b})", short(zeros.squared.sqrt()))
    });
    let right: Vec<String> = right.collect();
    let said = format!(
        "{unstable} of 6 poles are unstable, and from the torques there are zeros in the right \
         half plane at {}: non-minimum phase. The equations of any n agree with Lagrange's by \
         finite differences and keep energy (tests).",
        right.join(", ")
    );
    (said, Holds::when(unstable == 3 && !right.is_empty()))
}
