//! The sixteen things the paper measured, simulated or left open: our command for each, and what it
//! says.

use super::case::{Case, TS_S, sampled};
use super::computed::Computed;
use super::figure::{Figure, Holds};
use super::robot::edge;
use super::servo;
use crate::error::Result;
use crate::log::Motion;
use crate::model::{Drive, Model, Motor};
use crate::output::number::short;
use crate::sim::{Plant, SensorState, Start, predict};
use crate::study::{SIGNAL_PATHS, SignalPath};
use crate::synth::{linearise, poles, upright, zoh};

/// Centres of mass are right to this, m.
const CENTROID_M: f64 = 0.5e-3;

/// How far a finding is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// Computed here, with the verdict.
    Here(Holds),
    /// By another command.
    There,
    /// Not reproducible with this project alone.
    Not,
}

/// One of the sixteen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Counted from 1.
    pub number: usize,
    /// What the paper found or asked.
    pub found: &'static str,
    /// The command that shows it.
    pub command: &'static str,
    /// What comes of it.
    pub said: String,
    /// How far.
    pub shown: Shown,
}

impl Finding {
    /// The verdict in words.
    pub fn verdict(&self) -> &'static str {
        match self.shown {
            Shown::Here(holds) => holds.words(),
            Shown::There => "shown by the command",
            Shown::Not => "not reproducible here",
        }
    }
}

/// What was found or asked, the command, and what comes of it.
type Row = (&'static str, &'static str, (String, Shown));

/// All sixteen.
///
/// # Errors
/// None is known.
pub fn findings(computed: &Computed, figures: &[Figure]) -> Result<Vec<Finding>> {
    let rows = on_servos(computed, figures)?
        .into_iter()
        .chain(on_the_robot(computed, figures));
    let numbered = rows.enumerate();
    Ok(numbered
        .map(|(index, (found, command, (said, shown)))| Finding {
            number: index + 1,
            found,
            command,
            said,
            shown,
        })
        .collect())
}

/// The verdict of a figure.
fn figure(figures: &[Figure], number: &str) -> (String, Shown) {
    let found = figures.iter().find(|figure| figure.number == number);
    found.map_or((String::new(), Shown::Not), |figure| {
        (figure.sentence.clone(), Shown::Here(figure.holds))
    })
}

fn there(said: &str) -> (String, Shown) {
    (said.to_string(), Shown::There)
}

/// Timing, signals and servos.
fn on_servos(computed: &Computed, figures: &[Figure]) -> Result<Vec<Row>> {
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
            there(
                "Models declare each column's unit and offset; the 100 Hz position gives the speed (eq. 1), so the 10 Hz \
                 columns are not needed.",
            ),
        ),
        (
            "Closed-loop position control follows a sine under an outside torque; open-loop velocity control does not",
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
            there(
                "A diagnosis can say no: `nominal` where no effect predicts held-out motions better; `cargo xtask \
                 hidden` counts its false alarms.",
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
            "Servo identified by prediction error: Box-Jenkins (2,1,2,1), validated (Figures 9, 10)",
            "handstand identify",
            figure("10"),
        ),
    ])
}

/// The robot: equations, balance, outlook.
fn on_the_robot(computed: &Computed, figures: &[Figure]) -> Vec<Row> {
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
            "Gyro of 10 deg/s with constant perturbation: larger control, still stable (Figure 14 a,c,e)",
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
            there("A page that plays a log, with a model or another log drawn over it."),
        ),
        (
            "Future work: sliding-mode control; the servo's transfer function in the controller's model",
            "handstand controllers",
            there(
                "Both are among the controllers there: a sliding mode, alone and with an observer, and an LQR whose model has \
                 the servo's transfer function; each is simulated under every non-ideality, alone and together.",
            ),
        ),
    ]
}

/// The largest delay the sampled loop stands, with gains that do not know of it and with gains that
/// do.
fn delays(computed: &Computed) -> Result<(String, Shown)> {
    let falls = |delay_s: f64, case: &Case| {
        let mut case = case.clone();
        case.drives.delay_periods = delay_s / TS_S;
        Ok(case.run(0.1f64.to_radians())?.outcome.fell_s.is_some())
    };
    let plain = sampled(computed);
    let plain_s = edge(|delay| falls(delay, &plain), 0.0, 0.05)?;
    // The linear loop's own limit: a pole outside the unit circle.
    let unstable = |delay_s: f64| -> Result<bool> {
        let late = zoh(&computed.plant, TS_S, delay_s)?;
        let mut gains = computed.dlqr.k.clone();
        gains = gains.resize_horizontally(late.a.nrows(), 0.0);
        let closed = &late.a - &late.b * gains;
        Ok(poles(&closed)?.iter().any(|pole| pole.norm() >= 1.0))
    };
    let linear_s = edge(unstable, 0.0, 0.05)?;
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
        "The sampled loop is stable up to {} from sample to torque; later it swings, and from {} on it falls. Reading four \
         servos and telling them takes {} on the bus ({} with the factory's return delay): on board the delays are \
         compatible. By way of a PC at 57600 baud, with all 18 servos, it takes {}: {}.",
        ms(linear_s),
        ms(plain_s),
        ms(on_board_s),
        ms(path_s(4, None, true)),
        ms(over_pc_s),
        if over_pc_s < linear_s {
            "they are, too"
        } else {
            "there they are not"
        }
    );
    let holds = match (on_board_s < linear_s, over_pc_s < linear_s) {
        (true, true) => Holds::Yes,
        (true, false) => Holds::InPart,
        _ => Holds::No,
    };
    Ok((said, Shown::Here(holds)))
}

/// What an outside torque does to a servo that holds an angle, and to one that is told a speed.
fn position_and_velocity() -> Result<(String, Shown)> {
    let base = servo::model()?;
    let motor = |model: &Model| model.joints[0].drive.motor().cloned();
    let Some(motor) = motor(&base) else {
        return Ok(("the servo has no motor".to_string(), Shown::Not));
    };
    let sine: Vec<f64> = (0..1200)
        .map(|k| 0.5 * (0.02 * f64::from(k)).sin())
        .collect();
    let rate: Vec<f64> = (0..1200)
        .map(|k| 0.5 * 2.0 * (0.02 * f64::from(k)).cos())
        .collect();
    let follow = |motor: Motor| Drive::Position {
        gain_per_rad: 10.0,
        motor,
    };
    let moved = [
        shift_rad(&base, follow(motor.clone()), &sine),
        shift_rad(&base, Drive::Duty(motor), &duty(&rate)),
    ];
    let [position, velocity] = moved;
    let holds = position.abs() < 0.1 && velocity.abs() > 3.0 * position.abs();
    let said = format!(
        "In simulation 0.3 N m from 6 s on move the position-controlled servo off its sine by {} deg and the speed-commanded one by \
         {} deg within 6 s.",
        short(position.to_degrees()),
        short(velocity.to_degrees())
    );
    let shown = if holds { Holds::Yes } else { Holds::No };
    Ok((said, Shown::Here(shown)))
}

/// Duty for a speed: past the dead zone, full at 11.9 rad/s.
fn duty(speed_rad_s: &[f64]) -> Vec<f64> {
    let of = |speed: &f64| (speed.abs() / 11.9 + 0.085).copysign(*speed);
    speed_rad_s.iter().map(of).collect()
}

/// Largest shift, rad, that 0.3 N m of a mass on a horizontal lever bring from 6 s on.
fn shift_rad(base: &Model, drive: Drive, input: &[f64]) -> f64 {
    let mut model = base.clone();
    model.joints[0].drive = drive;
    // The lever's weight pulls the same way at every angle that is reached: gravity's moment about
    // the level.
    model.angle_zero = crate::model::AngleZero::Horizontal;
    let with = |payload_kg: f64| Motion {
        payload_kg,
        ..servo::empty_motion(input.to_vec())
    };
    let run = |motion: &Motion, stretch: std::ops::Range<usize>, start: &Start| {
        let plant = Plant::new(&model, motion);
        let mut readings = vec![0.0; stretch.len()];
        let end = predict(
            &plant,
            motion,
            stretch,
            start,
            &mut SensorState::default(),
            &mut readings,
        );
        (readings, end)
    };
    let level = Start {
        angle_rad: vec![std::f64::consts::FRAC_PI_2],
        speed_rad_s: vec![0.0],
        ..Start::default()
    };
    let payload_kg = 0.3 / (model.gravity_m_s2 * model.log.payload_at_m);
    let (free, loaded) = (with(0.0), with(payload_kg));
    let (_, at_six) = run(&free, 0..600, &level);
    let (calm, _) = run(&free, 599..input.len(), &at_six);
    let (pulled, _) = run(&loaded, 599..input.len(), &at_six);
    let shifts = calm.iter().zip(&pulled).map(|(a, b)| (a - b).abs());
    shifts.fold(0.0, f64::max)
}

/// How little 0.5 mm of each centre of mass matter: the spectral radius of the sampled loop at the
/// corners.
fn centroids(computed: &Computed) -> Result<(String, Shown)> {
    let mut worst: f64 = 0.0;
    for corner in 0..8 {
        let mut model = computed.model.clone();
        for (k, link) in model.links.iter_mut().enumerate() {
            link.com_m += if corner >> k & 1 == 0 {
                CENTROID_M
            } else {
                -CENTROID_M
            };
        }
        let off = zoh(&linearise(&model, &upright(&model))?.plant, TS_S, 0.0)?;
        let closed = &off.a - &off.b * &computed.dlqr.k;
        worst = poles(&closed)?
            .iter()
            .fold(worst, |worst, pole| worst.max(pole.norm()));
    }
    let nominal = computed
        .dlqr
        .poles
        .iter()
        .fold(0.0, |most: f64, pole| most.max(pole.norm()));
    let said = format!(
        "The model file holds Table 1 to every digit. With each centre of mass off by 0.5 mm either way the sampled loop's spectral radius \
         goes from {nominal:.4} to {worst:.4} at worst: {}.",
        if worst < 1.0 {
            "it stays stable"
        } else {
            "it is lost"
        }
    );
    Ok((
        said,
        Shown::Here(if worst < 1.0 { Holds::Yes } else { Holds::No }),
    ))
}

fn zeros(computed: &Computed) -> (String, Shown) {
    let unstable = computed.poles.iter().filter(|pole| pole.re > 0.0).count();
    let right: Vec<String> = computed
        .zeros
        .iter()
        .filter(|zeros| zeros.squared > 0.0)
        .map(|zeros| {
            let [a, b] = zeros.outputs;
            format!("+{} 1/s to (q{a}, q{b})", short(zeros.squared.sqrt()))
        })
        .collect();
    let said = format!(
        "{unstable} of 6 poles are unstable, and from the torques there are zeros in the right half plane at {}: \
         non-minimum phase. The equations of any n agree with Lagrange's by finite differences and keep energy (tests).",
        right.join(", ")
    );
    let holds = unstable == 3 && !right.is_empty();
    (
        said,
        Shown::Here(if holds { Holds::Yes } else { Holds::No }),
    )
}
