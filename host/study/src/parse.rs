//! A study as a file says it, or the paper's robot.

mod conditions;
mod weight;

use super::case::Case;
use super::judge::Judging;
use super::quantities::QUANTITIES;
use super::quantity::{Distribution, SpreadOver, Uncertain, quantity};
use crate::error::{Error, Result};
use crate::model::Limits;
use crate::model::Model;
use crate::model::reader::Table;
use crate::model::source::TomlSource;
use crate::model::suggest::suggest;
use crate::output::number::hex;
use crate::synth::controllers::{self, DESIGNS};
use conditions::conditions;
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

/// The paper's robot: the model file with its Table 1.
///
/// # Errors
/// None is known: the file is the project's own.
pub fn handstand() -> Result<Model> {
    let text = include_str!("handstand.toml");
    Model::parse(text, Path::new("handstand.toml"))
}

impl Study {
    /// The paper's robot with its regulator (Q = 100 I, R = I, 10 ms) under ideal circumstances:
    /// 200 runs of 5 s from starts within 1 deg.
    ///
    /// # Errors
    /// None that are not bugs.
    pub fn paper() -> Result<Study> {
        Ok(Study::of(handstand()?))
    }

    /// The same for another robot.
    pub fn of(model: Model) -> Study {
        Study {
            case: Case::ideal(model, controllers::DEFAULT, 0.01),
            judging: Judging {
                runs: 200,
                start_rad: 1f64.to_radians(),
                seconds: 5.0,
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
                let model = Model::load(&folder.join(name))?;
                model.hinges_only("studies are of robots on hinges")?;
                model.planar_only("studies are of planar chains (`gains` takes both)")?;
                Study::of(model)
            }
            _ => Study::paper()?,
        };
        if let Some(robot) = robot {
            robot.only(&["model", "compensated"])?;
            study.case.control.known_equilibrium = robot.flag("compensated")?;
        }
        if let Some(table) = root.table("design")? {
            design(&table, &mut study.case)?;
        }
        if let Some(table) = root.table("conditions")? {
            study.uncertain = conditions(&table, &mut study.case)?;
        }
        if let Some(table) = root.table("runs")? {
            runs(&table, &mut study)?;
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
        hex(Sha256::digest(said))
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
    table.only(&[
        "controller",
        "q",
        "r",
        "delay_periods",
        "word_bits",
        "period_s",
    ])?;
    let ids: Vec<_> = DESIGNS.iter().map(|design| design.info().id).collect();
    let choices: Vec<_> = ids.iter().copied().zip(DESIGNS.iter().copied()).collect();
    let control = &mut case.control;
    if let Some(design) = table.choice("controller", &choices)? {
        control.design = design;
    }
    if let Some(q) = weight::weight(table, "q", NOT_NEGATIVE)? {
        control.q = q;
    }
    if let Some(r) = weight::weight(table, "r", POSITIVE)? {
        control.r = r;
    }
    let delay = &mut control.drives.delay_periods;
    set(table, "delay_periods", Limits::within(0.0, 20.0), delay)?;
    if let Some(bits) = table.whole("word_bits", Limits::within(8.0, 32.0))? {
        control.word_bits = bits as u32;
    }
    let period_s = &mut case.clock.period_s;
    set(table, "period_s", Limits::within(1e-4, 1.0), period_s)
}

fn runs(table: &Table<'_>, study: &mut Study) -> Result<()> {
    table.only(&["count", "length_s", "start_rad", "fall_rad", "seed"])?;
    let judging = &mut study.judging;
    if let Some(count) = table.whole("count", Limits::within(1.0, 1e9))? {
        judging.runs = count as usize;
    }
    let seconds = &mut judging.seconds;
    set(table, "length_s", Limits::above(0.0, 1e4), seconds)?;
    let start = &mut judging.start_rad;
    set(table, "start_rad", Limits::within(0.0, 3.0), start)?;
    let fall = &mut study.case.limits.fall_rad;
    set(table, "fall_rad", Limits::above(0.0, 1e3), fall)?;
    if let Some(seed) = table.whole("seed", Limits::within(0.0, 9e15))? {
        judging.seed = seed as u64;
    }
    Ok(())
}

fn uncertain(table: &Table<'_>, links: usize, all: &mut Vec<Uncertain>) -> Result<()> {
    table.only(&["what", "link", "distribution", "size"])?;
    let what = table.required_text("what")?;
    let named = quantity(what).and_then(|quantity| Some((quantity, quantity.spread.as_ref()?)));
    let Some((quantity, spread)) = named else {
        let uncertain = QUANTITIES
            .iter()
            .filter(|quantity| quantity.spread.is_some());
        let known: Vec<&str> = uncertain.map(|quantity| quantity.id).collect();
        let found = format!("nothing called `{what}` can be uncertain");
        return Err(table.bad("what", found, suggest(what, &known)));
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
    let places = match (spread.place, chosen) {
        (SpreadOver::Whole, None) => vec![None],
        (SpreadOver::Whole, Some(_)) => {
            let found = format!("`{what}` belongs to the whole robot");
            return Err(table.bad("link", found, "leave `link` out"));
        }
        (SpreadOver::Link, Some(link)) => vec![Some(link)],
        (SpreadOver::Link, None) => (0..links).map(Some).collect(),
    };
    for link in places {
        let new = Uncertain {
            quantity,
            spread,
            link,
            distribution,
            size,
        };
        if all.iter().any(|other| other.column() == new.column()) {
            let found = format!("{} is drawn twice", new.column());
            return Err(table.bad("what", found, "say it once"));
        }
        all.push(new);
    }
    Ok(())
}
