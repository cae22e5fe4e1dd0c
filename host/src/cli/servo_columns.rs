//! Which columns of a log are a servo's input and output: by a model file, or by flags; never
//! guessed.

use handstand::model::{Column, ColumnMean, Dimension, JointColumns, LogColumns, Unit};
use handstand::sysid::OutputQuantity;
use handstand::{Error, Model, Result};
use std::path::PathBuf;

/// Flags that say where input and output are.
#[derive(Debug, clap::Args)]
pub struct ServoColumns {
    /// Model file whose [log] names the columns
    #[arg(long, value_name = "MODEL.toml")]
    #[arg(conflicts_with_all = ["time", "input", "output", "supply"])]
    model: Option<PathBuf>,
    /// Joint of the model, counted from 1; the driven one without it
    #[arg(long, value_name = "N", requires = "model")]
    joint: Option<usize>,
    /// Column of the time, without a model file
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = time)]
    time: Option<Column>,
    /// Column of the command, such as `goal=rad/s`
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = column)]
    input: Option<Column>,
    /// Column of the measured output, such as `angle=deg` or `position=ticks/1228.8`
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = column)]
    output: Option<Column>,
    /// Column of the supply voltage
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = voltage)]
    supply: Option<Column>,
    /// Take a measured angle as the output, not the speed estimated from it
    #[arg(long)]
    as_measured: bool,
}

/// Where input and output are.
#[derive(Debug)]
pub struct ChosenColumns {
    /// Columns to read.
    pub columns: LogColumns,
    /// Joint counted from 0.
    pub joint: usize,
    /// What of the measured column is the output.
    pub output: OutputQuantity,
    /// SI unit of the input.
    pub input_unit: &'static str,
    /// SI unit of the output.
    pub output_unit: &'static str,
}

impl ServoColumns {
    /// What the flags say.
    ///
    /// # Errors
    /// Neither a model nor all of `--time --input --output`; a joint that does not exist or that
    /// nothing drives.
    pub fn chosen(&self) -> Result<ChosenColumns> {
        let (columns, joint) = match &self.model {
            Some(file) => {
                let model = Model::load(file)?;
                model.hinges_only("a servo's columns are angles")?;
                let joint = self.driven(&model)?;
                (model.log, joint)
            }
            None => (self.declared()?, 0),
        };
        let own = &columns.joints[joint];
        let Some(position) = &own.position else {
            return Err(Error::usage(
                format!("the log holds no angle of joint {}", joint + 1),
                "name its column under [[log.joint]], or another joint",
            ));
        };
        let measured = position.dimension();
        let output = match measured {
            Dimension::Angle if !self.as_measured => OutputQuantity::Velocity,
            _ => OutputQuantity::AsMeasured,
        };
        let input = own.input.as_ref().map(ColumnMean::dimension);
        Ok(ChosenColumns {
            input_unit: input.map_or("1", si),
            output_unit: match output {
                OutputQuantity::Velocity => "rad/s",
                OutputQuantity::AsMeasured => si(measured),
            },
            joint,
            output,
            columns,
        })
    }

    fn driven(&self, model: &Model) -> Result<usize> {
        let driven = model.driven_joints();
        let names: Vec<String> = driven.iter().map(|joint| (joint + 1).to_string()).collect();
        let remedy = match names.as_slice() {
            [] => "a model without a drive has no servo to identify".to_string(),
            names => format!("give --joint {}", names.join(" or ")),
        };
        match (self.joint, driven.as_slice()) {
            (None, [joint]) => Ok(*joint),
            (None, _) => Err(Error::usage(
                format!("{} has {} driven joints", model.name, driven.len()),
                remedy,
            )),
            (Some(joint), driven) => match joint.checked_sub(1) {
                Some(index) if driven.contains(&index) => Ok(index),
                _ => Err(Error::usage(
                    format!("nothing drives joint {joint} of {}", model.name),
                    remedy,
                )),
            },
        }
    }

    fn declared(&self) -> Result<LogColumns> {
        let (Some(time), Some(input), Some(output)) = (&self.time, &self.input, &self.output)
        else {
            return Err(Error::usage(
                "the log's columns are not declared",
                "give --model MODEL.toml, or all of --time, --input and --output, such as --time \
                 t=s --input goal=rad/s --output angle=deg",
            ));
        };
        Ok(LogColumns {
            time: time.clone(),
            segment: None,
            supply: self.supply.clone(),
            torque_on: None,
            payload: None,
            payload_at_m: 0.0,
            payload_on: None,
            turned: None,
            joints: vec![JointColumns {
                position: Some(output.clone().into()),
                velocity: None,
                input: Some(input.clone().into()),
                ..JointColumns::default()
            }],
            arm: None,
            split_at_gap_s: None,
        })
    }
}

/// Name of the SI unit, which stands first among those that measure the same.
fn si(dimension: Dimension) -> &'static str {
    dimension.unit_names().next().unwrap_or("1")
}

/// `COLUMN=UNIT`, with `ticks/TURN` for counts.
fn column(text: &str) -> Result<Column, String> {
    let wrong = || "write COLUMN=UNIT, such as angle=deg or position=ticks/1228.8".to_string();
    let (name, unit) = text.rsplit_once('=').ok_or_else(wrong)?;
    let (unit, ticks) = match unit.split_once('/') {
        Some(("ticks", turn)) => {
            let turn: f64 = turn.parse().map_err(|_| wrong())?;
            if !(turn >= 1.0 && turn.is_finite()) {
                return Err(format!("{turn} counts per turn make no angle"));
            }
            ("ticks", Some(turn))
        }
        _ => (unit, None),
    };
    match Unit::named(unit, ticks) {
        Some(unit) if unit.si.is_finite() && !name.is_empty() => Ok(Column {
            name: name.to_string(),
            unit,
            offset: 0.0,
            reversed: false,
            resolution: (unit.name == "ticks").then_some(unit.si),
            shift_s: 0.0,
        }),
        Some(unit) if !name.is_empty() && unit.name == "ticks" => {
            Err("say how many make a turn: ticks/1228.8".to_string())
        }
        _ => Err(format!(
            "{}; units are those of a model file's [log]: rad deg turn rad/s deg/s rpm, N m, V, 1, \
             % and so on",
            wrong()
        )),
    }
}

fn of_dimension(text: &str, dimension: Dimension) -> Result<Column, String> {
    let column = column(text)?;
    if column.unit.dimension == dimension {
        Ok(column)
    } else {
        Err(format!(
            "'{}' is no unit here; write one of {}",
            column.unit.name,
            dimension.unit_names().collect::<Vec<_>>().join(", ")
        ))
    }
}

fn time(text: &str) -> Result<Column, String> {
    of_dimension(text, Dimension::Time)
}

fn voltage(text: &str) -> Result<Column, String> {
    of_dimension(text, Dimension::Voltage)
}
