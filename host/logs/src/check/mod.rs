//! Checks the quality of logs: one pass over the rows, in memory that does not grow with them.
//!
//! What is broken is refused; what looks wrong (unit, sign, zero, gaps, an end stop) or leaves a
//! question open (too few reversals) is warned of; the rest is noted. Judging goes on after a
//! finding.

mod empty;
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
use super::read::LeftOut;
use super::reason::LogReason;
use super::request::LogRequest;
use super::row::LogRow;
use super::short::{RowsLeft, ShortMotions};
use super::{LEAST_ROWS, bam, expanded, visit};
use crate::error::{Error, Place, Result, words};
use crate::model::Model;
use crate::motion::ends_s;
use empty::EmptyColumns;
use excitation::ExcitationCheck;
use finding::Findings;
use joint::JointCheck;
use relation::Relations;
use sampling::Sampling;
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
    let requests = &expanded(requests)?;
    for request in requests {
        let mut file = FileCheck::new(request, model, &mut excitation, &mut findings);
        let read = if request.is_json() {
            file.json()
        } else {
            visit(
                &request.path,
                &model.log,
                &mut |number, row| match (request.wants(number), row) {
                    (false, _) => Ok(()),
                    (true, Ok(row)) => {
                        file.take(row);
                        Ok(())
                    }
                    (true, Err(error)) => file.unread(error),
                },
            )
            .map(|facts| {
                file.findings.extend(facts.finding(&request.path));
                facts.rows
            })
        };
        file.close_cells();
        match read {
            Ok(rows) => file.finish(rows),
            Err(error) => file.broken("file", error)?,
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

struct FileCheck<'a> {
    request: &'a LogRequest,
    model: &'a Model,
    findings: &'a mut Findings,
    excitation: &'a mut ExcitationCheck,
    previous: Option<LogRow>,
    /// The first rows of a motion, until it is long enough to be judged.
    held: Vec<LogRow>,
    rows_left: RowsLeft,
    short: ShortMotions,
    /// Motions that are long enough.
    motions: usize,
    cells: WrongCells,
    /// Whether a whole column could not be read.
    lacks_column: bool,
    left_out: LeftOut,
    empty: EmptyColumns<'a>,
    sampling: Sampling,
    joints: Vec<JointCheck>,
    relations: Relations,
}

impl<'a> FileCheck<'a> {
    fn new(
        request: &'a LogRequest,
        model: &'a Model,
        excitation: &'a mut ExcitationCheck,
        findings: &'a mut Findings,
    ) -> Self {
        FileCheck {
            request,
            model,
            findings,
            excitation,
            previous: None,
            held: Vec::new(),
            rows_left: RowsLeft::new(match request.is_json() {
                // Nothing of it is moved.
                true => (0.0, 0.0),
                false => ends_s(&model.log),
            }),
            short: ShortMotions::default(),
            motions: 0,
            cells: WrongCells::default(),
            lacks_column: false,
            left_out: LeftOut::default(),
            empty: EmptyColumns::new(&model.log, request.name()),
            sampling: Sampling::default(),
            joints: model.log.joints.iter().map(JointCheck::new).collect(),
            relations: Relations::new(model),
        }
    }

    /// A row or file that cannot be read becomes a finding; the system's refusals stay errors.
    fn broken(&mut self, kind: &'static str, error: Error) -> Result<()> {
        match error {
            Error::Data { place, reason } => {
                self.findings.refuse(kind, place, &*reason);
                Ok(())
            }
            other => Err(other),
        }
    }

    /// A row that cannot be read.
    fn unread(&mut self, error: Error) -> Result<()> {
        match self.cells.take(error) {
            Ok(()) => Ok(()),
            Err(error) => self.broken("cell", error),
        }
    }

    fn close_cells(&mut self) {
        self.lacks_column = self.cells.close(self.findings);
    }

    fn json(&mut self) -> Result<usize> {
        let motion = bam::read(self.request, &self.model.log, &mut BamBench::default())?;
        for index in 0..motion.len() {
            self.take(&LogRow::of(&motion, index));
        }
        Ok(self.request.rows.map_or(motion.len(), |(_, last)| last + 1))
    }

    fn take(&mut self, row: &LogRow) {
        self.cells.read();
        if row.position_rad.len() != self.joints.len() {
            return;
        }
        if self.left_out.lacks_torque(row, &self.model.log) {
            return;
        }
        let fresh = self.begins(row);
        if fresh && self.left_out.lacks_input(row) {
            return;
        }
        if fresh {
            self.close_motion();
        }
        let forward = self.sampling.take(row, fresh, self.findings);
        // A sample out of order would spoil every difference after it; after a restart, that is one
        // to the samples before.
        if !forward {
            if self
                .previous
                .as_ref()
                .is_none_or(|previous| row.time_s >= previous.time_s)
            {
                return;
            }
            self.close_motion();
        }
        self.rows_left.take(row.line, row.time_s);
        self.empty.take(row);
        self.hold_or_judge(row);
        match &mut self.previous {
            Some(previous) => previous.clone_from(row),
            None => self.previous = Some(row.clone()),
        }
    }

    /// Judges a row once its motion is long enough; of one that is not, no row is judged.
    fn hold_or_judge(&mut self, row: &LogRow) {
        if self.held.len() == LEAST_ROWS {
            return self.judge(row, false);
        }
        self.held.push(row.clone());
        if self.held.len() == LEAST_ROWS {
            // Stays as long as it is: so it says that the motion is long enough.
            let held = std::mem::take(&mut self.held);
            for (index, row) in held.iter().enumerate() {
                self.judge(row, index == 0);
            }
            self.held = held;
        }
    }

    fn judge(&mut self, row: &LogRow, fresh: bool) {
        for joint in 0..self.joints.len() {
            self.joints[joint].take(row, joint, fresh, self.findings);
        }
        self.relations.take(row, fresh);
        self.excitation.take(row, fresh);
    }

    /// Whether a new motion begins with `row`; if not, it must fit the present one.
    fn begins(&mut self, row: &LogRow) -> bool {
        let previous = self.previous.as_ref().map(LogRow::before);
        let gap_s = self.model.log.split_at_gap_s;
        let Some(wrong) = previous.and_then(|previous| row.follows(&previous, gap_s)) else {
            return true;
        };
        // The order of time is judged with the sampling.
        let in_time = |reason: &LogReason| !matches!(reason, LogReason::TimeNotIncreasing { .. });
        for (field, reason) in wrong.into_iter().filter(|(_, reason)| in_time(reason)) {
            let kind = match reason {
                LogReason::TimeJumps { .. } => "jump",
                LogReason::PayloadChanges { .. } => "payload",
                _ => "turned",
            };
            self.findings.refuse(kind, row.place(field), &reason);
        }
        false
    }

    /// Ends a motion: one that is too short is left out.
    fn close_motion(&mut self) {
        self.held.clear();
        match self.rows_left.close() {
            None => {}
            Some((lines, rows)) if rows < LEAST_ROWS => {
                self.short.take(lines, rows);
                self.empty.begin();
            }
            Some(_) => {
                self.motions += 1;
                let place = Place::file(&self.request.path);
                self.empty.close(&place, self.findings);
            }
        }
    }

    /// Refuses a file of which nothing is long enough; else only warns of what is not.
    fn close_short(&mut self) {
        let path = &self.request.path;
        match self.short.refusal(path).filter(|_| self.motions == 0) {
            Some((place, reason)) => self.findings.refuse("short", place, &reason),
            None => self.findings.extend(self.short.warning(path)),
        }
    }

    fn finish(mut self, rows: usize) {
        let place = Place::file(&self.request.path);
        for sentence in self.model.log.unobserved() {
            let remedy = "what the log cannot show cannot be diagnosed";
            self.findings
                .note("unobserved", place.clone(), (sentence, remedy));
        }
        if let Some(reason) = self.request.beyond(rows) {
            self.findings.refuse("range", place.clone(), &reason);
        }
        if self.previous.is_none() {
            let name = self.request.name();
            match self.left_out.reason(&self.model.log, &name) {
                Some(reason) => self.findings.refuse("missing", place, &reason),
                // That says all.
                None if self.lacks_column => {}
                None => {
                    let remedy = "see the rows refused, or record again";
                    let reason = words("no sample could be read", remedy);
                    self.findings.refuse("none", place, &reason);
                }
            }
            return;
        }
        self.close_motion();
        self.close_short();
        let unit = self.model.log.time.unit;
        self.sampling.judge(&place, unit, self.findings);
        for (joint, check) in self.joints.iter_mut().enumerate() {
            check.judge(&place, &self.model.joints[joint].drive, self.findings);
        }
        self.relations.judge(&place, self.model, self.findings);
    }
}
