//! A study as a file says it, or the paper's robot.

use super::case::{Case, Design};
use super::judge::Judging;
use super::uncertain::{Distribution, Place, QUANTITIES, Uncertain};
use crate::closed_loop::{Conditions, Gyro, Velocity};
use crate::error::{Error, Result, words};
use crate::model::Limits;
use crate::model::Model;
use crate::model::reader::Table;
use crate::model::source::TomlSource;
use crate::model::suggest::suggest;
use sha2::{Digest as _, Sha256};
use std::path::Path;

/// What is studied.
#[derive(Debug, Clone)]
pub struct Study {
    /// Robot, circumstances and design.
    pub case: Case,
    /// How it is judged.
    pub judging: Judging,
    /// What is drawn for every run of a Monte Carlo study.
    pub uncertain: Vec<Uncertain>,
}

const HANDSTAND: &str = include_str!("../../models/handstand.toml");

impl Study {
    /// The paper's robot with its regulator (Q = 100 I, R = I, 10 ms) under ideal circumstances: 200 runs of 5 s from
    /// starts within 1 deg.
    ///
    /// # Errors
    /// None that are not bugs.
    pub fn paper() -> Result<Study> {
        let model = Model::parse(HANDSTAND, Path::new("handstand.toml"))?;
        Ok(Study::of(model))
    }

    /// The same for another robot.
    pub fn of(model: Model) -> Study {
        Study {
            case: Case {
                disturbance_nm: vec![0.0; model.link_count()],
                nominal: model.clone(),
                robot: model,
                conditions: Conditions::ideal(0.01),
                design: Design {
                    q: 100.0,
                    r: 1.0,
                    delay_periods: 0.0,
                    word_bits: 0,
                },
                compensated: false,
            },
            judging: Judging {
                runs: 200,
                start_rad: 1f64.to_radians(),
                seconds: 5.0,
                fall_rad: 45f64.to_radians(),
                seed: 1,
            },
            uncertain: Vec::new(),
        }
    }

    /// Reads a study's file; a model that it names is beside it.
    ///
    /// # Errors
    /// As [`Model::load`], for both files.
    pub fn load(path: &Path) -> Result<Study> {
        let text =
            std::fs::read_to_string(path).map_err(|error| Error::file(path, "read", error))?;
        let source = TomlSource {
            text: &text,
            file: path,
        };
        let document = source.document()?;
        let root = Table::root(&source, &document);
        root.only(&["robot", "design", "conditions", "runs", "uncertain"])?;
        let robot = root.table("robot")?;
        let mut study = match robot
            .as_ref()
            .map(|robot| robot.text("model"))
            .transpose()?
        {
            Some(Some(name)) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                Study::of(Model::load(&folder.join(name))?)
            }
            _ => Study::paper()?,
        };
        if let Some(robot) = robot {
            robot.only(&["model", "compensated"])?;
            study.case.compensated = robot.flag("compensated")?;
        }
        if let Some(table) = root.table("design")? {
            design(&table, &mut study.case)?;
        }
        if let Some(table) = root.table("conditions")? {
            conditions(&table, &mut study.case.conditions)?;
        }
        if let Some(table) = root.table("runs")? {
            runs(&table, &mut study.judging)?;
        }
        for table in root.tables("uncertain")? {
            uncertain(&table, study.case.robot.link_count(), &mut study.uncertain)?;
        }
        Ok(study)
    }

    /// SHA-256 of all that decides a run, in hexadecimal.
    pub fn fingerprint(&self) -> String {
        let drawn: Vec<_> = self
            .uncertain
            .iter()
            .map(|u| (u.column(), u.distribution, u.size))
            .collect();
        let said = format!(
            "{} {:?} {:?} {:?}",
            env!("CARGO_PKG_VERSION"),
            self.case,
            self.judging,
            drawn
        );
        super::journal::hex(Sha256::digest(said.as_bytes()).as_slice())
    }
}

const POSITIVE: Limits = Limits::above(0.0, f64::INFINITY);
const NOT_NEGATIVE: Limits = Limits::within(0.0, f64::INFINITY);

/// Puts the number under `key` into its place, if there is one.
fn set(table: &Table<'_>, key: &str, limits: Limits, place: &mut f64) -> Result<()> {
    if let Some(number) = table.number(key, limits)? {
        *place = number;
    }
    Ok(())
}

fn design(table: &Table<'_>, case: &mut Case) -> Result<()> {
    table.only(&["q", "r", "delay_periods", "word_bits", "period_s"])?;
    let design = &mut case.design;
    set(table, "q", NOT_NEGATIVE, &mut design.q)?;
    set(table, "r", POSITIVE, &mut design.r)?;
    set(
        table,
        "delay_periods",
        Limits::within(0.0, 20.0),
        &mut design.delay_periods,
    )?;
    if let Some(bits) = table.whole("word_bits", Limits::within(8.0, 32.0))? {
        design.word_bits = bits as u32;
    }
    let period_s = &mut case.conditions.clock.period_s;
    set(table, "period_s", Limits::within(1e-4, 1.0), period_s)
}

fn conditions(table: &Table<'_>, conditions: &mut Conditions) -> Result<()> {
    table.only(&[
        "base",
        "position_resolution_rad",
        "position_noise_rad",
        "velocity",
        "gyro_resolution_rad_s",
        "gyro_noise_rad_s",
        "saturation_nm",
        "torque_resolution",
        "dead_zone",
        "supply",
        "delay_periods",
        "jitter",
        "loss",
    ])?;
    if table.choice("base", &[("ideal", false), ("measured", true)])? == Some(true) {
        *conditions = Conditions::measured(conditions.clock.period_s);
    }
    let Conditions {
        sensor,
        actuator,
        clock,
    } = conditions;
    let resolution = &mut sensor.position_resolution_rad;
    set(table, "position_resolution_rad", NOT_NEGATIVE, resolution)?;
    set(
        table,
        "position_noise_rad",
        NOT_NEGATIVE,
        &mut sensor.position_noise_rad,
    )?;
    let kinds = [
        ("direct", Velocity::Direct),
        ("difference", Velocity::Difference),
    ];
    if let Some(velocity) = table.choice("velocity", &kinds)? {
        sensor.velocity = velocity;
    }
    if table.has("gyro_resolution_rad_s") || table.has("gyro_noise_rad_s") {
        let mut gyro = sensor.gyro.unwrap_or(Gyro {
            resolution_rad_s: 0.0,
            noise_rad_s: 0.0,
        });
        let resolution = &mut gyro.resolution_rad_s;
        set(table, "gyro_resolution_rad_s", NOT_NEGATIVE, resolution)?;
        set(
            table,
            "gyro_noise_rad_s",
            NOT_NEGATIVE,
            &mut gyro.noise_rad_s,
        )?;
        sensor.gyro = Some(gyro);
    }
    if let Some(limit) = table.number("saturation_nm", POSITIVE)? {
        actuator.full_torque_nm = limit;
        actuator.saturates = true;
    }
    let share = Limits::within(0.0, 0.99);
    set(table, "torque_resolution", share, &mut actuator.resolution)?;
    set(table, "dead_zone", share, &mut actuator.dead_zone)?;
    set(
        table,
        "supply",
        Limits::above(0.0, 100.0),
        &mut actuator.supply,
    )?;
    let delay = &mut actuator.delay_periods;
    set(table, "delay_periods", Limits::within(0.0, 100.0), delay)?;
    set(
        table,
        "jitter",
        Limits::within(0.0, 0.45),
        &mut clock.jitter,
    )?;
    set(table, "loss", Limits::within(0.0, 1.0), &mut clock.loss)
}

fn runs(table: &Table<'_>, judging: &mut Judging) -> Result<()> {
    table.only(&["count", "length_s", "start_rad", "fall_rad", "seed"])?;
    if let Some(count) = table.whole("count", Limits::within(1.0, 1e12))? {
        judging.runs = count as usize;
    }
    set(
        table,
        "length_s",
        Limits::above(0.0, 1e4),
        &mut judging.seconds,
    )?;
    set(
        table,
        "start_rad",
        Limits::within(0.0, 3.0),
        &mut judging.start_rad,
    )?;
    set(
        table,
        "fall_rad",
        Limits::above(0.0, 1e3),
        &mut judging.fall_rad,
    )?;
    if let Some(seed) = table.whole("seed", Limits::within(0.0, 9e15))? {
        judging.seed = seed as u64;
    }
    Ok(())
}

fn uncertain(table: &Table<'_>, links: usize, all: &mut Vec<Uncertain>) -> Result<()> {
    table.only(&["what", "link", "distribution", "size"])?;
    let what = table.required_text("what")?;
    let Some(quantity) = QUANTITIES.iter().find(|quantity| quantity.id == what) else {
        let known: Vec<&str> = QUANTITIES.iter().map(|quantity| quantity.id).collect();
        let said = format!("nothing called `{what}` can be uncertain");
        return Err(table.bad("what", words(said, suggest(what, &known))));
    };
    let kinds = [
        ("uniform", Distribution::Uniform),
        ("normal", Distribution::Normal),
    ];
    let distribution = table
        .choice("distribution", &kinds)?
        .unwrap_or(Distribution::Uniform);
    let size = table.required_number("size", NOT_NEGATIVE)?;
    let chosen = table.index("link", links)?;
    let places = match (quantity.place, chosen) {
        (Place::Whole, None) => vec![None],
        (Place::Whole, Some(_)) => {
            let said = format!("`{what}` belongs to the whole robot");
            return Err(table.bad("link", words(said, "leave `link` out")));
        }
        (Place::Link, Some(link)) => vec![Some(link)],
        (Place::Link, None) => (0..links).map(Some).collect(),
    };
    for link in places {
        let new = Uncertain {
            quantity,
            link,
            distribution,
            size,
        };
        if all.iter().any(|other| other.column() == new.column()) {
            let said = format!("{} is drawn twice", new.column());
            return Err(table.bad("what", words(said, "say it once")));
        }
        all.push(new);
    }
    Ok(())
}
