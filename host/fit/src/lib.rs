//! A model fitted to measured motions by multiple shooting, with intervals, and compared with them.
//!
//! ```
//! # use handstand_fit::fitting::{FitOptions, FitProblem, Horizon, fit};
//! # use handstand_model::{Model, motion::Motion};
//! # use handstand_sim::sim::Live;
//! let pendulum = |friction: f64| {
//!     let toml = format!(
//!         r#"rig = {{ name = "pendulum", angle_zero = "hanging" }}
//!         link = [{{ com_m = 0.1, mass_kg = 0.2, inertia_kg_m2 = 0.001 }}]
//!         joint = [{{ drive = "passive" }}]
//!         effect = [{{ kind = "viscous", joint = 1, coefficient_nm_s_rad = {friction} }}]
//!         fit.free = ["viscous@1.coefficient_nm_s_rad"]
//!         log.time = {{ column = "t", unit = "s" }}
//!         log.joint = [{{ position = {{ column = "q", unit = "rad" }} }}]"#
//!     );
//!     Model::parse(&toml, "pendulum.toml".as_ref())
//! };
//! let mut swing = Live::new(&pendulum(0.002)?, &[1.0])?;
//! let time_s: Vec<f64> = (0..400).map(|sample| 0.01 * sample as f64).collect();
//! let angle = |_: &f64| {
//!     let angle_rad = swing.angle_rad(0);
//!     swing.advance(0.01);
//!     angle_rad
//! };
//! let measured = Motion {
//!     position_rad: vec![time_s.iter().map(angle).collect()],
//!     velocity_rad_s: vec![None],
//!     rate_rad_s: vec![None],
//!     input: vec![None],
//!     time_s,
//!     ..Motion::default()
//! };
//! let guess = pendulum(0.01)?;
//! let data = FitProblem::new(&guess, vec![measured], Horizon::Whole);
//! let fitted = fit(&guess, &guess.free, &data, None, FitOptions::default());
//! let friction = fitted.model.effects[0].values[0];
//! assert!((friction - 0.002).abs() < 1e-5, "{friction} N m s/rad");
//! # Ok::<(), handstand_model::Error>(())
//! ```

pub mod compare;
pub mod fitting;

use handstand_model::{dynamics, effects, error, model, motion, output};
use handstand_sim::sim;
