//! The smaller parts of a plan.

/// The first link's attitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gyro {
    /// From the host's [`crate::message::Attitude`] instead of the gyro.
    pub from_host: bool,
    /// ADC code at rest.
    pub zero: u16,
    /// Rate steps per ADC code, times 16; negative if it is mounted the other way.
    pub scale: i16,
}

impl Gyro {
    pub(super) const LENGTH: usize = 5;
    pub(super) const ZERO: Gyro = Gyro {
        from_host: false,
        zero: 0,
        scale: 0,
    };

    /// Whether the zero is an ADC code, and a gyro that is balanced with has a scale.
    pub(super) fn is_sound(&self) -> bool {
        self.zero <= 1023 && (self.from_host || self.scale != 0)
    }

    pub(super) fn bytes(&self, sink: &mut impl FnMut(u8)) {
        sink(u8::from(self.from_host));
        let words = [self.zero.to_le_bytes(), self.scale.to_le_bytes()];
        words.into_iter().flatten().for_each(sink);
    }

    pub(super) fn from_bytes([from_host, z0, z1, s0, s1]: [u8; Gyro::LENGTH]) -> Self {
        Gyro {
            from_host: from_host != 0,
            zero: u16::from_le_bytes([z0, z1]),
            scale: i16::from_le_bytes([s0, s1]),
        }
    }
}

/// The moment of a link and of all that hangs on its end about its joint, p_j = m_j c_j e^{i d_j} +
/// l_j (m_{j+1} + ..): the direction in which its resultant centre of mass lies. The unit is free,
/// but the same for both parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Moment {
    /// Along the link's line.
    pub along: i16,
    /// Beside it, positive towards positive angles; 0 if its masses are not eccentric.
    pub aside: i16,
}

impl Moment {
    pub(super) const LENGTH: usize = 4;
    /// Of a link that asks for no compensation.
    pub const ZERO: Moment = Moment { along: 0, aside: 0 };

    pub(super) fn bytes(&self, sink: &mut impl FnMut(u8)) {
        let words = [self.along.to_le_bytes(), self.aside.to_le_bytes()];
        words.into_iter().flatten().for_each(sink);
    }

    pub(super) fn from_bytes([l0, l1, s0, s1]: [u8; Moment::LENGTH]) -> Self {
        Moment {
            along: i16::from_le_bytes([l0, l1]),
            aside: i16::from_le_bytes([s0, s1]),
        }
    }
}
