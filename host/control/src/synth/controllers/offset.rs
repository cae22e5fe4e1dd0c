//! A disturbance observer in place of the angle compensation.

use super::observed::{ObservedDesign, Options};
use super::{ControllerInfo, Speeds};

/// The paper's regulator about the angles of balance as they are observed; angles and true speeds
/// are read.
pub const OFFSET_OBSERVER: ObservedDesign = ObservedDesign {
    info: ControllerInfo {
        id: "offset-observer",
        title: "DLQR with observed offsets",
        law: "u = -K (x - x_balance), balance estimated",
        speeds: Speeds::True,
        known_equilibrium: false,
        reference: "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed., \
                    section 8.5",
    },
    options: Options {
        offsets: true,
        ..Options::PAPER
    },
};
