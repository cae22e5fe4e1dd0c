//! Is a log fit to be learned from? Streams it once, in memory that does not grow with it.
//!
//! What is broken is refused; what looks wrong (unit, sign, zero, gaps, an end stop) or leaves a question open
//! (too few reversals) is warned of; the rest is noted. Judging goes on after a finding.

mod block;
mod excitation;
mod finding;
mod fit;
mod joint;
mod relation;
mod timing;

#[cfg(test)]
mod tests;

pub use finding::{Finding, Severity};

use super::read::{GAP_REMEDY, LONGEST_GAP_S};
use super::request::LogRequest;
use super::row::Row;
use super::{LEAST_ROWS, bam, csv};
use crate::error::{Error, Place, Result};
use crate::model::Model;
use excitation::Excitation;
use finding::Findings;
use joint::JointCheck;
use relation::Relations;
use timing::Timing;

/// Judges the requested logs against the model that is to explain them.
///
/// Findings come in the order of the files; those about several files together come last, and without a place.
///
/// # Errors
/// Only what the system refuses; everything wrong with the content is a finding.
pub fn check(requests: &[LogRequest], model: &Model) -> Result<Vec<Finding>> {
    let mut findings = Findings::default();
    let mut excitation = Excitation::new(model);
    for request in requests {
        let mut file = FileCheck::new(request, model, &mut excitation, &mut findings);
        let read = if request.is_json() {
            file.json()
        } else {
            csv::visit(&request.path, &model.log, &mut |number, row| match (
                request.wants(number),
                row,
            ) {
                (false, _) => Ok(()),
                (true, Ok(row)) => {
                    file.take(row);
                    Ok(())
                }
                (true, Err(error)) => file.broken("cell", error),
            })
            .map(|facts| facts.rows)
        };
        match read {
            Ok(rows) => file.finish(rows),
            Err(error) => file.broken("file", error)?,
        }
        findings.close();
    }
    let place = match requests {
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
    excitation: &'a mut Excitation,
    previous: Option<Row>,
    rows_in_motion: usize,
    timing: Timing,
    joints: Vec<JointCheck>,
    relations: Relations,
}

impl<'a> FileCheck<'a> {
    fn new(
        request: &'a LogRequest,
        model: &'a Model,
        excitation: &'a mut Excitation,
        findings: &'a mut Findings,
    ) -> Self {
        FileCheck {
            request,
            model,
            findings,
            excitation,
            previous: None,
            rows_in_motion: 0,
            timing: Timing::default(),
            joints: model.log.joints.iter().map(JointCheck::new).collect(),
            relations: Relations::new(model),
        }
    }

    /// A row or file that cannot be read becomes a finding; the system's refusals stay errors.
    fn broken(&mut self, kind: &'static str, error: Error) -> Result<()> {
        match error {
            Error::Data {
                place,
                what,
                remedy,
            } => {
                self.findings
                    .add(kind, Severity::Refuse, place, what, remedy);
                Ok(())
            }
            other => Err(other),
        }
    }

    fn json(&mut self) -> Result<usize> {
        let motion = bam::read(self.request)?;
        for index in 0..motion.len() {
            self.take(&Row::of(&motion, index));
        }
        Ok(self.request.rows.map_or(motion.len(), |(_, last)| last + 1))
    }

    fn take(&mut self, row: &Row) {
        if row.position_rad.len() != self.joints.len() {
            return;
        }
        let fresh = self.begins(row);
        if fresh {
            self.close_motion();
        }
        let forward = self.timing.take(row, fresh, self.findings);
        // A sample out of order would spoil every difference after it.
        if !forward {
            return;
        }
        self.rows_in_motion += 1;
        for joint in 0..self.joints.len() {
            self.joints[joint].take(row, joint, fresh, self.findings);
        }
        self.relations.take(row, fresh);
        self.excitation.take(row, fresh);
        match &mut self.previous {
            Some(previous) => previous.clone_from(row),
            None => self.previous = Some(row.clone()),
        }
    }

    fn begins(&mut self, row: &Row) -> bool {
        let Some(previous) = &self.previous else {
            return true;
        };
        if row.segment != previous.segment {
            return true;
        }
        let gap = self.model.log.split_at_gap_s;
        if gap.is_some_and(|gap| row.time_s - previous.time_s > gap) {
            return true;
        }
        if row.time_s - previous.time_s > LONGEST_GAP_S {
            let what = format!(
                "time jumps from {} s to {} s within a motion",
                previous.time_s, row.time_s
            );
            let place = row.place(row.fields.time);
            self.findings
                .add("jump", Severity::Refuse, place, what, GAP_REMEDY);
        }
        if row.payload_kg != previous.payload_kg {
            let what = format!(
                "payload changes from {} kg to {} kg within a motion",
                previous.payload_kg, row.payload_kg
            );
            let place = row.place(row.fields.payload);
            let remedy = "mark motions in a segment column";
            self.findings
                .add("payload", Severity::Refuse, place, what, remedy);
        }
        if row.turned != previous.turned {
            let place = row.place(row.fields.turned);
            let what = "the rig is turned round within a motion";
            let remedy = "mark motions in a segment column";
            self.findings
                .add("turned", Severity::Refuse, place, what, remedy);
        }
        false
    }

    fn close_motion(&mut self) {
        if let Some(last) = self
            .previous
            .as_ref()
            .filter(|_| self.rows_in_motion < LEAST_ROWS)
        {
            let what = format!(
                "a motion of {} rows ends here; {LEAST_ROWS} are the least",
                self.rows_in_motion
            );
            let place = last.place(last.fields.time);
            let remedy = "leave it out by a row range such as log.csv:26-139, or record longer";
            self.findings
                .add("short", Severity::Refuse, place, what, remedy);
        }
        self.rows_in_motion = 0;
    }

    fn finish(mut self, rows: usize) {
        let place = Place::file(&self.request.path);
        if let Some((first, last)) = self.request.rows.filter(|(_, last)| *last >= rows) {
            let what = format!("rows {first}-{last} asked for, but it has {rows} rows");
            let remedy = "data rows count from 0, after the header";
            self.findings
                .add("range", Severity::Refuse, place.clone(), what, remedy);
        }
        if self.previous.is_none() {
            let what = "no sample could be read";
            let remedy = "see the rows refused, or record again";
            self.findings
                .add("none", Severity::Refuse, place, what, remedy);
            return;
        }
        self.close_motion();
        self.timing.judge(&place, self.findings);
        for (joint, check) in self.joints.iter_mut().enumerate() {
            check.judge(&place, &self.model.joints[joint].drive, self.findings);
        }
        self.relations.judge(&place, self.model, self.findings);
    }
}
