//! Balancing from the countdown until the robot is let down, watched by a terminal or a page.

use super::balancer::Balancer;
use super::outcome::{BalanceEnd, BalanceOutcome};
use super::status::BalanceStatus;
use crate::error::Result;
use crate::link::SerialLink;
use crate::link::record::RobotSample;
use handstand_shared::message::ArmLimits;
use std::time::Duration;

/// How long a robot is balanced, and within which limits.
#[derive(Debug, Clone, Copy)]
pub struct Supervision {
    /// From the start until torque comes on, s.
    pub countdown_s: f64,
    /// How long torque stays on, s; until it is stopped without.
    pub seconds: Option<f64>,
    /// What torque comes on with.
    pub limits: ArmLimits,
}

/// Who watches a robot that is balanced.
pub trait BalanceWatch {
    /// Told of each sample before torque comes on, `left_s` seconds before that; whether to go on.
    ///
    /// # Errors
    /// What ends it at once: torque does not come on.
    fn counts_down(&mut self, left_s: f64, at: (&RobotSample, &BalanceStatus)) -> Result<bool>;

    /// Told of each sample while torque is on; whether to go on. If not the robot is let down
    /// softly.
    ///
    /// # Errors
    /// What ends it at once: torque goes off.
    fn balances(&mut self, at: (&RobotSample, &BalanceStatus)) -> Result<bool>;
}

impl<L: SerialLink> Balancer<L> {
    /// Counts down, switches torque on, and supervises until it ends; none where it was stopped
    /// before torque came on.
    ///
    /// # Errors
    /// The CM-5 refuses or falls silent, or those of the watch.
    pub fn supervise(
        &mut self,
        how: Supervision,
        watch: &mut dyn BalanceWatch,
    ) -> Result<Option<BalanceOutcome>> {
        let armed_at = self.link().now() + Duration::from_secs_f64(how.countdown_s);
        while self.link().now() < armed_at {
            let sample = self.step()?;
            let left_s = armed_at.saturating_sub(self.link().now()).as_secs_f64();
            if !watch.counts_down(left_s, (&sample, &self.status))? {
                return Ok(None);
            }
        }
        self.arm(how.limits)?;
        loop {
            let sample = self.step()?;
            let goes_on = watch.balances((&sample, &self.status))?;
            if let Some(outcome) = self.end()? {
                return Ok(Some(outcome));
            }
            if !goes_on {
                return self.let_down(BalanceEnd::Interrupted).map(Some);
            }
            let is_over = |seconds| self.status.balanced_s >= seconds;
            if how.seconds.is_some_and(is_over) {
                return self.let_down(BalanceEnd::Finished).map(Some);
            }
        }
    }
}
