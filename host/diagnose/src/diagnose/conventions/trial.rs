//! A correction tried: the error with it and without.

use super::correction::{Correction, LogColumn};
use super::plain_friction::left_by_friction;
use super::rating::{ModelReading, Rating};
use super::search::is_long;
use crate::diagnose::values::values_of;
use crate::effects::TORQUE_SCALE;
use crate::fitting::Candidate;
use crate::model::{Drive, Model, ParameterPath, Unit};
use crate::motion::Motion;
use rayon::prelude::*;

/// A correction with its proof: the errors before and after it, on the same windows.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The change.
    pub correction: Correction,
    /// Share of the motion that the model leaves unexplained as it is: 0 nothing, 1 as much as
    /// going on at constant speed does.
    pub before: f64,
    /// The same with the correction.
    pub after: f64,
    /// Root-mean-square error as it is, rad.
    pub before_rad: f64,
    /// The same with the correction, rad.
    pub after_rad: f64,
    /// Share of the windows that the correction makes better, of those it changes.
    pub better: f64,
    /// Where the correction calibrates one joint, it shows most in that joint, and all joints
    /// together do not suffer: the share of that joint's motion before and after, which the others'
    /// would drown.
    pub own: Option<[f64; 2]>,
}

impl Trial {
    /// Error after over error before: of the joint that it calibrates, if it does.
    pub fn ratio(&self) -> f64 {
        let [before, after] = self.own.unwrap_or([self.before, self.after]);
        after / before.max(1e-12)
    }

    fn new(correction: Correction, before: &Rating, after: &Rating) -> Option<Trial> {
        let shares = [before.share()?, after.share()?];
        let ratio = |[before, after]: [f64; 2]| after / before.max(1e-12);
        let calibrated = correction.calibrates().filter(|_| shares[1] <= shares[0]);
        let own = calibrated.and_then(|joint| {
            let own = [before.share_of(joint)?, after.share_of(joint)?];
            (ratio(own) < ratio(shares)).then_some(own)
        });
        Some(Trial {
            before: shares[0],
            after: shares[1],
            before_rad: before.rms_rad,
            after_rad: after.rms_rad,
            better: better(before, after, calibrated.filter(|_| own.is_some())),
            own,
            correction,
        })
    }
}

/// Share of the windows that become better, of those that change; of one joint where one is named.
fn better(before: &Rating, after: &Rating, joint: Option<usize>) -> f64 {
    let square = |shares: &[Option<f64>]| {
        let own = shares
            .iter()
            .enumerate()
            .filter(|(signal, _)| joint.is_none_or(|j| j == *signal));
        own.filter_map(|(_, share)| share.map(|share| share * share))
            .sum::<f64>()
    };
    let (mut better, mut changed) = (0.0, 0.0);
    for (before, after) in before.shares.iter().zip(&after.shares) {
        let (before, after) = (square(before), square(after));
        if (before - after).abs() > 0.1 * before.max(after) {
            changed += 1.0;
            better += f64::from(after < before);
        }
    }
    better / f64::max(changed, 1.0)
}

/// What leaves so many times the error, on the windows of the model as it is, is not rated
/// on shorter ones: how errors grow in its reading takes most of a trial.
const FAR_WORSE: f64 = 5.0;

/// A value of the file may be wrong by this factor; a unit is wrong by more.
const PLAUSIBLE: f64 = 3.0;

/// The factor by which a correction multiplies a joint's torques, where that is all it does but for
/// the supply, and a stall torque may be off by as much; else none.
pub fn scales_torque_by(correction: &Correction, model: &Model) -> Option<f64> {
    let (joint, drive, unit) = match correction {
        Correction::Drive(joint, drive, unit) => (*joint, drive, unit),
        Correction::Unit(columns) => match columns.as_slice() {
            [(LogColumn::Input(joint), unit)] => (*joint, &model.joints[*joint].drive, unit),
            _ => return None,
        },
        _ => return None,
    };
    let column = LogColumn::Input(joint).column(model)?;
    let given = full_torque(&model.joints[joint].drive, &column.unit)?;
    let factor = full_torque(drive, unit)? / given;
    (1.0 / PLAUSIBLE..=PLAUSIBLE)
        .contains(&factor)
        .then_some(factor)
}

/// Torque of a written 1, N m; none where it also depends on speed or angle.
fn full_torque(drive: &Drive, unit: &Unit) -> Option<f64> {
    match drive {
        Drive::Torque => Some(unit.si),
        Drive::Duty(motor) if motor.no_load_speed_rad_s.is_infinite() => {
            Some(unit.si * motor.stall_torque_nm)
        }
        _ => None,
    }
}

/// Which values the trials fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Effort {
    /// None: start states as the samples suggest them.
    Guess,
    /// Start states.
    Starts,
    /// Start states and the model's free values.
    Values,
    /// The same until nothing more is gained.
    ValuesToTheEnd,
}

/// Tries corrections on a model and its motions.
pub(super) struct CorrectionTrial {
    pub model: Model,
    pub motions: Vec<Motion>,
    given: Option<ModelRating>,
}

/// The model as it reads its motions.
struct ModelRating {
    reading: ModelReading,
    /// From the start states that the samples suggest.
    rating: Rating,
}

impl CorrectionTrial {
    pub fn new(model: &Model, motions: Vec<Motion>) -> CorrectionTrial {
        let reading = ModelReading::new(model.clone(), motions.clone());
        let rating = reading.rated(Effort::Guess);
        CorrectionTrial {
            model: model.clone(),
            given: Some(ModelRating { reading, rating }),
            motions,
        }
    }

    /// For times so far apart that the model cannot be run over them for long: as it reads them,
    /// it is rated on the windows of the correction.
    pub fn of_doubtful_time(model: &Model, motions: Vec<Motion>) -> CorrectionTrial {
        CorrectionTrial {
            model: model.clone(),
            given: None,
            motions,
        }
    }

    /// The correction's effect, on windows in which start errors grow in neither reading.
    pub fn tried(&self, correction: Correction, effort: Effort) -> Option<Trial> {
        let motions = correction.reread(&self.model, &self.motions);
        let model = correction.applied(&self.model);
        let Some(ModelRating { reading, rating }) = &self.given else {
            let after = ModelReading::new(model, motions);
            let before = after.read_as(&self.model, self.motions.clone());
            return Trial::new(correction, &before.rated(effort), &after.rated(effort));
        };
        // A shift shortens the motions and leaves how errors grow in them; nothing else does.
        if matches!(correction, Correction::Shift(..)) {
            let shortened = self.shortened_as(reading, &motions);
            let after = reading.growing_like(model, motions);
            let [before, after] = rated_alike([&shortened, &after], effort);
            return Trial::new(correction, &before, &after);
        }
        if effort == Effort::Guess {
            let cut_as_given = reading.growing_like(model.clone(), motions.clone());
            let cut_as_given = cut_as_given.cut_as(&reading.data.windows).rated(effort);
            let trial = Trial::new(correction.clone(), rating, &cut_as_given);
            if is_long(&self.model) || trial.as_ref().is_some_and(|t| t.ratio() > FAR_WORSE) {
                return trial;
            }
        }
        let after = ModelReading::new(model, motions);
        let [before, after] = rated_alike([reading, &after], effort);
        Trial::new(correction, &before, &after)
    }

    /// Error with one value of the file, or the torques of a joint, off by what explains the
    /// motions best, at most [`PLAUSIBLE`] times, over the error without; none where no joint says
    /// anything, or times are in doubt.
    pub fn with_one_value_off(&self, joint: usize) -> Option<f64> {
        let reading = &self.given.as_ref()?.reading;
        let least = with_one_free(&self.model, joint).into_par_iter();
        let least = least.filter_map(|(model, path)| {
            let freed = reading.read_as(&model, self.motions.clone());
            let (rating, fitted) = freed.fitted(Effort::ValuesToTheEnd);
            let off = path.get(&fitted)? / path.get(&model)?;
            let is_plausible = (1.0 / PLAUSIBLE..=PLAUSIBLE).contains(&off);
            rating.share().filter(|_| is_plausible)
        });
        let before = reading.rated(Effort::ValuesToTheEnd).share()?;
        let least = least.min_by(f64::total_cmp)?;
        Some(least / before.max(1e-12))
    }

    /// Error with plain friction at a joint, or without its input, over the error without; none
    /// where no joint says anything, or times are in doubt.
    pub fn with_plain_friction(&self, joint: usize) -> Option<f64> {
        left_by_friction(&self.given.as_ref()?.reading, joint)
    }

    /// Error with a joint's torques multiplied by a factor over the error without, on windows as a
    /// correction has them.
    pub fn with_torques_scaled(&self, joint: usize, factor: f64) -> Option<f64> {
        let reading = &self.given.as_ref()?.reading;
        let mut scaled = self.model.clone();
        scaled.effects.push(torque_scale(joint).instance(&[factor]));
        let after = ModelReading::new(scaled, self.motions.clone());
        let [before, after] = rated_alike([reading, &after], Effort::Values);
        Some(after.share()? / before.share()?.max(1e-12))
    }

    /// The motions without the ends that others lack.
    fn shortened_as(&self, reading: &ModelReading, others: &[Motion]) -> ModelReading {
        let motions = self.motions.iter().zip(others);
        let motions = motions.map(|(motion, other)| {
            let first_s = other.time_s.first().copied().unwrap_or(f64::INFINITY);
            let begin = motion.time_s.partition_point(|t| *t < first_s);
            motion.part(begin..begin + other.len())
        });
        reading.growing_like(self.model.clone(), motions.collect())
    }

    /// Whether the column is there and not the same all the time.
    pub fn varies(&self, quantity: LogColumn) -> bool {
        let values = |motion: &Motion| -> Option<Vec<f64>> {
            match quantity {
                LogColumn::Time => Some(motion.time_s.clone()),
                LogColumn::Position(joint) => Some(motion.position_rad[joint].clone()),
                LogColumn::Velocity(joint) => motion.velocity_rad_s[joint].clone(),
                LogColumn::Rate(joint) => motion.rate(joint).map(<[f64]>::to_vec),
                LogColumn::Input(joint) => motion.input[joint].clone(),
            }
        };
        let varies = |values: Vec<f64>| values.windows(2).any(|pair| pair[0] != pair[1]);
        self.motions.iter().filter_map(values).any(varies)
    }
}

/// Both on the windows in which start errors grow in neither.
fn rated_alike(readings: [&ModelReading; 2], effort: Effort) -> [Rating; 2] {
    let windows = readings[0].common_windows(readings[1]);
    readings.map(|reading| reading.cut_as(&windows).rated(effort))
}

fn torque_scale(joint: usize) -> Candidate {
    Candidate {
        effect: TORQUE_SCALE,
        joint: Some(joint),
    }
}

/// The model with one more value free: each of its own, and a scale of the torques of a joint.
fn with_one_free(model: &Model, joint: usize) -> Vec<(Model, ParameterPath)> {
    let mut scaled = model.clone();
    let scale = torque_scale(joint);
    if !scale.in_model(model) {
        scaled.effects.push(scale.instance(&[1.0]));
    }
    let own = values_of(model).into_iter().map(|path| (model, path));
    let all = own.chain(scale.paths().map(|path| (&scaled, path)));
    let freed = all.map(|(model, path)| {
        let mut freed = model.clone();
        freed
            .free
            .extend((!model.free.contains(&path)).then_some(path));
        (freed, path)
    });
    freed.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::search::tests::arm;
    use crate::model::AngleZero;

    /// What trying the other angle zero says of an arm that lacks friction: the error as it is, and
    /// the one on the windows that suit both readings.
    fn upside_down(seed: u64) -> (Trial, f64, f64) {
        let (model, training, _) = arm(seed, &["viscous"]);
        let correction = Correction::AngleZero(match model.angle_zero {
            AngleZero::Upright => AngleZero::Hanging,
            _ => AngleZero::Upright,
        });
        let after = ModelReading::new(correction.applied(&model), training.clone());
        let trial = CorrectionTrial::new(&model, training);
        let given = trial.given.as_ref().unwrap();
        let [on_common, _] = rated_alike([&given.reading, &after], Effort::Guess);
        let (as_is, on_common) = (given.rating.share(), on_common.share());
        let tried = trial.tried(correction, Effort::Guess).unwrap();
        (tried, as_is.unwrap(), on_common.unwrap())
    }

    /// Upside down the arm falls: within its windows as they are that is seen at once.
    #[test]
    fn what_is_far_worse_is_not_rated_on_windows_of_its_own() {
        let (tried, as_is, on_common) = upside_down(1);
        assert!(tried.ratio() > FAR_WORSE, "{tried:?}");
        assert_ne!(as_is, on_common);
        assert_eq!(tried.before, as_is);
    }

    /// An arm that whirls where its model does not is lost either way.
    #[test]
    fn what_is_not_far_worse_is_rated_on_windows_that_suit_both() {
        let (tried, as_is, on_common) = upside_down(2);
        assert!(tried.ratio() < FAR_WORSE, "{tried:?}");
        assert_ne!(as_is, on_common);
        assert_eq!(tried.before, on_common);
    }
}
