//! Angles of a model's links from a robot's sample.

use crate::deploy::balance::BalanceStatus;
use crate::link::record::{RobotSample, ServoSample};
use crate::model::{AngleZero, Angles, Model};

/// Turns samples into angles of links.
#[derive(Debug)]
pub struct LinkPose<'a> {
    model: Option<&'a Model>,
    ids: &'a [u8],
}

impl<'a> LinkPose<'a> {
    /// Of this model's links, by the servos' places in a sample; without a model there are none.
    pub fn new(model: Option<&'a Model>, ids: &'a [u8]) -> Self {
        LinkPose { model, ids }
    }

    /// Angle of each link from hanging, rad, by the columns that the model's log names; none where
    /// it names no column of this sample.
    pub fn of_sample(&self, sample: &RobotSample) -> Vec<Option<f64>> {
        let joints = self.model.map_or(&[][..], |model| &model.log.joints);
        let angles = joints.iter().map(|joint| {
            let columns = joint.position.as_ref()?.columns();
            let values: Option<Vec<f64>> = columns
                .iter()
                .map(|column| Some(column.to_si(self.value(sample, &column.name)?)))
                .collect();
            let values = values?;
            Some(values.iter().sum::<f64>() / values.len() as f64)
        });
        self.links_rad(&angles.collect::<Vec<_>>())
    }

    /// The same of a robot that balances: its first link's angle is from upright, the others'
    /// relative.
    pub fn of_status(&self, status: &BalanceStatus) -> Vec<Option<f64>> {
        let [shoulder, hip] = status.joint_rad;
        let mut from = status
            .lean_rad
            .map(|lean| AngleZero::Upright.from_hanging_rad() + lean);
        let relative = [Some(0.0), shoulder, hip];
        let links = relative.map(|angle| {
            from = from.zip(angle).map(|(from, angle)| from + angle);
            from
        });
        links.to_vec()
    }

    /// A value of a sample by the name of its column in a recording.
    fn value(&self, sample: &RobotSample, name: &str) -> Option<f64> {
        for (id, servo) in self.ids.iter().zip(&sample.joints) {
            for ((before, behind), value) in ServoSample::NAMES.iter().zip(servo.values()) {
                if name == format!("{before}{id}{behind}") {
                    return value;
                }
            }
        }
        None
    }

    /// Angles in the model's convention, from hanging. One that is not known leaves those that
    /// hang on it unknown.
    fn links_rad(&self, joint_rad: &[Option<f64>]) -> Vec<Option<f64>> {
        let Some(model) = self.model else {
            return Vec::new();
        };
        let mut from = Some(model.angle_zero.from_hanging_rad());
        let links = joint_rad.iter().map(|angle| {
            let own = from.zip(*angle).map(|(from, angle)| from + angle);
            if model.angles == Angles::Relative {
                from = own;
            }
            own
        });
        links.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn two_servos_of_a_joint_are_read_as_the_log_is() {
        let text = "[rig]\nname = \"p\"\nangle_zero = \"hanging\"\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 1e-4\n\
             [[joint]]\ndrive = \"passive\"\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n\
             [[log.joint]]\nposition = [{ column = \"q1_rad\", unit = \"rad\" },\n\
             { column = \"q2_rad\", unit = \"rad\", reversed = true }]\n";
        let model = Model::parse(text, Path::new("p.toml")).unwrap();
        let servo = |position_rad| ServoSample {
            position_rad,
            ..ServoSample::default()
        };
        let mut sample = RobotSample {
            joints: vec![servo(Some(0.3)), servo(Some(-0.1))],
            ..RobotSample::default()
        };
        let pose = LinkPose::new(Some(&model), &[1, 2]);
        let [Some(angle)] = pose.of_sample(&sample)[..] else {
            panic!("one link");
        };
        assert!((angle - 0.2).abs() < 1e-12, "{angle}");
        sample.joints[1] = servo(None);
        assert_eq!(pose.of_sample(&sample), [None], "half of it is no angle");
        assert_eq!(LinkPose::new(None, &[1, 2]).of_sample(&sample), []);
    }
}
