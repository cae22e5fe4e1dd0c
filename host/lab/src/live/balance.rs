//! Balancing the robot, live: as `handstand balance`, with the same questions.

use super::access::OpenLine;
use super::pose::LinkPose;
use super::samples::{LiveChart, Sender};
use super::slot::{LivePhase, LiveRobot};
use crate::deploy::PlanBasis;
use crate::deploy::balance::{
    AttitudeSource, BalanceStatus, BalanceWatch, Balancer, Supervision, WheelChange, check_attitude,
};
use crate::error::Result;
use crate::link::SerialLink;
use crate::link::record::{RobotRecorder, RobotSample};
use crate::model::Model;
use handstand_shared::message::ArmLimits;
use handstand_shared::plan::Plan;
use handstand_shared::raw::TorqueLimit;
use std::path::Path;

/// Supervision with this torque limit, a share of full torque.
pub fn supervision(seconds: Option<f64>, countdown_s: f64, torque: f64) -> Supervision {
    Supervision {
        countdown_s,
        seconds,
        limits: ArmLimits {
            torque: TorqueLimit((torque * 1023.0).round() as u16),
            ..ArmLimits::FULL
        },
    }
}

/// Sets up, asks, balances and lets down; what is said of it.
///
/// # Errors
/// What speaks against it, in the words of the CM-5 or of this program.
pub fn run(
    robot: &LiveRobot,
    (link, simulated): OpenLine,
    model: Option<&Model>,
    how: Supervision,
    file: &Path,
) -> Result<String> {
    let access = &robot.access;
    let given = model.map(|model| plan(robot, model)).transpose()?;
    let source = AttitudeSource::of_plan(given.as_ref(), simulated);
    let is_gyro = source.is_gyro();
    let mut balancer = Balancer::new(link, &access.ids, source)?;
    let plan = match given {
        Some(plan) => plan,
        None => balancer.stored_plan()?,
    };
    check_attitude(&plan, is_gyro)?;
    if !set_up(robot, &mut balancer, &plan)? {
        return Ok("not agreed to: nothing was moved".into());
    }
    prepares(robot, "hearing the servos");
    balancer.make_ready(&plan)?;
    let question = "Is the robot upright and straight, and room around it?";
    if !robot.asks(question.into()) {
        return Ok("not agreed to: nothing was moved".into());
    }
    robot.keep_emergency_off(balancer.emergency_off());
    let mut watch = LiveObserver {
        robot,
        pose: LinkPose::new(model, &access.ids),
        sender: Sender::new(robot.samples().clone()),
        recorder: None,
        file,
        told: String::new(),
    };
    let outcome = balancer.supervise(how, &mut watch);
    if let Some(recorder) = watch.recorder {
        recorder.finish()?;
    }
    Ok(match outcome? {
        None => "stopped before torque came on: nothing was moved".into(),
        Some(outcome) => {
            let words = outcome.words();
            format!("balanced for {:.1} s; {words}", outcome.balanced_s)
        }
    })
}

/// The plan for a model, as `handstand balance MODEL` designs it.
fn plan(robot: &LiveRobot, model: &Model) -> Result<Plan> {
    prepares(robot, "designing the plan");
    let access = &robot.access;
    PlanBasis::of(model, &access.board, &access.timing, &access.told)?.plan(model)
}

/// The plan onto the CM-5, the servos into wheel mode; false where that was not agreed to.
fn set_up(
    robot: &LiveRobot,
    balancer: &mut Balancer<Box<dyn SerialLink>>,
    plan: &Plan,
) -> Result<bool> {
    prepares(robot, "comparing the plan on the CM-5");
    balancer.deploy(plan, |sent| {
        prepares(robot, &format!("uploading the plan: {sent} bytes"));
    })?;
    prepares(robot, "reading the servos' modes");
    let changes = balancer.wheel_changes(plan)?;
    if changes.is_empty() {
        return Ok(true);
    }
    let one = |change: &WheelChange| {
        format!(
            "{} of servo {} ({})",
            change.register.name, change.id, change.before
        )
    };
    let list: Vec<String> = changes.iter().map(one).collect();
    let question = format!(
        "These registers are kept without power and have to be 0 (now): {}. Write them?",
        list.join(", ")
    );
    if !robot.asks(question) {
        return Ok(false);
    }
    prepares(robot, "setting the servos up");
    balancer.set_up(&changes)?;
    Ok(true)
}

fn prepares(robot: &LiveRobot, what: &str) {
    robot.tell(LivePhase::Preparing { what: what.into() });
}

/// Sends what it is told to pages, and writes it down.
struct LiveObserver<'a> {
    robot: &'a LiveRobot,
    pose: LinkPose<'a>,
    sender: Sender,
    /// Made when torque comes on.
    recorder: Option<RobotRecorder>,
    file: &'a Path,
    told: String,
}

impl LiveObserver<'_> {
    fn hear(
        &mut self,
        what: String,
        (sample, status): (&RobotSample, &BalanceStatus),
    ) -> Result<bool> {
        if what != self.told {
            self.told.clone_from(&what);
            self.robot.tell(LivePhase::Running {
                what,
                charts: charts(),
            });
        }
        let [shoulder, hip] = status.joint_rad;
        let values = [status.lean_rad, shoulder, hip]
            .into_iter()
            .chain(status.output);
        let pose = &self.pose;
        self.sender.add(sample.time_s, values, |last| {
            last.link_rad = pose.of_status(status);
            last.supply_v = status.supply_v();
            last.hottest_celsius = status.hottest_celsius();
        });
        self.robot.goes_on()
    }
}

impl BalanceWatch for LiveObserver<'_> {
    fn counts_down(&mut self, left_s: f64, at: (&RobotSample, &BalanceStatus)) -> Result<bool> {
        self.hear(
            format!("torque in {:.0} s: hold the robot", left_s.ceil()),
            at,
        )
    }

    fn balances(&mut self, at: (&RobotSample, &BalanceStatus)) -> Result<bool> {
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            none => none.insert(RobotRecorder::create(
                self.file,
                &self.robot.access.ids,
                false,
            )?),
        };
        recorder.write(at.0)?;
        self.hear("balancing".into(), at)
    }
}

fn charts() -> Vec<LiveChart> {
    let charts = [
        ("first link from upright", "rad"),
        ("shoulder", "rad"),
        ("hip", "rad"),
        ("output at the shoulder, share of full", "1"),
        ("output at the hip, share of full", "1"),
    ];
    let chart = |(title, unit): (&str, &'static str)| LiveChart {
        title: title.into(),
        unit,
    };
    charts.map(chart).to_vec()
}
