//! Wheel mode: servos that turn without end, whose command is their motor's output.

use crate::link::{SerialLink, ServoResult, Servos};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, RETURN_DELAY, Register};
use serde::Serialize;

/// A register of a servo that has to change before the robot can be balanced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WheelChange {
    /// The servo.
    pub id: u8,
    /// The register.
    pub register: Register,
    /// Its code now.
    pub before: u16,
}

/// What a driven servo needs: no angle limits, which is wheel mode.
const DRIVEN: &[Register] = &[CW_LIMIT, CCW_LIMIT, RETURN_DELAY];
/// What every servo needs that is read in each tick: answers without a delay.
const READ: &[Register] = &[RETURN_DELAY];

impl WheelChange {
    /// Those of the servos `ids`, of which `driven` balance; all of them get the code 0.
    ///
    /// # Errors
    /// A servo does not answer, or its codes are not those that the CM-5's firmware goes by.
    pub fn needed<L: SerialLink>(
        servos: &mut Servos<L>,
        ids: &[u8],
        driven: &[u8],
    ) -> ServoResult<Vec<WheelChange>> {
        let mut changes = Vec::new();
        for &id in ids {
            servos.cm5_servo(id)?;
            let needed = if driven.contains(&id) { DRIVEN } else { READ };
            for &register in needed {
                let before = servos.get(id, register)?;
                if before != 0 {
                    changes.push(WheelChange {
                        id,
                        register,
                        before,
                    });
                }
            }
        }
        Ok(changes)
    }

    /// Write it, and read it back.
    ///
    /// # Errors
    /// The servo does not answer or keeps its code.
    pub fn make<L: SerialLink>(&self, servos: &mut Servos<L>) -> ServoResult<()> {
        servos.set(self.id, self.register, 0)
    }
}

impl Serialize for WheelChange {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct as _;
        let mut fields = to.serialize_struct("change", 3)?;
        fields.serialize_field("id", &self.id)?;
        fields.serialize_field("register", self.register.name)?;
        fields.serialize_field("before", &self.before)?;
        fields.end()
    }
}
