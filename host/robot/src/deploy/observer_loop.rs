//! The linear loop of the observer-based law: its margins, and how far a lasting torque leans it.
//!
//! The observer's offsets are integral action. They are estimates of the angles of balance, which
//! nothing moves but what was not predicted, so that a lasting torque ends in them: at rest the
//! robot stands where gravity balances it, and the drives bear nothing. (Franklin, Powell, Workman,
//! Digital Control of Dynamic Systems, 3rd ed., section 8.5.)

use super::{PlanBasis, observer_known};
use crate::error::Result;
use crate::model::Model;
use crate::synth::controllers::{OnBoard, board_plant};
use crate::synth::{Continuous, Discrete, Margins, OpenLoop, torque_inputs, upright};
use handstand_shared::observer::{ESTIMATED, INPUTS, JOINTS, PAST, READINGS, SEEN, STATE};
use nalgebra::{DMatrix, stack};

/// What is said of the observer's loop without simulating it.
#[derive(Debug, Clone, PartialEq)]
pub struct ObserverLoop {
    /// At the inputs; none of a loop that is not stable.
    pub margins: Option<Margins>,
    /// Departure of each joint (rows) per lasting torque at each joint (columns), rad/N m; none
    /// where no rest is determined.
    pub lean_per_torque: Option<DMatrix<f64>>,
}

/// The machine as a controller z(k+1) = A z + B y, u = C z + D y of its readings y.
struct Machine {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

/// The loop of the observer-based law with the board's timing; in floating point, its limits and
/// compensation of the drives left out.
///
/// # Errors
/// A model that cannot be balanced.
pub fn observer_loop(model: &Model, basis: &PlanBasis) -> Result<ObserverLoop> {
    let known = observer_known(model, &basis.board)?;
    let plant = board_plant(&known, &basis.timing)?;
    let machine = Machine::of(&OnBoard::new(&known, &basis.timing)?);
    let margins = machine.open_loop(&plant).margins()?;
    let torque = torque_inputs(model, &upright(model))?;
    Ok(ObserverLoop {
        lean_per_torque: match margins {
            Some(_) => machine.rest(&known.plant, &torque),
            None => None,
        },
        margins,
    })
}

impl Machine {
    fn of(on_board: &OnBoard) -> Machine {
        let (predict, feedback, update) = (&on_board.predict, &on_board.feedback, &on_board.update);
        let (by_state, d) = (
            feedback.columns(0, STATE),
            feedback.columns(STATE, READINGS),
        );
        let c = by_state - d * predict;
        // What it estimates, and the past inputs that it keeps.
        let by_readings = update.columns(STATE, READINGS);
        let mut a =
            (update.columns(0, STATE) - by_readings * predict).resize_vertically(STATE, 0.0);
        a.view_mut(
            (ESTIMATED + INPUTS, ESTIMATED),
            (PAST - INPUTS, PAST - INPUTS),
        )
        .fill_with_identity();
        let mut by_inputs = update.columns(SEEN, INPUTS).into_owned();
        by_inputs = by_inputs.resize_vertically(STATE, 0.0);
        by_inputs
            .view_mut((ESTIMATED, 0), (INPUTS, INPUTS))
            .fill_with_identity();
        let b = by_readings.into_owned().resize_vertically(STATE, 0.0);
        Machine {
            a: a + &by_inputs * &c,
            b: b + &by_inputs * d,
            c,
            d: d.into_owned(),
        }
    }

    /// The loop broken at the inputs.
    fn open_loop(&self, plant: &Discrete) -> OpenLoop {
        let states = plant.b.nrows();
        let none = DMatrix::zeros(states, STATE);
        OpenLoop {
            a: stack![&plant.a, none; &self.b * &plant.c, &self.a],
            b: plant.b.clone().insert_rows(states, STATE, 0.0),
            c: -stack![&self.d * &plant.c, &self.c],
            ts_s: Some(plant.ts_s),
        }
    }

    /// Where plant and machine rest under torques that last: 0 = A x + B u + `torque` d, z = A z +
    /// B y, u = C z + D y. At rest the readings are the angles and no rate, whatever their age.
    fn rest(&self, plant: &Continuous, torque: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut read = DMatrix::zeros(READINGS, 2 * JOINTS);
        read.view_mut((0, 0), (READINGS, READINGS))
            .fill_with_identity();
        let still = DMatrix::identity(STATE, STATE);
        let none = DMatrix::zeros(2 * JOINTS, STATE);
        let rest = stack![
            &plant.a, &plant.b, none;
            -(&self.b * &read), DMatrix::zeros(STATE, INPUTS), still - &self.a;
            -(&self.d * &read), DMatrix::identity(INPUTS, INPUTS), -&self.c
        ];
        let push = -torque.clone().resize_vertically(rest.nrows(), 0.0);
        Some(rest.lu().solve(&push)?.rows(0, JOINTS).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deploy::{Board, ToldDrives};
    use crate::synth::controllers::BoardTiming;
    use crate::synth::zoh;
    use handstand_shared::observer::WIDTH;
    use nalgebra::DVector;

    fn basis(model: &Model) -> PlanBasis {
        let timing = BoardTiming::HOST_ATTITUDE;
        PlanBasis::of(model, &Board::BIOLOID, &timing, &ToldDrives::default()).unwrap()
    }

    fn robot() -> Model {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/handstand.toml");
        Model::load(file.as_ref()).unwrap()
    }

    /// The machine itself, sample by sample, with the sampled plant: it rests where the closed form
    /// says, which is where gravity balances the robot, and its drives bear nothing.
    #[test]
    fn a_lasting_torque_leaves_no_lean_but_gravity_s_own() {
        let model = robot();
        let basis = basis(&model);
        let found = observer_loop(&model, &basis).unwrap();
        let lean = found.lean_per_torque.unwrap();
        let known = observer_known(&model, &basis.board).unwrap();
        let machine = OnBoard::new(&known, &basis.timing).unwrap();
        let plant = board_plant(&known, &basis.timing).unwrap();
        let torque = torque_inputs(&model, &upright(&model)).unwrap();
        // Gravity's stiffness alone: 0 = A x + torque d.
        let falls = known.plant.a.view((JOINTS, 0), (JOINTS, JOINTS));
        let acts = torque.rows(JOINTS, JOINTS);
        let gravity = -falls.into_owned().lu().solve(&acts.into_owned()).unwrap();
        assert!((&lean - &gravity).amax() < 1e-6, "{lean} {gravity}");
        for joint in 0..JOINTS {
            let push = Continuous {
                b: torque.columns(joint, 1).into_owned(),
                ..known.plant.clone()
            };
            // What the torque did to the state since a reading was taken: e^{-Ah} S(h) B.
            let since: [f64; READINGS] = std::array::from_fn(|reading| {
                let held = zoh(&push, basis.timing.age_s[reading], 0.0).unwrap();
                1e-3 * held.a.lu().solve(&held.b).unwrap()[reading]
            });
            let push = zoh(&push, basis.board.period_s, 0.0).unwrap().b * 1e-3;
            let mut x = DVector::zeros(plant.a.nrows());
            let (mut memory, mut last) = ([0.0; WIDTH], [0.0; INPUTS]);
            for _ in 0..8000 {
                let y = &plant.c * &x;
                let y = std::array::from_fn(|i| y[i] - since[i]);
                last = machine.raw_command(&mut memory, &y);
                machine.update(&mut memory, last);
                x = &plant.a * x + &plant.b * DVector::from_column_slice(&last);
                for row in 0..2 * JOINTS {
                    x[row] += push[row];
                }
            }
            let expected = 1e-3 * gravity.column(joint);
            let off = (x.rows(0, JOINTS) - &expected).amax();
            assert!(off < 1e-3 * expected.amax(), "{joint}: {x} {expected}");
            assert!(last.iter().all(|nm| nm.abs() < 1e-6), "{joint}: {last:?}");
        }
    }

    /// Just within the common gain margin the loop of plant and machine stays, just beyond it
    /// grows: run sample by sample.
    #[test]
    fn the_gain_margin_is_that_of_the_machine_that_runs() {
        let model = robot();
        let basis = basis(&model);
        let margins = observer_loop(&model, &basis).unwrap().margins.unwrap();
        let known = observer_known(&model, &basis.board).unwrap();
        let machine = OnBoard::new(&known, &basis.timing).unwrap();
        let plant = board_plant(&known, &basis.timing).unwrap();
        let size_after = |gain: f64| {
            let mut x = DVector::from_element(plant.a.nrows(), 0.0);
            x[0] = 1e-3;
            let mut memory = [0.0; WIDTH];
            for _ in 0..20_000 {
                let y = &plant.c * &x;
                let u = machine.raw_command(&mut memory, &[y[0], y[1], y[2], y[3]]);
                machine.update(&mut memory, u);
                x = &plant.a * x + &plant.b * DVector::from_column_slice(&u) * gain;
                if x.amax() > 1e9 {
                    break;
                }
            }
            x.amax()
        };
        let [low, high] = margins.common.gain;
        assert!(low > 0.0 && high.is_finite());
        for (within, beyond) in [(1.02 * low, 0.98 * low), (0.98 * high, 1.02 * high)] {
            let (stays, grows) = (size_after(within), size_after(beyond));
            assert!(
                stays < 1e-3 && grows > 100.0 * stays,
                "{within} {stays} {beyond} {grows}"
            );
        }
    }
}
