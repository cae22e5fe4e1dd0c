//! The state of a plant in a loop.

use super::equations::Equations;
use super::general::{General, GeneralState};
use super::posed_plant::PosedPlant;

/// The state as deviations from the pose, joint by joint from the link before.
#[derive(Debug)]
pub(super) struct Body {
    pub(super) angle_rad: Vec<f64>,
    pub(super) speed_rad_s: Vec<f64>,
    /// Torques of the drives as they were when the last commands arrived, N m.
    pub(super) drive_nm: Vec<f64>,
    pub(super) general: Option<Box<dyn General>>,
}

impl Body {
    /// At these deviations from the pose, rad and rad/s.
    pub(super) fn new(posed: &PosedPlant, angle_rad: &[f64], speed_rad_s: &[f64]) -> Self {
        let general = matches!(posed.equations, Equations::General).then(|| {
            let pose = posed.pose_rad.iter().zip(angle_rad);
            let angle: Vec<f64> = pose.map(|(pose, off)| pose + off).collect();
            GeneralState::boxed(&posed.plant, angle, speed_rad_s.to_vec())
        });
        Body {
            angle_rad: angle_rad.to_vec(),
            speed_rad_s: speed_rad_s.to_vec(),
            drive_nm: vec![0.0; posed.drives()],
            general,
        }
    }
}
