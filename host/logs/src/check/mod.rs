//! Checks the quality of logs: each motion is judged as it was cut, before gaps are filled.
//!
//! What is broken is refused; what looks wrong (unit, sign, zero, gaps, an end stop) or leaves a
//! question open (too few reversals) is warned of; the rest is noted. Judging goes on after a
//! finding.

mod excitation;
mod extremes;
mod finding;
mod fit;
mod held;
mod joint;
mod outlier;
mod relation;
mod sampling;
mod stretch;
mod wrong_cells;

#[cfg(test)]
mod tests;

pub use finding::{LogFinding, Proof, Severity};

use super::bam::BamBench;
use super::cut::{Cut, cut};
use super::expanded;
use super::request::LogRequest;
use crate::error::{Place, Problem, Result};
use crate::model::Model;
use excitation::ExcitationCheck;
use finding::Findings;
use joint::JointCheck;
use relation::Relations;
use std::path::Path;
use wrong_cells::WrongCells;

/// Judges the requested logs against the model that is to explain them.
///
/// Findings come in the order of the files; those about several files together come last, and
/// without a place.
///
/// # Errors
/// Only what the system refuses; everything wrong with the content is a finding.
pub fn check(requests: &[LogRequest], model: &Model) -> Result<Vec<LogFinding>> {
    let mut findings = Findings::default();
    let mut excitation = ExcitationCheck::new(model);
    let mut bench = BamBench::default();
    let requests = &expanded(requests)?;
    for request in requests {
        let mut cells = WrongCells::default();
        let (cut, facts) = cut(request, &model.log, &mut bench, &mut |kind, fault| {
            match fault.cell {
                Some(cell) => cells.take(fault.place, fault.problem, cell),
                None => findings.refuse(kind, fault.place, &fault.problem),
            }
            Ok(())
        });
        let lacks_column = cells.close(cut.rows, &mut findings);
        match facts {
            Ok(facts) => {
                findings.extend(facts.finding(&request.path));
                judge(request, model, &cut, lacks_column, &mut findings);
                cut.motions
                    .iter()
                    .for_each(|cut| excitation.take(&cut.motion));
            }
            Err(error) => findings.broken("file", error)?,
        }
        findings.close();
    }
    let place = match requests.as_slice() {
        [request] => Some(Place::file(&request.path)),
        _ => None,
    };
    excitation.judge(place.as_ref(), &mut findings);
    findings.close();
    Ok(findings.list)
}

/// A file and the motions in it.
struct LoggedFile<'a> {
    path: &'a Path,
    cut: &'a Cut,
}

impl LoggedFile<'_> {
    fn place(&self) -> Place {
        Place::file(self.path)
    }

    /// A field of a line.
    fn at(&self, line: usize, field: usize) -> Place {
        self.cut.fields.place(self.path, line, field)
    }
}

/// Judges a file that was read; `lacks_column` where a whole column of it was refused.
fn judge(
    request: &LogRequest,
    model: &Model,
    cut: &Cut,
    lacks_column: bool,
    findings: &mut Findings,
) {
    let path = &request.path;
    let file = &LoggedFile { path, cut };
    for sentence in model.log.unobserved() {
        let remedy = "what the log cannot show cannot be diagnosed";
        findings.note("unobserved", file.place(), (sentence, remedy));
    }
    if cut.is_empty() {
        match cut.lack(&model.log, &request.name()) {
            Some(problem) => findings.refuse("missing", file.place(), &problem),
            // That says all.
            None if lacks_column => {}
            None => {
                let remedy = "see the rows refused, or record again";
                let problem = Problem::new("no sample could be read", remedy);
                findings.refuse("none", file.place(), &problem);
            }
        }
        return;
    }
    // Refuses a file of which nothing is long enough; else only warns of what is not.
    match cut.short.refusal(path).filter(|_| cut.motions.is_empty()) {
        Some((place, problem)) => findings.refuse("short", place, &problem),
        None => findings.extend(cut.short.warning(path)),
    }
    sampling::judge(file, model.log.time.unit, findings);
    for (joint, columns) in model.log.joints.iter().enumerate() {
        let mut check = JointCheck::new(columns, joint);
        cut.motions.iter().for_each(|motion| check.take(motion));
        check.judge(file, &model.joints[joint].drive, findings);
    }
    let mut relations = Relations::new(model);
    cut.motions
        .iter()
        .for_each(|cut| relations.take(&cut.motion));
    relations.judge(&file.place(), model, findings);
}
