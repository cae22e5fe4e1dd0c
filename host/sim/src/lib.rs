//! A model simulated along its logs and in closed loops.
//!
//! ```
//! # use handstand_model::Model;
//! # use handstand_sim::sim::Live;
//! let pendulum = r#"
//!     rig = { name = "pendulum", angle_zero = "hanging" }
//!     link = [{ com_m = 0.1, mass_kg = 0.2, inertia_kg_m2 = 0.001 }]
//!     joint = [{ drive = "passive" }]
//!     effect = [{ kind = "viscous", joint = 1, coefficient_nm_s_rad = 0.002 }]
//!     log.time = { column = "t", unit = "s" }
//!     log.joint = [{ position = { column = "q", unit = "rad" } }]
//! "#;
//! let model = Model::parse(pendulum, "pendulum.toml".as_ref())?;
//! let mut swing = Live::new(&model, &[1.0])?;
//! swing.advance(10.0);
//! assert!(swing.angle_rad(0).abs() < 0.5, "friction has taken half of it");
//! # Ok::<(), handstand_model::Error>(())
//! ```

pub mod sim;

use handstand_model::{dynamics, effects, error, model, motion};
