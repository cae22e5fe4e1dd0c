//! The invariants, each checked after every step.

use super::IDS;
use super::acts::TAKEN_MS;
use super::judged::Judged;
use handstand_cm5_sim::SimulatedCm5;
use handstand_firmware::app::{State, Torque};
use handstand_shared::control_table::{CCW_LIMIT, GOAL_POSITION, MOVING_SPEED, TORQUE_LIMIT};
use handstand_shared::message::*;
use handstand_shared::raw::MovingSpeed;

impl Judged {
    pub(super) fn judge(&mut self) {
        let now_ms = self.cm5.now_ms();
        self.arms.retain(|(until_ms, ..)| now_ms <= *until_ms);
        let is_armed = self.cm5.app.is_armed();
        // Commands that came during one tick are obeyed one right after the other: torque that went
        // off and came on again between two looks shows in the token alone.
        let armed_again = self.fresh.is_some() && self.cm5.app.used_token() == self.fresh;
        if is_armed && (!self.armed || armed_again) {
            let fresh = self.fresh;
            let arms = self.arms.iter();
            // Of two that came during one tick the first arms, or the second if the first was
            // refused: which one is not known here.
            let own = arms.filter(|(_, token, limits)| Some(*token) == fresh && limits.is_sound());
            let all = own.clone().map(|(_, _, limits)| *limits);
            let limits = all.reduce(|a, b| ArmLimits {
                torque: a.torque.max(b.torque),
                speed: MovingSpeed(a.speed.0.max(b.speed.0)),
            });
            let first_ms = own.map(|(until_ms, ..)| until_ms - TAKEN_MS);
            let first_ms = first_ms.fold(f64::INFINITY, f64::min);
            let Some(limits) = limits else {
                panic!(
                    "armed by none of {:?}, the token being {fresh:?}",
                    self.arms
                );
            };
            self.judge_arming(limits, first_ms.max(self.looked_ms));
        }
        if self.armed && !is_armed {
            self.off_ms = Some(now_ms);
        }
        self.armed = is_armed;
        self.judge_torque(now_ms);
        self.judge_times(now_ms);
        if is_armed {
            self.judge_armed(now_ms);
        }
        self.goals = self.goals_now();
        let servos = self.cm5.board.bus.servos.iter();
        self.had_torque = servos.map(|servo| servo.torque_is_on()).collect();
        self.was_streaming = matches!(self.cm5.app.state(), State::Stream(Torque::On(_)));
        self.looked_ms = now_ms;
        let unfed_ms = self.cm5.board.longest_unfed_ns as f64 * 1e-6;
        assert!(
            unfed_ms <= 22.0,
            "{unfed_ms} ms without feeding the watchdog"
        );
    }

    /// What the firmware must have refused, had it been so when it was armed, which it was not
    /// before `since_ms`: a tick may have come between, and lasts up to 18 ms.
    fn judge_arming(&mut self, limits: ArmLimits, since_ms: f64) {
        // A token arms once, and only the last one.
        self.fresh = None;
        let now_ms = self.cm5.now_ms();
        let supply_v = self.cm5.board.bus.servos.iter().map(|servo| servo.supply_v);
        let lowest_v = supply_v.fold(f64::INFINITY, f64::min);
        // As a round of the housekeeping told: it takes up to three ticks here, noise lets it last.
        assert!(
            lowest_v >= 8.75 || now_ms - self.supply_ms < 500.0,
            "armed at {lowest_v} V"
        );
        self.plan = self.cm5.app.plan_fingerprint();
        self.limits = limits;
        self.gave_up.clear();
        self.off_ms = None;
        self.odd.clear();
        self.armed_ms = now_ms;
        let is_balance = matches!(self.cm5.app.state(), State::Balance(_));
        if is_balance {
            assert!(self.plan.is_some(), "balancing without a plan");
            if self.is_by_gyro() {
                // It is heard for ten ticks.
                let is_bad = |since_ms: Option<f64>| since_ms.is_some_and(|at| now_ms - at > 40.0);
                assert!(!is_bad(self.rail_ms), "armed with a gyro at a rail");
                assert!(!is_bad(self.far_ms), "armed with a gyro far from its zero");
            } else {
                let age_ms = since_ms - self.attitudes.last_by(now_ms);
                assert!(age_ms <= 30.5, "armed with an attitude {age_ms} ms old");
            }
        }
        // Who did not answer was not switched on.
        let bus = &self.cm5.board.bus;
        let deaf = bus.servos.iter().filter(|servo| servo.faults.dead);
        self.odd.extend(deaf.map(|servo| servo.id()));
        // Nor is what missed torque off before, and is not heard now.
        let had_torque = self.had_torque.iter().zip(IDS).enumerate();
        let unheard = had_torque.filter(|(at, (had, _))| **had && self.may_be_deaf(*at));
        let unheard: Vec<u8> = unheard.map(|(_, (_, id))| id).collect();
        self.odd.extend(unheard);
    }

    /// Torque is off where nothing is armed, in every servo that hears.
    fn judge_torque(&self, now_ms: f64) {
        let Some(off_ms) = self.off_ms else { return };
        for (at, servo) in self.cm5.board.bus.servos.iter().enumerate() {
            let id = servo.id();
            let is_odd = self.may_be_deaf(at) || self.odd.contains(&id);
            assert!(
                is_odd || !servo.torque_is_on(),
                "servo {id} is torqued, {:.1} ms after torque off, in {:?}",
                now_ms - off_ms,
                self.cm5.app.state()
            );
        }
    }

    /// Times by the clock on the wall, of what the servos were written: soft within 100 ms of the
    /// last sign of life, off within 300; and an attitude of at most 30 ms at every command of the
    /// law.
    fn judge_times(&mut self, now_ms: f64) {
        let bus = &self.cm5.board.bus;
        let state = self.cm5.app.state();
        let written_ms = |register| {
            let at_ns = bus.last_write_ns(register);
            at_ns.map_or(f64::NEG_INFINITY, |ns| ns as f64 * 1e-6)
        };
        let since_life = |at_ms: f64| at_ms - self.lives.last_by(at_ms).max(self.armed_ms);
        let is_on = matches!(
            state,
            State::Stream(Torque::On(_)) | State::Balance(Torque::On(_))
        );
        let is_balancing = matches!(state, State::Balance(Torque::On(_)));
        if is_on {
            let silent_ms = since_life(now_ms);
            assert!(silent_ms <= 100.3, "{silent_ms} ms without life");
        }
        if self.was_on && state.condition() == Condition::Soft {
            let soft_ms = since_life(written_ms(TORQUE_LIMIT));
            assert!(soft_ms <= 100.3, "soft {soft_ms} ms after the last life");
        }
        // Torque off is said again in the next ticks.
        let offs = bus.torque_offs.iter().rev().map(|ns| *ns as f64 * 1e-6);
        let first_off_ms = offs.take_while(|at_ms| *at_ms > self.looked_ms).last();
        let off_ms = first_off_ms.filter(|_| !state.is_armed()).unwrap_or(now_ms);
        if state.is_armed() || self.was_armed {
            let off_ms = since_life(off_ms);
            assert!(off_ms <= 300.3, "torque {off_ms} ms after the last life");
        }
        let law_ms = written_ms(MOVING_SPEED);
        if is_balancing && self.was_balancing && law_ms > self.looked_ms && !self.is_by_gyro() {
            let age_ms = law_ms - self.attitudes.last_by(law_ms);
            assert!(age_ms <= 30.5, "balances by an attitude {age_ms} ms old");
        }
        if is_balancing && self.is_by_gyro() {
            let rail_ms = self.rail_ms.map_or(0.0, |since_ms| now_ms - since_ms);
            assert!(rail_ms <= 40.0, "the gyro is at a rail for {rail_ms} ms");
        }
        (self.was_on, self.was_balancing) = (is_on, is_balancing);
        self.was_armed = state.is_armed();
    }

    fn judge_armed(&mut self, now_ms: f64) {
        let state = self.cm5.app.state();
        assert_eq!(
            self.cm5.app.plan_fingerprint(),
            self.plan,
            "the plan changed under an armed robot"
        );
        assert!(
            !self.cm5.app.is_writing(),
            "a plan is written under an armed robot"
        );
        let is_on = matches!(
            state,
            State::Stream(Torque::On(_)) | State::Balance(Torque::On(_))
        );
        if let State::Balance(Torque::On(_)) = state {
            let out_ms = self.out_ms.map_or(0.0, |since_ms| now_ms - since_ms);
            assert!(
                out_ms <= 60.0,
                "a joint is out of its range for {out_ms} ms"
            );
        }
        if let Some(since_ms) = self.button_ms {
            assert!(now_ms - since_ms <= 70.0, "a button does not stop it");
        }
        let periods = ((now_ms - self.looked_ms) / 10.0).ceil() as u16 + 1;
        for at in 0..IDS.len() {
            let servo = &self.cm5.board.bus.servos[at];
            if !self.odd.contains(&servo.id()) && servo.torque_is_on() {
                self.judge_limits(at);
            }
        }
        let servos = self.cm5.board.bus.servos.iter().zip(&self.goals);
        for (at, (servo, before)) in servos.enumerate() {
            let id = servo.id();
            // Arming itself sets them to where the servos stand.
            if self.was_streaming && matches!(state, State::Stream(Torque::On(_))) {
                let step = servo.get(GOAL_POSITION).abs_diff(*before);
                // One that was silent goes on from where it stands.
                let is_odd = self.is_disturbed(at) || self.odd.contains(&id);
                assert!(is_odd || step <= 20 * periods, "a goal jumped by {step}");
            }
        }
        for id in &self.gave_up {
            let servo = self
                .cm5
                .board
                .bus
                .servos
                .iter()
                .find(|servo| servo.id() == *id);
            let at = IDS.iter().position(|other| other == id);
            let is_disturbed = at.is_some_and(|at| self.is_disturbed(at));
            let since = servo.is_some_and(|servo| servo.torque_is_on() && !is_disturbed);
            assert!(
                !since || self.odd.contains(id) || is_on,
                "servo {id} was woken"
            );
        }
    }

    /// No servo with torque has more of it, or is faster, than arming named: one that lost its
    /// registers is let go once it was read. Requests that it does not hear change nothing of it.
    fn judge_limits(&mut self, at: usize) {
        if self.has_restarted[at] && self.is_disturbed(at) {
            return;
        }
        self.has_restarted[at] = false;
        let servo = &self.cm5.board.bus.servos[at];
        let (limit, speed) = (servo.get(TORQUE_LIMIT), servo.get(MOVING_SPEED));
        let id = servo.id();
        assert!(
            limit <= self.limits.torque.0,
            "servo {id}: torque limit {limit}"
        );
        let is_joint = servo.get(CCW_LIMIT) != 0;
        assert!(
            !is_joint || (1..=self.limits.speed.0).contains(&speed),
            "servo {id}: speed {speed}"
        );
    }
}
