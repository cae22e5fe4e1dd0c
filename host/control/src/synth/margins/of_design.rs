//! The margins of a design: its loop broken at the inputs and, with a filter, at the sensors.

use super::response::{Grid, Matrix, largest_singular_value};
use super::{Margins, OpenLoop};
use crate::model::{Drive, Model};
use crate::synth::eigen::{largest, poles};
use crate::synth::error::DesignError;
use crate::synth::{Continuous, Design, Discrete, zoh};
use nalgebra::DMatrix;

/// Supply that a drive of a planar chain without a nominal one is taken to have, V: that of the
/// paper's servos.
const SUPPLY_V: f64 = 9.8;

/// First step in the search for the longest delay and its end, in samples, and how much longer each
/// step is.
const DELAY_STEPS: (f64, f64, f64) = (0.02, 1.06, 20.0);

/// Halvings of the interval in which a delay is lost.
const HALVINGS: usize = 40;

/// A range of supplies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupplyRange {
    /// The nominal one, V.
    pub nominal_v: f64,
    /// Lowest at which the linear loop is stable, V.
    pub lowest_v: f64,
    /// Highest, V; infinite where nothing bounds it.
    pub highest_v: f64,
}

/// The margins of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignMargins {
    /// At the inputs. Delays of a sampled loop are exact: the held input arrives late. The law
    /// knows of no change; its past inputs are those that it asked for.
    pub inputs: Margins,
    /// At the sensors, of a design with a filter.
    pub sensors: Option<Margins>,
    /// The common gain as supply, where torque follows the supply.
    pub supply: Option<SupplyRange>,
}

/// A controller z(k+1) = A z + B y, u = C z + D y of a plant's outputs y = `outputs` x.
struct Controller {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
    outputs: DMatrix<f64>,
}

/// The margins of `design` for `model`; none of a loop that is not stable.
///
/// # Errors
/// Entries that are no numbers.
pub fn design_margins(
    model: &Model,
    design: &Design,
) -> Result<Option<DesignMargins>, DesignError> {
    let Some((plant, delay_s)) = &design.sampled else {
        let inputs = open_at_inputs(design).margins()?;
        return Ok(inputs.map(|inputs| DesignMargins {
            supply: supply(model, inputs.common.gain),
            inputs,
            sensors: None,
        }));
    };
    let controller = Controller::of_design(design, plant);
    let Some(mut inputs) = controller.at_inputs(plant).margins()? else {
        return Ok(None);
    };
    let channels = inputs.single.len();
    let late = |which: &[usize]| controller.longest_delay(design, plant, *delay_s, which);
    let all: Vec<usize> = (0..channels).collect();
    inputs.common.delay_s = late(&all)?;
    for (channel, single) in inputs.single.iter_mut().enumerate() {
        single.delay_s = late(&[channel])?;
    }
    let sensors = match design.estimator {
        Some(_) => controller.at_outputs(plant).margins()?,
        None => None,
    };
    Ok(Some(DesignMargins {
        supply: supply(model, inputs.common.gain),
        inputs,
        sensors,
    }))
}

/// The largest singular values of a loop at a frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingularValues {
    /// Frequency, rad/s.
    pub frequency_rad_s: f64,
    /// Of S = (I + L)^-1.
    pub sensitivity: f64,
    /// Of T = L (I + L)^-1.
    pub complementary: f64,
}

/// S and T of a design's loop, broken at the inputs, over frequency; none of a loop that is not
/// stable.
///
/// # Errors
/// Entries that are no numbers.
pub fn singular_values(design: &Design) -> Result<Option<Vec<SingularValues>>, DesignError> {
    let open = open_at_inputs(design);
    if !open.is_stable(1.0)? {
        return Ok(None);
    }
    let grid = Grid::of(&open)?;
    let of = |(frequency, s): &(f64, Matrix)| {
        let identity = Matrix::identity(s.nrows(), s.ncols());
        SingularValues {
            frequency_rad_s: grid.rad_s(*frequency),
            sensitivity: largest_singular_value(s),
            complementary: largest_singular_value(&(identity - s)),
        }
    };
    let mut values: Vec<SingularValues> = grid.points.iter().map(of).collect();
    values.sort_by(|a, b| a.frequency_rad_s.total_cmp(&b.frequency_rad_s));
    Ok(Some(values))
}

/// The loop of a design, broken at the inputs.
fn open_at_inputs(design: &Design) -> OpenLoop {
    match &design.sampled {
        Some((plant, _)) => Controller::of_design(design, plant).at_inputs(plant),
        None => OpenLoop {
            a: design.plant.a.clone(),
            b: design.plant.b.clone(),
            c: design.gains.k.clone(),
            ts_s: None,
        },
    }
}

/// The common gain as supply, where every input is a torque or a duty of one nominal supply.
fn supply(model: &Model, gain: [f64; 2]) -> Option<SupplyRange> {
    let usual_v = (!model.is_in_space()).then_some(SUPPLY_V);
    let mut nominal_v = None;
    for joint in model.driven_joints() {
        let joint = &model.joints[joint];
        let own_v = match &joint.drive {
            Drive::Torque if joint.slide.is_none() => usual_v?,
            Drive::Duty(motor) => motor.nominal_supply_v.or(usual_v)?,
            _ => return None,
        };
        if *nominal_v.get_or_insert(own_v) != own_v {
            return None;
        }
    }
    nominal_v.map(|nominal_v| SupplyRange {
        nominal_v,
        lowest_v: gain[0] * nominal_v,
        highest_v: gain[1] * nominal_v,
    })
}

/// Blocks side by side and below one another; any may be empty.
fn blocks(rows: &[&[&DMatrix<f64>]]) -> DMatrix<f64> {
    let height = rows.iter().map(|row| row[0].nrows()).sum();
    let width = rows[0].iter().map(|block| block.ncols()).sum();
    let mut all = DMatrix::zeros(height, width);
    let mut top = 0;
    for row in rows {
        let mut left = 0;
        for block in *row {
            all.view_mut((top, left), block.shape()).copy_from(*block);
            left += block.ncols();
        }
        top += row[0].nrows();
    }
    all
}

impl Controller {
    /// Gains and filter, or gains on the plant's states.
    fn of_design(design: &Design, plant: &Discrete) -> Controller {
        match &design.estimator {
            Some(estimation) => {
                let compensator = &estimation.compensator;
                Controller {
                    a: compensator.a.clone(),
                    b: compensator.b.clone(),
                    c: compensator.c.clone(),
                    d: compensator.d.clone(),
                    outputs: estimation.plant.c.columns(0, plant.plant_states()).into(),
                }
            }
            None => Controller::of_states(plant, &design.gains.k),
        }
    }

    /// u = -K [x; past u]: its states are the inputs that it asked for.
    fn of_states(plant: &Discrete, k: &DMatrix<f64>) -> Controller {
        let (all, own) = (plant.a.nrows(), plant.plant_states());
        let past = all - own;
        let shift = plant.a.view((own, own), (past, past));
        let enter = plant.b.rows(own, past);
        let (of_states, of_past) = (k.columns(0, own), k.columns(own, past));
        Controller {
            a: shift - enter * of_past,
            b: -(enter * of_states),
            c: -of_past.into_owned(),
            d: -of_states.into_owned(),
            outputs: DMatrix::identity(own, own),
        }
    }

    /// y of a plant with any number of past inputs.
    fn outputs(&self, plant_states: usize) -> DMatrix<f64> {
        self.outputs.clone().resize_horizontally(plant_states, 0.0)
    }

    fn at_inputs(&self, plant: &Discrete) -> OpenLoop {
        let (own, states) = (self.a.nrows(), plant.a.nrows());
        let outputs = self.outputs(states);
        let channels = plant.b.ncols();
        OpenLoop {
            a: blocks(&[
                &[&plant.a, &DMatrix::zeros(states, own)],
                &[&(&self.b * &outputs), &self.a],
            ]),
            b: blocks(&[&[&plant.b], &[&DMatrix::zeros(own, channels)]]),
            c: blocks(&[&[&-(&self.d * &outputs), &-&self.c]]),
            ts_s: Some(plant.ts_s),
        }
    }

    fn at_outputs(&self, plant: &Discrete) -> OpenLoop {
        let (own, states) = (self.a.nrows(), plant.a.nrows());
        let outputs = self.outputs(states);
        OpenLoop {
            a: blocks(&[
                &[&self.a, &DMatrix::zeros(own, states)],
                &[&(&plant.b * &self.c), &plant.a],
            ]),
            b: blocks(&[&[&self.b], &[&(&plant.b * &self.d)]]),
            c: blocks(&[&[&DMatrix::zeros(outputs.nrows(), own), &-outputs]]),
            ts_s: Some(plant.ts_s),
        }
    }

    /// The longest delay beyond the design's that the inputs `late` bear; none up to 20 samples.
    fn longest_delay(
        &self,
        design: &Design,
        sampled: &Discrete,
        delay_s: f64,
        late: &[usize],
    ) -> Result<Option<f64>, DesignError> {
        let ts_s = sampled.ts_s;
        let is_stable = |more_s: f64| -> Result<bool, DesignError> {
            let mut plant = late_inputs(&design.plant, ts_s, delay_s, more_s, late)?;
            if let Some(integral) = &design.integral {
                plant = integral.with_sums(&plant);
            }
            Ok(largest(&poles(&self.at_inputs(&plant).closed(1.0))?) < 1.0)
        };
        let (mut step, longer, last) = DELAY_STEPS;
        let mut good = 0.0;
        while good < last {
            let mut bad = good + step;
            if is_stable(bad * ts_s)? {
                good = bad;
                step *= longer;
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(good, bad);
                if is_stable(middle * ts_s)? {
                    good = middle;
                } else {
                    bad = middle;
                }
            }
            return Ok(Some(good * ts_s));
        }
        Ok(None)
    }
}

/// The plant sampled with its inputs `delay_s` late, those in `late` by `more_s` more.
fn late_inputs(
    plant: &Continuous,
    ts_s: f64,
    delay_s: f64,
    more_s: f64,
    late: &[usize],
) -> Result<Discrete, DesignError> {
    let longest = zoh(plant, ts_s, delay_s + more_s)?;
    let usual = zoh(plant, ts_s, delay_s)?;
    let (own, channels) = plant.b.shape();
    let mut mixed = longest.clone();
    for channel in (0..channels).filter(|channel| !late.contains(channel)) {
        // How this input acts, now and after each number of samples.
        let now = usual.b.view((0, channel), (own, 1));
        mixed.b.view_mut((0, channel), (own, 1)).copy_from(&now);
        for past in 0..longest.delayed_inputs {
            let column = own + past * channels + channel;
            let acts = if past < usual.delayed_inputs {
                usual.a.view((0, column), (own, 1)).into_owned()
            } else {
                DMatrix::zeros(own, 1)
            };
            mixed.a.view_mut((0, column), (own, 1)).copy_from(&acts);
        }
    }
    Ok(mixed)
}
