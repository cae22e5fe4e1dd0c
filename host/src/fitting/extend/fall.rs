//! Errors in rad: before, after, and what exact knowledge would leave.

use crate::fitting::{Data, Fit};

/// How far the error falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fall {
    /// Root-mean-square position error before, rad, all joints together.
    pub before_rad: f64,
    /// The same after.
    pub after_rad: f64,
    /// What the noise and resolution of the measurement leave.
    pub floor_rad: f64,
    /// Whether the motions judged took no part in the fit.
    pub held_out: bool,
}

/// Root-mean-square position error, rad, over all joints and every sample that was measured.
pub fn rms_rad(fit: &Fit, data: &Data) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for (window, residuals) in data.windows.iter().zip(&fit.residuals.windows) {
        let motion = &data.motions[window.motion];
        for (joint, part) in residuals.chunks(window.samples.len()).enumerate() {
            let measured = &motion.position_rad[joint][window.samples.clone()];
            for (residual, _) in part.iter().zip(measured).filter(|(_, m)| !m.is_nan()) {
                sum += (residual * data.sigma_rad[joint]).powi(2);
                count += 1;
            }
        }
    }
    (sum / count.max(1) as f64).sqrt()
}

/// The error a perfect model would show.
pub(super) fn floor_rad(data: &Data) -> f64 {
    let squares: f64 = data.sigma_rad.iter().map(|sigma| sigma * sigma).sum();
    (squares / data.sigma_rad.len().max(1) as f64).sqrt()
}
